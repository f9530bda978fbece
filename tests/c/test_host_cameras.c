/* Two cameras of one aircraft: an obstacle flies out of one and into the other. SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "check.h"
#include "goe_guard.h"
#include "scene.h"

#define IMAGES 56
#define VISIBLE_DEG 32.0 /* off the axis of a camera: half of what it sees across */
#define YAW_AHEAD_DEG (-25.0f)
#define YAW_ASIDE_DEG (-75.0f)
#define EXACT_M 0.02
#define NOISE_PX 0.3
#define Z0_M 60.0
#define X0_M (-18.0)

typedef enum { SEES_POINTS, SEES_CORNERS, SEES_BOXES, SIGHTS } sight_t;

static scene_t scene;
static goe_camera_t ahead, aside;
static goe_settings_t settings;
static goe_estimator_t estimator;
static goe_estimate_t estimate;
static check_random_t any;

void setUp(void) {
    any = check_random_start("cameras");
    scene_default(&scene);
    scene.speed_mps = 8.0;
    scene.top_nearest = true;
    scene.z0_m = Z0_M;
    scene.x0_m = X0_M;
    ahead = scene.camera;
    ahead.mount_yaw_deg = YAW_AHEAD_DEG;
    aside = scene.camera;
    aside.mount_yaw_deg = YAW_ASIDE_DEG;
    aside.fx_px *= 0.8f;
    aside.fy_px *= 0.8f;
    aside.k1 = -0.05f;
    aside.offset_m[0] = 0.6f;
    aside.offset_m[1] = -0.4f;
    aside.offset_m[2] = 0.2f;
    scene.camera = ahead;
    settings = scene_settings(&scene);
    settings.more_cameras[0] = aside;
}
void tearDown(void) {}

static void make(sight_t sight) {
    scene.boxes = sight == SEES_BOXES;
    if (sight == SEES_POINTS) {
        scene_make_cylinder(&scene);
    }
}

/* The scene places the obstacle from the camera that it has, level at the first image. */
static void look_through(const goe_camera_t *camera) {
    scene.camera = *camera;
    scene.z0_m = Z0_M - (double)camera->offset_m[0];
    scene.x0_m = X0_M - (double)camera->offset_m[1];
}

/* Degrees to the right of the nose at which the obstacle lies. */
static double bearing_deg(int k) {
    goe_image_t image;
    scene_truth_t truth;
    look_through(&ahead);
    scene_image(&scene, k, &image, &truth);
    return atan2(truth.x_m, truth.z_m) * 57.29577951308232;
}

/* The image of the camera that has the obstacle nearer to its axis. False if neither sees it. */
static bool see(int k, goe_image_t *image) {
    const double bearing = bearing_deg(k);
    const bool by_aside = fabs(bearing - (double)YAW_ASIDE_DEG) < fabs(bearing - (double)YAW_AHEAD_DEG);
    look_through(by_aside ? &aside : &ahead);
    scene_image(&scene, k, image, NULL);
    image->camera = by_aside ? 1 : 0;
    return fabs(bearing - (double)scene.camera.mount_yaw_deg) < VISIBLE_DEG;
}

static void start(void) { CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL)); }

typedef struct {
    int by[2];                /* images of each camera that were solved */
    int solved_after;         /* images after the change until the first that was solved */
    double before_m, after_m; /* sigma of the center at the end of each camera */
    int points;
} passage_t;

static double center_sd_m(void) {
    return hypot((double)estimate.sigma.center_north_m, (double)estimate.sigma.center_east_m);
}

/* Flies past. Every image with the obstacle visible must continue the track. */
static passage_t fly(double noise_px) {
    passage_t passage = {{0, 0}, 0, 0.0, 0.0, 0};
    start();
    for (int k = 0; k < IMAGES; k++) {
        goe_image_t image;
        if (!see(k, &image)) {
            continue;
        }
        if (noise_px > 0.0) {
            scene_add_noise(&image, &any, noise_px);
        }
        const goe_status_t status = goe_update(&estimator, &image, &estimate);
        passage.by[image.camera] += status == GOE_OK ? 1 : 0;
        passage.solved_after += image.camera == 1 && passage.by[1] == 0 ? 1 : 0;
        *(image.camera == 0 ? &passage.before_m : &passage.after_m) = center_sd_m();
    }
    passage.points = estimate.images_used;
    return passage;
}

