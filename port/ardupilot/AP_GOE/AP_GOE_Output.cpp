/* Outputs of AP_GOE: the avoidance database, messages. SPDX-License-Identifier: MIT */
#include "AP_GOE_config.h"

#if AP_GOE_ENABLED

#include "AP_GOE.h"

#include <AC_Avoidance/AP_OADatabase.h>
#include <AP_HAL/AP_HAL.h>
#include <GCS_MAVLink/GCS.h>

#define DATABASE_ID 0x474F4500U // of slot 0's first track; above every ship's nine digits
#define TOP_SIGMAS 2.0f
#define RESEND_MS 500 // the ground station sees a database item twice a second

bool AP_GOE::has_position(const Found &found, int slot) const
{
    return found.state[slot] == GOE_FLIGHT_OK && (found.obstacle[slot].valid & GOE_HAS_POSITION) != 0;
}

void AP_GOE::log_obstacles() const
{
    log_assessment();
    for (int slot = 0; slot < GOE_FLIGHT_SLOTS; slot++) {
        if (has_position(_state->shown, slot)) {
            log_obstacle(slot, _state->shown.obstacle[slot]);
            log_hazard(slot, _state->shown.obstacle[slot]);
        }
    }
}

// ---------------------------------------------------------------------------------------------------------- database

#if AP_OADATABASE_ENABLED
// one sigma of the place along its worst direction
static float place_sd_m(const goe_flight_obstacle_t &obstacle)
{
    const float nn = obstacle.covariance_ne_m2[0], ne = obstacle.covariance_ne_m2[1], ee = obstacle.covariance_ne_m2[2];
    const float half_difference = 0.5f * (nn - ee);
    return sqrtf(0.5f * (nn + ee) + sqrtf(half_difference * half_difference + ne * ne));
}
#endif

/* A track has one item, and each call moves it. The database forgets the item OA_DB_EXPIRE after the end of the track,
 * because the obstacle may still be there. The slot's next track has another item. */
void AP_GOE::refresh_database(AP_OADatabase &database)
{
#if AP_OADATABASE_ENABLED
    if (!enabled() || _state == nullptr) {
        return;
    }
    const bool resend = AP_HAL::millis() - _resent_ms >= RESEND_MS;
    _resent_ms = resend ? AP_HAL::millis() : _resent_ms;
    WITH_SEMAPHORE(_found_sem);
    for (int slot = 0; slot < GOE_FLIGHT_SLOTS; slot++) {
        if (has_position(_state->found, slot)) {
            put_into_database(database, slot, _state->found.obstacle[slot], resend);
        }
    }
#endif
}

/* The database holds spheres: the obstacle's one is at the vehicle's own height while that is between the obstacle's foot and
 * top, so that what counts is the horizontal distance. Without a known top it always is. */
void AP_GOE::put_into_database(AP_OADatabase &database, int slot, const goe_flight_obstacle_t &obstacle, bool resend)
{
#if AP_OADATABASE_ENABLED
    const float *own_ned_m = _state->found.own_ned_m;
    const float foot_m = -obstacle.center_ned_m[2];
    float up_m = MAX(-own_ned_m[2], foot_m);
    if ((obstacle.valid & GOE_HAS_HEIGHT) != 0) {
        up_m = MIN(up_m, foot_m + obstacle.height_m + TOP_SIGMAS * obstacle.height_sd_m);
    }
    const float sigmas = _oa_sigma * (obstacle.suspect ? 2.0f : 1.0f);
    const float radius_m = MAX(float(database._radius_min), obstacle.radius_m + sigmas * place_sd_m(obstacle));
    const Vector3f place_neu_m{obstacle.center_ned_m[0], obstacle.center_ned_m[1], up_m};
    const float distance_m = norm(place_neu_m.x - own_ned_m[0], place_neu_m.y - own_ned_m[1]) - radius_m;
    if (is_positive(database._dist_max) && distance_m > database._dist_max) {
        return;
    }
    const uint32_t id = DATABASE_ID + GOE_FLIGHT_SLOTS * (_state->found.track[slot].number - 1U) + uint32_t(slot);
    uint16_t index = 0;
    while (index < database._database.count &&
           (database._database.items[index].id != id ||
            database._database.items[index].source != AP_OADatabase::OA_DbItem::Source::camera)) {
        index++;
    }
    if (index == database._database.count) {
        AP_OADatabase::OA_DbItem item{};
        item.importance = AP_OADatabase::OA_DbItemImportance::Normal;
        item.source = AP_OADatabase::OA_DbItem::Source::camera;
        item.id = id;
        database.database_item_add(item);
        if (index == database._database.count) {
            return; // no space
        }
    }
    AP_OADatabase::OA_DbItem &item = database._database.items[index];
    item.pos = place_neu_m;
    item.radius = radius_m;
    item.timestamp_ms = AP_HAL::millis();
    if (resend) {
        item.send_to_gcs = database.get_send_to_gcs_flags(item.importance);
    }
#endif
}

