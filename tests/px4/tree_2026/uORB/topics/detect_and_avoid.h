/* The used fields of PX4's topic: see standin.hpp. SPDX-License-Identifier: MIT */
#pragma once

#include "standin.hpp"

struct detect_and_avoid_s {
    static constexpr uint8_t DAA_CONFLICT_LVL_NONE = 0, DAA_CONFLICT_LVL_LOW = 1, DAA_CONFLICT_LVL_HIGH = 3,
                             DAA_CONFLICT_LVL_CRITICAL = 4, UNIQUE_ID_ENCODING_UAS_ID = 2;
    uint64_t timestamp, unique_id;
    float aircraft_dist, aircraft_dist_hor, aircraft_dist_vert, expected_min_dist_time;
    uint8_t unique_id_encoding, conflict_level;
};

STANDIN_TOPIC(detect_and_avoid, 16)
