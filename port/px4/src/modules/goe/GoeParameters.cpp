/* Parameters: one table instead of an object for each. SPDX-License-Identifier: MIT */
#include "GoeParameters.hpp"

#include <math.h>
#include <px4_platform_common/param.h>
#include <stddef.h>
#include <string.h>

namespace {

/* Of PX4's filter, one sigma: measured in simulated flight of a fixed wing, mounting included. Not those of a better one, which are the
 * library's defaults. */
constexpr float ATTITUDE_BIAS_DEG = 1.f;
constexpr float ATTITUDE_DRIFT_DEG = 0.5f; /* per square root of a second */
constexpr float ATTITUDE_WHITE_DEG = 0.3f;

constexpr float GRAVITY_M_S2 = 9.80665f;
constexpr float RAD_PER_DEG = 0.01745329252f;

/* A parameter and where its value goes. */
struct Entry {
    px4::params parameter;
    uint16_t offset;
};

#define GOE_AT(name, field) {px4::params::name, static_cast<uint16_t>(offsetof(GoeParameters, field))}

const Entry numbers[] = {
    GOE_AT(GOE_CAM_W, estimator.camera.width_px),
    GOE_AT(GOE_CAM_H, estimator.camera.height_px),
    GOE_AT(GOE_CAM_FX, estimator.camera.fx_px),
    GOE_AT(GOE_CAM_FY, estimator.camera.fy_px),
    GOE_AT(GOE_CAM_CX, estimator.camera.cx_px),
    GOE_AT(GOE_CAM_CY, estimator.camera.cy_px),
    GOE_AT(GOE_CAM_K1, estimator.camera.k1),
    GOE_AT(GOE_CAM_K2, estimator.camera.k2),
    GOE_AT(GOE_CAM_K3, estimator.camera.k3),
    GOE_AT(GOE_CAM_P1, estimator.camera.p1),
    GOE_AT(GOE_CAM_P2, estimator.camera.p2),
    GOE_AT(GOE_CAM_YAW, estimator.camera.mount_yaw_deg),
    GOE_AT(GOE_CAM_PITCH, estimator.camera.mount_pitch_deg),
    GOE_AT(GOE_CAM_ROLL, estimator.camera.mount_roll_deg),
    GOE_AT(GOE_CAM_X, estimator.camera.offset_m[0]),
    GOE_AT(GOE_CAM_Y, estimator.camera.offset_m[1]),
    GOE_AT(GOE_CAM_Z, estimator.camera.offset_m[2]),
    GOE_AT(GOE_GROUND_SD, estimator.navigation.terrain_height_sd_m),
    GOE_AT(GOE_DELAY, flight.delay_s),
    GOE_AT(GOE_HOME_SD, flight.home_sd_m),
    GOE_AT(GOE_MARGIN, flight.margin_m),
    GOE_AT(GOE_CLEAR, flight.clearance_m),
    GOE_AT(GOE_LT_DELAY, target_delay_s),
};

const Entry choices[] = {
    GOE_AT(GOE_IN, inputs),
    GOE_AT(GOE_OUT, outputs),
    GOE_AT(GOE_REACT, react),
    GOE_AT(GOE_RESUME, resume),
};

#undef GOE_AT

/* Of a parameter that PX4 does not have, which cannot be, the default stays. */
template <typename T> void read(const Entry &entry, GoeParameters &parameters) {
    const param_t handle = param_handle(entry.parameter);
    T value;
    param_set_used(handle);
    if (param_get(handle, &value) == 0) {
        memcpy(reinterpret_cast<char *>(&parameters) + entry.offset, &value, sizeof value);
    }
}

/* A parameter of another module. False: this PX4 has none of that name, or it is not positive. */
bool find_positive(const char *name, float &value) {
    const param_t handle = param_find(name);
    float found = 0.f;
    if (handle == PARAM_INVALID || param_get(handle, &found) != 0 || !(found > 0.f)) {
        return false;
    }
    value = found;
    return true;
}

float turn_m(float speed_m_s, float bank_deg) {
    return speed_m_s * speed_m_s / (GRAVITY_M_S2 * tanf(RAD_PER_DEG * bank_deg));
}

/* What a fixed wing flies. A loiter circle narrower than its turn at cruise speed is not flown: the layer gets the turn's. */
void read_wings(GoeParameters &parameters) {
    goe_flight_settings_t &flight = parameters.flight;
    float value = 0.f;
    if (find_positive("FW_R_LIM", value)) {
        flight.bank_deg = fminf(flight.bank_deg, value);
    }
    if (find_positive("FW_T_CLMB_MAX", value)) {
        flight.climb_m_s = fminf(flight.climb_m_s, value);
    }
    if (!find_positive("NAV_LOITER_RAD", flight.loiter_m) || !find_positive("FW_AIRSPD_TRIM", value)) {
        return;
    }
    const float least_m = turn_m(value, flight.bank_deg);
    if (flight.loiter_m < least_m) {
        parameters.narrow_loiter_m = flight.loiter_m;
        flight.loiter_m = least_m;
    }
}

float or_else(float value, float otherwise) { return fabsf(value) <= 0.f ? otherwise : value; }

/* What stays 0 is as in most cameras: square pixels, the axis in the middle. */
void complete_camera(goe_camera_t &camera) {
    camera.fy_px = or_else(camera.fy_px, camera.fx_px);
    camera.cx_px = or_else(camera.cx_px, 0.5f * camera.width_px);
    camera.cy_px = or_else(camera.cy_px, 0.5f * camera.height_px);
}

} // namespace

void goe_parameters_read(GoeParameters &parameters, bool has_wings) {
    memset(&parameters, 0, sizeof parameters);
    goe_settings_default(&parameters.estimator);
    goe_flight_settings_default(&parameters.flight);
    parameters.estimator.navigation.attitude_bias_sd_deg = ATTITUDE_BIAS_DEG;
    parameters.estimator.navigation.attitude_walk_sd_deg = ATTITUDE_DRIFT_DEG;
    parameters.estimator.navigation.attitude_white_sd_deg = ATTITUDE_WHITE_DEG;
    for (const Entry &entry : numbers) {
        read<float>(entry, parameters);
    }
    for (const Entry &entry : choices) {
        read<int32_t>(entry, parameters);
    }
    complete_camera(parameters.estimator.camera);
    if (has_wings) {
        read_wings(parameters);
    }
}

bool goe_parameters_differ(const GoeParameters &a, const GoeParameters &b) {
    return memcmp(&a.estimator, &b.estimator, sizeof a.estimator) != 0 ||
           memcmp(&a.flight, &b.flight, sizeof a.flight) != 0;
}
