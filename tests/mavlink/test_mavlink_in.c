/* From messages to frames of the flight layer: pixels, times and refused input. SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "check.h"
#include "goe_mavlink_map.h"

#define ARRIVAL_US 2000000u

static goe_mavlink_features_t features;
static goe_mavlink_landing_target_t target;
static goe_mavlink_tracking_t tracking;
static goe_mavlink_camera_t camera;
static goe_mavlink_sighting_t sighting;

void setUp(void) {
    memset(&features, 0, sizeof features);
    memset(&target, 0, sizeof target);
    memset(&tracking, 0, sizeof tracking);
    memset(&camera, 0, sizeof camera);
    memset(&sighting, 0xA5, sizeof sighting);
    features.time_usec = 1900000u;
    features.obstacle_id = 70000u;
    features.image_width = 1281u; /* odd: its middle is at 640.5 */
    features.image_height = 960u;
    features.visible = GOE_MAVLINK_FEATURE_BOX;
    features.number = 2u;
    features.score = 85u;
    camera.width_px = 1000.0f;
    camera.height_px = 800.0f;
    camera.fx_px = 900.0f;
    camera.fy_px = 850.0f;
    camera.cx_px = 510.0f;
    camera.cy_px = 390.0f;
    camera.delay_us = 150000u;
    camera.delay_sd_us = 20000u;
}
void tearDown(void) {}

static void check_not_understood(void) {
    TEST_ASSERT_EQUAL_UINT8(255u, sighting.frame.camera);
    TEST_ASSERT_EQUAL_UINT8(0u, sighting.frame.count);
}

static void check_empty(uint8_t number) {
    TEST_ASSERT_EQUAL_UINT8(camera.number, sighting.frame.camera);
    TEST_ASSERT_EQUAL_UINT8(0u, sighting.frame.count);
    TEST_ASSERT_EQUAL_UINT8(number, sighting.frame.number);
}

static void check_box(double left, double top, double right, double bottom) {
    CHECK_CLOSE(2e-3, left, sighting.detection.box.left_px);
    CHECK_CLOSE(2e-3, top, sighting.detection.box.top_px);
    CHECK_CLOSE(2e-3, right, sighting.detection.box.right_px);
    CHECK_CLOSE(2e-3, bottom, sighting.detection.box.bottom_px);
    TEST_ASSERT_EQUAL_HEX8(GOE_SIDES_ALL, sighting.detection.box.sides);
    TEST_ASSERT_EQUAL_PTR(&sighting.detection, sighting.frame.detection);
    TEST_ASSERT_EQUAL_UINT8(1u, sighting.frame.count);
}

/* -------------------------------------------------------------------------------------------------------- features -- */

static void features_are_tenths_from_the_middle(void) {
    const int16_t box[4] = {-32768, -1, 15, 32767};
    memcpy(features.box, box, sizeof box);
    features.pixel_sd = 25u;
    TEST_ASSERT_TRUE(goe_mavlink_from_features(&features, ARRIVAL_US, &sighting));
    check_box(640.5 - 3276.8, 479.9, 642.0, 480.0 + 3276.7);
    TEST_ASSERT_EQUAL_UINT32(70000u, sighting.detection.id);
    CHECK_CLOSE(1e-6, 0.85, sighting.detection.score);
    CHECK_CLOSE(1e-6, 2.5, sighting.detection.pixel_px);
    TEST_ASSERT_EQUAL_UINT8(2u, sighting.frame.number);
    TEST_ASSERT_FALSE(sighting.detection.left.visible || sighting.detection.base_right.visible);
}

