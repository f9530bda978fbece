/* Places in the image, on the earth and by bearing. SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "check.h"
#include "goe_geometry.h"
#include "scene.h"

#define DEG_PER_RAD 57.295779513082321
#define EARTH_M 6371000.0
#define MAX_CM 30000u

static check_random_t any;
static uint16_t sector_cm[GOE_FLIGHT_SECTORS];

void setUp(void) { any = check_random_start("flight geometry"); }
void tearDown(void) {}

/* The middle of the scene's box lies between the sides of its bounding box, observed by any camera at any attitude; and the point that
 * the scene draws as its top left corner lies on them. Mounting is that of the library: a wrong one would not hit the box. */
static void a_point_is_visible_where_the_scene_draws_it(void) {
    int seen = 0;
    for (int k = 0; k < 400; k++) {
        scene_t scene;
        goe_image_t image;
        scene_truth_t truth;
        scene_default(&scene);
        scene.width_m = scene.length_m = 0.5; /* small: its box gives its place */
        scene.height_m = 0.5;
        scene.x0_m = check_random_between(&any, -40.0, 40.0);
        scene.course_deg = check_random_between(&any, -180.0, 180.0);
        scene.roll_deg = check_random_between(&any, -40.0, 40.0);
        scene.pitch_deg = check_random_between(&any, -15.0, 15.0);
        scene.boxes = true;
        scene.camera.width_px = scene.camera.height_px = 1280.0f;
        scene.camera.mount_yaw_deg = (float)check_random_between(&any, -30.0, 30.0);
        scene.camera.mount_pitch_deg = (float)check_random_between(&any, -20.0, 10.0);
        scene.camera.mount_roll_deg = (float)check_random_between(&any, -20.0, 20.0);
        scene.camera.offset_m[0] = (float)check_random_between(&any, -3.0, 3.0);
        scene.camera.offset_m[2] = (float)check_random_between(&any, -3.0, 3.0);
        scene_image(&scene, 0, &image, &truth);
        if (image.box.sides != GOE_SIDES_ALL) {
            continue;
        }
        goe_flight_camera_t camera;
        goe_flight_history_pose_t pose;
        float pixel[2];
        memset(&camera, 0, sizeof camera);
        memset(&pose, 0, sizeof pose);
        goe_flight_geometry_camera(&camera, &scene.camera);
        memcpy(pose.q, image.pose.attitude, sizeof pose.q);
        memcpy(pose.ned_m, image.pose.position_ned_m, sizeof pose.ned_m);
        const float point[3] = {(float)truth.center_north_m, (float)truth.center_east_m,
                                (float)(scene.ground_d_m - 0.25)};
        const bool inside = goe_flight_geometry_project(&camera, &pose, point, pixel);
        TEST_ASSERT_TRUE(inside || image.box.left_px < -600.0f || image.box.right_px > 1800.0f ||
                         image.box.top_px < -600.0f || image.box.bottom_px > 1800.0f);
        if (inside) {
            TEST_ASSERT_TRUE(pixel[0] > image.box.left_px && pixel[0] < image.box.right_px);
            TEST_ASSERT_TRUE(pixel[1] > image.box.top_px && pixel[1] < image.box.bottom_px);
            seen++;
        }
    }
    TEST_ASSERT_TRUE(seen > 200);
}

static void nothing_is_detected_behind_the_camera(void) {
    goe_flight_camera_t camera;
    goe_flight_history_pose_t pose;
    goe_camera_t settings;
    float pixel[2];
    memset(&settings, 0, sizeof settings);
    settings.fx_px = settings.fy_px = 800.0f;
    settings.width_px = settings.height_px = 1000.0f;
    memset(&camera, 0, sizeof camera);
    memset(&pose, 0, sizeof pose);
    pose.q[0] = 1.0f;
    goe_flight_geometry_camera(&camera, &settings);
    const float behind[3] = {-10.0f, 0.0f, 0.0f};
    const float ahead[3] = {10.0f, 1.0f, 2.0f};
    TEST_ASSERT_FALSE(goe_flight_geometry_project(&camera, &pose, behind, pixel));
    TEST_ASSERT_TRUE(goe_flight_geometry_project(&camera, &pose, ahead, pixel));
    CHECK_CLOSE(1e-3, 80.0, pixel[0]);
    CHECK_CLOSE(1e-3, 160.0, pixel[1]);
}

