/* The used fields of PX4's topic: see standin.hpp. SPDX-License-Identifier: MIT */
#pragma once

#include "standin.hpp"

struct vehicle_local_position_s {
    uint64_t timestamp, timestamp_sample;
    double ref_lat, ref_lon;
    float x, y, z, delta_xy[2], delta_z, vx, vy, vz, ref_alt, dist_bottom;
    bool xy_valid, z_valid, v_xy_valid, v_z_valid, xy_global, z_global, dist_bottom_valid, dead_reckoning;
    uint8_t xy_reset_counter, z_reset_counter;
};

STANDIN_TOPIC(vehicle_local_position, 1)
