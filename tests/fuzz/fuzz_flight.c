/* Fuzzes the flight layer's public API. SPDX-License-Identifier: MIT
 *
 * Bytes become sections: settings, a flight past one to three obstacles, its samples of attitude and position, the detector's frames
 * with their delay, and the calls that query the result; some samples and frames are spoiled. After every call the promises of
 * goe_flight.h are checked:
 *   - the status is one of those documented; every number returned is finite and within its range;
 *   - a call that failed, or returned GOE_FLIGHT_TOO_NEW, changed nothing but counters (a clock that was set back is the one
 *     exception, and has its own counter);
 *   - only the state is written; the same bytes give the same bits (one input in 32). */
#include <math.h>
#include <string.h>

#include "fuzz.h"
#include "fuzz_scene.h"
#include "fuzz_settings.h"
#include "fuzz_twice.h"
#include "goe_flight.h"

#define GUARD_BYTES 64
#define GUARD 0xC3
#define SOLIDS_MAX 3u
#define SAMPLE_US 20000u
#define SAMPLE_S 0.02f
#define SAMPLES_MAX 6000u /* for one input */
#define ASSESS_EVERY 5u
#define READ_EVERY 7u

enum {
    CALLS,
    ATTITUDES,
    POSITIONS,
    FRAMES,
    FRAMES_TAKEN,
    FRAMES_TOO_NEW,
    FRAMES_TOO_OLD,
    ASSESSED,
    HAZARDS,
    OBSTACLES,
    SUSPECT,
    ACTIONS, /* from GOE_FLIGHT_LEFT on */
    RESETS_KNOWN = ACTIONS + 5,
    RESETS_UNKNOWN,
    RESTARTS,
    STARTS,
    STARTS_REFUSED,
    REFUSED,
    TWICE,
    COUNTS
};

fuzz_count_t fuzz_counts[COUNTS + 1] = {
    {"calls", 0},          {"attitudes", 0},      {"positions", 0},        {"frames", 0},
    {"frames_taken", 0},   {"frames_too_new", 0}, {"frames_too_old", 0},   {"assessed", 0},
    {"hazards", 0},        {"obstacles", 0},      {"suspect", 0},          {"action_left", 0},
    {"action_right", 0},   {"action_climb", 0},   {"action_go_around", 0}, {"action_hold", 0},
    {"resets_known", 0},   {"resets_unknown", 0}, {"restarts", 0},         {"starts", 0},
    {"starts_refused", 0}, {"refused", 0},        {"inputs_run_twice", 0}, {NULL, 0}};

static void count(int what) { fuzz_count_once(what); }

/* -------------------------------------------------------------------------------------------------------------- memory -- */

static struct {
    unsigned char before[GUARD_BYTES];
    goe_flight_t flight;
    unsigned char behind[GUARD_BYTES];
} memory;

static unsigned char guard[GUARD_BYTES];
static goe_flight_t kept;

typedef struct {
    fuzz_input_t in;
    fuzz_noise_t noise;
    goe_settings_t settings;
    fuzz_path_t path;
    fuzz_solid_t solid[SOLIDS_MAX];
    uint32_t solids;
    float t_s;
    uint32_t now_us, delay_us;
    uint32_t every; /* samples between frames */
    uint32_t limit; /* of 256: samples, frames and calls that are spoiled */
    uint8_t time_base;
    uint8_t shows; /* 1 box, 2 points, 4 base corners, 8 no ids */
    uint32_t attitude_resets, horizontal_resets, vertical_resets;
    float jump_ned_m[3];
    uint32_t samples;
    uint64_t hash;
} run_t;

/* -------------------------------------------------------------------------------------------------------------- checks -- */

static void check_floats(const float *numbers, size_t many) {
    for (size_t i = 0; i < many; i++) {
        FUZZ_CHECK(fuzz_is_finite(numbers[i]));
    }
}

