/* Rows of a box. SPDX-License-Identifier: MIT
 *
 * Seen from above, lengths in units of Z0; P: middle of the front edge relative to the camera now.
 *
 *        BL ------ BR          side edge  (sx, sz), from the front backwards
 *        |          |          front edge (fx, fz), fz = -fx sx/sz
 *        |          |          corner     P + across (fx, fz) + along (sx, sz)
 *        FL -- P -- FR */
#include "refined/goe_box.h"

#include <math.h>
#include <string.h>

#include "maths/goe_scalar.h"

#define AHEAD_LEAST 0.01f  /* range below which a corner's direction is not compared */
#define AHEAD_TINY 1.0e-3f /* ... or ordered */
#define SUM_LEAST 1.0e-12f
#define CURVATURE 2.0f  /* generous: the error is not a Gaussian one */
#define CLEARLY_PX 4.0f /* sigmas of a pixel by which one reading of the outline must fit better */

enum { FRONT_LEFT, BACK_LEFT, BACK_RIGHT, FRONT_RIGHT, CORNERS }; /* clockwise */
enum { FACE_FRONT, FACE_RIGHT, FACE_BACK, FACE_LEFT };
enum { OUTER_LEFT, NEAR_CORNER, OUTER_RIGHT };

static const float across_of[CORNERS] = {-0.5f, -0.5f, 0.5f, 0.5f};
static const float along_of[CORNERS] = {0.0f, 1.0f, 1.0f, 0.0f};

typedef struct {
    float q, sx, fx, sz, fz; /* fz: see above */
    float px, pz;            /* P */
    goe_depth_t depth;
    float sign;                      /* of sx: the front edge comes nearer to the right (+) or to the left (-) */
    float curvature;                 /* one sigma of what linearising the depths at an uncertain GOE_D misses */
    float ground, top;               /* Y of the base and of the roof */
    bool front, right;               /* which side of the box the camera is on */
    bool far_half;                   /* it is nearer to the back edge */
    float depth_margin, side_margin; /* how far it is outside of the box along and across its axes, units of Z0 */
} outline_t;

goe_depth_t goe_box_depth(const float state[GOE_STATES]) {
    goe_depth_t depth;
    const float d = state[GOE_D];
    const float product = goe_absolute(state[GOE_SX]) * state[GOE_FX];
    const float sum = goe_larger(sqrtf(d * d + 4.0f * product), SUM_LEAST);
    /* the larger one by adding, the smaller one by the product: no cancellation */
    const float larger = 0.5f * (sum + goe_absolute(d));
    depth.sum = sum;
    depth.side = d > 0.0f ? larger : product / larger;
    depth.front = d > 0.0f ? product / larger : larger;
    depth.by_extents[0] = (state[GOE_SX] > 0.0f ? state[GOE_FX] : -state[GOE_FX]) / sum;
    depth.by_extents[1] = goe_absolute(state[GOE_SX]) / sum;
    depth.side_by_d = depth.side / sum;
    depth.front_by_d = -depth.front / sum;
    return depth;
}

static void describe(const goe_observation_t *sight, outline_t *o) {
    const float *x = sight->state;
    o->depth = goe_box_depth(x);
    o->q = x[GOE_Q];
    o->sx = x[GOE_SX];
    o->fx = x[GOE_FX];
    o->sz = o->depth.side;
    o->sign = o->sx > 0.0f ? 1.0f : -1.0f;
    o->fz = -o->sign * o->depth.front;
    o->curvature = CURVATURE * 2.0f * goe_absolute(o->sx) * o->fx / (o->depth.sum * o->depth.sum * o->depth.sum) *
                   sight->depth_variance;
    o->px = goe_observation_reference_x(sight);
    o->pz = goe_observation_reference_z(sight);
    o->ground = (sight->height_m + x[GOE_DH]) * o->q;
    o->top = sight->height_m * o->q - x[GOE_E];
    const float length = sqrtf(o->sx * o->sx + o->sz * o->sz);
    const float vx = o->sx / length;
    const float vz = o->sz / length;
    const float width = o->fx / vz;
    const float across = vx * o->pz - vz * o->px; /* of the camera, in the box's axes, from P */
    const float along = -(vx * o->px + vz * o->pz);
    o->front = -along > along - length;
    o->right = across > 0.0f;
    o->far_half = along >= 0.5f * length;
    o->depth_margin = o->front ? -along : along - length;
    o->side_margin = (o->right ? across : -across) - 0.5f * width;
}

