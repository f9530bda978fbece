/* Resets of the autopilot's filter: compensated, or a new track, never motion. SPDX-License-Identifier: MIT */
#include <string.h>

#include "check.h"
#include "scene.h"

#define RESETS 0 /* in fault_counts */

static scene_t scene;
static goe_estimator_t plain, jumped;
static goe_estimate_t estimate_plain, estimate_jumped;

/* All positions are multiples of 1/4 m, and so are the jumps: their sums are exact floats. */
void setUp(void) {
    scene_default(&scene);
    const goe_settings_t settings = scene_window_settings(&scene);
    CHECK_STATUS(GOE_OK, goe_init(&plain, sizeof plain, &settings, NULL));
    CHECK_STATUS(GOE_OK, goe_init(&jumped, sizeof jumped, &settings, NULL));
}
void tearDown(void) {}

static const float jump[3] = {37.25f, -12.5f, 3.0f};

/* The k-th image after the filter has jumped `times` times. */
static void image_after(int k, int times, goe_image_t *image) {
    scene_image(&scene, k, image, NULL);
    image->pose.reset_count = (uint8_t)(image->pose.reset_count + times);
    for (int i = 0; i < 3; i++) {
        image->pose.position_ned_m[i] += (float)times * jump[i];
    }
}

static void give_jump(goe_image_t *image, int times) {
    image->pose.reset_delta_known = true;
    for (int i = 0; i < 3; i++) {
        image->pose.reset_delta_ned_m[i] = (float)times * jump[i];
    }
}

static void check_same_but_for_the_origin(int times) {
    const goe_estimate_t *a = &estimate_plain;
    const goe_estimate_t *b = &estimate_jumped;
    TEST_ASSERT_EQUAL_INT(a->model, b->model);
    TEST_ASSERT_EQUAL_HEX32(a->valid, b->valid);
    CHECK_SAME(a->x0_m, b->x0_m);
    CHECK_SAME(a->z0_m, b->z0_m);
    CHECK_SAME(a->x_m, b->x_m);
    CHECK_SAME(a->z_m, b->z_m);
    CHECK_SAME(a->width_m, b->width_m);
    CHECK_SAME(a->length_m, b->length_m);
    CHECK_SAME(a->height_m, b->height_m);
    CHECK_SAME(a->orientation_deg, b->orientation_deg);
    CHECK_SAME(a->baseline_m, b->baseline_m);
    CHECK_SAME(a->sigma.z0_m, b->sigma.z0_m);
    if (a->valid & GOE_HAS_CENTER) { /* NED as of the latest pose */
        TEST_ASSERT_FLOAT_WITHIN(5.0e-5f, a->center_north_m + (float)times * jump[0], b->center_north_m);
        TEST_ASSERT_FLOAT_WITHIN(5.0e-5f, a->center_east_m + (float)times * jump[1], b->center_east_m);
    }
}

/* [A27, goe_ego_motion.c, goe_pose_t.reset_delta_known] GIVEN a flight in which the filter jumps at the 12th image by a known amount
 * WHEN the same flight is flown without a jump THEN both estimates are the same in every bit, but for NED. */
static void a_known_jump_is_compensated(void) {
    for (int k = 0; k < 30; k++) {
        goe_image_t image;
        scene_image(&scene, k, &image, NULL);
        const goe_status_t status = goe_update(&plain, &image, &estimate_plain);
        image_after(k, k >= 12 ? 1 : 0, &image);
        if (k == 12) {
            give_jump(&image, 1);
        }
        CHECK_STATUS(status, goe_update(&jumped, &image, &estimate_jumped));
        check_same_but_for_the_origin(k >= 12 ? 1 : 0);
    }
    TEST_ASSERT_TRUE(estimate_jumped.valid & GOE_HAS_CENTER);
    TEST_ASSERT_EQUAL_UINT32(0u, jumped.fault_counts[RESETS]);
}

/* [goe_pose_t.reset_delta_ned_m] The sum is given if the filter jumped more than once between two images, the counter then skips. */
static void several_jumps_between_two_images_are_one_sum(void) {
    for (int k = 0; k < 24; k++) {
        goe_image_t image;
        scene_image(&scene, k, &image, NULL);
        (void)goe_update(&plain, &image, &estimate_plain);
        image_after(k, k >= 9 ? 3 : 0, &image);
        if (k == 9) {
            give_jump(&image, 3);
        }
        (void)goe_update(&jumped, &image, &estimate_jumped);
        check_same_but_for_the_origin(k >= 9 ? 3 : 0);
    }
}

/* GIVEN a counter that starts at 254 WHEN it wraps from 255 to 0 THEN that is a jump like any other. */
static void the_counter_wraps(void) {
    for (int k = 0; k < 30; k++) {
        goe_image_t image;
        const int times = k < 10 ? 0 : k < 15 ? 1 : k < 20 ? 2 : 3;
        scene_image(&scene, k, &image, NULL);
        (void)goe_update(&plain, &image, &estimate_plain);
        image_after(k, times, &image);
        image.pose.reset_count = (uint8_t)(254 + times);
        if (k == 10 || k == 15 || k == 20) {
            give_jump(&image, 1);
        }
        (void)goe_update(&jumped, &image, &estimate_jumped);
        check_same_but_for_the_origin(times);
    }
    TEST_ASSERT_EQUAL_UINT32(0u, jumped.fault_counts[RESETS]);
}

