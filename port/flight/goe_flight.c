/* Public functions of the flight layer: settings, samples, frames, assessment, sectors. SPDX-License-Identifier: MIT */
#include "goe_flight.h"

#include <math.h>

#include "goe_candidate.h"
#include "goe_clear.h"
#include "goe_clock.h"
#include "goe_flight_maths.h"
#include "goe_flight_seal.h"
#include "goe_geometry.h"
#include "goe_history.h"
#include "goe_lookout.h"
#include "goe_marks.h"
#include "goe_parts.h"
#include "goe_reaction.h"
#include "goe_table.h"
#include "goe_travel.h"

#define TAG 0x474F4546u
#define POSITION_MAX_M 1.0e6f
#define VELOCITY_MAX_M_S 1.0e3f
#define HEIGHT_MAX_M 1.0e5f
#define NORM_TOLERANCE 0.01f
#define ATTITUDE_SD_MAX_DEG 30.0f
#define LATITUDE_MAX_E7 890000000
#define LONGITUDE_MAX_E7 1800000000
#define SET_BACK_US 1000000     /* a time that is so much older than the newest one is of another clock */
#define UNASSESSED_US 300000000 /* five minutes */
#define STALE_MAX 16            /* samples in a row that are not newer: the clock was set back */
#define POSE_ALIVE_S 0.5f
#define GUESS_MAX_S 1.0f /* longest gap between samples over which the velocity shows a jump */
#define SECTOR_MAX_CM 65000u
#define NOBODY (-1)
/* Bits of goe_flight_obstacle_t.valid. */
#define REPORTED (GOE_HAS_POSITION | GOE_HAS_HEIGHT | GOE_HAS_WIDTH | GOE_HAS_LENGTH | GOE_HAS_ORIENTATION)

#define UNLOCATED_DEG 5.0f /* possible change of bearing from a detection without a position to the next one */
#define DEPTH_SHARE 0.25f  /* of the range: an obstacle of unknown length may reach so much nearer than its outline */

#define OUTLINED (GOE_HAS_POSITION | GOE_HAS_WIDTH) /* bits of an obstacle with position and outline */

/* ---------------------------------------------------------------------------------------------------------- settings -- */

typedef struct {
    const char *name;
    float least, most;
} range_t;

#define GOE_FLIGHT_SETTING(field, least, most, usual) {#field, least, most},
static const range_t ranges[] = {
#include "goe_flight_settings_list.h"
};
#undef GOE_FLIGHT_SETTING

enum { SETTINGS = sizeof ranges / sizeof ranges[0] };
GOE_STATIC_ASSERT(sizeof(goe_flight_settings_t) == SETTINGS * sizeof(float), flight_settings_are_listed);

void goe_flight_settings_default(goe_flight_settings_t *settings) {
    if (settings) {
#define GOE_FLIGHT_SETTING(field, least, most, usual) settings->field = usual;
#include "goe_flight_settings_list.h"
#undef GOE_FLIGHT_SETTING
    }
}

/* The name of the first setting outside its range, or of a fraction that must be a whole number; null: none. */
static const char *find_bad(const goe_flight_settings_t *settings) {
    float value[SETTINGS];
    memcpy(value, settings, sizeof value);
    for (int i = 0; i < SETTINGS; i++) {
        if (!goe_flight_finite(value[i]) || value[i] < ranges[i].least || value[i] > ranges[i].most) {
            return ranges[i].name;
        }
    }
    if (settings->resets > 0.0f && settings->resets < 1.0f) {
        return "resets";
    }
    return (float)(int)settings->confirm_images < settings->confirm_images ? "confirm_images" : NULL;
}

static const char *init_slots(goe_flight_t *flight, const goe_settings_t *estimator) {
    const char *bad = NULL;
    for (int i = 0; i < GOE_FLIGHT_SLOTS && !bad; i++) {
        goe_estimator_t *one = &flight->slot[i].estimator;
        if (goe_init(one, sizeof *one, estimator, &bad) != GOE_OK && !bad) {
            bad = "estimator";
        }
    }
    return bad;
}

static const goe_camera_t *camera_settings(const goe_settings_t *estimator, int number) {
#if GOE_CAMERAS_MAX > 1
    return number > 0 ? &estimator->more_cameras[number - 1] : &estimator->camera;
#else
    (void)number;
    return &estimator->camera;
#endif
}

static const char *init_cameras(goe_flight_t *flight, const goe_settings_t *estimator) {
    for (int i = 0; i < GOE_CAMERAS_MAX; i++) {
        const goe_camera_t *camera = camera_settings(estimator, i);
        if (!(camera->fx_px > 0.0f)) {
            continue;
        }
        if (!(camera->width_px > 0.0f)) {
            return "camera.width_px";
        }
        if (!(camera->height_px > 0.0f)) {
            return "camera.height_px";
        }
        goe_flight_geometry_camera(&flight->camera[i], camera);
    }
    return NULL;
}

static bool has_camera(const goe_flight_t *flight, int number) {
    return number < GOE_CAMERAS_MAX && flight->camera[number].focal_px[0] > 0.0f;
}

static void forget(goe_flight_t *flight) {
    goe_flight_history_clear(&flight->history);
    memset(&flight->marks, 0, sizeof flight->marks);
    memset(flight->clock, 0, sizeof flight->clock);
    memset(&flight->waiting, 0, sizeof flight->waiting);
    memset(flight->parts, 0, sizeof flight->parts);
    memset(flight->velocity_ned_m_s, 0, sizeof flight->velocity_ned_m_s);
    memset(&flight->travel, 0, sizeof flight->travel);
    goe_flight_reaction_clear(&flight->reaction);
    flight->base_us = 0; /* the next sample may be of another clock */
    flight->had_frame = 0;
    flight->origin_known = false;
    for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
        goe_flight_slot_begin(&flight->slot[i], 0u, 0u);
        flight->slot[i].used = false;
    }
}

