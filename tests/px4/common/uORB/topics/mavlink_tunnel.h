/* The used fields of PX4's topic: see standin.hpp. SPDX-License-Identifier: MIT */
#pragma once

#include "standin.hpp"

struct mavlink_tunnel_s {
    uint64_t timestamp;
    uint16_t payload_type;
    uint8_t target_system, target_component, payload_length, payload[128];
};

STANDIN_TOPIC(mavlink_tunnel, 1)
