/* The library: Householder reflections of the triangle. WITH_INVERSE: 1 and the triangle's inverse, row by row, whose squared
 * norms are the variances. SPDX-License-Identifier: MIT */
#include <string.h>

#include "peer.h"
#include "refined/goe_srif.h"

_Static_assert(GOE_STATES == PEER_STATES && GOE_NUISANCES == PEER_NUISANCES && GOE_ROWS_MAX == PEER_ROWS,
               "job.h describes another filter");

typedef struct {
    goe_triangle_t root;
    float inverse[PEER_TRIANGLE]; /* column by column */
    goe_matrix_t rows;
    size_t count; /* of rows that are not 0 */
    float nuisance_root;
    float change[GOE_STATES];
    float nis;
} state_t;

static state_t states[PEER_SLOTS];

void peer_prepare(int slot, const peer_case_t *given) {
    state_t *state = &states[slot];
    memset(state, 0, sizeof *state);
    memcpy(state->root.element, given->root, sizeof given->root);
    memcpy(state->rows.row, given->measured, sizeof given->measured);
    state->nuisance_root = given->nuisance_root;
    for (size_t i = 0; i < GOE_ROWS_MAX; i++) {
        for (size_t c = 0; c < GOE_COLUMNS; c++) {
            state->count = state->rows.row[i][c] != 0.0f ? i + 1 : state->count;
        }
    }
}

void peer_solve(int slot) {
    state_t *state = &states[slot];
    state->nis = goe_srif_update(&state->root, state->nuisance_root, &state->rows, state->count, state->change);
#if WITH_INVERSE
    float reciprocal[GOE_STATES];
    goe_srif_reciprocals(&state->root, reciprocal);
    for (size_t i = 0; i < GOE_STATES; i++) {
        float part[GOE_STATES] = {0.0f};
        part[i] = 1.0f;
        (void)goe_srif_project(&state->root, reciprocal, 0, part);
        for (size_t j = i; j < GOE_STATES; j++) {
            state->inverse[j * (j + 1) / 2 + i] = part[j];
        }
    }
#endif
}

void peer_answer(int slot, peer_answer_t *answer) {
    const state_t *state = &states[slot];
    memset(answer, 0, sizeof *answer);
    memcpy(answer->change, state->change, sizeof answer->change);
    answer->nis = state->nis;
#if WITH_INVERSE
    memcpy(answer->held, state->inverse, sizeof state->inverse);
#else
    memcpy(answer->held, state->root.element, sizeof state->root.element);
#endif
}
