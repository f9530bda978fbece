/* Stand-in, written by this project: only the names that AP_GOE uses, with the lines that the README adds. Names compared with
 * ArduPilot 4.7-dev, commit 90700977c5, on 22 Nov 2026; the private ones with public copies of other commits, on 24 Nov 2026. scripted.cpp
 * implements them. SPDX-License-Identifier: MIT */
#pragma once

#include <AP_Math/AP_Math.h>

#include <cstdint>

#define AP_OADATABASE_ENABLED 1

class AP_OADatabase {
  public:
    enum OA_DbItemImportance : uint8_t { Low, Normal, High };
    struct OA_DbItem {
        enum class Source : uint8_t { proximity, AIS, camera };
        Vector3f pos;
        uint32_t timestamp_ms;
        float radius;
        uint32_t id;
        uint8_t send_to_gcs;
        OA_DbItemImportance importance;
        Source source;
    };
    AP_OADatabase();
    void update();
    uint16_t database_count() const { return _database.count; }
    const OA_DbItem &get_item(uint32_t i) const { return _database.items[i]; }
    void note_sent();             // to the ground station
    void begin(unsigned foreign); // empty except for so many items of other sources
    void set_limits(float radius_min, float dist_max);

  private:
    friend class AP_GOE;
    void database_item_add(const OA_DbItem &item);
    uint8_t get_send_to_gcs_flags(OA_DbItemImportance importance);

    struct {
        OA_DbItem *items;
        uint16_t count, size;
    } _database;
    float _radius_min, _dist_max;
};

namespace AP {
AP_OADatabase *oadatabase();
}
