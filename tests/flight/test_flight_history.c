/* Pose history against analytic flights. SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "check.h"
#include "goe_history.h"

#define RAD_PER_DEG 0.017453292519943295

static goe_flight_history_t history;
static goe_flight_history_pose_t pose;

void setUp(void) { goe_flight_history_clear(&history); }
void tearDown(void) {}

/* A turn about one axis at a constant rate, and a straight line. */
static void attitude_at(double t_s, double rate_deg_s, float q[4]) {
    const double half = 0.5 * RAD_PER_DEG * rate_deg_s * t_s;
    q[0] = (float)cos(half);
    q[1] = (float)(0.6 * sin(half));
    q[2] = 0.0f;
    q[3] = (float)(0.8 * sin(half));
}

static void position_at(double t_s, float ned_m[3]) {
    ned_m[0] = (float)(20.0 * t_s);
    ned_m[1] = (float)(-3.0 * t_s);
    ned_m[2] = (float)(-50.0 + 2.0 * t_s);
}

static void feed(uint32_t start_us, uint32_t step_us, int samples, double rate_deg_s) {
    for (int k = 0; k < samples; k++) {
        float q[4];
        float ned_m[3];
        attitude_at(1e-6 * step_us * k, rate_deg_s, q);
        position_at(1e-6 * step_us * k, ned_m);
        if (k % 3 == 1) { /* the same attitude by the other sign */
            for (int i = 0; i < 4; i++) {
                q[i] = -q[i];
            }
        }
        TEST_ASSERT_TRUE(goe_flight_history_add_attitude(&history, start_us + step_us * (uint32_t)k, q));
        TEST_ASSERT_TRUE(goe_flight_history_add_position(&history, start_us + step_us * (uint32_t)k, ned_m));
    }
}

/* By how much the attitude is off, degrees: twice the chord between the quaternions, whichever their signs. */
static double turned_deg(const float a[4], const float b[4]) {
    double apart = 0.0;
    double together = 0.0;
    for (int i = 0; i < 4; i++) {
        apart += pow((double)a[i] - (double)b[i], 2.0);
        together += pow((double)a[i] + (double)b[i], 2.0);
    }
    return 2.0 * sqrt(fmin(apart, together)) / RAD_PER_DEG;
}

static void check_flight(uint32_t start_us, uint32_t step_us, double rate_deg_s, double attitude_deg) {
    feed(start_us, step_us, 200, rate_deg_s);
    const double newest_s = 199e-6 * step_us;
    for (double back_s = 0.0; back_s < 0.55; back_s += 0.0131) {
        float q[4];
        float ned_m[3];
        const uint32_t at_us = start_us + (uint32_t)((newest_s - back_s) * 1e6 + 0.5);
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_history_at(&history, at_us, &pose));
        attitude_at(newest_s - back_s, rate_deg_s, q);
        position_at(newest_s - back_s, ned_m);
        for (int i = 0; i < 3; i++) {
            CHECK_CLOSE(1e-4, ned_m[i], pose.ned_m[i]);
        }
        TEST_ASSERT_TRUE(turned_deg(q, pose.q) < attitude_deg);
        CHECK_CLOSE(0.01 * rate_deg_s, rate_deg_s, pose.rate_deg_s);
    }
}

static void a_steady_flight_is_found_again(void) { check_flight(1000u, 4000u, 90.0, 2e-3); }
static void slow_samples_too(void) { check_flight(0u, 100000u, 60.0, 2e-3); }
static void the_clock_may_wrap(void) { check_flight(0xFFFFFFFFu - 500000u, 4000u, 90.0, 2e-3); }

/* A sine of the pitch: 10 degrees, 1 Hz. */
static void sine_at(uint32_t at_us, float q[4]) {
    const double half = 0.5 * RAD_PER_DEG * 10.0 * sin(2.0 * 3.14159265358979 * 1e-6 * at_us);
    q[0] = (float)cos(half);
    q[1] = 0.0f;
    q[2] = (float)sin(half);
    q[3] = 0.0f;
}

static void feed_sine(uint32_t at_us) {
    const float ned_m[3] = {0.0f, 0.0f, 0.0f};
    float q[4];
    sine_at(at_us, q);
    TEST_ASSERT_TRUE(goe_flight_history_add_attitude(&history, at_us, q));
    TEST_ASSERT_TRUE(goe_flight_history_add_position(&history, at_us, ned_m));
}

