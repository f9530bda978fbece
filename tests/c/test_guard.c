/* The seal over settings and mounting, and the check of what leaves. SPDX-License-Identifier: MIT */
/* tests: lib/goe_guard.c */
#include "goe_guard.h"

#include <string.h>

#include "check.h"
#include "goe_settings_internal.h"
#include "refined/goe_filter.h"
#include "scene.h"

#define IMAGES 12
#define SEALED_FROM offsetof(goe_estimator_t, camera_to_body)
#define SEALED_BYTES (offsetof(goe_estimator_t, settings) + sizeof(goe_settings_t) - SEALED_FROM)

static scene_t scene;
static goe_estimator_t estimator;
static goe_estimate_t estimate;
static goe_image_t image;

void setUp(void) { scene_default(&scene); }
void tearDown(void) {}

static void fly(int from, int to) {
    for (int k = from; k < to; k++) {
        scene_image(&scene, k, &image, NULL);
        (void)goe_update(&estimator, &image, &estimate);
    }
}

static void start(void) {
    goe_settings_t settings = scene_settings(&scene);
    scene_level_ground(&settings); /* then it is a box by now */
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
    fly(0, IMAGES);
    TEST_ASSERT_TRUE((estimate.valid & GOE_HAS_POSITION) != 0u);
    scene_image(&scene, IMAGES, &image, NULL);
}

static void flip(void *at, size_t bit) { ((unsigned char *)at)[bit / 8u] ^= (unsigned char)(1u << bit % 8u); }

/* -------------------------------------------------------------------------------------------------------------- seal -- */

static void check_corrupted(void) {
    static const goe_estimate_t nothing;
    static const goe_intent_t intent = {{16.0f, 0.0f, 0.0f}, 10.0f, 10.0f, 0.0f, 0.0f};
    const goe_estimator_t before = estimator;
    float covariance[GOE_QUANTITIES][GOE_QUANTITIES];
    goe_hazard_t hazard;
    memset(&estimate, 0x5A, sizeof estimate);
    CHECK_STATUS(GOE_CORRUPTED, goe_update(&estimator, &image, &estimate));
    TEST_ASSERT_EQUAL_MEMORY(&nothing, &estimate, sizeof estimate);
    CHECK_STATUS(GOE_CORRUPTED, goe_covariance(&estimator, covariance));
    CHECK_STATUS(GOE_CORRUPTED, goe_hazard(&estimator, &intent, &hazard));
    TEST_ASSERT_EQUAL_FLOAT(0.0f, hazard.conflict_probability);
    CHECK_STATUS(GOE_CORRUPTED, goe_reset(&estimator));
    TEST_ASSERT_EQUAL_MEMORY(&before, &estimator, sizeof before);
}

/* [goe_reset]
 * GIVEN a flight WHEN any one bit of settings, mounting, seal or readiness flips THEN every call says so, answers nothing and changes
 * nothing; and the bit flipped back, everything is as it was. */
static void every_flip_of_the_settings_is_found(void) {
    const size_t first = 8u * offsetof(goe_estimator_t, ready);
    const size_t end = 8u * (SEALED_FROM + SEALED_BYTES);
    start();
    for (size_t bit = first; bit < end; bit++) {
        flip(&estimator, bit);
        CHECK_STATUS(GOE_CORRUPTED, goe_guard_check(&estimator));
        if (bit % 97u == 0u) {
            check_corrupted();
        }
        flip(&estimator, bit);
        CHECK_STATUS(GOE_OK, goe_guard_check(&estimator));
    }
}

/* GIVEN any two flips THEN they are found, unless they are the same bit of words that lie 32 words apart. */
static void two_flips_are_found(void) {
    unsigned char *sealed = (unsigned char *)&estimator + SEALED_FROM;
    start();
    for (size_t a = 0; a < 8u * SEALED_BYTES; a += 5) {
        flip(sealed, a);
        for (size_t b = a + 1; b < 8u * SEALED_BYTES; b += 3) {
            if ((b - a) % (32u * 32u) != 0u) {
                flip(sealed, b);
                TEST_ASSERT_TRUE(goe_guard_check(&estimator) == GOE_CORRUPTED);
                flip(sealed, b);
            }
        }
        flip(sealed, a);
    }
}

