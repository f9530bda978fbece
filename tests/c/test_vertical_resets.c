/* Known jumps of the autopilot's down. A flight with jumps must give what the same flight gives without them.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "check.h"
#include "scene.h"

#define IMAGES 64
#define MOVED_MAX 0.05 /* sigmas: 16,000 flights came to 0.02 */
#define FLIGHTS 400
#define JUMPS_MAX 3

typedef enum { OUTLINE, CORNERS, BOXES, BOXES_AND_CORNERS, KINDS } kind_t;
typedef enum { RANGE_FINDER, SAME_FILTER, SOURCES } source_t;

typedef struct {
    int image; /* the first one after the jump */
    float ned_m[3];
} jump_t;

/* A flight without jumps, and what the jumps make of it. */
typedef struct {
    scene_t scene;
    goe_settings_t settings;
    kind_t kind;
    source_t source;
    jump_t jump[JUMPS_MAX];
    int jumps;
    double height_sd_m;            /* noise of the height */
    int blind_from, blind_until;   /* images without a detection ... */
    bool looks_back;               /* ... as the aircraft flies backwards in them */
    int refused;                   /* of the flight with jumps, once before it is taken; -1: none */
    int broken_from, broken_until; /* images of something else: the filter starts again */
    int late;                      /* by so many tenths of the time between two images the poses are late */
} flight_t;

static flight_t flight;
static check_random_t any;
static goe_estimator_t plain, jumped;
static goe_estimate_t of_plain, of_jumped;
static double moved; /* the largest difference so far, sigmas */
static int stops[2]; /* of the plain flight's filter, which then starts again: before the first jump, and from it on */

static void set_up_flight(kind_t kind, source_t source) {
    memset(&flight, 0, sizeof flight);
    scene_default(&flight.scene);
    flight.scene.width_m = 10.0;
    flight.scene.length_m = 15.0;
    flight.scene.height_m = 8.0;
    flight.scene.x0_m = 15.0;
    flight.scene.z0_m = 190.0;
    flight.scene.altitude_m = 30.0;
    flight.scene.speed_mps = 18.0;
    flight.scene.glide_deg = 2.0;
    flight.settings = scene_settings(&flight.scene);
    flight.kind = kind;
    flight.source = source;
    flight.refused = -1;
}

void setUp(void) {
    set_up_flight(CORNERS, SAME_FILTER);
    moved = 0.0;
}
void tearDown(void) {}

static void add_jump(int from, float north_m, float east_m, float down_m) {
    flight.jump[flight.jumps++] = (jump_t){from, {north_m, east_m, down_m}};
}

/* ------------------------------------------------------------------------------------------------------------ images -- */

/* By half a turn about the vertical. */
static void turn_back(float q[4]) {
    const float before[4] = {q[0], q[1], q[2], q[3]};
    q[0] = -before[3];
    q[1] = -before[2];
    q[2] = before[1];
    q[3] = before[0];
}

/* The pose of a moment before, at the time of the image. */
static void take_late_pose(int k, goe_pose_t *pose) {
    scene_t often = flight.scene;
    goe_image_t before;
    const int64_t time_us = pose->time_us;
    often.image_rate_hz *= 10.0;
    scene_image(&often, 10 * k - flight.late, &before, NULL);
    *pose = before.pose;
    pose->time_us = time_us;
}

