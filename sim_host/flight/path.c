/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "path.h"

#include <math.h>
#include <string.h>

#include "rotation.h"
#include "text_numbers.h"

#define WEAVE_STEPS 2000    /* of the integration of a weave's length */
#define SHARPEST_TURN_M 1.0 /* radius */

bool path_parse(const char *text, path_t *path) {
    double value[2];
    if (strcmp(text, "straight") == 0) {
        path->kind = PATH_STRAIGHT;
        return true;
    }
    if (text_numbers(text, "arc:", value, 1)) {
        path->kind = PATH_ARC;
        path->radius_m = value[0];
        return fabs(path->radius_m) >= SHARPEST_TURN_M;
    }
    if (text_numbers(text, "weave:", value, 2)) {
        path->kind = PATH_WEAVE;
        path->amplitude_m = value[0];
        path->period_s = value[1];
        return path->period_s > 0.0;
    }
    return false;
}

bool path_parse_speed(const char *text, path_t *path) {
    path->acceleration_mps2 = 0.0;
    return strcmp(text, "constant") == 0 || text_numbers(text, "ramp:", &path->acceleration_mps2, 1);
}

void path_prepare(path_t *path, double speed_mps) { path->wavelength_m = speed_mps * path->period_s; }

static path_point_t weave_at(const path_t *path, double z) {
    const double k = 2.0 * SIM_PI / path->wavelength_m;
    const double slope = path->amplitude_m * k * cos(k * z);
    const double bend = -path->amplitude_m * k * k * sin(k * z);
    path_point_t point = {z, path->amplitude_m * sin(k * z), atan(slope), bend / pow(1.0 + slope * slope, 1.5)};
    return point;
}

static path_point_t arc_at(const path_t *path, double length) {
    const double angle = length / path->radius_m;
    path_point_t point = {path->radius_m * sin(angle), path->radius_m * (1.0 - cos(angle)), angle,
                          1.0 / path->radius_m};
    return point;
}

path_point_t path_at(const path_t *path, double progress_m) {
    path_point_t start = {0.0, 0.0, 0.0, 0.0};
    if (path->kind == PATH_ARC && progress_m >= 0.0) {
        return arc_at(path, progress_m);
    }
    if (path->kind == PATH_WEAVE) {
        start = weave_at(path, fmax(progress_m, 0.0));
        if (progress_m >= 0.0) {
            return start;
        }
    }
    start.z_m = progress_m;
    start.x_m = progress_m * tan(start.course_rad);
    start.curvature = 0.0;
    return start;
}

double path_progress(const path_t *path, double z_m, double x_m) {
    if (path->kind != PATH_ARC) {
        return z_m;
    }
    const double angle = atan2(z_m, path->radius_m > 0.0 ? path->radius_m - x_m : x_m - path->radius_m);
    return angle > 0.0 ? angle * fabs(path->radius_m) : z_m;
}

double path_progress_of_length(const path_t *path, double length_m) {
    if (path->kind != PATH_WEAVE) {
        return length_m;
    }
    double z = 0.0;
    for (int i = 0; i < WEAVE_STEPS; i++) {
        z += length_m / WEAVE_STEPS * cos(weave_at(path, z).course_rad);
    }
    return z;
}

double path_speed(const path_t *path, double speed_mps, double t_s, double lowest_mps, double highest_mps) {
    return clamp(speed_mps + path->acceleration_mps2 * fmax(t_s, 0.0), lowest_mps, highest_mps);
}

double path_length(const path_t *path, double speed_mps, double t_s, double lowest_mps, double highest_mps) {
    const double acceleration = path->acceleration_mps2;
    if (fabs(acceleration) <= 0.0) {
        return speed_mps * t_s;
    }
    const double limit = acceleration > 0.0 ? highest_mps : lowest_mps;
    const double ramp_s = fmin(t_s, (limit - speed_mps) / acceleration);
    return (speed_mps + 0.5 * acceleration * ramp_s) * ramp_s + limit * (t_s - ramp_s);
}
