/* The memory of the slowly varying (correlated) error of a box's side. SPDX-License-Identifier: MIT
 *
 * The error is a first-order process with the sigma s and the time constant tau. As the obstacle does not move, the residuals so far
 * determine the error for a given state. Its mean is linear in the state, so it needs no state of its own. (R28) to (R30). */
#ifndef GOE_SIDE_MEMORY_H
#define GOE_SIDE_MEMORY_H

#include "refined/goe_observation.h"

/* Fades the error to the present image. fade: the share of it that remains; variance: s^2 now. */
void goe_side_memory_fade(goe_side_memory_t *side, float fade, float variance);

/* Removes the known part of the error from a row's residual and derivatives, and adds the variance of the rest. */
void goe_side_memory_recall(const goe_side_memory_t *side, float row[GOE_COLUMNS], float *variance);

/* Updates the error by a row, after the gate, times its weight. The rows of an image share the error of its attitude and position, which is
 * no error of a side: its estimate, own times the row plus both times that of the opposite side, is removed. */
void goe_side_memory_learn(goe_side_memory_t *side, const float row[GOE_COLUMNS], float weight, float own,
                           const float opposite[GOE_COLUMNS], float both);

/* After the state has changed: relates the error to the new state. */
void goe_side_memory_follow(goe_side_memory_t *side, const float change[GOE_UNKNOWNS]);

#endif