/* Against the exact azimuthal projection of a sphere, as PX4 has it. */
static void latitude_and_longitude(void) {
    double worst_m = 0.0;
    for (int k = 0; k < 2000; k++) {
        const double lat = check_random_between(&any, -60.0, 60.0);
        const double lon = check_random_between(&any, -180.0, 180.0);
        const float ne_m[2] = {(float)check_random_between(&any, -3000.0, 3000.0),
                               (float)check_random_between(&any, -3000.0, 3000.0)};
        int32_t lat_e7;
        int32_t lon_e7;
        const int32_t origin_lat_e7 = (int32_t)lround(lat * 1e7);
        const int32_t origin_lon_e7 = (int32_t)lround(lon * 1e7);
        goe_flight_geometry_lat_lon(origin_lat_e7, origin_lon_e7, ne_m, &lat_e7, &lon_e7);
        const double c = hypot((double)ne_m[0], (double)ne_m[1]) / EARTH_M;
        const double s0 = sin(lat / DEG_PER_RAD);
        const double c0 = cos(lat / DEG_PER_RAD);
        const double share = sin(c) / c;
        const double north = (double)ne_m[0] / EARTH_M;
        const double east = (double)ne_m[1] / EARTH_M;
        const double exact_lat = DEG_PER_RAD * asin(cos(c) * s0 + north * share * c0);
        const double exact_lon = lon + DEG_PER_RAD * atan2(east * share, c0 * cos(c) - north * share * s0);
        const double off_lat = (double)lat_e7 * 1e-7 - exact_lat;
        const double off_lon = remainder((double)lon_e7 * 1e-7 - exact_lon, 360.0) * cos(exact_lat / DEG_PER_RAD);
        check_worst(&worst_m, hypot(off_lat, off_lon) / DEG_PER_RAD * EARTH_M);
        TEST_ASSERT_TRUE(lon_e7 >= -1800000000 && lon_e7 <= 1800000000);
    }
    check_report("worst within 3 km each way, m", worst_m);
    TEST_ASSERT_TRUE(worst_m < 4.0);
}

static void the_poles_and_far_places_stay_in_range(void) {
    const float ne_m[2] = {1.0e6f, -1.0e6f};
    int32_t lat_e7;
    int32_t lon_e7;
    goe_flight_geometry_lat_lon(890000000, -1800000000, ne_m, &lat_e7, &lon_e7);
    TEST_ASSERT_TRUE(lat_e7 <= 900000000 && lon_e7 >= -1800000000 && lon_e7 <= 1800000000);
    const float south_m[2] = {-1.0e6f, 0.0f};
    goe_flight_geometry_lat_lon(-890000000, 0, south_m, &lat_e7, &lon_e7);
    TEST_ASSERT_EQUAL_INT32(-900000000, lat_e7);
}

/* East of 180 degrees lies the west, and the other way round. */
static void the_date_line_is_no_edge(void) {
    static const float ways_m[] = {1000.0f, -1000.0f};
    for (int i = 0; i < 2; i++) {
        const float ne_m[2] = {0.0f, ways_m[i]};
        const int32_t from_e7 = i == 0 ? 1799990000 : -1799990000;
        int32_t lat_e7;
        int32_t lon_e7;
        goe_flight_geometry_lat_lon(0, from_e7, ne_m, &lat_e7, &lon_e7);
        const int64_t went_e7 = (int64_t)lon_e7 - from_e7 + (i == 0 ? 3600000000LL : -3600000000LL);
        CHECK_CLOSE(1.0, (double)ways_m[i], (double)went_e7 * 1.0e-7 / DEG_PER_RAD * EARTH_M);
    }
}

