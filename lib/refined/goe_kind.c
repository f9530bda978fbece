/* The sizes of the detector's class: their rows and their test. SPDX-License-Identifier: MIT */
#include "refined/goe_kind.h"

#include <math.h>
#include <string.h>

#include "maths/goe_scalar.h"

#if GOE_WITH_FILTER

#define WRONG_SIGMAS2 16.0f /* 4 sigma: a size that far off is of another class */
#define DOUBT_SIGMAS2 4.0f  /* 2 sigma: a size that far off gives no estimate */
#define WRONG_IMAGES 3      /* images in a row that find a size wrong */
#define KNOWN_SHARE 0.7f    /* share of range_sd_rel_max: images that know the range better need no size */
#define WIDER 1.2f          /* factor on a size's sigma: the silhouette is not exactly a box's width and height */
#define ANGLE_MIN 1.0e-6f   /* least angular size that gives a range */
#define FARTHER 10.0f       /* factor from the previous prior range, which is 2.25 sigma from the new one */
#define PASSED_MAX 3u       /* largest number of such steps */

enum { KIND_WIDTH, KIND_HEIGHT, KIND_SIZES };

GOE_STATIC_ASSERT(KIND_SIZES == GOE_KIND_SIZES, width_and_height);

float goe_kind_range_m(const goe_kind_t *kind, float across, float up) {
    const bool wide = kind->width_m > 0.0f && across > ANGLE_MIN;
    const bool tall = kind->height_m > 0.0f && up > ANGLE_MIN;
    if (tall && (!wide || kind->height_sd_m * kind->width_m < kind->width_sd_m * kind->height_m)) {
        return kind->height_m / up;
    }
    return wide ? kind->width_m / across : 0.0f;
}

void goe_kind_start(goe_filter_t *filter, const goe_observation_t *obs, bool by_kind) {
    filter->kind.known = 0;
    filter->kind.usable = 0;
    filter->kind.contradicted = 0;
    filter->kind.is_round = obs->is_round;
    filter->kind.first = by_kind;
}

/* Width of the silhouette, units of Z0, with its derivatives. */
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

/* Size in the state minus that of the class, units of Z0, with its derivatives: it is linear in the state. */
static float excess_of(const goe_filter_t *filter, size_t size, float size_m, float by[GOE_STATES]) {
    const float *x = filter->state;
    memset(by, 0, GOE_STATES * sizeof by[0]);
    by[GOE_INVERSE_RANGE] = -size_m;
    if (size == KIND_WIDTH) {
        return width_of(filter, by) - size_m * x[GOE_INVERSE_RANGE];
    }
    by[GOE_TOP] = 1.0f;
    by[GOE_GROUND] = 1.0f;
    return x[GOE_TOP] + x[GOE_GROUND] - size_m * x[GOE_INVERSE_RANGE];
}

/* One sigma of the class's size, units of Z0. While the range is poorly known, the visible size sets the scale, not the range. */
static float sd_of(const goe_filter_t *filter, size_t size) {
    float by[GOE_STATES];
    const float size_m = filter->kind.size_m[size];
    const float q = filter->state[GOE_INVERSE_RANGE];
    const float visible = excess_of(filter, size, size_m, by) + size_m * q;
    return filter->kind.sd_m[size] * goe_larger(q, visible / size_m);
}

static void take(goe_filter_t *filter, const goe_kind_t *kind) {
    const float size_m[KIND_SIZES] = {kind->width_m, kind->height_m};
    const float sd_m[KIND_SIZES] = {kind->width_sd_m, kind->height_sd_m};
    for (size_t i = 0; i < KIND_SIZES; i++) {
        if (size_m[i] > 0.0f) {
            filter->kind.size_m[i] = size_m[i];
            filter->kind.sd_m[i] = sd_m[i];
        }
    }
}

/* (excess over its sigma)^2; the sigma contains the errors of class and images. */
static float difference2(const goe_filter_t *filter, const float reciprocal[GOE_STATES], size_t size) {
    float by[GOE_STATES];
    const float excess = excess_of(filter, size, filter->kind.size_m[size], by);
    const float variance = goe_srif_project(&filter->root, reciprocal, GOE_UNWEIGHTED, by);
    const float sd = filter->kind.sd_m[size] * filter->state[GOE_INVERSE_RANGE];
    return goe_square(excess) / (goe_square(sd) + variance);
}

