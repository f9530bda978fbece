/* The used fields of PX4's topic: see standin.hpp. SPDX-License-Identifier: MIT */
#pragma once

#include "standin.hpp"

struct vehicle_command_s {
    static constexpr uint32_t VEHICLE_CMD_DO_SET_MODE = 176, VEHICLE_CMD_DO_GO_AROUND = 191,
                              VEHICLE_CMD_DO_REPOSITION = 192;
    uint64_t timestamp;
    double param5, param6;
    float param1, param2, param3, param4, param7;
    uint32_t command;
    uint8_t target_system, target_component, source_system;
    uint16_t source_component;
    bool from_external;
};

STANDIN_TOPIC(vehicle_command, 8)
