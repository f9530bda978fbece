/*
 * Every flight of the campaign and its runs.
 *
 *   paper         Table 2: pixels rounded, straight, 17 m/s, still air; boxes with the paper's switching (auto) and with the
 *                 disc forced all the time, the cylinder with the disc
 * and beyond it, Table 2 (orientations -20, 0 and 45) flown again with one thing changed, boxes with the paper's switching:
 *   arc, weave, ramp              curved paths and a changing speed
 *   wind                          turbulence
 *   attitude, position, field     errors of the own attitude, of the own position and height, and all sensors of the field
 *   conditioning  one obstacle of each type at its middle side distance, turned by 20 degrees, in level flight; from there
 *                 one at a time: window, side distance, orientation, image rate
 *   boxes         Table 2 level, lowest and at those orientations, with upright boxes instead of points and all sensors of
 *                 the field, from an aircraft that rolls by 0, 5, 10 and 25 degrees
 * The above are runs of the window method. Over every flight goes the filter method too, once, with its own choice of the
 * model and the flight's noise as its settings.
 *
 * A seed names the random numbers. Without random errors it still distinguishes runs: it sets how far into an interval
 * between two images the run starts, so that pixels are rounded differently. Seed 1 starts as Table 2 says.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#ifndef CAMPAIGN_PLAN_H
#define CAMPAIGN_PLAN_H

#include <stdbool.h>
#include <stddef.h>

#include "case_run.h"
#include "flight_case.h"
#include "goe.h"

typedef enum {
    STUDY_PAPER,
    STUDY_ARC,
    STUDY_WEAVE,
    STUDY_RAMP,
    STUDY_WIND,
    STUDY_ATTITUDE,
    STUDY_POSITION,
    STUDY_FIELD,
    STUDY_CONDITIONING,
    STUDY_BOXES,
    STUDY_COUNT
} study_t;

extern const char *const STUDY_NAMES[STUDY_COUNT];

#define STUDY_GROUPS "paper, paths, wind, noise, conditioning, boxes or all"
#define PLAN_RUNS_MAX 12
#define PLAN_WINDOW 8                     /* points, as in the paper */
#define PLAN_FIRST_CONDITIONING_CASE 1000 /* cases of other studies bear their number in Table 2 */

typedef struct {
    study_t study;
    int number; /* case */
    int seed;
    const char *obstacle, *path, *speed_profile, *wind, *noise; /* as goe_sim's options name them, or a study's name */
    flight_case_t setup;
    case_setting_t run[PLAN_RUNS_MAX];
    int runs;
} planned_flight_t;

typedef struct {
    planned_flight_t *flights; /* by study, then seed, then case */
    size_t count;
} campaign_plan_t;

/* Reads names from STUDY_GROUPS, separated by commas, into a set of 1u << study_t. False: *bad (of bad_size) is the first
 * name that is none of them. */
bool campaign_plan_studies(const char *text, unsigned *studies, char *bad, size_t bad_size);

/* Seeds 1 to seeds. False if memory is short. */
bool campaign_plan_make(unsigned studies, int seeds, campaign_plan_t *plan);

/* Keeps part 1 to parts of the flights, in their order; parts that follow one another make the whole plan. */
void campaign_plan_keep_part(campaign_plan_t *plan, int part, int parts);

void campaign_plan_free(campaign_plan_t *plan);

#endif
