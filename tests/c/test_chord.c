/* Boxes by their silhouette alone, and shapes that are no box or no disc. SPDX-License-Identifier: MIT */
/* tests: lib/refined/goe_chord.c */
#include "refined/goe_chord.h"

#include <math.h>
#include <string.h>

#include "check.h"
#include "refined/goe_report.h"
#include "scene.h"
#include "sighting.h"

#define CASES 1000
#define HOUSES 300
#define IMAGES 188 /* half a meter each, to some meters before the obstacle */
#define RAD_PER_DEG 0.017453292519943295
#define BOX_BITS 0x3Fu

static check_random_t any;
static sighting_t sighting;
static double truth[GOE_STATES];
static size_t kind[3];
static size_t expected_rows;

static scene_t scene;
static goe_settings_t settings;
static goe_estimator_t estimator;
static goe_estimate_t estimate;
static goe_image_t image;
static unsigned phases; /* bit i: phase i was there */
static bool suspected;
static unsigned reasons; /* bit i: reason i was reported */

/* A box on the left whose front and right face are visible until the front turns away; the aircraft passes it closely. */
void setUp(void) {
    scene_default(&scene);
    scene.width_m = 5.0;
    scene.length_m = 9.0;
    scene.height_m = 6.0;
    scene.alpha_deg = 40.0;
    scene.x0_m = -16.0;
    scene.speed_mps = 10.0;
    scene.image_rate_hz = 20.0;
    scene.wobble_deg = 1.0;
    scene.top_nearest = true;
    settings = scene_settings(&scene);
    phases = 0;
    suspected = false;
    reasons = 0;
}
void tearDown(void) {}

static void start(void) {
    settings.camera = scene.camera;
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
}

static void update(void) {
    (void)goe_update(&estimator, &image, &estimate);
    phases |= 1u << estimator.filter.phase;
    suspected = suspected || estimate.suspect;
    reasons |= 1u << estimate.reason;
}

static bool was_reported(goe_reason_t reason) { return (reasons >> reason & 1u) != 0u; }

static void leave_base_out(void) {
    image.base_left.visible = false;
    image.base_near.visible = false;
    image.base_right.visible = false;
}

static void see_silhouette(int k, double sigma_px) {
    scene_image(&scene, k, &image, NULL);
    leave_base_out();
    scene_add_noise(&image, &any, sigma_px);
    update();
}

static bool was_in(goe_phase_t phase) { return (phases >> phase & 1u) != 0u; }

/* --------------------------------------------------------------------------------------------------------------- rows -- */

static double end_z(const double state[GOE_STATES], double side) {
    return 1.0 - (double)sighting.sight.camera_m.z * state[GOE_INVERSE_RANGE] + side * state[GOE_SIDE_X];
}

/* Left, right: the end's x at the measured height, which is taken as known; top: the y of the nearer end, or of the farther
 * one if the highest. */
static double see(const double state[GOE_STATES], size_t feature) {
    const double px = state[GOE_BEARING] - (double)sighting.sight.camera_m.x * state[GOE_INVERSE_RANGE];
    const double pz = 1.0 - (double)sighting.sight.camera_m.z * state[GOE_INVERSE_RANGE];
    const double y = (double)sighting.sight.height_m * state[GOE_INVERSE_RANGE] - state[GOE_TOP];
    const bool highest = sighting.settings.filter.top_is_highest && y > 0.0;
    const bool right_is_near = px * state[GOE_FRONT_X] + pz * state[GOE_SIDE_X] < 0.0;
    const double side = (feature == GOE_POINT_TOP ? right_is_near != highest : feature == GOE_POINT_RIGHT) ? 0.5 : -0.5;
    const double held = sighting_height(&sighting, state, feature) * end_z(truth, side);
    const double point[3] = {px + side * state[GOE_FRONT_X], feature == GOE_POINT_TOP ? y : held, end_z(state, side)};
    double seen[2];
    sighting_project(&sighting, state, point, seen);
    return seen[feature == GOE_POINT_TOP ? 1 : 0];
}

static double predict(const sighting_t *of, const double state[GOE_STATES], size_t row) {
    (void)of;
    return see(state, kind[row]);
}

