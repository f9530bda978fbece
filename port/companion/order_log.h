/* Orders in the log: orders.csv, next to frames.csv. SPDX-License-Identifier: MIT
 *
 * The file has a row for each order, command, acknowledgement and end. Each row goes to the operating system at once, so it outlives the
 * companion. A wait for the disk delays poses and commands in flight. Therefore, only the row with which an order is no longer active waits:
 * a loss of power makes no order active again. After a restart the companion reads the last row, which shows the order that was active. */
#ifndef ORDER_LOG_H
#define ORDER_LOG_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "goe_flight.h"

typedef struct {
    FILE *stream; /* null: there is no log */
    bool active;  /* the latest row's order is */
} order_log_t;

/* Data of an active order that the companion needs to return from it after a restart. */
typedef struct {
    bool active;
    unsigned action; /* goe_flight_action_t */
    uint32_t mode_before;
    int64_t unix_us, boot_us; /* time of the row by the UNIX clock and by the autopilot's clock */
    float course_ne[2];       /* course when the order was given */
    float obstacle_ne_m[2], radius_m;
} order_left_t;

typedef struct {
    const char *event; /* kind of the row */
    order_left_t left;
    uint32_t mode; /* present mode of the autopilot */
    unsigned obstacle_id;
    int slot;
    float tcpa_s, dcpa_m; /* hazard of the worst obstacle */
    int32_t target_lat_e7, target_lon_e7;
    float target_alt_m;
    const char *why; /* reason of the event, or an empty text */
} order_row_t;

/* Creates orders.csv in the folder. Returns false if it cannot be written. */
bool order_log_open(order_log_t *log, const char *folder);

void order_log_put(order_log_t *log, const order_row_t *row);

void order_log_close(order_log_t *log);

/* Reads the last row of orders.csv in the folder. Returns false if there is none, or if its order is not active. */
bool order_log_read(const char *folder, order_left_t *left);

#endif
