/* goe_init(), goe_update(), goe_reset(): they pass one image through the processing chain. SPDX-License-Identifier: MIT
 *
 *   image -> intake -> ego motion -> aligned points -> window -----------------> estimate
 *                                                  \-> filter -> quantities -/
 */
#include <math.h>
#include <string.h>

#include "goe_guard.h"
#include "goe_latest.h"
#include "goe_settings_internal.h"
#include "image/goe_align.h"
#include "image/goe_camera.h"
#include "image/goe_ego_motion.h"
#include "image/goe_intake.h"
#include "maths/goe_scalar.h"
#include "refined/goe_answer.h"
#include "refined/goe_ground.h"
#include "refined/goe_refined.h"
#include "refined/goe_report.h"
#include "window/goe_window.h"

#define RESETS GOE_OK /* fault_counts[0] counts resets of unknown size and jumps without a reset */
#define SURE_SIGMA 2.0f
#define LOOKS_AHEAD 0.7f           /* cosine: a camera that looks within 45 degrees of Z of T sees nothing behind */
#define REFUSED_MAX_US 1000000000u /* 1000 s, the range of goe_intent_t.since_image_s */
#define ASIDE_MIN 1.7320508f       /* tangent of 60 degrees */
#define STEP_BITS 17u              /* 2^17 us, 1/8 s, in which goe_motion_t.detected counts time */
#define UNANSWERED_STEPS 12        /* without a detection, after which one that gave no estimate no longer counts */

/* ------------------------------------------------------------------------------------------------------- the estimate -- */

/* Every call copies an estimate. On ARM, two instructions copy four words; memcpy() does not know that they are aligned, and takes twice as
 * long. */
#if defined(__GNUC__)
#define BLOCK_BYTES 32u
#define ESTIMATE_BLOCKS (sizeof(goe_estimate_t) / BLOCK_BYTES)

typedef struct __attribute__((may_alias)) {
    uint32_t word[BLOCK_BYTES / 4u];
} block_t;

static inline void copy_estimate(goe_estimate_t *to, const goe_estimate_t *from) {
    block_t *t = (block_t *)to;
    const block_t *f = (const block_t *)from;
    const size_t copied = ESTIMATE_BLOCKS * BLOCK_BYTES;
    for (size_t i = 0; i < ESTIMATE_BLOCKS; i++) {
        t[i] = f[i];
    }
    memcpy((unsigned char *)to + copied, (const unsigned char *)from + copied, sizeof *to - copied);
}
#else
static inline void copy_estimate(goe_estimate_t *to, const goe_estimate_t *from) { *to = *from; }
#endif

/* The estimate also ages while images are refused. Their times count only if they are later than the latest image. */
static void set_age(const goe_estimator_t *estimator, int64_t image_us, goe_estimate_t *estimate) {
    const int64_t latest_us = estimator->motion.time_us;
    const int64_t now_us = image_us > latest_us ? image_us : latest_us;
    const bool placed = (estimate->valid & GOE_HAS_POSITION) != 0u;
    estimate->age_s = placed ? goe_latest_since_s(estimator, now_us) : 0.0f;
}

/* Fields that every output contains, also after a refused image. */
static void complete(const goe_estimator_t *estimator, int64_t image_us, goe_estimate_t *estimate) {
    set_age(estimator, image_us, estimate);
    estimate->trajectory_heading_deg = goe_motion_heading_deg(&estimator->motion);
    if (estimate->valid & GOE_HAS_ORIENTATION) {
        goe_motion_turn(&estimator->motion, estimate->length_axis, estimate->length_axis_ne);
        estimate->width_axis_ne[0] = -estimate->length_axis_ne[1]; /* to the right of it */
        estimate->width_axis_ne[1] = estimate->length_axis_ne[0];
    }
}

static void forget_track(goe_estimator_t *estimator) {
    memset(&estimator->motion, 0, sizeof estimator->motion);
    estimator->motion.time_us = GOE_TIME_UNKNOWN;
    memset(&estimator->estimate, 0, sizeof estimator->estimate);
    estimator->estimate_time_us = GOE_TIME_UNKNOWN;
#if GOE_WITH_WINDOW
    goe_window_clear(&estimator->window);
#endif
#if GOE_WITH_FILTER
    if (goe_uses_filter(estimator)) { /* the window method uses no filter, and must not spend time on it */
        goe_filter_clear(&estimator->filter);
    }
#endif
}

/* ------------------------------------------------------------------------------------------------------------- filter -- */

