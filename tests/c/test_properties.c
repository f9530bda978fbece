/* Properties of every flight: exact recovery, symmetries, invariances. SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "check.h"
#include "scene.h"

#define IMAGES 32

typedef struct {
    goe_status_t status;
    goe_estimate_t estimate;
    scene_truth_t truth;
} step_t;

static step_t flight[IMAGES];
static step_t other[IMAGES];

void setUp(void) {
    memset(flight, 0, sizeof flight);
    memset(other, 0, sizeof other);
}
void tearDown(void) {}

static void fly_with(const scene_t *scene, const goe_settings_t *settings, step_t steps[IMAGES]) {
    goe_estimator_t estimator;
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, settings, NULL));
    for (int k = 0; k < IMAGES; k++) {
        goe_image_t image;
        scene_image(scene, k, &image, &steps[k].truth);
        steps[k].status = goe_update(&estimator, &image, &steps[k].estimate);
    }
}

static void fly(const scene_t *scene, goe_model_t model, step_t steps[IMAGES]) {
    goe_settings_t settings = scene_window_settings(scene);
    settings.model = model;
    fly_with(scene, &settings, steps);
}

static bool solved(const step_t *step) { return step->status == GOE_OK || step->status == GOE_PARTIAL; }

/* ---------------------------------------------------------------------------------------------------- exact recovery -- */

typedef struct {
    double x0, z0, width, length, orientation_deg, center_m;
    int solutions, lengths;
} worst_t;

/* Relative errors of every image that solved; X0 by its own size. */
static void collect_box(const scene_t *scene, const step_t steps[IMAGES], worst_t *worst) {
    for (int k = 0; k < IMAGES; k++) {
        const goe_estimate_t *e = &steps[k].estimate;
        if (solved(&steps[k]) && e->model == GOE_MODEL_LINE) {
            check_worst(&worst->x0, ((double)e->x0_m - scene->x0_m) / scene->x0_m);
            check_worst(&worst->z0, (double)e->z0_m / scene->z0_m - 1.0);
            check_worst(&worst->width, (double)e->width_m / scene->width_m - 1.0);
            check_worst(&worst->orientation_deg, (double)e->orientation_deg - scene->alpha_deg);
            worst->solutions++;
            if (e->valid & GOE_HAS_LENGTH) {
                check_worst(&worst->length, (double)e->length_m / scene->length_m - 1.0);
                check_worst(&worst->center_m, (double)e->center_north_m - steps[k].truth.center_north_m);
                check_worst(&worst->center_m, (double)e->center_east_m - steps[k].truth.center_east_m);
                worst->lengths++;
            }
        }
    }
}

static void check_box(const worst_t *worst) {
    check_report("X0, worst relative error", worst->x0);
    check_report("Z0, worst relative error", worst->z0);
    check_report("W, worst relative error", worst->width);
    check_report("L, worst relative error", worst->length);
    check_report("orientation, worst error in degrees", worst->orientation_deg);
    check_report("center, worst error in meters", worst->center_m);
    check_report("solutions", worst->solutions);
    TEST_ASSERT_TRUE(worst->x0 < 1.0e-3);
    TEST_ASSERT_TRUE(worst->z0 < 1.0e-3);
    TEST_ASSERT_TRUE(worst->width < 1.0e-3);
    TEST_ASSERT_TRUE(worst->length < 1.0e-3);
    TEST_ASSERT_TRUE(worst->orientation_deg < 0.05);
    TEST_ASSERT_TRUE(worst->center_m < 0.1);
}

/* The paths, sides and slopes of one box; returns the number of flights. */
static int fly_all_ways(const scene_t *box, goe_model_t model, worst_t *worst) {
    static const double alphas_deg[] = {0.0, 20.0, -35.0};
    int flights = 0;
    for (int path = 0; path < 4; path++) {
        for (int side = 0; side < 2; side++) {
            for (int glide = 0; glide < 2; glide++) {
                for (int a = 0; a < 3; a++) {
                    scene_t scene = *box;
                    scene.path = path == 1 ? SCENE_ARC : path == 2 ? SCENE_WEAVE : SCENE_STRAIGHT;
                    scene.acceleration_mps2 = path == 3 ? 2.0 : 0.0;
                    scene.alpha_deg = side ? -alphas_deg[a] : alphas_deg[a];
                    scene.x0_m = side ? -box->x0_m : box->x0_m;
                    scene.arc_radius_m = side ? box->arc_radius_m : -box->arc_radius_m;
                    scene.glide_deg = glide ? 6.0 : 0.0;
                    fly(&scene, model, flight);
                    collect_box(&scene, flight, worst);
                    TEST_ASSERT_TRUE(solved(&flight[IMAGES - 1]));
                    flights++;
                }
            }
        }
    }
    return flights;
}