static void hash_bytes(run_t *run, const void *from, size_t size) {
    const unsigned char *bytes = from;
    for (size_t i = 0; i < size; i++) {
        run->hash = (run->hash ^ bytes[i]) * 0x100000001B3u;
    }
}

static void check_hazard(const goe_hazard_t *h) {
    check_floats(&h->tcpa_s, 7);
    FUZZ_CHECK(h->conflict_probability >= 0.0f && h->conflict_probability <= 1.0f && h->tcpa_s >= 0.0f &&
               h->dcpa_m >= 0.0f);
    FUZZ_CHECK(h->tcpa_sd_s >= 0.0f && h->dcpa_sd_m >= 0.0f && h->clearance_sd_m >= 0.0f);
}

static void before_call(void) { memcpy(&kept, &memory.flight, sizeof kept); }

static void after_call(run_t *run, goe_flight_status_t status) {
    FUZZ_CHECK(((int)status <= (int)GOE_FLIGHT_TOO_NEW && (int)status >= (int)GOE_FLIGHT_NOTHING) ||
               ((int)status <= (int)GOE_FLIGHT_BAD_SETTINGS && (int)status >= (int)GOE_FLIGHT_NOT_INITIALIZED));
    FUZZ_CHECK(fuzz_same(memory.before, guard, GUARD_BYTES) && fuzz_same(memory.behind, guard, GUARD_BYTES));
    if (status != GOE_FLIGHT_OK && memory.flight.counters.lost == kept.counters.lost) {
        kept.counters = memory.flight.counters;
        kept.history.attitude_stale = memory.flight.history.attitude_stale;
        kept.history.position_stale = memory.flight.history.position_stale;
        if (status == GOE_FLIGHT_TOO_OLD) { /* such a frame counts for the sender's clock */
            memcpy(kept.clock, memory.flight.clock, sizeof kept.clock);
        }
        FUZZ_CHECK(fuzz_same(&kept, &memory.flight, sizeof kept));
    }
    hash_bytes(run, &status, sizeof status);
    count(CALLS);
    if ((int)status < 0) {
        count(REFUSED);
    }
}

/* ------------------------------------------------------------------------------------------------------------- samples -- */

static bool is_spoiled(run_t *run) { return fuzz_noise_bits(&run->noise) % 256u < run->limit; }

static void send_attitude(run_t *run, const goe_pose_t *pose) {
    goe_flight_attitude_t sample;
    memset(&sample, 0, sizeof sample);
    sample.time_us = run->now_us;
    memcpy(sample.q, pose->attitude, sizeof sample.q);
    sample.reset = run->attitude_resets;
    if (is_spoiled(run)) {
        const uint32_t how = fuzz_byte(&run->in);
        if (how % 4u == 1u) {
            sample.q[how / 4u % 4u] = fuzz_any(&run->in, -1.0f, 1.0f);
        } else if (how % 4u == 2u) {
            sample.time_us -= fuzz_word(&run->in) >> (how >> 3);
        } else if (how % 4u == 3u) {
            sample.reset = ++run->attitude_resets;
        }
    }
    before_call();
    after_call(run, goe_flight_attitude(&memory.flight, &sample));
    count(ATTITUDES);
}

/* Its filter jumps, and reports the jump or not. */
static void jump(run_t *run, goe_flight_position_t *sample) {
    const uint32_t how = fuzz_byte(&run->in);
    for (int i = 0; i < 3; i++) {
        sample->reset_delta_ned_m[i] = fuzz_between(&run->in, -15.0f, 15.0f);
        run->jump_ned_m[i] += sample->reset_delta_ned_m[i];
        sample->position_ned_m[i] += sample->reset_delta_ned_m[i];
    }
    run->horizontal_resets += how & 1u;
    run->vertical_resets += how >> 1 & 3u;
    sample->reset_delta_known = (how & 8u) == 0;
}