static void any_chord(void) {
    const double z0_m = sighting_place(&sighting, &any);
    sighting.state[GOE_SIDE_X] = (float)(check_random_between(&any, -12.0, 12.0) / z0_m);
    sighting.state[GOE_FRONT_X] = (float)(check_random_between(&any, 1.0, 25.0) / z0_m);
    sighting_finish(&sighting, &any, z0_m, truth);
    expected_rows = 0;
}

/* The features in the order of the rows. */
static void measure(size_t feature) {
    goe_point_t *point = &sighting.sight.point[feature];
    point->usable = true;
    point->x = 0.0f;
    point->y = (float)check_random_between(&any, -0.2, 0.2);
    for (int i = 0; i < SETTLED; i++) { /* the height that is freed of the bias hangs on x a little */
        *(feature == GOE_POINT_TOP ? &point->y : &point->x) = (float)see(truth, feature);
    }
    kind[expected_rows++] = feature;
}

/* [filter.top_is_highest, (R8)]
 * GIVEN chords of any place, slope and length THEN the residuals are 0 at the truth and the derivatives those of its ends; base
 * corners give no rows. */
static void rows_are_those_of_the_ends(void) {
    any = check_random_start("chords");
    for (int n = 0; n < CASES; n++) {
        any_chord();
        for (size_t feature = GOE_POINT_LEFT; feature <= GOE_POINT_TOP; feature++) {
            if (n % 4 == 0 || n % 4 == (int)feature + 1) {
                measure(feature);
            }
        }
        sighting.sight.point[GOE_POINT_BASE_NEAR].usable = true;
        goe_rows_clear(&sighting.rows, &sighting.matrix);
        goe_chord_rows(&sighting.sight, &sighting.rows);
        TEST_ASSERT_EQUAL_size_t(expected_rows, sighting.rows.count);
        for (size_t row = 0; row < expected_rows; row++) {
            TEST_ASSERT_EQUAL_size_t(kind[row], sighting.rows.feature[row]);
        }
        sighting_check_rows(&sighting, predict);
    }
}

/* -------------------------------------------------------------------------------------------------------------- boxes -- */

static double half_diagonal(void) { return 0.5 * hypot(scene.width_m, scene.length_m); }

/* The estimate's center from the box's, in sigmas of each axis; the camera starts at north 0, east 0, heading north. */
static double center_off(void) {
    const double s = sin(scene.alpha_deg * RAD_PER_DEG);
    const double c = cos(scene.alpha_deg * RAD_PER_DEG);
    const double north = scene.z0_m + 0.5 * scene.length_m * c - (double)estimate.center_north_m;
    const double east = scene.x0_m + 0.5 * scene.length_m * s - (double)estimate.center_east_m;
    return fmax(fabs(north) / (double)estimate.sigma.center_north_m, fabs(east) / (double)estimate.sigma.center_east_m);
}

/* GIVEN a box without base corners WHEN two of its faces are visible THEN it is reported as a disc about its middle. */
static void check_chord(void) {
    TEST_ASSERT_EQUAL_INT(GOE_MODEL_DISC, estimate.model);
    TEST_ASSERT_EQUAL_HEX32(0u, estimate.valid & (GOE_HAS_LENGTH | GOE_HAS_ORIENTATION));
    TEST_ASSERT_TRUE(estimate.width_m < 2.0f * (float)half_diagonal());
    TEST_ASSERT_TRUE((double)estimate.sigma.center_north_m >= 0.25 * (double)estimate.width_m);
    TEST_ASSERT_TRUE(center_off() < 1.0);
}

static void check_box(double share) {
    TEST_ASSERT_EQUAL_INT(GOE_MODEL_BOX, estimate.model);
    TEST_ASSERT_EQUAL_HEX32(BOX_BITS, estimate.valid);
    CHECK_CLOSE(90.0 * share, scene.alpha_deg, estimate.orientation_deg);
    CHECK_CLOSE(scene.width_m * share, scene.width_m, estimate.width_m);
    CHECK_CLOSE(scene.length_m * share, scene.length_m, estimate.length_m);
    CHECK_CLOSE(scene.z0_m * share, scene.z0_m, estimate.z0_m);
    CHECK_CLOSE(scene.z0_m * share, scene.x0_m, estimate.x0_m);
    CHECK_CLOSE(scene.height_m * share, scene.height_m, estimate.height_m);
    TEST_ASSERT_TRUE(center_off() < 2.0);
}

