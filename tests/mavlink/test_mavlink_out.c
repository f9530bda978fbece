/* From the flight layer's answers to messages: numbers by hand, unknown values, and the interpretation by other programs.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "check.h"
#include "goe_mavlink_map.h"

#define EVERYTHING (GOE_HAS_POSITION | GOE_HAS_HEIGHT | GOE_HAS_WIDTH | GOE_HAS_LENGTH | GOE_HAS_ORIENTATION)
#define UNKNOWN GOE_FLIGHT_SECTOR_UNKNOWN
#define MAX_CM 20000u
#define CLEAR (MAX_CM + 1u)

static goe_flight_obstacle_t obstacle;
static goe_flight_assessment_t assessment;
static goe_mavlink_own_t own;
static uint16_t sector_cm[GOE_FLIGHT_SECTORS];

static void set3(float to[3], float a, float b, float c) {
    to[0] = a;
    to[1] = b;
    to[2] = c;
}

/* A chimney of 6 m by 40 m 200 m north, 30 m west; its foot 12 m above the origin of 100 m. */
void setUp(void) {
    memset(&obstacle, 0, sizeof obstacle);
    memset(&assessment, 0, sizeof assessment);
    memset(&own, 0, sizeof own);
    obstacle.id = 70001u;
    obstacle.valid = EVERYTHING;
    obstacle.model = GOE_MODEL_DISC;
    obstacle.has_hazard = true;
    obstacle.age_s = 0.5f;
    set3(obstacle.center_ned_m, 200.0f, -30.0f, -12.0f);
    set3(obstacle.covariance_ne_m2, 9.0f, 1.0f, 16.0f);
    obstacle.radius_m = 3.0f;
    obstacle.height_m = 40.0f;
    obstacle.height_sd_m = 2.0f;
    obstacle.width_m = 6.0f;
    obstacle.length_m = 5.0f;
    obstacle.length_heading_deg = 45.0f;
    set3(obstacle.nearest_ned_m, 197.0f, -29.5f, -30.0f);
    set3(obstacle.nearest_body_m, 197.0f, -29.0f, 1.0f);
    obstacle.lat_e7 = 475000000;
    obstacle.lon_e7 = 190000000;
    obstacle.hazard.tcpa_s = 10.0f;
    obstacle.hazard.tcpa_sd_s = 1.0f;
    obstacle.hazard.dcpa_m = 4.0f;
    obstacle.hazard.dcpa_sd_m = 2.0f;
    obstacle.hazard.clearance_m = -22.0f;
    obstacle.hazard.clearance_sd_m = 3.0f;
    obstacle.hazard.has_clearance = true;
    obstacle.hazard.conflict_probability = 0.3f;
    assessment.worst = 2;
    assessment.avoided = -1;
    assessment.needed_s = 6.0f;
    own.time_usec = 5000000000123u;
    own.unix_usec = 1700000000000000u;
    own.origin_known = true;
    own.origin_alt_m = 100.0f;
    set3(own.position_ned_m, 0.0f, 0.0f, -30.0f); /* 130 m above sea level */
    for (int i = 0; i < GOE_FLIGHT_SECTORS; i++) {
        sector_cm[i] = CLEAR;
    }
}
void tearDown(void) {}

static void order(goe_flight_action_t action, int slot) {
    assessment.action = action;
    assessment.avoided = (int8_t)slot;
    assessment.late = true;
    set3(assessment.target_ned_m, 300.0f, 60.0f, -30.0f);
    assessment.target_lat_e7 = 475010000;
    assessment.target_lon_e7 = 190020000;
}

static void check_nan(float x) { TEST_ASSERT_FALSE(check_is_finite(x)); }

/* ---------------------------------------------------------------------------------------------------- goe's messages -- */

