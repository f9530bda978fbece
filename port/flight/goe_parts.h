/* An image whose detections come in one call or several, and the view of the latest complete image. SPDX-License-Identifier: MIT */
#ifndef GOE_FLIGHT_PARTS_H
#define GOE_FLIGHT_PARTS_H

#include "goe_flight.h"
#include "goe_slot.h"

/* Counts the detections of a call. Returns whether the image is complete: all of its detections have come. */
bool goe_flight_parts_add(goe_flight_parts_t *parts, const goe_flight_slot_view_t *view,
                          const goe_flight_frame_t *frame);

/* Keeps the view of a complete image; now_us: time of the newest sample. */
void goe_flight_parts_keep(goe_flight_parts_t *parts, const goe_flight_slot_view_t *view, uint32_t now_us);

#endif
