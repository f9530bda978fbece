/* Samples, resets and restarts derived from messages. SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "autopilot.h"
#include "check.h"
#include "image_queue.h"
#include "receiver.h"

#define OTHER_SYSTEM 9
#define SYSTEM 1
#define SPEED_M_S 20.0f
#define PERIOD_MS 20
#define BOOT_MS 100000u /* of the autopilot's clock when the test begins */

static companion_config_t config;
static goe_flight_t flight;
static wire_t wire;
static autopilot_t autopilot;
static int64_t own_us; /* the companion's clock, with an arbitrary start */
static uint32_t boot_ms;
static float north_m, jump_m, turn_rad;

static void beat(uint8_t system) {
    mavlink_message_t message;
    (void)mavlink_msg_heartbeat_pack(system, MAV_COMP_ID_AUTOPILOT1, &message, MAV_TYPE_FIXED_WING, MAV_AUTOPILOT_PX4,
                                     0, 0, MAV_STATE_ACTIVE);
    autopilot_take(&autopilot, &message, own_us);
}

void setUp(void) {
    char fault[256];
    const char *bad = NULL;
    (void)memset(&config, 0, sizeof config);
    (void)memset(&wire, 0, sizeof wire);
    goe_settings_default(&config.estimator);
    goe_flight_settings_default(&config.flight);
    config.estimator.camera.fx_px = config.estimator.camera.fy_px = 900.0f;
    config.estimator.camera.cx_px = config.estimator.camera.cy_px = 0.0f;
    config.estimator.camera.width_px = config.estimator.camera.height_px = 1000.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_init(&flight, sizeof flight, &config.estimator, &config.flight, &bad));
    wire.link = link_open("udpout:127.0.0.1:9", fault, sizeof fault);
    TEST_ASSERT_NOT_NULL(wire.link);
    autopilot_init(&autopilot, &config, &flight, &wire);
    own_us = 777000000;
    boot_ms = BOOT_MS;
    north_m = jump_m = turn_rad = 0.0f;
    beat(SYSTEM);
}

void tearDown(void) { link_close(wire.link); }

static void send_attitude(uint8_t system, float w, float z) {
    static const float none[4] = {0.0f, 0.0f, 0.0f, 0.0f};
    mavlink_message_t message;
    (void)mavlink_msg_attitude_quaternion_pack(system, MAV_COMP_ID_AUTOPILOT1, &message, boot_ms, w, 0.0f, 0.0f, z,
                                               0.0f, 0.0f, 0.0f, none);
    autopilot_take(&autopilot, &message, own_us);
}

static void send_position(uint8_t system, float north, float down) {
    mavlink_message_t message;
    (void)mavlink_msg_local_position_ned_pack(system, MAV_COMP_ID_AUTOPILOT1, &message, boot_ms, north, 0.0f, down,
                                              SPEED_M_S, 0.0f, 0.0f);
    autopilot_take(&autopilot, &message, own_us);
}

/* Sends `count` samples of a straight flight to the north, including the jumps so far. */
static void fly(int samples) {
    for (int k = 0; k < samples; k++) {
        own_us += 1000 * PERIOD_MS;
        boot_ms += PERIOD_MS;
        north_m += SPEED_M_S * 1e-3f * PERIOD_MS;
        send_attitude(SYSTEM, cosf(0.5f * turn_rad), sinf(0.5f * turn_rad));
        send_position(SYSTEM, north_m + jump_m, -30.0f);
    }
}

static float north_at_ms(uint32_t ms) {
    goe_pose_t pose;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_pose(&flight, ms * 1000u, 0, &pose, NULL));
    return pose.position_ned_m[0];
}

static void samples_reach_the_flight_layer_at_their_own_time(void) {
    fly(20);
    TEST_ASSERT_EQUAL_UINT32(20, (uint32_t)autopilot.attitudes);
    TEST_ASSERT_EQUAL_UINT32(20, (uint32_t)autopilot.positions);
    CHECK_CLOSE(1e-3, north_m - 2.0f, north_at_ms(boot_ms - 100));
    TEST_ASSERT_EQUAL_INT64((int64_t)boot_ms * 1000, autopilot_clock_us(&autopilot, own_us));
}

static void nothing_is_taken_before_a_heartbeat_or_from_another_system(void) {
    autopilot_init(&autopilot, &config, &flight, &wire);
    fly(5);
    TEST_ASSERT_EQUAL_UINT32(0, (uint32_t)autopilot.positions);
    beat(SYSTEM);
    beat(OTHER_SYSTEM);
    TEST_ASSERT_EQUAL_UINT8(SYSTEM, autopilot.system);
    fly(5);
    send_position(OTHER_SYSTEM, 1e5f, 0.0f);
    send_attitude(OTHER_SYSTEM, 0.0f, 1.0f);
    fly(5);
    TEST_ASSERT_EQUAL_UINT32(10, (uint32_t)autopilot.positions);
    TEST_ASSERT_EQUAL_UINT32(0, (uint32_t)autopilot.jumps);
}

