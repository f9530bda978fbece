/* Length (6), (7) and height (8) of one image. SPDX-License-Identifier: MIT */
#ifndef GOE_EXTENT_H
#define GOE_EXTENT_H

#include "goe_orientation.h"
#include "goe_projection.h"

/* One image's value and how it hangs on the quantities it was made of. */
typedef struct {
    float value_m;
    float variance_m2; /* from the sigmas of the solution it was made of */
} goe_extent_t;

/* What (6) to (8) take from the solution. */
typedef struct {
    float x_m, z_m, width_m; /* reference point now */
    float sigma_x_m, sigma_z_m, sigma_width_m;
} goe_reference_t;

/* (6), (7). GOE_OK, or GOE_EDGE_ON if an end of the side edge is within min_x (of the focal length) of x' = 0, where the
 * side cannot be seen. faces must have a front and a side. */
goe_status_t goe_extent_length(const goe_faces_t *faces, goe_turn_t turn, const goe_reference_t *reference, float min_x,
                               goe_extent_t *length);

/* (8). GOE_OK, or GOE_BAD_HEIGHT if the camera is not above ground. */
goe_status_t goe_extent_height(const goe_point_t *top, float height_m, const goe_reference_t *reference,
                               goe_extent_t *height);

#endif
