/* Reaction. SPDX-License-Identifier: MIT
 *
 * A turn of radius R leaves the course by d after sqrt(d (2 R - d)) of it; by no more than R before it is crossed. So an
 * obstacle that needs d < R aside can be passed, and before one that needs more the only way is to turn away. */
#include "goe_reaction.h"

#include <math.h>

#include "goe_flight_maths.h"
#include "goe_lookout.h"
#include "goe_slot.h"

#define GRAVITY_M_S2 9.80665f
#define SURE_SIGMA 2.0f
#define SPEED_MIN_M_S 1.0f
#define TIME_MAX_S 1.0e4f
#define LATE_VIOLATION                                                                                                 \
    0.5f /* where no action comes in time, a hazard that is less likely than not is no reason for one */
#define NOBODY (-1)

/* Everything about one obstacle on a course: right is positive aside. */
typedef struct {
    float course_ne[2], speed_m_s, turn_m; /* turn_m: radius */
    float ahead_m, aside_m;                /* of the centre from the aircraft */
    float keep_m;                          /* distance that the centre is to have, aside */
    float rise_m, top_down_m;              /* to the height that clears the top, and where that is; has_top */
    float soonest_s;
    bool has_top;
} encounter_t;

typedef struct {
    goe_flight_action_t action;
    float needed_s, aside_m; /* of LEFT, RIGHT, HOLD: how far to the right of the present course; else 0 */
} option_t;

void goe_flight_reaction_clear(goe_flight_reaction_t *reaction) {
    memset(reaction, 0, sizeof *reaction);
    reaction->slot = NOBODY;
}

void goe_flight_reaction_shift(goe_flight_reaction_t *reaction, const float jump_ned_m[3]) {
    for (int i = 0; i < 3; i++) {
        reaction->target_ned_m[i] += jump_ned_m[i];
    }
    for (int i = 0; i < 2; i++) {
        reaction->from_ne_m[i] += jump_ned_m[i];
    }
}

/* --------------------------------------------------------------------------------------------------------- encounter -- */

static void relate(const float from_ne_m[2], const float course_ne[2], const float place_ne_m[2], float *ahead_m,
                   float *aside_m) {
    const float north = place_ne_m[0] - from_ne_m[0];
    const float east = place_ne_m[1] - from_ne_m[1];
    *ahead_m = course_ne[0] * north + course_ne[1] * east;
    *aside_m = course_ne[0] * east - course_ne[1] * north;
}

static float aside_sd_m(const goe_flight_slot_t *slot, const float course_ne[2]) {
    const float *covariance = slot->covariance_ne_m2;
    const float c = course_ne[0];
    const float s = course_ne[1];
    const float variance = s * s * covariance[0] - 2.0f * s * c * covariance[1] + c * c * covariance[2];
    return sqrtf(goe_flight_larger(variance, 0.0f));
}

/* False: no course to speak of. */
static bool find_course(const goe_flight_t *flight, encounter_t *e) {
    const float north = flight->velocity_ned_m_s[0];
    const float east = flight->velocity_ned_m_s[1];
    float sine;
    float cosine;
    e->speed_m_s = sqrtf(north * north + east * east);
    if (!(e->speed_m_s > SPEED_MIN_M_S)) {
        return false;
    }
    e->course_ne[0] = north / e->speed_m_s;
    e->course_ne[1] = east / e->speed_m_s;
    goe_flight_sincos_deg(flight->settings.bank_deg, &sine, &cosine);
    e->turn_m = e->speed_m_s * e->speed_m_s * cosine / (GRAVITY_M_S2 * sine);
    return true;
}

