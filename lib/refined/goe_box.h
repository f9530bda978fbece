/* The box model: an obstacle measured by its corners. SPDX-License-Identifier: MIT */
#ifndef GOE_BOX_H
#define GOE_BOX_H

#include "refined/goe_observation.h"
#include "refined/goe_shape.h"

/* An edge of a box as a vector, in the state's axes and units of Z0, with the derivatives of its depth `along.z` by GOE_SIDE_X,
 * GOE_FRONT_X, GOE_DEPTH_DIFFERENCE. Its lateral extent `along.x` is itself a state. */
typedef struct {
    goe_xz_t along;
    float by[3];
    float length;
} goe_box_edge_t;

/* (R7): |side.z| - |front.z| = GOE_DEPTH_DIFFERENCE, and as the corner is a right angle, |side.z front.z| = |GOE_SIDE_X| GOE_FRONT_X. */
typedef struct {
    goe_box_edge_t side, front; /* side.along.z >= 0; front.along.x >= 0 */
    float sum;                  /* sum of both depths */
    float sign;                 /* sign of side.along.x: the right end (+) or the left end (-) of the front is nearer */
} goe_box_edges_t;

void goe_box_edges(const float state[GOE_STATES], goe_box_edges_t *edges);

/* Enters a phase of the box model. The edges have no names in the report yet. */
void goe_box_enter(goe_filter_t *filter, goe_phase_t phase);

/* Appends the rows of a box. */
/*@ requires goe_observation_is_open(obs) && goe_rows_hold(rows) && rows->count == 0; */
void goe_box_rows(const goe_observation_t *obs, goe_rows_t *rows);

/* After an update: limits the extents to those at which the next image can be linearized, and names the edges in the report: front and side
 * keep their names until the side is clearly across Z of T. */
void goe_box_clip(goe_filter_t *filter);
void goe_box_name(goe_filter_t *filter);

/* Frees the length when a second face comes into view, and exchanges front and side if the side is across Z. Returns whether there was a
 * change; the image that causes it is used for nothing else. */
bool goe_box_change(goe_filter_t *filter, const goe_observation_t *obs);

/* Sets the quantities. Orientation, width and length depend on the right angle of the corner: while GOE_DEPTH_DIFFERENCE is poorly known,
 * their true error exceeds the first order, by goe_shape_t.corner_growth, (R22). */
void goe_box_shape(const goe_filter_t *filter, goe_shape_t *shape);

#endif
