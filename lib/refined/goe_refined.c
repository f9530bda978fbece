/* One image through the filter method. SPDX-License-Identifier: MIT
 *
 *   time -> start, change of model -> rows of the model -> gate -> square-root update -> health
 *
 * One Gauss-Newton step per image, linearized at the predicted state: in these states the image is so nearly linear that
 * linearizing older images again gains next to nothing. */
#include "refined/goe_refined.h"

#include <math.h>
#include <string.h>

#include "maths/goe_angle.h"
#include "maths/goe_exp.h"
#include "maths/goe_scalar.h"
#include "maths/goe_time.h"
#include "refined/goe_box.h"
#include "refined/goe_ellipse.h"
#include "refined/goe_ground.h"
#include "refined/goe_health.h"
#include "refined/goe_kind.h"
#include "refined/goe_model.h"
#include "refined/goe_mover.h"
#include "refined/goe_report.h"
#include "refined/goe_scatter.h"

#if GOE_WITH_FILTER

#define GAP_MAX_US 1000000000u /* a longer gap between images counts as this one */
#define TOO_SOON_SHARE 0.08f   /* of the time constant: sooner, differences of boxes are their linearization's */
#define FADE_MAX 0.95f         /* of what a box's error keeps from image to image, where it is not remembered */
#define AGREE_SIGMA 3.0f       /* within which two answers say the same */
#define KEPT_S 3.0f            /* since the new start, for which the answer before it may stand */
#define REACH_MAX_M 1.0e6f     /* as all positions */

/* --------------------------------------------------------------------------------------------------------------- time -- */

/* Along the path, which in a turn is longer than the way to where it began. */
static void fly_on(goe_filter_t *filter, const goe_motion_t *motion) {
    const float dx_m = motion->dx_m - filter->last.dx_m;
    const float dz_m = motion->dz_m - filter->last.dz_m;
    filter->flown_m += sqrtf(dx_m * dx_m + dz_m * dz_m);
    filter->last.dx_m = motion->dx_m;
    filter->last.dz_m = motion->dz_m;
#if GOE_AUGMENTED
    goe_filter_pace(filter, motion);
#endif
}

/* Whether an image comes so soon after the one before that the errors of its box are the same: it is not used. */
static bool comes_too_soon(const goe_filter_t *filter, const goe_detector_t *detector, const goe_motion_t *motion) {
    const float since_s = goe_time_between_s(filter->time_us, motion->time_us, GAP_MAX_US);
    return goe_filter_by_boxes(filter) && since_s < TOO_SOON_SHARE * detector->box_correlation_time_s;
}

/* ------------------------------------------------------------------------------------------------------------- update -- */

/* (R13): possible linearization error at an uncertain range, the second order of 1/Z. */
static void allow_for_curvature(const goe_observation_t *obs, goe_rows_t *rows) {
    const float ahead = goe_observation_ahead(obs);
    const float missed = obs->camera_m.z * obs->range_variance / ahead;
    for (size_t i = 0; i < rows->count; i++) {
        rows->variance[i] += goe_square(rows->matrix->row[i][GOE_STATE_COLUMN + GOE_INVERSE_RANGE] * missed);
    }
}

/* What the rows find less certain than the image before left it; not sooner, as without them the state stays as it is. */
static void doubt(goe_filter_t *filter, const goe_observation_t *obs) {
    goe_ground_widen(filter);
    goe_ground_drift(filter, obs);
    goe_observation_age(filter, obs);
}

/* The rows of the image, before the gate. */
static void find_rows(goe_filter_t *filter, goe_observation_t *obs, goe_rows_t *rows) {
    rows->white_rad = obs->white_rad;
    goe_model_rows(filter, obs, rows);
    goe_rows_end(rows, obs);
#if GOE_AUGMENTED
    goe_mover_columns(obs, rows);
#endif
    allow_for_curvature(obs, rows);
    goe_model_recall(filter, obs, rows);
}

static bool measure(goe_filter_t *filter, const goe_observation_t *obs, goe_rows_t *rows, goe_verdict_t *verdict,
                    float change[GOE_UNKNOWNS]) {
    *verdict = goe_gate_apply(obs->settings, filter, rows);
    goe_scatter_take(&filter->scatter, rows);
    goe_model_learn(filter, rows);
    if (verdict->rows == 0) {
        goe_health_take_refused(&filter->health, *verdict);
        return false;
    }
    filter->answer.outdated = true;
    filter->measured.dx_m = obs->camera_m.x;
    filter->measured.dz_m = obs->camera_m.z;
    doubt(filter, obs);
    verdict->rows += goe_ground_row(filter, obs, rows);
    verdict->rows += goe_kind_rows(filter, obs, rows);
    const float nis = goe_model_update(filter, 1.0f / rows->white_rad, rows, change);
    /* Variances were inflated by (1+r)/(1-r) for the correlation in time, the scatter within one image is not: undone for the
     * NIS. */
    goe_health_take(&filter->health, *verdict,
                    nis * goe_gate_repeated(filter, obs->settings->detector.point_correlation));
    return true;
}

/* -------------------------------------------------------------------------------------------------------------- image -- */

