/* Where the sides of an upright bounding box touch an upright solid, and their rows. SPDX-License-Identifier: MIT
 *
 * A side of the box is a line of the raw image, and the plane through that line and the camera touches the solid: at its foot
 * or at its head, at the point of the footprint that lies farthest along the plane's normal. This is exact at any roll and
 * from above the roof as from below. (R24) to (R27). */
#ifndef GOE_TOUCH_H
#define GOE_TOUCH_H

#include "refined/goe_ellipse.h"
#include "refined/goe_observation.h"

/* An upright solid relative to the camera now, in the state's axes and units of Z0. Its footprint is the convex hull of its
 * corners or, without corners, an ellipse. */
typedef struct {
    goe_xz_t center;
    goe_ellipse_t ellipse;
    const goe_xz_t *corner;
    size_t corners;
    float ground, roof;            /* Y; goe_touch_open() sets these and the next two */
    unsigned seen;                 /* GOE_SIDE_...: sides that are measured, and that no border seems to cut */
    float unbiased_from_camera[9]; /* rotation, row by row */
} goe_solid_t;

/* Where a plane through the camera touches a solid. */
typedef struct {
    float point[3];        /* from the camera, the state's axes */
    float x, y, nearness;  /* the point in the image, focal lengths, no lens; 1/(range along the optical axis) */
    goe_xz_t outward;      /* unit normal of the plane, horizontal part */
    goe_contact_t contact; /* of an ellipse, along `outward` */
    size_t corner;         /* of a hull: the touched corner */
    bool foot;             /* the touching point is at the foot, not at the head */
    bool other;            /* the plane touches the other end, which is not ahead */
} goe_touch_t;

/*@ predicate goe_solid_is_closed(goe_solid_t *solid) =
        \valid_read(solid) && (solid->corners == 0 || \valid_read(solid->corner + (0 .. solid->corners - 1))); */

/* Whether a side is top or bottom, which are measured along y. */
static inline bool goe_touch_is_level(size_t side) { return (side & 1u) != 0u; }

/* Raw coordinate of a side, focal lengths. */
/*@ requires \valid_read(camera) && \valid_read(sides) && side < GOE_BOX_SIDES; */
float goe_touch_coordinate(const goe_camera_t *camera, const goe_sides_t *sides, size_t side);

/* Size of the box along the coordinate of a side, focal lengths: as measured if both of its ends are, otherwise that of an
 * extent, units of Z0, at the reference point. */
/*@ requires goe_observation_is_open(obs) && side < GOE_BOX_SIDES; */
float goe_touch_size(const goe_observation_t *obs, size_t side, float extent);

/* Variance that a box has because the border cuts it at the obstacle's left or right; size: that of the box along a side's coordinate. */
float goe_touch_cut_variance(const goe_observation_t *obs, float size);

/* Variance of a side's error that is new in each image, with that of a cut. */
/*@ requires goe_observation_is_open(obs) && side < GOE_BOX_SIDES; */
float goe_touch_white_variance(const goe_observation_t *obs, size_t side, float size);

/* The same plus the correlated error, for models that do not model it. */
/*@ requires goe_observation_is_open(obs) && side < GOE_BOX_SIDES; */
float goe_touch_variance(const goe_observation_t *obs, size_t side, float size);

/* Sets the common part of all sides of an image: ground and roof by the camera's height, the rotation from the camera's axes, corrected for
 * the attitude bias, and the sides that give rows. The footprint is set before. */
/*@ requires goe_observation_is_open(obs) && \valid(solid); */
void goe_touch_open(const goe_observation_t *obs, float height_m, goe_solid_t *solid);

/* Adds the row of a side, (R27), and returns its derivatives by the states as goe_rows_add() does. It sets those by GOE_GROUND and GOE_TOP,
 * the model sets the others. Null if the side is not visible: neither end of it is ahead or, for a level side, its own end is not. */
/*@ requires goe_observation_is_open(obs) && goe_solid_is_closed(solid) && goe_rows_hold(rows);
    requires side < GOE_BOX_SIDES && rows->count < GOE_ROWS_MAX && \valid(touch) && \valid(gradient); */
float *goe_touch_add(goe_rows_t *rows, const goe_observation_t *obs, const goe_solid_t *solid, size_t side,
                     float variance, goe_touch_t *touch, goe_gradient_t *gradient);

#endif