#if GOE_WITH_FILTER
/* No new estimate: the last one ages, and its position relative to the camera follows the motion. */
static void grow_old(goe_estimator_t *estimator) {
    goe_estimate_t *estimate = &estimator->estimate;
    const goe_motion_t *motion = &estimator->motion;
    estimate->fresh = false;
    if (!(estimate->valid & GOE_HAS_POSITION)) {
        return;
    }
    goe_motion_relate(motion, estimate);
    const float s = goe_latest_since_s(estimator, motion->time_us);
    const float grown_m2 = goe_latest_grown_m2(estimator, s);
    const float north_m = estimate->velocity_north_m_s * s; /* 0 for a static obstacle */
    const float east_m = estimate->velocity_east_m_s * s;
    estimate->x_m += motion->heading_cos * east_m - motion->heading_sin * north_m;
    estimate->z_m += motion->heading_cos * north_m + motion->heading_sin * east_m;
    estimate->sigma.x_m = sqrtf(goe_square(estimate->sigma.x0_m) + grown_m2);
    estimate->sigma.z_m = sqrtf(goe_square(estimate->sigma.z0_m) + grown_m2);
}

/* Drops an old estimate whose whole extent lies behind the camera, while the image shows the obstacle ahead: it is wrong. */
/*@ requires \valid(estimator) && \valid_read(view); */
static void drop_contradicted(goe_estimator_t *estimator, const goe_view_t *view) {
    goe_estimate_t *estimate = &estimator->estimate;
    const float reach_m = goe_larger(estimator->filter.answer.reach_m, 0.5f * estimate->width_m) + estimate->length_m;
    bool ahead = view->seen && view->camera_to_trajectory[8] > LOOKS_AHEAD;
    for (size_t i = 0; i < GOE_FEATURES; i++) {
        ahead = ahead || view->point[i].usable;
    }
    if (ahead && estimate->z_m < -reach_m - SURE_SIGMA * estimate->sigma.z_m) { /* 0 without a position */
        memset(estimate, 0, sizeof *estimate);
    }
}

static goe_status_t report_refined(goe_estimator_t *estimator, const goe_view_t *view, const goe_faults_t *faults,
                                   bool measured) {
    const bool fresh = measured && goe_answer_update(&estimator->filter, &estimator->settings, &estimator->motion,
                                                     &estimator->estimate);
    if (fresh) {
        estimator->estimate_time_us = estimator->motion.time_us;
    } else {
        grow_old(estimator);
        drop_contradicted(estimator, view);
    }
    goe_report_fit(&estimator->filter, &estimator->settings, &estimator->estimate);
    if (fresh) {
        return faults->first == GOE_OK ? GOE_OK : GOE_PARTIAL;
    }
    if (faults->first != GOE_OK) {
        return faults->first;
    }
    if (!view->seen) {
        return GOE_NO_DETECTION;
    }
    return (estimator->estimate.valid & GOE_HAS_POSITION) ? GOE_STALE : GOE_CONVERGING;
}

static goe_status_t update_refined(goe_estimator_t *estimator, const goe_view_t *view, goe_faults_t *faults) {
    const goe_settings_t *settings = &estimator->settings;
    unsigned swapped;
    const bool measured = goe_refined_update(&estimator->filter, settings, view, &swapped);
    for (unsigned i = 0; i < swapped; i++) { /* each pair of points that is out of order counts */
        goe_fault_count(faults, GOE_SWAPPED);
    }
    return report_refined(estimator, view, faults, measured && goe_filter_reports(&estimator->filter, settings->model));
}

static goe_status_t take_refined(goe_estimator_t *estimator, const goe_view_t *view, goe_faults_t *faults) {
    if (view->seen && goe_ground_lacks_height(view)) {
        goe_fault_count(faults, GOE_NO_HEIGHT);
    }
    return update_refined(estimator, view, faults);
}
#endif

/* --------------------------------------------------------------------------------------------------------- the chain -- */

/* The autopilot's filter jumped: a known jump moves the ground along, an unknown one ends the track. */
static void follow_reset(goe_estimator_t *estimator, const goe_pose_t *pose) {
    if (!goe_is_set(&pose->reset_delta_known)) {
        forget_track(estimator);
        goe_count_cause(estimator->fault_counts, RESETS);
        return;
    }
#if GOE_WITH_FILTER
    if (goe_uses_filter(estimator)) {
        goe_ground_move(&estimator->filter, pose->reset_delta_ned_m[2]);
    }
#endif
}