goe_flight_status_t goe_flight_init(goe_flight_t *flight, size_t flight_size, const goe_settings_t *estimator,
                                    const goe_flight_settings_t *settings, const char **bad_field) {
    if (bad_field) {
        *bad_field = NULL;
    }
    if (!flight || !estimator || flight_size != sizeof *flight) {
        return GOE_FLIGHT_BAD_ARGUMENT;
    }
    memset(flight, 0, sizeof *flight);
    goe_flight_settings_default(&flight->settings);
    if (settings) {
        flight->settings = *settings;
    }
    const char *bad = find_bad(&flight->settings);
    bad = bad ? bad : init_slots(flight, estimator);
    bad = bad ? bad : init_cameras(flight, estimator);
    if (bad) {
        if (bad_field) {
            *bad_field = bad;
        }
        return GOE_FLIGHT_BAD_SETTINGS;
    }
    flight->attitude_white_sd_deg = estimator->navigation.attitude_white_sd_deg;
    forget(flight);
    goe_flight_seal(flight);
    flight->tag = TAG;
    return GOE_FLIGHT_OK;
}

static goe_flight_status_t check_ready(const goe_flight_t *flight) {
    if (!flight) {
        return GOE_FLIGHT_BAD_ARGUMENT;
    }
    return flight->tag == TAG ? GOE_FLIGHT_OK : GOE_FLIGHT_NOT_INITIALIZED;
}

/* Also checks the seal, for calls that depend on the settings. */
static goe_flight_status_t check_sealed(const goe_flight_t *flight) {
    const goe_flight_status_t ready = check_ready(flight);
    return ready == GOE_FLIGHT_OK && !goe_flight_is_sealed(flight) ? GOE_FLIGHT_CORRUPTED : ready;
}

goe_flight_status_t goe_flight_change_settings(goe_flight_t *flight, const goe_flight_settings_t *settings,
                                               const char **bad_field) {
    const goe_flight_status_t sealed = check_sealed(flight);
    goe_flight_settings_t wanted;
    goe_flight_settings_default(&wanted);
    if (settings) {
        wanted = *settings;
    }
    const char *bad = find_bad(&wanted);
    if (bad_field) {
        *bad_field = sealed == GOE_FLIGHT_OK ? bad : NULL;
    }
    if (sealed != GOE_FLIGHT_OK || bad) {
        return sealed != GOE_FLIGHT_OK ? sealed : GOE_FLIGHT_BAD_SETTINGS;
    }
    flight->settings = wanted;
    goe_flight_seal(flight);
    return GOE_FLIGHT_OK;
}

goe_flight_status_t goe_flight_restart(goe_flight_t *flight) {
    const goe_flight_status_t status = check_ready(flight);
    if (status == GOE_FLIGHT_OK) {
        forget(flight);
        goe_flight_count(&flight->counters.lost);
    }
    return status;
}

/* ----------------------------------------------------------------------------------------------------------- samples -- */

static goe_flight_status_t refuse(goe_flight_t *flight, goe_flight_status_t status) {
    goe_flight_count(&flight->counters.refused);
    return status;
}

/* Refuses a sample that is not newer. Many of one kind show that the clock was set back, or that one sample had a time of the future. */
static goe_flight_status_t refuse_time(goe_flight_t *flight, uint8_t *stale) {
    (*stale)++;
    if (*stale >= STALE_MAX) {
        (void)goe_flight_restart(flight);
    }
    return refuse(flight, GOE_FLIGHT_BAD_TIME);
}

static bool camera_alive(const goe_flight_t *flight, int number, uint32_t now_us) {
    return ((flight->had_frame >> number) & 1u) != 0u &&
           goe_flight_between_s(now_us, flight->frame_us[number]) <= flight->settings.detector_timeout_s;
}

/* Whether the latest complete image of a camera is recent enough to clear sectors. */
static bool view_alive(const goe_flight_t *flight, int number, uint32_t now_us) {
    const goe_flight_parts_t *parts = &flight->parts[number];
    return parts->viewed && goe_flight_between_s(now_us, parts->viewed_us) <= flight->settings.detector_timeout_s;
}

/* A dead input stays dead until its next message. Otherwise, times of half an hour ago would look like future times. */
static void bury(goe_flight_t *flight, uint32_t now_us) {
    for (int i = 0; i < GOE_CAMERAS_MAX; i++) {
        if (!camera_alive(flight, i, now_us)) {
            flight->had_frame = (uint8_t)(flight->had_frame & ~(1u << i));
        }
        flight->parts[i].viewed = view_alive(flight, i, now_us);
        goe_flight_clock_bury(&flight->clock[i], now_us);
    }
}

/* Advances base_us, the newest time, which does not wrap. After a reset the history is empty, and a time that is a little older is no other
 * clock. An assessment of long ago counts as one of now: otherwise, its time would look like one of the future after half an hour. */
static void advance(goe_flight_t *flight, uint32_t time_us) {
    const int32_t on_us = goe_flight_between_us(time_us, (uint32_t)flight->base_us);
    const bool empty = flight->history.attitude_count + flight->history.position_count == 0;
    const bool first = empty && (flight->base_us == 0 || on_us < -SET_BACK_US);
    if (first || on_us > 0) {
        flight->base_us += (uint32_t)on_us;
    }
    if (first || goe_flight_between_us((uint32_t)flight->base_us, flight->assessed_us) > UNASSESSED_US) {
        flight->assessed_us = (uint32_t)flight->base_us;
    }
    bury(flight, (uint32_t)flight->base_us);
}

