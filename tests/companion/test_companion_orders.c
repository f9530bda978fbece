/* Orders: when commands are sent, when none is, and when the previous mode is restored. SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "orders.h"
#include "receiver.h"

#define SYSTEM 1
#define MISSION (4u << 16 | 4u << 24)
#define LOITER (4u << 16 | 3u << 24)
#define LAND (4u << 16 | 6u << 24)
#define POSITION (3u << 16)
#define AUTO 10u /* of ArduPlane */
#define CRUISE 7u
#define AVOID 14u
#define PLANE_LOITER 12u
#define STEP_US 100000 /* between assessments */

static int waits; /* for the disk */

/* In place of the system's. */
int fdatasync(int file) {
    (void)file;
    waits++;
    return 0;
}

static companion_config_t config;
static goe_flight_t flight;
static wire_t wire;
static autopilot_t autopilot;
static orders_t orders;
static goe_flight_assessment_t assessment;
static goe_mavlink_own_t own;
static int64_t now_us;
static receiver_t receiver;      /* receives the companion's messages */
static mavlink_message_t latest; /* the latest received command */
static bool has_arrived[256];    /* traffic, by the last byte of its address */
static int arrived;              /* traffic messages */

void setUp(void) {
    const char *bad = NULL;
    (void)memset(&config, 0, sizeof config);
    (void)memset(&wire, 0, sizeof wire);
    (void)memset(&autopilot, 0, sizeof autopilot);
    (void)memset(&assessment, 0, sizeof assessment);
    (void)memset(&own, 0, sizeof own);
    goe_settings_default(&config.estimator);
    goe_flight_settings_default(&config.flight);
    config.estimator.camera.fx_px = config.estimator.camera.fy_px = 900.0f;
    config.estimator.camera.cx_px = config.estimator.camera.cy_px = 0.0f;
    config.estimator.camera.width_px = config.estimator.camera.height_px = 1000.0f;
    config.reaction_mode = REACTION_PX4;
    config.reaction_modes = 3;
    config.reaction_resume = 1;
    config.reaction_adsb_hz = 2.0;
    config.reaction_icao = 0xF0E000;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_init(&flight, sizeof flight, &config.estimator, &config.flight, &bad));
    receiver_open(&receiver, &wire);
    autopilot.system = SYSTEM;
    autopilot.kind = MAV_AUTOPILOT_PX4;
    autopilot.base_mode = MAV_MODE_FLAG_SAFETY_ARMED;
    autopilot.custom_mode = MISSION;
    autopilot.origin_given = true;
    autopilot.heartbeats = 10;
    autopilot.heartbeat_us = 1000000;
    assessment.worst = assessment.avoided = -1;
    now_us = 1000000;
    orders_init(&orders, &wire, &config, &autopilot, &flight);
}

void tearDown(void) { receiver_close(&receiver, &wire); }

/* The number of commands of this kind since the last call; the latest is in `latest`. */
static int count_commands(uint16_t number) {
    int count = 0;
    mavlink_message_t message;
    while (receiver_next(&receiver, &message)) {
        if (message.msgid == MAVLINK_MSG_ID_ADSB_VEHICLE) {
            has_arrived[mavlink_msg_adsb_vehicle_get_ICAO_address(&message) & 0xFFu] = true;
            arrived++;
        }
        if (message.msgid != MAVLINK_MSG_ID_COMMAND_INT && message.msgid != MAVLINK_MSG_ID_COMMAND_LONG) {
            continue;
        }
        const bool is_int = message.msgid == MAVLINK_MSG_ID_COMMAND_INT;
        const uint16_t command =
            is_int ? mavlink_msg_command_int_get_command(&message) : mavlink_msg_command_long_get_command(&message);
        latest = command == number ? message : latest;
        count += command == number ? 1 : 0;
    }
    return count;
}

/* The number of traffic messages since the last call. */
static int count_traffic(void) {
    arrived = 0;
    (void)memset(has_arrived, 0, sizeof has_arrived);
    (void)count_commands(0);
    return arrived;
}

/* Gives the flight layer's order, about the obstacle in slot 0. */
static void decide(goe_flight_action_t action) {
    assessment.action = action;
    assessment.avoided = action == GOE_FLIGHT_NONE ? -1 : 0;
    assessment.target_lat_e7 = 474000000;
    assessment.target_lon_e7 = 85000000;
    assessment.target_ned_m[2] = -30.0f;
}

/* Runs so many assessments, with a heartbeat of this mode each second. */
static void go_on(int assessments, uint32_t mode) {
    for (int k = 0; k < assessments; k++) {
        now_us += STEP_US;
        if (now_us % 1000000 == 0) {
            autopilot.custom_mode = mode;
            autopilot.heartbeats++;
            autopilot.heartbeat_us = now_us;
        }
        orders_follow(&orders, &assessment, &own, now_us);
    }
}

static void answer_as(uint8_t system, uint8_t component, uint8_t to, uint16_t command, uint8_t result) {
    mavlink_message_t message;
    (void)mavlink_msg_command_ack_pack(system, component, &message, command, result, 0, 0, 0, to);
    orders_take(&orders, &message);
}

static void answer(uint16_t command, uint8_t result) { answer_as(SYSTEM, MAV_COMP_ID_AUTOPILOT1, 0, command, result); }

/* An obstacle in the flight layer, or one that it has given up. */
static void know_obstacle(bool known) {
    goe_flight_attitude_t attitude = {5000000, {1.0f, 0.0f, 0.0f, 0.0f}, 0};
    goe_flight_position_t position;
    (void)memset(&position, 0, sizeof position);
    position.time_us = 5000000;
    (void)goe_flight_attitude(&flight, &attitude);
    (void)goe_flight_position(&flight, &position);
    flight.slot[0].used = known;
    flight.slot[0].valid = GOE_HAS_POSITION;
}

static void ordered(void) {
    decide(GOE_FLIGHT_LEFT);
    go_on(1, MISSION);
    TEST_ASSERT_EQUAL_INT(1, count_commands(MAV_CMD_DO_REPOSITION));
    answer(MAV_CMD_DO_REPOSITION, MAV_RESULT_ACCEPTED);
    go_on(40, LOITER);
    TEST_ASSERT_EQUAL_INT(0, count_commands(MAV_CMD_DO_REPOSITION));
}

static void ordered_again(void) {
    autopilot.custom_mode = MISSION;
    ordered();
}

static void an_order_is_repeated_until_it_is_acknowledged(void) {
    decide(GOE_FLIGHT_LEFT);
    go_on(21, MISSION);
    TEST_ASSERT_EQUAL_INT(5, count_commands(MAV_CMD_DO_REPOSITION)); /* at once, and every half second */
    TEST_ASSERT_EQUAL_INT32(474000000, mavlink_msg_command_int_get_x(&latest));
    TEST_ASSERT_EQUAL_UINT8(MAV_FRAME_GLOBAL_INT, mavlink_msg_command_int_get_frame(&latest));
    answer(MAV_CMD_DO_SET_MODE, MAV_RESULT_ACCEPTED); /* of another sender */
    go_on(6, MISSION);
    TEST_ASSERT_EQUAL_INT(1, count_commands(MAV_CMD_DO_REPOSITION));
    answer(MAV_CMD_DO_REPOSITION, MAV_RESULT_ACCEPTED);
    go_on(20, LOITER);
    TEST_ASSERT_EQUAL_INT(0, count_commands(MAV_CMD_DO_REPOSITION));
}

