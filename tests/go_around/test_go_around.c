/* The README's rule for going around, flown. SPDX-License-Identifier: MIT
 *
 * Collision courses: an aircraft flies level towards an obstacle that is higher than its path. The features are what a
 * detector gives, the middles of the sides of upright bounding boxes, from an aircraft that rolls: a case in which the
 * estimates are suspect most of the time. */
#include <math.h>
#include <string.h>

#include "check.h"
#include "scene.h"

#include "readme_rule.h"

#define RUNS 200
#define SPEED_M_S 20.0
#define RATE_HZ 8.0
#define FIRST_RANGE_M 500.0
#define AHEAD_S 8.0 /* the least that an order must come before the obstacle is reached */
#define BOX_PX 0.5

static check_random_t any;
static scene_t scene;
static goe_estimator_t estimator;

void setUp(void) { any = check_random_start("going around"); }
void tearDown(void) {}

/* What of a flight is counted. */
typedef struct {
    double ordered_s;    /* before the obstacle is reached; negative: never */
    int suspect, images; /* until then */
} outcome_t;

/* aside_m: of the path from the middle of the obstacle. */
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
}

/* seen: whether the detector sees the obstacle in image k. */
static outcome_t fly(bool (*seen)(int k)) {
    static const float velocity_ned_m_s[3] = {(float)SPEED_M_S, 0.0f, 0.0f};
    outcome_t outcome = {-1.0, 0, 0};
    goe_settings_t settings = scene_settings(&scene);
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
    for (int k = 0; outcome.ordered_s < 0.0; k++) {
        goe_image_t image;
        goe_estimate_t estimate;
        const double left_s = (FIRST_RANGE_M - SPEED_M_S * k / RATE_HZ) / SPEED_M_S;
        if (left_s <= 1.0) {
            break;
        }
        scene_image(&scene, k, &image, NULL);
        scene_add_noise(&image, &any, BOX_PX);
        if (!seen(k)) {
            image.left.seen = image.right.seen = image.top.seen = false;
        }
        (void)goe_update(&estimator, &image, &estimate);
        outcome.suspect += estimate.suspect ? 1 : 0;
        outcome.images++;
        if (must_go_around(&estimator, &estimate, velocity_ned_m_s)) {
            outcome.ordered_s = left_s;
        }
    }
    return outcome;
}

static bool always(int k) {
    (void)k;
    return true;
}

/* Two seconds of every five. */
static bool with_gaps(int k) { return k % 40 >= 16; }

static double least_ordered_s(double roll_deg, bool (*seen)(int k), int *suspect, int *images) {
    double least_s = 1.0e9;
    for (int run = 0; run < RUNS; run++) {
        make_course(check_random_between(&any, -2.0, 2.0), roll_deg);
        const outcome_t outcome = fly(seen);
        least_s = outcome.ordered_s < least_s ? outcome.ordered_s : least_s;
        *suspect += outcome.suspect;
        *images += outcome.images;
    }
    return least_s;
}

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

static void the_order_comes_through_gaps_of_the_detector(void) {
    int suspect = 0;
    int images = 0;
    const double least_s = least_ordered_s(5.0, with_gaps, &suspect, &images);
    check_report("least time ahead with gaps, s", least_s);
    TEST_ASSERT_TRUE(least_s >= AHEAD_S);
}

/* An estimate that is suspect or old asks for more room, so it warns at least as early. */
static void doubt_warns_no_later(void) {
    static const float velocity_ned_m_s[3] = {(float)SPEED_M_S, 0.0f, 0.0f};
    int warned = 0;
    for (int run = 0; run < RUNS; run++) {
        make_course(check_random_between(&any, -40.0, 40.0), 0.0);
        goe_settings_t settings = scene_settings(&scene);
        CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
        for (int k = 0; k < 120; k++) {
            goe_image_t image;
            goe_estimate_t sure;
            scene_image(&scene, k, &image, NULL);
            (void)goe_update(&estimator, &image, &sure);
            goe_estimate_t doubtful = sure;
            goe_estimate_t old = sure;
            sure.suspect = false;
            doubtful.suspect = true;
            old.age_s = 3.0f;
            if (must_go_around(&estimator, &sure, velocity_ned_m_s)) {
                TEST_ASSERT_TRUE(must_go_around(&estimator, &doubtful, velocity_ned_m_s));
                TEST_ASSERT_TRUE(must_go_around(&estimator, &old, velocity_ned_m_s));
                warned++;
            }
        }
    }
    TEST_ASSERT_TRUE(warned > RUNS);
}

/* ... and one that flies past at a distance is left alone. */
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
    RUN_TEST(the_order_comes_through_gaps_of_the_detector);
    RUN_TEST(doubt_warns_no_later);
    RUN_TEST(a_wide_pass_is_no_reason);
    return UNITY_END();
}