/* The middle of the obstacle, off by so much, m. */
static double center_off_m(void) {
    goe_image_t image;
    scene_truth_t truth;
    look_through(&ahead);
    scene_image(&scene, 0, &image, &truth);
    return hypot((double)estimate.center_north_m - truth.center_north_m,
                 (double)estimate.center_east_m - truth.center_east_m);
}

/* [GOE_CAMERAS_MAX, goe_image_t.camera]
 * GIVEN what two cameras see one after the other WHEN it is exact THEN the track goes on from the first to the second, and the
 * obstacle is where it is. */
static void a_track_passes_from_one_camera_to_the_other(void) {
    for (int method = 0; method < 2; method++) {
        for (int sight = SEES_POINTS; sight <= SEES_CORNERS; sight++) {
            setUp();
            make((sight_t)sight);
            settings = method == 0 ? scene_settings(&scene) : scene_window_settings(&scene);
            settings.more_cameras[0] = aside;
            if (method == 0) {
                scene_clear_noise(&settings);
            }
            const passage_t passage = fly(0.0);
            TEST_ASSERT_TRUE(passage.by[0] > 5 && passage.by[1] > 5);
            TEST_ASSERT_TRUE(passage.solved_after <= 1);
            TEST_ASSERT_TRUE(estimate.valid & GOE_HAS_CENTER);
            if (method == 0 || sight == SEES_CORNERS) { /* (2) of a cylinder far aside is not exact */
                check_report("center off, m", center_off_m());
                TEST_ASSERT_TRUE(center_off_m() < EXACT_M);
            }
        }
    }
}

/* [GOE_CAMERAS_MAX]
 * GIVEN noise THEN the second camera improves the answer and reduces the sigma; the error stays within three of it. */
static void the_second_camera_adds_to_the_first(void) {
    for (int sight = 0; sight < SIGHTS; sight++) {
        setUp();
        make((sight_t)sight);
        const passage_t passage = fly(NOISE_PX);
        check_report("sigma of the center by the first, m", passage.before_m);
        check_report("... and by the second", passage.after_m);
        check_report("center off, m", center_off_m());
        TEST_ASSERT_TRUE(passage.after_m < passage.before_m);
        TEST_ASSERT_TRUE(passage.points >= passage.by[0] + passage.by[1]);
        TEST_ASSERT_FALSE(estimate.suspect);
        TEST_ASSERT_TRUE(center_off_m() < 3.0 * center_sd_m());
    }
}

/* [GOE_CAMERAS_MAX] GIVEN an image that names a camera which there is not THEN it is refused, and changes nothing but a counter. */
static void a_camera_that_is_not_there_is_refused(void) {
    goe_image_t image;
    goe_estimator_t before;
    memset(&settings.more_cameras[0], 0, sizeof settings.more_cameras[0]);
    start();
    scene_image(&scene, 0, &image, NULL);
    (void)goe_update(&estimator, &image, &estimate);
    scene_image(&scene, 1, &image, NULL);
    for (unsigned number = 1; number < 256; number++) {
        before = estimator;
        image.camera = (uint8_t)number;
        CHECK_STATUS(GOE_OUT_OF_RANGE, goe_update(&estimator, &image, &estimate));
        before.fault_counts[-GOE_OUT_OF_RANGE]++;
        before.estimate.age_s = estimator.estimate.age_s;
        TEST_ASSERT_EQUAL_MEMORY(&before, &estimator, sizeof estimator);
    }
    image.camera = 0;
    TEST_ASSERT_TRUE(goe_update(&estimator, &image, &estimate) >= GOE_OK);
}

