/* Where an order is given or withheld, what it clears and when it ends, with more than one obstacle. SPDX-License-Identifier: MIT
 *
 * Obstacles are written straight into the table, as in test_flight_reaction.c. */
#include <math.h>
#include <string.h>

#include "flown.h"
#include "goe_clear.h"
#include "goe_reaction.h"
#include "goe_slot.h"

#define SPEED_M_S 20.0f

static goe_flight_t flight;
static goe_flight_reaction_own_t own;

/* A mast of 6 m diameter; see test_flight_reaction.c. */
static void put(int slot, float ahead_m, float right_m, float top_m) {
    goe_flight_slot_t *s = &flight.slot[slot];
    s->used = s->assessed = true;
    s->valid = GOE_HAS_POSITION | GOE_HAS_WIDTH | GOE_HAS_HEIGHT;
    s->center_ne_m[0] = ahead_m;
    s->center_ne_m[1] = right_m;
    s->width_m = 6.0f;
    s->top_m = top_m;
    s->hazard.conflict_probability = fabsf(right_m) < 18.0f && ahead_m > own.ned_m[0] ? 1.0f : 0.0f;
    s->hazard.tcpa_s = (ahead_m - own.ned_m[0] - 3.0f) / SPEED_M_S;
}

static void start(float loiter_m) {
    static flown_t flown;
    goe_flight_settings_t settings;
    goe_flight_settings_default(&settings);
    settings.loiter_m = loiter_m;
    flown_start(&flown, &settings);
    flight = flown.flight;
    memset(&own, 0, sizeof own);
    own.ned_m[2] = -20.0f;
    flight.velocity_ned_m_s[0] = SPEED_M_S;
}

void setUp(void) { start(0.0f); }
void tearDown(void) {}

static goe_flight_action_t decide(double seconds) {
    for (int k = 0; k <= (int)(seconds * 10.0 + 0.5); k++) {
        for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
            flight.slot[i].taken_us = own.time_us;
        }
        (void)goe_flight_reaction_decide(&flight, 0, &own);
        own.time_us += 100000u;
    }
    return (goe_flight_action_t)flight.reaction.action;
}

static double miss_m(int slot) {
    const float *at = flight.slot[slot].center_ne_m;
    return hypot((double)(at[0] - flight.reaction.target_ned_m[0]), (double)(at[1] - flight.reaction.target_ned_m[1]));
}

/* --------------------------------------------------------------------------------------------------------------- side -- */

/* The nearer side leads to 17.5 m left, and 4 m next to it is a second mast that does not touch the present course. */
static void a_mast_that_is_not_on_the_course_blocks_a_side(void) {
    put(0, 110.0f, 0.5f, 50.0f);
    put(1, 115.0f, -24.0f, 50.0f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_RIGHT, decide(0.5));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_REASON_CLEAR, flight.reaction.reason);
    TEST_ASSERT_TRUE(miss_m(0) >= 17.9 && miss_m(1) >= 17.9);
}

/* Its sigma counts: 22 m beyond the target it is free, but not with 6 m of one sigma. */
static void a_place_that_is_hardly_known_blocks_a_side(void) {
    for (int unsure = 0; unsure < 2; unsure++) {
        start(0.0f);
        put(0, 110.0f, 0.5f, 50.0f);
        put(1, 110.0f, -39.5f, 50.0f);
        flight.slot[1].covariance_ne_m2[2] = unsure ? 36.0f : 0.0f;
        TEST_ASSERT_EQUAL(unsure ? GOE_FLIGHT_RIGHT : GOE_FLIGHT_LEFT, decide(0.5));
    }
}

/* So does its age: 10 s without an image. */
static void an_old_place_blocks_a_side(void) {
    put(0, 110.0f, 0.5f, 50.0f);
    put(1, 110.0f, -39.5f, 50.0f);
    flight.slot[1].age_s = 10.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_RIGHT, decide(0.5));
}

/* A mast that is surely passed over blocks nothing. */
static void a_low_one_blocks_no_side(void) {
    put(0, 110.0f, 0.5f, 50.0f);
    put(1, 110.0f, -20.0f, 8.0f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.5));
}

/* An autopilot that circles its target with 80 m comes to 178 m left of the line. */
static void the_circle_about_the_target_is_kept_clear(void) {
    put(0, 125.0f, 0.5f, 50.0f);
    put(1, 125.0f, -150.0f, 50.0f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.5)); /* with nothing next to it where the aircraft flies through */
    start(80.0f);
    put(0, 125.0f, 0.5f, 50.0f);
    put(1, 125.0f, -150.0f, 50.0f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_RIGHT, decide(0.5));
    TEST_ASSERT_TRUE(miss_m(0) >= 80.0 + 17.9 && miss_m(1) >= 80.0 + 17.9);
}

/* [flight.reserve_s] GIVEN a sure hazard whose order is due WHEN another obstacle leaves less time, too little even, and is unlikely to be in the
 * way THEN the order comes all the same. */
static void an_unlikely_obstacle_delays_no_order(void) {
    for (int unsure = 0; unsure < 2; unsure++) {
        start(0.0f);
        put(0, 125.0f, 0.5f, 50.0f);
        if (unsure) {
            put(1, 60.0f, 5.0f, 50.0f);
            flight.slot[1].covariance_ne_m2[0] = flight.slot[1].covariance_ne_m2[2] = 900.0f;
            flight.slot[1].hazard.tcpa_sd_s = 1.5f;
            flight.slot[1].hazard.conflict_probability = 0.3f;
        }
        TEST_ASSERT_NOT_EQUAL(GOE_FLIGHT_NONE, decide(0.5));
        TEST_ASSERT_EQUAL(0, flight.reaction.slot);
    }
}

/* GIVEN up to two obstacles that are unlikely to be in the way, for which it is too late, and the first of which is the worst WHEN the order
 * against a sure hazard behind them is due THEN it comes all the same. */
static void an_unlikely_worst_obstacle_delays_no_order(void) {
    for (int unsure = 0; unsure <= 2; unsure++) {
        start(0.0f);
        put(2, 125.0f, 0.5f, 50.0f);
        for (int i = 0; i < unsure; i++) {
            put(i, 60.0f + 10.0f * (float)i, 5.0f, 50.0f);
            flight.slot[i].covariance_ne_m2[0] = flight.slot[i].covariance_ne_m2[2] = 900.0f;
            flight.slot[i].hazard.tcpa_sd_s = 1.5f;
            flight.slot[i].hazard.conflict_probability = 0.4f;
        }
        TEST_ASSERT_NOT_EQUAL(GOE_FLIGHT_NONE, decide(0.5));
        TEST_ASSERT_EQUAL(2, flight.reaction.slot);
    }
}

