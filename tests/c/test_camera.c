/* Mounting and lens. SPDX-License-Identifier: MIT */
/* tests: lib/image/goe_camera.c */
#include <string.h>

#include "check.h"
#include "image/goe_camera.h"
#include "scene.h"

static goe_camera_t camera;

void setUp(void) {
    memset(&camera, 0, sizeof camera);
    camera.fx_px = 900.0f;
    camera.fy_px = 920.0f;
    camera.cx_px = 640.0f;
    camera.cy_px = 480.0f;
}
void tearDown(void) {}

/* Columns of camera -> body: image x, image y and the optical axis, in body axes. */
static void check_axes(const float x_axis[3], const float y_axis[3], const float z_axis[3]) {
    float r[9];
    goe_camera_mounting(&camera, r);
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_FLOAT_WITHIN(5.0e-7f, x_axis[i], r[3 * i]);
        TEST_ASSERT_FLOAT_WITHIN(5.0e-7f, y_axis[i], r[3 * i + 1]);
        TEST_ASSERT_FLOAT_WITHIN(5.0e-7f, z_axis[i], r[3 * i + 2]);
    }
}

/* [camera.mount_yaw_deg] */
static void an_unmounted_camera_looks_ahead(void) {
    check_axes((const float[]){0.0f, 1.0f, 0.0f}, (const float[]){0.0f, 0.0f, 1.0f}, (const float[]){1.0f, 0.0f, 0.0f});
}

static void negative_yaw_looks_left(void) {
    camera.mount_yaw_deg = -30.0f;
    check_axes((const float[]){0.5f, 0.866025404f, 0.0f}, (const float[]){0.0f, 0.0f, 1.0f},
               (const float[]){0.866025404f, -0.5f, 0.0f});
}

/* [camera.mount_yaw_deg] */
static void negative_pitch_looks_down(void) {
    camera.mount_pitch_deg = -90.0f;
    check_axes((const float[]){0.0f, 1.0f, 0.0f}, (const float[]){-1.0f, 0.0f, 0.0f},
               (const float[]){0.0f, 0.0f, 1.0f});
}

/* [camera.mount_yaw_deg] */
static void positive_roll_turns_the_image_clockwise(void) {
    camera.mount_roll_deg = 90.0f;
    check_axes((const float[]){0.0f, 0.0f, 1.0f}, (const float[]){0.0f, -1.0f, 0.0f},
               (const float[]){1.0f, 0.0f, 0.0f});
}

/* Yaw is about body z, so the axis keeps its elevation; pitch is about the axis that yaw made. */
static void mounting_angles_apply_in_order(void) {
    camera.mount_yaw_deg = -90.0f;
    camera.mount_pitch_deg = -30.0f;
    check_axes((const float[]){1.0f, 0.0f, 0.0f}, (const float[]){0.0f, 0.5f, 0.866025404f},
               (const float[]){0.0f, -0.866025404f, 0.5f});
}

static bool ray_of(float u, float v, float *x, float *y) {
    const goe_pixel_t pixel = {u, v, true};
    *x = (pixel.u_px - camera.cx_px) / camera.fx_px;
    *y = (pixel.v_px - camera.cy_px) / camera.fy_px;
    return !goe_camera_distorts(&camera) || goe_camera_undistort(&camera, x, y);
}

/* [camera.fx_px, camera.fy_px] */
static void a_pinhole_camera_divides_by_its_focal_lengths(void) {
    float x;
    float y;
    TEST_ASSERT_TRUE(ray_of(640.0f + 90.0f, 480.0f - 230.0f, &x, &y));
    TEST_ASSERT_EQUAL_FLOAT(0.1f, x);
    TEST_ASSERT_EQUAL_FLOAT(-0.25f, y);
}

/* GIVEN a lens WHEN a ray is distorted in double and looked up again THEN it comes back. */
static void check_round_trip(float tolerance) {
    double worst = 0.0;
    for (int i = -8; i <= 8; i++) {
        for (int j = -8; j <= 8; j++) {
            const double x = 0.08 * i;
            const double y = 0.08 * j;
            double distorted_x;
            double distorted_y;
            float back_x;
            float back_y;
            scene_distort(&camera, x, y, &distorted_x, &distorted_y);
            TEST_ASSERT_TRUE(
                ray_of((float)(640.0 + 900.0 * distorted_x), (float)(480.0 + 920.0 * distorted_y), &back_x, &back_y));
            check_worst(&worst, (double)back_x - x);
            check_worst(&worst, (double)back_y - y);
        }
    }
    check_report("lens round trip, worst error of the ray", worst);
    TEST_ASSERT_TRUE(worst <= (double)tolerance);
}

/* GIVEN a lens of all five terms THEN a point goes where the definition puts it, and its derivatives are those of that place: by
 * them a side of a box touches, and weighs. */
