/* Images in one call and in several, and what they show of the horizon. SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "flown.h"

#define MAX_CM 20000u
#define CLEAR_CM (MAX_CM + 1u)
#define DEG_PER_RAD 57.29577951308232

static flown_t flown;
static uint16_t sector_cm[GOE_FLIGHT_SECTORS];

void setUp(void) {
    flown_start(&flown, NULL);
    flown.scene.width_m = flown.scene.length_m = 4.0;
    flown.scene.height_m = 12.0;
}
void tearDown(void) {}

static goe_flight_assessment_t look(void) {
    goe_flight_assessment_t now;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_assess(&flown.flight, flown_now_us(&flown), GOE_FLIGHT_FLYING, &now));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_sectors(&flown.flight, MAX_CM, sector_cm));
    return now;
}

static int clear_sectors(void) {
    int clear = 0;
    for (int i = 0; i < GOE_FLIGHT_SECTORS; i++) {
        clear += sector_cm[i] == CLEAR_CM ? 1 : 0;
    }
    return clear;
}

/* Samples alone, so many, and no frame. */
static void fly_without_frames(int samples) {
    for (int i = 0; i < samples; i++) {
        goe_flight_attitude_t attitude;
        goe_flight_position_t position;
        flown_samples(&flown, flown.sample, &attitude, &position);
        flown.sample++;
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_attitude(&flown.flight, &attitude));
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_position(&flown.flight, &position));
    }
}

static bool is_known(uint32_t id) {
    bool known = false;
    for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
        known = known || (flown.flight.slot[i].used && flown.flight.slot[i].id == id);
    }
    for (int i = 0; i < GOE_FLIGHT_CANDIDATES; i++) {
        known = known || (flown.flight.waiting.place[i].images != 0 && flown.flight.waiting.place[i].id == id);
    }
    return known;
}

/* The obstacle of the flight with the id 7, and a wider box around it with another id. */
static void find_pair(int exposed, goe_flight_detection_t pair[2]) {
    pair[0] = pair[1] = flown_detection(&flown, exposed);
    pair[0].id = 9u;
    pair[0].box.left_px -= 10.0f;
    pair[0].box.right_px += 40.0f;
    pair[0].box.top_px -= 15.0f;
    pair[0].box.bottom_px += 5.0f;
}

/* Gives the newest exposure's pair in one call, or in two with the other box first. */
static void give_pair(const goe_flight_detection_t pair[2], int exposed, bool split) {
    for (int i = 0; i < (split ? 2 : 1); i++) {
        goe_flight_frame_t frame = flown_frame(&flown, exposed, &pair[i], split ? 1 : 2);
        frame.number = 2;
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_frame(&flown.flight, &frame));
    }
}

/* GIVEN a track WHEN an image contains its id and a box of another id around it, in one call or in two THEN the track keeps its id, and
 * the other detection is a track or waits. */
static void no_detection_takes_the_track_of_another_one(void) {
    for (int split = 0; split < 2; split++) {
        setUp();
        (void)flown_fly(&flown, 3.0);
        TEST_ASSERT_TRUE(is_known(7u));
        for (int images = 0; images < 10; images++) {
            goe_flight_detection_t pair[2];
            fly_without_frames(FLOWN_IMAGE_EVERY);
            const int exposed = flown.sample - 1;
            find_pair(exposed, pair);
            give_pair(pair, exposed, split != 0);
            TEST_ASSERT_TRUE(is_known(7u));
            TEST_ASSERT_TRUE(is_known(9u));
            TEST_ASSERT_EQUAL(0, flown.flight.counters.renumbered);
        }
    }
}

/* GIVEN a track without an id WHEN an image shows it and another box, in any order THEN the box that fits better gets the track. */
static void the_box_that_fits_better_gets_the_track(void) {
    for (int order = 0; order < 2; order++) {
        setUp();
        flown.id = 0u;
        (void)flown_fly(&flown, 3.0);
        const int exposed = flown.sample - 1;
        goe_flight_detection_t pair[2];
        find_pair(exposed, pair);
        pair[0].id = pair[1].id = 0u;
        const goe_flight_detection_t good = pair[1];
        if (order == 1) {
            pair[1] = pair[0];
            pair[0] = good;
        }
        give_pair(pair, exposed, false);
        TEST_ASSERT_TRUE(flown.flight.slot[0].used);
        TEST_ASSERT_INT_WITHIN(1, (int)good.box.right_px, flown.flight.slot[0].box_px[2]);
        TEST_ASSERT_EQUAL(1, look().unplaced);
    }
}