/* [A22, A27, GOE_FAULT_COUNTS, goe_pose_t.reset_delta_known]
 * GIVEN a track with a solution WHEN the filter jumps by an unknown amount THEN the track starts again with this image:
 * as a new estimator's, and the jump is counted. */
static void an_unknown_jump_starts_a_new_track(void) {
    for (int k = 0; k < 30; k++) {
        goe_image_t image;
        image_after(k, k >= 12 ? 1 : 0, &image);
        const goe_status_t status = goe_update(&jumped, &image, &estimate_jumped);
        if (k < 12) {
            continue;
        }
        CHECK_STATUS(goe_update(&plain, &image, &estimate_plain), status); /* gets only the input after the jump */
        CHECK_STATUS(k < 19 ? GOE_CONVERGING : GOE_OK, status);
        TEST_ASSERT_EQUAL_MEMORY(&estimate_plain, &estimate_jumped, sizeof estimate_plain);
    }
    TEST_ASSERT_EQUAL_UINT32(1u, jumped.fault_counts[RESETS]);
    TEST_ASSERT_EQUAL_UINT32(0u, plain.fault_counts[RESETS]);
}

/* [A22] */
static void an_unknown_jump_leaves_no_old_answer(void) {
    goe_image_t image;
    for (int k = 0; k < 12; k++) {
        scene_image(&scene, k, &image, NULL);
        (void)goe_update(&jumped, &image, &estimate_jumped);
    }
    TEST_ASSERT_TRUE(estimate_jumped.valid & GOE_HAS_POSITION);
    image_after(12, 1, &image);
    (void)goe_update(&jumped, &image, &estimate_jumped);
    TEST_ASSERT_EQUAL_HEX32(GOE_HAS_ORIENTATION, estimate_jumped.valid); /* that of this image alone */
    TEST_ASSERT_EQUAL_INT(GOE_MODEL_NONE, estimate_jumped.model);
    TEST_ASSERT_EQUAL_FLOAT(0.0f, estimate_jumped.z0_m);
    TEST_ASSERT_EQUAL_FLOAT(0.0f, estimate_jumped.age_s);
}

#if GOE_WITH_FILTER
/* [goe_estimator.c]
 * GIVEN an answer of the filter method WHEN the filter jumps while nothing is detected THEN the old answer's center, reported in the
 * autopilot's north and east, moves along with them; values relative to the camera stay. */
static void an_old_answers_center_moves_along(void) {
    goe_image_t image;
    goe_settings_t settings = scene_settings(&scene);
    CHECK_STATUS(GOE_OK, goe_init(&jumped, sizeof jumped, &settings, NULL));
    for (int k = 0; k < 60; k++) {
        scene_image(&scene, k, &image, NULL);
        (void)goe_update(&jumped, &image, &estimate_jumped);
    }
    const goe_estimate_t before = estimate_jumped;
    TEST_ASSERT_EQUAL_INT(GOE_METHOD_FILTER, before.method);
    TEST_ASSERT_TRUE(before.valid & GOE_HAS_CENTER);
    image_after(59, 1, &image);
    give_jump(&image, 1);
    image.pose.time_us += 100000;
    scene_hide_points(&image);
    CHECK_STATUS(GOE_NO_DETECTION, goe_update(&jumped, &image, &estimate_jumped));
    CHECK_CLOSE(1.0e-4, (double)before.center_north_m + (double)jump[0], estimate_jumped.center_north_m);
    CHECK_CLOSE(1.0e-4, (double)before.center_east_m + (double)jump[1], estimate_jumped.center_east_m);
    CHECK_CLOSE(1.0e-4, (double)before.z_m, estimate_jumped.z_m);
}

#endif
/* [A27] GIVEN a camera that hovers WHEN its filter jumps by a known amount again and again THEN there is still no baseline. */
static void jumps_are_never_motion(void) {
    goe_image_t image;
    goe_status_t status = GOE_OK;
    for (int k = 0; k < 20; k++) {
        scene_image(&scene, 0, &image, NULL);
        const int times = k / 2;
        for (int i = 0; i < 3; i++) {
            image.pose.position_ned_m[i] += (float)times * jump[i];
        }
        image.pose.time_us += 100000 * k;
        image.pose.reset_count = (uint8_t)times;
        if (k % 2 == 0) {
            give_jump(&image, k == 0 ? 0 : 1);
        }
        status = goe_update(&jumped, &image, &estimate_jumped);
    }
    CHECK_STATUS(GOE_NO_BASELINE, status);
    TEST_ASSERT_EQUAL_FLOAT(0.0f, jumped.motion.dz_m);
    TEST_ASSERT_EQUAL_FLOAT(0.0f, jumped.motion.dx_m);
}

