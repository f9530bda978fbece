/* From samples and frames to obstacles. SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "flown.h"
#include "goe_table.h"

static flown_t flown;

void setUp(void) { flown_start(&flown, NULL); }
void tearDown(void) {}

static int slots_used(void) {
    int used = 0;
    for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
        used += flown.flight.slot[i].used ? 1 : 0;
    }
    return used;
}

/* The truck of the scene: middle of the base, NED. */
static void truth(double center_ne_m[2]) {
    goe_image_t image;
    scene_truth_t exact;
    scene_image(&flown.scene, 0, &image, &exact);
    center_ne_m[0] = exact.center_north_m;
    center_ne_m[1] = exact.center_east_m;
}

static void an_obstacle_is_found_where_it_is(void) {
    double center[2];
    goe_flight_obstacle_t obstacle;
    flown.scene.width_m = flown.scene.length_m = 4.0;
    flown.scene.height_m = 12.0;
    const goe_flight_assessment_t now = flown_fly(&flown, 4.0);
    truth(center);
    TEST_ASSERT_EQUAL(1, now.obstacles);
    TEST_ASSERT_TRUE(now.detector_alive && now.pose_alive);
    TEST_ASSERT_EQUAL(0, now.worst);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_obstacle(&flown.flight, 0, &obstacle));
    TEST_ASSERT_EQUAL_UINT32(7u, obstacle.id);
    TEST_ASSERT_TRUE((obstacle.valid & GOE_HAS_POSITION) != 0u && (obstacle.valid & GOE_HAS_HEIGHT) != 0u);
    const double sd_m = sqrt((double)obstacle.covariance_ne_m2[0]);
    check_report("north off, m", (double)obstacle.center_ned_m[0] - center[0]);
    check_report("sigma, m", sd_m);
    CHECK_CLOSE(2.0 * sd_m, center[0], obstacle.center_ned_m[0]);
    CHECK_CLOSE(2.0, center[1], obstacle.center_ned_m[1]);
    CHECK_CLOSE(1.5, 12.0, obstacle.height_m);
    CHECK_CLOSE(1e-3, flown.scene.ground_d_m, obstacle.center_ned_m[2]);
    TEST_ASSERT_TRUE(obstacle.in_view && !obstacle.receding && obstacle.has_hazard);
}

#define STEP_S 0.25

/* Seconds until detections of this kind give a position, where the ground gives no range. */
static double answer_s_of(goe_kind_t kind) {
    goe_flight_obstacle_t obstacle;
    const char *bad = NULL;
    flown_start(&flown, NULL);
    goe_settings_t settings = scene_settings(&flown.scene);
    settings.navigation.terrain_height_sd_m = 1000.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_init(&flown.flight, sizeof flown.flight, &settings, NULL, &bad));
    flown.scene.width_m = flown.scene.length_m = 4.0;
    flown.scene.height_m = 12.0;
    flown.kind = kind;
    for (double s = STEP_S; s < 10.0; s += STEP_S) {
        (void)flown_fly(&flown, STEP_S);
        if (goe_flight_obstacle(&flown.flight, 0, &obstacle) == GOE_FLIGHT_OK &&
            (obstacle.valid & GOE_HAS_POSITION) != 0u) {
            return s;
        }
    }
    return 10.0;
}

/* GIVEN detections of a class THEN its size reaches the estimator, which answers sooner; a bad size changes nothing. */
static void the_size_of_a_class_is_used(void) {
    const goe_kind_t unknown = {0.0f, 0.0f, 0.0f, 0.0f, GOE_KIND_UNKNOWN};
    const goe_kind_t known = {4.0f, 0.2f, 12.0f, 0.3f, GOE_KIND_UNKNOWN};
    const goe_kind_t bad = {4.0f, 0.2f, 12.0f, NAN, GOE_KIND_UNKNOWN};
    const double without_s = answer_s_of(unknown);
    const double with_s = answer_s_of(known);
    check_report("first position without and with the size, s", without_s);
    check_report("", with_s);
    TEST_ASSERT_TRUE(with_s < without_s);
    CHECK_CLOSE(0.0, without_s, answer_s_of(bad));
}

/* Of what the estimator knows, and the manual of the layer lists, and nothing else. */
static void valid_lists_the_fields_of_an_obstacle(void) {
    const unsigned reported =
        GOE_HAS_POSITION | GOE_HAS_HEIGHT | GOE_HAS_WIDTH | GOE_HAS_LENGTH | GOE_HAS_ORIENTATION; /* of goe_flight.h */
    goe_flight_obstacle_t obstacle;
    (void)flown_fly(&flown, 3.0);
    for (unsigned bit = 1u; bit < 0x100u; bit <<= 1) {
        flown.flight.slot[0].valid = (uint8_t)bit;
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_obstacle(&flown.flight, 0, &obstacle));
        TEST_ASSERT_EQUAL_HEX(bit & reported, obstacle.valid);
    }
}

/* [goe_flight_assessment_t.suspect] GIVEN images that show no position yet THEN that makes nothing suspect. */
static void a_track_without_a_position_is_not_suspect(void) {
    goe_flight_obstacle_t obstacle;
    int images = 0;
    while (slots_used() == 0) {
        (void)flown_step(&flown);
    }
    for (int i = 0; i < 3 * FLOWN_IMAGE_EVERY; i++) {
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_obstacle(&flown.flight, 0, &obstacle));
        images += (obstacle.valid & GOE_HAS_POSITION) == 0u ? 1 : 0;
        TEST_ASSERT_FALSE(obstacle.suspect);
        (void)flown_step(&flown);
    }
    TEST_ASSERT_TRUE(images > 0);
}