/* North and east of an older estimate move with T's origin, and on with a moving obstacle. Their errors may all add up. */
static void follow_motion(goe_estimator_t *estimator, goe_view_t *view) {
    goe_estimate_t *estimate = &estimator->estimate;
    const int64_t before_us = estimator->motion.time_us;
    const float north_m = estimator->motion.origin_ne_m[0];
    const float east_m = estimator->motion.origin_ne_m[1];
    if (goe_motion_follow(&estimator->motion, &estimator->settings, view)) {
        goe_count_cause(estimator->fault_counts, RESETS);
    }
    if (estimate->valid & GOE_HAS_CENTER) {
        const float s = goe_time_between_s(before_us, estimator->motion.time_us, GOE_TIME_MAX_US);
        estimate->center_north_m += estimator->motion.origin_ne_m[0] - north_m + estimate->velocity_north_m_s * s;
        estimate->center_east_m += estimator->motion.origin_ne_m[1] - east_m + estimate->velocity_east_m_s * s;
        estimate->sigma.center_north_m += estimate->sigma.velocity_north_m_s * s; /* 0 for a static obstacle */
        estimate->sigma.center_east_m += estimate->sigma.velocity_east_m_s * s;
    }
}

/* Whether a new track may begin: an earlier image showed a feature, T's heading is that of the nose, no position is known, and the nose has
 * turned by more than 45 degrees from Z. */
static bool may_begin_again(const goe_estimator_t *estimator, const goe_view_t *view) {
    const float *to_trajectory = view->camera_to_trajectory;
    const float *nose = view->camera_to_body; /* its first row: the nose's direction, camera axes */
    const float x = to_trajectory[0] * nose[0] + to_trajectory[1] * nose[1] + to_trajectory[2] * nose[2];
    const float z = to_trajectory[6] * nose[0] + to_trajectory[7] * nose[1] + to_trajectory[8] * nose[2];
    const bool known = (estimator->estimate.valid & GOE_HAS_POSITION) != 0u;
    return goe_is_set(&estimator->settings.heading_auto) && estimator->motion.detected && !known && goe_absolute(x) > z;
}

/* Whether features are visible, and all of them are more than 60 degrees from Z. */
/*@ requires \valid_read(view); */
static bool lies_aside(const goe_view_t *view) {
    bool aside = view->seen;
    for (size_t i = 0; i < GOE_FEATURES; i++) {
        aside = aside && !(view->point[i].usable && goe_within(view->point[i].x, ASIDE_MIN));
    }
    return aside;
}

/* After a turn, features far from T's Z axis give little information, and a track without a known position has nothing to lose: a new track
 * begins with this image. The faults of this image are counted only once. */
static GOE_NOINLINE void align_after_turn(goe_estimator_t *estimator, goe_view_t *view, goe_faults_t *faults) {
    uint32_t fault_counts[GOE_FAULT_COUNTS];
    memcpy(fault_counts, faults->fault_counts, sizeof fault_counts);
    goe_align_points(view->camera, view, faults);
    if (lies_aside(view)) {
        memcpy(faults->fault_counts, fault_counts, sizeof fault_counts);
        faults->first = GOE_OK;
        forget_track(estimator);
        (void)goe_motion_follow(&estimator->motion, &estimator->settings, view);
        goe_align_points(view->camera, view, faults);
    }
}

/*@ requires \valid(estimator) && \valid_read(image) && \valid_read(camera) && \valid(view);
    requires goe_faults_are_open(faults); */
static void open_view(goe_estimator_t *estimator, const goe_image_t *image, const goe_camera_t *camera,
                      goe_view_t *view, goe_faults_t *faults) {
    view->image = image;
    view->motion = &estimator->motion;
    view->camera = camera;
    view->box_noise_rel = estimator->settings.detector.box_noise_rel;
    view->camera_to_body = estimator->camera_to_body[image->camera];
    follow_motion(estimator, view);
    if (may_begin_again(estimator, view)) {
        align_after_turn(estimator, view, faults);
    } else {
        goe_align_points(camera, view, faults);
    }
}

static uint32_t step_of(int64_t time_us) { return (uint32_t)((uint64_t)time_us >> STEP_BITS); }

/* Remembers for some time that a detection gave no new estimate. The next estimate ends this. before_us: the previous image. */
static void note_detection(goe_estimator_t *estimator, bool detected, int64_t before_us) {
    goe_motion_t *motion = &estimator->motion;
    if (detected) {
        motion->detected = goe_is_set(&estimator->estimate.fresh) ? 1u : 1u + UNANSWERED_STEPS;
    } else if (motion->detected > 1u) { /* whole steps since time 0, so that none is lost between images */
        const uint32_t steps = step_of(motion->time_us) - step_of(before_us);
        motion->detected = steps < motion->detected ? (uint8_t)(motion->detected - steps) : 1u;
    }
}

