/* The used fields of PX4's topic: see standin.hpp. SPDX-License-Identifier: MIT */
#pragma once

#include "standin.hpp"

struct position_setpoint_s {
    static constexpr uint8_t SETPOINT_TYPE_POSITION = 0, SETPOINT_TYPE_LOITER = 2, SETPOINT_TYPE_LAND = 4;
    bool valid;
    uint8_t type;
    float alt; /* above sea level */
};

struct position_setpoint_triplet_s {
    uint64_t timestamp;
    position_setpoint_s current;
};

STANDIN_TOPIC(position_setpoint_triplet, 1)
