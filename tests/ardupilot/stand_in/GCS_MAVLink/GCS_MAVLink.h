/* Stand-in, written by this project: only the names that AP_GOE uses. Names and signatures compared with ArduPilot 4.7-dev,
 * commit 90700977c5, on 22 Nov 2026. scripted.cpp implements them. SPDX-License-Identifier: MIT */
#pragma once

#include <cstdint>

#define MAVLINK_STATUS_FLAG_OUT_MAVLINK1 2

enum mavlink_channel_t { MAVLINK_COMM_0, MAVLINK_COMM_1, MAVLINK_COMM_2 };

struct mavlink_status_t;

struct mavlink_signing_t {
    bool (*accept_unsigned_callback)(const mavlink_status_t *status, uint32_t msgid);
};

struct mavlink_status_t {
    uint8_t flags;
    mavlink_signing_t *signing;
};

struct mavlink_message_t {
    uint16_t checksum;
    uint8_t magic, len, incompat_flags, compat_flags, seq, sysid, compid;
    uint32_t msgid;
    uint64_t payload64[33];
};

struct mavlink_system_t {
    uint8_t sysid, compid;
};

#define _MAV_PAYLOAD(message) (reinterpret_cast<const char *>(&(message)->payload64[0]))

extern mavlink_system_t mavlink_system;
mavlink_status_t *mavlink_get_channel_status(uint8_t channel);
uint16_t comm_get_txspace(mavlink_channel_t channel);
void _mav_finalize_message_chan_send(mavlink_channel_t channel, uint32_t msgid, const char *packet, uint8_t min_length,
                                     uint8_t length, uint8_t crc_extra);
