/* Two masts and exact places: the layer's orders obeyed late by an aircraft that turns at the bank of the settings.
 * SPDX-License-Identifier: MIT
 *
 * The first mast is on the course, the second one, known as well, next to it. No order may lead into either, and the order may
 * not end while one of them is on the line that is flown again. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "flown.h"
#include "goe_reaction.h"

#define SPEED_M_S 20.0
#define MAST_RADIUS_M 3.0
#define AHEAD_M 260.0
#define CLEAR_M 5.0
#define STEP_S 0.02
#define ASSESS_STEPS 5
#define FLIGHT_S 40.0
#define ASSESSMENTS 402
#define GRAVITY_M_S2 9.80665
#define PI 3.14159265358979

typedef struct {
    double mast_m[2][2]; /* ahead, right */
    double obey_s, loiter_m;
    double wide_m, sd_m; /* radius of both, 0: a mast's; one sigma of each place */
    double known_m;      /* the second is known from this distance on; 0: always */
} pair_t;

typedef struct {
    double closest_m;
    int changes;
    bool ordered, back; /* at its end the aircraft flies on its line again */
} flight_t;

static goe_flight_t flight;

static void start(double loiter_m) {
    static flown_t flown;
    goe_flight_settings_t settings;
    goe_flight_settings_default(&settings);
    settings.loiter_m = (float)loiter_m;
    flown_start(&flown, &settings);
    flight = flown.flight;
}

void setUp(void) { start(0.0); }
void tearDown(void) {}

static double radius_m(const pair_t *pair) { return pair->wide_m > 0.0 ? pair->wide_m : MAST_RADIUS_M; }

/* The input of an estimator that knows both positions, on the present course. */
static int look(const pair_t *pair, const double at_m[2], double course, uint32_t now_us) {
    int worst = -1;
    double most = -1.0;
    for (int i = 0; i < 2; i++) {
        goe_flight_slot_t *s = &flight.slot[i];
        const double north = pair->mast_m[i][0] - at_m[0], east = pair->mast_m[i][1] - at_m[1];
        const double ahead_m = cos(course) * north + sin(course) * east,
                     aside_m = cos(course) * east - sin(course) * north;
        const bool meets = ahead_m > 0.0 && fabs(aside_m) < radius_m(pair) + (double)flight.settings.margin_m;
        memset(&s->hazard, 0, sizeof s->hazard);
        s->used = s->assessed = i == 0 || !(pair->known_m > 0.0) || hypot(north, east) < pair->known_m;
        if (!s->used) {
            continue;
        }
        s->valid = GOE_HAS_POSITION | GOE_HAS_WIDTH | GOE_HAS_HEIGHT;
        s->center_ne_m[0] = (float)pair->mast_m[i][0];
        s->center_ne_m[1] = (float)pair->mast_m[i][1];
        s->width_m = (float)(2.0 * radius_m(pair));
        s->covariance_ne_m2[0] = s->covariance_ne_m2[2] = (float)(pair->sd_m * pair->sd_m);
        s->top_m = 80.0f;
        s->taken_us = s->detected_us = now_us;
        s->hazard.conflict_probability = meets ? 1.0f : 0.0f;
        s->hazard.tcpa_s = (float)fmax(ahead_m / SPEED_M_S, 0.0);
        const double urgency = (double)s->hazard.conflict_probability / (1.0 + 0.1 * (double)s->hazard.tcpa_s);
        worst = urgency > most ? i : worst;
        most = fmax(urgency, most);
    }
    return worst;
}

/* The course that the obeyed order requires. */
static double wanted_course(const goe_flight_reaction_t *order, const double at_m[2], double course, double loiter_m) {
    const double north = (double)order->target_ned_m[0] - at_m[0], east = (double)order->target_ned_m[1] - at_m[1];
    const double distance_m = hypot(north, east);
    if (order->action == GOE_FLIGHT_NONE) {
        return -0.8 * tanh(at_m[1] / 40.0);
    }
    if (loiter_m > 0.0 || order->action == GOE_FLIGHT_HOLD) { /* to the target, then about it to the right */
        const double radius_m = fmax(loiter_m, 72.0);
        return atan2(-east, -north) + 0.5 * PI + atan(4.0 * (distance_m - radius_m) / radius_m);
    }
    return cos(course) * north + sin(course) * east > 0.0 && north > 0.0 ? atan2(east, north) : 0.0;
}

