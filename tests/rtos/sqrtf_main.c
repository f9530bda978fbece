/* goe_sqrtf() in integers against this machine's sqrtf: every float of two octaves, every 97th of all others, and the special ones.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "goe_sqrtf.h"

#define OCTAVES_BEGIN 0x3F000000u /* 0.5 */
#define OCTAVES_END 0x40000000u   /* 2: even and odd exponents */
#define SUBNORMAL_END 0x00800000u
#define STEP 97u

static uint32_t bits_of(float number) {
    uint32_t bits;
    memcpy(&bits, &number, sizeof bits);
    return bits;
}

static int differs(uint32_t bits) {
    float square;
    memcpy(&square, &bits, sizeof square);
    const float own = goe_sqrtf(square);
    const float right = sqrtf(square);
    if (bits_of(own) == bits_of(right) || (isnan(own) && isnan(right))) {
        return 0;
    }
    printf("%08x: %08x, not %08x\n", (unsigned)bits, (unsigned)bits_of(own), (unsigned)bits_of(right));
    return 1;
}

int main(void) {
    const uint32_t special[] = {0u,          1u,          2u,          0x007FFFFFu, 0x00800000u,
                                0x7F7FFFFFu, 0x7F800000u, 0x7F800001u, 0x7FC00000u, 0x80000000u,
                                0x80000001u, 0xBF800000u, 0xFF800000u, 0xFFC00000u};
    unsigned long tried = 0;
    int wrong = 0;
    for (size_t i = 0; i < sizeof special / sizeof special[0]; i++, tried++) {
        wrong += differs(special[i]);
    }
    for (uint64_t bits = 0; bits <= UINT32_MAX && wrong < 10; tried++) {
        wrong += differs((uint32_t)bits);
        bits += (bits >= OCTAVES_BEGIN && bits < OCTAVES_END) || bits < SUBNORMAL_END / STEP ? 1u : STEP;
    }
    printf("%lu tried, %d wrong\n", tried, wrong);
    return wrong != 0;
}
