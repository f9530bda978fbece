/* The module of port/px4 with a scripted broker: its result for a flight equals that of the flight layer, to the last bit; and its behavior
 * when topics are late, early, missing or jump. SPDX-License-Identifier: MIT */
#include "px4_flight.hpp"

#include "GoeText.hpp"

static Px4Flight flight;

extern "C" void setUp(void) { flight.begin(); }
extern "C" void tearDown(void) { flight.end(); }

static bool says(const std::string &text, const char *word) { return text.find(word) != std::string::npos; }

static std::string status_text() {
    standin::console().clear();
    TEST_ASSERT_EQUAL(0, goe_command("status"));
    return standin::console();
}

/* --------------------------------------------------------------------------------------------------------- the flight -- */

static void it_is_the_flight_layer_to_the_last_bit() {
    flight.fly(5.0);
    TEST_ASSERT_GREATER_THAN(25, flight.compared);
    goe_obstacle_s topic;
    TEST_ASSERT_TRUE(flight.obstacle(topic));
    TEST_ASSERT_EQUAL_UINT32(7u, topic.id);
    const goe_status_s status = flight.status();
    TEST_ASSERT_EQUAL_HEX8(0, status.self_check); /* by PX4's flags, and the module's own */
    TEST_ASSERT_TRUE(status.settings_in_use);
    TEST_ASSERT_EQUAL(1, status.obstacles);
    CHECK_CLOSE(0.5, 10.0, status.image_rate);
    CHECK_CLOSE(0.5, 104.0, status.delay_mean);
}

static void the_clocks_32_bits_may_wrap_in_flight() {
    flight.end();
    flight.begin(0xFFFFFFFFull - 2500000ull);
    flight.fly(5.0);
    TEST_ASSERT_GREATER_THAN(25, flight.compared);
}

static void statuses_come_ten_times_a_second() {
    flight.fly(3.0);
    const unsigned before = standin::published(ORB_ID(goe_status));
    flight.fly(2.0);
    TEST_ASSERT_INT_WITHIN(1, 20, static_cast<int>(standin::published(ORB_ID(goe_status)) - before));
}

/* ------------------------------------------------------------------------------------------------------- late and early -- */

static void an_image_that_is_too_new_waits_for_its_pose() {
    flight.fly(1.0);
    const uint16_t taken = flight.status().taken;
    flight.follows = flight.sends_images = false;
    flight.publish_image(flight.flown.sample, flight.time_of(flight.flown.sample) + 30000u);
    flight.fly(0.04);
    standin::advance(1000);
    TEST_ASSERT_EQUAL(taken, flight.status().taken);
    flight.fly(0.2);
    TEST_ASSERT_EQUAL(taken + 1, flight.status().taken);
    TEST_ASSERT_EQUAL(0, flight.status().overdue);
}

/* A companion's converted clock may be some milliseconds ahead. */
static void an_image_that_was_sent_in_the_future_waits_too() {
    flight.fly(1.0);
    const uint16_t taken = flight.status().taken;
    flight.follows = flight.sends_images = false;
    goe_features_s topic = flight.features_of(flight.flown.sample);
    topic.timestamp_sample = flight.time_of(flight.flown.sample) + 30000u;
    topic.timestamp = topic.timestamp_sample + 20000u;
    standin::publish(ORB_ID(goe_features), &topic);
    flight.fly(0.3);
    TEST_ASSERT_EQUAL(taken + 1, flight.status().taken);
    TEST_ASSERT_EQUAL(0, flight.status().overdue);
}

static void an_image_that_no_pose_comes_for_is_given_up() {
    flight.fly(1.0);
    const uint16_t taken = flight.status().taken;
    flight.follows = flight.sends_images = flight.sends_pose = false;
    flight.publish_image(0, flight.time_of(flight.flown.sample) + 50000u);
    flight.fly(0.4);
    TEST_ASSERT_EQUAL(0, flight.status().overdue);
    flight.fly(0.4);
    TEST_ASSERT_EQUAL(1, flight.status().overdue);
    TEST_ASSERT_EQUAL(taken, flight.status().taken);
    TEST_ASSERT_FALSE(flight.status().pose_alive);
}

