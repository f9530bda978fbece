/* Where the sides of an upright bounding box touch a solid, and their rows. SPDX-License-Identifier: MIT */
#include "refined/goe_touch.h"

#include <math.h>

#include "image/goe_camera.h"
#include "maths/goe_scalar.h"

#if GOE_WITH_FILTER

#define LEVEL_MIN 1.0e-6f          /* least horizontal part of a side's normal: without it the nearest point touches */
#define HIDDEN_VARIANCE 5.3333333f /* factor on half the edge squared: uniform, 1/3, times 16 images that share it */
#define SCATTER_SHARE 0.01f        /* white part of a side's error, over the box's size */

GOE_STATIC_ASSERT(GOE_BOX_RIGHT == GOE_BOX_LEFT + 2 && GOE_BOX_BOTTOM == GOE_BOX_TOP + 2 && GOE_BOX_TOP == 1,
                  level_sides_are_odd_and_opposite_ones_two_apart);

static const uint8_t feature_of[GOE_BOX_SIDES] = {GOE_POINT_LEFT, GOE_POINT_TOP, GOE_POINT_RIGHT, GOE_POINT_BASE_NEAR};

/*@ requires \valid_read(camera) && side < GOE_BOX_SIDES; */
static float focal_px(const goe_camera_t *camera, size_t side) {
    return goe_touch_is_level(side) ? camera->fy_px : camera->fx_px;
}

float goe_touch_coordinate(const goe_camera_t *camera, const goe_sides_t *sides, size_t side) {
    const float center_px = goe_touch_is_level(side) ? camera->cy_px : camera->cx_px;
    return (sides->px[side] - center_px) / focal_px(camera, side);
}

/* ------------------------------------------------------------------------------------------------------------- noise -- */

float goe_touch_size(const goe_observation_t *obs, size_t side, float extent) {
    const goe_sides_t *sides = obs->sides;
    const size_t first = goe_touch_is_level(side) ? GOE_BOX_TOP : GOE_BOX_LEFT;
    if (goe_sides_see(sides, (1u | 1u << 2u) << first)) {
        return (sides->px[first + 2u] - sides->px[first]) / focal_px(obs->camera, first);
    }
    return goe_larger(extent, 0.0f) / goe_observation_ahead(obs);
}

float goe_touch_cut_variance(const goe_observation_t *obs, float size) {
    return obs->sides->truncated ? goe_square(obs->settings->detector.truncation_noise_rel * size) : 0.0f;
}

float goe_touch_white_variance(const goe_observation_t *obs, size_t side, float size) {
    const float pixel = obs->side_px / focal_px(obs->camera, side);
    return goe_square(pixel) + goe_square(SCATTER_SHARE * size) + goe_touch_cut_variance(obs, size);
}

float goe_touch_variance(const goe_observation_t *obs, size_t side, float size) {
    return goe_touch_white_variance(obs, side, size) + goe_square(obs->outline_share * size);
}

/* ------------------------------------------------------------------------------------------------------------- touch -- */

/* Rotates a vector by r, from the camera's axes. */
static inline void turn(const float r[9], const float v[3], float to[3]) {
    to[0] = r[0] * v[0] + r[1] * v[1] + r[2] * v[2];
    to[1] = r[3] * v[0] + r[4] * v[1] + r[5] * v[2];
    to[2] = r[6] * v[0] + r[7] * v[1] + r[8] * v[2];
}

/* (R25): the corner of a hull that lies farthest along the plane's normal. */
/*@ requires goe_solid_is_closed(solid) && solid->corners > 0 && \valid(t) && \valid_read(n + (0 .. 2)); */
static void reach_corner(const goe_solid_t *solid, const float n[3], goe_touch_t *t) {
    const goe_xz_t *corner = solid->corner;
    float farthest = n[0] * corner[0].x + n[2] * corner[0].z;
    t->corner = 0;
    for (size_t i = 1; i < solid->corners; i++) {
        const float reach = n[0] * corner[i].x + n[2] * corner[i].z;
        if (reach > farthest) {
            farthest = reach;
            t->corner = i;
        }
    }
    t->point[0] = corner[t->corner].x;
    t->point[2] = corner[t->corner].z;
}

