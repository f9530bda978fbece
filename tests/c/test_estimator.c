/* One estimator over whole flights: statuses, counters, what holds on failure. SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "check.h"
#include "scene.h"

#define WINDOW 8

static scene_t scene;
static goe_settings_t settings;
static goe_estimator_t estimator;
static goe_estimate_t estimate;
static goe_image_t image;

void setUp(void) {
    scene_default(&scene);
    settings = scene_window_settings(&scene);
    memset(&estimate, 0, sizeof estimate);
}
void tearDown(void) {}

static void start(void) {
    settings.camera = scene.camera;
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
}

static goe_status_t update(void) { return goe_update(&estimator, &image, &estimate); }

/* Flies the scene's images from k on. */
static goe_status_t fly(int from, int to) {
    goe_status_t status = GOE_OK;
    for (int k = from; k < to; k++) {
        scene_image(&scene, k, &image, NULL);
        status = update();
    }
    return status;
}

static void hide_all(goe_image_t *of) {
    of->left.visible = false;
    of->right.visible = false;
    of->top.visible = false;
    of->base_left.visible = false;
    of->base_near.visible = false;
    of->base_right.visible = false;
}

/* ------------------------------------------------------------------------------------------------- the normal course -- */

/* [goe_init] */
static void a_new_estimator_knows_nothing(void) {
    start();
    CHECK_STATUS(GOE_CONVERGING, fly(0, 1));
    TEST_ASSERT_EQUAL_INT(GOE_MODEL_NONE, estimate.model);
    TEST_ASSERT_EQUAL_HEX32(GOE_HAS_ORIENTATION, estimate.valid);
    TEST_ASSERT_FALSE(estimate.fresh);
    TEST_ASSERT_EQUAL_INT(0, estimate.images_used);
    TEST_ASSERT_EQUAL_FLOAT(0.0f, estimate.age_s);
    TEST_ASSERT_EQUAL_FLOAT(0.0f, estimate.width_m);
}

/* [A3, goe_estimator.c, goe_image_t.top]
 * GIVEN a cylinder WHEN it is flown past THEN seven images collect and each one from the eighth on solves. */
static void the_disc_solves_from_the_eighth_image_on(void) {
    scene_make_cylinder(&scene);
    start();
    CHECK_STATUS(GOE_CONVERGING, fly(0, WINDOW - 1));
    for (int k = WINDOW - 1; k < 40; k++) {
        CHECK_STATUS(GOE_OK, fly(k, k + 1));
        TEST_ASSERT_EQUAL_INT(GOE_MODEL_DISC, estimate.model);
        TEST_ASSERT_TRUE(estimate.fresh);
        TEST_ASSERT_EQUAL_INT(WINDOW, estimate.images_used);
        TEST_ASSERT_EQUAL_HEX32(GOE_HAS_POSITION | GOE_HAS_HEIGHT | GOE_HAS_CENTER | GOE_HAS_WIDTH, estimate.valid);
    }
}

/* [GOE_MODEL_AUTO] GIVEN a box whose corners are visible only from the 5th image on WHEN flown in auto THEN the disc is reported from the
 * 8th image, and the line from the 8th line point, which is the 13th image. */
static void the_line_takes_over_at_the_eighth_line_point(void) {
    start();
    for (int k = 0; k < 30; k++) {
        scene_image(&scene, k, &image, NULL);
        if (k < 5) {
            image.base_left.visible = false;
            image.base_near.visible = false;
            image.base_right.visible = false;
        }
        const goe_status_t status = update();
        CHECK_STATUS(k < 7 ? GOE_CONVERGING : GOE_OK, status);
        TEST_ASSERT_EQUAL_INT(k < 7 ? GOE_MODEL_NONE : k < 12 ? GOE_MODEL_DISC : GOE_MODEL_LINE, estimate.model);
        TEST_ASSERT_EQUAL_INT(k >= 12, (estimate.valid & GOE_HAS_LENGTH) != 0);
    }
}

/* [GOE_MODEL_AUTO] */
static void the_number_of_line_points_is_a_setting(void) {
    settings.window.line_points = 11;
    start();
    (void)fly(0, 10);
    TEST_ASSERT_EQUAL_INT(GOE_MODEL_DISC, estimate.model);
    (void)fly(10, 11);
    TEST_ASSERT_EQUAL_INT(GOE_MODEL_LINE, estimate.model);
    settings.window.line_points = 1; /* the window still has to be full */
    start();
    (void)fly(0, 7);
    TEST_ASSERT_EQUAL_INT(GOE_MODEL_NONE, estimate.model);
    (void)fly(7, 8);
    TEST_ASSERT_EQUAL_INT(GOE_MODEL_LINE, estimate.model);
    start(); /* ... of line points, too: until it is, the disc is reported */
    for (int k = 0; k < 13; k++) {
        scene_image(&scene, k, &image, NULL);
        image.base_left.visible = image.base_near.visible = image.base_right.visible = k >= 5;
        (void)update();
        TEST_ASSERT_EQUAL_INT(k < 7 ? GOE_MODEL_NONE : k < 12 ? GOE_MODEL_DISC : GOE_MODEL_LINE, estimate.model);
    }
}

/* [GOE_MODEL_AUTO] */
static void the_window_is_a_setting(void) {
    settings.window.points = 3;
    settings.window.line_points = 3;
    start();
    CHECK_STATUS(GOE_CONVERGING, fly(0, 2));
    CHECK_STATUS(GOE_OK, fly(2, 3));
    TEST_ASSERT_EQUAL_INT(3, estimate.images_used);
}

