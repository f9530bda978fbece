/* The camera's height above the obstacle's ground: mean of its readings, and rows. SPDX-License-Identifier: MIT */
#include "refined/goe_ground.h"

#include <math.h>

#include "maths/goe_scalar.h"

#if GOE_WITH_FILTER

#define UNKNOWN_SD_M 1.0e3f  /* sigma of a height that was not set */
#define GROWN 1.0e-3f        /* least growth of the heights' information, as a share: less waits for more */
#define NARROW 0.95f         /* ground_scale below which the ground's information is too strong */
#define WIDE 1.05f           /* ground_scale above which it is too weak */
#define SCALE_MIN 0.05f      /* a smaller one counts as this */
#define SCATTER_SEEDS 8      /* readings as configured with which the scatter begins */
#define SCATTER_MEMORY 64.0f /* readings that the scatter remembers */
#define VARIANCE_MIN_M2 1.0e-12f
#define LEVEL_SHARE 1.0e-3f   /* least share of the offset's variance that remains on level ground */
#define VARIANCE_MIN 1.0e-12f /* least variance of the offset, units of Z0 */
#define UNKNOWN 1.0e12f /* a larger variance of the offset grows as this one would: each image could multiply it */

/* ----------------------------------------------------------------------------------------------------------- readings -- */

/* Down of the camera. Its direction in the camera's axes is a row of camera -> T, because T is level. */
static float camera_down_m(const goe_view_t *view) {
    const float *down = &view->camera_to_trajectory[3];
    float arm_m = 0.0f;
    for (size_t i = 0; i < 3; i++) {
        for (size_t j = 0; j < 3; j++) {
            arm_m += down[i] * view->camera_to_body[3 * j + i] * view->camera->offset_m[j];
        }
    }
    return view->image->pose.position_ned_m[2] + arm_m;
}

/* A Kalman filter of one state, the altimeter's zero: down drifts, and readings scatter as configured or more. Until the obstacle's filter
 * starts, the mean moves the ground. */
static void average(goe_filter_t *filter, const goe_navigation_t *navigation, float off_m, float since_s) {
    goe_datum_t *datum = &filter->datum;
    uint8_t *readings = &filter->health.heights;
    const float innovation2 = *readings > 0 ? goe_square(off_m - datum->mean_m) : 0.0f;
    const float counted = (float)(*readings + SCATTER_SEEDS);
    datum->scatter_m2 += (innovation2 - datum->scatter_m2) / (counted < SCATTER_MEMORY ? counted : SCATTER_MEMORY);
    const float white2 = goe_larger(goe_square(navigation->height_white_sd_m), datum->scatter_m2);
    const float predicted = datum->noise_m2 + goe_square(navigation->position_walk_sd_m) * since_s;
    const float gain = *readings > 0 ? predicted / goe_larger(predicted + white2, VARIANCE_MIN_M2) : 1.0f;
    *readings = (uint8_t)(*readings < UINT8_MAX ? *readings + 1 : UINT8_MAX);
    datum->noise_m2 = gain * white2;
    datum->mean_m += gain * (off_m - datum->mean_m);
    if (!goe_filter_has_started(filter)) {
        datum->ground_m += datum->mean_m;
        datum->mean_m = 0.0f;
    }
}

/* Call before each height; only the first one of a track has an effect. A filter that started without it, and has found no position yet,
 * starts again with it. */
static void begin_heights(goe_filter_t *filter, float sd_m) {
    if (filter->health.heights > 0) {
        return;
    }
    filter->datum.sd_m = sd_m;
    if ((filter->known & GOE_HAS_POSITION) == 0u) {
        goe_filter_enter(filter, GOE_PHASE_NONE);
    }
}

void goe_ground_read(goe_filter_t *filter, const goe_navigation_t *navigation, const goe_view_t *view, float since_s) {
    goe_datum_t *datum = &filter->datum;
    const float down_m = camera_down_m(view);
    const float ground_m = view->motion->height_m + down_m;
    const bool lacks_height = goe_ground_lacks_height(view);
    if (!filter->has_datum) {
        datum->ground_m = ground_m;
        datum->sd_m = UNKNOWN_SD_M;
        datum->scatter_m2 = goe_square(navigation->height_white_sd_m);
        filter->has_datum = true;
    }
    const float before_m = datum->ground_m;
    if (!lacks_height) {
        begin_heights(filter, view->image->noise.height_sd_m);
        average(filter, navigation, ground_m - datum->ground_m, since_s);
    }
    filter->answer.height_bias_m -= datum->ground_m - before_m; /* an estimate from before a restart keeps its height */
    datum->height_m = datum->ground_m - down_m;
}

/* --------------------------------------------------------------------------------------------------------------- known -- */

/* Variance of GOE_GROUND: the error of a height is multiplied by 1/Z0; a slope counts as it is, at any range. */
static GOE_NOINLINE float variance_of(const goe_navigation_t *navigation, float height_m2, float q) {
    return goe_larger(height_m2 * q * q + goe_square(navigation->terrain_slope_sd), VARIANCE_MIN);
}

float goe_ground_variance(const goe_observation_t *obs, float inverse_range) {
    return variance_of(&obs->settings->navigation, goe_square(obs->height_sd_m), inverse_range);
}

float goe_ground_if_level(const goe_filter_t *filter, const goe_navigation_t *navigation, float variance) {
    const float height_m2 = filter->datum.taken_m2;
    const float all = variance_of(navigation, height_m2, filter->state[GOE_INVERSE_RANGE]);
    const float level = goe_larger(height_m2 * goe_square(filter->state[GOE_INVERSE_RANGE]), LEVEL_SHARE * all);
    const float more = 1.0f / level - 1.0f / all;
    return more / (1.0f + variance * more);
}

