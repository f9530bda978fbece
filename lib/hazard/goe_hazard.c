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
#define INTENT_NUMBERS (sizeof(goe_intent_t) / sizeof(float))
#define HAZARD_NUMBERS (offsetof(goe_hazard_t, has_clearance) / sizeof(float))

GOE_STATIC_ASSERT(offsetof(goe_hazard_t, conflict_probability) + sizeof(float) == offsetof(goe_hazard_t, has_clearance),
                  the_numbers_of_a_hazard_come_first);

/* Returns GOE_OK, or why the intent is refused. */
static goe_status_t check_intent(const goe_intent_t *intent) {
    if (!goe_guard_finite(intent->velocity_ned_m_s, INTENT_NUMBERS)) {
        return GOE_NOT_FINITE;
    }
    const bool within = goe_largest_of_three(intent->velocity_ned_m_s) <= goe_magnitude(VELOCITY_MAX_M_S) &&
                        goe_between(intent->margin_m, 0.0f, DISTANCE_MAX_M) &&
                        goe_between(intent->clearance_m, 0.0f, DISTANCE_MAX_M) &&
                        goe_between(intent->since_image_s, 0.0f, SINCE_MAX_S) &&
                        goe_between(intent->velocity_sd_m_s, 0.0f, VELOCITY_SD_MAX_M_S);
    return within ? GOE_OK : GOE_OUT_OF_RANGE;
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