static void a_forced_model_is_never_left(void) {
    settings.model = GOE_MODEL_DISC;
    start();
    for (int k = 0; k < 30; k++) {
        (void)fly(k, k + 1);
        TEST_ASSERT_EQUAL_INT(k < 7 ? GOE_MODEL_NONE : GOE_MODEL_DISC, estimate.model);
        TEST_ASSERT_FALSE(estimate.valid & (GOE_HAS_LENGTH | GOE_HAS_ORIENTATION));
    }
    settings.model = GOE_MODEL_LINE;
    start();
    for (int k = 0; k < 30; k++) {
        (void)fly(k, k + 1);
        TEST_ASSERT_EQUAL_INT(k < 7 ? GOE_MODEL_NONE : GOE_MODEL_LINE, estimate.model);
    }
}

/* ------------------------------------------------------------------------------------ images without a new solution - -- */

/* [goe_estimate_t.x_m]
 * GIVEN a solution WHEN nothing is in view THEN the image's pose is followed, the answer ages, and nothing is at fault. */
static void no_detection_is_no_fault(void) {
    start();
    CHECK_STATUS(GOE_OK, fly(0, 16));
    const goe_estimate_t before = estimate;
    scene_image(&scene, 20, &image, NULL);
    hide_all(&image);
    CHECK_STATUS(GOE_NO_DETECTION, update());
    TEST_ASSERT_FALSE(estimate.fresh);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-6f, 0.625f, estimate.age_s); /* 5 images of 1/8 s */
    TEST_ASSERT_EQUAL_HEX32(before.valid, estimate.valid);
    CHECK_SAME(before.z0_m, estimate.z0_m);
    CHECK_SAME(before.length_m, estimate.length_m);
    CHECK_SAME(before.sigma.z0_m, estimate.sigma.z0_m);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-4f, before.z_m - 10.0f, estimate.z_m); /* 5 images of 2 m */
    for (int i = 0; i < GOE_FAULT_COUNTS; i++) {
        TEST_ASSERT_EQUAL_UINT32(0u, estimator.fault_counts[i]);
    }
    CHECK_STATUS(GOE_OK, fly(21, 22));
    TEST_ASSERT_TRUE(estimate.fresh);
    TEST_ASSERT_EQUAL_FLOAT(0.0f, estimate.age_s);
}

/* [GOE_MODEL_AUTO, goe_window.c] GIVEN the line is reported WHEN an image shows the silhouette alone THEN the line's solution is held. */
static void an_image_without_corners_keeps_the_line(void) {
    start();
    CHECK_STATUS(GOE_OK, fly(0, 16));
    const goe_estimate_t before = estimate;
    scene_image(&scene, 16, &image, NULL);
    image.base_left.visible = false;
    image.base_near.visible = false;
    image.base_right.visible = false;
    CHECK_STATUS(GOE_STALE, update());
    TEST_ASSERT_EQUAL_INT(GOE_MODEL_LINE, estimate.model);
    TEST_ASSERT_FALSE(estimate.fresh);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-6f, 0.125f, estimate.age_s);
    CHECK_SAME(before.z0_m, estimate.z0_m);
    CHECK_SAME(before.height_m, estimate.height_m);
}

static void an_age_is_bounded(void) {
    start();
    CHECK_STATUS(GOE_OK, fly(0, 16));
    hide_all(&image);
    image.pose.time_us += 3999 * (int64_t)1000000;
    CHECK_STATUS(GOE_NO_DETECTION, update());
    TEST_ASSERT_FLOAT_WITHIN(1.0e-3f, 3999.0f, estimate.age_s);
    image.pose.time_us = INT64_MAX;
    CHECK_STATUS(GOE_NO_DETECTION, update());
    TEST_ASSERT_FLOAT_WITHIN(1.0e-3f, 4000.0f, estimate.age_s);
}

/* GIVEN a solution WHEN every image after it is refused THEN it grows old by their times, and a time that runs backwards
 * does not make it younger. */
static void an_estimate_grows_old_while_images_are_refused(void) {
    start();
    CHECK_STATUS(GOE_OK, fly(0, 16));
    const int64_t solved_us = image.pose.time_us;
    image.left.u_px = NAN;
    image.pose.time_us = solved_us + 3 * (int64_t)1000000;
    CHECK_STATUS(GOE_NOT_FINITE, update());
    TEST_ASSERT_FALSE(estimate.fresh);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-6f, 3.0f, estimate.age_s);
    image.pose.time_us = solved_us - 1;
    CHECK_STATUS(GOE_NOT_FINITE, update());
    TEST_ASSERT_EQUAL_FLOAT(0.0f, estimate.age_s);
}

/* [goe_estimator.c] */
static void times_may_start_anywhere(void) {
    start();
    for (int k = 0; k < 10; k++) {
        scene_image(&scene, k, &image, NULL);
        image.pose.time_us = INT64_MIN + 1 + k;
        CHECK_STATUS(k < 7 ? GOE_CONVERGING : GOE_OK, update());
    }
    hide_all(&image);
    image.pose.time_us = INT64_MAX;
    CHECK_STATUS(GOE_NO_DETECTION, update());
    TEST_ASSERT_FLOAT_WITHIN(1.0e-3f, 4000.0f, estimate.age_s);
}

/* GIVEN a box met head-on: one face, parallel to the horizon WHEN the line is forced THEN no edge has a heading. */
static void head_on_has_no_edge(void) {
    settings.model = GOE_MODEL_LINE;
    scene.x0_m = 0.0;
    start();
    CHECK_STATUS(GOE_NO_EDGE, fly(0, 20));
    TEST_ASSERT_EQUAL_UINT32(20u, estimator.fault_counts[-GOE_NO_EDGE]);
    TEST_ASSERT_EQUAL_HEX32(0u, estimate.valid);
    settings.model = GOE_MODEL_AUTO; /* which has the disc */
    start();
    CHECK_STATUS(GOE_OK, fly(0, 20));
    TEST_ASSERT_EQUAL_INT(GOE_MODEL_DISC, estimate.model);
    TEST_ASSERT_EQUAL_UINT32(0u, estimator.fault_counts[-GOE_NO_EDGE]);
}

