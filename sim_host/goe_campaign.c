/*
 * goe_campaign - flies the paper's whole campaign and what it left for later, runs the library over every flight, and writes
 * how far its estimates are off.
 *
 * Exit status: 0 done; 2 bad usage, or the campaign could not be flown or written: the folder is as it was.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#include <math.h>
#include <popt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "campaign_files.h"
#include "campaign_plan.h"
#include "campaign_text.h"
#include "case_run.h"
#include "case_statistics.h"
#include "option_fault.h"
#include "progress.h"
#include "standard_output.h"
#include "work_pool.h"

#ifndef GOE_VERSION
#define GOE_VERSION "development"
#endif

#define PROGRAM "goe_campaign"
#define DEFAULT_FOLDER "campaign"
#define SEEDS_MAX 1000
#define PARTS_MAX 10000
#define SERIES_SEED 1

enum { EXIT_DONE = 0, EXIT_FAILED = 2 };

static const double FRACTIONS[] = {0.2, 0.4, 0.6, 1.0};
#define FRACTIONS_COUNT (sizeof FRACTIONS / sizeof FRACTIONS[0])

/* --------------------------------------------------------------------------------------------------------- options -- */

typedef struct {
    char *out_text, *studies_text, *part_text;
    const char *out;
    int seeds, jobs;
    int part, parts; /* of the plan */
    int all_series, quiet, help, version;
    unsigned studies; /* set of 1u << study_t */
} options_t;

static bool complain(const char *subject, const char *reason) {
    (void)fprintf(stderr, PROGRAM ": %s: %s (see " PROGRAM " --help)\n", subject, reason);
    return false;
}

static bool give_up(const char *subject, const char *reason) {
    (void)fprintf(stderr, PROGRAM ": %s: %s\n", subject, reason);
    return false;
}

static bool check_range(const char *option, int value, int low, int high) {
    char reason[64];
    if (value >= low && value <= high) {
        return true;
    }
    (void)snprintf(reason, sizeof reason, "must be %d to %d, not %d", low, high, value);
    return complain(option, reason);
}

static bool check_studies(options_t *options) {
    char bad[32], reason[96];
    if (campaign_plan_studies(options->studies_text != NULL ? options->studies_text : "all", &options->studies, bad,
                              sizeof bad)) {
        return true;
    }
    (void)snprintf(reason, sizeof reason, "'%s' is not " STUDY_GROUPS, bad);
    return complain("--studies", reason);
}

static bool check_part(options_t *options) {
    const char *text = options->part_text != NULL ? options->part_text : "1/1";
    char *slash = NULL, *end = NULL;
    const long part = strtol(text, &slash, 10);
    const long parts = *slash == '/' ? strtol(slash + 1, &end, 10) : 0;
    if (part < 1 || part > parts || parts > PARTS_MAX || *end != '\0') {
        return complain("--part", "must be K/N, as 2/8: K from 1 to N, N up to 10000");
    }
    options->part = (int)part;
    options->parts = (int)parts;
    return true;
}

static bool check_options(options_t *options) {
    if (!check_range("--seeds", options->seeds, 1, SEEDS_MAX) ||
        !check_range("--jobs", options->jobs, 1, WORK_POOL_JOBS_MAX) || !check_studies(options) ||
        !check_part(options)) {
        return false;
    }
    options->out = options->out_text != NULL ? options->out_text : DEFAULT_FOLDER;
    const char *fault = campaign_files_check(options->out);
    return fault == NULL || give_up(options->out, fault);
}

/* ---------------------------------------------------------------------------------------------------------- flights -- */

/* What a flight leaves behind. */
typedef struct {
    char *rows;                  /* of cases.csv */
    char *series[PLAN_RUNS_MAX]; /* null: not wanted */
    size_t frames;
    bool ended_early;
    const char *fault; /* null, or why it could not be flown or run */
} result_t;

typedef struct {
    const options_t *options;
    campaign_plan_t plan;
    result_t *results; /* in the plan's order */
} campaign_t;

/* The figures need one obstacle's orientation over time: the building, turned by -20 degrees. */
static bool series_wanted(const options_t *options, const planned_flight_t *flight) {
    const bool figure =
        flight->setup.alpha_deg < -10.0 && flight->setup.alpha_deg > -30.0 && strcmp(flight->obstacle, "building") == 0;
    return flight->study == STUDY_PAPER && flight->seed == SERIES_SEED && (options->all_series || figure);
}

