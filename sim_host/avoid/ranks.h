/*
 * Quantiles of a list of numbers.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#ifndef SIM_RANKS_H
#define SIM_RANKS_H

/* The least first. */
void ranks_sort(double *numbers, int count);

/* The number at the rank nearest to this share of the way from the least to the most. NaN: there is no number. */
double ranks_quantile(const double *sorted, int count, double share);

#endif
