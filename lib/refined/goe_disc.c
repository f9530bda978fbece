/* Start, rows and quantities of a disc. SPDX-License-Identifier: MIT */
#include "refined/goe_disc.h"

#include <math.h>
#include <string.h>

#include "maths/goe_angle.h"
#include "maths/goe_exp.h"
#include "maths/goe_scalar.h"
#include "refined/goe_touch.h"

#if GOE_WITH_FILTER

#define CENTER_AHEAD_MIN 1.0e-3f /* center, units of Z0: nearer gives no rows */
#define TANGENT_AHEAD 0.02f      /* third component of a tangent's unit vector */
#define SINE_MIN 1.0e-5f         /* of half the angle that the disc covers */
#define SINE_MAX 0.98f
#define STAND_IN_SHAPE 0.1f  /* shape_error_rel that is added while a box is taken for a disc */
#define STAND_IN_PLACE 0.1f  /* of the width, by which the box's middle may lie off the disc's */
#define WIDTH_MIN 1.0e-5f    /* between left and right, focal lengths */
#define RANGE_MIN_M 1.0f     /* of a first guess */
#define GROUND_SIGMAS 3.0f   /* by which the base must lie below the horizon to give the range */
#define WIDTH_FREEDOM 5.0f   /* one sigma of the first guess of the width, relative */
#define SKEWED_SIGMAS2 18.0f /* twice the log-likelihood ratio of chord against disc; cylinders stay below 14 */
#define VARIANCE_MIN 1.0e-30f
#define CHANCE_SHARE 0.5f  /* of the skew's variance that is taken for a true disc's chance, where one was configured */
#define SKEW_SHARE 0.5f    /* one sigma of the skew of a shape that is no disc, of its width */
#define TURNED_SIGMAS 6.0f /* of the skew by which the line of sight must turn to reveal a shape that is no disc */
#define KINK_SHARE 0.4f    /* ... and of what it changes by as other corners come into view */
#define WIDTH_SHARE 0.05f  /* of the width by which corners that change unnoticed move the visible outline */
#define BASE_NOISE 2.0f    /* variance of a base corner's y as range of the center, over its own */

typedef struct {
    goe_xz_t center; /* relative to the camera now, units of Z0 */
    float distance;
    goe_xz_t to;        /* unit vector to it */
    float sine, cosine; /* of half the angle that the disc covers */
} circle_t;

static bool describe(const goe_observation_t *obs, circle_t *o) {
    o->center = goe_observation_reference(obs);
    if (!(o->center.z >= CENTER_AHEAD_MIN)) {
        return false;
    }
    o->distance = sqrtf(goe_xz_dot(o->center, o->center));
    o->to.x = o->center.x / o->distance;
    o->to.z = o->center.z / o->distance;
    const float sine = 0.5f * obs->state[GOE_FRONT_X] / o->distance;
    o->sine = sine > SINE_MAX ? SINE_MAX : (sine > SINE_MIN ? sine : SINE_MIN);
    o->cosine = sqrtf(1.0f - o->sine * o->sine);
    return true;
}

/* Which features give the width; false if none do. */
static bool outline_features(const goe_observation_t *obs, goe_feature_t *left, goe_feature_t *right) {
    const bool silhouette = obs->point[GOE_POINT_LEFT].usable && obs->point[GOE_POINT_RIGHT].usable;
    *left = silhouette || !obs->base ? GOE_POINT_LEFT : GOE_POINT_BASE_LEFT;
    *right = silhouette || !obs->base ? GOE_POINT_RIGHT : GOE_POINT_BASE_RIGHT;
    return silhouette || obs->base;
}

/* (R5): the tangent's azimuth is that of the center plus or minus asin(r/d). */
/*@ requires goe_observation_is_open(obs) && \valid_read(o) && goe_rows_hold(rows);
    requires feature < GOE_FEATURES && rows->count < GOE_ROWS_MAX; */