/* [GOE_CAMERAS_MAX] GIVEN a second camera with a bad setting THEN it is named; GIVEN none THEN its settings are not read. */
static void a_bad_second_camera_is_named(void) {
    const char *bad = NULL;
    settings.more_cameras[0].mount_pitch_deg = 400.0f;
    CHECK_STATUS(GOE_BAD_SETTINGS, goe_init(&estimator, sizeof estimator, &settings, &bad));
    TEST_ASSERT_EQUAL_STRING("camera.mount_pitch_deg", bad);
    settings.more_cameras[0].fx_px = check_from_bits(0x7FC00000u);
    CHECK_STATUS(GOE_BAD_SETTINGS, goe_init(&estimator, sizeof estimator, &settings, &bad));
    TEST_ASSERT_EQUAL_STRING("camera.fx_px", bad);
    settings.more_cameras[0].fx_px = 0.0f;
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, &bad));
    goe_settings_default(&settings);
    TEST_ASSERT_EQUAL_FLOAT(0.0f, settings.more_cameras[0].fx_px);
    TEST_ASSERT_EQUAL_FLOAT(settings.camera.border_rel, settings.more_cameras[0].border_rel);
}

/* ------------------------------------------------------------------------------------------------ at the same time -- */

#define FOCAL_PX 914.0
#define SIZE_PX 1280.0
#define PERIOD_US 100000
#define MAST_M 3.0 /* half of its width */
#define MAST_HIGH_M 30.0
#define EYE_M 15.0 /* the camera above the ground */
#define FIRST_M 150.0
#define STEP_M 1.5 /* 15 m/s */
#define LOOKS 70
#define FIRST_ALONE 5  /* images without such a box: as the first, it would place the mast too far away */
#define LOW_PX 1200.0f /* so near to the lower border that it may cut the box */

typedef enum { ALONE, CUT_BEFORE, LOW_BEFORE, WHOLE_BEFORE, EMPTY_BETWEEN } other_t; /* what the other camera gives */

/* The box of a mast ahead, in the image of a level camera that is turned to the right by yaw; a border cuts it. */
static void detect_mast(double ahead_m, double yaw_rad, goe_box_t *box) {
    const double half_rad = asin(MAST_M / ahead_m);
    const double scale = FOCAL_PX / ((ahead_m - MAST_M) * cos(yaw_rad));
    box->left_px = (float)fmax(0.5 * SIZE_PX + FOCAL_PX * tan(-yaw_rad - half_rad), 0.0);
    box->right_px = (float)fmax(0.5 * SIZE_PX + FOCAL_PX * tan(-yaw_rad + half_rad), 2.0);
    box->top_px = (float)fmax(0.5 * SIZE_PX - scale * (MAST_HIGH_M - EYE_M), 0.0);
    box->bottom_px = (float)fmin(0.5 * SIZE_PX + scale * EYE_M, SIZE_PX - 1.0);
    box->sides = GOE_SIDES_ALL;
}

static int used_by_other; /* images of camera 1 that gave an estimate */

static void look_ahead(int64_t time_us, goe_image_t *image) {
    memset(image, 0, sizeof *image);
    image->pose.time_us = time_us;
    image->pose.position_ned_m[0] = (float)(STEP_M * (double)time_us / PERIOD_US);
    image->pose.position_ned_m[2] = (float)-EYE_M;
    image->pose.height_m = (float)EYE_M;
    image->pose.attitude[0] = 1.0f;
}

/* An approach to a mast that camera 0 sees whole, up to its image `last`. Returns how many of its images gave an estimate. */
static int approach_until(int last, other_t other, double yaw_deg, int64_t lead_us) {
    int used = 0;
    used_by_other = 0;
    goe_settings_default(&settings);
    settings.camera.fx_px = settings.camera.fy_px = (float)FOCAL_PX;
    settings.camera.cx_px = settings.camera.cy_px = (float)(0.5 * SIZE_PX);
    settings.camera.width_px = settings.camera.height_px = (float)SIZE_PX;
    settings.more_cameras[0] = settings.camera;
    settings.more_cameras[0].mount_yaw_deg = (float)yaw_deg;
    start();
    for (int k = 1; k <= LOOKS; k++) {
        goe_image_t image;
        const int64_t time_us = (int64_t)k * PERIOD_US;
        if (other != ALONE) {
            look_ahead(time_us - lead_us, &image);
            image.camera = 1;
            if (other != EMPTY_BETWEEN && (other != LOW_BEFORE || k > FIRST_ALONE)) {
                detect_mast(FIRST_M - (double)image.pose.position_ned_m[0], yaw_deg / 57.29577951308232, &image.box);
                image.box.bottom_px = other == LOW_BEFORE ? LOW_PX : image.box.bottom_px;
            }
            (void)goe_update(&estimator, &image, &estimate);
            used_by_other += estimate.fresh ? 1 : 0;
        }
        look_ahead(time_us, &image);
        if (k <= last) {
            detect_mast(FIRST_M - (double)image.pose.position_ned_m[0], 0.0, &image.box);
        }
        (void)goe_update(&estimator, &image, &estimate);
        used += estimate.fresh ? 1 : 0;
    }
    return used;
}