/* Both flights see the same. */
static void see(int k, goe_image_t *image) {
    scene_t boxed = flight.scene;
    goe_image_t box;
    boxed.boxes = true;
    scene_image(&flight.scene, k, image, NULL);
    scene_image(&boxed, k, &box, NULL);
    scene_add_noise(image, &any, 0.3);
    if (flight.late > 0 && k > 0) {
        take_late_pose(k, &image->pose);
    }
    if (flight.kind == OUTLINE) {
        image->base_left.visible = image->base_near.visible = image->base_right.visible = false;
    }
    if (flight.kind == BOXES) {
        scene_hide_points(image);
    }
    if (flight.kind == BOXES || flight.kind == BOXES_AND_CORNERS) {
        image->box = box.box;
    }
    if (k >= flight.blind_from && k < flight.blind_until) {
        scene_hide_points(image);
        image->box.sides = 0u;
        if (flight.looks_back) {
            turn_back(image->pose.attitude);
        }
    }
    if (k >= flight.broken_from && k < flight.broken_until) {
        image->left.u_px -= 150.0f + 20.0f * (float)(k % 3);
        image->right.u_px += 150.0f;
        image->base_left.u_px -= 90.0f;
        image->base_right.v_px += 60.0f;
        image->box.left_px -= 200.0f;
        image->box.bottom_px += 80.0f;
    }
    image->pose.height_m += (float)(flight.height_sd_m * check_random_normal(&any));
}

/* The pose after all jumps up to this image; each jump comes with its size. */
static void jump(int k, goe_pose_t *pose) {
    for (int j = 0; j < flight.jumps; j++) {
        const jump_t *one = &flight.jump[j];
        for (int i = 0; i < 3 && k >= one->image; i++) {
            pose->position_ned_m[i] += one->ned_m[i];
            pose->reset_delta_ned_m[i] += k == one->image ? one->ned_m[i] : 0.0f;
        }
        pose->reset_count = (uint8_t)(pose->reset_count + (k >= one->image ? 1 : 0));
        pose->reset_delta_known = pose->reset_delta_known || k == one->image;
        if (k >= one->image && flight.source == SAME_FILTER) {
            pose->height_m -= one->ned_m[2];
        }
    }
}

/* ----------------------------------------------------------------------------------------------------------- compare -- */

static void compare(float sigma, float expected, float actual, bool known) {
    if (known) {
        check_worst(&moved, ((double)actual - (double)expected) / ((double)sigma + 1.0e-9));
    }
}

static float jumped_by(int k, int axis) {
    float sum_m = 0.0f;
    for (int j = 0; j < flight.jumps; j++) {
        sum_m += k >= flight.jump[j].image ? flight.jump[j].ned_m[axis] : 0.0f;
    }
    return sum_m;
}

static void compare_estimates(int k) {
    const goe_estimate_t *a = &of_plain;
    const goe_estimate_t *b = &of_jumped;
    const goe_sigma_t *s = &a->sigma;
    const unsigned valid = a->valid & b->valid;
    compare(s->x_m, a->x_m, b->x_m, (valid & GOE_HAS_POSITION) != 0u);
    compare(s->z_m, a->z_m, b->z_m, (valid & GOE_HAS_POSITION) != 0u);
    compare(s->width_m, a->width_m, b->width_m, (valid & GOE_HAS_WIDTH) != 0u);
    compare(s->length_m, a->length_m, b->length_m, (valid & GOE_HAS_LENGTH) != 0u);
    compare(s->height_m, a->height_m, b->height_m, (valid & GOE_HAS_HEIGHT) != 0u);
    compare(s->orientation_deg, a->orientation_deg, b->orientation_deg, (valid & GOE_HAS_ORIENTATION) != 0u);
    compare(s->center_north_m, a->center_north_m + jumped_by(k, 0), b->center_north_m, (valid & GOE_HAS_CENTER) != 0u);
    compare(s->center_east_m, a->center_east_m + jumped_by(k, 1), b->center_east_m, (valid & GOE_HAS_CENTER) != 0u);
    TEST_ASSERT_EQUAL_HEX32(a->valid, b->valid);
    TEST_ASSERT_EQUAL_INT(a->model, b->model);
    TEST_ASSERT_EQUAL_INT(a->suspect, b->suspect);
    TEST_ASSERT_EQUAL_STRING(goe_reason_text(a->reason), goe_reason_text(b->reason));
}

