/* Sigmas, covariance, validity. SPDX-License-Identifier: MIT */
#include "refined/goe_quantities.h"

#include <math.h>
#include <string.h>

#include "image/goe_ego_motion.h"
#include "maths/goe_scalar.h"
#include "maths/goe_time.h"
#include "refined/goe_box.h"
#include "refined/goe_ellipse.h"
#include "refined/goe_footprint.h"
#include "refined/goe_gate.h"
#include "refined/goe_ground.h"
#include "refined/goe_model.h"
#include "refined/goe_mover.h"
#include "refined/goe_scatter.h"

#if GOE_WITH_FILTER

#define EXTENT_SHARE 0.3f /* ... width, length and height */
#define HEIGHT_MIN_M 2.0f /* a lower obstacle's height may be off by the share of this */
#define SHAPE_SHARE 0.05f /* of the width, by which the place is off if points show another shape: one sigma */
#define FAR_ROOF 2.0f     /* of the width: one sigma of the position of the farthest corner of the roof */
#define ORIENTATION_MAX_RAD 0.174532925f
#define PATH_MIN_M 0.1f
#define RANGE_MIN_M 1.0f
#define METERS_MAX 1.0e6f

static bool depends_on_corner(int quantity) { return quantity >= GOE_ORIENTATION && quantity <= GOE_LENGTH; }

/* ------------------------------------------------------------------------------------------------------------- drift -- */

/* (R21): constant velocity errors scale and turn the path flown since the filter's start, and the obstacle with it: no
 * image shows that. */
typedef struct {
    goe_xz_t camera_m; /* since the filter's start */
    float share;       /* of lengths, and rad */
    float walk_m2;
    float turned_m2; /* a path that leads back on itself is not scaled: what of the drift is left */
} drift_t;

static float path_over_ground(const goe_filter_t *filter, const goe_motion_t *motion) {
    const float dx_m = motion->dx_m - filter->axes.start_dx_m;
    const float dz_m = motion->dz_m - filter->axes.start_dz_m;
    return sqrtf(dx_m * dx_m + dz_m * dz_m);
}

static drift_t drift_of(const goe_filter_t *filter, const goe_navigation_t *navigation, const goe_motion_t *motion) {
    drift_t drift;
    const float s = goe_filter_elapsed_s(filter, motion);
    drift.camera_m = goe_filter_camera(filter, motion);
    const float path_m = path_over_ground(filter, motion);
    drift.share = navigation->velocity_bias_sd_m_s * s / (path_m > PATH_MIN_M ? path_m : PATH_MIN_M);
    drift.walk_m2 = goe_square(navigation->position_walk_sd_m) * s;
    const float straight = filter->flown_m > path_m ? path_m / filter->flown_m : 1.0f;
    drift.turned_m2 = goe_square(navigation->velocity_bias_sd_m_s * s) * (1.0f - straight * straight);
    return drift;
}

/* (R21), from the track's first image to the filter's start: X0 and Z0 alone count from there. */
static float variance_before(const goe_filter_t *filter, const goe_navigation_t *navigation,
                             const goe_motion_t *motion) {
    const float s = goe_time_between_s(motion->start_time_us, filter->axes.start_time_us, GOE_TIME_MAX_US);
    return goe_square(navigation->velocity_bias_sd_m_s * s) + goe_square(navigation->position_walk_sd_m) * s;
}

/* The roof's corner below the top is off the middle; from above or from below it appears lower or higher, by the
 * tangent of that angle, which from nearby is taken as its sine. */
static float top_variance(const goe_motion_t *motion, drift_t drift, const goe_shape_t *shape) {
    const float x_m = shape->middle.at.x * shape->scale_m - drift.camera_m.x;
    const float z_m = shape->middle.at.z * shape->scale_m - drift.camera_m.z;
    const float below2_m2 = goe_square(motion->height_m - shape->quantity[GOE_HEIGHT].value);
    return shape->roof_m2 * below2_m2 / goe_larger(x_m * x_m + z_m * z_m + below2_m2, goe_square(RANGE_MIN_M));
}

