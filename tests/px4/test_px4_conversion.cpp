/* Topics of PX4, including MAVLink's images, as the flight layer's input, and parameters as its settings. SPDX-License-Identifier: MIT */
#include "px4_flight.hpp"

#include "goe_mavlink.h"

static constexpr uint8_t NO_CAMERA = 255;
static constexpr uint16_t FEATURES = 4270;
static constexpr uint8_t SYSTEM = 1, COMPONENT = 1; /* as in Px4Flight::set_mode() */

extern "C" void setUp(void) { standin::begin(1000000u); }
extern "C" void tearDown(void) {}

/* -------------------------------------------------------------------------------------------------------------- heights -- */

static void a_distance_sensor_that_looks_down_gives_a_height() {
    const float level[4] = {1.f, 0.f, 0.f, 0.f};
    const float banked[4] = {std::cos(0.2f), std::sin(0.2f), 0.f, 0.f};  /* 23 degrees */
    const float steep[4] = {std::cos(0.45f), 0.f, std::sin(0.45f), 0.f}; /* 52 degrees */
    distance_sensor_s sensor{};
    float height_m;
    sensor.min_distance = 0.1f;
    sensor.max_distance = 40.f;
    sensor.current_distance = 20.f;
    sensor.signal_quality = -1; /* not known */
    sensor.orientation = distance_sensor_s::ROTATION_DOWNWARD_FACING;
    TEST_ASSERT_TRUE(goe_px4::height_by_range(sensor, level, height_m));
    CHECK_CLOSE(1e-5, 20, height_m);
    TEST_ASSERT_TRUE(goe_px4::height_by_range(sensor, banked, height_m));
    CHECK_CLOSE(1e-3, 20.0 * std::cos(0.4), height_m);
    TEST_ASSERT_FALSE(goe_px4::height_by_range(sensor, steep, height_m));
    sensor.signal_quality = 0;
    TEST_ASSERT_FALSE(goe_px4::height_by_range(sensor, level, height_m));
    sensor.signal_quality = 80;
    sensor.orientation = distance_sensor_s::ROTATION_FORWARD_FACING;
    TEST_ASSERT_FALSE(goe_px4::height_by_range(sensor, level, height_m));
    sensor.orientation = distance_sensor_s::ROTATION_DOWNWARD_FACING;
    sensor.current_distance = 40.f;
    TEST_ASSERT_FALSE(goe_px4::height_by_range(sensor, level, height_m));
    sensor.current_distance = NAN;
    TEST_ASSERT_FALSE(goe_px4::height_by_range(sensor, level, height_m));
}

/* --------------------------------------------------------------------------------------------------------------- phase -- */

static constexpr uint64_t NOW_US = 90000000u;

struct Landing {
    position_setpoint_s setpoint{};
    vehicle_land_detected_s ground{};
    position_controller_landing_status_s status{};

    Landing() {
        setpoint.valid = true;
        setpoint.type = position_setpoint_s::SETPOINT_TYPE_LAND;
        status.timestamp = NOW_US - 20000u;
    }
    uint8_t phase() const { return goe_px4::phase(setpoint, ground, status, NOW_US); }
};

static void a_setpoint_to_land_is_an_approach() {
    Landing landing;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_APPROACH, landing.phase());
    landing.setpoint.type = position_setpoint_s::SETPOINT_TYPE_POSITION;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_FLYING, landing.phase());
    landing.setpoint.type = position_setpoint_s::SETPOINT_TYPE_LAND;
    landing.setpoint.valid = false;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_FLYING, landing.phase());
}

static void the_controller_reports_the_flare() {
    Landing landing;
    landing.status.flaring = true;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_FLARE, landing.phase());
}

/* PX4 publishes the flare while it lands, and does not withdraw it when it stops landing. */
static void the_flare_of_an_earlier_landing_is_none() {
    Landing landing;
    landing.status.flaring = true;
    landing.status.timestamp = NOW_US - 600000u;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_APPROACH, landing.phase());
    landing.status.timestamp = NOW_US + 4000u; /* published between the start of the cycle and its assessment */
    TEST_ASSERT_EQUAL(GOE_FLIGHT_FLARE, landing.phase());
    landing.setpoint.type = position_setpoint_s::SETPOINT_TYPE_LOITER;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_FLYING, landing.phase());
    landing.status = position_controller_landing_status_s{}; /* never published */
    landing.status.flaring = true;
    landing.setpoint.type = position_setpoint_s::SETPOINT_TYPE_LAND;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_APPROACH, landing.phase());
}

