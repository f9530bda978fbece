/* For any input: no number out of its range, no byte written outside, and finite numbers only where the headers promise them.
 * SPDX-License-Identifier: MIT
 *
 * Payloads, structures and answers are random bits, checked by their bits alone, so that the test also works if the sources were
 * compiled with -ffast-math. GOE_TEST_SEED and GOE_TEST_UPDATES set seed and length. */
#include <stdlib.h>
#include <string.h>

#include "any_message.h"
#include "check.h"
#include "goe_mavlink_map.h"

#define CALLS_EACH 40000
#define GUARD 0xC3

static check_random_t any;

void setUp(void) { any = check_random_start("MAVLink safety"); }
void tearDown(void) {}

static int calls_each(void) {
    const char *wanted = getenv("GOE_TEST_UPDATES");
    return wanted ? (int)strtol(wanted, NULL, 0) : CALLS_EACH;
}

static bool one_in(uint32_t n) { return check_random_bits(&any) % n == 0u; }

static void random_bytes(void *to, size_t count) {
    uint8_t *bytes = (uint8_t *)to;
    for (size_t i = 0; i < count; i++) {
        bytes[i] = (uint8_t)check_random_bits(&any);
    }
}

/* A number of plausible size; sometimes arbitrary bits. */
static float some(double low, double high) {
    return one_in(20) ? check_from_bits(check_random_bits(&any)) : (float)check_random_between(&any, low, high);
}

static void fill(float *numbers, int count, double low, double high) {
    for (int i = 0; i < count; i++) {
        numbers[i] = some(low, high);
    }
}

static void check_floats(const float *numbers, int count) {
    for (int i = 0; i < count; i++) {
        TEST_ASSERT_TRUE(check_is_finite(numbers[i]));
    }
}

/* --------------------------------------------------------------------------------------------------------------- in -- */

static void check_pixel(const goe_pixel_t *pixel) {
    check_floats(&pixel->u_px, 1);
    check_floats(&pixel->v_px, 1);
}

static void check_sighting(bool has, const goe_mavlink_sighting_t *sighting) {
    const goe_flight_detection_t *d = &sighting->detection;
    TEST_ASSERT_EQUAL_UINT8(has ? 1u : 0u, sighting->frame.count);
    TEST_ASSERT_TRUE(sighting->frame.camera < GOE_CAMERAS_MAX || sighting->frame.camera == 255u);
    TEST_ASSERT_TRUE(!has || sighting->frame.camera != 255u);
    TEST_ASSERT_EQUAL_PTR(d, sighting->frame.detection);
    check_floats(&d->score, 2);
    check_floats(&d->box.left_px, 4);
    check_pixel(&d->left);
    check_pixel(&d->right);
    check_pixel(&d->top);
    check_pixel(&d->base_left);
    check_pixel(&d->base_near);
    check_pixel(&d->base_right);
}

static goe_mavlink_camera_t some_camera(void) {
    goe_mavlink_camera_t camera;
    memset(&camera, 0, sizeof camera);
    fill(&camera.width_px, 6, 100.0, 2000.0);
    camera.number = (uint8_t)(one_in(20) ? check_random_bits(&any) : 0u);
    camera.delay_us = check_random_bits(&any);
    camera.shares_clock = one_in(2);
    return camera;
}

static bool fuzz_features(void) {
    goe_mavlink_features_t features;
    goe_mavlink_sighting_t sighting;
    uint8_t payload[GOE_MAVLINK_PAYLOAD_MAX];
    random_bytes(payload, sizeof payload);
    goe_mavlink_read_features(payload, check_random_bits(&any) % sizeof payload, &features);
    features.time_base = (uint8_t)(features.time_base % 4u);
    features.camera_id = (uint8_t)(one_in(20) ? features.camera_id : 0u);
    const bool has = goe_mavlink_from_features(&features, check_random_bits(&any), &sighting);
    check_sighting(has, &sighting);
    return has;
}

static bool fuzz_landing_target(void) {
    const goe_mavlink_camera_t camera = some_camera();
    goe_mavlink_landing_target_t target;
    goe_mavlink_sighting_t sighting;
    random_bytes(&target, sizeof target);
    fill(&target.angle_x, 2, -1.2, 1.2);
    fill(&target.size_x, 2, -0.1, 0.5);
    const bool has = goe_mavlink_from_landing_target(&target, &camera, check_random_bits(&any), &sighting);
    check_sighting(has, &sighting);
    return has;
}

