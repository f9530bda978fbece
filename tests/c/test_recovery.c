/* How well the images fit, and when the filter has to start again. SPDX-License-Identifier: MIT */
/* tests: lib/refined/goe_health.c */
#include "refined/goe_health.h"

#include <string.h>

#include "check.h"

#define ALL 0x3Fu
#define LEFT (1u << GOE_POINT_LEFT)
#define TOP (1u << GOE_POINT_TOP)
#define HALF 0x07u /* three of six */
#define ROWS 9
#define SEEDS 8
#define MEAN_IMAGES 64

static goe_filter_t filter;
static goe_settings_t settings;

/* A footprint whose state is one of an obstacle. */
void setUp(void) {
    goe_settings_default(&settings);
    memset(&filter, 0, sizeof filter);
    goe_filter_clear(&filter);
    goe_filter_enter(&filter, GOE_PHASE_FOOTPRINT);
    filter.state[GOE_FRONT_X] = 0.1f;
    for (size_t i = 0; i < GOE_UNKNOWNS; i++) {
        *goe_srif_at(&filter.root, i, i) = 1.0f;
    }
}
void tearDown(void) {}

static goe_verdict_t verdict_of(unsigned refused) {
    goe_verdict_t verdict;
    memset(&verdict, 0, sizeof verdict);
    verdict.measured = ALL;
    verdict.refused = refused;
    verdict.rows = ROWS;
    return verdict;
}

static void take(float ratio) { goe_health_take(&filter.health, verdict_of(0u), ratio * (float)ROWS); }
static bool judge(unsigned refused) { return goe_health_judge(&filter, settings.model, verdict_of(refused)); }

/* ------------------------------------------------------------------------------------------------------------- means -- */

/* [GOE_REASON_NOISE, goe_estimate_t.nis_ratio]
 * GIVEN images whose NIS is that of their rows THEN the NIS ratio is their mean with eight zeros before, of 64 images from then on; the
 * excess over 1 is a mean of all of the track. */
static void the_misfit_begins_with_eight_zeros_and_remembers_64_images(void) {
    double expected = 0.0;
    double excess = 0.0;
    for (int n = 1; n <= 200; n++) {
        const int counted = n + SEEDS < MEAN_IMAGES ? n + SEEDS : MEAN_IMAGES;
        const float ratio = n > 100 ? 2.0f : 1.0f;
        take(ratio);
        expected += ((double)ratio - expected) / counted;
        excess += ((double)ratio - 1.0 - excess) / (n + SEEDS);
        CHECK_CLOSE(1.0e-5, expected, filter.health.mean_nis);
        CHECK_CLOSE(1.0e-5, excess, filter.health.excess);
        if (n == 24) {
            CHECK_CLOSE(1.0e-5, 24.0 / 32.0, filter.health.mean_nis);
        }
    }
    CHECK_CLOSE(1.0e-5, 18.0, filter.health.nis);
    TEST_ASSERT_EQUAL_INT(ROWS, filter.health.nis_rows);
    TEST_ASSERT_EQUAL_INT(200, filter.health.images);
    goe_health_expect(&filter.health);
    CHECK_SAME(0.0f, filter.health.nis);
    TEST_ASSERT_EQUAL_INT(0, filter.health.nis_rows);
}

/* GIVEN one image that fits not at all, or of which half of the points or all were refused THEN it counts as 20 times too large. */
static void one_image_does_not_decide(void) {
    take(1.0e9f);
    CHECK_CLOSE(1.0e-5, 20.0 / 9.0, filter.health.mean_nis);
    TEST_ASSERT_TRUE(check_is_finite(filter.health.nis));
    setUp();
    take(check_from_bits(0x7FC00000u));
    CHECK_CLOSE(1.0e-5, 20.0 / 9.0, filter.health.mean_nis);
    setUp();
    goe_health_take(&filter.health, verdict_of(HALF), (float)ROWS);
    CHECK_CLOSE(1.0e-5, 20.0 / 9.0, filter.health.mean_nis);
    setUp();
    goe_health_take_refused(&filter.health, verdict_of(ALL));
    CHECK_CLOSE(1.0e-5, 20.0 / 9.0, filter.health.mean_nis);
    TEST_ASSERT_EQUAL_INT(1, filter.health.images);
    setUp();
    goe_verdict_t nothing = verdict_of(0u);
    nothing.measured = 0u;
    goe_health_take_refused(&filter.health, nothing);
    TEST_ASSERT_EQUAL_INT(0, filter.health.images);
}

