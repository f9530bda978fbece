/* The order: its choice against the worst obstacle, its review and its end. SPDX-License-Identifier: MIT
 *
 * A turn of radius R leaves the course by d after sqrt(d (2 R - d)) along it, and by at most R before it heads across the course. So the
 * aircraft can pass an obstacle that needs d < R to the side; before one that needs more, it can only turn away.
 *
 * A side is a target next to the course: past the outline of the present obstacle; or farther out, past that of another one; or in the
 * middle of the gap between the two. goe_clear.c computes the clear fraction of the path to each of them. */
#include "goe_reaction.h"

#include <math.h>

#include "goe_clear.h"
#include "goe_flight_maths.h"
#include "goe_lookout.h"
#include "goe_slot.h"

#define GRAVITY_M_S2 9.80665f
#define SURE_SIGMA 2.0f
#define LIKELY_SIGMA 1.0f /* an active order is replaced only if another one is likely to be better */
#define TIME_MAX_S 1.0e4f
#define CLEAR_MAX_M 1000.0f
#define LATE_VIOLATION                                                                                                 \
    0.5f           /* least conflict probability that causes an order if no action comes in time: likelier than not */
#define ATTEMPTS 3 /* number of hazards against which an assessment looks for an order */
#define NOBODY (-1)
#define TO_LEFT (-1)
#define TO_RIGHT 1

/* Fractions of the margin. */
#define FREE 0.75f     /* a path with this fraction is clear: an aircraft cuts the corner on the way to its target */
#define HOLD_FREE 0.5f /* the same for HOLD, which is for the case that no side is clear */
#define KEPT 0.33f     /* below this fraction, a better target replaces the present one */
#define GAIN 0.2f      /* by which the better one must exceed it */
#define NEVER (-2.0f * GOE_FLIGHT_CLEAR_MAX)

#define PAST_M 10.0f     /* of a climb's target beyond the place where the obstacle is passed */
#define CLIMB_SLACK 0.5f /* of the clearance: a climb that lacks less than this is not replaced */

#define REMEMBERED_S 10.0f
#define LONG_US 600000000 /* ten minutes: longer than any time that counts */
#define LATEST 1.2f       /* of roll_in_s: the latest time at which an autopilot obeys */
#define TURNED 0.99f      /* cosine of 8 degrees: after such a turn the aircraft obeys */
#define EARLY 0.33f       /* of roll_in_s: the earliest time at which an autopilot obeys */
#define WHOLE 0.9f        /* a larger fraction makes no path better */
#define SHARE_S 4.0f      /* s: value of a whole margin, between clear paths */
#define SAME_SIDE_S 0.5f  /* s: value of the side that was ordered before */

/* One obstacle relative to the course. Aside is positive to the right. */
typedef struct {
    float ahead_m, aside_m;   /* of the center, from the aircraft */
    float keep_m;             /* required lateral distance of the center */
    float rise_m, top_down_m; /* climb to the height that clears the top, and its down; if has_top */
    float earliest_tcpa_s;
    bool has_top;
} encounter_t;

/* The scene of the decision: the aircraft on its course, and every obstacle in the frame of this course. */
typedef struct {
    const goe_flight_t *flight;
    const goe_flight_reaction_own_t *own;
    goe_flight_clear_own_t at;
    goe_flight_clear_slot_t slot[GOE_FLIGHT_SLOTS];
    float speed_m_s;
    float circle_m;  /* radius of the circle around a target; 0: the aircraft flies through it */
    float line_m[2]; /* direction of the order line, or of the course */
    bool has_course; /* false: the aircraft is too slow, and the order line replaces the course */
} look_t;

typedef struct {
    goe_flight_action_t action;
    float needed_s, cost_s;
    float share;                /* least clear fraction of the path; of a climb 1, or 0 over a top that is not known */
    goe_flight_clear_way_t way; /* path to a side, or of HOLD */
    float down_m;               /* of the target */
    int8_t edge, side;
    bool gap; /* the target is between the obstacle and `edge` */
} option_t;

void goe_flight_reaction_clear(goe_flight_reaction_t *reaction) {
    memset(reaction, 0, sizeof *reaction);
    reaction->slot = reaction->edge = NOBODY;
}

void goe_flight_reaction_shift(goe_flight_reaction_t *reaction, const float jump_ned_m[3]) {
    for (int i = 0; i < 3; i++) {
        reaction->target_ned_m[i] += jump_ned_m[i];
        reaction->from_ned_m[i] += jump_ned_m[i];
    }
}

/* --------------------------------------------------------------------------------------------------------- encounter -- */

static bool is_aside(unsigned action) { return action == GOE_FLIGHT_LEFT || action == GOE_FLIGHT_RIGHT; }
static bool is_up(unsigned action) { return action == GOE_FLIGHT_CLIMB || action == GOE_FLIGHT_GO_AROUND; }
static float times(int side, float aside_m) { return side == TO_LEFT ? -aside_m : aside_m; }

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

/* Sets the distance straight on until the aircraft obeys an order that was given since_s ago. */
static void set_delay(look_t *look, float since_s) {
    const float roll_in_s = look->flight->settings.roll_in_s;
    look->at.early_m = look->speed_m_s * goe_flight_larger(EARLY * roll_in_s - since_s, 0.0f);
    look->at.late_m = look->speed_m_s * goe_flight_larger(LATEST * roll_in_s - since_s, EARLY * roll_in_s);
}

/* Sets course and speed. A slow aircraft with an order has the course of the order line, and the least speed. Returns false if there is no
 * course. */
static bool set_course(const goe_flight_t *flight, look_t *look) {
    const float north = flight->velocity_ned_m_s[0];
    const float east = flight->velocity_ned_m_s[1];
    const float speed_m_s = sqrtf(north * north + east * east);
    look->has_course = speed_m_s > GOE_FLIGHT_COURSE_MIN_M_S;
    look->speed_m_s = look->has_course ? speed_m_s : GOE_FLIGHT_COURSE_MIN_M_S;
    look->at.course_ne[0] = look->has_course ? north / speed_m_s : flight->reaction.course_ne[0];
    look->at.course_ne[1] = look->has_course ? east / speed_m_s : flight->reaction.course_ne[1];
    return look->has_course || flight->reaction.action != GOE_FLIGHT_NONE;
}