/* --------------------------------------------------------------------------------- faults of an image that was taken -- */

static void swapped_left_and_right_are_reported(void) {
    scene_make_cylinder(&scene);
    start();
    CHECK_STATUS(GOE_OK, fly(0, 10));
    const goe_estimate_t before = estimate;
    scene_image(&scene, 10, &image, NULL);
    const goe_pixel_t left = image.left;
    image.left = image.right;
    image.right = left;
    CHECK_STATUS(GOE_SWAPPED, update());
    TEST_ASSERT_EQUAL_UINT32(1u, estimator.fault_counts[-GOE_SWAPPED]);
    TEST_ASSERT_FALSE(estimate.fresh);
    CHECK_SAME(before.width_m, estimate.width_m);
    CHECK_STATUS(GOE_OK, fly(11, 12));
}

/* [A21, GOE_FAULT_COUNTS, GOE_IMAGE_TAKEN, goe_update] The camera looks back: every ray is behind. */
static void an_obstacle_behind_is_reported(void) {
    start();
    CHECK_STATUS(GOE_OK, fly(0, 10));
    scene_image(&scene, 10, &image, NULL);
    image.pose.attitude[0] = 0.0f; /* heading south */
    image.pose.attitude[1] = 0.0f;
    image.pose.attitude[2] = 0.0f;
    image.pose.attitude[3] = 1.0f;
    CHECK_STATUS(GOE_BEHIND_CAMERA, update());
    TEST_ASSERT_EQUAL_UINT32(6u, estimator.fault_counts[-GOE_BEHIND_CAMERA]);
    TEST_ASSERT_FALSE(estimate.fresh);
    TEST_ASSERT_TRUE(estimate.valid & GOE_HAS_POSITION);
}

/* A fault of one feature does not lose the others. */
static void a_fault_next_to_a_solution_is_partial(void) {
    start();
    CHECK_STATUS(GOE_OK, fly(0, 10));
    scene_image(&scene, 10, &image, NULL);
    image.pose.height_m = 0.0f;
    CHECK_STATUS(GOE_PARTIAL, update());
    TEST_ASSERT_TRUE(estimate.fresh);
    TEST_ASSERT_TRUE(estimate.valid & GOE_HAS_HEIGHT); /* that of the images before */
    TEST_ASSERT_EQUAL_UINT32(1u, estimator.fault_counts[-GOE_BAD_HEIGHT]);
    image.pose.time_us += 1;
    image.pose.height_m = -20.0f;
    CHECK_STATUS(GOE_PARTIAL, update());
    TEST_ASSERT_EQUAL_UINT32(2u, estimator.fault_counts[-GOE_BAD_HEIGHT]);
    scene_image(&scene, 11, &image, NULL);
    const goe_pixel_t left = image.left; /* the disc is not reported */
    image.left = image.right;
    image.right = left;
    CHECK_STATUS(GOE_PARTIAL, update());
    TEST_ASSERT_EQUAL_INT(GOE_MODEL_LINE, estimate.model);
}

static void a_negative_height_all_along_gives_no_height(void) {
    scene_make_cylinder(&scene);
    start();
    for (int k = 0; k < 12; k++) {
        scene_image(&scene, k, &image, NULL);
        image.pose.height_m = -1.0f;
        CHECK_STATUS(k < 7 ? GOE_CONVERGING : GOE_PARTIAL, update());
        TEST_ASSERT_FALSE(estimate.valid & GOE_HAS_HEIGHT);
        TEST_ASSERT_EQUAL_FLOAT(0.0f, estimate.height_m);
    }
}

/* GIVEN a top below the ground THEN the mean of the heights is not valid, and is not reported. */
static void a_height_that_is_not_positive_is_none(void) {
    scene_make_cylinder(&scene);
    start();
    for (int k = 0; k < 12; k++) {
        scene_image(&scene, k, &image, NULL);
        image.top.v_px += 800.0f;
        CHECK_STATUS(k < 7 ? GOE_CONVERGING : GOE_OK, update());
        TEST_ASSERT_FALSE(estimate.valid & GOE_HAS_HEIGHT);
        TEST_ASSERT_EQUAL_FLOAT(0.0f, estimate.height_m);
        TEST_ASSERT_EQUAL_FLOAT(0.0f, estimate.sigma.height_m);
    }
}

/* [window.side_min_px] GIVEN a truck flown past with its side pointing at the camera THEN lengths are skipped and the status reports it. */
static void a_side_viewed_edge_on_gives_no_length(void) {
    scene.x0_m = -1.9; /* the plane of the right side passes 0.65 m from the camera */
    scene.z0_m = 80.0;
    start();
    (void)fly(0, 8);
    CHECK_STATUS(GOE_PARTIAL, fly(8, 9));
    TEST_ASSERT_EQUAL_INT(GOE_MODEL_LINE, estimate.model);
    TEST_ASSERT_FALSE(estimate.valid & (GOE_HAS_LENGTH | GOE_HAS_CENTER));
    TEST_ASSERT_GREATER_THAN_UINT32(0u, estimator.fault_counts[-GOE_EDGE_ON]);
}

/* ------------------------------------------------------------------------------------------- failures of the solution -- */

/* [GOE_IMAGE_TAKEN] */
static void hovering_has_no_baseline(void) {
    scene_make_cylinder(&scene);
    scene.speed_mps = 0.0;
    start();
    CHECK_STATUS(GOE_CONVERGING, fly(0, 7));
    CHECK_STATUS(GOE_NO_BASELINE, fly(7, 12));
    TEST_ASSERT_EQUAL_UINT32(5u, estimator.fault_counts[-GOE_NO_BASELINE]);
    TEST_ASSERT_EQUAL_HEX32(0u, estimate.valid);
}