void goe_ground_start(goe_filter_t *filter, const goe_observation_t *obs) {
    filter->boxes = obs->sides->usable != 0;
    filter->datum.first_m2 = goe_square(obs->height_sd_m);
    filter->datum.taken_m2 = filter->datum.first_m2;
    filter->datum.taken_mean_m = 0.0f;
    filter->ground_scale = 1.0f;
}

/* The changes of down, which drift, move the height. Readings that scatter more than before are less informative about it. The top counts
 * from the altimeter's zero, which moves along. */
void goe_ground_drift(goe_filter_t *filter, const goe_observation_t *obs) {
    float direction[GOE_STATES] = {0.0f};
    goe_datum_t *datum = &filter->datum;
    const float walked_m2 = goe_square(obs->settings->navigation.position_walk_sd_m) * filter->due_s;
    const float more_m2 = goe_larger(goe_square(obs->height_sd_m) - datum->taken_m2,
                                     walked_m2); /* the difference would lose a small walk */
    if (!(filter->due_s > 0.0f) || !(more_m2 > 0.0f)) {
        return;
    }
    direction[GOE_GROUND] = 1.0f;
    direction[GOE_TOP] = -1.0f;
    goe_srif_spread(&filter->root, direction, GOE_GROUND, GOE_TOP,
                    filter->ground_scale * filter->state[GOE_INVERSE_RANGE] * sqrtf(more_m2));
    datum->taken_m2 += more_m2;
    datum->first_m2 = goe_larger(datum->first_m2, datum->taken_m2);
}

/* Information (1/variance) that the first height gives the state at the present 1/Z0, minus that at the 1/Z0 for which it was set. */
static float first_gained(const goe_filter_t *filter, const goe_navigation_t *navigation, float scale) {
    const float q = filter->state[GOE_INVERSE_RANGE];
    return 1.0f / variance_of(navigation, filter->datum.first_m2, q) -
           1.0f / variance_of(navigation, filter->datum.first_m2, scale * q);
}

void goe_ground_widen(goe_filter_t *filter, const goe_navigation_t *navigation) {
    if (filter->ground_scale > NARROW) {
        return;
    }
    const float scale = goe_larger(filter->ground_scale, SCALE_MIN);
    const float begun = variance_of(navigation, filter->datum.first_m2, scale * filter->state[GOE_INVERSE_RANGE]);
    const float variance = goe_filter_variance(filter, GOE_GROUND);
    const float least = variance < begun ? variance : begun;
    const float taken =
        -first_gained(filter, navigation, scale) * least; /* the excess, as a share of the present information */
    const float wider = variance < UNKNOWN ? variance : UNKNOWN;
    goe_filter_inflate(filter, GOE_GROUND, sqrtf(wider * taken / (1.0f - taken)));
    filter->ground_scale = 1.0f;
}

/* Adds the information that the first height gains when 1/Z0 becomes smaller. */
static int add_first(goe_filter_t *filter, const goe_observation_t *obs, goe_rows_t *rows) {
    if (!(filter->ground_scale >= WIDE) || rows->count >= GOE_ROWS_MAX) {
        return 0;
    }
    const float weight = sqrtf(first_gained(filter, &obs->settings->navigation, filter->ground_scale));
    float *row = rows->matrix->row[rows->count++];
    row[GOE_STATE_COLUMN + GOE_GROUND] = weight;
    row[GOE_RESIDUAL] = -weight * filter->state[GOE_GROUND];
    filter->ground_scale = 1.0f;
    return 1;
}

/* The heights so far measure the offset of the first one with the information 1/(constant error^2 + variance of their mean). The row adds
 * only the growth of this information: all heights contain the constant error, which must not count twice. */
static int add_grown(goe_filter_t *filter, const goe_observation_t *obs, goe_rows_t *rows) {
    goe_datum_t *datum = &filter->datum;
    const float q = filter->state[GOE_INVERSE_RANGE];
    const float height_m2 = goe_square(obs->height_sd_m);
    const float information = 1.0f / variance_of(&obs->settings->navigation, height_m2, q);
    const float before = 1.0f / variance_of(&obs->settings->navigation, datum->taken_m2, q);
    const float grown = information - before;
    if (rows->count >= GOE_ROWS_MAX || !(grown > GROWN * information)) {
        return 0; /* waits for more */
    }
    const float weight = sqrtf(grown);
    const float read_m = (information * datum->mean_m - before * datum->taken_mean_m) / grown;
    float *row = rows->matrix->row[rows->count++];
    row[GOE_STATE_COLUMN + GOE_GROUND] = weight;
    row[GOE_STATE_COLUMN + GOE_INVERSE_RANGE] =
        -weight * filter->state[GOE_GROUND] / q; /* instead of read_m, which is noisy */
    row[GOE_RESIDUAL] = weight * (read_m * q - filter->state[GOE_GROUND]);
    datum->taken_m2 = height_m2;
    datum->taken_mean_m = datum->mean_m;
    return 1;
}

int goe_ground_row(goe_filter_t *filter, const goe_observation_t *obs, goe_rows_t *rows) {
    if ((filter->known & GOE_HAS_POSITION) == 0u) {
        return 0;
    }
    const int first = add_first(filter, obs, rows);
    return first + add_grown(filter, obs, rows);
}

#endif
