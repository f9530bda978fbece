/* The refined method: a square-root information filter over the whole track. SPDX-License-Identifier: MIT */
#ifndef GOE_REFINED_H
#define GOE_REFINED_H

#include "refined/goe_observation.h"
#include "refined/goe_srif.h"

typedef enum {
    GOE_PHASE_NONE,  /* not started */
    GOE_PHASE_DISC,  /* a disc, also as a stand-in for a box whose orientation is not known yet */
    GOE_PHASE_CHORD, /* the line between the silhouette's ends: a box of which no base corner was seen */
    GOE_PHASE_BOX
} goe_phase_t;

/* Images in a row; saturates. Returns the new count. */
static inline unsigned goe_refined_count(uint8_t *count) {
    *count = (uint8_t)(*count < UINT8_MAX ? *count + 1 : UINT8_MAX);
    return *count;
}

/* The inverse is that of R. */
static inline void goe_refined_settle(goe_filter_t *filter) {
    filter->drift_rad2 = 0.0f;
    filter->walk2 = 0.0f;
}

/* Brings the inverse up to date with R. */
static inline void goe_refined_invert(goe_filter_t *filter) {
    goe_srif_invert(&filter->root, &filter->inverse);
    goe_refined_settle(filter);
}

/* Enters a phase: what counts images of the phase begins anew. */
static inline void goe_refined_enter(goe_filter_t *filter, goe_phase_t phase) {
    filter->phase = (uint8_t)phase;
    filter->agreeing = 0;
    filter->poor = 0;
    filter->known = 0;
    filter->since = 0;
    filter->level = -1.0f; /* the first image of a phase does not count */
}

/* Takes one image, whose ego motion the estimator holds. swapped: how many pairs of points are out of their
 * order, left to right; they are marked as not usable.
 * Returns whether the image gave the filter anything. */
bool goe_refined_update(goe_estimator_t *estimator, const float camera_to_trajectory[9], goe_view_t *view,
                        unsigned *swapped);

#endif
