/* Start, rows and quantities of a prism. SPDX-License-Identifier: MIT */
#include "refined/goe_prism.h"

#include <math.h>
#include <string.h>

#include "image/goe_camera.h"
#include "maths/goe_angle.h"
#include "maths/goe_exp.h"
#include "maths/goe_scalar.h"
#include "maths/goe_time.h"
#include "refined/goe_side_memory.h"

#if GOE_WITH_REFINED

#define AHEAD_MIN 0.02f        /* of a touching point, units of Z0 */
#define LEVEL_MIN 1.0e-6f      /* horizontal part of a side's normal: without one the nearest point touches */
#define REACH_MIN 1.0e-9f      /* of the footprint, units of Z0 */
#define DEPTH_MAX 2.0f         /* |s|: 7 times as deep as wide, or as flat */
#define SCATTER_SHARE 0.01f    /* white part of a side's error, of the box's size */
#define SHIFT_RATIO_MAX 300.0f /* of a shift that rows share, over a row's own noise */
#define EARLY_SHARE 0.08f      /* of the time constant: sooner, differences of boxes are their linearisation's */
#define GAP_MAX_US 1000000000u /* as the filter's: a longer gap counts as this one */
#define GROUND_SIGMAS 3.0f     /* by which the foot must lie below the horizon to give the range */
#define FOOT_SHARE 0.6f        /* of box_share of the width, in that sigma */
#define NEAR_SIDE 0.5f         /* the foot is nearer than the middle by half the width */
#define RANGE_MIN_M 1.0f       /* of a first guess */
#define RANGE_MAX_M 1.0e6f     /* the same */
#define NO_ALTIMETER_M 50.0f   /* sigma of the height from which on the first box sets it */
#define HEADING_ARM 0.08f      /* s/m: a yaw bias this large per m/s looks like a velocity bias */
#define BEARING_FREEDOM 1.0f   /* one sigma of the first guess of X0/Z0 */
#define RANGE_FREEDOM 2.0f     /* ... of 1/Z0, relative */
#define HALF_FREEDOM 2.5f      /* ... of the half width, in widths */
#define TOP_FREEDOM 10.0f      /* ... of the top, in the larger of top and width */
#define DEPTH_FREEDOM 0.3f     /* ... of s */
#define DEPTH_UNSEEN 3.0f      /* one sigma of c: a factor of 20 in depth, from a plate to a wall seen end-on */
#define DISC_FREEDOM 1.0e-3f   /* both, where a disc is asked for */
#define GROUND_MIN 1.0e-6f     /* one sigma of the ground's offset, units of Z0 */
#define BOX_SIZE_MIN 1.0e-12f  /* of a box, angular: a smaller one tells no range */

GOE_STATIC_ASSERT(sizeof(((goe_filter_t *)0)->side) == GOE_BOX_SIDES * sizeof(goe_side_memory_t),
                  every_side_has_a_memory);
GOE_STATIC_ASSERT(GOE_BOX_RIGHT == GOE_BOX_LEFT + 2 && GOE_BOX_BOTTOM == GOE_BOX_TOP + 2 && GOE_BOX_TOP == 1,
                  level_sides_are_odd_and_opposite_ones_two_apart);

static const uint8_t feature_of[GOE_BOX_SIDES] = {GOE_POINT_LEFT, GOE_POINT_TOP, GOE_POINT_RIGHT, GOE_POINT_BASE_NEAR};

static size_t side_of(uint8_t feature) {
    return feature == GOE_POINT_LEFT    ? GOE_BOX_LEFT
           : feature == GOE_POINT_TOP   ? GOE_BOX_TOP
           : feature == GOE_POINT_RIGHT ? GOE_BOX_RIGHT
                                        : GOE_BOX_BOTTOM;
}

static bool is_level(size_t side) { return (side & 1u) != 0u; } /* top, bottom */

/*@ requires \valid_read(camera) && side < GOE_BOX_SIDES; */
static float focal_px(const goe_camera_t *camera, size_t side) {
    return is_level(side) ? camera->fy_px : camera->fx_px;
}

/* The raw coordinate of a side, focal lengths. */
/*@ requires \valid_read(camera) && \valid_read(sides) && side < GOE_BOX_SIDES; */
static float coordinate(const goe_camera_t *camera, const goe_sides_t *sides, size_t side) {
    const float center_px = is_level(side) ? camera->cy_px : camera->cx_px;
    return (sides->px[side] - center_px) / focal_px(camera, side);
}

