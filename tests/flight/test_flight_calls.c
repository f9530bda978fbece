/* What each call of goe_flight.h promises, where the path of a whole flight does not show it. SPDX-License-Identifier: MIT
 *
 * An aircraft flies north at 20 m/s, 20 m above the ground; obstacles are kept places, written straight into the table. */
#include <math.h>
#include <string.h>

#include "flown.h"
#include "goe_geometry.h"

#define SPEED_M_S 20.0
#define STEP_US 20000u
#define START_US (0xFFFFFFFFu - 300000u) /* the clock wraps on the way */
#define SAMPLES 60

static check_random_t any;
static flown_t flown;
static goe_flight_t *flight;
static goe_flight_attitude_t attitude;
static goe_flight_position_t position;
static goe_flight_assessment_t now;

static void give(void) {
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_attitude(flight, &attitude));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_position(flight, &position));
}

/* The aircraft as it is so long after the start. */
static void at(uint32_t since_us) {
    attitude.time_us = position.time_us = START_US + since_us;
    position.position_ned_m[0] = (float)(SPEED_M_S * 1.0e-6 * (double)since_us);
}

void setUp(void) {
    any = check_random_start("flight calls");
    flown_start(&flown, NULL);
    flight = &flown.flight;
    memset(&attitude, 0, sizeof attitude);
    memset(&position, 0, sizeof position);
    attitude.q[0] = 1.0f;
    position.position_ned_m[2] = -20.0f;
    position.velocity_ned_m_s[0] = (float)SPEED_M_S;
    position.height_m[GOE_FLIGHT_TERRAIN] = 20.0f;
    position.height_valid = 1u << GOE_FLIGHT_TERRAIN;
    position.origin_known = true;
    position.origin_lat_e7 = 470000000;
    position.origin_lon_e7 = 85000000;
    for (uint32_t k = 0; k < SAMPLES; k++) {
        at(k * STEP_US);
        give();
    }
}
void tearDown(void) {}

static uint32_t newest_us(void) { return START_US + (SAMPLES - 1u) * STEP_US; }

/* Kept after a reset: so far ahead of the aircraft, and to the right. */
static void put(int i, float ahead_m, float right_m, float top_m) {
    goe_flight_slot_t *slot = &flight->slot[i];
    slot->used = slot->remembered = true;
    slot->id = 40u + (uint32_t)i;
    slot->valid = GOE_HAS_POSITION | GOE_HAS_WIDTH | GOE_HAS_HEIGHT;
    slot->center_ne_m[0] = position.position_ned_m[0] + ahead_m;
    slot->center_ne_m[1] = right_m;
    slot->width_m = 6.0f;
    slot->top_m = top_m;
    slot->taken_us = slot->detected_us = newest_us();
}

static goe_flight_status_t assess(uint32_t on_us, uint8_t phase) {
    return goe_flight_assess(flight, newest_us() + on_us, phase, &now);
}

/* -------------------------------------------------------------------------------------------------------------- pose -- */

/* Between samples the position lies on the line; the time goes on over the wrap, and the height is that over the ground. */
static void a_pose_is_that_of_its_time(void) {
    int64_t first_us = 0;
    for (uint32_t k = 0; k < 50u; k++) {
        goe_pose_t pose;
        const uint32_t since_us = (SAMPLES - 26u) * STEP_US + k * STEP_US / 2u;
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_pose(flight, START_US + since_us, 0u, &pose, NULL));
        first_us = k == 0 ? pose.time_us : first_us;
        TEST_ASSERT_TRUE(pose.time_us - first_us == (int64_t)(k * STEP_US / 2u));
        CHECK_CLOSE(1.0e-3, SPEED_M_S * 1.0e-6 * (double)since_us, pose.position_ned_m[0]);
        CHECK_SAME(-20.0f, pose.position_ned_m[2]);
        CHECK_CLOSE(1.0e-3, 20.0 - (double)flight->camera[0].offset_m[2], pose.height_m);
    }
}

