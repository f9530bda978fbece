/* Which way is taken, how clear an active order is, and when it ends: against plain models of the README's rule. SPDX-License-Identifier:
 * MIT
 *
 * Any places about any order on any course. How clear one way is test_flight_clear.c knows; here it is which way counts. */
#include <math.h>
#include <string.h>

#include "flown.h"
#include "goe_clear.h"
#include "goe_flight_maths.h"
#include "goe_reaction.h"

#define PI 3.14159265358979
#define GRAVITY_M_S2 9.80665
#define SPEED_M_S 20.0
#define TRIALS 6000
#define NEAR_TIE_M 0.05
#define NEAR_TIE 0.002

static check_random_t any;
static goe_flight_t plain;
static goe_flight_t flight;
static goe_flight_reaction_own_t own;
static goe_flight_clear_own_t frame; /* of the course */
static goe_flight_clear_slot_t slots[GOE_FLIGHT_SLOTS];
static double line[2], course[2], own_ahead_m, own_right_m; /* on the line of the order */

void setUp(void) {
    static flown_t flown;
    any = check_random_start("flight rule");
    flown_start(&flown, NULL);
    plain = flown.flight;
}
void tearDown(void) {}

static double between(double low, double high) { return check_random_between(&any, low, high); }
static bool one_in(int n) { return between(0.0, (double)n) < 1.0; }
static double turn_m(void) { return SPEED_M_S * SPEED_M_S / (GRAVITY_M_S2 * tan(30.0 * PI / 180.0)); }

/* An order on a line through the origin, and an aircraft next to it; with any obstacles. */
static void any_standing_order(void) {
    static const uint8_t actions[] = {GOE_FLIGHT_LEFT, GOE_FLIGHT_RIGHT, GOE_FLIGHT_HOLD, GOE_FLIGHT_CLIMB,
                                      GOE_FLIGHT_GO_AROUND};
    const double angle = between(-PI, PI);
    const double off = one_in(3) ? 0.0 : between(-1.2, 1.2);
    flight = plain;
    memset(&own, 0, sizeof own);
    line[0] = cos(angle);
    line[1] = sin(angle);
    course[0] = cos(angle + off);
    course[1] = sin(angle + off);
    own_ahead_m = between(0.0, 150.0);
    own_right_m = between(-60.0, 60.0);
    own.ned_m[0] = (float)(own_ahead_m * line[0] - own_right_m * line[1]);
    own.ned_m[1] = (float)(own_ahead_m * line[1] + own_right_m * line[0]);
    own.ned_m[2] = -20.0f;
    own.time_us = 50000000u;
    flight.velocity_ned_m_s[0] = (float)(SPEED_M_S * course[0]);
    flight.velocity_ned_m_s[1] = (float)(SPEED_M_S * course[1]);
    flight.settings.loiter_m = one_in(2) ? 0.0f : 100.0f;
    flight.settings.hold_s = one_in(2) ? 0.0f : 2.0f;
    const int count = 1 + (int)between(0.0, 3.99);
    for (int i = 0; i < count; i++) {
        goe_flight_slot_t *slot = &flight.slot[i];
        const double ahead_m = between(-80.0, 400.0);
        const double right_m = one_in(2) ? between(-160.0, 160.0) : between(-40.0, 40.0);
        const double sd_m[2] = {between(0.0, 6.0), between(0.0, 6.0)};
        slot->used = true;
        slot->valid = (uint8_t)(GOE_HAS_POSITION | GOE_HAS_WIDTH | (one_in(3) ? 0 : GOE_HAS_HEIGHT));
        slot->top_m = one_in(4) ? 5.0f : 80.0f;
        slot->width_m = (float)between(1.0, 30.0);
        slot->center_ne_m[0] = (float)(ahead_m * line[0] - right_m * line[1]);
        slot->center_ne_m[1] = (float)(ahead_m * line[1] + right_m * line[0]);
        slot->covariance_ne_m2[0] = (float)(sd_m[0] * sd_m[0]);
        slot->covariance_ne_m2[2] = (float)(sd_m[1] * sd_m[1]);
        slot->covariance_ne_m2[1] = (float)(between(-0.9, 0.9) * sd_m[0] * sd_m[1]);
        slot->taken_us = own.time_us;
    }
    goe_flight_reaction_t *r = &flight.reaction;
    r->action = actions[(int)between(0.0, 4.99)];
    r->side = (int8_t)(r->action == GOE_FLIGHT_LEFT    ? -1
                       : r->action == GOE_FLIGHT_RIGHT ? 1
                       : r->action == GOE_FLIGHT_HOLD  ? (one_in(2) ? 1 : -1)
                                                       : 0);
    r->slot = (int8_t)(one_in(6) ? -1 : (int)between(0.0, (double)count - 0.01));
    r->edge = -1;
    r->changes = 1u;
    r->course_ne[0] = r->along_ne[0] = (float)line[0];
    r->course_ne[1] = r->along_ne[1] = (float)line[1];
    const double to_m[2] = {own_ahead_m + between(20.0, 150.0), own_right_m + between(-60.0, 60.0)};
    r->target_ned_m[0] = (float)(to_m[0] * line[0] - to_m[1] * line[1]);
    r->target_ned_m[1] = (float)(to_m[0] * line[1] + to_m[1] * line[0]);
    r->target_ned_m[2] = -20.0f;
    r->from_ned_m[2] = one_in(2) ? -20.0f : (float)between(-130.0, 0.0);
    r->ordered_us = own.time_us - (uint32_t)between(0.0, 2.5e6);
    r->reason = GOE_FLIGHT_REASON_CLEAR;
}

