/* What a planned flight will meet: the public call. SPDX-License-Identifier: MIT */
#include <string.h>

#include "goe_told.h"
#include "hazard/goe_approach.h"
#include "maths/goe_scalar.h"
#include "refined/goe_observation.h"

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

/* The camera above the top now. The told height is off by a constant that the refined answer's height above the ground
 * has been freed from, and the camera's has not. */
static float height_over_top(const goe_estimator_t *estimator, const goe_estimate_t *estimate) {
    const bool of_filter = estimate->method == GOE_METHOD_REFINED && estimate->fresh; /* it may be another's since */
    const float datum_m = of_filter ? estimator->filter.state[GOE_DH] : 0.0f;
    return estimator->height_m - (estimate->height_m - datum_m);
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
    const goe_estimate_t *estimate = goe_told(estimator);
    if (!(estimate->valid & GOE_HAS_POSITION)) {
        return GOE_COLLECTING;
    }
    goe_told_covariance(estimator, GOE_FROM_DATUM, covariance);
    goe_approach_foresee(estimator, plan, height_over_top(estimator, estimate), covariance, hazard);
    return GOE_OK;
}