static void an_obstacle_is_reported_as_it_is(void) {
    goe_mavlink_obstacle_t m;
    obstacle.suspect = obstacle.in_view = true;
    goe_mavlink_to_obstacle(&obstacle, 3, &own, &m);
    TEST_ASSERT_EQUAL_UINT64(own.time_usec, m.time_usec);
    TEST_ASSERT_EQUAL_UINT32(70001u, m.id);
    TEST_ASSERT_EQUAL_INT32(475000000, m.lat);
    TEST_ASSERT_EQUAL_INT32(190000000, m.lon);
    CHECK_SAME(200.0f, m.north);
    CHECK_SAME(-30.0f, m.east);
    CHECK_SAME(-12.0f, m.ground_down);
    TEST_ASSERT_EQUAL_MEMORY(obstacle.covariance_ne_m2, m.covariance, sizeof m.covariance);
    CHECK_SAME(3.0f, m.radius);
    CHECK_SAME(6.0f, m.width);
    CHECK_SAME(5.0f, m.length);
    CHECK_SAME(40.0f, m.height);
    CHECK_SAME(2.0f, m.height_sd);
    CHECK_SAME(45.0f, m.heading);
    TEST_ASSERT_EQUAL_MEMORY(obstacle.nearest_ned_m, m.nearest, sizeof m.nearest);
    CHECK_SAME(0.5f, m.age);
    TEST_ASSERT_EQUAL_UINT8(3u, m.slot);
    TEST_ASSERT_EQUAL_UINT8(GOE_MODEL_DISC, m.model);
    TEST_ASSERT_EQUAL_HEX8(GOE_MAVLINK_SUSPECT | GOE_MAVLINK_IN_VIEW, m.flags);
}

static void what_is_not_known_is_nan(void) {
    goe_mavlink_obstacle_t m;
    obstacle.valid = GOE_HAS_POSITION;
    obstacle.receding = true;
    own.origin_known = false;
    goe_mavlink_to_obstacle(&obstacle, 0, &own, &m);
    CHECK_SAME(200.0f, m.north);
    CHECK_SAME(3.0f, m.radius);
    check_nan(m.width);
    check_nan(m.length);
    check_nan(m.height);
    check_nan(m.height_sd);
    check_nan(m.heading);
    TEST_ASSERT_EQUAL_INT32(INT32_MAX, m.lat);
    TEST_ASSERT_EQUAL_INT32(INT32_MAX, m.lon);
    TEST_ASSERT_EQUAL_HEX8(GOE_MAVLINK_RECEDING, m.flags);
    obstacle.valid = 0u;
    own.origin_known = true;
    goe_mavlink_to_obstacle(&obstacle, 0, &own, &m);
    const float place[] = {m.north,         m.east,          m.ground_down, m.radius,     m.age,       m.covariance[0],
                           m.covariance[1], m.covariance[2], m.nearest[0],  m.nearest[1], m.nearest[2]};
    for (size_t i = 0; i < sizeof place / sizeof place[0]; i++) {
        check_nan(place[i]);
    }
    TEST_ASSERT_EQUAL_INT32(INT32_MAX, m.lat);
}

static void a_hazard_without_an_order_has_no_target(void) {
    goe_mavlink_hazard_t m;
    TEST_ASSERT_TRUE(goe_mavlink_to_hazard(&obstacle, 2, &assessment, &own, &m));
    CHECK_SAME(10.0f, m.tcpa);
    CHECK_SAME(1.0f, m.tcpa_sd);
    CHECK_SAME(4.0f, m.dcpa);
    CHECK_SAME(2.0f, m.dcpa_sd);
    CHECK_SAME(-22.0f, m.clearance);
    CHECK_SAME(3.0f, m.clearance_sd);
    CHECK_SAME(0.3f, m.conflict_probability);
    check_nan(m.needed);
    for (int i = 0; i < 3; i++) {
        check_nan(m.target[i]);
    }
    TEST_ASSERT_EQUAL_INT32(INT32_MAX, m.target_lat);
    TEST_ASSERT_EQUAL_UINT8(GOE_FLIGHT_NONE, m.action);
    TEST_ASSERT_EQUAL_HEX8(GOE_MAVLINK_WORST, m.flags);
    obstacle.hazard.has_clearance = false;
    obstacle.has_hazard = false;
    TEST_ASSERT_FALSE(goe_mavlink_to_hazard(&obstacle, 1, &assessment, &own, &m));
    check_nan(m.clearance);
    check_nan(m.clearance_sd);
    TEST_ASSERT_EQUAL_HEX8(0u, m.flags);
}