/* The height of a pose is that of the camera, which lies aside of the aircraft's position and turns with it. */
static void a_pose_has_the_height_of_the_camera(void) {
    goe_pose_t pose;
    flight->camera[0].offset_m[0] = 1.0f;
    flight->camera[0].offset_m[1] = 0.5f;
    flight->camera[0].offset_m[2] = 0.25f;
    for (int turn = 0; turn < 2; turn++) { /* the nose up by 30 degrees, or the right wing down by 30 degrees */
        attitude.q[0] = cosf(0.2617994f);
        attitude.q[1] = turn ? sinf(0.2617994f) : 0.0f;
        attitude.q[2] = turn ? 0.0f : sinf(0.2617994f);
        at((SAMPLES + (uint32_t)turn) * STEP_US);
        give();
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_pose(flight, attitude.time_us, 0u, &pose, NULL));
        const double below_m = 0.25 * sqrt(0.75) + (turn ? 0.5 * 0.5 : -1.0 * 0.5);
        CHECK_CLOSE(1.0e-4, 20.0 - below_m, pose.height_m);
    }
}

/* GIVEN numbers that a flipped bit has made no numbers THEN there is no pose. */
static void a_pose_of_no_numbers_is_none(void) {
    static const goe_pose_t nothing;
    goe_pose_t pose;
    float sd_deg = 1.0f;
    flight->ground_down_m = NAN;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_NO_POSE, goe_flight_pose(flight, newest_us(), 0u, &pose, &sd_deg));
    TEST_ASSERT_EQUAL_MEMORY(&nothing, &pose, sizeof pose);
    CHECK_SAME(0.0f, sd_deg);
}

/* [goe_flight_attitude_t.q] A norm within 1 % of 1, whatever the parts; an accepted one counts as one of norm 1. */
static void a_norm_within_one_percent_is_taken(void) {
    for (int n = 0; n < 500; n++) {
        double q[4];
        double square = 0.0;
        for (int i = 0; i < 4; i++) {
            q[i] = check_random_between(&any, -1.0, 1.0);
            square += q[i] * q[i];
        }
        const double norm = check_random_between(&any, 0.97, 1.03);
        for (int i = 0; i < 4; i++) {
            attitude.q[i] = (float)(q[i] * norm / sqrt(square));
        }
        attitude.time_us += STEP_US;
        if (fabs(fabs(norm - 1.0) - 0.01) > 1.0e-5) {
            TEST_ASSERT_EQUAL(fabs(norm - 1.0) < 0.01 ? GOE_FLIGHT_OK : GOE_FLIGHT_BAD_ATTITUDE,
                              goe_flight_attitude(flight, &attitude));
        }
    }
    for (int scaled = 0; scaled < 2; scaled++) {
        static goe_flight_obstacle_t obstacle[2];
        setUp();
        put(0, 100.0f, 40.0f, 50.0f);
        const float half = scaled ? 0.7071068f * 0.991f : 0.7071068f;
        attitude.q[0] = attitude.q[3] = half;
        at(SAMPLES * STEP_US);
        give();
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_obstacle(flight, 0, &obstacle[scaled]));
        for (int i = 0; i < 3 && scaled; i++) {
            CHECK_CLOSE(0.01, obstacle[0].nearest_body_m[i], obstacle[1].nearest_body_m[i]);
        }
    }
}

/* [flight.range_finder_sd_m, flight.terrain_sd_m, flight.home_sd_m]
 * A track's height has the sigma of the source that it began with. */
