/* The phases of the filter: every transition by its name, and that there are no others. SPDX-License-Identifier: MIT
 *
 * The diagram is above goe_phase_t in refined/goe_filter.h. */
/* tests: lib/refined/goe_filter.c */
#include <math.h>
#include <string.h>

#include "check.h"
#include "refined/goe_filter.h"
#include "refined/goe_health.h"
#include "refined/goe_model.h"
#include "scene.h"

#define IMAGES 188
#define PHASES 4

/* Which features the detector gives. */
typedef enum { SEE_ALL, SEE_OUTLINE, SEE_OUTLINE_FIRST, SEE_LEAPS } sight_t;

static scene_t scene;
static goe_settings_t settings;
static goe_estimator_t estimator;
static goe_estimate_t estimate;
static check_random_t any;
static bool happened[PHASES][PHASES]; /* from, to: of two images one after the other */
static bool exchanged;

static const bool allowed[PHASES][PHASES] = {
    [GOE_PHASE_NONE] = {[GOE_PHASE_FOOTPRINT] = true},
    [GOE_PHASE_FOOTPRINT] = {[GOE_PHASE_NONE] = true, [GOE_PHASE_BOX_FACE] = true, [GOE_PHASE_BOX] = true},
    [GOE_PHASE_BOX_FACE] = {[GOE_PHASE_NONE] = true, [GOE_PHASE_BOX] = true},
    [GOE_PHASE_BOX] = {[GOE_PHASE_NONE] = true},
};

void setUp(void) {
    scene_default(&scene);
    scene.top_nearest = true;
    settings = scene_settings(&scene);
    scene_clear_noise(&settings);
    memset(happened, 0, sizeof happened);
    exchanged = false;
}
void tearDown(void) {}

static goe_phase_t phase(void) { return (goe_phase_t)estimator.filter.phase; }

static void start(void) {
    settings.camera = scene.camera;
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
}

static void update(const goe_image_t *image) {
    const goe_phase_t before = phase();
    const bool names = estimator.filter.naming.exchanged;
    (void)goe_update(&estimator, image, &estimate);
    if (before != phase()) {
        happened[before][phase()] = true;
    } else {
        exchanged = exchanged || (goe_filter_is_box(&estimator.filter) && names != estimator.filter.naming.exchanged);
    }
}

static void hide_base(goe_image_t *image) {
    image->base_left.visible = image->base_near.visible = image->base_right.visible = false;
}

/* A scene from image to image. SEE_LEAPS: from the middle on every third of the points lies elsewhere. */
static void fly(sight_t sight, int images) {
    start();
    for (int k = 0; k < images; k++) {
        goe_image_t image;
        scene_image(&scene, k, &image, NULL);
        if (sight == SEE_OUTLINE || (sight == SEE_OUTLINE_FIRST && k < images / 2)) {
            hide_base(&image);
        }
        if (sight == SEE_LEAPS && k >= images / 2) {
            image.left.u_px -= 150.0f;
            image.right.u_px -= 150.0f;
            image.base_right.u_px += 100.0f;
        }
        update(&image);
    }
}

/* A box of which the front and the right face are visible until the front turns away. */
static void make_box_next_to(double alpha_deg) {
    scene.width_m = 5.0;
    scene.length_m = 9.0;
    scene.height_m = 6.0;
    scene.alpha_deg = alpha_deg;
    scene.x0_m = -16.0;
    scene.speed_mps = 10.0;
    scene.image_rate_hz = 20.0;
    scene.wobble_deg = 1.0;
}

/* A wide front straight ahead, its sides hidden behind it until the path leads aside. */
static void make_wall_ahead(void) {
    scene.width_m = 12.0;
    scene.length_m = 8.0;
    scene.height_m = 5.0;
    scene.alpha_deg = 0.0;
    scene.x0_m = 0.0;
    scene.z0_m = 120.0;
    scene.speed_mps = 10.0;
    scene.path = SCENE_ARC;
    scene.arc_radius_m = 300.0;
}

/* ------------------------------------------------------------------------------------------------------- transitions -- */

/* GIVEN a filter that enters a phase THEN counters of the phase before count no more: neither known quantities, nor refused
 * points, nor votes for a box. */
