/* The obstacle's quantities by the filter's state, with their derivatives by the states. Each model sets them.
 * SPDX-License-Identifier: MIT */
#ifndef GOE_SHAPE_H
#define GOE_SHAPE_H

#include "refined/goe_filter.h"

/* A quantity and its derivatives by the states. */
typedef struct {
    float value;
    float by[GOE_STATES];
} goe_linear_t;

/* A place in the horizontal plane, in the state's axes and units of Z0, with its derivatives by GOE_SIDE_X, GOE_FRONT_X and
 * GOE_DEPTH_DIFFERENCE; that of x by GOE_BEARING is 1. */
typedef struct {
    goe_xz_t at;
    float x_by[3], z_by[3];
} goe_spot_t;

GOE_STATIC_ASSERT(GOE_FRONT_X == GOE_SIDE_X + 1 && GOE_DEPTH_DIFFERENCE == GOE_SIDE_X + 2,
                  the_extents_follow_each_other);

typedef struct {
    /* X0, Z0: reference point in T's axes, from the camera at the filter's start, m; width, length, height: m; orientation: rad.
     * Orientation and length are 0 unless the model is a box */
    goe_linear_t quantity[GOE_QUANTITIES];
    goe_spot_t middle;    /* of the base */
    goe_xz_t length_axis; /* unit vector, T axes; along the edge that is reported as side */
    float scale_m;        /* Z0: the unit of the state */
    float place_m2;       /* variance of the center beyond that of the state, along X and along Z */
    float width_m2;       /* the same of the width */
    float turned_rad2;    /* the same of the orientation */
    float roof_m2;        /* the same of the position of the roof's point below the top */
    float top_m2;         /* the same of the height, as a result */
    float datum_by_range; /* derivative by 1/Z0 of the height above the altimeter's zero, minus that of the height */
    float corner_growth;  /* factor on the variance of orientation, width and length, see goe_box_shape() */
} goe_shape_t;

/* Sets by[] to the derivatives of by_x X + by_z Z of a spot, meters, X and Z in the state's axes. */
void goe_shape_place(const goe_spot_t *spot, float scale_m, float by_x, float by_z, float by[GOE_STATES]);

/* Sets the common part of all models: scale, height, and X0, Z0 of the reference point. The rest becomes 0. */
void goe_shape_start(const goe_filter_t *filter, const goe_spot_t *reference, goe_shape_t *shape);

/* Sets the variances of a filled shape that no image reduces. highest: the detector's top is the highest point of the roof. camera_m: the
 * camera since the filter's start; height_m: its height. */
void goe_shape_doubt(const goe_filter_t *filter, bool highest, goe_xz_t camera_m, float height_m, goe_shape_t *shape);

#endif
