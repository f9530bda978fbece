/* The square-root information filter: reflections, process noise, variances. SPDX-License-Identifier: MIT
 *
 * The sign of R's diagonal elements is free; nothing depends on it. */
#include "refined/goe_srif.h"

#include <math.h>
#include <string.h>

#if GOE_WITH_FILTER

#define PIVOT_MIN 1.0e-12f /* least pivot, over the diagonal: no covariance counts as nearer to singular */

/* The rows of the state come first. */
void goe_srif_clear(goe_triangle_t *root) {
    memset(root->element, 0, goe_srif_augmented_row() * sizeof root->element[0]);
}

/* -------------------------------------------------------------------------------------------------------- reflections -- */

/* Element k of a column is in row k. Each kernel holds one column in registers, of few rows or of the largest number of rows: `few` is a
 * constant in each. Rows of zeros, which the longer kernel reads as well, change no bit. */
#define STEP GOE_COLUMNS
GOE_STATIC_ASSERT(GOE_ROWS_MAX == 9 && GOE_ROWS_FEW == 5, the_kernels_hold_five_rows_or_nine);

typedef struct {
    float v0, v1, v2, v3, v4, v5, v6, v7, v8;
} column_t;

/*@ requires \valid_read(v + (0 .. (GOE_ROWS_MAX - 1) * STEP)); */
static GOE_INLINE column_t load(const float *v, bool few) {
    column_t c = {v[0], v[STEP], v[2 * STEP], v[3 * STEP], v[4 * STEP], 0.0f, 0.0f, 0.0f, 0.0f};
    if (!few) {
        c.v5 = v[5 * STEP];
        c.v6 = v[6 * STEP];
        c.v7 = v[7 * STEP];
        c.v8 = v[8 * STEP];
    }
    return c;
}

/* first: the sum including the first row. */
static GOE_INLINE float dot(column_t p, column_t c, float first, bool few) {
    float sum = first;
    sum += p.v1 * c.v1;
    sum += p.v2 * c.v2;
    sum += p.v3 * c.v3;
    sum += p.v4 * c.v4;
    if (!few) {
        sum += p.v5 * c.v5;
        sum += p.v6 * c.v6;
        sum += p.v7 * c.v7;
        sum += p.v8 * c.v8;
    }
    return sum;
}

/* at = c + g p */
/*@ requires \valid(at + (0 .. (GOE_ROWS_MAX - 1) * STEP)); */
static GOE_INLINE void store_sum(float *at, column_t c, float g, column_t p, bool few) {
    at[0] = c.v0 + g * p.v0;
    at[STEP] = c.v1 + g * p.v1;
    at[2 * STEP] = c.v2 + g * p.v2;
    at[3 * STEP] = c.v3 + g * p.v3;
    at[4 * STEP] = c.v4 + g * p.v4;
    if (!few) {
        at[5 * STEP] = c.v5 + g * p.v5;
        at[6 * STEP] = c.v6 + g * p.v6;
        at[7 * STEP] = c.v7 + g * p.v7;
        at[8 * STEP] = c.v8 + g * p.v8;
    }
}

/* The reflection that takes (r, column) to (diagonal, 0): I + beta (u, column)(u, column)'. */
typedef struct {
    column_t column;
    float diagonal, u, beta;
} reflection_t;

/* Finds the reflection of a column; false if it is 0 already. r: the element of the triangle above it. */
/*@ requires \valid_read(column + (0 .. (GOE_ROWS_MAX - 1) * STEP)) && \valid(to); */
static GOE_INLINE bool aim(const float *column, float r, reflection_t *to, bool few) {
    to->column = load(column, few);
    const float s = dot(to->column, to->column, to->column.v0 * to->column.v0, few);
    if (!(s > 0.0f)) {
        return false;
    }
    const float norm = sqrtf(r * r + s);
    to->diagonal = r > 0.0f ? -norm : norm;
    to->u = r - to->diagonal;
    to->beta = 1.0f / (to->diagonal * to->u);
    return true;
}

/* Reflects the columns after that of a nuisance. Only the sigma of a nuisance is known beforehand: its row of the triangle is 0 until its
 * column is reached, and is not needed afterwards. */
