/* An upright obstacle by its silhouette. SPDX-License-Identifier: MIT
 *
 * A side of an upright bounding box is an image line, and the plane through it and the camera touches the obstacle: left and right at an
 * upright edge's foot or head, top and bottom at the rim. Left and right as points are upright edges: their plane is upright. The
 * footprint is an ellipse about (X0, Z0) that may turn: half width w across the line of sight of the first image, shear s, and depth
 * w e^d along it. The support function of an ellipse is smooth and has no corners to mistake. Images hardly determine the depth before
 * the line of sight has turned: until then d is considered, and estimated afterwards. A disc has s = d = 0.
 * (R5), (R6), (R23) to (R27), (R31). */
#ifndef GOE_FOOTPRINT_H
#define GOE_FOOTPRINT_H

#include "refined/goe_gate.h"
#include "refined/goe_observation.h"
#include "refined/goe_shape.h"

/* Appends the rows of an image. If base corners are visible, it substitutes for a box whose orientation is not known yet: then they give
 * the range over flat ground. */
/*@ requires goe_observation_is_open(obs) && goe_rows_hold(rows) && rows->count == 0; */
void goe_footprint_rows(const goe_observation_t *obs, goe_rows_t *rows);

/* After goe_rows_end(): removes the known part of the sides' errors from their rows. */
/*@ requires \valid(filter) && goe_observation_is_open(obs) && goe_rows_hold(rows);
    requires rows->remembered <= GOE_BOX_SIDES; */
void goe_footprint_recall(goe_filter_t *filter, const goe_observation_t *obs, goe_rows_t *rows);

/* After the gate: keeps the rows' information on these errors, and frees the rows of the image's position noise, which they
 * share. */
/*@ requires \valid(filter) && goe_rows_hold(rows) && rows->remembered <= GOE_BOX_SIDES; */
void goe_footprint_learn(goe_filter_t *filter, goe_rows_t *rows);

/* Whether an image gives the depth: after the line of sight has turned. */
bool goe_footprint_knows_depth(const goe_filter_t *filter);

/* After the update. */
void goe_footprint_follow(goe_filter_t *filter, const float change[GOE_UNKNOWNS]);

/* Factor on the part of the depth in a sigma: the depth is exponential in its state, and a sigma more adds more than the derivative
 * says, (R31). */
float goe_footprint_bend(const goe_filter_t *filter);

/* Whether a configured disc shows a shear that no disc has. */
bool goe_footprint_is_forced(const goe_filter_t *filter);

/* Quantities. */
void goe_footprint_shape(const goe_filter_t *filter, goe_shape_t *shape);

#endif
