/* Square-root information filter: reflections, inverse, process noise. SPDX-License-Identifier: MIT
 *
 * The sign of the diagonal of R is free; nothing depends on it. */
#include "refined/goe_srif.h"

#include <math.h>
#include <string.h>

#if GOE_WITH_FILTER

#define PIVOT_MIN 1.0e-12f /* of the diagonal: a covariance this near to singular is taken as if it were this far */

/* The rows of the state come first. */
void goe_srif_clear(goe_triangle_t *root) {
    memset(root->element, 0, goe_srif_augmented_row() * sizeof root->element[0]);
}

/* -------------------------------------------------------------------------------------------------------- reflections -- */

/* Element k of a column lies in row k. The kernels hold one column of all rows in registers, of few rows or of as many as there can
 * be: `few` is a constant in each. Rows of zeros, which the longer kernel reads as well, change no bit. */
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

/* first: the sum up to the first row. */
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

/* False if the column is 0 already. r: the element of the triangle above it. */
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

/* Of the columns behind one of the nuisances. Nothing is known of these beforehand but their sigma: their rows of the triangle are 0 until
 * they are reached, and are not needed afterwards. */
/*@ requires \valid_read(to) && \valid(column) && \valid(last); */
static GOE_INLINE void pass_nuisance(const reflection_t *to, float *column, const float *last, bool few) {
    for (; column <= last; column++) {
        const column_t other = load(column, few);
        const float g = dot(to->column, other, to->column.v0 * other.v0, few) * to->beta;
        store_sum(column, other, g, to->column, few);
    }
}

/* Of the columns behind an unknown: first those of other unknowns, which are below the elements of the triangle from `above` to before
 * `end`, then the residual, which is below *right. */
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

/* The columns from first to before last, each reflected out of those behind it, which end with the residual. r: element of the
 * triangle above the first of them, on its diagonal; right: what belongs to the residual, row by row. Of the nuisances there is none, and
 * *r is 1/sigma of each. */
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

/* Each kernel once: a copy at every call would cost more than the calls. */
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

