/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "log_hints.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

/* tools/goe_tools/logs/hints.py has the same rules. */
#define IMAGES_MIN 10
#define STEP_MAX_S 5.0    /* images farther apart, of an aircraft ... */
#define SPEED_MIN_M_S 0.5 /* ... that hardly moves and yet gets somewhere, are timed in milliseconds */
#define SPEED_MAX_M_S 150.0
#define WAY_MIN_M 5.0
#define MOVE_M 1.0
#define TILT_MAX 0.5   /* cosine: an attitude that is tilted by more than 60 degrees is odd */
#define AGAINST (-0.5) /* cosine: a nose that points so against the motion, too */
#define APART 0.87     /* cosine: a motion at more than 30 degrees to the nose */
#define ALONG 0.97     /* cosine: a motion within 14 degrees of it */
#define MOST 0.8       /* of the images */
#define FOOT_M 0.3048
#define FOOT_TOLERANCE 0.03
#define HEIGHT_SPREAD_M 2.0 /* one sigma; of less nothing is concluded */
#define CORRELATED 0.99

static bool is_finite(const frame_t *frame, frame_value_t name) {
    return frame->given[name] && isfinite(frame->value[name]);
}

static bool has_pose(const frame_t *frame) {
    bool has = isfinite(frame->time_s);
    for (int i = 0; i < 3; i++) {
        has = has && is_finite(frame, (frame_value_t)(FRAME_N_M + i));
    }
    for (int i = 0; i < 4; i++) {
        has = has && is_finite(frame, (frame_value_t)(FRAME_QW + i));
    }
    return has;
}

static bool is_broken(const frame_t *frame) {
    bool broken = !has_pose(frame);
    for (int i = 0; i < FRAME_VALUES; i++) {
        broken = broken || (frame->given[i] && !isfinite(frame->value[i]));
    }
    return broken;
}

/* Cosine between the nose and the motion, which has length 1, of a level attitude. */
static double nose_along(double w, double x, double y, double z, double north, double east) {
    return (w * w + x * x - y * y - z * z) * north + 2.0 * (x * y + w * z) * east;
}

/* Whether an attitude lies on its side, or looks against the motion. */
static bool is_odd(double w, double x, double y, double z, const double motion[2]) {
    const double down = w * w - x * x - y * y + z * z;
    return down < TILT_MAX || nose_along(w, x, y, z, motion[0], motion[1]) < AGAINST;
}

static void add_motion(log_hints_t *hints, const frame_t *frame) {
    const double *q = &frame->value[FRAME_QW];
    double motion[2];
    for (int i = 0; i < 2; i++) {
        motion[i] = frame->value[FRAME_N_M + i] - hints->anchor[i];
    }
    const double length = hypot(motion[0], motion[1]);
    if (length < MOVE_M) {
        return;
    }
    for (int i = 0; i < 2; i++) {
        motion[i] /= length;
        hints->anchor[i] = frame->value[FRAME_N_M + i];
    }
    hints->moves++;
    hints->odd += is_odd(q[0], q[1], q[2], q[3], motion) ? 1u : 0u;
    hints->odd_as_xyzw += is_odd(q[3], q[0], q[1], q[2], motion) ? 1u : 0u;
    hints->apart += nose_along(q[0], q[1], q[2], q[3], motion[0], motion[1]) < APART ? 1u : 0u;
    hints->along_exchanged += nose_along(q[0], q[1], q[2], q[3], motion[1], motion[0]) > ALONG ? 1u : 0u;
    hints->along_inverse += nose_along(q[0], -q[1], -q[2], -q[3], motion[0], motion[1]) > ALONG ? 1u : 0u;
}

static void add_height(log_hints_t *hints, const frame_t *frame) {
    const double up = -frame->value[FRAME_D_M], agl = frame->value[FRAME_AGL_M];
    if (!is_finite(frame, FRAME_AGL_M)) {
        hints->below += up < 0.0 && !frame->given[FRAME_AGL_M] ? 1u : 0u;
        return;
    }
    hints->below += agl < 0.0 ? 1u : 0u;
    const double ratio = agl / up;
    if (hints->heights++ == 0) {
        hints->first_up = up;
        hints->first_agl = agl;
        hints->ratio[0] = hints->ratio[1] = ratio;
    }
    hints->ratio[0] = fmin(hints->ratio[0], ratio);
    hints->ratio[1] = fmax(hints->ratio[1], ratio);
    const double u = up - hints->first_up, a = agl - hints->first_agl;
    hints->up[0] += u;
    hints->up[1] += u * u;
    hints->agl[0] += a;
    hints->agl[1] += a * a;
    hints->up_agl += u * a;
}

void log_hints_add(log_hints_t *hints, const frame_t *frame) {
    if (is_broken(frame) && hints->broken++ == 0) {
        hints->broken_line = frame->line;
    }
    if (!has_pose(frame) || (hints->images > 0 && !(frame->time_s > hints->last_s))) {
        return; /* another obstacle in the same image */
    }
    const double *position = &frame->value[FRAME_N_M];
    if (hints->images++ == 0) {
        hints->first_s = frame->time_s;
        hints->anchor[0] = position[0];
        hints->anchor[1] = position[1];
    } else {
        hints->way_m += hypot(position[0] - hints->last[0], position[1] - hints->last[1]);
    }
    hints->last_s = frame->time_s;
    (void)memcpy(hints->last, position, sizeof hints->last);
    add_motion(hints, frame);
    add_height(hints, frame);
}

