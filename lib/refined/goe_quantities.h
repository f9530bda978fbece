/* The quantities of an estimate, computed from the filter's state: values, sigmas, covariance and validity. SPDX-License-Identifier: MIT */
#ifndef GOE_QUANTITIES_H
#define GOE_QUANTITIES_H

#include "refined/goe_shape.h"

typedef struct {
    unsigned now;                /* GOE_HAS_...: quantities that the latest image knows well enough */
    unsigned known;              /* those that the previous image knew as well; 0: report nothing */
    float value[GOE_QUANTITIES]; /* X0, Z0 from the track's first image, T axes; m, orientation in rad */
    float sigma[GOE_QUANTITIES];
    float worked_out[GOE_QUANTITIES]; /* the sigmas for validity: without scatter, ground and a prism's depth */
    float began_m2[2];    /* X0, Z0: variance from the filter's start on, minus that relative to the camera now */
    float before_m2;      /* variance of X0 and of Z0 by the drift of the own position before the filter's start */
    goe_xz_t length_axis; /* unit vector, T axes */
    bool moves;           /* the obstacle is followed; the position is that at the latest image */
    float velocity_m_s[2], velocity_sd_m_s[2]; /* valid if it moves: north, east */
    float center_m[2], center_sd_m[2];         /* north, east; valid with GOE_HAS_CENTER */
    float center_ne_m2;                        /* covariance of the two, valid with GOE_HAS_CENTER */
    goe_model_t model;
    bool box;
} goe_quantities_t;

/* Sets the quantities as of the latest image that the filter used. */
void goe_quantities_find(const goe_filter_t *filter, const goe_settings_t *settings, const goe_motion_t *motion,
                         goe_quantities_t *quantities);

/* (R20): covariance of the six quantities, meters and radians, ahead_s after the latest image. for_hazard: the top's height counts from the
 * altimeter's zero, not from the ground, because its constant error cancels between camera and top. And a prism's place and width are those
 * of the circle that is as wide across the line of sight, and as near to the camera, as the prism. */
void goe_quantities_covariance(const goe_filter_t *filter, const goe_settings_t *settings, const goe_motion_t *motion,
                               bool for_hazard, float ahead_s, float covariance[GOE_QUANTITIES][GOE_QUANTITIES]);

#endif
