/* Common quantities of all models. SPDX-License-Identifier: MIT */
#include "refined/goe_shape.h"

#include <math.h>
#include <string.h>

#include "maths/goe_scalar.h"

#if GOE_WITH_FILTER

void goe_shape_place(const goe_spot_t *spot, float scale_m, float by_x, float by_z, float by[GOE_STATES]) {
    by[GOE_BEARING] = by_x * scale_m;
    by[GOE_INVERSE_RANGE] = -scale_m * scale_m * (by_x * spot->at.x + by_z * spot->at.z);
    for (size_t i = 0; i < 3; i++) {
        by[GOE_SIDE_X + i] = scale_m * (by_x * spot->x_by[i] + by_z * spot->z_by[i]);
    }
}

void goe_shape_start(const goe_filter_t *filter, const goe_spot_t *reference, goe_shape_t *shape) {
    const float *x = filter->state;
    const float c = filter->axes.turn_cos;
    const float s = filter->axes.turn_sin;
    const float q = x[GOE_INVERSE_RANGE];
    const float scale_m = q > 0.0f ? 1.0f / q : 0.0f; /* a flipped bit */
    const goe_xz_t place = goe_filter_into_trajectory(filter, reference->at);
    goe_linear_t *height = &shape->quantity[GOE_HEIGHT];
    memset(shape, 0, sizeof *shape);
    shape->scale_m = scale_m;
    shape->corner_growth = 1.0f;
    shape->length_axis.z = 1.0f;
    shape->quantity[GOE_X0].value = place.x * scale_m;
    shape->quantity[GOE_Z0].value = place.z * scale_m;
    goe_shape_place(reference, scale_m, c, s, shape->quantity[GOE_X0].by);
    goe_shape_place(reference, scale_m, -s, c, shape->quantity[GOE_Z0].by);
    height->value = (x[GOE_TOP] + x[GOE_GROUND]) * scale_m;
    height->by[GOE_INVERSE_RANGE] = -scale_m * height->value;
    height->by[GOE_GROUND] = scale_m;
    height->by[GOE_TOP] = scale_m;
    shape->datum_by_range = x[GOE_GROUND] * scale_m * scale_m;
}

#endif
