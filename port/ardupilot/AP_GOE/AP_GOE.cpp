/* AP_GOE in the main thread: start, changes of parameters, assessment, texts for the operator. SPDX-License-Identifier: MIT */
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

#define SECOND_MS 1000

extern const AP_HAL::HAL &hal;

AP_GOE *AP_GOE::_singleton;

AP_GOE::AP_GOE()
{
    _singleton = this;
    AP_Param::setup_object_defaults(this, var_info);
}

// ------------------------------------------------------------------------------------------------------------- start

// the check overflows on purpose; the simulator's traps would treat this as a fault
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
        // the estimates are valid, but not bit-identical to those of other targets
        GCS_SEND_TEXT(MAV_SEVERITY_INFO, "GOE: arithmetic not bit-identical (0x%02x)", _self_check);
    }
    State *const state = NEW_NOTHROW State;
    if (state == nullptr) {
        GCS_SEND_TEXT(MAV_SEVERITY_ERROR, "GOE: no memory");
        return false;
    }
    memset(state, 0, sizeof(*state));
    state->next.assessment.worst = state->next.assessment.avoided = -1;
    state->next.assessment.pose_agrees = true; // a pose that has not come contradicts nothing
    state->shown.assessment = state->next.assessment;
    // the thread waits until update() wakes it
    if (!hal.scheduler->thread_create(FUNCTOR_BIND_MEMBER(&AP_GOE::thread_main, void), "goe", AP_GOE_STACK,
                                      AP_HAL::Scheduler::PRIORITY_IO, -1)) {
        delete state;
        GCS_SEND_TEXT(MAV_SEVERITY_ERROR, "GOE: no thread");
        return false;
    }
    _state = state;
    find_vehicle();
    follow_params();
    return true;
}

// any slot in use, with a position or not
bool AP_GOE::follows_something() const
{
    for (const Track &track : _state->shown.track) {
        if (track.used) {
            return true;
        }
    }
    return false;
}

/* New settings restart the flight layer, which ends all tracks. While the vehicle is armed, they therefore wait until no obstacle
 * is tracked. Invalid settings are refused, and the latest valid ones stay in use. */
void AP_GOE::follow_params()
{
    Settings now;
    read_params(now.estimator, now.layer);
    const bool is_first = _state->shown.assessed == 0;
    if (memcmp(&now, &_state->given, sizeof(now)) == 0) {
        return;
    }
    if (!is_first && AP::arming().is_armed() && follows_something()) {
        if (!_reported_waiting) {
            GCS_SEND_TEXT(MAV_SEVERITY_INFO, "GOE: parameters wait until nothing is tracked");
            _reported_waiting = true;
        }
        return;
    }
    _reported_waiting = false;
    _state->given = now;
    report_loiter(now.layer.loiter_m);
    WITH_SEMAPHORE(_inbox_sem);
    _state->inbox.settings = now;
    _state->inbox.has_settings = true;
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
    _wake.signal();
    take_found();
    const uint32_t now_ms = AP_HAL::millis();
    if (now_ms - _second_ms >= SECOND_MS) {
        _second_ms = now_ms;
        once_a_second();
    }
}

void AP_GOE::take_found()
{
    {
        WITH_SEMAPHORE(_found_sem);
        if (_state->found.assessed == _state->shown.assessed) {
            return;
        }
        _state->shown = _state->found;
    }
    report();
}

void AP_GOE::report()
{
    log_obstacles();
    report_settings();
    report_changes();
    if (is_positive(_report_hz) && (AP_HAL::millis() - _reported_ms) * 0.001f * _report_hz >= 1.0f) {
        _reported_ms = AP_HAL::millis();
        send_obstacles();
    }
}

void AP_GOE::report_settings()
{
    const Found &now = _state->shown;
    if (now.taken_settings != _reported_taken) {
        if (_reported_taken != 0) {
            GCS_SEND_TEXT(MAV_SEVERITY_INFO, "GOE: new parameters in use");
        }
        _reported_taken = now.taken_settings;
        _reported_lost = 0;
    }
    if (now.refused_settings != _reported_refused) {
        _reported_refused = now.refused_settings;
        _reported_lost = 0;
        GCS_SEND_TEXT(MAV_SEVERITY_WARNING, "GOE: bad parameter %s", parameter_of(now.bad_field));
    }
    if (now.corruptions != _reported_corruptions) {
        _reported_corruptions = now.corruptions;
        _reported_lost = 0;
        GCS_SEND_TEXT(MAV_SEVERITY_WARNING, "GOE: memory was corrupted, restarted");
    }
}

// The aircraft flies a wider circle than WP_LOITER_RAD if its turn is wider. The layer uses that radius.
void AP_GOE::report_loiter(float used_m)
{
    const float set_m = fabsf(_loiter_m.get());
    if (used_m <= set_m + 0.5f || is_zero(used_m - _reported_loiter_m)) {
        return;
    }
    _reported_loiter_m = used_m;
    GCS_SEND_TEXT(MAV_SEVERITY_WARNING, "GOE: WP_LOITER_RAD %.0f too small, %.0f used", double(set_m), double(used_m));
}

void AP_GOE::report_changes()
{
    const goe_flight_assessment_t &now = _state->shown.assessment;
    const bool alive = now.detector_alive && now.pose_alive;
    if (alive != _reported_alive) {
        _reported_alive = alive;
        GCS_SEND_TEXT(alive ? MAV_SEVERITY_INFO : MAV_SEVERITY_WARNING, "GOE: %s",
                      alive             ? "alive"
                      : now.pose_alive  ? "no images"
                      : now.pose_agrees ? "no pose"
                                        : "velocity contradicts position");
    }
    if (now.action != _reported_action) {
        _reported_action = now.action;
        if (now.action == GOE_FLIGHT_NONE) {
            GCS_SEND_TEXT(MAV_SEVERITY_INFO, "GOE: action ended");
        } else {
            GCS_SEND_TEXT(MAV_SEVERITY_WARNING, "GOE: obstacle in %.1f s (%s%s)", double(now.hazard.tcpa_s),
                          goe_flight_action_text(now.action), now.late ? ", late" : "");
        }
    }
    const uint16_t lost = _state->shown.counters.lost;
    if (lost != _reported_lost) {
        _reported_lost = lost;
        GCS_SEND_TEXT(MAV_SEVERITY_INFO, "GOE: pose reset, all tracks ended");
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
    return enabled() && _state != nullptr && _state->shown.bad_field == nullptr &&
           _state->shown.assessment.detector_alive && _state->shown.assessment.pose_alive;
}

bool AP_GOE::pre_arm_check(char *failure_msg, uint8_t failure_msg_len) const
{
    if (!enabled() || !_tried) {
        return true;
    }
    const char *why = nullptr;
    if (_state == nullptr) {
        why = "no memory or no thread";
    } else if (_state->shown.bad_field != nullptr) {
        hal.util->snprintf(failure_msg, failure_msg_len, "GOE: bad parameter %s",
                           parameter_of(_state->shown.bad_field));
        return false;
    } else if (!has_option(Option::ARM_NEEDS_IMAGES)) {
        return true;
    } else if (!_state->shown.assessment.pose_alive) {
        why = _state->shown.assessment.pose_agrees ? "no pose" : "velocity contradicts position";
    } else if (!_state->shown.assessment.detector_alive) {
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
