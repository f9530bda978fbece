/* AP_GOE, compiled as in ArduPilot and run with a scripted vehicle: it has the state of a flight layer with the same input,
 * to the last bit, and acts on it as its header documents. SPDX-License-Identifier: MIT */
#include "flown_vehicle.h"

#include <AP_HAL/AP_HAL.h>

#include <fenv.h>

#include <atomic>
#include <cstring>
#include <set>
#include <string>
#include <thread>

extern "C" {
#include "goe_settings_list.h"
}

static const uint32_t ID = 0x474F4500u;

void setUp(void) {}
void tearDown(void) {}

static goe_flight_obstacle_t obstacle_of(const FlownVehicle &vehicle, int slot) {
    goe_flight_obstacle_t obstacle;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, vehicle.goe->_state->shown.state[slot]);
    obstacle = vehicle.goe->_state->shown.obstacle[slot];
    return obstacle;
}

static bool may_arm(const FlownVehicle &vehicle, const char *why) {
    char text[42] = "";
    const bool may = vehicle.goe->pre_arm_check(text, sizeof text);
    if (!may) {
        TEST_ASSERT_EQUAL_STRING(why, text);
    }
    return may;
}

// -------------------------------------------------------------------------------------------------------------- equality

static void test_it_has_the_state_of_the_layer(void) {
    FlownVehicle vehicle;
    vehicle.fly(8.0);
    TEST_ASSERT_EQUAL(1, vehicle.seen().obstacles);
    TEST_ASSERT_GREATER_THAN(60, vehicle.layer.counters.taken);
    TEST_ASSERT_EQUAL(80, vehicle.compared);
    TEST_ASSERT_TRUE(vehicle.goe->healthy());
}

static void test_an_early_image_waits_for_its_pose(void) {
    FlownVehicle vehicle;
    vehicle.delay = 0;
    vehicle.ahead_us = 50000; // exposed between future samples
    vehicle.fly(4.0);
    TEST_ASSERT_GREATER_THAN(20, vehicle.flight().counters.early);
    TEST_ASSERT_GREATER_OR_EQUAL(vehicle.images - 1, vehicle.flight().counters.taken);
    TEST_ASSERT_EQUAL(1, vehicle.seen().obstacles);
}

static void test_images_of_the_future_block_nobody(void) {
    FlownVehicle vehicle;
    vehicle.compares = false; // a full queue drops the oldest image, and the reference layer does not
    vehicle.ahead_us = 40000000;
    vehicle.fly(4.0);
    TEST_ASSERT_EQUAL(0, vehicle.flight().counters.taken);
    TEST_ASSERT_FALSE(vehicle.goe->healthy());
    vehicle.ahead_us = 0;
    vehicle.fly(4.0);
    TEST_ASSERT_TRUE(vehicle.goe->healthy());
    TEST_ASSERT_EQUAL(1, vehicle.seen().obstacles);
}

static void test_a_late_image_is_counted_and_left(void) {
    FlownVehicle vehicle;
    vehicle.delay = 25; // half a second
    vehicle.fly(4.0);
    TEST_ASSERT_EQUAL(0, vehicle.flight().counters.taken);
    TEST_ASSERT_GREATER_THAN(30, vehicle.flight().counters.late);
    TEST_ASSERT_FALSE(vehicle.goe->healthy());
    TEST_ASSERT_TRUE(scripted.database().empty());
}

static void test_the_clock_may_wrap(void) {
    FlownVehicle vehicle;
    vehicle.first_us = (uint64_t(1) << 32) - 3000000;
    vehicle.fly(8.0);
    TEST_ASSERT_EQUAL(1, vehicle.seen().obstacles);
}

static void test_a_full_table(void) {
    FlownVehicle vehicle;
    vehicle.copies = GOE_FLIGHT_SLOTS + 2;
    vehicle.fly(6.0);
    std::set<uint32_t> ids;
    for (const auto &item : scripted.database()) {
        TEST_ASSERT_GREATER_OR_EQUAL(ID, item.first);
        TEST_ASSERT_LESS_THAN(ID + GOE_FLIGHT_SLOTS * (1u + vehicle.flight().counters.evicted), item.first);
        ids.insert(item.first);
    }
    TEST_ASSERT_GREATER_THAN(1, ids.size());
    TEST_ASSERT_GREATER_THAN(0, vehicle.flight().counters.full + vehicle.flight().counters.evicted);
}

// ---------------------------------------------------------------------------------------------------------------- resets

static void test_a_known_jump_moves_the_obstacle_in_the_database(void) {
    FlownVehicle vehicle;
    vehicle.fly(6.0);
    const Vector3f before = scripted.database().at(ID).pos;
    scripted.horizontal_reset_ms = AP_HAL::millis();
    scripted.horizontal_change = Vector2f(7.0f, -4.0f);
    vehicle.jump = Vector3f(7.0f, -4.0f, 0.0f);
    vehicle.fly(0.3);
    const Vector3f after = scripted.database().at(ID).pos;
    CHECK_CLOSE(0.5, 7.0, after.x - before.x);
    CHECK_CLOSE(0.5, -4.0, after.y - before.y);
    TEST_ASSERT_EQUAL(1, vehicle.flight().counters.resets);
    TEST_ASSERT_EQUAL(0, vehicle.flight().counters.lost);
}

static void test_a_reset_of_the_heading_ends_all(void) {
    FlownVehicle vehicle;
    vehicle.fly(6.0);
    scripted.yaw_reset_ms = AP_HAL::millis();
    vehicle.step();
    TEST_ASSERT_EQUAL(1, vehicle.flight().counters.lost);
    vehicle.fly(0.2);
    TEST_ASSERT_TRUE(scripted.has_said("all tracks ended"));
    TEST_ASSERT_EQUAL(1, vehicle.seen().obstacles); /* kept as suspect, until an image locates it again */
    TEST_ASSERT_TRUE(vehicle.seen().suspect);
}

static void test_another_filter_ends_all(void) {
    FlownVehicle vehicle;
    vehicle.fly(6.0);
    vehicle.compares = false;
    scripted.ekf_type = 2;
    vehicle.step();
    TEST_ASSERT_EQUAL(1, vehicle.flight().counters.lost);
}

