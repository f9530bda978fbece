/* The used fields of PX4's topic: see standin.hpp. SPDX-License-Identifier: MIT */
#pragma once

#include "standin.hpp"

struct distance_sensor_s {
    static constexpr uint8_t ROTATION_FORWARD_FACING = 0, ROTATION_DOWNWARD_FACING = 25;
    uint64_t timestamp;
    float min_distance, max_distance, current_distance;
    int8_t signal_quality;
    uint8_t orientation;
};

STANDIN_TOPIC(distance_sensor, 1)