/*@ requires \valid_read(to) && \valid(column) && \valid(last); */
static GOE_INLINE void pass_nuisance(const reflection_t *to, float *column, const float *last, bool few) {
    for (; column <= last; column++) {
        const column_t other = load(column, few);
        const float g = dot(to->column, other, to->column.v0 * other.v0, few) * to->beta;
        store_sum(column, other, g, to->column, few);
    }
}

/* Reflects the columns after that of an unknown: first those of other unknowns, below the elements of the triangle from `above` to before
 * `end`, then the residual, below *right. */
/*@ requires \valid_read(to) && \valid(column) && \valid(above) && \valid(right); */
static GOE_INLINE void pass_unknown(const reflection_t *to, float *column, float *above, const float *end, float *right,
                                    bool few) {
    for (int part = 0; part < 2; part++) {
        for (; above != end; above++) {
            const column_t other = load(column, few);
            const float g = dot(to->column, other, to->u * *above + to->column.v0 * other.v0, few) * to->beta;
            *above += g * to->u;
            store_sum(column, other, g, to->column, few);
            column++;
        }
        above = right;
        end = right + 1;
    }
}

/* Eliminates the columns from first to last - 1 by reflections, and applies each to the columns after it, which end with the residual. r:
 * the diagonal element of the triangle above the first column; right: the triangle's right-hand side, row by row, or null for nuisances,
 * where *r is 1/sigma of each. */
/*@ requires \valid(matrix) && \valid(r) && first <= last <= GOE_RESIDUAL;
    requires right == \null || \valid(right); */
static GOE_INLINE void reflect(goe_matrix_t *matrix, size_t first, size_t last, float *r, float *right, bool few) {
    reflection_t to;
    for (size_t j = first; j < last; j++) {
        float *column = &matrix->row[0][j];
        const bool turns = aim(column, *r, &to, few);
        if (!right) {
            if (turns) {
                pass_nuisance(&to, column + 1, &matrix->row[0][GOE_RESIDUAL], few);
            }
            continue;
        }
        float *next = r + (GOE_RESIDUAL - j);
        if (turns) {
            *r = to.diagonal;
            pass_unknown(&to, column + 1, r + 1, next, right, few);
        }
        r = next;
        right++;
    }
}

/* Each kernel exists once: a copy at every call would cost more than the calls. */
/*@ requires \valid(matrix) && \valid(r) && first <= last <= GOE_RESIDUAL;
    requires right == \null || \valid(right); */
GOE_NOINLINE static void reflect_few(goe_matrix_t *matrix, size_t first, size_t last, float *r, float *right) {
    reflect(matrix, first, last, r, right, true);
}

/*@ requires \valid(matrix) && \valid(r) && first <= last <= GOE_RESIDUAL;
    requires right == \null || \valid(right); */
GOE_NOINLINE static void reflect_all(goe_matrix_t *matrix, size_t first, size_t last, float *r, float *right) {
    reflect(matrix, first, last, r, right, false);
}

/*@ requires \valid(matrix) && \valid(r) && first <= last <= GOE_RESIDUAL;
    requires right == \null || \valid(right); */
static void reflect_columns(goe_matrix_t *matrix, size_t first, size_t last, float *r, float *right, bool few) {
    if (few) {
        reflect_few(matrix, first, last, r, right);
    } else {
        reflect_all(matrix, first, last, r, right);
    }
}

/* Solves R x = right in place; right is 0 for states that are not estimated. */
static void solve_back(const goe_triangle_t *root, float right[GOE_UNKNOWNS]) {
    const size_t count = goe_srif_count(root);
    const float *r = &root->element[goe_srif_row(count) + count]; /* after the last row */
    for (size_t i = count; i-- > 0;) {
        r -= GOE_UNKNOWNS - i; /* on the diagonal */
        float g = right[i];
        for (size_t j = i + 1; j < count; j++) {
            g -= r[j - i] * right[j];
        }
        right[i] = g / r[0];
    }
}

