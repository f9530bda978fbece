/* Probability that a planned flight violates the margin and the clearance. SPDX-License-Identifier: MIT */
#ifndef GOE_VIOLATION_H
#define GOE_VIOLATION_H

#include "hazard/goe_affine.h"

/* Sets *hazard, all zero before, for an estimator that has a position and a plan within its ranges. covariance: with the
 * height counted from the altimeter's zero. */
void goe_violation_foresee(const goe_estimator_t *estimator, const goe_plan_t *plan, goe_covariance_t covariance,
                           goe_hazard_t *hazard);

#endif
