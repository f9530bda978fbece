/* The decision rule. SPDX-License-Identifier: MIT
 *
 * Answers are written into the estimator, so that every number is known. */
/* tests: lib/hazard/goe_decide.c */
#include <math.h>
#include <string.h>

#include "check.h"
#include "goe_guard.h"
#include "inverse.h"
#include "stated.h"

static goe_estimator_t estimator;
static goe_intent_t intent;
static goe_rule_t rule;
static goe_hazard_t hazard;

/* A mast 6 m wide, 100 m ahead and aside_m aside, higher than the path, of which everything is known to a meter. */
static void place(double aside_m) {
    const stated_t mast = {(float)aside_m, 100.0f, 6.0f, 40.0f, 1.0f, 1.0f, 20.0f};
    stated_answer(&estimator, &mast);
}

void setUp(void) {
    place(0.0);
    memset(&intent, 0, sizeof intent);
    intent.velocity_ned_m_s[0] = 10.0f;
    intent.margin_m = 15.0f;
    intent.clearance_m = 10.0f;
    goe_rule_default(&rule);
}
void tearDown(void) {}

/* Images without the obstacle since its estimate. */
static void last_shown_s(double seconds) {
    estimator.motion.time_us = estimator.estimate_time_us + (int64_t)(1.0e6 * seconds);
}

static goe_decision_t decide(void) { return goe_decide(&estimator, &intent, &rule, &hazard); }

/* [goe_decide]
 * GIVEN an obstacle on the course THEN the rule acts from the probability and from the time on that it is given, and not before. */
static void probability_and_time_decide(void) {
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_ACT, decide());
    TEST_ASSERT_TRUE(hazard.conflict_probability > 0.99f);
    rule.act_within_s = 0.99f * (hazard.tcpa_s - 2.0f * hazard.tcpa_sd_s);
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_CLEAR, decide());
    rule.act_within_s = 1.01f * goe_earliest_tcpa_s(&hazard);
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_ACT, decide());
    rule.act_within_s = 12.0f;
    place(19.0); /* passed by a meter more than the margin */
    (void)decide();
    TEST_ASSERT_TRUE(hazard.conflict_probability > 0.05f && hazard.conflict_probability < 0.5f);
    rule.conflict_probability_max = hazard.conflict_probability;
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_ACT, decide());
    rule.conflict_probability_max = 1.01f * hazard.conflict_probability;
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_CLEAR, decide());
}

/* GIVEN a place so uncertain that hardly any of it lies within the margin THEN the small probability is no "clear": too little is known.
 * A place that is surely outside is clear, by either distance. */
static void a_poorly_known_obstacle_is_not_clear(void) {
    for (int far_aside = 0; far_aside < 2; far_aside++) {
        place(far_aside == 1 ? 60.0 : 0.0);
        estimator.estimate.sigma.x0_m = estimator.estimate.sigma.z0_m = 5000.0f;
        TEST_ASSERT_EQUAL_INT(GOE_DECISION_UNKNOWN, decide());
        TEST_ASSERT_TRUE(hazard.conflict_probability < rule.conflict_probability_max);
    }
    place(0.0); /* met for sure, but nobody knows when: 10 s +- 8 s */
    estimator.estimate.sigma.z0_m = 80.0f;
    rule.act_within_s = 3.0f;
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_UNKNOWN, decide());
    TEST_ASSERT_TRUE(hazard.conflict_probability > 0.5f && goe_earliest_tcpa_s(&hazard) > rule.act_within_s);
    rule.act_within_s = 12.0f;
    place(60.0);
    estimator.estimate.sigma.x0_m = estimator.estimate.sigma.z0_m = 5000.0f;
    estimator.estimate.height_m = 2.0f; /* 18 m below the path */
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_CLEAR, decide());
    place(60.0);
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_CLEAR, decide());
}

/* GIVEN detections for more than two seconds without an answer THEN the old answer clears nothing; an answer that is as old for want of
 * detections does. */