static char *series_text(const flight_log_t *log, const case_sample_t *samples) {
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (stream != NULL) {
        campaign_text_series(stream, log, samples);
        (void)fclose(stream);
    }
    return text;
}

/* Rows of one run; setting.model: whose frames count. */
static const char *put_rows(FILE *rows, const planned_flight_t *flight, case_setting_t setting, const flight_log_t *log,
                            const case_sample_t *samples) {
    for (size_t i = 0; i < FRACTIONS_COUNT; i++) {
        case_statistics_t statistics;
        if (!case_statistics(log, samples, setting.model, FRACTIONS[i], &statistics)) {
            return "out of memory";
        }
        campaign_text_cases_row(rows, flight, setting, FRACTIONS[i], &statistics);
    }
    return NULL;
}

/* A run that switches models is judged twice: as a whole, and by its frames with the line (filter: the box) alone. */
static const char *run_over(const planned_flight_t *flight, case_setting_t setting, const flight_log_t *log,
                            case_sample_t *samples, FILE *rows) {
    const char *fault = case_run(&flight->setup, log, setting, samples);
    const bool switches = setting.model == GOE_MODEL_AUTO && flight->setup.obstacle.kind == OBSTACLE_BOX &&
                          flight->setup.features != LOG_BOXES; /* boxes show no corners to switch by */
    if (fault == NULL) {
        fault = put_rows(rows, flight, setting, log, samples);
    }
    if (fault == NULL && switches) {
        setting.model = setting.method == GOE_METHOD_FILTER ? GOE_MODEL_BOX : GOE_MODEL_LINE;
        fault = put_rows(rows, flight, setting, log, samples);
    }
    return fault;
}

static void run_all_over(const options_t *options, const planned_flight_t *flight, const flight_log_t *log, FILE *rows,
                         result_t *result) {
    case_sample_t *samples = malloc((log->count + 1) * sizeof *samples);
    if (samples == NULL) {
        result->fault = "out of memory";
        return;
    }
    for (int r = 0; r < flight->runs && result->fault == NULL; r++) {
        result->fault = run_over(flight, flight->run[r], log, samples, rows);
        if (result->fault == NULL && series_wanted(options, flight)) {
            result->series[r] = series_text(log, samples);
            result->fault = result->series[r] != NULL ? NULL : "out of memory";
        }
    }
    free(samples);
}

/* One flight and everything that is run over it. context: a campaign_t. */
static void fly(void *context, size_t i) {
    const campaign_t *campaign = context;
    const planned_flight_t *flight = &campaign->plan.flights[i];
    result_t *result = &campaign->results[i];
    flight_log_t log;
    size_t size = 0;
    FILE *rows = open_memstream(&result->rows, &size);
    if (rows == NULL) {
        result->fault = "out of memory";
        return;
    }
    result->fault = flight_case_fly(&flight->setup, &log);
    if (result->fault == NULL) {
        result->frames = log.count;
        result->ended_early = log.ended != NULL;
        run_all_over(campaign->options, flight, &log, rows, result);
        flight_log_free(&log);
    }
    if (fclose(rows) != 0) {
        result->fault = "out of memory";
    }
}

static bool check_results(const campaign_t *campaign) {
    for (size_t i = 0; i < campaign->plan.count; i++) {
        if (campaign->results[i].fault != NULL) {
            const planned_flight_t *flight = &campaign->plan.flights[i];
            (void)fprintf(stderr, PROGRAM ": study %s, case %d, seed %d: %s\n", STUDY_NAMES[flight->study],
                          flight->number, flight->seed, campaign->results[i].fault);
            return false;
        }
    }
    return true;
}

/* ------------------------------------------------------------------------------------------------------------ files -- */

typedef struct {
    size_t runs, frames, series, ended_early;
} counts_t;

static counts_t count_results(const campaign_t *campaign) {
    counts_t counts = {0, 0, 0, 0};
    for (size_t i = 0; i < campaign->plan.count; i++) {
        const result_t *result = &campaign->results[i];
        counts.runs += (size_t)campaign->plan.flights[i].runs;
        counts.frames += result->frames;
        counts.ended_early += result->ended_early ? 1u : 0u;
        for (int r = 0; r < PLAN_RUNS_MAX; r++) {
            counts.series += result->series[r] != NULL ? 1u : 0u;
        }
    }
    return counts;
}

