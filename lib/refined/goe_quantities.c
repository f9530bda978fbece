/* The quantities of an estimate: their sigmas, covariance and validity. SPDX-License-Identifier: MIT */
#include "refined/goe_quantities.h"

#include <math.h>
#include <string.h>

#include "image/goe_ego_motion.h"
#include "maths/goe_scalar.h"
#include "refined/goe_deviation.h"
#include "refined/goe_drift.h"
#include "refined/goe_footprint.h"
#include "refined/goe_gate.h"
#include "refined/goe_ground.h"
#include "refined/goe_model.h"
#include "refined/goe_mover.h"
#include "refined/goe_near_side.h"
#include "refined/goe_scatter.h"

#if GOE_WITH_FILTER

#define EXTENT_SHARE 0.3f /* largest relative sigma of a valid width, length or height */
#define HEIGHT_MIN_M 2.0f /* a lower obstacle's height may be off by that share of this */
#define ORIENTATION_MAX_RAD 0.174532925f
#define METERS_MAX 1.0e6f

static bool depends_on_corner(int quantity) { return quantity >= GOE_ORIENTATION && quantity <= GOE_LENGTH; }

/* ---------------------------------------------------------------------------------------------------------- validity -- */

/* Whether the sigma is within a share of the value, and both are finite, by their bits. */
static bool is_known(float value, float sigma, float least, float share) {
    const float size = goe_larger(goe_absolute(value), least);
    return goe_within(value, METERS_MAX) && goe_within(sigma, share * size);
}

/*@ requires \valid_read(q) && 0 <= quantity < GOE_QUANTITIES; */
static bool is_extent(const goe_quantities_t *q, int quantity, float least) {
    return q->value[quantity] > 0.0f && goe_within(q->sigma[quantity], METERS_MAX) &&
           is_known(q->value[quantity], q->worked_out[quantity], least, EXTENT_SHARE);
}

/* from: origin of the values, in T. */
static bool is_position(const goe_quantities_t *q, goe_xz_t from, float share) {
    return goe_within(q->value[GOE_X0] + from.x, METERS_MAX) && goe_within(q->value[GOE_Z0] + from.z, METERS_MAX) &&
           goe_within(q->sigma[GOE_X0], METERS_MAX) && goe_within(q->sigma[GOE_Z0], METERS_MAX) &&
           goe_within(q->worked_out[GOE_X0], share * q->value[GOE_Z0]) &&
           is_known(q->value[GOE_Z0], q->worked_out[GOE_Z0], 0.0f, share);
}

static unsigned known_extents(const goe_filter_t *filter, const goe_quantities_t *q) {
    unsigned known = 0;
    if (is_extent(q, GOE_WIDTH, 0.0f)) {
        known |= GOE_HAS_WIDTH;
    }
    if (q->box && !goe_filter_traits(filter)->one_face && is_extent(q, GOE_LENGTH, 0.0f)) {
        known |= GOE_HAS_LENGTH;
    }
    if (q->box && goe_within(q->worked_out[GOE_ORIENTATION], ORIENTATION_MAX_RAD)) {
        known |= GOE_HAS_ORIENTATION;
    }
    return known;
}

/* Which quantities this image knows well enough. from: origin of the values in T, at the filter's start. */
static unsigned known_now(const goe_filter_t *filter, const goe_quantities_t *q, goe_xz_t from, float range_share) {
    if (!is_position(q, from, range_share)) {
        return 0;
    }
    return GOE_HAS_POSITION | (is_extent(q, GOE_HEIGHT, HEIGHT_MIN_M) ? GOE_HAS_HEIGHT : 0u) | known_extents(filter, q);
}

/* --------------------------------------------------------------------------------------------------------- quantities -- */

/* Whether the model has the quantity: only a box has an orientation and a length; the shape of a footprint leaves them 0. */
static bool has(const goe_quantities_t *q, int quantity) {
    return q->box || (quantity != GOE_ORIENTATION && quantity != GOE_LENGTH);
}

GOE_STATIC_ASSERT(GOE_X0 == 0 && GOE_Z0 == 1, the_place_comes_first);

/* The error of the ground; and the factors on the square of a quantity's covariance with it by which its variance shrinks if the ground is
 * level, or if it is known. */
typedef struct {
    float by[GOE_STATES];
    float if_level, if_known;
} ground_t;

