/* The thread of AP_GOE: the only one that calls the flight layer. SPDX-License-Identifier: MIT */
#include "AP_GOE_config.h"

#if AP_GOE_ENABLED

#include "AP_GOE.h"

#include <AP_HAL/AP_HAL.h>

#define ASSESS_MS 100
#define A_SECOND 10      // assessments
#define WAIT_US 200000   // an image whose pose has not come by then never gets one
#define IMAGES_AT_ONCE 4 // each costs up to one update of an estimator; the poses that come meanwhile wait no longer

void AP_GOE::thread_main()
{
    while (true) {
        (void)_wake.wait_blocking();
        work();
    }
}

void AP_GOE::work()
{
    take_settings();
    take_poses();
    fetch_images();
    take_images();
    if (AP_HAL::millis() - _state->assessed_ms >= ASSESS_MS) {
        _state->assessed_ms = AP_HAL::millis();
        assess();
        publish();
    }
}

// ---------------------------------------------------------------------------------------------------------- settings

void AP_GOE::take_settings()
{
    {
        WITH_SEMAPHORE(_inbox_sem);
        if (!_state->inbox.has_settings) {
            return;
        }
        _state->tried = _state->inbox.settings;
        _state->inbox.has_settings = false;
    }
    Found &next = _state->next;
    if (init_flight(_state->tried, &next.bad_field)) {
        _state->good = _state->tried;
        _state->has_good = true;
        next.taken_settings++;
        return;
    }
    next.refused_settings++;
    if (next.bad_field == nullptr) {
        next.bad_field = "size";
    }
    if (_state->has_good) {
        (void)init_flight(_state->good, nullptr);
    }
}

bool AP_GOE::init_flight(const Settings &settings, const char **bad_field)
{
    return goe_flight_init(&_state->flight, sizeof(_state->flight), &settings.estimator, &settings.layer, bad_field) ==
           GOE_FLIGHT_OK;
}

// ------------------------------------------------------------------------------------------------------------- poses

bool AP_GOE::next_pose(Pose &pose)
{
    WITH_SEMAPHORE(_inbox_sem);
    Inbox &inbox = _state->inbox;
    if (inbox.poses == 0) {
        return false;
    }
    pose = inbox.pose[0];
    inbox.poses--;
    memmove(&inbox.pose[0], &inbox.pose[1], inbox.poses * sizeof(Pose));
    return true;
}

void AP_GOE::take_poses()
{
    Pose pose;
    for (uint8_t i = 0; i < POSES_MAX && next_pose(pose); i++) {
        if (goe_flight_attitude(&_state->flight, &pose.attitude) == GOE_FLIGHT_OK) {
            (void)goe_flight_position(&_state->flight, &pose.position);
        }
        memcpy(_state->next.own_ned_m, pose.position.position_ned_m, sizeof(_state->next.own_ned_m));
    }
}

// ------------------------------------------------------------------------------------------------------------ images

// Into the thread's own queue, whose oldest go first if there are too many.
void AP_GOE::fetch_images()
{
    WITH_SEMAPHORE(_inbox_sem);
    Inbox &inbox = _state->inbox;
    const int over = int(_state->waiting_count) + inbox.images - WAITING_MAX;
    if (over > 0) {
        memmove(&_state->waiting[0], &_state->waiting[over], (_state->waiting_count - over) * sizeof(Waiting));
        _state->waiting_count -= over;
    }
    memcpy(&_state->waiting[_state->waiting_count], &inbox.image[0], inbox.images * sizeof(Waiting));
    _state->waiting_count += inbox.images;
    inbox.images = 0;
}

// false: its pose has not come yet
bool AP_GOE::take_image(const Waiting &waiting)
{
    goe_mavlink_sighting_t sighting;
    (void)goe_mavlink_from_features(&waiting.features, waiting.arrival_us, &sighting);
    const goe_flight_status_t status = goe_flight_frame(&_state->flight, &sighting.frame);
    if (status == GOE_FLIGHT_TOO_NEW) {
        return AP_HAL::micros() - waiting.arrival_us > WAIT_US;
    }
    const uint32_t delay_us = waiting.arrival_us - _state->flight.capture_us;
    if (status == GOE_FLIGHT_OK && int32_t(delay_us) >= 0) {
        Found &next = _state->next;
        next.delay_sum_us += delay_us;
        _state->delay_max_us = MAX(_state->delay_max_us, delay_us);
        next.images++;
    }
    return true;
}

void AP_GOE::take_images()
{
    uint8_t kept = 0;
    for (uint8_t i = 0; i < _state->waiting_count; i++) {
        if (i - kept >= IMAGES_AT_ONCE || !take_image(_state->waiting[i])) {
            _state->waiting[kept++] = _state->waiting[i];
        }
    }
    _state->waiting_count = kept;
}

// ------------------------------------------------------------------------------------------------------------ result

/* A slot in use gets another track by an eviction alone. The layer counts evictions, and the new track has another id;
 * without ids it may be in any slot. Without an eviction another id is a new one of the same track. */
void AP_GOE::number_tracks()
{
    Found &next = _state->next;
    const bool evicted = _state->flight.counters.evicted != _state->evicted;
    _state->evicted = _state->flight.counters.evicted;
    for (int slot = 0; slot < GOE_FLIGHT_SLOTS; slot++) {
        Track &track = next.track[slot];
        const bool used = next.state[slot] == GOE_FLIGHT_OK;
        const uint32_t id = next.obstacle[slot].id;
        const bool is_another = !track.used || (evicted && (id == 0 || id != track.id));
        track.number += used && is_another ? 1 : 0;
        track.used = used;
        track.id = id;
    }
}

/* A layer that cannot assess, as without a pose, has not ended its order: the assessment before stays, and nothing is
 * clear. */
void AP_GOE::assess()
{
    bool landing;
    {
        WITH_SEMAPHORE(_inbox_sem);
        landing = _state->inbox.landing;
    }
    Found &next = _state->next;
    goe_flight_assessment_t assessment;
    const goe_flight_status_t status = goe_flight_assess(&_state->flight, AP_HAL::micros(), landing, &assessment);
    if (status == GOE_FLIGHT_CORRUPTED && _state->has_good) {
        next.corruptions++;
        (void)init_flight(_state->good, nullptr);
    }
    for (int slot = 0; slot < GOE_FLIGHT_SLOTS; slot++) {
        next.state[slot] = goe_flight_obstacle(&_state->flight, slot, &next.obstacle[slot]);
    }
    if (status == GOE_FLIGHT_OK) {
        next.assessment = assessment;
        number_tracks();
    } else {
        next.assessment.pose_alive = false;
    }
    next.counters = _state->flight.counters;
    next.assessed++;
    if (next.assessed % A_SECOND == 0) {
        next.delay_max_us = _state->delay_max_us;
        _state->delay_max_us = 0;
    }
}

void AP_GOE::publish()
{
    WITH_SEMAPHORE(_found_sem);
    _state->found = _state->next;
}

#endif // AP_GOE_ENABLED
