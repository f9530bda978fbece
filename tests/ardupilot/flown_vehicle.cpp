/* A vehicle that flies past an obstacle. SPDX-License-Identifier: MIT */
#include "flown_vehicle.h"

#include <AP_HAL/AP_HAL.h>
#include <GCS_MAVLink/GCS.h>

#include <cstring>
#include <string>

static const float SIZE_PX = 1280.0f;
static const uint32_t STEP_US = 1000000 / FLOWN_POSE_HZ;
static const uint32_t ASSESS_MS = 100;
static const uint32_t WAIT_US = 200000;
static const size_t IMAGES_AT_ONCE = 4;

static const AP_Param::GroupInfo &parameter(const char *name) {
    const AP_Param::GroupInfo *info = AP_GOE::var_info;
    while (info->type != AP_PARAM_NONE && strcmp(info->name, name) != 0) {
        info++;
    }
    TEST_ASSERT_NOT_EQUAL_MESSAGE(AP_PARAM_NONE, info->type, name);
    return *info;
}

AP_GOE *new_goe() {
    static uint64_t memory[(sizeof(AP_GOE) + 7) / 8]; // it is a singleton
    memset(memory, 0, sizeof memory);
    return new (memory) AP_GOE();
}

void set_parameter(AP_GOE &goe, const char *name, float value) {
    const AP_Param::GroupInfo &info = parameter(name);
    char *element = reinterpret_cast<char *>(&goe) + info.offset;
    if (info.type == AP_PARAM_FLOAT) {
        reinterpret_cast<AP_Float *>(element)->set(value);
    } else if (info.type == AP_PARAM_INT8) {
        reinterpret_cast<AP_Int8 *>(element)->set(int8_t(value));
    } else {
        reinterpret_cast<AP_Int16 *>(element)->set(int16_t(value));
    }
}

float get_parameter(const AP_GOE &goe, const char *name) {
    const AP_Param::GroupInfo &info = parameter(name);
    const char *element = reinterpret_cast<const char *>(&goe) + info.offset;
    if (info.type == AP_PARAM_FLOAT) {
        return reinterpret_cast<const AP_Float *>(element)->get();
    }
    return info.type == AP_PARAM_INT8 ? float(reinterpret_cast<const AP_Int8 *>(element)->get())
                                      : float(reinterpret_cast<const AP_Int16 *>(element)->get());
}

mavlink_message_t features_message(const goe_mavlink_features_t &features, uint8_t system) {
    mavlink_message_t message;
    uint8_t payload[GOE_MAVLINK_PAYLOAD_MAX];
    uint8_t frame[GOE_MAVLINK_FRAME_MAX];
    memset(&message, 0, sizeof message);
    const size_t length = goe_mavlink_pack_features(&features, payload);
    goe_mavlink_sender_t sender = {system, 100, 77};
    const size_t whole = goe_mavlink_frame(&sender, GOE_MAVLINK_FEATURES, payload, length, frame);
    message.len = uint8_t(length);
    message.seq = 77;
    message.sysid = system;
    message.compid = 100;
    message.msgid = goe_mavlink_info(GOE_MAVLINK_FEATURES)->id;
    message.checksum = uint16_t(frame[whole - 2] | frame[whole - 1] << 8);
    memcpy(message.payload64, payload, length);
    return message;
}

// ------------------------------------------------------------------------------------------------------------ detector

static int16_t tenths(float px) { return int16_t(lroundf(10.0f * (px - 0.5f * SIZE_PX))); }

static goe_mavlink_features_t features_of(const goe_flight_detection_t &detection, uint8_t number) {
    goe_mavlink_features_t features;
    memset(&features, 0, sizeof features);
    features.image_width = features.image_height = uint16_t(SIZE_PX);
    features.time_sd = 1000;
    features.score = 90;
    features.number = number;
    if (number > 0) {
        features.obstacle_id = detection.id;
        features.visible = detection.box.sides;
        features.box[GOE_MAVLINK_LEFT] = tenths(detection.box.left_px);
        features.box[GOE_MAVLINK_TOP] = tenths(detection.box.top_px);
        features.box[GOE_MAVLINK_RIGHT] = tenths(detection.box.right_px);
        features.box[GOE_MAVLINK_BOTTOM] = tenths(detection.box.bottom_px);
    }
    return features;
}

void FlownVehicle::send(const goe_mavlink_features_t &features) {
    goe->handle_unknown(features_message(features), MAVLINK_COMM_0);
    waiting.push_back(Kept{features, AP_HAL::micros()});
}

