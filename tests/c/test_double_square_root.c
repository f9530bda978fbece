/* The self-check notices a C library whose sqrtf is not correctly rounded. SPDX-License-Identifier: MIT
 *
 * Embedded C libraries have such: Newton's method with too few steps is off by an ulp for a quarter of all arguments. */
/* tests: lib/goe_self_check.c */
#include <math.h>
#include <string.h>

#include "check.h"

typedef enum { ROOT_RIGHT, ROOT_OFF_FOR_A_QUARTER, ROOT_OFF_FOR_SUBNORMALS, ROOT_OFF_FOR_ODD_EXPONENTS } root_kind_t;

static root_kind_t kind;
static uint32_t seed;

static uint32_t bits_of_float(float x) {
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static bool is_off(uint32_t square_bits) {
    switch (kind) {
        case ROOT_OFF_FOR_A_QUARTER: /* which quarter: by a hash of the argument */
            return ((square_bits * 2654435761u + seed * 40503u) >> 13) % 4u == 0u;
        case ROOT_OFF_FOR_SUBNORMALS:
            return square_bits < 0x00800000u;
        case ROOT_OFF_FOR_ODD_EXPONENTS:
            return ((square_bits >> 23) & 1u) != 0u;
        case ROOT_RIGHT:
        default:
            return false;
    }
}

static float some_root(float square) {
    uint32_t bits = bits_of_float(sqrtf(square));
    float root;
    bits += !is_off(bits_of_float(square)) ? 0u : (bits & 1u) != 0u ? 1u : UINT32_MAX; /* an ulp up or down */
    memcpy(&root, &bits, sizeof root);
    return root;
}

/* The self-check once more, with that root. */
#define sqrtf some_root
#define goe_self_check self_check_with_some_root
unsigned self_check_with_some_root(void);
#include "goe_self_check.c"
#undef sqrtf
#undef goe_self_check

void setUp(void) {
    kind = ROOT_RIGHT;
    seed = 0;
}
void tearDown(void) {}

/* [goe_self_check] */
static void a_right_root_passes(void) { TEST_ASSERT_EQUAL_HEX32(0u, self_check_with_some_root()); }

/* [goe_self_check] */
static void a_root_that_is_off_for_a_quarter_is_found(void) {
    kind = ROOT_OFF_FOR_A_QUARTER;
    for (seed = 0; seed < 100; seed++) {
        TEST_ASSERT_EQUAL_HEX32(GOE_SELF_ROUNDING, self_check_with_some_root());
    }
}

/* [goe_self_check] */
static void a_root_that_is_off_for_subnormals_is_found(void) {
    kind = ROOT_OFF_FOR_SUBNORMALS;
    TEST_ASSERT_EQUAL_HEX32(GOE_SELF_ROUNDING, self_check_with_some_root());
}

/* [goe_self_check] */
static void a_root_that_is_off_for_odd_exponents_is_found(void) {
    kind = ROOT_OFF_FOR_ODD_EXPONENTS;
    TEST_ASSERT_EQUAL_HEX32(GOE_SELF_ROUNDING, self_check_with_some_root());
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(a_right_root_passes);
    RUN_TEST(a_root_that_is_off_for_a_quarter_is_found);
    RUN_TEST(a_root_that_is_off_for_subnormals_is_found);
    RUN_TEST(a_root_that_is_off_for_odd_exponents_is_found);
    return UNITY_END();
}
