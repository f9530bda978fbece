/*
 * goe_mavlink - goe's MAVLink messages and some standard messages, without generated MAVLink headers
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 *
 * goe.xml is the dialect: GOE_FEATURES is input; GOE_OBSTACLE, GOE_HAZARD and GOE_STATUS are output. goe_mavlink_map.h fills or
 * reads the standard messages of this header. A firmware with generated headers passes the packed payload to its own send
 * function. A firmware without them calls goe_mavlink_frame().
 *
 *   structure > goe_mavlink_pack_...() > payload > goe_mavlink_frame() > bytes of a MAVLink 2 frame
 *   payload of a received frame > goe_mavlink_read_...() > structure
 *
 * Structures   contain the fields of a message in their order on the wire. NaN, or the value given at the field, means "not known".
 * Payload      as in MAVLink 2: little-endian, without the trailing zeros, at least one byte. The read functions accept any length.
 *              They set missing bytes to zero, and ignore bytes beyond the message, such as fields that a newer dialect added.
 * Safety       No heap, no writable statics, no recursion; from the C library only memcpy and memset. The functions access no memory
 *              outside the given lengths. They do not check values; goe_flight refuses values that are not finite.
 */
#ifndef GOE_MAVLINK_H
#define GOE_MAVLINK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* --------------------------------------------------------------------------------------------------------- messages -- */

typedef enum {
    GOE_MAVLINK_FEATURES,
    GOE_MAVLINK_OBSTACLE,
    GOE_MAVLINK_HAZARD,
    GOE_MAVLINK_STATUS,
    GOE_MAVLINK_LANDING_TARGET,
    GOE_MAVLINK_TRACKING, /* CAMERA_TRACKING_IMAGE_STATUS */
    GOE_MAVLINK_OBSTACLE_DISTANCE,
    GOE_MAVLINK_OBSTACLE_DISTANCE_3D,
    GOE_MAVLINK_COLLISION,
    GOE_MAVLINK_TARGET_ABSOLUTE,
    GOE_MAVLINK_ADSB_VEHICLE,
    GOE_MAVLINK_MESSAGES
} goe_mavlink_message_t;

/* Properties of a message that a frame needs. goe_mavlink_messages.h is the table. */
typedef struct {
    const char *name;  /* as in the XML */
    uint32_t id;
    uint8_t crc_extra;  /* seed of the checksum, computed from the names and types of the base fields */
    uint8_t length_min; /* bytes without extensions */
    uint8_t length;     /* bytes with extensions */
} goe_mavlink_info_t;

#define GOE_MAVLINK_PAYLOAD_MAX 255
#define GOE_MAVLINK_FRAME_MAX 267 /* payload, header (10 bytes) and checksum (2 bytes) */

/* ------------------------------------------------------------------------------------------------- goe's own dialect -- */

#define GOE_MAVLINK_FEATURE_BOX_LEFT 0x001u
#define GOE_MAVLINK_FEATURE_BOX_TOP 0x002u
#define GOE_MAVLINK_FEATURE_BOX_RIGHT 0x004u
#define GOE_MAVLINK_FEATURE_BOX_BOTTOM 0x008u
#define GOE_MAVLINK_FEATURE_BOX 0x00Fu
#define GOE_MAVLINK_FEATURE_POINT 0x010u /* bit of point i: 0x10 << i */

enum { GOE_MAVLINK_LEFT, GOE_MAVLINK_TOP, GOE_MAVLINK_RIGHT, GOE_MAVLINK_BOTTOM, GOE_MAVLINK_SIDES };

/* Points in the order of goe_image_t: left, right, top, base left, base near, base right. */
#define GOE_MAVLINK_POINTS 6

/* Pixel coordinates count in tenths of a pixel to the right and down from the middle of the image (half its width and height).
 * 16 bits thus suffice for an image of 6,553 pixels. */
