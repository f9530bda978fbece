/* Flies the decision rule of the README. SPDX-License-Identifier: MIT
 *
 * Collision courses: an aircraft flies level towards an obstacle that is higher than its path, and rolls. The features are a
 * detector's: upright bounding boxes with an error correlation time of one second; or, which is discouraged, the middles of
 * their sides as points, for which the estimates are suspect most of the time. */
#include <math.h>
#include <string.h>

#include "check.h"
#include "scene.h"

#include "readme_rule.h"

#define RUNS 200
#define BOX_RUNS 250 /* at each of four rolls */
#define SPEED_M_S 20.0
#define RATE_HZ 8.0
#define FIRST_RANGE_M 500.0
#define MARGIN_M 15.0 /* of the README's intended velocity */
#define AHEAD_S 8.0   /* an order must come at least this long before the obstacle is reached */
#define BOX_PX 0.5
#define BOX_SHARE 0.04        /* correlated side error, relative to the box's size */
#define BOX_CORRELATION_S 1.0 /* ... and its correlation time */
#define IMAGE_PX 1280.0f      /* width and height of the image */

static check_random_t any;
static scene_t scene;
static goe_estimator_t estimator;
static unsigned hidden_sides; /* GOE_SIDE_..., without which every box comes */
static bool is_level;         /* the ground, as configured */

void setUp(void) {
    is_level = false;
    any = check_random_start("going around");
    hidden_sides = 0u;
}
void tearDown(void) {}

/* Counts of a flight. */
typedef struct {
    double ordered_s;    /* before the obstacle is reached; negative: never */
    int suspect, images; /* until then */
} outcome_t;

/* aside_m: distance of the path from the middle of the obstacle. */
static void make_course(double aside_m, double roll_deg) {
    scene_default(&scene);
    if (check_random_bits(&any) % 3u == 0u) {
        scene_make_cylinder(&scene);
        scene.width_m = check_random_between(&any, 2.0, 10.0);
    } else {
        scene.width_m = check_random_between(&any, 4.0, 20.0);
        scene.length_m = check_random_between(&any, 4.0, 20.0);
        scene.alpha_deg = check_random_between(&any, -80.0, 80.0);
    }
    scene.height_m = check_random_between(&any, 25.0, 60.0);
    scene.altitude_m = 20.0;
    scene.x0_m = aside_m;
    scene.z0_m = FIRST_RANGE_M;
    scene.speed_mps = SPEED_M_S;
    scene.image_rate_hz = RATE_HZ;
    scene.roll_swing_deg = roll_deg;
    scene.roll_swing_hz = 0.4;
    scene.upright_boxes = true;
    scene.camera.width_px = scene.camera.height_px = IMAGE_PX;
}

/* The box of a real detector: correlated errors, sides not outside the image. */
static void spoil_box(goe_image_t *image, double error[4]) {
    goe_box_t *box = &image->box;
    float *side[4] = {&box->left_px, &box->top_px, &box->right_px, &box->bottom_px};
    const double width = (double)box->right_px - (double)box->left_px;
    const double height = (double)box->bottom_px - (double)box->top_px;
    const double kept = exp(-1.0 / RATE_HZ / BOX_CORRELATION_S);
    for (int i = 0; i < 4; i++) {
        const double size = i % 2 == 0 ? width : height;
        error[i] = kept * error[i] + sqrt(1.0 - kept * kept) * check_random_normal(&any);
        *side[i] += (float)(BOX_SHARE * size * error[i] + BOX_PX * check_random_normal(&any));
        *side[i] = *side[i] > 0.0f ? *side[i] : 0.0f;
        *side[i] = *side[i] < IMAGE_PX - 1.0f ? *side[i] : IMAGE_PX - 1.0f;
    }
}

/* detected: whether the detector finds the obstacle in image k. From refused_m ahead on, the attitude of every image is none. reported:
 * the caller passes the time since the latest image taken, not 0. */