static void spoil_position(run_t *run, goe_flight_position_t *sample) {
    const uint32_t how = fuzz_byte(&run->in);
    switch (how % 6u) {
        case 0:
            sample->position_ned_m[how / 8u % 3u] = fuzz_any(&run->in, -1.0e6f, 1.0e6f);
            break;
        case 1:
            sample->velocity_ned_m_s[how / 8u % 3u] = fuzz_any(&run->in, -1.0e3f, 1.0e3f);
            break;
        case 2:
            sample->height_m[how / 8u % 3u] = fuzz_any(&run->in, -1.0e5f, 1.0e5f);
            break;
        case 3:
            sample->time_us -= fuzz_word(&run->in) >> (how >> 3);
            break;
        case 4:
            sample->origin_lat_e7 = (int32_t)((int64_t)fuzz_word(&run->in) - INT64_C(0x80000000));
            sample->origin_lon_e7 = (int32_t)((int64_t)fuzz_word(&run->in) - INT64_C(0x80000000));
            break;
        default:
            jump(run, sample);
            break;
    }
}

static void send_position(run_t *run, const goe_pose_t *pose) {
    goe_flight_position_t sample;
    memset(&sample, 0, sizeof sample);
    sample.time_us = run->now_us;
    for (int i = 0; i < 3; i++) {
        sample.position_ned_m[i] = pose->position_ned_m[i] + run->jump_ned_m[i];
    }
    sample.velocity_ned_m_s[0] = run->path.speed_m_s * cosf(run->path.course_rad);
    sample.velocity_ned_m_s[1] = run->path.speed_m_s * sinf(run->path.course_rad);
    sample.velocity_ned_m_s[2] = -run->path.climb_m_s;
    sample.height_valid = (uint8_t)(run->samples / 64u);
    for (int i = 0; i < GOE_FLIGHT_HEIGHTS; i++) {
        sample.height_m[i] = pose->height_m;
    }
    sample.origin_known = (run->shows & 16u) != 0;
    sample.origin_lat_e7 = 475000000;
    sample.origin_lon_e7 = 190000000;
    sample.reset_delta_known = true;
    if (is_spoiled(run)) {
        spoil_position(run, &sample);
    }
    sample.reset_horizontal = run->horizontal_resets;
    sample.reset_vertical = run->vertical_resets;
    const uint16_t known = memory.flight.counters.resets;
    const uint16_t unknown = memory.flight.counters.lost;
    before_call();
    after_call(run, goe_flight_position(&memory.flight, &sample));
    count(POSITIONS);
    if (memory.flight.counters.resets != known) {
        count(RESETS_KNOWN);
    }
    if (memory.flight.counters.lost != unknown) {
        count(RESETS_UNKNOWN);
    }
}

/* -------------------------------------------------------------------------------------------------------------- frames -- */

static bool detect(run_t *run, uint32_t i, const goe_pose_t *pose, float t_s, goe_flight_detection_t *d) {
    fuzz_sight_t sight;
    goe_image_t image;
    memset(d, 0, sizeof *d);
    if (!fuzz_look(&run->settings.camera, pose, &run->solid[i], t_s, &sight)) {
        return false;
    }
    fuzz_blur(&sight, &run->noise, 0.7f);
    d->id = (run->shows & 8u) != 0 ? 0u : i + 1u;
    d->score = 0.6f + 0.4f * fuzz_noise(&run->noise);
    if ((run->shows & 1u) != 0 || (run->shows & 6u) == 0) {
        d->box = fuzz_box(&run->settings.camera, &sight);
    }
    if ((run->shows & 6u) != 0) {
        memset(&image, 0, sizeof image);
        fuzz_points(&run->settings.camera, &sight, (run->shows & 4u) != 0, &image);
        d->left = image.left;
        d->right = image.right;
        d->top = image.top;
        d->base_left = image.base_left;
        d->base_near = image.base_near;
        d->base_right = image.base_right;
    }
    return true;
}

