/* Noise-free flights. SPDX-License-Identifier: MIT */
#include "scene.h"

#include <math.h>
#include <string.h>

#define RAD_PER_DEG 0.017453292519943295
#define TWO_PI 6.283185307179586
#define FORWARD_MIN 0.051 /* just inside what the library aligns */
#define START_US 1000000

typedef struct {
    double m[3][3];
} matrix_t;

typedef struct {
    double v[3];
} vector_t;

static matrix_t times(matrix_t a, matrix_t b) {
    matrix_t p;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            p.m[i][j] = a.m[i][0] * b.m[0][j] + a.m[i][1] * b.m[1][j] + a.m[i][2] * b.m[2][j];
        }
    }
    return p;
}

static vector_t turned(matrix_t a, vector_t v) {
    vector_t p;
    for (int i = 0; i < 3; i++) {
        p.v[i] = a.m[i][0] * v.v[0] + a.m[i][1] * v.v[1] + a.m[i][2] * v.v[2];
    }
    return p;
}

static matrix_t transposed(matrix_t a) {
    matrix_t t;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            t.m[i][j] = a.m[j][i];
        }
    }
    return t;
}

/* Right-handed rotation about one axis. */
static matrix_t about(int axis, double deg) {
    const double c = cos(deg * RAD_PER_DEG);
    const double s = sin(deg * RAD_PER_DEG);
    const int i = (axis + 1) % 3;
    const int j = (axis + 2) % 3;
    matrix_t r;
    memset(&r, 0, sizeof r);
    r.m[axis][axis] = 1.0;
    r.m[i][i] = c;
    r.m[j][j] = c;
    r.m[i][j] = -s;
    r.m[j][i] = s;
    return r;
}

static matrix_t yaw_pitch_roll(double yaw_deg, double pitch_deg, double roll_deg) {
    return times(about(2, yaw_deg), times(about(1, pitch_deg), about(0, roll_deg)));
}

static void quaternion_of(double yaw_deg, double pitch_deg, double roll_deg, float q[4]) {
    const double half = 0.5 * RAD_PER_DEG;
    const double cy = cos(yaw_deg * half);
    const double sy = sin(yaw_deg * half);
    const double cp = cos(pitch_deg * half);
    const double sp = sin(pitch_deg * half);
    const double cr = cos(roll_deg * half);
    const double sr = sin(roll_deg * half);
    q[0] = (float)(cy * cp * cr + sy * sp * sr);
    q[1] = (float)(cy * cp * sr - sy * sp * cr);
    q[2] = (float)(cy * sp * cr + sy * cp * sr);
    q[3] = (float)(sy * cp * cr - cy * sp * sr);
}

void scene_default(scene_t *scene) {
    memset(scene, 0, sizeof *scene);
    scene->shape = SCENE_BOX;
    scene->width_m = 2.5;
    scene->length_m = 7.0;
    scene->height_m = 2.5;
    scene->x0_m = -12.0;
    scene->z0_m = 100.0;
    scene->path = SCENE_STRAIGHT;
    scene->arc_radius_m = 400.0;
    scene->weave_amplitude_m = 4.0;
    scene->weave_period_s = 5.0;
    scene->speed_mps = 16.0;
    scene->image_rate_hz = 8.0;
    scene->altitude_m = 20.0;
    scene->camera.fx_px = 914.0f;
    scene->camera.fy_px = 914.0f;
    scene->camera.cx_px = 640.0f;
    scene->camera.cy_px = 640.0f;
    scene->camera.width_px = scene->camera.height_px = 0.0f; /* an image without an end */
}

void scene_make_cylinder(scene_t *scene) {
    scene->shape = SCENE_CYLINDER;
    scene->width_m = 6.0;
    scene->height_m = 30.0;
}

void scene_level_ground(goe_settings_t *settings) {
    settings->navigation.height_white_sd_m = 0.0f;
    settings->navigation.terrain_height_sd_m = 0.0f;
    settings->navigation.terrain_slope_sd = 0.0f;
}

void scene_clear_noise(goe_settings_t *settings) {
    settings->detector.point_noise_px = 0.05f;
    settings->navigation.attitude_bias_sd_deg = 1.0e-3f;
    settings->navigation.attitude_white_sd_deg = 1.0e-3f;
    settings->navigation.height_bias_sd_m = 1.0e-2f;
    settings->navigation.velocity_bias_sd_m_s = 0.0f;
    settings->navigation.position_walk_sd_m = 0.0f;
    scene_level_ground(settings);
}