static void test_time_jumps(void) {
    for (const int64_t jump_us : {INT64_C(-900000), INT64_C(700000), INT64_C(20000000)}) {
        FlownVehicle vehicle;
        vehicle.fly(2.0);
        vehicle.first_us += uint64_t(jump_us);
        vehicle.fly(5.0); // compared at each step
        TEST_ASSERT_TRUE(vehicle.goe->healthy());
        TEST_ASSERT_EQUAL(1, vehicle.seen().obstacles);
    }
}

static void test_without_a_pose_it_is_not_healthy(void) {
    FlownVehicle vehicle;
    vehicle.compares = false;
    vehicle.fly(3.0);
    TEST_ASSERT_TRUE(vehicle.goe->healthy());
    scripted.has_nav = false;
    vehicle.fly(1.0);
    TEST_ASSERT_FALSE(vehicle.goe->healthy());
    TEST_ASSERT_FALSE(may_arm(vehicle, "GOE: no pose"));
    scripted.has_nav = true;
    vehicle.fly(3.0);
    TEST_ASSERT_TRUE(vehicle.goe->healthy());
}

/* Without a position after a reset of the heading nothing can be assessed: the order, the obstacles and the
 * parameters that wait stay as they are. */
static void test_what_cannot_be_assessed_ends_no_order(void) {
    FlownVehicle vehicle;
    vehicle.compares = false;
    scene_make_cylinder(&vehicle.flown.scene);
    vehicle.flown.scene.x0_m = 0.5;
    vehicle.flown.scene.z0_m = 260.0;
    do {
        vehicle.step();
    } while (vehicle.seen().action == GOE_FLIGHT_NONE && vehicle.flown.sample < 13 * FLOWN_POSE_HZ);
    const goe_flight_action_t action = vehicle.seen().action;
    TEST_ASSERT_NOT_EQUAL(GOE_FLIGHT_NONE, action);
    scripted.armed = true;
    set_parameter(*vehicle.goe, "MARGIN", 25);
    scripted.texts.clear();
    scripted.yaw_reset_ms = AP_HAL::millis();
    vehicle.jump = Vector3f(2e6f, 0.0f, 0.0f); // out of range: such a position is refused
    vehicle.fly(1.3);
    TEST_ASSERT_EQUAL(action, vehicle.seen().action);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_NO_POSE, vehicle.goe->_state->shown.state[0]);
    TEST_ASSERT_FALSE(may_arm(vehicle, "GOE: no pose"));
    TEST_ASSERT_TRUE(scripted.has_said("GOE: no pose"));
    TEST_ASSERT_FALSE(scripted.has_said("action ended"));
    TEST_ASSERT_TRUE(scripted.has_said("parameters wait"));
    CHECK_CLOSE(0.0, 15.0, vehicle.flight().settings.margin_m);
    goe_mavlink_status_t status;
    TEST_ASSERT_EQUAL(42703, scripted.sent.back().msgid);
    goe_mavlink_read_status(scripted.sent.back().payload.data(), scripted.sent.back().payload.size(), &status);
    TEST_ASSERT_EQUAL(action, status.action);
    TEST_ASSERT_EQUAL(1 | 4, status.alive);
}

static void test_before_the_first_pose_none_contradicts(void) {
    FlownVehicle vehicle;
    vehicle.compares = false;
    scripted.has_nav = false;
    vehicle.step();
    TEST_ASSERT_FALSE(may_arm(vehicle, "GOE: no pose"));
    vehicle.fly(1.0);
    TEST_ASSERT_FALSE(may_arm(vehicle, "GOE: no pose"));
}

// ---------------------------------------------------------------------------------------------------------------- health

static void test_healthy_means_alive_and_not_that_something_is_there(void) {
    FlownVehicle vehicle;
    vehicle.flown.detects = false;
    vehicle.fly(3.0);
    TEST_ASSERT_TRUE(vehicle.goe->healthy());
    TEST_ASSERT_EQUAL(0, vehicle.seen().obstacles);
    TEST_ASSERT_TRUE(may_arm(vehicle, ""));
    vehicle.sends = false;
    vehicle.fly(3.0);
    TEST_ASSERT_FALSE(vehicle.goe->healthy());
    TEST_ASSERT_FALSE(may_arm(vehicle, "GOE: no images"));
    TEST_ASSERT_TRUE(scripted.has_said("GOE: no images"));
    set_parameter(*vehicle.goe, "OPTIONS", 0);
    TEST_ASSERT_TRUE(may_arm(vehicle, ""));
    set_parameter(*vehicle.goe, "OPTIONS", 1);
    vehicle.sends = true;
    vehicle.fly(3.0);
    TEST_ASSERT_TRUE(may_arm(vehicle, ""));
}

static void test_disabled_it_takes_no_memory_and_keeps_nobody_from_arming(void) {
    FlownVehicle vehicle;
    set_parameter(*vehicle.goe, "ENABLE", 0);
    vehicle.compares = false;
    vehicle.fly(2.0);
    TEST_ASSERT_EQUAL(0, scripted.allocations);
    TEST_ASSERT_NULL(vehicle.goe->_state);
    TEST_ASSERT_TRUE(may_arm(vehicle, ""));
    TEST_ASSERT_TRUE(scripted.sent.empty() && scripted.log.empty() && scripted.texts.empty());
}

static void test_switched_off_it_is_not_healthy_and_keeps_nobody_from_arming(void) {
    FlownVehicle vehicle;
    vehicle.fly(3.0);
    vehicle.sends = false;
    vehicle.fly(3.0);
    TEST_ASSERT_FALSE(may_arm(vehicle, "GOE: no images"));
    vehicle.sends = true;
    vehicle.fly(3.0);
    TEST_ASSERT_TRUE(vehicle.goe->healthy());
    vehicle.compares = false;
    set_parameter(*vehicle.goe, "ENABLE", 0);
    const uint32_t so_far_ms = scripted.database().at(ID).timestamp_ms;
    vehicle.fly(3.0);
    TEST_ASSERT_EQUAL(so_far_ms, scripted.database().at(ID).timestamp_ms);
    TEST_ASSERT_FALSE(vehicle.goe->healthy());
    TEST_ASSERT_TRUE(may_arm(vehicle, ""));
}

