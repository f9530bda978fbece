/* The hazard of a place that is kept while its estimator knows none. SPDX-License-Identifier: MIT
 *
 * Against the geometry of a straight flight past a circle, in double precision. */
#include <math.h>
#include <string.h>

#include "flown.h"
#include "goe_lookout.h"

#define TRIALS 4000
#define SD_MIN_M 0.5 /* of a kept place, and of its top */

static check_random_t any;
static goe_flight_t flight;

void setUp(void) {
    static flown_t flown;
    any = check_random_start("flight lookout");
    flown_start(&flown, NULL);
    flight = flown.flight;
}
void tearDown(void) {}

static double between(double low, double high) { return check_random_between(&any, low, high); }
static bool one_in(int n) { return between(0.0, (double)n) < 1.0; }

static void put_any(goe_flight_slot_t *slot, uint32_t now_us) {
    const double sigma[2] = {between(0.0, 9.0), between(0.0, 9.0)};
    const double angle = between(-3.0, 3.0);
    const double c = cos(angle);
    const double s = sin(angle);
    slot->used = slot->remembered = true;
    slot->valid = (uint8_t)(GOE_HAS_POSITION | (one_in(2) ? GOE_HAS_HEIGHT : 0));
    slot->suspect = one_in(2);
    slot->center_ne_m[0] = (float)between(-150.0, 300.0);
    slot->center_ne_m[1] = (float)between(-90.0, 90.0);
    slot->covariance_ne_m2[0] = (float)(c * c * sigma[0] * sigma[0] + s * s * sigma[1] * sigma[1]);
    slot->covariance_ne_m2[1] = (float)(c * s * (sigma[0] * sigma[0] - sigma[1] * sigma[1]));
    slot->covariance_ne_m2[2] = (float)(s * s * sigma[0] * sigma[0] + c * c * sigma[1] * sigma[1]);
    slot->width_m = (float)between(0.0, 30.0);
    slot->length_m = (float)between(0.0, 30.0);
    slot->ground_down_m = (float)between(-5.0, 5.0);
    slot->top_m = (float)between(1.0, 40.0);
    slot->top_sd_m = (float)between(0.0, 4.0);
    slot->age_s = (float)between(0.0, 8.0);
    slot->taken_us = now_us - (uint32_t)between(0.0, 2.0e6);
}

/* One sigma of the place along a direction. */
static double sd_along_m(const goe_flight_slot_t *slot, double north, double east) {
    const double length = hypot(north, east);
    const double n = north / length;
    const double e = east / length;
    const double variance = n * n * (double)slot->covariance_ne_m2[0] +
                            2.0 * n * e * (double)slot->covariance_ne_m2[1] + e * e * (double)slot->covariance_ne_m2[2];
    return fmax(sqrt(fmax(variance, 0.0)), SD_MIN_M);
}

/* A half at the limit, 1 from 1.25 sigma within it on, 0 from 2.5 sigma beyond it on. */
static double chance(double within_m, double sd_m) {
    const double share = within_m > 0.0 ? 0.5 + 0.5 * within_m / (1.25 * sd_m) : 0.5 + 0.5 * within_m / (2.5 * sd_m);
    return fmin(fmax(share, 0.0), 1.0);
}