/* An assessment with a sample, so many tenths of a second after the time; no frame comes. */
static goe_flight_assessment_t assess_later(uint32_t from_us, int tenths) {
    goe_flight_assessment_t now;
    goe_flight_attitude_t attitude;
    goe_flight_position_t position;
    flown_samples(&flown, 0, &attitude, &position);
    attitude.time_us = position.time_us = from_us + (uint32_t)tenths * 100000u;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_attitude(&flown.flight, &attitude));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_position(&flown.flight, &position));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_assess(&flown.flight, position.time_us, false, &now));
    return now;
}

/* Whether the detector was alive in any assessment after the first two seconds without a frame. */
static bool revives(double seconds) {
    bool alive = false;
    const uint32_t from_us = flown_now_us(&flown);
    for (int k = 1; k <= (int)(10.0 * seconds); k++) {
        const goe_flight_assessment_t now = assess_later(from_us, k);
        alive = alive || (k > 20 && now.detector_alive);
    }
    return alive;
}

/* [goe_flight_obstacle_t.in_view] GIVEN a detector of one image a second WHEN assessments predict between its images THEN the obstacle stays in view
 * until an image does not show it. */
static void a_prediction_is_no_image(void) {
    goe_flight_obstacle_t obstacle;
    goe_flight_assessment_t now;
    (void)flown_fly(&flown, 3.0);
    for (int k = 0; k < 45; k++) {
        goe_flight_attitude_t attitude;
        goe_flight_position_t position;
        flown_samples(&flown, flown.sample++, &attitude, &position);
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_attitude(&flown.flight, &attitude));
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_position(&flown.flight, &position));
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_assess(&flown.flight, position.time_us, 0u, &now));
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_obstacle(&flown.flight, 0, &obstacle));
        TEST_ASSERT_TRUE(obstacle.in_view);
    }
    const goe_flight_frame_t frame = flown_frame(&flown, flown.sample - 2, NULL, 0);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_frame(&flown.flight, &frame));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_obstacle(&flown.flight, 0, &obstacle));
    TEST_ASSERT_FALSE(obstacle.in_view);
}

/* GIVEN a detector that has died WHEN the clock wraps the difference of its times, after 36 minutes THEN it is as dead as before. */
static void a_dead_detector_stays_dead(void) {
    (void)flown_fly(&flown, 1.0);
    TEST_ASSERT_FALSE(revives(80.0 * 60.0));
}

typedef enum { FRAME_EMPTY, FRAME_WEAK, FRAME_NOT_A_NUMBER, FRAME_PROMISED, FRAMES } frame_kind_t;

/* Whether two seconds of such frames alone let the detector count as alive. */
static bool lives_by(frame_kind_t kind) {
    goe_flight_assessment_t now;
    flown_start(&flown, NULL);
    for (int k = 0; k < 2 * FLOWN_POSE_HZ; k++) {
        goe_flight_attitude_t attitude;
        goe_flight_position_t position;
        flown_samples(&flown, k, &attitude, &position);
        flown.sample = k + 1;
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_attitude(&flown.flight, &attitude));
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_position(&flown.flight, &position));
        goe_flight_detection_t detection = flown_detection(&flown, k);
        detection.score = kind == FRAME_NOT_A_NUMBER ? check_from_bits(0x7FC00000u) : 0.1f;
        const bool given = kind == FRAME_WEAK || kind == FRAME_NOT_A_NUMBER;
        goe_flight_frame_t frame = flown_frame(&flown, k, &detection, given ? 1 : 0);
        frame.number = (uint8_t)(kind == FRAME_EMPTY ? 0 : 1);
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_frame(&flown.flight, &frame));
    }
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_assess(&flown.flight, flown_now_us(&flown), false, &now));
    return now.detector_alive;
}

/* GIVEN frames of which nothing can be read, or that announce detections and bring none THEN the detector is not alive; by empty ones, or
 * weak detections, it is. */
static void unreadable_input_is_no_sign_of_life(void) {
    TEST_ASSERT_TRUE(lives_by(FRAME_EMPTY));
    TEST_ASSERT_TRUE(lives_by(FRAME_WEAK));
    TEST_ASSERT_FALSE(lives_by(FRAME_NOT_A_NUMBER));
    TEST_ASSERT_FALSE(lives_by(FRAME_PROMISED));
}

/* GIVEN an obstacle ahead on the course WHEN it is undetected for longer than track_timeout_s THEN it is kept, and so is its warning, until it is
 * passed. */
static void an_obstacle_ahead_is_not_forgotten(void) {
    goe_flight_settings_t settings;
    goe_flight_settings_default(&settings);
    settings.track_timeout_s = 1.0f;
    flown_start(&flown, &settings);
    flown.scene.x0_m = 0.0;
    flown.scene.z0_m = 200.0;
    flown.scene.height_m = 40.0;
    const goe_flight_assessment_t before = flown_fly(&flown, 4.0);
    TEST_ASSERT_TRUE(before.hazard.conflict_probability > 0.5f && before.hazard.tcpa_s > 3.0f);
    flown.detects = false;
    const double left_s = (double)before.hazard.tcpa_s;
    for (int k = 1; k < (int)(5.0 * left_s) - 3; k++) {
        const goe_flight_assessment_t now = flown_fly(&flown, 0.2);
        TEST_ASSERT_EQUAL(1, now.obstacles);
        TEST_ASSERT_TRUE(now.hazard.conflict_probability > 0.5f);
    }
    for (int k = 0; k < 30; k++) {
        (void)flown_fly(&flown, 0.5);
    }
    TEST_ASSERT_EQUAL(0, flown_fly(&flown, 0.2).obstacles);
}

