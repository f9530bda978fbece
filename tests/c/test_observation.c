/* Projection under an attitude bias, and noise of the points, against differences in double. SPDX-License-Identifier: MIT */
/* tests: lib/refined/goe_observation.c */
#include "refined/goe_observation.h"

#include <math.h>
#include <string.h>

#include "check.h"
#include "maths/goe_angle.h"
#include "sighting.h"

#define CASES 500

static check_random_t any;
static sighting_t sighting;

void setUp(void) {}
void tearDown(void) {}

static void any_point(double p[3]) {
    p[0] = check_random_between(&any, -0.5, 0.5);
    p[1] = check_random_between(&any, -0.3, 0.3);
    p[2] = check_random_between(&any, 0.2, 1.2);
}

/* Exact projection with a bias about the axes themselves. */
static void project(const double e[3], const double p[3], double seen[2]) {
    const double z = p[2] + e[0] * p[1] - e[1] * p[0];
    seen[0] = (p[0] + e[1] * p[2] - e[2] * p[1]) / z;
    seen[1] = (p[1] + e[2] * p[0] - e[0] * p[2]) / z;
}

/* [(R3)] GIVEN any point and bias THEN place and all twelve derivatives are those of the projection. */
static void derivatives_are_those_of_the_projection(void) {
    any = check_random_start("projection");
    for (int n = 0; n < CASES; n++) {
        goe_gradient_t gx;
        goe_gradient_t gy;
        double p[3];
        double seen[2];
        sighting_start(&sighting, &any);
        any_point(p);
        const double e[3] = {sighting.sight.ex, sighting.sight.ey, sighting.sight.ez};
        goe_observation_project_x(&sighting.sight, (float)p[0], (float)p[1], (float)p[2], &gx);
        goe_observation_project_y(&sighting.sight, (float)p[0], (float)p[1], (float)p[2], &gy);
        project(e, p, seen);
        CHECK_CLOSE(3.0e-6, seen[0], gx.at);
        CHECK_CLOSE(3.0e-6, seen[1], gy.at);
        const float by_x[6] = {gx.x, gx.y, gx.z, gx.ex, gx.ey, gx.ez};
        const float by_y[6] = {gy.x, gy.y, gy.z, gy.ex, gy.ey, gy.ez};
        for (int i = 0; i < 6; i++) {
            double up[6] = {p[0], p[1], p[2], e[0], e[1], e[2]};
            double down[6] = {p[0], p[1], p[2], e[0], e[1], e[2]};
            double above[2];
            double below[2];
            up[i] += 1.0e-6;
            down[i] -= 1.0e-6;
            project(&up[3], up, above);
            project(&down[3], down, below);
            CHECK_CLOSE(2.0e-4, (above[0] - below[0]) / 2.0e-6, by_x[i]);
            CHECK_CLOSE(2.0e-4, (above[1] - below[1]) / 2.0e-6, by_y[i]);
        }
    }
}

/* A bias of the body is turned into the axes. */
/* GIVEN a point that was measured under a small attitude bias THEN freed of it, it is where it would be without one, to first order
 * along both axes: first guesses of ranges are made of its y. */
static void a_point_is_freed_of_the_bias(void) {
    any = check_random_start("unbiased");
    for (int n = 0; n < CASES; n++) {
        double p[3];
        double seen[2];
        sighting_start(&sighting, &any);
        any_point(p);
        p[2] = fmax(p[2], 0.5);
        const double e[3] = {sighting.sight.ex, sighting.sight.ey, sighting.sight.ez};
        project(e, p, seen);
        goe_point_t *point = &sighting.sight.point[GOE_POINT_TOP];
        point->x = (float)seen[0];
        point->y = (float)seen[1];
        const goe_point_t freed = goe_observation_unbiased(&sighting.sight, GOE_POINT_TOP);
        const double bias2 = e[0] * e[0] + e[1] * e[1] + e[2] * e[2];
        CHECK_CLOSE(6.0 * bias2 + 1.0e-6, p[0] / p[2], freed.x);
        CHECK_CLOSE(6.0 * bias2 + 1.0e-6, p[1] / p[2], freed.y);
    }
}