/* [A30, GOE_MODEL_BOX, (R21)] ... and WHEN its front turns away THEN as the box that it is. */
static void a_box_comes_out_of_its_silhouette(void) {
    static const double alpha_deg[] = {40.0, 42.0, 44.0};
    for (int i = 0; i < 3; i++) {
        setUp();
        scene.alpha_deg = alpha_deg[i];
        scene_clear_noise(&settings);
        start();
        for (int k = 0; k < IMAGES; k++) {
            see_silhouette(k, 0.0);
            TEST_ASSERT_FALSE(estimate.suspect);
            if (estimator.filter.phase == GOE_PHASE_CHORD && estimator.filter.phase_images > 20 && estimate.fresh &&
                !goe_chord_is_leaving(&estimator.filter)) {
                check_chord();
            }
        }
        TEST_ASSERT_TRUE(was_in(GOE_PHASE_CHORD));
        check_box(2.0e-3);
    }
}

/* GIVEN errors as configured THEN the reported box is right within its sigmas. */
static void noise_does_not_hide_the_box(void) {
    any = check_random_start("silhouettes");
    settings.navigation.attitude_bias_sd_deg = 1.0e-3f;
    settings.navigation.attitude_white_sd_deg = 1.0e-3f;
    start();
    for (int k = 0; k < IMAGES; k++) {
        see_silhouette(k, 0.5);
    }
    TEST_ASSERT_EQUAL_INT(GOE_MODEL_BOX, estimate.model);
    CHECK_CLOSE(3.0 * (double)estimate.sigma.z0_m, scene.z0_m, estimate.z0_m);
    if (estimate.valid & GOE_HAS_ORIENTATION) {
        CHECK_CLOSE(3.0 * (double)estimate.sigma.orientation_deg, scene.alpha_deg, estimate.orientation_deg);
    }
    if (estimate.valid & GOE_HAS_WIDTH) {
        CHECK_CLOSE(3.0 * (double)estimate.sigma.width_m, scene.width_m, estimate.width_m);
    }
}

/* A house of 6 to 20 m by 6 to 20 m, 3 to 15 m high, whose outline lies 3 to 40 m to the side of a straight, level flight. */
static int any_house(void) {
    scene_default(&scene);
    scene.width_m = check_random_between(&any, 6.0, 20.0);
    scene.length_m = check_random_between(&any, 6.0, 20.0);
    scene.height_m = check_random_between(&any, 3.0, 15.0);
    scene.alpha_deg = check_random_between(&any, -80.0, 80.0);
    scene.altitude_m = check_random_between(&any, 15.0, 60.0);
    scene.speed_mps = check_random_between(&any, 12.0, 30.0);
    scene.top_nearest = true;
    scene.wobble_deg = 0.0;
    const double reach_s = check_random_between(&any, 10.0, 20.0);
    const double aside = half_diagonal() + check_random_between(&any, 3.0, 40.0);
    scene.z0_m = scene.speed_mps * reach_s;
    scene.x0_m = check_random_bits(&any) % 2u != 0u ? aside : -aside;
    settings = scene_settings(&scene);
    return (int)(scene.image_rate_hz * (reach_s - 1.0 - half_diagonal() / scene.speed_mps));
}

/* Worst error of the center, or of the height, in sigmas, of all answers of a flight that are not suspect. */
static double worst_confident(int images) {
    double worst = 0.0;
    start();
    for (int k = 0; k < images; k++) {
        see_silhouette(k, 0.5);
        if (!estimate.fresh || estimate.suspect) {
            continue;
        }
        if (estimate.valid & GOE_HAS_CENTER) {
            check_worst(&worst, center_off());
        }
        if (estimate.valid & GOE_HAS_HEIGHT) {
            check_worst(&worst, ((double)estimate.height_m - scene.height_m) / (double)estimate.sigma.height_m);
        }
    }
    return worst;
}

/* [A30, (R40)]
 * GIVEN the outlines of typical houses in straight flights THEN hardly one is reported wrong by six sigma, though corners change that
 * nothing but the sigma can hold. */
