/* Realistic flights. SPDX-License-Identifier: MIT */
#include "fuzz_scene.h"

#include <math.h>

#define PI 3.14159265f
#define AHEAD_MIN 0.1f /* of a corner's distance: cosine of the angle from the optical axis */

/* --------------------------------------------------------------------------------------------------------- what there is -- */

fuzz_path_t fuzz_any_path(fuzz_input_t *in) {
    fuzz_path_t path;
    memset(&path, 0, sizeof path);
    const uint32_t kind = fuzz_byte(in);
    path.speed_m_s = (kind & 3u) == 3u ? fuzz_between(in, 0.0f, 120.0f) : fuzz_between(in, 8.0f, 25.0f);
    path.height_m = fuzz_between(in, 4.0f, (kind & 64u) != 0 ? 80.0f : 30.0f);
    path.course_rad = fuzz_between(in, -PI, PI);
    path.climb_m_s = (kind & 4u) != 0 ? fuzz_between(in, -3.0f, 3.0f) : 0.0f;
    path.sway_m = (kind & 8u) != 0 ? fuzz_between(in, 0.0f, 20.0f) : 0.0f;
    path.sway_rad_s = fuzz_between(in, 0.1f, 2.0f);
    path.yaw_rad = (kind & 16u) != 0 ? fuzz_between(in, -0.3f, 0.3f) : 0.0f;
    path.pitch_rad = (kind & 16u) != 0 ? fuzz_between(in, -0.2f, 0.2f) : 0.0f;
    path.roll_rad = (kind & 16u) != 0 ? fuzz_between(in, -0.4f, 0.4f) : 0.0f;
    path.swing_rad = (kind & 32u) != 0 ? fuzz_between(in, 0.0f, 0.3f) : 0.01f;
    path.swing_rad_s = fuzz_between(in, 0.3f, 6.0f);
    if ((kind & 192u) == 192u) {
        path.north_m = fuzz_between(in, -9.0e5f, 9.0e5f);
        path.east_m = fuzz_between(in, -1.0e4f, 1.0e4f);
        path.ground_down_m = fuzz_between(in, -500.0f, 500.0f);
    }
    return path;
}

fuzz_solid_t fuzz_any_solid(fuzz_input_t *in, const fuzz_path_t *path) {
    fuzz_solid_t solid;
    memset(&solid, 0, sizeof solid);
    const uint32_t kind = fuzz_byte(in);
    const float ahead_m = fuzz_between(in, 30.0f, 300.0f);
    const float aside_m = fuzz_between(in, -50.0f, 50.0f);
    const float c = cosf(path->course_rad);
    const float s = sinf(path->course_rad);
    solid.round = (kind & 3u) == 3u;
    solid.width_m = fuzz_between(in, 1.0f, 25.0f);
    solid.length_m = (kind & 4u) != 0 ? fuzz_between(in, 0.1f, 60.0f) : fuzz_between(in, 2.0f, 20.0f);
    solid.height_m = fuzz_between(in, 1.0f, 60.0f);
    solid.turn_rad = fuzz_between(in, -PI, PI);
    solid.north_m = path->north_m + ahead_m * c - aside_m * s;
    solid.east_m = path->east_m + ahead_m * s + aside_m * c;
    if ((kind & 24u) == 24u) {
        solid.north_m_s = fuzz_between(in, -15.0f, 15.0f);
        solid.east_m_s = fuzz_between(in, -15.0f, 15.0f);
    }
    solid.ground_down_m = path->ground_down_m;
    return solid;
}

/* Yaw, then pitch, then roll, as a quaternion. */
static void turned(float yaw, float pitch, float roll, float q[4]) {
    const float cy = cosf(0.5f * yaw);
    const float sy = sinf(0.5f * yaw);
    const float cp = cosf(0.5f * pitch);
    const float sp = sinf(0.5f * pitch);
    const float cr = cosf(0.5f * roll);
    const float sr = sinf(0.5f * roll);
    q[0] = cr * cp * cy + sr * sp * sy;
    q[1] = sr * cp * cy - cr * sp * sy;
    q[2] = cr * sp * cy + sr * cp * sy;
    q[3] = cr * cp * sy - sr * sp * cy;
}

void fuzz_path_pose(const fuzz_path_t *path, float t_s, goe_pose_t *pose) {
    const float c = cosf(path->course_rad);
    const float s = sinf(path->course_rad);
    const float along_m = path->speed_m_s * t_s;
    const float aside_m = path->sway_m * sinf(path->sway_rad_s * t_s);
    const float swing = path->swing_rad * sinf(path->swing_rad_s * t_s);
    memset(pose, 0, sizeof *pose);
    pose->height_m = path->height_m + path->climb_m_s * t_s;
    pose->position_ned_m[0] = path->north_m + along_m * c - aside_m * s;
    pose->position_ned_m[1] = path->east_m + along_m * s + aside_m * c;
    pose->position_ned_m[2] = path->ground_down_m - pose->height_m;
    turned(path->course_rad + path->yaw_rad + 0.5f * swing, path->pitch_rad - 0.5f * swing, path->roll_rad + swing,
           pose->attitude);
}

