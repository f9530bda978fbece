/* The horizontal ellipse of a footprint: how far it reaches, where a line touches it, and the derivatives. SPDX-License-Identifier: MIT */
#ifndef GOE_ELLIPSE_H
#define GOE_ELLIPSE_H

#include "refined/goe_filter.h"

/* All points A v about the middle, abs(v) <= 1, with A = (half 0; shear half ratio), across and along Z; units of Z0. (R23) */
typedef struct {
    float half, shear;
    float ratio; /* of depth over width */
} goe_ellipse_t;

/* The point A v of the ellipse that is farthest along a horizontal unit vector. */
typedef struct {
    goe_xz_t at;
    float v[2];
    float reach; /* its distance along that vector: the support function */
} goe_contact_t;

/* Derivatives by the states of the footprint: shear, half width, log of depth over width. */
typedef struct {
    float shear, half, depth;
} goe_by_footprint_t;

/* The support function in one direction, with its derivatives. */
typedef struct {
    float reach;
    goe_by_footprint_t by;
} goe_support_t;

/* The footprint as viewed from the camera: the unit vector toward the camera in the state's axes, and the reach along and across it. */
typedef struct {
    goe_xz_t towards;
    goe_support_t before, across;
} goe_aspect_t;

goe_ellipse_t goe_ellipse_of(const float state[GOE_STATES]);

goe_contact_t goe_ellipse_touch(const goe_ellipse_t *ellipse, goe_xz_t outward);

/* Derivatives of gradient' A v, for a row that depends on the touched point. By the envelope theorem v does not change. (R27) */
goe_by_footprint_t goe_ellipse_slope(const goe_ellipse_t *ellipse, const goe_contact_t *contact, goe_xz_t gradient);

/* Additional derivatives if the point is farthest along a unit vector that is not the gradient and that turns with the line of sight: the
 * point then slides along the rim. */
typedef struct {
    goe_by_footprint_t by;
    goe_xz_t by_outward;
} goe_slide_t;

goe_slide_t goe_ellipse_slide(const goe_ellipse_t *ellipse, const goe_contact_t *contact, goe_xz_t outward,
                              goe_xz_t gradient);

/* Finds the footprint as viewed from camera_m, the camera's displacement since the filter's start. The part behind the camera counts up to
 * the camera. */
void goe_ellipse_face_camera(const goe_filter_t *filter, goe_xz_t camera_m, goe_aspect_t *aspect);

#endif
