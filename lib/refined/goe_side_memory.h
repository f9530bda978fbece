/* The slowly varying (correlated) error of a box's side. SPDX-License-Identifier: MIT
 *
 * A first-order process of the sigma s and the time constant tau. As the obstacle stands still, the residuals so far determine
 * the error, given the state: it is linear in the state, so the process needs no state of its own. (R28) to (R30). */
#ifndef GOE_SIDE_MEMORY_H
#define GOE_SIDE_MEMORY_H

#include "refined/goe_observation.h"

/* Over the time that an image's share of the error fades to `fade`. variance: s^2 now. */
void goe_side_memory_fade(goe_side_memory_t *side, float fade, float variance);

/* Removes the known part of the error from a row: its residual, its derivatives, its variance. */
void goe_side_memory_recall(const goe_side_memory_t *side, float row[GOE_COLUMNS], float *variance);

/* The row's information on the error. row: after the gate, times its weight; common: variance, in units of the row's, of the part that all
 * rows of the image share (attitude, position). */
void goe_side_memory_learn(goe_side_memory_t *side, const float row[GOE_COLUMNS], float weight, float common);

/* After the state has changed. */
void goe_side_memory_follow(goe_side_memory_t *side, const float change[GOE_UNKNOWNS]);

#endif
