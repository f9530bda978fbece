/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "image_box.h"

#include <math.h>
#include <string.h>

#define CURVES_MAX 12 /* edges of a box; of a cylinder two rims and two lines on the wall are enough */
#define STEPS 32      /* a curve is first looked at so often; the best place is then filter */
#define HALVINGS 50   /* of a step: down to rounding */
#define THIRDS 40     /* of two steps: (2/3)^40 is 1e-7, of which the square counts */
#define LEAST_PX 2.0  /* width and height of what a detector finds */

const char *const SIDE_NAMES[SIDE_COUNT] = {"box_left_px", "box_top_px", "box_right_px", "box_bottom_px"};

/* A straight edge (radius 0) or a level circle (along 0): from + along s + radius (cos 2 pi s, sin 2 pi s), 0 <= s <= 1. */
typedef struct {
    vec3_t from, along;
    double radius_m;
} curve_t;

typedef struct {
    const camera_t *camera;
    const view_t *view;
    curve_t curve[CURVES_MAX];
    int curves;
} outline_t;

/* The farthest point of a curve towards one side. */
typedef struct {
    double out_px; /* right or down is positive for right and bottom, left or up for left and top */
    double s;
} extreme_t;

static void add_edge(outline_t *outline, vec3_t from, vec3_t to) {
    const curve_t edge = {from, vec3_sub(to, from), 0.0};
    outline->curve[outline->curves++] = edge;
}

static void add_rim(outline_t *outline, const obstacle_t *cylinder, double height_m) {
    const vec3_t middle = {cylinder->center_n_m, cylinder->center_e_m, cylinder->ground_d_m - height_m};
    const vec3_t still = {0.0, 0.0, 0.0};
    const curve_t rim = {middle, still, 0.5 * cylinder->width_m};
    outline->curve[outline->curves++] = rim;
}

/* Through a lens a straight edge is bent and may reach farther than its ends. */
static void find_outline(outline_t *outline, const obstacle_t *obstacle) {
    if (obstacle->kind == OBSTACLE_BOX) {
        for (int k = 0; k < 4; k++) {
            add_edge(outline, obstacle_corner(obstacle, k, false), obstacle_corner(obstacle, k + 1, false));
            add_edge(outline, obstacle_corner(obstacle, k, true), obstacle_corner(obstacle, k + 1, true));
            add_edge(outline, obstacle_corner(obstacle, k, false), obstacle_corner(obstacle, k, true));
        }
        return;
    }
    add_rim(outline, obstacle, 0.0);
    add_rim(outline, obstacle, obstacle->height_m);
    double azimuth[2];
    if (obstacle_tangent_azimuths(obstacle, outline->view->eye_ned_m, &azimuth[0], &azimuth[1])) {
        for (int k = 0; k < 2; k++) {
            add_edge(outline, obstacle_cylinder_point(obstacle, azimuth[k], 0.0),
                     obstacle_cylinder_point(obstacle, azimuth[k], obstacle->height_m));
        }
    }
}

/* Pixel of a curve's point; false: it has no image. */
static bool see(const outline_t *outline, const curve_t *curve, double s, double pixel[2]) {
    vec3_t point = vec3_add(curve->from, vec3_scale(curve->along, s));
    point.x += curve->radius_m * cos(2.0 * SIM_PI * s);
    point.y += curve->radius_m * sin(2.0 * SIM_PI * s);
    return camera_project(outline->camera, outline->view, point, &pixel[0], &pixel[1]);
}

static double outwards(const double pixel[2], int side) { return side < SIDE_RIGHT ? -pixel[side] : pixel[side - 2]; }

static void include(extreme_t extremes[SIDE_COUNT], double s, const double pixel[2]) {
    for (int side = 0; side < SIDE_COUNT; side++) {
        const extreme_t here = {outwards(pixel, side), s};
        if (here.out_px > extremes[side].out_px) {
            extremes[side] = here;
        }
    }
}

/* The last point with an image, on the way from one that has one to one that has none. */
static void include_end(const outline_t *outline, extreme_t extremes[SIDE_COUNT], const curve_t *curve, double seen,
                        double unseen) {
    double pixel[2];
    for (int i = 0; i < HALVINGS; i++) {
        const double middle = 0.5 * (seen + unseen);
        if (see(outline, curve, middle, pixel)) {
            seen = middle;
        } else {
            unseen = middle;
        }
    }
    if (see(outline, curve, seen, pixel)) {
        include(extremes, seen, pixel);
    }
}

