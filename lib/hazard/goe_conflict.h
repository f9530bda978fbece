/* Probability that a planned flight violates the margin and the clearance. SPDX-License-Identifier: MIT */
#ifndef GOE_CONFLICT_H
#define GOE_CONFLICT_H

#include "hazard/goe_affine.h"

/* The relative intent: the own velocity minus the obstacle's, if this one is valid. */
goe_intent_t goe_conflict_relative(const goe_estimator_t *estimator, const goe_intent_t *intent);

/* How long after the latest image the obstacle will be nearest, s, roughly: velocities, the own one and the obstacle's, add their
 * uncertainty up to then. */
float goe_conflict_ahead_s(const goe_estimator_t *estimator, const goe_intent_t *relative);

/* Adds the error of the intent's own velocity to the place and to the height of the top, both relative to the camera then. */
void goe_conflict_add_intent(const goe_estimator_t *estimator, const goe_intent_t *intent, float ahead_s,
                             goe_covariance_t covariance);

/* Sets *hazard, all zero before, for an estimator that has a position and an intent within its ranges. covariance: with the
 * height counted from the altimeter's zero. */
void goe_conflict_foresee(const goe_estimator_t *estimator, const goe_intent_t *intent, goe_covariance_t covariance,
                          goe_hazard_t *hazard);

#endif