static void lose_everything(goe_flight_t *flight) {
    goe_flight_history_clear(&flight->history);
    for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
        goe_flight_slot_lose(&flight->slot[i]);
    }
    goe_flight_candidate_crowd(&flight->waiting, (uint32_t)flight->base_us); /* bearings may have jumped */
    goe_flight_count(&flight->counters.lost);
}

static bool is_unit(const float q[4]) {
    const float square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    const float least = (1.0f - NORM_TOLERANCE) * (1.0f - NORM_TOLERANCE);
    const float most = (1.0f + NORM_TOLERANCE) * (1.0f + NORM_TOLERANCE);
    return square >= least && square <= most;
}

/* Whether a sample would be accepted: it is newer than the newest of its kind, or the first. */
static bool is_newer(uint8_t count, const uint32_t *newest_us, uint32_t time_us) {
    return count == 0 || goe_flight_between_us(time_us, *newest_us) > 0;
}

goe_flight_status_t goe_flight_attitude(goe_flight_t *flight, const goe_flight_attitude_t *sample) {
    const goe_flight_status_t ready = sample ? check_ready(flight) : GOE_FLIGHT_BAD_ARGUMENT;
    if (ready != GOE_FLIGHT_OK) {
        return ready;
    }
    if (!goe_flight_all_finite(sample->q, 4)) {
        return refuse(flight, GOE_FLIGHT_NOT_FINITE);
    }
    if (!goe_flight_all_within(sample->q, 4, 2.0f) || !is_unit(sample->q)) {
        return refuse(flight, GOE_FLIGHT_BAD_ATTITUDE);
    }
    const goe_flight_history_attitude_t *newest = goe_flight_history_newest_attitude(&flight->history);
    if (newest && !is_newer(flight->history.attitude_count, &newest->time_us, sample->time_us)) {
        return refuse_time(flight, &flight->history.attitude_stale);
    }
    if (goe_flight_marks_attitude(&flight->marks, sample->reset) != GOE_FLIGHT_MARKS_SAME) {
        lose_everything(flight);
    }
    const float norm = sqrtf(sample->q[0] * sample->q[0] + sample->q[1] * sample->q[1] + sample->q[2] * sample->q[2] +
                             sample->q[3] * sample->q[3]);
    const float q[4] = {sample->q[0] / norm, sample->q[1] / norm, sample->q[2] / norm, sample->q[3] / norm};
    advance(flight, sample->time_us);
    (void)goe_flight_history_add_attitude(&flight->history, sample->time_us, q);
    flight->history.attitude_stale = 0;
    return GOE_FLIGHT_OK;
}

static goe_flight_status_t check_position(const goe_flight_position_t *p) {
    const bool finite = goe_flight_all_finite(p->position_ned_m, 3) && goe_flight_all_finite(p->velocity_ned_m_s, 3);
    if (!finite) {
        return GOE_FLIGHT_NOT_FINITE;
    }
    bool within = goe_flight_all_within(p->position_ned_m, 3, POSITION_MAX_M) &&
                  goe_flight_all_within(p->velocity_ned_m_s, 3, VELOCITY_MAX_M_S);
    for (int i = 0; i < GOE_FLIGHT_HEIGHTS; i++) {
        if ((p->height_valid >> i) & 1u) {
            if (!goe_flight_finite(p->height_m[i])) {
                return GOE_FLIGHT_NOT_FINITE;
            }
            within = within && goe_flight_within(p->height_m[i], HEIGHT_MAX_M);
        }
    }
    if (goe_flight_is_set(&p->origin_known)) {
        within = within && p->origin_lat_e7 >= -LATITUDE_MAX_E7 && p->origin_lat_e7 <= LATITUDE_MAX_E7 &&
                 p->origin_lon_e7 >= -LONGITUDE_MAX_E7 && p->origin_lon_e7 <= LONGITUDE_MAX_E7;
    }
    return within ? GOE_FLIGHT_OK : GOE_FLIGHT_OUT_OF_RANGE;
}

/* Checks the jump, which counts only if a mark changed; then it must be finite. */
static goe_flight_status_t check_delta(const goe_flight_t *flight, const goe_flight_position_t *p) {
    const bool changed = flight->marks.position_known && (flight->marks.horizontal != p->reset_horizontal ||
                                                          flight->marks.vertical != p->reset_vertical);
    if (!changed || !goe_flight_is_set(&p->reset_delta_known)) {
        return GOE_FLIGHT_OK;
    }
    if (!goe_flight_all_finite(p->reset_delta_ned_m, 3)) {
        return GOE_FLIGHT_NOT_FINITE;
    }
    return goe_flight_all_within(p->reset_delta_ned_m, 3, POSITION_MAX_M) ? GOE_FLIGHT_OK : GOE_FLIGHT_OUT_OF_RANGE;
}

/* Estimates an unknown jump as well as possible: the position minus its prediction by the velocity. The kept obstacles move along. After a
 * reset of the attitude, the history is empty. After a long gap, the velocity is not that of the gap, and the jump counts as 0. */
static void guess_jump(const goe_flight_t *flight, const goe_flight_position_t *sample, float jump_ned_m[3]) {
    const goe_flight_history_position_t *newest = goe_flight_history_newest_position(&flight->history);
    uint32_t from_us;
    float from_ned_m[3];
    bool known = goe_flight_travel_end(&flight->travel, from_ned_m, &from_us);
    if (newest) {
        known = true;
        from_us = newest->time_us;
        memcpy(from_ned_m, newest->ned_m, sizeof from_ned_m);
    }
    const float s = goe_flight_between_s(sample->time_us, from_us);
    known = known && s >= 0.0f && s <= GUESS_MAX_S;
    for (int i = 0; known && i < 3; i++) {
        jump_ned_m[i] = sample->position_ned_m[i] - from_ned_m[i] - s * flight->velocity_ned_m_s[i];
    }
}

