/* Rows and start of a disc. SPDX-License-Identifier: MIT */
#include "refined/goe_disc.h"

#include <math.h>
#include <string.h>

#include "maths/goe_angle.h"
#include "maths/goe_scalar.h"

#define AHEAD_LEAST 1.0e-3f /* centre, units of Z0: nearer gives no rows */
#define TANGENT_AHEAD 0.02f /* third component of a tangent's unit vector */
#define SINE_LEAST 1.0e-5f  /* of half the angle that the disc covers */
#define SINE_MOST 0.98f
#define BOX_SHAPE 0.05f     /* shape_share that is added while a box is taken for a disc */
#define WIDTH_LEAST 1.0e-5f /* between left and right, focal lengths */
#define RANGE_LEAST_M 1.0f  /* of a first guess */
#define GROUND_SIGMAS 3.0f  /* by which the base must lie below the horizon to tell the range */
#define RANGE_FREEDOM 2.0f  /* one sigma of the first guess of 1/Z0, relative */
#define WIDTH_FREEDOM 5.0f  /* ... of the width */
#define TOP_FREEDOM 10.0f   /* ... of the top */
#define HEADING_ARM 0.08f   /* s/m: a yaw bias this large per m/s looks like a velocity bias */
#define BASE_NOISE 2.0f     /* variance of a base corner's y as range of the centre, over its own */

typedef struct {
    float px, pz; /* centre relative to the camera now, units of Z0 */
    float distance;
    float ex, ez;       /* unit vector to it */
    float sine, cosine; /* of half the angle that the disc covers */
} circle_t;

static bool describe(const goe_observation_t *sight, circle_t *o) {
    o->px = goe_observation_reference_x(sight);
    o->pz = goe_observation_reference_z(sight);
    if (!(o->pz >= AHEAD_LEAST)) {
        return false;
    }
    o->distance = sqrtf(o->px * o->px + o->pz * o->pz);
    o->ex = o->px / o->distance;
    o->ez = o->pz / o->distance;
    const float sine = 0.5f * sight->state[GOE_FX] / o->distance;
    o->sine = sine > SINE_MOST ? SINE_MOST : (sine > SINE_LEAST ? sine : SINE_LEAST);
    o->cosine = sqrtf(1.0f - o->sine * o->sine);
    return true;
}

/* Which features tell the width; false if none do. */
static bool outline_features(const goe_observation_t *sight, size_t *left, size_t *right) {
    const bool silhouette = sight->point[GOE_LEFT].usable && sight->point[GOE_RIGHT].usable;
    *left = silhouette || !sight->base ? GOE_LEFT : GOE_BASE_LEFT;
    *right = silhouette || !sight->base ? GOE_RIGHT : GOE_BASE_RIGHT;
    return silhouette || sight->base;
}

/* The tangent's azimuth is that of the centre plus or minus asin(r/d). */
static void add_tangent(const goe_observation_t *sight, const circle_t *o, size_t feature, float side,
                        float extra_variance, goe_rows_t *rows) {
    goe_gradient_t gx;
    goe_gradient_t gy;
    const goe_point_t *measured = &sight->point[feature];
    const float tx = o->ex * o->cosine + side * o->ez * o->sine;
    const float tz = o->ez * o->cosine - side * o->ex * o->sine;
    if (!measured->usable || tz < TANGENT_AHEAD) {
        return;
    }
    const float ray = tx / tz;
    const goe_point_t seen = goe_observation_project(sight, ray, measured->y, 1.0f, &gx, &gy);
    const float by_azimuth = (1.0f + ray * ray) * gx.x;
    const float by_sine = side / o->cosine;
    const float by_x = by_azimuth * (o->ez - by_sine * o->sine * o->ex) / o->distance;
    const float by_z = by_azimuth * (-o->ex - by_sine * o->sine * o->ez) / o->distance;
    const float variance = goe_observation_spread(sight, feature).xx + extra_variance;
    /* without base corners: half the skew deeper */
    const float by_skew = sight->base ? 0.0f : -0.5f * side * ray / o->pz * gx.x;
    const float residual = measured->x - seen.x - by_skew * sight->state[GOE_SX];
    const size_t row = goe_rows_add(rows, feature, residual, variance, &gx);
    goe_rows_set(rows, row, GOE_A, by_x);
    goe_rows_set(rows, row, GOE_Q, -(by_x * sight->dx_m) - by_z * sight->dz_m);
    goe_rows_set(rows, row, GOE_SX, by_skew);
    goe_rows_set(rows, row, GOE_FX, 0.5f * by_azimuth * by_sine / o->distance);
}

