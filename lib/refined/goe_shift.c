/* The image's own position error, in rows. SPDX-License-Identifier: MIT */
#include "refined/goe_shift.h"

#include <math.h>

#include "maths/goe_scalar.h"

#if GOE_WITH_FILTER

#define SHIFT_RATIO_MAX 300.0f /* of a shift that rows share, over a row's own noise */

void goe_shift_note(goe_rows_t *rows, const goe_gradient_t *gradient, float shift) {
    float *common = rows->shift[rows->count - 1u];
    common[0] = shift * gradient->x;
    common[1] = shift * gradient->y;
    common[2] = shift * gradient->z;
}

/*@ requires goe_rows_hold(rows) && row < rows->count && middle < rows->count; */
float goe_shift_variance(const goe_rows_t *rows, size_t row, size_t middle, float other) {
    float sum = 0.0f;
    for (size_t c = 0; c < 3; c++) {
        const float own = row < rows->remembered ? rows->shift[row][c] : 0.0f;
        const float common = middle < rows->remembered ? rows->shift[middle][c] : 0.0f;
        sum += goe_square(own - other * common);
    }
    return sum;
}

/*@ requires goe_rows_hold(rows) && a < GOE_BOX_SIDES && b < GOE_BOX_SIDES; */
float goe_shift_shared(const goe_rows_t *rows, size_t a, size_t b) {
    const float *v = rows->shift[a];
    const float *w = rows->shift[b];
    return rows->shifts ? v[0] * w[0] + v[1] * w[1] + v[2] * w[2] : 0.0f;
}

/* What a row counts: I + N has lost the 1, a row's own noise, among float's 24 bits where the shift is thousands of times that noise,
 * and rows would come out far too certain, or infinite. Such a row counts as if its noise were larger. */
/*@ requires goe_rows_hold(rows) && i < GOE_BOX_SIDES; */
static float share_of(const goe_rows_t *rows, size_t i) {
    const float shift = goe_square(rows->weight[i]) * goe_shift_shared(rows, i, i);
    return shift > SHIFT_RATIO_MAX * SHIFT_RATIO_MAX ? SHIFT_RATIO_MAX / sqrtf(shift) : 1.0f;
}

/* Rows of unit noise that share a shift: their covariance is I + N; times the inverse of its Cholesky root they share none. */
/*@ requires goe_rows_hold(rows) && rows->remembered <= GOE_BOX_SIDES; */
void goe_shift_whiten(goe_rows_t *rows) {
    float root[GOE_BOX_SIDES][GOE_BOX_SIDES];
    if (!rows->shifts) {
        return;
    }
    for (size_t i = 0; i < rows->remembered; i++) {
        float *row = rows->matrix->row[i];
        const float share = share_of(rows, i);
        rows->weight[i] *= share;
        for (size_t j = 0; j <= i; j++) {
            float sum = (i == j ? 1.0f : 0.0f) + rows->weight[i] * rows->weight[j] * goe_shift_shared(rows, i, j);
            for (size_t k = 0; k < j; k++) {
                sum -= root[i][k] * root[j][k];
            }
            root[i][j] = i == j ? sqrtf(sum) : sum / root[j][j];
        }
        for (size_t c = 0; c < GOE_COLUMNS; c++) {
            row[c] *= share;
            for (size_t j = 0; j < i; j++) {
                row[c] -= root[i][j] * rows->matrix->row[j][c];
            }
            row[c] = row[c] / root[i][i];
        }
    }
}

#endif
