/* Stand-in, written by this project: only the names that AP_GOE uses. Names and signatures compared with ArduPilot 4.7-dev,
 * commit 90700977c5, on 22 Nov 2026. scripted.cpp implements them. SPDX-License-Identifier: MIT */
#pragma once

#include <AP_Math/AP_Math.h>

#define AP_RANGEFINDER_ENABLED 1

class RangeFinder {
  public:
    enum class Status : unsigned char { NotConnected, NoData, OutOfRangeLow, OutOfRangeHigh, Good };
    Status status_orient(enum Rotation orientation) const;
    float distance_orient(enum Rotation orientation) const;
    const Vector3f &get_pos_offset_orient(enum Rotation orientation) const;
};

namespace AP {
RangeFinder *rangefinder();
}
