/* Sliding mean. SPDX-License-Identifier: MIT */
/* tests: lib/window/goe_mean.c */
#include <math.h>
#include <string.h>

#include "check.h"
#include "window/goe_mean.h"

static goe_mean_t mean;

void setUp(void) { memset(&mean, 0, sizeof mean); }
void tearDown(void) {}

/* [A32] */
static void the_first_value_is_its_own_mean(void) {
    const goe_average_t a = goe_mean_add(&mean, 8, 3.5f);
    TEST_ASSERT_EQUAL_FLOAT(3.5f, a.mean);
    TEST_ASSERT_EQUAL_FLOAT(0.0f, a.variance);
}

/* [window.points] */
static void the_newest_values_are_averaged(void) {
    float value[30];
    check_random_t random = check_random_start("means");
    for (int k = 0; k < 30; k++) {
        value[k] = (float)check_random_between(&random, -5.0, 20.0);
        const goe_average_t a = goe_mean_add(&mean, 5, value[k]);
        const int n = k + 1 < 5 ? k + 1 : 5;
        double sum = 0.0;
        double squares = 0.0;
        for (int i = k - n + 1; i <= k; i++) {
            sum += (double)value[i];
        }
        for (int i = k - n + 1; i <= k; i++) {
            squares += ((double)value[i] - sum / n) * ((double)value[i] - sum / n);
        }
        CHECK_CLOSE(1.0e-5, sum / n, a.mean);
        CHECK_CLOSE(1.0e-4, n > 1 ? squares / (n * (n - 1.0)) : 0.0, a.variance);
    }
}

/* GIVEN a place or a count that a flipped bit made none THEN the mean is that of values which came. */
static void a_place_that_is_none_is_the_first(void) {
    static const int16_t none[] = {INT16_MIN, -1, 3, INT16_MAX};
    for (size_t i = 0; i < sizeof none / sizeof none[0]; i++) {
        setUp();
        mean.next = none[i];
        CHECK_SAME(2.0f, goe_mean_add(&mean, 3, 2.0f).mean);
        TEST_ASSERT_EQUAL_INT(1, mean.next);
        mean.count = none[i];
        (void)goe_mean_add(&mean, 3, 4.0f);
        TEST_ASSERT_TRUE(mean.count > 0 && mean.count <= 3);
    }
}

/* [window.points] */
static void an_outlier_leaves_without_a_trace(void) {
    goe_average_t a = {0.0f, 0.0f};
    (void)goe_mean_add(&mean, 4, 1.0e12f);
    for (int k = 0; k < 4; k++) {
        a = goe_mean_add(&mean, 4, 2.0f);
    }
    TEST_ASSERT_EQUAL_FLOAT(2.0f, a.mean);
    TEST_ASSERT_EQUAL_FLOAT(0.0f, a.variance);
}

static void a_long_run_collects_no_rounding(void) {
    goe_average_t a = {0.0f, 0.0f};
    for (int k = 0; k < 100000; k++) {
        a = goe_mean_add(&mean, 8, 0.1f);
    }
    TEST_ASSERT_FLOAT_WITHIN(1.0e-7f, 0.1f, a.mean);
    TEST_ASSERT_EQUAL_INT(8, mean.count);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(the_first_value_is_its_own_mean);
    RUN_TEST(the_newest_values_are_averaged);
    RUN_TEST(a_place_that_is_none_is_the_first);
    RUN_TEST(an_outlier_leaves_without_a_trace);
    RUN_TEST(a_long_run_collects_no_rounding);
    return UNITY_END();
}