static void move_places(goe_flight_t *flight, const float jump_ned_m[3]) {
    for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
        goe_flight_slot_shift(&flight->slot[i], jump_ned_m);
    }
    goe_flight_reaction_shift(&flight->reaction, jump_ned_m);
}

static void follow_reset(goe_flight_t *flight, const goe_flight_position_t *sample) {
    float jump_ned_m[3] = {0.0f, 0.0f, 0.0f};
    const bool counters = !(flight->settings.resets > 0.5f);
    const goe_flight_marks_change_t change = goe_flight_marks_position(&flight->marks, sample, counters, jump_ned_m);
    if (change == GOE_FLIGHT_MARKS_UNKNOWN) {
        guess_jump(flight, sample, jump_ned_m);
        move_places(flight, jump_ned_m);
        lose_everything(flight);
        goe_flight_travel_restart(&flight->travel);
    } else if (change == GOE_FLIGHT_MARKS_JUMP) {
        goe_flight_history_shift(&flight->history, jump_ned_m);
        move_places(flight, jump_ned_m);
        goe_flight_travel_shift(&flight->travel, jump_ned_m);
        goe_flight_count(&flight->counters.resets);
    }
}

/* Sets the ground from the best source of this sample. */
static void note_ground(goe_flight_t *flight, const goe_flight_position_t *sample) {
    flight->ground_source = GOE_FLIGHT_HOME;
    flight->ground_down_m = 0.0f;
    for (int i = GOE_FLIGHT_HEIGHTS - 1; i >= 0; i--) {
        const float height_m = sample->height_m[i];
        const bool valid = ((sample->height_valid >> i) & 1u) != 0u && (height_m > 0.0f || height_m < 0.0f);
        if (valid && (i != GOE_FLIGHT_RANGE_FINDER || height_m <= flight->settings.range_finder_max_m)) {
            flight->ground_source = (uint8_t)i;
            flight->ground_down_m = sample->position_ned_m[2] + height_m;
        }
    }
}

goe_flight_status_t goe_flight_position(goe_flight_t *flight, const goe_flight_position_t *sample) {
    goe_flight_status_t status = sample ? check_ready(flight) : GOE_FLIGHT_BAD_ARGUMENT;
    if (status != GOE_FLIGHT_OK) {
        return status;
    }
    status = check_position(sample);
    if (status == GOE_FLIGHT_OK) {
        status = check_delta(flight, sample);
    }
    if (status != GOE_FLIGHT_OK) {
        return refuse(flight, status);
    }
    const goe_flight_history_position_t *newest = goe_flight_history_newest_position(&flight->history);
    if (newest && !is_newer(flight->history.position_count, &newest->time_us, sample->time_us)) {
        return refuse_time(flight, &flight->history.position_stale);
    }
    follow_reset(flight, sample);
    advance(flight, sample->time_us);
    (void)goe_flight_history_add_position(&flight->history, sample->time_us, sample->position_ned_m);
    goe_flight_travel_take(&flight->travel, sample);
    flight->history.position_stale = 0;
    memcpy(flight->velocity_ned_m_s, sample->velocity_ned_m_s, sizeof flight->velocity_ned_m_s);
    note_ground(flight, sample);
    flight->origin_known = goe_flight_is_set(&sample->origin_known);
    flight->origin_lat_e7 = flight->origin_known ? sample->origin_lat_e7 : 0;
    flight->origin_lon_e7 = flight->origin_known ? sample->origin_lon_e7 : 0;
    return GOE_FLIGHT_OK;
}

/* -------------------------------------------------------------------------------------------------------------- pose -- */

static float attitude_sd_deg(const goe_flight_t *flight, const goe_flight_history_pose_t *pose, uint32_t time_sd_us) {
    const float late_deg = pose->rate_deg_s * (float)time_sd_us * GOE_FLIGHT_S_PER_US;
    const float square = goe_flight_square(flight->attitude_white_sd_deg) + goe_flight_square(pose->spread_deg) +
                         goe_flight_square(late_deg);
    return goe_flight_smaller(sqrtf(square), ATTITUDE_SD_MAX_DEG);
}

static float height_sd_m(const goe_flight_t *flight) {
    const goe_flight_settings_t *settings = &flight->settings;
    const float terrain_sd_m =
        flight->ground_source == GOE_FLIGHT_TERRAIN ? settings->terrain_sd_m : settings->home_sd_m;
    return flight->ground_source == GOE_FLIGHT_RANGE_FINDER ? settings->range_finder_sd_m : terrain_sd_m;
}

/* Returns false only after a flipped bit. */
static bool is_finite_view(const goe_flight_slot_view_t *view) {
    return goe_flight_all_finite(view->pose.ned_m, 3) && goe_flight_all_finite(view->pose.q, 4) &&
           goe_flight_finite(view->attitude_sd_deg) && goe_flight_finite(view->ground_down_m) &&
           goe_flight_finite(view->height_sd_m);
}

static goe_flight_status_t look_back(const goe_flight_t *flight, uint32_t time_us, uint32_t time_sd_us,
                                     goe_flight_slot_view_t *view) {
    memset(view, 0, sizeof *view);
    const goe_flight_status_t status = goe_flight_history_at(&flight->history, time_us, &view->pose);
    if (status == GOE_FLIGHT_OK) {
        view->time_us = time_us;
        view->estimator_us = flight->base_us + goe_flight_between_us(time_us, (uint32_t)flight->base_us);
        view->attitude_sd_deg = attitude_sd_deg(flight, &view->pose, time_sd_us);
        view->ground_down_m = flight->ground_down_m;
        view->height_sd_m = height_sd_m(flight);
        if (!is_finite_view(view)) {
            memset(view, 0, sizeof *view);
            return GOE_FLIGHT_NO_POSE;
        }
    }
    return status;
}

