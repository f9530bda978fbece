/* The inverse of a root. SPDX-License-Identifier: MIT */
#include "inverse.h"

#include <string.h>

/* Of an upper triangular matrix, row by row from below. */
static void invert(size_t count, inverse_t of, inverse_t to) {
    memset(to, 0, sizeof(inverse_t));
    for (size_t j = 0; j < count; j++) {
        to[j][j] = 1.0 / of[j][j];
        for (size_t i = j; i-- > 0;) {
            double sum = 0.0;
            for (size_t k = i + 1; k <= j; k++) {
                sum += of[i][k] * to[k][j];
            }
            to[i][j] = -sum / of[i][i];
        }
    }
}

void inverse_of(const goe_triangle_t *root, inverse_t v) {
    inverse_t r;
    const size_t count = goe_srif_count(root);
    memset(r, 0, sizeof r);
    for (size_t i = 0; i < count; i++) {
        for (size_t j = i; j < count; j++) {
            r[i][j] = (double)root->element[goe_srif_row(i) + j];
        }
    }
    invert(count, r, v);
}

void inverse_put(goe_triangle_t *root, inverse_t v) {
    inverse_t r;
    const size_t count = goe_srif_count(root);
    invert(count, v, r);
    for (size_t i = 0; i < count; i++) {
        for (size_t j = i; j < count; j++) {
            *goe_srif_at(root, i, j) = (float)r[i][j];
        }
    }
}

void inverse_set(goe_triangle_t *root, size_t i, size_t j, double element) {
    inverse_t v;
    inverse_of(root, v);
    v[i][j] = element;
    inverse_put(root, v);
}

void inverse_start(goe_triangle_t *root, double sigma) {
    memset(root, 0, sizeof *root);
    for (size_t i = 0; i < GOE_STATES; i++) {
        *goe_srif_at(root, i, i) = (float)(1.0 / sigma);
    }
}

void inverse_covariance(const goe_triangle_t *root, double covariance[GOE_STATES][GOE_STATES]) {
    inverse_t v;
    inverse_of(root, v);
    for (size_t i = 0; i < GOE_STATES; i++) {
        for (size_t k = 0; k < GOE_STATES; k++) {
            covariance[i][k] = 0.0;
            for (size_t j = i > k ? i : k; j < GOE_STATES; j++) {
                covariance[i][k] += v[i][j] * v[k][j];
            }
        }
    }
}