static void a_track_has_the_sigma_of_its_height(void) {
    for (int source = 0; source < GOE_FLIGHT_HEIGHTS; source++) {
        goe_flight_settings_t settings;
        goe_flight_settings_default(&settings);
        settings.confirm_images = 1.0f;
        settings.range_finder_sd_m = 0.5f;
        settings.terrain_sd_m = 2.5f;
        settings.home_sd_m = 4.5f;
        setUp();
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_change_settings(flight, &settings, NULL));
        position.height_m[source] = 20.0f;
        position.height_valid = (uint8_t)(1u << source);
        at(SAMPLES * STEP_US);
        give();
        goe_flight_detection_t detection = flown_detection(&flown, 0);
        goe_flight_frame_t frame = flown_frame(&flown, 0, &detection, 1);
        frame.capture_us = frame.arrival_us = position.time_us;
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_frame(flight, &frame));
        TEST_ASSERT_TRUE(flight->slot[0].used);
        CHECK_SAME(0.5f + 2.0f * (float)source, flight->slot[0].height_sd_m);
        CHECK_CLOSE(1.0e-4, 0.0, flight->slot[0].ground_down_m);
    }
}

/* -------------------------------------------------------------------------------------------------------- assessment -- */

/* [goe_flight_assess] */
static void the_phase_decides_the_action(void) {
    static const uint8_t phase[] = {GOE_FLIGHT_FLYING, GOE_FLIGHT_APPROACH, GOE_FLIGHT_FLARE, GOE_FLIGHT_LANDED};
    static const goe_flight_action_t action[] = {GOE_FLIGHT_CLIMB, GOE_FLIGHT_GO_AROUND, GOE_FLIGHT_NONE,
                                                 GOE_FLIGHT_NONE};
    for (int k = 0; k < 4; k++) {
        int32_t lat_e7;
        int32_t lon_e7;
        setUp();
        put(0, 110.0f, 0.5f, 12.0f);
        for (uint32_t tenth = 0; tenth < 5u; tenth++) {
            TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, assess(tenth * 100000u, phase[k]));
        }
        TEST_ASSERT_EQUAL(action[k], now.action);
        TEST_ASSERT_EQUAL(k < 2 ? GOE_FLIGHT_REASON_CLEAR : GOE_FLIGHT_REASON_LANDING, now.reason);
        TEST_ASSERT_EQUAL(0, now.worst);
        TEST_ASSERT_EQUAL(1, now.obstacles);
        TEST_ASSERT_TRUE(now.hazard.conflict_probability > 0.9f);
        TEST_ASSERT_EQUAL(k < 2 ? 0 : -1, now.avoided);
        if (k < 2) {
            CHECK_CLOSE(0.01, -22.0, now.target_ned_m[2]);
            goe_flight_geometry_lat_lon(470000000, 85000000, now.target_ned_m, &lat_e7, &lon_e7);
            TEST_ASSERT_EQUAL_INT32(lat_e7, now.target_lat_e7);
            TEST_ASSERT_EQUAL_INT32(lon_e7, now.target_lon_e7);
            TEST_ASSERT_EQUAL_UINT32(newest_us() + 300000u, flight->reaction.ordered_us);
        }
    }
}

/* The newest position is moved on by the velocity, for half a second at most. */
static void a_dead_pose_is_not_moved_on(void) {
    float time_s[3];
    for (int k = 0; k < 3; k++) {
        setUp();
        put(0, 200.0f, 60.0f, 50.0f);
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, assess(k == 0 ? 0u : k == 1 ? 500000u : 3000000u, GOE_FLIGHT_FLYING));
        time_s[k] = now.hazard.tcpa_s;
        TEST_ASSERT_EQUAL(k < 2, now.pose_alive);
    }
    CHECK_CLOSE(1.0e-4, time_s[0] - 0.5f, time_s[1]);
    CHECK_SAME(time_s[1], time_s[2]);
}

static void check_nothing_is_known(goe_flight_status_t expected) {
    goe_flight_assessment_t nothing;
    memset(&nothing, 0, sizeof nothing);
    nothing.worst = nothing.avoided = -1;
    memset(&now, 0x5A, sizeof now);
    TEST_ASSERT_EQUAL(expected, assess(0u, GOE_FLIGHT_FLYING));
    TEST_ASSERT_EQUAL_MEMORY(&nothing, &now, sizeof now);
}

