/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "several.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "flown.h"

#define STREAM_SEVERAL 101 /* far from those of random.h */
#define REACH_S 18.0       /* from the start to the first obstacle */
#define AFTER_S 22.0
#define CIRCLE_M 80.0 /* that the autopilot which circles is set to */
#define CAPTURE 4.0   /* how steeply it heads for its circle */
#define BANK_DEG 30.0 /* of the search's turns */
#define BANKS 12      /* to each side */
#define ROLL_IN_S 0.5 /* of the search, behind the delay */
#define SEARCH_S 15.0
#define SEARCH_STEP_S 0.05
#define UNORDERED_S 6.0 /* the search begins this long before the closest approach, if there was no order */
#define OFFSETS 21
#define TRACE_MAX 4096

const char *const SEVERAL_NAMES[SEVERAL_KINDS] = {"single", "pair", "gate", "wall", "row", "field", "between"};

typedef struct {
    const several_case_t *setup;
    flown_t flown;
    double height_m;
    goe_flight_assessment_t given[TRACE_MAX]; /* each assessment */
    int assessed;
    goe_flight_assessment_t obeyed;
    int side;              /* of the latest order */
    double search_at[4];   /* north, east, and their speeds */
    double search_reach_s; /* the delay, and the roll */
} run_t;

/* ------------------------------------------------------------------------------------------------------------- scene -- */

static int among(random_t *random, int least, int most) {
    return least + (int)(random_uniform(random) * (most - least + 1) * 0.999999);
}

/* A mast, or in one of four a building. */
static void shape(obstacle_t *o, random_t *random) {
    const bool mast = random_uniform(random) < 0.75;
    o->kind = mast ? OBSTACLE_CYLINDER : OBSTACLE_BOX;
    o->width_m = flown_between(random, mast ? 2.0 : 6.0, mast ? 8.0 : 16.0);
    o->length_m = mast ? o->width_m : flown_between(random, 6.0, 16.0);
    o->height_m = flown_between(random, 45.0, 80.0);
    o->heading_rad = flown_between(random, -SIM_PI, SIM_PI);
}

/* along: behind the reach, right: of the course. */
static obstacle_t *put(run_t *run, random_t *random, double along_m, double right_m) {
    obstacle_t *o = &run->flown.obstacle[run->flown.obstacles++];
    shape(o, random);
    flown_put(&run->flown, o, run->flown.reach_m + along_m, right_m);
    return o;
}

static void move_aside(const run_t *run, obstacle_t *o, double right_m) {
    o->center_n_m -= sin(run->flown.course_rad) * right_m;
    o->center_e_m += cos(run->flown.course_rad) * right_m;
}

/* Two of this clear width between them, the course up to off_m right of the middle. */
static void put_gate(run_t *run, random_t *random, double width_m, double off_m, double apart_m) {
    for (int side = -1; side <= 1; side += 2) {
        obstacle_t *o = put(run, random, side * 0.5 * apart_m, 0.0);
        move_aside(run, o, side * (0.5 * width_m + flown_half_across_m(o, run->flown.course_rad)) - off_m);
    }
}

static bool is_apart(const run_t *run, double least_m) {
    const obstacle_t *last = &run->flown.obstacle[run->flown.obstacles - 1];
    for (int i = 0; i < run->flown.obstacles - 1; i++) {
        if (hypot(run->flown.obstacle[i].center_n_m - last->center_n_m,
                  run->flown.obstacle[i].center_e_m - last->center_e_m) < least_m) {
            return false;
        }
    }
    return true;
}

static void put_field(run_t *run, random_t *random, int wanted) {
    for (int tries = 0; tries < 100 && run->flown.obstacles < wanted; tries++) {
        (void)put(run, random, flown_between(random, -60.0, 300.0), flown_between(random, -120.0, 120.0));
        run->flown.obstacles -= is_apart(run, 30.0) ? 0 : 1;
    }
}