static void outlines_of_houses_are_not_confidently_wrong(void) {
    int wrong = 0;
    any = check_random_start("houses");
    for (int n = 0; n < HOUSES; n++) {
        const int images = any_house();
        wrong += worst_confident(images) > 6.0 ? 1 : 0;
    }
    check_report("houses reported wrong by six sigma, of 300", wrong);
    TEST_ASSERT_TRUE(wrong <= 3); /* one of a hundred; 0.3 % of thousands of flights */
}

/* GIVEN a flight WHEN it is mirrored THEN the same models come at the same images, and the box is the mirrored one. */
static void left_and_right_are_equal(void) {
    unsigned char phase[IMAGES];
    scene.z0_m -= 2.0; /* with no image so near to where a disc becomes a chord that rounding decides */
    scene.camera.cx_px = 0.0f;
    scene_clear_noise(&settings);
    start();
    for (int k = 0; k < IMAGES; k++) {
        see_silhouette(k, 0.0);
        phase[k] = estimator.filter.phase;
    }
    const goe_estimate_t plain = estimate;
    scene = scene_mirrored(&scene);
    start();
    for (int k = 0; k < IMAGES; k++) {
        see_silhouette(k, 0.0);
        TEST_ASSERT_EQUAL_UINT8(phase[k], estimator.filter.phase);
    }
    TEST_ASSERT_EQUAL_INT(GOE_MODEL_BOX, plain.model);
    TEST_ASSERT_EQUAL_HEX32(plain.valid, estimate.valid);
    CHECK_CLOSE(2.0e-3, -plain.x0_m, estimate.x0_m);
    CHECK_CLOSE(2.0e-3, plain.z0_m, estimate.z0_m);
    CHECK_CLOSE(2.0e-2, -plain.orientation_deg, estimate.orientation_deg);
    CHECK_CLOSE(2.0e-3, plain.width_m, estimate.width_m);
    CHECK_CLOSE(2.0e-3, plain.length_m, estimate.length_m);
    CHECK_CLOSE(1.0e-2 * (double)plain.sigma.width_m, plain.sigma.width_m, estimate.sigma.width_m);
}

/* GIVEN a box that starts by its silhouette WHEN its base comes into view THEN it becomes a box by its corners. */
static void base_corners_end_the_chord(void) {
    scene_clear_noise(&settings);
    start();
    for (int k = 0; k < 60; k++) {
        see_silhouette(k, 0.0);
    }
    TEST_ASSERT_EQUAL_INT(GOE_PHASE_CHORD, estimator.filter.phase);
    for (int k = 60; k < 100; k++) {
        scene_image(&scene, k, &image, NULL);
        update();
    }
    TEST_ASSERT_NOT_EQUAL(GOE_PHASE_BOX_OUTLINE, estimator.filter.phase);
    check_box(1.0e-3);
}

/* -------------------------------------------------------------------------------------- an end that leaves, made by hand -- */

static goe_filter_t filter;

/* A chord whose right end has left it, the camera 20 m before its middle: the ray to that end meets the circle over the chord at
 * a corner, and front and side are what leads there from the ends. Units of Z0. */
static void leave_chord(float side_x, float front_x, float right_x) {
    any = check_random_start("leaving");
    sighting_start(&sighting, &any);
    goe_filter_clear(&filter);
    for (size_t i = 0; i < GOE_STATES; i++) {
        *goe_srif_at(&filter.root, i, i) = 100.0f;
    }
    filter.phase = GOE_PHASE_CHORD;
    filter.phase_images = UINT8_MAX;
    filter.leaving.outward = 3.0f;
    filter.leaving.turning = 3.0f;
    filter.state[GOE_INVERSE_RANGE] = 0.01f;
    filter.state[GOE_SIDE_X] = side_x;
    filter.state[GOE_FRONT_X] = front_x;
    sighting.sight.state = filter.state;
    sighting.sight.camera_m = (goe_xz_t){0.0f, 0.0f};
    sighting.sight.point[GOE_POINT_LEFT] = (goe_point_t){-right_x, 0.0f, true};
    sighting.sight.point[GOE_POINT_RIGHT] = (goe_point_t){right_x, 0.0f, true};
    sighting_look(&sighting);
}

static bool changes(void) {
    const goe_filter_t before = filter;
    const bool changed = goe_chord_change(&filter, &sighting.sight);
    TEST_ASSERT_TRUE(changed || memcmp(&before, &filter, sizeof filter) == 0);
    return changed;
}

