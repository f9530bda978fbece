/*
 * The flight layer (port/flight) flown among one to nine obstacles, and judged by what could have been flown instead.
 *
 *   single   one on the course
 *   pair     one on the course and one at a lateral offset of -100 to 100 m, from 40 m before to 60 m behind it
 *   gate     two next to the course, 15 to 60 m of clear width between them, and in half of the flights one behind them on it
 *   wall     three to nine across the course, 20 to 60 m apart
 *   row      two to nine along the course, 40 to 150 m apart
 *   field    one to nine anywhere ahead
 *   between  two, one on each side at twice the margin: no order is due
 *
 * Errors as flown.h has them. An order is obeyed after a delay, by one of two autopilots: one flies parallel to its line, the other flies
 * to the target and circles it, and the layer is set to its radius.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#ifndef SIM_SEVERAL_H
#define SIM_SEVERAL_H

#include <stdbool.h>
#include <stdint.h>

#include "aviation.h"
#include "goe_flight.h"

#define SEVERAL_CLEAR_M 5.0 /* wanted from the nearest wall, wherever a search finds it */

typedef enum {
    SEVERAL_SINGLE,
    SEVERAL_PAIR,
    SEVERAL_GATE,
    SEVERAL_WALL,
    SEVERAL_ROW,
    SEVERAL_FIELD,
    SEVERAL_BETWEEN,
    SEVERAL_KINDS
} several_kind_t;

extern const char *const SEVERAL_NAMES[SEVERAL_KINDS];

typedef struct {
    several_kind_t kind;
    uint64_t seed;
    double obey_s;  /* from an order to its beginning */
    double frame_s; /* from the exposure to the arrival of a frame */
    bool circles;   /* the autopilot flies to the target and circles it */
    bool new_ids;   /* the detector's tracker gives an obstacle that comes back into view a new id */
    bool traced;    /* prints the flight */
} several_case_t;

typedef struct {
    int obstacles;
    double offset_m;  /* of a pair's second obstacle */
    double closest_m; /* of the aircraft's middle from any wall or top */
    bool collided;
    bool ordered, late;
    goe_flight_action_t action; /* the first */
    goe_flight_reason_t reason;
    double ahead_s; /* from the first order to the nearest obstacle on the course */
    int changes;    /* of the side, over the whole flight */
    bool
        possible; /* a plain search over constant turns from the first order on keeps SEVERAL_CLEAR_M from everything */
    bool known;   /* every obstacle had a place in the layer's table at the first order */
    int begun;    /* orders that began: one that follows another without a break is no new one */
    double flown_s;      /* from the start to the end or to the collision */
    double ordered_s;    /* from the start to the first order */
    double arrival_s;    /* of the newest frame at the first order: from its exposure to its arrival */
    double assessment_s; /* from there to the order */
    double delay_s;      /* from there to the moment when the aircraft begins to obey */
    bool obeyed;         /* the first order */
} several_outcome_t;

/* Null and the outcome, or why the case cannot be flown. */
const char *several_fly(const several_case_t *setup, several_outcome_t *outcome);

/* The same flight without orders, in the same wind: the nominal course. The layer does not run, so the outcome has the number of
 * obstacles, closest_m, collided and flown_s alone. */
const char *several_fly_nominal(const several_case_t *setup, several_outcome_t *nominal);

/* What aviation.h counts of a flight and its nominal course. */
aviation_flight_t several_counted(const several_outcome_t *flown, const several_outcome_t *nominal);

/* Whether the flight misses its goals: no collision, SEVERAL_CLEAR_M wherever possible. */
bool several_misses(const several_outcome_t *outcome);

#endif