static void add_tangent(const goe_observation_t *obs, const circle_t *o, goe_feature_t feature, float side, float more,
                        goe_rows_t *rows) {
    goe_gradient_t g;
    const float tx = o->to.x * o->cosine + side * o->to.z * o->sine;
    const float tz = o->to.z * o->cosine - side * o->to.x * o->sine;
    if (tz < TANGENT_AHEAD) {
        return;
    }
    const goe_xz_t ray = {tx / tz, 1.0f};
    float *by = goe_rows_add_edge(rows, obs, ray, feature, more, &g);
    if (!by) {
        return;
    }
    const float by_azimuth = (1.0f + ray.x * ray.x) * g.x;
    const float by_sine = side / o->cosine;
    const float by_x = by_azimuth * (o->to.z - by_sine * o->sine * o->to.x) / o->distance;
    const float by_z = by_azimuth * (-o->to.x - by_sine * o->sine * o->to.z) / o->distance;
    /* without base corners: half the skew deeper */
    const float by_skew = obs->base ? 0.0f : -0.5f * side * ray.x / o->center.z * g.x;
    goe_rows_place(by, obs, by_x, by_z);
    by[GOE_SIDE_X] = by_skew;
    by[GOE_FRONT_X] = 0.5f * by_azimuth * by_sine / o->distance;
    by[GOE_BEHIND_STATES] -= by_skew * obs->state[GOE_SIDE_X];
}

/* (R6): the nearest point of the upper rim; from above the highest in the image is the farthest. */
static void add_top(const goe_observation_t *obs, const circle_t *o, float more, goe_rows_t *rows) {
    goe_gradient_t g;
    const float y = goe_observation_roof(obs);
    const float side = obs->settings->filter.top_is_highest && y > 0.0f ? -1.0f : 1.0f;
    const float share = 1.0f - side * o->sine;
    const goe_xz_t rim = {o->center.x * share, o->center.z * share};
    float *by = goe_rows_add_level(rows, obs, rim, y, GOE_POINT_TOP, more, &g);
    if (!by) {
        return;
    }
    const float radial = side * (g.x * o->center.x + g.z * o->center.z); /* by -(sine of half the angle) */
    const float by_x = g.x * share + radial * o->sine / o->distance * o->to.x;
    const float by_z = g.z * share + radial * o->sine / o->distance * o->to.z;
    goe_rows_place(by, obs, by_x, by_z);
    by[GOE_INVERSE_RANGE] += g.y * obs->height_m;
    by[GOE_FRONT_X] = -radial * 0.5f / o->distance;
    by[GOE_TOP] = -g.y;
}

/* (R2), range over flat ground: how far a base corner is in front of or behind the center is not known, and a whole width is
 * allowed for it. */
/*@ requires goe_observation_is_open(obs) && \valid_read(o) && goe_rows_hold(rows);
    requires feature < GOE_FEATURES && rows->count < GOE_ROWS_MAX; */
static void add_base(const goe_observation_t *obs, const circle_t *o, goe_feature_t feature, float width,
                     goe_rows_t *rows) {
    goe_gradient_t g;
    const float q = obs->state[GOE_INVERSE_RANGE];
    const float ground = obs->height_m * q + obs->state[GOE_GROUND];
    float *by = goe_rows_add_level(rows, obs, o->center, ground, feature, 0.0f, &g);
    if (!by) {
        return;
    }
    float *variance = goe_rows_last_variance(rows);
    *variance = *variance * BASE_NOISE + goe_square(g.at * width);
    by[GOE_GROUND] = g.y;
    goe_rows_place(by, obs, g.x, g.z);
    by[GOE_INVERSE_RANGE] += g.y * obs->height_m;
}

/* (R29): what a side of an upright bounding box touches. */
/*@ requires goe_observation_is_open(obs) && goe_solid_is_closed(solid) && goe_rows_hold(rows);
    requires side < GOE_BOX_SIDES && rows->count < GOE_ROWS_MAX; */
