/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "camera_model.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#define WIDEST_RADIUS_SQUARED 64.0 /* tan^2 of 83 degrees off the axis: wider lenses need another model */
#define RADIUS_STEPS 4096

camera_t camera_default(void) {
    camera_t camera;
    memset(&camera, 0, sizeof camera);
    camera.width_px = 1280.0;
    camera.height_px = 1280.0;
    camera.fx_px = 914.0;
    camera.fy_px = 914.0;
    camera.cx_px = 640.0;
    camera.cy_px = 640.0;
    camera.mount_yaw_deg = -30.0;
    camera_prepare(&camera);
    return camera;
}

void camera_prepare(camera_t *camera) {
    /* Beyond the radius at which r (1 + k1 r^2 + k2 r^4 + k3 r^6) stops growing, the polynomial folds the outside back into
     * the image. */
    camera->lens_radius2 = WIDEST_RADIUS_SQUARED;
    for (int i = 1; i <= RADIUS_STEPS; i++) {
        const double r2 = WIDEST_RADIUS_SQUARED * (double)i / RADIUS_STEPS;
        if (1.0 + r2 * (3.0 * camera->k1 + r2 * (5.0 * camera->k2 + r2 * 7.0 * camera->k3)) <= 0.0) {
            camera->lens_radius2 = WIDEST_RADIUS_SQUARED * (double)(i - 1) / RADIUS_STEPS;
            return;
        }
    }
}

const char *camera_fault(const camera_t *camera) {
    if (!(camera->width_px >= 1.0 && camera->width_px <= 1e5 && camera->height_px >= 1.0 && camera->height_px <= 1e5)) {
        return "image-width, image-height: the image size must be 1 to 100000 px";
    }
    if (!(camera->fx_px >= 1.0 && camera->fx_px <= 1e5 && camera->fy_px >= 1.0 && camera->fy_px <= 1e5)) {
        return "fx, fy: the focal length must be 1 to 100000 px";
    }
    if (!(fabs(camera->cx_px) <= 1e5 && fabs(camera->cy_px) <= 1e5)) {
        return "cx, cy: the principal point must lie within +-100000 px";
    }
    const double *lens[] = {&camera->k1, &camera->k2, &camera->p1, &camera->p2, &camera->k3};
    for (size_t i = 0; i < sizeof lens / sizeof lens[0]; i++) {
        if (!(fabs(*lens[i]) <= 100.0)) {
            return "k1, k2, p1, p2, k3: the lens coefficients must lie within +-100";
        }
    }
    if (!(fabs(camera->mount_roll_deg) <= 360.0 && fabs(camera->mount_pitch_deg) <= 360.0 &&
          fabs(camera->mount_yaw_deg) <= 360.0)) {
        return "roll-camera, pitch-camera, yaw-camera, second-camera: the mounting angles must lie within +-360 deg";
    }
    if (!(vec3_norm(camera->offset_m) <= 1e4)) {
        return "offset-x, offset-y, offset-z: the camera's offset must lie within 10000 m";
    }
    return NULL;
}

view_t camera_view(const camera_t *camera, const pose_t *pose) {
    /* un-mounted: camera x, y, z = body y, z, x */
    static const mat3_t camera_to_unmounted = {{{0.0, 0.0, 1.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}}};
    const mat3_t body_to_ned = quat_to_matrix(pose->attitude);
    const mat3_t mounting = quat_to_matrix(quat_from_euler(
        radians(camera->mount_roll_deg), radians(camera->mount_pitch_deg), radians(camera->mount_yaw_deg)));
    const mat3_t camera_to_body = mat3_multiply(&mounting, &camera_to_unmounted);
    const mat3_t camera_to_ned = mat3_multiply(&body_to_ned, &camera_to_body);
    view_t view;
    view.eye_ned_m = vec3_add(pose->position_ned_m, mat3_apply(&body_to_ned, camera->offset_m));
    view.ned_to_camera = mat3_transpose(&camera_to_ned);
    return view;
}

bool camera_project(const camera_t *camera, const view_t *view, vec3_t point_ned_m, double *u_px, double *v_px) {
    const vec3_t ray = mat3_apply(&view->ned_to_camera, vec3_sub(point_ned_m, view->eye_ned_m));
    *u_px = ray.x < 0.0 ? -HUGE_VAL : HUGE_VAL;
    *v_px = 0.0;
    if (!(ray.z > CAMERA_NEAREST_M)) {
        return false;
    }
    const double x = ray.x / ray.z, y = ray.y / ray.z;
    const double r2 = x * x + y * y;
    if (r2 > camera->lens_radius2) {
        return false;
    }
    const double radial = 1.0 + r2 * (camera->k1 + r2 * (camera->k2 + r2 * camera->k3));
    const double distorted_x = x * radial + 2.0 * camera->p1 * x * y + camera->p2 * (r2 + 2.0 * x * x);
    const double distorted_y = y * radial + camera->p1 * (r2 + 2.0 * y * y) + 2.0 * camera->p2 * x * y;
    *u_px = camera->fx_px * distorted_x + camera->cx_px;
    *v_px = camera->fy_px * distorted_y + camera->cy_px;
    return true;
}

bool camera_has_lens(const camera_t *camera) {
    const double lens[] = {camera->k1, camera->k2, camera->p1, camera->p2, camera->k3};
    bool lens_bends = false;
    for (size_t i = 0; i < sizeof lens / sizeof lens[0]; i++) {
        lens_bends = lens_bends || fabs(lens[i]) > 0.0;
    }
    return lens_bends;
}

bool camera_in_image(const camera_t *camera, double u_px, double v_px) {
    return u_px >= -0.5 && u_px < camera->width_px - 0.5 && v_px >= -0.5 && v_px < camera->height_px - 0.5;
}