/* ----------------------------------------------------------------------------------------------------------- support -- */

typedef struct {
    goe_xz_t center; /* relative to the camera now, units of Z0 */
    float half, depth;
    float ground, roof; /* Y */
} ellipse_t;

/* Where a plane through the camera touches. */
typedef struct {
    float point[3];       /* from the camera, in the axes */
    float x, y, nearness; /* seen there, focal lengths, no lens; 1/(range along the optical axis) */
    goe_xz_t outward;
    float reach; /* of the footprint into that direction: the support function */
    bool foot;   /* at the foot, not at the head */
} touch_t;

/*@ requires goe_observation_is_open(obs) && \valid(o); */
static void describe(const goe_observation_t *obs, ellipse_t *o) {
    const float *x = obs->state;
    o->center = goe_observation_reference(obs);
    o->half = x[GOE_PRISM_HALF];
    o->depth = o->half * goe_exp(x[GOE_PRISM_DEPTH]);
    o->ground = obs->steady_height_m * x[GOE_INVERSE_RANGE] + x[GOE_GROUND];
    o->roof = obs->steady_height_m * x[GOE_INVERSE_RANGE] - x[GOE_PRISM_TOP];
}

/*@ requires \valid_read(a + (0 .. 2)) && \valid_read(b + (0 .. 2)) && \valid(c + (0 .. 2)); */
static void cross(const float a[3], const float b[3], float c[3]) {
    c[0] = a[1] * b[2] - a[2] * b[1];
    c[1] = a[2] * b[0] - a[0] * b[2];
    c[2] = a[0] * b[1] - a[1] * b[0];
}

/* Out of the camera's axes into the state's, by the given attitude. */
/*@ requires goe_observation_is_open(obs) && \valid_read(v + (0 .. 2)) && \valid(to + (0 .. 2)); */
static void into_axes(const goe_observation_t *obs, const float v[3], float to[3]) {
    const float *r = obs->camera_to_axes;
    for (size_t i = 0; i < 3; i++) {
        to[i] = r[3 * i] * v[0] + r[3 * i + 1] * v[1] + r[3 * i + 2] * v[2];
    }
}

typedef enum { FOOT, HEAD, EITHER } end_t;

/* The touching point on the side of the outward normal, which is given in the camera's axes. (R26), (R27). False if it is not
 * ahead. */
/*@ requires goe_observation_is_open(obs) && \valid_read(o) && \valid_read(normal + (0 .. 2)) && \valid(t); */
static bool touch(const goe_observation_t *obs, const ellipse_t *o, const float normal[3], end_t end, touch_t *t) {
    const float e[3] = {obs->ex, obs->ey, obs->ez};
    const float *r = obs->camera_to_axes;
    float n[3];
    float turn[3];
    into_axes(obs, normal, n);
    cross(e, n, turn);
    for (size_t i = 0; i < 3; i++) {
        n[i] -= turn[i];
    }
    const float level = sqrtf(n[0] * n[0] + n[2] * n[2]);
    const bool tilts = level > LEVEL_MIN;
    t->outward.x = tilts ? n[0] / level : 0.0f;
    t->outward.z = tilts ? n[2] / level : -1.0f;
    t->foot = end == EITHER ? n[1] > 0.0f : end == FOOT;
    const float across = o->half * t->outward.x;
    const float along = o->depth * t->outward.z;
    t->reach = goe_larger(sqrtf(across * across + along * along), REACH_MIN);
    t->point[0] = o->center.x + o->half * across / t->reach;
    t->point[1] = t->foot ? o->ground : o->roof;
    t->point[2] = o->center.z + o->depth * along / t->reach;
    float seen[3];
    cross(e, t->point, turn);
    for (size_t i = 0; i < 3; i++) {
        seen[i] = t->point[i] + turn[i];
    }
    const float z = r[2] * seen[0] + r[5] * seen[1] + r[8] * seen[2];
    if (!(z >= AHEAD_MIN)) {
        return false;
    }
    t->nearness = 1.0f / z;
    t->x = (r[0] * seen[0] + r[3] * seen[1] + r[6] * seen[2]) * t->nearness;
    t->y = (r[1] * seen[0] + r[4] * seen[1] + r[7] * seen[2]) * t->nearness;
    return true;
}