static float corner_x(const outline_t *o, size_t corner) {
    return o->px + across_of[corner] * o->fx + along_of[corner] * o->sx;
}

static float corner_z(const outline_t *o, size_t corner) {
    return o->pz + across_of[corner] * o->fz + along_of[corner] * o->sz;
}

/* ---------------------------------------------------------------------------------------------------- visible corners -- */

/* Corners at the left end, between and at the right end of one face, or of two faces that begin with `face`. */
static void corners_of_faces(size_t face, bool two, size_t corner[3]) {
    corner[OUTER_LEFT] = (CORNERS - face) % CORNERS;
    corner[NEAR_CORNER] = (corner[OUTER_LEFT] + 3u) % CORNERS;
    corner[OUTER_RIGHT] = (corner[OUTER_LEFT] + (two ? 2u : 3u)) % CORNERS;
}

/* Sum of what the outer corners are off in the image. */
static float misfit(const goe_observation_t *sight, const outline_t *o, const size_t corner[3]) {
    float sum = 0.0f;
    for (size_t i = OUTER_LEFT; i <= OUTER_RIGHT; i += 2) {
        const float z = corner_z(o, corner[i]);
        const float x = corner_x(o, corner[i]) / (z > AHEAD_LEAST ? z : AHEAD_LEAST);
        sum += goe_absolute(sight->point[GOE_BASE_LEFT + i].x - x);
    }
    return sum;
}

static void visible_corners(const goe_observation_t *sight, const outline_t *o, size_t corner[3]) {
    const size_t first_of_two = o->front ? (o->right ? FACE_FRONT : FACE_LEFT) : (o->right ? FACE_RIGHT : FACE_BACK);
    if (sight->point[GOE_BASE_NEAR].usable) {
        corners_of_faces(first_of_two, true, corner);
        return;
    }
    const size_t along = o->front ? FACE_FRONT : FACE_BACK;
    const size_t across = o->right ? FACE_RIGHT : FACE_LEFT;
    corners_of_faces(o->depth_margin > o->side_margin ? along : across, false, corner);
    if (sight->deep && sight->base && o->depth_margin > 0.0f && o->side_margin > 0.0f) {
        /* one face, or two and the detector missed the corner between them: whichever fits clearly better */
        size_t both[3];
        corners_of_faces(first_of_two, true, both);
        const float clearly = CLEARLY_PX * goe_observation_pixel(sight);
        if (misfit(sight, o, both) + clearly < misfit(sight, o, corner)) {
            memcpy(corner, both, sizeof both);
        }
    }
}

