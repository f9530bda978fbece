/* Included before everything else (-include), this turns the library into the same filter in float64. For
 * the host's tests and tools only: it shows how much of an answer is the rounding of floats. SPDX-License-Identifier: MIT
 *
 * Constants stay floats, as in the library itself: what differs is the arithmetic and nothing else. The functions of
 * goe_scalar.h, which look at a float's bits, are given here for doubles, and its include guard is taken. */
#ifndef GOE_DOUBLE_PRECISION_H
#define GOE_DOUBLE_PRECISION_H

#include <float.h> /* standard headers come first: they must not see the macros below */
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define GOE_SCALAR_H
#define GOE_MAGNITUDE_BITS 0x7FFFFFFFu
#define GOE_INFINITY_BITS 0x7F800000u

/* Bits of x as a float: infinities and NaN stay as they are, and a value beyond any float counts as infinite. */
static inline uint32_t goe_bits(double x) {
    const float single = (float)x;
    uint32_t bits;
    memcpy(&bits, &single, sizeof bits);
    return bits;
}

static inline uint32_t goe_bits_at(const double *at) { return goe_bits(*at); }

static inline bool goe_is_set(const bool *truth) { return *(const unsigned char *)truth != 0u; }

static inline uint32_t goe_magnitude(double x) { return goe_bits(x) & GOE_MAGNITUDE_BITS; }

static inline uint32_t goe_larger_bits(uint32_t a, uint32_t b) { return a > b ? a : b; }

static inline uint32_t goe_largest_of_three(const double v[3]) {
    return goe_larger_bits(goe_larger_bits(goe_magnitude(v[0]), goe_magnitude(v[1])), goe_magnitude(v[2]));
}

static inline double goe_absolute(double x) { return fabs(x); }

static inline bool goe_within(double x, double limit) { return fabs(x) <= fabs(limit) && isfinite(x); }

static inline bool goe_between(double x, double least, double most) { return x >= least && x <= most; }

static inline double goe_larger(double a, double b) { return a > b ? a : b; }

static inline double goe_square(double x) { return x * x; }

#define float double
#define sqrtf sqrt
#define fabsf fabs

#endif /* GOE_DOUBLE_PRECISION_H */
