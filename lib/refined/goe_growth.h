/* Whether the obstacle is larger in an image than it can be at its range. SPDX-License-Identifier: MIT
 *
 * An obstacle that comes closer while its direction stays the same moves, or is much nearer than the state has it. Direction then says
 * "far", growth says "near", and a state far away takes each step of the growth for an error of the detector. */
#ifndef GOE_GROWTH_H
#define GOE_GROWTH_H

#include "refined/goe_observation.h"

#define GOE_GROWN_SIGMAS2 9.0f /* from here on it contradicts an obstacle that stands still */

/* (R34): by how much width or height exceeds the predicted one, (in sigmas)^2. 0 if it does not, or if the line of sight may have turned
 * far. A cut box has the errors of one. Of the model's rows, before the remembered errors are taken off. */
float goe_growth_find(const goe_observation_t *obs, const goe_rows_t *rows);

#endif