/* Returns false if there is no course. */
static bool look_around(const goe_flight_t *flight, const goe_flight_reaction_own_t *own, look_t *look) {
    float sine;
    float cosine;
    if (!set_course(flight, look)) {
        return false;
    }
    const float speed_m_s = look->speed_m_s;
    goe_flight_sincos_deg(flight->settings.bank_deg, &sine, &cosine);
    look->flight = flight;
    look->own = own;
    memcpy(look->at.ned_m, own->ned_m, sizeof look->at.ned_m);
    look->at.turn_m = speed_m_s * speed_m_s * cosine / (GRAVITY_M_S2 * sine);
    look->at.through_m = look->at.turn_m + speed_m_s * (flight->settings.roll_in_s + flight->settings.reserve_s);
    look->at.time_us = own->time_us;
    look->circle_m =
        flight->settings.loiter_m > 0.0f ? goe_flight_larger(flight->settings.loiter_m, look->at.turn_m) : 0.0f;
    set_delay(look, 0.0f);
    goe_flight_clear_direct(
        &look->at, flight->reaction.action == GOE_FLIGHT_NONE ? look->at.course_ne : flight->reaction.course_ne,
        look->line_m);
    goe_flight_clear_slots(flight, &look->at, look->slot);
    return true;
}

static void meet(const look_t *look, int i, encounter_t *e) {
    const goe_flight_slot_t *slot = &look->flight->slot[i];
    const goe_flight_settings_t *settings = &look->flight->settings;
    const float doubt = goe_flight_lookout_doubt(look->flight, slot);
    const float drift_m = goe_flight_lookout_drift_m(look->flight, slot, look->own->time_us);
    relate(look->own->ned_m, look->at.course_ne, slot->center_ne_m, &e->ahead_m, &e->aside_m);
    e->keep_m = goe_flight_slot_radius_m(slot) + doubt * settings->margin_m + drift_m +
                SURE_SIGMA * aside_sd_m(slot, look->at.course_ne);
    e->has_top = (slot->valid & GOE_HAS_HEIGHT) != 0u;
    e->top_down_m = slot->ground_down_m - slot->top_m - SURE_SIGMA * slot->top_sd_m - doubt * settings->clearance_m;
    e->rise_m = goe_flight_larger(look->own->ned_m[2] - e->top_down_m, 0.0f);
    e->earliest_tcpa_s = goe_earliest_tcpa_s(&slot->hazard);
}

/* ----------------------------------------------------------------------------------------------------------- options -- */

static float turn_time_s(const look_t *look, float aside_m) {
    const float turn_m = look->at.turn_m;
    const float d = goe_flight_clamped(aside_m, 0.0f, turn_m);
    return look->flight->settings.roll_in_s + sqrtf(d * (2.0f * turn_m - d)) / look->speed_m_s;
}

static float climb_time_s(const look_t *look, float rise_m) {
    const goe_flight_settings_t *settings = &look->flight->settings;
    return goe_flight_smaller(settings->climb_in_s + rise_m / settings->climb_m_s, TIME_MAX_S);
}

/* The climb that is left. Over a top that is not known, it ends at the clearance over the height at which the climb began. */
static float rise_of(const look_t *look, const encounter_t *e) {
    const goe_flight_reaction_t *r = &look->flight->reaction;
    const float climbed_m = is_up(r->action) ? r->from_ned_m[2] - look->own->ned_m[2] : 0.0f;
    return e->has_top ? e->rise_m : goe_flight_larger(look->flight->settings.clearance_m - climbed_m, 0.0f);
}

/* Compares two paths: of clear ones, that of the lower cost is better; otherwise the clearer one. */
static bool is_better(const option_t *a, const option_t *b) {
    const bool a_is_free = a->share >= FREE;
    const bool b_is_free = b->share >= FREE;
    if (a_is_free && b_is_free) {
        return a->cost_s < b->cost_s;
    }
    return a->share > b->share;
}

static void prefer(option_t *best, const option_t *option) {
    if (best->action == GOE_FLIGHT_NONE || is_better(option, best)) {
        *best = *option;
    }
}

static bool is_on_course(const encounter_t *e) {
    return e->ahead_m > 0.0f && goe_flight_absolute(e->aside_m) < e->keep_m;
}

/* Tries a climb straight on. It must clear everything in the way: up to the highest top, and each top in time. On approach it may also
 * lead over a top that is not known; nothing then shows that it clears this top. */
static void try_climb(const look_t *look, int about, const encounter_t *e, option_t *best) {
    option_t option;
    const bool approach = look->own->approach;
    float rise_m = rise_of(look, e);
    bool possible = (e->has_top || approach) && climb_time_s(look, rise_m) <= e->earliest_tcpa_s;
    bool blind = !e->has_top;
    for (int i = 0; i < GOE_FLIGHT_SLOTS && possible; i++) {
        encounter_t other;
        if (i == about || !look->slot[i].counts) {
            continue;
        }
        meet(look, i, &other);
        if (!is_on_course(&other)) {
            continue;
        }
        if (other.has_top) {
            rise_m = goe_flight_larger(rise_m, other.rise_m);
        }
        if (other.ahead_m < e->ahead_m + 2.0f * look->at.turn_m) {
            const float there_s = goe_flight_larger(other.ahead_m - look->slot[i].radius_m, 0.0f) / look->speed_m_s;
            rise_m = goe_flight_larger(rise_m, rise_of(look, &other));
            possible = (other.has_top || approach) && climb_time_s(look, rise_of(look, &other)) <= there_s;
            blind = blind || !other.has_top;
        }
    }
    if (possible) {
        memset(&option, 0, sizeof option);
        option.action = approach ? GOE_FLIGHT_GO_AROUND : GOE_FLIGHT_CLIMB;
        option.needed_s = option.cost_s = climb_time_s(look, rise_of(look, e));
        option.share = blind ? 0.0f : 1.0f;
        option.down_m = look->own->ned_m[2] - rise_m;
        option.edge = NOBODY;
        prefer(best, &option);
    }
}