static void points_keep_their_order(void) {
    features.visible = 0;
    for (int i = 0; i < GOE_MAVLINK_POINTS; i++) {
        features.u[i] = (int16_t)(100 * i);
        features.v[i] = (int16_t)(-10 * i);
    }
    for (int i = 0; i < GOE_MAVLINK_POINTS; i++) {
        features.visible = (uint16_t)(GOE_MAVLINK_FEATURE_POINT << i);
        TEST_ASSERT_TRUE(goe_mavlink_from_features(&features, ARRIVAL_US, &sighting));
        const goe_flight_detection_t *d = &sighting.detection;
        const goe_pixel_t points[] = {d->left, d->right, d->top, d->base_left, d->base_near, d->base_right};
        for (int k = 0; k < GOE_MAVLINK_POINTS; k++) {
            TEST_ASSERT_EQUAL(k == i, points[k].visible);
            CHECK_CLOSE(1e-3, 640.5 + 10.0 * k, points[k].u_px);
            CHECK_CLOSE(1e-3, 480.0 - k, points[k].v_px);
        }
        TEST_ASSERT_EQUAL_HEX8(0, d->box.sides);
    }
}

/* Centimeters; a shorter message, without these fields, has no kind. */
static void a_kind_is_read_in_centimeters(void) {
    uint8_t payload[GOE_MAVLINK_PAYLOAD_MAX];
    features.kind_width = 330u;
    features.kind_width_sd = 87u;
    features.kind_height = 65535u;
    features.kind_height_sd = 1000u;
    features.kind_shape = GOE_KIND_OTHER;
    const size_t length = goe_mavlink_pack_features(&features, payload);
    TEST_ASSERT_EQUAL_UINT(70u, length);
    goe_mavlink_read_features(payload, length, &features);
    TEST_ASSERT_TRUE(goe_mavlink_from_features(&features, ARRIVAL_US, &sighting));
    const goe_kind_t *kind = &sighting.detection.kind;
    CHECK_CLOSE(1e-5, 3.3, kind->width_m);
    CHECK_CLOSE(1e-5, 0.87, kind->width_sd_m);
    CHECK_CLOSE(1e-3, 655.35, kind->height_m);
    CHECK_CLOSE(1e-5, 10.0, kind->height_sd_m);
    TEST_ASSERT_EQUAL_UINT8(GOE_KIND_OTHER, kind->shape);
    goe_mavlink_read_features(payload, 61u, &features);
    TEST_ASSERT_TRUE(goe_mavlink_from_features(&features, ARRIVAL_US, &sighting));
    CHECK_SAME(0.0f, kind->width_m);
    CHECK_SAME(0.0f, kind->height_m);
    TEST_ASSERT_EQUAL_UINT8(GOE_KIND_UNKNOWN, kind->shape);
}

static void times_are_of_their_clock(void) {
    features.time_usec = 0x1200000034u; /* beyond 32 bits: modulo */
    features.age_usec = 40000u;
    features.time_sd = 700u;
    features.time_base = GOE_FLIGHT_SENDER_CLOCK;
    TEST_ASSERT_TRUE(goe_mavlink_from_features(&features, ARRIVAL_US, &sighting));
    TEST_ASSERT_EQUAL_UINT32(0x34u, sighting.frame.capture_us);
    TEST_ASSERT_EQUAL_UINT32(0x34u + 40000u, sighting.frame.sent_us);
    TEST_ASSERT_EQUAL_UINT32(700u, sighting.frame.time_sd_us);
    TEST_ASSERT_EQUAL_UINT32(ARRIVAL_US, sighting.frame.arrival_us);
    features.age_usec = 0u; /* not known */
    TEST_ASSERT_TRUE(goe_mavlink_from_features(&features, ARRIVAL_US, &sighting));
    TEST_ASSERT_EQUAL_UINT32(sighting.frame.capture_us, sighting.frame.sent_us);
    features.age_usec = 40000u;
    features.time_base = GOE_FLIGHT_AGE;
    TEST_ASSERT_TRUE(goe_mavlink_from_features(&features, ARRIVAL_US, &sighting));
    TEST_ASSERT_EQUAL_UINT32(40000u, sighting.frame.capture_us);
    features.time_base = GOE_FLIGHT_AUTOPILOT_CLOCK;
    TEST_ASSERT_TRUE(goe_mavlink_from_features(&features, ARRIVAL_US, &sighting));
    TEST_ASSERT_EQUAL_UINT32(0x34u, sighting.frame.capture_us);
    TEST_ASSERT_EQUAL_UINT8(GOE_FLIGHT_AUTOPILOT_CLOCK, sighting.frame.time_base);
}