/* Obeyed after 0.33 to 1.2 roll_in_s, of which so much has passed. */
static void begin_frame(double since_s) {
    const double roll_in_s = (double)flight.settings.roll_in_s;
    memset(&frame, 0, sizeof frame);
    memcpy(frame.ned_m, own.ned_m, sizeof frame.ned_m);
    frame.course_ne[0] = (float)course[0];
    frame.course_ne[1] = (float)course[1];
    frame.turn_m = (float)turn_m();
    frame.early_m = (float)(SPEED_M_S * fmax(0.33 * roll_in_s - since_s, 0.0));
    frame.late_m = (float)(SPEED_M_S * fmax(1.2 * roll_in_s - since_s, 0.33 * roll_in_s));
    frame.through_m = (float)(turn_m() + SPEED_M_S * (roll_in_s + (double)flight.settings.reserve_s));
    frame.time_us = own.time_us;
    goe_flight_clear_slots(&flight, &frame, slots);
}

static double share_of(const goe_flight_clear_way_t *way) {
    int nearest;
    return (double)goe_flight_clear_share(&frame, slots, way, -2.0f * GOE_FLIGHT_CLEAR_MAX, &nearest);
}

/* ------------------------------------------------------------------------------------------------------------- model -- */

static bool near_tie; /* of the encounter: what rounding decides */

static bool is_more(double a, double b, double tie) {
    near_tie = near_tie || fabs(a - b) < tie;
    return a > b;
}

/* It has a place; and its top, at two sigma and with the clearance, is not below the height at which a climb began. */
static bool is_above_the_line(int i) {
    const goe_flight_slot_t *slot = &flight.slot[i];
    const double top_m = (double)slot->top_m + 2.0 * (double)slot->top_sd_m + (double)flight.settings.clearance_m;
    const bool low = (slot->valid & GOE_HAS_HEIGHT) != 0u &&
                     is_more(-(double)flight.reaction.from_ned_m[2], top_m - (double)slot->ground_down_m, NEAR_TIE_M);
    return slot->used && (slot->valid & GOE_HAS_POSITION) != 0u && !low;
}

/* Not behind by its radius and the margin, nor beyond the distance needed to avoid it again, nor aside of both the line and the aircraft.
 * */
static bool is_in_the_way(int i, double aside_m) {
    const goe_flight_slot_t *slot = &flight.slot[i];
    const double place[2] = {(double)slot->center_ne_m[0], (double)slot->center_ne_m[1]};
    const double ahead_m = line[0] * place[0] + line[1] * place[1];
    const double right_m = line[0] * place[1] - line[1] * place[0];
    const float *v = slot->covariance_ne_m2;
    const double variance =
        line[1] * line[1] * (double)v[0] - 2.0 * line[0] * line[1] * (double)v[1] + line[0] * line[0] * (double)v[2];
    const double reach_m = 0.5 * (double)slot->width_m + (double)flight.settings.margin_m;
    const double sure_m = reach_m + 2.0 * sqrt(fmax(variance, 0.0));
    const double horizon_m =
        fabs(aside_m) + 2.0 * turn_m() + SPEED_M_S * (double)(flight.settings.roll_in_s + flight.settings.reserve_s);
    if (is_more(-reach_m, ahead_m - own_ahead_m, NEAR_TIE_M) ||
        (i != flight.reaction.slot && is_more(ahead_m - own_ahead_m, horizon_m, NEAR_TIE_M))) {
        return false;
    }
    const bool left = is_more(right_m, fmin(aside_m, 0.0) - sure_m, NEAR_TIE_M);
    const bool right = is_more(fmax(aside_m, 0.0) + sure_m, right_m, NEAR_TIE_M);
    return left && right;
}

