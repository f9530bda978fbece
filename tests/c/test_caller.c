/* What the caller sees when the detector falls silent, passes the number to another obstacle, or the obstacle is passed, by
 * points and by boxes. SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "check.h"
#include "scene.h"

#define NOISE_PX 0.5
#define RATE_HZ 8.0
#define DEEP_M 10.0  /* by which the middle may lie behind the front edge */
#define NOTICED 24   /* images, of three seconds */
#define RECOVERED 48 /* ... of six */

static check_random_t any;
static scene_t scene;
static goe_settings_t settings;
static goe_estimator_t estimator;
static goe_estimate_t estimate;
static goe_hazard_t hazard;

void setUp(void) {
    any = check_random_start("caller");
    scene_default(&scene);
    scene.z0_m = 200.0;
    scene.x0_m = -12.0;
    scene.wobble_deg = 1.5;
    settings = scene_settings(&scene);
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
}
void tearDown(void) {}

static goe_status_t see(int k, bool blind, scene_truth_t *truth) {
    goe_image_t image;
    scene_image(&scene, k, &image, truth);
    if (scene.boxes) {
        image.box.left_px += (float)(2.0 * check_random_normal(&any));
        image.box.right_px += (float)(2.0 * check_random_normal(&any));
        image.box.top_px += (float)(2.0 * check_random_normal(&any));
        image.box.bottom_px += (float)(2.0 * check_random_normal(&any));
    } else {
        scene_add_noise(&image, &any, NOISE_PX);
    }
    if (blind) {
        scene_hide_points(&image);
        image.box.sides = 0;
    }
    return goe_update(&estimator, &image, &estimate);
}

static void foresee(void) {
    goe_intent_t intent;
    memset(&intent, 0, sizeof intent);
    intent.velocity_ned_m_s[0] = (float)scene.speed_mps;
    intent.margin_m = 25.0f;
    intent.clearance_m = 30.0f;
    CHECK_STATUS(GOE_OK, goe_hazard(&estimator, &intent, &hazard));
}

/* [goe_hazard]
 * GIVEN a detector that falls silent for three seconds, images without features coming THEN the estimate is stale, says how old
 * it is, follows the own motion, and the hazard goes on; WHEN it sees again THEN the track goes on, too. */
static void a_silent_detector(void) {
    scene_truth_t truth;
    int images = 0;
    for (int k = 0; k < 64; k++) {
        const bool blind = k >= 32 && k < 56;
        const goe_status_t status = see(k, blind, &truth);
        if (blind) {
            CHECK_STATUS(GOE_NO_DETECTION, status);
            TEST_ASSERT_FALSE(estimate.fresh);
            TEST_ASSERT_TRUE(estimate.valid & GOE_HAS_POSITION);
            CHECK_CLOSE(1.0e-4, (k - 31) / RATE_HZ, estimate.age_s);
            CHECK_CLOSE(4.0 * (double)estimate.sigma.z_m + DEEP_M, truth.z_m, estimate.z_m);
            foresee();
            TEST_ASSERT_TRUE(hazard.conflict_probability > 0.5f);
        }
        TEST_ASSERT_TRUE(estimate.images_used >= images); /* no restart */
        images = estimate.images_used;
    }
    TEST_ASSERT_TRUE(estimate.fresh);
    TEST_ASSERT_FALSE(estimate.suspect);
}

/* GIVEN a number that passes to another obstacle THEN within three seconds the estimate is suspect or began again, and within six
 * it is at the visible one. */
static void a_number_that_passes_to_another(void) {
    scene_truth_t truth;
    bool noticed = false;
    int images = 0;
    for (int k = 0; k < 32 + RECOVERED; k++) {
        if (k == 32) { /* 80 m on: the other one is 120 m ahead */
            scene.x0_m = 15.0;
            scene.z0_m = 230.0;
            scene.width_m = 12.0;
        }
        (void)see(k, false, &truth);
        noticed = noticed || (k >= 32 && (estimate.suspect || estimate.images_used < images || !estimate.fresh));
        TEST_ASSERT_TRUE(k < 32 + NOTICED || noticed);
        images = estimate.images_used;
    }
    check_report("range, off by, m", (double)estimate.z_m - truth.z_m);
    check_report("sigma, m", (double)estimate.sigma.z_m);
    TEST_ASSERT_TRUE(fabs((double)estimate.x_m - truth.x_m) < 4.0 * (double)estimate.sigma.x_m + 2.0);
    TEST_ASSERT_TRUE(fabs((double)estimate.z_m - truth.z_m) < 4.0 * (double)estimate.sigma.z_m + 2.0);
}

/* [goe_estimate_t.x_m, goe_hazard]
 * GIVEN an obstacle that is passed and no longer visible THEN the hazard is over when it is behind, though the estimate is old. */
static void an_obstacle_that_is_passed(void) {
    scene_truth_t truth;
    for (int k = 0; k < 136; k++) {
        (void)see(k, k > 88, &truth);
    }
    TEST_ASSERT_TRUE(truth.z_m < -20.0);
    TEST_ASSERT_FALSE(estimate.fresh);
    TEST_ASSERT_TRUE(estimate.z_m < 0.0f);
    foresee();
    CHECK_SAME(0.0f, hazard.tcpa_s);
    TEST_ASSERT_TRUE(hazard.dcpa_m > 20.0f);
}

static void by_boxes(void (*test)(void)) {
    setUp();
    scene.boxes = true;
    settings = scene_settings(&scene);
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
    test();
}

/* [goe_estimate_t.age_s] */
static void a_silent_detector_of_boxes(void) { by_boxes(a_silent_detector); }
/* [goe_estimate_t.suspect] */
static void a_number_of_boxes_that_passes_to_another(void) { by_boxes(a_number_that_passes_to_another); }
/* [goe_estimate_t.x_m] */
static void an_obstacle_of_boxes_that_is_passed(void) { by_boxes(an_obstacle_that_is_passed); }

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(a_silent_detector);
    RUN_TEST(a_silent_detector_of_boxes);
    RUN_TEST(a_number_that_passes_to_another);
    RUN_TEST(a_number_of_boxes_that_passes_to_another);
    RUN_TEST(an_obstacle_that_is_passed);
    RUN_TEST(an_obstacle_of_boxes_that_is_passed);
    return UNITY_END();
}