static void a_score_that_is_not_known_is_whole(void) {
    const uint8_t scores[] = {0u, 30u, 100u, 101u, 254u, 255u};
    const double expected[] = {0.0, 0.3, 1.0, 1.0, 1.0, 1.0};
    for (int i = 0; i < 6; i++) {
        features.score = scores[i];
        TEST_ASSERT_TRUE(goe_mavlink_from_features(&features, ARRIVAL_US, &sighting));
        CHECK_CLOSE(1e-6, expected[i], sighting.detection.score);
        TEST_ASSERT_TRUE(sighting.detection.score <= 1.0f);
    }
}

static void an_image_without_detections_shows_that_the_detector_is_alive(void) {
    features.number = 0u;
    features.image_width = 0u; /* of no use then */
    TEST_ASSERT_FALSE(goe_mavlink_from_features(&features, ARRIVAL_US, &sighting));
    check_empty(0u);
    TEST_ASSERT_EQUAL_UINT32(1900000u, sighting.frame.capture_us);
}

/* An obstacle of which nothing is visible is no image without obstacles: it is one that cannot be located. */
static void an_obstacle_that_shows_nothing_is_one_nevertheless(void) {
    for (uint8_t number = 1; number <= 2; number++) {
        features.number = number;
        features.visible = 0xFC00u; /* bits without a meaning yet */
        TEST_ASSERT_TRUE(goe_mavlink_from_features(&features, ARRIVAL_US, &sighting));
        TEST_ASSERT_EQUAL_UINT8(number, sighting.frame.number);
        TEST_ASSERT_EQUAL_UINT8(1u, sighting.frame.count);
        TEST_ASSERT_EQUAL_HEX8(0u, sighting.detection.box.sides);
        TEST_ASSERT_FALSE(sighting.detection.left.visible || sighting.detection.base_right.visible);
    }
}

static void what_cannot_be_understood_has_no_camera(void) {
    features.time_base = 3u;
    TEST_ASSERT_FALSE(goe_mavlink_from_features(&features, ARRIVAL_US, &sighting));
    check_not_understood();
    features.time_base = 0u;
    features.camera_id = GOE_CAMERAS_MAX;
    TEST_ASSERT_FALSE(goe_mavlink_from_features(&features, ARRIVAL_US, &sighting));
    check_not_understood();
    features.camera_id = 0u;
    features.image_height = 0u;
    TEST_ASSERT_FALSE(goe_mavlink_from_features(&features, ARRIVAL_US, &sighting));
    check_not_understood();
}

/* -------------------------------------------------------------------------------------------------- landing target -- */

static void angles_become_pixels_by_their_tangents(void) {
    double worst = 0.0;
    check_random_t any = check_random_start("landing target");
    target.target_num = 255u;
    for (int k = 0; k < 2000; k++) {
        target.angle_x = (float)check_random_between(&any, -1.0, 1.0);
        target.angle_y = (float)check_random_between(&any, -1.0, 1.0);
        target.size_x = (float)check_random_between(&any, 0.01, 0.7);
        target.size_y = (float)check_random_between(&any, 0.01, 0.7);
        TEST_ASSERT_TRUE(goe_mavlink_from_landing_target(&target, &camera, ARRIVAL_US, &sighting));
        const goe_box_t *box = &sighting.detection.box;
        const double half_x = 0.5 * (double)target.size_x;
        const double half_y = 0.5 * (double)target.size_y;
        check_worst(&worst, (double)box->left_px - (510.0 + 900.0 * tan((double)target.angle_x - half_x)));
        check_worst(&worst, (double)box->right_px - (510.0 + 900.0 * tan((double)target.angle_x + half_x)));
        check_worst(&worst, (double)box->top_px - (390.0 + 850.0 * tan((double)target.angle_y - half_y)));
        check_worst(&worst, (double)box->bottom_px - (390.0 + 850.0 * tan((double)target.angle_y + half_y)));
    }
    check_report("error of a side, px", worst);
    TEST_ASSERT_TRUE(worst < 0.05);
    TEST_ASSERT_EQUAL_UINT32(256u, sighting.detection.id);
    TEST_ASSERT_EQUAL_UINT8(1u, sighting.frame.number);
}

