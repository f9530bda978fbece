/*
 * One estimator over one flight, in-process: bit by bit what goe_replay makes of the flight's log.
 *
 * A log carries every number so that the same double comes back, and goe_replay shows the library the float next to it.
 * Here the doubles go the same way, through the same frame_to_image(), and only their passage through text is left out.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#ifndef CASE_RUN_H
#define CASE_RUN_H

#include "flight_case.h"
#include "goe.h"

/* What the estimator says after one frame. */
typedef struct {
    goe_status_t status;
    goe_estimate_t estimate;
    double condition; /* of the matrix of (5) behind a solution from this frame, see case_statistics.h; otherwise NaN */
} case_sample_t;

/* Runs the library over log, which setup flew. samples: room for log->count of them.
 * Null, or the name of the setting that the library refuses. */
const char *case_run(const flight_case_t *setup, const flight_log_t *log, goe_model_t model, int window,
                     case_sample_t *samples);

#endif
