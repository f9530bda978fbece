/*
 * AP_GOE - obstacles from a camera's detections, for ArduPilot
 *
 * Takes GOE_FEATURES from a camera over MAVLink and the pose from AP_AHRS, runs goe_flight, and puts what it finds into the
 * object avoidance database, the log and the telemetry. README.md beside this folder tells how it gets into a tree.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 *
 * Everything runs in the main thread: update() from the scheduler, the messages from the links' reception. Frames as
 * goe_flight.h: NED relative to the EKF's origin, m; times of AP_HAL::micros().
 */
#pragma once

#include "AP_GOE_config.h"

#if AP_GOE_ENABLED

#include <AP_Common/AP_Common.h>
#include <AP_Math/AP_Math.h>
#include <AP_Param/AP_Param.h>
#include <GCS_MAVLink/GCS_MAVLink.h>

#include "flight/goe_flight.h"
#include "mavlink/goe_mavlink.h"
#include "mavlink/goe_mavlink_map.h"

class AP_GOE
{
  public:
    AP_GOE();
    CLASS_NO_COPY(AP_GOE);

    static AP_GOE *get_singleton() { return _singleton; }

    // 50 Hz. The first call takes the memory: some 16 kB, if GOE_ENABLE is set
    void update();

    // a message that the link's parser knows: whole, and its signature checked
    void handle_message(const mavlink_message_t &msg);

    // a message whose id the link's parser does not know: checked here, and refused on a link that wants signatures
    void handle_unknown(const mavlink_message_t &msg, mavlink_channel_t chan);

    bool enabled() const { return _enable > 0; }

    // alive: images come, and the pose. Whether an obstacle is there has nothing to do with it
    bool healthy() const;

    // for the arming checks: false with a reason if arming must wait. What OPTIONS does not ask for is not looked at
    bool pre_arm_check(char *failure_msg, uint8_t failure_msg_len) const;

    // null while not started
    const goe_flight_t *flight() const;
    const goe_flight_assessment_t *assessment() const;

    static const struct AP_Param::GroupInfo var_info[];

  private:
    enum class Option : uint16_t {
        ARM_NEEDS_IMAGES = 1U << 0,
    };

    struct Waiting { // message that waits for its pose
        goe_mavlink_features_t features;
        uint32_t arrival_us;
    };

    static const uint8_t WAITING_MAX = 16;

    struct Settings {
        goe_settings_t estimator;
        goe_flight_settings_t layer;
    };

    struct State { // what is only there if enabled
        goe_flight_t flight;
        Settings tried, good; // the latest that it was to be started with, and the latest that it could be
        goe_flight_assessment_t assessment;
        Waiting waiting[WAITING_MAX];
        uint8_t waiting_count;
    };

    // AP_GOE_Params.cpp
    void read_params(goe_settings_t &estimator, goe_flight_settings_t &layer) const;
    bool has_option(Option option) const { return (_options.get() & uint16_t(option)) != 0; }

    // AP_GOE.cpp
    bool start();
    void follow_params();
    bool init_flight(const Settings &settings, const char **bad_field);
    bool follows_something() const;
    void assess();
    void tell_changes();
    void once_a_second();

    // AP_GOE_Input.cpp
    void read_pose();
    void read_attitude(goe_flight_attitude_t &sample);
    bool read_position(goe_flight_position_t &sample);
    void read_heights(goe_flight_position_t &sample, const float q[4]) const;
    void queue_features(const mavlink_message_t &msg);
    void take_images();
    bool take_image(const Waiting &waiting);

    // AP_GOE_Output.cpp
    void put_obstacles();
    void push_to_database(int slot, const goe_flight_obstacle_t &obstacle);
    void send_obstacles();
    void send_status();
    void send_payload(goe_mavlink_message_t message, const uint8_t *payload, size_t length) const;
    goe_mavlink_own_t own() const;

    // AP_GOE_Logging.cpp
    void log_obstacle(int slot, const goe_flight_obstacle_t &obstacle) const;
    void log_hazard(int slot, const goe_flight_obstacle_t &obstacle) const;
    void log_status(const goe_mavlink_status_t &status) const;

    static AP_GOE *_singleton;

    State *_state;
    bool _tried;                // start() was called
    bool _has_tried, _has_good; // of State
    const char *_bad_field;     // of the parameters as they are; null: none is bad
    unsigned _self_check;

    // pose
    Vector3f _position_ned_m; // of the newest sample
    float _origin_alt_m;
    bool _origin_known;
    uint32_t _breaks; // changes of the filter behind the pose, each an unknown reset
    int16_t _filter;  // which EKF, which of its cores

    // since the latest GOE_STATUS
    uint32_t _delay_sum_us, _delay_max_us;
    uint16_t _images;

    // what was told last
    uint32_t _assessed_ms, _second_ms, _reported_ms;
    goe_flight_action_t _told_action;
    bool _told_alive, _told_waiting;
    uint16_t _told_lost;
    bool _push_is_odd;

    AP_Int8 _enable;
    AP_Int16 _width, _height;
    AP_Float _fx, _fy, _cx, _cy;
    AP_Float _k1, _k2, _p1, _p2, _k3;
    AP_Float _yaw, _pitch, _roll;
    AP_Float _pos_x, _pos_y, _pos_z;
    AP_Float _delay, _delay_sd, _delay_max;
    AP_Float _score_min;
    AP_Int8 _confirm;
    AP_Float _alive, _forget;
    AP_Float _rng_sd, _rng_max, _ter_sd, _home_sd;
    AP_Float _margin, _clear, _viol_max;
    AP_Float _bank, _roll_in, _climb, _climb_in, _loiter, _reserve;
    AP_Float _att_bias, _att_white, _att_drift, _vel_bias, _gnd_sd;
    AP_Float _box_px, _box_share, _box_time;
    AP_Float _oa_sigma;
    AP_Float _report_hz;
    AP_Int16 _options;
};

namespace AP
{
AP_GOE *goe();
}

#endif // AP_GOE_ENABLED
