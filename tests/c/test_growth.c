/* Growth beyond what a range lets an obstacle have. SPDX-License-Identifier: MIT */
#include "refined/goe_growth.h"

#include <fenv.h>
#include <math.h>
#include <string.h>

#include "check.h"
#include "refined/goe_footprint.h"
#include "sighting.h"

#define WIDTH 0.2  /* of the obstacle that is predicted, focal lengths at Z0 */
#define HEIGHT 0.3 /* the same */
#define SHARE 0.05
#define PIXEL 0.001

static check_random_t any;
static sighting_t sighting;
static goe_sides_t sides;

void setUp(void) {}
void tearDown(void) {}

/* A level camera at the given Z before the obstacle, units of Z0, whose box is as predicted but for a factor. */
static void see(double ahead, double wider, double taller) {
    static const float level[9] = {1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f};
    const goe_camera_t *camera = &sighting.settings.camera;
    any = check_random_start("growth");
    sighting_start(&sighting, &any);
    memset(sighting.state, 0, sizeof sighting.state);
    memcpy(sighting.sight.camera_to_axes, level, sizeof level);
    sighting.state[GOE_INVERSE_RANGE] = 0.01f;
    sighting.state[GOE_HALF] = (float)(0.5 * WIDTH);
    sighting.state[GOE_LOG_DEPTH] = -20.0f; /* a sheet: its ends are where it is */
    sighting.state[GOE_TOP] = (float)(HEIGHT - 0.1);
    sighting.state[GOE_GROUND] = 0.1f;
    sighting.sight.camera_m.x = 0.0f;
    sighting.sight.camera_m.z = (float)(100.0 * (1.0 - ahead));
    sighting.sight.height_m = 0.0f;
    sighting.sight.range_variance = 0.0f;
    sighting.sight.elapsed_s = 0.0f;
    sighting.sight.sides = &sides;
    sighting.settings.detector.box_noise_rel = (float)SHARE;
    sighting.sight.side_px = (float)PIXEL * camera->fx_px;
    sighting_look(&sighting);
    const double half[2] = {0.5 * WIDTH * wider / ahead, 0.5 * HEIGHT * taller / ahead};
    const double middle[2] = {0.0, (0.1 - 0.5 * HEIGHT) / ahead};
    for (size_t side = 0; side < GOE_BOX_SIDES; side++) {
        const size_t axis = side & 1u;
        const double at = middle[axis] + (side < 2u ? -half[axis] : half[axis]);
        sides.px[side] = (float)(at * (double)(axis == 1u ? camera->fy_px : camera->fx_px) +
                                 (double)(axis == 1u ? camera->cy_px : camera->cx_px));
    }
    sides.usable = GOE_SIDES_ALL;
    sides.cut = 0;
    sides.truncated = false;
    sides.doubtful = 0;
}

static double growth(void) {
    sighting_clear_rows(&sighting);
    goe_footprint_rows(&sighting.sight, &sighting.rows);
    return (double)goe_growth_find(&sighting.sight, &sighting.rows);
}

/* [(R34)] GIVEN a box that is larger than predicted THEN its excess counts in sigmas of the detector's errors, of the range, of the own path and of the
 * rows: the height's, or the width's where a level side is missing; one that is smaller, or as predicted, is none. */
static void an_excess_counts_in_sigmas(void) {
    static const double factors[] = {0.5, 0.9, 1.0, 1.1, 1.5, 3.0};
    for (size_t n = 0; n < sizeof factors / sizeof factors[0]; n++) {
        for (int wide = 0; wide < 2; wide++) {
            const double extent = wide == 1 ? WIDTH : HEIGHT;
            see(0.8, wide == 1 ? factors[n] : 1.0, wide == 1 ? 1.0 : factors[n]);
            sides.usable = wide == 1 ? GOE_SIDE_LEFT | GOE_SIDE_RIGHT | GOE_SIDE_BOTTOM : GOE_SIDES_ALL;
            sighting.sight.range_variance = 1.0e-6f; /* (0.1 of 1/Z0)^2, after 20 m: 0.025 of Z now */
            sighting.settings.navigation.velocity_bias_sd_m_s = 0.3f;
            sighting.sight.elapsed_s = 10.0f * (float)(n % 3u);
            const double drift = 3.0 * (double)(n % 3u) / 80.0;
            const double found = growth();
            const double size = factors[n] * extent / 0.8;
            const double excess = fmax((factors[n] - 1.0) * extent / 0.8, 0.0);
            const double own =
                (double)sighting.rows.variance[wide == 1 ? 0 : 1] + (double)sighting.rows.variance[wide == 1 ? 1 : 3];
            const double variance = (2.0 * SHARE * SHARE + 0.025 * 0.025 + drift * drift) * size * size + own;
            const double expected = excess * excess / variance;
            CHECK_CLOSE(0.02 * expected + 1.0e-3, expected, found);
        }
    }
}

