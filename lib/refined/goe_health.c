/* How well the images fit: means of the NIS, refused points, restarts. SPDX-License-Identifier: MIT */
#include "refined/goe_health.h"

#include <string.h>

#include "maths/goe_scalar.h"

#if GOE_WITH_FILTER

#define RECENT_MEMORY 0.125f /* weight of one image in recent_nis */
#define MEAN_IMAGES 64       /* images that mean_nis remembers */
#define MEAN_SEEDS 8         /* images of NIS 0 with which it begins: the first images alone are not informative */
#define RATIO_MAX 20.0f      /* limit of NIS over rows of one image: one outlier must not decide */
#define RECENT_MAX 6.0f      /* recent_nis that only a captured state reaches */
#define POOR_IMAGES 3
#define REFUSED_IMAGES 4 /* images in a row in which a point is refused before the state is doubted */
#define REFUSED_TOPS 3
#define EARLY_IMAGES 32 /* first images of the track: a failure in them began with an outlier */
#define FAILURES_MAX 2  /* times that a box of base corners may prove wrong */
#define TOP_FREED 2.0f
#define RESTART_IMAGES 24 /* images within which a second restart is one too many: 3 s at 8 Hz */
#define STATE_MAX 1.0e6f
#define NIS_MAX 1.0e6f

/* ---------------------------------------------------------------------------------------------------------- means -- */

static void average(float *mean, float ratio, float memory) {
    *mean += ((ratio < RATIO_MAX ? ratio : RATIO_MAX) - *mean) * memory;
}

static unsigned bits_of(unsigned set) {
    unsigned count = 0;
    for (; set != 0; set &= set - 1u) {
        count++;
    }
    return count;
}

/* Whether half of the points or more do not fit. */
static bool is_poor(goe_verdict_t verdict) {
    return verdict.measured != 0 && 2u * bits_of(verdict.refused) >= bits_of(verdict.measured);
}

static void average_track(goe_health_t *health, float ratio) {
    const int before = health->images > 0 ? health->images : 0;
    health->images = (int16_t)(before < INT16_MAX ? before + 1 : INT16_MAX);
    const int counted = health->images + MEAN_SEEDS;
    average(&health->mean_nis, ratio, 1.0f / (float)(counted < MEAN_IMAGES ? counted : MEAN_IMAGES));
    average(&health->excess, ratio - 1.0f, 1.0f / (float)counted);
}

void goe_health_expect(goe_health_t *health) {
    health->nis = 0.0f;
    health->nis_rows = 0;
}

void goe_health_take(goe_health_t *health, goe_verdict_t verdict, float nis) {
    health->steady = (uint8_t)(health->steady > 0 && health->steady < UINT8_MAX ? health->steady + 1 : health->steady);
    health->nis = goe_within(nis, NIS_MAX) ? nis : NIS_MAX;
    health->nis_rows = (int16_t)verdict.rows;
    const float ratio = health->nis / (float)verdict.rows;
    average_track(health,
                  is_poor(verdict) ? RATIO_MAX : ratio); /* if poor, the fit of the other points is not informative */
    if (health->recent_nis < 0.0f) {
        health->recent_nis = 1.0f;
    } else {
        average(&health->recent_nis, ratio, RECENT_MEMORY);
    }
}

void goe_health_take_refused(goe_health_t *health, goe_verdict_t verdict) {
    if (verdict.measured != 0) {
        average_track(health, RATIO_MAX);
    }
}

/* ----------------------------------------------------------------------------------------------------------- recovery -- */

/* Whether a point is refused image after image: then an outlier has captured the state, and the point is right. */
static bool is_captured(goe_filter_t *filter, goe_verdict_t verdict) {
    goe_health_t *health = &filter->health;
    bool captured = false;
    for (size_t i = 0; i < GOE_FEATURES; i++) {
        const unsigned flag = 1u << i;
        if ((verdict.refused & flag) != 0) {
            captured = goe_count_image(&health->refused[i]) >= REFUSED_IMAGES || captured;
        } else if ((verdict.measured & flag) != 0) {
            health->refused[i] = 0;
        }
    }
    if (is_poor(verdict)) {
        captured = goe_count_image(&health->poor) >= POOR_IMAGES || captured;
    } else if (verdict.measured != 0) {
        health->poor = 0;
    }
    return captured;
}

/* The detector may find one corner of a box's roof now, and another one later. No other state depends on the top. */
static void free_top(goe_filter_t *filter) {
    const float *x = filter->state;
    const float extent = goe_larger(x[GOE_FRONT_X], goe_absolute(x[GOE_DEPTH_DIFFERENCE]));
    goe_filter_inflate(filter, GOE_TOP, TOP_FREED * goe_larger(goe_absolute(x[GOE_TOP]), extent));
    filter->health.refused[GOE_POINT_TOP] = 0;
}

static bool is_sane(const goe_filter_t *filter) {
    bool sane = filter->state[GOE_FRONT_X] > 0.0f;
    for (size_t i = 0; i < GOE_STATES; i++) {
        sane = goe_within(filter->state[i], STATE_MAX) &&
               goe_magnitude(filter->root.element[goe_srif_row(i) + i]) < GOE_INFINITY_BITS && sane;
    }
    return sane;
}

/* Counts the failures of a box of base corners. If it proves wrong more than once, the corners belong to something else. One failure does not
 * decide: configured noise that is too small must not cost a true box its corners. */
static void count_failure(goe_filter_t *filter, goe_model_t asked) {
    if (goe_filter_is_box(filter) && asked == GOE_MODEL_AUTO && filter->health.images >= EARLY_IMAGES) {
        filter->health.base_refused = goe_count_image(&filter->health.failed) >= FAILURES_MAX;
    }
}

/* An outlier, or an obstacle that crosses another, may cause one restart. Two so soon mean a bad track. */
static void count_restart(goe_health_t *health) {
    health->adrift = health->adrift || (health->steady > 0 && health->steady < RESTART_IMAGES);
    health->steady = 1;
}

bool goe_health_judge(goe_filter_t *filter, goe_model_t asked, goe_verdict_t verdict) {
    goe_health_t *health = &filter->health;
    const bool captured = is_captured(filter, verdict);
    if (goe_filter_is_box(filter) && health->refused[GOE_POINT_TOP] >= REFUSED_TOPS) {
        free_top(filter);
    }
    if (!captured && !(health->recent_nis > RECENT_MAX) && is_sane(filter)) {
        return false;
    }
    count_failure(filter, asked);
    count_restart(health);
    goe_filter_forgive(filter);
    return true;
}

#endif
