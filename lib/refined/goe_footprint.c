/* The footprint model: rows of an image, memories of errors, and quantities. SPDX-License-Identifier: MIT */
#include "refined/goe_footprint.h"

#include <math.h>
#include <string.h>

#include "maths/goe_exp.h"
#include "maths/goe_scalar.h"
#include "refined/goe_side_memory.h"
#include "refined/goe_touch.h"

#if GOE_WITH_FILTER

#define DEPTH_MAX 2.0f       /* limit of |d|, and of its sigma in (R31): 7 times as deep as wide, or as flat */
#define DEPTH_TURNED 0.3f    /* sine of the turn of the line of sight above which images give the depth */
#define BENT_MIN 0.01f       /* sigma of the log of the depth below which its exponential is nearly linear */
#define FORCED_SIGMAS2 18.0f /* squared sigmas of the shear above which the obstacle is no disc */
#define SIDE_SHAPE                                                                                                     \
    0.05f /* one sigma by which corners displace the points left and right, over the width, if it may be no disc */
#define SHAPE_TURN 0.3f /* sine of the turn of the line of sight over which this error fades to 1/e */
#define RIM_SHAPE 0.1f  /* one sigma of the distance along Z from the rim's nearest point to the top, over the width */
#define CORNER_SHAPE 0.1f /* addition to shape_error_rel where base corners show that the obstacle is no ellipse */
#define BASE_NOISE 2.0f   /* factor on the variance of a base corner's y, where it gives the range of the middle */

/* Indices of the memories: sides of each camera's boxes by goe_box_side_t, then left and right as points. */
enum { SHAPE_LEFT = GOE_SIDE_MEMORIES - 2, SHAPE_RIGHT, MEMORIES };

GOE_STATIC_ASSERT(sizeof(((goe_filter_t *)0)->side) == MEMORIES * sizeof(goe_side_memory_t), every_side_has_a_memory);

/* Sine of the turn of the line of sight between two positions of the camera, each relative to the filter's start. */
static float turn_between(const goe_filter_t *filter, goe_xz_t from_m, goe_xz_t to_m) {
    const float q = filter->state[GOE_INVERSE_RANGE];
    const float a = filter->state[GOE_BEARING];
    const goe_xz_t was = {a - from_m.x * q, 1.0f - from_m.z * q};
    const goe_xz_t is = {a - to_m.x * q, 1.0f - to_m.z * q};
    const float lengths = sqrtf(goe_xz_dot(was, was) * goe_xz_dot(is, is));
    return (is.x * was.z - is.z * was.x) / goe_larger(lengths, GOE_AHEAD_MIN);
}

/* -------------------------------------------------------------------------------------------------------------- rows -- */

/*@ requires goe_observation_is_open(obs) && \valid(o); */
static void describe(const goe_observation_t *obs, goe_solid_t *o) {
    o->center = goe_observation_reference(obs);
    o->ellipse = goe_ellipse_of(obs->state);
    o->corners = 0;
    goe_touch_open(obs, obs->height_m, o);
}

/* The box's size along a side's coordinate, focal lengths: as measured, or as predicted. */
/*@ requires goe_observation_is_open(obs) && side < GOE_BOX_SIDES; */
static float size_of(const goe_observation_t *obs, size_t side) {
    const float *x = obs->state;
    return goe_touch_size(obs, side, goe_touch_is_level(side) ? x[GOE_TOP] + x[GOE_GROUND] : 2.0f * x[GOE_HALF]);
}

/* Sets a row's derivatives by the footprint, from those by the touched point. */
/*@ requires \valid(by + (0 .. GOE_UNKNOWNS - 1)) && \valid_read(o) && \valid_read(g); */
static void set_footprint(const goe_solid_t *o, const goe_contact_t *contact, const goe_gradient_t *g,
                          float by[GOE_UNKNOWNS]) {
    const goe_xz_t gradient = {g->x, g->z};
    const goe_by_footprint_t slope = goe_ellipse_slope(&o->ellipse, contact, gradient);
    by[GOE_SHEAR] = slope.shear;
    by[GOE_HALF] = slope.half;
    by[GOE_LOG_DEPTH] = slope.depth;
}

