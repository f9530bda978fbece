/* The rule of the reaction, line by line of its table in port/flight/README.md. SPDX-License-Identifier: MIT
 *
 * The obstacle of a slot is written straight into the table: the test checks the rule's result, not the detection. */
#include <math.h>
#include <string.h>

#include "flown.h"
#include "goe_reaction.h"

#define SPEED_M_S 20.0f

static goe_flight_t flight;
static goe_flight_reaction_own_t own;

/* A mast of 6 m diameter, 50 m high, `ahead` meters ahead and `right` meters aside of an aircraft 20 m above the ground that flies
 * north from the origin at 20 m/s; bank 30 degrees: 71 m of radius. */
static void put(int slot, float ahead_m, float right_m) {
    goe_flight_slot_t *s = &flight.slot[slot];
    s->used = s->assessed = true;
    s->valid = GOE_HAS_POSITION | GOE_HAS_WIDTH | GOE_HAS_HEIGHT;
    s->center_ne_m[0] = ahead_m;
    s->center_ne_m[1] = right_m;
    s->width_m = 6.0f;
    s->top_m = 50.0f;
    s->hazard.conflict_probability = 1.0f;
    s->hazard.tcpa_s = (ahead_m - 3.0f) / SPEED_M_S;
}

void setUp(void) {
    static flown_t flown;
    flown_start(&flown, NULL);
    flight = flown.flight;
    memset(&own, 0, sizeof own);
    own.ned_m[2] = -20.0f;
    flight.velocity_ned_m_s[0] = SPEED_M_S;
}
void tearDown(void) {}

/* Looks for so long, ten times a second, at estimates that are renewed each time. */
static goe_flight_action_t decide_about(int worst, double seconds) {
    for (int k = 0; k <= (int)(seconds * 10.0 + 0.5); k++) {
        for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
            flight.slot[i].taken_us = own.time_us;
        }
        (void)goe_flight_reaction_decide(&flight, worst, &own);
        own.time_us += 100000u;
    }
    return (goe_flight_action_t)flight.reaction.action;
}

static goe_flight_action_t decide(double seconds) { return decide_about(0, seconds); }

static void a_far_obstacle_is_no_reason_yet(void) {
    put(0, 400.0f, 0.0f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_NONE, decide(2.0));
}

/* [flight.roll_in_s, flight.reserve_s, flight.confirm_s]
 * 18 m aside and 71 m of radius: 45 m of way, 2.2 s, 1.5 s to roll in, 3 s of reserve: 6.7 s. */
static void the_order_comes_with_the_time_that_it_needs(void) {
    put(0, 3.0f + 6.9f * SPEED_M_S, 0.5f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_NONE, decide(1.0));
    put(0, 3.0f + 6.5f * SPEED_M_S, 0.5f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_NONE, decide(0.2));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.3)); /* after confirm_s */
    TEST_ASSERT_FALSE(flight.reaction.late);
}

/* The time by two sigmas too early is time / (1 + 2 sigma / time): 10.5 s of 20 +- 9 s, 5.8 s of 11 +- 5 s. */
static void a_range_that_is_hardly_known_orders_earlier_but_not_at_once(void) {
    put(0, 3.0f + 20.0f * SPEED_M_S, 0.5f);
    flight.slot[0].hazard.tcpa_sd_s = 9.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_NONE, decide(1.0));
    put(0, 3.0f + 11.0f * SPEED_M_S, 0.5f);
    flight.slot[0].hazard.tcpa_sd_s = 5.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.5));
    TEST_ASSERT_FALSE(flight.reaction.late);
}

static void the_nearer_side_is_taken(void) {
    put(0, 100.0f, 2.0f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.5));
    CHECK_CLOSE(0.1, 100.0, flight.reaction.target_ned_m[0]);
    CHECK_CLOSE(0.1, 2.0 - 3.0 - 15.0, flight.reaction.target_ned_m[1]);
    goe_flight_reaction_clear(&flight.reaction);
    put(0, 100.0f, -2.0f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_RIGHT, decide(0.5));
    CHECK_CLOSE(0.1, -2.0 + 3.0 + 15.0, flight.reaction.target_ned_m[1]);
}