static bool meet(const goe_flight_t *flight, const goe_flight_slot_t *slot, const goe_flight_reaction_own_t *own,
                 encounter_t *e) {
    const goe_flight_settings_t *settings = &flight->settings;
    memset(e, 0, sizeof *e);
    if (!find_course(flight, e)) {
        return false;
    }
    const float doubt = goe_flight_lookout_doubt(flight, slot);
    const float drift_m = goe_flight_lookout_drift_m(flight, slot, own->time_us);
    relate(own->ned_m, e->course_ne, slot->center_ne_m, &e->ahead_m, &e->aside_m);
    e->keep_m = goe_flight_slot_radius_m(slot) + doubt * settings->margin_m + drift_m +
                SURE_SIGMA * aside_sd_m(slot, e->course_ne);
    e->has_top = (slot->valid & GOE_HAS_HEIGHT) != 0u;
    e->top_down_m = slot->ground_down_m - slot->top_m - SURE_SIGMA * slot->top_sd_m - doubt * settings->clearance_m;
    e->rise_m = goe_flight_larger(own->ned_m[2] - e->top_down_m, 0.0f);
    e->soonest_s = goe_soonest_s(&slot->hazard);
    return true;
}

/* ----------------------------------------------------------------------------------------------------------- options -- */

/* Whether another obstacle stands on the way past this one. */
static bool is_blocked(const goe_flight_t *flight, const encounter_t *e, int about,
                       const goe_flight_reaction_own_t *own, float aside_m) {
    bool blocked = false;
    for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
        const goe_flight_slot_t *other = &flight->slot[i];
        float ahead_m;
        float other_m;
        relate(own->ned_m, e->course_ne, other->center_ne_m, &ahead_m, &other_m);
        const float reach_m = goe_flight_slot_radius_m(other) + flight->settings.margin_m;
        const bool on_the_way =
            ahead_m > 0.0f && ahead_m < e->ahead_m + e->turn_m && goe_flight_absolute(other_m - aside_m) < reach_m;
        blocked = blocked || (i != about && other->used && other->assessed && on_the_way &&
                              other->hazard.violation > flight->settings.violation_max);
    }
    return blocked;
}

static float turn_time_s(const goe_flight_t *flight, const encounter_t *e, float aside_m) {
    const float d = goe_flight_clamped(aside_m, 0.0f, e->turn_m);
    return flight->settings.roll_in_s + sqrtf(d * (2.0f * e->turn_m - d)) / e->speed_m_s;
}

static float climb_time_s(const goe_flight_t *flight, const encounter_t *e) {
    const float rise_m = e->has_top ? e->rise_m : flight->settings.clearance_m;
    return goe_flight_smaller(flight->settings.climb_in_s + rise_m / flight->settings.climb_m_s, TIME_MAX_S);
}

static void prefer(option_t *best, goe_flight_action_t action, float needed_s, float aside_m) {
    if (best->action == GOE_FLIGHT_NONE || needed_s < best->needed_s) {
        best->action = action;
        best->needed_s = needed_s;
        best->aside_m = aside_m;
    }
}

/* The action that needs the least time of those that pass the obstacle; or to turn away. */
static option_t choose(const goe_flight_t *flight, const encounter_t *e, int about,
                       const goe_flight_reaction_own_t *own) {
    option_t best = {GOE_FLIGHT_NONE, 0.0f, 0.0f};
    const float right_m = e->aside_m + e->keep_m; /* where to be, from the present course */
    const float left_m = e->aside_m - e->keep_m;
    const float climb_s = climb_time_s(flight, e);
    if (own->approach && climb_s <= e->soonest_s) {
        prefer(&best, GOE_FLIGHT_GO_AROUND, climb_s, 0.0f);
        return best;
    }
    if (right_m < e->turn_m && !is_blocked(flight, e, about, own, right_m)) {
        prefer(&best, GOE_FLIGHT_RIGHT, turn_time_s(flight, e, right_m), right_m);
    }
    if (-left_m < e->turn_m && !is_blocked(flight, e, about, own, left_m)) {
        prefer(&best, GOE_FLIGHT_LEFT, turn_time_s(flight, e, -left_m), left_m);
    }
    if (e->has_top && climb_s <= e->soonest_s) {
        prefer(&best, own->approach ? GOE_FLIGHT_GO_AROUND : GOE_FLIGHT_CLIMB, climb_s, 0.0f);
    }
    if (best.action == GOE_FLIGHT_NONE) {
        const float away_m = 2.0f * e->turn_m + flight->settings.loiter_m;
        prefer(&best, GOE_FLIGHT_HOLD, turn_time_s(flight, e, e->turn_m), e->aside_m > 0.0f ? -away_m : away_m);
    }
    return best;
}

