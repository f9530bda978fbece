/* A footprint by upright boxes: rows against the extremes of its rims in double, start, errors of the sides.
 * SPDX-License-Identifier: MIT */
/* tests: lib/refined/goe_footprint.c */
#include "refined/goe_footprint.h"

#include <math.h>
#include <string.h>

#include "check.h"
#include "maths/goe_scalar.h"
#include "refined/goe_footprint_start.h"
#include "scene.h"
#include "upright.h"

#define CASES 100
#define SLENDER 400
#define FEW 5 /* brute force is slow where double precision is emulated */
#define RIM_POINTS 60
#define TWO_PI 6.283185307179586
#define STEP 1.0e-5

static const size_t feature_of_side[] = {GOE_POINT_LEFT, GOE_POINT_TOP, GOE_POINT_RIGHT, GOE_POINT_BASE_NEAR};

static check_random_t any;
static sighting_t sighting;
static goe_sides_t sides;
static bool by_kind; /* the start took the range of the class */

void setUp(void) {}
void tearDown(void) {}

/* ---------------------------------------------------------------------------------------------------------- reference -- */

/* Of the rims of an ellipse that may turn. */
static void rim_point(const double state[GOE_STATES], size_t side, double at, bool foot, double point[3]) {
    const double q = state[GOE_INVERSE_RANGE];
    const double h = (double)sighting.sight.height_m;
    const double half = state[GOE_HALF];
    const double depth = half * exp(state[GOE_LOG_DEPTH]);
    (void)side;
    point[0] = state[GOE_BEARING] - (double)sighting.sight.camera_m.x * q + half * sin(at);
    point[1] = foot ? h * q + state[GOE_GROUND] : h * q - state[GOE_TOP];
    point[2] = 1.0 - (double)sighting.sight.camera_m.z * q + state[GOE_SHEAR] * sin(at) + depth * cos(at);
}

static const upright_t ellipse = {&sighting, rim_point, RIM_POINTS, true, STEP};

/* -------------------------------------------------------------------------------------------------------------- input -- */

static void any_footprint(double truth[GOE_STATES]) {
    const double z0_m = sighting_place(&sighting, &any);
    upright_roll(&sighting, check_random_between(&any, -3.1, 3.1));
    sighting.state[GOE_BEARING] = (float)check_random_between(&any, -0.3, 0.3);
    sighting.state[GOE_GROUND] = (float)(check_random_between(&any, -1.0, 1.0) / z0_m);
    sighting.state[GOE_HALF] = (float)(check_random_between(&any, 0.5, 12.0) / z0_m);
    sighting.state[GOE_SHEAR] = sighting.state[GOE_HALF] * (float)check_random_between(&any, -1.2, 1.2);
    sighting.state[GOE_LOG_DEPTH] = (float)check_random_between(&any, -1.0, 1.0);
    sighting.state[GOE_TOP] = (float)(check_random_between(&any, 2.0, 60.0) / z0_m);
    sighting.sight.height_m = 20.0f;
    sighting.sight.shift = 0.0f;
    sighting.sight.sides = &sides;
    for (int i = 0; i < GOE_STATES; i++) {
        truth[i] = (double)sighting.state[i];
    }
    sighting_look(&sighting);
}

static void make_rows(void) {
    sighting_clear_rows(&sighting);
    goe_footprint_rows(&sighting.sight, &sighting.rows);
    goe_rows_end(&sighting.rows, &sighting.sight);
}

/* -------------------------------------------------------------------------------------------------------------- tests -- */

/* [A29, GOE_MODEL_PRISM, goe_image_t.box, goe_touch.c, (R23), (R24), (R25), (R27)]
 * GIVEN ellipses of any size, place and proportion, a camera above or below the roof, rolled by any angle, under an attitude bias
 * THEN the sides of the upright box leave no residual, and the derivatives are those of the extremes of the rims. */
static void rows_are_those_of_the_touching_planes(void) {
    double truth[GOE_STATES];
    any = check_random_start("footprints");
    for (int n = 0; n < CASES; n++) {
        any_footprint(truth);
        upright_measure(&ellipse, truth, &sides);
        make_rows();
        TEST_ASSERT_EQUAL_size_t(GOE_BOX_SIDES, sighting.rows.count);
        for (size_t side = 0; side < GOE_BOX_SIDES; side++) {
            TEST_ASSERT_EQUAL_size_t(feature_of_side[side], sighting.rows.feature[side]);
            TEST_ASSERT_EQUAL_size_t(side, sighting.rows.side[side]);
            TEST_ASSERT_EQUAL_INT(side % 2 == 1 ? GOE_ALONG_Y : GOE_ALONG_X, sighting.rows.axis[side]);
            upright_check_row(&ellipse, truth, side, sighting.matrix.row[side]);
        }
    }
}

/* Whether the box lies where the lens model still means something: within 33 degrees of the axis. */
static bool is_within_lens(void) {
    double farthest = 0.0;
    for (size_t side = 0; side < GOE_BOX_SIDES; side++) {
        const goe_camera_t *camera = &sighting.settings.camera;
        const double px = (double)sides.px[side] - (double)((side & 1u) ? camera->cy_px : camera->cx_px);
        const double at = fabs(px) / (double)((side & 1u) ? camera->fy_px : camera->fx_px);
        farthest = at > farthest ? at : farthest;
    }
    return farthest < 0.45;
}

/* [goe_image_t.box, (R26)]
 * GIVEN a wide lens (k1 = -0.3) THEN a straight side of the raw image, linearized where it touches, is off by less than a
 * tenth of a pixel at 914 px in 98 of 100 sides, and by less than one in all. */
static void a_lens_is_linearised_where_a_side_touches(void) {
    double truth[GOE_STATES];
    double worst_px = 0.0;
    int far = 0;
    int all = 0;
    any = check_random_start("lens");
    for (int n = 0; n < 4 * CASES; n++) {
        any_footprint(truth);
        sighting.settings.camera.k1 = -0.3f;
        sighting.settings.camera.k2 = 0.08f;
        sighting.settings.camera.p1 = 0.001f;
        upright_measure(&ellipse, truth, &sides);
        make_rows();
        for (size_t i = 0; is_within_lens() && i < sighting.rows.count; i++) {
            const double off = fabs((double)sighting.matrix.row[i][GOE_RESIDUAL]) * 914.0;
            worst_px = off > worst_px ? off : worst_px;
            far += off > 0.1 ? 1 : 0;
            all++;
        }
    }
    check_report("px, worst residual of an exact side under a lens", worst_px);
    check_report("share beyond a tenth of a pixel", (double)far / all);
    TEST_ASSERT_TRUE(all > CASES && 50 * far < all && worst_px < 1.0);
}

