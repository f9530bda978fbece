/* Capture time by three clocks. SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "goe_clock.h"

#define OFFSET_US 123456789u /* of the autopilot's clock before the sender's */
#define DELAY_US 20000u      /* least, from sending to arrival */

static check_random_t any;
static goe_flight_clock_t flight_clock;
static goe_flight_settings_t settings;

void setUp(void) {
    any = check_random_start("flight clock");
    memset(&flight_clock, 0, sizeof flight_clock);
    goe_flight_settings_default(&settings);
    settings.delay_s = 1e-6f * (float)DELAY_US;
}
void tearDown(void) {}

/* A frame that was exposed at this time of the sender's clock, sent 60 ms later, and `late_us` more than the least on its way. */
static goe_flight_frame_t message(uint32_t exposed_us, uint32_t late_us) {
    goe_flight_frame_t frame;
    memset(&frame, 0, sizeof frame);
    frame.time_base = GOE_FLIGHT_SENDER_CLOCK;
    frame.capture_us = exposed_us;
    frame.sent_us = exposed_us + 60000u;
    frame.arrival_us = frame.sent_us + OFFSET_US + DELAY_US + late_us;
    return frame;
}

static int32_t off_us(uint32_t exposed_us, uint32_t late_us, uint32_t *sd_us) {
    const goe_flight_frame_t frame = message(exposed_us, late_us);
    const uint32_t capture_us = goe_flight_clock_capture(&flight_clock, &frame, &settings, sd_us);
    return (int32_t)(capture_us - (exposed_us + OFFSET_US));
}

static uint32_t jitter_us(void) { return (uint32_t)(-15000.0 * log(check_random_between(&any, 1e-6, 1.0))); }

/* [flight.delay_sd_s] */
static void the_autopilots_own_clock_is_taken_as_it_is(void) {
    uint32_t sd_us;
    goe_flight_frame_t frame = message(500u, 0u);
    frame.time_base = GOE_FLIGHT_AUTOPILOT_CLOCK;
    TEST_ASSERT_EQUAL_UINT32(500u, goe_flight_clock_capture(&flight_clock, &frame, &settings, &sd_us));
    TEST_ASSERT_EQUAL_UINT32(5000u, sd_us); /* settings.delay_sd_s */
    frame.time_sd_us = 700u;
    (void)goe_flight_clock_capture(&flight_clock, &frame, &settings, &sd_us);
    TEST_ASSERT_EQUAL_UINT32(700u, sd_us);
}

static void an_age_counts_back_from_the_arrival(void) {
    uint32_t sd_us;
    goe_flight_frame_t frame = message(0u, 0u);
    frame.time_base = GOE_FLIGHT_AGE;
    frame.capture_us = 60000u;
    frame.time_sd_us = 3000u;
    TEST_ASSERT_EQUAL_UINT32(OFFSET_US, goe_flight_clock_capture(&flight_clock, &frame, &settings, &sd_us));
    TEST_ASSERT_UINT32_WITHIN(2u, 5831u, sd_us); /* 3 and 5 ms */
}

/* [flight.delay_s] The least delay is found, also over the wrap of the sender's clock, and its uncertainty is honest. */
static void the_least_delay_gives_the_offset(void) {
    uint32_t sd_us = 0u;
    int within = 0;
    const uint32_t start_us = 0xFFFFFFFFu - 5000000u;
    for (uint32_t k = 0; k < 300u; k++) {
        const int32_t error_us = off_us(start_us + 100000u * k, jitter_us(), &sd_us);
        within += abs(error_us) <= 2 * (int)sd_us ? 1 : 0;
        if (k > 50u) {
            TEST_ASSERT_INT32_WITHIN(2000, 0, error_us);
            TEST_ASSERT_UINT32_WITHIN(100u, 5099u, sd_us);
        }
    }
    TEST_ASSERT_TRUE(within >= 280);
}

