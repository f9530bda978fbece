/* The samples' estimating thread, port/examples/scripted_flight. SPDX-License-Identifier: MIT */
#include <string.h>

#include "scripted_estimator.h"
#include "unity.h"

#define ARRIVAL_TICK 5u /* of the first image, which was taken at tick 0 */
#define LATE_TICK 10u   /* of the second one, which was taken at tick 5 */

static scripted_estimator_t estimator;
static char line[SCRIPTED_LINE];

static uint32_t clock_now;
static uint32_t next_time(void) { return clock_now += 3u; }

void setUp(void) {
    clock_now = UINT32_MAX - 3u; /* about to wrap */
    TEST_ASSERT_TRUE(scripted_start(&estimator, next_time, line));
}
void tearDown(void) {}

/* Whether a line was printed. */
static bool give(uint32_t tick, scripted_kind_t kind) {
    scripted_message_t message;
    TEST_ASSERT_TRUE(scripted_message(tick, kind, &message));
    return scripted_take(&estimator, &message, line);
}

static void give_poses(uint32_t begin, uint32_t end) {
    for (uint32_t tick = begin; tick < end; tick++) {
        (void)give(tick, SCRIPTED_POSE);
    }
}

static void test_an_image_waits_for_its_pose(void) {
    give_poses(0u, 4u);
    (void)give(LATE_TICK, SCRIPTED_IMAGE);
    TEST_ASSERT_EQUAL_UINT32(0u, estimator.frame.calls);
    TEST_ASSERT_TRUE(estimator.image_waits);
    (void)give(4u, SCRIPTED_POSE);
    TEST_ASSERT_EQUAL_UINT32(0u, estimator.frame.calls);
    give_poses(5u, 7u);
    TEST_ASSERT_EQUAL_UINT32(1u, estimator.frame.calls);
    TEST_ASSERT_FALSE(estimator.image_waits);
    TEST_ASSERT_EQUAL_UINT32(0u, estimator.dropped);
}

static void test_an_image_that_is_overtaken_is_counted(void) {
    give_poses(0u, 4u);
    (void)give(LATE_TICK, SCRIPTED_IMAGE);
    (void)give(LATE_TICK + SCRIPTED_IMAGE_TICKS, SCRIPTED_IMAGE);
    TEST_ASSERT_EQUAL_UINT32(1u, estimator.dropped);
    give_poses(4u, 12u);
    TEST_ASSERT_EQUAL_UINT32(1u, estimator.frame.calls);
}

static void test_an_image_that_is_refused_is_counted(void) {
    (void)give(ARRIVAL_TICK, SCRIPTED_IMAGE); /* no pose at all */
    TEST_ASSERT_EQUAL_UINT32(1u, estimator.dropped);
    TEST_ASSERT_FALSE(estimator.image_waits);
}

/* The assessment is made and reported although no image ever comes. */
static void test_a_silent_detector_is_reported(void) {
    unsigned lines = 0;
    bool alive = false;
    for (uint32_t tick = 0u; tick <= 100u; tick++) {
        (void)give(tick, SCRIPTED_POSE);
        alive = alive || estimator.assessment.detector_alive;
        if (tick % SCRIPTED_ASSESS_TICKS == 0u && give(tick, SCRIPTED_TIMER)) {
            lines++;
            TEST_ASSERT_NOT_NULL(strstr(line, ": nothing known; no detector;"));
        }
    }
    TEST_ASSERT_EQUAL_UINT(3u, lines);
    TEST_ASSERT_FALSE(alive);
    TEST_ASSERT_EQUAL_UINT32(21u, estimator.assess.calls);
}

/* The whole script: an order, a silence of the detector. */
static void test_the_flight(void) {
    unsigned silent = 0, back = 0, left = 0;
    for (uint32_t tick = 0u; tick < SCRIPTED_TICKS; tick++) {
        for (int kind = SCRIPTED_POSE; kind < SCRIPTED_END; kind++) {
            scripted_message_t message;
            const bool was_alive = estimator.assessment.detector_alive;
            if (scripted_message(tick, (scripted_kind_t)kind, &message)) {
                (void)scripted_take(&estimator, &message, line);
            }
            silent += was_alive && !estimator.assessment.detector_alive;
            back += !was_alive && estimator.assessment.detector_alive;
            left += estimator.assessment.action == GOE_FLIGHT_LEFT;
        }
    }
    TEST_ASSERT_EQUAL_UINT(1u, silent);
    TEST_ASSERT_EQUAL_UINT(2u, back);
    TEST_ASSERT_TRUE(left > 0u);
    TEST_ASSERT_EQUAL_UINT32(SCRIPTED_TICKS / SCRIPTED_ASSESS_TICKS, estimator.assess.calls);
    TEST_ASSERT_EQUAL_INT(GOE_FLIGHT_NONE, estimator.assessment.action);
    TEST_ASSERT_EQUAL_UINT32(3u, scripted_mean(&estimator.frame));
    TEST_ASSERT_EQUAL_UINT32(3u, estimator.assess.most);
}

static void test_the_end_is_no_message(void) {
    scripted_message_t message;
    TEST_ASSERT_FALSE(scripted_message(0u, SCRIPTED_END, &message));
    TEST_ASSERT_FALSE(scripted_take(&estimator, &message, line));
    TEST_ASSERT_EQUAL_UINT32(0u, scripted_mean(&estimator.frame));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_an_image_waits_for_its_pose);
    RUN_TEST(test_an_image_that_is_overtaken_is_counted);
    RUN_TEST(test_an_image_that_is_refused_is_counted);
    RUN_TEST(test_a_silent_detector_is_reported);
    RUN_TEST(test_the_flight);
    RUN_TEST(test_the_end_is_no_message);
    return UNITY_END();
}
