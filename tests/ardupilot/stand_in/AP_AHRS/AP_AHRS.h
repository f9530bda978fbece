/* Stand-in, written by this project: only the names that AP_GOE uses. Names and signatures compared with ArduPilot 4.7-dev,
 * commit 90700977c5, on 22 Nov 2026. scripted.cpp implements them. SPDX-License-Identifier: MIT */
#pragma once

#include <AP_Common/AP_Common.h>
#include <AP_Math/AP_Math.h>

class AP_AHRS {
  public:
    enum class EKFType : uint8_t { TWO = 2, THREE = 3 };
    void get_quat_body_to_ned(Quaternion &q) const;
    bool have_inertial_nav() const;
    bool get_relative_position_NED_origin_float(Vector3f &position) const;
    bool get_velocity_NED(Vector3f &velocity) const;
    void get_relative_position_D_home(float &down) const;
    bool home_is_set() const;
    bool get_origin(Location &origin) const;
    EKFType configured_ekf_type() const;
    int8_t get_primary_core_index() const;
    uint32_t getLastYawResetAngle(float &change);
    uint32_t getLastPosNorthEastReset(Vector2f &change);
    uint32_t getLastPosDownReset(float &change);
};

namespace AP {
AP_AHRS &ahrs();
}
