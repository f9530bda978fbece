/* The camera: choice by number, mounting, lens model. SPDX-License-Identifier: MIT */
#ifndef GOE_CAMERA_H
#define GOE_CAMERA_H

#include "goe.h"
#include "maths/goe_scalar.h"

/* Returns the camera of that number; null if there is none. */
static inline const goe_camera_t *goe_camera_of(const goe_settings_t *settings, unsigned number) {
    const goe_camera_t *camera = &settings->camera;
#if GOE_CAMERAS_MAX > 1
    if (number > 0) {
        camera = number < GOE_CAMERAS_MAX ? &settings->more_cameras[number - 1u] : NULL;
        return camera && camera->fx_px > 0.0f ? camera : NULL;
    }
    return camera;
#else
    return number == 0 ? camera : NULL;
#endif
}

/* Computes the rotation camera -> body (FRD) from the mounting angles. */
void goe_camera_mounting(const goe_camera_t *camera, float camera_to_body[9]);

/* Whether any distortion coefficient is not 0. */
static inline bool goe_camera_distorts(const goe_camera_t *camera) {
    return ((goe_bits(camera->k1) | goe_bits(camera->k2) | goe_bits(camera->p1) | goe_bits(camera->p2) |
             goe_bits(camera->k3)) &
            GOE_MAGNITUDE_BITS) != 0u;
}

/* The lens model at the ray (x, y, 1): its image point, and the derivatives of this point. */
typedef struct {
    float x, y;
    float xx, xy, yy; /* of x by x; of x by y, equal to y by x; of y by y */
} goe_distorted_t;

goe_distorted_t goe_camera_distort(const goe_camera_t *camera, float x, float y);

/* Inverts the lens model at the distorted ray (*ray_x, *ray_y, 1). Returns false, and leaves the ray unchanged, if this fails. */
bool goe_camera_undistort(const goe_camera_t *camera, float *ray_x, float *ray_y);

#endif
