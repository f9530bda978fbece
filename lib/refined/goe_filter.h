/* The filter's state, its phase, its root, and the axes in which it is counted.
 * SPDX-License-Identifier: MIT */
#ifndef GOE_FILTER_H
#define GOE_FILTER_H

#include "image/goe_view.h"
#include "maths/goe_xz.h"
#include "refined/goe_srif.h"

/* The states. All lengths are in units of Z0, the range of the reference point at the filter's start, in which the image is
 * nearly linear. X, Z: the state's axes, see goe_axes_t. "Side" is the edge of length L, "front" that of width W, b the side's
 * angle from Z. */
typedef enum {
    GOE_BIAS_X, /* attitude bias about body x, y, z: small rotation from the true to the given attitude, rad */
    GOE_BIAS_Y,
    GOE_BIAS_Z,
    GOE_GROUND,        /* (true minus given height of the camera above the obstacle's ground)/Z0 */
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

/* The same places of a footprint, see goe_footprint.h. All over Z0. */
enum {
    GOE_SHEAR = GOE_SIDE_X,              /* how much deeper the right end lies than the middle */
    GOE_HALF = GOE_FRONT_X,              /* half width across Z */
    GOE_LOG_DEPTH = GOE_DEPTH_DIFFERENCE /* log of depth along Z over width: the last, which may be considered */
};

GOE_STATIC_ASSERT(GOE_LOG_DEPTH == GOE_STATES - 1, the_considered_state_comes_last);

/* Places of the states in goe_substitution_t. */
enum { GOE_OF_GROUND, GOE_OF_BEARING, GOE_OF_RANGE, GOE_OF_TOP, GOE_OF_SIDE, GOE_OF_FRONT, GOE_OF_DEPTH };

GOE_STATIC_ASSERT(GOE_GROUND + GOE_CHANGED == GOE_STATES && GOE_GROUND + GOE_OF_DEPTH == GOE_DEPTH_DIFFERENCE,
                  the_last_states_are_those_that_change);
GOE_STATIC_ASSERT(GOE_KEPT == GOE_TOP, the_first_states_are_those_that_are_kept);

/* The phases, and what leads from one to the next.
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
 * A box may also exchange the names of front and side, without leaving its phase (goe_box_change). */
typedef enum {
    GOE_PHASE_NONE,      /* not started */
    GOE_PHASE_FOOTPRINT, /* an ellipse, by the silhouette; also in place of a box whose orientation is not known yet */
    GOE_PHASE_BOX_FACE,  /* a box with one visible face: its length is fixed, not estimated */
    GOE_PHASE_BOX        /* a box by its base corners */
} goe_phase_t;

#define GOE_PHASES (GOE_PHASE_BOX + 1)

/* What the model of a phase is like, for all that does not know the models. */
typedef struct {
    bool is_ellipse; /* its last state is a ratio, and may be considered; GOE_FRONT_X is half a width */
    bool is_box;     /* two edges by base corners, with orientation and length */
    bool one_face;   /* ... of which one face is visible: its length is held, not estimated */
} goe_traits_t;

extern const goe_traits_t goe_traits_of[GOE_PHASES];

static inline const goe_traits_t *goe_filter_traits(const goe_filter_t *filter) {
    return &goe_traits_of[filter->phase < GOE_PHASES ? filter->phase : GOE_PHASE_NONE];
}

static inline bool goe_filter_has_started(const goe_filter_t *filter) { return filter->phase != GOE_PHASE_NONE; }
static inline bool goe_filter_is_box(const goe_filter_t *filter) { return goe_filter_traits(filter)->is_box; }

/* Upright boxes have started the footprint: the height counts by the changes of down, a side's error is remembered, and the foot gives
 * the range from the first image on. */
static inline bool goe_filter_by_boxes(const goe_filter_t *filter) {
    return goe_filter_traits(filter)->is_ellipse && filter->datum.boxes;
}

/* Whether the phase is one that the settings let be reported: a forced line is a box, and no disc before it. */
bool goe_filter_reports(const goe_filter_t *filter, goe_model_t asked);

/* Forgets the track. */
void goe_filter_clear(goe_filter_t *filter);

/* Enters a phase: counters of the phase begin again. */
void goe_filter_enter(goe_filter_t *filter, goe_phase_t phase);

/* The same obstacle in another phase: what counts its images goes on. */
static inline void goe_filter_set_phase(goe_filter_t *filter, goe_phase_t phase) { filter->phase = (uint8_t)phase; }

/* Points count as never refused. */
void goe_filter_forgive(goe_filter_t *filter);

/* Images in a row; saturates. Returns the new count. */
static inline unsigned goe_count_image(uint8_t *count) {
    *count = (uint8_t)(*count < UINT8_MAX ? *count + 1 : UINT8_MAX);
    return *count;
}

/* --------------------------------------------------------------------------------------------------------------- root -- */

/* Adds the variance sigma^2 to a state; sigma > 0. */
/*@ requires \valid(filter) && state < GOE_STATES; */
void goe_filter_inflate(goe_filter_t *filter, goe_state_index_t state, float sigma);

/* A state's error in terms of independent unit errors, as goe_srif_project() has it. Returns its variance. */
/*@ requires \valid_read(filter) && state < GOE_STATES && \valid(error + (0 .. GOE_STATES - 1)); */
float goe_filter_error(const goe_filter_t *filter, goe_state_index_t state, float error[GOE_STATES]);

/*@ requires \valid_read(filter) && state < GOE_STATES; */
float goe_filter_variance(const goe_filter_t *filter, goe_state_index_t state);

/* --------------------------------------------------------------------------------------------------- process noise -- */

/* (R12): the bias of the attitude drifts, the own position walks. R holds the errors as of the latest image that gave rows, and so
 * does an answer; the noise since then is due, and goes into R before the rows of the next, or before a change of the model.
 *
 * Time passes. */
void goe_filter_wait(goe_filter_t *filter, float since_s);

/* The noise that is due goes into R. since_s: after the image before. */
void goe_filter_age(goe_filter_t *filter, const goe_navigation_t *navigation, float since_s);

/* Variance that is due: of each attitude bias, and of the bearing. */
float goe_filter_due_drift2(const goe_filter_t *filter, const goe_navigation_t *navigation);
float goe_filter_due_walk2(const goe_filter_t *filter, const goe_navigation_t *navigation);

/* ------------------------------------------------------------------------------------------------------------ axes -- */

/* The state's axes become T's, with their origin at the camera now. */
void goe_filter_place_axes(goe_filter_t *filter, const goe_motion_t *motion);

/* Turns the axes, from T's: clockwise as viewed from above, by the angle of that cosine and sine. */
static inline void goe_filter_turn_axes(goe_filter_t *filter, float turn_cos, float turn_sin) {
    filter->axes.turn_cos = turn_cos;
    filter->axes.turn_sin = turn_sin;
}

/* The camera since the filter's start in the latest image that gave rows, the state's axes, m: what images have shown, they have shown
 * up to there. */
static inline goe_xz_t goe_filter_measured(const goe_filter_t *filter) {
    const goe_xz_t camera_m = {filter->measured.dx_m, filter->measured.dz_m};
    return camera_m;
}

/* Seconds since the filter's start; at most 4000. */
float goe_filter_elapsed_s(const goe_filter_t *filter, const goe_motion_t *motion);

/* goe_filter_camera(): the camera since the filter's start, the state's axes, m: as an obstacle sees it that moves, and freed of
 * what the poses are late by. */
#if GOE_AUGMENTED
goe_xz_t goe_filter_camera(const goe_filter_t *filter, const goe_motion_t *motion);

/* The own velocity less that at the filter's start, m/s, the state's axes. */
goe_xz_t goe_filter_gained(const goe_filter_t *filter, const goe_motion_t *motion);

/* Takes the own velocity at the filter's start, as soon as it is known. */
void goe_filter_pace(goe_filter_t *filter, const goe_motion_t *motion);
#else
static inline goe_xz_t goe_filter_camera(const goe_filter_t *filter, const goe_motion_t *motion) {
    const goe_xz_t since = {motion->dx_m - filter->axes.start_dx_m, motion->dz_m - filter->axes.start_dz_m};
    return goe_xz_into(since, filter->axes.turn_cos, filter->axes.turn_sin);
}
#endif

/* What the obstacle has moved by since the filter's start, m, T axes. */
goe_xz_t goe_filter_moved(const goe_filter_t *filter, const goe_motion_t *motion);

/* A direction out of the state's axes into T's. */
static inline goe_xz_t goe_filter_into_trajectory(const goe_filter_t *filter, goe_xz_t v) {
    return goe_xz_out_of(v, filter->axes.turn_cos, filter->axes.turn_sin);
}

#endif
