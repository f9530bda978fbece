/* Windows to solve. SPDX-License-Identifier: MIT */
#include "peer.h"

#include <stdint.h>

#define NOISE 2.0e-3f /* of a row, of its size: half a pixel in an image of 250 pixels */

static uint32_t state;

/* -1 to 1: a linear congruential generator's upper bits. */
static float random_number(void) {
    state = state * 1664525u + 1013904223u;
    return (float)(int32_t)(state >> 8) * (1.0f / 8388608.0f) - 1.0f;
}

static float between(float low, float high) { return low + (high - low) * 0.5f * (random_number() + 1.0f); }

static void make_window(peer_window_t *window) {
    const float width_m = between(2.0f, 40.0f);
    const float x0_m = between(-60.0f, 60.0f);
    const float z0_m = between(60.0f, 400.0f);
    const float step_m = between(1.0f, 5.0f);
    for (int k = 0; k < PEER_POINTS; k++) {
        const float dx_m = between(-1.0f, 1.0f);
        const float dz_m = step_m * (float)k;
        window->dx_m[k] = dx_m;
        window->dz_m[k] = dz_m;
        window->xi[k] = (x0_m - dx_m) / width_m * (1.0f + NOISE * random_number());
        window->zeta[k] = (z0_m - dz_m) / width_m * (1.0f + NOISE * random_number());
    }
}

void peer_make_windows(peer_window_t windows[PEER_WINDOWS]) {
    state = 20190601u;
    for (int i = 0; i < PEER_WINDOWS; i++) {
        make_window(&windows[i]);
    }
}