static void check_hazard(const goe_flight_slot_t *slot, const float own_ned_m[3], uint32_t now_us) {
    const goe_flight_settings_t *settings = &flight.settings;
    const goe_hazard_t *found = &slot->hazard;
    const double v[3] = {(double)flight.velocity_ned_m_s[0], (double)flight.velocity_ned_m_s[1],
                         (double)flight.velocity_ned_m_s[2]};
    const double north = (double)slot->center_ne_m[0] - (double)own_ned_m[0];
    const double east = (double)slot->center_ne_m[1] - (double)own_ned_m[1];
    const double speed = hypot(v[0], v[1]);
    const double closest_s = fmax((north * v[0] + east * v[1]) / (speed * speed), 0.0);
    const double off[2] = {north - closest_s * v[0], east - closest_s * v[1]};
    const double radius_m = 0.5 * hypot((double)slot->width_m, (double)slot->length_m);
    const double doubt = slot->suspect ? (double)settings->suspect_factor : 1.0;
    const double age_s = (double)slot->age_s + 1.0e-6 * (double)(now_us - slot->taken_us);
    const double limit_m = doubt * (double)settings->margin_m + (double)settings->stale_growth_m_s * age_s;
    const double off_m = hypot(off[0], off[1]) - radius_m;
    const bool ahead = closest_s > 0.0;
    const double dcpa_sd_m = ahead ? sd_along_m(slot, -v[1], v[0]) : sd_along_m(slot, off[0], off[1]);
    double violation = chance(limit_m - off_m, dcpa_sd_m);
    CHECK_CLOSE(2.0e-3, fmax(closest_s - radius_m / speed, ahead ? 0.01 : 0.0), found->tcpa_s);
    CHECK_CLOSE(2.0e-3, ahead ? sd_along_m(slot, v[0], v[1]) / speed : 0.0, found->tcpa_sd_s);
    CHECK_CLOSE(5.0e-3, fmax(off_m, 0.0), found->dcpa_m);
    CHECK_CLOSE(5.0e-3, dcpa_sd_m, found->dcpa_sd_m);
    TEST_ASSERT_EQUAL((slot->valid & GOE_HAS_HEIGHT) != 0u, found->has_clearance);
    if (found->has_clearance) {
        const double down_m = (double)own_ned_m[2] + closest_s * v[2];
        const double over_m = (double)slot->ground_down_m - (double)slot->top_m - down_m;
        const double sd_m = fmax((double)slot->top_sd_m, SD_MIN_M);
        CHECK_CLOSE(5.0e-3, over_m, found->clearance_m);
        CHECK_CLOSE(5.0e-3, sd_m, found->clearance_sd_m);
        violation *= chance(doubt * (double)settings->clearance_m - over_m, sd_m);
    }
    CHECK_CLOSE(0.01, violation, found->conflict_probability);
}

/* GIVEN any kept place and any straight flight THEN time, distance, their sigmas and the violation are those of the closest approach; of
 * a place that lies behind, those of now. The worst is the largest violation by the time that is left. */
static void a_kept_place_is_a_hazard_by_the_closest_approach(void) {
    int ahead = 0;
    int behind = 0;
    for (int n = 0; n < TRIALS; n++) {
        const uint32_t now_us = 0xFFFFF000u + (uint32_t)n;
        const float own_ned_m[3] = {(float)between(-20.0, 20.0), (float)between(-20.0, 20.0),
                                    (float)between(-60.0, -5.0)};
        const double course = between(-1.0, 1.0);
        const double speed_m_s = between(3.0, 30.0);
        flight.velocity_ned_m_s[0] = (float)(speed_m_s * cos(course));
        flight.velocity_ned_m_s[1] = (float)(speed_m_s * sin(course));
        flight.velocity_ned_m_s[2] = (float)between(-3.0, 3.0);
        for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
            put_any(&flight.slot[i], now_us);
            flight.slot[i].used = i == n % GOE_FLIGHT_SLOTS || !one_in(4);
        }
        const int worst = goe_flight_lookout_assess(&flight, own_ned_m, now_us);
        TEST_ASSERT_TRUE(worst >= 0 && flight.slot[worst].used);
        const goe_hazard_t *first = &flight.slot[worst].hazard;
        for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
            const goe_flight_slot_t *slot = &flight.slot[i];
            TEST_ASSERT_EQUAL(slot->used, slot->assessed);
            if (!slot->used) {
                continue;
            }
            check_hazard(slot, own_ned_m, now_us);
            TEST_ASSERT_TRUE((double)slot->hazard.conflict_probability / (1.0 + 0.1 * (double)slot->hazard.tcpa_s) <=
                             (double)first->conflict_probability / (1.0 + 0.1 * (double)first->tcpa_s) + 1.0e-6);
            ahead += slot->hazard.tcpa_s > 0.0f ? 1 : 0;
            behind += slot->hazard.tcpa_s > 0.0f ? 0 : 1;
        }
    }
    TEST_ASSERT_TRUE(ahead > TRIALS / 2 && behind > TRIALS / 4);
}

