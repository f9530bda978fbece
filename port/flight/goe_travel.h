/* Comparison of the positions with the velocities. SPDX-License-Identifier: MIT */
#ifndef GOE_FLIGHT_TRAVEL_H
#define GOE_FLIGHT_TRAVEL_H

#include "goe_flight.h"

/* Takes a sample that was checked and is newer than the previous one. */
void goe_flight_travel_take(goe_flight_travel_t *travel, const goe_flight_position_t *sample);

/* Shifts the comparison by a known jump of the autopilot's filter. */
void goe_flight_travel_shift(goe_flight_travel_t *travel, const float jump_ned_m[3]);

/* Finds the latest position, by the velocities since the way of a second began, and its time. Returns false if there is none. It outlasts
 * the history, which a reset of the attitude empties. */
bool goe_flight_travel_end(const goe_flight_travel_t *travel, float ned_m[3], uint32_t *time_us);

/* To be called after a jump of unknown size: the next sample begins a new comparison. */
void goe_flight_travel_restart(goe_flight_travel_t *travel);

#endif
