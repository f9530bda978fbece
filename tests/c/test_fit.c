/* Window least squares: exact data, failures, sliding. SPDX-License-Identifier: MIT
 * Against the dense system and for its sigmas: test_double_window.c. */
/* tests: lib/window/goe_fit.c */
#include <string.h>

#include "check.h"
#include "window/goe_fit.h"

#define LENGTH 8
#define MIN_BASELINE_M 0.1f

static goe_fit_ring_t window;
static goe_estimate_t fit;

void setUp(void) {
    memset(&window, 0, sizeof window);
    memset(&fit, 0xA5, sizeof fit);
}
void tearDown(void) {}

/* What an obstacle of width w at (x, z) from the track's first image gives from (dx, dz). */
static void add(float x, float z, float w, float dx, float dz) {
    goe_fit_add(&window, LENGTH, dx, dz, (goe_row_t){(x - dx) / w, (z - dz) / w});
}

static goe_status_t solve(void) { return goe_fit_solve(&window, LENGTH, MIN_BASELINE_M, &fit); }

static void check_failure(goe_status_t expected) {
    goe_estimate_t untouched;
    memset(&untouched, 0xA5, sizeof untouched);
    CHECK_STATUS(expected, solve());
    TEST_ASSERT_EQUAL_MEMORY(&untouched, &fit, sizeof fit);
}

/* [(5)] */
static void exact_rows_are_solved_exactly(void) {
    for (int k = 0; k < LENGTH; k++) {
        add(-12.0f, 150.0f, 2.5f, 0.25f * (float)k, 2.0f * (float)k);
    }
    CHECK_STATUS(GOE_OK, solve());
    TEST_ASSERT_FLOAT_WITHIN(2.5e-5f, 2.5f, fit.width_m);
    TEST_ASSERT_FLOAT_WITHIN(1.2e-4f, -12.0f, fit.x0_m);
    TEST_ASSERT_FLOAT_WITHIN(1.5e-3f, 150.0f, fit.z0_m);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-4f, 13.0623f, fit.baseline_m); /* sqrt(42 (2^2 + 0.25^2)) */
    TEST_ASSERT_FLOAT_WITHIN(1.0e-4f, 0.0f, fit.residual);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-3f, 0.0f, fit.sigma.width_m);
}

/* [(5)] The slope is shared: lateral motion alone determines the width as well as motion ahead. */
static void motion_aside_is_a_baseline_too(void) {
    for (int k = 0; k < LENGTH; k++) {
        add(30.0f, 100.0f, 6.0f, (float)k - 3.0f, 0.0f);
    }
    CHECK_STATUS(GOE_OK, solve());
    TEST_ASSERT_FLOAT_WITHIN(6.0e-4f, 6.0f, fit.width_m);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-2f, 100.0f, fit.z0_m);
}

static void no_motion_is_no_baseline(void) {
    for (int k = 0; k < LENGTH; k++) {
        add(-12.0f, 150.0f, 2.5f, 5.0f, 7.0f);
    }
    check_failure(GOE_NO_BASELINE);
}

/* [goe_estimate_t.baseline_m, window.min_baseline_m]
 * Root of the summed squared spread, 6.48074 for unit steps, just below and just above the limit. */
static void the_baseline_limit_is_where_it_is_said_to_be(void) {
    for (int above = 0; above < 2; above++) {
        const float step = above ? 0.0155f : 0.0154f;
        setUp();
        for (int k = 0; k < LENGTH; k++) {
            add(1.0f, 10.0f, 2.0f, 0.0f, step * (float)k);
        }
        if (above) {
            CHECK_STATUS(GOE_OK, solve());
        } else {
            check_failure(GOE_NO_BASELINE);
        }
    }
}

static void an_image_that_does_not_grow_is_no_parallax(void) {
    for (int k = 0; k < LENGTH; k++) { /* very far away: 1/W = 0 */
        goe_fit_add(&window, LENGTH, 0.0f, 2.0f * (float)k, (goe_row_t){1.0f, 60.0f});
    }
    check_failure(GOE_NO_PARALLAX);
}

