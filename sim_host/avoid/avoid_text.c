/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "avoid_text.h"

#include <inttypes.h>
#include <math.h>

#include "flown.h"

const avoid_outcome_t *avoid_run_ordered(const avoid_run_t *run) {
    return avoid_is_pass(&run->setup) ? &run->without : &run->with;
}

bool avoid_run_is_false(const avoid_run_t *run) { return avoid_is_pass(&run->setup) && run->without.ordered; }

void avoid_text_header(FILE *stream) {
    (void)fputs("kind,course,seed,delay_s,margin_m,collision_m,pass_m,action,ahead_s,late,false_order,"
                "closest_without_m,collided_without,closest_with_m,collided_with,suspect,assessed,confident\n",
                stream);
}

/* A field and the comma before it. */
static void put(FILE *stream, double value) {
    if (isfinite(value)) {
        (void)fprintf(stream, ",%.9g", value);
    } else {
        (void)fputc(',', stream);
    }
}

static void put_distance(FILE *stream, const avoid_outcome_t *outcome) {
    put(stream, outcome->closest_m);
    (void)fprintf(stream, ",%d", outcome->collided ? 1 : 0);
}

void avoid_text_row(FILE *stream, const avoid_run_t *run, double margin_m) {
    const avoid_case_t *setup = &run->setup;
    const avoid_outcome_t *orders = avoid_run_ordered(run);
    const bool pass = avoid_is_pass(setup);
    (void)fprintf(stream, "%s,%s,%" PRIu64, AVOID_NAMES[setup->kind], pass ? "pass" : "collision", setup->seed);
    put(stream, setup->delay_s);
    put(stream, margin_m);
    put(stream, FLOWN_COLLISION_M);
    put(stream, pass ? setup->pass_m : (double)NAN);
    (void)fprintf(stream, ",%s", goe_flight_action_text(orders->action));
    put(stream, orders->ordered ? orders->ahead_s : (double)NAN);
    (void)fprintf(stream, ",%d", orders->late ? 1 : 0);
    put(stream, pass ? (double)avoid_run_is_false(run) : (double)NAN);
    put_distance(stream, &run->without);
    if (pass) {
        (void)fputs(",,", stream);
    } else {
        put_distance(stream, &run->with);
    }
    (void)fprintf(stream, ",%d,%d,%d\n", orders->suspect, orders->assessed,
                  run->with.confident || run->without.confident ? 1 : 0);
}
