/* The upright bounding box of a solid, by brute force in double: what the rows of a box's sides are compared with.
 * SPDX-License-Identifier: MIT */
#ifndef UPRIGHT_H
#define UPRIGHT_H

#include "sighting.h"

/* A point of the solid's foot or roof from the camera, units of Z0: of the corner `at`, or of a rim at the angle `at`. */
typedef void (*upright_point_t)(const double state[GOE_STATES], size_t side, double at, bool foot, double point[3]);

typedef struct {
    const sighting_t *sighting;
    upright_point_t point;
    int points;    /* corners of the footprint; of a rim, how many are tried before it is searched */
    bool is_round; /* a rim */
    double step;   /* of a state, for the derivatives */
} upright_t;

/* Turns the camera about its optical axis. */
void upright_roll(sighting_t *sighting, double rad);

/* The whole box of the solid. */
void upright_measure(const upright_t *solid, const double state[GOE_STATES], goe_sides_t *sides);

/* GIVEN a box that was measured at the state `truth` THEN the side's row has no residual, and its columns are the derivatives of the
 * solid's extreme. */
void upright_check_row(const upright_t *solid, const double truth[GOE_STATES], size_t side,
                       const float row[GOE_COLUMNS]);

#endif