/* A clock that runs 50 ppm too fast. */
static void a_drift_is_followed(void) {
    uint32_t sd_us;
    int32_t worst_us = 0;
    for (uint32_t k = 0; k < 6000u; k++) { /* ten minutes: 30 ms of drift */
        const uint32_t exposed_us = 100000u * k;
        goe_flight_frame_t frame = message(exposed_us, jitter_us());
        frame.arrival_us += k * 5u;
        const uint32_t capture_us = goe_flight_clock_capture(&flight_clock, &frame, &settings, &sd_us);
        const int32_t error_us = (int32_t)(capture_us - (exposed_us + OFFSET_US + k * 5u));
        worst_us = k > 100u && abs(error_us) > worst_us ? abs(error_us) : worst_us;
    }
    TEST_ASSERT_TRUE(worst_us < 3000);
}

/* The sender starts again with another time: after a few messages that is accepted. */
static void another_clock_is_noticed(void) {
    uint32_t sd_us;
    for (uint32_t k = 0; k < 50u; k++) {
        (void)off_us(100000u * k, jitter_us(), &sd_us);
    }
    static const uint32_t restarts_us[] = {400000000u, 0u, 300000000u};
    for (int n = 0; n < 3; n++) {
        const uint32_t restart_us = restarts_us[n];
        int32_t error_us = 0;
        for (uint32_t k = 0; k < 20u; k++) {
            goe_flight_frame_t frame = message(restart_us + 100000u * k, 0u);
            frame.arrival_us = 900000000u + 100000u * k;
            const uint32_t capture_us = goe_flight_clock_capture(&flight_clock, &frame, &settings, &sd_us);
            error_us = (int32_t)(capture_us - (frame.arrival_us - 60000u - DELAY_US));
        }
        TEST_ASSERT_INT32_WITHIN(100, 0, error_us);
    }
}

static void one_stuck_message_is_no_other_clock(void) {
    uint32_t sd_us;
    for (uint32_t k = 0; k < 50u; k++) {
        (void)off_us(100000u * k, jitter_us(), &sd_us);
    }
    (void)off_us(5000000u, 3000000u, &sd_us);
    TEST_ASSERT_INT32_WITHIN(3000, 0, off_us(5100000u, 1000u, &sd_us));
}

/* GIVEN messages that were stuck for up to three seconds, and come all at once THEN they are of no other clock: their lateness falls. The
 * parts of one image are of no other clock either. */
static void messages_that_come_at_once_are_no_other_clock(void) {
    for (int parts = 0; parts < 2; parts++) {
        uint32_t sd_us;
        memset(&flight_clock, 0, sizeof flight_clock);
        for (uint32_t k = 0; k < 50u; k++) {
            (void)off_us(100000u * k, jitter_us(), &sd_us);
        }
        for (uint32_t k = 0; k < 30u; k++) {
            const uint32_t exposed_us = 5000000u + (parts ? 0u : 100000u * k);
            const int32_t error_us = off_us(exposed_us, 8000000u + 1000u * k - exposed_us, &sd_us);
            TEST_ASSERT_INT32_WITHIN(3000, 0, error_us);
        }
        TEST_ASSERT_INT32_WITHIN(3000, 0, off_us(8100000u, 1000u, &sd_us));
    }
}

/* A least delay of before a long silence says nothing, however long the silence: not even where the difference of its times wraps. */
static void a_clock_is_forgotten_in_a_silence(void) {
    static const uint32_t silence_s[] = {90u, 110u, 2400u, 4295u};
    for (int n = 0; n < 4; n++) {
        uint32_t sd_us;
        memset(&flight_clock, 0, sizeof flight_clock);
        for (uint32_t k = 0; k < 30u; k++) {
            (void)off_us(100000u * k, 0u, &sd_us);
        }
        for (uint32_t s = 0; s < silence_s[n]; s++) {
            goe_flight_clock_bury(&flight_clock, 3000000u + OFFSET_US + DELAY_US + 1000000u * s);
        }
        const uint32_t later_us = 3000000u + 1000000u * silence_s[n];
        TEST_ASSERT_EQUAL_INT32(n == 0 ? 0 : 120000, off_us(later_us, 120000u, &sd_us));
        TEST_ASSERT_EQUAL_INT32(n == 0 ? 0 : 120000, off_us(later_us + 100000u, 120000u, &sd_us));
    }
}

