/* The upright bounding box of a solid. SPDX-License-Identifier: MIT */
#include "upright.h"

#include <math.h>
#include <string.h>

#include "scene.h"

#define TWO_PI 6.283185307179586
#define RESIDUAL_BOUND 3.0e-6 /* rounding, for derivatives of 1 */
#define SLOPE_BOUND 2.0e-3    /* of the largest derivative by a state */

void upright_roll(sighting_t *sighting, double rad) {
    float *r = sighting->sight.camera_to_axes;
    for (int i = 0; i < 3; i++) {
        const double x = (double)r[3 * i];
        const double y = (double)r[3 * i + 1];
        r[3 * i] = (float)(x * cos(rad) + y * sin(rad));
        r[3 * i + 1] = (float)(y * cos(rad) - x * sin(rad));
    }
}

/* Raw coordinate along a side's axis, focal lengths. */
static double coordinate(const upright_t *solid, const double state[GOE_STATES], size_t side, double at, bool foot) {
    const sighting_t *sighting = solid->sighting;
    double point[3];
    double seen[2];
    double in_camera[3];
    double raw[2];
    solid->point(state, side, at, foot, point);
    sighting_project(sighting, state, point, seen);
    for (int i = 0; i < 3; i++) {
        const float *r = sighting->sight.camera_to_axes;
        in_camera[i] = (double)r[i] * seen[0] + (double)r[3 + i] * seen[1] + (double)r[6 + i];
    }
    scene_distort(&sighting->settings.camera, in_camera[0] / in_camera[2], in_camera[1] / in_camera[2], &raw[0],
                  &raw[1]);
    return raw[side & 1u];
}

/* The farthest of the corners; of a rim, the best of some points and two parabolas about it, each with a smaller step. */
static double farthest(const upright_t *solid, const double state[GOE_STATES], size_t side, double sign, bool foot) {
    const double scale = solid->is_round ? TWO_PI / solid->points : 1.0;
    double best = -1.0e9;
    double at = 0.0;
    for (int i = 0; i < solid->points; i++) {
        const double seen = sign * coordinate(solid, state, side, i * scale, foot);
        at = seen > best ? i * scale : at;
        best = seen > best ? seen : best;
    }
    for (double step = scale; solid->is_round && step > 1.0e-4; step *= 0.03) {
        const double a = sign * coordinate(solid, state, side, at - step, foot);
        const double b = sign * coordinate(solid, state, side, at, foot);
        const double c = sign * coordinate(solid, state, side, at + step, foot);
        const double curve = a - 2.0 * b + c;
        at += curve < 0.0 ? 0.5 * step * (a - c) / curve : 0.0;
    }
    return sign * coordinate(solid, state, side, at, foot);
}

/* The box's side: the extreme of foot and roof. */
static double extreme(const upright_t *solid, const double state[GOE_STATES], size_t side) {
    const double sign = side < 2 ? -1.0 : 1.0;
    const double foot = farthest(solid, state, side, sign, true);
    const double head = farthest(solid, state, side, sign, false);
    return sign * (foot > head ? foot : head);
}

void upright_measure(const upright_t *solid, const double state[GOE_STATES], goe_sides_t *sides) {
    const goe_camera_t *camera = &solid->sighting->settings.camera;
    for (size_t side = 0; side < GOE_BOX_SIDES; side++) {
        const float focal_px = (side & 1u) ? camera->fy_px : camera->fx_px;
        const float center_px = (side & 1u) ? camera->cy_px : camera->cx_px;
        sides->px[side] = (float)extreme(solid, state, side) * focal_px + center_px;
    }
    sides->usable = GOE_SIDES_ALL;
    sides->cut = false;
    sides->doubtful = 0;
}

static double slope(const upright_t *solid, const double truth[GOE_STATES], size_t side, int i) {
    const double step = i == GOE_INVERSE_RANGE ? solid->step * 1.0e-2 : solid->step;
    double up[GOE_STATES];
    double down[GOE_STATES];
    memcpy(up, truth, sizeof up);
    memcpy(down, truth, sizeof down);
    up[i] += step;
    down[i] -= step;
    return (extreme(solid, up, side) - extreme(solid, down, side)) / (2.0 * step);
}

void upright_check_row(const upright_t *solid, const double truth[GOE_STATES], size_t side,
                       const float row[GOE_COLUMNS]) {
    const double steep = 1.0 + fabs((double)row[0]) + fabs((double)row[1]);
    double slopes[GOE_STATES];
    double largest = 1.0;
    CHECK_CLOSE(RESIDUAL_BOUND * steep, 0.0, row[GOE_RESIDUAL]);
    for (int i = 0; i < GOE_STATES; i++) {
        slopes[i] = slope(solid, truth, side, i);
        largest = fabs(slopes[i]) > largest && i != GOE_INVERSE_RANGE ? fabs(slopes[i]) : largest;
    }
    for (size_t i = 0; i < GOE_STATES; i++) {
        const double scale = i == GOE_INVERSE_RANGE ? 100.0 * largest : largest;
        CHECK_CLOSE(SLOPE_BOUND * scale, slopes[i], row[GOE_STATE_COLUMN + i]);
    }
}
