/* The covariance of the latest estimate. SPDX-License-Identifier: MIT */
#ifndef GOE_COVARIANCE_H
#define GOE_COVARIANCE_H

#include "goe_latest.h"

typedef float goe_covariance_t[GOE_QUANTITIES][GOE_QUANTITIES];

/* goe_covariance(). from_datum: the top's height is counted from the altimeter's zero. */
goe_status_t goe_latest_covariance(const goe_estimator_t *estimator, bool from_datum, goe_covariance_t covariance);

/* Constant error of goe_pose_t.height_m that the height of the latest estimate has been freed from, and the camera's has
 * not; 0 if it has none. */
float goe_latest_height_bias(const goe_estimator_t *estimator);

#endif
