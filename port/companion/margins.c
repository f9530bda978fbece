/* Margins that follow the doubt about where the aircraft is. SPDX-License-Identifier: MIT */
#include "margins.h"

#define MARGIN_MAX_M 1000.0f /* range of both settings */

static float widened_m(float margin_m, float doubt) {
    const float wide_m = margin_m * doubt;
    return wide_m < MARGIN_MAX_M ? wide_m : MARGIN_MAX_M;
}

bool margins_set(goe_flight_t *flight, const companion_config_t *config, bool in_doubt) {
    goe_flight_settings_t settings = config->flight;
    if (in_doubt) {
        settings.margin_m = widened_m(settings.margin_m, settings.suspect_factor);
        settings.clearance_m = widened_m(settings.clearance_m, settings.suspect_factor);
    }
    return goe_flight_change_settings(flight, &settings, NULL) == GOE_FLIGHT_OK;
}
