/* The camera's mounting and its lens model. SPDX-License-Identifier: MIT */
#include "image/goe_camera.h"

#include "maths/goe_rotation.h"
#include "maths/goe_scalar.h"

#define UNDISTORT_ROUNDS 20
#define UNDISTORT_DONE 1.0e-7f   /* focal lengths; smaller steps are rounding */
#define UNDISTORT_FAILED 1.0e-4f /* focal lengths; with a larger last step it did not converge */
#define RAY_MAX 20.0f            /* 87 degrees off the axis: farther out no lens model is valid */
#define RADIAL_MIN 0.05f

void goe_camera_mounting(const goe_camera_t *camera, float camera_to_body[9]) {
    float turn[9];
    goe_rotation_from_euler(camera->mount_yaw_deg, camera->mount_pitch_deg, camera->mount_roll_deg, turn);
    for (int row = 0; row < 3; row++) { /* without mounting angles: camera x, y, z = body y, z, x */
        camera_to_body[3 * row] = turn[3 * row + 1];
        camera_to_body[3 * row + 1] = turn[3 * row + 2];
        camera_to_body[3 * row + 2] = turn[3 * row];
    }
}

/* Brown-Conrady model. */
goe_distorted_t goe_camera_distort(const goe_camera_t *camera, float x, float y) {
    const float r2 = x * x + y * y;
    const float radial = 1.0f + r2 * (camera->k1 + r2 * (camera->k2 + r2 * camera->k3));
    const float slope =
        2.0f * (camera->k1 + r2 * (2.0f * camera->k2 + 3.0f * r2 * camera->k3)); /* derivative of radial by r2 / 2 */
    const float p1 = camera->p1;
    const float p2 = camera->p2;
    goe_distorted_t to;
    to.x = x * radial + 2.0f * p1 * x * y + p2 * (r2 + 2.0f * x * x);
    to.y = y * radial + p1 * (r2 + 2.0f * y * y) + 2.0f * p2 * x * y;
    to.xx = radial + x * x * slope + 2.0f * p1 * y + 6.0f * p2 * x;
    to.xy = x * y * slope + 2.0f * p1 * x + 2.0f * p2 * y;
    to.yy = radial + y * y * slope + 6.0f * p1 * y + 2.0f * p2 * x;
    return to;
}

/* Brown-Conrady model, inverted by the fixed-point iteration x <- (x_distorted - tangential(x)) / radial(x). */
bool goe_camera_undistort(const goe_camera_t *camera, float *ray_x, float *ray_y) {
    const float distorted_x = *ray_x;
    const float distorted_y = *ray_y;
    float x = distorted_x;
    float y = distorted_y;
    float step = 0.0f;
    for (int turn = 0; turn < UNDISTORT_ROUNDS; turn++) {
        const float r2 = x * x + y * y;
        const float radial = 1.0f + r2 * (camera->k1 + r2 * (camera->k2 + r2 * camera->k3));
        if (!goe_within(radial, 1.0e6f) || radial < RADIAL_MIN) {
            return false;
        }
        const float tangential_x = 2.0f * camera->p1 * x * y + camera->p2 * (r2 + 2.0f * x * x);
        const float tangential_y = camera->p1 * (r2 + 2.0f * y * y) + 2.0f * camera->p2 * x * y;
        const float next_x = (distorted_x - tangential_x) / radial;
        const float next_y = (distorted_y - tangential_y) / radial;
        if (!goe_within(next_x, RAY_MAX) || !goe_within(next_y, RAY_MAX)) {
            return false;
        }
        step = goe_larger(goe_absolute(next_x - x), goe_absolute(next_y - y));
        x = next_x;
        y = next_y;
        if (step <= UNDISTORT_DONE) {
            break;
        }
    }
    if (step > UNDISTORT_FAILED) {
        return false;
    }
    *ray_x = x;
    *ray_y = y;
    return true;
}