/* ----------------------------------------------------------------------------------------------------- visible features -- */

static void product(const float a[4], const float b[4], float q[4]) {
    q[0] = a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3];
    q[1] = a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2];
    q[2] = a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1];
    q[3] = a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0];
}

static void matrix_of(const float q[4], float m[3][3]) {
    m[0][0] = 1.0f - 2.0f * (q[2] * q[2] + q[3] * q[3]);
    m[0][1] = 2.0f * (q[1] * q[2] - q[0] * q[3]);
    m[0][2] = 2.0f * (q[1] * q[3] + q[0] * q[2]);
    m[1][0] = 2.0f * (q[1] * q[2] + q[0] * q[3]);
    m[1][1] = 1.0f - 2.0f * (q[1] * q[1] + q[3] * q[3]);
    m[1][2] = 2.0f * (q[2] * q[3] - q[0] * q[1]);
    m[2][0] = 2.0f * (q[1] * q[3] - q[0] * q[2]);
    m[2][1] = 2.0f * (q[2] * q[3] + q[0] * q[1]);
    m[2][2] = 1.0f - 2.0f * (q[1] * q[1] + q[2] * q[2]);
}

/* The ring of corners, north and east of the camera. */
static void ring_of(const fuzz_solid_t *solid, float north_m, float east_m, float ring[4][2]) {
    const float distance_m = sqrtf(north_m * north_m + east_m * east_m) + 1.0e-3f;
    const bool outside = distance_m > 0.5f * solid->width_m;
    float c = cosf(solid->turn_rad);
    float s = sinf(solid->turn_rad);
    float half_length = 0.5f * solid->length_m;
    float half_width = 0.5f * solid->width_m;
    float back = 0.0f;
    if (solid->round && outside) { /* tangents: nearer than the middle, and less far aside than the radius */
        const float sine = half_width / distance_m;
        c = north_m / distance_m;
        s = east_m / distance_m;
        back = half_width * sine;
        half_length = half_width;
        half_width *= sqrtf(1.0f - sine * sine);
    }
    for (int i = 0; i < 4; i++) {
        const bool far = i == 2 || i == 3;
        const bool right = i == 1 || i == 2;
        float along = far ? half_length : -half_length;
        float aside = right ? half_width : -half_width;
        if (solid->round) { /* near, right, far, left */
            along = i == 0 ? -half_length : (i == 2 ? half_length : -back);
            aside = i == 1 ? half_width : (i == 3 ? -half_width : 0.0f);
        }
        ring[i][0] = north_m + along * c - aside * s;
        ring[i][1] = east_m + along * s + aside * c;
    }
}

/* Pixel of a point in the axes forward, right, down of the camera. */
static bool project(const goe_camera_t *camera, const float at[3], float *u_px, float *v_px) {
    const float range2 = at[0] * at[0] + at[1] * at[1] + at[2] * at[2];
    if (!(at[0] > 0.0f) || !(at[0] * at[0] > AHEAD_MIN * AHEAD_MIN * range2)) {
        return false;
    }
    const float x = at[1] / at[0];
    const float y = at[2] / at[0];
    const float r2 = x * x + y * y;
    const float radial = 1.0f + r2 * (camera->k1 + r2 * (camera->k2 + r2 * camera->k3));
    *u_px = camera->cx_px + camera->fx_px * (x * radial + 2.0f * camera->p1 * x * y + camera->p2 * (r2 + 2.0f * x * x));
    *v_px = camera->cy_px + camera->fy_px * (y * radial + camera->p1 * (r2 + 2.0f * y * y) + 2.0f * camera->p2 * x * y);
    return true;
}

static int nearest_of(float ring[4][2]) {
    int nearest = 0;
    float least = 0.0f;
    for (int i = 0; i < 4; i++) {
        const float distance2 = ring[i][0] * ring[i][0] + ring[i][1] * ring[i][1];
        if (i == 0 || distance2 < least) {
            nearest = i;
            least = distance2;
        }
    }
    return nearest;
}

/* Columns: forward, right and down of the camera in NED. */
static void axes_of(const goe_camera_t *camera, const goe_pose_t *pose, float axes[3][3]) {
    const float degree = PI / 180.0f;
    float mount[4], q[4];
    turned(camera->mount_yaw_deg * degree, camera->mount_pitch_deg * degree, camera->mount_roll_deg * degree, mount);
    product(pose->attitude, mount, q);
    matrix_of(q, axes);
}