/* GIVEN a side that is not measured THEN it gives no row, and the others stay as they are. */
static void a_missing_side_gives_no_row(void) {
    double truth[GOE_STATES];
    any = check_random_start("missing");
    any_footprint(truth);
    upright_measure(&ellipse, truth, &sides);
    make_rows();
    const float right = sighting.matrix.row[GOE_BOX_RIGHT][GOE_STATE_COLUMN + GOE_BEARING];
    sides.usable = GOE_SIDE_RIGHT;
    make_rows();
    TEST_ASSERT_EQUAL_size_t(1, sighting.rows.count);
    TEST_ASSERT_EQUAL_FLOAT(right, sighting.matrix.row[0][GOE_STATE_COLUMN + GOE_BEARING]);
}

/* GIVEN an image with an own position error THEN each row has twice the variance by which its place along the line of sight moves it: opposite
 * sides share that. */
static void an_own_position_error_moves_all_rows(void) {
    double truth[GOE_STATES];
    any = check_random_start("own position");
    for (int n = 0; n < FEW; n++) {
        float before[GOE_ROWS_MAX];
        any_footprint(truth);
        upright_measure(&ellipse, truth, &sides);
        make_rows();
        memcpy(before, sighting.rows.variance, sizeof before);
        sighting.sight.shift = 0.1f;
        make_rows();
        for (size_t i = 0; i < sighting.rows.count; i++) {
            const float *by = &sighting.matrix.row[i][GOE_STATE_COLUMN];
            const double gx = (double)by[GOE_BEARING];
            const double gy = (double)by[GOE_GROUND] - (double)by[GOE_TOP]; /* of the one that it touches */
            const double height = (double)sighting.sight.height_m;
            const double gz = -((double)by[GOE_INVERSE_RANGE] - gy * height + gx * 3.0) / 25.0;
            CHECK_CLOSE(1.0e-5, 2.0 * 0.01 * gz * gz, (double)sighting.rows.variance[i] - (double)before[i]);
        }
    }
}

/* GIVEN a row of a side THEN that side's memory learns of it, and no other, with what the attitude, which all sides share, leaves
 * of the residual to it; and a change of the state is followed by all four. */
static void each_side_has_its_own_memory(void) {
    static goe_filter_t filter;
    float change[GOE_UNKNOWNS] = {0.0f};
    for (size_t side = 0; side < GOE_BOX_SIDES; side++) {
        memset(&filter, 0, sizeof filter);
        sighting_clear_rows(&sighting);
        memset(&sighting.matrix, 0, sizeof sighting.matrix);
        sighting.rows.count = sighting.rows.remembered = 1;
        sighting.rows.white_rad = 2.0f;
        sighting.rows.side[0] = (uint8_t)side;
        sighting.rows.weight[0] = 0.5f;
        const float turns[3] = {0.3f, -0.4f, 1.2f};
        memcpy(sighting.matrix.row[0], turns, sizeof turns);
        sighting.matrix.row[0][GOE_RESIDUAL] = 3.0f;
        sighting.matrix.row[0][GOE_STATE_COLUMN + GOE_BEARING] = 0.7f;
        for (size_t i = 0; i < GOE_BOX_SIDES; i++) {
            filter.side[i].variance = 1.0f;
        }
        goe_footprint_learn(&filter, &sighting.rows);
        const double common = 4.0 * (0.09 + 0.16 + 1.44);
        const double gain = 1.0 * 0.25 / (1.0 + common) / 0.5;
        for (size_t i = 0; i < GOE_BOX_SIDES; i++) {
            CHECK_CLOSE(1.0e-6, i == side ? 3.0 * gain : 0.0, filter.side[i].value);
            CHECK_CLOSE(1.0e-6, i == side ? 0.7 * gain : 0.0, filter.side[i].by[GOE_BEARING]);
            filter.side[i].by[GOE_GROUND] = (float)(i + 1);
            filter.side[i].by[GOE_BEARING] = 0.0f;
            filter.side[i].value = 0.0f;
        }
        change[GOE_GROUND] = 2.0f;
        goe_footprint_follow(&filter, change);
        for (size_t i = 0; i < GOE_BOX_SIDES; i++) {
            CHECK_CLOSE(1.0e-6, -2.0 * (double)(i + 1), filter.side[i].value);
        }
    }
}

/* [(R30)] GIVEN two sides along one axis THEN the memory of each learns what the exact update of both, with the error that they share, says of
 * it; a side along the other axis does not matter. */
static void opposite_sides_learn_together(void) {
    static goe_filter_t filter;
    const double variance[2] = {1.0, 0.5};
    const double white[2] = {0.3, 0.8};
    const double residual[2] = {3.0, -1.0};
    const double common = 4.0 * (0.09 + 0.16 + 1.44);
    memset(&filter, 0, sizeof filter);
    sighting_clear_rows(&sighting);
    memset(&sighting.matrix, 0, sizeof sighting.matrix);
    sighting.rows.count = sighting.rows.remembered = 3;
    sighting.rows.white_rad = 2.0f;
    for (size_t i = 0; i < 3; i++) {
        const size_t of = i < 2 ? i : 0;
        const double weight = 1.0 / sqrt(variance[of] + white[of]);
        const float turns[3] = {(float)(0.3 * weight), (float)(-0.4 * weight), (float)(1.2 * weight)};
        memcpy(sighting.matrix.row[i], turns, sizeof turns);
        sighting.rows.axis[i] = (uint8_t)(i == 2 ? GOE_ALONG_Y : GOE_ALONG_X);
        sighting.rows.side[i] = (uint8_t)(i == 0 ? GOE_BOX_LEFT : (i == 1 ? GOE_BOX_RIGHT : GOE_BOX_TOP));
        sighting.rows.weight[i] = (float)weight;
        sighting.matrix.row[i][GOE_RESIDUAL] = (float)(weight * residual[of]);
        filter.side[sighting.rows.side[i]].variance = (float)variance[of];
    }
    goe_footprint_learn(&filter, &sighting.rows);
    const double s00 = variance[0] + white[0] + common;
    const double s11 = variance[1] + white[1] + common;
    const double determinant = s00 * s11 - common * common;
    const double left = variance[0] * (s11 * residual[0] - common * residual[1]) / determinant;
    const double right = variance[1] * (s00 * residual[1] - common * residual[0]) / determinant;
    CHECK_CLOSE(1.0e-5, left, filter.side[GOE_BOX_LEFT].value);
    CHECK_CLOSE(1.0e-5, right, filter.side[GOE_BOX_RIGHT].value);
    CHECK_CLOSE(1.0e-5, variance[0] - variance[0] * variance[0] * s11 / determinant,
                filter.side[GOE_BOX_LEFT].variance);
    CHECK_CLOSE(1.0e-5, variance[1] - variance[1] * variance[1] * s00 / determinant,
                filter.side[GOE_BOX_RIGHT].variance);
    CHECK_CLOSE(1.0e-5, variance[0] * residual[0] / s00, filter.side[GOE_BOX_TOP].value);
}

