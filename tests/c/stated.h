/* An answer that is written into an estimator, so that every number of it is known. SPDX-License-Identifier: MIT */
#ifndef STATED_H
#define STATED_H

#include "check.h"
#include "goe.h"

/* An upright cylinder ahead; lengths in m. */
typedef struct {
    float x_m, z_m, width_m, height_m;
    float place_sd_m, height_sd_m;
    float camera_m; /* above the ground */
} stated_t;

/* An estimator whose Z is north, and whose plans are exact. */
void stated_start(goe_estimator_t *estimator, goe_method_t method);

/* That, with a fresh answer of the window method after 5 s. */
void stated_answer(goe_estimator_t *estimator, const stated_t *cylinder);

#endif