/* The camera flies on as it does, and somewhat towards the obstacle. */
static void compare_hazards(void) {
    const goe_intent_t intent = {{(float)flight.scene.speed_mps, 1.5f, 0.5f}, 10.0f, 5.0f, 0.2f, 0.0f};
    goe_hazard_t a;
    goe_hazard_t b;
    const goe_status_t status = goe_hazard(&plain, &intent, &a);
    CHECK_STATUS(status, goe_hazard(&jumped, &intent, &b));
    TEST_ASSERT_EQUAL_INT(a.has_clearance, b.has_clearance);
    compare(a.clearance_sd_m, a.clearance_m, b.clearance_m, a.has_clearance);
    TEST_ASSERT_FLOAT_WITHIN(0.02f, a.conflict_probability, b.conflict_probability);
}

/* An image that is refused changes nothing: the delta is given with the next one, too. */
static void give_refused(const goe_image_t *image) {
    goe_image_t bad = *image;
    goe_estimate_t estimate;
    bad.pose.attitude[0] = bad.pose.attitude[1] = bad.pose.attitude[2] = bad.pose.attitude[3] = 0.0f;
    const float height_m = jumped.motion.height_m;
    CHECK_STATUS(GOE_BAD_ATTITUDE, goe_update(&jumped, &bad, &estimate));
    CHECK_SAME(height_m, jumped.motion.height_m);
}

/* Flies both, and returns by how many sigmas any quantity of any image moved. */
static double fly(void) {
    CHECK_STATUS(GOE_OK, goe_init(&plain, sizeof plain, &flight.settings, NULL));
    CHECK_STATUS(GOE_OK, goe_init(&jumped, sizeof jumped, &flight.settings, NULL));
    memset(stops, 0, sizeof stops);
    moved = 0.0;
    for (int k = 0; k < IMAGES; k++) {
        goe_image_t image;
        see(k, &image);
        const bool ran = plain.filter.phase != 0;
        const goe_status_t status = goe_update(&plain, &image, &of_plain);
        if (ran && plain.filter.phase == 0) {
            stops[flight.jumps > 0 && k >= flight.jump[0].image]++;
        }
        jump(k, &image.pose);
        if (k == flight.refused) {
            give_refused(&image);
        }
        CHECK_STATUS(status, goe_update(&jumped, &image, &of_jumped));
        compare_estimates(k);
        compare_hazards();
    }
    return moved;
}

/* ---------------------------------------------------------------------------------------------------------- the tests -- */

/* [A28, goe_pose_t.reset_delta_ned_m]
 * GIVEN points, boxes or both, heights with and without a white error WHEN down jumps by a known amount, height_m with it or
 * not THEN no quantity moves by a twentieth of a sigma, and the obstacle neither moves nor becomes suspect. */
static void a_known_jump_of_down_is_no_motion(void) {
    static const float jumps[][3] = {
        {0.0f, 0.0f, 2.0f}, {0.0f, 0.0f, -2.0f}, {3.0f, -2.0f, 5.0f}, {0.0f, 1.0f, -25.0f}};
    double worst = 0.0;
    int heights = 0; /* known in the end */
    for (int run = 0; run < (int)KINDS * (int)SOURCES * 2 * 4; run++) {
        set_up_flight((kind_t)(run % KINDS), (source_t)(run / KINDS % SOURCES));
        any = check_random_start("one jump");
        flight.settings.navigation.height_white_sd_m = run / ((int)KINDS * (int)SOURCES) % 2 ? 1.0f : 0.0f;
        const float *ned_m = jumps[run / ((int)KINDS * (int)SOURCES * 2)];
        add_jump(30, ned_m[0], ned_m[1], ned_m[2]);
        check_worst(&worst, fly());
        TEST_ASSERT_FALSE(of_jumped.suspect);
        TEST_ASSERT_FALSE(of_jumped.valid & GOE_HAS_VELOCITY);
        heights += (of_jumped.valid & GOE_HAS_HEIGHT) != 0u ? 1 : 0;
    }
    TEST_ASSERT_TRUE(heights > (int)KINDS * (int)SOURCES * 4);
    check_report("moved by, sigmas", worst);
    TEST_ASSERT_TRUE(worst < MOVED_MAX);
}

