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

/* The filter starts. */
void goe_kind_start(goe_filter_t *filter, const goe_observation_t *obs);

/* After the rows of an image: takes its sizes, and compares them with what the images know without them. */
void goe_kind_test(goe_filter_t *filter, const goe_observation_t *obs);

/* State and root without the sizes. */
typedef struct {
    float state[GOE_STATES];
    goe_triangle_t root;
} goe_kind_loan_t;

/* For one answer the sizes enter the state, if the images do not know the range to range_share. False: nothing was done. */
bool goe_kind_lend(goe_filter_t *filter, float range_share, goe_kind_loan_t *loan);
void goe_kind_return(goe_filter_t *filter, const goe_kind_loan_t *loan);

#endif
