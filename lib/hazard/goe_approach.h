/* Closest approach of a straight flight to an outline. SPDX-License-Identifier: MIT */
#ifndef GOE_APPROACH_H
#define GOE_APPROACH_H

#include "hazard/goe_outline.h"

/* left, right: signed distances if the obstacle is passed with it on the left, on the right; these exclude each other, so that
 * their probabilities add. ahead: along the course, or, of what does not come nearer, from the outline to the camera. */
typedef struct {
    goe_affine_t left, right, ahead;
    goe_affine_t clearance;
    float time_s, time_sd_s;
    bool moves;
} goe_approach_t;

/* The course of a plan, T axes. */
goe_course_t goe_approach_course(const goe_motion_t *motion, const goe_plan_t *plan);

/* height_m: of the camera over the top now. */
void goe_approach_find(const goe_outline_t *o, const goe_course_t *course, goe_covariance_t covariance, float height_m,
                       goe_approach_t *approach);

#endif
