/* Square-root information filter: the triangle R and its operations. SPDX-License-Identifier: MIT
 *
 * R'R is the information of the state, R^-1 R^-1' its covariance; G. J. Bierman, "Factorization Methods for Discrete
 * Sequential Estimation" (1977), chapters V and VI. The state is the linearization point, so the right-hand side that
 * belongs to R is always zero. */
#ifndef GOE_SRIF_H
#define GOE_SRIF_H

#include "goe.h"

/* Columns of a row of goe_matrix_t: the image's own nuisances, the states, the augmented states, the residual (measured minus
 * predicted). */
#define GOE_STATE_COLUMN GOE_NUISANCES
#define GOE_AUGMENTED_COLUMN (GOE_STATE_COLUMN + GOE_STATES)
#define GOE_RESIDUAL (GOE_COLUMNS - 1)

/* Element (i, j), i <= j, is element[goe_srif_row(i) + j]. */
/*@ requires i <= GOE_UNKNOWNS; */
static inline size_t goe_srif_row(size_t i) { return i * (2u * GOE_UNKNOWNS - 1u - i) / 2u; }

/*@ requires \valid(r) && i <= j < GOE_UNKNOWNS; */
static inline float *goe_srif_at(goe_triangle_t *r, size_t i, size_t j) { return &r->element[goe_srif_row(i) + j]; }

/* Number of estimated augmented states; at most all of them. */
static inline size_t goe_srif_augmented_count(const goe_triangle_t *r) {
#if GOE_AUGMENTED
    return r->estimated < GOE_AUGMENTED ? r->estimated : GOE_AUGMENTED;
#else
    (void)r;
    return 0;
#endif
}

/* Number of states and estimated augmented states. */
static inline size_t goe_srif_count(const goe_triangle_t *r) { return GOE_STATES + goe_srif_augmented_count(r); }

/* Index of the first element of the augmented states. */
static inline size_t goe_srif_augmented_row(void) { return goe_srif_row(GOE_STATES) + GOE_STATES; }

/* Clears the derivatives by the states from `first` on, and by the augmented states: in two steps, each too short to be worth a call of
 * memset(). */
/*@ requires \valid(by + (0 .. GOE_UNKNOWNS - 1)) && first <= GOE_STATES; */
static inline void goe_srif_zero(float by[GOE_UNKNOWNS], size_t first) {
    for (size_t i = first; i < GOE_STATES; i++) {
        by[i] = 0.0f;
    }
#if GOE_AUGMENTED
    by[GOE_STATES] = 0.0f;
    by[GOE_STATES + 1] = 0.0f;
    by[GOE_STATES + 2] = 0.0f;
#endif
}

/* Clears the rows of the states; those of the augmented states remain. */
void goe_srif_clear(goe_triangle_t *root);

/* Number of leading elements, the attitude bias, that are 0 in some rows. */
#define GOE_UNWEIGHTED 3

/* An update by at most this many rows uses the shorter kernel. */
#define GOE_ROWS_FEW 5

/* (R15): rotates `count` whitened rows into R by Householder reflections and solves for the change of the state and of the estimated
 * augmented states. The rows after these must be 0. nuisance_root: 1/sigma of the nuisances. *matrix is overwritten. Returns the remaining
 * squared norm of the residuals: the normalized innovation squared. */
float goe_srif_update(goe_triangle_t *root, float nuisance_root, goe_matrix_t *matrix, size_t count,
                      float change[GOE_UNKNOWNS]);

/* The same, with the last state considered, not estimated (Schmidt 1966; Bierman 1977, chapter VIII): the gain is as if its present value
 * were exact, and its own information does not change. R then describes its part in the variances of the others. */
float goe_srif_update_considering(goe_triangle_t *root, float nuisance_root, goe_matrix_t *matrix, size_t count,
                                  float change[GOE_UNKNOWNS]);

/* For few rows without nuisances: rotates a whitened row into R by Givens rotations, which cost less than reflections, and its residual
 * into `right`, which must be 0 before the first row. The row's first GOE_UNWEIGHTED elements must be 0; the row is overwritten. */
