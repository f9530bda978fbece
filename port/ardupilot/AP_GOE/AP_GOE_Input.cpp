/* Inputs of AP_GOE: the pose from the vehicle, detections from a link. SPDX-License-Identifier: MIT */
#include "AP_GOE_config.h"

#if AP_GOE_ENABLED

#include "AP_GOE.h"

#include <AP_AHRS/AP_AHRS.h>
#include <AP_HAL/AP_HAL.h>
#include <AP_InertialSensor/AP_InertialSensor.h>
#include <AP_RangeFinder/AP_RangeFinder.h>
#include <AP_Terrain/AP_Terrain.h>
#include <AP_Vehicle/AP_Vehicle.h>
#include <GCS_MAVLink/GCS.h>

#define TILT_MIN 0.7f // cosine: more than 45 degrees of tilt, and a range finder does not look at the ground below

// -------------------------------------------------------------------------------------------------------------- pose

void AP_GOE::read_pose()
{
    Pose pose{};
    const AP_AHRS &ahrs = AP::ahrs();
    const int16_t filter = 16 * int16_t(ahrs.configured_ekf_type()) + ahrs.get_primary_core_index();
    if (filter != _filter) {
        // another one, with another heading and perhaps another origin
        _filter = filter;
        _breaks++;
    }
    read_attitude(pose.attitude);
    if (!read_position(pose.position)) {
        return;
    }
    read_heights(pose.position, pose.attitude.q);
    queue_pose(pose);
}

// a thread that is too late loses the oldest
void AP_GOE::queue_pose(const Pose &pose)
{
    const bool landing = AP::vehicle()->is_landing();
    WITH_SEMAPHORE(_inbox_sem);
    Inbox &inbox = _state->inbox;
    if (inbox.poses == POSES_MAX) {
        inbox.poses--;
        memmove(&inbox.pose[0], &inbox.pose[1], inbox.poses * sizeof(Pose));
    }
    inbox.pose[inbox.poses++] = pose;
    inbox.landing = landing;
}

void AP_GOE::read_attitude(goe_flight_attitude_t &sample)
{
    Quaternion q;
    AP::ahrs().get_quat_body_to_ned(q);
    sample.time_us = AP::ins().get_last_update_usec();
    sample.q[0] = q.q1;
    sample.q[1] = q.q2;
    sample.q[2] = q.q3;
    sample.q[3] = q.q4;
    float yaw_change;
    sample.reset = AP::ahrs().getLastYawResetAngle(yaw_change) + _breaks;
}

bool AP_GOE::read_position(goe_flight_position_t &sample)
{
    AP_AHRS &ahrs = AP::ahrs();
    Vector3f ned_m, velocity_m_s;
    if (!ahrs.have_inertial_nav() || !ahrs.get_relative_position_NED_origin_float(ned_m) ||
        !ahrs.get_velocity_NED(velocity_m_s)) {
        return false;
    }
    sample.time_us = AP::ins().get_last_update_usec();
    for (uint8_t i = 0; i < 3; i++) {
        sample.position_ned_m[i] = ned_m[i];
        sample.velocity_ned_m_s[i] = velocity_m_s[i];
    }
    _position_ned_m = ned_m;

    Vector2f jump_ne_m;
    float jump_down_m = 0.0f;
    sample.reset_horizontal = ahrs.getLastPosNorthEastReset(jump_ne_m);
    sample.reset_vertical = ahrs.getLastPosDownReset(jump_down_m);
    sample.reset_delta_known = true;
    sample.reset_delta_ned_m[0] = jump_ne_m.x;
    sample.reset_delta_ned_m[1] = jump_ne_m.y;
    sample.reset_delta_ned_m[2] = jump_down_m;

    Location origin;
    _origin_known = ahrs.get_origin(origin);
    sample.origin_known = _origin_known;
    if (_origin_known) {
        sample.origin_lat_e7 = origin.lat;
        sample.origin_lon_e7 = origin.lng;
        _origin_alt_m = origin.alt * 0.01f;
    }
    return true;
}

