/* Assigns detections to slots, and ends tracks. SPDX-License-Identifier: MIT */
#ifndef GOE_FLIGHT_TABLE_H
#define GOE_FLIGHT_TABLE_H

#include "goe_flight.h"
#include "goe_slot.h"

/* Passes each detection of a frame to its slot. After the last detection of an image, the other slots are updated as undetected. Returns
 * whether the frame shows that the detector is alive: it has a readable detection, or the image has none. */
bool goe_flight_table_take(goe_flight_t *flight, const goe_flight_slot_view_t *view, const goe_flight_frame_t *frame);

/* Ends tracks that have been undetected for track_timeout_s, or for the following time if it is longer: during an order 120 s, and 600 s for
 * the order's obstacle; shortly after an order 600 s; for an obstacle that moves 30 s. Tracks of hazards ahead on the course continue. */
void goe_flight_table_age(goe_flight_t *flight, uint32_t now_us);

/* Updates, as undetected, the slots whose latest image is older than this view. Images older than this view no longer arrive. */
void goe_flight_table_follow(goe_flight_t *flight, const goe_flight_slot_view_t *view);

#endif
