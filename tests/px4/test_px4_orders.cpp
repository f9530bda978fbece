/* Orders of the module of port/px4: when it sends commands to PX4, and which. SPDX-License-Identifier: MIT */
#include "px4_flight.hpp"

#include <uORB/topics/position_controller_landing_status.h>
#include <uORB/topics/position_setpoint_triplet.h>
#include <uORB/topics/vehicle_land_detected.h>

#include "GoeOrders.hpp"

static constexpr uint8_t MISSION = vehicle_status_s::NAVIGATION_STATE_AUTO_MISSION;
static constexpr uint8_t HOLD = vehicle_status_s::NAVIGATION_STATE_AUTO_LOITER;
static constexpr uint8_t LAND = vehicle_status_s::NAVIGATION_STATE_AUTO_LAND;
static constexpr uint8_t POSITION = vehicle_status_s::NAVIGATION_STATE_POSCTL;
static constexpr uint8_t RETURN = vehicle_status_s::NAVIGATION_STATE_AUTO_RTL;
static constexpr int32_t REPOSITION = GOE_REACT_REPOSITION;
static constexpr int32_t ALL = GOE_REACT_REPOSITION | GOE_REACT_GO_AROUND;

static GoeOrders orders;
static GoeOrders::Vehicle vehicle;
static goe_flight_assessment_t assessment;
static vehicle_command_s command;

extern "C" void setUp(void) {
    orders = GoeOrders();
    vehicle = GoeOrders::Vehicle{};
    vehicle.armed = vehicle.has_wings = vehicle.obstacle_known = true;
    vehicle.origin_known = vehicle.altitude_known = true;
    vehicle.nav_state = MISSION;
    vehicle.origin_alt_m = 489.f;
    vehicle.setpoint_alt_m = 489.f;
    vehicle.now_us = 1000000u;
    memset(&assessment, 0, sizeof assessment);
    assessment.action = GOE_FLIGHT_LEFT;
    assessment.target_ned_m[0] = 100.f;
    assessment.target_ned_m[1] = -40.f;
    assessment.target_ned_m[2] = -30.f;
    assessment.target_lat_e7 = 474000000;
    assessment.target_lon_e7 = -85000000;
}
extern "C" void tearDown(void) {}

/* Advances by 100 ms. */
static bool follow(int32_t react = ALL, bool resume = false) {
    vehicle.now_us += 100000u;
    return orders.follow(assessment, vehicle, react, resume, command);
}

static void answer(uint8_t result) {
    vehicle_command_ack_s ack{};
    ack.command = command.command;
    ack.result = result;
    orders.take(ack);
}

static void accept(uint8_t mode) {
    answer(vehicle_command_ack_s::VEHICLE_CMD_RESULT_ACCEPTED);
    vehicle.nav_state = mode;
}

static void a_place_is_a_reposition_with_change_of_mode() {
    TEST_ASSERT_TRUE(follow());
    TEST_ASSERT_EQUAL(vehicle_command_s::VEHICLE_CMD_DO_REPOSITION, command.command);
    CHECK_CLOSE(0, 1, command.param2);
    TEST_ASSERT_TRUE(std::fabs(command.param5 - 47.4) < 1e-9 && std::fabs(command.param6 + 8.5) < 1e-9);
    CHECK_CLOSE(0, 519, command.param7);
    TEST_ASSERT_TRUE(__builtin_isnan(command.param4));
    TEST_ASSERT_TRUE(orders.flown());
}

static void without_an_altitude_it_keeps_its_own() {
    vehicle.altitude_known = false;
    TEST_ASSERT_TRUE(follow());
    TEST_ASSERT_TRUE(__builtin_isnan(command.param7));
}

static void nothing_is_given_unless_all_allows_it() {
    TEST_ASSERT_FALSE(follow(0));
    TEST_ASSERT_FALSE(follow(GOE_REACT_GO_AROUND));
    vehicle.armed = false;
    TEST_ASSERT_FALSE(follow());
    vehicle.armed = true;
    vehicle.origin_known = false;
    TEST_ASSERT_FALSE(follow());
    vehicle.origin_known = true;
    for (const uint8_t mode : {POSITION, RETURN, LAND}) {
        vehicle.nav_state = mode;
        TEST_ASSERT_FALSE(follow());
    }
    TEST_ASSERT_FALSE(orders.flown());
    vehicle.nav_state = MISSION;
    TEST_ASSERT_TRUE(follow());
}

static void it_is_repeated_until_it_is_answered() {
    TEST_ASSERT_TRUE(follow());
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_FALSE(follow());
    }
    TEST_ASSERT_TRUE(follow());
    accept(HOLD);
    for (int i = 0; i < 20; i++) {
        TEST_ASSERT_FALSE(follow());
    }
}

static void a_refusal_is_counted_and_repeated() {
    TEST_ASSERT_TRUE(follow());
    answer(vehicle_command_ack_s::VEHICLE_CMD_RESULT_DENIED);
    TEST_ASSERT_EQUAL(1, orders.refused());
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_FALSE(follow());
    }
    TEST_ASSERT_TRUE(follow());
}

static void a_target_that_moves_is_sent_again() {
    TEST_ASSERT_TRUE(follow());
    accept(HOLD);
    assessment.target_ned_m[1] -= 4.f;
    TEST_ASSERT_FALSE(follow());
    assessment.target_ned_m[1] -= 2.f;
    TEST_ASSERT_TRUE(follow());
    TEST_ASSERT_FALSE(follow());
    assessment.target_ned_m[2] -= 6.f; /* upwards, too */
    TEST_ASSERT_TRUE(follow());
    answer(vehicle_command_ack_s::VEHICLE_CMD_RESULT_IN_PROGRESS);
    for (int i = 0; i < 20; i++) {
        TEST_ASSERT_FALSE(follow());
    }
}

