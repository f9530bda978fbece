/* The effect of time alone on the estimate: images without a detection. SPDX-License-Identifier: MIT */
/* tests: lib/refined/goe_filter.c */
#include <math.h>
#include <string.h>

#include "check.h"
#include "refined/goe_filter.h"
#include "scene.h"

#define RAD_PER_DEG 0.017453292519943295
#define DRIFT_DEG 0.2
#define WALK_M 0.5

static scene_t scene;
static goe_estimator_t estimator;
static goe_estimate_t estimate;
static goe_image_t last;

void setUp(void) {
    scene_default(&scene);
    goe_settings_t settings = scene_settings(&scene);
    settings.navigation.attitude_walk_sd_deg = (float)DRIFT_DEG;
    settings.navigation.position_walk_sd_m = (float)WALK_M;
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
    for (int k = 0; k < 40; k++) {
        scene_image(&scene, k, &last, NULL);
        (void)goe_update(&estimator, &last, &estimate);
    }
    TEST_ASSERT_TRUE(estimate.fresh && estimator.filter.phase != GOE_PHASE_NONE);
}
void tearDown(void) {}

/* An image without a detection, from the same position, that much later. */
static void wait_s(double s) {
    scene_hide_points(&last);
    last.pose.time_us += (int64_t)(s * 1.0e6);
    (void)goe_update(&estimator, &last, &estimate);
}

/* With the noise that is due by now, as the rows of the next image would find it. */
static double variance(goe_state_index_t state) {
    goe_filter_t filter = estimator.filter;
    goe_filter_age(&filter, &estimator.settings.navigation, 0.0f);
    return (double)goe_filter_variance(&filter, state);
}

/* GIVEN an attitude whose error walks WHEN it has for four seconds THEN the uncertainty of each axis is twice that after one, not
 * four times; and the gate, which uses the earlier state, takes it into account. */
static void the_attitude_drifts_with_the_root_of_time(void) {
    static const goe_state_index_t axes[] = {GOE_BIAS_X, GOE_BIAS_Y, GOE_BIAS_Z};
    double before[3];
    for (size_t i = 0; i < 3; i++) {
        before[i] = variance(axes[i]);
    }
    const double due = (double)goe_filter_due_drift2(&estimator.filter, &estimator.settings.navigation);
    wait_s(4.0);
    const double drift = 4.0 * DRIFT_DEG * RAD_PER_DEG * DRIFT_DEG * RAD_PER_DEG;
    for (size_t i = 0; i < 3; i++) {
        CHECK_CLOSE(2.0e-3 * drift, before[i] + drift, variance(axes[i]));
    }
    CHECK_CLOSE(2.0e-3 * drift, due + drift, goe_filter_due_drift2(&estimator.filter, &estimator.settings.navigation));
}

/* GIVEN an own position that walks THEN the place becomes uncertain along X and Z in turn, each time for as long as it has not, and
 * none of the time is lost or counted twice. */
static void the_own_position_walks_along_both_axes_in_turn(void) {
    const goe_navigation_t *navigation = &estimator.settings.navigation;
    goe_filter_t *filter = &estimator.filter;
    const double q = (double)filter->state[GOE_INVERSE_RANGE];
    const double second = WALK_M * WALK_M * q * q; /* of walking, in units of Z0 */
    double walked[2] = {(double)filter->walk_s[0], (double)filter->walk_s[1]};
    for (int n = 0; n < 6; n++) {
        const double x = variance(GOE_BEARING);
        const double z = variance(GOE_INVERSE_RANGE);
        const double a = (double)filter->state[GOE_BEARING];
        walked[0] += 3.0;
        walked[1] += 3.0;
        const int axis = walked[1] > walked[0] ? 1 : 0;
        goe_filter_wait(filter, 3.0f);
        CHECK_CLOSE(1.0e-3 * second, 3.0 * second, goe_filter_due_walk2(filter, navigation));
        goe_filter_age(filter, navigation, 3.0f);
        CHECK_SAME(0.0f, goe_filter_due_walk2(filter, navigation));
        const double added = second * walked[axis];
        walked[axis] = 0.0;
        if (axis == 0) {
            CHECK_CLOSE(5.0e-3 * added, x + added, variance(GOE_BEARING));
            CHECK_CLOSE(1.0e-3 * z, z, variance(GOE_INVERSE_RANGE));
        } else { /* all lengths in units of Z0 */
            CHECK_CLOSE(5.0e-3 * added * a * a + 2.0e-4 * x, x + added * a * a, variance(GOE_BEARING));
            CHECK_CLOSE(2.0e-2 * added * q * q, z + added * q * q, variance(GOE_INVERSE_RANGE));
        }
        CHECK_CLOSE(1.0e-4, walked[0], filter->walk_s[0]);
        CHECK_CLOSE(1.0e-4, walked[1], filter->walk_s[1]);
    }
}

/* GIVEN images without a detection THEN the root stays that of the latest rows, and the next rows find the place uncertain along both
 * axes by the whole time. */
static void the_walk_waits_for_rows(void) {
    const double q = (double)estimator.filter.state[GOE_INVERSE_RANGE];
    const double second = WALK_M * WALK_M * q * q;
    const goe_triangle_t before = estimator.filter.root;
    const double walked = (double)estimator.filter.walk_s[1]; /* along Z */
    const double z = variance(GOE_INVERSE_RANGE);
    const double due = (double)goe_filter_due_walk2(&estimator.filter, &estimator.settings.navigation);
    TEST_ASSERT_TRUE(due == 0.0);
    wait_s(3.0);
    wait_s(2.0);
    TEST_ASSERT_EQUAL_MEMORY(before.element, estimator.filter.root.element, sizeof before.element);
    CHECK_CLOSE(1.0e-3 * second, 5.0 * second, goe_filter_due_walk2(&estimator.filter, &estimator.settings.navigation));
    goe_filter_t filter = estimator.filter;
    goe_filter_age(&filter, &estimator.settings.navigation, 2.0f);
    CHECK_SAME(0.0f, filter.walk_s[0]);
    CHECK_SAME(0.0f, filter.walk_s[1]);
    const double added = second * (5.0 + walked) * q * q;
    CHECK_CLOSE(2.0e-2 * added, z + added, goe_filter_variance(&filter, GOE_INVERSE_RANGE));
}

/* GIVEN a gap of a day THEN it counts as a thousand seconds, and all stays finite. */
static void a_long_gap_counts_as_a_bounded_one(void) {
    const double before = variance(GOE_BIAS_X);
    wait_s(86400.0);
    const double drift = 1000.0 * DRIFT_DEG * RAD_PER_DEG * DRIFT_DEG * RAD_PER_DEG;
    CHECK_CLOSE(1.0e-2 * drift, before + drift, variance(GOE_BIAS_X));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(the_attitude_drifts_with_the_root_of_time);
    RUN_TEST(the_own_position_walks_along_both_axes_in_turn);
    RUN_TEST(the_walk_waits_for_rows);
    RUN_TEST(a_long_gap_counts_as_a_bounded_one);
    return UNITY_END();
}
