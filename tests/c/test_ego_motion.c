/* The own motion between two poses, and the effect of a late pose on it. SPDX-License-Identifier: MIT */
/* tests: lib/image/goe_ego_motion.c */
#include "image/goe_ego_motion.h"

#include <math.h>
#include <string.h>

#include "check.h"
#include "maths/goe_scalar.h"
#include "refined/goe_filter.h"

#define HEADING 0.4 /* of the nose at the first image, rad: T's Z axis */

static goe_motion_t motion;
static goe_settings_t settings;
static goe_view_t view;
static goe_image_t image;
static goe_filter_t filter;
static const float jump_m[3] = {20.0f, -7.0f, 3.0f};
static bool jumped;
static float error_m[2]; /* of the position */

void setUp(void) {
    static const float forward[9] = {0.0f, 0.0f, 1.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f};
    goe_settings_default(&settings);
    jumped = false;
    memset(error_m, 0, sizeof error_m);
    memset(&motion, 0, sizeof motion);
    memset(&view, 0, sizeof view);
    memset(&image, 0, sizeof image);
    memset(&filter, 0, sizeof filter);
    motion.time_us = GOE_TIME_UNKNOWN;
    view.image = &image;
    view.motion = &motion;
    view.camera = &settings.camera;
    view.camera_to_body = forward;
}
void tearDown(void) {}

/* The pose at t: the aircraft flies along its nose at 12 m/s and across it at 3 m/s, yawing at 0.5 rad/s, from level. */
static void follow(double t) {
    const double yaw = HEADING + 0.5 * t;
    image.pose.time_us = 1000000 + (int64_t)(t * 1.0e6 + 0.5);
    image.pose.attitude[0] = (float)cos(0.5 * yaw);
    image.pose.attitude[3] = (float)sin(0.5 * yaw);
    image.pose.position_ned_m[0] = (float)((12.0 * cos(HEADING) - 3.0 * sin(HEADING)) * t);
    image.pose.position_ned_m[1] = (float)((12.0 * sin(HEADING) + 3.0 * cos(HEADING)) * t);
    for (int i = 0; i < 2; i++) {
        image.pose.position_ned_m[i] += error_m[i] + (jumped ? jump_m[i] : 0.0f);
    }
    goe_motion_follow(&motion, &settings, &view);
    motion.detected = true; /* each image shows a feature */
}

/* GIVEN two poses a tenth of a second apart THEN rate and velocity are those between them, in T: about its Y axis, which points down,
 * and along Z and X. */
static void two_poses_give_rate_and_velocity(void) {
    follow(0.0);
    TEST_ASSERT_FALSE(goe_motion_paced(&motion));
    follow(0.1);
    TEST_ASSERT_TRUE(goe_motion_paced(&motion));
    CHECK_CLOSE(1.0e-3, 0.0, motion.rate_rad_s[0]);
    CHECK_CLOSE(1.0e-3, 0.5, motion.rate_rad_s[1]);
    CHECK_CLOSE(1.0e-3, 0.0, motion.rate_rad_s[2]);
    CHECK_CLOSE(1.0e-3, 3.0, motion.velocity_m_s[0]);
    CHECK_CLOSE(1.0e-3, 12.0, motion.velocity_m_s[1]);
    CHECK_SAME(0.0f, motion.rate_before_rad_s[1]);
    follow(0.2); /* the rate before is that of the span before, in which this pose's error has no part */
    CHECK_CLOSE(1.0e-3, 0.5, motion.rate_before_rad_s[1]);
}

