// The public headers in a C++ translation unit, with a call of every function.
#include "goe_flight.h"

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

int main() {
    goe_settings_t settings;
    goe_settings_default(&settings);
    settings.camera.fx_px = settings.camera.fy_px = 800.0f;

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
    return refused && empty && reset && named && flies && goe_self_check() <= 0x3Fu ? 0 : 1;
}
