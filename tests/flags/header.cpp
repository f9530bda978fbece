// The public headers in a C++ translation unit, with a call of every function; of the codec of one message.
#include "goe_flight.h"
#include "goe_mavlink.h"
#include "goe_mavlink_map.h"

static goe_flight_t flight;

static bool flight_layer_answers(const goe_settings_t &estimator) {
    goe_flight_settings_t settings;
    goe_flight_settings_default(&settings);
    if (goe_flight_init(&flight, sizeof flight, &estimator, &settings, nullptr) != GOE_FLIGHT_OK) {
        return false;
    }
    goe_flight_attitude_t attitude = goe_flight_attitude_t();
    attitude.q[0] = 1.0f;
    const goe_flight_position_t position = goe_flight_position_t();
    const goe_flight_frame_t frame = goe_flight_frame_t();
    goe_flight_assessment_t assessment;
    goe_flight_obstacle_t obstacle;
    goe_pose_t pose;
    uint16_t sector_cm[GOE_FLIGHT_SECTORS];
    return goe_flight_attitude(&flight, &attitude) == GOE_FLIGHT_OK &&
           goe_flight_position(&flight, &position) == GOE_FLIGHT_OK &&
           goe_flight_timesync(&flight, 0u, 100u) == GOE_FLIGHT_OK &&
           goe_flight_pose(&flight, 0u, 0u, &pose, nullptr) == GOE_FLIGHT_OK &&
           goe_flight_frame(&flight, &frame) == GOE_FLIGHT_OK &&
           goe_flight_assess(&flight, 0u, false, &assessment) == GOE_FLIGHT_OK &&
           goe_flight_obstacle(&flight, 0, &obstacle) == GOE_FLIGHT_NOTHING &&
           goe_flight_sectors(&flight, 1000u, sector_cm) == GOE_FLIGHT_OK &&
           goe_flight_restart(&flight) == GOE_FLIGHT_OK && goe_flight_action_text(assessment.action)[0] == 'n';
}

static bool features_arrive() {
    goe_mavlink_features_t features = goe_mavlink_features_t();
    goe_mavlink_sighting_t sighting;
    uint8_t payload[GOE_MAVLINK_PAYLOAD_MAX];
    features.number = 1u;
    features.image_width = features.image_height = 640u;
    features.visible = GOE_MAVLINK_FEATURE_BOX;
    const size_t length = goe_mavlink_pack_features(&features, payload);
    goe_mavlink_read_features(payload, length, &features);
    return goe_mavlink_from_features(&features, 0u, &sighting) && sighting.frame.count == 1u;
}

static bool standard_messages_arrive() {
    const goe_mavlink_camera_t camera = {640.0f, 640.0f, 800.0f, 800.0f, 320.0f, 320.0f, 0u, 0u, 0u, false};
    const goe_mavlink_landing_target_t target = goe_mavlink_landing_target_t();
    const goe_mavlink_tracking_t tracking = goe_mavlink_tracking_t();
    goe_mavlink_sighting_t sighting;
    return !goe_mavlink_from_landing_target(&target, &camera, 0u, &sighting) &&
           !goe_mavlink_from_tracking(&tracking, &camera, 0u, &sighting);
}

/* For an obstacle without any known value. */
static bool messages_leave() {
    const goe_flight_obstacle_t obstacle = goe_flight_obstacle_t();
    const goe_flight_assessment_t assessment = goe_flight_assessment_t();
    const goe_flight_counters_t counters = goe_flight_counters_t();
    const goe_mavlink_own_t own = goe_mavlink_own_t();
    const uint16_t sector_cm[GOE_FLIGHT_SECTORS] = {0};
    goe_mavlink_obstacle_t message;
    goe_mavlink_hazard_t hazard;
    goe_mavlink_status_t status;
    goe_mavlink_obstacle_distance_t distance;
    goe_mavlink_obstacle_distance_3d_t distance_3d;
    goe_mavlink_collision_t collision;
    goe_mavlink_target_absolute_t target;
    goe_mavlink_adsb_vehicle_t vehicle;
    goe_mavlink_to_obstacle(&obstacle, 0, &own, &message);
    goe_mavlink_to_status(&counters, &assessment, 0u, &own, &status);
    return !goe_mavlink_to_hazard(&obstacle, 0, &assessment, &own, &hazard) &&
           goe_mavlink_to_obstacle_distance(sector_cm, 1000u, 5u, &own, &distance) &&
           !goe_mavlink_to_obstacle_distance_3d(&obstacle, 100.0f, &own, &distance_3d) &&
           !goe_mavlink_to_collision(&obstacle, 0, &assessment, 0.1f, &collision) &&
           !goe_mavlink_to_target_absolute(&obstacle, 0, &own, &target) &&
           !goe_mavlink_to_adsb_vehicle(&obstacle, 0, 0u, &own, &vehicle);
}

static bool messages_are_framed() {
    goe_mavlink_sender_t sender = {1u, 191u, 0u};
    const uint8_t payload[1] = {0};
    uint8_t frame[GOE_MAVLINK_FRAME_MAX];
    const goe_mavlink_message_t status = goe_mavlink_of_id(42703u);
    return goe_mavlink_info(status) != nullptr &&
           goe_mavlink_frame(&sender, status, payload, sizeof payload, frame) == 13u;
}

int main() {
    goe_settings_t settings;
    goe_settings_default(&settings);
    settings.camera.fx_px = settings.camera.fy_px = 800.0f;
    settings.camera.cx_px = settings.camera.cy_px = 640.0f;
    settings.camera.width_px = settings.camera.height_px = 1280.0f;

    goe_estimator_t estimator;
    const char *bad_field = nullptr;
    if (goe_init(&estimator, sizeof estimator, &settings, &bad_field) != GOE_OK) {
        return 1;
    }
    goe_image_t image = goe_image_t();
    image.pose.time_us = GOE_TIME_UNKNOWN;
    image.pose.attitude[0] = 1.0f;
    goe_estimate_t estimate;
    const bool refused = goe_update(&estimator, &image, &estimate) == GOE_BAD_TIME;
    const bool empty = (estimate.valid & (GOE_HAS_POSITION | GOE_HAS_LENGTH | GOE_HAS_HEIGHT | GOE_HAS_ORIENTATION |
                                          GOE_HAS_CENTER)) == 0u;
    const bool reset = goe_reset(&estimator) == GOE_OK;
    const bool named = goe_status_text(GOE_OK)[0] == 'o';
    settings.camera.width_px = settings.camera.height_px = 640.0f;
    const bool flies = flight_layer_answers(settings);
    const bool reports = features_arrive() && standard_messages_arrive() && messages_leave() && messages_are_framed();
    return refused && empty && reset && named && flies && reports && goe_self_check() <= 0x3Fu ? 0 : 1;
}