static void test_without_memory_it_says_so(void) {
    FlownVehicle vehicle;
    scripted.has_memory = false;
    vehicle.compares = false;
    vehicle.fly(2.0);
    TEST_ASSERT_EQUAL(1, scripted.allocations);
    TEST_ASSERT_FALSE(vehicle.goe->healthy());
    TEST_ASSERT_FALSE(may_arm(vehicle, "GOE: no memory or no thread"));
}

static void test_without_a_thread_it_says_so(void) {
    FlownVehicle vehicle;
    scripted.has_threads = false;
    vehicle.compares = false;
    vehicle.fly(2.0);
    TEST_ASSERT_EQUAL(1, scripted.allocations);
    TEST_ASSERT_FALSE(vehicle.goe->healthy());
    TEST_ASSERT_FALSE(may_arm(vehicle, "GOE: no memory or no thread"));
    TEST_ASSERT_TRUE(scripted.has_said("GOE: no thread"));
}

// ---------------------------------------------------------------------------------------------------------------- thread

static void test_the_scheduler_waits_for_no_estimator(void) {
    FlownVehicle vehicle;
    vehicle.compares = false;
    vehicle.fly(6.0);
    TEST_ASSERT_EQUAL_STRING("goe", scripted.thread_name.c_str());
    TEST_ASSERT_GREATER_OR_EQUAL(3130 + 200 + 1500,
                                 scripted.thread_stack); // the layer's deepest call, the thread's, spare
    TEST_ASSERT_EQUAL(300, scripted.wakes);
    scripted.thread_is_late = true;
    const unsigned taken = vehicle.flight().counters.taken;
    vehicle.fly(0.2);
    TEST_ASSERT_EQUAL(taken, vehicle.flight().counters.taken); // update() used none of it
}

static void test_the_layer_knows_that_the_vehicle_lands(void) {
    bool goes_around = false;
    FlownVehicle vehicle;
    vehicle.compares = false;
    vehicle.flown.scene.altitude_m = 9.0; // over a truck of 2.5 m: less than GOE_CLEAR
    vehicle.flown.scene.x0_m = 0.5;
    vehicle.flown.scene.z0_m = 260.0;
    scripted.landing = true;
    for (int i = 0; i < 12 * FLOWN_POSE_HZ; i++) {
        vehicle.step();
        goes_around = goes_around || vehicle.seen().action == GOE_FLIGHT_GO_AROUND;
    }
    TEST_ASSERT_TRUE(goes_around);
}

static void test_a_thread_that_is_late_loses_no_pose_and_no_image(void) {
    FlownVehicle vehicle;
    vehicle.compares = false; // the reference layer assesses meanwhile
    vehicle.fly(6.0);
    for (int i = 0; i < 5; i++) {
        scripted.thread_is_late = true;
        vehicle.fly(0.2);
        scripted.thread_is_late = false;
        vehicle.fly(0.2);
    }
    TEST_ASSERT_EQUAL(vehicle.layer.counters.taken, vehicle.flight().counters.taken);
    TEST_ASSERT_EQUAL(1, vehicle.seen().obstacles);
}

/* The thread, the main loop and the database's thread in parallel, at full speed: input for a thread sanitizer. */
static void test_the_threads_may_run_at_once(void) {
    FlownVehicle vehicle;
    vehicle.compares = false;
    vehicle.fly(3.0);
    scripted.runs_at_once = true;
    std::atomic<bool> goes_on(true);
    std::thread planner([&] {
        while (goes_on) {
            AP::oadatabase()->update();
            std::this_thread::yield();
        }
    });
    for (int i = 0; i < 200; i++) {
        vehicle.steps_database = false;
        vehicle.step();
        if (i % 10 == 0) {
            char text[42];
            (void)vehicle.goe->pre_arm_check(text, sizeof text);
            set_parameter(*vehicle.goe, "OPTIONS", i % 20 == 0 ? 0 : 1);
        }
    }
    goes_on = false;
    planner.join();
    wait_for_the_thread();
    scripted.runs_at_once = false;
    vehicle.fly(2.0);
    TEST_ASSERT_TRUE(vehicle.goe->healthy());
    TEST_ASSERT_EQUAL(1, vehicle.seen().obstacles);
    TEST_ASSERT_EQUAL(1, scripted.database().size());
}

static void test_a_stopped_thread_is_survived(void) {
    FlownVehicle vehicle;
    vehicle.compares = false;
    vehicle.copies = 4;
    vehicle.fly(6.0);
    scripted.thread_is_late = true;
    vehicle.fly(3.0); // the inbox is full by then
    scripted.thread_is_late = false;
    vehicle.fly(4.0);
    TEST_ASSERT_TRUE(vehicle.goe->healthy());
    TEST_ASSERT_GREATER_OR_EQUAL(1, vehicle.seen().obstacles);
}

// ------------------------------------------------------------------------------------------------------------ parameters

static void test_parameters_wait_in_flight_until_nothing_is_followed(void) {
    FlownVehicle vehicle;
    vehicle.fly(6.0);
    scripted.armed = true;
    set_parameter(*vehicle.goe, "MARGIN", 25);
    vehicle.fly(3.0); // compared with the layer, which has the old ones
    TEST_ASSERT_TRUE(scripted.has_said("parameters wait"));
    CHECK_CLOSE(0.0, 15.0, vehicle.flight().settings.margin_m);
    vehicle.flown.detects = false;
    vehicle.fly(1.0);
    vehicle.compares = false;
    vehicle.fly(13.0); // forgotten by then
    TEST_ASSERT_TRUE(scripted.has_said("new parameters in use"));
    CHECK_CLOSE(0.0, 25.0, vehicle.flight().settings.margin_m);
}

static void test_on_the_ground_parameters_are_taken_at_once(void) {
    FlownVehicle vehicle;
    vehicle.fly(3.0);
    vehicle.compares = false;
    set_parameter(*vehicle.goe, "HOME_SD", 8);
    vehicle.fly(1.1);
    CHECK_CLOSE(0.0, 8.0, vehicle.flight().settings.home_sd_m);
    vehicle.fly(3.0);
    TEST_ASSERT_TRUE(vehicle.goe->healthy());
}

