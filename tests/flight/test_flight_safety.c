/* Any input, only finite output. SPDX-License-Identifier: MIT
 *
 * Invariants, checked after every call on random, extreme and broken input, spoiled flights among it:
 *   - the status is one of those that goe_flight.h names;
 *   - every number of every output is finite, judged by its exponent bits, and so is every number of the layer's own state;
 *   - a call that failed, and one that was answered by GOE_FLIGHT_TOO_NEW, changed nothing but counters (a clock that was set
 *     back, which starts everything again, is the one exception);
 *   - actions, slots and sectors lie in their ranges; probabilities lie in 0 to 1;
 *   - no byte before or behind the state is touched.
 * Floats are judged by bits alone, so the test also works where the layer was compiled with -ffast-math. GOE_TEST_SEED and
 * GOE_TEST_UPDATES set seed and length. */
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "flown.h"

#define CALLS_EACH 60000
#define GUARD_BYTES 64
#define GUARD 0xC3

static struct {
    unsigned char before[GUARD_BYTES];
    goe_flight_t flight;
    unsigned char behind[GUARD_BYTES];
} memory;

static goe_flight_t kept;
static check_random_t any;
static uint32_t now_us;
static long taken, ordered;

void setUp(void) { memset(&memory, GUARD, sizeof memory); }
void tearDown(void) {}

static int calls_each(void) {
    const char *wanted = getenv("GOE_TEST_UPDATES");
    return wanted ? (int)strtol(wanted, NULL, 0) : CALLS_EACH;
}

static uint32_t below(uint32_t limit) { return check_random_bits(&any) % limit; }
static bool one_in(uint32_t n) { return below(n) == 0u; }
static float between(double low, double high) { return (float)check_random_between(&any, low, high); }
static float any_bits(void) { return check_from_bits(check_random_bits(&any)); }

/* Mostly a number of the size that belongs there; sometimes anything. */
static float some(double low, double high) {
    if (one_in(60)) {
        return any_bits();
    }
    return one_in(60) ? between(-1.0e7, 1.0e7) : between(low, high);
}

/* -------------------------------------------------------------------------------------------------------- invariants -- */

static void check_floats(const float *numbers, size_t count, const char *what) {
    for (size_t i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, &numbers[i], sizeof bits);
        TEST_ASSERT_TRUE_MESSAGE((bits & 0x7F800000u) != 0x7F800000u, what);
    }
}

static bool is_probability(const float *x) {
    uint32_t bits;
    memcpy(&bits, x, sizeof bits);
    return bits <= 0x3F800000u || bits == 0x80000000u; /* 0 to 1 */
}

static void check_status(goe_flight_status_t status) {
    TEST_ASSERT_TRUE((status <= GOE_FLIGHT_TOO_NEW && status >= GOE_FLIGHT_NOTHING) ||
                     (status <= GOE_FLIGHT_BAD_SETTINGS && status >= GOE_FLIGHT_NOT_INITIALIZED));
}

static void check_hazard(const goe_hazard_t *hazard) {
    check_floats(&hazard->tcpa_s, 7, "hazard");
    TEST_ASSERT_TRUE(is_probability(&hazard->conflict_probability));
}

static void check_slots(void) {
    for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
        const goe_flight_slot_t *slot = &memory.flight.slot[i];
        const size_t floats = (offsetof(goe_flight_slot_t, box_px) - offsetof(goe_flight_slot_t, jumps_ned_m)) / 4u;
        check_floats(slot->jumps_ned_m, floats, "slot");
        check_hazard(&slot->hazard);
        check_floats(slot->estimator.settings.camera.offset_m, 3, "estimator");
    }
}

static void check_state(void) {
    const goe_flight_t *f = &memory.flight;
    for (int k = 0; k < GOE_FLIGHT_SAMPLES; k++) {
        check_floats(f->history.attitude[k].q, 4, "attitudes");
        check_floats(f->history.position[k].ned_m, 3, "positions");
    }
    check_floats(f->marks.jumps_ned_m, 3, "jumps");
    check_floats(f->velocity_ned_m_s, 3, "velocity");
    check_floats(f->reaction.from_ned_m, 5, "order");
    check_floats(f->reaction.target_ned_m, 3, "target");
    for (int i = 0; i < GOE_CAMERAS_MAX; i++) {
        check_floats(&f->clock[i].excess_us, 2, "clock");
    }
    check_slots();
    for (int i = 0; i < GUARD_BYTES; i++) {
        TEST_ASSERT_EQUAL_HEX8(GUARD, memory.before[i]);
        TEST_ASSERT_EQUAL_HEX8(GUARD, memory.behind[i]);
    }
}