/* GIVEN a side whose opposite one is not visible THEN its error, a share of the box's size, is that of the box as it is predicted; and
 * that of a box which the border cuts is larger by the setting. */
static void a_sides_error_is_a_share_of_the_box(void) {
    double truth[GOE_STATES];
    any = check_random_start("size");
    for (int n = 0; n < FEW; n++) {
        any_footprint(truth);
        upright_measure(&ellipse, truth, &sides);
        const goe_camera_t *camera = &sighting.settings.camera;
        const double ahead = 1.0 - 25.0 * truth[GOE_INVERSE_RANGE];
        const double predicted[2] = {2.0 * truth[GOE_HALF] / ahead, (truth[GOE_TOP] + truth[GOE_GROUND]) / ahead};
        for (size_t side = 0; side < GOE_BOX_SIDES; side++) {
            const double focal = (double)((side & 1u) != 0u ? camera->fy_px : camera->fx_px);
            const double pixel = (double)sighting.sight.side_px / focal;
            const size_t first = side & 1u;
            const double seen = ((double)sides.px[first + 2u] - (double)sides.px[first]) / focal;
            for (int alone = 0; alone < 2; alone++) {
                const double size = alone == 1 ? predicted[first] : seen;
                const unsigned ends = first == 0u ? GOE_SIDE_TOP | GOE_SIDE_BOTTOM : 0u; /* of an upright side */
                sides.usable = (uint8_t)(alone == 1 ? 1u << side | ends : GOE_SIDES_ALL);
                for (int cut = 0; cut < 2; cut++) {
                    sides.truncated = cut == 1;
                    sighting.settings.detector.truncation_noise_rel = 0.8f;
                    make_rows();
                    const double expected = pixel * pixel + (1.0e-4 + (cut == 1 ? 0.64 : 0.0)) * size * size;
                    CHECK_CLOSE(1.0e-4 * expected, expected,
                                sighting.rows.variance[alone == 1 ? side / 2u * (1u - first) : side]);
                }
            }
        }
    }
}

/* A level camera that looks along Z and is where the track began; a box of these sides, in focal lengths from the middle. */
static void see_box(float left, float top, float right, float bottom) {
    static const float level[9] = {1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f};
    const goe_camera_t *camera = &sighting.settings.camera;
    const float at[GOE_BOX_SIDES] = {left, top, right, bottom};
    sighting_start(&sighting, &any);
    memset(sighting.state, 0, sizeof sighting.state);
    memcpy(sighting.sight.camera_to_axes, level, sizeof level);
    sighting.sight.camera_m.x = sighting.sight.camera_m.z = 0.0f;
    sighting.sight.height_m = 20.0f;
    sighting.sight.height_sd_m = 0.5f;
    sighting.sight.sides = &sides;
    sighting.settings.camera.cx_px = 700.0f; /* different along x and y */
    sighting.settings.camera.cy_px = 400.0f;
    for (size_t side = 0; side < GOE_BOX_SIDES; side++) {
        sides.px[side] = at[side] * ((side & 1u) != 0u ? camera->fy_px : camera->fx_px) +
                         ((side & 1u) != 0u ? camera->cy_px : camera->cx_px);
    }
    sides.usable = GOE_SIDES_ALL;
    sides.cut = false;
    sides.doubtful = 0;
}

/* GIVEN a first box THEN the filter starts with the range that its foot gives over flat ground, its near side being nearer than its
 * middle by half the width; or, where that foot is hidden or lies so near to the horizon that errors may have put it there, with
 * the typical size's; with the size and the top that the box shows there; and no state is more certain than that. */
static void a_start_matches_one_box(void) {
    goe_triangle_t root;
    float x[GOE_STATES];
    any = check_random_start("start");
    see_box(-0.05f, -0.1f, 0.05f, 0.25f);
    sighting.settings.navigation.velocity_bias_sd_m_s = 0.1f;
    sighting.settings.navigation.terrain_slope_sd = 0.03f;
    sighting.sight.state = x;
    memset(x, 0xA5, sizeof x); /* whatever was there before */
    TEST_ASSERT_TRUE(goe_footprint_start(&sighting.sight, x, &root, &by_kind));
    for (size_t i = 0; i < 3; i++) {
        CHECK_SAME(0.0f, x[i]);
    }
    CHECK_SAME(0.0f, x[GOE_LOG_DEPTH]);
    CHECK_SAME(0.0f, x[GOE_SHEAR]);
    const double q = 1.0 / (80.0 * 1.05);
    const double bias = 0.5 * 0.017453292519943295;
    CHECK_CLOSE(1.0e-6, q, x[GOE_INVERSE_RANGE]);
    CHECK_CLOSE(1.0e-6, 0.0, x[GOE_BEARING]);
    CHECK_CLOSE(1.0e-6, 0.05, x[GOE_HALF]);
    CHECK_CLOSE(1.0e-6, 20.0 * q + 0.1, x[GOE_TOP]);
    CHECK_CLOSE(1.0e-6, 0.0, x[GOE_GROUND]);
    const double sigma[GOE_STATES] = {
        bias, bias,    hypot(bias, 0.008),      hypot(0.5 * q, 0.03), /* of the height, and of the slope of the ground below */
        1.0,  4.0 * q, 10.0 * (20.0 * q + 0.1), 0.6 * 0.05,           2.5 * 0.1, 1.0};
    for (size_t i = 0; i < GOE_STATES; i++) {
        CHECK_CLOSE(1.0e-4, 1.0, sigma[i] * (double)*goe_srif_at(&root, i, i));
    }
    sighting.sight.is_round = true; /* as deep as wide */
    TEST_ASSERT_TRUE(goe_footprint_start(&sighting.sight, x, &root, &by_kind));
    CHECK_CLOSE(1.0, 1000.0, *goe_srif_at(&root, GOE_LOG_DEPTH, GOE_LOG_DEPTH));
    CHECK_CLOSE(1.0, 50.0 / 0.05, *goe_srif_at(&root, GOE_SHEAR, GOE_SHEAR)); /* which shows that it is none */
    see_box(-0.05f, -0.1f, 0.05f, 0.25f);
    sides.usable = GOE_SIDE_LEFT | GOE_SIDE_RIGHT; /* no foot, no head */
    TEST_ASSERT_TRUE(goe_footprint_start(&sighting.sight, x, &root, &by_kind));
    CHECK_CLOSE(1.0e-6, 0.1 / 6.0, x[GOE_INVERSE_RANGE]); /* 6 m under 0.1 */
    CHECK_CLOSE(1.0e-6, 20.0 * 0.1 / 6.0, x[GOE_TOP]);
    see_box(-0.05f, -0.1f, 0.05f, 0.02f); /* below three sigma of attitude, pixel and share */
    TEST_ASSERT_TRUE(goe_footprint_start(&sighting.sight, x, &root, &by_kind));
    CHECK_CLOSE(1.0e-6, 0.1 / 6.0, x[GOE_INVERSE_RANGE]);
    see_box(-0.05f, -0.1f, 0.05f, 0.25f);
    sighting.sight.height_sd_m = 100.0f; /* no altimeter: the first box sets the ground */
    TEST_ASSERT_TRUE(goe_footprint_start(&sighting.sight, x, &root, &by_kind));
    CHECK_CLOSE(1.0e-6, 0.25 - 20.0 * 0.1 / 6.0, x[GOE_GROUND]);
}