static void an_order_is_reported_with_its_obstacle(void) {
    goe_mavlink_hazard_t m;
    order(GOE_FLIGHT_RIGHT, 1);
    TEST_ASSERT_TRUE(goe_mavlink_to_hazard(&obstacle, 1, &assessment, &own, &m));
    TEST_ASSERT_EQUAL_UINT8(GOE_FLIGHT_RIGHT, m.action);
    TEST_ASSERT_EQUAL_HEX8(GOE_MAVLINK_ORDER | GOE_MAVLINK_LATE, m.flags);
    CHECK_SAME(6.0f, m.needed);
    TEST_ASSERT_EQUAL_MEMORY(assessment.target_ned_m, m.target, sizeof m.target);
    TEST_ASSERT_EQUAL_INT32(475010000, m.target_lat);
    TEST_ASSERT_EQUAL_INT32(190020000, m.target_lon);
    TEST_ASSERT_TRUE(goe_mavlink_to_hazard(&obstacle, 2, &assessment, &own, &m)); /* the worst is another one */
    TEST_ASSERT_EQUAL_UINT8(GOE_FLIGHT_NONE, m.action);
    TEST_ASSERT_EQUAL_HEX8(GOE_MAVLINK_WORST, m.flags);
    order(GOE_FLIGHT_HOLD, -1); /* its obstacle was given up */
    own.origin_known = false;
    TEST_ASSERT_TRUE(goe_mavlink_to_hazard(&obstacle, 2, &assessment, &own, &m));
    TEST_ASSERT_EQUAL_UINT8(GOE_FLIGHT_HOLD, m.action);
    TEST_ASSERT_EQUAL_INT32(INT32_MAX, m.target_lat);
    CHECK_SAME(300.0f, m.target[0]);
}

static void the_status_counts(void) {
    const goe_flight_counters_t counters = {1u, 2u, 3u, 4u, 5u, 6u, 7u, 8u, 9u, 10u};
    goe_mavlink_status_t m;
    assessment.obstacles = 4u;
    assessment.unplaced = 2u;
    assessment.action = GOE_FLIGHT_CLIMB;
    assessment.pose_alive = true;
    goe_mavlink_to_status(&counters, &assessment, 0x400u, &own, &m);
    TEST_ASSERT_EQUAL_UINT32(705032704u, m.time_boot_ms); /* 5e9 ms modulo 2^32 */
    TEST_ASSERT_EQUAL_MEMORY(&counters, &m.taken, sizeof counters);
    TEST_ASSERT_EQUAL_UINT16(65535u, m.delay_mean);
    TEST_ASSERT_EQUAL_UINT16(65535u, m.delay_max);
    TEST_ASSERT_EQUAL_UINT8(4u, m.obstacles);
    TEST_ASSERT_EQUAL_UINT8(2u, m.unplaced);
    TEST_ASSERT_EQUAL_UINT8(GOE_FLIGHT_CLIMB, m.action);
    TEST_ASSERT_EQUAL_HEX8(GOE_MAVLINK_POSE_ALIVE, m.alive);
    TEST_ASSERT_EQUAL_UINT8(255u, m.self_check); /* never truncated to "right" */
    assessment.detector_alive = true;
    goe_mavlink_to_status(&counters, &assessment, 0u, &own, &m);
    TEST_ASSERT_EQUAL_HEX8(GOE_MAVLINK_DETECTOR_ALIVE | GOE_MAVLINK_POSE_ALIVE, m.alive);
    TEST_ASSERT_EQUAL_UINT8(0u, m.self_check);
}

