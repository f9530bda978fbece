/* Reports in north and east: T's heading, both axes, the center and its uncertainty.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "check.h"
#include "inverse.h"
#include "refined/goe_quantities.h"
#include "scene.h"

#define IMAGES 60
#define RAD_PER_DEG 0.017453292519943295
#define ROUNDING 2.0e-3 /* of a sigma: the same flight in other numbers */

static scene_t scene;
static goe_settings_t settings;
static goe_estimator_t estimator;

void setUp(void) {
    scene_default(&scene);
    settings = scene_settings(&scene);
    scene.boxes = false;
}
void tearDown(void) {}

/* The estimate after a flight on a course; blind: whose first image saw nothing, on another course. */
static goe_estimate_t fly_after(double before_deg, bool blind, double course_deg) {
    goe_estimate_t estimate;
    goe_image_t image;
    scene.course_deg = before_deg;
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
    for (int k = 0; k < IMAGES; k++) {
        scene_image(&scene, k, &image, NULL);
        if (k == 0 && blind) {
            scene_hide_points(&image);
            image.box.sides = 0;
        }
        scene.course_deg = course_deg;
        (void)goe_update(&estimator, &image, &estimate);
    }
    return estimate;
}

static goe_estimate_t fly(double course_deg) { return fly_after(course_deg, false, course_deg); }

static goe_estimate_t fly_after_turn(double before_deg, double after_deg) {
    return fly_after(before_deg, true, after_deg);
}

/* Angle of b from a, folded into -180 to 180. */
static double between_deg(double a, double b) { return remainder(b - a, 360.0); }

/* [heading_auto] GIVEN a course WHEN an image was taken THEN T's heading is reported, also while nothing else is known. */
static void the_heading_is_reported_from_the_first_image_on(void) {
    for (double course = -170.0; course <= 180.0; course += 25.0) {
        goe_estimate_t estimate;
        goe_image_t image;
        scene.course_deg = course;
        CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
        scene_image(&scene, 0, &image, NULL);
        (void)goe_update(&estimator, &image, &estimate);
        TEST_ASSERT_EQUAL_HEX(0, estimate.valid);
        CHECK_CLOSE(1.0e-4, 0.0, between_deg(course, (double)estimate.trajectory_heading_deg));
        image.pose.time_us = GOE_TIME_UNKNOWN; /* refused */
        CHECK_STATUS(GOE_BAD_TIME, goe_update(&estimator, &image, &estimate));
        CHECK_CLOSE(1.0e-4, 0.0, between_deg(course, (double)estimate.trajectory_heading_deg));
    }
}

/* GIVEN a heading that is set, in any turn THEN it is reported between -180 and 180. */
static void a_set_heading_is_reported(void) {
    settings.heading_auto = false;
    for (double heading = -360.0; heading <= 360.0; heading += 45.0) {
        settings.heading_deg = (float)heading;
        const goe_estimate_t estimate = fly(10.0);
        CHECK_CLOSE(1.0e-4, 0.0, between_deg(heading, (double)estimate.trajectory_heading_deg));
        TEST_ASSERT_TRUE(estimate.trajectory_heading_deg >= -180.0f && estimate.trajectory_heading_deg <= 180.0f);
    }
}

static void check_axes(const goe_estimate_t *e) {
    const double azimuth = ((double)e->trajectory_heading_deg + (double)e->orientation_deg) * RAD_PER_DEG;
    TEST_ASSERT_TRUE(e->valid & GOE_HAS_ORIENTATION);
    CHECK_CLOSE(1.0e-5, cos(azimuth), e->length_axis_ne[0]);
    CHECK_CLOSE(1.0e-5, sin(azimuth), e->length_axis_ne[1]);
    CHECK_CLOSE(1.0e-5, -sin(azimuth), e->width_axis_ne[0]);
    CHECK_CLOSE(1.0e-5, cos(azimuth), e->width_axis_ne[1]);
}

/* [goe_estimate_t.length_axis_ne, goe_estimate_t.width_axis_ne]
 * GIVEN a box on any course, by either method THEN its axes in north and east are the heading and the orientation together. */
static void the_axes_point_north_and_east(void) {
    for (double course = -180.0; course < 180.0; course += 40.0) {
        const goe_estimate_t filter = fly(course);
        check_axes(&filter);
    }
#if GOE_WITH_WINDOW
    settings = scene_window_settings(&scene);
    for (double course = -180.0; course < 180.0; course += 40.0) {
        const goe_estimate_t window = fly(course);
        check_axes(&window);
    }
#endif
}

