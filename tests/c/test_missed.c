/* Images without a detection, and new starts of the filter: no warning is lost by them. SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "check.h"
#include "goe_covariance.h"
#include "refined/goe_filter.h"
#include "rim.h"
#include "scene.h"

#define FLIGHTS 60
#define IMAGES 70
#define MARGIN_M 15.0
#define CLEARANCE_M 10.0
#define LOST_MAX                                                                                                       \
    0.02 /* of a probability, in an image without a detection: what an eighth of a second adds to the sigmas */
#define HZ 8.0

typedef enum { BY_POINTS, BY_CORNERS, BY_BOXES, BY_BOXES_AND_CORNERS, BY_OUTLINE, KINDS } kind_t;

static check_random_t any;
static scene_t scene;
static goe_settings_t settings;
static goe_estimator_t estimator;
static goe_image_t image;
static goe_estimate_t estimate;
static goe_hazard_t hazard;

void setUp(void) {
    scene_default(&scene);
    any = check_random_start("missed");
}
void tearDown(void) {}

static void hide_all(void) {
    scene_hide_points(&image);
    image.box.sides = 0;
}

/* Image k of the scene as a detector of that kind gives it, with noise. */
static void look(kind_t kind, int k) {
    goe_box_t box;
    scene.boxes = true;
    scene_image(&scene, k, &image, NULL);
    box = image.box;
    scene.boxes = false;
    scene_image(&scene, k, &image, NULL);
    scene_add_noise(&image, &any, 0.5);
    if (kind == BY_BOXES || kind == BY_BOXES_AND_CORNERS) {
        image.box = box;
        image.left.visible = image.right.visible = image.top.visible = false;
    }
    if (kind != BY_CORNERS && kind != BY_BOXES_AND_CORNERS) {
        image.base_left.visible = image.base_near.visible = image.base_right.visible = false;
    }
    if (kind == BY_OUTLINE) {
        image.top.visible = false;
    }
}

static goe_intent_t intent_of(double since_s) {
    const goe_intent_t intent = {
        {(float)scene.speed_mps, 0.0f, 0.0f}, (float)MARGIN_M, (float)CLEARANCE_M, (float)since_s, 0.0f};
    return intent;
}

static goe_status_t ask(double since_s) {
    const goe_intent_t intent = intent_of(since_s);
    return goe_hazard(&estimator, &intent, &hazard);
}

static void start(void) {
    settings = scene_settings(&scene);
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
}

/* The ground is known to be as level as it is. */
static void start_on_level_ground(void) {
    settings = scene_settings(&scene);
    scene_level_ground(&settings);
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
}

/* Any obstacle near the course, from a mast to a wall, observed by any features. */
static kind_t draw(int flight) {
    const kind_t kind = (kind_t)(flight % KINDS);
    scene_default(&scene);
    if (kind == BY_POINTS) {
        scene_make_cylinder(&scene);
        scene.width_m = check_random_between(&any, 1.0, 30.0);
    } else {
        scene.width_m = check_random_between(&any, 2.0, 40.0);
        scene.length_m = check_random_between(&any, 2.0, 40.0);
        scene.alpha_deg = check_random_between(&any, -85.0, 85.0);
    }
    scene.height_m = check_random_between(&any, 4.0, 40.0);
    scene.altitude_m = check_random_between(&any, 5.0, 30.0);
    scene.x0_m = check_random_between(&any, -40.0, 40.0);
    scene.z0_m = check_random_between(&any, 100.0, 200.0);
    scene.speed_mps = check_random_between(&any, 8.0, 14.0);
    scene.wobble_deg = flight % 2 == 0 ? 0.0 : 2.0;
    scene.image_rate_hz = HZ;
    return kind;
}

/* [A34]
 * GIVEN random flights by any features, and an answer WHEN the next image shows nothing THEN the hazard is that which was predicted for
 * that moment: its probability falls by no more than the time explains, and distance and time are the same; ten such images in a row, too.
 * */
