/* The test scene by GOE_FEATURES: the flight layer answers as for the detector's own boxes, to the last bit if those are
 * rounded as on the wire, and otherwise within a sigma. SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "any_message.h"
#include "check.h"
#include "flown.h"
#include "goe_mavlink_map.h"

#define SECONDS 6
#define HALF_PX 640.0f

static flown_t by_message, by_box;

void setUp(void) {
    flown_start(&by_message, NULL);
    flown_start(&by_box, NULL);
}
void tearDown(void) {}

static int16_t tenths(float px) { return (int16_t)lround(10.0 * ((double)px - (double)HALF_PX)); }

static float rounded(float px) { return HALF_PX + 0.1f * (float)tenths(px); }

static goe_mavlink_features_t features_of(const goe_flight_frame_t *frame) {
    const goe_flight_detection_t *d = frame->detection;
    goe_mavlink_features_t features;
    memset(&features, 0, sizeof features);
    features.time_usec = frame->capture_us;
    features.obstacle_id = d->id;
    features.box[GOE_MAVLINK_LEFT] = tenths(d->box.left_px);
    features.box[GOE_MAVLINK_TOP] = tenths(d->box.top_px);
    features.box[GOE_MAVLINK_RIGHT] = tenths(d->box.right_px);
    features.box[GOE_MAVLINK_BOTTOM] = tenths(d->box.bottom_px);
    features.time_sd = (uint16_t)frame->time_sd_us;
    features.image_width = features.image_height = (uint16_t)(2.0f * HALF_PX);
    features.visible = d->box.sides;
    features.number = frame->number;
    features.score = (uint8_t)lround(100.0 * (double)d->score);
    return features;
}

/* Packed, read and mapped. */
static void send(flown_t *flown, const goe_flight_frame_t *frame) {
    goe_mavlink_sighting_t sighting;
    uint8_t payload[GOE_MAVLINK_PAYLOAD_MAX];
    const goe_mavlink_features_t sent = features_of(frame);
    goe_mavlink_features_t received;
    const size_t length = goe_mavlink_pack_features(&sent, payload);
    goe_mavlink_read_features(payload, length, &received);
    TEST_ASSERT_TRUE(goe_mavlink_from_features(&received, frame->arrival_us, &sighting));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_frame(&flown->flight, &sighting.frame));
}

static void round_box(goe_box_t *box) {
    box->left_px = rounded(box->left_px);
    box->top_px = rounded(box->top_px);
    box->right_px = rounded(box->right_px);
    box->bottom_px = rounded(box->bottom_px);
}

static void step(flown_t *flown, bool message, bool round) {
    goe_flight_attitude_t attitude;
    goe_flight_position_t position;
    flown_samples(flown, flown->sample, &attitude, &position);
    flown->sample++;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_attitude(&flown->flight, &attitude));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_position(&flown->flight, &position));
    const int exposed = flown->sample - 1 - FLOWN_DELAY;
    if (exposed < 0 || exposed % FLOWN_IMAGE_EVERY != 0) {
        return;
    }
    goe_flight_detection_t detection = flown_detection(flown, exposed);
    TEST_ASSERT_EQUAL_HEX8(GOE_SIDES_ALL, detection.box.sides);
    const goe_flight_frame_t frame = flown_frame(flown, exposed, &detection, 1);
    if (round) {
        round_box(&detection.box);
    }
    if (message) {
        send(flown, &frame);
    } else {
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_frame(&flown->flight, &frame));
    }
}

static void fly(bool round, goe_flight_obstacle_t *of_message, goe_flight_obstacle_t *of_box) {
    goe_flight_assessment_t assessment;
    for (int k = 0; k < SECONDS * FLOWN_POSE_HZ; k++) {
        step(&by_message, true, false);
        step(&by_box, false, round);
    }
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK,
                      goe_flight_assess(&by_message.flight, flown_now_us(&by_message), false, &assessment));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_assess(&by_box.flight, flown_now_us(&by_box), false, &assessment));
    TEST_ASSERT_EQUAL(1, assessment.obstacles);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_obstacle(&by_message.flight, 0, of_message));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_obstacle(&by_box.flight, 0, of_box));
    TEST_ASSERT_TRUE((of_box->valid & GOE_HAS_POSITION) != 0u);
}

static void a_box_of_whole_tenths_arrives_to_the_last_bit(void) {
    goe_flight_obstacle_t of_message;
    goe_flight_obstacle_t of_box;
    fly(true, &of_message, &of_box);
    TEST_ASSERT_EQUAL_MEMORY(&of_box, &of_message, sizeof of_box);
}

static void rounding_costs_less_than_a_sigma(void) {
    goe_flight_obstacle_t of_message;
    goe_flight_obstacle_t of_box;
    fly(false, &of_message, &of_box);
    const double north_m = (double)of_message.center_ned_m[0] - (double)of_box.center_ned_m[0];
    const double east_m = (double)of_message.center_ned_m[1] - (double)of_box.center_ned_m[1];
    const double sigma_m = sqrt((double)of_box.covariance_ne_m2[0] + (double)of_box.covariance_ne_m2[2]);
    check_report("by rounding to 0.1 px, m", hypot(north_m, east_m));
    check_report("one sigma, m", sigma_m);
    TEST_ASSERT_TRUE(hypot(north_m, east_m) < 0.2 * sigma_m);
}

/* One sample and the message of an obstacle of which nothing is visible. */
static void step_blindly(uint32_t id) {
    goe_flight_attitude_t attitude;
    goe_flight_position_t position;
    goe_mavlink_features_t features;
    goe_mavlink_sighting_t sighting;
    flown_samples(&by_message, by_message.sample, &attitude, &position);
    by_message.sample++;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_attitude(&by_message.flight, &attitude));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_position(&by_message.flight, &position));
    memset(&features, 0, sizeof features);
    features.time_base = GOE_FLIGHT_AGE;
    features.obstacle_id = id;
    features.image_width = features.image_height = (uint16_t)(2.0f * HALF_PX);
    features.number = 1u;
    (void)goe_mavlink_from_features(&features, flown_now_us(&by_message), &sighting);
    (void)goe_flight_frame(&by_message.flight, &sighting.frame);
}

/* The detector is alive, and nothing is clear. */
static void an_obstacle_that_shows_nothing_clears_nothing(void) {
    goe_flight_assessment_t assessment;
    uint16_t sector_cm[GOE_FLIGHT_SECTORS];
    for (uint32_t id = 0u; id < 2u; id++) {
        setUp();
        for (int k = 0; k < SECONDS * FLOWN_POSE_HZ; k++) {
            step_blindly(id);
        }
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK,
                          goe_flight_assess(&by_message.flight, flown_now_us(&by_message), false, &assessment));
        TEST_ASSERT_TRUE(assessment.detector_alive);
        TEST_ASSERT_EQUAL(0, assessment.obstacles);
        TEST_ASSERT_TRUE(assessment.unplaced > 0);
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_sectors(&by_message.flight, 20000u, sector_cm));
        for (int i = 0; i < GOE_FLIGHT_SECTORS; i++) {
            TEST_ASSERT_EQUAL_UINT16(GOE_FLIGHT_SECTOR_UNKNOWN, sector_cm[i]);
        }
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(an_obstacle_that_shows_nothing_clears_nothing);
    RUN_TEST(a_box_of_whole_tenths_arrives_to_the_last_bit);
    RUN_TEST(rounding_costs_less_than_a_sigma);
    return UNITY_END();
}