static void put_facts(FILE *stream, const campaign_t *campaign, const counts_t *counts, double wall_s) {
    const char *separator = "";
    (void)fprintf(stream, "{\n  \"program\": \"" PROGRAM "\",\n  \"version\": \"" GOE_VERSION "\",\n  \"seeds\": %d,\n",
                  campaign->options->seeds);
    (void)fputs("  \"studies\": [", stream);
    for (int i = 0; i < STUDY_COUNT; i++) {
        if ((campaign->options->studies & (1u << (unsigned)i)) != 0) {
            (void)fprintf(stream, "%s\"%s\"", separator, STUDY_NAMES[i]);
            separator = ", ";
        }
    }
    (void)fprintf(stream,
                  "],\n  \"flights\": %zu,\n  \"flights_ended_early\": %zu,\n  \"frames\": %zu,\n  \"runs\": %zu,\n"
                  "  \"series\": %zu,\n",
                  campaign->plan.count, counts->ended_early, counts->frames, counts->runs, counts->series);
    (void)fprintf(stream, "  \"jobs\": %d,\n  \"wall_s\": %.3f\n}\n", campaign->options->jobs, wall_s);
}

static char *text_of_header(void) {
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (stream != NULL) {
        campaign_text_cases_header(stream);
        (void)fclose(stream);
    }
    return text;
}

static char *text_of_facts(const campaign_t *campaign, const counts_t *counts, double wall_s) {
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (stream != NULL) {
        put_facts(stream, campaign, counts, wall_s);
        (void)fclose(stream);
    }
    return text;
}

static void name_file(campaign_file_t *file, const char *name, const char *const *pieces, size_t count) {
    (void)snprintf(file->name, sizeof file->name, "%s", name);
    file->pieces = pieces;
    file->count = count;
}

/* The difference between the series of a flight's runs. */
static const char *series_name(case_setting_t setting) {
    return setting.method == GOE_METHOD_FILTER ? campaign_text_method(setting.method)
                                               : campaign_text_model(setting.model);
}

/* The series first: whoever finds cases.csv and campaign.json finds what belongs to them. */
static size_t list_files(const campaign_t *campaign, const char *const *rows, const char *const *facts,
                         campaign_file_t *files) {
    size_t count = 0;
    for (size_t i = 0; i < campaign->plan.count; i++) {
        const planned_flight_t *flight = &campaign->plan.flights[i];
        for (int r = 0; r < flight->runs; r++) {
            char *const *series = &campaign->results[i].series[r];
            char name[sizeof files->name];
            if (*series != NULL) {
                (void)snprintf(name, sizeof name, CAMPAIGN_SERIES_FOLDER "/%d_%s.csv", flight->number,
                               series_name(flight->run[r]));
                name_file(&files[count++], name, (const char *const *)series, 1);
            }
        }
    }
    name_file(&files[count++], "cases.csv", rows, campaign->plan.count + 1);
    name_file(&files[count++], "campaign.json", facts, 1);
    return count;
}

static const char *write_files(const campaign_t *campaign, const counts_t *counts, double wall_s) {
    char *header = text_of_header();
    char *facts = text_of_facts(campaign, counts, wall_s);
    const char **rows = malloc((campaign->plan.count + 1) * sizeof *rows);
    campaign_file_t *files = malloc((counts->series + 2) * sizeof *files);
    const char *fault = "out of memory";
    if (header != NULL && facts != NULL && rows != NULL && files != NULL) {
        const char *const whole_facts = facts;
        rows[0] = header;
        for (size_t i = 0; i < campaign->plan.count; i++) {
            rows[i + 1] = campaign->results[i].rows;
        }
        fault = campaign_files_write(campaign->options->out, files, list_files(campaign, rows, &whole_facts, files));
    }
    free(files);
    free(rows);
    free(facts);
    free(header);
    return fault;
}

/* --------------------------------------------------------------------------------------------------------- campaign -- */

static bool fly_and_write(const campaign_t *campaign, const char **fault) {
    const options_t *options = campaign->options;
    progress_t progress;
    progress_start(&progress, "flights", campaign->plan.count, options->quiet != 0);
    campaign_t shared = *campaign;
    const bool worked = work_pool_run(options->jobs, campaign->plan.count, fly, &shared, progress_show, &progress);
    progress_end(&progress);
    *fault = worked ? NULL : "no thread could be started";
    if (!worked || !check_results(campaign)) {
        return false;
    }
    const counts_t counts = count_results(campaign);
    const double wall_s = progress_elapsed_s(&progress);
    *fault = write_files(campaign, &counts, wall_s);
    if (*fault == NULL && !options->quiet) {
        (void)printf("%zu flights, %zu frames, %zu runs in %.1f s: %s/cases.csv\n", campaign->plan.count, counts.frames,
                     counts.runs, progress_elapsed_s(&progress), options->out);
    }
    return *fault == NULL;
}

