/* Seal of the layer's settings, which reveals flipped bits. SPDX-License-Identifier: MIT */
#ifndef GOE_FLIGHT_SEAL_H
#define GOE_FLIGHT_SEAL_H

#include "goe_flight.h"

/* Seals settings and cameras. Any later change breaks the seal. */
void goe_flight_seal(goe_flight_t *flight);

/* Returns whether settings and cameras are unchanged since goe_flight_seal(). */
bool goe_flight_is_sealed(const goe_flight_t *flight);

/* To be called if the settings of all estimators are lost: goe_flight_is_sealed() then returns false. */
void goe_flight_unseal(goe_flight_t *flight);

#endif