goe_flight_status_t goe_flight_pose(const goe_flight_t *flight, uint32_t time_us, uint32_t time_sd_us, goe_pose_t *pose,
                                    float *sd_deg) {
    goe_flight_slot_view_t view;
    float body_to_ned[9];
    float arm[3];
    if (sd_deg) {
        *sd_deg = 0.0f;
    }
    if (!pose) {
        return GOE_FLIGHT_BAD_ARGUMENT;
    }
    memset(pose, 0, sizeof *pose);
    goe_flight_status_t status = check_ready(flight);
    if (status == GOE_FLIGHT_OK) {
        status = look_back(flight, time_us, time_sd_us, &view);
    }
    if (status != GOE_FLIGHT_OK) {
        return status;
    }
    goe_flight_rotation(view.pose.q, body_to_ned);
    goe_flight_turn(body_to_ned, flight->camera[0].offset_m, arm);
    pose->time_us = view.estimator_us;
    memcpy(pose->position_ned_m, view.pose.ned_m, sizeof pose->position_ned_m);
    memcpy(pose->attitude, view.pose.q, sizeof pose->attitude);
    pose->height_m = view.ground_down_m - view.pose.ned_m[2] - arm[2];
    if (!goe_flight_finite(pose->height_m)) { /* a flipped bit */
        memset(pose, 0, sizeof *pose);
        return GOE_FLIGHT_NO_POSE;
    }
    if (sd_deg) {
        *sd_deg = view.attitude_sd_deg;
    }
    return GOE_FLIGHT_OK;
}

/* ------------------------------------------------------------------------------------------------------------- frame -- */

goe_flight_status_t goe_flight_timesync(goe_flight_t *flight, uint32_t offset_us, uint32_t sd_us) {
    const goe_flight_status_t status = check_ready(flight);
    for (int i = 0; i < GOE_CAMERAS_MAX && status == GOE_FLIGHT_OK; i++) {
        goe_flight_clock_sync(&flight->clock[i], offset_us, sd_us);
    }
    return status;
}

static goe_flight_status_t check_frame(const goe_flight_t *flight, const goe_flight_frame_t *frame) {
    if (frame->time_base > GOE_FLIGHT_AGE || frame->count > GOE_FLIGHT_DETECTIONS ||
        !has_camera(flight, frame->camera)) {
        return GOE_FLIGHT_OUT_OF_RANGE;
    }
    return frame->count > 0 && !frame->detection ? GOE_FLIGHT_BAD_ARGUMENT : GOE_FLIGHT_OK;
}

static goe_flight_status_t find_view(goe_flight_t *flight, const goe_flight_frame_t *frame, goe_flight_clock_t *clock,
                                     goe_flight_slot_view_t *view) {
    uint32_t sd_us;
    const uint32_t capture_us = goe_flight_clock_capture(clock, frame, &flight->settings, &sd_us);
    goe_flight_status_t status = look_back(flight, capture_us, sd_us, view);
    const float delay_s = goe_flight_between_s((uint32_t)flight->base_us, capture_us);
    view->camera = frame->camera;
    if (status == GOE_FLIGHT_OK && delay_s > flight->settings.delay_max_s) {
        status = GOE_FLIGHT_TOO_OLD;
    }
    return status;
}

goe_flight_status_t goe_flight_frame(goe_flight_t *flight, const goe_flight_frame_t *frame) {
    goe_flight_slot_view_t view;
    goe_flight_status_t status = frame ? check_sealed(flight) : GOE_FLIGHT_BAD_ARGUMENT;
    if (status != GOE_FLIGHT_OK) {
        return status;
    }
    status = check_frame(flight, frame);
    if (status != GOE_FLIGHT_OK) {
        return refuse(flight, status);
    }
    goe_flight_clock_t clock = flight->clock[frame->camera]; /* not kept if the frame may come again */
    status = find_view(flight, frame, &clock, &view);
    if (status == GOE_FLIGHT_OK || status == GOE_FLIGHT_TOO_OLD) {
        flight->clock[frame->camera] = clock; /* all frames look too old after the sender's clock was set back */
    }
    if (status != GOE_FLIGHT_OK) {
        goe_flight_count(status == GOE_FLIGHT_TOO_NEW ? &flight->counters.early : &flight->counters.late);
        return status;
    }
    flight->capture_us = view.time_us;
    if (goe_flight_table_take(flight, &view, frame)) {
        flight->had_frame = (uint8_t)(flight->had_frame | 1u << frame->camera);
        flight->frame_us[frame->camera] = (uint32_t)flight->base_us;
    }
    goe_flight_count(&flight->counters.taken);
    return GOE_FLIGHT_OK;
}

/* -------------------------------------------------------------------------------------------------------- assessment -- */

/* The newest position, extrapolated by the velocity. */
static void find_own(const goe_flight_t *flight, uint32_t now_us, goe_flight_reaction_own_t *own) {
    const goe_flight_history_position_t *newest = goe_flight_history_newest_position(&flight->history);
    const float on_s = goe_flight_clamped(goe_flight_between_s(now_us, newest->time_us), 0.0f, POSE_ALIVE_S);
    own->time_us = now_us;
    for (int i = 0; i < 3; i++) {
        own->ned_m[i] = newest->ned_m[i] + on_s * flight->velocity_ned_m_s[i];
    }
}

/* Images older than delay_max_s are refused, so the estimates are predicted up to that time. It counts from the newest sample, as in
 * find_view(): a prediction beyond it would make the estimator ignore images that are accepted. */
static void catch_up(goe_flight_t *flight, uint32_t now_us) {
    goe_flight_slot_view_t view;
    const uint32_t delay_us = (uint32_t)(flight->settings.delay_max_s * 1.0e6f);
    if (look_back(flight, (uint32_t)flight->base_us - delay_us, 0u, &view) == GOE_FLIGHT_OK) {
        goe_flight_table_follow(flight, &view);
    }
    goe_flight_table_age(flight, now_us);
}

