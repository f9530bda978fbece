/* The outline of an estimate in the horizontal plane. SPDX-License-Identifier: MIT
 *
 * In T, the camera now at the origin. The outline K is convex. Its support function in a direction m, h(m) = max over K of m k, is
 * all that distances need: the ray along u keeps max of -h(m), m u >= 0, from K, negative if it crosses, and by the envelope
 * theorem the derivative at the best m is that of h with m fixed. */
#ifndef GOE_OUTLINE_H
#define GOE_OUTLINE_H

#include "hazard/goe_affine.h"
#include "maths/goe_xz.h"

#define GOE_CORNERS 4

typedef struct {
    goe_xz_t reference, width_axis, length_axis;
    float half, length; /* half: of the width, or the radius */
    bool box;
} goe_outline_t;

enum { GOE_RIGHT, GOE_LEFT, GOE_SIDES };

typedef struct {
    goe_xz_t ahead, back, side[GOE_SIDES]; /* unit vectors; 0 if it stands still */
    float speed_m_s, climb_m_s;
} goe_course_t;

/* A quarter turn to the right: also the derivative by the orientation. */
static inline goe_xz_t goe_outline_right_of(goe_xz_t v) {
    const goe_xz_t right = {v.z, -v.x};
    return right;
}

/* The box as far as it is known, otherwise a disc. */
void goe_outline_of(const goe_estimate_t *estimate, goe_outline_t *o);

/* *at = m k at a corner k of a box, m held in the derivatives: side -0.5 or 0.5 of the width, end 0 or 1 of the length. At the
 * reference point both are 0. */
void goe_outline_corner_along(const goe_outline_t *o, const goe_xz_t *m, float side, float end, goe_affine_t *at);

/* h(m), |m| = 1. */
void goe_outline_reach(const goe_outline_t *o, const goe_xz_t *m, goe_affine_t *reach);

/* Signed distance to the half-plane beyond which the outline does not reach towards m. */
void goe_outline_distance(const goe_outline_t *o, const goe_xz_t *m, goe_affine_t *distance);

/* Along the course to where the outline reaches farthest towards m, a side of the course; of a whole edge that does, to
 * its first end. */
void goe_outline_along(const goe_outline_t *o, const goe_xz_t *ahead, const goe_xz_t *m, goe_affine_t *along);

/* Along the course into (way -1) or out of (way 1) the outline, which it crosses. sigma_m: of how deep. */
void goe_outline_end(const goe_outline_t *o, const goe_course_t *course, float way, float sigma_m, goe_affine_t *end);

/* Unit vector from the outline to the camera now, or out of it by the shortest way. */
goe_xz_t goe_outline_way_from(const goe_outline_t *o, const goe_course_t *course);

#endif
