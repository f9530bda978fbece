/* Jumps of the position that no reset announces, by the velocity. SPDX-License-Identifier: MIT
 *
 * The slip is the distance of the positions from the way that the velocity gives. A position filter that works keeps it small.
 * The correction of a wrong GPS position moves the positions without the velocity, at once or within a second. */
#ifndef GOE_FLIGHT_SLIP_H
#define GOE_FLIGHT_SLIP_H

#include "goe_flight.h"

void goe_flight_slip_clear(goe_flight_slip_t *slip);

/* The distance of a sample from its prediction by the mean of two velocities, from the newest sample before it. */
void goe_flight_slip_between(const goe_flight_history_position_t *newest, const float before_m_s[3],
                             const float now_m_s[3], const goe_flight_position_t *sample, float off_ned_m[3]);

/* Takes the next such distance, over step_s. Returns true, and the jump, if the positions have jumped and the velocity has not. */
bool goe_flight_slip_jumped(goe_flight_slip_t *slip, const float off_ned_m[3], float step_s, float jump_ned_m[3]);

#endif