/* [goe_pose_t.reset_delta_ned_m]
 * A jump is given "since the image before", so one that comes with a refused image is given again with the next. */
static void a_refused_image_does_not_use_up_a_jump(void) {
    for (int k = 0; k < 24; k++) {
        goe_image_t image;
        scene_image(&scene, k, &image, NULL);
        if (k != 12) {
            (void)goe_update(&plain, &image, &estimate_plain);
        }
        image_after(k, k >= 12 ? 1 : 0, &image);
        if (k == 12 || k == 13) {
            give_jump(&image, 1);
        }
        if (k == 12) {
            image.pose.attitude[0] = 0.0f;
            image.pose.attitude[3] = 0.0f;
            image.pose.attitude[2] = 0.0f;
            image.pose.attitude[1] = 0.0f;
            CHECK_STATUS(GOE_BAD_ATTITUDE, goe_update(&jumped, &image, &estimate_jumped));
        } else {
            (void)goe_update(&jumped, &image, &estimate_jumped);
            check_same_but_for_the_origin(k >= 12 ? 1 : 0);
        }
    }
}

/* [A27] A jump with an image without a detection counts as well. */
static void a_jump_without_a_feature_is_compensated(void) {
    for (int k = 0; k < 24; k++) {
        goe_image_t image;
        goe_image_t other;
        scene_image(&scene, k, &image, NULL);
        image_after(k, k >= 12 ? 1 : 0, &other);
        if (k == 12) {
            give_jump(&other, 1);
            goe_image_t empty;
            memset(&empty, 0, sizeof empty);
            empty.pose = image.pose;
            image = empty;
            empty.pose = other.pose;
            other = empty;
        }
        CHECK_STATUS(goe_update(&plain, &image, &estimate_plain), goe_update(&jumped, &other, &estimate_jumped));
        check_same_but_for_the_origin(k >= 12 ? 1 : 0);
    }
}

/* "Read only when reset_count changed and reset_delta_known". */
static void a_delta_is_read_only_with_a_reset(void) {
    for (int k = 0; k < 24; k++) {
        goe_image_t image;
        scene_image(&scene, k, &image, NULL);
        const goe_status_t status = goe_update(&plain, &image, &estimate_plain);
        image.pose.reset_delta_known = k % 2 == 0;
        for (int i = 0; i < 3; i++) {
            image.pose.reset_delta_ned_m[i] = 1000.0f;
        }
        CHECK_STATUS(status, goe_update(&jumped, &image, &estimate_jumped));
        TEST_ASSERT_EQUAL_MEMORY(&estimate_plain, &estimate_jumped, sizeof estimate_plain);
    }
}

static void a_bad_delta_is_ignored_without_a_reset(void) {
    goe_image_t image;
    scene_image(&scene, 0, &image, NULL);
    CHECK_STATUS(GOE_CONVERGING, goe_update(&jumped, &image, &estimate_jumped));
    scene_image(&scene, 1, &image, NULL);
    image.pose.reset_delta_known = true;
    image.pose.reset_delta_ned_m[1] = check_from_bits(0x7FC00000u);
    CHECK_STATUS(GOE_CONVERGING, goe_update(&jumped, &image, &estimate_jumped));
}

static void a_bad_delta_of_a_reset_is_refused(void) {
    goe_image_t image;
    scene_image(&scene, 0, &image, NULL);
    CHECK_STATUS(GOE_CONVERGING, goe_update(&jumped, &image, &estimate_jumped));
    image_after(1, 1, &image);
    give_jump(&image, 1);
    image.pose.reset_delta_ned_m[1] = check_from_bits(0x7FC00000u);
    CHECK_STATUS(GOE_NOT_FINITE, goe_update(&jumped, &image, &estimate_jumped));
    image.pose.reset_delta_ned_m[1] = 1.1e6f;
    CHECK_STATUS(GOE_OUT_OF_RANGE, goe_update(&jumped, &image, &estimate_jumped));
    image.pose.reset_delta_known = false; /* then it is not read */
    CHECK_STATUS(GOE_CONVERGING, goe_update(&jumped, &image, &estimate_jumped));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(a_known_jump_is_compensated);
    RUN_TEST(several_jumps_between_two_images_are_one_sum);
    RUN_TEST(the_counter_wraps);
    RUN_TEST(an_unknown_jump_starts_a_new_track);
    RUN_TEST(an_unknown_jump_leaves_no_old_answer);
#if GOE_WITH_FILTER
    RUN_TEST(an_old_answers_center_moves_along);
#endif
    RUN_TEST(jumps_are_never_motion);
    RUN_TEST(a_refused_image_does_not_use_up_a_jump);
    RUN_TEST(a_jump_without_a_feature_is_compensated);
    RUN_TEST(a_delta_is_read_only_with_a_reset);
    RUN_TEST(a_bad_delta_is_ignored_without_a_reset);
    RUN_TEST(a_bad_delta_of_a_reset_is_refused);
    return UNITY_END();
}