static void test_bad_parameters_are_refused_and_the_good_ones_go_on(void) {
    FlownVehicle vehicle;
    vehicle.fly(3.0);
    vehicle.compares = false;
    set_parameter(*vehicle.goe, "CLEAR", 2000);
    vehicle.fly(4.0);
    TEST_ASSERT_TRUE(scripted.has_said("GOE: bad parameter GOE_CLEAR"));
    TEST_ASSERT_FALSE(may_arm(vehicle, "GOE: bad parameter GOE_CLEAR"));
    TEST_ASSERT_FALSE(vehicle.goe->healthy());
    CHECK_CLOSE(0.0, 10.0, vehicle.flight().settings.clearance_m);
    TEST_ASSERT_EQUAL(1, vehicle.seen().obstacles); // it continues
    set_parameter(*vehicle.goe, "CLEAR", 12);
    vehicle.fly(4.0);
    TEST_ASSERT_TRUE(vehicle.goe->healthy());
    CHECK_CLOSE(0.0, 12.0, vehicle.flight().settings.clearance_m);
}

static void test_without_a_camera_it_names_the_missing_parameter(void) {
    FlownVehicle vehicle;
    set_parameter(*vehicle.goe, "FX", 0);
    vehicle.compares = false;
    vehicle.fly(2.0);
    TEST_ASSERT_FALSE(may_arm(vehicle, "GOE: bad parameter GOE_FX"));
}

static void test_a_bad_parameter_is_named_as_the_ground_station_shows_it(void) {
    const Parameter bad[] = {
        {"WIDTH", -1},   {"HEIGHT", -1}, {"FX", -1},      {"FY", -1},      {"CX", 2e5f},    {"CY", 2e5f},
        {"K1", 200},     {"K2", 200},    {"P1", 200},     {"P2", 200},     {"K3", 200},     {"YAW", 400},
        {"PITCH", 400},  {"ROLL", 400},  {"POS_X", 2e4f}, {"POS_Y", 2e4f}, {"POS_Z", 2e4f}, {"DELAY", 1},
        {"HOME_SD", -1}, {"GND_SD", -1}, {"MARGIN", -1},  {"CLEAR", -1},
    };
    for (const Parameter &parameter : bad) {
        FlownVehicle vehicle;
        vehicle.compares = false;
        set_parameter(*vehicle.goe, parameter.name, parameter.value);
        vehicle.fly(0.5);
        TEST_ASSERT_FALSE(may_arm(vehicle, (std::string("GOE: bad parameter GOE_") + parameter.name).c_str()));
    }
    FlownVehicle vehicle;
    vehicle.compares = false;
    scripted.parameters["ROLL_LIMIT_DEG"] = 2;
    vehicle.fly(0.5);
    TEST_ASSERT_FALSE(may_arm(vehicle, "GOE: bad parameter ROLL_LIMIT_DEG"));
}

// --------------------------------------------------------------------------------- settings from the vehicle's parameters

static goe_flight_settings_t settings_of(const std::map<std::string, float> &parameters) {
    FlownVehicle vehicle;
    vehicle.compares = false;
    scripted.parameters = parameters;
    vehicle.fly(2.5);
    return vehicle.flight().settings;
}

static void test_the_loiter_radius_is_the_vehicles(void) {
    CHECK_CLOSE(0.0, 0.0, settings_of({}).loiter_m); // a copter has none
    CHECK_CLOSE(0.0, 0.0, settings_of({{"AIRSPEED_CRUISE", 22}}).loiter_m);
    CHECK_CLOSE(0.0, 120.0, settings_of({{"WP_LOITER_RAD", 120}, {"AIRSPEED_CRUISE", 22}}).loiter_m);
    CHECK_CLOSE(0.0, 120.0, settings_of({{"WP_LOITER_RAD", -120}}).loiter_m); // to the left
    TEST_ASSERT_FALSE(scripted.has_said("too small"));
}

static unsigned words_with(const char *part) {
    unsigned words = 0;
    for (const std::string &text : scripted.texts) {
        words += text.find(part) != std::string::npos;
    }
    return words;
}

static void test_a_circle_that_cannot_be_flown_is_widened_with_a_word(void) {
    CHECK_CLOSE(0.2, 85.5, settings_of({{"WP_LOITER_RAD", 60}, {"AIRSPEED_CRUISE", 22}}).loiter_m); // 22^2 / (g tan 30)
    TEST_ASSERT_EQUAL(1, words_with("GOE: WP_LOITER_RAD 60 too small, 85 used"));
    CHECK_CLOSE(0.2, 85.5, settings_of({{"WP_LOITER_RAD", 60}, {"TRIM_ARSPD_CM", 2200}}).loiter_m);
    CHECK_CLOSE(0.3, 135.6,
                settings_of({{"WP_LOITER_RAD", 60}, {"AIRSPEED_CRUISE", 22}, {"ROLL_LIMIT_DEG", 20}}).loiter_m);
}

static void test_the_word_about_the_circle_comes_once(void) {
    FlownVehicle vehicle;
    vehicle.compares = false;
    scripted.parameters = {{"WP_LOITER_RAD", 60}, {"AIRSPEED_CRUISE", 22}};
    vehicle.fly(2.0);
    set_parameter(*vehicle.goe, "MARGIN", 20);
    vehicle.fly(2.0);
    TEST_ASSERT_EQUAL(1, words_with("too small"));
    scripted.parameters["AIRSPEED_CRUISE"] = 25;
    vehicle.fly(2.0);
    TEST_ASSERT_EQUAL(2, words_with("too small"));
}

static void test_parameters_are_searched_for_once(void) {
    FlownVehicle vehicle;
    vehicle.compares = false;
    scripted.parameters = {{"WP_LOITER_RAD", 60}, {"AIRSPEED_CRUISE", 22}};
    vehicle.step();
    const unsigned searches = scripted.searches;
    TEST_ASSERT_LESS_OR_EQUAL(6, searches);
    vehicle.fly(3.0);
    TEST_ASSERT_EQUAL(searches, scripted.searches);
}

static void test_bank_and_climb_are_no_more_than_the_vehicles(void) {
    CHECK_CLOSE(0.0, 20.0, settings_of({{"ROLL_LIMIT_DEG", 20}}).bank_deg);
    CHECK_CLOSE(1e-4, 25.0, settings_of({{"LIM_ROLL_CD", 2500}}).bank_deg);
    CHECK_CLOSE(0.0, 30.0, settings_of({{"ROLL_LIMIT_DEG", 55}}).bank_deg);
    CHECK_CLOSE(0.0, 2.0, settings_of({{"TECS_CLMB_MAX", 2}}).climb_m_s);
    CHECK_CLOSE(0.0, 2.5, settings_of({{"TECS_CLMB_MAX", 5}}).climb_m_s);
}