typedef struct {
    uint64_t time_usec;   /* middle of the exposure, by the clock of time_base; ignored with AGE */
    uint32_t age_usec;    /* time from there until this message was sent; 0: not known, but with AGE an age of 0 */
    uint32_t obstacle_id; /* id from the detector's tracker; 0: no id */
    int16_t box[GOE_MAVLINK_SIDES]; /* upright bounding box, 0.1 px: left, top, right, bottom; all four sides, also at the border */
    uint16_t time_sd;     /* one sigma of time_usec or age_usec, us; 0: not known */
    uint16_t image_width, image_height; /* px */
    uint16_t visible;     /* GOE_MAVLINK_FEATURE_... */
    uint8_t camera_id;    /* number of the camera, from 0 */
    uint8_t time_base;    /* 0 autopilot's clock, 1 sender's clock, 2 age; same numbers as GOE_FLIGHT_AUTOPILOT_CLOCK, ... */
    uint8_t number;       /* number of messages for this image; 0: nothing in view, which shows that the detector is alive */
    uint8_t pixel_sd;     /* one sigma of box and points, 0.1 px; 0: not known */
    uint8_t score;        /* percent; 255: not known, treated as 100 */
    int16_t u[GOE_MAVLINK_POINTS], v[GOE_MAVLINK_POINTS]; /* extension: points, 0.1 px */
    /* Extension: what the detector's class says of the obstacle, as goe_kind_t; 0: not known */
    uint16_t kind_width, kind_width_sd, kind_height, kind_height_sd; /* cm */
    uint8_t kind_shape; /* GOE_KIND_... */
} goe_mavlink_features_t;

#define GOE_MAVLINK_SUSPECT 0x01u /* the estimate contradicts the images; the margins are wider */
#define GOE_MAVLINK_RECEDING 0x02u /* the distance to the obstacle grows */
#define GOE_MAVLINK_IN_VIEW 0x04u /* detected in the latest image of its camera */
#define GOE_MAVLINK_WORST 0x08u   /* the worst hazard of all obstacles */
#define GOE_MAVLINK_LATE 0x10u    /* the action needs more time than is left */
#define GOE_MAVLINK_ORDER 0x20u   /* the action avoids this obstacle */

typedef struct {
    uint64_t time_usec; /* autopilot's clock */
    uint32_t id;        /* the detector's id of the obstacle; 0: no id */
    int32_t lat, lon;   /* middle of the base, degrees times 1e7; INT32_MAX: not known */
    float north, east;  /* middle of the base in the autopilot's local frame, m */
    float ground_down;  /* down coordinate of the ground at the obstacle, m */
    float covariance[3]; /* covariance of the middle: north north, north east, east east, m^2 */
    float radius;       /* radius of the circle around the middle that contains the outline, m */
    float width, length, height, height_sd; /* m; NaN: not known */
    float heading;      /* direction of the length axis, degrees clockwise from north, 0 to 180; NaN: not known */
    float nearest[3];   /* nearest point of the circle, NED, m */
    float age;          /* time since the obstacle was last measured, s */
    uint8_t slot;       /* slot in the table; it does not change while the obstacle is tracked */
    uint8_t model;      /* goe_model_t */
    uint8_t flags;      /* GOE_MAVLINK_SUSPECT, ... */
} goe_mavlink_obstacle_t;

typedef struct {
    uint64_t time_usec; /* autopilot's clock; tcpa and needed count from this time */
    uint32_t id;        /* the detector's id of the obstacle; 0: no id */
    int32_t target_lat, target_lon; /* target of the action, degrees times 1e7; INT32_MAX: not known, or no action */
    float target[3];    /* target of the action in the local frame, NED, m; NaN: no action */
    float tcpa, tcpa_sd;              /* time to the closest point of approach, s */
    float dcpa, dcpa_sd;              /* horizontal distance to the outline at that point, m */
    float clearance, clearance_sd;    /* vertical distance over the top at that point, m; NaN: the top is not known */
    float conflict_probability; /* probability that both margin and clearance are violated, 0 to 1 */
    float needed;       /* time that the action needs, s; NaN: no action */
    uint8_t slot;
    uint8_t action;     /* goe_flight_action_t; 0 unless GOE_MAVLINK_ORDER */
    uint8_t flags;      /* GOE_MAVLINK_WORST, _ORDER, _LATE, _SUSPECT, _RECEDING */
} goe_mavlink_hazard_t;

