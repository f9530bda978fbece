/* The latest estimate and its covariance. SPDX-License-Identifier: MIT */
#ifndef GOE_COVARIANCE_H
#define GOE_COVARIANCE_H

#include "goe.h"

#define GOE_READY 0x474F4533u /* "GOE3" */

typedef float goe_covariance_t[GOE_QUANTITIES][GOE_QUANTITIES];

static inline bool goe_is_refined(const goe_estimator_t *estimator) {
#if GOE_WITH_WINDOW && GOE_WITH_REFINED
    return estimator->settings.method == GOE_METHOD_REFINED;
#else
    (void)estimator;
    return GOE_WITH_REFINED != 0;
#endif
}

/* GOE_OK, or GOE_BAD_ARGUMENT of a null pointer, or GOE_NOT_INITIALISED. */
static inline goe_status_t goe_check_ready(const goe_estimator_t *estimator) {
    if (!estimator) {
        return GOE_BAD_ARGUMENT;
    }
    return estimator->ready == GOE_READY ? GOE_OK : GOE_NOT_INITIALISED;
}

/* The estimate after the latest image. */
static inline const goe_estimate_t *goe_latest_estimate(const goe_estimator_t *estimator) {
#if !GOE_WITH_REFINED
    return &estimator->window.estimate;
#elif !GOE_WITH_WINDOW
    return &estimator->estimate;
#else
    return goe_is_refined(estimator) ? &estimator->estimate : &estimator->window.estimate;
#endif
}

/* goe_covariance(). from_datum: the top's height is counted from the altimeter's zero. */
goe_status_t goe_latest_covariance(const goe_estimator_t *estimator, bool from_datum, goe_covariance_t covariance);

/* Constant error of goe_pose_t.height_m that the height of the latest estimate has been freed from, and the camera's has
 * not; 0 if it has none. */
float goe_latest_height_bias(const goe_estimator_t *estimator);

#endif