/* GIVEN two or three obstacles that are unlikely to be in the way, and for which it is too late WHEN a hazard behind them is unlikely, too, but there
 * is time for its order THEN that comes all the same. */
static void unlikely_obstacles_delay_no_order_in_time(void) {
    for (int unsure = 0; unsure <= 3; unsure++) {
        start(0.0f);
        for (int i = 0; i < unsure; i++) {
            put(i, 60.0f + 10.0f * (float)i, 5.0f, 50.0f);
            flight.slot[i].covariance_ne_m2[0] = flight.slot[i].covariance_ne_m2[2] = 900.0f;
            flight.slot[i].hazard.tcpa_sd_s = 1.5f;
            flight.slot[i].hazard.conflict_probability = 0.4f;
        }
        put(3, 115.0f, 8.0f, 50.0f);
        flight.slot[3].hazard.conflict_probability = 0.45f;
        if (unsure == 0) {
            flight.slot[0] = flight.slot[3];
            flight.slot[3].used = false;
        }
        TEST_ASSERT_NOT_EQUAL(GOE_FLIGHT_NONE, decide(0.5));
        TEST_ASSERT_EQUAL(unsure == 0 ? 0 : 3, flight.reaction.slot);
        TEST_ASSERT_FALSE(flight.reaction.late);
    }
}

/* GIVEN a passed obstacle that is the worst, because it is next to the aircraft WHEN others are ahead THEN the order against the worst of these
 * comes all the same, and not against one that is no hazard. */
static void a_passed_obstacle_delays_no_order(void) {
    for (int kind = 0; kind < 3; kind++) {
        start(0.0f);
        put(0, -2.0f, 12.0f, 50.0f);
        flight.slot[0].hazard.conflict_probability = 1.0f;
        flight.slot[0].hazard.tcpa_s = 0.0f;
        put(1, 125.0f, 0.5f, 50.0f);
        flight.slot[1].hazard.conflict_probability = kind == 2 ? 0.09f : 1.0f;
        if (kind == 1) { /* it leaves less time, and is unlikely to be in the way */
            put(2, 60.0f, 5.0f, 50.0f);
            flight.slot[2].covariance_ne_m2[0] = flight.slot[2].covariance_ne_m2[2] = 900.0f;
            flight.slot[2].hazard.tcpa_sd_s = 1.5f;
            flight.slot[2].hazard.conflict_probability = 0.3f;
        }
        TEST_ASSERT_EQUAL(kind == 2, decide(0.5) == GOE_FLIGHT_NONE);
        TEST_ASSERT_EQUAL(kind == 2 ? -1 : 1, flight.reaction.slot);
    }
}

/* A circle of 30 m cannot be flown at 20 m/s and 30 degrees of bank: the target keeps the turn's 71 m away. */
static void a_circle_is_never_smaller_than_the_turn(void) {
    start(30.0f);
    put(0, 125.0f, 0.5f, 50.0f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.5));
    TEST_ASSERT_TRUE(miss_m(0) >= 70.6 + 17.9);
}

/* Four of 44 m across the course, 16 m of clear width between them. */
static void put_wall(float ahead_m) {
    for (int i = 0; i < 4; i++) {
        put(i, ahead_m, -88.0f + 60.0f * (float)i, 50.0f);
        flight.slot[i].width_m = 44.0f;
        flight.slot[i].hazard.conflict_probability = i == 1 || i == 2 ? 1.0f : 0.0f;
    }
}

/* It is not passed where there is room to turn away. */
static void a_wall_of_masts_is_a_reason_to_hold(void) {
    put_wall(160.0f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_HOLD, decide(0.5));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_REASON_CLEAR, flight.reaction.reason);
    TEST_ASSERT_TRUE(flight.reaction.clear_m >= 7.5f);
}

/* A wall that is known too late to be turned away from: the middle of the gap keeps 8 m and is taken, and called the least bad. */
static void a_blocked_aircraft_reports_it(void) {
    put_wall(60.0f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_RIGHT, decide(0.5));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_REASON_LEAST_BAD, flight.reaction.reason);
    CHECK_CLOSE(0.1, 2.0, flight.reaction.target_ned_m[1]);
    TEST_ASSERT_TRUE(flight.reaction.clear_m > 5.0f && flight.reaction.clear_m < 8.1f);
}

/* A new mast on the way of an active order: the order goes farther out on its side. */
static void a_standing_order_evades_to_its_own_side_first(void) {
    put(0, 130.0f, 0.5f, 50.0f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.5));
    put(1, 150.0f, -20.0f, 50.0f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.5));
    TEST_ASSERT_TRUE(flight.reaction.target_ned_m[1] < -37.0f);
    TEST_ASSERT_EQUAL(0, flight.reaction.changes);
}

static void put_wide(int slot, float ahead_m, float right_m, float width_m) {
    put(slot, ahead_m, right_m, 50.0f);
    flight.slot[slot].width_m = width_m;
}

/* GIVEN an order past A WHEN B comes to lie on its way, and only the gap between A and B is left THEN it leads through that, still past A
 * on its side. */
static void an_order_leads_through_a_gap_on_its_side(void) {
    for (int side = -1; side <= 1; side += 2) {
        const float right = (float)side;
        start(0.0f);
        put(0, 110.0f, -0.5f * right, 50.0f);
        TEST_ASSERT_EQUAL(side < 0 ? GOE_FLIGHT_LEFT : GOE_FLIGHT_RIGHT, decide(0.5));
        put(1, 112.0f, 21.0f * right, 50.0f);
        put_wide(2, 112.0f, 80.0f * right, 100.0f);
        put_wide(3, 112.0f, -60.0f * right, 80.0f);
        TEST_ASSERT_EQUAL(side < 0 ? GOE_FLIGHT_LEFT : GOE_FLIGHT_RIGHT, decide(0.5));
        CHECK_CLOSE(0.1, 10.25 * (double)side, flight.reaction.target_ned_m[1]); /* between 2.5 and 18 */
        TEST_ASSERT_EQUAL(side, flight.reaction.side);
        TEST_ASSERT_EQUAL(0, flight.reaction.slot);
        TEST_ASSERT_EQUAL(0, flight.reaction.changes);
    }
}

