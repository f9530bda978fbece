/* Hazards from now. SPDX-License-Identifier: MIT
 *
 * The latest image is some tenths of a second old. What a turn has bent of the path since, in half a second at the longest
 * (goe_flight_table_follow), is less than a metre. */
#include "goe_lookout.h"

#include "goe_flight_maths.h"
#include "goe_slot.h"

#define URGENCY_PER_S 0.1f /* 10 s of time halve the weight of a violation */
#define DISTANCE_MAX_M 1.0e4f
#define VELOCITY_MAX_M_S 1.0e3f
#define SINCE_MAX_S 1.0e3f

float goe_flight_lookout_doubt(const goe_flight_t *flight, const goe_flight_slot_t *slot) {
    return slot->suspect ? flight->settings.doubt : 1.0f;
}

float goe_flight_lookout_age_s(const goe_flight_slot_t *slot, uint32_t now_us) {
    return slot->age_s + goe_flight_larger(goe_flight_between_s(now_us, slot->taken_us), 0.0f);
}

/* What is older than an image that comes in time. */
float goe_flight_lookout_drift_m(const goe_flight_t *flight, const goe_flight_slot_t *slot, uint32_t now_us) {
    const float old_s = goe_flight_lookout_age_s(slot, now_us) - flight->settings.delay_max_s;
    return flight->settings.drift_m_s * goe_flight_larger(old_s, 0.0f);
}

/* The hazard as it was, nearer by what has passed. */
static void count_down(const goe_flight_t *flight, goe_flight_slot_t *slot, uint32_t now_us) {
    const float passed_s = goe_flight_larger(goe_flight_between_s(now_us, flight->assessed_us), 0.0f);
    slot->hazard.time_s = goe_flight_larger(slot->hazard.time_s - passed_s, 0.0f);
}

static void assess(const goe_flight_t *flight, goe_flight_slot_t *slot, uint32_t now_us) {
    goe_plan_t plan;
    goe_hazard_t hazard;
    const float doubt = goe_flight_lookout_doubt(flight, slot);
    const float drift_m = goe_flight_lookout_drift_m(flight, slot, now_us);
    plan.margin_m = goe_flight_smaller(doubt * flight->settings.margin_m + drift_m, DISTANCE_MAX_M);
    plan.clearance_m = goe_flight_smaller(doubt * flight->settings.clearance_m + drift_m, DISTANCE_MAX_M);
    plan.since_image_s = goe_flight_clamped(goe_flight_between_s(now_us, slot->taken_us), 0.0f, SINCE_MAX_S);
    for (int i = 0; i < 3; i++) {
        plan.velocity_ned_m_s[i] = goe_flight_clamped(flight->velocity_ned_m_s[i], -VELOCITY_MAX_M_S, VELOCITY_MAX_M_S);
    }
    const bool placed = slot->used && (slot->valid & GOE_HAS_POSITION) != 0u;
    const goe_status_t status = placed ? goe_hazard(&slot->estimator, &plan, &hazard) : GOE_COLLECTING;
    if (placed && (status == GOE_CORRUPTED || status == GOE_NOT_INITIALISED)) {
        goe_flight_slot_lose(slot);
    }
    if (placed && slot->remembered && status != GOE_OK) {
        count_down(flight, slot, now_us);
        return;
    }
    slot->assessed = status == GOE_OK;
    memset(&slot->hazard, 0, sizeof slot->hazard);
    if (slot->assessed) {
        slot->hazard = hazard;
    }
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