/* A camera or a gimbal of the same system knows nothing of the order, nor does an answer to another component's command. */
static void only_the_autopilots_answer_to_the_companion_counts(void) {
    wire.component = MAV_COMP_ID_OBSTACLE_AVOIDANCE;
    decide(GOE_FLIGHT_LEFT);
    go_on(1, MISSION);
    answer_as(SYSTEM, MAV_COMP_ID_GIMBAL, 0, MAV_CMD_DO_REPOSITION, MAV_RESULT_UNSUPPORTED);
    answer_as(SYSTEM + 1, MAV_COMP_ID_AUTOPILOT1, 0, MAV_CMD_DO_REPOSITION, MAV_RESULT_DENIED);
    answer_as(SYSTEM, MAV_COMP_ID_AUTOPILOT1, MAV_COMP_ID_CAMERA, MAV_CMD_DO_REPOSITION, MAV_RESULT_DENIED);
    TEST_ASSERT_EQUAL_UINT32(0, (uint32_t)orders.refused);
    TEST_ASSERT_FALSE(orders.silenced);
    TEST_ASSERT_EQUAL_UINT16(MAV_CMD_DO_REPOSITION, orders.command);
    answer_as(SYSTEM, MAV_COMP_ID_AUTOPILOT1, wire.component, MAV_CMD_DO_REPOSITION, MAV_RESULT_ACCEPTED);
    TEST_ASSERT_EQUAL_UINT16(0, orders.command);
}

static void a_target_that_moves_is_sent_once_a_second_at_most(void) {
    ordered();
    for (int k = 0; k < 30; k++) {
        assessment.target_lat_e7 += 1000; /* 11 m */
        go_on(1, LOITER);
        answer(MAV_CMD_DO_REPOSITION, MAV_RESULT_ACCEPTED);
    }
    const int sent = count_commands(MAV_CMD_DO_REPOSITION);
    TEST_ASSERT_TRUE(sent >= 2 && sent <= 4);
}

static void a_denied_order_is_not_repeated(void) {
    decide(GOE_FLIGHT_LEFT);
    go_on(1, MISSION);
    answer(MAV_CMD_DO_REPOSITION, MAV_RESULT_DENIED);
    (void)count_commands(0);
    go_on(30, MISSION);
    TEST_ASSERT_EQUAL_INT(0, count_commands(MAV_CMD_DO_REPOSITION));
}

static void nothing_goes_out_to_whom_it_is_not_for(void) {
    const struct {
        uint8_t kind, base_mode;
        uint32_t mode;
        bool origin;
    } cases[] = {{MAV_AUTOPILOT_PX4, 0, MISSION, true},
                 {MAV_AUTOPILOT_PX4, MAV_MODE_FLAG_SAFETY_ARMED, POSITION, true},
                 {MAV_AUTOPILOT_PX4, MAV_MODE_FLAG_SAFETY_ARMED, MISSION, false},
                 {MAV_AUTOPILOT_ARDUPILOTMEGA, MAV_MODE_FLAG_SAFETY_ARMED, MISSION, true}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        orders_init(&orders, &wire, &config, &autopilot, &flight);
        autopilot.kind = cases[i].kind;
        autopilot.base_mode = cases[i].base_mode;
        autopilot.custom_mode = cases[i].mode;
        autopilot.origin_given = cases[i].origin;
        decide(GOE_FLIGHT_LEFT);
        go_on(30, cases[i].mode);
        TEST_ASSERT_EQUAL_INT(0, count_commands(MAV_CMD_DO_REPOSITION));
        TEST_ASSERT_TRUE(orders.silenced);
    }
}

/* GIVEN a landing, in whose mode no side is flown, WHEN the order to a side becomes one to go around THEN the go-around is sent; a pilot
 * who has taken over in the meantime is not overridden. */
static void a_side_that_was_not_sent_does_not_silence_a_go_around(void) {
    autopilot.custom_mode = LAND;
    decide(GOE_FLIGHT_LEFT);
    go_on(5, LAND);
    TEST_ASSERT_TRUE(orders.silenced);
    TEST_ASSERT_EQUAL_INT(0, count_commands(MAV_CMD_DO_REPOSITION));
    decide(GOE_FLIGHT_GO_AROUND);
    go_on(1, LAND);
    TEST_ASSERT_FALSE(orders.silenced);
    TEST_ASSERT_EQUAL_INT(1, count_commands(MAV_CMD_DO_GO_AROUND));
    decide(GOE_FLIGHT_NONE);
    go_on(1, MISSION);
    ordered_again();
    go_on(20, POSITION);
    decide(GOE_FLIGHT_GO_AROUND);
    go_on(20, POSITION);
    TEST_ASSERT_EQUAL_INT(0, count_commands(MAV_CMD_DO_GO_AROUND));
}

/* Also if the target moves, and for the mode afterwards. */
static void a_pilot_is_not_fought(void) {
    know_obstacle(true);
    ordered();
    go_on(20, POSITION);
    assessment.target_lat_e7 += 10000;
    go_on(30, POSITION);
    decide(GOE_FLIGHT_NONE);
    go_on(30, LOITER);
    TEST_ASSERT_EQUAL_INT(0, count_commands(MAV_CMD_DO_REPOSITION));
    TEST_ASSERT_EQUAL_INT(0, count_commands(MAV_CMD_DO_SET_MODE));
}

static void the_mode_before_comes_back_once_the_obstacle_is_passed(void) {
    know_obstacle(true);
    ordered();
    decide(GOE_FLIGHT_NONE);
    go_on(1, LOITER);
    TEST_ASSERT_EQUAL_INT(1, count_commands(MAV_CMD_DO_SET_MODE));
    CHECK_SAME(4.0f, mavlink_msg_command_long_get_param2(&latest));
    CHECK_SAME(4.0f, mavlink_msg_command_long_get_param3(&latest));
    go_on(100, LOITER);
    TEST_ASSERT_EQUAL_INT(4, count_commands(MAV_CMD_DO_SET_MODE)); /* five in total */
}

/* Of a single assessment, acknowledged. */
static void ordered_briefly(void) {
    tearDown();
    setUp();
    know_obstacle(true);
    decide(GOE_FLIGHT_LEFT);
    go_on(1, MISSION);
    TEST_ASSERT_EQUAL_INT(1, count_commands(MAV_CMD_DO_REPOSITION));
    answer(MAV_CMD_DO_REPOSITION, MAV_RESULT_ACCEPTED);
    decide(GOE_FLIGHT_NONE);
    go_on(1, MISSION);
    TEST_ASSERT_EQUAL_INT(0, count_commands(MAV_CMD_DO_SET_MODE));
}

/* Heartbeats come once a second. */
static void the_mode_before_comes_back_when_hold_shows_after_the_order(void) {
    ordered_briefly();
    go_on(10, MISSION);
    TEST_ASSERT_EQUAL_INT(0, count_commands(MAV_CMD_DO_SET_MODE));
    go_on(10, LOITER);
    TEST_ASSERT_EQUAL_INT(1, count_commands(MAV_CMD_DO_SET_MODE));
    CHECK_SAME(4.0f, mavlink_msg_command_long_get_param3(&latest));
    answer(MAV_CMD_DO_SET_MODE, MAV_RESULT_ACCEPTED);
    go_on(30, LOITER);
    TEST_ASSERT_EQUAL_INT(0, count_commands(MAV_CMD_DO_SET_MODE));
}

