/* One image as the filter method sees it. SPDX-License-Identifier: MIT */
#include "sighting.h"

#include <math.h>
#include <string.h>

#include "maths/goe_angle.h"

#define STEP 1.0e-6
#define RESIDUAL_BOUND 2.0e-6 /* rounding of a state that a close range divides by, for derivatives of 1 */
#define SLOPE_BOUND 2.0e-3    /* of the largest derivative by a state, and the last digits of small differences */

static const goe_sides_t no_sides; /* an image without a box */
static const goe_kind_t no_kind;

/* Product of rotations about x, y, z. */
static void rotation_of(double x, double y, double z, double m[9]) {
    const double cx = cos(x);
    const double sx = sin(x);
    const double cy = cos(y);
    const double sy = sin(y);
    const double cz = cos(z);
    const double sz = sin(z);
    const double r[9] = {cz * cy,
                         cz * sy * sx - sz * cx,
                         cz * sy * cx + sz * sx,
                         sz * cy,
                         sz * sy * sx + cz * cx,
                         sz * sy * cx - cz * sx,
                         -sy,
                         cy * sx,
                         cy * cx};
    memcpy(m, r, sizeof r);
}

static void any_rotation(check_random_t *random, double most_rad, float m[9]) {
    double r[9];
    rotation_of(check_random_between(random, -most_rad, most_rad), check_random_between(random, -most_rad, most_rad),
                check_random_between(random, -most_rad, most_rad), r);
    for (int i = 0; i < 9; i++) {
        m[i] = (float)r[i];
    }
}

void sighting_start(sighting_t *sighting, check_random_t *random) {
    memset(sighting, 0, sizeof *sighting);
    goe_settings_default(&sighting->settings);
    sighting->settings.camera.cx_px = sighting->settings.camera.cy_px = 0.0f;
    sighting->settings.camera.width_px = sighting->settings.camera.height_px = 0.0f;
    sighting->settings.camera.fx_px = 914.0f;
    sighting->settings.camera.fy_px = 850.0f;
    sighting->sight.settings = &sighting->settings;
    sighting->sight.camera = &sighting->settings.camera;
    sighting->sight.sides = &no_sides;
    sighting->sight.kind = &no_kind;
    sighting->sight.point_px = sighting->settings.detector.point_noise_px;
    sighting->sight.side_px = sighting->settings.detector.box_noise_px;
    sighting->sight.white_rad = sighting->settings.navigation.attitude_white_sd_deg * GOE_RAD_PER_DEG;
    sighting->sight.height_sd_m = sighting->settings.navigation.height_bias_sd_m;
    sighting->sight.state = sighting->state;
    sighting->sight.camera_m.x = 3.0f;
    sighting->sight.camera_m.z = 25.0f;
    sighting->sight.height_m = 20.0f;
    any_rotation(random, 0.35, sighting->sight.camera_to_axes);
    any_rotation(random, 3.14, sighting->sight.body_to_axes);
    for (int i = 0; i < 3; i++) {
        sighting->state[i] = (float)check_random_between(random, -0.03, 0.03);
    }
    sighting_look(sighting);
}

void sighting_look(sighting_t *sighting) { goe_observation_linearise(&sighting->sight); }

void sighting_clear_rows(sighting_t *sighting) {
    sighting->sight.sure_m = sighting->sight.camera_m;
    sighting->sight.sure_height_m = sighting->sight.height_m;
    goe_rows_clear(&sighting->rows, &sighting->matrix);
}

static void attitude_bias(const sighting_t *sighting, const double state[GOE_STATES], double e[3]) {
    for (int i = 0; i < 3; i++) {
        const float *row = &sighting->sight.body_to_axes[3 * i];
        e[i] = (double)row[0] * state[0] + (double)row[1] * state[1] + (double)row[2] * state[2];
    }
}