static void before_call(void) { kept = memory.flight; }

/* What failed changed nothing but counters, the count of samples that are not newer, and, by a frame that is too old, the sender's clock. */
static void check_call(goe_flight_status_t status) {
    check_status(status);
    if (status != GOE_FLIGHT_OK && memory.flight.counters.lost == kept.counters.lost) {
        kept.counters = memory.flight.counters;
        kept.history.attitude_stale = memory.flight.history.attitude_stale;
        kept.history.position_stale = memory.flight.history.position_stale;
        if (status == GOE_FLIGHT_TOO_OLD) {
            memcpy(kept.clock, memory.flight.clock, sizeof kept.clock);
        }
        TEST_ASSERT_EQUAL_MEMORY(&kept, &memory.flight, sizeof kept);
    }
    check_state();
}

/* ------------------------------------------------------------------------------------------------------------- calls -- */

static void fuzz_attitude(void) {
    goe_flight_attitude_t sample;
    memset(&sample, 0, sizeof sample);
    sample.time_us = one_in(100) ? check_random_bits(&any) : now_us;
    const double half = check_random_between(&any, -0.1, 0.1);
    sample.q[0] = (float)cos(half);
    sample.q[1 + below(3)] = (float)sin(half);
    if (one_in(30)) {
        sample.q[below(4)] = any_bits();
    }
    sample.reset = one_in(800) ? check_random_bits(&any) : memory.flight.marks.attitude;
    before_call();
    check_call(goe_flight_attitude(&memory.flight, &sample));
}

static void fuzz_position(void) {
    goe_flight_position_t sample;
    memset(&sample, 0, sizeof sample);
    sample.time_us = one_in(100) ? check_random_bits(&any) : now_us;
    const float t_s = 1.0e-6f * (float)(now_us % 20000000u);
    sample.position_ned_m[0] = some(20.0 * (double)t_s, 20.0 * (double)t_s + 0.1);
    sample.position_ned_m[1] = some(-1.0, 1.0);
    sample.position_ned_m[2] = some(-21.0, -20.0);
    sample.velocity_ned_m_s[0] = some(19.0, 21.0);
    sample.velocity_ned_m_s[1] = some(-1.0, 1.0);
    sample.velocity_ned_m_s[2] = some(-1.0, 1.0);
    sample.height_valid = (uint8_t)below(256);
    for (int i = 0; i < GOE_FLIGHT_HEIGHTS; i++) {
        sample.height_m[i] = some(19.0, 21.0);
    }
    sample.origin_known = one_in(2);
    sample.origin_lat_e7 = (int32_t)check_random_bits(&any) / (one_in(3) ? 1 : 3);
    sample.origin_lon_e7 = (int32_t)check_random_bits(&any) / (one_in(20) ? 1 : 2);
    sample.reset_horizontal = memory.flight.marks.horizontal + (one_in(200) ? 1u : 0u);
    sample.reset_vertical = one_in(400) ? check_random_bits(&any) : memory.flight.marks.vertical;
    sample.reset_delta_known = !one_in(4);
    for (int i = 0; i < 3; i++) {
        sample.reset_delta_ned_m[i] = some(-5.0, 5.0);
    }
    before_call();
    check_call(goe_flight_position(&memory.flight, &sample));
}

static void fuzz_pixel(goe_pixel_t *pixel) {
    pixel->u_px = some(0.0, 1280.0);
    pixel->v_px = some(0.0, 1280.0);
    pixel->visible = one_in(8);
}

