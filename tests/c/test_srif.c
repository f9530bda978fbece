/* Square-root information against dense normal equations in double. SPDX-License-Identifier: MIT */
/* tests: lib/refined/goe_srif.c */
#include "refined/goe_srif.h"

#include <math.h>
#include <string.h>

#include "check.h"

#define N GOE_STATES
#define ROWS GOE_ROWS_MAX
#define CASES 300
#define SHARE 2.0e-4 /* rounding, of one sigma, at the condition numbers of random_root() */

typedef struct {
    double m[N][N];
} dense_t;

static check_random_t any;
static const goe_triangle_t no_root;

void setUp(void) {}
void tearDown(void) {}

/* ---------------------------------------------------------------------------------------------------- dense reference -- */

/* Gauss-Jordan with pivoting: *inverse = a^-1. */
static dense_t inverted(dense_t a, int n) {
    dense_t inverse;
    memset(&inverse, 0, sizeof inverse);
    for (int i = 0; i < n; i++) {
        inverse.m[i][i] = 1.0;
    }
    for (int c = 0; c < n; c++) {
        int pivot = c;
        for (int i = c + 1; i < n; i++) {
            pivot = fabs(a.m[i][c]) > fabs(a.m[pivot][c]) ? i : pivot;
        }
        for (int j = 0; j < n; j++) {
            const double x = a.m[c][j];
            const double y = inverse.m[c][j];
            a.m[c][j] = a.m[pivot][j];
            a.m[pivot][j] = x;
            inverse.m[c][j] = inverse.m[pivot][j];
            inverse.m[pivot][j] = y;
        }
        const double by = 1.0 / a.m[c][c];
        for (int j = 0; j < n; j++) {
            a.m[c][j] *= by;
            inverse.m[c][j] *= by;
        }
        for (int i = 0; i < n; i++) {
            const double f = i == c ? 0.0 : a.m[i][c];
            for (int j = 0; j < n; j++) {
                a.m[i][j] -= f * a.m[c][j];
                inverse.m[i][j] -= f * inverse.m[c][j];
            }
        }
    }
    return inverse;
}

static dense_t dense_of(const goe_triangle_t *triangle) {
    dense_t d;
    memset(&d, 0, sizeof d);
    for (size_t i = 0; i < N; i++) {
        for (size_t j = i; j < N; j++) {
            d.m[i][j] = (double)triangle->element[goe_srif_row(i) + j];
        }
    }
    return d;
}

/* R'R */
static dense_t information_of(const goe_triangle_t *root) {
    const dense_t r = dense_of(root);
    dense_t p;
    for (int i = 0; i < N; i++) {
        for (int j = 0; j < N; j++) {
            p.m[i][j] = 0.0;
            for (int k = 0; k < N; k++) {
                p.m[i][j] += r.m[k][i] * r.m[k][j];
            }
        }
    }
    return p;
}

static dense_t covariance_of(const goe_triangle_t *root) { return inverted(information_of(root), N); }

/* Symmetric matrices, each element by the diagonal's. */
static void check_equal(double share, const dense_t *expected, const dense_t *actual) {
    for (int i = 0; i < N; i++) {
        for (int j = 0; j < N; j++) {
            const double scale = sqrt(expected->m[i][i] * expected->m[j][j]);
            CHECK_CLOSE(share, 0.0, (actual->m[i][j] - expected->m[i][j]) / scale);
        }
    }
}

/* ------------------------------------------------------------------------------------------------------------- input -- */

static float normal(void) { return (float)check_random_normal(&any); }

/* Diagonals from 1 to 1000 and of either sign, the rest of their row's size. */
static void random_root(goe_triangle_t *root) {
    memset(root, 0, sizeof *root);
    for (size_t i = 0; i < N; i++) {
        const double size = pow(10.0, check_random_between(&any, 0.0, 3.0));
        for (size_t j = i; j < N; j++) {
            *goe_srif_at(root, i, j) = (float)(0.5 * size * check_random_normal(&any));
        }
        *goe_srif_at(root, i, i) = (float)(check_random_bits(&any) % 2u ? size : -size);
    }
}

