/* Parameters: one table instead of an object for each. SPDX-License-Identifier: MIT */
#include "GoeParameters.hpp"

#include <px4_platform_common/param.h>
#include <stddef.h>
#include <string.h>

namespace {

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
    GOE_AT(GOE_ATT_BIAS, estimator.navigation.attitude_bias_deg),
    GOE_AT(GOE_ATT_DRIFT, estimator.navigation.attitude_drift_deg),
    GOE_AT(GOE_ATT_WHITE, estimator.navigation.attitude_white_deg),
    GOE_AT(GOE_GROUND_SD, estimator.navigation.ground_m),
    GOE_AT(GOE_BOX_PX, estimator.detector.box_px),
    GOE_AT(GOE_BOX_SHARE, estimator.detector.box_share),
    GOE_AT(GOE_TYP_SIZE, estimator.refined.typical_size_m),
    GOE_AT(GOE_SCORE_MIN, flight.score_min),
    GOE_AT(GOE_CONFIRM, flight.confirm_images),
    GOE_AT(GOE_ALIVE, flight.alive_s),
    GOE_AT(GOE_FORGET, flight.forget_s),
    GOE_AT(GOE_DELAY, flight.delay_s),
    GOE_AT(GOE_DELAY_SD, flight.delay_sd_s),
    GOE_AT(GOE_DELAY_MAX, flight.delay_max_s),
    GOE_AT(GOE_RNG_SD, flight.range_finder_sd_m),
    GOE_AT(GOE_RNG_MAX, flight.range_finder_max_m),
    GOE_AT(GOE_TERR_SD, flight.terrain_sd_m),
    GOE_AT(GOE_HOME_SD, flight.home_sd_m),
    GOE_AT(GOE_MARGIN, flight.margin_m),
    GOE_AT(GOE_CLEAR, flight.clearance_m),
    GOE_AT(GOE_VIOL_MAX, flight.violation_max),
    GOE_AT(GOE_DOUBT, flight.doubt),
    GOE_AT(GOE_DRIFT, flight.drift_m_s),
    GOE_AT(GOE_BANK, flight.bank_deg),
    GOE_AT(GOE_ROLL_IN, flight.roll_in_s),
    GOE_AT(GOE_CLIMB, flight.climb_m_s),
    GOE_AT(GOE_CLIMB_IN, flight.climb_in_s),
    GOE_AT(GOE_LOITER, flight.loiter_m),
    GOE_AT(GOE_RESERVE, flight.reserve_s),
    GOE_AT(GOE_CONFIRM_T, flight.confirm_s),
    GOE_AT(GOE_HOLD, flight.hold_s),
    GOE_AT(GOE_DIST_MAX, distance_max_m),
    GOE_AT(GOE_LT_DELAY, target_delay_s),
    GOE_AT(GOE_LT_DEL_SD, target_delay_sd_s),
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

} // namespace

void goe_parameters_read(GoeParameters &parameters) {
    memset(&parameters, 0, sizeof parameters);
    goe_settings_default(&parameters.estimator);
    goe_flight_settings_default(&parameters.flight);
    for (const Entry &entry : numbers) {
        read<float>(entry, parameters);
    }
    for (const Entry &entry : choices) {
        read<int32_t>(entry, parameters);
    }
}

bool goe_parameters_differ(const GoeParameters &a, const GoeParameters &b) {
    return memcmp(&a.estimator, &b.estimator, sizeof a.estimator) != 0 ||
           memcmp(&a.flight, &b.flight, sizeof a.flight) != 0;
}