/* GIVEN an order to a side WHEN that leads into a wide obstacle, and there is no way on its side THEN the other side is flown, once it is
 * clear. */
static void an_order_into_an_obstacle_changes_its_side(void) {
    for (int side = -1; side <= 1; side += 2) {
        const float right = (float)side;
        start(0.0f);
        put(0, 110.0f, -0.5f * right, 50.0f);
        TEST_ASSERT_EQUAL(side < 0 ? GOE_FLIGHT_LEFT : GOE_FLIGHT_RIGHT, decide(0.5));
        put_wide(1, 90.0f, 75.0f * right, 130.0f);
        TEST_ASSERT_EQUAL(side < 0 ? GOE_FLIGHT_RIGHT : GOE_FLIGHT_LEFT, decide(0.0));
        CHECK_CLOSE(0.1, -18.5 * (double)side, flight.reaction.target_ned_m[1]);
        TEST_ASSERT_EQUAL(-side, flight.reaction.side);
        TEST_ASSERT_EQUAL(1, flight.reaction.changes);
    }
}

/* ---------------------------------------------------------------------------------------------------------------- end -- */

/* The order about B is not over while A, which is on the line, is not passed. */
static void an_order_stays_active_while_another_one_is_on_its_line(void) {
    put(0, 100.0f, 0.5f, 50.0f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.5));
    put(1, 90.0f, -60.0f, 50.0f);
    flight.reaction.slot = flight.reaction.edge = 1; /* as if it had been given for that one since */
    flight.slot[0].hazard.conflict_probability = 0.0f;
    TEST_ASSERT_TRUE(decide(4.0) != GOE_FLIGHT_NONE);
}

/* Past A, before B: the order turns to B; past both it ends. */
static void an_order_turns_to_the_next_one_on_its_line(void) {
    put(0, 100.0f, 0.5f, 50.0f);
    put(1, 200.0f, 2.0f, 50.0f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.5));
    own.ned_m[0] = 125.0f;
    own.ned_m[1] = -18.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.5));
    TEST_ASSERT_EQUAL(1, flight.reaction.slot);
    CHECK_CLOSE(0.1, 200.0, flight.reaction.target_ned_m[0]);
    own.ned_m[0] = 225.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_NONE, decide(0.0));
}

/* What an aircraft sinks by in the turn is not the height that another way of the same order keeps. */
static void an_order_that_finds_another_way_does_not_sink_with_the_aircraft(void) {
    put(0, 130.0f, 0.5f, 50.0f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.5));
    CHECK_CLOSE(0.01, -20.0, flight.reaction.target_ned_m[2]);
    own.ned_m[2] = -15.0f;
    put(1, 150.0f, -20.0f, 50.0f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.5));
    TEST_ASSERT_TRUE(flight.reaction.target_ned_m[1] < -37.0f);
    CHECK_CLOSE(0.01, -20.0, flight.reaction.target_ned_m[2]);
}

/* The way back to the line leads past a mast next to the line, which the line itself passes. */
static void an_order_stays_active_while_the_way_back_is_not_clear(void) {
    put(0, 100.0f, 0.5f, 50.0f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.5));
    own.ned_m[0] = 125.0f;
    own.ned_m[1] = -60.0f;
    put(1, 165.0f, -30.0f, 50.0f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.5));
    put(1, 165.0f, -130.0f, 50.0f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_NONE, decide(3.0));
}

/* GIVEN an order that has just ended next to its line WHEN an obstacle lies on the course of the moment, and none on the way back to the
 * line THEN that is no reason for another order; one on the way back is. */
static void an_aircraft_that_flies_back_to_its_line_needs_no_order(void) {
    for (int side = -1; side <= 1; side += 2) {
        for (int blocked = 0; blocked < 2; blocked++) {
            const float right = (float)side;
            start(0.0f);
            own.ned_m[0] = 100.0f;
            own.ned_m[1] = 40.0f * right;
            own.time_us = 5000000u;
            put(0, 225.0f, 45.0f * right, 50.0f);
            flight.slot[0].hazard.conflict_probability = 1.0f;
            put(1, 190.0f, (blocked ? 22.0f : -1.0f) * right, 50.0f);
            flight.slot[1].hazard.conflict_probability = 0.0f;
            flight.reaction.side = (int8_t)side;
            flight.reaction.course_ne[0] = 1.0f;
            flight.reaction.falling_us = own.time_us;
            TEST_ASSERT_EQUAL(blocked, decide(0.5) != GOE_FLIGHT_NONE);
        }
    }
}

/* [flight.suspect_factor, flight.stale_growth_m_s]
 * GIVEN an order past an obstacle that is within its margin only because it is suspect, or old WHEN this hazard is active THEN the order is,
 * too; it ends once the obstacle is behind by the plain margin. */
static void an_order_stays_active_while_its_hazard_is(void) {
    for (int old = 0; old < 2; old++) {
        start(0.0f);
        for (int k = 0; k < 40; k++) {
            put(0, 90.0f, 21.0f, 50.0f);
            flight.slot[0].suspect = !old;
            flight.slot[0].age_s = old ? 4.0f : 0.0f;
            flight.slot[0].hazard.conflict_probability = 0.8f;
            const goe_flight_action_t action = decide(0.0);
            TEST_ASSERT_TRUE(k < 4 || action == GOE_FLIGHT_LEFT);
        }
        own.ned_m[0] = 108.1f;
        put(0, 90.0f, 21.0f, 50.0f);
        TEST_ASSERT_EQUAL(GOE_FLIGHT_NONE, decide(0.0));
    }
}

/* GIVEN an order, or a hazard whose order is withheld WHEN it lasts for hours, in which differences of times wrap THEN its report stays the same. */
static void a_long_time_changes_no_report(void) {
    put_wall(160.0f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_HOLD, decide(3.0));
    const float clear_m = flight.reaction.clear_m;
    for (int k = 0; k < 300; k++) {
        own.time_us += 30000000u;
        TEST_ASSERT_EQUAL(GOE_FLIGHT_HOLD, decide(0.0));
        CHECK_SAME(clear_m, flight.reaction.clear_m);
    }
    start(0.0f);
    own.ned_m[2] = -4.9f;
    put(0, 100.0f, 0.5f, 50.0f);
    (void)decide(1.0);
    for (int k = 0; k < 300; k++) {
        TEST_ASSERT_EQUAL(GOE_FLIGHT_REASON_LOW, flight.reaction.reason);
        own.time_us += 30000000u;
        (void)decide(0.0);
    }
}