/* Tries the path that keeps aside_m to the right of the present course, abeam of the obstacle. */
static void try_target(const look_t *look, const encounter_t *e, int side, float aside_m, int edge, bool gap,
                       option_t *best) {
    option_t option;
    int nearest;
    memset(&option, 0, sizeof option);
    option.action = side == TO_LEFT ? GOE_FLIGHT_LEFT : GOE_FLIGHT_RIGHT;
    option.needed_s = turn_time_s(look, times(side, aside_m));
    option.way.target_m[0] = e->ahead_m;
    option.way.target_m[1] = aside_m + times(side, look->circle_m);
    option.way.circle_m = look->circle_m;
    option.way.sigmas = SURE_SIGMA;
    memcpy(option.way.line_m, look->line_m, sizeof option.way.line_m);
    option.way.shifts = true;
    option.down_m = look->own->ned_m[2];
    option.edge = (int8_t)edge;
    option.gap = gap;
    option.side = (int8_t)side;
    const float enough = best->share < FREE ? best->share : FREE;
    option.share = goe_flight_clear_share(&look->at, look->slot, &option.way, enough, &nearest);
    const bool same_side = look->flight->reaction.side == option.side;
    option.cost_s = option.needed_s + SHARE_S * (WHOLE - goe_flight_smaller(option.share, WHOLE)) -
                    (same_side ? SAME_SIDE_S : 0.0f);
    prefer(best, &option);
}

/* Tries the paths of a side: past this obstacle's outline; farther out, past that of another; between the two. */
static void try_side(const look_t *look, int about, const encounter_t *e, int side, option_t *best) {
    const float base_m = e->aside_m + times(side, e->keep_m);
    const float wall_m = e->aside_m + times(side, look->slot[about].radius_m);
    if (!(times(side, base_m) < look->at.turn_m)) {
        return;
    }
    try_target(look, e, side, base_m, about, false, best);
    for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
        const goe_flight_clear_slot_t *other = &look->slot[i];
        const float beyond_m = other->at_m[0] - e->ahead_m;
        if (i == about || !other->counts || !(other->at_m[0] > -look->at.turn_m) ||
            !(beyond_m < 2.0f * look->at.turn_m)) {
            continue;
        }
        const float keep_m =
            other->radius_m + other->margin_m + SURE_SIGMA * sqrtf(goe_flight_larger(other->variance_m2[2], 0.0f));
        const float edge_m = other->at_m[1] + times(side, keep_m);
        const float inner_m = other->at_m[1] - times(side, other->radius_m);
        const float middle_m = 0.5f * (wall_m + inner_m);
        if (times(side, edge_m - base_m) > 0.0f) {
            try_target(look, e, side, edge_m, i, false, best);
        }
        if (times(side, inner_m - wall_m) > 0.0f && times(side, base_m - middle_m) > 0.0f) {
            try_target(look, e, side, middle_m, i, true, best);
        }
    }
}

/* Tries to turn away and circle: around a point abeam, or at once. */
static void try_hold(const look_t *look, int side, option_t *best) {
    const float circle_m = goe_flight_larger(look->flight->settings.loiter_m, look->at.turn_m);
    for (int at_once = 0; at_once < 2; at_once++) {
        option_t option;
        int nearest;
        memset(&option, 0, sizeof option);
        option.action = GOE_FLIGHT_HOLD;
        option.needed_s = option.cost_s = turn_time_s(look, look->at.turn_m);
        option.way.target_m[0] = at_once ? look->at.late_m : 0.0f;
        option.way.target_m[1] =
            times(side, at_once ? circle_m : 2.0f * look->at.turn_m + look->flight->settings.loiter_m);
        option.way.circle_m = circle_m;
        option.way.sigmas = SURE_SIGMA;
        option.way.turns_away = true;
        option.down_m = look->own->ned_m[2];
        option.edge = NOBODY;
        option.side = (int8_t)side;
        option.share = goe_flight_clear_share(&look->at, look->slot, &option.way, NEVER, &nearest);
        if (best->action != GOE_FLIGHT_HOLD || goe_flight_smaller(option.share, 1.0f) > best->share) {
            option.share = goe_flight_smaller(option.share, 1.0f);
            *best = option;
        }
    }
}

/* Chooses the clear side or climb of the lowest cost; otherwise HOLD; otherwise the clearest path. On approach, a climb over known tops
 * comes first, and one over a top that is not known comes last, before a path into an outline. side: the only one that is allowed; 0: both. */
static option_t choose(const look_t *look, int about, const encounter_t *e, int side) {
    option_t best;
    option_t hold;
    option_t climb;
    memset(&best, 0, sizeof best);
    best.share = NEVER;
    hold = climb = best;
    if (look->own->approach) {
        try_climb(look, about, e, &climb);
        if (climb.share >= FREE) {
            return climb;
        }
    }
    if (side != TO_LEFT && e->ahead_m > 0.0f) {
        try_side(look, about, e, TO_RIGHT, &best);
    }
    if (side != TO_RIGHT && e->ahead_m > 0.0f) {
        try_side(look, about, e, TO_LEFT, &best);
    }
    if (side == 0 && !look->own->approach) {
        try_climb(look, about, e, &best);
    }
    if (best.action != GOE_FLIGHT_NONE && best.share >= FREE) {
        return best;
    }
    const int away = e->aside_m > 0.0f ? TO_LEFT : TO_RIGHT;
    if (side == 0 || side == away) {
        try_hold(look, away, &hold);
    }
    if (side == 0 || side == -away) {
        try_hold(look, -away, &hold);
    }
    const bool keep = best.action == GOE_FLIGHT_NONE || hold.share >= HOLD_FREE || hold.share > best.share + GAIN;
    const option_t level = keep ? hold : best;
    return side == 0 && climb.action != GOE_FLIGHT_NONE && climb.share >= level.share ? climb : level;
}

/* ------------------------------------------------------------------------------------------------------------- order -- */

/* The reported distance of a path with this clear fraction. */
static float clear_of(const goe_flight_t *flight, float share) {
    const float margin_m = goe_flight_larger(flight->settings.margin_m, GOE_FLIGHT_CLEAR_MARGIN_MIN_M);
    return goe_flight_clamped(share * margin_m, -CLEAR_MAX_M, CLEAR_MAX_M);
}

