/* The footprint model: an upright obstacle by its silhouette, with an elliptic outline. SPDX-License-Identifier: MIT
 *
 * A side of an upright bounding box is an image line, and the plane through this line and the camera touches the obstacle: left and right
 * at the foot or head of an upright edge, top and bottom at the rim. Left and right as points are upright edges, so their plane is upright.
 * The footprint is an ellipse about (X0, Z0) that may turn: half width w across the line of sight of the first image, shear s, and depth w
 * e^d along it. The support function of an ellipse is smooth and has no corners that could be confused. Images hardly determine the depth
 * before the line of sight has turned: until then d is a consider parameter, afterwards it is estimated. A disc has s = d = 0. (R5), (R6),
 * (R23) to (R27), (R31). */
#ifndef GOE_FOOTPRINT_H
#define GOE_FOOTPRINT_H

#include "refined/goe_gate.h"
#include "refined/goe_observation.h"
#include "refined/goe_shape.h"

/* Appends the rows of an image. If base corners are visible, the footprint replaces a box whose orientation is not known yet, and the
 * corners give the range over flat ground. */
/*@ requires goe_observation_is_open(obs) && goe_rows_hold(rows) && rows->count == 0; */
void goe_footprint_rows(const goe_observation_t *obs, goe_rows_t *rows);

/* After goe_rows_end(): removes the known part of the sides' errors from their rows. */
/*@ requires \valid(filter) && goe_observation_is_open(obs) && goe_rows_hold(rows);
    requires rows->remembered <= GOE_BOX_SIDES; */
void goe_footprint_recall(goe_filter_t *filter, const goe_observation_t *obs, goe_rows_t *rows);

/* After the gate: updates the memory of these errors by the rows. Errors that all rows of the image share reduce the gain. */
/*@ requires \valid(filter) && goe_rows_hold(rows) && rows->remembered <= GOE_BOX_SIDES; */
void goe_footprint_learn(goe_filter_t *filter, goe_rows_t *rows);

/* Whether images give the depth, because the line of sight has turned enough. */
bool goe_footprint_knows_depth(const goe_filter_t *filter);

/* After the update: applies the change of the state to the memories, and limits the depth. */
void goe_footprint_follow(goe_filter_t *filter, const float change[GOE_UNKNOWNS]);

/* Factor on the part of the depth in a sigma: the depth is exponential in its state, so one sigma changes it by more than the derivative
 * predicts, (R31). */
float goe_footprint_bend(const goe_filter_t *filter);

/* Whether a round obstacle shows a shear that no disc has. */
bool goe_footprint_is_forced(const goe_filter_t *filter);

/* Sets the quantities. */
void goe_footprint_shape(const goe_filter_t *filter, goe_shape_t *shape);

#endif
