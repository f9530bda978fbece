/* Obstacles that move, and how a violation is put together. SPDX-License-Identifier: MIT
 *
 * Estimates are written into the estimator, so that every number is known. */
/* tests: lib/hazard/goe_conflict.c */
#include "hazard/goe_conflict.h"

#include <math.h>
#include <string.h>

#include "check.h"
#include "goe_guard.h"
#include "stated.h"

static goe_estimator_t estimator;
static goe_hazard_t hazard;

/* A tower of 6 m straight ahead, 100 m away, 20 m high; the camera is 50 m up. */
void setUp(void) {
    const stated_t tower = {0.0f, 100.0f, 6.0f, 20.0f, 2.0f, 3.0f, 50.0f};
    stated_answer(&estimator, &tower);
}
void tearDown(void) {}

static goe_intent_t intent_of(float north_m_s, float east_m_s) {
    const goe_intent_t intent = {{north_m_s, east_m_s, 0.0f}, 5.0f, 10.0f, 0.0f, 0.0f};
    return intent;
}

static void make_it_move(float north_m_s, float east_m_s) {
    estimator.estimate.valid |= GOE_HAS_VELOCITY;
    estimator.estimate.velocity_north_m_s = north_m_s;
    estimator.estimate.velocity_east_m_s = east_m_s;
    estimator.estimate.sigma.velocity_north_m_s = 0.5f;
    estimator.estimate.sigma.velocity_east_m_s = 0.5f;
}

/* GIVEN an obstacle that moves THEN it is met by the velocity relative to it; of one that is not known to, by the own. */
static void a_moving_target_is_met_by_the_relative_velocity(void) {
    const goe_intent_t intent = intent_of(10.0f, 2.0f);
    estimator.estimate.velocity_north_m_s = -7.0f; /* means nothing without its bit */
    goe_intent_t relative = goe_conflict_relative(&estimator, &intent);
    CHECK_SAME(10.0f, relative.velocity_ned_m_s[0]);
    CHECK_SAME(2.0f, relative.velocity_ned_m_s[1]);
    make_it_move(-7.0f, 3.0f);
    relative = goe_conflict_relative(&estimator, &intent);
    CHECK_SAME(17.0f, relative.velocity_ned_m_s[0]);
    CHECK_SAME(-1.0f, relative.velocity_ned_m_s[1]);
    CHECK_SAME(intent.margin_m, relative.margin_m);
}

/* GIVEN an obstacle, standing or moving THEN errors of velocity count up to the time at which it is met, but no longer than a minute,
 * nor less than has passed since the image. */
static void a_velocitys_error_counts_until_it_is_met(void) {
    goe_intent_t intent = intent_of(10.0f, 0.0f);
    CHECK_CLOSE(1.0e-4, 10.0, goe_conflict_ahead_s(&estimator, &intent));
    make_it_move(0.0f, 0.0f);
    CHECK_CLOSE(1.0e-4, 10.0, goe_conflict_ahead_s(&estimator, &intent));
    intent.velocity_ned_m_s[0] = 1.0f;
    CHECK_SAME(60.0f, goe_conflict_ahead_s(&estimator, &intent));
    intent.velocity_ned_m_s[0] = -10.0f; /* behind */
    intent.since_image_s = 1.5f;
    CHECK_SAME(1.5f, goe_conflict_ahead_s(&estimator, &intent));
    intent.velocity_ned_m_s[0] = 0.0f; /* standing still has no way to it */
    CHECK_SAME(1.5f, goe_conflict_ahead_s(&estimator, &intent));
    estimator.motion.heading_cos = 0.0f; /* Z is east */
    estimator.motion.heading_sin = 1.0f;
    intent.velocity_ned_m_s[1] = 20.0f;
    CHECK_CLOSE(1.0e-4, 5.0, goe_conflict_ahead_s(&estimator, &intent));
}

/* GIVEN an intent whose velocity is uncertain THEN distance and clearance are, by that over the time until then; an intent that does not
 * say takes the setting. */
static void the_plans_velocity_may_be_wrong(void) {
    goe_intent_t intent = intent_of(10.0f, 0.0f);
    estimator.estimate.x_m = estimator.estimate.x0_m = 40.0f;
    CHECK_STATUS(GOE_OK, goe_hazard(&estimator, &intent, &hazard));
    CHECK_CLOSE(1.0e-3, 2.0, hazard.dcpa_sd_m);
    CHECK_CLOSE(1.0e-3, 3.0, hazard.clearance_sd_m);
    intent.velocity_sd_m_s = 0.3f; /* ten seconds away */
    CHECK_STATUS(GOE_OK, goe_hazard(&estimator, &intent, &hazard));
    CHECK_CLOSE(1.0e-3, sqrt(4.0 + 9.0), hazard.dcpa_sd_m);
    CHECK_CLOSE(1.0e-3, sqrt(9.0 + 9.0), hazard.clearance_sd_m);
    CHECK_CLOSE(1.0e-3, sqrt(4.0 + 9.0) / 10.0, hazard.tcpa_sd_s);
#if GOE_WITH_FILTER
    intent.velocity_sd_m_s = 0.0f;
    estimator.settings.navigation.velocity_bias_sd_m_s = 0.4f;
    goe_guard_seal(&estimator);
    CHECK_STATUS(GOE_OK, goe_hazard(&estimator, &intent, &hazard));
    CHECK_CLOSE(1.0e-3, sqrt(4.0 + 16.0), hazard.dcpa_sd_m);
#endif
    static const float refused[] = {-0.1f, 101.0f};
    for (int i = 0; i < 2; i++) {
        intent.velocity_sd_m_s = refused[i];
        CHECK_STATUS(GOE_OUT_OF_RANGE, goe_hazard(&estimator, &intent, &hazard));
    }
    intent.velocity_sd_m_s = NAN;
    CHECK_STATUS(GOE_NOT_FINITE, goe_hazard(&estimator, &intent, &hazard));
}

