/* What must not depend on north, on the origin, or on left and right. SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "flown.h"

#define COURSES 8

static check_random_t any;
static flown_t flown;
static flown_t other;

void setUp(void) { any = check_random_start("flight properties"); }
void tearDown(void) {}

/* A mast on course, somewhat aside. */
static void start(flown_t *of, double aside_m) {
    flown_start(of, NULL);
    of->scene.width_m = of->scene.length_m = 4.0;
    of->scene.height_m = 40.0;
    of->scene.altitude_m = 20.0;
    of->scene.x0_m = aside_m;
    of->scene.z0_m = 140.0;
}

static void check_same_hazard(const goe_hazard_t *a, const goe_hazard_t *b, double tolerance) {
    CHECK_CLOSE(tolerance, a->tcpa_s, b->tcpa_s);
    CHECK_CLOSE(10.0 * tolerance, a->dcpa_m, b->dcpa_m);
    CHECK_CLOSE(tolerance, a->conflict_probability, b->conflict_probability);
    CHECK_CLOSE(10.0 * tolerance, a->clearance_m, b->clearance_m);
}

/* Distance of the order's point from the obstacle's middle. */
static double target_distance_m(const goe_flight_assessment_t *a, const goe_flight_obstacle_t *o) {
    return hypot((double)(a->target_ned_m[0] - o->center_ned_m[0]), (double)(a->target_ned_m[1] - o->center_ned_m[1]));
}

static void any_course_gives_the_same_order(void) {
    goe_flight_obstacle_t here;
    goe_flight_obstacle_t there;
    start(&flown, 1.0);
    const goe_flight_assessment_t north = flown_fly(&flown, 4.0);
    TEST_ASSERT_EQUAL(1, north.obstacles);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_obstacle(&flown.flight, 0, &here));
    for (int k = 0; k < COURSES; k++) {
        start(&other, 1.0);
        other.scene.course_deg = check_random_between(&any, -180.0, 180.0);
        const goe_flight_assessment_t turned = flown_fly(&other, 4.0);
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_obstacle(&other.flight, 0, &there));
        check_same_hazard(&north.hazard, &turned.hazard, 0.01);
        TEST_ASSERT_EQUAL(north.action, turned.action);
        CHECK_CLOSE(0.1, target_distance_m(&north, &here), target_distance_m(&turned, &there));
        CHECK_CLOSE(0.05, here.nearest_body_m[0], there.nearest_body_m[0]);
        CHECK_CLOSE(0.05, here.nearest_body_m[1], there.nearest_body_m[1]);
        const double trace = (double)(here.covariance_ne_m2[0] + here.covariance_ne_m2[2]);
        CHECK_CLOSE(0.02 * trace, trace, there.covariance_ne_m2[0] + there.covariance_ne_m2[2]);
        const double angle = other.scene.course_deg * 0.017453292519943295;
        const double c = cos(angle), s = sin(angle);
        const double turned_nn = c * c * (double)here.covariance_ne_m2[0] -
                                 2.0 * c * s * (double)here.covariance_ne_m2[1] +
                                 s * s * (double)here.covariance_ne_m2[2];
        CHECK_CLOSE(0.02 * trace, turned_nn, there.covariance_ne_m2[0]);
    }
}

static void a_shifted_origin_shifts_the_places_alone(void) {
    goe_flight_obstacle_t here;
    goe_flight_obstacle_t there;
    start(&flown, -1.0);
    start(&other, -1.0);
    other.scene.start_ned_m[0] = 1000.0;
    other.scene.start_ned_m[1] = -2000.0;
    const goe_flight_assessment_t a = flown_fly(&flown, 4.0);
    const goe_flight_assessment_t b = flown_fly(&other, 4.0);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_obstacle(&flown.flight, 0, &here));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_obstacle(&other.flight, 0, &there));
    check_same_hazard(&a.hazard, &b.hazard, 0.02);
    CHECK_CLOSE(0.3, here.center_ned_m[0] + 1000.0f, there.center_ned_m[0]);
    CHECK_CLOSE(0.1, here.center_ned_m[1] - 2000.0f, there.center_ned_m[1]);
}