/* Memory of a side of the boxes of the image's camera. */
/*@ requires \valid_read(obs) && side < GOE_BOX_SIDES; */
static size_t memory_of(const goe_observation_t *obs, size_t side) {
#if GOE_CAMERAS_MAX > 1
    return (size_t)GOE_BOX_SIDES * (obs->number % (size_t)GOE_CAMERAS_MAX) + side;
#else
    (void)obs;
    return side;
#endif
}

/* Notes that the error of the last row is remembered, in the memory `side`. */
/*@ requires goe_rows_hold(rows) && rows->count > 0 && side < MEMORIES; */
static void remember(goe_rows_t *rows, size_t side) {
    rows->side[rows->count - 1u] = (uint8_t)side;
    rows->remembered = rows->count;
}

/* (R27): the row of a box's side. */
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
    set_footprint(o, &t.contact, &g, by);
    remember(rows, memory_of(obs, side));
}

/* (R5): the row of left or right as a point: the upright plane through it and the camera touches the footprint. outward: 1 on the right, -1
 * on the left. */
/*@ requires goe_observation_is_open(obs) && \valid_read(o) && goe_rows_hold(rows);
    requires feature < GOE_FEATURES && rows->count < GOE_ROWS_MAX; */
static void add_edge(const goe_observation_t *obs, const goe_solid_t *o, goe_feature_t feature, float outward,
                     float more, goe_rows_t *rows) {
    goe_gradient_t g;
    if (!obs->point[feature].usable) {
        return;
    }
    const float x = goe_observation_unbiased(obs, feature).x;
    const float scale = outward / sqrtf(1.0f + x * x);
    const goe_xz_t normal = {scale, -scale * x};
    const goe_contact_t contact = goe_ellipse_touch(&o->ellipse, normal);
    const goe_xz_t place = {o->center.x + contact.at.x, o->center.z + contact.at.z};
    float *by = place.z < GOE_AHEAD_MIN ? NULL : goe_rows_add_edge(rows, obs, place, feature, more, &g);
    if (by != NULL) {
        set_footprint(o, &contact, &g, by);
        remember(rows, outward > 0.0f ? SHAPE_RIGHT : SHAPE_LEFT);
    }
}

/* (R6): the row of the top, at the nearest point of the upper rim; from above, the highest one in the image is the farthest. This point
 * slides along the rim as the line of sight turns. */
/*@ requires goe_observation_is_open(obs) && \valid_read(o) && goe_rows_hold(rows) && rows->count < GOE_ROWS_MAX; */
static void add_rim(const goe_observation_t *obs, const goe_solid_t *o, float more, goe_rows_t *rows) {
    goe_gradient_t g;
    const float distance = sqrtf(goe_xz_dot(o->center, o->center)); /* at least GOE_AHEAD_MIN */
    const float away = (obs->settings->filter.top_is_highest && o->roof > 0.0f ? 1.0f : -1.0f) / distance;
    const goe_xz_t outward = {away * o->center.x, away * o->center.z};
    const goe_contact_t contact = goe_ellipse_touch(&o->ellipse, outward);
    const goe_xz_t rim = {o->center.x + contact.at.x, o->center.z + contact.at.z};
    float *by = rim.z < GOE_AHEAD_MIN ? NULL : goe_rows_add_level(rows, obs, rim, o->roof, GOE_POINT_TOP, more, &g);
    if (by == NULL) {
        return;
    }
    *goe_rows_last_variance(rows) += obs->is_round ? 0.0f : goe_square(2.0f * RIM_SHAPE * o->ellipse.half * g.z);
    const goe_xz_t gradient = {g.x, g.z};
    const goe_slide_t slide = goe_ellipse_slide(&o->ellipse, &contact, outward, gradient);
    const float along = goe_xz_dot(slide.by_outward, outward);
    set_footprint(o, &contact, &g, by);
    goe_rows_move(by, obs, g.x + away * (slide.by_outward.x - along * outward.x), g.y,
                  g.z + away * (slide.by_outward.z - along * outward.z));
    by[GOE_SHEAR] += slide.by.shear;
    by[GOE_HALF] += slide.by.half;
    by[GOE_LOG_DEPTH] += slide.by.depth;
    by[GOE_TOP] = -g.y;
}