static void order(goe_flight_t *flight, int slot, const look_t *look, const encounter_t *e, const option_t *option) {
    goe_flight_reaction_t *r = &flight->reaction;
    const float *course = look->at.course_ne;
    const bool aside = option->side != 0;
    if (r->action == GOE_FLIGHT_NONE) { /* another order keeps the line of the first one */
        memcpy(r->from_ned_m, look->own->ned_m, sizeof r->from_ned_m);
        memcpy(r->course_ne, course, sizeof r->course_ne);
    }
    if (r->side != 0 && aside && r->side != option->side) {
        r->changes = (uint8_t)(r->changes < UINT8_MAX ? r->changes + 1 : r->changes);
    }
    const float ahead_m = aside ? option->way.target_m[0] : e->ahead_m;
    const float right_m = aside ? option->way.target_m[1] : 0.0f;
    r->target_ned_m[0] = look->own->ned_m[0] + course[0] * ahead_m - course[1] * right_m;
    r->target_ned_m[1] = look->own->ned_m[1] + course[1] * ahead_m + course[0] * right_m;
    r->target_ned_m[2] =
        r->action == GOE_FLIGHT_NONE ? option->down_m : goe_flight_smaller(r->target_ned_m[2], option->down_m);
    memcpy(r->along_ne, course, sizeof r->along_ne);
    r->ordered_us = r->action == (uint8_t)option->action ? r->ordered_us : look->own->time_us;
    r->action = (uint8_t)option->action;
    r->late = option->needed_s > e->earliest_tcpa_s;
    r->slot = (int8_t)slot;
    r->edge = option->edge;
    r->gap = option->gap;
    r->side = aside ? option->side : r->side;
    r->reason = option->share >= (option->action == GOE_FLIGHT_HOLD ? HOLD_FREE : FREE) ? GOE_FLIGHT_REASON_CLEAR
                                                                                        : GOE_FLIGHT_REASON_LEAST_BAD;
    r->clear_m = aside ? clear_of(flight, option->share) : 0.0f;
    r->rising = r->falling = false;
}

/* Whether the hazard has lasted long enough; it is due at once if no time is left. */
static bool is_due(goe_flight_reaction_t *r, const goe_flight_settings_t *settings, const encounter_t *e,
                   float needed_s, bool is_hazard, uint32_t now_us) {
    if (!is_hazard || e->earliest_tcpa_s > needed_s + settings->reserve_s) {
        r->rising = false;
        return false;
    }
    r->rising_us = r->rising ? r->rising_us : now_us;
    r->rising = true;
    return e->earliest_tcpa_s <= needed_s || goe_flight_between_s(now_us, r->rising_us) >= settings->confirm_s;
}

/* goe_flight_clear_slots() leaves 0 for a slot without a position. */
static bool has_position(const look_t *look, int i) { return look->slot[i].margin_m > 0.0f; }

/* Distance of the target to the right of the line, as one obstacle requires: past its outline on the side of the order; in a gap, at the
 * wall that is passed. */
static float edge_of(const look_t *look, const goe_flight_reaction_t *r, int i, int side) {
    const goe_flight_clear_slot_t *one = &look->slot[i];
    float ahead_m;
    float aside_m;
    relate(r->from_ned_m, r->along_ne, look->flight->slot[i].center_ne_m, &ahead_m, &aside_m);
    const float beyond_m = r->gap ? one->radius_m
                                  : one->radius_m + one->margin_m + look->circle_m +
                                        SURE_SIGMA * aside_sd_m(&look->flight->slot[i], r->along_ne);
    return aside_m + times(side, beyond_m);
}

/* Moves the target with the outline that it passes, along the course on which it was chosen, but never inside the outline of the order's
 * obstacle. In a gap, the target stays in the middle. */
static void follow(const look_t *look, goe_flight_reaction_t *r) {
    float ahead_m;
    float aside_m;
    if (!is_aside(r->action) || r->edge == NOBODY || r->slot == NOBODY) {
        return;
    }
    if (!has_position(look, r->slot) || !has_position(look, r->edge)) {
        return;
    }
    const float about_m = edge_of(look, r, r->slot, r->side);
    const float other_m = edge_of(look, r, r->edge, r->gap ? -r->side : r->side);
    const float outer_m = times(r->side, other_m - about_m) > 0.0f ? other_m : about_m;
    const float target_m = r->gap ? 0.5f * (about_m + other_m) + times(r->side, look->circle_m) : outer_m;
    relate(r->from_ned_m, r->along_ne, look->flight->slot[r->slot].center_ne_m, &ahead_m, &aside_m);
    r->target_ned_m[0] = r->from_ned_m[0] + r->along_ne[0] * ahead_m - r->along_ne[1] * target_m;
    r->target_ned_m[1] = r->from_ned_m[1] + r->along_ne[1] * ahead_m + r->along_ne[0] * target_m;
}

/* Clear fraction of the order's path from here. */
static float share_of_order(const look_t *look, const goe_flight_reaction_t *r, int *nearest) {
    goe_flight_clear_way_t way;
    memset(&way, 0, sizeof way);
    goe_flight_clear_relate(&look->at, r->target_ned_m, way.target_m);
    goe_flight_clear_direct(&look->at, r->course_ne, way.line_m);
    way.shifts = true;
    way.circle_m = look->circle_m;
    way.sigmas = LIKELY_SIGMA;
    way.turns_away = r->action == GOE_FLIGHT_HOLD || !(way.target_m[0] > 0.0f);
    if (!(way.circle_m > 0.0f) && is_aside(r->action)) { /* it is flown through: the line beyond it also counts */
        const float on_m = goe_flight_larger(2.0f * look->at.turn_m - way.target_m[0], 0.0f);
        way.target_m[0] += on_m * way.line_m[0];
        way.target_m[1] += on_m * way.line_m[1];
        way.turns_away = !(way.target_m[0] > 0.0f);
    }
    if (r->action == GOE_FLIGHT_HOLD) {
        way.circle_m = goe_flight_larger(look->flight->settings.loiter_m, look->at.turn_m);
    }
    return goe_flight_clear_share(&look->at, look->slot, &way, NEVER, nearest);
}

