/* A flight as PX4's topics. SPDX-License-Identifier: MIT */
#include "px4_flight.hpp"

static constexpr uint64_t LATE_US = 4000; /* between a sample and its publication */
static constexpr float CAMERA_PX = 1280.f;

int goe_command(const char *word) {
    char name[] = "goe";
    char argument[32];
    strncpy(argument, word, sizeof argument - 1);
    argument[sizeof argument - 1] = '\0';
    char *arguments[] = {name, argument, nullptr};
    return goe_main(argument[0] != '\0' ? 2 : 1, arguments);
}

void Px4Flight::begin(uint64_t clock_us, bool set_camera) {
    standin::begin(clock_us);
    flown_start(&flown, nullptr);
    flown.start_us = goe_px4::time_us(clock_us);
    _start_us = clock_us;
    if (set_camera) {
        standin::set("GOE_CAM_W", CAMERA_PX);
        standin::set("GOE_CAM_H", CAMERA_PX);
        standin::set("GOE_CAM_FX", flown.scene.camera.fx_px);
    }
    sends_pose = sends_images = in_step = sends_position = true;
    failsafe = user_took_over = false;
    follows = set_camera;
    position = vehicle_local_position_s{};
    quat_reset_counter = 0;
    compared = 0;
    _statuses = _obstacles = 0;
    _assessment = goe_flight_assessment_t{};
    _assessment.worst = -1;
    standin::set_other("NAV_LOITER_RAD", 80.f);
    standin::set_other("FW_AIRSPD_TRIM", 15.f);
    set_mode(false, vehicle_status_s::NAVIGATION_STATE_AUTO_LOITER);
    TEST_ASSERT_EQUAL(0, goe_command("start"));
    if (follows) {
        GoeParameters parameters;
        goe_parameters_read(parameters, has_wings);
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_init(&reference, sizeof reference, &parameters.estimator,
                                                         &parameters.flight, nullptr));
    }
}

void Px4Flight::end() {
    if (goe_command("status") == 0) {
        TEST_ASSERT_EQUAL(0, goe_command("stop"));
    }
    TEST_ASSERT_NOT_EQUAL(0, goe_command("status"));
}

void Px4Flight::publish_pose() {
    goe_flight_attitude_t attitude;
    goe_flight_position_t sample;
    vehicle_attitude_s topic{};
    flown_samples(&flown, flown.sample, &attitude, &sample);
    attitude.reset = quat_reset_counter;
    topic.timestamp = standin::now_us();
    topic.timestamp_sample = time_of(flown.sample);
    memcpy(topic.q, attitude.q, sizeof topic.q);
    topic.quat_reset_counter = quat_reset_counter;
    position.timestamp = standin::now_us();
    position.timestamp_sample = time_of(flown.sample);
    position.xy_valid = position.z_valid = position.v_xy_valid = position.v_z_valid = true;
    position.x = sample.position_ned_m[0];
    position.y = sample.position_ned_m[1];
    position.z = sample.position_ned_m[2];
    position.vx = sample.velocity_ned_m_s[0];
    position.vy = sample.velocity_ned_m_s[1];
    position.vz = sample.velocity_ned_m_s[2];
    position.dist_bottom_valid = true;
    position.dist_bottom = sample.height_m[GOE_FLIGHT_TERRAIN];
    if (sends_position) {
        standin::publish(ORB_ID(vehicle_local_position), &position);
    }
    standin::publish(ORB_ID(vehicle_attitude), &topic);
    if (follows) {
        sample.reset_horizontal = position.xy_reset_counter;
        sample.reset_vertical = position.z_reset_counter;
        memcpy(sample.reset_delta_ned_m, position.delta_xy, sizeof position.delta_xy);
        sample.reset_delta_ned_m[2] = position.delta_z;
        sample.origin_known = position.xy_global;
        sample.origin_lat_e7 = static_cast<int32_t>(std::lround(1e7 * position.ref_lat));
        sample.origin_lon_e7 = static_cast<int32_t>(std::lround(1e7 * position.ref_lon));
        (void)goe_flight_attitude(&reference, &attitude);
        (void)goe_flight_position(&reference, &sample);
    }
}

