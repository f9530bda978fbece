/* The aligned view of one image: the common input of both methods. SPDX-License-Identifier: MIT */
#ifndef GOE_VIEW_H
#define GOE_VIEW_H

#include "goe.h"

/* The features of an image, in the order of goe_image_t. */
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

/* An aligned image point: X/Z and Y/Z of the ray in T, in units of the focal length, as in a camera that looks along T's Z axis. x and y
 * are valid only if usable. */
typedef struct {
    float x, y;
    bool usable; /* visible, ahead, and within the lens model */
} goe_point_t;

/* The sides of a box. */
typedef enum { GOE_BOX_LEFT, GOE_BOX_TOP, GOE_BOX_RIGHT, GOE_BOX_BOTTOM, GOE_BOX_SIDES } goe_box_side_t;

typedef struct {
    float px[GOE_BOX_SIDES]; /* in the raw image */
    uint8_t usable;          /* mask of GOE_SIDE_... */
    uint8_t doubtful;        /* mask: sides that the border may cut, by the error of a detector */
    uint8_t cut;             /* mask: sides that are missing, or near the border */
    uint8_t ends;            /* mask: the obstacle's left and right end, if the border may cut them */
    bool truncated;          /* whether the box has the error of a cut one */
} goe_sides_t;

/* Whether all of these sides (GOE_SIDE_...) are measured. */
static inline bool goe_sides_see(const goe_sides_t *sides, unsigned set) { return (sides->usable & set) == set; }

typedef struct {
    goe_point_t point[GOE_FEATURES]; /* by goe_feature_t */
    goe_sides_t sides;               /* of the image's box; without a box no side is usable */
    bool seen;                       /* any point or side is visible in the image */
    const goe_image_t *image;        /* as the caller gave it */
    const goe_motion_t *motion;      /* the motion of the track up to this image */
    const goe_camera_t *camera;      /* the one that took it */
    float box_noise_rel;             /* setting */
    const float *camera_to_body;     /* rotation matrices, row by row */
    float camera_to_trajectory[9];
#if GOE_AUGMENTED
    float off_m[3]; /* the given place minus that on the smoothed path: X and Z in T, down; 0 before there is a path */
    float gain_1_s; /* by which off_m changed the path's velocity */
#endif
} goe_view_t;

/*@ predicate goe_view_is_open(goe_view_t *view) =
        \valid_read(view) && \valid_read(view->image) && \valid_read(view->motion) && \valid_read(view->camera) &&
        \valid_read(view->camera_to_body + (0 .. 8)); */

#define GOE_PIXEL_LIES_AT(field, feature)                                                                              \
    (offsetof(goe_image_t, field) == offsetof(goe_image_t, left) + (feature) * sizeof(goe_pixel_t))
GOE_STATIC_ASSERT(GOE_PIXEL_LIES_AT(right, GOE_POINT_RIGHT) && GOE_PIXEL_LIES_AT(top, GOE_POINT_TOP) &&
                      GOE_PIXEL_LIES_AT(base_left, GOE_POINT_BASE_LEFT) &&
                      GOE_PIXEL_LIES_AT(base_near, GOE_POINT_BASE_NEAR) &&
                      GOE_PIXEL_LIES_AT(base_right, GOE_POINT_BASE_RIGHT),
                  the_pixels_of_an_image_follow_each_other);

/* The pixels of an image, by goe_feature_t. */
static inline const goe_pixel_t *goe_image_pixels(const goe_image_t *image) {
    return (const goe_pixel_t *)(const void *)((const unsigned char *)image + offsetof(goe_image_t, left));
}

#define GOE_SIDE_LIES_AT(field, side)                                                                                  \
    (offsetof(goe_box_t, field) == offsetof(goe_box_t, left_px) + (side) * sizeof(float))
GOE_STATIC_ASSERT(GOE_SIDE_LIES_AT(top_px, GOE_BOX_TOP) && GOE_SIDE_LIES_AT(right_px, GOE_BOX_RIGHT) &&
                      GOE_SIDE_LIES_AT(bottom_px, GOE_BOX_BOTTOM),
                  the_sides_of_a_box_follow_each_other);

/* The sides of a box, by goe_box_side_t. */
static inline const float *goe_box_sides(const goe_box_t *box) {
    return (const float *)(const void *)((const unsigned char *)box + offsetof(goe_box_t, left_px));
}

#endif
