/* The library: closed form, with all its checks and the sigmas of the answer. SPDX-License-Identifier: MIT */
#include <string.h>

#include "peer.h"
#include "window/goe_fit.h"

#define MIN_BASELINE_M 0.1f

static goe_fit_ring_t windows[PEER_SLOTS];
static goe_estimate_t fits[PEER_SLOTS];

void peer_prepare(int slot, const peer_case_t *given) {
    goe_fit_ring_t *window = &windows[slot];
    memset(window, 0, sizeof *window);
    memset(&fits[slot], 0, sizeof fits[slot]);
    for (int k = 0; k < PEER_POINTS; k++) {
        const goe_row_t row = {given->xi[k], given->zeta[k]};
        goe_fit_add(window, PEER_POINTS, given->dx_m[k], given->dz_m[k], row);
    }
}

void peer_solve(int slot) { (void)goe_fit_solve(&windows[slot], PEER_POINTS, MIN_BASELINE_M, &fits[slot]); }

void peer_answer(int slot, peer_answer_t *answer) {
    answer->width_m = fits[slot].width_m;
    answer->x0_m = fits[slot].x0_m;
    answer->z0_m = fits[slot].z0_m;
}
