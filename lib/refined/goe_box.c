/* The box model: rows of an image, changes of the state, and quantities. SPDX-License-Identifier: MIT
 *
 * View from above, lengths in units of Z0; P: middle of the front edge relative to the present camera.
 *
 *        BL ------ BR          side edge  (sx, sz), from the front backwards
 *        |          |          front edge (fx, fz), fz = -fx sx/sz: perpendicular to the side, signed
 *        |          |          corner     P + across (fx, fz) + along (sx, sz)
 *        FL -- P -- FR */
#include "refined/goe_box.h"

#include <math.h>
#include <string.h>

#include "maths/goe_angle.h"
#include "maths/goe_scalar.h"
#include "refined/goe_touch.h"

#if GOE_WITH_FILTER

#define CORNER_AHEAD_MIN 0.01f  /* least Z of a corner in its direction X/Z */
#define ORDER_AHEAD_MIN 1.0e-3f /* the same for the order of corners */
#define SUM_MIN 1.0e-12f
#define CURVATURE 2.0f      /* factor on the second order of (R7), generous: its error is not Gaussian */
#define EXTENT_MIN 0.03f    /* smallest extent over the sum of all extents */
#define DEPTH_MIN 0.3f      /* smallest sz over |sx| */
#define EXCHANGE_SLOPE 1.3f /* tan b above which front and side exchange their names, in the state and in the report */
#define LENGTH_FREED 2.0f   /* relative sigma of the length when its face comes into view */
#define CORNER_GROWTH 12.0f /* (R22) */
#define CORNER_GROWTH_MAX 4.0f
#define POOR_SHARE 0.3f  /* largest sigma of the depth difference over both depths: beyond, two corners may be any */
#define FACE_RAD 0.14f   /* (R37), one sigma of the error if two ends are those of two faces: orientation, rad */
#define FACE_WIDTH 0.06f /* the same of the width, relative */
#define FACE_PLACE 0.1f  /* the same of the position, over the width */
#define FACE_ROOF 0.15f  /* the same of the roof's nearest corner, over the width */

enum { FRONT_LEFT, BACK_LEFT, BACK_RIGHT, FRONT_RIGHT, CORNERS }; /* clockwise */
enum { OUTER_LEFT, NEAR_CORNER, OUTER_RIGHT };

static const float across_of[CORNERS] = {-0.5f, -0.5f, 0.5f, 0.5f};
static const float along_of[CORNERS] = {0.0f, 1.0f, 1.0f, 0.0f};

typedef struct {
    goe_box_edges_t edges;
    goe_xz_t middle;   /* P */
    float curvature;   /* twice the second-order error of the depths by the variance of GOE_DEPTH_DIFFERENCE */
    float ground, top; /* Y of the base and of the roof */
    bool front, right; /* which side of the box the camera is on: front or back, right or left */
    bool far_half;     /* the camera is nearer to the back edge */
    goe_xz_t corner[CORNERS];
    float depth_margin,
        side_margin; /* how far the camera is outside of the box, along its side and across, units of Z0 */
} outline_t;

static float sign_of(float x) { return x > 0.0f ? 1.0f : -1.0f; }

void goe_box_edges(const float state[GOE_STATES], goe_box_edges_t *edges) {
    const float *x = state;
    goe_box_edges_t *e = edges;
    const float d = x[GOE_DEPTH_DIFFERENCE];
    const float across = goe_absolute(x[GOE_SIDE_X]);
    const float sign = sign_of(x[GOE_SIDE_X]);
    const float product = across * x[GOE_FRONT_X];
    const float sum = goe_larger(sqrtf(d * d + 4.0f * product), SUM_MIN);
    /* (R7): the larger root by addition, the smaller one from the product, so nothing cancels */
    const float larger = 0.5f * (sum + goe_absolute(d));
    const float smaller = product / larger;
    e->sum = sum;
    e->sign = sign;
    e->side.along.x = x[GOE_SIDE_X];
    e->side.along.z = goe_larger(d > 0.0f ? larger : smaller, SUM_MIN); /* a flipped bit may make it 0 */
    e->side.by[0] = sign * x[GOE_FRONT_X] / sum;
    e->side.by[1] = across / sum;
    e->side.by[2] = e->side.along.z / sum;
    e->front.along.x = x[GOE_FRONT_X];
    e->front.along.z = -sign * (d > 0.0f ? smaller : larger);
    e->front.by[0] = -sign * e->side.by[0];
    e->front.by[1] = -sign * e->side.by[1];
    e->front.by[2] = -e->front.along.z / sum;
    e->side.length = goe_larger(sqrtf(goe_xz_dot(e->side.along, e->side.along)), SUM_MIN);
    e->front.length = goe_larger(sqrtf(goe_xz_dot(e->front.along, e->front.along)), SUM_MIN);
}

