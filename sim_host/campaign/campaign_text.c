/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "campaign_text.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

#define SMALLEST_TRUTH_M 1e-6 /* nothing is a percentage of less */
#define PERCENT 100.0
#define US_PER_S 1000000

/* By case_quantity_t. */
typedef struct {
    const char *name, *unit;
    bool in_percent; /* too */
} quantity_text_t;

static const quantity_text_t QUANTITIES[CASE_QUANTITIES] = {
    {"z0", "m", true},     {"x0", "m", true},      {"width", "m", true},
    {"length", "m", true}, {"height", "m", false}, {"orientation", "deg", false},
};

const char *campaign_text_model(goe_model_t model) {
    switch (model) {
        case GOE_MODEL_AUTO:
            return "auto";
        case GOE_MODEL_DISC:
            return "disc";
        case GOE_MODEL_LINE:
            return "line";
        case GOE_MODEL_BOX:
            return "box";
        case GOE_MODEL_PRISM:
            return "prism";
        case GOE_MODEL_NONE:
        default:
            return "none";
    }
}

const char *campaign_text_method(goe_method_t method) { return method == GOE_METHOD_FILTER ? "filter" : "window"; }

/* A field and the comma before it. */
static void put(FILE *stream, double value) {
    if (isfinite(value)) {
        (void)fprintf(stream, ",%.9g", value);
    } else {
        (void)fputc(',', stream);
    }
}

/* A name may contain a comma, but no quote. */
static void put_name(FILE *stream, const char *name) {
    (void)fprintf(stream, strchr(name, ',') != NULL ? ",\"%s\"" : ",%s", name);
}

/* ------------------------------------------------------------------------------------------------------- cases.csv -- */

void campaign_text_cases_header(FILE *stream) {
    (void)fputs("study,case,obstacle,side_m,alpha_deg,altitude_m,glide_deg,path,speed_profile,wind,noise,seed,window,"
                "method,model,fraction,frames,solved,used,fresh_line_share,swapped",
                stream);
    for (int q = 0; q < CASE_QUANTITIES; q++) {
        const char *name = QUANTITIES[q].name;
        (void)fprintf(stream, ",%s_truth,%s_mean,%s_two_sigma,%s_rmse", name, name, name, name);
    }
    for (int q = 0; q < CASE_QUANTITIES; q++) {
        const char *name = QUANTITIES[q].name;
        if (QUANTITIES[q].in_percent) {
            (void)fprintf(stream, ",%s_mean_pct,%s_two_sigma_pct,%s_rmse_pct", name, name, name);
        }
    }
    (void)fputs(",baseline_m,condition,fps_hz,roll_deg", stream);
    for (int q = 0; q < CASE_QUANTITIES; q++) {
        (void)fprintf(stream, ",%s_covered", QUANTITIES[q].name);
    }
    (void)fputc('\n', stream);
}

static void put_statistics(FILE *stream, const error_statistics_t *s) {
    put(stream, s->truth);
    put(stream, s->mean);
    put(stream, s->two_sigma);
    put(stream, s->rmse);
}

static void put_percentages(FILE *stream, const error_statistics_t *s) {
    const double unit = fabs(s->truth) > SMALLEST_TRUTH_M ? PERCENT / fabs(s->truth) : (double)NAN;
    put(stream, s->mean * unit);
    put(stream, s->two_sigma * unit);
    put(stream, s->rmse * unit);
}

void campaign_text_cases_row(FILE *stream, const planned_flight_t *flight, case_setting_t setting, double fraction,
                             const case_statistics_t *statistics) {
    const flight_case_t *setup = &flight->setup;
    (void)fprintf(stream, "%s,%d,%s", STUDY_NAMES[flight->study], flight->number, flight->obstacle);
    put(stream, setup->x0_m);
    put(stream, setup->alpha_deg);
    put(stream, setup->altitude_m);
    put(stream, setup->glide_deg);
    put_name(stream, flight->path);
    put_name(stream, flight->speed_profile);
    put_name(stream, flight->wind);
    put_name(stream, flight->noise);
    (void)fprintf(stream, ",%d,%d,%s,%s,%g,%zu,%zu,%zu", flight->seed, setting.window,
                  campaign_text_method(setting.method), campaign_text_model(setting.model), fraction,
                  statistics->frames, statistics->solved, statistics->used);
    put(stream, statistics->line_share);
    (void)fprintf(stream, ",%d", statistics->swapped ? 1 : 0);
    for (int q = 0; q < CASE_QUANTITIES; q++) {
        put_statistics(stream, &statistics->quantity[q]);
    }
    for (int q = 0; q < CASE_QUANTITIES; q++) {
        if (QUANTITIES[q].in_percent) {
            put_percentages(stream, &statistics->quantity[q]);
        }
    }
    put(stream, statistics->baseline_m);
    put(stream, statistics->condition);
    put(stream, setup->fps_hz);
    put(stream, setup->roll_amplitude_deg);
    for (int q = 0; q < CASE_QUANTITIES; q++) {
        put(stream, statistics->covered[q]);
    }
    (void)fputc('\n', stream);
}

