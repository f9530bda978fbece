/* Jumps of the position that no reset announces. SPDX-License-Identifier: MIT
 *
 * The aircraft turns at 20 m/s. Its positions come as a position filter gives them: with steps, ramps, holds, noise and wrong velocities. */
#include <math.h>
#include <string.h>

#include "flown.h"
#include "goe_slip.h"

#define SPEED_M_S 20.0
#define TURN_RAD_S 0.3
#define STEP_S 0.05
#define STEPS 400
#define PI 3.14159265358979

static check_random_t any;
static goe_flight_slip_t slip;
static double jumped_m[3]; /* sum of the jumps found */
static double most_m;      /* the largest sum on the way */
static int jumps;

/* What the autopilot gives at a time, besides the turn. */
typedef struct {
    double step_m[3]; /* of the positions, from `from_s` on, within `ramp_s`, back at `to_s` */
    double from_s, ramp_s, to_s;
    double hold_s;           /* positions are held for so long */
    double noise_m;          /* of the positions, white */
    double off_m_s, since_s; /* error of the velocity to the east, and from when on */
} flight_t;

static double part(const flight_t *f, double t_s) {
    const double up = f->ramp_s > 0.0 ? (t_s - f->from_s) / f->ramp_s : (t_s >= f->from_s ? 1.0 : 0.0);
    const double down = f->ramp_s > 0.0 ? (t_s - f->to_s) / f->ramp_s : (t_s >= f->to_s ? 1.0 : 0.0);
    return fmin(fmax(up, 0.0), 1.0) - (f->to_s > 0.0 ? fmin(fmax(down, 0.0), 1.0) : 0.0);
}

static void sample_at(const flight_t *f, double t_s, goe_flight_position_t *sample) {
    const double held_s = f->hold_s > 0.0 ? f->hold_s * floor(t_s / f->hold_s + 1e-9) : t_s;
    const double radius_m = SPEED_M_S / TURN_RAD_S;
    const double place_m[3] = {radius_m * sin(TURN_RAD_S * held_s), radius_m * (1.0 - cos(TURN_RAD_S * held_s)),
                               -50.0 + held_s};
    const double way_m_s[3] = {SPEED_M_S * cos(TURN_RAD_S * t_s), SPEED_M_S * sin(TURN_RAD_S * t_s), 1.0};
    memset(sample, 0, sizeof *sample);
    sample->time_us = (uint32_t)lround(1e6 * t_s);
    for (int i = 0; i < 3; i++) {
        const double noise_m = f->noise_m > 0.0 ? f->noise_m * check_random_normal(&any) : 0.0;
        sample->position_ned_m[i] = (float)(place_m[i] + part(f, t_s) * f->step_m[i] + noise_m);
        sample->velocity_ned_m_s[i] = (float)(way_m_s[i] + (i == 1 && t_s >= f->since_s ? f->off_m_s : 0.0));
    }
}

static void fly(const flight_t *f) {
    goe_flight_position_t before;
    memset(jumped_m, 0, sizeof jumped_m);
    most_m = 0.0;
    jumps = 0;
    goe_flight_slip_clear(&slip);
    sample_at(f, 0.0, &before);
    for (int k = 1; k < STEPS; k++) {
        goe_flight_position_t now;
        float off_m[3];
        float jump_m[3];
        sample_at(f, STEP_S * k, &now);
        goe_flight_history_position_t newest;
        newest.time_us = before.time_us;
        memcpy(newest.ned_m, before.position_ned_m, sizeof newest.ned_m);
        goe_flight_slip_between(&newest, before.velocity_ned_m_s, now.velocity_ned_m_s, &now, off_m);
        if (goe_flight_slip_jumped(&slip, off_m, (float)STEP_S, jump_m)) {
            jumps++;
            for (int i = 0; i < 3; i++) {
                jumped_m[i] += (double)jump_m[i];
            }
        }
        most_m = fmax(most_m, hypot(hypot(jumped_m[0], jumped_m[1]), jumped_m[2]));
        before = now;
    }
}

void setUp(void) { any = check_random_start("flight slip"); }
void tearDown(void) {}

static void a_calm_flight_does_not_jump(void) {
    const flight_t calm = {0};
    fly(&calm);
    TEST_ASSERT_EQUAL(0, jumps);
}

/* [F6] GIVEN a step of the positions, at once or within a second, in any direction THEN the jumps found add up to it. */
static void the_jumps_add_up_to_the_step(void) {
    const double sizes_m[] = {3.0, 5.0, 20.0, 200.0};
    for (int size = 0; size < 4; size++) {
        for (int ramp = 0; ramp < 3; ramp++) {
            for (int way = 0; way < 5; way++) {
                flight_t f = {0};
                f.step_m[way < 4 ? 0 : 2] = sizes_m[size] * (way < 4 ? cos(0.5 * PI * way + 0.3) : 1.0);
                f.step_m[1] = way < 4 ? sizes_m[size] * sin(0.5 * PI * way + 0.3) : 0.0;
                f.from_s = 4.0;
                f.ramp_s = 0.4 * ramp;
                fly(&f);
                for (int i = 0; i < 3; i++) {
                    CHECK_CLOSE(1.0 + 0.01 * sizes_m[size], f.step_m[i], jumped_m[i]);
                }
            }
        }
    }
}

