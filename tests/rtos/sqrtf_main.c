/* goe_sqrtf() in integers against this machine's sqrtf: every float of two octaves, every 97th of all others, and the special ones.
 * Other values of SPARSE and DENSE make it fewer, for slow machines. SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "goe_sqrtf.h"

#if defined(GOE_BARE_METAL)
#include "semihosting.h"
#else
#include <stdio.h>
#endif

#define OCTAVES_BEGIN 0x3F000000u /* 0.5 */
#define OCTAVES_END 0x40000000u   /* 2: even and odd exponents */
#define SMALL_END 0x00015000u     /* the first 86,016 floats */
#ifndef DENSE
#define DENSE 1u
#endif
#ifndef SPARSE
#define SPARSE 97u
#endif

static uint32_t bits_of(float number) {
    uint32_t bits;
    memcpy(&bits, &number, sizeof bits);
    return bits;
}

#if defined(GOE_BARE_METAL)

#define FEWEST 50000ul

static void report_wrong(uint32_t bits, float own, float right) {
    (void)bits;
    (void)own;
    (void)right;
}

static void report_all(unsigned long tried, int wrong) {
    port_write_text(wrong == 0 && tried > FEWEST ? "every root is right\n" : "wrong roots, or too few\n");
}

#else

static void report_wrong(uint32_t bits, float own, float right) {
    printf("%08x: %08x, not %08x\n", (unsigned)bits, (unsigned)bits_of(own), (unsigned)bits_of(right));
}

static void report_all(unsigned long tried, int wrong) { printf("%lu tried, %d wrong\n", tried, wrong); }

#endif

static int differs(uint32_t bits) {
    float square;
    memcpy(&square, &bits, sizeof square);
    const float own = goe_sqrtf(square);
    const float right = sqrtf(square);
    if (bits_of(own) == bits_of(right) || (isnan(own) && isnan(right))) {
        return 0;
    }
    report_wrong(bits, own, right);
    return 1;
}

/* Never past the start of the octaves. */
static uint64_t next_of(uint64_t bits) {
    const int dense = bits < SMALL_END || (bits >= OCTAVES_BEGIN && bits < OCTAVES_END);
    const uint64_t next = bits + (dense ? DENSE : SPARSE);
    return bits < OCTAVES_BEGIN && next > OCTAVES_BEGIN ? OCTAVES_BEGIN : next;
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
        bits = next_of(bits);
    }
    report_all(tried, wrong);
    return wrong != 0;
}
