/* Capture time of an image by the autopilot's clock. SPDX-License-Identifier: MIT */
#ifndef GOE_FLIGHT_CLOCK_H
#define GOE_FLIGHT_CLOCK_H

#include "goe_flight.h"

/* Returns the time of the exposure and its one sigma, and updates the clock with this message. */
uint32_t goe_flight_clock_capture(goe_flight_clock_t *clock, const goe_flight_frame_t *frame,
                                  const goe_flight_settings_t *settings, uint32_t *sd_us);

/* Forgets the one-way offset if no message has changed it for 100 s. Call it with each sample: times of half an hour ago would look like
 * future times. */
void goe_flight_clock_bury(goe_flight_clock_t *clock, uint32_t now_us);

/* Sets the two-way offset; sd_us 0xFFFFFFFF: the offset is no longer known. */
void goe_flight_clock_sync(goe_flight_clock_t *clock, uint32_t offset_us, uint32_t sd_us);

#endif
