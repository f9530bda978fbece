/* LAPACK's sgels: Householder QR. SPDX-License-Identifier: MIT */
#include <lapacke.h>
#include <string.h>

#include "dense.h"

static float given_a[PEER_SLOTS][DENSE_ROWS * DENSE_COLUMNS];
static float given_b[PEER_SLOTS][DENSE_ROWS];
static peer_answer_t answers[PEER_SLOTS];

void peer_prepare(int slot, const peer_case_t *given) {
    float rows[DENSE_ROWS * DENSE_COLUMNS];
    dense_system(given, rows, given_b[slot]);
    for (int i = 0; i < DENSE_ROWS; i++) { /* by column, as in LAPACK */
        for (int j = 0; j < DENSE_COLUMNS; j++) {
            given_a[slot][j * DENSE_ROWS + i] = rows[i * DENSE_COLUMNS + j];
        }
    }
}

void peer_solve(int slot) {
    float a[DENSE_ROWS * DENSE_COLUMNS];
    float b[DENSE_ROWS];
    float work[64];
    memcpy(a, given_a[slot], sizeof a);
    memcpy(b, given_b[slot], sizeof b);
    (void)LAPACKE_sgels_work(LAPACK_COL_MAJOR, 'N', DENSE_ROWS, DENSE_COLUMNS, 1, a, DENSE_ROWS, b, DENSE_ROWS, work,
                             64);
    dense_solution(b, &answers[slot]);
}

void peer_answer(int slot, peer_answer_t *answer) { *answer = answers[slot]; }