static void spoil_detection(run_t *run, goe_flight_detection_t *d) {
    float *const numbers[] = {&d->score,        &d->pixel_px,      &d->box.left_px, &d->box.top_px,
                              &d->box.right_px, &d->box.bottom_px, &d->left.u_px,   &d->base_near.v_px};
    float *const sizes[] = {&d->kind.width_m, &d->kind.width_sd_m, &d->kind.height_m, &d->kind.height_sd_m};
    const uint32_t how = fuzz_byte(&run->in);
    switch (how % 5u) {
        case 0:
            *numbers[how / 5u % 8u] = fuzz_any(&run->in, -1.0e5f, 1.0e5f);
            break;
        case 1:
            d->id = fuzz_byte(&run->in);
            break;
        case 2:
            d->box.sides = fuzz_byte(&run->in);
            break;
        case 3:
            for (int i = 0; i < 4; i++) {
                *sizes[i] = fuzz_any(&run->in, 0.0f, 100.0f);
            }
            d->kind.shape = fuzz_byte(&run->in) % 4u;
            break;
        default:
            d->pixel_px = fuzz_any(&run->in, 0.0f, 100.0f);
            break;
    }
}

static void spoil_frame(run_t *run, goe_flight_frame_t *frame) {
    const uint32_t how = fuzz_byte(&run->in);
    switch (how % 8u) {
        case 0:
            frame->capture_us = fuzz_word(&run->in);
            break;
        case 1:
            frame->time_base = fuzz_byte(&run->in);
            break;
        case 2:
            frame->camera = fuzz_byte(&run->in);
            break;
        case 3:
            frame->count = fuzz_byte(&run->in) % (GOE_FLIGHT_DETECTIONS + 2);
            break;
        case 4:
            frame->number = fuzz_byte(&run->in);
            break;
        case 5:
            frame->time_sd_us = fuzz_word(&run->in);
            break;
        case 6:
            frame->arrival_us -= fuzz_word(&run->in) >> (how >> 3);
            break;
        default:
            frame->detection = NULL;
            break;
    }
}

static void set_times(const run_t *run, goe_flight_frame_t *frame) {
    const uint32_t sender_ahead_us = 123456789u; /* of the autopilot's clock */
    frame->arrival_us = run->now_us;
    frame->sent_us = run->now_us - 8000u + sender_ahead_us;
    frame->time_base = run->time_base;
    frame->capture_us = run->now_us - run->delay_us;
    if (run->time_base == GOE_FLIGHT_SENDER_CLOCK) {
        frame->capture_us += sender_ahead_us;
    } else if (run->time_base == GOE_FLIGHT_AGE) {
        frame->capture_us = run->delay_us;
    }
    frame->time_sd_us = 2000u;
}

static void send_frame(run_t *run) {
    static goe_flight_detection_t detections[GOE_FLIGHT_DETECTIONS + 1];
    const float t_s = run->t_s - 1.0e-6f * (float)run->delay_us;
    goe_flight_frame_t frame;
    goe_pose_t pose;
    memset(&frame, 0, sizeof frame);
    memset(detections, 0, sizeof detections);
    fuzz_path_pose(&run->path, t_s, &pose);
    for (uint32_t i = 0; i < run->solids; i++) {
        if (detect(run, i, &pose, t_s, &detections[frame.count])) {
            if (is_spoiled(run)) {
                spoil_detection(run, &detections[frame.count]);
            }
            frame.count++;
        }
    }
    frame.number = frame.count;
    frame.detection = detections;
    set_times(run, &frame);
    if (is_spoiled(run)) {
        spoil_frame(run, &frame);
    }
    before_call();
    const goe_flight_status_t status = goe_flight_frame(&memory.flight, &frame);
    after_call(run, status);
    count(FRAMES);
    if (status == GOE_FLIGHT_OK || status == GOE_FLIGHT_TOO_NEW || status == GOE_FLIGHT_TOO_OLD) {
        count(status == GOE_FLIGHT_OK ? FRAMES_TAKEN
                                      : (status == GOE_FLIGHT_TOO_NEW ? FRAMES_TOO_NEW : FRAMES_TOO_OLD));
    }
}

/* ------------------------------------------------------------------------------------------------------------- outcome -- */