/* A Hold that shows later, or after another mode, is a pilot's. */
static void a_hold_long_after_the_order_is_a_pilots(void) {
    static const uint32_t modes[] = {MISSION, POSITION};
    for (size_t i = 0; i < 2; i++) {
        ordered_briefly();
        go_on(i == 0 ? 30 : 10, modes[i]);
        go_on(30, LOITER);
        TEST_ASSERT_EQUAL_INT(0, count_commands(MAV_CMD_DO_SET_MODE));
    }
}

static void an_order_right_after_a_short_one_goes_back_to_the_same_mode(void) {
    ordered_briefly();
    autopilot.custom_mode = LOITER;
    autopilot.heartbeats++;
    decide(GOE_FLIGHT_RIGHT);
    go_on(1, LOITER);
    TEST_ASSERT_EQUAL_INT(1, count_commands(MAV_CMD_DO_REPOSITION));
    answer(MAV_CMD_DO_REPOSITION, MAV_RESULT_ACCEPTED);
    go_on(20, LOITER);
    decide(GOE_FLIGHT_NONE);
    go_on(1, LOITER);
    TEST_ASSERT_EQUAL_INT(1, count_commands(MAV_CMD_DO_SET_MODE));
}

/* It is out of sight, or the aircraft has turned away: the obstacle may lie ahead on the way back. */
static void the_aircraft_stays_where_the_obstacle_is_not_known_to_be_passed(void) {
    know_obstacle(true);
    ordered();
    know_obstacle(false);
    decide(GOE_FLIGHT_NONE);
    go_on(30, LOITER);
    TEST_ASSERT_EQUAL_INT(0, count_commands(MAV_CMD_DO_SET_MODE));
    know_obstacle(true);
    ordered_again();
    flight.slot[0].valid = 0; /* a reset of the heading, for example, has ended the track: the slot waits for images */
    decide(GOE_FLIGHT_NONE);
    go_on(30, LOITER);
    TEST_ASSERT_EQUAL_INT(0, count_commands(MAV_CMD_DO_SET_MODE));
    know_obstacle(true);
    decide(GOE_FLIGHT_HOLD);
    autopilot.custom_mode = MISSION;
    go_on(30, LOITER);
    decide(GOE_FLIGHT_NONE);
    go_on(30, LOITER);
    TEST_ASSERT_EQUAL_INT(0, count_commands(MAV_CMD_DO_SET_MODE));
}

/* GIVEN an order whose obstacle the layer has given up WHEN another obstacle takes its slot and is located, and the order ends, THEN the mode
 * before is not requested. */
static void another_obstacle_in_the_slot_is_not_the_one_that_was_avoided(void) {
    know_obstacle(true);
    ordered();
    assessment.avoided = -1;
    go_on(20, LOITER);
    decide(GOE_FLIGHT_NONE);
    go_on(30, LOITER);
    TEST_ASSERT_EQUAL_INT(0, count_commands(MAV_CMD_DO_SET_MODE));
}

/* The same if the order is later about another obstacle, and that one is passed. */
static void an_obstacle_that_was_given_up_is_not_forgotten(void) {
    know_obstacle(true);
    ordered();
    assessment.avoided = -1;
    go_on(1, LOITER);
    assessment.avoided = 0;
    go_on(20, LOITER);
    decide(GOE_FLIGHT_NONE);
    go_on(30, LOITER);
    TEST_ASSERT_EQUAL_INT(0, count_commands(MAV_CMD_DO_SET_MODE));
    ordered_again();
    decide(GOE_FLIGHT_NONE);
    go_on(1, LOITER);
    TEST_ASSERT_EQUAL_INT(1, count_commands(MAV_CMD_DO_SET_MODE));
}

/* Two obstacles, 200 m ahead. The order is about the first, then about the second one. */
static void turn_to_another(void) {
    tearDown();
    setUp();
    know_obstacle(true);
    flight.slot[0].id = 5;
    flight.slot[0].center_ne_m[0] = 200.0f;
    flight.slot[3] = flight.slot[0];
    flight.slot[3].id = 7;
    autopilot.position.vx = 20.0f;
    ordered();
    assessment.avoided = 3;
    go_on(2, LOITER);
}

static void check_resumed(bool resumed) {
    go_on(2, LOITER);
    decide(GOE_FLIGHT_NONE);
    go_on(1, LOITER);
    TEST_ASSERT_EQUAL_INT(resumed ? 1 : 0, count_commands(MAV_CMD_DO_SET_MODE));
}

static void an_obstacle_whose_track_ends_under_another_order_may_be_ahead(void) {
    for (int passed = 0; passed < 2; passed++) {
        turn_to_another();
        autopilot.position.x = passed ? 230.0f : 100.0f;
        go_on(1, LOITER);
        flight.slot[0].used = false;
        check_resumed(passed != 0);
    }
}

/* Another id alone is the tracker's new name of the same obstacle. */
static void an_obstacle_that_another_evicts_may_be_ahead(void) {
    for (int evicted = 0; evicted < 2; evicted++) {
        turn_to_another();
        flight.slot[0].id = 9;
        flight.counters.evicted = (uint16_t)(flight.counters.evicted + evicted);
        check_resumed(evicted == 0);
    }
}

/* With one heartbeat a second the mode is known late: the loiter of the previous order is not the mode before the new one, and the
 * mission that returns is not a pilot's choice. */
static void a_second_order_within_a_heartbeat_of_the_first(void) {
    know_obstacle(true);
    ordered();
    decide(GOE_FLIGHT_NONE);
    go_on(1, LOITER);
    answer(MAV_CMD_DO_SET_MODE, MAV_RESULT_ACCEPTED);
    decide(GOE_FLIGHT_RIGHT);
    go_on(1, LOITER);
    TEST_ASSERT_EQUAL_INT(1, count_commands(MAV_CMD_DO_REPOSITION));
    go_on(12, MISSION);
    TEST_ASSERT_FALSE(orders.silenced);
    TEST_ASSERT_TRUE(count_commands(MAV_CMD_DO_REPOSITION) >= 2);
    answer(MAV_CMD_DO_REPOSITION, MAV_RESULT_ACCEPTED);
    go_on(30, LOITER);
    decide(GOE_FLIGHT_NONE);
    go_on(1, LOITER);
    TEST_ASSERT_EQUAL_INT(1, count_commands(MAV_CMD_DO_SET_MODE));
    CHECK_SAME(4.0f, mavlink_msg_command_long_get_param3(&latest));
}

static void a_restarted_autopilot_knows_of_no_order(void) {
    know_obstacle(true);
    ordered();
    autopilot.restarts++;
    decide(GOE_FLIGHT_NONE);
    go_on(30, LOITER);
    TEST_ASSERT_EQUAL_INT(0, count_commands(MAV_CMD_DO_SET_MODE));
}

static void nothing_at_all_goes_out_while_reactions_are_off(void) {
    config.reaction_mode = REACTION_OFF;
    decide(GOE_FLIGHT_GO_AROUND);
    go_on(30, MISSION);
    decide(GOE_FLIGHT_LEFT);
    go_on(30, MISSION);
    TEST_ASSERT_EQUAL_INT(0, count_commands(MAV_CMD_DO_GO_AROUND));
    TEST_ASSERT_EQUAL_INT(0, count_commands(MAV_CMD_DO_REPOSITION));
}