/* GIVEN a corner of which the two faces are those of a box THEN the chord becomes that box. */
static void a_corner_makes_a_box(void) {
    leave_chord(0.02f, 0.1f, 0.04f);
    TEST_ASSERT_TRUE(changes());
    TEST_ASSERT_EQUAL_INT(GOE_PHASE_BOX_OUTLINE, filter.phase);
}

/* GIVEN an end that left now to the one side and now to the other, as of noise THEN none is said to turn away. */
static void ends_that_leave_in_turn_make_no_box(void) {
    leave_chord(0.02f, 0.1f, 0.04f);
    filter.leaving.turning = 0.1f;
    TEST_ASSERT_FALSE(changes());
}

/* GIVEN a camera that is within the circle over the chord THEN no ray of it meets that circle from outside. */
static void within_the_circle_there_is_no_corner(void) {
    leave_chord(0.0f, 0.1f, 0.04f);
    filter.state[GOE_FRONT_X] = 2.2f;
    TEST_ASSERT_FALSE(changes());
}

/* GIVEN a front whose middle would lie at less than a third of the range that the filter started with THEN it is no box that the
 * states could hold; nor is one whose front leads to the left, or whose side leads towards the camera. */
static void faces_of_no_box_are_left_a_chord(void) {
    leave_chord(0.0f, 3.4f, 0.04f);
    sighting.sight.camera_m.z = -90.0f; /* it has flown away from the obstacle since: the circle lies before it */
    TEST_ASSERT_FALSE(changes());
    leave_chord(-0.9f, 0.117f, 0.4f);
    TEST_ASSERT_FALSE(changes());
    leave_chord(-0.609f, 0.57f, 0.458f);
    TEST_ASSERT_FALSE(changes());
}

/* ---------------------------------------------------------------------------------------------------------- cylinders -- */

/* [GOE_REASON_SHAPE, (R7)] GIVEN cylinders, noise-free and noisy THEN they stay discs and are not suspect, also if a disc was configured.
 * */
static void a_cylinder_stays_a_disc(void) {
    any = check_random_start("cylinders");
    for (int i = 0; i < 12; i++) {
        setUp();
        scene_make_cylinder(&scene);
        scene.width_m = 2.0 + 2.0 * i;
        scene.x0_m = i % 2 ? -25.0 : 30.0;
        scene.path = (scene_path_t)(i % 3);
        settings.model = i < 6 ? GOE_MODEL_AUTO : GOE_MODEL_DISC;
        start();
        for (int k = 0; k < 150; k++) {
            see_silhouette(k, i % 4 < 2 ? 0.0 : 0.5);
            TEST_ASSERT_FALSE(estimate.suspect);
        }
        TEST_ASSERT_FALSE(was_in(GOE_PHASE_CHORD) || was_in(GOE_PHASE_BOX));
        TEST_ASSERT_EQUAL_INT(GOE_MODEL_DISC, estimate.model);
        CHECK_CLOSE(3.0 * (double)estimate.sigma.width_m, scene.width_m, estimate.width_m);
        CHECK_CLOSE(3.0 * (double)estimate.sigma.z0_m, scene.z0_m, estimate.z0_m);
    }
}

/* [goe_report.c, (R7)] GIVEN a long box WHEN a disc is configured THEN it is reported, and reported as suspect. */
static void a_disc_by_force_is_suspect(void) {
    any = check_random_start("force");
    scene.length_m = 18.0;
    settings.model = GOE_MODEL_DISC;
    settings.navigation.position_walk_sd_m = 0.0f; /* as it is flown */
    start();
    for (int k = 0; k < 120; k++) {
        see_silhouette(k, 0.3);
    }
    TEST_ASSERT_EQUAL_INT(GOE_MODEL_DISC, estimate.model);
    TEST_ASSERT_TRUE(estimate.suspect);
    TEST_ASSERT_EQUAL_INT(GOE_REASON_SHAPE, estimate.reason);
}

/* ------------------------------------------------------------------------------------------------------ base corners -- */