/* GIVEN a solution WHEN the camera stops THEN the last good answer stays, stale. */
static void stopping_keeps_the_last_answer(void) {
    scene_make_cylinder(&scene);
    start();
    CHECK_STATUS(GOE_OK, fly(0, 12));
    goe_status_t status = GOE_OK;
    goe_estimate_t last = estimate;
    for (int k = 0; k < 12; k++) {
        image.pose.time_us += 125000;
        last = estimate.fresh ? estimate : last;
        status = update();
    }
    CHECK_STATUS(GOE_NO_BASELINE, status);
    TEST_ASSERT_FALSE(estimate.fresh);
    TEST_ASSERT_TRUE(estimate.age_s > 0.5f);
    CHECK_SAME(last.z0_m, estimate.z0_m);
    CHECK_SAME(last.width_m, estimate.width_m);
}

/* [goe_update]
 * GIVEN base corners out of order in images that cannot be solved either THEN both are counted, and the solution's failure is reported;
 * before there is one to solve, the feature's fault is. */
static void a_failed_solution_is_reported_before_a_feature_s_fault(void) {
    scene.speed_mps = 0.0;
    start();
    for (int k = 0; k < 12; k++) {
        scene_image(&scene, k, &image, NULL);
        const goe_pixel_t left = image.base_left;
        image.base_left = image.base_right;
        image.base_right = left;
        CHECK_STATUS(k < WINDOW - 1 ? GOE_SWAPPED : GOE_NO_BASELINE, update());
    }
    TEST_ASSERT_EQUAL_UINT32(12u, estimator.fault_counts[-GOE_SWAPPED]);
    TEST_ASSERT_EQUAL_UINT32(5u, estimator.fault_counts[-GOE_NO_BASELINE]);
}

/* An obstacle that flies along ahead of us never grows. */
static void a_moving_obstacle_has_no_parallax(void) {
    scene_make_cylinder(&scene);
    start();
    goe_status_t status = GOE_OK;
    for (int k = 0; k < 12; k++) {
        goe_image_t first;
        scene_image(&scene, 0, &first, NULL);
        scene_image(&scene, k, &image, NULL);
        first.pose = image.pose;
        image = first;
        status = update();
    }
    CHECK_STATUS(GOE_NO_PARALLAX, status);
    TEST_ASSERT_EQUAL_UINT32(5u, estimator.fault_counts[-GOE_NO_PARALLAX]);
}

/* GIVEN an obstacle that grows faster than our own motion explains: the line through the window meets Z = 0 before its
 * end THEN it is reported as passed, and no solution is made of it. */
static void an_obstacle_that_is_said_to_lie_behind_is_passed(void) {
    scene_make_cylinder(&scene);
    start();
    goe_status_t status = GOE_OK;
    for (int k = 0; k < 8; k++) {
        goe_image_t close;
        scene_image(&scene, k, &image, NULL);
        scene_image(&scene, 46, &close, NULL);
        if (k >= 2) {
            close.pose = image.pose;
            image = close;
        }
        status = update();
    }
    CHECK_STATUS(GOE_ABEAM, status);
    TEST_ASSERT_EQUAL_UINT32(1u, estimator.fault_counts[-GOE_ABEAM]);
    TEST_ASSERT_EQUAL_HEX32(0u, estimate.valid);
}

/* --------------------------------------------------------------------------------- refused images, and bad arguments -- */

/* The estimator is as it was, but for one counter and the age of the latest image taken. */
static void check_refused(goe_status_t expected) {
    static goe_estimator_t before;
    const goe_estimate_t reported = estimate;
    memcpy(&before, &estimator, sizeof before);
    memset(&estimate, 0xA5, sizeof estimate);
    CHECK_STATUS(expected, update());
    TEST_ASSERT_EQUAL_UINT32(before.fault_counts[-expected] + 1u, estimator.fault_counts[-expected]);
    before.fault_counts[-expected]++;
    before.estimate.age_s = estimator.estimate.age_s;
    TEST_ASSERT_EQUAL_MEMORY(&before, &estimator, sizeof before);
    TEST_ASSERT_FALSE(estimate.fresh); /* always written */
    TEST_ASSERT_EQUAL_HEX32(reported.valid, estimate.valid);
    TEST_ASSERT_EQUAL_INT(reported.model, estimate.model);
    CHECK_SAME(reported.z0_m, estimate.z0_m);
    CHECK_SAME(reported.x_m, estimate.x_m);
    CHECK_SAME(reported.length_m, estimate.length_m);
    CHECK_SAME(reported.sigma.height_m, estimate.sigma.height_m);
}

/* [A17, A21, GOE_FAULT_COUNTS, goe_intake.c] */
static void every_number_read_is_checked(void) {
    static const uint32_t patterns[] = {0x7F800000u, 0xFF800000u, 0x7FC00000u, 0xFFFFFFFFu, 0x7F800001u};
    goe_image_t good;
    start();
    CHECK_STATUS(GOE_OK, fly(0, 12));
    scene_image(&scene, 12, &good, NULL);
    const struct {
        float *at;
        float limit;
    } numbers[] = {
        {&image.pose.position_ned_m[0], 1.0e6f},
        {&image.pose.position_ned_m[1], 1.0e6f},
        {&image.pose.position_ned_m[2], 1.0e6f},
        {&image.pose.height_m, 1.0e5f},
        {&image.left.u_px, 1.0e5f},
        {&image.left.v_px, 1.0e5f},
        {&image.right.u_px, 1.0e5f},
        {&image.right.v_px, 1.0e5f},
        {&image.top.u_px, 1.0e5f},
        {&image.top.v_px, 1.0e5f},
        {&image.base_left.u_px, 1.0e5f},
        {&image.base_left.v_px, 1.0e5f},
        {&image.base_near.u_px, 1.0e5f},
        {&image.base_near.v_px, 1.0e5f},
        {&image.base_right.u_px, 1.0e5f},
        {&image.base_right.v_px, 1.0e5f},
    };
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        for (size_t p = 0; p < sizeof patterns / sizeof patterns[0]; p++) {
            image = good;
            *numbers[i].at = check_from_bits(patterns[p]);
            check_refused(GOE_NOT_FINITE);
        }
        image = good;
        *numbers[i].at = check_next_away(numbers[i].limit);
        check_refused(GOE_OUT_OF_RANGE);
        *numbers[i].at = check_next_away(-numbers[i].limit);
        check_refused(GOE_OUT_OF_RANGE);
    }
    for (int i = 0; i < 4; i++) {
        for (size_t p = 0; p < sizeof patterns / sizeof patterns[0]; p++) {
            image = good;
            image.pose.attitude[i] = check_from_bits(patterns[p]);
            check_refused(GOE_NOT_FINITE);
        }
    }
    image = good;
    CHECK_STATUS(GOE_OK, update()); /* none of them left a trace */
}

