/* An estimator and its answer, between guard bytes that no call may write. SPDX-License-Identifier: MIT */
#include "guarded_estimator.h"

#include <string.h>

#include "fuzz.h"

guarded_estimator_t memory;

static unsigned char guard[GUARD_BYTES];

void guard_begin(int fill) {
    memset(guard, GUARD, sizeof guard);
    memset(&memory, GUARD, sizeof memory);
    memset(&memory.estimator, fill, sizeof memory.estimator);
}

void guard_check(void) {
    FUZZ_CHECK(fuzz_same(memory.before, guard, GUARD_BYTES));
    FUZZ_CHECK(fuzz_same(memory.between, guard, GUARD_BYTES));
    FUZZ_CHECK(fuzz_same(memory.behind, guard, GUARD_BYTES));
}
