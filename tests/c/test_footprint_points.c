/* A footprint by points: rows against the extremes of its rim, in double, start, and flights. SPDX-License-Identifier: MIT */
/* tests: lib/refined/goe_footprint.c, lib/refined/goe_footprint_start.c */
#include "refined/goe_footprint.h"

#include <math.h>
#include <string.h>

#include "check.h"
#include "refined/goe_footprint_start.h"
#include "refined/goe_report.h"
#include "scene.h"
#include "sighting.h"

#define CASES 1000
#define HOUSES 300
#define MIRRORED 120 /* images; of later ones rounding decides which no longer fits an ellipse */
#define RIM_POINTS 60
#define BIAS_SHARE 0.1f /* of that of a sighting: tenths of a degree */
#define TWO_PI 6.283185307179586
#define RAD_PER_DEG 0.017453292519943295

static check_random_t any;
static sighting_t sighting;
static goe_sides_t sides;
static double truth[GOE_STATES];
static size_t kind[GOE_ROWS_MAX]; /* feature of each row that should come */
static bool level[GOE_ROWS_MAX];  /* ... measured along y */
static size_t expected_rows;

static scene_t scene;
static goe_settings_t settings;
static goe_estimator_t estimator;
static goe_estimate_t estimate;
static goe_image_t image;
static unsigned phases; /* bit i: phase i was there */
static bool suspected;
static unsigned reasons; /* bit i: reason i was reported */

/* A box on the left whose front and right face are visible until the front turns away; the aircraft passes it closely. */
void setUp(void) {
    scene_default(&scene);
    scene.width_m = 5.0;
    scene.length_m = 9.0;
    scene.height_m = 6.0;
    scene.alpha_deg = 40.0;
    scene.x0_m = -16.0;
    scene.speed_mps = 10.0;
    scene.image_rate_hz = 20.0;
    scene.wobble_deg = 1.0;
    scene.top_nearest = true;
    settings = scene_settings(&scene);
    phases = 0;
    suspected = false;
    reasons = 0;
}
void tearDown(void) {}

/* ---------------------------------------------------------------------------------------------------------- reference -- */

static void rim_point(const double state[GOE_STATES], double at, double point[3]) {
    const double q = state[GOE_INVERSE_RANGE];
    const double depth = state[GOE_HALF] * exp(state[GOE_LOG_DEPTH]);
    point[0] = state[GOE_BEARING] - (double)sighting.sight.camera_m.x * q + state[GOE_HALF] * sin(at);
    point[1] = (double)sighting.sight.height_m * q - state[GOE_TOP];
    point[2] = 1.0 - (double)sighting.sight.camera_m.z * q + state[GOE_SHEAR] * sin(at) + depth * cos(at);
}

/* How far to the right the rim's point appears, and how far along the line of sight to the middle it lies. */
static double to_the_right(const double state[GOE_STATES], double at) {
    double point[3];
    rim_point(state, at, point);
    return point[0] / point[2];
}

static double away(const double state[GOE_STATES], double at) {
    double point[3];
    rim_point(state, at, point);
    const double x = state[GOE_BEARING] - (double)sighting.sight.camera_m.x * state[GOE_INVERSE_RANGE];
    const double z = 1.0 - (double)sighting.sight.camera_m.z * state[GOE_INVERSE_RANGE];
    return (x * point[0] + z * point[2]) / hypot(x, z);
}

/* Angle of the largest of the rim: the best of some points, and parabolas about it. */
static double largest(double (*of)(const double state[GOE_STATES], double at), const double state[GOE_STATES],
                      double sign) {
    double at = 0.0;
    for (int i = 1; i < RIM_POINTS; i++) {
        const double tried = i * (TWO_PI / RIM_POINTS);
        at = sign * of(state, tried) > sign * of(state, at) ? tried : at;
    }
    for (double step = TWO_PI / RIM_POINTS; step > 1.0e-4; step *= 0.1) {
        const double a = sign * of(state, at - step);
        const double c = sign * of(state, at + step);
        const double curve = a - 2.0 * sign * of(state, at) + c;
        at += curve < 0.0 ? 0.5 * step * (a - c) / curve : 0.0;
    }
    return at;
}

static double end_of(size_t feature) {
    return feature == GOE_POINT_LEFT || feature == GOE_POINT_BASE_LEFT ? -1.0 : 1.0;
}

/* Image coordinate. An end: the rim's extreme, at the measured height; top: the rim's point nearest along the line of sight, or the
 * farthest if it is the highest; a base corner along y: the ground at the middle's range. */