#if GOE_AUGMENTED
static void reflect_augmented(goe_triangle_t *root, goe_matrix_t *matrix, bool few, float change[GOE_UNKNOWNS]) {
    const size_t count = goe_srif_augmented_count(root);
    reflect_columns(matrix, GOE_AUGMENTED_COLUMN, GOE_RESIDUAL, &root->element[goe_srif_augmented_row()], root->right,
                    few);
    for (size_t j = 0; j < GOE_AUGMENTED; j++) {
        const bool estimated = j < count;
        change[GOE_STATES + j] = estimated ? root->right[j] : 0.0f;
        root->right[j] = estimated ? 0.0f : root->right[j];
    }
}
#endif

/*@ requires \valid(root) && \valid(matrix) && \valid(change + (0 .. GOE_UNKNOWNS - 1)) && states <= GOE_STATES; */
GOE_NOINLINE static float update(goe_triangle_t *root, float nuisance_root, goe_matrix_t *matrix, bool few,
                                 size_t states, float change[GOE_UNKNOWNS]) {
    reflect_columns(matrix, 0, GOE_NUISANCES, &nuisance_root, NULL, few);
    memset(change, 0, GOE_STATES * sizeof change[0]);
    reflect_columns(matrix, GOE_STATE_COLUMN, GOE_STATE_COLUMN + states, root->element, change, few);
    const column_t residual = load(&matrix->row[0][GOE_RESIDUAL], false);
#if GOE_AUGMENTED
    reflect_augmented(root, matrix, few, change);
#endif
    solve_back(root, change);
    return dot(residual, residual, residual.v0 * residual.v0, false);
}

float goe_srif_update(goe_triangle_t *root, float nuisance_root, goe_matrix_t *matrix, size_t count,
                      float change[GOE_UNKNOWNS]) {
    return update(root, nuisance_root, matrix, count <= GOE_ROWS_FEW, GOE_STATES, change);
}

float goe_srif_update_considering(goe_triangle_t *root, float nuisance_root, goe_matrix_t *matrix, size_t count,
                                  float change[GOE_UNKNOWNS]) {
    return update(root, nuisance_root, matrix, count <= GOE_ROWS_FEW, GOE_STATES - 1, change);
}

/* The rest of the row, by augmented states alone, is dropped: it does not estimate them. */
void goe_srif_add(goe_triangle_t *root, float row[GOE_UNKNOWNS], float residual, float right[GOE_UNKNOWNS]) {
    for (size_t i = GOE_UNWEIGHTED; i < GOE_STATES; i++) {
        float *r = &root->element[goe_srif_row(i)];
        const float length = sqrtf(r[i] * r[i] + row[i] * row[i]);
        const float c = r[i] / length;
        const float s = row[i] / length;
        for (size_t j = i; j < GOE_UNKNOWNS; j++) {
            const float p = r[j];
            const float q = row[j];
            r[j] = c * p + s * q;
            row[j] = c * q - s * p;
        }
        const float p = right[i];
        right[i] = c * p + s * residual;
        residual = c * residual - s * p;
    }
}

void goe_srif_solve(const goe_triangle_t *root, float right[GOE_UNKNOWNS]) { solve_back(root, right); }

/* ------------------------------------------------------------------------------------------------------ process noise -- */

/* A disturbance d of the state, x = x' + direction d, enters as a row (1/sigma) d = 0; Givens rotations then eliminate d from the triangle.
 * The code uses sigma, not 1/sigma, which must not overflow for a tiny sigma. */
void goe_srif_spread(goe_triangle_t *root, const float direction[GOE_STATES], size_t first, size_t last, float sigma) {
    float row[GOE_UNKNOWNS];
    goe_srif_zero(row, 0);
    for (size_t i = last + 1; i-- > 0;) {
        float *r = &root->element[goe_srif_row(i)];
        float b = 0.0f;
        for (size_t k = i > first ? i : first; k <= last; k++) {
            b -= r[k] * direction[k];
        }
        const float t = sigma * b;
        const float c = 1.0f / sqrtf(1.0f + t * t);
        const float s = t * c;
        sigma *= c;
        for (size_t k = i; k < GOE_UNKNOWNS; k++) {
            const float p = row[k];
            const float q = r[k];
            row[k] = c * p + s * q;
            r[k] = c * q - s * p;
        }
    }
}

