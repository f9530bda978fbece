/* Detects resets of the autopilot's filter by its reset counters or reset times. SPDX-License-Identifier: MIT */
#ifndef GOE_FLIGHT_MARKS_H
#define GOE_FLIGHT_MARKS_H

#include "goe_flight.h"

typedef enum { GOE_FLIGHT_MARKS_SAME, GOE_FLIGHT_MARKS_JUMP, GOE_FLIGHT_MARKS_UNKNOWN } goe_flight_marks_change_t;

/* Compares the mark of an attitude: unchanged, or an unknown reset. */
goe_flight_marks_change_t goe_flight_marks_attitude(goe_flight_marks_t *marks, uint32_t mark);

/* Compares the marks of a position. A known jump is added to the sum of jumps, and returned in jump_ned_m.
 *   counters  the marks are counters (PX4), not times (ArduPilot) */
goe_flight_marks_change_t goe_flight_marks_position(goe_flight_marks_t *marks, const goe_flight_position_t *sample,
                                                    bool counters, float jump_ned_m[3]);

#endif