static flight_t fly(const pair_t *pair) {
    static goe_flight_reaction_t given[ASSESSMENTS];
    flight_t result = {1.0e9, 0, false, false};
    double at_m[2] = {0.0, 0.0}, course = 0.0;
    int assessed = 0, side = 0;
    const int back = (int)(pair->obey_s / (STEP_S * ASSESS_STEPS) + 0.5);
    start(pair->loiter_m);
    for (int k = 0; k < (int)(FLIGHT_S / STEP_S); k++) {
        goe_flight_reaction_own_t own;
        memset(&own, 0, sizeof own);
        own.time_us = (uint32_t)(k * STEP_S * 1.0e6 + 0.5);
        own.ned_m[0] = (float)at_m[0];
        own.ned_m[1] = (float)at_m[1];
        own.ned_m[2] = -20.0f;
        flight.velocity_ned_m_s[0] = (float)(SPEED_M_S * cos(course));
        flight.velocity_ned_m_s[1] = (float)(SPEED_M_S * sin(course));
        if (k % ASSESS_STEPS == 0) {
            const int worst = look(pair, at_m, course, own.time_us);
            (void)goe_flight_reaction_decide(&flight, worst, &own);
            const uint8_t action = flight.reaction.action;
            const int now = action == GOE_FLIGHT_LEFT ? -1 : (action == GOE_FLIGHT_RIGHT ? 1 : 0);
            result.changes += now != 0 && side != 0 && now != side ? 1 : 0;
            side = now != 0 ? now : side;
            result.ordered = result.ordered || action != GOE_FLIGHT_NONE;
            given[assessed++] = flight.reaction;
        }
        if (assessed > back) {
            const double off = wanted_course(&given[assessed - 1 - back], at_m, course, pair->loiter_m) - course;
            const double turn = atan2(sin(off), cos(off));
            const double most = STEP_S * GRAVITY_M_S2 * tan(30.0 * PI / 180.0) / SPEED_M_S;
            course += fmin(fmax(turn, -most), most);
        }
        at_m[0] += STEP_S * SPEED_M_S * cos(course);
        at_m[1] += STEP_S * SPEED_M_S * sin(course);
        for (int i = 0; i < 2; i++) {
            const double away_m = hypot(at_m[0] - pair->mast_m[i][0], at_m[1] - pair->mast_m[i][1]) - radius_m(pair);
            result.closest_m = fmin(result.closest_m, away_m);
        }
    }
    result.back = fabs(at_m[1]) < 2.0 && cos(course) > 0.9;
    return result;
}

static void check(const pair_t *pair) {
    const flight_t flown = fly(pair);
    char text[128];
    (void)snprintf(
        text, sizeof text, "second mast at %.0f, %.0f, obeyed after %.1f s, circle %.0f m: %.1f m, %d changes",
        pair->mast_m[1][0] - AHEAD_M, pair->mast_m[1][1], pair->obey_s, pair->loiter_m, flown.closest_m, flown.changes);
    TEST_ASSERT_TRUE_MESSAGE(flown.ordered, text);
    TEST_ASSERT_TRUE_MESSAGE(flown.closest_m >= CLEAR_M, text);
    TEST_ASSERT_TRUE_MESSAGE(flown.changes <= 1, text);
    TEST_ASSERT_TRUE_MESSAGE(flown.back || pair->loiter_m > 0.0, text);
}

static const double obey_s[] = {0.5, 1.0, 1.5, 2.0};

/* Every lateral offset, before, abeam of and behind the first mast. */
static void fly_offsets(double first_m, double last_m, double loiter_m) {
    for (int delay = 0; delay < 4; delay++) {
        for (double aside_m = first_m; aside_m <= last_m + 0.1; aside_m += 5.0) {
            for (int row = -1; row <= 2; row++) {
                pair_t pair = {
                    {{AHEAD_M, 0.5}, {AHEAD_M + 30.0 * row, aside_m}}, obey_s[delay], loiter_m, 0.0, 0.0, 0.0};
                check(&pair);
            }
        }
    }
}

static void no_order_leads_into_a_second_mast_on_the_right(void) { fly_offsets(0.0, 100.0, 0.0); }
static void no_order_leads_into_a_second_mast_on_the_left(void) { fly_offsets(-100.0, 0.0, 0.0); }
static void no_circle_about_a_target_leads_into_a_second_mast(void) { fly_offsets(-100.0, 100.0, 80.0); }

/* One behind the other on the course. */
static void a_second_mast_behind_the_first_one_is_passed_too(void) {
    for (int delay = 0; delay < 4; delay++) {
        for (double apart_m = 30.0; apart_m < 200.0; apart_m += 10.0) {
            for (double aside_m = -8.0; aside_m < 9.0; aside_m += 4.0) {
                pair_t pair = {
                    {{AHEAD_M - 100.0, 0.5}, {AHEAD_M - 100.0 + apart_m, aside_m}}, obey_s[delay], 0.0, 0.0, 0.0, 0.0};
                check(&pair);
            }
        }
    }
}

/* GIVEN a wide obstacle beyond the first one and next to the line WHEN the first is passed THEN the aircraft, which passes the second
 * already, is not turned into it. */
static void no_order_flies_into_a_second_obstacle(void) {
    for (int sd = 0; sd <= 2; sd++) {
        for (int known = 1; known <= 3; known++) {
            for (double beyond_m = 60.0; beyond_m < 170.0; beyond_m += 20.0) {
                for (double right_m = 60.0; right_m <= 115.0; right_m += 5.0) {
                    const pair_t pair = {
                        {{AHEAD_M, 0.0}, {AHEAD_M + beyond_m, right_m}}, 0.6, 0.0, 18.0, 8.0 * sd, 80.0 * known};
                    const flight_t flown = fly(&pair);
                    char text[120];
                    (void)snprintf(text, sizeof text, "second at %.0f, %.0f, sigma %.0f m, known from %.0f m: %.1f m",
                                   beyond_m, right_m, pair.sd_m, pair.known_m, flown.closest_m);
                    TEST_ASSERT_TRUE_MESSAGE(flown.ordered && flown.closest_m >= CLEAR_M, text);
                    TEST_ASSERT_TRUE_MESSAGE(flown.changes <= 1, text);
                }
            }
        }
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(no_order_leads_into_a_second_mast_on_the_right);
    RUN_TEST(no_order_leads_into_a_second_mast_on_the_left);
    RUN_TEST(no_circle_about_a_target_leads_into_a_second_mast);
    RUN_TEST(no_order_flies_into_a_second_obstacle);
    RUN_TEST(a_second_mast_behind_the_first_one_is_passed_too);
    return UNITY_END();
}