/*@ requires \valid_read(motion) && \valid_read(shape) && 0 <= quantity < GOE_QUANTITIES; */
static float drift_variance(const goe_motion_t *motion, drift_t drift, const goe_shape_t *shape, bool box,
                            int quantity) {
    const float share2 = goe_square(drift.share);
    const float value = shape->quantity[quantity].value;
    switch (quantity) {
        case GOE_X0:
        case GOE_Z0:
            return share2 * goe_square(shape->quantity[GOE_Z0].value) + drift.walk_m2 + drift.turned_m2 +
                   shape->place_m2;
        case GOE_ORIENTATION:
            return box ? share2 + shape->turned_rad2 : 0.0f;
        case GOE_HEIGHT:
            return share2 * goe_larger(goe_square(value), goe_square(value - motion->height_m)) + shape->top_m2;
        case GOE_WIDTH:
            return share2 * goe_square(value) + shape->width_m2;
        default:
            return share2 * goe_square(value);
    }
}

/* --------------------------------------------------------------------------------------------------------- variance -- */

/* What an answer is less certain by than the filter. */
typedef struct {
    float scatter;                /* factor on the variance of what it found, (R32) */
    float reciprocal[GOE_STATES]; /* of R, for the projections */
    float bend;                   /* factor on a footprint's depth, goe_footprint_bend() */
} widening_t;

GOE_STATIC_ASSERT(GOE_STATES == 10 && GOE_UNWEIGHTED == 3, the_product_is_written_out_for_ten_states);

/* Of projected derivatives, whose first elements are 0. */
static float dot(const float a[GOE_STATES], const float b[GOE_STATES], float sum) {
    sum += a[3] * b[3];
    sum += a[4] * b[4];
    sum += a[5] * b[5];
    sum += a[6] * b[6];
    sum += a[7] * b[7];
    sum += a[8] * b[8];
    return sum + a[9] * b[9];
}

/* ------------------------------------------------------------------------------------------------- augmented --------- */

/* The contribution of the augmented states, if there are any, as independent unit errors. */
typedef struct {
    float part[GOE_AUGMENTED > 0 ? GOE_AUGMENTED : 1];
} augmented_t;

/* by: projected. at_s: the place counts that long after the filter's start, and (x, z), T axes, is its derivative by the place there;
 * it matters of an obstacle that is followed. */
static void augmented_of(const goe_filter_t *filter, const float by[GOE_STATES], float x, float z, float at_s,
                         augmented_t *augmented) {
#if GOE_AUGMENTED
    const float direct[GOE_AUGMENTED] = {0.0f, x * at_s, z * at_s};
    goe_srif_augmented(&filter->root, by, GOE_UNWEIGHTED, filter->mover.followed ? direct : NULL, augmented->part);
#else
    (void)filter;
    (void)by;
    (void)x;
    (void)z;
    (void)at_s;
    augmented->part[0] = 0.0f;
#endif
}

static void augmented_scale(augmented_t *augmented, float factor) {
    for (int i = 0; i < GOE_AUGMENTED; i++) {
        augmented->part[i] *= factor;
    }
}

/* x a + z b */
static augmented_t augmented_sum(const augmented_t *a, float x, const augmented_t *b, float z) {
    augmented_t sum = *a;
    for (int i = 0; i < GOE_AUGMENTED; i++) {
        sum.part[i] = x * a->part[i] + z * b->part[i];
    }
    return sum;
}

/* ------------------------------------------------------------------------------------------------------- projection -- */

GOE_STATIC_ASSERT(GOE_GROUND == GOE_UNWEIGHTED, no_quantity_depends_on_the_attitude_bias);

/* Where the place counts of which a quantity is made, see augmented_of(). */
typedef struct {
    float x, z, at_s;
} counted_t;

static counted_t counted_of(int quantity, float at_s) {
    const counted_t counted = {quantity == GOE_X0 ? 1.0f : 0.0f, quantity == GOE_Z0 ? 1.0f : 0.0f, at_s};
    return counted;
}

/* The error of a quantity in terms of independent unit errors. */
typedef struct {
    float *by; /* of the state: the projected derivatives */
    augmented_t augmented;
} deviation_t;