/* `rows` rows, the rest 0. */
static void random_matrix(size_t rows, goe_matrix_t *matrix) {
    memset(matrix, 0, sizeof *matrix);
    for (size_t c = 0; c < GOE_COLUMNS; c++) {
        const double size = c == GOE_RESIDUAL ? 1.0 : pow(10.0, check_random_between(&any, 0.0, 3.0));
        for (size_t i = 0; i < rows; i++) {
            matrix->row[i][c] = (float)(size * check_random_normal(&any));
        }
    }
}

/* ------------------------------------------------------------------------------------------------------------- update -- */

typedef struct {
    dense_t information;
    double right[N]; /* A'S^-1r */
    double change[N];
    double nis;
} solution_t;

/* Unit noise of the rows, and the temporaries': S = I + B B'/t^2. */
static dense_t noise_of(const goe_matrix_t *matrix, double nuisance_root) {
    dense_t s;
    memset(&s, 0, sizeof s);
    for (int i = 0; i < ROWS; i++) {
        for (int j = 0; j < ROWS; j++) {
            s.m[i][j] = i == j ? 1.0 : 0.0;
            for (int c = 0; c < GOE_NUISANCES; c++) {
                s.m[i][j] += (double)matrix->row[i][c] * (double)matrix->row[j][c] / (nuisance_root * nuisance_root);
            }
        }
    }
    return s;
}

/* R'R + A'S^-1A, its solution for A'S^-1r, and the rest: e'S^-1e + x'R'Rx, e = r - Ax. */
static solution_t solve(const goe_triangle_t *root, double nuisance_root, const goe_matrix_t *matrix) {
    const dense_t weight = inverted(noise_of(matrix, nuisance_root), ROWS);
    const dense_t prior = information_of(root);
    solution_t s;
    double *right = s.right;
    double left_over[ROWS];
    s.information = prior;
    for (int i = 0; i < N; i++) {
        float a[ROWS];
        for (int k = 0; k < ROWS; k++) {
            a[k] = matrix->row[k][GOE_STATE_COLUMN + i];
        }
        right[i] = 0.0;
        for (int k = 0; k < ROWS; k++) {
            for (int l = 0; l < ROWS; l++) {
                right[i] += (double)a[k] * weight.m[k][l] * (double)matrix->row[l][GOE_RESIDUAL];
                for (int j = 0; j < N; j++) {
                    s.information.m[i][j] += (double)a[k] * weight.m[k][l] * (double)matrix->row[l][GOE_NUISANCES + j];
                }
            }
        }
    }
    const dense_t covariance = inverted(s.information, N);
    for (int i = 0; i < N; i++) {
        s.change[i] = 0.0;
        for (int j = 0; j < N; j++) {
            s.change[i] += covariance.m[i][j] * right[j];
        }
    }
    s.nis = 0.0;
    for (int k = 0; k < ROWS; k++) {
        left_over[k] = (double)matrix->row[k][GOE_RESIDUAL];
        for (int j = 0; j < N; j++) {
            left_over[k] -= (double)matrix->row[k][GOE_NUISANCES + j] * s.change[j];
        }
    }
    for (int k = 0; k < ROWS; k++) {
        for (int l = 0; l < ROWS; l++) {
            s.nis += left_over[k] * weight.m[k][l] * left_over[l];
        }
    }
    for (int i = 0; i < N; i++) {
        for (int j = 0; j < N; j++) {
            s.nis += s.change[i] * prior.m[i][j] * s.change[j];
        }
    }
    return s;
}

