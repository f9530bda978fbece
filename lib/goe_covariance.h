/* The latest estimate and its covariance. SPDX-License-Identifier: MIT */
#ifndef GOE_COVARIANCE_H
#define GOE_COVARIANCE_H

#include "refined/goe_quantities.h"

#define GOE_READY 0x474F4532u /* "GOE2" */

typedef float goe_covariance_t[GOE_QUANTITIES][GOE_QUANTITIES];

/* The estimate after the latest image. */
static inline const goe_estimate_t *goe_latest_estimate(const goe_estimator_t *estimator) {
    return estimator->settings.method == GOE_METHOD_REFINED ? &estimator->estimate : &estimator->window.estimate;
}

/* goe_covariance() of an estimator that has a position, the height's rows and columns counted from `zero`. */
void goe_latest_covariance(const goe_estimator_t *estimator, goe_zero_t zero, goe_covariance_t covariance);

/* Constant error of goe_pose_t.height_m that the height of the latest estimate has been freed from, and the camera's has
 * not; 0 if it has none. */
float goe_latest_height_bias(const goe_estimator_t *estimator);

#endif
