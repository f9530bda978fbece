/* Rows of a size by its class, and their test. SPDX-License-Identifier: MIT */
#include "refined/goe_kind.h"

#include <math.h>
#include <string.h>

#include "maths/goe_scalar.h"

#if GOE_WITH_FILTER

#define WRONG_SIGMAS2 16.0f /* 4 sigma: a size that far off is of another class */
#define DOUBT_SIGMAS2 4.0f  /* 2 sigma: a size that far off gives no answer */
#define WRONG_IMAGES 3      /* in a row that find it so */
#define KNOWN_SHARE 0.7f    /* of range_share: images that know the range better need no size */
#define WIDER 1.2f          /* of a size's sigma: a silhouette is no box's width and height */
#define ANGLE_MIN 1.0e-6f   /* of a size that gives a range */

enum { WIDTH, HEIGHT, SIZES };

GOE_STATIC_ASSERT(SIZES == GOE_KIND_SIZES, width_and_height);

float goe_kind_range_m(const goe_kind_t *kind, float across, float up) {
    const bool wide = kind->width_m > 0.0f && across > ANGLE_MIN;
    const bool tall = kind->height_m > 0.0f && up > ANGLE_MIN;
    if (tall && (!wide || kind->height_sd_m * kind->width_m < kind->width_sd_m * kind->height_m)) {
        return kind->height_m / up;
    }
    return wide ? kind->width_m / across : 0.0f;
}

void goe_kind_start(goe_filter_t *filter, const goe_observation_t *obs) {
    filter->kind.known = 0;
    filter->kind.contradicted = 0;
    filter->kind.round = obs->round;
}

/* Of the silhouette, units of Z0. */
static float width_of(const goe_filter_t *filter, float by[GOE_STATES]) {
    const float *x = filter->state;
    const bool is_ellipse = goe_filter_traits(filter)->is_ellipse;
    by[GOE_HALF] = is_ellipse ? 2.0f : 1.0f;
    if (is_ellipse) {
        return 2.0f * x[GOE_HALF];
    }
    by[GOE_SIDE_X] = x[GOE_SIDE_X] < 0.0f ? -1.0f : 1.0f;
    return x[GOE_FRONT_X] + goe_absolute(x[GOE_SIDE_X]);
}

/* By how much a size of the state exceeds the class's, units of Z0, with the derivatives: linear in the state. */
static float excess_of(const goe_filter_t *filter, size_t size, float size_m, float by[GOE_STATES]) {
    const float *x = filter->state;
    memset(by, 0, GOE_STATES * sizeof by[0]);
    by[GOE_INVERSE_RANGE] = -size_m;
    if (size == WIDTH) {
        return width_of(filter, by) - size_m * x[GOE_INVERSE_RANGE];
    }
    by[GOE_TOP] = 1.0f;
    by[GOE_GROUND] = 1.0f;
    return x[GOE_TOP] + x[GOE_GROUND] - size_m * x[GOE_INVERSE_RANGE];
}

/* Of a row with the derivatives `by`, which are used up. */
static float variance_of(const goe_filter_t *filter, float by[GOE_STATES]) {
    float reciprocal[GOE_STATES];
    goe_srif_reciprocals(&filter->root, reciprocal);
    return goe_srif_project(&filter->root, reciprocal, GOE_UNWEIGHTED, by);
}

static void take(goe_filter_t *filter, const goe_kind_t *kind) {
    const float size_m[SIZES] = {kind->width_m, kind->height_m};
    const float sd_m[SIZES] = {kind->width_sd_m, kind->height_sd_m};
    for (size_t i = 0; i < SIZES; i++) {
        if (size_m[i] > 0.0f) {
            filter->kind.size_m[i] = size_m[i];
            filter->kind.sd_m[i] = sd_m[i];
        }
    }
}

/* Whether the images know the size, and another one. */
static bool is_off(const goe_filter_t *filter, size_t size, float sigmas2) {
    float by[GOE_STATES];
    const float excess = excess_of(filter, size, filter->kind.size_m[size], by);
    const float class2 = goe_square(filter->kind.sd_m[size] * filter->state[GOE_INVERSE_RANGE]);
    return goe_square(excess) > sigmas2 * (class2 + variance_of(filter, by));
}

void goe_kind_test(goe_filter_t *filter, const goe_observation_t *obs) {
    bool off = false;
    take(filter, obs->kind);
    for (size_t i = 0; i < SIZES; i++) {
        off = (filter->kind.size_m[i] > 0.0f && is_off(filter, i, WRONG_SIGMAS2)) || off;
    }
    if (!off) {
        filter->kind.contradicted = 0;
    } else if (goe_count_image(&filter->kind.contradicted) >= WRONG_IMAGES) {
        filter->kind.wrong = true;
        memset(filter->kind.size_m, 0, sizeof filter->kind.size_m);
    }
}

static void add_size(const goe_filter_t *filter, size_t size, goe_matrix_t *matrix, size_t *count) {
    const float weight = 1.0f / (WIDER * filter->kind.sd_m[size] * filter->state[GOE_INVERSE_RANGE]);
    float *row = matrix->row[(*count)++];
    float *by = &row[GOE_STATE_COLUMN];
    row[GOE_RESIDUAL] = -weight * excess_of(filter, size, filter->kind.size_m[size], by);
    for (size_t i = 0; i < GOE_STATES; i++) {
        by[i] *= weight;
    }
}

static bool is_range_known(const goe_filter_t *filter, float share) {
    return goe_filter_variance(filter, GOE_INVERSE_RANGE) <
           goe_square(KNOWN_SHARE * share * filter->state[GOE_INVERSE_RANGE]);
}

void goe_kind_return(goe_filter_t *filter, const goe_kind_loan_t *loan) {
    memcpy(filter->state, loan->state, sizeof loan->state);
    filter->root = loan->root;
}

bool goe_kind_lend(goe_filter_t *filter, float range_share, goe_kind_loan_t *loan) {
    goe_matrix_t matrix;
    float change[GOE_UNKNOWNS];
    size_t count = 0;
    const bool own = (filter->known & GOE_HAS_POSITION) != 0u;
    if (own || filter->kind.contradicted > 0 || !goe_filter_has_started(filter) ||
        is_range_known(filter, range_share)) {
        return false;
    }
    memset(&matrix, 0, sizeof matrix);
    for (size_t i = 0; i < SIZES; i++) {
        if (filter->kind.size_m[i] > 0.0f && !is_off(filter, i, DOUBT_SIGMAS2)) {
            add_size(filter, i, &matrix, &count);
        }
    }
    if (count == 0) {
        return false;
    }
    memcpy(loan->state, filter->state, sizeof loan->state);
    loan->root = filter->root;
    (void)goe_srif_update(&filter->root, 1.0f, &matrix, count, change);
    for (size_t i = 0; i < GOE_STATES; i++) {
        filter->state[i] += change[i];
    }
    return true;
}

#endif