static void another_action_is_sent_at_once() {
    TEST_ASSERT_TRUE(follow());
    accept(HOLD);
    assessment.action = GOE_FLIGHT_HOLD;
    TEST_ASSERT_TRUE(follow());
}

static void a_pilot_is_not_fought() {
    TEST_ASSERT_TRUE(follow());
    accept(HOLD);
    TEST_ASSERT_FALSE(follow());
    vehicle.nav_state = POSITION;
    TEST_ASSERT_FALSE(follow());
    TEST_ASSERT_TRUE(orders.overruled());
    vehicle.nav_state = MISSION; /* also if the pilot continues the mission */
    assessment.target_ned_m[0] += 100.f;
    TEST_ASSERT_FALSE(follow());
    assessment.action = GOE_FLIGHT_NONE;
    TEST_ASSERT_FALSE(follow(ALL, true));
    TEST_ASSERT_FALSE(orders.overruled());
    assessment.action = GOE_FLIGHT_RIGHT; /* the next order is another one */
    TEST_ASSERT_TRUE(follow());
}

/* Before PX4 returns it waits in Hold: COM_FAIL_ACT_T. A command would cancel the return. */
static void nothing_is_given_in_a_failsafe() {
    vehicle.failsafe = vehicle.lands = true;
    for (const uint8_t mode : {HOLD, LAND}) {
        for (const goe_flight_action_t action : {GOE_FLIGHT_LEFT, GOE_FLIGHT_GO_AROUND}) {
            vehicle.nav_state = mode;
            assessment.action = action;
            TEST_ASSERT_FALSE(follow());
        }
    }
    TEST_ASSERT_FALSE(orders.flown());
    vehicle.failsafe = false;
    TEST_ASSERT_TRUE(follow());
}

/* In Mission PX4 only warns: any other failsafe changes the mode. */
static void a_warning_is_no_failsafe() {
    vehicle.failsafe = true;
    TEST_ASSERT_TRUE(follow());
}

static void a_failsafe_overrules_an_order() {
    TEST_ASSERT_TRUE(follow());
    accept(HOLD);
    TEST_ASSERT_FALSE(follow());
    for (const bool failsafe : {true, false}) {
        vehicle.failsafe = failsafe;
        assessment.target_ned_m[0] += 100.f;
        TEST_ASSERT_FALSE(follow());
        TEST_ASSERT_TRUE(orders.overruled());
    }
    assessment.action = GOE_FLIGHT_NONE;
    for (int i = 0; i < 20; i++) {
        TEST_ASSERT_FALSE(follow(ALL, true));
    }
}

/* Neither if it comes with the end of the order, nor afterwards. */
static void no_mission_is_resumed_in_a_failsafe() {
    for (const bool is_later : {false, true}) {
        setUp();
        TEST_ASSERT_TRUE(follow(ALL, true));
        accept(HOLD);
        TEST_ASSERT_FALSE(follow(ALL, true));
        assessment.action = GOE_FLIGHT_NONE;
        vehicle.failsafe = !is_later;
        TEST_ASSERT_EQUAL(is_later, follow(ALL, true));
        for (int i = 0; i < 40; i++) {
            vehicle.failsafe = i < 20;
            TEST_ASSERT_FALSE(follow(ALL, true));
        }
    }
}

static void a_pilot_who_goes_on_with_the_mission_is_not_fought() {
    TEST_ASSERT_TRUE(follow());
    accept(HOLD);
    TEST_ASSERT_FALSE(follow());
    vehicle.nav_state = MISSION;
    assessment.target_ned_m[0] += 100.f;
    TEST_ASSERT_FALSE(follow());
    TEST_ASSERT_TRUE(orders.overruled());
}

/* The result of the previous order does not count for this one. */
static void the_next_order_begins_afresh() {
    TEST_ASSERT_TRUE(follow());
    accept(HOLD);
    TEST_ASSERT_FALSE(follow());
    assessment.action = GOE_FLIGHT_NONE;
    TEST_ASSERT_TRUE(follow(ALL, true));
    accept(MISSION);
    assessment.action = GOE_FLIGHT_LEFT;
    TEST_ASSERT_TRUE(follow());
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_FALSE(follow());
    }
    TEST_ASSERT_FALSE(orders.overruled());
    TEST_ASSERT_TRUE(follow());
}

static void an_order_that_stood_while_a_pilot_flew_is_given_in_the_mission() {
    vehicle.nav_state = POSITION;
    TEST_ASSERT_FALSE(follow());
    vehicle.nav_state = MISSION;
    TEST_ASSERT_TRUE(follow());
    TEST_ASSERT_FALSE(follow());
    TEST_ASSERT_FALSE(orders.overruled());
}

static void the_mission_is_resumed_if_that_is_wanted() {
    for (const bool wanted : {false, true}) {
        setUp();
        TEST_ASSERT_TRUE(follow());
        accept(HOLD);
        TEST_ASSERT_FALSE(follow());
        assessment.action = GOE_FLIGHT_NONE;
        TEST_ASSERT_EQUAL(wanted, follow(ALL, wanted));
    }
    TEST_ASSERT_EQUAL(vehicle_command_s::VEHICLE_CMD_DO_SET_MODE, command.command);
    CHECK_CLOSE(0, 4, command.param2);
    CHECK_CLOSE(0, 4, command.param3);
    int sent = 1;
    for (int i = 0; i < 100; i++) {
        sent += follow(ALL, true) ? 1 : 0;
    }
    TEST_ASSERT_EQUAL(5, sent); /* unanswered */
}

/* One of a single assessment: nothing has looked at the mode before its end. */
static void the_mission_is_resumed_after_a_short_order() {
    for (const uint8_t mode : {HOLD, POSITION}) {
        setUp();
        TEST_ASSERT_TRUE(follow(ALL, true));
        accept(mode);
        assessment.action = GOE_FLIGHT_NONE;
        TEST_ASSERT_EQUAL(mode == HOLD, follow(ALL, true));
        vehicle.nav_state = HOLD; /* by a pilot */
        TEST_ASSERT_FALSE(follow(ALL, true));
    }
}

