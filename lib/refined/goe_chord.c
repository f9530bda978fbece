/* Rows of a chord, and its changes. SPDX-License-Identifier: MIT */
#include "refined/goe_chord.h"

#include <math.h>
#include <string.h>

#include "maths/goe_scalar.h"
#include "refined/goe_box.h"

#define SKEWED_SIGMAS2 18.0f /* twice the log-likelihood ratio of chord against disc; cylinders stay below 14 */
#define RANGE_SHARE 0.1f     /* one sigma of 1/Z0 over it, for a disc to change */
#define DISC_FREEDOM 0.05f   /* what the disc's tangents left behind in the chord, of its width */
#define AHEAD_LEAST 1.0e-3f  /* of an end, units of Z0 */
#define AHEAD_TINY 0.02f     /* of the chord's middle */
#define TOP_NOISE 0.3f       /* of the nearest corner's place, over the chord */
#define TOP_FREEDOM 0.1f     /* the same from image to image */
#define TOP_MOVED 0.5f       /* ... and at the box's start */
#define MEMORY 0.25f         /* of one image in outward, turning */
#define SIGMAS2_MOST 25.0f   /* of one image */
#define LEFT_SIGMAS 1.0f     /* outward: an end is leaving */
#define GONE_SIGMAS 1.8f     /* outward: an end has left */
#define TURNING_SIGMAS 0.4f
#define SETTLED_IMAGES 16    /* before an end can be told to leave */
#define END_FREEDOM 0.5f     /* of an end that is learnt anew, over the chord */
#define DEPTH_UNNOTICED 0.1f /* what the images between a face's turning away and its being noticed did to the chord */
#define WIDTH_UNNOTICED 0.05f
#define CORNER_RAD 0.5f /* one sigma of the corner's place on the circle */
#define BOX_FREEDOM 0.01f
#define PLACE2_MOST 0.2401f /* (0.49)^2: of the corner's place along the chord from its middle; 1/2 is its end */
#define ZETA_LEAST 0.3f
#define SIGMA_LEAST 1.0e-6f

typedef struct {
    float x, z;
} vector_t;

static float chord_length(const float x[GOE_STATES]) { return sqrtf(goe_square(x[GOE_SX]) + goe_square(x[GOE_FX])); }

/* Aligned y of the top over the chord's middle. */
static float top_y(const goe_observation_t *sight) {
    const float *x = sight->state;
    return (sight->height_m * x[GOE_Q] - x[GOE_E]) / goe_larger(goe_observation_reference_z(sight), AHEAD_TINY);
}

static void spread(goe_filter_t *filter, size_t state, float sigma) {
    goe_srif_spread_state(&filter->root, state, goe_larger(sigma, SIGMA_LEAST));
}

/* --------------------------------------------------------------------------------------------------------------- rows -- */

/* An end of the chord. */
typedef struct {
    float x, z; /* from the camera now, units of Z0 */
    float side; /* of the chord's middle: -1/2 left, +1/2 right */
} end_t;

static end_t end_of(const goe_observation_t *sight, float side) {
    const float *x = sight->state;
    const float z = goe_observation_reference_z(sight) + side * x[GOE_SX];
    const end_t end = {goe_observation_reference_x(sight) + side * x[GOE_FX], goe_larger(z, AHEAD_LEAST), side};
    return end;
}

static void set_end(goe_rows_t *rows, size_t row, const goe_observation_t *sight, const end_t *end,
                    const goe_gradient_t *g) {
    goe_rows_set(rows, row, GOE_A, g->x);
    goe_rows_set(rows, row, GOE_Q, -(g->x * sight->dx_m) - g->z * sight->dz_m);
    goe_rows_set(rows, row, GOE_SX, end->side * g->z);
    goe_rows_set(rows, row, GOE_FX, end->side * g->x);
}

