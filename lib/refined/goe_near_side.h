/* The near side of an obstacle, which a hazard meets: a circle as near to the camera, and as wide across the line of sight, as the
 * obstacle. Images show both; they hardly show the middle of a footprint, which depends on its depth. SPDX-License-Identifier: MIT */
#ifndef GOE_NEAR_SIDE_H
#define GOE_NEAR_SIDE_H

#include "refined/goe_shape.h"

/* Returns the radius of the circle, m, also while the width is not valid; for a box, half of its visible extent about the reference point.
 * nearer_m: from the middle of a footprint to the middle of the circle, T axes. */
float goe_near_side_reach(const goe_filter_t *filter, goe_xz_t *nearer_m);

/* Replaces the derivatives of place and width by those of the circle, and the width by its width; goe_conflict.c computes its place. The
 * height then counts from the altimeter's zero, whose constant error cancels between camera and top. */
void goe_near_side_meet(const goe_filter_t *filter, goe_shape_t *shape);

#endif
