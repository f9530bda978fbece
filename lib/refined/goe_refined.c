/* The filter method: the order of the steps in one image. SPDX-License-Identifier: MIT
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
#include "refined/goe_ground.h"
#include "refined/goe_growth.h"
#include "refined/goe_health.h"
#include "refined/goe_kind.h"
#include "refined/goe_model.h"
#include "refined/goe_mover.h"
#include "refined/goe_scatter.h"

#if GOE_WITH_FILTER

#define GAP_MAX_US 1000000000u /* a longer gap between images counts as this one */
#define TOO_SOON_SHARE 0.08f   /* share of the time constant: sooner, box differences are linearization errors */
#define LOST_S 0.5f            /* time without rows after which a known range does not count as known */
#define VAGUE2 4.0f   /* limit of (sigma of 1/Z0 times the way along Z)^2, which is below 1 for an obstacle ahead */
#define LATELY_S 0.5f /* after it, what another camera showed of the obstacle's ends no longer counts */
#define DOUBTED_SIGMAS2 4.0f /* squared sigmas of a growth above which nothing is clear, for DOUBTED_S */
#define DOUBTED_S 2.0f       /* s: as the errors of boxes fade in a second, the next growth may be smaller by chance */
#define NEVER_S 1.0e6f       /* longer than any correlation time */
#define FADE_MAX 0.9995f     /* largest share of a box's error kept from image to image, where points replace sides */

/* --------------------------------------------------------------------------------------------------------------- time -- */

/* Seconds to the latest image of a camera that gave rows, as of the previous image. */
static float used_s(const goe_filter_t *filter, unsigned camera) {
#if GOE_CAMERAS_MAX > 1
    return filter->used_s[camera];
#else
    (void)camera;
    return filter->due_s;
#endif
}

/* Notes that an image gave rows. */
static void note_use(goe_filter_t *filter, unsigned camera) {
#if GOE_CAMERAS_MAX > 1
    filter->used_s[camera] = 0.0f;
#else
    (void)filter;
    (void)camera;
#endif
}

/* Whether an image comes so soon after the latest one with rows of the same camera that the errors of its box are the same: it is not used.
 * Images without rows in between do not count. */
static bool comes_too_soon(const goe_filter_t *filter, const goe_detector_t *detector, const goe_view_t *view,
                           float since_s) {
    const float after_s = used_s(filter, view->image->camera) + since_s;
    return after_s < TOO_SOON_SHARE * detector->box_correlation_time_s && goe_filter_by_boxes(filter);
}

/* ------------------------------------------------------------------------------------------------------------- update -- */

/* (R13): adds the possible linearization error at an uncertain range, the second order of 1/Z. */
static void allow_for_curvature(const goe_observation_t *obs, goe_rows_t *rows) {
    const float ahead = goe_observation_ahead(obs);
    const float missed = obs->camera_m.z * obs->range_variance / ahead;
    for (size_t i = 0; i < rows->count; i++) {
        rows->variance[i] += goe_square(rows->matrix->row[i][GOE_STATE_COLUMN + GOE_INVERSE_RANGE] * missed);
    }
}

/* Adds the uncertainty since the latest rows. Only for an image with rows: without rows the state stays as it is. */
static void doubt(goe_filter_t *filter, const goe_observation_t *obs) {
    goe_ground_widen(filter, &obs->settings->navigation);
    goe_ground_drift(filter, obs);
    goe_observation_age(filter, obs);
}

/* Notes a growth in the image that contradicts the range. An image that does not show it changes nothing. */
static void note_growth(goe_answer_t *answer, float grown2, float since_s) {
    const float left_s = goe_larger(answer->outgrown_s - since_s, 0.0f);
    if (grown2 >= 0.0f) {
        answer->outgrown_s = grown2 > DOUBTED_SIGMAS2 ? DOUBTED_S : left_s;
    }
}