static outcome_t fly_refused(bool (*detected)(int k), double refused_m, bool reported) {
    static const float velocity_ned_m_s[3] = {(float)SPEED_M_S, 0.0f, 0.0f};
    outcome_t outcome = {-1.0, 0, 0};
    bool go_around = false;
    int taken = 0;
    double error[4];
    for (int i = 0; i < 4; i++) {
        error[i] = check_random_normal(&any);
    }
    goe_settings_t settings = scene_settings(&scene);
    settings.navigation.terrain_slope_sd = is_level ? 0.0f : settings.navigation.terrain_slope_sd;
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
    for (int k = 0; outcome.ordered_s < 0.0; k++) {
        goe_image_t image;
        goe_estimate_t estimate;
        const double left_s = (FIRST_RANGE_M - SPEED_M_S * k / RATE_HZ) / SPEED_M_S;
        if (left_s <= 1.0) {
            break;
        }
        scene_image(&scene, k, &image, NULL);
        if (hidden_sides != 0u) {
            image.box.sides &= (uint8_t)~hidden_sides;
        }
        if (scene.boxes) {
            spoil_box(&image, error);
        } else {
            scene_add_noise(&image, &any, BOX_PX);
        }
        if (!detected(k)) {
            image.box.sides = 0;
            image.left.visible = image.right.visible = image.top.visible = false;
        }
        if (SPEED_M_S * left_s <= refused_m) {
            memset(image.pose.attitude, 0, sizeof image.pose.attitude);
        }
        const goe_status_t status = goe_update(&estimator, &image, &estimate);
        taken = GOE_IMAGE_TAKEN(status) ? k : taken;
        outcome.suspect += estimate.suspect ? 1 : 0;
        outcome.images++;
        decide(&estimator, velocity_ned_m_s, reported ? (float)((k - taken) / RATE_HZ) : 0.0f, &go_around);
        outcome.ordered_s = go_around ? left_s : -1.0;
    }
    return outcome;
}

static outcome_t fly(bool (*detected)(int k)) { return fly_refused(detected, 0.0, true); }

static bool always(int k) {
    (void)k;
    return true;
}

/* Two seconds of every five. */
static bool with_gaps(int k) { return k % 40 >= 16; }

static double least_ordered_s(double roll_deg, bool (*detected)(int k), int *suspect, int *images) {
    double least_s = 1.0e9;
    for (int run = 0; run < RUNS; run++) {
        make_course(check_random_between(&any, -2.0, 2.0), roll_deg);
        const outcome_t outcome = fly(detected);
        least_s = outcome.ordered_s < least_s ? outcome.ordered_s : least_s;
        *suspect += outcome.suspect;
        *images += outcome.images;
    }
    return least_s;
}

/* [GOE_DECISION_ACT, goe_decide] */
static void the_order_comes_on_every_collision_course(void) {
    static const double roll_deg[] = {0.0, 5.0, 10.0};
    for (int i = 0; i < 3; i++) {
        int suspect = 0;
        int images = 0;
        const double least_s = least_ordered_s(roll_deg[i], always, &suspect, &images);
        check_report("roll, degrees", roll_deg[i]);
        check_report("least time ahead, s", least_s);
        check_report("share of suspect images", (double)suspect / images);
        TEST_ASSERT_TRUE(least_s >= AHEAD_S);
    }
}

/* [GOE_DECISION_ACT, goe_decide] The same by unmodified boxes. */
static void the_order_comes_by_boxes(void) {
    static const double roll_deg[] = {0.0, 5.0, 10.0, 25.0};
    for (int i = 0; i < 4; i++) {
        double least_s = 1.0e9;
        for (int run = 0; run < BOX_RUNS; run++) {
            make_course(check_random_between(&any, -2.0, 2.0), roll_deg[i]);
            scene.boxes = true;
            const double ordered_s = fly(always).ordered_s;
            least_s = ordered_s < least_s ? ordered_s : least_s;
        }
        check_report("boxes, roll, degrees", roll_deg[i]);
        check_report("least time ahead, s", least_s);
        TEST_ASSERT_TRUE(least_s >= AHEAD_S);
    }
}

