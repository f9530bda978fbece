/* The filter's phases, process noise, axes and variances. SPDX-License-Identifier: MIT */
#include "refined/goe_filter.h"

#include <math.h>
#include <string.h>

#include "image/goe_ego_motion.h"
#include "maths/goe_angle.h"
#include "maths/goe_scalar.h"
#include "maths/goe_time.h"
#include "refined/goe_mover.h"

#if GOE_WITH_FILTER

GOE_STATIC_ASSERT(GOE_PHASES <= UINT8_MAX, a_phase_fits_its_byte);
GOE_STATIC_ASSERT((GOE_HAS_POSITION | GOE_HAS_LENGTH | GOE_HAS_HEIGHT | GOE_HAS_ORIENTATION | GOE_HAS_CENTER |
                   GOE_HAS_WIDTH) <= UINT8_MAX,
                  known_mask_fits_its_byte);
GOE_STATIC_ASSERT(GOE_BIAS_Y == GOE_BIAS_X + 1 && GOE_BIAS_Z == GOE_BIAS_X + 2, the_biases_follow_each_other);

const goe_traits_t goe_traits_of[GOE_PHASES] = {[GOE_PHASE_NONE] = {.is_box = false},
                                                [GOE_PHASE_FOOTPRINT] = {.is_ellipse = true},
                                                [GOE_PHASE_BOX_FACE] = {.is_box = true, .one_face = true},
                                                [GOE_PHASE_BOX] = {.is_box = true}};

bool goe_filter_reports(const goe_filter_t *filter, goe_model_t asked) {
    return asked == GOE_MODEL_LINE ? goe_filter_is_box(filter) : goe_filter_has_started(filter);
}

void goe_filter_clear(goe_filter_t *filter) {
    memset(filter, 0, sizeof *filter);
    filter->axes.turn_cos = 1.0f;
#if GOE_AUGMENTED
    goe_mover_clear(filter);
#endif
}

void goe_filter_enter(goe_filter_t *filter, goe_phase_t phase) {
    filter->answer.outdated = true;
    goe_filter_set_phase(filter, phase);
    filter->phase_images = 0;
    filter->known = 0;
    filter->candidate.agreeing = 0;
    filter->health.poor = 0;
    filter->health.recent_nis = GOE_NIS_NONE; /* the first image of a phase does not count */
}

void goe_filter_forgive(goe_filter_t *filter) { memset(filter->health.refused, 0, sizeof filter->health.refused); }

float goe_filter_error(const goe_filter_t *filter, goe_state_index_t state, float error[GOE_STATES]) {
    const size_t first = state < GOE_UNWEIGHTED ? 0u : GOE_UNWEIGHTED;
    float reciprocal[GOE_STATES];
    memset(error, 0, GOE_STATES * sizeof error[0]);
    error[state] = 1.0f;
    goe_srif_reciprocals(&filter->root, reciprocal);
    const float variance = goe_srif_project(&filter->root, reciprocal, first, error);
#if GOE_AUGMENTED
    float part[GOE_AUGMENTED];
    goe_srif_augmented(&filter->root, error, first, NULL, 0.0f, part);
    return variance + goe_srif_augmented_dot(part, part);
#else
    return variance;
#endif
}

float goe_filter_variance(const goe_filter_t *filter, goe_state_index_t state) {
    float error[GOE_STATES];
    return goe_filter_error(filter, state, error);
}

void goe_filter_inflate(goe_filter_t *filter, goe_state_index_t state, float sigma) {
    float direction[GOE_STATES];
    direction[state] = 1.0f;
    goe_srif_spread(&filter->root, direction, state, state, sigma);
}

void goe_filter_wait(goe_filter_t *filter, float since_s) {
    filter->walk_s[0] += since_s;
    filter->walk_s[1] += since_s;
    filter->due_s += since_s;
#if GOE_CAMERAS_MAX > 1
    for (size_t i = 0; i < GOE_CAMERAS_MAX; i++) {
        filter->faded_s[i] += since_s;
        filter->used_s[i] += since_s;
    }
#endif
}

float goe_filter_due_drift2(const goe_filter_t *filter, const goe_navigation_t *navigation) {
    return goe_square(navigation->attitude_walk_sd_deg * GOE_RAD_PER_DEG) * filter->due_s;
}

float goe_filter_due_walk2(const goe_filter_t *filter, const goe_navigation_t *navigation) {
    return goe_square(navigation->position_walk_sd_m * filter->state[GOE_INVERSE_RANGE]) * filter->due_s;
}

/* A step of the own position along Z rescales every length in units of Z0. The depth of an ellipse is a ratio of two lengths. */
static GOE_NOINLINE void walk_along_z(goe_filter_t *filter, float sigma) {
    float direction[GOE_STATES];
    memcpy(direction, filter->state, sizeof direction);
    if (goe_filter_traits(filter)->is_ellipse) {
        direction[GOE_LOG_DEPTH] = 0.0f;
    }
    goe_srif_spread(&filter->root, direction, GOE_GROUND, GOE_STATES - 1u, sigma);
}