static void check_update(goe_triangle_t *root, double nuisance_root, goe_matrix_t *matrix) {
    const solution_t expected = solve(root, nuisance_root, matrix);
    const dense_t covariance = inverted(expected.information, N);
    float change[GOE_UNKNOWNS];
    const float nis = goe_srif_update(root, (float)nuisance_root, matrix, GOE_ROWS_MAX, change);
    const dense_t information = information_of(root);
    check_equal(SHARE, &expected.information, &information);
    for (int i = 0; i < N; i++) {
        CHECK_CLOSE(SHARE, 0.0, ((double)change[i] - expected.change[i]) / sqrt(covariance.m[i][i]));
    }
    CHECK_CLOSE(SHARE * (1.0 + expected.nis), expected.nis, nis);
}

/* [GOE_METHOD_FILTER, goe_estimate_t.nis, (R15)]
 * GIVEN any triangle and any 1 to 9 rows WHEN they are rotated in THEN information, change and the rest are those of the
 * normal equations with the temporaries' noise in the rows' covariance. */
static void an_update_solves_the_normal_equations(void) {
    any = check_random_start("update");
    for (int n = 0; n < CASES; n++) {
        goe_triangle_t root = no_root;
        goe_matrix_t matrix;
        random_root(&root);
        random_matrix(1u + (size_t)n % ROWS, &matrix);
        check_update(&root, pow(10.0, check_random_between(&any, 0.0, 3.0)), &matrix);
    }
}

/* [T3] GIVEN the same WHEN the last state is considered THEN the others are those of the normal equations with that state fixed at 0,
 * their dependence on it is that of these equations, too, and its own information stays. */
static void a_considered_state_is_held_and_depended_on(void) {
    any = check_random_start("considering");
    for (int n = 0; n < CASES; n++) {
        goe_triangle_t root = no_root;
        goe_matrix_t matrix;
        float change[GOE_UNKNOWNS];
        random_root(&root);
        random_matrix(1u + (size_t)n % ROWS, &matrix);
        const double nuisance_root = pow(10.0, check_random_between(&any, 0.0, 3.0));
        const float known = *goe_srif_at(&root, N - 1, N - 1);
        const solution_t expected = solve(&root, nuisance_root, &matrix);
        const dense_t covariance = inverted(expected.information, N - 1);
        (void)goe_srif_update_considering(&root, (float)nuisance_root, &matrix, GOE_ROWS_MAX, change);
        const dense_t information = information_of(&root);
        TEST_ASSERT_EQUAL_FLOAT(known, *goe_srif_at(&root, N - 1, N - 1));
        TEST_ASSERT_EQUAL_FLOAT(0.0f, change[N - 1]);
        for (int i = 0; i < N - 1; i++) {
            double held = 0.0;
            for (int j = 0; j < N; j++) {
                const double scale = sqrt(expected.information.m[i][i] * expected.information.m[j][j]);
                CHECK_CLOSE(SHARE, 0.0, (information.m[i][j] - expected.information.m[i][j]) / scale);
                held += j < N - 1 ? covariance.m[i][j] * expected.right[j] : 0.0;
            }
            CHECK_CLOSE(SHARE, 0.0, ((double)change[i] - held) / sqrt(covariance.m[i][i]));
        }
    }
}

/* [goe_estimate_t.nis, (R15)]
 * GIVEN measurements drawn from the model WHEN updated many times THEN the squares that are left over average to the number
 * of rows: that is what makes them an innovation statistic. */
