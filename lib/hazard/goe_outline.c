/* The outline of an estimate: how far it reaches, where a course enters and leaves it. SPDX-License-Identifier: MIT */
#include "hazard/goe_outline.h"

#include <math.h>

#include "maths/goe_angle.h"
#include "maths/goe_scalar.h"

#if GOE_WITH_HAZARD

#define PARALLEL 1.0e-5f      /* sine of an angle between two directions that counts as none */
#define CHORD_LEAST_M 1.0e-3f /* half chord that a derivative divides by */
#define DISTANCE_LEAST_M 1.0e-6f
#define MOST 1.0e9f

/* ----------------------------------------------------------------------------------------------------------- outline -- */

goe_outline_t goe_outline_of(const goe_estimate_t *estimate) {
    const unsigned needed = GOE_HAS_ORIENTATION | GOE_HAS_WIDTH | GOE_HAS_LENGTH;
    goe_outline_t o;
    o.reference.x = estimate->x_m;
    o.reference.z = estimate->z_m;
    o.length_axis.x = estimate->length_axis[0];
    o.length_axis.z = estimate->length_axis[1];
    o.width_axis.x = estimate->width_axis[0];
    o.width_axis.z = estimate->width_axis[1];
    o.half = (estimate->valid & GOE_HAS_WIDTH) ? 0.5f * estimate->width_m : 0.0f;
    o.length = estimate->length_m;
    o.box = estimate->model != GOE_MODEL_DISC && (estimate->valid & needed) == needed;
    return o;
}

goe_affine_t goe_outline_corner(const goe_outline_t *o, goe_xz_t m, float side, float end) {
    const float across = goe_xz_dot(m, o->width_axis);
    const float along = goe_xz_dot(m, o->length_axis);
    const float side_m = side * 2.0f * o->half;
    const float end_m = end * o->length;
    goe_affine_t g = {goe_xz_dot(m, o->reference) + side_m * across + end_m * along, {0}};
    g.by[GOE_X0] = m.x;
    g.by[GOE_Z0] = m.z;
    g.by[GOE_WIDTH] = side * across;
    g.by[GOE_LENGTH] = end * along;
    g.by[GOE_ORIENTATION] = (end_m * across - side_m * along) * GOE_RAD_PER_DEG;
    return g;
}

goe_affine_t goe_outline_reach(const goe_outline_t *o, goe_xz_t m) {
    if (o->box) {
        return goe_outline_corner(o, m, goe_xz_dot(m, o->width_axis) < 0.0f ? -0.5f : 0.5f,
                                  goe_xz_dot(m, o->length_axis) > 0.0f ? 1.0f : 0.0f);
    }
    goe_affine_t h = {goe_xz_dot(m, o->reference) + o->half, {0}};
    h.by[GOE_X0] = m.x;
    h.by[GOE_Z0] = m.z;
    h.by[GOE_WIDTH] = 0.5f;
    return h;
}

goe_affine_t goe_outline_distance(const goe_outline_t *o, goe_xz_t m) {
    goe_affine_t d = goe_outline_reach(o, m);
    d.value = -d.value;
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        d.by[i] = -d.by[i];
    }
    return d;
}

goe_affine_t goe_outline_along(const goe_outline_t *o, goe_xz_t ahead, goe_xz_t m) {
    if (o->box) {
        float across = goe_xz_dot(m, o->width_axis);
        float along = goe_xz_dot(m, o->length_axis);
        across = goe_absolute(across) > PARALLEL ? across : -goe_xz_dot(ahead, o->width_axis);
        along = goe_absolute(along) > PARALLEL ? along : -goe_xz_dot(ahead, o->length_axis);
        return goe_outline_corner(o, ahead, across < 0.0f ? -0.5f : 0.5f, along > 0.0f ? 1.0f : 0.0f);
    }
    goe_affine_t s = {goe_xz_dot(ahead, o->reference), {0}};
    s.by[GOE_X0] = ahead.x;
    s.by[GOE_Z0] = ahead.z;
    return s;
}

/* --------------------------------------------------------------------------------------------------------- crossing -- */

/* Along the course into (way -1) or out of (way 1) a disc that it crosses. sigma_m: of how deep. Near the rim the chord
 * grows with the root of the depth, and its derivative is taken a sigma inside. */