static bool pose_alive(const goe_flight_t *flight, uint32_t now_us) {
    const goe_flight_history_attitude_t *attitude = goe_flight_history_newest_attitude(&flight->history);
    const goe_flight_history_position_t *position = goe_flight_history_newest_position(&flight->history);
    return attitude && position && !flight->travel.doubted &&
           goe_flight_between_s(now_us, attitude->time_us) <= POSE_ALIVE_S &&
           goe_flight_between_s(now_us, position->time_us) <= POSE_ALIVE_S;
}

static bool detector_alive(const goe_flight_t *flight, uint32_t now_us) {
    bool alive = true;
    for (int i = 0; i < GOE_CAMERAS_MAX; i++) {
        alive = alive && (camera_alive(flight, i, now_us) || !has_camera(flight, i));
    }
    return alive;
}

static void copy_hazard(const goe_flight_slot_t *slot, goe_hazard_t *hazard) {
    *hazard = slot->hazard;
    hazard->has_clearance = goe_flight_is_set(&slot->hazard.has_clearance);
}

static void report_action(const goe_flight_t *flight, goe_flight_assessment_t *result) {
    const goe_flight_reaction_t *reaction = &flight->reaction;
    result->action = (goe_flight_action_t)reaction->action;
    result->late = reaction->late;
    result->avoided = reaction->slot;
    result->reason = (goe_flight_reason_t)reaction->reason;
    result->clear_m = reaction->clear_m;
    if (reaction->action != GOE_FLIGHT_NONE) {
        memcpy(result->target_ned_m, reaction->target_ned_m, sizeof result->target_ned_m);
        if (flight->origin_known) {
            goe_flight_geometry_lat_lon(flight->origin_lat_e7, flight->origin_lon_e7, reaction->target_ned_m,
                                        &result->target_lat_e7, &result->target_lon_e7);
        }
    }
}

static void report(const goe_flight_t *flight, int worst, uint32_t now_us, goe_flight_assessment_t *result) {
    result->detector_alive = detector_alive(flight, now_us);
    result->pose_alive = pose_alive(flight, now_us);
    result->pose_agrees = !flight->travel.doubted;
    result->worst = (int8_t)worst;
    for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
        const goe_flight_slot_t *slot = &flight->slot[i];
        result->obstacles = (uint8_t)(result->obstacles + (slot->assessed ? 1 : 0));
        result->unplaced = (uint8_t)(result->unplaced + (goe_flight_slot_is_unplaced(slot) ? 1 : 0));
    }
    result->unplaced = (uint8_t)(result->unplaced + goe_flight_candidate_count(&flight->waiting));
    if (worst != NOBODY) {
        copy_hazard(&flight->slot[worst], &result->hazard);
        result->suspect = flight->slot[worst].suspect;
    }
    report_action(flight, result);
}

static bool is_finite_hazard(const goe_hazard_t *hazard) {
    const float number[] = {hazard->tcpa_s,    hazard->dcpa_m,         hazard->clearance_m,         hazard->tcpa_sd_s,
                            hazard->dcpa_sd_m, hazard->clearance_sd_m, hazard->conflict_probability};
    return goe_flight_all_finite(number, (int)(sizeof number / sizeof number[0]));
}

/* Returns false only after a flipped bit. */
static bool is_finite_assessment(const goe_flight_assessment_t *a) {
    return goe_flight_all_finite(a->target_ned_m, 3) && goe_flight_finite(a->needed_s) &&
           goe_flight_finite(a->clear_m) && is_finite_hazard(&a->hazard);
}

static void know_nothing(goe_flight_assessment_t *result) {
    memset(result, 0, sizeof *result);
    result->worst = result->avoided = NOBODY;
}

goe_flight_status_t goe_flight_assess(goe_flight_t *flight, uint32_t now_us, uint8_t phase,
                                      goe_flight_assessment_t *result) {
    goe_flight_reaction_own_t own;
    if (!result) {
        return GOE_FLIGHT_BAD_ARGUMENT;
    }
    know_nothing(result);
    const goe_flight_status_t status = check_sealed(flight);
    if (status != GOE_FLIGHT_OK) {
        return status;
    }
    if (!goe_flight_history_newest_attitude(&flight->history) ||
        !goe_flight_history_newest_position(&flight->history)) {
        return GOE_FLIGHT_NO_POSE;
    }
    const bool past = goe_flight_between_us(now_us, (uint32_t)flight->base_us) < 0;
    const uint32_t now = past ? (uint32_t)flight->base_us : now_us;
    find_own(flight, now, &own);
    own.approach = phase == GOE_FLIGHT_APPROACH;
    own.grounded = phase == GOE_FLIGHT_FLARE || phase == GOE_FLIGHT_LANDED;
    bury(flight, now);
    catch_up(flight, now);
    const int worst = goe_flight_lookout_assess(flight, own.ned_m, now);
    flight->assessed_us = now;
    result->needed_s = goe_flight_reaction_decide(flight, worst, &own);
    report(flight, worst, now, result);
    if (!is_finite_assessment(result)) {
        know_nothing(result);
        return GOE_FLIGHT_CORRUPTED;
    }
    return GOE_FLIGHT_OK;
}

/* ---------------------------------------------------------------------------------------------------------- obstacles -- */