static void an_old_answer_clears_nothing_after_new_detections(void) {
    place(60.0);
    estimator.estimate.method = GOE_METHOD_FILTER;
    estimator.estimate.fresh = false;
    for (int outdated = 0; outdated < 2; outdated++) {
        estimator.filter.answer.outdated = true; /* the covariance of the sigmas in both */
        estimator.motion.time_us = estimator.estimate_time_us + (outdated == 1 ? 2100000 : 1900000);
        TEST_ASSERT_EQUAL_INT(outdated == 1 ? GOE_DECISION_UNKNOWN : GOE_DECISION_CLEAR, decide());
    }
    inverse_start(&estimator.filter.root, 1.0e-6);
    estimator.filter.answer.outdated = false; /* as old for want of detections */
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_CLEAR, decide());
    estimator.estimate.valid &= ~(unsigned)GOE_HAS_HEIGHT;
    estimator.filter.answer.outdated = true;
    estimator.motion.time_us = estimator.estimate_time_us;
    estimator.estimate.sigma.x0_m = estimator.estimate.sigma.z0_m = 5000.0f;
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_UNKNOWN, decide());
    place(60.0);
    estimator.estimate.fresh = false;
    estimator.motion.time_us = estimator.estimate_time_us + 2100000;
    estimator.filter.answer.outdated = true;
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_UNKNOWN, decide());
#if GOE_WITH_WINDOW
    estimator.settings.method = GOE_METHOD_WINDOW;
    goe_guard_seal(&estimator);
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_CLEAR, decide());
#endif
}

/* [goe_decide, GOE_REASON_MOVES]
 * GIVEN an obstacle that moves without an estimated velocity THEN its position is wrong and clears nothing; it still orders. */
static void a_wrong_position_clears_nothing(void) {
    place(60.0);
    estimator.estimate.suspect = true;
    estimator.estimate.reason = GOE_REASON_NOISE;
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_CLEAR, decide());
    estimator.estimate.reason = GOE_REASON_MOVES;
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_UNKNOWN, decide());
    estimator.estimate.valid |= GOE_HAS_VELOCITY;
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_CLEAR, decide());
    place(0.0);
    estimator.estimate.reason = GOE_REASON_MOVES;
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_ACT, decide());
}

/* GIVEN a wall 13 m ahead, nearer than the margin, WHEN the aircraft creeps towards it THEN the rule acts, though the closest approach is
 * minutes ahead; the same for an obstacle that flees a little slower than the aircraft. From farther away the time decides. */
static void a_violation_at_a_creeping_speed_is_one_of_now(void) {
    for (int follows = 0; follows < 2; follows++) {
        for (int k = -20; k <= 20; k++) {
            const stated_t mast = {0.0f, 16.0f, 6.0f, 40.0f, 1.0f, 1.0f, 20.0f};
            stated_answer(&estimator, &mast);
            if (follows == 1) {
                estimator.estimate.valid |= GOE_HAS_VELOCITY;
                estimator.estimate.velocity_north_m_s = 8.0f;
            }
            intent.velocity_ned_m_s[0] = 0.05f * (float)k + 8.0f * (float)follows;
            TEST_ASSERT_EQUAL_INT(GOE_DECISION_ACT, decide());
        }
    }
    place(0.0);
    intent.velocity_ned_m_s[0] = 2.0f; /* 48 s */
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_CLEAR, decide());
}

/* GIVEN a roof 60 m below and 5 m aside of a hover WHEN the aircraft sinks at 5 m/s THEN the rule acts from act_within_s before the clearance
 * on; at 1 m/s, at rest and in a climb it does not. */
static void a_descent_next_to_a_roof_is_foreseen(void) {
    for (int k = -10; k <= 10; k++) {
        const stated_t hall = {0.0f, 15.0f, 20.0f, 20.0f, 0.5f, 0.5f, 80.0f}; /* 60 m below; 50 m until the clearance */
        const float sinks_m_s = 0.7f * (float)k;
        stated_answer(&estimator, &hall);
        intent.velocity_ned_m_s[0] = 0.05f;
        intent.velocity_ned_m_s[2] = sinks_m_s;
        const bool soon = 12.0f * sinks_m_s > 50.0f;
        TEST_ASSERT_EQUAL_INT(soon ? GOE_DECISION_ACT : GOE_DECISION_CLEAR, decide());
    }
}