/* (R25): the point of an ellipse that lies farthest along the plane's normal. */
static void reach_rim(const goe_solid_t *solid, const float n[3], goe_touch_t *t) {
    const float level = sqrtf(n[0] * n[0] + n[2] * n[2]);
    const bool tilts = level > LEVEL_MIN;
    t->outward.x = tilts ? n[0] / level : 0.0f;
    t->outward.z = tilts ? n[2] / level : -1.0f;
    t->contact = goe_ellipse_touch(&solid->ellipse, t->outward);
    t->point[0] = solid->center.x + t->contact.at.x;
    t->point[2] = solid->center.z + t->contact.at.z;
}

typedef enum { FOOT, HEAD, EITHER } end_t;

/* (R24), (R25): finds the touching point on the side of the outward normal, which is given in the camera's axes. An end (foot or head) that
 * is not ahead is not visible, so the other end replaces it. False if neither is ahead. */
static bool touch(const goe_solid_t *solid, const float normal[3], end_t end, goe_touch_t *t) {
    const float *r = solid->unbiased_from_camera;
    float n[3];
    turn(r, normal, n);
    t->foot = end == EITHER ? n[1] > 0.0f : end == FOOT;
    if (solid->corners > 0) {
        reach_corner(solid, n, t);
    } else {
        reach_rim(solid, n, t);
    }
    float *p = t->point;
    const float level = r[2] * p[0] + r[8] * p[2];
    p[1] = t->foot ? solid->ground : solid->roof;
    t->other = !(level + r[5] * p[1] >= GOE_AHEAD_MIN);
    if (t->other) {
        t->foot = !t->foot;
        p[1] = t->foot ? solid->ground : solid->roof;
    }
    const float z = level + r[5] * p[1];
    if (!(z >= GOE_AHEAD_MIN)) {
        return false;
    }
    t->nearness = 1.0f / z;
    t->x = (r[0] * p[0] + r[3] * p[1] + r[6] * p[2]) * t->nearness;
    t->y = (r[1] * p[0] + r[4] * p[1] + r[7] * p[2]) * t->nearness;
    return true;
}

/* The line of a side near a point: raw coordinate there, and its derivatives by the undistorted (x, y). */
typedef struct {
    float at, by_x, by_y;
} line_t;

/*@ requires \valid_read(camera) && side < GOE_BOX_SIDES; */
static line_t line_at(const goe_camera_t *camera, size_t side, float x, float y) {
    const bool level = goe_touch_is_level(side);
    line_t line = {level ? y : x, level ? 0.0f : 1.0f, level ? 1.0f : 0.0f};
    if (goe_camera_distorts(camera)) {
        const goe_distorted_t to = goe_camera_distort(camera, x, y);
        line.at = level ? to.y : to.x;
        line.by_x = level ? to.xy : to.xx;
        line.by_y = level ? to.yy : to.xy;
    }
    return line;
}

static float sign_of(size_t side) { return side == GOE_BOX_LEFT || side == GOE_BOX_TOP ? -1.0f : 1.0f; }

/* (R26): uses the line of the side linearized at its touching point, which the first call finds. */
/*@ requires goe_observation_is_open(obs) && goe_solid_is_closed(solid) && \valid_read(straight + (0 .. 2));
    requires \valid(t) && side < GOE_BOX_SIDES; */
static bool touch_bent(const goe_observation_t *obs, const goe_solid_t *solid, size_t side, const float straight[3],
                       end_t end, goe_touch_t *t) {
    if (!touch(solid, straight, end, t)) {
        return false;
    }
    const float sign = sign_of(side);
    const line_t line = line_at(obs->camera, side, t->x, t->y);
    const float bent[3] = {sign * line.by_x, sign * line.by_y, -sign * (line.by_x * t->x + line.by_y * t->y)};
    return touch(solid, bent, end, t);
}