/* [window.min_baseline_m] */
static void an_image_that_shrinks_is_no_parallax(void) {
    for (int k = 0; k < LENGTH; k++) { /* it flies ahead, faster than we do */
        goe_fit_add(&window, LENGTH, 0.0f, 2.0f * (float)k, (goe_row_t){1.0f, 60.0f + (float)k});
    }
    check_failure(GOE_NO_PARALLAX);
}

static void growth_below_the_rounding_of_floats_is_no_parallax(void) {
    for (int k = 0; k < LENGTH; k++) { /* one unit in the last place: Z0 = 9e5 m and W = 1.4e4 m, if it were believed */
        const float zeta = k < 6 ? check_next_away(64.0f) : 64.0f;
        goe_fit_add(&window, LENGTH, 0.0f, 0.0156f * (float)k, (goe_row_t){1.0f, zeta});
    }
    check_failure(GOE_NO_PARALLAX);
}

static void an_obstacle_abeam_or_behind_is_passed(void) {
    for (int k = 0; k < LENGTH; k++) { /* Z runs from 5 to -9 */
        add(20.0f, 5.0f, 4.0f, 0.0f, 2.0f * (float)k);
    }
    check_failure(GOE_ABEAM);
    setUp();
    for (int k = 0; k < LENGTH; k++) { /* still 1 m ahead at the last image */
        add(20.0f, 15.0f, 4.0f, 0.0f, 2.0f * (float)k);
    }
    CHECK_STATUS(GOE_OK, solve());
}

/* [window.min_baseline_m] */
static void an_excessive_range_is_no_parallax(void) {
    for (int k = 0; k < LENGTH; k++) { /* W = 2e6 m, and the camera moves 1e6 m: above the rounding limit */
        goe_fit_add(&window, LENGTH, 0.0f, 1.0e6f * (float)k, (goe_row_t){0.0f, 10.0f - 0.5f * (float)k});
    }
    check_failure(GOE_NO_PARALLAX);
}

/* [(5)] GIVEN an obstacle that was elsewhere before WHEN the window is full of new rows THEN nothing of the old is left. */
static void the_oldest_rows_leave(void) {
    for (int k = 0; k < 5; k++) {
        add(50.0f, 90.0f, 20.0f, 0.0f, 1.5f * (float)k);
    }
    for (int k = 0; k < LENGTH; k++) {
        add(-12.0f, 150.0f, 2.5f, 0.0f, 2.0f * (float)(k + 5));
        if (k == LENGTH - 2) {
            TEST_ASSERT_TRUE(solve() != GOE_OK || fit.residual > 0.1f); /* one old row is still in it */
        }
    }
    CHECK_STATUS(GOE_OK, solve());
    TEST_ASSERT_FLOAT_WITHIN(1.0e-4f, 2.5f, fit.width_m);
    TEST_ASSERT_FLOAT_WITHIN(5.0e-3f, 150.0f, fit.z0_m);
    TEST_ASSERT_EQUAL_INT(13, window.count);
}

/* GIVEN a place in the ring that a flipped bit made invalid THEN nothing is written outside of it, and the ring continues. */
static void a_place_outside_the_ring_is_its_first(void) {
    static const int16_t places[] = {INT16_MIN, -1, LENGTH, INT16_MAX};
    for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
        struct {
            goe_fit_ring_t before, ring, behind;
        } memory;
        memset(&memory, 0, sizeof memory);
        const goe_fit_ring_t nothing = memory.before;
        memory.ring.next = places[i];
        goe_fit_add(&memory.ring, LENGTH, 2.0f, 3.0f, (goe_row_t){4.0f, 5.0f});
        TEST_ASSERT_EQUAL_MEMORY(&nothing, &memory.before, sizeof nothing);
        TEST_ASSERT_EQUAL_MEMORY(&nothing, &memory.behind, sizeof nothing);
        TEST_ASSERT_EQUAL_FLOAT(2.0f, memory.ring.point[0].dx_m);
        TEST_ASSERT_EQUAL_INT(1, memory.ring.next);
    }
}

