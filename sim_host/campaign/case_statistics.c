/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "case_statistics.h"

#include <math.h>
#include <stdlib.h>

/* ---------------------------------------------------------------------------------------------------------- errors -- */

static const double NONE = (double)NAN;

/* Into (-90, 90]: the difference of two axes. */
static double fold_deg(double angle_deg) {
    const double folded = remainder(angle_deg, 180.0);
    return folded <= -90.0 ? folded + 180.0 : folded;
}

static bool has_front_edge(const goe_estimate_t *estimate) {
    return estimate->model == GOE_MODEL_LINE || estimate->model == GOE_MODEL_BOX;
}

/* The box as the estimate names its sides, from the front edge: the truth of the line and the box model. */
static void set_edge_truth(const flight_log_t *log, bool swapped, double truth[CASE_QUANTITIES]) {
    const obstacle_t *box = &log->obstacle;
    const double length_m = swapped ? box->width_m : box->length_m;
    const double axis_rad = radians(truth[CASE_ORIENTATION]);
    truth[CASE_WIDTH] = swapped ? box->length_m : box->width_m;
    truth[CASE_LENGTH] = length_m;
    truth[CASE_Z0] = log->z0_m - 0.5 * length_m * cos(axis_rad);
    truth[CASE_X0] = log->x0_m - 0.5 * length_m * sin(axis_rad);
}

static bool set_truth(const flight_log_t *log, const goe_estimate_t *estimate, double truth[CASE_QUANTITIES]) {
    const obstacle_t *obstacle = &log->obstacle;
    truth[CASE_Z0] = log->z0_m;
    truth[CASE_X0] = log->x0_m;
    truth[CASE_WIDTH] = obstacle->width_m;
    truth[CASE_LENGTH] = NONE;
    truth[CASE_HEIGHT] = obstacle->height_m;
    truth[CASE_ORIENTATION] = NONE;
    if (obstacle->kind != OBSTACLE_BOX) {
        return false;
    }
    const bool swapped = (estimate->valid & GOE_HAS_ORIENTATION) != 0 &&
                         fabs(fold_deg((double)estimate->orientation_deg - log->orientation_deg)) > 45.0;
    truth[CASE_LENGTH] = obstacle->length_m;
    truth[CASE_ORIENTATION] = swapped ? fold_deg(log->orientation_deg + 90.0) : log->orientation_deg;
    if (has_front_edge(estimate)) {
        set_edge_truth(log, swapped, truth);
    }
    return swapped;
}

case_errors_t case_errors(const flight_log_t *log, const goe_estimate_t *estimate) {
    case_errors_t e;
    e.swapped = set_truth(log, estimate, e.truth);
    const bool located = (estimate->valid & GOE_HAS_POSITION) != 0;
    const bool wide_known = (estimate->valid & GOE_HAS_WIDTH) != 0;
    const bool long_known = (estimate->valid & GOE_HAS_LENGTH) != 0;
    const bool high_known = (estimate->valid & GOE_HAS_HEIGHT) != 0;
    const bool turned = (estimate->valid & GOE_HAS_ORIENTATION) != 0;
    e.error[CASE_Z0] = located ? (double)estimate->z0_m - e.truth[CASE_Z0] : NONE;
    e.error[CASE_X0] = located ? (double)estimate->x0_m - e.truth[CASE_X0] : NONE;
    e.error[CASE_WIDTH] = wide_known ? (double)estimate->width_m - e.truth[CASE_WIDTH] : NONE;
    e.error[CASE_LENGTH] = long_known ? (double)estimate->length_m - e.truth[CASE_LENGTH] : NONE;
    e.error[CASE_HEIGHT] = high_known ? (double)estimate->height_m - e.truth[CASE_HEIGHT] : NONE;
    e.error[CASE_ORIENTATION] = turned ? fold_deg((double)estimate->orientation_deg - e.truth[CASE_ORIENTATION]) : NONE;
    return e;
}

/* ------------------------------------------------------------------------------------------------------- statistics -- */

