/* Least squares over the window, (5), in closed form. SPDX-License-Identifier: MIT */
#ifndef GOE_FIT_H
#define GOE_FIT_H

#include "window/goe_projection.h"

GOE_STATIC_ASSERT(GOE_WINDOW_MAX <= INT16_MAX, a_place_in_the_ring_fits_its_type);

/* Adds a row, which replaces the oldest of `length` rows. */
/*@ requires \valid(ring) && 1 <= length <= GOE_WINDOW_MAX; */
static inline void goe_fit_add(goe_fit_ring_t *ring, int length, float dx_m, float dz_m, goe_row_t row) {
    const int at = ring->next >= 0 && ring->next < length ? ring->next : 0;
    goe_fit_point_t *point = &ring->point[at];
    point->dx_m = dx_m;
    point->dz_m = dz_m;
    point->xi = row.xi;
    point->zeta = row.zeta;
    ring->next = (int16_t)(at + 1 < length ? at + 1 : 0);
    ring->count = (int16_t)(ring->count < INT16_MAX ? ring->count + 1 : INT16_MAX);
}

/* Solves (5) over the newest `length` rows, which must exist. Returns GOE_OK and sets x0, z0, width, residual, baseline and their sigmas;
 * or leaves *fit unchanged and returns GOE_NO_BASELINE, GOE_NO_PARALLAX or GOE_ABEAM. */
/*@ requires \valid_read(ring) && \valid(fit) && 3 <= length <= GOE_WINDOW_MAX; */
goe_status_t goe_fit_solve(const goe_fit_ring_t *ring, int length, float min_baseline_m, goe_estimate_t *fit);

#endif