static void a_side_that_is_not_clear_is_not_taken(void) {
    put(0, 100.0f, 2.0f);
    put(1, 100.0f, -20.0f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_RIGHT, decide(0.5));
}

/* Behind the target the line continues: for the turn's radius and the distance flown before an order is obeyed, 71 + 90 m. */
static void an_obstacle_on_the_line_behind_a_target_blocks_it(void) {
    for (int blocked = 0; blocked < 2; blocked++) {
        goe_flight_reaction_clear(&flight.reaction);
        put(0, 100.0f, 2.0f);
        put(1, blocked ? 250.0f : 340.0f, -16.0f);
        flight.slot[1].hazard.conflict_probability = 0.0f;
        TEST_ASSERT_EQUAL(blocked ? GOE_FLIGHT_RIGHT : GOE_FLIGHT_LEFT, decide(0.5));
    }
}

static void no_side_and_no_climb_is_a_reason_to_hold(void) {
    put(0, 100.0f, 2.0f);
    put(1, 100.0f, -20.0f);
    put(2, 90.0f, 20.0f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_HOLD, decide(0.5));
    TEST_ASSERT_TRUE(fabs((double)flight.reaction.target_ned_m[1]) > 70.0);
}

static void a_wide_obstacle_is_a_reason_to_hold(void) {
    put(0, 110.0f, 1.0f);
    flight.slot[0].width_m = 140.0f;
    flight.slot[0].hazard.tcpa_s = 5.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_HOLD, decide(0.5));
    TEST_ASSERT_TRUE(flight.reaction.target_ned_m[1] < -70.0f); /* the side with less of it */
}

/* [flight.climb_in_s] 2 m too low: 2 s and 2/2.5 s, less than a turn. */
static void a_low_top_is_climbed_over(void) {
    put(0, 110.0f, 0.5f);
    flight.slot[0].top_m = 12.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_CLIMB, decide(0.5));
    CHECK_CLOSE(0.01, -22.0, flight.reaction.target_ned_m[2]);
}

static void a_top_that_is_not_known_is_not_climbed_over(void) {
    put(0, 110.0f, 0.5f);
    flight.slot[0].top_m = 0.0f;
    flight.slot[0].valid = GOE_HAS_POSITION | GOE_HAS_WIDTH;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.5));
}

static void an_unsure_top_is_taken_for_higher(void) {
    put(0, 110.0f, 0.5f);
    flight.slot[0].top_m = 12.0f;
    flight.slot[0].top_sd_m = 5.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.5));
}

/* [GOE_FLIGHT_APPROACH] */
static void an_approach_is_broken_off(void) {
    own.approach = true;
    put(0, 110.0f, 0.5f);
    flight.slot[0].top_m = 12.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_GO_AROUND, decide(0.5));
    goe_flight_reaction_clear(&flight.reaction);
    flight.slot[0].top_m = 80.0f; /* 28 s of climb: too high to go around over it */
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.5));
}

/* GIVEN an approach to a low obstacle whose range looks far too short, so that a side is ordered, WHEN the range is known and a climb
 * comes in time THEN the approach is broken off, about the same obstacle and on the line of the first order; not before, and not
 * where nobody lands. */