static void test_defaults_are_those_of_the_library(void) {
    scripted = Scripted();
    AP_GOE &goe = *new_goe();
    set_parameter(goe, "ENABLE", 1);
    set_parameter(goe, "WIDTH", 640);
    set_parameter(goe, "HEIGHT", 480);
    set_parameter(goe, "FX", 500);
    goe.update();
    goe_flight_settings_t expected;
    goe_flight_settings_default(&expected);
    expected.resets = GOE_FLIGHT_RESETS_TIME;
    const goe_flight_settings_t &actual = goe._state->flight.settings;
#define GOE_FLIGHT_SETTING(field, least, most, usual) CHECK_SAME(expected.field, actual.field);
#include "goe_flight_settings_list.h"
#undef GOE_FLIGHT_SETTING
    goe_settings_t library;
    goe_settings_default(&library);
    library.camera = goe._state->good.estimator.camera;
    CHECK_CLOSE(1e-6, 0.3,
                goe._state->good.estimator.navigation.attitude_walk_sd_deg); // the library's 0 assumes a better filter
    library.navigation.attitude_walk_sd_deg = goe._state->good.estimator.navigation.attitude_walk_sd_deg;
    TEST_ASSERT_EQUAL_MEMORY(&library, &goe._state->good.estimator, sizeof library);
}

static void test_parameters_fit_into_their_table(void) {
    std::set<unsigned> numbers;
    std::set<std::string> names;
    for (const AP_Param::GroupInfo *info = AP_GOE::var_info; info->type != AP_PARAM_NONE; info++) {
        TEST_ASSERT_LESS_OR_EQUAL_MESSAGE(16, strlen("GOE_") + strlen(info->name), info->name);
        TEST_ASSERT_LESS_THAN_MESSAGE(64, info->idx, info->name);
        TEST_ASSERT_TRUE_MESSAGE(numbers.insert(info->idx).second, info->name);
        TEST_ASSERT_TRUE_MESSAGE(names.insert(info->name).second, info->name);
    }
    TEST_ASSERT_EQUAL(26, numbers.size());
}

// -------------------------------------------------------------------------------------------------------------- messages

static unsigned taken_of(void (*change)(mavlink_message_t &, FlownVehicle &)) {
    FlownVehicle vehicle;
    vehicle.sends = false;
    vehicle.compares = false;
    vehicle.fly(1.0);
    goe_mavlink_features_t features;
    memset(&features, 0, sizeof features);
    features.time_usec = scripted.now_us - 50000;
    features.image_width = features.image_height = 1280;
    mavlink_message_t message = features_message(features);
    change(message, vehicle);
    vehicle.goe->handle_unknown(message, MAVLINK_COMM_0);
    vehicle.fly(0.2);
    return vehicle.flight().counters.taken;
}

static bool accepts_none(const mavlink_status_t *, uint32_t) { return false; }
static bool accepts_any(const mavlink_status_t *, uint32_t) { return true; }

static mavlink_signing_t no_callback = {nullptr}, strict = {accepts_none}, lenient = {accepts_any};

static void test_only_whole_messages_of_the_own_vehicle_are_taken(void) {
    TEST_ASSERT_EQUAL(1, taken_of([](mavlink_message_t &, FlownVehicle &) {}));
    TEST_ASSERT_EQUAL(0, taken_of([](mavlink_message_t &m, FlownVehicle &) { m.checksum ^= 1; }));
    TEST_ASSERT_EQUAL(0, taken_of([](mavlink_message_t &m, FlownVehicle &) { m.payload64[0] ^= 4; }));
    TEST_ASSERT_EQUAL(0, taken_of([](mavlink_message_t &m, FlownVehicle &) { m.len = 0; }));
    TEST_ASSERT_EQUAL(0, taken_of([](mavlink_message_t &m, FlownVehicle &) { m.len = 255; }));
    TEST_ASSERT_EQUAL(0, taken_of([](mavlink_message_t &m, FlownVehicle &) { m.msgid = 42701; }));
    TEST_ASSERT_EQUAL(0, taken_of([](mavlink_message_t &m, FlownVehicle &) {
                          goe_mavlink_features_t features;
                          goe_mavlink_read_features(reinterpret_cast<const uint8_t *>(_MAV_PAYLOAD(&m)), m.len,
                                                    &features);
                          m = features_message(features, 2);
                      }));
    TEST_ASSERT_EQUAL(0, taken_of([](mavlink_message_t &, FlownVehicle &) { scripted.channel[0].signing = &strict; }));
    TEST_ASSERT_EQUAL(
        0, taken_of([](mavlink_message_t &, FlownVehicle &) { scripted.channel[0].signing = &no_callback; }));
    TEST_ASSERT_EQUAL(1, taken_of([](mavlink_message_t &, FlownVehicle &) { scripted.channel[0].signing = &lenient; }));
    TEST_ASSERT_EQUAL(1, taken_of([](mavlink_message_t &m, FlownVehicle &vehicle) {
                          vehicle.goe->handle_message(m); // by a dialect that includes it
                          m.checksum ^= 1;
                      }));
}

static unsigned count_sent(mavlink_channel_t channel, uint32_t msgid) {
    unsigned count = 0;
    for (const ScriptedSent &sent : scripted.sent) {
        count += sent.channel == channel && sent.msgid == msgid;
    }
    return count;
}

