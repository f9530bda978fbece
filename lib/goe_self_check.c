/* Self-check: does the arithmetic contract, reorder, flush or misround? SPDX-License-Identifier: MIT
 *
 * Operands are read through volatile, so the compiler cannot evaluate the expressions itself. Then they are plain floats, which it may
 * transform as it transforms the rest of the library. */
#include <math.h>

#include "goe.h"
#include "maths/goe_scalar.h"

static bool same(float a, uint32_t bits) { return goe_bits(a) == bits; }

/* (1 + 2^-12)^2 - (1 + 2^-11) is exactly 2^-24, and 0 if the product is rounded first. */
static bool contracts(void) {
    volatile float probe_a = 1.000244140625f;
    volatile float probe_b = 1.00048828125f;
    const float a = probe_a;
    const float b = probe_b;
    return !same(a * a - b, 0u);
}

/* (2^25 + 1) - 2^25 is 0 in floats, and 1 if it is reordered. */
static bool reassociates(void) {
    volatile float probe_large = 33554432.0f;
    volatile float probe_one = 1.0f;
    const float large = probe_large;
    const float one = probe_one;
    return !same((large + one) - large, 0u);
}

#define QUOTIENTS 3
#define DIVISOR 41.0f

/* 5/d, 7/d and 11/d have one divisor: this invites the compiler to compute 1/d once, side by side or before a loop; for a constant d,
 * beforehand. With d = 41 all three quotients then differ. The bits are joined by |, not ||: a compiler that may skip a division does not
 * merge it with the others. */
static bool reciprocates(void) {
    static const uint32_t right[QUOTIENTS] = {0x3DF9C190u, 0x3E2ED44Bu, 0x3E895DA9u};
    volatile float probe_five = 5.0f;
    volatile float probe_seven = 7.0f;
    volatile float probe_eleven = 11.0f;
    volatile float probe_divisor = DIVISOR;
    volatile int probe_count = QUOTIENTS; /* the compiler must keep the loop */
    const float dividend[QUOTIENTS] = {probe_five, probe_seven, probe_eleven};
    const float divisor = probe_divisor;
    const int count = probe_count;
    const float first = dividend[0] / divisor;
    const float second = dividend[1] / divisor;
    const float third = dividend[2] / divisor;
    uint32_t off = (goe_bits(first) ^ right[0]) | (goe_bits(second) ^ right[1]) | (goe_bits(third) ^ right[2]);
    off |= goe_bits(dividend[0] / DIVISOR) ^ right[0];
    for (int k = 0; k < count; k++) {
        off |= goe_bits(dividend[k] / divisor) ^ right[k];
    }
    return off != 0u;
}

/* A vector unit may flush although the scalar unit does not (Helium always does). The loops below invite the compiler to use it. */
static bool flushes(void) {
    volatile float smallest_normal = 1.17549435e-38f;
    volatile float probe_half = 0.5f;
    const float half = probe_half;
    const float subnormal = smallest_normal * half;
    float values[8];
    uint32_t off = 0u;
    for (int k = 0; k < 8; k++) {
        values[k] = smallest_normal;
    }
    for (int k = 0; k < 8; k++) {
        values[k] *= half;
    }
    for (int k = 0; k < 8; k++) {
        off |= goe_bits(values[k]) ^ 0x00400000u;
    }
    return off != 0u || !same(subnormal, 0x00400000u) || !same(subnormal / half, 0x00800000u);
}

/* 1e38 * 10 overflows float, but not a wider register. In float, 1 + 2^-24 is rounded back to 1. */
static bool exceeds(void) {
    volatile float probe_large = 1.0e38f;
    volatile float probe_ten = 10.0f;
    volatile float probe_half_ulp = 5.9604645e-08f;
    const float large = probe_large;
    const float ten = probe_ten;
    const float half_ulp = probe_half_ulp;
    return goe_magnitude((large * ten) / ten) < GOE_INFINITY_BITS || !same((1.0f + half_ulp) + half_ulp, 0x3F800000u);
}

/* Ties are rounded to even: 1 + 2^-24 down, 1 + 3 2^-24 up, and negative numbers in the same way. */
static bool misrounds(void) {
    volatile float probe_tie_down = 5.9604645e-08f;
    volatile float probe_tie_up = 1.7881393e-07f;
    const float up = probe_tie_up;
    return !same(1.0f + probe_tie_down, 0x3F800000u) || !same(1.0f + up, 0x3F800002u) || !same(-1.0f - up, 0xBF800002u);
}

#define MANTISSA_BITS 23u
#define HIDDEN_BIT (1u << MANTISSA_BITS)
/* A float is mantissa * 2^(exponent field - 150). The hidden bit is one of the mantissa's 24 bits. */
#define EXPONENT_OFFSET 150u
#define ROOT_SHIFT_MAX 47u /* that of the smallest subnormal */

/* Let m 2^e have the root r 2^f, with whole mantissas. It is the nearest float exactly if r is the whole number nearest to the root of X =
 * m 2^(e - 2f): (r - 1/2)^2 < X < (r + 1/2)^2, that is r^2 - r < X <= r^2 + r. These numbers fit 64 bits. Without a sign, a number below 0
 * becomes too large. */
static bool root_is_nearest(uint32_t square_bits) {
    float square;
    memcpy(&square, &square_bits, sizeof square);
    volatile float probe = square;
    const uint32_t root_bits = goe_bits(sqrtf(probe));
    const bool subnormal = square_bits < HIDDEN_BIT;
    if (subnormal && root_bits == 0u) {
        return true; /* flushed, not misrounded */
    }
    const uint64_t m = (square_bits & (HIDDEN_BIT - 1u)) | (subnormal ? 0u : HIDDEN_BIT);
    const uint32_t r = (root_bits & (HIDDEN_BIT - 1u)) | HIDDEN_BIT;
    const uint32_t e = subnormal ? 1u : square_bits >> MANTISSA_BITS;
    const uint32_t shift = e + EXPONENT_OFFSET - 2u * (root_bits >> MANTISSA_BITS);
    return shift <= ROOT_SHIFT_MAX && (m << shift) - (uint64_t)r * (r - 1u) - 1u < 2u * r;
}

/* Spread over all exponents, odd and even; the first are subnormal. If a quarter of all roots is wrong, 32 arguments miss it with a
 * probability of 1e-4. */
#define ROOTS 32u
#define ROOT_FIRST 0x00000001u
#define ROOT_STEP 0x03FA5A5Bu /* ROOT_FIRST + (ROOTS - 1) ROOT_STEP is below infinity */
#define ROOT_SUBNORMAL 0x00512345u

static bool misroots(void) {
    bool nearest = root_is_nearest(ROOT_SUBNORMAL);
    for (uint32_t k = 0; k < ROOTS; k++) {
        nearest = root_is_nearest(ROOT_FIRST + k * ROOT_STEP) && nearest;
    }
    return !nearest;
}

unsigned goe_self_check(void) {
    return (contracts() ? GOE_SELF_CONTRACTED : 0u) | (reassociates() ? GOE_SELF_REASSOCIATED : 0u) |
           (reciprocates() ? GOE_SELF_RECIPROCAL : 0u) | (flushes() ? GOE_SELF_FLUSHED : 0u) |
           (exceeds() ? GOE_SELF_EXCESS : 0u) | (misrounds() || misroots() ? GOE_SELF_ROUNDING : 0u);
}