/* The rows of the image, before the gate. */
static void find_rows(goe_filter_t *filter, goe_observation_t *obs, goe_rows_t *rows) {
    rows->white_rad = obs->white_rad;
    goe_model_rows(filter, obs, rows);
    obs->grown2 = goe_growth_find(obs, rows);
    note_growth(&filter->answer, obs->grown2, obs->since_s);
    goe_rows_end(rows, obs);
#if GOE_AUGMENTED
    goe_mover_columns(&filter->axes, obs, rows);
#endif
    allow_for_curvature(obs, rows);
    goe_model_recall(filter, obs, rows);
}

/* Notes an image with rows. Returns the ends of the obstacle that no image shows: another camera may have shown them lately, or all of it.
 * An image without a box shows no end. */
static unsigned open_ends(goe_filter_t *filter, const goe_observation_t *obs) {
    unsigned open = obs->sides->ends;
    note_use(filter, obs->number);
    if ((obs->sides->usable | open) == 0u) {
        return filter->answer.cut;
    }
#if GOE_CAMERAS_MAX > 1
    bool whole = false;
    filter->ends[obs->number] = (uint8_t)open;
    for (size_t i = 0; i < GOE_CAMERAS_MAX; i++) {
        if (filter->used_s[i] < LATELY_S) {
            whole = whole || filter->ends[i] == 0u;
            open |= filter->ends[i];
        }
    }
    open = whole ? 0u : open;
#endif
    return open;
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
    filter->answer.cut = (uint8_t)open_ends(filter, obs);
    filter->measured.dx_m = obs->camera_m.x;
    filter->measured.dz_m = obs->camera_m.z;
    doubt(filter, obs);
    verdict->rows += goe_ground_row(filter, obs, rows);
    const float nis = goe_model_update(filter, 1.0f / rows->white_rad, rows, change);
    /* The variances were multiplied by (1+r)/(1-r) for the correlation in time. The scatter within one image does not contain it, so the
     * NIS is corrected for this factor. */
    goe_health_take(&filter->health, *verdict,
                    nis * goe_gate_repeated(filter, obs->settings->detector.point_correlation));
    return true;
}

/* -------------------------------------------------------------------------------------------------------------- image -- */

/* Points that replace the sides of a box have its errors. These are not modeled, so the variance is multiplied by (1 + fade)/(1 - fade),
 * the factor for a long mean of a first-order process. */
static float outline_share(const goe_detector_t *detector, float fade) {
    const float kept = fade < FADE_MAX ? fade : FADE_MAX;
    return detector->box_noise_rel * sqrtf((1.0f + kept) / (1.0f - kept));
}

/* Seconds over which the errors of the boxes of the image's camera fade with this image. */
static float fade_time(goe_filter_t *filter, const goe_observation_t *obs) {
#if GOE_CAMERAS_MAX > 1
    const float since_s = filter->faded_s[obs->number];
    filter->faded_s[obs->number] = 0.0f;
    return since_s;
#else
    (void)filter;
    return obs->since_s;
#endif
}

/* Sets how much of a box's error remains from the camera's previous image, and the effect of this image's position noise, including the
 * second order by the uncertain range. */
static void note_time(goe_filter_t *filter, goe_observation_t *obs) {
    const goe_detector_t *detector = &obs->settings->detector;
    obs->range_variance = goe_filter_variance(filter, GOE_INVERSE_RANGE);
    const float relative2 = obs->range_variance / goe_square(filter->state[GOE_INVERSE_RANGE]);
    const float faded_s = fade_time(filter, obs);
    obs->fade = detector->box_correlation_time_s > 0.0f ? goe_exp(-faded_s / detector->box_correlation_time_s) : 0.0f;
    if (obs->sides->usable != 0) {
        obs->outline_share = outline_share(detector, obs->fade);
    }
    obs->shift =
        obs->settings->navigation.position_white_sd_m * obs->state[GOE_INVERSE_RANGE] * sqrtf(1.0f + relative2);
    obs->white_rad = sqrtf(goe_square(obs->white_rad) + goe_square(obs->shift / goe_observation_ahead(obs)));
}