static void an_approach_left_to_a_side_is_broken_off_once_there_is_time(void) {
    for (int landing = 0; landing < 2; landing++) {
        goe_flight_reaction_clear(&flight.reaction);
        own.approach = landing != 0;
        put(0, 40.0f, 0.5f);
        flight.slot[0].top_m = 12.0f;
        flight.slot[0].hazard.tcpa_s = 2.0f;
        TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.0));
        TEST_ASSERT_TRUE(flight.reaction.late);
        TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.1));
        put(0, 110.0f, 0.5f);
        flight.slot[0].top_m = 12.0f;
        TEST_ASSERT_EQUAL(landing ? GOE_FLIGHT_GO_AROUND : GOE_FLIGHT_LEFT, decide(0.1));
        TEST_ASSERT_EQUAL(0, flight.reaction.slot);
        if (landing) {
            TEST_ASSERT_FALSE(flight.reaction.late);
            CHECK_CLOSE(0.01, -22.0, flight.reaction.target_ned_m[2]);
        }
    }
}

/* GIVEN a go-around over a low obstacle WHEN a tower is behind it that the climb does not clear in time THEN a side is flown. */
static void a_climb_that_comes_too_late_gives_way_to_a_side(void) {
    own.approach = true;
    put(0, 110.0f, 0.5f);
    flight.slot[0].top_m = 12.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_GO_AROUND, decide(0.5));
    put(1, 400.0f, 0.5f);
    flight.slot[1].top_m = 60.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_GO_AROUND, decide(0.5));
    put(0, -40.0f, 0.5f); /* passed */
    flight.slot[0].hazard.conflict_probability = 0.0f;
    put(1, 125.0f, 0.5f);
    flight.slot[1].top_m = 60.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide_about(1, 0.5)); /* 20 s of climb, 6 s left */
    TEST_ASSERT_FALSE(flight.reaction.late);
}

/* GIVEN a go-around WHEN a higher top is known farther ahead on the course THEN the height clears that too, and never sinks again. */
static void a_climb_clears_every_known_top_ahead(void) {
    own.approach = true;
    put(0, 110.0f, 0.5f);
    flight.slot[0].top_m = 12.0f;
    put(1, 600.0f, 3.0f);
    flight.slot[1].top_m = 30.0f;
    put(2, 600.0f, 80.0f); /* next to the course */
    TEST_ASSERT_EQUAL(GOE_FLIGHT_GO_AROUND, decide(0.5));
    CHECK_CLOSE(0.01, -40.0, flight.reaction.target_ned_m[2]);
    flight.slot[1].top_m = 25.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_GO_AROUND, decide(0.5));
    CHECK_CLOSE(0.01, -40.0, flight.reaction.target_ned_m[2]);
    flight.slot[1].top_m = 35.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_GO_AROUND, decide(0.5));
    CHECK_CLOSE(0.01, -45.0, flight.reaction.target_ned_m[2]);
}

/* GIVEN any places about an active order THEN its reports agree: no way that leads into an obstacle is clear. */
static void the_reports_of_an_order_agree(void) {
    uint32_t state = 1u;
    int least_bad = 0;
    for (int flights = 0; flights < 300; flights++) {
        setUp();
        for (int step = 0; step < 6; step++) {
            for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
                state = state * 1664525u + 1013904223u;
                const float ahead_m = 30.0f + (float)(state >> 24u);
                state = state * 1664525u + 1013904223u;
                put(i, ahead_m, i == 0 ? 1.0f : (float)(state >> 24u) - 128.0f);
            }
            (void)decide(0.2);
            const goe_flight_reaction_t *r = &flight.reaction;
            if (r->clear_m < 0.0f) {
                least_bad++;
                TEST_ASSERT_EQUAL(GOE_FLIGHT_REASON_LEAST_BAD, r->reason);
            }
            if (r->action == GOE_FLIGHT_NONE) {
                TEST_ASSERT_EQUAL_FLOAT(0.0f, r->clear_m);
            }
        }
    }
    TEST_ASSERT_TRUE(least_bad > 20);
}

static void a_wait_for_confirmation_is_not_afforded_when_it_is_late(void) {
    put(0, 63.0f, 0.5f); /* 3 s */
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.0));
    TEST_ASSERT_TRUE(flight.reaction.late);
}

