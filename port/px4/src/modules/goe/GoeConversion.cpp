/* Between PX4's topics and the flight layer. SPDX-License-Identifier: MIT */
#include "GoeConversion.hpp"

#include <math.h>
#include <string.h>

namespace goe_px4 {

namespace {

constexpr float UPRIGHT_MIN = 0.7f; /* cosine of the tilt up to which a distance downwards is a height */
constexpr double E7_PER_DEG = 1.0e7;
constexpr double LATITUDE_MAX_DEG = 89.0;
constexpr double LONGITUDE_MAX_DEG = 180.0;
constexpr float RAD_PER_DEG = 0.01745329252f;
constexpr unsigned TUNNEL_FEATURES = 4270u; /* payload type. Above 32767 are experiments that must not be distributed */
constexpr uint8_t NO_CAMERA = 255u;
constexpr uint64_t LANDING_FRESH_US =
    500000; /* PX4 publishes its landing's status at 50 Hz while it lands, and then no more */

static_assert(GOE_FLIGHT_SECTORS == sizeof(obstacle_distance_s::distances) / sizeof(uint16_t), "one to one");
static_assert(static_cast<int>(goe_features_s::TIME_BASE_AGE) == static_cast<int>(GOE_FLIGHT_AGE), "same numbers");
static_assert(goe_features_s::SIDES_ALL == GOE_SIDES_ALL, "same bits");

float known(float value, bool is_known) { return is_known ? value : NAN; }

int32_t e7(double deg) { return static_cast<int32_t>(lround(deg * E7_PER_DEG)); }

} // namespace

/* --------------------------------------------------------------------------------------------------------------- in -- */

goe_flight_attitude_t attitude(const vehicle_attitude_s &topic) {
    goe_flight_attitude_t sample{};
    sample.time_us = time_us(topic.timestamp_sample);
    memcpy(sample.q, topic.q, sizeof sample.q);
    sample.reset = topic.quat_reset_counter;
    return sample;
}

bool position(const vehicle_local_position_s &topic, const Heights &heights, goe_flight_position_t &sample) {
    memset(&sample, 0, sizeof sample);
    if (!topic.xy_valid || !topic.z_valid || !topic.v_xy_valid || !topic.v_z_valid) {
        return false;
    }
    sample.time_us = time_us(topic.timestamp_sample);
    sample.position_ned_m[0] = topic.x;
    sample.position_ned_m[1] = topic.y;
    sample.position_ned_m[2] = topic.z;
    sample.velocity_ned_m_s[0] = topic.vx;
    sample.velocity_ned_m_s[1] = topic.vy;
    sample.velocity_ned_m_s[2] = topic.vz;
    sample.reset_horizontal = topic.xy_reset_counter;
    sample.reset_vertical = topic.z_reset_counter;
    sample.reset_delta_known = true; /* a skipped count makes it unknown */
    sample.reset_delta_ned_m[0] = topic.delta_xy[0];
    sample.reset_delta_ned_m[1] = topic.delta_xy[1];
    sample.reset_delta_ned_m[2] = topic.delta_z;
    sample.origin_known =
        topic.xy_global && fabs(topic.ref_lat) <= LATITUDE_MAX_DEG && fabs(topic.ref_lon) <= LONGITUDE_MAX_DEG;
    if (sample.origin_known) {
        sample.origin_lat_e7 = e7(topic.ref_lat);
        sample.origin_lon_e7 = e7(topic.ref_lon);
    }
    sample.height_m[GOE_FLIGHT_RANGE_FINDER] = heights.range_m;
    sample.height_m[GOE_FLIGHT_TERRAIN] = topic.dist_bottom;
    sample.height_m[GOE_FLIGHT_HOME] = heights.home_down_m - topic.z;
    sample.height_valid = static_cast<uint8_t>((heights.has_range ? 1u << GOE_FLIGHT_RANGE_FINDER : 0u) |
                                               (topic.dist_bottom_valid ? 1u << GOE_FLIGHT_TERRAIN : 0u) |
                                               (heights.has_home ? 1u << GOE_FLIGHT_HOME : 0u));
    return true;
}

bool height_by_range(const distance_sensor_s &sensor, const float q[4], float &height_m) {
    const float upright = q[0] * q[0] - q[1] * q[1] - q[2] * q[2] + q[3] * q[3];
    height_m = sensor.current_distance * upright;
    return sensor.orientation == distance_sensor_s::ROTATION_DOWNWARD_FACING && upright >= UPRIGHT_MIN &&
           sensor.signal_quality != 0 && sensor.current_distance > sensor.min_distance &&
           sensor.current_distance < sensor.max_distance;
}

bool home_down(const home_position_s &home, float &down_m) {
    down_m = home.z;
    return home.valid_lpos && home.valid_alt;
}

uint8_t phase(const position_setpoint_s &setpoint, const vehicle_land_detected_s &ground,
              const position_controller_landing_status_s &landing, uint64_t now_us) {
    if (ground.landed) {
        return GOE_FLIGHT_LANDED;
    }
    if (!setpoint.valid || setpoint.type != position_setpoint_s::SETPOINT_TYPE_LAND) {
        return GOE_FLIGHT_FLYING;
    }
    const bool is_fresh = landing.timestamp != 0 && now_us < landing.timestamp + LANDING_FRESH_US;
    return landing.flaring && is_fresh ? GOE_FLIGHT_FLARE : GOE_FLIGHT_APPROACH;
}

/* A time of no clock that there is cannot be understood: goe_flight_frame() refuses the camera, and counts it. */
static void read_time(const goe_features_s &topic, goe_flight_frame_t &frame) {
    frame.arrival_us = time_us(topic.timestamp);
    frame.capture_us =
        topic.time_base == goe_features_s::TIME_BASE_PX4 ? time_us(topic.timestamp_sample) : topic.capture;
    frame.sent_us = topic.time_base == goe_features_s::TIME_BASE_SENDER ? topic.sent : frame.capture_us;
    frame.time_sd_us = topic.time_sd;
    frame.time_base = topic.time_base;
}

void sighting(const goe_features_s &topic, goe_mavlink_sighting_t &to) {
    memset(&to, 0, sizeof to);
    goe_flight_detection_t &detection = to.detection;
    to.frame.detection = &detection;
    read_time(topic, to.frame);
    to.frame.camera = topic.camera;
    to.frame.number = topic.number;
    if (topic.number == 0) {
        return;
    }
    to.frame.count = 1;
    detection.id = topic.id;
    detection.score = topic.score;
    detection.pixel_px = topic.pixel_sd;
    detection.box.left_px = topic.box[0];
    detection.box.top_px = topic.box[1];
    detection.box.right_px = topic.box[2];
    detection.box.bottom_px = topic.box[3];
    detection.box.sides = topic.sides;
    goe_pixel_t *const point[] = {&detection.left,      &detection.right,     &detection.top,
                                  &detection.base_left, &detection.base_near, &detection.base_right};
    for (unsigned i = 0; i < sizeof point / sizeof point[0]; i++) {
        point[i]->u_px = topic.u[i];
        point[i]->v_px = topic.v[i];
        point[i]->visible = (topic.points >> i & 1u) != 0u;
    }
}

bool is_addressed(const mavlink_tunnel_s &topic, uint8_t system, uint8_t component) {
    return system != 0u && topic.target_system == system &&
           (topic.target_component == 0u || topic.target_component == component);
}

bool next_of_tunnel(const mavlink_tunnel_s &topic, unsigned &offset, goe_mavlink_sighting_t &to) {
    if (topic.payload_type != TUNNEL_FEATURES || topic.payload_length > sizeof topic.payload ||
        offset >= topic.payload_length) {
        return false;
    }
    const unsigned length = topic.payload[offset];
    if (length == 0u || offset + 1u + length > topic.payload_length) {
        return false;
    }
    goe_mavlink_features_t features;
    goe_mavlink_read_features(topic.payload + offset + 1u, length, &features);
    (void)goe_mavlink_from_features(&features, time_us(topic.timestamp), &to);
    offset += 1u + length;
    return true;
}

bool sighting(const irlock_report_s &topic, const goe_settings_t &settings, uint32_t delay_us, uint32_t delay_sd_us,
              goe_mavlink_sighting_t &to) {
    goe_mavlink_camera_t camera{};
    goe_mavlink_landing_target_t target{};
    camera.width_px = settings.camera.width_px;
    camera.height_px = settings.camera.height_px;
    camera.fx_px = settings.camera.fx_px;
    camera.fy_px = settings.camera.fy_px;
    camera.cx_px = settings.camera.cx_px;
    camera.cy_px = settings.camera.cy_px;
    camera.delay_us = delay_us;
    camera.delay_sd_us = delay_sd_us;
    target.angle_x = topic.pos_x;
    target.angle_y = topic.pos_y;
    target.size_x = topic.size_x;
    target.size_y = topic.size_y;
    target.target_num = static_cast<uint8_t>(topic.signature & 0xFFu);
    return goe_mavlink_from_landing_target(&target, &camera, time_us(topic.timestamp), &to) ||
           to.frame.camera != NO_CAMERA;
}

/* -------------------------------------------------------------------------------------------------------------- out -- */

static void report_hazard(const goe_flight_obstacle_t &from, goe_obstacle_s &topic) {
    const goe_hazard_t &hazard = from.hazard;
    const bool has_top = from.has_hazard && hazard.has_clearance;
    topic.tcpa = known(hazard.tcpa_s, from.has_hazard);
    topic.tcpa_sd = known(hazard.tcpa_sd_s, from.has_hazard);
    topic.dcpa = known(hazard.dcpa_m, from.has_hazard);
    topic.dcpa_sd = known(hazard.dcpa_sd_m, from.has_hazard);
    topic.clearance = known(hazard.clearance_m, has_top);
    topic.clearance_sd = known(hazard.clearance_sd_m, has_top);
    topic.conflict_probability = known(hazard.conflict_probability, from.has_hazard);
}

static void report_size(const goe_flight_obstacle_t &from, goe_obstacle_s &topic) {
    const bool has_height = (from.valid & GOE_HAS_HEIGHT) != 0u;
    topic.radius = from.radius_m;
    topic.width = known(from.width_m, (from.valid & GOE_HAS_WIDTH) != 0u);
    topic.length = known(from.length_m, (from.valid & GOE_HAS_LENGTH) != 0u);
    topic.length_heading = known(from.length_heading_deg * RAD_PER_DEG, (from.valid & GOE_HAS_ORIENTATION) != 0u);
    topic.height = known(from.height_m, has_height);
    topic.height_sd = known(from.height_sd_m, has_height);
}

goe_obstacle_s obstacle(const goe_flight_t &flight, const goe_flight_obstacle_t &from, int slot,
                        const goe_flight_assessment_t &assessment, uint64_t now_us) {
    goe_obstacle_s topic{};
    topic.timestamp = now_us;
    topic.timestamp_sample = now_us - static_cast<uint32_t>(time_us(now_us) - flight.capture_us);
    topic.slot = static_cast<uint8_t>(slot);
    topic.id = from.id;
    topic.model = static_cast<uint8_t>(from.model);
    topic.suspect = from.suspect;
    topic.receding = from.receding;
    topic.in_view = from.in_view;
    topic.worst = assessment.worst == slot;
    topic.avoided = assessment.avoided == slot;
    topic.north = from.center_ned_m[0];
    topic.east = from.center_ned_m[1];
    topic.ground_down = from.center_ned_m[2];
    memcpy(topic.covariance, from.covariance_ne_m2, sizeof topic.covariance);
    const double unknown = static_cast<double>(NAN);
    topic.lat = flight.origin_known ? static_cast<double>(from.lat_e7) / E7_PER_DEG : unknown;
    topic.lon = flight.origin_known ? static_cast<double>(from.lon_e7) / E7_PER_DEG : unknown;
    memcpy(topic.nearest, from.nearest_ned_m, sizeof topic.nearest);
    topic.age = from.age_s;
    report_size(from, topic);
    report_hazard(from, topic);
    return topic;
}

void status(const goe_flight_t &flight, const goe_flight_assessment_t &assessment, goe_status_s &topic) {
    const goe_flight_counters_t &counters = flight.counters;
    const bool ordered = assessment.action != GOE_FLIGHT_NONE;
    topic.detector_alive = assessment.detector_alive;
    topic.pose_agrees = assessment.pose_agrees;
    topic.pose_alive = assessment.pose_alive;
    topic.obstacles = assessment.obstacles;
    topic.unplaced = assessment.unplaced;
    topic.worst = assessment.worst;
    topic.avoided = assessment.avoided;
    topic.action = static_cast<uint8_t>(assessment.action);
    topic.late = assessment.late;
    topic.needed = known(assessment.needed_s, ordered);
    for (int i = 0; i < 3; i++) {
        topic.target[i] = known(assessment.target_ned_m[i], ordered);
    }
    topic.taken = counters.taken;
    topic.late_images = counters.late;
    topic.early = counters.early;
    topic.refused = counters.refused;
    topic.weak = counters.weak;
    topic.renumbered = counters.renumbered;
    topic.evicted = counters.evicted;
    topic.full = counters.full;
    topic.resets = counters.resets;
    topic.lost = counters.lost;
}

obstacle_distance_s distances(const goe_flight_t &flight, uint16_t max_cm, uint64_t now_us) {
    obstacle_distance_s topic{};
    topic.timestamp = now_us;
    topic.frame = obstacle_distance_s::MAV_FRAME_GLOBAL;
    topic.sensor_type = obstacle_distance_s::MAV_DISTANCE_SENSOR_LASER; /* PX4 has none that fits better */
    topic.increment = 360.f / static_cast<float>(GOE_FLIGHT_SECTORS);
    topic.max_distance = max_cm;
    for (uint16_t &distance_cm : topic.distances) {
        distance_cm = GOE_FLIGHT_SECTOR_UNKNOWN; /* what stays so without settings or a pose */
    }
    (void)goe_flight_sectors(&flight, max_cm, topic.distances);
    return topic;
}

#ifdef GOE_HAS_DETECT_AND_AVOID

namespace {

uint8_t conflict_level(const goe_flight_obstacle_t &from, int slot, const goe_flight_assessment_t &assessment,
                       float conflict_probability_max) {
    if (assessment.avoided == slot && assessment.action != GOE_FLIGHT_NONE) {
        return assessment.late ? detect_and_avoid_s::DAA_CONFLICT_LVL_CRITICAL
                               : detect_and_avoid_s::DAA_CONFLICT_LVL_HIGH;
    }
    const bool meets =
        from.has_hazard && !from.receding && from.hazard.conflict_probability >= conflict_probability_max;
    return meets ? detect_and_avoid_s::DAA_CONFLICT_LVL_LOW : detect_and_avoid_s::DAA_CONFLICT_LVL_NONE;
}

/* The distance in space came a month after the others. */
template <typename T> auto report_distance(T &topic, float distance_m, int) -> decltype(topic.aircraft_dist, void()) {
    topic.aircraft_dist = distance_m;
}

template <typename T> void report_distance(T &, float, long) {}

} // namespace

detect_and_avoid_s detect_and_avoid(const goe_flight_obstacle_t &from, int slot,
                                    const goe_flight_assessment_t &assessment, const float own_ned_m[3],
                                    float conflict_probability_max, uint64_t now_us) {
    detect_and_avoid_s topic{};
    const float north_m = from.nearest_ned_m[0] - own_ned_m[0];
    const float east_m = from.nearest_ned_m[1] - own_ned_m[1];
    const float down_m = from.nearest_ned_m[2] - own_ned_m[2];
    topic.timestamp = now_us;
    topic.unique_id = from.id;
    topic.unique_id_encoding = detect_and_avoid_s::UNIQUE_ID_ENCODING_UAS_ID;
    topic.conflict_level = conflict_level(from, slot, assessment, conflict_probability_max);
    topic.aircraft_dist_hor = sqrtf(north_m * north_m + east_m * east_m);
    topic.aircraft_dist_vert = fabsf(down_m);
    topic.expected_min_dist_time = known(from.hazard.tcpa_s, from.has_hazard);
    report_distance(topic, sqrtf(north_m * north_m + east_m * east_m + down_m * down_m), 0);
    return topic;
}

#endif

} // namespace goe_px4