/* Conditions that forbid an order are checked as long as the order is active. */
static void what_hinders_an_order_may_end(void) {
    for (int k = 0; k < 3; k++) {
        orders_init(&orders, &wire, &config, &autopilot, &flight);
        autopilot.base_mode = k == 0 ? 0 : MAV_MODE_FLAG_SAFETY_ARMED;
        autopilot.custom_mode = k == 1 ? POSITION : MISSION;
        autopilot.origin_given = k != 2;
        decide(GOE_FLIGHT_LEFT);
        go_on(20, autopilot.custom_mode);
        TEST_ASSERT_EQUAL_INT(0, count_commands(MAV_CMD_DO_REPOSITION));
        TEST_ASSERT_TRUE(orders.silenced);
        autopilot.base_mode = MAV_MODE_FLAG_SAFETY_ARMED;
        autopilot.origin_given = true;
        go_on(12, MISSION);
        TEST_ASSERT_FALSE(orders.silenced);
        TEST_ASSERT_TRUE(count_commands(MAV_CMD_DO_REPOSITION) >= 1);
        decide(GOE_FLIGHT_NONE);
        go_on(1, MISSION);
        (void)count_commands(0);
    }
}

/* Also conditions that arise later. */
static void an_order_that_is_disarmed_is_not_repeated(void) {
    decide(GOE_FLIGHT_LEFT);
    go_on(1, MISSION);
    autopilot.base_mode = 0;
    (void)count_commands(0);
    go_on(30, MISSION);
    TEST_ASSERT_EQUAL_INT(0, count_commands(MAV_CMD_DO_REPOSITION));
}

/* After touchdown a landing is not aborted; a bounce is flight again. */
static void nothing_is_sent_on_the_ground(void) {
    autopilot.custom_mode = LAND;
    autopilot.on_ground = true;
    decide(GOE_FLIGHT_GO_AROUND);
    go_on(20, LAND);
    TEST_ASSERT_EQUAL_INT(0, count_commands(MAV_CMD_DO_GO_AROUND));
    autopilot.on_ground = false;
    go_on(1, LAND);
    TEST_ASSERT_EQUAL_INT(1, count_commands(MAV_CMD_DO_GO_AROUND));
}

/* Before PX4 returns it waits in Hold: COM_FAIL_ACT_T. A command would cancel the return. */
static void nothing_is_sent_in_a_failsafe(void) {
    static const uint8_t states[] = {MAV_STATE_CRITICAL, MAV_STATE_EMERGENCY, MAV_STATE_FLIGHT_TERMINATION};
    for (size_t i = 0; i < sizeof states; i++) {
        orders_init(&orders, &wire, &config, &autopilot, &flight);
        autopilot.custom_mode = LOITER;
        autopilot.system_status = states[i];
        decide(i == 0 ? GOE_FLIGHT_LEFT : GOE_FLIGHT_GO_AROUND);
        go_on(20, LOITER);
        TEST_ASSERT_EQUAL_INT(0, count_commands(MAV_CMD_DO_REPOSITION));
        TEST_ASSERT_EQUAL_INT(0, count_commands(MAV_CMD_DO_GO_AROUND));
        TEST_ASSERT_EQUAL_STRING("failsafe", orders.hindrance);
    }
    autopilot.system_status = MAV_STATE_ACTIVE;
    go_on(1, LOITER);
    TEST_ASSERT_EQUAL_INT(1, count_commands(MAV_CMD_DO_GO_AROUND));
}

/* In Mission PX4 only warns: any other failsafe changes the mode. */
static void a_warning_is_no_failsafe(void) {
    autopilot.system_status = MAV_STATE_CRITICAL;
    decide(GOE_FLIGHT_LEFT);
    go_on(1, MISSION);
    TEST_ASSERT_EQUAL_INT(1, count_commands(MAV_CMD_DO_REPOSITION));
}

/* Whether it comes during the order, with its end, or after that. */
static void no_mode_is_resumed_after_a_failsafe(void) {
    for (int when = 0; when < 3; when++) {
        tearDown();
        setUp();
        know_obstacle(true);
        ordered();
        autopilot.system_status = when == 0 ? MAV_STATE_CRITICAL : MAV_STATE_ACTIVE;
        assessment.target_lat_e7 += 10000;
        go_on(when == 0 ? 20 : 0, LOITER);
        TEST_ASSERT_EQUAL_INT(0, count_commands(MAV_CMD_DO_REPOSITION));
        autopilot.system_status = when == 1 ? MAV_STATE_CRITICAL : MAV_STATE_ACTIVE;
        go_on(when == 0 ? 1 : 0, LOITER);
        decide(GOE_FLIGHT_NONE);
        go_on(1, LOITER);
        TEST_ASSERT_EQUAL_INT(when == 2 ? 1 : 0, count_commands(MAV_CMD_DO_SET_MODE));
        autopilot.system_status = MAV_STATE_CRITICAL;
        go_on(10, LOITER);
        autopilot.system_status = MAV_STATE_ACTIVE;
        go_on(20, LOITER);
        TEST_ASSERT_EQUAL_INT(0, count_commands(MAV_CMD_DO_SET_MODE));
    }
}

/* GIVEN an order that has led to its mode, WHEN the pilot returns to the previous mode, and the target moves, THEN the order is not
 * repeated against the pilot, and no mode is requested. */
static void the_mode_before_may_be_the_pilots_choice(void) {
    know_obstacle(true);
    ordered();
    assessment.target_lat_e7 += 10000;
    go_on(11, LOITER); /* sent again, and not acknowledged yet */
    (void)count_commands(0);
    go_on(10, MISSION);
    (void)count_commands(0);
    go_on(60, MISSION);
    TEST_ASSERT_EQUAL_INT(0, count_commands(MAV_CMD_DO_REPOSITION));
    TEST_ASSERT_TRUE(orders.silenced);
    decide(GOE_FLIGHT_NONE);
    go_on(30, MISSION);
    TEST_ASSERT_EQUAL_INT(0, count_commands(MAV_CMD_DO_SET_MODE));
}

/* GIVEN an order, WHEN the autopilot flies to another place, for example by a pilot's Hold or reposition, THEN the pilot keeps control. */
static void a_place_that_the_pilot_chose_is_left_to_him(void) {
    ordered();
    autopilot.target_lat_e7 = assessment.target_lat_e7 + 100; /* one meter: rounding */
    autopilot.target_lon_e7 = assessment.target_lon_e7;
    autopilot.targets++;
    go_on(30, LOITER);
    TEST_ASSERT_FALSE(orders.silenced);
    autopilot.target_lat_e7 = assessment.target_lat_e7 + 10000; /* 110 m */
    for (int k = 0; k < 3; k++) {
        autopilot.targets++;
        go_on(5, LOITER);
    }
    TEST_ASSERT_TRUE(orders.silenced);
    assessment.target_lat_e7 -= 10000;
    go_on(30, LOITER);
    TEST_ASSERT_EQUAL_INT(0, count_commands(MAV_CMD_DO_REPOSITION));
}

