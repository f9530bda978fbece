/*
 * The campaign's tables as text: cases.csv and the time series. Meters, degrees, seconds; an empty field: there is no such
 * number. Numbers have 9 significant digits, which preserve the estimates' floats.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#ifndef CAMPAIGN_TEXT_H
#define CAMPAIGN_TEXT_H

#include <stdio.h>

#include "campaign_plan.h"
#include "case_statistics.h"

/* "auto", "disc" or "line" as a setting; "none", "disc", "line", "box" or "prism" of an estimate. */
const char *campaign_text_model(goe_model_t model);

/* "window" or "filter". */
const char *campaign_text_method(goe_method_t method);

void campaign_text_cases_header(FILE *stream);

/* One row: a run over a flight, and statistics of the last fraction of its frames that were solved with setting.model. */
void campaign_text_cases_row(FILE *stream, const planned_flight_t *flight, case_setting_t setting, double fraction,
                             const case_statistics_t *statistics);

/* A run's estimates, their truth and errors, frame by frame. samples: one for each frame of log. */
void campaign_text_series(FILE *stream, const flight_log_t *log, const case_sample_t *samples);

#endif