void scene_hide_points(goe_image_t *image) {
    image->left.visible = image->right.visible = image->top.visible = false;
    image->base_left.visible = image->base_near.visible = image->base_right.visible = false;
}

void scene_add_noise(goe_image_t *image, check_random_t *random, double sigma_px) {
    goe_pixel_t *const all[] = {&image->left,      &image->right,     &image->top,
                                &image->base_left, &image->base_near, &image->base_right};
    for (int i = 0; i < 6; i++) {
        all[i]->u_px += (float)(sigma_px * check_random_normal(random));
        all[i]->v_px += (float)(sigma_px * check_random_normal(random));
    }
}

goe_settings_t scene_settings(const scene_t *scene) {
    goe_settings_t settings;
    goe_settings_default(&settings);
    settings.camera = scene->camera;
    return settings;
}

goe_settings_t scene_window_settings(const scene_t *scene) {
    goe_settings_t settings = scene_settings(scene);
    settings.method = GOE_METHOD_WINDOW;
    return settings;
}

scene_t scene_mirrored(const scene_t *scene) {
    scene_t m = *scene;
    m.x0_m = -m.x0_m;
    m.alpha_deg = -m.alpha_deg;
    m.arc_radius_m = -m.arc_radius_m;
    m.weave_amplitude_m = -m.weave_amplitude_m;
    m.yaw_deg = -m.yaw_deg;
    m.roll_deg = -m.roll_deg;
    m.wobble_deg = -m.wobble_deg;
    m.roll_swing_deg = -m.roll_swing_deg;
    m.camera.cx_px = -m.camera.cx_px;
    m.camera.mount_yaw_deg = -m.camera.mount_yaw_deg;
    m.camera.mount_roll_deg = -m.camera.mount_roll_deg;
    m.camera.offset_m[1] = -m.camera.offset_m[1];
    m.camera.p2 = -m.camera.p2;
    return m;
}

scene_t scene_scaled(const scene_t *scene, double scale) {
    scene_t s = *scene;
    s.width_m *= scale;
    s.length_m *= scale;
    s.height_m *= scale;
    s.x0_m *= scale;
    s.z0_m *= scale;
    s.arc_radius_m *= scale;
    s.weave_amplitude_m *= scale;
    s.speed_mps *= scale;
    s.acceleration_mps2 *= scale;
    s.altitude_m *= scale;
    s.start_ned_m[0] *= scale;
    s.start_ned_m[1] *= scale;
    s.ground_d_m *= scale;
    for (int i = 0; i < 3; i++) {
        s.camera.offset_m[i] *= (float)scale;
    }
    return s;
}

/* ----------------------------------------------------------------------------------------------------------- flight -- */

typedef struct {
    vector_t camera_ned_m;
    matrix_t camera_to_ned;
    double heading_deg; /* of T, at the first image */
} flight_t;

