/* (R21): the drift of the own position, and how uncertain it makes an obstacle. SPDX-License-Identifier: MIT */
#ifndef GOE_DRIFT_H
#define GOE_DRIFT_H

#include "image/goe_ego_motion.h"
#include "refined/goe_shape.h"

/* Constant velocity errors scale and turn the path flown since the filter's start, and the obstacle with it: no image shows that. */
typedef struct {
    goe_xz_t camera_m; /* since the filter's start */
    float share;       /* of lengths, and rad */
    float walk_m2;
    float turned_m2; /* a path that leads back on itself is not scaled: what of the drift is left */
} goe_drift_t;

goe_drift_t goe_drift_of(const goe_filter_t *filter, const goe_navigation_t *navigation, const goe_motion_t *motion);

/* Variance of X0, as of Z0, from the track's first image to the filter's start: these two alone count from there. */
float goe_drift_before_start(const goe_filter_t *filter, const goe_navigation_t *navigation,
                             const goe_motion_t *motion);

/* Variance of a quantity by the drift, and by what its shape leaves open. */
/*@ requires \valid_read(motion) && \valid_read(drift) && \valid_read(shape) && 0 <= quantity < GOE_QUANTITIES; */
float goe_drift_variance(const goe_motion_t *motion, const goe_drift_t *drift, const goe_shape_t *shape, bool box,
                         int quantity);

#endif
