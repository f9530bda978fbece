/* The answer: whether the filter's new one replaces the one before, and what goe_hazard() needs of it when no new one follows.
 * SPDX-License-Identifier: MIT */
#ifndef GOE_ANSWER_H
#define GOE_ANSWER_H

#include "refined/goe_filter.h"

/* After an update that returned true: sets *estimate from the filter's state. A quantity is known only if the image before
 * knew it, too: sigma and value come from the same linearization, so one image alone may be lucky. Returns
 * false, and keeps the last estimate, if the position is not known. */
bool goe_answer_update(goe_filter_t *filter, const goe_settings_t *settings, const goe_motion_t *motion,
                       goe_estimate_t *estimate);

#endif