/* GIVEN a box of which the image's border hides one side THEN the filter starts from the visible part. The border may hide as much again,
 * or an assumed width; and the class gives the range by the height alone. No side at all, a width of 0, or one of more than a quarter of the image starts nothing. */
static void a_start_needs_one_side(void) {
    goe_triangle_t root;
    float x[GOE_STATES];
    goe_kind_t kind;
    memset(&kind, 0, sizeof kind);
    any = check_random_start("border");
    for (int wide = 0; wide < 2; wide++) {
        const double width = wide == 1 ? 0.28 : 0.02;
        see_box(0.1f, -0.1f, 0.1f + (float)width, 0.25f);
        sighting.sight.state = x;
        sighting.sight.kind = &kind;
        sides.usable = GOE_SIDE_LEFT | GOE_SIDE_BOTTOM; /* right is that of the border */
        const double middle = 0.1 + 0.5 * width;
        const double size = width / (1.0 + middle * middle);
        const double q = 1.0 / (80.0 * (1.0 + 0.5 * size));
        TEST_ASSERT_TRUE(goe_footprint_start(&sighting.sight, x, &root, &by_kind));
        CHECK_CLOSE(1.0e-5, q, x[GOE_INVERSE_RANGE]);
        CHECK_CLOSE(1.0e-5, 0.5 * size, x[GOE_HALF]);
        CHECK_CLOSE(1.0e-3, 1.0, fmax(0.5 * size, 6.0 * q) * (double)*goe_srif_at(&root, GOE_HALF, GOE_HALF));
        sighting.sight.height_sd_m = 100.0f; /* no ground */
        kind.width_m = 2.0f;
        TEST_ASSERT_TRUE(goe_footprint_start(&sighting.sight, x, &root, &by_kind));
        TEST_ASSERT_FALSE(by_kind);
        CHECK_CLOSE(1.0e-5, size / 6.0, x[GOE_INVERSE_RANGE]);
        kind.width_m = 0.0f;
        sides.usable = GOE_SIDE_TOP | GOE_SIDE_BOTTOM;
        TEST_ASSERT_FALSE(goe_footprint_start(&sighting.sight, x, &root, &by_kind));
        sides.usable = GOE_SIDE_LEFT;
        sides.px[GOE_BOX_RIGHT] = sides.px[GOE_BOX_LEFT];
        TEST_ASSERT_FALSE(goe_footprint_start(&sighting.sight, x, &root, &by_kind));
    }
    see_box(-0.2f, -0.1f, 0.2f, 0.25f);
    TEST_ASSERT_TRUE(goe_footprint_start(&sighting.sight, x, &root, &by_kind));
    sides.usable = GOE_SIDE_LEFT | GOE_SIDE_BOTTOM; /* too wide for a part */
    TEST_ASSERT_FALSE(goe_footprint_start(&sighting.sight, x, &root, &by_kind));
}

/* GIVEN a box off the axis THEN the state's axes are turned towards its middle, at the middle of its height, or at the horizon where
 * that is not visible; and a box without any of its upright sides turns nothing. */
static void the_axes_turn_towards_the_box(void) {
    static const float rolled[9] = {0.8f, -0.6f, 0.0f, 0.6f, 0.8f, 0.0f, 0.0f, 0.0f, 1.0f};
    goe_filter_t filter;
    goe_view_t view;
    memset(&filter, 0, sizeof filter);
    memset(&view, 0, sizeof view);
    any = check_random_start("face");
    for (int n = 0; n < 3; n++) {
        see_box(0.3f, -0.1f, 0.5f, 0.3f);
        view.camera = &sighting.settings.camera;
        memcpy(view.camera_to_trajectory, rolled, sizeof rolled);
        view.sides = sides;
        view.sides.usable = n == 0   ? GOE_SIDES_ALL
                            : n == 1 ? GOE_SIDE_LEFT | GOE_SIDE_RIGHT
                                     : GOE_SIDE_BOTTOM | GOE_SIDE_TOP;
        TEST_ASSERT_EQUAL_INT(n < 2, goe_footprint_face(&filter, &view));
        const double x = 0.8 * 0.4 - 0.6 * (n == 0 ? 0.1 : 0.0);
        if (n < 2) {
            CHECK_CLOSE(1.0e-5, x / hypot(1.0, x), filter.axes.turn_sin);
            CHECK_CLOSE(1.0e-5, 1.0 / hypot(1.0, x), filter.axes.turn_cos);
        }
    }
}

/* A flight past a truck with visible base corners, by its box, too. Returns the error of Z0 in sigmas; model: the reported one. */
static double fly_with_corners(bool corners, double roll_deg, goe_model_t *model) {
    scene_t scene;
    goe_estimator_t estimator;
    goe_estimate_t estimate;
    goe_image_t image;
    scene_truth_t truth;
    scene_default(&scene);
    scene.roll_deg = roll_deg;
    goe_settings_t settings = scene_settings(&scene);
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
    for (int k = 0; k < 45; k++) {
        goe_image_t boxed;
        scene_t box_scene = scene;
        box_scene.boxes = true;
        scene_image(&scene, k, &image, &truth);
        scene_image(&box_scene, k, &boxed, NULL);
        image.box = boxed.box;
        image.left.u_px = image.right.u_px = image.top.v_px = 0.0f; /* not read */
        if (!corners) {
            image.base_left.visible = image.base_near.visible = image.base_right.visible = false;
        }
        (void)goe_update(&estimator, &image, &estimate);
    }
    *model = estimate.model;
    TEST_ASSERT_TRUE(estimate.fresh && (estimate.valid & GOE_HAS_WIDTH));
    return fabs((double)estimate.z0_m - scene.z0_m) / (double)estimate.sigma.z0_m;
}

/* [A1, goe_box_t.sides, goe_image_t.box, goe_model.c]
 * GIVEN a box and base corners THEN the box replaces left, right and top, and the corners make a box of it; without corners
 * it is a prism. */