static void assess(run_t *run) {
    goe_flight_assessment_t a;
    memset(&a, GUARD, sizeof a);
    const uint32_t now_us = is_spoiled(run) ? run->now_us - fuzz_word(&run->in) / 2u : run->now_us;
    before_call();
    const goe_flight_status_t status = goe_flight_assess(&memory.flight, now_us, (run->shows & 32u) != 0, &a);
    after_call(run, status);
    FUZZ_CHECK((int)a.action >= (int)GOE_FLIGHT_NONE && (int)a.action <= (int)GOE_FLIGHT_HOLD);
    FUZZ_CHECK(a.worst >= -1 && a.worst < GOE_FLIGHT_SLOTS && a.avoided >= -1 && a.avoided < GOE_FLIGHT_SLOTS);
    FUZZ_CHECK(a.obstacles <= GOE_FLIGHT_SLOTS && fuzz_is_finite(a.needed_s) && a.needed_s >= 0.0f);
    check_floats(a.target_ned_m, 3);
    check_hazard(&a.hazard);
    FUZZ_CHECK(status == GOE_FLIGHT_OK || (a.action == GOE_FLIGHT_NONE && a.worst == -1 && a.avoided == -1));
    FUZZ_CHECK(a.target_lat_e7 >= -900000000 && a.target_lat_e7 <= 900000000);
    FUZZ_CHECK(a.target_lon_e7 >= -1800000000 && a.target_lon_e7 <= 1800000000);
    FUZZ_CHECK(*goe_flight_action_text(a.action) != '\0');
    hash_bytes(run, a.target_ned_m, sizeof a.target_ned_m);
    hash_bytes(run, &a.hazard.tcpa_s, 7 * sizeof(float));
    count(ASSESSED);
    if (a.worst >= 0) {
        count(HAZARDS);
    }
    if (a.action != GOE_FLIGHT_NONE) {
        count(ACTIONS + (int)a.action - (int)GOE_FLIGHT_LEFT);
    }
    if (a.suspect) {
        count(SUSPECT);
    }
}

static void read_obstacle(run_t *run, int slot) {
    goe_flight_obstacle_t o;
    memset(&o, GUARD, sizeof o);
    const goe_flight_status_t status = goe_flight_obstacle(&memory.flight, slot, &o);
    after_call(run, status);
    FUZZ_CHECK(fuzz_is_finite(o.age_s) && o.age_s >= 0.0f);
    check_floats(o.center_ned_m, 3);
    check_floats(o.covariance_ne_m2, 3);
    check_floats(&o.radius_m, 6);
    check_floats(o.nearest_ned_m, 3);
    check_floats(o.nearest_body_m, 3);
    check_hazard(&o.hazard);
    FUZZ_CHECK(o.covariance_ne_m2[0] >= 0.0f && o.covariance_ne_m2[2] >= 0.0f && o.radius_m >= 0.0f);
    FUZZ_CHECK(o.length_heading_deg >= 0.0f && o.length_heading_deg <= 180.0f);
    FUZZ_CHECK(status != GOE_FLIGHT_OK || (slot >= 0 && slot < GOE_FLIGHT_SLOTS));
    hash_bytes(run, o.center_ned_m, sizeof o.center_ned_m);
    if (status == GOE_FLIGHT_OK && (o.valid & GOE_HAS_POSITION) != 0u) {
        count(OBSTACLES);
    }
}

static void read_sectors(run_t *run) {
    uint16_t sector_cm[GOE_FLIGHT_SECTORS];
    const uint32_t max_cm = is_spoiled(run) ? fuzz_word(&run->in) : 20000u;
    memset(sector_cm, 0, sizeof sector_cm);
    const goe_flight_status_t status = goe_flight_sectors(&memory.flight, max_cm, sector_cm);
    after_call(run, status);
    for (int i = 0; i < GOE_FLIGHT_SECTORS && (status == GOE_FLIGHT_OK || status == GOE_FLIGHT_NO_POSE); i++) {
        FUZZ_CHECK(sector_cm[i] == GOE_FLIGHT_SECTOR_UNKNOWN ||
                   (sector_cm[i] > 0u && (uint32_t)sector_cm[i] <= max_cm + 1u));
    }
    hash_bytes(run, sector_cm, sizeof sector_cm);
}