/* An autopilot may acknowledge the mode and refuse the place, for example outside its fence: that is no pilot's choice. */
static void a_place_that_was_never_flown_to_is_no_choice(void) {
    ordered();
    autopilot.target_lat_e7 = assessment.target_lat_e7 + 10000;
    autopilot.target_lon_e7 = assessment.target_lon_e7;
    for (int k = 0; k < 5; k++) {
        autopilot.targets++;
        go_on(5, LOITER);
    }
    TEST_ASSERT_FALSE(orders.silenced);
}

/* The autopilot may report the old place for a while after a new one was sent. */
static void a_place_that_is_reported_late_is_no_choice(void) {
    ordered();
    autopilot.target_lat_e7 = assessment.target_lat_e7;
    autopilot.target_lon_e7 = assessment.target_lon_e7;
    autopilot.targets++;
    go_on(5, LOITER);
    assessment.target_lat_e7 += 10000;
    go_on(15, LOITER);
    answer(MAV_CMD_DO_REPOSITION, MAV_RESULT_ACCEPTED);
    for (int k = 0; k < 4; k++) {
        autopilot.targets++;
        go_on(5, LOITER);
    }
    TEST_ASSERT_FALSE(orders.silenced);
}

/* GIVEN an acknowledgement that comes late WHEN the next heartbeat still shows the previous mode THEN that is no pilot's choice. */
static void a_late_acknowledgement_gives_the_mode_its_time(void) {
    decide(GOE_FLIGHT_LEFT);
    go_on(60, MISSION);
    answer(MAV_CMD_DO_REPOSITION, MAV_RESULT_ACCEPTED);
    go_on(15, MISSION);
    TEST_ASSERT_FALSE(orders.silenced);
    go_on(30, MISSION);
    TEST_ASSERT_TRUE(orders.silenced);
}

static void another_action_may_be_accepted_where_one_was_denied(void) {
    decide(GOE_FLIGHT_LEFT);
    go_on(1, MISSION);
    answer(MAV_CMD_DO_REPOSITION, MAV_RESULT_DENIED);
    (void)count_commands(0);
    decide(GOE_FLIGHT_RIGHT);
    go_on(1, MISSION);
    TEST_ASSERT_EQUAL_INT(1, count_commands(MAV_CMD_DO_REPOSITION));
}

/* The top above home plus the clearance, as in the flight layer's target. */
static void a_go_around_carries_the_height_that_the_top_requires(void) {
    know_obstacle(true);
    flight.slot[0].valid |= GOE_HAS_HEIGHT;
    autopilot.has_home = true;
    autopilot.home_down_m = 2.0f;
    decide(GOE_FLIGHT_GO_AROUND);
    assessment.target_ned_m[2] = -45.0f;
    go_on(1, LAND);
    TEST_ASSERT_EQUAL_INT(1, count_commands(MAV_CMD_DO_GO_AROUND));
    CHECK_SAME(47.0f, mavlink_msg_command_long_get_param1(&latest));
    flight.slot[0].valid = GOE_HAS_POSITION; /* no top: the autopilot's own height */
    go_on(5, LAND);
    TEST_ASSERT_EQUAL_INT(1, count_commands(MAV_CMD_DO_GO_AROUND));
    CHECK_SAME(0.0f, mavlink_msg_command_long_get_param1(&latest));
}

/* The top becomes known. PX4 flies DO_GO_AROUND only while it lands: in Hold the aircraft would circle level. */
static void a_go_around_after_a_side_raises_the_target(void) {
    for (int early = 0; early < 2; early++) { /* also before Hold is reported */
        tearDown();
        setUp();
        autopilot.landing = true;
        autopilot.origin_alt_m = 400.0f;
        decide(GOE_FLIGHT_LEFT);
        go_on(1, MISSION);
        if (early == 0) {
            answer(MAV_CMD_DO_REPOSITION, MAV_RESULT_ACCEPTED);
            go_on(20, LOITER);
        }
        (void)count_commands(0);
        decide(GOE_FLIGHT_GO_AROUND);
        assessment.target_lat_e7 += 10000; /* straight on, past the side */
        assessment.target_ned_m[2] = -45.0f;
        go_on(early == 0 ? 1 : 20, LOITER);
        TEST_ASSERT_TRUE(count_commands(MAV_CMD_DO_REPOSITION) >= 1);
        TEST_ASSERT_EQUAL_INT32(474000000, mavlink_msg_command_int_get_x(&latest));
        CHECK_SAME(445.0f, mavlink_msg_command_int_get_z(&latest));
        answer(MAV_CMD_DO_REPOSITION, MAV_RESULT_ACCEPTED);
        go_on(40, LOITER);
        TEST_ASSERT_EQUAL_INT(0, count_commands(MAV_CMD_DO_REPOSITION));
        TEST_ASSERT_FALSE(orders.silenced);
        go_on(20, MISSION); /* a pilot's choice */
        TEST_ASSERT_TRUE(orders.overruled);
    }
}

/* From next to the runway the mode before would lead to the same landing. */
static void no_landing_is_resumed(void) {
    know_obstacle(true);
    for (int around = 0; around < 2; around++) {
        autopilot.custom_mode = MISSION;
        autopilot.landing = true;
        decide(around ? GOE_FLIGHT_GO_AROUND : GOE_FLIGHT_LEFT);
        go_on(1, MISSION);
        answer(around ? MAV_CMD_DO_GO_AROUND : MAV_CMD_DO_REPOSITION, MAV_RESULT_ACCEPTED);
        autopilot.landing = false;
        decide(GOE_FLIGHT_LEFT);
        go_on(5, LOITER);
        answer(MAV_CMD_DO_REPOSITION, MAV_RESULT_ACCEPTED);
        go_on(30, LOITER);
        decide(GOE_FLIGHT_NONE);
        go_on(30, LOITER);
        TEST_ASSERT_EQUAL_INT(0, count_commands(MAV_CMD_DO_SET_MODE));
    }
    ordered_again(); /* later in the mission */
    decide(GOE_FLIGHT_NONE);
    go_on(1, LOITER);
    TEST_ASSERT_EQUAL_INT(1, count_commands(MAV_CMD_DO_SET_MODE));
}

static void a_go_around_after_a_side_that_was_denied_is_one(void) {
    autopilot.landing = true;
    decide(GOE_FLIGHT_LEFT);
    go_on(1, MISSION);
    answer(MAV_CMD_DO_REPOSITION, MAV_RESULT_DENIED);
    decide(GOE_FLIGHT_GO_AROUND);
    go_on(1, MISSION);
    TEST_ASSERT_EQUAL_INT(1, count_commands(MAV_CMD_DO_GO_AROUND));
    answer(MAV_CMD_DO_GO_AROUND, MAV_RESULT_ACCEPTED);
    go_on(60, MISSION);
    TEST_ASSERT_FALSE(orders.overruled);
}

/* The landing leads into the obstacle: up at least. */
static void in_landing_a_side_that_is_hindered_is_a_go_around(void) {
    for (int has_origin = 0; has_origin < 2; has_origin++) {
        const uint32_t mode = has_origin ? LAND : MISSION;
        tearDown();
        setUp();
        autopilot.custom_mode = mode;
        autopilot.landing = true;
        autopilot.origin_given = has_origin != 0;
        decide(GOE_FLIGHT_RIGHT);
        go_on(1, mode);
        TEST_ASSERT_EQUAL_INT(1, count_commands(MAV_CMD_DO_GO_AROUND));
        answer(MAV_CMD_DO_GO_AROUND, MAV_RESULT_ACCEPTED);
        go_on(40, mode);
        TEST_ASSERT_FALSE(orders.silenced);
        autopilot.base_mode = 0;
        go_on(1, mode);
        TEST_ASSERT_TRUE(orders.silenced);
    }
    TEST_ASSERT_EQUAL_INT(0, count_commands(MAV_CMD_DO_GO_AROUND));
}

