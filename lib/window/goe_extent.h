/* Length (6), (7) and height (8) of the obstacle from one image. SPDX-License-Identifier: MIT */
#ifndef GOE_EXTENT_H
#define GOE_EXTENT_H

#include "window/goe_orientation.h"
#include "window/goe_projection.h"

/* A length or height from one image, and its variance from the solution. */
typedef struct {
    float value_m;
    float variance_m2; /* from the sigmas of the solution that the value uses */
} goe_extent_t;

/* (6), (7). Returns GOE_OK; or GOE_EDGE_ON if an end of the side edge is within min_x (focal lengths) of x' = 0, where the side is not
 * visible. faces must have a front and a side. */
goe_status_t goe_extent_length(const goe_faces_t *faces, const goe_span_t *front, goe_turn_t turn,
                               const goe_estimate_t *reference, float min_x, goe_extent_t *length);

/* (8). Returns GOE_OK; or GOE_BAD_HEIGHT if the camera is not above ground. */
static inline goe_status_t goe_extent_height(const goe_point_t *top, float height_m, const goe_estimate_t *reference,
                                             goe_extent_t *height) {
    if (height_m <= 0.0f) {
        return GOE_BAD_HEIGHT;
    }
    const float sigma_m = top->y * reference->sigma.z_m;
    height->value_m = height_m - top->y * reference->z_m; /* (8) */
    height->variance_m2 = sigma_m * sigma_m;
    return GOE_OK;
}

#endif
