/* Aligned image points: what a camera that looks along T's Z axis would see. SPDX-License-Identifier: MIT */
#ifndef GOE_ALIGN_H
#define GOE_ALIGN_H

#include "image/goe_fault.h"

/* In units of the focal length: X/Z and Y/Z of the ray in T. x and y hold only if usable. */
typedef struct {
    float x, y;
    bool usable;
} goe_point_t;

typedef struct {
    goe_point_t left, right, top, base_left, base_near, base_right;
} goe_view_t;

/* The points are read as an array, too. */
typedef char goe_view_is_points_t[sizeof(goe_view_t) == GOE_FEATURES * sizeof(goe_point_t) ? 1 : -1];

/* Aligns every seen feature; one that is not seen, or that meets GOE_BEHIND_CAMERA or GOE_LENS_FAILED, is not usable. */
void goe_align_view(const goe_camera_t *camera, const float camera_to_trajectory[9], const goe_image_t *image,
                    goe_view_t *view, goe_faults_t *faults);

#endif
