/* Outlier gate and Huber weights. SPDX-License-Identifier: MIT */
/* tests: lib/refined/goe_gate.c */
#include "refined/goe_gate.h"

#include <math.h>
#include <string.h>

#include "check.h"
#include "inverse.h"
#include "maths/goe_angle.h"

#define FOCAL_PX 914.0
#define PIXEL_PX 0.5
#define SIGMA (PIXEL_PX / FOCAL_PX)
#define RAD_PER_DEG 0.017453292519943295
#define ALL 0x3Fu

static goe_settings_t settings;
static goe_filter_t filter;
static goe_matrix_t matrix;
static goe_rows_t rows;
static goe_observation_t sight; /* at rest */
static goe_verdict_t verdict;

/* A box viewed from some way off: six points, base corners as two rows each. The filter is sure of its state. */
static const double points[GOE_FEATURES][2] = {{-0.12, 0.02}, {0.03, 0.02},  {-0.04, -0.05},
                                               {-0.12, 0.15}, {-0.04, 0.17}, {0.03, 0.16}};

static void add_row(size_t feature, bool along_y) {
    const double x = points[feature][0];
    const double y = points[feature][1];
    goe_gradient_t g;
    memset(&g, 0, sizeof g);
    g.ey = (float)(along_y ? x * y : 1.0 + x * x);
    g.ex = (float)(along_y ? -(1.0 + y * y) : -x * y);
    g.ez = (float)(along_y ? x : -y);
    (void)goe_rows_add(&rows, &sight, (goe_feature_t)feature, along_y ? GOE_ALONG_Y : GOE_ALONG_X, 0.0f,
                       (float)(SIGMA * SIGMA), &g);
}

void setUp(void) {
    goe_settings_default(&settings);
    memset(&filter, 0, sizeof filter);
    inverse_start(&filter.root, 1.0e-6);
    goe_rows_clear(&rows, &matrix);
    rows.white_rad = settings.navigation.attitude_white_sd_deg * GOE_RAD_PER_DEG;
    for (size_t i = 0; i < GOE_FEATURES; i++) {
        if (i != GOE_POINT_TOP) {
            add_row(i, false);
        }
        if (i != GOE_POINT_LEFT && i != GOE_POINT_RIGHT) {
            add_row(i, true);
        }
    }
    memset(matrix.row[rows.count], 0, (GOE_ROWS_MAX - rows.count) * sizeof matrix.row[0]);
}
void tearDown(void) {}

static float *residual(size_t row) { return &matrix.row[row][GOE_RESIDUAL]; }

static bool is_along_y(size_t row) { return fabsf(matrix.row[row][1]) > 0.5f; }

/* The whole image turned by an attitude error. */
static void turn(double ex, double ey, double ez) {
    for (size_t i = 0; i < rows.count; i++) {
        *residual(i) +=
            (float)((double)matrix.row[i][0] * ey + (double)matrix.row[i][1] * ex + (double)matrix.row[i][2] * ez);
    }
}

static void apply(void) { verdict = goe_gate_apply(&settings, &filter, &rows); }

/* Weight of a row after the gate: what its first column was multiplied with. */
static double weight_of(size_t row, const goe_matrix_t *before) {
    const int c = fabsf(before->row[row][0]) > fabsf(before->row[row][1]) ? 0 : 1;
    return (double)matrix.row[row][c] / (double)before->row[row][c];
}

static void check_weights(const goe_matrix_t *before, size_t but_feature, double share) {
    for (size_t i = 0; i < rows.count; i++) {
        const double expected = rows.feature[i] == but_feature ? share / SIGMA : 1.0 / SIGMA;
        CHECK_CLOSE(2.0e-3 * (expected + 1.0), expected, weight_of(i, before));
    }
}

/* [goe_estimate_t.nis_rows] */
static void rows_without_suspicion_are_divided_by_their_sigma(void) {
    for (size_t i = 0; i < rows.count; i++) {
        *residual(i) = (float)((i % 2 ? 0.8 : -0.8) * SIGMA);
    }
    const goe_matrix_t before = matrix;
    apply();
    TEST_ASSERT_EQUAL_HEX32(ALL, verdict.measured);
    TEST_ASSERT_EQUAL_HEX32(0u, verdict.refused);
    TEST_ASSERT_EQUAL_INT(9, verdict.rows);
    check_weights(&before, GOE_FEATURES, 1.0);
    for (size_t i = 0; i < rows.count; i++) {
        CHECK_CLOSE(1.0e-3, i % 2 ? 0.8 : -0.8, *residual(i));
    }
}

