/* Probability that a planned flight violates the margin and the clearance. SPDX-License-Identifier: MIT */
#ifndef GOE_CONFLICT_H
#define GOE_CONFLICT_H

#include "hazard/goe_affine.h"

#define GOE_DISTANCE_MAX_M 1.0e4f /* of an intent's margin and clearance */

/* Returns GOE_OK, or why the intent is refused: GOE_NOT_FINITE, GOE_OUT_OF_RANGE. */
goe_status_t goe_conflict_check(const goe_intent_t *intent);

/* The intent relative to the obstacle: the own velocity minus the obstacle's, if that is valid. */
goe_intent_t goe_conflict_relative(const goe_estimator_t *estimator, const goe_intent_t *intent);

/* Approximate time from the latest image to the closest approach, s. Until then, the uncertainties of the own velocity and of the
 * obstacle's velocity count. */
float goe_conflict_ahead_s(const goe_estimator_t *estimator, const goe_intent_t *relative);

/* Adds the error of the intent's own velocity to the position and to the top's height, both relative to the camera at that time. */
void goe_conflict_add_intent(const goe_estimator_t *estimator, const goe_intent_t *intent, float ahead_s,
                             goe_covariance_t covariance);

/* Sets *hazard, which must be all zero, for an estimator with a position and an intent within its ranges. In covariance, the height counts
 * from the altimeter's zero. */
void goe_conflict_foresee(const goe_estimator_t *estimator, const goe_intent_t *intent, goe_covariance_t covariance,
                          goe_hazard_t *hazard);

#endif
