/* The horizontal ellipse of a footprint, and its derivatives. SPDX-License-Identifier: MIT */
#include "refined/goe_ellipse.h"

#include <math.h>

#include "maths/goe_exp.h"
#include "maths/goe_scalar.h"

#if GOE_WITH_FILTER

#define REACH_MIN 1.0e-9f /* least reach of the footprint, and least distance to it, units of Z0 */

goe_ellipse_t goe_ellipse_of(const float state[GOE_STATES]) {
    const goe_ellipse_t ellipse = {state[GOE_HALF], state[GOE_SHEAR], goe_exp(state[GOE_LOG_DEPTH])};
    return ellipse;
}

/* (R23), (R25). */
goe_contact_t goe_ellipse_touch(const goe_ellipse_t *ellipse, goe_xz_t outward) {
    const float depth = ellipse->half * ellipse->ratio;
    const float across = ellipse->half * outward.x + ellipse->shear * outward.z;
    const float along = depth * outward.z;
    goe_contact_t to;
    to.reach = goe_larger(sqrtf(across * across + along * along), REACH_MIN);
    to.v[0] = across / to.reach;
    to.v[1] = along / to.reach;
    to.at.x = ellipse->half * to.v[0];
    to.at.z = ellipse->shear * to.v[0] + depth * to.v[1];
    return to;
}

goe_by_footprint_t goe_ellipse_slope(const goe_ellipse_t *ellipse, const goe_contact_t *contact, goe_xz_t gradient) {
    const float along = gradient.z * contact->v[1] * ellipse->ratio;
    const goe_by_footprint_t by = {gradient.z * contact->v[0], gradient.x * contact->v[0] + along,
                                   along * ellipse->half};
    return by;
}

/* If A changes by dA and u by du, v turns toward t, perpendicular to v, by t'(dA' u + A' du) over the reach. */
goe_slide_t goe_ellipse_slide(const goe_ellipse_t *ellipse, const goe_contact_t *contact, goe_xz_t outward,
                              goe_xz_t gradient) {
    const float t[2] = {-contact->v[1], contact->v[0]};
    const float depth = ellipse->half * ellipse->ratio;
    const goe_xz_t way = {ellipse->half * t[0], ellipse->shear * t[0] + depth * t[1]}; /* A t */
    const float per_turn = goe_xz_dot(gradient, way) / contact->reach;
    goe_slide_t slide;
    slide.by.shear = per_turn * t[0] * outward.z;
    slide.by.half = per_turn * (t[0] * outward.x + t[1] * ellipse->ratio * outward.z);
    slide.by.depth = per_turn * t[1] * depth * outward.z;
    slide.by_outward.x = per_turn * way.x;
    slide.by_outward.z = per_turn * way.z;
    return slide;
}

static void support(const goe_ellipse_t *footprint, goe_xz_t outward, goe_support_t *to) {
    const goe_contact_t contact = goe_ellipse_touch(footprint, outward);
    to->reach = contact.reach;
    to->by = goe_ellipse_slope(footprint, &contact, outward);
}

void goe_ellipse_face_camera(const goe_filter_t *filter, goe_xz_t camera_m, goe_aspect_t *aspect) {
    const float *x = filter->state;
    const float q = x[GOE_INVERSE_RANGE];
    const goe_xz_t middle = {x[GOE_BEARING] - camera_m.x * q, 1.0f - camera_m.z * q};
    const float range = goe_larger(sqrtf(goe_xz_dot(middle, middle)), REACH_MIN);
    const goe_xz_t towards = {-middle.x / range, -middle.z / range};
    const goe_xz_t right = {towards.z, -towards.x};
    const goe_ellipse_t footprint = goe_ellipse_of(x);
    aspect->towards = towards;
    support(&footprint, towards, &aspect->before);
    support(&footprint, right, &aspect->across);
    aspect->before.reach = aspect->before.reach < range ? aspect->before.reach : range;
}

#endif
