/* Margins, which widen while the navigation is suspect. SPDX-License-Identifier: MIT */
#ifndef MARGINS_H
#define MARGINS_H

#include "companion_config.h"
#include "goe_flight.h"

/* Sets margin and clearance of the configuration, multiplied by flight.suspect_factor if in_doubt. The flight layer keeps its obstacles.
 * Returns false if the margins could not be changed. */
bool margins_set(goe_flight_t *flight, const companion_config_t *config, bool in_doubt);

#endif