/* A two-way offset is not forgotten. */
static void a_two_way_offset_outlasts_a_silence(void) {
    uint32_t sd_us;
    goe_flight_clock_sync(&flight_clock, OFFSET_US, 200u);
    for (uint32_t s = 0; s < 200u; s++) {
        goe_flight_clock_bury(&flight_clock, 1000000u * s);
    }
    TEST_ASSERT_EQUAL_INT32(0, off_us(77u, 90000u, &sd_us));
}

static void a_two_way_offset_replaces_the_estimate(void) {
    uint32_t sd_us;
    goe_flight_clock_sync(&flight_clock, OFFSET_US, 200u);
    TEST_ASSERT_EQUAL_INT32(0, off_us(77u, 90000u, &sd_us));
    TEST_ASSERT_UINT32_WITHIN(1u, 200u, sd_us);
    goe_flight_clock_sync(&flight_clock, 0u, UINT32_MAX);
    TEST_ASSERT_EQUAL_INT32(1000, off_us(77u, 1000u, &sd_us));
}

/* While few messages have come their mean lateness is a part of the uncertainty. */
static void a_clock_that_is_hardly_known_says_so(void) {
    double excess_us = 0.0;
    for (uint32_t k = 0; k < 12u; k++) {
        uint32_t sd_us;
        const uint32_t late_us = k % 2u == 0u ? 0u : 4000u * k;
        const double share = 1.0 / (double)(k + 1u);
        (void)off_us(100000u * k, late_us, &sd_us);
        excess_us += share * ((double)late_us - excess_us);
        const double unsettled_us = k + 1u < 8u ? excess_us : 0.0;
        TEST_ASSERT_UINT32_WITHIN(2u, (uint32_t)sqrt(26.0e6 + unsettled_us * unsettled_us), sd_us);
    }
}

/* A least delay counts for ten seconds, and after twenty no more. */
static void a_least_delay_is_forgotten(void) {
    for (uint32_t k = 0; k < 300u; k++) {
        uint32_t sd_us;
        const int32_t error_us = off_us(100000u * k, k == 0u ? 0u : 5000u, &sd_us);
        if (k <= 99u) {
            TEST_ASSERT_EQUAL_INT32(0, error_us);
        }
        if (k > 202u) {
            TEST_ASSERT_EQUAL_INT32(5000, error_us);
        }
    }
}

/* Three messages in a row of another clock are believed, two are not; whichever way the clock was set. */
static void another_clock_is_believed_with_the_third_message(void) {
    uint32_t sd_us;
    for (uint32_t k = 0; k < 30u; k++) {
        (void)off_us(100000u * k, 0u, &sd_us);
    }
    for (int n = 0; n < 2; n++) {
        TEST_ASSERT_EQUAL_INT32(0, off_us(3000000u, 2000000u, &sd_us));
        TEST_ASSERT_EQUAL_INT32(0, off_us(3100000u, 2000000u, &sd_us));
        TEST_ASSERT_EQUAL_INT32(0, off_us(3200000u, 0u, &sd_us));
    }
    TEST_ASSERT_EQUAL_INT32(0, off_us(3300000u, 2000000u, &sd_us));
    TEST_ASSERT_EQUAL_INT32(0, off_us(3400000u, 2000000u, &sd_us));
    TEST_ASSERT_EQUAL_INT32(2000000, off_us(3500000u, 2000000u, &sd_us));
    for (uint32_t k = 36u; k < 120u; k++) { /* and for as long as any */
        TEST_ASSERT_EQUAL_INT32(2000000, off_us(100000u * k, k == 36u ? 2000000u : 2003000u, &sd_us));
    }
}