/* ------------------------------------------------------------------------------------------------------------ withheld -- */

static void no_order_is_given_too_low(void) {
    own.ned_m[2] = -4.9f;
    put(0, 100.0f, 0.5f, 50.0f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_NONE, decide(1.0));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_REASON_LOW, flight.reaction.reason);
    flight.ground_down_m = 0.2f; /* the ground lies lower */
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.5));
    own.ned_m[2] = -2.0f; /* an active one is not withdrawn */
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.5));
}

/* In a valley the height above the home is negative: that is no height above the ground, and withholds nothing. */
static void a_height_below_the_ground_withholds_no_order(void) {
    own.ned_m[2] = 2.0f * flight.settings.home_sd_m - 0.1f;
    put(0, 100.0f, 0.5f, 50.0f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_NONE, decide(1.0));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_REASON_LOW, flight.reaction.reason);
    own.ned_m[2] = 2.0f * flight.settings.home_sd_m + 0.1f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.5));
}

static void a_height_of_zero_gives_orders_at_any_height(void) {
    flight.settings.order_height_m = 0.0f;
    own.ned_m[2] = 30.0f; /* below the origin */
    put(0, 100.0f, 0.5f, 50.0f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.5));
}

/* [flight.order_speed_m_s] */
static void no_order_is_given_too_slow(void) {
    flight.velocity_ned_m_s[0] = 4.9f;
    put(0, 30.0f, 0.5f, 50.0f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_NONE, decide(1.0));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_REASON_SLOW, flight.reaction.reason);
}

static void no_order_is_given_in_flare_or_after_touchdown(void) {
    own.grounded = true;
    put(0, 100.0f, 0.5f, 8.0f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_NONE, decide(2.0));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_REASON_LANDING, flight.reaction.reason);
    own.grounded = false;
    TEST_ASSERT_TRUE(decide(0.5) != GOE_FLIGHT_NONE);
    own.grounded = true; /* ends an active one */
    TEST_ASSERT_EQUAL(GOE_FLIGHT_NONE, decide(0.0));
}

/* [GOE_FLIGHT_FLYING, goe_flight_assessment_t.hazard, goe_flight_assessment_t.reason]
 * A hangar behind the runway, from the approach to the rollout: the hazard is reported throughout, an order in none of the last phases.
 * Any number that is no phase counts as flying. */
static void phases_reach_the_rule(void) {
    static flown_t flown;
    goe_flight_assessment_t now;
    const uint8_t phase[] = {GOE_FLIGHT_LANDED, GOE_FLIGHT_FLARE, 77u};
    for (int k = 0; k < 3; k++) {
        flown_start(&flown, NULL);
        flown.scene.x0_m = 0.5;
        flown.scene.z0_m = 120.0;
        flown.scene.height_m = 60.0;
        flown.scene.altitude_m = 20.0;
        bool ordered = false;
        bool warned = false;
        for (int tenth = 0; tenth < 45; tenth++) {
            for (int i = 0; i < FLOWN_POSE_HZ / 10; i++) {
                (void)flown_step(&flown);
            }
            TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_assess(&flown.flight, flown_now_us(&flown), phase[k], &now));
            ordered = ordered || now.action != GOE_FLIGHT_NONE;
            warned = warned || (now.hazard.conflict_probability > 0.9f && now.reason == GOE_FLIGHT_REASON_LANDING);
        }
        TEST_ASSERT_EQUAL(k == 2, ordered);
        TEST_ASSERT_EQUAL(k != 2, warned);
    }
}

/* --------------------------------------------------------------------------------------------------------------- height -- */

/* 12 m and 10 m of clearance, then a second one of 18 m, and an estimate that grows: the height clears the highest. */
static void a_go_around_carries_the_height_of_the_highest_top(void) {
    own.approach = true;
    put(0, 110.0f, 0.5f, 12.0f);
    put(1, 160.0f, 3.0f, 14.0f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_GO_AROUND, decide(0.5));
    CHECK_CLOSE(0.01, -24.0, flight.reaction.target_ned_m[2]);
    put(1, 160.0f, 3.0f, 18.0f);
    (void)decide(0.0);
    CHECK_CLOSE(0.01, -28.0, flight.reaction.target_ned_m[2]);
    put(1, 160.0f, 3.0f, 10.0f); /* it does not sink while the order is active */
    (void)decide(0.0);
    CHECK_CLOSE(0.01, -28.0, flight.reaction.target_ned_m[2]);
}

/* On the approach: a mast, and to both sides before it a wide obstacle, so that every turn leads into one. */
static void put_unknown_tops(int count) {
    for (int i = 0; i < 3; i++) {
        put_wide(i, i == 0 ? 150.0f : 70.0f, i == 0 ? 0.5f : i == 1 ? -58.0f : 58.0f, i == 0 ? 40.0f : 80.0f);
        flight.slot[i].used = i < count;
        flight.slot[i].valid = GOE_HAS_POSITION | GOE_HAS_WIDTH;
        flight.slot[i].hazard.conflict_probability = i == 0 ? 1.0f : 0.0f;
    }
}

/* GIVEN an approach to an obstacle whose top is not known WHEN a side is clear THEN the side is flown; WHEN every turn leads into another
 * obstacle THEN the aircraft climbs by the clearance over the present height, and the reason does not call that clear. WHEN there is space to
 * turn away and hold THEN it does that instead. */