/* [A28, goe_pose_t.height_m, goe_pose_t.reset_delta_ned_m]
 * The camera's height goes on over the ground that was known before, whichever height it is. */
static void the_height_goes_on(void) {
    for (int source = 0; source < SOURCES; source++) {
        set_up_flight(CORNERS, (source_t)source);
        any = check_random_start("height");
        add_jump(20, 0.0f, 0.0f, 4.0f);
        add_jump(40, 0.0f, 0.0f, -1.5f);
        (void)fly();
        CHECK_CLOSE(1.0e-4, plain.motion.height_m, jumped.motion.height_m);
    }
}

/* A flight with jumps in images of any kind. */
static void check_source_by_source(void) {
    const flight_t wanted = flight;
    for (int run = 0; run < (int)KINDS * (int)SOURCES; run++) {
        flight = wanted;
        flight.kind = (kind_t)(run % KINDS);
        flight.source = (source_t)(run / KINDS);
        any = check_random_start("flight");
        TEST_ASSERT_TRUE(fly() < MOVED_MAX);
    }
}

/* [A28] */
static void jumps_add_up(void) {
    add_jump(20, 1.0f, 0.5f, 3.0f);
    add_jump(35, -2.0f, 0.0f, 4.5f);
    add_jump(36, 0.0f, 0.0f, -1.25f);
    check_source_by_source();
}

/* [A28] */
static void jumps_between_two_images_are_one_sum(void) {
    add_jump(30, 1.0f, 0.5f, 6.0f);
    add_jump(30, 0.0f, 0.0f, -2.0f);
    add_jump(30, -3.0f, 0.0f, 1.5f);
    check_source_by_source();
}

/* [A28] */
static void a_jump_without_a_detection_counts(void) {
    flight.blind_from = 28;
    flight.blind_until = 33;
    add_jump(30, 2.0f, 0.0f, -4.0f);
    check_source_by_source();
}

/* [GOE_IMAGE_TAKEN] */
static void a_refused_image_leaves_the_jump_to_the_next_one(void) {
    flight.refused = 30;
    add_jump(30, 2.0f, 0.0f, -4.0f);
    check_source_by_source();
}

/* [A28] GIVEN images without a detection WHEN down jumps in them, and in the first one with a detection THEN the track is
 * that of a flight without jumps. */
static void a_jump_in_the_first_image_with_a_feature_counts(void) {
    flight.blind_until = 10;
    add_jump(5, 0.0f, 1.0f, 2.5f);
    add_jump(10, 2.0f, 0.0f, -4.0f);
    check_source_by_source();
}

/* [A28] GIVEN an aircraft that looks back until the first detection, where the track begins THEN a jump in that image counts,
 * too. */
static void a_jump_counts_where_the_track_begins_at_first_sight(void) {
    flight.settings.navigation.height_white_sd_m = 1.0f;
    flight.blind_until = 16;
    flight.looks_back = true;
    add_jump(8, 0.0f, 0.0f, 2.5f);
    add_jump(16, 2.0f, 0.0f, -4.0f);
    check_source_by_source();
    TEST_ASSERT_TRUE(plain.motion.start_time_us == 1000000 + 16 * 125000); /* the track began with image 16 */
    TEST_ASSERT_TRUE(of_jumped.valid & GOE_HAS_POSITION);
}

