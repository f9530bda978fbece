/* Flights whose detector states a class, or whose first guess of the range is wrong. SPDX-License-Identifier: MIT */
/* tests: lib/refined/goe_answer.c lib/refined/goe_kind.c */
#include <math.h>
#include <string.h>

#include "check.h"
#include "drawn.h"
#include "goe.h"
#include "scene.h"

#define IMAGES 40
#define DIAMETER_M 6.0f
#define HEIGHT_M 30.0f
#define WARNED_IMAGES 12 /* until the warning, from whatever first guess */
#define JUDGED_IMAGES 20 /* until a class proves wrong, or a passage clear */

typedef struct {
    int first;         /* image of the first position; IMAGES: none */
    int clear, act;    /* ... of the first such decision */
    int wrong;         /* ... that first reports the class as wrong */
    double off_sigmas; /* largest error of z_m, while no image reports the class as wrong */
    goe_model_t model; /* of the latest position */
} flown_t;

static scene_t scene;
static goe_settings_t settings;
static goe_kind_t kind;

static const float TIMES[] = {0.01f, 0.02f, 0.05f, 0.1f, 0.2f, 0.3f, 0.5f, 0.7f, 2.0f, 3.0f, 5.0f, 10.0f};
#define ALL_TIMES (sizeof TIMES / sizeof TIMES[0])

/* A chimney in the way, over a ground of unknown height. */
void setUp(void) {
    scene_default(&scene);
    scene_make_cylinder(&scene);
    scene.x0_m = 0.0;
    settings = scene_settings(&scene);
    settings.navigation.terrain_height_sd_m = 1000.0f;
    memset(&kind, 0, sizeof kind);
}
void tearDown(void) {}

static int earlier(bool now, int k, int before) { return now && k < before ? k : before; }

static void note(flown_t *flown, int k, const goe_estimate_t *estimate, goe_decision_t decision, double z_m) {
    const bool placed = (estimate->valid & GOE_HAS_POSITION) != 0u;
    flown->wrong = earlier(estimate->reason == GOE_REASON_SHAPE, k, flown->wrong);
    flown->first = earlier(placed, k, flown->first);
    flown->clear = earlier(decision == GOE_DECISION_CLEAR, k, flown->clear);
    flown->act = earlier(decision == GOE_DECISION_ACT, k, flown->act);
    if (placed) {
        flown->model = estimate->model;
        if (flown->wrong == IMAGES) {
            flown->off_sigmas =
                fmax(flown->off_sigmas, fabs((double)estimate->z_m - z_m) / (double)estimate->sigma.z_m);
        }
    }
}

static flown_t fly(void) {
    flown_t flown = {IMAGES, IMAGES, IMAGES, IMAGES, 0.0, GOE_MODEL_NONE};
    const goe_intent_t intent = {{(float)scene.speed_mps, 0.0f, 0.0f}, 15.0f, 10.0f, 0.0f, 0.0f};
    goe_estimator_t estimator;
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
    for (int k = 0; k < IMAGES; k++) {
        goe_image_t image;
        goe_estimate_t estimate;
        scene_truth_t truth;
        scene_image(&scene, k, &image, &truth);
        image.kind = kind;
        (void)goe_update(&estimator, &image, &estimate);
        note(&flown, k, &estimate, goe_decide(&estimator, &intent, NULL, NULL), truth.z_m);
    }
    check_report("image of the first position", flown.first);
    check_report("image of the first \"act\"", flown.act);
    check_report("image that finds the class wrong", flown.wrong);
    return flown;
}

static void state(float width_m, float height_m, uint8_t shape) {
    kind.width_m = width_m;
    kind.width_sd_m = 0.1f * width_m;
    kind.height_m = height_m;
    kind.height_sd_m = 0.1f * height_m;
    kind.shape = shape;
}

/* [goe_kind_t.width_m, goe_kind.c] GIVEN a class whose width is right THEN the position comes sooner than without, within 3 sigma, and the class is never
 * reported as wrong. The model is the shape that the class states. */
static void a_right_class_answers_sooner(void) {
    const flown_t without = fly();
    state(DIAMETER_M, 0.0f, GOE_KIND_ROUND);
    const flown_t with = fly();
    TEST_ASSERT_TRUE(with.first < without.first && with.act <= with.first);
    TEST_ASSERT_EQUAL_INT(IMAGES, with.wrong);
    TEST_ASSERT_TRUE(with.off_sigmas < 3.0);
    TEST_ASSERT_EQUAL_INT(GOE_MODEL_DISC, with.model);
    settings.model = GOE_MODEL_DISC;
    state(DIAMETER_M, 0.0f, GOE_KIND_OTHER);
    TEST_ASSERT_EQUAL_INT(GOE_MODEL_PRISM, fly().model);
}

