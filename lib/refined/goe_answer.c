/* Quantities, their derivatives by the state, and when they are known well enough. SPDX-License-Identifier: MIT */
#include "refined/goe_answer.h"

#include <math.h>
#include <string.h>

#include "maths/goe_angle.h"
#include "maths/goe_scalar.h"
#include "refined/goe_box.h"
#include "refined/goe_chord.h"
#include "refined/goe_refined.h"

#define RANGE_SHARE 0.25f   /* sigma over value up to which the range is told */
#define EXTENT_SHARE 0.3f   /* ... width, length and height */
#define HEIGHT_LEAST_M 2.0f /* a lower obstacle's height may be off by the share of this */
#define ORIENTATION_MOST_RAD 0.174532925f
#define SUSPECT_IMAGES 8 /* fewer say nothing */
#define EARLY 4.0f
#define EARLY_MOST 4.0f
#define PATH_LEAST_M 0.1f
#define S_PER_US 1.0e-6f
#define TIME_MOST_US 4000000000u
#define METRES_MOST 1.0e6f
#define VARIANCE_LEAST 1.0e-30f
#define CHORD_SHARE 0.25f /* of a chord's width by which its middle may lie beside the obstacle's centre */
/* a box that was found by its outline: corners change unnoticed for some images */
#define OUTLINE_IMAGES 10
#define OUTLINE_LEVEL 1.8f /* mean NIS over rows up to which it is told */
#define OUTLINE_RAD 0.025f
#define OUTLINE_SHARE 0.03f /* of width and length together */
#define SINE2_LEAST 1.0e-6f

/* A place seen from above, in the state's axes and units of Z0, with its derivatives by GOE_SX, GOE_FX, GOE_D; that of x by
 * GOE_A is 1. */
typedef struct {
    float x, z;
    float x_by[3], z_by[3];
} spot_t;

/* A vector along an edge. */
typedef struct {
    float x, z;
} axis_t;

/* The answer in numbers. side, front: as the state has them; the answer may call them by each other's names. */
typedef struct {
    float value[GOE_QUANTITIES];
    float scale_m;            /* 1/GOE_Q: the unit of the state */
    float start, e, height_m; /* GOE_A, GOE_E, GOE_DH */
    bool box, exchanged;
    bool disc;                /* under the condition that its skew is 0 */
    float place_m2;           /* variance of the centre beyond that of the state */
    float turn_cos, turn_sin; /* from T to the state's axes */
    goe_depth_t depth;
    float sx, fx, side, front; /* lengths of the edges, units of scale_m */
    spot_t reference;
    axis_t length_axis; /* unit vector, T axes; along the edge that the answer calls side */
} answer_t;

static float sign_of(float x) { return x > 0.0f ? 1.0f : -1.0f; }

/* Out of the state's axes into T's. */
static axis_t into_trajectory(const goe_filter_t *filter, float x, float z) {
    const float c = filter->turn_cos;
    const float s = filter->turn_sin;
    const axis_t axis = {c * x + s * z, c * z - s * x};
    return axis;
}

/* GOE_A, 1 and across fronts and along sides from there. */
static spot_t spot_of(const answer_t *a, float across, float along) {
    spot_t spot;
    const float sign = sign_of(a->sx);
    const float both = along - across * sign;
    spot.x = a->start + across * a->fx + along * a->sx;
    spot.z = 1.0f - across * sign * a->depth.front + along * a->depth.side;
    spot.x_by[0] = along;
    spot.x_by[1] = across;
    spot.x_by[2] = 0.0f;
    spot.z_by[0] = both * a->depth.by_extents[0];
    spot.z_by[1] = both * a->depth.by_extents[1];
    spot.z_by[2] = along * a->depth.side_by_d - across * sign * a->depth.front_by_d;
    return spot;
}

/* Front and side keep their names until the side lies clearly across T's Z. */
static void name_edges(goe_filter_t *filter) {
    const goe_depth_t depth = goe_box_depth(filter->state);
    const float sx = filter->state[GOE_SX];
    const float fx = filter->state[GOE_FX];
    const axis_t side = filter->exchanged ? into_trajectory(filter, fx, -sign_of(sx) * depth.front)
                                          : into_trajectory(filter, sx, depth.side);
    const float slope = filter->named ? GOE_EXCHANGE_SLOPE : 1.0f;
    if (goe_absolute(side.x) > slope * goe_absolute(side.z)) {
        filter->exchanged = !filter->exchanged;
    }
    filter->named = true;
}

