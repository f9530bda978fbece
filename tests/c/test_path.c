/* Noise of the own position that is new in each image, as configured: neither range nor latency follows it. SPDX-License-Identifier: MIT */
/* tests: lib/image/goe_ego_motion.c, lib/refined/goe_observation.c */
#include <math.h>
#include <string.h>

#include "check.h"
#include "scene.h"

#define FLIGHTS 40
#define IMAGES 60
#define POINT_PX 0.5

static scene_t scene;
static goe_settings_t settings;
static goe_estimator_t estimator;
static check_random_t any;

void setUp(void) {
    scene_default(&scene);
    scene_make_cylinder(&scene);
    settings = scene_settings(&scene);
    settings.detector.point_noise_px = (float)POINT_PX;
}
void tearDown(void) {}

/* Errors of the estimate's range at the end of a flight, sigmas; positive: too far. late: whether the poses are called late. */
static double fly(double white_m, bool *late) {
    goe_estimate_t estimate;
    scene_truth_t truth;
    memset(&estimate, 0, sizeof estimate);
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
    for (int k = 0; k < IMAGES; k++) {
        goe_image_t image;
        scene_image(&scene, k, &image, &truth);
        scene_add_noise(&image, &any, POINT_PX);
        for (int i = 0; i < 3; i++) {
            image.pose.position_ned_m[i] += (float)(white_m * check_random_normal(&any));
        }
        (void)goe_update(&estimator, &image, &estimate);
    }
    TEST_ASSERT_TRUE((estimate.valid & GOE_HAS_CENTER) != 0u);
    *late = *late || estimate.reason == GOE_REASON_LATE;
    return ((double)estimate.center_north_m - truth.center_north_m) / (double)estimate.sigma.center_north_m;
}

/* [navigation.position_white_sd_m] */
static void noise_of_the_position_biases_no_range(void) {
    for (int path = 0; path < 3; path++) {
        for (int i = 0; i < 3; i++) {
            static const double white_m[] = {0.0, 0.3, 1.0};
            double sum = 0.0;
            double squares = 0.0;
            int late = 0;
            setUp();
            any = check_random_start("white noise");
            scene.path = (scene_path_t)path;
            settings.navigation.position_white_sd_m = (float)white_m[i];
            for (int n = 0; n < FLIGHTS; n++) {
                bool is_late = false;
                const double off = fly(white_m[i], &is_late);
                sum += off;
                squares += off * off;
                late += is_late ? 1 : 0;
            }
            check_report("mean error, sigmas", sum / FLIGHTS);
            check_report("rms error, sigmas", sqrt(squares / FLIGHTS));
            check_report("flights called late", late);
            TEST_ASSERT_TRUE(fabs(sum / FLIGHTS) < 0.8);
            TEST_ASSERT_TRUE(sqrt(squares / FLIGHTS) < 1.4);
            TEST_ASSERT_TRUE(late <= FLIGHTS / 10);
        }
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(noise_of_the_position_biases_no_range);
    return UNITY_END();
}