/* (R2): the row of a base corner, range over flat ground. How far the corner is in front of or behind the middle is not known, and one
 * sigma of a whole width is allowed. */
/*@ requires goe_observation_is_open(obs) && \valid_read(o) && goe_rows_hold(rows);
    requires feature < GOE_FEATURES && rows->count < GOE_ROWS_MAX; */
static void add_base(const goe_observation_t *obs, const goe_solid_t *o, goe_feature_t feature, float width,
                     goe_rows_t *rows) {
    goe_gradient_t g;
    float *by = goe_rows_add_level(rows, obs, o->center, o->ground, feature, 0.0f, &g);
    if (by == NULL) {
        return;
    }
    float *variance = goe_rows_last_variance(rows);
    *variance = *variance * BASE_NOISE + goe_square(g.at * width);
    by[GOE_GROUND] = g.y;
}

/* Adds the rows of the points that no sides replace, and of the base corners. */
/*@ requires goe_observation_is_open(obs) && \valid_read(o) && goe_rows_hold(rows) && rows->count <= GOE_BOX_SIDES; */
static void add_points(const goe_observation_t *obs, const goe_solid_t *o, bool sides, goe_rows_t *rows) {
    goe_feature_t left;
    goe_feature_t right;
    const bool wide = goe_observation_ends(obs->point, &left, &right);
    const float width = wide ? obs->point[right].x - obs->point[left].x : 2.0f * o->ellipse.half / o->center.z;
    const float shape_rel = obs->settings->detector.shape_error_rel + (obs->base ? CORNER_SHAPE : 0.0f);
    const float more = goe_square(shape_rel * width) + goe_square(obs->outline_share * width);
    if (!sides) {
        add_edge(obs, o, left, -1.0f, more, rows);
        add_edge(obs, o, right, 1.0f, more, rows);
        add_rim(obs, o, more, rows);
    }
    if (obs->base) {
        add_base(obs, o, GOE_POINT_BASE_LEFT, width, rows);
        add_base(obs, o, GOE_POINT_BASE_RIGHT, width, rows);
    }
}

void goe_footprint_rows(const goe_observation_t *obs, goe_rows_t *rows) {
    goe_solid_t solid;
    const bool sides = obs->sides->usable != 0;
    describe(obs, &solid);
    if (!(solid.center.z >= GOE_AHEAD_MIN)) {
        return;
    }
    for (size_t side = 0; side < GOE_BOX_SIDES; side++) {
        add_side(obs, &solid, side, rows);
    }
    add_points(obs, &solid, sides, rows);
}

/* ------------------------------------------------------------------------------------------------------ sides' errors -- */

/* The errors of a box's sides fade with time, those of a shape that is no ellipse with the turn of the line of sight. */
static void fade(goe_filter_t *filter, const goe_observation_t *obs, const goe_rows_t *rows) {
    const float kept =
        goe_exp(-goe_absolute(turn_between(filter, goe_filter_measured(filter), obs->camera_m)) / SHAPE_TURN);
    const float shape2 = obs->is_round ? 0.0f : goe_square(SIDE_SHAPE * size_of(obs, GOE_BOX_LEFT));
    for (size_t side = 0; side < GOE_BOX_SIDES; side++) {
        const float share = obs->settings->detector.box_noise_rel;
        goe_side_memory_fade(&filter->side[memory_of(obs, side)], obs->fade, goe_square(share * size_of(obs, side)));
    }
    if (rows->count > 0) { /* otherwise the next image includes this turn */
        goe_side_memory_fade(&filter->side[SHAPE_LEFT], kept, shape2);
        goe_side_memory_fade(&filter->side[SHAPE_RIGHT], kept, shape2);
    }
}

