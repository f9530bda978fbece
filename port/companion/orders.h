/* The flight layer's decision as commands that a stock autopilot follows. SPDX-License-Identifier: MIT
 *
 * px4, an order:  given in a mode that reaction.modes names > DO_REPOSITION until it is acknowledged, again as its target moves >
 *                 the obstacle is passed: back into the mode before; not known to be passed: it stays where it loiters
 *                 another mode was chosen meanwhile: nothing more is sent until the next order
 * arduplane:      ADSB_VEHICLE for as long as the order stands; what comes of it is the autopilot's affair */
#ifndef ORDERS_H
#define ORDERS_H

#include "autopilot.h"
#include "companion_config.h"
#include "goe_flight.h"
#include "goe_mavlink_map.h"
#include "wire.h"

typedef struct {
    wire_t *wire;
    const companion_config_t *config;
    const autopilot_t *autopilot;
    const goe_flight_t *flight;

    goe_flight_action_t action; /* that stands */
    int slot;                   /* what it is about, as last known; -1: none */
    bool overruled;             /* a pilot chose another mode: nothing is sent until all orders have ended */
    bool silenced; /* nothing is sent for this action: that, or the autopilot's mode, kind or answer forbids it */
    int32_t target_lat_e7, target_lon_e7; /* as it was sent last ... */
    float target_alt_m;
    int64_t sent_us;
    uint16_t command;     /* whose acknowledgement is awaited; 0: none */
    unsigned answered_at; /* count of heartbeats when it came */
    unsigned judged_at;   /* count of heartbeats by which the mode was looked at last */
    uint32_t mode_before; /* in which the order was given */
    int resumes_left;     /* times that it may still be asked for */
    unsigned resumed_at;  /* count of heartbeats when it was asked for last */
    unsigned long restarts_seen;
    unsigned long orders, refused; /* counted */
} orders_t;

void orders_init(orders_t *orders, wire_t *wire, const companion_config_t *config, const autopilot_t *autopilot,
                 const goe_flight_t *flight);

/* After every assessment that succeeded. Sends nothing unless the configuration allows it. */
void orders_follow(orders_t *orders, const goe_flight_assessment_t *assessment, const goe_mavlink_own_t *own,
                   int64_t now_us);

/* COMMAND_ACK of the autopilot. */
void orders_take(orders_t *orders, const mavlink_message_t *message);

#endif