/* [A19] GIVEN settings with anything between their fields THEN the same settings give the same memory. */
static void padding_between_settings_counts_for_nothing(void) {
    goe_settings_t settings;
    static goe_estimator_t first;
    memset(&settings, 0xA5, sizeof settings);
    goe_settings_t wanted = scene_settings(&scene);
    goe_settings_copy(&settings, &wanted);
    CHECK_STATUS(GOE_OK, goe_init(&first, sizeof first, &settings, NULL));
    memset((unsigned char *)&settings + offsetof(goe_settings_t, heading_auto) + 1, 0xFF,
           offsetof(goe_settings_t, heading_deg) - offsetof(goe_settings_t, heading_auto) - 1);
    memset((unsigned char *)&settings + offsetof(goe_settings_t, filter.top_is_highest) + 1, 0xFF,
           sizeof settings - offsetof(goe_settings_t, filter.top_is_highest) - 1);
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
    TEST_ASSERT_EQUAL_MEMORY(&first, &estimator, sizeof first);
}

/* ------------------------------------------------------------------------------------------------------------ answers -- */

/* [A20] GIVEN any number of floats WHEN one of them is an infinity or a NaN THEN it is found, wherever it lies; the largest float is
 * none. */
static void a_value_that_is_not_finite_is_found(void) {
    static const uint32_t bad[] = {0x7F800000u, 0xFF800000u, 0x7FC00000u, 0xFFFFFFFFu, 0x7F800001u};
    float x[11];
    for (size_t count = 0; count <= 11; count++) {
        for (size_t i = 0; i < 11; i++) {
            x[i] = check_from_bits(i % 2 == 0 ? 0x7F7FFFFFu : 0xFF7FFFFFu);
        }
        TEST_ASSERT_TRUE(goe_guard_finite(x, count));
        for (size_t i = 0; i < 11; i++) {
            for (size_t k = 0; k < sizeof bad / sizeof bad[0]; k++) {
                const float kept = x[i];
                x[i] = check_from_bits(bad[k]);
                TEST_ASSERT_EQUAL(i >= count, goe_guard_finite(x, count));
                x[i] = kept;
            }
        }
    }
}

/* [A20] GIVEN a good estimate WHEN a field of it is none that goe.h lists THEN that is found. */
static void an_undefined_value_is_found(void) {
    start();
    TEST_ASSERT_TRUE(goe_guard_estimate(&estimate));
    for (size_t at = offsetof(goe_estimate_t, age_s); at < sizeof estimate; at += sizeof(float)) {
        goe_estimate_t bad = estimate;
        memset((unsigned char *)&bad + at, 0xFF, sizeof(float)); /* a NaN, or a negative count */
        TEST_ASSERT_FALSE(goe_guard_estimate(&bad));
    }
    goe_estimate_t bad = estimate;
    memset(&bad.method, 3, 1);
    TEST_ASSERT_FALSE(goe_guard_estimate(&bad));
    bad = estimate;
    bad.model = GOE_MODEL_AUTO;
    TEST_ASSERT_FALSE(goe_guard_estimate(&bad));
    memset(&bad.model, GOE_MODEL_PRISM + 1, 1);
    TEST_ASSERT_FALSE(goe_guard_estimate(&bad));
    bad = estimate;
    memset(&bad.reason, GOE_REASON_NOISE + 1, 1);
    TEST_ASSERT_FALSE(goe_guard_estimate(&bad));
    bad = estimate;
    bad.valid |= 0x80u;
    TEST_ASSERT_FALSE(goe_guard_estimate(&bad));
    bad = estimate;
    bad.images_used = -1;
    TEST_ASSERT_FALSE(goe_guard_estimate(&bad));
    bad.images_used = 32768; /* more than goe.h promises */
    TEST_ASSERT_FALSE(goe_guard_estimate(&bad));
    bad = estimate;
    memset(&bad.fresh, 2, 1);
    TEST_ASSERT_FALSE(goe_guard_estimate(&bad));
    bad = estimate;
    memset(&bad.suspect, 0x80, 1);
    TEST_ASSERT_FALSE(goe_guard_estimate(&bad));
}

