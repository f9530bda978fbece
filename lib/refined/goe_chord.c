/* Start, rows, changes and quantities of a chord. SPDX-License-Identifier: MIT */
#include "refined/goe_chord.h"

#include <math.h>
#include <string.h>

#include "maths/goe_scalar.h"
#include "refined/goe_box.h"
#include "refined/goe_disc.h"
#include "refined/goe_mover.h"
#include "refined/goe_touch.h"

#if GOE_WITH_FILTER

#define RANGE_SHARE 0.1f      /* one sigma of 1/Z0 over it, for a disc to change */
#define DISC_FREEDOM 0.05f    /* what the disc's tangents left behind in the chord, of its width */
#define END_AHEAD_MIN 1.0e-3f /* of an end, units of Z0 */
#define WIDTH_SHARE 0.15f     /* of the width by which corners that change unnoticed move its ends */
#define TOP_NOISE 0.3f        /* of the nearest corner's place, over the chord */
#define TOP_WALK 0.1f         /* the same from image to image */
#define TOP_MOVED 0.5f        /* ... and at the box's start */
#define MEMORY 0.25f          /* of one image in outward, turning */
#define SIGMAS2_MAX 25.0f     /* of one image */
#define LEAVING_SIGMAS 1.0f   /* outward: an end is leaving */
#define GONE_SIGMAS 1.8f      /* outward: an end has left */
#define TURNING_SIGMAS 0.4f
#define SETTLED_IMAGES 16    /* before an end can be taken to leave */
#define END_FREEDOM 0.5f     /* of an end that is learned again, over the chord */
#define DEPTH_UNNOTICED 0.1f /* what the images between a face's turning away and its being noticed did to the chord */
#define WIDTH_UNNOTICED 0.05f
#define CORNER_RAD 0.5f /* one sigma of the corner's place on the circle */
#define BOX_FREEDOM 0.01f
#define PLACE2_MAX 0.2401f /* (0.49)^2: of the corner's place along the chord from its middle; 1/2 is its end */
#define ZETA_MIN 0.3f
#define SIGMA_MIN 1.0e-6f

static float chord_length(const float x[GOE_STATES]) {
    return sqrtf(goe_square(x[GOE_SIDE_X]) + goe_square(x[GOE_FRONT_X]));
}

/* Aligned y of the top over the chord's middle. */
static float top_y(const goe_observation_t *obs) { return goe_observation_roof(obs) / goe_observation_ahead(obs); }

/*@ requires \valid(filter) && state < GOE_STATES; */
static void inflate(goe_filter_t *filter, goe_state_index_t state, float sigma) {
    goe_filter_inflate(filter, state, goe_larger(sigma, SIGMA_MIN));
}

/* --------------------------------------------------------------------------------------------------------------- rows -- */

/* (R8): an end of the chord, from the camera now, units of Z0. side: of the chord's middle, -1/2 left, +1/2 right. */
static goe_xz_t end_of(const goe_observation_t *obs, float side) {
    const goe_xz_t middle = goe_observation_reference(obs);
    const goe_xz_t end = {middle.x + side * obs->state[GOE_FRONT_X],
                          goe_larger(middle.z + side * obs->state[GOE_SIDE_X], END_AHEAD_MIN)};
    return end;
}

static void set_end(float by[GOE_UNKNOWNS], const goe_observation_t *obs, float side, const goe_gradient_t *g) {
    goe_rows_place(by, obs, g->x, g->z);
    by[GOE_SIDE_X] = side * g->z;
    by[GOE_FRONT_X] = side * g->x;
}

/* An upright edge, at the height at which it was measured. */
/*@ requires goe_observation_is_open(obs) && goe_rows_hold(rows);
    requires feature < GOE_FEATURES && rows->count < GOE_ROWS_MAX; */
static void add_end(const goe_observation_t *obs, goe_feature_t feature, float side, goe_rows_t *rows) {
    goe_gradient_t g;
    float *by = goe_rows_add_edge(rows, obs, end_of(obs, side), feature, goe_observation_size_variance(obs), &g);
    if (by != NULL) {
        set_end(by, obs, side, &g);
    }
}

