/*
 * AP_GOE - obstacles from a camera's detections, for ArduPilot
 *
 * Takes GOE_FEATURES from a camera over MAVLink and the pose from AP_AHRS, runs goe_flight, and puts the obstacles into the
 * object avoidance database, the log and the telemetry. README.md next to this folder describes the integration into a tree.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 *
 * Three threads. The main one reads the pose, receives messages, and reports: update() from the scheduler, the messages from the
 * links' reception. A separate thread runs the flight layer. The avoidance planner's thread takes the obstacles over into its
 * database. A semaphore each protects their shared data, held for no longer than a copy takes. Frames as goe_flight.h: NED
 * relative to the EKF's origin, m; times of AP_HAL::micros().
 */
#pragma once

#include "AP_GOE_config.h"

#if AP_GOE_ENABLED

#include <AP_Common/AP_Common.h>
#include <AP_HAL/AP_HAL.h>
#include <AP_Math/AP_Math.h>
#include <AP_Param/AP_Param.h>
#include <GCS_MAVLink/GCS_MAVLink.h>

#include "flight/goe_flight.h"
#include "mavlink/goe_mavlink.h"
#include "mavlink/goe_mavlink_map.h"

class AP_OADatabase;

class AP_GOE
{
  public:
    AP_GOE();
    CLASS_NO_COPY(AP_GOE);

    static AP_GOE *get_singleton() { return _singleton; }

    // 50 Hz. The first call takes the memory, some 20 kB, and starts the thread, if GOE_ENABLE is set
    void update();

    // by the database's own thread, between its queue and what it forgets
    void refresh_database(AP_OADatabase &database);

    // a message that the link's parser knows: whole, and its signature checked
    void handle_message(const mavlink_message_t &msg);

    // a message whose id the link's parser does not know: checked here, and refused on a link that wants signatures
    void handle_unknown(const mavlink_message_t &msg, mavlink_channel_t chan);

    bool enabled() const { return _enable > 0; }

    // alive: images come, and the pose. Whether an obstacle is there has nothing to do with it
    bool healthy() const;

    // for the arming checks: false with a reason if arming must wait. What OPTIONS does not ask for is not looked at
    bool pre_arm_check(char *failure_msg, uint8_t failure_msg_len) const;

    static const struct AP_Param::GroupInfo var_info[];

  private:
    enum class Option : uint16_t {
        ARM_NEEDS_IMAGES = 1U << 0,
    };

    struct Waiting { // message that waits for its pose
        goe_mavlink_features_t features;
        uint32_t arrival_us;
    };

    struct Pose {
        goe_flight_attitude_t attitude;
        goe_flight_position_t position;
    };

    struct Settings {
        goe_settings_t estimator;
        goe_flight_settings_t layer;
    };

    struct Foreign {           // parameter of the vehicle
        const AP_Param *param; // null: it has none of that name
        enum ap_var_type type;
        float scale;

        bool find(const char *name, float its_scale);
        float get() const { return param != nullptr ? param->cast_to_float(type) * scale : 0.0f; }
    };

    static const uint8_t WAITING_MAX = 16;
    static const uint8_t POSES_MAX = 16; // 0.32 s: the thread may be that late without a loss

    struct Inbox { // from the main thread; _inbox_sem
        Pose pose[POSES_MAX];
        Waiting image[WAITING_MAX];
        Settings settings;
        uint8_t poses, images;
        bool has_settings; // new ones
        bool landing;
    };

    struct Track {       // of a slot, at the latest assessment that did not fail
        bool used;       // the slot is
        uint32_t id;     // the detector's
        uint32_t number; // of the slot's tracks so far
    };

    struct Found { // by the thread; _found_sem
        goe_flight_obstacle_t obstacle[GOE_FLIGHT_SLOTS];
        goe_flight_status_t state[GOE_FLIGHT_SLOTS]; // of each slot
        goe_flight_assessment_t assessment; // the latest one that did not fail; pose_alive is false since one did
        Track track[GOE_FLIGHT_SLOTS];
        goe_flight_counters_t counters;
        const char *bad_field;         // of the settings that were given last; null: none is bad
        uint32_t assessed;             // assessments
        float own_ned_m[3];            // of the newest pose
        uint32_t delay_sum_us, images; // since the start
        uint32_t delay_max_us;         // of the last whole second
        uint16_t taken_settings, refused_settings, corruptions;
    };