/* Points that replace the sides of a box have its errors; as they are not modeled, the variance counts
 * (1 + fade)/(1 - fade) times, which for a first-order process is that of a long mean. */
static float outline_share(const goe_detector_t *detector, float fade) {
    const float kept = fade < FADE_MAX ? fade : FADE_MAX;
    return detector->box_noise_rel * sqrtf((1.0f + kept) / (1.0f - kept));
}

/* What of a box's error is left since the image before; and what an image's own position error does, with the second order that
 * the uncertain range adds. */
static void note_time(goe_filter_t *filter, goe_observation_t *obs) {
    const goe_detector_t *detector = &obs->settings->detector;
    obs->range_variance = goe_filter_variance(filter, GOE_INVERSE_RANGE);
    const float relative2 = obs->range_variance / goe_square(filter->state[GOE_INVERSE_RANGE]);
    const bool same = filter->camera == obs->number; /* a correlation in one camera is no evidence about another */
    const bool fades = same && detector->box_correlation_time_s > 0.0f;
    obs->fade = fades ? goe_exp(-obs->since_s / detector->box_correlation_time_s) : 0.0f;
    filter->camera = obs->number;
    if (obs->sides->usable != 0) {
        obs->outline_share = outline_share(detector, obs->fade);
    }
    obs->position_sd = obs->settings->navigation.position_white_sd_m * sqrtf(1.0f + relative2);
}

/* False if the image does not start the filter. */
/*@ requires \valid(filter) && \valid_read(settings) && goe_view_is_open(view) && \valid(obs);
    requires \valid(swapped); */
static bool open_image(goe_filter_t *filter, const goe_settings_t *settings, const goe_view_t *view,
                       goe_observation_t *obs, unsigned *swapped) {
    const bool running = goe_filter_has_started(filter);
    if (!running && !goe_model_place(filter, view)) {
        return false;
    }
    *swapped = goe_observation_open(obs, settings, filter, view);
    if (!running && !goe_model_start(filter, obs)) {
        return false;
    }
    if (!running) {
        filter->time_us = view->motion->time_us;
        filter->last.dx_m = view->motion->dx_m;
        filter->last.dz_m = view->motion->dz_m;
    }
    return true;
}

/* Whether the obstacle has just been found to move. */
static bool starts_to_move(goe_filter_t *filter, const goe_observation_t *obs, const float change[GOE_UNKNOWNS]) {
#if GOE_AUGMENTED
    return goe_mover_judge(filter, obs, change, obs->since_s);
#else
    (void)filter;
    (void)obs;
    (void)change;
    return false;
#endif
}

/* What the rows bring; its locals are not on the stack while they are made. */
GOE_NOINLINE static bool use_rows(goe_filter_t *filter, const goe_observation_t *obs, goe_rows_t *rows) {
    goe_verdict_t verdict;
    float change[GOE_UNKNOWNS];
    const bool measured = measure(filter, obs, rows, &verdict, change);
    if (goe_filter_is_box(filter)) {
        goe_box_clip(filter);
    }
    const bool moves = measured && starts_to_move(filter, obs, change);
    const bool contradicts = measured && goe_kind_contradicts(filter);
    if (goe_health_judge(filter, obs->settings->model, verdict) || moves || contradicts) {
        goe_filter_enter(filter, GOE_PHASE_NONE);
        return false;
    }
    if (!measured) {
        return false;
    }
    if (goe_filter_is_box(filter)) {
        goe_box_name(filter);
    }
    return true;
}

GOE_NOINLINE static bool use_image(goe_filter_t *filter, goe_observation_t *obs) {
    goe_matrix_t matrix;
    goe_rows_t rows;
    (void)goe_count_image(&filter->phase_images);
    goe_rows_clear(&rows, &matrix);
    find_rows(filter, obs, &rows);
    return use_rows(filter, obs, &rows);
}

bool goe_refined_update(goe_filter_t *filter, const goe_settings_t *settings, const goe_view_t *view,
                        unsigned *swapped) {
    goe_observation_t obs;
    goe_health_expect(&filter->health);
    *swapped = 0;
    if (filter->phase >= GOE_PHASES) {
        goe_filter_enter(filter, GOE_PHASE_NONE); /* an unknown one: it starts again */
    }
    const float since_s = goe_time_between_s(filter->time_us, view->motion->time_us, GAP_MAX_US);
    goe_ground_read(filter, &settings->navigation, view, goe_filter_has_started(filter) ? since_s : 0.0f);
    if (comes_too_soon(filter, &settings->detector, view->motion) ||
        !open_image(filter, settings, view, &obs, swapped)) {
        return false;
    }
    obs.since_s = goe_time_between_s(filter->time_us, view->motion->time_us, GAP_MAX_US);
    fly_on(filter, view->motion);
    note_time(filter, &obs);
    goe_filter_wait(filter, obs.since_s);
    filter->time_us = view->motion->time_us;
    goe_observation_linearise(&obs);
    if (view->seen && goe_model_change(filter, &obs)) { /* an image without a feature changes nothing but the time */
        filter->answer.outdated = true;
        return false;
    }
    return use_image(filter, &obs);
}

