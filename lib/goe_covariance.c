/* Covariance. SPDX-License-Identifier: MIT */
#include "goe_covariance.h"

#include <string.h>

#include "goe_guard.h"
#include "maths/goe_angle.h"
#include "maths/goe_scalar.h"
#include "refined/goe_ground.h"
#include "refined/goe_quantities.h"

/*@ requires \valid_read(sigma) && \valid(covariance + (0 .. GOE_QUANTITIES - 1)); */
static void covariance_of_sigmas(const goe_sigma_t *sigma, goe_covariance_t covariance) {
    const float of[GOE_QUANTITIES] = {sigma->x0_m,    sigma->z0_m,     sigma->orientation_deg,
                                      sigma->width_m, sigma->length_m, sigma->height_m};
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        covariance[i][i] = of[i] * of[i];
    }
}

#if GOE_WITH_REFINED
/* The filter is as it was when it gave the estimate; it may be another's since. */
/*@ requires \valid_read(estimate); */
static bool is_of_filter(const goe_estimate_t *estimate) {
    return estimate->method == GOE_METHOD_REFINED && goe_is_set(&estimate->fresh);
}

static const unsigned bit_of[GOE_QUANTITIES] = {GOE_HAS_POSITION, GOE_HAS_POSITION, GOE_HAS_ORIENTATION,
                                                GOE_HAS_WIDTH,    GOE_HAS_LENGTH,   GOE_HAS_HEIGHT};

/*@ requires \valid(covariance + (0 .. GOE_QUANTITIES - 1)); */
static void keep_valid(unsigned valid, goe_covariance_t covariance) {
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        for (int j = 0; j < GOE_QUANTITIES; j++) {
            const float scale =
                (i == GOE_ORIENTATION ? GOE_DEG_PER_RAD : 1.0f) * (j == GOE_ORIENTATION ? GOE_DEG_PER_RAD : 1.0f);
            const bool known = (valid & bit_of[i]) && (valid & bit_of[j]);
            covariance[i][j] = known ? covariance[i][j] * scale : 0.0f;
        }
    }
}

/* False if the estimate is not the filter's. */
/*@ requires \valid_read(estimator) && \valid(covariance + (0 .. GOE_QUANTITIES - 1)); */
static bool covariance_of_filter(const goe_estimator_t *estimator, bool from_datum, float ahead_s,
                                 goe_covariance_t covariance) {
    const goe_estimate_t *estimate = &estimator->estimate;
    if (!is_of_filter(estimate)) {
        return false;
    }
    goe_quantities_covariance(&estimator->filter, &estimator->settings, &estimator->motion, from_datum, ahead_s,
                              covariance);
    keep_valid(estimate->valid, covariance);
    return true;
}

/*@ requires \valid_read(estimator); */
static bool is_steady(const goe_estimator_t *estimator) {
    return is_of_filter(&estimator->estimate) &&
           goe_ground_is_steady(&estimator->filter, &estimator->settings.navigation);
}

float goe_latest_camera_height(const goe_estimator_t *estimator) {
    return is_steady(estimator) ? estimator->filter.datum.height_m : estimator->motion.height_m;
}

float goe_latest_height_bias(const goe_estimator_t *estimator) {
    const float *state = estimator->filter.state;
    return is_of_filter(&estimator->estimate) ? state[GOE_GROUND] / state[GOE_INVERSE_RANGE] : 0.0f;
}
float goe_latest_reach(const goe_estimator_t *estimator) {
    const goe_filter_t *filter = &estimator->filter;
    const float *x = filter->state;
    if (!is_of_filter(&estimator->estimate)) {
        return 0.0f;
    }
    if (filter->phase == GOE_PHASE_PRISM) {
        return x[GOE_PRISM_HALF] / x[GOE_INVERSE_RANGE];
    }
    const float side = goe_filter_is_box(filter) ? goe_absolute(x[GOE_SIDE_X]) : 0.0f;
    return 0.5f * (x[GOE_FRONT_X] + side) / x[GOE_INVERSE_RANGE];
}
#else
/*@ requires \valid_read(estimator) && \valid(covariance + (0 .. GOE_QUANTITIES - 1)); */
static bool covariance_of_filter(const goe_estimator_t *estimator, bool from_datum, float ahead_s,
                                 goe_covariance_t covariance) {
    (void)estimator;
    (void)from_datum;
    (void)ahead_s;
    (void)covariance;
    return false;
}

float goe_latest_camera_height(const goe_estimator_t *estimator) { return estimator->motion.height_m; }

float goe_latest_height_bias(const goe_estimator_t *estimator) {
    (void)estimator;
    return 0.0f;
}

float goe_latest_reach(const goe_estimator_t *estimator) {
    (void)estimator;
    return 0.0f;
}
#endif

goe_status_t goe_latest_covariance(const goe_estimator_t *estimator, bool from_datum, float ahead_s,
                                   goe_covariance_t covariance) {
    memset(covariance, 0, sizeof(goe_covariance_t));
    const goe_estimate_t *estimate = &estimator->estimate;
    if (!(estimate->valid & GOE_HAS_POSITION)) {
        return GOE_COLLECTING;
    }
    if (!covariance_of_filter(estimator, from_datum, ahead_s, covariance)) {
        const float age_s = goe_latest_since_s(estimator, estimator->motion.time_us);
        const float grown_m2 = goe_latest_grown_m2(estimate, age_s + ahead_s);
        covariance_of_sigmas(&estimate->sigma, covariance);
        covariance[GOE_X0][GOE_X0] += grown_m2;
        covariance[GOE_Z0][GOE_Z0] += grown_m2;
    }
    return GOE_OK;
}

goe_status_t goe_covariance(const goe_estimator_t *estimator, float covariance[GOE_QUANTITIES][GOE_QUANTITIES]) {
    if (!covariance) {
        return GOE_BAD_ARGUMENT;
    }
    goe_status_t status = goe_guard_check(estimator);
    if (status == GOE_OK) {
        status = goe_latest_covariance(estimator, false, 0.0f, covariance);
    }
    if (status == GOE_OK && !goe_guard_finite(&covariance[0][0], GOE_QUANTITIES * GOE_QUANTITIES)) {
        status = GOE_CORRUPTED;
    }
    if (status != GOE_OK) {
        memset(covariance, 0, sizeof(goe_covariance_t));
    }
    return status;
}