void goe_box_enter(goe_filter_t *filter, goe_phase_t phase) {
    filter->naming.exchanged = false;
    filter->naming.decided = false;
    goe_filter_enter(filter, phase);
}

/* ------------------------------------------------------------------------------------------------------------ outline -- */

static void place_corners(outline_t *o) {
    const goe_xz_t side = o->edges.side.along;
    const goe_xz_t front = o->edges.front.along;
    for (size_t i = 0; i < CORNERS; i++) {
        o->corner[i].x = o->middle.x + across_of[i] * front.x + along_of[i] * side.x;
        o->corner[i].z = o->middle.z + across_of[i] * front.z + along_of[i] * side.z;
    }
}

static void describe(const goe_observation_t *obs, outline_t *o) {
    const float *x = obs->state;
    goe_box_edges_t *e = &o->edges;
    goe_box_edges(x, e);
    o->curvature = CURVATURE * 2.0f * goe_absolute(x[GOE_SIDE_X]) * x[GOE_FRONT_X] / (e->sum * e->sum * e->sum) *
                   obs->depth_variance;
    o->middle = goe_observation_reference(obs);
    o->ground = obs->height_m * x[GOE_INVERSE_RANGE] + x[GOE_GROUND];
    o->top = goe_observation_roof(obs);
    const float length = e->side.length;
    const float vx = e->side.along.x / length;
    const float vz = e->side.along.z / length;
    const float width = e->front.along.x / vz;
    const float across = vx * o->middle.z - vz * o->middle.x; /* of the camera, in the box's axes, from P */
    const float along = -(vx * o->middle.x + vz * o->middle.z);
    o->front = -along > along - length;
    o->right = across > 0.0f;
    o->far_half = along >= 0.5f * length;
    o->depth_margin = o->front ? -along : along - length;
    o->side_margin = (o->right ? across : -across) - 0.5f * width;
    place_corners(o);
}

/* ---------------------------------------------------------------------------------------------------- visible corners -- */

/* The corners at the left end, between and at the right end of one face, or of two faces. left: that at the left end. */
/*@ requires \valid(corner + (0 .. 2)) && left < CORNERS; */
static void corners_from(size_t left, bool two, size_t corner[3]) {
    corner[OUTER_LEFT] = left;
    corner[NEAR_CORNER] = (left + 3u) % CORNERS;
    corner[OUTER_RIGHT] = (left + (two ? 2u : 3u)) % CORNERS;
}

/* Error of the predicted distance between the outer corners in the image. This distance is more informative than their places: an error of
 * range or bearing moves both equally. */
/*@ requires goe_observation_is_open(obs) && \valid_read(o) && \valid_read(corner + (0 .. 2));
    requires corner[0] < CORNERS && corner[2] < CORNERS; */
static float misfit(const goe_observation_t *obs, const outline_t *o, const size_t corner[3]) {
    const goe_xz_t *l = &o->corner[corner[OUTER_LEFT]];
    const goe_xz_t *r = &o->corner[corner[OUTER_RIGHT]];
    const float wide = r->x / goe_larger(r->z, CORNER_AHEAD_MIN) - l->x / goe_larger(l->z, CORNER_AHEAD_MIN);
    return goe_absolute(obs->point[GOE_POINT_BASE_RIGHT].x - obs->point[GOE_POINT_BASE_LEFT].x - wide);
}