static void a_phase_begins_with_nothing_counted(void) {
    start();
    goe_filter_t *filter = &estimator.filter;
    filter->phase_images = 9;
    filter->known = 0xFFu;
    filter->candidate.agreeing = 2;
    filter->health.poor = 2;
    filter->health.recent_nis = 5.0f;
    goe_filter_enter(filter, GOE_PHASE_BOX);
    TEST_ASSERT_EQUAL_INT(GOE_PHASE_BOX, phase());
    TEST_ASSERT_EQUAL_UINT8(0, filter->phase_images);
    TEST_ASSERT_EQUAL_UINT8(0, filter->known);
    TEST_ASSERT_EQUAL_UINT8(0, filter->candidate.agreeing);
    TEST_ASSERT_EQUAL_UINT8(0, filter->health.poor);
    CHECK_SAME(GOE_NIS_NONE, filter->health.recent_nis);
}

static void a_width_starts_a_footprint(void) {
    goe_image_t image;
    start();
    scene_image(&scene, 0, &image, NULL);
    image.right.visible = false;
    hide_base(&image);
    update(&image);
    TEST_ASSERT_EQUAL_INT(GOE_PHASE_NONE, phase());
    scene_image(&scene, 1, &image, NULL);
    update(&image);
    TEST_ASSERT_EQUAL_INT(GOE_PHASE_FOOTPRINT, phase());
}

/* ... that of base corners alone, too, whose range is that of the ground. */
static void base_corners_alone_start_a_footprint(void) {
    goe_image_t image;
    start();
    scene_image(&scene, 0, &image, NULL);
    image.left.visible = image.right.visible = image.top.visible = false;
    update(&image);
    TEST_ASSERT_EQUAL_INT(GOE_PHASE_FOOTPRINT, phase());
    CHECK_CLOSE(0.1 * scene.z0_m, scene.z0_m, 1.0 / (double)estimator.filter.state[GOE_INVERSE_RANGE]);
}

/* [GOE_MODEL_AUTO, (R17)] */
static void two_faces_make_a_box_of_a_footprint(void) {
    fly(SEE_ALL, 40);
    TEST_ASSERT_TRUE(happened[GOE_PHASE_FOOTPRINT][GOE_PHASE_BOX]);
    TEST_ASSERT_FALSE(happened[GOE_PHASE_FOOTPRINT][GOE_PHASE_BOX_FACE]);
}

/* [GOE_MODEL_AUTO] */
static void one_face_makes_a_box_whose_length_is_held(void) {
    make_wall_ahead();
    fly(SEE_ALL, 60);
    TEST_ASSERT_TRUE(happened[GOE_PHASE_FOOTPRINT][GOE_PHASE_BOX_FACE]);
    TEST_ASSERT_FALSE(estimate.valid & GOE_HAS_LENGTH && phase() == GOE_PHASE_BOX_FACE);
}

static void a_second_face_frees_the_length(void) {
    make_wall_ahead();
    fly(SEE_ALL, 90);
    TEST_ASSERT_TRUE(happened[GOE_PHASE_BOX_FACE][GOE_PHASE_BOX]);
    TEST_ASSERT_TRUE((estimate.valid & GOE_HAS_LENGTH) != 0);
}

/* GIVEN the outline of a box whose faces come and go THEN it stays a footprint, and has neither orientation nor length. */
static void an_outline_alone_stays_a_footprint(void) {
    make_box_next_to(44.0);
    fly(SEE_OUTLINE, IMAGES);
    TEST_ASSERT_EQUAL_INT(GOE_PHASE_FOOTPRINT, phase());
    TEST_ASSERT_TRUE((estimate.valid & GOE_HAS_POSITION) != 0);
    TEST_ASSERT_FALSE(estimate.valid & (GOE_HAS_ORIENTATION | GOE_HAS_LENGTH));
}

static void base_corners_that_appear_late_make_a_box(void) {
    make_box_next_to(44.0);
    fly(SEE_OUTLINE_FIRST, 160);
    TEST_ASSERT_TRUE(happened[GOE_PHASE_FOOTPRINT][GOE_PHASE_BOX]);
}

/* [A8, (R19)] */
static void a_side_that_lies_across_takes_the_name_of_the_front(void) {
    scene.width_m = 3.1;
    scene.length_m = 15.3;
    scene.height_m = 20.5;
    scene.alpha_deg = 23.3;
    scene.x0_m = -28.2;
    scene.z0_m = 120.0;
    scene.speed_mps = 12.9;
    scene.image_rate_hz = 16.7;
    fly(SEE_ALL, IMAGES);
    TEST_ASSERT_TRUE(happened[GOE_PHASE_FOOTPRINT][GOE_PHASE_BOX]);
    TEST_ASSERT_TRUE(exchanged);
}

