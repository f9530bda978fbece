/* Resets of the autopilot's filter. SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "flown.h"
#include "goe_history.h"

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

/* GIVEN a flight with a jump whose size is given THEN its track is that of the
 * flight without one, moved by the jump. Positions are floats: 5 m of jump turn
 * their last bits. */
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
    CHECK_CLOSE(0.005, without.hazard.tcpa_s, with.hazard.tcpa_s);
    CHECK_CLOSE(0.02, without.hazard.dcpa_m, with.hazard.dcpa_m);
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

/* GIVEN a warning WHEN the autopilot's filter jumps by an unknown amount THEN
 * the track ends, and the obstacle is kept where it was relative to the
 * aircraft, suspect, with its hazard, until images place it again. */
static void an_unknown_jump_takes_no_warning_back(void) {
    const goe_flight_assessment_t before = flown_fly(&flown, 3.0);
    const goe_flight_obstacle_t at = obstacle_of(&flown);
    flown.jump_known = false;
    jump(&flown, 50.0f, -30.0f);
    goe_flight_assessment_t now = flown_fly(&flown, 0.1);
    TEST_ASSERT_EQUAL(1, flown.flight.counters.lost);
    TEST_ASSERT_EQUAL(1, now.obstacles);
    TEST_ASSERT_EQUAL(0, now.worst);
    TEST_ASSERT_TRUE(now.suspect);
    TEST_ASSERT_TRUE(now.hazard.conflict_probability >= before.hazard.conflict_probability);
    const double due_s = (double)before.hazard.tcpa_s - 0.1; /* to the outline; now to the circle about it, which
                               is entered sooner */
    TEST_ASSERT_TRUE((double)now.hazard.tcpa_s < due_s + 0.03 && (double)now.hazard.tcpa_s > due_s - 0.3);
    const goe_flight_obstacle_t kept = obstacle_of(&flown);
    CHECK_CLOSE(1.0, at.center_ned_m[0] + 50.0f, kept.center_ned_m[0]);
    CHECK_CLOSE(1.0, at.center_ned_m[1] - 30.0f, kept.center_ned_m[1]);
    now = flown_fly(&flown, 1.9); /* and the obstacle is found again */
    TEST_ASSERT_EQUAL(1, now.obstacles);
    TEST_ASSERT_FALSE(flown.flight.slot[0].remembered);
    const goe_flight_obstacle_t again = obstacle_of(&flown);
    TEST_ASSERT_EQUAL_UINT32(7u, again.id);
}

/* ... also WHEN a reset of the heading comes in the same sample, and empties
 * the history. */
static void an_unknown_jump_after_a_reset_of_the_heading_moves_the_places(void) {
    goe_flight_attitude_t attitude;
    goe_flight_position_t position;
    (void)flown_fly(&flown, 3.0);
    const goe_flight_obstacle_t at = obstacle_of(&flown);
    flown.flight.reaction.target_ned_m[0] = 90.0f;
    flown.jump_known = false;
    jump(&flown, 50.0f, -30.0f);
    flown_samples(&flown, flown.sample, &attitude, &position);
    attitude.reset = 1u;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_attitude(&flown.flight, &attitude));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_position(&flown.flight, &position));
    TEST_ASSERT_EQUAL(2, flown.flight.counters.lost);
    const goe_flight_slot_t *kept = &flown.flight.slot[0];
    CHECK_CLOSE(1.0, at.center_ned_m[0] + 50.0f, kept->center_ne_m[0]);
    CHECK_CLOSE(1.0, at.center_ned_m[1] - 30.0f, kept->center_ne_m[1]);
    CHECK_CLOSE(1.0, 140.0, flown.flight.reaction.target_ned_m[0]);
}

