/* The filter's states, phases, process noise and axes, and variances of its states. SPDX-License-Identifier: MIT */
#ifndef GOE_FILTER_H
#define GOE_FILTER_H

#include "image/goe_view.h"
#include "maths/goe_xz.h"
#include "refined/goe_srif.h"

/* The states. All lengths are in units of Z0, the range of the reference point at the filter's start: the image is nearly linear in them. X
 * and Z are the state's axes, see goe_axes_t. "Side" is the edge of length L, "front" the edge of width W, and b the angle of the side from
 * Z. */
typedef enum {
    GOE_BIAS_X, /* attitude bias about body x, y, z: small rotation from the true to the supplied attitude, rad */
    GOE_BIAS_Y,
    GOE_BIAS_Z,
    GOE_GROUND,        /* (true minus supplied height of the camera above the obstacle's ground)/Z0 */
    GOE_BEARING,       /* X0/Z0 */
    GOE_INVERSE_RANGE, /* 1/Z0, 1/m */
    GOE_TOP,           /* H/Z0 - GOE_GROUND: the top above the altimeter's own zero */
    GOE_SIDE_X,        /* box: L sin(b)/Z0 */
    GOE_FRONT_X,       /* box: W cos(b)/Z0 */
    /* box: (L cos(b) - W |sin(b)|)/Z0: how much deeper the side reaches than the front */
    GOE_DEPTH_DIFFERENCE,
    GOE_STATE_COUNT
} goe_state_index_t;

GOE_STATIC_ASSERT(GOE_STATE_COUNT == GOE_STATES, every_state_has_a_name);

/* The same indices for a footprint, see goe_footprint.h. All over Z0. */
enum {
    GOE_SHEAR = GOE_SIDE_X, /* how much deeper the right end is than the middle */
    GOE_HALF = GOE_FRONT_X, /* half width across Z */
    GOE_LOG_DEPTH =
        GOE_DEPTH_DIFFERENCE /* log of depth along Z over width: the last state, as it may be a consider parameter */
};

GOE_STATIC_ASSERT(GOE_LOG_DEPTH == GOE_STATES - 1, the_considered_state_comes_last);

/* Indices of the states in goe_substitution_t. */
enum { GOE_OF_GROUND, GOE_OF_BEARING, GOE_OF_RANGE, GOE_OF_TOP, GOE_OF_SIDE, GOE_OF_FRONT, GOE_OF_DEPTH };

GOE_STATIC_ASSERT(GOE_GROUND + GOE_CHANGED == GOE_STATES && GOE_GROUND + GOE_OF_DEPTH == GOE_DEPTH_DIFFERENCE,
                  the_last_states_are_those_that_change);
GOE_STATIC_ASSERT(GOE_KEPT == GOE_TOP, the_first_states_are_those_that_are_kept);

/* The phases, and the conditions that lead from one to the next.
 *
 *          left and right visible,          base corners agree: goe_box_start
 *          or both outer base corners         one face         two faces
 *   NONE -----------------------> FOOTPRINT ---------> BOX_FACE      |
 *    ^                                |                    | second face in view: goe_box_change
 *    |                                |                    v         |
 *    |                                \-------------------> BOX <----/
 *    |  captured, not sane (health)
 *    \--- from every phase
 *
 * A box may also exchange the names of front and side within its phase (goe_box_change). */
typedef enum {
    GOE_PHASE_NONE,      /* not started */
    GOE_PHASE_FOOTPRINT, /* an ellipse that fits the silhouette; also for a box whose orientation is not known yet */
    GOE_PHASE_BOX_FACE,  /* a box with one visible face: its length is fixed, not estimated */
    GOE_PHASE_BOX        /* a box measured by its base corners */
} goe_phase_t;

#define GOE_PHASES (GOE_PHASE_BOX + 1)

/* Properties of a phase's model, for code that does not depend on the models. */
typedef struct {
    bool is_ellipse; /* its last state is a ratio, and may be a consider parameter; GOE_FRONT_X is half a width */
    bool is_box;     /* two edges measured by base corners, with orientation and length */
    bool one_face;   /* a box with one visible face: its length is fixed, not estimated */
} goe_traits_t;

extern const goe_traits_t goe_traits_of[GOE_PHASES];

static inline const goe_traits_t *goe_filter_traits(const goe_filter_t *filter) {
    return &goe_traits_of[filter->phase < GOE_PHASES ? filter->phase : GOE_PHASE_NONE];
}

static inline bool goe_filter_has_started(const goe_filter_t *filter) { return filter->phase != GOE_PHASE_NONE; }
static inline bool goe_filter_is_box(const goe_filter_t *filter) { return goe_filter_traits(filter)->is_box; }

/* Whether the footprint has used an upright box. The slowly varying errors of the sides are then remembered, and no correlation of points
 * widens the variances. */
static inline bool goe_filter_by_boxes(const goe_filter_t *filter) {
    return goe_filter_traits(filter)->is_ellipse && filter->boxes;
}

