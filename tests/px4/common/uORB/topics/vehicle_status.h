/* The used fields of PX4's topic: see standin.hpp. SPDX-License-Identifier: MIT */
#pragma once

#include "standin.hpp"

struct vehicle_status_s {
    static constexpr uint8_t ARMING_STATE_DISARMED = 1, ARMING_STATE_ARMED = 2;
    static constexpr uint8_t NAVIGATION_STATE_POSCTL = 2, NAVIGATION_STATE_AUTO_MISSION = 3,
                             NAVIGATION_STATE_AUTO_LOITER = 4, NAVIGATION_STATE_AUTO_RTL = 5,
                             NAVIGATION_STATE_AUTO_LAND = 18;
    static constexpr uint8_t VEHICLE_TYPE_UNSPECIFIED = 0, VEHICLE_TYPE_ROTARY_WING = 1, VEHICLE_TYPE_FIXED_WING = 2;
    uint64_t timestamp;
    uint8_t arming_state, nav_state, vehicle_type, system_id, component_id;
    bool failsafe, failsafe_and_user_took_over;
};

STANDIN_TOPIC(vehicle_status, 1)
