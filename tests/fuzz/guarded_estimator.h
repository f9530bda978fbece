/* An estimator and its answer, between guard bytes that no call may write. SPDX-License-Identifier: MIT */
#ifndef GUARDED_ESTIMATOR_H
#define GUARDED_ESTIMATOR_H

#include "goe.h"

#define GUARD_BYTES 64
#define GUARD 0xC3

typedef struct {
    unsigned char before[GUARD_BYTES];
    goe_estimator_t estimator;
    unsigned char between[GUARD_BYTES];
    goe_estimate_t estimate;
    unsigned char behind[GUARD_BYTES];
} guarded_estimator_t;

extern guarded_estimator_t memory;

/* Fills the estimator's bytes with `fill`, all others with GUARD. */
void guard_begin(int fill);

void guard_check(void);

#endif