static void test_sent_messages(void) {
    FlownVehicle vehicle;
    scripted.channel.resize(3);
    scripted.active = {true, true, true};
    scripted.is_private = {false, false, true};
    scripted.channel[1].flags = MAVLINK_STATUS_FLAG_OUT_MAVLINK1;
    vehicle.fly(6.0);
    TEST_ASSERT_INT_WITHIN(1, 6, count_sent(MAVLINK_COMM_0, 42703));
    TEST_ASSERT_GREATER_THAN(2, count_sent(MAVLINK_COMM_0, 42701));
    TEST_ASSERT_EQUAL(count_sent(MAVLINK_COMM_0, 42701), count_sent(MAVLINK_COMM_0, 42702));
    TEST_ASSERT_EQUAL(count_sent(MAVLINK_COMM_0, 42701) + count_sent(MAVLINK_COMM_0, 42702) +
                          count_sent(MAVLINK_COMM_0, 42703),
                      scripted.sent.size());
    for (const ScriptedSent &sent : scripted.sent) {
        const goe_mavlink_info_t *info = goe_mavlink_info(goe_mavlink_of_id(sent.msgid));
        TEST_ASSERT_EQUAL(info->length, sent.payload.size());
        TEST_ASSERT_EQUAL(info->crc_extra, sent.crc_extra);
    }
    goe_mavlink_status_t status;
    const ScriptedSent &last = scripted.sent.back();
    TEST_ASSERT_EQUAL(42703, last.msgid);
    goe_mavlink_read_status(last.payload.data(), last.payload.size(), &status);
    TEST_ASSERT_EQUAL(7, status.alive);
    TEST_ASSERT_INT_WITHIN(3, 100, status.delay_mean);
    TEST_ASSERT_INT_WITHIN(3, 100, status.delay_max);
    TEST_ASSERT_EQUAL(1, status.obstacles);

    const size_t so_far = scripted.sent.size();
    scripted.txspace = 40;
    vehicle.fly(2.0);
    scripted.txspace = 1000;
    set_parameter(*vehicle.goe, "REPORT_HZ", 0);
    vehicle.fly(2.0);
    TEST_ASSERT_EQUAL(so_far, scripted.sent.size());
}

// -------------------------------------------------------------------------------------------------------------- database

static void test_an_obstacle_in_the_database(void) {
    FlownVehicle vehicle;
    set_parameter(*vehicle.goe, "OA_SIGMA", 0);
    vehicle.fly(6.0);
    const goe_flight_obstacle_t obstacle = obstacle_of(vehicle, 0);
    TEST_ASSERT_EQUAL(1, scripted.database().size());
    const AP_OADatabase::OA_DbItem item = scripted.database().at(ID);
    CHECK_SAME(obstacle.radius_m, item.radius);
    CHECK_SAME(obstacle.center_ned_m[0], item.pos.x);
    CHECK_SAME(obstacle.center_ned_m[1], item.pos.y);
    TEST_ASSERT_EQUAL(AP_HAL::millis(), item.timestamp_ms);
    TEST_ASSERT_EQUAL(0xFF, item.send_to_gcs);
}

static void test_the_ground_station_sees_an_item_twice_a_second(void) {
    FlownVehicle vehicle;
    vehicle.fly(6.0);
    unsigned sent = 0;
    for (int i = 0; i < 4 * FLOWN_POSE_HZ; i++) {
        vehicle.step();
        sent += scripted.database().at(ID).send_to_gcs == 0xFF;
        AP::oadatabase()->note_sent();
    }
    TEST_ASSERT_INT_WITHIN(1, 8, sent);
}

static void test_others_items_stay_as_they_are(void) {
    FlownVehicle vehicle;
    AP::oadatabase()->begin(2);
    vehicle.fly(6.0);
    TEST_ASSERT_EQUAL(3, AP::oadatabase()->database_count());
    for (unsigned i = 0; i < 2; i++) {
        CHECK_SAME(0.0f, AP::oadatabase()->get_item(i).radius);
        TEST_ASSERT_EQUAL(0, AP::oadatabase()->get_item(i).timestamp_ms);
    }
}

static void test_a_full_database_is_survived(void) {
    FlownVehicle vehicle;
    AP::oadatabase()->begin(5);
    vehicle.fly(6.0);
    TEST_ASSERT_EQUAL(5, AP::oadatabase()->database_count());
    TEST_ASSERT_TRUE(scripted.database().empty());
}

static void test_an_obstacle_that_the_database_forgot_comes_back(void) {
    FlownVehicle vehicle;
    vehicle.fly(6.0);
    AP::oadatabase()->begin(0);
    vehicle.step();
    TEST_ASSERT_EQUAL(1, scripted.database().size());
}

static void test_the_database_keeps_its_limits(void) {
    FlownVehicle vehicle;
    AP::oadatabase()->set_limits(90.0f, 0.0f);
    vehicle.fly(6.0);
    CHECK_SAME(90.0f, scripted.database().at(ID).radius);
    AP::oadatabase()->begin(0);
    AP::oadatabase()->set_limits(0.01f, 1.0f);
    vehicle.fly(0.5);
    TEST_ASSERT_TRUE(scripted.database().empty());
}

/* Followed obstacles stay fresh; others age, until the database forgets them. */
static void test_an_obstacle_that_is_given_up_is_left_to_the_database(void) {
    FlownVehicle vehicle;
    vehicle.fly(6.0);
    vehicle.flown.detects = false;
    vehicle.fly(5.0);
    TEST_ASSERT_EQUAL(AP_HAL::millis(),
                      scripted.database().at(ID).timestamp_ms); // not visible for 5 s, and still followed
    vehicle.compares = false;
    vehicle.fly(9.0);
    TEST_ASSERT_EQUAL(0, vehicle.seen().obstacles);
    TEST_ASSERT_LESS_THAN(AP_HAL::millis() - 1000, scripted.database().at(ID).timestamp_ms);
}

/* As the layer does it: the slot's next track is another one, after an eviction or after a time in which the slot was
 * free. */
static void begin_another_track(FlownVehicle &vehicle, bool evicts) {
    goe_flight_t &flight = vehicle.goe->_state->flight;
    if (evicts) {
        flight.counters.evicted++;
    } else {
        flight.slot[0].used = false;
        vehicle.fly(0.2);
        flight.slot[0].used = true;
    }
    flight.slot[0].id += flight.slot[0].id != 0 ? 1 : 0;
}

static void test_an_obstacle_whose_slot_is_taken_is_left_to_the_database(void) {
    for (const uint32_t id : {7u, 0u}) {
        for (const bool evicts : {true, false}) {
            FlownVehicle vehicle;
            vehicle.compares = false;
            vehicle.flown.id = id;
            vehicle.fly(6.0);
            TEST_ASSERT_EQUAL(1, scripted.database().size());
            vehicle.sends = false;
            begin_another_track(vehicle, evicts);
            vehicle.fly(1.2);
            TEST_ASSERT_EQUAL(2, scripted.database().size());
            TEST_ASSERT_LESS_THAN(AP_HAL::millis() - 1000, scripted.database().at(ID).timestamp_ms);
            TEST_ASSERT_EQUAL(AP_HAL::millis(), scripted.database().at(ID + GOE_FLIGHT_SLOTS).timestamp_ms);
        }
    }
}