static void the_mirror_image_turns_to_the_other_side(void) {
    goe_flight_action_t action[2] = {GOE_FLIGHT_NONE, GOE_FLIGHT_NONE};
    goe_flight_assessment_t last[2];
    for (int k = 0; k < 2; k++) {
        start(&flown, k == 0 ? 2.0 : -2.0);
        for (int tenth = 0; tenth < 60 && action[k] == GOE_FLIGHT_NONE; tenth++) {
            last[k] = flown_fly(&flown, 0.1);
            action[k] = last[k].action;
        }
    }
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, action[0]);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_RIGHT, action[1]);
    CHECK_CLOSE(0.3, last[0].target_ned_m[0], last[1].target_ned_m[0]);
    CHECK_CLOSE(0.3, -last[0].target_ned_m[1], last[1].target_ned_m[1]);
}

static void restart(flown_t *of, const goe_settings_t *estimator) {
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_init(&of->flight, sizeof of->flight, estimator, NULL, NULL));
}

static void check_same_place(const goe_flight_obstacle_t *a, const goe_flight_obstacle_t *b) {
    const double trace_m2 = (double)(a->covariance_ne_m2[0] + a->covariance_ne_m2[2]);
    for (int i = 0; i < 3; i++) {
        CHECK_CLOSE(0.02, a->center_ned_m[i], b->center_ned_m[i]);
        CHECK_CLOSE(0.01 * trace_m2, a->covariance_ne_m2[i], b->covariance_ne_m2[i]);
    }
}

/* T's direction is the caller's choice, and nothing outside depends on it. */
static void a_set_heading_changes_no_place(void) {
    goe_flight_obstacle_t by_nose;
    goe_flight_obstacle_t by_heading;
    start(&flown, 3.0);
    start(&other, 3.0);
    flown.scene.course_deg = other.scene.course_deg = 70.0;
    goe_settings_t estimator = scene_settings(&other.scene);
    estimator.heading_auto = false;
    estimator.heading_deg = 45.0f;
    restart(&other, &estimator);
    const goe_flight_assessment_t a = flown_fly(&flown, 4.0);
    const goe_flight_assessment_t b = flown_fly(&other, 4.0);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_obstacle(&flown.flight, 0, &by_nose));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_obstacle(&other.flight, 0, &by_heading));
    TEST_ASSERT_TRUE((by_nose.valid & GOE_HAS_POSITION) != 0u);
    check_same_hazard(&a.hazard, &b.hazard, 0.01);
    check_same_place(&by_nose, &by_heading);
}

/* Points as the scene gives them, in every fifth sample. */
static void fly_points(flown_t *of, int samples) {
    for (int k = 0; k < samples; k++) {
        goe_flight_attitude_t attitude;
        goe_flight_position_t position;
        goe_image_t image;
        flown_samples(of, k, &attitude, &position);
        of->sample = k + 1;
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_attitude(&of->flight, &attitude));
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_position(&of->flight, &position));
        scene_image(&of->scene, k, &image, NULL);
        goe_flight_detection_t detection = {.id = 3u, .score = 1.0f, .left = image.left, .right = image.right};
        detection.top = image.top;
        detection.base_left = image.base_left;
        detection.base_near = image.base_near;
        detection.base_right = image.base_right;
        const goe_flight_frame_t frame = flown_frame(of, k, &detection, 1);
        if (k % FLOWN_IMAGE_EVERY == 0) {
            TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_frame(&of->flight, &frame));
        }
    }
}

/* The covariance of X0 and Z0, along north and east. */
static void check_turned(const goe_estimator_t *of, double heading_deg, const float ne_m2[3]) {
    float covariance[GOE_QUANTITIES][GOE_QUANTITIES];
    const double heading = heading_deg * 3.14159265358979 / 180.0;
    const double by[2][2] = {{-sin(heading), cos(heading)}, {cos(heading), sin(heading)}}; /* X, Z: along north, east */
    double turned[2][2] = {{0.0, 0.0}, {0.0, 0.0}};
    TEST_ASSERT_EQUAL(GOE_OK, goe_covariance(of, covariance));
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 4; k++) {
            const double of_xz = (double)covariance[k / 2 ? GOE_Z0 : GOE_X0][k % 2 ? GOE_Z0 : GOE_X0];
            turned[i / 2][i % 2] += by[i / 2][k / 2] * of_xz * by[i % 2][k % 2];
        }
    }
    CHECK_CLOSE(1.0e-3 * turned[0][0], turned[0][0], ne_m2[0]);
    CHECK_CLOSE(1.0e-3 * sqrt(turned[0][0] * turned[1][1]), turned[0][1], ne_m2[1]);
    CHECK_CLOSE(1.0e-3 * turned[1][1], turned[1][1], ne_m2[2]);
}

