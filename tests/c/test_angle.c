/* Arctangent, sine and cosine, folding: exact places, symmetries, continuity. SPDX-License-Identifier: MIT
 * The error bounds are tested against double in test_double_angle.c. */
/* tests: lib/maths/goe_angle.c */
#include "check.h"
#include "maths/goe_angle.h"

#define BOUND 2.0e-7f
#define PI 3.14159265f

void setUp(void) {}
void tearDown(void) {}

static void arctangent_at_known_places(void) {
    TEST_ASSERT_FLOAT_WITHIN(0.0f, 0.0f, goe_arctan_rad(0.0f, 1.0f));
    TEST_ASSERT_FLOAT_WITHIN(BOUND, PI / 4.0f, goe_arctan_rad(1.0f, 1.0f));
    TEST_ASSERT_FLOAT_WITHIN(BOUND, -PI / 4.0f, goe_arctan_rad(-2.5f, 2.5f));
    TEST_ASSERT_FLOAT_WITHIN(BOUND, PI / 2.0f, goe_arctan_rad(1.0f, 0.0f));
    TEST_ASSERT_FLOAT_WITHIN(BOUND, -PI / 2.0f, goe_arctan_rad(-1.0e-30f, 0.0f));
    TEST_ASSERT_FLOAT_WITHIN(BOUND, PI / 3.0f, goe_arctan_rad(1.73205081f, 1.0f));
    TEST_ASSERT_FLOAT_WITHIN(BOUND, PI / 6.0f, goe_arctan_rad(1.0f, 1.73205081f));
}

static void arctangent_is_odd_and_grows(void) {
    float before = 0.0f;
    for (int i = 1; i <= 4000; i++) {
        const float t = (float)i * 0.001f;
        const float angle = goe_arctan_rad(t, 1.0f);
        CHECK_SAME(-angle, goe_arctan_rad(-t, 1.0f));
        TEST_ASSERT_TRUE(angle > before);
        before = angle;
    }
}

static void arctangent_takes_any_magnitude(void) {
    /* GIVEN the largest and the smallest floats THEN no quotient overflows or divides zero by zero */
    TEST_ASSERT_FLOAT_WITHIN(BOUND, PI / 4.0f, goe_arctan_rad(3.4e38f, 3.4e38f));
    TEST_ASSERT_FLOAT_WITHIN(BOUND, PI / 4.0f, goe_arctan_rad(1.0e-38f, 1.0e-38f));
    TEST_ASSERT_FLOAT_WITHIN(BOUND, PI / 2.0f, goe_arctan_rad(3.4e38f, 1.0e-38f));
    TEST_ASSERT_FLOAT_WITHIN(BOUND, 0.0f, goe_arctan_rad(1.0e-38f, 3.4e38f));
}

static void sine_and_cosine_at_quarter_turns(void) {
    static const float sines[4] = {0.0f, 1.0f, 0.0f, -1.0f};
    for (int quarter = -8; quarter <= 8; quarter++) {
        float s;
        float c;
        goe_sincos_deg(90.0f * (float)quarter, &s, &c);
        TEST_ASSERT_FLOAT_WITHIN(0.0f, sines[(unsigned)quarter & 3u], s);
        TEST_ASSERT_FLOAT_WITHIN(0.0f, sines[((unsigned)quarter + 1u) & 3u], c);
    }
}

static void sine_and_cosine_lie_on_the_circle(void) {
    for (int i = -7200; i <= 7200; i += 7) {
        float s;
        float c;
        float s_mirrored;
        float c_mirrored;
        goe_sincos_deg((float)i * 0.1f, &s, &c);
        goe_sincos_deg((float)i * -0.1f, &s_mirrored, &c_mirrored);
        TEST_ASSERT_FLOAT_WITHIN(3.0e-7f, 1.0f, s * s + c * c);
        TEST_ASSERT_FLOAT_WITHIN(BOUND, -s, s_mirrored);
        TEST_ASSERT_FLOAT_WITHIN(BOUND, c, c_mirrored);
    }
}

static void sine_and_cosine_stay_bounded_at_any_angle_allowed(void) {
    for (int i = -1000; i <= 1000; i++) {
        float s;
        float c;
        goe_sincos_deg((float)i * 1000.0f, &s, &c);
        TEST_ASSERT_FLOAT_WITHIN(1.0e-3f, 1.0f, s * s + c * c);
    }
}

/* GIVEN an angle whose quarters no int can count, or that is none THEN it counts as 0. */
static void sine_and_cosine_of_no_angle_are_those_of_none(void) {
    static const uint32_t none[] = {0x49742401u, 0xC9742401u, 0x7F7FFFFFu, 0x7F800000u, 0xFF800000u, 0x7FC00000u};
    for (size_t i = 0; i < sizeof none / sizeof none[0];
         i++) { /* the first two: the float next to 1e6, and its negative */
        float s = 5.0f;
        float c = 5.0f;
        goe_sincos_deg(check_from_bits(none[i]), &s, &c);
        CHECK_SAME(0.0f, s);
        CHECK_SAME(1.0f, c);
    }
}

/* [goe_estimate_t.orientation_deg] */
static void folding_names_the_same_undirected_line(void) {
    TEST_ASSERT_EQUAL_FLOAT(90.0f, goe_fold_deg(90.0f));
    TEST_ASSERT_EQUAL_FLOAT(90.0f, goe_fold_deg(-90.0f));
    TEST_ASSERT_EQUAL_FLOAT(-89.0f, goe_fold_deg(91.0f));
    TEST_ASSERT_EQUAL_FLOAT(89.0f, goe_fold_deg(-91.0f));
    TEST_ASSERT_EQUAL_FLOAT(0.0f, goe_fold_deg(180.0f));
    TEST_ASSERT_EQUAL_FLOAT(0.0f, goe_fold_deg(-180.0f));
    TEST_ASSERT_EQUAL_FLOAT(90.0f, goe_fold_deg(270.0f));
    for (int i = -2699; i <= 2700; i++) {
        const float deg = (float)i * 0.1f;
        const float folded = goe_fold_deg(deg);
        const float turns = (deg - folded) / 180.0f;
        TEST_ASSERT_TRUE(folded > -90.0f && folded <= 90.0f);
        TEST_ASSERT_FLOAT_WITHIN(1.0e-5f, 0.0f, turns - (float)(int)(turns + (turns < 0.0f ? -0.5f : 0.5f)));
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(arctangent_at_known_places);
    RUN_TEST(arctangent_is_odd_and_grows);
    RUN_TEST(arctangent_takes_any_magnitude);
    RUN_TEST(sine_and_cosine_at_quarter_turns);
    RUN_TEST(sine_and_cosine_lie_on_the_circle);
    RUN_TEST(sine_and_cosine_stay_bounded_at_any_angle_allowed);
    RUN_TEST(sine_and_cosine_of_no_angle_are_those_of_none);
    RUN_TEST(folding_names_the_same_undirected_line);
    return UNITY_END();
}
