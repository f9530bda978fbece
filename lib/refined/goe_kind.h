/* The size and the shape that the detector's class says. SPDX-License-Identifier: MIT
 *
 * A size is information on the state once, as the class of a track is one fact, not one in each image: (R38), (R39). Images that
 * contradict it later show a wrong class. */
#ifndef GOE_KIND_H
#define GOE_KIND_H

#include "refined/goe_filter.h"
#include "refined/goe_observation.h"

/* A range by the size, and one sigma of it as a share. */
typedef struct {
    float range_m, share;
} goe_kind_range_t;

/* Of angular sizes across and up, 0: not seen. Share 0: no size is known. */
goe_kind_range_t goe_kind_range(const goe_kind_t *kind, float across, float up);

/* The filter starts: what an earlier start used counts no more. */
void goe_kind_start(goe_filter_t *filter, const goe_observation_t *obs);

/* Appends the rows of sizes that are not used yet, if space remains. Returns how many. */
int goe_kind_rows(goe_filter_t *filter, const goe_observation_t *obs, goe_rows_t *rows);

/* After the rows of an image. Whether the sizes prove wrong: the filter must start again, without them. */
bool goe_kind_contradicts(goe_filter_t *filter);

#endif