double sighting_height(const sighting_t *sighting, const double state[GOE_STATES], size_t feature) {
    const double x = (double)sighting->sight.point[feature].x;
    const double y = (double)sighting->sight.point[feature].y;
    double e[3];
    attitude_bias(sighting, state, e);
    return y + e[0] * (1.0 + y * y) - e[2] * x - e[1] * x * y;
}

/* A ray r of the given axes is r + e x r in the true ones, and the other way round with the other sign. */
void sighting_project(const sighting_t *sighting, const double state[GOE_STATES], const double point[3],
                      double seen[2]) {
    double e[3];
    attitude_bias(sighting, state, e);
    const double x = point[0] + e[1] * point[2] - e[2] * point[1];
    const double y = point[1] + e[2] * point[0] - e[0] * point[2];
    const double z = point[2] + e[0] * point[1] - e[1] * point[0];
    seen[0] = x / z;
    seen[1] = y / z;
}

double sighting_place(sighting_t *sighting, check_random_t *random) {
    sighting_start(sighting, random);
    const double z0_m = check_random_between(random, 60.0, 200.0);
    sighting->state[GOE_GROUND] = (float)(check_random_between(random, -1.0, 1.0) / z0_m);
    sighting->state[GOE_BEARING] = (float)check_random_between(random, -0.5, 0.5);
    sighting->state[GOE_INVERSE_RANGE] = (float)(1.0 / z0_m);
    return z0_m;
}

void sighting_finish(sighting_t *sighting, check_random_t *random, double z0_m, double truth[GOE_STATES]) {
    sighting->state[GOE_TOP] = (float)(check_random_between(random, 2.0, 60.0) / z0_m);
    sighting->settings.filter.top_is_highest = check_random_bits(random) % 2u != 0u;
    for (int i = 0; i < GOE_STATES; i++) {
        truth[i] = (double)sighting->state[i];
    }
    sighting_look(sighting);
}

void sighting_check_rows(sighting_t *sighting, sighting_predict_t predict) {
    double state[GOE_STATES];
    goe_rows_end(&sighting->rows, &sighting->sight);
    for (int i = 0; i < GOE_STATES; i++) {
        state[i] = (double)sighting->state[i];
    }
    for (size_t row = 0; row < sighting->rows.count; row++) {
        double slope[GOE_STATES];
        double largest = 1.0;
        TEST_ASSERT_TRUE(sighting->rows.variance[row] > 0.0f);
        const double steep =
            1.0 + fabs((double)sighting->matrix.row[row][0]) + fabs((double)sighting->matrix.row[row][1]);
        CHECK_CLOSE(RESIDUAL_BOUND * steep, 0.0, sighting->matrix.row[row][GOE_RESIDUAL]);
        for (int i = 0; i < GOE_STATES; i++) {
            const double step = i == GOE_INVERSE_RANGE ? STEP * 1.0e-2 : STEP;
            double up[GOE_STATES];
            double down[GOE_STATES];
            memcpy(up, state, sizeof up);
            memcpy(down, state, sizeof down);
            up[i] += step;
            down[i] -= step;
            slope[i] = (predict(sighting, up, row) - predict(sighting, down, row)) / (2.0 * step);
            largest = fabs(slope[i]) > largest && i != GOE_INVERSE_RANGE ? fabs(slope[i]) : largest;
        }
        for (size_t i = 0; i < GOE_STATES; i++) {
            const double scale = i == GOE_INVERSE_RANGE ? 100.0 * largest : largest;
            CHECK_CLOSE(SLOPE_BOUND * scale, slope[i], sighting->matrix.row[row][GOE_STATE_COLUMN + i]);
        }
    }
    for (size_t row = sighting->rows.count; row < GOE_ROWS_MAX; row++) {
        for (size_t c = 0; c < GOE_COLUMNS; c++) {
            TEST_ASSERT_EQUAL_FLOAT(0.0f, sighting->matrix.row[row][c]);
        }
    }
}
