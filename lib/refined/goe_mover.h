/* The augmented states: latency of the poses, and motion of the obstacle. (R33) to (R36). SPDX-License-Identifier: MIT
 *
 * The latency is estimated with the state, from the first image on. The velocity is taken as 0, and the images' information on it is
 * kept separately, until it is significant: then the filter begins again, in axes that move along. */
#ifndef GOE_MOVER_H
#define GOE_MOVER_H

#include "refined/goe_filter.h"
#include "refined/goe_observation.h"

#if GOE_AUGMENTED

/* A new track: the poses are in time, as far as is known, and nothing moves. */
void goe_mover_clear(goe_filter_t *filter);

/* The columns of the augmented states. They hold the derivatives by the place until then; after goe_rows_end(). */
void goe_mover_columns(const goe_observation_t *obs, goe_rows_t *rows);

/* After an image's update: follows the changes of the augmented states, and decides on latency and motion. True if the filter
 * must begin again, as the obstacle has been found to move. */
bool goe_mover_judge(goe_filter_t *filter, const goe_observation_t *obs, const float change[GOE_UNKNOWNS],
                     float since_s);

/* Variance of the velocity of an obstacle that is followed, along a unit vector in T, m2/s2; of the images alone. */
float goe_mover_variance(const goe_filter_t *filter, goe_xz_t along);

/* Variance of the autopilot's own velocity over a time, each axis, m2/s2. */
float goe_mover_own_variance(const goe_navigation_t *navigation, float elapsed_s);

/* One sigma of the latency, s. */
float goe_mover_latency_sd(const goe_filter_t *filter);

#endif

#endif