void log_hints_late(log_hints_t *hints, const frame_t *frame) {
    if (hints->late++ == 0) {
        hints->late_line = frame->line;
    }
}

/* ----------------------------------------------------------------------------------------------------------- print -- */

typedef struct {
    const char *program, *file;
    FILE *stream;
} place_t;

static void begin(const place_t *place) {
    (void)fprintf(place->stream, "%s: warning: %s: ", place->program, place->file);
}

static void print_times(const log_hints_t *hints, const place_t *place) {
    const double span_s = hints->last_s - hints->first_s, step_s = span_s / (double)(hints->images - 1);
    const double speed = hints->way_m / span_s;
    if (hints->way_m > WAY_MIN_M && step_s > STEP_MAX_S && speed < SPEED_MIN_M_S) {
        begin(place);
        (void)fprintf(
            place->stream,
            "t_s: an image every %.3g s of an aircraft that flies %.2g m/s: milliseconds? t_s is in seconds\n", step_s,
            speed);
    } else if (speed > SPEED_MAX_M_S) {
        begin(place);
        (void)fprintf(place->stream,
                      "n_m, e_m: the aircraft flies %.3g m/s: feet? positions are in meters, t_s in seconds\n", speed);
    }
}

static bool is_most(unsigned long count, unsigned long of) { return (double)count > MOST * (double)of; }

static void print_attitude(const log_hints_t *hints, const place_t *place) {
    const unsigned long moves = hints->moves;
    const char *hint = NULL;
    if (moves < IMAGES_MIN) {
        return;
    }
    if (is_most(hints->odd, moves) && (double)hints->odd_as_xyzw < (1.0 - MOST) * (double)moves) {
        hint = "qw: the attitude does not fit the motion, and does if the quaternion is in the order x, y, z, w: qw is "
               "its real part";
    } else if (is_most(hints->apart, moves) && is_most(hints->along_exchanged, moves)) {
        hint =
            "n_m, e_m: the motion does not fit the heading, and does if the two are exchanged: is east the first? n_m "
            "is north";
    } else if (is_most(hints->apart, moves) && is_most(hints->along_inverse, moves)) {
        hint =
            "qw: the attitude does not fit the motion, and its inverse does: the quaternion turns the body's axes into "
            "north, east, down";
    }
    if (hint) {
        begin(place);
        (void)fprintf(place->stream, "%s\n", hint);
    }
}

static bool is_near(double ratio, double wanted) { return fabs(ratio / wanted - 1.0) < FOOT_TOLERANCE; }

/* 3.28, 0.305 or -1, by which agl_m changes with -d_m, or of which it is a multiple; 0: none of them. */
static double strange_ratio(const log_hints_t *hints) {
    static const double strange[] = {1.0 / FOOT_M, FOOT_M, -1.0};
    const double n = (double)hints->heights;
    const double up = hints->up[1] / n - hints->up[0] / n * hints->up[0] / n;
    const double agl = hints->agl[1] / n - hints->agl[0] / n * hints->agl[0] / n;
    const double both = hints->up_agl / n - hints->up[0] / n * hints->agl[0] / n;
    const bool varied = up > HEIGHT_SPREAD_M * HEIGHT_SPREAD_M * FOOT_M && both * both > CORRELATED * up * agl;
    for (size_t i = 0; i < sizeof strange / sizeof strange[0]; i++) {
        if ((varied && is_near(both / up, strange[i])) ||
            (is_near(hints->ratio[0], strange[i]) && is_near(hints->ratio[1], strange[i]))) {
            return strange[i];
        }
    }
    return 0.0;
}

static void print_heights(const log_hints_t *hints, const place_t *place) {
    const double ratio = hints->heights >= IMAGES_MIN ? strange_ratio(hints) : 0.0;
    if (ratio < 0.0 || is_most(hints->below, hints->images)) {
        const char *below = hints->heights > 0 ? "the camera is below the ground by agl_m"
                                               : "the camera is below the ground, and agl_m is empty";
        begin(place);
        (void)fprintf(place->stream, "d_m: %s: is it up? d_m is down, negative above the origin\n",
                      ratio < 0.0 ? "it grows as agl_m does" : below);
    } else if (ratio > 0.0) {
        begin(place);
        (void)fprintf(place->stream, "%s: %.3g times %s: feet? both are in meters\n", ratio > 1.0 ? "agl_m" : "d_m",
                      1.0 / FOOT_M, ratio > 1.0 ? "-d_m" : "-agl_m");
    }
}

void log_hints_print(const log_hints_t *hints, const char *program, const char *file, FILE *stream) {
    const place_t place = {program, file, stream};
    if (hints->broken > 0) {
        begin(&place);
        (void)fprintf(stream,
                      "%lu row%s without a finite pose or with a number that is not finite, the first in line %lu\n",
                      hints->broken, hints->broken == 1 ? "" : "s", hints->broken_line);
    }
    if (hints->late > 0) {
        begin(&place);
        (void)fprintf(stream,
                      "t_s: %lu row%s not later than the rows of the same id before, the first in line %lu: goe "
                      "refuses this as bad_time; sort the rows by t_s\n",
                      hints->late, hints->late == 1 ? " is" : "s are", hints->late_line);
    }
    if (hints->images >= IMAGES_MIN) {
        print_times(hints, &place);
        print_attitude(hints, &place);
        print_heights(hints, &place);
    }
}
