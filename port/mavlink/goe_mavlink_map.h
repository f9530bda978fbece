/*
 * goe_mavlink_map - between MAVLink messages and the flight layer
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 *
 * In:   GOE_FEATURES, LANDING_TARGET, CAMERA_TRACKING_IMAGE_STATUS  > goe_flight_frame_t with one detection
 * Out:  goe_flight_obstacle_t, goe_flight_assessment_t              > GOE_OBSTACLE, GOE_HAZARD, GOE_STATUS and the standard
 *       messages that today's autopilots and ground stations understand
 *
 * Pure functions: structure in, structure out. Of the C library only sqrtf, memcpy and memset.
 */
#ifndef GOE_MAVLINK_MAP_H
#define GOE_MAVLINK_MAP_H

#include "goe_flight.h"
#include "goe_mavlink.h"

#ifdef __cplusplus
extern "C" {
#endif

/* -------------------------------------------------------------------------------------------------------------- in -- */

/* A frame and the one detection that it points at; do not copy it by value. */
typedef struct {
    goe_flight_frame_t frame;
    goe_flight_detection_t detection;
} goe_mavlink_sighting_t;

/* The camera of a standard message: these messages contain neither size nor focal length. Principal point from the top left
 * corner. */
typedef struct {
    float width_px, height_px, fx_px, fy_px, cx_px, cy_px;
    uint8_t number;         /* goe_flight_frame_t.camera */
    uint32_t delay_us;      /* from the exposure to the message's arrival, calibrated: for messages without a time */
    uint32_t delay_sd_us;   /* its one sigma */
    bool shares_clock;      /* LANDING_TARGET.time_usec is the autopilot's, of the exposure; false: it is ignored, which is
                               right for a sender that gives its own time since boot, or is not known */
} goe_mavlink_camera_t;

/* Each returns false, and an empty frame of its camera, if the message marks no obstacle: nothing in view, which also shows that
 * the detector is alive; and false with frame.camera 255, which goe_flight_frame() refuses, if the message is invalid:
 * an unknown time base or camera, not finite, no size.
 *   arrival_us  autopilot's clock */

/* Empty if nothing is visible: with number 0 nothing is in the image; with another number only not this one. */
bool goe_mavlink_from_features(const goe_mavlink_features_t *message, uint32_t arrival_us,
                               goe_mavlink_sighting_t *sighting);

/* Box by tan of the angles, each side within 80 degrees of the axis. The message does not say whose clock its time is of:
 * delay_us counts back from the arrival, unless the camera shares the autopilot's clock and the time is one since boot, that is
 * not 0 and below 2^32 ms. Id: target_num + 1. Never empty: a sender that sees nothing sends nothing. */
bool goe_mavlink_from_landing_target(const goe_mavlink_landing_target_t *message, const goe_mavlink_camera_t *camera,
                                     uint32_t arrival_us, goe_mavlink_sighting_t *sighting);

/* Rectangle, or the square about a point of that radius, a share of the image's width. Neither time nor id: delay_us; id 0.
 * Empty while the camera does not track, or only predicts (coasting). */
bool goe_mavlink_from_tracking(const goe_mavlink_tracking_t *message, const goe_mavlink_camera_t *camera,
                               uint32_t arrival_us, goe_mavlink_sighting_t *sighting);

/* ------------------------------------------------------------------------------------------------------------- out -- */

/* What the messages need besides the flight layer's answers. */
typedef struct {
    uint64_t time_usec;     /* autopilot's clock, of the assessment, not wrapping */
    uint64_t unix_usec;     /* 0: not known */
    float position_ned_m[3]; /* the aircraft's */
    bool origin_known;
    float origin_alt_m;     /* over the sea, of the local frame's down = 0 */
    float heading_deg;      /* the aircraft's, from north, +-1e4: for OBSTACLE_DISTANCE */
} goe_mavlink_own_t;

/* Without a position (GOE_HAS_POSITION) all of the place is NaN. */
void goe_mavlink_to_obstacle(const goe_flight_obstacle_t *obstacle, int slot, const goe_mavlink_own_t *own,
                             goe_mavlink_obstacle_t *message);

/* The hazard of one obstacle of the table; with the action if it is the one that the action is about, or if that was given up
 * and it is the worst. False: it has none. */
bool goe_mavlink_to_hazard(const goe_flight_obstacle_t *obstacle, int slot, const goe_flight_assessment_t *assessment,
                           const goe_mavlink_own_t *own, goe_mavlink_hazard_t *message);

/* delay_mean and delay_max are the caller's: set to 65535 here. */
void goe_mavlink_to_status(const goe_flight_counters_t *counters, const goe_flight_assessment_t *assessment,
                           unsigned self_check, const goe_mavlink_own_t *own, goe_mavlink_status_t *message);

/* OBSTACLE_DISTANCE: elements from north on, each about its bearing, of `increment_deg` 5 to 180 that divides 360. An element
 * takes the nearest of the sectors that it touches; not known if any of them is not and none has an obstacle. An obstacle
 * nearer than 1 cm is sent as 1 cm: ArduPilot ignores 0. Frame BODY_FRD with angle_offset = -heading: ArduPilot takes every
 * message for one of the body frame, PX4 knows both.
 *   max_cm  as given to goe_flight_sectors(); 1 to 65000
 * False for another increment, max_cm or heading. */
bool goe_mavlink_to_obstacle_distance(const uint16_t sector_cm[GOE_FLIGHT_SECTORS], uint16_t max_cm,
                                      unsigned increment_deg, const goe_mavlink_own_t *own,
                                      goe_mavlink_obstacle_distance_t *message);

/* OBSTACLE_DISTANCE_3D: the nearest point, body frame (FRD). One for each obstacle, all of one time. A point that the aircraft is
 * at is sent 1 cm ahead: ArduPilot ignores 0. obstacle_id: the detector's id modulo 65535; 65535 if it has none.
 * False without a position. */
bool goe_mavlink_to_obstacle_distance_3d(const goe_flight_obstacle_t *obstacle, float max_m, const goe_mavlink_own_t *own,
                                         goe_mavlink_obstacle_distance_3d_t *message);

/* COLLISION: source 1, as none of the standard fits better; threat by `conflict_probability` against `conflict_probability_max`: 0 below, 1 from
 * there, 2 from 0.5 on or when late. Action: report (1), unless the action is about this obstacle: left, right 3; climb, go
 * around 2; hold 6. altitude_minimum_delta: 0 below the top, also if that is not known. False without a hazard. */
bool goe_mavlink_to_collision(const goe_flight_obstacle_t *obstacle, int slot, const goe_flight_assessment_t *assessment,
                              float conflict_probability_max, goe_mavlink_collision_t *message);

/* TARGET_ABSOLUTE: the middle of the base; capability: position alone. position_std: horizontal root of the summed variances;
 * vertical NaN, the ground's is not known here. False without a position, and while the origin or the UNIX time is not known. */
bool goe_mavlink_to_target_absolute(const goe_flight_obstacle_t *obstacle, int slot, const goe_mavlink_own_t *own,
                                    goe_mavlink_target_absolute_t *message);

/* ADSB_VEHICLE, a static point obstacle, for autopilots that avoid traffic and compare single points: its middle, at
 * the altitude min(top, own - 1 m), neither above nor far below; own - 1 m if the top is not known. tslc is 0
 * while the obstacle is followed: an avoiding turn takes it out of view, and ArduPilot forgets traffic after 5 s.
 * Callsign: GOE and slot + 1.
 *   icao_base  address of slot 0, 24 bits
 * False without a position, and while the origin is not known or own->position_ned_m or origin_alt_m are not finite. */
bool goe_mavlink_to_adsb_vehicle(const goe_flight_obstacle_t *obstacle, int slot, uint32_t icao_base,
                                 const goe_mavlink_own_t *own, goe_mavlink_adsb_vehicle_t *message);

#ifdef __cplusplus
}
#endif

#endif /* GOE_MAVLINK_MAP_H */
