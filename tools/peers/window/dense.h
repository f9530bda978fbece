/* The dense 16 x 3 system of one window. SPDX-License-Identifier: MIT */
#ifndef GOE_PEER_DENSE_H
#define GOE_PEER_DENSE_H

#include "peer.h"

#define DENSE_ROWS (2 * PEER_POINTS)
#define DENSE_COLUMNS 3

/* a(row, column), by row: 1 0 -dX and 0 1 -dZ; b: xi and zeta. Unknowns X0/W, Z0/W, 1/W. */
static inline void dense_system(const peer_case_t *window, float a[DENSE_ROWS * DENSE_COLUMNS], float b[DENSE_ROWS]) {
    for (int k = 0; k < PEER_POINTS; k++) {
        float *row = &a[2 * k * DENSE_COLUMNS];
        row[0] = 1.0f;
        row[1] = 0.0f;
        row[2] = -window->dx_m[k];
        row[3] = 0.0f;
        row[4] = 1.0f;
        row[5] = -window->dz_m[k];
        b[2 * k] = window->xi[k];
        b[2 * k + 1] = window->zeta[k];
    }
}

static inline void dense_solution(const float p[DENSE_COLUMNS], peer_answer_t *answer) {
    answer->width_m = 1.0f / p[2];
    answer->x0_m = p[0] * answer->width_m;
    answer->z0_m = p[1] * answer->width_m;
}

#endif