static void solve_box(const goe_filter_t *filter, answer_t *a) {
    const float sx = a->sx;
    const float fx = a->fx;
    a->depth = goe_box_depth(filter->state);
    a->side = sqrtf(sx * sx + a->depth.side * a->depth.side);
    a->front = sqrtf(fx * fx + a->depth.front * a->depth.front);
    const axis_t side = into_trajectory(filter, sx, a->depth.side);
    const axis_t front = into_trajectory(filter, fx, -sign_of(sx) * a->depth.front);
    const float away = front.z < 0.0f ? 1.0f : -1.0f; /* the end of the front from which it leads away */
    a->exchanged = filter->exchanged;
    a->reference = a->exchanged ? spot_of(a, 0.5f * away, 0.5f) : spot_of(a, 0.0f, 0.0f);
    const float length = a->exchanged ? -away * a->front : (side.z < 0.0f ? -a->side : a->side);
    a->length_axis.x = (a->exchanged ? front.x : side.x) / length;
    a->length_axis.z = (a->exchanged ? front.z : side.z) / length;
    a->value[GOE_ORIENTATION] = goe_arctan_rad(a->length_axis.x, a->length_axis.z);
    a->value[GOE_WIDTH] = a->scale_m * (a->exchanged ? a->side : a->front);
    a->value[GOE_LENGTH] = a->scale_m * (a->exchanged ? a->front : a->side);
}

static float skew_variance(const goe_filter_t *filter) {
    return goe_larger(goe_inverse_variance(&filter->inverse, GOE_SX), VARIANCE_LEAST);
}

/* A disc has no skew: the state under that condition. */
static void leave_skew(const goe_filter_t *filter, float x[GOE_STATES]) {
    const float *v = filter->inverse.element;
    const float share = x[GOE_SX] / skew_variance(filter);
    for (size_t i = 0; i < GOE_STATES; i++) {
        float with_skew = 0.0f;
        for (size_t j = i > GOE_SX ? i : GOE_SX; j < GOE_STATES; j++) {
            with_skew += v[goe_inverse_column(j) + i] * v[goe_inverse_column(j) + GOE_SX];
        }
        x[i] -= with_skew * share;
    }
}

static void solve(const goe_filter_t *filter, answer_t *a) {
    float x[GOE_STATES];
    memset(a, 0, sizeof *a);
    memcpy(x, filter->state, sizeof x);
    a->box = filter->phase == GOE_PHASE_BOX;
    a->disc = filter->phase == GOE_PHASE_DISC;
    if (a->disc) {
        leave_skew(filter, x);
    }
    a->scale_m = 1.0f / x[GOE_Q];
    a->start = x[GOE_A];
    a->height_m = x[GOE_DH];
    a->turn_cos = filter->turn_cos;
    a->turn_sin = filter->turn_sin;
    a->sx = x[GOE_SX];
    a->fx = x[GOE_FX];
    a->e = x[GOE_E];
    a->length_axis.z = 1.0f;
    if (a->box) {
        solve_box(filter, a);
    } else {
        a->reference = spot_of(a, 0.0f, 0.0f);
        a->value[GOE_WIDTH] = a->fx * a->scale_m;
    }
    if (filter->phase == GOE_PHASE_CHORD) {
        const float beside_m = CHORD_SHARE * a->value[GOE_WIDTH];
        a->place_m2 = beside_m * beside_m;
    }
    const axis_t place = into_trajectory(filter, a->reference.x, a->reference.z);
    a->value[GOE_X0] = place.x * a->scale_m;
    a->value[GOE_Z0] = place.z * a->scale_m;
    a->value[GOE_HEIGHT] = a->e * a->scale_m + a->height_m;
}

/* -------------------------------------------------------------------------------------------------------- derivatives -- */

/* Of by_x X + by_z Z of a spot, metres, X and Z in the state's axes. */
static void differentiate_spot(const answer_t *a, const spot_t *spot, float by_x, float by_z,
                               float weight[GOE_STATES]) {
    weight[GOE_A] = by_x * a->scale_m;
    weight[GOE_Q] = -a->scale_m * a->scale_m * (by_x * spot->x + by_z * spot->z);
    for (size_t i = 0; i < 3; i++) {
        weight[GOE_SX + i] = a->scale_m * (by_x * spot->x_by[i] + by_z * spot->z_by[i]);
    }
}