/* A sine of the pitch: 10 degrees, 1 Hz. Between samples 100 ms apart a straight line is off by 0.49 degrees at most; the cubic
 * by a tenth of that, and the parabola at the newest samples by less than half. The error is reported. */
static void a_bent_flight_is_followed(void) {
    double cubic_deg = 0.0;
    double parabola_deg = 0.0;
    double missed[2] = {0.0, 0.0};
    double reported[2] = {0.0, 0.0};
    for (int k = 0; k < 40; k++) {
        feed_sine(100000u * (uint32_t)k);
        for (int back = 1; k > 5 && back <= 2; back++) {
            const uint32_t at_us = 100000u * (uint32_t)k - 100000u * (uint32_t)back + 50000u;
            float truth[4];
            sine_at(at_us, truth);
            TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_history_at(&history, at_us, &pose));
            const double off_deg = turned_deg(truth, pose.q);
            check_worst(back == 1 ? &parabola_deg : &cubic_deg, off_deg);
            missed[back - 1] += off_deg * off_deg;
            reported[back - 1] += pow((double)pose.spread_deg, 2.0);
        }
    }
    check_report("cubic, degrees", cubic_deg);
    check_report("parabola, degrees", parabola_deg);
    for (int i = 0; i < 2; i++) {
        check_report("missed over reported, rms", sqrt(missed[i] / reported[i]));
        TEST_ASSERT_TRUE(missed[i] < reported[i] && missed[i] > 0.1 * reported[i]);
    }
    TEST_ASSERT_TRUE(cubic_deg < 0.06);
    TEST_ASSERT_TRUE(parabola_deg < 0.25);
}

/* The reported error follows the bend of the whole history. The same sine, sampled so that every other sample is a zero crossing: around
 * these, three samples lie on a line, and the attitude between them is off all the same. */
static void samples_on_a_line_do_not_lower_the_reported_error(void) {
    double least_deg = 1.0e9;
    double most_deg = 0.0;
    for (int k = 0; k < 40; k++) {
        feed_sine(250000u * (uint32_t)k);
        if (k > 5) {
            TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_history_at(&history, 250000u * (uint32_t)k - 125000u, &pose));
            least_deg = fmin(least_deg, (double)pose.spread_deg);
            most_deg = fmax(most_deg, (double)pose.spread_deg);
        }
    }
    check_report("least reported error, degrees", least_deg);
    check_report("most reported error, degrees", most_deg);
    TEST_ASSERT_TRUE(least_deg > 0.5 * most_deg && most_deg < 5.0);
}

static void samples_are_thinned_to_20_ms(void) {
    feed(0u, 1000u, 2000, 10.0);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_SAMPLES, history.attitude_count);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_history_at(&history, 1999000u, &pose));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_history_at(&history, 1999000u - 600000u, &pose));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_TOO_NEW, goe_flight_history_at(&history, 1999001u, &pose));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_TOO_OLD, goe_flight_history_at(&history, 1999000u - 700000u, &pose));
}

static void nothing_is_known_before_both(void) {
    const float q[4] = {1.0f, 0.0f, 0.0f, 0.0f};
    TEST_ASSERT_EQUAL(GOE_FLIGHT_NO_POSE, goe_flight_history_at(&history, 0u, &pose));
    TEST_ASSERT_TRUE(goe_flight_history_add_attitude(&history, 10u, q));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_NO_POSE, goe_flight_history_at(&history, 10u, &pose));
}

static void old_samples_are_refused(void) {
    const float ned_m[3] = {1.0f, 2.0f, 3.0f};
    feed(0u, 20000u, 10, 10.0);
    const goe_flight_history_t before = history;
    TEST_ASSERT_FALSE(goe_flight_history_add_position(&history, 180000u, ned_m));
    TEST_ASSERT_FALSE(goe_flight_history_add_position(&history, 100000u, ned_m));
    TEST_ASSERT_EQUAL_MEMORY(&before, &history, sizeof history);
}

