/* Alignment of pixels into T. SPDX-License-Identifier: MIT */
/* tests: lib/image/goe_align.c */
#include <string.h>

#include "check.h"
#include "image/goe_align.h"
#include "maths/goe_rotation.h"

static goe_camera_t camera;
static goe_image_t image;
static goe_view_t view;
static goe_faults_t faults;
static uint32_t fault_counts[GOE_FAULT_COUNTS];

void setUp(void) {
    memset(&camera, 0, sizeof camera);
    memset(&image, 0, sizeof image);
    memset(&view, 0xA5, sizeof view);
    memset(fault_counts, 0, sizeof fault_counts);
    camera.fx_px = 1000.0f;
    camera.fy_px = 500.0f;
    camera.cx_px = 320.0f;
    camera.cy_px = 240.0f;
    faults.fault_counts = fault_counts;
    faults.first = GOE_OK;
}
void tearDown(void) {}

static const float unturned[9] = {1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f};

static void align(const float camera_to_trajectory[9]) {
    memcpy(view.camera_to_trajectory, camera_to_trajectory, sizeof view.camera_to_trajectory);
    view.image = &image;
    goe_align_points(&camera, &view, &faults);
}

static void see(goe_pixel_t *pixel, float u, float v) {
    pixel->u_px = u;
    pixel->v_px = v;
    pixel->visible = true;
}

static void check_point(float x, float y, const goe_point_t *point) {
    TEST_ASSERT_TRUE(point->usable);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-6f, x, point->x);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-6f, y, point->y);
}

static void every_feature_has_its_own_place(void) {
    see(&image.left, 320.0f + 100.0f, 240.0f + 50.0f);
    see(&image.right, 320.0f + 200.0f, 240.0f + 100.0f);
    see(&image.top, 320.0f + 300.0f, 240.0f + 150.0f);
    see(&image.base_left, 320.0f + 400.0f, 240.0f + 200.0f);
    see(&image.base_near, 320.0f + 500.0f, 240.0f + 250.0f);
    see(&image.base_right, 320.0f + 600.0f, 240.0f + 300.0f);
    align(unturned);
    check_point(0.1f, 0.1f, &view.point[GOE_POINT_LEFT]);
    check_point(0.2f, 0.2f, &view.point[GOE_POINT_RIGHT]);
    check_point(0.3f, 0.3f, &view.point[GOE_POINT_TOP]);
    check_point(0.4f, 0.4f, &view.point[GOE_POINT_BASE_LEFT]);
    check_point(0.5f, 0.5f, &view.point[GOE_POINT_BASE_NEAR]);
    check_point(0.6f, 0.6f, &view.point[GOE_POINT_BASE_RIGHT]);
    CHECK_STATUS(GOE_OK, faults.first);
}

static void invisible_features_are_not_usable(void) {
    see(&image.top, 320.0f, 240.0f);
    image.left.u_px = check_from_bits(0x7FC00000u); /* not read */
    align(unturned);
    TEST_ASSERT_FALSE(view.point[GOE_POINT_LEFT].usable || view.point[GOE_POINT_RIGHT].usable ||
                      view.point[GOE_POINT_BASE_LEFT].usable || view.point[GOE_POINT_BASE_NEAR].usable ||
                      view.point[GOE_POINT_BASE_RIGHT].usable);
    check_point(0.0f, 0.0f, &view.point[GOE_POINT_TOP]);
    CHECK_STATUS(GOE_OK, faults.first);
}

/* [A4, camera.cx_px, camera.cy_px]
 * GIVEN a camera turned by yaw 20, pitch -10, roll 5 WHEN it sees a point THEN the point's aligned coordinates are X/Z,
 * Y/Z in T, whatever the turn. */
static void own_rotation_is_taken_out(void) {
    const float point_in_t[3] = {-12.0f, 20.0f, 100.0f};
    float body_to_t[9];
    float t_to_camera[9];
    float camera_to_t[9];
    float seen[3];
    goe_rotation_from_euler(-20.0f, 10.0f, 5.0f, body_to_t); /* any rotation will do */
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            camera_to_t[3 * i + j] = body_to_t[3 * i + j];
            t_to_camera[3 * j + i] = body_to_t[3 * i + j];
        }
    }
    goe_rotation_apply(t_to_camera, point_in_t, seen);
    see(&image.top, 320.0f + 1000.0f * seen[0] / seen[2], 240.0f + 500.0f * seen[1] / seen[2]);
    align(camera_to_t);
    check_point(-0.12f, 0.2f, &view.point[GOE_POINT_TOP]);
}

/* [A6] The third component in T may be 0.05 of the norm: 87.13 degrees aside. */
static void a_ray_too_far_aside_is_behind_the_camera(void) {
    float to_the_right[9];
    goe_rotation_from_euler(0.0f, 90.0f, 0.0f, to_the_right); /* about image y: the optical axis becomes T's X */
    see(&image.left, 320.0f - 1000.0f * 0.0502f, 240.0f);
    see(&image.right, 320.0f - 1000.0f * 0.0498f, 240.0f);
    see(&image.top, 320.0f + 1000.0f * 0.5f, 240.0f); /* backwards */
    align(to_the_right);
    TEST_ASSERT_TRUE(view.point[GOE_POINT_LEFT].usable);
    TEST_ASSERT_FLOAT_WITHIN(0.01f, 1.0f / 0.0502f, view.point[GOE_POINT_LEFT].x);
    TEST_ASSERT_FALSE(view.point[GOE_POINT_RIGHT].usable);
    TEST_ASSERT_FALSE(view.point[GOE_POINT_TOP].usable);
    CHECK_STATUS(GOE_BEHIND_CAMERA, faults.first);
    TEST_ASSERT_EQUAL_UINT32(2u, fault_counts[-GOE_BEHIND_CAMERA]);
}

static void a_lens_that_cannot_be_inverted_loses_its_pixel_only(void) {
    camera.k1 = -0.5f;
    see(&image.left, 320.0f + 900.0f, 240.0f);
    see(&image.right, 320.0f + 100.0f, 240.0f);
    align(unturned);
    TEST_ASSERT_FALSE(view.point[GOE_POINT_LEFT].usable);
    TEST_ASSERT_TRUE(view.point[GOE_POINT_RIGHT].usable);
    CHECK_STATUS(GOE_LENS_FAILED, faults.first);
    TEST_ASSERT_EQUAL_UINT32(1u, fault_counts[-GOE_LENS_FAILED]);
}

/* [GOE_FAULT_COUNTS, goe_fault.c] */
static void counters_saturate(void) {
    fault_counts[-GOE_LENS_FAILED] = UINT32_MAX;
    camera.k1 = -0.5f;
    see(&image.left, 320.0f + 900.0f, 240.0f);
    align(unturned);
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, fault_counts[-GOE_LENS_FAILED]);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(every_feature_has_its_own_place);
    RUN_TEST(invisible_features_are_not_usable);
    RUN_TEST(own_rotation_is_taken_out);
    RUN_TEST(a_ray_too_far_aside_is_behind_the_camera);
    RUN_TEST(a_lens_that_cannot_be_inverted_loses_its_pixel_only);
    RUN_TEST(counters_saturate);
    return UNITY_END();
}
