/* From the filter to the estimate that the user gets. SPDX-License-Identifier: MIT */
#ifndef GOE_REPORT_H
#define GOE_REPORT_H

#include "refined/goe_quantities.h"

/* Sets *estimate, fresh, from the quantities if the position is known; otherwise keeps the last valid estimate and returns
 * false. */
bool goe_report_quantities(const goe_quantities_t *quantities, const goe_motion_t *motion, goe_estimate_t *estimate);

/* How the latest image fits: nis to nis_ratio, suspect, points. */
void goe_report_fit(const goe_filter_t *filter, const goe_settings_t *settings, goe_estimate_t *estimate);

#endif
