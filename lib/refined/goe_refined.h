/* The filter method: a square-root information filter over the whole track. SPDX-License-Identifier: MIT */
#ifndef GOE_REFINED_H
#define GOE_REFINED_H

#include "image/goe_view.h"
#include "refined/goe_filter.h"

/* Processes one image. *swapped: number of pairs of points that are out of their order, left to right. Returns whether the image gave
 * information to the filter. */
bool goe_refined_update(goe_filter_t *filter, const goe_settings_t *settings, const goe_view_t *view,
                        unsigned *swapped);

#endif
