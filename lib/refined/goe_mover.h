/* The augmented states: latency of the poses, and motion of the obstacle. (R33) to (R36). SPDX-License-Identifier: MIT
 *
 * Both are taken as 0 at first, and the images' information on them is kept separately. When the latency is significant, it is estimated
 * with the state. When the velocity is, the filter restarts in axes that move with the obstacle. */
#ifndef GOE_MOVER_H
#define GOE_MOVER_H

#include "refined/goe_filter.h"
#include "refined/goe_observation.h"

#if GOE_AUGMENTED

/* Starts a new track: the poses count as on time, with the prior sigma, and nothing moves. */
void goe_mover_clear(goe_filter_t *filter);

/* Call after goe_rows_end(): sets the columns of the augmented states, which contain the derivatives by the place until then. */
void goe_mover_columns(const goe_axes_t *axes, const goe_observation_t *obs, goe_rows_t *rows);

/* Call after an image's update: applies the changes of the augmented states, and decides on latency and motion. True if the filter must
 * restart, because the obstacle has been found to move. */
bool goe_mover_judge(goe_filter_t *filter, const goe_observation_t *obs, const float change[GOE_UNKNOWNS],
                     float since_s);

/* Variance of the velocity of a followed obstacle, along a unit vector in T, m2/s2; by the images alone. */
float goe_mover_variance(const goe_filter_t *filter, goe_xz_t along);

/* Variance of the autopilot's own mean velocity over a time, each axis, m2/s2. */
float goe_mover_own_variance(const goe_navigation_t *navigation, float elapsed_s);

/* One sigma of the latency, s. */
float goe_mover_latency_sd(const goe_filter_t *filter);

#endif

#endif