/* Where the aircraft comes to before it flies back: on for as long as an order may take to be obeyed, and the turn. */
static double farthest_aside_m(void) {
    const double cosine = line[0] * course[0] + line[1] * course[1];
    const double sine = line[0] * course[1] - line[1] * course[0];
    const double way_m = SPEED_M_S * 1.2 * (double)flight.settings.roll_in_s * fabs(sine) + turn_m() * (1.0 - cosine);
    const bool leaves = (sine > 0.0) == (own_right_m > 0.0);
    near_tie = near_tie || fabs(own_right_m) < NEAR_TIE_M;
    return leaves ? own_right_m + (sine > 0.0 ? way_m : -way_m) : own_right_m;
}

/* Back to the line: by half of the margin at two sigma. */
static bool is_way_back_clear(double aside_m) {
    goe_flight_clear_way_t way;
    const double on_m = own_ahead_m + fabs(aside_m) + 2.0 * turn_m();
    const float back_ne_m[2] = {(float)(on_m * line[0]), (float)(on_m * line[1])};
    const float line_ne[2] = {(float)line[0], (float)line[1]};
    begin_frame(0.0);
    memset(&way, 0, sizeof way);
    goe_flight_clear_relate(&frame, back_ne_m, way.target_m);
    goe_flight_clear_direct(&frame, line_ne, way.line_m);
    way.sigmas = 2.0f;
    way.turns_away = !is_more((double)way.target_m[0], 0.0, NEAR_TIE_M);
    return is_more(share_of(&way), 0.5, NEAR_TIE);
}

/* The way from here to the target at one sigma: about a circle, or through it and on along the line. */
static double share_of_order(const goe_flight_reaction_t *r) {
    goe_flight_clear_way_t way;
    const bool turned = !is_more(line[0] * course[0] + line[1] * course[1], 0.99, 1.0e-4);
    begin_frame(1.0e-6 * (double)(own.time_us - r->ordered_us));
    if (turned) {
        frame.early_m = frame.late_m = 0.0f;
    }
    memset(&way, 0, sizeof way);
    goe_flight_clear_relate(&frame, r->target_ned_m, way.target_m);
    goe_flight_clear_direct(&frame, r->course_ne, way.line_m);
    way.shifts = true;
    way.sigmas = 1.0f;
    const float loiter_m = flight.settings.loiter_m;
    const float circle_m = loiter_m > (float)turn_m() ? loiter_m : (float)turn_m();
    way.circle_m = r->action == GOE_FLIGHT_HOLD || loiter_m > 0.0f ? circle_m : 0.0f;
    if (way.circle_m > 0.0f) {
        way.turns_away = r->action == GOE_FLIGHT_HOLD || !(way.target_m[0] > 0.0f);
    } else {
        const double on_m = fmax(2.0 * turn_m() - (double)way.target_m[0], 0.0);
        way.target_m[0] += (float)on_m * way.line_m[0];
        way.target_m[1] += (float)on_m * way.line_m[1];
        way.turns_away = !is_more((double)way.target_m[0], 0.0, NEAR_TIE_M);
    }
    return share_of(&way);
}

/* The next one on the line of those in the way: the nearest ahead except those on the outer side of a side. */
static int next_of(double aside_m) {
    double least_m = 1.0e4;
    int next = -1;
    for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
        const goe_flight_reaction_t *r = &flight.reaction;
        const double north = (double)(flight.slot[i].center_ne_m[0] - own.ned_m[0]);
        const double east = (double)(flight.slot[i].center_ne_m[1] - own.ned_m[1]);
        const double right_m = line[0] * east - line[1] * north;
        const bool is_side = r->action == GOE_FLIGHT_LEFT || r->action == GOE_FLIGHT_RIGHT;
        const bool outside = is_side && i != r->slot && is_more((double)r->side * right_m, 0.0, NEAR_TIE_M);
        const double ahead_m = course[0] * north + course[1] * east;
        if (slots[i].counts && is_in_the_way(i, aside_m) && !outside && is_more(least_m, ahead_m, NEAR_TIE_M)) {
            next = i;
            least_m = ahead_m;
        }
    }
    return next;
}

