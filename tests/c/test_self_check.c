/* The self-check of the arithmetic finds nothing with the project's own flags. SPDX-License-Identifier: MIT
 * That it finds what it should: test_double_self_check.c. */
/* tests: lib/goe_self_check.c */
#include "check.h"

void setUp(void) {}
void tearDown(void) {}

static void the_arithmetic_is_ieee_754_single_precision(void) { TEST_ASSERT_EQUAL_HEX32(0u, goe_self_check()); }

/* [goe_self_check] */
static void its_findings_are_single_bits(void) {
    const unsigned all = GOE_SELF_CONTRACTED + GOE_SELF_REASSOCIATED + GOE_SELF_RECIPROCAL + GOE_SELF_FLUSHED +
                         GOE_SELF_EXCESS + GOE_SELF_ROUNDING;
    TEST_ASSERT_EQUAL_HEX32(0x3Fu, all);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(the_arithmetic_is_ieee_754_single_precision);
    RUN_TEST(its_findings_are_single_bits);
    return UNITY_END();
}
