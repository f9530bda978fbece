/* Positions against velocities: wrong conventions, jumps, and flights that agree. SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "flown.h"

#define SPEED_M_S 15.0
#define CLIMB_M_S 2.5
#define TURN_M 60.0 /* radius: 3.75 m/s^2 across */
#define MAX_CM 6000u

static flown_t flown;
static check_random_t any;

void setUp(void) {
    any = check_random_start("flight travel");
    flown_start(&flown, NULL);
}
void tearDown(void) {}

static goe_flight_assessment_t assess(void) {
    goe_flight_assessment_t now;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_assess(&flown.flight, (uint32_t)flown.flight.base_us, 0u, &now));
    return now;
}

/* A climbing turn. */
static goe_flight_position_t sample_at(double s) {
    goe_flight_position_t sample;
    const double angle = SPEED_M_S * s / TURN_M;
    memset(&sample, 0, sizeof sample);
    sample.time_us = (uint32_t)llround(s * 1e6);
    sample.position_ned_m[0] = (float)(TURN_M * sin(angle));
    sample.position_ned_m[1] = (float)(TURN_M * (1.0 - cos(angle)));
    sample.position_ned_m[2] = (float)(-50.0 - CLIMB_M_S * s);
    sample.velocity_ned_m_s[0] = (float)(SPEED_M_S * cos(angle));
    sample.velocity_ned_m_s[1] = (float)(SPEED_M_S * sin(angle));
    sample.velocity_ned_m_s[2] = (float)-CLIMB_M_S;
    return sample;
}

static void give(goe_flight_position_t *sample, uint32_t start_us) {
    goe_flight_attitude_t attitude = {0u, {1.0f, 0.0f, 0.0f, 0.0f}, 0u};
    sample->time_us += start_us;
    attitude.time_us = sample->time_us;
    (void)goe_flight_attitude(&flown.flight, &attitude);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_position(&flown.flight, sample));
}

/* GIVEN samples at 5 to 100 Hz with the noise of small aircraft, past the wrap of the clock THEN they agree throughout. */
static void true_flights_agree(void) {
    static const double rates_hz[] = {5.0, 10.0, 50.0, 100.0};
    for (int r = 0; r < 4; r++) {
        setUp();
        for (int k = 0; k < (int)(60.0 * rates_hz[r]); k++) {
            goe_flight_position_t sample = sample_at(k / rates_hz[r]);
            for (int i = 0; i < 3; i++) {
                sample.position_ned_m[i] += (float)check_random_between(&any, -0.3, 0.3);
                sample.velocity_ned_m_s[i] += (float)check_random_between(&any, -0.5, 0.5);
            }
            give(&sample, 0u - 20000000u);
            TEST_ASSERT_TRUE(assess().pose_agrees && assess().pose_alive);
        }
    }
}

typedef enum {
    ZERO,
    EAST_NORTH,
    UP,
    CENTIMETERS,
    FORWARD,
    STUCK,
    MILLISECONDS,
    DECLINATION,
    WIND,
    HALVED,
    EAST_NORTH_PLACE,
    MISTAKES
} mistake_t;

static void mistake(mistake_t which, goe_flight_position_t *sample) {
    float *v = sample->velocity_ned_m_s;
    float *p = sample->position_ned_m;
    const float swap = which == EAST_NORTH_PLACE ? p[0] : v[0];
    switch (which) {
        case ZERO:
            memset(v, 0, sizeof sample->velocity_ned_m_s);
            break;
        case EAST_NORTH:
            v[0] = v[1];
            v[1] = swap;
            break;
        case UP:
            v[2] = -v[2];
            break;
        case CENTIMETERS:
            for (int i = 0; i < 3; i++) {
                v[i] *= 0.01f;
            }
            break;
        case FORWARD:
            v[0] = (float)SPEED_M_S;
            v[1] = 0.0f;
            break;
        case STUCK:
            memset(p, 0, sizeof sample->position_ned_m);
            break;
        case MILLISECONDS:
            sample->time_us /= 1000u;
            break;
        case DECLINATION: /* 15 degrees */
            v[0] = 0.966f * v[0] - 0.259f * v[1];
            v[1] = 0.966f * v[1] + 0.259f * swap;
            break;
        case WIND: /* through the air */
            v[1] += 5.0f;
            break;
        case HALVED:
            for (int i = 0; i < 3; i++) {
                v[i] *= 0.5f;
            }
            break;
        case EAST_NORTH_PLACE:
        case MISTAKES:
        default:
            p[0] = p[1];
            p[1] = swap;
            break;
    }
}

