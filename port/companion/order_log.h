/* Orders in the log: orders.csv, next to frames.csv. SPDX-License-Identifier: MIT
 *
 * A row for each order, command, acknowledgement and end; on the disk at once. By its last row a companion that was restarted knows
 * of the order that it left. */
#ifndef ORDER_LOG_H
#define ORDER_LOG_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "goe_flight.h"

typedef struct {
    FILE *stream; /* null: there is no log */
} order_log_t;

/* The rest of an active order: enough to return from it. */
typedef struct {
    bool active;
    unsigned action; /* goe_flight_action_t */
    uint32_t mode_before;
    int64_t unix_us, boot_us; /* when this was written, by both clocks */
    float course_ne[2];       /* when it was given */
    float obstacle_ne_m[2], radius_m;
} order_left_t;

typedef struct {
    const char *event; /* a word */
    order_left_t left;
    uint32_t mode; /* of the autopilot now */
    unsigned obstacle_id;
    int slot;
    float tcpa_s, dcpa_m; /* of the hazard */
    int32_t target_lat_e7, target_lon_e7;
    float target_alt_m;
    const char *why; /* or an empty text */
} order_row_t;

/* Makes orders.csv in the folder. False: it cannot be written. */
bool order_log_open(order_log_t *log, const char *folder);

void order_log_put(order_log_t *log, const order_row_t *row);

void order_log_close(order_log_t *log);

/* What the last row of orders.csv in the folder leaves. False: there is none, or its order has ended. */
bool order_log_read(const char *folder, order_left_t *left);

#endif
