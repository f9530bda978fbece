/* Seal over settings and mounting, and the final check of an estimate. SPDX-License-Identifier: MIT */
#include "goe_guard.h"

#include <string.h>

#include "maths/goe_scalar.h"

#define READY 0x474F4533u /* "GOE3" */
#define SEED 0x5EA1u      /* not 0, so memory of zeros is not sealed */
#define EXPONENT_STEP 0x00800000u
#define HAS_ALL                                                                                                        \
    (GOE_HAS_POSITION | GOE_HAS_LENGTH | GOE_HAS_HEIGHT | GOE_HAS_ORIENTATION | GOE_HAS_CENTER | GOE_HAS_WIDTH |       \
     GOE_HAS_VELOCITY)

/* ------------------------------------------------------------------------------------------------------------ words -- */

/* Reads a word of any stored type. memcpy() does not know that it is aligned, and takes four times as long where that matters. */
#if defined(__GNUC__)
typedef uint32_t __attribute__((may_alias)) word_t;

/*@ requires \valid_read((char *)from + (4 * i .. 4 * i + 3)); */
static inline uint32_t word_at(const void *from, size_t i) { return ((const word_t *)from)[i]; }
#else
/*@ requires \valid_read((char *)from + (4 * i .. 4 * i + 3)); */
static inline uint32_t word_at(const void *from, size_t i) {
    uint32_t word;
    memcpy(&word, (const unsigned char *)from + i * sizeof word, sizeof word);
    return word;
}
#endif

#define WORD sizeof(uint32_t)

/* ------------------------------------------------------------------------------------------------------------- seal -- */

#define SEALED_FROM offsetof(goe_estimator_t, camera_to_body)
#define SEALED_TO (offsetof(goe_estimator_t, settings) + sizeof(goe_settings_t))
#define SEALED_WORDS ((SEALED_TO - SEALED_FROM) / WORD)

GOE_STATIC_ASSERT(SEALED_FROM % WORD == 0 && SEALED_TO % WORD == 0, sealed_memory_is_whole_words);

/* The sum detects every change of one word, and of two bits except the same bit of two words. The rotated XOR detects these, unless the
 * words are a multiple of 32 apart. */
static inline void add(goe_seal_t *seal, uint32_t word) {
    seal->sum += word;
    seal->turned = word ^ (seal->turned << 1 | seal->turned >> 31);
}

/* Partly unrolled, because every call computes it. */
static goe_seal_t seal_of(const goe_estimator_t *estimator) {
    const unsigned char *from = (const unsigned char *)estimator + SEALED_FROM;
    goe_seal_t seal = {SEED, SEED};
    size_t i = 0;
    for (; i + 8u <= SEALED_WORDS; i += 8u) {
        add(&seal, word_at(from, i));
        add(&seal, word_at(from, i + 1u));
        add(&seal, word_at(from, i + 2u));
        add(&seal, word_at(from, i + 3u));
        add(&seal, word_at(from, i + 4u));
        add(&seal, word_at(from, i + 5u));
        add(&seal, word_at(from, i + 6u));
        add(&seal, word_at(from, i + 7u));
    }
    for (size_t left = SEALED_WORDS % 8u; left > 0; left--) {
        add(&seal, word_at(from, i++));
    }
    return seal;
}

void goe_guard_seal(goe_estimator_t *estimator) {
    estimator->seal = seal_of(estimator);
    estimator->ready = READY;
}

/* Memory with a wrong mark and a wrong seal was never initialized. */
goe_status_t goe_guard_judge(const goe_estimator_t *estimator) {
    const goe_seal_t seal = seal_of(estimator);
    const bool sealed = seal.sum == estimator->seal.sum && seal.turned == estimator->seal.turned;
    const bool ready = estimator->ready == READY;
    if (sealed && ready) {
        return GOE_OK;
    }
    return sealed || ready ? GOE_CORRUPTED : GOE_NOT_INITIALIZED;
}

/* --------------------------------------------------------------------------------------------------------- estimates -- */

/* Sets bit 31 if the exponent is that of infinities and NaNs. */
static inline uint32_t overflow(const float *at) { return (goe_bits_at(at) & GOE_INFINITY_BITS) + EXPONENT_STEP; }

/* Partly unrolled, too. */
bool goe_guard_finite(const float *floats, size_t count) {
    const float *x = floats;
    const float *end = floats + count;
    uint32_t any = 0u;
    for (; end - x >= 4; x += 4) {
        any |= overflow(&x[0]) | overflow(&x[1]) | overflow(&x[2]) | overflow(&x[3]);
    }
    for (; x != end; x++) {
        any |= overflow(x);
    }
    return any >> 31 == 0u;
}

/* The floats of an estimate are contiguous, except for one count. */
#define FIRST offsetof(goe_estimate_t, age_s)
#define BETWEEN offsetof(goe_estimate_t, nis_rows)
#define SECOND offsetof(goe_estimate_t, nis_ratio)

GOE_STATIC_ASSERT((BETWEEN - FIRST) % sizeof(float) == 0 && (sizeof(goe_estimate_t) - SECOND) % sizeof(float) == 0 &&
                      offsetof(goe_estimate_t, nis) + sizeof(float) == BETWEEN &&
                      offsetof(goe_estimate_t, sigma) == SECOND + sizeof(float) &&
                      offsetof(goe_estimate_t, sigma) + sizeof(goe_sigma_t) == sizeof(goe_estimate_t),
                  the_floats_of_an_estimate_are_checked);
GOE_STATIC_ASSERT(sizeof(bool) == 1, a_truth_value_is_a_byte);

static bool is_truth(const bool *truth) { return *(const unsigned char *)truth <= 1u; }

static bool is_count(int count) { return count >= 0 && count <= INT16_MAX; }

bool goe_guard_estimate(const goe_estimate_t *estimate) {
    const bool named = (unsigned)estimate->method <= (unsigned)GOE_METHOD_FILTER &&
                       (unsigned)estimate->model <= (unsigned)GOE_MODEL_PRISM && estimate->model != GOE_MODEL_AUTO &&
                       (unsigned)estimate->reason <= (unsigned)GOE_REASON_NOISE;
    return named && estimate->valid <= HAS_ALL && is_truth(&estimate->fresh) && is_truth(&estimate->suspect) &&
           is_count(estimate->images_used) && is_count(estimate->nis_rows) &&
           goe_guard_finite(&estimate->age_s, (BETWEEN - FIRST) / sizeof(float)) &&
           goe_guard_finite(&estimate->nis_ratio, (sizeof *estimate - SECOND) / sizeof(float));
}