/* Whether the other path is left of another obstacle, but still right of that of the order, or vice versa: no change of side. */
static bool is_between(const look_t *look, const goe_flight_reaction_t *r, int nearest, const option_t *other) {
    return is_aside(r->action) && is_aside(other->action) && r->slot != NOBODY && r->slot != nearest &&
           times(r->side, other->way.target_m[1] - look->slot[r->slot].at_m[1]) > 0.0f;
}

/* Looks for another path if that of the order is no longer clear: first on the same side, then on the other side, which must be twice as
 * clear. After one change of side, another one needs a clear path. */
static void find_better(goe_flight_t *flight, look_t *look, float share, int nearest) {
    goe_flight_reaction_t *r = &flight->reaction;
    encounter_t e;
    meet(look, nearest, &e);
    option_t option = choose(look, nearest, &e, r->side);
    /* An autopilot obeys another action as late as a first order. */
    if (option.action != (goe_flight_action_t)r->action) {
        set_delay(look, 0.0f);
        option = choose(look, nearest, &e, r->side);
    }
    if (!(option.share >= KEPT)) {
        set_delay(look, 0.0f);
        option_t other = choose(look, nearest, &e, -r->side);
        if (is_between(look, r, nearest, &other) && other.share >= KEPT && other.share >= share + GAIN) {
            other.action = (goe_flight_action_t)r->action;
            other.side = r->side;
            other.edge = NOBODY;
            other.gap = false;
            order(flight, r->slot, look, &e, &other);
            return;
        }
        const bool allowed = share < 0.0f && other.share >= (r->changes == 0 ? HOLD_FREE : FREE);
        if (allowed && other.share >= 2.0f * goe_flight_larger(option.share, share)) {
            option = other;
        }
    }
    if (option.share >= share + GAIN) {
        order(flight, nearest, look, &e, &option);
    }
}

static void review(goe_flight_t *flight, look_t *look) {
    goe_flight_reaction_t *r = &flight->reaction;
    int nearest;
    if (r->action == GOE_FLIGHT_NONE || r->side == 0 || is_up(r->action)) { /* the order may have just ended */
        return;
    }
    follow(look, r);
    const bool turned = r->along_ne[0] * look->at.course_ne[0] + r->along_ne[1] * look->at.course_ne[1] < TURNED;
    if (turned) {
        look->at.early_m = look->at.late_m = 0.0f;
    } else {
        set_delay(look, goe_flight_between_s(look->own->time_us, r->ordered_us));
    }
    const float share = share_of_order(look, r, &nearest);
    r->clear_m = clear_of(flight, share);
    if (share < 0.0f) {
        r->reason = GOE_FLIGHT_REASON_LEAST_BAD;
    }
    if (share >= KEPT || nearest == NOBODY) {
        r->rising = false;
        return;
    }
    r->rising_us = r->rising ? r->rising_us : look->own->time_us;
    r->rising = true;
    if (share < 0.0f || goe_flight_between_s(look->own->time_us, r->rising_us) >= flight->settings.confirm_s) {
        find_better(flight, look, share, nearest);
    }
}

/* --------------------------------------------------------------------------------------------------------------- end -- */

/* Whether an obstacle is on the order line, or between this line and the aircraft, and is not passed. To the side it needs the margin that a
 * hazard is judged by: otherwise, an order ends while its hazard is active. A slow aircraft may become faster: for it the line has no end. */
static bool is_in_the_way(const look_t *look, int i, float own_aside_m) {
    const goe_flight_slot_t *slot = &look->flight->slot[i];
    const goe_flight_reaction_t *r = &look->flight->reaction;
    const float reach_m = goe_flight_slot_radius_m(slot) + look->flight->settings.margin_m;
    const float sure_m = look->slot[i].radius_m + look->slot[i].margin_m + SURE_SIGMA * aside_sd_m(slot, r->course_ne);
    const float horizon_m = goe_flight_absolute(own_aside_m) + 2.0f * look->at.turn_m +
                            look->speed_m_s * (look->flight->settings.roll_in_s + look->flight->settings.reserve_s);
    float ahead_m;
    float aside_m;
    float from_ahead_m;
    relate(look->own->ned_m, r->course_ne, slot->center_ne_m, &ahead_m, &aside_m);
    if (ahead_m < -reach_m || (i != r->slot && look->has_course && ahead_m > horizon_m)) {
        return false;
    }
    relate(r->from_ned_m, r->course_ne, slot->center_ne_m, &from_ahead_m, &aside_m);
    return aside_m > goe_flight_smaller(own_aside_m, 0.0f) - sure_m &&
           aside_m < goe_flight_larger(own_aside_m, 0.0f) + sure_m;
}

/* Whether the aircraft may turn back to the order line from here, whatever is behind it. */
static bool is_way_back_clear(const look_t *look, float own_ahead_m, float own_aside_m) {
    const goe_flight_reaction_t *r = &look->flight->reaction;
    const float on_m = own_ahead_m + goe_flight_absolute(own_aside_m) + 2.0f * look->at.turn_m;
    const float back_ne_m[2] = {r->from_ned_m[0] + on_m * r->course_ne[0], r->from_ned_m[1] + on_m * r->course_ne[1]};
    goe_flight_clear_way_t way;
    int nearest;
    memset(&way, 0, sizeof way);
    goe_flight_clear_relate(&look->at, back_ne_m, way.target_m);
    goe_flight_clear_direct(&look->at, r->course_ne, way.line_m);
    way.sigmas = SURE_SIGMA;
    way.turns_away = !(way.target_m[0] > 0.0f);
    return goe_flight_clear_share(&look->at, look->slot, &way, HOLD_FREE, &nearest) >= HOLD_FREE;
}

/* Largest distance from the order line before the aircraft flies back: straight on until it obeys, then a turn. */
static float farthest_aside_m(const look_t *look, float own_aside_m) {
    const float *line = look->flight->reaction.course_ne;
    const float *course = look->at.course_ne;
    const float cosine = line[0] * course[0] + line[1] * course[1];
    const float sine = line[0] * course[1] - line[1] * course[0];
    const float way_m =
        look->at.late_m * goe_flight_absolute(sine) + look->at.turn_m * goe_flight_larger(1.0f - cosine, 0.0f);
    return (sine > 0.0f) == (own_aside_m > 0.0f) ? own_aside_m + (sine > 0.0f ? way_m : -way_m) : own_aside_m;
}

