/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "avoidance.h"

#include <math.h>
#include <string.h>

#include "flown.h"

#define STREAM_AVOID 100 /* far from those of random.h */
#define REACH_S 22.0     /* from the start to the obstacle */
#define AFTER_S 6.0
#define OBEY_S 0.5
#define GLIDE_DEG 3.0
#define GO_AROUND_M 40.0

const char *const AVOID_NAMES[AVOID_KINDS] = {"mast", "building", "truck"};

bool avoid_is_pass(const avoid_case_t *setup) { return setup->pass_m >= 0.0; }

typedef struct {
    const avoid_case_t *setup;
    flown_t flown;
    bool approach;
    double height_m, glide_rad;
    goe_flight_assessment_t order, obeyed; /* the latest, and the one that is carried out */
    double order_s;
    int wrong_times[GOE_FLIGHT_SLOTS]; /* assessments in a row */
} run_t;

/* ------------------------------------------------------------------------------------------------------------- scene -- */

static void shape(run_t *run, random_t *random) {
    obstacle_t *o = &run->flown.obstacle[0];
    o->kind = run->setup->kind == AVOID_MAST ? OBSTACLE_CYLINDER : OBSTACLE_BOX;
    switch (run->setup->kind) {
        case AVOID_MAST:
            o->width_m = o->length_m = flown_between(random, 2.0, 8.0);
            o->height_m = flown_between(random, 35.0, 80.0);
            break;
        case AVOID_BUILDING:
            o->width_m = flown_between(random, 6.0, 20.0);
            o->length_m = flown_between(random, 6.0, 20.0);
            o->height_m = flown_between(random, 20.0, 40.0);
            break;
        case AVOID_TRUCK:
        case AVOID_KINDS:
        default:
            o->width_m = 2.5;
            o->length_m = flown_between(random, 6.0, 16.0);
            o->height_m = flown_between(random, 2.6, 4.0);
            break;
    }
    run->height_m = run->approach ? 1.5 : flown_between(random, 15.0, fmin(0.9 * o->height_m, 40.0));
}

static void place(run_t *run, random_t *random) {
    flown_t *flown = &run->flown;
    obstacle_t *o = &flown->obstacle[0];
    flown->obstacles = 1;
    flown->reach_m = flown->speed_mps * REACH_S;
    o->heading_rad = flown_between(random, -SIM_PI, SIM_PI);
    const double side = random_uniform(random) < 0.5 ? -1.0 : 1.0;
    const double off_m = flown_between(random, -2.0, 2.0);
    const bool passes = avoid_is_pass(run->setup);
    flown_put(flown, o, flown->reach_m,
              passes ? side * (run->setup->pass_m + flown_half_across_m(o, flown->course_rad)) : off_m);
}

static double height_on_path(const run_t *run, double along_m) {
    return run->height_m + (run->flown.reach_m - along_m) * tan(run->glide_rad);
}

static const char *begin(run_t *run) {
    flown_t *flown = &run->flown;
    random_t random = random_start(run->setup->seed, STREAM_AVOID);
    run->approach = run->setup->kind == AVOID_TRUCK;
    run->glide_rad = run->approach ? radians(GLIDE_DEG) : 0.0;
    flown->frame_s = run->setup->delay_s;
    flown->course_rad = flown_between(&random, -SIM_PI, SIM_PI);
    flown->speed_mps = flown_between(&random, 14.0, 22.0);
    flown->rolls = random_uniform(&random) < 0.5;
    flown->drops = random_uniform(&random) < 0.5;
    shape(run, &random);
    place(run, &random);
    const char *fault =
        flown_start(flown, &random, run->setup->seed, run->setup->seed, height_on_path(run, 0.0), -run->glide_rad);
    return fault ? fault : flown_start_layer(flown, 0.0);
}

/* ---------------------------------------------------------------------------------------------------------- aircraft -- */

static void steer(const run_t *run, guidance_t *guidance, double along_m, double right_m) {
    const goe_flight_assessment_t *o = &run->obeyed;
    const vec3_t at = run->flown.aircraft.state.position_ned_m;
    double target_along_m, target_right_m;
    flown_on_path(&run->flown, (double)o->target_ned_m[0], (double)o->target_ned_m[1], &target_along_m,
                  &target_right_m);
    switch (o->action) {
        case GOE_FLIGHT_LEFT:
        case GOE_FLIGHT_RIGHT:
            guidance->cross_track_m = right_m - target_right_m;
            break;
        case GOE_FLIGHT_CLIMB:
            guidance->height_error_m = -(double)o->target_ned_m[2] + at.z;
            break;
        case GOE_FLIGHT_GO_AROUND:
            guidance->height_error_m = fmax(-(double)o->target_ned_m[2], GO_AROUND_M) + at.z;
            guidance->climb_rad = 0.0;
            break;
        case GOE_FLIGHT_HOLD:
            guidance->path_course_rad = atan2((double)o->target_ned_m[1] - at.y, (double)o->target_ned_m[0] - at.x);
            guidance->cross_track_m = 0.0;
            break;
        case GOE_FLIGHT_NONE:
        default:
            guidance->height_error_m = height_on_path(run, along_m) + at.z;
            break;
    }
}