/* [(R34)] GIVEN an obstacle that is near, or whose line of sight may have turned, THEN nothing counts. GIVEN one of which one end is
 * missing THEN the image says nothing. */
static void what_cannot_be_compared_is_no_growth(void) {
    see(0.72, 2.0, 2.0);
    TEST_ASSERT_TRUE(growth() > 9.0);
    see(0.68, 2.0, 2.0);
    CHECK_SAME(0.0f, (float)growth());
    see(0.9, 2.0, 2.0);
    sides.usable = GOE_SIDE_LEFT | GOE_SIDE_TOP;
    CHECK_SAME(GOE_GROWTH_UNSEEN, (float)growth());
    sides.usable = 0u;
    CHECK_SAME(GOE_GROWTH_UNSEEN, (float)growth());
}

/* [(R34)] GIVEN an obstacle whose reference point is exactly at the camera, with Z = 0, THEN nothing counts, and nothing is divided by 0. */
static void an_obstacle_at_the_camera_is_no_growth(void) {
    see(0.9, 2.0, 2.0);
    sighting_clear_rows(&sighting);
    goe_footprint_rows(&sighting.sight, &sighting.rows);
    sighting.sight.camera_m.z = 1.0f / sighting.state[GOE_INVERSE_RANGE];
    CHECK_SAME(0.0f, goe_observation_reference(&sighting.sight).z);
    (void)feclearexcept(FE_ALL_EXCEPT);
    CHECK_SAME(0.0f, goe_growth_find(&sighting.sight, &sighting.rows));
    TEST_ASSERT_EQUAL_INT(0, fetestexcept(FE_DIVBYZERO | FE_INVALID));
}

/* [(R34)] GIVEN a cut box THEN a size does not count that the border has made: its error is that of a cut one. A cut at the left or the
 * right does not change a height whose ends are in the image. */
static void a_size_that_the_border_made_is_no_growth(void) {
    const unsigned upright[] = {GOE_SIDE_LEFT, GOE_SIDE_RIGHT};
    for (size_t i = 0; i < 2; i++) {
        see(0.9, 1.0, 2.0);
        TEST_ASSERT_TRUE(growth() > 9.0);
        const double uncut = growth();
        sides.truncated = true;
        sides.cut = (uint8_t)upright[i];
        CHECK_CLOSE(1.0e-4 * uncut, uncut, growth());
        sides.cut = (uint8_t)(upright[i] | GOE_SIDE_TOP);
        TEST_ASSERT_TRUE(growth() < 1.0);
        sides.cut = GOE_SIDE_BOTTOM; /* of a camera that is rolled */
        TEST_ASSERT_TRUE(growth() < 1.0);
        see(0.9, 2.0, 1.0);
        sides.usable = GOE_SIDE_LEFT | GOE_SIDE_RIGHT;
        TEST_ASSERT_TRUE(growth() > 9.0);
        sides.truncated = true;
        sides.cut = (uint8_t)upright[i];
        TEST_ASSERT_TRUE(growth() < 1.0);
    }
}

/* [(R34)] GIVEN left and right as points THEN the width counts, as that of a box. */
static void points_show_the_width(void) {
    goe_point_t *left = &sighting.sight.point[GOE_POINT_LEFT];
    goe_point_t *right = &sighting.sight.point[GOE_POINT_RIGHT];
    for (int larger = 0; larger < 2; larger++) {
        see(0.8, 1.0, 1.0);
        sides.usable = 0u;
        const float half = (float)(0.5 * WIDTH / 0.8 * (larger == 1 ? 1.8 : 1.0));
        memset(sighting.sight.point, 0, sizeof sighting.sight.point);
        left->x = -half;
        right->x = half;
        left->usable = right->usable = true;
        TEST_ASSERT_TRUE(larger == 1 ? growth() > 9.0 : growth() < 0.1);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(an_excess_counts_in_sigmas);
    RUN_TEST(what_cannot_be_compared_is_no_growth);
    RUN_TEST(an_obstacle_at_the_camera_is_no_growth);
    RUN_TEST(a_size_that_the_border_made_is_no_growth);
    RUN_TEST(points_show_the_width);
    return UNITY_END();
}
