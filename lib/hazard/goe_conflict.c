/* The conflict probability, and the other fields of goe_hazard_t. SPDX-License-Identifier: MIT */
#include "hazard/goe_conflict.h"

#include <math.h>

#include "goe_guard.h"
#include "hazard/goe_approach.h"
#include "maths/goe_scalar.h"

#if GOE_WITH_HAZARD

#define VELOCITY_MAX_M_S 1.0e3f
#define SINCE_MAX_S 1.0e3f
#define VELOCITY_SD_MAX_M_S 100.0f
#define INTENT_NUMBERS (sizeof(goe_intent_t) / sizeof(float))
#define SIGMA_MIN 1.0e-6f
#define SPEED_MIN_M_S 0.1f
#define AHEAD_MAX_S 60.0f /* longest time for which a velocity counts as constant */

goe_status_t goe_conflict_check(const goe_intent_t *intent) {
    if (!goe_guard_finite(intent->velocity_ned_m_s, INTENT_NUMBERS)) {
        return GOE_NOT_FINITE;
    }
    const bool within = goe_largest_of_three(intent->velocity_ned_m_s) <= goe_magnitude(VELOCITY_MAX_M_S) &&
                        goe_between(intent->margin_m, 0.0f, GOE_DISTANCE_MAX_M) &&
                        goe_between(intent->clearance_m, 0.0f, GOE_DISTANCE_MAX_M) &&
                        goe_between(intent->since_image_s, 0.0f, SINCE_MAX_S) &&
                        goe_between(intent->velocity_sd_m_s, 0.0f, VELOCITY_SD_MAX_M_S);
    return within ? GOE_OK : GOE_OUT_OF_RANGE;
}

/* ------------------------------------------------------------------------------------------- sigmas and probability -- */

static const goe_affine_t *largest(const goe_approach_t *a) {
    const goe_affine_t *side = goe_approach_side(a);
    return a->moves && side->value > a->ahead.value ? side : &a->ahead;
}

/* Probability that the course does not pass the obstacle on one side. Any corner may violate the margin. The likeliest one is not always
 * the nearest: the orientation moves some corners more than others. */
static float side_violation(const goe_outline_t *o, const goe_affine_t *nearest, const goe_xz_t *away, float margin_m,
                            goe_covariance_t covariance) {
    float most = goe_affine_below(nearest, margin_m, covariance);
    for (int i = 0; o->box && i < GOE_CORNERS; i++) {
        goe_affine_t d;
        goe_outline_corner_along(o, away, (i & 1) ? 0.5f : -0.5f, (i & 2) ? 1.0f : 0.0f, &d);
        most = goe_larger(goe_affine_below(&d, margin_m, covariance), most);
    }
    return most;
}

/* The margin is violated only if the course passes on neither side, and the outline is not out of the way along the course. */
static float margin_violation(const goe_outline_t *o, const goe_course_t *course, const goe_approach_t *a,
                              float margin_m, goe_covariance_t covariance) {
    const float out = goe_affine_below(&a->ahead, margin_m, covariance);
    if (!a->moves) {
        return out;
    }
    const float sides = side_violation(o, &a->side[GOE_RIGHT], &course->side[GOE_LEFT], margin_m, covariance) +
                        side_violation(o, &a->side[GOE_LEFT], &course->side[GOE_RIGHT], margin_m, covariance) - 1.0f;
    return sides < 0.0f ? 0.0f : sides < out ? sides : out;
}

/* Probability that two normal variables are both below their limits. Independent: the product. Positively correlated: between the product
 * and the smaller of the two, in proportion; that is at most 0.014 below the truth and at most 0.053 above it. Negatively correlated: the
 * product, which is an upper bound. */
static float both(float p, float q, float correlation) {
    const float independent = p * q;
    const float share = correlation < 0.0f ? 0.0f : correlation > 1.0f ? 1.0f : correlation;
    return independent + share * ((p < q ? p : q) - independent);
}