static void nothing_is_made_up_in_a_gap(void) {
    float q[4];
    float ned_m[3];
    feed(0u, 20000u, 10, 10.0);
    attitude_at(1.0, 10.0, q);
    position_at(1.0, ned_m);
    TEST_ASSERT_TRUE(goe_flight_history_add_attitude(&history, 1000000u, q));
    TEST_ASSERT_TRUE(goe_flight_history_add_position(&history, 1000000u, ned_m));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_TOO_OLD, goe_flight_history_at(&history, 600000u, &pose));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_history_at(&history, 1000000u, &pose));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_history_at(&history, 150000u, &pose));
}

static void a_jump_moves_older_poses(void) {
    const float jump_ned_m[3] = {5.0f, -7.0f, 0.5f};
    feed(0u, 20000u, 30, 10.0);
    goe_flight_history_shift(&history, jump_ned_m);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_history_at(&history, 300000u, &pose));
    float ned_m[3];
    position_at(0.3, ned_m);
    for (int i = 0; i < 3; i++) {
        CHECK_CLOSE(1e-4, ned_m[i] + jump_ned_m[i], pose.ned_m[i]);
    }
}

/* Attitude and position come at rates of their own. */
static void the_rings_are_independent(void) {
    for (uint32_t k = 0; k < 400; k++) {
        float q[4];
        float ned_m[3];
        attitude_at(0.004 * k, 30.0, q);
        position_at(0.004 * k, ned_m);
        TEST_ASSERT_TRUE(goe_flight_history_add_attitude(&history, 4000u * k, q));
        if (k % 25u == 0u) {
            TEST_ASSERT_TRUE(goe_flight_history_add_position(&history, 4000u * k, ned_m));
        }
    }
    TEST_ASSERT_EQUAL(GOE_FLIGHT_TOO_NEW, goe_flight_history_at(&history, 1510000u, &pose));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_history_at(&history, 1490000u, &pose));
    CHECK_CLOSE(1e-3, 29.8, pose.ned_m[0]);
}

/* The attitude is that of its own samples, and times newer or older than either ring are not known. */
static void each_ring_answers_for_itself(void) {
    float truth[4];
    for (int other = 0; other < 2; other++) {
        setUp();
        for (uint32_t k = 0; k <= 30u; k++) {
            float q[4];
            float ned_m[3];
            attitude_at(0.02 * k, 30.0, q);
            position_at(0.02 * k, ned_m);
            if (!other || k % 5u == 0u) {
                TEST_ASSERT_TRUE(goe_flight_history_add_attitude(&history, 20000u * k, q));
            }
            if (other || k % 5u == 0u) {
                TEST_ASSERT_TRUE(goe_flight_history_add_position(&history, 20000u * k, ned_m));
            }
        }
        for (uint32_t at_us = 110000u; at_us <= 600000u; at_us += 7000u) {
            TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_history_at(&history, at_us, &pose));
            attitude_at(1e-6 * at_us, 30.0, truth);
            TEST_ASSERT_TRUE(turned_deg(truth, pose.q) < 2e-3);
            CHECK_CLOSE(1e-4, 20e-6 * at_us, pose.ned_m[0]);
        }
        TEST_ASSERT_EQUAL(GOE_FLIGHT_TOO_NEW, goe_flight_history_at(&history, 600001u, &pose));
        attitude_at(0.7, 30.0, truth);
        if (!other) {
            TEST_ASSERT_TRUE(goe_flight_history_add_attitude(&history, 700000u, truth));
        } else {
            TEST_ASSERT_TRUE(goe_flight_history_add_position(&history, 700000u, truth));
        }
        TEST_ASSERT_EQUAL(GOE_FLIGHT_TOO_NEW, goe_flight_history_at(&history, 650000u, &pose));
    }
}

/* The rate is the root mean square over all samples of the attitude; of a single one it is 0. */
static void the_rate_is_that_of_all_samples(void) {
    const float ned_m[3] = {0.0f, 0.0f, 0.0f};
    float q[4];
    TEST_ASSERT_TRUE(goe_flight_history_add_position(&history, 0u, ned_m));
    attitude_at(0.0, 30.0, q);
    TEST_ASSERT_TRUE(goe_flight_history_add_attitude(&history, 0u, q));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_history_at(&history, 0u, &pose));
    CHECK_SAME(0.0f, pose.rate_deg_s);
    for (uint32_t k = 1; k <= 20u; k++) { /* the first half turns, the other does not */
        attitude_at(0.02 * (k < 10u ? k : 10u), 30.0, q);
        TEST_ASSERT_TRUE(goe_flight_history_add_attitude(&history, 20000u * k, q));
    }
    TEST_ASSERT_TRUE(goe_flight_history_add_position(&history, 400000u, ned_m));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_history_at(&history, 200000u, &pose));
    CHECK_CLOSE(0.05, 30.0 * sqrt(0.5), pose.rate_deg_s);
}

