/* Positions that are kept after an unknown reset, while no image updates them. SPDX-License-Identifier: MIT
 *
 * A mast of 4 m is ahead, or next to the course. Its boxes come until shortly before the heading's reset, then images are empty. The
 * kept positions must be judged by the present flight, and grow older. */
#include <math.h>
#include <string.h>

#include "goe_flight.h"
#include "unity.h"

#define SPEED_M_S 20.0
#define HEIGHT_M 20.0
#define FOCAL_PX 900.0
#define SAMPLE_S 0.02
#define FRAME_SAMPLES 5
#define TURN_RAD 0.004       /* per sample */
#define START_US 4294000000u /* the clock wraps on the way */

typedef struct {
    double mast_m[2];        /* north, east */
    double reset_s, blind_s; /* boxes come before blind_s */
    double turn_s;           /* from here on the aircraft flies at the mast, or away from it */
    bool away;
} flight_t;

static goe_flight_t layer;
static double north_m, east_m, heading, now_s;
static double valley_m; /* by which the ground below the aircraft is lower than that of the mast */
static goe_flight_assessment_t assessed;

static void start(void) {
    goe_settings_t estimator;
    goe_settings_default(&estimator);
    estimator.camera.fx_px = estimator.camera.fy_px = (float)FOCAL_PX;
    estimator.camera.cx_px = 640.0f;
    estimator.camera.cy_px = 480.0f;
    estimator.camera.width_px = 1280.0f;
    estimator.camera.height_px = 960.0f;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_init(&layer, sizeof layer, &estimator, NULL, NULL));
    north_m = east_m = heading = now_s = valley_m = 0.0;
    memset(&assessed, 0, sizeof assessed);
}

void setUp(void) { start(); }
void tearDown(void) {}

static uint32_t clock_us(double t_s) { return START_US + (uint32_t)lround(1.0e6 * t_s); }

static void sample(const flight_t *flight) {
    const uint8_t reset = now_s >= flight->reset_s;
    const goe_flight_attitude_t attitude = {
        clock_us(now_s), {(float)cos(0.5 * heading), 0.0f, 0.0f, (float)sin(0.5 * heading)}, reset};
    goe_flight_position_t position;
    memset(&position, 0, sizeof position);
    position.time_us = clock_us(now_s);
    position.position_ned_m[0] = (float)north_m;
    position.position_ned_m[1] = (float)east_m;
    position.position_ned_m[2] = (float)-HEIGHT_M;
    position.velocity_ned_m_s[0] = (float)(SPEED_M_S * cos(heading));
    position.velocity_ned_m_s[1] = (float)(SPEED_M_S * sin(heading));
    position.height_m[GOE_FLIGHT_TERRAIN] = (float)(HEIGHT_M + valley_m);
    position.height_valid = 1u << GOE_FLIGHT_TERRAIN;
    (void)goe_flight_attitude(&layer, &attitude);
    (void)goe_flight_position(&layer, &position);
}

static void frame(const flight_t *flight) {
    goe_flight_frame_t image;
    goe_flight_detection_t mast;
    const double ahead = cos(heading) * (flight->mast_m[0] - north_m) + sin(heading) * (flight->mast_m[1] - east_m);
    const double right = cos(heading) * (flight->mast_m[1] - east_m) - sin(heading) * (flight->mast_m[0] - north_m);
    memset(&image, 0, sizeof image);
    memset(&mast, 0, sizeof mast);
    mast.id = 1;
    mast.score = 0.9f;
    mast.box.sides = GOE_SIDES_ALL;
    mast.box.left_px = (float)(640.0 + FOCAL_PX * (right - 2.0) / ahead);
    mast.box.right_px = (float)(640.0 + FOCAL_PX * (right + 2.0) / ahead);
    mast.box.top_px = (float)(480.0 - FOCAL_PX * 20.0 / ahead);
    mast.box.bottom_px = (float)(480.0 + FOCAL_PX * HEIGHT_M / ahead);
    image.arrival_us = image.capture_us = clock_us(now_s);
    image.number = image.count = now_s < flight->blind_s ? 1 : 0;
    image.detection = &mast;
    (void)goe_flight_frame(&layer, &image);
}

/* Until end_s; assesses with each image, if assesses. */
static void fly(const flight_t *flight, double end_s, bool assesses) {
    for (int k = (int)lround(now_s / SAMPLE_S); k * SAMPLE_S < end_s; k++) {
        now_s = k * SAMPLE_S;
        if (now_s >= flight->turn_s) {
            const double at = atan2(flight->mast_m[1] - east_m, flight->mast_m[0] - north_m);
            heading += fmax(-TURN_RAD, fmin(TURN_RAD, (flight->away ? at - 1.5 : at) - heading));
        }
        north_m += SAMPLE_S * SPEED_M_S * cos(heading);
        east_m += SAMPLE_S * SPEED_M_S * sin(heading);
        sample(flight);
        if (k % FRAME_SAMPLES == 0) {
            frame(flight);
            if (assesses) {
                TEST_ASSERT_EQUAL(GOE_FLIGHT_OK,
                                  goe_flight_assess(&layer, clock_us(now_s), GOE_FLIGHT_FLYING, &assessed));
            }
        }
    }
    now_s = end_s;
}