static void the_count_of_points_saturates(void) {
    window.count = INT16_MAX - 1;
    add(1.0f, 10.0f, 1.0f, 0.0f, 0.0f);
    add(1.0f, 10.0f, 1.0f, 0.0f, 0.0f);
    TEST_ASSERT_EQUAL_INT(INT16_MAX, window.count);
}

/* [(5)] GIVEN a window of three in the room for more THEN only three rows count. */
static void a_shorter_window_uses_its_own_length(void) {
    for (int k = 0; k < 7; k++) {
        const float wrong = k < 4 ? 9.0f : 0.0f;
        goe_fit_add(&window, 3, 0.0f, (float)k, (goe_row_t){1.0f + wrong, (50.0f - (float)k) / 2.0f});
    }
    CHECK_STATUS(GOE_OK, goe_fit_solve(&window, 3, MIN_BASELINE_M, &fit));
    TEST_ASSERT_FLOAT_WITHIN(1.0e-4f, 2.0f, fit.width_m);
    TEST_ASSERT_FLOAT_WITHIN(1.0e-4f, 2.0f, fit.x0_m);
    TEST_ASSERT_EQUAL_FLOAT(0.0f, window.point[3].dz_m);
}

/* [A32] Whatever the residuals, a sigma is finite. */
static void hopeless_rows_have_a_finite_sigma(void) {
    for (int k = 0; k < LENGTH; k++) {
        const float wild = k % 2 == 0 ? 4.0e6f : -4.0e6f;
        goe_fit_add(&window, LENGTH, wild, 1.0e-2f * (float)k, (goe_row_t){-0.5f * wild, 2.0e5f});
    }
    CHECK_STATUS(GOE_OK, solve());
    TEST_ASSERT_TRUE(check_is_finite(fit.sigma.x0_m) && check_is_finite(fit.sigma.z0_m) &&
                     check_is_finite(fit.sigma.width_m) && check_is_finite(fit.residual));
}

/* GIVEN a wide obstacle whose X jumps from row to row by far more than any image shows THEN its sigma stops where squares and
 * products of it are still finite. */
static void a_sigma_is_bounded(void) {
    for (int k = 0; k < LENGTH; k++) {
        const float ahead_m = 1000.0f * (float)k;
        goe_fit_add(&window, LENGTH, 0.0f, ahead_m,
                    (goe_row_t){k % 2 ? 1.0e6f : -1.0e6f, (5.0e5f - ahead_m) * 1.0e-5f});
    }
    CHECK_STATUS(GOE_OK, solve());
    TEST_ASSERT_FLOAT_WITHIN(1.0e3f, 1.0e5f, fit.width_m);
    TEST_ASSERT_EQUAL_FLOAT(1.0e9f, fit.sigma.x0_m);
    TEST_ASSERT_TRUE(fit.sigma.z0_m > 0.0f && check_is_finite(fit.sigma.z0_m * fit.sigma.z0_m));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(exact_rows_are_solved_exactly);
    RUN_TEST(motion_aside_is_a_baseline_too);
    RUN_TEST(no_motion_is_no_baseline);
    RUN_TEST(the_baseline_limit_is_where_it_is_said_to_be);
    RUN_TEST(an_image_that_does_not_grow_is_no_parallax);
    RUN_TEST(an_image_that_shrinks_is_no_parallax);
    RUN_TEST(growth_below_the_rounding_of_floats_is_no_parallax);
    RUN_TEST(an_obstacle_abeam_or_behind_is_passed);
    RUN_TEST(an_excessive_range_is_no_parallax);
    RUN_TEST(the_oldest_rows_leave);
    RUN_TEST(a_place_outside_the_ring_is_its_first);
    RUN_TEST(the_count_of_points_saturates);
    RUN_TEST(a_shorter_window_uses_its_own_length);
    RUN_TEST(hopeless_rows_have_a_finite_sigma);
    RUN_TEST(a_sigma_is_bounded);
    return UNITY_END();
}