static bool fuzz_tracking(void) {
    const goe_mavlink_camera_t camera = some_camera();
    goe_mavlink_tracking_t tracking;
    goe_mavlink_sighting_t sighting;
    random_bytes(&tracking, sizeof tracking);
    fill(&tracking.point_x, 7, 0.0, 1.0);
    tracking.tracking_status = (uint8_t)(one_in(5) ? tracking.tracking_status : 1u);
    tracking.tracking_mode = (uint8_t)(tracking.tracking_mode % 4u);
    const bool has = goe_mavlink_from_tracking(&tracking, &camera, check_random_bits(&any), &sighting);
    check_sighting(has, &sighting);
    return has;
}

static void what_comes_in_is_finite_or_refused(void) {
    int features = 0;
    int targets = 0;
    int tracked = 0;
    const int calls = calls_each();
    for (int k = 0; k < calls; k++) {
        features += fuzz_features() ? 1 : 0;
        targets += fuzz_landing_target() ? 1 : 0;
        tracked += fuzz_tracking() ? 1 : 0;
    }
    TEST_ASSERT_TRUE(features > calls / 20 && targets > calls / 20 && tracked > calls / 20);
}

/* -------------------------------------------------------------------------------------------------------------- out -- */

static goe_flight_obstacle_t some_obstacle(void) {
    goe_flight_obstacle_t obstacle;
    memset(&obstacle, 0, sizeof obstacle);
    obstacle.id = check_random_bits(&any);
    obstacle.valid = check_random_bits(&any);
    obstacle.model = (goe_model_t)(check_random_bits(&any) % 6u);
    obstacle.suspect = one_in(2);
    obstacle.has_hazard = one_in(2);
    fill(&obstacle.age_s, 1, 0.0, 20.0);
    fill(obstacle.center_ned_m, 3, -1.0e4, 1.0e4);
    fill(obstacle.covariance_ne_m2, 3, 0.0, 1.0e3);
    fill(&obstacle.height_m, 1, 0.0, 200.0);
    fill(obstacle.nearest_body_m, 3, -1.0, 1.0);
    fill(&obstacle.hazard.tcpa_s, 7, 0.0, 1.0);
    obstacle.hazard.has_clearance = one_in(2);
    return obstacle;
}

static goe_mavlink_own_t some_own(void) {
    goe_mavlink_own_t own;
    memset(&own, 0, sizeof own);
    random_bytes(&own.time_usec, sizeof own.time_usec);
    random_bytes(&own.unix_usec, sizeof own.unix_usec);
    fill(own.position_ned_m, 3, -1.0e4, 1.0e4);
    own.origin_known = !one_in(5);
    own.origin_alt_m = some(-400.0, 9000.0);
    own.heading_deg = some(-720.0, 720.0);
    return own;
}

static goe_flight_assessment_t some_assessment(void) {
    goe_flight_assessment_t assessment;
    memset(&assessment, 0, sizeof assessment);
    assessment.action = (goe_flight_action_t)(check_random_bits(&any) % 6u);
    assessment.worst = (int8_t)((int)(check_random_bits(&any) % 5u) - 1);
    assessment.avoided = (int8_t)((int)(check_random_bits(&any) % 5u) - 1);
    assessment.late = one_in(2);
    fill(&assessment.needed_s, 4, 0.0, 1.0e3);
    return assessment;
}

static void fuzz_distance(const goe_mavlink_own_t *own) {
    uint16_t sector_cm[GOE_FLIGHT_SECTORS];
    goe_mavlink_obstacle_distance_t m;
    random_bytes(sector_cm, sizeof sector_cm);
    const uint16_t max_cm = (uint16_t)check_random_bits(&any);
    const bool written = goe_mavlink_to_obstacle_distance(sector_cm, max_cm, check_random_bits(&any) % 100u, own, &m);
    check_floats(&m.increment_f, 2);
    for (int i = 0; written && i < GOE_FLIGHT_SECTORS; i++) {
        TEST_ASSERT_TRUE(m.distances[i] >= 1u && (m.distances[i] <= max_cm + 1u || m.distances[i] == 65535u));
    }
}

