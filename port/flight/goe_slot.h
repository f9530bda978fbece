/* One tracked obstacle: its estimator and its position. SPDX-License-Identifier: MIT */
#ifndef GOE_FLIGHT_SLOT_H
#define GOE_FLIGHT_SLOT_H

#include "goe_flight.h"
#include "goe_history.h"

/* Time and pose of an image, common to all slots. */
typedef struct {
    uint32_t time_us;     /* time of the exposure */
    int64_t estimator_us; /* the same time for the estimator; does not wrap */
    goe_flight_history_pose_t pose;
    uint8_t camera;
    float attitude_sd_deg;
    float ground_down_m, height_sd_m; /* ground and its sigma for new tracks */
} goe_flight_slot_view_t;

/* Starts a new track with the next image. */
void goe_flight_slot_begin(goe_flight_slot_t *slot, uint32_t id, uint32_t time_us);

/* To be called after an unknown reset of the autopilot's filter, or if the estimator's memory is corrupted: the next image starts a new
 * track. Until the estimator has a position again, the slot keeps its position and hazard, marked suspect. */
void goe_flight_slot_lose(goe_flight_slot_t *slot);

/* Radius of the circle around the center that contains the outline. An unknown width or length counts as 0. */
float goe_flight_slot_radius_m(const goe_flight_slot_t *slot);

#define GOE_FLIGHT_SLOT_SD_MIN_M2 0.25f /* no distance to a kept place is known better than to half a meter */

/* One sigma of the center along a horizontal vector; for a vector without a direction, at least the largest one. */
float goe_flight_slot_sd_along_m(const goe_flight_slot_t *slot, float north_m, float east_m);

/* Whether its obstacle was detected, but has no position, or one that does not follow its detections. */
bool goe_flight_slot_is_unplaced(const goe_flight_slot_t *slot);

/* Shifts the slot's obstacle by a jump of the autopilot's position. */
void goe_flight_slot_shift(goe_flight_slot_t *slot, const float jump_ned_m[3]);

/* Passes an image to the estimator, which the caller has reset if the image starts the slot's track. `seen` is the detection; null: the
 * image does not show the obstacle, and counts as one of the camera that detected it last. An image that is not newer than the slot's
 * latest image does not reach the estimator. Its detection is noted if it is newer than the slot's latest detection. */
void goe_flight_slot_take(goe_flight_slot_t *slot, const goe_flight_camera_t cameras[GOE_CAMERAS_MAX],
                          const goe_flight_slot_view_t *view, const float jumps_ned_m[3],
                          const goe_flight_detection_t *seen);

/* Whether the estimator accepts this kind. goe_flight_slot_take() leaves out any other, because the estimator would refuse the image. */
bool goe_flight_slot_is_good_kind(const goe_kind_t *kind);

/* Computes a detection's box in whole pixels, from its box or its points. Returns false if it has neither. */
bool goe_flight_slot_box_of(const goe_flight_detection_t *detection, int16_t box_px[4]);

/* Computes the possible bearings of a detection from the attitude at its exposure. */
void goe_flight_slot_bearings_of(const goe_flight_detection_t *detection, const goe_flight_camera_t *camera,
                                 const float q[4], goe_flight_bearings_t *bearings);

/* Returns how well this box matches the slot's obstacle in this view, 0 to 1; 0: no match. */
float goe_flight_slot_claims(const goe_flight_slot_t *slot, const goe_flight_camera_t cameras[GOE_CAMERAS_MAX],
                             const goe_flight_slot_view_t *view, const int16_t box_px[4]);

#endif