static void report_nearest(const goe_flight_t *flight, const goe_flight_slot_t *slot, goe_flight_obstacle_t *obstacle) {
    const goe_flight_history_position_t *own = goe_flight_history_newest_position(&flight->history);
    const goe_flight_history_attitude_t *attitude = goe_flight_history_newest_attitude(&flight->history);
    float body_to_ned[9];
    const float north = slot->center_ne_m[0] - own->ned_m[0];
    const float east = slot->center_ne_m[1] - own->ned_m[1];
    const float distance_m = sqrtf(north * north + east * east);
    const float share =
        distance_m > goe_flight_slot_radius_m(slot) ? (distance_m - goe_flight_slot_radius_m(slot)) / distance_m : 0.0f;
    const float top_down_m = slot->ground_down_m - slot->top_m;
    const bool over = (slot->valid & GOE_HAS_HEIGHT) != 0u && own->ned_m[2] < top_down_m;
    const float away[3] = {share * north, share * east, over ? top_down_m - own->ned_m[2] : 0.0f};
    for (int i = 0; i < 3; i++) {
        obstacle->nearest_ned_m[i] = own->ned_m[i] + away[i];
    }
    goe_flight_rotation(attitude->q, body_to_ned);
    goe_flight_turn_back(body_to_ned, away, obstacle->nearest_body_m);
}

static void report_place(const goe_flight_t *flight, const goe_flight_slot_t *slot, goe_flight_obstacle_t *obstacle) {
    obstacle->center_ned_m[0] = slot->center_ne_m[0];
    obstacle->center_ned_m[1] = slot->center_ne_m[1];
    obstacle->center_ned_m[2] = slot->ground_down_m;
    memcpy(obstacle->covariance_ne_m2, slot->covariance_ne_m2, sizeof obstacle->covariance_ne_m2);
    obstacle->radius_m = goe_flight_slot_radius_m(slot);
    obstacle->width_m = slot->width_m;
    obstacle->length_m = slot->length_m;
    obstacle->height_m = slot->top_m;
    obstacle->height_sd_m = slot->top_sd_m;
    obstacle->length_heading_deg = slot->length_heading_deg;
    if (flight->origin_known) {
        goe_flight_geometry_lat_lon(flight->origin_lat_e7, flight->origin_lon_e7, slot->center_ne_m, &obstacle->lat_e7,
                                    &obstacle->lon_e7);
    }
    report_nearest(flight, slot, obstacle);
}

static bool is_finite_obstacle(const goe_flight_obstacle_t *o) {
    const float number[] = {o->age_s,   o->radius_m, o->height_m,          o->height_sd_m,
                            o->width_m, o->length_m, o->length_heading_deg};
    return goe_flight_all_finite(number, (int)(sizeof number / sizeof number[0])) &&
           goe_flight_all_finite(o->center_ned_m, 3) && goe_flight_all_finite(o->covariance_ne_m2, 3) &&
           goe_flight_all_finite(o->nearest_ned_m, 3) && goe_flight_all_finite(o->nearest_body_m, 3) &&
           is_finite_hazard(&o->hazard);
}

goe_flight_status_t goe_flight_obstacle(const goe_flight_t *flight, int slot, goe_flight_obstacle_t *obstacle) {
    if (!obstacle) {
        return GOE_FLIGHT_BAD_ARGUMENT;
    }
    memset(obstacle, 0, sizeof *obstacle);
    const goe_flight_status_t status = check_ready(flight);
    if (status != GOE_FLIGHT_OK) {
        return status;
    }
    if (slot < 0 || slot >= GOE_FLIGHT_SLOTS || !flight->slot[slot].used) {
        return GOE_FLIGHT_NOTHING;
    }
    if (!goe_flight_history_newest_attitude(&flight->history) ||
        !goe_flight_history_newest_position(&flight->history)) {
        return GOE_FLIGHT_NO_POSE;
    }
    const goe_flight_slot_t *one = &flight->slot[slot];
    obstacle->id = one->id;
    obstacle->valid = one->valid & REPORTED;
    obstacle->model = one->model <= GOE_MODEL_PRISM ? (goe_model_t)one->model : GOE_MODEL_NONE;
    obstacle->suspect = one->suspect;
    obstacle->in_view = one->in_view;
    obstacle->has_hazard = one->assessed;
    copy_hazard(one, &obstacle->hazard);
    obstacle->receding = one->assessed && !(one->hazard.tcpa_s > 0.0f);
    if (one->valid & GOE_HAS_POSITION) {
        obstacle->age_s = goe_flight_lookout_age_s(one, flight->assessed_us);
        report_place(flight, one, obstacle);
    }
    if (!is_finite_obstacle(obstacle)) {
        memset(obstacle, 0, sizeof *obstacle);
        return GOE_FLIGHT_CORRUPTED;
    }
    return GOE_FLIGHT_OK;
}

/* Whether the aircraft clears the top at present, and at the closest approach. A climb alone, which may end, clears nothing. */
static bool is_passed_over(const goe_flight_t *flight, int i, float own_down_m) {
    const goe_flight_slot_t *slot = &flight->slot[i];
    const goe_hazard_t *hazard = &slot->hazard;
    return slot->assessed && !goe_flight_clear_counts(flight, i, own_down_m) &&
           goe_flight_is_set(&hazard->has_clearance) && hazard->tcpa_s > 0.0f &&
           hazard->clearance_m - 2.0f * hazard->clearance_sd_m >
               goe_flight_lookout_doubt(flight, slot) * flight->settings.clearance_m;
}

static void know_no_sector(uint16_t sector_cm[GOE_FLIGHT_SECTORS]) {
    for (int i = 0; i < GOE_FLIGHT_SECTORS; i++) {
        sector_cm[i] = GOE_FLIGHT_SECTOR_UNKNOWN;
    }
}