static void read_pose(run_t *run) {
    goe_pose_t pose;
    float sd_deg = 0.0f;
    memset(&pose, GUARD, sizeof pose);
    const uint32_t back_us = is_spoiled(run) ? fuzz_word(&run->in) : fuzz_noise_bits(&run->noise) % 700000u;
    const goe_flight_status_t status = goe_flight_pose(&memory.flight, run->now_us - back_us, back_us, &pose, &sd_deg);
    after_call(run, status);
    check_floats(pose.position_ned_m, 3);
    check_floats(pose.attitude, 4);
    FUZZ_CHECK(fuzz_is_finite(pose.height_m) && fuzz_is_finite(sd_deg) && sd_deg >= 0.0f);
    const float *q = pose.attitude;
    const float norm2 = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    FUZZ_CHECK(status == GOE_FLIGHT_OK ? (norm2 > 0.98f && norm2 < 1.03f) : norm2 <= 0.0f);
    hash_bytes(run, pose.position_ned_m, sizeof pose.position_ned_m);
}

static void read_all(run_t *run) {
    before_call();
    for (int slot = -1; slot <= GOE_FLIGHT_SLOTS; slot++) {
        read_obstacle(run, slot);
    }
    read_sectors(run);
    read_pose(run);
    FUZZ_CHECK(fuzz_same(&kept, &memory.flight, sizeof kept));
}

/* ------------------------------------------------------------------------------------------------------------ sections -- */

#define GOE_FLIGHT_SETTING(field, least, most, usual) {offsetof(goe_flight_settings_t, field), least, most},
static const struct {
    size_t place;
    float low, high;
} fields[] = {
#include "goe_flight_settings_list.h"
};
#define FIELDS (sizeof fields / sizeof fields[0])

static void change_flight_settings(fuzz_input_t *in, goe_flight_settings_t *settings) {
    const uint32_t changes = fuzz_below(in, 5);
    for (uint32_t i = 0; i < changes; i++) {
        const uint32_t which = fuzz_below(in, FIELDS);
        const bool legal = fuzz_below(in, 8) != 7;
        const float value = legal ? fuzz_between(in, fields[which].low, fields[which].high)
                                  : fuzz_any(in, fields[which].low, fields[which].high);
        memcpy((unsigned char *)settings + fields[which].place, &value, sizeof value);
    }
    if (settings->confirm_images >= 1.0f &&
        settings->confirm_images <= 20.0f) { /* a fraction is refused, and ends the story */
        settings->confirm_images = (float)(int)settings->confirm_images;
    }
    settings->resets = fuzz_below(in, 4) == 3u ? 1.0f : settings->resets;
}

static void start(run_t *run) {
    goe_flight_settings_t settings;
    const char *bad = NULL;
    goe_flight_settings_default(&settings);
    fuzz_usual_settings(&run->in, &run->settings);
    run->settings.camera.width_px = 2.0f * run->settings.camera.cx_px;
    run->settings.camera.height_px = 2.0f * run->settings.camera.cy_px;
    change_flight_settings(&run->in, &settings);
    if (fuzz_below(&run->in, 4) == 3u) {
        fuzz_change_settings(&run->in, true, &run->settings);
    }
    if (goe_flight_init(&memory.flight, sizeof memory.flight, &run->settings, &settings, &bad) != GOE_FLIGHT_OK) {
        FUZZ_CHECK(bad != NULL && *bad != '\0');
        count(STARTS_REFUSED);
        goe_settings_default(&run->settings);
        run->settings.camera.fx_px = run->settings.camera.fy_px = 900.0f;
        run->settings.camera.cx_px = run->settings.camera.cy_px = 640.0f;
        run->settings.camera.width_px = run->settings.camera.height_px = 1280.0f;
        FUZZ_CHECK(goe_flight_init(&memory.flight, sizeof memory.flight, &run->settings, NULL, NULL) == GOE_FLIGHT_OK);
    }
    count(STARTS);
    run->attitude_resets = run->horizontal_resets = run->vertical_resets = 0;
}