/* GIVEN a slot without a place, or that is free THEN it has no hazard, whatever it had. */
static void an_obstacle_without_position_has_no_hazard(void) {
    const float own_ned_m[3] = {0.0f, 0.0f, -20.0f};
    goe_hazard_t none;
    memset(&none, 0, sizeof none);
    flight.velocity_ned_m_s[0] = 20.0f;
    for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
        put_any(&flight.slot[i], 0u);
        flight.slot[i].assessed = true;
        flight.slot[i].hazard.conflict_probability = 1.0f;
        flight.slot[i].used = i != 1;
        flight.slot[i].valid = i == 1 ? GOE_HAS_POSITION : GOE_HAS_HEIGHT;
    }
    TEST_ASSERT_EQUAL(-1, goe_flight_lookout_assess(&flight, own_ned_m, 0u));
    for (int i = 0; i < GOE_FLIGHT_SLOTS; i++) {
        TEST_ASSERT_FALSE(flight.slot[i].assessed);
        TEST_ASSERT_EQUAL_MEMORY(&none, &flight.slot[i].hazard, sizeof none);
    }
}

/* Standing over the middle of a kept place no direction is known: the whole spread counts. */
static void over_the_middle_the_whole_spread_counts(void) {
    const float own_ned_m[3] = {10.0f, 5.0f, -20.0f};
    put_any(&flight.slot[0], 0u);
    flight.slot[0].center_ne_m[0] = 10.0f;
    flight.slot[0].center_ne_m[1] = 5.0f;
    flight.slot[0].covariance_ne_m2[0] = 9.0f;
    flight.slot[0].covariance_ne_m2[1] = 0.0f;
    flight.slot[0].covariance_ne_m2[2] = 16.0f;
    TEST_ASSERT_EQUAL(0, goe_flight_lookout_assess(&flight, own_ned_m, 0u));
    CHECK_CLOSE(1.0e-3, 5.0, flight.slot[0].hazard.dcpa_sd_m);
    CHECK_SAME(0.0f, flight.slot[0].hazard.tcpa_s);
    CHECK_SAME(0.0f, flight.slot[0].hazard.tcpa_sd_s);
    CHECK_SAME(0.0f, flight.slot[0].hazard.dcpa_m);
}

/* Who stands still comes no nearer. */
static void a_hover_meets_nothing(void) {
    const float own_ned_m[3] = {0.0f, 0.0f, -20.0f};
    put_any(&flight.slot[0], 0u);
    flight.slot[0].center_ne_m[0] = 60.0f;
    flight.slot[0].center_ne_m[1] = -80.0f;
    flight.slot[0].width_m = flight.slot[0].length_m = 0.0f;
    TEST_ASSERT_EQUAL(0, goe_flight_lookout_assess(&flight, own_ned_m, 0u));
    CHECK_SAME(0.0f, flight.slot[0].hazard.tcpa_s);
    CHECK_CLOSE(1.0e-3, 100.0, flight.slot[0].hazard.dcpa_m);
    TEST_ASSERT_TRUE(check_is_finite(flight.slot[0].hazard.conflict_probability));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(a_hover_meets_nothing);
    RUN_TEST(a_kept_place_is_a_hazard_by_the_closest_approach);
    RUN_TEST(an_obstacle_without_position_has_no_hazard);
    RUN_TEST(over_the_middle_the_whole_spread_counts);
    return UNITY_END();
}