/* Ahead of the origin on the line, and how far to the right a side leads: past the outline, the margin, two sigmas and the circle. */
static void lead_past(int i, int side, double *ahead_m, double *aside_m) {
    const goe_flight_slot_t *slot = &flight.slot[i];
    const double place[2] = {(double)slot->center_ne_m[0], (double)slot->center_ne_m[1]};
    const float *v = slot->covariance_ne_m2;
    const double variance =
        line[1] * line[1] * (double)v[0] - 2.0 * line[0] * line[1] * (double)v[1] + line[0] * line[0] * (double)v[2];
    const double circle_m = flight.settings.loiter_m > 0.0f ? fmax((double)flight.settings.loiter_m, turn_m()) : 0.0;
    const double beyond_m =
        0.5 * (double)slot->width_m + (double)flight.settings.margin_m + circle_m + 2.0 * sqrt(fmax(variance, 0.0));
    *ahead_m = line[0] * place[0] + line[1] * place[1];
    *aside_m = line[0] * place[1] - line[1] * place[0] + (double)side * beyond_m;
}

/* The obstacle of an order to a side lies ahead, and the way past it is farther out than that past the next. */
static bool is_farther_out(const goe_flight_reaction_t *r, int next) {
    double ahead_m[2];
    double aside_m[2];
    lead_past(r->slot, r->side, &ahead_m[0], &aside_m[0]);
    lead_past(next, r->side, &ahead_m[1], &aside_m[1]);
    const bool ahead = is_more(ahead_m[0], own_ahead_m, NEAR_TIE_M);
    const bool farther = is_more((double)r->side * aside_m[0], (double)r->side * aside_m[1], NEAR_TIE_M);
    return r->action != GOE_FLIGHT_HOLD && slots[r->slot].counts && ahead && farther;
}

/* ------------------------------------------------------------------------------------------------------------- tests -- */

/* [flight.hold_s, goe_flight_assessment_t.clear_m]
 * GIVEN any active order THEN it ends once nothing is in the way and the way back is clear: at once if its obstacle lies behind,
 * else after hold_s. Till then it reports how clear it is, and turns to the next obstacle once its own is out of the way, but not back into
 * an obstacle ahead. */
static void an_order_stays_active_as_long_as_something_is_in_the_way(void) {
    int ended = 0;
    int waits = 0;
    int turned_to = 0;
    int reported = 0;
    for (int n = 0; n < TRIALS; n++) {
        any_standing_order();
        const goe_flight_reaction_t before = flight.reaction;
        const bool up = before.action == GOE_FLIGHT_CLIMB || before.action == GOE_FLIGHT_GO_AROUND;
        bool any_in_the_way = false;
        bool own_in_the_way = false;
        near_tie = false;
        begin_frame(0.0);
        const double aside_m = up ? 0.0 : farthest_aside_m();
        for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
            const bool in_the_way = (up ? is_above_the_line(i) : slots[i].counts) && is_in_the_way(i, aside_m);
            any_in_the_way = any_in_the_way || in_the_way;
            own_in_the_way = own_in_the_way || (in_the_way && i == before.slot);
        }
        const int next = any_in_the_way ? next_of(aside_m) : -1;
        const bool over = !any_in_the_way && (up || is_way_back_clear(aside_m));
        const bool turns =
            !up && before.slot >= 0 && any_in_the_way && !own_in_the_way && next >= 0 && !is_farther_out(&before, next);
        goe_flight_reaction_t followed = before;
        if (turns && before.action != GOE_FLIGHT_HOLD) {
            double at_m[2];
            lead_past(next, before.side, &at_m[0], &at_m[1]);
            followed.target_ned_m[0] = (float)(at_m[0] * line[0] - at_m[1] * line[1]);
            followed.target_ned_m[1] = (float)(at_m[0] * line[1] + at_m[1] * line[0]);
        }
        const double share = up ? 0.0 : share_of_order(&followed);
        bool behind = false;
        if (before.slot >= 0) {
            const float *at_ne_m = flight.slot[before.slot].center_ne_m;
            const double ahead_m =
                line[0] * (double)(at_ne_m[0] - own.ned_m[0]) + line[1] * (double)(at_ne_m[1] - own.ned_m[1]);
            behind = is_more(0.0, ahead_m, NEAR_TIE_M);
        }
        if (near_tie) {
            continue;
        }
        (void)goe_flight_reaction_decide(&flight, -1, &own);
        const goe_flight_reaction_t *r = &flight.reaction;
        const bool ends = over && (behind || !(flight.settings.hold_s > 0.0f));
        TEST_ASSERT_EQUAL(ends, r->action == GOE_FLIGHT_NONE);
        if (ends) {
            ended++;
            TEST_ASSERT_EQUAL(before.side, r->side);
            TEST_ASSERT_EQUAL(before.changes, r->changes);
            TEST_ASSERT_EQUAL_UINT32(own.time_us, r->falling_us);
            TEST_ASSERT_EQUAL_MEMORY(before.from_ned_m, r->from_ned_m, sizeof r->from_ned_m);
            TEST_ASSERT_EQUAL_MEMORY(before.course_ne, r->course_ne, sizeof r->course_ne);
            continue;
        }
        if (!(share < 0.0) || up) { /* otherwise another way may be found at once */
            TEST_ASSERT_EQUAL(over, r->falling);
            TEST_ASSERT_EQUAL(turns ? next : before.slot, r->slot);
            waits += over ? 1 : 0;
            turned_to += turns ? 1 : 0;
        }
        if (!up && share > 0.0) {
            CHECK_CLOSE(0.02, share * (double)flight.settings.margin_m, r->clear_m);
            CHECK_CLOSE(0.02, followed.target_ned_m[0], r->target_ned_m[0]);
            CHECK_CLOSE(0.02, followed.target_ned_m[1], r->target_ned_m[1]);
            reported++;
        }
    }
    check_report("ended", (double)ended);
    check_report("over, and waits", (double)waits);
    check_report("turned to the next", (double)turned_to);
    check_report("clear", (double)reported);
    TEST_ASSERT_TRUE(ended > 300 && waits > 100 && turned_to > 50 && reported > 1000);
}