/* [A22] GIVEN a stale answer that was flipped to none WHEN an image comes THEN nothing is handed out, and the next image begins a track. */
static void a_corrupted_track_begins_again(void) {
    static const goe_estimate_t nothing;
    start();
    estimator.estimate.height_m = check_from_bits(0x7FC00000u);
    memset(&image.left, 0, sizeof image.left);
    memset(&image.right, 0, sizeof image.right);
    image.pose.time_us = estimator.motion.time_us; /* refused */
    CHECK_STATUS(GOE_CORRUPTED, goe_update(&estimator, &image, &estimate));
    TEST_ASSERT_EQUAL_MEMORY(&nothing, &estimate, sizeof estimate);
    TEST_ASSERT_TRUE(estimator.motion.time_us == GOE_TIME_UNKNOWN);
    fly(IMAGES, IMAGES + 1);
    TEST_ASSERT_TRUE(estimator.motion.time_us != GOE_TIME_UNKNOWN);
    fly(IMAGES + 1, 2 * IMAGES);
    TEST_ASSERT_TRUE((estimate.valid & GOE_HAS_POSITION) != 0u);
}

/* GIVEN a camera at no valid place WHEN an image comes THEN the track begins again, too. */
static void a_track_that_is_nowhere_begins_again(void) {
    start();
    estimator.motion.origin_ne_m[0] = check_from_bits(0xFF800000u);
    CHECK_STATUS(GOE_CORRUPTED, goe_update(&estimator, &image, &estimate));
    TEST_ASSERT_TRUE(estimator.motion.time_us == GOE_TIME_UNKNOWN);
}

/* ... also while there is no answer that would show it. */
static void a_track_that_is_nowhere_and_knows_nothing_begins_again(void) {
    const goe_settings_t settings = scene_settings(&scene);
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
    fly(0, 1);
    TEST_ASSERT_EQUAL_HEX32(0u, estimate.valid);
    estimator.motion.origin_ne_m[0] = check_from_bits(0xFF800000u);
    scene_image(&scene, 1, &image, NULL);
    scene_hide_points(&image);
    CHECK_STATUS(GOE_CORRUPTED, goe_update(&estimator, &image, &estimate));
    TEST_ASSERT_TRUE(estimator.motion.time_us == GOE_TIME_UNKNOWN);
}

/* [A20] GIVEN covariance and hazard of an answer that is no number THEN they are none, either. */
static void no_call_returns_a_value_that_is_not_finite(void) {
    static const goe_intent_t intent = {{16.0f, 0.0f, 0.0f}, 10.0f, 10.0f, 0.0f, 0.0f};
    float covariance[GOE_QUANTITIES][GOE_QUANTITIES];
    goe_hazard_t hazard;
    start();
    estimator.filter.root.element[goe_srif_row(GOE_INVERSE_RANGE) + GOE_INVERSE_RANGE] = check_from_bits(0x7FC00000u);
    CHECK_STATUS(GOE_CORRUPTED, goe_covariance(&estimator, covariance));
    TEST_ASSERT_EQUAL_FLOAT(0.0f, covariance[GOE_X0][GOE_X0]);
    CHECK_STATUS(GOE_CORRUPTED, goe_hazard(&estimator, &intent, &hazard));
    TEST_ASSERT_EQUAL_FLOAT(0.0f, hazard.tcpa_s);
}

/* [A19] GIVEN truth values of an image that are neither 0 nor 1 THEN they count as 1. */
static void any_truth_but_none_is_one(void) {
    goe_estimate_t first;
    goe_image_t odd;
    goe_settings_t settings = scene_settings(&scene);
    scene_level_ground(&settings);
    start();
    first = estimate;
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
    for (int k = 0; k < IMAGES; k++) {
        scene_image(&scene, k, &odd, NULL);
        goe_pixel_t *const points[] = {&odd.left,      &odd.right,     &odd.top,
                                       &odd.base_left, &odd.base_near, &odd.base_right};
        for (int i = 0; i < 6; i++) {
            if (points[i]->visible) {
                memset(&points[i]->visible, 0x40 + i, 1);
            }
        }
        (void)goe_update(&estimator, &odd, &estimate);
    }
    TEST_ASSERT_EQUAL_MEMORY(&first, &estimate, sizeof first);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(every_flip_of_the_settings_is_found);
    RUN_TEST(two_flips_are_found);
    RUN_TEST(padding_between_settings_counts_for_nothing);
    RUN_TEST(a_value_that_is_not_finite_is_found);
    RUN_TEST(an_undefined_value_is_found);
    RUN_TEST(a_corrupted_track_begins_again);
    RUN_TEST(a_track_that_is_nowhere_begins_again);
    RUN_TEST(a_track_that_is_nowhere_and_knows_nothing_begins_again);
    RUN_TEST(no_call_returns_a_value_that_is_not_finite);
    RUN_TEST(any_truth_but_none_is_one);
    return UNITY_END();
}
