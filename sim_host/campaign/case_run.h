/*
 * One estimator over one flight, in-process: bit by bit the result of goe_replay for the flight's log.
 *
 * A log carries every number with enough digits to restore the same double, and goe_replay gives the library the float next to it.
 * Here the doubles go the same way, through the same frame_to_image(), and only their passage through text is left out.
 * The filter method uses case_noise(), which goe_replay takes by --set.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#ifndef CASE_RUN_H
#define CASE_RUN_H

#include "flight_case.h"
#include "goe.h"

/* How a flight is run over. */
typedef struct {
    goe_method_t method;
    goe_model_t model;
    int window;
} case_setting_t;

/* What the estimator says after one frame. */
typedef struct {
    goe_status_t status;
    goe_estimate_t estimate;
    double condition; /* window: of the matrix of (5) behind this frame's solution, see case_statistics.h; or NaN */
} case_sample_t;

/* Settings of the filter method for the sensors: their true errors, as a user knows them from data sheets. Outliers are
 * left to its gate. For boxes the defaults stay, which apply to real detectors and obstacles of any shape. */
void case_noise(const sensor_noise_t *sensors, goe_settings_t *settings);

/* Runs the library over log, which setup flew. samples: room for log->count of them.
 * Null, or the name of the setting that the library refuses. */
const char *case_run(const flight_case_t *setup, const flight_log_t *log, case_setting_t setting,
                     case_sample_t *samples);

#endif