/* -------------------------------------------------------------------------------------------------------------- rows -- */

/* The line of a side near a point: raw coordinate there, and its derivatives by the undistorted (x, y). */
typedef struct {
    float at, by_x, by_y;
} line_t;

/*@ requires \valid_read(camera) && side < GOE_BOX_SIDES; */
static line_t line_at(const goe_camera_t *camera, size_t side, float x, float y) {
    line_t line = {is_level(side) ? y : x, is_level(side) ? 0.0f : 1.0f, is_level(side) ? 1.0f : 0.0f};
    if (goe_camera_distorts(camera)) {
        const goe_distorted_t to = goe_camera_distort(camera, x, y);
        line.at = is_level(side) ? to.y : to.x;
        line.by_x = is_level(side) ? to.xy : to.xx;
        line.by_y = is_level(side) ? to.yy : to.xy;
    }
    return line;
}

static float sign_of(size_t side) { return side == GOE_BOX_LEFT || side == GOE_BOX_TOP ? -1.0f : 1.0f; }

/* By the line as it lies where it touches, which the first call tells about, (R28). */
/*@ requires goe_observation_is_open(obs) && \valid_read(o) && \valid_read(straight + (0 .. 2)) && \valid(t);
    requires side < GOE_BOX_SIDES; */
static bool touch_bent(const goe_observation_t *obs, const ellipse_t *o, size_t side, const float straight[3],
                       end_t end, touch_t *t) {
    if (!touch(obs, o, straight, end, t)) {
        return false;
    }
    const float sign = sign_of(side);
    const line_t line = line_at(obs->camera, side, t->x, t->y);
    const float bent[3] = {sign * line.by_x, sign * line.by_y, -sign * (line.by_x * t->x + line.by_y * t->y)};
    return touch(obs, o, bent, end, t);
}

/* Touches by the plane through the raw coordinate `at`. With a lens foot and head are tried, as the line is not straight between
 * them. */
/*@ requires goe_observation_is_open(obs) && \valid_read(o) && \valid(t) && side < GOE_BOX_SIDES; */
static bool touch_side(const goe_observation_t *obs, const ellipse_t *o, size_t side, float at, touch_t *t) {
    const goe_camera_t *camera = obs->camera;
    const float sign = sign_of(side);
    const float straight[3] = {is_level(side) ? 0.0f : sign, is_level(side) ? sign : 0.0f, -sign * at};
    if (!goe_camera_distorts(camera)) {
        return touch(obs, o, straight, EITHER, t);
    }
    touch_t head;
    if (!touch_bent(obs, o, side, straight, FOOT, t) || !touch_bent(obs, o, side, straight, HEAD, &head)) {
        return false;
    }
    if (sign * line_at(camera, side, head.x, head.y).at > sign * line_at(camera, side, t->x, t->y).at) {
        *t = head;
    }
    return true;
}

/* Derivatives by the touching point and by the attitude's error, from the line's. */
/*@ requires goe_observation_is_open(obs) && \valid_read(t) && \valid_read(line); */
static goe_gradient_t gradient_of(const goe_observation_t *obs, const touch_t *t, const line_t *line) {
    const float e[3] = {obs->ex, obs->ey, obs->ez};
    const float in_camera[3] = {line->by_x * t->nearness, line->by_y * t->nearness,
                                -(line->by_x * t->x + line->by_y * t->y) * t->nearness};
    float g[3];
    float turn[3];
    goe_gradient_t to;
    into_axes(obs, in_camera, g);
    cross(t->point, g, turn);
    to.at = line->at;
    to.ex = turn[0];
    to.ey = turn[1];
    to.ez = turn[2];
    cross(g, e, turn);
    to.x = g[0] + turn[0];
    to.y = g[1] + turn[1];
    to.z = g[2] + turn[2];
    return to;
}

/* (R29). */
/*@ requires goe_observation_is_open(obs) && \valid_read(o) && goe_rows_hold(rows);
    requires side < GOE_BOX_SIDES && rows->count < GOE_ROWS_MAX; */