static void what_the_land_detector_says_is_landed() {
    Landing landing;
    landing.ground.landed = true;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LANDED, landing.phase());
    landing.setpoint.valid = false;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LANDED, landing.phase());
}

static void each_height_is_marked_by_its_source() {
    vehicle_local_position_s topic{};
    goe_px4::Heights heights;
    goe_flight_position_t sample;
    topic.xy_valid = topic.z_valid = topic.v_xy_valid = topic.v_z_valid = true;
    topic.z = -30.f;
    TEST_ASSERT_TRUE(goe_px4::position(topic, heights, sample));
    TEST_ASSERT_EQUAL(0, sample.height_valid);
    TEST_ASSERT_FALSE(sample.origin_known);
    heights.has_range = heights.has_home = topic.dist_bottom_valid = true;
    heights.range_m = 29.f;
    heights.home_down_m = 2.f;
    topic.dist_bottom = 31.f;
    TEST_ASSERT_TRUE(goe_px4::position(topic, heights, sample));
    TEST_ASSERT_EQUAL_HEX8(7, sample.height_valid);
    CHECK_CLOSE(0, 29, sample.height_m[GOE_FLIGHT_RANGE_FINDER]);
    CHECK_CLOSE(0, 31, sample.height_m[GOE_FLIGHT_TERRAIN]);
    CHECK_CLOSE(0, 32, sample.height_m[GOE_FLIGHT_HOME]);
    for (bool *valid : {&topic.xy_valid, &topic.z_valid, &topic.v_xy_valid, &topic.v_z_valid}) {
        *valid = false;
        TEST_ASSERT_FALSE(goe_px4::position(topic, heights, sample));
        *valid = true;
    }
}

/* --------------------------------------------------------------------------------------------------------------- images -- */

static void each_clock_has_its_own_times() {
    goe_features_s topic{};
    goe_mavlink_sighting_t sighting;
    topic.timestamp = 0x700001000u;
    topic.timestamp_sample = 0x700000500u;
    topic.capture = 77u;
    topic.sent = 99u;
    goe_px4::sighting(topic, sighting);
    TEST_ASSERT_EQUAL_HEX32(0x1000u, sighting.frame.arrival_us);
    TEST_ASSERT_EQUAL_HEX32(0x500u, sighting.frame.capture_us);
    TEST_ASSERT_EQUAL(0, sighting.frame.count);
    topic.time_base = goe_features_s::TIME_BASE_SENDER;
    goe_px4::sighting(topic, sighting);
    TEST_ASSERT_EQUAL(77u, sighting.frame.capture_us);
    TEST_ASSERT_EQUAL(99u, sighting.frame.sent_us);
    topic.time_base = goe_features_s::TIME_BASE_AGE;
    goe_px4::sighting(topic, sighting);
    TEST_ASSERT_EQUAL(77u, sighting.frame.capture_us);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_AGE, sighting.frame.time_base);
}

static goe_mavlink_features_t features(uint32_t id) {
    goe_mavlink_features_t message{};
    message.time_usec = 900000u;
    message.obstacle_id = id;
    message.image_width = message.image_height = 1280;
    message.visible = GOE_MAVLINK_FEATURE_BOX;
    message.number = 3;
    message.score = 90;
    message.box[GOE_MAVLINK_LEFT] = -100;
    message.box[GOE_MAVLINK_RIGHT] = 105;
    message.box[GOE_MAVLINK_TOP] = -50;
    message.box[GOE_MAVLINK_BOTTOM] = 60;
    return message;
}

static void append(mavlink_tunnel_s &tunnel, const goe_mavlink_features_t &message) {
    uint8_t payload[GOE_MAVLINK_PAYLOAD_MAX];
    const size_t length = goe_mavlink_pack_features(&message, payload);
    TEST_ASSERT_TRUE(tunnel.payload_length + 1u + length <= sizeof tunnel.payload);
    tunnel.payload[tunnel.payload_length] = static_cast<uint8_t>(length);
    memcpy(tunnel.payload + tunnel.payload_length + 1, payload, length);
    tunnel.payload_length = static_cast<uint8_t>(tunnel.payload_length + 1u + length);
}

