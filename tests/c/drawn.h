/* Drawn flights towards an obstacle in the way, with a real detector's noise. SPDX-License-Identifier: MIT */
#ifndef DRAWN_H
#define DRAWN_H

#include "check.h"
#include "goe.h"
#include "scene.h"

#define DRAWN_RATE_HZ 8.0
#define DRAWN_AHEAD_S 3.0 /* a warning must come at least this long before the near side is reached */

/* What a detector gives, and the state of its errors. */
typedef struct {
    bool points, boxes;
    double box_share;
    double error[4]; /* of the box's sides, in its sigma */
} drawn_t;

/* A chimney or a building 160 to 250 m ahead, in the way and higher than the aircraft. */
drawn_t drawn_flight(scene_t *scene, check_random_t *any);

/* The k-th image: noisy points, a box with errors that last, or both. */
void drawn_image(drawn_t *drawn, scene_t *scene, check_random_t *any, int k, goe_image_t *image);

/* Seconds from the k-th image until the near side is reached. */
double drawn_left_s(const scene_t *scene, int k);

#endif