static void an_image_without_a_detection_takes_no_warning_back(void) {
    static goe_estimator_t kept;
    double lost = 0.0;
    double moved_sigma = 0.0;
    int compared = 0;
    int warned = 0;
    for (int flight = 0; flight < FLIGHTS; flight++) {
        const kind_t kind = draw(flight);
        start();
        for (int k = 0; k < IMAGES; k++) {
            look(kind, k);
            (void)goe_update(&estimator, &image, &estimate);
            if (!estimate.fresh || ask(0.0) != GOE_OK) {
                continue;
            }
            kept = estimator;
            for (int missed = 1; missed <= 10; missed++) {
                CHECK_STATUS(GOE_OK, ask(1.0 / HZ));
                const goe_hazard_t predicted = hazard;
                look(kind, k + missed);
                hide_all();
                CHECK_STATUS(GOE_NO_DETECTION, goe_update(&estimator, &image, &estimate));
                CHECK_STATUS(GOE_OK, ask(0.0));
                lost = fmax(lost, (double)predicted.conflict_probability - (double)hazard.conflict_probability);
                moved_sigma = fmax(moved_sigma, fabs((double)predicted.dcpa_m - (double)hazard.dcpa_m) /
                                                    ((double)predicted.dcpa_sd_m + 0.05));
                compared++;
                warned += predicted.conflict_probability > 0.5f ? 1 : 0;
            }
            estimator = kept;
        }
    }
    check_report("images without a detection", compared);
    check_report("... after a warning", warned);
    check_report("largest probability lost", lost);
    check_report("largest change of the distance, sigmas", moved_sigma);
    TEST_ASSERT_TRUE(compared > 10000 && warned > 2000);
    TEST_ASSERT_TRUE(lost < LOST_MAX);
    TEST_ASSERT_TRUE(moved_sigma < 0.1);
}

/* Whether the outline is within the margin, whatever the orientation of the obstacle: the middle is ahead, or just behind the camera. */
static bool is_violated(int k) {
    const double behind_m = scene.speed_mps * k / HZ - scene.z0_m;
    const double least_m = scene.length_m > 0.0 ? fmin(scene.width_m, scene.length_m) : scene.width_m;
    return behind_m < 0.5 * least_m + MARGIN_M;
}

/* [A34, goe_answer.c]
 * GIVEN a warning WHEN the filter starts again, whatever comes next THEN the warning stays for as long as the truth is a violation:
 * position and size are kept until an answer replaces them that is better or says otherwise. */
static void a_new_start_of_the_filter_takes_no_warning_back(void) {
    int warned = 0;
    double least = 1.0;
    for (int flight = 0; flight < FLIGHTS; flight++) {
        const kind_t kind = draw(flight);
        scene.x0_m = check_random_between(&any, -3.0, 3.0); /* met, whatever its size */
        scene.altitude_m = check_random_between(&any, 0.2, 0.8) * scene.height_m;
        start();
        for (int k = 0; k < IMAGES; k++) {
            look(kind, k);
            (void)goe_update(&estimator, &image, &estimate);
        }
        if (ask(0.0) != GOE_OK || hazard.conflict_probability < 0.99f || estimate.suspect) {
            continue;
        }
        goe_filter_enter(&estimator.filter, GOE_PHASE_NONE);
        for (int k = IMAGES; k < IMAGES + 12; k++) {
            look(kind, k);
            if (k % 4 == 2) {
                hide_all();
            }
            (void)goe_update(&estimator, &image, &estimate);
            CHECK_STATUS(GOE_OK, ask(0.0));
            least = is_violated(k) ? fmin(least, (double)hazard.conflict_probability) : least;
        }
        warned++;
    }
    check_report("flights with a warning and a new start", warned);
    check_report("least probability after it", least);
    TEST_ASSERT_TRUE(warned > FLIGHTS / 2);
    TEST_ASSERT_TRUE(least > 0.5);
}

/* [A34]
 * GIVEN a building 36 m wide, by points and base corners without noise, every eighth detection missed WHEN the width is not valid THEN the
 * probability stays: once it was 1.0000 with the detection, and 0.0000 an image later. It is not 1, as images before the line of sight
 * turns do not show how deep the building is. */
