/* The flight layer's decision as commands that PX4 follows. SPDX-License-Identifier: MIT */
#pragma once

#include <uORB/topics/vehicle_command.h>
#include <uORB/topics/vehicle_command_ack.h>
#include <uORB/topics/vehicle_status.h>

#include "GoeParameters.hpp"
#include "goe_flight.h"

/* Left, right, climb and hold become DO_REPOSITION with a change of mode to Hold; again when the target moves by 5 m, and until
 * PX4 acknowledges it. Go around becomes DO_GO_AROUND, and when PX4 has taken that, DO_REPOSITION upwards if its height is too low
 * for the obstacle's top. Only while armed, in Mission or Hold, and to break off a landing in Land. A side that may not be flown
 * breaks a landing off like go around. A pilot or a failsafe that chooses another mode has priority: no command follows until the
 * end of the order. So has a failsafe that waits in Hold, which a command would cancel. The mission continues only when the obstacle is
 * known to be passed, and never after a landing that was broken off. */
class GoeOrders {
  public:
    /* Where the aircraft is and how PX4 flies it. */
    struct Vehicle {
        bool armed;
        bool has_wings;      /* a fixed wing, at present */
        bool lands;          /* the present setpoint is one to land */
        bool failsafe;       /* one is active, and no pilot has taken over */
        uint8_t nav_state;   /* vehicle_status_s::NAVIGATION_STATE_... */
        bool obstacle_known; /* the layer still knows the place of that of slot() */
        uint32_t gone;   /* slots, as bits: without a position, or with another obstacle since the assessment before */
        uint32_t behind; /* ... whose obstacle lies behind, on the course before the order */
        bool origin_known, altitude_known;
        float origin_alt_m;   /* over the sea, of the local frame's down = 0 */
        float setpoint_alt_m; /* ... of the present setpoint */
        uint64_t now_us;
    };

    /* After every assessment. True: the command is to be published. */
    bool follow(const goe_flight_assessment_t &assessment, const Vehicle &vehicle, int32_t react, bool resume,
                vehicle_command_s &command);

    /* Acknowledgements of a command of this system. */
    void take(const vehicle_command_ack_s &answer);

    /* What the order is about, or the latest one was; -1: nothing any more, the layer has given it up. */
    int slot() const { return _slot; }

    /* The active order was given to PX4. */
    bool flown() const { return _given; }
    bool overruled() const { return _overruled; }
    uint16_t refused() const { return _refused; }

  private:
    void begin(goe_flight_action_t action);
    bool end(const Vehicle &vehicle, bool resume, vehicle_command_s &command);
    bool is_past(const Vehicle &vehicle) const;
    void watch_obstacles(const Vehicle &vehicle);
    bool repeat_resume(const Vehicle &vehicle, vehicle_command_s &command);
    bool may_resume(const Vehicle &vehicle) const;
    bool go_on(const goe_flight_assessment_t &assessment, const Vehicle &vehicle, int32_t react, bool is_new,
               vehicle_command_s &command);
    void watch_mode(const Vehicle &vehicle);
    bool has_moved(const goe_flight_assessment_t &assessment) const;
    void await(uint32_t command, const Vehicle &vehicle);
    void reposition(const goe_flight_assessment_t &assessment, const Vehicle &vehicle, vehicle_command_s &command);
    void go_around(float altitude_m, const Vehicle &vehicle, vehicle_command_s &command);
    void raise(float altitude_m, const Vehicle &vehicle, vehicle_command_s &command);
    bool go_on_around(const goe_flight_assessment_t &assessment, const Vehicle &vehicle, bool is_new,
                      vehicle_command_s &command);
    bool is_unanswered(const Vehicle &vehicle) const;
    void set_mission(const Vehicle &vehicle, vehicle_command_s &command);

    goe_flight_action_t _action{GOE_FLIGHT_NONE}; /* as it is flown */
    int8_t _slot{-1};
    uint8_t _mode_before{0};
    bool _given{false}, _has_led{false}, _overruled{false}, _wants_mission{false};
    uint32_t _named{0};   /* since the order began: slots that it was about, as bits; without those that were passed */
    bool _gave_up{false}; /* ... the layer, an obstacle of it */
    bool _breaks_off{false}, _raised{false}; /* since the order began: a landing; the altitude where PX4 holds */
    uint8_t _resumes_left{0};
    uint32_t _awaited{0}; /* command whose acknowledgement is awaited; 0: none */
    uint64_t _sent_us{0};
    float _target_ned_m[3]{};
    uint16_t _refused{0};
};
