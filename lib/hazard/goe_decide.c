/* The decision rule: goe_decide(), goe_rule_default(), goe_earliest_tcpa_s(). SPDX-License-Identifier: MIT
 *
 * The README, the examples and the flight layer use this one rule. A failure never means "clear". */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "goe_guard.h"
#include "goe_latest.h"
#include "hazard/goe_conflict.h"
#include "maths/goe_scalar.h"
#include "maths/goe_xz.h"

#if GOE_WITH_HAZARD

#define SURE_SIGMA 2.0f
#define HOVER_M_S 0.1f    /* as for goe_hazard() */
#define SUPERSEDED_S 2.0f /* of detections without a new estimate, after which the old one clears nothing */
#define SHOWN_S 1.0f      /* time without a new estimate after which images no longer show an obstacle */
#define SILENT_S 2.0f     /* after this time without an image nothing is clear: the flight since is not known */
#define TIME_MAX_S 1.0e4f
#define TIME_NUMBERS (offsetof(goe_hazard_t, tcpa_sd_s) / sizeof(float) + 1u) /* up to the sigma of the time */
#define RULE_NUMBERS (sizeof(goe_rule_t) / sizeof(float))
#define DOUBT_MAX 100.0f
#define DRIFT_MAX_M_S 100.0f

static const goe_rule_t by_default = {0.1f, 12.0f, 1.5f, 1.0f};

void goe_rule_default(goe_rule_t *rule) {
    if (rule) {
        *rule = by_default;
    }
}

/* An image measures the inverse of the time, so the bound uses the sigma of the inverse. For a small sigma it is the time minus two sigmas;
 * for a sigma of half the time it is half of the time, and not 0. */
float goe_earliest_tcpa_s(const goe_hazard_t *hazard) {
    const bool finite = hazard && goe_guard_finite(&hazard->tcpa_s, TIME_NUMBERS);
    const float most_s = finite ? hazard->tcpa_s + SURE_SIGMA * hazard->tcpa_sd_s : 0.0f;
    return most_s > 0.0f && hazard->tcpa_s > 0.0f ? hazard->tcpa_s * (hazard->tcpa_s / most_s) : 0.0f;
}

static bool is_rule(const goe_rule_t *rule) {
    return goe_guard_finite(&rule->conflict_probability_max, RULE_NUMBERS) &&
           goe_between(rule->conflict_probability_max, 0.0f, 1.0f) &&
           goe_between(rule->act_within_s, 0.0f, TIME_MAX_S) && goe_between(rule->suspect_factor, 1.0f, DOUBT_MAX) &&
           goe_between(rule->stale_growth_m_s, 0.0f, DRIFT_MAX_M_S);
}

static float enlarged(float distance_m, float factor, float more_m) {
    const float wide_m = factor * distance_m + more_m;
    return wide_m < GOE_DISTANCE_MAX_M ? wide_m : GOE_DISTANCE_MAX_M;
}

/* The intent at a time after the latest image, with both distances enlarged: an estimate that is suspect, or was not updated for a while,
 * may be wrong toward the obstacle. */
static GOE_NOINLINE void widen(const goe_estimator_t *estimator, const goe_intent_t *intent, float since_s,
                               const goe_rule_t *rule, goe_intent_t *wide) {
    const goe_estimate_t *estimate = &estimator->estimate;
    const bool suspect = goe_is_set(&estimate->suspect);
    const float age_s = goe_latest_since_s(estimator, estimator->motion.time_us);
    const float factor = suspect ? rule->suspect_factor : 1.0f;
    const float drift_m = rule->stale_growth_m_s * (age_s + since_s);
    *wide = *intent;
    wide->since_image_s = since_s;
    wide->margin_m = enlarged(intent->margin_m, factor, drift_m);
    wide->clearance_m = enlarged(intent->clearance_m, factor, drift_m);
}

/* Wide sigmas also make the probability small. CLEAR therefore requires that one of the two distances is kept at one sigma. */
static bool is_outside(const goe_hazard_t *hazard, const goe_intent_t *intent) {
    const bool aside = hazard->dcpa_m - hazard->dcpa_sd_m >= intent->margin_m;
    const bool above = hazard->has_clearance && hazard->clearance_m - hazard->clearance_sd_m >= intent->clearance_m;
    return aside || above;
}

