/* Memory of a side's error against generalized least squares over all images at once, in double. SPDX-License-Identifier: MIT */
/* tests: lib/refined/goe_side_memory.c */
#include "refined/goe_side_memory.h"

#include <math.h>
#include <string.h>

#include "check.h"
#include "refined/goe_footprint.h"

#define IMAGES 16
#define CASES 200
#define SHARE 1.0e-3 /* rounding, of one sigma */

static check_random_t any;

typedef struct {
    double time_s[IMAGES], slope[IMAGES], residual[IMAGES]; /* residual = slope x + error + white noise */
    double white[IMAGES];                                   /* variances */
    double variance, tau_s;                                 /* of the error */
    double prior;                                           /* variance of x about 0 */
} series_t;

void setUp(void) {}
void tearDown(void) {}

/* ---------------------------------------------------------------------------------------------------------- reference -- */

/* Solves S y = b in place by Gauss elimination; S is positive definite. */
static void solve(double s[IMAGES][IMAGES], double b[IMAGES]) {
    for (int c = 0; c < IMAGES; c++) {
        for (int i = c + 1; i < IMAGES; i++) {
            const double f = s[i][c] / s[c][c];
            for (int j = c; j < IMAGES; j++) {
                s[i][j] -= f * s[c][j];
            }
            b[i] -= f * b[c];
        }
    }
    for (int i = IMAGES - 1; i >= 0; i--) {
        for (int j = i + 1; j < IMAGES; j++) {
            b[i] -= s[i][j] * b[j];
        }
        b[i] /= s[i][i];
    }
}

static void covariance_of(const series_t *of, double s[IMAGES][IMAGES]) {
    for (int i = 0; i < IMAGES; i++) {
        for (int j = 0; j < IMAGES; j++) {
            const double apart_s = fabs(of->time_s[i] - of->time_s[j]);
            s[i][j] = of->variance * exp(-apart_s / of->tau_s) + (i == j ? of->white[i] : 0.0);
        }
    }
}

static void expect(const series_t *of, double *x, double *variance) {
    double s[IMAGES][IMAGES];
    double by_slope[IMAGES];
    double by_residual[IMAGES];
    double information = 1.0 / of->prior;
    double right = 0.0;
    memcpy(by_slope, of->slope, sizeof by_slope);
    memcpy(by_residual, of->residual, sizeof by_residual);
    covariance_of(of, s);
    solve(s, by_slope);
    covariance_of(of, s);
    solve(s, by_residual);
    for (int i = 0; i < IMAGES; i++) {
        information += of->slope[i] * by_slope[i];
        right += of->slope[i] * by_residual[i];
    }
    *variance = 1.0 / information;
    *x = right / information;
}

/* ------------------------------------------------------------------------------------------------------- the recursion -- */

/* x is the filter's bearing; each image is used once, as the filter does: fade, recall, update, learn, follow. */
static void filter(const series_t *of, double *x, double *variance) {
    goe_side_memory_t side;
    double state = 0.0;
    double information = 1.0 / of->prior;
    memset(&side, 0, sizeof side);
    for (int k = 0; k < IMAGES; k++) {
        float row[GOE_COLUMNS] = {0.0f};
        float own = (float)of->white[k];
        float change[GOE_UNKNOWNS] = {0.0f};
        const double since_s = k > 0 ? of->time_s[k] - of->time_s[k - 1] : 0.0;
        goe_side_memory_fade(&side, (float)exp(-since_s / of->tau_s), (float)of->variance);
        row[GOE_STATE_COLUMN + GOE_BEARING] = (float)of->slope[k];
        row[GOE_RESIDUAL] = (float)(of->residual[k] - of->slope[k] * state);
        goe_side_memory_recall(&side, row, &own);
        const float weight = 1.0f / sqrtf(own);
        for (int c = 0; c < (int)GOE_COLUMNS; c++) {
            row[c] *= weight;
        }
        const double by = (double)row[GOE_STATE_COLUMN + GOE_BEARING];
        information += by * by;
        change[GOE_BEARING] = (float)(by * (double)row[GOE_RESIDUAL] / information);
        goe_side_memory_learn(&side, row, weight, 0.0f, row, 0.0f);
        state += (double)change[GOE_BEARING];
        goe_side_memory_follow(&side, change);
    }
    *x = state;
    *variance = 1.0 / information;
}

