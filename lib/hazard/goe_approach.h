/* Closest approach of a straight flight to an outline. SPDX-License-Identifier: MIT */
#ifndef GOE_APPROACH_H
#define GOE_APPROACH_H

#include "hazard/goe_outline.h"

/* side[i]: distance by which the course clears the outline on its side i, negative if it crosses. Only one of them can be
 * positive, so that their probabilities add. ahead: along the course, or, of what does not come nearer, from the outline to
 * the camera. */
typedef struct {
    goe_affine_t side[GOE_SIDES], ahead, clearance;
    float tcpa_s, tcpa_sd_s;
    bool moves;
} goe_approach_t;

/* The course of an intent, T axes. */
void goe_approach_course(const goe_motion_t *motion, const goe_intent_t *intent, goe_course_t *course);

/* The side on which the outline is passed, or crossed less deep. */
static inline const goe_affine_t *goe_approach_side(const goe_approach_t *approach) {
    const goe_affine_t *side = approach->side;
    return side[GOE_RIGHT].value > side[GOE_LEFT].value ? &side[GOE_RIGHT] : &side[GOE_LEFT];
}

/* height_m: of the camera over the top now. */
void goe_approach_find(const goe_outline_t *o, const goe_course_t *course, goe_covariance_t covariance, float height_m,
                       goe_approach_t *approach);

#endif
