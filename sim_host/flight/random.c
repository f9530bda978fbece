/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "random.h"

#include <math.h>

#include "rotation.h"

#define GOLDEN_GAMMA UINT64_C(0x9E3779B97F4A7C15) /* 2^64 / golden ratio, odd: the counter visits every number */

static uint64_t mix(uint64_t z) {
    z = (z ^ (z >> 30)) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94D049BB133111EB);
    return z ^ (z >> 31);
}

random_t random_start(uint64_t seed, uint64_t stream) {
    random_t random = {mix(mix(seed + GOLDEN_GAMMA) + stream * GOLDEN_GAMMA)};
    return random;
}

uint64_t random_bits(random_t *random) {
    random->counter += GOLDEN_GAMMA;
    return mix(random->counter);
}

double random_uniform(random_t *random) { return (double)(random_bits(random) >> 11) * 0x1p-53; }

double random_normal(random_t *random) {
    const double radius = sqrt(-2.0 * log(1.0 - random_uniform(random))); /* 1 - u lies in (0, 1] */
    return radius * cos(2.0 * SIM_PI * random_uniform(random));
}