static void add_side(const goe_observation_t *obs, const goe_solid_t *solid, size_t side, float variance,
                     goe_rows_t *rows) {
    goe_touch_t touch;
    goe_gradient_t g;
    float *by = goe_touch_add(rows, obs, solid, side, variance, &touch, &g);
    if (!by) {
        return;
    }
    /* without base corners: half the skew deeper, as of a tangent */
    const float end = side == GOE_BOX_LEFT ? -0.5f : 0.5f;
    const float by_skew = obs->base || goe_touch_is_level(side) ? 0.0f : end * g.z;
    goe_rows_place(by, obs, g.x, g.z);
    by[GOE_INVERSE_RANGE] += g.y * obs->height_m;
    by[GOE_SIDE_X] = by_skew;
    by[GOE_FRONT_X] = 0.5f * (g.x * touch.outward.x + g.z * touch.outward.z);
    by[GOE_BEHIND_STATES] -= by_skew * obs->state[GOE_SIDE_X];
}

/*@ requires goe_observation_is_open(obs) && \valid_read(o) && goe_rows_hold(rows);
    requires rows->count + 3 <= GOE_ROWS_MAX; */
static void add_sides(const goe_observation_t *obs, const circle_t *o, float shape_rel, goe_rows_t *rows) {
    goe_solid_t solid;
    goe_touch_open(obs, obs->height_m, &solid);
    solid.center = o->center;
    solid.ellipse.half = 0.5f * obs->state[GOE_FRONT_X];
    solid.ellipse.shear = 0.0f;
    solid.ellipse.depth = solid.ellipse.half;
    solid.corners = 0;
    const float width = goe_touch_size(obs, GOE_BOX_LEFT, obs->state[GOE_FRONT_X]);
    const float height = goe_touch_size(obs, GOE_BOX_TOP, solid.ground - solid.roof);
    const float more = goe_square(shape_rel * width);
    const float wide = goe_touch_variance(obs, GOE_BOX_LEFT, width) + more;
    if (obs->base) {
        add_tangent(obs, o, GOE_POINT_BASE_LEFT, -1.0f, more, rows);
        add_tangent(obs, o, GOE_POINT_BASE_RIGHT, 1.0f, more, rows);
    } else {
        add_side(obs, &solid, GOE_BOX_LEFT, wide, rows);
        add_side(obs, &solid, GOE_BOX_RIGHT, wide, rows);
    }
    add_side(obs, &solid, GOE_BOX_TOP, goe_touch_variance(obs, GOE_BOX_TOP, height) + more, rows);
}

/*@ requires goe_observation_is_open(obs) && \valid_read(o) && goe_rows_hold(rows);
    requires rows->count + 3 <= GOE_ROWS_MAX; */
static void add_points(const goe_observation_t *obs, const circle_t *o, float shape_rel, goe_feature_t left,
                       goe_feature_t right, float width, goe_rows_t *rows) {
    const float extra = goe_square(shape_rel * width) + goe_square(obs->outline_share * width);
    add_tangent(obs, o, left, -1.0f, extra, rows);
    add_tangent(obs, o, right, 1.0f, extra, rows);
    add_top(obs, o, extra, rows);
}

void goe_disc_rows(const goe_observation_t *obs, goe_rows_t *rows) {
    circle_t circle;
    goe_feature_t left;
    goe_feature_t right;
    if (!describe(obs, &circle)) {
        return;
    }
    const bool wide = outline_features(obs, &left, &right);
    const float width = wide ? obs->point[right].x - obs->point[left].x : obs->state[GOE_FRONT_X] / circle.center.z;
    const float shape_rel =
        obs->settings->detector.shape_error_rel + (obs->base || obs->stand_in ? STAND_IN_SHAPE : 0.0f);
    if (goe_sides_see(obs->sides, GOE_SIDE_LEFT | GOE_SIDE_RIGHT)) {
        add_sides(obs, &circle, shape_rel, rows);
    } else {
        add_points(obs, &circle, shape_rel, left, right, width, rows);
    }
    if (obs->base) {
        add_base(obs, &circle, GOE_POINT_BASE_LEFT, width, rows);
        add_base(obs, &circle, GOE_POINT_BASE_RIGHT, width, rows);
    }
}