/* GIVEN a height that is not valid THEN any number may stand there; GIVEN one that is THEN it must be one, and in its range. */
static void a_height_counts_as_far_as_it_is_valid(void) {
    const float bad[] = {check_from_bits(0x7FC00000u), check_from_bits(0x7F800000u), 1.1e5f, -1.1e5f};
    goe_flight_attitude_t attitude;
    goe_flight_position_t position;
    flown_samples(&flown, 0, &attitude, &position);
    for (int i = 0; i < GOE_FLIGHT_HEIGHTS; i++) {
        for (int k = 0; k < 4; k++) {
            for (int j = 0; j < GOE_FLIGHT_HEIGHTS; j++) {
                position.height_m[j] = j == i ? bad[k] : 20.0f;
            }
            position.height_valid = (uint8_t)(1u << i);
            TEST_ASSERT_EQUAL(k < 2 ? GOE_FLIGHT_NOT_FINITE : GOE_FLIGHT_OUT_OF_RANGE,
                              goe_flight_position(&flown.flight, &position));
            position.height_valid = (uint8_t)(7u & ~(1u << i));
            position.time_us += 20000u;
            TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_position(&flown.flight, &position));
        }
    }
    TEST_ASSERT_EQUAL(4 * GOE_FLIGHT_HEIGHTS, flown.flight.counters.refused);
}

/* [goe_flight_position_t.velocity_ned_m_s] The hazard counts from now, not from the image that came 100 ms late. */
static void the_hazard_counts_from_now(void) {
    flown.scene.x0_m = 0.0;
    flown.scene.altitude_m = 6.0;
    flown.scene.height_m = 12.0;
    (void)flown_fly(&flown, 3.0);
    goe_flight_assessment_t first;
    goe_flight_assessment_t later;
    const uint32_t now_us = flown_now_us(&flown);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_assess(&flown.flight, now_us, false, &first));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_assess(&flown.flight, now_us + 100000u, false, &later));
    CHECK_CLOSE(1e-4, first.hazard.tcpa_s - 0.1f, later.hazard.tcpa_s);
    goe_intent_t intent = {{(float)flown.scene.speed_mps, 0.0f, 0.0f}, 15.0f, 10.0f, 0.0f, 0.0f};
    goe_hazard_t hazard;
    TEST_ASSERT_EQUAL(GOE_OK, goe_hazard(&flown.flight.slot[0].estimator, &intent, &hazard));
    /* the newest sample is number 149, the latest frame that has arrived shows number 140 */
    CHECK_CLOSE(1e-3, (double)hazard.tcpa_s - 0.18, first.hazard.tcpa_s);
}

/* [flight.confirm_images] */
static void a_new_obstacle_waits_for_its_confirmation(void) {
    for (int frames = 0; frames < 2;) {
        frames += flown_step(&flown) ? 1 : 0;
    }
    TEST_ASSERT_EQUAL(0, slots_used());
    while (!flown_step(&flown)) {
    }
    TEST_ASSERT_EQUAL(1, slots_used());
}

/* [flight.score_min] */
static void a_low_score_is_not_looked_at(void) {
    flown.score = 0.2f;
    const goe_flight_assessment_t now = flown_fly(&flown, 2.0);
    TEST_ASSERT_EQUAL(0, slots_used());
    TEST_ASSERT_TRUE(flown.flight.counters.weak > 15);
    TEST_ASSERT_TRUE(now.detector_alive);
    TEST_ASSERT_EQUAL(-1, now.worst);
}

/* GIVEN a detector that sets no score THEN its detections count. */
static void no_score_hides_no_obstacle(void) {
    flown.score = 0.0f;
    const goe_flight_assessment_t now = flown_fly(&flown, 2.0);
    TEST_ASSERT_EQUAL(1, slots_used());
    TEST_ASSERT_EQUAL(0, flown.flight.counters.weak);
    TEST_ASSERT_EQUAL(0, now.worst);
}

/* [GOE_FLIGHT_CANDIDATES] A full table of obstacles, and false detections with a new id in each image: nobody is evicted. */
static void false_detections_evict_nobody(void) {
    for (int k = 0; k < 40; k++) {
        goe_flight_detection_t detections[5];
        if (!flown_step(&flown)) {
            continue;
        }
        for (int i = 0; i < 5; i++) {
            detections[i] = flown_detection(&flown, flown.sample - 1);
            detections[i].id = i < 4 ? 100u + (uint32_t)i : 1000u + (uint32_t)k;
            detections[i].box.left_px = 200.0f * (float)(i + 1);
            detections[i].box.right_px = detections[i].box.left_px + 40.0f;
        }
        const goe_flight_frame_t frame = flown_frame(&flown, flown.sample - 1, detections, 5);
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_frame(&flown.flight, &frame));
    }
    TEST_ASSERT_EQUAL(0, flown.flight.counters.evicted);
}