/* The history is moved along: an image from before the step still has its pose in the new frame. */
static void a_step_of_the_position_is_a_known_jump(void) {
    fly(20);
    jump_m = 7.0f;
    fly(10);
    TEST_ASSERT_EQUAL_UINT32(1, (uint32_t)autopilot.jumps);
    TEST_ASSERT_EQUAL_UINT16(1, flight.counters.resets);
    TEST_ASSERT_EQUAL_UINT16(0, flight.counters.lost);
    CHECK_CLOSE(0.01, north_m + 7.0f - SPEED_M_S * 0.4f, north_at_ms(boot_ms - 400));
}

static void losses_and_turns_of_an_aircraft_are_no_steps(void) {
    fly(20);
    boot_ms += 600;
    own_us += 600000;
    north_m += SPEED_M_S * 0.6f + 1.5f; /* it has accelerated in the meantime */
    fly(20);
    jump_m = 0.5f; /* a filter that corrects itself */
    fly(20);
    TEST_ASSERT_EQUAL_UINT32(0, (uint32_t)autopilot.jumps);
}

static void a_turn_that_no_rate_explains_ends_the_tracks(void) {
    fly(20);
    turn_rad = 0.3f;
    fly(5);
    TEST_ASSERT_EQUAL_UINT32(1, (uint32_t)autopilot.jumps);
    TEST_ASSERT_EQUAL_UINT16(1, flight.counters.lost);
}

/* GIVEN a constant attitude about any axis, by either sign of the quaternion THEN there is no jump, and the heading is correct;
 * another attitude about that axis is a jump. */
static void an_attitude_about_any_axis_is_compared(void) {
    static const float none[4] = {0.0f, 0.0f, 0.0f, 0.0f};
    for (int axis = 1; axis < 4; axis++) {
        tearDown();
        setUp();
        for (int k = 0; k < 20; k++) {
            const float half = k < 15 ? 0.3f : 0.6f;
            const float sign = k % 2 == 0 ? 1.0f : -1.0f;
            float q[4] = {sign * cosf(half), 0.0f, 0.0f, 0.0f};
            mavlink_message_t message;
            q[axis] = sign * sinf(half);
            own_us += 1000 * PERIOD_MS;
            boot_ms += PERIOD_MS;
            (void)mavlink_msg_attitude_quaternion_pack(SYSTEM, MAV_COMP_ID_AUTOPILOT1, &message, boot_ms, q[0], q[1],
                                                       q[2], q[3], 0.0f, 0.0f, 0.0f, none);
            autopilot_take(&autopilot, &message, own_us);
            TEST_ASSERT_EQUAL_UINT32(k < 15 ? 0 : 1, (uint32_t)autopilot.jumps);
        }
        TEST_ASSERT_EQUAL_UINT32(20, (uint32_t)autopilot.attitudes);
        CHECK_CLOSE(0.01, axis == 3 ? 1.2 * 57.29578 : 0.0, autopilot_heading_deg(&autopilot));
    }
}

/* PX4's home has its own down. ArduPilot's down counts from home, so the difference of the altitudes of origin and home applies. A home
 * that is too far off is not used as ground. */
static void home_is_the_ground_by_the_autopilots_own_count(void) {
    static const float none[4] = {0.0f, 0.0f, 0.0f, 0.0f};
    for (int kind = 0; kind < 2; kind++) {
        for (int far = 0; far < 2; far++) {
            mavlink_message_t message;
            tearDown();
            setUp();
            autopilot.kind = kind == 0 ? MAV_AUTOPILOT_PX4 : MAV_AUTOPILOT_ARDUPILOTMEGA;
            const int32_t home_mm = far ? -400000000 : 480000;
            (void)mavlink_msg_gps_global_origin_pack(SYSTEM, MAV_COMP_ID_AUTOPILOT1, &message, 470000000, 80000000,
                                                     500000, 0);
            autopilot_take(&autopilot, &message, own_us);
            (void)mavlink_msg_home_position_pack(SYSTEM, MAV_COMP_ID_AUTOPILOT1, &message, 470000000, 80000000, home_mm,
                                                 0.0f, 0.0f, far ? 1.0e6f : 7.0f, none, 0.0f, 0.0f, 0.0f, 0);
            autopilot_take(&autopilot, &message, own_us);
            TEST_ASSERT_EQUAL(!far, autopilot.has_home);
            if (!far) {
                CHECK_CLOSE(1.0e-3, kind == 0 ? 7.0 : 20.0, autopilot.home_down_m);
                goe_pose_t pose;
                fly(5);
                TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_pose(&flight, boot_ms * 1000u, 0u, &pose, NULL));
                CHECK_CLOSE(1.0e-3, kind == 0 ? 37.0 : 50.0, pose.height_m);
            }
        }
    }
}