static void a_wide_building_stays_wide(void) {
    scene.width_m = scene.length_m = 36.0;
    scene.height_m = 17.0;
    scene.altitude_m = 11.0;
    scene.x0_m = 23.0;
    scene.z0_m = 72.0;
    scene.alpha_deg = 0.0;
    scene.speed_mps = 10.0;
    scene.image_rate_hz = HZ;
    scene.top_nearest = true;
    start_on_level_ground();
    int missed = 0;
    float before = 0.0f;
    for (int k = 0; k < 40; k++) {
        scene_image(&scene, k, &image, NULL);
        if (k % 8 == 7) {
            hide_all();
        }
        (void)goe_update(&estimator, &image, &estimate);
        if (k > 8) {
            CHECK_STATUS(GOE_OK, ask(0.0));
            TEST_ASSERT_TRUE(hazard.conflict_probability > 0.85f);
            TEST_ASSERT_TRUE(hazard.conflict_probability > before - (float)LOST_MAX);
            before = hazard.conflict_probability;
            missed += estimate.fresh ? 0 : 1;
        }
    }
    TEST_ASSERT_TRUE(missed >= 4);
}

/* Half of the visible extent of the obstacle, by the filter's state. */
static double reach_by_state(void) {
    const float *x = estimator.filter.state;
    const double q = (double)x[GOE_INVERSE_RANGE];
    if (estimator.filter.phase == GOE_PHASE_FOOTPRINT) {
        const goe_xz_t camera = goe_filter_measured(&estimator.filter);
        const double ahead_x = (double)x[GOE_BEARING] - (double)camera.x * q;
        const double ahead_z = 1.0 - (double)camera.z * q;
        const double range = hypot(ahead_x, ahead_z);
        return rim_reach(x, ahead_z / range, -ahead_x / range) / q;
    }
    return 0.5 * ((double)x[GOE_FRONT_X] + fabs((double)x[GOE_SIDE_X])) / q;
}

/* [A34]
 * GIVEN flights by any features THEN a hazard reaches as far as the filter's own guess of the extent, valid or not; after a new start as far
 * as before, until a new estimate. */
static void the_reach_is_that_of_the_state(void) {
    unsigned phases = 0u;
    for (int flight = 0; flight < 2 * KINDS; flight++) {
        const kind_t kind = draw(flight);
        scene.x0_m = 15.0;
        start();
        for (int k = 0; k < IMAGES; k++) {
            look(kind, k);
            (void)goe_update(&estimator, &image, &estimate);
            if (estimate.fresh && estimate.method == GOE_METHOD_FILTER) {
                const double reach_m = reach_by_state();
                phases |= 1u << estimator.filter.phase;
                CHECK_CLOSE(1.0e-4 * reach_m, reach_m, goe_latest_answer(&estimator).reach_m);
            }
        }
        const float before = goe_latest_answer(&estimator).reach_m;
        goe_filter_enter(&estimator.filter, GOE_PHASE_NONE);
        CHECK_SAME(before, goe_latest_answer(&estimator).reach_m);
    }
    TEST_ASSERT_TRUE(phases & (1u << GOE_PHASE_FOOTPRINT));
    TEST_ASSERT_TRUE(phases & (1u << GOE_PHASE_BOX));
}

/* ---------------------------------------------------------------------------------------------- traps of the interface -- */

/* [A5] GIVEN images without a feature, then a turn of 88 degrees, then a mast dead ahead THEN it is answered for within a second: the empty
 * images have fixed no direction. */
static void a_turn_before_first_sight_costs_nothing(void) {
    scene_make_cylinder(&scene);
    scene.x0_m = 0.0;
    scene.z0_m = 120.0;
    scene.image_rate_hz = HZ;
    start();
    int first = -1;
    for (int k = 0; k < 30 && first < 0; k++) {
        look(BY_POINTS, k);
        if (k < 6) {
            hide_all();
            image.pose.attitude[0] = 0.719339800f; /* 88 degrees to the right */
            image.pose.attitude[1] = image.pose.attitude[2] = 0.0f;
            image.pose.attitude[3] = 0.694658370f;
        }
        (void)goe_update(&estimator, &image, &estimate);
        first = (estimate.valid & GOE_HAS_POSITION) ? k : -1;
    }
    TEST_ASSERT_TRUE(first >= 6 && first <= 14);
    CHECK_CLOSE(1.0e-3, 0.0, estimate.trajectory_heading_deg);
}