/* ... but a hazard that is less likely than not is then no reason: no action would change it. */
static void an_unlikely_hazard_is_no_reason_when_it_is_late(void) {
    put(0, 63.0f, 0.5f);
    flight.slot[0].hazard.conflict_probability = 0.4f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_NONE, decide(1.0));
    put(0, 110.0f, 0.5f);
    flight.slot[0].hazard.conflict_probability = 0.4f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.5));
}

static void no_hazard_is_no_reason(void) {
    put(0, 100.0f, 0.5f);
    flight.slot[0].hazard.conflict_probability = 0.09f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_NONE, decide(2.0));
    put(0, -5.0f, 0.5f); /* behind */
    TEST_ASSERT_EQUAL(GOE_FLIGHT_NONE, decide(2.0));
    flight.velocity_ned_m_s[0] = 0.5f; /* no course */
    put(0, 50.0f, 0.5f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_NONE, decide(2.0));
}

static void doubt_orders_earlier_and_wider(void) {
    put(0, 3.0f + 7.1f * SPEED_M_S, 0.5f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_NONE, decide(1.0));
    flight.slot[0].suspect = true;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.5));
    CHECK_CLOSE(0.1, 0.5 - 3.0 - 22.5, flight.reaction.target_ned_m[1]);
}

/* The order is active while the aircraft turns away from the obstacle, which ends the hazard on its present course; it ends when the
 * line of the order leads past the obstacle again. */
static void the_order_stays_active_until_the_obstacle_lies_behind(void) {
    put(0, 100.0f, 0.5f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.5));
    flight.slot[0].hazard.conflict_probability = 0.0f;
    flight.velocity_ned_m_s[0] = 14.0f;
    flight.velocity_ned_m_s[1] = -14.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(5.0));
    own.ned_m[0] = 115.0f; /* abeam and a little more: to turn back now would meet it */
    own.ned_m[1] = -20.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(1.0));
    own.ned_m[0] = 120.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_NONE, decide(0.0));
}

/* An estimate that moves away from the line ends it, once that has stood for hold_s. */
static void an_order_that_proves_wrong_is_taken_back(void) {
    put(0, 100.0f, 0.5f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.5));
    flight.slot[0].hazard.conflict_probability = 0.0f;
    flight.slot[0].center_ne_m[1] = 40.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(1.0));
    flight.slot[0].center_ne_m[1] = 10.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(3.0));
    flight.slot[0].center_ne_m[1] = 40.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_NONE, decide(2.5));
}

static void an_obstacle_that_is_given_up_ends_its_order(void) {
    put(0, 100.0f, 0.5f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.5));
    flight.slot[0].used = flight.slot[0].assessed = false;
    memset(&flight.slot[0].hazard, 0, sizeof flight.slot[0].hazard);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_NONE, decide(2.5));
}

/* After an order that has ended nothing of it is reported: no target, no clearance. */
static void an_order_that_has_ended_reports_nothing(void) {
    put(0, 100.0f, 0.5f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.5));
    flight.slot[0].hazard.conflict_probability = 0.0f;
    own.ned_m[0] = 130.0f;
    own.ned_m[1] = -20.0f;
    while (decide(0.0) != GOE_FLIGHT_NONE) {
        TEST_ASSERT_TRUE(own.time_us < 10000000u);
    }
    TEST_ASSERT_EQUAL(-1, flight.reaction.slot);
    CHECK_SAME(0.0f, flight.reaction.clear_m);
    for (int i = 0; i < 3; i++) {
        CHECK_SAME(0.0f, flight.reaction.target_ned_m[i]);
    }
}

/* A hazard within 10 s of the end of an order is the same encounter, with its side and its changes of it; later neither counts. */
static void the_side_of_an_order_is_remembered_for_ten_seconds(void) {
    for (int later = 0; later < 2; later++) {
        goe_flight_reaction_clear(&flight.reaction);
        flight.reaction.side = 1;
        flight.reaction.changes = 2u;
        flight.reaction.falling_us = 5000000u;
        own.time_us = later ? 15100000u : 14900000u;
        (void)goe_flight_reaction_decide(&flight, -1, &own);
        TEST_ASSERT_EQUAL(later ? 0 : 1, flight.reaction.side);
        TEST_ASSERT_EQUAL(later ? 0 : 2, flight.reaction.changes);
    }
}