static void the_squares_left_over_average_to_the_number_of_rows(void) {
    const size_t rows = 7;
    const int draws = 4000;
    double sum = 0.0;
    any = check_random_start("innovations");
    goe_triangle_t root = no_root;
    goe_matrix_t matrix;
    random_root(&root);
    const dense_t v = inverted(dense_of(&root), N);
    random_matrix(rows, &matrix);
    for (int n = 0; n < draws; n++) {
        goe_triangle_t updated = root;
        goe_matrix_t drawn = matrix;
        float noise[N];
        float change[GOE_UNKNOWNS];
        float temporaries[GOE_NUISANCES];
        for (size_t i = 0; i < N; i++) {
            noise[i] = normal();
        }
        for (size_t i = 0; i < GOE_NUISANCES; i++) {
            temporaries[i] = normal() / 20.0f;
        }
        for (size_t k = 0; k < rows; k++) {
            double r = (double)normal();
            for (size_t c = 0; c < GOE_NUISANCES; c++) {
                r += (double)matrix.row[k][c] * (double)temporaries[c];
            }
            for (size_t i = 0; i < N; i++) { /* a state off by R^-1 noise */
                for (size_t j = i; j < N; j++) {
                    r += (double)matrix.row[k][GOE_NUISANCES + i] * v.m[i][j] * (double)noise[j];
                }
            }
            drawn.row[k][GOE_RESIDUAL] = (float)r;
        }
        sum += (double)goe_srif_update(&updated, 20.0f, &drawn, GOE_ROWS_MAX, change);
    }
    check_report("mean of the squares left over, 7 rows", sum / draws);
    CHECK_CLOSE(5.0 * sqrt(2.0 * (double)rows / draws), (double)rows, sum / draws); /* 5 sigma */
}

/* [(R15)] */
static void rows_of_zeros_change_nothing(void) {
    any = check_random_start("zeros");
    goe_triangle_t root = no_root;
    goe_matrix_t matrix;
    float change[GOE_UNKNOWNS];
    random_root(&root);
    const goe_triangle_t before = root;
    memset(&matrix, 0, sizeof matrix);
    CHECK_SAME(0.0f, goe_srif_update(&root, 100.0f, &matrix, GOE_ROWS_MAX, change));
    TEST_ASSERT_EQUAL_MEMORY(&before, &root, sizeof root);
    for (int i = 0; i < N; i++) {
        TEST_ASSERT_EQUAL_FLOAT(0.0f, change[i]);
    }
}

/* A residual that no column explains is left over whole. */
static void a_row_without_derivatives_is_left_over(void) {
    any = check_random_start("no derivatives");
    goe_triangle_t root = no_root;
    goe_matrix_t matrix;
    float change[GOE_UNKNOWNS];
    random_root(&root);
    memset(&matrix, 0, sizeof matrix);
    matrix.row[4][GOE_RESIDUAL] = 3.0f;
    CHECK_SAME(9.0f, goe_srif_update(&root, 100.0f, &matrix, GOE_ROWS_MAX, change));
}

/* [(R15)]
 * GIVEN up to five rows WHEN they are counted THEN the shorter kernel gives the bits of the longer one, which reads rows of zeros behind
 * them. */
static void few_rows_give_the_same_bits(void) {
    any = check_random_start("few rows");
    for (size_t rows = 1; rows <= GOE_ROWS_FEW; rows++) {
        for (int n = 0; n < 50; n++) {
            goe_triangle_t root[2] = {no_root, no_root};
            goe_matrix_t matrix[2];
            float change[2][GOE_UNKNOWNS];
            float nis[2];
            random_root(&root[0]);
            random_matrix(rows, &matrix[0]);
            root[1] = root[0];
            matrix[1] = matrix[0];
            if (n % 2 == 0) {
                nis[0] = goe_srif_update(&root[0], 50.0f, &matrix[0], rows, change[0]);
                nis[1] = goe_srif_update(&root[1], 50.0f, &matrix[1], GOE_ROWS_MAX, change[1]);
            } else {
                nis[0] = goe_srif_update_considering(&root[0], 50.0f, &matrix[0], rows, change[0]);
                nis[1] = goe_srif_update_considering(&root[1], 50.0f, &matrix[1], GOE_ROWS_MAX, change[1]);
            }
            CHECK_SAME(nis[1], nis[0]);
            TEST_ASSERT_EQUAL_MEMORY(&root[1], &root[0], sizeof root[0]);
            TEST_ASSERT_EQUAL_MEMORY(change[1], change[0], sizeof change[0]);
        }
    }
}

