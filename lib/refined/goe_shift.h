/* The position error of the image itself: the sides of a box share it. SPDX-License-Identifier: MIT
 *
 * A camera that is off moves all sides of an image together. The first rows, as many as goe_rows_t.remembered, hold what a unit error
 * along each axis does to them. */
#ifndef GOE_SHIFT_H
#define GOE_SHIFT_H

#include "refined/goe_observation.h"

/* Of the last row, whose coordinate has that gradient. shift: one sigma of the error, units of Z0. */
void goe_shift_note(goe_rows_t *rows, const goe_gradient_t *gradient, float shift);

/* Variance in a row, or in the difference of two (other 1). */
float goe_shift_variance(const goe_rows_t *rows, size_t row, size_t middle, float other);

/* Covariance of two rows; 0 if the image has no such error. */
float goe_shift_shared(const goe_rows_t *rows, size_t a, size_t b);

/* Frees weighted rows of what they share. */
void goe_shift_whiten(goe_rows_t *rows);

#endif
