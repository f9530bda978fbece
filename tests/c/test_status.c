/* Names of the statuses. SPDX-License-Identifier: MIT */
/* tests: lib/goe_status.c */
#include <string.h>

#include "check.h"

/* Images from the first number to the last, then calls. */
static const int first[] = {GOE_NO_HEIGHT, GOE_CORRUPTED};
static const int last[] = {GOE_NO_DETECTION, GOE_BAD_SETTINGS};
#define RANGES 2
#define FREE_FROM (-31) /* for faults of images to come */

void setUp(void) {}
void tearDown(void) {}

static const char *text_of(int status) { return goe_status_text((goe_status_t)status); }

static int all[64];

static int collect(void) {
    int count = 0;
    for (int range = 0; range < RANGES; range++) {
        for (int status = first[range]; status <= last[range]; status++) {
            all[count++] = status;
        }
    }
    return count;
}

/* [goe_status_text] */
static void every_status_has_a_name_of_its_own(void) {
    const int count = collect();
    for (int a = 0; a < count; a++) {
        TEST_ASSERT_NOT_NULL(text_of(all[a]));
        TEST_ASSERT_TRUE(strcmp("unknown", text_of(all[a])) != 0);
        for (int b = 0; b < a; b++) {
            TEST_ASSERT_TRUE_MESSAGE(strcmp(text_of(all[a]), text_of(all[b])) != 0, text_of(all[a]));
        }
    }
}

/* [goe_status_text] */
static void a_name_fits_a_log(void) {
    const int count = collect();
    for (int k = 0; k < count; k++) {
        const char *text = text_of(all[k]);
        TEST_ASSERT_TRUE(strlen(text) > 0 && strlen(text) <= 16);
        TEST_ASSERT_EQUAL_size_t(strlen(text), strspn(text, "abcdefghijklmnopqrstuvwxyz_"));
    }
}

/* [goe_status_text] */
static void the_names_are_those_of_the_manual(void) {
    TEST_ASSERT_EQUAL_STRING("ok", text_of(GOE_OK));
    TEST_ASSERT_EQUAL_STRING("no_baseline", text_of(GOE_NO_BASELINE));
    TEST_ASSERT_EQUAL_STRING("no_detection", text_of(GOE_NO_DETECTION));
    TEST_ASSERT_EQUAL_STRING("stale", text_of(GOE_STALE));
    TEST_ASSERT_EQUAL_STRING("behind_camera", text_of(GOE_BEHIND_CAMERA));
    TEST_ASSERT_EQUAL_STRING("bad_height", text_of(GOE_BAD_HEIGHT));
    TEST_ASSERT_EQUAL_STRING("bad_attitude", text_of(GOE_BAD_ATTITUDE));
    TEST_ASSERT_EQUAL_STRING("box_incomplete", text_of(GOE_BOX_INCOMPLETE));
    TEST_ASSERT_EQUAL_STRING("no_height", text_of(GOE_NO_HEIGHT));
    TEST_ASSERT_EQUAL_STRING("bad_settings", text_of(GOE_BAD_SETTINGS));
    TEST_ASSERT_EQUAL_STRING("bad_argument", text_of(GOE_BAD_ARGUMENT));
    TEST_ASSERT_EQUAL_STRING("not_initialized", text_of(GOE_NOT_INITIALIZED));
    TEST_ASSERT_EQUAL_STRING("corrupted", text_of(GOE_CORRUPTED));
}

/* [A25, goe_status_text] Also those that are kept free: a new fault must not renumber the calls. */
static void any_other_number_is_unknown(void) {
    for (int status = -100; status <= 100; status++) {
        bool known = false;
        for (int range = 0; range < RANGES; range++) {
            known = known || (status >= first[range] && status <= last[range]);
        }
        TEST_ASSERT_EQUAL_INT(!known, strcmp("unknown", text_of(status)) == 0);
    }
    TEST_ASSERT_TRUE(GOE_BAD_SETTINGS < FREE_FROM && FREE_FROM < GOE_NO_HEIGHT);
}

/* [A25] */
static void the_sign_is_the_grade(void) {
    TEST_ASSERT_TRUE(GOE_OK == 0);
    TEST_ASSERT_TRUE(GOE_PARTIAL > 0 && GOE_CONVERGING > 0 && GOE_STALE > 0 && GOE_NO_DETECTION > 0);
    TEST_ASSERT_TRUE(GOE_BEHIND_CAMERA == -1 && GOE_NO_HEIGHT == -(GOE_FAULT_COUNTS - 1)); /* index the counters */
}

/* GIVEN the statuses of images THEN those of a refusal took nothing, all others took the image; a call's failure took none. */
static void what_took_the_image(void) {
    const int count = collect();
    for (int k = 0; k < count; k++) {
        const int status = all[k];
        const bool refused = status == GOE_NOT_FINITE || status == GOE_OUT_OF_RANGE || status == GOE_BAD_TIME ||
                             status == GOE_BAD_ATTITUDE || status <= GOE_BAD_SETTINGS;
        TEST_ASSERT_EQUAL_INT(!refused, GOE_IMAGE_TAKEN(status));
    }
    int k = 0;
    (void)GOE_IMAGE_TAKEN(all[k++]); /* evaluated once */
    TEST_ASSERT_EQUAL_INT(1, k);
}

/* GIVEN any number THEN a reason has a name of its own, and any other number is unknown. */
static void reasons_have_names(void) {
    static const char *const names[] = {"none", "convention", "moves", "base", "shape", "late", "noise"};
    for (int reason = GOE_REASON_NONE; reason <= GOE_REASON_NOISE; reason++) {
        TEST_ASSERT_EQUAL_STRING(names[reason], goe_reason_text((goe_reason_t)reason));
    }
    TEST_ASSERT_EQUAL_STRING("unknown", goe_reason_text((goe_reason_t)(GOE_REASON_NOISE + 1)));
    TEST_ASSERT_EQUAL_STRING("unknown", goe_reason_text((goe_reason_t)99));
    TEST_ASSERT_EQUAL_STRING("unknown", goe_reason_text((goe_reason_t)-1));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(every_status_has_a_name_of_its_own);
    RUN_TEST(a_name_fits_a_log);
    RUN_TEST(the_names_are_those_of_the_manual);
    RUN_TEST(any_other_number_is_unknown);
    RUN_TEST(the_sign_is_the_grade);
    RUN_TEST(what_took_the_image);
    RUN_TEST(reasons_have_names);
    return UNITY_END();
}