void goe_srif_add(goe_triangle_t *root, float row[GOE_UNKNOWNS], float residual, float right[GOE_UNKNOWNS]);

/* Replaces `right` by the change of the state. */
void goe_srif_solve(const goe_triangle_t *root, float right[GOE_UNKNOWNS]);

/* Adds variance sigma^2 along a direction, of which the states from first to last are read and the others are 0; sigma > 0. */
/*@ requires \valid(root) && \valid_read(direction + (0 .. GOE_STATES - 1)) && first <= last < GOE_STATES; */
void goe_srif_spread(goe_triangle_t *root, const float direction[GOE_STATES], size_t first, size_t last, float sigma);

/* One over the diagonal of R: several projections share the divisions. */
void goe_srif_reciprocals(const goe_triangle_t *root, float reciprocal[GOE_STATES]);

/* Replaces w, the weights, by R^-1' w: the derivative in terms of independent unit errors. Returns its squared norm, the variance of w' x,
 * as if the augmented states were known. If the first GOE_UNWEIGHTED weights are 0, `first` may be GOE_UNWEIGHTED, for half of the cost;
 * otherwise it is 0. */
float goe_srif_project(const goe_triangle_t *root, const float reciprocal[GOE_STATES], size_t first,
                       float weight[GOE_STATES]);

/* The part of a projected w's variance that belongs to the last state alone. */
static inline float goe_srif_last_variance(const float projected[GOE_STATES]) {
    return projected[GOE_STATES - 1] * projected[GOE_STATES - 1];
}

#if GOE_AUGMENTED
/* Sets part[], whose sum of squares is the contribution of the augmented states to the variance of w' x + direct' augmented. projected: the
 * projected w, whose elements before `first`, 0 or GOE_UNWEIGHTED, are 0. direct may be null. considered: sigma of the target's velocity
 * while it is not estimated. */
/*@ requires \valid_read(root) && \valid_read(projected + (0 .. GOE_STATES - 1));
    requires direct == \null || \valid_read(direct + (0 .. GOE_AUGMENTED - 1));
    requires \valid(part + (0 .. GOE_AUGMENTED - 1)); */
void goe_srif_augmented(const goe_triangle_t *root, const float projected[GOE_STATES], size_t first,
                        const float direct[GOE_AUGMENTED], float considered, float part[GOE_AUGMENTED]);
#endif

/* Covariance of two such contributions, or the variance of one; 0 if there are no augmented states. */
/*@ requires \valid_read(a + (0 .. GOE_AUGMENTED - 1)) && \valid_read(b + (0 .. GOE_AUGMENTED - 1)); */
static inline float goe_srif_augmented_dot(const float *a, const float *b) {
    float sum = 0.0f;
    for (int i = 0; i < GOE_AUGMENTED; i++) {
        sum += a[i] * b[i];
    }
    return sum;
}

/* Covariance of the first GOE_KEPT states; upper half. considered: as for goe_srif_augmented(). */
#define GOE_KEPT 6
void goe_srif_marginal(const goe_triangle_t *root, float considered, float covariance[GOE_KEPT][GOE_KEPT]);

/* Sets R from the covariance of the first states, which is overwritten, and the sigmas of the others, which are independent of them. */
void goe_srif_from_covariance(float covariance[GOE_KEPT][GOE_KEPT], const float sigma[GOE_STATES - GOE_KEPT],
                              goe_triangle_t *root);

/* Sets R from the sigmas of independent errors. */
void goe_srif_from_sigmas(const float sigma[GOE_STATES], goe_triangle_t *root);

/* Derivatives of the last GOE_CHANGED states by the new states that replace them. */
#define GOE_CHANGED 7
typedef struct {
    float by[GOE_CHANGED][GOE_CHANGED]; /* [old][new] */
} goe_substitution_t;

/* (R19): transforms R to the new states. */
void goe_srif_substitute(goe_triangle_t *root, const goe_substitution_t *old);

#endif
