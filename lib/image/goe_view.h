/* One image, aligned: what both methods see of it. SPDX-License-Identifier: MIT */
#ifndef GOE_VIEW_H
#define GOE_VIEW_H

#include "goe.h"

/* The features of an image, in its order. */
typedef enum {
    GOE_POINT_LEFT,
    GOE_POINT_RIGHT,
    GOE_POINT_TOP,
    GOE_POINT_BASE_LEFT,
    GOE_POINT_BASE_NEAR,
    GOE_POINT_BASE_RIGHT,
    GOE_POINT_COUNT
} goe_feature_t;

GOE_STATIC_ASSERT(GOE_POINT_COUNT == GOE_FEATURES, every_feature_has_a_name);

/* An aligned image point: what a camera that looks along T's Z axis would see, X/Z and Y/Z of the ray in T, in units of the
 * focal length. x and y hold only if usable. */
typedef struct {
    float x, y;
    bool usable; /* seen, ahead, and within the lens model */
} goe_point_t;

typedef struct {
    goe_point_t point[GOE_FEATURES]; /* by goe_feature_t */
    const goe_image_t *image;        /* as it was given */
    const goe_motion_t *motion;      /* the track's own motion up to this image */
    const float *camera_to_body;     /* rotations, row by row */
    float camera_to_trajectory[9];
} goe_view_t;

static inline bool goe_image_seen(const goe_image_t *image) {
    return image->left.seen || image->right.seen || image->top.seen || image->base_left.seen || image->base_near.seen ||
           image->base_right.seen;
}

#endif