/* -------------------------------------------------------------------------------------------------------------- tests -- */

static series_t any_series(void) {
    series_t s;
    s.variance = pow(10.0, check_random_between(&any, -4.0, 0.0));
    s.tau_s = check_random_between(&any, 0.2, 3.0);
    s.prior = pow(10.0, check_random_between(&any, -1.0, 2.0));
    double time_s = 0.0;
    for (int k = 0; k < IMAGES; k++) {
        time_s += check_random_between(&any, 0.02, 0.5);
        s.time_s[k] = time_s;
        s.slope[k] = check_random_between(&any, -2.0, 2.0);
        s.white[k] = s.variance * pow(10.0, check_random_between(&any, -2.0, 1.0));
        s.residual[k] = check_random_normal(&any) * sqrt(s.variance);
    }
    return s;
}

/* [detector.box_noise_rel, (R28), (R29), (R30)]
 * GIVEN a side whose error is a first-order process WHEN its images come one by one THEN value and variance are those of all
 * images at once, with the error's whole covariance. */
static void it_is_as_good_as_all_images_at_once(void) {
    any = check_random_start("series");
    for (int n = 0; n < CASES; n++) {
        double expected;
        double expected_variance;
        double x;
        double variance;
        const series_t s = any_series();
        expect(&s, &expected, &expected_variance);
        filter(&s, &x, &variance);
        CHECK_CLOSE(SHARE, 0.0, (x - expected) / sqrt(expected_variance));
        CHECK_CLOSE(SHARE, 1.0, variance / expected_variance);
    }
}

/* ----------------------------------------------------------------------------------------------------- common error -- */

#define LONG 60
#define FLIGHTS 600

/* One flight: two opposite sides with errors of their own, slow and white, and an error that is common to both and new in each image. The
 * slow errors have a sigma of 1 and a time constant of 12 images. Only the difference of the sides shows x, as the growth of a box shows a
 * range. Returns the squared error of x, in sigmas. */
static double fly_with_common_error(double common, double white) {
    static goe_filter_t filter;
    goe_rows_t rows;
    goe_matrix_t matrix;
    const double fade = exp(-1.0 / 12.0);
    double slow[2] = {check_random_normal(&any), check_random_normal(&any)};
    double state = 0.0;
    double information = 0.01; /* the prior: 0 +- 10 */
    const double x = 10.0 * check_random_normal(&any);
    memset(&filter, 0, sizeof filter);
    memset(&rows, 0, sizeof rows);
    rows.matrix = &matrix;
    rows.count = rows.remembered = 2;
    rows.white_rad = (float)common;
    rows.side[1] = GOE_BOX_RIGHT;
    for (int k = 0; k < LONG; k++) {
        const double shared = common * check_random_normal(&any);
        const double slope = 0.05 + 0.05 * k / LONG;
        double by[2], residual[2], size2 = 1.0 / (common * common), by_common = 0.0, residual_common = 0.0;
        float change[GOE_UNKNOWNS] = {0.0f};
        double added = 0.0, right = 0.0;
        memset(&matrix, 0, sizeof matrix);
        for (int i = 0; i < 2; i++) {
            float *row = matrix.row[i];
            float own = (float)(white * white);
            goe_side_memory_t *side = &filter.side[rows.side[i]];
            const double sign = i == 0 ? -slope : slope;
            slow[i] = fade * slow[i] + sqrt(1.0 - fade * fade) * check_random_normal(&any);
            const double measured = sign * x + slow[i] + white * check_random_normal(&any) + shared;
            row[0] = 1.0f;
            row[GOE_STATE_COLUMN + GOE_BEARING] = (float)sign;
            row[GOE_RESIDUAL] = (float)(measured - sign * state);
            goe_side_memory_fade(side, (float)fade, 1.0f);
            goe_side_memory_recall(side, row, &own);
            rows.weight[i] = 1.0f / sqrtf(own);
            for (int c = 0; c < (int)GOE_COLUMNS; c++) {
                row[c] *= rows.weight[i];
            }
            by[i] = (double)row[GOE_STATE_COLUMN + GOE_BEARING];
            residual[i] = (double)row[GOE_RESIDUAL];
            size2 += (double)row[0] * (double)row[0];
            by_common += (double)row[0] * by[i];
            residual_common += (double)row[0] * residual[i];
            added += by[i] * by[i];
            right += by[i] * residual[i];
        }
        information += added - by_common * by_common / size2;
        change[GOE_BEARING] = (float)((right - by_common * residual_common / size2) / information);
        goe_footprint_learn(&filter, &rows);
        state += (double)change[GOE_BEARING];
        goe_footprint_follow(&filter, change);
    }
    return (state - x) * (state - x) * information;
}