/* Whether the settings allow the phase to be reported: if they force a line, only a box, not the footprint before it. */
bool goe_filter_reports(const goe_filter_t *filter, goe_model_t asked);

/* Forgets the track. */
void goe_filter_clear(goe_filter_t *filter);

/* Enters a phase: counters of the phase begin again. */
void goe_filter_enter(goe_filter_t *filter, goe_phase_t phase);

/* Changes the phase for the same obstacle; the counters of its images continue. */
static inline void goe_filter_set_phase(goe_filter_t *filter, goe_phase_t phase) { filter->phase = (uint8_t)phase; }

/* Sets the counts of refused points to 0. */
void goe_filter_forgive(goe_filter_t *filter);

/* Increments a count of images in a row; saturates. Returns the new count. */
static inline unsigned goe_count_image(uint8_t *count) {
    *count = (uint8_t)(*count < UINT8_MAX ? *count + 1 : UINT8_MAX);
    return *count;
}

/* --------------------------------------------------------------------------------------------------------------- root -- */

/* Adds the variance sigma^2 to a state; sigma > 0. */
/*@ requires \valid(filter) && state < GOE_STATES; */
void goe_filter_inflate(goe_filter_t *filter, goe_state_index_t state, float sigma);

/* A state's error in terms of independent unit errors, as by goe_srif_project(). Returns its variance. */
/*@ requires \valid_read(filter) && state < GOE_STATES && \valid(error + (0 .. GOE_STATES - 1)); */
float goe_filter_error(const goe_filter_t *filter, goe_state_index_t state, float error[GOE_STATES]);

/*@ requires \valid_read(filter) && state < GOE_STATES; */
float goe_filter_variance(const goe_filter_t *filter, goe_state_index_t state);

/* --------------------------------------------------------------------------------------------------- process noise -- */

/* (R12): the attitude bias and the own position walk randomly. R contains the errors as of the latest image that gave rows, and so does an
 * estimate. The noise since then is due: it is added to R before the next rows, or before a change of the model.
 *
 * Adds time for which noise is due. */
void goe_filter_wait(goe_filter_t *filter, float since_s);

/* Adds the due noise to R. since_s: time since the previous image. */
void goe_filter_age(goe_filter_t *filter, const goe_navigation_t *navigation, float since_s);

/* Due variance of each attitude bias, and of the bearing. */
float goe_filter_due_drift2(const goe_filter_t *filter, const goe_navigation_t *navigation);
float goe_filter_due_walk2(const goe_filter_t *filter, const goe_navigation_t *navigation);

/* ------------------------------------------------------------------------------------------------------------ axes -- */

/* Sets the state's axes to those of T, with their origin at the present camera. */
void goe_filter_place_axes(goe_filter_t *filter, const goe_motion_t *motion);

/* Sets the turn of the axes from T, clockwise as viewed from above, by the angle's cosine and sine. */
static inline void goe_filter_turn_axes(goe_filter_t *filter, float turn_cos, float turn_sin) {
    filter->axes.turn_cos = turn_cos;
    filter->axes.turn_sin = turn_sin;
}

/* The camera's displacement from the filter's start to the latest image that gave rows, m, in the state's axes: the information of the
 * images ends there. */
static inline goe_xz_t goe_filter_measured(const goe_filter_t *filter) {
    const goe_xz_t camera_m = {filter->measured.dx_m, filter->measured.dz_m};
    return camera_m;
}

/* Seconds since the filter's start; at most 4000. */
float goe_filter_elapsed_s(const goe_filter_t *filter, const goe_motion_t *motion);

/* goe_filter_camera(): the camera's displacement since the filter's start, m, in the state's axes; relative to a moving obstacle, and
 * corrected for the latency of the poses. */
#if GOE_AUGMENTED
goe_xz_t goe_filter_camera(const goe_filter_t *filter, const goe_motion_t *motion);

/* Change of the own velocity since the filter's start, m/s, in the state's axes. */
goe_xz_t goe_filter_gained(const goe_filter_t *filter, const goe_motion_t *motion);

/* Stores the own velocity at the filter's start, as soon as a velocity is known. */
void goe_filter_pace(goe_filter_t *filter, const goe_motion_t *motion);
#else
static inline goe_xz_t goe_filter_camera(const goe_filter_t *filter, const goe_motion_t *motion) {
    const goe_xz_t since = {motion->dx_m - filter->axes.start_dx_m, motion->dz_m - filter->axes.start_dz_m};
    return goe_xz_into(since, filter->axes.turn_cos, filter->axes.turn_sin);
}
#endif

/* Displacement of a followed obstacle since the filter's start, m, T axes. */
goe_xz_t goe_filter_moved(const goe_filter_t *filter, const goe_motion_t *motion);

/* Transforms a direction from the state's axes into T's. */
static inline goe_xz_t goe_filter_into_trajectory(const goe_filter_t *filter, goe_xz_t v) {
    return goe_xz_out_of(v, filter->axes.turn_cos, filter->axes.turn_sin);
}

#endif
