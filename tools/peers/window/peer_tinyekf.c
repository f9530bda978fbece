/* TinyEKF: not a window, but what a filter's step costs: 3 states, 2 rows of one image, predicted and updated once.
 * SPDX-License-Identifier: MIT */
#define EKF_N 3
#define EKF_M 2
#include <tinyekf.h>

#include "dense.h"

static ekf_t ekf;
static float rows[DENSE_ROWS * DENSE_COLUMNS];
static float right[DENSE_ROWS];

static void step(int k) {
    static const float identity[9] = {1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f};
    static const float drift[9] = {0.0f};
    static const float noise[4] = {1.0e-2f, 0.0f, 0.0f, 1.0e-2f};
    const float *h = &rows[2 * k * DENSE_COLUMNS];
    const float fx[3] = {ekf.x[0], ekf.x[1], ekf.x[2]};
    const float hx[2] = {h[0] * fx[0] + h[1] * fx[1] + h[2] * fx[2], h[3] * fx[0] + h[4] * fx[1] + h[5] * fx[2]};
    ekf_predict(&ekf, fx, identity, drift);
    (void)ekf_update(&ekf, &right[2 * k], hx, h, noise);
}

/* All points but the last. */
void peer_prepare(const peer_window_t *window) {
    static const float wide[3] = {1.0e2f, 1.0e3f, 1.0f};
    dense_system(window, rows, right);
    ekf_initialize(&ekf, wide);
    for (int k = 0; k + 1 < PEER_POINTS; k++) {
        step(k);
    }
}

void peer_solve(const peer_window_t *window, peer_solution_t *solution) {
    const ekf_t before = ekf;
    (void)window;
    step(PEER_POINTS - 1);
    dense_solution(ekf.x, solution);
    ekf = before;
}