static double see(const double state[GOE_STATES], size_t feature, bool along_y) {
    double point[3];
    double seen[2];
    rim_point(truth, 0.0, point);
    const bool farthest = sighting.settings.filter.top_is_highest && point[1] > 0.0;
    if (feature == GOE_POINT_TOP) {
        rim_point(state, largest(away, state, farthest ? 1.0 : -1.0), point);
        sighting_project(&sighting, state, point, seen);
        return seen[1];
    }
    if (!along_y) {
        point[0] = to_the_right(state, largest(to_the_right, state, end_of(feature)));
        point[1] = sighting_height(&sighting, state, feature);
        point[2] = 1.0;
        sighting_project(&sighting, state, point, seen);
        return seen[0];
    }
    const double q = state[GOE_INVERSE_RANGE];
    point[0] = state[GOE_BEARING] - (double)sighting.sight.camera_m.x * q;
    point[1] = (double)sighting.sight.height_m * q + state[GOE_GROUND];
    point[2] = 1.0 - (double)sighting.sight.camera_m.z * q;
    sighting_project(&sighting, state, point, seen);
    return seen[1];
}

static double predict(const sighting_t *of, const double state[GOE_STATES], size_t row) {
    (void)of;
    return see(state, kind[row], level[row]);
}

/* -------------------------------------------------------------------------------------------------------------- input -- */

/* The attitude bias is freed to first order, and by that direction a contact is found: its derivatives are off by the square. */
static void any_footprint(void) {
    const double z0_m = sighting_place(&sighting, &any);
    for (int i = 0; i < GOE_GROUND; i++) {
        sighting.state[i] *= BIAS_SHARE;
    }
    sighting.state[GOE_HALF] = (float)(check_random_between(&any, 0.3, 8.0) / z0_m);
    sighting.state[GOE_SHEAR] = sighting.state[GOE_HALF] * (float)check_random_between(&any, -0.8, 0.8);
    sighting.state[GOE_LOG_DEPTH] = (float)check_random_between(&any, -0.8, 0.8);
    sighting_finish(&sighting, &any, z0_m, truth);
    expected_rows = 0;
}

static void expect(size_t feature, bool along_y) {
    kind[expected_rows] = feature;
    level[expected_rows++] = along_y;
}

/* As it appears; an end or a base corner along x, and at any height or at that of the ground. */
static void measure(size_t feature) {
    goe_point_t *point = &sighting.sight.point[feature];
    point->usable = true;
    point->x = 0.0f;
    point->y = (float)(feature < GOE_POINT_TOP ? check_random_between(&any, -0.2, 0.2) : see(truth, feature, true));
    for (int i = 0; feature != GOE_POINT_TOP && i < SETTLED;
         i++) { /* the height freed of the bias hangs on x a little */
        point->x = (float)see(truth, feature, false);
    }
}

static void make_rows(void) {
    sighting.sight.base =
        sighting.sight.point[GOE_POINT_BASE_LEFT].usable && sighting.sight.point[GOE_POINT_BASE_RIGHT].usable;
    sighting_clear_rows(&sighting);
    goe_footprint_rows(&sighting.sight, &sighting.rows);
}

static void check_rows(void) {
    make_rows();
    TEST_ASSERT_EQUAL_size_t(expected_rows, sighting.rows.count);
    for (size_t row = 0; row < expected_rows; row++) {
        TEST_ASSERT_EQUAL_size_t(kind[row], sighting.rows.feature[row]);
        TEST_ASSERT_EQUAL_INT(level[row] ? GOE_ALONG_Y : GOE_ALONG_X, sighting.rows.axis[row]);
        TEST_ASSERT_EQUAL_INT(!level[row],
                              row < sighting.rows.remembered); /* the ends, which a shape that is no ellipse moves */
    }
    sighting_check_rows(&sighting, predict);
}

/* --------------------------------------------------------------------------------------------------------------- rows -- */

/* [goe_image_t.top, filter.top_is_highest, (R1), (R2), (R5), (R6)]
 * GIVEN footprints of any place, width, shear and depth, with the roof below or above the camera THEN residuals are 0 at the truth and the
 * derivatives are those of the rim's extremes; base corners are the ends where left and right are not visible, and give the
 * range over the ground. */
static void rows_are_those_of_the_rim(void) {
    any = check_random_start("footprints");
    for (int n = 0; n < CASES; n++) {
        const bool silhouette = n % 3 != 0;
        any_footprint();
        measure(GOE_POINT_TOP);
        for (int end = 0; end < 2; end++) {
            const size_t silhouette_end = end == 0 ? GOE_POINT_LEFT : GOE_POINT_RIGHT;
            const size_t base = end == 0 ? GOE_POINT_BASE_LEFT : GOE_POINT_BASE_RIGHT;
            if (silhouette) {
                measure(silhouette_end);
            }
            if (n % 3 != 1) {
                measure(base);
            }
            expect(silhouette ? silhouette_end : base, false);
        }
        expect(GOE_POINT_TOP, true);
        if (n % 3 != 1) {
            expect(GOE_POINT_BASE_LEFT, true);
            expect(GOE_POINT_BASE_RIGHT, true);
        }
        check_rows();
    }
}