/* At the filter's start, by an image of one camera: it has used nothing of the others. */
static void meet_cameras(goe_filter_t *filter, unsigned camera) {
#if GOE_CAMERAS_MAX > 1
    for (size_t i = 0; i < GOE_CAMERAS_MAX; i++) {
        filter->used_s[i] = NEVER_S;
        filter->faded_s[i] = NEVER_S;
    }
    filter->faded_s[camera] = 0.0f;
#endif
    note_use(filter, camera);
}

/* Starts the filter if necessary. False if the image does not start it. */
/*@ requires \valid(filter) && \valid_read(settings) && goe_view_is_open(view) && \valid(obs);
    requires \valid(swapped); */
static bool open_image(goe_filter_t *filter, const goe_settings_t *settings, const goe_view_t *view,
                       goe_observation_t *obs, unsigned *swapped) {
    const bool running = goe_filter_has_started(filter);
    const bool placed = running || goe_model_place(filter, view);
    *swapped = goe_observation_open(obs, settings, filter, view); /* even if the image does not start the filter */
    if (!placed || (!running && !goe_model_start(filter, obs))) {
        return false;
    }
    if (!running) {
        filter->time_us = view->motion->time_us;
        meet_cameras(filter, obs->number);
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

/* Whether no image can correct the state: the obstacle is behind the camera and gives no rows, or its range is so uncertain that rows
 * change nothing. With a known range, a place behind the camera may be right, and the image wrong, for LOST_S at most. */
static bool is_lost(const goe_filter_t *filter, const goe_observation_t *obs) {
    const float known2 = goe_square(obs->settings->filter.range_sd_rel_max * filter->state[GOE_INVERSE_RANGE]);
    const float z = goe_observation_reference(obs).z;
    const bool passed = z < 0.0f && (obs->range_variance > known2 || filter->due_s > LOST_S);
    const bool vague = obs->range_variance * goe_square(obs->camera_m.z) > VAGUE2;
    return goe_filter_has_started(filter) && (passed || vague);
}

/* Uses the rows. Its locals must not be on the stack while the rows are computed. */
GOE_NOINLINE static bool use_rows(goe_filter_t *filter, const goe_observation_t *obs, goe_rows_t *rows) {
    goe_verdict_t verdict;
    float change[GOE_UNKNOWNS];
    const bool measured = measure(filter, obs, rows, &verdict, change);
    if (goe_filter_is_box(filter)) {
        goe_box_clip(filter);
    }
    const bool moves = measured && starts_to_move(filter, obs, change);
    if (measured) {
        goe_kind_test(filter, obs);
    }
    if (goe_health_judge(filter, obs->settings->model, verdict) || moves) {
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
        goe_filter_enter(filter, GOE_PHASE_NONE); /* an invalid phase: the filter restarts */
    }
    const float since_s = goe_time_between_s(filter->time_us, view->motion->time_us, GAP_MAX_US);
    const bool too_soon = comes_too_soon(filter, &settings->detector, view, since_s);
    goe_ground_read(filter, &settings->navigation, view, goe_filter_has_started(filter) && !too_soon ? since_s : 0.0f);
    filter->answer.cut |= view->sides.ends; /* an image that gives no rows takes none away */
    if (too_soon || !open_image(filter, settings, view, &obs, swapped)) {
        return false;
    }
    obs.since_s = goe_time_between_s(filter->time_us, view->motion->time_us, GAP_MAX_US);
#if GOE_AUGMENTED
    goe_filter_pace(filter, view->motion);
#endif
    goe_filter_wait(filter, obs.since_s);
    note_time(filter, &obs);
    filter->time_us = view->motion->time_us;
    goe_observation_linearise(&obs);
    if (view->seen && goe_model_change(filter, &obs)) { /* an image without a feature changes nothing but the time */
        filter->answer.outdated = true;
        note_use(filter, obs.number);
        return false;
    }
    const bool used = use_image(filter, &obs);
    if (view->seen && is_lost(filter, &obs)) {
        goe_kind_start_farther(filter);
    }
    return used;
}

#endif
