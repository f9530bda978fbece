/* From the flight layer's answers to messages. SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "goe_flight_maths.h"
#include "goe_mavlink_map.h"

#define NO_PLACE_E7 INT32_MAX
#define NO_DELAY UINT16_MAX
#define US_PER_MS 1000u
#define MM_PER_M 1000.0f
#define CIRCLE_DEG 360
#define SECTOR_DEG 5
#define SECTOR_MAX_CM 65000u
#define NEAREST_CM 1u /* ArduPilot passes over 0 */
#define NEAREST_M 0.01f
#define HEADING_MAX_DEG 1.0e4f
#define ALTITUDE_MAX_M 2.0e6f /* in mm within int32_t */
#define BELOW_OWN_M 1.0f
#define VIOLATION_HIGH 0.5f
#define FRAME_BODY_FRD 12u      /* MAV_FRAME */
#define SENSOR_UNKNOWN 4u       /* MAV_DISTANCE_SENSOR */
#define COLLISION_SOURCE 1u     /* MAV_COLLISION_SRC */
#define CAPABILITY_POSITION 1u  /* TARGET_ABSOLUTE_SENSOR_CAPABILITY_FLAGS */
#define ADSB_VALID 0x9Fu        /* ADSB_FLAGS: coordinates, altitude, heading, velocity, callsign, vertical velocity */
#define ADSB_GEOMETRIC 1u       /* ADSB_ALTITUDE_TYPE */
#define ADSB_POINT_OBSTACLE 19u /* ADSB_EMITTER_TYPE */
#define ICAO_MASK 0xFFFFFFu

GOE_STATIC_ASSERT(CIRCLE_DEG == SECTOR_DEG * GOE_FLIGHT_SECTORS, sectors_make_a_circle);

enum { REPORT = 1, ASCEND_OR_DESCEND = 2, MOVE_HORIZONTALLY = 3, HOVER = 6 }; /* MAV_COLLISION_ACTION */