/* [T1] */
static void misfitting_images_start_the_filter_again(void) {
    scene_make_cylinder(&scene);
    fly(SEE_LEAPS, 60);
    TEST_ASSERT_TRUE(happened[GOE_PHASE_FOOTPRINT][GOE_PHASE_NONE]);
    setUp();
    fly(SEE_LEAPS, 60);
    TEST_ASSERT_TRUE(happened[GOE_PHASE_BOX][GOE_PHASE_NONE]);
    setUp();
    make_wall_ahead();
    scene.path = SCENE_STRAIGHT;
    fly(SEE_LEAPS, 60);
    TEST_ASSERT_TRUE(happened[GOE_PHASE_BOX_FACE][GOE_PHASE_NONE]);
}

/* GIVEN a phase that has no model to change, or a number that is no phase THEN nothing of the filter changes. */
static void an_invalid_phase_changes_nothing(void) {
    static const uint8_t none[] = {GOE_PHASE_NONE, PHASES, UINT8_MAX};
    goe_observation_t sight;
    memset(&sight, 0, sizeof sight);
    sight.settings = &settings;
    for (size_t i = 0; i < sizeof none; i++) {
        goe_filter_t filter;
        goe_filter_t before;
        goe_filter_clear(&filter);
        filter.phase = none[i];
        before = filter;
        TEST_ASSERT_FALSE(goe_model_change(&filter, &sight));
        TEST_ASSERT_EQUAL_MEMORY(&before, &filter, sizeof filter);
    }
}

/* GIVEN a number that a flipped bit made no phase WHEN an image comes THEN the filter starts with it, as at a track's begin. */
static void an_invalid_phase_starts_the_filter_again(void) {
    for (int number = PHASES; number <= UINT8_MAX; number += 62) {
        goe_image_t image;
        fly(SEE_ALL, 20);
        estimator.filter.phase = (uint8_t)number;
        scene_image(&scene, 20, &image, NULL);
        (void)goe_update(&estimator, &image, &estimate);
        TEST_ASSERT_EQUAL_INT(GOE_PHASE_FOOTPRINT, phase());
        TEST_ASSERT_TRUE(image.pose.time_us == estimator.filter.axes.start_time_us);
    }
}

/* GIVEN a state or a root that no images lead to, one element of it at a time THEN the filter starts again, and nothing of it
 * reaches an answer. */
static void a_state_that_is_not_finite_starts_the_filter_again(void) {
    const goe_verdict_t good = {1u, 0u, 1};
    for (size_t i = 0; i <= 2 * GOE_STATES; i++) {
        fly(SEE_ALL, 20);
        goe_filter_t *filter = &estimator.filter;
        TEST_ASSERT_FALSE(goe_health_judge(filter, settings.model, good));
        if (i < GOE_STATES) {
            filter->state[i] = check_from_bits(i % 2 ? 0x7FC00000u : 0x7F800000u);
        } else if (i < 2 * GOE_STATES) {
            const size_t k = i - GOE_STATES;
            *goe_srif_at(&filter->root, k, k) = check_from_bits(i % 2 ? 0xFF800000u : 0x7FC00000u);
        } else {
            filter->state[GOE_FRONT_X] = 0.0f; /* no obstacle is as narrow */
        }
        TEST_ASSERT_TRUE(goe_health_judge(filter, settings.model, good));
    }
}

/* ---------------------------------------------------------------------------------------------------------- new starts -- */

/* A box by its corners, whose filter has just stopped; the next image. */
static goe_image_t stop(void) {
    goe_image_t image;
    make_box_next_to(55.0);
    fly(SEE_ALL, 60);
    TEST_ASSERT_EQUAL_INT(GOE_METHOD_FILTER, estimate.method);
    TEST_ASSERT_TRUE(estimate.fresh && estimate.nis_rows > 0);
    goe_filter_enter(&estimator.filter, GOE_PHASE_NONE);
    scene_image(&scene, 60, &image, NULL);
    return image;
}

/* GIVEN a filter that has stopped WHEN an image shows nothing THEN its last answer stays, as an old one: it follows the motion, and
 * reports no innovation, as the image gave none. */
static void a_stopped_filters_answer_stays_while_nothing_else_is_known(void) {
    goe_image_t image = stop();
    const goe_estimate_t before = estimate;
    hide_base(&image);
    image.left.visible = image.right.visible = image.top.visible = false;
    update(&image);
    TEST_ASSERT_EQUAL_INT(GOE_METHOD_FILTER, estimate.method);
    TEST_ASSERT_EQUAL_HEX32(before.valid, estimate.valid);
    TEST_ASSERT_FALSE(estimate.fresh);
    CHECK_SAME(before.z0_m, estimate.z0_m);
    CHECK_CLOSE(0.05, (double)before.z_m - scene.speed_mps / scene.image_rate_hz, estimate.z_m);
    TEST_ASSERT_EQUAL_INT(0, estimate.nis_rows);
    CHECK_SAME(0.0f, estimate.nis);
    TEST_ASSERT_EQUAL_INT(before.images_used, estimate.images_used);
}

