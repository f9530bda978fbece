/* Which detection belongs to which slot, and which slot is given up. SPDX-License-Identifier: MIT */
#ifndef GOE_FLIGHT_TABLE_H
#define GOE_FLIGHT_TABLE_H

#include "goe_flight.h"
#include "goe_slot.h"

/* All detections of a frame, each to its slot; with the last ones of an image the other slots are updated as undetected. Returns
 * whether the frame shows that the detector works: a readable detection, or an image without any. */
bool goe_flight_table_take(goe_flight_t *flight, const goe_flight_slot_view_t *view, const goe_flight_frame_t *frame);

/* Gives up tracks undetected for too long, except obstacles ahead on the course or of an order. */
void goe_flight_table_age(goe_flight_t *flight, uint32_t now_us);

/* Slots whose latest image is older than any that may still come are moved on to this view. */
void goe_flight_table_follow(goe_flight_t *flight, const goe_flight_slot_view_t *view);

#endif
