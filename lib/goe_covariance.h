/* The covariance of the latest estimate. SPDX-License-Identifier: MIT */
#ifndef GOE_COVARIANCE_H
#define GOE_COVARIANCE_H

#include "goe_latest.h"

typedef float goe_covariance_t[GOE_QUANTITIES][GOE_QUANTITIES];

/* goe_covariance() of an estimator that is ready.
 *   for_hazard  the top's height is counted from the altimeter's zero, place and width are those of the circle at a prism's near
 *               side (goe_quantities_covariance), and correlations that are lost are allowed for
 *   ahead_s     the place of an obstacle that moves counts that long after the latest image */
/*@ requires estimator == \null || \valid_read(estimator);
    requires \valid(covariance + (0 .. GOE_QUANTITIES - 1)); */
goe_status_t goe_latest_covariance(const goe_estimator_t *estimator, bool for_hazard, float ahead_s,
                                   goe_covariance_t covariance);

/* Height of the camera at the latest image, m, that the latest estimate's own height is counted with, and the constant
 * error of it that the estimate has been freed from (0 if none): their sum is the height above the obstacle's ground. */
float goe_latest_camera_height(const goe_estimator_t *estimator);
float goe_latest_height_bias(const goe_estimator_t *estimator);

/* Half of the visible extent of the obstacle about its reference point, m, also while the width is not valid; 0: not
 * known. An image without a detection, or a new start of the filter, does not reduce it. */
float goe_latest_reach(const goe_estimator_t *estimator);

/* Of a prism, from the reference point to the middle of a circle of this reach that begins at its near side, m, T axes. */
goe_place_t goe_latest_nearer(const goe_estimator_t *estimator);

#endif