static void close_sectors(void) {
    for (int i = 0; i < GOE_FLIGHT_SECTORS; i++) {
        sector_cm[i] = GOE_FLIGHT_SECTOR_UNKNOWN;
    }
}

/* Each sector that contains a ray into the circle has it, and of the others only the two next to these. */
static void a_circle_enters_the_sectors_that_it_touches(void) {
    for (int k = 0; k < 300; k++) {
        const double bearing = check_random_between(&any, 0.0, 360.0);
        const double distance_m = check_random_between(&any, 12.0, 200.0);
        const double radius_m = check_random_between(&any, 0.1, 11.0);
        const float away[2] = {(float)(distance_m * cos(bearing / DEG_PER_RAD)),
                               (float)(distance_m * sin(bearing / DEG_PER_RAD))};
        const double half = DEG_PER_RAD * asin(radius_m / distance_m);
        close_sectors();
        goe_flight_geometry_enter_circle(sector_cm, MAX_CM, away, (float)radius_m, 0.0f);
        for (int i = 0; i < GOE_FLIGHT_SECTORS; i++) {
            const double off = fabs(remainder(5.0 * i - bearing, 360.0));
            if (off < half + 2.4) {
                TEST_ASSERT_UINT16_WITHIN(2u, (uint16_t)(100.0 * (distance_m - radius_m)), sector_cm[i]);
            } else if (off > half + 2.6) {
                TEST_ASSERT_EQUAL_UINT16(GOE_FLIGHT_SECTOR_UNKNOWN, sector_cm[i]);
            }
        }
    }
}

static void the_nearest_counts_and_distant_ones_do_not(void) {
    const float near_m[2] = {20.0f, 0.0f};
    const float far_m[2] = {50.0f, 0.0f};
    const float beyond_m[2] = {-400.0f, 0.0f};
    const float inside_m[2] = {1.0f, 0.0f};
    close_sectors();
    sector_cm[0] = MAX_CM + 1u;
    goe_flight_geometry_enter_circle(sector_cm, MAX_CM, far_m, 2.0f, 0.0f);
    goe_flight_geometry_enter_circle(sector_cm, MAX_CM, near_m, 2.0f, 0.0f);
    goe_flight_geometry_enter_circle(sector_cm, MAX_CM, far_m, 2.0f, 0.0f);
    goe_flight_geometry_enter_circle(sector_cm, MAX_CM, beyond_m, 2.0f, 0.0f);
    TEST_ASSERT_EQUAL_UINT16(1800u, sector_cm[0]);
    TEST_ASSERT_EQUAL_UINT16(GOE_FLIGHT_SECTOR_UNKNOWN, sector_cm[36]);
    goe_flight_geometry_enter_circle(sector_cm, MAX_CM, inside_m, 2.0f, 0.0f);
    for (int i = 0; i < GOE_FLIGHT_SECTORS; i++) {
        TEST_ASSERT_EQUAL_UINT16(1u, sector_cm[i]);
    }
}

/* A circle that may be nearer than max_cm clears nothing, and takes no distance away. */
static void a_circle_that_may_be_near_makes_clear_sectors_unknown(void) {
    const float far_m[2] = {(float)MAX_CM / 100.0f + 30.0f, 0.0f};
    const float near_m[2] = {0.0f, 20.0f};
    const float behind_m[2] = {0.0f, (float)MAX_CM / 100.0f + 30.0f};
    for (int k = 0; k < 2; k++) {
        for (int i = 0; i < GOE_FLIGHT_SECTORS; i++) {
            sector_cm[i] = MAX_CM + 1u;
        }
        goe_flight_geometry_enter_circle(sector_cm, MAX_CM, near_m, 2.0f, 0.0f);
        goe_flight_geometry_enter_circle(sector_cm, MAX_CM, far_m, 2.0f, k == 0 ? 27.9f : 28.1f);
        goe_flight_geometry_enter_circle(sector_cm, MAX_CM, behind_m, 2.0f, 1.0e6f);
        TEST_ASSERT_EQUAL_UINT16(k == 0 ? MAX_CM + 1u : GOE_FLIGHT_SECTOR_UNKNOWN, sector_cm[0]);
        TEST_ASSERT_EQUAL_UINT16(1800u, sector_cm[18]);
        TEST_ASSERT_EQUAL_UINT16(MAX_CM + 1u, sector_cm[36]);
        goe_flight_geometry_enter_circle(sector_cm, MAX_CM, far_m, 40.0f, 0.0f);
        TEST_ASSERT_TRUE(sector_cm[0] <= MAX_CM);
    }
}