/* [F6] A wrong position that lasts for 0.3 to 3 s: there and back adds up to nothing. */
static void there_and_back_is_nothing(void) {
    for (int k = 0; k < 10; k++) {
        flight_t f = {0};
        f.step_m[k % 3] = k % 2 != 0 ? 30.0 : -8.0;
        f.from_s = 5.0;
        f.ramp_s = 0.1 * k;
        f.to_s = 5.0 + 0.3 * (k + 1);
        fly(&f);
        TEST_ASSERT_TRUE(jumps > 1);
        for (int i = 0; i < 3; i++) {
            CHECK_CLOSE(1.0, 0.0, jumped_m[i]);
        }
    }
}

/* [F7] GIVEN a velocity that does not agree with the positions: of another frame, always 0, held or noisy positions THEN nothing jumps:
 * the positions count. */
static void a_velocity_that_never_agreed_says_nothing(void) {
    const flight_t flights[] = {{.off_m_s = 3.0},
                                {.off_m_s = -30.0, .step_m = {50.0, 0.0, 0.0}, .from_s = 5.0},
                                {.hold_s = 0.2},
                                {.hold_s = 1.0},
                                {.noise_m = 1.0}};
    for (size_t k = 0; k < sizeof flights / sizeof flights[0]; k++) {
        fly(&flights[k]);
        TEST_ASSERT_EQUAL(0, jumps);
    }
}

/* [F7] A velocity that goes wrong in flight, by 5 m/s, counts for three seconds at most. */
static void a_velocity_that_goes_wrong_counts_for_seconds(void) {
    const flight_t f = {.off_m_s = 5.0, .since_s = 6.0};
    fly(&f);
    check_report("moved by a wrong velocity, m", most_m);
    TEST_ASSERT_TRUE(most_m > 5.0 && most_m < 5.0 * 3.5);
}

/* The velocity has to agree for a second first, and again after a gap of the samples or a flipped bit. */
static void nothing_jumps_before_the_velocity_has_agreed(void) {
    flight_t f = {.step_m = {20.0, 0.0, 0.0}, .from_s = 0.8};
    fly(&f);
    TEST_ASSERT_EQUAL(0, jumps);
    f.from_s = 1.5;
    fly(&f);
    TEST_ASSERT_EQUAL(1, jumps);
    const float still_m[3] = {0.0f, 0.0f, 0.0f};
    const float jump_m[3] = {20.0f, 0.0f, 0.0f};
    float found_m[3];
    for (int k = 0; k < 3; k++) {
        goe_flight_slip_clear(&slip);
        for (int i = 0; i < 40; i++) {
            TEST_ASSERT_FALSE(goe_flight_slip_jumped(&slip, still_m, 0.05f, found_m));
        }
        if (k == 1) {
            TEST_ASSERT_FALSE(goe_flight_slip_jumped(&slip, still_m, 1.01f, found_m));
        } else if (k == 2) {
            slip.ned_m[1] = (float)NAN;
            TEST_ASSERT_FALSE(goe_flight_slip_jumped(&slip, still_m, 0.05f, found_m));
        }
        TEST_ASSERT_EQUAL(k == 0, goe_flight_slip_jumped(&slip, jump_m, 0.05f, found_m));
    }
}

/* [F6] GIVEN a track WHEN the positions jump by 30 m without a reset, and back a second later THEN place and hazard are those of the flight
 * without jumps, also between the images. */
static void a_track_does_not_feel_a_jump(void) {
    static flown_t flown;
    static flown_t other;
    flown_start(&flown, NULL);
    flown.scene.width_m = flown.scene.length_m = 4.0;
    flown.scene.height_m = 12.0;
    other = flown;
    (void)flown_fly(&flown, 2.5);
    (void)flown_fly(&other, 2.5);
    for (int k = 0; k < 2; k++) {
        const double off_m = k == 0 ? 30.0 : 0.0;
        flown.jump_ned_m[1] = (float)off_m; /* the marks stay as they are */
        flown.jump_ned_m[2] = (float)(-0.2 * off_m);
        const goe_flight_assessment_t with = flown_fly(&flown, 1.0);
        const goe_flight_assessment_t without = flown_fly(&other, 1.0);
        goe_flight_obstacle_t moved;
        goe_flight_obstacle_t still;
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_obstacle(&flown.flight, 0, &moved));
        TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_obstacle(&other.flight, 0, &still));
        CHECK_CLOSE(0.1, (double)still.center_ned_m[0], moved.center_ned_m[0]);
        CHECK_CLOSE(0.1, (double)still.center_ned_m[1] + off_m, moved.center_ned_m[1]);
        CHECK_CLOSE(0.01, without.hazard.tcpa_s, with.hazard.tcpa_s);
        TEST_ASSERT_EQUAL(without.suspect, with.suspect);
        TEST_ASSERT_EQUAL(k + 1, flown.flight.counters.resets);
        TEST_ASSERT_EQUAL(0, flown.flight.counters.lost);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(a_calm_flight_does_not_jump);
    RUN_TEST(the_jumps_add_up_to_the_step);
    RUN_TEST(there_and_back_is_nothing);
    RUN_TEST(a_velocity_that_never_agreed_says_nothing);
    RUN_TEST(a_velocity_that_goes_wrong_counts_for_seconds);
    RUN_TEST(nothing_jumps_before_the_velocity_has_agreed);
    RUN_TEST(a_track_does_not_feel_a_jump);
    return UNITY_END();
}
