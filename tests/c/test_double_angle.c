/* The error bounds of the angle functions, against the C library's double ones. SPDX-License-Identifier: MIT */
/* tests: lib/maths/goe_angle.c */
#include <math.h>

#include "check.h"
#include "maths/goe_angle.h"

#define BOUND 2.0e-7 /* as the header states it, radians */
#define RAD_PER_DEG 0.017453292519943295

static double worst;

void setUp(void) { worst = 0.0; }
void tearDown(void) {}

static void arctangent_once(float y, float x) {
    check_worst(&worst, (double)goe_arctan_rad(y, x) - atan2((double)y, (double)x));
}

static void arctangent_on_a_dense_grid(void) {
    for (int i = 0; i <= 1 << 20; i++) {
        const float t = (float)i / (float)(1 << 20);
        arctangent_once(t, 1.0f);
        arctangent_once(1.0f, t);
        arctangent_once(-1.0f, t);
    }
    check_report("arctangent, grid, worst error in rad", worst);
    TEST_ASSERT_TRUE(worst <= BOUND);
}

/* GIVEN every 251st bit pattern of a positive finite float as the tangent, from the smallest subnormal on */
static void arctangent_over_the_bit_patterns(void) {
    for (uint32_t bits = 1u; bits < 0x7F800000u; bits += 251u) {
        arctangent_once(check_from_bits(bits), 1.0f);
    }
    check_report("arctangent, bit patterns, worst error in rad", worst);
    TEST_ASSERT_TRUE(worst <= BOUND);
}

static void arctangent_of_random_pairs(void) {
    check_random_t random = check_random_start("arctangent");
    for (int i = 0; i < 2000000; i++) {
        const uint32_t x = check_random_bits(&random) & 0x7FFFFFFFu;
        const uint32_t y = check_random_bits(&random);
        if (x < 0x7F800000u && (y & 0x7FFFFFFFu) < 0x7F800000u && (x | (y & 0x7FFFFFFFu)) != 0u) {
            arctangent_once(check_from_bits(y), check_from_bits(x));
        }
        arctangent_once((float)check_random_between(&random, -1.0, 1.0),
                        (float)check_random_between(&random, 1e-9, 1.0));
    }
    check_report("arctangent, random, worst error in rad", worst);
    TEST_ASSERT_TRUE(worst <= BOUND);
}

static void sincos_once(float deg) {
    float s;
    float c;
    goe_sincos_deg(deg, &s, &c);
    check_worst(&worst, (double)s - sin((double)deg * RAD_PER_DEG));
    check_worst(&worst, (double)c - cos((double)deg * RAD_PER_DEG));
}

static void sine_and_cosine_up_to_two_turns(void) {
    check_random_t random = check_random_start("sine and cosine");
    for (int i = -720 * 1024; i <= 720 * 1024; i++) {
        sincos_once((float)i / 1024.0f);
        sincos_once((float)check_random_between(&random, -720.0, 720.0));
    }
    for (uint32_t bits = 0u; bits < 0x44340000u; bits += 1021u) { /* up to 720 */
        sincos_once(check_from_bits(bits));
        sincos_once(check_from_bits(bits | 0x80000000u));
    }
    check_report("sine and cosine, worst error", worst);
    TEST_ASSERT_TRUE(worst <= BOUND);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(arctangent_on_a_dense_grid);
    RUN_TEST(arctangent_over_the_bit_patterns);
    RUN_TEST(arctangent_of_random_pairs);
    RUN_TEST(sine_and_cosine_up_to_two_turns);
    return UNITY_END();
}