/* Ten images a second, each followed by one with a time ahead of PX4's clock. */
static void fly_with_times_ahead(uint64_t ahead_us, double seconds) {
    for (int i = 0; i < static_cast<int>(10.0 * seconds); i++) {
        const int exposed = flight.flown.sample - FLOWN_DELAY;
        flight.publish_image(exposed, flight.time_of(exposed));
        flight.publish_image(exposed, standin::now_us() + ahead_us);
        flight.fly(0.1);
    }
}

static void an_image_with_a_time_ahead_does_not_delay_the_next_ones() {
    flight.fly(1.0);
    flight.follows = flight.sends_images = false;
    for (const uint64_t ahead_us : {400000u, 2000000u}) {
        const uint16_t taken = flight.status().taken;
        fly_with_times_ahead(ahead_us, 2.0);
        TEST_ASSERT_GREATER_OR_EQUAL(taken + 19, flight.status().taken);
        TEST_ASSERT_EQUAL(0, flight.status().late_images);
        TEST_ASSERT_TRUE(flight.status().delay_max < 150.0f);
    }
}

/* No pose comes for it in time: it takes no place in the queue. */
static void an_exposure_long_after_its_arrival_is_refused_at_once() {
    flight.fly(1.0);
    flight.follows = flight.sends_images = false;
    flight.publish_image(0, standin::now_us() + 600000u);
    flight.fly(0.2);
    TEST_ASSERT_EQUAL(1, flight.status().overdue);
}

static void more_images_than_can_wait_cost_the_oldest() {
    flight.fly(1.0);
    flight.follows = flight.sends_images = flight.sends_pose = false;
    for (int i = 0; i < 11; i++) {
        flight.publish_image(0, flight.time_of(flight.flown.sample) + 50000u + static_cast<uint64_t>(i));
        standin::advance(10000);
    }
    standin::advance(100000);
    TEST_ASSERT_EQUAL(3, flight.status().overdue);
}

static void an_image_that_comes_too_late_is_counted() {
    flight.fly(2.0);
    flight.follows = false;
    flight.publish_image(flight.flown.sample - 25, flight.time_of(flight.flown.sample - 25));
    flight.fly(0.2);
    TEST_ASSERT_EQUAL(1, flight.status().late_images);
}

/* --------------------------------------------------------------------------------------------------------------- resets -- */

static void a_known_jump_keeps_the_track() {
    flight.fly(3.0);
    flight.flown.jump_ned_m[0] = flight.position.delta_xy[0] = 30.f;
    flight.flown.jump_ned_m[1] = flight.position.delta_xy[1] = -20.f;
    flight.position.xy_reset_counter++;
    goe_obstacle_s before;
    goe_obstacle_s after;
    TEST_ASSERT_TRUE(flight.obstacle(before));
    flight.fly(1.0);
    TEST_ASSERT_TRUE(flight.obstacle(after));
    TEST_ASSERT_EQUAL(1, flight.status().resets);
    TEST_ASSERT_EQUAL(0, flight.status().lost);
    CHECK_CLOSE(2.0, 30.0, after.north - before.north);
    CHECK_CLOSE(2.0, -20.0, after.east - before.east);
}

/* ... and the obstacle is kept as suspect, until an image locates it again. */
static void a_missed_reset_ends_the_track() {
    flight.fly(3.0);
    flight.position.z_reset_counter = static_cast<uint8_t>(flight.position.z_reset_counter + 2);
    flight.fly(0.2);
    TEST_ASSERT_EQUAL(1, flight.status().lost);
    TEST_ASSERT_EQUAL(1, flight.status().obstacles);
}

static void a_reset_of_the_heading_ends_the_track() {
    flight.fly(3.0);
    flight.quat_reset_counter++;
    flight.fly(0.2);
    TEST_ASSERT_EQUAL(1, flight.status().lost);
    TEST_ASSERT_EQUAL(1, flight.status().obstacles);
}

static void an_invalid_position_is_no_sample() {
    flight.fly(2.0);
    flight.follows = false;
    flight.sends_pose = false;
    for (int i = 0; i < 40; i++) {
        flight.step();
        flight.position.timestamp_sample = standin::now_us();
        flight.position.xy_valid = false;
        standin::publish(ORB_ID(vehicle_local_position), &flight.position);
    }
    TEST_ASSERT_FALSE(flight.status().pose_alive);
    TEST_ASSERT_EQUAL(0, flight.status().refused);
}

