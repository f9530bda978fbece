/* What must hold of every answer, whatever came in. SPDX-License-Identifier: MIT
 *
 * Told by bits and by comparisons of finite numbers alone. Each ends the program where something does not hold. */
#ifndef ESTIMATE_CHECKS_H
#define ESTIMATE_CHECKS_H

#include "goe.h"

/* A status that goe_update() may return of an initialised estimator; of these the ones that changed nothing but counters. */
bool check_is_image_status(goe_status_t status);
bool check_is_refusal(goe_status_t status);

/* An estimate of goe_update(), and its status. */
void check_estimate(const goe_settings_t *settings, goe_status_t status, const goe_estimate_t *estimate);

/* goe_covariance() of the estimator whose latest estimate that is. */
void check_covariance(const goe_estimator_t *estimator, const goe_estimate_t *estimate);

/* goe_hazard() of it; `legal`: the plan lies within its ranges. */
void check_hazard(const goe_estimator_t *estimator, const goe_estimate_t *estimate, const goe_plan_t *plan, bool legal);

/* All that an estimate tells, as one number. */
uint64_t check_hash(uint64_t hash, goe_status_t status, const goe_estimate_t *estimate);

#endif
