/* New obstacles that wait for their confirmation, or for a slot. SPDX-License-Identifier: MIT */
#ifndef GOE_FLIGHT_CANDIDATE_H
#define GOE_FLIGHT_CANDIDATE_H

#include "goe_flight.h"

/* Share of the union of two boxes (left, top, right, bottom) that both cover, 0 to 1. */
float goe_flight_candidate_overlap(const int16_t a[4], const int16_t b[4]);

/* One more image of this detection, by its id or, without one, its box. Returns true once it was detected in `images` of them: it is
 * no candidate any more. The table is fixed: when it is full, the candidate undetected for the longest is forgotten, and the table is
 * crowded. */
bool goe_flight_candidate_confirm(goe_flight_waiting_t *waiting, const goe_flight_candidate_t *seen, int images);

/* A confirmed detection found no slot, or lost it: it waits again, and its images count from the next one. */
void goe_flight_candidate_return(goe_flight_waiting_t *waiting, const goe_flight_candidate_t *seen);

/* A detection of this time can have no place: it may be anywhere in the view. */
void goe_flight_candidate_crowd(goe_flight_waiting_t *waiting, uint32_t time_us);

/* An image of a camera has come: what it did not detect for a second does not wait any more. */
void goe_flight_candidate_expire(goe_flight_waiting_t *waiting, uint8_t camera, uint32_t time_us);

/* The same of all cameras after ten seconds, without an image: times of half an hour ago would look like future ones. */
void goe_flight_candidate_bury(goe_flight_waiting_t *waiting, uint32_t now_us);

/* At least so many wait; 0: none. */
int goe_flight_candidate_count(const goe_flight_waiting_t *waiting);

#endif
