/* The used fields of PX4's topic: see standin.hpp. SPDX-License-Identifier: MIT */
#pragma once

#include "standin.hpp"

struct home_position_s {
    uint64_t timestamp;
    float z;
    bool valid_alt, valid_lpos;
};

STANDIN_TOPIC(home_position, 1)