static void a_go_around_over_an_unknown_top_is_the_least_bad(void) {
    own.approach = true;
    put_unknown_tops(1);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.5));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_REASON_CLEAR, flight.reaction.reason);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(1.0));
    start(0.0f);
    own.approach = true;
    put_unknown_tops(3);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_GO_AROUND, decide(0.5));
    CHECK_CLOSE(0.01, -30.0, flight.reaction.target_ned_m[2]);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_REASON_LEAST_BAD, flight.reaction.reason);
    start(0.0f);
    own.approach = true;
    put_unknown_tops(3);
    for (int i = 0; i < 3; i++) { /* farther ahead: the aircraft can still turn away */
        put_wide(i, 180.0f, i == 0 ? 0.5f : i == 1 ? -48.0f : 48.0f, i == 0 ? 6.0f : 60.0f);
        flight.slot[i].valid = GOE_HAS_POSITION | GOE_HAS_WIDTH;
        flight.slot[i].hazard.conflict_probability = i == 0 ? 1.0f : 0.0f;
    }
    flight.slot[0].hazard.tcpa_s = 7.0f; /* a climb by 10 m would be in time */
    TEST_ASSERT_EQUAL(GOE_FLIGHT_HOLD, decide(1.5));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_REASON_CLEAR, flight.reaction.reason);
}

/* ... WHEN a second obstacle behind the first has no known top, the climb is not called clear either. */
static void a_go_around_over_any_unknown_top_is_not_clear(void) {
    own.approach = true;
    put_unknown_tops(3);
    flight.slot[0].valid |= GOE_HAS_HEIGHT;
    flight.slot[0].top_m = 18.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_GO_AROUND, decide(0.5));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_REASON_CLEAR, flight.reaction.reason);
    start(0.0f);
    own.approach = true;
    put_unknown_tops(3);
    flight.slot[0].valid |= GOE_HAS_HEIGHT;
    flight.slot[0].top_m = 18.0f;
    put(3, 160.0f, 0.5f, 0.0f);
    flight.slot[3].valid = GOE_HAS_POSITION | GOE_HAS_WIDTH;
    flight.slot[3].hazard.conflict_probability = 0.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_GO_AROUND, decide(0.5));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_REASON_LEAST_BAD, flight.reaction.reason);
}

/* GIVEN a go-around over an unknown top WHEN a side becomes clear THEN the side is flown; WHEN the top is known and low THEN the same
 * order is clear. */
static void a_go_around_over_an_unknown_top_gives_way(void) {
    for (int known = 0; known < 2; known++) {
        start(0.0f);
        own.approach = true;
        put_unknown_tops(3);
        TEST_ASSERT_EQUAL(GOE_FLIGHT_GO_AROUND, decide(0.5));
        if (known) {
            flight.slot[0].valid |= GOE_HAS_HEIGHT;
            flight.slot[0].top_m = 18.0f;
        } else {
            flight.slot[1].used = false;
        }
        TEST_ASSERT_EQUAL(known ? GOE_FLIGHT_GO_AROUND : GOE_FLIGHT_LEFT, decide(0.5));
        TEST_ASSERT_EQUAL(GOE_FLIGHT_REASON_CLEAR, flight.reaction.reason);
    }
}

/* GIVEN a climb that no longer reaches its clearance in time WHEN it still clears the known top, and every turn leads into an obstacle THEN it
 * stays active; WHEN it does not even clear the top THEN a turn replaces it. */
static void a_low_climb_over_a_known_top_is_better_than_a_turn_into_another(void) {
    for (int into = 0; into < 2; into++) {
        start(0.0f);
        own.approach = true;
        put_unknown_tops(3);
        flight.slot[0].valid |= GOE_HAS_HEIGHT;
        flight.slot[0].top_m = 18.0f;
        TEST_ASSERT_EQUAL(GOE_FLIGHT_GO_AROUND, decide(0.5));
        flight.slot[0].top_m = into ? 50.0f : 30.0f;
        TEST_ASSERT_EQUAL(into, decide(0.5) != GOE_FLIGHT_GO_AROUND);
        TEST_ASSERT_EQUAL(into ? GOE_FLIGHT_REASON_LEAST_BAD : GOE_FLIGHT_REASON_CLEAR, flight.reaction.reason);
    }
}

/* GIVEN a go-around over an unknown top WHEN the aircraft flies it exactly, and perhaps finds a second one late THEN it stays active up to the
 * obstacle, at the height of the order plus the clearance: the climb is no reason to turn into another obstacle. */
static void a_go_around_over_an_unknown_top_is_flown_to_its_end(void) {
    for (int two = 0; two < 2; two++) {
        start(0.0f);
        own.approach = true;
        put_unknown_tops(3);
        TEST_ASSERT_EQUAL(GOE_FLIGHT_GO_AROUND, decide(0.5));
        const uint32_t begun_us = own.time_us;
        while (own.ned_m[0] < 125.0f) {
            own.ned_m[0] += 0.1f * SPEED_M_S;
            own.ned_m[2] = own.time_us > begun_us + 2000000u ? fmaxf(own.ned_m[2] - 0.25f, -30.0f) : own.ned_m[2];
            put_unknown_tops(3);
            if (two && own.ned_m[0] > 100.0f) { /* it leaves less time */
                put_wide(3, 145.0f, -0.5f, 50.0f);
                flight.slot[3].valid = GOE_HAS_POSITION | GOE_HAS_WIDTH;
                flight.slot[3].hazard.tcpa_s = flight.slot[0].hazard.tcpa_s - 0.1f;
            }
            TEST_ASSERT_EQUAL(GOE_FLIGHT_GO_AROUND, decide(0.0));
            CHECK_CLOSE(0.01, -30.0, flight.reaction.target_ned_m[2]);
        }
    }
}

/* GIVEN an order to a side on approach WHEN a go-around over an unknown top would be in time THEN the side stays. */
static void no_side_is_left_for_an_unknown_top(void) {
    own.approach = true;
    put_unknown_tops(1);
    flight.slot[0].hazard.tcpa_s = 3.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.0));
    flight.slot[0].hazard.tcpa_s = 9.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.5));
}

/* Behind a low one is a high one: a climb over the first leads into the second. */
static void a_climb_does_not_lead_into_what_is_behind(void) {
    put(0, 110.0f, 0.5f, 12.0f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_CLIMB, decide(0.5));
    start(0.0f);
    put(0, 110.0f, 0.5f, 12.0f);
    put(1, 160.0f, 0.5f, 60.0f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.5));
}

/* ---------------------------------------------------------------------------------------------------------------- clear -- */