/* GIVEN a mast next to the course and a reset WHEN the aircraft turns at the kept place THEN that is a hazard, with its time. */
static void a_turn_at_a_kept_place_is_warned_of(void) {
    const flight_t flight = {{300.0, 60.0}, 6.0, 5.9, 6.2, false};
    fly(&flight, 5.9, true);
    TEST_ASSERT_TRUE(assessed.worst == 0 && assessed.hazard.conflict_probability < 0.2f);
    fly(&flight, 10.0, true);
    TEST_ASSERT_TRUE(assessed.worst == 0 && assessed.hazard.conflict_probability > 0.8f && assessed.suspect);
    TEST_ASSERT_FLOAT_WITHIN(1.5f, (float)(hypot(300.0 - north_m, 60.0 - east_m) / SPEED_M_S), assessed.hazard.tcpa_s);
}

/* GIVEN a mast ahead and a reset WHEN the aircraft turns away THEN the hazard falls. */
static void a_turn_away_from_a_kept_place_ends_the_hazard(void) {
    const flight_t flight = {{300.0, 0.0}, 6.0, 5.9, 6.2, true};
    fly(&flight, 6.1, true);
    TEST_ASSERT_TRUE(assessed.hazard.conflict_probability > 0.8f);
    fly(&flight, 12.0, true);
    TEST_ASSERT_TRUE(assessed.worst == 0 && assessed.hazard.conflict_probability < 0.2f);
}

/* GIVEN a reset before the first assessment WHEN no other detection comes THEN the kept mast is a hazard, and counts. */
static void a_place_that_was_never_assessed_is_no_clear_sky(void) {
    const flight_t flight = {{300.0, 0.0}, 4.0, 3.9, 1e9, false};
    fly(&flight, 4.2, false);
    fly(&flight, 4.4, true);
    TEST_ASSERT_EQUAL_INT(0, assessed.worst);
    TEST_ASSERT_EQUAL_UINT(1, assessed.obstacles);
    TEST_ASSERT_TRUE(assessed.hazard.conflict_probability > 0.8f);
}

/* GIVEN a kept place THEN its age is the time since it was measured, and its margin grows with that. */
static void a_kept_place_grows_older(void) {
    const flight_t flight = {{400.0, 50.0}, 6.0, 5.9, 1e9, false};
    goe_flight_obstacle_t obstacle;
    float violation = -1.0f;
    fly(&flight, 6.1, true);
    for (double t_s = 7.0; t_s < 16.0; t_s += 1.0) {
        fly(&flight, t_s, true);
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_obstacle(&layer, 0, &obstacle));
        TEST_ASSERT_FLOAT_WITHIN(0.35f, (float)(t_s - 5.8), obstacle.age_s);
        TEST_ASSERT_TRUE(obstacle.suspect && obstacle.hazard.conflict_probability >= violation);
        violation = obstacle.hazard.conflict_probability;
    }
}

/* GIVEN a kept place with a top WHEN the aircraft flies far over it THEN nothing is violated, and the clearance says so. */
static void a_kept_top_far_below_is_passed_over(void) {
    const flight_t flight = {{300.0, 0.0}, 6.0, 5.9, 1e9, false};
    fly(&flight, 6.2, true);
    TEST_ASSERT_TRUE(assessed.hazard.has_clearance && assessed.hazard.clearance_m < 0.0f);
    layer.slot[0].top_m = 1.0f;
    layer.slot[0].top_sd_m = 0.2f;
    fly(&flight, 6.4, true);
    TEST_ASSERT_FLOAT_WITHIN(1.0f, (float)HEIGHT_M - 1.0f, assessed.hazard.clearance_m);
    TEST_ASSERT_TRUE(assessed.hazard.conflict_probability < 0.05f);
}

/* GIVEN a mast whose top is above the aircraft WHEN a reset comes over ground that is lower or higher, and nothing is detected any more THEN the
 * top is as high as before, and so is the hazard. */
static void a_kept_top_does_not_follow_the_ground(void) {
    for (int sign = -1; sign <= 1; sign += 2) {
        const flight_t flight = {{300.0, 0.0}, 6.0, 5.9, 1e9, false};
        goe_flight_obstacle_t before;
        goe_flight_obstacle_t after;
        start();
        fly(&flight, 5.9, true);
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_obstacle(&layer, 0, &before));
        TEST_ASSERT_TRUE((before.valid & GOE_HAS_HEIGHT) != 0u && assessed.hazard.conflict_probability > 0.8f);
        valley_m = 15.0 * sign;
        fly(&flight, 7.0, true);
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_obstacle(&layer, 0, &after));
        TEST_ASSERT_FLOAT_WITHIN(0.01f, before.center_ned_m[2] + (float)valley_m, after.center_ned_m[2]);
        TEST_ASSERT_FLOAT_WITHIN(0.01f, before.center_ned_m[2] - before.height_m,
                                 after.center_ned_m[2] - after.height_m);
        TEST_ASSERT_TRUE(assessed.hazard.conflict_probability > 0.8f);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(a_turn_at_a_kept_place_is_warned_of);
    RUN_TEST(a_turn_away_from_a_kept_place_ends_the_hazard);
    RUN_TEST(a_place_that_was_never_assessed_is_no_clear_sky);
    RUN_TEST(a_kept_place_grows_older);
    RUN_TEST(a_kept_top_far_below_is_passed_over);
    RUN_TEST(a_kept_top_does_not_follow_the_ground);
    return UNITY_END();
}
