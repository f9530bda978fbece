/* Flipped bits of the layer's settings and of its estimators. SPDX-License-Identifier: MIT */
#include "goe_flight_seal.h"

#include <string.h>

#include "flown.h"

static flown_t flown;

void setUp(void) {
    flown_start(&flown, NULL);
    scene_make_cylinder(&flown.scene);
    flown.scene.x0_m = 0.0; /* on the way */
    flown.scene.z0_m = 300.0;
}
void tearDown(void) {}

static void flip(void *at, size_t bit) { ((unsigned char *)at)[bit / 8u] ^= (unsigned char)(1u << bit % 8u); }

static goe_flight_status_t assess(goe_flight_assessment_t *now) {
    return goe_flight_assess(&flown.flight, flown_now_us(&flown), false, now);
}

/* [F3] GIVEN any one flipped bit of the sealed memory THEN frames, assessments and sectors report it, and nothing is "clear". */
static void every_flip_of_the_settings_is_reported(void) {
    const size_t first = 8u * offsetof(goe_flight_t, seal);
    const size_t end = 8u * (offsetof(goe_flight_t, attitude_white_sd_deg) + sizeof(float));
    goe_flight_assessment_t now;
    goe_flight_frame_t frame;
    uint16_t sector_cm[GOE_FLIGHT_SECTORS];
    (void)flown_fly(&flown, 3.0);
    memset(&frame, 0, sizeof frame);
    for (size_t bit = first; bit < end; bit++) {
        flip(&flown.flight, bit);
        memset(sector_cm, 0, sizeof sector_cm);
        TEST_ASSERT_EQUAL(GOE_FLIGHT_CORRUPTED, goe_flight_sectors(&flown.flight, 10000u, sector_cm));
        TEST_ASSERT_EACH_EQUAL_UINT16(GOE_FLIGHT_SECTOR_UNKNOWN, sector_cm, GOE_FLIGHT_SECTORS);
        TEST_ASSERT_EQUAL(GOE_FLIGHT_CORRUPTED, assess(&now));
        TEST_ASSERT_EQUAL(GOE_FLIGHT_CORRUPTED, goe_flight_frame(&flown.flight, &frame));
        TEST_ASSERT_EQUAL_INT(-1, now.worst);
        TEST_ASSERT_FALSE(now.detector_alive || now.pose_alive);
        flip(&flown.flight, bit);
    }
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, assess(&now));
}

/* GIVEN an obstacle that violates WHEN settings change in flight THEN it stays known and is judged by the new ones. */
static void settings_change_in_flight_and_nothing_is_lost(void) {
    goe_flight_settings_t settings = flown.flight.settings;
    goe_flight_assessment_t before;
    goe_flight_assessment_t after;
    static goe_flight_t twin;
    (void)flown_fly(&flown, 4.0);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, assess(&before));
    TEST_ASSERT_TRUE(before.worst >= 0);
    twin = flown.flight;
    settings.margin_m = 1.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_change_settings(&flown.flight, &settings, NULL));
    TEST_ASSERT_EQUAL_MEMORY(&twin.attitude_white_sd_deg, &flown.flight.attitude_white_sd_deg,
                             sizeof twin - offsetof(goe_flight_t, attitude_white_sd_deg));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, assess(&after));
    TEST_ASSERT_EQUAL_INT(before.worst, after.worst);
    TEST_ASSERT_TRUE(after.hazard.conflict_probability <
                     before.hazard.conflict_probability); /* a smaller margin is violated less surely */
    settings.margin_m = twin.settings.margin_m;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_change_settings(&flown.flight, &settings, NULL));
    TEST_ASSERT_EQUAL_MEMORY(&twin.settings, &flown.flight.settings, sizeof twin.settings);
    TEST_ASSERT_EQUAL_MEMORY(&twin.seal, &flown.flight.seal, sizeof twin.seal);
}