static float share_of(float circle_m, float target_ahead_m, float target_right_m, float ahead_m, float right_m) {
    static goe_flight_clear_slot_t slots[GOE_FLIGHT_SLOTS];
    goe_flight_clear_own_t at;
    goe_flight_clear_way_t way;
    int nearest;
    memset(slots, 0, sizeof slots);
    memset(&at, 0, sizeof at);
    memset(&way, 0, sizeof way);
    at.turn_m = 70.0f;
    at.late_m = 30.0f;
    at.early_m = 10.0f;
    at.through_m = 100.0f;
    at.course_ne[0] = 1.0f;
    way.target_m[0] = target_ahead_m;
    way.target_m[1] = target_right_m;
    way.line_m[0] = 1.0f;
    way.circle_m = circle_m;
    way.sigmas = 2.0f;
    slots[1].counts = true;
    slots[1].at_m[0] = ahead_m;
    slots[1].at_m[1] = right_m;
    slots[1].radius_m = 3.0f;
    slots[1].margin_m = 10.0f;
    const float share = goe_flight_clear_share(&at, slots, &way, -4.0f, &nearest);
    TEST_ASSERT_EQUAL(share < GOE_FLIGHT_CLEAR_MAX ? 1 : -1, nearest);
    return share;
}

/* [goe_flight_assessment_t.clear_m]
 * Next to the way straight on, next to the target, within the fan, in the circle, on the line behind; mirrored it is the same. */
static void clearance_is_that_of_the_nearest_part_of_the_way(void) {
    for (int side = -1; side <= 1; side += 2) {
        const float s = (float)side;
        CHECK_CLOSE(0.001, 0.7, share_of(0.0f, 100.0f, 20.0f * s, 10.0f, -10.0f * s));
        CHECK_CLOSE(0.001, 1.2, share_of(0.0f, 100.0f, 20.0f * s, 150.0f, 35.0f * s));
        CHECK_CLOSE(0.001, 1.2, share_of(0.0f, 100.0f, 20.0f * s, 215.0f, 20.0f * s));
        CHECK_CLOSE(0.001, 0.7, share_of(60.0f, 150.0f, 90.0f * s, 150.0f, 160.0f * s));
        TEST_ASSERT_TRUE(share_of(60.0f, 150.0f, 90.0f * s, 150.0f, 90.0f * s) < -2.0f + 0.001f);
        TEST_ASSERT_TRUE(share_of(60.0f, 200.0f, 90.0f * s, 120.0f, 50.0f * s) < 0.0f);
        CHECK_CLOSE(0.001, 2.0, share_of(0.0f, 100.0f, 20.0f * s, -60.0f, 0.0f));
    }
}

/* A target almost straight ahead takes an arc of almost nothing, whatever the rounding. */
static void a_target_straight_ahead_takes_no_circle(void) {
    for (int k = -20; k <= 20; k++) {
        const float aside_m = 1.0e-6f * (float)k;
        TEST_ASSERT_TRUE(share_of(0.0f, 100.0f, aside_m, 30.0f, 140.0f) > 1.9f);
        TEST_ASSERT_TRUE(share_of(0.0f, 100.0f, aside_m, 30.0f, -140.0f) > 1.9f);
    }
}

/* ------------------------------------------------------------------------------------------------------- small shares -- */

/* [flight.confirm_s] GIVEN a side that keeps a fifth of the margin THEN another way is flown once that has stood for confirm_s. */
static void a_way_that_is_hardly_clear_is_left_after_a_while(void) {
    put(0, 130.0f, 0.5f, 50.0f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.5));
    const float target_m = flight.reaction.target_ned_m[1];
    put(1, 200.0f, target_m - 6.0f, 50.0f);
    flight.slot[1].hazard.conflict_probability = 0.0f;
    (void)decide(0.2);
    CHECK_CLOSE(0.1, 3.0, flight.reaction.clear_m);
    CHECK_SAME(target_m, flight.reaction.target_ned_m[1]);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.2));
    for (int k = 0; k < 20; k++) { /* and stays so, past an obstacle next to the line */
        TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.0));
        TEST_ASSERT_TRUE(flight.reaction.target_ned_m[1] < target_m - 10.0f);
    }
    TEST_ASSERT_TRUE(flight.reaction.clear_m > 6.0f);
}

/* GIVEN an obstacle whose range is known to 8 m and whose bearing well WHEN the aircraft flies past it on the line of the order THEN the
 * order keeps its kind and side until it ends: the uncertainty lies along the line. */
static void an_uncertain_range_does_not_turn_an_order_into_another(void) {
    put(0, 120.0f, 0.5f, 50.0f);
    flight.slot[0].width_m = 20.0f;
    flight.slot[0].covariance_ne_m2[0] = 64.0f;
    flight.slot[0].covariance_ne_m2[2] = 1.0f;
    const goe_flight_action_t first = decide(0.5);
    TEST_ASSERT_TRUE(first == GOE_FLIGHT_LEFT || first == GOE_FLIGHT_RIGHT);
    own.ned_m[1] = flight.reaction.target_ned_m[1];
    goe_flight_action_t now = first;
    for (; own.ned_m[0] < 250.0f && now != GOE_FLIGHT_NONE; own.ned_m[0] += 2.0f) {
        now = decide(0.0);
        TEST_ASSERT_TRUE(now == first || now == GOE_FLIGHT_NONE);
        TEST_ASSERT_TRUE(now == GOE_FLIGHT_NONE || flight.reaction.clear_m > 12.0f);
    }
    TEST_ASSERT_EQUAL(GOE_FLIGHT_NONE, now);
}

/* GIVEN an order that has just ended, and a clear way back to its line WHEN something is on the course of this moment THEN that is no
 * hazard for 1.2 roll_in_s, by when the aircraft turns back. */
static void flying_back_is_given_time(void) {
    for (int late = 0; late < 2; late++) {
        start(0.0f);
        own.time_us = 5000000u;
        own.ned_m[0] = 125.0f;
        own.ned_m[1] = -20.0f;
        flight.reaction.side = -1;
        flight.reaction.course_ne[0] = 1.0f;
        flight.reaction.falling_us = own.time_us - (late ? 1900000u : 1000000u);
        flight.velocity_ned_m_s[0] = 14.142136f;
        flight.velocity_ned_m_s[1] = -14.142136f;
        put(0, 125.0f + 71.0f, -20.0f - 71.0f, 50.0f);
        flight.slot[0].hazard.conflict_probability = 1.0f;
        flight.slot[0].hazard.tcpa_s = 4.85f;
        flight.settings.confirm_s = 0.0f;
        TEST_ASSERT_EQUAL(late, decide(0.0) != GOE_FLIGHT_NONE);
    }
}

