/* Checks of every answer, for any input. SPDX-License-Identifier: MIT
 *
 * The checks use only bits and comparisons of finite numbers. Each ends the program on a violation. */
#ifndef ESTIMATE_CHECKS_H
#define ESTIMATE_CHECKS_H

#include "goe.h"

/* True for a status that goe_update() may return for an initialized estimator. Of these, check_is_refusal() covers the ones that change
 * nothing but counters and the time since the latest image taken. */
bool check_is_image_status(goe_status_t status);
bool check_is_refusal(goe_status_t status);

/* Checks an estimate of goe_update() and its status. */
void check_estimate(const goe_settings_t *settings, goe_status_t status, const goe_estimate_t *estimate);

/* Checks goe_covariance() of the estimator whose latest estimate this is. */
void check_covariance(const goe_estimator_t *estimator, const goe_estimate_t *estimate);

/* Checks its goe_hazard(); `legal`: the intent is within its ranges. */
void check_hazard(const goe_estimator_t *estimator, const goe_estimate_t *estimate, const goe_intent_t *intent,
                  bool legal);

/* A hash of all fields of an estimate. */
uint64_t check_hash(uint64_t hash, goe_status_t status, const goe_estimate_t *estimate);

#endif
