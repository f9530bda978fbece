/* New obstacles that wait for their confirmation, or for a slot. SPDX-License-Identifier: MIT */
#ifndef GOE_FLIGHT_CANDIDATE_H
#define GOE_FLIGHT_CANDIDATE_H

#include "goe_flight.h"

/* Intersection of two boxes (left, top, right, bottom) as a fraction of their union, 0 to 1. */
float goe_flight_candidate_overlap(const int16_t a[4], const int16_t b[4]);

/* Counts an image with this detection, which is identified by its id or, without an id, by its box. Returns true if `images` images
 * have shown it: it is then confirmed and leaves the table. The table has a fixed size. If it is full, the new candidate replaces the one
 * that has been undetected for the longest time, and the table is marked as crowded. */
bool goe_flight_candidate_confirm(goe_flight_waiting_t *waiting, const goe_flight_candidate_t *seen, int images);

/* Returns a confirmed detection that found no slot, or lost its slot, to the table, unless it has been undetected for a second. Its images
 * count again from the next one. */
void goe_flight_candidate_return(goe_flight_waiting_t *waiting, const goe_flight_candidate_t *seen, uint32_t now_us);

/* Marks the table as crowded: a detection of this time has no place in the table, and may be anywhere in the view. */
void goe_flight_candidate_crowd(goe_flight_waiting_t *waiting, uint32_t time_us);

/* To be called for each image of a camera: removes candidates of this camera that have been undetected for a second. */
void goe_flight_candidate_expire(goe_flight_waiting_t *waiting, uint8_t camera, uint32_t time_us);

/* Removes the candidates of all cameras that have been undetected for ten seconds, even without an image. Otherwise times of half an hour
 * ago would look like future times. */
void goe_flight_candidate_bury(goe_flight_waiting_t *waiting, uint32_t now_us);

/* Least number of waiting detections; 0: none. */
int goe_flight_candidate_count(const goe_flight_waiting_t *waiting);

#endif