/* GIVEN a tank of 40 m radius, 20 m aside of the aircraft, WHEN the course passes it at 6 m, in 14 s, THEN the aircraft is within the margin
 * of 30 m now; 45 m aside it is not. */
static void within_the_margin_of_a_wide_obstacle_the_rule_acts(void) {
    for (int far_aside = 0; far_aside < 2; far_aside++) {
        const float beyond_m = far_aside == 1 ? 45.0f : 20.0f;
        const float z_m = sqrtf((40.0f + beyond_m) * (40.0f + beyond_m) - 46.0f * 46.0f);
        const stated_t tank = {46.0f, z_m, 80.0f, 40.0f, 0.5f, 0.5f, 20.0f};
        stated_answer(&estimator, &tank);
        intent.margin_m = 30.0f;
        intent.velocity_ned_m_s[0] = z_m / 14.0f; /* faster than creeping */
        TEST_ASSERT_TRUE(12.0f * intent.velocity_ned_m_s[0] > intent.margin_m);
        TEST_ASSERT_EQUAL_INT(far_aside == 1 ? GOE_DECISION_CLEAR : GOE_DECISION_ACT, decide());
    }
}

/* GIVEN a wall ahead that is nearer than the margin which a suspect or an old estimate has widened, or than the margin after the flight
 * since the latest image, WHEN the aircraft flies a little slower or faster THEN the rule acts at every speed: more doubt and more way never
 * end an order. */
static void a_widened_margin_counts_at_every_speed(void) {
    for (int k = 2; k <= 400; k++) {
        const float speed_m_s = 0.05f * (float)k;
        const stated_t mast = {0.0f, 26.0f, 6.0f, 40.0f, 0.5f, 0.5f, 20.0f}; /* 23 m to its face */
        stated_answer(&estimator, &mast);
        intent.velocity_ned_m_s[0] = speed_m_s;
        intent.margin_m = 15.0f;
        intent.since_image_s = 0.0f;
        TEST_ASSERT_EQUAL_INT(speed_m_s < 1.0f ? GOE_DECISION_CLEAR : decide(),
                              decide()); /* 8 m and more, in 8 s or more */
        estimator.estimate.fresh = false;
        estimator.motion.time_us = estimator.estimate_time_us + 12000000;
        TEST_ASSERT_EQUAL_INT(GOE_DECISION_ACT, decide());
        stated_answer(&estimator, &mast);
        estimator.estimate.suspect = true;
        intent.margin_m = 17.0f;
        TEST_ASSERT_EQUAL_INT(GOE_DECISION_ACT, decide());
        stated_answer(&estimator, &mast);
        estimator.estimate.suspect = false;
        intent.margin_m = 21.5f;
        intent.since_image_s = 2.0f;
        rule.stale_growth_m_s = 0.0f;
        TEST_ASSERT_TRUE(speed_m_s < 1.0f || decide() == GOE_DECISION_ACT);
        rule.stale_growth_m_s = 1.0f;
    }
}

/* [GOE_DECISION_UNKNOWN]
 * GIVEN an obstacle aside WHEN the image's border cuts it on the side of the course THEN it is not clear while it is ahead; WHEN the border
 * cuts it on the other side THEN it is. The course, not the nose, decides; a hovering aircraft has none. */