/* ------------------------------------------------------------------------------------------------------------- order -- */

/* Where an order flies to: of a side the point abeam of the obstacle's middle, of HOLD the one abeam of the aircraft. */
static void aim(const goe_flight_t *flight, const encounter_t *e, const option_t *option,
                const goe_flight_reaction_own_t *own, float target_ned_m[3]) {
    const bool hold = option->action == GOE_FLIGHT_HOLD;
    const bool aside = option->action == GOE_FLIGHT_LEFT || option->action == GOE_FLIGHT_RIGHT;
    const float loiter_m = option->action == GOE_FLIGHT_LEFT ? -flight->settings.loiter_m : flight->settings.loiter_m;
    const float right_m = option->aside_m + (aside ? loiter_m : 0.0f);
    const float ahead_m = hold ? 0.0f : e->ahead_m;
    target_ned_m[0] = own->ned_m[0] + e->course_ne[0] * ahead_m - e->course_ne[1] * right_m;
    target_ned_m[1] = own->ned_m[1] + e->course_ne[1] * ahead_m + e->course_ne[0] * right_m;
    target_ned_m[2] = aside || hold || !e->has_top ? own->ned_m[2] : goe_flight_smaller(e->top_down_m, own->ned_m[2]);
}

static void order(goe_flight_t *flight, int slot, const encounter_t *e, const option_t *option,
                  const goe_flight_reaction_own_t *own) {
    goe_flight_reaction_t *r = &flight->reaction;
    if (r->action == GOE_FLIGHT_NONE) { /* another order keeps the line of the first */
        memcpy(r->from_ne_m, own->ned_m, sizeof r->from_ne_m);
        memcpy(r->course_ne, e->course_ne, sizeof r->course_ne);
    }
    aim(flight, e, option, own, r->target_ned_m);
    r->action = (uint8_t)option->action;
    r->late = option->needed_s > e->soonest_s;
    r->slot = (int8_t)slot;
    r->rising = r->falling = false;
}

/* Whether the hazard has stood for long enough; one that leaves no time needs none. */
static bool is_due(goe_flight_reaction_t *r, const goe_flight_settings_t *settings, const encounter_t *e,
                   float needed_s, bool is_hazard, uint32_t now_us) {
    if (!is_hazard || e->soonest_s > needed_s + settings->reserve_s) {
        r->rising = false;
        return false;
    }
    r->rising_us = r->rising ? r->rising_us : now_us;
    r->rising = true;
    return e->soonest_s <= needed_s || goe_flight_between_s(now_us, r->rising_us) >= settings->confirm_s;
}

/* A side keeps to its side: the point moves with the estimate, along the line of the order. */
static void follow(goe_flight_t *flight, const goe_flight_slot_t *slot, const goe_flight_reaction_own_t *own) {
    goe_flight_reaction_t *r = &flight->reaction;
    encounter_t e;
    float ahead_m;
    float aside_m;
    if ((r->action != GOE_FLIGHT_LEFT && r->action != GOE_FLIGHT_RIGHT) || !meet(flight, slot, own, &e)) {
        return;
    }
    const float loiter_m = flight->settings.loiter_m;
    relate(r->from_ne_m, r->course_ne, slot->center_ne_m, &ahead_m, &aside_m);
    const float right_m = r->action == GOE_FLIGHT_RIGHT ? aside_m + e.keep_m + loiter_m : aside_m - e.keep_m - loiter_m;
    r->target_ned_m[0] = r->from_ne_m[0] + r->course_ne[0] * ahead_m - r->course_ne[1] * right_m;
    r->target_ned_m[1] = r->from_ne_m[1] + r->course_ne[1] * ahead_m + r->course_ne[0] * right_m;
}

