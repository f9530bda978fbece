/* Text of `goe status`. SPDX-License-Identifier: MIT */
#pragma once

#include <stddef.h>
#include <uORB/topics/goe_obstacle.h>
#include <uORB/topics/goe_status.h>

#include "goe_flight.h"

/* Content of the operator's report: copies of the latest publications. */
struct GoeOverview {
    goe_status_s status;
    goe_obstacle_s obstacle[GOE_FLIGHT_SLOTS]; /* with a position */
    uint8_t obstacles;
    float north_m, east_m; /* the aircraft */
    int32_t react;
    const char *bad_field; /* parameter that was refused, by the setting's name; null: none */
    uint8_t phase;         /* GOE_FLIGHT_FLYING, ... */
};

/* Name of the parameter that sets a setting; the setting's name itself if no parameter does. */
const char *goe_text_parameter(const char *setting);

constexpr size_t GOE_TEXT_LINE = 128;

/* Line `number` of the status, from 0 on, without its end. False: there is none of that number. */
bool goe_text_status(const GoeOverview &overview, unsigned number, char line[GOE_TEXT_LINE]);