/* A detector that numbers its obstacle again, or a pose that is lost for a moment, makes no second item. */
static void test_a_track_is_one_item(void) {
    FlownVehicle vehicle;
    vehicle.compares = false;
    vehicle.fly(4.0);
    vehicle.flown.id += 100;
    vehicle.fly(1.0);
    scripted.yaw_reset_ms = AP_HAL::millis();
    vehicle.jump = Vector3f(2e6f, 0.0f, 0.0f); // out of range: such a position is refused
    vehicle.fly(0.3);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_NO_POSE, vehicle.goe->_state->shown.state[0]);
    vehicle.jump = Vector3f();
    vehicle.fly(0.3);
    TEST_ASSERT_EQUAL(107, obstacle_of(vehicle, 0).id);
    TEST_ASSERT_EQUAL(1, scripted.database().size());
    TEST_ASSERT_EQUAL(AP_HAL::millis(), scripted.database().at(ID).timestamp_ms);
}

static void test_the_sphere_is_at_the_own_height_between_foot_and_top(void) {
    FlownVehicle vehicle;
    vehicle.fly(6.0);
    const goe_flight_obstacle_t obstacle = obstacle_of(vehicle, 0);
    const float foot = -obstacle.center_ned_m[2], own = -scripted.position.z, up = scripted.database().at(ID).pos.z;
    TEST_ASSERT_TRUE((obstacle.valid & GOE_HAS_HEIGHT) != 0);
    const float top = foot + obstacle.height_m + 2.0f * obstacle.height_sd_m;
    CHECK_CLOSE(0.3, fminf(fmaxf(own, foot), top), up);
    vehicle.compares = false;
    scripted.vertical_reset_ms = AP_HAL::millis();
    vehicle.flown.detects = false;
    vehicle.jump = Vector3f(0.0f, 0.0f, -500.0f); // far over it
    vehicle.fly(0.4);
    TEST_ASSERT_TRUE(scripted.database().at(ID).pos.z < own + 100.0f);
}

static void test_sigmas_widen_the_sphere(void) {
    FlownVehicle vehicle;
    CHECK_CLOSE(0.0, 2.0, get_parameter(*vehicle.goe, "OA_SIGMA")); // by default
    vehicle.fly(6.0);
    const goe_flight_obstacle_t obstacle = obstacle_of(vehicle, 0);
    const float worst = sqrtf(fmaxf(obstacle.covariance_ne_m2[0], obstacle.covariance_ne_m2[2]));
    TEST_ASSERT_FALSE(obstacle.suspect);
    TEST_ASSERT_TRUE(scripted.database().at(ID).radius >= obstacle.radius_m + 1.99f * worst);
    TEST_ASSERT_TRUE(scripted.database().at(ID).radius <= obstacle.radius_m + 3.0f * worst);
}

static void test_without_a_database_it_flies_on(void) {
    FlownVehicle vehicle;
    scripted.has_database = false;
    vehicle.fly(5.0);
    TEST_ASSERT_EQUAL(1, vehicle.seen().obstacles);
    TEST_ASSERT_TRUE(scripted.database().empty());
}

// --------------------------------------------------------------------------------------------------------------- heights

static float height_of_range_finder(float roll_deg, float range_m, const Vector3f &offset, RangeFinder::Status status) {
    FlownVehicle vehicle;
    vehicle.compares = false;
    vehicle.sends = false;
    vehicle.fly(0.5);
    scripted.has_range_finder = true;
    scripted.range_finder = status;
    scripted.range_m = range_m;
    scripted.range_finder_offset = offset;
    const float half = roll_deg * 3.14159265f / 360.0f;
    scripted.q.q1 = cosf(half);
    scripted.q.q2 = sinf(half);
    scripted.q.q3 = scripted.q.q4 = 0.0f;
    scripted.sample_us += 30000;
    scripted.now_us += 30000;
    vehicle.goe->update();
    const goe_flight_t &flight = vehicle.flight();
    return flight.ground_source == GOE_FLIGHT_RANGE_FINDER ? flight.ground_down_m - scripted.position.z : -1.0f;
}

static void test_a_range_finder_counts_along_the_vertical(void) {
    const RangeFinder::Status good = RangeFinder::Status::Good;
    CHECK_CLOSE(0.001, 20.0, height_of_range_finder(0, 20, Vector3f(), good));
    CHECK_CLOSE(0.001, 17.3205, height_of_range_finder(30, 20, Vector3f(), good));
    CHECK_CLOSE(0.001, 20.4, height_of_range_finder(0, 20, Vector3f(0, 0, 0.4f), good));
    CHECK_CLOSE(0.001, 17.3205 + 0.5,
                height_of_range_finder(30, 20, Vector3f(0, 1, 0), good)); // rolled right: right is low
    CHECK_CLOSE(0.0, -1.0, height_of_range_finder(60, 20, Vector3f(), good));
    CHECK_CLOSE(0.0, -1.0, height_of_range_finder(0, 20, Vector3f(), RangeFinder::Status::OutOfRangeHigh));
}

// ------------------------------------------------------------------------------------------------------------------- log

