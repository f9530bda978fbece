/* Doubt about the aircraft's position, and the margins that follow from it. SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "check.h"
#include "health.h"
#include "margins.h"

#define STEP_US 500000
#define GOOD (ESTIMATOR_ATTITUDE | ESTIMATOR_VELOCITY_HORIZ | ESTIMATOR_VELOCITY_VERT | ESTIMATOR_POS_HORIZ_ABS)

static health_t health;
static int64_t now_us;
static mavlink_estimator_status_t estimator;
static mavlink_ekf_status_report_t ekf;
static uint8_t fix;
static bool gps_comes;

void setUp(void) {
    (void)memset(&health, 0, sizeof health);
    (void)memset(&estimator, 0, sizeof estimator);
    (void)memset(&ekf, 0, sizeof ekf);
    now_us = 1000000;
    estimator.flags = ekf.flags = GOOD;
    estimator.hagl_ratio = 9.0f; /* not checked */
    fix = GPS_FIX_TYPE_3D_FIX;
    gps_comes = true;
}
void tearDown(void) {}

/* Sends messages for so many half seconds, PX4's or ArduPilot's. */
static void go_on(int steps, bool px4) {
    for (int k = 0; k < steps; k++) {
        mavlink_message_t message;
        now_us += STEP_US;
        if (gps_comes) {
            (void)mavlink_msg_gps_raw_int_pack(1, 1, &message, 0, fix, 0, 0, 0, 0, 0, 0, 0, 9, 0, 0, 0, 0, 0, 0);
            health_take(&health, &message, now_us);
        }
        if (px4) {
            (void)mavlink_msg_estimator_status_encode(1, 1, &message, &estimator);
        } else {
            (void)mavlink_msg_ekf_status_report_encode(1, 1, &message, &ekf);
        }
        health_take(&health, &message, now_us);
        (void)health_judge(&health, now_us);
    }
}

static void a_healthy_autopilot_is_not_doubted(void) {
    go_on(20, true);
    go_on(20, false);
    TEST_ASSERT_EQUAL_HEX32(0, health.doubts);
    TEST_ASSERT_EQUAL_STRING("good", health_text(0));
}

static void a_lost_fix_is_a_doubt_until_it_is_back_for_a_while(void) {
    go_on(4, true);
    fix = GPS_FIX_TYPE_2D_FIX;
    go_on(2, true);
    TEST_ASSERT_EQUAL_HEX32(0, health.doubts); /* for a moment */
    go_on(1, true);
    TEST_ASSERT_EQUAL_HEX32(HEALTH_NO_FIX, health.doubts);
    fix = GPS_FIX_TYPE_RTK_FIXED;
    go_on(9, true);
    TEST_ASSERT_EQUAL_HEX32(HEALTH_NO_FIX, health.doubts);
    go_on(1, true);
    TEST_ASSERT_EQUAL_HEX32(0, health.doubts);
}

static void faults_of_moments_make_no_doubt(void) {
    go_on(4, true);
    for (int k = 0; k < 10; k++) {
        fix = GPS_FIX_TYPE_NO_FIX;
        go_on(1, true);
        fix = GPS_FIX_TYPE_3D_FIX;
        go_on(1, true);
    }
    TEST_ASSERT_EQUAL_HEX32(0, health.doubts);
}

/* As indoors, where another system measures the position. */
static void who_never_had_a_fix_has_lost_none(void) {
    fix = GPS_FIX_TYPE_NO_GPS;
    go_on(20, true);
    TEST_ASSERT_EQUAL_HEX32(0, health.doubts);
}

static void gps_that_ceases_is_a_doubt(void) {
    go_on(4, true);
    gps_comes = false;
    go_on(6, true);
    TEST_ASSERT_EQUAL_HEX32(0, health.faults);
    go_on(4, true);
    TEST_ASSERT_EQUAL_HEX32(HEALTH_GPS_SILENT, health.doubts);
}

static unsigned doubts_of(bool px4) {
    (void)memset(&health, 0, sizeof health);
    go_on(6, px4);
    return health.doubts;
}

static void each_flag_of_the_filter_counts(void) {
    static const uint16_t needed[] = {ESTIMATOR_ATTITUDE, ESTIMATOR_VELOCITY_HORIZ, ESTIMATOR_POS_HORIZ_ABS};
    for (size_t i = 0; i < 3; i++) {
        estimator.flags = ekf.flags = (uint16_t)(GOOD & ~needed[i]);
        TEST_ASSERT_EQUAL_HEX32(HEALTH_FILTER, doubts_of(true));
        TEST_ASSERT_EQUAL_HEX32(HEALTH_FILTER, doubts_of(false));
    }
    estimator.flags = ekf.flags = (uint16_t)((GOOD & ~ESTIMATOR_POS_HORIZ_ABS) | ESTIMATOR_POS_HORIZ_REL);
    TEST_ASSERT_EQUAL_HEX32(0, doubts_of(true) | doubts_of(false));
    estimator.flags = ekf.flags = GOOD | ESTIMATOR_CONST_POS_MODE;
    TEST_ASSERT_EQUAL_HEX32(HEALTH_FILTER, doubts_of(true));
    TEST_ASSERT_EQUAL_HEX32(HEALTH_FILTER, doubts_of(false));
}

/* The same bits have other meanings for each make. */
static void what_each_make_has_of_its_own(void) {
    estimator.flags = GOOD | ESTIMATOR_GPS_GLITCH;
    TEST_ASSERT_EQUAL_HEX32(HEALTH_GLITCH, doubts_of(true));
    estimator.flags = GOOD | ESTIMATOR_ACCEL_ERROR;
    TEST_ASSERT_EQUAL_HEX32(HEALTH_FILTER, doubts_of(true));
    ekf.flags = GOOD | 1024; /* never was healthy */
    TEST_ASSERT_EQUAL_HEX32(HEALTH_FILTER, doubts_of(false));
    ekf.flags = GOOD | 32768;
    TEST_ASSERT_EQUAL_HEX32(HEALTH_GLITCH, doubts_of(false));
}

