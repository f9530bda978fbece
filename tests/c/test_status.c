/* Names of the statuses. SPDX-License-Identifier: MIT */
#include <string.h>

#include "check.h"

#define FIRST GOE_NOT_INITIALISED
#define LAST GOE_NOTHING_SEEN

void setUp(void) {}
void tearDown(void) {}

static const char *text_of(int status) { return goe_status_text((goe_status_t)status); }

static void every_status_has_a_name_of_its_own(void) {
    for (int a = FIRST; a <= LAST; a++) {
        TEST_ASSERT_NOT_NULL(text_of(a));
        TEST_ASSERT_TRUE(strcmp("unknown", text_of(a)) != 0);
        for (int b = FIRST; b < a; b++) {
            TEST_ASSERT_TRUE_MESSAGE(strcmp(text_of(a), text_of(b)) != 0, text_of(a));
        }
    }
}

static void a_name_fits_a_log(void) {
    for (int status = FIRST; status <= LAST; status++) {
        const char *text = text_of(status);
        TEST_ASSERT_TRUE(strlen(text) > 0 && strlen(text) <= 16);
        TEST_ASSERT_EQUAL_size_t(strlen(text), strspn(text, "abcdefghijklmnopqrstuvwxyz_"));
    }
}

static void the_names_are_those_of_the_manual(void) {
    TEST_ASSERT_EQUAL_STRING("ok", text_of(GOE_OK));
    TEST_ASSERT_EQUAL_STRING("no_baseline", text_of(GOE_NO_BASELINE));
    TEST_ASSERT_EQUAL_STRING("not_initialised", text_of(GOE_NOT_INITIALISED));
}

static void any_other_number_is_unknown(void) {
    TEST_ASSERT_EQUAL_STRING("unknown", text_of(FIRST - 1));
    TEST_ASSERT_EQUAL_STRING("unknown", text_of(LAST + 1));
    TEST_ASSERT_EQUAL_STRING("unknown", text_of(100));
    TEST_ASSERT_EQUAL_STRING("unknown", text_of(-100));
}

static void the_sign_is_the_grade(void) {
    TEST_ASSERT_TRUE(GOE_OK == 0);
    TEST_ASSERT_TRUE(GOE_PARTIAL > 0 && GOE_COLLECTING > 0 && GOE_HELD > 0 && GOE_NOTHING_SEEN > 0);
    TEST_ASSERT_TRUE(GOE_BEHIND_CAMERA == -1 && GOE_BAD_ATTITUDE == -(GOE_CAUSES - 1)); /* index the counters */
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(every_status_has_a_name_of_its_own);
    RUN_TEST(a_name_fits_a_log);
    RUN_TEST(the_names_are_those_of_the_manual);
    RUN_TEST(any_other_number_is_unknown);
    RUN_TEST(the_sign_is_the_grade);
    return UNITY_END();
}
