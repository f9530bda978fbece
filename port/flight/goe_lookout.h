/* The hazard of every obstacle from now on, and the worst of them. SPDX-License-Identifier: MIT */
#ifndef GOE_FLIGHT_LOOKOUT_H
#define GOE_FLIGHT_LOOKOUT_H

#include "goe_flight.h"

/* Factor on the margins of a slot (1, or suspect_factor if it is suspect), age of its estimate, and growth of its margins with this age. */
float goe_flight_lookout_doubt(const goe_flight_t *flight, const goe_flight_slot_t *slot);
float goe_flight_lookout_age_s(const goe_flight_slot_t *slot, uint32_t now_us);
float goe_flight_lookout_drift_m(const goe_flight_t *flight, const goe_flight_slot_t *slot, uint32_t now_us);

/* Computes the hazard of every slot. own_ned_m: present position of the aircraft. Returns the worst slot; -1 if no slot has a position. */
int goe_flight_lookout_assess(goe_flight_t *flight, const float own_ned_m[3], uint32_t now_us);

#endif