/* [goe_estimate_t.images_used] */
static void the_count_of_images_saturates(void) {
    filter.health.images = INT16_MAX - 1;
    take(1.0f);
    TEST_ASSERT_EQUAL_INT(INT16_MAX, filter.health.images);
    take(1.0f);
    TEST_ASSERT_EQUAL_INT(INT16_MAX, filter.health.images);
}

/* ---------------------------------------------------------------------------------------------------------- recovery -- */

/* [T1] GIVEN one point that is refused in 4 images in a row THEN the filter starts again; an image between in which it fits begins the
 * count again, one in which it is not measured does not. */
static void a_point_refused_again_and_again_starts_the_filter_again(void) {
    for (int i = 1; i < 4; i++) {
        TEST_ASSERT_FALSE(judge(LEFT));
    }
    TEST_ASSERT_FALSE(judge(0u));
    for (int i = 1; i < 4; i++) {
        TEST_ASSERT_FALSE(judge(LEFT));
    }
    goe_verdict_t undetected = verdict_of(0u);
    undetected.measured = ALL & ~LEFT;
    TEST_ASSERT_FALSE(goe_health_judge(&filter, settings.model, undetected));
    TEST_ASSERT_TRUE(judge(LEFT));
    TEST_ASSERT_EQUAL_UINT8(0u, filter.health.refused[GOE_POINT_LEFT]);
}

/* [T1] */
static void half_of_the_points_refused_three_times_start_the_filter_again(void) {
    TEST_ASSERT_FALSE(judge(HALF));
    TEST_ASSERT_FALSE(judge(HALF));
    TEST_ASSERT_FALSE(judge(0u));
    TEST_ASSERT_FALSE(judge(HALF));
    TEST_ASSERT_FALSE(judge(ALL & ~HALF)); /* whichever half */
    TEST_ASSERT_TRUE(judge(HALF));
    setUp();
    for (int i = 0; i < 20; i++) {
        TEST_ASSERT_FALSE(judge(i % 2 == 0 ? 0x03u : 0x18u)); /* two of six, never the same for long */
    }
}

/* [T1] */
static void images_that_do_not_fit_start_the_filter_again(void) {
    filter.health.recent_nis = 6.0f;
    TEST_ASSERT_FALSE(judge(0u));
    filter.health.recent_nis = 6.01f;
    TEST_ASSERT_TRUE(judge(0u));
    setUp();
    take(10.0f); /* the first of a phase says nothing */
    CHECK_SAME(1.0f, filter.health.recent_nis);
    take(9.0f);
    CHECK_CLOSE(1.0e-6, 2.0, filter.health.recent_nis);
}

/* [T1] GIVEN a width that is none, a number beyond all bounds or none, or an information that is infinite THEN the filter starts again. */
static void a_state_of_no_obstacle_starts_the_filter_again(void) {
    filter.state[GOE_FRONT_X] = 0.0f;
    TEST_ASSERT_TRUE(judge(0u));
    for (size_t i = 0; i < GOE_STATES; i++) {
        setUp();
        filter.state[i] = i == GOE_FRONT_X ? 1.1e6f : -1.1e6f;
        TEST_ASSERT_TRUE(judge(0u));
        setUp();
        filter.state[i] = check_from_bits(0x7FC00000u);
        TEST_ASSERT_TRUE(judge(0u));
        setUp();
        *goe_srif_at(&filter.root, i, i) = check_from_bits(0x7F800000u);
        TEST_ASSERT_TRUE(judge(0u));
    }
}

