/* How well the images fit: the running means of the NIS, points that the gate refuses in many images, and restarts of the filter.
 * SPDX-License-Identifier: MIT */
#ifndef GOE_HEALTH_H
#define GOE_HEALTH_H

#include "refined/goe_gate.h"

/* Before an image: it has no NIS and no rows yet. */
void goe_health_expect(goe_health_t *health);

/* After the update by an image. nis: its normalized innovation squared, of verdict.rows rows. */
void goe_health_take(goe_health_t *health, goe_verdict_t verdict, float nis);

/* The same if every point of the image was refused: it counts as the worst fit. */
void goe_health_take_refused(goe_health_t *health, goe_verdict_t verdict);

/* Judges the filter after an image: counts refused points, and frees the top if that alone was refused for some images. Returns whether
 * the filter must start again: because points that are refused image after image captured the state when they were outliers, or because
 * the state is impossible. After repeated failures of a box by base corners, its base corners are no longer used. */
bool goe_health_judge(goe_filter_t *filter, goe_model_t asked, goe_verdict_t verdict);

#endif