static int approach(other_t other, double yaw_deg, int64_t lead_us) {
    return approach_until(LOOKS, other, yaw_deg, lead_us);
}

/* [GOE_CAMERAS_MAX, goe_image_t.camera]
 * GIVEN a camera that sees the whole obstacle, and another one whose image comes shortly before and cuts it, or shows nothing, THEN all
 * boxes of the first are used, and its errors remain known: the sigma is that without the other camera, or a little better. */
static void a_camera_takes_nothing_from_another_one(void) {
    static const int64_t leads_us[] = {1, 1000, 20000, 60000, 90000};
    const int alone = approach(ALONE, 0.0, 0);
    const float alone_sd_m = estimate.sigma.z_m;
    TEST_ASSERT_TRUE(alone >= LOOKS - 2 && alone_sd_m > 0.0f);
    for (size_t i = 0; i < sizeof leads_us / sizeof leads_us[0]; i++) {
        TEST_ASSERT_TRUE(approach(EMPTY_BETWEEN, 33.0, leads_us[i]) == alone);
        CHECK_CLOSE(0.1 * (double)alone_sd_m, (double)alone_sd_m, (double)estimate.sigma.z_m);
        TEST_ASSERT_TRUE(approach(CUT_BEFORE, 33.0, leads_us[i]) >= alone - 1);
        TEST_ASSERT_TRUE(estimate.sigma.z_m > 0.5f * alone_sd_m && estimate.sigma.z_m < 1.05f * alone_sd_m);
        TEST_ASSERT_TRUE(approach(LOW_BEFORE, 0.0, leads_us[i]) == alone);
        TEST_ASSERT_TRUE(estimate.sigma.z_m > 0.5f * alone_sd_m && estimate.sigma.z_m < 1.05f * alone_sd_m);
    }
}

/* [GOE_CAMERAS_MAX, goe_pose_t.time_us] GIVEN two cameras that see the whole obstacle, at the same time or one after the other, THEN the
 * boxes of both are used. */
static void the_boxes_of_both_cameras_are_used(void) {
    static const int64_t leads_us[] = {1, 1000, 50000};
    (void)approach(ALONE, 0.0, 0);
    const float alone_sd_m = estimate.sigma.z_m;
    for (size_t i = 0; i < sizeof leads_us / sizeof leads_us[0]; i++) {
        const int used = approach(WHOLE_BEFORE, 0.0, leads_us[i]);
        TEST_ASSERT_TRUE(used >= LOOKS - 2 && used_by_other >= LOOKS - 2);
        TEST_ASSERT_TRUE(estimate.sigma.z_m > 0.65f * alone_sd_m && estimate.sigma.z_m < alone_sd_m);
    }
}

/* [goe_pose_t.time_us] GIVEN cameras that are triggered together THEN their images are taken in the order of the cameras, each once, and the
 * boxes of both are used. */
static void images_of_one_time_come_in_the_order_of_the_cameras(void) {
    static const uint8_t order[] = {0, 0, 1, 0, 1};
    static const bool taken[] = {true, false, true, false, false};
    (void)approach(ALONE, 0.0, 0);
    for (int k = LOOKS + 1; k < LOOKS + 5; k++) {
        for (size_t i = 0; i < sizeof order; i++) {
            goe_image_t image;
            look_ahead((int64_t)k * PERIOD_US, &image);
            image.camera = order[i];
            detect_mast(FIRST_M - (double)image.pose.position_ned_m[0], 0.0, &image.box);
            const goe_status_t status = goe_update(&estimator, &image, &estimate);
            TEST_ASSERT_TRUE(taken[i] ? estimate.fresh && status >= GOE_OK : status == GOE_BAD_TIME);
        }
    }
    goe_image_t first;
    look_ahead(0, &first);
    first.pose.time_us = GOE_TIME_UNKNOWN;
    first.camera = 1;
    start();
    CHECK_STATUS(GOE_BAD_TIME, goe_update(&estimator, &first, &estimate));
}