/* GIVEN box.sides = true, which marks the left side alone THEN every image says so, and counts it; a whole box does not. */
static void a_box_of_one_side_is_reported(void) {
    start();
    for (int k = 0; k < 8; k++) {
        look(BY_BOXES, k);
        image.box.sides = true;
        CHECK_STATUS(GOE_BOX_INCOMPLETE, goe_update(&estimator, &image, &estimate));
    }
    TEST_ASSERT_EQUAL_UINT32(8u, estimator.fault_counts[-GOE_BOX_INCOMPLETE]);
    look(BY_BOXES, 8);
    TEST_ASSERT_TRUE(goe_update(&estimator, &image, &estimate) != GOE_BOX_INCOMPLETE);
    TEST_ASSERT_EQUAL_UINT32(8u, estimator.fault_counts[-GOE_BOX_INCOMPLETE]);
}

/* GIVEN a height of 0 with a box THEN it is counted as not set and nothing rests on it: range and clearance come from the growth of the
 * box, within three sigma. */
static void a_height_that_was_not_set_is_reported(void) {
    scene.x0_m = -20.0;
    scene.speed_mps = 14.0;
    start();
    for (int k = 0; k < 50; k++) {
        look(BY_BOXES, k);
        image.pose.height_m = k % 2 == 0 ? 0.0f : -0.0f;
        (void)goe_update(&estimator, &image, &estimate);
    }
    TEST_ASSERT_EQUAL_UINT32(50u, estimator.fault_counts[-GOE_NO_HEIGHT]);
    if (estimate.valid & GOE_HAS_POSITION) {
        scene_truth_t truth;
        scene_image(&scene, 49, &image, &truth);
        CHECK_CLOSE(3.0 * (double)estimate.sigma.z_m + 0.5 * scene.length_m, truth.z_m, estimate.z_m);
        CHECK_STATUS(GOE_OK, ask(0.0));
        TEST_ASSERT_TRUE(hazard.has_clearance); /* the growth of the box has shown the height, too */
        CHECK_CLOSE(3.0 * (double)hazard.clearance_sd_m, truth.height_above_ground_m - scene.height_m,
                    hazard.clearance_m);
    }
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
    look(BY_POINTS, 0);
    image.pose.height_m = 0.0f;
    (void)goe_update(&estimator, &image, &estimate);
    TEST_ASSERT_EQUAL_UINT32(0u, estimator.fault_counts[-GOE_NO_HEIGHT]);
}

/* Images in which the estimator takes the box, of those at 10 Hz that show the mast ahead. empty_hz: rate of the images without a
 * detection in between, 0: none; phase_us: when the first of them comes. */
static int used_boxes(int empty_hz, int64_t phase_us) {
    int used = 0;
    scene_default(&scene);
    scene_make_cylinder(&scene);
    scene.image_rate_hz = 1000.0; /* a step is a millisecond */
    scene.boxes = true;
    start();
    for (int64_t ms = 0; ms < 6000; ms++) {
        const bool boxed = ms % 100 == 0;
        const bool empty = empty_hz > 0 && !boxed && (1000 * ms - phase_us) % (1000000 / empty_hz) == 0;
        if (!boxed && !empty) {
            continue;
        }
        scene_image(&scene, (int)ms, &image, NULL);
        if (empty) {
            hide_all();
        }
        (void)goe_update(&estimator, &image, &estimate);
        used += boxed && estimate.fresh ? 1 : 0;
    }
    return used;
}

/* [goe_update]
 * GIVEN boxes at 10 Hz, and images without a detection in between, at any rate and phase, as of a camera that is faster than its detector
 * or of a second camera, WHEN the boxes come THEN all of them are used, as without those images. */
