/* Flipped bits of the layer's settings. SPDX-License-Identifier: MIT */
#ifndef GOE_FLIGHT_SEAL_H
#define GOE_FLIGHT_SEAL_H

#include "goe_flight.h"

/* Seals settings and cameras: from then on they change no more. */
void goe_flight_seal(goe_flight_t *flight);

/* Whether they are as they were. */
bool goe_flight_is_sealed(const goe_flight_t *flight);

/* The settings of the estimators are lost: goe_flight_is_sealed() is false from now on. */
void goe_flight_unseal(goe_flight_t *flight);

#endif