/* Whether the aircraft flies between the order line and this obstacle: on the side of the order, it would turn into the obstacle. */
static bool is_outside(const look_t *look, const goe_flight_reaction_t *r, int i) {
    float ahead_m;
    float aside_m;
    relate(look->own->ned_m, r->course_ne, look->flight->slot[i].center_ne_m, &ahead_m, &aside_m);
    return is_aside(r->action) && i != r->slot && times(r->side, aside_m) > 0.0f;
}

/* Whether the obstacle of an order to a side is ahead, and the path past it is farther out than that past the next one on the line. An
 * order for the next one would lead back into it. */
static bool is_farther_out(const look_t *look, const goe_flight_reaction_t *r, int next) {
    float ahead_m;
    float aside_m;
    relate(look->own->ned_m, r->course_ne, look->flight->slot[r->slot].center_ne_m, &ahead_m, &aside_m);
    return is_aside(r->action) && look->slot[r->slot].counts && ahead_m > 0.0f &&
           times(r->side, edge_of(look, r, r->slot, r->side) - edge_of(look, r, next, r->side)) > 0.0f;
}

/* Whether an obstacle counts for the end of the order. After a climb the aircraft descends to its line, whose height decides. */
static bool counts_at_end(const look_t *look, int i) {
    const goe_flight_reaction_t *r = &look->flight->reaction;
    const bool up = is_up(r->action);
    return up ? goe_flight_clear_counts(look->flight, i, r->from_ned_m[2]) : look->slot[i].counts;
}

/* Whether the order line may be flown again: every obstacle is behind on it, or surely to its side, or unknown; and the way back to it is
 * clear. Otherwise, the order turns to the nearest obstacle that remains. */
static bool is_over(const look_t *look, goe_flight_reaction_t *r, bool *behind) {
    float own_ahead_m;
    float own_aside_m;
    float least_m = TIME_MAX_S;
    int next = NOBODY;
    bool left = false;
    bool waits = false;
    relate(r->from_ned_m, r->course_ne, look->own->ned_m, &own_ahead_m, &own_aside_m);
    own_aside_m = is_up(r->action) ? 0.0f : farthest_aside_m(look, own_aside_m);
    for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
        const float ahead_m = look->slot[i].at_m[0];
        if (counts_at_end(look, i) && is_in_the_way(look, i, own_aside_m)) {
            left = left || i == r->slot;
            waits = true;
            if (ahead_m < least_m && !is_outside(look, r, i)) {
                next = i;
                least_m = ahead_m;
            }
        }
    }
    *behind = false;
    if (waits) {
        const bool may_turn = !left && r->slot != NOBODY && next != NOBODY && !is_up(r->action);
        if (may_turn && !is_farther_out(look, r, next)) { /* one is passed, the next is ahead */
            r->slot = (int8_t)next;
            r->edge = is_aside(r->action) ? (int8_t)next : NOBODY;
            r->gap = false;
            memcpy(r->along_ne, r->course_ne, sizeof r->along_ne);
        }
        return false;
    }
    if (r->slot != NOBODY) {
        float ahead_m;
        float aside_m;
        relate(look->own->ned_m, r->course_ne, look->flight->slot[r->slot].center_ne_m, &ahead_m, &aside_m);
        *behind = ahead_m < 0.0f;
    }
    return is_up(r->action) || is_way_back_clear(look, own_ahead_m, own_aside_m);
}

static void end_if_over(goe_flight_t *flight, const look_t *look) {
    goe_flight_reaction_t *r = &flight->reaction;
    bool behind;
    if (!is_over(look, r, &behind)) {
        r->falling = false;
        return;
    }
    r->falling_us = r->falling ? r->falling_us : look->own->time_us;
    r->falling = true;
    if (behind || goe_flight_between_s(look->own->time_us, r->falling_us) >= flight->settings.hold_s) {
        const goe_flight_reaction_t ended = *r;
        goe_flight_reaction_clear(r);
        memcpy(r->from_ned_m, ended.from_ned_m, sizeof r->from_ned_m);
        memcpy(r->course_ne, ended.course_ne, sizeof r->course_ne);
        r->side = ended.side;
        r->changes = ended.changes;
        r->falling = true; /* without an order: it has just ended */
        r->falling_us = look->own->time_us;
    }
}

/* Forgets an ended order and its side, but only after a while: an order soon after it belongs to the same encounter. */
static void forget_order(goe_flight_reaction_t *r, uint32_t now_us) {
    if (r->action == GOE_FLIGHT_NONE && goe_flight_between_s(now_us, r->falling_us) > REMEMBERED_S) {
        r->side = 0;
        r->changes = 0;
        r->falling = false;
    }
}

/* Leads a climb on, past an obstacle on its line: at the order the obstacle may have seemed nearer, and an autopilot circles the target. */
static void lead_past(const look_t *look, goe_flight_reaction_t *r, int i) {
    const goe_flight_slot_t *slot = &look->flight->slot[i];
    const float reach_m = goe_flight_slot_radius_m(slot) + look->flight->settings.margin_m + PAST_M;
    float ahead_m;
    float target_m;
    float aside_m;
    relate(r->from_ned_m, r->course_ne, slot->center_ne_m, &ahead_m, &aside_m);
    relate(r->from_ned_m, r->course_ne, r->target_ned_m, &target_m, &aside_m);
    const float more_m = goe_flight_larger(ahead_m + reach_m - target_m, 0.0f);
    r->target_ned_m[0] += more_m * r->course_ne[0];
    r->target_ned_m[1] += more_m * r->course_ne[1];
}