static void a_resume_that_is_answered_is_not_repeated() {
    TEST_ASSERT_TRUE(follow());
    accept(HOLD);
    TEST_ASSERT_FALSE(follow());
    assessment.action = GOE_FLIGHT_NONE;
    TEST_ASSERT_TRUE(follow(ALL, true));
    accept(MISSION);
    for (int i = 0; i < 20; i++) {
        TEST_ASSERT_FALSE(follow(ALL, true));
    }
}

/* Commands in Hold, when the target moves, do not make Hold the mode to restore. */
static void the_mission_is_resumed_after_a_target_that_moved() {
    TEST_ASSERT_TRUE(follow());
    accept(HOLD);
    assessment.target_ned_m[0] += 20.f;
    TEST_ASSERT_TRUE(follow());
    accept(HOLD);
    TEST_ASSERT_FALSE(follow());
    assessment.action = GOE_FLIGHT_NONE;
    TEST_ASSERT_TRUE(follow(ALL, true));
}

/* Given up, or only turned away from: it may be ahead in the mission. */
static void the_mission_is_not_resumed_before_the_obstacle_is_passed() {
    for (const bool is_hold : {false, true}) {
        setUp();
        assessment.action = is_hold ? GOE_FLIGHT_HOLD : GOE_FLIGHT_RIGHT;
        TEST_ASSERT_TRUE(follow(ALL, true));
        accept(HOLD);
        TEST_ASSERT_FALSE(follow(ALL, true));
        vehicle.obstacle_known = is_hold;
        assessment.action = GOE_FLIGHT_NONE;
        for (int i = 0; i < 20; i++) {
            TEST_ASSERT_FALSE(follow(ALL, true));
        }
    }
}

static void the_slot_is_that_of_the_latest_order() {
    TEST_ASSERT_EQUAL(-1, orders.slot());
    assessment.avoided = 2;
    (void)follow();
    assessment.action = GOE_FLIGHT_NONE;
    assessment.avoided = -1;
    (void)follow();
    TEST_ASSERT_EQUAL(2, orders.slot());
    assessment.action = GOE_FLIGHT_LEFT; /* that has given up its obstacle */
    (void)follow();
    TEST_ASSERT_EQUAL(-1, orders.slot());
}

/* The layer gives up the obstacle of an order. Later the order is about another one, and that one is passed. */
static void an_obstacle_that_was_given_up_is_not_forgotten() {
    TEST_ASSERT_TRUE(follow(ALL, true));
    accept(HOLD);
    TEST_ASSERT_FALSE(follow(ALL, true));
    for (const int8_t avoided : {-1, 2}) {
        assessment.avoided = avoided;
        TEST_ASSERT_FALSE(follow(ALL, true));
    }
    assessment.action = GOE_FLIGHT_NONE;
    assessment.avoided = -1;
    for (int i = 0; i < 20; i++) {
        TEST_ASSERT_FALSE(follow(ALL, true));
    }
    vehicle.nav_state = MISSION;
    assessment.action = GOE_FLIGHT_LEFT; /* the next order */
    assessment.avoided = 2;
    TEST_ASSERT_TRUE(follow(ALL, true));
    accept(HOLD);
    TEST_ASSERT_FALSE(follow(ALL, true));
    assessment.action = GOE_FLIGHT_NONE;
    TEST_ASSERT_TRUE(follow(ALL, true));
}

/* The order turns from one obstacle to another, and the first one's track ends: at once, after it was passed, or with the order. */
static void an_obstacle_whose_track_ends_under_another_order_may_be_ahead() {
    for (const bool is_passed : {false, true}) {
        for (const bool is_at_end : {false, true}) {
            setUp();
            TEST_ASSERT_TRUE(follow(ALL, true));
            accept(HOLD);
            TEST_ASSERT_FALSE(follow(ALL, true));
            assessment.avoided = 1;
            vehicle.behind = is_passed ? 1u << 0 : 0u;
            TEST_ASSERT_FALSE(follow(ALL, true));
            vehicle.behind = 0;
            vehicle.gone = is_at_end ? 0u : 1u << 0;
            TEST_ASSERT_FALSE(follow(ALL, true));
            vehicle.gone = is_at_end ? 1u << 0 : 0u;
            assessment.action = GOE_FLIGHT_NONE;
            assessment.avoided = -1;
            TEST_ASSERT_EQUAL(is_passed, follow(ALL, true));
        }
    }
}

/* The slot of a new obstacle was without a position before. Another slot without one does not count. */
static void an_obstacle_that_comes_into_a_slot_is_no_loss() {
    vehicle.gone = 1u << 0 | 1u << 3;
    TEST_ASSERT_TRUE(follow(ALL, true));
    accept(HOLD);
    vehicle.gone = 1u << 3;
    TEST_ASSERT_FALSE(follow(ALL, true));
    assessment.action = GOE_FLIGHT_NONE;
    TEST_ASSERT_TRUE(follow(ALL, true));
}

static void an_order_in_hold_resumes_nothing() {
    vehicle.nav_state = HOLD;
    TEST_ASSERT_TRUE(follow());
    accept(HOLD);
    TEST_ASSERT_FALSE(follow());
    assessment.action = GOE_FLIGHT_NONE;
    TEST_ASSERT_FALSE(follow(ALL, true));
}