/* The near corner is visible, or both outer ones are. */
static void visible_corners(const goe_observation_t *obs, const outline_t *o, size_t corner[3]) {
    const bool near_visible = obs->point[GOE_POINT_BASE_NEAR].usable;
    const size_t of_two = o->front ? (o->right ? FRONT_LEFT : BACK_LEFT) : (o->right ? FRONT_RIGHT : BACK_RIGHT);
    const size_t along = o->front ? FRONT_LEFT : BACK_RIGHT;
    const size_t across = o->right ? FRONT_RIGHT : BACK_LEFT;
    corners_from(near_visible ? of_two : o->depth_margin > o->side_margin ? along : across, near_visible, corner);
    if (!near_visible && obs->two_faces && o->depth_margin > 0.0f && o->side_margin > 0.0f) {
        /* one face, or two faces whose common corner the detector missed */
        size_t both[3];
        corners_from(of_two, true, both);
        if (misfit(obs, o, both) < misfit(obs, o, corner)) {
            memcpy(corner, both, sizeof both);
        }
    }
}

/* Without base corners: those of least and greatest X/Z. */
static void widest_corners(const outline_t *o, size_t corner[3]) {
    float least = 0.0f;
    float most = 0.0f;
    for (size_t i = 0; i < CORNERS; i++) {
        const float z = o->corner[i].z;
        const float x = o->corner[i].x / (z > ORDER_AHEAD_MIN ? z : ORDER_AHEAD_MIN);
        if (i == 0 || x < least) {
            least = x;
            corner[OUTER_LEFT] = i;
        }
        if (i == 0 || x > most) {
            most = x;
            corner[OUTER_RIGHT] = i;
        }
    }
}

/* --------------------------------------------------------------------------------------------------------------- rows -- */

/* Sets the derivatives by place and extents in a corner's row from those by (X, Z), and adds the possible linearization error. */
/*@ requires goe_rows_hold(rows) && \valid(by + (0 .. GOE_UNKNOWNS - 1));
    requires \valid_read(o) && \valid_read(g) && corner < CORNERS && 1 <= rows->count <= GOE_ROWS_MAX; */
static void set_corner(goe_rows_t *rows, float by[restrict GOE_UNKNOWNS], const outline_t *o, size_t corner,
                       const goe_gradient_t *g) {
    const goe_box_edges_t *e = &o->edges;
    const float across = across_of[corner];
    const float along = along_of[corner];
    const float by_both = (along - across * e->sign) * g->z; /* by an equal change of both depths */
    const float missed = 0.5f * by_both * o->curvature;
    by[GOE_SIDE_X] = along * g->x + by_both * e->side.by[0];
    by[GOE_FRONT_X] = across * g->x + by_both * e->side.by[1];
    by[GOE_DEPTH_DIFFERENCE] = (along * e->side.by[2] + across * e->front.by[2]) * g->z;
    rows->variance[rows->count - 1u] += missed * missed;
}

/* (R9): adds two rows; the noise of the first is removed from the second. */
/*@ requires goe_observation_is_open(obs) && \valid_read(o) && goe_rows_hold(rows);
    requires feature < GOE_FEATURES && corner < CORNERS && rows->count + 2 <= GOE_ROWS_MAX; */
GOE_NOINLINE static void add_base_corner(const goe_observation_t *obs, const outline_t *o, goe_feature_t feature,
                                         size_t corner, goe_rows_t *rows) {
    goe_gradient_t gx;
    goe_gradient_t gy;
    const goe_point_t *measured = &obs->point[feature];
    const goe_spread_t spread = goe_observation_spread(obs, feature);
    const float share = spread.xy / spread.xx;
    goe_observation_project_x(obs, o->corner[corner].x, o->ground, o->corner[corner].z, &gx);
    goe_observation_project_y(obs, o->corner[corner].x, o->ground, o->corner[corner].z, &gy);
    gy.x -= share * gx.x;
    gy.y -= share * gx.y;
    gy.z -= share * gx.z;
    gy.ex -= share * gx.ex;
    gy.ey -= share * gx.ey;
    gy.ez -= share * gx.ez;
    float *by = goe_rows_add(rows, obs, feature, GOE_ALONG_X, measured->x, spread.xx, &gx);
    set_corner(rows, by, o, corner, &gx);
    by[GOE_GROUND] = gx.y;
    by = goe_rows_add(rows, obs, feature, GOE_ALONG_Y, measured->y, spread.yy - share * spread.xy, &gy);
    rows->series[rows->count - 1u]++; /* that of y follows that of x */
    by[GOE_BEHIND_STATES] -= share * (measured->x - gx.at);
    set_corner(rows, by, o, corner, &gy);
    by[GOE_GROUND] = gy.y;
}

