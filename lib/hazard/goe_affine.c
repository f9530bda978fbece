/* First-order error propagation: sigma, covariance and probability of a value. SPDX-License-Identifier: MIT */
#include "hazard/goe_affine.h"

#include <math.h>

#include "maths/goe_normal.h"
#include "maths/goe_scalar.h"

#if GOE_WITH_HAZARD

#define SIGMA_MIN 1.0e-6f
#define NUMBER_MAX 1.0e9f /* limit of any reported number */

float goe_bounded(float x) { return goe_within(x, NUMBER_MAX) ? x : (x < 0.0f ? -NUMBER_MAX : NUMBER_MAX); }

void goe_affine_divide(goe_affine_t *affine, float divisor) {
    affine->value /= divisor;
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        affine->by[i] /= divisor;
    }
}

float goe_affine_covariance(const goe_affine_t *a, const goe_affine_t *b, goe_covariance_t covariance) {
    float sum = 0.0f;
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        float row = 0.0f;
        for (int j = 0; j < GOE_QUANTITIES; j++) {
            row += covariance[i][j] * b->by[j];
        }
        sum += a->by[i] * row;
    }
    return sum;
}

float goe_affine_sigma(const goe_affine_t *affine, goe_covariance_t covariance) {
    const float variance = goe_affine_covariance(affine, affine, covariance);
    return variance > 0.0f ? goe_bounded(sqrtf(variance)) : 0.0f;
}

float goe_affine_below(const goe_affine_t *affine, float limit, goe_covariance_t covariance) {
    return goe_normal_below((limit - affine->value) / goe_larger(goe_affine_sigma(affine, covariance), SIGMA_MIN));
}

#endif
