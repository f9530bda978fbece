/* The near side of an obstacle: the circle that a hazard meets. SPDX-License-Identifier: MIT */
#include "refined/goe_near_side.h"

#include <string.h>

#include "maths/goe_scalar.h"
#include "refined/goe_ellipse.h"

#if GOE_WITH_FILTER

float goe_near_side_reach(const goe_filter_t *filter, goe_xz_t *nearer_m) {
    const float *x = filter->state;
    memset(nearer_m, 0, sizeof *nearer_m);
    if (goe_filter_traits(filter)->is_ellipse) {
        goe_aspect_t aspect;
        goe_ellipse_face_camera(filter, goe_filter_measured(filter), &aspect);
        const float way_m = (aspect.before.reach - aspect.across.reach) / x[GOE_INVERSE_RANGE];
        const goe_xz_t towards = goe_filter_into_trajectory(filter, aspect.towards);
        nearer_m->x = way_m * towards.x;
        nearer_m->z = way_m * towards.z;
        return aspect.across.reach / x[GOE_INVERSE_RANGE];
    }
    return 0.5f * (x[GOE_FRONT_X] + goe_absolute(x[GOE_SIDE_X])) / x[GOE_INVERSE_RANGE];
}

/* Adds to by[]: factor times the derivatives of `reach` minus `less` (or null), lengths in units of Z0. */
/*@ requires \valid_read(reach) && (less == \null || \valid_read(less)) && \valid(by + (0 .. GOE_STATES - 1)); */
static void add_to_footprint(float factor, float scale_m, const goe_support_t *reach, const goe_support_t *less,
                             float by[GOE_STATES]) {
    by[GOE_SHEAR] += factor * (reach->by.shear - (less ? less->by.shear : 0.0f));
    by[GOE_HALF] += factor * (reach->by.half - (less ? less->by.half : 0.0f));
    by[GOE_LOG_DEPTH] += factor * (reach->by.depth - (less ? less->by.depth : 0.0f));
    by[GOE_INVERSE_RANGE] -= factor * scale_m * (reach->reach - (less ? less->reach : 0.0f));
}

static void count_from_datum(goe_shape_t *shape) {
    shape->quantity[GOE_HEIGHT].by[GOE_GROUND] = 0.0f;
    shape->quantity[GOE_HEIGHT].by[GOE_INVERSE_RANGE] += shape->datum_by_range;
}

void goe_near_side_meet(const goe_filter_t *filter, goe_shape_t *shape) {
    goe_aspect_t aspect;
    count_from_datum(shape);
    if (!goe_filter_traits(filter)->is_ellipse) {
        return;
    }
    goe_ellipse_face_camera(filter, goe_filter_measured(filter), &aspect);
    const goe_support_t *before = &aspect.before;
    const goe_support_t *across = &aspect.across;
    const goe_xz_t towards = goe_filter_into_trajectory(filter, aspect.towards);
    const float scale_m = shape->scale_m;
    add_to_footprint(scale_m * towards.x, scale_m, before, across, shape->quantity[GOE_X0].by);
    add_to_footprint(scale_m * towards.z, scale_m, before, across, shape->quantity[GOE_Z0].by);
    memset(shape->quantity[GOE_WIDTH].by, 0, sizeof shape->quantity[GOE_WIDTH].by);
    add_to_footprint(2.0f * scale_m, scale_m, across, NULL, shape->quantity[GOE_WIDTH].by);
    shape->quantity[GOE_WIDTH].value = 2.0f * scale_m * across->reach;
}

#endif