/* [navigation.attitude_bias_sd_deg, (R3)] */
static void the_bias_is_turned_from_body_axes(void) {
    any = check_random_start("bias");
    for (int n = 0; n < CASES; n++) {
        sighting_start(&sighting, &any);
        const float reported[3] = {sighting.sight.ex, sighting.sight.ey, sighting.sight.ez};
        for (int i = 0; i < 3; i++) {
            double expected = 0.0;
            for (int j = 0; j < 3; j++) {
                expected += (double)sighting.sight.body_to_axes[3 * i + j] * (double)sighting.state[j];
            }
            CHECK_CLOSE(1.0e-7, expected, reported[i]);
        }
    }
}

/* [(R3)] GIVEN a point next to or behind the camera THEN everything stays finite. */
static void points_behind_the_camera_stay_finite(void) {
    static const float z[] = {1.0e-5f, 0.0f, -1.0e-5f, -1.0f, -1.0e6f};
    any = check_random_start("behind");
    sighting_start(&sighting, &any);
    for (int i = 0; i < 5; i++) {
        goe_gradient_t g[2];
        goe_observation_project_x(&sighting.sight, 0.3f, -0.2f, z[i], &g[0]);
        goe_observation_project_y(&sighting.sight, 0.3f, -0.2f, z[i], &g[1]);
        TEST_ASSERT_TRUE(check_is_finite(g[0].at) && check_is_finite(g[1].at));
        for (int j = 0; j < 2; j++) {
            TEST_ASSERT_TRUE(check_is_finite(g[j].x) && check_is_finite(g[j].y) && check_is_finite(g[j].z));
            TEST_ASSERT_TRUE(check_is_finite(g[j].ex) && check_is_finite(g[j].ey) && check_is_finite(g[j].ez));
        }
    }
}

/* Pixel to aligned point. */
static void align(const sighting_t *s, double u_px, double v_px, double aligned[2]) {
    const float *h = s->sight.camera_to_axes;
    const double ray[3] = {u_px / (double)s->settings.camera.fx_px, v_px / (double)s->settings.camera.fy_px, 1.0};
    double turned[3];
    for (int i = 0; i < 3; i++) {
        turned[i] = (double)h[3 * i] * ray[0] + (double)h[3 * i + 1] * ray[1] + (double)h[3 * i + 2] * ray[2];
    }
    aligned[0] = turned[0] / turned[2];
    aligned[1] = turned[1] / turned[2];
}

static void differentiate(const sighting_t *s, double u_px, double v_px, double by_u[2], double by_v[2]) {
    const double step = 1.0e-3;
    double up[2];
    double down[2];
    align(s, u_px + step, v_px, up);
    align(s, u_px - step, v_px, down);
    by_u[0] = (up[0] - down[0]) / (2.0 * step);
    by_u[1] = (up[1] - down[1]) / (2.0 * step);
    align(s, u_px, v_px + step, up);
    align(s, u_px, v_px - step, down);
    by_v[0] = (up[0] - down[0]) / (2.0 * step);
    by_v[1] = (up[1] - down[1]) / (2.0 * step);
}

/* [detector.point_noise_px, (R4)]
 * GIVEN a pixel anywhere in the image of a turned camera THEN the spread of its aligned point is the pixel's variance through
 * the derivative of the alignment. */