/* GIVEN a climb that was ordered a while ago WHEN half of the clearance over a top cannot be reached before it any more THEN another
 * order is given, whatever side was flown before; while it can, the climb stays active. */
static void a_climb_is_left_when_it_comes_too_late(void) {
    for (int since = 0; since <= 3; since++) {
        for (int later = 0; later < 2; later++) {
            const float needed_s = fmaxf(2.0f - (float)since, 0.0f) + 5.0f / 2.5f;
            start(0.0f);
            own.time_us = 5000000u;
            const float right_m = since < 2 ? 0.5f : 12.0f;      /* a turn does not lead into it */
            put(0, 3.0f + SPEED_M_S * needed_s, right_m, 20.0f); /* 10 m to climb, of which 5 are enough */
            flight.slot[0].hazard.tcpa_s = needed_s + (later ? 0.2f : -0.2f);
            flight.reaction.action = GOE_FLIGHT_CLIMB;
            flight.reaction.slot = 0;
            flight.reaction.side = (int8_t)(since % 2);
            flight.reaction.course_ne[0] = flight.reaction.along_ne[0] = 1.0f;
            flight.reaction.target_ned_m[2] = -30.0f;
            flight.reaction.ordered_us = own.time_us - (uint32_t)since * 1000000u;
            TEST_ASSERT_EQUAL(later, decide(0.0) == GOE_FLIGHT_CLIMB);
        }
    }
}

/* [F1] GIVEN a climb WHEN the aircraft is high above the top, which is still ahead THEN the order stays active until the top lies behind:
 * the aircraft would sink towards it. Of an obstacle that the line clears the order knows nothing. */
static void a_climb_stays_active_until_the_top_is_passed(void) {
    for (int low = 0; low < 2; low++) {
        start(0.0f);
        put(0, 110.0f, 0.5f, 12.0f);
        TEST_ASSERT_EQUAL(GOE_FLIGHT_CLIMB, decide(0.5));
        flight.slot[0].hazard.conflict_probability = 0.0f;
        put(1, 160.0f, 0.5f, low ? 4.0f : 12.0f);
        flight.slot[1].hazard.conflict_probability = 0.0f;
        const float behind_m = low ? 110.0f : 160.0f;
        for (; own.ned_m[0] < behind_m + 30.0f; own.ned_m[0] += 2.0f) {
            own.ned_m[2] = fmaxf(own.ned_m[2] - 0.3f, -60.0f);
            const goe_flight_action_t now = decide(0.0);
            if (own.ned_m[0] < behind_m) {
                TEST_ASSERT_EQUAL(GOE_FLIGHT_CLIMB, now);
            }
        }
        TEST_ASSERT_EQUAL(GOE_FLIGHT_NONE, flight.reaction.action);
        (void)decide(9.0);
        TEST_ASSERT_TRUE(flight.reaction.falling); /* its end is remembered for 10 s */
        (void)decide(2.0);
        TEST_ASSERT_FALSE(flight.reaction.falling);
    }
}

/* [GOE_FLIGHT_CLIMB] GIVEN a climb WHEN its obstacle proves to be farther, or another one on the line appears THEN the target moves on past
 * them, and never back: an autopilot that circles the target passes them. */
static void a_climb_leads_past_its_obstacle(void) {
    put(0, 110.0f, 0.5f, 12.0f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_CLIMB, decide(0.5));
    put(0, 170.0f, 0.5f, 12.0f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_CLIMB, decide(0.2));
    const float past_m = 170.0f + goe_flight_slot_radius_m(&flight.slot[0]) + flight.settings.margin_m;
    TEST_ASSERT_TRUE(flight.reaction.target_ned_m[0] > past_m && flight.reaction.target_ned_m[0] < past_m + 20.0f);
    put(0, 130.0f, 0.5f, 12.0f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_CLIMB, decide(0.2));
    TEST_ASSERT_TRUE(flight.reaction.target_ned_m[0] > past_m);
    put(1, 200.0f, 0.5f, 12.0f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_CLIMB, decide(0.2));
    TEST_ASSERT_TRUE(flight.reaction.target_ned_m[0] > 200.0f + flight.settings.margin_m);
}

/* [goe_flight_position_t.velocity_ned_m_s] Above 1 m/s there is a course, and so an order. */
static void a_slow_aircraft_has_a_course(void) {
    for (int slow = 0; slow < 2; slow++) {
        start(0.0f);
        flight.settings.order_speed_m_s = 0.0f;
        flight.velocity_ned_m_s[0] = slow ? 0.9f : 1.5f;
        put(0, 12.0f, 0.5f, 80.0f);
        flight.slot[0].hazard.tcpa_s = 3.0f;
        TEST_ASSERT_EQUAL(slow, decide(0.5) == GOE_FLIGHT_NONE);
    }
}

/* GIVEN an active order WHEN the aircraft stops THEN the order stays active while an obstacle is ahead on its line, its own or a far one, and
 * ends hold_s after the last one is forgotten. */
static void the_order_of_an_aircraft_that_stops_ends(void) {
    put(0, 130.0f, 0.5f, 50.0f);
    put(1, 600.0f, 0.5f, 50.0f);
    flight.slot[1].hazard.conflict_probability = 0.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.5));
    flight.velocity_ned_m_s[0] = 0.5f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(5.0));
    flight.slot[0].used = false; /* as when its track has ended */
    flight.reaction.slot = flight.reaction.edge = -1;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(5.0));
    flight.slot[1].used = false;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(1.8));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_NONE, decide(0.3));
}

/* The side that was flown last is worth half a second. */
static void the_side_of_before_is_preferred(void) {
    for (int side = -1; side <= 1; side++) {
        start(0.0f);
        own.time_us = 5000000u;
        flight.reaction.side = (int8_t)side;
        flight.reaction.falling_us = own.time_us - 5000000u; /* too long ago to be flying back */
        flight.reaction.course_ne[0] = 1.0f;
        put(0, 110.0f, 1.0f, 50.0f);
        TEST_ASSERT_EQUAL(side > 0 ? GOE_FLIGHT_RIGHT : GOE_FLIGHT_LEFT, decide(0.5));
    }
}