static void begin(run_t *run) {
    const uint32_t how = fuzz_byte(&run->in);
    if (run->samples == 0 || how % 4u != 3u) {
        start(run);
    }
    run->path = fuzz_any_path(&run->in);
    run->solids = 1u + fuzz_below(&run->in, SOLIDS_MAX);
    for (uint32_t i = 0; i < run->solids; i++) {
        run->solid[i] = fuzz_any_solid(&run->in, &run->path);
    }
    run->t_s = 0.0f;
    run->now_us += fuzz_byte(&run->in) % 8u == 7u ? fuzz_word(&run->in) : SAMPLE_US;
    run->noise.state = fuzz_half(&run->in) * 0x9E3779B9u | 1u;
    run->every = 2u + fuzz_below(&run->in, 12);
    run->delay_us = 20000u + 1000u * fuzz_below(&run->in, 200);
    run->time_base = (uint8_t)fuzz_below(&run->in, 3);
    run->shows = fuzz_byte(&run->in);
    const uint32_t spoiled = fuzz_byte(&run->in);
    run->limit = spoiled < 192u ? spoiled / 48u : spoiled - 128u;
    memset(run->jump_ned_m, 0, sizeof run->jump_ned_m);
}

static void other_calls(run_t *run) {
    const uint32_t how = fuzz_byte(&run->in);
    before_call();
    if (how % 4u == 0u) {
        after_call(run, goe_flight_timesync(&memory.flight, fuzz_word(&run->in), fuzz_half(&run->in)));
    } else if (how % 4u == 1u) {
        after_call(run, goe_flight_timesync(&memory.flight, 0u, 0xFFFFFFFFu));
    } else if (how % 4u == 2u && how / 4u % 8u == 7u) {
        after_call(run, goe_flight_restart(&memory.flight));
        count(RESTARTS);
    } else {
        after_call(run, goe_flight_frame(&memory.flight, NULL));
        after_call(run, goe_flight_attitude(&memory.flight, NULL));
        after_call(run, goe_flight_position(NULL, NULL));
        after_call(run, goe_flight_obstacle(&memory.flight, 0, NULL));
        after_call(run, goe_flight_assess(&memory.flight, run->now_us, false, NULL));
    }
}

static void section(run_t *run) {
    begin(run);
    const uint32_t samples = 50u + 4u * fuzz_byte(&run->in);
    for (uint32_t k = 0; k < samples && run->samples < SAMPLES_MAX; k++) {
        goe_pose_t pose;
        run->t_s += SAMPLE_S;
        run->now_us += SAMPLE_US;
        run->samples++;
        fuzz_path_pose(&run->path, run->t_s, &pose);
        send_attitude(run, &pose);
        send_position(run, &pose);
        if (k % run->every == 0) {
            send_frame(run);
        }
        if (k % ASSESS_EVERY == 0) {
            assess(run);
        }
        if (k % READ_EVERY == 0) {
            read_all(run);
        }
        if (is_spoiled(run)) {
            other_calls(run);
        }
    }
}

static uint64_t fly(const uint8_t *data, size_t size, int fill) {
    run_t run;
    memset(&run, 0, sizeof run);
    memset(guard, GUARD, sizeof guard);
    memset(&memory, GUARD, sizeof memory);
    memset(&memory.flight, fill, sizeof memory.flight);
    run.in.next = data;
    run.in.left = size;
    do {
        section(&run);
    } while (run.in.left > 0 && run.samples < SAMPLES_MAX);
    return run.hash;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    fuzz_twice(fly, data, size, TWICE);
    return 0;
}
