/* Resets of the autopilot's filter. SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "flown.h"

static flown_t flown;
static flown_t other;

void setUp(void) {
    flown_start(&flown, NULL);
    flown_start(&other, NULL);
    flown.scene.width_m = flown.scene.length_m = 4.0;
    flown.scene.height_m = 12.0;
    other.scene = flown.scene;
}
void tearDown(void) {}

static goe_flight_obstacle_t obstacle_of(const flown_t *of) {
    goe_flight_obstacle_t obstacle;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_obstacle(&of->flight, 0, &obstacle));
    TEST_ASSERT_TRUE((obstacle.valid & GOE_HAS_POSITION) != 0u);
    return obstacle;
}

static void jump(flown_t *of, float north_m, float east_m) {
    of->jump_ned_m[0] = north_m;
    of->jump_ned_m[1] = east_m;
    of->reset_horizontal++;
}

/* GIVEN a flight with a jump whose size is told THEN its track is that of the flight without one, moved by the jump. Positions are
 * floats: 5 m of jump turn their last bits. */
static void a_known_jump_changes_nothing_but_the_place(void) {
    (void)flown_fly(&flown, 2.5);
    (void)flown_fly(&other, 2.5);
    jump(&flown, 5.0f, -3.0f);
    const goe_flight_assessment_t with = flown_fly(&flown, 1.5);
    const goe_flight_assessment_t without = flown_fly(&other, 1.5);
    const goe_flight_obstacle_t moved = obstacle_of(&flown);
    const goe_flight_obstacle_t still = obstacle_of(&other);
    CHECK_CLOSE(0.02, still.center_ned_m[0] + 5.0f, moved.center_ned_m[0]);
    CHECK_CLOSE(0.02, still.center_ned_m[1] - 3.0f, moved.center_ned_m[1]);
    CHECK_CLOSE(0.01, still.width_m, moved.width_m);
    CHECK_CLOSE(0.005, without.hazard.time_s, with.hazard.time_s);
    CHECK_CLOSE(0.02, without.hazard.miss_m, with.hazard.miss_m);
    TEST_ASSERT_EQUAL(1, flown.flight.counters.resets);
    TEST_ASSERT_EQUAL(0, flown.flight.counters.lost);
}

/* At once, also before the next image. */
static void a_known_jump_moves_the_place_before_the_next_image(void) {
    (void)flown_fly(&flown, 3.04); /* an image came with sample 150 */
    const goe_flight_obstacle_t before = obstacle_of(&flown);
    jump(&flown, 5.0f, -3.0f);
    (void)flown_fly(&flown, 0.021); /* one sample */
    const goe_flight_obstacle_t after = obstacle_of(&flown);
    CHECK_CLOSE(1e-3, before.center_ned_m[0] + 5.0f, after.center_ned_m[0]);
    CHECK_CLOSE(1e-3, before.center_ned_m[1] - 3.0f, after.center_ned_m[1]);
}

static void an_unknown_jump_ends_the_tracks(void) {
    (void)flown_fly(&flown, 3.0);
    flown.jump_known = false;
    jump(&flown, 5.0f, -3.0f);
    goe_flight_assessment_t now = flown_fly(&flown, 0.1);
    TEST_ASSERT_EQUAL(0, now.obstacles);
    TEST_ASSERT_EQUAL(-1, now.worst);
    TEST_ASSERT_EQUAL(1, flown.flight.counters.lost);
    now = flown_fly(&flown, 1.9); /* and the obstacle is found anew */
    TEST_ASSERT_EQUAL(1, now.obstacles);
    const goe_flight_obstacle_t again = obstacle_of(&flown);
    TEST_ASSERT_EQUAL_UINT32(7u, again.id);
}

/* A counter that rose by two hides a jump that nobody told. */
static void a_counter_that_skips_is_an_unknown_jump(void) {
    (void)flown_fly(&flown, 3.0);
    flown.reset_horizontal++;
    jump(&flown, 5.0f, -3.0f);
    (void)flown_fly(&flown, 0.1);
    TEST_ASSERT_EQUAL(1, flown.flight.counters.lost);
    TEST_ASSERT_EQUAL(0, flown.flight.counters.resets);
}