static void a_renumbered_obstacle_keeps_its_track(void) {
    (void)flown_fly(&flown, 3.0);
    const goe_flight_slot_t before = flown.flight.slot[0];
    flown.id = 8u;
    (void)flown_fly(&flown, 0.5);
    TEST_ASSERT_EQUAL(1, slots_used());
    TEST_ASSERT_EQUAL_UINT32(8u, flown.flight.slot[0].id);
    TEST_ASSERT_EQUAL(1, flown.flight.counters.renumbered);
    TEST_ASSERT_TRUE(flown.flight.slot[0].taken_us != before.taken_us);
    TEST_ASSERT_TRUE((flown.flight.slot[0].valid & GOE_HAS_POSITION) != 0u);
}

/* While the obstacle is undetected, a box of another size over its position does not join its track. */
static void a_box_of_another_size_takes_nothing_over(void) {
    (void)flown_fly(&flown, 3.0);
    flown.detects = false;
    for (int k = 0; k < 20; k++) {
        (void)flown_step(&flown);
        if (flown.sample % 5 == 3) {
            goe_flight_detection_t other = flown_detection(&flown, flown.sample - 1);
            const float wide_px = other.box.right_px - other.box.left_px;
            other.id = 50u + (uint32_t)k;
            other.box.left_px -= 2.0f * wide_px;
            other.box.right_px += 2.0f * wide_px;
            const goe_flight_frame_t frame = flown_frame(&flown, flown.sample - 1, &other, 1);
            TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_frame(&flown.flight, &frame));
        }
    }
    TEST_ASSERT_EQUAL_UINT32(7u, flown.flight.slot[0].id);
    TEST_ASSERT_EQUAL(0, flown.flight.counters.renumbered);
}

static void a_detector_without_ids_is_followed_by_place(void) {
    flown.id = 0u;
    const goe_flight_assessment_t now = flown_fly(&flown, 4.0);
    TEST_ASSERT_EQUAL(1, slots_used());
    TEST_ASSERT_EQUAL(1, now.obstacles);
    TEST_ASSERT_EQUAL(0, flown.flight.counters.renumbered);
}

/* Another obstacle elsewhere in the image gets a slot of its own. */
static void another_obstacle_takes_nothing_over(void) {
    (void)flown_fly(&flown, 3.0);
    for (int k = 0; k < 40; k++) {
        if (flown_step(&flown)) {
            goe_flight_detection_t other = flown_detection(&flown, flown.sample - 1);
            other.id = 99u;
            other.box.left_px += 400.0f;
            other.box.right_px += 400.0f;
            const goe_flight_frame_t frame = flown_frame(&flown, flown.sample - 1, &other, 1);
            TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_frame(&flown.flight, &frame));
        }
    }
    TEST_ASSERT_EQUAL(2, slots_used());
    TEST_ASSERT_EQUAL_UINT32(7u, flown.flight.slot[0].id);
    TEST_ASSERT_EQUAL_UINT32(99u, flown.flight.slot[1].id);
}

static void a_vanished_obstacle_is_given_up(void) {
    (void)flown_fly(&flown, 3.0);
    flown.detects = false;
    (void)flown_fly(&flown, 9.0);
    TEST_ASSERT_EQUAL(1, slots_used());
    (void)flown_fly(&flown, 2.0);
    TEST_ASSERT_EQUAL(0, slots_used());
}

/* A new track in a slot that was given up is not the obstacle of the order. */
static void an_order_does_not_pass_to_the_next_in_its_slot(void) {
    (void)flown_fly(&flown, 3.04); /* an image came with sample 150 */
    flown.flight.reaction.action = GOE_FLIGHT_LEFT;
    flown.flight.reaction.slot = 0;
    flown.flight.slot[0].detected_us -= 601000000u;
    const goe_flight_assessment_t now = flown_fly(&flown, 0.02);
    TEST_ASSERT_EQUAL(0, slots_used());
    TEST_ASSERT_EQUAL(-1, now.avoided);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, now.action); /* for hold_s */
}

/* [flight.detector_timeout_s] */
static void a_dead_detector_is_not_a_clear_sky(void) {
    flown.scene.width_m = flown.scene.length_m = 4.0;
    flown.scene.height_m = 12.0;
    goe_flight_assessment_t now = flown_fly(&flown, 3.0); /* its middle: 54 m ahead, 12 m left, so at 347 degrees */
    TEST_ASSERT_TRUE(now.detector_alive);
    uint16_t sector_cm[GOE_FLIGHT_SECTORS];
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_sectors(&flown.flight, 20000u, sector_cm));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OUT_OF_RANGE, goe_flight_sectors(&flown.flight, 0u, sector_cm));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OUT_OF_RANGE, goe_flight_sectors(&flown.flight, UINT32_MAX, sector_cm));
    TEST_ASSERT_EQUAL_UINT16(20001u, sector_cm[3]);                     /* 15 degrees right: in view, nothing there */
    TEST_ASSERT_EQUAL_UINT16(GOE_FLIGHT_SECTOR_UNKNOWN, sector_cm[36]); /* behind */
    TEST_ASSERT_TRUE(sector_cm[69] > 4000u && sector_cm[69] < 6500u);
    const uint32_t later_us = flown_now_us(&flown) + 1500000u;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_assess(&flown.flight, later_us, false, &now));
    TEST_ASSERT_FALSE(now.detector_alive);
    TEST_ASSERT_FALSE(now.pose_alive);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_sectors(&flown.flight, 20000u, sector_cm));
    TEST_ASSERT_EQUAL_UINT16(GOE_FLIGHT_SECTOR_UNKNOWN, sector_cm[3]);
}

