/* The used fields of PX4's topic: see standin.hpp. SPDX-License-Identifier: MIT */
#pragma once

#include "standin.hpp"

struct vehicle_attitude_s {
    uint64_t timestamp, timestamp_sample;
    float q[4];
    uint8_t quat_reset_counter;
};

STANDIN_TOPIC(vehicle_attitude, 1)