static void report(const goe_outline_t *o, const goe_course_t *course, const goe_approach_t *a,
                   const goe_intent_t *intent, goe_covariance_t covariance, goe_hazard_t *hazard) {
    const goe_affine_t *miss = largest(a);
    hazard->tcpa_s = goe_bounded(a->tcpa_s);
    hazard->tcpa_sd_s = a->tcpa_sd_s;
    hazard->dcpa_m = miss->value > 0.0f ? goe_bounded(miss->value) : 0.0f;
    hazard->dcpa_sd_m = goe_affine_sigma(miss, covariance);
    hazard->conflict_probability = margin_violation(o, course, a, intent->margin_m, covariance);
    if (hazard->has_clearance) {
        const float sd = goe_affine_sigma(&a->clearance, covariance);
        const float shared = goe_affine_covariance(miss, &a->clearance, covariance);
        const float correlation = shared / goe_larger(hazard->dcpa_sd_m, SIGMA_MIN) / goe_larger(sd, SIGMA_MIN);
        hazard->clearance_m = goe_bounded(a->clearance.value);
        hazard->clearance_sd_m = sd;
        hazard->conflict_probability =
            both(hazard->conflict_probability, goe_affine_below(&a->clearance, intent->clearance_m, covariance),
                 correlation);
    }
}

goe_intent_t goe_conflict_relative(const goe_estimator_t *estimator, const goe_intent_t *intent) {
    goe_intent_t relative = *intent;
    if ((estimator->estimate.valid & GOE_HAS_VELOCITY) != 0u) {
        relative.velocity_ned_m_s[0] -= estimator->estimate.velocity_north_m_s;
        relative.velocity_ned_m_s[1] -= estimator->estimate.velocity_east_m_s;
    }
    return relative;
}

float goe_conflict_ahead_s(const goe_estimator_t *estimator, const goe_intent_t *relative) {
    goe_course_t course;
    const goe_estimate_t *estimate = &estimator->estimate;
    goe_approach_course(&estimator->motion, relative, &course);
    const float ahead_m = estimate->x_m * course.ahead.x + estimate->z_m * course.ahead.z;
    const float ahead_s = ahead_m / goe_larger(course.speed_m_s, SPEED_MIN_M_S);
    return goe_larger(ahead_s < AHEAD_MAX_S ? ahead_s : AHEAD_MAX_S, relative->since_image_s);
}

static float velocity_sd_m_s(const goe_estimator_t *estimator, const goe_intent_t *intent) {
    return intent->velocity_sd_m_s > 0.0f ? intent->velocity_sd_m_s
                                          : estimator->settings.navigation.velocity_bias_sd_m_s;
}

void goe_conflict_add_intent(const goe_estimator_t *estimator, const goe_intent_t *intent, float ahead_s,
                             goe_covariance_t covariance) {
    const float sd_m = velocity_sd_m_s(estimator, intent) * ahead_s;
    covariance[GOE_X0][GOE_X0] += sd_m * sd_m;
    covariance[GOE_Z0][GOE_Z0] += sd_m * sd_m;
    covariance[GOE_HEIGHT][GOE_HEIGHT] += sd_m * sd_m;
}

/* The outline becomes a circle, as near as the obstacle was in the image that gave the estimate, and no nearer later. Its covariance is
 * that of goe_quantities_covariance(). */
static void meet_near_side(const goe_answer_t *answer, goe_model_t model, goe_outline_t *outline) {
    outline->reference.x += goe_bounded(answer->nearer.dx_m);
    outline->reference.z += goe_bounded(answer->nearer.dz_m);
    const float reach_m = goe_bounded(answer->reach_m);
    const bool turns = model == GOE_MODEL_PRISM && reach_m > 0.0f; /* the width is across the first line of sight */
    outline->half = turns ? reach_m : goe_larger(outline->half, reach_m);
}

/* Moves the outline relative to the camera: straight flight for s. */
static void fly_on(const goe_course_t *course, float s, goe_outline_t *outline) {
    outline->reference.x -= course->speed_m_s * s * course->ahead.x;
    outline->reference.z -= course->speed_m_s * s * course->ahead.z;
}

void goe_conflict_foresee(const goe_estimator_t *estimator, const goe_intent_t *intent, goe_covariance_t covariance,
                          goe_hazard_t *hazard) {
    goe_outline_t outline;
    goe_course_t course;
    goe_approach_t approach;
    const goe_estimate_t *estimate = &estimator->estimate;
    const goe_answer_t answer = goe_latest_answer(estimator);
    goe_outline_of(estimate, &outline);
    if (!outline.box) {
        meet_near_side(&answer, estimate->model, &outline);
    }
    goe_approach_course(&estimator->motion, intent, &course);
    fly_on(&course, intent->since_image_s, &outline);
    const float height_m = goe_latest_camera_height(estimator) + course.climb_m_s * intent->since_image_s -
                           (estimate->height_m - answer.height_bias_m); /* of the camera over the top, now */
    goe_approach_find(&outline, &course, covariance, height_m, &approach);
    hazard->has_clearance = (estimate->valid & GOE_HAS_HEIGHT) != 0u;
    report(&outline, &course, &approach, intent, covariance, hazard);
}

#endif
