/* Length (6), (7) and height (8). SPDX-License-Identifier: MIT */
/* tests: lib/window/goe_extent.c */
#include <math.h>

#include "check.h"
#include "window/goe_extent.h"

#define RAD_PER_DEG 0.017453292519943295
#define MIN_X 0.01f

static goe_extent_t extent;

void setUp(void) { extent = (goe_extent_t){-1.0f, -2.0f}; }
void tearDown(void) {}

static goe_point_t aligned(double x, double z) { return (goe_point_t){(float)(x / z), 0.0f, true}; }

static goe_estimate_t solved(float x_m, float z_m, float width_m) {
    goe_estimate_t estimate = {.x_m = x_m, .z_m = z_m, .width_m = width_m};
    estimate.sigma.x_m = 0.5f;
    estimate.sigma.z_m = 2.0f;
    estimate.sigma.width_m = 0.25f;
    return estimate;
}

/* The front edge, which ends at the near corner on both sides. */
static goe_span_t front_to(const goe_point_t *near, goe_turn_t turn) {
    goe_span_t front = {0.0f, 0.0f};
    TEST_ASSERT_TRUE(goe_projection_turn(near, turn, &front.left));
    front.right = front.left;
    return front;
}

/* A box with the middle of its front edge at (x, z), width w, length l, turned by b, without noise. */
static goe_status_t measure(double x, double z, double w, double l, double b_deg, bool side_is_right) {
    const double s = sin(b_deg * RAD_PER_DEG);
    const double c = cos(b_deg * RAD_PER_DEG);
    const double half = side_is_right ? 0.5 * w : -0.5 * w;
    const goe_point_t near = aligned(x + half * c, z - half * s);
    const goe_point_t far = aligned(x + half * c + l * s, z - half * s + l * c);
    const goe_edge_t side = {side_is_right ? &near : &far, side_is_right ? &far : &near, true, true, (float)b_deg};
    const goe_edge_t front = {NULL, NULL, true, true, 0.0f};
    const goe_faces_t faces = {true, &front, &side, side_is_right};
    const goe_turn_t turn = {(float)s, (float)c};
    const goe_span_t span = front_to(&near, turn);
    const goe_estimate_t reference = solved((float)x, (float)z, (float)w);
    return goe_extent_length(&faces, &span, turn, &reference, MIN_X, &extent);
}

/* [goe_estimate_t.length_m, (6), (7)] */
static void length_is_exact_on_both_sides(void) {
    for (int b = -25; b <= 25; b += 5) {
        CHECK_STATUS(GOE_OK, measure(-60.0, 80.0, 2.5, 7.0, b, true));
        TEST_ASSERT_FLOAT_WITHIN(1.0e-3f, 7.0f, extent.value_m);
        CHECK_STATUS(GOE_OK, measure(60.0, 80.0, 15.0, 40.0, b, false));
        TEST_ASSERT_FLOAT_WITHIN(5.0e-3f, 40.0f, extent.value_m);
    }
}

/* [A32] d L/d(X_side) = 1/x3 - 1/x2, and X_side = X c - Z s +- W/2. */
static void length_variance_is_that_of_the_solution(void) {
    const double b = 20.0;
    CHECK_STATUS(GOE_OK, measure(-30.0, 80.0, 2.5, 7.0, b, true));
    const double c = cos(b * RAD_PER_DEG);
    const double s = sin(b * RAD_PER_DEG);
    const double side = -30.0 * c - 80.0 * s + 1.25;
    const double gain = 7.0 / side;
    const double across = c * c * 0.25 + s * s * 4.0 + 0.25 * 0.0625;
    CHECK_CLOSE(1.0e-3 * gain * gain * across, gain * gain * across, extent.variance_m2);
}

/* [window.side_min_px] */
static void a_side_that_points_at_the_camera_has_no_length(void) {
    /* the side plane passes within MIN_X of the camera, or the camera is between its ends' bearings */
    CHECK_STATUS(GOE_EDGE_ON, measure(-1.25 - 0.79, 80.0, 2.5, 7.0, 0.0, true));
    TEST_ASSERT_EQUAL_FLOAT(-1.0f, extent.value_m);
    TEST_ASSERT_EQUAL_FLOAT(-2.0f, extent.variance_m2);
    CHECK_STATUS(GOE_OK, measure(-1.25 - 0.88, 80.0, 2.5, 7.0, 0.0, true));      /* the far end is at 0.0101 */
    CHECK_STATUS(GOE_EDGE_ON, measure(-1.25 - 0.86, 80.0, 2.5, 7.0, 0.0, true)); /* ... at 0.0099 */
}