/* ------------------------------------------------------------------------------------------------ OBSTACLE_DISTANCE -- */

static goe_mavlink_obstacle_distance_t distances(unsigned increment_deg) {
    goe_mavlink_obstacle_distance_t m;
    TEST_ASSERT_TRUE(goe_mavlink_to_obstacle_distance(sector_cm, MAX_CM, increment_deg, &own, &m));
    TEST_ASSERT_EQUAL_UINT8(increment_deg, m.increment);
    TEST_ASSERT_EQUAL_UINT8(4u, m.sensor_type);
    TEST_ASSERT_EQUAL_UINT8(12u, m.frame);
    TEST_ASSERT_EQUAL_UINT16(0u, m.min_distance);
    TEST_ASSERT_EQUAL_UINT16(MAX_CM, m.max_distance);
    CHECK_SAME(0.0f, m.increment_f);
    return m;
}

static void sectors_of_5_degrees_go_out_as_they_are(void) {
    for (int i = 0; i < GOE_FLIGHT_SECTORS; i++) {
        sector_cm[i] = (uint16_t)(i % 7 == 0 ? UNKNOWN : i % 5 == 0 ? CLEAR : 100u + (unsigned)i);
    }
    const goe_mavlink_obstacle_distance_t m = distances(5u);
    TEST_ASSERT_EQUAL_UINT16_ARRAY(sector_cm, m.distances, GOE_FLIGHT_SECTORS);
    sector_cm[1] = 0u; /* ArduPilot would ignore it */
    TEST_ASSERT_EQUAL_UINT16(1u, distances(5u).distances[1]);
}

/* By angles in floating point: every degree of an element has the distance of the sector that contains it, or a nearer one. */
static void no_obstacle_gets_lost_between_elements(void) {
    check_random_t any = check_random_start("sectors");
    for (unsigned increment = 5; increment <= 180; increment++) {
        goe_mavlink_obstacle_distance_t m;
        for (int i = 0; i < GOE_FLIGHT_SECTORS; i++) {
            const uint32_t die = check_random_bits(&any) % 4u;
            sector_cm[i] = (uint16_t)(die == 0u ? UNKNOWN : die == 1u ? 50u + check_random_bits(&any) % 9000u : CLEAR);
        }
        const bool whole = goe_mavlink_to_obstacle_distance(sector_cm, MAX_CM, increment, &own, &m);
        TEST_ASSERT_EQUAL(360u % increment == 0u, whole);
        for (double deg = 0.25; whole && deg < 360.0; deg += 0.5) {
            const uint16_t sector = sector_cm[(int)floor(deg / 5.0 + 0.5) % GOE_FLIGHT_SECTORS];
            const int element = (int)floor(deg / increment + 0.5) % (int)(360u / increment);
            if (sector == UNKNOWN) {
                TEST_ASSERT_NOT_EQUAL(CLEAR, m.distances[element]);
            } else {
                TEST_ASSERT_TRUE(m.distances[element] <= sector ||
                                 (m.distances[element] == UNKNOWN && sector == CLEAR));
            }
        }
    }
}

static void elements_contain_nothing_of_others(void) {
    sector_cm[9] = 700u; /* 42.5 to 47.5 degrees */
    sector_cm[36] = UNKNOWN;
    const goe_mavlink_obstacle_distance_t m = distances(15u);
    for (int i = 0; i < GOE_FLIGHT_SECTORS; i++) {
        const unsigned expected = i == 3 ? 700u : i == 12 || i >= 24 ? UNKNOWN : CLEAR;
        TEST_ASSERT_EQUAL_UINT16(expected, m.distances[i]);
    }
    TEST_ASSERT_EQUAL_UINT16(700u, distances(10u).distances[4]); /* 35 to 45 */
    TEST_ASSERT_EQUAL_UINT16(700u, distances(10u).distances[5]); /* 45 to 55 */
    TEST_ASSERT_EQUAL_UINT16(CLEAR, distances(10u).distances[3]);
}

