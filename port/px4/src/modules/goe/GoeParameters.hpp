/* Parameters as the settings of estimator and flight layer. SPDX-License-Identifier: MIT */
#pragma once

#include <stdint.h>

#include "goe_flight.h"

/* Bits of GOE_IN, GOE_OUT and GOE_REACT. */
enum GoeInput : int32_t { GOE_IN_TUNNEL = 1, GOE_IN_LANDING_TARGET = 2 };
enum GoeOutput : int32_t { GOE_OUT_DISTANCES = 1, GOE_OUT_DETECT_AND_AVOID = 2 };
enum GoeReact : int32_t { GOE_REACT_REPOSITION = 1, GOE_REACT_GO_AROUND = 2 };

struct GoeParameters {
    /* Settings at initialization: a change ends all tracks. */
    goe_settings_t estimator;
    goe_flight_settings_t flight;
    /* What takes effect at once. */
    float target_delay_s;                   /* GOE_LT_DELAY */
    int32_t inputs, outputs, react, resume; /* GOE_IN, GOE_OUT, GOE_REACT, GOE_RESUME */
    /* NAV_LOITER_RAD, if the circle that is flown is wider than that; else 0. */
    float narrow_loiter_m;
};

/* All defaults of the settings, then the values measured with PX4, those of the vehicle's own parameters, and those of the parameters.
 * Marks them as used, so that ground stations list them. Without wings there is no loiter circle. */
void goe_parameters_read(GoeParameters &parameters, bool has_wings);

/* Whether the layer would have to be initialized again. */
bool goe_parameters_differ(const GoeParameters &a, const GoeParameters &b);
