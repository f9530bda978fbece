/* Length of the obstacle from one image, (6) and (7). SPDX-License-Identifier: MIT */
#include "window/goe_extent.h"
#include "maths/goe_scalar.h"

#if GOE_WITH_WINDOW

goe_status_t goe_extent_length(const goe_faces_t *faces, const goe_span_t *front, goe_turn_t turn,
                               const goe_estimate_t *reference, float min_x, goe_extent_t *length) {
    /* the edges meet at the near corner: the front's right end if the side is the right edge */
    const goe_point_t *far_end = faces->side_is_right ? faces->side->right : faces->side->left;
    const float x_near = faces->side_is_right ? front->right : front->left;
    float x_far;
    if (!goe_projection_turn(far_end, turn, &x_far)) {
        return GOE_EDGE_ON;
    }
    if (goe_absolute(x_near) < min_x || goe_absolute(x_far) < min_x || (x_near < 0.0f) != (x_far < 0.0f)) {
        return GOE_EDGE_ON;
    }
    const float inverse = 1.0f / x_far - 1.0f / x_near; /* (6) = L/X_side */
    const float half_m = faces->side_is_right ? 0.5f * reference->width_m : -0.5f * reference->width_m;
    const float side_m = reference->x_m * turn.c - reference->z_m * turn.s + half_m;
    const float across_m2 = turn.c * turn.c * reference->sigma.x_m * reference->sigma.x_m +
                            turn.s * turn.s * reference->sigma.z_m * reference->sigma.z_m +
                            0.25f * reference->sigma.width_m * reference->sigma.width_m;
    length->value_m = inverse * side_m; /* (7) */
    length->variance_m2 = inverse * inverse * across_m2;
    return GOE_OK;
}

#endif
