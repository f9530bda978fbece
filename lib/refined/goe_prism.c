/* Start, rows and quantities of a prism. SPDX-License-Identifier: MIT */
#include "refined/goe_prism.h"

#include <math.h>
#include <string.h>

#include "image/goe_camera.h"
#include "maths/goe_angle.h"
#include "maths/goe_exp.h"
#include "maths/goe_scalar.h"
#include "refined/goe_side_memory.h"
#include "refined/goe_touch.h"

#if GOE_WITH_FILTER

#define RAY_AHEAD_MIN 0.02f    /* third component of a ray that is faced */
#define DEPTH_MAX 2.0f         /* |d|, and its sigma in (R33): 7 times as deep as wide, or as flat */
#define SHIFT_RATIO_MAX 300.0f /* of a shift that rows share, over a row's own noise */
#define GROUND_SIGMAS 3.0f     /* by which the foot must lie below the horizon to give the range */
#define FOOT_SHARE 0.6f        /* of box_noise_rel of the width, in that sigma */
#define NEAR_SIDE 0.5f         /* the foot is nearer than the middle by half the width */
#define RANGE_MIN_M 1.0f       /* of a first guess */
#define RANGE_MAX_M 1.0e6f     /* the same */
#define NO_ALTIMETER_M 50.0f   /* sigma of the height from which on the first box sets it */
#define HALF_FREEDOM 2.5f      /* one sigma of the first guess of the half width, in widths */
#define SHEAR_FREEDOM 0.6f     /* ... of the shear, in half widths */
#define DEPTH_FREEDOM 1.0f   /* ... of the log of the depth: a population of masts, cars and houses, in any direction */
#define DEPTH_TURNED 0.3f    /* sine of the turn of the line of sight from which on images give the depth */
#define BENT_MIN 0.01f       /* sigma of the log of the depth below which its exponential is a line */
#define DISC_FREEDOM 1.0e-3f /* of shear and depth, where a disc is configured */
#define NEAR_MIN 1.0e-9f     /* of the half width, and of the distance, units of Z0 */
#define GROUND_MIN 1.0e-6f   /* one sigma of the ground's offset, units of Z0 */
#define BOX_SIZE_MIN 1.0e-12f /* of a box, angular: a smaller one gives no range */

GOE_STATIC_ASSERT(sizeof(((goe_filter_t *)0)->side) == GOE_BOX_SIDES * sizeof(goe_side_memory_t),
                  every_side_has_a_memory);

/* -------------------------------------------------------------------------------------------------------------- rows -- */

static void set_footprint(const float x[GOE_STATES], goe_ellipse_t *footprint) {
    footprint->half = x[GOE_PRISM_HALF];
    footprint->shear = x[GOE_PRISM_SHEAR];
    footprint->depth = footprint->half * goe_exp(x[GOE_PRISM_DEPTH]);
}

/*@ requires goe_observation_is_open(obs) && \valid(o); */
static void describe(const goe_observation_t *obs, goe_solid_t *o) {
    o->center = goe_observation_reference(obs);
    set_footprint(obs->state, &o->ellipse);
    o->corners = 0;
    goe_touch_open(obs, obs->steady_height_m, o);
}

/* The box's size along a side's coordinate, focal lengths: as measured, or as predicted. */
/*@ requires goe_observation_is_open(obs) && side < GOE_BOX_SIDES; */
static float size_of(const goe_observation_t *obs, size_t side) {
    const float *x = obs->state;
    return goe_touch_size(obs, side, goe_touch_is_level(side) ? x[GOE_TOP] + x[GOE_GROUND] : 2.0f * x[GOE_PRISM_HALF]);
}

/* (R29). */
/*@ requires goe_observation_is_open(obs) && goe_solid_is_closed(o) && goe_rows_hold(rows);
    requires side < GOE_BOX_SIDES && rows->count < GOE_ROWS_MAX; */
static void add_side(const goe_observation_t *obs, const goe_solid_t *o, size_t side, goe_rows_t *rows) {
    goe_touch_t t;
    goe_gradient_t g;
    const float variance = goe_touch_white_variance(obs, side, size_of(obs, side));
    float *by = goe_touch_add(rows, obs, o, side, variance, &t, &g);
    if (by == NULL) {
        return;
    }
    const float outward = g.x * t.outward.x + g.z * t.outward.z;
    const float per_reach = outward / t.reach.length;
    goe_rows_place(by, obs, g.x, g.z);
    by[GOE_INVERSE_RANGE] += g.y * obs->steady_height_m;
    by[GOE_PRISM_SHEAR] = per_reach * t.reach.across * t.outward.z;
    by[GOE_PRISM_HALF] = per_reach * (t.reach.across * t.outward.x + t.reach.along * t.reach.along / o->ellipse.half);
    by[GOE_PRISM_DEPTH] = per_reach * t.reach.along * t.reach.along;
    const float shift = -obs->position_sd * obs->state[GOE_INVERSE_RANGE];
    float *common = rows->shift[rows->count - 1u];
    common[0] = shift * g.x;
    common[1] = shift * g.y;
    common[2] = shift * g.z;
}

