/* The autopilot's clock, with and without answers to questions. SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>

#include "check.h"
#include "clock_sync.h"

#define OFFSET_US 123456789 /* lead of the autopilot's clock over the own one */
#define ONE_WAY_SD_US 5000.0

static check_random_t any;
static clock_sync_t sync;

void setUp(void) {
    any = check_random_start("companion clock");
    clock_sync_reset(&sync);
}
void tearDown(void) {}

static int64_t delay_us(void) { return 300 + (int64_t)(-2000.0 * log(check_random_between(&any, 1e-6, 1.0))); }

/* A question at this own time; question and answer take random times. The autopilot's clock gains `ppm`. */
static bool exchange(int64_t own_us, int64_t offset_us, double ppm) {
    const int64_t there_us = delay_us(), back_us = delay_us();
    const int64_t at_us = own_us + there_us;
    const int64_t answered_us = at_us + offset_us + (int64_t)(ppm * 1e-6 * (double)at_us);
    return clock_sync_answer(&sync, own_us, at_us + back_us, answered_us);
}

static double off_us(int64_t own_us, int64_t offset_us, double ppm) {
    const double truth = (double)own_us + (double)offset_us + ppm * 1e-6 * (double)own_us;
    return (double)clock_sync_autopilot_us(&sync, own_us) - truth;
}

static void nothing_is_known_before_the_first_message(void) {
    TEST_ASSERT_FALSE(clock_sync_known(&sync));
    clock_sync_one_way(&sync, 1000, 1000 + OFFSET_US - 400);
    TEST_ASSERT_TRUE(clock_sync_known(&sync));
}

static void without_answers_the_least_delay_of_the_poses_replaces_the_clock(void) {
    int64_t least_us = INT64_MAX;
    for (int k = 0; k < 400; k++) {
        const int64_t own_us = 20000 * k, late_us = delay_us();
        least_us = late_us < least_us ? late_us : least_us;
        clock_sync_one_way(&sync, own_us + late_us, own_us + OFFSET_US);
    }
    TEST_ASSERT_EQUAL_INT64(OFFSET_US - least_us, clock_sync_autopilot_us(&sync, 0));
    TEST_ASSERT_TRUE(clock_sync_sd_us(&sync, ONE_WAY_SD_US) >= ONE_WAY_SD_US);
}

/* The truth is within two sigmas, for clocks that drift apart like crystals, over ten minutes. */
static void answers_find_the_clock_within_its_sigma(void) {
    const double ppms[] = {0.0, 40.0, -40.0};
    for (size_t i = 0; i < sizeof ppms / sizeof ppms[0]; i++) {
        double worst = 0.0;
        clock_sync_reset(&sync);
        for (int k = 0; k < 2400; k++) {
            TEST_ASSERT_TRUE(exchange(250000 * (int64_t)k, OFFSET_US, ppms[i]));
            if (k > 20) {
                const int64_t now_us = 250000 * (int64_t)k + 100000;
                check_worst(&worst, off_us(now_us, OFFSET_US, ppms[i]) / clock_sync_sd_us(&sync, ONE_WAY_SD_US));
                TEST_ASSERT_TRUE(clock_sync_sd_us(&sync, ONE_WAY_SD_US) < 1000.0);
            }
        }
        check_report("worst error in sigmas", worst);
        TEST_ASSERT_TRUE(worst < 3.0);
    }
}

static void poses_do_not_move_a_clock_that_answers_found(void) {
    TEST_ASSERT_TRUE(exchange(0, OFFSET_US, 0.0));
    const int64_t found_us = clock_sync_autopilot_us(&sync, 0);
    clock_sync_one_way(&sync, 20000, 20000 + OFFSET_US + 50000);
    TEST_ASSERT_EQUAL_INT64(found_us, clock_sync_autopilot_us(&sync, 0));
}

static void one_strange_answer_is_passed_over_and_three_are_a_jump(void) {
    for (int k = 0; k < 20; k++) {
        TEST_ASSERT_TRUE(exchange(250000 * (int64_t)k, OFFSET_US, 0.0));
    }
    TEST_ASSERT_TRUE(exchange(5000000, OFFSET_US - 100000000, 0.0));
    CHECK_CLOSE(5000.0, 0.0, off_us(5000000, OFFSET_US, 0.0));
    TEST_ASSERT_TRUE(exchange(5250000, OFFSET_US, 0.0));
    TEST_ASSERT_TRUE(exchange(5500000, 0, 0.0));
    TEST_ASSERT_TRUE(exchange(5750000, 0, 0.0));
    TEST_ASSERT_FALSE(exchange(6000000, 0, 0.0));
    TEST_ASSERT_FALSE(clock_sync_known(&sync));
    TEST_ASSERT_TRUE(exchange(6250000, 0, 0.0));
    CHECK_CLOSE(10000.0, 0.0, off_us(6250000, 0, 0.0));
}

/* A link that stalls for half a second contains no information on the clock, and an answer before its question is ignored. */
static void slow_and_impossible_answers_change_nothing(void) {
    TEST_ASSERT_TRUE(exchange(0, OFFSET_US, 0.0));
    const clock_sync_t before = sync;
    TEST_ASSERT_TRUE(clock_sync_answer(&sync, 1000000, 3000000, 500));
    TEST_ASSERT_TRUE(clock_sync_answer(&sync, 1000000, 900000, 500));
    TEST_ASSERT_EQUAL_MEMORY(&before, &sync, sizeof sync);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(nothing_is_known_before_the_first_message);
    RUN_TEST(without_answers_the_least_delay_of_the_poses_replaces_the_clock);
    RUN_TEST(answers_find_the_clock_within_its_sigma);
    RUN_TEST(poses_do_not_move_a_clock_that_answers_found);
    RUN_TEST(one_strange_answer_is_passed_over_and_three_are_a_jump);
    RUN_TEST(slow_and_impossible_answers_change_nothing);
    return UNITY_END();
}