/* Over the nearer end; from above the highest in the image is over the farther one. */
static void add_top(const goe_observation_t *obs, goe_rows_t *rows) {
    goe_gradient_t g;
    const goe_point_t *left = &obs->point[GOE_POINT_LEFT];
    const goe_point_t *right = &obs->point[GOE_POINT_RIGHT];
    const goe_xz_t middle = goe_observation_reference(obs);
    const float y = goe_observation_roof(obs);
    const bool highest = obs->settings->filter.top_is_highest && y > 0.0f;
    const bool right_is_near = middle.x * obs->state[GOE_FRONT_X] + middle.z * obs->state[GOE_SIDE_X] < 0.0f;
    const float side = right_is_near != highest ? 0.5f : -0.5f;
    float *by =
        goe_rows_add_level(rows, obs, end_of(obs, side), y, GOE_POINT_TOP, goe_observation_size_variance(obs), &g);
    if (!by) {
        return;
    }
    const float width = left->usable && right->usable ? right->x - left->x : 0.0f;
    *goe_rows_last_variance(rows) += goe_square(TOP_NOISE * g.at * width);
    set_end(by, obs, side, &g);
    by[GOE_INVERSE_RANGE] += g.y * obs->height_m;
    by[GOE_TOP] = -g.y;
}

/* (R29): what a side of an upright bounding box touches. */
/*@ requires goe_observation_is_open(obs) && goe_solid_is_closed(solid) && goe_rows_hold(rows);
    requires side < GOE_BOX_SIDES && rows->count < GOE_ROWS_MAX; */
static void add_side(const goe_observation_t *obs, const goe_solid_t *solid, size_t side, float size, float moved,
                     goe_rows_t *rows) {
    goe_touch_t touch;
    goe_gradient_t g;
    float *by = goe_touch_add(rows, obs, solid, side, goe_touch_variance(obs, side, size), &touch, &g);
    if (by == NULL) {
        return;
    }
    set_end(by, obs, touch.corner == 0 ? -0.5f : 0.5f, &g);
    by[GOE_INVERSE_RANGE] += g.y * obs->height_m;
    *goe_rows_last_variance(rows) += goe_square(moved * g.y * touch.point[1]);
}

/*@ requires goe_observation_is_open(obs) && goe_rows_hold(rows) && rows->count + 3 <= GOE_ROWS_MAX; */
static void add_sides(const goe_observation_t *obs, goe_rows_t *rows) {
    const goe_xz_t end[2] = {end_of(obs, -0.5f), end_of(obs, 0.5f)};
    goe_solid_t solid;
    goe_touch_open(obs, obs->height_m, &solid);
    solid.corner = end;
    solid.corners = 2;
    const float width = goe_touch_size(obs, GOE_BOX_LEFT, obs->state[GOE_FRONT_X]);
    const float height = goe_touch_size(obs, GOE_BOX_TOP, solid.ground - solid.roof);
    add_side(obs, &solid, GOE_BOX_LEFT, width, 0.0f, rows);
    add_side(obs, &solid, GOE_BOX_RIGHT, width, 0.0f, rows);
    add_side(obs, &solid, GOE_BOX_TOP, height, TOP_NOISE * width, rows);
}

void goe_chord_rows(const goe_observation_t *obs, goe_rows_t *rows) {
    if (obs->sides->usable != 0) {
        add_sides(obs, rows);
        return;
    }
    add_end(obs, GOE_POINT_LEFT, -0.5f, rows);
    add_end(obs, GOE_POINT_RIGHT, 0.5f, rows);
    add_top(obs, rows);
}

/* ------------------------------------------------------------------------------------------------------- from the disc -- */

/* Skew and diameter of the disc become depth and width of the chord: nothing else changes. */
bool goe_chord_start(goe_filter_t *filter, const goe_observation_t *obs) {
    const float most = RANGE_SHARE * filter->state[GOE_INVERSE_RANGE];
    if (obs->edge || obs->settings->model == GOE_MODEL_DISC ||
        !(goe_filter_variance(filter, GOE_INVERSE_RANGE) < most * most) || !goe_disc_is_skewed(filter)) {
        return false;
    }
    goe_observation_age(filter, obs);
    const float sigma = DISC_FREEDOM * filter->state[GOE_FRONT_X];
    inflate(filter, GOE_SIDE_X, sigma);
    inflate(filter, GOE_FRONT_X, sigma);
    filter->leaving.outward = 0.0f;
    filter->leaving.turning = 0.0f;
#if GOE_AUGMENTED
    goe_mover_doubt(filter);
#endif
    goe_filter_enter(filter, GOE_PHASE_CHORD);
    return true;
}

/* ------------------------------------------------------------------------------------------------------------- upkeep -- */

void goe_chord_free_top(goe_filter_t *filter, const goe_observation_t *obs) {
    inflate(filter, GOE_TOP, TOP_WALK * goe_absolute(top_y(obs)) * chord_length(filter->state));
}

