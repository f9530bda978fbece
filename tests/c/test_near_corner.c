/* Base corners left and right without the one between: one face, or two whose corner was missed. SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "check.h"
#include "goe.h"
#include "refined/goe_filter.h"
#include "scene.h"

#define FLIGHTS 40
#define IMAGES 64
#define NOISE_PX 0.5
#define SIGMAS_MAX 5.0

typedef bool (*shows_t)(int k); /* whether the near corner is marked in image k where it is visible */

static check_random_t any;
static scene_t scene;
static goe_settings_t settings;
static goe_estimator_t estimator;
static goe_estimate_t estimate;
static int faces, boxes; /* images in the phase of a single face, and of two */
static int oriented;     /* images with an orientation */
static double worst;     /* error of orientation, width, length or height, in its sigmas */

void setUp(void) {
    scene_default(&scene);
    scene.top_nearest = true;
    scene.speed_mps = 15.0;
    scene.altitude_m = 20.0;
    scene.z0_m = 150.0;
}
void tearDown(void) {}

static bool always(int k) {
    (void)k;
    return true;
}
static bool never(int k) {
    (void)k;
    return false;
}
static bool now_and_then(int k) { return k % 6 == 0; }

static void check_error(double error, double sigma) { worst = fmax(worst, fabs(error) / fmax(sigma, 1.0e-3)); }

/* Front and side may be reported by each other's name. */
static void check_estimate(void) {
    const double turned = remainder((double)estimate.orientation_deg - scene.alpha_deg, 180.0);
    const bool exchanged = fabs(turned) > 45.0;
    const double width = exchanged ? scene.length_m : scene.width_m;
    const double length = exchanged ? scene.width_m : scene.length_m;
    if (estimate.valid & GOE_HAS_HEIGHT) {
        check_error((double)estimate.height_m - scene.height_m, (double)estimate.sigma.height_m);
    }
    if (!(estimate.valid & GOE_HAS_ORIENTATION)) {
        return;
    }
    oriented++;
    check_error(remainder(turned, 90.0), (double)estimate.sigma.orientation_deg);
    if (estimate.valid & GOE_HAS_WIDTH) {
        check_error((double)estimate.width_m - width, (double)estimate.sigma.width_m);
    }
    if (estimate.valid & GOE_HAS_LENGTH) {
        check_error((double)estimate.length_m - length, (double)estimate.sigma.length_m);
    }
}

static void fly(shows_t shows, bool highest) {
    settings = scene_settings(&scene);
    settings.filter.top_is_highest = highest;
    scene.top_nearest = !highest;
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
    for (int k = 0; k < IMAGES; k++) {
        goe_image_t image;
        scene_image(&scene, k, &image, NULL);
        scene_add_noise(&image, &any, NOISE_PX);
        image.base_near.visible = image.base_near.visible && shows(k);
        (void)goe_update(&estimator, &image, &estimate);
        faces += estimator.filter.phase == GOE_PHASE_BOX_FACE;
        boxes += estimator.filter.phase == GOE_PHASE_BOX;
        if (estimate.method == GOE_METHOD_FILTER) {
            check_estimate();
        }
    }
}

static void start(const char *name) {
    any = check_random_start(name);
    faces = boxes = oriented = 0;
    worst = 0.0;
}

static void report(void) {
    check_report("images of a single face", faces);
    check_report("images of a box", boxes);
    check_report("images with an orientation", oriented);
    check_report("worst error, sigmas", worst);
}

/* A house that shows two faces, neither of which is narrow. */
static void stand_askew(void) {
    scene.width_m = check_random_between(&any, 6.0, 12.0);
    scene.length_m = check_random_between(&any, 6.0, 12.0);
    scene.height_m = check_random_between(&any, 4.0, 10.0);
    scene.alpha_deg =
        check_random_between(&any, 20.0, 70.0) * (check_random_between(&any, -1.0, 1.0) < 0.0 ? -1.0 : 1.0);
    scene.x0_m = check_random_between(&any, -10.0, 10.0);
}

/* [goe_image_t.base_near]
 * GIVEN two faces WHEN the corner between them is visible in every sixth image alone THEN they are never taken for one. */
static void a_missed_corner_makes_no_face_of_two(void) {
    start("now and then");
    for (int n = 0; n < FLIGHTS; n++) {
        stand_askew();
        fly(now_and_then, false);
    }
    report();
    TEST_ASSERT_EQUAL_INT(0, faces);
    TEST_ASSERT_TRUE(worst < SIGMAS_MAX);
}

/* [(R37)]
 * GIVEN two faces WHEN the corner between them is never visible THEN their ends are taken for a face only where one is possible, across the
 * line of sight; and the reported sigmas then include that. */
static void two_ends_are_no_sure_face(void) {
    start("never");
    for (int n = 0; n < FLIGHTS; n++) {
        stand_askew();
        fly(never, false);
    }
    report();
    TEST_ASSERT_TRUE(faces < FLIGHTS * IMAGES / 2);
    TEST_ASSERT_TRUE(worst < 6.0); /* a diagonal is up to 45 degrees off */
}

/* [goe_image_t.base_near]
 * GIVEN one face WHEN a turn brings the second into view THEN orientation, width and length are right within their sigmas. */
static void a_second_face_comes_late_in_a_turn(void) {
    start("turn");
    int beyond = 0;
    double most = 0.0;
    for (int n = 0; n < FLIGHTS; n++) {
        worst = 0.0;
        scene.width_m = check_random_between(&any, 6.0, 14.0);
        scene.length_m = check_random_between(&any, 6.0, 14.0);
        scene.x0_m = check_random_between(&any, -2.0, 2.0);
        scene.alpha_deg = 0.0;
        scene.z0_m = 120.0;
        scene.path = SCENE_ARC;
        scene.arc_radius_m = n % 2 == 0 ? 200.0 : -200.0;
        fly(always, false);
        beyond += worst >= SIGMAS_MAX;
        most = fmax(most, worst);
    }
    worst = most;
    report();
    TEST_ASSERT_TRUE(faces > FLIGHTS && boxes > FLIGHTS);
    TEST_ASSERT_TRUE(beyond <= FLIGHTS / 20); /* a length that is first viewed at a grazing angle */
}

/* [(R37)]
 * GIVEN a truck ahead, end on, viewed from above WHEN its top is the highest point of the roof in the image, which is over the far end
 * THEN the height is uncertain by the unobserved length. */
static void a_truck_viewed_end_on_hides_its_length(void) {
    start("truck");
    for (int n = 0; n < FLIGHTS; n++) {
        scene.width_m = 2.5;
        scene.length_m = check_random_between(&any, 6.0, 16.0);
        scene.height_m = check_random_between(&any, 2.5, 4.0);
        scene.x0_m = check_random_between(&any, -0.5, 0.5);
        scene.alpha_deg = 0.0;
        scene.z0_m = 160.0;
        fly(always, n % 2 == 0);
    }
    report();
    TEST_ASSERT_TRUE(faces > FLIGHTS);
    TEST_ASSERT_TRUE(worst < SIGMAS_MAX);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(a_missed_corner_makes_no_face_of_two);
    RUN_TEST(two_ends_are_no_sure_face);
    RUN_TEST(a_second_face_comes_late_in_a_turn);
    RUN_TEST(a_truck_viewed_end_on_hides_its_length);
    return UNITY_END();
}