/* GIVEN a box by either method THEN the axes in T are unit vectors of the orientation, and the other side is square to it. */
static void the_axes_agree_with_the_orientation(void) {
    int reported = 0;
    for (int method = GOE_METHOD_WINDOW; method <= GOE_METHOD_FILTER; method++) {
#if !GOE_WITH_WINDOW
        if (method == GOE_METHOD_WINDOW) {
            continue;
        }
#endif
        for (int alpha = -80; alpha <= 80; alpha += 20) {
            scene_default(&scene);
            scene.alpha_deg = alpha;
            settings = scene_settings(&scene);
            settings.method = (goe_method_t)method;
            const goe_estimate_t e = fly(25.0);
            const double rad = (double)e.orientation_deg * RAD_PER_DEG;
            if (!(e.valid & GOE_HAS_ORIENTATION)) {
                continue;
            }
            reported++;
            CHECK_CLOSE(1.0e-5, sin(rad), e.length_axis[0]);
            CHECK_CLOSE(1.0e-5, cos(rad), e.length_axis[1]);
            CHECK_CLOSE(1.0e-5, cos(rad), e.width_axis[0]);
            CHECK_CLOSE(1.0e-5, -sin(rad), e.width_axis[1]);
            CHECK_CLOSE(1.0e-4, 90.0, fabs((double)e.front_orientation_deg - (double)e.orientation_deg));
            TEST_ASSERT_TRUE(e.front_orientation_deg > -90.0f && e.front_orientation_deg <= 90.0f);
        }
    }
    TEST_ASSERT_TRUE(reported >= (GOE_WITH_WINDOW ? 12 : 6));
}

#if GOE_WITH_WINDOW
/* GIVEN images of noise THEN the window's raw orientation is that of the latest image alone, and the filtered one scatters less. */
static void the_raw_orientation_is_that_of_the_latest_image(void) {
    check_random_t any = check_random_start("raw orientation");
    double raw = 0.0;
    double filtered = 0.0;
    settings = scene_window_settings(&scene);
    scene.alpha_deg = 20.0;
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
    for (int k = 0; k < 40; k++) {
        goe_estimate_t estimate;
        goe_image_t image;
        scene_image(&scene, k, &image, NULL);
        scene_add_noise(&image, &any, 1.0);
        (void)goe_update(&estimator, &image, &estimate);
        if (k >= 20) {
            raw += fabs((double)estimate.orientation_raw_deg - 20.0);
            filtered += fabs((double)estimate.orientation_deg - 20.0);
        }
    }
    check_report("mean error of the raw orientation, deg", raw / 20.0);
    check_report("... of the filtered one", filtered / 20.0);
    TEST_ASSERT_TRUE(raw > 1.5 * filtered);
}
#endif

/* Covariance of the center along and across the course, and of the two. */
typedef struct {
    double along, across, both;
} spread_t;

static spread_t spread_of(const goe_estimate_t *e, double course_deg) {
    const double c = cos(course_deg * RAD_PER_DEG);
    const double s = sin(course_deg * RAD_PER_DEG);
    const double nn = (double)e->sigma.center_north_m * (double)e->sigma.center_north_m;
    const double ee = (double)e->sigma.center_east_m * (double)e->sigma.center_east_m;
    const double ne = (double)e->center_ne_m2;
    const spread_t spread = {c * c * nn + 2.0 * c * s * ne + s * s * ee, s * s * nn - 2.0 * c * s * ne + c * c * ee,
                             c * s * (ee - nn) + (c * c - s * s) * ne};
    TEST_ASSERT_TRUE(e->valid & GOE_HAS_CENTER);
    TEST_ASSERT_TRUE(nn * ee - ne * ne > 0.0);
    return spread;
}

/* GIVEN one flight on two courses THEN the center is as uncertain along and across the course, with the same correlation. */
static void check_spread_turns(void) {
    const goe_estimate_t reference = fly(0.0);
    const spread_t expected = spread_of(&reference, 0.0);
    const double scale = sqrt(expected.along * expected.across);
    TEST_ASSERT_TRUE(expected.along != expected.across);
    for (double course = -150.0; course < 180.0; course += 50.0) {
        const goe_estimate_t turned = fly(course);
        const spread_t spread = spread_of(&turned, course);
        CHECK_CLOSE(ROUNDING * expected.along, expected.along, spread.along);
        CHECK_CLOSE(ROUNDING * expected.along, expected.across, spread.across);
        CHECK_CLOSE(ROUNDING * (expected.along + scale), expected.both, spread.both);
    }
}