/* (R10): the row of the upright edge above an outer corner, at the height at which it was measured. */
/*@ requires goe_observation_is_open(obs) && \valid_read(o) && goe_rows_hold(rows);
    requires feature < GOE_FEATURES && corner < CORNERS && rows->count < GOE_ROWS_MAX; */
static void add_silhouette(const goe_observation_t *obs, const outline_t *o, goe_feature_t feature, size_t corner,
                           goe_rows_t *rows) {
    goe_gradient_t g;
    float *by = goe_rows_add_edge(rows, obs, o->corner[corner], feature, goe_observation_size_variance(obs), &g);
    if (by != NULL) {
        set_corner(rows, by, o, corner, &g);
    }
}

/* Coordinate down in the raw image of a place on the roof, focal lengths, without the lens. */
static float down_of(const goe_observation_t *obs, const goe_xz_t *at, float top) {
    const float *r = obs->camera_to_axes;
    return (r[1] * at->x + r[4] * top + r[7] * at->z) / (r[2] * at->x + r[5] * top + r[8] * at->z);
}

/* The corner of the roof that is highest in the raw image: viewed from above a far one, and with a roll a lateral one. */
static size_t highest_corner(const goe_observation_t *obs, const outline_t *o) {
    size_t highest = 0;
    float least = down_of(obs, &o->corner[0], o->top);
    for (size_t i = 1; i < CORNERS; i++) {
        const float down = down_of(obs, &o->corner[i], o->top);
        if (down < least) {
            least = down;
            highest = i;
        }
    }
    return highest;
}

/* (R11): the corner of the roof at the top. */
static size_t top_corner(const goe_observation_t *obs, const outline_t *o) {
    if (obs->settings->filter.top_is_highest) {
        return highest_corner(obs, o);
    }
    return o->right ? (o->far_half ? BACK_RIGHT : FRONT_RIGHT) : (o->far_half ? BACK_LEFT : FRONT_LEFT);
}

static void add_top(const goe_observation_t *obs, const outline_t *o, goe_rows_t *rows) {
    goe_gradient_t g;
    const size_t corner = top_corner(obs, o);
    float *by =
        goe_rows_add_level(rows, obs, o->corner[corner], o->top, GOE_POINT_TOP, goe_observation_size_variance(obs), &g);
    if (by != NULL) {
        set_corner(rows, by, o, corner, &g);
        by[GOE_TOP] = -g.y;
    }
}

/* (R27): adds the row of a side, at the point that the side of an upright bounding box touches, not at the point that it replaces. */
/*@ requires goe_observation_is_open(obs) && \valid_read(o) && goe_solid_is_closed(solid) && goe_rows_hold(rows);
    requires side < GOE_BOX_SIDES && rows->count < GOE_ROWS_MAX; */
static void add_side(const goe_observation_t *obs, const outline_t *o, const goe_solid_t *solid, size_t side,
                     float variance, goe_rows_t *rows) {
    goe_touch_t touch;
    goe_gradient_t g;
    float *by = goe_touch_add(rows, obs, solid, side, variance, &touch, &g);
    if (by != NULL) {
        set_corner(rows, by, o, touch.corner, &g);
    }
}

/*@ requires goe_observation_is_open(obs) && \valid_read(o) && goe_rows_hold(rows);
    requires rows->count + 3 <= GOE_ROWS_MAX; */
