/* Own motion: from the vehicle's pose to the trajectory frame T. SPDX-License-Identifier: MIT */
#ifndef GOE_EGO_MOTION_H
#define GOE_EGO_MOTION_H

#include "goe.h"

/* Takes the pose of an image: fixes T and its origin at the track's first image, compensates a reset of known delta,
 * and sets dx_m, dz_m (displacement of the camera since the first image, T axes).
 * camera_to_trajectory: rotation of this image's rays into T. */
void goe_ego_motion_follow(goe_estimator_t *estimator, const goe_pose_t *pose, float camera_to_trajectory[9]);

/* Whether the autopilot's filter jumped since the image before; the same by an unknown amount. */
static inline bool goe_ego_motion_reset(const goe_estimator_t *estimator, const goe_pose_t *pose) {
    return estimator->started && pose->reset_count != estimator->reset_count;
}

static inline bool goe_ego_motion_lost(const goe_estimator_t *estimator, const goe_pose_t *pose) {
    return goe_ego_motion_reset(estimator, pose) && !pose->reset_delta_known;
}

#endif