/* Raises a climb with the tops on the course, and leads it past what it has to pass. */
static void rise(goe_flight_t *flight, const look_t *look) {
    goe_flight_reaction_t *r = &flight->reaction;
    for (int i = 0; i < GOE_FLIGHT_SLOTS && is_up(r->action); i++) {
        encounter_t e;
        if (!flight->slot[i].used || (flight->slot[i].valid & GOE_HAS_POSITION) == 0u) {
            continue;
        }
        meet(look, i, &e);
        if (e.has_top && is_on_course(&e)) {
            r->target_ned_m[2] = goe_flight_smaller(r->target_ned_m[2], e.top_down_m);
        }
        if (r->action == GOE_FLIGHT_CLIMB && counts_at_end(look, i) && is_in_the_way(look, i, 0.0f)) {
            lead_past(look, r, i);
        }
    }
}

/* On approach, a go-around over known tops replaces an order to a side as soon as a climb is in time. An aircraft that lands next to an
 * obstacle lands next to the runway. */
static void break_off(goe_flight_t *flight, const look_t *look) {
    const goe_flight_reaction_t *r = &flight->reaction;
    encounter_t e;
    option_t option;
    if (!look->own->approach || r->action == GOE_FLIGHT_NONE || r->action == GOE_FLIGHT_GO_AROUND ||
        r->slot == NOBODY) {
        return;
    }
    memset(&option, 0, sizeof option);
    option.share = NEVER;
    meet(look, r->slot, &e);
    try_climb(look, r->slot, &e, &option);
    if (option.share >= FREE) {
        order(flight, r->slot, look, &e, &option);
    }
}

/* Moves a time along that lies far back: after half an hour it would look like one of the future. */
static void drag(uint32_t *since_us, uint32_t now_us) {
    if (goe_flight_between_us(now_us, *since_us) > LONG_US) {
        *since_us = now_us - (uint32_t)LONG_US;
    }
}

/* Clears an order with a corrupt field. A hazard that is still active then causes a new order. */
static void mend(goe_flight_reaction_t *r) {
    const bool finite = goe_flight_all_finite(r->target_ned_m, 3) && goe_flight_all_finite(r->from_ned_m, 3) &&
                        goe_flight_all_finite(r->course_ne, 2) && goe_flight_all_finite(r->along_ne, 2) &&
                        goe_flight_finite(r->clear_m);
    if (!finite || r->reason > GOE_FLIGHT_REASON_LANDING || r->action > GOE_FLIGHT_HOLD || r->slot < NOBODY ||
        r->slot >= GOE_FLIGHT_SLOTS || r->edge < NOBODY || r->edge >= GOE_FLIGHT_SLOTS || r->side < TO_LEFT ||
        r->side > TO_RIGHT) {
        goe_flight_reaction_clear(r);
    }
}

/* ------------------------------------------------------------------------------------------------------------- decide -- */

/* The reason why no order may be given now; GOE_FLIGHT_REASON_NONE: it may. */
static goe_flight_reason_t withheld(const goe_flight_t *flight, const goe_flight_reaction_own_t *own, float speed_m_s) {
    if (own->grounded) {
        return GOE_FLIGHT_REASON_LANDING;
    }
    const goe_flight_settings_t *settings = &flight->settings;
    const float above_m = flight->ground_down_m - own->ned_m[2];
    const bool is_above = above_m > -SURE_SIGMA * settings->home_sd_m; /* otherwise the ground is lower than assumed */
    if (is_above && above_m < settings->order_height_m && settings->order_height_m > 0.0f) {
        return GOE_FLIGHT_REASON_LOW;
    }
    return speed_m_s < settings->order_speed_m_s ? GOE_FLIGHT_REASON_SLOW : GOE_FLIGHT_REASON_NONE;
}

/* Time of the simplest turn past an obstacle, regardless of other obstacles. */
static float simplest_s(const look_t *look, const encounter_t *e) {
    const float right_s = turn_time_s(look, e->keep_m + e->aside_m);
    const float left_s = turn_time_s(look, e->keep_m - e->aside_m);
    return goe_flight_smaller(right_s, left_s);
}

/* Time that is left, minus that of the simplest action against this obstacle. */
static float slack_s(const look_t *look, const encounter_t *e) { return e->earliest_tcpa_s - simplest_s(look, e); }

static bool is_hazard_slot(const look_t *look, int i) {
    const goe_flight_slot_t *slot = &look->flight->slot[i];
    return slot->used && slot->assessed &&
           slot->hazard.conflict_probability >= look->flight->settings.conflict_probability_max;
}

/* The hazard ahead that leaves the least time; NOBODY if there is none.
 *   unlikely  slots that are left out, as bits
 *   least     least conflict probability of the hazard
 *   spare_s   least slack of the hazard */
static int most_pressing(const look_t *look, uint32_t unlikely, float least, float spare_s) {
    int pressing = NOBODY;
    float least_s = TIME_MAX_S;
    for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
        encounter_t e;
        if (((unlikely >> i) & 1u) != 0u || !is_hazard_slot(look, i) ||
            !(look->flight->slot[i].hazard.conflict_probability >= least)) {
            continue;
        }
        meet(look, i, &e);
        const float left_s = slack_s(look, &e);
        if (e.ahead_m > 0.0f && !(left_s < spare_s) && (pressing == NOBODY || left_s < least_s)) {
            least_s = left_s;
            pressing = i;
        }
    }
    return pressing;
}

/* After one change of side, only a side that is twice as clear causes another change. */
static option_t choose_steadily(const look_t *look, int about, const encounter_t *e) {
    const goe_flight_reaction_t *r = &look->flight->reaction;
    const option_t option = choose(look, about, e, 0);
    if (r->changes == 0 || option.side == 0 || option.side == r->side) {
        return option;
    }
    const option_t same = choose(look, about, e, r->side);
    return same.share > 0.0f && option.share < 2.0f * same.share ? same : option;
}

/* Whether the previous order has just ended, and the autopilot is about to fly back to its line on a clear path. An obstacle on the present
 * course is then no reason for another order. */
static bool is_flying_back(look_t *look) {
    const goe_flight_reaction_t *r = &look->flight->reaction;
    const float since_s = goe_flight_between_s(look->own->time_us, r->falling_us);
    float own_ahead_m;
    float own_aside_m;
    if (r->action != GOE_FLIGHT_NONE || r->side == 0 || since_s > LATEST * look->flight->settings.roll_in_s) {
        return false;
    }
    relate(r->from_ned_m, r->course_ne, look->own->ned_m, &own_ahead_m, &own_aside_m);
    set_delay(look, since_s);
    const bool clear = is_way_back_clear(look, own_ahead_m, own_aside_m);
    set_delay(look, 0.0f);
    return clear;
}

