/* The drift of the own position, and the variance that it adds to each quantity, (R21). SPDX-License-Identifier: MIT */
#ifndef GOE_DRIFT_H
#define GOE_DRIFT_H

#include "image/goe_ego_motion.h"
#include "refined/goe_shape.h"

/* A constant error of the own velocity looks like a velocity of the obstacle: goe_deviation.h considers it. Without the states for it, it
 * counts as a scale and a turn of the path flown since the filter's start. */
typedef struct {
    goe_xz_t camera_m; /* displacement since the filter's start */
    float walk_m2;
#if !GOE_AUGMENTED
    float share; /* relative error of lengths, error of directions in rad */
    float off_m; /* of the path's end */
#endif
} goe_drift_t;

goe_drift_t goe_drift_of(const goe_filter_t *filter, const goe_navigation_t *navigation, const goe_motion_t *motion);

/* Variance of X0, and of Z0, by the drift from the track's first image to the filter's start. Only these two count from that image. */
float goe_drift_before_start(const goe_filter_t *filter, const goe_navigation_t *navigation,
                             const goe_motion_t *motion);

/* Variance of a quantity by the drift, and by properties of its shape that no image shows. */
/*@ requires \valid_read(motion) && \valid_read(drift) && \valid_read(shape) && 0 <= quantity < GOE_QUANTITIES; */
float goe_drift_variance(const goe_motion_t *motion, const goe_drift_t *drift, const goe_shape_t *shape, bool box,
                         int quantity);

#endif