/* -------------------------------------------------------------------------------------------------------------- start -- */

/* (R18): flat ground, if the base lies clearly below the horizon; otherwise the typical size. */
static float first_range_m(const goe_observation_t *obs, float size) {
    const goe_navigation_t *navigation = &obs->settings->navigation;
    if (obs->base && obs->height_m > 0.0f) {
        const float y = 0.5f * (obs->point[GOE_POINT_BASE_LEFT].y + obs->point[GOE_POINT_BASE_RIGHT].y);
        const float sigma = sqrtf(goe_square(navigation->attitude_bias_sd_deg * GOE_RAD_PER_DEG) +
                                  goe_square(obs->white_rad) + goe_square(goe_observation_pixel(obs)));
        if (y > GROUND_SIGMAS * sigma) {
            return obs->height_m / y;
        }
    }
    return obs->settings->filter.prior_width_m / size;
}

static void set_root(const goe_observation_t *obs, const float state[GOE_STATES], goe_triangle_t *root) {
    const float width = state[GOE_FRONT_X];
    float sd[GOE_STATES];
    goe_observation_prior(obs, state, width, sd);
    sd[GOE_GROUND] = sqrtf(goe_observation_height_variance(obs, obs->sides->usable != 0)) * state[GOE_INVERSE_RANGE];
    sd[GOE_SIDE_X] = width;
    sd[GOE_FRONT_X] = WIDTH_FREEDOM * width;
    sd[GOE_DEPTH_DIFFERENCE] = width;
    goe_srif_from_sigmas(sd, root);
}

bool goe_disc_start(const goe_observation_t *obs, float state[GOE_STATES], goe_triangle_t *root) {
    goe_feature_t left;
    goe_feature_t right;
    if (!outline_features(obs, &left, &right)) {
        return false;
    }
    const float width = obs->point[right].x - obs->point[left].x;
    if (!(width >= WIDTH_MIN)) {
        return false;
    }
    const float to_left = 1.0f / sqrtf(1.0f + goe_square(obs->point[left].x)); /* cosines from Z */
    const float to_right = 1.0f / sqrtf(1.0f + goe_square(obs->point[right].x));
    const float ahead = to_left + to_right;
    const float middle = (obs->point[left].x * to_left + obs->point[right].x * to_right) / ahead;
    const float size = 2.0f * width * to_left * to_right / ahead;
    const float range_m = first_range_m(obs, size);
    const float z0_m = range_m + obs->camera_m.z;
    if (!(z0_m >= RANGE_MIN_M)) {
        return false;
    }
    const float top = obs->point[GOE_POINT_TOP].usable ? obs->point[GOE_POINT_TOP].y : 0.0f;
    memset(state, 0, GOE_STATES * sizeof state[0]);
    state[GOE_BEARING] = (middle * range_m + obs->camera_m.x) / z0_m;
    state[GOE_INVERSE_RANGE] = 1.0f / z0_m;
    state[GOE_FRONT_X] = size * range_m / z0_m;
    state[GOE_DEPTH_DIFFERENCE] = state[GOE_FRONT_X];
    state[GOE_TOP] = (obs->height_m - top * range_m) / z0_m;
    set_root(obs, state, root);
    return true;
}

/* --------------------------------------------------------------------------------------------------------- quantities -- */

/* Of the skew, on which the condition is. */
static float skew_of(const goe_filter_t *filter, float part[GOE_UNKNOWNS]) {
    return goe_larger(goe_srif_part(&filter->root, GOE_SIDE_X, part), VARIANCE_MIN);
}

