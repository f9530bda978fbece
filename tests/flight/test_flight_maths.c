/* Angles and spans of time against double precision. SPDX-License-Identifier: MIT */
#include <math.h>

#include "check.h"
#include "goe_flight_maths.h"

#define DEG_PER_RAD 57.295779513082321
#define TRIES 20000

static check_random_t any;

void setUp(void) { any = check_random_start("flight maths"); }
void tearDown(void) {}

static void arctangents_in_every_quarter(void) {
    double worst = 0.0;
    for (int i = 0; i < TRIES; i++) {
        const float scale = (float)pow(10.0, check_random_between(&any, -10.0, 10.0));
        const float y = scale * (float)check_random_between(&any, -1.0, 1.0);
        const float x = scale * (float)check_random_between(&any, -1.0, 1.0);
        check_worst(&worst, (double)goe_flight_atan2_deg(y, x) - DEG_PER_RAD * atan2((double)y, (double)x));
    }
    check_report("worst arctangent, degrees", worst);
    TEST_ASSERT_TRUE(worst <= 3.0e-5);
    CHECK_SAME(0.0f, goe_flight_atan2_deg(0.0f, 0.0f));
    CHECK_CLOSE(1e-5, 90.0, goe_flight_atan2_deg(1.0f, 0.0f));
    CHECK_CLOSE(1e-5, 180.0, goe_flight_atan2_deg(0.0f, -1.0f));
    CHECK_CLOSE(1e-5, -135.0, goe_flight_atan2_deg(-2.0f, -2.0f));
}

static void sines_of_every_quarter(void) {
    double worst = 0.0;
    for (int i = 0; i < TRIES; i++) {
        float sine;
        float cosine;
        const float deg = (float)check_random_between(&any, -720.0, 720.0);
        goe_flight_sincos_deg(deg, &sine, &cosine);
        check_worst(&worst, (double)sine - sin((double)deg / DEG_PER_RAD));
        check_worst(&worst, (double)cosine - cos((double)deg / DEG_PER_RAD));
    }
    check_report("worst sine or cosine", worst);
    TEST_ASSERT_TRUE(worst <= 1.0e-6);
}

static void angles_become_positive(void) {
    for (int i = 0; i < TRIES; i++) {
        const float deg = (float)check_random_between(&any, -1.0e4, 1.0e4);
        const float positive = goe_flight_positive_deg(deg);
        TEST_ASSERT_TRUE(positive >= 0.0f && positive < 360.0f);
        CHECK_CLOSE(2e-3, 0.0, remainder((double)positive - (double)deg, 360.0));
    }
    TEST_ASSERT_TRUE(goe_flight_positive_deg(-1.0e-9f) < 360.0f);
}

/* GIVEN an angle that is none THEN it counts as 0: no int could count its quarters or turns. */
static void an_invalid_angle_counts_as_none(void) {
    static const uint32_t none[] = {0x7F7FFFFFu, 0xFF7FFFFFu, 0x7F800000u, 0xFF800000u, 0x7FC00000u};
    for (size_t i = 0; i < sizeof none / sizeof none[0]; i++) {
        float sine = 5.0f;
        float cosine = 5.0f;
        goe_flight_sincos_deg(check_from_bits(none[i]), &sine, &cosine);
        CHECK_SAME(0.0f, sine);
        CHECK_SAME(1.0f, cosine);
        CHECK_SAME(0.0f, goe_flight_positive_deg(check_from_bits(none[i])));
    }
}

static void a_counter_stays_at_its_most(void) {
    uint16_t counter = UINT16_MAX - 1u;
    goe_flight_count(&counter);
    TEST_ASSERT_EQUAL_UINT16(UINT16_MAX, counter);
    goe_flight_count(&counter);
    TEST_ASSERT_EQUAL_UINT16(UINT16_MAX, counter);
}

static void time_wraps(void) {
    TEST_ASSERT_EQUAL_INT32(10, goe_flight_between_us(5u, 0xFFFFFFFBu));
    TEST_ASSERT_EQUAL_INT32(-10, goe_flight_between_us(0xFFFFFFFBu, 5u));
    TEST_ASSERT_EQUAL_INT32(0, goe_flight_between_us(7u, 7u));
    TEST_ASSERT_EQUAL_INT32(INT32_MIN, goe_flight_between_us(0x80000000u, 0u));
}

static void numbers_are_judged_by_their_bits(void) {
    const float good[2] = {1.0f, -3.4e38f};
    const float bad[2] = {check_from_bits(0x7FC00000u), 0.0f};
    TEST_ASSERT_TRUE(goe_flight_all_finite(good, 2));
    TEST_ASSERT_FALSE(goe_flight_all_finite(bad, 2));
    TEST_ASSERT_FALSE(goe_flight_all_within(good, 2, 1.0f));
    TEST_ASSERT_TRUE(goe_flight_all_within(good, 1, 1.0f));
    TEST_ASSERT_FALSE(goe_flight_within(check_from_bits(0xFF800000u), 3.4e38f));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(arctangents_in_every_quarter);
    RUN_TEST(sines_of_every_quarter);
    RUN_TEST(angles_become_positive);
    RUN_TEST(an_invalid_angle_counts_as_none);
    RUN_TEST(a_counter_stays_at_its_most);
    RUN_TEST(time_wraps);
    RUN_TEST(numbers_are_judged_by_their_bits);
    return UNITY_END();
}
