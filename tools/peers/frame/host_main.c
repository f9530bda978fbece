/* Times one solver on the host and holds it against double precision. Prints one line:
 *   ns <nanoseconds per solve> error <largest relative error of W> <root mean square>
 * SPDX-License-Identifier: MIT */
#define _POSIX_C_SOURCE 199309L
#include <math.h>
#include <stdio.h>
#include <time.h>

#include "peer.h"

#define REPETITIONS 4000
#define ROUNDS 9 /* the best counts: everything else on the machine only adds */

static peer_window_t windows[PEER_WINDOWS];

static double seconds(void) {
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1.0e-9 * (double)now.tv_nsec;
}

/* The straight-line fit of two rows with a shared slope, in double. */
static double width_in_double(const peer_window_t *w) {
    double dx = 0.0;
    double dz = 0.0;
    double xi = 0.0;
    double zeta = 0.0;
    double spread = 0.0;
    double mixed = 0.0;
    for (int k = 0; k < PEER_POINTS; k++) {
        dx += (double)w->dx_m[k] / PEER_POINTS;
        dz += (double)w->dz_m[k] / PEER_POINTS;
        xi += (double)w->xi[k] / PEER_POINTS;
        zeta += (double)w->zeta[k] / PEER_POINTS;
    }
    for (int k = 0; k < PEER_POINTS; k++) {
        const double x = (double)w->dx_m[k] - dx;
        const double z = (double)w->dz_m[k] - dz;
        spread += x * x + z * z;
        mixed += x * ((double)w->xi[k] - xi) + z * ((double)w->zeta[k] - zeta);
    }
    return -spread / mixed;
}

static double nanoseconds(const peer_window_t *window) {
    peer_solution_t solution = {0.0f, 0.0f, 0.0f};
    double best = 1.0e9;
    peer_prepare(window);
    for (int round = 0; round < ROUNDS; round++) {
        const double start = seconds();
        for (int i = 0; i < REPETITIONS; i++) {
            peer_solve(window, &solution);
            __asm__ volatile("" : : "r"(&solution) : "memory");
        }
        const double each = (seconds() - start) * 1.0e9 / REPETITIONS;
        best = each < best ? each : best;
    }
    return best;
}

int main(void) {
    double worst = 0.0;
    double squares = 0.0;
    double time = 0.0;
    peer_make_windows(windows);
    for (int i = 0; i < PEER_WINDOWS; i++) {
        peer_solution_t solution = {0.0f, 0.0f, 0.0f};
        const double truth = width_in_double(&windows[i]);
        peer_prepare(&windows[i]);
        peer_solve(&windows[i], &solution);
        const double error = fabs((double)solution.width_m / truth - 1.0);
        worst = error > worst ? error : worst;
        squares += error * error;
    }
    for (int i = 0; i < PEER_WINDOWS; i += 8) {
        time += nanoseconds(&windows[i]) / (PEER_WINDOWS / 8);
    }
    printf("ns %.1f error %.2e %.2e\n", time, worst, sqrt(squares / PEER_WINDOWS));
    return 0;
}