/* Without base corners: those of least and greatest X/Z. */
static void widest_corners(const outline_t *o, size_t corner[3]) {
    float least = 0.0f;
    float most = 0.0f;
    for (size_t i = 0; i < CORNERS; i++) {
        const float z = corner_z(o, i);
        const float x = corner_x(o, i) / (z > AHEAD_TINY ? z : AHEAD_TINY);
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

/* Derivatives by the place and the outline of a corner, from those by (X, Z); and what their linearisation may miss. */
static void set_corner(goe_rows_t *rows, size_t row, const goe_observation_t *sight, const outline_t *o, size_t corner,
                       const goe_gradient_t *g) {
    const float across = across_of[corner];
    const float along = along_of[corner];
    const float by_both = (along - across * o->sign) * g->z; /* by side and front depth as their sum moves them */
    const float missed = 0.5f * by_both * o->curvature;
    goe_rows_set(rows, row, GOE_A, g->x);
    goe_rows_set(rows, row, GOE_Q, -(g->x * sight->dx_m) - g->z * sight->dz_m);
    goe_rows_set(rows, row, GOE_SX, along * g->x + by_both * o->depth.by_extents[0]);
    goe_rows_set(rows, row, GOE_FX, across * g->x + by_both * o->depth.by_extents[1]);
    goe_rows_set(rows, row, GOE_D, (along * o->depth.side_by_d - across * o->sign * o->depth.front_by_d) * g->z);
    rows->variance[row] += missed * missed;
}

/* ... and by the height of what stands at Y = height q. */
static void set_height(goe_rows_t *rows, size_t row, float y, float height_m) {
    goe_rows_set(rows, row, GOE_Q, goe_rows_get(rows, row, GOE_Q) + y * height_m);
}

/* Two rows, the second free of the first one's noise. */
static void add_base_corner(const goe_observation_t *sight, const outline_t *o, size_t feature, size_t corner,
                            goe_rows_t *rows) {
    goe_gradient_t gx;
    goe_gradient_t gy;
    const float height_m = sight->height_m + sight->state[GOE_DH];
    const goe_point_t *measured = &sight->point[feature];
    const goe_point_t seen =
        goe_observation_project(sight, corner_x(o, corner), o->ground, corner_z(o, corner), &gx, &gy);
    const goe_spread_t spread = goe_observation_spread(sight, feature);
    const float share = spread.xy / spread.xx;
    const float rx = measured->x - seen.x;
    const float ry = measured->y - seen.y - share * rx;
    gy.x -= share * gx.x;
    gy.y -= share * gx.y;
    gy.z -= share * gx.z;
    gy.ex -= share * gx.ex;
    gy.ey -= share * gx.ey;
    gy.ez -= share * gx.ez;
    size_t row = goe_rows_add(rows, feature, rx, spread.xx, &gx);
    set_corner(rows, row, sight, o, corner, &gx);
    set_height(rows, row, gx.y, height_m);
    goe_rows_set(rows, row, GOE_DH, gx.y * o->q);
    row = goe_rows_add(rows, feature, ry, spread.yy - share * spread.xy, &gy);
    set_corner(rows, row, sight, o, corner, &gy);
    set_height(rows, row, gy.y, height_m);
    goe_rows_set(rows, row, GOE_DH, gy.y * o->q);
}

/* The vertical edge over an outer corner, at the height at which it was measured. */
static void add_silhouette(const goe_observation_t *sight, const outline_t *o, size_t feature, size_t corner,
                           goe_rows_t *rows) {
    goe_gradient_t gx;
    goe_gradient_t gy;
    const goe_point_t *measured = &sight->point[feature];
    if (!measured->usable) {
        return;
    }
    const float z = corner_z(o, corner);
    const goe_point_t seen = goe_observation_project(sight, corner_x(o, corner), measured->y * z, z, &gx, &gy);
    const float variance = goe_observation_spread(sight, feature).xx + goe_observation_size_variance(sight);
    const size_t row = goe_rows_add(rows, feature, measured->x - seen.x, variance, &gx);
    set_corner(rows, row, sight, o, corner, &gx);
}

/* The corner of the roof nearest to the camera; seen from above the highest in the image is the farthest. */
static size_t top_corner(const goe_observation_t *sight, const outline_t *o) {
    const bool highest = sight->settings->top_is_highest && o->top > 0.0f;
    const bool right = o->right != highest;
    const bool back = o->far_half != highest;
    return right ? (back ? BACK_RIGHT : FRONT_RIGHT) : (back ? BACK_LEFT : FRONT_LEFT);
}

static void add_top(const goe_observation_t *sight, const outline_t *o, goe_rows_t *rows) {
    goe_gradient_t gx;
    goe_gradient_t gy;
    const goe_point_t *measured = &sight->point[GOE_TOP];
    if (!measured->usable) {
        return;
    }
    const size_t corner = top_corner(sight, o);
    const goe_point_t seen = goe_observation_project(sight, corner_x(o, corner), o->top, corner_z(o, corner), &gx, &gy);
    const float variance = goe_observation_spread(sight, GOE_TOP).yy + goe_observation_size_variance(sight);
    const size_t row = goe_rows_add(rows, GOE_TOP, measured->y - seen.y, variance, &gy);
    set_corner(rows, row, sight, o, corner, &gy);
    set_height(rows, row, gy.y, sight->height_m);
    goe_rows_set(rows, row, GOE_E, -gy.y);
}

void goe_box_rows(const goe_observation_t *sight, goe_rows_t *rows) {
    outline_t outline;
    size_t corner[3] = {FRONT_LEFT, FRONT_LEFT, FRONT_LEFT};
    describe(sight, &outline);
    if (sight->base || sight->point[GOE_BASE_NEAR].usable) {
        visible_corners(sight, &outline, corner);
        for (size_t i = OUTER_LEFT; i <= OUTER_RIGHT; i++) {
            if (sight->point[GOE_BASE_LEFT + i].usable) {
                add_base_corner(sight, &outline, GOE_BASE_LEFT + i, corner[i], rows);
            }
        }
    } else {
        widest_corners(&outline, corner);
    }
    add_silhouette(sight, &outline, GOE_LEFT, corner[OUTER_LEFT], rows);
    add_silhouette(sight, &outline, GOE_RIGHT, corner[OUTER_RIGHT], rows);
    add_top(sight, &outline, rows);
}
