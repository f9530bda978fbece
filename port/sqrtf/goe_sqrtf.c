/* The root bit by bit, in integers. SPDX-License-Identifier: MIT */
#include "goe_sqrtf.h"

#include <stdint.h>
#include <string.h>

#if GOE_SQRTF_IS_INSTRUCTION

/* For callers that do not see the one in goe_sqrtf.h. */
float goe_sqrtf(float square) { return __builtin_sqrtf(square); }

#else

#define SQRTF_SIGN 0x80000000u
#define SQRTF_INFINITY 0x7F800000u
#define SQRTF_QUIET_NAN 0x7FC00000u
#define SQRTF_HIDDEN_BIT 0x00800000u
#define SQRTF_MANTISSA_BITS 23
#define SQRTF_BIAS 127

static float float_of(uint32_t bits) {
    float number;
    memcpy(&number, &bits, sizeof number);
    return number;
}

/* Root of m * 2^25, rounded down; 2^23 <= m < 2^25. Two bits of the square come down at each step. */
static uint32_t root_of(uint32_t m) {
    uint32_t root = 0;
    uint32_t rest = 0;
    m <<= 7;
    for (int step = 0; step < 25; step++) {
        rest = (rest << 2) | (m >> 30);
        m <<= 2;
        const uint32_t trial = (root << 2) | 1u;
        root <<= 1;
        if (rest >= trial) {
            rest -= trial;
            root |= 1u;
        }
    }
    return root;
}

float goe_sqrtf(float square) {
    uint32_t bits;
    memcpy(&bits, &square, sizeof bits);
    if ((bits & ~SQRTF_SIGN) == 0u || bits == SQRTF_INFINITY) {
        return square;
    }
    if (bits > SQRTF_INFINITY) { /* NaN, or below 0 */
        return float_of(SQRTF_QUIET_NAN);
    }
    int exponent = (int)(bits >> SQRTF_MANTISSA_BITS);
    uint32_t mantissa = bits & (SQRTF_HIDDEN_BIT - 1u);
    if (exponent == 0) { /* subnormal */
        exponent = 1;
        while (mantissa < SQRTF_HIDDEN_BIT) {
            mantissa <<= 1;
            exponent--;
        }
    }
    mantissa |= SQRTF_HIDDEN_BIT;
    if (exponent % 2 == 0) { /* the power of two, exponent - SQRTF_BIAS, is odd */
        mantissa <<= 1;
        exponent--;
    }
    /* 25 bits, the last one to be rounded. Never half way: the root would be odd, and its square cannot end in 25 zeros. */
    const uint32_t rounded = (root_of(mantissa) + 1u) >> 1;
    const int half = (exponent - SQRTF_BIAS) / 2;             /* exact */
    const uint32_t power = (uint32_t)(half + SQRTF_BIAS - 1); /* the hidden bit counts one */
    return float_of((power << SQRTF_MANTISSA_BITS) + rounded);
}

#endif