bool goe_disc_is_skewed(const goe_filter_t *filter) {
    return goe_square(filter->state[GOE_SIDE_X]) > SKEWED_SIGMAS2 * goe_filter_variance(filter, GOE_SIDE_X);
}

/* (R7): conditions the state on zero skew, which is what a disc has. Its covariance with the states is R^-1 times its part; no quantity
 * depends on the first states. */
static void condition_state(const goe_filter_t *filter, float x[GOE_STATES]) {
    float with_skew[GOE_UNKNOWNS] = {0.0f};
    const float share = filter->state[GOE_SIDE_X] / skew_of(filter, with_skew);
    memcpy(x, filter->state, sizeof filter->state);
    for (size_t i = GOE_STATES; i-- > GOE_UNWEIGHTED;) {
        const float *r = &filter->root.element[goe_srif_row(i)];
        float sum = with_skew[i];
        for (size_t j = i + 1; j < GOE_STATES; j++) {
            sum -= r[j] * with_skew[j];
        }
        with_skew[i] = sum / r[i];
        x[i] -= with_skew[i] * share;
    }
}

/* (R39): the probability that it is no disc, by the skew, which a disc has none of, and which anything else shows sooner or later
 * as the line of sight turns. */
static float unlikeness(const goe_filter_t *filter, float variance, float turned) {
    const float width2 = goe_square(filter->state[GOE_FRONT_X]);
    const float chance = variance / (variance + goe_square(SKEW_SHARE) * width2);
    const float sigmas2 = goe_square(filter->state[GOE_SIDE_X]) / variance;
    const float shown2 = goe_square(turned / TURNED_SIGMAS) * width2 / variance;
    const float odds = sqrtf(chance) * goe_exp(0.5f * ((1.0f - chance) * sigmas2 - shown2));
    return odds / (1.0f + odds);
}

void goe_disc_doubt(const goe_filter_t *filter, bool asked, goe_xz_t camera_m, goe_shape_t *shape,
                    goe_disc_doubt_t *doubt) {
    const float variance = skew_of(filter, doubt->part);
    const float skew2 = goe_square(filter->state[GOE_SIDE_X]);
    doubt->skew_variance = variance;
    if (asked) {
        doubt->spread = sqrtf(goe_larger(skew2 - CHANCE_SHARE * variance, 0.0f));
        return;
    }
    const float unlike = unlikeness(filter, variance, goe_shape_turned(filter, camera_m));
    const float width_m = shape->quantity[GOE_WIDTH].value;
    doubt->spread = sqrtf(unlike * (skew2 + variance + goe_square(KINK_SHARE * filter->state[GOE_FRONT_X])));
    if (filter->candidate.stand_in) {
        shape->place_m2 = goe_square(STAND_IN_PLACE * width_m);
        shape->roof_m2 = shape->place_m2;
    } else {
        shape->place_m2 = unlike * goe_square(GOE_PLACE_SHARE * width_m);
        shape->roof_m2 = shape->place_m2;
        shape->width_m2 = unlike * goe_square(WIDTH_SHARE * width_m);
    }
}

float goe_disc_condition(const goe_disc_doubt_t *doubt, float projected[GOE_STATES]) {
    const float *part = doubt->part;
    float along = 0.0f;
    for (size_t j = GOE_SIDE_X; j < GOE_STATES; j++) {
        along += projected[j] * part[j];
    }
    along = along / doubt->skew_variance;
    for (size_t j = GOE_SIDE_X; j < GOE_STATES; j++) {
        projected[j] -= along * part[j];
    }
    return along * doubt->spread;
}

void goe_disc_shape(const goe_filter_t *filter, goe_shape_t *shape) {
    float x[GOE_STATES];
    condition_state(filter, x);
    goe_shape_line(filter, x, shape);
}

#endif