/* ---------------------------------------------------------------------------------------------------------- variances -- */

GOE_STATIC_ASSERT(GOE_STATES == 10 && GOE_UNWEIGHTED == 3, the_projection_is_written_out_for_ten_states);

/*@ requires \valid_read(root) && i <= j < GOE_UNKNOWNS; */
static GOE_INLINE float r_at(const goe_triangle_t *root, size_t i, size_t j) {
    return root->element[goe_srif_row(i) + j];
}

void goe_srif_reciprocals(const goe_triangle_t *root, float reciprocal[GOE_STATES]) {
    reciprocal[0] = 1.0f / r_at(root, 0, 0);
    reciprocal[1] = 1.0f / r_at(root, 1, 1);
    reciprocal[2] = 1.0f / r_at(root, 2, 2);
    reciprocal[3] = 1.0f / r_at(root, 3, 3);
    reciprocal[4] = 1.0f / r_at(root, 4, 4);
    reciprocal[5] = 1.0f / r_at(root, 5, 5);
    reciprocal[6] = 1.0f / r_at(root, 6, 6);
    reciprocal[7] = 1.0f / r_at(root, 7, 7);
    reciprocal[8] = 1.0f / r_at(root, 8, 8);
    reciprocal[9] = 1.0f / r_at(root, 9, 9);
}

/* The sum that the first GOE_UNWEIGHTED elements, already solved, subtract from element j. */
/*@ requires \valid_read(root) && \valid_read(y + (0 .. GOE_UNWEIGHTED - 1)) && GOE_UNWEIGHTED <= j < GOE_STATES; */
static GOE_INLINE float taken(const goe_triangle_t *root, const float y[GOE_STATES], size_t j) {
    return r_at(root, 0, j) * y[0] + r_at(root, 1, j) * y[1] + r_at(root, 2, j) * y[2];
}

/* Solves these elements, and subtracts them from the others. Returns their squared norm. */
static GOE_INLINE float project_first(const goe_triangle_t *root, const float k[GOE_STATES], float y[GOE_STATES]) {
    y[0] *= k[0];
    y[1] = (y[1] - r_at(root, 0, 1) * y[0]) * k[1];
    y[2] = (y[2] - r_at(root, 0, 2) * y[0] - r_at(root, 1, 2) * y[1]) * k[2];
    y[3] -= taken(root, y, 3);
    y[4] -= taken(root, y, 4);
    y[5] -= taken(root, y, 5);
    y[6] -= taken(root, y, 6);
    y[7] -= taken(root, y, 7);
    y[8] -= taken(root, y, 8);
    y[9] -= taken(root, y, 9);
    return y[0] * y[0] + y[1] * y[1] + y[2] * y[2];
}

/* Forward substitution, written out: it is done for every row and every quantity of every image. */
float goe_srif_project(const goe_triangle_t *root, const float reciprocal[GOE_STATES], size_t first,
                       float weight[GOE_STATES]) {
    const float *k = reciprocal;
    float *w = weight;
    float sum = first < GOE_UNWEIGHTED ? project_first(root, k, w) : 0.0f;
    const float y3 = w[3] * k[3];
    const float y4 = (w[4] - r_at(root, 3, 4) * y3) * k[4];
    const float y5 = (w[5] - r_at(root, 3, 5) * y3 - r_at(root, 4, 5) * y4) * k[5];
    const float y6 = (w[6] - r_at(root, 3, 6) * y3 - r_at(root, 4, 6) * y4 - r_at(root, 5, 6) * y5) * k[6];
    const float y7 =
        (w[7] - r_at(root, 3, 7) * y3 - r_at(root, 4, 7) * y4 - r_at(root, 5, 7) * y5 - r_at(root, 6, 7) * y6) * k[7];
    const float y8 = (w[8] - r_at(root, 3, 8) * y3 - r_at(root, 4, 8) * y4 - r_at(root, 5, 8) * y5 -
                      r_at(root, 6, 8) * y6 - r_at(root, 7, 8) * y7) *
                     k[8];
    const float y9 = (w[9] - r_at(root, 3, 9) * y3 - r_at(root, 4, 9) * y4 - r_at(root, 5, 9) * y5 -
                      r_at(root, 6, 9) * y6 - r_at(root, 7, 9) * y7 - r_at(root, 8, 9) * y8) *
                     k[9];
    w[3] = y3;
    w[4] = y4;
    w[5] = y5;
    w[6] = y6;
    w[7] = y7;
    w[8] = y8;
    w[9] = y9;
    sum += y3 * y3;
    sum += y4 * y4;
    sum += y5 * y5;
    sum += y6 * y6;
    sum += y7 * y7;
    sum += y8 * y8;
    return sum + y9 * y9;
}

