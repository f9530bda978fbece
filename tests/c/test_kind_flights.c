/* Flights whose detector states a class, or whose first guess of the range is wrong. SPDX-License-Identifier: MIT */
/* tests: lib/refined/goe_answer.c lib/refined/goe_kind.c */
#include <math.h>
#include <string.h>

#include "check.h"
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
#define RATE_HZ 8.0
#define AHEAD_S 3.0 /* a warning must come at least this long before the near side is reached */
#define RAD_PER_DEG 0.017453292519943295
#define BOX_MEMORY_S 1.2 /* of a detector's errors */
#define POINT_PX 0.5
#define IMAGE_PX 1280.0f

typedef struct {
    bool points, boxes;
    double box_share;
    double error[4]; /* of the box's sides, in its sigma */
} detector_t;

/* A chimney or a building 160 to 250 m ahead, in the way and higher than the aircraft. */
static detector_t any_flight(check_random_t *any) {
    scene_default(&scene);
    scene.shape = check_random_bits(any) % 2u == 0u ? SCENE_CYLINDER : SCENE_BOX;
    scene.width_m = exp(check_random_between(any, log(2.5), log(30.0)));
    scene.length_m = scene.width_m * check_random_between(any, 0.4, 2.5);
    scene.alpha_deg = check_random_between(any, -45.0, 45.0);
    scene.altitude_m = check_random_between(any, 15.0, 40.0);
    scene.height_m = scene.altitude_m + check_random_between(any, 0.0, 30.0);
    scene.x0_m = check_random_between(any, -0.3, 0.3) * scene.width_m;
    scene.z0_m = check_random_between(any, 160.0, 250.0);
    scene.speed_mps = check_random_between(any, 10.0, 20.0);
    scene.image_rate_hz = RATE_HZ;
    scene.roll_swing_deg = check_random_bits(any) % 2u == 0u ? 0.0 : check_random_between(any, 0.0, 10.0);
    scene.roll_swing_hz = check_random_between(any, 0.1, 0.25);
    const unsigned features = check_random_bits(any) % 3u;
    detector_t detector = {features != 1u, features != 0u, check_random_bits(any) % 2u == 0u ? 0.02 : 0.07, {0.0}};
    for (int i = 0; i < 4; i++) {
        detector.error[i] = check_random_normal(any);
    }
    return detector;
}

static void box_image(const detector_t *detector, int k, goe_image_t *image) {
    goe_image_t boxed;
    scene.boxes = true;
    scene_image(&scene, k, &boxed, NULL);
    scene.boxes = false;
    image->box = boxed.box;
    if (!detector->points) {
        scene_hide_points(image);
    }
}

static void spoil_box(detector_t *detector, check_random_t *any, goe_box_t *box) {
    float *const side[4] = {&box->left_px, &box->top_px, &box->right_px, &box->bottom_px};
    const double size[2] = {(double)(box->right_px - box->left_px), (double)(box->bottom_px - box->top_px)};
    const double kept = exp(-1.0 / RATE_HZ / BOX_MEMORY_S);
    for (int i = 0; i < 4; i++) {
        detector->error[i] = kept * detector->error[i] + sqrt(1.0 - kept * kept) * check_random_normal(any);
        *side[i] += (float)(detector->box_share * size[i % 2] * detector->error[i] + check_random_normal(any));
        *side[i] = fminf(fmaxf(*side[i], 0.0f), IMAGE_PX - 1.0f);
    }
}

/* Time ahead of the near side at the first warning, s; negative: none. cleared: whether "clear" came within 10 s. */
static double warned_s(detector_t detector, check_random_t any, bool *cleared) {
    const goe_intent_t intent = {{(float)scene.speed_mps, 0.0f, 0.0f}, 15.0f, 10.0f, 0.0f, 0.0f};
    const double turned = fabs(sin(scene.alpha_deg * RAD_PER_DEG));
    const double reach_m = 0.5 * scene.width_m * (scene.shape == SCENE_CYLINDER ? 1.0 : turned); /* nearer than z0_m */
    double first_s = -1.0;
    goe_estimator_t estimator;
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
    for (int k = 0; first_s < 0.0; k++) {
        goe_image_t image;
        goe_estimate_t estimate;
        const double left_s = (scene.z0_m - reach_m) / scene.speed_mps - k / RATE_HZ;
        if (left_s < 0.5) {
            break;
        }
        scene_image(&scene, k, &image, NULL);
        scene_add_noise(&image, &any, POINT_PX);
        if (detector.boxes) {
            box_image(&detector, k, &image);
            spoil_box(&detector, &any, &image.box);
        }
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
        const detector_t detector = any_flight(&any);
        settings = scene_settings(&scene);
        settings.navigation.terrain_height_sd_m = 1000.0f;
        settings.detector.box_noise_rel = (float)detector.box_share;
        memset(&kind, 0, sizeof kind);
        wrong(scene.width_m, exp(check_random_between(&any, log(0.01), log(10.0))));
        late += warned_s(detector, any, &clear) < AHEAD_S ? 1 : 0;
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

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(a_right_class_answers_sooner);
    RUN_TEST(a_wrong_class_loses_no_warning);
    RUN_TEST(a_class_alone_clears_nothing);
    RUN_TEST(a_wrong_prior_width_loses_no_warning);
    RUN_TEST(a_wrong_first_guess_loses_no_warning_in_any_flight);
    return UNITY_END();
}