/* The derivatives error->by become the error. Returns its squared norm, the variance, without what moves. */
static float project(const goe_filter_t *filter, const widening_t *wider, counted_t counted, deviation_t *error) {
    float variance = goe_srif_project(&filter->root, wider->reciprocal, GOE_UNWEIGHTED, error->by);
    augmented_of(filter, error->by, counted.x, counted.z, counted.at_s, &error->augmented);
    if (goe_filter_traits(filter)->is_ellipse) {
        float *depth = &error->by[GOE_LOG_DEPTH];
        variance += (goe_square(wider->bend) - 1.0f) * goe_square(*depth);
        *depth *= wider->bend;
    }
    return variance + goe_srif_augmented_dot(error->augmented.part, error->augmented.part);
}

static float covariance_of(const widening_t *wider, const deviation_t *a, const deviation_t *b) {
    return wider->scatter * dot(a->by, b->by, goe_srif_augmented_dot(a->augmented.part, b->augmented.part));
}

/* ---------------------------------------------------------------------------------------------------------- validity -- */

/* Within a share of the value, and finite, by the bits. */
static bool is_known(float value, float sigma, float least, float share) {
    const float size = goe_larger(goe_absolute(value), least);
    return goe_within(value, METERS_MAX) && goe_within(sigma, share * size);
}

/*@ requires \valid_read(q) && 0 <= quantity < GOE_QUANTITIES; */
static bool is_extent(const goe_quantities_t *q, int quantity, float least) {
    return q->value[quantity] > 0.0f && goe_within(q->sigma[quantity], METERS_MAX) &&
           is_known(q->value[quantity], q->worked_out[quantity], least, EXTENT_SHARE);
}

/* from: where the values count from, in T. */
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

/* Which of the quantities this image knows well enough; values count from the filter's start, which lies at `from`. */
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

/* The error of the ground, and by how much a variance shrinks per square of its covariance with it, if the ground is level, and if it
 * is known. */
typedef struct {
    float by[GOE_STATES];
    float if_level, if_known;
} ground_t;

static void ground_of(const goe_filter_t *filter, const goe_navigation_t *navigation, const widening_t *wider,
                      ground_t *ground) {
    for (size_t k = GOE_UNWEIGHTED; k < GOE_STATES; k++) {
        ground->by[k] = k == GOE_GROUND ? 1.0f : 0.0f;
    }
    (void)goe_srif_project(&filter->root, wider->reciprocal, GOE_UNWEIGHTED, ground->by);
    if (goe_filter_traits(filter)->is_ellipse) { /* the depth silences nothing either: as if it were known */
        ground->by[GOE_LOG_DEPTH] = 0.0f;
    }
    const float variance = dot(ground->by, ground->by, 0.0f); /* no difference, which might cancel to 0 */
    ground->if_level = goe_ground_if_level(filter, navigation, variance);
    ground->if_known = 1.0f / variance;
}

/* If a foot lies above the altimeter's zero, either the ground there is higher, or bushes hide the lowest part of the obstacle. No image
 * shows which of the two. */
static float hidden_variance(const goe_filter_t *filter, float scale_m) {
    const float above_m = -filter->state[GOE_GROUND] * scale_m;
    return above_m > 0.0f ? goe_square(above_m) : 0.0f;
}

/* What all quantities share. */
typedef struct {
    const goe_filter_t *filter;
    const goe_motion_t *motion;
    const goe_shape_t *shape;
    const widening_t *wider;
    const ground_t *ground;
    drift_t drift;
} finding_t;

/* The scatter widens the sigmas; validity is decided without it, as doubt must not silence an answer. Nor must the ground: it is decided as
 * if that were level, and for the height as if it were known. *error: of the derivatives in shape, which are used up. */
