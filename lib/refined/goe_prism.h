/* An upright obstacle, observed by its upright bounding boxes. SPDX-License-Identifier: MIT
 *
 * A side of the box is an image line, and the plane through it and the camera touches the obstacle: left and right at an
 * upright edge's foot or head, top and bottom at the rim. The footprint is an ellipse about (X0, Z0) that may turn: half
 * width w across the line of sight of the first image, shear s, and depth w e^d along it. The support function of an ellipse is smooth
 * and has no corners to mistake. Boxes hardly determine the depth before the line of sight has turned: until then d is considered, and
 * estimated afterwards. (R25) to (R29), (R33). */
#ifndef GOE_PRISM_H
#define GOE_PRISM_H

#include "refined/goe_gate.h"
#include "refined/goe_observation.h"
#include "refined/goe_shape.h"

/* Turns the filter's axes so that Z points at the obstacle. False if left and right are not measured. */
bool goe_prism_face(goe_filter_t *filter, const goe_view_t *view);

/* First guess: state and root from one image, in axes that face the obstacle. False if it is out of range. */
bool goe_prism_start(const goe_observation_t *obs, float state[GOE_STATES], goe_triangle_t *root);

/* Appends the rows of a box. */
/*@ requires goe_observation_is_open(obs) && goe_rows_hold(rows) && rows->count == 0; */
void goe_prism_rows(const goe_observation_t *obs, goe_rows_t *rows);

/* After goe_rows_end(): removes the known part of the sides' errors from the rows. */
/*@ requires \valid(filter) && goe_observation_is_open(obs) && goe_rows_hold(rows);
    requires rows->count <= GOE_BOX_SIDES; */
void goe_prism_recall(goe_filter_t *filter, const goe_observation_t *obs, goe_rows_t *rows);

/* After the gate: keeps the rows' information on these errors, and frees the rows of the image's position noise, which they
 * share. */
/*@ requires \valid(filter) && goe_rows_hold(rows) && rows->count <= GOE_BOX_SIDES; */
void goe_prism_learn(goe_filter_t *filter, goe_rows_t *rows);

/* Whether an image gives the depth: after the line of sight has turned. */
bool goe_prism_knows_depth(const goe_filter_t *filter);

/* After the update. */
void goe_prism_follow(goe_filter_t *filter, const float change[GOE_UNKNOWNS]);

/* Factor on the part of the depth in a sigma: the depth is exponential in its state, and a sigma more adds more than the derivative
 * says, (R33). */
float goe_prism_bend(const goe_filter_t *filter);

/* How far the footprint reaches from its middle, units of Z0, and the derivatives by its three states. */
typedef struct {
    float reach, by_shear, by_half, by_depth;
} goe_support_t;

/* The footprint from the camera: towards it along the line of sight, which is that unit vector in the state's axes, and across. */
typedef struct {
    goe_xz_t towards;
    goe_support_t before, across;
} goe_aspect_t;

/* camera_m: since the filter's start. The part behind the camera counts up to the camera. */
void goe_prism_face_camera(const goe_filter_t *filter, goe_xz_t camera_m, goe_aspect_t *aspect);

/* Quantities. */
void goe_prism_shape(const goe_filter_t *filter, goe_shape_t *shape);

#endif
