/* Bierman's sequential update of U D U' = covariance, row by row. The rows of an image have common attitude noise; the Cholesky
 * factor of their joint noise decorrelates them first: for nine rows that takes fewer operations than three additional
 * states. G. J. Bierman, Factorization Methods for Discrete Sequential Estimation, 1977.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "peer.h"

#define OWN (PEER_STATES + 1) /* columns of a row without the nuisances: states, residual */

typedef struct {
    float factors[PEER_TRIANGLE];           /* column by column, D where U has ones */
    float noise[PEER_ROWS][PEER_NUISANCES]; /* of each row, from the nuisances */
    float row[PEER_ROWS][OWN];
    int rows; /* used ones: a sequential update skips the others */
    float nuisance_root;
    float change[PEER_STATES];
    float nis;
} state_t;

static state_t states[PEER_SLOTS];

static int is_used(const peer_case_t *given, int row) {
    int used = 0;
    for (int c = 0; c < PEER_COLUMNS; c++) {
        used |= given->measured[row][c] != 0.0f;
    }
    return used;
}

void peer_prepare(int slot, const peer_case_t *given) {
    state_t *state = &states[slot];
    memset(state, 0, sizeof *state);
    memcpy(state->factors, given->factors, sizeof given->factors);
    state->nuisance_root = given->nuisance_root;
    for (int i = 0; i < PEER_ROWS; i++) {
        if (!is_used(given, i)) {
            continue;
        }
        for (int c = 0; c < PEER_NUISANCES; c++) {
            state->noise[state->rows][c] = given->measured[i][c];
        }
        for (int c = 0; c < OWN; c++) {
            state->row[state->rows][c] = given->measured[i][PEER_NUISANCES + c];
        }
        state->rows++;
    }
}

/* The joint noise of the rows is I + sigma^2 T T' = L L'; the rows are multiplied by L^-1. */
static void make_independent(state_t *state) {
    float l[PEER_ROWS][PEER_ROWS];
    float reciprocal[PEER_ROWS];
    const float variance = 1.0f / (state->nuisance_root * state->nuisance_root);
    for (int i = 0; i < state->rows; i++) {
        const float *t = state->noise[i];
        const float scaled[PEER_NUISANCES] = {variance * t[0], variance * t[1], variance * t[2]};
        float *row = state->row[i];
        float pivot = 1.0f + scaled[0] * t[0] + scaled[1] * t[1] + scaled[2] * t[2];
        for (int k = 0; k < i; k++) {
            const float *other = state->noise[k];
            float sum = scaled[0] * other[0] + scaled[1] * other[1] + scaled[2] * other[2];
            for (int j = 0; j < k; j++) {
                sum -= l[i][j] * l[k][j];
            }
            const float factor = sum * reciprocal[k];
            l[i][k] = factor;
            pivot -= factor * factor;
            for (int c = 0; c < OWN; c++) {
                row[c] -= factor * state->row[k][c];
            }
        }
        reciprocal[i] = 1.0f / sqrtf(pivot);
        for (int c = 0; c < OWN; c++) {
            row[c] *= reciprocal[i];
        }
    }
}

/* One row of unit variance. */
static void take_row(state_t *state, const float row[OWN]) {
    float f[PEER_STATES];    /* U' h */
    float v[PEER_STATES];    /* D f */
    float gain[PEER_STATES]; /* unscaled: covariance times h */
    float innovation = row[PEER_STATES];
    float *column = state->factors;
    for (int j = 0; j < PEER_STATES; j++) {
        float sum = row[j];
        for (int i = 0; i < j; i++) {
            sum += column[i] * row[i];
        }
        f[j] = sum;
        v[j] = column[j] * sum;
        innovation -= row[j] * state->change[j];
        column += j + 1;
    }
    float alpha = 1.0f; /* variance of the innovation, from the states so far */
    float reciprocal = 1.0f;
    column = state->factors;
    for (int j = 0; j < PEER_STATES; j++) {
        const float before = alpha;
        const float lambda = f[j] * reciprocal;
        alpha += f[j] * v[j];
        reciprocal = 1.0f / alpha;
        column[j] *= before * reciprocal;
        for (int i = 0; i < j; i++) {
            const float u = column[i];
            column[i] = u - lambda * gain[i];
            gain[i] += u * v[j];
        }
        gain[j] = v[j];
        column += j + 1;
    }
    const float scaled = innovation * reciprocal;
    for (int i = 0; i < PEER_STATES; i++) {
        state->change[i] += gain[i] * scaled;
    }
    state->nis += innovation * scaled;
}

void peer_solve(int slot) {
    state_t *state = &states[slot];
    make_independent(state);
    for (int i = 0; i < state->rows; i++) {
        take_row(state, state->row[i]);
    }
}

void peer_answer(int slot, peer_answer_t *answer) {
    const state_t *state = &states[slot];
    memset(answer, 0, sizeof *answer);
    memcpy(answer->change, state->change, sizeof answer->change);
    answer->nis = state->nis;
    memcpy(answer->held, state->factors, sizeof state->factors);
}