/* GIVEN a link whose messages are late by up to most_us WHEN the sender's clock is set back by 2 s THEN that is believed in at most so many
 * messages, ten a second. */
static void check_set_back(double most_us, uint32_t messages) {
    for (int run = 0; run < 50; run++) {
        uint32_t sd_us;
        memset(&flight_clock, 0, sizeof flight_clock);
        for (uint32_t k = 0; k < 150u; k++) {
            (void)off_us(100000u * k, (uint32_t)check_random_between(&any, 0.0, most_us), &sd_us);
        }
        uint32_t k = 150u;
        int32_t error_us = 0;
        for (; k < 250u && error_us < 1000000; k++) {
            error_us = off_us(100000u * k, 2000000u + (uint32_t)check_random_between(&any, 0.0, most_us), &sd_us);
        }
        TEST_ASSERT_TRUE(k - 150u <= messages);
    }
}

static void a_clock_that_was_set_back_is_believed_on_a_jittery_link(void) {
    check_set_back(20000.0, 5u);
    check_set_back(100000.0, 12u);
    check_set_back(300000.0, 30u);
}

/* GIVEN messages that were stuck for three seconds THEN they are of no other clock while they come faster than they were sent, at twice or at ten
 * times the rate, and on a link with much jitter. */
static void messages_that_come_faster_are_no_other_clock(void) {
    static const uint32_t step_us[] = {50000u, 10000u};
    for (int n = 0; n < 4; n++) {
        const double most_us = n < 2 ? 15000.0 : 300000.0;
        uint32_t sd_us;
        uint32_t late_us = 3000000u;
        memset(&flight_clock, 0, sizeof flight_clock);
        for (uint32_t k = 0; k < 150u; k++) {
            (void)off_us(100000u * k, (uint32_t)check_random_between(&any, 0.0, most_us), &sd_us);
        }
        for (uint32_t k = 150u; late_us > 100000u; k++) {
            TEST_ASSERT_INT32_WITHIN(20000, 0, off_us(100000u * k, late_us, &sd_us));
            late_us -= 100000u - step_us[n % 2];
        }
    }
}

/* GIVEN a least delay of the interval before WHEN a stuck message comes THEN that delay still counts. */
static void a_stuck_message_discards_no_least_delay(void) {
    uint32_t sd_us;
    for (uint32_t k = 0; k < 105u; k++) {
        (void)off_us(100000u * k, k < 100u ? 0u : 50000u, &sd_us);
    }
    TEST_ASSERT_EQUAL_INT32(0, off_us(10500000u, 50000u, &sd_us));
    TEST_ASSERT_EQUAL_INT32(0, off_us(10600000u, 3000000u, &sd_us));
    TEST_ASSERT_EQUAL_INT32(0, off_us(13700000u, 50000u, &sd_us));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(a_clock_that_is_hardly_known_says_so);
    RUN_TEST(a_least_delay_is_forgotten);
    RUN_TEST(another_clock_is_believed_with_the_third_message);
    RUN_TEST(the_autopilots_own_clock_is_taken_as_it_is);
    RUN_TEST(an_age_counts_back_from_the_arrival);
    RUN_TEST(the_least_delay_gives_the_offset);
    RUN_TEST(a_drift_is_followed);
    RUN_TEST(another_clock_is_noticed);
    RUN_TEST(one_stuck_message_is_no_other_clock);
    RUN_TEST(messages_that_come_at_once_are_no_other_clock);
    RUN_TEST(a_clock_that_was_set_back_is_believed_on_a_jittery_link);
    RUN_TEST(messages_that_come_faster_are_no_other_clock);
    RUN_TEST(a_stuck_message_discards_no_least_delay);
    RUN_TEST(a_clock_is_forgotten_in_a_silence);
    RUN_TEST(a_two_way_offset_outlasts_a_silence);
    RUN_TEST(a_two_way_offset_replaces_the_estimate);
    return UNITY_END();
}
