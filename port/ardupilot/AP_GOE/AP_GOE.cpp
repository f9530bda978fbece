/* Life of AP_GOE: start, parameters that change, assessment, what the operator is told. SPDX-License-Identifier: MIT */
#include "AP_GOE_config.h"

#if AP_GOE_ENABLED

#include "AP_GOE.h"

#include <AP_Arming/AP_Arming.h>
#include <AP_HAL/AP_HAL.h>
#include <AP_Vehicle/AP_Vehicle.h>
#include <GCS_MAVLink/GCS.h>

#if CONFIG_HAL_BOARD == HAL_BOARD_SITL
#include <fenv.h>
#endif

#define ASSESS_MS 100
#define SECOND_MS 1000

extern const AP_HAL::HAL &hal;

AP_GOE *AP_GOE::_singleton;

AP_GOE::AP_GOE()
{
    _singleton = this;
    AP_Param::setup_object_defaults(this, var_info);
}

const goe_flight_t *AP_GOE::flight() const { return _state != nullptr ? &_state->flight : nullptr; }

const goe_flight_assessment_t *AP_GOE::assessment() const { return _state != nullptr ? &_state->assessment : nullptr; }

// ------------------------------------------------------------------------------------------------------------- start

// it overflows on purpose, which the simulator's traps would take for a fault
static unsigned check_arithmetic()
{
#if CONFIG_HAL_BOARD == HAL_BOARD_SITL
    fenv_t before;
    feholdexcept(&before);
    const unsigned result = goe_self_check();
    fesetenv(&before);
    return result;
#else
    return goe_self_check();
#endif
}

bool AP_GOE::start()
{
    _tried = true;
    _self_check = check_arithmetic();
    if (_self_check != 0) {
        // estimates stay good; they are not those of the host to the last bit
        GCS_SEND_TEXT(MAV_SEVERITY_INFO, "GOE: arithmetic differs (0x%02x)", _self_check);
    }
    _state = NEW_NOTHROW State;
    if (_state == nullptr) {
        GCS_SEND_TEXT(MAV_SEVERITY_ERROR, "GOE: no memory");
        return false;
    }
    memset(_state, 0, sizeof(*_state));
    follow_params();
    return true;
}

// any slot in use, with a position or not
bool AP_GOE::follows_something() const
{
    goe_flight_obstacle_t obstacle;
    for (int slot = 0; slot < GOE_FLIGHT_SLOTS; slot++) {
        if (goe_flight_obstacle(&_state->flight, slot, &obstacle) == GOE_FLIGHT_OK) {
            return true;
        }
    }
    return false;
}

/* The flight layer takes settings only at its start, which forgets everything: in flight they wait until nothing is followed.
 * Bad ones are refused, and the latest good ones go on. */
void AP_GOE::follow_params()
{
    Settings now;
    read_params(now.estimator, now.layer);
    const bool is_first = !_has_tried;
    if (!is_first && memcmp(&now, &_state->tried, sizeof(now)) == 0) {
        return;
    }
    if (!is_first && AP::arming().is_armed() && follows_something()) {
        if (!_told_waiting) {
            GCS_SEND_TEXT(MAV_SEVERITY_INFO, "GOE: parameters wait until nothing is followed");
            _told_waiting = true;
        }
        return;
    }
    _told_waiting = false;
    _has_tried = true;
    _state->tried = now;
    _bad_field = nullptr;
    if (init_flight(now, &_bad_field)) {
        _state->good = now;
        _has_good = true;
        if (!is_first) {
            GCS_SEND_TEXT(MAV_SEVERITY_INFO, "GOE: parameters taken");
        }
        return;
    }
    GCS_SEND_TEXT(MAV_SEVERITY_WARNING, "GOE: bad setting %s", _bad_field != nullptr ? _bad_field : "size");
    if (_has_good) {
        (void)init_flight(_state->good, nullptr);
    }
}

