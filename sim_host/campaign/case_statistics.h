/*
 * How far the estimates of one run are off.
 *
 * The truth is what the estimate means, from the true motion, with the true camera of the first frame as the origin:
 *   disc, prism   reference point = the obstacle's center
 *   line, box     reference point = middle of the front edge
 * Which side of a box is called the side edge is a convention; near 45 degrees noise decides it. An estimate that calls the
 * other one so (its orientation is more than 45 degrees off, modulo 180) is compared with the truth renamed accordingly:
 * width and length change places, the front edge is the other one, the orientation differs by 90 degrees.
 *
 * Only frames that were solved count: those whose image gave a solution of its own. A run that switches from the disc to the
 * line, or from the prism to the box, can also be judged by its frames of one model alone.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#ifndef CASE_STATISTICS_H
#define CASE_STATISTICS_H

#include <stdbool.h>
#include <stddef.h>

#include "case_run.h"

typedef enum {
    CASE_Z0,
    CASE_X0,
    CASE_WIDTH,
    CASE_LENGTH,
    CASE_HEIGHT,
    CASE_ORIENTATION,
    CASE_QUANTITIES
} case_quantity_t;

/* Meters or degrees; NaN where there is none. */
typedef struct {
    double truth[CASE_QUANTITIES], error[CASE_QUANTITIES]; /* error: estimate minus truth */
    bool swapped;                                          /* the truth was renamed */
} case_errors_t;

case_errors_t case_errors(const flight_log_t *log, const goe_estimate_t *estimate);

typedef struct {
    double truth;     /* of the last frame used */
    double mean;      /* of the errors */
    double two_sigma; /* two standard deviations of the errors from their mean: sqrt(sum/n) */
    double rmse;      /* rmse^2 = mean^2 + (two_sigma / 2)^2 */
} error_statistics_t; /* NaN where there is no estimate */

typedef struct {
    size_t frames, solved, used; /* used: the last ones of those solved */
    double line_share;           /* line or box, of the frames used; NaN if there are none */
    bool swapped;                /* in the last frame used */
    error_statistics_t quantity[CASE_QUANTITIES];
    double covered[CASE_QUANTITIES]; /* share of the answers within 2 of their own sigmas; NaN without answers */
    double baseline_m, condition;    /* medians over the frames used; condition: NaN in a filter run */
} case_statistics_t;

/* Statistics over the last fraction (0 to 1) of the frames that were solved with a model, rounded up; GOE_MODEL_AUTO: with
 * any. samples: one for each frame of log. False if memory is short. */
bool case_statistics(const flight_log_t *log, const case_sample_t *samples, goe_model_t model, double fraction,
                     case_statistics_t *result);

/* Condition number (largest over smallest singular value) of the 2N x 3 matrix of (5) with its columns as the paper writes
 * them: for X0/W, Z0/W and 1/W. A rotation of the pairs of rows leaves singular values as they are, so the orientation
 * drops out. N: count of points. Infinite without a baseline. */
double window_condition(const goe_fit_point_t *points, int count);

#endif