void goe_prism_rows(const goe_observation_t *obs, goe_rows_t *rows) {
    goe_solid_t ellipse;
    describe(obs, &ellipse);
    rows->shifts = obs->position_sd > 0.0f;
    for (size_t side = 0; side < GOE_BOX_SIDES; side++) {
        add_side(obs, &ellipse, side, rows);
    }
}

/* ------------------------------------------------------------------------------------------------------ sides' errors -- */

void goe_prism_recall(goe_filter_t *filter, const goe_observation_t *obs, goe_rows_t *rows) {
    const goe_detector_t *detector = &obs->settings->detector;
    for (size_t side = 0; side < GOE_BOX_SIDES; side++) {
        goe_side_memory_fade(&filter->side[side], obs->fade, goe_square(detector->box_noise_rel * size_of(obs, side)));
    }
    for (size_t i = 0; i < rows->count; i++) {
        goe_side_memory_recall(&filter->side[rows->side[i]], rows->matrix->row[i], &rows->variance[i]);
    }
}

/*@ requires goe_rows_hold(rows) && a < GOE_BOX_SIDES && b < GOE_BOX_SIDES; */
static float shared_shift(const goe_rows_t *rows, size_t a, size_t b) {
    const float *v = rows->shift[a];
    const float *w = rows->shift[b];
    return rows->shifts ? v[0] * w[0] + v[1] * w[1] + v[2] * w[2] : 0.0f;
}

/* What a row counts: I + N has lost the 1, a row's own noise, among float's 24 bits where the shift is thousands of times that noise,
 * and rows would come out far too certain, or infinite. Such a row counts as if its noise were larger. */
/*@ requires goe_rows_hold(rows) && i < GOE_BOX_SIDES; */
static float share_of(const goe_rows_t *rows, size_t i) {
    const float shift = goe_square(rows->weight[i]) * shared_shift(rows, i, i);
    return shift > SHIFT_RATIO_MAX * SHIFT_RATIO_MAX ? SHIFT_RATIO_MAX / sqrtf(shift) : 1.0f;
}

/* Rows of unit noise that share a shift: their covariance is I + N; times the inverse of its Cholesky root they share none. */
/*@ requires goe_rows_hold(rows) && rows->count <= GOE_BOX_SIDES; */
static void free_of_shift(goe_rows_t *rows) {
    float root[GOE_BOX_SIDES][GOE_BOX_SIDES];
    for (size_t i = 0; i < rows->count; i++) {
        float *row = rows->matrix->row[i];
        const float share = share_of(rows, i);
        rows->weight[i] *= share;
        for (size_t j = 0; j <= i; j++) {
            float sum = (i == j ? 1.0f : 0.0f) + rows->weight[i] * rows->weight[j] * shared_shift(rows, i, j);
            for (size_t k = 0; k < j; k++) {
                sum -= root[i][k] * root[j][k];
            }
            root[i][j] = i == j ? sqrtf(sum) : sum / root[j][j];
        }
        for (size_t c = 0; c < GOE_COLUMNS; c++) {
            row[c] *= share;
            for (size_t j = 0; j < i; j++) {
                row[c] -= root[i][j] * rows->matrix->row[j][c];
            }
            row[c] = row[c] / root[i][i];
        }
    }
}

void goe_prism_learn(goe_filter_t *filter, goe_rows_t *rows) {
    const float white = rows->white_rad;
    for (size_t i = 0; i < rows->count; i++) {
        const float *row = rows->matrix->row[i];
        const float weight = rows->weight[i];
        const float attitude = white * white * (row[0] * row[0] + row[1] * row[1] + row[2] * row[2]);
        goe_side_memory_learn(&filter->side[rows->side[i]], row, weight,
                              attitude + weight * weight * shared_shift(rows, i, i));
    }
    if (rows->shifts) {
        free_of_shift(rows);
    }
}