/* Without GPS a fixed wing's filter continues by the airspeed: the samples are valid, and drift. */
static void a_position_by_dead_reckoning_is_reported() {
    flight.fly(2.0);
    TEST_ASSERT_FALSE(flight.status().dead_reckoning);
    TEST_ASSERT_FALSE(says(status_text(), "dead reckoning"));
    flight.position.dead_reckoning = true;
    flight.fly(1.0);
    TEST_ASSERT_TRUE(flight.status().pose_alive);
    TEST_ASSERT_TRUE(flight.status().dead_reckoning);
    TEST_ASSERT_TRUE(says(status_text(), "pose       alive, by dead reckoning, corrected jumps"));
    TEST_ASSERT_TRUE(says(standin::mavlink_texts(), "goe: position by dead reckoning"));
    const std::string so_far = standin::mavlink_texts();
    flight.fly(1.0);
    TEST_ASSERT_TRUE(so_far == standin::mavlink_texts()); /* once */
    for (int i = 0; i < 40; i++) {                        /* it flickers in the first seconds */
        flight.position.dead_reckoning = i % 10 == 0;
        flight.fly(0.1);
        TEST_ASSERT_TRUE(flight.status().dead_reckoning);
    }
    TEST_ASSERT_TRUE(so_far == standin::mavlink_texts());
    flight.position.dead_reckoning = false;
    flight.fly(3.2);
    TEST_ASSERT_FALSE(flight.status().dead_reckoning);
    TEST_ASSERT_TRUE(says(standin::mavlink_texts(), "goe: dead reckoning ends"));
}

/* ------------------------------------------------------------------------------------------------- who is there, who not -- */

static void a_full_table_is_reported() {
    flight.follows = flight.sends_images = false;
    for (int k = 0; k < 150; k++) {
        flight.step();
        if (k % 5 != 0) {
            continue;
        }
        for (int i = 0; i < 6; i++) {
            goe_features_s topic = flight.features_of(flight.flown.sample - 1);
            topic.timestamp_sample = flight.time_of(flight.flown.sample - 1);
            topic.number = 6;
            topic.id = 100u + static_cast<uint32_t>(i);
            topic.sides = goe_features_s::SIDES_ALL;
            topic.box[0] = 150.f * static_cast<float>(i + 1);
            topic.box[2] = topic.box[0] + 40.f;
            standin::publish(ORB_ID(goe_features), &topic);
        }
        standin::settle();
    }
    TEST_ASSERT_GREATER_THAN(0, flight.status().full);
    TEST_ASSERT_EQUAL(0, flight.status().overdue);
}

static void two_obstacles_of_one_image_are_one_image() {
    flight.follows = flight.sends_images = false;
    for (int k = 0; k < 150; k++) {
        flight.step();
        const int exposed = flight.flown.sample - 1 - FLOWN_DELAY;
        for (uint32_t id = 1; k % 5 == 0 && exposed >= 0 && id <= 2; id++) {
            goe_features_s topic = flight.features_of(exposed);
            topic.number = 2;
            topic.id = id;
            standin::publish(ORB_ID(goe_features), &topic);
        }
        standin::settle();
    }
    CHECK_CLOSE(0.5, 10.0, flight.status().image_rate);
    TEST_ASSERT_GREATER_THAN(50, flight.status().taken); /* messages */
}

static void publish_range() {
    distance_sensor_s sensor{};
    sensor.timestamp = standin::now_us();
    sensor.max_distance = 40.f;
    sensor.current_distance = 18.f; /* 20 m, by dist_bottom */
    sensor.signal_quality = 100;
    sensor.orientation = distance_sensor_s::ROTATION_DOWNWARD_FACING;
    standin::publish(ORB_ID(distance_sensor), &sensor, 1);
}

/* With a distance sensor the ground follows its distance, not dist_bottom. */
static void a_distance_sensor_gives_the_ground() {
    goe_obstacle_s by_terrain;
    goe_obstacle_s by_range;
    flight.fly(4.0);
    TEST_ASSERT_TRUE(flight.obstacle(by_terrain));
    flight.end();
    flight.begin();
    flight.follows = false;
    for (int k = 0; k < 200; k++) {
        publish_range();
        flight.step();
    }
    TEST_ASSERT_TRUE(flight.obstacle(by_range));
    CHECK_CLOSE(0.1, -2.0, by_range.ground_down - by_terrain.ground_down);
}