static void the_lens_bends_as_its_derivatives_say(void) {
    check_random_t random = check_random_start("derivatives of the lens");
    const double step = 1.0e-5;
    camera.k1 = -0.12f;
    camera.k2 = 0.06f;
    camera.p1 = 0.008f;
    camera.p2 = -0.005f;
    camera.k3 = -0.03f;
    for (int i = 0; i < 500; i++) {
        const double x = check_random_between(&random, -0.8, 0.8);
        const double y = check_random_between(&random, -0.8, 0.8);
        const goe_distorted_t to = goe_camera_distort(&camera, (float)x, (float)y);
        double at[2];
        double right[2];
        double down[2];
        scene_distort(&camera, x, y, &at[0], &at[1]);
        scene_distort(&camera, x + step, y, &right[0], &right[1]);
        scene_distort(&camera, x, y + step, &down[0], &down[1]);
        CHECK_CLOSE(1.0e-6, at[0], to.x);
        CHECK_CLOSE(1.0e-6, at[1], to.y);
        CHECK_CLOSE(1.0e-4, (right[0] - at[0]) / step, to.xx);
        CHECK_CLOSE(1.0e-4, (right[1] - at[1]) / step, to.xy);
        CHECK_CLOSE(1.0e-4, (down[0] - at[0]) / step, to.xy);
        CHECK_CLOSE(1.0e-4, (down[1] - at[1]) / step, to.yy);
    }
}

static void a_barrel_lens_is_inverted(void) {
    camera.k1 = -0.12f;
    camera.k2 = 0.02f;
    camera.p1 = 0.0008f;
    camera.p2 = -0.0005f;
    camera.k3 = -0.001f;
    check_round_trip(1.0e-6f);
}

static void a_pincushion_lens_is_inverted(void) {
    camera.k1 = 0.1f;
    camera.p1 = -0.002f;
    camera.p2 = 0.001f;
    check_round_trip(1.0e-6f);
}

/* [A23, GOE_LENS_FAILED] */
static void a_pixel_outside_the_lens_is_refused(void) {
    float x;
    float y;
    camera.k1 = -0.5f; /* the image of r has its largest radius, 0.54, at r = 0.82 */
    TEST_ASSERT_TRUE(ray_of(640.0f + 900.0f * 0.40f, 480.0f, &x, &y));
    TEST_ASSERT_FALSE(ray_of(640.0f + 900.0f * 0.60f, 480.0f, &x, &y));
    TEST_ASSERT_FALSE(ray_of(640.0f + 900.0f * 5.0f, 480.0f, &x, &y));
    TEST_ASSERT_FALSE(ray_of(100000.0f, -100000.0f, &x, &y));
    camera.k1 = 0.0f;
    camera.k3 = -100.0f;
    TEST_ASSERT_FALSE(ray_of(640.0f + 900.0f, 480.0f, &x, &y));
}

/* [A23] GIVEN lenses good and bad THEN a ray that is given is one that the lens does put there, and it is finite. */
static void no_wrong_ray_is_given(void) {
    check_random_t random = check_random_start("lenses");
    double worst = 0.0;
    int given = 0;
    for (int i = 0; i < 20000; i++) {
        float *coefficients[] = {&camera.k1, &camera.k2, &camera.p1, &camera.p2, &camera.k3};
        const double spread = i % 2 == 0 ? 0.2 : 2.0;
        float x;
        float y;
        for (int k = 0; k < 5; k++) {
            const bool tangential = k == 2 || k == 3;
            *coefficients[k] = (float)check_random_between(&random, -spread, spread) * (tangential ? 0.02f : 1.0f);
        }
        const float u = (float)check_random_between(&random, 0.0, 1280.0);
        const float v = (float)check_random_between(&random, 0.0, 960.0);
        if (ray_of(u, v, &x, &y)) {
            double distorted_x;
            double distorted_y;
            scene_distort(&camera, (double)x, (double)y, &distorted_x, &distorted_y);
            check_worst(&worst, distorted_x - ((double)u - 640.0) / 900.0);
            check_worst(&worst, distorted_y - ((double)v - 480.0) / 920.0);
            given++;
        }
    }
    check_report("random lenses, worst distance of the ray's image", worst);
    TEST_ASSERT_GREATER_THAN_INT(10000, given);
    TEST_ASSERT_LESS_THAN_INT(20000, given);
    TEST_ASSERT_TRUE(worst <= 5.0e-4);
}

/* GIVEN a library for one camera WHEN an image names another THEN it is refused whole. */
static void another_camera_is_refused(void) {
#if GOE_CAMERAS_MAX == 1
    scene_t scene;
    goe_estimator_t estimator;
    goe_estimate_t estimate;
    goe_image_t image;
    scene_default(&scene);
    const goe_settings_t settings = scene_settings(&scene);
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
    scene_image(&scene, 0, &image, NULL);
    for (unsigned number = 1; number < 256u; number *= 3u) {
        image.camera = (uint8_t)number;
        CHECK_STATUS(GOE_OUT_OF_RANGE, goe_update(&estimator, &image, &estimate));
        TEST_ASSERT_TRUE(estimator.motion.time_us == GOE_TIME_UNKNOWN);
    }
#else
    TEST_IGNORE_MESSAGE("this library has more cameras than one");
#endif
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(an_unmounted_camera_looks_ahead);
    RUN_TEST(negative_yaw_looks_left);
    RUN_TEST(negative_pitch_looks_down);
    RUN_TEST(positive_roll_turns_the_image_clockwise);
    RUN_TEST(mounting_angles_apply_in_order);
    RUN_TEST(a_pinhole_camera_divides_by_its_focal_lengths);
    RUN_TEST(the_lens_bends_as_its_derivatives_say);
    RUN_TEST(a_barrel_lens_is_inverted);
    RUN_TEST(a_pincushion_lens_is_inverted);
    RUN_TEST(a_pixel_outside_the_lens_is_refused);
    RUN_TEST(no_wrong_ray_is_given);
    RUN_TEST(another_camera_is_refused);
    return UNITY_END();
}