/* Memory that flipped: an action that there is not, or an order about a slot that there is not, is no order. */
static void an_order_about_no_slot_is_none(void) {
    static const int beyond[] = {-2, GOE_FLIGHT_SLOTS, GOE_FLIGHT_SLOTS + 1, 127};
    for (int kind = 0; kind < 4; kind++) {
        for (size_t i = 0; i < sizeof beyond / sizeof beyond[0]; i++) {
            goe_flight_reaction_t *r = &flight.reaction;
            goe_flight_reaction_clear(r);
            put(0, 300.0f, 0.0f);
            flight.slot[0].hazard.conflict_probability = 0.0f;
            r->action = kind == 0 ? (uint8_t)(GOE_FLIGHT_HOLD + 1 + (int)i) : GOE_FLIGHT_LEFT;
            r->side = kind == 1 ? (int8_t)beyond[i] : -1;
            r->slot = kind == 2 ? (int8_t)beyond[i] : 0;
            r->edge = kind == 3 ? (int8_t)beyond[i] : 0;
            r->course_ne[0] = r->along_ne[0] = 1.0f;
            (void)goe_flight_reaction_decide(&flight, -1, &own);
            TEST_ASSERT_EQUAL(GOE_FLIGHT_NONE, r->action);
            TEST_ASSERT_EQUAL(-1, r->slot);
            TEST_ASSERT_EQUAL(-1, r->edge);
            TEST_ASSERT_EQUAL(0, r->side);
        }
    }
}

/* ... as is one whose numbers are none. */
static void an_order_of_no_numbers_is_none(void) {
    for (int k = 0; k < 11; k++) {
        goe_flight_reaction_t *r = &flight.reaction;
        float *const number[] = {&r->target_ned_m[0], &r->target_ned_m[1], &r->target_ned_m[2], &r->from_ned_m[0],
                                 &r->from_ned_m[1],   &r->from_ned_m[2],   &r->course_ne[0],    &r->course_ne[1],
                                 &r->along_ne[0],     &r->along_ne[1],     &r->clear_m};
        for (int bad = 0; bad < 2; bad++) {
            goe_flight_reaction_clear(r);
            put(0, 300.0f, 0.0f);
            flight.slot[0].hazard.conflict_probability = 0.0f;
            r->action = GOE_FLIGHT_LEFT;
            r->side = -1;
            r->slot = 0;
            r->course_ne[0] = r->along_ne[0] = 1.0f;
            *number[k] = bad ? check_from_bits(0x7FC00000u) : *number[k];
            (void)goe_flight_reaction_decide(&flight, -1, &own);
            TEST_ASSERT_EQUAL(bad ? GOE_FLIGHT_NONE : GOE_FLIGHT_LEFT, r->action);
        }
    }
}

static void the_point_of_a_side_follows_the_estimate(void) {
    put(0, 100.0f, 0.5f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.5));
    flight.slot[0].center_ne_m[1] = 3.0f;
    (void)decide(0.0);
    CHECK_CLOSE(0.1, 3.0 - 18.0, flight.reaction.target_ned_m[1]);
}

/* GIVEN an order past one obstacle, or in the gap to another one WHEN one of them has no position any more THEN the target stays. */
static void a_target_does_not_follow_a_lost_position(void) {
    for (int lost = 0; lost < 2; lost++) {
        setUp();
        put(0, 100.0f, 0.5f);
        TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.5));
        put(1, 110.0f, -12.0f);
        flight.slot[1].hazard.conflict_probability = 0.0f;
        flight.reaction.edge = 1;
        (void)decide(0.0);
        const goe_flight_reaction_t before = flight.reaction;
        TEST_ASSERT_EQUAL(1, before.edge);
        CHECK_CLOSE(0.1, -30.0, before.target_ned_m[1]);
        flight.slot[lost].valid = 0;
        (void)decide(0.0);
        TEST_ASSERT_EQUAL_MEMORY(before.target_ned_m, flight.reaction.target_ned_m, sizeof before.target_ned_m);
    }
}