static void fuzz_vehicle(const goe_flight_obstacle_t *obstacle, const goe_mavlink_own_t *own) {
    goe_mavlink_adsb_vehicle_t m;
    const int slot = (int)(check_random_bits(&any) % 2000u) - 1000;
    const bool written = goe_mavlink_to_adsb_vehicle(obstacle, slot, check_random_bits(&any), own, &m);
    TEST_ASSERT_TRUE(m.icao_address <= 0xFFFFFFu);
    TEST_ASSERT_EQUAL(0, m.callsign[8]);
    TEST_ASSERT_TRUE(!written || (m.altitude >= -2000000000 && m.altitude <= 2000000000));
}

static void fuzz_out(void) {
    const goe_flight_obstacle_t obstacle = some_obstacle();
    const goe_flight_assessment_t assessment = some_assessment();
    const goe_mavlink_own_t own = some_own();
    const int slot = (int)(check_random_bits(&any) % 4u);
    goe_flight_counters_t counters;
    goe_mavlink_obstacle_t message;
    goe_mavlink_hazard_t hazard;
    goe_mavlink_status_t status;
    goe_mavlink_obstacle_distance_3d_t distance_3d;
    goe_mavlink_collision_t collision;
    goe_mavlink_target_absolute_t target;
    random_bytes(&counters, sizeof counters);
    goe_mavlink_to_obstacle(&obstacle, slot, &own, &message);
    TEST_ASSERT_TRUE(own.origin_known || message.lat == INT32_MAX);
    (void)goe_mavlink_to_hazard(&obstacle, slot, &assessment, &own, &hazard);
    TEST_ASSERT_TRUE((hazard.flags & GOE_MAVLINK_ORDER) != 0u || hazard.action == 0u);
    goe_mavlink_to_status(&counters, &assessment, check_random_bits(&any), &own, &status);
    (void)goe_mavlink_to_obstacle_distance_3d(&obstacle, some(0.0, 500.0), &own, &distance_3d);
    (void)goe_mavlink_to_collision(&obstacle, slot, &assessment, some(0.0, 1.0), &collision);
    TEST_ASSERT_TRUE(collision.threat_level <= 2u && collision.action >= 1u && collision.action <= 6u);
    (void)goe_mavlink_to_target_absolute(&obstacle, slot, &own, &target);
    fuzz_distance(&own);
    fuzz_vehicle(&obstacle, &own);
}

static void what_goes_out_is_in_its_range(void) {
    const int calls = calls_each();
    for (int k = 0; k < calls; k++) {
        fuzz_out();
    }
}

/* ------------------------------------------------------------------------------------------------------------ codec -- */

static void nothing_outside_is_touched(void) {
    const int calls = calls_each();
    for (int k = 0; k < calls; k++) {
        const goe_mavlink_message_t message = (goe_mavlink_message_t)(k % (int)GOE_MAVLINK_MESSAGES);
        const size_t most = goe_mavlink_info(message)->length;
        goe_mavlink_sender_t sender = {1u, 1u, (uint8_t)k};
        uint8_t received[GOE_MAVLINK_PAYLOAD_MAX];
        uint8_t payload[GOE_MAVLINK_PAYLOAD_MAX + 1];
        uint8_t frame[GOE_MAVLINK_FRAME_MAX + 1];
        any_message_t fields;
        memset(payload, GUARD, sizeof payload);
        memset(frame, GUARD, sizeof frame);
        random_bytes(received, sizeof received);
        any_message_read(message, received, check_random_bits(&any) % sizeof received, &fields);
        const size_t length = any_message_pack(message, &fields, payload);
        TEST_ASSERT_TRUE(length >= 1u && length <= most);
        TEST_ASSERT_EQUAL_HEX8(GUARD, payload[most]);
        const size_t size = goe_mavlink_frame(&sender, message, payload, length, frame);
        TEST_ASSERT_EQUAL(length + 12u, size);
        TEST_ASSERT_EQUAL_HEX8(GUARD, frame[size]);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(what_comes_in_is_finite_or_refused);
    RUN_TEST(what_goes_out_is_in_its_range);
    RUN_TEST(nothing_outside_is_touched);
    return UNITY_END();
}
