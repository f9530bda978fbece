/* The common quantities of all models, and variances that no image reduces. SPDX-License-Identifier: MIT */
#include "refined/goe_shape.h"

#include <math.h>
#include <string.h>

#include "maths/goe_scalar.h"

#if GOE_WITH_FILTER

#define ELLIPSE_SHARE 0.05f /* one sigma of the position's error, over the width, if points show another shape */
#define FAR_ROOF 2.0f       /* one sigma of the position of the farthest corner of the roof, over the extent */
#define RANGE_MIN_M 1.0f

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
    const float scale_m = q > 0.0f ? 1.0f / q : 0.0f; /* not positive only after a bit flip */
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

/* Points of a silhouette do not show that the footprint is no ellipse. */
static void doubt_ellipse(const goe_filter_t *filter, goe_shape_t *shape) {
    if (goe_filter_traits(filter)->is_ellipse && !goe_filter_by_boxes(filter) && !filter->kind.is_round) {
        shape->place_m2 += goe_square(ELLIPSE_SHARE * shape->quantity[GOE_WIDTH].value);
    }
}

/* (R37): viewed from above, the highest point of a roof is a far corner. While one face is visible, no image shows how far it is. */
static void doubt_far_roof(const goe_filter_t *filter, bool highest, goe_shape_t *shape) {
    if (goe_filter_traits(filter)->one_face && (filter->boxes || highest)) {
        const float size_m = goe_larger(shape->quantity[GOE_WIDTH].value, shape->quantity[GOE_LENGTH].value);
        shape->roof_m2 = goe_square(FAR_ROOF * size_m);
    }
}

/* The roof's corner below the top is off the middle. Viewed from above or from below, it appears lower or higher by the tangent of that
 * angle. The code uses the sine, which differs only nearby. */
static float top_variance(goe_xz_t camera_m, float height_m, const goe_shape_t *shape) {
    const float x_m = shape->middle.at.x * shape->scale_m - camera_m.x;
    const float z_m = shape->middle.at.z * shape->scale_m - camera_m.z;
    const float below2_m2 = goe_square(height_m - shape->quantity[GOE_HEIGHT].value);
    return shape->roof_m2 * below2_m2 / goe_larger(x_m * x_m + z_m * z_m + below2_m2, goe_square(RANGE_MIN_M));
}

void goe_shape_doubt(const goe_filter_t *filter, bool highest, goe_xz_t camera_m, float height_m, goe_shape_t *shape) {
    doubt_ellipse(filter, shape);
    doubt_far_roof(filter, highest, shape);
    shape->top_m2 = shape->roof_m2 > 0.0f ? top_variance(camera_m, height_m, shape) : 0.0f;
}

#endif
