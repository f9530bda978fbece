/* The drift of the own position, (R21). SPDX-License-Identifier: MIT */
#include "refined/goe_drift.h"

#include <math.h>

#include "maths/goe_scalar.h"
#include "maths/goe_time.h"

#if GOE_WITH_FILTER

#if !GOE_AUGMENTED
#define PATH_MIN_M 0.1f

/* Without the columns of the obstacle's velocity, an error of the own velocity counts as if it scaled and turned the path. A path that leads
 * back is not scaled, but its end is off by the error. */
static void scale_path(const goe_filter_t *filter, const goe_motion_t *motion, float off_m, goe_drift_t *drift) {
    const float dx_m = motion->dx_m - filter->axes.start_dx_m;
    const float dz_m = motion->dz_m - filter->axes.start_dz_m;
    drift->off_m = off_m;
    drift->share = off_m / goe_larger(sqrtf(dx_m * dx_m + dz_m * dz_m), PATH_MIN_M);
}

/* Variance by this scale. */
static float scaled_m2(const goe_motion_t *motion, const goe_drift_t *drift, const goe_shape_t *shape, bool box,
                       int quantity) {
    const float value = shape->quantity[quantity].value;
    const float far_m = shape->quantity[GOE_Z0].value;
    const float share2 = goe_square(drift->share);
    switch (quantity) {
        case GOE_X0:
        case GOE_Z0:
            return goe_larger(share2 * goe_square(far_m), goe_square(drift->off_m));
        case GOE_ORIENTATION:
            return box ? share2 : 0.0f;
        case GOE_HEIGHT:
            return share2 * goe_larger(goe_square(value), goe_square(value - motion->height_m));
        default:
            return share2 * goe_square(value);
    }
}
#endif

goe_drift_t goe_drift_of(const goe_filter_t *filter, const goe_navigation_t *navigation, const goe_motion_t *motion) {
    goe_drift_t drift;
    const float s = goe_filter_elapsed_s(filter, motion);
    drift.camera_m = goe_filter_camera(filter, motion);
    drift.walk_m2 = goe_square(navigation->position_walk_sd_m) * s + goe_square(navigation->position_white_sd_m);
#if !GOE_AUGMENTED
    scale_path(filter, motion, navigation->velocity_bias_sd_m_s * s, &drift);
#endif
    return drift;
}

float goe_drift_before_start(const goe_filter_t *filter, const goe_navigation_t *navigation,
                             const goe_motion_t *motion) {
    const float s = goe_time_between_s(motion->start_time_us, filter->axes.start_time_us, GOE_TIME_MAX_US);
    return goe_square(navigation->velocity_bias_sd_m_s * s) + goe_square(navigation->position_walk_sd_m) * s;
}

/* Variance by the walk of the own position, and by properties of the shape that no image shows. */
static float given_m2(const goe_drift_t *drift, const goe_shape_t *shape, bool box, int quantity) {
    switch (quantity) {
        case GOE_X0:
        case GOE_Z0:
            return drift->walk_m2 + shape->place_m2;
        case GOE_ORIENTATION:
            return box ? shape->turned_rad2 : 0.0f;
        case GOE_HEIGHT:
            return shape->top_m2;
        case GOE_WIDTH:
            return shape->width_m2;
        default:
            return 0.0f;
    }
}

float goe_drift_variance(const goe_motion_t *motion, const goe_drift_t *drift, const goe_shape_t *shape, bool box,
                         int quantity) {
    const float given = given_m2(drift, shape, box, quantity);
#if GOE_AUGMENTED
    (void)motion;
    return given;
#else
    return given + scaled_m2(motion, drift, shape, box, quantity);
#endif
}

#endif