/* A side precedes a go-around over a top that is not known. */
static void a_side_is_flown_in_landing() {
    for (const goe_flight_action_t action : {GOE_FLIGHT_LEFT, GOE_FLIGHT_RIGHT, GOE_FLIGHT_HOLD}) {
        for (const uint8_t mode : {MISSION, HOLD, LAND}) {
            setUp();
            assessment.action = action;
            vehicle.nav_state = mode;
            vehicle.lands = true;
            TEST_ASSERT_TRUE(follow());
            TEST_ASSERT_EQUAL(vehicle_command_s::VEHICLE_CMD_DO_REPOSITION, command.command);
            accept(HOLD);
            vehicle.lands = false;
            for (int i = 0; i < 20; i++) {
                TEST_ASSERT_FALSE(follow());
            }
            TEST_ASSERT_FALSE(orders.overruled());
            assessment.action = GOE_FLIGHT_GO_AROUND; /* the top becomes known */
            assessment.target_ned_m[2] = -40.f;
            TEST_ASSERT_TRUE(follow());
            TEST_ASSERT_EQUAL(vehicle_command_s::VEHICLE_CMD_DO_REPOSITION, command.command);
            TEST_ASSERT_TRUE(__builtin_isnan(command.param5) && __builtin_isnan(command.param6));
            CHECK_CLOSE(0, 529, command.param7);
        }
    }
}

static void in_landing_a_side_that_may_not_be_flown_is_a_go_around() {
    for (const bool has_origin : {false, true}) {
        for (const uint8_t mode : {MISSION, LAND}) {
            setUp();
            vehicle.nav_state = mode;
            vehicle.lands = true;
            vehicle.origin_known = has_origin;
            const int32_t react = has_origin ? GOE_REACT_GO_AROUND : ALL;
            TEST_ASSERT_TRUE(follow(react));
            TEST_ASSERT_EQUAL(vehicle_command_s::VEHICLE_CMD_DO_GO_AROUND, command.command);
            TEST_ASSERT_TRUE(orders.flown());
            accept(mode == LAND ? HOLD : MISSION);
            for (const bool lands : {true, false}) {
                vehicle.lands = lands;
                for (int i = 0; i < 20; i++) {
                    TEST_ASSERT_FALSE(follow(react));
                }
            }
            assessment.action = GOE_FLIGHT_NONE;
            TEST_ASSERT_FALSE(follow(react, true));
        }
    }
}

/* Later in the mission: the order is flown, and when the obstacle is passed the mission continues. */
static void pass_another_one(goe_flight_action_t action) {
    assessment.action = action;
    vehicle.nav_state = MISSION;
    TEST_ASSERT_TRUE(follow(ALL, true));
    accept(HOLD);
    TEST_ASSERT_FALSE(follow(ALL, true));
    assessment.action = GOE_FLIGHT_NONE;
    TEST_ASSERT_TRUE(follow(ALL, true));
    TEST_ASSERT_EQUAL(vehicle_command_s::VEHICLE_CMD_DO_SET_MODE, command.command);
}

/* From next to the runway it would lead to the same landing. */
static void no_mission_is_resumed_after_a_side_in_landing() {
    vehicle.lands = true;
    TEST_ASSERT_TRUE(follow(ALL, true));
    accept(HOLD);
    vehicle.lands = false;
    TEST_ASSERT_FALSE(follow(ALL, true));
    assessment.action = GOE_FLIGHT_NONE;
    for (int i = 0; i < 20; i++) {
        TEST_ASSERT_FALSE(follow(ALL, true));
    }
    pass_another_one(GOE_FLIGHT_LEFT);
}

static void a_go_around_is_given_in_landing() {
    assessment.action = GOE_FLIGHT_GO_AROUND;
    vehicle.nav_state = LAND;
    vehicle.lands = true;
    vehicle.origin_known = false;
    TEST_ASSERT_FALSE(follow(REPOSITION));
    TEST_ASSERT_TRUE(follow());
    TEST_ASSERT_EQUAL(vehicle_command_s::VEHICLE_CMD_DO_GO_AROUND, command.command);
    accept(LAND);
    for (int i = 0; i < 20; i++) {
        TEST_ASSERT_FALSE(follow());
    }
    for (const uint8_t mode : {HOLD, LAND}) { /* PX4 decides where it leads */
        vehicle.nav_state = mode;
        TEST_ASSERT_FALSE(follow());
        TEST_ASSERT_FALSE(orders.overruled());
    }
}

/* A go-around that PX4 has accepted: it is_hold at `alt_m`, by its own parameter. */
static void go_around(uint8_t mode, float alt_m) {
    assessment.action = GOE_FLIGHT_GO_AROUND;
    vehicle.nav_state = mode;
    vehicle.lands = true;
    TEST_ASSERT_TRUE(follow());
    TEST_ASSERT_EQUAL(vehicle_command_s::VEHICLE_CMD_DO_GO_AROUND, command.command);
    CHECK_CLOSE(0, 519, command.param1);
    accept(mode == LAND ? HOLD : mode);
    vehicle.lands = false;
    vehicle.setpoint_alt_m = alt_m;
}

static void a_go_around_climbs_as_high_as_the_top_requires() {
    for (const uint8_t mode : {MISSION, LAND}) {
        setUp();
        go_around(mode, 505.f);
        TEST_ASSERT_TRUE(follow(GOE_REACT_GO_AROUND));
        TEST_ASSERT_EQUAL(vehicle_command_s::VEHICLE_CMD_DO_REPOSITION, command.command);
        CHECK_CLOSE(0, 1, command.param2);
        TEST_ASSERT_TRUE(__builtin_isnan(command.param4));
        TEST_ASSERT_TRUE(__builtin_isnan(command.param5) && __builtin_isnan(command.param6)); /* where PX4 is_hold */
        CHECK_CLOSE(0, 519, command.param7);
        for (int i = 0; i < 4; i++) {
            TEST_ASSERT_FALSE(follow());
        }
        TEST_ASSERT_TRUE(follow()); /* not accepted yet */
        accept(HOLD);
        vehicle.setpoint_alt_m = 519.f;
        for (int i = 0; i < 20; i++) {
            TEST_ASSERT_FALSE(follow());
        }
        assessment.target_ned_m[2] = -34.f; /* it is higher than estimated */
        TEST_ASSERT_TRUE(follow());
        CHECK_CLOSE(0, 523, command.param7);
    }
}