/* [goe_kind_t.width_m, goe_kind.c] GIVEN a width that is wrong by a factor of 0.01 to 10 WHEN the obstacle is in the way THEN the warning still comes, and no
 * "clear"; WHEN it is off the way THEN the "clear" comes. A width that is wrong by more than a factor of 1.5 is reported. */
static void a_wrong_class_loses_no_warning(void) {
    for (size_t i = 0; i < ALL_TIMES; i++) {
        const bool right = fabs(log((double)TIMES[i])) < log(1.5);
        state(TIMES[i] * DIAMETER_M, 0.0f, GOE_KIND_UNKNOWN);
        check_report("stated width over the true one", (double)TIMES[i]);
        scene.x0_m = 0.0;
        const flown_t flown = fly();
        TEST_ASSERT_TRUE(flown.act < WARNED_IMAGES);
        TEST_ASSERT_EQUAL_INT(IMAGES, flown.clear);
        TEST_ASSERT_TRUE(flown.wrong < JUDGED_IMAGES || right);
        scene.x0_m = -60.0;
        const flown_t clear = fly();
        TEST_ASSERT_TRUE(clear.clear < JUDGED_IMAGES);
        TEST_ASSERT_TRUE(clear.wrong < JUDGED_IMAGES || right);
    }
}

/* [GOE_DECISION_UNKNOWN] GIVEN an obstacle off the way WHEN its class alone gives the range THEN the decision is not "clear"; WHEN the
 * images give it, too, THEN it is, as without a class. */
static void a_class_alone_clears_nothing(void) {
    scene.x0_m = -60.0;
    const flown_t without = fly();
    state(DIAMETER_M, 0.0f, GOE_KIND_UNKNOWN);
    const flown_t with = fly();
    TEST_ASSERT_TRUE(with.first < without.first);
    TEST_ASSERT_EQUAL_INT(without.clear, with.clear);
}

/* [filter.prior_width_m, goe_kind.c] GIVEN an obstacle 60 times as wide as assumed, or a tenth WHEN it is in the way THEN the warning
 * comes: where the aircraft passes a first guess and still sees the obstacle ahead, the next guess is farther. */
static void a_wrong_prior_width_loses_no_warning(void) {
    for (size_t i = 0; i < ALL_TIMES; i++) {
        settings.filter.prior_width_m = fmaxf(TIMES[i] * DIAMETER_M, 0.1f);
        check_report("assumed width over the true one", (double)TIMES[i]);
        TEST_ASSERT_TRUE(fly().act < WARNED_IMAGES);
    }
}

/* ---------------------------------------------------------------------------------------------------------- any flight -- */

#define FLIGHTS 1000
/* Time ahead of the near side at the first warning, s; negative: none. cleared: whether "clear" came within 10 s. */
static double warned_s(drawn_t drawn, check_random_t any, bool *cleared) {
    const goe_intent_t intent = {{(float)scene.speed_mps, 0.0f, 0.0f}, 15.0f, 10.0f, 0.0f, 0.0f};
    double first_s = -1.0;
    goe_estimator_t estimator;
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
    for (int k = 0; first_s < 0.0; k++) {
        goe_image_t image;
        goe_estimate_t estimate;
        const double left_s = drawn_left_s(&scene, k);
        if (left_s < 0.5) {
            break;
        }
        drawn_image(&drawn, &scene, &any, k, &image);
        image.kind = kind;
        (void)goe_update(&estimator, &image, &estimate);
        const goe_decision_t decision = goe_decide(&estimator, &intent, NULL, NULL);
        *cleared = *cleared || (decision == GOE_DECISION_CLEAR && left_s < 10.0);
        first_s = decision == GOE_DECISION_ACT ? left_s : first_s;
    }
    return first_s;
}

/* Flights without a warning in time, of which `cleared` had a "clear". wrong: sets the first guess from the true width and a factor. */
static int unwarned(const char *what, void (*wrong)(double width_m, double factor), int *cleared) {
    check_random_t any = check_random_start(what);
    int late = 0;
    for (int n = 0; n < FLIGHTS; n++) {
        bool clear = false;
        const drawn_t drawn = drawn_flight(&scene, &any);
        settings = scene_settings(&scene);
        settings.navigation.terrain_height_sd_m = 1000.0f;
        settings.detector.box_noise_rel = (float)drawn.box_share;
        memset(&kind, 0, sizeof kind);
        wrong(scene.width_m, exp(check_random_between(&any, log(0.01), log(10.0))));
        late += warned_s(drawn, any, &clear) < DRAWN_AHEAD_S ? 1 : 0;
        *cleared += clear ? 1 : 0;
    }
    check_report("flights without a warning in time", late);
    return late;
}