/* [GOE_CAMERAS_MAX] GIVEN a camera that cuts the obstacle WHEN the camera that saw all of it sees nothing any more THEN its boxes are used
 * at once. */
static void a_cut_box_is_better_than_none(void) {
    const int last = 40;
    (void)approach_until(last, CUT_BEFORE, 33.0, 1000);
    check_report("boxes of the camera that cuts", used_by_other);
    TEST_ASSERT_TRUE(used_by_other >= LOOKS - last - 2);
}

/* One more image of a camera, `step` periods after the approach. The border cuts its box at these sides. */
static unsigned open_after(int step, uint8_t camera, unsigned sides) {
    goe_image_t image;
    look_ahead((int64_t)(LOOKS + step) * PERIOD_US, &image);
    image.camera = camera;
    detect_mast(FIRST_M - (double)image.pose.position_ned_m[0], 0.0, &image.box);
    image.box.left_px = (sides & GOE_SIDE_LEFT) != 0u ? 0.0f : image.box.left_px;
    image.box.right_px = (sides & GOE_SIDE_RIGHT) != 0u ? (float)SIZE_PX - 1.0f : image.box.right_px;
    image.box.top_px = (sides & GOE_SIDE_TOP) != 0u ? 0.0f : image.box.top_px;
    image.box.bottom_px = (sides & GOE_SIDE_BOTTOM) != 0u ? (float)SIZE_PX - 1.0f : image.box.bottom_px;
    (void)goe_update(&estimator, &image, &estimate);
    return estimator.filter.answer.cut;
}

/* [GOE_CAMERAS_MAX, GOE_DECISION_UNKNOWN]
 * GIVEN cameras that cut the obstacle THEN each end counts that one of them cuts, unless another one shows all of the obstacle; what a
 * camera showed half a second ago no longer counts. */
static void an_end_is_open_that_a_camera_cuts(void) {
    (void)approach(WHOLE_BEFORE, 0.0, 1000);
    TEST_ASSERT_EQUAL_HEX(0u, open_after(1, 0, 0u));
    TEST_ASSERT_EQUAL_HEX(0u, open_after(1, 1, GOE_SIDE_LEFT)); /* camera 0 shows all of it */
    TEST_ASSERT_EQUAL_HEX(GOE_SIDE_RIGHT | GOE_SIDE_LEFT, open_after(2, 0, GOE_SIDE_RIGHT));
    TEST_ASSERT_EQUAL_HEX(GOE_SIDE_RIGHT | GOE_SIDE_LEFT, open_after(2, 1, GOE_SIDE_LEFT));
    TEST_ASSERT_EQUAL_HEX(GOE_SIDE_LEFT, open_after(8, 1, GOE_SIDE_LEFT));
    TEST_ASSERT_EQUAL_HEX(0u, open_after(9, 0, 0u));
    TEST_ASSERT_EQUAL_HEX(GOE_SIDE_RIGHT | GOE_SIDE_LEFT, open_after(10, 0, GOE_SIDES_ALL)); /* gives no rows */
    TEST_ASSERT_FALSE(estimate.fresh);
}

/* [GOE_CAMERAS_MAX] GIVEN two cameras far apart on the aircraft WHEN they take turns THEN the way from one to the other is no jump of
 * the autopilot's position. */
static void the_way_between_two_cameras_is_no_jump(void) {
    (void)approach(EMPTY_BETWEEN, 0.0, 1000);
    estimator.settings.more_cameras[0].offset_m[1] = 30.0f;
    for (int k = LOOKS + 1; k < LOOKS + 20; k++) {
        for (int i = 0; i < 2; i++) {
            goe_image_t image;
            look_ahead((int64_t)k * PERIOD_US, &image);
            image.camera = (uint8_t)i;
            goe_guard_seal(&estimator);
            (void)goe_update(&estimator, &image, &estimate);
            TEST_ASSERT_EQUAL_UINT32(0u, estimator.fault_counts[0]); /* no jumps */
            CHECK_SAME(0.0f, estimator.motion.origin_ne_m[1]);
        }
    }
}