/* An upright edge, at the height at which it was measured. */
static void add_end(const goe_observation_t *sight, size_t feature, float side, goe_rows_t *rows) {
    goe_gradient_t gx;
    goe_gradient_t gy;
    const goe_point_t *measured = &sight->point[feature];
    if (!measured->usable) {
        return;
    }
    const end_t end = end_of(sight, side);
    const goe_point_t seen = goe_observation_project(sight, end.x, measured->y * end.z, end.z, &gx, &gy);
    const float variance = goe_observation_spread(sight, feature).xx + goe_observation_size_variance(sight);
    const size_t row = goe_rows_add(rows, feature, measured->x - seen.x, variance, &gx);
    set_end(rows, row, sight, &end, &gx);
}

/* Over the nearer end; seen from above the highest in the image is over the farther one. */
static void add_top(const goe_observation_t *sight, goe_rows_t *rows) {
    goe_gradient_t gx;
    goe_gradient_t gy;
    const float *x = sight->state;
    const goe_point_t *measured = &sight->point[GOE_TOP];
    if (!measured->usable) {
        return;
    }
    const float px = goe_observation_reference_x(sight);
    const float pz = goe_observation_reference_z(sight);
    const float y = sight->height_m * x[GOE_Q] - x[GOE_E];
    const bool highest = sight->settings->top_is_highest && y > 0.0f;
    const bool right_is_near = px * x[GOE_FX] + pz * x[GOE_SX] < 0.0f;
    const end_t end = end_of(sight, right_is_near != highest ? 0.5f : -0.5f);
    const goe_point_t seen = goe_observation_project(sight, end.x, y, end.z, &gx, &gy);
    const float width = sight->point[GOE_LEFT].usable && sight->point[GOE_RIGHT].usable
                            ? sight->point[GOE_RIGHT].x - sight->point[GOE_LEFT].x
                            : 0.0f;
    const float variance = goe_observation_spread(sight, GOE_TOP).yy + goe_observation_size_variance(sight) +
                           goe_square(TOP_NOISE * seen.y * width);
    const size_t row = goe_rows_add(rows, GOE_TOP, measured->y - seen.y, variance, &gy);
    set_end(rows, row, sight, &end, &gy);
    goe_rows_set(rows, row, GOE_Q, goe_rows_get(rows, row, GOE_Q) + gy.y * sight->height_m);
    goe_rows_set(rows, row, GOE_E, -gy.y);
}

void goe_chord_rows(const goe_observation_t *sight, goe_rows_t *rows) {
    add_end(sight, GOE_LEFT, -0.5f, rows);
    add_end(sight, GOE_RIGHT, 0.5f, rows);
    add_top(sight, rows);
}

/* ------------------------------------------------------------------------------------------------------- from the disc -- */

bool goe_chord_is_skewed(const goe_filter_t *filter) {
    return goe_square(filter->state[GOE_SX]) > SKEWED_SIGMAS2 * goe_inverse_variance(&filter->inverse, GOE_SX);
}

/* Skew and diameter of the disc become depth and width of the chord: nothing else changes. */
bool goe_chord_start(goe_filter_t *filter, const goe_observation_t *sight) {
    const float most = RANGE_SHARE * filter->state[GOE_Q];
    if (sight->edge || sight->settings->model == GOE_MODEL_DISC ||
        !(goe_inverse_variance(&filter->inverse, GOE_Q) < most * most) || !goe_chord_is_skewed(filter)) {
        return false;
    }
    const float sigma = DISC_FREEDOM * filter->state[GOE_FX];
    spread(filter, GOE_SX, sigma);
    spread(filter, GOE_FX, sigma);
    goe_refined_invert(filter);
    filter->outward = 0.0f;
    filter->turning = 0.0f;
    goe_refined_enter(filter, GOE_PHASE_CHORD);
    return true;
}

/* ------------------------------------------------------------------------------------------------------------- upkeep -- */

void goe_chord_free_top(goe_filter_t *filter, const goe_observation_t *sight) {
    spread(filter, GOE_E, TOP_FREEDOM * goe_absolute(top_y(sight)) * chord_length(filter->state));
}

