/* The used fields of PX4's topic: see standin.hpp. SPDX-License-Identifier: MIT */
#pragma once

#include "standin.hpp"

struct vehicle_command_ack_s {
    static constexpr uint8_t VEHICLE_CMD_RESULT_ACCEPTED = 0, VEHICLE_CMD_RESULT_DENIED = 2,
                             VEHICLE_CMD_RESULT_IN_PROGRESS = 5;
    uint64_t timestamp;
    uint32_t command;
    uint8_t result, target_system;
    uint16_t target_component;
};

STANDIN_TOPIC(vehicle_command_ack, 4)