/* Without any position before, no jump is known. */
static void an_unknown_jump_without_a_position_moves_nothing(void) {
    goe_flight_attitude_t attitude;
    goe_flight_position_t position;
    flown_samples(&flown, 0, &attitude, &position);
    flown.flight.marks.position_known = true;
    position.reset_horizontal = 5u;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_position(&flown.flight, &position));
    TEST_ASSERT_EQUAL(1, flown.flight.counters.lost);
    CHECK_SAME(0.0f, flown.flight.reaction.target_ned_m[0]);
    CHECK_SAME(0.0f, flown.flight.slot[0].center_ne_m[0]);
}

/* -------------------------------------------------------------------------------------------------------------
 * down -- */

static void jump_down(flown_t *of, float down_m, bool height_follows) {
    for (int i = 0; i < 3; i++) {
        of->jumped_ned_m[i] += of->jump_ned_m[i];
        of->jump_ned_m[i] = 0.0f;
    }
    of->jump_ned_m[2] = down_m;
    of->height_follows = height_follows;
    of->reset_vertical++;
}

static void check_same_but_for_down(double down_m) {
    const goe_flight_obstacle_t moved = obstacle_of(&flown);
    const goe_flight_obstacle_t still = obstacle_of(&other);
    for (int i = 0; i < 3; i++) {
        const double jumped_m = i == 2 ? down_m : 0.0;
        CHECK_CLOSE(0.01, (double)still.center_ned_m[i] + jumped_m, moved.center_ned_m[i]);
        CHECK_CLOSE(0.01, (double)still.nearest_ned_m[i] + jumped_m, moved.nearest_ned_m[i]);
        CHECK_CLOSE(0.01, still.nearest_body_m[i], moved.nearest_body_m[i]);
    }
    TEST_ASSERT_EQUAL_HEX(still.valid, moved.valid);
    TEST_ASSERT_TRUE((moved.valid & GOE_HAS_HEIGHT) != 0u);
    TEST_ASSERT_EQUAL(still.suspect, moved.suspect);
    CHECK_CLOSE(0.01, still.height_m, moved.height_m);
    CHECK_CLOSE(0.01, still.width_m, moved.width_m);
    CHECK_CLOSE(0.01, still.hazard.clearance_m, moved.hazard.clearance_m);
    CHECK_CLOSE(0.01, still.hazard.conflict_probability, moved.hazard.conflict_probability);
}

/* GIVEN a descent, by boxes or by points WHEN down jumps by a known amount, the
 * height that the autopilot gives with it or not THEN the track's ground moves
 * along, and neither place, height nor hazard move, as the aircraft sees them.
 */
static void a_known_jump_of_down_moves_the_ground_along(void) {
    for (int run = 0; run < 8; run++) {
        setUp();
        flown.scene.glide_deg = other.scene.glide_deg = 3.0;
        flown.points = other.points = run % 2 != 0;
        (void)flown_fly(&flown, 2.5);
        (void)flown_fly(&other, 2.5);
        jump_down(&flown, run / 4 != 0 ? -3.5f : 6.0f, run / 2 % 2 != 0);
        (void)flown_fly(&flown, 0.5);
        (void)flown_fly(&other, 0.5);
        check_same_but_for_down(run / 4 != 0 ? -3.5 : 6.0);
        jump_down(&flown, 2.0f, flown.height_follows);
        (void)flown_fly(&flown, 1.5);
        (void)flown_fly(&other, 1.5);
        check_same_but_for_down(run / 4 != 0 ? -1.5 : 8.0);
        TEST_ASSERT_EQUAL(2, flown.flight.counters.resets);
        TEST_ASSERT_EQUAL(0, flown.flight.counters.lost);
    }
}

/* GIVEN a descent, and jumps of down in it THEN boxes count by the height that
 * is left, which follows from the changes of down. */