/* [GOE_FLIGHT_NO_POSE, GOE_FLIGHT_CORRUPTED, GOE_FLIGHT_NOT_INITIALIZED] */
static void an_assessment_that_fails_knows_nothing(void) {
    put(0, 110.0f, 0.5f, 12.0f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, assess(0u, GOE_FLIGHT_FLYING));
    TEST_ASSERT_EQUAL(0, now.worst);
    flight->slot[0].top_m = NAN;
    check_nothing_is_known(GOE_FLIGHT_CORRUPTED);
    flight->settings.margin_m += 1.0f;
    check_nothing_is_known(GOE_FLIGHT_CORRUPTED);
    flight->settings.margin_m -= 1.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_restart(flight));
    check_nothing_is_known(GOE_FLIGHT_NO_POSE);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_attitude(flight, &attitude));
    check_nothing_is_known(GOE_FLIGHT_NO_POSE);
    flight->tag++;
    check_nothing_is_known(GOE_FLIGHT_NOT_INITIALIZED);
}

/* Images older than delay_max_s do not come any more: to there an obstacle is moved on without one. */
static void an_obstacle_that_is_not_visible_is_moved_on(void) {
    setUp();
    (void)flown_start(&flown, NULL);
    (void)flown_fly(&flown, 3.0);
    const uint32_t taken_us = flight->slot[0].taken_us;
    TEST_ASSERT_TRUE(flight->slot[0].used && flight->slot[0].valid != 0u);
    for (int k = 0; k < 25; k++) { /* samples, and no frames */
        flown_samples(&flown, flown.sample++, &attitude, &position);
        give();
    }
    TEST_ASSERT_EQUAL_UINT32(taken_us, flight->slot[0].taken_us);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_assess(flight, flown_now_us(&flown), GOE_FLIGHT_FLYING, &now));
    TEST_ASSERT_EQUAL_UINT32(flown_now_us(&flown) - 400000u, flight->slot[0].taken_us);
    TEST_ASSERT_TRUE(flight->slot[0].detected_us != flight->slot[0].taken_us);
}

/* An empty frame by the sender's clock, exposed 100 ms ago and sent 95 ms later. */
static goe_flight_status_t send(uint32_t offset_us, uint32_t late_us) {
    goe_flight_frame_t frame;
    memset(&frame, 0, sizeof frame);
    frame.time_base = GOE_FLIGHT_SENDER_CLOCK;
    frame.arrival_us = position.time_us;
    frame.sent_us = frame.arrival_us - 5000u - late_us + offset_us;
    frame.capture_us = frame.sent_us - 95000u;
    return goe_flight_frame(flight, &frame);
}

/* [GOE_FLIGHT_SENDER_CLOCK] GIVEN a sender whose clock was set back, by a restart or by less than a second WHEN its frames look too old THEN they
 * are accepted again: after three frames, or after two intervals of the least delay. */
static void a_sender_whose_clock_was_set_back_is_heard_again(void) {
    static const uint32_t back_us[] = {20000000u, 600000u};
    for (int n = 0; n < 2; n++) {
        const uint32_t offset_us = 50000000u;
        int refused = 0;
        setUp();
        for (uint32_t k = 0; k < 1800u; k++) {
            at((SAMPLES + k) * STEP_US);
            give();
            if (k % 5u != 0u) {
                continue;
            }
            const goe_flight_status_t status = send(k < 600u ? offset_us : offset_us - back_us[n], 0u);
            TEST_ASSERT_TRUE(status == GOE_FLIGHT_OK || (k >= 600u && status == GOE_FLIGHT_TOO_OLD));
            refused += status == GOE_FLIGHT_OK ? 0 : 1;
        }
        check_report("frames refused", (double)refused);
        TEST_ASSERT_TRUE(refused <= (n == 0 ? 2 : 200));
        TEST_ASSERT_EQUAL_UINT32(position.time_us - 80000u - 100000u, flight->capture_us);
    }
}

/* ... WHEN frames come late because they were stuck THEN they stay too old. */
static void a_stuck_frame_stays_too_old(void) {
    for (uint32_t k = 0; k < 100u; k++) {
        at((SAMPLES + k) * STEP_US);
        give();
        TEST_ASSERT_EQUAL(k < 90u ? GOE_FLIGHT_OK : GOE_FLIGHT_TOO_OLD,
                          send(0u, k < 90u ? 0u : 3000000u - (k - 90u) * 80000u));
    }
}

