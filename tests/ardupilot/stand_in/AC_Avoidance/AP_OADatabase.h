/* Stand-in, written by this project: only the names that AP_GOE uses. Names and signatures compared with ArduPilot 4.7-dev,
 * commit 90700977c5, on 22 Nov 2026. What happens behind them is in scripted.h. SPDX-License-Identifier: MIT */
#pragma once

#include <AP_Math/AP_Math.h>

#include <cstdint>

#define AP_OADATABASE_ENABLED 1

class AP_OADatabase {
  public:
    struct OA_DbItem {
        enum class Source : uint8_t { proximity, AIS };
    };
    bool healthy() const;
    void queue_push(const Vector3f &pos, uint32_t timestamp_ms, float distance, float radius, OA_DbItem::Source source,
                    uint32_t id = 0);
};

namespace AP {
AP_OADatabase *oadatabase();
}
