/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "approach.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846
#define RIM_POINTS 48 /* of a mast's rim: 0.2 % of its radius is lost at most */
#define POINTS_MAX (2 * RIM_POINTS)
#define LEAST_BOX_PX 2.0       /* no detector finds a smaller box */
#define KEPT_SHARE 0.904837418 /* exp(-1 / (APPROACH_RATE_HZ APPROACH_CORRELATION_S)) */
#define NEW_SHARE 0.425755835  /* sqrt(1 - KEPT_SHARE^2) */

typedef struct {
    double x, y, z;
} point_t;

/* The camera at an exposure: where it is (north, east, down), and how NED turns into the body's axes. */
typedef struct {
    point_t eye;
    double to_body[3][3];
} camera_t;

typedef struct {
    double u, v;
} pixel_t;

/* ------------------------------------------------------------------------------------------------------------ numbers -- */

/* Splitmix64. */
static uint64_t random_bits(uint64_t *state) {
    *state += UINT64_C(0x9E3779B97F4A7C15);
    uint64_t z = *state;
    z = (z ^ (z >> 30)) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94D049BB133111EB);
    return z ^ (z >> 31);
}

/* Mean 0, variance 1. */
static double random_normal(uint64_t *state) {
    double sum = -6.0;
    for (int i = 0; i < 12; i++) {
        sum += (double)(random_bits(state) >> 11) * 0x1p-53;
    }
    return sum;
}

/* Sine of an angle, |deg| <= 1e6; to 1e-9. */
static double sine_deg(double deg) {
    const double turn = deg / 360.0;
    const double nearest = (double)(int)(turn + (turn < 0.0 ? -0.5 : 0.5));
    double x = 2.0 * PI * (turn - nearest);
    if (x > 0.5 * PI) {
        x = PI - x;
    } else if (x < -0.5 * PI) {
        x = -PI - x;
    }
    double term = x;
    double sum = x;
    for (int n = 1; n <= 7; n++) {
        term *= -x * x / (double)(2 * n * (2 * n + 1));
        sum += term;
    }
    return sum;
}

static double cosine_deg(double deg) { return sine_deg(deg + 90.0); }

/* ----------------------------------------------------------------------------------------------------------- attitude -- */

/* Hamilton, body to NED: yaw, then pitch, then roll. */
static void quaternion_of(const double roll_pitch_yaw_deg[3], double q[4]) {
    double c[3];
    double s[3];
    for (int i = 0; i < 3; i++) {
        c[i] = cosine_deg(0.5 * roll_pitch_yaw_deg[i]);
        s[i] = sine_deg(0.5 * roll_pitch_yaw_deg[i]);
    }
    q[0] = c[0] * c[1] * c[2] + s[0] * s[1] * s[2];
    q[1] = s[0] * c[1] * c[2] - c[0] * s[1] * s[2];
    q[2] = c[0] * s[1] * c[2] + s[0] * c[1] * s[2];
    q[3] = c[0] * c[1] * s[2] - s[0] * s[1] * c[2];
}

/* The turn a, then b about the axes that a has turned. */
static void multiply(const double a[4], const double b[4], double q[4]) {
    q[0] = a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3];
    q[1] = a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2];
    q[2] = a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1];
    q[3] = a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0];
}

/* The true attitude is roll alone. */
static camera_t camera_at(const approach_truth_t *truth) {
    const double c = cosine_deg(truth->roll_deg);
    const double s = sine_deg(truth->roll_deg);
    const camera_t camera = {{truth->north_m, 0.0, -truth->height_m}, {{1.0, 0.0, 0.0}, {0.0, c, s}, {0.0, -s, c}}};
    return camera;
}

