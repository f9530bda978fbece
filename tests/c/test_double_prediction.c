/* Cylinders and heights come out as (2) and (8) say, approximations included. SPDX-License-Identifier: MIT
 *
 * Cylinder. A disc of radius r at (X, Z), d^2 = X^2 + Z^2, has tangents whose (2) is, in closed form,
 *     S = 4 r Z (1 - r^2/d^2)/(Z^2 - r^2)  instead of 4 r/Z,   x = X Z/(Z^2 - r^2) (1 - S^2/16)  instead of X/Z.
 * The fit (5) of these rows, in double, is what the library must give.
 *
 * Height. (8) takes the top point to be as far as the reference point, at Z: h_T = h - y_T Z with the true y_T of the
 * point that is highest in the image. */
/* tests: lib/window/goe_projection.c */
#include <math.h>
#include <string.h>

#include "check.h"
#include "reference.h"
#include "scene.h"

#define IMAGES 40
#define WINDOW 8

static double heights[WINDOW];
static int height_count;

void setUp(void) { height_count = 0; }
void tearDown(void) {}

static double mean_height_with(double value) {
    const int n = height_count + 1 < WINDOW ? height_count + 1 : WINDOW;
    double sum = 0.0;
    heights[height_count % WINDOW] = value;
    height_count++;
    for (int i = 0; i < n; i++) {
        sum += heights[i];
    }
    return sum / n;
}

static reference_row_t predicted_disc(const scene_t *scene, const scene_truth_t *truth) {
    const double x = truth->x_m;
    const double z = truth->z_m;
    const double r = 0.5 * scene->width_m;
    const double size = 4.0 * r * z * (1.0 - r * r / (x * x + z * z)) / (z * z - r * r);
    const double aside = x * z / (z * z - r * r) * (1.0 - size * size / 16.0);
    return (reference_row_t){truth->dx_m, truth->dz_m, 2.0 / size, 2.0 * aside / size, 0.0, 1.0};
}

typedef struct {
    double against_prediction, against_truth, height_against_prediction, height_against_truth;
    int solutions;
} worst_t;

static void fly_cylinder(const scene_t *scene, worst_t *worst) {
    static reference_row_t rows[IMAGES];
    goe_estimator_t estimator;
    goe_estimate_t e;
    goe_settings_t settings = scene_window_settings(scene);
    settings.model = GOE_MODEL_DISC;
    setUp();
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
    for (int k = 0; k < IMAGES; k++) {
        goe_image_t image;
        scene_truth_t truth;
        scene_image(scene, k, &image, &truth);
        const goe_status_t status = goe_update(&estimator, &image, &e);
        rows[k] = predicted_disc(scene, &truth);
        const reference_row_t of_tangents = reference_disc(truth.left_x, truth.right_x, truth.dx_m, truth.dz_m);
        CHECK_CLOSE(1.0e-9 * rows[k].size, rows[k].size, of_tangents.size); /* the closed form is the scene's */
        CHECK_CLOSE(1.0e-9 * rows[k].size, rows[k].aside, of_tangents.aside);
        if (k < WINDOW - 1) {
            continue;
        }
        CHECK_STATUS(GOE_OK, status);
        const reference_fit_t p = reference_solve(&rows[k - WINDOW + 1], WINDOW);
        const double height = mean_height_with(truth.height_above_ground_m - truth.top_y * (p.z0_m - truth.dz_m));
        check_worst(&worst->against_prediction, (double)e.z0_m / p.z0_m - 1.0);
        check_worst(&worst->against_prediction, ((double)e.x0_m - p.x0_m) / p.z0_m);
        check_worst(&worst->against_prediction, (double)e.width_m / p.width_m - 1.0);
        check_worst(&worst->against_truth, (double)e.z0_m / scene->z0_m - 1.0);
        check_worst(&worst->against_truth, (double)e.width_m / scene->width_m - 1.0);
        check_worst(&worst->height_against_prediction, ((double)e.height_m - height) / scene->height_m);
        check_worst(&worst->height_against_truth, ((double)e.height_m - scene->height_m) / scene->height_m);
        worst->solutions++;
    }
}