static void ground_of(const goe_filter_t *filter, const goe_navigation_t *navigation, const goe_widening_t *wider,
                      ground_t *ground) {
    for (size_t k = GOE_UNWEIGHTED; k < GOE_STATES; k++) {
        ground->by[k] = k == GOE_GROUND ? 1.0f : 0.0f;
    }
    (void)goe_srif_project(&filter->root, wider->reciprocal, GOE_UNWEIGHTED, ground->by);
    if (goe_filter_traits(filter)->is_ellipse) { /* validity does not depend on the depth either: as if it were known */
        ground->by[GOE_LOG_DEPTH] = 0.0f;
    }
    const float variance =
        goe_deviation_dot(ground->by, ground->by, 0.0f); /* a sum of squares, which cannot cancel to 0 */
    ground->if_level = goe_ground_if_level(filter, navigation, variance);
    ground->if_known = 1.0f / variance;
}

/* If a foot lies above the altimeter's zero, either the ground there is higher, or bushes hide the lowest part of the obstacle. No image
 * shows which of the two. */
static float hidden_variance(const goe_filter_t *filter, float scale_m) {
    const float above_m = -filter->state[GOE_GROUND] * scale_m;
    return above_m > 0.0f ? goe_square(above_m) : 0.0f;
}

/* The direction in T of a quantity that is a position, and the time for which it is valid. */
static goe_counted_t counted_of(int quantity, float at_s) {
    const goe_counted_t counted = {quantity == GOE_X0 ? 1.0f : 0.0f, quantity == GOE_Z0 ? 1.0f : 0.0f, at_s};
    return counted;
}

/* The data that all quantities share. */
typedef struct {
    const goe_filter_t *filter;
    const goe_motion_t *motion;
    const goe_shape_t *shape;
    const goe_widening_t *wider;
    const ground_t *ground;
    goe_drift_t drift;
} finding_t;

/* The scatter widens the sigmas but does not affect validity, because doubt must not suppress an estimate. Nor must the ground: validity
 * assumes that it is level and, for the height, that it is known. *error: derivatives in, error out. */
GOE_NOINLINE static void find_quantity(const finding_t *f, int i, goe_quantities_t *q, goe_deviation_t *error) {
    const goe_counted_t counted = counted_of(i, goe_filter_elapsed_s(f->filter, f->motion));
    const float found = has(q, i) ? goe_deviation_project(f->filter, f->wider, counted, error) : 0.0f;
    const float growth = depends_on_corner(i) ? f->shape->corner_growth : 1.0f;
    const float by_ground = i == GOE_HEIGHT ? f->ground->if_known : f->ground->if_level;
    const float doubted = by_ground * goe_square(goe_deviation_dot(error->by, f->ground->by, 0.0f));
    const float excluded = goe_filter_traits(f->filter)->is_ellipse ? goe_srif_last_variance(error->by) : 0.0f;
    const float given = goe_drift_variance(f->motion, &f->drift, f->shape, q->box, i);
    const float hidden = i == GOE_HEIGHT ? hidden_variance(f->filter, f->shape->scale_m) : 0.0f;
    q->value[i] = f->shape->quantity[i].value;
    q->sigma[i] = sqrtf(f->wider->scatter * growth * found + given + hidden);
    q->worked_out[i] = sqrtf(goe_larger(growth * (found - doubted) + given - excluded, 0.0f));
}

/* place: receives the errors of X0 and Z0. */
static void set_quantities(const finding_t *finding, goe_shape_t *shape, goe_quantities_t *q,
                           goe_deviation_t place[2]) {
    goe_deviation_t other;
    memset(&other, 0, sizeof other);
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        goe_deviation_t *error = i <= GOE_Z0 ? &place[i] : &other;
        error->by = shape->quantity[i].by;
        find_quantity(finding, i, q, error);
    }
}

/* Error of the middle of the base along a direction, T axes; error->by receives its derivatives by the states. The middle of a footprint is
 * the reference point, whose errors along X and Z are given: place. */
/*@ requires \valid_read(f) && \valid_read(f->filter) && \valid_read(f->shape) && \valid_read(f->wider);
    requires \valid_read(place + (0 .. 1)) && \valid(error) && \valid(error->by + (0 .. GOE_STATES - 1)); */
static void find_middle(const finding_t *f, const goe_deviation_t place[2], goe_counted_t along,
                        goe_deviation_t *error) {
    if (goe_filter_is_box(f->filter)) {
        const goe_xz_t in_trajectory = {along.x, along.z};
        const goe_xz_t in_axes = goe_xz_into(in_trajectory, f->filter->axes.turn_cos, f->filter->axes.turn_sin);
        memset(error->by, 0, GOE_STATES * sizeof error->by[0]);
        goe_shape_place(&f->shape->middle, f->shape->scale_m, in_axes.x, in_axes.z, error->by);
        (void)goe_deviation_project(f->filter, f->wider, along, error);
        return;
    }
    goe_deviation_sum(&place[GOE_X0], along.x, &place[GOE_Z0], along.z, error);
}

