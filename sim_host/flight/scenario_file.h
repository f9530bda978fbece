/*
 * A flight past several obstacles, as a file:
 *
 *   # comment
 *   [flight]          any option of goe_sim about flight, camera and sensors, without its dashes
 *   speed = 18
 *   noise = field
 *   [obstacle 1]      counted from 1; of the first one each key may be left out, as on the command line, but not all
 *   what = building   as --obstacle
 *   x0 = -30          to the right is positive
 *   z0 = 300          needed from the second one on
 *   alpha = 20
 *
 * Obstacles do not hide one another.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#ifndef SIM_SCENARIO_FILE_H
#define SIM_SCENARIO_FILE_H

#include <stdbool.h>
#include <stddef.h>

#include "flight_case.h"

#define SCENARIO_NEIGHBORS_MAX 15
#define SCENARIO_REASON_MAX 256

/* Takes an option by its name, from this line; false: reason says why not. */
typedef bool (*scenario_option_t)(const char *name, const char *value, unsigned long line,
                                  char reason[SCENARIO_REASON_MAX]);

typedef struct {
    neighbor_t neighbor[SCENARIO_NEIGHBORS_MAX]; /* obstacles from the second on */
    int neighbors;
} scenario_file_t;

/* The keys of [flight] and, as options obstacle, x0, z0 and alpha, those of the first obstacle go to option. False: fault is
 * "file:line: key: reason". */
bool scenario_file_read(const char *path, scenario_option_t option, scenario_file_t *scenario, char *fault,
                        size_t fault_size);

#endif
