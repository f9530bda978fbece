/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "scenario.h"

#include <string.h>

typedef struct {
    const char *obstacle;
    double x0_m[3];
    double altitude_m[2];
    int altitudes;
    int orientations; /* 5, or 1: only alpha = 0 */
    double run_s, reach_s;
} table_row_t;

/* Table 2; its column H is the altitude flown */
static const table_row_t TABLE[] = {
    {"cylinder", {0.0, 30.0, 60.0}, {15.0, 0.0}, 1, 1, 19.0, 20.0},
    {"building", {0.0, 75.0, 150.0}, {44.5, 0.0}, 1, 5, 30.0, 40.0},
    {"truck", {0.0, 12.5, 25.0}, {2.5, 5.0}, 2, 5, 18.0, 20.0},
    {"long-truck", {0.0, 12.5, 25.0}, {4.0, 8.0}, 2, 5, 18.0, 20.0},
};
#define TABLE_ROWS ((int)(sizeof TABLE / sizeof TABLE[0]))

static const double ALPHA_DEG[5] = {-45.0, -20.0, 0.0, 20.0, 45.0};
static const double GLIDE_DEG[2] = {0.0, 6.0};
#define SIDE_DISTANCES 3
#define SLOPES 2

static int row_cases(const table_row_t *row) { return SIDE_DISTANCES * row->altitudes * row->orientations * SLOPES; }

int scenario_count(void) {
    int count = 0;
    for (int i = 0; i < TABLE_ROWS; i++) {
        count += row_cases(&TABLE[i]);
    }
    return count;
}

scenario_t scenario_get(int number) {
    const table_row_t *row = TABLE;
    while (row < &TABLE[TABLE_ROWS - 1] && number >= row_cases(row)) {
        number -= row_cases(row);
        row++;
    }
    scenario_t scenario;
    scenario.obstacle = row->obstacle;
    scenario.run_s = row->run_s;
    scenario.reach_s = row->reach_s;
    scenario.glide_deg = GLIDE_DEG[number % SLOPES];
    number /= SLOPES;
    scenario.alpha_deg = row->orientations == 1 ? 0.0 : ALPHA_DEG[number % row->orientations];
    number /= row->orientations;
    scenario.altitude_m = row->altitude_m[number % row->altitudes];
    number /= row->altitudes;
    scenario.x0_m = row->x0_m[number % SIDE_DISTANCES];
    return scenario;
}

bool scenario_find(const char *obstacle, scenario_t *scenario) {
    for (int i = 0; i < TABLE_ROWS; i++) {
        const table_row_t *row = &TABLE[i];
        if (strcmp(row->obstacle, obstacle) == 0) {
            scenario->obstacle = row->obstacle;
            scenario->x0_m = row->x0_m[1];
            scenario->altitude_m = row->altitude_m[0];
            scenario->alpha_deg = 0.0;
            scenario->glide_deg = 0.0;
            scenario->run_s = row->run_s;
            scenario->reach_s = row->reach_s;
            return true;
        }
    }
    return false;
}