static void images_without_a_detection_leave_every_box(void) {
    static const int rates_hz[] = {10, 20, 40, 50, 100};
    const int alone = used_boxes(0, 0);
    TEST_ASSERT_TRUE(alone >= 58);
    for (size_t i = 0; i < sizeof rates_hz / sizeof rates_hz[0]; i++) {
        for (int64_t phase_us = 1000; phase_us < 1000000 / rates_hz[i]; phase_us += 3000) {
            TEST_ASSERT_EQUAL_INT(alone, used_boxes(rates_hz[i], phase_us));
        }
    }
}

/* A detection that gives no estimate: its sides are exchanged. */
static void spoil(void) {
    const float left_px = image.box.left_px;
    image.box.left_px = image.box.right_px;
    image.box.right_px = left_px;
}

/* [GOE_DECISION_UNKNOWN]
 * GIVEN an obstacle that is passed at a distance, by either method, WHEN detections give no new estimate for over two seconds THEN nothing
 * is clear, until the detector is silent or a detection gives an estimate. */
static void detections_without_an_estimate_clear_nothing(void) {
    for (int by = 0; by < 2; by++) {
        scene_default(&scene);
        scene_make_cylinder(&scene);
        scene.x0_m = 70.0;
        scene.z0_m = 300.0;
        scene.image_rate_hz = 10.0;
        settings = scene_settings(&scene);
        settings.method = by == 0 ? GOE_METHOD_FILTER : GOE_METHOD_WINDOW;
        if (goe_init(&estimator, sizeof estimator, &settings, NULL) != GOE_OK) {
            continue; /* the method is left out */
        }
        const goe_intent_t intent = intent_of(0.0);
        int clear[4] = {0, 0, 0, 0};
        for (int k = 0; k < 100; k++) {
            scene.boxes = true;
            scene_image(&scene, k, &image, NULL);
            const int part =
                k < 40 ? 0 : (k < 62 ? 1 : (k < 80 ? 2 : 3)); /* good; spoiled: two seconds, and after; none */
            if (part == 1 || part == 2) {
                spoil();
            } else if (part == 3) {
                hide_all();
            }
            (void)goe_update(&estimator, &image, &estimate);
            const bool cleared = goe_decide(&estimator, &intent, NULL, NULL) == GOE_DECISION_CLEAR;
            clear[part] += cleared && (part != 3 || k >= 97) ? 1 : 0;
        }
        TEST_ASSERT_TRUE(clear[0] > 20 && clear[1] > 15);
        TEST_ASSERT_EQUAL_INT(0, clear[2]);
        TEST_ASSERT_EQUAL_INT(3, clear[3]);
    }
}

/* Boxes of a mast that is passed at a distance. */
static void start_aside(double image_rate_hz, double speed_mps) {
    scene_default(&scene);
    scene_make_cylinder(&scene);
    scene.x0_m = 70.0;
    scene.z0_m = 300.0;
    scene.image_rate_hz = image_rate_hz;
    scene.speed_mps = speed_mps;
    scene.boxes = true;
    start();
}

/* [GOE_DECISION_UNKNOWN]
 * GIVEN an obstacle that is passed at a distance WHEN detections without a new estimate come for over two seconds, one in half a second,
 * among images without a detection at any rate, THEN nothing is clear in between; after two silent seconds it is. */
static void rare_detections_without_an_estimate_clear_nothing(void) {
    static const int every[] = {1, 5, 25, 50}; /* of 1000 images a second */
    for (size_t i = 0; i < sizeof every / sizeof every[0]; i++) {
        start_aside(1000.0, 16.0);
        const goe_intent_t intent = intent_of(0.0);
        for (int ms = 0; ms < 10500; ms += every[i]) {
            scene_image(&scene, ms, &image, NULL);
            if (ms % 500 == 0 && ms >= 3000 && ms <= 8000) {
                spoil();
            } else if (ms % 100 != 0 || ms >= 3000) {
                hide_all();
            }
            (void)goe_update(&estimator, &image, &estimate);
            const goe_decision_t decision = goe_decide(&estimator, &intent, NULL, NULL);
            TEST_ASSERT_TRUE(ms < 1000 || ms > 4000 || decision == GOE_DECISION_CLEAR);
            TEST_ASSERT_TRUE(ms < 5500 || ms > 8000 || decision == GOE_DECISION_UNKNOWN);
            TEST_ASSERT_TRUE(ms < 10000 || decision == GOE_DECISION_CLEAR);
        }
    }
}