/* The nearest point of the upper rim; seen from above the highest in the image is the farthest. */
static void add_top(const goe_observation_t *sight, const circle_t *o, float extra_variance, goe_rows_t *rows) {
    goe_gradient_t gx;
    goe_gradient_t gy;
    const goe_point_t *measured = &sight->point[GOE_TOP];
    if (!measured->usable) {
        return;
    }
    const float y = sight->height_m * sight->state[GOE_Q] - sight->state[GOE_E];
    const float side = sight->settings->top_is_highest && y > 0.0f ? -1.0f : 1.0f;
    const float share = 1.0f - side * o->sine;
    const goe_point_t seen = goe_observation_project(sight, o->px * share, y, o->pz * share, &gx, &gy);
    const float radial = side * (gy.x * o->px + gy.z * o->pz); /* by -(sine of half the angle) */
    const float by_x = gy.x * share + radial * o->sine / o->distance * o->ex;
    const float by_z = gy.z * share + radial * o->sine / o->distance * o->ez;
    const float variance = goe_observation_spread(sight, GOE_TOP).yy + extra_variance;
    const size_t row = goe_rows_add(rows, GOE_TOP, measured->y - seen.y, variance, &gy);
    goe_rows_set(rows, row, GOE_A, by_x);
    goe_rows_set(rows, row, GOE_Q, gy.y * sight->height_m - by_x * sight->dx_m - by_z * sight->dz_m);
    goe_rows_set(rows, row, GOE_FX, -radial * 0.5f / o->distance);
    goe_rows_set(rows, row, GOE_E, -gy.y);
}

/* Range over flat ground: a base corner lies about half a width before or behind the centre. */
static void add_base(const goe_observation_t *sight, const circle_t *o, size_t feature, float width, goe_rows_t *rows) {
    goe_gradient_t gx;
    goe_gradient_t gy;
    const goe_point_t *measured = &sight->point[feature];
    const float q = sight->state[GOE_Q];
    const float height_m = sight->height_m + sight->state[GOE_DH];
    const goe_point_t seen = goe_observation_project(sight, o->px, height_m * q, o->pz, &gx, &gy);
    const float variance = goe_observation_spread(sight, feature).yy * BASE_NOISE + goe_square(seen.y * width);
    const size_t row = goe_rows_add(rows, feature, measured->y - seen.y, variance, &gy);
    goe_rows_set(rows, row, GOE_DH, gy.y * q);
    goe_rows_set(rows, row, GOE_A, gy.x);
    goe_rows_set(rows, row, GOE_Q, gy.y * height_m - gy.x * sight->dx_m - gy.z * sight->dz_m);
}

void goe_disc_rows(const goe_observation_t *sight, goe_rows_t *rows) {
    circle_t circle;
    size_t left;
    size_t right;
    if (!describe(sight, &circle)) {
        return;
    }
    const bool wide = outline_features(sight, &left, &right);
    const float width = wide ? sight->point[right].x - sight->point[left].x : 0.0f;
    const float shape = sight->settings->noise.shape_share + (sight->base ? BOX_SHAPE : 0.0f);
    const float extra = goe_square(shape * width) + goe_square(sight->settings->noise.size_share * width);
    add_tangent(sight, &circle, left, -1.0f, extra, rows);
    add_tangent(sight, &circle, right, 1.0f, extra, rows);
    add_top(sight, &circle, extra, rows);
    if (sight->base) {
        add_base(sight, &circle, GOE_BASE_LEFT, width, rows);
        add_base(sight, &circle, GOE_BASE_RIGHT, width, rows);
    }
}

