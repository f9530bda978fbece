/*
 * A ground obstacle: an upright box or an upright cylinder on flat ground.
 *
 *   view from above                 corner 1 ______________ corner 2
 *                                           |    face 1    |
 *      length axis                          |              |           corners and faces are numbered clockwise,
 *           ^                        face 0 |    center    | face 2    face i lies between corners i and i + 1;
 *           |                               |              |           face 3 is the front of an obstacle met along
 *           o---> width axis                |____face 3____|           its length axis
 *                                   corner 0                corner 3
 *
 * The heading of the length axis counts clockwise from north. The width axis lies 90 degrees to its right.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#ifndef SIM_OBSTACLE_H
#define SIM_OBSTACLE_H

#include <stdbool.h>

#include "rotation.h"

typedef enum { OBSTACLE_BOX, OBSTACLE_CYLINDER } obstacle_kind_t;

typedef struct {
    obstacle_kind_t kind;
    double width_m, length_m, height_m; /* cylinder: width = length = diameter */
    double center_n_m, center_e_m;      /* middle of the base, NED */
    double ground_d_m;                  /* of the ground at its base, NED */
    double heading_rad;                 /* of the length axis */
} obstacle_t;

#define OBSTACLE_FORMS "cylinder, building, truck, long-truck, box:W,L,H or disc:D,H (meters)"

/* Reads one of OBSTACLE_FORMS into the shape; the place is left at zero. False: not such a form, or a size <= 0. */
bool obstacle_parse(const char *text, obstacle_t *obstacle);

/* Places the obstacle's center. */
void obstacle_place(obstacle_t *obstacle, double center_n_m, double center_e_m, double ground_d_m, double heading_rad);

/* Corner 0 to 3 of a box (any other number counts modulo 4), on the ground or on top. */
vec3_t obstacle_corner(const obstacle_t *box, int corner, bool top);

/* Is the point inside the obstacle's walls (its height included), or on them? */
bool obstacle_contains(const obstacle_t *obstacle, vec3_t point);

/* Is this wall of a box visible from the eye? A wall is visible from its outer side only. */
bool obstacle_face_visible(const obstacle_t *box, int face, vec3_t eye);

/* Base corners of the visible walls, in image order from left to right. Returns how many walls are visible: 0 (eye above
 * the roof or inside), 1 (left and right set, near = -1) or 2 (all three set, near between both walls). */
int obstacle_visible_base(const obstacle_t *box, vec3_t eye, int *left, int *near, int *right);

/* Corner whose vertical edge is horizontally nearest to the eye. */
int obstacle_nearest_corner(const obstacle_t *box, vec3_t eye);

/* Axis point of the cylinder plus radius times the direction of the given azimuth, at height over ground. */
vec3_t obstacle_cylinder_point(const obstacle_t *cylinder, double azimuth_rad, double height_m);

/* Azimuths (from the axis) of the two lines along which vertical planes through the eye touch the cylinder; left and
 * right as viewed from the eye. False: the eye is over the disc. */
bool obstacle_tangent_azimuths(const obstacle_t *cylinder, vec3_t eye, double *left_rad, double *right_rad);

/* Azimuth from the axis towards the eye. */
double obstacle_azimuth_to(const obstacle_t *cylinder, vec3_t eye);

#endif
