/*
 * Random numbers that repeat: SplitMix64 (Steele, Lea, Flood 2014), a counter run through a mixing function.
 *
 * Every source of noise draws from a stream of its own, named by a number. Switching one source on or off, or drawing more
 * from it, therefore leaves all the others as they were. Integers and uniform numbers are the same on every machine;
 * normal numbers use log and cos and are as repeatable as the C library's.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#ifndef SIM_RANDOM_H
#define SIM_RANDOM_H

#include <stdint.h>

/* Streams in use. The numbers are part of what a seed means: never renumber, only append. */
enum {
    STREAM_TURBULENCE = 1,
    STREAM_PIXEL = 2,
    STREAM_DETECTOR = 3,
    STREAM_OUTLIER = 4,
    STREAM_ATTITUDE = 5,
    STREAM_POSITION = 6,
    STREAM_ALTIMETER = 7,
    STREAM_DROP = 8,
    STREAM_TIME = 9,
    STREAM_BOX_PIXEL = 10,
    STREAM_BOX_DETECTOR = 11,
    STREAM_BOX_OUTLIER = 12
};

typedef struct {
    uint64_t counter;
} random_t;

random_t random_start(uint64_t seed, uint64_t stream);
uint64_t random_bits(random_t *random);
double random_uniform(random_t *random); /* in [0, 1), 53 bits */
double random_normal(random_t *random);  /* mean 0, variance 1; draws two uniform numbers, always */

#endif
