/* The hazard of every obstacle from now on, and the worst of them. SPDX-License-Identifier: MIT
 *
 * The latest image is some tenths of a second old, half a second at most (goe_flight_table_follow). In this time, a turn bends the path by
 * less than a meter. */
#include "goe_lookout.h"

#include <math.h>

#include "goe_flight_maths.h"
#include "goe_slot.h"

#define URGENCY_PER_S 0.1f /* 10 s of time halve the weight of a violation */
#define ANY_TIME_S 1.0e4f
#define VELOCITY_MAX_M_S 1.0e3f
#define SINCE_MAX_S 1.0e3f
#define RISE_INSIDE 0.4f  /* slope of a probability, per sigma inside the limit: 1 from 1.25 sigma on */
#define RISE_OUTSIDE 0.2f /* the same outside the limit: 0 from 2.5 sigma on */
#define SLOW_M2_S2 0.01f
#define SOON_S 0.01f /* least time to an obstacle ahead */

float goe_flight_lookout_doubt(const goe_flight_t *flight, const goe_flight_slot_t *slot) {
    return slot->suspect ? flight->settings.suspect_factor : 1.0f;
}

float goe_flight_lookout_age_s(const goe_flight_slot_t *slot, uint32_t now_us) {
    return slot->age_s + goe_flight_larger(goe_flight_between_s(now_us, slot->taken_us), 0.0f);
}

float goe_flight_lookout_drift_m(const goe_flight_t *flight, const goe_flight_slot_t *slot, uint32_t now_us) {
    return flight->settings.stale_growth_m_s * goe_flight_lookout_age_s(slot, now_us);
}

/* Probability that a distance is below a limit: two straight lines, at most 0.01 below the normal distribution. */
static float below(float limit_m, float distance_m, float sd_m) {
    const float inside = (limit_m - distance_m) / sd_m;
    return goe_flight_clamped(0.5f + inside * (inside > 0.0f ? RISE_INSIDE : RISE_OUTSIDE), 0.0f, 1.0f);
}

/* Sets the clearance over the kept top at the closest approach, and reduces the conflict probability accordingly. */
static void pass_over(const goe_flight_t *flight, const goe_flight_slot_t *slot, float own_down_m,
                      goe_hazard_t *hazard) {
    const float limit_m = goe_flight_lookout_doubt(flight, slot) * flight->settings.clearance_m;
    hazard->has_clearance = true;
    hazard->clearance_m = slot->ground_down_m - slot->top_m - own_down_m;
    hazard->clearance_sd_m = sqrtf(goe_flight_larger(goe_flight_square(slot->top_sd_m), GOE_FLIGHT_SLOT_SD_MIN_M2));
    hazard->conflict_probability *= below(limit_m, hazard->clearance_m, hazard->clearance_sd_m);
}

/* The hazard of a position that is kept while the estimator has none: from now on, at the velocity of the newest sample. */
static void foresee_kept(const goe_flight_t *flight, const goe_flight_slot_t *slot, const float own_ned_m[3],
                         uint32_t now_us, goe_hazard_t *hazard) {
    const float *v = flight->velocity_ned_m_s;
    const float north_m = slot->center_ne_m[0] - own_ned_m[0];
    const float east_m = slot->center_ne_m[1] - own_ned_m[1];
    const float speed2 = goe_flight_larger(goe_flight_square(v[0]) + goe_flight_square(v[1]), SLOW_M2_S2);
    const float closest_s = goe_flight_clamped((north_m * v[0] + east_m * v[1]) / speed2, 0.0f, ANY_TIME_S);
    const float off_n_m = north_m - closest_s * v[0];
    const float off_e_m = east_m - closest_s * v[1];
    const float radius_m = goe_flight_slot_radius_m(slot);
    const float off_m = sqrtf(goe_flight_square(off_n_m) + goe_flight_square(off_e_m)) - radius_m;
    const float limit_m = goe_flight_lookout_doubt(flight, slot) * flight->settings.margin_m +
                          goe_flight_lookout_drift_m(flight, slot, now_us);
    const float speed_m_s = sqrtf(speed2);
    memset(hazard, 0, sizeof *hazard);
    hazard->tcpa_s = goe_flight_larger(closest_s - radius_m / speed_m_s, closest_s > 0.0f ? SOON_S : 0.0f);
    hazard->tcpa_sd_s = closest_s > 0.0f ? goe_flight_slot_sd_along_m(slot, v[0], v[1]) / speed_m_s : 0.0f;
    hazard->dcpa_m = goe_flight_larger(off_m, 0.0f);
    hazard->dcpa_sd_m = closest_s > 0.0f ? goe_flight_slot_sd_along_m(slot, -v[1], v[0])
                                         : goe_flight_slot_sd_along_m(slot, off_n_m, off_e_m);
    hazard->conflict_probability = below(limit_m, off_m, hazard->dcpa_sd_m);
    if ((slot->valid & GOE_HAS_HEIGHT) != 0u) {
        pass_over(flight, slot, own_ned_m[2] + closest_s * v[2], hazard);
    }
}

static goe_decision_t decide(const goe_flight_t *flight, const goe_flight_slot_t *slot, uint32_t now_us,
                             goe_hazard_t *hazard) {
    const goe_flight_settings_t *settings = &flight->settings;
    const goe_rule_t rule = {settings->conflict_probability_max, ANY_TIME_S, settings->suspect_factor,
                             settings->stale_growth_m_s};
    goe_intent_t intent;
    memset(&intent, 0, sizeof intent);
    intent.margin_m = settings->margin_m;
    intent.clearance_m = settings->clearance_m;
    intent.since_image_s = goe_flight_clamped(goe_flight_between_s(now_us, slot->taken_us), 0.0f, SINCE_MAX_S);
    for (int i = 0; i < 3; i++) {
        intent.velocity_ned_m_s[i] =
            goe_flight_clamped(flight->velocity_ned_m_s[i], -VELOCITY_MAX_M_S, VELOCITY_MAX_M_S);
    }
    return goe_decide(&slot->estimator, &intent, &rule, hazard);
}

/* Computes the hazard by distances and probability. The reaction considers the time that an action takes. */
static void assess(const goe_flight_t *flight, goe_flight_slot_t *slot, const float own_ned_m[3], uint32_t now_us) {
    goe_hazard_t hazard;
    if (!slot->used || !(slot->valid & GOE_HAS_POSITION)) {
        slot->assessed = false;
        memset(&slot->hazard, 0, sizeof slot->hazard);
        return;
    }
    const goe_decision_t decision = decide(flight, slot, now_us, &hazard);
    if (decision == GOE_DECISION_KEEP) { /* the estimator's memory is lost */
        goe_flight_slot_lose(slot);
    }
    if (slot->remembered) {
        foresee_kept(flight, slot, own_ned_m, now_us, &hazard);
    }
    slot->hazard = hazard;
    slot->assessed = true;
}

/* The worst obstacle has the largest. */
static float urgency_of(const goe_flight_slot_t *slot) {
    return slot->hazard.conflict_probability / (1.0f + URGENCY_PER_S * slot->hazard.tcpa_s);
}

int goe_flight_lookout_assess(goe_flight_t *flight, const float own_ned_m[3], uint32_t now_us) {
    int worst = -1;
    float most = -1.0f;
    for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
        goe_flight_slot_t *slot = &flight->slot[i];
        assess(flight, slot, own_ned_m, now_us);
        const float urgency = urgency_of(slot);
        if (slot->assessed && urgency > most) {
            most = urgency;
            worst = i;
        }
    }
    return worst;
}
