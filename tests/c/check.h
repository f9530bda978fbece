/* Assertions and random numbers that the tests share. SPDX-License-Identifier: MIT */
#ifndef CHECK_H
#define CHECK_H

#include <stdbool.h>
#include <stdint.h>
#include <unity.h>

#include "goe.h"

/* |actual - expected| <= tolerance, the difference taken in double. Never true for a NaN. */
#define CHECK_CLOSE(tolerance, expected, actual)                                                                       \
    TEST_ASSERT_FLOAT_WITHIN((float)(tolerance), 0.0f, (float)((double)(actual) - (double)(expected)))

#define CHECK_STATUS(expected, actual) TEST_ASSERT_EQUAL_STRING(goe_status_text(expected), goe_status_text(actual))

/* Identical bits. */
#define CHECK_SAME(expected, actual) TEST_ASSERT_EQUAL_HEX32(check_bits(expected), check_bits(actual))

uint32_t check_bits(float x);
float check_from_bits(uint32_t bits);

/* Not NaN, not infinite, judged by the exponent bits: also in a program that is linked with -ffast-math. */
bool check_is_finite(float x);

/* The float next to x that is farther from zero. */
float check_next_away(float x);

/* Random numbers: the same sequence on every machine. The seed is printed; GOE_TEST_SEED in the environment sets it. */
typedef struct {
    uint64_t state;
} check_random_t;

check_random_t check_random_start(const char *what);
uint32_t check_random_bits(check_random_t *random);
double check_random_between(check_random_t *random, double low, double high);
double check_random_normal(check_random_t *random); /* mean 0, sigma 1 */

/* Prints "what: value", for figures that a limit of a test is judged by. */
void check_report(const char *what, double value);

/* *worst = max(*worst, |x|). A NaN makes it infinite. */
void check_worst(double *worst, double x);

#endif