static void a_time_of_reset_may_change_by_any_step(void) {
    goe_flight_settings_t settings;
    goe_flight_settings_default(&settings);
    settings.resets = (float)GOE_FLIGHT_RESETS_TIME;
    const scene_t scene = flown.scene;
    flown_start(&flown, &settings);
    flown.scene = scene;
    (void)flown_fly(&flown, 3.0);
    flown.reset_horizontal = 123456u;
    flown.jump_ned_m[0] = 5.0f;
    (void)flown_fly(&flown, 0.1);
    TEST_ASSERT_EQUAL(0, flown.flight.counters.lost);
    TEST_ASSERT_EQUAL(1, flown.flight.counters.resets);
}

static void a_reset_of_the_heading_ends_the_tracks(void) {
    goe_flight_attitude_t attitude;
    goe_flight_position_t position;
    (void)flown_fly(&flown, 3.0);
    flown_samples(&flown, flown.sample, &attitude, &position);
    attitude.reset = 1u;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_attitude(&flown.flight, &attitude));
    goe_pose_t pose;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_NO_POSE, goe_flight_pose(&flown.flight, attitude.time_us - 100000u, 0u, &pose, NULL));
    TEST_ASSERT_EQUAL(1, flown.flight.counters.lost);
}

/* The delta is told again after an image that was refused: it hangs on the slot's latest image that was taken. */
static void a_jump_between_lost_images_is_told_with_the_next_one(void) {
    (void)flown_fly(&flown, 2.5);
    (void)flown_fly(&other, 2.5);
    flown.sees = other.sees = false;
    jump(&flown, 4.0f, 1.0f);
    (void)flown_fly(&flown, 0.5);
    (void)flown_fly(&other, 0.5);
    flown.jump_ned_m[0] = 4.0f;
    flown.sees = other.sees = true;
    (void)flown_fly(&flown, 1.0);
    (void)flown_fly(&other, 1.0);
    const goe_flight_obstacle_t moved = obstacle_of(&flown);
    const goe_flight_obstacle_t still = obstacle_of(&other);
    CHECK_CLOSE(0.02, still.center_ned_m[0] + 4.0f, moved.center_ned_m[0]);
    CHECK_CLOSE(0.02, still.center_ned_m[1] + 1.0f, moved.center_ned_m[1]);
}

/* The autopilot starts anew: its clock begins at 0 again. */
static void a_clock_that_was_set_back_starts_everything_anew(void) {
    flown.start_us = 900000000u;
    (void)flown_fly(&flown, 3.0);
    goe_flight_attitude_t attitude;
    goe_flight_position_t position;
    int refused = 0;
    flown.start_us = 1000u;
    for (int k = 0; k < 100; k++) {
        flown_samples(&flown, k, &attitude, &position);
        refused += goe_flight_attitude(&flown.flight, &attitude) == GOE_FLIGHT_BAD_TIME ? 1 : 0;
        refused += goe_flight_position(&flown.flight, &position) == GOE_FLIGHT_BAD_TIME ? 1 : 0;
    }
    TEST_ASSERT_EQUAL(16, refused);
    TEST_ASSERT_EQUAL(1, flown.flight.counters.lost);
    goe_pose_t pose;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_pose(&flown.flight, attitude.time_us - 50000u, 0u, &pose, NULL));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(a_known_jump_changes_nothing_but_the_place);
    RUN_TEST(a_known_jump_moves_the_place_before_the_next_image);
    RUN_TEST(an_unknown_jump_ends_the_tracks);
    RUN_TEST(a_counter_that_skips_is_an_unknown_jump);
    RUN_TEST(a_time_of_reset_may_change_by_any_step);
    RUN_TEST(a_reset_of_the_heading_ends_the_tracks);
    RUN_TEST(a_jump_between_lost_images_is_told_with_the_next_one);
    RUN_TEST(a_clock_that_was_set_back_starts_everything_anew);
    return UNITY_END();
}
