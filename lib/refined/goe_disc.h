/* An upright cylinder: its tangents. SPDX-License-Identifier: MIT */
#ifndef GOE_DISC_H
#define GOE_DISC_H

#include "refined/goe_observation.h"
#include "refined/goe_shape.h"

/* First guess: state and root from one image. False if it shows no width, or the guess is out of range. */
/*@ requires goe_observation_is_open(obs) && \valid(state + (0 .. GOE_STATES - 1)) && \valid(root); */
bool goe_disc_start(const goe_observation_t *obs, float state[GOE_STATES], goe_triangle_t *root);

/* Appends the rows of a disc. If base corners are seen, what is taken for a disc is a box whose orientation is not known
 * yet: then they tell the range over flat ground. */
/*@ requires goe_observation_is_open(obs) && goe_rows_hold(rows) && rows->count == 0; */
void goe_disc_rows(const goe_observation_t *obs, goe_rows_t *rows);

/* Whether the ends of what is taken for a disc lie at different depths: it is no disc. */
/*@ requires \valid_read(filter); */
bool goe_disc_is_skewed(const goe_filter_t *filter);

/* Quantities, under the condition that the disc has no skew (GOE_SIDE_X = 0). */
/*@ requires \valid_read(filter) && \valid(shape); */
void goe_disc_shape(const goe_filter_t *filter, goe_shape_t *shape);

/* The same condition on a derivative in terms of independent unit errors (goe_srif_project). Returns by how much it moves the
 * quantity, which is in error by as much if the obstacle is no disc. */
/*@ requires \valid_read(filter) && \valid(projected + (0 .. GOE_STATES - 1)); */
float goe_disc_condition(const goe_filter_t *filter, float skew_variance, float projected[GOE_STATES]);

/* Of the skew, on which the condition is. */
/*@ requires \valid_read(filter); */
float goe_disc_skew_variance(const goe_filter_t *filter);

#endif
