/* Flipped bits of the estimator's memory: seal over the constant fields, and check of an estimate before it is returned.
 * SPDX-License-Identifier: MIT */
#ifndef GOE_GUARD_H
#define GOE_GUARD_H

#include "goe.h"

/* Seals mounting and settings. Call this when they are set; they must not change after that. */
void goe_guard_seal(goe_estimator_t *estimator);

/* Returns GOE_OK; GOE_NOT_INITIALIZED; or GOE_CORRUPTED, if mounting, settings or the mark that they are set have changed since
 * goe_guard_seal(). It detects every change of one word, and of two bits, except the same bit of two words that are 32 words apart. */
goe_status_t goe_guard_judge(const goe_estimator_t *estimator);

/* The same check; GOE_BAD_ARGUMENT for a null pointer. */
/*@ requires estimator == \null || \valid_read(estimator); */
static inline goe_status_t goe_guard_check(const goe_estimator_t *estimator) {
    return estimator ? goe_guard_judge(estimator) : GOE_BAD_ARGUMENT;
}

/* Whether all of `count` floats are finite. */
/*@ requires \valid_read(floats + (0 .. count - 1)); */
bool goe_guard_finite(const float *floats, size_t count);

/* Whether every number of an estimate is finite, and every enumeration, count and truth value is one that goe.h lists. */
bool goe_guard_estimate(const goe_estimate_t *estimate);

#endif