/* Adds the walk along X or Z, for the time since it was last added. walk: one sigma per root second, units of Z0. */
/*@ requires \valid(filter) && axis < 2; */
static void walk_along(goe_filter_t *filter, size_t axis, float walk) {
    const float sigma = walk * sqrtf(filter->walk_s[axis]);
    if (!(sigma > 0.0f)) {
        return;
    }
    filter->walk_s[axis] = 0.0f;
    if (axis == 0u) {
        goe_filter_inflate(filter, GOE_BEARING, sigma);
    } else {
        walk_along_z(filter, sigma);
    }
}

/* The walk along X and Z alternates from image to image. After images without rows both are added, because much is due. */
void goe_filter_age(goe_filter_t *filter, const goe_navigation_t *navigation, float since_s) {
    if (!(filter->due_s > 0.0f)) {
        return;
    }
    const float drift = sqrtf(goe_filter_due_drift2(filter, navigation));
    const float walk = navigation->position_walk_sd_m * filter->state[GOE_INVERSE_RANGE];
    const size_t first = filter->walk_s[1] > filter->walk_s[0] ? 1u : 0u;
    if (drift > 0.0f) {
        goe_filter_inflate(filter, GOE_BIAS_X, drift);
        goe_filter_inflate(filter, GOE_BIAS_Y, drift);
        goe_filter_inflate(filter, GOE_BIAS_Z, drift);
    }
    walk_along(filter, first, walk);
    if (filter->due_s > since_s) {
        walk_along(filter, 1u - first, walk);
    }
    filter->due_s = 0.0f;
}

float goe_filter_elapsed_s(const goe_filter_t *filter, const goe_motion_t *motion) {
    return goe_time_between_s(filter->axes.start_time_us, motion->time_us, GOE_TIME_MAX_US);
}

goe_xz_t goe_filter_moved(const goe_filter_t *filter, const goe_motion_t *motion) {
    goe_xz_t moved = {0.0f, 0.0f};
#if GOE_AUGMENTED
    if (filter->mover.followed) {
        const float s = goe_filter_elapsed_s(filter, motion);
        moved.x = filter->mover.augmented[GOE_AUGMENTED_VELOCITY_X] * s;
        moved.z = filter->mover.augmented[GOE_AUGMENTED_VELOCITY_Z] * s;
    }
#else
    (void)filter;
    (void)motion;
#endif
    return moved;
}

#if GOE_AUGMENTED
goe_xz_t goe_filter_gained(const goe_filter_t *filter, const goe_motion_t *motion) {
    const goe_axes_t *axes = &filter->axes;
    goe_xz_t gained = {0.0f, 0.0f};
    if (filter->paced && goe_motion_paced(motion)) {
        gained.x = motion->velocity_m_s[0] - axes->start_velocity_m_s[0];
        gained.z = motion->velocity_m_s[1] - axes->start_velocity_m_s[1];
    }
    return goe_xz_into(gained, axes->turn_cos, axes->turn_sin);
}

void goe_filter_pace(goe_filter_t *filter, const goe_motion_t *motion) {
    if (!filter->paced && goe_motion_paced(motion)) {
        memcpy(filter->axes.start_velocity_m_s, motion->velocity_m_s, sizeof filter->axes.start_velocity_m_s);
        filter->paced = true;
    }
}

goe_xz_t goe_filter_camera(const goe_filter_t *filter, const goe_motion_t *motion) {
    goe_xz_t since = {motion->dx_m - filter->axes.start_dx_m, motion->dz_m - filter->axes.start_dz_m};
    const goe_xz_t moved = goe_filter_moved(filter, motion);
    const goe_xz_t gained = goe_filter_gained(filter, motion);
    since.x -= moved.x;
    since.z -= moved.z;
    since = goe_xz_into(since, filter->axes.turn_cos, filter->axes.turn_sin);
    since.x += filter->mover.augmented[GOE_AUGMENTED_LATENCY] * gained.x;
    since.z += filter->mover.augmented[GOE_AUGMENTED_LATENCY] * gained.z;
    return since;
}
#endif

void goe_filter_place_axes(goe_filter_t *filter, const goe_motion_t *motion) {
    filter->axes.start_time_us = motion->time_us;
    goe_filter_turn_axes(filter, 1.0f, 0.0f);
    filter->axes.start_dx_m = motion->dx_m;
    filter->axes.start_dz_m = motion->dz_m;
    filter->datum.start_m = filter->datum.height_m;
#if GOE_AUGMENTED
    filter->paced = false;
    goe_filter_pace(filter, motion);
#endif
}

#endif