/* [A28] GIVEN a filter that starts again WHEN down jumps in that image, or in the next one THEN nothing moves. */
static void a_jump_at_a_new_start_of_the_filter_counts(void) {
    int seen = 0;
    for (int source = 0; source < SOURCES; source++) {
        for (int from = 24; from < 40; from++) {
            set_up_flight(CORNERS, (source_t)source);
            flight.broken_from = 24;
            flight.broken_until = 32;
            any = check_random_start("new start");
            add_jump(from, 0.0f, 0.0f, 4.0f);
            TEST_ASSERT_TRUE(fly() < MOVED_MAX);
            seen += stops[0] + stops[1];
        }
    }
    TEST_ASSERT_TRUE(seen > 0);
}

/* [A28] GIVEN poses that are late WHEN the filter jumps THEN the latency is corrected in that image as in any other. */
static void a_jump_does_not_disturb_late_poses(void) {
    for (int source = 0; source < SOURCES; source++) {
        set_up_flight(CORNERS, (source_t)source);
        flight.scene.path = SCENE_WEAVE;
        flight.scene.wobble_deg = 4.0;
        flight.late = 8;
        any = check_random_start("late");
        add_jump(44, 12.0f, -5.0f, 3.0f);
        add_jump(50, 0.0f, 0.0f, 4.0f);
        const double worst = fly();
        check_report("moved by, sigmas", worst);
        TEST_ASSERT_TRUE(worst < MOVED_MAX);
        TEST_ASSERT_TRUE(plain.filter.mover.late);
    }
}

/* [A28] The window takes each image's height as it is. */
static void a_jump_moves_no_height_of_the_window(void) {
    flight.settings.method = GOE_METHOD_WINDOW;
    for (int source = 0; source < SOURCES; source++) {
        flight.source = (source_t)source;
        flight.jumps = 0;
        add_jump(30, 0.0f, 0.0f, 3.0f);
        add_jump(45, 0.0f, 0.0f, 35.0f); /* height_m itself is negative then */
        any = check_random_start("window");
        (void)fly();
        TEST_ASSERT_TRUE(of_jumped.valid & GOE_HAS_HEIGHT);
        CHECK_CLOSE(1.0e-3, of_plain.height_m, of_jumped.height_m);
    }
}

/* [A28] GIVEN jumps that height_m followed WHEN the track ends THEN the next one takes height_m as it is. */
static void a_new_track_takes_the_height_as_it_is(void) {
    for (int unknown = 0; unknown < 2; unknown++) {
        goe_image_t image;
        add_jump(30, 0.0f, 0.0f, 3.0f);
        any = check_random_start("new track");
        (void)fly();
        see(IMAGES, &image);
        jump(IMAGES, &image.pose);
        TEST_ASSERT_TRUE(fabsf(image.pose.height_m - jumped.motion.height_m) > 2.0f);
        if (unknown == 0) {
            CHECK_STATUS(GOE_OK, goe_reset(&jumped));
        } else {
            image.pose.reset_count++;
            image.pose.reset_delta_known = false;
        }
        (void)goe_update(&jumped, &image, &of_jumped);
        CHECK_SAME(image.pose.height_m, jumped.motion.height_m);
        flight.jumps = 0;
    }
}

/* [A28] GIVEN a height whose noise is well below the jump THEN the jump is taken off in every image; GIVEN one whose noise is not THEN the
 * height is off by the jump at most. */
static void the_nearer_of_both_is_taken(void) {
    for (int run = 0; run < 2 * SOURCES; run++) {
        set_up_flight(CORNERS, (source_t)(run % SOURCES));
        any = check_random_start("noisy height");
        flight.height_sd_m = run < SOURCES ? 0.2 : 2.0;
        flight.settings.navigation.height_white_sd_m = (float)flight.height_sd_m;
        add_jump(30, 0.0f, 0.0f, 2.0f);
        CHECK_STATUS(GOE_OK, goe_init(&jumped, sizeof jumped, &flight.settings, NULL));
        for (int k = 0; k < IMAGES; k++) {
            goe_image_t image;
            see(k, &image);
            const float height_m = image.pose.height_m;
            jump(k, &image.pose);
            (void)goe_update(&jumped, &image, &of_jumped);
            CHECK_CLOSE(run < SOURCES ? 1.0e-4 : 2.0001, height_m, jumped.motion.height_m);
        }
    }
}

