/* Decisions and numbers from a fuzzer's bytes. SPDX-License-Identifier: MIT
 *
 * Bytes are taken from the front. After their end all are 0, so that a short input means default values. */
#ifndef FUZZ_INPUT_H
#define FUZZ_INPUT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

typedef struct {
    const uint8_t *next;
    size_t left;
} fuzz_input_t;

static inline uint8_t fuzz_byte(fuzz_input_t *in) {
    if (in->left == 0) {
        return 0;
    }
    in->left--;
    return *in->next++;
}

/* Two and four bytes, little-endian. */
static inline uint32_t fuzz_half(fuzz_input_t *in) {
    const uint32_t low = fuzz_byte(in);
    return low | (uint32_t)fuzz_byte(in) << 8;
}

static inline uint32_t fuzz_word(fuzz_input_t *in) {
    const uint32_t low = fuzz_half(in);
    return low | fuzz_half(in) << 16;
}

/* 0 to limit - 1, from one byte; limit 1 to 256. */
static inline uint32_t fuzz_below(fuzz_input_t *in, uint32_t limit) { return fuzz_byte(in) % limit; }

/* Always false once the bytes are used up. */
static inline bool fuzz_one_in(fuzz_input_t *in, uint32_t n) { return fuzz_byte(in) % n == n - 1u; }

/* low to high, from two bytes; 0 gives low. */
static inline float fuzz_between(fuzz_input_t *in, float low, float high) {
    return low + (high - low) * (float)fuzz_half(in) * (1.0f / 65535.0f);
}

static inline float fuzz_float_of(uint32_t bits) {
    float number;
    memcpy(&number, &bits, sizeof number);
    return number;
}

static inline uint32_t fuzz_bits_of(float number) {
    uint32_t bits;
    memcpy(&bits, &number, sizeof bits);
    return bits;
}

/* Uses the exponent's bits and therefore also works under -ffast-math. */
static inline bool fuzz_is_finite(float number) { return (fuzz_bits_of(number) & 0x7F800000u) != 0x7F800000u; }

/* A number that is often a limit, or just beyond one, or special, and sometimes arbitrary bits. */
float fuzz_any(fuzz_input_t *in, float low, float high);

/* A cheap source of noise that takes no bytes of the input. */
typedef struct {
    uint32_t state; /* not 0 */
} fuzz_noise_t;

static inline uint32_t fuzz_noise_bits(fuzz_noise_t *noise) {
    uint32_t x = noise->state;
    x ^= x << 13;
    x ^= x >> 17;
    x ^= x << 5;
    noise->state = x;
    return x;
}

/* -1 to 1, a triangle. */
static inline float fuzz_noise(fuzz_noise_t *noise) {
    const uint32_t bits = fuzz_noise_bits(noise);
    return ((float)(bits & 0xFFFFu) + (float)(bits >> 16)) * (1.0f / 65536.0f) - 1.0f;
}

#endif
