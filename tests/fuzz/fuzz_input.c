/* Decisions and numbers from a fuzzer's bytes. SPDX-License-Identifier: MIT */
#include "fuzz_input.h"

#include <stdio.h>
#include <stdlib.h>

#include "fuzz.h"

void fuzz_broken(const char *file, int line, const char *what) {
    (void)fprintf(stderr, "%s:%d: failed: %s\n", file, line, what);
    abort();
}

#if defined(__has_feature)
#if __has_feature(memory_sanitizer)
#include <sanitizer/msan_interface.h>
#define LARGEST 65536u

static unsigned char copies[2][LARGEST];
#endif
#endif

bool fuzz_same(const void *a, const void *b, size_t size) {
#ifdef LARGEST
    FUZZ_CHECK(size <= LARGEST);
    memcpy(copies[0], a, size);
    memcpy(copies[1], b, size);
    __msan_unpoison(copies[0], size);
    __msan_unpoison(copies[1], size);
    a = copies[0];
    b = copies[1];
#endif
    return memcmp(a, b, size) == 0;
}

static const uint32_t special_bits[] = {
    0x00000000u, 0x80000000u,                                        /* zeros */
    0x00000001u, 0x807FFFFFu,                                        /* subnormal */
    0x00800000u, 0x7F7FFFFFu, 0xFF7FFFFFu,                           /* the smallest normal one, the largest ones */
    0x7F800000u, 0xFF800000u, 0x7FC00000u, 0xFFC00001u, 0x7F800001u, /* infinities, NaNs */
    0x3F800000u, 0xBF800000u, 0x33800000u, 0x4B800000u               /* 1, -1, 2^-24, 2^24 */
};

/* The next float away from zero, or towards it. */
static float next_to(float number, bool away) {
    const uint32_t bits = fuzz_bits_of(number);
    const uint32_t magnitude = bits & 0x7FFFFFFFu;
    return magnitude == 0u && !away ? number : fuzz_float_of(away ? bits + 1u : bits - 1u);
}

float fuzz_any(fuzz_input_t *in, float low, float high) {
    const uint32_t how = fuzz_below(in, 16);
    switch (how) {
        case 8:
            return low;
        case 9:
            return high;
        case 10:
            return next_to(low, low < 0.0f);
        case 11:
            return next_to(high, high > 0.0f);
        case 12:
        case 13:
            return fuzz_float_of(special_bits[fuzz_below(in, sizeof special_bits / sizeof special_bits[0])]);
        case 14:
            return fuzz_float_of(fuzz_word(in));
        case 15: /* any exponent within the range */
            return fuzz_float_of(fuzz_bits_of(high) - fuzz_half(in) * 0x2000u);
        default:
            return fuzz_between(in, low, high);
    }
}