static void every_autopilot_has_a_name(void) {
    autopilot.kind = MAV_AUTOPILOT_ARDUPILOTMEGA;
    TEST_ASSERT_EQUAL_STRING("ArduPilot", autopilot_kind_text(&autopilot));
    autopilot.kind = MAV_AUTOPILOT_PX4;
    TEST_ASSERT_EQUAL_STRING("PX4", autopilot_kind_text(&autopilot));
    autopilot.kind = MAV_AUTOPILOT_GENERIC;
    TEST_ASSERT_EQUAL_STRING("autopilot", autopilot_kind_text(&autopilot));
}

static void a_restart_of_the_autopilot_begins_a_new_clock(void) {
    fly(50);
    boot_ms = 3000;
    fly(20);
    TEST_ASSERT_EQUAL_UINT32(1, (uint32_t)autopilot.restarts);
    TEST_ASSERT_EQUAL_INT64((int64_t)boot_ms * 1000, autopilot_clock_us(&autopilot, own_us));
    CHECK_CLOSE(1e-3, north_m - 2.0f, north_at_ms(boot_ms - 100));
    boot_ms += 30000;
    fly(20);
    TEST_ASSERT_EQUAL_UINT32(2, (uint32_t)autopilot.restarts);
}

/* An answer to the latest question, sent just now, by a clock that has drifted against the companion's. */
static void answer(int32_t slipped_ms) {
    mavlink_message_t message;
    autopilot.question_us[0] = own_us;
    (void)mavlink_msg_timesync_pack(SYSTEM, MAV_COMP_ID_AUTOPILOT1, &message,
                                    ((int64_t)boot_ms + slipped_ms) * 1000000 + 1000, own_us * 1000);
    autopilot_take(&autopilot, &message, own_us);
}

/* Poses and tracks use the autopilot's clock alone: a drift changes only the times of this computer's images. */
static void a_clock_that_slips_ends_nothing(void) {
    fly(50);
    for (int k = 0; k < 8; k++) {
        answer(0);
        fly(12);
    }
    own_us += 300000; /* the autopilot was asleep */
    for (int k = 0; k < 8; k++) {
        answer(0);
        fly(12);
    }
    TEST_ASSERT_EQUAL_UINT32(1, (uint32_t)autopilot.slips);
    TEST_ASSERT_EQUAL_UINT32(0, (uint32_t)autopilot.restarts);
    TEST_ASSERT_EQUAL_UINT16(0, flight.counters.lost);
    TEST_ASSERT_INT64_WITHIN(2000, (int64_t)boot_ms * 1000, autopilot_clock_us(&autopilot, own_us));
    CHECK_CLOSE(1e-3, north_m - 2.0f, north_at_ms(boot_ms - 100));
}

static void what_is_not_finite_is_refused_and_counted(void) {
    fly(10);
    boot_ms += PERIOD_MS;
    own_us += 1000 * PERIOD_MS;
    send_position(SYSTEM, NAN, 0.0f);
    send_position(SYSTEM, INFINITY, 0.0f);
    send_attitude(SYSTEM, NAN, 0.0f);
    send_attitude(SYSTEM, 3.0f, 0.0f);
    TEST_ASSERT_EQUAL_UINT32(4, (uint32_t)autopilot.bad_samples);
    fly(10);
    TEST_ASSERT_EQUAL_UINT32(20, (uint32_t)autopilot.positions);
    TEST_ASSERT_EQUAL_UINT32(0, (uint32_t)autopilot.jumps);
}

static void messages_that_come_twice_or_late_change_nothing(void) {
    fly(20);
    send_position(SYSTEM, north_m, -30.0f);
    boot_ms -= 5 * PERIOD_MS;
    send_position(SYSTEM, north_m - 2.0f, -30.0f);
    boot_ms += 5 * PERIOD_MS;
    fly(5);
    TEST_ASSERT_EQUAL_UINT32(25, (uint32_t)autopilot.positions);
    TEST_ASSERT_EQUAL_UINT32(0, (uint32_t)(autopilot.jumps + autopilot.restarts));
}