static void a_tunnel_carries_three_boxes() {
    mavlink_tunnel_s tunnel{};
    goe_mavlink_sighting_t sighting;
    unsigned offset = 0;
    tunnel.timestamp = 1000000u;
    tunnel.payload_type = FEATURES;
    for (uint32_t id = 11; id <= 13; id++) {
        append(tunnel, features(id));
    }
    for (uint32_t id = 11; id <= 13; id++) {
        TEST_ASSERT_TRUE(goe_px4::next_of_tunnel(tunnel, offset, sighting));
        TEST_ASSERT_EQUAL(id, sighting.detection.id);
        TEST_ASSERT_EQUAL_PTR(&sighting.detection, sighting.frame.detection);
        CHECK_CLOSE(1e-3, 630, sighting.detection.box.left_px);
        CHECK_CLOSE(1e-3, 650.5, sighting.detection.box.right_px);
        TEST_ASSERT_EQUAL(900000u, sighting.frame.capture_us);
        TEST_ASSERT_EQUAL(1000000u, sighting.frame.arrival_us);
    }
    TEST_ASSERT_FALSE(goe_px4::next_of_tunnel(tunnel, offset, sighting));
}

static void a_tunnel_that_is_cut_carries_one_less() {
    mavlink_tunnel_s tunnel{};
    goe_mavlink_sighting_t sighting;
    unsigned offset = 0;
    tunnel.payload_type = FEATURES;
    append(tunnel, features(1));
    append(tunnel, features(2));
    tunnel.payload_length--;
    TEST_ASSERT_TRUE(goe_px4::next_of_tunnel(tunnel, offset, sighting));
    TEST_ASSERT_FALSE(goe_px4::next_of_tunnel(tunnel, offset, sighting));
}

static void others_tunnels_are_theirs() {
    mavlink_tunnel_s tunnel{};
    goe_mavlink_sighting_t sighting;
    append(tunnel, features(1));
    for (const uint16_t type : {0, 200, 42700}) { /* types above 32767 are for private experiments */
        unsigned offset = 0;
        tunnel.payload_type = type;
        TEST_ASSERT_FALSE(goe_px4::next_of_tunnel(tunnel, offset, sighting));
    }
}

/* Number of images taken from one TUNNEL to this system and component, by a vehicle with system 1, component 1. */
static unsigned taken_of_tunnel_to(uint8_t system, uint8_t component, bool knows_itself) {
    static Px4Flight flight;
    mavlink_tunnel_s tunnel{};
    flight.system = knows_itself ? SYSTEM : 0;
    flight.begin();
    flight.follows = flight.sends_images = false;
    flight.fly(0.5);
    goe_mavlink_features_t message = features(1);
    message.time_usec = standin::now_us() - 50000u;
    tunnel.timestamp = standin::now_us();
    tunnel.payload_type = FEATURES;
    tunnel.target_system = system;
    tunnel.target_component = component;
    append(tunnel, message);
    standin::publish(ORB_ID(mavlink_tunnel), &tunnel);
    flight.fly(0.5);
    const unsigned taken = flight.status().taken;
    flight.end();
    return taken;
}

static void a_tunnel_to_another_vehicle_is_not_taken() {
    TEST_ASSERT_EQUAL(1, taken_of_tunnel_to(SYSTEM, COMPONENT, true));
    TEST_ASSERT_EQUAL(1, taken_of_tunnel_to(SYSTEM, 0, true)); /* any component */
    TEST_ASSERT_EQUAL(0, taken_of_tunnel_to(SYSTEM, 191, true));
    TEST_ASSERT_EQUAL(0, taken_of_tunnel_to(2, COMPONENT, true));
    TEST_ASSERT_EQUAL(0, taken_of_tunnel_to(0, 0, true)); /* to all systems: boxes belong to one vehicle's camera */
    TEST_ASSERT_EQUAL(0, taken_of_tunnel_to(SYSTEM, COMPONENT, false));
    TEST_ASSERT_EQUAL(0, taken_of_tunnel_to(0, 0, false));
}

/* Random bytes, lengths and types: each call advances or ends, and malformed data name no camera that does not exist. */
static void any_bytes_in_a_tunnel_are_borne() {
    check_random_t random = check_random_start("tunnel");
    static Px4Flight flight;
    flight.begin();
    flight.follows = flight.sends_images = false;
    for (int i = 0; i < 2000; i++) {
        mavlink_tunnel_s tunnel{};
        for (uint8_t &byte : tunnel.payload) {
            byte = static_cast<uint8_t>(check_random_bits(&random));
        }
        tunnel.timestamp = standin::now_us();
        tunnel.payload_type = FEATURES;
        tunnel.target_system = SYSTEM;
        tunnel.payload_length = static_cast<uint8_t>(check_random_bits(&random));
        tunnel.payload[0] = static_cast<uint8_t>(check_random_bits(&random) % 80u);
        standin::publish(ORB_ID(mavlink_tunnel), &tunnel);
        flight.step();
    }
    TEST_ASSERT_GREATER_THAN(100, flight.status().refused);
    TEST_ASSERT_TRUE(flight.status().pose_alive);
    flight.end();
}

