/* The self-check notices another mode of the floating-point unit. SPDX-License-Identifier: MIT */
/* tests: lib/goe_self_check.c */
#include <fenv.h>

#include "check.h"

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

void setUp(void) {}
void tearDown(void) { (void)fesetround(FE_TONEAREST); }

/* No assertion while the mode is changed: the test framework computes too. */
static unsigned check_with_rounding(int mode) {
    (void)fesetround(mode);
    const unsigned found = goe_self_check();
    (void)fesetround(FE_TONEAREST);
    return found;
}

static void another_rounding_mode_is_found(void) {
    TEST_ASSERT_BITS(GOE_SELF_ROUNDING, GOE_SELF_ROUNDING, check_with_rounding(FE_UPWARD));
    TEST_ASSERT_BITS(GOE_SELF_ROUNDING, GOE_SELF_ROUNDING, check_with_rounding(FE_DOWNWARD));
    TEST_ASSERT_BITS(GOE_SELF_ROUNDING, GOE_SELF_ROUNDING, check_with_rounding(FE_TOWARDZERO));
    TEST_ASSERT_EQUAL_HEX32(0u, goe_self_check());
}

static void flushing_to_zero_is_found(void) {
#if defined(__SSE__)
    const unsigned flush_results = 0x8000u;
    const unsigned flush_operands = 0x0040u;
    const unsigned before = _mm_getcsr();
    _mm_setcsr(before | flush_results);
    const unsigned with_results_flushed = goe_self_check();
    _mm_setcsr(before | flush_operands);
    const unsigned with_operands_flushed = goe_self_check();
    _mm_setcsr(before);
    TEST_ASSERT_EQUAL_HEX32(GOE_SELF_FLUSHED, with_results_flushed);
    TEST_ASSERT_EQUAL_HEX32(GOE_SELF_FLUSHED, with_operands_flushed);
#else
    TEST_IGNORE_MESSAGE("this processor's flush mode is not known here");
#endif
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(another_rounding_mode_is_found);
    RUN_TEST(flushing_to_zero_is_found);
    return UNITY_END();
}
