/* Jumps of the position that no reset announces, and positions that only look like them. SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "check.h"
#include "drawn.h"
#include "goe.h"
#include "scene.h"

#define LEAPS 0 /* in fault_counts */
#define IMAGES 40
#define FIRST 12 /* image that jumps */
#define FLIGHTS 400
#define CLEAR_MAX 1
#define CLEAR_IN_NOISE_MAX 12 /* an error of six sigma is no jump */

static scene_t scene;
static goe_settings_t settings;
static goe_estimator_t plain, jumped;
static goe_estimate_t estimate, after;

void setUp(void) {
    scene_default(&scene);
    scene.image_rate_hz = 8.0;
}
void tearDown(void) {}

static void start(goe_estimator_t *estimator) {
    settings = scene_settings(&scene);
    CHECK_STATUS(GOE_OK, goe_init(estimator, sizeof *estimator, &settings, NULL));
}

static void move(goe_image_t *image, double north_m, double east_m) {
    image->pose.position_ned_m[0] += (float)north_m;
    image->pose.position_ned_m[1] += (float)east_m;
}

/* Flies with and without jumps: of so many images from FIRST on. */
static void fly(double north_m, double east_m, int images) {
    start(&plain);
    start(&jumped);
    for (int k = 0; k < IMAGES; k++) {
        goe_image_t image;
        scene_image(&scene, k, &image, NULL);
        (void)goe_update(&plain, &image, &estimate);
        if (k >= FIRST && k < FIRST + images) {
            move(&image, north_m, east_m);
        }
        (void)goe_update(&jumped, &image, &after);
    }
}

/* [goe_pose_t.reset_count, goe_ego_motion.c]
 * GIVEN a flight WHEN its position jumps without a reset, for one image or for good THEN the estimate is that without a jump, its middle lies in the
 * new positions, and each jump is counted. */
static void a_jump_without_a_reset_is_no_motion(void) {
    for (int n = 0; n < 4; n++) {
        const bool back = n < 2;
        const double north_m = n % 2 == 0 ? 20.0 : -11.0;
        const double east_m = n % 2 == 0 ? 100.0 : 1.0;
        scene.image_rate_hz = n % 2 == 0 ? 8.0 : 25.0;
        fly(north_m, east_m, back ? 1 : IMAGES);
        TEST_ASSERT_EQUAL_UINT32(back ? 2u : 1u, jumped.fault_counts[LEAPS]);
        TEST_ASSERT_EQUAL_UINT32(0u, plain.fault_counts[LEAPS]);
        TEST_ASSERT_EQUAL_HEX32(estimate.valid, after.valid);
        CHECK_CLOSE(0.05 * (double)estimate.sigma.z_m, estimate.z_m, after.z_m);
        CHECK_CLOSE(0.05 * (double)estimate.sigma.x_m, estimate.x_m, after.x_m);
        CHECK_CLOSE(0.1 * (double)estimate.sigma.center_north_m,
                    (double)estimate.center_north_m + (back ? 0.0 : north_m), after.center_north_m);
        CHECK_CLOSE(0.1 * (double)estimate.sigma.center_east_m, (double)estimate.center_east_m + (back ? 0.0 : east_m),
                    after.center_east_m);
    }
}

/* [goe_estimate_t.center_north_m] GIVEN an older answer WHEN the position jumps without a reset, while nothing is detected THEN the answer moves along. */
static void an_old_answer_moves_with_the_jump(void) {
    start(&jumped);
    for (int k = 0; k < IMAGES; k++) {
        goe_image_t image;
        scene_image(&scene, k, &image, NULL);
        if (k >= FIRST + 10) {
            scene_hide_points(&image);
            image.box.sides = 0;
            estimate = k == FIRST + 10 ? after : estimate;
        }
        if (k >= FIRST + 15) {
            move(&image, 50.0, -30.0);
        }
        (void)goe_update(&jumped, &image, &after);
    }
    TEST_ASSERT_EQUAL_UINT32(1u, jumped.fault_counts[LEAPS]);
    CHECK_CLOSE(0.05, (double)estimate.center_north_m + 50.0, after.center_north_m);
    CHECK_CLOSE(0.05, (double)estimate.center_east_m - 30.0, after.center_east_m);
}

