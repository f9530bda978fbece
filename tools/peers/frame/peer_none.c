/* Nothing: what the frame costs. SPDX-License-Identifier: MIT */
#include "peer.h"

void peer_prepare(const peer_window_t *window) { (void)window; }

void peer_solve(const peer_window_t *window, peer_solution_t *solution) {
    solution->width_m = window->dx_m[0];
    solution->x0_m = window->dx_m[1];
    solution->z0_m = window->dx_m[2];
}