/* [F1] GIVEN an obstacle that is detected WHEN it has no position yet THEN it is counted, and its bearing is not clear but unknown. */
static void a_detection_without_a_position_is_not_a_clear_sky(void) {
    flown.scene.width_m = flown.scene.length_m = 4.0;
    flown.scene.height_m = 12.0;
    goe_flight_assessment_t now = flown_fly(&flown, 0.02);
    uint16_t sector_cm[GOE_FLIGHT_SECTORS];
    while (slots_used() == 0 && flown.sample < 100) {
        now = flown_fly(&flown, 0.02);
    }
    TEST_ASSERT_EQUAL(0, now.obstacles);
    TEST_ASSERT_EQUAL(1, now.unplaced);
    TEST_ASSERT_EQUAL(-1, now.worst);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_sectors(&flown.flight, 20000u, sector_cm));
    const double bearing_deg = atan2(flown.scene.x0_m, flown.scene.z0_m) * 180.0 / 3.14159265358979 + 360.0;
    TEST_ASSERT_EQUAL_UINT16(GOE_FLIGHT_SECTOR_UNKNOWN, sector_cm[(int)(bearing_deg / 5.0 + 0.5) % GOE_FLIGHT_SECTORS]);
    TEST_ASSERT_EQUAL_UINT16(20001u, sector_cm[3]); /* next to it: in view, nothing there */
    now = flown_fly(&flown, 3.0);
    TEST_ASSERT_EQUAL(1, now.obstacles);
    TEST_ASSERT_EQUAL(0, now.unplaced);
}

/* GIVEN an obstacle WHEN its first image has come, and it waits for its confirmation THEN it is counted, and its bearing is not clear. */
static void a_detection_that_waits_is_not_a_clear_sky(void) {
    flown.scene.width_m = flown.scene.length_m = 4.0;
    flown.scene.height_m = 12.0;
    goe_flight_assessment_t now = flown_fly(&flown, 0.02);
    uint16_t sector_cm[GOE_FLIGHT_SECTORS];
    while (flown.flight.waiting.place[0].images == 0 && flown.sample < 100) {
        TEST_ASSERT_EQUAL(0, now.unplaced);
        now = flown_fly(&flown, 0.02);
    }
    TEST_ASSERT_EQUAL(0, slots_used());
    TEST_ASSERT_EQUAL(1, now.unplaced);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_sectors(&flown.flight, 20000u, sector_cm));
    const double bearing_deg = atan2(flown.scene.x0_m, flown.scene.z0_m) * 180.0 / 3.14159265358979 + 360.0;
    TEST_ASSERT_EQUAL_UINT16(GOE_FLIGHT_SECTOR_UNKNOWN, sector_cm[(int)(bearing_deg / 5.0 + 0.5) % GOE_FLIGHT_SECTORS]);
    TEST_ASSERT_EQUAL_UINT16(20001u, sector_cm[3]); /* next to it: in view, nothing there */
}

/* GIVEN an obstacle without a position, or a detection that waits WHEN the aircraft turns or banks, and nothing is detected any more
 * THEN its bearing stays unknown: the turn does not take it along. */
static void a_turn_leaves_the_bearing_of_a_detection(void) {
    for (int kind = 0; kind < 4; kind++) {
        setUp();
        goe_flight_assessment_t now = flown_fly(&flown, 0.02);
        while ((kind < 2 ? flown.flight.waiting.place[0].images == 0 : slots_used() == 0) && flown.sample < 100) {
            now = flown_fly(&flown, 0.02);
        }
        TEST_ASSERT_EQUAL(1, now.unplaced);
        const double bearing_deg = atan2(flown.scene.x0_m, flown.scene.z0_m) * 180.0 / 3.14159265358979;
        const int sector = (int)((bearing_deg + 360.0) / 5.0 + 0.5) % GOE_FLIGHT_SECTORS;
        goe_flight_attitude_t attitude;
        goe_flight_position_t position;
        uint16_t sector_cm[GOE_FLIGHT_SECTORS];
        flown_samples(&flown, flown.sample, &attitude, &position);
        const float half_rad = 0.5f * (kind % 2 == 0 ? 20.0f : 40.0f) / 57.29578f;
        memset(attitude.q, 0, sizeof attitude.q);
        attitude.q[0] = cosf(half_rad);
        attitude.q[kind % 2 == 0 ? 3 : 1] = sinf(half_rad); /* to the right */
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_attitude(&flown.flight, &attitude));
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_position(&flown.flight, &position));
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_assess(&flown.flight, position.time_us, false, &now));
        TEST_ASSERT_EQUAL(1, now.unplaced);
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_sectors(&flown.flight, 20000u, sector_cm));
        TEST_ASSERT_EQUAL_UINT16(GOE_FLIGHT_SECTOR_UNKNOWN, sector_cm[sector]);
        if (kind % 2 == 0) {
            TEST_ASSERT_EQUAL_UINT16(20001u, sector_cm[(sector + 4) % GOE_FLIGHT_SECTORS]);
        }
    }
}

/* Boxes side by side in an image, each with its own id; the image's width has space for all of them. */
static void detect_row(uint32_t first_id, int count) {
    goe_flight_detection_t detections[GOE_FLIGHT_DETECTIONS];
    for (int i = 0; i < count; i++) {
        detections[i] = flown_detection(&flown, flown.sample - 1);
        detections[i].id = first_id + (uint32_t)i;
        detections[i].box.left_px = 50.0f + 38.0f * (float)i;
        detections[i].box.right_px = detections[i].box.left_px + 20.0f;
    }
    const goe_flight_frame_t frame = flown_frame(&flown, flown.sample - 1, detections, (uint8_t)count);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_frame(&flown.flight, &frame));
}

