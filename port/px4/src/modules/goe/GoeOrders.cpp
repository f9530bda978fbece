/* The flight layer's decision as commands that PX4 follows. SPDX-License-Identifier: MIT */
#include "GoeOrders.hpp"

#include <math.h>
#include <string.h>

namespace {

constexpr uint64_t REPEAT_US = 500000; /* without an acknowledgement */
constexpr uint8_t RESUMES_MAX = 5;     /* requests for the mission, until acknowledged */
constexpr float TOO_LOW_M = 1.f;       /* by which PX4 may hold lower than the go-around requires */
constexpr float TARGET_MOVED_M = 5.f;  /* from which on the target is sent again */
constexpr float CHANGE_MODE = 1.f;     /* DO_REPOSITION, param2: into Hold */
constexpr float DEFAULT_SPEED = -1.f;  /* ... param1 */
constexpr float CUSTOM_MODE = 1.f;     /* DO_SET_MODE, param1 */
constexpr float MAIN_AUTO = 4.f;       /* ... param2 */
constexpr float SUB_MISSION = 4.f;     /* ... param3 */
constexpr double DEG_PER_E7 = 1.0e-7;

bool is_place(goe_flight_action_t action) {
    return action == GOE_FLIGHT_LEFT || action == GOE_FLIGHT_RIGHT || action == GOE_FLIGHT_CLIMB ||
           action == GOE_FLIGHT_HOLD;
}

bool in_mission_or_hold(const GoeOrders::Vehicle &vehicle) {
    return vehicle.nav_state == vehicle_status_s::NAVIGATION_STATE_AUTO_MISSION ||
           vehicle.nav_state == vehicle_status_s::NAVIGATION_STATE_AUTO_LOITER;
}

/* PX4 waits in Hold before it flies a failsafe (COM_FAIL_ACT_T), and a command may cancel that. In Mission a failsafe is only a
 * warning: PX4 1.14 reports that, too. */
bool in_failsafe(const GoeOrders::Vehicle &vehicle) {
    return vehicle.failsafe && vehicle.nav_state != vehicle_status_s::NAVIGATION_STATE_AUTO_MISSION;
}

bool may_command(goe_flight_action_t action, const GoeOrders::Vehicle &vehicle, int32_t react) {
    const bool in_land = vehicle.nav_state == vehicle_status_s::NAVIGATION_STATE_AUTO_LAND;
    if (!vehicle.armed || in_failsafe(vehicle)) {
        return false;
    }
    if (action == GOE_FLIGHT_GO_AROUND) {
        return (react & GOE_REACT_GO_AROUND) != 0 && (in_mission_or_hold(vehicle) || in_land);
    }
    return is_place(action) && (react & GOE_REACT_REPOSITION) != 0 && vehicle.origin_known &&
           (in_mission_or_hold(vehicle) || (in_land && vehicle.lands));
}

/* While the aircraft lands, a side that may not be flown becomes a go-around: the landing leads into the obstacle. */
goe_flight_action_t flown_action(goe_flight_action_t action, const GoeOrders::Vehicle &vehicle, int32_t react) {
    const bool is_up = vehicle.lands && is_place(action) && !may_command(action, vehicle, react) &&
                       may_command(GOE_FLIGHT_GO_AROUND, vehicle, react);
    return is_up ? GOE_FLIGHT_GO_AROUND : action;
}

void start(vehicle_command_s &command, uint32_t number, const GoeOrders::Vehicle &vehicle) {
    memset(&command, 0, sizeof command);
    command.timestamp = vehicle.now_us;
    command.command = number;
}

} // namespace

/* The first command of an order is given in the mode to go back to. */
void GoeOrders::await(uint32_t command, const Vehicle &vehicle) {
    if (!_given) {
        _mode_before = vehicle.nav_state;
    }
    _awaited = command;
    _sent_us = vehicle.now_us;
    _given = true;
    _breaks_off = _breaks_off || vehicle.lands;
}

