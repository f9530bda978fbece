/* How well images fit, and when the filter begins again. SPDX-License-Identifier: MIT */
/* tests: lib/refined/goe_health.c */
#include "refined/goe_health.h"

#include <math.h>
#include <string.h>

#include "check.h"
#include "refined/goe_filter.h"

#define ALL 0x3Fu
#define LEFT (1u << GOE_POINT_LEFT)
#define TOP (1u << GOE_POINT_TOP)

static goe_filter_t filter;
static goe_settings_t settings;

/* A box by its corners, long in flight, that fits. */
void setUp(void) {
    goe_settings_default(&settings);
    memset(&filter, 0, sizeof filter);
    for (size_t i = 0; i < GOE_STATES; i++) {
        filter.state[i] = 0.1f;
        *goe_srif_at(&filter.root, i, i) = 10.0f;
    }
    filter.phase = GOE_PHASE_BOX;
    filter.health.images = 100;
    filter.health.recent_nis = 1.0f;
}
void tearDown(void) {}

static goe_verdict_t verdict_of(unsigned measured, unsigned refused) {
    goe_verdict_t verdict;
    memset(&verdict, 0, sizeof verdict);
    verdict.measured = measured;
    verdict.refused = refused;
    verdict.rows = 9;
    verdict.odd = GOE_FEATURES;
    return verdict;
}

static bool judge(unsigned measured, unsigned refused) {
    return goe_health_judge(&filter, settings.model, verdict_of(measured, refused));
}

/* GIVEN one point that is refused again and again, the others fitting THEN in the fourth image the state counts as captured, not
 * the point as an outlier; an image in which it fits restarts the count, one without it does not. */
static void a_point_that_is_always_refused_begins_again(void) {
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_FALSE(judge(ALL, LEFT));
    }
    TEST_ASSERT_TRUE(judge(ALL, LEFT));
    setUp();
    for (int i = 0; i < 20; i++) {
        TEST_ASSERT_FALSE(judge(ALL, i % 4 == 3 ? 0u : LEFT));
    }
    setUp();
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_FALSE(judge(ALL, LEFT));
        TEST_ASSERT_FALSE(judge(ALL & ~LEFT, 0u));
    }
    TEST_ASSERT_TRUE(judge(ALL, LEFT));
}

/* GIVEN images with half of the points refused THEN the third in a row starts the filter again; less than half does not count, and an
 * image that fits ends the row. */
static void images_of_which_half_is_refused_begin_again(void) {
    TEST_ASSERT_FALSE(judge(ALL, 0x07u));
    TEST_ASSERT_FALSE(judge(ALL, 0x38u));
    TEST_ASSERT_TRUE(judge(ALL, 0x15u));
    setUp();
    for (int i = 0; i < 20; i++) {
        TEST_ASSERT_FALSE(judge(ALL, i % 2 == 0 ? 0x03u : 0x18u)); /* two of six, never the same for long */
    }
    setUp();
    for (int i = 0; i < 20; i++) {
        TEST_ASSERT_FALSE(judge(ALL, i % 3 == 2 ? 0u : i % 3 == 0 ? 0x07u : 0x38u));
    }
}

/* GIVEN a chord, whose end may leave it THEN a point has twice as long to come back, and the filter does not start again while an end is
 * leaving: it becomes a box. */
static void an_end_of_a_chord_has_longer(void) {
    filter.phase = GOE_PHASE_CHORD;
    for (int i = 0; i < 7; i++) {
        TEST_ASSERT_FALSE(judge(ALL, LEFT));
    }
    TEST_ASSERT_TRUE(judge(ALL, LEFT));
    setUp();
    filter.phase = GOE_PHASE_CHORD;
    filter.leaving.outward = 1.5f;
    for (int i = 0; i < 20; i++) {
        TEST_ASSERT_FALSE(judge(ALL, 0x07u));
    }
    TEST_ASSERT_EQUAL_UINT8(0, filter.health.poor); /* nor at once when it has left */
}

/* GIVEN the top alone refused for three images THEN it is free again, by twice the largest extent, as nothing else hangs on it; and
 * the others are as certain as they were. */
static void a_refused_top_is_learnt_again(void) {
    const double before = (double)goe_filter_variance(&filter, GOE_FRONT_X);
    for (int box = 0; box < 2; box++) {
        setUp();
        const size_t top = GOE_TOP;
        filter.phase = box == 1 ? GOE_PHASE_BOX : GOE_PHASE_PRISM;
        filter.state[GOE_FRONT_X] = 0.3f;
        filter.state[GOE_DEPTH_DIFFERENCE] = box == 1 ? -0.5f : 0.2f;
        const double size = box == 1 ? 0.5 : 0.3; /* a prism has its top where a box has a depth */
        for (int i = 0; i < 3; i++) {
            CHECK_CLOSE(1.0e-5, 0.01, goe_filter_variance(&filter, (goe_state_index_t)top));
            TEST_ASSERT_FALSE(judge(ALL, TOP));
        }
        CHECK_CLOSE(1.0e-3, 0.01 + 4.0 * size * size, goe_filter_variance(&filter, (goe_state_index_t)top));
        CHECK_CLOSE(1.0e-6, before, goe_filter_variance(&filter, GOE_FRONT_X));
        TEST_ASSERT_EQUAL_UINT8(0, filter.health.refused[GOE_POINT_TOP]); /* and has three images again */
        TEST_ASSERT_FALSE(judge(ALL, TOP));
        TEST_ASSERT_FALSE(judge(ALL, TOP));
    }
}

