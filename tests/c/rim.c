/* The rim of a footprint. SPDX-License-Identifier: MIT */
#include "rim.h"

#include <math.h>

#define POINTS 20000
#define TURN 6.283185307179586

double rim_reach(const float state[GOE_STATES], double nx, double nz) {
    const double half = (double)state[GOE_HALF];
    const double shear = (double)state[GOE_SHEAR];
    const double depth = half * exp((double)state[GOE_LOG_DEPTH]);
    double reach = 0.0;
    for (int i = 0; i < POINTS; i++) {
        const double right = sin(i * (TURN / POINTS));
        const double ahead = cos(i * (TURN / POINTS));
        reach = fmax(reach, nx * half * right + nz * (shear * right + depth * ahead));
    }
    return reach;
}