/* The same flight by goe_features and by TUNNEL, with boxes rounded to 0.1 px: equal to less than a sigma. */
static void a_flight_by_tunnel_is_that_by_topic() {
    static Px4Flight flight;
    goe_obstacle_s by[2];
    for (int i = 0; i < 2; i++) {
        flight.begin();
        flight.follows = false;
        flight.sends_images = i == 0;
        for (int k = 0; k < 200; k++) {
            flight.step();
            const int exposed = flight.flown.sample - 1 - FLOWN_DELAY;
            if (i == 0 || exposed < 0 || exposed % FLOWN_IMAGE_EVERY != 0) {
                continue;
            }
            const goe_features_s topic = flight.features_of(exposed);
            goe_mavlink_features_t message = features(topic.id);
            mavlink_tunnel_s tunnel{};
            message.number = topic.number;
            message.time_usec = topic.timestamp_sample;
            message.time_sd = 1000;
            for (int side = 0; side < 4; side++) {
                message.box[side] =
                    static_cast<int16_t>(std::lround(10.0 * (static_cast<double>(topic.box[side]) - 640.0)));
            }
            tunnel.timestamp = standin::now_us();
            tunnel.payload_type = FEATURES;
            tunnel.target_system = SYSTEM;
            tunnel.target_component = COMPONENT;
            append(tunnel, message);
            standin::publish(ORB_ID(mavlink_tunnel), &tunnel);
            standin::settle();
        }
        TEST_ASSERT_TRUE(flight.obstacle(by[i]));
        flight.end();
    }
    const double away_m = std::hypot(static_cast<double>(by[1].north) - static_cast<double>(by[0].north),
                                     static_cast<double>(by[1].east) - static_cast<double>(by[0].east));
    check_report("by tunnel, m away", away_m);
    TEST_ASSERT_TRUE(away_m < 0.5 * std::sqrt(static_cast<double>(by[0].covariance[0] + by[0].covariance[2])));
}

static void a_landing_target_is_a_box_of_a_calibrated_age() {
    goe_settings_t settings;
    irlock_report_s report{};
    goe_mavlink_sighting_t sighting;
    goe_settings_default(&settings);
    settings.camera.fx_px = settings.camera.fy_px = 914.f;
    settings.camera.cx_px = settings.camera.cy_px = 640.f;
    settings.camera.width_px = settings.camera.height_px = 1280.f;
    report.timestamp = 1000000u;
    report.signature = 4;
    report.size_x = 0.1f;
    report.size_y = 0.2f;
    TEST_ASSERT_TRUE(goe_px4::sighting(report, settings, 80000u, 20000u, sighting));
    TEST_ASSERT_EQUAL(920000u, sighting.frame.capture_us);
    TEST_ASSERT_EQUAL(5u, sighting.detection.id);
    CHECK_CLOSE(0.01, 640.0 - 914.0 * std::tan(0.05), sighting.detection.box.left_px);
    report.pos_x = NAN;
    TEST_ASSERT_FALSE(goe_px4::sighting(report, settings, 80000u, 20000u, sighting));
    TEST_ASSERT_EQUAL(NO_CAMERA, sighting.frame.camera);
}

/* By default they are ignored: a landing target is no obstacle. */
static void landing_targets_are_taken_only_if_enabled() {
    static Px4Flight flight;
    flight.begin();
    flight.follows = flight.sends_images = false;
    for (const int32_t inputs : {1, 2}) {
        standin::set("GOE_IN", inputs);
        flight.fly(1.2);
        const uint16_t before = flight.status().taken;
        irlock_report_s report{};
        report.timestamp = standin::now_us();
        report.size_x = report.size_y = 0.1f;
        standin::publish(ORB_ID(irlock_report), &report);
        flight.fly(0.3);
        TEST_ASSERT_EQUAL(inputs == 2 ? 1 : 0, flight.status().taken - before);
        bool has_delay = false; /* of the last whole second */
        for (int i = 0; i < 12; i++) {
            flight.fly(0.1);
            has_delay = has_delay || flight.status().delay_mean > 80.f; /* GOE_LT_DELAY; otherwise NaN */
        }
        TEST_ASSERT_EQUAL(inputs == 2, has_delay);
    }
    flight.end();
}

