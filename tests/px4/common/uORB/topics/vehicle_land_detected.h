/* The used fields of PX4's topic: see standin.hpp. SPDX-License-Identifier: MIT */
#pragma once

#include "standin.hpp"

struct vehicle_land_detected_s {
    uint64_t timestamp;
    bool landed;
};

STANDIN_TOPIC(vehicle_land_detected, 1)