static void the_spread_is_that_of_the_alignment(void) {
    any = check_random_start("spread");
    for (int n = 0; n < CASES; n++) {
        double aligned[2];
        double by_u[2];
        double by_v[2];
        sighting_start(&sighting, &any);
        sighting.sight.point_px = (float)check_random_between(&any, 0.1, 3.0);
        const double u = check_random_between(&any, -600.0, 600.0);
        const double v = check_random_between(&any, -500.0, 500.0);
        align(&sighting, u, v, aligned);
        sighting.sight.point[GOE_POINT_TOP] = (goe_point_t){(float)aligned[0], (float)aligned[1], true};
        differentiate(&sighting, u, v, by_u, by_v);
        const double variance = (double)sighting.sight.point_px * (double)sighting.sight.point_px;
        const double xx = variance * (by_u[0] * by_u[0] + by_v[0] * by_v[0]);
        const double xy = variance * (by_u[0] * by_u[1] + by_v[0] * by_v[1]);
        const double yy = variance * (by_u[1] * by_u[1] + by_v[1] * by_v[1]);
        const goe_spread_t reported = goe_observation_spread(&sighting.sight, GOE_POINT_TOP);
        CHECK_CLOSE(1.0e-5 * xx, xx, reported.xx);
        CHECK_CLOSE(1.0e-5 * sqrt(xx * yy), xy, reported.xy);
        CHECK_CLOSE(1.0e-5 * yy, yy, reported.yy);
    }
}

/* [detector.point_noise_rel] */
static void size_noise_is_a_share_of_the_width(void) {
    any = check_random_start("size");
    sighting_start(&sighting, &any);
    sighting.sight.outline_share = 0.03f;
    sighting.sight.point[GOE_POINT_LEFT] = (goe_point_t){-0.1f, 0.0f, true};
    sighting.sight.point[GOE_POINT_RIGHT] = (goe_point_t){0.1f, 0.0f, true};
    CHECK_CLOSE(1.0e-10, 3.6e-5, goe_observation_size_variance(&sighting.sight));
    sighting.sight.point[GOE_POINT_RIGHT].usable = false; /* no width is visible */
    CHECK_SAME(0.0f, goe_observation_size_variance(&sighting.sight));
}

/* -------------------------------------------------------------------------------------------------- opening an image -- */

static goe_estimator_t estimator;
static goe_view_t view;
static goe_image_t image;
static const float identity[9] = {1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f};

static void start(void) {
    goe_settings_t settings;
    goe_settings_default(&settings);
    settings.camera.fx_px = 900.0f;
    settings.camera.cx_px = settings.camera.cy_px = 0.0f;
    settings.camera.width_px = settings.camera.height_px = 0.0f;
    settings.camera.fy_px = 900.0f;
    settings.camera.mount_yaw_deg = -30.0f;
    settings.camera.mount_pitch_deg = 10.0f;
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
    memset(&view, 0, sizeof view);
    memcpy(view.camera_to_trajectory, identity, sizeof identity);
    memset(&image, 0, sizeof image);
    view.image = &image;
    view.motion = &estimator.motion;
    view.camera = &settings.camera;
    view.camera_to_body = estimator.camera_to_body[0];
}

/* The camera's mounting taken back: a ray along the camera's axis is that of the body's mounting. */
static void the_body_is_where_the_mounting_puts_it(void) {
    goe_observation_t sight;
    start();
    TEST_ASSERT_EQUAL_UINT(0u, goe_observation_open(&sight, &estimator.settings, &estimator.filter, &view));
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) { /* identity = camera to axes: body to axes is the mounting's inverse */
            CHECK_CLOSE(1.0e-6, estimator.camera_to_body[0][3 * j + i], sight.body_to_axes[3 * i + j]);
        }
    }
}

#if GOE_AUGMENTED
/* [GOE_REASON_LATE]
 * GIVEN poses that are late WHEN an image is linearized THEN the attitude is that of the exposure: the turn of the body since then is
 * removed from the bias. */
static void pose_latency_is_corrected(void) {
    any = check_random_start("late");
    for (int n = 0; n < CASES; n++) {
        sighting_start(&sighting, &any);
        goe_observation_t *sight = &sighting.sight;
        goe_observation_linearise(sight);
        const float still[3] = {sight->ex, sight->ey, sight->ez};
        sight->latency_s = (float)check_random_between(&any, -0.3, 0.3);
        for (int i = 0; i < 3; i++) {
            sight->rate_rad_s[i] = (float)check_random_between(&any, -0.5, 0.5);
        }
        goe_observation_linearise(sight);
        const float turned[3] = {sight->ex, sight->ey, sight->ez};
        for (int i = 0; i < 3; i++) {
            CHECK_CLOSE(1.0e-7, (double)still[i] - (double)sight->latency_s * (double)sight->rate_rad_s[i], turned[i]);
        }
    }
}
#endif