static void a_distance_sensor_that_has_fallen_silent_is_ignored() {
    goe_obstacle_s obstacle;
    flight.fly(4.0);
    TEST_ASSERT_TRUE(flight.obstacle(obstacle));
    const float by_terrain_m = obstacle.ground_down;
    flight.end();
    flight.begin();
    flight.flown.detects = false;
    flight.fly(1.0);
    flight.follows = false;
    publish_range();
    flight.fly(0.5);
    flight.flown.detects = true;
    flight.fly(3.0);
    TEST_ASSERT_TRUE(flight.obstacle(obstacle));
    CHECK_CLOSE(0.1, by_terrain_m, obstacle.ground_down);
}

static unsigned known_sectors() {
    obstacle_distance_s topic{};
    unsigned count = 0;
    TEST_ASSERT_TRUE(standin::latest(ORB_ID(obstacle_distance), 0, &topic));
    for (const uint16_t distance : topic.distances) {
        count += distance != GOE_FLIGHT_SECTOR_UNKNOWN ? 1u : 0u;
    }
    return count;
}

static void a_dead_detector_is_not_clear() {
    flight.flown.detects = false;
    flight.fly(2.0);
    TEST_ASSERT_TRUE(flight.status().detector_alive); /* images without detections */
    TEST_ASSERT_GREATER_THAN(5, known_sectors());
    flight.follows = flight.sends_images = false;
    flight.fly(1.5);
    TEST_ASSERT_FALSE(flight.status().detector_alive);
    TEST_ASSERT_TRUE(flight.status().pose_alive);
    TEST_ASSERT_EQUAL(0, known_sectors());
    TEST_ASSERT_TRUE(says(status_text(), "detector   DEAD"));
    TEST_ASSERT_TRUE(says(standin::console(), "NOT KNOWN, 0 of 4"));
}

/* GIVEN no pose yet THEN the module says that, and not that the velocity contradicts a position. */
static void a_pose_that_has_not_come_contradicts_nothing() {
    flight.follows = flight.sends_pose = false;
    flight.fly(0.5);
    TEST_ASSERT_FALSE(flight.status().pose_alive);
    TEST_ASSERT_EQUAL(-1, flight.status().worst);
    TEST_ASSERT_EQUAL(-1, flight.status().avoided);
    TEST_ASSERT_TRUE(says(status_text(), "pose       DEAD, corrected"));
    TEST_ASSERT_TRUE(says(standin::console(), "NOT KNOWN, 0 of 4"));
}

static void without_an_attitude_the_status_still_comes() {
    flight.fly(1.0);
    flight.follows = flight.sends_images = flight.sends_pose = false;
    const unsigned before = standin::published(ORB_ID(goe_status));
    flight.fly(2.0);
    TEST_ASSERT_INT_WITHIN(1, 20, static_cast<int>(standin::published(ORB_ID(goe_status)) - before));
    TEST_ASSERT_FALSE(flight.status().pose_alive);
    TEST_ASSERT_EQUAL(0, known_sectors());
}

static void a_clock_that_jumps_ends_nothing_for_long() {
    flight.fly(2.0);
    flight.follows = flight.in_step = false;
    standin::set_clock(standin::now_us() - 1500000u); /* back: samples are newer than the clock */
    flight.fly(0.5);
    standin::set_clock(standin::now_us() + 20000000u); /* and ahead: samples are old */
    flight.fly(0.3);
    TEST_ASSERT_FALSE(flight.status().pose_alive);
    flight.end();
    flight.begin(60000000u);
    flight.fly(3.0);
    TEST_ASSERT_EQUAL(1, flight.status().obstacles);
}

static void statuses_go_on_while_the_clock_is_set_back() {
    flight.fly(2.0);
    flight.follows = flight.in_step = false;
    const unsigned before = standin::published(ORB_ID(goe_status));
    standin::set_clock(standin::now_us() - 1500000u);
    flight.fly(0.5);
    TEST_ASSERT_GREATER_THAN(before + 3u, standin::published(ORB_ID(goe_status)));
}