/* ----------------------------------------------------------------------------------------------------------------- out -- */

/* An order about slot 2; the worst one is slot 1. */
static goe_flight_assessment_t an_order() {
    goe_flight_assessment_t assessment{};
    assessment.action = GOE_FLIGHT_RIGHT;
    assessment.late = true;
    assessment.worst = 1;
    assessment.avoided = 2;
    assessment.needed_s = 3.5f;
    assessment.target_ned_m[0] = 10.f;
    assessment.target_ned_m[1] = 20.f;
    assessment.target_ned_m[2] = -30.f;
    return assessment;
}

/* [goe_flight_obstacle_t.length_m, goe_flight_obstacle_t.length_heading_deg] */
static void an_obstacle_is_reported_in_px4s_units() {
    static goe_flight_t flight;
    goe_flight_obstacle_t from{};
    memset(&flight, 0, sizeof flight);
    flight.origin_known = true;
    flight.capture_us = 0xFFFFFF00u; /* the clock's 32 bits have wrapped since */
    from.valid = GOE_HAS_POSITION | GOE_HAS_LENGTH | GOE_HAS_ORIENTATION;
    from.length_m = 8.f;
    from.length_heading_deg = 90.f;
    from.lat_e7 = 474000000;
    from.lon_e7 = -85000000;
    for (int slot = 0; slot < 4; slot++) {
        const goe_obstacle_s topic = goe_px4::obstacle(flight, from, slot, an_order(), 0x200000100u);
        TEST_ASSERT_EQUAL(slot == 1, topic.worst);
        TEST_ASSERT_EQUAL(slot == 2, topic.avoided);
        TEST_ASSERT_TRUE(topic.timestamp_sample == 0x1FFFFFF00u && topic.timestamp == 0x200000100u);
        TEST_ASSERT_TRUE(std::fabs(topic.lat - 47.4) < 1e-9 && std::fabs(topic.lon + 8.5) < 1e-9);
        CHECK_CLOSE(1e-6, 1.5707963, topic.length_heading);
        TEST_ASSERT_TRUE(__builtin_isnan(topic.dcpa) && __builtin_isnan(topic.height) && __builtin_isnan(topic.width));
    }
    flight.origin_known = false;
    TEST_ASSERT_TRUE(__builtin_isnan(goe_px4::obstacle(flight, from, 0, an_order(), 1000u).lat));
}

/* [goe_flight_assessment_t.needed_s] */
static void an_order_is_reported_completely() {
    static goe_flight_t flight;
    goe_flight_assessment_t assessment = an_order();
    goe_status_s topic{};
    memset(&flight, 0, sizeof flight);
    goe_px4::status(flight, assessment, topic);
    TEST_ASSERT_EQUAL(goe_status_s::ACTION_RIGHT, topic.action);
    TEST_ASSERT_TRUE(topic.late);
    TEST_ASSERT_EQUAL(2, topic.avoided);
    CHECK_CLOSE(0, 3.5, topic.needed);
    CHECK_CLOSE(0, -30, topic.target[2]);
    assessment.action = GOE_FLIGHT_NONE;
    goe_px4::status(flight, assessment, topic);
    TEST_ASSERT_TRUE(__builtin_isnan(topic.needed) && __builtin_isnan(topic.target[0]));
}

/* [goe_flight_position_t.origin_known, goe_flight_position_t.origin_lat_e7, goe_flight_position_t.origin_lon_e7] */
static void the_origin_is_rounded_and_no_pole() {
    vehicle_local_position_s topic{};
    goe_flight_position_t sample;
    topic.xy_valid = topic.z_valid = topic.v_xy_valid = topic.v_z_valid = topic.xy_global = true;
    topic.ref_lat = 47.12345678;
    topic.ref_lon = -8.12345678;
    TEST_ASSERT_TRUE(goe_px4::position(topic, goe_px4::Heights(), sample));
    TEST_ASSERT_EQUAL(471234568, sample.origin_lat_e7);
    TEST_ASSERT_EQUAL(-81234568, sample.origin_lon_e7);
    topic.ref_lat = 89.5;
    TEST_ASSERT_TRUE(goe_px4::position(topic, goe_px4::Heights(), sample));
    TEST_ASSERT_FALSE(sample.origin_known);
}