/* [goe_decide] ... and the path that keeps twice the margin from the outline causes no order, 19 times of 20, over ground that is
 * configured as level, as it is. */
static void a_pass_at_twice_the_margin_by_boxes(void) {
    static const double roll_deg[] = {0.0, 25.0};
    is_level = true;
    for (int i = 0; i < 2; i++) {
        int ordered = 0;
        for (int run = 0; run < BOX_RUNS; run++) {
            make_course(0.0, roll_deg[i]);
            scene.boxes = true;
            const double reach_m =
                scene.shape == SCENE_CYLINDER ? 0.5 * scene.width_m : 0.5 * hypot(scene.width_m, scene.length_m);
            const double middle_m = scene.shape == SCENE_CYLINDER ? 0.0 : 0.5 * scene.length_m;
            scene.x0_m = 2.0 * MARGIN_M + reach_m - middle_m * sin(scene.alpha_deg * 0.017453292519943295);
            ordered += fly(always).ordered_s > 0.0 ? 1 : 0;
        }
        check_report("boxes, orders on passes at twice the margin, share", (double)ordered / BOX_RUNS);
        TEST_ASSERT_TRUE(ordered <= BOX_RUNS / 20);
    }
}

/* [goe_decide] */
static void the_order_comes_through_gaps_of_the_detector(void) {
    int suspect = 0;
    int images = 0;
    const double least_s = least_ordered_s(5.0, with_gaps, &suspect, &images);
    check_report("least time ahead with gaps, s", least_s);
    TEST_ASSERT_TRUE(least_s >= AHEAD_S);
}

/* [GOE_IMAGE_TAKEN, goe_decide, goe_intent_t.since_image_s] GIVEN ten seconds of good images WHEN every further image is refused THEN
 * the order is in time: the time since the latest image taken moves the aircraft on, and without it the refused images' own times. */
static void the_order_comes_although_images_are_refused(void) {
    static const double roll_deg[] = {0.0, 10.0};
    for (int i = 0; i < 4; i++) {
        double least_s = 1.0e9;
        for (int run = 0; run < RUNS; run++) {
            make_course(check_random_between(&any, -2.0, 2.0), roll_deg[i / 2]);
            scene.boxes = true;
            const double ordered_s = fly_refused(always, 300.0, i % 2 == 0).ordered_s;
            least_s = ordered_s < least_s ? ordered_s : least_s;
        }
        check_report("refused images, least time ahead, s", least_s);
        TEST_ASSERT_TRUE(least_s >= AHEAD_S);
    }
}

/* [goe_box_t.sides, goe_decide] GIVEN an obstacle of which only the lower 3 to 8 m are visible, 12 m below the path at least WHEN its
 * boxes lack the top and the aircraft rolls THEN no height is reported, and the order is in time: the ends of left and right are those
 * of the visible part, and say nothing about the height. */
static void the_order_comes_although_the_top_is_hidden(void) {
    static const double roll_deg[] = {3.0, 15.0, 25.0};
    for (int i = 0; i < 3; i++) {
        double least_s = 1.0e9;
        for (int run = 0; run < RUNS / 2; run++) {
            make_course(check_random_between(&any, -2.0, 2.0), roll_deg[i]);
            scene.boxes = true;
            scene.height_m = check_random_between(&any, 3.0, 8.0);
            hidden_sides = GOE_SIDE_TOP;
            const double ordered_s = fly(always).ordered_s;
            TEST_ASSERT_EQUAL_HEX(0, estimator.estimate.valid & GOE_HAS_HEIGHT);
            least_s = ordered_s < least_s ? ordered_s : least_s;
        }
        check_report("hidden top, least time ahead, s", least_s);
        TEST_ASSERT_TRUE(least_s >= AHEAD_S);
    }
}

