/* The size and the shape of the detector's class. SPDX-License-Identifier: MIT
 *
 * The state never keeps a size: a wrong one would turn growth of the image into motion, and the state could no longer show the error. The
 * size gives the prior range, and an estimate until the images know the range themselves. Each image tests the size. */
#ifndef GOE_KIND_H
#define GOE_KIND_H

#include "refined/goe_filter.h"
#include "refined/goe_observation.h"

/* Range by the better known size, m; 0 if no size is known. across, up: angular sizes, 0 if not visible. */
float goe_kind_range_m(const goe_kind_t *kind, float across, float up);

/* Call when the filter starts. by_kind: at the range of the class. */
void goe_kind_start(goe_filter_t *filter, const goe_observation_t *obs, bool by_kind);

/* Call when an image shows the obstacle at a place that the state excludes, and no image can correct this: the prior range was too near.
 * The filter restarts, without the class if the prior was that of the class, otherwise from a farther prior. */
void goe_kind_start_farther(goe_filter_t *filter);

/* The class is wrong: the filter ignores it to the end of the track. */
void goe_kind_reject(goe_filter_t *filter);

/* Prior width without a class, m, after `passed` priors that were too near. */
float goe_kind_prior_width_m(const goe_settings_t *settings, unsigned passed);

/* After the rows of an image: takes its sizes, and compares them with the state, which does not contain them. */
void goe_kind_test(goe_filter_t *filter, const goe_observation_t *obs);

/* State and root without the sizes. */
typedef struct {
    float state[GOE_STATES];
    goe_triangle_t root;
} goe_kind_saved_t;

/* Adds the sizes to the state for one estimate, if the images do not contradict them, and do not know the range. False if it did
 * nothing. */
bool goe_kind_apply(goe_filter_t *filter, goe_kind_saved_t *saved);
void goe_kind_restore(goe_filter_t *filter, const goe_kind_saved_t *saved);

#endif