/* [navigation.attitude_white_sd_deg, (R30)]
 * GIVEN an error that both sides share, small or large against their own, THEN the variance of x is true: it is no error of a side. */
static void a_common_error_is_none_of_a_side(void) {
    static const double commons[] = {0.05, 0.3, 1.0, 3.0};
    for (size_t i = 0; i < sizeof commons / sizeof commons[0]; i++) {
        double sum = 0.0;
        any = check_random_start("common");
        for (int n = 0; n < FLIGHTS; n++) {
            sum += fly_with_common_error(commons[i], 0.2);
        }
        check_report("mean squared error in sigmas", sum / FLIGHTS);
        TEST_ASSERT_TRUE(sum / FLIGHTS > 0.65 && sum / FLIGHTS < 1.25);
    }
}

/* [(R30)] GIVEN a row that was refused THEN nothing is learned from it. */
static void a_refused_row_teaches_nothing(void) {
    goe_side_memory_t side;
    goe_side_memory_t before;
    float row[GOE_COLUMNS];
    memset(&side, 0, sizeof side);
    for (size_t c = 0; c < GOE_COLUMNS; c++) {
        row[c] = 0.0f;
    }
    goe_side_memory_fade(&side, 1.0f, 0.01f);
    before = side;
    goe_side_memory_learn(&side, row, 0.0f, 0.0f, row, 0.0f);
    TEST_ASSERT_EQUAL_MEMORY(&before, &side, sizeof side);
}

/* [(R28)] GIVEN a side that comes into view late, of a box that has grown THEN its error is as large as that box makes it. */
static void a_side_measured_late_starts_afresh(void) {
    goe_side_memory_t side;
    float row[GOE_COLUMNS] = {0.0f};
    float variance = 0.0f;
    memset(&side, 0, sizeof side);
    for (int k = 1; k <= 10; k++) {
        goe_side_memory_fade(&side, 0.95f, 0.01f * (float)k);
    }
    goe_side_memory_recall(&side, row, &variance);
    TEST_ASSERT_EQUAL_FLOAT(0.1f, variance);
    row[GOE_RESIDUAL] = 1.0f;
    goe_side_memory_learn(&side, row, 3.0f, 0.0f, row, 0.0f);
    TEST_ASSERT_TRUE(side.variance > 0.0f && side.variance < 0.1f);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(a_side_measured_late_starts_afresh);
    RUN_TEST(it_is_as_good_as_all_images_at_once);
    RUN_TEST(a_common_error_is_none_of_a_side);
    RUN_TEST(a_refused_row_teaches_nothing);
    return UNITY_END();
}