/* A sample from the future does not reach the flight layer, which would refuse all samples until that time. */
static void a_time_ahead_of_the_clock_is_not_taken(void) {
    fly(20);
    const uint64_t attitudes = autopilot.attitudes, positions = autopilot.positions;
    boot_ms += 60000u;
    send_attitude(SYSTEM, 1.0f, 0.0f);
    send_position(SYSTEM, north_m, -30.0f);
    boot_ms -= 60000u;
    TEST_ASSERT_EQUAL_UINT32((uint32_t)attitudes, (uint32_t)autopilot.attitudes);
    TEST_ASSERT_EQUAL_UINT32((uint32_t)positions, (uint32_t)autopilot.positions);
    fly(5);
    TEST_ASSERT_EQUAL_UINT32((uint32_t)positions + 5u, (uint32_t)autopilot.positions);
    TEST_ASSERT_EQUAL_UINT32(0, (uint32_t)autopilot.restarts);
    TEST_ASSERT_EQUAL_UINT32(0, (uint32_t)flight.counters.refused);
}

static void report_resets(uint8_t resets) {
    mavlink_message_t message;
    mavlink_odometry_t odometry;
    (void)memset(&odometry, 0, sizeof odometry);
    odometry.reset_counter = resets;
    (void)mavlink_msg_odometry_encode(SYSTEM, MAV_COMP_ID_AUTOPILOT1, &message, &odometry);
    autopilot_take(&autopilot, &message, own_us);
}

/* Runs so many samples, with the companion's work between them. */
static void go_on(int samples) {
    for (int k = 0; k < samples; k++) {
        fly(1);
        autopilot_ask(&autopilot, own_us);
    }
}

static void odometry_counts_resets_that_show_no_step(void) {
    go_on(10);
    report_resets(4);
    go_on(30);
    TEST_ASSERT_EQUAL_UINT16(0, flight.counters.lost);
    report_resets(5);
    go_on(30);
    TEST_ASSERT_EQUAL_UINT16(1, flight.counters.lost);
}

/* Before or after the step: both are one reset of known size. */
static void a_counter_that_rises_with_a_step_adds_no_reset(void) {
    go_on(10);
    report_resets(4);
    jump_m = 7.0f;
    go_on(5);
    report_resets(5);
    go_on(40);
    report_resets(6);
    go_on(5);
    jump_m = 3.0f;
    go_on(40);
    TEST_ASSERT_EQUAL_UINT16(2, flight.counters.resets);
    TEST_ASSERT_EQUAL_UINT16(0, flight.counters.lost);
}

/* Whether a range finder that measures 40 m, in a bank of `bank_deg`, gives the ground. */
static bool is_ground(float bank_deg, uint8_t quality) {
    mavlink_message_t message;
    mavlink_distance_sensor_t sensor;
    const float half = 0.5f * 0.017453293f * bank_deg;
    (void)memset(&sensor, 0, sizeof sensor);
    fly(1);
    autopilot.has_range_finder = false;
    autopilot.attitude.q1 = cosf(half);
    autopilot.attitude.q2 = sinf(half);
    sensor.time_boot_ms = boot_ms;
    sensor.max_distance = 5000;
    sensor.current_distance = 4000;
    sensor.signal_quality = quality;
    sensor.orientation = MAV_SENSOR_ROTATION_PITCH_270;
    (void)mavlink_msg_distance_sensor_encode(SYSTEM, MAV_COMP_ID_AUTOPILOT1, &message, &sensor);
    autopilot_take(&autopilot, &message, own_us);
    return autopilot.has_range_finder;
}

static unsigned taken;

static void count_taken(void *user, const goe_flight_frame_t *frame, goe_flight_status_t status) {
    (void)user;
    (void)frame;
    taken += status == GOE_FLIGHT_OK ? 1u : 0u;
}

/* The image then arrives later than now. */
static void an_image_outlasts_a_clock_that_is_corrected_backwards(void) {
    static image_queue_t queue;
    static camera_image_t image;
    taken = 0;
    fly(20);
    image_queue_clear(&queue);
    image.frame.arrival_us = boot_ms * 1000u + 11000u;
    image.frame.capture_us = image.frame.sent_us = boot_ms * 1000u + 5000u; /* no pose has come so far */
    image_queue_add(&queue, &image);
    for (int corrected = 0; corrected < 2; corrected++) {
        image_queue_run(&queue, &flight, image.frame.arrival_us + (corrected ? 0u - 500u : 1000u), count_taken, NULL);
        TEST_ASSERT_EQUAL_INT(1, queue.count);
    }
    fly(1);
    image_queue_run(&queue, &flight, boot_ms * 1000u, count_taken, NULL);
    TEST_ASSERT_EQUAL_UINT(1, taken);
    TEST_ASSERT_EQUAL_UINT32(0, (uint32_t)queue.given_up);
}