static void a_box_goes_with_base_corners(void) {
    goe_model_t model;
    TEST_ASSERT_TRUE(fly_with_corners(true, 0.0, &model) < 2.0);
    TEST_ASSERT_EQUAL_INT(GOE_MODEL_BOX, model);
    TEST_ASSERT_TRUE(fly_with_corners(true, 8.0, &model) < 2.0);
    TEST_ASSERT_EQUAL_INT(GOE_MODEL_BOX, model);
    (void)fly_with_corners(false, 8.0, &model);
    TEST_ASSERT_EQUAL_INT(GOE_MODEL_PRISM, model);
}

/* GIVEN boxes image after image THEN the error of each side is estimated, ever better: it is correlated with the next. */
static void sides_are_remembered_in_flight(void) {
    scene_t scene;
    goe_estimator_t estimator;
    goe_estimate_t estimate;
    goe_image_t boxed;
    scene_default(&scene);
    scene.boxes = true;
    scene.image_rate_hz = 5.0;
    goe_settings_t settings = scene_settings(&scene);
    settings.detector.box_noise_rel = 0.07f;
    settings.detector.box_correlation_time_s = 5.0f;
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
    for (int k = 0; k < 20; k++) {
        scene_image(&scene, k, &boxed, NULL);
        (void)goe_update(&estimator, &boxed, &estimate);
    }
    TEST_ASSERT_EQUAL_INT(GOE_PHASE_FOOTPRINT, estimator.filter.phase);
    const float size = (boxed.box.right_px - boxed.box.left_px) / settings.camera.fx_px;
    for (size_t side = 0; side < GOE_BOX_SIDES; side += 2) {
        TEST_ASSERT_TRUE(estimator.filter.side[side].variance > 0.0f);
        TEST_ASSERT_TRUE(estimator.filter.side[side].variance < 0.9f * goe_square(0.07f * size));
    }
}

/* ------------------------------------------------------------------------------------------------------------ height -- */

typedef enum { STEADY, NOISY_ALTIMETER, FILTER_JUMPS } height_t;

static goe_estimate_t fly_box(height_t height, float white_m) {
    static const float jump_m[3] = {3.0f, -2.0f, 5.0f};
    scene_t scene;
    goe_estimator_t estimator;
    goe_estimate_t estimate;
    goe_image_t image;
    scene_default(&scene);
    scene.boxes = true;
    scene.glide_deg = 2.0;
    goe_settings_t settings = scene_settings(&scene);
    settings.camera.offset_m[0] = 0.7f;
    settings.camera.offset_m[2] = 0.3f;
    settings.navigation.height_white_sd_m = white_m;
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
    for (int k = 0; k < 45; k++) {
        scene_image(&scene, k, &image, NULL);
        if (height == NOISY_ALTIMETER && k > 0) {
            image.pose.height_m += (float)check_random_normal(&any);
        }
        for (int i = 0; height == FILTER_JUMPS && k >= 20 && i < 3; i++) {
            image.pose.position_ned_m[i] += jump_m[i];
            image.pose.reset_delta_ned_m[i] = jump_m[i];
            image.pose.reset_count = 1;
            image.pose.reset_delta_known = true;
        }
        (void)goe_update(&estimator, &image, &estimate);
    }
    TEST_ASSERT_TRUE(estimate.fresh && (estimate.valid & GOE_HAS_HEIGHT));
    return estimate;
}

/* [camera.offset_m, goe_pose_t.height_m, navigation.height_white_sd_m]
 * GIVEN boxes, and an altimeter with a noise of 1 m THEN the answer is that of exact heights, within the error of the mean of its readings
 * over the height; and if that noise was not configured, its sigma knows. */
static void an_altimeter_s_noise_is_averaged(void) {
    const double mean_m = 1.0 / sqrt(45.0);
    any = check_random_start("altimeter");
    const goe_estimate_t steady = fly_box(STEADY, 1.0f);
    for (int flight = 0; flight < 8; flight++) {
        const goe_estimate_t noisy = fly_box(NOISY_ALTIMETER, 1.0f);
        const goe_estimate_t surprised = fly_box(NOISY_ALTIMETER, 0.0f);
        const double range_m = 3.0 * mean_m / (double)steady.height_m * (double)steady.z0_m;
        check_report("range off by, m", (double)noisy.z0_m - (double)steady.z0_m);
        CHECK_CLOSE(range_m, steady.z0_m, noisy.z0_m);
        CHECK_CLOSE(3.0 * mean_m, steady.height_m, noisy.height_m);
        CHECK_CLOSE(0.3 * (double)steady.sigma.z0_m, steady.sigma.z0_m, noisy.sigma.z0_m);
        CHECK_CLOSE((double)surprised.sigma.z0_m, steady.z0_m, surprised.z0_m);
        TEST_ASSERT_TRUE(surprised.sigma.z0_m > steady.sigma.z0_m);
    }
}

/* [goe_pose_t.reset_delta_known]
 * GIVEN a jump of the autopilot's filter, down among it, of known size THEN the answer is that of a flight without one. */
static void a_jump_of_the_filter_moves_the_datum(void) {
    any = check_random_start("jump");
    const goe_estimate_t steady = fly_box(STEADY, 0.5f);
    const goe_estimate_t jumped = fly_box(FILTER_JUMPS, 0.5f);
    CHECK_CLOSE(0.01 * (double)steady.sigma.z0_m, steady.z0_m, jumped.z0_m);
    CHECK_CLOSE(0.01 * (double)steady.sigma.height_m, steady.height_m, jumped.height_m);
}

/* ------------------------------------------------------------------------------------------------------------- start -- */

static float first[GOE_STATES];
static goe_triangle_t first_root;

/* A level camera 20 m above the ground, which knows its height and attitude well; the box of a tower 100 m ahead, 6 m wide, whose top
 * lies 10 m above the camera. */
static void show_tower(void) {
    static const float level[9] = {1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f};
    any = check_random_start("tower");
    sighting_start(&sighting, &any);
    goe_camera_t *camera = &sighting.settings.camera;
    memset(camera, 0, sizeof *camera);
    camera->fx_px = camera->fy_px = 1000.0f;
    memcpy(sighting.sight.camera_to_axes, level, sizeof level);
    sighting.sight.height_m = 20.0f;
    sighting.sight.height_sd_m = 0.14f;
    sighting.sight.sides = &sides;
    sides.px[GOE_BOX_LEFT] = -30.0f;
    sides.px[GOE_BOX_RIGHT] = 30.0f;
    sides.px[GOE_BOX_TOP] = -100.0f;
    sides.px[GOE_BOX_BOTTOM] = 200.0f;
    sides.usable = GOE_SIDES_ALL;
}

