/* The outline, box or disc: how far it reaches, and where a course enters and leaves it. SPDX-License-Identifier: MIT */
#include "hazard/goe_outline.h"

#include <math.h>
#include <string.h>

#include "maths/goe_angle.h"
#include "maths/goe_scalar.h"

#if GOE_WITH_HAZARD

#define PARALLEL 1.0e-5f    /* sine of the angle between two directions that count as parallel */
#define CHORD_MIN_M 1.0e-3f /* least half chord by which a derivative is divided */
#define DISTANCE_MIN_M 1.0e-6f
#define NUMBER_MAX 1.0e9f

/* ----------------------------------------------------------------------------------------------------------- outline -- */

void goe_outline_of(const goe_estimate_t *estimate, goe_outline_t *o) {
    const unsigned needed = GOE_HAS_ORIENTATION | GOE_HAS_WIDTH | GOE_HAS_LENGTH;
    o->reference.x = estimate->x_m;
    o->reference.z = estimate->z_m;
    o->length_axis.x = estimate->length_axis[0];
    o->length_axis.z = estimate->length_axis[1];
    o->width_axis.x = estimate->width_axis[0];
    o->width_axis.z = estimate->width_axis[1];
    o->half = (estimate->valid & GOE_HAS_WIDTH) ? 0.5f * estimate->width_m : 0.0f;
    o->length = estimate->length_m;
    o->box =
        estimate->model != GOE_MODEL_DISC && estimate->model != GOE_MODEL_PRISM && (estimate->valid & needed) == needed;
}

void goe_outline_corner_along(const goe_outline_t *o, const goe_xz_t *m, float side, float end, goe_affine_t *at) {
    const float across = goe_xz_dot(*m, o->width_axis);
    const float along = goe_xz_dot(*m, o->length_axis);
    const float side_m = side * 2.0f * o->half;
    const float end_m = end * o->length;
    at->value = goe_xz_dot(*m, o->reference) + side_m * across + end_m * along;
    at->by[GOE_X0] = m->x;
    at->by[GOE_Z0] = m->z;
    at->by[GOE_ORIENTATION] = (end_m * across - side_m * along) * GOE_RAD_PER_DEG;
    at->by[GOE_WIDTH] = side * across;
    at->by[GOE_LENGTH] = end * along;
    at->by[GOE_HEIGHT] = 0.0f;
}

/* m k at the corner k of a box on the side of the signs of across and along; for a disc, k is the center. */
GOE_NOINLINE static void corner_on(const goe_outline_t *o, const goe_xz_t *m, float across, float along,
                                   goe_affine_t *at) {
    const float side = across < 0.0f ? -0.5f : 0.5f;
    const float end = along > 0.0f ? 1.0f : 0.0f;
    goe_outline_corner_along(o, m, o->box ? side : 0.0f, o->box ? end : 0.0f, at);
}

void goe_outline_reach(const goe_outline_t *o, const goe_xz_t *m, goe_affine_t *reach) {
    corner_on(o, m, goe_xz_dot(*m, o->width_axis), goe_xz_dot(*m, o->length_axis), reach);
    if (!o->box) {
        reach->value += o->half;
        reach->by[GOE_WIDTH] = 0.5f;
    }
}

void goe_outline_distance(const goe_outline_t *o, const goe_xz_t *m, goe_affine_t *distance) {
    goe_outline_reach(o, m, distance);
    goe_affine_divide(distance, -1.0f);
}

void goe_outline_along(const goe_outline_t *o, const goe_xz_t *ahead, const goe_xz_t *m, goe_affine_t *along) {
    const float across_m = goe_xz_dot(*m, o->width_axis);
    const float along_m = goe_xz_dot(*m, o->length_axis);
    corner_on(o, ahead, goe_absolute(across_m) > PARALLEL ? across_m : -goe_xz_dot(*ahead, o->width_axis),
              goe_absolute(along_m) > PARALLEL ? along_m : -goe_xz_dot(*ahead, o->length_axis), along);
}

/* --------------------------------------------------------------------------------------------------------- crossing -- */

/* Distance along the course to the entry into (way -1) or the exit from (way 1) a disc that it crosses. sigma_m: sigma of the depth of the
 * crossing. Near the rim the chord grows with the root of the depth, so its derivative is taken at least half a sigma inside. */