/* Finds the touching point of a side. With a lens it tries foot and head, because the line is not straight between them. */
/*@ requires goe_observation_is_open(obs) && goe_solid_is_closed(solid) && \valid(t) && side < GOE_BOX_SIDES; */
static bool touch_side(const goe_observation_t *obs, const goe_solid_t *solid, size_t side, goe_touch_t *t) {
    const goe_camera_t *camera = obs->camera;
    const float at = goe_touch_coordinate(camera, obs->sides, side);
    const float sign = sign_of(side);
    const bool level = goe_touch_is_level(side);
    const float straight[3] = {level ? 0.0f : sign, level ? sign : 0.0f, -sign * at};
    if (!goe_camera_distorts(camera)) {
        return touch(solid, straight, EITHER, t);
    }
    goe_touch_t head;
    if (!touch_bent(obs, solid, side, straight, FOOT, t) || !touch_bent(obs, solid, side, straight, HEAD, &head)) {
        return false;
    }
    const bool other = side == GOE_BOX_TOP ? head.other : t->other || (head.other && !goe_touch_is_level(side));
    if (sign * line_at(camera, side, head.x, head.y).at > sign * line_at(camera, side, t->x, t->y).at) {
        *t = head;
    }
    t->other = other;
    return true;
}

static bool shows(const goe_solid_t *solid, size_t side) { return (solid->seen >> side & 1u) != 0u; }

/* Whether the point lies above the image (side: top) or below it (bottom), through the lens. */
/*@ requires goe_observation_is_open(obs) && \valid_read(t) && side < GOE_BOX_SIDES; */
static bool is_beyond(const goe_observation_t *obs, const goe_touch_t *t, size_t side) {
    const goe_camera_t *camera = obs->camera;
    const float px = line_at(camera, side, t->x, t->y).at * camera->fy_px + camera->cy_px;
    return side == GOE_BOX_TOP ? px < 0.0f : px > camera->height_px;
}

/* Bit of a doubtful top or bottom that the border cuts: while the position is not known, or if the solid reaches beyond the border. A cut
 * bottom, taken as the foot, would place the obstacle too far away by many sigma. */
/*@ requires goe_observation_is_open(obs) && goe_solid_is_closed(solid) && side < GOE_BOX_SIDES; */
static unsigned cut_bit(const goe_observation_t *obs, const goe_solid_t *solid, size_t side) {
    goe_touch_t t;
    const unsigned doubtful = obs->sides->doubtful & (1u << side);
    const bool shown =
        doubtful == 0u || (obs->is_placed && touch_side(obs, solid, side, &t) && !is_beyond(obs, &t, side));
    return shown ? 0u : doubtful;
}

/* Turns each axis n of the camera, by the supplied attitude, into n - e x n. */
void goe_touch_open(const goe_observation_t *obs, float height_m, goe_solid_t *solid) {
    const float *x = obs->state;
    const float *r = obs->camera_to_axes;
    float *to = solid->unbiased_from_camera;
    solid->ground = height_m * x[GOE_INVERSE_RANGE] + x[GOE_GROUND];
    solid->roof = height_m * x[GOE_INVERSE_RANGE] - x[GOE_TOP];
    for (size_t i = 0; i < 3; i++) {
        to[i] = r[i] - obs->ey * r[6 + i] + obs->ez * r[3 + i];
        to[3 + i] = r[3 + i] - obs->ez * r[i] + obs->ex * r[6 + i];
        to[6 + i] = r[6 + i] - obs->ex * r[3 + i] + obs->ey * r[i];
    }
    solid->seen = obs->sides->usable ^ cut_bit(obs, solid, GOE_BOX_TOP) ^ cut_bit(obs, solid, GOE_BOX_BOTTOM);
}

/* --------------------------------------------------------------------------------------------------------------- row -- */