static void give_a_target(void) {
    target.angle_x = 0.1f;
    target.angle_y = -0.1f;
    target.size_x = target.size_y = 0.05f;
}

static void check_time(uint32_t capture_us, uint32_t sd_us) {
    TEST_ASSERT_TRUE(goe_mavlink_from_landing_target(&target, &camera, ARRIVAL_US, &sighting));
    TEST_ASSERT_EQUAL_UINT32(capture_us, sighting.frame.capture_us);
    TEST_ASSERT_EQUAL_UINT32(capture_us, sighting.frame.sent_us);
    TEST_ASSERT_EQUAL_UINT32(sd_us, sighting.frame.time_sd_us);
    TEST_ASSERT_EQUAL_UINT8(GOE_FLIGHT_AUTOPILOT_CLOCK, sighting.frame.time_base);
}

static void a_time_counts_only_by_a_shared_clock(void) {
    const uint64_t since_boot_us[] = {1900000u, 1u, 0x3E7FFFFFFFFu};
    const uint64_t others_us[] = {0u, 0x3E800000000u, 1700000000000000u};
    give_a_target();
    for (int i = 0; i < 3; i++) {
        camera.shares_clock = true;
        target.time_usec = since_boot_us[i];
        check_time((uint32_t)(since_boot_us[i] & 0xFFFFFFFFu), 0u);
        target.time_usec = others_us[i];
        check_time(ARRIVAL_US - 150000u, 20000u);
        camera.shares_clock = false;
        target.time_usec = since_boot_us[i];
        check_time(ARRIVAL_US - 150000u, 20000u);
    }
}

static void a_target_without_a_size_is_refused(void) {
    const float bad[] = {0.0f, -0.05f, 2.9f, check_from_bits(0x7FC00000u), check_from_bits(0x7F800000u)};
    for (int i = 0; i < 5; i++) {
        give_a_target();
        target.size_x = bad[i];
        TEST_ASSERT_FALSE(goe_mavlink_from_landing_target(&target, &camera, ARRIVAL_US, &sighting));
        check_not_understood();
    }
    give_a_target();
    target.angle_y = 1.45f;
    TEST_ASSERT_FALSE(goe_mavlink_from_landing_target(&target, &camera, ARRIVAL_US, &sighting));
    check_not_understood();
}

static void a_camera_that_is_none_is_refused(void) {
    float *const numbers[] = {&camera.width_px, &camera.height_px, &camera.fx_px, &camera.fy_px};
    give_a_target();
    for (int i = 0; i < 4; i++) {
        const float kept = *numbers[i];
        *numbers[i] = i % 2 != 0 ? 0.0f : check_from_bits(0x7FC00000u);
        TEST_ASSERT_FALSE(goe_mavlink_from_landing_target(&target, &camera, ARRIVAL_US, &sighting));
        check_not_understood();
        TEST_ASSERT_FALSE(goe_mavlink_from_tracking(&tracking, &camera, ARRIVAL_US, &sighting));
        check_not_understood();
        *numbers[i] = kept;
    }
    camera.number = GOE_CAMERAS_MAX;
    TEST_ASSERT_FALSE(goe_mavlink_from_landing_target(&target, &camera, ARRIVAL_US, &sighting));
    check_not_understood();
}

/* -------------------------------------------------------------------------------------------------------- tracking -- */