void fuzz_put_ahead(const goe_camera_t *camera, const goe_pose_t *pose, float distance_m, float t_s,
                    fuzz_solid_t *solid) {
    float axes[3][3];
    axes_of(camera, pose, axes);
    solid->north_m = pose->position_ned_m[0] + distance_m * axes[0][0] - solid->north_m_s * t_s;
    solid->east_m = pose->position_ned_m[1] + distance_m * axes[1][0] - solid->east_m_s * t_s;
}

bool fuzz_look(const goe_camera_t *camera, const goe_pose_t *pose, const fuzz_solid_t *solid, float t_s,
               fuzz_sight_t *sight) {
    float body[3][3], axes[3][3], at_m[3], ring[4][2];
    fuzz_sight_t found;
    matrix_of(pose->attitude, body);
    axes_of(camera, pose, axes);
    for (int i = 0; i < 3; i++) {
        at_m[i] = pose->position_ned_m[i] + body[i][0] * camera->offset_m[0] + body[i][1] * camera->offset_m[1] +
                  body[i][2] * camera->offset_m[2];
    }
    ring_of(solid, solid->north_m + solid->north_m_s * t_s - at_m[0], solid->east_m + solid->east_m_s * t_s - at_m[1],
            ring);
    for (int i = 0; i < FUZZ_CORNERS; i++) {
        const float down = solid->ground_down_m - (i < 4 ? 0.0f : solid->height_m) - at_m[2];
        const float *to = ring[i % 4];
        float in_camera[3];
        for (int k = 0; k < 3; k++) {
            in_camera[k] = axes[0][k] * to[0] + axes[1][k] * to[1] + axes[2][k] * down;
        }
        if (!project(camera, in_camera, &found.u_px[i], &found.v_px[i])) {
            return false;
        }
    }
    found.nearest = nearest_of(ring);
    found.round = solid->round;
    *sight = found;
    return true;
}

void fuzz_blur(fuzz_sight_t *sight, fuzz_noise_t *noise, float pixel_px) {
    for (int i = 0; i < FUZZ_CORNERS; i++) {
        sight->u_px[i] += pixel_px * fuzz_noise(noise);
        sight->v_px[i] += pixel_px * fuzz_noise(noise);
    }
}

/* Index of the corner that is farthest in a direction. */
static int most(const float *px, float sign) {
    int found = 0;
    for (int i = 1; i < FUZZ_CORNERS; i++) {
        found = sign * px[i] > sign * px[found] ? i : found;
    }
    return found;
}

static float clamped(float px, float size_px) {
    if (size_px > 0.0f) {
        px = px < 0.0f ? 0.0f : (px > size_px ? size_px : px);
    }
    return px;
}

goe_box_t fuzz_box(const goe_camera_t *camera, const fuzz_sight_t *sight) {
    goe_box_t box;
    memset(&box, 0, sizeof box);
    box.left_px = clamped(sight->u_px[most(sight->u_px, -1.0f)], camera->width_px);
    box.right_px = clamped(sight->u_px[most(sight->u_px, 1.0f)], camera->width_px);
    box.top_px = clamped(sight->v_px[most(sight->v_px, -1.0f)], camera->height_px);
    box.bottom_px = clamped(sight->v_px[most(sight->v_px, 1.0f)], camera->height_px);
    box.sides = box.left_px < box.right_px && box.top_px < box.bottom_px ? GOE_SIDES_ALL : 0u;
    return box;
}

static goe_pixel_t pixel_of(const goe_camera_t *camera, const fuzz_sight_t *sight, int i) {
    goe_pixel_t pixel;
    memset(&pixel, 0, sizeof pixel);
    pixel.u_px = sight->u_px[i];
    pixel.v_px = sight->v_px[i];
    pixel.visible = !(camera->width_px > 0.0f) || (pixel.u_px >= 0.0f && pixel.u_px <= camera->width_px &&
                                                   pixel.v_px >= 0.0f && pixel.v_px <= camera->height_px);
    return pixel;
}

void fuzz_points(const goe_camera_t *camera, const fuzz_sight_t *sight, bool base, goe_image_t *image) {
    const int near = sight->nearest;
    image->left = pixel_of(camera, sight, most(sight->u_px, -1.0f));
    image->right = pixel_of(camera, sight, most(sight->u_px, 1.0f));
    image->top = pixel_of(camera, sight, near + 4);
    if (!base || sight->round) {
        return;
    }
    const int next = (near + 1) % 4;
    const int before = (near + 3) % 4;
    const bool in_order = sight->u_px[next] < sight->u_px[before];
    const int left = in_order ? next : before;
    const int right = in_order ? before : next;
    const bool two_faces = sight->u_px[left] < sight->u_px[near] && sight->u_px[near] < sight->u_px[right];
    const bool near_is_left = sight->u_px[near] <= sight->u_px[left];
    image->base_left = pixel_of(camera, sight, two_faces || !near_is_left ? left : near);
    image->base_right = pixel_of(camera, sight, two_faces || near_is_left ? right : near);
    if (two_faces) {
        image->base_near = pixel_of(camera, sight, near);
    }
}