/* One of four measurements, the others 0: as a test ratio of PX4 and as a variance of ArduPilot. */
static void measure(int which, float off) {
    const float value[4] = {which == 0 ? off : 0.0f, which == 1 ? off : 0.0f, which == 2 ? off : 0.0f,
                            which == 3 ? off : 0.0f};
    estimator.vel_ratio = ekf.velocity_variance = value[0];
    estimator.pos_horiz_ratio = ekf.pos_horiz_variance = value[1];
    estimator.pos_vert_ratio = ekf.pos_vert_variance = value[2];
    estimator.mag_ratio = ekf.compass_variance = value[3];
}

static void measurements_far_off_are_a_doubt(void) {
    for (int i = 0; i < 4; i++) {
        measure(i, 1.1f);
        TEST_ASSERT_EQUAL_HEX32(HEALTH_OFF, doubts_of(true));
        TEST_ASSERT_EQUAL_HEX32(HEALTH_OFF, doubts_of(false));
        measure(i, 0.9f);
        TEST_ASSERT_EQUAL_HEX32(0, doubts_of(true));
        TEST_ASSERT_EQUAL_HEX32(HEALTH_OFF, doubts_of(false));
        measure(i, 0.7f);
        TEST_ASSERT_EQUAL_HEX32(0, doubts_of(false));
        measure(i, NAN); /* not measured */
        TEST_ASSERT_EQUAL_HEX32(0, doubts_of(true) | doubts_of(false));
    }
}

static void the_gravest_fault_is_named_first(void) {
    TEST_ASSERT_EQUAL_STRING("GPS fix lost", health_text(0x1Fu));
    TEST_ASSERT_EQUAL_STRING("GPS is silent", health_text(0x1Eu));
    TEST_ASSERT_EQUAL_STRING("filter is not good", health_text(0x1Cu));
    TEST_ASSERT_EQUAL_STRING("filter takes GPS for faulty", health_text(0x18u));
    TEST_ASSERT_EQUAL_STRING("filter is far off its sensors", health_text(0x10u));
}

/* A new run of the autopilot has its own faults; the doubt of the last run ends as usual. */
static void a_restart_of_the_autopilot_ends_its_faults(void) {
    go_on(4, true);
    fix = GPS_FIX_TYPE_NO_FIX;
    go_on(4, true);
    TEST_ASSERT_EQUAL_HEX32(HEALTH_NO_FIX, health.doubts);
    health_restart(&health);
    gps_comes = false;
    go_on(9, true);
    TEST_ASSERT_EQUAL_HEX32(HEALTH_NO_FIX, health.doubts);
    go_on(3, true);
    TEST_ASSERT_EQUAL_HEX32(0, health.doubts);
}

/* ---------------------------------------------------------------------------------------------------------- margins -- */

static void margins_follow_the_doubt_and_nothing_else_changes(void) {
    static goe_flight_t flight, before;
    static companion_config_t config;
    goe_settings_default(&config.estimator);
    goe_flight_settings_default(&config.flight);
    config.estimator.camera.fx_px = config.estimator.camera.fy_px = 900.0f;
    config.estimator.camera.cx_px = config.estimator.camera.cy_px = 0.0f;
    config.estimator.camera.width_px = config.estimator.camera.height_px = 1000.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_init(&flight, sizeof flight, &config.estimator, &config.flight, NULL));
    const goe_flight_attitude_t attitude = {5000000, {1.0f, 0.0f, 0.0f, 0.0f}, 0};
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_attitude(&flight, &attitude));
    flight.slot[1].used = true;
    before = flight;
    TEST_ASSERT_TRUE(margins_set(&flight, &config, true));
    CHECK_SAME(1.5f * config.flight.margin_m, flight.settings.margin_m);
    CHECK_SAME(1.5f * config.flight.clearance_m, flight.settings.clearance_m);
    TEST_ASSERT_EQUAL_MEMORY(&before.history, &flight.history, sizeof flight - offsetof(goe_flight_t, history));
    goe_flight_assessment_t assessment;
    TEST_ASSERT_NOT_EQUAL(GOE_FLIGHT_CORRUPTED, goe_flight_assess(&flight, 5000000, false, &assessment)); /* sealed */
    flight = before;
    TEST_ASSERT_TRUE(margins_set(&flight, &config, false));
    TEST_ASSERT_EQUAL_MEMORY(&before, &flight, sizeof flight);
    config.flight.margin_m = 900.0f;
    TEST_ASSERT_TRUE(margins_set(&flight, &config, true));
    CHECK_SAME(1000.0f, flight.settings.margin_m);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(a_healthy_autopilot_is_not_doubted);
    RUN_TEST(a_lost_fix_is_a_doubt_until_it_is_back_for_a_while);
    RUN_TEST(faults_of_moments_make_no_doubt);
    RUN_TEST(who_never_had_a_fix_has_lost_none);
    RUN_TEST(gps_that_ceases_is_a_doubt);
    RUN_TEST(each_flag_of_the_filter_counts);
    RUN_TEST(what_each_make_has_of_its_own);
    RUN_TEST(measurements_far_off_are_a_doubt);
    RUN_TEST(the_gravest_fault_is_named_first);
    RUN_TEST(a_restart_of_the_autopilot_ends_its_faults);
    RUN_TEST(margins_follow_the_doubt_and_nothing_else_changes);
    return UNITY_END();
}
