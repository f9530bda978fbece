/* The log: camera.ini and frames.csv, what goe_replay reads. SPDX-License-Identifier: MIT */
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
    order_left_t left; /* what the log before this one leaves of an order */
    unsigned long rows;
    int64_t latest_us,
        shift_us; /* time of the latest row; offset that keeps times increasing when the autopilot restarts */
    double written_mb, size_max_mb;
    bool failed; /* ended, as the disk did not take it */
} flight_record_t;

/* Makes the folder, with a copy of the camera's file. An old log there is not overwritten: then it is the first of folder-2,
 * folder-3, ... without one, and of the latest of them is read what it leaves. A folder that cannot be written is a failure. Nothing is
 * done without a folder's name. */
bool flight_record_open(flight_record_t *record, const companion_config_t *config, char *fault, size_t fault_size);

/* The detections of a frame that was taken, with the pose at its exposure. */
void flight_record_put(flight_record_t *record, const goe_flight_t *flight, const goe_flight_frame_t *frame,
                       const autopilot_t *autopilot);

/* To be called once a second: writes the rows to the disk. */
void flight_record_flush(flight_record_t *record);

void flight_record_close(flight_record_t *record);

#endif
