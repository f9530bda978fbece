/* The test whether an obstacle is larger in an image than its range allows. SPDX-License-Identifier: MIT
 *
 * An obstacle that approaches while its direction stays the same moves, or is much nearer than in the state. The direction then indicates
 * "far", the growth "near". A filter whose state is far away attributes each step of the growth to an error of the detector. */
#ifndef GOE_GROWTH_H
#define GOE_GROWTH_H

#include "refined/goe_observation.h"

#define GOE_GROWN_SIGMAS2 9.0f    /* squared sigmas above which it contradicts a static obstacle */
#define GOE_GROWTH_UNSEEN (-1.0f) /* the image does not show both ends */

/* (R34): by how much the width or height exceeds the predicted one, in squared sigmas. 0 if it does not, or if the line of sight may have
 * turned far; GOE_GROWTH_UNSEEN if the image does not show both ends. rows: those of the model, before remembered errors are removed. The
 * error of a cut counts, except for a height that the border does not cut. */
float goe_growth_find(const goe_observation_t *obs, const goe_rows_t *rows);

#endif
