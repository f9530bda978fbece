/* The models, by the filter's phase. SPDX-License-Identifier: MIT */
#ifndef GOE_MODEL_H
#define GOE_MODEL_H

#include "refined/goe_gate.h"
#include "refined/goe_observation.h"
#include "refined/goe_shape.h"

/* Places the filter's axes for a start by this image. False if it shows no obstacle to start by. */
bool goe_model_place(goe_filter_t *filter, const goe_view_t *view);

/* Starts the filter by a footprint. False if the image does not show enough. */
bool goe_model_start(goe_filter_t *filter, const goe_observation_t *obs);

/* Changes the model if the image shows that another fits. Returns whether it did; the image that brings a change is not used
 * for more, because it costs as much as a measurement. */
bool goe_model_change(goe_filter_t *filter, const goe_observation_t *obs);

/* Appends the rows of an image. */
/*@ requires \valid_read(filter) && \valid(obs) && goe_observation_is_open(obs) && goe_rows_hold(rows);
    requires rows->count == 0; */
void goe_model_rows(const goe_filter_t *filter, goe_observation_t *obs, goe_rows_t *rows);

/* Before the gate. */
void goe_model_recall(goe_filter_t *filter, const goe_observation_t *obs, goe_rows_t *rows);

/* After the gate. */
void goe_model_learn(goe_filter_t *filter, goe_rows_t *rows);

/* The update by whitened rows, and the consequences of the change of the state. change: of it and of the augmented states. Returns the
 * normalized innovation squared. */
float goe_model_update(goe_filter_t *filter, float nuisance_root, goe_rows_t *rows, float change[GOE_UNKNOWNS]);

/* Quantities with their derivatives. */
void goe_model_shape(const goe_filter_t *filter, goe_shape_t *shape);

#endif