/* GIVEN an image of a second ago THEN the camera has flown on since, forward and up, and times count from now. */
static void the_aircraft_has_flown_on_since_the_image(void) {
    goe_intent_t intent = intent_of(10.0f, 0.0f);
    intent.velocity_ned_m_s[2] = -2.0f;
    CHECK_STATUS(GOE_OK, goe_hazard(&estimator, &intent, &hazard));
    const goe_hazard_t then = hazard;
    CHECK_CLOSE(1.0e-3, 9.7, then.tcpa_s);
    CHECK_CLOSE(1.0e-2, 30.0 + 2.0 * 9.7, then.clearance_m);
    intent.since_image_s = 1.0f;
    CHECK_STATUS(GOE_OK, goe_hazard(&estimator, &intent, &hazard));
    CHECK_CLOSE(1.0e-3, 8.7, hazard.tcpa_s);
    CHECK_CLOSE(1.0e-2, (double)then.clearance_m, hazard.clearance_m); /* at the same place */
}

/* ... and aside: an obstacle ahead of a crossing course is abeam when it has been flown for long enough. */
static void the_aircraft_has_flown_aside_since_the_image(void) {
    goe_intent_t intent = intent_of(0.0f, 10.0f);
    estimator.estimate.x_m = estimator.estimate.x0_m = 40.0f;
    estimator.estimate.z_m = estimator.estimate.z0_m = 30.0f;
    CHECK_STATUS(GOE_OK, goe_hazard(&estimator, &intent, &hazard));
    CHECK_CLOSE(1.0e-3, 4.0, hazard.tcpa_s);
    CHECK_CLOSE(1.0e-3, 27.0, hazard.dcpa_m);
    intent.since_image_s = 3.0f;
    CHECK_STATUS(GOE_OK, goe_hazard(&estimator, &intent, &hazard));
    CHECK_CLOSE(1.0e-3, 1.0, hazard.tcpa_s);
    CHECK_CLOSE(1.0e-3, 27.0, hazard.dcpa_m);
    CHECK_CLOSE(1.0e-3, 0.2, hazard.tcpa_sd_s); /* also of an obstacle a second away: 2 m by 10 m/s */
    intent.since_image_s = 3.5f;
    CHECK_STATUS(GOE_OK, goe_hazard(&estimator, &intent, &hazard));
    CHECK_CLOSE(1.0e-3, 0.5, hazard.tcpa_s);
    CHECK_CLOSE(1.0e-3, 0.2, hazard.tcpa_sd_s);
    intent.since_image_s = 5.0f; /* passed: nothing comes nearer, and now is certain */
    CHECK_STATUS(GOE_OK, goe_hazard(&estimator, &intent, &hazard));
    CHECK_SAME(0.0f, hazard.tcpa_s);
    CHECK_SAME(0.0f, hazard.tcpa_sd_s);
}

/* GIVEN a margin and a clearance whose errors have nothing in common THEN both are violated with the product of what each is; without
 * a height, with the margin's alone. */
static void independent_errors_multiply(void) {
    goe_intent_t intent = intent_of(10.0f, 0.0f);
    intent.margin_m = 0.0f;
    estimator.estimate.x_m = estimator.estimate.x0_m = 4.0f; /* passed a meter aside of the rim, by half a sigma */
    intent.clearance_m = 30.0f;                              /* as likely as not */
    CHECK_STATUS(GOE_OK, goe_hazard(&estimator, &intent, &hazard));
    TEST_ASSERT_TRUE(hazard.has_clearance);
    CHECK_CLOSE(1.0e-3, 1.0, hazard.dcpa_m);
    CHECK_CLOSE(1.0e-3, 2.0, hazard.dcpa_sd_m);
    CHECK_CLOSE(1.0e-2, 3.0, hazard.clearance_sd_m);
    const float both = hazard.conflict_probability;
    estimator.estimate.valid &= ~(unsigned)GOE_HAS_HEIGHT;
    CHECK_STATUS(GOE_OK, goe_hazard(&estimator, &intent, &hazard));
    TEST_ASSERT_FALSE(hazard.has_clearance);
    CHECK_SAME(0.0f, hazard.clearance_m);
    CHECK_CLOSE(2.0e-3, 0.3085,
                hazard.conflict_probability); /* of a normal variable, below half a sigma under its mean */
    CHECK_CLOSE(2.0e-3, 0.5 * (double)hazard.conflict_probability, both);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(a_moving_target_is_met_by_the_relative_velocity);
    RUN_TEST(a_velocitys_error_counts_until_it_is_met);
    RUN_TEST(the_plans_velocity_may_be_wrong);
    RUN_TEST(the_aircraft_has_flown_on_since_the_image);
    RUN_TEST(the_aircraft_has_flown_aside_since_the_image);
    RUN_TEST(independent_errors_multiply);
    return UNITY_END();
}
