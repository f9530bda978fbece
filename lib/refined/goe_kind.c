/* Rows of a size by its class, and their test. SPDX-License-Identifier: MIT */
#include "refined/goe_kind.h"

#include <math.h>
#include <string.h>

#include "maths/goe_scalar.h"

#if GOE_WITH_FILTER

#define WRONG_SIGMAS2 16.0f /* 4 sigma: a size that far off is of another class */
#define WRONG_IMAGES 8      /* in a row that find it so */
#define LEARNED_MIN 0.2f    /* of a size's variance: images that have taken off less say nothing of it */
#define ANGLE_MIN 1.0e-6f   /* of a size that gives a range */

enum { WIDTH, HEIGHT, SIZES };

GOE_STATIC_ASSERT(SIZES == GOE_KIND_SIZES, width_and_height);

static goe_kind_range_t by_size(float size_m, float sd_m, float angle) {
    const bool known = size_m > 0.0f && angle > ANGLE_MIN;
    const goe_kind_range_t range = {known ? size_m / angle : 0.0f, known ? sd_m / size_m : 0.0f};
    return range;
}

goe_kind_range_t goe_kind_range(const goe_kind_t *kind, float across, float up) {
    const goe_kind_range_t width = by_size(kind->width_m, kind->width_sd_m, across);
    const goe_kind_range_t height = by_size(kind->height_m, kind->height_sd_m, up);
    const bool taller = height.share > 0.0f && (!(width.share > 0.0f) || height.share < width.share);
    return taller ? height : width;
}

void goe_kind_start(goe_filter_t *filter, const goe_observation_t *obs) {
    filter->kind.used = 0;
    filter->kind.contradicted = 0;
    filter->kind.round = obs->round;
}

/* By how much a size of the state exceeds the class's, units of Z0, with the derivatives; linear in the state. (R38), (R39) */
static float excess_of(const goe_filter_t *filter, size_t size, float size_m, float by[GOE_STATES]) {
    const float *x = filter->state;
    memset(by, 0, GOE_STATES * sizeof by[0]);
    by[GOE_INVERSE_RANGE] = -size_m;
    if (size == WIDTH) {
        by[GOE_HALF] = 2.0f;
        return 2.0f * x[GOE_HALF] - size_m * x[GOE_INVERSE_RANGE];
    }
    by[GOE_TOP] = 1.0f;
    by[GOE_GROUND] = 1.0f;
    return x[GOE_TOP] + x[GOE_GROUND] - size_m * x[GOE_INVERSE_RANGE];
}

/* A box has no width across. */
static bool applies(const goe_filter_t *filter, size_t size) {
    return size == HEIGHT || goe_filter_traits(filter)->is_ellipse;
}

/* Of a row with the derivatives `by`, which are used up. */
static float variance_of(const goe_filter_t *filter, float by[GOE_STATES]) {
    float reciprocal[GOE_STATES];
    goe_srif_reciprocals(&filter->root, reciprocal);
    return goe_srif_project(&filter->root, reciprocal, GOE_UNWEIGHTED, by);
}

/* One row. A size that does not fit at all is not used. */
static int add_size(goe_filter_t *filter, size_t size, float size_m, float sd_m, goe_rows_t *rows) {
    float *row = rows->matrix->row[rows->count];
    float *by = &row[GOE_STATE_COLUMN];
    float projected[GOE_STATES];
    const float excess = excess_of(filter, size, size_m, projected);
    const float sd = sd_m * filter->state[GOE_INVERSE_RANGE];
    if (goe_square(excess) > WRONG_SIGMAS2 * (goe_square(sd) + variance_of(filter, projected))) {
        filter->kind.wrong = true;
        return 0;
    }
    (void)excess_of(filter, size, size_m, by);
    for (size_t i = 0; i < GOE_STATES; i++) {
        by[i] /= sd;
    }
    row[GOE_RESIDUAL] = -excess / sd;
    rows->count++;
    filter->kind.used |= (uint8_t)(1u << size);
    filter->kind.size_m[size] = size_m;
    filter->kind.sd_m[size] = sd_m;
    return 1;
}

int goe_kind_rows(goe_filter_t *filter, const goe_observation_t *obs, goe_rows_t *rows) {
    const float size_m[SIZES] = {obs->kind->width_m, obs->kind->height_m};
    const float sd_m[SIZES] = {obs->kind->width_sd_m, obs->kind->height_sd_m};
    int added = 0;
    for (size_t i = 0; i < SIZES; i++) {
        const bool is_new = size_m[i] > 0.0f && ((unsigned)filter->kind.used & (1u << i)) == 0u;
        if (is_new && applies(filter, i) && rows->count < GOE_ROWS_MAX) {
            added += add_size(filter, i, size_m[i], sd_m[i], rows);
        }
    }
    return added;
}

/* What the images have moved a size by has the variance that they have taken off it. */
static bool is_off(const goe_filter_t *filter, size_t size) {
    float by[GOE_STATES];
    const float excess = excess_of(filter, size, filter->kind.size_m[size], by);
    const float class2 = goe_square(filter->kind.sd_m[size] * filter->state[GOE_INVERSE_RANGE]);
    const float learned = class2 - variance_of(filter, by);
    return learned > LEARNED_MIN * class2 && goe_square(excess) > WRONG_SIGMAS2 * learned;
}

bool goe_kind_contradicts(goe_filter_t *filter) {
    bool off = false;
    for (size_t i = 0; i < SIZES; i++) {
        const bool used = ((unsigned)filter->kind.used & (1u << i)) != 0u;
        off = (used && applies(filter, i) && is_off(filter, i)) || off;
    }
    if (!off) {
        filter->kind.contradicted = 0;
        return false;
    }
    if (goe_count_image(&filter->kind.contradicted) < WRONG_IMAGES) {
        return false;
    }
    filter->kind.wrong = true;
    return true;
}

#endif