/* [A4, A8, goe_estimate_t.center_north_m, goe_estimate_t.width_m, (3), (7)]
 * GIVEN noise-free flights past a truck and a building: straight, curved, weaving, speeding up; on both sides; level and
 * down a 6 degree slope; at three orientations
 * THEN every solution of every image has X0, Z0, W, L within 0.1 % and the orientation within 0.05 degrees. */
static void boxes_are_recovered_exactly(void) {
    worst_t worst;
    scene_t truck;
    scene_t building;
    memset(&worst, 0, sizeof worst);
    scene_default(&truck);
    truck.z0_m = 90.0;
    scene_default(&building);
    building.width_m = 15.0;
    building.length_m = 40.0;
    building.height_m = 89.0;
    building.x0_m = -60.0;
    building.z0_m = 250.0;
    building.altitude_m = 60.0;
    building.speed_mps = 30.0;
    const int flights = fly_all_ways(&truck, GOE_MODEL_LINE, &worst) + fly_all_ways(&building, GOE_MODEL_AUTO, &worst);
    TEST_ASSERT_EQUAL_INT(96, flights);
    check_box(&worst);
    TEST_ASSERT_GREATER_THAN_INT(1800, worst.solutions);
    TEST_ASSERT_GREATER_THAN_INT(1200, worst.lengths);
}

/* [goe_estimator.c] ... with a camera that looks 30 degrees left, sits off the reference point and has a lens, on an aircraft that rolls,
 * pitches and yaws by 8 degrees. */
static void own_attitude_and_mounting_are_taken_out(void) {
    worst_t worst;
    scene_t scene;
    memset(&worst, 0, sizeof worst);
    scene_default(&scene);
    scene.x0_m = -25.0;
    scene.z0_m = 90.0;
    scene.camera.mount_yaw_deg = -30.0f;
    scene.camera.mount_pitch_deg = -12.0f;
    scene.camera.mount_roll_deg = 4.0f;
    scene.camera.offset_m[0] = 1.5f;
    scene.camera.offset_m[1] = -0.75f;
    scene.camera.offset_m[2] = 0.5f;
    scene.camera.k1 = -0.1f;
    scene.camera.k2 = 0.01f;
    scene.camera.p1 = 0.0005f;
    scene.camera.p2 = -0.0007f;
    scene.wobble_deg = 8.0;
    scene.course_deg = 217.0;
    scene.yaw_deg = 6.0;
    scene.start_ned_m[0] = 55.0;
    scene.start_ned_m[1] = -81.0;
    scene.ground_d_m = 12.0;
    for (int glide = 0; glide < 2; glide++) {
        scene.glide_deg = glide ? 6.0 : 0.0;
        scene.alpha_deg = glide ? -20.0 : 15.0;
        fly(&scene, GOE_MODEL_LINE, flight);
        TEST_ASSERT_TRUE(solved(&flight[IMAGES / 2]));
        collect_box(&scene, flight, &worst);
    }
    check_box(&worst);
    TEST_ASSERT_GREATER_THAN_INT(30, worst.solutions);
}

/* ------------------------------------------------------------------------------------------------------- invariances -- */

static void check_same_estimate(const step_t *a, const step_t *b, double tolerance) {
    CHECK_STATUS(a->status, b->status);
    TEST_ASSERT_EQUAL_INT(a->estimate.model, b->estimate.model);
    TEST_ASSERT_EQUAL_HEX32(a->estimate.valid, b->estimate.valid);
    const double z = 1.0 + fabs((double)a->estimate.z0_m);
    CHECK_CLOSE(tolerance * z, a->estimate.x0_m, b->estimate.x0_m);
    CHECK_CLOSE(tolerance * z, a->estimate.z0_m, b->estimate.z0_m);
    CHECK_CLOSE(tolerance * (double)a->estimate.width_m, a->estimate.width_m, b->estimate.width_m);
    CHECK_CLOSE(tolerance * 10.0 * (double)a->estimate.length_m, a->estimate.length_m, b->estimate.length_m);
    CHECK_CLOSE(tolerance * z, a->estimate.height_m, b->estimate.height_m);
    CHECK_CLOSE(0.01, a->estimate.orientation_deg, b->estimate.orientation_deg);
}