/* [goe_estimator.c]
 * GIVEN numbers just at the ends of their ranges THEN the image is taken: the header gives them as the ends, not beyond. */
static void the_ends_of_ranges_are_within(void) {
    goe_image_t good;
    start();
    CHECK_STATUS(GOE_OK, fly(0, 12));
    scene_image(&scene, 12, &good, NULL);
    float *const numbers[] = {&image.left.u_px, &image.top.v_px, &image.pose.height_m, &image.pose.position_ned_m[2]};
    for (size_t i = 0; i < 8; i++) {
        image = good;
        image.pose.time_us += (int64_t)i;
        *numbers[i / 2] = (i % 2 == 0 ? 1.0f : -1.0f) * (i / 2 == 3 ? 1.0e6f : 1.0e5f);
        const goe_status_t status = update();
        TEST_ASSERT_TRUE(status != GOE_OUT_OF_RANGE && status != GOE_NOT_FINITE);
    }
}

/* [goe_estimator.c]
 * GIVEN a box and points, one of both bad THEN the image is refused, whichever it is: the checks of the one do not replace those of the
 * other. */
static void points_and_boxes_are_both_checked(void) {
    goe_image_t good;
    start();
    CHECK_STATUS(GOE_OK, fly(0, 12));
    scene_image(&scene, 12, &good, NULL);
    good.box = (goe_box_t){500.0f, 500.0f, 700.0f, 700.0f, GOE_SIDES_ALL};
    float *const numbers[] = {&image.base_near.u_px, &image.box.left_px, &image.box.top_px, &image.box.right_px,
                              &image.box.bottom_px};
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        image = good;
        image.base_near.visible = true;
        *numbers[i] = 2.0e5f;
        check_refused(GOE_OUT_OF_RANGE);
        *numbers[i] = check_from_bits(0x7F800000u);
        check_refused(GOE_NOT_FINITE);
        image.box.sides = (uint8_t)(i == 0 ? 0 : GOE_SIDES_ALL & ~(1u << (i - 1)));
        image.base_near.visible = i != 0;
        TEST_ASSERT_TRUE(update() != GOE_NOT_FINITE); /* not visible: not read */
        image.pose.time_us += 1;
        good.pose.time_us = image.pose.time_us;
    }
}

/* [goe_estimator.c]
 * GIVEN a box whose left is not left of its right, or whose top not above its bottom THEN none of its sides counts, and that is reported.
 * */
static void a_box_out_of_order_does_not_count(void) {
    for (int n = 0; n < 2; n++) {
        start();
        CHECK_STATUS(GOE_OK, fly(0, 12));
        const int before = estimator.window.disc.count;
        scene_image(&scene, 12, &image, NULL);
        scene_hide_points(&image);
        image.box = (goe_box_t){500.0f, 500.0f, n == 0 ? 500.0f : 700.0f, n == 1 ? 500.0f : 700.0f, GOE_SIDES_ALL};
        (void)update();
        TEST_ASSERT_EQUAL_UINT32(1u, estimator.fault_counts[-GOE_SWAPPED]);
        TEST_ASSERT_EQUAL_INT(before, estimator.window.disc.count); /* no points were made of it */
    }
}

/* [goe_pixel_t.visible] */
static void invisible_features_are_not_read(void) {
    start();
    CHECK_STATUS(GOE_OK, fly(0, 12));
    scene_image(&scene, 12, &image, NULL);
    image.top.visible = false;
    image.top.u_px = check_from_bits(0x7FC00000u);
    image.top.v_px = 1.0e30f;
    CHECK_STATUS(GOE_OK, update());
}

/* [A21] */
static void time_must_run_on(void) {
    start();
    CHECK_STATUS(GOE_OK, fly(0, 12));
    const int64_t now = image.pose.time_us;
    const int64_t bad[] = {now, now - 1, now - 125000, 0, -1, INT64_MIN + 1, GOE_TIME_UNKNOWN};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        scene_image(&scene, 12, &image, NULL);
        image.pose.time_us = bad[i];
        check_refused(GOE_BAD_TIME);
    }
    image.pose.time_us = now + 1;
    CHECK_STATUS(GOE_OK, update());
}

/* [goe_init]
 * GIVEN settings that change after goe_init, and an estimator of which every byte is set THEN the estimator keeps what it was given,
 * and begins with zeroed counters. */
static void the_settings_are_copied_and_the_counters_zeroed(void) {
    memset(&estimator, 0xA5, sizeof estimator);
    start();
    for (int i = 0; i < GOE_FAULT_COUNTS; i++) {
        TEST_ASSERT_EQUAL_UINT32(0u, estimator.fault_counts[i]);
    }
    const goe_settings_t given = settings;
    memset(&settings, 0xFF, sizeof settings);
    TEST_ASSERT_EQUAL_MEMORY(&given, &estimator.settings, sizeof given);
    CHECK_STATUS(GOE_OK, fly(0, 12));
}