void goe_prism_follow(goe_filter_t *filter, const float change[GOE_UNKNOWNS]) {
    float *depth = &filter->state[GOE_PRISM_DEPTH];
    for (size_t side = 0; side < GOE_BOX_SIDES; side++) {
        goe_side_memory_follow(&filter->side[side], change);
    }
    *depth = *depth > DEPTH_MAX ? DEPTH_MAX : (*depth > -DEPTH_MAX ? *depth : -DEPTH_MAX);
}

/* -------------------------------------------------------------------------------------------------------------- start -- */

/* Aligned ray, in the state's axes, of the raw point (x, y) focal lengths. False if it does not point ahead. */
static bool ray_of(const goe_camera_t *camera, const float camera_to_axes[9], float x, float y, goe_point_t *ray) {
    float undistorted[2] = {x, y};
    if (goe_camera_distorts(camera) && !goe_camera_undistort(camera, &undistorted[0], &undistorted[1])) {
        return false;
    }
    const float *r = camera_to_axes;
    const float z = r[6] * undistorted[0] + r[7] * undistorted[1] + r[8];
    ray->usable = z > RAY_AHEAD_MIN;
    const float ahead = ray->usable ? z : 1.0f;
    ray->x = (r[0] * undistorted[0] + r[1] * undistorted[1] + r[2]) / ahead;
    ray->y = (r[3] * undistorted[0] + r[4] * undistorted[1] + r[5]) / ahead;
    return ray->usable;
}

/* Of the visible part of the box. */
static void middle_of(const goe_camera_t *camera, const goe_sides_t *sides, float *x, float *y) {
    *x =
        0.5f * (goe_touch_coordinate(camera, sides, GOE_BOX_LEFT) + goe_touch_coordinate(camera, sides, GOE_BOX_RIGHT));
    *y = goe_sides_see(sides, GOE_SIDE_TOP | GOE_SIDE_BOTTOM)
             ? 0.5f * (goe_touch_coordinate(camera, sides, GOE_BOX_TOP) +
                       goe_touch_coordinate(camera, sides, GOE_BOX_BOTTOM))
             : 0.0f;
}

bool goe_prism_face(goe_filter_t *filter, const goe_view_t *view) {
    float x;
    float y;
    goe_point_t ray;
    if (!goe_sides_see(&view->sides, GOE_SIDE_LEFT | GOE_SIDE_RIGHT)) {
        return false;
    }
    middle_of(view->camera, &view->sides, &x, &y);
    if (!ray_of(view->camera, view->camera_to_trajectory, x, y, &ray)) {
        return false;
    }
    const float norm = sqrtf(1.0f + ray.x * ray.x);
    goe_filter_turn_axes(filter, 1.0f / norm, ray.x / norm);
    return true;
}

static float height_sd_m(const goe_observation_t *obs) { return sqrtf(goe_observation_height_variance(obs, true)); }

/* From flat ground, if the foot lies clearly below the horizon; otherwise from the typical size. size: angular. */
static float first_range_m(const goe_observation_t *obs, float size, const goe_point_t *foot) {
    const goe_settings_t *s = obs->settings;
    const float attitude =
        goe_square(s->navigation.attitude_bias_sd_deg * GOE_RAD_PER_DEG) + goe_square(obs->white_rad);
    const float foot_sd = sqrtf(attitude + goe_square(obs->side_px / obs->camera->fy_px) +
                                goe_square(FOOT_SHARE * s->detector.box_noise_rel * size));
    const bool grounded =
        foot->usable && foot->y > GROUND_SIGMAS * foot_sd && obs->steady_height_m > GROUND_SIGMAS * height_sd_m(obs);
    return grounded ? obs->steady_height_m / foot->y * (1.0f + NEAR_SIDE * size)
                    : s->filter.prior_width_m / goe_larger(size, BOX_SIZE_MIN);
}

static void set_root(const goe_observation_t *obs, const float state[GOE_STATES], float width, goe_triangle_t *root) {
    const bool disc = obs->settings->model == GOE_MODEL_DISC;
    float sd[GOE_STATES];
    goe_observation_prior(obs, state, width, sd);
    sd[GOE_GROUND] = goe_larger(height_sd_m(obs) * state[GOE_INVERSE_RANGE], GROUND_MIN);
    sd[GOE_PRISM_SHEAR] = (disc ? DISC_FREEDOM : SHEAR_FREEDOM) * state[GOE_PRISM_HALF];
    sd[GOE_PRISM_HALF] = HALF_FREEDOM * width;
    sd[GOE_PRISM_DEPTH] = disc ? DISC_FREEDOM : DEPTH_FREEDOM;
    goe_srif_from_sigmas(sd, root);
}

