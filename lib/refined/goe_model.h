/* The calls that all models implement, by the filter's phase. SPDX-License-Identifier: MIT */
#ifndef GOE_MODEL_H
#define GOE_MODEL_H

#include "refined/goe_gate.h"
#include "refined/goe_observation.h"
#include "refined/goe_shape.h"

/* Places the filter's axes for a start with this image. False if it shows no obstacle to start with. */
bool goe_model_place(goe_filter_t *filter, const goe_view_t *view);

/* Starts the filter with a footprint. False if the image does not show enough. */
bool goe_model_start(goe_filter_t *filter, const goe_observation_t *obs);

/* Changes the model if the image shows that another one fits. Returns whether it did; the image that causes the change is used for nothing
 * else, because a change costs as much as a measurement. */
bool goe_model_change(goe_filter_t *filter, const goe_observation_t *obs);

/* Appends the rows of an image. */
/*@ requires \valid_read(filter) && \valid(obs) && goe_observation_is_open(obs) && goe_rows_hold(rows);
    requires rows->count == 0; */
void goe_model_rows(const goe_filter_t *filter, goe_observation_t *obs, goe_rows_t *rows);

/* Before the gate: removes the remembered errors from the rows. */
void goe_model_recall(goe_filter_t *filter, const goe_observation_t *obs, goe_rows_t *rows);

/* After the gate: updates the remembered errors. */
void goe_model_learn(goe_filter_t *filter, goe_rows_t *rows);

/* Updates state and root by whitened rows, and all that depends on the state. change: of the state and of the augmented states. Returns the
 * normalized innovation squared. */
float goe_model_update(goe_filter_t *filter, float nuisance_root, goe_rows_t *rows, float change[GOE_UNKNOWNS]);

/* Sets the quantities with their derivatives. */
void goe_model_shape(const goe_filter_t *filter, goe_shape_t *shape);

#endif