static void the_first_image_needs_a_time(void) {
    start();
    scene_image(&scene, 0, &image, NULL);
    image.pose.time_us = GOE_TIME_UNKNOWN;
    CHECK_STATUS(GOE_BAD_TIME, update());
    TEST_ASSERT_TRUE(estimator.motion.time_us == GOE_TIME_UNKNOWN);
}

static void a_quaternion_may_be_off_by_one_percent(void) {
    start();
    CHECK_STATUS(GOE_OK, fly(0, 12));
    const struct {
        float norm;
        bool good;
    } cases[] = {{0.0f, false},   {1.0e-30f, false}, {0.98f, false},   {0.9899f, false},
                 {0.9901f, true}, {1.0099f, true},   {1.0101f, false}, {1.02f, false},
                 {1.9f, false},   {-0.995f, true},   {3.0f, false}};
    for (int i = 0; i < (int)(sizeof cases / sizeof cases[0]); i++) {
        scene_image(&scene, 12 + i, &image, NULL);
        for (int k = 0; k < 4; k++) {
            image.pose.attitude[k] *= cases[i].norm;
        }
        if (cases[i].good) {
            CHECK_STATUS(GOE_OK, update());
        } else {
            check_refused(GOE_BAD_ATTITUDE);
        }
    }
}

/* [goe_estimator.c]
 * GIVEN a number of a camera that the settings do not have THEN the image is refused whole: there is no mounting to turn it by. */
static void an_image_of_no_camera_is_refused(void) {
    start();
    CHECK_STATUS(GOE_OK, fly(0, 12));
    scene_image(&scene, 12, &image, NULL);
    image.camera = GOE_CAMERAS_MAX;
    check_refused(GOE_OUT_OF_RANGE);
    image.camera = UINT8_MAX;
    check_refused(GOE_OUT_OF_RANGE);
    image.camera = 0;
    CHECK_STATUS(GOE_OK, update());
}

/* [goe_fault.c, goe_update] The order of the checks, each over the whole image. */
static void the_first_fault_is_reported(void) {
    start();
    CHECK_STATUS(GOE_OK, fly(0, 12));
    for (int i = 0; i < 4; i++) {
        image.pose.attitude[i] = 0.0f;
    }
    check_refused(GOE_BAD_TIME); /* repeated, and a zero quaternion */
    image.left.u_px = 2.0e5f;
    check_refused(GOE_OUT_OF_RANGE);
    image.base_right.v_px = check_from_bits(0x7F800000u);
    check_refused(GOE_NOT_FINITE);
}

/* [GOE_FAULT_COUNTS] Counters stop at their largest value. */
static void counters_saturate(void) {
    start();
    CHECK_STATUS(GOE_OK, fly(0, 12));
    estimator.fault_counts[-GOE_BAD_TIME] = UINT32_MAX;
    CHECK_STATUS(GOE_BAD_TIME, update());
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, estimator.fault_counts[-GOE_BAD_TIME]);
}

/* [A18] */
static void null_pointers_are_refused(void) {
    goe_estimate_t nothing;
    start();
    scene_image(&scene, 0, &image, NULL);
    memset(&nothing, 0, sizeof nothing);
    memset(&estimate, 0xA5, sizeof estimate);
    CHECK_STATUS(GOE_BAD_ARGUMENT, goe_update(NULL, &image, &estimate));
    TEST_ASSERT_EQUAL_MEMORY(&nothing, &estimate, sizeof estimate);
    memset(&estimate, 0xA5, sizeof estimate);
    CHECK_STATUS(GOE_BAD_ARGUMENT, goe_update(&estimator, NULL, &estimate));
    TEST_ASSERT_EQUAL_MEMORY(&nothing, &estimate, sizeof estimate);
    CHECK_STATUS(GOE_BAD_ARGUMENT, goe_update(&estimator, &image, NULL));
    CHECK_STATUS(GOE_BAD_ARGUMENT, goe_reset(NULL));
    TEST_ASSERT_TRUE(estimator.motion.time_us == GOE_TIME_UNKNOWN);
}

/* [goe_update] */
static void an_estimator_must_be_initialized(void) {
    static const int fills[] = {0x00, 0xFF, 0xA5};
    goe_estimate_t nothing;
    memset(&nothing, 0, sizeof nothing);
    scene_image(&scene, 0, &image, NULL);
    for (int i = 0; i < 3; i++) {
        static goe_estimator_t before;
        memset(&estimator, fills[i], sizeof estimator);
        memset(&before, fills[i], sizeof before);
        memset(&estimate, 0x5A, sizeof estimate);
        CHECK_STATUS(GOE_NOT_INITIALIZED, update());
        CHECK_STATUS(GOE_NOT_INITIALIZED, goe_reset(&estimator));
        TEST_ASSERT_EQUAL_MEMORY(&before, &estimator, sizeof before);
        TEST_ASSERT_EQUAL_MEMORY(&nothing, &estimate, sizeof estimate);
    }
}

/* Of the window's answer: the sigmas squared, and nothing next to the diagonal; all 0 without a position. */
static void the_covariance_is_the_sigmas_squared(void) {
    static const float nothing[GOE_QUANTITIES][GOE_QUANTITIES];
    float covariance[GOE_QUANTITIES][GOE_QUANTITIES];
    start();
    (void)fly(0, 4);
    memset(covariance, 0xFF, sizeof covariance);
    CHECK_STATUS(GOE_CONVERGING, goe_covariance(&estimator, covariance));
    TEST_ASSERT_EQUAL_MEMORY(nothing, covariance, sizeof covariance);
    CHECK_STATUS(GOE_OK, fly(4, 20));
    const goe_sigma_t *s = &estimate.sigma;
    const float sigma[GOE_QUANTITIES] = {[GOE_X0] = s->x0_m,         [GOE_Z0] = s->z0_m,
                                         [GOE_WIDTH] = s->width_m,   [GOE_ORIENTATION] = s->orientation_deg,
                                         [GOE_LENGTH] = s->length_m, [GOE_HEIGHT] = s->height_m};
    CHECK_STATUS(GOE_OK, goe_covariance(&estimator, covariance));
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        TEST_ASSERT_TRUE(sigma[i] > 0.0f);
        for (int j = 0; j < GOE_QUANTITIES; j++) {
            CHECK_SAME(i == j ? sigma[i] * sigma[i] : 0.0f, covariance[i][j]);
        }
    }
}