/* ------------------------------------------------------------------------------------------------------- arduplane -- */

static void fly_arduplane(void) {
    config.reaction_mode = REACTION_ARDUPLANE;
    autopilot.kind = MAV_AUTOPILOT_ARDUPILOTMEGA;
    autopilot.custom_mode = AUTO;
    own.origin_known = true;
    know_obstacle(true);
    flight.origin_known = true;
    flight.slot[3].used = true;
    flight.slot[3].valid = GOE_HAS_POSITION;
    flight.slot[5].used = true; /* without a position yet */
    decide(GOE_FLIGHT_LEFT);
}

/* ArduPlane's avoidance does nothing in a landing. So the landing is aborted up to above the top; then traffic turns the aircraft away. */
static void a_side_breaks_a_landing_off(void) {
    fly_arduplane();
    flight.slot[0].valid |= GOE_HAS_HEIGHT;
    flight.slot[0].top_m = 45.0f;
    flight.slot[0].top_sd_m = 1.5f;
    flight.slot[0].ground_down_m = 1.0f;
    autopilot.has_home = autopilot.landing = true;
    autopilot.home_down_m = 2.0f;
    assessment.target_ned_m[2] = -20.0f; /* for a side: the present height */
    go_on(12, AUTO);
    TEST_ASSERT_EQUAL_INT(3, count_commands(MAV_CMD_DO_GO_AROUND)); /* at once, and every half second */
    CHECK_CLOSE(1e-3, 2.0f - 1.0f + 45.0f + 2.0f * 1.5f + config.flight.clearance_m,
                mavlink_msg_command_long_get_param1(&latest));
    TEST_ASSERT_TRUE(arrived > 0);
    answer(MAV_CMD_DO_GO_AROUND, MAV_RESULT_ACCEPTED);
    go_on(20, AUTO);
    TEST_ASSERT_EQUAL_INT(0, count_commands(MAV_CMD_DO_GO_AROUND));
    autopilot.landing = false;
    go_on(20, AUTO);
    TEST_ASSERT_EQUAL_INT(8, count_traffic());
    autopilot.landing = true; /* it lands again, under the same order */
    go_on(1, AUTO);
    TEST_ASSERT_EQUAL_INT(1, count_commands(MAV_CMD_DO_GO_AROUND));
}

/* Without traffic ArduPlane's avoidance ends, and it flies back towards the obstacle. */
static void a_go_around_after_a_side_keeps_the_traffic(void) {
    fly_arduplane();
    autopilot.landing = true;
    go_on(5, AUTO);
    answer(MAV_CMD_DO_GO_AROUND, MAV_RESULT_ACCEPTED);
    autopilot.landing = false;
    go_on(10, AVOID);
    (void)count_traffic();
    decide(GOE_FLIGHT_GO_AROUND);
    go_on(20, AVOID);
    TEST_ASSERT_EQUAL_INT(8, count_traffic());
    decide(GOE_FLIGHT_NONE);
    go_on(20, AVOID);
    decide(GOE_FLIGHT_GO_AROUND); /* the first of its orders */
    (void)count_traffic();
    go_on(20, AUTO);
    TEST_ASSERT_EQUAL_INT(0, count_traffic());
}

static void a_side_outside_a_landing_is_traffic_alone(void) {
    fly_arduplane();
    go_on(20, AUTO);
    TEST_ASSERT_EQUAL_INT(0, count_commands(MAV_CMD_DO_GO_AROUND));
}

static void every_obstacle_is_traffic(void) {
    fly_arduplane();
    go_on(20, AUTO);
    TEST_ASSERT_EQUAL_INT(8, count_traffic()); /* two obstacles, twice a second */
    TEST_ASSERT_TRUE(has_arrived[0] && has_arrived[3]);
    TEST_ASSERT_FALSE(has_arrived[5]);
}

static void a_pilots_mode_ends_traffic(void) {
    fly_arduplane();
    go_on(20, AUTO);
    go_on(20, CRUISE);
    (void)count_traffic();
    go_on(50, CRUISE);
    TEST_ASSERT_EQUAL_INT(0, count_traffic());
    go_on(50, AUTO);
    TEST_ASSERT_EQUAL_INT(0, count_traffic()); /* the pilot is in control until all orders have ended */
    decide(GOE_FLIGHT_NONE);
    go_on(1, AUTO);
    decide(GOE_FLIGHT_RIGHT);
    go_on(10, AUTO);
    TEST_ASSERT_TRUE(count_traffic() > 0);
}

/* ArduPlane reports its avoidance as a failsafe. */
static void traffic_goes_on_while_the_autopilot_avoids_it(void) {
    fly_arduplane();
    go_on(20, AUTO);
    autopilot.system_status = MAV_STATE_CRITICAL;
    (void)count_traffic();
    go_on(20, AVOID);
    TEST_ASSERT_EQUAL_INT(8, count_traffic());
}

/* Out of the autopilot's avoidance back into the previous mode. */
static void a_pilots_way_out_of_avoidance_ends_traffic(void) {
    fly_arduplane();
    go_on(20, AUTO);
    go_on(30, AVOID);
    TEST_ASSERT_TRUE(count_traffic() > 0);
    go_on(30, AUTO);
    (void)count_traffic();
    go_on(50, AUTO);
    TEST_ASSERT_EQUAL_INT(0, count_traffic());
}

/* The autopilot reports when it ends its avoidance by itself: the obstacle may come ahead again. */
static void an_avoidance_that_the_autopilot_ends_goes_on(void) {
    fly_arduplane();
    go_on(20, AUTO);
    go_on(30, AVOID);
    autopilot.recovered_us = now_us;
    go_on(50, AUTO);
    (void)count_traffic();
    go_on(10, AUTO);
    TEST_ASSERT_TRUE(count_traffic() > 0);
    go_on(20, AVOID);
    go_on(30, AUTO);
    (void)count_traffic();
    go_on(20, AUTO);
    TEST_ASSERT_EQUAL_INT(0, count_traffic());
}

/* ArduPlane reports the end of its avoidance also if a pilot has ended it before, by a mode that no recovery leads to. */
static void a_pilots_mode_before_the_report_of_the_end_is_the_pilots(void) {
    fly_arduplane();
    go_on(20, AUTO);
    go_on(30, AVOID);
    autopilot.recovered_us = now_us;
    go_on(10, CRUISE);
    (void)count_traffic();
    go_on(60, CRUISE);
    TEST_ASSERT_EQUAL_INT(0, count_traffic());
    TEST_ASSERT_TRUE(orders.overruled);
}