static void what_goes_on_toward_the_course_is_not_clear(void) {
    for (int right = 0; right < 2; right++) {
        const unsigned near_side = right ? GOE_SIDE_LEFT : GOE_SIDE_RIGHT;
        place(right ? 60.0f : -60.0f);
        TEST_ASSERT_EQUAL_INT(GOE_DECISION_CLEAR, decide());
        estimator.filter.answer.cut = (uint8_t)((GOE_SIDE_LEFT | GOE_SIDE_RIGHT) ^ near_side);
        TEST_ASSERT_EQUAL_INT(GOE_DECISION_CLEAR, decide());
        estimator.filter.answer.cut = (uint8_t)near_side;
        TEST_ASSERT_EQUAL_INT(GOE_DECISION_UNKNOWN, decide());
        intent.velocity_ned_m_s[1] = right ? 20.0f : -20.0f; /* past it on its other side */
        TEST_ASSERT_EQUAL_INT(GOE_DECISION_CLEAR, decide());
        intent.velocity_ned_m_s[1] = 0.0f;
        estimator.filter.answer.cut = (uint8_t)((GOE_SIDE_LEFT | GOE_SIDE_RIGHT) ^ near_side);
        intent.velocity_ned_m_s[0] = 0.05f; /* no course */
        TEST_ASSERT_EQUAL_INT(GOE_DECISION_UNKNOWN, decide());
        intent.velocity_ned_m_s[0] = 20.0f;
        estimator.filter.answer.cut = (uint8_t)near_side;
        estimator.estimate.z_m = -1.0f;
        TEST_ASSERT_EQUAL_INT(GOE_DECISION_UNKNOWN, decide());
        last_shown_s(1.1);
        TEST_ASSERT_EQUAL_INT(GOE_DECISION_CLEAR, decide());
    }
}

/* [GOE_DECISION_UNKNOWN]
 * GIVEN an obstacle that is cut, or outgrew its range, WHEN it lies behind the axis to the right of T but ahead on the course THEN it is not
 * clear; WHEN the course leads away from it THEN it is. */
static void ahead_is_along_the_course(void) {
    for (int cut = 0; cut < 2; cut++) {
        place(60.0);
        last_shown_s(1.1);
        estimator.estimate.z_m = -1.0f;
        estimator.filter.answer.cut = cut == 1 ? GOE_SIDE_LEFT : 0u;
        estimator.filter.answer.outgrown_s = cut == 1 ? 0.0f : 1.0f;
        intent.velocity_ned_m_s[0] = 10.0f;
        intent.velocity_ned_m_s[1] = 2.0f;
        TEST_ASSERT_EQUAL_INT(GOE_DECISION_UNKNOWN, decide());
        intent.velocity_ned_m_s[1] = -2.0f;
        TEST_ASSERT_EQUAL_INT(GOE_DECISION_CLEAR, decide());
    }
}

/* [GOE_DECISION_UNKNOWN] GIVEN an obstacle whose middle is passed, and whose end toward the course is cut WHEN images show it, with an
 * estimate or without, THEN it is not clear. */
static void a_passed_middle_clears_no_cut_end_in_view(void) {
    for (int cut = 0; cut < 2; cut++) {
        place(60.0);
        estimator.estimate.z_m = -1.0f;
        intent.velocity_ned_m_s[1] = -2.0f;
        estimator.filter.answer.cut = cut == 1 ? GOE_SIDE_LEFT : 0u;
        estimator.motion.detected = 1u;
        TEST_ASSERT_EQUAL_INT(cut == 1 ? GOE_DECISION_UNKNOWN : GOE_DECISION_CLEAR, decide());
        last_shown_s(1.1); /* it is passed */
        TEST_ASSERT_EQUAL_INT(GOE_DECISION_CLEAR, decide());
        estimator.motion.detected = 2u;
        TEST_ASSERT_EQUAL_INT(cut == 1 ? GOE_DECISION_UNKNOWN : GOE_DECISION_CLEAR, decide());
        place(60.0);
        intent.velocity_ned_m_s[1] = 20.0f; /* it lies behind: the aircraft backs away */
        intent.velocity_ned_m_s[0] = -20.0f;
        estimator.filter.answer.cut = GOE_SIDE_LEFT | GOE_SIDE_RIGHT;
        TEST_ASSERT_EQUAL_INT(GOE_DECISION_UNKNOWN, decide());
        intent.velocity_ned_m_s[1] = -20.0f;
        TEST_ASSERT_EQUAL_INT(GOE_DECISION_CLEAR, decide());
        intent.velocity_ned_m_s[0] = 10.0f;
    }
}