/* The element at bearing b is at body angle b - heading = angle_offset + index times increment. */
static void elements_are_turned_into_the_body_frame(void) {
    const float heading_deg[] = {0.0f, 30.0f, 359.0f, -90.0f, 725.0f};
    const double offset_deg[] = {0.0, -30.0, -359.0, -270.0, -5.0};
    for (int i = 0; i < 5; i++) {
        own.heading_deg = heading_deg[i];
        CHECK_CLOSE(1e-3, offset_deg[i], distances(5u).angle_offset);
    }
}

static void input_that_does_not_fit_sectors_is_refused(void) {
    goe_mavlink_obstacle_distance_t m;
    TEST_ASSERT_FALSE(goe_mavlink_to_obstacle_distance(sector_cm, MAX_CM, 0u, &own, &m));
    TEST_ASSERT_FALSE(goe_mavlink_to_obstacle_distance(sector_cm, MAX_CM, 4u, &own, &m));
    TEST_ASSERT_FALSE(goe_mavlink_to_obstacle_distance(sector_cm, MAX_CM, 7u, &own, &m));
    TEST_ASSERT_FALSE(goe_mavlink_to_obstacle_distance(sector_cm, MAX_CM, 360u, &own, &m));
    TEST_ASSERT_FALSE(goe_mavlink_to_obstacle_distance(sector_cm, 0u, 5u, &own, &m));
    TEST_ASSERT_FALSE(goe_mavlink_to_obstacle_distance(sector_cm, 65001u, 5u, &own, &m));
    own.heading_deg = check_from_bits(0x7FC00000u);
    TEST_ASSERT_FALSE(goe_mavlink_to_obstacle_distance(sector_cm, MAX_CM, 5u, &own, &m));
}

/* ------------------------------------------------------------------------------------------ other standard messages -- */

static void the_nearest_point_is_reported_in_the_body_frame(void) {
    goe_mavlink_obstacle_distance_3d_t m;
    TEST_ASSERT_TRUE(goe_mavlink_to_obstacle_distance_3d(&obstacle, 250.0f, &own, &m));
    TEST_ASSERT_EQUAL_UINT32(705032704u, m.time_boot_ms);
    CHECK_SAME(197.0f, m.x);
    CHECK_SAME(-29.0f, m.y);
    CHECK_SAME(1.0f, m.z);
    CHECK_SAME(0.0f, m.min_distance);
    CHECK_SAME(250.0f, m.max_distance);
    TEST_ASSERT_EQUAL_UINT16(70001u - 65535u, m.obstacle_id);
    TEST_ASSERT_EQUAL_UINT8(4u, m.sensor_type);
    TEST_ASSERT_EQUAL_UINT8(12u, m.frame);
    set3(obstacle.nearest_body_m, 0.0f, 0.0f, 0.0f);
    obstacle.id = 0u;
    TEST_ASSERT_TRUE(goe_mavlink_to_obstacle_distance_3d(&obstacle, 250.0f, &own, &m));
    CHECK_SAME(0.01f, m.x);
    TEST_ASSERT_EQUAL_UINT16(65535u, m.obstacle_id);
    obstacle.valid = 0u;
    TEST_ASSERT_FALSE(goe_mavlink_to_obstacle_distance_3d(&obstacle, 250.0f, &own, &m));
}

