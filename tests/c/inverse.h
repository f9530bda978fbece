/* The inverse of a root, which the library never works out, in double. SPDX-License-Identifier: MIT
 *
 * Element [i][j] is the part of unknown i in independent unit error j; 0 below the diagonal. V V' is the covariance. */
#ifndef INVERSE_H
#define INVERSE_H

#include "refined/goe_srif.h"

typedef double inverse_t[GOE_UNKNOWNS][GOE_UNKNOWNS];

/* V = R^-1, of the states and the estimated augmented states; the rest is 0. */
void inverse_of(const goe_triangle_t *root, inverse_t v);

/* R = V^-1 of those; the rest of R stays. */
void inverse_put(goe_triangle_t *root, inverse_t v);

/* Element [i][j], i <= j, of the inverse becomes that; the others stay. */
void inverse_set(goe_triangle_t *root, size_t i, size_t j, double element);

/* All states become independent, with this sigma; the augmented states are taken as known. */
void inverse_start(goe_triangle_t *root, double sigma);

/* V V' of the states, as if the augmented states were known. */
void inverse_covariance(const goe_triangle_t *root, double covariance[GOE_STATES][GOE_STATES]);

#endif