/* Sets the middle of the base, in north and east. place: errors of X0 and Z0. */
static void set_center(const finding_t *f, const goe_deviation_t place[2], goe_quantities_t *q) {
    const goe_motion_t *motion = f->motion;
    const goe_axes_t *axes = &f->filter->axes;
    const goe_xz_t middle = goe_filter_into_trajectory(f->filter, f->shape->middle.at);
    const goe_xz_t gone = goe_filter_moved(f->filter, motion);
    const float scale_m = f->shape->scale_m;
    const float elapsed_s = goe_filter_elapsed_s(f->filter, motion);
    const goe_counted_t to_north = {-motion->heading_sin, motion->heading_cos, elapsed_s};
    const goe_counted_t to_east = {motion->heading_cos, motion->heading_sin, elapsed_s};
    float by[2][GOE_STATES];
    goe_deviation_t north;
    goe_deviation_t east;
    memset(&north, 0, sizeof north);
    memset(&east, 0, sizeof east);
    north.by = by[0];
    east.by = by[1];
    goe_motion_place(motion, middle.x * scale_m + axes->start_dx_m + gone.x,
                     middle.z * scale_m + axes->start_dz_m + gone.z, &q->center_m[0], &q->center_m[1]);
    const float drifted = goe_drift_variance(motion, &f->drift, f->shape, q->box, GOE_Z0);
    const float scatter = f->wider->scatter;
    find_middle(f, place, to_north, &north);
    find_middle(f, place, to_east, &east);
    q->center_sd_m[0] = sqrtf(scatter * goe_deviation_covariance(&north, &north, 0.0f) + drifted);
    q->center_sd_m[1] = sqrtf(scatter * goe_deviation_covariance(&east, &east, 0.0f) + drifted);
    q->center_ne_m2 = scatter * goe_deviation_covariance(&north, &east, 0.0f);
    if (goe_within(q->center_sd_m[0], METERS_MAX) && goe_within(q->center_sd_m[1], METERS_MAX)) {
        q->known |= GOE_HAS_CENTER;
    }
}

/* X0 and Z0 count from the start. By a constant error of the own velocity, they differ from the place relative to the camera now by the drift
 * of the reported path. */
static void set_began(const finding_t *f, const goe_deviation_t place[2], goe_quantities_t *q) {
    q->began_m2[0] = 0.0f;
    q->began_m2[1] = 0.0f;
#if GOE_AUGMENTED
    if (!f->filter->mover.followed) {
        const float drift = f->wider->own_m_s * goe_filter_elapsed_s(f->filter, f->motion);
        const float x = drift * (drift - 2.0f * place[GOE_X0].augmented[GOE_AUGMENTED_VELOCITY_X]);
        const float z = drift * (drift - 2.0f * place[GOE_Z0].augmented[GOE_AUGMENTED_VELOCITY_Z]);
        q->began_m2[0] = f->wider->scatter * x;
        q->began_m2[1] = f->wider->scatter * z;
    }
#else
    (void)f;
    (void)place;
#endif
}

static void set_velocity(const goe_filter_t *filter, const goe_settings_t *settings, const goe_motion_t *motion,
                         const goe_widening_t *wider, goe_quantities_t *q) {
    q->moves = false;
#if GOE_AUGMENTED
    const float *augmented = filter->mover.augmented;
    const float c = motion->heading_cos;
    const float s = motion->heading_sin;
    const goe_xz_t axis[2] = {{-s, c}, {c, s}};
    const float own = goe_mover_own_variance(&settings->navigation, goe_filter_elapsed_s(filter, motion));
    q->moves = filter->mover.followed;
    for (size_t i = 0; i < 2; i++) {
        q->velocity_m_s[i] =
            axis[i].x * augmented[GOE_AUGMENTED_VELOCITY_X] + axis[i].z * augmented[GOE_AUGMENTED_VELOCITY_Z];
        q->velocity_sd_m_s[i] = sqrtf(wider->scatter * goe_mover_variance(filter, axis[i]) + own);
    }
#else
    (void)filter;
    (void)settings;
    (void)motion;
    (void)wider;
#endif
}

/* (R31). A hazard meets the near side, which hardly depends on the depth, so the derivative suffices. */
static float bend_of(const goe_filter_t *filter, bool for_hazard) {
    const bool bends = goe_filter_traits(filter)->is_ellipse && !for_hazard;
    return bends ? goe_footprint_bend(filter) : 1.0f;
}

/* Sets by how much the estimate is less certain than the filter's state. */
static void widening_of(const goe_filter_t *filter, const goe_settings_t *settings, const goe_motion_t *motion,
                        const goe_drift_t *drift, goe_shape_t *shape, goe_widening_t *wider) {
    wider->scatter = goe_scatter_factor(filter, goe_gate_repeated(filter, settings->detector.point_correlation));
    wider->own_m_s = settings->navigation.velocity_bias_sd_m_s / sqrtf(wider->scatter);
    goe_srif_reciprocals(&filter->root, wider->reciprocal);
    goe_shape_doubt(filter, settings->filter.top_is_highest, drift->camera_m, motion->height_m, shape);
}