static bool has_size(const goe_kind_use_t *kind) {
    return kind->size_m[KIND_WIDTH] > 0.0f || kind->size_m[KIND_HEIGHT] > 0.0f;
}

void goe_kind_reject(goe_filter_t *filter) {
    filter->kind.wrong = true;
    memset(filter->kind.size_m, 0, sizeof filter->kind.size_m);
}

static void count(goe_filter_t *filter, bool off) {
    if (!off) {
        filter->kind.contradicted = 0;
    } else if (goe_count_image(&filter->kind.contradicted) >= WRONG_IMAGES) {
        goe_kind_reject(filter);
    }
}

void goe_kind_start_farther(goe_filter_t *filter) {
    if (filter->kind.first) {
        goe_kind_reject(filter);
    } else {
        (void)goe_count_image(&filter->kind.passed);
    }
    goe_filter_enter(filter, GOE_PHASE_NONE);
}

float goe_kind_prior_width_m(const goe_settings_t *settings, unsigned passed) {
    float width_m = settings->filter.prior_width_m;
    for (unsigned i = 0; i < PASSED_MAX && i < passed; i++) {
        width_m *= FARTHER;
    }
    return width_m;
}

static bool is_range_known(const goe_filter_t *filter, const float reciprocal[GOE_STATES], float range_share) {
    float by[GOE_STATES] = {0.0f};
    by[GOE_INVERSE_RANGE] = 1.0f;
    return goe_srif_project(&filter->root, reciprocal, GOE_UNWEIGHTED, by) <
           goe_square(KNOWN_SHARE * range_share * filter->state[GOE_INVERSE_RANGE]);
}

void goe_kind_test(goe_filter_t *filter, const goe_observation_t *obs) {
    float reciprocal[GOE_STATES];
    bool off = false;
    take(filter, obs->kind);
    filter->kind.usable = 0;
    if (!has_size(&filter->kind)) {
        return; /* no class, which is usual */
    }
    goe_srif_reciprocals(&filter->root, reciprocal);
    for (size_t i = 0; i < KIND_SIZES; i++) {
        if (filter->kind.size_m[i] > 0.0f) {
            const float squared = difference2(filter, reciprocal, i);
            filter->kind.usable = (uint8_t)(filter->kind.usable | (squared < DOUBT_SIGMAS2 ? 1u << i : 0u));
            off = squared > WRONG_SIGMAS2 || off;
        }
    }
    count(filter, off);
    if (filter->kind.contradicted > 0 || is_range_known(filter, reciprocal, obs->settings->filter.range_sd_rel_max)) {
        filter->kind.usable = 0;
    }
}

static void add_size(goe_filter_t *filter, size_t size, float right[GOE_UNKNOWNS]) {
    float row[GOE_UNKNOWNS] = {0.0f};
    const float weight = 1.0f / (WIDER * sd_of(filter, size));
    const float excess = excess_of(filter, size, filter->kind.size_m[size], row);
    for (size_t i = GOE_UNWEIGHTED; i < GOE_STATES; i++) {
        row[i] *= weight;
    }
    goe_srif_add(&filter->root, row, -weight * excess, right);
}

void goe_kind_restore(goe_filter_t *filter, const goe_kind_saved_t *saved) {
    memcpy(filter->state, saved->state, sizeof saved->state);
    memcpy(&filter->root, &saved->root, sizeof saved->root);
}

bool goe_kind_apply(goe_filter_t *filter, goe_kind_saved_t *saved) {
    float change[GOE_UNKNOWNS] = {0.0f};
    const unsigned sizes = filter->kind.usable;
    if (sizes == 0 || !goe_filter_has_started(filter)) {
        return false;
    }
    memcpy(saved->state, filter->state, sizeof saved->state);
    memcpy(&saved->root, &filter->root, sizeof saved->root);
    for (size_t i = 0; i < KIND_SIZES; i++) {
        if ((sizes & (1u << i)) != 0u) {
            add_size(filter, i, change);
        }
    }
    goe_srif_solve(&filter->root, change);
    for (size_t i = 0; i < GOE_STATES; i++) {
        filter->state[i] += change[i];
    }
    return true;
}

#endif