void goe_chord_follow(goe_filter_t *filter, const goe_verdict_t *verdict) {
    if (verdict->odd >= GOE_FEATURES) {
        return;
    }
    const float most2 = SIGMAS2_MAX;
    const float sigmas = sqrtf(goe_within(verdict->odd_sigmas2, most2) ? verdict->odd_sigmas2 : most2);
    const float outward = verdict->odd_outward ? sigmas : -sigmas;
    filter->leaving.outward += (outward - filter->leaving.outward) * MEMORY;
    filter->leaving.turning +=
        ((verdict->odd == GOE_POINT_RIGHT ? outward : -outward) - filter->leaving.turning) * MEMORY;
}

bool goe_chord_is_leaving(const goe_filter_t *filter) { return filter->leaving.outward > LEAVING_SIGMAS; }

/* --------------------------------------------------------------------------------------------------------- to the box -- */

/* The successor of a chord: viewed from its middle, in its own units. */
typedef struct {
    goe_xz_t front, side, shift; /* shift: from the chord's middle to that of the front */
    float side_sign;             /* chord = front + side_sign side */
} faces_t;

/* The corner is on the circle over the chord, where the ray to the end that has left it meets it first. */
/*@ requires goe_observation_is_open(obs) && \valid(corner) && feature < GOE_FEATURES; */
static bool find_corner(const goe_observation_t *obs, goe_feature_t feature, goe_xz_t *corner) {
    const float *x = obs->state;
    const float ray = goe_observation_unbiased(obs, feature).x;
    const goe_xz_t middle = goe_observation_reference(obs);
    const float length2 = goe_square(x[GOE_FRONT_X]) + goe_square(x[GOE_SIDE_X]);
    const float outside = middle.x * middle.x + middle.z * middle.z - 0.25f * length2;
    const float along = ray * middle.x + middle.z;
    const float met = along * along - (1.0f + ray * ray) * outside;
    if (!(met > 0.0f) || !(outside > 0.0f)) {
        return false;
    }
    const float range = outside / (along + sqrtf(met));
    corner->x = range * ray - middle.x;
    corner->z = range - middle.z;
    const float place = (corner->x * x[GOE_FRONT_X] + corner->z * x[GOE_SIDE_X]) / length2;
    return place * place <= PLACE2_MAX;
}

/* The front is the edge that lies more across. */
static faces_t faces_at(const float x[GOE_STATES], goe_xz_t corner) {
    const goe_xz_t half = {0.5f * x[GOE_FRONT_X], 0.5f * x[GOE_SIDE_X]};
    const goe_xz_t from_left = {corner.x + half.x, corner.z + half.z};
    const goe_xz_t to_right = {half.x - corner.x, half.z - corner.z};
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
    if (!(zeta >= ZETA_MIN) || !(faces->front.x > 0.0f) || !(faces->side.z > 0.0f)) {
        return false;
    }
    const float scale = 1.0f / zeta;
    x[GOE_GROUND] *= scale;
    x[GOE_BEARING] = (x[GOE_BEARING] + faces->shift.x) * scale;
    x[GOE_INVERSE_RANGE] *= scale;
    x[GOE_SIDE_X] = faces->side.x * scale;
    x[GOE_FRONT_X] = faces->front.x * scale;
    x[GOE_DEPTH_DIFFERENCE] = (faces->side.z - goe_absolute(faces->front.z)) * scale;
    x[GOE_TOP] *= scale;
    return true;
}

/* (R21): derivatives of the chord by the box. The chord's middle is half a side behind that of the front; its idle state represents
 * the corner's place on the circle: twice the angle between chord and front, tan = side over front. */
static GOE_NOINLINE void differentiate(const float was[GOE_STATES], const float is[GOE_STATES], float side_sign,
                                       goe_substitution_t *old) {
    goe_box_edges_t box;
    goe_box_edges(is, &box);
    const float depth = box.side.along.z;
    const float scale = 1.0f / (1.0f + 0.5f * depth);
    const float turn = 2.0f / (goe_square(is[GOE_FRONT_X]) + goe_square(depth));
    memset(old, 0, sizeof *old);
    for (size_t i = 0; i < 3; i++) {
        const float side = box.side.by[i];
        for (size_t k = 0; k < GOE_CHANGED; k++) {
            old->by[k][GOE_OF_SIDE + i] = -0.5f * scale * was[GOE_GROUND + k] * side;
        }
        old->by[GOE_OF_SIDE][GOE_OF_SIDE + i] += scale * (box.front.by[i] + side_sign * side);
        old->by[GOE_OF_DEPTH][GOE_OF_SIDE + i] = turn * is[GOE_FRONT_X] * side;
    }
    old->by[GOE_OF_DEPTH][GOE_OF_FRONT] -= turn * depth;
    old->by[GOE_OF_BEARING][GOE_OF_SIDE] += 0.5f * scale;
    old->by[GOE_OF_FRONT][GOE_OF_SIDE] += side_sign * scale;
    old->by[GOE_OF_FRONT][GOE_OF_FRONT] += scale;
    old->by[GOE_OF_GROUND][GOE_OF_GROUND] = scale;
    old->by[GOE_OF_BEARING][GOE_OF_BEARING] = scale;
    old->by[GOE_OF_RANGE][GOE_OF_RANGE] = scale;
    old->by[GOE_OF_TOP][GOE_OF_TOP] = scale;
}