/* [GOE_FLIGHT_SENDER_CLOCK] GIVEN a sender that is silent for 40 minutes, with a clock that drifts THEN its next frame is not late by the drift. */
static void a_silent_sender_is_met_anew(void) {
    for (uint32_t k = 0; k < 2u * 60u * 40u; k++) {
        at((SAMPLES + 25u * k) * STEP_US);
        give();
        if (k == 0u) {
            TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, send(0u, 0u));
        }
    }
    for (uint32_t k = 0; k < 10u; k++) {
        at((SAMPLES + 25u * 2u * 60u * 40u + k) * STEP_US);
        give();
    }
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, send(0u - 120000u, 0u));
    TEST_ASSERT_EQUAL_UINT32(position.time_us - 100000u, flight->capture_us);
}

/* Samples without frames. */
static void fly_blind(int samples) {
    for (int k = 0; k < samples; k++) {
        flown_samples(&flown, flown.sample++, &attitude, &position);
        give();
    }
}

/* A frame of the image so many samples before the newest one. */
static void give_frame(int back, int count) {
    const goe_flight_detection_t detection = flown_detection(&flown, flown.sample - 1 - back);
    const goe_flight_frame_t frame = flown_frame(&flown, flown.sample - 1 - back, &detection, count);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_frame(flight, &frame));
}

/* [flight.delay_max_s] GIVEN samples that come late WHEN an assessment has moved an obstacle on, and an accepted frame shows it THEN the
 * frame is used. */
static void an_accepted_frame_is_used(void) {
    for (int lag = 0; lag < 4; lag++) {
        setUp();
        flown_start(&flown, NULL);
        (void)flown_fly(&flown, 3.0);
        fly_blind(25);
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_assess(flight, flown_now_us(&flown) + (uint32_t)lag * STEP_US,
                                                           GOE_FLIGHT_FLYING, &now));
        TEST_ASSERT_TRUE(flight->slot[0].taken_us != flight->slot[0].detected_us);
        give_frame(19, 1);
        TEST_ASSERT_TRUE(flight->slot[0].in_view);
        TEST_ASSERT_EQUAL_UINT32(flown_now_us(&flown) - 19u * STEP_US, flight->slot[0].taken_us);
        TEST_ASSERT_EQUAL_UINT32(flight->slot[0].taken_us, flight->slot[0].detected_us);
    }
}

/* [F6] GIVEN images that arrive in another order than that of their exposures WHEN an empty one comes before an older one with a detection
 * THEN the estimator cannot use the older one, but the detection counts: where it was, and that it has no new position. An image older than the
 * latest detection changes nothing. */
static void a_detection_in_an_older_image_counts(void) {
    flown_start(&flown, NULL);
    (void)flown_fly(&flown, 3.0);
    fly_blind(15);
    give_frame(1, 0);
    const goe_flight_slot_t before = flight->slot[0];
    TEST_ASSERT_FALSE(before.in_view || before.unlocated);
    give_frame(3, 1);
    TEST_ASSERT_TRUE(flight->slot[0].in_view && flight->slot[0].unlocated);
    TEST_ASSERT_EQUAL_UINT32(flown_now_us(&flown) - 3u * STEP_US, flight->slot[0].detected_us);
    TEST_ASSERT_EQUAL_UINT32(before.taken_us, flight->slot[0].taken_us);
    TEST_ASSERT_TRUE(flight->slot[0].box_px[3] > before.box_px[3]);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, assess(15u * STEP_US, GOE_FLIGHT_FLYING));
    TEST_ASSERT_EQUAL(1, now.unplaced);
    const goe_flight_slot_t after = flight->slot[0];
    give_frame(5, 1);
    TEST_ASSERT_EQUAL_MEMORY(&after, &flight->slot[0], sizeof after);
}