/* [GOE_DECISION_UNKNOWN]
 * GIVEN images in which the obstacle grows faster than it can at the estimated range WHEN the next images show one end of it, or the range
 * seems right again, THEN nothing is clear for two more seconds of images that show both ends. */
static void a_doubt_about_the_range_lasts(void) {
    start_aside(10.0, 8.0);
    const goe_intent_t intent = intent_of(0.0);
    int doubted = 0;
    int partial = 0;
    int after = 0;
    for (int k = 0; k < 130 && after < 40; k++) {
        scene_image(&scene, k, &image, NULL);
        if (k == 60 || k == 61) { /* twice as large */
            const float half_px = 0.5f * (image.box.bottom_px - image.box.top_px);
            image.box.top_px -= half_px;
            image.box.bottom_px += half_px;
        } else if (k > 61 && k < 100) {
            image.box.sides = GOE_SIDE_LEFT | GOE_SIDE_TOP;
        }
        (void)goe_update(&estimator, &image, &estimate);
        const bool clear = goe_decide(&estimator, &intent, NULL, NULL) == GOE_DECISION_CLEAR;
        TEST_ASSERT_TRUE(k < 20 || k >= 60 || clear);
        doubted += k == 61 && !clear ? 1 : 0;
        partial += k > 61 && k < 100 && clear ? 1 : 0;
        after += k >= 100 && clear ? 1 : 0;
        TEST_ASSERT_TRUE(k < 100 || k >= 118 || !clear);
    }
    TEST_ASSERT_EQUAL_INT(1, doubted);
    TEST_ASSERT_EQUAL_INT(0, partial);
    TEST_ASSERT_TRUE(after > 0);
}

/* [goe_pose_t.height_m] GIVEN a track whose first images have a box and no height WHEN the heights come THEN they give the range as if
 * the track had begun then. */
static void a_late_height_gives_the_range(void) {
    for (int first = 1; first <= 5; first++) {
        scene_make_cylinder(&scene);
        scene.z0_m = 200.0;
        scene.image_rate_hz = 10.0;
        scene.boxes = true;
        start();
        for (int k = 0; k < first + 2; k++) {
            scene_image(&scene, k, &image, NULL);
            image.pose.height_m = k < first ? 0.0f : image.pose.height_m;
            (void)goe_update(&estimator, &image, &estimate);
        }
        TEST_ASSERT_TRUE((estimate.valid & GOE_HAS_POSITION) != 0u && estimate.fresh);
    }
}

/* [goe_estimate_t.center_north_m] GIVEN an obstacle with a velocity WHEN no image shows it any more THEN its center moves on as x and z do, and its sigma
 * grows with that of the velocity. */
