/* The companion's reports over MAVLink. SPDX-License-Identifier: MIT */
#ifndef REPORTS_H
#define REPORTS_H

#include "autopilot.h"
#include "companion_config.h"
#include "goe_flight.h"
#include "goe_mavlink_map.h"
#include "wire.h"

/* Delays from the exposure to the arrival, since the previous GOE_STATUS. */
typedef struct {
    double sum_ms, most_ms;
    unsigned images;
    unsigned long all_images; /* since the start */
} delay_count_t;

/* Position and time of the aircraft for the messages. */
goe_mavlink_own_t reports_own(const autopilot_t *autopilot, int64_t now_us, int64_t unix_us);

/* Sends obstacles and hazards, and the standard messages that the configuration names. */
void reports_send_obstacles(wire_t *wire, const companion_config_t *config, const goe_flight_t *flight,
                            const goe_flight_assessment_t *assessment, const goe_mavlink_own_t *own);

/* Sends a heartbeat and GOE_STATUS. */
void reports_send_status(wire_t *wire, const goe_flight_t *flight, const goe_flight_assessment_t *assessment,
                         const goe_mavlink_own_t *own, const delay_count_t *delay, unsigned self_check);

#endif