static void a_go_around_that_is_high_enough_is_left_to_px4() {
    go_around(MISSION, 520.f);
    for (int i = 0; i < 20; i++) {
        TEST_ASSERT_FALSE(follow());
    }
}

static void a_go_around_climbs_no_higher_while_px4_still_lands() {
    go_around(LAND, 489.f);
    vehicle.nav_state = LAND;
    vehicle.lands = true;
    for (int i = 0; i < 20; i++) {
        TEST_ASSERT_FALSE(follow());
    }
}

static void without_an_altitude_a_go_around_is_all_that_px4_makes_of_it() {
    assessment.action = GOE_FLIGHT_GO_AROUND;
    vehicle.lands = true;
    vehicle.altitude_known = false;
    TEST_ASSERT_TRUE(follow());
    CHECK_CLOSE(0, 0, command.param1);
    accept(MISSION);
    vehicle.lands = false;
    for (int i = 0; i < 20; i++) {
        TEST_ASSERT_FALSE(follow());
    }
}

/* PX4 acknowledges DO_GO_AROUND, but only a fixed wing flies it. */
static void a_multicopter_goes_around_by_a_climb() {
    assessment.action = GOE_FLIGHT_GO_AROUND;
    vehicle.nav_state = LAND;
    vehicle.lands = true;
    vehicle.has_wings = false;
    TEST_ASSERT_TRUE(follow());
    TEST_ASSERT_EQUAL(vehicle_command_s::VEHICLE_CMD_DO_REPOSITION, command.command);
    CHECK_CLOSE(0, 519, command.param7);
}

static void a_pilot_is_not_fought_after_a_go_around() {
    go_around(MISSION, 505.f);
    TEST_ASSERT_TRUE(follow());
    TEST_ASSERT_FALSE(follow()); /* still in the mission */
    TEST_ASSERT_FALSE(orders.overruled());
    accept(HOLD);
    TEST_ASSERT_FALSE(follow());
    vehicle.nav_state = MISSION; /* to land again */
    for (int i = 0; i < 20; i++) {
        TEST_ASSERT_FALSE(follow());
    }
    TEST_ASSERT_TRUE(orders.overruled());
}

/* It would lead to the same landing. */
static void no_mission_is_resumed_after_a_go_around() {
    for (const bool turns : {false, true}) {
        setUp();
        go_around(MISSION, 505.f);
        TEST_ASSERT_TRUE(follow(ALL, true));
        accept(HOLD);
        vehicle.setpoint_alt_m = 519.f;
        TEST_ASSERT_FALSE(follow(ALL, true));
        if (turns) {
            assessment.action = GOE_FLIGHT_LEFT;
            TEST_ASSERT_TRUE(follow(ALL, true));
            accept(HOLD);
        }
        assessment.action = GOE_FLIGHT_NONE;
        for (int i = 0; i < 20; i++) {
            TEST_ASSERT_FALSE(follow(ALL, true));
        }
    }
}

static void an_order_after_a_go_around_is_another_one() {
    go_around(MISSION, 505.f);
    TEST_ASSERT_TRUE(follow(ALL, true));
    accept(HOLD);
    assessment.action = GOE_FLIGHT_NONE;
    TEST_ASSERT_FALSE(follow(ALL, true));
    go_around(MISSION, 505.f); /* the second landing */
    TEST_ASSERT_FALSE(orders.overruled());
    vehicle.nav_state = LAND; /* again PX4 decides where DO_GO_AROUND leads */
    vehicle.setpoint_alt_m = 519.f;
    TEST_ASSERT_FALSE(follow(ALL, true));
    TEST_ASSERT_FALSE(orders.overruled());
    assessment.action = GOE_FLIGHT_NONE;
    TEST_ASSERT_FALSE(follow(ALL, true));
    pass_another_one(GOE_FLIGHT_RIGHT);
}

/* ------------------------------------------------------------------------------------------------------ the whole, flown */

static Px4Flight flight;
static vehicle_command_s last;

static constexpr uint8_t SYSTEM = 1, GROUND_STATION = 255, MODULE = 1, COMPANION = 196;

/* Towards a mast or, when landing, a truck. */
static void start_towards_one(uint8_t mode, bool lands, int32_t react) {
    flight.begin();
    standin::set("GOE_REACT", react);
    if (lands) {
        flight.flown.scene.altitude_m = 12.0; /* over a truck of 2.5 m: less than GOE_CLEAR */
    } else {
        scene_make_cylinder(&flight.flown.scene);
    }
    flight.flown.scene.x0_m = 0.5;
    flight.flown.scene.z0_m = 260.0;
    flight.position.xy_global = flight.position.z_global = true;
    flight.position.ref_lat = 47.4;
    flight.position.ref_lon = 8.5;
    flight.position.ref_alt = 489.f;
    flight.follows = !lands;
    position_setpoint_triplet_s setpoint{};
    setpoint.current.valid = true;
    setpoint.current.alt = 489.f;
    setpoint.current.type =
        lands ? position_setpoint_s::SETPOINT_TYPE_LAND : position_setpoint_s::SETPOINT_TYPE_POSITION;
    standin::publish(ORB_ID(position_setpoint_triplet), &setpoint);
    flight.set_mode(true, mode);
}

/* As PX4 does: it aborts the landing, and is_hold `above_m` above it. */
static void hold_over_the_landing(float above_m) {
    position_setpoint_triplet_s setpoint{};
    setpoint.current.valid = true;
    setpoint.current.type = position_setpoint_s::SETPOINT_TYPE_LOITER;
    setpoint.current.alt = 489.f + above_m;
    standin::publish(ORB_ID(position_setpoint_triplet), &setpoint);
}