#if GOE_AUGMENTED
GOE_STATIC_ASSERT(GOE_AUGMENTED == 3, augmented_states_are_written_out);

/* Subtracts the part of element i from those of the augmented states. */
/*@ requires \valid_read(root) && i < GOE_STATES && \valid(p + (0 .. GOE_AUGMENTED - 1)); */
static GOE_INLINE void take_out(const goe_triangle_t *root, size_t i, float y, float p[GOE_AUGMENTED]) {
    p[0] -= r_at(root, i, GOE_STATES) * y;
    p[1] -= r_at(root, i, GOE_STATES + 1) * y;
    p[2] -= r_at(root, i, GOE_STATES + 2) * y;
}

void goe_srif_augmented(const goe_triangle_t *root, const float projected[GOE_STATES], size_t first,
                        const float direct[GOE_AUGMENTED], float considered, float part[GOE_AUGMENTED]) {
    const size_t count = goe_srif_augmented_count(root);
    const float *t = &root->element[goe_srif_augmented_row()];
    float p[GOE_AUGMENTED] = {0.0f, 0.0f, 0.0f};
    part[0] = 0.0f;
    part[1] = 0.0f;
    part[2] = 0.0f;
    if (count == 0 && !(considered > 0.0f)) {
        return;
    }
    if (direct) {
        p[0] = direct[0];
        p[1] = direct[1];
        p[2] = direct[2];
    }
    if (first < GOE_UNWEIGHTED) {
        take_out(root, 0, projected[0], p);
        take_out(root, 1, projected[1], p);
        take_out(root, 2, projected[2], p);
    }
    take_out(root, 3, projected[3], p);
    take_out(root, 4, projected[4], p);
    take_out(root, 5, projected[5], p);
    take_out(root, 6, projected[6], p);
    take_out(root, 7, projected[7], p);
    take_out(root, 8, projected[8], p);
    take_out(root, 9, projected[9], p);
    if (count > 0) {
        part[0] = p[0] / t[0];
        p[1] -= t[1] * part[0];
        p[2] -= t[2] * part[0];
    }
    part[1] = count > 1 ? p[1] / t[3] : considered * p[1];
    part[2] = count > 2 ? (p[2] - t[4] * part[1]) / t[5] : considered * p[2];
}
#endif

void goe_srif_marginal(const goe_triangle_t *root, float considered, float covariance[GOE_KEPT][GOE_KEPT]) {
    float reciprocal[GOE_STATES];
    float error[GOE_KEPT][GOE_UNKNOWNS];
    goe_srif_reciprocals(root, reciprocal);
    memset(error, 0, sizeof error);
    for (size_t j = 0; j < GOE_KEPT; j++) {
        error[j][j] = 1.0f;
        (void)goe_srif_project(root, reciprocal, 0, error[j]);
#if GOE_AUGMENTED
        goe_srif_augmented(root, error[j], 0, NULL, considered, &error[j][GOE_STATES]);
#else
        (void)considered;
#endif
        for (size_t i = 0; i <= j; i++) {
            float sum = 0.0f;
            for (size_t k = j; k < GOE_UNKNOWNS; k++) {
                sum += error[i][k] * error[j][k];
            }
            covariance[i][j] = sum;
        }
    }
}