/* R x = right, in place; 0 for states that are not estimated. */
static void solve_back(const goe_triangle_t *root, float right[GOE_UNKNOWNS]) {
    const size_t count = goe_srif_count(root);
    const float *r = &root->element[goe_srif_row(count) + count]; /* behind the last row */
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

/* ------------------------------------------------------------------------------------------------------ process noise -- */

/* A disturbance d of the state, x = x' + direction d, enters as a row (1/sigma) d = 0; Givens rotations then take it out of
 * the triangle again. In terms of sigma, not 1/sigma: a tiny one must not overflow. */
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

/* ------------------------------------------------------------------------------------------------ inverse, covariance -- */

/*@ requires \valid_read(a + (0 .. count - 1)) && \valid_read(b + (0 .. count - 1)); */
static float dot_run(const float *a, const float *b, size_t count) {
    float sum = 0.0f;
    for (size_t i = 0; i < count; i++) {
        sum += a[i] * b[i];
    }
    return sum;
}

float goe_inverse_variance(const goe_inverse_t *inverse, size_t state) {
    const size_t count = goe_inverse_count(inverse);
    float sum = 0.0f;
    for (size_t j = state; j < count; j++) {
        const float v = inverse->element[goe_inverse_column(j) + state];
        sum += v * v;
    }
    return sum;
}

GOE_STATIC_ASSERT(GOE_UNWEIGHTED == 3, as_many_elements_of_a_column_are_left_0);

/* Column j of the inverse solves R v = (0 ... 1 at j ... 0)'. Of a column of the augmented states the first GOE_UNWEIGHTED elements, which
 * no quantity depends on, are left 0. */
/*@ requires \valid_read(root) && \valid(inverse) && first <= GOE_STATES; */
static void invert_from(const goe_triangle_t *root, size_t first, goe_inverse_t *inverse) {
    const size_t count = goe_srif_count(root);
    float *v = &inverse->element[goe_inverse_column(first)];
    for (size_t j = first; j < count; j++) {
        const size_t top = j < GOE_STATES ? 0 : GOE_UNWEIGHTED;
        if (top > 0) { /* written out: the compiler would call memset() for every column */
            v[0] = 0.0f;
            v[1] = 0.0f;
            v[2] = 0.0f;
        }
        v[j] = 1.0f / root->element[goe_srif_row(j) + j];
        for (size_t i = j; i-- > top;) {
            const float *r = &root->element[goe_srif_row(i)];
            v[i] = -(dot_run(&r[i + 1], &v[i + 1], j - i) * inverse->element[goe_inverse_column(i) + i]);
        }
        v += j + 1;
    }
#if GOE_AUGMENTED
    inverse->estimated = (uint8_t)goe_srif_augmented_count(root);
#endif
}

void goe_srif_invert(const goe_triangle_t *root, goe_inverse_t *inverse) { invert_from(root, 0, inverse); }

void goe_srif_invert_diagonal(const goe_triangle_t *root, goe_inverse_t *inverse) {
    memset(inverse, 0, sizeof *inverse);
    for (size_t i = 0; i < GOE_STATES; i++) {
        inverse->element[goe_inverse_column(i) + i] = 1.0f / root->element[goe_srif_row(i) + i];
    }
    invert_from(root, GOE_STATES, inverse);
}

GOE_STATIC_ASSERT(GOE_STATES == 10, the_variance_is_written_out_for_ten_states);

/* Written out: this is done for every row and every quantity of every image. */
float goe_srif_variance(const goe_inverse_t *inverse, const float weight[GOE_STATES]) {
    const float *v = inverse->element;
    const float w0 = weight[0], w1 = weight[1], w2 = weight[2], w3 = weight[3], w4 = weight[4];
    const float w5 = weight[5], w6 = weight[6], w7 = weight[7], w8 = weight[8], w9 = weight[9];
    float p = w0 * v[0];
    float sum = p * p;
    p = w0 * v[1] + w1 * v[2];
    sum += p * p;
    p = w0 * v[3] + w1 * v[4] + w2 * v[5];
    sum += p * p;
    p = w0 * v[6] + w1 * v[7] + w2 * v[8] + w3 * v[9];
    sum += p * p;
    p = w0 * v[10] + w1 * v[11] + w2 * v[12] + w3 * v[13] + w4 * v[14];
    sum += p * p;
    p = w0 * v[15] + w1 * v[16] + w2 * v[17] + w3 * v[18] + w4 * v[19] + w5 * v[20];
    sum += p * p;
    p = w0 * v[21] + w1 * v[22] + w2 * v[23] + w3 * v[24] + w4 * v[25] + w5 * v[26] + w6 * v[27];
    sum += p * p;
    p = w0 * v[28] + w1 * v[29] + w2 * v[30] + w3 * v[31] + w4 * v[32] + w5 * v[33] + w6 * v[34] + w7 * v[35];
    sum += p * p;
    p = w0 * v[36] + w1 * v[37] + w2 * v[38] + w3 * v[39] + w4 * v[40] + w5 * v[41] + w6 * v[42] + w7 * v[43] +
        w8 * v[44];
    sum += p * p;
    p = w0 * v[45] + w1 * v[46] + w2 * v[47] + w3 * v[48] + w4 * v[49] + w5 * v[50] + w6 * v[51] + w7 * v[52] +
        w8 * v[53] + w9 * v[54];
    return sum + p * p;
}

GOE_STATIC_ASSERT(GOE_UNWEIGHTED == 3, the_variance_of_the_rest_is_written_out_from_the_fourth_state);

float goe_srif_variance_of_rest(const goe_inverse_t *inverse, const float weight[GOE_STATES]) {
    const float *v = inverse->element;
    const float w3 = weight[3], w4 = weight[4], w5 = weight[5], w6 = weight[6];
    const float w7 = weight[7], w8 = weight[8], w9 = weight[9];
    float p = w3 * v[9];
    float sum = p * p;
    p = w3 * v[13] + w4 * v[14];
    sum += p * p;
    p = w3 * v[18] + w4 * v[19] + w5 * v[20];
    sum += p * p;
    p = w3 * v[24] + w4 * v[25] + w5 * v[26] + w6 * v[27];
    sum += p * p;
    p = w3 * v[31] + w4 * v[32] + w5 * v[33] + w6 * v[34] + w7 * v[35];
    sum += p * p;
    p = w3 * v[39] + w4 * v[40] + w5 * v[41] + w6 * v[42] + w7 * v[43] + w8 * v[44];
    sum += p * p;
    p = w3 * v[48] + w4 * v[49] + w5 * v[50] + w6 * v[51] + w7 * v[52] + w8 * v[53] + w9 * v[54];
    return sum + p * p;
}

#if GOE_AUGMENTED
GOE_STATIC_ASSERT(GOE_AUGMENTED == 3, augmented_states_are_cleared_by_three_writes);

/* Written out, as above. */
void goe_srif_augmented(const goe_inverse_t *inverse, const float weight[GOE_STATES], const float direct[GOE_AUGMENTED],
                        float part[GOE_AUGMENTED]) {
    const size_t count = goe_inverse_augmented(inverse);
    part[0] = 0.0f;
    part[1] = 0.0f;
    part[2] = 0.0f;
    for (size_t j = 0; j < count; j++) {
        const float *v = &inverse->element[goe_inverse_column(GOE_STATES + j)];
        float sum = weight[3] * v[3] + weight[4] * v[4] + weight[5] * v[5] + weight[6] * v[6] + weight[7] * v[7] +
                    weight[8] * v[8] + weight[9] * v[9];
        for (size_t k = 0; k <= j && direct; k++) {
            sum += direct[k] * v[GOE_STATES + k];
        }
        part[j] = sum;
    }
}
#endif

float goe_srif_last_variance(const goe_inverse_t *inverse, const float weight[GOE_STATES]) {
    const float last = dot_run(weight, &inverse->element[goe_inverse_column(GOE_STATES - 1)], GOE_STATES);
    return last * last;
}

/* From the last one on, as element j needs the weights up to j. */
void goe_srif_project(const goe_inverse_t *inverse, float weight[GOE_STATES]) {
    for (size_t j = GOE_STATES; j-- > GOE_UNWEIGHTED;) {
        const float *column = &inverse->element[goe_inverse_column(j)];
        weight[j] = dot_run(&weight[GOE_UNWEIGHTED], &column[GOE_UNWEIGHTED], j + 1 - GOE_UNWEIGHTED);
    }
}

void goe_srif_marginal(const goe_inverse_t *inverse, float covariance[GOE_KEPT][GOE_KEPT]) {
    memset(covariance, 0, GOE_KEPT * GOE_KEPT * sizeof(float));
    const size_t count = goe_inverse_count(inverse);
    for (size_t k = 0; k < count; k++) {
        const float *v = &inverse->element[goe_inverse_column(k)];
        const size_t last = k < GOE_KEPT ? k : GOE_KEPT - 1u;
        for (size_t i = 0; i <= last; i++) {
            for (size_t j = i; j <= last; j++) {
                covariance[i][j] += v[i] * v[j];
            }
        }
    }
}

/* Cholesky from the last column, C = U U' with U upper triangular: U is the inverse of R. */
static void factorise(float c[GOE_KEPT][GOE_KEPT], goe_inverse_t *inverse) {
    for (size_t j = GOE_KEPT; j-- > 0;) {
        float pivot = c[j][j];
        for (size_t k = j + 1; k < GOE_KEPT; k++) {
            pivot -= c[j][k] * c[j][k];
        }
        const float least = PIVOT_MIN * c[j][j];
        const float u = sqrtf(pivot > least ? pivot : least);
        float *column = &inverse->element[goe_inverse_column(j)];
        for (size_t i = 0; i < j; i++) {
            float s = c[i][j];
            for (size_t k = j + 1; k < GOE_KEPT; k++) {
                s -= c[i][k] * c[j][k];
            }
            c[i][j] = s / u;
            column[i] = c[i][j];
        }
        c[j][j] = u;
        column[j] = u;
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
                              goe_triangle_t *root, goe_inverse_t *inverse) {
    goe_srif_clear(root);
    memset(inverse, 0, sizeof *inverse);
    factorise(covariance, inverse);
    invert_kept(covariance, root);
    for (size_t i = GOE_KEPT; i < GOE_STATES; i++) {
        inverse->element[goe_inverse_column(i) + i] = sigma[i - GOE_KEPT];
        root->element[goe_srif_row(i) + i] = 1.0f / sigma[i - GOE_KEPT];
    }
    invert_from(root, GOE_STATES, inverse);
}

/* ------------------------------------------------------------------------------------------------------ other states -- */

GOE_STATIC_ASSERT(GOE_CHANGED <= GOE_ROWS_MAX && GOE_CHANGED < GOE_STATES, the_changed_states_fit_into_the_rows);

/* R times the derivative is square from the changed states on: these rows go in again, as if they were measured. */
void goe_srif_substitute(goe_triangle_t *root, const goe_substitution_t *old, goe_matrix_t *rows) {
    const size_t kept = GOE_STATES - GOE_CHANGED;
    float change[GOE_UNKNOWNS];
    memset(rows, 0, sizeof *rows);
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
            rows->row[i - kept][GOE_STATE_COLUMN + kept + j] = row[j];
        }
        for (size_t j = GOE_STATES; j < GOE_UNKNOWNS; j++) {
            rows->row[i - kept][GOE_STATE_COLUMN + j] = r[j];
        }
        memset(&r[i], 0, (GOE_UNKNOWNS - i) * sizeof r[0]);
    }
#if GOE_AUGMENTED
    const uint8_t estimated = root->estimated; /* the augmented states keep their pending change */
    root->estimated = 0;
    (void)goe_srif_update(root, 1.0f, rows, GOE_CHANGED, change);
    root->estimated = estimated;
#else
    (void)goe_srif_update(root, 1.0f, rows, GOE_CHANGED, change);
#endif
}

#endif
