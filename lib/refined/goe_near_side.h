/* What a hazard meets of an obstacle: a circle that is as near to the camera, and as wide across the line of sight, as the obstacle. Images
 * show both; they hardly show the middle of a footprint, which depends on its depth. SPDX-License-Identifier: MIT */
#ifndef GOE_NEAR_SIDE_H
#define GOE_NEAR_SIDE_H

#include "refined/goe_shape.h"

/* The radius of the circle, m, also while the width is not valid; half of the visible extent of a box, about its reference point.
 * nearer_m: from the middle of a footprint to the middle of the circle, T axes. */
float goe_near_side_reach(const goe_filter_t *filter, goe_xz_t *nearer_m);

/* The derivatives of place and width become those of the circle, and the width its width; goe_conflict.c computes its place. The height
 * counts from the altimeter's zero: its constant error cancels between camera and top. */
void goe_near_side_meet(const goe_filter_t *filter, goe_shape_t *shape);

#endif
