/*
 * The flight layer (port/flight) flown: an aircraft with its autopilot, a camera with a detector whose frames come late, and the
 * orders of the layer carried out, or not.
 *
 *   mast, building   level flight below the top; an order's side, climb or loitering is flown
 *   truck            a landing approach of 3 degrees that ends at the truck's middle; the order is to go around
 *
 * The aircraft meets the obstacle's middle, up to 2 m aside of it; or passes its outline at a given distance, on either
 * side. Errors as flown.h has them. An order is carried out half a second after it was given.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#ifndef SIM_AVOIDANCE_H
#define SIM_AVOIDANCE_H

#include <stdbool.h>
#include <stdint.h>

#include "goe_flight.h"

#define AVOID_WRONG_SIGMAS 5.0
#define AVOID_WRONG_TIMES 5

typedef enum { AVOID_MAST, AVOID_BUILDING, AVOID_TRUCK, AVOID_KINDS } avoid_kind_t;

extern const char *const AVOID_NAMES[AVOID_KINDS];

typedef struct {
    avoid_kind_t kind;
    uint64_t seed;
    double pass_m;  /* distance of the path from the outline; negative: a collision course */
    bool reacts;    /* orders are carried out */
    double delay_s; /* from the exposure to the arrival of a frame */
} avoid_case_t;

typedef struct {
    double closest_m; /* of the aircraft's middle from the obstacle's walls and top, in space; 0: inside */
    bool collided;    /* closer than FLOWN_COLLISION_M, or into the ground */
    bool ordered, late;
    goe_flight_action_t action; /* the first */
    double ahead_s;             /* the first order came this long before the obstacle would be reached */
    int suspect, assessed;      /* assessments with a position, until the first order */
    double height_gained_m;     /* highest over the path */
    bool
        confident; /* AVOID_WRONG_TIMES assessments in a row had an obstacle's middle more than AVOID_WRONG_SIGMAS of its
                                   own sigmas off, and nothing said that it was suspect */
} avoid_outcome_t;

/* Not a collision course. */
bool avoid_is_pass(const avoid_case_t *setup);

/* Null and the outcome, or why the case cannot be flown. */
const char *avoid_fly(const avoid_case_t *setup, avoid_outcome_t *outcome);

#endif