/* Whether an active climb does not reach the height over this obstacle in time, even if it may lack this fraction of the clearance. */
static bool is_too_low(const look_t *look, const encounter_t *e, float lack) {
    const goe_flight_settings_t *settings = &look->flight->settings;
    const float since_s = goe_flight_between_s(look->own->time_us, look->flight->reaction.ordered_us);
    const float begins_s = goe_flight_larger(settings->climb_in_s - since_s, 0.0f);
    const float rise_m = goe_flight_larger(rise_of(look, e) - lack * settings->clearance_m, 0.0f);
    return begins_s + rise_m / settings->climb_m_s > e->earliest_tcpa_s;
}

/* Whether another way replaces an active climb: a clear one, if it is against another obstacle or the climb is not clear; or any way, if the
 * climb is too low. A low climb over a top that is not known, or one that still clears the top, is better than a way into an obstacle. */
static bool replaces_climb(const look_t *look, int about, const encounter_t *e, const option_t *option) {
    const goe_flight_reaction_t *r = &look->flight->reaction;
    const bool other = r->slot != about;
    const bool low = is_too_low(look, e, CLIMB_SLACK) || (other && !e->has_top);
    const bool into = e->has_top && is_too_low(look, e, 1.0f);
    const bool instead = low && (into || option->share > 0.0f);
    return instead || (option->share >= FREE && (other || r->reason == GOE_FLIGHT_REASON_LEAST_BAD));
}

/* Least conflict probability that causes an order when no action comes in time. */
static float late_violation(const goe_flight_settings_t *settings) {
    return goe_flight_larger(LATE_VIOLATION, settings->conflict_probability_max);
}

/* Gives the order against one obstacle when it is due. Returns the time that the best action needs. If that time is not left, and the
 * conflict probability is too low for a late order, sets *unlikely and changes nothing; with a null pointer, it only gives no order. */
static float answer(goe_flight_t *flight, look_t *look, int about, bool *unlikely) {
    goe_flight_reaction_t *r = &flight->reaction;
    const goe_flight_settings_t *settings = &flight->settings;
    encounter_t e;
    const float violation = flight->slot[about].hazard.conflict_probability;
    const bool reviewed = r->side != 0 && !is_up(r->action) && r->action != GOE_FLIGHT_NONE;
    meet(look, about, &e);
    if (reviewed) {
        const float needed_s = simplest_s(look, &e);
        const bool into = r->clear_m < 0.0f && violation >= LATE_VIOLATION && e.ahead_m > 0.0f;
        r->late = r->late || (into && needed_s > e.earliest_tcpa_s);
        return needed_s;
    }
    if (!(violation >= settings->conflict_probability_max) || !(e.ahead_m > 0.0f)) {
        r->rising = false;
        return simplest_s(look, &e);
    }
    const option_t option = choose_steadily(look, about, &e);
    const float most =
        option.needed_s > e.earliest_tcpa_s ? late_violation(settings) : settings->conflict_probability_max;
    if (unlikely && violation < most) {
        *unlikely = true;
        return option.needed_s;
    }
    const bool is_hazard = violation >= most && !is_flying_back(look);
    const bool is_new = r->action == GOE_FLIGHT_NONE || (is_up(r->action) && replaces_climb(look, about, &e, &option));
    if (is_due(r, settings, &e, option.needed_s, is_hazard && is_new, look->own->time_us)) {
        const goe_flight_reason_t why = withheld(flight, look->own, look->speed_m_s);
        if (why == GOE_FLIGHT_REASON_NONE) {
            order(flight, about, look, &e, &option);
        } else if (r->action == GOE_FLIGHT_NONE) {
            r->reason = (uint8_t)why;
        }
    }
    return option.needed_s;
}

/* Gives the order against the hazard that leaves the least time. One that is unlikely, and for which it is too late, delays no order against
 * the next one. The last attempt takes a hazard that cannot be unlikely, otherwise one for which there is time. So each assessment examines a
 * limited number of paths. */
static float answer_hazards(goe_flight_t *flight, look_t *look, int worst) {
    uint32_t passed_over = 0u;
    for (int k = 0; k < ATTEMPTS; k++) {
        const bool last = k + 1 == ATTEMPTS;
        int about = most_pressing(look, passed_over, last ? late_violation(&flight->settings) : 0.0f, -TIME_MAX_S);
        bool unlikely = false;
        if (last && about == NOBODY) {
            about = most_pressing(look, passed_over, 0.0f, 0.0f);
        }
        if (about == NOBODY) {
            break;
        }
        const float needed_s = answer(flight, look, about, last ? NULL : &unlikely);
        if (!unlikely) {
            return needed_s;
        }
        passed_over |= 1u << about;
    }
    return answer(flight, look, worst, NULL);
}

float goe_flight_reaction_decide(goe_flight_t *flight, int worst, const goe_flight_reaction_own_t *own) {
    goe_flight_reaction_t *r = &flight->reaction;
    look_t look;
    memset(&look, 0, sizeof look);
    mend(r);
    drag(&r->ordered_us, own->time_us);
    drag(&r->rising_us, own->time_us);
    forget_order(r, own->time_us);
    if (own->grounded && r->action != GOE_FLIGHT_NONE) {
        goe_flight_reaction_clear(r);
    }
    const bool active = r->action != GOE_FLIGHT_NONE;
    if (!active) {
        r->reason = GOE_FLIGHT_REASON_NONE;
    }
    if (!look_around(flight, own, &look)) {
        r->rising = false;
        return 0.0f;
    }
    if (active) {
        end_if_over(flight, &look);
    }
    if (active && look.has_course) {
        break_off(flight, &look);
        review(flight, &look);
        set_delay(&look, 0.0f);
        rise(flight, &look);
    }
    if (worst == NOBODY || !look.has_course) {
        r->rising = false;
        return 0.0f;
    }
    return answer_hazards(flight, &look, worst);
}
