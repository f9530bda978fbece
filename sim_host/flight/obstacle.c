/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "obstacle.h"

#include <math.h>
#include <string.h>

#include "text_numbers.h"

typedef struct {
    const char *name;
    obstacle_kind_t kind;
    double width_m, length_m, height_m;
} named_shape_t;

/* Table 1 of the paper */
static const named_shape_t NAMED_SHAPES[] = {
    {"cylinder", OBSTACLE_CYLINDER, 6.0, 6.0, 30.0},
    {"building", OBSTACLE_BOX, 15.0, 40.0, 89.0},
    {"truck", OBSTACLE_BOX, 2.5, 7.0, 2.5},
    {"long-truck", OBSTACLE_BOX, 2.5, 18.0, 4.0},
};

/* corner -> side of the center along the width and the length axis */
static const double CORNER_WIDTH[4] = {-0.5, -0.5, 0.5, 0.5};
static const double CORNER_LENGTH[4] = {-0.5, 0.5, 0.5, -0.5};

bool obstacle_parse(const char *text, obstacle_t *obstacle) {
    memset(obstacle, 0, sizeof *obstacle);
    for (size_t i = 0; i < sizeof NAMED_SHAPES / sizeof NAMED_SHAPES[0]; i++) {
        const named_shape_t *shape = &NAMED_SHAPES[i];
        if (strcmp(text, shape->name) == 0) {
            obstacle->kind = shape->kind;
            obstacle->width_m = shape->width_m;
            obstacle->length_m = shape->length_m;
            obstacle->height_m = shape->height_m;
            return true;
        }
    }
    double size_m[3];
    if (text_numbers(text, "box:", size_m, 3)) {
        obstacle->kind = OBSTACLE_BOX;
        obstacle->width_m = size_m[0];
        obstacle->length_m = size_m[1];
        obstacle->height_m = size_m[2];
    } else if (text_numbers(text, "disc:", size_m, 2)) {
        obstacle->kind = OBSTACLE_CYLINDER;
        obstacle->width_m = obstacle->length_m = size_m[0];
        obstacle->height_m = size_m[1];
    }
    return obstacle->width_m > 0.0 && obstacle->length_m > 0.0 && obstacle->height_m > 0.0;
}

void obstacle_place(obstacle_t *obstacle, double center_n_m, double center_e_m, double ground_d_m, double heading_rad) {
    obstacle->center_n_m = center_n_m;
    obstacle->center_e_m = center_e_m;
    obstacle->ground_d_m = ground_d_m;
    obstacle->heading_rad = heading_rad;
}

vec3_t obstacle_corner(const obstacle_t *box, int corner, bool top) {
    const int k = corner & 3;
    const double c = cos(box->heading_rad), s = sin(box->heading_rad);
    const double along_width = CORNER_WIDTH[k] * box->width_m, along_length = CORNER_LENGTH[k] * box->length_m;
    vec3_t point = {box->center_n_m + c * along_length - s * along_width,
                    box->center_e_m + s * along_length + c * along_width,
                    box->ground_d_m - (top ? box->height_m : 0.0)};
    return point;
}

/* The point in the box's own axes, from its center. */
static void to_own_axes(const obstacle_t *box, vec3_t point, double *along_width, double *along_length) {
    const double c = cos(box->heading_rad), s = sin(box->heading_rad);
    const double n = point.x - box->center_n_m, e = point.y - box->center_e_m;
    *along_length = c * n + s * e;
    *along_width = c * e - s * n;
}

bool obstacle_contains(const obstacle_t *obstacle, vec3_t point) {
    const double height = obstacle->ground_d_m - point.z;
    if (height < 0.0 || height > obstacle->height_m) {
        return false;
    }
    if (obstacle->kind == OBSTACLE_CYLINDER) {
        return hypot(point.x - obstacle->center_n_m, point.y - obstacle->center_e_m) <= 0.5 * obstacle->width_m;
    }
    double along_width, along_length;
    to_own_axes(obstacle, point, &along_width, &along_length);
    return fabs(along_width) <= 0.5 * obstacle->width_m && fabs(along_length) <= 0.5 * obstacle->length_m;
}

bool obstacle_face_visible(const obstacle_t *box, int face, vec3_t eye) {
    double along_width, along_length;
    to_own_axes(box, eye, &along_width, &along_length);
    switch (face & 3) {
        case 0:
            return along_width < -0.5 * box->width_m;
        case 1:
            return along_length > 0.5 * box->length_m;
        case 2:
            return along_width > 0.5 * box->width_m;
        default:
            return along_length < -0.5 * box->length_m;
    }
}

int obstacle_visible_base(const obstacle_t *box, vec3_t eye, int *left, int *near, int *right) {
    bool visible[4];
    int count = 0, first = 0;
    for (int face = 0; face < 4; face++) {
        visible[face] = obstacle_face_visible(box, face, eye);
        count += visible[face] ? 1 : 0;
    }
    for (int face = 0; face < 4; face++) {
        /* the first of the visible walls, clockwise: its predecessor is hidden. Its corners run right to left. */
        if (visible[face] && !visible[(face + 3) & 3]) {
            first = face;
        }
    }
    *right = first;
    *near = count == 2 ? (first + 1) & 3 : -1;
    *left = (first + count) & 3;
    return count;
}

int obstacle_nearest_corner(const obstacle_t *box, vec3_t eye) {
    int nearest = 0;
    double nearest_distance = HUGE_VAL;
    for (int k = 0; k < 4; k++) {
        const vec3_t corner = obstacle_corner(box, k, false);
        const double distance = hypot(corner.x - eye.x, corner.y - eye.y);
        if (distance < nearest_distance) {
            nearest = k;
            nearest_distance = distance;
        }
    }
    return nearest;
}

vec3_t obstacle_cylinder_point(const obstacle_t *cylinder, double azimuth_rad, double height_m) {
    const double radius = 0.5 * cylinder->width_m;
    vec3_t point = {cylinder->center_n_m + radius * cos(azimuth_rad), cylinder->center_e_m + radius * sin(azimuth_rad),
                    cylinder->ground_d_m - height_m};
    return point;
}

double obstacle_azimuth_to(const obstacle_t *cylinder, vec3_t eye) {
    return atan2(eye.y - cylinder->center_e_m, eye.x - cylinder->center_n_m);
}

bool obstacle_tangent_azimuths(const obstacle_t *cylinder, vec3_t eye, double *left_rad, double *right_rad) {
    const double distance = hypot(eye.x - cylinder->center_n_m, eye.y - cylinder->center_e_m);
    const double radius = 0.5 * cylinder->width_m;
    if (distance <= radius) {
        return false;
    }
    /* The radius to the point of contact is perpendicular to the tangent. The eye looks back along the azimuth, so a
     * larger (clockwise) azimuth lies to its left. */
    const double towards_eye = obstacle_azimuth_to(cylinder, eye);
    const double half_opening = acos(radius / distance);
    *left_rad = towards_eye + half_opening;
    *right_rad = towards_eye - half_opening;
    return true;
}