static void a_collision_threatens_by_its_violation(void) {
    const float violation[] = {0.09f, 0.1f, 0.49f, 0.5f, 1.0f};
    const uint8_t threat[] = {0u, 1u, 1u, 2u, 2u};
    goe_mavlink_collision_t m;
    for (int i = 0; i < 5; i++) {
        obstacle.hazard.conflict_probability = violation[i];
        TEST_ASSERT_TRUE(goe_mavlink_to_collision(&obstacle, 1, &assessment, 0.1f, &m));
        TEST_ASSERT_EQUAL_UINT8(threat[i], m.threat_level);
        TEST_ASSERT_EQUAL_UINT8(1u, m.action);
    }
    TEST_ASSERT_EQUAL_UINT8(1u, m.src);
    TEST_ASSERT_EQUAL_UINT32(70001u, m.id);
    CHECK_SAME(10.0f, m.time_to_minimum_delta);
    CHECK_SAME(4.0f, m.horizontal_minimum_delta);
    CHECK_SAME(0.0f, m.altitude_minimum_delta); /* below the top */
    obstacle.hazard.clearance_m = 8.0f;
    TEST_ASSERT_TRUE(goe_mavlink_to_collision(&obstacle, 1, &assessment, 0.1f, &m));
    CHECK_SAME(8.0f, m.altitude_minimum_delta);
    obstacle.hazard.has_clearance = false;
    TEST_ASSERT_TRUE(goe_mavlink_to_collision(&obstacle, 1, &assessment, 0.1f, &m));
    CHECK_SAME(0.0f, m.altitude_minimum_delta);
    obstacle.has_hazard = false;
    TEST_ASSERT_FALSE(goe_mavlink_to_collision(&obstacle, 1, &assessment, 0.1f, &m));
}

static void a_collision_names_the_action(void) {
    const uint8_t expected[] = {1u, 3u, 3u, 2u, 2u, 6u};
    goe_mavlink_collision_t m;
    obstacle.hazard.conflict_probability = 0.2f;
    for (int action = GOE_FLIGHT_NONE; action <= GOE_FLIGHT_HOLD; action++) {
        order((goe_flight_action_t)action, 1);
        TEST_ASSERT_TRUE(goe_mavlink_to_collision(&obstacle, 1, &assessment, 0.1f, &m));
        TEST_ASSERT_EQUAL_UINT8(expected[action], m.action);
        TEST_ASSERT_EQUAL_UINT8(action ? 2u : 1u, m.threat_level); /* late */
        TEST_ASSERT_TRUE(goe_mavlink_to_collision(&obstacle, 2, &assessment, 0.1f, &m));
        TEST_ASSERT_EQUAL_UINT8(1u, m.action); /* about another one */
        TEST_ASSERT_EQUAL_UINT8(1u, m.threat_level);
    }
}

static void a_target_is_the_middle_of_the_base(void) {
    goe_mavlink_target_absolute_t m;
    TEST_ASSERT_TRUE(goe_mavlink_to_target_absolute(&obstacle, 2, &own, &m));
    TEST_ASSERT_EQUAL_UINT64(own.unix_usec, m.timestamp);
    TEST_ASSERT_EQUAL_INT32(475000000, m.lat);
    TEST_ASSERT_EQUAL_INT32(190000000, m.lon);
    CHECK_SAME(112.0f, m.alt);
    CHECK_SAME(5.0f, m.position_std[0]);
    check_nan(m.position_std[1]);
    CHECK_SAME(0.0f, m.vel[0]);
    TEST_ASSERT_EQUAL_UINT8(2u, m.id);
    TEST_ASSERT_EQUAL_UINT8(1u, m.sensor_capabilities);
    own.unix_usec = 0u;
    TEST_ASSERT_FALSE(goe_mavlink_to_target_absolute(&obstacle, 2, &own, &m));
    own.unix_usec = 1u;
    own.origin_known = false;
    TEST_ASSERT_FALSE(goe_mavlink_to_target_absolute(&obstacle, 2, &own, &m));
    own.origin_known = true;
    obstacle.valid = 0u;
    TEST_ASSERT_FALSE(goe_mavlink_to_target_absolute(&obstacle, 2, &own, &m));
}