/* [(R15)] Each row of R with the other sign is the same information. */
static void the_signs_of_the_rows_are_free(void) {
    any = check_random_start("signs");
    for (size_t i = 0; i < N; i++) {
        goe_triangle_t root = no_root;
        goe_matrix_t matrix;
        float change[2][GOE_UNKNOWNS];
        float nis[2];
        random_root(&root);
        random_matrix(ROWS, &matrix);
        for (int turned = 0; turned < 2; turned++) {
            goe_triangle_t r = root;
            goe_matrix_t m = matrix;
            for (size_t j = i; turned && j < N; j++) {
                *goe_srif_at(&r, i, j) *= -1.0f;
            }
            const dense_t covariance = covariance_of(&r);
            nis[turned] = goe_srif_update(&r, 50.0f, &m, GOE_ROWS_MAX, change[turned]);
            for (int k = 0; turned && k < N; k++) {
                CHECK_CLOSE(SHARE, 0.0, ((double)change[1][k] - (double)change[0][k]) / sqrt(covariance.m[k][k]));
            }
        }
        CHECK_CLOSE(SHARE * (1.0 + (double)nis[0]), nis[0], nis[1]);
    }
}

/* ------------------------------------------------------------------------------------------------------ process noise -- */

static void check_spread(const float direction[GOE_STATES], size_t first, size_t last, float sigma) {
    goe_triangle_t root = no_root;
    random_root(&root);
    dense_t expected = covariance_of(&root);
    for (int i = 0; i < N; i++) {
        for (int j = 0; j < N; j++) {
            expected.m[i][j] += (double)sigma * (double)sigma * (double)direction[i] * (double)direction[j];
        }
    }
    goe_srif_spread(&root, direction, first, last, sigma);
    const dense_t actual = covariance_of(&root);
    check_equal(5.0 * SHARE, &expected, &actual);
}

/* [navigation.attitude_walk_sd_deg, navigation.position_walk_sd_m, (R12)]
 * GIVEN a variance along one state, or along several at once THEN the covariance grows by sigma^2 d d', and nothing else
 * changes. */
static void spreading_adds_to_the_covariance(void) {
    any = check_random_start("spread");
    for (int n = 0; n < CASES; n++) {
        const size_t last = (size_t)check_random_bits(&any) % N;
        const float sigma = (float)pow(10.0, check_random_between(&any, -4.0, 1.0));
        float direction[N] = {0.0f};
        direction[last] = 1.0f;
        check_spread(direction, last, last, sigma);
        for (size_t i = 0; i <= last; i++) {
            direction[i] = check_random_bits(&any) % 2u ? normal() : 0.0f;
        }
        check_spread(direction, 0, last, sigma);
    }
}

/* [(R12)] GIVEN a sigma so small that its inverse squared is no float any more THEN the root stays as it is. */
static void a_tiny_sigma_changes_nothing(void) {
    static const float tiny[] = {1.0e-45f, 1.0e-38f, 1.0e-30f, 1.0e-20f, 1.0e-19f, 1.0e-17f};
    static const float one[N] = {1.0f};
    static const float two[N] = {[2] = 1.0f, [6] = -0.5f};
    any = check_random_start("tiny sigma");
    for (size_t i = 0; i < sizeof tiny / sizeof tiny[0]; i++) {
        goe_triangle_t root = no_root;
        random_root(&root);
        const dense_t before = information_of(&root);
        goe_srif_spread(&root, one, 0, 0, tiny[i]);
        goe_srif_spread(&root, two, 2, 6, tiny[i]);
        const dense_t after = information_of(&root);
        check_equal(SHARE, &before, &after);
    }
}

/* ---------------------------------------------------------------------------------------------------------- variances -- */