// heights of the reference point above the ground, by whatever the vehicle has
void AP_GOE::read_heights(goe_flight_position_t &sample, const float q[4]) const
{
#if AP_RANGEFINDER_ENABLED
    const RangeFinder *range_finder = AP::rangefinder();
    const float tilt = 1.0f - 2.0f * (q[1] * q[1] + q[2] * q[2]); // cosine
    if (range_finder != nullptr && range_finder->status_orient(ROTATION_PITCH_270) == RangeFinder::Status::Good &&
        tilt > TILT_MIN) {
        const Vector3f &offset = range_finder->get_pos_offset_orient(ROTATION_PITCH_270);
        const float sensor_below_m = 2.0f * (q[1] * q[3] - q[0] * q[2]) * offset.x +
                                     2.0f * (q[2] * q[3] + q[0] * q[1]) * offset.y + tilt * offset.z;
        sample.height_m[GOE_FLIGHT_RANGE_FINDER] =
            tilt * range_finder->distance_orient(ROTATION_PITCH_270) + sensor_below_m;
        sample.height_valid |= 1U << GOE_FLIGHT_RANGE_FINDER;
    }
#endif
#if AP_TERRAIN_AVAILABLE
    AP_Terrain *terrain = AP::terrain();
    float above_terrain_m;
    if (terrain != nullptr && terrain->height_above_terrain(above_terrain_m)) {
        sample.height_m[GOE_FLIGHT_TERRAIN] = above_terrain_m;
        sample.height_valid |= 1U << GOE_FLIGHT_TERRAIN;
    }
#endif
    if (AP::ahrs().home_is_set()) {
        float down_m;
        AP::ahrs().get_relative_position_D_home(down_m);
        sample.height_m[GOE_FLIGHT_HOME] = -down_m;
        sample.height_valid |= 1U << GOE_FLIGHT_HOME;
    }
}

// ---------------------------------------------------------------------------------------------------------- messages

void AP_GOE::handle_message(const mavlink_message_t &msg)
{
    if (goe_mavlink_of_id(msg.msgid) == GOE_MAVLINK_FEATURES) {
        queue_features(msg);
    }
}

/* The parser could not check it without the message's checksum seed. Framing it once more shows whether it is whole; a signed
 * frame has other flags and never fits. */
static bool is_whole(const mavlink_message_t &msg)
{
    goe_mavlink_sender_t sender{msg.sysid, msg.compid, msg.seq};
    uint8_t frame[GOE_MAVLINK_FRAME_MAX];
    const size_t length = goe_mavlink_frame(&sender, goe_mavlink_of_id(msg.msgid),
                                            reinterpret_cast<const uint8_t *>(_MAV_PAYLOAD(&msg)), msg.len, frame);
    return length >= 2 && (frame[length - 2] | frame[length - 1] << 8) == msg.checksum;
}

void AP_GOE::handle_unknown(const mavlink_message_t &msg, mavlink_channel_t chan)
{
    if (goe_mavlink_of_id(msg.msgid) != GOE_MAVLINK_FEATURES || !is_whole(msg)) {
        return;
    }
    const mavlink_status_t *status = mavlink_get_channel_status(chan);
    if (status->signing != nullptr && (status->signing->accept_unsigned_callback == nullptr ||
                                       !status->signing->accept_unsigned_callback(status, msg.msgid))) {
        return;
    }
    queue_features(msg);
}

// other vehicles' cameras are none of ours
void AP_GOE::queue_features(const mavlink_message_t &msg)
{
    if (!enabled() || _state == nullptr || msg.sysid != mavlink_system.sysid) {
        return;
    }
    WITH_SEMAPHORE(_inbox_sem);
    Inbox &inbox = _state->inbox;
    if (inbox.images == WAITING_MAX) {
        inbox.images--;
        memmove(&inbox.image[0], &inbox.image[1], inbox.images * sizeof(Waiting));
    }
    Waiting &waiting = inbox.image[inbox.images++];
    waiting.arrival_us = AP_HAL::micros();
    goe_mavlink_read_features(reinterpret_cast<const uint8_t *>(_MAV_PAYLOAD(&msg)), msg.len, &waiting.features);
}

#endif // AP_GOE_ENABLED
