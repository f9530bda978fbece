/* Collision courses with an obstacle that moves. SPDX-License-Identifier: MIT */
/* tests: lib/refined/goe_growth.c lib/refined/goe_mover.c */
#include <math.h>

#include "check.h"
#include "drawn.h"
#include "goe.h"
#include "scene.h"

#define FLIGHTS 500
#define SURE_S 5.0 /* before the near side, from which on nothing may be "clear" ... */
#define LATE_S 1.0 /* ... until here: an order that ends then changes nothing */
#define MOST 375   /* flights in which the motion is followed before the warning's time is over */
#define FEW 6      /* ... in which nothing moves, and a motion is followed nevertheless */
#define TURN 6.283185307179586

static scene_t scene;

void setUp(void) {}
void tearDown(void) {}

typedef struct {
    double first_s; /* ahead of the near side at the first warning; negative: none */
    bool cleared;   /* between SURE_S and LATE_S */
    bool followed;  /* a velocity was reported */
} flown_t;

/* The flight of the scene is that relative to the obstacle, which moves by the given velocity. */
static flown_t fly(drawn_t drawn, check_random_t any, const double velocity_m_s[2]) {
    flown_t flown = {-1.0, false, false};
    goe_settings_t settings = scene_settings(&scene);
    goe_estimator_t estimator;
    const goe_intent_t intent = {
        {(float)(scene.speed_mps + velocity_m_s[0]), (float)velocity_m_s[1], 0.0f}, 15.0f, 10.0f, 0.0f, 0.0f};
    settings.detector.box_noise_rel = (float)drawn.box_share;
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
    for (int k = 0; drawn_left_s(&scene, k) > LATE_S; k++) {
        goe_image_t image;
        goe_estimate_t estimate;
        const double left_s = drawn_left_s(&scene, k);
        drawn_image(&drawn, &scene, &any, k, &image);
        for (int i = 0; i < 2; i++) {
            image.pose.position_ned_m[i] += (float)(velocity_m_s[i] * k / DRAWN_RATE_HZ);
        }
        (void)goe_update(&estimator, &image, &estimate);
        const goe_decision_t decision = goe_decide(&estimator, &intent, NULL, NULL);
        flown.followed = flown.followed || (estimate.valid & GOE_HAS_VELOCITY) != 0u;
        flown.cleared = flown.cleared || (decision == GOE_DECISION_CLEAR && left_s < SURE_S);
        flown.first_s = decision == GOE_DECISION_ACT && flown.first_s < 0.0 ? left_s : flown.first_s;
    }
    return flown;
}

/* Flights by boxes without a warning in time; of all of them `cleared` had a "clear", and `followed` a velocity. */
static int unwarned(const char *what, double slowest_m_s, double fastest_m_s, int *cleared, int *followed) {
    check_random_t any = check_random_start(what);
    int late = 0;
    for (int n = 0; n < FLIGHTS; n++) {
        drawn_t drawn = drawn_flight(&scene, &any);
        drawn.boxes = true;
        const double speed_m_s = check_random_between(&any, slowest_m_s, fastest_m_s);
        const double course = check_random_between(&any, 0.0, TURN);
        const double velocity_m_s[2] = {speed_m_s * cos(course), speed_m_s * sin(course)};
        const flown_t flown = fly(drawn, any, velocity_m_s);
        late += flown.first_s < DRAWN_AHEAD_S ? 1 : 0;
        *cleared += flown.cleared ? 1 : 0;
        *followed += flown.followed ? 1 : 0;
    }
    check_report("flights without a warning in time", late);
    check_report("flights with a \"clear\"", *cleared);
    check_report("flights that follow a motion", *followed);
    return late;
}

/* [GOE_WITH_TARGET_MOTION, (R34), (R35)] GIVEN a collision course with an obstacle that moves: it keeps its direction, and grows THEN the
 * warning comes in time, and no "clear" takes it back. Without the growth, the obstacle seems to be far away: 13 of these 500 flights have
 * no warning in time, and 15 a "clear". */
static void a_constant_direction_hides_no_motion(void) {
    int cleared = 0;
    int followed = 0;
    TEST_ASSERT_EQUAL_INT(0, unwarned("movers", 1.0, 6.0, &cleared, &followed));
    TEST_ASSERT_EQUAL_INT(0, cleared);
    TEST_ASSERT_TRUE(followed > MOST);
}

/* [GOE_REASON_MOVES] GIVEN an obstacle that stands still THEN the growth does not say that it moves, and the warning comes in time. */
static void nothing_that_stands_still_outgrows_its_range(void) {
    int cleared = 0;
    int followed = 0;
    TEST_ASSERT_EQUAL_INT(0, unwarned("nothing moves", 0.0, 0.0, &cleared, &followed));
    TEST_ASSERT_EQUAL_INT(0, cleared);
    TEST_ASSERT_TRUE(followed < FEW);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(a_constant_direction_hides_no_motion);
    RUN_TEST(nothing_that_stands_still_outgrows_its_range);
    return UNITY_END();
}