/* Mostly a mast 300 m ahead of where a flight begins. */
static void fuzz_detection(goe_flight_detection_t *d) {
    const float ahead_m = 400.0f - 20.0e-6f * (float)(now_us % 20000000u);
    const float size_px = 914.0f / ahead_m;
    memset(d, 0, sizeof *d);
    d->id = one_in(4) ? below(8) : below(3);
    d->score = some(0.2, 1.0);
    d->pixel_px = one_in(4) ? some(0.0, 3.0) : 0.0f;
    d->box.left_px = some(639.0, 641.0) - (3.0f + 20.0f * (float)d->id) * size_px;
    d->box.right_px = d->box.left_px + 6.0f * size_px * some(0.9, 1.1);
    d->box.top_px = some(639.0, 641.0) - 20.0f * size_px;
    d->box.bottom_px = some(639.0, 641.0) + 20.0f * size_px;
    d->box.sides = one_in(20) ? (uint8_t)below(256) : GOE_SIDES_ALL;
    if (one_in(6)) {
        fuzz_pixel(&d->left);
        fuzz_pixel(&d->right);
        fuzz_pixel(&d->top);
        fuzz_pixel(&d->base_left);
        fuzz_pixel(&d->base_near);
        fuzz_pixel(&d->base_right);
    }
}

static void fuzz_frame(void) {
    static goe_flight_detection_t detections[GOE_FLIGHT_DETECTIONS];
    goe_flight_frame_t frame;
    memset(&frame, 0, sizeof frame);
    const uint32_t count = one_in(20) ? below(GOE_FLIGHT_DETECTIONS + 1u) : below(4);
    for (uint32_t i = 0; i < count; i++) {
        fuzz_detection(&detections[i]);
    }
    frame.arrival_us = one_in(100) ? check_random_bits(&any) : now_us;
    frame.time_base = (uint8_t)(one_in(60) ? below(256) : below(3));
    frame.camera = (uint8_t)(one_in(60) ? below(256) : 0u);
    frame.sent_us = frame.arrival_us - 1000000u - below(20000u);
    frame.capture_us = frame.time_base == GOE_FLIGHT_AGE ? below(200000u) : frame.arrival_us - below(200000u);
    if (frame.time_base == GOE_FLIGHT_SENDER_CLOCK) {
        frame.capture_us = frame.sent_us - below(150000u);
    }
    if (one_in(60)) {
        frame.capture_us = check_random_bits(&any);
    }
    frame.time_sd_us = one_in(40) ? check_random_bits(&any) : below(20000u);
    frame.count = (uint8_t)(one_in(100) ? below(256) : count);
    frame.count = frame.count > GOE_FLIGHT_DETECTIONS ? (uint8_t)(GOE_FLIGHT_DETECTIONS + 1) : frame.count;
    frame.number = (uint8_t)(one_in(5) ? below(8) : frame.count);
    frame.detection = one_in(200) ? NULL : detections;
    before_call();
    const goe_flight_status_t status = goe_flight_frame(&memory.flight, &frame);
    taken += status == GOE_FLIGHT_OK ? 1 : 0;
    check_call(status);
}

static void fuzz_assess(void) {
    goe_flight_assessment_t a;
    memset(&a, GUARD, sizeof a);
    before_call();
    const goe_flight_status_t status =
        goe_flight_assess(&memory.flight, one_in(100) ? check_random_bits(&any) : now_us, one_in(4), &a);
    check_call(status);
    TEST_ASSERT_TRUE(a.action >= GOE_FLIGHT_NONE && a.action <= GOE_FLIGHT_HOLD);
    TEST_ASSERT_TRUE(a.worst >= -1 && a.worst < GOE_FLIGHT_SLOTS && a.avoided >= -1 && a.avoided < GOE_FLIGHT_SLOTS);
    TEST_ASSERT_TRUE(a.obstacles <= GOE_FLIGHT_SLOTS);
    check_floats(&a.needed_s, 1, "needed");
    check_floats(a.target_ned_m, 3, "target");
    check_hazard(&a.hazard);
    ordered += a.action != GOE_FLIGHT_NONE ? 1 : 0;
}

