/*
 * The intended path over the ground, in path axes: z along the course from the start, x to its right; and the speed along it.
 *
 *   straight      x = 0
 *   arc           circle of signed radius R, tangent to the course at the start; R > 0 turns right
 *   weave         x = A sin(2 pi z / (speed T)): the start lies on the course, the first bend goes right if A > 0
 *
 * Before its start (negative progress) every path runs straight on along its tangent.
 * Progress is the length flown for straight and arc, and z for weave.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#ifndef SIM_PATH_H
#define SIM_PATH_H

#include <stdbool.h>

typedef enum { PATH_STRAIGHT, PATH_ARC, PATH_WEAVE } path_kind_t;

typedef struct {
    path_kind_t kind;
    double radius_m;              /* arc */
    double amplitude_m, period_s; /* weave */
    double wavelength_m;          /* weave: speed times period, set by path_prepare */
    double acceleration_mps2;     /* speed profile; 0 = constant */
} path_t;

typedef struct {
    double z_m, x_m;
    double course_rad; /* of the tangent, clockwise from the z axis */
    double curvature;  /* 1/m, positive turns right */
} path_point_t;

bool path_parse(const char *text, path_t *path);       /* straight | arc:R | weave:A,T; leaves the speed profile */
bool path_parse_speed(const char *text, path_t *path); /* constant | ramp:A */
void path_prepare(path_t *path, double speed_mps);

path_point_t path_at(const path_t *path, double progress_m);

/* Progress of the path point abeam of (z, x); of an arc within half a turn of the start. */
double path_progress(const path_t *path, double z_m, double x_m);

/* Progress a point makes that flies this length from the start along the path. */
double path_progress_of_length(const path_t *path, double length_m);

/* Intended ground speed at a time, kept within the limits; and the length flown by then. */
double path_speed(const path_t *path, double speed_mps, double t_s, double lowest_mps, double highest_mps);
double path_length(const path_t *path, double speed_mps, double t_s, double lowest_mps, double highest_mps);

#endif