/* GIVEN a nose that pitches up and a wing that drops THEN their rates are about X and Z. */
static void pitch_and_roll_are_about_x_and_z(void) {
    for (int n = 0; n < 2; n++) {
        setUp();
        image.pose.attitude[0] = 1.0f;
        image.pose.time_us = 1000000;
        goe_motion_follow(&motion, &settings, &view);
        motion.detected = true;
        image.pose.time_us = 1100000;
        image.pose.attitude[0] = (float)cos(0.02);
        image.pose.attitude[n == 0 ? 2 : 1] = (float)sin(0.02);
        goe_motion_follow(&motion, &settings, &view);
        CHECK_CLOSE(1.0e-3, n == 0 ? 0.4 : 0.0, motion.rate_rad_s[0]);
        CHECK_CLOSE(1.0e-3, n == 1 ? 0.4 : 0.0, motion.rate_rad_s[2]);
    }
}

/* GIVEN a camera on an arm of a turning aircraft THEN the velocity is the vehicle's, not that with which the arm swings: two cameras
 * must give the same velocity. */
static void the_velocity_is_the_vehicles(void) {
    settings.camera.offset_m[0] = 4.0f;
    settings.camera.offset_m[1] = -2.0f;
    follow(0.0);
    follow(0.1);
    CHECK_CLOSE(1.0e-3, 3.0, motion.velocity_m_s[0]);
    CHECK_CLOSE(1.0e-3, 12.0, motion.velocity_m_s[1]);
}

#define PATH_IMAGES 400

/* Follows an aircraft that moves at (3, 12) m/s, and returns the rms of off_m over all three axes. white_m: errors of its positions. */
static double off_path(double white_m, double *velocity_error_m_s) {
    check_random_t any = check_random_start("path");
    double squares = 0.0;
    double worst = 0.0;
    for (int k = 0; k < PATH_IMAGES; k++) {
        for (int i = 0; i < 2; i++) {
            error_m[i] = (float)(white_m * check_random_normal(&any));
        }
        image.pose.position_ned_m[2] = (float)(white_m * check_random_normal(&any) - 50.0);
        follow(0.1 * k);
        for (int i = 0; i < 3 && k > 10; i++) {
            squares += (double)view.off_m[i] * (double)view.off_m[i];
        }
        worst = k > 10 ? fmax(worst, fabs((double)motion.velocity_m_s[1] - 12.0)) : worst;
    }
    *velocity_error_m_s = worst;
    return sqrt(squares / (3.0 * (PATH_IMAGES - 11)));
}

/* GIVEN a straight flight THEN all places lie on the smoothed path. WHEN each position has an error of its own THEN each is off the path by this
 * error and by that of the prediction, which the steady gains a = 11/21 and b = 1/7 amplify: var = (1 + (2 a^2 + b (2 + a))/(a (4 - 2 a - b)))
 * of the white one (Kalata 1984); the velocity has sigma sqrt(2 b^2/(a (4 - 2 a - b)))/T, and not sqrt(2)/T. */
static void the_path_smooths_errors_of_the_places(void) {
    double velocity_error_m_s;
    const double a = 11.0 / 21.0;
    const double b = 1.0 / 7.0;
    const double bottom = a * (4.0 - 2.0 * a - b);
    const double predicted = (2.0 * a * a + b * (2.0 + a)) / bottom;
    CHECK_CLOSE(1.0e-4, 0.0, off_path(0.0, &velocity_error_m_s));
    CHECK_CLOSE(1.0e-2, 0.0, velocity_error_m_s);
    setUp();
    CHECK_CLOSE(0.02, 0.3 * sqrt(1.0 + predicted), off_path(0.3, &velocity_error_m_s));
    check_report("worst error of the velocity by 0.3 m, m/s", velocity_error_m_s);
    TEST_ASSERT_TRUE(velocity_error_m_s < 4.5 * 0.3 * sqrt(2.0 * b * b / bottom) / 0.1);
}