// ---------------------------------------------------------------------------------------------------------- messages

goe_mavlink_own_t AP_GOE::own() const
{
    goe_mavlink_own_t result{};
    result.time_usec = AP_HAL::micros64();
    for (uint8_t i = 0; i < 3; i++) {
        result.position_ned_m[i] = _position_ned_m[i];
    }
    result.origin_known = _origin_known;
    result.origin_alt_m = _origin_alt_m;
    return result;
}

/* To every link in use with free buffer space. The trees' dialect does not know these messages, but its framing takes
 * them. */
void AP_GOE::send_payload(goe_mavlink_message_t message, const uint8_t *payload, size_t length) const
{
#if HAL_GCS_ENABLED
    const goe_mavlink_info_t *info = goe_mavlink_info(message);
    uint8_t whole[GOE_MAVLINK_PAYLOAD_MAX]{};
    memcpy(whole, payload, length);
    for (uint8_t i = 0; i < gcs().num_gcs(); i++) {
        const GCS_MAVLINK *link = gcs().chan(i);
        if (link == nullptr || !link->is_active() || link->is_private()) {
            continue;
        }
        const mavlink_channel_t chan = link->get_chan();
        const bool is_mavlink1 = (mavlink_get_channel_status(chan)->flags & MAVLINK_STATUS_FLAG_OUT_MAVLINK1) != 0;
        if (is_mavlink1 || comm_get_txspace(chan) < uint16_t(GCS_MAVLINK::packet_overhead_chan(chan) + info->length)) {
            continue;
        }
        _mav_finalize_message_chan_send(chan, info->id, reinterpret_cast<const char *>(whole), info->length_min,
                                        info->length, info->crc_extra);
    }
#endif
}

void AP_GOE::send_obstacles()
{
    const goe_mavlink_own_t here = own();
    uint8_t payload[GOE_MAVLINK_PAYLOAD_MAX];
    for (int slot = 0; slot < GOE_FLIGHT_SLOTS; slot++) {
        if (!has_position(_state->shown, slot)) {
            continue;
        }
        const goe_flight_obstacle_t &obstacle = _state->shown.obstacle[slot];
        goe_mavlink_obstacle_t place;
        goe_mavlink_to_obstacle(&obstacle, slot, &here, &place);
        send_payload(GOE_MAVLINK_OBSTACLE, payload, goe_mavlink_pack_obstacle(&place, payload));
        goe_mavlink_hazard_t hazard;
        if (goe_mavlink_to_hazard(&obstacle, slot, &_state->shown.assessment, &here, &hazard)) {
            send_payload(GOE_MAVLINK_HAZARD, payload, goe_mavlink_pack_hazard(&hazard, payload));
        }
    }
}

void AP_GOE::send_status()
{
    const goe_mavlink_own_t here = own();
    goe_mavlink_status_t status;
    goe_mavlink_to_status(&_state->shown.counters, &_state->shown.assessment, _self_check, &here, &status);
    const uint32_t images = _state->shown.images - _status_images;
    if (images > 0) {
        status.delay_mean = MIN((_state->shown.delay_sum_us - _status_delay_us) / images / 1000U, 65534U);
        status.delay_max = MIN(_state->shown.delay_max_us / 1000U, 65534U);
    }
    _status_images = _state->shown.images;
    _status_delay_us = _state->shown.delay_sum_us;
    log_status(status);
    if (is_positive(_report_hz)) {
        uint8_t payload[GOE_MAVLINK_PAYLOAD_MAX];
        send_payload(GOE_MAVLINK_STATUS, payload, goe_mavlink_pack_status(&status, payload));
    }
}

#endif // AP_GOE_ENABLED