/* [goe_flight_assessment_t.clear_m] GIVEN a target less than a meter ahead that is circled THEN the way to it is flown, and no turn away. */
static void a_target_just_ahead_is_flown_to(void) {
    int reported = 0;
    for (int n = 0; n < TRIALS / 3; n++) {
        any_standing_order();
        goe_flight_reaction_t *r = &flight.reaction;
        const double to_m[2] = {between(0.1, 0.9), between(-60.0, 60.0)};
        flight.settings.loiter_m = 100.0f;
        flight.settings.hold_s = 60.0f;
        r->action = one_in(2) ? GOE_FLIGHT_LEFT : GOE_FLIGHT_RIGHT;
        r->side = r->action == GOE_FLIGHT_LEFT ? -1 : 1;
        r->slot = -1;
        r->target_ned_m[0] = own.ned_m[0] + (float)(to_m[0] * course[0] - to_m[1] * course[1]);
        r->target_ned_m[1] = own.ned_m[1] + (float)(to_m[0] * course[1] + to_m[1] * course[0]);
        near_tie = false;
        const double share = share_of_order(r);
        if (near_tie || !(share > 0.0)) {
            continue;
        }
        (void)goe_flight_reaction_decide(&flight, -1, &own);
        TEST_ASSERT_NOT_EQUAL(GOE_FLIGHT_NONE, r->action);
        CHECK_CLOSE(0.02, share * (double)flight.settings.margin_m, r->clear_m);
        reported++;
    }
    check_report("clear", (double)reported);
    TEST_ASSERT_TRUE(reported > 100);
}

/* ------------------------------------------------------------------------------------------------------------ choice -- */

typedef struct {
    goe_flight_action_t action;
    double share, cost_s, needed_s;
    double target_m[2], down_m; /* ahead, right */
} choice_t;

typedef struct {
    double ahead_m, right_m, radius_m, keep_m, rise_m;
    bool has_top, counts, is_on_course;
} met_t;

