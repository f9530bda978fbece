/* The outline of an obstacle in the horizontal plane, box or disc. SPDX-License-Identifier: MIT
 *
 * Axes: T, the camera now at the origin. The outline K is convex. Its support function in a direction m is h(m) = max over K of m k.
 * Distances need only this function: the ray along u keeps max of -h(m), m u >= 0, from K, negative if it crosses K. By the envelope
 * theorem, the derivative at the best m is that of h with m fixed. */
#ifndef GOE_OUTLINE_H
#define GOE_OUTLINE_H

#include "hazard/goe_affine.h"
#include "maths/goe_xz.h"

#define GOE_CORNERS 4

typedef struct {
    goe_xz_t reference, width_axis, length_axis;
    float half, length; /* half: half of the width, or the radius */
    bool box;
} goe_outline_t;

enum { GOE_RIGHT, GOE_LEFT, GOE_SIDES };

typedef struct {
    goe_xz_t ahead, back, side[GOE_SIDES]; /* unit vectors; 0 if the aircraft hovers */
    float speed_m_s, climb_m_s;
} goe_course_t;

/* A quarter turn to the right, which is also the derivative with respect to the orientation. */
static inline goe_xz_t goe_outline_right_of(goe_xz_t v) {
    const goe_xz_t right = {v.z, -v.x};
    return right;
}

/* The box if orientation, width and length are valid, otherwise a disc. */
void goe_outline_of(const goe_estimate_t *estimate, goe_outline_t *o);

/* *at = m k at a corner k of a box; the derivatives keep m fixed. side: -0.5 or 0.5 of the width; end: 0 or 1 of the length. At the
 * reference point both are 0. */
void goe_outline_corner_along(const goe_outline_t *o, const goe_xz_t *m, float side, float end, goe_affine_t *at);

/* Computes h(m), |m| = 1. */
void goe_outline_reach(const goe_outline_t *o, const goe_xz_t *m, goe_affine_t *reach);

/* -h(m): signed distance of the camera from the half-plane that contains the outline, in the direction m. */
void goe_outline_distance(const goe_outline_t *o, const goe_xz_t *m, goe_affine_t *distance);

/* Distance along the course to the point where the outline reaches farthest toward m, a side of the course; for a whole edge, to its first
 * end. */
void goe_outline_along(const goe_outline_t *o, const goe_xz_t *ahead, const goe_xz_t *m, goe_affine_t *along);

/* Distance along the course to the entry into (way -1) or the exit from (way 1) the outline, which it crosses. sigma_m: sigma of the depth
 * of the crossing. */
void goe_outline_end(const goe_outline_t *o, const goe_course_t *course, float way, float sigma_m, goe_affine_t *end);

/* Unit vector from the outline to the camera now; inside the outline, the shortest way out. */
goe_xz_t goe_outline_way_from(const goe_outline_t *o, const goe_course_t *course);

#endif