static goe_status_t estimate_view(goe_estimator_t *estimator, const goe_view_t *view, goe_faults_t *faults) {
#if GOE_WITH_FILTER
    if (goe_uses_filter(estimator)) {
        return take_refined(estimator, view, faults);
    }
#endif
#if GOE_WITH_WINDOW
    const goe_status_t status =
        goe_window_update(&estimator->window, &estimator->settings, view, faults, &estimator->estimate);
    if (estimator->estimate.fresh) {
        estimator->estimate_time_us = estimator->motion.time_us;
    }
    return status;
#else
    return GOE_CONVERGING; /* not reached: goe_init() admits no other method */
#endif
}

static goe_status_t take_image(goe_estimator_t *estimator, const goe_image_t *image, const goe_camera_t *camera) {
    goe_view_t view;
    goe_faults_t faults = {estimator->fault_counts, GOE_OK};
    const int64_t before_us = estimator->motion.time_us;
    estimator->estimate.age_s = 0.0f;
    if (goe_motion_reset(&estimator->motion, &image->pose)) {
        follow_reset(estimator, &image->pose);
    }
    open_view(estimator, image, camera, &view, &faults);
    const goe_status_t status = estimate_view(estimator, &view, &faults);
    note_detection(estimator, view.seen, before_us);
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
    goe_settings_copy(&estimator->settings, settings);
    for (unsigned i = 0; i < GOE_CAMERAS_MAX; i++) {
        const goe_camera_t *camera = goe_camera_of(settings, i);
        if (camera) {
            goe_camera_mounting(camera, estimator->camera_to_body[i]);
        }
    }
    forget_track(estimator);
    goe_guard_seal(estimator);
    return GOE_OK;
}

/* Refuses an image: only a counter and the time by which goe_decide() moves the aircraft on change. Returns the older estimate. */
static GOE_NOINLINE void refuse(goe_estimator_t *estimator, goe_status_t status, int64_t time_us,
                                goe_estimate_t *estimate) {
    goe_count_cause(estimator->fault_counts, status);
    if (time_us > estimator->motion.time_us) {
        const float since_s = goe_time_between_s(estimator->motion.time_us, time_us, REFUSED_MAX_US);
        estimator->estimate.age_s = goe_larger(estimator->estimate.age_s, since_s);
    }
    *estimate = estimator->estimate;
    estimate->fresh = false;
}

/* Whether all outputs are valid, and the camera's position, which places the next image, is finite. */
static bool is_sound(const goe_estimator_t *estimator, const goe_estimate_t *estimate) {
    const bool placed = goe_guard_finite(&estimator->motion.dx_m, 2); /* dx_m and dz_m */
    return placed && goe_guard_estimate(estimate);
}

/* Ends the track: its memory was changed from outside. */
static GOE_NOINLINE goe_status_t give_up(goe_estimator_t *estimator, goe_estimate_t *estimate) {
    forget_track(estimator);
    memset(estimate, 0, sizeof *estimate);
    return GOE_CORRUPTED;
}

goe_status_t goe_update(goe_estimator_t *estimator, const goe_image_t *image, goe_estimate_t *estimate) {
    if (!estimate) {
        return GOE_BAD_ARGUMENT;
    }
    goe_status_t status = image ? goe_guard_check(estimator) : GOE_BAD_ARGUMENT;
    if (status != GOE_OK) {
        memset(estimate, 0, sizeof *estimate);
        return status;
    }
    status = goe_intake_check(&estimator->motion, image);
    const goe_camera_t *camera = goe_camera_of(&estimator->settings, image->camera);
    if (status == GOE_OK && !camera) {
        status = GOE_OUT_OF_RANGE;
    }
    if (status == GOE_OK && goe_uses_filter(estimator)) {
        status = goe_intake_check_noise(&image->noise);
    }
    if (status == GOE_OK && goe_uses_filter(estimator)) {
        status = goe_intake_check_kind(&image->kind);
    }
    if (status == GOE_OK) {
        status = take_image(estimator, image, camera);
        copy_estimate(estimate, &estimator->estimate);
    } else {
        refuse(estimator, status, image->pose.time_us, estimate);
    }
    complete(estimator, image->pose.time_us, estimate);
    return is_sound(estimator, estimate) ? status : give_up(estimator, estimate);
}

goe_status_t goe_reset(goe_estimator_t *estimator) {
    const goe_status_t status = goe_guard_check(estimator);
    if (status == GOE_OK) {
        forget_track(estimator);
    }
    return status;
}
