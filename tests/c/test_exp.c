/* The exponential against the C library's in double. SPDX-License-Identifier: MIT */
/* tests: lib/maths/goe_exp.c */
#include "maths/goe_exp.h"

#include <math.h>

#include "check.h"

#define LIMIT 16.0 /* beyond it counts as that */
#define STEPS 4000

void setUp(void) {}
void tearDown(void) {}

/* The series of x/64 is cut off, and 64 of its errors add up. */
static double worst_share(double limit) {
    double worst = 0.0;
    for (int i = -STEPS; i <= STEPS; i++) {
        const float x = (float)(limit * i / STEPS);
        check_worst(&worst, (double)goe_exp(x) / exp((double)x) - 1.0);
    }
    check_report("largest relative error", worst);
    return worst;
}

/* [detector.box_correlation_time_s] */
static void it_is_as_right_as_reported(void) {
    TEST_ASSERT_TRUE(worst_share(6.0) < 1.0e-5);
    TEST_ASSERT_TRUE(worst_share(LIMIT) < 1.0e-3);
}

/* GIVEN a time constant that is short against the time between two images, or the other way round THEN nothing overflows. */
static void an_argument_beyond_the_limits_counts_as_the_limit(void) {
    CHECK_SAME(goe_exp((float)LIMIT), goe_exp(17.0f));
    CHECK_SAME(goe_exp((float)LIMIT), goe_exp(3.0e38f));
    CHECK_SAME(goe_exp((float)-LIMIT), goe_exp(-17.0f));
    CHECK_SAME(goe_exp((float)-LIMIT), goe_exp(-3.0e38f));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(it_is_as_right_as_reported);
    RUN_TEST(an_argument_beyond_the_limits_counts_as_the_limit);
    return UNITY_END();
}