/* ------------------------------------------------------------------------------------------------------------- tracks -- */

/* [A7] GIVEN a track WHEN it is reset THEN the estimator goes on as a new one, but keeps its counters. */
static void a_reset_forgets_the_track_and_keeps_the_counters(void) {
    static goe_estimator_t other;
    start();
    CHECK_STATUS(GOE_OK, fly(0, 12));
    CHECK_STATUS(GOE_BAD_TIME, update());
    CHECK_STATUS(GOE_OK, goe_reset(&estimator));
    TEST_ASSERT_EQUAL_UINT32(1u, estimator.fault_counts[-GOE_BAD_TIME]);
    settings.camera = scene.camera;
    CHECK_STATUS(GOE_OK, goe_init(&other, sizeof other, &settings, NULL));
    for (int k = 0; k < 20; k++) { /* an earlier time is no fault of a new track */
        goe_estimate_t expected;
        scene_image(&scene, k, &image, NULL);
        CHECK_STATUS(goe_update(&other, &image, &expected), update());
        TEST_ASSERT_EQUAL_MEMORY(&expected, &estimate, sizeof expected);
    }
}

/* [A11] GIVEN two obstacles in the same images WHEN two estimators take turns THEN each gives the same result as alone. */
static void estimators_share_nothing(void) {
    static goe_estimator_t second;
    static goe_estimate_t alone[24];
    scene_t chimney = scene;
    goe_estimate_t of_second;
    goe_image_t other_image;
    chimney.shape = SCENE_CYLINDER;
    chimney.x0_m = 25.0;
    start();
    for (int k = 0; k < 24; k++) {
        (void)fly(k, k + 1);
        alone[k] = estimate;
    }
    start();
    settings.model = GOE_MODEL_DISC;
    CHECK_STATUS(GOE_OK, goe_init(&second, sizeof second, &settings, NULL));
    for (int k = 0; k < 24; k++) {
        scene_image(&chimney, k, &other_image, NULL);
        (void)goe_update(&second, &other_image, &of_second);
        (void)fly(k, k + 1);
        TEST_ASSERT_EQUAL_MEMORY(&alone[k], &estimate, sizeof estimate);
    }
    TEST_ASSERT_FLOAT_WITHIN(0.1f, 25.0f, of_second.x0_m);
}

/* [A33] A copy of an estimator is an estimator: nothing in it points into itself. */
static void an_estimator_may_be_moved(void) {
    static goe_estimator_t copy;
    goe_estimate_t of_copy;
    start();
    CHECK_STATUS(GOE_OK, fly(0, 12));
    memcpy(&copy, &estimator, sizeof copy);
    for (int k = 12; k < 20; k++) {
        (void)fly(k, k + 1);
        (void)goe_update(&copy, &image, &of_copy);
        TEST_ASSERT_EQUAL_MEMORY(&estimate, &of_copy, sizeof estimate);
    }
}

static void a_set_heading_turns_the_trajectory_frame(void) {
    settings.heading_auto = false;
    settings.heading_deg = 10.0f;
    start();
    CHECK_STATUS(GOE_OK, fly(0, 20));
    /* (X, Z) = (-12, 100) viewed from a frame turned by 10 degrees to the right */
    TEST_ASSERT_FLOAT_WITHIN(0.05f, -12.0f * 0.98480775f - 100.0f * 0.17364818f, estimate.x0_m);
    TEST_ASSERT_FLOAT_WITHIN(0.05f, 100.0f * 0.98480775f - 12.0f * 0.17364818f, estimate.z0_m);
    TEST_ASSERT_FLOAT_WITHIN(0.05f, -10.0f, estimate.orientation_deg);
}

/* [A5, goe_estimator.c]
 * GIVEN images without a feature, on another heading WHEN something is detected for the first time THEN the track begins there, with
 * heading, origin and time of that image. */
static void a_track_begins_at_first_sight(void) {
    start();
    for (int k = 0; k < 8; k++) {
        scene_image(&scene, k, &image, NULL);
        if (k < 5) {
            hide_all(&image);
            image.pose.attitude[0] = image.pose.attitude[3] = 0.707106781f; /* east */
            image.pose.attitude[1] = image.pose.attitude[2] = 0.0f;
        }
        (void)update();
        CHECK_CLOSE(1.0e-3, k < 5 ? 90.0 : 0.0, estimate.trajectory_heading_deg);
    }
    CHECK_CLOSE(1.0e-3, 2.0 * scene.speed_mps / scene.image_rate_hz, estimator.motion.dz_m);
    CHECK_CLOSE(1.0e-3, 0.0, estimator.motion.dx_m);
    TEST_ASSERT_TRUE(estimator.motion.start_time_us == 1000000 + 5 * 125000);
}

/* [A7]
 * GIVEN a track that began before a turn, and no position yet WHEN all visible features are more than 60 degrees from Z and the nose
 * has turned by more than 45 THEN the track begins again; one feature nearer to Z is enough to continue. The image's faults count once. */