void GoeOrders::reposition(const goe_flight_assessment_t &assessment, const Vehicle &vehicle,
                           vehicle_command_s &command) {
    start(command, vehicle_command_s::VEHICLE_CMD_DO_REPOSITION, vehicle);
    command.param1 = DEFAULT_SPEED;
    command.param2 = CHANGE_MODE;
    command.param4 = NAN;
    command.param5 = DEG_PER_E7 * static_cast<double>(assessment.target_lat_e7);
    command.param6 = DEG_PER_E7 * static_cast<double>(assessment.target_lon_e7);
    /* without an altitude PX4 keeps its own, which is no climb */
    command.param7 = vehicle.altitude_known ? vehicle.origin_alt_m - assessment.target_ned_m[2] : NAN;
    memcpy(_target_ned_m, assessment.target_ned_m, sizeof _target_ned_m);
    await(command.command, vehicle);
}

/* PX4 does not read the altitude: it holds MIS_LND_ABRT_ALT over the landing. */
void GoeOrders::go_around(float altitude_m, const Vehicle &vehicle, vehicle_command_s &command) {
    start(command, vehicle_command_s::VEHICLE_CMD_DO_GO_AROUND, vehicle);
    command.param1 = vehicle.altitude_known ? altitude_m : 0.f;
    await(command.command, vehicle);
}

/* Upwards, where PX4 holds. It flies straight on until it is almost that high. */
void GoeOrders::raise(float altitude_m, const Vehicle &vehicle, vehicle_command_s &command) {
    start(command, vehicle_command_s::VEHICLE_CMD_DO_REPOSITION, vehicle);
    command.param1 = DEFAULT_SPEED;
    command.param2 = CHANGE_MODE;
    command.param4 = NAN;
    command.param5 = command.param6 = static_cast<double>(NAN);
    command.param7 = altitude_m;
    await(command.command, vehicle);
    _raised = _breaks_off = true;
}

void GoeOrders::set_mission(const Vehicle &vehicle, vehicle_command_s &command) {
    start(command, vehicle_command_s::VEHICLE_CMD_DO_SET_MODE, vehicle);
    command.param1 = CUSTOM_MODE;
    command.param2 = MAIN_AUTO;
    command.param3 = SUB_MISSION;
    _awaited = command.command;
    _sent_us = vehicle.now_us;
    _resumes_left--;
}

bool GoeOrders::has_moved(const goe_flight_assessment_t &assessment) const {
    float square = 0.f;
    for (int i = 0; i < 3; i++) {
        const float moved_m = assessment.target_ned_m[i] - _target_ned_m[i];
        square += moved_m * moved_m;
    }
    return square > TARGET_MOVED_M * TARGET_MOVED_M;
}

/* Of an order that was given: Hold is where it leads to, and until it has it is the mode before. Where DO_GO_AROUND leads to is PX4's
 * affair. */
void GoeOrders::watch_mode(const Vehicle &vehicle) {
    _overruled = _overruled || (_given && in_failsafe(vehicle));
    if (!_given || (_action == GOE_FLIGHT_GO_AROUND && !_raised)) {
        return;
    }
    if (vehicle.nav_state == vehicle_status_s::NAVIGATION_STATE_AUTO_LOITER) {
        _has_led = true;
    } else if (_has_led || vehicle.nav_state != _mode_before) {
        _overruled = true;
    }
}

void GoeOrders::begin(goe_flight_action_t action) {
    if (_action == GOE_FLIGHT_NONE) {
        _has_led = _overruled = _given = _breaks_off = _raised = _gave_up = false;
        _named = 0;
    }
    _action = action;
    _wants_mission = false;
}

bool GoeOrders::may_resume(const Vehicle &vehicle) const {
    return _wants_mission && _resumes_left > 0 && vehicle.armed && !in_failsafe(vehicle) &&
           vehicle.nav_state == vehicle_status_s::NAVIGATION_STATE_AUTO_LOITER;
}

/* The layer ends an order when the obstacle is behind, or the course back is clear of it, and its position is still known; or when
 * its track has ended. An obstacle that is only out of view may be ahead in the mission. */
bool GoeOrders::is_past(const Vehicle &vehicle) const {
    return vehicle.obstacle_known && !_gave_up && _action != GOE_FLIGHT_HOLD;
}

/* Those that the order was about before the present assessment: an obstacle that is neither passed nor known any more may be ahead. */
void GoeOrders::watch_obstacles(const Vehicle &vehicle) {
    _gave_up = _gave_up || (_named & vehicle.gone) != 0;
    _named &= ~vehicle.behind;
}

