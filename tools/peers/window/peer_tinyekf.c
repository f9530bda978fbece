/* TinyEKF: not a window, but the cost of a filter's step: 3 states, 2 rows of one image, one prediction and update.
 * SPDX-License-Identifier: MIT */
#define EKF_N 3
#define EKF_M 2
#include <tinyekf.h>

#include "dense.h"

static ekf_t before[PEER_SLOTS], after[PEER_SLOTS];
static float rows[PEER_SLOTS][DENSE_ROWS * DENSE_COLUMNS];
static float right[PEER_SLOTS][DENSE_ROWS];

static void step(ekf_t *ekf, const float *h, const float *measured) {
    static const float identity[9] = {1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f};
    static const float drift[9] = {0.0f};
    static const float noise[4] = {1.0e-2f, 0.0f, 0.0f, 1.0e-2f};
    const float fx[3] = {ekf->x[0], ekf->x[1], ekf->x[2]};
    const float hx[2] = {h[0] * fx[0] + h[1] * fx[1] + h[2] * fx[2], h[3] * fx[0] + h[4] * fx[1] + h[5] * fx[2]};
    ekf_predict(ekf, fx, identity, drift);
    (void)ekf_update(ekf, measured, hx, h, noise);
}

/* All points but the last. */
void peer_prepare(int slot, const peer_case_t *given) {
    static const float wide[3] = {1.0e2f, 1.0e3f, 1.0f};
    dense_system(given, rows[slot], right[slot]);
    ekf_initialize(&before[slot], wide);
    for (int k = 0; k + 1 < PEER_POINTS; k++) {
        step(&before[slot], &rows[slot][2 * k * DENSE_COLUMNS], &right[slot][2 * k]);
    }
}

void peer_solve(int slot) {
    const int k = PEER_POINTS - 1;
    after[slot] = before[slot];
    step(&after[slot], &rows[slot][2 * k * DENSE_COLUMNS], &right[slot][2 * k]);
}

void peer_answer(int slot, peer_answer_t *answer) { dense_solution(after[slot].x, answer); }
