/* The closed-form window fit against the dense 2N x 3 system in double, and its sigmas. SPDX-License-Identifier: MIT */
/* tests: lib/window/goe_fit.c */
#include <math.h>
#include <string.h>

#include "check.h"
#include "reference.h"
#include "window/goe_fit.h"

#define LENGTH 8
#define DRAWS 4000
#define RAD_PER_DEG 0.017453292519943295

typedef struct {
    double x0, z0, width, b_deg;
    double step_x, step_z; /* meters per image */
} case_t;

void setUp(void) {}
void tearDown(void) {}

/* Rows of an obstacle with relative noise on m/S and m x/S, as the dense system and as the library wants them. */
static void make_rows(const case_t *given, double noise, check_random_t *random, reference_row_t rows[LENGTH],
                      goe_fit_ring_t *window) {
    const double s = sin(given->b_deg * RAD_PER_DEG);
    const double c = cos(given->b_deg * RAD_PER_DEG);
    memset(window, 0, sizeof *window);
    for (int k = 0; k < LENGTH; k++) {
        reference_row_t *r = &rows[k];
        r->dx_m = (double)(float)(given->step_x * k);
        r->dz_m = (double)(float)(given->step_z * k);
        const double xi = (double)(float)((given->x0 - r->dx_m) / given->width + noise * check_random_normal(random));
        const double zeta = (double)(float)((given->z0 - r->dz_m) / given->width + noise * check_random_normal(random));
        r->sine = s;
        r->cosine = c;
        r->size = s * xi + c * zeta;
        r->aside = c * xi - s * zeta;
        goe_fit_add(window, LENGTH, (float)r->dx_m, (float)r->dz_m, (goe_row_t){(float)xi, (float)zeta});
    }
}

/* [(5)] GIVEN random obstacles, motions, orientations and residuals THEN the fit is that of the dense system, and so are the
 * sigmas. Rounding of the rows to float, relative to what the parallax moves them, sets the limit. */
static void the_fit_is_that_of_the_dense_system(void) {
    check_random_t random = check_random_start("dense system");
    double worst = 0.0;
    double worst_sigma = 0.0;
    int solved = 0;
    for (int i = 0; i < 20000; i++) {
        const case_t given = {check_random_between(&random, -100.0, 100.0), check_random_between(&random, 50.0, 400.0),
                              check_random_between(&random, 1.0, 30.0),     check_random_between(&random, -90.0, 90.0),
                              check_random_between(&random, -2.0, 2.0),     check_random_between(&random, 0.5, 4.0)};
        reference_row_t rows[LENGTH];
        goe_fit_ring_t window;
        goe_estimate_t fit;
        const double baseline = sqrt(42.0 * (given.step_x * given.step_x + given.step_z * given.step_z));
        make_rows(&given, 0.02 * baseline / given.width, &random, rows, &window);
        const reference_fit_t expected = reference_solve(rows, LENGTH);
        if (goe_fit_solve(&window, LENGTH, 0.1f, &fit) == GOE_OK) {
            const double rounding = (given.z0 / given.width) / (baseline / expected.width_m);
            check_worst(&worst, ((double)fit.width_m / expected.width_m - 1.0) / rounding);
            check_worst(&worst, ((double)fit.x0_m - expected.x0_m) / expected.z0_m / rounding);
            check_worst(&worst, ((double)fit.z0_m / expected.z0_m - 1.0) / rounding);
            check_worst(&worst_sigma, (double)fit.sigma.width_m / expected.sigma_width_m - 1.0);
            check_worst(&worst_sigma, (double)fit.sigma.x0_m / expected.sigma_x0_m - 1.0);
            check_worst(&worst_sigma, (double)fit.sigma.z0_m / expected.sigma_z0_m - 1.0);
            check_worst(&worst_sigma, (double)fit.residual / expected.residual - 1.0);
            solved++;
        }
    }
    check_report("fit against the dense system, worst relative difference by rounding gain", worst);
    check_report("sigmas and residual, worst relative difference", worst_sigma);
    TEST_ASSERT_GREATER_THAN_INT(19000, solved);
    TEST_ASSERT_TRUE(worst < 1.0e-6);
    TEST_ASSERT_TRUE(worst_sigma < 1.0e-3);
}

/* [A32] GIVEN one geometry and white noise on the rows WHEN it is solved 4000 times THEN the estimates scatter as the sigmas
 * say: 4000 draws know a standard deviation to 1.1 %, so 5 % are four and a half of it. */
static void the_sigmas_are_the_scatter(void) {
    check_random_t random = check_random_start("scatter");
    const case_t given = {-20.0, 120.0, 4.0, 15.0, 0.3, 2.0};
    double sum[3] = {0.0, 0.0, 0.0};
    double sum2[3] = {0.0, 0.0, 0.0};
    double variance[3] = {0.0, 0.0, 0.0};
    for (int i = 0; i < DRAWS; i++) {
        reference_row_t rows[LENGTH];
        goe_fit_ring_t window;
        goe_estimate_t fit;
        make_rows(&given, 0.01, &random, rows, &window);
        CHECK_STATUS(GOE_OK, goe_fit_solve(&window, LENGTH, 0.1f, &fit));
        const double off[3] = {(double)fit.x0_m - given.x0, (double)fit.z0_m - given.z0,
                               (double)fit.width_m - given.width};
        const double sigma[3] = {(double)fit.sigma.x0_m, (double)fit.sigma.z0_m, (double)fit.sigma.width_m};
        for (int q = 0; q < 3; q++) {
            sum[q] += off[q];
            sum2[q] += off[q] * off[q];
            variance[q] += sigma[q] * sigma[q];
        }
    }
    for (int q = 0; q < 3; q++) {
        const double mean = sum[q] / DRAWS;
        const double scatter = sqrt(sum2[q] / DRAWS - mean * mean);
        const double reported = sqrt(variance[q] / DRAWS);
        check_report("scatter by reported sigma (X0, Z0, W)", scatter / reported);
        CHECK_CLOSE(0.05, 1.0, scatter / reported);
        CHECK_CLOSE(4.5 * scatter / sqrt((double)DRAWS), 0.0, mean); /* and without a bias */
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(the_fit_is_that_of_the_dense_system);
    RUN_TEST(the_sigmas_are_the_scatter);
    return UNITY_END();
}