/* GIVEN images of which each detection comes in a call of its own WHEN an obstacle is not detected any more THEN it is not in view. */
static void an_image_in_parts_shows_what_is_not_in_it(void) {
    (void)flown_fly(&flown, 3.0);
    TEST_ASSERT_TRUE(flown.flight.slot[0].in_view);
    while (flown.sample % FLOWN_IMAGE_EVERY != 1) {
        (void)flown_step(&flown);
    }
    const int exposed = flown.sample - 1;
    for (int i = 0; i < 2; i++) {
        goe_flight_detection_t other = flown_detection(&flown, exposed);
        other.id = 30u + (uint32_t)i;
        other.box.left_px += 300.0f + 100.0f * (float)i;
        other.box.right_px += 300.0f + 100.0f * (float)i;
        goe_flight_frame_t frame = flown_frame(&flown, exposed, &other, 1);
        frame.capture_us -= (uint32_t)i * 2000u; /* as an age jitters */
        frame.number = 2;
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_frame(&flown.flight, &frame));
        TEST_ASSERT_EQUAL(i == 0, flown.flight.slot[0].in_view);
    }
}

/* GIVEN images that announce one more detection than ever comes THEN the detector is alive, and nothing is clear. */
static void an_incomplete_image_clears_nothing(void) {
    goe_flight_detection_t weak = flown_detection(&flown, 0);
    weak.score = 0.0f;
    for (int number = 1; number <= 2; number++) {
        setUp();
        for (int k = 0; k < 10; k++) {
            fly_without_frames(FLOWN_IMAGE_EVERY);
            goe_flight_frame_t frame = flown_frame(&flown, flown.sample - 1, &weak, 1);
            frame.number = (uint8_t)number;
            TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_frame(&flown.flight, &frame));
        }
        TEST_ASSERT_TRUE(look().detector_alive);
        TEST_ASSERT_EQUAL(number == 1, clear_sectors() > 5);
    }
}

/* [goe_flight_restart] GIVEN half of an image WHEN the layer is restarted THEN the other half is no whole image: nothing is clear. */
static void a_restart_forgets_half_an_image(void) {
    goe_flight_detection_t weak = flown_detection(&flown, 0);
    weak.score = 0.1f;
    for (int restarted = 0; restarted < 2; restarted++) {
        setUp();
        for (int half = 0; half < 2; half++) {
            if (half == 0 || restarted) { /* the autopilot's clock begins again, too */
                flown.sample = 0;
                fly_without_frames(20);
            }
            goe_flight_frame_t frame = flown_frame(&flown, flown.sample - 1, &weak, 1);
            frame.number = 2;
            TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_frame(&flown.flight, &frame));
            if (half == 0 && restarted) {
                TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_restart(&flown.flight));
            }
        }
        TEST_ASSERT_TRUE(look().detector_alive);
        TEST_ASSERT_EQUAL(!restarted, clear_sectors() > 5);
    }
}

/* GIVEN a clear view WHEN no sample comes any more THEN nothing is clear at an assessment half a second later. */
static void nothing_is_clear_without_a_pose(void) {
    goe_flight_assessment_t now;
    flown.detects = false;
    (void)flown_fly(&flown, 1.0);
    for (uint32_t later_us = 400000u; later_us <= 600000u; later_us += 200000u) {
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK,
                          goe_flight_assess(&flown.flight, flown_now_us(&flown) + later_us, GOE_FLIGHT_FLYING, &now));
        TEST_ASSERT_TRUE(now.detector_alive);
        TEST_ASSERT_EQUAL(later_us < 500000u, now.pose_alive);
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_sectors(&flown.flight, MAX_CM, sector_cm));
        TEST_ASSERT_EQUAL(now.pose_alive, clear_sectors() > 5);
    }
}

/* GIVEN a clear view WHEN no frame comes any more, and nobody assesses THEN nothing is clear, also when the clock has wrapped. */
static void a_view_ends_without_an_assessment(void) {
    flown.detects = false;
    (void)flown_fly(&flown, 1.0);
    (void)look();
    TEST_ASSERT_TRUE(clear_sectors() > 5);
    for (int minute = 0; minute < 80; minute++) {
        fly_without_frames(2 * FLOWN_POSE_HZ);
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_sectors(&flown.flight, MAX_CM, sector_cm));
        TEST_ASSERT_EQUAL(0, clear_sectors());
        flown.start_us += 58000000u; /* with the two seconds above: a minute */
    }
}

