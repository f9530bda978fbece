/* Between PX4's topics and the flight layer: pure functions, structure in, structure out. SPDX-License-Identifier: MIT */
#pragma once

#include <uORB/topics/distance_sensor.h>
#include <uORB/topics/goe_features.h>
#include <uORB/topics/goe_obstacle.h>
#include <uORB/topics/goe_status.h>
#include <uORB/topics/home_position.h>
#include <uORB/topics/irlock_report.h>
#include <uORB/topics/mavlink_tunnel.h>
#include <uORB/topics/obstacle_distance.h>
#include <uORB/topics/position_controller_landing_status.h>
#include <uORB/topics/position_setpoint_triplet.h>
#include <uORB/topics/vehicle_attitude.h>
#include <uORB/topics/vehicle_land_detected.h>
#include <uORB/topics/vehicle_local_position.h>

/* Trees from May 2026 on have it. */
#if defined(__has_include)
#if __has_include(<uORB/topics/detect_and_avoid.h>)
#include <uORB/topics/detect_and_avoid.h>
#define GOE_HAS_DETECT_AND_AVOID
#endif
#endif

#include "goe_flight.h"
#include "goe_mavlink_map.h"

namespace goe_px4 {

/* The flight layer's 32 bits of PX4's clock, us. They wrap every 71 minutes: only differences count. */
inline uint32_t time_us(uint64_t timestamp) { return static_cast<uint32_t>(timestamp & 0xFFFFFFFFu); }

/* ------------------------------------------------------------------------------------------------------- poses, in -- */

goe_flight_attitude_t attitude(const vehicle_attitude_s &topic);

/* Heights above the ground, m, from other topics. */
struct Heights {
    bool has_range{false}, has_home{false};
    float range_m{0.f}; /* by a distance sensor that looks down */
    float home_down_m{0.f};
};

/* False: the topic has no valid position and no sample must be given. */
bool position(const vehicle_local_position_s &topic, const Heights &heights, goe_flight_position_t &sample);

/* Height by a distance sensor that looks down, from the attitude of about the same time. False: it looks elsewhere, is out of its
 * range, or the aircraft banks or pitches by more than 45 degrees. */
bool height_by_range(const distance_sensor_s &sensor, const float q[4], float &height_m);

/* The home position as a ground, in the local frame. */
bool home_down(const home_position_s &home, float &down_m);

/* Of GOE_FLIGHT_FLYING, _APPROACH, _FLARE and _LANDED. PX4 publishes the landing's status with each step of a fixed wing's landing, from
 * the flare through the roll on the ground; the land detector reports the ground when the aircraft has all but stopped. */
uint8_t phase(const position_setpoint_s &setpoint, const vehicle_land_detected_s &ground,
              const position_controller_landing_status_s &landing, uint64_t now_us);

/* ------------------------------------------------------------------------------------------------------ images, in -- */

void sighting(const goe_features_s &topic, goe_mavlink_sighting_t &sighting);

/* A TUNNEL to this system by its number, and to this component or to any. One to every system is none: boxes belong to one vehicle. */
bool is_addressed(const mavlink_tunnel_s &topic, uint8_t system, uint8_t component);

/* TUNNEL with payload type 4270: any number of times a length and as many bytes of a GOE_FEATURES payload.
 * Takes the next one from `offset` on, and moves it. False: no more, or not understood. */
bool next_of_tunnel(const mavlink_tunnel_s &topic, unsigned &offset, goe_mavlink_sighting_t &sighting);

/* LANDING_TARGET as PX4's receiver passes it on: angles and sizes, without a time. False: not a box. */
bool sighting(const irlock_report_s &topic, const goe_settings_t &settings, uint32_t delay_us, uint32_t delay_sd_us,
              goe_mavlink_sighting_t &sighting);

/* ------------------------------------------------------------------------------------------------------------- out -- */

goe_obstacle_s obstacle(const goe_flight_t &flight, const goe_flight_obstacle_t &from, int slot,
                        const goe_flight_assessment_t &assessment, uint64_t now_us);

/* Counters and the assessment; what the module itself knows stays as it is. */
void status(const goe_flight_t &flight, const goe_flight_assessment_t &assessment, goe_status_s &topic);

/* GLOBAL frame, 5 degrees each. */
obstacle_distance_s distances(const goe_flight_t &flight, uint16_t max_cm, uint64_t now_us);

#ifdef GOE_HAS_DETECT_AND_AVOID
/* Level: LOW from conflict_probability_max on, HIGH when the order is about it, CRITICAL when that is late. Distances: now, to the nearest
 * point of the obstacle. unique_id: the detector's. */
detect_and_avoid_s detect_and_avoid(const goe_flight_obstacle_t &from, int slot,
                                    const goe_flight_assessment_t &assessment, const float own_ned_m[3],
                                    float conflict_probability_max, uint64_t now_us);
#endif

} // namespace goe_px4