/* is: the state of the box. */
static void become_box(goe_filter_t *filter, const float is[GOE_STATES], float side_sign, float top) {
    goe_substitution_t old;
    const float *was = filter->state;
    const float length = chord_length(was);
    inflate(filter, GOE_SIDE_X, DEPTH_UNNOTICED * length);
    inflate(filter, GOE_FRONT_X, WIDTH_UNNOTICED * length);
    *goe_srif_at(&filter->root, GOE_DEPTH_DIFFERENCE, GOE_DEPTH_DIFFERENCE) = 1.0f / CORNER_RAD;
    differentiate(was, is, side_sign, &old);
    goe_srif_substitute(&filter->root, &old);
    memcpy(filter->state, is, sizeof filter->state);
    inflate(filter, GOE_SIDE_X, BOX_FREEDOM * length);
    inflate(filter, GOE_FRONT_X, BOX_FREEDOM * length);
    inflate(filter, GOE_DEPTH_DIFFERENCE, BOX_FREEDOM * length);
    inflate(filter, GOE_TOP, TOP_MOVED * top * length);
    goe_filter_forgive(filter);
    goe_box_enter(filter, GOE_PHASE_BOX_OUTLINE);
}

/*@ requires \valid(filter) && goe_observation_is_open(obs) && feature < GOE_FEATURES; */
static bool turn_face_away(goe_filter_t *filter, const goe_observation_t *obs, goe_feature_t feature) {
    float is[GOE_STATES];
    goe_xz_t corner;
    if (!find_corner(obs, feature, &corner)) {
        return false;
    }
    const float top = goe_absolute(top_y(obs));
    const faces_t faces = faces_at(filter->state, corner);
    memcpy(is, filter->state, sizeof is);
    if (!set_box(&faces, is)) {
        return false;
    }
    goe_observation_age(filter, obs);
    become_box(filter, is, faces.side_sign, top);
    return true;
}

static void relearn(goe_filter_t *filter, const goe_observation_t *obs) {
    goe_observation_age(filter, obs);
    const float sigma = END_FREEDOM * chord_length(filter->state);
    inflate(filter, GOE_SIDE_X, sigma);
    inflate(filter, GOE_FRONT_X, sigma);
    filter->leaving.outward = 0.0f;
    filter->phase_images = 0;
}

bool goe_chord_change(goe_filter_t *filter, const goe_observation_t *obs) {
    if (filter->phase_images < SETTLED_IMAGES || !(filter->leaving.outward > GONE_SIGMAS) ||
        !obs->point[GOE_POINT_LEFT].usable || !obs->point[GOE_POINT_RIGHT].usable ||
        !(goe_absolute(filter->leaving.turning) > TURNING_SIGMAS)) {
        return false;
    }
    /* as the bearing moves to the left, faces come into view on the right and turn away on the left */
    const bool right = filter->leaving.turning > 0.0f;
    const bool to_left = obs->camera_m.x > filter->state[GOE_BEARING] * obs->camera_m.z;
    if (right == to_left) {
        relearn(filter, obs);
        return true;
    }
    return turn_face_away(filter, obs, right ? GOE_POINT_RIGHT : GOE_POINT_LEFT);
}

/* --------------------------------------------------------------------------------------------------------- quantities -- */

void goe_chord_shape(const goe_filter_t *filter, goe_shape_t *shape) {
    goe_shape_line(filter, filter->state, shape);
    const float width_m = shape->quantity[GOE_WIDTH].value;
    shape->place_m2 = goe_square(GOE_PLACE_SHARE * width_m);
    shape->roof_m2 = shape->place_m2;
    shape->width_m2 = goe_square(WIDTH_SHARE * width_m);
}

#endif