/* GIVEN a clear view WHEN the aircraft turns and no image has come since THEN what the image showed is clear, and nothing else. */
static void clear_is_what_an_image_showed(void) {
    uint16_t before[GOE_FLIGHT_SECTORS];
    flown.detects = false;
    (void)flown_fly(&flown, 1.0);
    (void)look();
    memcpy(before, sector_cm, sizeof before);
    for (int turn_deg = 15; turn_deg <= 90; turn_deg += 15) {
        goe_flight_attitude_t attitude;
        goe_flight_position_t position;
        flown_samples(&flown, flown.sample, &attitude, &position);
        flown.sample++;
        const double half = 0.5 * turn_deg / DEG_PER_RAD;
        const float q[4] = {(float)cos(half), 0.0f, 0.0f, (float)sin(half)};
        memcpy(attitude.q, q, sizeof attitude.q);
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_attitude(&flown.flight, &attitude));
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_position(&flown.flight, &position));
        (void)look();
        TEST_ASSERT_EQUAL_MEMORY(before, sector_cm, sizeof before);
    }
}

/* GIVEN an obstacle with a position and without a width THEN the bearings of its box are not clear. */
static void an_obstacle_without_a_width_closes_its_box(void) {
    flown.scene.width_m = flown.scene.length_m = 30.0;
    (void)flown_fly(&flown, 2.0);
    goe_flight_slot_t *slot = &flown.flight.slot[0];
    TEST_ASSERT_TRUE((slot->valid & GOE_HAS_POSITION) != 0u);
    slot->valid = (uint8_t)(slot->valid & ~(unsigned)GOE_HAS_WIDTH);
    slot->width_m = slot->length_m = 0.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_sectors(&flown.flight, MAX_CM, sector_cm));
    int closed = 0;
    for (int i = 0; i < GOE_FLIGHT_SECTORS; i++) {
        const double off_deg = remainder(5.0 * i - slot->bearings.middle_deg, 360.0);
        if (fabs(off_deg) <= slot->bearings.half_deg + 2.5) {
            TEST_ASSERT_NOT_EQUAL(CLEAR_CM, sector_cm[i]);
            closed++;
        }
    }
    TEST_ASSERT_TRUE(closed >= 2 && clear_sectors() > 2);
}

/* [F6] GIVEN an obstacle beyond the distance WHEN two of its sigmas reach into it, or it is suspect THEN its sectors are not clear. */
static void an_obstacle_that_may_be_nearer_is_not_clear(void) {
    (void)flown_fly(&flown, 2.0);
    goe_flight_slot_t *slot = &flown.flight.slot[0];
    const goe_flight_history_position_t *own = &flown.flight.history.position[0];
    TEST_ASSERT_TRUE((slot->valid & GOE_HAS_POSITION) != 0u && flown.flight.history.position_count > 0);
    const double north = (double)(slot->center_ne_m[0] - own->ned_m[0]);
    const double east = (double)(slot->center_ne_m[1] - own->ned_m[1]);
    const int sector = (int)lround(atan2(east, north) * 180.0 / 3.14159265358979 / 5.0 + 144.0) % GOE_FLIGHT_SECTORS;
    const uint32_t max_cm = (uint32_t)(50.0 * hypot(north, east)); /* half of the way */
    TEST_ASSERT_TRUE(max_cm > 1000u && max_cm < 6000u);
    for (int k = 0; k < 4; k++) {
        slot->covariance_ne_m2[0] = slot->covariance_ne_m2[2] = k == 1 ? 1600.0f : 1.0f;
        slot->covariance_ne_m2[1] = 0.0f;
        slot->suspect = k == 2;
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_sectors(&flown.flight, max_cm, sector_cm));
        TEST_ASSERT_EQUAL_UINT16(k == 0 || k == 3 ? max_cm + 1u : GOE_FLIGHT_SECTOR_UNKNOWN, sector_cm[sector]);
    }
}

/* ... by its sigma along the line of sight, not by that across. */
static void an_obstacle_may_be_nearer_along_the_line_of_sight(void) {
    (void)flown_fly(&flown, 2.0);
    goe_flight_slot_t *slot = &flown.flight.slot[0];
    goe_flight_attitude_t attitude;
    goe_flight_position_t own;
    flown_samples(&flown, flown.sample - 1, &attitude, &own);
    slot->center_ne_m[0] = own.position_ned_m[0] + 100.0f;
    slot->center_ne_m[1] = own.position_ned_m[1];
    slot->covariance_ne_m2[1] = 0.0f;
    for (int along = 0; along < 2; along++) {
        slot->covariance_ne_m2[0] = along ? 1600.0f : 1.0f;
        slot->covariance_ne_m2[2] = along ? 1.0f : 1600.0f;
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_sectors(&flown.flight, 5000u, sector_cm));
        TEST_ASSERT_EQUAL_UINT16(along ? GOE_FLIGHT_SECTOR_UNKNOWN : 5001u, sector_cm[0]);
    }
}

/* GIVEN a track WHEN its id shows another obstacle elsewhere THEN that one is unplaced and its bearing is not clear, until the track has its
 * position. */