GOE_NOINLINE static void find_quantity(const finding_t *f, int i, goe_quantities_t *q, deviation_t *error) {
    const counted_t counted = counted_of(i, goe_filter_elapsed_s(f->filter, f->motion));
    const float found = has(q, i) ? project(f->filter, f->wider, counted, error) : 0.0f;
    const float growth = depends_on_corner(i) ? f->shape->corner_growth : 1.0f;
    const float by_ground = i == GOE_HEIGHT ? f->ground->if_known : f->ground->if_level;
    const float doubted = by_ground * goe_square(dot(error->by, f->ground->by, 0.0f));
    const float excluded = goe_filter_traits(f->filter)->is_ellipse ? goe_srif_last_variance(error->by) : 0.0f;
    const float given = drift_variance(f->motion, f->drift, f->shape, q->box, i);
    const float hidden = i == GOE_HEIGHT ? hidden_variance(f->filter, f->shape->scale_m) : 0.0f;
    q->value[i] = f->shape->quantity[i].value;
    q->sigma[i] = sqrtf(f->wider->scatter * growth * found + given + hidden);
    q->worked_out[i] = sqrtf(goe_larger(growth * (found - doubted) + given - excluded, 0.0f));
}

/* place: errors of X0 and Z0. */
static void set_quantities(const finding_t *finding, goe_shape_t *shape, goe_quantities_t *q, deviation_t place[2]) {
    deviation_t other;
    memset(&other, 0, sizeof other);
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        deviation_t *error = i <= GOE_Z0 ? &place[i] : &other;
        error->by = shape->quantity[i].by;
        find_quantity(finding, i, q, error);
    }
}

/* Of the middle of the base along a direction, T axes; error->by: where the part of the state goes. But of a box it is the reference
 * point, whose errors along X and Z are known: place. */
/*@ requires \valid_read(filter) && \valid_read(shape) && \valid_read(wider) && \valid_read(place + (0 .. 1));
    requires \valid(error) && \valid(error->by + (0 .. GOE_STATES - 1)); */
static void find_middle(const goe_filter_t *filter, const goe_shape_t *shape, const widening_t *wider,
                        const deviation_t place[2], counted_t along, deviation_t *error) {
    float *by = error->by;
    if (goe_filter_is_box(filter)) {
        const goe_xz_t in_trajectory = {along.x, along.z};
        const goe_xz_t in_axes = goe_xz_into(in_trajectory, filter->axes.turn_cos, filter->axes.turn_sin);
        memset(by, 0, GOE_STATES * sizeof by[0]);
        goe_shape_place(&shape->middle, shape->scale_m, in_axes.x, in_axes.z, by);
        (void)project(filter, wider, along, error);
        return;
    }
    error->augmented = augmented_sum(&place[GOE_X0].augmented, along.x, &place[GOE_Z0].augmented, along.z);
    for (size_t k = GOE_UNWEIGHTED; k < GOE_STATES; k++) {
        by[k] = along.x * place[GOE_X0].by[k] + along.z * place[GOE_Z0].by[k];
    }
}

/* The middle of the base, in north and east. place: errors of X0 and Z0. */
static void set_center(const goe_filter_t *filter, const goe_motion_t *motion, const goe_shape_t *shape, drift_t drift,
                       const widening_t *wider, const deviation_t place[2], goe_quantities_t *q) {
    const goe_xz_t middle = goe_filter_into_trajectory(filter, shape->middle.at);
    const goe_xz_t gone = goe_filter_moved(filter, motion);
    const float elapsed_s = goe_filter_elapsed_s(filter, motion);
    const counted_t to_north = {-motion->heading_sin, motion->heading_cos, elapsed_s};
    const counted_t to_east = {motion->heading_cos, motion->heading_sin, elapsed_s};
    float by[2][GOE_STATES];
    deviation_t north;
    deviation_t east;
    memset(&north, 0, sizeof north);
    memset(&east, 0, sizeof east);
    north.by = by[0];
    east.by = by[1];
    goe_motion_place(motion, middle.x * shape->scale_m + filter->axes.start_dx_m + gone.x,
                     middle.z * shape->scale_m + filter->axes.start_dz_m + gone.z, &q->center_m[0], &q->center_m[1]);
    const float drifted = drift_variance(motion, drift, shape, q->box, GOE_Z0);
    find_middle(filter, shape, wider, place, to_north, &north);
    find_middle(filter, shape, wider, place, to_east, &east);
    q->center_sd_m[0] = sqrtf(covariance_of(wider, &north, &north) + drifted);
    q->center_sd_m[1] = sqrtf(covariance_of(wider, &east, &east) + drifted);
    q->center_ne_m2 = covariance_of(wider, &north, &east);
    if (goe_within(q->center_sd_m[0], METERS_MAX) && goe_within(q->center_sd_m[1], METERS_MAX)) {
        q->known |= GOE_HAS_CENTER;
    }
}