/* PX4 accepts the command, and reports that to `asker`. */
static void obey(const vehicle_command_s &one, uint8_t asker, uint8_t component) {
    vehicle_command_ack_s ack{};
    ack.command = one.command;
    ack.target_system = asker;
    ack.target_component = component;
    standin::publish(ORB_ID(vehicle_command_ack), &ack);
    if (one.command == vehicle_command_s::VEHICLE_CMD_DO_REPOSITION) {
        flight.set_mode(true, HOLD);
    } else if (one.command == vehicle_command_s::VEHICLE_CMD_DO_SET_MODE) {
        flight.set_mode(true, MISSION);
    }
}

/* Returns the number of commands; the first and the last one are kept. */
static unsigned fly_on(double seconds, uint8_t asker = SYSTEM, uint8_t component = MODULE) {
    unsigned commands = 0;
    for (int i = 0; i < static_cast<int>(seconds * FLOWN_POSE_HZ); i++) {
        const unsigned before = standin::published(ORB_ID(vehicle_command));
        flight.step();
        if (standin::published(ORB_ID(vehicle_command)) > before) {
            TEST_ASSERT_TRUE(standin::latest(ORB_ID(vehicle_command), 0, &last));
            command = commands == 0 ? last : command;
            obey(last, asker, component);
            commands++;
        }
    }
    return commands;
}

static unsigned fly_towards_one(uint8_t mode, bool lands, double seconds, int32_t react) {
    start_towards_one(mode, lands, react);
    return fly_on(seconds);
}

static void no_command_is_ever_given_by_default() {
    TEST_ASSERT_EQUAL(0, fly_towards_one(MISSION, false, 14.0, 0));
    TEST_ASSERT_NOT_EQUAL(GOE_FLIGHT_NONE, flight.status().action); /* it is reported */
    TEST_ASSERT_FALSE(flight.status().flown);
    TEST_ASSERT_TRUE(standin::mavlink_texts().find("(reported only)") != std::string::npos);
    flight.end();
}

static void a_mast_on_the_course_is_passed_aside() {
    TEST_ASSERT_GREATER_THAN(0, fly_towards_one(MISSION, false, 13.0, ALL));
    TEST_ASSERT_TRUE(flight.status().flown);
    TEST_ASSERT_EQUAL(vehicle_command_s::VEHICLE_CMD_DO_REPOSITION, command.command);
    TEST_ASSERT_EQUAL(1, command.target_system);
    CHECK_CLOSE(2.0, 489.f - flight.position.z, command.param7); /* its own height, in level flight */
    TEST_ASSERT_EQUAL(1, command.target_component);
    TEST_ASSERT_EQUAL(1, command.source_component);
    TEST_ASSERT_FALSE(command.from_external);
    const double east_m = (command.param6 - 8.5) * 111194.9 * std::cos(47.4 * 0.0174532925);
    check_report("target aside of the course, m", std::fabs(east_m));
    TEST_ASSERT_TRUE(std::fabs(east_m) > 15.0 && std::fabs(east_m) < 200.0); /* margin; with the loiter circle */
    TEST_ASSERT_TRUE(standin::mavlink_texts().find("goe: obstacle in") != std::string::npos);
    flight.end();
}

static void it_flies_on_in_its_mission_past_the_mast() {
    start_towards_one(MISSION, false, ALL);
    standin::set("GOE_RESUME", 1);
    TEST_ASSERT_GREATER_THAN(1, fly_on(20.0));
    TEST_ASSERT_EQUAL(vehicle_command_s::VEHICLE_CMD_DO_SET_MODE, last.command);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_NONE, flight.status().action);
    TEST_ASSERT_TRUE(standin::mavlink_texts().find("goe: the order ends") != std::string::npos);
    flight.end();
}

static void the_answer_to_another_sender_is_none_to_the_module() {
    start_towards_one(MISSION, false, ALL);
    const unsigned answered = fly_on(13.0);
    flight.end();
    start_towards_one(MISSION, false, ALL);
    TEST_ASSERT_GREATER_THAN(answered + 2, fly_on(13.0, GROUND_STATION));
    flight.end();
    start_towards_one(MISSION, false, ALL);
    TEST_ASSERT_GREATER_THAN(answered + 2, fly_on(13.0, SYSTEM, COMPANION));
    flight.end();
}

/* A pilot who has taken over flies as without a failsafe. */
static void a_failsafe_is_left_to_px4() {
    for (const bool took_over : {false, true}) {
        start_towards_one(HOLD, false, ALL);
        flight.failsafe = true;
        flight.user_took_over = took_over;
        flight.set_mode(true, HOLD);
        TEST_ASSERT_EQUAL(took_over, fly_on(13.0) > 0);
        TEST_ASSERT_NOT_EQUAL(GOE_FLIGHT_NONE, flight.status().action);
        flight.end();
    }
}

/* A reset of the heading ends the track. The obstacle keeps its position, and the order stays active until it is passed. For that long
 * settings wait; then the mission continues. */
static void an_order_outlives_its_track() {
    start_towards_one(MISSION, false, ALL);
    flight.flown.scene.x0_m = 10.0; /* nobody flies the order: the aircraft passes the mast within the margin */
    standin::set("GOE_RESUME", 1);
    TEST_ASSERT_GREATER_THAN(0, fly_on(10.0));
    flight.flown.detects = false;
    flight.quat_reset_counter++;
    (void)fly_on(0.2);
    TEST_ASSERT_EQUAL(1, flight.status().obstacles);
    TEST_ASSERT_NOT_EQUAL(GOE_FLIGHT_NONE, flight.status().action);
    standin::set("GOE_MARGIN", 40.f);
    (void)fly_on(3.2);
    TEST_ASSERT_TRUE(flight.status().settings_waiting);
    TEST_ASSERT_NOT_EQUAL(GOE_FLIGHT_NONE, flight.status().action);
    flight.follows = false;
    (void)fly_on(16.0);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_NONE, flight.status().action);
    TEST_ASSERT_FALSE(flight.status().settings_waiting);
    TEST_ASSERT_EQUAL(vehicle_command_s::VEHICLE_CMD_DO_SET_MODE, last.command); /* past it, the mission continues */
    flight.end();
}