/* ---------------------------------------------------------------------------------------------------- honest sigmas -- */

#define FLIGHTS 150
#define SLOW_REL 0.07 /* as by default: the slow error of a side, over the size of the box, and its time constant */
#define SLOW_S 1.2
#define STEPS 60

/* The box with errors of one camera's detector, which fade over a second. */
static void err(goe_box_t *box, check_random_t *random, double slow[4], double since_s) {
    const double kept = exp(-since_s / SLOW_S);
    const double size_px[2] = {(double)(box->right_px - box->left_px), (double)(box->bottom_px - box->top_px)};
    float *const side_px[4] = {&box->left_px, &box->top_px, &box->right_px, &box->bottom_px};
    for (int i = 0; i < 4; i++) {
        slow[i] = kept * slow[i] + sqrt(1.0 - kept * kept) * check_random_normal(random);
        *side_px[i] += (float)(SLOW_REL * slow[i] * size_px[i & 1] + check_random_normal(random));
    }
}

/* Mean square of the error of Z over its sigma, at the last image of flights toward a mast; cameras take turns at 5 Hz each. */
static double error2(int cameras) {
    check_random_t random = check_random_start(cameras == 1 ? "one camera" : "two cameras");
    double sum = 0.0;
    for (int flight = 0; flight < FLIGHTS; flight++) {
        double slow[2][4];
        const double level_rad = 0.5 / 57.29577951308232 * check_random_normal(&random);
        const float height_m = (float)(EYE_M + 2.0 * check_random_normal(&random));
        start();
        for (int k = 0; k < STEPS; k++) {
            goe_image_t image;
            const int camera = k % cameras;
            look_ahead((int64_t)k * PERIOD_US * 2 / cameras, &image);
            image.camera = (uint8_t)camera;
            image.pose.height_m = height_m;
            const double since_s = k < cameras ? 1.0e3 : 0.2;
            for (int i = 0; k < cameras && i < 4; i++) {
                slow[camera][i] = 0.0;
            }
            detect_mast(FIRST_M + 60.0 - (double)image.pose.position_ned_m[0], 0.0, &image.box);
            err(&image.box, &random, slow[camera], since_s);
            image.box.top_px += (float)(FOCAL_PX * level_rad);
            image.box.bottom_px += (float)(FOCAL_PX * level_rad);
            (void)goe_update(&estimator, &image, &estimate);
        }
        const double z_m = FIRST_M + 60.0 - STEP_M * (STEPS - 1) * 2.0 / cameras;
        const double error = ((double)estimate.z_m - z_m) / (double)estimate.sigma.z_m;
        sum += error * error;
    }
    return sum / FLIGHTS;
}

/* [GOE_CAMERAS_MAX] GIVEN two cameras that take turns WHEN the slow errors of their boxes are as configured THEN the sigma of Z is as true
 * as with one camera: the errors of each camera remain known while the other one looks. */
static void the_sigmas_of_two_cameras_are_true(void) {
    (void)approach(WHOLE_BEFORE, 0.0, 0);
    const double one = error2(1);
    const double two = error2(2);
    check_report("mean square of Z's error in sigmas, one camera", one);
    check_report("... two in turn", two);
    TEST_ASSERT_TRUE(one > 0.5 && one < 1.4 && two > 0.5 && two < 1.4);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(a_track_passes_from_one_camera_to_the_other);
    RUN_TEST(the_second_camera_adds_to_the_first);
    RUN_TEST(a_camera_that_is_not_there_is_refused);
    RUN_TEST(a_bad_second_camera_is_named);
    RUN_TEST(a_camera_takes_nothing_from_another_one);
    RUN_TEST(the_boxes_of_both_cameras_are_used);
    RUN_TEST(images_of_one_time_come_in_the_order_of_the_cameras);
    RUN_TEST(a_cut_box_is_better_than_none);
    RUN_TEST(an_end_is_open_that_a_camera_cuts);
    RUN_TEST(the_way_between_two_cameras_is_no_jump);
    RUN_TEST(the_sigmas_of_two_cameras_are_true);
    return UNITY_END();
}
