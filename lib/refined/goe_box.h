/* A box: where its corners are seen. SPDX-License-Identifier: MIT */
#ifndef GOE_BOX_H
#define GOE_BOX_H

#include "refined/goe_observation.h"

/* How deep the edges of a box reach, in units of Z0, and the derivatives by GOE_SX, GOE_FX, GOE_D:
 * side - front = GOE_D, and as the corner is square, side front = |GOE_SX| GOE_FX. */
typedef struct {
    float side, front; /* sz, |fz|; both >= 0 */
    float sum;
    float by_extents[2]; /* of either, by GOE_SX and GOE_FX */
    float side_by_d, front_by_d;
} goe_depth_t;

#define GOE_EXCHANGE_SLOPE 1.3f /* tan b above which front and side change names, in the state and in the answer */

goe_depth_t goe_box_depth(const float state[GOE_STATES]);

/* Appends the rows of a box. */
void goe_box_rows(const goe_observation_t *sight, goe_rows_t *rows);

#endif