/* Of the length of an edge, metres: its own extent across, which is state `extent`, and its depth. */
static void differentiate_edge(const answer_t *a, bool side, float weight[GOE_STATES]) {
    const float length = side ? a->side : a->front;
    const float across = side ? a->sx : a->fx;
    const float by_depth = (side ? a->depth.side : a->depth.front) / length * a->scale_m;
    weight[GOE_SX] = by_depth * a->depth.by_extents[0];
    weight[GOE_FX] = by_depth * a->depth.by_extents[1];
    weight[GOE_D] = by_depth * (side ? a->depth.side_by_d : a->depth.front_by_d);
    weight[side ? GOE_SX : GOE_FX] += across / length * a->scale_m;
    weight[GOE_Q] = -a->scale_m * a->scale_m * length;
}

/* Both edges turn together. */
static void differentiate_orientation(const answer_t *a, float weight[GOE_STATES]) {
    const float scale = 1.0f / (a->side * a->side);
    const float by_depth = -a->sx * scale;
    weight[GOE_SX] = a->depth.side * scale + by_depth * a->depth.by_extents[0];
    weight[GOE_FX] = by_depth * a->depth.by_extents[1];
    weight[GOE_D] = by_depth * a->depth.side_by_d;
}

/* Derivatives of a quantity by the states. */
static void differentiate(const answer_t *a, int quantity, float weight[GOE_STATES]) {
    for (size_t i = 0; i < GOE_STATES; i++) {
        weight[i] = 0.0f;
    }
    switch (quantity) {
        case GOE_X0:
            differentiate_spot(a, &a->reference, a->turn_cos, a->turn_sin, weight);
            break;
        case GOE_Z0:
            differentiate_spot(a, &a->reference, -a->turn_sin, a->turn_cos, weight);
            break;
        case GOE_HEIGHT:
            weight[GOE_Q] = -a->scale_m * a->scale_m * a->e;
            weight[GOE_DH] = 1.0f;
            weight[GOE_E] = a->scale_m;
            break;
        case GOE_WIDTH:
            if (!a->box) {
                weight[GOE_Q] = -a->scale_m * a->value[GOE_WIDTH];
                weight[GOE_FX] = a->scale_m;
                break;
            }
            differentiate_edge(a, a->exchanged, weight);
            break;
        default:
            if (a->box && quantity == GOE_LENGTH) {
                differentiate_edge(a, !a->exchanged, weight);
            } else if (a->box) {
                differentiate_orientation(a, weight);
            }
            break;
    }
}

/* Constant velocity errors scale and turn the flown path, and the obstacle with it: no image shows that. */
typedef struct {
    float share; /* of lengths, and rad */
    float walk_m2;
} drift_t;

static drift_t drift_of(const goe_estimator_t *estimator) {
    const goe_noise_t *noise = &estimator->settings.noise;
    const uint64_t us = (uint64_t)estimator->time_us - (uint64_t)estimator->start_time_us;
    const float s = (float)(uint32_t)(us < TIME_MOST_US ? us : TIME_MOST_US) * S_PER_US;
    const float path_m = sqrtf(goe_square(estimator->dx_m) + goe_square(estimator->dz_m));
    const drift_t drift = {noise->velocity_bias_m_s * s / (path_m > PATH_LEAST_M ? path_m : PATH_LEAST_M),
                           goe_square(noise->position_walk_m) * s};
    return drift;
}

static float drift_variance(const goe_estimator_t *estimator, drift_t drift, const answer_t *a, int quantity) {
    const float share2 = goe_square(drift.share);
    switch (quantity) {
        case GOE_X0:
        case GOE_Z0:
            return share2 * goe_square(a->value[GOE_Z0]) + drift.walk_m2 + a->place_m2;
        case GOE_ORIENTATION:
            return a->box ? share2 : 0.0f;
        case GOE_HEIGHT:
            return share2 *
                   goe_larger(goe_square(a->value[GOE_HEIGHT]), goe_square(a->value[GOE_HEIGHT] - estimator->height_m));
        default:
            return share2 * goe_square(a->value[quantity]);
    }
}

/* Orientation, width and length hang on the square of the box's corner: while GOE_D is not known well, more than their
 * derivatives tell. */
static float find_early_factor(const goe_filter_t *filter, const answer_t *a) {
    if (!a->box) {
        return 1.0f;
    }
    const float relative = goe_inverse_variance(&filter->inverse, GOE_D) / goe_square(a->depth.sum);
    return 1.0f + EARLY * (relative < EARLY_MOST ? relative : EARLY_MOST);
}

