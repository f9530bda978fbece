/* The worked example of goe.h, flown. SPDX-License-Identifier: MIT */
#include "check.h"
#include "scene.h"

void setUp(void) {}
void tearDown(void) {}

/* GIVEN an aircraft at north 0, east 0 that heads north, and a chimney of 6 m diameter at north 200, east -30
 * WHEN it flies 50 m THEN Z0 = 200, X0 = -30 and width = 6 stay as they were, Z = 150 and X = -30. */
static void fly_the_worked_example(goe_method_t method, int first) {
    scene_t scene;
    goe_estimator_t estimator;
    goe_estimate_t estimate;
    scene_default(&scene);
    scene.shape = SCENE_CYLINDER;
    scene.width_m = 6.0;
    scene.height_m = 30.0;
    scene.x0_m = -30.0;
    scene.z0_m = 200.0;
    goe_settings_t settings = scene_settings(&scene);
    settings.method = method;
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
    for (int k = 0; k <= 25; k++) { /* 2 m an image */
        goe_image_t image;
        scene_image(&scene, k, &image, NULL);
        CHECK_STATUS(k < first ? GOE_CONVERGING : GOE_OK, goe_update(&estimator, &image, &estimate));
        if (k >= first) {
            TEST_ASSERT_FLOAT_WITHIN(0.1f, 200.0f, estimate.z0_m);
            TEST_ASSERT_FLOAT_WITHIN(0.02f, -30.0f, estimate.x0_m);
            TEST_ASSERT_FLOAT_WITHIN(0.005f, 6.0f, estimate.width_m);
            TEST_ASSERT_FLOAT_WITHIN(0.1f, 200.0f - 2.0f * (float)k, estimate.z_m);
            TEST_ASSERT_FLOAT_WITHIN(0.02f, -30.0f, estimate.x_m);
            TEST_ASSERT_FLOAT_WITHIN(0.1f, 200.0f, estimate.center_north_m);
            TEST_ASSERT_FLOAT_WITHIN(0.02f, -30.0f, estimate.center_east_m);
        }
    }
    TEST_ASSERT_FLOAT_WITHIN(0.1f, 150.0f, estimate.z_m);
    TEST_ASSERT_EQUAL_INT(method == GOE_METHOD_FILTER ? GOE_MODEL_PRISM : GOE_MODEL_DISC, estimate.model);
    TEST_ASSERT_TRUE(estimate.fresh);
}

/* [GOE_CONVERGING, GOE_HAS_POSITION, goe_estimate_t.x0_m, goe_estimate_t.x_m, goe_estimate_t.z0_m]
 * The filter method answers once the range is known to 25 %, the window when it is full. */
static void the_worked_example_of_the_manual(void) { fly_the_worked_example(GOE_METHOD_FILTER, 6); }
/* [GOE_CONVERGING, goe_estimate_t.z0_m, method] */
static void the_worked_example_by_the_window(void) { fly_the_worked_example(GOE_METHOD_WINDOW, 7); }

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(the_worked_example_of_the_manual);
    RUN_TEST(the_worked_example_by_the_window);
    return UNITY_END();
}
