/*
 * goe_avoid - flies the flight layer over collision courses and passes, with and without its orders carried out, and prints what
 * came of it.
 *
 * Exit status: 0 done; 2 bad usage.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#include <math.h>
#include <popt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "avoidance.h"

#define EXIT_BAD_USAGE 2
#define RUNS_MAX 100000
#define TWICE_THE_MARGIN 2.0

static int runs = 334;
static int seed = 1;
static double delay_s = 0.1;
static int list;

static struct poptOption options[] = {
    {"runs", 'n', POPT_ARG_INT | POPT_ARGFLAG_SHOW_DEFAULT, &runs, 0, "of each kind of obstacle and question", "N"},
    {"seed", 's', POPT_ARG_INT | POPT_ARGFLAG_SHOW_DEFAULT, &seed, 0, "of the first run", "N"},
    {"delay", 'd', POPT_ARG_DOUBLE | POPT_ARGFLAG_SHOW_DEFAULT, &delay_s, 0, "of a frame, s", "S"},
    {"list", 'l', POPT_ARG_NONE, &list, 0, "a line for every run that collided although it reacted, or reacted falsely",
     NULL},
    {"version", 'V', POPT_ARG_NONE, NULL, 'V', "the version", NULL},
    POPT_AUTOHELP POPT_TABLEEND};

/* Of one kind of obstacle and one question. */
typedef struct {
    int runs, collided, ordered, late, collided_late, by_action[GOE_FLIGHT_HOLD + 1];
    double *closest_m, *ahead_s;
    long suspect, assessed;
} tally_t;

static int compare(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double quantile(double *sorted, int count, double share) {
    return count > 0 ? sorted[(int)(share * (count - 1) + 0.5)] : (double)NAN;
}

static void count(tally_t *tally, const avoid_outcome_t *outcome) {
    tally->closest_m[tally->runs++] = outcome->closest_m;
    tally->collided += outcome->collided ? 1 : 0;
    tally->collided_late += outcome->collided && outcome->late ? 1 : 0;
    tally->suspect += outcome->suspect;
    tally->assessed += outcome->assessed;
    if (outcome->ordered) {
        tally->ahead_s[tally->ordered++] = outcome->ahead_s;
        tally->late += outcome->late ? 1 : 0;
        tally->by_action[outcome->action]++;
    }
}

static void show_progress(const char *what, int done) {
    if (isatty(STDERR_FILENO) && (done % 16 == 0 || done == runs)) {
        fprintf(stderr, "\r%-40s %d of %d%s", what, done, runs, done == runs ? "\n" : "");
    }
}

static tally_t fly(avoid_kind_t kind, double pass_m, bool reacts) {
    tally_t tally;
    memset(&tally, 0, sizeof tally);
    tally.closest_m = calloc((size_t)runs, sizeof *tally.closest_m);
    tally.ahead_s = calloc((size_t)runs, sizeof *tally.ahead_s);
    if (tally.closest_m == NULL || tally.ahead_s == NULL) {
        fputs("goe_avoid: out of memory\n", stderr);
        exit(EXIT_BAD_USAGE);
    }
    for (int k = 0; k < runs; k++) {
        const avoid_case_t setup = {kind, (uint64_t)seed + (uint64_t)k, pass_m, reacts, delay_s};
        avoid_outcome_t outcome;
        if (avoid_fly(&setup, &outcome) == NULL) {
            count(&tally, &outcome);
        }
        const bool worth_a_line = pass_m < 0.0 ? reacts && outcome.collided : outcome.ordered;
        if (list && worth_a_line) {
            printf("%s seed %d: %s%s, %.1f s ahead, closest %.1f m, suspect %d of %d\n", AVOID_NAMES[kind], seed + k,
                   goe_flight_action_text(outcome.action), outcome.late ? " (late)" : "", outcome.ahead_s,
                   outcome.closest_m, outcome.suspect, outcome.assessed);
        }
        show_progress(AVOID_NAMES[kind], k + 1);
    }
    qsort(tally.closest_m, (size_t)tally.runs, sizeof *tally.closest_m, compare);
    qsort(tally.ahead_s, (size_t)tally.ordered, sizeof *tally.ahead_s, compare);
    return tally;
}

static void drop(tally_t *tally) {
    free(tally->closest_m);
    free(tally->ahead_s);
}

static void print_courses(avoid_kind_t kind) {
    tally_t without = fly(kind, -1.0, false);
    tally_t with = fly(kind, -1.0, true);
    printf("| %s | %d | %d | %d (%d late) | %.1f / %.1f / %.1f | %.1f / %.1f | ", AVOID_NAMES[kind], with.runs,
           without.collided, with.collided, with.collided_late, quantile(with.closest_m, with.runs, 0.0),
           quantile(with.closest_m, with.runs, 0.05), quantile(with.closest_m, with.runs, 0.5),
           quantile(with.ahead_s, with.ordered, 0.0), quantile(with.ahead_s, with.ordered, 0.5));
    for (int action = GOE_FLIGHT_NONE; action <= GOE_FLIGHT_HOLD; action++) {
        if (with.by_action[action] > 0) {
            printf("%s %d ", goe_flight_action_text((goe_flight_action_t)action), with.by_action[action]);
        }
    }
    printf("| %d | %.1f %% |\n", with.runs - with.ordered,
           100.0 * (double)with.suspect / fmax((double)with.assessed, 1.0));
    drop(&without);
    drop(&with);
}

static void print_passes(avoid_kind_t kind, double pass_m) {
    tally_t passes = fly(kind, pass_m, false);
    printf("| %s | %d | %d (%.1f %%) |\n", AVOID_NAMES[kind], passes.runs, passes.ordered,
           100.0 * passes.ordered / fmax(passes.runs, 1.0));
    drop(&passes);
}

int main(int argc, const char **argv) {
    poptContext context = poptGetContext("goe_avoid", argc, argv, options, 0);
    const int said = poptGetNextOpt(context);
    if (said == 'V') {
        puts("goe_avoid " GOE_VERSION);
    } else if (said < -1 || poptPeekArg(context) != NULL || runs < 1 || runs > RUNS_MAX || seed < 0 ||
               !(delay_s >= 0.0 && delay_s <= 2.0)) {
        fprintf(stderr, "goe_avoid: %s\n",
                said < -1 ? poptStrerror(said) : "runs: 1 to 100000; seed: 0 or more; delay: 0 to 2 s");
        poptFreeContext(context);
        return EXIT_BAD_USAGE;
    }
    poptFreeContext(context);
    if (said == 'V') {
        return 0;
    }
    goe_flight_settings_t settings;
    goe_flight_settings_default(&settings);
    puts("| collision courses | runs | collisions without | with | closest, m: least / 5 % / median | order ahead, s: "
         "least / median | orders | no order | suspect |");
    puts("|---|---|---|---|---|---|---|---|---|");
    for (int kind = 0; kind < AVOID_KINDS; kind++) {
        print_courses((avoid_kind_t)kind);
    }
    puts("");
    puts("| passes at twice the margin | runs | false orders |");
    puts("|---|---|---|");
    for (int kind = 0; kind < AVOID_KINDS; kind++) {
        print_passes((avoid_kind_t)kind, TWICE_THE_MARGIN * (double)settings.margin_m);
    }
    return 0;
}