/* As AVD_F_RCVRY 3 out of CRUISE: the aircraft loiters, and the next avoidance starts from there. */
static void a_recovery_into_another_mode_is_the_autopilots(void) {
    fly_arduplane();
    go_on(20, CRUISE);
    orders_init(&orders, &wire, &config, &autopilot, &flight);
    go_on(20, CRUISE);
    go_on(30, AVOID);
    autopilot.recovered_us = now_us;
    go_on(50, PLANE_LOITER);
    (void)count_traffic();
    go_on(10, PLANE_LOITER);
    TEST_ASSERT_TRUE(count_traffic() > 0);
    go_on(30, CRUISE);
    (void)count_traffic();
    go_on(20, CRUISE);
    TEST_ASSERT_EQUAL_INT(0, count_traffic());
}

/* --------------------------------------------------------------------------------------------------------- restarts -- */

static const order_left_t left = {.active = true,
                                  .action = GOE_FLIGHT_LEFT,
                                  .mode_before = MISSION,
                                  .boot_us = 900000,
                                  .unix_us = 1790000000000000,
                                  .obstacle_ne_m = {200.0f, 0.0f},
                                  .radius_m = 5.0f,
                                  .course_ne = {1.0f, 0.0f}};

static void take_over(float north_m, int64_t since_us) {
    autopilot.custom_mode = LOITER;
    autopilot.position.x = north_m;
    own.time_usec = (uint64_t)left.boot_us + 3000000u;
    own.unix_usec = (uint64_t)(left.unix_us + since_us);
    orders_take_over(&orders, &left);
    decide(GOE_FLIGHT_NONE);
    go_on(20, LOITER);
}

static void a_restarted_companion_goes_back_to_the_mode_before(void) {
    know_obstacle(true);
    take_over(100.0f, 3000000);
    autopilot.position.vy = 20.0f;
    TEST_ASSERT_EQUAL_INT(0, count_commands(MAV_CMD_DO_SET_MODE));
    decide(GOE_FLIGHT_LEFT);
    go_on(20, LOITER);
    CHECK_SAME(1.0f, orders.active.course_ne[0]); /* of the logged order, and not of the circle */
    answer(MAV_CMD_DO_REPOSITION, MAV_RESULT_ACCEPTED);
    go_on(20, LOITER);
    decide(GOE_FLIGHT_NONE);
    go_on(1, LOITER);
    TEST_ASSERT_EQUAL_INT(1, count_commands(MAV_CMD_DO_SET_MODE));
    CHECK_SAME(4.0f, mavlink_msg_command_long_get_param2(&latest));
    CHECK_SAME(4.0f, mavlink_msg_command_long_get_param3(&latest));
}

static void a_restarted_companion_goes_back_once_the_logged_obstacle_is_passed(void) {
    take_over(210.0f, 3000000);
    TEST_ASSERT_EQUAL_INT(0, count_commands(MAV_CMD_DO_SET_MODE));
    autopilot.position.x = 230.0f; /* behind by its radius and the margin */
    go_on(5, LOITER);
    TEST_ASSERT_EQUAL_INT(1, count_commands(MAV_CMD_DO_SET_MODE));
}

static void a_restarted_companion_leaves_a_failsafe_alone(void) {
    autopilot.system_status = MAV_STATE_CRITICAL;
    take_over(230.0f, 3000000);
    autopilot.system_status = MAV_STATE_ACTIVE;
    go_on(20, LOITER);
    TEST_ASSERT_EQUAL_INT(0, count_commands(MAV_CMD_DO_SET_MODE));
}

/* After another boot of the autopilot, and after a pilot has taken over in the meantime. */
static void an_order_of_another_flight_is_not_taken_over(void) {
    take_over(230.0f, 60000000);
    TEST_ASSERT_EQUAL_INT(0, count_commands(MAV_CMD_DO_SET_MODE));
    orders_init(&orders, &wire, &config, &autopilot, &flight);
    take_over(100.0f, 3000000);
    go_on(20, POSITION);
    autopilot.position.x = 230.0f;
    go_on(20, LOITER);
    TEST_ASSERT_EQUAL_INT(0, count_commands(MAV_CMD_DO_SET_MODE));
}

static char folder[64], path[80];
static order_log_t order_log;

static void make_folder(void) {
    (void)snprintf(folder, sizeof folder, "/tmp/goe_orders_XXXXXX");
    TEST_ASSERT_NOT_NULL(mkdtemp(folder));
    (void)snprintf(path, sizeof path, "%s/orders.csv", folder);
}

static void open_log(void) {
    (void)memset(&order_log, 0, sizeof order_log);
    TEST_ASSERT_TRUE(order_log_open(&order_log, folder));
    orders.log = &order_log;
}

static void remove_log(void) {
    orders.log = NULL;
    order_log_close(&order_log);
    (void)remove(path);
    (void)rmdir(folder);
}

/* An order that was left to the pilot is not resumed; a torn row does not count. */
static void the_log_shows_whether_an_order_is_active(void) {
    order_left_t read;
    waits = 0;
    make_folder();
    TEST_ASSERT_FALSE(order_log_read(folder, &read));
    open_log();
    TEST_ASSERT_FALSE(order_log_read(folder, &read));
    know_obstacle(true);
    ordered();
    TEST_ASSERT_TRUE(order_log_read(folder, &read));
    TEST_ASSERT_EQUAL_UINT32(MISSION, read.mode_before);
    TEST_ASSERT_EQUAL_UINT(GOE_FLIGHT_LEFT, read.action);
    TEST_ASSERT_EQUAL_INT(0, waits); /* while a command is due nothing waits */
    go_on(20, POSITION);
    TEST_ASSERT_FALSE(order_log_read(folder, &read));
    TEST_ASSERT_EQUAL_INT(1, waits); /* a loss of power must not bring it back */
    decide(GOE_FLIGHT_NONE);
    go_on(1, MISSION);
    autopilot.custom_mode = MISSION;
    autopilot.landing = true; /* a landing is not resumed either */
    decide(GOE_FLIGHT_LEFT);
    go_on(1, MISSION);
    TEST_ASSERT_FALSE(order_log_read(folder, &read));
    autopilot.landing = false;
    decide(GOE_FLIGHT_NONE);
    go_on(1, MISSION);
    decide(GOE_FLIGHT_LEFT);
    go_on(1, MISSION);
    TEST_ASSERT_TRUE(order_log_read(folder, &read));
    (void)fputs("1,2,0,1,3,1,0,5,6,7,en", order_log.stream);
    (void)fflush(order_log.stream);
    TEST_ASSERT_TRUE(order_log_read(folder, &read));
    (void)fputs("d\n", order_log.stream);
    (void)fflush(order_log.stream);
    TEST_ASSERT_FALSE(order_log_read(folder, &read));
    remove_log();
}

/* A restarted companion leaves the pilot's Hold alone. */
static void the_log_has_no_order_that_led_nowhere(void) {
    order_left_t read;
    make_folder();
    open_log();
    know_obstacle(true);
    autopilot.base_mode = 0; /* hindered */
    decide(GOE_FLIGHT_LEFT);
    go_on(1, MISSION);
    TEST_ASSERT_FALSE(order_log_read(folder, &read));
    autopilot.base_mode = MAV_MODE_FLAG_SAFETY_ARMED;
    go_on(1, MISSION);
    TEST_ASSERT_TRUE(order_log_read(folder, &read));
    answer(MAV_CMD_DO_REPOSITION, MAV_RESULT_TEMPORARILY_REJECTED); /* it is repeated */
    TEST_ASSERT_TRUE(order_log_read(folder, &read));
    answer(MAV_CMD_DO_REPOSITION, MAV_RESULT_DENIED);
    TEST_ASSERT_FALSE(order_log_read(folder, &read));
    decide(GOE_FLIGHT_RIGHT);
    go_on(1, MISSION);
    TEST_ASSERT_TRUE(order_log_read(folder, &read));
    remove_log();
}

