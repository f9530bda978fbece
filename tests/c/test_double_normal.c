/* The normal distribution, against the C library's double error function. SPDX-License-Identifier: MIT */
/* tests: lib/maths/goe_normal.c */
#include <math.h>

#include "check.h"
#include "maths/goe_normal.h"

#define BOUND 1.0e-6 /* as the header states it */

static double worst;

void setUp(void) { worst = 0.0; }
void tearDown(void) {}

static void once(float x) { check_worst(&worst, (double)goe_normal_below(x) - 0.5 * erfc(-(double)x / sqrt(2.0))); }

static void on_a_dense_grid(void) {
    for (int i = -6 * (1 << 18); i <= 6 * (1 << 18); i++) {
        once((float)i / (float)(1 << 18));
    }
    check_report("normal distribution, grid, worst error", worst);
    TEST_ASSERT_TRUE(worst <= BOUND);
}

static void over_the_bit_patterns(void) {
    for (uint32_t bits = 0u; bits < 0x7F800000u; bits += 1021u) {
        once(check_from_bits(bits));
        once(check_from_bits(bits | 0x80000000u));
    }
    once(check_from_bits(0x7F7FFFFFu));
    once(check_from_bits(0xFF7FFFFFu));
    check_report("normal distribution, bit patterns, worst error", worst);
    TEST_ASSERT_TRUE(worst <= BOUND);
}

static void both_tails_are_the_same(void) {
    for (int i = 1; i <= 6000; i++) {
        const float x = (float)i * 0.001f;
        CHECK_SAME(1.0f - goe_normal_below(-x), goe_normal_below(x));
        TEST_ASSERT_TRUE(goe_normal_below(-x) >= 0.0f && goe_normal_below(x) <= 1.0f);
    }
}

static void it_falls_all_along_the_tail(void) {
    float before = goe_normal_below(0.0f);
    for (int i = 1; i <= 700; i++) {
        const float tail = goe_normal_below((float)i * -0.01f);
        TEST_ASSERT_TRUE(tail < before || (i > 520 && tail <= before));
        before = tail;
    }
    CHECK_SAME(0.0f, before);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(on_a_dense_grid);
    RUN_TEST(over_the_bit_patterns);
    RUN_TEST(both_tails_are_the_same);
    RUN_TEST(it_falls_all_along_the_tail);
    return UNITY_END();
}
