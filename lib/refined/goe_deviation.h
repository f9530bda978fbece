/* The error of a reported quantity as a weighted sum of independent unit errors, of the states and of the augmented states. The variance of
 * a quantity is the sum of its squared weights, the covariance of two quantities the scalar product of their weights.
 * SPDX-License-Identifier: MIT */
#ifndef GOE_DEVIATION_H
#define GOE_DEVIATION_H

#include "refined/goe_filter.h"

/* By how much an estimate is less certain than the filter's state. */
typedef struct {
    float scatter;                /* factor on the variances by the filter, (R32) */
    float reciprocal[GOE_STATES]; /* of R's diagonal, for the projections */
    float bend;                   /* factor on the part of a footprint's depth, goe_footprint_bend() */
    float
        own_m_s; /* sigma of the own velocity's constant error, over the root of the scatter: that factor does not apply to it */
} goe_widening_t;

typedef struct {
    float *by; /* of the states: the derivatives by them before the projection, the weights after it */
    float augmented[GOE_AUGMENTED > 0 ? GOE_AUGMENTED : 1];
} goe_deviation_t;

/* A direction in T, and the time after the filter's start for which a position along it is valid: the position of a followed obstacle
 * and that by a path with a constant error of the own velocity depend on the time. (0, 0) for a quantity that is no position. */
typedef struct {
    float x, z, at_s;
} goe_counted_t;

GOE_STATIC_ASSERT(GOE_STATES == 10 && GOE_UNWEIGHTED == 3, the_product_is_written_out_for_ten_states);

/* sum + a' b of projected derivatives, whose first elements are 0. */
static inline float goe_deviation_dot(const float a[GOE_STATES], const float b[GOE_STATES], float sum) {
    sum += a[3] * b[3];
    sum += a[4] * b[4];
    sum += a[5] * b[5];
    sum += a[6] * b[6];
    sum += a[7] * b[7];
    sum += a[8] * b[8];
    return sum + a[9] * b[9];
}

/* Projects an error: derivatives in, weights out. Returns its variance. */
float goe_deviation_project(const goe_filter_t *filter, const goe_widening_t *wider, goe_counted_t counted,
                            goe_deviation_t *error);

/* Returns `more` plus the covariance of two projected errors, without the scatter. */
float goe_deviation_covariance(const goe_deviation_t *a, const goe_deviation_t *b, float more);

/* Sets *sum to the error of x a + z b. sum->by must point to memory for the part of the states. */
void goe_deviation_sum(const goe_deviation_t *a, float x, const goe_deviation_t *b, float z, goe_deviation_t *sum);

void goe_deviation_scale(goe_deviation_t *error, float factor);

#endif
