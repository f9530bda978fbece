/* Texts to the pilot: their order and their rate. SPDX-License-Identifier: MIT */
#include "receiver.h"
#include "screen.h"

#define STEP_US 100000

static wire_t wire;
static receiver_t receiver;
static screen_t screen;
static int64_t now_us;
static char text[64];

void setUp(void) {
    (void)memset(&wire, 0, sizeof wire);
    (void)memset(&screen, 0, sizeof screen);
    screen.on = true;
    now_us = 10000000;
    receiver_open(&receiver, &wire);
}
void tearDown(void) { receiver_close(&receiver, &wire); }

/* The number of texts within so many tenths of a second; the latest is in `text`. */
static int go_on(int steps) {
    int count = 0;
    for (int k = 0; k < steps; k++) {
        mavlink_message_t message;
        now_us += STEP_US;
        screen_go_on(&screen, &wire, now_us);
        while (receiver_next(&receiver, &message)) {
            TEST_ASSERT_EQUAL_UINT32(MAVLINK_MSG_ID_STATUSTEXT, message.msgid);
            (void)memset(text, 0, sizeof text);
            (void)mavlink_msg_statustext_get_text(&message, text);
            count++;
        }
    }
    return count;
}

static void the_most_severe_comes_first(void) {
    screen_show(&screen, SCREEN_ORDER, MAV_SEVERITY_INFO, "end");
    screen_show(&screen, SCREEN_NAVIGATION, MAV_SEVERITY_CRITICAL, "gps");
    screen_show(&screen, SCREEN_DETECTOR, MAV_SEVERITY_WARNING, "detector");
    TEST_ASSERT_EQUAL_INT(1, go_on(1));
    TEST_ASSERT_EQUAL_STRING("gps", text);
    TEST_ASSERT_EQUAL_INT(1, go_on(5));
    TEST_ASSERT_EQUAL_STRING("detector", text);
    TEST_ASSERT_EQUAL_INT(1, go_on(5));
    TEST_ASSERT_EQUAL_STRING("end", text);
    TEST_ASSERT_EQUAL_INT(0, go_on(50));
}

/* One kind of text, ten times a second: one is sent in two seconds, and the last one at the end. */
static void a_kind_that_chatters_is_thinned_to_its_latest(void) {
    int count = 0;
    for (int k = 0; k < 100; k++) {
        screen_show(&screen, SCREEN_ORDER, MAV_SEVERITY_WARNING, "order %d", k);
        count += go_on(1);
    }
    TEST_ASSERT_EQUAL_INT(5, count);
    TEST_ASSERT_EQUAL_INT(1, go_on(30));
    TEST_ASSERT_EQUAL_STRING("order 99", text);
}

static void what_is_too_long_is_cut(void) {
    screen_show(&screen, SCREEN_ORDER, MAV_SEVERITY_WARNING, "%060d", 7);
    TEST_ASSERT_EQUAL_INT(1, go_on(1));
    TEST_ASSERT_EQUAL_INT(49, (int)strlen(text));
}

static void nothing_is_sent_to_nobody_or_from_a_screen_that_is_off(void) {
    screen_show(NULL, SCREEN_ORDER, MAV_SEVERITY_WARNING, "nowhere");
    screen.on = false;
    screen_show(&screen, SCREEN_ORDER, MAV_SEVERITY_WARNING, "off");
    TEST_ASSERT_EQUAL_INT(0, go_on(10));
    screen.on = true;
    wire.autopilot_system = 0;
    screen_show(&screen, SCREEN_ORDER, MAV_SEVERITY_WARNING, "kept");
    TEST_ASSERT_EQUAL_INT(0, go_on(10));
    wire.autopilot_system = 1;
    TEST_ASSERT_EQUAL_INT(1, go_on(10));
    TEST_ASSERT_EQUAL_STRING("kept", text);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(the_most_severe_comes_first);
    RUN_TEST(a_kind_that_chatters_is_thinned_to_its_latest);
    RUN_TEST(what_is_too_long_is_cut);
    RUN_TEST(nothing_is_sent_to_nobody_or_from_a_screen_that_is_off);
    return UNITY_END();
}
