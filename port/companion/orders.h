/* The flight layer's decision as commands that a stock autopilot follows. SPDX-License-Identifier: MIT
 *
 * px4:        If reaction.modes names the present mode, an order becomes DO_REPOSITION, repeated until it is acknowledged and sent again
 *             when the target has moved. After the order the companion requests the previous mode if the obstacle is known to be passed;
 *             otherwise the autopilot keeps loitering. A go-around becomes DO_GO_AROUND; in Hold, after another order, it
 *             raises the target, because PX4 flies DO_GO_AROUND only while it lands.
 * arduplane:  ADSB_VEHICLE for all obstacles while the order is active; the autopilot chooses the reaction.
 *
 * The conditions for an order (armed, no failsafe, mode, origin) are checked while it is active. While the autopilot lands, an order that
 * they prevent becomes a go-around, if they do not prevent that. If the pilot chooses another mode (mode_watch.h), no command is sent until
 * all orders have ended. */
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

    goe_flight_action_t action;           /* active order */
    goe_flight_action_t flown;            /* the same, as it is sent: in a landing a hindered side is a go-around */
    int slot;                             /* of its obstacle, or that of the latest order; -1: none, or given up */
    bool overruled;                       /* a pilot chose another mode: nothing is sent until all orders have ended */
    bool denied;                          /* the autopilot denied or does not support a command of this order */
    const char *hindrance;                /* condition that prevents commands now; null: none */
    bool silenced;                        /* overruled, denied, or there is a hindrance */
    bool sent;                            /* a command or traffic was sent since the first of the active orders */
    bool placed;                          /* px4: a target was sent since then, and PX4 has not denied it */
    int32_t target_lat_e7, target_lon_e7; /* target that was sent last */
    float target_alt_m;
    int64_t sent_us;    /* own time of the latest command */
    int64_t traffic_us; /* own time of the latest traffic messages */
    bool gave_up;       /* the layer gave up an obstacle since then: it is not known to be passed */
    uint32_t named;     /* slots of the obstacles that the order was about since then, as bits; not of passed ones */
    uint32_t ids[GOE_FLIGHT_SLOTS]; /* of the obstacles, at the assessment before */
    uint16_t evicted;               /* the flight layer's count, then */
    bool from_landing; /* the autopilot was landing since the first of the active orders: no mode is resumed */
    bool had_failsafe; /* the same of a failsafe */
    bool has_traffic;  /* arduplane: traffic was sent since then */
    bool broke_off;    /* arduplane: an abort of the present landing was requested */
    uint16_t command;  /* command whose acknowledgement is awaited; 0: none */
    mode_watch_t watch;
    screen_t *screen;    /* null: none */
    order_log_t *log;    /* null: none */
    order_left_t active; /* the active order, as in the log */
    bool left_reported;
    order_left_t left;                  /* active order of the log before a restart of the companion */
    goe_flight_assessment_t assessment; /* latest assessment */
    int64_t unix_us, boot_us;           /* its time by the UNIX clock and by the autopilot's clock */
    int resumes_left;                   /* remaining requests for the previous mode */
    unsigned resumed_at;                /* count of heartbeats at the latest of these requests */
    bool awaits_hold;    /* the order ended before a heartbeat showed Hold: the first of these requests waits for it */
    unsigned awaited_at; /* count of heartbeats then */
    unsigned long restarts_counted;
    unsigned long orders, refused; /* numbers of orders and of refusals */
} orders_t;

void orders_init(orders_t *orders, wire_t *wire, const companion_config_t *config, const autopilot_t *autopilot,
                 const goe_flight_t *flight);

/* Takes over an order that was active before a restart of the companion, from the log. */
void orders_take_over(orders_t *orders, const order_left_t *left);

/* To be called after every successful assessment. Sends commands only if the configuration allows it. */
void orders_follow(orders_t *orders, const goe_flight_assessment_t *assessment, const goe_mavlink_own_t *own,
                   int64_t now_us);

/* Processes a COMMAND_ACK of the autopilot; ignores those of other components, and other messages. */
void orders_take(orders_t *orders, const mavlink_message_t *message);

#endif
