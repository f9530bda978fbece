/* One window: eight images of an obstacle, with unknown place and width. SPDX-License-Identifier: MIT */
#ifndef GOE_PEER_JOB_H
#define GOE_PEER_JOB_H

#define PEER_POINTS 8
#define PEER_REPEATS 100 /* of a prepared case while timed: solving does not change it */

/* The rows: xi = (X0 - dX)/W, zeta = (Z0 - dZ)/W, with noise. */
typedef struct {
    float dx_m[PEER_POINTS], dz_m[PEER_POINTS], xi[PEER_POINTS], zeta[PEER_POINTS];
} peer_case_t;

/* Solution of the 16 x 3 least squares problem in (1/W, X0/W, Z0/W). */
typedef struct {
    float width_m, x0_m, z0_m;
} peer_answer_t;

#endif