static void look_along(const outline_t *outline, extreme_t extremes[SIDE_COUNT], const curve_t *curve) {
    bool was_visible = false;
    for (int i = 0; i <= STEPS; i++) {
        const double s = (double)i / STEPS, before = (double)(i - 1) / STEPS;
        double pixel[2];
        const bool seen = see(outline, curve, s, pixel);
        if (seen) {
            include(extremes, s, pixel);
        }
        if (i > 0 && seen != was_visible) {
            include_end(outline, extremes, curve, seen ? s : before, seen ? before : s);
        }
        was_visible = seen;
    }
}

/* Of a straight edge that is entirely visible, shown by its ends as the field is convex. */
static bool look_at_ends(const outline_t *outline, extreme_t extremes[SIDE_COUNT], const curve_t *edge) {
    double from[2], to[2];
    if (!see(outline, edge, 0.0, from) || !see(outline, edge, 1.0, to)) {
        return false;
    }
    include(extremes, 0.0, from);
    include(extremes, 1.0, to);
    return true;
}

static double out_at(const outline_t *outline, const curve_t *curve, double s, int side) {
    double pixel[2];
    return see(outline, curve, s, pixel) ? outwards(pixel, side) : -HUGE_VAL;
}

/* How far a curve reaches towards a side: near the best step it turns back once. */
static double filter(const outline_t *outline, const curve_t *curve, const extreme_t *best, int side) {
    double low = best->s - 1.0 / STEPS, high = best->s + 1.0 / STEPS;
    if (!(curve->radius_m > 0.0)) { /* an edge ends, a rim goes round */
        low = fmax(low, 0.0);
        high = fmin(high, 1.0);
    }
    for (int i = 0; i < THIRDS; i++) {
        const double a = low + (high - low) / 3.0, b = high - (high - low) / 3.0;
        if (out_at(outline, curve, a, side) < out_at(outline, curve, b, side)) {
            low = a;
        } else {
            high = b;
        }
    }
    return fmax(best->out_px, out_at(outline, curve, 0.5 * (low + high), side));
}

/* ------------------------------------------------------------------------------------------- rims without a lens -- */

/* What a camera axis sees of a point on a level circle: at + by_cos cos + by_sin sin of its azimuth from north. */
typedef struct {
    double at, by_cos, by_sin;
} round_t;

static round_t along_rim(const outline_t *outline, const curve_t *rim, int axis) {
    const double *row = outline->view->ned_to_camera.m[axis];
    const vec3_t offset = vec3_sub(rim->from, outline->view->eye_ned_m);
    const round_t along = {row[0] * offset.x + row[1] * offset.y + row[2] * offset.z, rim->radius_m * row[0],
                           rim->radius_m * row[1]};
    return along;
}

static double ratio_at(const round_t *over, const round_t *under, double cosine, double sine) {
    return (over->at + over->by_cos * cosine + over->by_sin * sine) /
           (under->at + under->by_cos * cosine + under->by_sin * sine);
}

/* Least and largest of over / under, which is positive all round: where over' under - over under' = 0, that is
 * a cos + b sin = -c. False: rounding leaves none. */
static bool ends_of_ratio(const round_t *over, const round_t *under, double ends[2]) {
    const double a = under->at * over->by_sin - over->at * under->by_sin;
    const double b = over->at * under->by_cos - under->at * over->by_cos;
    const double c = over->by_sin * under->by_cos - over->by_cos * under->by_sin;
    const double norm = hypot(a, b);
    if (!(norm > fabs(c))) {
        return false;
    }
    const double nearer = -c / norm, aside = sqrt(1.0 - nearer * nearer);
    const double one = ratio_at(over, under, (nearer * a - aside * b) / norm, (nearer * b + aside * a) / norm);
    const double other = ratio_at(over, under, (nearer * a + aside * b) / norm, (nearer * b - aside * a) / norm);
    ends[0] = fmin(one, other);
    ends[1] = fmax(one, other);
    return true;
}

