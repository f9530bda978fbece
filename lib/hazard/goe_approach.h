/* Closest approach of a straight flight to an outline. SPDX-License-Identifier: MIT */
#ifndef GOE_APPROACH_H
#define GOE_APPROACH_H

#include "goe_told.h"

typedef float goe_covariance_t[GOE_QUANTITIES][GOE_QUANTITIES];

/* Sets *hazard, all zero before, for an estimator that has a position and a plan within its ranges. height_m: of the camera
 * over the top now. */
void goe_approach_foresee(const goe_estimator_t *estimator, const goe_plan_t *plan, float height_m,
                          goe_covariance_t covariance, goe_hazard_t *hazard);

#endif
