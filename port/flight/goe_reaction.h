/* What to do about the worst obstacle. SPDX-License-Identifier: MIT */
#ifndef GOE_FLIGHT_REACTION_H
#define GOE_FLIGHT_REACTION_H

#include "goe_flight.h"

/* The aircraft now. */
typedef struct {
    float ned_m[3];
    uint32_t time_us;
    bool approach;
    bool grounded; /* it flares, or has touched down */
} goe_flight_reaction_own_t;

void goe_flight_reaction_clear(goe_flight_reaction_t *reaction);

/* A known jump of the autopilot's filter. */
void goe_flight_reaction_shift(goe_flight_reaction_t *reaction, const float jump_ned_m[3]);

/* The order after this look at the hazards, into flight->reaction. Returns the time that the best action against the worst
 * obstacle needs, 0 if there is none. */
float goe_flight_reaction_decide(goe_flight_t *flight, int worst, const goe_flight_reaction_own_t *own);

#endif
