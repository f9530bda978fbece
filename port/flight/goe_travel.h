/* Comparison of the positions with the velocities. SPDX-License-Identifier: MIT */
#ifndef GOE_FLIGHT_TRAVEL_H
#define GOE_FLIGHT_TRAVEL_H

#include "goe_flight.h"

/* Takes a sample that was checked and is newer than the previous one. */
void goe_flight_travel_take(goe_flight_travel_t *travel, const goe_flight_position_t *sample);

/* Shifts the comparison by a known jump of the autopilot's filter. */
void goe_flight_travel_shift(goe_flight_travel_t *travel, const float jump_ned_m[3]);

/* To be called after a jump of unknown size: the next sample begins a new comparison. */
void goe_flight_travel_restart(goe_flight_travel_t *travel);

#endif
