/* Margins that follow the doubt about where the aircraft is. SPDX-License-Identifier: MIT */
#ifndef MARGINS_H
#define MARGINS_H

#include "companion_config.h"
#include "goe_flight.h"

/* Margin and clearance of the configuration, times flight.suspect_factor while there is doubt. All that the flight layer knows stays.
 * False: the margins stay as they were. */
bool margins_set(goe_flight_t *flight, const companion_config_t *config, bool in_doubt);

#endif
