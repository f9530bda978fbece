/* An upright cylinder: its tangents. SPDX-License-Identifier: MIT */
#ifndef GOE_DISC_H
#define GOE_DISC_H

#include "refined/goe_observation.h"
#include "refined/goe_shape.h"

/* First guess: state and root from one image. False if it shows no width, or the guess is out of range. */
bool goe_disc_start(const goe_observation_t *obs, float state[GOE_STATES], goe_triangle_t *root);

/* Appends the rows of a disc. If base corners are visible, the disc substitutes for a box whose orientation is not known
 * yet: then they give the range over flat ground. */
/*@ requires goe_observation_is_open(obs) && goe_rows_hold(rows) && rows->count == 0; */
void goe_disc_rows(const goe_observation_t *obs, goe_rows_t *rows);

/* Whether the ends of an assumed disc are at different depths: it is no disc. */
bool goe_disc_is_skewed(const goe_filter_t *filter);

/* Quantities, under the condition that the disc has no skew (GOE_SIDE_X = 0). */
void goe_disc_shape(const goe_filter_t *filter, goe_shape_t *shape);

/* What the condition leaves open: the obstacle may be no disc. */
typedef struct {
    float part[GOE_UNKNOWNS]; /* the skew's error in terms of independent unit errors (goe_srif_part) ... */
    float skew_variance;      /* ... of all of them */
    float spread;             /* one sigma of the skew that is left out, by how likely it is that it is no disc */
} goe_disc_doubt_t;

/* (R40), of the latest image; the shape's place and width learn of it. asked: the settings ask for a disc, and it is one. */
void goe_disc_doubt(const goe_filter_t *filter, bool asked, goe_xz_t camera_m, goe_shape_t *shape,
                    goe_disc_doubt_t *doubt);

/* The same condition on a derivative in terms of independent unit errors (goe_srif_project). Returns what it moves the quantity
 * by, one sigma, if the obstacle is no disc. */
float goe_disc_condition(const goe_disc_doubt_t *doubt, float projected[GOE_STATES]);

#endif