static void add_sides(const goe_observation_t *obs, const outline_t *o, goe_rows_t *rows) {
    goe_solid_t solid;
    const float width = o->edges.front.along.x + goe_absolute(o->edges.side.along.x);
    solid.corner = o->corner;
    solid.corners = CORNERS;
    goe_touch_open(obs, obs->height_m, &solid);
    const float wide = goe_touch_variance(obs, GOE_BOX_LEFT, goe_touch_size(obs, GOE_BOX_LEFT, width));
    const float high = goe_touch_variance(obs, GOE_BOX_TOP, goe_touch_size(obs, GOE_BOX_TOP, o->ground - o->top));
    add_side(obs, o, &solid, GOE_BOX_LEFT, wide, rows);
    add_side(obs, o, &solid, GOE_BOX_RIGHT, wide, rows);
    add_side(obs, o, &solid, GOE_BOX_TOP, high, rows);
}

void goe_box_rows(const goe_observation_t *obs, goe_rows_t *rows) {
    outline_t outline;
    size_t corner[3] = {FRONT_LEFT, FRONT_LEFT, FRONT_LEFT};
    describe(obs, &outline);
    const bool near_visible = obs->point[GOE_POINT_BASE_NEAR].usable;
    if (obs->base && !near_visible && obs->two_faces &&
        obs->depth_variance > goe_square(POOR_SHARE * outline.edges.sum)) {
        return; /* the choice of the corners would be a guess, which the state would adopt */
    }
    if (obs->base || near_visible) {
        visible_corners(obs, &outline, corner);
        for (size_t i = OUTER_LEFT; i <= OUTER_RIGHT; i++) {
            if (obs->point[GOE_POINT_BASE_LEFT + i].usable) {
                add_base_corner(obs, &outline, (goe_feature_t)(GOE_POINT_BASE_LEFT + i), corner[i], rows);
            }
        }
    } else {
        widest_corners(&outline, corner);
    }
    if (obs->sides->usable != 0) {
        add_sides(obs, &outline, rows);
        return;
    }
    add_silhouette(obs, &outline, GOE_POINT_LEFT, corner[OUTER_LEFT], rows);
    add_silhouette(obs, &outline, GOE_POINT_RIGHT, corner[OUTER_RIGHT], rows);
    add_top(obs, &outline, rows);
}

/* ------------------------------------------------------------------------------------------------------------- upkeep -- */

/* Whether the side's depth, the positive root of (R7), is less than `depth`. */
static bool side_is_shorter(const float x[GOE_STATES], float depth) {
    return depth * (depth - x[GOE_DEPTH_DIFFERENCE]) > goe_absolute(x[GOE_SIDE_X]) * x[GOE_FRONT_X];
}

/* Limits the extents: if their sizes differ too much, the next image cannot be linearized at that box. */
void goe_box_clip(goe_filter_t *filter) {
    float *x = filter->state;
    const float least = EXTENT_MIN * (goe_absolute(x[GOE_SIDE_X]) + goe_absolute(x[GOE_FRONT_X]) +
                                      goe_absolute(x[GOE_DEPTH_DIFFERENCE]));
    x[GOE_FRONT_X] = goe_larger(x[GOE_FRONT_X], least);
    x[GOE_DEPTH_DIFFERENCE] =
        goe_larger(x[GOE_DEPTH_DIFFERENCE], DEPTH_MIN * goe_absolute(x[GOE_SIDE_X]) - x[GOE_FRONT_X] / DEPTH_MIN);
    if (side_is_shorter(x, least)) {
        x[GOE_DEPTH_DIFFERENCE] = least - goe_absolute(x[GOE_SIDE_X]) * x[GOE_FRONT_X] / least;
    }
}

/* While one face is visible, the length of the other edge is unobservable. If it were free, relinearization would pull it to zero, so it is
 * fixed until its face comes into view. */
static void free_length(goe_filter_t *filter, const goe_observation_t *obs) {
    goe_box_edges_t edges;
    goe_box_edges(filter->state, &edges);
    float direction[GOE_STATES] = {0.0f};
    direction[GOE_SIDE_X] = filter->state[GOE_SIDE_X];
    direction[GOE_DEPTH_DIFFERENCE] = edges.side.along.z;
    goe_observation_age(filter, obs);
    goe_srif_spread(&filter->root, direction, GOE_SIDE_X, GOE_DEPTH_DIFFERENCE, LENGTH_FREED);
    goe_filter_set_phase(filter, GOE_PHASE_BOX);
}