    struct State { // allocated only if enabled
        Inbox inbox;
        Found found;    // what the threads share
        Found shown;    // the main thread's copy
        Settings given; // the latest that the thread was given; the main thread's
        // the thread's own
        goe_flight_t flight;
        Settings tried, good; // the latest that it was to be started with, and the latest that it could be
        Found next;
        Waiting waiting[WAITING_MAX];
        uint8_t waiting_count;
        bool has_good;
        uint16_t evicted; // counted at the latest assessment that did not fail
        uint32_t assessed_ms, delay_max_us;
    };

    // AP_GOE_Params.cpp
    void read_params(goe_settings_t &estimator, goe_flight_settings_t &layer) const;
    void find_vehicle();
    void read_vehicle(goe_flight_settings_t &layer) const;
    bool has_option(Option option) const { return (_options.get() & uint16_t(option)) != 0; }
    static const char *parameter_of(const char *field);

    // AP_GOE.cpp: main thread
    bool start();
    void follow_params();
    bool follows_something() const;
    void take_found();
    void report();
    void report_changes();
    void report_settings();
    void report_loiter(float used_m);
    void once_a_second();

    // AP_GOE_Thread.cpp
    void thread_main();
    void work();
    bool next_pose(Pose &pose);
    void take_poses();
    void take_settings();
    bool init_flight(const Settings &settings, const char **bad_field);
    void fetch_images();
    void take_images();
    bool take_image(const Waiting &waiting);
    void assess();
    void number_tracks();
    void publish();

    // AP_GOE_Input.cpp: main thread
    void read_pose();
    void read_attitude(goe_flight_attitude_t &sample);
    bool read_position(goe_flight_position_t &sample);
    void read_heights(goe_flight_position_t &sample, const float q[4]) const;
    void queue_pose(const Pose &pose);
    void queue_features(const mavlink_message_t &msg);

    // AP_GOE_Output.cpp: main thread, but for the database
    bool has_position(const Found &found, int slot) const;
    void log_obstacles() const;
    void put_into_database(AP_OADatabase &database, int slot, const goe_flight_obstacle_t &obstacle, bool resend);
    void send_obstacles();
    void send_status();
    void send_payload(goe_mavlink_message_t message, const uint8_t *payload, size_t length) const;
    goe_mavlink_own_t own() const;

    // AP_GOE_Logging.cpp
    void log_obstacle(int slot, const goe_flight_obstacle_t &obstacle) const;
    void log_hazard(int slot, const goe_flight_obstacle_t &obstacle) const;
    void log_assessment() const;
    void log_status(const goe_mavlink_status_t &status) const;

    static AP_GOE *_singleton;

    State *_state;
    HAL_Semaphore _inbox_sem, _found_sem;
    HAL_BinarySemaphore _wake; // the thread has something to do
    bool _tried;               // start() was called
    Foreign _roll_limit_deg, _climb_max_m_s, _loiter_m, _cruise_m_s;
    unsigned _self_check;

    // pose
    Vector3f _position_ned_m; // of the newest sample
    float _origin_alt_m;
    bool _origin_known;
    uint32_t _breaks; // changes of the filter behind the pose, each an unknown reset
    int16_t _filter;  // which EKF, which of its cores

    // at the latest GOE_STATUS
    uint32_t _status_delay_us, _status_images;

    // the latest reports
    uint32_t _second_ms, _reported_ms, _resent_ms;
    goe_flight_action_t _reported_action;
    bool _reported_alive, _reported_waiting;
    uint16_t _reported_lost, _reported_taken, _reported_refused, _reported_corruptions;
    float _reported_loiter_m;

    AP_Int8 _enable;
    AP_Int16 _width, _height;
    AP_Float _fx, _fy, _cx, _cy;
    AP_Float _k1, _k2, _p1, _p2, _k3;
    AP_Float _yaw, _pitch, _roll;
    AP_Float _pos_x, _pos_y, _pos_z;
    AP_Float _delay;
    AP_Float _home_sd, _gnd_sd;
    AP_Float _margin, _clear;
    AP_Float _oa_sigma;
    AP_Float _report_hz;
    AP_Int16 _options;
};

namespace AP
{
AP_GOE *goe();
}

#endif // AP_GOE_ENABLED