/* [goe_decide] GIVEN an aircraft that creeps away and whose images are refused WHEN the time since then may have led it into the margin
 * THEN it acts. */
static void a_creeping_aircraft_without_images_acts(void) {
    place(60.0);
    intent.velocity_ned_m_s[0] = -0.5f;
    intent.velocity_ned_m_s[1] = 0.0f;
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_CLEAR, decide());
    estimator.estimate.age_s = 80.0f;
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_ACT, decide());
}

/* [goe_intent_t.margin_m] GIVEN a creeping aircraft within the largest margin WHEN the image is old THEN the decision stays "act". */
static void the_largest_margin_is_none_too_large(void) {
    place(60.0);
    intent.margin_m = 9990.0f;
    intent.velocity_ned_m_s[0] = -0.5f;
    for (int since_s = 0; since_s < 1000; since_s += 90) {
        intent.since_image_s = (float)since_s;
        TEST_ASSERT_EQUAL_INT(GOE_DECISION_ACT, decide());
    }
}

/* GIVEN an obstacle that is passed far aside WHEN the camera is silent THEN it is clear for two seconds after the latest image, and not
 * known after that; one ahead is still acted on. */
static void a_silent_camera_clears_nothing(void) {
    place(60.0);
    intent.since_image_s = 2.0f;
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_CLEAR, decide());
    intent.since_image_s = nextafterf(2.0f, 3.0f);
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_UNKNOWN, decide());
    place(0.0);
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_ACT, decide());
}

/* [goe_decide]
 * GIVEN a suspect estimate THEN margin and clearance count `doubt` times; GIVEN one that is some seconds old, by its own age and the
 * intent's THEN they have grown by the drift. The hazard is that of these distances. */
static void doubt_and_age_widen(void) {
    static const float seconds[] = {0.0f, 4.0f};
    place(40.0);
    for (int suspect = 0; suspect < 2; suspect++) {
        for (int old = 0; old < 2; old++) {
            goe_hazard_t expected;
            goe_intent_t wide = intent;
            rule.suspect_factor = 1.8f;
            rule.stale_growth_m_s = 2.5f;
            estimator.estimate.suspect = suspect == 1;
            estimator.estimate.fresh = old == 0;
            estimator.motion.time_us = 5000000 + (int64_t)(1.0e6f * seconds[old]);
            intent.since_image_s = wide.since_image_s = 0.5f;
            wide.margin_m = (suspect == 1 ? 1.8f : 1.0f) * 15.0f + 2.5f * (seconds[old] + 0.5f);
            wide.clearance_m = (suspect == 1 ? 1.8f : 1.0f) * 10.0f + 2.5f * (seconds[old] + 0.5f);
            CHECK_STATUS(GOE_OK, goe_hazard(&estimator, &wide, &expected));
            (void)decide();
            CHECK_CLOSE(1.0e-6, expected.conflict_probability, hazard.conflict_probability);
            CHECK_SAME(expected.dcpa_m, hazard.dcpa_m);
        }
    }
}

/* [goe_decide] GIVEN an obstacle 10 s ahead and an image that was refused after the latest one taken WHEN the intent does not report
 * the time THEN the decision is that of the refused image's time; a false time takes no order back. */