/* [goe_ego_motion.c] GIVEN one flight WHEN the world is turned about the vertical THEN nothing changes in T, and NED turns along. */
static void turning_the_world_changes_nothing_in_the_trajectory_frame(void) {
    static const double courses_deg[] = {37.0, 90.0, 180.0, 211.0, 300.0, -5.0};
    scene_t scene;
    scene_default(&scene);
    scene.alpha_deg = 15.0;
    scene.path = SCENE_ARC;
    fly(&scene, GOE_MODEL_AUTO, flight);
    for (int i = 0; i < 6; i++) {
        scene.course_deg = courses_deg[i];
        fly(&scene, GOE_MODEL_AUTO, other);
        for (int k = 0; k < IMAGES; k++) {
            check_same_estimate(&flight[k], &other[k], 1.0e-4);
            if (other[k].estimate.valid & GOE_HAS_CENTER && other[k].estimate.model == GOE_MODEL_LINE) {
                CHECK_CLOSE(0.02, other[k].truth.center_north_m, other[k].estimate.center_north_m);
                CHECK_CLOSE(0.02, other[k].truth.center_east_m, other[k].estimate.center_east_m);
            }
        }
    }
}

/* GIVEN one flight WHEN T is given another heading THEN the obstacle's heading in the world, its center and its size
 * stay: the choice of T is no part of the answer. */
static void the_heading_in_the_world_does_not_depend_on_the_trajectory_frame(void) {
    scene_t scene;
    scene_default(&scene);
    scene.alpha_deg = 12.0;
    scene.course_deg = 70.0;
    fly(&scene, GOE_MODEL_LINE, flight);
    for (int turn_deg = -15; turn_deg <= 15; turn_deg += 5) {
        goe_settings_t settings = scene_window_settings(&scene);
        settings.model = GOE_MODEL_LINE;
        settings.heading_auto = false;
        settings.heading_deg = (float)(70 + turn_deg);
        fly_with(&scene, &settings, other);
        for (int k = 0; k < IMAGES; k++) {
            CHECK_STATUS(flight[k].status, other[k].status);
            if (other[k].estimate.valid & GOE_HAS_LENGTH) {
                CHECK_CLOSE(0.01, 82.0, other[k].estimate.orientation_deg + settings.heading_deg);
                CHECK_CLOSE(0.02, flight[k].estimate.center_north_m, other[k].estimate.center_north_m);
                CHECK_CLOSE(0.02, flight[k].estimate.center_east_m, other[k].estimate.center_east_m);
                CHECK_CLOSE(0.001, flight[k].estimate.width_m, other[k].estimate.width_m);
                CHECK_CLOSE(0.005, flight[k].estimate.length_m, other[k].estimate.length_m);
            }
        }
    }
}

/* [goe_estimate_t.x0_m]
 * GIVEN a flight WHEN it is mirrored left to right THEN X0 and the orientation change sign and nothing else changes. */
static void left_and_right_are_equal(void) {
    for (int shape = 0; shape < 2; shape++) {
        for (int path = 0; path < 3; path++) {
            scene_t scene;
            scene_default(&scene);
            scene.shape = shape ? SCENE_CYLINDER : SCENE_BOX;
            scene.path = (scene_path_t)path;
            scene.alpha_deg = 18.0;
            scene.camera.cx_px = 0.0f;
            scene.camera.mount_yaw_deg = -10.0f;
            scene.camera.offset_m[1] = 0.5f;
            scene.wobble_deg = 4.0;
            const scene_t mirrored = scene_mirrored(&scene);
            fly(&scene, GOE_MODEL_AUTO, flight);
            fly(&mirrored, GOE_MODEL_AUTO, other);
            for (int k = 0; k < IMAGES; k++) {
                goe_estimate_t *e = &other[k].estimate;
                e->x0_m = -e->x0_m;
                e->orientation_deg = -e->orientation_deg;
                check_same_estimate(&flight[k], &other[k], 1.0e-4);
            }
            TEST_ASSERT_TRUE(solved(&flight[IMAGES - 1]));
        }
    }
}

/* GIVEN a flight WHEN all lengths are doubled, in the same time, THEN every pixel is the same and every length of the
 * answer doubles: exactly, since the power of two passes through every sum, product and root. */
static void doubling_all_lengths_doubles_the_answer(void) {
    for (int shape = 0; shape < 2; shape++) {
        for (int path = 0; path < 3; path++) {
            scene_t scene;
            scene_default(&scene);
            scene.shape = shape ? SCENE_CYLINDER : SCENE_BOX;
            scene.path = (scene_path_t)path;
            scene.alpha_deg = -10.0;
            scene.acceleration_mps2 = 1.0;
            scene.glide_deg = 3.0;
            scene.start_ned_m[1] = 31.0;
            const scene_t doubled = scene_scaled(&scene, 2.0);
            fly(&scene, GOE_MODEL_AUTO, flight);
            fly(&doubled, GOE_MODEL_AUTO, other);
            for (int k = 0; k < IMAGES; k++) {
                const goe_estimate_t *a = &flight[k].estimate;
                const goe_estimate_t *b = &other[k].estimate;
                CHECK_STATUS(flight[k].status, other[k].status);
                TEST_ASSERT_EQUAL_HEX32(a->valid, b->valid);
                CHECK_SAME(2.0f * a->x0_m, b->x0_m);
                CHECK_SAME(2.0f * a->z0_m, b->z0_m);
                CHECK_SAME(2.0f * a->z_m, b->z_m);
                CHECK_SAME(2.0f * a->width_m, b->width_m);
                CHECK_SAME(2.0f * a->length_m, b->length_m);
                CHECK_SAME(2.0f * a->height_m, b->height_m);
                CHECK_SAME(2.0f * a->baseline_m, b->baseline_m);
                CHECK_SAME(2.0f * a->sigma.z0_m, b->sigma.z0_m);
                CHECK_SAME(2.0f * a->center_east_m, b->center_east_m);
                CHECK_SAME(a->orientation_deg, b->orientation_deg);
                CHECK_SAME(a->residual, b->residual);
            }
            TEST_ASSERT_TRUE(solved(&flight[IMAGES - 1]));
        }
    }
}