/* A camera of a right angle, and its bearing, level: the sectors within 45 degrees of it are clear, and no others. */
static void the_view_turns_with_the_camera(void) {
    goe_camera_t settings;
    goe_flight_camera_t camera;
    memset(&settings, 0, sizeof settings);
    settings.fx_px = settings.fy_px = 500.0f;
    settings.cx_px = settings.cy_px = 500.0f;
    settings.width_px = settings.height_px = 1000.0f;
    settings.mount_yaw_deg = -30.0f;
    memset(&camera, 0, sizeof camera);
    goe_flight_geometry_camera(&camera, &settings);
    for (int k = 0; k < 36; k++) {
        const double half = 0.5 * 10.0 * k / DEG_PER_RAD;
        const float q[4] = {(float)cos(half), 0.0f, 0.0f, (float)sin(half)};
        close_sectors();
        goe_flight_geometry_open_sectors(sector_cm, MAX_CM, &camera, q, 20.0f);
        for (int i = 0; i < GOE_FLIGHT_SECTORS; i++) {
            const bool inside = fabs(remainder(5.0 * i - (10.0 * k - 30.0), 360.0)) < 45.0 - 2.4;
            TEST_ASSERT_EQUAL_UINT16(inside ? MAX_CM + 1u : GOE_FLIGHT_SECTOR_UNKNOWN, sector_cm[i]);
        }
    }
    const float ahead[4] = {1.0f, 0.0f, 0.0f, 0.0f};
    camera.size_px[0] = 0.0f; /* sees nothing */
    close_sectors();
    goe_flight_geometry_open_sectors(sector_cm, MAX_CM, &camera, ahead, 20.0f);
    TEST_ASSERT_EQUAL_UINT16(GOE_FLIGHT_SECTOR_UNKNOWN, sector_cm[66]);
}

/* A vector turned by the quaternion (w, v), in doubles: from + 2 v x (v x from + w from). */
static void turn_exactly(double w, const double v[3], const double from[3], double to[3]) {
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3;
        const int k = (i + 2) % 3;
        const double along_j = v[k] * from[i] - v[i] * from[k] + w * from[j];
        const double along_k = v[i] * from[j] - v[j] * from[i] + w * from[k];
        to[i] = from[i] + 2.0 * (v[j] * along_k - v[k] * along_j);
    }
}

static goe_camera_t lens_of(const goe_flight_camera_t *camera) {
    goe_camera_t lens;
    memset(&lens, 0, sizeof lens);
    lens.k1 = camera->lens[0];
    lens.k2 = camera->lens[1];
    lens.p1 = camera->lens[2];
    lens.p2 = camera->lens[3];
    lens.k3 = camera->lens[4];
    return lens;
}

/* The inverse of the scene's lens, in doubles. */
static void undistort(const goe_flight_camera_t *camera, double *x, double *y) {
    const goe_camera_t lens = lens_of(camera);
    const double to_x = *x;
    const double to_y = *y;
    for (int i = 0; i < 300; i++) {
        double at_x;
        double at_y;
        scene_distort(&lens, *x, *y, &at_x, &at_y);
        *x += 0.3 * (to_x - at_x);
        *y += 0.3 * (to_y - at_y);
    }
}

