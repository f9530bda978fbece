/* The normal distribution function, without a C library. SPDX-License-Identifier: MIT */
#ifndef GOE_NORMAL_H
#define GOE_NORMAL_H

/* Probability that a normal variable of mean 0 and sigma 1 is below x, 0 to 1, for any finite x. Absolute error at most 1e-6; 0 below -5.2
 * and 1 above 5.2 sigma. */
float goe_normal_below(float x);

#endif
