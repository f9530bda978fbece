/* Length and height. SPDX-License-Identifier: MIT */
#include "goe_extent.h"

#include <math.h>

goe_status_t goe_extent_length(const goe_faces_t *faces, goe_turn_t turn, const goe_reference_t *reference, float min_x,
                               goe_extent_t *length) {
    /* the edges meet at the near corner: the side's left end if the side is the right edge */
    const goe_point_t *near = faces->side_is_right ? faces->side->left : faces->side->right;
    const goe_point_t *far = faces->side_is_right ? faces->side->right : faces->side->left;
    float x_near;
    float x_far;
    if (!goe_projection_turn(near, turn, &x_near) || !goe_projection_turn(far, turn, &x_far)) {
        return GOE_EDGE_ON;
    }
    if (fabsf(x_near) < min_x || fabsf(x_far) < min_x || (x_near < 0.0f) != (x_far < 0.0f)) {
        return GOE_EDGE_ON;
    }
    const float inverse = 1.0f / x_far - 1.0f / x_near; /* (6) = L/X_side */
    const float half_m = faces->side_is_right ? 0.5f * reference->width_m : -0.5f * reference->width_m;
    const float side_m = reference->x_m * turn.c - reference->z_m * turn.s + half_m;
    const float across_m2 = turn.c * turn.c * reference->sigma_x_m * reference->sigma_x_m +
                            turn.s * turn.s * reference->sigma_z_m * reference->sigma_z_m +
                            0.25f * reference->sigma_width_m * reference->sigma_width_m;
    length->value_m = inverse * side_m; /* (7) */
    length->variance_m2 = inverse * inverse * across_m2;
    return GOE_OK;
}

goe_status_t goe_extent_height(const goe_point_t *top, float height_m, const goe_reference_t *reference,
                               goe_extent_t *height) {
    if (height_m <= 0.0f) {
        return GOE_BAD_HEIGHT;
    }
    const float sigma_m = top->y * reference->sigma_z_m;
    height->value_m = height_m - top->y * reference->z_m; /* (8) */
    height->variance_m2 = sigma_m * sigma_m;
    return GOE_OK;
}