static void fuzz_readers(void) {
    goe_flight_obstacle_t o;
    goe_pose_t pose;
    float sd_deg;
    uint16_t sector_cm[GOE_FLIGHT_SECTORS];
    before_call();
    memset(&o, GUARD, sizeof o);
    check_status(goe_flight_obstacle(&memory.flight, (int)below(GOE_FLIGHT_SLOTS + 4) - 2, &o));
    check_floats(&o.age_s, 1, "age");
    check_floats(o.center_ned_m, 18, "obstacle");
    check_hazard(&o.hazard);
    memset(&pose, GUARD, sizeof pose);
    check_status(goe_flight_pose(&memory.flight, now_us - below(800000u), check_random_bits(&any), &pose, &sd_deg));
    check_floats(pose.position_ned_m, 8, "pose");
    check_floats(&sd_deg, 1, "sigma");
    const uint32_t max_cm = one_in(10) ? check_random_bits(&any) : 1u + below(65000u);
    const goe_flight_status_t status = goe_flight_sectors(&memory.flight, max_cm, sector_cm);
    check_status(status);
    for (int i = 0; i < GOE_FLIGHT_SECTORS && (status == GOE_FLIGHT_OK || status == GOE_FLIGHT_NO_POSE); i++) {
        TEST_ASSERT_TRUE(sector_cm[i] == GOE_FLIGHT_SECTOR_UNKNOWN ||
                         (sector_cm[i] > 0u && sector_cm[i] <= max_cm + 1u));
    }
    TEST_ASSERT_EQUAL_MEMORY(&kept, &memory.flight, sizeof kept);
}

static void start(void) {
    scene_t scene;
    scene_default(&scene);
    scene.camera.width_px = scene.camera.height_px = 1280.0f;
    const goe_settings_t estimator = scene_settings(&scene);
    goe_flight_settings_t settings;
    goe_flight_settings_default(&settings);
    settings.resets = one_in(2) ? 1.0f : 0.0f;
    settings.confirm_images = (float)(1u + below(4));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK,
                      goe_flight_init(&memory.flight, sizeof memory.flight, &estimator, &settings, NULL));
    now_us = one_in(3) ? 0xFFFFFFFFu - 3000000u : below(20000000u);
}

/* ------------------------------------------------------------------------------------------------------------- tests -- */

/* [GOE_FLIGHT_DETECTIONS, F1, F5] */
static void anything_does_no_harm(void) {
    any = check_random_start("flight layer");
    const int calls = calls_each();
    taken = ordered = 0;
    for (int k = 0; k < calls; k++) {
        if (k % 4000 == 0) {
            start();
        }
        now_us += one_in(500) ? below(3000000u) : 20000u;
        fuzz_attitude();
        fuzz_position();
        if (k % 3 == 0) {
            fuzz_frame();
        }
        if (k % 5 == 0) {
            fuzz_assess();
        }
        if (k % 7 == 0) {
            fuzz_readers();
        }
        if (one_in(2000)) {
            TEST_ASSERT_EQUAL(GOE_FLIGHT_OK,
                              goe_flight_timesync(&memory.flight, check_random_bits(&any), check_random_bits(&any)));
        }
        if (one_in(3000)) {
            TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_restart(&memory.flight));
        }
    }
    check_report("frames taken", (double)taken);
    check_report("assessments with an order", (double)ordered);
    TEST_ASSERT_TRUE(taken > calls / 12);
    TEST_ASSERT_TRUE(ordered > calls / 1000);
}

/* [flight.range_finder_sd_m, flight.range_finder_max_m, flight.terrain_sd_m] */
static void settings_out_of_range_are_named(void) {
    any = check_random_start("flight settings");
    scene_t scene;
    scene_default(&scene);
    scene.camera.width_px = scene.camera.height_px = 1280.0f;
    goe_settings_t estimator = scene_settings(&scene);
    const size_t count = sizeof(goe_flight_settings_t) / sizeof(float);
    for (size_t i = 0; i < count; i++) {
        float values[sizeof(goe_flight_settings_t) / sizeof(float)];
        goe_flight_settings_t settings;
        const char *bad = NULL;
        goe_flight_settings_default(&settings);
        memcpy(values, &settings, sizeof values);
        values[i] = one_in(2) ? (one_in(2) ? 1.0e9f : check_from_bits(0x7FC00001u)) : -1.0f;
        memcpy(&settings, values, sizeof values);
        TEST_ASSERT_EQUAL(GOE_FLIGHT_BAD_SETTINGS,
                          goe_flight_init(&memory.flight, sizeof memory.flight, &estimator, &settings, &bad));
        TEST_ASSERT_NOT_NULL(bad);
        goe_flight_assessment_t a;
        TEST_ASSERT_EQUAL(GOE_FLIGHT_NOT_INITIALIZED, goe_flight_assess(&memory.flight, 0u, false, &a));
    }
    const char *bad = NULL;
    estimator.camera.width_px = 0.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_BAD_SETTINGS,
                      goe_flight_init(&memory.flight, sizeof memory.flight, &estimator, NULL, &bad));
    TEST_ASSERT_EQUAL_STRING("camera.width_px", bad);
    estimator = scene_settings(&scene);
    estimator.camera.fx_px = 0.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_BAD_SETTINGS,
                      goe_flight_init(&memory.flight, sizeof memory.flight, &estimator, NULL, &bad));
    TEST_ASSERT_EQUAL_STRING("camera.fx_px", bad);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_BAD_SETTINGS,
                      goe_flight_init(&memory.flight, sizeof memory.flight, &estimator, NULL, NULL));
    estimator = scene_settings(&scene);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_BAD_ARGUMENT, goe_flight_init(&memory.flight, sizeof memory.flight, NULL, NULL, &bad));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_BAD_ARGUMENT,
                      goe_flight_init(&memory.flight, sizeof memory.flight - 8u, &estimator, NULL, &bad));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_init(&memory.flight, sizeof memory.flight, &estimator, NULL, &bad));
}