static void place(run_t *run, random_t *random, several_outcome_t *outcome) {
    goe_flight_settings_t settings;
    goe_flight_settings_default(&settings);
    switch (run->setup->kind) {
        case SEVERAL_SINGLE:
            (void)put(run, random, 0.0, flown_between(random, -2.0, 2.0));
            break;
        case SEVERAL_PAIR:
            outcome->offset_m = -100.0 + 10.0 * among(random, 0, OFFSETS - 1) + flown_between(random, -5.0, 5.0);
            (void)put(run, random, 0.0, flown_between(random, -2.0, 2.0));
            (void)put(run, random, flown_between(random, -40.0, 60.0), outcome->offset_m);
            if (!is_apart(run, 20.0)) {
                move_aside(run, &run->flown.obstacle[1], outcome->offset_m < 0.0 ? -20.0 : 20.0);
            }
            break;
        case SEVERAL_GATE:
            put_gate(run, random, flown_between(random, 15.0, 60.0), flown_between(random, -8.0, 8.0),
                     flown_between(random, -30.0, 30.0));
            if (random_uniform(random) < 0.5) {
                (void)put(run, random, flown_between(random, 60.0, 200.0), flown_between(random, -2.0, 2.0));
            }
            break;
        case SEVERAL_WALL: {
            const int number = among(random, 3, FLOWN_MAX);
            const double apart_m = flown_between(random, 20.0, 60.0),
                         off_m = flown_between(random, -0.5, 0.5) * apart_m;
            for (int i = 0; i < number; i++) {
                (void)put(run, random, flown_between(random, -10.0, 10.0), off_m + apart_m * (i - 0.5 * (number - 1)));
            }
            break;
        }
        case SEVERAL_ROW: {
            const int number = among(random, 2, FLOWN_MAX);
            const double apart_m = flown_between(random, 40.0, 150.0);
            for (int i = 0; i < number; i++) {
                (void)put(run, random, apart_m * i, flown_between(random, -10.0, 10.0));
            }
            break;
        }
        case SEVERAL_BETWEEN:
            put_gate(run, random, 4.0 * (double)settings.margin_m, 0.0, flown_between(random, -30.0, 30.0));
            break;
        case SEVERAL_FIELD:
        case SEVERAL_KINDS:
        default:
            put_field(run, random, among(random, 1, FLOWN_MAX));
            break;
    }
    outcome->obstacles = run->flown.obstacles;
}

static const char *begin(run_t *run, several_outcome_t *outcome) {
    flown_t *flown = &run->flown;
    const uint64_t seed = run->setup->seed;
    random_t random = random_start(seed, STREAM_SEVERAL);
    flown->frame_s = run->setup->frame_s;
    flown->course_rad = flown_between(&random, -SIM_PI, SIM_PI);
    flown->speed_mps = flown_between(&random, 14.0, 22.0);
    flown->reach_m = flown->speed_mps * REACH_S;
    run->height_m = flown_between(&random, 15.0, 35.0);
    flown->rolls = random_uniform(&random) < 0.5;
    flown->drops = random_uniform(&random) < 0.5;
    flown->new_ids = run->setup->new_ids;
    place(run, &random, outcome);
    const char *fault = flown_start(flown, &random, seed, seed * FLOWN_MAX, run->height_m, 0.0);
    return fault ? fault : flown_start_layer(flown, run->setup->circles ? CIRCLE_M : 0.0);
}

/* ---------------------------------------------------------------------------------------------------------- aircraft -- */

/* To the target, then clockwise about it. */
static void circle(const run_t *run, guidance_t *guidance, double radius_m) {
    const vec3_t at = run->flown.aircraft.state.position_ned_m;
    const double north = at.x - (double)run->obeyed.target_ned_m[0], east = at.y - (double)run->obeyed.target_ned_m[1];
    const double out_m = hypot(north, east) - radius_m;
    guidance->path_course_rad = atan2(east, north) + 0.5 * SIM_PI + atan(CAPTURE * out_m / radius_m);
    guidance->cross_track_m = 0.0;
    guidance->path_curvature = fabs(out_m) < 0.3 * radius_m ? 1.0 / radius_m : 0.0;
}