/* Marks as clear the sectors that the latest complete images show, for cameras whose detectors are alive. */
static void open_sectors(const goe_flight_t *flight, uint32_t max_cm, uint16_t sector_cm[GOE_FLIGHT_SECTORS]) {
    const uint32_t newest_us = (uint32_t)flight->base_us;
    const bool later = goe_flight_between_us(flight->assessed_us, newest_us) > 0;
    const uint32_t now_us = later ? flight->assessed_us : newest_us;
    const bool alive = pose_alive(flight, now_us) && !flight->waiting.crowded;
    know_no_sector(sector_cm);
    for (int i = 0; i < GOE_CAMERAS_MAX; i++) {
        const goe_flight_parts_t *parts = &flight->parts[i];
        if (alive && view_alive(flight, i, now_us) && camera_alive(flight, i, now_us)) {
            goe_flight_geometry_open_sectors(sector_cm, max_cm, &flight->camera[i], parts->q, parts->above_m);
        }
    }
}

/* By how much an obstacle may be nearer than its estimate: two sigmas; any distance if it is suspect. */
static float nearer_m(const goe_flight_slot_t *slot, const float away_ne_m[2]) {
    return slot->suspect ? POSITION_MAX_M : 2.0f * goe_flight_slot_sd_along_m(slot, away_ne_m[0], away_ne_m[1]);
}

/* The box of an obstacle reaches beyond its outline if the obstacle extends far back, as a wall at the side does. Its near end may then be
 * nearer than its sigma shows. The box therefore counts, unless the whole outline is well beyond max_cm. */
static bool may_reach(const goe_flight_t *flight, int i, uint32_t max_cm) {
    const goe_flight_slot_t *slot = &flight->slot[i];
    const goe_flight_history_position_t *own = goe_flight_history_newest_position(&flight->history);
    if (!own || !slot->in_view || is_passed_over(flight, i, own->ned_m[2])) {
        return false;
    }
    const float away[2] = {slot->center_ne_m[0] - own->ned_m[0], slot->center_ne_m[1] - own->ned_m[1]};
    const float far_m =
        (slot->valid & GOE_HAS_LENGTH) != 0u ? 0.0f : DEPTH_SHARE * sqrtf(away[0] * away[0] + away[1] * away[1]);
    return goe_flight_geometry_reaches(max_cm, away, goe_flight_slot_radius_m(slot), nearer_m(slot, away) + far_m);
}

/* Makes sectors unknown: those of detections without a position, with an old one or without a width; those of the other boxes. */
static void close_sectors(const goe_flight_t *flight, uint32_t max_cm, uint16_t sector_cm[GOE_FLIGHT_SECTORS]) {
    for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
        const goe_flight_slot_t *slot = &flight->slot[i];
        if (slot->used && ((slot->valid & OUTLINED) != OUTLINED || slot->unlocated)) {
            goe_flight_geometry_close_sectors(sector_cm, &slot->bearings, UNLOCATED_DEG);
        } else if (slot->used && may_reach(flight, i, max_cm)) {
            goe_flight_geometry_close_sectors(sector_cm, &slot->bearings, 0.0f);
        }
    }
    for (int i = 0; i < GOE_FLIGHT_CANDIDATES; i++) {
        if (flight->waiting.place[i].images != 0) {
            goe_flight_geometry_close_sectors(sector_cm, &flight->waiting.place[i].bearings, UNLOCATED_DEG);
        }
    }
}

goe_flight_status_t goe_flight_sectors(const goe_flight_t *flight, uint32_t max_cm,
                                       uint16_t sector_cm[GOE_FLIGHT_SECTORS]) {
    const goe_flight_status_t status = sector_cm ? check_sealed(flight) : GOE_FLIGHT_BAD_ARGUMENT;
    if (status == GOE_FLIGHT_CORRUPTED) {
        know_no_sector(sector_cm);
    }
    if (status != GOE_FLIGHT_OK) {
        return status;
    }
    if (max_cm < 1u || max_cm > SECTOR_MAX_CM) {
        return GOE_FLIGHT_OUT_OF_RANGE;
    }
    const goe_flight_history_attitude_t *attitude = goe_flight_history_newest_attitude(&flight->history);
    const goe_flight_history_position_t *own = goe_flight_history_newest_position(&flight->history);
    open_sectors(flight, max_cm, sector_cm);
    close_sectors(flight, max_cm, sector_cm);
    for (int i = 0; i < GOE_FLIGHT_SLOTS && attitude && own; i++) {
        const goe_flight_slot_t *slot = &flight->slot[i];
        if (slot->used && (slot->valid & GOE_HAS_POSITION) != 0u && !is_passed_over(flight, i, own->ned_m[2])) {
            const float away[2] = {slot->center_ne_m[0] - own->ned_m[0], slot->center_ne_m[1] - own->ned_m[1]};
            goe_flight_geometry_enter_circle(sector_cm, max_cm, away, goe_flight_slot_radius_m(slot),
                                             nearer_m(slot, away));
        }
    }
    return attitude && own ? GOE_FLIGHT_OK : GOE_FLIGHT_NO_POSE;
}

const char *goe_flight_action_text(goe_flight_action_t action) {
    switch (action) {
        case GOE_FLIGHT_NONE:
            return "none";
        case GOE_FLIGHT_LEFT:
            return "left";
        case GOE_FLIGHT_RIGHT:
            return "right";
        case GOE_FLIGHT_CLIMB:
            return "climb";
        case GOE_FLIGHT_GO_AROUND:
            return "go_around";
        case GOE_FLIGHT_HOLD:
            return "hold";
        default:
            return "unknown";
    }
}

const char *goe_flight_reason_text(goe_flight_reason_t reason) {
    switch (reason) {
        case GOE_FLIGHT_REASON_NONE:
            return "none";
        case GOE_FLIGHT_REASON_CLEAR:
            return "clear";
        case GOE_FLIGHT_REASON_LEAST_BAD:
            return "least_bad";
        case GOE_FLIGHT_REASON_LOW:
            return "low";
        case GOE_FLIGHT_REASON_SLOW:
            return "slow";
        case GOE_FLIGHT_REASON_LANDING:
            return "landing";
        default:
            return "unknown";
    }
}