/* Whether the rule orders a first time. */
static bool orders(const goe_estimator_t *of) {
    static const float velocity_ned_m_s[3] = {(float)SPEED_M_S, 0.0f, 0.0f};
    bool go_around = false;
    decide(of, velocity_ned_m_s, 0.0f, &go_around);
    return go_around;
}

/* [goe_decide] GIVEN an estimate for which the rule orders WHEN the same is suspect, or three seconds old THEN the rule orders, too. */
static void doubt_warns_no_later(void) {
    static goe_estimator_t doubtful;
    static goe_estimator_t old;
    int warned = 0;
    for (int run = 0; run < RUNS; run++) {
        make_course(check_random_between(&any, -40.0, 40.0), 0.0);
        goe_settings_t settings = scene_settings(&scene);
        CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
        for (int k = 0; k < 120; k++) {
            goe_image_t image;
            goe_estimate_t estimate;
            scene_image(&scene, k, &image, NULL);
            (void)goe_update(&estimator, &image, &estimate);
            estimator.estimate.suspect = false;
            doubtful = old = estimator;
            doubtful.estimate.suspect = true;
            old.estimate.fresh = false;
            old.estimate_time_us -=
                old.estimate.valid != 0u ? 3000000 : 0; /* without an answer it is the smallest of all times */
            if (orders(&estimator)) {
                TEST_ASSERT_TRUE(orders(&doubtful));
                TEST_ASSERT_TRUE(orders(&old));
                warned++;
            }
        }
    }
    TEST_ASSERT_TRUE(warned > RUNS);
}

/* [GOE_DECISION_KEEP, goe_decide]
 * GIVEN an active order WHEN the rule cannot decide, because of a NaN velocity, flipped settings, an estimator that was
 * never initialized, or no position THEN the order stays; and no new one is given. */
static void no_failure_means_clear(void) {
    static goe_estimator_t broken;
    const float ahead[3] = {(float)SPEED_M_S, 0.0f, 0.0f};
    const float no_number[3] = {NAN, 0.0f, 0.0f};
    const float too_fast[3] = {0.0f, 2.0e3f, 0.0f};
    make_course(0.0, 0.0);
    (void)fly(always);
    for (int ordered = 0; ordered < 2; ordered++) {
        bool go_around = ordered == 1;
        decide(&estimator, no_number, 0.0f, &go_around);
        decide(&estimator, too_fast, 0.0f, &go_around);
        broken = estimator;
        ((unsigned char *)&broken.settings)[176] ^= 4u;
        decide(&broken, ahead, 0.0f, &go_around);
        memset(&broken, 0, sizeof broken);
        decide(&broken, ahead, 0.0f, &go_around);
        broken = estimator;
        CHECK_STATUS(GOE_OK, goe_reset(&broken));
        decide(&broken, ahead, 0.0f, &go_around);
        decide(NULL, ahead, 0.0f, &go_around);
        TEST_ASSERT_EQUAL_INT(ordered, go_around);
    }
}

/* [goe_decide] ... and an obstacle passed at a distance causes no order. */
static void a_wide_pass_is_no_reason(void) {
    int ordered = 0;
    for (int run = 0; run < RUNS; run++) {
        make_course(check_random_bits(&any) % 2u == 0u ? 90.0 : -90.0, 0.0);
        ordered += fly(always).ordered_s > 0.0 ? 1 : 0;
    }
    check_report("orders on passes at 90 m, share", (double)ordered / RUNS);
    TEST_ASSERT_TRUE(ordered <= RUNS / 20);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(the_order_comes_on_every_collision_course);
    RUN_TEST(the_order_comes_by_boxes);
    RUN_TEST(a_pass_at_twice_the_margin_by_boxes);
    RUN_TEST(the_order_comes_through_gaps_of_the_detector);
    RUN_TEST(the_order_comes_although_images_are_refused);
    RUN_TEST(the_order_comes_although_the_top_is_hidden);
    RUN_TEST(doubt_warns_no_later);
    RUN_TEST(no_failure_means_clear);
    RUN_TEST(a_wide_pass_is_no_reason);
    return UNITY_END();
}
