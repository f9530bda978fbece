/* The used fields of PX4's topic: see standin.hpp. SPDX-License-Identifier: MIT */
#pragma once

#include "standin.hpp"

struct irlock_report_s {
    uint64_t timestamp;
    float pos_x, pos_y, size_x, size_y;
    uint16_t signature;
};

STANDIN_TOPIC(irlock_report, 1)