/* [goe_ego_motion.c] GIVEN a jump of less than 1 m THEN it is taken as it is: an aircraft flies as far off, and it does no harm. */
static void a_small_jump_is_none(void) {
    fly(0.6, 0.6, IMAGES);
    TEST_ASSERT_EQUAL_UINT32(0u, jumped.fault_counts[LEAPS]);
}

/* [goe_ego_motion.c] GIVEN an aircraft of up to 80 m/s, whose positions are held from fix to fix, at whatever two rates THEN nothing jumps. */
static void positions_that_are_held_do_not_jump(void) {
    static const double images_hz[] = {1.0, 2.0, 3.0, 5.0, 8.0, 10.0, 20.0, 30.0, 60.0};
    static const double fixes_hz[] = {1.0, 2.0, 4.0, 5.0};
    for (size_t i = 0; i < sizeof images_hz / sizeof images_hz[0]; i++) {
        for (size_t j = 0; j < sizeof fixes_hz / sizeof fixes_hz[0]; j++) {
            for (int speed = 10; speed <= 80; speed += 10) {
                scene.image_rate_hz = images_hz[i];
                scene.speed_mps = speed;
                scene.z0_m = 100.0 + 6.0 * speed;
                start(&jumped);
                for (int k = 0; k < (int)(5.0 * images_hz[i]); k++) {
                    goe_image_t image;
                    goe_image_t fix;
                    const double at = floor((k / images_hz[i] + 0.03) * fixes_hz[j]) / fixes_hz[j] * images_hz[i];
                    scene_image(&scene, k, &image, NULL);
                    scene_image(&scene, at > 0.0 ? (int)at : 0, &fix, NULL);
                    memcpy(image.pose.position_ned_m, fix.pose.position_ned_m, sizeof fix.pose.position_ned_m);
                    (void)goe_update(&jumped, &image, &after);
                }
                TEST_ASSERT_EQUAL_UINT32(0u, jumped.fault_counts[LEAPS]);
            }
        }
    }
}

/* [goe_ego_motion.c] GIVEN an aircraft that speeds up by 30 m/s^2 or turns by 3 g THEN nothing jumps. */
static void a_hard_manoeuvre_is_no_jump(void) {
    static const double images_hz[] = {2.0, 4.0, 10.0, 30.0};
    for (size_t i = 0; i < sizeof images_hz / sizeof images_hz[0]; i++) {
        for (int turns = 0; turns < 2; turns++) {
            setUp();
            scene.image_rate_hz = images_hz[i];
            scene.speed_mps = 20.0;
            scene.path = turns ? SCENE_ARC : SCENE_STRAIGHT;
            scene.arc_radius_m = 400.0 / 30.0;
            scene.acceleration_mps2 = turns ? 0.0 : 30.0;
            start(&jumped);
            for (int k = 0; k < (int)(3.0 * images_hz[i]); k++) {
                goe_image_t image;
                scene_image(&scene, k, &image, NULL);
                (void)goe_update(&jumped, &image, &after);
            }
            TEST_ASSERT_EQUAL_UINT32(0u, jumped.fault_counts[LEAPS]);
        }
    }
}

/* [goe_ego_motion.c] GIVEN positions that jump again in every image THEN only the first jump is removed, and the positions count. */
static void a_series_of_jumps_is_motion(void) {
    start(&jumped);
    for (int k = 0; k < IMAGES; k++) {
        goe_image_t image;
        scene_image(&scene, k, &image, NULL);
        if (k >= FIRST) {
            move(&image, 20.0 * (k - FIRST + 1), 0.0);
        }
        (void)goe_update(&jumped, &image, &after);
    }
    TEST_ASSERT_EQUAL_UINT32(1u, jumped.fault_counts[LEAPS]);
    CHECK_CLOSE(2.0, scene.speed_mps + 20.0 * 8.0, (double)jumped.motion.velocity_m_s[1]);
}

/* [goe_ego_motion.c] GIVEN positions that drift by 1 m/s and are corrected by a step each second THEN hardly any step is removed, because the
 * steps together are motion. */
