/* The used fields of PX4's topic: see standin.hpp. SPDX-License-Identifier: MIT */
#pragma once

#include "standin.hpp"

struct obstacle_distance_s {
    static constexpr uint8_t MAV_FRAME_GLOBAL = 0, MAV_DISTANCE_SENSOR_LASER = 0;
    uint64_t timestamp;
    float increment, angle_offset;
    uint16_t distances[72], min_distance, max_distance;
    uint8_t frame, sensor_type;
};

STANDIN_TOPIC(obstacle_distance, 1)