/* [goe_image_t.pose] */
static void each_feature_alone_gives_its_row(void) {
    static const size_t features[] = {GOE_POINT_LEFT, GOE_POINT_RIGHT, GOE_POINT_TOP};
    any = check_random_start("alone");
    for (int n = 0; n < 300; n++) {
        any_footprint();
        measure(features[n % 3]);
        expect(features[n % 3], n % 3 == 2);
        check_rows();
    }
}

/* GIVEN a noise model of the shape or of the size THEN it is added to the rows' variance as a share of the width. */
static void shape_and_size_noise_are_shares_of_the_width(void) {
    static const struct {
        float shape, size;
        double added; /* squared share */
    } cases[] = {{0.0f, 0.0f, 0.0}, {0.12f, 0.05f, 0.0169}};
    float plain[3] = {0.0f};
    any = check_random_start("variance");
    any_footprint();
    measure(GOE_POINT_LEFT);
    measure(GOE_POINT_RIGHT);
    measure(GOE_POINT_TOP);
    const double width =
        (double)sighting.sight.point[GOE_POINT_RIGHT].x - (double)sighting.sight.point[GOE_POINT_LEFT].x;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        sighting.settings.detector.shape_error_rel = cases[i].shape;
        sighting.sight.outline_share = cases[i].size;
        make_rows();
        for (size_t row = 0; row < 3; row++) {
            plain[row] = i == 0 ? sighting.rows.variance[row] : plain[row];
            const double added = cases[i].added * width * width;
            CHECK_CLOSE(1.0e-4 * added, added, (double)sighting.rows.variance[row] - (double)plain[row]);
        }
    }
}

/* GIVEN base corners THEN the range that they give is that of the middle within a width, as a corner may lie before it or behind, and
 * twice the noise of a pixel. */
static void a_base_corner_gives_the_range_within_a_width(void) {
    any = check_random_start("base corners");
    for (int n = 0; n < 100; n++) {
        any_footprint();
        measure(GOE_POINT_BASE_LEFT);
        measure(GOE_POINT_BASE_RIGHT);
        make_rows();
        TEST_ASSERT_EQUAL_size_t(4, sighting.rows.count);
        const goe_point_t *p = sighting.sight.point;
        const double width = (double)p[GOE_POINT_BASE_RIGHT].x - (double)p[GOE_POINT_BASE_LEFT].x;
        for (size_t row = 2; row < 4; row++) {
            const goe_feature_t corner = (goe_feature_t)sighting.rows.feature[row];
            const double off = see(truth, corner, true) * width;
            const double expected = 2.0 * (double)goe_observation_spread(&sighting.sight, corner).yy + off * off;
            CHECK_CLOSE(1.0e-4 * expected, expected, sighting.rows.variance[row]);
        }
    }
}

/* [goe_image_t.box]
 * GIVEN a box THEN its sides alone are remembered; left, right and top as points are not read,
 * and the base corners' rows are those without a box. */
static void a_box_replaces_the_points_but_base_corners(void) {
    any = check_random_start("box and corners");
    any_footprint();
    measure(GOE_POINT_BASE_LEFT);
    measure(GOE_POINT_BASE_RIGHT);
    make_rows();
    const goe_rows_t corners = sighting.rows;
    const goe_matrix_t matrix = sighting.matrix;
    sides.usable = GOE_SIDES_ALL;
    sides.px[GOE_BOX_LEFT] = sides.px[GOE_BOX_TOP] = -20.0f;
    sides.px[GOE_BOX_RIGHT] = sides.px[GOE_BOX_BOTTOM] = 20.0f;
    sighting.sight.sides = &sides;
    sighting.sight.point[GOE_POINT_TOP].usable = true;
    make_rows();
    TEST_ASSERT_EQUAL_size_t(GOE_BOX_SIDES, sighting.rows.remembered);
    TEST_ASSERT_EQUAL_size_t(4, corners.count);
    TEST_ASSERT_EQUAL_size_t(GOE_BOX_SIDES + 2, sighting.rows.count); /* the sides show the edges over the corners */
    for (size_t i = 2; i < corners.count; i++) {
        const size_t at = GOE_BOX_SIDES + i - 2;
        TEST_ASSERT_EQUAL_UINT8(corners.feature[i], sighting.rows.feature[at]);
        CHECK_SAME(corners.variance[i], sighting.rows.variance[at]);
        TEST_ASSERT_EQUAL_MEMORY(matrix.row[i], sighting.matrix.row[at], sizeof matrix.row[i]);
    }
    measure(GOE_POINT_LEFT);
    measure(GOE_POINT_RIGHT);
    sighting.sight.point[GOE_POINT_BASE_LEFT].usable = false;
    make_rows();
    TEST_ASSERT_EQUAL_size_t(GOE_BOX_SIDES, sighting.rows.count);
}

