/* Requests for messages, one at a time. SPDX-License-Identifier: MIT */
#include "message_rates.h"
#include "receiver.h"

#define STEP_US 100000

static wire_t wire;
static receiver_t receiver;
static message_rates_t rates;
static int64_t now_us;
static int requested_message;
static double requested_hz;

void setUp(void) {
    (void)memset(&wire, 0, sizeof wire);
    message_rates_clear(&rates);
    now_us = 10000000;
    receiver_open(&receiver, &wire);
    message_rates_want(&rates, 31, "first", 25.0);
    message_rates_want(&rates, 32, "second", 10.0);
}
void tearDown(void) { receiver_close(&receiver, &wire); }

/* The number of requests within so many tenths of a second. */
static int go_on(int steps) {
    int count = 0;
    for (int k = 0; k < steps; k++) {
        mavlink_message_t message;
        now_us += STEP_US;
        message_rates_ask(&rates, &wire, 1, now_us);
        while (receiver_next(&receiver, &message)) {
            TEST_ASSERT_EQUAL_UINT16(MAV_CMD_SET_MESSAGE_INTERVAL, mavlink_msg_command_long_get_command(&message));
            requested_message = (int)mavlink_msg_command_long_get_param1(&message);
            requested_hz = 1e6 / (double)mavlink_msg_command_long_get_param2(&message);
            count++;
        }
    }
    return count;
}

static void expect(int message, double hz) {
    TEST_ASSERT_EQUAL_INT(message, requested_message);
    CHECK_CLOSE(0.01, hz, requested_hz);
}

static void each_message_is_requested_once_if_it_is_accepted(void) {
    TEST_ASSERT_EQUAL_INT(1, go_on(5));
    expect(31, 25.0);
    message_rates_answer(&rates, MAV_RESULT_ACCEPTED);
    TEST_ASSERT_EQUAL_INT(1, go_on(5));
    expect(32, 10.0);
    TEST_ASSERT_FALSE(message_rates_done(&rates));
    message_rates_answer(&rates, MAV_RESULT_ACCEPTED);
    TEST_ASSERT_TRUE(message_rates_done(&rates));
    TEST_ASSERT_EQUAL_INT(0, go_on(50));
}

static void what_is_refused_goes_down_to_5_hz_and_is_given_up(void) {
    static const double expected_hz[] = {25.0, 20.0, 10.0, 5.0};
    for (size_t i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL_INT(1, go_on(1));
        expect(31, expected_hz[i]);
        message_rates_answer(&rates, MAV_RESULT_FAILED);
    }
    TEST_ASSERT_EQUAL_INT(1, go_on(1));
    expect(32, 10.0);
}

static void a_silent_autopilot_gets_five_requests_for_each(void) {
    TEST_ASSERT_EQUAL_INT(10, go_on(150));
    expect(32, 10.0);
    TEST_ASSERT_TRUE(message_rates_done(&rates));
}

/* A refusal is an answer: the tries start again. */
static void a_refusal_begins_the_tries_again(void) {
    TEST_ASSERT_EQUAL_INT(4, go_on(31));
    message_rates_answer(&rates, MAV_RESULT_DENIED);
    TEST_ASSERT_EQUAL_INT(5, go_on(41));
    expect(31, 20.0);
    TEST_ASSERT_EQUAL_INT(1, go_on(10));
    expect(32, 10.0);
}

static void an_answer_that_nobody_awaits_changes_nothing(void) {
    message_rates_answer(&rates, MAV_RESULT_DENIED);
    TEST_ASSERT_EQUAL_INT(1, go_on(5));
    expect(31, 25.0);
    message_rates_answer(&rates, MAV_RESULT_IN_PROGRESS);
    TEST_ASSERT_EQUAL_INT(0, go_on(4));
}

static void a_second_round_keeps_accepted_rates(void) {
    (void)go_on(1);
    message_rates_answer(&rates, MAV_RESULT_FAILED);
    (void)go_on(1);
    message_rates_answer(&rates, MAV_RESULT_ACCEPTED);
    for (int k = 0; k < 2; k++) { /* 10 and 5 Hz */
        (void)go_on(1);
        message_rates_answer(&rates, MAV_RESULT_FAILED);
    }
    TEST_ASSERT_TRUE(message_rates_done(&rates));
    message_rates_repeat(&rates);
    TEST_ASSERT_EQUAL_INT(1, go_on(1));
    expect(31, 20.0);
    message_rates_answer(&rates, MAV_RESULT_ACCEPTED);
    TEST_ASSERT_EQUAL_INT(1, go_on(1));
    expect(32, 10.0);
}

static void no_more_messages_than_fit(void) {
    for (uint32_t i = 0; i < 100; i++) {
        message_rates_want(&rates, i, "more", 1.0);
    }
    TEST_ASSERT_EQUAL_UINT(MESSAGE_RATES_MAX, rates.count);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(each_message_is_requested_once_if_it_is_accepted);
    RUN_TEST(what_is_refused_goes_down_to_5_hz_and_is_given_up);
    RUN_TEST(a_silent_autopilot_gets_five_requests_for_each);
    RUN_TEST(a_refusal_begins_the_tries_again);
    RUN_TEST(an_answer_that_nobody_awaits_changes_nothing);
    RUN_TEST(a_second_round_keeps_accepted_rates);
    RUN_TEST(no_more_messages_than_fit);
    return UNITY_END();
}
