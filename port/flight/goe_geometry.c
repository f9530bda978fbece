/* Pixels of positions, latitude and longitude, bearings and sectors. SPDX-License-Identifier: MIT */
#include "goe_geometry.h"

#include <math.h>

#include "goe_flight_maths.h"

#define DEPTH_MIN_M 0.5f
#define E7_PER_M 89.9322f /* 1e7 degrees of latitude on a sphere of 6371 km */
#define E7_MAX 9.0e8f     /* 90 degrees */
#define POLE_COSINE_MIN 0.017f
#define TURN_E7 3600000000
#define LENS_ROUNDS 16
#define LENS_OFF 1.0e-3f /* tolerance in focal lengths: less than a tenth of a degree */
#define AHEAD_MIN 0.02f  /* least component of a direction along the optical axis */
#define STEEP 100.0f     /* tangent that counts as a right angle of bearings: straight down or up may be in between */
#define SECTOR_DEG 5.0f
#define SECTOR_COS 0.99619470f /* of SECTOR_DEG */
#define SECTOR_SIN 0.08715574f
#define HALF_COS 0.99904822f /* of half a sector */
#define HALF_SIN 0.04361939f
#define CM_PER_M 100.0f
#define TOUCH_MIN 1u /* cm; for some readers 0 has another meaning */

/* ------------------------------------------------------------------------------------------------------------ camera -- */

/* The mounting, as defined at goe_camera_t: without it camera x, y, z are body y, z, x; then yaw, pitch, roll. */
static void mount(const goe_camera_t *settings, float r[9]) {
    float sy;
    float cy;
    float sp;
    float cp;
    float sr;
    float cr;
    goe_flight_sincos_deg(settings->mount_yaw_deg, &sy, &cy);
    goe_flight_sincos_deg(settings->mount_pitch_deg, &sp, &cp);
    goe_flight_sincos_deg(settings->mount_roll_deg, &sr, &cr);
    const float turned[9] = {cy * cp,
                             cy * sp * sr - sy * cr,
                             cy * sp * cr + sy * sr,
                             sy * cp,
                             sy * sp * sr + cy * cr,
                             sy * sp * cr - cy * sr,
                             -sp,
                             cp * sr,
                             cp * cr};
    for (int i = 0; i < 3; i++) {
        r[3 * i] = turned[3 * i + 1];
        r[3 * i + 1] = turned[3 * i + 2];
        r[3 * i + 2] = turned[3 * i];
    }
}

void goe_flight_geometry_camera(goe_flight_camera_t *camera, const goe_camera_t *settings) {
    mount(settings, camera->body_from_camera);
    memcpy(camera->offset_m, settings->offset_m, sizeof camera->offset_m);
    const float lens[5] = {settings->k1, settings->k2, settings->p1, settings->p2, settings->k3};
    memcpy(camera->lens, lens, sizeof camera->lens);
    camera->focal_px[0] = settings->fx_px;
    camera->focal_px[1] = settings->fy_px;
    camera->center_px[0] = settings->cx_px;
    camera->center_px[1] = settings->cy_px;
    camera->size_px[0] = settings->width_px;
    camera->size_px[1] = settings->height_px;
    camera->border_px = settings->border_rel * settings->width_px;
}

/* The Brown-Conrady model of goe_camera_t; x and y in focal lengths. The third number is the larger of the two slopes, along and across the
 * radius. Returns false where the radial part folds back: nothing there is in the image, although its distorted point may be. */
static bool distort(const float lens[5], float x, float y, float distorted[3]) {
    const float square = x * x + y * y;
    const float radial = 1.0f + square * (lens[0] + square * (lens[1] + square * lens[4]));
    const float slope = 1.0f + square * (3.0f * lens[0] + square * (5.0f * lens[1] + 7.0f * square * lens[4]));
    distorted[0] = x * radial + 2.0f * lens[2] * x * y + lens[3] * (square + 2.0f * x * x);
    distorted[1] = y * radial + lens[2] * (square + 2.0f * y * y) + 2.0f * lens[3] * x * y;
    distorted[2] = goe_flight_larger(radial, slope);
    return slope > 0.0f;
}

/* The inverse, by x <- x + (distorted - distort(x)) / slope. The larger slope avoids overshoots. Returns false if it does not converge. */
static bool undistort(const float lens[5], const float distorted[2], float *x, float *y) {
    *x = distorted[0];
    *y = distorted[1];
    for (int turn = 0; turn < LENS_ROUNDS; turn++) {
        float again[3];
        if (!distort(lens, *x, *y, again)) {
            return false;
        }
        const float off_x = distorted[0] - again[0];
        const float off_y = distorted[1] - again[1];
        if (goe_flight_within(off_x, LENS_OFF) && goe_flight_within(off_y, LENS_OFF)) {
            return true;
        }
        *x += off_x / again[2];
        *y += off_y / again[2];
    }
    return false;
}

