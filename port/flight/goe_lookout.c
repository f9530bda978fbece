/* Hazards from now. SPDX-License-Identifier: MIT
 *
 * The latest image is some tenths of a second old. What a turn has bent of the path since, in half a second at the longest
 * (goe_flight_table_follow), is less than a metre. */
#include "goe_lookout.h"

#include "goe_flight_maths.h"
#include "goe_slot.h"

#define URGENCY_PER_S 0.1f /* 10 s of time halve the weight of a violation */
#define ANY_TIME_S 1.0e4f
#define VELOCITY_MAX_M_S 1.0e3f
#define SINCE_MAX_S 1.0e3f

float goe_flight_lookout_doubt(const goe_flight_t *flight, const goe_flight_slot_t *slot) {
    return slot->suspect ? flight->settings.doubt : 1.0f;
}

float goe_flight_lookout_age_s(const goe_flight_slot_t *slot, uint32_t now_us) {
    return slot->age_s + goe_flight_larger(goe_flight_between_s(now_us, slot->taken_us), 0.0f);
}

float goe_flight_lookout_drift_m(const goe_flight_t *flight, const goe_flight_slot_t *slot, uint32_t now_us) {
    return flight->settings.drift_m_s * goe_flight_lookout_age_s(slot, now_us);
}

/* The hazard as it was, nearer by what has passed. */
static void count_down(const goe_flight_t *flight, goe_flight_slot_t *slot, uint32_t now_us) {
    const float passed_s = goe_flight_larger(goe_flight_between_s(now_us, flight->assessed_us), 0.0f);
    slot->hazard.time_s = goe_flight_larger(slot->hazard.time_s - passed_s, 0.0f);
}

static goe_decision_t decide(const goe_flight_t *flight, const goe_flight_slot_t *slot, uint32_t now_us,
                             goe_hazard_t *hazard) {
    const goe_flight_settings_t *settings = &flight->settings;
    const goe_rule_t rule = {settings->violation_max, ANY_TIME_S, settings->doubt, settings->drift_m_s};
    goe_plan_t plan;
    memset(&plan, 0, sizeof plan);
    plan.margin_m = settings->margin_m;
    plan.clearance_m = settings->clearance_m;
    plan.since_image_s = goe_flight_clamped(goe_flight_between_s(now_us, slot->taken_us), 0.0f, SINCE_MAX_S);
    for (int i = 0; i < 3; i++) {
        plan.velocity_ned_m_s[i] = goe_flight_clamped(flight->velocity_ned_m_s[i], -VELOCITY_MAX_M_S, VELOCITY_MAX_M_S);
    }
    return goe_decide(&slot->estimator, &plan, &rule, hazard);
}

/* The time that an action takes is for the reaction to know; here the rule's distances and probability count. */
static void assess(const goe_flight_t *flight, goe_flight_slot_t *slot, uint32_t now_us) {
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
        count_down(flight, slot, now_us);
        return;
    }
    slot->hazard = hazard;
    slot->assessed = true;
}

int goe_flight_lookout_assess(goe_flight_t *flight, uint32_t now_us) {
    int worst = -1;
    float most = -1.0f;
    for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
        goe_flight_slot_t *slot = &flight->slot[i];
        assess(flight, slot, now_us);
        const float urgency = slot->hazard.violation / (1.0f + URGENCY_PER_S * slot->hazard.time_s);
        if (slot->assessed && urgency > most) {
            most = urgency;
            worst = i;
        }
    }
    return worst;
}
