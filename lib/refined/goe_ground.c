/* The camera's height above the obstacle's ground. SPDX-License-Identifier: MIT */
#include "refined/goe_ground.h"

#include <math.h>

#include "maths/goe_scalar.h"

#if GOE_WITH_FILTER

#define UNKNOWN_SD_M 1.0e3f /* of a height that was not set */
#define GROWN 1.0e-3f       /* of the information of the heights: less waits for more */
#define NARROW 0.95f        /* of ground_scale: information too strong */
#define WIDE 1.05f          /* ... not well enough */
#define SCALE_MIN 0.05f     /* a smaller one counts as this */

/* ----------------------------------------------------------------------------------------------------------- readings -- */

/* Down in the camera's axes is a row of camera -> T, as T is level. */
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

/* Before the filter starts the ground is where the mean of the heights puts it. */
static void average(goe_datum_t *datum, bool started, float down_m, float height_m) {
    const float off_m = height_m + down_m - datum->ground_m;
    datum->readings = (uint16_t)(datum->readings < UINT16_MAX ? datum->readings + 1 : UINT16_MAX);
    datum->mean_m += (off_m - datum->mean_m) / (float)datum->readings;
    if (!started) {
        datum->ground_m += datum->mean_m;
        datum->mean_m = 0.0f;
    }
}

void goe_ground_read(goe_filter_t *filter, const goe_navigation_t *navigation, const goe_view_t *view) {
    goe_datum_t *datum = &filter->datum;
    const bool white = navigation->height_white_sd_m > 0.0f;
    if (!white && view->image->box.sides == 0 && !filter->has_datum) {
        return; /* points alone take each image's height as it is */
    }
    const float down_m = camera_down_m(view);
    const bool lacks_height = goe_ground_lacks_height(view->image);
    if (!filter->has_datum) {
        datum->ground_m = view->motion->height_m + down_m;
        datum->sd_m = lacks_height ? UNKNOWN_SD_M : view->image->noise.height_sd_m;
        filter->has_datum = true;
    }
    if (white && !lacks_height) {
        average(datum, goe_filter_has_started(filter), down_m, view->motion->height_m);
    }
    datum->height_m = datum->ground_m - down_m;
}

/* --------------------------------------------------------------------------------------------------------------- known -- */

void goe_ground_start(goe_filter_t *filter, const goe_observation_t *obs) {
    filter->datum.boxes = obs->sides->usable != 0;
    filter->datum.first = 1.0f / goe_observation_height_variance(obs, filter->datum.boxes);
    filter->datum.information = filter->datum.first;
    filter->datum.moment = 0.0f;
    filter->ground_scale = 1.0f;
    filter->flown_m = 0.0f;
    filter->sloped_m = 0.0f;
}

void goe_ground_meet_box(goe_filter_t *filter, const goe_navigation_t *navigation) {
    const float sigma = navigation->terrain_height_sd_m * filter->state[GOE_INVERSE_RANGE];
    if (filter->datum.boxes) {
        return;
    }
    filter->datum.boxes = true;
    if (sigma > 0.0f) {
        goe_filter_inflate(filter, GOE_GROUND, sigma);
    }
}

/* The ground below the altimeter rises or falls, one does not know which: after a way d the height is off by slope d more,
 * and its variance has grown by the difference of the squares. The top counts from the altimeter's zero, which moves
 * along. */
void goe_ground_climb(goe_filter_t *filter, const goe_navigation_t *navigation) {
    float direction[GOE_STATES] = {0.0f};
    const float grown2 = goe_square(filter->flown_m) - goe_square(filter->sloped_m);
    const float sigma =
        navigation->terrain_slope_sd * filter->state[GOE_INVERSE_RANGE] * sqrtf(goe_larger(grown2, 0.0f));
    if (!(sigma > 0.0f) || goe_ground_is_steady(filter, navigation)) {
        return;
    }
    direction[GOE_GROUND] = 1.0f;
    direction[GOE_TOP] = -1.0f;
    goe_srif_spread(&filter->root, direction, GOE_GROUND, GOE_TOP, sigma);
    filter->sloped_m = filter->flown_m;
}

void goe_ground_widen(goe_filter_t *filter) {
    const float scale2 = goe_square(goe_larger(filter->ground_scale, SCALE_MIN));
    if (goe_filter_by_boxes(filter) || filter->ground_scale > NARROW) {
        return;
    }
    const float information = filter->datum.first / goe_square(filter->state[GOE_INVERSE_RANGE]);
    const float variance = goe_filter_variance(filter, GOE_GROUND);
    const float share = variance * (1.0f / scale2 - 1.0f) * information; /* of its own, which was not there */
    const float most = 1.0f - scale2;
    const float taken = share < most ? share : most;
    goe_filter_inflate(filter, GOE_GROUND, sqrtf(variance * taken / (1.0f - taken)));
    filter->ground_scale = 1.0f;
}

/* Of the first height. */
static int add_first(goe_filter_t *filter, goe_rows_t *rows) {
    const float scale = filter->ground_scale;
    if (goe_filter_by_boxes(filter) || !(scale >= WIDE) || rows->count >= GOE_ROWS_MAX) {
        return 0;
    }
    const float weight =
        sqrtf((1.0f - 1.0f / goe_square(scale)) * filter->datum.first) / filter->state[GOE_INVERSE_RANGE];
    float *row = rows->matrix->row[rows->count++];
    row[GOE_STATE_COLUMN + GOE_GROUND] = weight;
    row[GOE_RESIDUAL] = -weight * filter->state[GOE_GROUND];
    filter->ground_scale = 1.0f;
    return 1;
}

/* All heights so far give the offset of the first with the information 1/(constant error^2 + white^2/n). A row adds
 * only its growth; the constant error is in all of them, and is not counted twice. */
static int add_grown(goe_filter_t *filter, const goe_observation_t *obs, goe_rows_t *rows) {
    goe_datum_t *datum = &filter->datum;
    const float q = filter->state[GOE_INVERSE_RANGE];
    const float information = 1.0f / goe_observation_height_variance(obs, filter->datum.boxes);
    const float grown = information - datum->information;
    const float moment = information * datum->mean_m;
    if (rows->count >= GOE_ROWS_MAX || !(grown > GROWN * information)) {
        return 0; /* later */
    }
    const float weight = sqrtf(grown);
    const float offset_m = filter->state[GOE_GROUND] / q;
    float *row = rows->matrix->row[rows->count++];
    row[GOE_STATE_COLUMN + GOE_GROUND] = weight / q;
    row[GOE_STATE_COLUMN + GOE_INVERSE_RANGE] = -weight * offset_m / q;
    row[GOE_RESIDUAL] = weight * ((moment - datum->moment) / grown - offset_m);
    datum->information = information;
    datum->moment = moment;
    return 1;
}

int goe_ground_row(goe_filter_t *filter, const goe_observation_t *obs, goe_rows_t *rows) {
    const bool white = obs->settings->navigation.height_white_sd_m > 0.0f;
    if ((filter->known & GOE_HAS_POSITION) == 0u) {
        return 0;
    }
    const int first = add_first(filter, rows);
    return first + (white ? add_grown(filter, obs, rows) : 0);
}

#endif
