/*
 * goe_avoid - flies the flight layer over collision courses and passes, with and without its orders carried out, and prints what
 * came of it; --csv writes every run.
 *
 * Exit status: 0 done; 2 bad usage, or a run could not be flown or written: the file is as it was.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <popt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "avoid_text.h"
#include "option_fault.h"
#include "output_file.h"
#include "ranks.h"
#include "several_text.h"
#include "standard_output.h"

#define PROGRAM "goe_avoid"
#define EXIT_FAILED 2
#define RUNS_MAX 100000
#define DELAY_MAX_S 2.0
#define TWICE_THE_MARGIN 2.0

enum { RUNS_GIVEN = 1, DELAY_GIVEN }; /* what popt reports of options that not all flights have */

static int runs = 334;
static int seed = 1;
static double delay_s = 0.1;
static int list;
static int several;
static int step = 1;
static int trace = -1;
static int new_ids;
static char *csv;

static struct poptOption options[] = {
    {"runs", 'n', POPT_ARG_INT | POPT_ARGFLAG_SHOW_DEFAULT, &runs, RUNS_GIVEN, "of each kind of obstacle and question",
     "N"},
    {"seed", 's', POPT_ARG_INT | POPT_ARGFLAG_SHOW_DEFAULT, &seed, 0, "of the first run", "N"},
    {"delay", 'd', POPT_ARG_DOUBLE | POPT_ARGFLAG_SHOW_DEFAULT, &delay_s, DELAY_GIVEN, "of a frame, s", "S"},
    {"list", 'l', POPT_ARG_NONE, &list, 0, "a line for every run that collided although it reacted, or reacted falsely",
     NULL},
    {"several", 'm', POPT_ARG_INT, &several, 0, "flies so many flights among one to nine obstacles instead", "N"},
    {"step", 0, POPT_ARG_INT | POPT_ARGFLAG_SHOW_DEFAULT, &step, 0, "of these: from one seed to the next", "N"},
    {"new-ids", 0, POPT_ARG_NONE, &new_ids, 0, "of these: an obstacle that was out of view gets a new id", NULL},
    {"trace", 0, POPT_ARG_INT, &trace, 0, "of these: prints flight N, one line for every assessment", "N"},
    {"csv", 'c', POPT_ARG_STRING, &csv, 0, "a row for every run goes here", "FILE"},
    {"help", 'h', POPT_ARG_NONE, NULL, 'h', "print this and exit", NULL},
    {"version", 'V', POPT_ARG_NONE, NULL, 'V', "print the version and exit", NULL},
    POPT_TABLEEND};

/* Of one kind of obstacle and one question. */
typedef struct {
    int runs, collided_without, collided, ordered, late, collided_late, by_action[GOE_FLIGHT_HOLD + 1];
    double *closest_m, *ahead_s;
    long suspect, assessed;
} tally_t;

static bool give_up(const char *subject, const char *reason) {
    (void)fprintf(stderr, PROGRAM ": %s: %s\n", subject, reason);
    return false;
}

/* ------------------------------------------------------------------------------------------------------------ tally -- */