static void boxes_count_by_the_height_that_is_left(void) {
    goe_image_t image;
    scene_truth_t truth;
    flown.scene.glide_deg = 6.0;
    flown.scene.altitude_m = 40.0;
    for (int k = 0; k < 3; k++) {
        (void)flown_fly(&flown, 1.5);
        const int shown = (flown.sample - 1 - FLOWN_DELAY) / FLOWN_IMAGE_EVERY * FLOWN_IMAGE_EVERY;
        scene_image(&flown.scene, shown, &image, &truth);
        const goe_estimator_t *estimator = &flown.flight.slot[0].estimator;
        CHECK_CLOSE(0.01, truth.height_above_ground_m, estimator->motion.height_m);
        CHECK_CLOSE(0.01, truth.height_above_ground_m, estimator->filter.datum.height_m);
        jump_down(&flown, k == 0 ? 5.0f : -3.0f, k == 1);
    }
    TEST_ASSERT_TRUE(truth.height_above_ground_m < 34.0);
}

/* At once, also before the next image. */
static void a_known_jump_of_down_moves_the_ground_before_the_next_image(void) {
    (void)flown_fly(&flown, 3.04); /* an image came with sample 150 */
    const goe_flight_obstacle_t before = obstacle_of(&flown);
    jump_down(&flown, 4.0f, false);
    (void)flown_fly(&flown, 0.021); /* one sample */
    const goe_flight_obstacle_t after = obstacle_of(&flown);
    CHECK_CLOSE(1e-3, before.center_ned_m[2] + 4.0f, after.center_ned_m[2]);
    CHECK_CLOSE(1e-3, before.center_ned_m[0], after.center_ned_m[0]);
    CHECK_CLOSE(1e-3, before.height_m, after.height_m);
}

/* Between images that saw nothing, and after them: the next one reports the
 * jump. */
static void a_jump_of_down_between_lost_images_counts(void) {
    flown.scene.glide_deg = other.scene.glide_deg = 3.0;
    (void)flown_fly(&flown, 2.5);
    (void)flown_fly(&other, 2.5);
    flown.detects = other.detects = false;
    jump_down(&flown, -5.0f, true);
    (void)flown_fly(&flown, 0.5);
    (void)flown_fly(&other, 0.5);
    flown.detects = other.detects = true;
    (void)flown_fly(&flown, 1.0);
    (void)flown_fly(&other, 1.0);
    check_same_but_for_down(-5.0);
}

/* GIVEN marks of which one changes THEN the delta of the other axes is not
 * read. */
static void a_mark_counts_in_its_own_axes_only(void) {
    (void)flown_fly(&flown, 3.04);
    const goe_flight_obstacle_t before = obstacle_of(&flown);
    goe_flight_attitude_t attitude;
    goe_flight_position_t position;
    flown_samples(&flown, flown.sample, &attitude, &position);
    for (int i = 0; i < 3; i++) {
        position.reset_delta_ned_m[i] = 10.0f;
    }
    position.reset_vertical = 1u;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_position(&flown.flight, &position));
    goe_flight_obstacle_t after = obstacle_of(&flown);
    CHECK_CLOSE(1e-3, before.center_ned_m[0], after.center_ned_m[0]);
    CHECK_CLOSE(1e-3, before.center_ned_m[2] + 10.0f, after.center_ned_m[2]);
    position.reset_horizontal = 1u;
    position.time_us += 20000u;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_position(&flown.flight, &position));
    after = obstacle_of(&flown);
    CHECK_CLOSE(1e-3, before.center_ned_m[0] + 10.0f, after.center_ned_m[0]);
    CHECK_CLOSE(1e-3, before.center_ned_m[2] + 10.0f, after.center_ned_m[2]);
}

/* A track that begins after the jump has the ground of the newest sample. */
static void a_track_after_the_jump_has_the_ground_of_its_own_time(void) {
    for (int follows = 0; follows < 2; follows++) {
        setUp();
        flown.detects = false;
        (void)flown_fly(&flown, 1.0);
        jump_down(&flown, 5.0f, follows != 0);
        (void)flown_fly(&flown, 0.5);
        flown.detects = true;
        (void)flown_fly(&flown, 2.5);
        CHECK_CLOSE(1e-3, flown.scene.ground_d_m + (follows != 0 ? 0.0 : 5.0), obstacle_of(&flown).center_ned_m[2]);
    }
}