/* Everything that is looked at is before the camera. */
static pixel_t project(const camera_t *camera, point_t p) {
    const double d[3] = {p.x - camera->eye.x, p.y - camera->eye.y, p.z - camera->eye.z};
    double body[3];
    for (int i = 0; i < 3; i++) {
        body[i] = camera->to_body[i][0] * d[0] + camera->to_body[i][1] * d[1] + camera->to_body[i][2] * d[2];
    }
    const pixel_t pixel = {0.5 * APPROACH_IMAGE_WIDTH_PX + APPROACH_FOCAL_PX * body[1] / body[0],
                           0.5 * APPROACH_IMAGE_HEIGHT_PX + APPROACH_FOCAL_PX * body[2] / body[0]};
    return pixel;
}

static bool in_image(pixel_t p) {
    return p.u >= 0.0 && p.u <= APPROACH_IMAGE_WIDTH_PX - 1.0 && p.v >= 0.0 && p.v <= APPROACH_IMAGE_HEIGHT_PX - 1.0;
}

/* ----------------------------------------------------------------------------------------------------------- obstacle -- */

static approach_obstacle_t obstacle_of(const approach_plan_t *plan) {
    static const approach_obstacle_t kinds[APPROACH_KINDS] = {
        {0.0, 0.0, 20.0, 30.0, 25.0, 25.0, false},
        {0.0, 0.0, 12.0, 2.5, 4.0, -20.0, false}, /* across the course */
        {0.0, 0.0, 4.0, 4.0, 40.0, 0.0, true},
    };
    approach_obstacle_t obstacle = kinds[plan->kind];
    obstacle.north_m = APPROACH_FIRST_RANGE_M;
    obstacle.east_m = plan->side_m;
    return obstacle;
}

/* A point of the obstacle at a height above ground, across and along its axes from its middle. */
static point_t place(const approach_obstacle_t *o, double across_m, double along_m, double up_m) {
    const double c = cosine_deg(o->orientation_deg);
    const double s = sine_deg(o->orientation_deg);
    const point_t point = {o->north_m + along_m * c - across_m * s, o->east_m + along_m * s + across_m * c, -up_m};
    return point;
}

static point_t corner(const approach_obstacle_t *o, int across, int along, double up_m) {
    return place(o, 0.5 * (double)across * o->width_m, 0.5 * (double)along * o->length_m, up_m);
}

/* Where the camera is along the obstacle's axes. */
static void eye_along_axes(const approach_obstacle_t *o, const camera_t *camera, double *across_m, double *along_m) {
    const double c = cosine_deg(o->orientation_deg);
    const double s = sine_deg(o->orientation_deg);
    const double north = camera->eye.x - o->north_m;
    const double east = camera->eye.y - o->east_m;
    *along_m = north * c + east * s;
    *across_m = east * c - north * s;
}

double approach_width_in_view_m(const approach_obstacle_t *o) {
    const double c = cosine_deg(o->orientation_deg);
    const double s = sine_deg(o->orientation_deg);
    const double range_m = (double)sqrtf((float)(o->north_m * o->north_m + o->east_m * o->east_m));
    const double side = (o->north_m * c + o->east_m * s) / range_m * o->width_m; /* across the line of sight */
    const double end = (o->east_m * c - o->north_m * s) / range_m * o->length_m;
    return o->round ? o->width_m : (side < 0.0 ? -side : side) + (end < 0.0 ? -end : end);
}

/* Points whose hull is the obstacle; returns how many. */
static int hull(const approach_obstacle_t *o, point_t points[POINTS_MAX]) {
    int count = 0;
    for (int upper = 0; upper < 2; upper++) {
        const double up_m = upper ? o->height_m : 0.0;
        for (int i = 0; o->round && i < RIM_POINTS; i++) {
            const double deg = 360.0 * (double)i / RIM_POINTS;
            points[count++] = place(o, 0.5 * o->width_m * cosine_deg(deg), 0.5 * o->width_m * sine_deg(deg), up_m);
        }
        for (int i = 0; !o->round && i < 4; i++) {
            points[count++] = corner(o, (i & 1) ? 1 : -1, (i & 2) ? 1 : -1, up_m);
        }
    }
    return count;
}

/* --------------------------------------------------------------------------------------------------------------- boxes -- */

static double clamped(double x, double high) { return x < 0.0 ? 0.0 : x > high ? high : x; }

