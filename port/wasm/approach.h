/*
 * A small approach: an aircraft flies straight on, slowly descending and rolling to and fro, and its camera sees one obstacle.
 *
 * North is the course, the flight starts at north 0, east 0. Everything is computed from the plan alone, without a C library: the
 * same plan gives the same bits everywhere. Noise is a sum of twelve uniform numbers, so that nothing is farther off than six
 * sigma. The path stays straight while the aircraft rolls.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#ifndef GOE_WASM_APPROACH_H
#define GOE_WASM_APPROACH_H

#include "goe.h"

#define APPROACH_RATE_HZ 10.0
#define APPROACH_SPEED_M_S 20.0
#define APPROACH_DESCENT_M_S 1.0 /* about 3 degrees */
#define APPROACH_FIRST_RANGE_M 400.0
#define APPROACH_IMAGES 188    /* until 26 m before the obstacle's middle is abeam */
#define APPROACH_HEIGHT_M 12.0 /* above ground at the obstacle */

#define APPROACH_IMAGE_WIDTH_PX 1280.0
#define APPROACH_IMAGE_HEIGHT_PX 960.0
#define APPROACH_FOCAL_PX 914.0 /* 70 degrees from side to side; the camera looks along the body's forward axis */

/* Errors that every flight has; one sigma each. */
#define APPROACH_BOX_SHARE 0.02    /* of a box's side, of its width or height, slowly varying ... */
#define APPROACH_CORRELATION_S 1.0 /* ... for so long */
#define APPROACH_ATTITUDE_BIAS_DEG 0.3
#define APPROACH_ATTITUDE_WHITE_DEG 0.1
#define APPROACH_VELOCITY_M_S 0.05

typedef enum { APPROACH_BUILDING, APPROACH_TRUCK, APPROACH_MAST, APPROACH_KINDS } approach_kind_t;

/* What the detector gives. */
typedef enum { APPROACH_BOXES, APPROACH_CORNERS } approach_detector_t;

typedef struct {
    approach_kind_t kind;
    approach_detector_t detector;
    double roll_deg;        /* amplitude of a sine of APPROACH_ROLL_S */
    double pixel_px;        /* noise that is new in each image, one sigma, of each side or coordinate */
    double height_offset_m; /* by which the altimeter says too much */
    double side_m;          /* of the obstacle's middle, to the right of the course */
    uint64_t seed;
} approach_plan_t;

#define APPROACH_ROLL_S 5.0

/* In the horizontal plane: a box about its middle, turned clockwise from north; the length is the edge that is turned so. Round: width is
 * the diameter. */
typedef struct {
    double north_m, east_m;
    double width_m, length_m, height_m, orientation_deg;
    bool round;
} approach_obstacle_t;

/* Where the aircraft is at an exposure. */
typedef struct {
    double time_s, north_m, height_m, roll_deg;
} approach_truth_t;

typedef struct {
    approach_plan_t plan;
    approach_obstacle_t obstacle;
    uint64_t random;
    double attitude_bias_deg[3], velocity_bias_m_s[2], side_error[4];
    int image;
} approach_t;

/* Width of the obstacle across the line of sight of the first image, the only width in upright boxes. */
double approach_width_in_view_m(const approach_obstacle_t *obstacle);

void approach_start(approach_t *approach, const approach_plan_t *plan);

/* The next image as the estimator is given it, and the truth; false after the last one. */
bool approach_next(approach_t *approach, goe_image_t *image, approach_truth_t *truth);

#endif
