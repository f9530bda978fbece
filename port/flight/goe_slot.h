/* One tracked obstacle: its estimator, and its position. SPDX-License-Identifier: MIT */
#ifndef GOE_FLIGHT_SLOT_H
#define GOE_FLIGHT_SLOT_H

#include "goe_flight.h"
#include "goe_history.h"

/* An image as the flight layer knows it, for every slot the same. */
typedef struct {
    uint32_t time_us;     /* of the exposure */
    int64_t estimator_us; /* the same for the estimator: never wraps */
    goe_flight_history_pose_t pose;
    uint8_t camera;
    float attitude_sd_deg;
    float ground_down_m, height_sd_m; /* for tracks that begin */
} goe_flight_slot_view_t;

/* A new track begins with the next image. */
void goe_flight_slot_begin(goe_flight_slot_t *slot, uint32_t id, uint32_t time_us);

/* An unknown reset of the autopilot's filter, or corrupted memory of the estimator: the track begins again with the next image. Until the
 * estimator knows a position again the slot keeps place and hazard, suspect. */
void goe_flight_slot_lose(goe_flight_slot_t *slot);

/* The circle about the center that contains the outline, as far as it is known. */
float goe_flight_slot_radius_m(const goe_flight_slot_t *slot);

/* Whether its obstacle was detected and has no position yet. */
bool goe_flight_slot_is_unplaced(const goe_flight_slot_t *slot);

/* A known one. */
void goe_flight_slot_shift(goe_flight_slot_t *slot, const float jump_ned_m[3]);

/* Gives an image to the estimator, which has been reset if the slot's track begins with it: with its detection, or none (null), then as by
 * the camera that detected it last. An image that is not newer than the slot's latest is left out. */
void goe_flight_slot_take(goe_flight_slot_t *slot, const goe_flight_camera_t cameras[GOE_CAMERAS_MAX],
                          const goe_flight_slot_view_t *view, const float jumps_ned_m[3],
                          const goe_flight_detection_t *seen);

/* Points of a detection's border as a box, whole pixels; false: it has none. */
bool goe_flight_slot_box_of(const goe_flight_detection_t *detection, int16_t box_px[4]);

/* Where it may be, by the attitude at its exposure. */
void goe_flight_slot_bearings_of(const goe_flight_detection_t *detection, const goe_flight_camera_t *camera,
                                 const float q[4], goe_flight_bearings_t *bearings);

/* Whether this box, in this view, is likely to be of the slot's obstacle: how near, 0 to 1; 0: not. */
float goe_flight_slot_claims(const goe_flight_slot_t *slot, const goe_flight_camera_t cameras[GOE_CAMERAS_MAX],
                             const goe_flight_slot_view_t *view, const int16_t box_px[4]);

#endif