/* [(R20)] GIVEN any triangle THEN the part of each state is its column of the inverse of R', and its square is the variance. */
static void the_root_times_a_part_is_one(void) {
    any = check_random_start("part");
    for (int n = 0; n < CASES; n++) {
        goe_triangle_t root = no_root;
        random_root(&root);
        const dense_t r = dense_of(&root);
        float reciprocal[N];
        goe_srif_reciprocals(&root, reciprocal);
        for (size_t state = 0; state < N; state++) {
            float part[N] = {0.0f};
            double squares = 0.0;
            part[state] = 1.0f;
            const float variance = goe_srif_project(&root, reciprocal, 0, part);
            for (size_t j = 0; j < N; j++) {
                double product = 0.0;
                double size = 1.0;
                for (size_t i = 0; i <= j; i++) {
                    product += r.m[i][j] * (double)part[i];
                    size += fabs(r.m[i][j] * (double)part[i]);
                }
                CHECK_CLOSE(5.0e-6 * size, j == state ? 1.0 : 0.0, product);
                squares += (double)part[j] * (double)part[j];
            }
            CHECK_CLOSE(1.0e-5 * squares, squares, variance);
        }
    }
}

/* [(R20)] GIVEN weights with zeros among them THEN projected'projected = w'Pw. */
static void a_variance_is_the_covariance_projected_along_the_weights(void) {
    any = check_random_start("variance");
    for (int n = 0; n < CASES; n++) {
        goe_triangle_t root = no_root;
        float reciprocal[N];
        float weight[N];
        float projected[N];
        float shorter[N];
        double expected = 0.0;
        double squares = 0.0;
        random_root(&root);
        goe_srif_reciprocals(&root, reciprocal);
        const dense_t p = covariance_of(&root);
        const bool rest = n % 2 == 0; /* weights of a quantity, or of a row */
        for (int i = 0; i < N; i++) {
            const bool weighs = check_random_bits(&any) % 3u && !(rest && i < GOE_UNWEIGHTED);
            weight[i] = weighs ? normal() / (float)sqrt(p.m[i][i]) : 0.0f;
        }
        for (int i = 0; i < N; i++) {
            for (int j = 0; j < N; j++) {
                expected += (double)weight[i] * p.m[i][j] * (double)weight[j];
            }
        }
        memcpy(projected, weight, sizeof projected);
        const float variance = goe_srif_project(&root, reciprocal, 0, projected);
        CHECK_CLOSE(SHARE * (double)N, expected, variance);
        for (int i = 0; i < N; i++) {
            squares += (double)projected[i] * (double)projected[i];
        }
        CHECK_CLOSE(SHARE * (double)N, expected, squares);
        CHECK_SAME(projected[N - 1] * projected[N - 1], goe_srif_last_variance(projected));
        if (!rest) {
            continue;
        }
        memcpy(shorter, weight, sizeof shorter);
        CHECK_SAME(variance, goe_srif_project(&root, reciprocal, GOE_UNWEIGHTED, shorter));
        TEST_ASSERT_EQUAL_FLOAT_ARRAY(projected, shorter, N);
    }
}

/* GIVEN any triangle WHEN the covariance of its first states is taken THEN it is that block of the whole one; WHEN it is put
 * together with sigmas for the others THEN the root is that of a covariance in which these stand alone. */
static void a_marginal_makes_a_root_again(void) {
    any = check_random_start("marginal");
    for (int n = 0; n < CASES; n++) {
        goe_triangle_t root = no_root;
        float c[GOE_KEPT][GOE_KEPT];
        float sigma[N - GOE_KEPT];
        random_root(&root);
        dense_t expected = covariance_of(&root);
        goe_srif_marginal(&root, 0.0f, c);
        for (size_t i = 0; i < N; i++) {
            for (size_t j = i; j < N; j++) {
                if (j < GOE_KEPT) {
                    const double scale = sqrt(expected.m[i][i] * expected.m[j][j]);
                    CHECK_CLOSE(SHARE, 0.0, ((double)c[i][j] - expected.m[i][j]) / scale);
                } else {
                    expected.m[i][j] = 0.0;
                    expected.m[j][i] = 0.0;
                }
            }
        }
        for (size_t i = GOE_KEPT; i < N; i++) {
            sigma[i - GOE_KEPT] = (float)pow(10.0, check_random_between(&any, -3.0, 1.0));
            expected.m[i][i] = (double)sigma[i - GOE_KEPT] * (double)sigma[i - GOE_KEPT];
        }
        goe_srif_from_covariance(c, sigma, &root);
        const dense_t actual = covariance_of(&root);
        check_equal(20.0 * SHARE, &expected, &actual); /* squaring doubled the digits that the condition takes */
    }
}

