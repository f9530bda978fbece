/* The flight layer's decision as commands that a stock autopilot follows. SPDX-License-Identifier: MIT
 *
 * px4, an order:  given in a mode that reaction.modes names > DO_REPOSITION until it is acknowledged, again as its target moves >
 *                 the obstacle is passed: back into the previous mode; not known to be passed: it stays where it loiters
 * arduplane:      ADSB_VEHICLE of all obstacles while the order is active; the autopilot decides on the reaction
 *
 * The conditions for an order (armed, mode, origin) are checked while it is active. A mode that the pilot chose (mode_watch.h)
 * stops all commands until all orders have ended. */
#ifndef ORDERS_H
#define ORDERS_H

#include "autopilot.h"
#include "companion_config.h"
#include "goe_flight.h"
#include "goe_mavlink_map.h"
#include "mode_watch.h"
#include "order_log.h"
#include "screen.h"
#include "wire.h"

typedef struct {
    wire_t *wire;
    const companion_config_t *config;
    const autopilot_t *autopilot;
    const goe_flight_t *flight;

    goe_flight_action_t action;           /* the active one */
    int slot;                             /* of its obstacle, as last known; -1: none */
    bool overruled;                       /* a pilot chose another mode: nothing is sent until all orders have ended */
    bool denied;                          /* the autopilot did, for this action */
    const char *hindrance;                /* why nothing can be sent now; null: nothing hinders */
    bool silenced;                        /* one of these */
    bool sent;                            /* a command or traffic, since the first of the orders that stand */
    int32_t target_lat_e7, target_lon_e7; /* as it was sent last ... */
    float target_alt_m;
    int64_t sent_us;    /* a command ... */
    int64_t traffic_us; /* ... and traffic */
    bool broke_off;     /* arduplane: an abort of the present landing was requested */
    uint16_t command;   /* whose acknowledgement is awaited; 0: none */
    mode_watch_t watch;
    screen_t *screen;    /* null: none */
    order_log_t *log;    /* null: none */
    order_left_t active; /* the active order as in the log ... */
    bool left_reported;
    order_left_t left;                  /* ... and what of one a companion before this one left */
    goe_flight_assessment_t assessment; /* the latest */
    int64_t unix_us, boot_us;           /* ... and when it was, by both clocks */
    int resumes_left;                   /* requests left */
    unsigned resumed_at;                /* count of heartbeats at the latest request */
    unsigned long restarts_counted;
    unsigned long orders, refused; /* counted */
} orders_t;

void orders_init(orders_t *orders, wire_t *wire, const companion_config_t *config, const autopilot_t *autopilot,
                 const goe_flight_t *flight);

/* An order that a companion before this one left standing, as its log has it. */
void orders_take_over(orders_t *orders, const order_left_t *left);

/* After every assessment that succeeded. Sends nothing unless the configuration allows it. */
void orders_follow(orders_t *orders, const goe_flight_assessment_t *assessment, const goe_mavlink_own_t *own,
                   int64_t now_us);

/* COMMAND_ACK of the autopilot. */
void orders_take(orders_t *orders, const mavlink_message_t *message);

#endif