/* In a bank of 40 degrees it measures 1.3 times the height. In a steeper one it looks far aside, or past the horizon. */
static void a_range_finder_is_taken_upright(void) {
    TEST_ASSERT_TRUE(is_ground(-40.0f, 0));
    CHECK_CLOSE(1e-3, 40.0f * cosf(40.0f * 0.017453293f), autopilot.range_finder_down_m - autopilot.position.z);
    TEST_ASSERT_FALSE(is_ground(60.0f, 0));
    TEST_ASSERT_FALSE(is_ground(180.0f, 0));
}

static void an_invalid_signal_of_a_range_finder_is_none(void) {
    TEST_ASSERT_TRUE(is_ground(0.0f, 0)); /* it reports no quality */
    TEST_ASSERT_TRUE(is_ground(0.0f, 100));
    TEST_ASSERT_FALSE(is_ground(0.0f, 1));
}

static void show_text(const char *text) {
    mavlink_message_t message;
    char field[MAVLINK_MSG_STATUSTEXT_FIELD_TEXT_LEN + 1] = "";
    (void)strncpy(field, text, sizeof field - 1u);
    (void)mavlink_msg_statustext_pack(SYSTEM, MAV_COMP_ID_AUTOPILOT1, &message, MAV_SEVERITY_INFO, field, 0, 0);
    autopilot_take(&autopilot, &message, own_us);
}

static void the_end_of_an_avoidance_is_read_from_its_text(void) {
    show_text("Avoid: Performing action: 3");
    TEST_ASSERT_EQUAL_INT64(0, autopilot.recovered_us);
    show_text("Avoid: Resuming with action: 1");
    TEST_ASSERT_EQUAL_INT64(own_us, autopilot.recovered_us);
}

static void a_failsafe_is_read_from_the_heartbeat(void) {
    mavlink_message_t message;
    TEST_ASSERT_EQUAL_UINT8(MAV_STATE_ACTIVE, autopilot.system_status);
    (void)mavlink_msg_heartbeat_pack(SYSTEM, MAV_COMP_ID_AUTOPILOT1, &message, MAV_TYPE_FIXED_WING, MAV_AUTOPILOT_PX4,
                                     0, 0, MAV_STATE_CRITICAL);
    autopilot_take(&autopilot, &message, own_us);
    TEST_ASSERT_EQUAL_UINT8(MAV_STATE_CRITICAL, autopilot.system_status);
}

static void show_landed_state(uint8_t state) {
    mavlink_message_t message;
    (void)mavlink_msg_extended_sys_state_pack(SYSTEM, MAV_COMP_ID_AUTOPILOT1, &message, 0, state);
    autopilot_take(&autopilot, &message, own_us);
}

static void approach_and_touchdown_are_read(void) {
    show_landed_state(MAV_LANDED_STATE_LANDING);
    TEST_ASSERT_TRUE(autopilot.landing && !autopilot.on_ground);
    show_landed_state(MAV_LANDED_STATE_ON_GROUND);
    TEST_ASSERT_TRUE(!autopilot.landing && autopilot.on_ground);
    show_landed_state(MAV_LANDED_STATE_IN_AIR);
    TEST_ASSERT_FALSE(autopilot.landing || autopilot.on_ground);
}

/* ArduPlane's texts and states in their order. */
static void the_flare_is_read_from_its_text(void) {
    TEST_ASSERT_EQUAL_UINT8(GOE_FLIGHT_FLYING, autopilot_phase(&autopilot));
    show_landed_state(MAV_LANDED_STATE_LANDING);
    show_text("Landing approach start at 43.7m");
    TEST_ASSERT_EQUAL_UINT8(GOE_FLIGHT_APPROACH, autopilot_phase(&autopilot));
    show_text("Flare 3.8m sink=1.27 speed=14.1 dist=38.9");
    TEST_ASSERT_EQUAL_UINT8(GOE_FLIGHT_FLARE, autopilot_phase(&autopilot));
    show_landed_state(MAV_LANDED_STATE_LANDING); /* it rolls */
    TEST_ASSERT_EQUAL_UINT8(GOE_FLIGHT_FLARE, autopilot_phase(&autopilot));
    show_landed_state(MAV_LANDED_STATE_ON_GROUND);
    TEST_ASSERT_EQUAL_UINT8(GOE_FLIGHT_LANDED, autopilot_phase(&autopilot));
}

static void a_flare_that_is_broken_off_is_none(void) {
    show_landed_state(MAV_LANDED_STATE_LANDING);
    show_text("Flare 3.8m sink=1.27 speed=14.1 dist=38.9");
    show_landed_state(MAV_LANDED_STATE_IN_AIR);
    TEST_ASSERT_EQUAL_UINT8(GOE_FLIGHT_FLYING, autopilot_phase(&autopilot));
    show_landed_state(MAV_LANDED_STATE_LANDING); /* the next approach */
    TEST_ASSERT_EQUAL_UINT8(GOE_FLIGHT_APPROACH, autopilot_phase(&autopilot));
}