/* Without a position after a reset of the heading nothing can be assessed. That ends no order: a pilot who has overruled it is not
 * overridden later, and parameters go on waiting. */
static void what_cannot_be_assessed_ends_no_order() {
    start_towards_one(MISSION, false, ALL);
    flight.follows = false;
    for (int i = 0; i < 130 && fly_on(0.1) == 0; i++) {
    }
    (void)fly_on(0.3);
    flight.set_mode(true, MISSION);
    standin::set("GOE_CLEAR", 12.f);
    (void)fly_on(1.2);
    const uint8_t action = flight.status().action;
    TEST_ASSERT_TRUE(action != GOE_FLIGHT_NONE && flight.status().overruled && flight.status().settings_waiting);
    for (const bool has_position : {false, true}) {
        flight.sends_position = has_position;
        flight.quat_reset_counter = static_cast<uint8_t>(flight.quat_reset_counter + (has_position ? 0 : 1));
        TEST_ASSERT_EQUAL(0, fly_on(0.3));
        TEST_ASSERT_EQUAL(has_position, flight.status().pose_alive);
        TEST_ASSERT_TRUE(flight.status().pose_agrees);
        TEST_ASSERT_EQUAL(action, flight.status().action);
        TEST_ASSERT_TRUE(flight.status().overruled && flight.status().settings_waiting);
    }
    TEST_ASSERT_TRUE(standin::mavlink_texts().find("the order ends") == std::string::npos);
    flight.end();
}

static void the_status_reports_a_pilot_and_refusals() {
    start_towards_one(MISSION, false, ALL);
    TEST_ASSERT_GREATER_THAN(0, fly_on(10.0, GROUND_STATION));
    TEST_ASSERT_FALSE(flight.status().overruled);
    vehicle_command_ack_s ack{};
    ack.command = vehicle_command_s::VEHICLE_CMD_DO_REPOSITION;
    ack.target_system = SYSTEM;
    ack.target_component = MODULE;
    ack.result = vehicle_command_ack_s::VEHICLE_CMD_RESULT_DENIED;
    standin::publish(ORB_ID(vehicle_command_ack), &ack);
    flight.fly(0.2);
    TEST_ASSERT_EQUAL(1, flight.status().commands_refused);
    flight.set_mode(true, POSITION);
    (void)fly_on(0.3);
    TEST_ASSERT_TRUE(flight.status().overruled);
    TEST_ASSERT_EQUAL(0, goe_command("status"));
    TEST_ASSERT_TRUE(standin::console().find(", overruled, needs") != std::string::npos);
    flight.end();
}

/* A pilot has taken over; the layer's order changes, and nobody flies the new one. */
static void an_order_that_nobody_flies_is_reported_as_such() {
    start_towards_one(MISSION, false, ALL);
    flight.follows = false;
    for (int i = 0; i < 130 && fly_on(0.1) == 0; i++) {
    }
    (void)fly_on(0.3);
    flight.set_mode(true, POSITION);
    (void)fly_on(0.3);
    TEST_ASSERT_TRUE(flight.status().overruled);
    const uint8_t action = flight.status().action;
    standin::mavlink_texts().clear();
    flight.flown.detects = false; /* straight on, until the side can no longer be reached */
    flight.quat_reset_counter++;
    for (int i = 0; i < 100 && (flight.status().action == action || flight.status().action == GOE_FLIGHT_NONE); i++) {
        TEST_ASSERT_EQUAL(0, fly_on(0.1));
    }
    TEST_ASSERT_TRUE(flight.status().action != action && flight.status().action != GOE_FLIGHT_NONE);
    TEST_ASSERT_TRUE(standin::mavlink_texts().find("(overruled)") != std::string::npos);
    flight.end();
}

static void fly_into_a_go_around() {
    start_towards_one(LAND, true, ALL);
    for (int i = 0; i < 140 && fly_on(0.1) == 0; i++) {
    }
    TEST_ASSERT_EQUAL(vehicle_command_s::VEHICLE_CMD_DO_GO_AROUND, command.command);
}

static void an_approach_is_broken_off() {
    fly_into_a_go_around();
    flight.end();
}

/* The top of a mast is above the image: a side precedes a go-around over it. */
static void an_approach_to_a_mast_of_unknown_height_leaves_it_aside() {
    start_towards_one(LAND, true, ALL);
    scene_make_cylinder(&flight.flown.scene);
    flight.flown.scene.height_m = 300.0;
    flight.flown.scene.altitude_m = 25.0;
    unsigned commands = 0;
    for (int i = 0; i < 140 && commands == 0; i++) {
        commands = fly_on(0.1);
    }
    TEST_ASSERT_EQUAL(1, commands);
    TEST_ASSERT_EQUAL(vehicle_command_s::VEHICLE_CMD_DO_REPOSITION, command.command);
    const uint8_t action = flight.status().action;
    TEST_ASSERT_TRUE(action == GOE_FLIGHT_LEFT || action == GOE_FLIGHT_RIGHT);
    TEST_ASSERT_TRUE(flight.status().flown);
    flight.end();
}

static void an_approach_that_px4_breaks_off_high_enough_gets_no_second_command() {
    fly_into_a_go_around();
    hold_over_the_landing(60.f);
    TEST_ASSERT_EQUAL(0, fly_on(0.4));
    flight.end();
}

