/* The flights in which bits are flipped. SPDX-License-Identifier: MIT */
#ifndef FLIGHTS_H
#define FLIGHTS_H

#include "goe.h"

#define FLIGHT_IMAGES 96

typedef struct {
    const char *name;
    goe_settings_t settings;
    goe_image_t image[FLIGHT_IMAGES]; /* the same in every run: noise of half a pixel */
    goe_intent_t intent;              /* straight on */
} flipped_flight_t;

/* Flight number `which`; false if there is none. */
bool flights_make(int which, flipped_flight_t *flight);

#endif