static void free_results(result_t *results, size_t count) {
    for (size_t i = 0; i < count; i++) {
        free(results[i].rows);
        for (int r = 0; r < PLAN_RUNS_MAX; r++) {
            free(results[i].series[r]);
        }
    }
    free(results);
}

static bool run_campaign(const options_t *options) {
    campaign_t campaign = {options, {NULL, 0}, NULL};
    const char *fault = "out of memory";
    bool done = false;
    if (campaign_plan_make(options->studies, options->seeds, &campaign.plan)) {
        campaign_plan_keep_part(&campaign.plan, options->part, options->parts);
        campaign.results = calloc(campaign.plan.count + 1, sizeof *campaign.results); /* a part may be empty */
        done = campaign.results != NULL && fly_and_write(&campaign, &fault);
    }
    if (!done && fault != NULL) {
        (void)give_up(options->out, fault);
    }
    if (campaign.results != NULL) {
        free_results(campaign.results, campaign.plan.count);
    }
    campaign_plan_free(&campaign.plan);
    return done;
}

/* ------------------------------------------------------------------------------------------------------------- main -- */

static void print_help(poptContext context) {
    poptPrintHelp(context, stdout, 0);
    (void)puts(
        "\nDIR gets cases.csv (one row for each run and each part of it that statistics are over: the last 20, 40, 60\n"
        "and 100 % of the solved images), series/CASE_RUN.csv (estimates, truth and errors over time, of the\n"
        "paper's study, seed 1; RUN: the window method's model, or filter) and campaign.json. Studies: " STUDY_GROUPS
        ".\n"
        "\nExit status: 0 done; 2 bad usage or DIR cannot be written, then it is as it was.");
}

static bool run(poptContext context, options_t *options) {
    if (poptPeekArg(context) != NULL) {
        return complain(poptPeekArg(context), "options only");
    }
    if (options->help) {
        print_help(context);
    } else if (options->version) {
        (void)puts(PROGRAM " " GOE_VERSION);
    } else if (!check_options(options) || !run_campaign(options)) {
        return false;
    }
    return standard_output_written(PROGRAM);
}

int main(int argc, char **argv) {
    options_t options = {.seeds = 1, .jobs = work_pool_cores()};
    const struct poptOption table[] = {
        {"seeds", 0, POPT_ARG_INT | POPT_ARGFLAG_SHOW_DEFAULT, &options.seeds, 0,
         "fly everything with the seeds 1 to N", "N"},
        {"jobs", 'j', POPT_ARG_INT, &options.jobs, 0, "flights at a time; all cores by default", "N"},
        {"out", 'o', POPT_ARG_STRING, &options.out_text, 0, "where to write; " DEFAULT_FOLDER " by default", "DIR"},
        {"studies", 0, POPT_ARG_STRING, &options.studies_text, 0, "names with commas between them; all by default",
         "NAMES"},
        {"part", 0, POPT_ARG_STRING, &options.part_text, 0,
         "fly part K of N only, for several machines: cases.csv of all parts in order is that of the whole", "K/N"},
        {"series", 0, POPT_ARG_NONE, &options.all_series, 0,
         "series of all the paper's cases, not only of those that the figures show", NULL},
        {"quiet", 'q', POPT_ARG_NONE, &options.quiet, 0, "no progress bar, no summary", NULL},
        {"help", 'h', POPT_ARG_NONE, &options.help, 0, "print this and exit", NULL},
        {"version", 0, POPT_ARG_NONE, &options.version, 0, "print the version and exit", NULL},
        POPT_TABLEEND};
    const char **arguments = (void *)argv; /* popt reads them only */
    poptContext context = poptGetContext(PROGRAM, argc, arguments, table, 0);
    bool done = false;
    const int result = context == NULL ? 0 : poptGetNextOpt(context);
    if (context == NULL) {
        (void)give_up("options", "out of memory");
    } else if (result < -1) {
        const char *bad = option_blamed(context, argc, arguments);
        char reason[OPTION_FAULT_MAX];
        option_fault(reason, context, table, bad, result);
        (void)complain(bad, reason);
    } else {
        done = run(context, &options);
    }
    (void)poptFreeContext(context);
    free(options.out_text);
    free(options.studies_text);
    free(options.part_text);
    return done ? EXIT_DONE : EXIT_FAILED;
}