/* The own velocity minus that of the obstacle, which is 0 unless valid: north and east. */
static goe_xz_t relative_velocity(const goe_estimate_t *estimate, const goe_intent_t *intent) {
    const goe_xz_t velocity = {intent->velocity_ned_m_s[1] - estimate->velocity_east_m_s,
                               intent->velocity_ned_m_s[0] - estimate->velocity_north_m_s};
    return velocity;
}

#if GOE_WITH_FILTER
/* Filter: whether the obstacle is ahead on the course, within a sigma, and images showed it larger than it can be at this range, or the
 * border may cut it on the side of the course. If it is nearer, it also passes sooner; if it is cut, it may reach the course, and while
 * images show it, even if its visible part is abeam. A hovering aircraft has no course, and the course to the obstacle itself
 * no side: then each end counts. */
static bool may_be_ahead(const goe_estimator_t *estimator, const goe_intent_t *intent) {
    const goe_motion_t *motion = &estimator->motion;
    const goe_answer_t *answer = &estimator->filter.answer;
    const goe_sigma_t *sigma = &estimator->estimate.sigma;
    const goe_xz_t to = {estimator->estimate.x_m, estimator->estimate.z_m};
    const goe_xz_t to_ne = goe_xz_out_of(to, motion->heading_cos, motion->heading_sin);
    const goe_xz_t velocity = relative_velocity(&estimator->estimate, intent);
    const float closing = goe_xz_dot(to_ne, velocity);
    const float right = to_ne.x * velocity.z - to_ne.z * velocity.x; /* of the course; times the speed, as `closing` */
    const float hover = HOVER_M_S * (goe_absolute(to.x) + goe_absolute(to.z));
    const unsigned toward = (right > -hover ? GOE_SIDE_LEFT : 0u) | (right < hover ? GOE_SIDE_RIGHT : 0u);
    const float unsure = goe_larger(sigma->x_m, sigma->z_m) * (goe_absolute(velocity.x) + goe_absolute(velocity.z));
    const bool cut = (answer->cut & toward) != 0u;
    if (closing > -(hover + unsure)) {
        return cut || answer->outgrown_s > 0.0f;
    }
    const bool abeam = goe_absolute(right) > -closing; /* rather than behind */
    return cut && (motion->detected > 1u || (abeam && goe_latest_since_s(estimator, motion->time_us) < SHOWN_S));
}
#endif

/* Whether the estimate is in doubt. Detections came for a while without a new one: the old one may belong to another object. The absence
 * of detections does not count. Filter: the range is that of a class, which may be wrong, and no image has tested it yet; or more than is
 * known may be ahead. */
static bool is_doubted(const goe_estimator_t *estimator, const goe_intent_t *intent) {
    bool superseded = estimator->motion.detected > 1u;
    bool wrong = false;
#if GOE_WITH_FILTER
    if (goe_uses_filter(estimator)) {
        const goe_answer_t *answer = &estimator->filter.answer;
        superseded = superseded || answer->outdated != 0u;
        wrong = answer->by_kind != 0u || may_be_ahead(estimator, intent);
    }
#else
    (void)intent;
#endif
    return wrong || (superseded && goe_latest_since_s(estimator, estimator->motion.time_us) > SUPERSEDED_S);
}

/* Whether the position is known to be wrong: the obstacle moves, and its velocity is not estimated. */
static bool is_misplaced(const goe_estimate_t *estimate) {
    return estimate->reason == GOE_REASON_MOVES && (estimate->valid & GOE_HAS_VELOCITY) == 0u;
}

/* Too little is known for CLEAR between the two bounds of the time, or if the probability is small but neither distance is kept. */
static goe_decision_t decision_of(const goe_hazard_t *met, const goe_intent_t *intent, const goe_rule_t *rule) {
    if (met->conflict_probability < rule->conflict_probability_max) {
        return is_outside(met, intent) ? GOE_DECISION_CLEAR : GOE_DECISION_UNKNOWN;
    }
    if (goe_earliest_tcpa_s(met) <= rule->act_within_s) {
        return GOE_DECISION_ACT;
    }
    return met->tcpa_s - SURE_SIGMA * met->tcpa_sd_s > rule->act_within_s ? GOE_DECISION_CLEAR : GOE_DECISION_UNKNOWN;
}

