/* The library's own: closed form, with all its checks and the sigmas of the answer. SPDX-License-Identifier: MIT */
#include <string.h>

#include "goe_window.h"
#include "peer.h"

static goe_window_t rows;

void peer_prepare(const peer_window_t *window) {
    memset(&rows, 0, sizeof rows);
    for (int k = 0; k < PEER_POINTS; k++) {
        const goe_row_t row = {window->xi[k], window->zeta[k]};
        goe_window_add(&rows, PEER_POINTS, window->dx_m[k], window->dz_m[k], row);
    }
}

void peer_solve(const peer_window_t *window, peer_solution_t *solution) {
    goe_estimate_t fit;
    (void)window;
    if (goe_window_solve(&rows, PEER_POINTS, 0.1f, &fit) == GOE_OK) {
        solution->width_m = fit.width_m;
        solution->x0_m = fit.x0_m;
        solution->z0_m = fit.z0_m;
    }
}