static bool starts(void) { return goe_footprint_start(&sighting.sight, first, &first_root, &by_kind); }

static double first_range_m(void) {
    TEST_ASSERT_TRUE(starts());
    return 1.0 / (double)first[GOE_INVERSE_RANGE];
}

/* GIVEN a foot clearly below the horizon THEN the range is that of flat ground, to the middle; width and top follow from it. */
static void the_ground_gives_the_first_range(void) {
    show_tower();
    CHECK_CLOSE(0.1, 103.0, first_range_m());
    CHECK_CLOSE(1.0e-6, 0.03, first[GOE_HALF]);
    CHECK_CLOSE(1.0e-3, 30.3, (double)first[GOE_TOP] * first_range_m());
    CHECK_SAME(0.0f, first[GOE_GROUND]);
    CHECK_SAME(0.0f, first[GOE_BEARING]);
    sides.usable &= (uint8_t)~GOE_SIDE_TOP; /* then it is taken to reach as high as the camera */
    CHECK_CLOSE(0.1, 103.0, first_range_m());
    CHECK_CLOSE(1.0e-4, 20.0, (double)first[GOE_TOP] / (double)first[GOE_INVERSE_RANGE]);
}

/* GIVEN an invisible foot, or one too near to the horizon, or a height without information THEN the range is that of the prior
 * width. */
static void the_typical_size_gives_another_range(void) {
    show_tower();
    sighting.settings.filter.prior_width_m = 12.0f;
    sides.usable &= (uint8_t)~GOE_SIDE_BOTTOM;
    CHECK_CLOSE(0.01, 200.0, first_range_m());
    show_tower();
    sighting.settings.filter.prior_width_m = 12.0f;
    sides.px[GOE_BOX_BOTTOM] = 20.0f;
    CHECK_CLOSE(0.01, 200.0, first_range_m());
    show_tower();
    sighting.settings.filter.prior_width_m = 12.0f;
    sighting.sight.height_m = 0.4f;
    CHECK_CLOSE(0.01, 200.0, first_range_m());
    show_tower();
    sighting.settings.filter.prior_width_m = 12.0f;
    sighting.settings.camera.k1 = -100.0f; /* a lens that no ray gives the foot in */
    CHECK_CLOSE(0.01, 200.0, first_range_m());
    show_tower();
    sighting.settings.filter.prior_width_m = 12.0f;
    sighting.settings.camera.k1 = 1.0e-6f; /* ... and one that changes next to nothing */
    CHECK_CLOSE(0.1, 103.0, first_range_m());
}

/* GIVEN a first range beyond any obstacle's, or within the camera THEN the filter does not start. */
static void no_range_is_no_start(void) {
    show_tower();
    sides.usable &= (uint8_t)~GOE_SIDE_BOTTOM;
    sighting.settings.filter.prior_width_m = 1000.0f;
    sides.px[GOE_BOX_LEFT] = -0.6f;
    sides.px[GOE_BOX_RIGHT] = 0.6f;
    TEST_ASSERT_TRUE(starts());
    sides.px[GOE_BOX_LEFT] = -0.4f;
    sides.px[GOE_BOX_RIGHT] = 0.4f;
    TEST_ASSERT_FALSE(starts());
}

/* [filter.prior_width_m] GIVEN an assumed width that places the obstacle nearer than a meter THEN the first guess is a meter: a wrong width
 * must not keep the filter from starting. */
static void a_first_guess_is_no_nearer_than_a_meter(void) {
    show_tower();
    sides.usable &= (uint8_t)~GOE_SIDE_BOTTOM;
    sighting.settings.filter.prior_width_m = 0.1f;
    sides.px[GOE_BOX_LEFT] = -100.0f;
    sides.px[GOE_BOX_RIGHT] = 100.0f;
    CHECK_CLOSE(1.0e-6, 1.0, first_range_m());
}

/* GIVEN a height that is as good as not known THEN the first box's foot sets it, if visible. */
static void without_an_altimeter_the_foot_gives_the_height(void) {
    show_tower();
    sighting.sight.height_sd_m = 100.0f;
    sighting.settings.filter.prior_width_m = 12.0f;
    CHECK_CLOSE(0.01, 200.0, first_range_m());
    CHECK_CLOSE(1.0e-5, 0.2 - 20.0 / 200.0, first[GOE_GROUND]); /* 40 m above the ground, by that range */
    sides.usable &= (uint8_t)~GOE_SIDE_BOTTOM;
    TEST_ASSERT_TRUE(starts());
    CHECK_SAME(0.0f, first[GOE_GROUND]);
}

/* ------------------------------------------------------------------------------------------------------------ errors -- */

/* GIVEN a depth that an update throws far off THEN it stays what a body can have, flat or deep, and can come back. */
static void the_depth_of_a_body_is_bounded(void) {
    goe_filter_t filter;
    float change[GOE_UNKNOWNS] = {0.0f};
    goe_filter_clear(&filter);
    filter.state[GOE_LOG_DEPTH] = 50.0f;
    goe_footprint_follow(&filter, change);
    const float most = filter.state[GOE_LOG_DEPTH];
    TEST_ASSERT_TRUE(most > 1.0f && most < 5.0f);
    filter.state[GOE_LOG_DEPTH] = -50.0f;
    goe_footprint_follow(&filter, change);
    CHECK_SAME(-most, filter.state[GOE_LOG_DEPTH]);
    filter.state[GOE_LOG_DEPTH] = -0.5f * most;
    goe_footprint_follow(&filter, change);
    CHECK_SAME(-0.5f * most, filter.state[GOE_LOG_DEPTH]);
}

/* GIVEN errors of an image that are none THEN the image is refused, and nothing changes; by the window method they are not
 * read. */
static void errors_of_an_image_are_checked(void) {
    static const float bad[] = {-1.0f, 31.0f, 1.0e30f};
    scene_t scene;
    goe_estimator_t estimator;
    goe_estimate_t estimate;
    goe_image_t image;
    scene_default(&scene);
    goe_settings_t settings = scene_settings(&scene);
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
    scene_image(&scene, 0, &image, NULL);
    for (int i = 0; i < 3; i++) {
        image.noise.attitude_sd_deg = bad[i];
        CHECK_STATUS(GOE_OUT_OF_RANGE, goe_update(&estimator, &image, &estimate));
    }
    image.noise.attitude_sd_deg = 0.0f;
    static const float bad_m[] = {-1.0f, 1001.0f};
    static const float bad_px[] = {-1.0f, 101.0f};
    for (int i = 0; i < 2; i++) {
        image.noise.height_sd_m = bad_m[i];
        CHECK_STATUS(GOE_OUT_OF_RANGE, goe_update(&estimator, &image, &estimate));
        image.noise.height_sd_m = 0.0f;
        image.noise.pixel_sd_px = bad_px[i];
        CHECK_STATUS(GOE_OUT_OF_RANGE, goe_update(&estimator, &image, &estimate));
        image.noise.pixel_sd_px = 0.0f;
    }
    image.noise.height_sd_m = check_from_bits(0x7FC00000u);
    CHECK_STATUS(GOE_NOT_FINITE, goe_update(&estimator, &image, &estimate));
    TEST_ASSERT_TRUE(estimator.motion.time_us == GOE_TIME_UNKNOWN);
#if GOE_WITH_WINDOW
    settings.method = GOE_METHOD_WINDOW;
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
    CHECK_STATUS(GOE_CONVERGING, goe_update(&estimator, &image, &estimate));
#endif
}

