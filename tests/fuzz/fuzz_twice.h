/* The same bytes give the same bits, for any previous content of the memory. SPDX-License-Identifier: MIT */
#ifndef FUZZ_TWICE_H
#define FUZZ_TWICE_H

#include <stddef.h>
#include <stdint.h>

/* Flies an input over memory filled with `fill`. Returns a hash of all answers. */
typedef uint64_t fuzz_flown_t(const uint8_t *data, size_t size, int fill);

/* Flies an input. One in 32, selected by its hash, runs again over other memory: both hashes must be equal. fuzz_counts[counter] counts
 * these. */
void fuzz_twice(fuzz_flown_t *fly, const uint8_t *data, size_t size, int counter);

/* Increments fuzz_counts[what], except in a repeated run. */
void fuzz_count_once(int what);

#endif
