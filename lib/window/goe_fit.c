/* Least squares over the window, (5), in closed form. SPDX-License-Identifier: MIT
 *
 * Rotated back into T, the 2N x 3 system (5) is the fit of two parallel straight lines
 *   xi_k = X0/W - dX_k/W,   zeta_k = Z0/W - dZ_k/W
 * with one common slope 1/W. This is exact, and far better conditioned than any factorization of the dense system. */
#include "window/goe_fit.h"

#include <math.h>

#include "maths/goe_scalar.h"

#if GOE_WITH_WINDOW

#define PARALLAX_MIN 1.0e-6f /* change of the rows over the window, relative to their size: less is float rounding */
#define METERS_MAX 1.0e6f    /* no obstacle is farther away or wider */
#define SIGMA_MAX_M 1.0e9f   /* keeps squares and products of sigmas finite */

typedef struct {
    float dx_m, dz_m, xi, zeta; /* means over the window */
    float spread_m2;            /* sum of squared deviations of dX and dZ */
    float mixed_m;              /* sum of products of the deviations of (dX, dZ) and (xi, zeta) */
    float largest_dz_m;
} moments_t;

/*@ requires \valid_read(points + (0 .. length - 1)) && \valid(m) && 1 <= length <= GOE_WINDOW_MAX; */
static void sum_means(const goe_fit_point_t *points, int length, moments_t *m) {
    float dx_m = 0.0f;
    float dz_m = 0.0f;
    float xi = 0.0f;
    float zeta = 0.0f;
    float largest_dz_m = points->dz_m;
    for (int k = 0; k < length; k++) {
        const goe_fit_point_t *p = &points[k];
        dx_m += p->dx_m;
        dz_m += p->dz_m;
        xi += p->xi;
        zeta += p->zeta;
        largest_dz_m = goe_larger(largest_dz_m, p->dz_m);
    }
    const float share = 1.0f / (float)length;
    m->dx_m = dx_m * share;
    m->dz_m = dz_m * share;
    m->xi = xi * share;
    m->zeta = zeta * share;
    m->largest_dz_m = largest_dz_m;
}

/*@ requires \valid_read(points + (0 .. length - 1)) && \valid(m) && 1 <= length <= GOE_WINDOW_MAX; */
static void sum_products(const goe_fit_point_t *points, int length, moments_t *m) {
    const goe_fit_point_t *end = points + length;
    const moments_t mean = *m; /* a copy, which the compiler may keep in registers */
    float spread_m2 = 0.0f;
    float mixed_m = 0.0f;
    for (const goe_fit_point_t *p = points; p != end; p++) {
        const float x = p->dx_m - mean.dx_m;
        const float z = p->dz_m - mean.dz_m;
        spread_m2 += x * x + z * z;
        mixed_m += x * (p->xi - mean.xi) + z * (p->zeta - mean.zeta);
    }
    m->spread_m2 = spread_m2;
    m->mixed_m = mixed_m;
}

/*@ requires \valid_read(points + (0 .. length - 1)) && \valid_read(m) && 1 <= length <= GOE_WINDOW_MAX; */
static float squared_residuals(const goe_fit_point_t *points, int length, const moments_t *m, float inverse_width) {
    const goe_fit_point_t *end = points + length;
    float sum = 0.0f;
    for (const goe_fit_point_t *p = points; p != end; p++) {
        const float x = (p->xi - m->xi) + inverse_width * (p->dx_m - m->dx_m);
        const float z = (p->zeta - m->zeta) + inverse_width * (p->dz_m - m->dz_m);
        sum += x * x + z * z;
    }
    return sum;
}

static float bounded(float sigma_m) { return sigma_m < SIGMA_MAX_M ? sigma_m : SIGMA_MAX_M; }

/* Uses the covariance of the fit: 1/W has s2/D, the window means have s2/N, and they are independent. */
/*@ requires \valid_read(m) && \valid(fit) && 2 <= length <= GOE_WINDOW_MAX; */
static void set_sigmas(const moments_t *m, int length, float squares, goe_estimate_t *fit) {
    const float s2 = squares / (float)(2 * length - 3);
    const float mean = s2 / (float)length;
    const float slope = fit->width_m * fit->width_m * (s2 / m->spread_m2);
    fit->residual = sqrtf(squares / (float)(2 * length));
    fit->sigma.width_m = bounded(fit->width_m * sqrtf(slope));
    fit->sigma.x0_m = bounded(fit->width_m * sqrtf(mean + m->xi * m->xi * slope));
    fit->sigma.z0_m = bounded(fit->width_m * sqrtf(mean + m->zeta * m->zeta * slope));
    fit->sigma.x_m = fit->sigma.x0_m;
    fit->sigma.z_m = fit->sigma.z0_m;
}

goe_status_t goe_fit_solve(const goe_fit_ring_t *ring, int length, float min_baseline_m, goe_estimate_t *fit) {
    moments_t m;
    sum_means(ring->point, length, &m);
    sum_products(ring->point, length, &m);
    const float baseline_m = sqrtf(m.spread_m2);
    if (baseline_m < min_baseline_m) {
        return GOE_NO_BASELINE;
    }
    const float inverse_width = -m.mixed_m / m.spread_m2;
    if (inverse_width * baseline_m <= PARALLAX_MIN * (1.0f + goe_absolute(m.xi) + goe_absolute(m.zeta))) {
        return GOE_NO_PARALLAX;
    }
    const float width_m = 1.0f / inverse_width;
    const float x0_m = width_m * m.xi + m.dx_m;
    const float z0_m = width_m * m.zeta + m.dz_m;
    if (!goe_within(width_m, METERS_MAX) || !goe_within(x0_m, METERS_MAX) || !goe_within(z0_m, METERS_MAX)) {
        return GOE_NO_PARALLAX;
    }
    if (z0_m <= m.largest_dz_m) {
        return GOE_ABEAM;
    }
    fit->x0_m = x0_m;
    fit->z0_m = z0_m;
    fit->width_m = width_m;
    fit->baseline_m = baseline_m;
    set_sigmas(&m, length, squared_residuals(ring->point, length, &m, inverse_width), fit);
    return GOE_OK;
}

#endif