/* Without EXTENDED_SYS_STATE no message would end it. */
static void a_flare_without_a_landing_is_none(void) {
    show_text("Flare 3.8m sink=1.27 speed=14.1 dist=38.9");
    TEST_ASSERT_EQUAL_UINT8(GOE_FLIGHT_FLYING, autopilot_phase(&autopilot));
    show_landed_state(MAV_LANDED_STATE_LANDING);
    TEST_ASSERT_EQUAL_UINT8(GOE_FLIGHT_APPROACH, autopilot_phase(&autopilot));
}

static void the_place_that_it_flies_to_is_kept(void) {
    mavlink_message_t message;
    mavlink_position_target_global_int_t target;
    (void)memset(&target, 0, sizeof target);
    target.lat_int = 474000000;
    target.lon_int = 85000000;
    (void)mavlink_msg_position_target_global_int_encode(SYSTEM, MAV_COMP_ID_AUTOPILOT1, &message, &target);
    autopilot_take(&autopilot, &message, own_us);
    autopilot_take(&autopilot, &message, own_us);
    TEST_ASSERT_EQUAL_INT32(474000000, autopilot.target_lat_e7);
    TEST_ASSERT_EQUAL_INT32(85000000, autopilot.target_lon_e7);
    TEST_ASSERT_EQUAL_UINT(2, autopilot.targets);
}

/* After a restart each message is requested again at its configured rate. */
static void a_restart_of_the_autopilot_renews_all_requests(void) {
    config.link_request_rates = 1;
    config.link_attitude_hz = config.link_position_hz = 25.0;
    go_on(20);
    TEST_ASSERT_TRUE(autopilot.rates.count > 2);
    autopilot.rates.rate[0].hz = 5.0;
    boot_ms = 0;
    go_on(20);
    TEST_ASSERT_EQUAL_UINT32(1, (uint32_t)autopilot.restarts);
    CHECK_CLOSE(0.01, 25.0, autopilot.rates.rate[0].hz);
}

/* ---------------------------------------------------------------------------------------------------------- requests -- */

/* The first messages to a new autopilot: the question for its clock, the first rate, its origin and its home. */
static void requests_have_the_right_target_and_content(void) {
    receiver_t receiver;
    mavlink_message_t message;
    unsigned clocks = 0, origins = 0, homes = 0, rates = 0;
    link_close(wire.link);
    receiver_open(&receiver, &wire);
    config.link_request_rates = 1;
    config.link_attitude_hz = 40.0;
    autopilot_ask(&autopilot, own_us);
    while (receiver_next(&receiver, &message)) {
        TEST_ASSERT_EQUAL_UINT8(196, message.compid);
        if (message.msgid == MAVLINK_MSG_ID_TIMESYNC) {
            mavlink_timesync_t sync;
            mavlink_msg_timesync_decode(&message, &sync);
            TEST_ASSERT_EQUAL_INT64(0, sync.tc1);
            TEST_ASSERT_EQUAL_INT64(own_us * 1000, sync.ts1);
            clocks++;
            continue;
        }
        TEST_ASSERT_EQUAL_UINT32(MAVLINK_MSG_ID_COMMAND_LONG, message.msgid);
        mavlink_command_long_t request;
        mavlink_msg_command_long_decode(&message, &request);
        TEST_ASSERT_EQUAL_UINT8(SYSTEM, request.target_system);
        TEST_ASSERT_EQUAL_UINT8(MAV_COMP_ID_AUTOPILOT1, request.target_component);
        CHECK_SAME(0.0f, request.param7);
        const bool is_request = request.command == MAV_CMD_REQUEST_MESSAGE;
        origins += is_request && request.param1 == (float)MAVLINK_MSG_ID_GPS_GLOBAL_ORIGIN ? 1u : 0u;
        homes += is_request && request.param1 == (float)MAVLINK_MSG_ID_HOME_POSITION ? 1u : 0u;
        if (request.command == MAV_CMD_SET_MESSAGE_INTERVAL) {
            CHECK_SAME((float)MAVLINK_MSG_ID_ATTITUDE_QUATERNION, request.param1);
            CHECK_SAME(25000.0f, request.param2);
            rates++;
        }
    }
    TEST_ASSERT_EQUAL_UINT(1, clocks);
    TEST_ASSERT_EQUAL_UINT(1, origins);
    TEST_ASSERT_EQUAL_UINT(1, homes);
    TEST_ASSERT_EQUAL_UINT(1, rates);
    (void)close(receiver.socket);
}