/* Derivatives by the touching point and by the attitude's error, from those of the line. */
/*@ requires goe_observation_is_open(obs) && \valid_read(solid) && \valid_read(t) && \valid_read(line) && \valid(to); */
static void find_gradient(const goe_observation_t *obs, const goe_solid_t *solid, const goe_touch_t *t,
                          const line_t *line, goe_gradient_t *to) {
    const float *p = t->point;
    const float in_camera[3] = {line->by_x * t->nearness, line->by_y * t->nearness,
                                -(line->by_x * t->x + line->by_y * t->y) * t->nearness};
    float g[3];
    turn(obs->camera_to_axes, in_camera, g);
    to->at = line->at;
    to->ex = p[1] * g[2] - p[2] * g[1];
    to->ey = p[2] * g[0] - p[0] * g[2];
    to->ez = p[0] * g[1] - p[1] * g[0];
    turn(solid->unbiased_from_camera, in_camera, g);
    to->x = g[0];
    to->y = g[1];
    to->z = g[2];
}

/* Whether the end of the solid that the side touches may be hidden, or outside the image: no level side of the box, and no base
 * corner, shows it. */
static bool is_hidden(const goe_observation_t *obs, const goe_solid_t *solid, const goe_touch_t *t) {
    return t->other || (!shows(solid, t->foot ? GOE_BOX_BOTTOM : GOE_BOX_TOP) && !(t->foot && obs->edge));
}

/* (R27a): the side then touches the end of the visible part, anywhere between foot and head. The row assumes the middle, and does not
 * depend on either height. Returns the variance to add. */
/*@ requires \valid_read(solid) && \valid_read(t) && \valid(gradient); */
static float forget_height(const goe_solid_t *solid, const goe_touch_t *t, goe_gradient_t *gradient) {
    const float moved = gradient->y * (0.5f * (solid->ground + solid->roof) - t->point[1]);
    gradient->at += moved;
    gradient->y = 0.0f;
    return moved * moved * HIDDEN_VARIANCE;
}

/* Whether the end of the upright edge that left or right touches is outside the image, beyond the opposite level side, which is not
 * measured. Then the whole edge is outside, and the side ends where the border crosses the roof or the base, which no row describes. */
/*@ requires goe_observation_is_open(obs) && \valid_read(solid) && \valid_read(t); */
static bool is_outside(const goe_observation_t *obs, const goe_solid_t *solid, const goe_touch_t *t) {
    const size_t beyond = t->foot ? GOE_BOX_TOP : GOE_BOX_BOTTOM;
    return obs->camera->height_px > 0.0f && !shows(solid, beyond) && is_beyond(obs, t, beyond);
}

GOE_NOINLINE float *goe_touch_add(goe_rows_t *rows, const goe_observation_t *obs, const goe_solid_t *solid, size_t side,
                                  float variance, goe_touch_t *touch, goe_gradient_t *gradient) {
    if (!shows(solid, side)) {
        return NULL;
    }
    const float measured = goe_touch_coordinate(obs->camera, obs->sides, side);
    const bool level = goe_touch_is_level(side);
    if (!touch_side(obs, solid, side, touch) || (level ? touch->other : is_outside(obs, solid, touch))) {
        return NULL;
    }
    const line_t line = line_at(obs->camera, side, touch->x, touch->y);
    find_gradient(obs, solid, touch, &line, gradient);
    const float hidden = !level && is_hidden(obs, solid, touch) ? forget_height(solid, touch, gradient) : 0.0f;
    float *by = goe_rows_add(rows, obs, (goe_feature_t)feature_of[side], level ? GOE_ALONG_Y : GOE_ALONG_X, measured,
                             variance + hidden, gradient);
    rows->side[rows->count - 1u] = (uint8_t)side;
    /* A foot moves with the ground, a head with the top. */
    by[GOE_GROUND] = touch->foot ? gradient->y : 0.0f;
    by[GOE_TOP] = touch->foot ? 0.0f : -gradient->y;
    return by;
}

#endif