/* ---------------------------------------------------------------------------------------------------------- series -- */

static void put_series_header(FILE *stream) {
    (void)fputs("t_s,status,model,x0_m,z0_m,width_m,length_m,height_m,orientation_deg,orientation_raw_deg,"
                "front_orientation_deg,x0_sd_m,z0_sd_m,width_sd_m,length_sd_m,height_sd_m,orientation_sd_deg",
                stream);
    for (int q = 0; q < CASE_QUANTITIES; q++) {
        (void)fprintf(stream, ",%s_true_%s", QUANTITIES[q].name, QUANTITIES[q].unit);
    }
    for (int q = 0; q < CASE_QUANTITIES; q++) {
        (void)fprintf(stream, ",%s_error_%s", QUANTITIES[q].name, QUANTITIES[q].unit);
    }
    (void)fputs(",swapped,baseline_m,condition\n", stream);
}

static void put_estimate(FILE *stream, const goe_estimate_t *estimate, unsigned has, float value) {
    put(stream, (estimate->valid & has) != 0 ? (double)value : (double)NAN);
}

static void put_series_row(FILE *stream, const flight_log_t *log, int64_t time_us, const case_sample_t *sample) {
    const goe_estimate_t *e = &sample->estimate;
    const case_errors_t errors = case_errors(log, e);
    (void)fprintf(stream, "%" PRId64 ".%06" PRId64 ",%s,%s", time_us / US_PER_S, time_us % US_PER_S,
                  goe_status_text(sample->status), campaign_text_model(e->model));
    put_estimate(stream, e, GOE_HAS_POSITION, e->x0_m);
    put_estimate(stream, e, GOE_HAS_POSITION, e->z0_m);
    put_estimate(stream, e, GOE_HAS_WIDTH, e->width_m);
    put_estimate(stream, e, GOE_HAS_LENGTH, e->length_m);
    put_estimate(stream, e, GOE_HAS_HEIGHT, e->height_m);
    put_estimate(stream, e, GOE_HAS_ORIENTATION, e->orientation_deg);
    put_estimate(stream, e, GOE_HAS_ORIENTATION, e->orientation_raw_deg);
    put_estimate(stream, e, GOE_HAS_ORIENTATION, e->front_orientation_deg);
    put_estimate(stream, e, GOE_HAS_POSITION, e->sigma.x0_m);
    put_estimate(stream, e, GOE_HAS_POSITION, e->sigma.z0_m);
    put_estimate(stream, e, GOE_HAS_WIDTH, e->sigma.width_m);
    put_estimate(stream, e, GOE_HAS_LENGTH, e->sigma.length_m);
    put_estimate(stream, e, GOE_HAS_HEIGHT, e->sigma.height_m);
    put_estimate(stream, e, GOE_HAS_ORIENTATION, e->sigma.orientation_deg);
    for (int q = 0; q < CASE_QUANTITIES; q++) {
        put(stream, errors.truth[q]);
    }
    for (int q = 0; q < CASE_QUANTITIES; q++) {
        put(stream, errors.error[q]);
    }
    (void)fprintf(stream, ",%d", errors.swapped ? 1 : 0);
    put(stream, e->fresh ? (double)e->baseline_m : (double)NAN);
    put(stream, sample->condition);
    (void)fputc('\n', stream);
}

void campaign_text_series(FILE *stream, const flight_log_t *log, const case_sample_t *samples) {
    put_series_header(stream);
    for (size_t i = 0; i < log->count; i++) {
        put_series_row(stream, log, log->frames[i].time_us, &samples[i]);
    }
}
