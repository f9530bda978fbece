/* The same bytes give the same bits, whatever the memory held before. SPDX-License-Identifier: MIT */
#ifndef FUZZ_TWICE_H
#define FUZZ_TWICE_H

#include <stddef.h>
#include <stdint.h>

/* Flies an input over memory that holds `fill`; a hash of all answers. */
typedef uint64_t fuzz_flown_t(const uint8_t *data, size_t size, int fill);

/* Flies an input; one in 32, as its hash has it, once more over other memory: the hash must be the same. fuzz_counts[counter] has how
 * many. */
void fuzz_twice(fuzz_flown_t *fly, const uint8_t *data, size_t size, int counter);

/* One more of fuzz_counts[what], unless the input runs once more. */
void fuzz_count_once(int what);

#endif
