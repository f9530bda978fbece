/* From the filter's state to the quantities of an estimate, their sigmas, and which are known well enough.
 * SPDX-License-Identifier: MIT */
#ifndef GOE_QUANTITIES_H
#define GOE_QUANTITIES_H

#include "refined/goe_shape.h"

typedef struct {
    unsigned now;                /* GOE_HAS_...: what the latest image knows well enough ... */
    unsigned known;              /* ... and the one before knew, too; 0: the rest does not hold */
    float value[GOE_QUANTITIES]; /* X0, Z0 from the track's first image, T axes; m, orientation in rad */
    float sigma[GOE_QUANTITIES];
    float worked_out[GOE_QUANTITIES]; /* ... excluding a prism's depth: decides on validity */
    float before_m2;      /* variance of X0 and Z0 by what the own position drifted before the filter's start */
    goe_xz_t length_axis; /* unit vector, T axes */
    bool moves;           /* and is followed; the place is that at the latest image ... */
    float velocity_m_s[2], velocity_sd_m_s[2]; /* ... and these hold: north, east */
    float center_m[2], center_sd_m[2];         /* north, east; holds with GOE_HAS_CENTER ... */
    float center_ne_m2;                        /* ... as does the covariance of the two */
    goe_model_t model;
    bool box;
} goe_quantities_t;

/* What the latest image that the filter took knows. */
void goe_quantities_find(const goe_filter_t *filter, const goe_settings_t *settings, const goe_motion_t *motion,
                         goe_quantities_t *quantities);

/* (R20): covariance of the six quantities, meters and radians, of the filter's present state. for_hazard: the top's height
 * is counted from the altimeter's zero, not from the ground: its constant error cancels between camera and top. And a
 * prism's place and width are those of the circle that is as wide across the line of sight, and as near to the camera, as it is. */
void goe_quantities_covariance(const goe_filter_t *filter, const goe_settings_t *settings, const goe_motion_t *motion,
                               bool for_hazard, float ahead_s, float covariance[GOE_QUANTITIES][GOE_QUANTITIES]);

#endif
