/* From a pixel to a ray of the pinhole camera. SPDX-License-Identifier: MIT */
#ifndef GOE_CAMERA_H
#define GOE_CAMERA_H

#include "goe.h"

/* Camera -> body (FRD) of the mounting angles. */
void goe_camera_mounting(const goe_camera_t *camera, float camera_to_body[9]);

/* Whether any distortion coefficient is not 0. */
bool goe_camera_distorts(const goe_camera_t *camera);

/* Inverts the lens model at the distorted ray (*ray_x, *ray_y, 1). False, with the ray untouched, if it cannot be. */
bool goe_camera_undistort(const goe_camera_t *camera, float *ray_x, float *ray_y);

/* The ray (ray_x, ray_y, 1) through a pixel, camera frame, undistorted if asked for. False if the lens model cannot be
 * inverted there. */
static inline bool goe_camera_ray(const goe_camera_t *camera, bool undistorts, const goe_pixel_t *pixel, float *ray_x,
                                  float *ray_y) {
    *ray_x = (pixel->u_px - camera->cx_px) / camera->fx_px;
    *ray_y = (pixel->v_px - camera->cy_px) / camera->fy_px;
    return !undistorts || goe_camera_undistort(camera, ray_x, ray_y);
}

#endif