/* ------------------------------------------------------------------------------------------------------------- random -- */

static double between(double low, double high) { return check_random_between(&any, low, high); }

static void take_any_scene(void) {
    scene_t *scene = &flight.scene;
    scene->width_m = between(3.0, 20.0);
    scene->length_m = between(3.0, 20.0);
    scene->height_m = between(2.0, 30.0);
    scene->alpha_deg = between(-80.0, 80.0);
    scene->x0_m = between(-40.0, 40.0);
    scene->z0_m = between(120.0, 250.0);
    scene->speed_mps = between(8.0, 0.8 * scene->z0_m / 8.0);
    scene->altitude_m = between(10.0, 60.0);
    scene->glide_deg = between(-2.0, 3.0);
    scene->course_deg = between(0.0, 360.0);
    scene->path = (scene_path_t)(check_random_bits(&any) % 3u);
    scene->roll_deg = between(-10.0, 10.0);
    scene->wobble_deg = between(0.0, 4.0);
    for (int i = 0; i < 3; i++) {
        scene->camera.offset_m[i] = (float)between(-2.0, 2.0);
    }
    if (check_random_bits(&any) % 4u == 0u) {
        scene_make_cylinder(scene);
    }
}

static void take_any_jumps(void) {
    const int jumps = 1 + (int)(check_random_bits(&any) % JUMPS_MAX);
    for (int j = 0; j < jumps; j++) {
        const float level = check_random_bits(&any) % 2u ? 1.0f : 0.0f;
        const double down_m = exp(between(log(0.3), log(30.0)));
        add_jump((int)between(1.0, 60.0), level * (float)between(-50.0, 50.0), level * (float)between(-50.0, 50.0),
                 (float)(check_random_bits(&any) % 2u ? down_m : -down_m));
    }
}

/* [A28] GIVEN any flight with any jumps THEN no quantity of any image moves by a twentieth of a sigma. */
static void no_flight_sees_a_jump(void) {
    double worst = 0.0;
    any = check_random_start("random flights");
    for (int run = 0; run < FLIGHTS; run++) {
        set_up_flight((kind_t)(run % KINDS), (source_t)(run / KINDS % SOURCES));
        take_any_scene();
        flight.settings = scene_settings(&flight.scene);
        flight.settings.navigation.height_white_sd_m =
            run / ((int)KINDS * (int)SOURCES) % 2 ? (float)between(0.1, 2.0) : 0.0f;
        flight.settings.method = run % 10 == 9 ? GOE_METHOD_WINDOW : GOE_METHOD_FILTER;
        take_any_jumps();
        check_worst(&worst, fly());
    }
    check_report("moved by, sigmas", worst);
    TEST_ASSERT_TRUE(worst < MOVED_MAX);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(a_known_jump_of_down_is_no_motion);
    RUN_TEST(the_height_goes_on);
    RUN_TEST(jumps_add_up);
    RUN_TEST(jumps_between_two_images_are_one_sum);
    RUN_TEST(a_jump_without_a_detection_counts);
    RUN_TEST(a_refused_image_leaves_the_jump_to_the_next_one);
    RUN_TEST(a_jump_in_the_first_image_with_a_feature_counts);
    RUN_TEST(a_jump_counts_where_the_track_begins_at_first_sight);
    RUN_TEST(a_jump_at_a_new_start_of_the_filter_counts);
    RUN_TEST(a_jump_does_not_disturb_late_poses);
    RUN_TEST(a_jump_moves_no_height_of_the_window);
    RUN_TEST(a_new_track_takes_the_height_as_it_is);
    RUN_TEST(the_nearer_of_both_is_taken);
    RUN_TEST(no_flight_sees_a_jump);
    return UNITY_END();
}