/* Cholesky from the last column, C = U U' with U upper triangular: U is the inverse of R. */
static void factorise(float c[GOE_KEPT][GOE_KEPT]) {
    for (size_t j = GOE_KEPT; j-- > 0;) {
        float pivot = c[j][j];
        for (size_t k = j + 1; k < GOE_KEPT; k++) {
            pivot -= c[j][k] * c[j][k];
        }
        const float least = PIVOT_MIN * c[j][j];
        const float u = sqrtf(pivot > least ? pivot : least);
        for (size_t i = 0; i < j; i++) {
            float s = c[i][j];
            for (size_t k = j + 1; k < GOE_KEPT; k++) {
                s -= c[i][k] * c[j][k];
            }
            c[i][j] = s / u;
        }
        c[j][j] = u;
    }
}

/* The inverse of U, row by row. */
static void invert_kept(float u[GOE_KEPT][GOE_KEPT], goe_triangle_t *root) {
    for (size_t j = 0; j < GOE_KEPT; j++) {
        root->element[goe_srif_row(j) + j] = 1.0f / u[j][j];
        for (size_t i = j; i-- > 0;) {
            float sum = 0.0f;
            for (size_t k = i + 1; k <= j; k++) {
                sum += u[i][k] * root->element[goe_srif_row(k) + j];
            }
            root->element[goe_srif_row(i) + j] = -(sum * root->element[goe_srif_row(i) + i]);
        }
    }
}

void goe_srif_from_covariance(float covariance[GOE_KEPT][GOE_KEPT], const float sigma[GOE_STATES - GOE_KEPT],
                              goe_triangle_t *root) {
    goe_srif_clear(root);
    factorise(covariance);
    invert_kept(covariance, root);
    for (size_t i = GOE_KEPT; i < GOE_STATES; i++) {
        root->element[goe_srif_row(i) + i] = 1.0f / sigma[i - GOE_KEPT];
    }
}

void goe_srif_from_sigmas(const float sigma[GOE_STATES], goe_triangle_t *root) {
    goe_srif_clear(root);
    for (size_t i = 0; i < GOE_STATES; i++) {
        root->element[goe_srif_row(i) + i] = 1.0f / sigma[i];
    }
}

/* ------------------------------------------------------------------------------------------------------ other states -- */

GOE_STATIC_ASSERT(GOE_CHANGED <= GOE_ROWS_MAX && GOE_CHANGED < GOE_STATES, the_changed_states_fit_into_the_rows);

/* Replaces states. R times the derivative is no longer triangular in the changed rows, so they enter again, as measurements. */
void goe_srif_substitute(goe_triangle_t *root, const goe_substitution_t *old) {
    const size_t kept = GOE_STATES - GOE_CHANGED;
    goe_matrix_t rows;
    float change[GOE_UNKNOWNS];
    memset(&rows, 0, sizeof rows);
    for (size_t i = 0; i < GOE_STATES; i++) {
        float *r = &root->element[goe_srif_row(i)];
        float row[GOE_CHANGED] = {0.0f};
        for (size_t k = i > kept ? i : kept; k < GOE_STATES; k++) {
            for (size_t j = 0; j < GOE_CHANGED; j++) {
                row[j] += r[k] * old->by[k - kept][j];
            }
        }
        if (i < kept) {
            memcpy(&r[kept], row, sizeof row);
            continue;
        }
        for (size_t j = 0; j < GOE_CHANGED; j++) {
            rows.row[i - kept][GOE_STATE_COLUMN + kept + j] = row[j];
        }
        for (size_t j = GOE_STATES; j < GOE_UNKNOWNS; j++) {
            rows.row[i - kept][GOE_STATE_COLUMN + j] = r[j];
        }
        memset(&r[i], 0, (GOE_UNKNOWNS - i) * sizeof r[0]);
    }
#if GOE_AUGMENTED
    const uint8_t estimated = root->estimated; /* the augmented states keep their pending change */
    root->estimated = 0;
    (void)goe_srif_update(root, 1.0f, &rows, GOE_CHANGED, change);
    root->estimated = estimated;
#else
    (void)goe_srif_update(root, 1.0f, &rows, GOE_CHANGED, change);
#endif
}

#endif