static void fly(const scene_t *scene, int k, goe_pose_t *pose, flight_t *flight) {
    const double t = k / scene->image_rate_hz;
    const double along = scene->speed_mps * t + 0.5 * scene->acceleration_mps2 * t * t;
    const double phase = TWO_PI * t / 3.0;
    double forward = along;
    double aside = 0.0;
    double turn_deg = 0.0;
    if (scene->path == SCENE_ARC) {
        const double turn = along / scene->arc_radius_m;
        forward = scene->arc_radius_m * sin(turn);
        aside = scene->arc_radius_m * (1.0 - cos(turn));
        turn_deg = turn / RAD_PER_DEG;
    } else if (scene->path == SCENE_WEAVE) {
        aside = scene->weave_amplitude_m * sin(TWO_PI * t / scene->weave_period_s);
    }
    const double yaw = scene->course_deg + scene->yaw_deg + turn_deg + scene->wobble_deg * sin(phase);
    const double pitch = scene->pitch_deg - scene->glide_deg + fabs(scene->wobble_deg) * cos(1.3 * phase);
    const double swing = scene->roll_swing_deg * sin(TWO_PI * scene->roll_swing_hz * t);
    const double roll = scene->roll_deg + scene->wobble_deg * sin(0.7 * phase + 1.0) + swing;
    const double c = cos(scene->course_deg * RAD_PER_DEG);
    const double s = sin(scene->course_deg * RAD_PER_DEG);
    const double descent = along * tan(scene->glide_deg * RAD_PER_DEG);
    const vector_t vehicle = {{scene->start_ned_m[0] + c * forward - s * aside,
                               scene->start_ned_m[1] + s * forward + c * aside,
                               scene->ground_d_m - scene->altitude_m + descent}};
    const goe_camera_t *camera = &scene->camera;
    const matrix_t body_to_ned = yaw_pitch_roll(yaw, pitch, roll);
    const matrix_t mounting = yaw_pitch_roll(camera->mount_yaw_deg, camera->mount_pitch_deg, camera->mount_roll_deg);
    const matrix_t unmounted = {{{0.0, 0.0, 1.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}}};
    const vector_t offset = {{camera->offset_m[0], camera->offset_m[1], camera->offset_m[2]}};
    const vector_t arm = turned(body_to_ned, offset);

    memset(pose, 0, sizeof *pose);
    pose->time_us = START_US + (int64_t)(t * 1.0e6 + 0.5);
    quaternion_of(yaw, pitch, roll, pose->attitude);
    flight->camera_to_ned = times(body_to_ned, times(mounting, unmounted));
    flight->heading_deg = scene->course_deg + scene->yaw_deg;
    for (int i = 0; i < 3; i++) {
        pose->position_ned_m[i] = (float)vehicle.v[i];
        flight->camera_ned_m.v[i] = vehicle.v[i] + arm.v[i];
    }
    pose->height_m = (float)(scene->ground_d_m - flight->camera_ned_m.v[2]);
}

/* --------------------------------------------------------------------------------------------------------- the image -- */

void scene_distort(const goe_camera_t *camera, double x, double y, double *distorted_x, double *distorted_y) {
    const double r2 = x * x + y * y;
    const double radial =
        1.0 + (double)camera->k1 * r2 + (double)camera->k2 * r2 * r2 + (double)camera->k3 * r2 * r2 * r2;
    *distorted_x = x * radial + 2.0 * (double)camera->p1 * x * y + (double)camera->p2 * (r2 + 2.0 * x * x);
    *distorted_y = y * radial + (double)camera->p1 * (r2 + 2.0 * y * y) + 2.0 * (double)camera->p2 * x * y;
}

/* point: relative to the camera, T axes */
static goe_pixel_t project(const scene_t *scene, const flight_t *flight, vector_t point) {
    const vector_t ned = turned(about(2, flight->heading_deg), (vector_t){{point.v[2], point.v[0], point.v[1]}});
    const vector_t ray = turned(transposed(flight->camera_to_ned), ned);
    const double norm = sqrt(point.v[0] * point.v[0] + point.v[1] * point.v[1] + point.v[2] * point.v[2]);
    goe_pixel_t pixel = {0.0f, 0.0f, false};
    double x;
    double y;
    if (ray.v[2] <= 0.0 || point.v[2] <= FORWARD_MIN * norm) {
        return pixel;
    }
    scene_distort(&scene->camera, ray.v[0] / ray.v[2], ray.v[1] / ray.v[2], &x, &y);
    pixel.u_px = (float)((double)scene->camera.cx_px + (double)scene->camera.fx_px * x);
    pixel.v_px = (float)((double)scene->camera.cy_px + (double)scene->camera.fy_px * y);
    pixel.visible = true;
    return pixel;
}

typedef struct {
    vector_t left, right, top;
    vector_t base[3]; /* left, near, right; on the ground */
    bool base_visible[3];
} points_t;

/* Tangent points at half height, and the point of the top's rim that is highest in the image, or nearest. */
static void cylinder_points(const scene_t *scene, double x, double z, double h, points_t *points) {
    const double r = 0.5 * scene->width_m;
    const double d2 = x * x + z * z;
    const double along = 1.0 - r * r / d2; /* foot of the tangent, in shares of the way to the center */
    const double across = r * sqrt(d2 - r * r) / d2;
    const double middle = h - 0.5 * scene->height_m;
    points->left = (vector_t){{x * along - z * across, middle, z * along + x * across}};
    points->right = (vector_t){{x * along + z * across, middle, z * along - x * across}};
    points->top = (vector_t){{x, h - scene->height_m, scene->height_m > h ? z - r : z + r}};
    if (scene->top_nearest) {
        const double share = 1.0 - r / sqrt(d2);
        points->top = (vector_t){{x * share, h - scene->height_m, z * share}};
    }
    memset(points->base_visible, 0, sizeof points->base_visible);
}