/* The samples' own time goes back, as after a restart of the estimator: after 16 of them the layer restarts, too. */
static void samples_that_go_back_in_time_begin_a_new_history() {
    flight.fly(2.0);
    flight.follows = false;
    flight.flown.sample -= 75;
    flight.in_step = false;
    flight.fly(1.0);
    TEST_ASSERT_GREATER_THAN(0, flight.status().lost);
}

/* ------------------------------------------------------------------------------------------------------------ parameters -- */

static void a_change_in_flight_waits_for_the_end_of_the_tracks() {
    flight.set_mode(true, vehicle_status_s::NAVIGATION_STATE_AUTO_MISSION);
    flight.fly(4.0);
    TEST_ASSERT_EQUAL(1, flight.status().obstacles);
    standin::set("GOE_MARGIN", 40.f);
    flight.fly(1.2); /* the reference continues with the old one */
    TEST_ASSERT_TRUE(flight.status().settings_waiting);
    TEST_ASSERT_EQUAL(1, flight.status().obstacles);
    TEST_ASSERT_TRUE(says(status_text(), "changes wait"));
    flight.follows = false;
    flight.set_mode(false, vehicle_status_s::NAVIGATION_STATE_AUTO_MISSION);
    flight.fly(0.2);
    TEST_ASSERT_FALSE(flight.status().settings_waiting);
    TEST_ASSERT_EQUAL(0, flight.status().obstacles);
}

static void one_that_is_taken_back_waits_for_nothing() {
    flight.set_mode(true, vehicle_status_s::NAVIGATION_STATE_AUTO_MISSION);
    flight.fly(4.0);
    standin::set("GOE_MARGIN", 40.f);
    flight.fly(1.1);
    standin::set("GOE_MARGIN", 15.f);
    flight.fly(1.1);
    TEST_ASSERT_FALSE(flight.status().settings_waiting);
    TEST_ASSERT_EQUAL(0, flight.status().lost);
}

static void what_costs_no_track_takes_effect_at_once() {
    flight.set_mode(true, vehicle_status_s::NAVIGATION_STATE_AUTO_MISSION);
    flight.fly(3.0);
    standin::set("GOE_OUT", 0);
    flight.fly(1.1);
    const unsigned before = standin::published(ORB_ID(obstacle_distance));
    flight.fly(1.0);
    TEST_ASSERT_EQUAL(before, standin::published(ORB_ID(obstacle_distance)));
    TEST_ASSERT_FALSE(flight.status().settings_waiting);
}

static void the_sectors_reach_two_hundred_meters() {
    obstacle_distance_s topic{};
    flight.fly(1.5);
    TEST_ASSERT_TRUE(standin::latest(ORB_ID(obstacle_distance), 0, &topic));
    TEST_ASSERT_EQUAL(20000, topic.max_distance);
}

static void a_loiter_radius_that_is_too_small_is_reported() {
    flight.follows = false;
    standin::set_other("NAV_LOITER_RAD", 60.f);
    standin::set_other("FW_AIRSPD_TRIM", 22.f);
    flight.fly(1.2);
    TEST_ASSERT_TRUE(says(standin::mavlink_texts(), "goe: NAV_LOITER_RAD 60 too small, 85 used"));
    const std::string so_far = standin::mavlink_texts();
    standin::set("GOE_OUT", 0);
    flight.fly(3.0);
    TEST_ASSERT_TRUE(so_far == standin::mavlink_texts()); /* once */
}

static void wings_that_come_later_are_noticed() {
    flight.end();
    flight.has_wings = false;
    flight.begin();
    flight.follows = false;
    standin::set_other("NAV_LOITER_RAD", 60.f);
    standin::set_other("FW_AIRSPD_TRIM", 22.f);
    flight.fly(2.0);
    TEST_ASSERT_FALSE(says(standin::mavlink_texts(), "NAV_LOITER_RAD")); /* a multicopter flies no circle */
    flight.has_wings = true;
    flight.set_mode(false, vehicle_status_s::NAVIGATION_STATE_AUTO_LOITER);
    flight.fly(0.5);
    TEST_ASSERT_TRUE(says(standin::mavlink_texts(), "NAV_LOITER_RAD 60 too small"));
}

