/* Time, distances and clearance of the closest approach. SPDX-License-Identifier: MIT */
#include "hazard/goe_approach.h"

#include <math.h>
#include <string.h>

#include "maths/goe_angle.h"
#include "maths/goe_normal.h"
#include "maths/goe_scalar.h"

#if GOE_WITH_HAZARD

#define HOVER_M_S 0.1f /* a slower aircraft counts as hovering */
#define SIGMA_MIN 1.0e-6f

/* ---------------------------------------------------------------------------------------------------------- approach -- */

void goe_approach_course(const goe_motion_t *motion, const goe_intent_t *intent, goe_course_t *course) {
    const float c = motion->heading_cos;
    const float s = motion->heading_sin;
    const float north = intent->velocity_ned_m_s[0];
    const float east = intent->velocity_ned_m_s[1];
    const float speed = sqrtf(north * north + east * east);
    memset(course, 0, sizeof *course);
    course->climb_m_s = -intent->velocity_ned_m_s[2];
    if (speed > HOVER_M_S) {
        course->speed_m_s = speed;
        course->ahead.x = (c * east - s * north) / speed;
        course->ahead.z = (c * north + s * east) / speed;
        course->back = goe_xz_negative(course->ahead);
        course->side[GOE_RIGHT] = goe_outline_right_of(course->ahead);
        course->side[GOE_LEFT] = goe_outline_right_of(course->back);
    }
}

/* Finds the time to the closest approach, and the time at which the clearance counts: over the outline, that of the flight's lower end. For
 * a time of now, value and derivatives are 0. */
static void find_times(const goe_outline_t *o, const goe_course_t *course, goe_covariance_t covariance,
                       const goe_approach_t *approach, goe_affine_t *first, goe_affine_t *lowest) {
    const goe_affine_t *side = approach->side;
    if (side[GOE_RIGHT].value > 0.0f || side[GOE_LEFT].value > 0.0f) {
        goe_outline_along(o, &course->ahead, &course->side[side[GOE_RIGHT].value > 0.0f ? GOE_RIGHT : GOE_LEFT], first);
    } else {
        const float sigma_m = goe_affine_sigma(&side[GOE_RIGHT], covariance);
        goe_outline_end(o, course, -1.0f, sigma_m, first);
        if (course->climb_m_s < 0.0f) {
            goe_outline_end(o, course, 1.0f, sigma_m, lowest);
        }
    }
    if (!(first->value > 0.0f)) {
        memset(first, 0, sizeof *first);
    }
    if (!(lowest->value > 0.0f)) {
        *lowest = *first;
    }
    goe_affine_divide(first, course->speed_m_s);
    goe_affine_divide(lowest, course->speed_m_s);
}

/* Upper bound of the time's sigma: the path meets the outline between its near and its far end. At a grazed edge the derivatives are too
 * large, because the entry jumps from one end to the other. */
static float time_sd_most(const goe_outline_t *o, const goe_course_t *course, goe_covariance_t covariance) {
    goe_affine_t far_end;
    goe_affine_t near_end;
    goe_outline_reach(o, &course->ahead, &far_end);
    goe_outline_reach(o, &course->back, &near_end);
    return (goe_affine_sigma(&near_end, covariance) + 0.5f * (far_end.value + near_end.value)) / course->speed_m_s;
}

/* Variance of the time from an edge that may lean either way from the course, within the sigma of the orientation. If it leans the other
 * way, the closest corner is its other end, provided that the course passes the outline. */
static float edge_variance(const goe_course_t *course, const goe_xz_t *edge, float length_m, float sigma_rad,
                           float passes) {
    const float lean = goe_absolute(goe_xz_dot(*edge, course->side[GOE_RIGHT]));
    const float lead = goe_absolute(goe_xz_dot(*edge, course->ahead));
    const float other = passes * goe_normal_below(-lean / goe_larger(lead * sigma_rad, SIGMA_MIN));
    const float between_s = lead * length_m / course->speed_m_s;
    return other * (1.0f - other) * between_s * between_s;
}

static float time_sd(const goe_outline_t *o, const goe_course_t *course, const goe_approach_t *a,
                     const goe_affine_t *time, goe_covariance_t covariance) {
    float sd = goe_affine_sigma(time, covariance);
    if (!(time->value > 0.0f)) {
        return 0.0f;
    }
    if (o->box) {
        const float sigma_rad = sqrtf(covariance[GOE_ORIENTATION][GOE_ORIENTATION]) * GOE_RAD_PER_DEG;
        const float passes = 1.0f - goe_affine_below(goe_approach_side(a), 0.0f, covariance);
        sd = sqrtf(sd * sd + edge_variance(course, &o->length_axis, o->length, sigma_rad, passes) +
                   edge_variance(course, &o->width_axis, 2.0f * o->half, sigma_rad, passes));
    }
    const float most = time_sd_most(o, course, covariance);
    return goe_bounded(sd < most ? sd : most);
}

/* The clearance at the time `lowest`. `share` scales the derivatives of this time, so that they give its full sigma, time_sd(). */
static void find_clearance(const goe_course_t *course, const goe_affine_t *lowest, float share, float height_m,
                           goe_affine_t *clearance) {
    clearance->value = height_m + course->climb_m_s * lowest->value;
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        clearance->by[i] = course->climb_m_s * share * lowest->by[i];
    }
    clearance->by[GOE_HEIGHT] -= 1.0f;
}

void goe_approach_find(const goe_outline_t *o, const goe_course_t *course, goe_covariance_t covariance, float height_m,
                       goe_approach_t *a) {
    goe_affine_t first;
    goe_affine_t lowest;
    goe_xz_t towards = course->ahead;
    float share = 0.0f;
    memset(a, 0, sizeof *a);
    memset(&lowest, 0, sizeof lowest);
    a->moves = course->speed_m_s > 0.0f;
    if (a->moves) {
        for (int i = 0; i < GOE_SIDES; i++) {
            goe_outline_distance(o, &course->side[i], &a->side[i]);
        }
        find_times(o, course, covariance, a, &first, &lowest);
        a->tcpa_s = first.value;
        a->tcpa_sd_s = time_sd(o, course, a, &first, covariance);
        share =
            time_sd(o, course, a, &lowest, covariance) / goe_larger(goe_affine_sigma(&lowest, covariance), SIGMA_MIN);
    }
    find_clearance(course, &lowest, share, height_m, &a->clearance);
    if (!(a->tcpa_s > 0.0f)) {
        towards = goe_outline_way_from(o, course);
    }
    goe_outline_distance(o, &towards, &a->ahead);
}

#endif
