/* Chooses the order against the worst obstacle. SPDX-License-Identifier: MIT */
#ifndef GOE_FLIGHT_REACTION_H
#define GOE_FLIGHT_REACTION_H

#include "goe_flight.h"

/* Present state of the aircraft. */
typedef struct {
    float ned_m[3];
    uint32_t time_us;
    bool approach;
    bool grounded; /* the aircraft flares, or has touched down */
} goe_flight_reaction_own_t;

void goe_flight_reaction_clear(goe_flight_reaction_t *reaction);

/* Shifts the active order by a known jump of the autopilot's filter. */
void goe_flight_reaction_shift(goe_flight_reaction_t *reaction, const float jump_ned_m[3]);

/* Chooses the order from the present hazards and stores it in flight->reaction. Returns the time that the order needs; without an order,
 * the time that the best action against the worst obstacle would need; 0 without a worst obstacle. */
float goe_flight_reaction_decide(goe_flight_t *flight, int worst, const goe_flight_reaction_own_t *own);

#endif