/* By the name that the ground station shows. */
static void a_bad_parameter_is_reported_by_its_name() {
    flight.follows = false;
    for (const auto &parameter : px4::standin_parameter) {
        if (parameter.is_int || strcmp(parameter.name, "GOE_LT_DELAY") == 0) {
            continue;
        }
        flight.end();
        flight.begin();
        flight.follows = false;
        const bool is_place =
            strlen(parameter.name) == 9 && strncmp(parameter.name, "GOE_CAM_", 8) == 0 && parameter.name[8] >= 'X';
        standin::set(parameter.name,
                     static_cast<float>((is_place ? 200.0 : 1.5) * parameter.most)); /* the layer accepts 10 km */
        flight.fly(1.2);
        TEST_ASSERT_TRUE_MESSAGE(
            says(standin::mavlink_texts(), (std::string("bad parameter ") + parameter.name).c_str()), parameter.name);
    }
}

static void a_user_sets_fifteen() {
    TEST_ASSERT_EQUAL(15 + 12, px4::standin_parameters); /* and the lens, the camera's mounting, LANDING_TARGET */
}

static void a_bad_parameter_leaves_the_old_ones() {
    flight.fly(1.0);
    flight.follows = false;
    standin::set("GOE_CAM_FX", -1.f);
    flight.fly(1.2);
    TEST_ASSERT_TRUE(flight.status().settings_in_use);
    TEST_ASSERT_TRUE(says(standin::mavlink_texts(), "goe: bad parameter GOE_CAM_FX"));
    TEST_ASSERT_TRUE(says(status_text(), "previous ones in use: GOE_CAM_FX"));
    flight.fly(2.0);
    TEST_ASSERT_EQUAL(1, flight.status().obstacles);
    standin::set("GOE_CAM_FX", flight.flown.scene.camera.fx_px);
    flight.fly(1.2);
    TEST_ASSERT_FALSE(says(status_text(), "previous ones"));
}

static void without_a_camera_nothing_is_done_and_said_so() {
    flight.end();
    flight.begin(5000000u, false);
    flight.fly(1.0);
    TEST_ASSERT_FALSE(flight.status().settings_in_use);
    TEST_ASSERT_FALSE(flight.status().detector_alive);
    TEST_ASSERT_EQUAL(0, known_sectors());
    TEST_ASSERT_TRUE(says(status_text(), "NOT IN USE, the module does nothing: GOE_CAM_"));
}

static void all_parameters_are_marked_as_used() {
    for (const auto &parameter : px4::standin_parameter) {
        TEST_ASSERT_TRUE_MESSAGE(standin::is_used(parameter.name), parameter.name);
    }
}

/* -------------------------------------------------------------------------------------------------------------- commands -- */

static void the_status_is_printed_in_words() {
    flight.fly(4.0);
    const std::string text = status_text();
    TEST_ASSERT_TRUE(says(text, "arithmetic correct, bit-identical to other targets (self-check 0x00)"));
    TEST_ASSERT_TRUE(says(text, "settings   in use"));
    TEST_ASSERT_TRUE(says(text, "detector   alive, 10.0 images/s, 104 ms from exposure to processing"));
    TEST_ASSERT_TRUE(says(text, "obstacles  1 of 4"));
    TEST_ASSERT_TRUE(says(text, "GOE_REACT is 0"));
    TEST_ASSERT_TRUE(says(text, " 0 id 7 "));
    TEST_ASSERT_TRUE(says(text, " %, worst"));
    printf("%s", text.c_str());
}

static std::string line_of(const GoeOverview &overview, unsigned number) {
    char line[GOE_TEXT_LINE];
    return goe_text_status(overview, number, line) ? line : "none";
}

