/* One window solve, by whoever is linked. SPDX-License-Identifier: MIT */
#ifndef GOE_PEER_H
#define GOE_PEER_H

#ifdef __cplusplus
extern "C" {
#endif

#define PEER_POINTS 8
#define PEER_WINDOWS 64

/* The rows of one window: xi = (X0 - dX)/W, zeta = (Z0 - dZ)/W, with noise. */
typedef struct {
    float dx_m[PEER_POINTS], dz_m[PEER_POINTS], xi[PEER_POINTS], zeta[PEER_POINTS];
} peer_window_t;

/* What is solved for. */
typedef struct {
    float width_m, x0_m, z0_m;
} peer_solution_t;

/* The same windows on every machine: an approach with a weave, obstacles of 2 to 40 m at 30 to 400 m. */
void peer_make_windows(peer_window_t windows[PEER_WINDOWS]);

/* What a solver makes of the window before it is timed; most do nothing. */
void peer_prepare(const peer_window_t *window);

/* Solves the 16 x 3 least squares problem in (1/W, X0/W, Z0/W). */
void peer_solve(const peer_window_t *window, peer_solution_t *solution);

#ifdef __cplusplus
}
#endif

#endif