goe_features_s Px4Flight::features_of(int k) const {
    goe_features_s topic{};
    const goe_flight_detection_t detection = flown_detection(&flown, k);
    const bool detects = flown.detects && detection.box.sides == GOE_SIDES_ALL;
    topic.timestamp = standin::now_us();
    topic.timestamp_sample = time_of(k);
    topic.time_sd = 1000u;
    topic.number = detects ? 1 : 0;
    topic.id = detection.id;
    topic.score = detection.score;
    topic.sides = detection.box.sides;
    topic.box[0] = detection.box.left_px;
    topic.box[1] = detection.box.top_px;
    topic.box[2] = detection.box.right_px;
    topic.box[3] = detection.box.bottom_px;
    return topic;
}

void Px4Flight::publish_image(int k, uint64_t capture_us) {
    goe_features_s topic = features_of(k);
    topic.timestamp_sample = capture_us;
    standin::publish(ORB_ID(goe_features), &topic);
}

void Px4Flight::step() {
    standin::advance(in_step ? time_of(flown.sample) + LATE_US - standin::now_us() : STEP_US);
    follow_status();
    if (sends_pose) {
        publish_pose();
    }
    const int exposed = flown.sample - FLOWN_DELAY;
    flown.sample++;
    if (sends_images && exposed >= 0 && exposed % FLOWN_IMAGE_EVERY == 0) {
        publish_image(exposed, time_of(exposed));
        if (follows) {
            const goe_flight_detection_t detection = flown_detection(&flown, exposed);
            const bool detects = flown.detects && detection.box.sides == GOE_SIDES_ALL;
            goe_flight_frame_t frame = flown_frame(&flown, exposed, &detection, detects ? 1 : 0);
            (void)goe_flight_frame(&reference, &frame);
        }
    }
    standin::settle();
    follow_status();
}

void Px4Flight::fly(double seconds) {
    const int steps = static_cast<int>(seconds * FLOWN_POSE_HZ + 0.5);
    for (int i = 0; i < steps; i++) {
        step();
    }
}

void Px4Flight::set_mode(bool armed, uint8_t nav_state) {
    vehicle_status_s topic{};
    topic.timestamp = standin::now_us();
    topic.arming_state = armed ? vehicle_status_s::ARMING_STATE_ARMED : vehicle_status_s::ARMING_STATE_DISARMED;
    topic.nav_state = nav_state;
    topic.vehicle_type =
        has_wings ? vehicle_status_s::VEHICLE_TYPE_FIXED_WING : vehicle_status_s::VEHICLE_TYPE_ROTARY_WING;
    topic.system_id = system;
    topic.component_id = 1;
    topic.failsafe = failsafe;
    topic.failsafe_and_user_took_over = user_took_over;
    standin::publish(ORB_ID(vehicle_status), &topic);
}

goe_status_s Px4Flight::status() const {
    goe_status_s topic{};
    TEST_ASSERT_TRUE(standin::latest(ORB_ID(goe_status), 0, &topic));
    return topic;
}

bool Px4Flight::obstacle(goe_obstacle_s &topic) const { return standin::latest(ORB_ID(goe_obstacle), 0, &topic); }

/* ------------------------------------------------------------------------------------------------ against the reference -- */

static void same(float expected, bool known, float actual) {
    if (known) {
        CHECK_SAME(expected, actual);
    } else {
        TEST_ASSERT_TRUE(__builtin_isnan(actual));
    }
}