static void a_home_needs_both_to_be_valid() {
    home_position_s home{};
    float down_m = 0.f;
    home.z = 3.f;
    for (int i = 0; i < 4; i++) {
        home.valid_lpos = (i & 1) != 0;
        home.valid_alt = (i & 2) != 0;
        TEST_ASSERT_EQUAL(i == 3, goe_px4::home_down(home, down_m));
    }
    CHECK_CLOSE(0, 3, down_m);
}

#ifdef GOE_HAS_DETECT_AND_AVOID
static void a_conflicts_level_follows_the_order() {
    const float own_ned_m[3] = {0.f, 0.f, -30.f};
    goe_flight_obstacle_t from{};
    goe_flight_assessment_t assessment = an_order();
    from.nearest_ned_m[0] = 40.f;
    from.nearest_ned_m[1] = 30.f;
    from.nearest_ned_m[2] = -40.f;
    from.has_hazard = true;
    from.hazard.conflict_probability = 0.3f;
    const auto level = [&](int slot) {
        return goe_px4::detect_and_avoid(from, slot, assessment, own_ned_m, 0.2f, 1000u).conflict_level;
    };
    TEST_ASSERT_EQUAL(detect_and_avoid_s::DAA_CONFLICT_LVL_CRITICAL, level(2));
    assessment.late = false;
    TEST_ASSERT_EQUAL(detect_and_avoid_s::DAA_CONFLICT_LVL_HIGH, level(2));
    TEST_ASSERT_EQUAL(detect_and_avoid_s::DAA_CONFLICT_LVL_LOW, level(0));
    from.receding = true;
    TEST_ASSERT_EQUAL(detect_and_avoid_s::DAA_CONFLICT_LVL_NONE, level(0));
    const detect_and_avoid_s topic = goe_px4::detect_and_avoid(from, 0, assessment, own_ned_m, 0.2f, 1000u);
    CHECK_CLOSE(1e-4, 50, topic.aircraft_dist_hor);
    CHECK_CLOSE(1e-4, 10, topic.aircraft_dist_vert);
}

static void conflicts_are_reported_where_px4_has_the_topic() {
    static Px4Flight flight;
    flight.begin();
    standin::set("GOE_OUT", 3);
    flight.fly(5.0);
    detect_and_avoid_s topic;
    goe_obstacle_s obstacle;
    TEST_ASSERT_TRUE(standin::latest(ORB_ID(detect_and_avoid), 0, &topic));
    TEST_ASSERT_TRUE(flight.obstacle(obstacle));
    TEST_ASSERT_EQUAL(7u, topic.unique_id);
    CHECK_SAME(obstacle.tcpa, topic.expected_min_dist_time);
    const double distance_m = std::sqrt(std::pow(static_cast<double>(topic.aircraft_dist_hor), 2.0) +
                                        std::pow(static_cast<double>(topic.aircraft_dist_vert), 2.0));
    CHECK_CLOSE(1e-3, distance_m, topic.aircraft_dist);
    TEST_ASSERT_TRUE(topic.conflict_level <= detect_and_avoid_s::DAA_CONFLICT_LVL_CRITICAL);
    flight.end();
}
#endif

/* ---------------------------------------------------------------------------------------------------------- parameters -- */

static void set_camera(GoeParameters &parameters) {
    goe_camera_t &camera = parameters.estimator.camera;
    camera.fx_px = camera.fy_px = 1e5f; /* focal length and size that contradict no other value in module.yaml */
    camera.cx_px = camera.cy_px = 640.f;
    camera.width_px = camera.height_px = 1e5f;
}

/* The layer's defaults, except those measured with PX4's filter. */
static void the_defaults_are_the_layers_but_for_px4s_own() {
    GoeParameters parameters;
    GoeParameters expected;
    memset(&expected, 0, sizeof expected);
    goe_settings_default(&expected.estimator);
    goe_flight_settings_default(&expected.flight);
    expected.estimator.navigation.attitude_bias_sd_deg = 1.f;
    expected.estimator.navigation.attitude_walk_sd_deg = 0.5f;
    expected.estimator.navigation.attitude_white_sd_deg = 0.3f;
    expected.estimator.camera.width_px = expected.estimator.camera.height_px = 0.f; /* which the layer refuses */
    expected.estimator.camera.cx_px = expected.estimator.camera.cy_px = 0.f; /* the middle of an image of no size yet */
    standin::begin(1000000u);
    standin::set_other("NAV_LOITER_RAD", 80.f);
    goe_parameters_read(parameters, false);
    TEST_ASSERT_FALSE(goe_parameters_differ(expected, parameters));
    TEST_ASSERT_EQUAL(0, parameters.react);
    TEST_ASSERT_EQUAL(0, parameters.resume);
}

