/* Which detection belongs to which slot, and which slot is given up. SPDX-License-Identifier: MIT */
#ifndef GOE_FLIGHT_TABLE_H
#define GOE_FLIGHT_TABLE_H

#include "goe_flight.h"
#include "goe_slot.h"

/* All detections of a frame, each to its slot; with the last ones of an image the other slots learn that they were not seen. Returns
 * whether the frame shows that the detector works: a detection that can be read, or an image without any. */
bool goe_flight_table_take(goe_flight_t *flight, const goe_flight_slot_view_t *view, const goe_flight_frame_t *frame);

/* Gives up what was not seen for too long, but not what stands ahead on the course or what an order is about. */
void goe_flight_table_age(goe_flight_t *flight, uint32_t now_us);

/* Slots whose latest image is older than any that may still come are moved on to this view. */
void goe_flight_table_follow(goe_flight_t *flight, const goe_flight_slot_view_t *view);

#endif