/* Horizontal. */
static double range2(vector_t v) { return v.v[0] * v.v[0] + v.v[2] * v.v[2]; }

static void box_points(const scene_t *scene, double x, double z, double h, points_t *points) {
    const double s = sin(scene->alpha_deg * RAD_PER_DEG);
    const double c = cos(scene->alpha_deg * RAD_PER_DEG);
    const double half = 0.5 * scene->width_m;
    const double l = scene->length_m;
    const vector_t front_left = {{x - half * c, h, z + half * s}};
    const vector_t front_right = {{x + half * c, h, z - half * s}};
    const vector_t back_left = {{front_left.v[0] + l * s, h, front_left.v[2] + l * c}};
    const vector_t back_right = {{front_right.v[0] + l * s, h, front_right.v[2] + l * c}};
    const vector_t corners[4] = {front_left, front_right, back_left, back_right};
    const bool front_visible = x * s + z * c > 0.0;
    const bool right_visible = front_right.v[0] * c - front_right.v[2] * s < 0.0;
    const bool left_visible = front_left.v[0] * c - front_left.v[2] * s > 0.0;
    int leftmost = 0;
    int rightmost = 0;
    int highest = 0;
    int nearest = 0;
    for (int i = 1; i < 4; i++) {
        const double tangent = corners[i].v[0] / corners[i].v[2];
        const double nearness = (scene->height_m > h ? -1.0 : 1.0) * (corners[i].v[2] - corners[highest].v[2]);
        leftmost = tangent < corners[leftmost].v[0] / corners[leftmost].v[2] ? i : leftmost;
        rightmost = tangent > corners[rightmost].v[0] / corners[rightmost].v[2] ? i : rightmost;
        highest = nearness > 0.0 ? i : highest;
        nearest = range2(corners[i]) < range2(corners[nearest]) ? i : nearest;
    }
    points->left = corners[leftmost];
    points->right = corners[rightmost];
    points->top = corners[scene->top_nearest ? nearest : highest];
    points->left.v[1] = h - 0.5 * scene->height_m;
    points->right.v[1] = h - 0.5 * scene->height_m;
    points->top.v[1] = h - scene->height_m;

    points->base[0] = left_visible ? back_left : front_left;
    points->base[1] = left_visible ? front_left : front_right;
    points->base[2] = right_visible ? back_right : front_right;
    points->base_visible[0] = front_visible;
    points->base_visible[1] = front_visible && (left_visible || right_visible);
    points->base_visible[2] = front_visible;
}

static void give_points(const points_t *points, scene_truth_t *truth) {
    truth->left_x = points->left.v[0] / points->left.v[2];
    truth->right_x = points->right.v[0] / points->right.v[2];
    truth->top_y = points->top.v[1] / points->top.v[2];
    truth->top_z_m = points->top.v[2];
    for (int i = 0; i < 3; i++) {
        truth->base_visible[i] = points->base_visible[i];
        truth->base_x[i] = points->base_visible[i] ? points->base[i].v[0] / points->base[i].v[2] : 0.0;
        truth->base_y[i] = points->base_visible[i] ? points->base[i].v[1] / points->base[i].v[2] : 0.0;
        truth->base_z_m[i] = points->base_visible[i] ? points->base[i].v[2] : 0.0;
    }
}

/* ---------------------------------------------------------------------------------------------------- bounding boxes -- */

#define RIM_POINTS 48

/* Corner or rim point i of the footprint, relative to the camera, T axes, at the height of the camera. */
static vector_t footprint_point(const scene_t *scene, double x, double z, int i) {
    const double angle = TWO_PI * i / RIM_POINTS;
    const double s = sin(scene->alpha_deg * RAD_PER_DEG);
    const double c = cos(scene->alpha_deg * RAD_PER_DEG);
    const double across = i % 2 == 0 ? -0.5 * scene->width_m : 0.5 * scene->width_m;
    const double along = i < 2 ? 0.0 : scene->length_m;
    if (scene->shape == SCENE_BOX) {
        return (vector_t){{x + across * c + along * s, 0.0, z - across * s + along * c}};
    }
    return (vector_t){{x + 0.5 * scene->width_m * cos(angle), 0.0, z + 0.5 * scene->width_m * sin(angle)}};
}

typedef struct {
    float left, top, right, bottom;
} frame_t;

