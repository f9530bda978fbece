/* Common parts of all fuzzing targets. SPDX-License-Identifier: MIT
 *
 * A target is one function over bytes, fuzz_<target>.c; it ends the program on a violation. libFuzzer has its own main(); with any other
 * compiler fuzz_main.c provides it. */
#ifndef FUZZ_H
#define FUZZ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Takes any bytes; returns 0. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Counters of a target; the first one measures its work. A null name ends them. */
typedef struct {
    const char *name;
    uint64_t times;
} fuzz_count_t;

extern fuzz_count_t fuzz_counts[];

/* Ends the program unless `condition` is true. */
#define FUZZ_CHECK(condition) ((condition) ? (void)0 : fuzz_broken(__FILE__, __LINE__, #condition))

/* memcmp() == 0, also for structures, whose padding may contain any bits; MemorySanitizer must not see that. */
bool fuzz_same(const void *a, const void *b, size_t size);

void fuzz_broken(const char *file, int line, const char *what) __attribute__((noreturn));

#endif