/* A ray through a pixel, by the definitions of goe.h, in doubles: its bearing. */
static double bearing_through(const goe_flight_camera_t *camera, const float q[4], double u_px, double v_px) {
    const double v[3] = {(double)q[1], (double)q[2], (double)q[3]};
    double seen[3] = {(u_px - (double)camera->center_px[0]) / (double)camera->focal_px[0],
                      (v_px - (double)camera->center_px[1]) / (double)camera->focal_px[1], 1.0};
    double body[3];
    double ned[3];
    undistort(camera, &seen[0], &seen[1]);
    for (int i = 0; i < 3; i++) {
        const float *row = &camera->body_from_camera[3 * i];
        body[i] = (double)row[0] * seen[0] + (double)row[1] * seen[1] + (double)row[2] * seen[2];
    }
    turn_exactly((double)q[0], v, body, ned);
    return DEG_PER_RAD * atan2(ned[1], ned[0]);
}

/* A camera of any mounting, every second one with a lens that is one to one in the image, and an attitude of any heading and a bank of up
 * to 50 degrees. */
static void any_camera(goe_flight_camera_t *camera, float q[4]) {
    goe_camera_t settings;
    memset(&settings, 0, sizeof settings);
    memset(camera, 0, sizeof *camera);
    settings.fx_px = settings.fy_px = (float)check_random_between(&any, 300.0, 1500.0);
    settings.width_px = settings.height_px = 1000.0f;
    settings.cx_px = settings.cy_px = 500.0f;
    if (check_random_between(&any, 0.0, 1.0) < 0.5) {
        const float corner = 707.2f / settings.fx_px; /* in focal lengths; by up to 10 % of it nearer, 20 % farther */
        settings.k1 = (float)check_random_between(&any, -0.1, 0.2) / (corner * corner);
        settings.p1 = (float)check_random_between(&any, -0.01, 0.01) / corner;
        settings.p2 = (float)check_random_between(&any, -0.01, 0.01) / corner;
    }
    settings.mount_yaw_deg = (float)check_random_between(&any, -180.0, 180.0);
    settings.mount_pitch_deg = (float)check_random_between(&any, -90.0, 30.0);
    settings.mount_roll_deg = (float)check_random_between(&any, -30.0, 30.0);
    goe_flight_geometry_camera(camera, &settings);
    const double roll = 0.5 / DEG_PER_RAD * check_random_between(&any, -50.0, 50.0);
    const double yaw = 0.5 / DEG_PER_RAD * check_random_between(&any, -180.0, 180.0);
    q[0] = (float)(cos(yaw) * cos(roll));
    q[1] = (float)(cos(yaw) * sin(roll));
    q[2] = (float)(sin(yaw) * sin(roll));
    q[3] = (float)(sin(yaw) * cos(roll));
}

/* Whether a direction, north, east, down, is in the image, by the definitions of goe.h, in doubles. */
static bool is_shown(const goe_flight_camera_t *camera, const float q[4], const double direction[3]) {
    const double v[3] = {-(double)q[1], -(double)q[2], -(double)q[3]}; /* the inverse */
    double body[3];
    double seen[3] = {0.0, 0.0, 0.0};
    turn_exactly((double)q[0], v, direction, body);
    for (int i = 0; i < 9; i++) {
        seen[i % 3] += (double)camera->body_from_camera[i] * body[i / 3];
    }
    const goe_camera_t lens = lens_of(camera);
    double x;
    double y;
    scene_distort(&lens, seen[0] / seen[2], seen[1] / seen[2], &x, &y);
    const double u = (double)camera->center_px[0] + (double)camera->focal_px[0] * x;
    const double at = (double)camera->center_px[1] + (double)camera->focal_px[1] * y;
    return seen[2] > 0.0 && u > -1.0 && u < (double)camera->size_px[0] + 1.0 && at > -1.0 &&
           at < (double)camera->size_px[1] + 1.0;
}

