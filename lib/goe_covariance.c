/* The covariance of the latest estimate. SPDX-License-Identifier: MIT */
#include "goe_covariance.h"

#include <string.h>

#include "goe_guard.h"
#include "maths/goe_angle.h"
#include "maths/goe_scalar.h"
#include "refined/goe_quantities.h"

#define LOST_CORRELATION 2.0f

/* No variance is smaller than that of the reported sigma. now: the position's sigma is that relative to the present camera. */
static void keep_at_least(const goe_sigma_t *sigma, bool now, goe_covariance_t covariance) {
    const float least[GOE_QUANTITIES] = {now ? sigma->x_m : sigma->x0_m,
                                         now ? sigma->z_m : sigma->z0_m,
                                         sigma->orientation_deg,
                                         sigma->width_m,
                                         sigma->length_m,
                                         sigma->height_m};
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        covariance[i][i] = goe_larger(covariance[i][i], least[i] * least[i]);
    }
}

#if GOE_WITH_FILTER
static const uint8_t bit_of[GOE_QUANTITIES] = {GOE_HAS_POSITION, GOE_HAS_POSITION, GOE_HAS_ORIENTATION,
                                               GOE_HAS_WIDTH,    GOE_HAS_LENGTH,   GOE_HAS_HEIGHT};

/* Factor of a quantity's row and column: its unit, or 0 if it is not known. */
static float factor_of(unsigned known, int i) {
    const float unit = i == GOE_ORIENTATION ? GOE_DEG_PER_RAD : 1.0f;
    return (known & bit_of[i]) != 0u ? unit : 0.0f;
}

static void keep_known(unsigned known, goe_covariance_t covariance) {
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        for (int j = 0; j < GOE_QUANTITIES; j++) {
            const float factor = factor_of(known, i) * factor_of(known, j);
            covariance[i][j] = factor > 0.0f ? covariance[i][j] * factor : 0.0f;
        }
    }
}

/* Returns false if the estimate is not the filter's, or if the state has changed since, other than by time. An image without a detection
 * changes only the time. */
static bool covariance_of_filter(const goe_estimator_t *estimator, bool for_hazard, float ahead_s,
                                 goe_covariance_t covariance) {
    if (!goe_latest_by_filter(estimator) || estimator->filter.answer.outdated) {
        return false;
    }
    goe_quantities_covariance(&estimator->filter, &estimator->settings, &estimator->motion, for_hazard, ahead_s,
                              covariance);
    /* The hazard counts the width of an obstacle that the border cuts, even if it is not known: its far end may be anywhere. */
    const bool open = for_hazard && estimator->filter.answer.cut != 0u;
    keep_known(estimator->estimate.valid | (open ? GOE_HAS_WIDTH : 0u), covariance);
    if (!for_hazard && !goe_is_set(&estimator->estimate.fresh)) { /* whatever path was flown since */
        keep_at_least(&estimator->estimate.sigma, true, covariance);
    }
    return true;
}
#else
static bool covariance_of_filter(const goe_estimator_t *estimator, bool for_hazard, float ahead_s,
                                 goe_covariance_t covariance) {
    (void)estimator;
    (void)for_hazard;
    (void)ahead_s;
    (void)covariance;
    return false;
}
#endif

/* For an estimate that the filter no longer contains: its squared sigmas, and their growth with age. The correlations are lost. For a
 * hazard, doubled variances cover two fully correlated errors. */
static void covariance_of_answer(const goe_estimator_t *estimator, bool for_hazard, float ahead_s,
                                 goe_covariance_t covariance) {
    const bool lost = for_hazard && goe_latest_by_filter(estimator);
    const float age_s = goe_latest_since_s(estimator, estimator->motion.time_us);
    const float moving_s = (estimator->estimate.valid & GOE_HAS_VELOCITY) != 0u ? ahead_s : 0.0f;
    const float grown_m2 = goe_latest_grown_m2(estimator, age_s + moving_s);
    keep_at_least(&estimator->estimate.sigma, false, covariance); /* all 0 so far */
    for (int i = 0; lost && i < GOE_QUANTITIES; i++) {
        covariance[i][i] *= LOST_CORRELATION;
    }
    covariance[GOE_X0][GOE_X0] += grown_m2;
    covariance[GOE_Z0][GOE_Z0] += grown_m2;
}

goe_status_t goe_covariance_ahead(const goe_estimator_t *estimator, bool for_hazard, float ahead_s,
                                  goe_covariance_t covariance) {
    memset(covariance, 0, sizeof(goe_covariance_t));
    if (!(estimator->estimate.valid & GOE_HAS_POSITION)) {
        return GOE_CONVERGING;
    }
    if (!covariance_of_filter(estimator, for_hazard, ahead_s, covariance)) {
        covariance_of_answer(estimator, for_hazard, ahead_s, covariance);
    }
    return GOE_OK;
}

goe_status_t goe_covariance(const goe_estimator_t *estimator, float covariance[GOE_QUANTITIES][GOE_QUANTITIES]) {
    if (!covariance) {
        return GOE_BAD_ARGUMENT;
    }
    goe_status_t status = goe_guard_check(estimator);
    if (status == GOE_OK) {
        status = goe_covariance_ahead(estimator, false, 0.0f, covariance);
    }
    if (status == GOE_OK && !goe_guard_finite(&covariance[0][0], GOE_QUANTITIES * GOE_QUANTITIES)) {
        status = GOE_CORRUPTED;
    }
    if (status != GOE_OK) {
        memset(covariance, 0, sizeof(goe_covariance_t));
    }
    return status;
}