static goe_point_t at(float x) { return (goe_point_t){x, 0.1f, true}; }

static void points_out_of_order_do_not_count(void) {
    goe_observation_t sight;
    start();
    view.point[GOE_POINT_LEFT] = at(0.1f);
    view.point[GOE_POINT_RIGHT] = at(0.2f);
    view.point[GOE_POINT_BASE_LEFT] = at(0.3f);
    view.point[GOE_POINT_BASE_RIGHT] = at(0.1f);
    TEST_ASSERT_EQUAL_UINT(1u, goe_observation_open(&sight, &estimator.settings, &estimator.filter, &view));
    TEST_ASSERT_TRUE(sight.point[GOE_POINT_LEFT].usable && sight.point[GOE_POINT_RIGHT].usable);
    TEST_ASSERT_FALSE(sight.point[GOE_POINT_BASE_LEFT].usable || sight.point[GOE_POINT_BASE_RIGHT].usable ||
                      sight.base);
    start();
    view.point[GOE_POINT_LEFT] = at(0.2f);
    view.point[GOE_POINT_RIGHT] = at(0.2f);
    view.point[GOE_POINT_BASE_LEFT] = at(0.1f);
    view.point[GOE_POINT_BASE_RIGHT] = at(0.3f);
    TEST_ASSERT_EQUAL_UINT(1u, goe_observation_open(&sight, &estimator.settings, &estimator.filter, &view));
    TEST_ASSERT_FALSE(sight.point[GOE_POINT_LEFT].usable || sight.point[GOE_POINT_RIGHT].usable);
    TEST_ASSERT_TRUE(sight.base && sight.edge);
}

static void an_edge_takes_two_base_corners(void) {
    goe_observation_t sight;
    start();
    view.point[GOE_POINT_BASE_LEFT] = at(0.1f);
    TEST_ASSERT_EQUAL_UINT(0u, goe_observation_open(&sight, &estimator.settings, &estimator.filter, &view));
    TEST_ASSERT_FALSE(sight.base || sight.edge);
    view.point[GOE_POINT_BASE_NEAR] = at(0.2f);
    TEST_ASSERT_EQUAL_UINT(0u, goe_observation_open(&sight, &estimator.settings, &estimator.filter, &view));
    TEST_ASSERT_FALSE(sight.base);
    TEST_ASSERT_TRUE(sight.edge);
}

/* GIVEN an image with its own errors THEN they replace the settings; 0 leaves these. */
static void an_image_may_know_its_own_errors(void) {
    goe_observation_t sight;
    start();
    TEST_ASSERT_EQUAL_UINT(0u, goe_observation_open(&sight, &estimator.settings, &estimator.filter, &view));
    CHECK_CLOSE(1.0e-9, (double)estimator.settings.navigation.attitude_white_sd_deg * (double)GOE_RAD_PER_DEG,
                sight.white_rad);
    TEST_ASSERT_EQUAL_FLOAT(estimator.settings.detector.point_noise_px, sight.point_px);
    TEST_ASSERT_EQUAL_FLOAT(estimator.settings.detector.box_noise_px, sight.side_px);
    image.noise.attitude_sd_deg = 2.0f;
    image.noise.pixel_sd_px = 7.0f;
    TEST_ASSERT_EQUAL_UINT(0u, goe_observation_open(&sight, &estimator.settings, &estimator.filter, &view));
    CHECK_CLOSE(1.0e-6, 2.0 * (double)GOE_RAD_PER_DEG, sight.white_rad);
    TEST_ASSERT_EQUAL_FLOAT(7.0f, sight.point_px);
    TEST_ASSERT_EQUAL_FLOAT(7.0f, sight.side_px);
}