/* ---------------------------------------------------------------------------------------------------------- obstacles -- */

/* [goe_flight_obstacle_t.age_s, goe_flight_obstacle_t.lat_e7, goe_flight_obstacle_t.lon_e7] */
static void an_obstacle_reports_its_age_and_place(void) {
    for (uint32_t k = 0; k < 4u; k++) {
        goe_flight_obstacle_t obstacle;
        int32_t lat_e7;
        int32_t lon_e7;
        put(1, 150.0f, -30.0f, 40.0f);
        flight->slot[1].age_s = 2.0f;
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, assess(k * 100000u, GOE_FLIGHT_FLYING));
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_obstacle(flight, 1, &obstacle));
        CHECK_CLOSE(1.0e-3, 2.0 + 0.1 * (double)k, obstacle.age_s);
        goe_flight_geometry_lat_lon(470000000, 85000000, flight->slot[1].center_ne_m, &lat_e7, &lon_e7);
        TEST_ASSERT_EQUAL_INT32(lat_e7, obstacle.lat_e7);
        TEST_ASSERT_EQUAL_INT32(lon_e7, obstacle.lon_e7);
        TEST_ASSERT_EQUAL_UINT32(41u, obstacle.id);
    }
}

/* Of an obstacle below the aircraft whose top is not known the nearest point lies at the aircraft's height. */
static void an_unknown_top_is_not_taken_for_a_low_one(void) {
    for (int known = 0; known < 2; known++) {
        goe_flight_obstacle_t obstacle;
        put(0, 60.0f, 0.0f, 5.0f);
        flight->slot[0].valid = (uint8_t)(GOE_HAS_POSITION | (known ? GOE_HAS_HEIGHT : 0));
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_obstacle(flight, 0, &obstacle));
        CHECK_CLOSE(1.0e-4, known ? -5.0 : -20.0, obstacle.nearest_ned_m[2]);
        CHECK_CLOSE(1.0e-3, 57.0, obstacle.nearest_body_m[0]);
        CHECK_CLOSE(1.0e-3, known ? 15.0 : 0.0, obstacle.nearest_body_m[2]);
    }
}

/* [goe_flight_obstacle] Each number that a flipped bit has made infinite. */
static void an_obstacle_of_no_numbers_is_corrupted(void) {
    static goe_flight_obstacle_t nothing;
    for (int k = 0; k < 12; k++) {
        goe_flight_obstacle_t obstacle;
        goe_flight_slot_t *slot = &flight->slot[0];
        float *const number[] = {&slot->center_ne_m[0],
                                 &slot->center_ne_m[1],
                                 &slot->covariance_ne_m2[0],
                                 &slot->covariance_ne_m2[1],
                                 &slot->covariance_ne_m2[2],
                                 &slot->ground_down_m,
                                 &slot->top_sd_m,
                                 &slot->width_m,
                                 &slot->length_m,
                                 &slot->length_heading_deg,
                                 &slot->age_s,
                                 &slot->hazard.dcpa_sd_m};
        put(0, 110.0f, 5.0f, 12.0f);
        const float before = *number[k];
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_obstacle(flight, 0, &obstacle));
        *number[k] = INFINITY;
        TEST_ASSERT_EQUAL(GOE_FLIGHT_CORRUPTED, goe_flight_obstacle(flight, 0, &obstacle));
        TEST_ASSERT_EQUAL_MEMORY(&nothing, &obstacle, sizeof obstacle);
        *number[k] = before;
    }
}

/* GIVEN estimators of other slots that lost their settings THEN a track begins with those of its own. */
static void a_track_begins_with_its_own_settings(void) {
    goe_flight_settings_t settings = flight->settings;
    settings.confirm_images = 1.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_change_settings(flight, &settings, NULL));
    for (int i = 1; i < GOE_FLIGHT_SLOTS; i++) {
        memset(&flight->slot[i].estimator, 0xA5, sizeof flight->slot[i].estimator);
    }
    const goe_flight_detection_t detection = flown_detection(&flown, 0);
    goe_flight_frame_t frame = flown_frame(&flown, 0, &detection, 1);
    frame.capture_us = frame.arrival_us = newest_us();
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_frame(flight, &frame));
    TEST_ASSERT_TRUE(flight->slot[0].used);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, assess(0u, GOE_FLIGHT_FLYING));
}