static met_t meet(int i) {
    const goe_flight_slot_t *slot = &flight.slot[i];
    const goe_flight_settings_t *settings = &flight.settings;
    const double doubt = slot->suspect ? (double)settings->suspect_factor : 1.0;
    const double top_m = (double)slot->top_m + 2.0 * (double)slot->top_sd_m + doubt * (double)settings->clearance_m;
    met_t met;
    met.counts = slots[i].counts;
    met.ahead_m = (double)slots[i].at_m[0];
    met.right_m = (double)slots[i].at_m[1];
    met.radius_m = (double)slots[i].radius_m;
    met.keep_m = 0.5 * (double)slot->width_m + doubt * (double)settings->margin_m +
                 2.0 * sqrt(fmax((double)slots[i].variance_m2[2], 0.0));
    met.is_on_course = false;
    met.has_top = (slot->valid & GOE_HAS_HEIGHT) != 0u;
    met.rise_m = met.has_top ? fmax((double)own.ned_m[2] - ((double)slot->ground_down_m - top_m), 0.0)
                             : (double)settings->clearance_m;
    met.is_on_course =
        slot->used && is_more(met.ahead_m, 0.0, NEAR_TIE_M) && is_more(met.keep_m, fabs(met.right_m), NEAR_TIE_M);
    return met;
}

static double climb_s(double rise_m) {
    return (double)flight.settings.climb_in_s + rise_m / (double)flight.settings.climb_m_s;
}

static double turn_s(double aside_m) {
    const double d = fmin(fmax(aside_m, 0.0), turn_m());
    return (double)flight.settings.roll_in_s + sqrt(d * (2.0 * turn_m() - d)) / SPEED_M_S;
}

/* Of two free ways the one of the lesser cost, else the clearer one. */
static void prefer(choice_t *best, const choice_t *other) {
    const bool free = is_more(other->share, 0.75, NEAR_TIE);
    if (best->action == GOE_FLIGHT_NONE) {
        *best = *other;
    } else if (free && best->share > 0.75) {
        *best = is_more(best->cost_s, other->cost_s, NEAR_TIE) ? *other : *best;
    } else {
        *best = is_more(other->share, best->share, NEAR_TIE) ? *other : *best;
    }
}

/* Over everything on the course, each in time; a top far behind only raises the height. */
static void try_climb(double earliest_tcpa_s, choice_t *best) {
    const met_t about = meet(0);
    choice_t climb = {own.approach ? GOE_FLIGHT_GO_AROUND : GOE_FLIGHT_CLIMB, 1.0, 0.0, 0.0, {0.0, 0.0}, 0.0};
    double rise_m = about.rise_m;
    bool possible = (about.has_top || own.approach) && is_more(earliest_tcpa_s, climb_s(about.rise_m), NEAR_TIE);
    bool is_blind = !about.has_top;
    for (int i = 1; i < GOE_FLIGHT_SLOTS; i++) {
        const met_t other = meet(i);
        if (!flight.slot[i].used || !other.counts || !other.is_on_course) {
            continue;
        }
        const bool is_soon = is_more(about.ahead_m + 2.0 * turn_m(), other.ahead_m, NEAR_TIE_M);
        const double there_s = fmax(other.ahead_m - other.radius_m, 0.0) / SPEED_M_S;
        rise_m = other.has_top || is_soon ? fmax(rise_m, other.rise_m) : rise_m;
        possible = possible &&
                   (!is_soon || ((other.has_top || own.approach) && is_more(there_s, climb_s(other.rise_m), NEAR_TIE)));
        is_blind = is_blind || (is_soon && !other.has_top);
    }
    climb.share = is_blind ? 0.0 : 1.0;
    climb.needed_s = climb.cost_s = climb_s(about.rise_m);
    climb.target_m[0] = about.ahead_m;
    climb.down_m = (double)own.ned_m[2] - rise_m;
    if (possible) {
        prefer(best, &climb);
    }
}

static void try_target(int side, double aside_m, choice_t *best) {
    const double loiter_m = (double)flight.settings.loiter_m;
    const double circle_m = loiter_m > 0.0 ? fmax(loiter_m, turn_m()) : 0.0;
    goe_flight_clear_way_t way;
    choice_t choice = {side < 0 ? GOE_FLIGHT_LEFT : GOE_FLIGHT_RIGHT, 0.0, 0.0, 0.0, {0.0, 0.0}, 0.0};
    memset(&way, 0, sizeof way);
    way.target_m[0] = slots[0].at_m[0];
    way.target_m[1] = (float)(aside_m + (double)side * circle_m);
    way.circle_m = (float)circle_m;
    way.sigmas = 2.0f;
    way.line_m[0] = 1.0f;
    way.shifts = true;
    choice.share = share_of(&way);
    choice.needed_s = turn_s((double)side * aside_m);
    choice.cost_s = choice.needed_s + 4.0 * (0.9 - fmin(choice.share, 0.9));
    choice.target_m[0] = (double)way.target_m[0];
    choice.target_m[1] = (double)way.target_m[1];
    choice.down_m = (double)own.ned_m[2];
    prefer(best, &choice);
}