/* [T2] GIVEN the top alone of a box refused 3 times THEN it is freed by twice the largest extent, as nothing else hangs on it, and the filter
 * goes on; the others are as certain as they were. Of a footprint, it counts as any other point. */
static void a_top_of_a_box_that_is_refused_is_freed(void) {
    for (int box = 0; box < 2; box++) {
        setUp();
        filter.phase = box == 1 ? GOE_PHASE_BOX : GOE_PHASE_FOOTPRINT;
        filter.state[GOE_FRONT_X] = 0.3f;
        filter.state[GOE_DEPTH_DIFFERENCE] = -0.5f;
        for (int i = 0; i < 3; i++) {
            CHECK_CLOSE(1.0e-5, 1.0, goe_filter_variance(&filter, GOE_TOP));
            TEST_ASSERT_FALSE(judge(TOP));
        }
        CHECK_CLOSE(1.0e-3, box == 1 ? 1.0 + 4.0 * 0.5 * 0.5 : 1.0, goe_filter_variance(&filter, GOE_TOP));
        CHECK_CLOSE(1.0e-6, 1.0, goe_filter_variance(&filter, GOE_FRONT_X));
        TEST_ASSERT_EQUAL_UINT8(box == 1 ? 0u : 3u, filter.health.refused[GOE_POINT_TOP]); /* three images again */
        TEST_ASSERT_EQUAL(box == 0, judge(TOP));
    }
}

/* ------------------------------------------------------------------------------------------------------------- doubt -- */

static void fail_once(void) {
    filter.state[GOE_FRONT_X] = 0.0f;
    TEST_ASSERT_TRUE(judge(0u));
    filter.state[GOE_FRONT_X] = 0.1f;
}

/* [GOE_REASON_BASE]
 * GIVEN a box of base corners that fails twice, late in its track THEN these are given up; a footprint's failures, a box's in the first
 * 32 images, or those of a configured box, are no evidence about them. */
static void base_corners_that_fail_twice_are_given_up(void) {
    for (int phase = GOE_PHASE_FOOTPRINT; phase <= GOE_PHASE_BOX; phase++) {
        for (int late = 0; late < 2; late++) {
            for (int forced = 0; forced < 2; forced++) {
                const bool by_corners = phase != GOE_PHASE_FOOTPRINT;
                setUp();
                settings.model = forced ? GOE_MODEL_LINE : GOE_MODEL_AUTO;
                filter.phase = (unsigned char)phase;
                filter.health.images = late ? 32 : 31;
                fail_once();
                TEST_ASSERT_FALSE(filter.health.base_refused);
                fail_once();
                TEST_ASSERT_EQUAL_INT(by_corners && late && !forced, filter.health.base_refused);
            }
        }
    }
}

/* [GOE_REASON_CONVENTION]
 * GIVEN two restarts within 24 images THEN the inputs contradict each other; farther apart they are an outlier's. */
static void two_restarts_soon_are_one_too_many(void) {
    for (int between = 22; between < 26; between++) {
        setUp();
        fail_once();
        TEST_ASSERT_FALSE(filter.health.adrift);
        for (int i = 0; i < between; i++) {
            take(1.0f);
        }
        fail_once();
        TEST_ASSERT_EQUAL_INT(between < 23, filter.health.adrift);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(the_misfit_begins_with_eight_zeros_and_remembers_64_images);
    RUN_TEST(one_image_does_not_decide);
    RUN_TEST(the_count_of_images_saturates);
    RUN_TEST(a_point_refused_again_and_again_starts_the_filter_again);
    RUN_TEST(half_of_the_points_refused_three_times_start_the_filter_again);
    RUN_TEST(images_that_do_not_fit_start_the_filter_again);
    RUN_TEST(a_state_of_no_obstacle_starts_the_filter_again);
    RUN_TEST(a_top_of_a_box_that_is_refused_is_freed);
    RUN_TEST(base_corners_that_fail_twice_are_given_up);
    RUN_TEST(two_restarts_soon_are_one_too_many);
    return UNITY_END();
}