#define GOE_MAVLINK_DETECTOR_ALIVE 0x01u
#define GOE_MAVLINK_POSE_ALIVE 0x02u
#define GOE_MAVLINK_POSE_AGREES 0x04u /* no position contradicts the velocities; without it the pose is not alive */

/* To be sent once a second, even with nothing in view. Without obstacles the course is clear only if detector and pose are alive and
 * unplaced is 0. */
typedef struct {
    uint32_t time_boot_ms;
    uint16_t taken, late, early, refused, weak, renumbered, evicted, full, resets, lost; /* goe_flight_counters_t */
    uint16_t delay_mean, delay_max; /* time from the exposure to the arrival, since the previous message, ms; 65535: no image */
    uint8_t obstacles;  /* number of obstacles with a position */
    uint8_t action;     /* goe_flight_action_t */
    uint8_t alive;      /* GOE_MAVLINK_DETECTOR_ALIVE, _POSE_ALIVE, _POSE_AGREES */
    uint8_t self_check; /* result of goe_self_check(); 0: correct */
    uint8_t unplaced;   /* number of detected obstacles without a position; no order avoids them; an extension */
} goe_mavlink_status_t;

/* ------------------------------------------------------------------------------- standard messages, with their own fields -- */

typedef struct {
    uint64_t time_usec;
    float angle_x, angle_y; /* rad, from the optical axis to the middle of the target */
    float distance, size_x, size_y; /* m, rad, rad */
    uint8_t target_num, frame;
    float x, y, z, q[4]; /* extensions from here on */
    uint8_t type, position_valid;
} goe_mavlink_landing_target_t;

typedef struct {
    float point_x, point_y, radius; /* fractions of the image, 0 to 1 */
    float rec_top_x, rec_top_y, rec_bottom_x, rec_bottom_y; /* fractions of the image, 0 to 1 */
    uint8_t tracking_status; /* 1: active */
    uint8_t tracking_mode;   /* 1: point, 2: rectangle */
    uint8_t target_data;
    uint8_t camera_device_id; /* extension */
} goe_mavlink_tracking_t;

typedef struct {
    uint64_t time_usec;
    uint16_t distances[72]; /* cm; max_distance + 1: no obstacle; 65535: not known */
    uint16_t min_distance, max_distance;
    uint8_t sensor_type;
    uint8_t increment; /* degrees */
    float increment_f, angle_offset; /* extensions from here on */
    uint8_t frame;
} goe_mavlink_obstacle_distance_t;

typedef struct {
    uint32_t time_boot_ms;
    float x, y, z, min_distance, max_distance; /* m */
    uint16_t obstacle_id;
    uint8_t sensor_type, frame;
} goe_mavlink_obstacle_distance_3d_t;

typedef struct {
    uint32_t id;
    float time_to_minimum_delta, altitude_minimum_delta, horizontal_minimum_delta; /* s, m, m */
    uint8_t src, action, threat_level;
} goe_mavlink_collision_t;

typedef struct {
    uint64_t timestamp; /* UNIX epoch, us */
    int32_t lat, lon;   /* degrees times 1e7 */
    float alt;          /* above sea level, m */
    float vel[3], acc[3], q_target[4], rates[3];
    float position_std[2]; /* horizontal, vertical, m */
    float vel_std[3], acc_std[3];
    uint8_t id, sensor_capabilities;
} goe_mavlink_target_absolute_t;

typedef struct {
    uint32_t icao_address;
    int32_t lat, lon;  /* degrees times 1e7 */
    int32_t altitude;  /* mm */
    uint16_t heading, hor_velocity; /* 0.01 degrees, cm/s */
    int16_t ver_velocity;
    uint16_t flags, squawk;
    uint8_t altitude_type;
    char callsign[9];
    uint8_t emitter_type, tslc;
} goe_mavlink_adsb_vehicle_t;

/* -------------------------------------------------------------------------------------------------------- functions -- */

/* Returns the properties of a message; null for an invalid number. */
const goe_mavlink_info_t *goe_mavlink_info(goe_mavlink_message_t message);

/* Returns the message with this MAVLink id; GOE_MAVLINK_MESSAGES if there is no such message. */
goe_mavlink_message_t goe_mavlink_of_id(uint32_t id);