static void count(tally_t *tally, const avoid_run_t *run) {
    const avoid_outcome_t *outcome = avoid_run_ordered(run);
    tally->closest_m[tally->runs++] = outcome->closest_m;
    tally->collided_without += run->without.collided ? 1 : 0;
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

static bool begin(tally_t *tally) {
    memset(tally, 0, sizeof *tally);
    tally->closest_m = calloc((size_t)runs, sizeof *tally->closest_m);
    tally->ahead_s = calloc((size_t)runs, sizeof *tally->ahead_s);
    return (tally->closest_m != NULL && tally->ahead_s != NULL) || give_up("runs", "out of memory");
}

static void drop(tally_t *tally) {
    free(tally->closest_m);
    free(tally->ahead_s);
}

/* ------------------------------------------------------------------------------------------------------------- runs -- */

static void show_progress(const char *what, int done) {
    if (isatty(STDERR_FILENO) && (done % 16 == 0 || done == runs)) {
        fprintf(stderr, "\r%-40s %d of %d%s", what, done, runs, done == runs ? "\n" : "");
    }
}

static void print_line(const avoid_run_t *run) {
    const avoid_outcome_t *outcome = avoid_run_ordered(run);
    if (avoid_is_pass(&run->setup) ? outcome->ordered : outcome->collided) {
        printf("%s seed %" PRIu64 ": %s%s, %.1f s ahead, closest %.1f m, suspect %d of %d\n",
               AVOID_NAMES[run->setup.kind], run->setup.seed, goe_flight_action_text(outcome->action),
               outcome->late ? " (late)" : "", outcome->ahead_s, outcome->closest_m, outcome->suspect,
               outcome->assessed);
    }
}

/* A collision course twice, a pass once. */
static bool fly_run(avoid_run_t *run) {
    avoid_case_t reacting = run->setup;
    reacting.reacts = true;
    const char *fault = avoid_fly(&run->setup, &run->without);
    if (fault == NULL && !avoid_is_pass(&run->setup)) {
        fault = avoid_fly(&reacting, &run->with);
    }
    if (fault != NULL) {
        (void)fprintf(stderr, PROGRAM ": %s, seed %" PRIu64 ": %s\n", AVOID_NAMES[run->setup.kind], run->setup.seed,
                      fault);
    }
    return fault == NULL;
}

/* rows: null, or where a row of every run goes. */
static bool fly(avoid_kind_t kind, double pass_m, FILE *rows, tally_t *tally) {
    goe_flight_settings_t settings;
    goe_flight_settings_default(&settings);
    for (int k = 0; k < runs; k++) {
        avoid_run_t run;
        memset(&run, 0, sizeof run);
        run.setup = (avoid_case_t){kind, (uint64_t)seed + (uint64_t)k, pass_m, false, delay_s};
        if (!fly_run(&run)) {
            return false;
        }
        count(tally, &run);
        if (rows != NULL) {
            avoid_text_row(rows, &run, (double)settings.margin_m);
        }
        if (list) {
            print_line(&run);
        }
        show_progress(AVOID_NAMES[kind], k + 1);
    }
    ranks_sort(tally->closest_m, tally->runs);
    ranks_sort(tally->ahead_s, tally->ordered);
    return true;
}

/* ----------------------------------------------------------------------------------------------------------- tables -- */

static void print_courses(avoid_kind_t kind, const tally_t *with) {
    printf("| %s | %d | %d | %d (%d late) | %.1f / %.1f / %.1f | %.1f / %.1f | ", AVOID_NAMES[kind], with->runs,
           with->collided_without, with->collided, with->collided_late,
           ranks_quantile(with->closest_m, with->runs, 0.0), ranks_quantile(with->closest_m, with->runs, 0.05),
           ranks_quantile(with->closest_m, with->runs, 0.5), ranks_quantile(with->ahead_s, with->ordered, 0.0),
           ranks_quantile(with->ahead_s, with->ordered, 0.5));
    for (int action = GOE_FLIGHT_NONE; action <= GOE_FLIGHT_HOLD; action++) {
        if (with->by_action[action] > 0) {
            printf("%s %d ", goe_flight_action_text((goe_flight_action_t)action), with->by_action[action]);
        }
    }
    printf("| %d | %.1f %% |\n", with->runs - with->ordered,
           100.0 * (double)with->suspect / fmax((double)with->assessed, 1.0));
}

static void print_passes(avoid_kind_t kind, const tally_t *passes) {
    printf("| %s | %d | %d (%.1f %%) |\n", AVOID_NAMES[kind], passes->runs, passes->ordered,
           100.0 * passes->ordered / fmax(passes->runs, 1.0));
}

/* A row for every kind. */
static bool print_all(double pass_m, FILE *rows, void (*print)(avoid_kind_t kind, const tally_t *tally)) {
    bool done = true;
    for (int kind = 0; kind < AVOID_KINDS && done; kind++) {
        tally_t tally;
        done = begin(&tally) && fly((avoid_kind_t)kind, pass_m, rows, &tally);
        if (done) {
            print((avoid_kind_t)kind, &tally);
        }
        drop(&tally);
    }
    return done;
}

static bool print_tables(FILE *rows) {
    goe_flight_settings_t settings;
    goe_flight_settings_default(&settings);
    puts("| collision courses | runs | collisions without | with | closest, m: least / 5 % / median | order ahead, s: "
         "least / median | orders | no order | suspect |");
    puts("|---|---|---|---|---|---|---|---|---|");
    if (!print_all(-1.0, rows, print_courses)) {
        return false;
    }
    puts("");
    puts("| passes at twice the margin | runs | false orders |");
    puts("|---|---|---|");
    return print_all(TWICE_THE_MARGIN * (double)settings.margin_m, rows, print_passes);
}

static bool print_and_write(void) {
    output_file_t output;
    if (!output_file_open(&output, csv)) {
        return give_up(csv, strerror(errno));
    }
    avoid_text_header(output.stream);
    if (!print_tables(output.stream)) {
        output_file_discard(&output);
        return false;
    }
    return output_file_commit(&output) || give_up(csv, strerror(errno));
}

/* ------------------------------------------------------------------------------------------------------------- main -- */

static bool check_ranges(void) {
    char reason[64];
    if (runs < 1 || runs > RUNS_MAX) {
        (void)snprintf(reason, sizeof reason, "must be 1 to %d, not %d", RUNS_MAX, runs);
        return give_up("--runs", reason);
    }
    if (several < 0 || several > RUNS_MAX) {
        (void)snprintf(reason, sizeof reason, "must be 1 to %d, not %d", RUNS_MAX, several);
        return give_up("--several", reason);
    }
    if (step < 1 || step > RUNS_MAX) {
        (void)snprintf(reason, sizeof reason, "must be 1 to %d, not %d", RUNS_MAX, step);
        return give_up("--step", reason);
    }
    if (seed < 0) {
        return give_up("--seed", "must be 0 or more");
    }
    if (!(delay_s >= 0.0 && delay_s <= DELAY_MAX_S)) {
        (void)snprintf(reason, sizeof reason, "must be 0 to %g s, not %g", DELAY_MAX_S, delay_s);
        return give_up("--delay", reason);
    }
    return true;
}

/* Flight `trace` of the campaign, with its seed. */
static bool trace_one(void) {
    several_outcome_t outcome;
    several_case_t setup = several_case(trace, (uint64_t)seed + (uint64_t)trace * (uint64_t)step, new_ids != 0);
    setup.traced = true;
    const char *fault = several_fly(&setup, &outcome);
    return fault == NULL || give_up("--trace", fault);
}

/* Goals that are missed are printed, and no failure of the program. */
static bool fly_several(void) {
    bool met;
    return trace >= 0 ? trace_one()
                      : several_campaign(several, (uint64_t)seed, (uint64_t)step, list != 0, new_ids != 0, &met);
}

static bool run_options(poptContext context, int argc, const char *const *argv) {
    const char *single = NULL;
    int said = poptGetNextOpt(context);
    for (; said == RUNS_GIVEN || said == DELAY_GIVEN; said = poptGetNextOpt(context)) {
        single = said == RUNS_GIVEN ? "--runs" : "--delay";
    }
    if (said == 'V') {
        puts(PROGRAM " " GOE_VERSION);
        return true;
    }
    if (said == 'h') {
        poptPrintHelp(context, stdout, 0);
        return true;
    }
    if (said < -1) {
        const char *bad = option_blamed(context, argc, argv);
        char reason[OPTION_FAULT_MAX];
        option_fault(reason, context, options, bad, said);
        return give_up(bad, reason);
    }
    if (poptPeekArg(context) != NULL) {
        return give_up(poptPeekArg(context), "options only; see --help");
    }
    if (!check_ranges()) {
        return false;
    }
    if (several > 0 || trace >= 0) {
        if (csv != NULL) {
            return give_up("--csv", "not with --several or --trace, which print their flights by --list");
        }
        if (single != NULL) {
            return give_up(single, "not with --several or --trace, whose flights have their own");
        }
        return fly_several();
    }
    if (new_ids != 0) {
        return give_up("--new-ids", "only with --several or --trace");
    }
    return csv != NULL ? print_and_write() : print_tables(NULL);
}

int main(int argc, const char **argv) {
    poptContext context = poptGetContext(PROGRAM, argc, argv, options, 0);
    standard_output_watch(PROGRAM, EXIT_FAILED);
    const bool done = run_options(context, argc, argv);
    poptFreeContext(context);
    free(csv);
    return done ? 0 : EXIT_FAILED;
}
