/* A box: the image points of its corners. SPDX-License-Identifier: MIT */
#ifndef GOE_BOX_H
#define GOE_BOX_H

#include "refined/goe_observation.h"
#include "refined/goe_shape.h"

/* An edge of a box as a vector, the state's axes and units of Z0, with the derivatives of its depth `along.z` by GOE_SIDE_X,
 * GOE_FRONT_X, GOE_DEPTH_DIFFERENCE. Its lateral extent is that of its own state. */
typedef struct {
    goe_xz_t along;
    float by[3];
    float length;
} goe_box_edge_t;

/* |side.z| - |front.z| = GOE_DEPTH_DIFFERENCE, and as the corner is square, |side.z front.z| = |GOE_SIDE_X| GOE_FRONT_X. */
typedef struct {
    goe_box_edge_t side, front; /* side.along.z >= 0; front.along.x >= 0 */
    float sum;                  /* of both depths */
    float sign;                 /* of side.along.x: the front comes nearer to the right (+) or to the left (-) */
} goe_box_edges_t;

void goe_box_edges(const float state[GOE_STATES], goe_box_edges_t *edges);

/* Enters one of the phases of a box, whose edges have no names yet. */
void goe_box_enter(goe_filter_t *filter, goe_phase_t phase);

/* Appends the rows of a box. */
/*@ requires goe_observation_is_open(obs) && goe_rows_hold(rows) && rows->count == 0; */
void goe_box_rows(const goe_observation_t *obs, goe_rows_t *rows);

/* After an update: keeps the extents where the next image can be linearized, and names the edges: front and side keep their
 * names until the side is clearly across T's Z. */
void goe_box_clip(goe_filter_t *filter);
void goe_box_name(goe_filter_t *filter);

/* Frees the length when a second face comes into view, and exchanges front and side if the side lies across. Returns whether
 * there was a change; the image that brings it is not used for more. */
bool goe_box_change(goe_filter_t *filter, const goe_observation_t *obs);

/* Quantities. Orientation, width and length depend on the square of the corner: while GOE_DEPTH_DIFFERENCE is not known well
 * their true error is larger than to first order, by goe_shape_t.corner_growth, (R22). */
void goe_box_shape(const goe_filter_t *filter, goe_shape_t *shape);

#endif