/* GIVEN a path WHEN down jumps by a known distance, or images are missing for long THEN no place is off it. */
static void the_path_jumps_along_and_begins_again(void) {
    for (int k = 0; k < 8; k++) {
        image.pose.position_ned_m[2] = k < 5 ? -50.0f : -43.0f;
        image.pose.reset_count = k < 5 ? 0 : 1;
        image.pose.reset_delta_known = 1;
        image.pose.reset_delta_ned_m[2] = 7.0f;
        follow(0.1 * k);
        for (int i = 0; i < 3; i++) {
            CHECK_CLOSE(1.0e-4, 0.0, view.off_m[i]);
        }
    }
    image.pose.position_ned_m[2] = -60.0f;
    follow(1.4);
    CHECK_SAME(0.0f, view.off_m[2]);
}

/* GIVEN a path that a flipped bit has made no number WHEN images follow THEN it begins again, and no place is off it. */
static void a_path_that_is_no_number_begins_again(void) {
    follow(0.0);
    follow(0.1);
    follow(0.2);
    motion.velocity_m_s[0] = NAN;
    follow(0.3);
    CHECK_SAME(0.0f, view.off_m[0]);
    follow(0.4);
    follow(0.5);
    CHECK_CLOSE(1.0e-3, 3.0, motion.velocity_m_s[0]);
    CHECK_CLOSE(1.0e-4, 0.0, view.off_m[0]);
}

/* GIVEN poses too near to each other THEN they would give only noise, and the previous motion stays; too far apart, they would give a mean,
 * and there is no motion; nor over a jump of the autopilot's filter. */
static void only_distant_poses_give_motion(void) {
    follow(0.0);
    follow(0.04);
    CHECK_SAME(0.0f, motion.rate_rad_s[1]); /* nearer than 45 ms: not yet */
    follow(0.06);
    CHECK_CLOSE(1.0e-3, 0.5, motion.rate_rad_s[1]);
    TEST_ASSERT_FALSE(goe_motion_paced(&motion)); /* nearer than 90 ms: no second mark of the path yet */
    follow(0.10);
    TEST_ASSERT_TRUE(goe_motion_paced(&motion));
    CHECK_CLOSE(1.0e-3, 12.0, motion.velocity_m_s[1]);
    follow(0.71);
    TEST_ASSERT_FALSE(goe_motion_paced(&motion));
    CHECK_SAME(0.0f, motion.rate_rad_s[1]);
    CHECK_SAME(0.0f, motion.rate_before_rad_s[1]);
    follow(0.81);
    TEST_ASSERT_TRUE(goe_motion_paced(&motion));
}

/* GIVEN a known jump of the autopilot's filter THEN it is in neither velocity nor rate: the latency is corrected in that image,
 * too. */
static void a_known_jump_is_in_no_velocity(void) {
    follow(0.0);
    follow(0.1);
    for (int i = 0; i < 3; i++) {
        image.pose.reset_delta_ned_m[i] = jump_m[i];
    }
    image.pose.reset_count = 1;
    image.pose.reset_delta_known = true;
    jumped = true;
    follow(0.2);
    TEST_ASSERT_TRUE(goe_motion_paced(&motion));
    CHECK_CLOSE(1.0e-3, 0.5, motion.rate_rad_s[1]);
    CHECK_CLOSE(1.0e-3, 3.0, motion.velocity_m_s[0]);
    CHECK_CLOSE(1.0e-3, 12.0, motion.velocity_m_s[1]);
}

/* GIVEN a new track that begins with the jump THEN there is no velocity yet. */
static void a_new_track_has_no_velocity(void) {
    follow(0.0);
    follow(0.1);
    memset(&motion, 0, sizeof motion); /* as goe_estimator.c does */
    motion.time_us = GOE_TIME_UNKNOWN;
    image.pose.reset_count = 1;
    jumped = true;
    follow(0.2);
    TEST_ASSERT_FALSE(goe_motion_paced(&motion));
    CHECK_SAME(0.0f, motion.rate_rad_s[1]);
}