/* Of a box with one visible face, only the front edge has a position; here in a T that is across the course. */
static void a_front_without_a_length_lies_where_it_is(void) {
    goe_flight_obstacle_t obstacle;
    for (int turned = 0; turned < 2; turned++) {
        start(&flown, 0.0);
        flown.scene.boxes = flown.scene.upright_boxes = false;
        flown.scene.width_m = 10.0;
        flown.scene.alpha_deg = 0.0;
        flown.scene.course_deg = -110.0;
        goe_settings_t estimator = scene_settings(&flown.scene);
        estimator.model = GOE_MODEL_LINE;
        estimator.heading_auto = false;
        estimator.heading_deg = turned ? -95.0f : -125.0f;
        restart(&flown, &estimator);
        fly_points(&flown, 200);
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_obstacle(&flown.flight, 0, &obstacle));
        TEST_ASSERT_TRUE((obstacle.valid & GOE_HAS_POSITION) != 0u);
        TEST_ASSERT_TRUE((obstacle.valid & GOE_HAS_LENGTH) == 0u);
        const double along = flown.scene.course_deg * 3.14159265358979 / 180.0;
        const double north = (double)obstacle.center_ned_m[0] - flown.scene.start_ned_m[0];
        const double east = (double)obstacle.center_ned_m[1] - flown.scene.start_ned_m[1];
        CHECK_CLOSE(2.0, flown.scene.z0_m, cos(along) * north + sin(along) * east);
        CHECK_CLOSE(0.5, 0.0, cos(along) * east - sin(along) * north);
        const float *ne = obstacle.covariance_ne_m2;
        TEST_ASSERT_TRUE(ne[0] > 0.01f && ne[2] > 0.01f && ne[0] * ne[2] > ne[1] * ne[1]);
        check_turned(&flown.flight.slot[0].estimator, (double)estimator.heading_deg, ne);
    }
}

/* Points work as boxes do, but for those at the border of the image: left, top or both at once. */
static void points_at_the_border_are_not_visible(void) {
    start(&flown, 1.0);
    flown.scene.boxes = flown.scene.upright_boxes = false;
    flown.scene.camera.border_rel = 0.012f;
    const goe_settings_t estimator = scene_settings(&flown.scene);
    restart(&flown, &estimator);
    int taken = 0;
    for (int k = 0; k < 200; k++) {
        goe_flight_attitude_t attitude;
        goe_flight_position_t position;
        goe_image_t image;
        goe_flight_detection_t detection;
        flown_samples(&flown, k, &attitude, &position);
        flown.sample = k + 1;
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_attitude(&flown.flight, &attitude));
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_position(&flown.flight, &position));
        scene_image(&flown.scene, k, &image, NULL);
        memset(&detection, 0, sizeof detection);
        detection.id = 3u;
        detection.score = 1.0f;
        detection.left = image.left;
        detection.right = image.right;
        detection.top = image.top;
        if (k % 10 == 5) { /* a cut side: 2 px inside the image, hundreds from where it belongs */
            detection.left.u_px = 2.0f;
        }
        if (k % 20 == 15) {
            detection.top.v_px = 1279.0f;
        }
        const goe_flight_frame_t frame = flown_frame(&flown, k, &detection, 1);
        if (k % 5 == 0) {
            TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_frame(&flown.flight, &frame));
            taken++;
        }
    }
    goe_flight_obstacle_t obstacle;
    TEST_ASSERT_EQUAL(40, taken);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_obstacle(&flown.flight, 0, &obstacle));
    TEST_ASSERT_TRUE((obstacle.valid & GOE_HAS_POSITION) != 0u);
    TEST_ASSERT_FALSE(obstacle.suspect);
    CHECK_CLOSE(0.5, 4.0, obstacle.width_m);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(any_course_gives_the_same_order);
    RUN_TEST(a_shifted_origin_shifts_the_places_alone);
    RUN_TEST(the_mirror_image_turns_to_the_other_side);
    RUN_TEST(a_set_heading_changes_no_place);
    RUN_TEST(a_front_without_a_length_lies_where_it_is);
    RUN_TEST(points_at_the_border_are_not_visible);
    return UNITY_END();
}
