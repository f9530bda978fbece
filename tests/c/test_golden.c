/* Committed reference data: what golden/ holds was made by `python -m bench golden`. SPDX-License-Identifier: MIT
 * A change of one bit anywhere on the committed flight shows here, with the image and the quantity. */
/* tests: lib/window/goe_window.c */
#include <math.h>
#include <string.h>

#include "check.h"
#include "golden/golden_angle.h"
#include "golden/golden_corner.h"
#include "golden/golden_lens.h"
#include "golden/golden_window.h"
#include "image/goe_camera.h"
#include "maths/goe_angle.h"
#include "window/goe_fit.h"

#define COUNT_OF(array) (sizeof(array) / sizeof((array)[0]))
#define ANGLE_BOUND 2.0e-7 /* goe_angle.h */
#define RAY_BOUND 1.0e-6   /* rounding of the pixel, 2^-24 x 1280 px by f = 400 px, and of the iteration */

void setUp(void) {}
void tearDown(void) {}

static void arctangents(void) {
    for (size_t i = 0; i < COUNT_OF(golden_arctan); i++) {
        CHECK_CLOSE(ANGLE_BOUND, golden_arctan[i].rad, goe_arctan_rad(golden_arctan[i].y, golden_arctan[i].x));
    }
}

static void sines_and_cosines(void) {
    for (size_t i = 0; i < COUNT_OF(golden_sincos); i++) {
        float s;
        float c;
        goe_sincos_deg(golden_sincos[i].deg, &s, &c);
        CHECK_CLOSE(ANGLE_BOUND, golden_sincos[i].sine, s);
        CHECK_CLOSE(ANGLE_BOUND, golden_sincos[i].cosine, c);
    }
}

/* [camera.k3] */
static void rays(void) {
    for (size_t i = 0; i < COUNT_OF(golden_lens); i++) {
        const golden_lens_t *g = &golden_lens[i];
        const goe_camera_t camera = {.fx_px = g->fx_px,
                                     .fy_px = g->fy_px,
                                     .cx_px = g->cx_px,
                                     .cy_px = g->cy_px,
                                     .k1 = g->k1,
                                     .k2 = g->k2,
                                     .p1 = g->p1,
                                     .p2 = g->p2,
                                     .k3 = g->k3};
        const goe_pixel_t pixel = {g->u_px, g->v_px, true};
        float x = (pixel.u_px - camera.cx_px) / camera.fx_px;
        float y = (pixel.v_px - camera.cy_px) / camera.fy_px;
        TEST_ASSERT_TRUE(!goe_camera_distorts(&camera) || goe_camera_undistort(&camera, &x, &y));
        CHECK_CLOSE(RAY_BOUND, g->x, x);
        CHECK_CLOSE(RAY_BOUND, g->y, y);
    }
}

/* [(5)] Rounding of a row is 2^-24 of Z0/W; the parallax moves it by baseline/W over the window. Sigmas hang on the residuals,
 * which rounding disturbs by 2^-24 of Z0/W as well. */
static void windows(void) {
    for (size_t i = 0; i < COUNT_OF(golden_window); i++) {
        const golden_window_t *g = &golden_window[i];
        goe_fit_ring_t window;
        goe_estimate_t fit;
        memset(&window, 0, sizeof window);
        for (int k = 0; k < g->length; k++) {
            goe_fit_add(&window, g->length, g->dx_m[k], g->dz_m[k], (goe_row_t){g->xi[k], g->zeta[k]});
        }
        CHECK_STATUS(GOE_OK, goe_fit_solve(&window, g->length, 0.1f, &fit));
        const double share = 5.0e-7 * g->z0_m / g->baseline_m;
        const double noise = 1.0e-3 + 5.0e-7 * (g->z0_m / g->width_m) / g->residual;
        CHECK_CLOSE(share * g->z0_m, g->x0_m, fit.x0_m);
        CHECK_CLOSE(share * g->z0_m, g->z0_m, fit.z0_m);
        CHECK_CLOSE(share * g->width_m, g->width_m, fit.width_m);
        CHECK_CLOSE(1.0e-6 * g->baseline_m, g->baseline_m, fit.baseline_m);
        CHECK_CLOSE(noise * g->residual, g->residual, fit.residual);
        CHECK_CLOSE(noise * g->sigma_x0_m, g->sigma_x0_m, fit.sigma.x0_m);
        CHECK_CLOSE(noise * g->sigma_z0_m, g->sigma_z0_m, fit.sigma.z0_m);
        CHECK_CLOSE(noise * g->sigma_width_m, g->sigma_width_m, fit.sigma.width_m);
    }
}

static void numbers_of(const goe_estimate_t *e, float numbers[GOLDEN_CORNER_NUMBERS]) {
    const goe_sigma_t *s = &e->sigma;
    const float all[GOLDEN_CORNER_NUMBERS] = {
        e->x0_m,
        s->x0_m,
        e->z0_m,
        s->z0_m,
        e->x_m,
        s->x_m,
        e->z_m,
        s->z_m,
        e->width_m,
        s->width_m,
        e->length_m,
        s->length_m,
        e->height_m,
        s->height_m,
        e->orientation_deg,
        s->orientation_deg,
        e->center_north_m,
        s->center_north_m,
        e->center_east_m,
        s->center_east_m,
        e->residual,
        e->baseline_m,
    };
    memcpy(numbers, all, sizeof all);
}

static void print_place(size_t image, const char *name) {
    UnityPrint("image ");
    UnityPrintNumberUnsigned((UNITY_UINT)image);
    UnityPrint(", ");
    UnityPrint(name);
    UNITY_PRINT_EOL();
}

/* [A3, A13, goe_estimate_t.residual, window.points, (1)]
 * GIVEN the committed flight WHEN it is replayed THEN every status and every bit of every number is as committed. */
static void a_whole_flight_bit_by_bit(void) {
    goe_settings_t settings;
    goe_estimator_t estimator;
    size_t different = 0;
    goe_settings_default(&settings);
    settings.method = GOE_METHOD_WINDOW;
    settings.camera = golden_corner_camera;
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
    for (size_t i = 0; i < COUNT_OF(golden_corner); i++) {
        const golden_corner_t *g = &golden_corner[i];
        goe_estimate_t estimate;
        float numbers[GOLDEN_CORNER_NUMBERS];
        CHECK_STATUS(g->status, goe_update(&estimator, &g->image, &estimate));
        TEST_ASSERT_EQUAL_INT(g->model, estimate.model);
        TEST_ASSERT_EQUAL_INT(g->points, estimate.images_used);
        TEST_ASSERT_EQUAL_INT(g->fresh, estimate.fresh);
        TEST_ASSERT_EQUAL_HEX32(g->valid, estimate.valid);
        numbers_of(&estimate, numbers);
        for (size_t q = 0; q < GOLDEN_CORNER_NUMBERS; q++) {
            if (check_bits(numbers[q]) != g->bits[q]) {
                print_place(i, golden_corner_names[q]);
                different++;
            }
        }
    }
    TEST_ASSERT_EQUAL_size_t(0u, different);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(arctangents);
    RUN_TEST(sines_and_cosines);
    RUN_TEST(rays);
    RUN_TEST(windows);
    RUN_TEST(a_whole_flight_bit_by_bit);
    return UNITY_END();
}