static bool is_placed(uint32_t id) {
    bool placed = false;
    for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
        const goe_flight_slot_t *slot = &flown.flight.slot[i];
        placed = placed || (slot->used && slot->id == id && (slot->valid & GOE_HAS_POSITION) != 0u);
    }
    return placed;
}

/* The sector of the middle of a box, in a level camera that looks north. */
static int sector_of(const goe_box_t *box) {
    const goe_flight_camera_t *camera = &flown.flight.camera[0];
    const double u = 0.5 * ((double)box->left_px + (double)box->right_px) - (double)camera->center_px[0];
    const double bearing_deg = atan2(u, (double)camera->focal_px[0]) * 180.0 / 3.14159265358979 + 360.0;
    return (int)(bearing_deg / 5.0 + 0.5) % GOE_FLIGHT_SECTORS;
}

/* GIVEN more detections than slots, and than places to wait THEN the bearing of none that has no position is clear, and the count
 * of these is not 0. */
static void a_full_table_is_not_a_clear_sky(void) {
    for (int count = 1; count <= 30; count += count < 8 ? 1 : 11) {
        setUp();
        flown.detects = false;
        for (int frames = 0; frames < 40;) {
            goe_flight_assessment_t now;
            uint16_t sector_cm[GOE_FLIGHT_SECTORS];
            if (!flown_step(&flown)) {
                continue;
            }
            detect_row(100u, count);
            frames++;
            TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_assess(&flown.flight, flown_now_us(&flown), false, &now));
            TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_sectors(&flown.flight, 65000u, sector_cm));
            for (int i = 0; i < count; i++) {
                if (is_placed(100u + (uint32_t)i)) {
                    continue; /* its own place counts, which need not be where this box is */
                }
                TEST_ASSERT_GREATER_THAN(0, now.unplaced);
                const goe_box_t box = {50.0f + 38.0f * (float)i, 0.0f, 70.0f + 38.0f * (float)i, 0.0f, GOE_SIDES_ALL};
                TEST_ASSERT_NOT_EQUAL(65001u, sector_cm[sector_of(&box)]);
            }
        }
    }
}

/* GIVEN a box whose side another object hides, with an id or without one, or a detection that is no number next to a good one THEN the
 * bearing is not clear. */
static void a_detection_that_cannot_be_used_is_not_a_clear_sky(void) {
    for (int kind = 0; kind < 3; kind++) {
        setUp();
        flown.detects = false;
        for (int frames = 0; frames < 12;) {
            goe_flight_assessment_t now;
            uint16_t sector_cm[GOE_FLIGHT_SECTORS];
            goe_flight_detection_t detection[2];
            if (!flown_step(&flown)) {
                continue;
            }
            detection[0] = detection[1] = flown_detection(&flown, flown.sample - 1);
            detection[0].id = kind == 0 ? 0u : 5u;
            detection[0].box.sides = kind < 2 ? GOE_SIDE_LEFT | GOE_SIDE_RIGHT | GOE_SIDE_TOP : GOE_SIDES_ALL;
            detection[0].pixel_px = kind == 2 ? NAN : 0.0f;
            detection[1].id = 6u;
            detection[1].box.left_px = 1000.0f;
            detection[1].box.right_px = 1020.0f;
            const goe_flight_frame_t frame = flown_frame(&flown, flown.sample - 1, detection, 2);
            TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_frame(&flown.flight, &frame));
            frames++;
            TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_assess(&flown.flight, flown_now_us(&flown), false, &now));
            TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_sectors(&flown.flight, 65000u, sector_cm));
            if (!is_placed(5u)) {
                TEST_ASSERT_GREATER_THAN(0, now.unplaced);
                TEST_ASSERT_NOT_EQUAL(65001u, sector_cm[sector_of(&detection[0].box)]);
            }
        }
    }
}

/* GIVEN a false detection, or a crowd of them WHEN half an hour has passed, where times wrap THEN nothing is left of them. */
static void a_false_detection_is_forgotten_for_good(void) {
    for (int count = 1; count < 30; count += 27) {
        setUp();
        flown.detects = false;
        while (!flown_step(&flown)) {
        }
        detect_row(100u, count);
        const uint32_t from_us = flown_now_us(&flown);
        TEST_ASSERT_GREATER_THAN(0, assess_later(from_us, 1).unplaced);
        for (int tenths = 2; tenths < 80 * 60 * 10; tenths++) {
            const goe_flight_assessment_t now = assess_later(from_us, tenths);
            TEST_ASSERT_TRUE(tenths < 120 || now.unplaced == 0);
        }
        TEST_ASSERT_FALSE(flown.flight.waiting.crowded);
    }
}

/* A kept obstacle far behind, which no box of an image fits. The longer its time, the sooner it is evicted. */
static void keep_behind(int i, float tcpa_s) {
    goe_flight_slot_t *slot = &flown.flight.slot[i];
    slot->used = slot->remembered = slot->assessed = true;
    slot->id = 100u + (uint32_t)i;
    slot->valid = GOE_HAS_POSITION | GOE_HAS_WIDTH;
    slot->center_ne_m[0] = -500.0f;
    slot->hazard.tcpa_s = tcpa_s;
    slot->taken_us = slot->detected_us = flown_now_us(&flown);
}