/* [goe_flight_restart] What waited for its confirmation is forgotten too. */
static void a_restart_forgets_waiting_images(void) {
    goe_flight_settings_t settings = flight->settings;
    settings.confirm_images = 2.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_change_settings(flight, &settings, NULL));
    const goe_flight_detection_t detection = flown_detection(&flown, 0);
    goe_flight_frame_t frame = flown_frame(&flown, 0, &detection, 1);
    for (uint32_t k = 0; k < 3u; k++) {
        at((SAMPLES + k) * STEP_US);
        give();
        frame.capture_us = frame.arrival_us = position.time_us;
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_frame(flight, &frame));
        TEST_ASSERT_EQUAL(k == 2u, flight->slot[0].used);
        if (k == 0u) {
            TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_restart(flight));
        }
    }
}

/* ------------------------------------------------------------------------------------------------------------ resets -- */

/* GIVEN a jump of unknown size after a gap of the samples THEN the kept obstacles move by the part that the velocity does not explain. */
static void an_unknown_jump_is_the_unexplained_motion(void) {
    put(0, 100.0f, 5.0f, 12.0f);
    const goe_flight_slot_t before = flight->slot[0];
    at((SAMPLES - 1u) * STEP_US + 400000u);
    position.velocity_ned_m_s[1] = 3.0f; /* from now on */
    position.position_ned_m[0] += 7.0f;
    position.position_ned_m[1] -= 4.0f;
    position.position_ned_m[2] += 2.0f;
    position.reset_horizontal++;
    position.reset_delta_known = false;
    give();
    TEST_ASSERT_EQUAL(1, flight->counters.lost);
    CHECK_CLOSE(0.01, before.center_ne_m[0] + 7.0f, flight->slot[0].center_ne_m[0]);
    CHECK_CLOSE(0.01, before.center_ne_m[1] - 4.0f, flight->slot[0].center_ne_m[1]);
    CHECK_CLOSE(0.01, before.ground_down_m + 2.0f, flight->slot[0].ground_down_m);
}

/* GIVEN such a jump after a gap of more than a second THEN the velocity does not show it, and the kept obstacles stay where they are. */
static void an_unknown_jump_after_a_long_gap_moves_nothing(void) {
    put(0, 100.0f, 5.0f, 12.0f);
    const goe_flight_slot_t before = flight->slot[0];
    at((SAMPLES - 1u) * STEP_US + 1100000u);
    position.position_ned_m[1] += 40.0f; /* the aircraft has turned */
    position.reset_horizontal++;
    position.reset_delta_known = false;
    give();
    TEST_ASSERT_EQUAL(1, flight->counters.lost);
    CHECK_SAME(before.center_ne_m[0], flight->slot[0].center_ne_m[0]);
    CHECK_SAME(before.center_ne_m[1], flight->slot[0].center_ne_m[1]);
}

/* Jumps whose sum is no place any more are unknown ones. */
static void jumps_beyond_all_places_are_unknown(void) {
    position.reset_delta_known = true;
    position.reset_delta_ned_m[0] = 0.6e6f;
    for (uint32_t k = 0; k < 2u; k++) {
        position.reset_horizontal++;
        at((SAMPLES + k) * STEP_US);
        give();
        TEST_ASSERT_EQUAL(1, flight->counters.resets);
        TEST_ASSERT_EQUAL(k, flight->counters.lost);
    }
}

/* ------------------------------------------------------------------------------------------------------------- texts -- */

