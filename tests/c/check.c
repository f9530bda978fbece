/* Assertions and random numbers that the tests share. SPDX-License-Identifier: MIT */
#include "check.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define DEFAULT_SEED 20190601u

uint32_t check_bits(float x) {
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

float check_from_bits(uint32_t bits) {
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

bool check_is_finite(float x) { return (check_bits(x) & 0x7F800000u) != 0x7F800000u; }

float check_next_away(float x) { return check_from_bits(check_bits(x) + 1u); }

check_random_t check_random_start(const char *what) {
    const char *wanted = getenv("GOE_TEST_SEED");
    const uint64_t seed = wanted ? strtoul(wanted, NULL, 0) : DEFAULT_SEED;
    check_random_t random = {seed * 2654435761u + 88172645463325252u};
    UnityPrint(what);
    UnityPrint(": GOE_TEST_SEED=");
    UnityPrintNumberUnsigned((UNITY_UINT)seed);
    UNITY_PRINT_EOL();
    for (int i = 0; i < 8; i++) {
        (void)check_random_bits(&random);
    }
    return random;
}

uint32_t check_random_bits(check_random_t *random) { /* xorshift64* */
    uint64_t x = random->state;
    x ^= x >> 12;
    x ^= x << 25;
    x ^= x >> 27;
    random->state = x;
    return (uint32_t)((x * 2685821657736338717u) >> 32);
}

double check_random_between(check_random_t *random, double low, double high) {
    return low + (high - low) * ((double)check_random_bits(random) / 4294967295.0);
}

double check_random_normal(check_random_t *random) {
    const double radius = sqrt(-2.0 * log(((double)check_random_bits(random) + 1.0) / 4294967296.0));
    return radius * cos(check_random_between(random, 0.0, 6.283185307179586));
}

void check_report(const char *what, double value) {
    UnityPrint(what);
    UnityPrint(": ");
    UnityPrintFloat((UNITY_DOUBLE)value);
    UNITY_PRINT_EOL();
}

void check_worst(double *worst, double x) {
    const double magnitude = fabs(x);
    if (!(magnitude <= *worst)) {
        *worst = magnitude >= 0.0 ? magnitude : HUGE_VAL;
    }
}