/* [GOE_FLIGHT_TRAVELS] GIVEN a velocity, a position or a time in a wrong convention, also one that a second does not show, THEN within 12 s of a turn the pose disagrees, and stays so. */
static void wrong_conventions_are_noticed(void) {
    for (int which = 0; which < MISTAKES; which++) {
        setUp();
        for (int k = 0; k < 30 * 50; k++) {
            goe_flight_position_t sample = sample_at(k / 50.0);
            mistake((mistake_t)which, &sample);
            give(&sample, 1000u);
            const goe_flight_assessment_t now = assess();
            TEST_ASSERT_TRUE(now.pose_agrees || !now.pose_alive);
            TEST_ASSERT_TRUE_MESSAGE(k < 12 * 50 || !now.pose_agrees, "a mistake was not noticed");
        }
    }
}

/* One jump that nobody announces: at once, and for 10 s. */
static void a_jump_takes_clear_away_for_ten_seconds(void) {
    for (int axis = 0; axis < 3; axis++) {
        setUp();
        for (int k = 0; k < 25 * 50; k++) {
            goe_flight_position_t sample = sample_at(k / 50.0);
            sample.position_ned_m[axis] += k >= 500 ? 12.0f : 0.0f;
            give(&sample, 1000u);
            TEST_ASSERT_EQUAL(k < 500 || k >= 1000, assess().pose_agrees);
        }
    }
}

/* GIVEN announced jumps THEN they agree, unless the position does not make the jump that it announced. An unknown one is no
 * contradiction. */
static void announced_jumps_agree(void) {
    for (int way = 0; way < 3; way++) {
        setUp();
        for (int k = 0; k < 10 * 50; k++) {
            goe_flight_position_t sample = sample_at(k / 50.0);
            const bool after = k >= 225;
            sample.position_ned_m[1] += after && way != 1 ? 12.0f : 0.0f;
            sample.reset_horizontal = after ? 1u : 0u;
            sample.reset_delta_known = way != 2;
            sample.reset_delta_ned_m[1] = 12.0f;
            give(&sample, 1000u);
            if (way == 2 && k == 225) { /* the history is empty until the next sample */
                continue;
            }
            TEST_ASSERT_EQUAL(!after || way != 1, assess().pose_agrees);
        }
    }
}

/* Between samples too far apart nothing is known of the velocity. */
static void a_gap_is_no_contradiction(void) {
    for (int k = 0; k < 20; k++) {
        goe_flight_position_t sample = sample_at(0.7 * k);
        memset(sample.velocity_ned_m_s, 0, sizeof sample.velocity_ned_m_s);
        give(&sample, 1000u);
        TEST_ASSERT_TRUE(assess().pose_agrees);
    }
}

static int clear_sectors(void) {
    uint16_t sector_cm[GOE_FLIGHT_SECTORS];
    int clear = 0;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_sectors(&flown.flight, MAX_CM, sector_cm));
    for (int i = 0; i < GOE_FLIGHT_SECTORS; i++) {
        clear += sector_cm[i] == MAX_CM + 1u ? 1 : 0;
    }
    return clear;
}

/* GIVEN images that clear sectors WHEN the position jumps THEN none is clear, and the obstacle stays. */
static void a_contradiction_clears_no_sector(void) {
    (void)flown_fly(&flown, 2.5);
    TEST_ASSERT_TRUE(clear_sectors() > 0);
    flown.jump_ned_m[0] = 30.0f; /* without a mark */
    const goe_flight_assessment_t now = flown_fly(&flown, 0.5);
    TEST_ASSERT_FALSE(now.pose_agrees || now.pose_alive);
    TEST_ASSERT_EQUAL(0, clear_sectors());
    TEST_ASSERT_EQUAL(1, now.obstacles);
}

/* A restart knows nothing of the contradiction. */
static void a_restart_begins_anew(void) {
    (void)flown_fly(&flown, 1.0);
    flown.jump_ned_m[1] = 30.0f;
    TEST_ASSERT_FALSE(flown_fly(&flown, 0.5).pose_agrees);
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_restart(&flown.flight));
    TEST_ASSERT_TRUE(flown_fly(&flown, 2.5).pose_agrees);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(true_flights_agree);
    RUN_TEST(wrong_conventions_are_noticed);
    RUN_TEST(a_jump_takes_clear_away_for_ten_seconds);
    RUN_TEST(announced_jumps_agree);
    RUN_TEST(a_gap_is_no_contradiction);
    RUN_TEST(a_contradiction_clears_no_sector);
    RUN_TEST(a_restart_begins_anew);
    return UNITY_END();
}