bool goe_flight_geometry_project(const goe_flight_camera_t *camera, const goe_flight_history_pose_t *pose,
                                 const float point_ned_m[3], float pixel[2]) {
    float body_to_ned[9];
    float away[3];
    float body[3];
    float seen[3];
    goe_flight_rotation(pose->q, body_to_ned);
    for (int i = 0; i < 3; i++) {
        away[i] = point_ned_m[i] - pose->ned_m[i];
    }
    goe_flight_turn_back(body_to_ned, away, body);
    for (int i = 0; i < 3; i++) {
        body[i] -= camera->offset_m[i];
    }
    goe_flight_turn_back(camera->body_from_camera, body, seen);
    if (!(seen[2] > DEPTH_MIN_M)) {
        return false;
    }
    float shown[3];
    bool inside = distort(camera->lens, seen[0] / seen[2], seen[1] / seen[2], shown);
    for (int i = 0; i < 2; i++) {
        pixel[i] = camera->center_px[i] + camera->focal_px[i] * shown[i];
        inside = inside && goe_flight_within(pixel[i] - 0.5f * camera->size_px[i], camera->size_px[i]);
    }
    return inside;
}

/* ------------------------------------------------------------------------------------------------------------- earth -- */

static int32_t wrapped_e7(int64_t lon_e7) {
    if (lon_e7 > TURN_E7 / 2) {
        return (int32_t)(lon_e7 - TURN_E7);
    }
    return (int32_t)(lon_e7 < -TURN_E7 / 2 ? lon_e7 + TURN_E7 : lon_e7);
}

static int32_t rounded(float x) { return (int32_t)(x + (x < 0.0f ? -0.5f : 0.5f)); }

void goe_flight_geometry_lat_lon(int32_t origin_lat_e7, int32_t origin_lon_e7, const float ne_m[2], int32_t *lat_e7,
                                 int32_t *lon_e7) {
    float sine;
    float cosine;
    goe_flight_sincos_deg((float)origin_lat_e7 * 1.0e-7f, &sine, &cosine);
    const float across = E7_PER_M / goe_flight_larger(cosine, POLE_COSINE_MIN);
    const float north = goe_flight_clamped(ne_m[0] * E7_PER_M, -E7_MAX, E7_MAX);
    const float east = goe_flight_clamped(ne_m[1] * across, -E7_MAX, E7_MAX);
    const int64_t lat = (int64_t)origin_lat_e7 + rounded(north);
    const int32_t most = (int32_t)E7_MAX;
    *lat_e7 = lat > most ? most : (lat < -most ? -most : (int32_t)lat);
    *lon_e7 = wrapped_e7((int64_t)origin_lon_e7 + rounded(east));
}

/* ---------------------------------------------------------------------------------------------------------- bearings -- */

/* The ray through a pixel: north, east, down, of any length. Returns false if the lens model has none there. */
static bool look_through(const goe_flight_camera_t *camera, const float body_to_ned[9], float u_px, float v_px,
                         float ray[3]) {
    const float shown[2] = {(u_px - camera->center_px[0]) / camera->focal_px[0],
                            (v_px - camera->center_px[1]) / camera->focal_px[1]};
    float seen[3] = {0.0f, 0.0f, 1.0f};
    float body[3];
    const bool found = undistort(camera->lens, shown, &seen[0], &seen[1]);
    goe_flight_turn(camera->body_from_camera, seen, body);
    goe_flight_turn(body_to_ned, body, ray);
    return found;
}

/* Difference of two angles, from -180 to 180. */
static float apart_deg(float from_deg, float to_deg) {
    return goe_flight_positive_deg(to_deg - from_deg + 180.0f) - 180.0f;
}

/* The camera's axes x, y and optical axis, as north, east, down. */
static void find_axes(const goe_flight_camera_t *camera, const float q[4], float axis[3][3]) {
    float body_to_ned[9];
    goe_flight_rotation(q, body_to_ned);
    for (int i = 0; i < 3; i++) {
        const float *r = camera->body_from_camera;
        const float column[3] = {r[i], r[3 + i], r[6 + i]};
        goe_flight_turn(body_to_ned, column, axis[i]);
    }
}