/* The decision for a widened intent. */
static GOE_NOINLINE goe_decision_t judge(const goe_estimator_t *estimator, const goe_intent_t *wide,
                                         const goe_rule_t *rule, goe_hazard_t *met) {
    const goe_status_t status = goe_hazard(estimator, wide, met);
    if (status != GOE_OK) {
        return status == GOE_CONVERGING ? GOE_DECISION_UNKNOWN : GOE_DECISION_KEEP;
    }
    const goe_decision_t decision = decision_of(met, wide, rule);
    const bool clears =
        wide->since_image_s <= SILENT_S && !is_doubted(estimator, wide) && !is_misplaced(&estimator->estimate);
    return decision == GOE_DECISION_CLEAR && !clears ? GOE_DECISION_UNKNOWN : decision;
}

/* Whether a more severe decision may replace it. */
static bool is_open(goe_decision_t decision) {
    return decision == GOE_DECISION_CLEAR || decision == GOE_DECISION_UNKNOWN;
}

/* Whether the aircraft is too near now, judged as if it were at rest relative to the obstacle. On its course, with the closest approach `met`,
 * it may be near for longer than the rule's time: at a creeping speed, or next to a long wall that the rule clears. The way since the latest
 * image counts as flown toward the obstacle, and a descent at a creeping speed for the rule's time.
 *   speed_m_s  relative to the obstacle
 *   clears     the rule clears the course */
static bool is_too_near(const goe_estimator_t *estimator, const goe_intent_t *wide, const goe_rule_t *rule,
                        float speed_m_s, bool clears, goe_hazard_t *met) {
    const goe_estimate_t *estimate = &estimator->estimate;
    goe_intent_t still = *wide;
    goe_hazard_t now;
    const bool creeps = speed_m_s * rule->act_within_s <= wide->margin_m;
    if (!creeps && !(clears && met->tcpa_s > rule->act_within_s)) {
        return false;
    }
    const float sinks_m_s = creeps ? goe_larger(wide->velocity_ned_m_s[2], 0.0f) : 0.0f;
    still.margin_m = enlarged(wide->margin_m, 1.0f, speed_m_s * wide->since_image_s);
    still.clearance_m = enlarged(wide->clearance_m, 1.0f, sinks_m_s * rule->act_within_s);
    still.velocity_ned_m_s[0] = estimate->velocity_north_m_s;
    still.velocity_ned_m_s[1] = estimate->velocity_east_m_s;
    if (judge(estimator, &still, rule, &now) != GOE_DECISION_ACT) {
        return false;
    }
    *met = now;
    return true;
}

/* The caller may not know that images are refused, and since when. The rule therefore also judges the time of the newest refused image. That
 * time may be wrong: it can only make the decision more severe, and makes no speed creeping. */
static goe_decision_t decide_checked(const goe_estimator_t *estimator, const goe_intent_t *intent,
                                     const goe_rule_t *rule, goe_hazard_t *met) {
    const goe_xz_t velocity = relative_velocity(&estimator->estimate, intent);
    const float speed_m_s = sqrtf(goe_xz_dot(velocity, velocity));
    goe_intent_t wide;
    widen(estimator, intent, intent->since_image_s, rule, &wide);
    goe_decision_t decision = judge(estimator, &wide, rule, met);
    const bool clears = decision == GOE_DECISION_CLEAR;
    const float refused_s = estimator->estimate.age_s;
    if (is_open(decision) && refused_s > intent->since_image_s) {
        goe_hazard_t then;
        goe_intent_t later;
        widen(estimator, intent, refused_s, rule, &later);
        const goe_decision_t refused = judge(estimator, &later, rule, &then);
        if (refused == GOE_DECISION_ACT || (clears && refused != GOE_DECISION_CLEAR)) {
            *met = then;
            decision = refused;
        }
        if (speed_m_s * rule->act_within_s <= intent->margin_m) {
            wide = later;
        }
    }
    return is_open(decision) && is_too_near(estimator, &wide, rule, speed_m_s, clears, met) ? GOE_DECISION_ACT
                                                                                            : decision;
}

goe_decision_t goe_decide(const goe_estimator_t *estimator, const goe_intent_t *intent, const goe_rule_t *rule,
                          goe_hazard_t *hazard) {
    goe_hazard_t met;
    goe_decision_t decision = GOE_DECISION_KEEP;
    memset(&met, 0, sizeof met);
    const goe_rule_t *const used = rule ? rule : &by_default;
    if (estimator && intent && is_rule(used) && goe_conflict_check(intent) == GOE_OK) {
        decision = decide_checked(estimator, intent, used, &met);
    }
    if (hazard) {
        *hazard = met;
    }
    return decision;
}

#endif
