/* The flight layer's decision as commands that a stock autopilot follows. SPDX-License-Identifier: MIT */
#ifndef ORDERS_H
#define ORDERS_H

#include "autopilot.h"
#include "companion_config.h"
#include "goe_flight.h"
#include "goe_mavlink_map.h"
#include "wire.h"

typedef struct {
    goe_flight_action_t action;           /* that stands */
    int32_t target_lat_e7, target_lon_e7; /* as it was sent last ... */
    float target_alt_m;
    int64_t sent_us;
    uint16_t command;     /* whose acknowledgement is awaited; 0: none */
    int resumes_left;     /* px4: times that the mode before may still be asked for */
    uint32_t mode_before; /* px4: in which the order was given ... */
    bool has_led;         /* ... whether it has led to the mode that it leads to ... */
    bool overruled;       /* ... and whether somebody has chosen another one since: then no command follows any more */
    unsigned long orders, refused;
} orders_t;

/* After every assessment. Sends nothing unless the configuration allows it. */
void orders_follow(orders_t *orders, wire_t *wire, const companion_config_t *config, const autopilot_t *autopilot,
                   const goe_flight_t *flight, const goe_flight_assessment_t *assessment, const goe_mavlink_own_t *own,
                   int64_t now_us);

/* COMMAND_ACK of the autopilot. */
void orders_take(orders_t *orders, const mavlink_message_t *message, const autopilot_t *autopilot);

#endif