static goe_affine_t chord_end(const goe_outline_t *o, const goe_course_t *course, float way, float sigma_m) {
    const goe_xz_t u = course->ahead;
    const goe_xz_t r = course->right;
    const float off = goe_xz_dot(r, o->reference);
    const float chord2 = o->half * o->half - off * off;
    const float chord = sqrtf(chord2 > 0.0f ? chord2 : 0.0f);
    const float share = way / goe_larger(goe_larger(chord, sqrtf(o->half * sigma_m)), CHORD_LEAST_M);
    goe_affine_t s = {goe_xz_dot(u, o->reference) + way * chord, {0}};
    s.by[GOE_X0] = u.x - share * off * r.x;
    s.by[GOE_Z0] = u.z - share * off * r.z;
    s.by[GOE_WIDTH] = 0.5f * share * o->half;
    return s;
}

/* Along the course to the line of the face with the outward normal m; slope = m u, not 0. */
static goe_affine_t face_line(const goe_outline_t *o, const goe_course_t *course, goe_xz_t m, float slope) {
    goe_affine_t s = goe_outline_reach(o, m);
    s.value /= slope;
    const goe_xz_t to_reference = {o->reference.x - s.value * course->ahead.x,
                                   o->reference.z - s.value * course->ahead.z};
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        s.by[i] /= slope;
    }
    s.by[GOE_ORIENTATION] = goe_xz_dot(goe_outline_right_of(m), to_reference) * GOE_RAD_PER_DEG / slope;
    return s;
}

/* The same for a box: the last of the faces that it enters by, the first of those that it leaves by. */
static goe_affine_t face_end(const goe_outline_t *o, const goe_course_t *course, float way) {
    const goe_xz_t normal[4] = {o->width_axis, goe_xz_negative(o->width_axis), o->length_axis,
                                goe_xz_negative(o->length_axis)};
    goe_affine_t s = {0.0f, {0}};
    bool any = false;
    for (int i = 0; i < 4; i++) {
        const float slope = goe_xz_dot(normal[i], course->ahead);
        if (way * slope > PARALLEL) {
            const goe_affine_t end = face_line(o, course, normal[i], slope);
            if (!any || way * (end.value - s.value) < 0.0f) {
                s = end;
                any = true;
            }
        }
    }
    return s;
}

goe_affine_t goe_outline_end(const goe_outline_t *o, const goe_course_t *course, float way, float sigma_m) {
    return o->box ? face_end(o, course, way) : chord_end(o, course, way, sigma_m);
}

/* -------------------------------------------------------------------------------------------------- where it stands -- */

/* The way out of a box that the camera is in, other than to the sides of the course. */
static goe_xz_t way_out_of_box(const goe_outline_t *o, const goe_course_t *course) {
    const goe_xz_t normal[4] = {o->width_axis, goe_xz_negative(o->width_axis), o->length_axis,
                                goe_xz_negative(o->length_axis)};
    goe_xz_t best = course->ahead;
    float least = MOST;
    for (int i = 0; i < 4; i++) {
        const float depth = goe_outline_reach(o, normal[i]).value;
        if (depth < least && goe_xz_dot(normal[i], course->ahead) >= 0.0f) {
            least = depth;
            best = normal[i];
        }
    }
    return best;
}

/* From the outline to the camera now, or out of it by the shortest way. */
static goe_xz_t way_from_box(const goe_outline_t *o, const goe_course_t *course) {
    const float across = -goe_xz_dot(o->width_axis, o->reference);
    const float along = -goe_xz_dot(o->length_axis, o->reference);
    const float off_across = across - (across < -o->half ? -o->half : across > o->half ? o->half : across);
    const float off_along = along - (along < 0.0f ? 0.0f : along > o->length ? o->length : along);
    const float norm = sqrtf(off_across * off_across + off_along * off_along);
    if (norm < DISTANCE_LEAST_M) {
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
        return course->ahead; /* inside, and the sides are nearer than what lies behind */
    }
    goe_xz_t m = {0.0f, 1.0f};
    if (norm > DISTANCE_LEAST_M) {
        m.x = -c.x / norm;
        m.z = -c.z / norm;
    }
    return m;
}

goe_xz_t goe_outline_way_from(const goe_outline_t *o, const goe_course_t *course) {
    return o->box ? way_from_box(o, course) : way_from_disc(o, course);
}

#endif
