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
goe_status_t goe_covariance_ahead(const goe_estimator_t *estimator, bool for_hazard, float ahead_s,
                                  goe_covariance_t covariance);

#endif