static void add_side(const goe_observation_t *obs, const ellipse_t *o, size_t side, float variance, goe_rows_t *rows) {
    touch_t t;
    const goe_camera_t *camera = obs->camera;
    const float measured = coordinate(camera, obs->sides, side);
    if (!touch_side(obs, o, side, measured, &t)) {
        return;
    }
    const line_t line = line_at(camera, side, t.x, t.y);
    const goe_gradient_t g = gradient_of(obs, &t, &line);
    float *by = goe_rows_add(rows, (goe_feature_t)feature_of[side], measured, variance, &g);
    const float outward = g.x * t.outward.x + g.z * t.outward.z;
    const float along = o->depth * t.outward.z;
    by[GOE_GROUND] = t.foot ? g.y : 0.0f;
    goe_rows_place(by, obs, g.x, g.z);
    by[GOE_INVERSE_RANGE] += g.y * obs->steady_height_m;
    by[GOE_PRISM_DEPTH] = outward * along * along / t.reach;
    by[GOE_PRISM_HALF] = outward * t.reach / o->half;
    by[GOE_PRISM_TOP] = t.foot ? 0.0f : -g.y;
    by[GOE_PRISM_UNSEEN] = by[GOE_PRISM_DEPTH];
    const float shift = -obs->position_sd * obs->state[GOE_INVERSE_RANGE];
    float *common = rows->shift[rows->count - 1u];
    common[0] = shift * g.x;
    common[1] = shift * g.y;
    common[2] = shift * g.z;
}

/* The box's size along a side's coordinate, focal lengths: as measured, or as predicted. */
/*@ requires goe_observation_is_open(obs); */
static float size_of(const goe_observation_t *obs, bool level) {
    const goe_camera_t *camera = obs->camera;
    const goe_sides_t *sides = obs->sides;
    const float *x = obs->state;
    const size_t first = level ? GOE_BOX_TOP : GOE_BOX_LEFT;
    if (goe_sides_see(sides, level ? GOE_SEES_TOP | GOE_SEES_BOTTOM : GOE_SEES_LEFT | GOE_SEES_RIGHT)) {
        return (sides->px[first + 2u] - sides->px[first]) / focal_px(camera, first);
    }
    const float ahead = goe_larger(goe_observation_reference(obs).z, AHEAD_MIN);
    return goe_larger(level ? x[GOE_PRISM_TOP] + x[GOE_GROUND] : 2.0f * x[GOE_PRISM_HALF], 0.0f) / ahead;
}

/*@ requires goe_observation_is_open(obs) && side < GOE_BOX_SIDES; */
static float white_variance(const goe_observation_t *obs, size_t side) {
    const goe_detector_t *detector = &obs->settings->detector;
    const float size = size_of(obs, is_level(side));
    const float pixel = obs->side_px / focal_px(obs->camera, side);
    return goe_square(pixel) + goe_square(SCATTER_SHARE * size) +
           (obs->sides->cut ? goe_square(detector->cut_noise * size) : 0.0f);
}

void goe_prism_rows(const goe_observation_t *obs, goe_rows_t *rows) {
    ellipse_t ellipse;
    describe(obs, &ellipse);
    rows->shifts = obs->position_sd > 0.0f;
    for (size_t side = 0; side < GOE_BOX_SIDES; side++) {
        if (goe_sides_see(obs->sides, 1u << side)) {
            add_side(obs, &ellipse, side, white_variance(obs, side), rows);
        }
    }
}

/* ------------------------------------------------------------------------------------------------------ sides' errors -- */

bool goe_prism_is_early(const goe_filter_t *filter, const goe_settings_t *settings, const goe_motion_t *motion) {
    const float since_s = goe_time_between_s(filter->time_us, motion->time_us, GAP_MAX_US);
    return filter->phase == GOE_PHASE_PRISM && since_s < EARLY_SHARE * settings->detector.correlation_s;
}

