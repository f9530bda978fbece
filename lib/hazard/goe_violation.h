/* Probability that a planned flight violates the margin and the clearance. SPDX-License-Identifier: MIT */
#ifndef GOE_VIOLATION_H
#define GOE_VIOLATION_H

#include "hazard/goe_affine.h"

/* The plan as an obstacle that moves sees it. The others take this one. */
/*@ requires \valid_read(estimator) && \valid_read(plan); */
goe_plan_t goe_violation_relative(const goe_estimator_t *estimator, const goe_plan_t *plan);

/* How long after the latest image it will be nearest, roughly: what its velocity is uncertain by counts up to then. 0 of an
 * obstacle that stands still. */
/*@ requires \valid_read(estimator) && \valid_read(relative); */
float goe_violation_ahead_s(const goe_estimator_t *estimator, const goe_plan_t *relative);

/* Sets *hazard, all zero before, for an estimator that has a position and a plan within its ranges. covariance: with the
 * height counted from the altimeter's zero. */
/*@ requires \valid_read(estimator) && \valid_read(plan) && \valid(covariance + (0 .. GOE_QUANTITIES - 1));
    requires \valid(hazard); */
void goe_violation_foresee(const goe_estimator_t *estimator, const goe_plan_t *plan, goe_covariance_t covariance,
                           goe_hazard_t *hazard);

#endif