static void test_the_log(void) {
    FlownVehicle vehicle;
    vehicle.fly(6.0);
    for (const char *name : {"GOEO", "GOEH", "GOEA", "GOES"}) {
        const std::vector<ScriptedRecord> &records = scripted.log[name];
        TEST_ASSERT_FALSE_MESSAGE(records.empty(), name);
        const ScriptedRecord &record = records.back();
        size_t length = 0;
        for (const std::string &label : record.labels) {
            length += label.size() + 1;
        }
        TEST_ASSERT_LESS_OR_EQUAL_MESSAGE(65, length, name);
        TEST_ASSERT_LESS_OR_EQUAL_MESSAGE(16, record.labels.size(), name);
        TEST_ASSERT_EQUAL_MESSAGE(record.labels.size(), record.value.size(), name); // no label twice
        TEST_ASSERT_EQUAL_MESSAGE(record.labels.size(), record.format.size(), name);
        TEST_ASSERT_EQUAL_MESSAGE(record.labels.size(), record.units.size(), name);
        TEST_ASSERT_EQUAL_MESSAGE(record.labels.size(), record.mults.size(), name);
    }
    const goe_flight_obstacle_t obstacle = obstacle_of(vehicle, 0);
    const auto &place = scripted.log["GOEO"].back().value;
    CHECK_CLOSE(0.0, obstacle.center_ned_m[1], place.at("E"));
    CHECK_CLOSE(0.0, obstacle.radius_m, place.at("R"));
    CHECK_CLOSE(0.0, obstacle.covariance_ne_m2[2], place.at("EE"));
    TEST_ASSERT_EQUAL(obstacle.id, place.at("Id"));
    TEST_ASSERT_EQUAL(obstacle.model, place.at("Mdl"));
    const auto &hazard = scripted.log["GOEH"].back().value;
    CHECK_CLOSE(0.0, obstacle.hazard.dcpa_m, hazard.at("DCPA"));
    TEST_ASSERT_EQUAL(0, hazard.at("I"));
    const auto &first = scripted.log["GOEA"].front().value;
    TEST_ASSERT_EQUAL(0, first.at("Ob"));
    TEST_ASSERT_EQUAL(-1, first.at("Wst"));
    const auto &assessment = scripted.log["GOEA"].back().value;
    TEST_ASSERT_EQUAL(0, assessment.at("Wst"));
    TEST_ASSERT_EQUAL(1, assessment.at("Ob"));
    TEST_ASSERT_EQUAL(1, scripted.log["GOEA"][2].value.at("Unp"));  // detected, no range yet
    TEST_ASSERT_EQUAL(0, scripted.log["GOEA"][30].value.at("Unp")); // placed
    TEST_ASSERT_EQUAL(1, assessment.at("Unp"));                     // its box has left the image
    TEST_ASSERT_EQUAL(12, int(assessment.at("Fl")) & 12);
    TEST_ASSERT_INT_WITHIN(2, 60, scripted.log["GOEA"].size()); // also before the first detection
    const auto &status = scripted.log["GOES"].back().value;
    TEST_ASSERT_INT_WITHIN(12, vehicle.flight().counters.taken, status.at("Tkn"));
    TEST_ASSERT_EQUAL(7, status.at("Al"));
    TEST_ASSERT_INT_WITHIN(3, 100, status.at("Dly"));
    TEST_ASSERT_INT_WITHIN(1, 6, scripted.log["GOES"].size());
}

int main(void) {
#if defined(__GLIBC__) && defined(TRAPS_FLOAT_EXCEPTIONS) // as ArduPilot's simulator does
    feenableexcept(FE_OVERFLOW | FE_DIVBYZERO | FE_INVALID);
#endif
    UNITY_BEGIN();
    RUN_TEST(test_it_has_the_state_of_the_layer);
    RUN_TEST(test_an_early_image_waits_for_its_pose);
    RUN_TEST(test_images_of_the_future_block_nobody);
    RUN_TEST(test_a_late_image_is_counted_and_left);
    RUN_TEST(test_the_clock_may_wrap);
    RUN_TEST(test_a_full_table);
    RUN_TEST(test_a_known_jump_moves_the_obstacle_in_the_database);
    RUN_TEST(test_a_reset_of_the_heading_ends_all);
    RUN_TEST(test_another_filter_ends_all);
    RUN_TEST(test_time_jumps);
    RUN_TEST(test_without_a_pose_it_is_not_healthy);
    RUN_TEST(test_what_cannot_be_assessed_ends_no_order);
    RUN_TEST(test_before_the_first_pose_none_contradicts);
    RUN_TEST(test_healthy_means_alive_and_not_that_something_is_there);
    RUN_TEST(test_disabled_it_takes_no_memory_and_keeps_nobody_from_arming);
    RUN_TEST(test_switched_off_it_is_not_healthy_and_keeps_nobody_from_arming);
    RUN_TEST(test_without_memory_it_says_so);
    RUN_TEST(test_without_a_thread_it_says_so);
    RUN_TEST(test_the_scheduler_waits_for_no_estimator);
    RUN_TEST(test_the_layer_knows_that_the_vehicle_lands);
    RUN_TEST(test_a_thread_that_is_late_loses_no_pose_and_no_image);
    RUN_TEST(test_the_threads_may_run_at_once);
    RUN_TEST(test_a_stopped_thread_is_survived);
    RUN_TEST(test_parameters_wait_in_flight_until_nothing_is_followed);
    RUN_TEST(test_on_the_ground_parameters_are_taken_at_once);
    RUN_TEST(test_bad_parameters_are_refused_and_the_good_ones_go_on);
    RUN_TEST(test_without_a_camera_it_names_the_missing_parameter);
    RUN_TEST(test_a_bad_parameter_is_named_as_the_ground_station_shows_it);
    RUN_TEST(test_the_loiter_radius_is_the_vehicles);
    RUN_TEST(test_a_circle_that_cannot_be_flown_is_widened_with_a_word);
    RUN_TEST(test_the_word_about_the_circle_comes_once);
    RUN_TEST(test_parameters_are_searched_for_once);
    RUN_TEST(test_bank_and_climb_are_no_more_than_the_vehicles);
    RUN_TEST(test_defaults_are_those_of_the_library);
    RUN_TEST(test_parameters_fit_into_their_table);
    RUN_TEST(test_only_whole_messages_of_the_own_vehicle_are_taken);
    RUN_TEST(test_sent_messages);
    RUN_TEST(test_an_obstacle_in_the_database);
    RUN_TEST(test_the_ground_station_sees_an_item_twice_a_second);
    RUN_TEST(test_others_items_stay_as_they_are);
    RUN_TEST(test_a_full_database_is_survived);
    RUN_TEST(test_an_obstacle_that_the_database_forgot_comes_back);
    RUN_TEST(test_the_database_keeps_its_limits);
    RUN_TEST(test_an_obstacle_that_is_given_up_is_left_to_the_database);
    RUN_TEST(test_an_obstacle_whose_slot_is_taken_is_left_to_the_database);
    RUN_TEST(test_a_track_is_one_item);
    RUN_TEST(test_the_sphere_is_at_the_own_height_between_foot_and_top);
    RUN_TEST(test_sigmas_widen_the_sphere);
    RUN_TEST(test_without_a_database_it_flies_on);
    RUN_TEST(test_a_range_finder_counts_along_the_vertical);
    RUN_TEST(test_the_log);
    return UNITY_END();
}
