/* The hazard of every obstacle from now on, and the worst of them. SPDX-License-Identifier: MIT */
#ifndef GOE_FLIGHT_LOOKOUT_H
#define GOE_FLIGHT_LOOKOUT_H

#include "goe_flight.h"

/* Factor on the margins for a slot's doubt, and the addition for its age. */
float goe_flight_lookout_doubt(const goe_flight_t *flight, const goe_flight_slot_t *slot);
float goe_flight_lookout_age_s(const goe_flight_slot_t *slot, uint32_t now_us);
float goe_flight_lookout_drift_m(const goe_flight_t *flight, const goe_flight_slot_t *slot, uint32_t now_us);

/* Fills every slot's hazard; own_ned_m: where the aircraft is now. Returns the worst slot, -1 if none has a position. */
int goe_flight_lookout_assess(goe_flight_t *flight, const float own_ned_m[3], uint32_t now_us);

#endif
