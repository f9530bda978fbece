/* Writes the quantities and the fit of the images into the user's estimate. SPDX-License-Identifier: MIT */
#ifndef GOE_REPORT_H
#define GOE_REPORT_H

#include "refined/goe_quantities.h"

/* If the position is known, sets *estimate from the quantities and marks it fresh; otherwise keeps the last valid estimate and returns
 * false. */
bool goe_report_quantities(const goe_quantities_t *quantities, const goe_motion_t *motion, goe_estimate_t *estimate);

/* Sets the fields on the fit of the images: reason, suspect, latency, images_used, nis to nis_ratio. */
void goe_report_fit(const goe_filter_t *filter, const goe_settings_t *settings, goe_estimate_t *estimate);

#endif