/* -------------------------------------------------------------------------------------------------------------- start -- */

static goe_point_t point_at(double azimuth_rad, bool usable) {
    const goe_point_t point = {(float)tan(azimuth_rad), 0.1f, usable};
    return point;
}

/* [goe_image_t.left, (R16)]
 * GIVEN two ends anywhere ahead THEN the filter's axes face the middle of the angle between them, where a disc's center is; the
 * outer base corners serve in place of left and right, and no pair in its order turns nothing. */
static void the_axes_face_the_obstacle(void) {
    any = check_random_start("axes");
    for (int n = 0; n < 300; n++) {
        static goe_filter_t filter;
        goe_view_t view;
        memset(&view, 0, sizeof view);
        goe_filter_clear(&filter);
        const double middle = check_random_between(&any, -1.0, 1.0);
        const double half = check_random_between(&any, 1.0e-3, 0.4);
        const bool silhouette = n % 4 < 2;
        view.point[GOE_POINT_LEFT] = point_at(middle - half, silhouette);
        view.point[GOE_POINT_RIGHT] = point_at(middle + half, silhouette);
        const double base = silhouette ? 0.1 : middle; /* then it is not read */
        view.point[GOE_POINT_BASE_LEFT] = point_at(base - half, n % 4 != 0);
        view.point[GOE_POINT_BASE_RIGHT] = point_at(base + half, n % 4 == 1 || n % 4 == 2);
        TEST_ASSERT_EQUAL(n % 4 != 3, goe_footprint_face(&filter, &view));
        CHECK_CLOSE(1.0e-5, n % 4 != 3 ? sin(middle) : 0.0, filter.axes.turn_sin);
        CHECK_CLOSE(1.0e-5, n % 4 != 3 ? cos(middle) : 1.0, filter.axes.turn_cos);
        const goe_point_t left = view.point[GOE_POINT_BASE_LEFT];
        view.point[GOE_POINT_BASE_LEFT] = view.point[GOE_POINT_BASE_RIGHT];
        view.point[GOE_POINT_BASE_RIGHT] = left;
        view.point[GOE_POINT_LEFT].usable = false;
        TEST_ASSERT_FALSE(goe_footprint_face(&filter, &view));
    }
}

static float first[GOE_STATES];
static goe_triangle_t root;
static bool by_kind; /* the start took the range of the class */

static bool starts(void) { return goe_footprint_start(&sighting.sight, first, &root, &by_kind); }

/* An obstacle dead ahead, between -0.05 and 0.05, with base corners at `y` below the horizon, from 20 m above the ground. */
static void see_base(double y) {
    any_footprint();
    memset(sighting.state, 0, sizeof sighting.state);
    sighting_look(&sighting);
    for (size_t i = 0; i < 2; i++) {
        const float x = i == 0 ? -0.05f : 0.05f;
        sighting.sight.point[GOE_POINT_LEFT + i] = (goe_point_t){x, 0.0f, true};
        sighting.sight.point[i == 0 ? GOE_POINT_BASE_LEFT : GOE_POINT_BASE_RIGHT] = (goe_point_t){x, (float)y, true};
    }
    sighting.sight.base = true;
    sighting.settings.filter.prior_width_m = 4.0f;
}

/* [filter.prior_width_m, (R16)]
 * GIVEN base corners clearly below the horizon THEN flat ground gives the first range; GIVEN ones that lie so near to it that the
 * attitude's error alone may have put them there, a camera below the ground or a height as good as unknown, or no base corners, THEN the
 * typical size does. */
static void flat_ground_gives_the_first_range(void) {
    any = check_random_start("flat ground");
    see_base(0.25);
    const double sigma = sqrt(pow(0.5 * RAD_PER_DEG, 2.0) + pow(0.1 * RAD_PER_DEG, 2.0) +
                              pow((double)goe_observation_pixel(&sighting.sight), 2.0));
    const struct {
        double y;
        float height_m, height_sd_m;
        bool base, ground;
    } cases[] = {{0.25, 20.0f, 0.5f, true, true},         {3.1 * sigma, 20.0f, 0.5f, true, true},
                 {2.9 * sigma, 20.0f, 0.5f, true, false}, {0.25, -20.0f, 0.5f, true, false},
                 {0.25, 20.0f, 6.8f, true, false},        {0.25, 20.0f, 6.5f, true, true},
                 {3.1 * sigma, 20.0f, 0.5f, false, false}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        see_base(cases[i].y);
        sighting.sight.height_m = cases[i].height_m;
        sighting.sight.height_sd_m = cases[i].height_sd_m;
        sighting.sight.base = cases[i].base;
        TEST_ASSERT_TRUE(starts());
        const double expected_m = cases[i].ground ? 20.0 / cases[i].y : 4.0 / 0.1;
        CHECK_CLOSE(1.0e-5 * expected_m, expected_m, 1.0 / (double)first[GOE_INVERSE_RANGE]);
    }
}