/* A restarted companion waits for the obstacle that the order was about last, and for none that was given up. */
static void the_log_follows_the_obstacle_of_the_order(void) {
    order_left_t read;
    make_folder();
    open_log();
    know_obstacle(true);
    flight.slot[0].center_ne_m[0] = 200.0f;
    flight.slot[3] = flight.slot[0];
    flight.slot[3].center_ne_m[0] = 300.0f;
    autopilot.position.vx = 20.0f;
    ordered();
    TEST_ASSERT_TRUE(order_log_read(folder, &read));
    CHECK_SAME(200.0f, read.obstacle_ne_m[0]);
    assessment.avoided = 3;
    go_on(1, LOITER);
    TEST_ASSERT_TRUE(order_log_read(folder, &read));
    CHECK_SAME(300.0f, read.obstacle_ne_m[0]);
    autopilot.position.vx = 0.0f;
    autopilot.position.vy = 20.0f; /* turned */
    decide(GOE_FLIGHT_RIGHT);      /* another order goes back to the line of the first one */
    go_on(1, LOITER);
    TEST_ASSERT_TRUE(order_log_read(folder, &read));
    TEST_ASSERT_EQUAL_UINT(GOE_FLIGHT_RIGHT, read.action);
    CHECK_SAME(1.0f, read.course_ne[0]);
    CHECK_SAME(0.0f, read.course_ne[1]);
    flight.slot[0].used = false; /* the order is about slot 3 */
    go_on(1, LOITER);
    TEST_ASSERT_FALSE(order_log_read(folder, &read));
    assessment.avoided = -1;
    go_on(1, LOITER);
    TEST_ASSERT_FALSE(order_log_read(folder, &read));
    remove_log();
}

/* GIVEN a companion that is restarted twice without a new order in between THEN the second log still contains the order and its end. */
static void an_order_that_was_taken_over_is_in_the_next_log(void) {
    order_left_t read;
    make_folder();
    open_log();
    take_over(100.0f, 3000000);
    TEST_ASSERT_TRUE(order_log_read(folder, &read));
    TEST_ASSERT_EQUAL_UINT32(MISSION, read.mode_before);
    CHECK_SAME(200.0f, read.obstacle_ne_m[0]);
    CHECK_SAME(1.0f, read.course_ne[0]);
    TEST_ASSERT_EQUAL_INT64(left.unix_us + 3000000, read.unix_us);
    go_on(20, POSITION);
    TEST_ASSERT_FALSE(order_log_read(folder, &read));
    orders_init(&orders, &wire, &config, &autopilot, &flight);
    orders.log = &order_log;
    take_over(230.0f, 3000000);
    TEST_ASSERT_FALSE(order_log_read(folder, &read)); /* passed */
    remove_log();
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(an_order_that_was_taken_over_is_in_the_next_log);
    RUN_TEST(a_recovery_into_another_mode_is_the_autopilots);
    RUN_TEST(the_log_shows_whether_an_order_is_active);
    RUN_TEST(the_log_has_no_order_that_led_nowhere);
    RUN_TEST(the_log_follows_the_obstacle_of_the_order);
    RUN_TEST(what_hinders_an_order_may_end);
    RUN_TEST(an_order_that_is_disarmed_is_not_repeated);
    RUN_TEST(nothing_is_sent_on_the_ground);
    RUN_TEST(nothing_is_sent_in_a_failsafe);
    RUN_TEST(a_warning_is_no_failsafe);
    RUN_TEST(no_mode_is_resumed_after_a_failsafe);
    RUN_TEST(traffic_goes_on_while_the_autopilot_avoids_it);
    RUN_TEST(a_restarted_companion_leaves_a_failsafe_alone);
    RUN_TEST(the_mode_before_may_be_the_pilots_choice);
    RUN_TEST(a_place_that_the_pilot_chose_is_left_to_him);
    RUN_TEST(a_place_that_was_never_flown_to_is_no_choice);
    RUN_TEST(a_place_that_is_reported_late_is_no_choice);
    RUN_TEST(a_late_acknowledgement_gives_the_mode_its_time);
    RUN_TEST(another_action_may_be_accepted_where_one_was_denied);
    RUN_TEST(a_go_around_carries_the_height_that_the_top_requires);
    RUN_TEST(an_obstacle_that_was_given_up_is_not_forgotten);
    RUN_TEST(an_obstacle_whose_track_ends_under_another_order_may_be_ahead);
    RUN_TEST(an_obstacle_that_another_evicts_may_be_ahead);
    RUN_TEST(a_go_around_after_a_side_raises_the_target);
    RUN_TEST(a_go_around_after_a_side_that_was_denied_is_one);
    RUN_TEST(no_landing_is_resumed);
    RUN_TEST(in_landing_a_side_that_is_hindered_is_a_go_around);
    RUN_TEST(a_side_breaks_a_landing_off);
    RUN_TEST(a_go_around_after_a_side_keeps_the_traffic);
    RUN_TEST(a_side_outside_a_landing_is_traffic_alone);
    RUN_TEST(every_obstacle_is_traffic);
    RUN_TEST(a_pilots_mode_ends_traffic);
    RUN_TEST(a_pilots_way_out_of_avoidance_ends_traffic);
    RUN_TEST(an_avoidance_that_the_autopilot_ends_goes_on);
    RUN_TEST(a_pilots_mode_before_the_report_of_the_end_is_the_pilots);
    RUN_TEST(a_restarted_companion_goes_back_to_the_mode_before);
    RUN_TEST(a_restarted_companion_goes_back_once_the_logged_obstacle_is_passed);
    RUN_TEST(an_order_of_another_flight_is_not_taken_over);
    RUN_TEST(an_order_is_repeated_until_it_is_acknowledged);
    RUN_TEST(only_the_autopilots_answer_to_the_companion_counts);
    RUN_TEST(a_target_that_moves_is_sent_once_a_second_at_most);
    RUN_TEST(a_denied_order_is_not_repeated);
    RUN_TEST(nothing_goes_out_to_whom_it_is_not_for);
    RUN_TEST(a_side_that_was_not_sent_does_not_silence_a_go_around);
    RUN_TEST(a_pilot_is_not_fought);
    RUN_TEST(the_mode_before_comes_back_once_the_obstacle_is_passed);
    RUN_TEST(the_mode_before_comes_back_when_hold_shows_after_the_order);
    RUN_TEST(a_hold_long_after_the_order_is_a_pilots);
    RUN_TEST(an_order_right_after_a_short_one_goes_back_to_the_same_mode);
    RUN_TEST(the_aircraft_stays_where_the_obstacle_is_not_known_to_be_passed);
    RUN_TEST(another_obstacle_in_the_slot_is_not_the_one_that_was_avoided);
    RUN_TEST(a_second_order_within_a_heartbeat_of_the_first);
    RUN_TEST(a_restarted_autopilot_knows_of_no_order);
    RUN_TEST(nothing_at_all_goes_out_while_reactions_are_off);
    return UNITY_END();
}