/* GIVEN a pose that is half turned about from the one before THEN that is a jump, not a rate. */
static void a_jump_of_the_attitude_is_no_rate(void) {
    follow(0.0);
    image.pose.time_us += 100000;
    image.pose.attitude[0] = 0.0f;
    image.pose.attitude[3] = 1.0f;
    goe_motion_follow(&motion, &settings, &view);
    TEST_ASSERT_FALSE(goe_motion_paced(&motion));
    setUp();
    follow(0.0);
    for (int i = 0; i < 4; i++) { /* the same attitude by the other quaternion is no jump */
        image.pose.attitude[i] = -image.pose.attitude[i];
    }
    image.pose.time_us += 100000;
    goe_motion_follow(&motion, &settings, &view);
    TEST_ASSERT_TRUE(goe_motion_paced(&motion));
    CHECK_CLOSE(1.0e-5, 0.0, motion.rate_rad_s[1]);
}

/* GIVEN a filter whose poses are late THEN the camera is where it was that much before: behind by what it has gained in velocity since
 * the filter's start, as a constant velocity only shifts where it began; and of a velocity that is not known nothing is gained. */
static void late_poses_are_behind_by_what_was_gained(void) {
    follow(0.0);
    filter.axes.turn_cos = 0.8f;
    filter.axes.turn_sin = 0.6f;
    filter.axes.start_velocity_m_s[0] = 1.0f;
    filter.axes.start_velocity_m_s[1] = 2.0f;
    filter.paced = 1;
    goe_xz_t gained = goe_filter_gained(&filter, &motion);
    CHECK_SAME(0.0f, gained.x); /* the motion knows of none yet */
    CHECK_SAME(0.0f, gained.z);
    follow(0.1);
    filter.paced = 0;
    gained = goe_filter_gained(&filter, &motion);
    CHECK_SAME(0.0f, gained.x);
    CHECK_SAME(0.0f, gained.z);
    filter.paced = 1;
    gained = goe_filter_gained(&filter, &motion);
    CHECK_CLOSE(1.0e-3, 0.8 * 2.0 - 0.6 * 10.0, gained.x);
    CHECK_CLOSE(1.0e-3, 0.6 * 2.0 + 0.8 * 10.0, gained.z);
    filter.mover.augmented[0] = 0.2f;
    filter.axes.start_dx_m = 0.5f;
    filter.axes.start_dz_m = 0.25f;
    const goe_xz_t camera = goe_filter_camera(&filter, &motion);
    const double dx = 0.3 - 0.5;
    const double dz = 1.2 - 0.25;
    CHECK_CLOSE(1.0e-3, 0.8 * dx - 0.6 * dz + 0.2 * (double)gained.x, camera.x);
    CHECK_CLOSE(1.0e-3, 0.6 * dx + 0.8 * dz + 0.2 * (double)gained.z, camera.z);
    /* of an obstacle that is followed, less by what that has moved */
    filter.mover.followed = 1;
    filter.mover.augmented[0] = 0.0f;
    filter.mover.augmented[1] = 5.0f;
    filter.mover.augmented[2] = -7.0f;
    filter.axes.start_time_us = motion.time_us - 2000000;
    const goe_xz_t moved = goe_filter_moved(&filter, &motion);
    CHECK_CLOSE(1.0e-4, 10.0, moved.x);
    CHECK_CLOSE(1.0e-4, -14.0, moved.z);
    const goe_xz_t behind = goe_filter_camera(&filter, &motion);
    CHECK_CLOSE(1.0e-3, 0.8 * (dx - 10.0) - 0.6 * (dz + 14.0), behind.x);
    CHECK_CLOSE(1.0e-3, 0.6 * (dx - 10.0) + 0.8 * (dz + 14.0), behind.z);
}

/* -------------------------------------------------------------------------------------------------------------- height -- */