/* The requests for an autopilot of each kind. */
static void each_kind_gets_its_own_requests(void) {
    static const uint32_t both[] = {MAVLINK_MSG_ID_ATTITUDE_QUATERNION, MAVLINK_MSG_ID_LOCAL_POSITION_NED,
                                    MAVLINK_MSG_ID_DISTANCE_SENSOR,     MAVLINK_MSG_ID_EXTENDED_SYS_STATE,
                                    MAVLINK_MSG_ID_HOME_POSITION,       MAVLINK_MSG_ID_ODOMETRY,
                                    MAVLINK_MSG_ID_GPS_RAW_INT};
    static const uint32_t px4[] = {MAVLINK_MSG_ID_ESTIMATOR_STATUS, MAVLINK_MSG_ID_ALTITUDE,
                                   MAVLINK_MSG_ID_POSITION_TARGET_GLOBAL_INT};
    static const uint32_t ardupilot[] = {MAVLINK_MSG_ID_EKF_STATUS_REPORT, MAVLINK_MSG_ID_TERRAIN_REPORT};
    for (int is_px4 = 0; is_px4 < 2; is_px4++) {
        message_rates_clear(&autopilot.rates);
        autopilot.kind = is_px4 ? MAV_AUTOPILOT_PX4 : MAV_AUTOPILOT_ARDUPILOTMEGA;
        autopilot.requested_us = 0;
        config.link_request_rates = 1;
        config.link_attitude_hz = 40.0;
        config.link_position_hz = 30.0;
        autopilot_ask(&autopilot, own_us);
        TEST_ASSERT_EQUAL_UINT(is_px4 ? 10 : 9, autopilot.rates.count);
        for (unsigned i = 0; i < autopilot.rates.count; i++) {
            const message_rate_t *rate = &autopilot.rates.rate[i];
            TEST_ASSERT_EQUAL_UINT32(i < 7u ? both[i] : is_px4 ? px4[i - 7u] : ardupilot[i - 7u], rate->message);
            TEST_ASSERT_TRUE(rate->wanted_hz > 0.0 && strlen(rate->name) > 6u);
        }
        CHECK_CLOSE(0.0, 40.0, autopilot.rates.rate[0].wanted_hz);
        CHECK_CLOSE(0.0, 30.0, autopilot.rates.rate[1].wanted_hz);
    }
}

/* The companion is a component of the autopilot's system. */
static void the_companion_takes_the_autopilots_system(void) {
    TEST_ASSERT_EQUAL_UINT8(SYSTEM, wire.system);
    TEST_ASSERT_EQUAL_UINT8(SYSTEM, wire.autopilot_system);
    autopilot_init(&autopilot, &config, &flight, &wire);
    beat(OTHER_SYSTEM);
    TEST_ASSERT_EQUAL_UINT8(OTHER_SYSTEM, wire.system);
    TEST_ASSERT_EQUAL_UINT8(OTHER_SYSTEM, wire.autopilot_system);
}

/* Each number of a position beyond its range, in both directions. */
static void a_position_out_of_range_is_counted(void) {
    fly(5);
    for (int i = 0; i < 6; i++) {
        for (int sign = -1; sign <= 1; sign += 2) {
            mavlink_message_t message;
            float number[6] = {north_m, 0.0f, -30.0f, SPEED_M_S, 0.0f, 0.0f};
            number[i] = (float)sign * (i < 3 ? 1.1e6f : 1.1e3f);
            own_us += 1000 * PERIOD_MS;
            boot_ms += PERIOD_MS;
            const unsigned long before = autopilot.bad_samples;
            (void)mavlink_msg_local_position_ned_pack(SYSTEM, MAV_COMP_ID_AUTOPILOT1, &message, boot_ms, number[0],
                                                      number[1], number[2], number[3], number[4], number[5]);
            autopilot_take(&autopilot, &message, own_us);
            TEST_ASSERT_EQUAL_UINT32((uint32_t)before + 1u, (uint32_t)autopilot.bad_samples);
            TEST_ASSERT_EQUAL_UINT32(0, (uint32_t)autopilot.jumps);
        }
    }
}

/* A vertical step counts like a horizontal one. */
static void a_step_of_the_height_is_a_known_jump(void) {
    for (int sign = -1; sign <= 1; sign += 2) {
        tearDown();
        setUp();
        fly(20);
        for (int k = 0; k < 3; k++) {
            own_us += 1000 * PERIOD_MS;
            boot_ms += PERIOD_MS;
            north_m += SPEED_M_S * 1e-3f * PERIOD_MS;
            send_attitude(SYSTEM, 1.0f, 0.0f);
            send_position(SYSTEM, north_m, -30.0f + 4.0f * (float)sign);
        }
        TEST_ASSERT_EQUAL_UINT32(1, (uint32_t)autopilot.jumps);
        CHECK_CLOSE(0.01, 4.0 * sign, autopilot.reset_delta_ned_m[2]);
    }
}