void FlownVehicle::send_image() {
    const int exposed = flown.sample - 1 - delay;
    if (!sends || goe->_state == nullptr || exposed < 0 || exposed % FLOWN_IMAGE_EVERY != 0) {
        return;
    }
    goe_flight_detection_t detection = flown_detection(&flown, exposed);
    const bool sees = flown.detects && detection.box.sides == GOE_SIDES_ALL;
    const uint8_t number = sees ? copies : 0;
    const uint64_t exposed_us = first_us + uint64_t(exposed) * STEP_US + uint64_t(int64_t(ahead_us));
    images++;
    for (uint8_t i = 0; i < (number > 0 ? number : 1); i++) {
        goe_mavlink_features_t features = features_of(detection, number);
        features.time_usec = exposed_us;
        send(features);
        detection.id++;
        detection.box.left_px += 90.0f;
        detection.box.right_px += 90.0f;
    }
}

// ------------------------------------------------------------------------------------------------------- own flight layer

void FlownVehicle::restart_layer() {
    goe_settings_t estimator;
    goe_flight_settings_t settings;
    goe_settings_default(&estimator);
    goe_flight_settings_default(&settings);
    estimator.navigation.attitude_walk_sd_deg = AP_GOE_ATTITUDE_DRIFT;
    estimator.camera.fx_px = estimator.camera.fy_px = flown.scene.camera.fx_px;
    estimator.camera.cx_px = estimator.camera.cy_px = 0.5f * SIZE_PX;
    estimator.camera.width_px = estimator.camera.height_px = SIZE_PX;
    settings.resets = GOE_FLIGHT_RESETS_TIME;
    settings.margin_m = get_parameter(*goe, "MARGIN");
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_init(&layer, sizeof layer, &estimator, &settings, nullptr));
}

bool FlownVehicle::take_layer_image(const Kept &kept) {
    goe_mavlink_sighting_t sighting;
    (void)goe_mavlink_from_features(&kept.features, kept.arrival_us, &sighting);
    return goe_flight_frame(&layer, &sighting.frame) != GOE_FLIGHT_TOO_NEW ||
           AP_HAL::micros() - kept.arrival_us > WAIT_US;
}

void FlownVehicle::step_layer() {
    goe_flight_attitude_t attitude;
    goe_flight_position_t position;
    flown_samples(&flown, flown.sample - 1, &attitude, &position);
    attitude.time_us = position.time_us = scripted.sample_us;
    attitude.reset = scripted.yaw_reset_ms + 1; // the first read of the filter's state counts as a change
    position.position_ned_m[0] += jump.x;
    position.position_ned_m[1] += jump.y;
    position.position_ned_m[2] += jump.z;
    position.reset_horizontal = scripted.horizontal_reset_ms;
    position.reset_vertical = scripted.vertical_reset_ms;
    position.reset_delta_known = true;
    position.reset_delta_ned_m[0] = scripted.horizontal_change.x;
    position.reset_delta_ned_m[1] = scripted.horizontal_change.y;
    position.reset_delta_ned_m[2] = scripted.vertical_change;
    position.origin_known = true;
    position.origin_lat_e7 = scripted.origin.lat;
    position.origin_lon_e7 = scripted.origin.lng;
    position.height_valid |= 1u << GOE_FLIGHT_HOME;
    position.height_m[GOE_FLIGHT_HOME] = -(scripted.position.z - scripted.down_of_home);
    if (goe_flight_attitude(&layer, &attitude) == GOE_FLIGHT_OK) {
        (void)goe_flight_position(&layer, &position);
    }
    std::vector<Kept> left;
    for (size_t i = 0; i < waiting.size(); i++) {
        if (i - left.size() >= IMAGES_AT_ONCE || !take_layer_image(waiting[i])) {
            left.push_back(waiting[i]);
        }
    }
    waiting = left;
    if (AP_HAL::millis() - assessed_ms >= ASSESS_MS) {
        assessed_ms = AP_HAL::millis();
        goe_flight_assessment_t now;
        const bool is_assessed = goe_flight_assess(&layer, AP_HAL::micros(), scripted.landing, &now) == GOE_FLIGHT_OK;
        assessment = is_assessed ? now : assessment;
        assessment.pose_alive = is_assessed && now.pose_alive;
    }
}

// ----------------------------------------------------------------------------------------------------------------- flight

FlownVehicle::FlownVehicle()
    : compares(true), delay(FLOWN_DELAY), ahead_us(0), sends(true), copies(1), first_us(1000000), images(0),
      compared(0), assessed_ms(0) {
    scripted = Scripted();
    AP::oadatabase()->begin(0);
    AP::oadatabase()->set_limits(0.01f, 0.0f);
    flown_start(&flown, nullptr);
    goe = new_goe();
    set_parameter(*goe, "ENABLE", 1);
    set_parameter(*goe, "WIDTH", SIZE_PX);
    set_parameter(*goe, "HEIGHT", SIZE_PX);
    set_parameter(*goe, "FX", flown.scene.camera.fx_px);
    memset(&assessment, 0, sizeof assessment);
    assessment.worst = -1;
    restart_layer();
}

