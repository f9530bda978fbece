/* Fuzzes one flipped bit in the estimator's memory: any bit, at any time of any flight. SPDX-License-Identifier: MIT
 *
 * goe.h: a flipped bit leads to no trap, no endless loop, no write outside, and no output that is not finite or outside its enumeration.
 * Each section begins with goe_init(), flies, flips one bit and flies on. tests/flips counts the effects of every bit in some flights;
 * this target covers all flights, and some bits. */
#include <math.h>
#include <string.h>

#include "estimate_checks.h"
#include "fuzz.h"
#include "fuzz_image.h"
#include "fuzz_settings.h"
#include "guarded_estimator.h"

#define UPDATES_MAX 6000u
#define VALID_BITS 0x7Fu

enum { UPDATES, FLIPS, CORRUPTED, NOT_INITIALIZED, RESET_HELPED, FRESH_AFTER, SUSPECT_AFTER, COUNTS };

fuzz_count_t fuzz_counts[COUNTS + 1] = {{"updates", 0},
                                        {"flips", 0},
                                        {"answered_corrupted", 0},
                                        {"answered_not_initialized", 0},
                                        {"resets_that_helped", 0},
                                        {"fresh_after", 0},
                                        {"suspect_after", 0},
                                        {NULL, 0}};

static void check_finite(const void *from, size_t size) {
    for (size_t i = 0; i + sizeof(float) <= size; i += sizeof(float)) {
        float number;
        memcpy(&number, (const unsigned char *)from + i, sizeof number);
        FUZZ_CHECK(fuzz_is_finite(number));
    }
}

/* 0 or 1, checked as a byte. */
static void check_truth(const bool *truth) {
    unsigned char byte;
    memcpy(&byte, truth, sizeof byte);
    FUZZ_CHECK(byte <= 1u);
}

static void check_answer(goe_status_t status) {
    const goe_estimate_t *e = &memory.estimate;
    guard_check();
    check_finite(&e->age_s, sizeof *e - offsetof(goe_estimate_t, age_s));
    check_truth(&e->fresh);
    check_truth(&e->suspect);
    FUZZ_CHECK(check_is_image_status(status) || status == GOE_CORRUPTED || status == GOE_NOT_INITIALIZED);
    FUZZ_CHECK((int)e->method >= 0 && (int)e->method <= (int)GOE_METHOD_FILTER);
    FUZZ_CHECK((int)e->model >= (int)GOE_MODEL_NONE && (int)e->model <= (int)GOE_MODEL_PRISM);
    FUZZ_CHECK((int)e->reason >= (int)GOE_REASON_NONE && (int)e->reason <= (int)GOE_REASON_NOISE);
    FUZZ_CHECK((e->valid & ~VALID_BITS) == 0u);
    FUZZ_CHECK(check_is_image_status(status) || e->valid == 0u);
}

static void ask(const fuzz_view_t *view) {
    float covariance[GOE_QUANTITIES][GOE_QUANTITIES];
    goe_hazard_t hazard;
    goe_intent_t intent;
    memset(&intent, 0, sizeof intent);
    memset(&hazard, 0xFF, sizeof hazard);
    memset(covariance, 0xFF, sizeof covariance);
    intent.velocity_ned_m_s[0] = view->path.speed_m_s * cosf(view->path.course_rad);
    intent.velocity_ned_m_s[1] = view->path.speed_m_s * sinf(view->path.course_rad);
    intent.margin_m = 15.0f;
    intent.clearance_m = 10.0f;
    (void)goe_covariance(&memory.estimator, covariance);
    check_finite(covariance, sizeof covariance);
    (void)!goe_hazard(&memory.estimator, &intent, &hazard);
    check_finite(&hazard, offsetof(goe_hazard_t, has_clearance));
    check_truth(&hazard.has_clearance);
    FUZZ_CHECK(hazard.conflict_probability >= 0.0f && hazard.conflict_probability <= 1.0f);
    guard_check();
}

static void flip(fuzz_input_t *in) {
    const size_t byte = fuzz_half(in) % sizeof memory.estimator;
    const unsigned char bit = (unsigned char)(1u << fuzz_below(in, 8));
    unsigned char *at = (unsigned char *)&memory.estimator + byte;
    *at = (unsigned char)(*at ^ bit);
    fuzz_counts[FLIPS].times++;
}

static void count_answer(goe_status_t status, bool flipped) {
    fuzz_counts[UPDATES].times++;
    if (flipped) {
        fuzz_counts[CORRUPTED].times += status == GOE_CORRUPTED ? 1u : 0u;
        fuzz_counts[NOT_INITIALIZED].times += status == GOE_NOT_INITIALIZED ? 1u : 0u;
        fuzz_counts[FRESH_AFTER].times += memory.estimate.fresh ? 1u : 0u;
        fuzz_counts[SUSPECT_AFTER].times += memory.estimate.suspect ? 1u : 0u;
    }
}

/* Returns the number of images flown. */
static uint32_t section(fuzz_input_t *in, fuzz_view_t *view) {
    static goe_settings_t settings;
    goe_image_t image;
    fuzz_usual_settings(in, &settings);
    if (fuzz_below(in, 4) == 3u) {
        fuzz_change_settings(in, true, &settings);
    }
    if (goe_init(&memory.estimator, sizeof memory.estimator, &settings, NULL) != GOE_OK) {
        return 1;
    }
    fuzz_view_begin(in, &settings, view);
    const uint32_t before = fuzz_below(in, 80);
    const uint32_t images = before + 10u + fuzz_below(in, 40);
    for (uint32_t k = 0; k < images; k++) {
        if (k == before) {
            flip(in);
        }
        (void)fuzz_view_image(view, &image);
        memset(&memory.estimate, 0xFF, sizeof memory.estimate);
        const goe_status_t status = goe_update(&memory.estimator, &image, &memory.estimate);
        check_answer(status);
        count_answer(status, k >= before);
        if (k >= before && k % 2u == 0) {
            ask(view);
        }
        if (status == GOE_CORRUPTED && goe_reset(&memory.estimator) == GOE_OK) {
            fuzz_counts[RESET_HELPED].times++;
        }
    }
    return images;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    fuzz_input_t in = {data, size};
    fuzz_view_t view;
    uint32_t updates = 0;
    memset(&view, 0, sizeof view);
    guard_begin(GUARD);
    do {
        updates += section(&in, &view);
    } while (in.left > 0 && updates < UPDATES_MAX);
    return 0;
}
