/* The estimator: one image through the whole chain. SPDX-License-Identifier: MIT
 *
 *   image -> intake -> ego motion -> aligned points -> paper ---------> estimate
 *                                                  \-> refined -> answer -/
 */
#include <string.h>

#include "goe.h"
#include "goe_settings.h"
#include "goe_told.h"
#include "image/goe_align.h"
#include "image/goe_camera.h"
#include "image/goe_ego_motion.h"
#include "image/goe_fault.h"
#include "image/goe_intake.h"
#include "maths/goe_angle.h"
#include "refined/goe_answer.h"
#include "refined/goe_refined.h"
#include "window/goe_window.h"

#define RESETS 0 /* causes[0] counts tracks that an unknown filter reset ended */
#define AGE_LIMIT_US 4000000000u
#define S_PER_US 1.0e-6f

/* --------------------------------------------------------------------------------------------------------- the answer -- */

static void tell_age(const goe_estimator_t *estimator, int64_t time_us, goe_estimate_t *estimate) {
    estimate->age_s = 0.0f;
    if (estimate->fresh || !(estimate->valid & GOE_HAS_POSITION)) {
        return;
    }
    const int64_t then_us = goe_is_refined(estimator) ? estimator->told_time_us : estimator->solved_time_us;
    const uint64_t age_us = (uint64_t)time_us - (uint64_t)then_us;
    const uint32_t told_us = age_us < AGE_LIMIT_US ? (uint32_t)age_us : AGE_LIMIT_US;
    estimate->age_s = (float)told_us * S_PER_US;
}

/* No new answer: the last one grows old, and follows the motion. */
static void grow_old(goe_estimator_t *estimator) {
    goe_estimate_t *estimate = &estimator->told;
    estimate->fresh = false;
    if (estimate->valid & GOE_HAS_POSITION) {
        estimate->x_m = estimate->x0_m - estimator->dx_m;
        estimate->z_m = estimate->z0_m - estimator->dz_m;
    }
}

/* A filter that has not started, or has only a disc where a box was asked for, leaves the answer to the window; a stale
 * answer of its own is worth more than none, or than a stale one of the window's. */
static goe_status_t tell_window(goe_estimator_t *estimator, goe_status_t status) {
    if (estimator->estimate.fresh || estimator->told.method != GOE_METHOD_REFINED ||
        !(estimator->told.valid & GOE_HAS_POSITION)) {
        estimator->told = estimator->estimate;
        estimator->told_time_us = estimator->solved_time_us;
        return status;
    }
    grow_old(estimator);
    goe_answer_residuals(estimator, &estimator->told);
    return status == GOE_COLLECTING ? GOE_HELD : status;
}

static goe_status_t tell_refined(goe_estimator_t *estimator, const goe_image_t *image, const goe_faults_t *faults,
                                 bool measured) {
    const bool fresh = measured && goe_answer_tell(estimator, &estimator->told);
    if (fresh) {
        estimator->told_time_us = estimator->time_us;
    } else {
        grow_old(estimator);
    }
    goe_answer_residuals(estimator, &estimator->told);
    if (fresh) {
        return faults->first == GOE_OK ? GOE_OK : GOE_PARTIAL;
    }
    if (faults->first != GOE_OK) {
        return faults->first;
    }
    if (!goe_image_seen(image)) {
        return GOE_NOTHING_SEEN;
    }
    return (estimator->told.valid & GOE_HAS_POSITION) ? GOE_HELD : GOE_COLLECTING;
}

/* --------------------------------------------------------------------------------------------------------- the chain -- */

static void forget_track(goe_estimator_t *estimator) {
    goe_estimator_t *e = estimator;
    e->started = false;
    memset(&e->disc, 0, sizeof e->disc);
    memset(&e->line, 0, sizeof e->line);
    memset(&e->length, 0, sizeof e->length);
    memset(&e->height, 0, sizeof e->height);
    memset(&e->orientation, 0, sizeof e->orientation);
    memset(&e->estimate, 0, sizeof e->estimate);
    memset(&e->filter, 0, sizeof e->filter);
    e->filter.turn_cos = 1.0f;
    memset(&e->told, 0, sizeof e->told);
    e->dx_m = 0.0f;
    e->dz_m = 0.0f;
    e->time_us = GOE_TIME_UNKNOWN;
    e->start_time_us = GOE_TIME_UNKNOWN;
    e->solved_time_us = GOE_TIME_UNKNOWN;
    e->told_time_us = GOE_TIME_UNKNOWN;
}