/* GIVEN a covariance without any rank left THEN the root is finite all the same. */
static void a_singular_covariance_gives_a_finite_root(void) {
    float c[GOE_KEPT][GOE_KEPT];
    const float sigma[N - GOE_KEPT] = {1.0f, 1.0f, 1.0f, 1.0f};
    goe_triangle_t root = no_root;
    for (size_t i = 0; i < GOE_KEPT; i++) {
        for (size_t j = 0; j < GOE_KEPT; j++) {
            c[i][j] = 1.0f; /* all states are the same one */
        }
    }
    goe_srif_from_covariance(c, sigma, &root);
    for (size_t i = 0; i < sizeof root.element / sizeof(float); i++) {
        TEST_ASSERT_TRUE(check_is_finite(root.element[i]));
    }
}

/* [(R19)] GIVEN new states of which the last seven old ones are functions THEN the information in the new ones is D'(R'R)D. */
static void a_substitution_keeps_the_information(void) {
    any = check_random_start("substitution");
    for (int c = 0; c < CASES; c++) {
        goe_triangle_t root = no_root;
        goe_substitution_t old;
        dense_t d;
        random_root(&root);
        memset(&d, 0, sizeof d);
        for (int i = 0; i < N; i++) {
            d.m[i][i] = 1.0;
        }
        for (size_t i = 0; i < GOE_CHANGED; i++) {
            for (size_t j = 0; j < GOE_CHANGED; j++) {
                old.by[i][j] = (float)((i == j ? 1.5 : 0.0) + 0.2 * check_random_normal(&any));
                d.m[N - GOE_CHANGED + i][N - GOE_CHANGED + j] = (double)old.by[i][j];
            }
        }
        const dense_t r = dense_of(&root);
        dense_t rd;
        memset(&rd, 0, sizeof rd);
        for (int i = 0; i < N; i++) {
            for (int j = 0; j < N; j++) {
                for (int k = 0; k < N; k++) {
                    rd.m[i][j] += r.m[i][k] * d.m[k][j];
                }
            }
        }
        goe_srif_substitute(&root, &old);
        const dense_t changed = dense_of(&root);
        for (int i = 0; i < N; i++) {
            for (int j = 0; j < N; j++) {
                double expected = 0.0;
                double actual = 0.0;
                double size = 0.0;
                for (int k = 0; k < N; k++) {
                    expected += rd.m[k][i] * rd.m[k][j];
                    actual += changed.m[k][i] * changed.m[k][j];
                    size += fabs(rd.m[k][i] * rd.m[k][j]);
                }
                CHECK_CLOSE(SHARE * (size + 1.0e-6), expected, actual);
            }
        }
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(an_update_solves_the_normal_equations);
    RUN_TEST(a_considered_state_is_held_and_depended_on);
    RUN_TEST(the_squares_left_over_average_to_the_number_of_rows);
    RUN_TEST(rows_of_zeros_change_nothing);
    RUN_TEST(a_row_without_derivatives_is_left_over);
    RUN_TEST(few_rows_give_the_same_bits);
    RUN_TEST(the_signs_of_the_rows_are_free);
    RUN_TEST(spreading_adds_to_the_covariance);
    RUN_TEST(a_tiny_sigma_changes_nothing);
    RUN_TEST(the_root_times_a_part_is_one);
    RUN_TEST(a_variance_is_the_covariance_projected_along_the_weights);
    RUN_TEST(a_marginal_makes_a_root_again);
    RUN_TEST(a_singular_covariance_gives_a_finite_root);
    RUN_TEST(a_substitution_keeps_the_information);
    return UNITY_END();
}