/* Past its outline; farther out past that of another one; in the middle of the gap between the two. */
static void try_side(int side, choice_t *best) {
    const met_t about = meet(0);
    const double base_m = about.right_m + side * about.keep_m;
    const double wall_m = about.right_m + side * about.radius_m;
    if (!is_more(turn_m(), side * base_m, NEAR_TIE_M)) {
        return;
    }
    try_target(side, base_m, best);
    for (int i = 1; i < GOE_FLIGHT_SLOTS; i++) {
        const met_t other = meet(i);
        if (!flight.slot[i].used || !other.counts || !is_more(other.ahead_m, -turn_m(), NEAR_TIE_M) ||
            !is_more(2.0 * turn_m(), other.ahead_m - about.ahead_m, NEAR_TIE_M)) {
            continue;
        }
        const double inner_m = other.right_m - side * other.radius_m;
        const double edge_m = other.right_m + side * other.keep_m;
        const double middle_m = 0.5 * (wall_m + inner_m);
        if (is_more(side * edge_m, side * base_m, NEAR_TIE_M)) {
            try_target(side, edge_m, best);
        }
        if (is_more(side * inner_m, side * wall_m, NEAR_TIE_M) && is_more(side * base_m, side * middle_m, NEAR_TIE_M)) {
            try_target(side, middle_m, best);
        }
    }
}

static choice_t best_hold(void) {
    choice_t best = {GOE_FLIGHT_HOLD, -100.0, 0.0, turn_s(turn_m()), {0.0, 0.0}, (double)own.ned_m[2]};
    const double loiter_m = (double)flight.settings.loiter_m;
    const double circle_m = fmax(loiter_m, turn_m());
    const bool is_right = is_more((double)slots[0].at_m[1], 0.0, NEAR_TIE_M);
    for (int k = 0; k < 4; k++) {
        const double side = (k < 2) == is_right ? -1.0 : 1.0;
        goe_flight_clear_way_t way;
        memset(&way, 0, sizeof way);
        way.target_m[0] = k % 2 == 1 ? frame.late_m : 0.0f;
        way.target_m[1] = (float)(side * (k % 2 == 1 ? circle_m : 2.0 * turn_m() + loiter_m));
        way.circle_m = (float)circle_m;
        way.sigmas = 2.0f;
        way.turns_away = true;
        const double share = fmin(share_of(&way), 1.0);
        near_tie = near_tie || (fabs(share - best.share) < NEAR_TIE && share < 1.0);
        if (share > best.share) {
            best.share = share;
            best.target_m[0] = (double)way.target_m[0];
            best.target_m[1] = (double)way.target_m[1];
        }
    }
    return best;
}

static choice_t choose(double earliest_tcpa_s) {
    choice_t best = {GOE_FLIGHT_NONE, -100.0, 0.0, 0.0, {0.0, 0.0}, 0.0};
    choice_t climb = best;
    try_climb(earliest_tcpa_s, &climb);
    if (climb.action == GOE_FLIGHT_GO_AROUND && climb.share > 0.75) {
        return climb;
    }
    try_side(1, &best);
    try_side(-1, &best);
    if (climb.action == GOE_FLIGHT_CLIMB) {
        prefer(&best, &climb);
    }
    if (best.action != GOE_FLIGHT_NONE && is_more(best.share, 0.75, NEAR_TIE)) {
        return best;
    }
    const choice_t hold = best_hold();
    const choice_t level = best.action == GOE_FLIGHT_NONE || is_more(hold.share, 0.5, NEAR_TIE) ||
                                   is_more(hold.share, best.share + 0.2, NEAR_TIE)
                               ? hold
                               : best;
    const bool blind = climb.action == GOE_FLIGHT_GO_AROUND; /* over a top that is not known */
    return blind && !is_more(level.share, climb.share, NEAR_TIE) ? climb : level;
}

