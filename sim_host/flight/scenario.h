/*
 * The paper's campaign: Tables 1 and 2, all orientations, both slopes.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#ifndef SIM_SCENARIO_H
#define SIM_SCENARIO_H

#include <stdbool.h>

typedef struct {
    const char *obstacle; /* name for obstacle_parse */
    double x0_m;          /* side distance, to the left */
    double altitude_m;    /* over ground, where the obstacle would be reached */
    double alpha_deg;     /* orientation */
    double glide_deg;     /* slope, positive down */
    double run_s, reach_s;
} scenario_t;

#define SCENARIO_SPEED_MPS 17.0
#define SCENARIO_FPS_HZ 8.0

/* Number of cases, 156: cylinder 6, building 30, truck 60, long truck 60, in this order. */
int scenario_count(void);

/* Case 0 to scenario_count() - 1. Slope varies fastest, then orientation, altitude, side distance, obstacle. */
scenario_t scenario_get(int number);

/* The named obstacle at its middle side distance and first altitude, orientation 0, level flight; false if Table 1 has no
 * such obstacle. */
bool scenario_find(const char *obstacle, scenario_t *scenario);

#endif