static float dot(const float a[3], const float b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* Whether a direction is in the image. */
static bool is_visible(const goe_flight_camera_t *camera, float axis[3][3], const float direction[3]) {
    const float ahead = dot(axis[2], direction);
    float shown[3];
    if (!(ahead > AHEAD_MIN) ||
        !distort(camera->lens, dot(axis[0], direction) / ahead, dot(axis[1], direction) / ahead, shown)) {
        return false;
    }
    bool visible = true;
    for (int i = 0; i < 2; i++) {
        const float px = camera->center_px[i] + camera->focal_px[i] * shown[i];
        visible = visible && px >= 0.0f && px <= camera->size_px[i];
    }
    return visible;
}

void goe_flight_geometry_open_sectors(uint16_t sector_cm[GOE_FLIGHT_SECTORS], uint32_t max_cm,
                                      const goe_flight_camera_t *camera, const float q[4], float above_m) {
    float axis[3][3];
    float edge[3] = {HALF_COS, -HALF_SIN, above_m * CM_PER_M / (float)max_cm}; /* left edge of sector 0 */
    bool left = false;
    find_axes(camera, q, axis);
    for (int i = -1; i < GOE_FLIGHT_SECTORS; i++) {
        const bool visible = is_visible(camera, axis, edge);
        if (left && visible) {
            sector_cm[i] = (uint16_t)(max_cm + 1u);
        }
        left = visible;
        const float north = SECTOR_COS * edge[0] - SECTOR_SIN * edge[1];
        edge[1] = SECTOR_SIN * edge[0] + SECTOR_COS * edge[1];
        edge[0] = north;
    }
}

void goe_flight_geometry_bearings(const goe_flight_camera_t *camera, const float q[4], const float extent_px[4],
                                  goe_flight_bearings_t *bearings) {
    float body_to_ned[9];
    float middle[3];
    float ray[3];
    float tangent = 0.0f; /* of the corner farthest from the middle */
    goe_flight_rotation(q, body_to_ned);
    bool unknown = !look_through(camera, body_to_ned, 0.5f * (extent_px[0] + extent_px[2]),
                                 0.5f * (extent_px[1] + extent_px[3]), middle);
    for (int i = 0; i < 9; i++) { /* corners, middles of the sides (a lens bends these outward), i = 4: the middle */
        const int row = i / 3;
        const float right = 0.5f * (float)(i % 3);
        const float down = 0.5f * (float)row;
        unknown = !look_through(camera, body_to_ned, extent_px[0] + right * (extent_px[2] - extent_px[0]),
                                extent_px[1] + down * (extent_px[3] - extent_px[1]), ray) ||
                  unknown;
        const float across = goe_flight_absolute(middle[0] * ray[1] - middle[1] * ray[0]);
        const float along = middle[0] * ray[0] + middle[1] * ray[1];
        unknown = unknown || along * STEEP <= across;
        tangent = unknown ? tangent : goe_flight_larger(tangent, across / along);
    }
    const float half_deg = goe_flight_atan2_deg(tangent, 1.0f) + 1.0f; /* rounded up to whole degrees */
    const float middle_deg = goe_flight_positive_deg(goe_flight_atan2_deg(middle[1], middle[0]));
    bearings->middle_deg = (int16_t)middle_deg;
    bearings->half_deg = unknown ? GOE_FLIGHT_ANY_BEARING : (int16_t)half_deg;
}

void goe_flight_geometry_close_sectors(uint16_t sector_cm[GOE_FLIGHT_SECTORS], const goe_flight_bearings_t *bearings,
                                       float widen_deg) {
    for (int i = 0; i < GOE_FLIGHT_SECTORS; i++) {
        const float off_deg = apart_deg((float)bearings->middle_deg, (float)i * SECTOR_DEG);
        if (goe_flight_within(off_deg, (float)bearings->half_deg + widen_deg + 0.5f * SECTOR_DEG)) {
            sector_cm[i] = GOE_FLIGHT_SECTOR_UNKNOWN;
        }
    }
}

static float near_side_cm(const float away_ne_m[2], float radius_m) {
    const float square = away_ne_m[0] * away_ne_m[0] + away_ne_m[1] * away_ne_m[1];
    return goe_flight_larger(sqrtf(square) - radius_m, 0.0f) * CM_PER_M;
}

bool goe_flight_geometry_reaches(uint32_t max_cm, const float away_ne_m[2], float radius_m, float nearer_m) {
    return !(near_side_cm(away_ne_m, radius_m) - nearer_m * CM_PER_M > (float)max_cm);
}

/* Keeps the nearest distance. GOE_FLIGHT_SECTOR_UNKNOWN replaces "clear", but no distance. */
static void enter(uint16_t *sector_cm, uint16_t cm, uint32_t max_cm) {
    if (cm < *sector_cm || *sector_cm > max_cm) {
        *sector_cm = cm;
    }
}

void goe_flight_geometry_enter_circle(uint16_t sector_cm[GOE_FLIGHT_SECTORS], uint32_t max_cm, const float away_ne_m[2],
                                      float radius_m, float nearer_m) {
    if (!goe_flight_geometry_reaches(max_cm, away_ne_m, radius_m, nearer_m)) {
        return;
    }
    const float square = away_ne_m[0] * away_ne_m[0] + away_ne_m[1] * away_ne_m[1];
    const float outside = square - radius_m * radius_m;
    const float near_cm = near_side_cm(away_ne_m, radius_m);
    const bool beyond = near_cm > (float)max_cm;
    const float within_cm = goe_flight_larger(near_cm, (float)TOUCH_MIN);
    const uint16_t cm = beyond ? GOE_FLIGHT_SECTOR_UNKNOWN : (uint16_t)within_cm;
    const float half_deg = outside > 0.0f ? goe_flight_atan2_deg(radius_m, sqrtf(outside)) : 180.0f;
    const float bearing_deg = goe_flight_atan2_deg(away_ne_m[1], away_ne_m[0]);
    for (int i = 0; i < GOE_FLIGHT_SECTORS; i++) {
        const float off_deg = apart_deg(bearing_deg, (float)i * SECTOR_DEG);
        if (goe_flight_within(off_deg, half_deg + 0.5f * SECTOR_DEG)) {
            enter(&sector_cm[i], cm, max_cm);
        }
    }
}