/* ------------------------------------------------------------------------------------------------------------- answer -- */

/* Half of the visible extent about the reference point, m, also while the width is not valid; and of a footprint, the way to the middle
 * of a circle of that reach that begins where it does, T axes. */
static float reach_of(const goe_filter_t *filter, goe_xz_t *nearer_m) {
    const float *x = filter->state;
    memset(nearer_m, 0, sizeof *nearer_m);
    if (goe_filter_traits(filter)->is_ellipse) {
        goe_aspect_t aspect;
        goe_ellipse_face_camera(filter, goe_filter_measured(filter), &aspect);
        const float way_m = (aspect.before.reach - aspect.across.reach) / x[GOE_INVERSE_RANGE];
        const goe_xz_t towards = goe_filter_into_trajectory(filter, aspect.towards);
        nearer_m->x = way_m * towards.x;
        nearer_m->z = way_m * towards.z;
        return aspect.across.reach / x[GOE_INVERSE_RANGE];
    }
    return 0.5f * (x[GOE_FRONT_X] + goe_absolute(x[GOE_SIDE_X])) / x[GOE_INVERSE_RANGE];
}

/* One coordinate of the place. */
typedef struct {
    float value, sigma;
} place_t;

static bool agrees(const place_t *now, const place_t *before, float reach_m) {
    const float sigma = sqrtf(goe_square(now->sigma) + goe_square(before->sigma));
    return goe_absolute(now->value - before->value) <= AGREE_SIGMA * sigma + reach_m;
}

/* Whether the answer from before a new start of the filter is kept: the new one agrees, and is less certain. One that
 * disagrees, or that is of an obstacle that moves, takes over; after some seconds any does. */
static bool keeps_previous(const goe_filter_t *filter, const goe_motion_t *motion, const goe_quantities_t *quantities,
                           const goe_estimate_t *estimate) {
    const place_t now[2] = {{quantities->value[GOE_X0], quantities->sigma[GOE_X0]},
                            {quantities->value[GOE_Z0], quantities->sigma[GOE_Z0]}};
    const place_t before[2] = {{estimate->x0_m, estimate->sigma.x_m}, {estimate->z0_m, estimate->sigma.z_m}};
    const bool answered = (estimate->valid & GOE_HAS_POSITION) != 0u && !quantities->moves && estimate->z_m > 0.0f &&
                          goe_filter_elapsed_s(filter, motion) < KEPT_S;
    const float reach_m = filter->answer.reach_m;
    return answered && (filter->answer.previous != 0u) &&
           goe_square(now[0].sigma) + goe_square(now[1].sigma) >
               goe_square(before[0].sigma) + goe_square(before[1].sigma) &&
           agrees(&now[0], &before[0], reach_m) && agrees(&now[1], &before[1], reach_m);
}

/* Keeps what goe_hazard() needs of an answer when no new one follows. */
static void keep_answer(goe_filter_t *filter, unsigned valid) {
    goe_answer_t *answer = &filter->answer;
    goe_xz_t nearer_m;
    const float reach_m = reach_of(filter, &nearer_m);
    answer->nearer.dx_m = nearer_m.x;
    answer->nearer.dz_m = nearer_m.z;
    answer->least_m = (valid & GOE_HAS_WIDTH) != 0u ? 0.0f : answer->least_m;
    if (goe_within(reach_m, REACH_MAX_M)) {
        answer->reach_m = goe_larger(reach_m, answer->least_m);
    }
    answer->height_bias_m = filter->state[GOE_GROUND] / filter->state[GOE_INVERSE_RANGE];
    answer->outdated = false;
    answer->previous = false;
}

/* Whether a position lies behind the camera, with all of its extent, in an image that shows the obstacle ahead. */
static bool lies_behind(const goe_filter_t *filter, const goe_quantities_t *quantities, const goe_motion_t *motion) {
    goe_xz_t nearer_m;
    const float circle_m = reach_of(filter, &nearer_m);
    const float reach_m = circle_m + sqrtf(goe_xz_dot(nearer_m, nearer_m));
    return quantities->value[GOE_Z0] - motion->dz_m <
           -(reach_m + (quantities->box ? quantities->value[GOE_LENGTH] : 0.0f));
}

bool goe_refined_report(goe_filter_t *filter, const goe_settings_t *settings, const goe_motion_t *motion,
                        goe_estimate_t *estimate) {
    goe_quantities_t quantities;
    goe_quantities_find(filter, settings, motion, &quantities);
    filter->known = (uint8_t)quantities.now;
    const bool placed = (quantities.now & GOE_HAS_POSITION) != 0u; /* otherwise nothing else of them need be set */
    if (placed && lies_behind(filter, &quantities, motion)) {
        goe_filter_enter(filter, GOE_PHASE_NONE);
        return false;
    }
    if (placed && keeps_previous(filter, motion, &quantities, estimate)) {
        return false;
    }
    const bool fresh = goe_report_quantities(&quantities, motion, estimate);
    if (fresh) {
        keep_answer(filter, estimate->valid);
    }
    return fresh;
}

#endif
