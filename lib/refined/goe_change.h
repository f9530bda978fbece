/* Changes of the model: when the images show a box, its second face, or its front where the side was.
 * SPDX-License-Identifier: MIT */
#ifndef GOE_CHANGE_H
#define GOE_CHANGE_H

#include "refined/goe_refined.h"

/* Both return whether there was a change. It costs as much as a measurement: the image that brings it is not used for more.
 *
 * Of a disc, or of a chord (goe_chord.h): turns it into a box as soon as two faces are seen, or enough images agree on the
 * direction of one. */
bool goe_change_to_box(goe_filter_t *filter, const goe_observation_t *sight);

/* Of a box: frees its length when a second face comes into view, and exchanges front and side if the side lies across. */
bool goe_change_box(goe_filter_t *filter, const goe_observation_t *sight);

#endif