/* GIVEN a filter that has stopped WHEN it cannot start from an image, as its first guess of the range is invalid THEN its last answer
 * stays. */
static void an_answer_stays_while_the_filter_cannot_start(void) {
    settings.filter.prior_width_m = 1000.0f;
    goe_image_t image = stop();
    const goe_estimate_t before = estimate;
    hide_base(&image);
    image.right.u_px = image.left.u_px + 0.2f; /* beyond all distances, by that width */
    update(&image);
    TEST_ASSERT_EQUAL_INT(GOE_PHASE_NONE, phase());
    TEST_ASSERT_EQUAL_INT(GOE_METHOD_FILTER, estimate.method);
    TEST_ASSERT_FALSE(estimate.fresh);
    TEST_ASSERT_EQUAL_HEX32(before.valid, estimate.valid);
    CHECK_SAME(before.width_m, estimate.width_m);
}

/* GIVEN a filter that has stopped WHEN it starts again THEN its older answer is kept. */
static void a_filter_that_starts_again_keeps_its_older_answer(void) {
    goe_image_t image = stop();
    update(&image);
    TEST_ASSERT_EQUAL_INT(GOE_PHASE_FOOTPRINT, phase());
    TEST_ASSERT_EQUAL_INT(GOE_METHOD_FILTER, estimate.method);
    TEST_ASSERT_TRUE(estimate.valid & GOE_HAS_POSITION);
}

/* --------------------------------------------------------------------------------------------------------- no others -- */

static void make_any_scene(void) {
    scene.shape = check_random_bits(&any) % 4u == 0u ? SCENE_CYLINDER : SCENE_BOX;
    scene.path = (scene_path_t)(check_random_bits(&any) % 3u);
    scene.width_m = check_random_between(&any, 2.0, 20.0);
    scene.length_m = check_random_between(&any, 2.0, 20.0);
    scene.height_m = check_random_between(&any, 2.0, 30.0);
    scene.alpha_deg = check_random_between(&any, -90.0, 90.0);
    scene.x0_m = check_random_between(&any, -30.0, 30.0);
    scene.z0_m = check_random_between(&any, 60.0, 150.0);
    scene.speed_mps = check_random_between(&any, 5.0, 20.0);
    scene.image_rate_hz = check_random_between(&any, 8.0, 20.0);
    scene.boxes = check_random_bits(&any) % 8u == 0u;
}

/* [goe_model.c] */
static void no_other_transition_happens(void) {
    any = check_random_start("phases");
    memset(happened, 0, sizeof happened);
    for (int run = 0; run < 150; run++) {
        scene_default(&scene);
        make_any_scene();
        settings = scene_settings(&scene);
        fly((sight_t)(check_random_bits(&any) % 4u), 120);
    }
    int transitions = 0;
    for (int from = 0; from < PHASES; from++) {
        for (int to = 0; to < PHASES; to++) {
            TEST_ASSERT_TRUE(allowed[from][to] || !happened[from][to]);
            transitions += happened[from][to] ? 1 : 0;
        }
    }
    check_report("kinds of transitions that happened", transitions);
    TEST_ASSERT_TRUE(transitions >= 6);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(a_phase_begins_with_nothing_counted);
    RUN_TEST(a_width_starts_a_footprint);
    RUN_TEST(base_corners_alone_start_a_footprint);
    RUN_TEST(two_faces_make_a_box_of_a_footprint);
    RUN_TEST(one_face_makes_a_box_whose_length_is_held);
    RUN_TEST(a_second_face_frees_the_length);
    RUN_TEST(an_outline_alone_stays_a_footprint);
    RUN_TEST(base_corners_that_appear_late_make_a_box);
    RUN_TEST(a_side_that_lies_across_takes_the_name_of_the_front);
    RUN_TEST(misfitting_images_start_the_filter_again);
    RUN_TEST(an_invalid_phase_changes_nothing);
    RUN_TEST(an_invalid_phase_starts_the_filter_again);
    RUN_TEST(a_state_that_is_not_finite_starts_the_filter_again);
    RUN_TEST(a_stopped_filters_answer_stays_while_nothing_else_is_known);
    RUN_TEST(an_answer_stays_while_the_filter_cannot_start);
    RUN_TEST(a_filter_that_starts_again_keeps_its_older_answer);
    RUN_TEST(no_other_transition_happens);
    return UNITY_END();
}
