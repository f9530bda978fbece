/* How much farther the images scatter than their configured noise, and how correlated their residuals are from image to image: the
 * resulting factor on the variances. SPDX-License-Identifier: MIT */
#ifndef GOE_SCATTER_H
#define GOE_SCATTER_H

#include "refined/goe_observation.h"

/* Takes the whitened rows of an image, before the update. */
void goe_scatter_take(goe_scatter_t *scatter, const goe_rows_t *rows);

/* (R32): factor on the variance of the filter's estimates, at least 1. repeated: (1 + c)/(1 - c) of the configured correlation c
 * that counts already. */
float goe_scatter_factor(const goe_filter_t *filter, float repeated);

#endif
