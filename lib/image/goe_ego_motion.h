/* Motion of the camera in the trajectory frame T, from the vehicle's poses. SPDX-License-Identifier: MIT */
#ifndef GOE_EGO_MOTION_H
#define GOE_EGO_MOTION_H

#include "image/goe_view.h"

/* Takes the pose of view->image. Fixes T and its origin, up to the first image that shows a feature; compensates a reset of known size;
 * sets dx_m, dz_m (displacement of the camera since that image, T axes). view->camera and view->camera_to_body must be set. Sets
 * view->camera_to_trajectory, the rotation of this image's rays into T. Returns whether it also compensated a jump that no reset
 * announced. */
bool goe_motion_follow(goe_motion_t *motion, const goe_settings_t *settings, goe_view_t *view);

/* Heading of T's Z axis, clockwise from north, -180 to 180 degrees; 0 before the track's first image. */
float goe_motion_heading_deg(const goe_motion_t *motion);

/* Whether the autopilot's filter jumped since the previous image. */
static inline bool goe_motion_reset(const goe_motion_t *motion, const goe_pose_t *pose) {
    return motion->time_us != GOE_TIME_UNKNOWN && pose->reset_count != motion->reset_count;
}

#if GOE_AUGMENTED
#define GOE_PATH_MARKS_MIN 2u /* least marks that give the smoothed path a velocity */

/* Whether rate and velocity are known. */
static inline bool goe_motion_paced(const goe_motion_t *motion) { return motion->marks >= GOE_PATH_MARKS_MIN; }
#endif

/* Converts (X, Z) in T, relative to T's origin, to north and east. */
static inline void goe_motion_place(const goe_motion_t *motion, float x_m, float z_m, float *north_m, float *east_m) {
    const float c = motion->heading_cos;
    const float s = motion->heading_sin;
    *north_m = motion->origin_ne_m[0] + (c * z_m - s * x_m);
    *east_m = motion->origin_ne_m[1] + (s * z_m + c * x_m);
}

/* Converts a direction (X, Z) in T to (north, east). */
static inline void goe_motion_turn(const goe_motion_t *motion, const float axis[2], float axis_ne[2]) {
    axis_ne[0] = motion->heading_cos * axis[1] - motion->heading_sin * axis[0];
    axis_ne[1] = motion->heading_sin * axis[1] + motion->heading_cos * axis[0];
}

/* Sets the estimate's reference point relative to the camera at the latest image, if the position is known. */
static inline void goe_motion_relate(const goe_motion_t *motion, goe_estimate_t *estimate) {
    if ((estimate->valid & GOE_HAS_POSITION) != 0u) {
        estimate->x_m = estimate->x0_m - motion->dx_m;
        estimate->z_m = estimate->z0_m - motion->dz_m;
    }
}

#endif