/* A cylinder from a detector without a sense of shape: the lower corners of its bounding box, and the point between. */
static void fake_base(int k) {
    scene_truth_t seen;
    scene_image(&scene, k, &image, &seen);
    const double radius = 0.5 * scene.width_m;
    const double range = hypot(seen.x_m, seen.z_m);
    const double nearest = seen.z_m * (1.0 - radius / range);
    const float v =
        (float)((double)scene.camera.cy_px + (double)scene.camera.fy_px * seen.height_above_ground_m / nearest);
    image.base_left = image.left;
    image.base_right = image.right;
    image.base_near = image.left;
    image.base_near.u_px = (float)((double)scene.camera.cx_px + (double)scene.camera.fx_px * seen.x_m / seen.z_m);
    image.base_left.v_px = v;
    image.base_right.v_px = v;
    image.base_near.v_px = v;
}

/* GIVEN a cylinder with base corners that it does not have THEN the answer is suspect sooner or later. */
static void false_base_corners_are_found_out(void) {
    any = check_random_start("false corners");
    scene_make_cylinder(&scene);
    scene.width_m = 12.0;
    scene.wobble_deg = 0.0;
    start();
    for (int k = 0; k < 170; k++) {
        fake_base(k);
        scene_add_noise(&image, &any, 0.3);
        update();
    }
    TEST_ASSERT_TRUE(was_in(GOE_PHASE_BOX));
    TEST_ASSERT_TRUE(suspected);
    TEST_ASSERT_TRUE(was_reported(GOE_REASON_BASE));
    TEST_ASSERT_EQUAL_INT(GOE_REASON_BASE, estimate.reason); /* and stays so */
    TEST_ASSERT_FALSE(goe_filter_is_box(&estimator.filter));
}

/* GIVEN base corners that proved to be wrong WHEN the window answers, which has no doubt THEN its answer reports them, and a
 * graver reason stays. */
static void refused_corners_are_reported_with_every_answer(void) {
    goe_filter_clear(&filter);
    for (int refused = 0; refused < 2; refused++) {
        filter.health.base_refused = refused != 0;
        memset(&estimate, 0, sizeof estimate);
        goe_report_doubt(&filter, &estimate);
        TEST_ASSERT_EQUAL_INT(refused ? GOE_REASON_BASE : GOE_REASON_NONE, estimate.reason);
        TEST_ASSERT_EQUAL(refused != 0, estimate.suspect);
        estimate.reason = GOE_REASON_CONVENTION;
        goe_report_doubt(&filter, &estimate);
        TEST_ASSERT_EQUAL_INT(GOE_REASON_CONVENTION, estimate.reason);
    }
}

/* [goe_estimate_t.suspect, filter.nis_ratio_max]
 * GIVEN noise larger than configured by a factor of 2 THEN a true box is suspect, but keeps its base corners in the end. */
static void noise_does_not_make_corners_false(void) {
    any = check_random_start("large noise");
    start();
    for (int k = 0; k < 170; k++) {
        scene_image(&scene, k, &image, NULL);
        scene_add_noise(&image, &any, 1.0);
        update();
    }
    TEST_ASSERT_TRUE(suspected);
    TEST_ASSERT_TRUE(was_reported(GOE_REASON_NOISE));
    TEST_ASSERT_FALSE(was_reported(GOE_REASON_BASE));
    TEST_ASSERT_FALSE(estimator.filter.health.base_refused);
    TEST_ASSERT_EQUAL_INT(GOE_MODEL_BOX, estimate.model);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(rows_are_those_of_the_ends);
    RUN_TEST(a_box_comes_out_of_its_silhouette);
    RUN_TEST(noise_does_not_hide_the_box);
    RUN_TEST(outlines_of_houses_are_not_confidently_wrong);
    RUN_TEST(left_and_right_are_equal);
    RUN_TEST(base_corners_end_the_chord);
    RUN_TEST(a_corner_makes_a_box);
    RUN_TEST(ends_that_leave_in_turn_make_no_box);
    RUN_TEST(within_the_circle_there_is_no_corner);
    RUN_TEST(faces_of_no_box_are_left_a_chord);
    RUN_TEST(a_cylinder_stays_a_disc);
    RUN_TEST(a_disc_by_force_is_suspect);
    RUN_TEST(false_base_corners_are_found_out);
    RUN_TEST(refused_corners_are_reported_with_every_answer);
    RUN_TEST(noise_does_not_make_corners_false);
    return UNITY_END();
}