/* [goe_flight_attitude_t.q] GIVEN a quaternion whose norm is off 1 by more, or less, than 1 % THEN that alone decides. */
static void a_quaternion_must_be_one(void) {
    goe_flight_attitude_t sample;
    goe_flight_attitude_t later;
    any = check_random_start("flight attitude");
    start();
    memset(&sample, 0, sizeof sample);
    sample.time_us = now_us;
    sample.q[0] = 1.02f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_BAD_ATTITUDE, goe_flight_attitude(&memory.flight, &sample));
    sample.q[0] = 0.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_BAD_ATTITUDE, goe_flight_attitude(&memory.flight, &sample));
    sample.q[0] = 0.992f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_attitude(&memory.flight, &sample));
    later = sample;
    later.time_us += 20000u;
    later.q[2] = check_from_bits(0x7FC00001u);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_NOT_FINITE, goe_flight_attitude(&memory.flight, &later));
}

/* GIVEN a pose and no obstacle THEN none is there, in no slot. */
static void an_empty_slot_contains_nothing(void) {
    goe_flight_obstacle_t o;
    static flown_t flown;
    flown_start(&flown, NULL);
    flown.detects = false;
    (void)flown_fly(&flown, 1.0);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_NOTHING, goe_flight_obstacle(&flown.flight, 0, &o));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_NOTHING, goe_flight_obstacle(&flown.flight, -1, &o));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_NOTHING, goe_flight_obstacle(&flown.flight, GOE_FLIGHT_SLOTS, &o));
}

static void null_pointers_are_refused(void) {
    goe_flight_assessment_t a;
    goe_flight_obstacle_t o;
    goe_pose_t pose;
    uint16_t sector_cm[GOE_FLIGHT_SECTORS];
    goe_flight_settings_default(NULL);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_BAD_ARGUMENT, goe_flight_init(NULL, 0u, NULL, NULL, NULL));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_BAD_ARGUMENT, goe_flight_attitude(&memory.flight, NULL));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_BAD_ARGUMENT, goe_flight_position(&memory.flight, NULL));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_BAD_ARGUMENT, goe_flight_frame(&memory.flight, NULL));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_BAD_ARGUMENT, goe_flight_assess(NULL, 0u, false, &a));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_BAD_ARGUMENT, goe_flight_assess(&memory.flight, 0u, false, NULL));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_BAD_ARGUMENT, goe_flight_obstacle(NULL, 0, &o));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_BAD_ARGUMENT, goe_flight_obstacle(&memory.flight, 0, NULL));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_BAD_ARGUMENT, goe_flight_pose(NULL, 0u, 0u, &pose, NULL));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_BAD_ARGUMENT, goe_flight_pose(&memory.flight, 0u, 0u, NULL, NULL));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_BAD_ARGUMENT, goe_flight_sectors(NULL, 100u, sector_cm));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_BAD_ARGUMENT, goe_flight_sectors(&memory.flight, 100u, NULL));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_BAD_ARGUMENT, goe_flight_timesync(NULL, 0u, 0u));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_BAD_ARGUMENT, goe_flight_restart(NULL));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_NOT_INITIALIZED, goe_flight_restart(&memory.flight));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(anything_does_no_harm);
    RUN_TEST(settings_out_of_range_are_named);
    RUN_TEST(a_quaternion_must_be_one);
    RUN_TEST(an_empty_slot_contains_nothing);
    RUN_TEST(null_pointers_are_refused);
    return UNITY_END();
}