static bool hangs_on_corner(int quantity) { return quantity >= GOE_ORIENTATION && quantity <= GOE_LENGTH; }

/* Derivative in terms of independent unit errors: its squared norm is the variance. */
static void project(const goe_filter_t *filter, const answer_t *a, const float weight[GOE_STATES],
                    float projected[GOE_STATES]) {
    const float *v = filter->inverse.element;
    float along = 0.0f;
    goe_srif_project(&filter->inverse, weight, projected);
    if (!a->disc) {
        return;
    }
    for (size_t j = GOE_SX; j < GOE_STATES; j++) {
        along += projected[j] * v[goe_inverse_column(j) + GOE_SX];
    }
    along = along / skew_variance(filter);
    for (size_t j = GOE_SX; j < GOE_STATES; j++) {
        projected[j] -= along * v[goe_inverse_column(j) + GOE_SX];
    }
}

static float variance_of(const goe_filter_t *filter, const answer_t *a, const float weight[GOE_STATES]) {
    float projected[GOE_STATES];
    float sum = 0.0f;
    if (!a->disc) {
        return goe_srif_variance(&filter->inverse, weight);
    }
    project(filter, a, weight, projected);
    for (size_t j = 0; j < GOE_STATES; j++) {
        sum += projected[j] * projected[j];
    }
    return sum;
}

/* Of a box that was found by its outline. Of its side, seen at a small angle, only the product of length and angle shows. */
static float outline_variance(const goe_estimator_t *estimator, const answer_t *a, int quantity,
                              float orientation_rad2) {
    const goe_filter_t *filter = &estimator->filter;
    if (!a->box || !filter->outline || !hangs_on_corner(quantity)) {
        return 0.0f;
    }
    if (quantity == GOE_ORIENTATION) {
        return goe_square(OUTLINE_RAD);
    }
    const float size2 = goe_square(OUTLINE_SHARE * (a->value[GOE_WIDTH] + a->value[GOE_LENGTH]));
    if ((quantity == GOE_LENGTH) == a->exchanged) { /* the front of the state */
        return size2;
    }
    const float vx = a->sx / a->side;
    const float vz = a->depth.side / a->side;
    const float px = a->start - estimator->dx_m / a->scale_m;
    const float pz = 1.0f - estimator->dz_m / a->scale_m;
    const float beside = goe_larger(goe_absolute(vz * px - vx * pz) - 0.5f * a->fx / vz, 0.0f);
    const float sine2 = goe_square(beside) / (px * px + pz * pz);
    return size2 + goe_square(a->value[quantity]) * orientation_rad2 / (sine2 + SINE2_LEAST);
}

/* Within a share of the value, and finite, by the bits. */
static bool is_known(float value, float sigma, float least, float share) {
    const float size = goe_larger(goe_absolute(value), least);
    return goe_within(value, METRES_MOST) && goe_within(size, METRES_MOST) && goe_within(sigma, share * size);
}

static void tell_motion(const goe_estimator_t *estimator, goe_estimate_t *estimate) {
    estimate->x_m = estimate->x0_m - estimator->dx_m;
    estimate->z_m = estimate->z0_m - estimator->dz_m;
    estimate->sigma.x_m = estimate->sigma.x0_m;
    estimate->sigma.z_m = estimate->sigma.z0_m;
    estimate->baseline_m = sqrtf(goe_square(estimator->dx_m) + goe_square(estimator->dz_m));
}

static void tell_axes(const answer_t *a, goe_estimate_t *estimate) {
    estimate->other_side_deg = goe_fold_deg(estimate->orientation_deg + 90.0f);
    estimate->orientation_raw_deg = estimate->orientation_deg;
    estimate->length_axis[0] = a->length_axis.x;
    estimate->length_axis[1] = a->length_axis.z;
    estimate->width_axis[0] = a->length_axis.z;
    estimate->width_axis[1] = -a->length_axis.x;
}

