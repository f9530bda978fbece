/* The size and the shape that the detector's class says. SPDX-License-Identifier: MIT
 *
 * The filter never takes a size in: a wrong one would turn growth into motion, and the state would no longer show which. The size
 * gives the first guess of the range, and an answer until the images know the range themselves. Each image tests it. */
#ifndef GOE_KIND_H
#define GOE_KIND_H

#include "refined/goe_filter.h"
#include "refined/goe_observation.h"

/* By the better known size, of the angular sizes across and up, 0: not visible. 0: no size is known. */
float goe_kind_range_m(const goe_kind_t *kind, float across, float up);

/* The filter starts; by_kind: at the range of the class. */
void goe_kind_start(goe_filter_t *filter, const goe_observation_t *obs, bool by_kind);

/* An image shows the obstacle where the state cannot have it, and no image corrects that: the first guess of the range was too near. The
 * filter starts again, without the class if the guess was that of the class, otherwise from a farther guess. */
void goe_kind_start_farther(goe_filter_t *filter);

/* The class is wrong: the filter ignores it to the end of the track. */
void goe_kind_reject(goe_filter_t *filter);

/* Width that a first guess without a class assumes, m, when so many were too near. */
float goe_kind_prior_width_m(const goe_settings_t *settings, unsigned passed);

/* After the rows of an image: takes its sizes, and compares them with what the images know without them. */
void goe_kind_test(goe_filter_t *filter, const goe_observation_t *obs);

/* State and root without the sizes. */
typedef struct {
    float state[GOE_STATES];
    goe_triangle_t root;
} goe_kind_saved_t;

/* For one answer the sizes enter the state, if the images do not contradict them, and do not know the range. False: nothing was done. */
bool goe_kind_apply(goe_filter_t *filter, goe_kind_saved_t *saved);
void goe_kind_restore(goe_filter_t *filter, const goe_kind_saved_t *saved);

#endif