/* ... as is its change, however many positions there are. */
static void the_change_of_the_rate_is_that_of_the_attitudes(void) {
    const float ned_m[3] = {0.0f, 0.0f, 0.0f};
    float spread_deg = 0.0f;
    for (int few = 0; few < 2; few++) {
        goe_flight_history_clear(&history);
        for (uint32_t k = 0; k < 10u; k++) {
            float q[4];
            sine_at(100000u * k, q);
            TEST_ASSERT_TRUE(goe_flight_history_add_attitude(&history, 100000u * k, q));
            if (few == 0 || k == 7u || k == 9u) {
                TEST_ASSERT_TRUE(goe_flight_history_add_position(&history, 100000u * k, ned_m));
            }
        }
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_history_at(&history, 850000u, &pose));
        TEST_ASSERT_TRUE(pose.spread_deg > 0.01f);
        spread_deg = few == 0 ? pose.spread_deg : spread_deg;
        CHECK_SAME(spread_deg, pose.spread_deg);
    }
}

/* A sample more than a second away bends nothing. */
static void a_sample_of_long_ago_bends_nothing(void) {
    const float ned_m[3] = {0.0f, 0.0f, 0.0f};
    for (uint32_t k = 0; k < 3u; k++) {
        float q[4];
        const uint32_t at_us = k == 0u ? 0u : 3000000u + 100000u * k;
        attitude_at(k == 0u ? 2.0 : 0.0, 30.0, q);
        TEST_ASSERT_TRUE(goe_flight_history_add_attitude(&history, at_us, q));
        TEST_ASSERT_TRUE(goe_flight_history_add_position(&history, at_us, ned_m));
    }
    const float level[4] = {1.0f, 0.0f, 0.0f, 0.0f};
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_history_at(&history, 3130000u, &pose));
    TEST_ASSERT_TRUE(turned_deg(level, pose.q) < 1e-4);
    CHECK_SAME(0.0f, pose.spread_deg);
}

/* Half of a wide turn between two samples is half of it, and a rotation. */
static void half_of_a_wide_turn_is_a_rotation(void) {
    const float ned_m[3] = {0.0f, 0.0f, 0.0f};
    float q[4];
    for (uint32_t k = 0; k < 2u; k++) {
        attitude_at(0.1 * k, 900.0, q);
        TEST_ASSERT_TRUE(goe_flight_history_add_attitude(&history, 100000u * k, q));
        TEST_ASSERT_TRUE(goe_flight_history_add_position(&history, 100000u * k, ned_m));
    }
    attitude_at(0.05, 900.0, q);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_history_at(&history, 50000u, &pose));
    TEST_ASSERT_TRUE(turned_deg(q, pose.q) < 2e-3);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(half_of_a_wide_turn_is_a_rotation);
    RUN_TEST(each_ring_answers_for_itself);
    RUN_TEST(the_rate_is_that_of_all_samples);
    RUN_TEST(the_change_of_the_rate_is_that_of_the_attitudes);
    RUN_TEST(a_sample_of_long_ago_bends_nothing);
    RUN_TEST(a_steady_flight_is_found_again);
    RUN_TEST(slow_samples_too);
    RUN_TEST(the_clock_may_wrap);
    RUN_TEST(a_bent_flight_is_followed);
    RUN_TEST(samples_on_a_line_do_not_lower_the_reported_error);
    RUN_TEST(samples_are_thinned_to_20_ms);
    RUN_TEST(nothing_is_known_before_both);
    RUN_TEST(old_samples_are_refused);
    RUN_TEST(nothing_is_made_up_in_a_gap);
    RUN_TEST(a_jump_moves_older_poses);
    RUN_TEST(the_rings_are_independent);
    return UNITY_END();
}