static float not_a_number(void) {
    const uint32_t bits = 0x7FC00000u;
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

static float if_known(bool known, float x) { return known ? x : not_a_number(); }

static void copy_if_known(bool known, const float from[3], float to[3]) {
    for (int i = 0; i < 3; i++) {
        to[i] = if_known(known, from[i]);
    }
}

static bool has(const goe_flight_obstacle_t *obstacle, unsigned what) { return (obstacle->valid & what) != 0u; }

static uint32_t boot_ms(const goe_mavlink_own_t *own) { return (uint32_t)(own->time_usec / US_PER_MS & UINT32_MAX); }

/* The action is about this obstacle, or about one that was given up and this is the worst. */
static bool is_ordered(const goe_flight_assessment_t *assessment, int slot) {
    const int about = assessment->avoided < 0 ? assessment->worst : assessment->avoided;
    return assessment->action != GOE_FLIGHT_NONE && about == slot;
}

/* ---------------------------------------------------------------------------------------------------- goe's messages -- */

static uint8_t state_of(const goe_flight_obstacle_t *obstacle) {
    return (uint8_t)((obstacle->suspect ? GOE_MAVLINK_SUSPECT : 0u) | (obstacle->receding ? GOE_MAVLINK_RECEDING : 0u));
}

static void fill_size(const goe_flight_obstacle_t *obstacle, goe_mavlink_obstacle_t *message) {
    message->radius = if_known(has(obstacle, GOE_HAS_POSITION), obstacle->radius_m);
    message->width = if_known(has(obstacle, GOE_HAS_WIDTH), obstacle->width_m);
    message->length = if_known(has(obstacle, GOE_HAS_LENGTH), obstacle->length_m);
    message->height = if_known(has(obstacle, GOE_HAS_HEIGHT), obstacle->height_m);
    message->height_sd = if_known(has(obstacle, GOE_HAS_HEIGHT), obstacle->height_sd_m);
    message->heading = if_known(has(obstacle, GOE_HAS_ORIENTATION), obstacle->length_heading_deg);
}

void goe_mavlink_to_obstacle(const goe_flight_obstacle_t *obstacle, int slot, const goe_mavlink_own_t *own,
                             goe_mavlink_obstacle_t *message) {
    const bool placed = has(obstacle, GOE_HAS_POSITION);
    memset(message, 0, sizeof *message);
    message->time_usec = own->time_usec;
    message->id = obstacle->id;
    message->lat = placed && own->origin_known ? obstacle->lat_e7 : NO_PLACE_E7;
    message->lon = placed && own->origin_known ? obstacle->lon_e7 : NO_PLACE_E7;
    message->north = if_known(placed, obstacle->center_ned_m[0]);
    message->east = if_known(placed, obstacle->center_ned_m[1]);
    message->ground_down = if_known(placed, obstacle->center_ned_m[2]);
    copy_if_known(placed, obstacle->covariance_ne_m2, message->covariance);
    copy_if_known(placed, obstacle->nearest_ned_m, message->nearest);
    message->age = if_known(placed, obstacle->age_s);
    fill_size(obstacle, message);
    message->slot = (uint8_t)slot;
    message->model = (uint8_t)obstacle->model;
    message->flags = (uint8_t)(state_of(obstacle) | (obstacle->in_view ? GOE_MAVLINK_IN_VIEW : 0u));
}

static void fill_order(const goe_flight_assessment_t *assessment, bool ordered, const goe_mavlink_own_t *own,
                       goe_mavlink_hazard_t *message) {
    message->action = (uint8_t)(ordered ? assessment->action : GOE_FLIGHT_NONE);
    message->needed = if_known(ordered, assessment->needed_s);
    copy_if_known(ordered, assessment->target_ned_m, message->target);
    message->target_lat = ordered && own->origin_known ? assessment->target_lat_e7 : NO_PLACE_E7;
    message->target_lon = ordered && own->origin_known ? assessment->target_lon_e7 : NO_PLACE_E7;
}

bool goe_mavlink_to_hazard(const goe_flight_obstacle_t *obstacle, int slot, const goe_flight_assessment_t *assessment,
                           const goe_mavlink_own_t *own, goe_mavlink_hazard_t *message) {
    const goe_hazard_t *hazard = &obstacle->hazard;
    const bool ordered = is_ordered(assessment, slot);
    const bool late = ordered && assessment->late;
    memset(message, 0, sizeof *message);
    message->time_usec = own->time_usec;
    message->id = obstacle->id;
    message->tcpa = hazard->tcpa_s;
    message->tcpa_sd = hazard->tcpa_sd_s;
    message->dcpa = hazard->dcpa_m;
    message->dcpa_sd = hazard->dcpa_sd_m;
    message->clearance = if_known(hazard->has_clearance, hazard->clearance_m);
    message->clearance_sd = if_known(hazard->has_clearance, hazard->clearance_sd_m);
    message->conflict_probability = hazard->conflict_probability;
    fill_order(assessment, ordered, own, message);
    message->slot = (uint8_t)slot;
    message->flags = (uint8_t)(state_of(obstacle) | (assessment->worst == slot ? GOE_MAVLINK_WORST : 0u) |
                               (ordered ? GOE_MAVLINK_ORDER : 0u) | (late ? GOE_MAVLINK_LATE : 0u));
    return obstacle->has_hazard;
}

void goe_mavlink_to_status(const goe_flight_counters_t *counters, const goe_flight_assessment_t *assessment,
                           unsigned self_check, const goe_mavlink_own_t *own, goe_mavlink_status_t *message) {
    memset(message, 0, sizeof *message);
    message->time_boot_ms = boot_ms(own);
    message->taken = counters->taken;
    message->late = counters->late;
    message->early = counters->early;
    message->refused = counters->refused;
    message->weak = counters->weak;
    message->renumbered = counters->renumbered;
    message->evicted = counters->evicted;
    message->full = counters->full;
    message->resets = counters->resets;
    message->lost = counters->lost;
    message->delay_mean = message->delay_max = NO_DELAY;
    message->obstacles = assessment->obstacles;
    message->unplaced = assessment->unplaced;
    message->action = (uint8_t)assessment->action;
    message->alive = (uint8_t)((assessment->detector_alive ? GOE_MAVLINK_DETECTOR_ALIVE : 0u) |
                               (assessment->pose_alive ? GOE_MAVLINK_POSE_ALIVE : 0u) |
                               (assessment->pose_agrees ? GOE_MAVLINK_POSE_AGREES : 0u));
    message->self_check = (uint8_t)(self_check > UINT8_MAX ? UINT8_MAX : self_check);
}

/* ------------------------------------------------------------------------------------------------ OBSTACLE_DISTANCE -- */

/* The element about a bearing: of the sectors that it touches. */
static uint16_t join(const uint16_t sector_cm[GOE_FLIGHT_SECTORS], uint32_t max_cm, int bearing_deg, int width_deg) {
    uint32_t nearest_cm = max_cm + 1u;
    bool unknown = false;
    for (int i = 0; i < GOE_FLIGHT_SECTORS; i++) {
        int off_deg = (SECTOR_DEG * i - bearing_deg + CIRCLE_DEG) % CIRCLE_DEG;
        off_deg = off_deg > CIRCLE_DEG / 2 ? CIRCLE_DEG - off_deg : off_deg;
        if (2 * off_deg < width_deg + SECTOR_DEG) {
            unknown = unknown || sector_cm[i] == GOE_FLIGHT_SECTOR_UNKNOWN;
            nearest_cm = sector_cm[i] < nearest_cm ? sector_cm[i] : nearest_cm;
        }
    }
    nearest_cm = nearest_cm < NEAREST_CM ? NEAREST_CM : nearest_cm;
    return (uint16_t)(nearest_cm > max_cm && unknown ? GOE_FLIGHT_SECTOR_UNKNOWN : nearest_cm);
}

bool goe_mavlink_to_obstacle_distance(const uint16_t sector_cm[GOE_FLIGHT_SECTORS], uint16_t max_cm,
                                      unsigned increment_deg, const goe_mavlink_own_t *own,
                                      goe_mavlink_obstacle_distance_t *message) {
    memset(message, 0, sizeof *message);
    if (increment_deg < SECTOR_DEG || increment_deg > CIRCLE_DEG / 2 || CIRCLE_DEG % increment_deg != 0u ||
        max_cm < 1u || max_cm > SECTOR_MAX_CM || !goe_flight_within(own->heading_deg, HEADING_MAX_DEG)) {
        return false;
    }
    const int elements = CIRCLE_DEG / (int)increment_deg;
    for (int i = 0; i < GOE_FLIGHT_SECTORS; i++) {
        message->distances[i] = i < elements ? join(sector_cm, max_cm, i * (int)increment_deg, (int)increment_deg)
                                             : (uint16_t)GOE_FLIGHT_SECTOR_UNKNOWN;
    }
    message->time_usec = own->time_usec;
    message->max_distance = max_cm;
    message->sensor_type = SENSOR_UNKNOWN;
    message->increment = (uint8_t)increment_deg;
    message->angle_offset = -goe_flight_positive_deg(own->heading_deg);
    message->frame = FRAME_BODY_FRD;
    return true;
}

/* ------------------------------------------------------------------------------------------ other standard messages -- */

bool goe_mavlink_to_obstacle_distance_3d(const goe_flight_obstacle_t *obstacle, float max_m,
                                         const goe_mavlink_own_t *own, goe_mavlink_obstacle_distance_3d_t *message) {
    const float *nearest_m = obstacle->nearest_body_m;
    const bool there = goe_flight_all_within(nearest_m, 3, 0.5f * NEAREST_M);
    memset(message, 0, sizeof *message);
    message->time_boot_ms = boot_ms(own);
    message->x = there ? NEAREST_M : nearest_m[0];
    message->y = nearest_m[1];
    message->z = nearest_m[2];
    message->max_distance = max_m;
    message->obstacle_id = (uint16_t)(obstacle->id != 0u ? obstacle->id % UINT16_MAX : UINT16_MAX);
    message->sensor_type = SENSOR_UNKNOWN;
    message->frame = FRAME_BODY_FRD;
    return has(obstacle, GOE_HAS_POSITION);
}

static uint8_t collision_action(goe_flight_action_t action) {
    switch (action) {
        case GOE_FLIGHT_LEFT:
        case GOE_FLIGHT_RIGHT:
            return MOVE_HORIZONTALLY;
        case GOE_FLIGHT_CLIMB:
        case GOE_FLIGHT_GO_AROUND:
            return ASCEND_OR_DESCEND;
        case GOE_FLIGHT_HOLD:
            return HOVER;
        case GOE_FLIGHT_NONE:
        default:
            return REPORT;
    }
}

bool goe_mavlink_to_collision(const goe_flight_obstacle_t *obstacle, int slot,
                              const goe_flight_assessment_t *assessment, float conflict_probability_max,
                              goe_mavlink_collision_t *message) {
    const goe_hazard_t *hazard = &obstacle->hazard;
    const bool ordered = is_ordered(assessment, slot);
    const bool high = hazard->conflict_probability >= VIOLATION_HIGH || (ordered && assessment->late);
    memset(message, 0, sizeof *message);
    message->id = obstacle->id;
    message->time_to_minimum_delta = hazard->tcpa_s;
    message->altitude_minimum_delta = hazard->has_clearance ? goe_flight_larger(hazard->clearance_m, 0.0f) : 0.0f;
    message->horizontal_minimum_delta = hazard->dcpa_m;
    message->src = COLLISION_SOURCE;
    message->action = collision_action(ordered ? assessment->action : GOE_FLIGHT_NONE);
    message->threat_level = (uint8_t)(high ? 2 : hazard->conflict_probability >= conflict_probability_max ? 1 : 0);
    return obstacle->has_hazard;
}

bool goe_mavlink_to_target_absolute(const goe_flight_obstacle_t *obstacle, int slot, const goe_mavlink_own_t *own,
                                    goe_mavlink_target_absolute_t *message) {
    const float variance_m2 = obstacle->covariance_ne_m2[0] + obstacle->covariance_ne_m2[2];
    memset(message, 0, sizeof *message);
    if (!has(obstacle, GOE_HAS_POSITION) || !own->origin_known || own->unix_usec == 0u) {
        return false;
    }
    message->timestamp = own->unix_usec;
    message->lat = obstacle->lat_e7;
    message->lon = obstacle->lon_e7;
    message->alt = own->origin_alt_m - obstacle->center_ned_m[2];
    message->position_std[0] = variance_m2 > 0.0f ? sqrtf(variance_m2) : 0.0f;
    message->position_std[1] = not_a_number();
    message->id = (uint8_t)slot;
    message->sensor_capabilities = CAPABILITY_POSITION;
    return true;
}

/* GOE1, GOE2, ... of slot 0, 1, ...; filled up with zeros. */
static void fill_callsign(int slot, char callsign[9]) {
    const unsigned number = ((unsigned)slot + 1u) % 100u;
    const size_t digits = number < 10u ? 1u : 2u;
    callsign[0] = 'G';
    callsign[1] = 'O';
    callsign[2] = 'E';
    callsign[2u + digits] = (char)('0' + (int)(number % 10u));
    if (digits == 2u) {
        callsign[3] = (char)('0' + (int)(number / 10u));
    }
}

/* Down of the reported altitude. */
static float reported_down_m(const goe_flight_obstacle_t *obstacle, const goe_mavlink_own_t *own) {
    const float below_m = own->position_ned_m[2] + BELOW_OWN_M;
    const float top_m = obstacle->center_ned_m[2] - obstacle->height_m;
    return has(obstacle, GOE_HAS_HEIGHT) ? goe_flight_larger(top_m, below_m) : below_m;
}

bool goe_mavlink_to_adsb_vehicle(const goe_flight_obstacle_t *obstacle, int slot, uint32_t icao_base,
                                 const goe_mavlink_own_t *own, goe_mavlink_adsb_vehicle_t *message) {
    const float altitude_m = own->origin_alt_m - reported_down_m(obstacle, own);
    memset(message, 0, sizeof *message);
    if (!has(obstacle, GOE_HAS_POSITION) || !own->origin_known || !goe_flight_within(altitude_m, ALTITUDE_MAX_M)) {
        return false;
    }
    message->icao_address = (icao_base + (uint32_t)slot) & ICAO_MASK;
    message->lat = obstacle->lat_e7;
    message->lon = obstacle->lon_e7;
    message->altitude = (int32_t)(altitude_m * MM_PER_M);
    message->flags = ADSB_VALID;
    message->altitude_type = ADSB_GEOMETRIC;
    fill_callsign(slot, message->callsign);
    message->emitter_type = ADSB_POINT_OBSTACLE;
    return true;
}
