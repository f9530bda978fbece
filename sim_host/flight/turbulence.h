/*
 * Turbulence after MIL-F-8785C, Dryden form, low altitude (below 1000 ft): gusts along the body axes and the rotation of the
 * air about them.
 *
 * Intensity and scale follow the height h over ground (feet inside the formulas, 10 to 1000):
 *   sigma_w = 0.1 W20, sigma_u = sigma_v = sigma_w / (0.177 + 0.000823 h)^0.4, L_w = h, L_u = L_v = h / (0.177 + 0.000823 h)^1.2
 * with W20 the wind at 20 ft: 15 kt light, 30 kt moderate. One-sided spectra over the angular frequency omega:
 *   Phi_u = sigma_u^2 2 L_u/(pi V) / (1 + (L_u omega/V)^2)
 *   Phi_v = sigma_v^2 L_v/(pi V) (1 + 3 (L_v omega/V)^2) / (1 + (L_v omega/V)^2)^2, w likewise
 *   Phi_p = sigma_w^2/(V L_w) 0.8 (pi L_w/(4 b))^(1/3) / (1 + (4 b omega/(pi V))^2)
 *   Phi_q = (omega/V)^2 / (1 + (4 b omega/(pi V))^2) Phi_w,   Phi_r = (omega/V)^2 / (1 + (3 b omega/(pi V))^2) Phi_v
 * u, v, w and p are discretised exactly and start from their stationary distribution: there is no transient. q and r are
 * derivatives of w and v (trapezoidal rule); they start at 0 and settle within a few tenths of a second.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#ifndef SIM_TURBULENCE_H
#define SIM_TURBULENCE_H

#include <stdbool.h>
#include <stdint.h>

#include "random.h"
#include "rotation.h"

typedef struct {
    double w20_mps; /* 0 = still air */
    double span_m;  /* of the aircraft: it averages out smaller scales */
    random_t random;
    double u;                 /* unit variance */
    double v_first, v_second; /* the two stages of the second-order filters, unit noise */
    double w_first, w_second;
    double p;                              /* unit variance */
    double q_slow, r_slow, q_gust, r_gust; /* low-passed gusts and the last ones, m/s */
    bool started;
} turbulence_t;

typedef struct {
    vec3_t velocity_mps; /* of the air, along body forward, right, down */
    vec3_t rate_rps;     /* of the air, about them */
} gust_t;

typedef struct {
    double sigma_uv_mps, sigma_w_mps, scale_uv_m, scale_w_m;
} turbulence_scale_t;

/* Wind at 20 ft of "none", "dryden:light" or "dryden:moderate"; false for anything else. */
bool turbulence_parse(const char *text, double *w20_mps);

turbulence_scale_t turbulence_scale(double w20_mps, double height_m);

turbulence_t turbulence_start(double w20_mps, double span_m, uint64_t seed);

/* The gusts after another step of time, for an aircraft of this airspeed at this height. */
gust_t turbulence_step(turbulence_t *turbulence, double airspeed_mps, double height_m, double step_s);

#endif