static void chord_end(const goe_outline_t *o, const goe_course_t *course, float way, float sigma_m, goe_affine_t *end) {
    const goe_xz_t *right = &course->side[GOE_RIGHT];
    const float off = goe_xz_dot(*right, o->reference);
    const float chord = sqrtf(goe_larger(o->half * o->half - off * off, 0.0f));
    const float share = way / goe_larger(goe_larger(chord, sqrtf(o->half * sigma_m)), CHORD_MIN_M);
    goe_outline_corner_along(o, &course->ahead, 0.0f, 0.0f, end);
    end->value += way * chord;
    end->by[GOE_X0] -= share * off * right->x;
    end->by[GOE_Z0] -= share * off * right->z;
    end->by[GOE_WIDTH] = 0.5f * share * o->half;
}

/*@ requires \valid_read(o) && 0 <= face < GOE_CORNERS; */
static goe_xz_t normal_of(const goe_outline_t *o, int face) {
    const goe_xz_t axis = (face & 2) ? o->length_axis : o->width_axis;
    return (face & 1) ? goe_xz_negative(axis) : axis;
}

/* Distance along the course to the line of the face with the outward normal m; slope = m u, not 0. */
static void face_line(const goe_outline_t *o, const goe_course_t *course, const goe_xz_t *m, float slope,
                      goe_affine_t *line) {
    goe_outline_reach(o, m, line);
    goe_affine_divide(line, slope);
    const goe_xz_t to_reference = {o->reference.x - line->value * course->ahead.x,
                                   o->reference.z - line->value * course->ahead.z};
    line->by[GOE_ORIENTATION] = goe_xz_dot(goe_outline_right_of(*m), to_reference) * GOE_RAD_PER_DEG / slope;
}

/* The same for a box: it is entered by the last of the faces that are crossed inward, and left by the first of the others. */
static void face_end(const goe_outline_t *o, const goe_course_t *course, float way, goe_affine_t *end) {
    bool any = false;
    memset(end, 0, sizeof *end);
    for (int face = 0; face < GOE_CORNERS; face++) {
        const goe_xz_t normal = normal_of(o, face);
        const float slope = goe_xz_dot(normal, course->ahead);
        if (way * slope > PARALLEL) {
            goe_affine_t line;
            face_line(o, course, &normal, slope, &line);
            if (!any || way * (line.value - end->value) < 0.0f) {
                *end = line;
                any = true;
            }
        }
    }
}

void goe_outline_end(const goe_outline_t *o, const goe_course_t *course, float way, float sigma_m, goe_affine_t *end) {
    if (o->box) {
        face_end(o, course, way, end);
    } else {
        chord_end(o, course, way, sigma_m, end);
    }
}

/* -------------------------------------------------------------------------------------------------- its position --- */

/* The way out of a box that contains the camera, by the nearest face that does not point against the course. */
static goe_xz_t way_out_of_box(const goe_outline_t *o, const goe_course_t *course) {
    goe_affine_t depth;
    goe_xz_t best = course->ahead;
    float least = NUMBER_MAX;
    for (int face = 0; face < GOE_CORNERS; face++) {
        const goe_xz_t normal = normal_of(o, face);
        goe_outline_reach(o, &normal, &depth);
        if (depth.value < least && goe_xz_dot(normal, course->ahead) >= 0.0f) {
            least = depth.value;
            best = normal;
        }
    }
    return best;
}

/* From the outline to the camera now; inside the outline, the shortest way out. */
static goe_xz_t way_from_box(const goe_outline_t *o, const goe_course_t *course) {
    const float across = -goe_xz_dot(o->width_axis, o->reference);
    const float along = -goe_xz_dot(o->length_axis, o->reference);
    const float off_across = across - (across < -o->half ? -o->half : across > o->half ? o->half : across);
    const float off_along = along - (along < 0.0f ? 0.0f : along > o->length ? o->length : along);
    const float norm = sqrtf(off_across * off_across + off_along * off_along);
    if (norm < DISTANCE_MIN_M) {
        return way_out_of_box(o, course);
    }
    const goe_xz_t m = {(off_across * o->width_axis.x + off_along * o->length_axis.x) / norm,
                        (off_across * o->width_axis.z + off_along * o->length_axis.z) / norm};
    return m;
}

static goe_xz_t way_from_disc(const goe_outline_t *o, const goe_course_t *course) {
    const goe_xz_t c = o->reference;
    const float norm = sqrtf(goe_xz_dot(c, c));
    if (norm < o->half && goe_xz_dot(c, course->ahead) > 0.0f) {
        return course->ahead; /* inside, and the sides are nearer than the part behind */
    }
    goe_xz_t m = {0.0f, 1.0f};
    if (norm > DISTANCE_MIN_M) {
        m.x = -c.x / norm;
        m.z = -c.z / norm;
    }
    return m;
}

goe_xz_t goe_outline_way_from(const goe_outline_t *o, const goe_course_t *course) {
    return o->box ? way_from_box(o, course) : way_from_disc(o, course);
}

#endif