static void check_root(const double sigma[GOE_STATES]) {
    for (size_t i = 0; i < GOE_STATES; i++) {
        CHECK_CLOSE(1.0e-4, 1.0, sigma[i] * (double)*goe_srif_at(&root, i, i));
        for (size_t j = i + 1; j < GOE_STATES; j++) {
            CHECK_SAME(0.0f, *goe_srif_at(&root, i, j));
        }
    }
}

/* GIVEN a start THEN it is a disc dead ahead, and the first image gives no more information than it has: the sensors' errors as
 * configured, the range within a factor of five, and all extents by several times themselves, as later images will determine them
 * better; but a configured disc is one. */
static void a_start_is_as_uncertain_as_one_image(void) {
    any = check_random_start("first root");
    see_base(0.25);
    sighting.sight.point[GOE_POINT_TOP] = (goe_point_t){0.0f, -0.3f, true};
    sighting.sight.height_sd_m = 0.7f;
    sighting.settings.navigation.velocity_bias_sd_m_s = 0.1f;
    sighting.settings.navigation.terrain_slope_sd = 0.03f;
    sighting.sight.state = first;
    memset(first, 0xA5, sizeof first); /* whatever was there before */
    TEST_ASSERT_TRUE(starts());
    for (size_t i = 0; i < GOE_STATES; i++) { /* biases, ground, bearing, shear, log of depth over width */
        if (i != GOE_INVERSE_RANGE && i != GOE_TOP && i != GOE_HALF) {
            CHECK_SAME(0.0f, first[i]);
        }
    }
    const double bias = 0.5 * RAD_PER_DEG;
    const double q = (double)first[GOE_INVERSE_RANGE];
    const double top = (20.0 + 0.3 * 80.0) * q;
    CHECK_CLOSE(1.0e-6, top, first[GOE_TOP]);
    CHECK_CLOSE(1.0e-6, 0.05, first[GOE_HALF]);
    double sigma[GOE_STATES] = {
        bias, bias, hypot(bias, 0.008), hypot(0.7 * q, 0.03), 1.0, 4.0 * q, 10.0 * top, 0.6 * 0.05, 2.5 * 0.1, 1.0};
    check_root(sigma);
    sighting.sight.is_round = true;
    sigma[GOE_SHEAR] = 0.02 * 0.05; /* enough to show that it is none */
    sigma[GOE_LOG_DEPTH] = 1.0e-3;
    TEST_ASSERT_TRUE(starts());
    check_root(sigma);
    sides.usable = GOE_SIDE_TOP; /* an upright box knows no more of the height */
    sighting.sight.sides = &sides;
    TEST_ASSERT_TRUE(starts());
    check_root(sigma);
    sighting.sight.point[GOE_POINT_TOP].y = 0.2499f; /* a top near the altimeter's zero */
    TEST_ASSERT_TRUE(starts());
    CHECK_CLOSE(1.0e-3, 1.0, 10.0 * 0.1 * (double)*goe_srif_at(&root, GOE_TOP, GOE_TOP));
}

/* GIVEN a height that is as good as not known THEN the first base corners set it, by the range of the typical size. */
static void without_an_altimeter_the_base_gives_the_height(void) {
    any = check_random_start("no altimeter");
    see_base(0.25);
    sighting.sight.height_sd_m = 100.0f;
    TEST_ASSERT_TRUE(starts());
    CHECK_CLOSE(1.0e-6, 0.25 - 20.0 / 40.0, first[GOE_GROUND]);
    sighting.sight.base = false;
    TEST_ASSERT_TRUE(starts());
    CHECK_SAME(0.0f, first[GOE_GROUND]);
}

/* [goe_image_t.left] */
static void no_width_is_no_start(void) {
    any = check_random_start("no start");
    any_footprint();
    sighting.sight.base = false;
    measure(GOE_POINT_LEFT);
    TEST_ASSERT_FALSE(starts());
    measure(GOE_POINT_RIGHT);
    sighting.sight.point[GOE_POINT_RIGHT].x = sighting.sight.point[GOE_POINT_LEFT].x;
    TEST_ASSERT_FALSE(starts());
}