/* 50 m west of an obstacle, 5 m below its top, with a late order. */
static void the_words_are_those_of_the_numbers() {
    GoeOverview overview{};
    goe_obstacle_s &obstacle = overview.obstacle[0];
    overview.obstacles = overview.status.obstacles = 1;
    overview.east_m = 100.f;
    overview.north_m = obstacle.north = obstacle.nearest[0] = 30.f;
    overview.react = 1;
    obstacle.east = 40.f;
    obstacle.nearest[1] = 50.f;
    obstacle.width = obstacle.height = NAN;
    obstacle.dcpa = 3.f;
    obstacle.clearance = -5.f;
    overview.status.action = goe_status_s::ACTION_LEFT;
    overview.status.late = true;
    TEST_ASSERT_EQUAL_STRING("order      left, reported only, LATE, needs 0.0 s", line_of(overview, 5).c_str());
    TEST_ASSERT_TRUE(says(line_of(overview, 7), "50 m at 270 deg"));
    TEST_ASSERT_TRUE(says(line_of(overview, 8), "5 m below its top"));
    TEST_ASSERT_EQUAL_STRING("none", line_of(overview, 9).c_str());
    overview.status.obstacles = 0;
    overview.status.detector_alive = true; /* but no pose */
    TEST_ASSERT_TRUE(says(line_of(overview, 6), "NOT KNOWN"));
    overview.status.pose_alive = true;
    TEST_ASSERT_FALSE(says(line_of(overview, 6), "NOT KNOWN"));
    overview.status.unplaced = 2;
    TEST_ASSERT_TRUE(says(line_of(overview, 6), "NOT KNOWN, 0 of 4, 2 without a position"));
}

static void it_starts_once_and_explains_itself() {
    TEST_ASSERT_NOT_EQUAL(0, goe_command("start"));
    TEST_ASSERT_EQUAL(0, goe_command(""));
    TEST_ASSERT_EQUAL(0, goe_command("dance"));
    TEST_ASSERT_TRUE(says(standin::console(), "unknown command"));
    TEST_ASSERT_TRUE(says(standin::console(), "GOE_CAM_FX"));
}

int main() {
    UNITY_BEGIN();
    RUN_TEST(it_is_the_flight_layer_to_the_last_bit);
    RUN_TEST(the_clocks_32_bits_may_wrap_in_flight);
    RUN_TEST(statuses_come_ten_times_a_second);
    RUN_TEST(an_image_that_is_too_new_waits_for_its_pose);
    RUN_TEST(an_image_that_was_sent_in_the_future_waits_too);
    RUN_TEST(an_image_that_no_pose_comes_for_is_given_up);
    RUN_TEST(an_image_with_a_time_ahead_does_not_delay_the_next_ones);
    RUN_TEST(an_exposure_long_after_its_arrival_is_refused_at_once);
    RUN_TEST(more_images_than_can_wait_cost_the_oldest);
    RUN_TEST(an_image_that_comes_too_late_is_counted);
    RUN_TEST(a_known_jump_keeps_the_track);
    RUN_TEST(a_missed_reset_ends_the_track);
    RUN_TEST(a_reset_of_the_heading_ends_the_track);
    RUN_TEST(an_invalid_position_is_no_sample);
    RUN_TEST(a_position_by_dead_reckoning_is_reported);
    RUN_TEST(a_full_table_is_reported);
    RUN_TEST(two_obstacles_of_one_image_are_one_image);
    RUN_TEST(a_distance_sensor_gives_the_ground);
    RUN_TEST(a_distance_sensor_that_has_fallen_silent_is_ignored);
    RUN_TEST(a_dead_detector_is_not_clear);
    RUN_TEST(a_pose_that_has_not_come_contradicts_nothing);
    RUN_TEST(without_an_attitude_the_status_still_comes);
    RUN_TEST(a_clock_that_jumps_ends_nothing_for_long);
    RUN_TEST(statuses_go_on_while_the_clock_is_set_back);
    RUN_TEST(samples_that_go_back_in_time_begin_a_new_history);
    RUN_TEST(a_change_in_flight_waits_for_the_end_of_the_tracks);
    RUN_TEST(one_that_is_taken_back_waits_for_nothing);
    RUN_TEST(what_costs_no_track_takes_effect_at_once);
    RUN_TEST(the_sectors_reach_two_hundred_meters);
    RUN_TEST(a_loiter_radius_that_is_too_small_is_reported);
    RUN_TEST(wings_that_come_later_are_noticed);
    RUN_TEST(a_bad_parameter_is_reported_by_its_name);
    RUN_TEST(a_user_sets_fifteen);
    RUN_TEST(a_bad_parameter_leaves_the_old_ones);
    RUN_TEST(without_a_camera_nothing_is_done_and_said_so);
    RUN_TEST(all_parameters_are_marked_as_used);
    RUN_TEST(the_status_is_printed_in_words);
    RUN_TEST(the_words_are_those_of_the_numbers);
    RUN_TEST(it_starts_once_and_explains_itself);
    return UNITY_END();
}