static GoeParameters of_wings(float loiter_m, float speed_m_s, float bank_deg) {
    GoeParameters parameters;
    standin::begin(1000000u);
    standin::set_other("NAV_LOITER_RAD", loiter_m);
    standin::set_other("FW_AIRSPD_TRIM", speed_m_s);
    standin::set_other("FW_R_LIM", bank_deg);
    goe_parameters_read(parameters, true);
    return parameters;
}

static void a_fixed_wings_parameters_give_loiter_bank_and_climb() {
    GoeParameters parameters = of_wings(90.f, 15.f, 50.f);
    CHECK_SAME(90.f, parameters.flight.loiter_m);
    CHECK_SAME(30.f, parameters.flight.bank_deg);
    CHECK_SAME(0.f, parameters.narrow_loiter_m);
    parameters = of_wings(200.f, 15.f, 20.f);
    CHECK_SAME(20.f, parameters.flight.bank_deg);
    standin::set_other("FW_T_CLMB_MAX", 2.f);
    goe_parameters_read(parameters, true);
    CHECK_SAME(2.f, parameters.flight.climb_m_s);
    standin::set_other("FW_T_CLMB_MAX", 5.f);
    standin::set_other("NAV_LOITER_RAD", NAN);
    goe_parameters_read(parameters, true);
    CHECK_SAME(2.5f, parameters.flight.climb_m_s);
    CHECK_SAME(0.f, parameters.flight.loiter_m);
    standin::set_other("NAV_LOITER_RAD", 200.f);
    goe_parameters_read(parameters, false); /* without wings there is no circle */
    CHECK_SAME(0.f, parameters.flight.loiter_m);
    CHECK_SAME(30.f, parameters.flight.bank_deg);
    standin::begin(1000000u); /* a firmware without these */
    goe_parameters_read(parameters, true);
    CHECK_SAME(0.f, parameters.flight.loiter_m);
}

static void a_circle_that_cannot_be_flown_is_widened() {
    GoeParameters parameters = of_wings(60.f, 22.f, 50.f);
    CHECK_CLOSE(0.2, 85.5, parameters.flight.loiter_m); /* 22^2 / (g tan 30) */
    CHECK_SAME(60.f, parameters.narrow_loiter_m);
    parameters = of_wings(60.f, 22.f, 20.f);
    CHECK_CLOSE(0.3, 135.6, parameters.flight.loiter_m);
}

static void a_camera_of_square_pixels_needs_three_numbers() {
    GoeParameters parameters;
    standin::begin(1000000u);
    standin::set("GOE_CAM_W", 1280.f);
    standin::set("GOE_CAM_H", 720.f);
    standin::set("GOE_CAM_FX", 900.f);
    goe_parameters_read(parameters, false);
    CHECK_SAME(900.f, parameters.estimator.camera.fy_px);
    CHECK_SAME(640.f, parameters.estimator.camera.cx_px);
    CHECK_SAME(360.f, parameters.estimator.camera.cy_px);
    standin::set("GOE_CAM_CY", 350.f);
    standin::set("GOE_CAM_FY", NAN);
    goe_parameters_read(parameters, false);
    CHECK_SAME(350.f, parameters.estimator.camera.cy_px);
    TEST_ASSERT_TRUE(__builtin_isnan(parameters.estimator.camera.fy_px)); /* refused by the layer */
}

/* Each parameter changes four bytes of the settings, and no two change the same. */
static void each_parameter_has_a_place_of_its_own() {
    GoeParameters before;
    GoeParameters after;
    bool taken[sizeof(GoeParameters) / sizeof(float)] = {};
    const auto begin = [] { /* no camera setting is derived */
                            standin::begin(1000000u);
                            for (const char *name : {"GOE_CAM_FY", "GOE_CAM_CX", "GOE_CAM_CY"}) {
                                standin::set(name, 1.f);
                            }
    };
    begin();
    goe_parameters_read(before, false);
    for (const auto &parameter : px4::standin_parameter) {
        unsigned changed = 0;
        begin();
        if (parameter.is_int) {
            standin::set(parameter.name, static_cast<int32_t>(parameter.standard) + 1);
        } else {
            standin::set(parameter.name, static_cast<float>(parameter.standard) + 0.5f);
        }
        goe_parameters_read(after, false);
        for (size_t i = 0; i < sizeof taken / sizeof taken[0]; i++) {
            const char *const word[] = {reinterpret_cast<const char *>(&before),
                                        reinterpret_cast<const char *>(&after)};
            if (memcmp(word[0] + i * sizeof(float), word[1] + i * sizeof(float), sizeof(float)) != 0) {
                TEST_ASSERT_FALSE_MESSAGE(taken[i], parameter.name);
                taken[i] = true;
                changed++;
            }
        }
        TEST_ASSERT_EQUAL_MESSAGE(1, changed, parameter.name);
    }
}

