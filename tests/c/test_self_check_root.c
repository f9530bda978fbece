/* The self-check finds a square root that is not correctly rounded: compiled as it is, with one that can be made wrong.
 * SPDX-License-Identifier: MIT */
/* tests: lib/goe_self_check.c */
#include <math.h>
#include <string.h>

#include "check.h"

static float root(float square);

#define sqrtf root
#include "goe_self_check.c"
#undef sqrtf

/* The arguments that the self-check tries, and some whose roots it cannot judge. */
static uint32_t spoilt;      /* bits of the one argument whose root is wrong; 0: of all */
static uint32_t wrong_by;    /* added to the bits of the root */
static bool returns_nothing; /* 0 instead */

static float root(float square) {
    const float right = sqrtf(square);
    if (spoilt != 0u && check_bits(square) != spoilt) {
        return right;
    }
    return returns_nothing ? 0.0f : check_from_bits(check_bits(right) + wrong_by);
}

void setUp(void) {
    spoilt = 0u;
    wrong_by = 0u;
    returns_nothing = false;
}
void tearDown(void) {}

static void a_right_root_is_none_of_its_findings(void) { TEST_ASSERT_EQUAL_HEX32(0u, goe_self_check()); }

/* One unit in the last place too much or too little, as of a root by Newton's steps without the last correction; another
 * exponent; a sign. */
static void a_wrong_root_is_found(void) {
    static const uint32_t errors[] = {1u, UINT32_MAX, 2u, 0x00800000u, 0xFF800000u, 0x20000000u, 0x80000000u};
    for (size_t i = 0; i < sizeof errors / sizeof errors[0]; i++) {
        wrong_by = errors[i];
        TEST_ASSERT_EQUAL_HEX32(GOE_SELF_ROUNDING, goe_self_check());
    }
}

/* Each of the arguments is tried: the self-check reports a root that is wrong for one of them alone, too. */
static void one_wrong_root_among_right_ones_is_found(void) {
    wrong_by = 1u;
    for (uint32_t k = 0; k < ROOTS; k++) {
        spoilt = ROOT_FIRST + k * ROOT_STEP;
        TEST_ASSERT_EQUAL_HEX32(GOE_SELF_ROUNDING, goe_self_check());
    }
    spoilt = ROOT_SUBNORMAL;
    TEST_ASSERT_EQUAL_HEX32(GOE_SELF_ROUNDING, goe_self_check());
}

/* A root of nothing is that of a machine which flushes subnormal numbers; of any other argument it is wrong. */
static void a_root_that_is_flushed_is_another_finding(void) {
    returns_nothing = true;
    spoilt = ROOT_SUBNORMAL;
    TEST_ASSERT_EQUAL_HEX32(0u, goe_self_check());
    spoilt = ROOT_FIRST + ROOT_STEP;
    TEST_ASSERT_EQUAL_HEX32(GOE_SELF_ROUNDING, goe_self_check());
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(a_right_root_is_none_of_its_findings);
    RUN_TEST(a_wrong_root_is_found);
    RUN_TEST(one_wrong_root_among_right_ones_is_found);
    RUN_TEST(a_root_that_is_flushed_is_another_finding);
    return UNITY_END();
}
