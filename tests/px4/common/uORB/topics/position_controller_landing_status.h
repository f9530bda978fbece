/* The used fields of PX4's topic: see standin.hpp. SPDX-License-Identifier: MIT */
#pragma once

#include "standin.hpp"

struct position_controller_landing_status_s {
    uint64_t timestamp;
    bool flaring;
};

STANDIN_TOPIC(position_controller_landing_status, 1)