static goe_status_t estimate_refined(goe_estimator_t *estimator, const goe_image_t *image, goe_view_t *view,
                                     const float camera_to_trajectory[9], goe_faults_t *faults) {
    unsigned swapped;
    const goe_phase_t least = estimator->settings.model == GOE_MODEL_LINE ? GOE_PHASE_BOX : GOE_PHASE_DISC;
    const goe_window_task_t task =
        (goe_phase_t)estimator->filter.phase < least ? GOE_WINDOW_SOLVES : GOE_WINDOW_COLLECTS;
    const goe_status_t status = goe_window_update(estimator, image, view, task, faults);
    const bool measured = goe_refined_update(estimator, camera_to_trajectory, view, &swapped);
    for (unsigned i = 0; i < swapped && task == GOE_WINDOW_COLLECTS;
         i++) { /* otherwise the paper's method has counted */
        goe_count_cause(estimator->causes, GOE_SWAPPED);
    }
    if (swapped > 0 && faults->first == GOE_OK) {
        faults->first = GOE_SWAPPED;
    }
    const goe_status_t told = (goe_phase_t)estimator->filter.phase < least
                                  ? tell_window(estimator, status)
                                  : tell_refined(estimator, image, faults, measured);
    estimator->told.suspect = estimator->told.suspect || estimator->filter.base_refused;
    return told;
}

/* North and east of an older answer are those of the autopilot's filter before its reset. */
static void move_center(goe_estimate_t *estimate, const float delta_ned_m[3]) {
    if (estimate->valid & GOE_HAS_CENTER) {
        estimate->center_north_m += delta_ned_m[0];
        estimate->center_east_m += delta_ned_m[1];
    }
}

static goe_status_t take_image(goe_estimator_t *estimator, const goe_image_t *image) {
    float camera_to_trajectory[9];
    goe_view_t view;
    goe_faults_t faults = {estimator->causes, GOE_OK};
    if (goe_ego_motion_lost(estimator, &image->pose)) {
        forget_track(estimator);
        estimator->causes[RESETS] += estimator->causes[RESETS] < UINT32_MAX ? 1u : 0u;
    }
    if (goe_is_refined(estimator) && goe_ego_motion_reset(estimator, &image->pose)) {
        move_center(&estimator->told, image->pose.reset_delta_ned_m);
    }
    goe_ego_motion_follow(estimator, &image->pose, camera_to_trajectory);
    goe_align_view(&estimator->settings.camera, camera_to_trajectory, image, &view, &faults);
    if (!goe_is_refined(estimator)) {
        const goe_status_t status = goe_window_update(estimator, image, &view, GOE_WINDOW_SOLVES, &faults);
        tell_age(estimator, estimator->time_us, &estimator->estimate);
        return status;
    }
    const goe_status_t status = estimate_refined(estimator, image, &view, camera_to_trajectory, &faults);
    tell_age(estimator, estimator->time_us, &estimator->told);
    return status;
}

/* ------------------------------------------------------------------------------------------------------- public calls -- */

goe_status_t goe_init(goe_estimator_t *estimator, size_t estimator_size, const goe_settings_t *settings,
                      const char **bad_field) {
    if (bad_field) {
        *bad_field = NULL;
    }
    if (!estimator || !settings || estimator_size != sizeof *estimator) {
        return GOE_BAD_ARGUMENT;
    }
    const char *bad = goe_settings_first_bad(settings);
    if (bad) {
        if (bad_field) {
            *bad_field = bad;
        }
        return GOE_BAD_SETTINGS;
    }
    memset(estimator, 0, sizeof *estimator);
    estimator->settings = *settings;
    goe_camera_mounting(&settings->camera, estimator->camera_to_body);
    forget_track(estimator);
    estimator->ready = GOE_READY;
    return GOE_OK;
}

