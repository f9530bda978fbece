/* A horizontal ellipse that may turn: how far it reaches, where a line touches it, and the derivatives.
 * SPDX-License-Identifier: MIT */
#ifndef GOE_ELLIPSE_H
#define GOE_ELLIPSE_H

#include "refined/goe_filter.h"

/* A v from its middle, abs(v) <= 1, with A = (half 0; shear half ratio), across and along Z; units of Z0. (R23) */
typedef struct {
    float half, shear;
    float ratio; /* of depth over width */
} goe_ellipse_t;

/* Where the ellipse lies farthest along a horizontal unit vector: A v. */
typedef struct {
    goe_xz_t at;
    float v[2];
    float reach; /* how far along that vector: the support function */
} goe_contact_t;

/* Derivatives by the states of the footprint: shear, half width, log of depth over width. */
typedef struct {
    float shear, half, depth;
} goe_by_footprint_t;

/* A reach with its derivatives. */
typedef struct {
    float reach;
    goe_by_footprint_t by;
} goe_support_t;

/* The footprint from the camera: towards it along the line of sight, which is that unit vector in the state's axes, and across. */
typedef struct {
    goe_xz_t towards;
    goe_support_t before, across;
} goe_aspect_t;

goe_ellipse_t goe_ellipse_of(const float state[GOE_STATES]);

goe_contact_t goe_ellipse_touch(const goe_ellipse_t *ellipse, goe_xz_t outward);

/* Of gradient' A v: of what depends on the place that is touched. By the envelope theorem v does not change. (R27) */
goe_by_footprint_t goe_ellipse_slope(const goe_ellipse_t *ellipse, const goe_contact_t *contact, goe_xz_t gradient);

/* The same of a place where the ellipse lies farthest along a unit vector that a line of sight turns, not along the gradient: what the
 * place's sliding along the rim adds. */
typedef struct {
    goe_by_footprint_t by;
    goe_xz_t by_outward;
} goe_slide_t;

goe_slide_t goe_ellipse_slide(const goe_ellipse_t *ellipse, const goe_contact_t *contact, goe_xz_t outward,
                              goe_xz_t gradient);

/* As the camera sees it from camera_m, since the filter's start. The part behind the camera counts up to the camera. */
void goe_ellipse_face_camera(const goe_filter_t *filter, goe_xz_t camera_m, goe_aspect_t *aspect);

#endif