void goe_footprint_recall(goe_filter_t *filter, const goe_observation_t *obs, goe_rows_t *rows) {
    fade(filter, obs, rows);
    for (size_t i = 0; i < rows->remembered; i++) {
        goe_side_memory_recall(&filter->side[rows->side[i]], rows->matrix->row[i], &rows->variance[i]);
    }
}

/* Product of the derivatives of two rows by the attitude of the image. */
static float attitude_of(const float a[GOE_COLUMNS], const float b[GOE_COLUMNS]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

void goe_footprint_learn(goe_filter_t *filter, goe_rows_t *rows) {
    static const float none[GOE_COLUMNS] = {0.0f};
    for (size_t i = 0; i < rows->remembered; i++) {
        const float *row = rows->matrix->row[i];
        const float *opposite = none;
        for (size_t j = 0; j < rows->remembered; j++) {
            if (j != i && rows->axis[j] == rows->axis[i]) {
                opposite = rows->matrix->row[j];
            }
        }
        const float own2 = attitude_of(row, row);
        const float all2 = own2 + attitude_of(opposite, opposite) + 1.0f / goe_square(rows->white_rad);
        goe_side_memory_learn(&filter->side[rows->side[i]], row, rows->weight[i], own2 / all2, opposite,
                              attitude_of(row, opposite) / all2);
    }
}

void goe_footprint_follow(goe_filter_t *filter, const float change[GOE_UNKNOWNS]) {
    float *depth = &filter->state[GOE_LOG_DEPTH];
    for (size_t side = 0; side < MEMORIES; side++) {
        goe_side_memory_follow(&filter->side[side], change);
    }
    *depth = *depth > DEPTH_MAX ? DEPTH_MAX : (*depth > -DEPTH_MAX ? *depth : -DEPTH_MAX);
}

/* --------------------------------------------------------------------------------------------------------- quantities -- */

/* (R31). */
void goe_footprint_shape(const goe_filter_t *filter, goe_shape_t *shape) {
    const float *x = filter->state;
    goe_spot_t reference;
    memset(&reference, 0, sizeof reference);
    reference.at.x = x[GOE_BEARING];
    reference.at.z = 1.0f;
    goe_shape_start(filter, &reference, shape);
    shape->middle = reference;
    const float scale_m = shape->scale_m;
    goe_linear_t *width = &shape->quantity[GOE_WIDTH];
    width->value = 2.0f * x[GOE_HALF] * scale_m;
    width->by[GOE_INVERSE_RANGE] = -scale_m * width->value;
    width->by[GOE_HALF] = 2.0f * scale_m;
}

/* ------------------------------------------------------------------------------------------------------ depth -- */

bool goe_footprint_knows_depth(const goe_filter_t *filter) {
    const goe_xz_t start_m = {0.0f, 0.0f};
    return goe_absolute(turn_between(filter, start_m, goe_filter_measured(filter))) > DEPTH_TURNED;
}

/* The last state's sigma depends on its own row of R alone. */
float goe_footprint_bend(const goe_filter_t *filter) {
    const float last = filter->root.element[goe_srif_row(GOE_LOG_DEPTH) + GOE_LOG_DEPTH];
    const float sd = 1.0f / goe_larger(goe_absolute(last), 1.0f / DEPTH_MAX);
    return sd > BENT_MIN ? (goe_exp(sd) - 1.0f) / sd : 1.0f;
}

bool goe_footprint_is_forced(const goe_filter_t *filter) {
    return goe_square(filter->state[GOE_SHEAR]) > FORCED_SIGMAS2 * goe_filter_variance(filter, GOE_SIDE_X);
}

#endif