/* The next image, a tenth of a second later: down and height as given, after a known jump of down. */
static void climb(float down_m, float height_m, float down_jump_m) {
    image.pose.time_us += 100000;
    image.pose.position_ned_m[2] = down_m;
    image.pose.height_m = height_m;
    if (goe_magnitude(down_jump_m) != 0u) {
        image.pose.reset_count++;
        image.pose.reset_delta_known = true;
    }
    image.pose.reset_delta_ned_m[2] = down_jump_m; /* read with a reset only */
    goe_motion_follow(&motion, &settings, &view);
}

/* GIVEN a height that jumps with down THEN it goes on as if neither had, and jumps add up; GIVEN one that does not THEN it is as
 * given. */
static void a_height_goes_on_over_a_jump_of_down(void) {
    image.pose.attitude[0] = 1.0f;
    climb(-50.0f, 30.0f, 0.0f);
    CHECK_SAME(30.0f, motion.height_m);
    climb(-46.0f, 29.0f, 3.0f); /* 1 m of descent; the height of a range finder */
    CHECK_SAME(29.0f, motion.height_m);
    climb(-42.0f, 25.0f, 4.0f); /* jumps along */
    CHECK_SAME(29.0f, motion.height_m);
    climb(-43.0f, 26.0f, 0.0f);
    CHECK_SAME(30.0f, motion.height_m);
    climb(-45.5f, 28.5f, -2.5f);
    CHECK_SAME(30.0f, motion.height_m);
    climb(-55.5f, 28.5f, -10.0f);
    CHECK_SAME(30.0f, motion.height_m);
    climb(-55.5f, 20.0f, 0.0f); /* what the height does without a jump is its own */
    CHECK_SAME(21.5f, motion.height_m);
}

/* GIVEN a step of the height that lies between both THEN the nearer counts, and in the middle the height as given. */
static void the_nearer_step_counts(void) {
    static const float given_m[] = {28.1f, 28.0f, 27.9f, 26.0f, 20.0f, 33.0f};
    static const float taken_m[] = {28.1f, 28.0f, 31.9f, 30.0f, 24.0f, 33.0f};
    for (int i = 0; i < 6; i++) {
        setUp();
        image.pose.attitude[0] = 1.0f;
        climb(-50.0f, 30.0f, 0.0f);
        climb(-46.0f, given_m[i], 4.0f);
        CHECK_CLOSE(1.0e-5, taken_m[i], motion.height_m);
    }
}

/* GIVEN a camera far ahead of the vehicle's reference WHEN the nose pitches up as down jumps THEN the camera's own climb is no
 * part of the jump. */
static void the_height_is_the_cameras(void) {
    for (int follows = 0; follows < 2; follows++) {
        setUp();
        settings.camera.offset_m[0] = 10.0f;
        image.pose.attitude[0] = 1.0f;
        climb(-50.0f, 30.0f, 0.0f);
        image.pose.attitude[0] = 0.96f;
        image.pose.attitude[2] = 0.28f; /* sin = 2 0.96 0.28: up by 5.376 m */
        climb(-48.0f, follows ? 33.376f : 35.376f, 2.0f);
        CHECK_CLOSE(1.0e-4, 35.376, motion.height_m);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(two_poses_give_rate_and_velocity);
    RUN_TEST(pitch_and_roll_are_about_x_and_z);
    RUN_TEST(the_velocity_is_the_vehicles);
    RUN_TEST(the_path_smooths_errors_of_the_places);
    RUN_TEST(the_path_jumps_along_and_begins_again);
    RUN_TEST(a_path_that_is_no_number_begins_again);
    RUN_TEST(only_distant_poses_give_motion);
    RUN_TEST(a_known_jump_is_in_no_velocity);
    RUN_TEST(a_new_track_has_no_velocity);
    RUN_TEST(a_jump_of_the_attitude_is_no_rate);
    RUN_TEST(late_poses_are_behind_by_what_was_gained);
    RUN_TEST(a_height_goes_on_over_a_jump_of_down);
    RUN_TEST(the_nearer_step_counts);
    RUN_TEST(the_height_is_the_cameras);
    return UNITY_END();
}