static void a_refused_image_moves_the_aircraft_on(void) {
    goe_hazard_t expected;
    rule.act_within_s = 3.0f;
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_CLEAR, decide());
    intent.since_image_s = 7.5f;
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_ACT, decide());
    expected = hazard;
    intent.since_image_s = 0.0f;
    estimator.estimate.age_s = 7.5f;
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_ACT, decide());
    CHECK_SAME(expected.tcpa_s, hazard.tcpa_s);
    intent.since_image_s = 8.0f; /* reported, and later */
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_ACT, decide());
    TEST_ASSERT_TRUE(hazard.tcpa_s < expected.tcpa_s);
    intent.since_image_s = 0.0f;
    rule.act_within_s = 12.0f;
    estimator.estimate.age_s = 1.0e3f; /* long past the obstacle */
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_ACT, decide());
    estimator.estimate.sigma.z0_m = 80.0f; /* 10 s +- 8 s: too little is known */
    rule.act_within_s = 3.0f;
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_UNKNOWN, decide());
    estimator.estimate.age_s = 0.5f;
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_UNKNOWN, decide());
    estimator.estimate.age_s = 9.0f;
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_ACT, decide());
    estimator.estimate.sigma.z0_m = 8.0f; /* clear now, and uncertain then */
    rule.act_within_s = 1.6f;
    estimator.estimate.age_s = 0.0f;
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_CLEAR, decide());
    const float now_s = hazard.tcpa_s;
    estimator.estimate.age_s = 1.0f; /* clear at both times: the hazard is that of now */
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_CLEAR, decide());
    CHECK_SAME(now_s, hazard.tcpa_s);
    estimator.estimate.age_s = 6.7f;
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_UNKNOWN, decide());
    estimator.estimate.age_s = 7.5f; /* within the margin, which has grown by 7.5 m */
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_ACT, decide());
}

/* [goe_decide] GIVEN an estimator without a position THEN the decision is that nothing is known. */
static void without_a_position_nothing_is_known(void) {
    estimator.estimate.valid = 0u;
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_UNKNOWN, decide());
    CHECK_SAME(0.0f, hazard.conflict_probability);
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_UNKNOWN, 0); /* memory of zeros is not "clear" */
}

static float *field(int i) {
    float *const fields[] = {&intent.velocity_ned_m_s[0], &intent.velocity_ned_m_s[1],
                             &intent.velocity_ned_m_s[2], &intent.margin_m,
                             &intent.clearance_m,         &intent.since_image_s,
                             &intent.velocity_sd_m_s,     &rule.conflict_probability_max,
                             &rule.act_within_s,          &rule.suspect_factor,
                             &rule.stale_growth_m_s};
    return fields[i];
}

/* [goe_intent_t.velocity_sd_m_s, goe_rule_t.act_within_s, goe_rule_t.conflict_probability_max]
 * GIVEN anything that the rule cannot work with: a number that is none, or out of range, in each field; no intent, no estimator, one that was
 * not set or whose settings have changed THEN the decision is to keep the previous one, and the hazard is all zero. */
static void every_failure_keeps_the_decision(void) {
    static const uint32_t bits[] = {0x7FC00000u, 0xFFC00001u, 0x7F800000u, 0xFF800000u, 0x7F000000u, 0xFF000000u};
    static goe_estimator_t broken;
    for (int i = 0; i < 11; i++) {
        for (size_t k = 0; k < sizeof bits / sizeof bits[0]; k++) {
            setUp();
            *field(i) = check_from_bits(bits[k]);
            TEST_ASSERT_EQUAL_INT(GOE_DECISION_KEEP, decide());
            CHECK_SAME(0.0f, hazard.conflict_probability);
            CHECK_SAME(0.0f, hazard.tcpa_s);
        }
    }
    setUp();
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_KEEP, goe_decide(&estimator, NULL, &rule, &hazard));
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_KEEP, goe_decide(NULL, &intent, &rule, &hazard));
    broken = estimator;
    broken.settings.navigation.terrain_height_sd_m += 1.0f;
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_KEEP, goe_decide(&broken, &intent, &rule, &hazard));
    memset(&broken, 0, sizeof broken);
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_KEEP, goe_decide(&broken, &intent, &rule, &hazard));
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_ACT, goe_decide(&estimator, &intent, &rule, NULL));
}

