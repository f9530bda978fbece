/* Projection models: rows of (5) for a disc or a line. SPDX-License-Identifier: MIT */
#include "window/goe_projection.h"

#include <math.h>

#if GOE_WITH_WINDOW

#define WIDTH_MIN 1.0e-4f    /* smallest image width that is a divisor, in focal lengths */
#define DISC_MULTIPLIER 2.0f /* m in (5) */

goe_status_t goe_projection_disc(const goe_point_t *left, const goe_point_t *right, goe_row_t *row) {
    const float raw_size = right->x - left->x;
    if (!(raw_size > WIDTH_MIN)) {
        return GOE_SWAPPED;
    }
    const float cos_left = 1.0f / sqrtf(1.0f + left->x * left->x);
    const float cos_right = 1.0f / sqrtf(1.0f + right->x * right->x);
    const float size = raw_size * (cos_left + cos_right);
    const float x = 0.5f * (left->x + right->x) * (1.0f - size * size * (1.0f / 16.0f));
    row->zeta = DISC_MULTIPLIER / size;
    row->xi = x * row->zeta;
    return GOE_OK;
}

goe_status_t goe_projection_line(const goe_point_t *left, const goe_point_t *right, goe_turn_t turn, goe_span_t *span,
                                 goe_row_t *row) {
    float x_left;
    float x_right;
    if (!goe_projection_turn(left, turn, &x_left) || !goe_projection_turn(right, turn, &x_right)) {
        return GOE_EDGE_ON;
    }
    const float size = x_right - x_left;
    if (!(size > WIDTH_MIN)) {
        return GOE_EDGE_ON;
    }
    const float forward = 1.0f / size;                       /* m/S, m = 1 */
    const float aside = 0.5f * (x_left + x_right) * forward; /* m x/S */
    span->left = x_left;
    span->right = x_right;
    row->xi = turn.c * aside + turn.s * forward;
    row->zeta = turn.c * forward - turn.s * aside;
    return GOE_OK;
}

#endif