/* GIVEN any camera, attitude and height THEN every obstacle on flat ground in a clear sector, as high as the aircraft and nearer than the
 * sectors reach, is in the image; and many sectors are clear. */
static void a_clear_sector_shows_any_obstacle_in_it(void) {
    int clear = 0;
    for (int k = 0; k < 2000; k++) {
        goe_flight_camera_t camera;
        float q[4];
        any_camera(&camera, q);
        const double above_m = check_random_between(&any, 0.0, 120.0);
        close_sectors();
        goe_flight_geometry_open_sectors(sector_cm, MAX_CM, &camera, q, (float)above_m);
        for (int i = 0; i < GOE_FLIGHT_SECTORS; i++) {
            if (sector_cm[i] != MAX_CM + 1u) {
                continue;
            }
            clear++;
            const double bearing = (5.0 * i + check_random_between(&any, -2.5, 2.5)) / DEG_PER_RAD;
            const double distance_m = MAX_CM / 100.0 * check_random_between(&any, 0.05, 1.0);
            bool shown = false;
            for (int part = 0; part <= 1000 && !shown; part++) {
                const double direction[3] = {distance_m * cos(bearing), distance_m * sin(bearing),
                                             above_m * part / 1000.0};
                shown = is_shown(&camera, q, direction);
            }
            TEST_ASSERT_TRUE(shown);
        }
    }
    TEST_ASSERT_TRUE(clear > 2000);
}

/* Each pixel of a part of the image, in any camera at any attitude, lies within its bearings; and one of them lies at their end. */
static void bearings_contain_every_pixel_and_no_more(void) {
    int some = 0;
    for (int k = 0; k < 1000; k++) {
        goe_flight_camera_t camera;
        goe_flight_bearings_t bearings;
        double most = 0.0;
        float q[4];
        any_camera(&camera, q);
        float extent[4];
        for (int axis = 0; axis < 2; axis++) {
            extent[axis] = (float)check_random_between(&any, 0.0, 1000.0);
            extent[axis + 2] = extent[axis] + (float)check_random_between(&any, 1.0, 500.0);
        }
        goe_flight_geometry_bearings(&camera, q, extent, &bearings);
        for (int i = 0; i < 17 * 17; i++) {
            const int column = i % 17;
            const int line = i / 17;
            const double u = (double)extent[0] + (double)(extent[2] - extent[0]) * column / 16.0;
            const double v = (double)extent[1] + (double)(extent[3] - extent[1]) * line / 16.0;
            const double off = fabs(remainder(bearing_through(&camera, q, u, v) - bearings.middle_deg, 360.0));
            most = fmax(most, off);
        }
        TEST_ASSERT_TRUE(most <= bearings.half_deg + 1.0); /* middle_deg is a whole number */
        if (bearings.half_deg != GOE_FLIGHT_ANY_BEARING) {
            TEST_ASSERT_TRUE(most >= bearings.half_deg - 2.0);
            some++;
        } else {
            const bool folds = camera.lens[0] < 0.0f && (extent[2] > 1000.0f || extent[3] > 1000.0f);
            TEST_ASSERT_TRUE(most > 88.0 || folds); /* outside the image the lens may have no ray */
        }
    }
    TEST_ASSERT_TRUE(some > 500);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(a_point_is_visible_where_the_scene_draws_it);
    RUN_TEST(nothing_is_detected_behind_the_camera);
    RUN_TEST(latitude_and_longitude);
    RUN_TEST(the_poles_and_far_places_stay_in_range);
    RUN_TEST(the_date_line_is_no_edge);
    RUN_TEST(a_circle_enters_the_sectors_that_it_touches);
    RUN_TEST(the_nearest_counts_and_distant_ones_do_not);
    RUN_TEST(a_circle_that_may_be_near_makes_clear_sectors_unknown);
    RUN_TEST(the_view_turns_with_the_camera);
    RUN_TEST(a_clear_sector_shows_any_obstacle_in_it);
    RUN_TEST(bearings_contain_every_pixel_and_no_more);
    return UNITY_END();
}
