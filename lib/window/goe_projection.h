/* The projection models disc and line, which give the rows of (5). SPDX-License-Identifier: MIT */
#ifndef GOE_PROJECTION_H
#define GOE_PROJECTION_H

#include <math.h>

#include "image/goe_view.h"

#define GOE_FORWARD_MIN 0.05f /* least third component of a unit ray in T, as in the alignment */

/* The two rows of (5) that one image gives, rotated back into T by the orientation b. This keeps the norm of the residuals:
 *   xi   = c (m x/S) + s (m/S) = (X0 - dX)/W
 *   zeta = c (m/S) - s (m x/S) = (Z0 - dZ)/W */
typedef struct {
    float xi, zeta;
} goe_row_t;

/* The ends x' of the front edge, rotated by the orientation. */
typedef struct {
    float left, right;
} goe_span_t;

/* Sine and cosine of the orientation b. */
typedef struct {
    float s, c;
} goe_turn_t;

/* (2), b = 0. Returns GOE_OK; or GOE_SWAPPED if left is not left of right. */
goe_status_t goe_projection_disc(const goe_point_t *left, const goe_point_t *right, goe_row_t *row);

/* (3), (4) for the front edge from its left to its right end. Returns GOE_OK; or GOE_EDGE_ON if the camera views it from its end or from
 * behind. */
goe_status_t goe_projection_line(const goe_point_t *left, const goe_point_t *right, goe_turn_t turn, goe_span_t *span,
                                 goe_row_t *row);

/* The virtual rotation (4) of an aligned point. Returns false if the point is not ahead of the rotated camera. */
static inline bool goe_projection_turn(const goe_point_t *point, goe_turn_t turn, float *turned_x) {
    const float forward = turn.c + point->x * turn.s;
    if (!(forward > GOE_FORWARD_MIN * sqrtf(1.0f + point->x * point->x))) {
        return false;
    }
    *turned_x = (point->x * turn.c - turn.s) / forward;
    return true;
}

#endif