/* Whether the line of the order may be flown again: the obstacle lies behind on it, or surely aside of it; or is unknown. */
static bool is_over(const goe_flight_t *flight, const goe_flight_reaction_own_t *own, bool *behind) {
    const goe_flight_reaction_t *r = &flight->reaction;
    const goe_flight_slot_t *slot = r->slot == NOBODY ? NULL : &flight->slot[r->slot];
    float ahead_m;
    float aside_m;
    *behind = false;
    if (!slot || !slot->used || !slot->assessed) {
        return true;
    }
    const float reach_m = goe_flight_slot_radius_m(slot) + flight->settings.margin_m;
    relate(own->ned_m, r->course_ne, slot->center_ne_m, &ahead_m, &aside_m);
    *behind = ahead_m < -reach_m;
    relate(r->from_ne_m, r->course_ne, slot->center_ne_m, &ahead_m, &aside_m);
    return *behind || goe_flight_absolute(aside_m) > reach_m + SURE_SIGMA * aside_sd_m(slot, r->course_ne);
}

static void end_if_over(goe_flight_t *flight, const goe_flight_reaction_own_t *own) {
    goe_flight_reaction_t *r = &flight->reaction;
    bool behind;
    if (!is_over(flight, own, &behind)) {
        r->falling = false;
        follow(flight, &flight->slot[r->slot], own);
        return;
    }
    r->falling_us = r->falling ? r->falling_us : own->time_us;
    r->falling = true;
    if (behind || goe_flight_between_s(own->time_us, r->falling_us) >= flight->settings.hold_s) {
        goe_flight_reaction_clear(r);
    }
}

/* Of an approach that was left to a side, as no climb seemed to come in time: once one does, it is broken off. Whoever lands beside an
 * obstacle lands beside the runway. */
static void break_off(goe_flight_t *flight, const goe_flight_reaction_own_t *own) {
    const goe_flight_reaction_t *r = &flight->reaction;
    encounter_t e;
    if (!own->approach || r->action == GOE_FLIGHT_NONE || r->action == GOE_FLIGHT_GO_AROUND || r->slot == NOBODY ||
        !meet(flight, &flight->slot[r->slot], own, &e)) {
        return;
    }
    const option_t option = {GOE_FLIGHT_GO_AROUND, climb_time_s(flight, &e), 0.0f};
    if (option.needed_s <= e.soonest_s) {
        order(flight, r->slot, &e, &option, own);
    }
}

/* An order that there is not, or about no slot that there is, is none: the hazard that stands brings another. */
static void mend(goe_flight_reaction_t *r) {
    if (r->action > GOE_FLIGHT_HOLD || r->slot < NOBODY || r->slot >= GOE_FLIGHT_SLOTS) {
        goe_flight_reaction_clear(r);
    }
}

float goe_flight_reaction_decide(goe_flight_t *flight, int worst, const goe_flight_reaction_own_t *own) {
    goe_flight_reaction_t *r = &flight->reaction;
    encounter_t e;
    mend(r);
    if (r->action != GOE_FLIGHT_NONE) {
        end_if_over(flight, own);
        break_off(flight, own);
    }
    if (worst == NOBODY || !meet(flight, &flight->slot[worst], own, &e)) {
        r->rising = false;
        return 0.0f;
    }
    const option_t option = choose(flight, &e, worst, own);
    const float most = option.needed_s > e.soonest_s ? goe_flight_larger(LATE_VIOLATION, flight->settings.violation_max)
                                                     : flight->settings.violation_max;
    const bool is_hazard = flight->slot[worst].hazard.violation >= most && e.ahead_m > 0.0f;
    const bool is_new = r->action == GOE_FLIGHT_NONE || r->slot != worst;
    if (is_due(r, &flight->settings, &e, option.needed_s, is_hazard && is_new, own->time_us)) {
        order(flight, worst, &e, &option, own);
    }
    return option.needed_s;
}