/* A slot that is free, or has no place, raises no climb. */
static void a_missing_obstacle_raises_no_climb(void) {
    put(0, 110.0f, 0.5f, 12.0f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_CLIMB, decide(0.5));
    put(1, 300.0f, 0.5f, 60.0f);
    flight.slot[1].used = false;
    put(2, 300.0f, 0.5f, 60.0f);
    flight.slot[2].valid = GOE_HAS_HEIGHT;
    flight.slot[1].hazard.conflict_probability = flight.slot[2].hazard.conflict_probability = 0.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_CLIMB, decide(0.2));
    CHECK_CLOSE(0.01, -22.0, flight.reaction.target_ned_m[2]);
}

/* [goe_flight_assessment_t.clear_m] GIVEN a margin of 0 WHEN the path of an order leads into an obstacle THEN clear_m is negative, and
 * the reason is the least bad. */
static void an_order_into_an_obstacle_is_negative_without_a_margin(void) {
    flight.settings.margin_m = 0.0f;
    put_wall(20.0f);
    flight.reaction.action = GOE_FLIGHT_LEFT;
    flight.reaction.side = -1;
    flight.reaction.course_ne[0] = flight.reaction.along_ne[0] = 1.0f;
    flight.reaction.target_ned_m[0] = 20.0f;
    flight.reaction.target_ned_m[1] = -28.0f;
    flight.reaction.slot = flight.reaction.edge = -1;
    (void)decide(0.0);
    TEST_ASSERT_TRUE(flight.reaction.clear_m < -1.0f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_REASON_LEAST_BAD, flight.reaction.reason);
}

/* At most 1000 m are reported, however large the margin. */
static void clear_sectors_are_reported_up_to_a_kilometer(void) {
    flight.settings.margin_m = 1000.0f;
    flight.reaction.action = GOE_FLIGHT_LEFT;
    flight.reaction.side = -1;
    flight.reaction.course_ne[0] = flight.reaction.along_ne[0] = 1.0f;
    flight.reaction.target_ned_m[0] = 100.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.0));
    CHECK_SAME(1000.0f, flight.reaction.clear_m);
}

/* ---------------------------------------------------------------------------------------------------------------- names -- */

static void every_reason_has_a_name(void) {
    for (int reason = GOE_FLIGHT_REASON_NONE; reason <= GOE_FLIGHT_REASON_LANDING; reason++) {
        TEST_ASSERT_TRUE(strcmp("unknown", goe_flight_reason_text((goe_flight_reason_t)reason)) != 0);
    }
    TEST_ASSERT_EQUAL_STRING("least_bad", goe_flight_reason_text(GOE_FLIGHT_REASON_LEAST_BAD));
    TEST_ASSERT_EQUAL_STRING("unknown", goe_flight_reason_text((goe_flight_reason_t)77));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(a_way_that_is_hardly_clear_is_left_after_a_while);
    RUN_TEST(an_uncertain_range_does_not_turn_an_order_into_another);
    RUN_TEST(flying_back_is_given_time);
    RUN_TEST(a_climb_is_left_when_it_comes_too_late);
    RUN_TEST(a_climb_stays_active_until_the_top_is_passed);
    RUN_TEST(a_climb_leads_past_its_obstacle);
    RUN_TEST(a_slow_aircraft_has_a_course);
    RUN_TEST(the_order_of_an_aircraft_that_stops_ends);
    RUN_TEST(the_side_of_before_is_preferred);
    RUN_TEST(a_missing_obstacle_raises_no_climb);
    RUN_TEST(an_order_into_an_obstacle_is_negative_without_a_margin);
    RUN_TEST(clear_sectors_are_reported_up_to_a_kilometer);
    RUN_TEST(a_mast_that_is_not_on_the_course_blocks_a_side);
    RUN_TEST(a_place_that_is_hardly_known_blocks_a_side);
    RUN_TEST(an_old_place_blocks_a_side);
    RUN_TEST(a_low_one_blocks_no_side);
    RUN_TEST(the_circle_about_the_target_is_kept_clear);
    RUN_TEST(an_unlikely_obstacle_delays_no_order);
    RUN_TEST(an_unlikely_worst_obstacle_delays_no_order);
    RUN_TEST(unlikely_obstacles_delay_no_order_in_time);
    RUN_TEST(a_passed_obstacle_delays_no_order);
    RUN_TEST(a_circle_is_never_smaller_than_the_turn);
    RUN_TEST(a_wall_of_masts_is_a_reason_to_hold);
    RUN_TEST(a_blocked_aircraft_reports_it);
    RUN_TEST(a_standing_order_evades_to_its_own_side_first);
    RUN_TEST(an_order_leads_through_a_gap_on_its_side);
    RUN_TEST(an_order_into_an_obstacle_changes_its_side);
    RUN_TEST(an_aircraft_that_flies_back_to_its_line_needs_no_order);
    RUN_TEST(an_order_stays_active_while_another_one_is_on_its_line);
    RUN_TEST(an_order_turns_to_the_next_one_on_its_line);
    RUN_TEST(an_order_that_finds_another_way_does_not_sink_with_the_aircraft);
    RUN_TEST(an_order_stays_active_while_the_way_back_is_not_clear);
    RUN_TEST(an_order_stays_active_while_its_hazard_is);
    RUN_TEST(a_long_time_changes_no_report);
    RUN_TEST(no_order_is_given_too_low);
    RUN_TEST(a_height_below_the_ground_withholds_no_order);
    RUN_TEST(a_height_of_zero_gives_orders_at_any_height);
    RUN_TEST(no_order_is_given_too_slow);
    RUN_TEST(no_order_is_given_in_flare_or_after_touchdown);
    RUN_TEST(phases_reach_the_rule);
    RUN_TEST(a_go_around_carries_the_height_of_the_highest_top);
    RUN_TEST(a_go_around_over_an_unknown_top_is_the_least_bad);
    RUN_TEST(a_go_around_over_any_unknown_top_is_not_clear);
    RUN_TEST(a_go_around_over_an_unknown_top_gives_way);
    RUN_TEST(a_low_climb_over_a_known_top_is_better_than_a_turn_into_another);
    RUN_TEST(a_go_around_over_an_unknown_top_is_flown_to_its_end);
    RUN_TEST(no_side_is_left_for_an_unknown_top);
    RUN_TEST(a_climb_does_not_lead_into_what_is_behind);
    RUN_TEST(clearance_is_that_of_the_nearest_part_of_the_way);
    RUN_TEST(a_target_straight_ahead_takes_no_circle);
    RUN_TEST(every_reason_has_a_name);
    return UNITY_END();
}
