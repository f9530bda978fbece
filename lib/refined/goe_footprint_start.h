/* The start of a footprint from the first image. SPDX-License-Identifier: MIT */
#ifndef GOE_FOOTPRINT_START_H
#define GOE_FOOTPRINT_START_H

#include "refined/goe_observation.h"

/* Turns the filter's axes so that Z points at the obstacle. False if neither left or right of a box nor two end points are measured. */
bool goe_footprint_face(goe_filter_t *filter, const goe_view_t *view);

/* Sets the first state and root from one image, in axes that point at the obstacle. False if the image does not suffice. *by_kind: the
 * range is that of the detector's class. */
bool goe_footprint_start(const goe_observation_t *obs, float state[GOE_STATES], goe_triangle_t *root, bool *by_kind);

#endif