static void traffic_lies_just_below_the_aircraft_or_at_the_top(void) {
    const float own_down_m[] = {-30.0f, -52.5f, -53.5f, -80.0f}; /* the top is at 52 m above the origin */
    const int32_t altitude_mm[] = {129000, 151500, 152000, 152000};
    goe_mavlink_adsb_vehicle_t m;
    for (int i = 0; i < 4; i++) {
        own.position_ned_m[2] = own_down_m[i];
        TEST_ASSERT_TRUE(goe_mavlink_to_adsb_vehicle(&obstacle, 1, 0xFFFFFFu, &own, &m));
        TEST_ASSERT_EQUAL_INT32(altitude_mm[i], m.altitude);
    }
    TEST_ASSERT_EQUAL_HEX32(0u, m.icao_address); /* 24 bits */
    TEST_ASSERT_EQUAL_INT32(475000000, m.lat);
    TEST_ASSERT_EQUAL_INT32(190000000, m.lon);
    TEST_ASSERT_EQUAL_STRING("GOE2", m.callsign);
    TEST_ASSERT_EQUAL_HEX16(0x9Fu, m.flags);
    TEST_ASSERT_EQUAL_UINT8(1u, m.altitude_type);
    TEST_ASSERT_EQUAL_UINT8(19u, m.emitter_type);
    TEST_ASSERT_EQUAL_UINT8(0u, m.tslc);
    TEST_ASSERT_EQUAL_UINT16(0u, m.hor_velocity);
    obstacle.valid = GOE_HAS_POSITION; /* the top is not known */
    TEST_ASSERT_TRUE(goe_mavlink_to_adsb_vehicle(&obstacle, 15, 0u, &own, &m));
    TEST_ASSERT_EQUAL_INT32(179000, m.altitude);
    TEST_ASSERT_EQUAL_STRING("GOE16", m.callsign);
    own.origin_alt_m = 3.0e6f;
    TEST_ASSERT_FALSE(goe_mavlink_to_adsb_vehicle(&obstacle, 1, 0u, &own, &m));
    own.origin_alt_m = check_from_bits(0x7FC00000u);
    TEST_ASSERT_FALSE(goe_mavlink_to_adsb_vehicle(&obstacle, 1, 0u, &own, &m));
    own.origin_alt_m = 100.0f;
    own.origin_known = false;
    TEST_ASSERT_FALSE(goe_mavlink_to_adsb_vehicle(&obstacle, 1, 0u, &own, &m));
    own.origin_known = true;
    obstacle.valid = 0u;
    TEST_ASSERT_FALSE(goe_mavlink_to_adsb_vehicle(&obstacle, 1, 0u, &own, &m));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(an_obstacle_is_reported_as_it_is);
    RUN_TEST(what_is_not_known_is_nan);
    RUN_TEST(a_hazard_without_an_order_has_no_target);
    RUN_TEST(an_order_is_reported_with_its_obstacle);
    RUN_TEST(the_status_counts);
    RUN_TEST(sectors_of_5_degrees_go_out_as_they_are);
    RUN_TEST(no_obstacle_gets_lost_between_elements);
    RUN_TEST(elements_contain_nothing_of_others);
    RUN_TEST(elements_are_turned_into_the_body_frame);
    RUN_TEST(input_that_does_not_fit_sectors_is_refused);
    RUN_TEST(the_nearest_point_is_reported_in_the_body_frame);
    RUN_TEST(a_collision_threatens_by_its_violation);
    RUN_TEST(a_collision_names_the_action);
    RUN_TEST(a_target_is_the_middle_of_the_base);
    RUN_TEST(traffic_lies_just_below_the_aircraft_or_at_the_top);
    return UNITY_END();
}