/* [(R14)] GIVEN one point that is 15 px off, whichever it is, along one coordinate or both THEN it alone is refused, and all of its
 * rows are 0. */
static void one_outlier_is_refused_alone(void) {
    for (size_t feature = 0; feature < GOE_FEATURES; feature++) {
        for (int axes = 1; axes <= 3; axes++) {
            int moved = 0;
            setUp();
            for (size_t i = 0; i < rows.count; i++) {
                if (rows.feature[i] == feature && (axes & (is_along_y(i) ? 2 : 1)) != 0) {
                    *residual(i) = (float)(15.0 / FOCAL_PX);
                    moved++;
                }
            }
            apply();
            TEST_ASSERT_EQUAL_HEX32(ALL, verdict.measured);
            TEST_ASSERT_EQUAL_HEX32(moved > 0 ? 1u << feature : 0u, verdict.refused);
            for (size_t i = 0; i < rows.count; i++) {
                const bool out = moved > 0 && rows.feature[i] == feature;
                float sum = 0.0f;
                for (size_t c = 0; c < GOE_COLUMNS; c++) {
                    sum += fabsf(matrix.row[i][c]);
                }
                TEST_ASSERT_TRUE(out ? sum == 0.0f : sum > 100.0f);
            }
        }
    }
}

/* [(R14)] GIVEN an attitude error of twice its sigma about each axis in turn, which is many pixels THEN no point is suspicious;
 * GIVEN four times THEN still none is refused. */
static void a_shift_of_all_points_refuses_none(void) {
    for (int axis = 0; axis < 3; axis++) {
        for (int sigmas = -4; sigmas <= 4; sigmas += 2) {
            setUp();
            const double angle = sigmas * (double)settings.navigation.attitude_white_sd_deg * RAD_PER_DEG;
            turn(axis == 0 ? angle : 0.0, axis == 1 ? angle : 0.0, axis == 2 ? angle : 0.0);
            const goe_matrix_t before = matrix;
            apply();
            TEST_ASSERT_EQUAL_HEX32(0u, verdict.refused);
            if (sigmas * sigmas <= 4) {
                check_weights(&before, GOE_FEATURES, 1.0);
            }
        }
    }
}

/* [(R14)] ... and an outlier is found in a shifted image, too. */
static void an_outlier_is_found_in_a_shifted_image(void) {
    for (size_t feature = 0; feature < GOE_FEATURES; feature++) {
        setUp();
        turn(0.003, -0.003, 0.002);
        for (size_t i = 0; i < rows.count; i++) {
            *residual(i) += rows.feature[i] == feature ? (float)(15.0 / FOCAL_PX) : 0.0f;
        }
        apply();
        TEST_ASSERT_EQUAL_HEX32(1u << feature, verdict.refused);
    }
}

/* [filter.huber_sigma, (R14)]
 * GIVEN a point between Huber's limit and the gate THEN its weight is that of a residual on the limit, for both of its rows:
 * weight^2 = huber / residual. */
static void a_suspicious_point_counts_less(void) {
    static const double normalised[] = {2.4, 3.0, 4.0, 4.9};
    const size_t feature = GOE_POINT_BASE_NEAR;
    for (int n = 0; n < 4; n++) {
        setUp();
        rows.white_rad = 1.0e-4f * GOE_RAD_PER_DEG;
        for (size_t i = 0; i < rows.count; i++) { /* its difference from the middle one has both points' noise */
            *residual(i) =
                rows.feature[i] == feature && is_along_y(i) ? (float)(normalised[n] * sqrt(2.0) * SIGMA) : 0.0f;
        }
        const goe_matrix_t before = matrix;
        apply();
        TEST_ASSERT_EQUAL_HEX32(0u, verdict.refused);
        check_weights(&before, feature, normalised[n] > 2.5 ? sqrt(2.5 / normalised[n]) : 1.0);
    }
}

static void the_limits_are_settings(void) {
    rows.white_rad = 1.0e-4f * GOE_RAD_PER_DEG;
    settings.filter.gate_sigma = 3.0f;
    *residual(0) = (float)(3.2 * sqrt(2.0) * SIGMA);
    apply();
    TEST_ASSERT_EQUAL_HEX32(1u << rows.feature[0], verdict.refused);
    setUp();
    rows.white_rad = 1.0e-4f * GOE_RAD_PER_DEG;
    settings.filter.gate_sigma = 100.0f;
    settings.filter.huber_sigma = 1.0f;
    *residual(0) = (float)(10.0 * sqrt(2.0) * SIGMA);
    const goe_matrix_t before = matrix;
    apply();
    TEST_ASSERT_EQUAL_HEX32(0u, verdict.refused);
    check_weights(&before, rows.feature[0], sqrt(0.1));
}