/* [GOE_FLIGHT_SECTORS] */
static void sectors_stay_in_their_place(void) {
    struct {
        uint16_t before[8], cm[GOE_FLIGHT_SECTORS], behind[8];
    } memory;
    memset(&memory, 0x5A, sizeof memory);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_sectors(flight, 1000u, memory.cm));
    for (int i = 0; i < 8; i++) {
        TEST_ASSERT_EQUAL_HEX16(0x5A5Au, memory.before[i]);
        TEST_ASSERT_EQUAL_HEX16(0x5A5Au, memory.behind[i]);
    }
    for (int i = 0; i < GOE_FLIGHT_SECTORS; i++) {
        TEST_ASSERT_EQUAL_UINT16(GOE_FLIGHT_SECTOR_UNKNOWN, memory.cm[i]); /* no frame came */
    }
}

/* GIVEN a slow climb that would clear an obstacle ahead by far, when the aircraft comes there WHEN the aircraft does not clear it yet THEN its
 * sector has its distance; WHEN it does THEN the obstacle is ignored. */
static void a_climb_clears_no_obstacle_in_advance(void) {
    for (int above = 0; above < 2; above++) {
        uint16_t sector_cm[GOE_FLIGHT_SECTORS];
        put(0, 40.0f, 0.0f, above ? 8.0f : 15.0f);
        flight->velocity_ned_m_s[0] = 1.0f;
        flight->velocity_ned_m_s[2] = -3.0f;
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, assess(0u, GOE_FLIGHT_FLYING));
        TEST_ASSERT_TRUE(now.hazard.clearance_m > 50.0f);
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_sectors(flight, 10000u, sector_cm));
        TEST_ASSERT_EQUAL_UINT16(above ? GOE_FLIGHT_SECTOR_UNKNOWN : 3700u, sector_cm[0]);
    }
}

/* [goe_flight_action_text, goe_flight_reason_text] */
static void texts_are_those_of_the_manual(void) {
    static const char *const actions[] = {"none", "left", "right", "climb", "go_around", "hold", "unknown"};
    static const char *const reasons[] = {"none", "clear", "least_bad", "low", "slow", "landing", "unknown"};
    for (int i = 0; i < 7; i++) {
        TEST_ASSERT_EQUAL_STRING(actions[i], goe_flight_action_text((goe_flight_action_t)i));
        TEST_ASSERT_EQUAL_STRING(reasons[i], goe_flight_reason_text((goe_flight_reason_t)i));
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(a_restart_forgets_waiting_images);
    RUN_TEST(a_pose_is_that_of_its_time);
    RUN_TEST(a_pose_has_the_height_of_the_camera);
    RUN_TEST(a_pose_of_no_numbers_is_none);
    RUN_TEST(a_norm_within_one_percent_is_taken);
    RUN_TEST(a_track_has_the_sigma_of_its_height);
    RUN_TEST(the_phase_decides_the_action);
    RUN_TEST(a_dead_pose_is_not_moved_on);
    RUN_TEST(an_assessment_that_fails_knows_nothing);
    RUN_TEST(an_obstacle_that_is_not_visible_is_moved_on);
    RUN_TEST(a_sender_whose_clock_was_set_back_is_heard_again);
    RUN_TEST(a_stuck_frame_stays_too_old);
    RUN_TEST(a_silent_sender_is_met_anew);
    RUN_TEST(an_accepted_frame_is_used);
    RUN_TEST(a_detection_in_an_older_image_counts);
    RUN_TEST(an_obstacle_reports_its_age_and_place);
    RUN_TEST(an_unknown_top_is_not_taken_for_a_low_one);
    RUN_TEST(an_obstacle_of_no_numbers_is_corrupted);
    RUN_TEST(a_track_begins_with_its_own_settings);
    RUN_TEST(an_unknown_jump_is_the_unexplained_motion);
    RUN_TEST(an_unknown_jump_after_a_long_gap_moves_nothing);
    RUN_TEST(jumps_beyond_all_places_are_unknown);
    RUN_TEST(sectors_stay_in_their_place);
    RUN_TEST(a_climb_clears_no_obstacle_in_advance);
    RUN_TEST(texts_are_those_of_the_manual);
    return UNITY_END();
}