/* [goe_estimate_t.center_ne_m2] */
static void the_spread_of_the_center_turns_with_the_course(void) {
    check_spread_turns();
    scene_make_cylinder(&scene);
    check_spread_turns();
    scene.boxes = true;
    check_spread_turns();
#if GOE_WITH_WINDOW
    scene.boxes = false;
    settings = scene_window_settings(&scene);
    check_spread_turns();
#endif
}

/* [A5, A7]
 * GIVEN a first image without a feature, before a turn THEN T is that of the first image with one, by points and by boxes; with a heading
 * that is set, T has that. */
static void a_track_that_began_before_a_turn_faces_forward(void) {
    for (int boxes = 0; boxes < 2; boxes++) {
        scene.boxes = boxes == 1;
        const goe_estimate_t turned = fly_after_turn(20.0, 150.0);
        TEST_ASSERT_TRUE(turned.valid & GOE_HAS_POSITION);
        CHECK_CLOSE(1.0e-3, 150.0, turned.trajectory_heading_deg);
        const goe_estimate_t bent = fly_after_turn(20.0, 60.0);
        TEST_ASSERT_TRUE(bent.valid & GOE_HAS_POSITION);
        CHECK_CLOSE(1.0e-3, 60.0, bent.trajectory_heading_deg);
    }
    settings.heading_auto = false;
    settings.heading_deg = 20.0f;
    const goe_estimate_t reported = fly_after_turn(20.0, 150.0);
    TEST_ASSERT_EQUAL_HEX(0, reported.valid);
    CHECK_CLOSE(1.0e-3, 20.0, reported.trajectory_heading_deg);
}

/* [goe_quantities.c]
 * GIVEN a place known in X and in Z to 800 km each, the two errors equal WHEN the course leads to the north-east THEN that makes
 * more than 1000 km along one of north and east, and no center is reported, whichever it is; the place is. */
static void a_center_that_is_nowhere_is_not_reported(void) {
    static const float errors_correlated[] = {1.0f, -1.0f};
    const float range_m = 4.0e5f;
    const float spread = 2.0f; /* of X and of Z, over the range */
    settings.filter.range_sd_rel_max = 10.0f;
    for (int i = 0; i < 3; i++) {
        goe_filter_t filter;
        goe_motion_t motion;
        goe_quantities_t quantities;
        goe_filter_clear(&filter);
        memset(&motion, 0, sizeof motion);
        motion.heading_cos = i < 2 ? sqrtf(0.5f) : 1.0f;
        motion.heading_sin = i < 2 ? sqrtf(0.5f) : 0.0f;
        filter.phase = GOE_PHASE_FOOTPRINT;
        filter.known = GOE_HAS_POSITION;
        filter.state[GOE_INVERSE_RANGE] = 1.0f / range_m;
        filter.state[GOE_HALF] = 1.0e-3f;
        inverse_start(&filter.root, 1.0e-9);
        inverse_set(&filter.root, GOE_BEARING, GOE_INVERSE_RANGE, (double)spread);
        inverse_set(&filter.root, GOE_INVERSE_RANGE, GOE_INVERSE_RANGE,
                    (double)((i < 2 ? errors_correlated[i] : 1.0f) * spread / range_m));
        goe_quantities_find(&filter, &settings, &motion, &quantities);
        CHECK_CLOSE(1.0e3, spread * range_m, quantities.sigma[GOE_X0]);
        CHECK_CLOSE(1.0e3, spread * range_m, quantities.sigma[GOE_Z0]);
        TEST_ASSERT_EQUAL_HEX32(i < 2 ? GOE_HAS_POSITION : GOE_HAS_POSITION | GOE_HAS_CENTER, quantities.known);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(the_heading_is_reported_from_the_first_image_on);
    RUN_TEST(a_set_heading_is_reported);
    RUN_TEST(the_axes_point_north_and_east);
    RUN_TEST(the_axes_agree_with_the_orientation);
#if GOE_WITH_WINDOW
    RUN_TEST(the_raw_orientation_is_that_of_the_latest_image);
#endif
    RUN_TEST(a_track_that_began_before_a_turn_faces_forward);
    RUN_TEST(the_spread_of_the_center_turns_with_the_course);
    RUN_TEST(a_center_that_is_nowhere_is_not_reported);
    return UNITY_END();
}