void goe_quantities_find(const goe_filter_t *filter, const goe_settings_t *settings, const goe_motion_t *motion,
                         goe_quantities_t *quantities) {
    goe_quantities_t *q = quantities;
    goe_shape_t shape;
    goe_widening_t wider;
    ground_t ground;
    const finding_t finding = {filter, motion,  &shape,
                               &wider, &ground, goe_drift_of(filter, &settings->navigation, motion)};
    goe_deviation_t place[2];
    q->now = 0;
    q->known = 0;
    q->sigma[GOE_ORIENTATION] = 0.0f;
    q->worked_out[GOE_ORIENTATION] = 0.0f;
    if (!(filter->state[GOE_INVERSE_RANGE] > 0.0f)) {
        return;
    }
    goe_model_shape(filter, &shape);
    widening_of(filter, settings, motion, &finding.drift, &shape, &wider);
    wider.bend = bend_of(filter, false);
    ground_of(filter, &settings->navigation, &wider, &ground);
    q->before_m2 = goe_drift_before_start(filter, &settings->navigation, motion);
    q->box = goe_filter_is_box(filter);
    q->model = q->box ? GOE_MODEL_BOX : (filter->kind.is_round ? GOE_MODEL_DISC : GOE_MODEL_PRISM);
    q->length_axis = shape.length_axis;
    set_quantities(&finding, &shape, q, place);
    const goe_xz_t gone = goe_filter_moved(filter, motion);
    const goe_xz_t from = {filter->axes.start_dx_m + gone.x, filter->axes.start_dz_m + gone.z};
    q->now = known_now(filter, q, from, settings->filter.range_sd_rel_max);
    q->known = q->now & filter->known;
    q->value[GOE_X0] += from.x;
    q->value[GOE_Z0] += from.z;
    set_began(&finding, place, q);
    set_velocity(filter, settings, motion, &wider, q);
    if ((q->known & GOE_HAS_POSITION) && (!q->box || (q->known & GOE_HAS_LENGTH))) {
        set_center(&finding, place, q);
    }
}

/* --------------------------------------------------------------------------------------------------------- covariance -- */

/* The time for which places count: of a followed obstacle that of the closest approach; of a static one now, where only the error of the path
 * so far counts, or the start, without it. */
static float counted_s(const goe_filter_t *filter, const goe_motion_t *motion, bool for_hazard, float ahead_s) {
    const float elapsed_s = goe_filter_elapsed_s(filter, motion);
#if GOE_AUGMENTED
    if (!filter->mover.followed) {
        return for_hazard ? elapsed_s : 0.0f;
    }
#else
    (void)for_hazard;
#endif
    return elapsed_s + ahead_s;
}

void goe_quantities_covariance(const goe_filter_t *filter, const goe_settings_t *settings, const goe_motion_t *motion,
                               bool for_hazard, float ahead_s, float covariance[GOE_QUANTITIES][GOE_QUANTITIES]) {
    goe_shape_t shape;
    goe_widening_t wider;
    const goe_drift_t drift = goe_drift_of(filter, &settings->navigation, motion);
    goe_model_shape(filter, &shape);
    if (for_hazard) {
        goe_near_side_meet(filter, &shape);
    }
    widening_of(filter, settings, motion, &drift, &shape, &wider);
    wider.bend = bend_of(filter, for_hazard);
    const float scatter = sqrtf(wider.scatter);
    const float corner = sqrtf(shape.corner_growth) * scatter;
    const float elapsed_s = counted_s(filter, motion, for_hazard, ahead_s);
    goe_deviation_t error[GOE_QUANTITIES];
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        error[i].by = shape.quantity[i].by;
        (void)goe_deviation_project(filter, &wider, counted_of(i, elapsed_s), &error[i]);
        const float factor = depends_on_corner(i) ? corner : scatter;
        goe_deviation_scale(&error[i], factor);
        for (int j = 0; j <= i; j++) {
            const float drifted =
                i == j ? goe_drift_variance(motion, &drift, &shape, goe_filter_is_box(filter), i) : 0.0f;
            const float sum = goe_deviation_covariance(&error[i], &error[j], drifted);
            covariance[i][j] = sum;
            covariance[j][i] = sum;
        }
    }
    if (!for_hazard) { /* without effect relative to the present camera */
        const float before = goe_drift_before_start(filter, &settings->navigation, motion);
        covariance[GOE_X0][GOE_X0] += before;
        covariance[GOE_Z0][GOE_Z0] += before;
        covariance[GOE_HEIGHT][GOE_HEIGHT] += hidden_variance(filter, shape.scale_m);
    }
}

#endif
