/* The estimator as the calls read it: by which method, and how old its estimate is. SPDX-License-Identifier: MIT */
#ifndef GOE_LATEST_H
#define GOE_LATEST_H

#include "goe.h"
#include "maths/goe_scalar.h"
#include "maths/goe_time.h"

/*@ requires \valid_read(estimator); */
static inline bool goe_is_refined(const goe_estimator_t *estimator) {
#if GOE_WITH_WINDOW && GOE_WITH_REFINED
    return estimator->settings.method == GOE_METHOD_REFINED;
#else
    (void)estimator;
    return GOE_WITH_REFINED != 0;
#endif
}

/* From the image behind the estimate to a later time, s. */
/*@ requires \valid_read(estimator); */
static inline float goe_latest_since_s(const goe_estimator_t *estimator, int64_t now_us) {
    return goe_time_between_s(estimator->estimate_time_us, now_us, GOE_TIME_MAX_US);
}

/* What the place of an obstacle that moves has gained in variance since then, m2, along X as along Z; 0 of any other. */
/*@ requires \valid_read(estimate); */
static inline float goe_latest_grown_m2(const goe_estimate_t *estimate, float since_s) {
    const float north = goe_square(estimate->sigma.velocity_north_m_s);
    const float east = goe_square(estimate->sigma.velocity_east_m_s);
    return goe_larger(north, east) * since_s * since_s;
}

#endif
