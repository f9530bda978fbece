/* Images without a detection, before a track, give the position of the aircraft and nothing else.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "check.h"
#include "refined/goe_filter.h"
#include "scene.h"

#define IMAGES 188
#define SHARE                                                                                                          \
    2.0e-3 /* of a value or a sigma: rounding of positions that count from another origin, over the whole chain */

typedef enum { SHAPE_CYLINDER, SHAPE_BOX, SHAPE_OUTLINE, SHAPES } shape_t; /* outline: a box without base corners */

/* How the aircraft came to where the track begins. */
typedef struct {
    int images;
    double ahead_m_s, aside_m_s;
} arrival_t;

static const arrival_t arrivals[] = {
    {1, 10.0, 0.0}, {40, 10.0, 0.0}, {400, 10.0, 0.0}, {400, 0.0, 0.0}, {100, 3.0, 8.0}};
#define ARRIVALS (sizeof arrivals / sizeof arrivals[0])

static scene_t scene;
static goe_settings_t settings;
static goe_estimator_t plain, late; /* without and with images before */
static goe_estimate_t expected, estimate;
static unsigned phases;

void setUp(void) {
    scene_default(&scene);
    scene.width_m = 5.0;
    scene.length_m = 9.0;
    scene.height_m = 6.0;
    scene.alpha_deg = 44.0;
    scene.x0_m = -16.0;
    scene.speed_mps = 10.0;
    scene.image_rate_hz = 20.0;
    scene.wobble_deg = 1.0;
    scene.top_nearest = true;
    phases = 0;
}
void tearDown(void) {}

static void see(shape_t shape, int k, goe_image_t *image) {
    scene_image(&scene, k, image, NULL);
    if (shape == SHAPE_OUTLINE) {
        image->base_left.visible = image->base_near.visible = image->base_right.visible = false;
    }
}

static void see_nothing(shape_t shape, const arrival_t *arrival, int images_ahead, goe_image_t *image) {
    const double s = -(double)images_ahead / scene.image_rate_hz;
    see(shape, 0, image);
    scene_hide_points(image);
    image->pose.time_us += (int64_t)(s * 1.0e6);
    image->pose.position_ned_m[0] += (float)(s * arrival->ahead_m_s);
    image->pose.position_ned_m[1] += (float)(s * arrival->aside_m_s);
}

static void check_equal(double expected_value, double value) {
    CHECK_CLOSE(SHARE * (fabs(expected_value) + 1.0e-3), expected_value, value);
}

static void check_estimates(void) {
    const goe_sigma_t *e = &expected.sigma;
    const goe_sigma_t *s = &estimate.sigma;
    TEST_ASSERT_EQUAL_HEX(expected.valid, estimate.valid);
    TEST_ASSERT_EQUAL_INT(expected.model, estimate.model);
    TEST_ASSERT_EQUAL_INT(expected.suspect, estimate.suspect);
    check_equal((double)expected.width_m, (double)estimate.width_m);
    check_equal((double)expected.length_m, (double)estimate.length_m);
    check_equal((double)expected.height_m, (double)estimate.height_m);
    check_equal((double)expected.orientation_deg, (double)estimate.orientation_deg);
    check_equal((double)expected.x_m, (double)estimate.x_m);
    check_equal((double)expected.z_m, (double)estimate.z_m);
    check_equal((double)e->width_m, (double)s->width_m);
    check_equal((double)e->length_m, (double)s->length_m);
    check_equal((double)e->height_m, (double)s->height_m);
    check_equal((double)e->orientation_deg, (double)s->orientation_deg);
    check_equal((double)e->x_m, (double)s->x_m);
    check_equal((double)e->z_m, (double)s->z_m);
    check_equal((double)e->center_north_m, (double)s->center_north_m);
    check_equal((double)e->center_east_m, (double)s->center_east_m);
}

static void start(goe_estimator_t *estimator) {
    CHECK_STATUS(GOE_OK, goe_init(estimator, sizeof *estimator, &settings, NULL));
}

/* The flight twice, with and without what came before it. Returns how many images gave an answer. */
static int fly(shape_t shape, const arrival_t *arrival) {
    goe_image_t image;
    int answers = 0;
    start(&plain);
    start(&late);
    for (int k = arrival->images; k > 0; k--) {
        see_nothing(shape, arrival, k, &image);
        (void)goe_update(&late, &image, &estimate);
    }
    for (int k = 0; k < IMAGES; k++) {
        see(shape, k, &image);
        (void)goe_update(&plain, &image, &expected);
        (void)goe_update(&late, &image, &estimate);
        check_estimates();
        answers += expected.valid ? 1 : 0;
        phases |= 1u << late.filter.phase;
    }
    return answers;
}

static void fly_all(goe_method_t method, shape_t shape) {
    if (shape == SHAPE_CYLINDER) {
        scene_make_cylinder(&scene);
    }
    settings = method == GOE_METHOD_WINDOW ? scene_window_settings(&scene) : scene_settings(&scene);
    scene_clear_noise(&settings);
    settings.navigation.velocity_bias_sd_m_s =
        0.1f; /* what a flown path stretches by counts from the filter's start, too */
    settings.navigation.position_walk_sd_m = 0.01f;
    for (size_t i = 0; i < ARRIVALS; i++) {
        TEST_ASSERT_TRUE(fly(shape, &arrivals[i]) > IMAGES / 2);
    }
}

static bool was_in(goe_phase_t phase) { return (phases >> phase & 1u) != 0u; }

/* [A5, A34, navigation.velocity_bias_sd_m_s, (R21)] */
static void they_change_no_cylinder(void) {
    fly_all(GOE_METHOD_FILTER, SHAPE_CYLINDER);
    TEST_ASSERT_TRUE(was_in(GOE_PHASE_FOOTPRINT));
}

/* [A5] */
static void they_change_no_box(void) {
    fly_all(GOE_METHOD_FILTER, SHAPE_BOX);
    TEST_ASSERT_TRUE(was_in(GOE_PHASE_BOX));
}

/* [A5] */
static void they_change_no_outline(void) {
    fly_all(GOE_METHOD_FILTER, SHAPE_OUTLINE);
    TEST_ASSERT_TRUE(was_in(GOE_PHASE_FOOTPRINT));
}

/* [A5] */
static void they_change_nothing_in_the_window(void) {
    fly_all(GOE_METHOD_WINDOW, SHAPE_BOX);
    setUp();
    fly_all(GOE_METHOD_WINDOW, SHAPE_CYLINDER);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(they_change_no_cylinder);
    RUN_TEST(they_change_no_box);
    RUN_TEST(they_change_no_outline);
    RUN_TEST(they_change_nothing_in_the_window);
    return UNITY_END();
}