/* [(6)] */
static void ends_on_both_sides_of_the_axis_have_no_length(void) {
    const goe_point_t near = {-0.1f, 0.0f, true};
    const goe_point_t far = {0.1f, 0.0f, true};
    const goe_edge_t side = {&near, &far, true, true, 0.0f};
    const goe_faces_t faces = {true, &side, &side, true};
    const goe_estimate_t reference = solved(-10.0f, 80.0f, 2.5f);
    const goe_turn_t turn = {0.0f, 1.0f};
    const goe_span_t span = front_to(&near, turn);
    CHECK_STATUS(GOE_EDGE_ON, goe_extent_length(&faces, &span, turn, &reference, MIN_X, &extent));
    TEST_ASSERT_EQUAL_FLOAT(-1.0f, extent.value_m);
}

/* [(6)] */
static void an_end_behind_the_turned_camera_has_no_length(void) {
    const goe_point_t near = {-1.0f, 0.0f, true};
    const goe_point_t far = {-2.0f, 0.0f, true};
    const goe_edge_t side = {&near, &far, true, true, 0.0f};
    const goe_faces_t faces = {true, &side, &side, true};
    const goe_estimate_t reference = solved(-10.0f, 80.0f, 2.5f);
    const goe_turn_t turn = {0.707106781f, 0.707106781f}; /* bearing -63 viewed from 45: 108 degrees aside */
    const goe_span_t span = {-1.0f, -1.0f};
    CHECK_STATUS(GOE_EDGE_ON, goe_extent_length(&faces, &span, turn, &reference, MIN_X, &extent));
}

/* [goe_estimate_t.height_m, goe_pose_t.height_m, (8)] */
static void height_is_below_or_above_the_camera(void) {
    const goe_estimate_t reference = solved(0.0f, 100.0f, 2.5f);
    const goe_point_t below = {0.0f, 0.175f, true};
    const goe_point_t above = {0.0f, -0.4f, true};
    CHECK_STATUS(GOE_OK, goe_extent_height(&below, 20.0f, &reference, &extent));
    TEST_ASSERT_FLOAT_WITHIN(1.0e-5f, 2.5f, extent.value_m);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-5f, 0.1225f, extent.variance_m2); /* (0.175 2)^2 */
    CHECK_STATUS(GOE_OK, goe_extent_height(&above, 20.0f, &reference, &extent));
    TEST_ASSERT_FLOAT_WITHIN(1.0e-5f, 60.0f, extent.value_m);
}

/* [goe_pose_t.height_m] */
static void height_needs_a_camera_above_ground(void) {
    const goe_estimate_t reference = solved(0.0f, 100.0f, 2.5f);
    const goe_point_t top = {0.0f, -0.1f, true};
    CHECK_STATUS(GOE_BAD_HEIGHT, goe_extent_height(&top, 0.0f, &reference, &extent));
    CHECK_STATUS(GOE_BAD_HEIGHT, goe_extent_height(&top, -0.0f, &reference, &extent));
    CHECK_STATUS(GOE_BAD_HEIGHT, goe_extent_height(&top, -20.0f, &reference, &extent));
    TEST_ASSERT_EQUAL_FLOAT(-1.0f, extent.value_m);
    CHECK_STATUS(GOE_OK, goe_extent_height(&top, 1.0e-3f, &reference, &extent));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(length_is_exact_on_both_sides);
    RUN_TEST(length_variance_is_that_of_the_solution);
    RUN_TEST(a_side_that_points_at_the_camera_has_no_length);
    RUN_TEST(ends_on_both_sides_of_the_axis_have_no_length);
    RUN_TEST(an_end_behind_the_turned_camera_has_no_length);
    RUN_TEST(height_is_below_or_above_the_camera);
    RUN_TEST(height_needs_a_camera_above_ground);
    return UNITY_END();
}
