/* The factor on the variances if the residuals scatter more than their configured noise, or are correlated from image to image.
 * SPDX-License-Identifier: MIT */
#ifndef GOE_SCATTER_H
#define GOE_SCATTER_H

#include "refined/goe_observation.h"

/* Adds the whitened rows of an image to the sums. Call before the update. */
void goe_scatter_take(goe_scatter_t *scatter, const goe_rows_t *rows);

/* (R32): factor on the variance of the filter's estimates, at least 1. repeated: (1 + c)/(1 - c) of the configured correlation c, which the
 * variances already contain. */
float goe_scatter_factor(const goe_filter_t *filter, float repeated);

#endif
