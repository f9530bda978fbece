/* The models, by the filter's phase. SPDX-License-Identifier: MIT */
#ifndef GOE_MODEL_H
#define GOE_MODEL_H

#include "refined/goe_gate.h"
#include "refined/goe_observation.h"
#include "refined/goe_shape.h"

/* Starts the filter by the first model, a disc. False if the image does not show enough. */
bool goe_model_start(goe_filter_t *filter, const goe_observation_t *obs);

/* Changes the model if the image shows that another fits. Returns whether it did; the image that brings a change is not used
 * for more, because it costs as much as a measurement. */
bool goe_model_change(goe_filter_t *filter, const goe_observation_t *obs);

/* Prepares the filter for the rows of an image, and appends them. */
void goe_model_rows(goe_filter_t *filter, goe_observation_t *obs, goe_rows_t *rows);

/* After the gate. */
void goe_model_follow(goe_filter_t *filter, const goe_verdict_t *verdict);

/* Quantities with their derivatives. */
void goe_model_shape(const goe_filter_t *filter, goe_shape_t *shape);

#endif
