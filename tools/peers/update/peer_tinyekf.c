/* TinyEKF with 10 states and 9 measurements. The attitude noise common to the rows of an image is in the matrix of the
 * measurement noise. SPDX-License-Identifier: MIT */
#define EKF_N 10
#define EKF_M 9
#include <tinyekf.h>

#include "peer.h"

_Static_assert(EKF_N == PEER_STATES && EKF_M == PEER_ROWS, "job.h describes another filter");

typedef struct {
    ekf_t ekf;
    float row[EKF_M * EKF_N];
    float measured[EKF_M];
    float shared[EKF_M][PEER_NUISANCES];
    float nuisance_root;
} state_t;

static state_t states[PEER_SLOTS];

void peer_prepare(int slot, const peer_case_t *given) {
    state_t *state = &states[slot];
    memset(state, 0, sizeof *state);
    memcpy(state->ekf.P, given->covariance, sizeof given->covariance);
    state->nuisance_root = given->nuisance_root;
    for (int i = 0; i < EKF_M; i++) {
        for (int c = 0; c < PEER_NUISANCES; c++) {
            state->shared[i][c] = given->measured[i][c];
        }
        for (int j = 0; j < EKF_N; j++) {
            state->row[i * EKF_N + j] = given->measured[i][PEER_NUISANCES + j];
        }
        state->measured[i] = given->measured[i][PEER_RESIDUAL];
    }
}

void peer_solve(int slot) {
    static const float predicted[EKF_M] = {0.0f}; /* the residual is the measurement */
    state_t *state = &states[slot];
    float noise[EKF_M * EKF_M];
    const float variance = 1.0f / (state->nuisance_root * state->nuisance_root);
    for (int i = 0; i < EKF_M; i++) {
        const float *a = state->shared[i];
        for (int k = 0; k <= i; k++) {
            const float *b = state->shared[k];
            const float sum = variance * (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
            noise[i * EKF_M + k] = sum;
            noise[k * EKF_M + i] = sum;
        }
        noise[i * EKF_M + i] += 1.0f;
    }
    (void)ekf_update(&state->ekf, state->measured, predicted, state->row, noise);
}

void peer_answer(int slot, peer_answer_t *answer) {
    memset(answer, 0, sizeof *answer);
    memcpy(answer->change, states[slot].ekf.x, sizeof answer->change);
    memcpy(answer->held, states[slot].ekf.P, sizeof answer->held);
}