/* [goe_intake.c] GIVEN a side of the box that is not finite, or out of range THEN the image is refused; an invisible one is not read. */
static void every_side_that_is_visible_is_checked(void) {
    scene_t scene;
    goe_estimator_t estimator;
    goe_estimate_t estimate;
    goe_image_t image;
    scene_default(&scene);
    scene.boxes = true;
    const goe_settings_t settings = scene_settings(&scene);
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
    for (int side = 0; side < GOE_BOX_SIDES; side++) {
        float *const px[] = {&image.box.left_px, &image.box.top_px, &image.box.right_px, &image.box.bottom_px};
        scene_image(&scene, 0, &image, NULL);
        *px[side] = check_from_bits(0x7FC00000u);
        CHECK_STATUS(GOE_NOT_FINITE, goe_update(&estimator, &image, &estimate));
        *px[side] = check_next_away(side < 2 ? -1.0e5f : 1.0e5f);
        CHECK_STATUS(GOE_OUT_OF_RANGE, goe_update(&estimator, &image, &estimate));
        TEST_ASSERT_TRUE(estimator.motion.time_us == GOE_TIME_UNKNOWN);
    }
    for (int side = 0; side < GOE_BOX_SIDES; side++) {
        float *const px[] = {&image.box.left_px, &image.box.top_px, &image.box.right_px, &image.box.bottom_px};
        scene_image(&scene, 1 + side, &image, NULL);
        *px[side] = check_from_bits(0x7FC00000u);
        image.box.sides = (uint8_t)(GOE_SIDES_ALL & ~(1u << side));
        TEST_ASSERT_TRUE(goe_update(&estimator, &image, &estimate) >= GOE_OK);
    }
}

/* The flight of the boxes whose images know these errors of their heights, 0: as in the settings. */
static float height_sigma_with(float first_m, float later_m, goe_model_t model, goe_estimate_t *estimate) {
    scene_t scene;
    goe_estimator_t estimator;
    goe_image_t image;
    scene_default(&scene);
    scene.boxes = true;
    goe_settings_t settings = scene_settings(&scene);
    settings.navigation.terrain_height_sd_m = 0.0f;
    settings.model = model;
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
    for (int k = 0; k < 30; k++) {
        scene_image(&scene, k, &image, NULL);
        image.noise.height_sd_m = k == 0 ? first_m : later_m;
        (void)goe_update(&estimator, &image, estimate);
    }
    TEST_ASSERT_TRUE(estimate->valid & GOE_HAS_HEIGHT);
    return estimate->sigma.height_m;
}

/* A thing 7 to 14 times as long as wide, some 3 to 40 m to the side of a straight flight. Returns the images of the pass. */
static int any_slender(scene_t *scene) {
    scene_default(scene);
    scene->boxes = true;
    scene->width_m = check_random_between(&any, 1.0, 6.0);
    scene->length_m = scene->width_m * check_random_between(&any, 7.0, 14.0);
    scene->height_m = check_random_between(&any, 3.0, 15.0);
    scene->alpha_deg = check_random_between(&any, -80.0, 80.0);
    scene->altitude_m = check_random_between(&any, 15.0, 60.0);
    scene->speed_mps = check_random_between(&any, 12.0, 30.0);
    const double reach_s = check_random_between(&any, 10.0, 20.0);
    const double half = 0.5 * hypot(scene->width_m, scene->length_m);
    const double aside = half + check_random_between(&any, 3.0, 40.0);
    const double alpha = scene->alpha_deg * TWO_PI / 360.0;
    scene->z0_m = scene->speed_mps * reach_s - 0.5 * scene->length_m * cos(alpha); /* the middle of the front */
    scene->x0_m = (check_random_bits(&any) % 2u != 0u ? aside : -aside) - 0.5 * scene->length_m * sin(alpha);
    return (int)(scene->image_rate_hz * (reach_s - 1.0 - half / scene->speed_mps));
}

/* Across the line of sight to the middle, when the filter started. */
static double width_across(const scene_t *scene, const goe_estimator_t *estimator) {
    const double alpha = scene->alpha_deg * TWO_PI / 360.0;
    const double x = scene->x0_m + 0.5 * scene->length_m * sin(alpha);
    const double z = scene->z0_m + 0.5 * scene->length_m * cos(alpha) - (double)estimator->filter.axes.start_dz_m;
    const double turn = atan2(x, z) - alpha;
    return scene->width_m * fabs(cos(turn)) + scene->length_m * fabs(sin(turn));
}

/* [GOE_MODEL_PRISM]
 * GIVEN exact boxes of slender things, whose width changes as the line of sight turns, and of which no image shows how deep they are,
 * THEN no width is reported that is wrong by six sigma, suspect or not. */
static void the_width_of_slender_things_is_not_confidently_wrong(void) {
    int wrong = 0;
    any = check_random_start("slender");
    for (int n = 0; n < SLENDER; n++) {
        scene_t scene;
        goe_estimator_t estimator;
        goe_estimate_t estimate;
        double worst = 0.0;
        const int images = any_slender(&scene);
        const goe_settings_t settings = scene_settings(&scene);
        CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
        for (int k = 0; k < images; k++) {
            goe_image_t image;
            scene_image(&scene, k, &image, NULL);
            (void)goe_update(&estimator, &image, &estimate);
            if (estimate.fresh && (estimate.valid & GOE_HAS_WIDTH) != 0u) {
                const double off = (double)estimate.width_m - width_across(&scene, &estimator);
                check_worst(&worst, off / (double)estimate.sigma.width_m);
            }
        }
        wrong += worst > 6.0 ? 1 : 0;
    }
    check_report("slender things reported wrong by six sigma, of 400", wrong);
    TEST_ASSERT_EQUAL_INT(0, wrong);
}

/* [goe_image_noise_t.height_sd_m]
 * GIVEN an image that knows the error of its height THEN it counts in the first image with a box, and in no other. */
