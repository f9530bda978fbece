/* Memory of one estimator. SPDX-License-Identifier: MIT */
#include "check.h"

#define STANDARD_WINDOW 8u
#define BYTES_PER_POINT 40u

void setUp(void) {}
void tearDown(void) {}

/* [A9] */
static void an_estimator_takes_2100_bytes_at_the_default_window(void) {
    const size_t beyond = (GOE_WINDOW_MAX > STANDARD_WINDOW ? GOE_WINDOW_MAX - STANDARD_WINDOW : 0u) * BYTES_PER_POINT;
    check_report("bytes of an estimator", (double)sizeof(goe_estimator_t));
    TEST_ASSERT_TRUE(sizeof(goe_estimator_t) <= (GOE_AUGMENTED > 0 ? 2100u : 1850u) + beyond);
}

static void each_point_of_the_window_takes_40_bytes(void) {
    const size_t windows = 2u * sizeof(goe_fit_ring_t) + 2u * sizeof(goe_mean_t);
    const size_t rings = 4u * 2u * sizeof(int16_t);
    TEST_ASSERT_EQUAL_size_t(BYTES_PER_POINT * GOE_WINDOW_MAX + rings, windows);
}

/* [GOE_CAMERAS_MAX] */
static void each_further_camera_takes_360_bytes(void) {
    goe_estimator_t *none = NULL;
    const size_t memory = GOE_WITH_FILTER ? 4u * sizeof(goe_side_memory_t) + 2u * sizeof(float) : 0u;
    TEST_ASSERT_TRUE(sizeof(goe_camera_t) + sizeof none->camera_to_body[0] + memory <= 360u);
    TEST_ASSERT_EQUAL_size_t(112u, sizeof(goe_camera_t) + sizeof none->camera_to_body[0]);
}

/* [A12] */
static void numbers_have_the_sizes_that_the_library_relies_on(void) {
    TEST_ASSERT_EQUAL_size_t(4u, sizeof(float));
    TEST_ASSERT_EQUAL_HEX32(0x3F800000u, check_bits(1.0f));
    TEST_ASSERT_EQUAL_HEX32(0xC0490FDBu, check_bits(-3.14159274f));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(an_estimator_takes_2100_bytes_at_the_default_window);
    RUN_TEST(each_point_of_the_window_takes_40_bytes);
    RUN_TEST(each_further_camera_takes_360_bytes);
    RUN_TEST(numbers_have_the_sizes_that_the_library_relies_on);
    return UNITY_END();
}
