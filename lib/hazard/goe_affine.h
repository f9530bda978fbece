/* A number that depends on the estimate: its value and its derivatives by the quantities of goe_covariance.
 * SPDX-License-Identifier: MIT */
#ifndef GOE_AFFINE_H
#define GOE_AFFINE_H

#include "goe_covariance.h"

typedef struct {
    float value;
    float by[GOE_QUANTITIES];
} goe_affine_t;

/* The number over a divisor that is exact. */
void goe_affine_divide(goe_affine_t *affine, float divisor);

/* Covariance of two such numbers. */
float goe_affine_covariance(const goe_affine_t *a, const goe_affine_t *b, goe_covariance_t covariance);

float goe_affine_sigma(const goe_affine_t *affine, goe_covariance_t covariance);

/* Probability that the number lies below the limit. */
float goe_affine_below(const goe_affine_t *affine, float limit, goe_covariance_t covariance);

/* Within what may be reported. */
float goe_bounded(float x);

#endif