/* Errors that repeat from image to image count as fewer images: (1 + r)/(1 - r) times the variance. */
static void correlated_errors_count_less(void) {
    settings.detector.point_correlation = 0.6f;
    const goe_matrix_t before = matrix;
    apply();
    for (size_t i = 0; i < rows.count; i++) {
        CHECK_CLOSE(1.0e-3, 0.5, weight_of(i, &before) * SIGMA);
    }
}

/* [(R14)] GIVEN a state that is not sure of what moves one point THEN that point may be far off; the same for what the state gained
 * since the latest rows. */
static void an_unsure_state_opens_the_gate(void) {
    for (int n = 0; n < 3; n++) {
        setUp();
        *residual(0) = (float)(15.0 / FOCAL_PX);
        matrix.row[0][GOE_STATE_COLUMN + GOE_BEARING] = 1.0f;
        if (n == 1) {
            inverse_set(&filter.root, GOE_BEARING, GOE_BEARING, 0.01);
        } else if (n == 2) {
            settings.navigation.position_walk_sd_m = 2.0f;
            filter.state[GOE_INVERSE_RANGE] = 0.01f;
            filter.due_s = 0.25f;
        }
        apply();
        TEST_ASSERT_EQUAL_HEX32(n == 0 ? 1u << rows.feature[0] : 0u, verdict.refused);
    }
}

/* GIVEN a single row along an axis THEN it is judged, too, by itself. */
static void a_row_alone_is_judged(void) {
    rows.count = 1;
    rows.white_rad = 1.0e-4f * GOE_RAD_PER_DEG;
    *residual(0) = (float)(6.0 * SIGMA);
    apply();
    TEST_ASSERT_EQUAL_HEX32(1u << rows.feature[0], verdict.refused);
    TEST_ASSERT_EQUAL_INT(0, verdict.rows);
}

/* GIVEN a bias of the attitude that has drifted since the latest rows, about whichever axis THEN a point that it moves may be
 * that much farther off. */
static void a_drift_of_the_attitude_opens_the_gate(void) {
    for (size_t axis = 0; axis < 3; axis++) {
        for (int drifted = 0; drifted < 2; drifted++) {
            setUp();
            *residual(0) = (float)(15.0 / FOCAL_PX);
            matrix.row[0][GOE_STATE_COLUMN + GOE_BIAS_X + axis] = -1.0f;
            settings.navigation.attitude_walk_sd_deg = (float)(0.02 / RAD_PER_DEG);
            filter.due_s = drifted == 1 ? 0.25f : 0.0f;
            apply();
            TEST_ASSERT_EQUAL_HEX32(drifted == 1 ? 0u : 1u << rows.feature[0], verdict.refused);
        }
    }
}

static void no_rows_are_no_verdict(void) {
    goe_rows_clear(&rows, &matrix);
    apply();
    TEST_ASSERT_EQUAL_HEX32(0u, verdict.measured | verdict.refused);
    TEST_ASSERT_EQUAL_INT(0, verdict.rows);
}

/* [goe_gate.c] GIVEN a track that started again and again WHEN a point is off by any number of sigmas THEN it is not refused, but counts less,
 * the more it is off. */
static void of_a_track_adrift_nothing_is_refused(void) {
    double before = 1.0;
    for (int i = 0; i < 3; i++) {
        setUp();
        filter.health.adrift = true;
        const goe_matrix_t whole = matrix;
        *residual(0) = (float)(20.0 * pow(10.0, i) * SIGMA);
        apply();
        TEST_ASSERT_EQUAL_HEX32(0u, verdict.refused);
        TEST_ASSERT_EQUAL_INT(rows.count, verdict.rows);
        const double share = weight_of(0, &whole) * SIGMA;
        TEST_ASSERT_TRUE(share > 0.0 && share < 0.5 * before);
        before = share;
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(rows_without_suspicion_are_divided_by_their_sigma);
    RUN_TEST(one_outlier_is_refused_alone);
    RUN_TEST(a_shift_of_all_points_refuses_none);
    RUN_TEST(an_outlier_is_found_in_a_shifted_image);
    RUN_TEST(a_suspicious_point_counts_less);
    RUN_TEST(the_limits_are_settings);
    RUN_TEST(correlated_errors_count_less);
    RUN_TEST(an_unsure_state_opens_the_gate);
    RUN_TEST(a_row_alone_is_judged);
    RUN_TEST(of_a_track_adrift_nothing_is_refused);
    RUN_TEST(a_drift_of_the_attitude_opens_the_gate);
    RUN_TEST(no_rows_are_no_verdict);
    return UNITY_END();
}
