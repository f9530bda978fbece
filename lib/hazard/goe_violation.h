/* Probability that a planned flight violates the margin and the clearance. SPDX-License-Identifier: MIT */
#ifndef GOE_VIOLATION_H
#define GOE_VIOLATION_H

#include "hazard/goe_affine.h"

/* The plan as an obstacle that moves sees it. The others take this one. */
goe_plan_t goe_violation_relative(const goe_estimator_t *estimator, const goe_plan_t *plan);

/* How long after the latest image the obstacle will be nearest, s, roughly: velocities, the own one and the obstacle's, add their
 * uncertainty up to then. */
float goe_violation_ahead_s(const goe_estimator_t *estimator, const goe_plan_t *relative);

/* Adds the error of the plan's own velocity to the place and to the height of the top, both relative to the camera then. */
void goe_violation_add_plan(const goe_estimator_t *estimator, const goe_plan_t *plan, float ahead_s,
                            goe_covariance_t covariance);

/* Sets *hazard, all zero before, for an estimator that has a position and a plan within its ranges. covariance: with the
 * height counted from the altimeter's zero. */
void goe_violation_foresee(const goe_estimator_t *estimator, const goe_plan_t *plan, goe_covariance_t covariance,
                           goe_hazard_t *hazard);

#endif