/* GIVEN an error less than the least that its setting takes THEN it counts as that. */
static void less_than_the_least_counts_as_that(void) {
    goe_observation_t sight;
    start();
    image.noise.attitude_sd_deg = 1.0e-6f;
    image.noise.pixel_sd_px = 1.0e-6f;
    estimator.filter.datum.sd_m = 1.0e-6f;
    estimator.settings.navigation.terrain_height_sd_m = 0.0f;
    TEST_ASSERT_EQUAL_UINT(0u, goe_observation_open(&sight, &estimator.settings, &estimator.filter, &view));
    CHECK_CLOSE(1.0e-10, 1.0e-4 * (double)GOE_RAD_PER_DEG, sight.white_rad);
    TEST_ASSERT_EQUAL_FLOAT(0.05f, sight.point_px);
    TEST_ASSERT_EQUAL_FLOAT(0.05f, sight.side_px);
    TEST_ASSERT_EQUAL_FLOAT(1.0e-3f, sight.height_sd_m);
}

/* GIVEN what the readings of the altimeter say THEN the height is that of the first image moved by the changes of down, and its variance that
 * of the constant error, of the obstacle's own ground, of the readings' mean, and four times what they scatter beyond the configured
 * noise. */
static void the_height_is_as_uncertain_as_its_parts(void) {
    goe_observation_t sight;
    start();
    estimator.settings.navigation.height_bias_sd_m = 3.0f;
    estimator.settings.navigation.terrain_height_sd_m = 4.0f;
    estimator.settings.navigation.height_white_sd_m = 5.0f;
    estimator.motion.height_m = 20.0f;
    estimator.filter.datum.height_m = 24.0f;
    estimator.filter.datum.noise_m2 = 7.0f;
    estimator.filter.datum.scatter_m2 = 24.0f; /* less than configured */
    TEST_ASSERT_EQUAL_UINT(0u, goe_observation_open(&sight, &estimator.settings, &estimator.filter, &view));
    TEST_ASSERT_EQUAL_FLOAT(24.0f, sight.height_m);
    CHECK_CLOSE(1.0e-5, sqrt(9.0 + 16.0 + 7.0), sight.height_sd_m);
    estimator.filter.datum.scatter_m2 = 34.9f; /* as much as by chance: 1.4 of the configured 25 */
    TEST_ASSERT_EQUAL_UINT(0u, goe_observation_open(&sight, &estimator.settings, &estimator.filter, &view));
    CHECK_CLOSE(1.0e-5, sqrt(9.0 + 16.0 + 7.0), sight.height_sd_m);
    estimator.filter.datum.scatter_m2 = 45.0f;
    TEST_ASSERT_EQUAL_UINT(0u, goe_observation_open(&sight, &estimator.settings, &estimator.filter, &view));
    CHECK_CLOSE(1.0e-5, sqrt(9.0 + 16.0 + 7.0 + 4.0 * 10.0), sight.height_sd_m);
    estimator.filter.datum.sd_m = 6.0f; /* the first image knew its own height's error */
    TEST_ASSERT_EQUAL_UINT(0u, goe_observation_open(&sight, &estimator.settings, &estimator.filter, &view));
    CHECK_CLOSE(1.0e-5, sqrt(36.0 + 16.0 + 7.0 + 4.0 * 10.0), sight.height_sd_m);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(derivatives_are_those_of_the_projection);
    RUN_TEST(a_point_is_freed_of_the_bias);
    RUN_TEST(the_bias_is_turned_from_body_axes);
    RUN_TEST(points_behind_the_camera_stay_finite);
    RUN_TEST(the_spread_is_that_of_the_alignment);
    RUN_TEST(size_noise_is_a_share_of_the_width);
    RUN_TEST(the_body_is_where_the_mounting_puts_it);
#if GOE_AUGMENTED
    RUN_TEST(pose_latency_is_corrected);
#endif
    RUN_TEST(points_out_of_order_do_not_count);
    RUN_TEST(an_edge_takes_two_base_corners);
    RUN_TEST(an_image_may_know_its_own_errors);
    RUN_TEST(less_than_the_least_counts_as_that);
    RUN_TEST(the_height_is_as_uncertain_as_its_parts);
    return UNITY_END();
}