/* The middle of the base: half a side behind the front. */
static void tell_center(const goe_estimator_t *estimator, const answer_t *a, goe_estimate_t *estimate) {
    const goe_filter_t *filter = &estimator->filter;
    float weight[GOE_STATES] = {0.0f};
    float sigma[2];
    const spot_t middle = spot_of(a, 0.0f, a->box ? 0.5f : 0.0f);
    const axis_t place = into_trajectory(filter, middle.x, middle.z);
    const drift_t drift = drift_of(estimator);
    /* from the state's axes to north: the heading of T and the turn */
    const float c = estimator->heading_cos * a->turn_cos - estimator->heading_sin * a->turn_sin;
    const float s = estimator->heading_sin * a->turn_cos + estimator->heading_cos * a->turn_sin;
    goe_answer_place(estimator, place.x * a->scale_m + filter->start_dx_m, place.z * a->scale_m + filter->start_dz_m,
                     &estimate->center_north_m, &estimate->center_east_m);
    for (int i = 0; i < 2; i++) {
        differentiate_spot(a, &middle, i == 0 ? -s : c, i == 0 ? c : s, weight);
        sigma[i] = sqrtf(variance_of(filter, a, weight) + drift_variance(estimator, drift, a, GOE_Z0));
    }
    if (goe_within(sigma[0], METRES_MOST) && goe_within(sigma[1], METRES_MOST)) {
        estimate->sigma.center_north_m = sigma[0];
        estimate->sigma.center_east_m = sigma[1];
        estimate->valid |= GOE_HAS_CENTER;
    } else {
        estimate->center_north_m = 0.0f;
        estimate->center_east_m = 0.0f;
    }
}

static bool is_extent(float value, float sigma, float least) {
    return value > 0.0f && is_known(value, sigma, least, EXTENT_SHARE);
}

/* Which of the quantities this image knows well enough. */
static unsigned known_now(const goe_filter_t *filter, const answer_t *a, const float sigma[GOE_QUANTITIES]) {
    const float *value = a->value;
    unsigned known = 0;
    if (!(goe_within(value[GOE_X0] + filter->start_dx_m, METRES_MOST) &&
          goe_within(value[GOE_Z0] + filter->start_dz_m, METRES_MOST) &&
          goe_within(sigma[GOE_X0], RANGE_SHARE * value[GOE_Z0]) &&
          is_known(value[GOE_Z0], sigma[GOE_Z0], 0.0f, RANGE_SHARE))) {
        return known;
    }
    known |= GOE_HAS_POSITION;
    if (is_extent(value[GOE_HEIGHT], sigma[GOE_HEIGHT], HEIGHT_LEAST_M)) {
        known |= GOE_HAS_HEIGHT;
    }
    if (a->box && filter->outline && (filter->since < OUTLINE_IMAGES || filter->level > OUTLINE_LEVEL)) {
        return known;
    }
    if ((a->box || !filter->stand_in) && is_extent(value[GOE_WIDTH], sigma[GOE_WIDTH], 0.0f)) {
        known |= GOE_HAS_WIDTH;
    }
    if (a->box && filter->deep && is_extent(value[GOE_LENGTH], sigma[GOE_LENGTH], 0.0f)) {
        known |= GOE_HAS_LENGTH;
    }
    if (a->box && goe_within(sigma[GOE_ORIENTATION], ORIENTATION_MOST_RAD)) {
        known |= GOE_HAS_ORIENTATION;
    }
    return known;
}

static void tell_quantities(const goe_estimator_t *estimator, const answer_t *a, const float sigma[GOE_QUANTITIES],
                            unsigned known, goe_estimate_t *estimate) {
    const float *value = a->value;
    estimate->model = a->box ? GOE_MODEL_BOX : GOE_MODEL_DISC;
    estimate->fresh = true;
    estimate->valid = known;
    estimate->x0_m = value[GOE_X0] + estimator->filter.start_dx_m;
    estimate->z0_m = value[GOE_Z0] + estimator->filter.start_dz_m;
    estimate->sigma.x0_m = sigma[GOE_X0];
    estimate->sigma.z0_m = sigma[GOE_Z0];
    tell_motion(estimator, estimate);
    if (known & GOE_HAS_WIDTH) {
        estimate->width_m = value[GOE_WIDTH];
        estimate->sigma.width_m = sigma[GOE_WIDTH];
    }
    if (known & GOE_HAS_LENGTH) {
        estimate->length_m = value[GOE_LENGTH];
        estimate->sigma.length_m = sigma[GOE_LENGTH];
    }
    if (known & GOE_HAS_HEIGHT) {
        estimate->height_m = value[GOE_HEIGHT];
        estimate->sigma.height_m = sigma[GOE_HEIGHT];
    }
    if (known & GOE_HAS_ORIENTATION) {
        estimate->orientation_deg = goe_fold_deg(value[GOE_ORIENTATION] * GOE_DEG_PER_RAD);
        estimate->sigma.orientation_deg = sigma[GOE_ORIENTATION] * GOE_DEG_PER_RAD;
        tell_axes(a, estimate);
    }
    if (!a->box || (known & GOE_HAS_LENGTH)) {
        tell_center(estimator, a, estimate);
    }
}

