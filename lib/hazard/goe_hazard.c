/* goe_hazard(): the encounter of a planned flight with the obstacle. SPDX-License-Identifier: MIT */
#include <string.h>

#include "goe_guard.h"
#include "hazard/goe_conflict.h"
#include "maths/goe_scalar.h"

#if GOE_WITH_HAZARD

#define VELOCITY_MAX_M_S 1.0e3f
#define DISTANCE_MAX_M 1.0e4f
#define SINCE_MAX_S 1.0e3f
#define VELOCITY_SD_MAX_M_S 100.0f
#define HAZARD_NUMBERS (offsetof(goe_hazard_t, has_clearance) / sizeof(float))

GOE_STATIC_ASSERT(offsetof(goe_hazard_t, conflict_probability) + sizeof(float) == offsetof(goe_hazard_t, has_clearance),
                  the_numbers_of_a_hazard_come_first);

/* Returns GOE_OK, or why the intent is refused. */
static goe_status_t check_intent(const goe_intent_t *intent) {
    const uint32_t velocity = goe_largest_of_three(intent->velocity_ned_m_s);
    const uint32_t margin = goe_magnitude(intent->margin_m);
    const uint32_t clearance = goe_magnitude(intent->clearance_m);
    const uint32_t since = goe_magnitude(intent->since_image_s);
    const uint32_t sd = goe_magnitude(intent->velocity_sd_m_s);
    const uint32_t most = goe_larger_bits(goe_larger_bits(velocity, since), goe_larger_bits(margin, clearance));
    if (goe_larger_bits(most, sd) >= GOE_INFINITY_BITS) {
        return GOE_NOT_FINITE;
    }
    const bool within = velocity <= goe_magnitude(VELOCITY_MAX_M_S) && margin <= goe_magnitude(DISTANCE_MAX_M) &&
                        clearance <= goe_magnitude(DISTANCE_MAX_M) && since <= goe_magnitude(SINCE_MAX_S) &&
                        sd <= goe_magnitude(VELOCITY_SD_MAX_M_S);
    const bool negative = intent->margin_m < 0.0f || intent->clearance_m < 0.0f || intent->since_image_s < 0.0f ||
                          intent->velocity_sd_m_s < 0.0f;
    return within && !negative ? GOE_OK : GOE_OUT_OF_RANGE;
}

goe_status_t goe_hazard(const goe_estimator_t *estimator, const goe_intent_t *intent, goe_hazard_t *hazard) {
    goe_covariance_t covariance;
    goe_intent_t relative;
    float ahead_s = 0.0f;
    if (!hazard) {
        return GOE_BAD_ARGUMENT;
    }
    memset(hazard, 0, sizeof *hazard);
    goe_status_t status = intent ? goe_guard_check(estimator) : GOE_BAD_ARGUMENT;
    if (status == GOE_OK) {
        status = check_intent(intent);
    }
    if (status == GOE_OK) {
        relative = goe_conflict_relative(estimator, intent);
        ahead_s = goe_conflict_ahead_s(estimator, &relative);
        status = goe_covariance_ahead(estimator, true, ahead_s, covariance);
    }
    if (status == GOE_OK) {
        goe_conflict_add_intent(estimator, intent, ahead_s, covariance);
        goe_conflict_foresee(estimator, &relative, covariance, hazard);
        if (!goe_guard_finite(&hazard->tcpa_s, HAZARD_NUMBERS)) {
            memset(hazard, 0, sizeof *hazard);
            status = GOE_CORRUPTED;
        }
    }
    return status;
}

#endif
