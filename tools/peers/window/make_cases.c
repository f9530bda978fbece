/* Prints windows to solve, one a line, in the order of peer_case_t: an approach with a weave, obstacles of 2 to 40 m at 30
 * to 400 m.
 *
 *   make_cases COUNT
 *
 * SPDX-License-Identifier: MIT */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "job.h"

#define NOISE 2.0e-3f /* of a row, relative: half a pixel in an image of 250 pixels */

static uint32_t state;

/* -1 to 1: a linear congruential generator's upper bits. */
static float random_number(void) {
    state = state * 1664525u + 1013904223u;
    return (float)(int32_t)(state >> 8) * (1.0f / 8388608.0f) - 1.0f;
}

static float between(float low, float high) { return low + (high - low) * 0.5f * (random_number() + 1.0f); }

static void make_window(peer_case_t *window) {
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

static void print(const float numbers[PEER_POINTS]) {
    for (int k = 0; k < PEER_POINTS; k++) {
        printf("%.9g ", (double)numbers[k]);
    }
}

int main(int count, char **arguments) {
    peer_case_t window;
    state = 20190601u;
    for (int i = count == 2 ? atoi(arguments[1]) : 0; i > 0; i--) {
        make_window(&window);
        print(window.dx_m);
        print(window.dz_m);
        print(window.xi);
        print(window.zeta);
        printf("\n");
    }
    return 0;
}
