/* From the filter's state to the quantities of an estimate. SPDX-License-Identifier: MIT */
#ifndef GOE_ANSWER_H
#define GOE_ANSWER_H

#include "goe_told.h"

/* Sets *estimate from the filter and its inverse, fresh, if the position is known well enough; otherwise leaves a position
 * that it holds as it is, and returns false. */
bool goe_answer_tell(goe_estimator_t *estimator, goe_estimate_t *estimate);

/* How the latest image fits: nis to misfit, suspect, points. */
void goe_answer_residuals(const goe_estimator_t *estimator, goe_estimate_t *estimate);

/* Covariance of the six quantities, metres and radians, of the filter's present state. */
void goe_answer_covariance(const goe_estimator_t *estimator, goe_zero_t zero,
                           float covariance[GOE_QUANTITIES][GOE_QUANTITIES]);

/* (X, Z) in T, relative to T's origin, to north and east. */
static inline void goe_answer_place(const goe_estimator_t *estimator, float x_m, float z_m, float *north_m,
                                    float *east_m) {
    const float c = estimator->heading_cos;
    const float s = estimator->heading_sin;
    *north_m = estimator->origin_ne_m[0] + (c * z_m - s * x_m);
    *east_m = estimator->origin_ne_m[1] + (s * z_m + c * x_m);
}

#endif