/* Write the payload and return its length, 1 to 255. */
size_t goe_mavlink_pack_features(const goe_mavlink_features_t *message, uint8_t payload[GOE_MAVLINK_PAYLOAD_MAX]);
size_t goe_mavlink_pack_obstacle(const goe_mavlink_obstacle_t *message, uint8_t payload[GOE_MAVLINK_PAYLOAD_MAX]);
size_t goe_mavlink_pack_hazard(const goe_mavlink_hazard_t *message, uint8_t payload[GOE_MAVLINK_PAYLOAD_MAX]);
size_t goe_mavlink_pack_status(const goe_mavlink_status_t *message, uint8_t payload[GOE_MAVLINK_PAYLOAD_MAX]);
size_t goe_mavlink_pack_landing_target(const goe_mavlink_landing_target_t *message,
                                       uint8_t payload[GOE_MAVLINK_PAYLOAD_MAX]);
size_t goe_mavlink_pack_tracking(const goe_mavlink_tracking_t *message, uint8_t payload[GOE_MAVLINK_PAYLOAD_MAX]);
size_t goe_mavlink_pack_obstacle_distance(const goe_mavlink_obstacle_distance_t *message,
                                          uint8_t payload[GOE_MAVLINK_PAYLOAD_MAX]);
size_t goe_mavlink_pack_obstacle_distance_3d(const goe_mavlink_obstacle_distance_3d_t *message,
                                             uint8_t payload[GOE_MAVLINK_PAYLOAD_MAX]);
size_t goe_mavlink_pack_collision(const goe_mavlink_collision_t *message, uint8_t payload[GOE_MAVLINK_PAYLOAD_MAX]);
size_t goe_mavlink_pack_target_absolute(const goe_mavlink_target_absolute_t *message,
                                        uint8_t payload[GOE_MAVLINK_PAYLOAD_MAX]);
size_t goe_mavlink_pack_adsb_vehicle(const goe_mavlink_adsb_vehicle_t *message,
                                     uint8_t payload[GOE_MAVLINK_PAYLOAD_MAX]);

/* Read a payload of this length into the structure. */
void goe_mavlink_read_features(const uint8_t *payload, size_t length, goe_mavlink_features_t *message);
void goe_mavlink_read_obstacle(const uint8_t *payload, size_t length, goe_mavlink_obstacle_t *message);
void goe_mavlink_read_hazard(const uint8_t *payload, size_t length, goe_mavlink_hazard_t *message);
void goe_mavlink_read_status(const uint8_t *payload, size_t length, goe_mavlink_status_t *message);
void goe_mavlink_read_landing_target(const uint8_t *payload, size_t length, goe_mavlink_landing_target_t *message);
void goe_mavlink_read_tracking(const uint8_t *payload, size_t length, goe_mavlink_tracking_t *message);
void goe_mavlink_read_obstacle_distance(const uint8_t *payload, size_t length,
                                        goe_mavlink_obstacle_distance_t *message);
void goe_mavlink_read_obstacle_distance_3d(const uint8_t *payload, size_t length,
                                           goe_mavlink_obstacle_distance_3d_t *message);
void goe_mavlink_read_collision(const uint8_t *payload, size_t length, goe_mavlink_collision_t *message);
void goe_mavlink_read_target_absolute(const uint8_t *payload, size_t length, goe_mavlink_target_absolute_t *message);
void goe_mavlink_read_adsb_vehicle(const uint8_t *payload, size_t length, goe_mavlink_adsb_vehicle_t *message);

/* Identity and sequence number of a sender of frames. */
typedef struct {
    uint8_t system, component;
    uint8_t sequence; /* sequence number of the next frame */
} goe_mavlink_sender_t;

/* Makes an unsigned MAVLink 2 frame from a packed payload and increments the sequence number. Returns the length of the frame. Returns
 * 0 for an invalid message, and for a length of 0 or more than the message's length. */
size_t goe_mavlink_frame(goe_mavlink_sender_t *sender, goe_mavlink_message_t message, const uint8_t *payload,
                         size_t length, uint8_t frame[GOE_MAVLINK_FRAME_MAX]);

#ifdef __cplusplus
}
#endif

#endif /* GOE_MAVLINK_H */