/* Exchanges the names of front and side in the state. A second exchange restores the state. */
static void exchange_state(float x[GOE_STATES]) {
    const float sign = sign_of(x[GOE_SIDE_X]);
    const float scale = 1.0f / (1.0f + 0.5f * x[GOE_DEPTH_DIFFERENCE]);
    const float side = x[GOE_SIDE_X];
    x[GOE_GROUND] *= scale;
    x[GOE_BEARING] = (x[GOE_BEARING] + 0.5f * (sign * x[GOE_FRONT_X] + side)) * scale;
    x[GOE_INVERSE_RANGE] *= scale;
    x[GOE_SIDE_X] = -sign * x[GOE_FRONT_X] * scale;
    x[GOE_FRONT_X] = goe_absolute(side) * scale;
    x[GOE_DEPTH_DIFFERENCE] = -x[GOE_DEPTH_DIFFERENCE] * scale;
    x[GOE_TOP] *= scale;
}

/* (R19): the derivative of the old states by the new ones is that of the reverse exchange. */
static void exchange_root(goe_filter_t *filter, const float was[GOE_STATES]) {
    goe_substitution_t old;
    const float *is = filter->state;
    const float sign = sign_of(is[GOE_SIDE_X]);
    const float scale = 1.0f / (1.0f + 0.5f * is[GOE_DEPTH_DIFFERENCE]);
    memset(&old, 0, sizeof old);
    for (size_t k = 0; k < GOE_CHANGED; k++) {
        old.by[k][GOE_OF_DEPTH] = -0.5f * scale * was[GOE_GROUND + k];
    }
    old.by[GOE_OF_DEPTH][GOE_OF_DEPTH] -= scale;
    old.by[GOE_OF_BEARING][GOE_OF_SIDE] = 0.5f * scale;
    old.by[GOE_OF_BEARING][GOE_OF_FRONT] = 0.5f * scale * sign;
    old.by[GOE_OF_SIDE][GOE_OF_FRONT] = -scale * sign;
    old.by[GOE_OF_FRONT][GOE_OF_SIDE] = scale * sign;
    old.by[GOE_OF_GROUND][GOE_OF_GROUND] = scale;
    old.by[GOE_OF_BEARING][GOE_OF_BEARING] = scale;
    old.by[GOE_OF_RANGE][GOE_OF_RANGE] = scale;
    old.by[GOE_OF_TOP][GOE_OF_TOP] = scale;
    goe_srif_substitute(&filter->root, &old);
}

static void exchange_names(goe_filter_t *filter, const goe_observation_t *obs) {
    float was[GOE_STATES];
    goe_observation_age(filter, obs);
    memcpy(was, filter->state, sizeof was);
    exchange_state(filter->state);
    exchange_root(filter, was);
    filter->naming.exchanged = !filter->naming.exchanged;
}

bool goe_box_change(goe_filter_t *filter, const goe_observation_t *obs) {
    if (goe_filter_traits(filter)->one_face && obs->base && obs->point[GOE_POINT_BASE_NEAR].usable) {
        free_length(filter, obs);
        return true;
    }
    if (side_is_shorter(filter->state, goe_absolute(filter->state[GOE_SIDE_X]) * (1.0f / EXCHANGE_SLOPE))) {
        exchange_names(filter, obs);
        return true;
    }
    return false;
}

/* --------------------------------------------------------------------------------------------------------- quantities -- */

void goe_box_name(goe_filter_t *filter) {
    goe_box_edges_t e;
    goe_box_edges(filter->state, &e);
    const goe_xz_t side = goe_filter_into_trajectory(filter, filter->naming.exchanged ? e.front.along : e.side.along);
    const float slope = filter->naming.decided ? EXCHANGE_SLOPE : 1.0f;
    if (goe_absolute(side.x) > slope * goe_absolute(side.z)) {
        filter->naming.exchanged = !filter->naming.exchanged;
    }
    filter->naming.decided = true;
}

/* The place `across` fronts and `along` sides away from the reference point. */
static void find_spot(const float x[GOE_STATES], const goe_box_edges_t *e, float across, float along,
                      goe_spot_t *spot) {
    spot->at.x = x[GOE_BEARING] + across * e->front.along.x + along * e->side.along.x;
    spot->at.z = 1.0f + across * e->front.along.z + along * e->side.along.z;
    spot->x_by[0] = along;
    spot->x_by[1] = across;
    spot->x_by[2] = 0.0f;
    for (int i = 0; i < 3; i++) {
        spot->z_by[i] = along * e->side.by[i] + across * e->front.by[i];
    }
}