/* An obstacle ahead that is surely a hazard, among others that are none. */
static void any_hazard(void) {
    any_standing_order();
    goe_flight_reaction_clear(&flight.reaction);
    flight.settings.confirm_s = 0.0f;
    own.approach = one_in(4);
    for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
        goe_flight_slot_t *slot = &flight.slot[i];
        const double ahead_m = i == 0 ? between(50.0, 180.0) : between(-60.0, 320.0);
        const double right_m = i == 0 ? between(-15.0, 15.0) : one_in(3) ? between(-10.0, 10.0) : between(-90.0, 90.0);
        slot->used = i == 0 || slot->used;
        slot->suspect = one_in(6);
        slot->top_m = one_in(2) ? (float)between(8.0, 25.0) : 80.0f;
        slot->top_sd_m = one_in(3) ? 1.5f : 0.0f;
        slot->width_m = one_in(6) ? 110.0f : (float)between(1.0, 20.0);
        slot->taken_us = own.time_us;
        slot->center_ne_m[0] = own.ned_m[0] + (float)(ahead_m * course[0] - right_m * course[1]);
        slot->center_ne_m[1] = own.ned_m[1] + (float)(ahead_m * course[1] + right_m * course[0]);
    }
    flight.slot[0].valid = (uint8_t)(flight.slot[0].valid | GOE_HAS_POSITION | GOE_HAS_WIDTH);
    flight.slot[0].assessed = true;
    flight.slot[0].hazard.conflict_probability = 1.0f;
    flight.slot[0].hazard.tcpa_s = (float)between(1.0, 9.0);
}

/* [flight.margin_m, flight.clearance_m, flight.bank_deg, flight.climb_m_s, goe_flight_assessment_t.needed_s]
 * GIVEN any obstacles THEN the chosen way, its point, its height and its reports are those of the rule. */
static void the_way_that_is_taken_is_that_of_the_rule(void) {
    int taken[GOE_FLIGHT_HOLD + 1] = {0, 0, 0, 0, 0, 0};
    for (int n = 0; n < TRIALS; n++) {
        any_hazard();
        near_tie = false;
        begin_frame(0.0);
        const double earliest_tcpa_s = (double)flight.slot[0].hazard.tcpa_s;
        const choice_t choice = choose(earliest_tcpa_s);
        const bool due = is_more(choice.needed_s + (double)flight.settings.reserve_s, earliest_tcpa_s, NEAR_TIE);
        const bool late = is_more(choice.needed_s, earliest_tcpa_s, NEAR_TIE);
        if (near_tie) {
            continue;
        }
        const float needed_s = goe_flight_reaction_decide(&flight, 0, &own);
        const goe_flight_reaction_t *r = &flight.reaction;
        CHECK_CLOSE(2.0e-3, choice.needed_s, needed_s);
        TEST_ASSERT_EQUAL(due ? choice.action : GOE_FLIGHT_NONE, r->action);
        taken[r->action]++;
        if (!due) {
            continue;
        }
        const bool up = choice.action == GOE_FLIGHT_CLIMB || choice.action == GOE_FLIGHT_GO_AROUND;
        const double free = choice.action == GOE_FLIGHT_HOLD ? 0.5 : 0.75;
        const double north = choice.target_m[0] * course[0] - choice.target_m[1] * course[1];
        const double east = choice.target_m[0] * course[1] + choice.target_m[1] * course[0];
        CHECK_CLOSE(0.05, (double)own.ned_m[0] + north, r->target_ned_m[0]);
        CHECK_CLOSE(0.05, (double)own.ned_m[1] + east, r->target_ned_m[1]);
        CHECK_CLOSE(0.01, choice.down_m, r->target_ned_m[2]);
        TEST_ASSERT_EQUAL(late, r->late);
        TEST_ASSERT_EQUAL(0, r->slot);
        TEST_ASSERT_EQUAL(choice.share > free ? GOE_FLIGHT_REASON_CLEAR : GOE_FLIGHT_REASON_LEAST_BAD, r->reason);
        CHECK_CLOSE(0.03, up ? 0.0 : choice.share * (double)flight.settings.margin_m, r->clear_m);
        TEST_ASSERT_EQUAL_UINT32(own.time_us, r->ordered_us);
        TEST_ASSERT_EQUAL_MEMORY(own.ned_m, r->from_ned_m, sizeof r->from_ned_m);
        CHECK_CLOSE(1.0e-5, course[0], r->course_ne[0]);
        CHECK_CLOSE(1.0e-5, course[1], r->course_ne[1]);
    }
    for (int i = 0; i <= GOE_FLIGHT_HOLD; i++) {
        check_report(goe_flight_action_text((goe_flight_action_t)i), (double)taken[i]);
        TEST_ASSERT_TRUE(taken[i] > 50);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(the_way_that_is_taken_is_that_of_the_rule);
    RUN_TEST(a_target_just_ahead_is_flown_to);
    RUN_TEST(an_order_stays_active_as_long_as_something_is_in_the_way);
    return UNITY_END();
}
