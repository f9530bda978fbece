/* Scalars: magnitudes and comparisons by the bits of floats, truth values. SPDX-License-Identifier: MIT */
#ifndef GOE_SCALAR_H
#define GOE_SCALAR_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#define GOE_MAGNITUDE_BITS 0x7FFFFFFFu /* all but the sign */
#define GOE_INFINITY_BITS 0x7F800000u  /* this magnitude or a larger one is an infinity or a NaN */

static inline uint32_t goe_bits(float x) {
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

/* The same for a float in memory, without a detour through a floating-point register. */
static inline uint32_t goe_bits_at(const float *at) {
    uint32_t bits;
    memcpy(&bits, at, sizeof bits);
    return bits;
}

/* Bits of |x|. They have the same order as the magnitudes. Unlike isfinite() or a comparison with NaN, the compiler cannot assume their
 * meaning away under -ffast-math. */
static inline uint32_t goe_magnitude(float x) { return goe_bits(x) & GOE_MAGNITUDE_BITS; }

static inline uint32_t goe_larger_bits(uint32_t a, uint32_t b) { return a > b ? a : b; }

/* The largest magnitude of a vector's elements. */
static inline uint32_t goe_largest_of_three(const float v[3]) {
    return goe_larger_bits(goe_larger_bits(goe_magnitude(v[0]), goe_magnitude(v[1])), goe_magnitude(v[2]));
}

/* |x|. Not fabsf(): a C library may lack it, and an undeclared call would then return an int. */
static inline float goe_absolute(float x) {
#if defined(__GNUC__)
    return __builtin_fabsf(x); /* one instruction, never a call */
#else
    const uint32_t bits = goe_magnitude(x);
    float magnitude;
    memcpy(&magnitude, &bits, sizeof magnitude);
    return magnitude;
#endif
}

/* |x| <= limit; false for NaN and infinity. */
static inline bool goe_within(float x, float limit) { return goe_magnitude(x) <= goe_magnitude(limit); }

/* For a finite x: least <= x <= most. */
static inline bool goe_between(float x, float least, float most) { return x >= least && x <= most; }

static inline float goe_larger(float a, float b) { return a > b ? a : b; }

/* Whether a truth value from outside is set. A byte that is neither 0 nor 1 counts as set; as a bool it would be undefined. */
static inline bool goe_is_set(const bool *truth) { return *(const unsigned char *)truth != 0u; }

static inline float goe_square(float x) { return x * x; }

#endif