/* -------------------------------------------------------------------------------------------------------------- depth -- */

static goe_filter_t filter;

/* GIVEN a line of sight that has turned up to the latest image that gave rows, to either side, THEN from a sine of 0.3 on images are
 * said to give the depth. */
static void a_turned_line_of_sight_gives_the_depth(void) {
    for (int side = -1; side <= 1; side += 2) {
        for (int known = 0; known < 2; known++) {
            goe_filter_clear(&filter);
            filter.state[GOE_BEARING] = 0.2f;
            filter.state[GOE_INVERSE_RANGE] = 0.01f;
            const double azimuth = atan(0.2) + side * asin(known == 1 ? 0.301 : 0.299);
            filter.measured.dz_m = 40.0f;
            filter.measured.dx_m = (float)(20.0 - 60.0 * tan(azimuth));
            TEST_ASSERT_EQUAL(known == 1, goe_footprint_knows_depth(&filter));
        }
    }
}

/* ------------------------------------------------------------------------------------------------------------ flights -- */

static void start(void) {
    settings.camera = scene.camera;
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
}

static void update(void) {
    (void)goe_update(&estimator, &image, &estimate);
    phases |= 1u << estimator.filter.phase;
    suspected = suspected || estimate.suspect;
    reasons |= 1u << estimate.reason;
}

static bool was_reported(goe_reason_t reason) { return (reasons >> reason & 1u) != 0u; }

static bool was_in(goe_phase_t phase) { return (phases >> phase & 1u) != 0u; }

static void see_silhouette(int k, double sigma_px) {
    scene_image(&scene, k, &image, NULL);
    image.base_left.visible = image.base_near.visible = image.base_right.visible = false;
    scene_add_noise(&image, &any, sigma_px);
    update();
}

static double half_diagonal(void) { return 0.5 * hypot(scene.width_m, scene.length_m); }

/* The estimate's center from the box's, in sigmas of each axis; the camera starts at north 0, east 0, heading north. */
static double center_off(void) {
    const double s = sin(scene.alpha_deg * RAD_PER_DEG);
    const double c = cos(scene.alpha_deg * RAD_PER_DEG);
    const double north = scene.z0_m + 0.5 * scene.length_m * c - (double)estimate.center_north_m;
    const double east = scene.x0_m + 0.5 * scene.length_m * s - (double)estimate.center_east_m;
    return fmax(fabs(north) / (double)estimate.sigma.center_north_m, fabs(east) / (double)estimate.sigma.center_east_m);
}

/* A house of 6 to 20 m by 6 to 20 m, 3 to 15 m high, whose outline lies 3 to 40 m to the side of a straight, level flight. */
static int any_house(void) {
    scene_default(&scene);
    scene.width_m = check_random_between(&any, 6.0, 20.0);
    scene.length_m = check_random_between(&any, 6.0, 20.0);
    scene.height_m = check_random_between(&any, 3.0, 15.0);
    scene.alpha_deg = check_random_between(&any, -80.0, 80.0);
    scene.altitude_m = check_random_between(&any, 15.0, 60.0);
    scene.speed_mps = check_random_between(&any, 12.0, 30.0);
    scene.top_nearest = true;
    scene.wobble_deg = 0.0;
    const double reach_s = check_random_between(&any, 10.0, 20.0);
    const double aside = half_diagonal() + check_random_between(&any, 3.0, 40.0);
    scene.z0_m = scene.speed_mps * reach_s;
    scene.x0_m = check_random_bits(&any) % 2u != 0u ? aside : -aside;
    settings = scene_settings(&scene);
    return (int)(scene.image_rate_hz * (reach_s - 1.0 - half_diagonal() / scene.speed_mps));
}

/* Worst error of the center, or of the height, in sigmas, of all answers of a flight that are not suspect. */
static double worst_confident(int images) {
    double worst = 0.0;
    start();
    for (int k = 0; k < images; k++) {
        see_silhouette(k, 0.5);
        TEST_ASSERT_EQUAL_HEX32(0u, estimate.valid & (GOE_HAS_LENGTH | GOE_HAS_ORIENTATION));
        if (!estimate.fresh || estimate.suspect) {
            continue;
        }
        if (estimate.valid & GOE_HAS_CENTER) {
            check_worst(&worst, center_off());
        }
        if (estimate.valid & GOE_HAS_HEIGHT) {
            check_worst(&worst, ((double)estimate.height_m - scene.height_m) / (double)estimate.sigma.height_m);
        }
    }
    return worst;
}

/* [A30]
 * GIVEN the outlines of typical houses in straight flights THEN none is said to have an orientation or a length, and hardly one is reported
 * wrong by six sigma. */