static void steer(const run_t *run, guidance_t *guidance, double along_m, double right_m) {
    const goe_flight_assessment_t *o = &run->obeyed;
    const vec3_t at = run->flown.aircraft.state.position_ned_m;
    const double tightest_m = run->flown.speed_mps * run->flown.speed_mps / (9.80665 * tan(radians(BANK_DEG)));
    double target_along_m, target_right_m;
    flown_on_path(&run->flown, (double)o->target_ned_m[0], (double)o->target_ned_m[1], &target_along_m,
                  &target_right_m);
    switch (o->action) {
        case GOE_FLIGHT_LEFT:
        case GOE_FLIGHT_RIGHT:
            if (run->setup->circles) {
                circle(run, guidance, fmax(CIRCLE_M, tightest_m));
            } else if (fabs(right_m - target_right_m) > target_along_m - along_m && target_along_m > along_m) {
                guidance->path_course_rad = atan2((double)o->target_ned_m[1] - at.y, (double)o->target_ned_m[0] - at.x);
                guidance->cross_track_m = 0.0;
            } else {
                guidance->cross_track_m = right_m - target_right_m;
            }
            break;
        case GOE_FLIGHT_HOLD:
            circle(run, guidance, run->setup->circles ? fmax(CIRCLE_M, tightest_m) : tightest_m);
            break;
        case GOE_FLIGHT_CLIMB:
        case GOE_FLIGHT_GO_AROUND:
            guidance->height_error_m = -(double)o->target_ned_m[2] + at.z;
            break;
        case GOE_FLIGHT_NONE:
        default:
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
    guidance.height_error_m = run->height_m + state->position_ned_m.z;
    guidance.cross_track_m = right_m;
    guidance.path_course_rad = run->flown.course_rad;
    steer(run, &guidance, along_m, right_m);
    flown_step(&run->flown, &guidance);
}

/* ------------------------------------------------------------------------------------------------------------- layer -- */

/* -1, 1: left, right of the course as the aircraft flies. */
static int side_of(const run_t *run, const goe_flight_assessment_t *order) {
    const vec3_t at = run->flown.aircraft.state.position_ned_m,
                 moving = aircraft_ground_velocity(&run->flown.aircraft.state);
    const double north = (double)order->target_ned_m[0] - at.x, east = (double)order->target_ned_m[1] - at.y;
    if (order->action == GOE_FLIGHT_LEFT || order->action == GOE_FLIGHT_RIGHT) {
        return order->action == GOE_FLIGHT_LEFT ? -1 : 1;
    }
    return order->action != GOE_FLIGHT_HOLD ? 0 : (moving.x * east - moving.y * north < 0.0 ? -1 : 1);
}

static void note_search(run_t *run, double roll_in_s) {
    const vec3_t at = run->flown.aircraft.state.position_ned_m,
                 moving = aircraft_ground_velocity(&run->flown.aircraft.state);
    run->search_at[0] = at.x;
    run->search_at[1] = at.y;
    run->search_at[2] = moving.x;
    run->search_at[3] = moving.y;
    run->search_reach_s = run->setup->obey_s + roll_in_s;
}

static void note_first(run_t *run, const goe_flight_assessment_t *now, several_outcome_t *outcome) {
    double along_m, right_m;
    const vec3_t at = run->flown.aircraft.state.position_ned_m;
    flown_on_path(&run->flown, at.x, at.y, &along_m, &right_m);
    outcome->ordered = true;
    outcome->late = now->late;
    outcome->action = now->action;
    outcome->reason = now->reason;
    outcome->ahead_s = (run->flown.reach_m - along_m) / run->flown.speed_mps;
    outcome->known = now->obstacles >= run->flown.obstacles;
    outcome->ordered_s = run->flown.t_s;
    outcome->arrival_s = run->flown.arrival_s - run->flown.exposure_s;
    outcome->assessment_s = run->flown.t_s - run->flown.arrival_s;
    note_search(run, ROLL_IN_S);
}

static void trace(const run_t *run, const goe_flight_assessment_t *now) {
    double along_m, right_m, target_along_m, target_right_m;
    const vec3_t at = run->flown.aircraft.state.position_ned_m;
    flown_on_path(&run->flown, at.x, at.y, &along_m, &right_m);
    flown_on_path(&run->flown, (double)now->target_ned_m[0], (double)now->target_ned_m[1], &target_along_m,
                  &target_right_m);
    printf("%.1f at %.0f %.1f %.1f: %s %s%s to %.0f %.1f about %d clear %.1f worst %d %.2f in %.1f; ", run->flown.t_s,
           along_m - run->flown.reach_m, right_m, -at.z, goe_flight_action_text(now->action),
           goe_flight_reason_text(now->reason), now->late ? " late" : "",
           now->action ? target_along_m - run->flown.reach_m : 0.0, target_right_m, now->avoided, (double)now->clear_m,
           now->worst, (double)now->hazard.conflict_probability, (double)now->hazard.tcpa_s);
    for (int slot = 0; slot < GOE_FLIGHT_SLOTS; slot++) {
        goe_flight_obstacle_t found;
        if (goe_flight_obstacle(&run->flown.flight, slot, &found) == GOE_FLIGHT_OK &&
            (found.valid & GOE_HAS_POSITION) != 0u) {
            flown_on_path(&run->flown, (double)found.center_ned_m[0], (double)found.center_ned_m[1], &along_m,
                          &right_m);
            printf(" [%d #%u %.0f %.1f r %.1f sd %.1f %.1f%s]", slot, (unsigned)found.id, along_m - run->flown.reach_m,
                   right_m, (double)found.radius_m, sqrt((double)found.covariance_ne_m2[0]),
                   sqrt((double)found.covariance_ne_m2[2]), found.suspect ? " suspect" : "");
        }
    }
    puts("");
}

static void note_obeyed(const run_t *run, several_outcome_t *outcome) {
    if (!outcome->obeyed && run->obeyed.action != GOE_FLIGHT_NONE) {
        outcome->obeyed = true;
        outcome->delay_s = run->flown.t_s - outcome->ordered_s;
    }
}

static void assess(run_t *run, several_outcome_t *outcome) {
    goe_flight_assessment_t now;
    if (goe_flight_assess(&run->flown.flight, flown_clock_us(run->flown.t_s), GOE_FLIGHT_FLYING, &now) !=
        GOE_FLIGHT_OK) {
        memset(&now, 0, sizeof now);
    }
    const int side = side_of(run, &now);
    if (now.action != GOE_FLIGHT_NONE && !outcome->ordered) {
        note_first(run, &now, outcome);
    }
    const goe_flight_action_t before = run->assessed > 0 ? run->given[run->assessed - 1].action : GOE_FLIGHT_NONE;
    outcome->begun += before == GOE_FLIGHT_NONE && now.action != GOE_FLIGHT_NONE ? 1 : 0;
    if (now.action != before && side != 0) {
        outcome->changes += run->side != 0 && side != run->side ? 1 : 0;
        run->side = side;
    }
    if (run->setup->traced) {
        trace(run, &now);
    }
    run->given[run->assessed++] = now;
    const int back = (int)lround(run->setup->obey_s / (FLOWN_ASSESS_STEPS * AIRCRAFT_STEP_S));
    if (run->assessed > back) {
        run->obeyed = run->given[run->assessed - 1 - back];
    }
    note_obeyed(run, outcome);
}

/* ----------------------------------------------------------------------------------------------------------- outcome -- */

static double nearest_m(const run_t *run, double north, double east, double up) {
    double least = HUGE_VAL;
    for (int i = 0; i < run->flown.obstacles; i++) {
        least = fmin(least, flown_distance_m(&run->flown.obstacle[i], north, east, up));
    }
    return least;
}

/* Of one turn of this bank, begun when the search begins. */
static double turn_keeps_m(const run_t *run, double bank_rad) {
    double north = run->search_at[0], east = run->search_at[1], least = HUGE_VAL;
    double course = atan2(run->search_at[3], run->search_at[2]);
    const double speed = hypot(run->search_at[3], run->search_at[2]);
    for (int k = 0; k * SEARCH_STEP_S < SEARCH_S && least >= SEVERAL_CLEAR_M; k++) {
        const double t = k * SEARCH_STEP_S;
        course += t < run->search_reach_s ? 0.0 : SEARCH_STEP_S * 9.80665 * tan(bank_rad) / speed;
        north += SEARCH_STEP_S * speed * cos(course);
        east += SEARCH_STEP_S * speed * sin(course);
        least = fmin(least, nearest_m(run, north, east, run->height_m));
    }
    return least;
}

static bool is_possible(const run_t *run) {
    for (int i = -BANKS; i <= BANKS; i++) {
        if (turn_keeps_m(run, radians(BANK_DEG) * i / BANKS) >= SEVERAL_CLEAR_M) {
            return true;
        }
    }
    return false;
}

static void lead(run_t *run, int k, several_outcome_t *outcome) {
    flown_sense(&run->flown, k);
    if (k % FLOWN_ASSESS_STEPS == 0) {
        assess(run, outcome);
    }
    if (!outcome->ordered && run->flown.t_s < REACH_S - UNORDERED_S) {
        note_search(run, ROLL_IN_S);
    }
}

static void note_place(const run_t *run, several_outcome_t *outcome) {
    const vec3_t at = run->flown.aircraft.state.position_ned_m;
    outcome->closest_m = fmin(outcome->closest_m, nearest_m(run, at.x, at.y, -at.z));
    outcome->collided = outcome->closest_m < FLOWN_COLLISION_M || at.z > -FLOWN_GROUND_M;
}

bool several_misses(const several_outcome_t *outcome) {
    return outcome->possible && (outcome->collided || outcome->closest_m < SEVERAL_CLEAR_M);
}

/* led: the layer runs, and its orders are obeyed. */
static const char *fly(const several_case_t *setup, bool led, several_outcome_t *outcome) {
    static run_t run; /* 100 kB */
    memset(&run, 0, sizeof run);
    memset(outcome, 0, sizeof *outcome);
    outcome->closest_m = HUGE_VAL;
    run.setup = setup;
    const char *fault = begin(&run, outcome);
    const int steps = fault ? 0 : (int)((REACH_S + AFTER_S) / AIRCRAFT_STEP_S);
    for (int k = 0; k < steps && !outcome->collided; k++) {
        if (led) {
            lead(&run, k, outcome);
        }
        step(&run);
        note_place(&run, outcome);
    }
    outcome->flown_s = run.flown.t_s;
    outcome->possible = led && !fault && is_possible(&run);
    return fault;
}

const char *several_fly(const several_case_t *setup, several_outcome_t *outcome) { return fly(setup, true, outcome); }

const char *several_fly_nominal(const several_case_t *setup, several_outcome_t *nominal) {
    return fly(setup, false, nominal);
}

aviation_flight_t several_counted(const several_outcome_t *flown, const several_outcome_t *nominal) {
    aviation_flight_t counted;
    goe_flight_settings_t settings;
    goe_flight_settings_default(&settings);
    memset(&counted, 0, sizeof counted);
    counted.obstacles = flown->obstacles;
    counted.nominal_m = nominal->closest_m;
    counted.due = nominal->collided || nominal->closest_m < (double)settings.margin_m;
    counted.collided_nominal = nominal->collided;
    counted.collided = flown->collided;
    counted.alerts = flown->begun;
    counted.flown_s = flown->flown_s;
    counted.lead_s = flown->ordered && nominal->collided ? nominal->flown_s - flown->ordered_s : (double)NAN;
    counted.obeyed = flown->obeyed;
    counted.latency_s[AVIATION_ARRIVAL] = flown->arrival_s;
    counted.latency_s[AVIATION_ASSESSMENT] = flown->assessment_s;
    counted.latency_s[AVIATION_DELAY] = flown->delay_s;
    return counted;
}
