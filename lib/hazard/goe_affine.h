/* A value that depends on the estimate, with its derivatives with respect to the quantities of goe_covariance().
 * SPDX-License-Identifier: MIT */
#ifndef GOE_AFFINE_H
#define GOE_AFFINE_H

#include "goe_covariance.h"

typedef struct {
    float value;
    float by[GOE_QUANTITIES];
} goe_affine_t;

/* Divides value and derivatives by an exact divisor. */
void goe_affine_divide(goe_affine_t *affine, float divisor);

/* Covariance of two such values. */
float goe_affine_covariance(const goe_affine_t *a, const goe_affine_t *b, goe_covariance_t covariance);

float goe_affine_sigma(const goe_affine_t *affine, goe_covariance_t covariance);

/* Probability that the value is below the limit. */
float goe_affine_below(const goe_affine_t *affine, float limit, goe_covariance_t covariance);

/* Limits x to the range of reported numbers. */
float goe_bounded(float x);

#endif
