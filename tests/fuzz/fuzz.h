/* What every target of fuzzing has, and what it leans on. SPDX-License-Identifier: MIT
 *
 * A target is one function over bytes, fuzz_<target>.c; it ends the program where something does not hold. libFuzzer brings a main()
 * of its own, any other compiler takes fuzz_main.c. */
#ifndef FUZZ_H
#define FUZZ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Takes any bytes; returns 0. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* What a target counts, the first its measure of work. A null name ends them. */
typedef struct {
    const char *name;
    uint64_t times;
} fuzz_count_t;

extern fuzz_count_t fuzz_counts[];

/* Ends the program unless `condition` holds. */
#define FUZZ_HOLDS(condition) ((condition) ? (void)0 : fuzz_broken(__FILE__, __LINE__, #condition))

/* memcmp() == 0, of structures too: their padding may hold anything, which MemorySanitizer is not to be told. */
bool fuzz_same(const void *a, const void *b, size_t size);

void fuzz_broken(const char *file, int line, const char *what) __attribute__((noreturn));

#endif