/* GIVEN settings out of range, no layer or a flipped bit WHEN they are to change THEN all stays as it was. */
static void refused_settings_change_nothing(void) {
    goe_flight_settings_t settings = flown.flight.settings;
    const char *bad = "";
    static goe_flight_t twin;
    twin = flown.flight;
    settings.hold_s = -1.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_BAD_SETTINGS, goe_flight_change_settings(&flown.flight, &settings, &bad));
    TEST_ASSERT_EQUAL_STRING("hold_s", bad);
    TEST_ASSERT_EQUAL_MEMORY(&twin, &flown.flight, sizeof twin);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_BAD_ARGUMENT, goe_flight_change_settings(NULL, NULL, &bad));
    TEST_ASSERT_NULL(bad);
    flip(&flown.flight.settings, 9);
    twin = flown.flight;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_CORRUPTED, goe_flight_change_settings(&flown.flight, NULL, NULL));
    TEST_ASSERT_EQUAL_MEMORY(&twin, &flown.flight, sizeof twin);
    memset(&flown.flight, 0, sizeof flown.flight);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_NOT_INITIALIZED, goe_flight_change_settings(&flown.flight, NULL, NULL));
}

/* GIVEN changed settings WHEN none are passed THEN the defaults hold. */
static void no_settings_are_the_defaults(void) {
    goe_flight_settings_t settings;
    goe_flight_settings_default(&settings);
    settings.hold_s += 1.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_change_settings(&flown.flight, &settings, NULL));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_change_settings(&flown.flight, NULL, NULL));
    goe_flight_settings_default(&settings);
    TEST_ASSERT_EQUAL_MEMORY(&settings, &flown.flight.settings, sizeof settings);
}

static bool is_finite(const void *at, size_t bytes) {
    const unsigned char *from = (const unsigned char *)at;
    for (size_t i = 0; i + sizeof(float) <= bytes; i += sizeof(float)) {
        uint32_t bits;
        memcpy(&bits, &from[i], sizeof bits);
        if ((bits & 0x7F800000u) == 0x7F800000u) {
            return false;
        }
    }
    return true;
}

/* [F1] GIVEN one flipped bit anywhere behind the sealed memory WHEN pose, assessment and obstacles are requested THEN no number is infinite
 * and no enumerator is outside of its list. */
static void no_flipped_bit_makes_an_output_infinite(void) {
    static goe_flight_t whole;
    goe_flight_assessment_t now;
    goe_flight_obstacle_t obstacle;
    goe_pose_t pose;
    float sd_deg;
    (void)flown_fly(&flown, 6.0);
    whole = flown.flight;
    for (size_t bit = 8u * offsetof(goe_flight_t, history); bit < 8u * sizeof whole; bit += 11u) {
        flown.flight = whole;
        flip(&flown.flight, bit);
        (void)goe_flight_pose(&flown.flight, flown_now_us(&flown) - 100000u, 0, &pose, &sd_deg);
        TEST_ASSERT_TRUE(is_finite(pose.position_ned_m, sizeof pose.position_ned_m) &&
                         is_finite(&pose.height_m, sizeof pose.height_m) && is_finite(&sd_deg, sizeof sd_deg));
        (void)assess(&now);
        TEST_ASSERT_TRUE(is_finite(now.target_ned_m, sizeof now.target_ned_m) &&
                         is_finite(&now.needed_s, sizeof now.needed_s) && is_finite(&now.clear_m, sizeof now.clear_m) &&
                         is_finite(&now.hazard, offsetof(goe_hazard_t, has_clearance)));
        TEST_ASSERT_TRUE((unsigned)now.action <= GOE_FLIGHT_HOLD && (unsigned)now.reason <= GOE_FLIGHT_REASON_LANDING);
        for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
            (void)goe_flight_obstacle(&flown.flight, i, &obstacle);
            TEST_ASSERT_TRUE(is_finite(&obstacle.age_s, offsetof(goe_flight_obstacle_t, lat_e7) -
                                                            offsetof(goe_flight_obstacle_t, age_s)) &&
                             is_finite(&obstacle.hazard, offsetof(goe_hazard_t, has_clearance)));
        }
    }
}