static void a_rectangle_is_a_share_of_the_image(void) {
    tracking.tracking_status = 1u;
    tracking.tracking_mode = 2u;
    tracking.rec_top_x = 0.25f;
    tracking.rec_top_y = 0.125f;
    tracking.rec_bottom_x = 0.5f;
    tracking.rec_bottom_y = 0.75f;
    TEST_ASSERT_TRUE(goe_mavlink_from_tracking(&tracking, &camera, ARRIVAL_US, &sighting));
    check_box(250.0, 100.0, 500.0, 600.0);
    TEST_ASSERT_EQUAL_UINT32(0u, sighting.detection.id);
    TEST_ASSERT_EQUAL_UINT32(ARRIVAL_US - 150000u, sighting.frame.capture_us);
    TEST_ASSERT_EQUAL_UINT32(20000u, sighting.frame.time_sd_us);
    tracking.rec_bottom_x = 0.25f; /* no size */
    TEST_ASSERT_FALSE(goe_mavlink_from_tracking(&tracking, &camera, ARRIVAL_US, &sighting));
    check_not_understood();
    tracking.rec_bottom_x = check_from_bits(0x7FC00000u); /* not known */
    TEST_ASSERT_FALSE(goe_mavlink_from_tracking(&tracking, &camera, ARRIVAL_US, &sighting));
    check_not_understood();
}

static void a_point_is_a_square(void) {
    tracking.tracking_status = 1u | 4u; /* moving target indicators are ignored */
    tracking.tracking_mode = 1u;
    tracking.point_x = 0.5f;
    tracking.point_y = 0.25f;
    tracking.radius = 0.02f;
    TEST_ASSERT_TRUE(goe_mavlink_from_tracking(&tracking, &camera, ARRIVAL_US, &sighting));
    check_box(480.0, 180.0, 520.0, 220.0);
    tracking.radius = 0.0f;
    TEST_ASSERT_FALSE(goe_mavlink_from_tracking(&tracking, &camera, ARRIVAL_US, &sighting));
    check_not_understood();
}

static void what_the_camera_does_not_see_is_nothing(void) {
    const uint8_t status[] = {0u, 1u, 1u | 8u};
    const uint8_t mode[] = {2u, 0u, 2u};
    tracking.rec_bottom_x = tracking.rec_bottom_y = 0.5f;
    for (int i = 0; i < 3; i++) {
        tracking.tracking_status = status[i];
        tracking.tracking_mode = mode[i];
        TEST_ASSERT_FALSE(goe_mavlink_from_tracking(&tracking, &camera, ARRIVAL_US, &sighting));
        check_empty(0u);
    }
    tracking.tracking_status = 1u | 2u; /* in an error: not alive */
    TEST_ASSERT_FALSE(goe_mavlink_from_tracking(&tracking, &camera, ARRIVAL_US, &sighting));
    check_not_understood();
    tracking.tracking_status = 1u;
    tracking.tracking_mode = 3u;
    TEST_ASSERT_FALSE(goe_mavlink_from_tracking(&tracking, &camera, ARRIVAL_US, &sighting));
    check_not_understood();
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(features_are_tenths_from_the_middle);
    RUN_TEST(points_keep_their_order);
    RUN_TEST(a_kind_is_read_in_centimeters);
    RUN_TEST(times_are_of_their_clock);
    RUN_TEST(a_score_that_is_not_known_is_whole);
    RUN_TEST(an_image_without_detections_shows_that_the_detector_is_alive);
    RUN_TEST(an_obstacle_that_shows_nothing_is_one_nevertheless);
    RUN_TEST(what_cannot_be_understood_has_no_camera);
    RUN_TEST(angles_become_pixels_by_their_tangents);
    RUN_TEST(a_time_counts_only_by_a_shared_clock);
    RUN_TEST(a_target_without_a_size_is_refused);
    RUN_TEST(a_camera_that_is_none_is_refused);
    RUN_TEST(a_rectangle_is_a_share_of_the_image);
    RUN_TEST(a_point_is_a_square);
    RUN_TEST(what_the_camera_does_not_see_is_nothing);
    return UNITY_END();
}
