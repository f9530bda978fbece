/* Stand-in, written by this project: only the names that AP_GOE uses. Names and signatures compared with ArduPilot 4.7-dev,
 * commit 90700977c5, on 22 Nov 2026. scripted.cpp implements them. SPDX-License-Identifier: MIT */
#pragma once

#include "GCS_MAVLink.h"

enum MAV_SEVERITY { MAV_SEVERITY_ERROR = 3, MAV_SEVERITY_WARNING = 4, MAV_SEVERITY_INFO = 6 };

class GCS_MAVLINK {
  public:
    bool is_active() const;
    bool is_private() const;
    mavlink_channel_t get_chan() const { return channel; }
    static uint8_t packet_overhead_chan(mavlink_channel_t channel);

    mavlink_channel_t channel;
};

class GCS {
  public:
    uint8_t num_gcs() const;
    GCS_MAVLINK *chan(uint8_t i);
    void send_text(MAV_SEVERITY severity, const char *format, ...) __attribute__((format(printf, 3, 4)));
};

GCS &gcs();

#define GCS_SEND_TEXT(severity, ...) gcs().send_text(severity, __VA_ARGS__)
