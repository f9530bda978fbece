/* How clear a standing order is, when it ends, and how to hold: against plain models of the README's rule. SPDX-License-Identifier: MIT
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
    any = check_random_start("flight ends");
    flown_start(&flown, NULL);
    plain = flown.flight;
}
void tearDown(void) {}

static double between(double low, double high) { return check_random_between(&any, low, high); }
static bool one_in(int n) { return between(0.0, (double)n) < 1.0; }
static double turn_m(void) { return SPEED_M_S * SPEED_M_S / (GRAVITY_M_S2 * tan(30.0 * PI / 180.0)); }

/* An order on a line through the origin, and an aircraft beside it; whatever stands about. */
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

/* Not behind by its radius and the margin, nor beyond what is needed to avoid it again, nor aside of both the line and the aircraft. */
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

/* The next one on the line of those in the way: the nearest ahead but for what stands on the outer side of a side. */
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

/* An order to a side that turns to another obstacle leads past its outline, with the margin, two sigmas and the circle. */
static void lead_past(int i, goe_flight_reaction_t *r) {
    const goe_flight_slot_t *slot = &flight.slot[i];
    const double place[2] = {(double)slot->center_ne_m[0], (double)slot->center_ne_m[1]};
    const double ahead_m = line[0] * place[0] + line[1] * place[1];
    const double right_m = line[0] * place[1] - line[1] * place[0];
    const float *v = slot->covariance_ne_m2;
    const double variance =
        line[1] * line[1] * (double)v[0] - 2.0 * line[0] * line[1] * (double)v[1] + line[0] * line[0] * (double)v[2];
    const double circle_m = flight.settings.loiter_m > 0.0f ? fmax((double)flight.settings.loiter_m, turn_m()) : 0.0;
    const double beyond_m =
        0.5 * (double)slot->width_m + (double)flight.settings.margin_m + circle_m + 2.0 * sqrt(fmax(variance, 0.0));
    const double aside_m = right_m + (double)r->side * beyond_m;
    r->target_ned_m[0] = (float)(ahead_m * line[0] - aside_m * line[1]);
    r->target_ned_m[1] = (float)(ahead_m * line[1] + aside_m * line[0]);
}

/* ------------------------------------------------------------------------------------------------------------- tests -- */

/* [flight.hold_s, goe_flight_assessment_t.clear_m]
 * GIVEN any order that stands THEN it ends once nothing is in the way and the way back is clear: at once if its obstacle lies behind,
 * else after hold_s. Till then it tells how clear it is, and turns to the next obstacle once its own is out of the way. */
static void an_order_stands_as_long_as_something_is_in_the_way(void) {
    int ended = 0;
    int waits = 0;
    int turned_to = 0;
    int told = 0;
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
            const bool in_the_way = slots[i].counts && is_in_the_way(i, aside_m);
            any_in_the_way = any_in_the_way || in_the_way;
            own_in_the_way = own_in_the_way || (in_the_way && i == before.slot);
        }
        const int next = any_in_the_way ? next_of(aside_m) : -1;
        const bool over = !any_in_the_way && (up || is_way_back_clear(aside_m));
        const bool turns = !up && before.slot >= 0 && any_in_the_way && !own_in_the_way && next >= 0;
        goe_flight_reaction_t followed = before;
        if (turns && before.action != GOE_FLIGHT_HOLD) {
            lead_past(next, &followed);
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
            TEST_ASSERT_EQUAL_MEMORY(before.from_ne_m, r->from_ne_m, sizeof r->from_ne_m);
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
            told++;
        }
    }
    check_report("ended", (double)ended);
    check_report("over, and waits", (double)waits);
    check_report("turned to the next", (double)turned_to);
    check_report("clear", (double)told);
    TEST_ASSERT_TRUE(ended > 300 && waits > 100 && turned_to > 50 && told > 1000);
}

/* GIVEN a wall that is too wide to be passed THEN HOLD is ordered on the way that is clearest, up to the whole margin, of four: to the side
 * where less of the wall stands first, about a point abeam or at once. */
static void to_hold_takes_the_clearest_of_four_ways(void) {
    int held = 0;
    for (int n = 0; n < TRIALS; n++) {
        double best = -100.0;
        double target_m[2] = {0.0, 0.0};
        any_standing_order();
        goe_flight_reaction_clear(&flight.reaction);
        flight.settings.confirm_s = 0.0f;
        const double wall_right_m = between(-20.0, 20.0);
        const double wall_ahead_m = between(100.0, 170.0);
        goe_flight_slot_t *wall = &flight.slot[0];
        wall->used = wall->assessed = true;
        wall->valid = GOE_HAS_POSITION | GOE_HAS_WIDTH;
        wall->width_m = (float)between(150.0, 190.0);
        wall->center_ne_m[0] = own.ned_m[0] + (float)(wall_ahead_m * course[0] - wall_right_m * course[1]);
        wall->center_ne_m[1] = own.ned_m[1] + (float)(wall_ahead_m * course[1] + wall_right_m * course[0]);
        wall->hazard.violation = 1.0f;
        wall->hazard.time_s = 3.0f;
        near_tie = false;
        begin_frame(0.0);
        const double loiter_m = (double)flight.settings.loiter_m;
        const double circle_m = fmax(loiter_m, turn_m());
        for (int k = 0; k < 4; k++) {
            const double side = (k < 2) == (wall_right_m > 0.0) ? -1.0 : 1.0;
            goe_flight_clear_way_t way;
            memset(&way, 0, sizeof way);
            way.target_m[0] = k % 2 == 1 ? frame.late_m : 0.0f;
            way.target_m[1] = (float)(side * (k % 2 == 1 ? circle_m : 2.0 * turn_m() + loiter_m));
            way.circle_m = (float)circle_m;
            way.sigmas = 2.0f;
            way.turns_away = true;
            const double share = fmin(share_of(&way), 1.0);
            near_tie = near_tie || (fabs(share - best) < NEAR_TIE && share < 1.0);
            if (share > best) {
                best = share;
                target_m[0] = (double)way.target_m[0];
                target_m[1] = (double)way.target_m[1];
            }
        }
        const int changes = flight.reaction.changes;
        (void)goe_flight_reaction_decide(&flight, 0, &own);
        const goe_flight_reaction_t *r = &flight.reaction;
        if (near_tie || fabs(wall_right_m) < NEAR_TIE_M || r->action != GOE_FLIGHT_HOLD) {
            continue;
        }
        held++;
        TEST_ASSERT_EQUAL(changes, r->changes);
        CHECK_CLOSE(0.02, (double)own.ned_m[0] + target_m[0] * course[0] - target_m[1] * course[1], r->target_ned_m[0]);
        CHECK_CLOSE(0.02, (double)own.ned_m[1] + target_m[0] * course[1] + target_m[1] * course[0], r->target_ned_m[1]);
        CHECK_CLOSE(0.02, best * (double)flight.settings.margin_m, r->clear_m);
        TEST_ASSERT_EQUAL(best >= 0.5 ? GOE_FLIGHT_REASON_CLEAR : GOE_FLIGHT_REASON_LEAST_BAD, r->reason);
        TEST_ASSERT_EQUAL(target_m[1] < 0.0 ? -1 : 1, r->side);
    }
    check_report("held", (double)held);
    TEST_ASSERT_TRUE(held > 500);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(an_order_stands_as_long_as_something_is_in_the_way);
    RUN_TEST(to_hold_takes_the_clearest_of_four_ways);
    return UNITY_END();
}
