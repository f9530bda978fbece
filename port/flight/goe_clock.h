/* When an image was taken, in the autopilot's clock. SPDX-License-Identifier: MIT */
#ifndef GOE_FLIGHT_CLOCK_H
#define GOE_FLIGHT_CLOCK_H

#include "goe_flight.h"

/* The exposure's time and its one sigma, and the clock updated by this message. */
uint32_t goe_flight_clock_capture(goe_flight_clock_t *clock, const goe_flight_frame_t *frame,
                                  const goe_flight_settings_t *settings, uint32_t *sd_us);

/* A two-way offset; sd_us 0xFFFFFFFF: none any more. */
void goe_flight_clock_sync(goe_flight_clock_t *clock, uint32_t offset_us, uint32_t sd_us);

#endif