static void outlines_of_houses_are_not_confidently_wrong(void) {
    int wrong = 0;
    any = check_random_start("houses");
    for (int n = 0; n < HOUSES; n++) {
        const int images = any_house();
        wrong += worst_confident(images) > 6.0 ? 1 : 0;
    }
    check_report("houses reported wrong by six sigma, of 300", wrong);
    TEST_ASSERT_TRUE(wrong <= 3); /* one of a hundred; 0.3 % of thousands of flights */
}

/* GIVEN a flight WHEN it is mirrored THEN the same models come at the same images, and the footprint is the mirrored one. */
static void left_and_right_are_equal(void) {
    goe_estimate_t plain[MIRRORED];
    scene.camera.cx_px = 0.0f;
    scene_clear_noise(&settings);
    start();
    for (int k = 0; k < MIRRORED; k++) {
        see_silhouette(k, 0.0);
        plain[k] = estimate;
    }
    TEST_ASSERT_EQUAL_INT(GOE_MODEL_PRISM, estimate.model);
    scene = scene_mirrored(&scene);
    start();
    for (int k = 0; k < MIRRORED; k++) {
        see_silhouette(k, 0.0);
        TEST_ASSERT_EQUAL_INT(plain[k].model, estimate.model);
        TEST_ASSERT_EQUAL_HEX32(plain[k].valid, estimate.valid);
        CHECK_CLOSE(2.0e-3, -plain[k].x0_m, estimate.x0_m);
        CHECK_CLOSE(2.0e-3, plain[k].z0_m, estimate.z0_m);
        CHECK_CLOSE(2.0e-3, plain[k].width_m, estimate.width_m);
        CHECK_CLOSE(1.0e-2 * (double)plain[k].sigma.width_m, plain[k].sigma.width_m, estimate.sigma.width_m);
    }
}

/* GIVEN a box that starts by its silhouette WHEN its base comes into view THEN it becomes a box by its corners. */
static void base_corners_make_a_box_of_it(void) {
    const double share = 1.0e-3;
    scene_clear_noise(&settings);
    start();
    for (int k = 0; k < 60; k++) {
        see_silhouette(k, 0.0);
    }
    TEST_ASSERT_EQUAL_INT(GOE_PHASE_FOOTPRINT, estimator.filter.phase);
    for (int k = 60; k < 100; k++) {
        scene_image(&scene, k, &image, NULL);
        update();
    }
    TEST_ASSERT_EQUAL_INT(GOE_MODEL_BOX, estimate.model);
    TEST_ASSERT_EQUAL_HEX32(0x3Fu, estimate.valid);
    CHECK_CLOSE(90.0 * share, scene.alpha_deg, estimate.orientation_deg);
    CHECK_CLOSE(scene.width_m * share, scene.width_m, estimate.width_m);
    CHECK_CLOSE(scene.length_m * share, scene.length_m, estimate.length_m);
    CHECK_CLOSE(scene.z0_m * share, scene.z0_m, estimate.z0_m);
    CHECK_CLOSE(scene.z0_m * share, scene.x0_m, estimate.x0_m);
    CHECK_CLOSE(scene.height_m * share, scene.height_m, estimate.height_m);
    TEST_ASSERT_TRUE(center_off() < 2.0);
}

/* [GOE_REASON_SHAPE] GIVEN cylinders, noise-free and noisy THEN they are no boxes and not suspect, and right within their sigmas,
 * whether or not a disc was configured. */
static void a_cylinder_is_not_suspect(void) {
    any = check_random_start("cylinders");
    for (int i = 0; i < 12; i++) {
        setUp();
        scene_make_cylinder(&scene);
        scene.width_m = 2.0 + 2.0 * i;
        scene.x0_m = i % 2 ? -25.0 : 30.0;
        scene.path = (scene_path_t)(i % 3);
        settings.model = i < 6 ? GOE_MODEL_AUTO : GOE_MODEL_DISC;
        start();
        for (int k = 0; k < 150; k++) {
            see_silhouette(k, i % 4 < 2 ? 0.0 : 0.5);
            TEST_ASSERT_FALSE(estimate.suspect);
        }
        TEST_ASSERT_FALSE(was_in(GOE_PHASE_BOX) || was_in(GOE_PHASE_BOX_FACE));
        TEST_ASSERT_EQUAL_INT(i < 6 ? GOE_MODEL_PRISM : GOE_MODEL_DISC, estimate.model);
        CHECK_CLOSE(3.0 * (double)estimate.sigma.width_m, scene.width_m, estimate.width_m);
        CHECK_CLOSE(3.0 * (double)estimate.sigma.z0_m, scene.z0_m, estimate.z0_m);
    }
}