static void a_height_s_own_error_counts_in_the_first_image(void) {
    goe_estimate_t estimate;
    const float plain = height_sigma_with(0.0f, 0.0f, GOE_MODEL_DISC, &estimate);
    const float doubtful = height_sigma_with(20.0f, 0.0f, GOE_MODEL_DISC, &estimate);
    check_report("sigma of the height, the first height 20 m off instead of 0.5", (double)doubtful / (double)plain);
    TEST_ASSERT_TRUE(doubtful > 1.04f * plain);
    CHECK_SAME(plain, height_sigma_with(0.0f, 3.0f, GOE_MODEL_DISC, &estimate));
}

/* [(R31)] GIVEN any sigma of the log of the depth THEN its part in a sigma counts by the secant over a sigma, up to the largest depth. */
static void the_depth_counts_by_its_secant(void) {
    static const double sd[] = {1.0e-3, 0.011, 0.3, 1.0, 2.0, 50.0};
    goe_filter_t filter;
    goe_filter_clear(&filter);
    for (size_t i = 0; i < sizeof sd / sizeof sd[0]; i++) {
        const double counts = fmin(sd[i], 2.0);
        const double secant = expm1(counts) / counts;
        *goe_srif_at(&filter.root, GOE_LOG_DEPTH, GOE_LOG_DEPTH) = (float)(i % 2 == 0 ? 1.0 / sd[i] : -1.0 / sd[i]);
        CHECK_CLOSE(6.0e-3 * secant, secant, goe_footprint_bend(&filter));
    }
}

/* [(R31)] GIVEN the same boxes WHEN a disc is configured THEN the range is known better: a prism's sigma includes unobservable
 * depth, and that keeps no answer back. */
static void a_prism_reports_unobserved_depth(void) {
    goe_estimate_t prism;
    goe_estimate_t disc;
    (void)height_sigma_with(0.0f, 0.0f, GOE_MODEL_AUTO, &prism);
    (void)height_sigma_with(0.0f, 0.0f, GOE_MODEL_DISC, &disc);
    TEST_ASSERT_EQUAL_INT(GOE_MODEL_PRISM, prism.model);
    TEST_ASSERT_TRUE(prism.valid & disc.valid & GOE_HAS_POSITION);
    check_report("sigma of Z0 over that of a disc", (double)prism.sigma.z0_m / (double)disc.sigma.z0_m);
    TEST_ASSERT_TRUE(prism.sigma.z0_m > 1.1f * disc.sigma.z0_m);
}

/* [(R31)]
 * GIVEN a share of the range between the observable part of the sigma and the whole THEN the position is reported, with
 * the whole sigma. */
static void unobserved_depth_keeps_no_answer_back(void) {
    static const float share[] = {0.04f, 0.015f};
    scene_t scene;
    goe_estimator_t estimator;
    goe_estimate_t estimate;
    goe_image_t image;
    for (int strict = 0; strict < 2; strict++) {
        scene_default(&scene);
        scene.boxes = true;
        scene.width_m = scene.length_m = 20.0;
        goe_settings_t settings = scene_settings(&scene);
        settings.filter.range_sd_rel_max = share[strict];
        CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
        for (int k = 0; k < 34; k++) {
            scene_image(&scene, k, &image, NULL);
            (void)goe_update(&estimator, &image, &estimate);
        }
        const bool reported = estimate.fresh && estimate.method == GOE_METHOD_FILTER;
        TEST_ASSERT_EQUAL_INT(strict == 0, reported);
        TEST_ASSERT_TRUE(!reported || estimate.sigma.z0_m > share[strict] * estimate.z0_m);
    }
}

/* GIVEN a box sooner than 0.08 of the correlation time of its errors THEN it adds nothing, and the answer stays; later it
 * does. */
static void boxes_that_come_too_soon_are_not_used(void) {
    scene_t scene;
    goe_estimator_t estimator;
    goe_estimate_t estimate;
    goe_image_t image;
    scene_default(&scene);
    scene.boxes = true;
    const goe_settings_t settings = scene_settings(&scene);
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
    for (int k = 0; k < 30; k++) {
        scene_image(&scene, k, &image, NULL);
        (void)goe_update(&estimator, &image, &estimate);
    }
    TEST_ASSERT_TRUE(estimate.fresh);
    const int points = estimate.images_used;
    const int64_t last_us = image.pose.time_us;
    const float early_s = 0.08f * settings.detector.box_correlation_time_s;
    image.pose.time_us = last_us + (int64_t)((early_s - 0.002f) * 1.0e6f);
    CHECK_STATUS(GOE_STALE, goe_update(&estimator, &image, &estimate));
    TEST_ASSERT_FALSE(estimate.fresh);
    TEST_ASSERT_EQUAL_INT(points, estimate.images_used);
    image.pose.time_us = last_us + (int64_t)((early_s + 0.002f) * 1.0e6f);
    CHECK_STATUS(GOE_OK, goe_update(&estimator, &image, &estimate));
    TEST_ASSERT_EQUAL_INT(points + 1, estimate.images_used);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(every_side_that_is_visible_is_checked);
    RUN_TEST(the_width_of_slender_things_is_not_confidently_wrong);
    RUN_TEST(a_height_s_own_error_counts_in_the_first_image);
    RUN_TEST(the_depth_counts_by_its_secant);
    RUN_TEST(a_prism_reports_unobserved_depth);
    RUN_TEST(unobserved_depth_keeps_no_answer_back);
    RUN_TEST(boxes_that_come_too_soon_are_not_used);
    RUN_TEST(the_ground_gives_the_first_range);
    RUN_TEST(the_typical_size_gives_another_range);
    RUN_TEST(no_range_is_no_start);
    RUN_TEST(a_first_guess_is_no_nearer_than_a_meter);
    RUN_TEST(without_an_altimeter_the_foot_gives_the_height);
    RUN_TEST(the_depth_of_a_body_is_bounded);
    RUN_TEST(errors_of_an_image_are_checked);
    RUN_TEST(an_altimeter_s_noise_is_averaged);
    RUN_TEST(a_jump_of_the_filter_moves_the_datum);
    RUN_TEST(an_own_position_error_moves_all_rows);
    RUN_TEST(each_side_has_its_own_memory);
    RUN_TEST(opposite_sides_learn_together);
    RUN_TEST(a_sides_error_is_a_share_of_the_box);
    RUN_TEST(a_start_matches_one_box);
    RUN_TEST(a_start_needs_one_side);
    RUN_TEST(the_axes_turn_towards_the_box);
    RUN_TEST(sides_are_remembered_in_flight);
    RUN_TEST(a_box_goes_with_base_corners);
    RUN_TEST(rows_are_those_of_the_touching_planes);
    RUN_TEST(a_lens_is_linearised_where_a_side_touches);
    RUN_TEST(a_missing_side_gives_no_row);
    return UNITY_END();
}
