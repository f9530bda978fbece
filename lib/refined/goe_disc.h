/* An upright cylinder: its tangents. SPDX-License-Identifier: MIT */
#ifndef GOE_DISC_H
#define GOE_DISC_H

#include "refined/goe_observation.h"

/* Appends the rows of a disc. If base corners are seen, what is taken for a disc is a box whose orientation is not known
 * yet: then they tell the range over flat ground. */
void goe_disc_rows(const goe_observation_t *sight, goe_rows_t *rows);

/* First guess: state and root from one image. False if it shows no width, or the guess is out of range. */
bool goe_disc_start(const goe_observation_t *sight, float state[GOE_STATES], goe_triangle_t *root);

#endif