/* GIVEN bools of a message that are neither 0 nor 1 THEN they count as 1 (the sanitizers would notice one that is loaded). */
static void a_bool_of_any_bits_counts_as_set(void) {
    goe_flight_attitude_t attitude;
    goe_flight_position_t position;
    (void)flown_fly(&flown, 2.0);
    flown_samples(&flown, flown.sample, &attitude, &position);
    memset(&position.origin_known, 255, sizeof position.origin_known);
    memset(&position.reset_delta_known, 2, sizeof position.reset_delta_known);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_attitude(&flown.flight, &attitude));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_position(&flown.flight, &position));
    TEST_ASSERT_TRUE(flown.flight.origin_known == 1);
    goe_flight_detection_t detection = flown_detection(&flown, flown.sample - 6);
    memset(&detection.top.visible, 255, sizeof detection.top.visible);
    memset(&detection.base_near.visible, 2, sizeof detection.base_near.visible);
    const goe_flight_frame_t frame = flown_frame(&flown, flown.sample - 6, &detection, 1);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_frame(&flown.flight, &frame));
}

/* GIVEN a position but no attitude since an unknown reset THEN every sector is unknown, whatever is kept. */
static void no_sector_is_known_without_a_pose(void) {
    goe_flight_attitude_t attitude;
    goe_flight_position_t position;
    uint16_t sector_cm[GOE_FLIGHT_SECTORS];
    (void)flown_fly(&flown, 4.0);
    flown_samples(&flown, flown.sample, &attitude, &position);
    position.reset_horizontal++;
    position.reset_delta_known = false;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_position(&flown.flight, &position));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_NO_POSE, goe_flight_sectors(&flown.flight, 20000u, sector_cm));
    for (int i = 0; i < GOE_FLIGHT_SECTORS; i++) {
        TEST_ASSERT_EQUAL_UINT16(GOE_FLIGHT_SECTOR_UNKNOWN, sector_cm[i]);
    }
}

/* One sample and a frame on, whatever becomes of them. */
static void step_anyhow(void) {
    goe_flight_attitude_t attitude;
    goe_flight_position_t position;
    flown_samples(&flown, flown.sample, &attitude, &position);
    flown.sample++;
    (void)goe_flight_attitude(&flown.flight, &attitude);
    (void)goe_flight_position(&flown.flight, &position);
    const goe_flight_detection_t detection = flown_detection(&flown, flown.sample - 6);
    const goe_flight_frame_t frame = flown_frame(&flown, flown.sample - 6, &detection, 1);
    (void)goe_flight_frame(&flown.flight, &frame);
}

static int known_slot(void) {
    for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
        if (flown.flight.slot[i].used) {
            return i;
        }
    }
    return -1;
}

/* GIVEN an obstacle ahead WHEN a setting or the state of its track is lost in its estimator THEN it stays the worst one, no less
 * likely to be hit and suspect, until the estimator, started again with the settings of another, knows its position again. */
static void warning_outlasts(size_t offset) {
    const goe_flight_assessment_t before = flown_fly(&flown, 7.0);
    const int slot = known_slot();
    goe_flight_slot_t *s = &flown.flight.slot[slot];
    const goe_settings_t settings = s->estimator.settings;
    TEST_ASSERT_TRUE(before.worst == slot && before.hazard.conflict_probability > 0.5f && !before.suspect);
    memset((unsigned char *)&s->estimator + offset, 0xFF, sizeof(float));
    bool remembered = false;
    for (int k = 0; k < 20; k++) {
        const goe_flight_assessment_t now = flown_fly(&flown, 0.2);
        TEST_ASSERT_EQUAL_INT(slot, now.worst);
        TEST_ASSERT_TRUE(now.hazard.conflict_probability > 0.4f);
        TEST_ASSERT_TRUE(now.suspect || !s->remembered);
        remembered = remembered || s->remembered;
    }
    TEST_ASSERT_TRUE(remembered);
    TEST_ASSERT_FALSE(s->remembered);
    TEST_ASSERT_EQUAL_MEMORY(&settings, &s->estimator.settings, sizeof settings);
    goe_flight_obstacle_t obstacle;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_obstacle(&flown.flight, slot, &obstacle));
    TEST_ASSERT_TRUE((obstacle.valid & GOE_HAS_POSITION) != 0u);
}

