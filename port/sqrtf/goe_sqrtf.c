/* The root bit by bit, in integers. SPDX-License-Identifier: MIT */
#include "goe_sqrtf.h"

#include <stdint.h>
#include <string.h>

#if defined(GOE_SQRTF_IN_INTEGERS)
#define IN_HARDWARE 0
#elif defined(__ARM_FP) && defined(__ARM_FEATURE_FMA)
#define IN_HARDWARE ((__ARM_FP & 4) != 0)
#elif defined(__riscv_fsqrt) || defined(__SSE2__) || defined(__aarch64__)
#define IN_HARDWARE 1
#else
#define IN_HARDWARE 0
#endif

#if IN_HARDWARE

float goe_sqrtf(float square) { return __builtin_sqrtf(square); }

#else

#define SIGN 0x80000000u
#define INFINITY_BITS 0x7F800000u
#define QUIET_NAN_BITS 0x7FC00000u
#define HIDDEN_BIT 0x00800000u
#define MANTISSA_BITS 23
#define BIAS 127

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
    if ((bits & ~SIGN) == 0u || bits == INFINITY_BITS) {
        return square;
    }
    if (bits > INFINITY_BITS) { /* NaN, or below 0 */
        return float_of(QUIET_NAN_BITS);
    }
    int exponent = (int)(bits >> MANTISSA_BITS);
    uint32_t mantissa = bits & (HIDDEN_BIT - 1u);
    if (exponent == 0) { /* subnormal */
        exponent = 1;
        while (mantissa < HIDDEN_BIT) {
            mantissa <<= 1;
            exponent--;
        }
    }
    mantissa |= HIDDEN_BIT;
    if (exponent % 2 == 0) { /* the power of two, exponent - BIAS, is odd */
        mantissa <<= 1;
        exponent--;
    }
    /* 25 bits, the last one to be rounded. Never half way: the root would be odd, and its square cannot end in 25 zeros. */
    const uint32_t rounded = (root_of(mantissa) + 1u) >> 1;
    const int half = (exponent - BIAS) / 2;                                    /* exact */
    return float_of(((uint32_t)(half + BIAS - 1) << MANTISSA_BITS) + rounded); /* the hidden bit counts one */
}

#endif
