/* Behind the stand-in headers: a scripted vehicle, and a record of AP_GOE's actions. SPDX-License-Identifier: MIT */
#pragma once

#include <AC_Avoidance/AP_OADatabase.h>
#include <AP_AHRS/AP_AHRS.h>
#include <AP_RangeFinder/AP_RangeFinder.h>
#include <GCS_MAVLink/GCS.h>

#include <map>
#include <string>
#include <vector>

struct ScriptedSent {
    mavlink_channel_t channel;
    uint32_t msgid;
    std::vector<uint8_t> payload;
    uint8_t min_length, crc_extra;
};

struct ScriptedRecord { // of the log
    std::vector<std::string> labels;
    std::string units, mults, format;
    std::map<std::string, double> value;
};

struct Scripted {
    // clocks
    uint64_t now_us;
    uint32_t sample_us; // of the inertial sensors

    // pose
    Quaternion q;
    Vector3f position, velocity;
    bool has_position, has_nav, home_set, origin_known;
    float down_of_home;
    Location origin;
    int8_t ekf_type, core;
    uint32_t yaw_reset_ms, horizontal_reset_ms, vertical_reset_ms;
    Vector2f horizontal_change;
    float vertical_change;

    // heights
    bool has_range_finder, has_terrain;
    RangeFinder::Status range_finder;
    float range_m, terrain_m;
    Vector3f range_finder_offset;

    // the rest of the vehicle
    bool armed, landing, has_memory, has_threads, has_database;
    bool thread_is_late;                     // the thread gets no turn
    bool runs_at_once;                       // the thread and the others run in parallel
    std::map<std::string, float> parameters; // of the vehicle
    std::vector<mavlink_status_t> channel;   // links, one each
    std::vector<bool> active, is_private;
    uint16_t txspace;

    // results
    std::vector<std::string> texts;
    std::vector<ScriptedSent> sent;
    std::map<std::string, std::vector<ScriptedRecord>> log;
    unsigned allocations;
    std::string thread_name;
    uint32_t thread_stack;
    unsigned wakes;
    unsigned searches; // searches of parameters by name

    Scripted();
    bool has_said(const char *part) const;
    std::map<uint32_t, AP_OADatabase::OA_DbItem> database() const; // AP_GOE's entries, by id
};

extern Scripted scripted;

/* For parallel threads: sets the thread's clock from here on, and waits until the thread waits. */
void show_clock();
void wait_for_the_thread();
