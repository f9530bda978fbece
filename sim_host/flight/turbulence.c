/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "turbulence.h"

#include <math.h>
#include <string.h>

#define METERS_PER_FOOT 0.3048
#define MPS_PER_KNOT (1852.0 / 3600.0)
#define LOWEST_FT 10.0
#define HIGHEST_FT 1000.0
#define SQRT3 1.7320508075688772

bool turbulence_parse(const char *text, double *w20_mps) {
    if (strcmp(text, "none") == 0) {
        *w20_mps = 0.0;
    } else if (strcmp(text, "dryden:light") == 0) {
        *w20_mps = 15.0 * MPS_PER_KNOT;
    } else if (strcmp(text, "dryden:moderate") == 0) {
        *w20_mps = 30.0 * MPS_PER_KNOT;
    } else {
        return false;
    }
    return true;
}

turbulence_scale_t turbulence_scale(double w20_mps, double height_m) {
    const double h = clamp(height_m / METERS_PER_FOOT, LOWEST_FT, HIGHEST_FT);
    const double shape = 0.177 + 0.000823 * h;
    turbulence_scale_t scale;
    scale.sigma_w_mps = 0.1 * w20_mps;
    scale.sigma_uv_mps = scale.sigma_w_mps / pow(shape, 0.4);
    scale.scale_w_m = h * METERS_PER_FOOT;
    scale.scale_uv_m = scale.scale_w_m / pow(shape, 1.2);
    return scale;
}

turbulence_t turbulence_start(double w20_mps, double span_m, uint64_t seed) {
    turbulence_t t;
    memset(&t, 0, sizeof t);
    t.w20_mps = w20_mps;
    t.span_m = span_m;
    t.random = random_start(seed, STREAM_TURBULENCE);
    /* Stationary covariance of the two stages: [1/2 1/4; 1/4 1/4] = F F' with F = [sqrt(1/2) 0; sqrt(1/8) sqrt(1/8)]. */
    double n1, n2;
    t.u = random_normal(&t.random);
    n1 = random_normal(&t.random);
    n2 = random_normal(&t.random);
    t.v_first = sqrt(0.5) * n1;
    t.v_second = sqrt(0.125) * (n1 + n2);
    n1 = random_normal(&t.random);
    n2 = random_normal(&t.random);
    t.w_first = sqrt(0.5) * n1;
    t.w_second = sqrt(0.125) * (n1 + n2);
    t.p = random_normal(&t.random);
    return t;
}

static double step_first_order(double value, double ratio, random_t *random) {
    const double keep = exp(-ratio);
    return keep * value + sqrt(1.0 - keep * keep) * random_normal(random);
}

/* Two equal lags in a row, driven by white noise: x1' = (n - x1)/tau, x2' = (x1 - x2)/tau, over ratio = step/tau. The
 * covariance of what the noise adds to both within the step is integrated exactly. */
static void step_second_order(double *first, double *second, double ratio, random_t *random) {
    const double keep = exp(-ratio), keep2 = keep * keep;
    const double q11 = 0.5 * (1.0 - keep2);
    const double q12 = 0.25 * (1.0 - (1.0 + 2.0 * ratio) * keep2);
    const double q22 = 0.25 * (1.0 - (1.0 + 2.0 * ratio * (1.0 + ratio)) * keep2);
    const double n1 = random_normal(random), n2 = random_normal(random);
    const double f11 = sqrt(q11), f21 = q12 / f11;
    const double f22 = sqrt(fmax(q22 - f21 * f21, 0.0));
    *second = keep * (*second + ratio * *first) + f21 * n1 + f22 * n2;
    *first = keep * *first + f11 * n1;
}

/* (1 + sqrt(3) tau s)/(1 + tau s)^2 from the two stages: x2 + sqrt(3) (x1 - x2), of unit variance */
static double second_order_output(double first, double second) { return SQRT3 * first + (1.0 - SQRT3) * second; }

/* s/(1 + tau s) of a gust: the gust less its low-passed value, over tau */
static double washed_out(double gust, double *last, double *slow, double tau, double step_s) {
    *slow = ((2.0 * tau - step_s) * *slow + step_s * (gust + *last)) / (2.0 * tau + step_s);
    *last = gust;
    return (gust - *slow) / tau;
}

gust_t turbulence_step(turbulence_t *t, double airspeed_mps, double height_m, double step_s) {
    gust_t gust;
    memset(&gust, 0, sizeof gust);
    if (!(t->w20_mps > 0.0)) {
        return gust;
    }
    const turbulence_scale_t scale = turbulence_scale(t->w20_mps, height_m);
    const double way = airspeed_mps * step_s;
    const double tau_pq = 4.0 * t->span_m / (SIM_PI * airspeed_mps), tau_r = 0.75 * tau_pq;
    t->u = step_first_order(t->u, way / scale.scale_uv_m, &t->random);
    step_second_order(&t->v_first, &t->v_second, way / scale.scale_uv_m, &t->random);
    step_second_order(&t->w_first, &t->w_second, way / scale.scale_w_m, &t->random);
    t->p = step_first_order(t->p, step_s / tau_pq, &t->random);

    gust.velocity_mps.x = scale.sigma_uv_mps * t->u;
    gust.velocity_mps.y = scale.sigma_uv_mps * second_order_output(t->v_first, t->v_second);
    gust.velocity_mps.z = scale.sigma_w_mps * second_order_output(t->w_first, t->w_second);
    /* variance of p: the integral of Phi_p over all frequencies */
    const double p_density =
        0.8 * cbrt(SIM_PI * scale.scale_w_m / (4.0 * t->span_m)) / (airspeed_mps * scale.scale_w_m);
    gust.rate_rps.x = scale.sigma_w_mps * sqrt(p_density * 0.5 * SIM_PI / tau_pq) * t->p;
    if (!t->started) {
        t->started = true;
        t->q_slow = t->q_gust = gust.velocity_mps.z;
        t->r_slow = t->r_gust = gust.velocity_mps.y;
    }
    gust.rate_rps.y = washed_out(gust.velocity_mps.z, &t->q_gust, &t->q_slow, tau_pq, step_s) / airspeed_mps;
    gust.rate_rps.z = -washed_out(gust.velocity_mps.y, &t->r_gust, &t->r_slow, tau_r, step_s) / airspeed_mps;
    return gust;
}