bool goe_prism_start(const goe_observation_t *obs, float state[GOE_STATES], goe_triangle_t *root) {
    const goe_camera_t *camera = obs->camera;
    const goe_sides_t *sides = obs->sides;
    goe_point_t head = {0.0f, 0.0f, false};
    goe_point_t foot = {0.0f, 0.0f, false};
    float x;
    float y;
    middle_of(camera, sides, &x, &y);
    if (goe_sides_see(sides, GOE_SIDE_TOP)) {
        (void)ray_of(camera, obs->camera_to_axes, x, goe_touch_coordinate(camera, sides, GOE_BOX_TOP), &head);
    }
    if (goe_sides_see(sides, GOE_SIDE_BOTTOM)) {
        (void)ray_of(camera, obs->camera_to_axes, x, goe_touch_coordinate(camera, sides, GOE_BOX_BOTTOM), &foot);
    }
    const float size = size_of(obs, GOE_BOX_LEFT) / (1.0f + x * x);
    const float range_m = first_range_m(obs, size, &foot);
    if (!(range_m >= RANGE_MIN_M) || !goe_within(range_m, RANGE_MAX_M)) {
        return false;
    }
    const float q = 1.0f / range_m;
    memset(state, 0, GOE_STATES * sizeof state[0]);
    state[GOE_INVERSE_RANGE] = q;
    state[GOE_PRISM_HALF] = 0.5f * size;
    state[GOE_TOP] = obs->steady_height_m * q - (head.usable ? head.y : 0.0f);
    if (height_sd_m(obs) > NO_ALTIMETER_M && foot.usable) {
        state[GOE_GROUND] = foot.y - obs->steady_height_m * q;
    }
    set_root(obs, state, size, root);
    return true;
}

/* --------------------------------------------------------------------------------------------------------- quantities -- */

/* (R33). */
void goe_prism_shape(const goe_filter_t *filter, goe_shape_t *shape) {
    const float *x = filter->state;
    goe_spot_t reference;
    memset(&reference, 0, sizeof reference);
    reference.at.x = x[GOE_BEARING];
    reference.at.z = 1.0f;
    goe_shape_start(filter, x, &reference, shape);
    shape->middle = reference;
    const float scale_m = shape->scale_m;
    goe_linear_t *width = &shape->quantity[GOE_WIDTH];
    width->value = 2.0f * x[GOE_PRISM_HALF] * scale_m;
    width->by[GOE_INVERSE_RANGE] = -scale_m * width->value;
    width->by[GOE_PRISM_HALF] = 2.0f * scale_m;
}

/* ------------------------------------------------------------------------------------------------------ depth, near side -- */

bool goe_prism_knows_depth(const goe_filter_t *filter) {
    return goe_absolute(goe_shape_turned(filter, goe_filter_measured(filter))) > DEPTH_TURNED;
}

/* The last state's sigma is that of its own row. */
float goe_prism_bend(const goe_filter_t *filter) {
    const float last = filter->root.element[goe_srif_row(GOE_PRISM_DEPTH) + GOE_PRISM_DEPTH];
    const float sd = 1.0f / goe_larger(goe_absolute(last), 1.0f / DEPTH_MAX);
    return sd > BENT_MIN ? (goe_exp(sd) - 1.0f) / sd : 1.0f;
}

static void support(const goe_ellipse_t *footprint, goe_xz_t outward, goe_support_t *to) {
    const goe_reach_t r = goe_touch_reach(footprint, outward);
    to->reach = r.length;
    to->by_shear = r.across * outward.z / r.length;
    to->by_half = (r.across * outward.x + r.along * r.along / goe_larger(footprint->half, NEAR_MIN)) / r.length;
    to->by_depth = r.along * r.along / r.length;
}

void goe_prism_face_camera(const goe_filter_t *filter, goe_xz_t camera_m, goe_aspect_t *aspect) {
    const float *x = filter->state;
    const float q = x[GOE_INVERSE_RANGE];
    const goe_xz_t middle = {x[GOE_BEARING] - camera_m.x * q, 1.0f - camera_m.z * q};
    const float range = goe_larger(sqrtf(goe_xz_dot(middle, middle)), NEAR_MIN);
    const goe_xz_t towards = {-middle.x / range, -middle.z / range};
    const goe_xz_t right = {towards.z, -towards.x};
    goe_ellipse_t footprint;
    set_footprint(x, &footprint);
    aspect->towards = towards;
    support(&footprint, towards, &aspect->before);
    support(&footprint, right, &aspect->across);
    aspect->before.reach = aspect->before.reach < range ? aspect->before.reach : range;
}

#endif
