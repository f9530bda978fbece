/*
 * goe_mavlink_map - conversion between MAVLink messages and the flight layer's structures
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 *
 * In:   GOE_FEATURES, LANDING_TARGET, CAMERA_TRACKING_IMAGE_STATUS  > goe_flight_frame_t with one detection
 * Out:  goe_flight_obstacle_t, goe_flight_assessment_t              > GOE_OBSTACLE, GOE_HAZARD, GOE_STATUS and the standard
 *       messages that present autopilots and ground stations support
 *
 * The functions are pure: a structure in, a structure out. From the C library they use only sqrtf, memcpy and memset.
 */
#ifndef GOE_MAVLINK_MAP_H
#define GOE_MAVLINK_MAP_H

#include "goe_flight.h"
#include "goe_mavlink.h"

#ifdef __cplusplus
extern "C" {
#endif

/* -------------------------------------------------------------------------------------------------------------- in -- */

/* A frame and its detection. The frame points at the detection, so do not copy this structure. */
typedef struct {
    goe_flight_frame_t frame;
    goe_flight_detection_t detection;
} goe_mavlink_sighting_t;

/* The camera of a standard message, because these messages contain neither the image's size nor the focal length. The principal
 * point is measured from the top left corner. */
typedef struct {
    float width_px, height_px, fx_px, fy_px, cx_px, cy_px;
    uint8_t number;         /* goe_flight_frame_t.camera */
    uint32_t delay_us;      /* calibrated time from the exposure to the message's arrival, for messages without a time */
    uint32_t delay_sd_us;   /* one sigma of delay_us */
    bool shares_clock;      /* LANDING_TARGET.time_usec is the time of the exposure by the autopilot's clock. Set it to false
                               if the clock is another one or not known; time_usec is then ignored */
} goe_mavlink_camera_t;

/* Each function returns true if the message contains an obstacle. If it contains none, the function returns false and makes an empty
 * frame of its camera, which shows that the detector is alive. If the message is invalid (unknown time base or camera, values not
 * finite, no image size), the function returns false and sets frame.camera to 255; goe_flight_frame() refuses this frame. Call
 * goe_flight_frame() in all three cases.
 *   arrival_us  time of arrival by the autopilot's clock */

/* The frame is empty if number is 0: nothing is in the image. A message with another number and no bit of visible makes a detection
 * without sides and points: an obstacle that cannot be located, so nothing is clear. A score of 0 counts as not known, because a
 * field that nobody set must not hide an obstacle. */
bool goe_mavlink_from_features(const goe_mavlink_features_t *message, uint32_t arrival_us,
                               goe_mavlink_sighting_t *sighting);

/* Computes the box from the tangents of the angles; each side must be within 80 degrees of the axis. The message does not name its
 * clock. The exposure is therefore delay_us before the arrival, unless shares_clock is set and the time is a time since boot (not 0,
 * less than 2^32 ms). The id is target_num + 1. The frame is never empty, because a sender without a target sends no message. */
bool goe_mavlink_from_landing_target(const goe_mavlink_landing_target_t *message, const goe_mavlink_camera_t *camera,
                                     uint32_t arrival_us, goe_mavlink_sighting_t *sighting);

/* The box is the rectangle, or the square around the point; radius is half its width, as a fraction of the image's width. The
 * message has neither time nor id: the exposure is delay_us before the arrival, and the id is 0. The frame is empty while the camera
 * does not track, or only predicts (coasting). */
bool goe_mavlink_from_tracking(const goe_mavlink_tracking_t *message, const goe_mavlink_camera_t *camera,
                               uint32_t arrival_us, goe_mavlink_sighting_t *sighting);

/* ------------------------------------------------------------------------------------------------------------- out -- */

/* Data for the messages in addition to the results of the flight layer. */
typedef struct {
    uint64_t time_usec;     /* time of the assessment by the autopilot's clock, does not wrap */
    uint64_t unix_usec;     /* UNIX time; 0: not known */
    float position_ned_m[3]; /* position of the aircraft */
    bool origin_known;
    float origin_alt_m;     /* altitude above sea level of down = 0 in the local frame */
    float heading_deg;      /* heading of the aircraft, from north, +-1e4; for OBSTACLE_DISTANCE */
} goe_mavlink_own_t;

/* Fills GOE_OBSTACLE. If the obstacle has no position (GOE_HAS_POSITION), all fields that depend on it are NaN. */
void goe_mavlink_to_obstacle(const goe_flight_obstacle_t *obstacle, int slot, const goe_mavlink_own_t *own,
                             goe_mavlink_obstacle_t *message);

/* Fills GOE_HAZARD for one obstacle. The message contains the action if the action avoids this obstacle. If the track of the avoided
 * obstacle has ended, the message of the worst obstacle contains the action. Returns false if the obstacle has no hazard. */
bool goe_mavlink_to_hazard(const goe_flight_obstacle_t *obstacle, int slot, const goe_flight_assessment_t *assessment,
                           const goe_mavlink_own_t *own, goe_mavlink_hazard_t *message);

/* Fills GOE_STATUS. It sets delay_mean and delay_max to 65535 (no image); the caller may replace them. */
void goe_mavlink_to_status(const goe_flight_counters_t *counters, const goe_flight_assessment_t *assessment,
                           unsigned self_check, const goe_mavlink_own_t *own, goe_mavlink_status_t *message);

/* Fills OBSTACLE_DISTANCE. Element i is centered on the bearing i times increment_deg, which is 5 to 180 and divides 360. An element
 * has the least distance of the sectors that it touches. It is unknown if one of these sectors is unknown and no sector has an
 * obstacle. An obstacle nearer than 1 cm is sent as 1 cm, because ArduPilot ignores 0. The frame is BODY_FRD with angle_offset =
 * -heading, because ArduPilot assumes the body frame for every message; PX4 supports both frames.
 *   max_cm  as for goe_flight_sectors(); 1 to 65000
 * Returns false for an increment, max_cm or heading out of range. */
bool goe_mavlink_to_obstacle_distance(const uint16_t sector_cm[GOE_FLIGHT_SECTORS], uint16_t max_cm,
                                      unsigned increment_deg, const goe_mavlink_own_t *own,
                                      goe_mavlink_obstacle_distance_t *message);

/* Fills OBSTACLE_DISTANCE_3D: the nearest point in the body frame (FRD). Send one message for each obstacle, all with the same time. If
 * the aircraft is at this point, the message has a point 1 cm ahead, because ArduPilot ignores 0. obstacle_id is the detector's id
 * modulo 65535; 65535 without an id. Returns false without a position. */
bool goe_mavlink_to_obstacle_distance_3d(const goe_flight_obstacle_t *obstacle, float max_m, const goe_mavlink_own_t *own,
                                         goe_mavlink_obstacle_distance_3d_t *message);

/* Fills COLLISION. The source is 1, because no source of the standard fits better. The threat level is 0 if the conflict probability is
 * below conflict_probability_max, otherwise 1; it is 2 from 0.5 on, or if the flight layer's action
 * avoids this obstacle and is late. The action is 1 (report) unless the flight layer's action avoids this obstacle: then 3 for left
 * and right, 2 for climb and go around, 6 for hold. altitude_minimum_delta is 0 below the top, and if the top is not known. Returns
 * false without a hazard. */
bool goe_mavlink_to_collision(const goe_flight_obstacle_t *obstacle, int slot, const goe_flight_assessment_t *assessment,
                              float conflict_probability_max, goe_mavlink_collision_t *message);

/* Fills TARGET_ABSOLUTE: the middle of the base, with the capability position. position_std has the root of the summed horizontal
 * variances, and NaN for the vertical sigma, because the sigma of the ground is not known here. Returns false without a position, and
 * while the origin or the UNIX time is not known. */
bool goe_mavlink_to_target_absolute(const goe_flight_obstacle_t *obstacle, int slot, const goe_mavlink_own_t *own,
                                    goe_mavlink_target_absolute_t *message);

/* Fills ADSB_VEHICLE: a static point obstacle, for autopilots that avoid traffic and treat it as points. The point is the middle of the
 * obstacle, at the lower of two altitudes: the top, and 1 m below the aircraft. If the top is not known, it is 1 m below the aircraft.
 * tslc is 0 during the whole track, because an avoiding turn takes the obstacle out of view and ArduPilot deletes traffic after 5 s.
 * The callsign is GOE and the slot + 1.
 *   icao_base  address of slot 0, 24 bits
 * Returns false without a position, while the origin is not known, and if own->position_ned_m or origin_alt_m are not finite. */
bool goe_mavlink_to_adsb_vehicle(const goe_flight_obstacle_t *obstacle, int slot, uint32_t icao_base,
                                 const goe_mavlink_own_t *own, goe_mavlink_adsb_vehicle_t *message);

#ifdef __cplusplus
}
#endif

#endif /* GOE_MAVLINK_MAP_H */
