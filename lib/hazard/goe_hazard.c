/* What a planned flight will meet: the public call. SPDX-License-Identifier: MIT */
#include <string.h>

#include "hazard/goe_violation.h"
#include "maths/goe_scalar.h"

#if GOE_WITH_HAZARD

#define VELOCITY_MOST_M_S 1.0e3f
#define DISTANCE_MOST_M 1.0e4f

static goe_status_t check_plan(const goe_plan_t *plan) {
    bool finite =
        goe_magnitude(plan->margin_m) < GOE_INFINITY_BITS && goe_magnitude(plan->clearance_m) < GOE_INFINITY_BITS;
    bool within = goe_within(plan->margin_m, DISTANCE_MOST_M) && goe_within(plan->clearance_m, DISTANCE_MOST_M);
    for (int i = 0; i < 3; i++) {
        finite = finite && goe_magnitude(plan->velocity_ned_m_s[i]) < GOE_INFINITY_BITS;
        within = within && goe_within(plan->velocity_ned_m_s[i], VELOCITY_MOST_M_S);
    }
    if (!finite) {
        return GOE_NOT_FINITE;
    }
    return within && plan->margin_m >= 0.0f && plan->clearance_m >= 0.0f ? GOE_OK : GOE_OUT_OF_RANGE;
}

goe_status_t goe_hazard(const goe_estimator_t *estimator, const goe_plan_t *plan, goe_hazard_t *hazard) {
    goe_covariance_t covariance;
    if (!hazard) {
        return GOE_BAD_ARGUMENT;
    }
    memset(hazard, 0, sizeof *hazard);
    if (!estimator || !plan) {
        return GOE_BAD_ARGUMENT;
    }
    if (estimator->ready != GOE_READY) {
        return GOE_NOT_INITIALISED;
    }
    const goe_status_t status = check_plan(plan);
    if (status != GOE_OK) {
        return status;
    }
    const goe_estimate_t *estimate = goe_latest_estimate(estimator);
    if (!(estimate->valid & GOE_HAS_POSITION)) {
        return GOE_COLLECTING;
    }
    goe_latest_covariance(estimator, true, covariance);
    goe_violation_foresee(estimator, plan, covariance, hazard);
    return GOE_OK;
}

#endif