/* [goe_report.c, GOE_REASON_SHAPE] GIVEN a long box WHEN a disc is configured THEN it is reported, and reported as suspect. */
static void a_disc_by_force_is_suspect(void) {
    any = check_random_start("force");
    scene.length_m = 18.0;
    settings.model = GOE_MODEL_DISC;
    settings.navigation.position_walk_sd_m = 0.0f; /* as it is flown */
    scene_level_ground(&settings);
    start();
    for (int k = 0; k < 145; k++) {
        see_silhouette(k, 0.3);
    }
    TEST_ASSERT_EQUAL_INT(GOE_MODEL_DISC, estimate.model);
    TEST_ASSERT_TRUE(estimate.suspect);
    TEST_ASSERT_EQUAL_INT(GOE_REASON_SHAPE, estimate.reason);
}

/* ------------------------------------------------------------------------------------------------------ base corners -- */

/* A cylinder from a detector without a sense of shape: the lower corners of its bounding box, and the point between. */
static void fake_base(int k) {
    scene_truth_t seen;
    scene_image(&scene, k, &image, &seen);
    const double radius = 0.5 * scene.width_m;
    const double range = hypot(seen.x_m, seen.z_m);
    const double nearest = seen.z_m * (1.0 - radius / range);
    const float v =
        (float)((double)scene.camera.cy_px + (double)scene.camera.fy_px * seen.height_above_ground_m / nearest);
    image.base_left = image.left;
    image.base_right = image.right;
    image.base_near = image.left;
    image.base_near.u_px = (float)((double)scene.camera.cx_px + (double)scene.camera.fx_px * seen.x_m / seen.z_m);
    image.base_left.v_px = v;
    image.base_right.v_px = v;
    image.base_near.v_px = v;
}

/* GIVEN a cylinder with base corners that it does not have THEN the answer is suspect sooner or later. */
static void false_base_corners_are_found_out(void) {
    any = check_random_start("false corners");
    scene_make_cylinder(&scene);
    scene.width_m = 12.0;
    scene.wobble_deg = 0.0;
    start();
    for (int k = 0; k < 170; k++) {
        fake_base(k);
        scene_add_noise(&image, &any, 0.3);
        update();
    }
    TEST_ASSERT_TRUE(was_in(GOE_PHASE_BOX));
    TEST_ASSERT_TRUE(suspected);
    TEST_ASSERT_TRUE(was_reported(GOE_REASON_BASE));
    TEST_ASSERT_EQUAL_INT(GOE_REASON_BASE, estimate.reason); /* and stays so */
    TEST_ASSERT_FALSE(goe_filter_is_box(&estimator.filter));
}

/* [goe_estimate_t.suspect, filter.nis_ratio_max]
 * GIVEN noise larger than configured by a factor of 2 THEN a true box is suspect, but keeps its base corners in the end. */
static void noise_does_not_make_corners_false(void) {
    any = check_random_start("large noise");
    start();
    for (int k = 0; k < 170; k++) {
        scene_image(&scene, k, &image, NULL);
        scene_add_noise(&image, &any, 1.0);
        update();
    }
    TEST_ASSERT_TRUE(suspected);
    TEST_ASSERT_TRUE(was_reported(GOE_REASON_NOISE));
    TEST_ASSERT_FALSE(was_reported(GOE_REASON_BASE));
    TEST_ASSERT_FALSE(estimator.filter.health.base_refused);
    TEST_ASSERT_EQUAL_INT(GOE_MODEL_BOX, estimate.model);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(rows_are_those_of_the_rim);
    RUN_TEST(each_feature_alone_gives_its_row);
    RUN_TEST(shape_and_size_noise_are_shares_of_the_width);
    RUN_TEST(a_base_corner_gives_the_range_within_a_width);
    RUN_TEST(a_box_replaces_the_points_but_base_corners);
    RUN_TEST(the_axes_face_the_obstacle);
    RUN_TEST(flat_ground_gives_the_first_range);
    RUN_TEST(a_start_is_as_uncertain_as_one_image);
    RUN_TEST(without_an_altimeter_the_base_gives_the_height);
    RUN_TEST(no_width_is_no_start);
    RUN_TEST(a_turned_line_of_sight_gives_the_depth);
    RUN_TEST(outlines_of_houses_are_not_confidently_wrong);
    RUN_TEST(left_and_right_are_equal);
    RUN_TEST(base_corners_make_a_box_of_it);
    RUN_TEST(a_cylinder_is_not_suspect);
    RUN_TEST(a_disc_by_force_is_suspect);
    RUN_TEST(false_base_corners_are_found_out);
    RUN_TEST(noise_does_not_make_corners_false);
    return UNITY_END();
}