/* A disc was asked for, and it is none. */
static bool is_forced(const goe_filter_t *filter, const goe_settings_t *settings) {
    return settings->model == GOE_MODEL_DISC && filter->phase == GOE_PHASE_DISC && goe_chord_is_skewed(filter);
}

void goe_answer_residuals(const goe_estimator_t *estimator, goe_estimate_t *estimate) {
    const goe_filter_t *filter = &estimator->filter;
    estimate->suspect = (filter->images >= SUSPECT_IMAGES && filter->misfit > estimator->settings.misfit_max) ||
                        filter->base_refused || is_forced(filter, &estimator->settings);
    if (estimate->method == GOE_METHOD_REFINED) {
        estimate->points = filter->images;
        estimate->nis = filter->nis;
        estimate->nis_rows = filter->nis_rows;
        estimate->misfit = filter->misfit;
    }
}

/* What the filter knows well enough now and knew in the image before: one image alone may be lucky, as sigma and value come
 * from the same linearisation. */
static unsigned find_quantities(goe_estimator_t *estimator, answer_t *a, float sigma[GOE_QUANTITIES]) {
    goe_filter_t *filter = &estimator->filter;
    float weight[GOE_STATES];
    if (filter->phase == GOE_PHASE_BOX) {
        name_edges(filter);
    }
    solve(filter, a);
    if (!(filter->state[GOE_Q] > 0.0f) || !(a->scale_m > 0.0f)) {
        filter->known = 0;
        return 0;
    }
    const drift_t drift = drift_of(estimator);
    const float early = find_early_factor(filter, a);
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        differentiate(a, i, weight);
        const float variance = variance_of(filter, a, weight) * (hangs_on_corner(i) ? early : 1.0f) +
                               drift_variance(estimator, drift, a, i);
        sigma[i] = sqrtf(variance + outline_variance(estimator, a, i, goe_square(sigma[GOE_ORIENTATION])));
    }
    const unsigned now = known_now(filter, a, sigma);
    const unsigned known = now & filter->known;
    filter->known = (uint8_t)now;
    return known;
}

bool goe_answer_tell(goe_estimator_t *estimator, goe_estimate_t *estimate) {
    answer_t a;
    float sigma[GOE_QUANTITIES] = {0.0f};
    const unsigned known = find_quantities(estimator, &a, sigma);
    const bool is_known = (known & GOE_HAS_POSITION) != 0;
    if (is_known || !(estimate->valid & GOE_HAS_POSITION)) {
        memset(estimate, 0, sizeof *estimate);
        estimate->method = GOE_METHOD_REFINED;
    }
    if (is_known) {
        tell_quantities(estimator, &a, sigma, known, estimate);
    }
    return is_known;
}

void goe_answer_covariance(const goe_estimator_t *estimator, goe_zero_t zero,
                           float covariance[GOE_QUANTITIES][GOE_QUANTITIES]) {
    float weight[GOE_STATES];
    float root[GOE_QUANTITIES][GOE_STATES];
    answer_t a;
    solve(&estimator->filter, &a);
    const drift_t drift = drift_of(estimator);
    const float early = sqrtf(find_early_factor(&estimator->filter, &a));
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        differentiate(&a, i, weight);
        if (zero == GOE_FROM_DATUM && i == GOE_HEIGHT) {
            weight[GOE_DH] = 0.0f;
        }
        project(&estimator->filter, &a, weight, root[i]);
        const float factor = hangs_on_corner(i) ? early : 1.0f;
        for (int k = 0; k < GOE_STATES; k++) {
            root[i][k] *= factor;
        }
        for (int j = 0; j <= i; j++) {
            float sum = i == j ? drift_variance(estimator, drift, &a, i) : 0.0f;
            for (int k = 0; k < GOE_STATES; k++) {
                sum += root[i][k] * root[j][k];
            }
            covariance[i][j] = sum;
            covariance[j][i] = sum;
        }
        covariance[i][i] += outline_variance(estimator, &a, i, covariance[GOE_ORIENTATION][GOE_ORIENTATION]);
    }
}