static void frame(const approach_obstacle_t *o, const camera_t *camera, double side[4]) {
    point_t points[POINTS_MAX];
    const int count = hull(o, points);
    for (int i = 0; i < count; i++) {
        const pixel_t p = project(camera, points[i]);
        side[0] = i == 0 || p.u < side[0] ? p.u : side[0];
        side[1] = i == 0 || p.v < side[1] ? p.v : side[1];
        side[2] = i == 0 || p.u > side[2] ? p.u : side[2];
        side[3] = i == 0 || p.v > side[3] ? p.v : side[3];
    }
}

static void give_box(approach_t *a, const camera_t *camera, goe_image_t *image) {
    double side[4] = {0.0, 0.0, 0.0, 0.0};
    frame(&a->obstacle, camera, side);
    const double size[2] = {side[2] - side[0], side[3] - side[1]};
    for (int i = 0; i < 4; i++) {
        a->side_error[i] = KEPT_SHARE * a->side_error[i] + NEW_SHARE * random_normal(&a->random);
        side[i] += APPROACH_BOX_SHARE * size[i % 2] * a->side_error[i] + a->plan.pixel_px * random_normal(&a->random);
        side[i] = clamped(side[i], (i % 2 ? APPROACH_IMAGE_HEIGHT_PX : APPROACH_IMAGE_WIDTH_PX) - 1.0);
    }
    image->box.left_px = (float)side[0];
    image->box.top_px = (float)side[1];
    image->box.right_px = (float)side[2];
    image->box.bottom_px = (float)side[3];
    image->box.sides = side[2] - side[0] >= LEAST_BOX_PX && side[3] - side[1] >= LEAST_BOX_PX ? GOE_SIDES_ALL : 0;
}

/* ------------------------------------------------------------------------------------------------------------- corners -- */

static void give_point(approach_t *a, const camera_t *camera, point_t point, goe_pixel_t *to) {
    pixel_t p = project(camera, point);
    p.u += a->plan.pixel_px * random_normal(&a->random);
    p.v += a->plan.pixel_px * random_normal(&a->random);
    to->visible = in_image(p);
    to->u_px = to->visible ? (float)p.u : 0.0f;
    to->v_px = to->visible ? (float)p.v : 0.0f;
}

/* Half way up, where vertical planes through the camera touch the mast; and the rim's point towards the camera. */
static void give_mast(approach_t *a, const camera_t *camera, goe_image_t *image) {
    const approach_obstacle_t *o = &a->obstacle;
    double across;
    double along;
    eye_along_axes(o, camera, &across, &along);
    const double far_m = (double)sqrtf((float)(across * across + along * along));
    const double r = 0.5 * o->width_m;
    const double c = r / far_m;
    const double s = (double)sqrtf((float)(1.0 - c * c));
    const double ux = across / far_m;
    const double uy = along / far_m;
    const double half_m = 0.5 * o->height_m;
    give_point(a, camera, place(o, r * (c * ux + s * uy), r * (c * uy - s * ux), half_m), &image->left);
    give_point(a, camera, place(o, r * (c * ux - s * uy), r * (c * uy + s * ux), half_m), &image->right);
    give_point(a, camera, place(o, r * ux, r * uy, o->height_m), &image->top);
    if (image->left.u_px > image->right.u_px && image->left.visible && image->right.visible) {
        const goe_pixel_t left = image->left;
        image->left = image->right;
        image->right = left;
    }
}