static void compare_obstacle(const goe_flight_obstacle_t &o, const goe_obstacle_s &topic) {
    TEST_ASSERT_EQUAL_UINT32(o.id, topic.id);
    TEST_ASSERT_EQUAL(o.model, topic.model);
    TEST_ASSERT_EQUAL(o.suspect, topic.suspect);
    TEST_ASSERT_EQUAL(o.receding, topic.receding);
    TEST_ASSERT_EQUAL(o.in_view, topic.in_view);
    CHECK_SAME(o.center_ned_m[0], topic.north);
    CHECK_SAME(o.center_ned_m[1], topic.east);
    CHECK_SAME(o.center_ned_m[2], topic.ground_down);
    CHECK_SAME(o.radius_m, topic.radius);
    CHECK_SAME(o.age_s, topic.age);
    for (int i = 0; i < 3; i++) {
        CHECK_SAME(o.covariance_ne_m2[i], topic.covariance[i]);
        CHECK_SAME(o.nearest_ned_m[i], topic.nearest[i]);
    }
    same(o.width_m, (o.valid & GOE_HAS_WIDTH) != 0u, topic.width);
    same(o.length_m, (o.valid & GOE_HAS_LENGTH) != 0u, topic.length);
    same(o.height_m, (o.valid & GOE_HAS_HEIGHT) != 0u, topic.height);
    same(o.hazard.tcpa_s, o.has_hazard, topic.tcpa);
    same(o.hazard.dcpa_m, o.has_hazard, topic.dcpa);
    same(o.hazard.conflict_probability, o.has_hazard, topic.conflict_probability);
    same(o.hazard.clearance_m, o.has_hazard && o.hazard.has_clearance, topic.clearance);
}

void Px4Flight::compare(const goe_flight_assessment_t &assessment, const goe_status_s &topic) {
    TEST_ASSERT_EQUAL(assessment.action, topic.action);
    TEST_ASSERT_EQUAL(assessment.obstacles, topic.obstacles);
    TEST_ASSERT_EQUAL(assessment.unplaced, topic.unplaced);
    TEST_ASSERT_EQUAL(assessment.worst, topic.worst);
    TEST_ASSERT_EQUAL(assessment.detector_alive, topic.detector_alive);
    TEST_ASSERT_EQUAL(assessment.pose_alive, topic.pose_alive);
    TEST_ASSERT_EQUAL(reference.counters.taken, topic.taken);
    TEST_ASSERT_EQUAL(reference.counters.lost, topic.lost);
    TEST_ASSERT_EQUAL(reference.counters.resets, topic.resets);
    for (int slot = 0; slot < GOE_FLIGHT_SLOTS; slot++) {
        goe_flight_obstacle_t expected;
        goe_obstacle_s actual;
        if (goe_flight_obstacle(&reference, slot, &expected) != GOE_FLIGHT_OK ||
            (expected.valid & GOE_HAS_POSITION) == 0u) {
            continue;
        }
        TEST_ASSERT_TRUE(standin::copy(ORB_ID(goe_obstacle), 0, _obstacles, &actual));
        TEST_ASSERT_EQUAL(slot, actual.slot);
        compare_obstacle(expected, actual);
        compared++;
    }
    goe_obstacle_s none;
    TEST_ASSERT_FALSE(standin::copy(ORB_ID(goe_obstacle), 0, _obstacles, &none));
}

void Px4Flight::follow_status() {
    goe_status_s topic;
    while (follows && standin::copy(ORB_ID(goe_status), 0, _statuses, &topic)) {
        goe_flight_assessment_t assessment;
        uint16_t sector_cm[GOE_FLIGHT_SECTORS];
        obstacle_distance_s distances{};
        const bool is_assessed =
            goe_flight_assess(&reference, goe_px4::time_us(topic.timestamp), false, &assessment) == GOE_FLIGHT_OK;
        _assessment = is_assessed ? assessment : _assessment;
        _assessment.pose_alive = is_assessed && assessment.pose_alive;
        compare(_assessment, topic);
        if (standin::latest(ORB_ID(obstacle_distance), 0, &distances) && distances.timestamp == topic.timestamp &&
            goe_flight_sectors(&reference, 20000u, sector_cm) == GOE_FLIGHT_OK) {
            TEST_ASSERT_EQUAL_MEMORY(sector_cm, distances.distances, sizeof sector_cm);
        }
    }
}