/* GIVEN an order that passes the outline of another obstacle, or the gap to it WHEN a new obstacle needs a slot THEN it gets that of an
 * obstacle of which the order knows nothing; in a table without one, none. */
static void the_obstacles_of_an_order_are_not_evicted(void) {
    for (int spare = 0; spare < 2; spare++) {
        setUp();
        flown.detects = false;
        while (!flown_step(&flown)) {
        }
        for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
            keep_behind(i, i == 1 ? 100.0f : i == 2 && spare ? 20.0f : 0.5f);
        }
        flown.flight.reaction.action = GOE_FLIGHT_LEFT;
        flown.flight.reaction.slot = 0;
        flown.flight.reaction.edge = 1;
        flown.flight.reaction.gap = true;
        for (int frames = 0; frames < 4;) {
            if (flown_step(&flown)) {
                detect_row(500u, 1);
                frames++;
            }
        }
        TEST_ASSERT_EQUAL(spare, flown.flight.counters.evicted);
        TEST_ASSERT_EQUAL(spare, flown.flight.counters.full == 0);
        TEST_ASSERT_EQUAL_UINT32(100u, flown.flight.slot[0].id);
        TEST_ASSERT_EQUAL_UINT32(101u, flown.flight.slot[1].id);
        TEST_ASSERT_EQUAL_UINT32(spare ? 500u : 102u, flown.flight.slot[2].id);
        TEST_ASSERT_EQUAL(1, flown.flight.reaction.edge);
        TEST_ASSERT_TRUE(flown.flight.reaction.gap);
    }
}

/* GIVEN an order through a gap WHEN the obstacle on its other side is given up THEN the order knows of no gap any more. */
static void an_obstacle_that_is_given_up_leaves_no_gap(void) {
    (void)flown_fly(&flown, 3.04);
    keep_behind(1, 0.5f);
    flown.flight.slot[1].detected_us -= 121000000u;
    flown.flight.slot[1].hazard.tcpa_s = 0.0f;
    flown.flight.reaction.action = GOE_FLIGHT_LEFT;
    flown.flight.reaction.slot = 0;
    flown.flight.reaction.side = -1;
    flown.flight.reaction.edge = 1;
    flown.flight.reaction.gap = true;
    goe_flight_table_age(&flown.flight, flown_now_us(&flown));
    TEST_ASSERT_FALSE(flown.flight.slot[1].used);
    TEST_ASSERT_EQUAL(0, flown.flight.reaction.slot);
    TEST_ASSERT_EQUAL(-1, flown.flight.reaction.edge);
    TEST_ASSERT_FALSE(flown.flight.reaction.gap);
}

/* GIVEN an obstacle WHEN the own attitude or position is no longer known THEN it cannot be reported. */
static void without_a_pose_no_obstacle_is_reported(void) {
    goe_flight_obstacle_t obstacle;
    (void)flown_fly(&flown, 3.0);
    const goe_flight_t kept = flown.flight;
    flown.flight.history.position_count = 0;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_NO_POSE, goe_flight_obstacle(&flown.flight, 0, &obstacle));
    flown.flight = kept;
    flown.flight.history.attitude_count = 0;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_NO_POSE, goe_flight_obstacle(&flown.flight, 0, &obstacle));
    flown.flight = kept;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_obstacle(&flown.flight, 0, &obstacle));
}

/* [flight.delay_max_s] */
static void early_frames_are_kept_by_the_caller(void) {
    (void)flown_fly(&flown, 2.0);
    const goe_flight_detection_t detection = flown_detection(&flown, flown.sample);
    goe_flight_frame_t frame = flown_frame(&flown, flown.sample, &detection, 1);
    goe_flight_t before = flown.flight;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_TOO_NEW, goe_flight_frame(&flown.flight, &frame));
    before.counters.early++;
    TEST_ASSERT_EQUAL_MEMORY(&before, &flown.flight, sizeof before);
    (void)flown_step(&flown);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_frame(&flown.flight, &frame));
    frame = flown_frame(&flown, flown.sample - 25, &detection, 1); /* half a second ago: more than delay_max_s */
    TEST_ASSERT_EQUAL(GOE_FLIGHT_TOO_OLD, goe_flight_frame(&flown.flight, &frame));
    TEST_ASSERT_EQUAL(1, flown.flight.counters.late);
}

/* GIVEN an autopilot whose clock was set back by less than a second WHEN the layer has restarted with the 16th of its times THEN frames are taken
 * from the first samples on. */
static void frames_are_taken_after_a_clock_was_set_back(void) {
    (void)flown_fly(&flown, 3.0);
    flown.start_us -= 900000u;
    int refused = 0;
    for (int k = 0; k < 20; k++) {
        goe_flight_attitude_t attitude;
        goe_flight_position_t position;
        flown_samples(&flown, flown.sample++, &attitude, &position);
        refused += goe_flight_attitude(&flown.flight, &attitude) != GOE_FLIGHT_OK ? 1 : 0;
        (void)goe_flight_position(&flown.flight, &position);
    }
    TEST_ASSERT_EQUAL(16, refused);
    TEST_ASSERT_EQUAL(1, flown.flight.counters.lost);
    const goe_flight_frame_t frame = flown_frame(&flown, flown.sample - 2, NULL, 0);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_frame(&flown.flight, &frame));
}