/* -------------------------------------------------------------------------------------------------------------- start -- */

/* Flat ground, if the base lies clearly below the horizon; otherwise the typical size. */
static float first_range_m(const goe_observation_t *sight, float size) {
    const goe_noise_t *noise = &sight->settings->noise;
    if (sight->base && sight->height_m > 0.0f) {
        const float y = 0.5f * (sight->point[GOE_BASE_LEFT].y + sight->point[GOE_BASE_RIGHT].y);
        const float sigma =
            sqrtf(goe_square(noise->attitude_bias_deg * GOE_RAD_PER_DEG) +
                  goe_square(noise->attitude_white_deg * GOE_RAD_PER_DEG) + goe_square(goe_observation_pixel(sight)));
        if (y > GROUND_SIGMAS * sigma) {
            return sight->height_m / y;
        }
    }
    return sight->settings->typical_size_m / size;
}

static void first_root(const goe_settings_t *settings, const float state[GOE_STATES], goe_triangle_t *root) {
    const float bias = settings->noise.attitude_bias_deg * GOE_RAD_PER_DEG;
    const float top = goe_absolute(state[GOE_E]) > state[GOE_FX] ? goe_absolute(state[GOE_E]) : state[GOE_FX];
    memset(root, 0, sizeof *root);
    *goe_srif_at(root, GOE_BX, GOE_BX) = 1.0f / bias;
    *goe_srif_at(root, GOE_BY, GOE_BY) = 1.0f / bias;
    *goe_srif_at(root, GOE_BZ, GOE_BZ) =
        1.0f / sqrtf(goe_square(bias) + goe_square(HEADING_ARM * settings->noise.velocity_bias_m_s));
    *goe_srif_at(root, GOE_DH, GOE_DH) = 1.0f / settings->noise.height_m;
    *goe_srif_at(root, GOE_A, GOE_A) = 1.0f;
    *goe_srif_at(root, GOE_Q, GOE_Q) = 1.0f / (RANGE_FREEDOM * state[GOE_Q]);
    *goe_srif_at(root, GOE_SX, GOE_SX) = 1.0f / state[GOE_FX];
    *goe_srif_at(root, GOE_FX, GOE_FX) = 1.0f / (WIDTH_FREEDOM * state[GOE_FX]);
    *goe_srif_at(root, GOE_D, GOE_D) = 1.0f / state[GOE_FX];
    *goe_srif_at(root, GOE_E, GOE_E) = 1.0f / (TOP_FREEDOM * top);
}

bool goe_disc_start(const goe_observation_t *sight, float state[GOE_STATES], goe_triangle_t *root) {
    size_t left;
    size_t right;
    if (!outline_features(sight, &left, &right)) {
        return false;
    }
    const float width = sight->point[right].x - sight->point[left].x;
    if (!(width >= WIDTH_LEAST)) {
        return false;
    }
    const float middle = 0.5f * (sight->point[left].x + sight->point[right].x);
    const float size = width / sqrtf(1.0f + middle * middle);
    const float range_m = first_range_m(sight, size);
    const float z0_m = range_m + sight->dz_m;
    if (!(z0_m >= RANGE_LEAST_M)) {
        return false;
    }
    const float top = sight->point[GOE_TOP].usable ? sight->point[GOE_TOP].y : 0.0f;
    memset(state, 0, GOE_STATES * sizeof state[0]);
    state[GOE_A] = (middle * range_m + sight->dx_m) / z0_m;
    state[GOE_Q] = 1.0f / z0_m;
    state[GOE_FX] = size * range_m / z0_m;
    state[GOE_D] = state[GOE_FX];
    state[GOE_E] = (sight->height_m - top * range_m) / z0_m;
    first_root(sight->settings, state, root);
    return true;
}