/* ----------------------------------------------------------------------------------------------------
 * unknown, skipped -- */

/* [GOE_FLIGHT_RESETS_COUNT] A counter that rose by two hides a jump that nobody
 * reported. */
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

/* The delta is given again after an image that was refused: it depends on the
 * slot's latest accepted image. */
static void a_jump_between_lost_images_is_reported_with_the_next_one(void) {
    (void)flown_fly(&flown, 2.5);
    (void)flown_fly(&other, 2.5);
    flown.detects = other.detects = false;
    jump(&flown, 4.0f, 1.0f);
    (void)flown_fly(&flown, 0.5);
    (void)flown_fly(&other, 0.5);
    flown.jump_ned_m[0] = 4.0f;
    flown.detects = other.detects = true;
    (void)flown_fly(&flown, 1.0);
    (void)flown_fly(&other, 1.0);
    const goe_flight_obstacle_t moved = obstacle_of(&flown);
    const goe_flight_obstacle_t still = obstacle_of(&other);
    CHECK_CLOSE(0.02, still.center_ned_m[0] + 4.0f, moved.center_ned_m[0]);
    CHECK_CLOSE(0.02, still.center_ned_m[1] + 1.0f, moved.center_ned_m[1]);
}

/* The autopilot starts again: its clock begins at 0 again. */
static void a_clock_that_was_set_back_starts_everything_again(void) {
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
    TEST_ASSERT_EQUAL(16 + 15, refused); /* attitudes, positions */
    TEST_ASSERT_EQUAL(1, flown.flight.counters.lost);
    goe_pose_t pose;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_pose(&flown.flight, attitude.time_us - 50000u, 0u, &pose, NULL));
}

/* GIVEN one attitude or one position of the future WHEN the samples of the
 * other kind continue THEN everything starts again after 16 samples. */
static void one_sample_of_the_future_ends_nothing_for_long(void) {
    for (int kind = 0; kind < 2; kind++) {
        goe_flight_attitude_t attitude;
        goe_flight_position_t position;
        setUp();
        (void)flown_fly(&flown, 3.0);
        flown_samples(&flown, flown.sample, &attitude, &position);
        attitude.time_us += kind == 0 ? 600000000u : 0u;
        position.time_us += kind == 1 ? 600000000u : 0u;
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_attitude(&flown.flight, &attitude));
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_position(&flown.flight, &position));
        int refused = 0;
        for (int k = flown.sample + 1; k < flown.sample + 40; k++) {
            flown_samples(&flown, k, &attitude, &position);
            refused += goe_flight_attitude(&flown.flight, &attitude) == GOE_FLIGHT_BAD_TIME ? 1 : 0;
            refused += goe_flight_position(&flown.flight, &position) == GOE_FLIGHT_BAD_TIME ? 1 : 0;
        }
        TEST_ASSERT_EQUAL(16, refused);
        TEST_ASSERT_EQUAL(1, flown.flight.counters.lost);
        goe_pose_t pose;
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_pose(&flown.flight, attitude.time_us - 50000u, 0u, &pose, NULL));
    }
}

/* GIVEN a pose that is a little older than the newest one WHEN a reset of the
 * heading has emptied the history before THEN the time that does not wrap
 * stays; of a clock that was set back by more, it goes on. */
