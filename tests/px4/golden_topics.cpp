/* The replay of tests/targets/flight_main.c, whose hash must stay the golden one while every sample and every frame is sent as in PX4:
 * as a topic, through GoeConversion. Linked with --wrap. SPDX-License-Identifier: MIT */
#include <cstring>

#include "GoeConversion.hpp"

extern "C" {
goe_flight_status_t __real_goe_flight_attitude(goe_flight_t *flight, const goe_flight_attitude_t *sample);
goe_flight_status_t __real_goe_flight_position(goe_flight_t *flight, const goe_flight_position_t *sample);
goe_flight_status_t __real_goe_flight_frame(goe_flight_t *flight, const goe_flight_frame_t *frame);
goe_flight_status_t __wrap_goe_flight_attitude(goe_flight_t *flight, const goe_flight_attitude_t *sample);
goe_flight_status_t __wrap_goe_flight_position(goe_flight_t *flight, const goe_flight_position_t *sample);
goe_flight_status_t __wrap_goe_flight_frame(goe_flight_t *flight, const goe_flight_frame_t *frame);
}

namespace {

constexpr uint64_t EPOCH_US = uint64_t{7} << 32; /* PX4's upper 32 of 64 bits, which the layer does not get */

/* PX4 reports the size of every jump; a jump of unknown size is one that was missed. */
uint8_t count_reset(const goe_flight_position_t &sample) {
    static uint32_t mark;
    static uint8_t count;
    if (sample.reset_horizontal != mark) {
        const bool known = sample.reset_delta_known && ((sample.reset_horizontal - mark) & 0xFFu) == 1u;
        count = static_cast<uint8_t>(count + (known ? 1 : 2));
        mark = sample.reset_horizontal;
    }
    return count;
}

} // namespace

goe_flight_status_t __wrap_goe_flight_attitude(goe_flight_t *flight, const goe_flight_attitude_t *sample) {
    vehicle_attitude_s topic{};
    topic.timestamp_sample = EPOCH_US + sample->time_us;
    topic.timestamp = topic.timestamp_sample + 4000u;
    memcpy(topic.q, sample->q, sizeof topic.q);
    topic.quat_reset_counter = static_cast<uint8_t>(sample->reset);
    const goe_flight_attitude_t converted = goe_px4::attitude(topic);
    return __real_goe_flight_attitude(flight, &converted);
}

goe_flight_status_t __wrap_goe_flight_position(goe_flight_t *flight, const goe_flight_position_t *sample) {
    vehicle_local_position_s topic{};
    goe_flight_position_t converted;
    topic.timestamp_sample = EPOCH_US + sample->time_us;
    topic.timestamp = topic.timestamp_sample + 4000u;
    topic.xy_valid = topic.z_valid = topic.v_xy_valid = topic.v_z_valid = true;
    topic.x = sample->position_ned_m[0];
    topic.y = sample->position_ned_m[1];
    topic.z = sample->position_ned_m[2];
    topic.vx = sample->velocity_ned_m_s[0];
    topic.vy = sample->velocity_ned_m_s[1];
    topic.vz = sample->velocity_ned_m_s[2];
    topic.xy_reset_counter = topic.z_reset_counter = count_reset(*sample);
    memcpy(topic.delta_xy, sample->reset_delta_ned_m, sizeof topic.delta_xy);
    topic.delta_z = sample->reset_delta_ned_m[2];
    topic.xy_global = sample->origin_known;
    topic.ref_lat = 1e-7 * sample->origin_lat_e7;
    topic.ref_lon = 1e-7 * sample->origin_lon_e7;
    topic.dist_bottom_valid = (sample->height_valid >> GOE_FLIGHT_TERRAIN & 1u) != 0u;
    topic.dist_bottom = sample->height_m[GOE_FLIGHT_TERRAIN];
    (void)goe_px4::position(topic, goe_px4::Heights{}, converted);
    return __real_goe_flight_position(flight, &converted);
}

goe_flight_status_t __wrap_goe_flight_frame(goe_flight_t *flight, const goe_flight_frame_t *frame) {
    const goe_flight_detection_t &detection = *frame->detection;
    const goe_pixel_t point[] = {detection.left,      detection.right,     detection.top,
                                 detection.base_left, detection.base_near, detection.base_right};
    goe_features_s topic{};
    goe_mavlink_sighting_t sighting;
    topic.timestamp = EPOCH_US + frame->arrival_us;
    topic.timestamp_sample = EPOCH_US + frame->capture_us;
    topic.time_sd = frame->time_sd_us;
    topic.number = frame->number;
    topic.id = detection.id;
    topic.score = detection.score;
    topic.box[0] = detection.box.left_px;
    topic.box[1] = detection.box.top_px;
    topic.box[2] = detection.box.right_px;
    topic.box[3] = detection.box.bottom_px;
    topic.sides = detection.box.sides;
    for (unsigned i = 0; i < sizeof point / sizeof point[0]; i++) {
        topic.u[i] = point[i].u_px;
        topic.v[i] = point[i].v_px;
        topic.points = static_cast<uint8_t>(topic.points | (point[i].visible ? 1u << i : 0u));
    }
    goe_px4::sighting(topic, sighting);
    return __real_goe_flight_frame(flight, &sighting.frame);
}