static void the_center_of_a_moving_obstacle_moves_on(void) {
    scene_make_cylinder(&scene);
    scene.image_rate_hz = 10.0;
    scene.boxes = true;
    start();
    for (int k = 0; k < 60; k++) {
        scene_image(&scene, k, &image, NULL);
        if (k == 20) { /* as if it had been estimated */
            TEST_ASSERT_TRUE((estimate.valid & GOE_HAS_CENTER) != 0u);
            estimator.estimate.valid |= GOE_HAS_VELOCITY;
            estimator.estimate.velocity_north_m_s = -3.0f;
            estimator.estimate.velocity_east_m_s = 6.0f;
            estimator.estimate.sigma.velocity_north_m_s = 0.5f;
            estimator.estimate.sigma.velocity_east_m_s = 2.0f;
            estimate = estimator.estimate;
        }
        if (k >= 20) {
            goe_estimate_t now;
            hide_all();
            (void)goe_update(&estimator, &image, &now);
            const double since_s = 0.1 * (k - 19);
            CHECK_CLOSE(1.0e-3, (double)estimate.center_north_m - 3.0 * since_s, now.center_north_m);
            CHECK_CLOSE(1.0e-3, (double)estimate.center_east_m + 6.0 * since_s, now.center_east_m);
            CHECK_CLOSE(1.0e-3, (double)estimate.sigma.center_north_m + 0.5 * since_s, now.sigma.center_north_m);
            CHECK_CLOSE(1.0e-3, (double)estimate.sigma.center_east_m + 2.0 * since_s, now.sigma.center_east_m);
            CHECK_CLOSE(1.0e-2, (double)(image.pose.position_ned_m[1] + now.x_m), now.center_east_m);
        } else {
            (void)goe_update(&estimator, &image, &estimate);
        }
    }
}

/* GIVEN a first height 5 m too low WHEN the filter starts again, which averages all heights, THEN the kept estimate keeps its clearance in a
 * level flight: its height refers to the zero of its time. */
static void a_new_start_leaves_the_clearance(void) {
    start();
    for (int k = 0; k < IMAGES; k++) {
        look(BY_BOXES, k);
        image.pose.height_m -= k == 0 ? 5.0f : 0.0f;
        (void)goe_update(&estimator, &image, &estimate);
    }
    CHECK_STATUS(GOE_OK, ask(0.0));
    TEST_ASSERT_TRUE(hazard.has_clearance);
    const double before_m = (double)hazard.clearance_m;
    const double moved_m = (double)estimator.filter.datum.mean_m;
    TEST_ASSERT_TRUE(moved_m > 2.0);
    goe_filter_enter(&estimator.filter, GOE_PHASE_NONE);
    for (int k = IMAGES; k < IMAGES + 8; k++) {
        look(BY_BOXES, k);
        hide_all();
        (void)goe_update(&estimator, &image, &estimate);
        CHECK_STATUS(GOE_OK, ask(0.0));
        CHECK_CLOSE(0.05, before_m, hazard.clearance_m);
    }
}

/* GIVEN an obstacle that is passed at a distance, whose last box comes too soon after another one, WHEN the detector is silent from then on,
 * THEN it stays clear. */
static void a_box_too_soon_does_not_end_clear(void) {
    start_aside(50.0, 16.0);
    const goe_intent_t intent = intent_of(0.0);
    for (int k = 0; k < 400; k++) {
        scene_image(&scene, k, &image, NULL);
        const bool boxed = k < 200 && (k % 50 == 0 || k % 50 == 2); /* pairs, 40 ms apart, once a second; then none */
        if (!boxed) {
            hide_all();
        }
        if (boxed || k % 50 == 25) {
            (void)goe_update(&estimator, &image, &estimate);
            TEST_ASSERT_TRUE(k < 150 || goe_decide(&estimator, &intent, NULL, NULL) == GOE_DECISION_CLEAR);
        }
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(an_image_without_a_detection_takes_no_warning_back);
    RUN_TEST(a_new_start_of_the_filter_takes_no_warning_back);
    RUN_TEST(a_new_start_leaves_the_clearance);
    RUN_TEST(a_wide_building_stays_wide);
    RUN_TEST(the_reach_is_that_of_the_state);
    RUN_TEST(a_turn_before_first_sight_costs_nothing);
    RUN_TEST(a_box_of_one_side_is_reported);
    RUN_TEST(a_height_that_was_not_set_is_reported);
    RUN_TEST(images_without_a_detection_leave_every_box);
    RUN_TEST(detections_without_an_estimate_clear_nothing);
    RUN_TEST(a_box_too_soon_does_not_end_clear);
    RUN_TEST(rare_detections_without_an_estimate_clear_nothing);
    RUN_TEST(a_doubt_about_the_range_lasts);
    RUN_TEST(a_late_height_gives_the_range);
    RUN_TEST(the_center_of_a_moving_obstacle_moves_on);
    return UNITY_END();
}