static void a_track_begins_again_after_a_turn(void) {
    goe_pixel_t *const features[] = {&image.left,      &image.right,     &image.top,
                                     &image.base_left, &image.base_near, &image.base_right};
    for (int ahead = -1; ahead < GOE_FEATURES; ahead++) {
        for (int turned = 0; turned < 2; turned++) {
            start();
            scene_image(&scene, 0, &image, NULL);
            image.pose.attitude[0] = 1.0f;
            image.pose.attitude[1] = image.pose.attitude[2] = image.pose.attitude[3] = 0.0f;
            (void)update();
            image.pose.time_us += 125000;
            image.pose.attitude[0] = turned == 1 ? 0.793353340f : 0.965925826f; /* 75 degrees, or 30 */
            image.pose.attitude[3] = turned == 1 ? 0.608761429f : 0.258819045f;
            for (int i = 0; i < GOE_FEATURES; i++) {
                *features[i] = (goe_pixel_t){i == ahead ? 10.0f : 1270.0f, 640.0f, true};
            }
            image.right.u_px = 5.0f; /* out of order with left */
            image.right.visible = ahead == -1 ? false : image.right.visible;
            const uint32_t before = estimator.fault_counts[-GOE_SWAPPED] + estimator.fault_counts[-GOE_BEHIND_CAMERA];
            (void)update();
            const bool again = turned == 1 && ahead == -1;
            CHECK_CLOSE(1.0e-3, again ? 75.0 : 0.0, estimate.trajectory_heading_deg);
            if (again) {
                TEST_ASSERT_EQUAL_UINT32(before, estimator.fault_counts[-GOE_SWAPPED] +
                                                     estimator.fault_counts[-GOE_BEHIND_CAMERA]);
            }
        }
    }
}

/* [A7] GIVEN a position that is known WHEN the nose turns THEN T stays. */
static void a_turn_leaves_a_known_track_alone(void) {
    start();
    CHECK_STATUS(GOE_OK, fly(0, 20));
    scene_image(&scene, 20, &image, NULL);
    image.pose.attitude[0] = image.pose.attitude[3] = 0.707106781f;
    image.pose.attitude[1] = image.pose.attitude[2] = 0.0f;
    const float heading_deg = estimate.trajectory_heading_deg;
    (void)update();
    CHECK_SAME(heading_deg, estimate.trajectory_heading_deg);
    TEST_ASSERT_TRUE(estimate.valid & GOE_HAS_POSITION);
}

/* [heading_auto] A nose that points straight up has no heading: T looks north. */
static void a_vertical_nose_takes_north(void) {
    start();
    scene_image(&scene, 0, &image, NULL);
    hide_all(&image);
    image.pose.attitude[0] = 0.5f;
    image.pose.attitude[1] = 0.5f;
    image.pose.attitude[2] = 0.5f;
    image.pose.attitude[3] = -0.5f;
    /* rotation of 120 degrees about (1, 1, -1): forward goes to -down, with no level part */
    CHECK_STATUS(GOE_NO_DETECTION, update());
    TEST_ASSERT_EQUAL_FLOAT(1.0f, estimator.motion.heading_cos);
    TEST_ASSERT_EQUAL_FLOAT(0.0f, estimator.motion.heading_sin);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(a_new_estimator_knows_nothing);
    RUN_TEST(the_disc_solves_from_the_eighth_image_on);
    RUN_TEST(the_line_takes_over_at_the_eighth_line_point);
    RUN_TEST(the_number_of_line_points_is_a_setting);
    RUN_TEST(the_window_is_a_setting);
    RUN_TEST(a_forced_model_is_never_left);
    RUN_TEST(no_detection_is_no_fault);
    RUN_TEST(an_image_without_corners_keeps_the_line);
    RUN_TEST(an_age_is_bounded);
    RUN_TEST(an_estimate_grows_old_while_images_are_refused);
    RUN_TEST(times_may_start_anywhere);
    RUN_TEST(head_on_has_no_edge);
    RUN_TEST(swapped_left_and_right_are_reported);
    RUN_TEST(an_obstacle_behind_is_reported);
    RUN_TEST(a_fault_next_to_a_solution_is_partial);
    RUN_TEST(a_negative_height_all_along_gives_no_height);
    RUN_TEST(a_height_that_is_not_positive_is_none);
    RUN_TEST(a_side_viewed_edge_on_gives_no_length);
    RUN_TEST(hovering_has_no_baseline);
    RUN_TEST(stopping_keeps_the_last_answer);
    RUN_TEST(a_failed_solution_is_reported_before_a_feature_s_fault);
    RUN_TEST(a_moving_obstacle_has_no_parallax);
    RUN_TEST(an_obstacle_that_is_said_to_lie_behind_is_passed);
    RUN_TEST(every_number_read_is_checked);
    RUN_TEST(the_ends_of_ranges_are_within);
    RUN_TEST(points_and_boxes_are_both_checked);
    RUN_TEST(a_box_out_of_order_does_not_count);
    RUN_TEST(invisible_features_are_not_read);
    RUN_TEST(time_must_run_on);
    RUN_TEST(the_settings_are_copied_and_the_counters_zeroed);
    RUN_TEST(the_first_image_needs_a_time);
    RUN_TEST(a_quaternion_may_be_off_by_one_percent);
    RUN_TEST(an_image_of_no_camera_is_refused);
    RUN_TEST(the_first_fault_is_reported);
    RUN_TEST(counters_saturate);
    RUN_TEST(null_pointers_are_refused);
    RUN_TEST(an_estimator_must_be_initialized);
    RUN_TEST(the_covariance_is_the_sigmas_squared);
    RUN_TEST(a_reset_forgets_the_track_and_keeps_the_counters);
    RUN_TEST(estimators_share_nothing);
    RUN_TEST(an_estimator_may_be_moved);
    RUN_TEST(a_set_heading_turns_the_trajectory_frame);
    RUN_TEST(a_track_begins_at_first_sight);
    RUN_TEST(a_track_begins_again_after_a_turn);
    RUN_TEST(a_turn_leaves_a_known_track_alone);
    RUN_TEST(a_vertical_nose_takes_north);
    return UNITY_END();
}