static void another_obstacle_replaces_the_order_but_not_the_line(void) {
    put(0, 100.0f, 0.5f);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_LEFT, decide(0.5));
    put(1, 90.0f, -17.0f);
    own.ned_m[1] = -15.0f;
    for (int k = 0; k < 5; k++) {
        (void)goe_flight_reaction_decide(&flight, 1, &own);
        own.time_us += 100000u;
    }
    TEST_ASSERT_EQUAL(1, flight.reaction.slot);
    CHECK_SAME(0.0f, flight.reaction.from_ned_m[1]);
}

static void every_action_has_a_name(void) {
    for (int action = GOE_FLIGHT_NONE; action <= GOE_FLIGHT_HOLD; action++) {
        TEST_ASSERT_TRUE(strcmp("unknown", goe_flight_action_text((goe_flight_action_t)action)) != 0);
    }
    TEST_ASSERT_EQUAL_STRING("go_around", goe_flight_action_text(GOE_FLIGHT_GO_AROUND));
    TEST_ASSERT_EQUAL_STRING("unknown", goe_flight_action_text((goe_flight_action_t)77));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(an_order_of_no_numbers_is_none);
    RUN_TEST(a_far_obstacle_is_no_reason_yet);
    RUN_TEST(the_order_comes_with_the_time_that_it_needs);
    RUN_TEST(a_range_that_is_hardly_known_orders_earlier_but_not_at_once);
    RUN_TEST(the_nearer_side_is_taken);
    RUN_TEST(a_side_that_is_not_clear_is_not_taken);
    RUN_TEST(an_obstacle_on_the_line_behind_a_target_blocks_it);
    RUN_TEST(no_side_and_no_climb_is_a_reason_to_hold);
    RUN_TEST(a_wide_obstacle_is_a_reason_to_hold);
    RUN_TEST(a_low_top_is_climbed_over);
    RUN_TEST(a_top_that_is_not_known_is_not_climbed_over);
    RUN_TEST(an_unsure_top_is_taken_for_higher);
    RUN_TEST(an_approach_is_broken_off);
    RUN_TEST(an_approach_left_to_a_side_is_broken_off_once_there_is_time);
    RUN_TEST(a_climb_that_comes_too_late_gives_way_to_a_side);
    RUN_TEST(a_climb_clears_every_known_top_ahead);
    RUN_TEST(the_reports_of_an_order_agree);
    RUN_TEST(a_wait_for_confirmation_is_not_afforded_when_it_is_late);
    RUN_TEST(an_unlikely_hazard_is_no_reason_when_it_is_late);
    RUN_TEST(no_hazard_is_no_reason);
    RUN_TEST(doubt_orders_earlier_and_wider);
    RUN_TEST(the_order_stays_active_until_the_obstacle_lies_behind);
    RUN_TEST(an_order_that_proves_wrong_is_taken_back);
    RUN_TEST(an_obstacle_that_is_given_up_ends_its_order);
    RUN_TEST(an_order_that_has_ended_reports_nothing);
    RUN_TEST(the_side_of_an_order_is_remembered_for_ten_seconds);
    RUN_TEST(an_order_about_no_slot_is_none);
    RUN_TEST(the_point_of_a_side_follows_the_estimate);
    RUN_TEST(a_target_does_not_follow_a_lost_position);
    RUN_TEST(another_obstacle_replaces_the_order_but_not_the_line);
    RUN_TEST(every_action_has_a_name);
    return UNITY_END();
}