static void step(run_t *run) {
    const aircraft_state_t *state = &run->flown.aircraft.state;
    double along_m, right_m;
    flown_on_path(&run->flown, state->position_ned_m.x, state->position_ned_m.y, &along_m, &right_m);
    guidance_t guidance;
    memset(&guidance, 0, sizeof guidance);
    guidance.airspeed_mps = run->flown.speed_mps;
    guidance.height_error_m = height_on_path(run, along_m) + state->position_ned_m.z;
    guidance.climb_rad = -run->glide_rad;
    guidance.cross_track_m = right_m;
    guidance.path_course_rad = run->flown.course_rad;
    steer(run, &guidance, along_m, right_m);
    flown_step(&run->flown, &guidance);
}

/* ------------------------------------------------------------------------------------------------------------- layer -- */

static void note_order(const run_t *run, const goe_flight_assessment_t *now, avoid_outcome_t *outcome) {
    double along_m, right_m;
    const vec3_t at = run->flown.aircraft.state.position_ned_m;
    flown_on_path(&run->flown, at.x, at.y, &along_m, &right_m);
    outcome->ordered = true;
    outcome->late = now->late;
    outcome->action = now->action;
    outcome->ahead_s = (run->flown.reach_m - along_m) / run->flown.speed_mps;
}

/* The middle's error in its own sigmas, squared: e' C^-1 e. The middle counts from the place that the autopilot reports, which drifts. */
static double off_sigmas_squared(const goe_flight_obstacle_t *found, const obstacle_t *truth, vec3_t drift_m) {
    const double n = (double)found->center_ned_m[0] - truth->center_n_m - drift_m.x;
    const double e = (double)found->center_ned_m[1] - truth->center_e_m - drift_m.y;
    const double nn = (double)found->covariance_ne_m2[0], ne = (double)found->covariance_ne_m2[1];
    const double ee = (double)found->covariance_ne_m2[2], determinant = nn * ee - ne * ne;
    return determinant > 0.0 ? (ee * n * n - 2.0 * ne * n * e + nn * e * e) / determinant : HUGE_VAL;
}

static void judge_places(run_t *run, avoid_outcome_t *outcome) {
    const vec3_t drift_m = sensors_drift(&run->flown.sensors[0], run->flown.t_s);
    for (int slot = 0; slot < GOE_FLIGHT_SLOTS; slot++) {
        goe_flight_obstacle_t found;
        const bool known = goe_flight_obstacle(&run->flown.flight, slot, &found) == GOE_FLIGHT_OK &&
                           (found.valid & GOE_HAS_POSITION) != 0u;
        const bool wrong =
            known && !found.suspect &&
            off_sigmas_squared(&found, &run->flown.obstacle[0], drift_m) > AVOID_WRONG_SIGMAS * AVOID_WRONG_SIGMAS;
        run->wrong_times[slot] = wrong ? run->wrong_times[slot] + 1 : 0;
        outcome->confident = outcome->confident || run->wrong_times[slot] >= AVOID_WRONG_TIMES;
    }
}

static void assess(run_t *run, avoid_outcome_t *outcome) {
    goe_flight_assessment_t now;
    if (goe_flight_assess(&run->flown.flight, flown_clock_us(run->flown.t_s), run->approach, &now) != GOE_FLIGHT_OK) {
        return;
    }
    judge_places(run, outcome);
    if (now.action != GOE_FLIGHT_NONE && !outcome->ordered) {
        note_order(run, &now, outcome);
    }
    if (!outcome->ordered && now.worst >= 0) {
        outcome->assessed++;
        outcome->suspect += now.suspect ? 1 : 0;
    }
    if (now.action != run->order.action) {
        run->order_s = run->flown.t_s;
    }
    run->order = now;
    if (run->setup->reacts && run->flown.t_s >= run->order_s + OBEY_S) {
        if (run->obeyed.action != GOE_FLIGHT_GO_AROUND) { /* that is flown to its end */
            run->obeyed = run->order;
        }
    }
}

/* ----------------------------------------------------------------------------------------------------------- outcome -- */

static void note_place(const run_t *run, avoid_outcome_t *outcome) {
    const vec3_t at = run->flown.aircraft.state.position_ned_m;
    double along_m, right_m;
    flown_on_path(&run->flown, at.x, at.y, &along_m, &right_m);
    outcome->closest_m = fmin(outcome->closest_m, flown_distance_m(&run->flown.obstacle[0], at.x, at.y, -at.z));
    outcome->height_gained_m = fmax(outcome->height_gained_m, -at.z - height_on_path(run, along_m));
    outcome->collided = outcome->closest_m < FLOWN_COLLISION_M || (outcome->ordered && at.z > -FLOWN_GROUND_M);
}

const char *avoid_fly(const avoid_case_t *setup, avoid_outcome_t *outcome) {
    static run_t run; /* 60 kB */
    memset(&run, 0, sizeof run);
    memset(outcome, 0, sizeof *outcome);
    outcome->closest_m = HUGE_VAL;
    run.setup = setup;
    const char *fault = begin(&run);
    const int steps = fault ? 0 : (int)((REACH_S + AFTER_S) / AIRCRAFT_STEP_S);
    for (int k = 0; k < steps && !outcome->collided; k++) {
        flown_sense(&run.flown, k);
        if (k % FLOWN_ASSESS_STEPS == 0) {
            assess(&run, outcome);
        }
        step(&run);
        note_place(&run, outcome);
        if (run.flown.aircraft.state.position_ned_m.z > -FLOWN_GROUND_M) {
            break; /* it has landed */
        }
    }
    return fault;
}