/* The layer accepts both ends of every range in module.yaml. */
static void every_range_lies_within_the_layers() {
    static goe_flight_t flight;
    for (const auto &parameter : px4::standin_parameter) {
        const bool must_be_set =
            strncmp(parameter.name, "GOE_CAM_", 8) == 0 && strpbrk(parameter.name + 8, "WHF") != nullptr;
        for (const double end : {parameter.least, parameter.most}) {
            GoeParameters parameters;
            const char *bad = nullptr;
            standin::begin(1000000u);
            if (parameter.is_int) {
                standin::set(parameter.name, static_cast<int32_t>(end));
            } else {
                standin::set(parameter.name, static_cast<float>(end));
            }
            goe_parameters_read(parameters, false);
            if (!must_be_set) {
                const goe_camera_t camera = parameters.estimator.camera;
                set_camera(parameters);
                parameters.estimator.camera.cx_px = camera.cx_px;
                parameters.estimator.camera.cy_px = camera.cy_px;
            } else if (end > 0.0) {
                goe_camera_t camera = parameters.estimator.camera;
                set_camera(parameters);
                float *const fields[][2] = {{&camera.fx_px, &parameters.estimator.camera.fx_px},
                                            {&camera.fy_px, &parameters.estimator.camera.fy_px},
                                            {&camera.width_px, &parameters.estimator.camera.width_px},
                                            {&camera.height_px, &parameters.estimator.camera.height_px}};
                for (auto &field : fields) {
                    *field[1] = *field[0] > 0.f ? *field[0] : *field[1];
                }
            }
            const bool taken = goe_flight_init(&flight, sizeof flight, &parameters.estimator, &parameters.flight,
                                               &bad) == GOE_FLIGHT_OK;
            TEST_ASSERT_TRUE_MESSAGE(taken == !(must_be_set && end <= 0.0), parameter.name);
        }
    }
}

int main() {
    UNITY_BEGIN();
    RUN_TEST(a_distance_sensor_that_looks_down_gives_a_height);
    RUN_TEST(a_setpoint_to_land_is_an_approach);
    RUN_TEST(the_controller_reports_the_flare);
    RUN_TEST(the_flare_of_an_earlier_landing_is_none);
    RUN_TEST(what_the_land_detector_says_is_landed);
    RUN_TEST(each_height_is_marked_by_its_source);
    RUN_TEST(each_clock_has_its_own_times);
    RUN_TEST(a_tunnel_carries_three_boxes);
    RUN_TEST(a_tunnel_that_is_cut_carries_one_less);
    RUN_TEST(others_tunnels_are_theirs);
    RUN_TEST(a_tunnel_to_another_vehicle_is_not_taken);
    RUN_TEST(any_bytes_in_a_tunnel_are_borne);
    RUN_TEST(a_flight_by_tunnel_is_that_by_topic);
    RUN_TEST(a_landing_target_is_a_box_of_a_calibrated_age);
    RUN_TEST(landing_targets_are_taken_only_if_enabled);
    RUN_TEST(an_obstacle_is_reported_in_px4s_units);
    RUN_TEST(an_order_is_reported_completely);
    RUN_TEST(the_origin_is_rounded_and_no_pole);
    RUN_TEST(a_home_needs_both_to_be_valid);
#ifdef GOE_HAS_DETECT_AND_AVOID
    RUN_TEST(a_conflicts_level_follows_the_order);
    RUN_TEST(conflicts_are_reported_where_px4_has_the_topic);
#endif
    RUN_TEST(the_defaults_are_the_layers_but_for_px4s_own);
    RUN_TEST(a_fixed_wings_parameters_give_loiter_bank_and_climb);
    RUN_TEST(a_circle_that_cannot_be_flown_is_widened);
    RUN_TEST(a_camera_of_square_pixels_needs_three_numbers);
    RUN_TEST(each_parameter_has_a_place_of_its_own);
    RUN_TEST(every_range_lies_within_the_layers);
    return UNITY_END();
}