void FlownVehicle::take_sample() {
    goe_flight_attitude_t attitude;
    goe_flight_position_t position;
    flown_samples(&flown, flown.sample, &attitude, &position);
    scripted.now_us = first_us + uint64_t(flown.sample) * STEP_US;
    scripted.sample_us = uint32_t(scripted.now_us);
    show_clock();
    scripted.q.q1 = attitude.q[0];
    scripted.q.q2 = attitude.q[1];
    scripted.q.q3 = attitude.q[2];
    scripted.q.q4 = attitude.q[3];
    const float *ned = position.position_ned_m;
    scripted.position = Vector3f(ned[0] + jump.x, ned[1] + jump.y, ned[2] + jump.z);
    const float *v = position.velocity_ned_m_s;
    scripted.velocity = Vector3f(v[0], v[1], v[2]);
    scripted.has_terrain = true;
    scripted.terrain_m = position.height_m[GOE_FLIGHT_TERRAIN];
    flown.sample++;
}

void FlownVehicle::step() {
    take_sample();
    send_image();
    goe->update();
    if (steps_database && AP::oadatabase() != nullptr) {
        AP::oadatabase()->update();
    }
    step_layer();
    if (compares) {
        compare();
    }
}

void FlownVehicle::fly(double seconds) {
    for (int i = 0; i < int(seconds * FLOWN_POSE_HZ); i++) {
        step();
    }
}

// ---------------------------------------------------------------------------------------------------------------- compare

static void compare_hazards(const goe_hazard_t &expected, const goe_hazard_t &actual) {
    CHECK_SAME(expected.tcpa_s, actual.tcpa_s);
    CHECK_SAME(expected.tcpa_sd_s, actual.tcpa_sd_s);
    CHECK_SAME(expected.dcpa_m, actual.dcpa_m);
    CHECK_SAME(expected.dcpa_sd_m, actual.dcpa_sd_m);
    CHECK_SAME(expected.clearance_m, actual.clearance_m);
    CHECK_SAME(expected.conflict_probability, actual.conflict_probability);
}

static void compare_obstacles(const goe_flight_obstacle_t &expected, const goe_flight_obstacle_t &actual) {
    TEST_ASSERT_EQUAL(expected.id, actual.id);
    TEST_ASSERT_EQUAL(expected.valid, actual.valid);
    TEST_ASSERT_EQUAL(expected.suspect, actual.suspect);
    TEST_ASSERT_EQUAL(expected.in_view, actual.in_view);
    for (int i = 0; i < 3; i++) {
        CHECK_SAME(expected.center_ned_m[i], actual.center_ned_m[i]);
        CHECK_SAME(expected.covariance_ne_m2[i], actual.covariance_ne_m2[i]);
        CHECK_SAME(expected.nearest_body_m[i], actual.nearest_body_m[i]);
    }
    CHECK_SAME(expected.radius_m, actual.radius_m);
    CHECK_SAME(expected.height_m, actual.height_m);
    CHECK_SAME(expected.age_s, actual.age_s);
    TEST_ASSERT_EQUAL(expected.lat_e7, actual.lat_e7);
    TEST_ASSERT_EQUAL(expected.has_hazard, actual.has_hazard);
    compare_hazards(expected.hazard, actual.hazard);
}

/* The main thread's state is that of the thread's latest assessment: compared once for each. */
void FlownVehicle::compare() {
    if (goe->_state->shown.assessed == compared) {
        return;
    }
    compared = goe->_state->shown.assessed;
    const AP_GOE::Found &found = goe->_state->shown;
    const goe_flight_assessment_t &actual = found.assessment;
    TEST_ASSERT_EQUAL(assessment.action, actual.action);
    TEST_ASSERT_EQUAL(assessment.worst, actual.worst);
    TEST_ASSERT_EQUAL(assessment.obstacles, actual.obstacles);
    TEST_ASSERT_EQUAL(assessment.detector_alive, actual.detector_alive);
    TEST_ASSERT_EQUAL(assessment.pose_alive, actual.pose_alive);
    CHECK_SAME(assessment.needed_s, actual.needed_s);
    compare_hazards(assessment.hazard, actual.hazard);
    for (int slot = 0; slot < GOE_FLIGHT_SLOTS; slot++) {
        goe_flight_obstacle_t expected;
        TEST_ASSERT_EQUAL(goe_flight_obstacle(&layer, slot, &expected), found.state[slot]);
        compare_obstacles(expected, found.obstacle[slot]);
    }
    TEST_ASSERT_EQUAL_MEMORY(&layer.counters, &found.counters, sizeof layer.counters);
}
