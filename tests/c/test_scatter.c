/* The factor that answers for a track's own scatter. SPDX-License-Identifier: MIT */
/* tests: lib/refined/goe_scatter.c */
#include <math.h>
#include <string.h>

#include "check.h"
#include "refined/goe_scatter.h"

#define IMAGES 400
#define TRACKS 50

static goe_filter_t filter;
static goe_matrix_t matrix;
static goe_rows_t rows;
static check_random_t any;

void setUp(void) {
    any = check_random_start("scatter");
    memset(&filter, 0, sizeof filter);
    goe_rows_clear(&rows, &matrix);
}
void tearDown(void) {}

/* An image of two sides and a corner, whose residuals keep this much of those before. */
static void take(double residual[4], double kept) {
    static const uint8_t series[4] = {2 * GOE_POINT_LEFT, 2 * GOE_POINT_RIGHT, 2 * GOE_POINT_BASE_NEAR,
                                      2 * GOE_POINT_BASE_NEAR + 1};
    rows.count = 4;
    for (int i = 0; i < 4; i++) {
        residual[i] = kept * residual[i] + sqrt(1.0 - kept * kept) * check_random_normal(&any);
        rows.series[i] = series[i];
        rows.weight[i] = 1.0f; /* the factor that whitened it */
        matrix.row[i][GOE_RESIDUAL] = (float)residual[i];
    }
    goe_scatter_take(&filter.scatter, &rows);
}

/* Mean factor at the end of tracks. */
static double mean_factor(double kept, float repeated) {
    double sum = 0.0;
    for (int track = 0; track < TRACKS; track++) {
        double residual[4] = {0.0};
        memset(&filter.scatter, 0, sizeof filter.scatter);
        for (int k = 0; k < IMAGES; k++) {
            take(residual, kept);
        }
        sum += (double)goe_scatter_factor(&filter, repeated);
    }
    return sum / TRACKS;
}

/* [(R32)] GIVEN residuals that are new in each image and as large as configured THEN nothing is widened by more than chance. */
static void nothing_is_widened_without_need(void) {
    const double factor = mean_factor(0.0, 1.0f);
    check_report("factor of white residuals", factor);
    TEST_ASSERT_TRUE(factor >= 1.0 && factor < 1.05);
    memset(&filter.scatter, 0, sizeof filter.scatter);
    CHECK_SAME(1.0f, goe_scatter_factor(&filter, 1.0f)); /* a new track */
}

/* [goe_estimate_t.sigma, (R32)]
 * GIVEN residuals that keep a share from image to image THEN the factor is that of the variance of a long mean of them. */
static void correlated_residuals_count_less(void) {
    static const double kept[] = {0.3, 0.5, 0.7};
    for (int i = 0; i < 3; i++) {
        const double expected = (1.0 + kept[i]) / (1.0 - kept[i]);
        const double factor = mean_factor(kept[i], 1.0f);
        check_report("factor over that of a first-order process", factor / expected);
        CHECK_CLOSE(0.15 * expected, expected, factor);
    }
}

/* [detector.point_correlation, (R32)] GIVEN a configured correlation THEN it is not counted twice. */
static void an_external_value_is_not_counted_twice(void) {
    const double factor = mean_factor(0.5, 3.0f);
    TEST_ASSERT_TRUE(factor >= 1.0 && factor < 1.15);
}

/* [goe_estimate_t.sigma, (R32)]
 * GIVEN images that scatter more than configured THEN the larger of the two means counts; GIVEN ones that scatter less THEN nothing
 * shrinks. */
static void doubt_widens_and_trust_does_not_shrink(void) {
    filter.health.mean_nis = 4.0f;
    CHECK_CLOSE(2.0e-3, 4.0, goe_scatter_factor(&filter, 1.0f));
    filter.health.mean_nis = 1.1f; /* of a tenth half is chance: 0.07^2 / 0.1 */
    CHECK_CLOSE(1.0e-4, 1.1 - 0.049, goe_scatter_factor(&filter, 1.0f));
    filter.health.mean_nis = 1.5f;
    filter.health.excess = 2.0f;
    CHECK_CLOSE(3.0e-3, 3.0, goe_scatter_factor(&filter, 1.0f));
    filter.health.mean_nis = 0.2f;
    filter.health.excess = -0.5f;
    CHECK_SAME(1.0f, goe_scatter_factor(&filter, 1.0f));
    filter.scatter.products = -50.0f; /* residuals that alternate */
    filter.scatter.squares = 60.0f;
    CHECK_SAME(1.0f, goe_scatter_factor(&filter, 1.0f));
    filter.health.mean_nis = 1.0f;
    filter.health.excess = 0.0f;
    filter.scatter.products = 30.0f; /* rho = 30/(10 + 30) less its chance value */
    filter.scatter.squares = 30.0f;
    const double rho = 0.75 - 0.0049 / 0.75;
    CHECK_CLOSE(1.0e-3, (1.0 + rho) / (1.0 - rho), goe_scatter_factor(&filter, 1.0f));
    filter.scatter.products = 1.0e6f; /* at most 0.9 */
    filter.scatter.squares = 1.0e6f;
    CHECK_CLOSE(1.0e-3, 19.0, goe_scatter_factor(&filter, 1.0f));
}

/* [(R32)] GIVEN a feature that is refused or not visible in an image THEN the next one is not correlated with an earlier one; GIVEN an
 * outlier THEN it counts as ten sigmas. */
static void gaps_join_nothing_and_outliers_are_clipped(void) {
    double residual[4] = {5.0, 5.0, 5.0, 5.0};
    take(residual, 1.0);
    rows.count = 1;
    rows.weight[0] = 0.0f; /* refused */
    goe_scatter_take(&filter.scatter, &rows);
    CHECK_SAME(0.0f, filter.scatter.products);
    take(residual, 1.0);
    CHECK_SAME(0.0f, filter.scatter.products);
    CHECK_SAME(0.0f, filter.scatter.squares);
    rows.count = 1;
    rows.weight[0] = 1.0f;
    matrix.row[0][GOE_RESIDUAL] = 1.0e30f;
    goe_scatter_take(&filter.scatter, &rows);
    CHECK_CLOSE(1.0e-4, 50.0, filter.scatter.products);
    CHECK_CLOSE(1.0e-3, 100.0, filter.scatter.squares);
    matrix.row[0][GOE_RESIDUAL] = check_from_bits(0x7FC00000u);
    goe_scatter_take(&filter.scatter, &rows);
    TEST_ASSERT_TRUE(check_is_finite(filter.scatter.products) && check_is_finite(filter.scatter.before[0]));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(nothing_is_widened_without_need);
    RUN_TEST(correlated_residuals_count_less);
    RUN_TEST(an_external_value_is_not_counted_twice);
    RUN_TEST(doubt_widens_and_trust_does_not_shrink);
    RUN_TEST(gaps_join_nothing_and_outliers_are_clipped);
    return UNITY_END();
}