void goe_chord_follow(goe_filter_t *filter, const goe_verdict_t *verdict) {
    if (verdict->held >= GOE_FEATURES) {
        return;
    }
    const float most2 = SIGMAS2_MOST;
    const float sigmas = sqrtf(goe_within(verdict->held_sigmas2, most2) ? verdict->held_sigmas2 : most2);
    const float outward = verdict->held_outward ? sigmas : -sigmas;
    filter->outward += (outward - filter->outward) * MEMORY;
    filter->turning += ((verdict->held == GOE_RIGHT ? outward : -outward) - filter->turning) * MEMORY;
}

bool goe_chord_is_left(const goe_filter_t *filter) { return filter->outward > LEFT_SIGMAS; }

/* --------------------------------------------------------------------------------------------------------- to the box -- */

/* What a chord becomes: seen from its middle, in its own units. */
typedef struct {
    vector_t front, side, shift; /* shift: from the chord's middle to that of the front */
    float side_sign;             /* chord = front + side_sign side */
} faces_t;

/* The corner stands on the circle over the chord, where the ray to the end that has left it meets it first. */
static bool find_corner(const goe_observation_t *sight, size_t feature, vector_t *corner) {
    const float *x = sight->state;
    const float ray = goe_observation_unbiased(sight, feature).x;
    const float px = goe_observation_reference_x(sight);
    const float pz = goe_observation_reference_z(sight);
    const float length2 = goe_square(x[GOE_FX]) + goe_square(x[GOE_SX]);
    const float outside = px * px + pz * pz - 0.25f * length2;
    const float along = ray * px + pz;
    const float met = along * along - (1.0f + ray * ray) * outside;
    if (!(met > 0.0f) || !(outside > 0.0f)) {
        return false;
    }
    const float range = outside / (along + sqrtf(met));
    corner->x = range * ray - px;
    corner->z = range - pz;
    const float place = (corner->x * x[GOE_FX] + corner->z * x[GOE_SX]) / length2;
    return place * place <= PLACE2_MOST;
}

/* The front is the edge that lies more across. */
static faces_t faces_at(const float x[GOE_STATES], vector_t corner) {
    const vector_t half = {0.5f * x[GOE_FX], 0.5f * x[GOE_SX]};
    const vector_t from_left = {corner.x + half.x, corner.z + half.z};
    const vector_t to_right = {half.x - corner.x, half.z - corner.z};
    faces_t faces;
    if (goe_absolute(from_left.x * to_right.z) > goe_absolute(from_left.z * to_right.x)) {
        faces.front = from_left;
        faces.side = to_right;
        faces.side_sign = 1.0f;
    } else {
        faces.front = to_right;
        faces.side.x = -from_left.x;
        faces.side.z = -from_left.z;
        faces.side_sign = -1.0f;
    }
    faces.shift.x = 0.5f * (corner.x - faces.side_sign * half.x);
    faces.shift.z = 0.5f * (corner.z - faces.side_sign * half.z);
    return faces;
}

/* False if these are no faces of a box. */
static bool set_box(const faces_t *faces, float x[GOE_STATES]) {
    const float zeta = 1.0f + faces->shift.z;
    if (!(zeta >= ZETA_LEAST) || !(faces->front.x > 0.0f) || !(faces->side.z > 0.0f)) {
        return false;
    }
    const float scale = 1.0f / zeta;
    x[GOE_A] = (x[GOE_A] + faces->shift.x) * scale;
    x[GOE_Q] *= scale;
    x[GOE_SX] = faces->side.x * scale;
    x[GOE_FX] = faces->front.x * scale;
    x[GOE_D] = (faces->side.z - goe_absolute(faces->front.z)) * scale;
    x[GOE_E] *= scale;
    return true;
}

/* Derivatives of the chord by the box. The chord's middle lies half a side behind that of the front; its idle state stands
 * for the corner's place on the circle: twice the angle between chord and front, tan = side over front. */
