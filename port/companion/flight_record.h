/* The log: camera.ini and frames.csv, which goe_replay reads, and orders.csv. SPDX-License-Identifier: MIT */
#ifndef FLIGHT_RECORD_H
#define FLIGHT_RECORD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "autopilot.h"
#include "companion_config.h"
#include "goe_flight.h"
#include "order_log.h"

typedef struct {
    FILE *stream; /* null: there is no log, or it has ended */
    order_log_t orders;
    order_left_t left; /* active order in the previous log */
    unsigned long rows;
    int64_t latest_us,
        shift_us; /* time of the latest row; offset that keeps times increasing when the autopilot restarts */
    double written_mb, size_max_mb;
    bool failed; /* a write failed and ended the log */
} flight_record_t;

/* Creates the folder of the log, with a copy of the camera's file. If record.folder already has a log, the new log goes to the first of
 * folder-2, folder-3, ... without a log, and `left` comes from the log before it. Does nothing if record.folder is empty. Returns false
 * if the files cannot be created. */
bool flight_record_open(flight_record_t *record, const companion_config_t *config, char *fault, size_t fault_size);

/* Adds the detections of an accepted frame, with the pose at its exposure. */
void flight_record_put(flight_record_t *record, const goe_flight_t *flight, const goe_flight_frame_t *frame,
                       const autopilot_t *autopilot);

/* To be called once a second: hands the rows to the operating system. */
void flight_record_flush(flight_record_t *record);

void flight_record_close(flight_record_t *record);

#endif