/* 12 m high over a truck of 2.5 m: PX4's own height does not clear it by GOE_CLEAR. */
static void an_approach_that_is_broken_off_climbs_over_the_obstacle() {
    fly_into_a_go_around();
    hold_over_the_landing(10.f);
    TEST_ASSERT_EQUAL(1, fly_on(0.4));
    TEST_ASSERT_EQUAL(vehicle_command_s::VEHICLE_CMD_DO_REPOSITION, command.command);
    CHECK_CLOSE(0.01, 489.f - flight.status().target[2], command.param7);
    TEST_ASSERT_TRUE(command.param7 > 489.f + 12.5f); /* top and GOE_CLEAR */
    flight.end();
}

static void publish_flare() {
    position_controller_landing_status_s topic{};
    topic.timestamp = standin::now_us();
    topic.flaring = true;
    standin::publish(ORB_ID(position_controller_landing_status), &topic);
}

/* An obstacle behind the touchdown point. */
static void a_landing_is_not_broken_off_from_the_flare_on() {
    start_towards_one(LAND, true, ALL);
    bool reported = false;
    for (int i = 0; i < 140; i++) {
        publish_flare();
        TEST_ASSERT_EQUAL(0, fly_on(0.1));
        TEST_ASSERT_EQUAL(GOE_FLIGHT_NONE, flight.status().action);
        reported = reported || flight.status().worst >= 0;
    }
    TEST_ASSERT_TRUE(reported); /* the hazard exists nevertheless */
    flight.end();
}

static void after_touchdown_nothing_is_ordered() {
    start_towards_one(LAND, true, ALL);
    vehicle_land_detected_s topic{};
    topic.timestamp = standin::now_us();
    topic.landed = true;
    standin::publish(ORB_ID(vehicle_land_detected), &topic);
    TEST_ASSERT_EQUAL(0, fly_on(14.0));
    TEST_ASSERT_EQUAL(0, goe_command("status"));
    TEST_ASSERT_TRUE(standin::console().find("; on the ground") != std::string::npos);
    flight.end();
}

int main() {
    UNITY_BEGIN();
    RUN_TEST(a_place_is_a_reposition_with_change_of_mode);
    RUN_TEST(without_an_altitude_it_keeps_its_own);
    RUN_TEST(nothing_is_given_unless_all_allows_it);
    RUN_TEST(it_is_repeated_until_it_is_answered);
    RUN_TEST(a_refusal_is_counted_and_repeated);
    RUN_TEST(a_target_that_moves_is_sent_again);
    RUN_TEST(another_action_is_sent_at_once);
    RUN_TEST(a_pilot_is_not_fought);
    RUN_TEST(nothing_is_given_in_a_failsafe);
    RUN_TEST(a_warning_is_no_failsafe);
    RUN_TEST(a_failsafe_overrules_an_order);
    RUN_TEST(no_mission_is_resumed_in_a_failsafe);
    RUN_TEST(a_pilot_who_goes_on_with_the_mission_is_not_fought);
    RUN_TEST(the_next_order_begins_afresh);
    RUN_TEST(an_order_that_stood_while_a_pilot_flew_is_given_in_the_mission);
    RUN_TEST(the_mission_is_resumed_if_that_is_wanted);
    RUN_TEST(the_mission_is_resumed_after_a_short_order);
    RUN_TEST(a_resume_that_is_answered_is_not_repeated);
    RUN_TEST(the_mission_is_resumed_after_a_target_that_moved);
    RUN_TEST(the_mission_is_not_resumed_before_the_obstacle_is_passed);
    RUN_TEST(the_slot_is_that_of_the_latest_order);
    RUN_TEST(an_obstacle_that_was_given_up_is_not_forgotten);
    RUN_TEST(an_obstacle_whose_track_ends_under_another_order_may_be_ahead);
    RUN_TEST(an_obstacle_that_comes_into_a_slot_is_no_loss);
    RUN_TEST(an_order_in_hold_resumes_nothing);
    RUN_TEST(a_side_is_flown_in_landing);
    RUN_TEST(in_landing_a_side_that_may_not_be_flown_is_a_go_around);
    RUN_TEST(no_mission_is_resumed_after_a_side_in_landing);
    RUN_TEST(a_go_around_is_given_in_landing);
    RUN_TEST(a_go_around_climbs_as_high_as_the_top_requires);
    RUN_TEST(a_go_around_that_is_high_enough_is_left_to_px4);
    RUN_TEST(a_go_around_climbs_no_higher_while_px4_still_lands);
    RUN_TEST(without_an_altitude_a_go_around_is_all_that_px4_makes_of_it);
    RUN_TEST(a_multicopter_goes_around_by_a_climb);
    RUN_TEST(a_pilot_is_not_fought_after_a_go_around);
    RUN_TEST(no_mission_is_resumed_after_a_go_around);
    RUN_TEST(an_order_after_a_go_around_is_another_one);
    RUN_TEST(no_command_is_ever_given_by_default);
    RUN_TEST(a_mast_on_the_course_is_passed_aside);
    RUN_TEST(it_flies_on_in_its_mission_past_the_mast);
    RUN_TEST(the_answer_to_another_sender_is_none_to_the_module);
    RUN_TEST(a_failsafe_is_left_to_px4);
    RUN_TEST(an_order_outlives_its_track);
    RUN_TEST(what_cannot_be_assessed_ends_no_order);
    RUN_TEST(the_status_reports_a_pilot_and_refusals);
    RUN_TEST(an_order_that_nobody_flies_is_reported_as_such);
    RUN_TEST(an_approach_to_a_mast_of_unknown_height_leaves_it_aside);
    RUN_TEST(an_approach_is_broken_off);
    RUN_TEST(an_approach_that_is_broken_off_climbs_over_the_obstacle);
    RUN_TEST(an_approach_that_px4_breaks_off_high_enough_gets_no_second_command);
    RUN_TEST(a_landing_is_not_broken_off_from_the_flare_on);
    RUN_TEST(after_touchdown_nothing_is_ordered);
    return UNITY_END();
}