static void set_velocity(const goe_filter_t *filter, const goe_settings_t *settings, const goe_motion_t *motion,
                         const widening_t *wider, goe_quantities_t *q) {
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

/* (R37): the highest point of a roof from above is a far corner, and no image shows how far while one face is visible. */
static void doubt_far_roof(const goe_filter_t *filter, bool highest, goe_shape_t *shape) {
    if (goe_filter_traits(filter)->one_face && (filter->datum.boxes || highest)) {
        const float size_m = goe_larger(shape->quantity[GOE_WIDTH].value, shape->quantity[GOE_LENGTH].value);
        shape->roof_m2 = goe_square(FAR_ROOF * size_m);
    }
}

/* Points of a silhouette do not show that the footprint is no ellipse. */
static void doubt_shape(const goe_filter_t *filter, goe_shape_t *shape) {
    if (goe_filter_traits(filter)->is_ellipse && !goe_filter_by_boxes(filter) && !filter->kind.is_round) {
        shape->place_m2 += goe_square(SHAPE_SHARE * shape->quantity[GOE_WIDTH].value);
    }
}

/* (R31). The near side, which a hazard meets, hardly depends on the depth: there the derivative suffices. */
static float bend_of(const goe_filter_t *filter, bool for_hazard) {
    const bool bends = goe_filter_traits(filter)->is_ellipse && !for_hazard;
    return bends ? goe_footprint_bend(filter) : 1.0f;
}

/* What the answer is less certain by. */
static void widening_of(const goe_filter_t *filter, const goe_settings_t *settings, const goe_motion_t *motion,
                        drift_t drift, goe_shape_t *shape, widening_t *wider) {
    wider->scatter = goe_scatter_factor(filter, goe_gate_repeated(filter, settings->detector.point_correlation));
    goe_srif_reciprocals(&filter->root, wider->reciprocal);
    doubt_shape(filter, shape);
    doubt_far_roof(filter, settings->filter.top_is_highest, shape);
    shape->top_m2 = shape->roof_m2 > 0.0f ? top_variance(motion, drift, shape) : 0.0f;
}

void goe_quantities_find(const goe_filter_t *filter, const goe_settings_t *settings, const goe_motion_t *motion,
                         goe_quantities_t *quantities) {
    goe_quantities_t *q = quantities;
    goe_shape_t shape;
    widening_t wider;
    ground_t ground;
    const finding_t finding = {filter, motion,  &shape,
                               &wider, &ground, drift_of(filter, &settings->navigation, motion)};
    deviation_t place[2];
    q->now = 0;
    q->known = 0;
    q->sigma[GOE_ORIENTATION] = 0.0f;
    q->worked_out[GOE_ORIENTATION] = 0.0f;
    if (!(filter->state[GOE_INVERSE_RANGE] > 0.0f)) {
        return;
    }
    goe_model_shape(filter, &shape);
    widening_of(filter, settings, motion, finding.drift, &shape, &wider);
    wider.bend = bend_of(filter, false);
    ground_of(filter, &settings->navigation, &wider, &ground);
    q->before_m2 = variance_before(filter, &settings->navigation, motion);
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
    set_velocity(filter, settings, motion, &wider, q);
    if ((q->known & GOE_HAS_POSITION) && (!q->box || (q->known & GOE_HAS_LENGTH))) {
        set_center(filter, motion, &shape, finding.drift, &wider, place, q);
    }
}

/* --------------------------------------------------------------------------------------------------------- covariance -- */

static void count_from_datum(goe_shape_t *shape) {
    shape->quantity[GOE_HEIGHT].by[GOE_GROUND] = 0.0f;
    shape->quantity[GOE_HEIGHT].by[GOE_INVERSE_RANGE] += shape->datum_by_range;
}

/* by += factor times the derivatives of one reach, less those of another, of a length in units of Z0. */
static void add_to_footprint(float factor, float scale_m, const goe_support_t *reach, const goe_support_t *less,
                             float by[GOE_STATES]) {
    by[GOE_SHEAR] += factor * (reach->by.shear - (less ? less->by.shear : 0.0f));
    by[GOE_HALF] += factor * (reach->by.half - (less ? less->by.half : 0.0f));
    by[GOE_LOG_DEPTH] += factor * (reach->by.depth - (less ? less->by.depth : 0.0f));
    by[GOE_INVERSE_RANGE] -= factor * scale_m * (reach->reach - (less ? less->reach : 0.0f));
}

/* What decides a warning is the near side, which images show, not the middle, which depends on the depth. The values are those of
 * goe_conflict.c. */
static void meet_near_side(const goe_filter_t *filter, goe_xz_t camera_m, goe_shape_t *shape) {
    goe_aspect_t aspect;
    if (!goe_filter_traits(filter)->is_ellipse) {
        return;
    }
    goe_ellipse_face_camera(filter, camera_m, &aspect);
    const goe_support_t *before = &aspect.before;
    const goe_support_t *across = &aspect.across;
    const goe_xz_t towards = goe_filter_into_trajectory(filter, aspect.towards);
    const float scale_m = shape->scale_m;
    add_to_footprint(scale_m * towards.x, scale_m, before, across, shape->quantity[GOE_X0].by);
    add_to_footprint(scale_m * towards.z, scale_m, before, across, shape->quantity[GOE_Z0].by);
    memset(shape->quantity[GOE_WIDTH].by, 0, sizeof shape->quantity[GOE_WIDTH].by);
    add_to_footprint(2.0f * scale_m, scale_m, across, NULL, shape->quantity[GOE_WIDTH].by);
    shape->quantity[GOE_WIDTH].value = 2.0f * scale_m * across->reach;
}

void goe_quantities_covariance(const goe_filter_t *filter, const goe_settings_t *settings, const goe_motion_t *motion,
                               bool for_hazard, float ahead_s, float covariance[GOE_QUANTITIES][GOE_QUANTITIES]) {
    goe_shape_t shape;
    widening_t wider;
    const drift_t drift = drift_of(filter, &settings->navigation, motion);
    goe_model_shape(filter, &shape);
    if (for_hazard) {
        count_from_datum(&shape);
        meet_near_side(filter, goe_filter_measured(filter), &shape);
    }
    widening_of(filter, settings, motion, drift, &shape, &wider);
    wider.bend = bend_of(filter, for_hazard);
    const float scatter = sqrtf(wider.scatter);
    const float corner = sqrtf(shape.corner_growth) * scatter;
    const float elapsed_s = goe_filter_elapsed_s(filter, motion) + ahead_s;
    deviation_t error[GOE_QUANTITIES];
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        float *by = shape.quantity[i].by;
        error[i].by = by;
        (void)project(filter, &wider, counted_of(i, elapsed_s), &error[i]);
        const float factor = depends_on_corner(i) ? corner : scatter;
        for (int k = 0; k < GOE_STATES; k++) {
            by[k] *= factor;
        }
        augmented_scale(&error[i].augmented, factor);
        for (int j = 0; j <= i; j++) {
            const float drifted = i == j ? drift_variance(motion, drift, &shape, goe_filter_is_box(filter), i) : 0.0f;
            const float shared = drifted + goe_srif_augmented_dot(error[i].augmented.part, error[j].augmented.part);
            const float sum = dot(by, shape.quantity[j].by, shared);
            covariance[i][j] = sum;
            covariance[j][i] = sum;
        }
    }
    if (!for_hazard) { /* the camera now has no part in it */
        const float before = variance_before(filter, &settings->navigation, motion);
        covariance[GOE_X0][GOE_X0] += before;
        covariance[GOE_Z0][GOE_Z0] += before;
        covariance[GOE_HEIGHT][GOE_HEIGHT] += hidden_variance(filter, shape.scale_m);
    }
}

#endif
