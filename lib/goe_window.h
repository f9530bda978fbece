/* Window least squares (5) in closed form. SPDX-License-Identifier: MIT */
#ifndef GOE_WINDOW_H
#define GOE_WINDOW_H

#include "goe_projection.h"

typedef struct {
    float x0_m, z0_m, width_m;
    float sigma_x0_m, sigma_z0_m, sigma_width_m;
    float residual;   /* rms of the rows */
    float baseline_m; /* root of the summed squared spread of dX, dZ */
} goe_fit_t;

/* Adds a row; the oldest of `length` rows leaves. */
void goe_window_add(goe_window_t *window, int length, float dx_m, float dz_m, goe_row_t row);

/* Solves (5) over the newest `length` rows, which must be there. GOE_OK, or with *fit untouched GOE_NO_BASELINE,
 * GOE_NO_PARALLAX or GOE_PASSED. */
goe_status_t goe_window_solve(const goe_window_t *window, int length, float min_baseline_m, goe_fit_t *fit);

#endif