bool GoeOrders::end(const Vehicle &vehicle, bool resume, vehicle_command_s &command) {
    watch_obstacles(vehicle);
    watch_mode(vehicle); /* a short order ends with the first look at the mode that it has led to */
    _wants_mission = resume && _has_led && !_overruled && !_breaks_off && is_past(vehicle) &&
                     _mode_before == vehicle_status_s::NAVIGATION_STATE_AUTO_MISSION;
    _resumes_left = RESUMES_MAX;
    _action = GOE_FLIGHT_NONE;
    _awaited = 0;
    _given = _overruled = false;
    if (!may_resume(vehicle)) {
        return false;
    }
    set_mission(vehicle, command);
    return true;
}

bool GoeOrders::repeat_resume(const Vehicle &vehicle, vehicle_command_s &command) {
    _wants_mission = _wants_mission && !in_failsafe(vehicle);
    if (_awaited == 0 || vehicle.now_us - _sent_us < REPEAT_US || !may_resume(vehicle)) {
        return false;
    }
    set_mission(vehicle, command);
    return true;
}

bool GoeOrders::is_unanswered(const Vehicle &vehicle) const {
    return _awaited != 0 && vehicle.now_us - _sent_us >= REPEAT_US;
}

/* PX4 acknowledges DO_GO_AROUND without a look at it, and only a fixed wing that lands flies it. */
bool GoeOrders::go_on_around(const goe_flight_assessment_t &assessment, const Vehicle &vehicle, bool is_new,
                             vehicle_command_s &command) {
    const float altitude_m = vehicle.origin_alt_m - assessment.target_ned_m[2];
    if (vehicle.has_wings && vehicle.lands) {
        const bool due = is_new || !_given || is_unanswered(vehicle);
        if (due) {
            go_around(altitude_m, vehicle, command);
        }
        return due;
    }
    const bool too_low = vehicle.altitude_known && altitude_m > vehicle.setpoint_alt_m + TOO_LOW_M;
    const bool due = too_low && (!_raised || vehicle.now_us - _sent_us >= REPEAT_US);
    if (due) {
        raise(altitude_m, vehicle, command);
    }
    return due;
}

bool GoeOrders::go_on(const goe_flight_assessment_t &assessment, const Vehicle &vehicle, int32_t react, bool is_new,
                      vehicle_command_s &command) {
    watch_mode(vehicle);
    if (_overruled || !may_command(_action, vehicle, react)) {
        return false;
    }
    if (_action == GOE_FLIGHT_GO_AROUND) {
        return go_on_around(assessment, vehicle, is_new, command);
    }
    const bool due = is_new || !_given || is_unanswered(vehicle) || has_moved(assessment);
    if (due) {
        reposition(assessment, vehicle, command);
    }
    return due;
}

bool GoeOrders::follow(const goe_flight_assessment_t &assessment, const Vehicle &vehicle, int32_t react, bool resume,
                       vehicle_command_s &command) {
    if (assessment.action == GOE_FLIGHT_NONE) {
        return _action == GOE_FLIGHT_NONE ? repeat_resume(vehicle, command) : end(vehicle, resume, command);
    }
    const goe_flight_action_t action = flown_action(assessment.action, vehicle, react);
    const bool is_new = action != _action;
    _slot = assessment.avoided;
    if (is_new) {
        begin(action);
    }
    watch_obstacles(vehicle);
    if (assessment.avoided < 0) {
        _gave_up = true; /* also if the order is about another obstacle later */
    } else {
        _named |= 1u << static_cast<unsigned>(assessment.avoided);
    }
    return go_on(assessment, vehicle, react, is_new, command);
}

void GoeOrders::take(const vehicle_command_ack_s &answer) {
    if (_awaited == 0 || answer.command != _awaited) {
        return;
    }
    if (answer.result == vehicle_command_ack_s::VEHICLE_CMD_RESULT_ACCEPTED ||
        answer.result == vehicle_command_ack_s::VEHICLE_CMD_RESULT_IN_PROGRESS) {
        _awaited = 0;
    } else {
        _refused = static_cast<uint16_t>(_refused + (_refused < UINT16_MAX ? 1 : 0));
    }
}
