/* The update of the estimate from the filter's state, and the data that goe_hazard() needs when no new one follows.
 * SPDX-License-Identifier: MIT */
#ifndef GOE_ANSWER_H
#define GOE_ANSWER_H

#include "refined/goe_filter.h"

/* Call after a filter update that returned true: sets *estimate from the filter's state. A quantity is known only if the previous image
 * knew it as well: value and sigma come from the same linearization, so in one image alone a small sigma may be chance. Returns false, and
 * keeps the last estimate, if the position is not known. */
bool goe_answer_update(goe_filter_t *filter, const goe_settings_t *settings, const goe_motion_t *motion,
                       goe_estimate_t *estimate);

#endif