/* [(2)] */
static void cylinders_come_out_as_equation_2_says(void) {
    static const double asides_m[] = {0.0, -12.0, 30.0, -45.0};
    worst_t worst;
    memset(&worst, 0, sizeof worst);
    for (int path = 0; path < 4; path++) {
        for (int glide = 0; glide < 2; glide++) {
            for (int a = 0; a < 4; a++) {
                scene_t scene;
                scene_default(&scene);
                scene.shape = SCENE_CYLINDER;
                scene.width_m = 6.0;
                scene.height_m = 30.0;
                scene.x0_m = asides_m[a];
                scene.z0_m = 160.0;
                scene.path = path == 1 ? SCENE_ARC : path == 2 ? SCENE_WEAVE : SCENE_STRAIGHT;
                scene.arc_radius_m = asides_m[a] > 0.0 ? -400.0 : 400.0;
                scene.acceleration_mps2 = path == 3 ? 2.0 : 0.0;
                scene.glide_deg = glide ? 6.0 : 0.0;
                scene.altitude_m = 40.0;
                scene.wobble_deg = 3.0;
                fly_cylinder(&scene, &worst);
            }
        }
    }
    check_report("cylinders against prediction, worst relative difference of X0, Z0, W", worst.against_prediction);
    check_report("cylinders against truth, worst relative difference of Z0, W", worst.against_truth);
    check_report("heights against prediction, worst relative difference", worst.height_against_prediction);
    check_report("heights against truth, worst relative difference", worst.height_against_truth);
    TEST_ASSERT_EQUAL_INT(4 * 2 * 4 * (IMAGES - WINDOW + 1), worst.solutions);
    TEST_ASSERT_TRUE(worst.against_prediction < 1.0e-4);
    TEST_ASSERT_TRUE(worst.height_against_prediction < 1.0e-3);
    TEST_ASSERT_TRUE(worst.against_truth > 1.0e-3); /* the approximation is there to be predicted */
}

static void fly_box(const scene_t *scene, worst_t *worst) {
    goe_estimator_t estimator;
    goe_estimate_t e;
    goe_settings_t settings = scene_window_settings(scene);
    settings.model = GOE_MODEL_LINE;
    setUp();
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
    for (int k = 0; k < IMAGES; k++) {
        goe_image_t image;
        scene_truth_t truth;
        scene_image(scene, k, &image, &truth);
        const goe_status_t status = goe_update(&estimator, &image, &e);
        if (status == GOE_OK || status == GOE_PARTIAL) {
            const double height = mean_height_with(truth.height_above_ground_m - truth.top_y * truth.z_m);
            check_worst(&worst->height_against_prediction, ((double)e.height_m - height) / scene->height_m);
            check_worst(&worst->height_against_truth, ((double)e.height_m - scene->height_m) / scene->height_m);
            worst->solutions++;
        }
    }
}

/* [(8)] */
static void heights_of_boxes_come_out_as_equation_8_says(void) {
    static const double alphas_deg[] = {-30.0, 0.0, 20.0};
    worst_t worst;
    memset(&worst, 0, sizeof worst);
    for (int a = 0; a < 3; a++) {
        for (int tall = 0; tall < 2; tall++) {
            scene_t scene;
            scene_default(&scene);
            scene.width_m = tall ? 15.0 : 2.5;
            scene.length_m = tall ? 40.0 : 7.0;
            scene.height_m = tall ? 89.0 : 2.5;
            scene.x0_m = tall ? -60.0 : -15.0;
            scene.z0_m = tall ? 250.0 : 90.0;
            scene.altitude_m = tall ? 60.0 : 20.0;
            scene.alpha_deg = alphas_deg[a];
            scene.glide_deg = 6.0 * (a % 2);
            fly_box(&scene, &worst);
        }
    }
    check_report("box heights against prediction, worst relative difference", worst.height_against_prediction);
    check_report("box heights against truth, worst relative difference", worst.height_against_truth);
    TEST_ASSERT_GREATER_THAN_INT(150, worst.solutions);
    TEST_ASSERT_TRUE(worst.height_against_prediction < 1.0e-3);
    TEST_ASSERT_TRUE(worst.height_against_truth > 1.0e-2);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(cylinders_come_out_as_equation_2_says);
    RUN_TEST(heights_of_boxes_come_out_as_equation_8_says);
    return UNITY_END();
}
