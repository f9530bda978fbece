/* The start of a footprint from the first image. SPDX-License-Identifier: MIT */
#ifndef GOE_FOOTPRINT_START_H
#define GOE_FOOTPRINT_START_H

#include "refined/goe_observation.h"

/* Turns the filter's axes so that Z points at the obstacle. False if neither a side of a box, left or right, nor two ends are measured. */
bool goe_footprint_face(goe_filter_t *filter, const goe_view_t *view);

/* First guess: state and root from one image, in axes that face the obstacle. False if it is out of range. by_kind: the range is that
 * of the detector's class. */
bool goe_footprint_start(const goe_observation_t *obs, float state[GOE_STATES], goe_triangle_t *root, bool *by_kind);

#endif
