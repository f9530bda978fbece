/* The same bytes give the same bits, for any previous content of the memory. SPDX-License-Identifier: MIT */
#include "fuzz_twice.h"

#include "fuzz.h"

#define TWICE_IN 32u /* inputs of which one runs twice */
#define OTHER_FILL 0xA5

static bool is_repeat;

void fuzz_count_once(int what) { fuzz_counts[what].times += is_repeat ? 0u : 1u; }

void fuzz_twice(fuzz_flown_t *fly, const uint8_t *data, size_t size, int counter) {
    is_repeat = false;
    const uint64_t hash = fly(data, size, 0);
    if ((hash >> 32) % TWICE_IN == 0) {
        fuzz_count_once(counter);
        is_repeat = true;
        FUZZ_CHECK(fly(data, size, OTHER_FILL) == hash);
    }
}