/* False if a point of the obstacle is not ahead. */
static bool frame_of(const scene_t *scene, const flight_t *flight, const scene_truth_t *at, frame_t *frame) {
    const int points = scene->shape == SCENE_BOX ? 4 : RIM_POINTS;
    bool ahead = true;
    for (int i = 0; i < 2 * points; i++) {
        vector_t point = footprint_point(scene, at->x_m, at->z_m, i / 2);
        point.v[1] = at->height_above_ground_m - (i % 2 == 0 ? 0.0 : scene->height_m);
        const goe_pixel_t p = project(scene, flight, point);
        ahead = ahead && p.visible;
        frame->left = i == 0 || p.u_px < frame->left ? p.u_px : frame->left;
        frame->right = i == 0 || p.u_px > frame->right ? p.u_px : frame->right;
        frame->top = i == 0 || p.v_px < frame->top ? p.v_px : frame->top;
        frame->bottom = i == 0 || p.v_px > frame->bottom ? p.v_px : frame->bottom;
    }
    return ahead;
}

static void see_upright_box(const scene_t *scene, const flight_t *flight, const scene_truth_t *at, goe_image_t *image) {
    frame_t f = {0.0f, 0.0f, 0.0f, 0.0f};
    const bool seen = frame_of(scene, flight, at, &f);
    if (scene->boxes) {
        scene_hide_points(image);
        image->box = (goe_box_t){f.left, f.top, f.right, f.bottom, seen ? GOE_SIDES_ALL : 0u};
        return;
    }
    image->left = (goe_pixel_t){f.left, 0.5f * (f.top + f.bottom), seen};
    image->right = (goe_pixel_t){f.right, 0.5f * (f.top + f.bottom), seen};
    image->top = (goe_pixel_t){0.5f * (f.left + f.right), f.top, seen};
    image->base_left.visible = image->base_near.visible = image->base_right.visible = false;
}

/* --------------------------------------------------------------------------------------------------------- the image -- */

void scene_image(const scene_t *scene, int k, goe_image_t *image, scene_truth_t *truth) {
    goe_pose_t first_pose;
    flight_t first;
    flight_t now;
    points_t points;
    scene_truth_t ignored;
    scene_truth_t *reported = truth ? truth : &ignored;
    memset(image, 0, sizeof *image);
    memset(reported, 0, sizeof *reported);
    fly(scene, 0, &first_pose, &first);
    fly(scene, k, &image->pose, &now);
    const double c = cos(now.heading_deg * RAD_PER_DEG);
    const double s = sin(now.heading_deg * RAD_PER_DEG);
    const double north = now.camera_ned_m.v[0] - first.camera_ned_m.v[0];
    const double east = now.camera_ned_m.v[1] - first.camera_ned_m.v[1];
    reported->dx_m = c * east - s * north;
    reported->dz_m = c * north + s * east;
    reported->x_m = scene->x0_m - reported->dx_m;
    reported->z_m = scene->z0_m - reported->dz_m;
    reported->height_above_ground_m = scene->ground_d_m - now.camera_ned_m.v[2];
    if (scene->shape == SCENE_BOX) {
        box_points(scene, reported->x_m, reported->z_m, reported->height_above_ground_m, &points);
    } else {
        cylinder_points(scene, reported->x_m, reported->z_m, reported->height_above_ground_m, &points);
    }
    give_points(&points, reported);
    const double half = scene->shape == SCENE_BOX ? 0.5 * scene->length_m : 0.0;
    const double center_x = reported->x_m + half * sin(scene->alpha_deg * RAD_PER_DEG);
    const double center_z = reported->z_m + half * cos(scene->alpha_deg * RAD_PER_DEG);
    reported->center_north_m = now.camera_ned_m.v[0] + c * center_z - s * center_x;
    reported->center_east_m = now.camera_ned_m.v[1] + s * center_z + c * center_x;
    image->left = project(scene, &now, points.left);
    image->right = project(scene, &now, points.right);
    image->top = project(scene, &now, points.top);
    goe_pixel_t *base[3] = {&image->base_left, &image->base_near, &image->base_right};
    for (int i = 0; i < 3; i++) {
        if (points.base_visible[i]) {
            *base[i] = project(scene, &now, points.base[i]);
        }
    }
    if (scene->upright_boxes || scene->boxes) {
        see_upright_box(scene, &now, reported, image);
    }
}
