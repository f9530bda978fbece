/* The drift of the own position, (R21). SPDX-License-Identifier: MIT */
#include "refined/goe_drift.h"

#include <math.h>

#include "maths/goe_scalar.h"
#include "maths/goe_time.h"

#if GOE_WITH_FILTER

#define PATH_MIN_M 0.1f

static float path_over_ground(const goe_filter_t *filter, const goe_motion_t *motion) {
    const float dx_m = motion->dx_m - filter->axes.start_dx_m;
    const float dz_m = motion->dz_m - filter->axes.start_dz_m;
    return sqrtf(dx_m * dx_m + dz_m * dz_m);
}

goe_drift_t goe_drift_of(const goe_filter_t *filter, const goe_navigation_t *navigation, const goe_motion_t *motion) {
    goe_drift_t drift;
    const float s = goe_filter_elapsed_s(filter, motion);
    drift.camera_m = goe_filter_camera(filter, motion);
    const float path_m = path_over_ground(filter, motion);
    drift.share = navigation->velocity_bias_sd_m_s * s / (path_m > PATH_MIN_M ? path_m : PATH_MIN_M);
    drift.walk_m2 = goe_square(navigation->position_walk_sd_m) * s;
    const float straight = filter->flown_m > path_m ? path_m / filter->flown_m : 1.0f;
    drift.turned_m2 = goe_square(navigation->velocity_bias_sd_m_s * s) * (1.0f - straight * straight);
    return drift;
}

float goe_drift_before_start(const goe_filter_t *filter, const goe_navigation_t *navigation,
                             const goe_motion_t *motion) {
    const float s = goe_time_between_s(motion->start_time_us, filter->axes.start_time_us, GOE_TIME_MAX_US);
    return goe_square(navigation->velocity_bias_sd_m_s * s) + goe_square(navigation->position_walk_sd_m) * s;
}

float goe_drift_variance(const goe_motion_t *motion, const goe_drift_t *drift, const goe_shape_t *shape, bool box,
                         int quantity) {
    const float share2 = goe_square(drift->share);
    const float value = shape->quantity[quantity].value;
    switch (quantity) {
        case GOE_X0:
        case GOE_Z0:
            return share2 * goe_square(shape->quantity[GOE_Z0].value) + drift->walk_m2 + drift->turned_m2 +
                   shape->place_m2;
        case GOE_ORIENTATION:
            return box ? share2 + shape->turned_rad2 : 0.0f;
        case GOE_HEIGHT:
            return share2 * goe_larger(goe_square(value), goe_square(value - motion->height_m)) + shape->top_m2;
        case GOE_WIDTH:
            return share2 * goe_square(value) + shape->width_m2;
        default:
            return share2 * goe_square(value);
    }
}

#endif