static void a_detection_that_is_elsewhere_is_unplaced(void) {
    (void)flown_fly(&flown, 3.0);
    TEST_ASSERT_EQUAL(0, look().unplaced);
    int unplaced = 0;
    for (int images = 1; images <= 20; images++) {
        fly_without_frames(FLOWN_IMAGE_EVERY);
        goe_flight_detection_t other = flown_detection(&flown, flown.sample - 1);
        other.box.left_px += 400.0f;
        other.box.right_px += 400.0f;
        const goe_flight_frame_t frame = flown_frame(&flown, flown.sample - 1, &other, 1);
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_frame(&flown.flight, &frame));
        const int missing = look().unplaced;
        unplaced += missing;
        const goe_flight_camera_t *camera = &flown.flight.camera[0];
        const double u = 0.5 * ((double)other.box.left_px + (double)other.box.right_px);
        const double box_deg = DEG_PER_RAD * atan2(u - (double)camera->center_px[0], (double)camera->focal_px[0]);
        const float *at = flown.flight.slot[0].center_ne_m;
        goe_flight_attitude_t attitude;
        goe_flight_position_t own;
        flown_samples(&flown, flown.sample - 1, &attitude, &own);
        const double deg = DEG_PER_RAD * atan2((double)at[1] - (double)own.position_ned_m[1],
                                               (double)at[0] - (double)own.position_ned_m[0]);
        const double half_px =
            0.75 * ((double)other.box.right_px - (double)other.box.left_px); /* taken as half larger */
        const double half_deg = DEG_PER_RAD * atan(half_px / (double)camera->focal_px[0]);
        TEST_ASSERT_TRUE(missing > 0 || fabs(deg - box_deg) < fmax(5.0, half_deg));
        const int sector = (int)((box_deg + 360.0) / 5.0 + 0.5) % GOE_FLIGHT_SECTORS;
        TEST_ASSERT_NOT_EQUAL(CLEAR_CM, sector_cm[sector]);
    }
    TEST_ASSERT_TRUE(unplaced >= 4);
}

/* GIVEN two obstacles without ids, each in a call of its own THEN there are two tracks, as with one call. */
static void without_ids_parts_are_as_good_as_one_call(void) {
    const float middle_px = flown.flight.camera[0].center_px[0];
    flown.id = 0u;
    for (int images = 0; images < 30; images++) {
        fly_without_frames(FLOWN_IMAGE_EVERY);
        goe_flight_detection_t pair[2] = {flown_detection(&flown, flown.sample - 1),
                                          flown_detection(&flown, flown.sample - 1)};
        pair[1].box.left_px = 2.0f * middle_px - pair[0].box.right_px; /* the same on the other side of the course */
        pair[1].box.right_px = 2.0f * middle_px - pair[0].box.left_px;
        give_pair(pair, flown.sample - 1, true);
    }
    int used = 0;
    for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
        used += flown.flight.slot[i].used ? 1 : 0;
    }
    TEST_ASSERT_EQUAL(2, used);
}

/* GIVEN a clear view WHEN the heading jumps by a reset THEN nothing is clear for a second: no bearing from before is right. */
static void a_reset_of_the_heading_clears_nothing(void) {
    goe_flight_attitude_t attitude;
    goe_flight_position_t position;
    flown.detects = false;
    (void)flown_fly(&flown, 2.0);
    (void)look();
    TEST_ASSERT_TRUE(clear_sectors() > 5);
    flown_samples(&flown, flown.sample, &attitude, &position);
    flown.sample++;
    attitude.reset = 1u;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_attitude(&flown.flight, &attitude));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_position(&flown.flight, &position));
    (void)look();
    TEST_ASSERT_EQUAL(0, clear_sectors());
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(no_detection_takes_the_track_of_another_one);
    RUN_TEST(the_box_that_fits_better_gets_the_track);
    RUN_TEST(an_image_in_parts_shows_what_is_not_in_it);
    RUN_TEST(an_incomplete_image_clears_nothing);
    RUN_TEST(a_restart_forgets_half_an_image);
    RUN_TEST(nothing_is_clear_without_a_pose);
    RUN_TEST(a_view_ends_without_an_assessment);
    RUN_TEST(clear_is_what_an_image_showed);
    RUN_TEST(an_obstacle_without_a_width_closes_its_box);
    RUN_TEST(an_obstacle_that_may_be_nearer_is_not_clear);
    RUN_TEST(an_obstacle_may_be_nearer_along_the_line_of_sight);
    RUN_TEST(a_detection_that_is_elsewhere_is_unplaced);
    RUN_TEST(without_ids_parts_are_as_good_as_one_call);
    RUN_TEST(a_reset_of_the_heading_clears_nothing);
    return UNITY_END();
}
