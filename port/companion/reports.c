/* The companion's reports over MAVLink. SPDX-License-Identifier: MIT */
#include "reports.h"

#include <math.h>

#define CM_PER_M 100.0
#define MS_UNKNOWN 65535.0

goe_mavlink_own_t reports_own(const autopilot_t *autopilot, int64_t now_us, int64_t unix_us) {
    const int64_t clock_us = autopilot_clock_us(autopilot, now_us);
    const goe_mavlink_own_t own = {
        .time_usec = (uint64_t)(clock_us > 0 ? clock_us : 0),
        .unix_usec = (uint64_t)(unix_us > 0 ? unix_us : 0),
        .position_ned_m = {autopilot->position.x, autopilot->position.y, autopilot->position.z},
        .origin_known = autopilot->origin_given,
        .origin_alt_m = autopilot->origin_alt_m,
        .heading_deg = autopilot_heading_deg(autopilot),
    };
    return own;
}

/* One slot, or what one slot's standard message is made of. */
typedef struct {
    wire_t *wire;
    const companion_config_t *config;
    const goe_flight_assessment_t *assessment;
    const goe_mavlink_own_t *own;
    const goe_flight_obstacle_t *obstacle;
    int slot;
} report_t;

static void send_obstacle(const report_t *r) {
    uint8_t payload[GOE_MAVLINK_PAYLOAD_MAX];
    goe_mavlink_obstacle_t obstacle;
    goe_mavlink_hazard_t hazard;
    goe_mavlink_to_obstacle(r->obstacle, r->slot, r->own, &obstacle);
    wire_send_payload(r->wire, GOE_MAVLINK_OBSTACLE, payload, goe_mavlink_pack_obstacle(&obstacle, payload));
    if (goe_mavlink_to_hazard(r->obstacle, r->slot, r->assessment, r->own, &hazard)) {
        wire_send_payload(r->wire, GOE_MAVLINK_HAZARD, payload, goe_mavlink_pack_hazard(&hazard, payload));
    }
}

static void send_standard(const report_t *r) {
    uint8_t payload[GOE_MAVLINK_PAYLOAD_MAX];
    goe_mavlink_obstacle_distance_3d_t nearest;
    goe_mavlink_collision_t collision;
    goe_mavlink_target_absolute_t target;
    const unsigned wanted = r->config->reports_standard;
    if ((wanted & REPORT_OBSTACLE_DISTANCE_3D) != 0) {
        goe_mavlink_to_obstacle_distance_3d(r->obstacle, (float)r->config->reports_distance_max_m, r->own, &nearest);
        wire_send_payload(r->wire, GOE_MAVLINK_OBSTACLE_DISTANCE_3D, payload,
                          goe_mavlink_pack_obstacle_distance_3d(&nearest, payload));
    }
    if ((wanted & REPORT_COLLISION) != 0 &&
        goe_mavlink_to_collision(r->obstacle, r->slot, r->assessment, r->config->flight.conflict_probability_max,
                                 &collision)) {
        wire_send_payload(r->wire, GOE_MAVLINK_COLLISION, payload, goe_mavlink_pack_collision(&collision, payload));
    }
    if ((wanted & REPORT_TARGET_ABSOLUTE) != 0 &&
        goe_mavlink_to_target_absolute(r->obstacle, r->slot, r->own, &target)) {
        wire_send_payload(r->wire, GOE_MAVLINK_TARGET_ABSOLUTE, payload,
                          goe_mavlink_pack_target_absolute(&target, payload));
    }
}

/* Also while nothing is known: then every sector says so. */
static void send_sectors(wire_t *wire, const companion_config_t *config, const goe_flight_t *flight,
                         const goe_mavlink_own_t *own) {
    uint16_t sector_cm[GOE_FLIGHT_SECTORS];
    uint8_t payload[GOE_MAVLINK_PAYLOAD_MAX];
    goe_mavlink_obstacle_distance_t distance;
    const uint16_t most_cm = (uint16_t)(config->reports_distance_max_m * CM_PER_M);
    (void)goe_flight_sectors(flight, most_cm, sector_cm);
    if (goe_mavlink_to_obstacle_distance(sector_cm, most_cm, config->reports_distance_increment_deg, own, &distance)) {
        wire_send_payload(wire, GOE_MAVLINK_OBSTACLE_DISTANCE, payload,
                          goe_mavlink_pack_obstacle_distance(&distance, payload));
    }
}

void reports_send_obstacles(wire_t *wire, const companion_config_t *config, const goe_flight_t *flight,
                            const goe_flight_assessment_t *assessment, const goe_mavlink_own_t *own) {
    for (int slot = 0; slot < GOE_FLIGHT_SLOTS; slot++) {
        goe_flight_obstacle_t obstacle;
        if (goe_flight_obstacle(flight, slot, &obstacle) == GOE_FLIGHT_OK && (obstacle.valid & GOE_HAS_POSITION) != 0) {
            const report_t report = {wire, config, assessment, own, &obstacle, slot};
            send_obstacle(&report);
            send_standard(&report);
        }
    }
    if ((config->reports_standard & REPORT_OBSTACLE_DISTANCE) != 0) {
        send_sectors(wire, config, flight, own);
    }
}

static uint16_t whole_ms(double ms) { return (uint16_t)lround(fmin(fmax(ms, 0.0), MS_UNKNOWN - 1.0)); }

void reports_send_status(wire_t *wire, const goe_flight_t *flight, const goe_flight_assessment_t *assessment,
                         const goe_mavlink_own_t *own, const delay_count_t *delay, unsigned self_check) {
    mavlink_message_t heartbeat;
    goe_mavlink_status_t status;
    uint8_t payload[GOE_MAVLINK_PAYLOAD_MAX];
    (void)mavlink_msg_heartbeat_pack(wire->system, wire->component, &heartbeat, MAV_TYPE_ONBOARD_CONTROLLER,
                                     MAV_AUTOPILOT_INVALID, 0, 0, MAV_STATE_ACTIVE);
    wire_send(wire, &heartbeat);
    goe_mavlink_to_status(&flight->counters, assessment, self_check, own, &status);
    status.taken = (uint16_t)(delay->all_images < UINT16_MAX ? delay->all_images : UINT16_MAX);
    if (delay->images > 0) {
        status.delay_mean = whole_ms(delay->sum_ms / delay->images);
        status.delay_max = whole_ms(delay->most_ms);
    }
    wire_send_payload(wire, GOE_MAVLINK_STATUS, payload, goe_mavlink_pack_status(&status, payload));
}
