/* The exponential against double precision. SPDX-License-Identifier: MIT */
#include <math.h>

#include "check.h"
#include "maths/goe_exp.h"

/* Of itself: goe_exp.h. */
#define BOUND 1.0e-5
#define NEAR 6.0
#define BOUND_FAR 7.0e-4
#define ARGUMENT_MAX 16.0f

void setUp(void) {}
void tearDown(void) {}

static void it_is_the_exponential_on_a_dense_grid(void) {
    double near = 0.0;
    double far = 0.0;
    for (int i = -16000; i <= 16000; i++) {
        const float x = (float)i * 1.0e-3f;
        check_worst(fabs((double)x) <= NEAR ? &near : &far, (double)goe_exp(x) / exp((double)x) - 1.0);
    }
    check_report("worst relative error up to 6", near);
    check_report("... and to 16", far);
    TEST_ASSERT_TRUE(near < BOUND);
    TEST_ASSERT_TRUE(far < BOUND_FAR);
    CHECK_SAME(1.0f, goe_exp(0.0f));
}

/* Beyond 16, and for what is no number, it is finite. */
static void beyond_its_range_it_stays_at_the_end(void) {
    CHECK_SAME(goe_exp(ARGUMENT_MAX), goe_exp(17.0f));
    CHECK_SAME(goe_exp(ARGUMENT_MAX), goe_exp(check_from_bits(0x7F800000u)));
    CHECK_SAME(goe_exp(-ARGUMENT_MAX), goe_exp(-1.0e30f));
    CHECK_SAME(goe_exp(-ARGUMENT_MAX), goe_exp(check_from_bits(0xFF800000u)));
    TEST_ASSERT_TRUE(check_is_finite(goe_exp(check_from_bits(0x7FC00000u))));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(it_is_the_exponential_on_a_dense_grid);
    RUN_TEST(beyond_its_range_it_stays_at_the_end);
    return UNITY_END();
}