goe_status_t goe_update(goe_estimator_t *estimator, const goe_image_t *image, goe_estimate_t *estimate) {
    if (!estimate) {
        return GOE_BAD_ARGUMENT;
    }
    if (!estimator || !image || estimator->ready != GOE_READY) {
        memset(estimate, 0, sizeof *estimate);
        return !estimator || !image ? GOE_BAD_ARGUMENT : GOE_NOT_INITIALISED;
    }
    goe_status_t status = goe_intake_check(estimator, image);
    if (status == GOE_OK) {
        status = take_image(estimator, image);
        *estimate = *goe_told(estimator);
        return status;
    }
    goe_count_cause(estimator->causes, status);
    *estimate = *goe_told(estimator);
    estimate->fresh = false;
    /* the estimate grows old while images are refused, too, as far as their times can be believed */
    tell_age(estimator, image->pose.time_us > estimator->time_us ? image->pose.time_us : estimator->time_us, estimate);
    return status;
}

goe_status_t goe_reset(goe_estimator_t *estimator) {
    if (!estimator) {
        return GOE_BAD_ARGUMENT;
    }
    if (estimator->ready != GOE_READY) {
        return GOE_NOT_INITIALISED;
    }
    forget_track(estimator);
    return GOE_OK;
}

/* ------------------------------------------------------------------------------------------------------- covariance -- */

static const unsigned bit_of[GOE_QUANTITIES] = {GOE_HAS_POSITION, GOE_HAS_POSITION, GOE_HAS_ORIENTATION,
                                                GOE_HAS_WIDTH,    GOE_HAS_LENGTH,   GOE_HAS_HEIGHT};

static void covariance_of_sigmas(const goe_sigma_t *sigma, float covariance[GOE_QUANTITIES][GOE_QUANTITIES]) {
    const float of[GOE_QUANTITIES] = {sigma->x0_m,    sigma->z0_m,     sigma->orientation_deg,
                                      sigma->width_m, sigma->length_m, sigma->height_m};
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        covariance[i][i] = of[i] * of[i];
    }
}

static void keep_valid(unsigned valid, float covariance[GOE_QUANTITIES][GOE_QUANTITIES]) {
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        for (int j = 0; j < GOE_QUANTITIES; j++) {
            const float scale =
                (i == GOE_ORIENTATION ? GOE_DEG_PER_RAD : 1.0f) * (j == GOE_ORIENTATION ? GOE_DEG_PER_RAD : 1.0f);
            const bool known = (valid & bit_of[i]) && (valid & bit_of[j]);
            covariance[i][j] = known ? covariance[i][j] * scale : 0.0f;
        }
    }
}

void goe_told_covariance(const goe_estimator_t *estimator, goe_zero_t zero,
                         float covariance[GOE_QUANTITIES][GOE_QUANTITIES]) {
    const goe_estimate_t *estimate = goe_told(estimator);
    memset(covariance, 0, sizeof(float) * GOE_QUANTITIES * GOE_QUANTITIES);
    if (estimate->method == GOE_METHOD_REFINED && estimate->fresh) {
        goe_answer_covariance(estimator, zero, covariance);
        keep_valid(estimate->valid, covariance);
    } else {
        covariance_of_sigmas(&estimate->sigma, covariance);
    }
}

goe_status_t goe_covariance(const goe_estimator_t *estimator, float covariance[GOE_QUANTITIES][GOE_QUANTITIES]) {
    if (!covariance) {
        return GOE_BAD_ARGUMENT;
    }
    memset(covariance, 0, sizeof(float) * GOE_QUANTITIES * GOE_QUANTITIES);
    if (!estimator || estimator->ready != GOE_READY) {
        return estimator ? GOE_NOT_INITIALISED : GOE_BAD_ARGUMENT;
    }
    if (!(goe_told(estimator)->valid & GOE_HAS_POSITION)) {
        return GOE_COLLECTING;
    }
    goe_told_covariance(estimator, GOE_FROM_GROUND, covariance);
    return GOE_OK;
}