static int compare_numbers(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Of at least one number; sorts them. */
static double median(double *numbers, size_t count) {
    qsort(numbers, count, sizeof *numbers, compare_numbers);
    return count % 2 == 1 ? numbers[count / 2] : 0.5 * (numbers[count / 2 - 1] + numbers[count / 2]);
}

/* Mean, then deviations from it: errors are large compared with their spread. */
static error_statistics_t describe(const case_errors_t *errors, size_t count, case_quantity_t quantity) {
    error_statistics_t s = {errors[count - 1].truth[quantity], NONE, NONE, NONE};
    double sum = 0.0, squares = 0.0, deviations = 0.0;
    size_t there = 0;
    for (size_t i = 0; i < count; i++) {
        const double error = errors[i].error[quantity];
        if (!isnan(error)) {
            sum += error;
            squares += error * error;
            there++;
        }
    }
    if (there == 0) {
        return s;
    }
    s.mean = sum / (double)there;
    s.rmse = sqrt(squares / (double)there);
    for (size_t i = 0; i < count; i++) {
        const double error = errors[i].error[quantity];
        deviations += isnan(error) ? 0.0 : (error - s.mean) * (error - s.mean);
    }
    s.two_sigma = 2.0 * sqrt(deviations / (double)there);
    return s;
}

static double sigma_of(const goe_estimate_t *estimate, case_quantity_t quantity) {
    const goe_sigma_t *sigma = &estimate->sigma;
    const float by_quantity[CASE_QUANTITIES] = {
        [CASE_Z0] = sigma->z0_m,         [CASE_X0] = sigma->x0_m,         [CASE_WIDTH] = sigma->width_m,
        [CASE_LENGTH] = sigma->length_m, [CASE_HEIGHT] = sigma->height_m, [CASE_ORIENTATION] = sigma->orientation_deg,
    };
    return (double)by_quantity[quantity];
}

static double covered(const case_sample_t *const *used, const case_errors_t *errors, size_t count,
                      case_quantity_t quantity) {
    size_t there = 0, within = 0;
    for (size_t i = 0; i < count; i++) {
        const double error = errors[i].error[quantity];
        there += isnan(error) ? 0u : 1u;
        within += fabs(error) <= 2.0 * sigma_of(&used[i]->estimate, quantity) ? 1u : 0u;
    }
    return there > 0 ? (double)within / (double)there : NONE;
}

static void describe_nothing(const flight_log_t *log, const case_sample_t *samples, case_statistics_t *result) {
    const goe_estimate_t blank = {.model = GOE_MODEL_NONE};
    const case_errors_t errors = case_errors(log, log->count > 0 ? &samples[log->count - 1].estimate : &blank);
    for (int q = 0; q < CASE_QUANTITIES; q++) {
        const error_statistics_t none = {errors.truth[q], NONE, NONE, NONE};
        result->quantity[q] = none;
        result->covered[q] = NONE;
    }
    result->swapped = false;
    result->line_share = NONE;
    result->baseline_m = NONE;
    result->condition = NONE;
}

static bool counts(const goe_estimate_t *estimate, goe_model_t model) {
    return estimate->fresh && (model == GOE_MODEL_AUTO || estimate->model == model);
}

/* The frames that count, in order of time. solved: room for count of them. */
static size_t find_solved(const case_sample_t *samples, size_t count, goe_model_t model, const case_sample_t **solved) {
    size_t found = 0;
    for (size_t i = 0; i < count; i++) {
        if (counts(&samples[i].estimate, model)) {
            solved[found++] = &samples[i];
        }
    }
    return found;
}

/* used: result->used samples; errors and numbers: room for as many */
static void describe_used(const flight_log_t *log, const case_sample_t *const *used, case_errors_t *errors,
                          double *numbers, case_statistics_t *result) {
    const size_t count = result->used;
    size_t lines = 0;
    for (size_t i = 0; i < count; i++) {
        errors[i] = case_errors(log, &used[i]->estimate);
        lines += has_front_edge(&used[i]->estimate) ? 1u : 0u;
    }
    for (int q = 0; q < CASE_QUANTITIES; q++) {
        result->quantity[q] = describe(errors, count, (case_quantity_t)q);
        result->covered[q] = covered(used, errors, count, (case_quantity_t)q);
    }
    result->swapped = errors[count - 1].swapped;
    result->line_share = (double)lines / (double)count;
    for (size_t i = 0; i < count; i++) {
        numbers[i] = (double)used[i]->estimate.baseline_m;
    }
    result->baseline_m = median(numbers, count);
    for (size_t i = 0; i < count; i++) {
        numbers[i] = used[i]->condition;
    }
    result->condition = median(numbers, count);
}

bool case_statistics(const flight_log_t *log, const case_sample_t *samples, goe_model_t model, double fraction,
                     case_statistics_t *result) {
    const size_t capacity = log->count + 1; /* never 0 */
    const case_sample_t **solved = malloc(capacity * sizeof *solved);
    case_errors_t *errors = malloc(capacity * sizeof *errors);
    double *numbers = malloc(capacity * sizeof *numbers);
    const bool done = solved != NULL && errors != NULL && numbers != NULL;
    if (done) {
        result->frames = log->count;
        result->solved = find_solved(samples, log->count, model, solved);
        result->used = (size_t)ceil(fraction * (double)result->solved);
        if (result->used > 0) {
            describe_used(log, solved + (result->solved - result->used), errors, numbers, result);
        } else {
            describe_nothing(log, samples, result);
        }
    }
    free(numbers);
    free(errors);
    free(solved);
    return done;
}

/* ------------------------------------------------------------------------------------------------------- condition -- */

/* The rows are (1, 0, -dX) and (0, 1, -dZ), so A'A = [N 0 -a; 0 N -b; -a -b q] with the sums a, b of dX, dZ and q of their
 * squares. One eigenvalue is N; the others are those of [N -r; -r q], r^2 = a^2 + b^2, and lie on both sides of it. Their
 * product is N q - r^2 = N D with D the squared spread of the baseline, formed from deviations: nothing cancels. */
double window_condition(const goe_fit_point_t *points, int count) {
    const double n = (double)count;
    double a = 0.0, b = 0.0, q = 0.0, spread = 0.0;
    for (int i = 0; i < count; i++) {
        a += (double)points[i].dx_m;
        b += (double)points[i].dz_m;
    }
    for (int i = 0; i < count; i++) {
        const double x = (double)points[i].dx_m, z = (double)points[i].dz_m;
        q += x * x + z * z;
        spread += (x - a / n) * (x - a / n) + (z - b / n) * (z - b / n);
    }
    const double largest = 0.5 * (n + q + hypot(n - q, 2.0 * hypot(a, b)));
    return largest / sqrt(n * spread);
}
