/* What every function that only reads an estimator needs of it. SPDX-License-Identifier: MIT */
#ifndef GOE_TOLD_H
#define GOE_TOLD_H

#include "goe.h"

#define GOE_READY 0x474F4532u /* "GOE2" */

static inline bool goe_is_refined(const goe_estimator_t *estimator) {
    return estimator->settings.method == GOE_METHOD_REFINED;
}

/* The answer after the latest image. */
static inline const goe_estimate_t *goe_told(const goe_estimator_t *estimator) {
    return goe_is_refined(estimator) ? &estimator->told : &estimator->estimate;
}

/* From what the top's height is counted. */
typedef enum {
    GOE_FROM_GROUND, /* of the obstacle */
    GOE_FROM_DATUM   /* where the told height of the camera is 0: its constant error does not part camera and top */
} goe_zero_t;

/* goe_covariance() of an estimator that has a position, the height's rows and columns counted from `zero`. */
void goe_told_covariance(const goe_estimator_t *estimator, goe_zero_t zero,
                         float covariance[GOE_QUANTITIES][GOE_QUANTITIES]);

#endif