bool AP_GOE::init_flight(const Settings &settings, const char **bad_field)
{
    _told_lost = 0;
    return goe_flight_init(&_state->flight, sizeof(_state->flight), &settings.estimator, &settings.layer, bad_field) ==
           GOE_FLIGHT_OK;
}

// -------------------------------------------------------------------------------------------------------------- life

void AP_GOE::update()
{
    if (!enabled()) {
        return;
    }
    if (!_tried) {
        start();
    }
    if (_state == nullptr) {
        return;
    }
    read_pose();
    take_images();
    const uint32_t now_ms = AP_HAL::millis();
    if (now_ms - _assessed_ms >= ASSESS_MS) {
        _assessed_ms = now_ms;
        assess();
    }
    if (now_ms - _second_ms >= SECOND_MS) {
        _second_ms = now_ms;
        once_a_second();
    }
}

void AP_GOE::assess()
{
    const goe_flight_status_t status =
        goe_flight_assess(&_state->flight, AP_HAL::micros(), AP::vehicle()->is_landing(), &_state->assessment);
    if (status == GOE_FLIGHT_CORRUPTED && _has_good) {
        GCS_SEND_TEXT(MAV_SEVERITY_WARNING, "GOE: memory was corrupted, begun anew");
        (void)init_flight(_state->good, nullptr);
    }
    put_obstacles();
    tell_changes();
    if (is_positive(_report_hz) && (AP_HAL::millis() - _reported_ms) * 0.001f * _report_hz >= 1.0f) {
        _reported_ms = AP_HAL::millis();
        send_obstacles();
    }
}

void AP_GOE::tell_changes()
{
    const goe_flight_assessment_t &now = _state->assessment;
    const bool alive = now.detector_alive && now.pose_alive;
    if (alive != _told_alive) {
        _told_alive = alive;
        GCS_SEND_TEXT(alive ? MAV_SEVERITY_INFO : MAV_SEVERITY_WARNING, "GOE: %s",
                      alive            ? "alive"
                      : now.pose_alive ? "no images"
                                       : "no pose");
    }
    if (now.action != _told_action) {
        _told_action = now.action;
        if (now.action == GOE_FLIGHT_NONE) {
            GCS_SEND_TEXT(MAV_SEVERITY_INFO, "GOE: no action any more");
        } else {
            GCS_SEND_TEXT(MAV_SEVERITY_WARNING, "GOE: obstacle in %.1f s (%s%s)", double(now.hazard.time_s),
                          goe_flight_action_text(now.action), now.late ? ", late" : "");
        }
    }
    const uint16_t lost = _state->flight.counters.lost;
    if (lost != _told_lost) {
        _told_lost = lost;
        GCS_SEND_TEXT(MAV_SEVERITY_INFO, "GOE: pose jumped, all obstacles given up");
    }
}

void AP_GOE::once_a_second()
{
    follow_params();
    send_status();
}

// ------------------------------------------------------------------------------------------------------------ health

bool AP_GOE::healthy() const
{
    return enabled() && _state != nullptr && _bad_field == nullptr && _state->assessment.detector_alive &&
           _state->assessment.pose_alive;
}

bool AP_GOE::pre_arm_check(char *failure_msg, uint8_t failure_msg_len) const
{
    if (!enabled() || !_tried) {
        return true;
    }
    const char *why = nullptr;
    if (_state == nullptr) {
        why = "no memory";
    } else if (_bad_field != nullptr) {
        hal.util->snprintf(failure_msg, failure_msg_len, "GOE: bad setting %s", _bad_field);
        return false;
    } else if (!has_option(Option::ARM_NEEDS_IMAGES)) {
        return true;
    } else if (!_state->assessment.pose_alive) {
        why = "no pose";
    } else if (!_state->assessment.detector_alive) {
        why = "no images";
    }
    if (why != nullptr) {
        hal.util->snprintf(failure_msg, failure_msg_len, "GOE: %s", why);
    }
    return why == nullptr;
}

namespace AP
{
AP_GOE *goe() { return AP_GOE::get_singleton(); }
} // namespace AP

#endif // AP_GOE_ENABLED
