/* Method, age and stored data of the latest estimate, for the functions that read it. SPDX-License-Identifier: MIT */
#ifndef GOE_LATEST_H
#define GOE_LATEST_H

#include <string.h>

#include "goe.h"
#include "maths/goe_scalar.h"
#include "maths/goe_time.h"

static inline bool goe_uses_filter(const goe_estimator_t *estimator) {
#if GOE_WITH_WINDOW && GOE_WITH_FILTER
    return estimator->settings.method == GOE_METHOD_FILTER;
#else
    (void)estimator;
    return GOE_WITH_FILTER != 0;
#endif
}

static inline bool goe_latest_by_filter(const goe_estimator_t *estimator) {
    return estimator->estimate.method == GOE_METHOD_FILTER;
}

/* Time from the image that gave the estimate to a later time, s. */
static inline float goe_latest_since_s(const goe_estimator_t *estimator, int64_t now_us) {
    return goe_time_between_s(estimator->estimate_time_us, now_us, GOE_TIME_MAX_US);
}

/* Growth of the variance of the position relative to the camera in a time without a new estimate, m2, along X as along Z: by the velocity
 * of a moving obstacle and, in the filter method, by the errors of the own motion. */
static inline float goe_latest_grown_m2(const goe_estimator_t *estimator, float since_s) {
    const goe_sigma_t *sigma = &estimator->estimate.sigma;
    const float north = goe_square(sigma->velocity_north_m_s);
    const float east = goe_square(sigma->velocity_east_m_s);
    float velocity_m2_s2 = goe_larger(north, east);
    float walk_m2_s = 0.0f;
    if (goe_latest_by_filter(estimator)) {
        velocity_m2_s2 += goe_square(estimator->settings.navigation.velocity_bias_sd_m_s);
        walk_m2_s = goe_square(estimator->settings.navigation.position_walk_sd_m);
    }
    return velocity_m2_s2 * since_s * since_s + walk_m2_s * since_s;
}

/* Height of the camera at the latest image, m, as the method of the latest estimate uses it. Plus the height_bias_m of goe_latest_answer(),
 * it is the height above the obstacle's ground. */
static inline float goe_latest_camera_height(const goe_estimator_t *estimator) {
#if GOE_WITH_FILTER
    if (goe_latest_by_filter(estimator)) {
        return estimator->filter.datum.height_m;
    }
#endif
    return estimator->motion.height_m;
}

/* Data that the filter stored with the latest estimate; all 0 if the estimate is the window method's. An image without a detection, or a
 * restart of the filter, changes only the flags. */
static inline goe_answer_t goe_latest_answer(const goe_estimator_t *estimator) {
    goe_answer_t answer;
#if GOE_WITH_FILTER
    if (goe_latest_by_filter(estimator)) {
        return estimator->filter.answer;
    }
#else
    (void)estimator;
#endif
    memset(&answer, 0, sizeof answer);
    return answer;
}

#endif
