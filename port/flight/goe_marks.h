/* Resets of the autopilot's filter, by its counters or times. SPDX-License-Identifier: MIT */
#ifndef GOE_FLIGHT_MARKS_H
#define GOE_FLIGHT_MARKS_H

#include "goe_flight.h"

typedef enum { GOE_FLIGHT_MARKS_SAME, GOE_FLIGHT_MARKS_JUMP, GOE_FLIGHT_MARKS_UNKNOWN } goe_flight_marks_change_t;

/* An attitude's mark: the same, or an unknown reset. */
goe_flight_marks_change_t goe_flight_marks_attitude(goe_flight_marks_t *marks, uint32_t mark);

/* A position's marks. A jump is added to the running sum and returned separately. */
goe_flight_marks_change_t goe_flight_marks_position(goe_flight_marks_t *marks, const goe_flight_position_t *sample,
                                                    bool counters, float jump_ned_m[3]);

#endif
