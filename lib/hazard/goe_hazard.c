/* goe_hazard(): the encounter of a planned flight with the obstacle. SPDX-License-Identifier: MIT */
#include <string.h>

#include "goe_guard.h"
#include "hazard/goe_conflict.h"
#include "maths/goe_scalar.h"

#if GOE_WITH_HAZARD

#define HAZARD_NUMBERS (offsetof(goe_hazard_t, has_clearance) / sizeof(float))

GOE_STATIC_ASSERT(offsetof(goe_hazard_t, conflict_probability) + sizeof(float) == offsetof(goe_hazard_t, has_clearance),
                  the_numbers_of_a_hazard_come_first);

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
        status = goe_conflict_check(intent);
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