static void assume(double width_m, double factor) {
    settings.filter.prior_width_m = fmaxf((float)(factor * width_m), 0.1f);
}

static void claim(double width_m, double factor) { state((float)(factor * width_m), 0.0f, GOE_KIND_UNKNOWN); }

/* [filter.prior_width_m, goe_kind_t.width_m] GIVEN any obstacle ahead, by points, boxes or both, of real detectors' noise, and a first guess by a
 * width or a class that is wrong by a factor of 0.01 to 10 THEN the warning comes in time, and no "clear". */
static void a_wrong_first_guess_loses_no_warning_in_any_flight(void) {
    int cleared = 0;
    TEST_ASSERT_EQUAL_INT(0, unwarned("wrong prior widths", assume, &cleared));
    TEST_ASSERT_EQUAL_INT(0, unwarned("wrong classes", claim, &cleared));
    TEST_ASSERT_EQUAL_INT(0, cleared);
}

/* ------------------------------------------------------------------------------------------------------------- border -- */

#define BORDER_FLIGHTS 300

/* Seconds ahead of the near side at the first warning of an obstacle that reaches beyond the image's left border in every image. hidden: the
 * detector says so and the camera's width is not configured; otherwise both are left to the library. */
static double warned_at_border_s(drawn_t drawn, check_random_t any, bool hidden) {
    const goe_intent_t intent = {{(float)scene.speed_mps, 0.0f, 0.0f}, 15.0f, 10.0f, 0.0f, 0.0f};
    double first_s = -1.0;
    goe_estimator_t estimator;
    settings = scene_settings(&scene);
    settings.camera.width_px = settings.camera.height_px = hidden ? 0.0f : 1280.0f;
    settings.camera.border_rel = 0.012f; /* the library's default */
    settings.detector.box_noise_rel = (float)drawn.box_share;
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
    for (int k = 0; first_s < 0.0 && drawn_left_s(&scene, k) > 0.5; k++) {
        goe_image_t image;
        goe_estimate_t estimate;
        drawn_image(&drawn, &scene, &any, k, &image);
        scene_hide_points(&image);
        if (image.box.right_px - image.box.left_px < 2.0f) {
            continue; /* nothing of it is in the image */
        }
        image.box.left_px = hidden ? NAN : 0.0f;
        image.box.sides = hidden ? GOE_SIDES_ALL & ~GOE_SIDE_LEFT : GOE_SIDES_ALL;
        (void)goe_update(&estimator, &image, &estimate);
        first_s = goe_decide(&estimator, &intent, NULL, NULL) == GOE_DECISION_ACT ? drawn_left_s(&scene, k) : first_s;
    }
    return first_s;
}

/* [goe_box_t.sides] GIVEN any obstacle ahead whose left end is never in the image THEN the visible side and the ground give a range, and the
 * warning comes in time. */
static void a_box_cut_by_the_border_is_warned_of(void) {
    check_random_t any = check_random_start("border");
    int late[2] = {0, 0};
    for (int n = 0; n < BORDER_FLIGHTS; n++) {
        drawn_t drawn = drawn_flight(&scene, &any);
        drawn.boxes = true;
        scene.camera.mount_yaw_deg = 34.0f; /* straight ahead is one degree inside the left border */
        scene.roll_swing_deg = 0.0;
        late[n % 2] += warned_at_border_s(drawn, any, n % 2 == 1) < DRAWN_AHEAD_S ? 1 : 0;
    }
    check_report("flights without a warning in time, of 150, border known", late[0]);
    check_report("... side hidden", late[1]);
    TEST_ASSERT_EQUAL_INT(0, late[0]);
    TEST_ASSERT_EQUAL_INT(0, late[1]);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(a_right_class_answers_sooner);
    RUN_TEST(a_wrong_class_loses_no_warning);
    RUN_TEST(a_class_alone_clears_nothing);
    RUN_TEST(a_wrong_prior_width_loses_no_warning);
    RUN_TEST(a_wrong_first_guess_loses_no_warning_in_any_flight);
    RUN_TEST(a_box_cut_by_the_border_is_warned_of);
    return UNITY_END();
}