/* Terrain data are used where they are known, and for two seconds. */
static void terrain_is_the_ground_while_it_is_fresh(void) {
    for (int known = 0; known < 2; known++) {
        mavlink_message_t message;
        tearDown();
        setUp();
        fly(20);
        (void)mavlink_msg_terrain_report_pack(SYSTEM, MAV_COMP_ID_AUTOPILOT1, &message, 0, 0, known ? 100 : 0, 0.0f,
                                              25.0f, 0, 0);
        autopilot_take(&autopilot, &message, own_us);
        fly(2);
        TEST_ASSERT_EQUAL(known ? GOE_FLIGHT_TERRAIN : GOE_FLIGHT_HOME, flight.ground_source);
        CHECK_CLOSE(1e-3, known ? -5.0 : 0.0, flight.ground_down_m);
        fly(95);
        TEST_ASSERT_EQUAL(known ? GOE_FLIGHT_TERRAIN : GOE_FLIGHT_HOME, flight.ground_source);
        fly(10);
        TEST_ASSERT_EQUAL(GOE_FLIGHT_HOME, flight.ground_source);
    }
}

/* A ground station may ask for the terrain of any place. */
static void terrain_of_another_place_is_none(void) {
    for (int off_m = 150; off_m <= 250; off_m += 100) {
        for (int north = 0; north < 2; north++) {
            mavlink_message_t message;
            const float north_e7 = (north_m + (north ? (float)off_m : 0.0f)) / 0.0111195f;
            const float east_e7 = (north ? 0.0f : (float)off_m) / 0.0111195f / cosf(0.827286f); /* 47.4 degrees */
            tearDown();
            setUp();
            fly(20);
            (void)mavlink_msg_gps_global_origin_pack(SYSTEM, MAV_COMP_ID_AUTOPILOT1, &message, 474000000, 85000000,
                                                     400000, 0);
            autopilot_take(&autopilot, &message, own_us);
            (void)mavlink_msg_terrain_report_pack(SYSTEM, MAV_COMP_ID_AUTOPILOT1, &message,
                                                  474000000 + (int32_t)north_e7, 85000000 + (int32_t)east_e7, 100, 0.0f,
                                                  25.0f, 0, 0);
            autopilot_take(&autopilot, &message, own_us);
            TEST_ASSERT_EQUAL(off_m < 200, autopilot.has_terrain);
        }
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(requests_have_the_right_target_and_content);
    RUN_TEST(each_kind_gets_its_own_requests);
    RUN_TEST(the_companion_takes_the_autopilots_system);
    RUN_TEST(a_position_out_of_range_is_counted);
    RUN_TEST(a_step_of_the_height_is_a_known_jump);
    RUN_TEST(terrain_is_the_ground_while_it_is_fresh);
    RUN_TEST(terrain_of_another_place_is_none);
    RUN_TEST(samples_reach_the_flight_layer_at_their_own_time);
    RUN_TEST(nothing_is_taken_before_a_heartbeat_or_from_another_system);
    RUN_TEST(a_step_of_the_position_is_a_known_jump);
    RUN_TEST(losses_and_turns_of_an_aircraft_are_no_steps);
    RUN_TEST(a_turn_that_no_rate_explains_ends_the_tracks);
    RUN_TEST(an_attitude_about_any_axis_is_compared);
    RUN_TEST(home_is_the_ground_by_the_autopilots_own_count);
    RUN_TEST(every_autopilot_has_a_name);
    RUN_TEST(a_restart_of_the_autopilot_begins_a_new_clock);
    RUN_TEST(a_clock_that_slips_ends_nothing);
    RUN_TEST(what_is_not_finite_is_refused_and_counted);
    RUN_TEST(messages_that_come_twice_or_late_change_nothing);
    RUN_TEST(a_time_ahead_of_the_clock_is_not_taken);
    RUN_TEST(odometry_counts_resets_that_show_no_step);
    RUN_TEST(a_counter_that_rises_with_a_step_adds_no_reset);
    RUN_TEST(an_image_outlasts_a_clock_that_is_corrected_backwards);
    RUN_TEST(a_range_finder_is_taken_upright);
    RUN_TEST(an_invalid_signal_of_a_range_finder_is_none);
    RUN_TEST(the_end_of_an_avoidance_is_read_from_its_text);
    RUN_TEST(a_failsafe_is_read_from_the_heartbeat);
    RUN_TEST(approach_and_touchdown_are_read);
    RUN_TEST(the_flare_is_read_from_its_text);
    RUN_TEST(a_flare_that_is_broken_off_is_none);
    RUN_TEST(a_flare_without_a_landing_is_none);
    RUN_TEST(the_place_that_it_flies_to_is_kept);
    RUN_TEST(a_restart_of_the_autopilot_renews_all_requests);
    return UNITY_END();
}