void goe_prism_recall(goe_filter_t *filter, const goe_observation_t *obs, goe_rows_t *rows) {
    const goe_detector_t *detector = &obs->settings->detector;
    for (size_t side = 0; side < GOE_BOX_SIDES; side++) {
        goe_side_memory_fade(&filter->side[side], obs->fade,
                             goe_square(detector->box_share * size_of(obs, is_level(side))));
    }
    for (size_t i = 0; i < rows->count; i++) {
        goe_side_memory_recall(&filter->side[side_of(rows->feature[i])], rows->matrix->row[i], &rows->variance[i]);
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
    const float shift = goe_square(rows->variance[i]) * shared_shift(rows, i, i);
    return shift > SHIFT_RATIO_MAX * SHIFT_RATIO_MAX ? SHIFT_RATIO_MAX / sqrtf(shift) : 1.0f;
}

/* Rows of unit noise that share a shift: their covariance is I + N; times the inverse of its Cholesky root they share none. */
/*@ requires goe_rows_hold(rows) && rows->count <= GOE_BOX_SIDES; */
static void free_of_shift(goe_rows_t *rows) {
    float root[GOE_BOX_SIDES][GOE_BOX_SIDES];
    for (size_t i = 0; i < rows->count; i++) {
        float *row = rows->matrix->row[i];
        const float share = share_of(rows, i);
        rows->variance[i] *= share;
        for (size_t j = 0; j <= i; j++) {
            float sum = (i == j ? 1.0f : 0.0f) + rows->variance[i] * rows->variance[j] * shared_shift(rows, i, j);
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
        const float weight = rows->variance[i];
        const float attitude = white * white * (row[0] * row[0] + row[1] * row[1] + row[2] * row[2]);
        goe_side_memory_learn(&filter->side[side_of(rows->feature[i])], row, weight,
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
/*@ requires \valid_read(camera) && \valid_read(camera_to_axes + (0 .. 8)) && \valid(ray); */
static bool ray_of(const goe_camera_t *camera, const float camera_to_axes[9], float x, float y, goe_point_t *ray) {
    float undistorted[2] = {x, y};
    if (goe_camera_distorts(camera) && !goe_camera_undistort(camera, &undistorted[0], &undistorted[1])) {
        return false;
    }
    const float *r = camera_to_axes;
    const float z = r[6] * undistorted[0] + r[7] * undistorted[1] + r[8];
    ray->usable = z > AHEAD_MIN;
    const float ahead = ray->usable ? z : 1.0f;
    ray->x = (r[0] * undistorted[0] + r[1] * undistorted[1] + r[2]) / ahead;
    ray->y = (r[3] * undistorted[0] + r[4] * undistorted[1] + r[5]) / ahead;
    return ray->usable;
}

/* Of the box, as far as it is seen. */
/*@ requires \valid_read(camera) && \valid_read(sides) && \valid(x) && \valid(y); */
static void middle_of(const goe_camera_t *camera, const goe_sides_t *sides, float *x, float *y) {
    *x = 0.5f * (coordinate(camera, sides, GOE_BOX_LEFT) + coordinate(camera, sides, GOE_BOX_RIGHT));
    *y = goe_sides_see(sides, GOE_SEES_TOP | GOE_SEES_BOTTOM)
             ? 0.5f * (coordinate(camera, sides, GOE_BOX_TOP) + coordinate(camera, sides, GOE_BOX_BOTTOM))
             : 0.0f;
}

bool goe_prism_face(goe_filter_t *filter, const goe_view_t *view) {
    float x;
    float y;
    goe_point_t ray;
    if (!goe_sides_see(&view->sides, GOE_SEES_LEFT | GOE_SEES_RIGHT)) {
        return false;
    }
    middle_of(view->camera, &view->sides, &x, &y);
    if (!ray_of(view->camera, view->camera_to_trajectory, x, y, &ray)) {
        return false;
    }
    const float norm = sqrtf(1.0f + ray.x * ray.x);
    filter->axes.turn_cos = 1.0f / norm;
    filter->axes.turn_sin = ray.x / norm;
    return true;
}

/*@ requires goe_observation_is_open(obs); */
static float height_sd_m(const goe_observation_t *obs) { return sqrtf(goe_observation_height_variance(obs, true)); }

/* From flat ground, if the foot lies clearly below the horizon; otherwise from the typical size. size: angular. */
/*@ requires goe_observation_is_open(obs) && \valid_read(foot); */
static float first_range_m(const goe_observation_t *obs, float size, const goe_point_t *foot) {
    const goe_settings_t *s = obs->settings;
    const float attitude = goe_square(s->navigation.attitude_bias_deg * GOE_RAD_PER_DEG) + goe_square(obs->white_rad);
    const float foot_sd = sqrtf(attitude + goe_square(obs->side_px / obs->camera->fy_px) +
                                goe_square(FOOT_SHARE * s->detector.box_share * size));
    const bool grounded =
        foot->usable && foot->y > GROUND_SIGMAS * foot_sd && obs->steady_height_m > GROUND_SIGMAS * height_sd_m(obs);
    return grounded ? obs->steady_height_m / foot->y * (1.0f + NEAR_SIDE * size)
                    : s->refined.typical_size_m / goe_larger(size, BOX_SIZE_MIN);
}

/*@ requires goe_observation_is_open(obs) && \valid_read(state + (0 .. GOE_STATES - 1)) && \valid(root); */
static void set_root(const goe_observation_t *obs, const float state[GOE_STATES], float width, goe_triangle_t *root) {
    const goe_settings_t *settings = obs->settings;
    const goe_navigation_t *navigation = &settings->navigation;
    const float bias = navigation->attitude_bias_deg * GOE_RAD_PER_DEG;
    const float q = state[GOE_INVERSE_RANGE];
    const bool disc = settings->model == GOE_MODEL_DISC;
    float sd[GOE_STATES];
    sd[GOE_BIAS_X] = bias;
    sd[GOE_BIAS_Y] = bias;
    sd[GOE_BIAS_Z] = sqrtf(goe_square(bias) + goe_square(HEADING_ARM * navigation->velocity_bias_m_s));
    sd[GOE_GROUND] = goe_larger(height_sd_m(obs) * q, GROUND_MIN);
    sd[GOE_BEARING] = BEARING_FREEDOM;
    sd[GOE_INVERSE_RANGE] = RANGE_FREEDOM * q;
    sd[GOE_PRISM_DEPTH] = disc ? DISC_FREEDOM : DEPTH_FREEDOM;
    sd[GOE_PRISM_HALF] = HALF_FREEDOM * width;
    sd[GOE_PRISM_TOP] = TOP_FREEDOM * goe_larger(goe_absolute(state[GOE_PRISM_TOP]), width);
    sd[GOE_PRISM_UNSEEN] = disc ? DISC_FREEDOM : DEPTH_UNSEEN;
    goe_srif_clear(root);
    for (size_t i = 0; i < GOE_STATES; i++) {
        root->element[goe_srif_row(i) + i] = 1.0f / sd[i];
    }
}

bool goe_prism_start(const goe_observation_t *obs, float state[GOE_STATES], goe_triangle_t *root) {
    const goe_camera_t *camera = obs->camera;
    const goe_sides_t *sides = obs->sides;
    goe_point_t head = {0.0f, 0.0f, false};
    goe_point_t foot = {0.0f, 0.0f, false};
    float x;
    float y;
    middle_of(camera, sides, &x, &y);
    if (goe_sides_see(sides, GOE_SEES_TOP)) {
        (void)ray_of(camera, obs->camera_to_axes, x, coordinate(camera, sides, GOE_BOX_TOP), &head);
    }
    if (goe_sides_see(sides, GOE_SEES_BOTTOM)) {
        (void)ray_of(camera, obs->camera_to_axes, x, coordinate(camera, sides, GOE_BOX_BOTTOM), &foot);
    }
    const float size = size_of(obs, false) / (1.0f + x * x);
    const float range_m = first_range_m(obs, size, &foot);
    if (!(range_m >= RANGE_MIN_M) || !goe_within(range_m, RANGE_MAX_M)) {
        return false;
    }
    const float q = 1.0f / range_m;
    memset(state, 0, GOE_STATES * sizeof state[0]);
    state[GOE_INVERSE_RANGE] = q;
    state[GOE_PRISM_HALF] = 0.5f * size;
    state[GOE_PRISM_TOP] = obs->steady_height_m * q - (head.usable ? head.y : 0.0f);
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
    goe_linear_t *height = &shape->quantity[GOE_HEIGHT];
    width->value = 2.0f * x[GOE_PRISM_HALF] * scale_m;
    width->by[GOE_INVERSE_RANGE] = -scale_m * width->value;
    width->by[GOE_PRISM_HALF] = 2.0f * scale_m;
    height->value = (x[GOE_PRISM_TOP] + x[GOE_GROUND]) * scale_m;
    height->by[GOE_INVERSE_RANGE] = -scale_m * height->value;
    height->by[GOE_TOP] = 0.0f; /* which is another state here */
    height->by[GOE_PRISM_TOP] = scale_m;
}

#endif