static void fail(goe_phase_t phase) {
    filter.phase = (uint8_t)phase;
    filter.health.recent_nis = 7.0f; /* which no true state has */
    TEST_ASSERT_TRUE(judge(ALL, 0u));
    filter.health.recent_nis = 1.0f;
}

/* GIVEN a box by base corners that proves wrong twice, not early in the track THEN they are wrong, and are left out; a disc, a box by
 * its outline, or one that was configured, is no evidence about the corners. */
static void corners_that_prove_wrong_twice_are_left_out(void) {
    static const goe_phase_t others[] = {GOE_PHASE_DISC, GOE_PHASE_CHORD, GOE_PHASE_BOX_OUTLINE, GOE_PHASE_PRISM};
    fail(GOE_PHASE_BOX);
    TEST_ASSERT_FALSE(filter.health.base_refused);
    fail(GOE_PHASE_BOX_FACE);
    TEST_ASSERT_TRUE(filter.health.base_refused);
    for (size_t i = 0; i < 4; i++) {
        setUp();
        fail(others[i]);
        fail(others[i]);
        fail(GOE_PHASE_BOX);
        TEST_ASSERT_FALSE(filter.health.base_refused);
    }
    setUp();
    filter.health.images = 31;
    fail(GOE_PHASE_BOX);
    fail(GOE_PHASE_BOX);
    TEST_ASSERT_FALSE(filter.health.base_refused);
    setUp();
    settings.model = GOE_MODEL_LINE;
    fail(GOE_PHASE_BOX);
    fail(GOE_PHASE_BOX);
    TEST_ASSERT_FALSE(filter.health.base_refused);
}

/* GIVEN two new starts within 24 images THEN the inputs contradict each other; one is an outlier's, and so are two that are
 * farther apart. */
static void two_starts_in_short_order_are_reported(void) {
    const goe_verdict_t good = verdict_of(ALL, 0u);
    for (int apart = 22; apart <= 24; apart++) {
        setUp();
        for (int i = 0; i < 50; i++) {
            goe_health_take(&filter.health, good, 9.0f);
        }
        fail(GOE_PHASE_DISC);
        TEST_ASSERT_FALSE(filter.health.adrift);
        for (int i = 0; i < apart; i++) {
            goe_health_take(&filter.health, good, 9.0f);
        }
        fail(GOE_PHASE_DISC);
        TEST_ASSERT_EQUAL_INT(apart < 23, filter.health.adrift ? 1 : 0);
    }
}

/* GIVEN a state that is no obstacle's THEN it is not used any more: a width that is none, a number beyond all bounds, or an
 * information that is infinite. */
static void a_state_that_is_none_is_not_kept(void) {
    TEST_ASSERT_FALSE(judge(ALL, 0u));
    filter.state[GOE_FRONT_X] = 0.0f;
    TEST_ASSERT_TRUE(judge(ALL, 0u));
    for (size_t i = 0; i < GOE_STATES; i++) {
        setUp();
        filter.state[i] = i == GOE_FRONT_X ? 2.0e6f : -2.0e6f;
        TEST_ASSERT_TRUE(judge(ALL, 0u));
        setUp();
        *goe_srif_at(&filter.root, i, i) = check_from_bits(0x7F800000u);
        TEST_ASSERT_TRUE(judge(ALL, 0u));
    }
}

/* GIVEN an image with half of its points refused THEN it counts as the worst, as the rest fits by itself; and the means are those of the
 * header: over the latest 64, with eight images of prior, and over all of the track. */
static void the_means_are_those_of_the_header(void) {
    goe_health_t *health = &filter.health;
    memset(health, 0, sizeof *health);
    health->recent_nis = GOE_NIS_NONE;
    double mean = 0.0;
    double excess = 0.0;
    for (int i = 1; i <= 80; i++) {
        const bool poor = i == 40;
        const double ratio = poor ? 20.0 : 0.5 + 0.01 * i;
        goe_health_take(health, verdict_of(ALL, poor ? 0x07u : 0u), (float)(9.0 * (0.5 + 0.01 * i)));
        mean += (ratio - mean) / fmin(i + 8.0, 64.0);
        excess += (ratio - 1.0 - excess) / (i + 8.0);
        CHECK_CLOSE(1.0e-4, mean, health->mean_nis);
        CHECK_CLOSE(1.0e-4, excess, health->excess);
        TEST_ASSERT_EQUAL_INT(9, health->nis_rows);
        TEST_ASSERT_TRUE(i > 1 || fabs((double)health->recent_nis - 1.0) < 1.0e-6); /* a phase's first does not count */
    }
    const float before = health->mean_nis;
    goe_health_take_refused(health, verdict_of(0u, 0u));
    CHECK_SAME(before, health->mean_nis);
    goe_health_take_refused(health, verdict_of(ALL, ALL));
    TEST_ASSERT_TRUE(health->mean_nis > before + 0.2f);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(a_point_that_is_always_refused_begins_again);
    RUN_TEST(images_of_which_half_is_refused_begin_again);
    RUN_TEST(an_end_of_a_chord_has_longer);
    RUN_TEST(a_refused_top_is_learnt_again);
    RUN_TEST(corners_that_prove_wrong_twice_are_left_out);
    RUN_TEST(two_starts_in_short_order_are_reported);
    RUN_TEST(a_state_that_is_none_is_not_kept);
    RUN_TEST(the_means_are_those_of_the_header);
    return UNITY_END();
}