static void differentiate(const float was[GOE_STATES], const float is[GOE_STATES], float side_sign,
                          goe_substitution_t *old) {
    enum { OF_A, OF_Q, OF_SX, OF_FX, OF_D, OF_E };
    const goe_depth_t depth = goe_box_depth(is);
    const float sign = is[GOE_SX] > 0.0f ? -1.0f : 1.0f; /* of the front's depth */
    const float scale = 1.0f / (1.0f + 0.5f * depth.side);
    const float turn = 2.0f / (goe_square(is[GOE_FX]) + goe_square(depth.side));
    const float side[] = {depth.by_extents[0], depth.by_extents[1], depth.side_by_d};
    const float front[] = {sign * depth.by_extents[0], sign * depth.by_extents[1], sign * depth.front_by_d};
    memset(old, 0, sizeof *old);
    for (size_t i = 0; i < 3; i++) {
        for (size_t k = 0; k < GOE_CHANGED; k++) {
            old->by[k][OF_SX + i] = -0.5f * scale * was[GOE_A + k] * side[i];
        }
        old->by[OF_SX][OF_SX + i] += scale * (front[i] + side_sign * side[i]);
        old->by[OF_D][OF_SX + i] = turn * is[GOE_FX] * side[i];
    }
    old->by[OF_D][OF_FX] -= turn * depth.side;
    old->by[OF_A][OF_SX] += 0.5f * scale;
    old->by[OF_FX][OF_SX] += side_sign * scale;
    old->by[OF_FX][OF_FX] += scale;
    old->by[OF_A][OF_A] = scale;
    old->by[OF_Q][OF_Q] = scale;
    old->by[OF_E][OF_E] = scale;
}

static void become_box(goe_filter_t *filter, const float was[GOE_STATES], float side_sign, float top) {
    goe_substitution_t old;
    const float length = chord_length(was);
    spread(filter, GOE_SX, DEPTH_UNNOTICED * length);
    spread(filter, GOE_FX, WIDTH_UNNOTICED * length);
    *goe_srif_at(&filter->root, GOE_D, GOE_D) = 1.0f / CORNER_RAD;
    *goe_srif_at(&filter->root, GOE_D, GOE_E) = 0.0f;
    differentiate(was, filter->state, side_sign, &old);
    goe_srif_substitute(&filter->root, &old, &filter->rows);
    for (size_t i = GOE_SX; i <= GOE_D; i++) {
        spread(filter, i, BOX_FREEDOM * length);
    }
    spread(filter, GOE_E, TOP_MOVED * top * length);
    goe_refined_invert(filter);
    memset(filter->refused, 0, sizeof filter->refused);
    filter->outline = true;
    filter->deep = true;
    filter->exchanged = false;
    filter->named = false;
    goe_refined_enter(filter, GOE_PHASE_BOX);
}

static bool turn_face_away(goe_filter_t *filter, const goe_observation_t *sight, size_t feature) {
    float was[GOE_STATES];
    vector_t corner;
    if (!find_corner(sight, feature, &corner)) {
        return false;
    }
    const float top = goe_absolute(top_y(sight));
    const faces_t faces = faces_at(filter->state, corner);
    memcpy(was, filter->state, sizeof was);
    if (!set_box(&faces, filter->state)) {
        return false;
    }
    become_box(filter, was, faces.side_sign, top);
    return true;
}

static void learn_anew(goe_filter_t *filter) {
    const float sigma = END_FREEDOM * chord_length(filter->state);
    spread(filter, GOE_SX, sigma);
    spread(filter, GOE_FX, sigma);
    goe_refined_invert(filter);
    filter->outward = 0.0f;
    filter->since = 0;
}

bool goe_chord_change(goe_filter_t *filter, const goe_observation_t *sight) {
    if (filter->since < SETTLED_IMAGES || !(filter->outward > GONE_SIGMAS) || !sight->point[GOE_LEFT].usable ||
        !sight->point[GOE_RIGHT].usable || !(goe_absolute(filter->turning) > TURNING_SIGMAS)) {
        return false;
    }
    /* as the bearing moves to the left, faces come into view on the right and turn away on the left */
    const bool right = filter->turning > 0.0f;
    const bool to_left = sight->dx_m > filter->state[GOE_A] * sight->dz_m;
    if (right == to_left) {
        learn_anew(filter);
        return true;
    }
    return turn_face_away(filter, sight, right ? GOE_RIGHT : GOE_LEFT);
}