/* GIVEN no rule THEN it is the default one, which goe.h states. */
static void no_rule_is_the_default(void) {
    const goe_rule_t zero = {0.0f, 0.0f, 0.0f, 0.0f};
    CHECK_SAME(0.1f, rule.conflict_probability_max);
    CHECK_SAME(12.0f, rule.act_within_s);
    CHECK_SAME(1.5f, rule.suspect_factor);
    CHECK_SAME(1.0f, rule.stale_growth_m_s);
    goe_rule_default(NULL);
    for (double aside = -60.0; aside <= 60.0; aside += 1.5) {
        place(aside);
        TEST_ASSERT_EQUAL_INT(decide(), goe_decide(&estimator, &intent, NULL, NULL));
    }
    rule = zero; /* a doubt of 0 would narrow */
    TEST_ASSERT_EQUAL_INT(GOE_DECISION_KEEP, decide());
}

/* [goe_decide, goe_rule_t.suspect_factor] GIVEN distances at the end of their range THEN doubt and age do not push them out of it. */
static void the_widest_distances_are_taken(void) {
    intent.margin_m = intent.clearance_m = 1.0e4f;
    estimator.estimate.suspect = true;
    intent.since_image_s = 1.0e3f;
    rule.stale_growth_m_s = 100.0f;
    TEST_ASSERT_TRUE(decide() != GOE_DECISION_KEEP);
}

/* GIVEN times and their sigmas THEN the soonest is the time less two small sigmas, half of it for a sigma of half of it, 0 of 0, and never
 * later for a larger sigma. */
static void the_soonest_time_is_early(void) {
    memset(&hazard, 0, sizeof hazard);
    CHECK_SAME(0.0f, goe_earliest_tcpa_s(&hazard));
    CHECK_SAME(0.0f, goe_earliest_tcpa_s(NULL));
    hazard.tcpa_s = 10.0f;
    hazard.tcpa_sd_s = 0.05f;
    CHECK_CLOSE(2.0e-3, 9.9, goe_earliest_tcpa_s(&hazard));
    hazard.tcpa_sd_s = 5.0f;
    CHECK_CLOSE(1.0e-6, 5.0, goe_earliest_tcpa_s(&hazard));
    float before = 10.0f;
    for (int i = 0; i < 100; i++) {
        hazard.tcpa_sd_s = 0.3f * (float)i;
        TEST_ASSERT_TRUE(goe_earliest_tcpa_s(&hazard) <= before && goe_earliest_tcpa_s(&hazard) > 0.0f);
        before = goe_earliest_tcpa_s(&hazard);
    }
    hazard.tcpa_sd_s = check_from_bits(0x7FC00000u);
    CHECK_SAME(0.0f, goe_earliest_tcpa_s(&hazard));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(probability_and_time_decide);
    RUN_TEST(a_poorly_known_obstacle_is_not_clear);
    RUN_TEST(an_old_answer_clears_nothing_after_new_detections);
    RUN_TEST(a_wrong_position_clears_nothing);
    RUN_TEST(a_silent_camera_clears_nothing);
    RUN_TEST(what_goes_on_toward_the_course_is_not_clear);
    RUN_TEST(ahead_is_along_the_course);
    RUN_TEST(a_passed_middle_clears_no_cut_end_in_view);
    RUN_TEST(a_creeping_aircraft_without_images_acts);
    RUN_TEST(the_largest_margin_is_none_too_large);
    RUN_TEST(a_violation_at_a_creeping_speed_is_one_of_now);
    RUN_TEST(a_descent_next_to_a_roof_is_foreseen);
    RUN_TEST(within_the_margin_of_a_wide_obstacle_the_rule_acts);
    RUN_TEST(a_widened_margin_counts_at_every_speed);
    RUN_TEST(doubt_and_age_widen);
    RUN_TEST(a_refused_image_moves_the_aircraft_on);
    RUN_TEST(without_a_position_nothing_is_known);
    RUN_TEST(every_failure_keeps_the_decision);
    RUN_TEST(no_rule_is_the_default);
    RUN_TEST(the_widest_distances_are_taken);
    RUN_TEST(the_soonest_time_is_early);
    return UNITY_END();
}