/* Sets the length of an edge, m. extent: the state that is its lateral extent. */
/*@ requires \valid(length) && \valid_read(edge) && extent < GOE_STATES; */
static void set_edge(goe_linear_t *length, const goe_box_edge_t *edge, goe_state_index_t extent, float scale_m) {
    const float by_depth = edge->along.z / edge->length * scale_m;
    length->value = scale_m * edge->length;
    for (int i = 0; i < 3; i++) {
        length->by[GOE_SIDE_X + i] = by_depth * edge->by[i];
    }
    length->by[extent] += edge->along.x / edge->length * scale_m;
    length->by[GOE_INVERSE_RANGE] = -scale_m * scale_m * edge->length;
}

/* The derivatives are those of the side, because both edges turn together. */
static void set_orientation(goe_linear_t *orientation, const goe_box_edge_t *side, goe_xz_t length_axis) {
    const float scale = 1.0f / (side->length * side->length);
    const float by_depth = -side->along.x * scale;
    orientation->value = goe_arctan_rad(length_axis.x, length_axis.z);
    for (int i = 0; i < 3; i++) {
        orientation->by[GOE_SIDE_X + i] = by_depth * side->by[i];
    }
    orientation->by[GOE_SIDE_X] += side->along.z * scale;
}

static float corner_growth(const goe_filter_t *filter, const goe_box_edges_t *e) {
    const float relative = goe_filter_variance(filter, GOE_DEPTH_DIFFERENCE) / goe_square(e->sum);
    return 1.0f + CORNER_GROWTH * (relative < CORNER_GROWTH_MAX ? relative : CORNER_GROWTH_MAX);
}

/* (R37): adds variances while a single face is visible, because its ends may be the outer ends of two faces. */
static void doubt_face(goe_shape_t *shape) {
    const float size_m = goe_larger(shape->quantity[GOE_WIDTH].value, shape->quantity[GOE_LENGTH].value);
    shape->turned_rad2 = goe_square(FACE_RAD);
    shape->width_m2 = goe_square(FACE_WIDTH * size_m);
    shape->place_m2 = goe_square(FACE_PLACE * size_m);
    shape->roof_m2 = goe_square(FACE_ROOF * size_m);
}

void goe_box_shape(const goe_filter_t *filter, goe_shape_t *shape) {
    const float *x = filter->state;
    const bool exchanged = filter->naming.exchanged;
    goe_box_edges_t e;
    goe_spot_t reference;
    goe_box_edges(x, &e);
    const goe_box_edge_t *edge = exchanged ? &e.front : &e.side; /* the edge that is reported as side */
    const goe_xz_t axis = goe_filter_into_trajectory(filter, edge->along);
    const bool nearer = axis.z < 0.0f; /* the edge points toward the camera */
    const float length = nearer ? -edge->length : edge->length;
    const float half = nearer ? 0.5f : -0.5f; /* the end of the front from which the edge points away */
    find_spot(x, &e, exchanged ? half : 0.0f, exchanged ? 0.5f : 0.0f, &reference);
    goe_shape_start(filter, &reference, shape);
    find_spot(x, &e, 0.0f, 0.5f, &shape->middle);
    shape->length_axis.x = axis.x / length;
    shape->length_axis.z = axis.z / length;
    shape->corner_growth = corner_growth(filter, &e);
    set_orientation(&shape->quantity[GOE_ORIENTATION], &e.side, shape->length_axis);
    set_edge(&shape->quantity[exchanged ? GOE_WIDTH : GOE_LENGTH], &e.side, GOE_SIDE_X, shape->scale_m);
    set_edge(&shape->quantity[exchanged ? GOE_LENGTH : GOE_WIDTH], &e.front, GOE_FRONT_X, shape->scale_m);
    if (goe_filter_traits(filter)->one_face) {
        doubt_face(shape);
    }
}

#endif