/* The base corners of the faces in sight, and the silhouette, whose ends are upright edges. */
static void give_corners(approach_t *a, const camera_t *camera, goe_image_t *image) {
    const approach_obstacle_t *o = &a->obstacle;
    double across;
    double along;
    eye_along_axes(o, camera, &across, &along);
    const int near_across = across > 0.0 ? 1 : -1;
    const int near_along = along > 0.0 ? 1 : -1;
    const bool sees_side = across * (double)near_across > 0.5 * o->width_m;
    const bool sees_front = along * (double)near_along > 0.5 * o->length_m;
    point_t one = corner(o, near_across, sees_side ? -near_along : near_along, 0.0);
    point_t other = corner(o, sees_front ? -near_across : near_across, near_along, 0.0);
    if (project(camera, one).u > project(camera, other).u) {
        const point_t swapped = one;
        one = other;
        other = swapped;
    }
    const point_t near = corner(o, near_across, near_along, 0.0);
    give_point(a, camera, one, &image->base_left);
    give_point(a, camera, other, &image->base_right);
    if (sees_side && sees_front) {
        give_point(a, camera, near, &image->base_near);
    }
    one.z = other.z = -0.5 * o->height_m;
    give_point(a, camera, one, &image->left);
    give_point(a, camera, other, &image->right);
    const point_t top = {near.x, near.y, -o->height_m};
    give_point(a, camera, top, &image->top);
}

/* ---------------------------------------------------------------------------------------------------------------- pose -- */

/* The errors are about the body's axes, as those of a mounting are. */
static void give_attitude(approach_t *a, double roll_deg, float attitude[4]) {
    const double true_deg[3] = {roll_deg, 0.0, 0.0};
    double error_deg[3];
    double truth[4];
    double error[4];
    double given[4];
    for (int i = 0; i < 3; i++) {
        error_deg[i] = a->attitude_bias_deg[i] + APPROACH_ATTITUDE_WHITE_DEG * random_normal(&a->random);
    }
    quaternion_of(true_deg, truth);
    quaternion_of(error_deg, error);
    multiply(truth, error, given);
    for (int i = 0; i < 4; i++) {
        attitude[i] = (float)given[i];
    }
}

static void give_pose(approach_t *a, const approach_truth_t *truth, goe_pose_t *pose) {
    give_attitude(a, truth->roll_deg, pose->attitude);
    pose->time_us = (int64_t)a->image * (int64_t)(1.0e6 / APPROACH_RATE_HZ);
    pose->position_ned_m[0] = (float)(truth->north_m + a->velocity_bias_m_s[0] * truth->time_s);
    pose->position_ned_m[1] = (float)(a->velocity_bias_m_s[1] * truth->time_s);
    pose->position_ned_m[2] = (float)-truth->height_m;
    pose->height_m = (float)(truth->height_m + a->plan.height_offset_m);
}

void approach_start(approach_t *approach, const approach_plan_t *plan) {
    memset(approach, 0, sizeof *approach);
    approach->plan = *plan;
    approach->obstacle = obstacle_of(plan);
    approach->random = plan->seed;
    for (int i = 0; i < 3; i++) {
        approach->attitude_bias_deg[i] = APPROACH_ATTITUDE_BIAS_DEG * random_normal(&approach->random);
    }
    for (int i = 0; i < 2; i++) {
        approach->velocity_bias_m_s[i] = APPROACH_VELOCITY_M_S * random_normal(&approach->random);
    }
    for (int i = 0; i < 4; i++) {
        approach->side_error[i] = random_normal(&approach->random);
    }
}

bool approach_next(approach_t *approach, goe_image_t *image, approach_truth_t *truth) {
    if (approach->image >= APPROACH_IMAGES) {
        return false;
    }
    truth->time_s = (double)approach->image / APPROACH_RATE_HZ;
    truth->north_m = APPROACH_SPEED_M_S * truth->time_s;
    truth->height_m =
        APPROACH_HEIGHT_M + APPROACH_DESCENT_M_S * (APPROACH_FIRST_RANGE_M / APPROACH_SPEED_M_S - truth->time_s);
    truth->roll_deg = approach->plan.roll_deg * sine_deg(360.0 * truth->time_s / APPROACH_ROLL_S);
    const camera_t camera = camera_at(truth);
    memset(image, 0, sizeof *image);
    give_pose(approach, truth, &image->pose);
    if (approach->plan.detector == APPROACH_BOXES) {
        give_box(approach, &camera, image);
    } else if (approach->obstacle.round) {
        give_mast(approach, &camera, image);
    } else {
        give_corners(approach, &camera, image);
    }
    approach->image++;
    return true;
}