static void the_time_goes_on_after_a_reset(void) {
    for (int back = 0; back < 2; back++) {
        goe_flight_attitude_t attitude;
        goe_flight_position_t position;
        goe_pose_t before;
        goe_pose_t after;
        setUp();
        flown.start_us = 900000000u;
        (void)flown_fly(&flown, 3.0);
        const uint32_t newest_us = flown_now_us(&flown);
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_pose(&flown.flight, newest_us, 0u, &before, NULL));
        flown_samples(&flown, flown.sample, &attitude, &position);
        position.time_us = newest_us + 8000u;
        attitude.time_us = newest_us + 7000u;
        attitude.reset++; /* empties the history */
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_position(&flown.flight, &position));
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_attitude(&flown.flight, &attitude));
        if (back) {
            goe_flight_history_clear(&flown.flight.history);
        }
        attitude.time_us = position.time_us = back ? 5000u : newest_us + 20000u;
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_attitude(&flown.flight, &attitude));
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_position(&flown.flight, &position));
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_pose(&flown.flight, attitude.time_us, 0u, &after, NULL));
        TEST_ASSERT_EQUAL_UINT32(attitude.time_us, (uint32_t)after.time_us);
        TEST_ASSERT_TRUE(back ? after.time_us > before.time_us : after.time_us == before.time_us + 20000);
    }
}

/* So many samples, without images. */
static void give_samples(int count) {
    for (int k = 0; k < count; k++) {
        goe_flight_attitude_t attitude;
        goe_flight_position_t position;
        flown_samples(&flown, flown.sample++, &attitude, &position);
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_attitude(&flown.flight, &attitude));
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_position(&flown.flight, &position));
    }
}

static int clear_sectors(void) {
    uint16_t sector_cm[GOE_FLIGHT_SECTORS];
    int clear = 0;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_sectors(&flown.flight, 6000u, sector_cm));
    for (int i = 0; i < GOE_FLIGHT_SECTORS; i++) {
        clear += sector_cm[i] == 6001u ? 1 : 0;
    }
    return clear;
}

/* GIVEN an assessment of half an hour ago or more, or none THEN it closes no
 * sector: its time is none of the future. */
static void an_old_assessment_closes_no_sector(void) {
    for (int assessed = 0; assessed < 2; assessed++) {
        setUp();
        flown.detects = false;
        flown.scene.speed_mps = 0.0;
        if (assessed) {
            (void)flown_fly(&flown, 1.0);
        }
        flown.start_us += assessed ? 0u : 2400000000u;
        for (int k = 0; k < (assessed ? 240 : 0); k++) { /* 40 minutes */
            flown.start_us += 10000000u;
            give_samples(1);
        }
        flown.start_us += 1000000u; /* no image is exposed in a gap of samples */
        give_samples(FLOWN_DELAY + 1);
        for (int k = 0; k < FLOWN_POSE_HZ; k++) {
            (void)flown_step(&flown);
        }
        TEST_ASSERT_TRUE(clear_sectors() > 5);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(a_known_jump_changes_nothing_but_the_place);
    RUN_TEST(a_known_jump_moves_the_place_before_the_next_image);
    RUN_TEST(a_known_jump_of_down_moves_the_ground_along);
    RUN_TEST(boxes_count_by_the_height_that_is_left);
    RUN_TEST(a_known_jump_of_down_moves_the_ground_before_the_next_image);
    RUN_TEST(a_jump_of_down_between_lost_images_counts);
    RUN_TEST(a_mark_counts_in_its_own_axes_only);
    RUN_TEST(a_track_after_the_jump_has_the_ground_of_its_own_time);
    RUN_TEST(an_unknown_jump_takes_no_warning_back);
    RUN_TEST(an_unknown_jump_after_a_reset_of_the_heading_moves_the_places);
    RUN_TEST(an_unknown_jump_without_a_position_moves_nothing);
    RUN_TEST(a_counter_that_skips_is_an_unknown_jump);
    RUN_TEST(a_time_of_reset_may_change_by_any_step);
    RUN_TEST(a_reset_of_the_heading_ends_the_tracks);
    RUN_TEST(a_jump_between_lost_images_is_reported_with_the_next_one);
    RUN_TEST(a_clock_that_was_set_back_starts_everything_again);
    RUN_TEST(the_time_goes_on_after_a_reset);
    RUN_TEST(an_old_assessment_closes_no_sector);
    RUN_TEST(one_sample_of_the_future_ends_nothing_for_long);
    return UNITY_END();
}