/* [goe_pose_t.position_ned_m]
 * GIVEN a flight WHEN the origin of NED lies elsewhere THEN nothing changes but the center, which moves along; far away
 * floats hold positions to 0.1 mm at 1 km and to 4 mm at 100 km, and the tolerances grow with that. */
static void the_origin_of_ned_does_not_matter(void) {
    static const double distances_m[] = {100.0, 1000.0, 10000.0, 100000.0};
    static const double tolerances[] = {1.0e-4, 2.0e-4, 2.0e-3, 1.5e-2};
    scene_t scene;
    scene_default(&scene);
    scene.course_deg = 33.0; /* positions are no round numbers */
    fly(&scene, GOE_MODEL_LINE, flight);
    for (int i = 0; i < 4; i++) {
        double worst = 0.0;
        scene.start_ned_m[0] = distances_m[i];
        scene.start_ned_m[1] = -0.7 * distances_m[i];
        fly(&scene, GOE_MODEL_LINE, other);
        for (int k = 0; k < IMAGES; k++) {
            const goe_estimate_t *a = &flight[k].estimate;
            const goe_estimate_t *b = &other[k].estimate;
            CHECK_STATUS(flight[k].status, other[k].status);
            TEST_ASSERT_EQUAL_HEX32(a->valid, b->valid);
            if (a->valid & GOE_HAS_POSITION) {
                check_worst(&worst, (double)b->z0_m / (double)a->z0_m - 1.0);
                check_worst(&worst, (double)b->width_m / (double)a->width_m - 1.0);
                check_worst(&worst, ((double)b->x0_m - (double)a->x0_m) / (double)a->z0_m);
            }
        }
        check_report("origin moved: worst relative difference of X0, Z0, W", worst);
        TEST_ASSERT_TRUE(worst < tolerances[i]);
    }
}

/* [goe_estimate_t.x_m] One estimate says the same thing in several ways. */
static void an_estimate_agrees_with_itself(void) {
    scene_t scene;
    scene_default(&scene);
    scene.alpha_deg = 25.0;
    fly(&scene, GOE_MODEL_AUTO, flight);
    for (int k = 0; k < IMAGES; k++) {
        const goe_estimate_t *e = &flight[k].estimate;
        if (e->valid & GOE_HAS_ORIENTATION) {
            const double radians = (double)e->orientation_deg * 0.017453292519943295;
            CHECK_CLOSE(1.0e-6, sin(radians), e->length_axis[0]);
            CHECK_CLOSE(1.0e-6, cos(radians), e->length_axis[1]);
            CHECK_CLOSE(1.0e-6, cos(radians), e->width_axis[0]);
            CHECK_CLOSE(1.0e-6, -sin(radians), e->width_axis[1]);
            CHECK_CLOSE(1.0e-4, 90.0f, fabsf(e->front_orientation_deg - e->orientation_deg));
        }
        if (e->valid & GOE_HAS_POSITION) {
            CHECK_CLOSE(1.0e-4, e->x0_m - (float)flight[k].truth.dx_m, e->x_m);
            CHECK_CLOSE(1.0e-4, e->z0_m - (float)flight[k].truth.dz_m, e->z_m);
        }
    }
    TEST_ASSERT_TRUE(solved(&flight[IMAGES - 1]));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(boxes_are_recovered_exactly);
    RUN_TEST(own_attitude_and_mounting_are_taken_out);
    RUN_TEST(turning_the_world_changes_nothing_in_the_trajectory_frame);
    RUN_TEST(the_heading_in_the_world_does_not_depend_on_the_trajectory_frame);
    RUN_TEST(left_and_right_are_equal);
    RUN_TEST(doubling_all_lengths_doubles_the_answer);
    RUN_TEST(the_origin_of_ned_does_not_matter);
    RUN_TEST(an_estimate_agrees_with_itself);
    return UNITY_END();
}