/* Detections of one image in several calls. */
static void an_image_may_come_in_parts(void) {
    for (int k = 0; k < 60; k++) {
        if (!flown_step(&flown)) {
            continue;
        }
        const int exposed = flown.sample - 1;
        goe_flight_detection_t pair[2] = {flown_detection(&flown, exposed), flown_detection(&flown, exposed)};
        pair[0].id = 21u;
        pair[1].id = 22u;
        pair[1].box.left_px += 300.0f;
        pair[1].box.right_px += 300.0f;
        for (int i = 0; i < 2; i++) {
            goe_flight_frame_t frame = flown_frame(&flown, exposed, &pair[i], 1);
            frame.number = 2;
            TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_frame(&flown.flight, &frame));
        }
    }
    int in_view = 0;
    for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
        const goe_flight_slot_t *slot = &flown.flight.slot[i];
        in_view += slot->used && slot->in_view && (slot->id == 21u || slot->id == 22u || slot->id == 7u) ? 1 : 0;
    }
    TEST_ASSERT_TRUE(in_view >= 2);
}

static void the_autopilots_clock_may_wrap(void) {
    static flown_t other;
    flown_start(&other, NULL);
    other.start_us = 0xFFFFFFFFu - 2000000u;
    const goe_flight_assessment_t here = flown_fly(&flown, 4.0);
    const goe_flight_assessment_t there = flown_fly(&other, 4.0);
    CHECK_SAME(here.hazard.tcpa_s, there.hazard.tcpa_s);
    CHECK_SAME(here.hazard.conflict_probability, there.hazard.conflict_probability);
    TEST_ASSERT_EQUAL(1, there.obstacles);
    TEST_ASSERT_EQUAL(0, other.flight.counters.late);
}

/* [flight.score_min] GIVEN a track THEN a weak detection, or one of no numbers, is nobody's: it shows no obstacle, and takes none over. */
static void an_unassigned_detection_belongs_to_no_track(void) {
    for (int kind = 0; kind < 4; kind++) {
        setUp();
        (void)flown_fly(&flown, 3.0);
        const uint32_t detected_us = flown.flight.slot[0].detected_us;
        TEST_ASSERT_TRUE(flown.flight.slot[0].in_view);
        goe_flight_detection_t detection = flown_detection(&flown, flown.sample - 1);
        detection.id = kind % 2 == 0 ? 99u : 7u;
        detection.score = kind < 2 ? 0.1f : check_from_bits(0x7FC00000u);
        const goe_flight_frame_t frame = flown_frame(&flown, flown.sample - 1, &detection, 1);
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_frame(&flown.flight, &frame));
        TEST_ASSERT_EQUAL_UINT32(7u, flown.flight.slot[0].id);
        TEST_ASSERT_EQUAL_UINT32(detected_us, flown.flight.slot[0].detected_us);
        TEST_ASSERT_FALSE(flown.flight.slot[0].in_view);
        TEST_ASSERT_EQUAL(1, slots_used());
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(an_unassigned_detection_belongs_to_no_track);
    RUN_TEST(an_obstacle_is_found_where_it_is);
    RUN_TEST(the_size_of_a_class_is_used);
    RUN_TEST(valid_lists_the_fields_of_an_obstacle);
    RUN_TEST(a_track_without_a_position_is_not_suspect);
    RUN_TEST(a_prediction_is_no_image);
    RUN_TEST(a_dead_detector_stays_dead);
    RUN_TEST(unreadable_input_is_no_sign_of_life);
    RUN_TEST(an_obstacle_ahead_is_not_forgotten);
    RUN_TEST(a_height_counts_as_far_as_it_is_valid);
    RUN_TEST(the_hazard_counts_from_now);
    RUN_TEST(a_new_obstacle_waits_for_its_confirmation);
    RUN_TEST(a_low_score_is_not_looked_at);
    RUN_TEST(no_score_hides_no_obstacle);
    RUN_TEST(false_detections_evict_nobody);
    RUN_TEST(a_renumbered_obstacle_keeps_its_track);
    RUN_TEST(a_box_of_another_size_takes_nothing_over);
    RUN_TEST(a_detector_without_ids_is_followed_by_place);
    RUN_TEST(another_obstacle_takes_nothing_over);
    RUN_TEST(a_vanished_obstacle_is_given_up);
    RUN_TEST(an_order_does_not_pass_to_the_next_in_its_slot);
    RUN_TEST(a_dead_detector_is_not_a_clear_sky);
    RUN_TEST(a_detection_without_a_position_is_not_a_clear_sky);
    RUN_TEST(a_detection_that_waits_is_not_a_clear_sky);
    RUN_TEST(a_turn_leaves_the_bearing_of_a_detection);
    RUN_TEST(a_full_table_is_not_a_clear_sky);
    RUN_TEST(a_detection_that_cannot_be_used_is_not_a_clear_sky);
    RUN_TEST(a_false_detection_is_forgotten_for_good);
    RUN_TEST(the_obstacles_of_an_order_are_not_evicted);
    RUN_TEST(an_obstacle_that_is_given_up_leaves_no_gap);
    RUN_TEST(without_a_pose_no_obstacle_is_reported);
    RUN_TEST(early_frames_are_kept_by_the_caller);
    RUN_TEST(frames_are_taken_after_a_clock_was_set_back);
    RUN_TEST(an_image_may_come_in_parts);
    RUN_TEST(the_autopilots_clock_may_wrap);
    return UNITY_END();
}