/* [F4] GIVEN a warning WHEN the settings of its estimator, or its track, are lost THEN position, hazard and warning stay, suspect. */
static void a_warning_outlasts_its_estimators_settings(void) {
    warning_outlasts(offsetof(goe_estimator_t, settings.camera.fx_px));
}

static void a_warning_outlasts_its_track(void) { warning_outlasts(offsetof(goe_estimator_t, motion.origin_ne_m)); }

/* GIVEN that the settings of every estimator are lost WHEN one of them must start again THEN the layer must be started again. */
static void without_any_settings_the_layer_says_so(void) {
    goe_flight_assessment_t now;
    (void)flown_fly(&flown, 7.0);
    for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
        flip(&flown.flight.slot[i].estimator, 8u * offsetof(goe_estimator_t, settings) + 40u);
    }
    goe_flight_status_t status = GOE_FLIGHT_OK;
    for (int k = 0; k < 50 && status == GOE_FLIGHT_OK; k++) {
        step_anyhow();
        status = assess(&now);
    }
    TEST_ASSERT_EQUAL(GOE_FLIGHT_CORRUPTED, status);
    TEST_ASSERT_FALSE(goe_flight_is_sealed(&flown.flight));
}

/* [F2] GIVEN indices and counts that are out of their arrays THEN no call reads or writes there; the order that there is not is none. */
static void indices_stay_in_their_arrays(void) {
    goe_flight_assessment_t now;
    (void)flown_fly(&flown, 7.0);
    const int slot = known_slot();
    const goe_flight_t good = flown.flight;
    for (int value = 0; value < 256; value++) {
        flown.flight = good;
        flown.flight.history.attitude_next = flown.flight.history.position_count = (uint8_t)value;
        flown.flight.history.position_next = flown.flight.history.attitude_count = (uint8_t)(255 - value);
        flown.flight.reaction.slot = (int8_t)(value - 128);
        flown.flight.reaction.action = (uint8_t)value;
        flown.flight.slot[slot].camera = (uint8_t)value;
        flown.flight.slot[slot].model = (uint8_t)value;
        flown.flight.had_frame = (uint8_t)value;
        flown.flight.ground_source = (uint8_t)value;
        step_anyhow();
        (void)assess(&now);
        TEST_ASSERT_TRUE((int)now.action >= GOE_FLIGHT_NONE && (int)now.action <= GOE_FLIGHT_HOLD);
        TEST_ASSERT_TRUE(now.avoided >= -1 && now.avoided < GOE_FLIGHT_SLOTS);
        goe_flight_obstacle_t obstacle;
        (void)goe_flight_obstacle(&flown.flight, slot, &obstacle);
        TEST_ASSERT_TRUE((int)obstacle.model <= GOE_MODEL_PRISM);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(no_flipped_bit_makes_an_output_infinite);
    RUN_TEST(a_bool_of_any_bits_counts_as_set);
    RUN_TEST(no_sector_is_known_without_a_pose);
    RUN_TEST(settings_change_in_flight_and_nothing_is_lost);
    RUN_TEST(refused_settings_change_nothing);
    RUN_TEST(no_settings_are_the_defaults);
    RUN_TEST(every_flip_of_the_settings_is_reported);
    RUN_TEST(a_warning_outlasts_its_estimators_settings);
    RUN_TEST(a_warning_outlasts_its_track);
    RUN_TEST(without_any_settings_the_layer_says_so);
    RUN_TEST(indices_stay_in_their_arrays);
    return UNITY_END();
}
