/* One image as lib/refined/goe_observation.h holds it, made up from numbers, and what it should show, in double.
 * SPDX-License-Identifier: MIT */
#ifndef SIGHTING_H
#define SIGHTING_H

#include "check.h"
#include "refined/goe_observation.h"

#define SETTLED 4 /* iterations until a fixed point is exact to a float */

typedef struct {
    goe_settings_t settings;
    float state[GOE_STATES];
    goe_observation_t sight;
    goe_matrix_t matrix;
    goe_rows_t rows;
} sighting_t;

/* A camera turned anyhow within 20 degrees of the state's axes on a body turned anyhow; no point is measured; the state is 0
 * but for an attitude bias of some degrees; camera 20 m above the ground and moved by (3, 25) m. */
void sighting_start(sighting_t *sighting, check_random_t *random);

/* As it starts, and the states that every obstacle has but for its extents: place and height's offset. Returns Z0, m. */
double sighting_place(sighting_t *sighting, check_random_t *random);

/* The top, whichever the detector marks; then the parts that depend on the state. truth: the state in double. */
void sighting_finish(sighting_t *sighting, check_random_t *random, double z0_m, double truth[GOE_STATES]);

/* What depends on the state, after a change of it. */
void sighting_look(sighting_t *sighting);

/* Prepares an empty set of rows of the image: it lies on the smoothed path, which is free of noise. */
void sighting_clear_rows(sighting_t *sighting);

/* Y/Z at which a point of the image was measured, freed of the attitude bias of `state`, to first order. */
double sighting_height(const sighting_t *sighting, const double state[GOE_STATES], size_t feature);

/* Image of the point under the attitude bias of `state`: the exact small-rotation model of goe_observation.h in double. */
void sighting_project(const sighting_t *sighting, const double state[GOE_STATES], const double point[3],
                      double seen[2]);

/* What row `row` predicts for a state; depends on the shape. */
typedef double (*sighting_predict_t)(const sighting_t *sighting, const double state[GOE_STATES], size_t row);

/* GIVEN points that were measured at the present state THEN the residuals of all rows are 0, the rows' columns are the
 * derivatives of the prediction, and what belongs to no row is 0. */
void sighting_check_rows(sighting_t *sighting, sighting_predict_t predict);

#endif
