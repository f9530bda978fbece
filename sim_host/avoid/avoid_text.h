/*
 * A run of goe_avoid as a row of CSV.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#ifndef SIM_AVOID_TEXT_H
#define SIM_AVOID_TEXT_H

#include <stdbool.h>
#include <stdio.h>

#include "avoidance.h"

typedef struct {
    avoid_case_t setup;            /* of the flight without */
    avoid_outcome_t without, with; /* orders carried out; a pass is flown without alone */
} avoid_run_t;

/* Of the flight whose orders count. */
const avoid_outcome_t *avoid_run_ordered(const avoid_run_t *run);

/* A false order: of a pass. */
bool avoid_run_is_false(const avoid_run_t *run);

void avoid_text_header(FILE *stream);

/* An empty field: not flown, or not applicable. margin_m: of the flight layer's settings. */
void avoid_text_row(FILE *stream, const avoid_run_t *run, double margin_m);

#endif