static void a_drift_that_steps_correct_is_no_jump(void) {
    start(&jumped);
    for (int k = 0; k < 15 * IMAGES; k++) {
        goe_image_t image;
        scene.image_rate_hz = 30.0;
        scene_image(&scene, k, &image, NULL);
        move(&image, 1.0 * (k % 30) / 30.0, 0.0);
        (void)goe_update(&jumped, &image, &after);
    }
    check_report("removed of 19 steps", (int)jumped.fault_counts[LEAPS]);
    TEST_ASSERT_TRUE(jumped.fault_counts[LEAPS] >= 1u && jumped.fault_counts[LEAPS] <= 3u);
}

/* Flights towards an obstacle in the way, in which one position in 30 is off by up to wrong_m along each axis, and all others by noise_m (one
 * sigma, configured). */
static void fly_with_wrong_positions(double wrong_m, double noise_m, const char *seed) {
    check_random_t any = check_random_start(seed);
    int late = 0;
    int clear = 0;
    for (int n = 0; n < FLIGHTS; n++) {
        drawn_t drawn = drawn_flight(&scene, &any);
        double first_s = 0.0;
        bool cleared = false;
        drawn.boxes = drawn.boxes || n % 2 == 0;
        const goe_intent_t intent = {{(float)scene.speed_mps, 0.0f, 0.0f}, 15.0f, 10.0f, 0.0f, 0.0f};
        settings = scene_settings(&scene);
        settings.detector.box_noise_rel = (float)drawn.box_share;
        settings.navigation.position_white_sd_m = (float)noise_m;
        CHECK_STATUS(GOE_OK, goe_init(&jumped, sizeof jumped, &settings, NULL));
        for (int k = 0; drawn_left_s(&scene, k) > 0.5; k++) {
            goe_image_t image;
            const double left_s = drawn_left_s(&scene, k);
            drawn_image(&drawn, &scene, &any, k, &image);
            const double north_m =
                check_random_between(&any, -wrong_m, wrong_m); /* one after the other, in any compiler */
            const double east_m = check_random_between(&any, -wrong_m, wrong_m);
            if (check_random_between(&any, 0.0, 30.0) < 1.0) {
                move(&image, north_m, east_m);
            }
            for (int i = 0; i < 2 && noise_m > 0.0; i++) {
                image.pose.position_ned_m[i] += (float)(noise_m * check_random_normal(&any));
            }
            (void)goe_update(&jumped, &image, &after);
            const goe_decision_t decision = goe_decide(&jumped, &intent, NULL, NULL);
            first_s = decision == GOE_DECISION_ACT ? fmax(first_s, left_s) : first_s;
            cleared = cleared || (decision == GOE_DECISION_CLEAR && left_s < 5.0);
        }
        clear += cleared;
        late += first_s < DRAWN_AHEAD_S;
    }
    check_report("late warnings", late);
    check_report("flights with a \"clear\" within 5 s", clear);
    TEST_ASSERT_EQUAL_INT(0, late);
    TEST_ASSERT_TRUE(clear <= (noise_m > 0.0 ? CLEAR_IN_NOISE_MAX : CLEAR_MAX));
}

/* [A27] GIVEN flights towards an obstacle in the way WHEN now and then a position is wrong, by 2 m, 6 m or 20 m THEN every warning comes in time,
 * and hardly any flight is "clear" in the last 5 s. */
static void a_wrong_position_now_and_then_costs_no_warning(void) {
    fly_with_wrong_positions(2.0, 0.0, "positions wrong by 2 m");
    fly_with_wrong_positions(6.0, 0.0, "positions wrong by 6 m");
    fly_with_wrong_positions(20.0, 0.0, "wrong positions");
}

/* [goe_ego_motion.c] GIVEN noisy positions WHEN some are wrong by far more THEN the same, but for some errors within the noise. */
static void a_wrong_position_is_found_in_noise(void) {
    fly_with_wrong_positions(100.0, 1.0, "wrong positions in noise");
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(a_jump_without_a_reset_is_no_motion);
    RUN_TEST(an_old_answer_moves_with_the_jump);
    RUN_TEST(a_small_jump_is_none);
    RUN_TEST(positions_that_are_held_do_not_jump);
    RUN_TEST(a_hard_manoeuvre_is_no_jump);
    RUN_TEST(a_series_of_jumps_is_motion);
    RUN_TEST(a_drift_that_steps_correct_is_no_jump);
    RUN_TEST(a_wrong_position_now_and_then_costs_no_warning);
    RUN_TEST(a_wrong_position_is_found_in_noise);
    return UNITY_END();
}
