/* The closest approach of a straight flight to an obstacle's outline. SPDX-License-Identifier: MIT */
#ifndef GOE_APPROACH_H
#define GOE_APPROACH_H

#include "hazard/goe_outline.h"

/* side[i]: distance by which the course clears the outline on its side i, negative if it crosses it. Only one of them can be positive, so
 * their probabilities add. ahead: the same along the course, negative if part of the outline is ahead; if the outline does not come nearer,
 * along the direction from the outline to the camera. */
typedef struct {
    goe_affine_t side[GOE_SIDES], ahead, clearance;
    float tcpa_s, tcpa_sd_s;
    bool moves;
} goe_approach_t;

/* Computes the course of an intent, T axes. */
void goe_approach_course(const goe_motion_t *motion, const goe_intent_t *intent, goe_course_t *course);

/* The side on which the course passes the outline, or crosses it less deeply. */
static inline const goe_affine_t *goe_approach_side(const goe_approach_t *approach) {
    const goe_affine_t *side = approach->side;
    return side[GOE_RIGHT].value > side[GOE_LEFT].value ? &side[GOE_RIGHT] : &side[GOE_LEFT];
}

/* height_m: present height of the camera above the top. */
void goe_approach_find(const goe_outline_t *o, const goe_course_t *course, goe_covariance_t covariance, float height_m,
                       goe_approach_t *approach);

#endif
