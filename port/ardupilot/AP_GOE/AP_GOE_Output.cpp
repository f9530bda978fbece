/* What goes out of AP_GOE: the avoidance database, messages. SPDX-License-Identifier: MIT */
#include "AP_GOE_config.h"

#if AP_GOE_ENABLED

#include "AP_GOE.h"

#include <AC_Avoidance/AP_OADatabase.h>
#include <AP_HAL/AP_HAL.h>
#include <GCS_MAVLink/GCS.h>

#define DATABASE_ID 0x474F4500U // of slot 0; above every ship's nine digits
#define TOP_SIGMAS 2.0f
#define NUDGE_M 0.001f

void AP_GOE::put_obstacles()
{
    goe_flight_obstacle_t obstacle;
    _push_is_odd = !_push_is_odd;
    for (int slot = 0; slot < GOE_FLIGHT_SLOTS; slot++) {
        if (goe_flight_obstacle(&_state->flight, slot, &obstacle) != GOE_FLIGHT_OK ||
            (obstacle.valid & GOE_HAS_POSITION) == 0) {
            continue;
        }
        push_to_database(slot, obstacle);
        log_obstacle(slot, obstacle);
        log_hazard(slot, obstacle);
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

/* The database holds spheres: the obstacle's one is at the vehicle's own height while that is between the obstacle's foot and
 * top, so that what counts is the horizontal distance. Without a known top it always is.
 *
 * The source is the one whose items the database knows by their id, and moves. It moves them if the radius changed or half a
 * second has gone by: every other push differs by a millimetre. */
void AP_GOE::push_to_database(int slot, const goe_flight_obstacle_t &obstacle)
{
#if AP_OADATABASE_ENABLED
    AP_OADatabase *database = AP::oadatabase();
    if (database == nullptr || !database->healthy()) {
        return;
    }
    const float foot_m = -obstacle.center_ned_m[2];
    float up_m = MAX(-_position_ned_m.z, foot_m);
    if ((obstacle.valid & GOE_HAS_HEIGHT) != 0) {
        up_m = MIN(up_m, foot_m + obstacle.height_m + TOP_SIGMAS * obstacle.height_sd_m);
    }
    const float sigmas = _oa_sigma * (obstacle.suspect ? 2.0f : 1.0f);
    const float radius_m = obstacle.radius_m + sigmas * place_sd_m(obstacle) + (_push_is_odd ? NUDGE_M : 0.0f);
    const Vector3f place_neu_m{obstacle.center_ned_m[0], obstacle.center_ned_m[1], up_m};
    const float distance_m = norm(place_neu_m.x - _position_ned_m.x, place_neu_m.y - _position_ned_m.y);
    const uint32_t measured_ms = AP_HAL::millis() - uint32_t(obstacle.age_s * 1000.0f);
    database->queue_push(place_neu_m, measured_ms, distance_m, radius_m, AP_OADatabase::OA_DbItem::Source::AIS,
                         DATABASE_ID + uint32_t(slot));
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

/* To every link that is in use and has room. The trees' dialect does not know these messages, its framing takes them all the
 * same. */
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
    goe_flight_obstacle_t obstacle;
    for (int slot = 0; slot < GOE_FLIGHT_SLOTS; slot++) {
        if (goe_flight_obstacle(&_state->flight, slot, &obstacle) != GOE_FLIGHT_OK ||
            (obstacle.valid & GOE_HAS_POSITION) == 0) {
            continue;
        }
        goe_mavlink_obstacle_t place;
        goe_mavlink_to_obstacle(&obstacle, slot, &here, &place);
        send_payload(GOE_MAVLINK_OBSTACLE, payload, goe_mavlink_pack_obstacle(&place, payload));
        goe_mavlink_hazard_t hazard;
        if (goe_mavlink_to_hazard(&obstacle, slot, &_state->assessment, &here, &hazard)) {
            send_payload(GOE_MAVLINK_HAZARD, payload, goe_mavlink_pack_hazard(&hazard, payload));
        }
    }
}

void AP_GOE::send_status()
{
    const goe_mavlink_own_t here = own();
    goe_mavlink_status_t status;
    goe_mavlink_to_status(&_state->flight.counters, &_state->assessment, _self_check, &here, &status);
    if (_images > 0) {
        status.delay_mean = MIN(_delay_sum_us / _images / 1000U, 65534U);
        status.delay_max = MIN(_delay_max_us / 1000U, 65534U);
    }
    _delay_sum_us = _delay_max_us = 0;
    _images = 0;
    log_status(status);
    if (is_positive(_report_hz)) {
        uint8_t payload[GOE_MAVLINK_PAYLOAD_MAX];
        send_payload(GOE_MAVLINK_STATUS, payload, goe_mavlink_pack_status(&status, payload));
    }
}

#endif // AP_GOE_ENABLED