/* A circle that lies in the field all round. False: it may not, and nothing was done. */
static bool include_rim(const outline_t *outline, double out_px[SIDE_COUNT], const curve_t *rim) {
    const camera_t *camera = outline->camera;
    const round_t x = along_rim(outline, rim, 0), y = along_rim(outline, rim, 1), z = along_rim(outline, rim, 2);
    double u[2], v[2];
    if (!(z.at - hypot(z.by_cos, z.by_sin) > CAMERA_NEAREST_M) || !ends_of_ratio(&x, &z, u) ||
        !ends_of_ratio(&y, &z, v)) {
        return false;
    }
    const double widest = fmax(-u[0], u[1]), highest = fmax(-v[0], v[1]);
    if (widest * widest + highest * highest > camera->lens_radius2) {
        return false;
    }
    out_px[SIDE_LEFT] = fmax(out_px[SIDE_LEFT], -(camera->fx_px * u[0] + camera->cx_px));
    out_px[SIDE_RIGHT] = fmax(out_px[SIDE_RIGHT], camera->fx_px * u[1] + camera->cx_px);
    out_px[SIDE_TOP] = fmax(out_px[SIDE_TOP], -(camera->fy_px * v[0] + camera->cy_px));
    out_px[SIDE_BOTTOM] = fmax(out_px[SIDE_BOTTOM], camera->fy_px * v[1] + camera->cy_px);
    return true;
}

/* ------------------------------------------------------------------------------------------------------- all curves -- */

/* Every curve is filter, not the best of them alone: where a rim meets the wall, the rim's farthest point may lie between two
 * steps and reach farther than the wall's end. */
static void include_curve(const outline_t *outline, double out_px[SIDE_COUNT], const curve_t *curve) {
    extreme_t extremes[SIDE_COUNT];
    for (int side = 0; side < SIDE_COUNT; side++) {
        extremes[side].out_px = -HUGE_VAL;
        extremes[side].s = 0.0;
    }
    const bool rim = curve->radius_m > 0.0, lens = camera_has_lens(outline->camera), bent = rim || lens;
    if (rim && !lens && include_rim(outline, out_px, curve)) {
        return;
    }
    if (bent || !look_at_ends(outline, extremes, curve)) {
        look_along(outline, extremes, curve);
    }
    for (int side = 0; side < SIDE_COUNT && isfinite(extremes[side].out_px); side++) {
        const extreme_t *best = &extremes[side];
        out_px[side] = fmax(out_px[side], bent ? filter(outline, curve, best, side) : best->out_px);
    }
}

image_box_t image_box_project(const obstacle_t *obstacle, const camera_t *camera, const view_t *view) {
    image_box_t box;
    memset(&box, 0, sizeof box);
    if (obstacle_contains(obstacle, view->eye_ned_m)) {
        return box;
    }
    outline_t outline;
    memset(&outline, 0, sizeof outline);
    outline.camera = camera;
    outline.view = view;
    find_outline(&outline, obstacle);
    double out_px[SIDE_COUNT] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    for (int i = 0; i < outline.curves; i++) {
        include_curve(&outline, out_px, &outline.curve[i]);
    }
    box.seen = isfinite(out_px[SIDE_LEFT]);
    for (int side = 0; side < SIDE_COUNT && box.seen; side++) {
        box.side_px[side] = side < SIDE_RIGHT ? -out_px[side] : out_px[side];
    }
    return box;
}

double image_box_size_px(const image_box_t *box, int side) {
    const int low = side % 2 == 0 ? SIDE_LEFT : SIDE_TOP;
    return box->side_px[low + 2] - box->side_px[low];
}

bool image_box_whole(const image_box_t *box, const camera_t *camera) {
    return box->seen && box->side_px[SIDE_LEFT] >= 0.0 && box->side_px[SIDE_TOP] >= 0.0 &&
           box->side_px[SIDE_RIGHT] <= camera->width_px - 1.0 && box->side_px[SIDE_BOTTOM] <= camera->height_px - 1.0;
}

image_box_t image_box_clipped(const image_box_t *box, const camera_t *camera) {
    image_box_t clipped = *box;
    for (int side = 0; side < SIDE_COUNT; side++) {
        const double size_px = side % 2 == 0 ? camera->width_px : camera->height_px;
        clipped.side_px[side] = clamp(box->side_px[side], 0.0, size_px - 1.0);
    }
    if (!box->seen || !(image_box_size_px(&clipped, SIDE_LEFT) >= LEAST_PX) ||
        !(image_box_size_px(&clipped, SIDE_TOP) >= LEAST_PX)) {
        memset(&clipped, 0, sizeof clipped);
    }
    return clipped;
}
