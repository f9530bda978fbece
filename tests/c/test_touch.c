/* Sides of upright bounding boxes on boxes and footprints, against the extremes of the visible points in double.
 * SPDX-License-Identifier: MIT */
/* tests: lib/refined/goe_touch.c */
#include "refined/goe_touch.h"

#include <math.h>
#include <string.h>

#include "check.h"
#include "refined/goe_box.h"
#include "refined/goe_footprint.h"
#include "scene.h"
#include "upright.h"

#define CASES 400
#define FOOTPRINTS 40
#define RIM_POINTS 40
#define RAD_PER_DEG 0.017453292519943295
#define RESIDUAL_BOUND 3.0e-6 /* rounding, for derivatives of 1 */
#define STEP 1.0e-6
#define IMAGES 64

typedef enum { A_BOX, A_FOOTPRINT } model_t;

static const size_t box_sides[] = {GOE_BOX_LEFT, GOE_BOX_RIGHT, GOE_BOX_TOP}; /* the foot is that of the corners */
static const size_t footprint_sides[] = {GOE_BOX_LEFT, GOE_BOX_TOP, GOE_BOX_RIGHT, GOE_BOX_BOTTOM};
static const size_t feature_of_side[] = {GOE_POINT_LEFT, GOE_POINT_TOP, GOE_POINT_RIGHT, GOE_POINT_BASE_NEAR};

static check_random_t any;
static sighting_t sighting;
static goe_sides_t sides;
static model_t model;

void setUp(void) {}
void tearDown(void) {}

/* ---------------------------------------------------------------------------------------------------------- reference -- */

/* Corner or rim point, units of Z0. */
static void solid_point(const double state[GOE_STATES], size_t side, double at, bool foot, double point[3]) {
    (void)side;
    const double q = state[GOE_INVERSE_RANGE];
    const double h = (double)sighting.sight.height_m * q;
    double *x = &point[0];
    double *z = &point[2];
    point[1] = foot ? h + state[GOE_GROUND] : h - state[GOE_TOP];
    *x = state[GOE_BEARING] - (double)sighting.sight.camera_m.x * q;
    *z = 1.0 - (double)sighting.sight.camera_m.z * q;
    if (model == A_BOX) {
        const int i = (int)at;
        const double d = state[GOE_DEPTH_DIFFERENCE];
        const double deep = 0.5 * (d + sqrt(d * d + 4.0 * fabs(state[GOE_SIDE_X]) * state[GOE_FRONT_X]));
        const double across = i % 2 == 0 ? -0.5 : 0.5;
        const double along = i < 2 ? 0.0 : 1.0;
        *x += across * state[GOE_FRONT_X] + along * state[GOE_SIDE_X];
        *z += -across * state[GOE_FRONT_X] * state[GOE_SIDE_X] / deep + along * deep;
    } else {
        *x += state[GOE_HALF] * sin(at);
        *z += state[GOE_SHEAR] * sin(at) + state[GOE_HALF] * exp(state[GOE_LOG_DEPTH]) * cos(at);
    }
}

static const upright_t solids[] = {{&sighting, solid_point, 4, false, STEP},
                                   {&sighting, solid_point, RIM_POINTS, true, STEP}};

/* -------------------------------------------------------------------------------------------------------------- input -- */

static void set_extents(double z0_m) {
    const double w = check_random_between(&any, 2.0, 20.0) / z0_m;
    if (model == A_FOOTPRINT) {
        sighting.state[GOE_HALF] = (float)(0.5 * w);
        sighting.state[GOE_SHEAR] = (float)(0.5 * w * check_random_between(&any, -1.0, 1.0));
        sighting.state[GOE_LOG_DEPTH] = (float)check_random_between(&any, -0.8, 0.8);
        return;
    }
    const double b = (check_random_bits(&any) % 2u != 0u ? 1.0 : -1.0) * check_random_between(&any, 5.0, 80.0);
    const double l = check_random_between(&any, 2.0, 20.0) / z0_m;
    const double s = sin(b * RAD_PER_DEG);
    const double c = cos(b * RAD_PER_DEG);
    sighting.state[GOE_SIDE_X] = (float)(l * s);
    sighting.state[GOE_FRONT_X] = (float)(w * c);
    sighting.state[GOE_DEPTH_DIFFERENCE] = (float)(l * c - w * fabs(s));
}

static void any_obstacle(double truth[GOE_STATES]) {
    const double z0_m = sighting_place(&sighting, &any);
    upright_roll(&sighting, check_random_between(&any, -0.5, 0.5));
    sighting.state[GOE_BEARING] = (float)check_random_between(&any, -0.3, 0.3);
    set_extents(z0_m);
    sighting.sight.sides = &sides;
    sighting_finish(&sighting, &any, z0_m, truth);
    upright_measure(&solids[model], truth, &sides);
}

static void make_rows(void) {
    sighting_clear_rows(&sighting);
    if (model == A_BOX) {
        goe_box_rows(&sighting.sight, &sighting.rows);
    } else {
        goe_footprint_rows(&sighting.sight, &sighting.rows);
    }
    goe_rows_end(&sighting.rows, &sighting.sight);
}

/* -------------------------------------------------------------------------------------------------------------- tests -- */

static void check_model(model_t of, int cases, const size_t *expected, size_t count) {
    double truth[GOE_STATES];
    model = of;
    any = check_random_start(of == A_BOX ? "boxes" : "footprints");
    for (int n = 0; n < cases; n++) {
        any_obstacle(truth);
        make_rows();
        TEST_ASSERT_EQUAL_size_t(count, sighting.rows.count);
        for (size_t i = 0; i < count; i++) {
            TEST_ASSERT_EQUAL_size_t(feature_of_side[expected[i]], sighting.rows.feature[i]);
            upright_check_row(&solids[of], truth, expected[i], sighting.matrix.row[i]);
        }
    }
}

/* [A29, goe_image_t.box, (R25)]
 * GIVEN obstacles of any size and place, a camera above or below the roof that rolls by up to 30 degrees, under an attitude bias,
 * WHEN a box replaces left, right and top THEN the sides leave no residual whichever top is configured, and the derivatives are
 * those of the extremes of roof and foot. */
static void sides_touch_a_box_where_its_image_ends(void) { check_model(A_BOX, CASES, box_sides, 3); }
/* [A29, goe_image_t.box, (R25)] */
static void sides_touch_a_footprint_where_its_image_ends(void) {
    check_model(A_FOOTPRINT, FOOTPRINTS, footprint_sides, GOE_BOX_SIDES);
}

/* [A29] GIVEN an invisible side THEN it gives no row, and the others give theirs. */
static void a_side_that_is_not_visible_gives_no_row(void) {
    double truth[GOE_STATES];
    model = A_BOX;
    any = check_random_start("some sides");
    any_obstacle(truth);
    sides.usable = GOE_SIDE_RIGHT | GOE_SIDE_TOP;
    make_rows();
    TEST_ASSERT_EQUAL_size_t(2, sighting.rows.count);
    TEST_ASSERT_EQUAL_size_t(GOE_POINT_RIGHT, sighting.rows.feature[0]);
    TEST_ASSERT_EQUAL_size_t(GOE_POINT_TOP, sighting.rows.feature[1]);
}

/* A cylinder 10 m wide and 100 m ahead, whose upright box has no extent: all sides lie on the principal point. */
static void cylinder_ahead(double roof_m, double pitch_down_deg) {
    const double c = cos(pitch_down_deg * RAD_PER_DEG);
    const double s = sin(pitch_down_deg * RAD_PER_DEG);
    const float pitched[9] = {1.0f, 0.0f, 0.0f, 0.0f, (float)c, (float)s, 0.0f, (float)-s, (float)c};
    model = A_FOOTPRINT;
    any = check_random_start("cylinder ahead");
    sighting_start(&sighting, &any);
    memset(sighting.state, 0, sizeof sighting.state);
    memcpy(sighting.sight.camera_to_axes, pitched, sizeof pitched);
    sighting.sight.camera_m = (goe_xz_t){0.0f, 0.0f};
    sighting.sight.sides = &sides;
    sighting.state[GOE_INVERSE_RANGE] = 0.01f;
    sighting.state[GOE_HALF] = 0.05f;
    sighting.state[GOE_TOP] = (float)(0.01 * roof_m);
    sighting_look(&sighting);
    sides.usable = GOE_SIDES_ALL;
    sides.cut = false;
    sides.doubtful = 0;
    for (size_t side = 0; side < GOE_BOX_SIDES; side++) {
        sides.px[side] = (side & 1u) ? sighting.settings.camera.cy_px : sighting.settings.camera.cx_px;
    }
}

/* GIVEN a cylinder whose roof is as high as a level camera WHEN the top is measured there THEN its plane is level and meets no point
 * of the rim before the others: the nearest counts, 95 m away, and nothing is divided by the missing horizontal part. */
static void a_level_plane_touches_the_nearest_point(void) {
    cylinder_ahead(20.0, 0.0);
    make_rows();
    TEST_ASSERT_EQUAL_size_t(GOE_BOX_SIDES, sighting.rows.count);
    TEST_ASSERT_EQUAL_size_t(GOE_POINT_TOP, sighting.rows.feature[1]);
    const float *by = &sighting.matrix.row[1][GOE_STATE_COLUMN];
    CHECK_CLOSE(RESIDUAL_BOUND, 0.0, sighting.matrix.row[1][GOE_RESIDUAL]);
    CHECK_CLOSE(1.0e-5, -1.0 / 0.95, by[GOE_TOP]);
    CHECK_CLOSE(1.0e-5, 0.0, by[GOE_BEARING]);
}

/* [(R27)] GIVEN a camera with a lens that looks 60 degrees down WHEN the foot is ahead of it and the head of a tall cylinder is not THEN the
 * top gives no row, and left and right say nothing about either height, as where the head is hidden; a low one gives all rows. */
static void a_head_behind_the_camera_counts_as_hidden(void) {
    for (int tall = 0; tall < 2; tall++) {
        cylinder_ahead(tall ? 100.0 : 5.0, 60.0);
        sighting.settings.camera.k1 = -0.05f;
        make_rows();
        TEST_ASSERT_EQUAL_size_t(tall ? 3 : GOE_BOX_SIDES, sighting.rows.count);
        for (size_t i = 0; i < sighting.rows.count; i++) {
            const float *by = &sighting.matrix.row[i][GOE_STATE_COLUMN];
            if (tall) {
                TEST_ASSERT_TRUE(sighting.rows.feature[i] != GOE_POINT_TOP);
            }
            if (tall && sighting.rows.axis[i] == GOE_ALONG_X) {
                CHECK_SAME(0.0f, by[GOE_GROUND]);
                CHECK_SAME(0.0f, by[GOE_TOP]);
            }
        }
    }
}

/* Rows of the cylinder of 10 m height from 20 m above the ground, level, where only `seen` is measured. The upright edges' heads lie 0.1 below
 * the optical axis, in focal lengths, without a lens. */
static size_t rows_seen(unsigned seen, float height_px, float cy_px, float k1) {
    cylinder_ahead(10.0, 0.0);
    sighting.settings.camera.height_px = height_px;
    sighting.settings.camera.cy_px = cy_px;
    sighting.settings.camera.k1 = k1;
    sides.usable = (uint8_t)seen;
    make_rows();
    return sighting.rows.count;
}

/* [(R27), camera.height_px]
 * GIVEN a box whose bottom is not measured WHEN the image ends above the heads of its upright edges THEN left and right give no row,
 * because they are where the border crosses the roof; below the heads they give theirs. With a lens as without. Where the bottom is
 * measured, or the image's height is not known, nothing is left out. */
static void an_edge_outside_the_image_gives_no_row(void) {
    const unsigned no_bottom = GOE_SIDES_ALL & ~(unsigned)GOE_SIDE_BOTTOM;
    for (int bent = 0; bent < 2; bent++) {
        const float k1 = bent ? -0.3f : 0.0f;
        double at[2];
        cylinder_ahead(10.0, 0.0);
        goe_camera_t camera = sighting.settings.camera;
        camera.k1 = k1;
        const float cy_px = camera.cy_px;
        scene_distort(&camera, 0.05, 0.1, &at[0], &at[1]);
        const float head_px = (float)at[1] * camera.fy_px;
        TEST_ASSERT_EQUAL_size_t(1, rows_seen(no_bottom, cy_px + head_px - 1.0f, cy_px, k1));
        TEST_ASSERT_EQUAL_size_t(3, rows_seen(no_bottom, cy_px + head_px + 1.0f, cy_px, k1));
        TEST_ASSERT_EQUAL_size_t(3, rows_seen(no_bottom, 0.0f, cy_px, k1));
        TEST_ASSERT_EQUAL_size_t(4, rows_seen(GOE_SIDES_ALL, cy_px + head_px - 1.0f, cy_px, k1));
        TEST_ASSERT_EQUAL_size_t(0, rows_seen(GOE_SIDE_LEFT | GOE_SIDE_RIGHT, cy_px + head_px - 1.0f, cy_px, k1));
    }
}

/* [detector.box_noise_rel]
 * GIVEN a bottom that the border may cut WHEN the position is known and the foot lies in the image THEN it gives its row; WHEN the foot lies
 * below the image, or nothing is known, THEN it gives none, and the box counts as one without a bottom. The same of the top. */
static void a_doubtful_side_gives_a_row_where_the_solid_ends_in_the_image(void) {
    for (int above = 0; above < 2; above++) {
        for (int placed = 0; placed < 2; placed++) {
            for (int inside = 0; inside < 2; inside++) {
                const float cy_px = 300.0f;
                cylinder_ahead(above ? 30.0 : 10.0, 0.0);
                goe_camera_t *camera = &sighting.settings.camera;
                const float edge_px =
                    0.2f * camera->fy_px / 0.95f; /* of the nearest foot; of the head, half of it above the axis */
                camera->cy_px = above ? (0.5f * edge_px + (inside ? 1.0f : -1.0f)) : cy_px;
                camera->height_px = above ? 4000.0f : cy_px + edge_px + (inside ? 1.0f : -1.0f);
                sides.px[GOE_BOX_TOP] = camera->cy_px - (above ? 0.105f : 0.0f) * camera->fy_px;
                sides.px[GOE_BOX_BOTTOM] = camera->cy_px + 0.21f * camera->fy_px;
                sides.doubtful = above ? GOE_SIDE_TOP : GOE_SIDE_BOTTOM;
                sighting.sight.is_placed = placed != 0;
                make_rows();
                size_t level = 0;
                for (size_t i = 0; i < sighting.rows.count; i++) {
                    level += sighting.rows.axis[i] == GOE_ALONG_Y ? 1u : 0u;
                }
                TEST_ASSERT_EQUAL_size_t(placed && inside ? 2u : 1u, level);
            }
        }
    }
}

/* ------------------------------------------------------------------------------------------------------------ flights -- */

static goe_settings_t settings;
static goe_estimator_t estimator;
static goe_estimate_t estimate;

/* A house of 10 m by 15 m by 8 m on the right of the way, by its base corners and its box. */
static scene_t house(double altitude_m, double roll_deg) {
    scene_t scene;
    scene_default(&scene);
    scene.width_m = 10.0;
    scene.length_m = 15.0;
    scene.height_m = 8.0;
    scene.x0_m = 20.0;
    scene.z0_m = 192.5;
    scene.speed_mps = 20.0;
    scene.altitude_m = altitude_m;
    scene.roll_deg = roll_deg;
    return scene;
}

/* Flies past it; returns the worst error of a reported height, in its sigmas. */
static double worst_height(const scene_t *scene) {
    scene_t by_box = *scene;
    double worst = 0.0;
    int reported = 0;
    by_box.boxes = true;
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
    for (int k = 0; k < IMAGES; k++) {
        goe_image_t image;
        goe_image_t boxed;
        scene_image(scene, k, &image, NULL);
        scene_image(&by_box, k, &boxed, NULL);
        image.box = boxed.box;
        (void)goe_update(&estimator, &image, &estimate);
        if (estimate.fresh && (estimate.valid & GOE_HAS_HEIGHT) != 0u) {
            reported += estimate.model == GOE_MODEL_BOX ? 1 : 0;
            check_worst(&worst, ((double)estimate.height_m - scene->height_m) / (double)estimate.sigma.height_m);
        }
        TEST_ASSERT_FALSE(estimate.suspect);
    }
    TEST_ASSERT_TRUE(reported > IMAGES / 4); /* of a box, which needs a range first */
    return worst;
}

/* [A29] GIVEN an exact box and exact base corners WHEN the camera flies over the roof or below it, level or rolled THEN the height is
 * right within three sigma, whichever point the setting calls the top: that one is about points. */
static void a_house_by_its_box_and_its_corners_has_its_height(void) {
    for (int i = 0; i < 12; i++) {
        const double roll_deg[3] = {0.0, 10.0, -25.0};
        scene_t scene = house(i % 2 == 0 ? 30.0 : 5.0, roll_deg[i / 4]);
        settings = scene_settings(&scene);
        settings.filter.top_is_highest = i / 2 % 2 == 1;
        const double worst = worst_height(&scene);
        check_report("worst height, sigmas", worst);
        TEST_ASSERT_TRUE(worst < 3.0);
    }
}

/* [A29] GIVEN the same by a detector that is good to half a percent THEN a rolled house keeps its height, its width and its length:
 * points in place of the box would be off by more than that detector. */
static void a_good_detector_is_not_spoiled_by_roll(void) {
    scene_t scene = house(30.0, 25.0);
    settings = scene_settings(&scene);
    settings.detector.box_noise_rel = 0.005f;
    TEST_ASSERT_TRUE(worst_height(&scene) < 3.0);
    CHECK_CLOSE(0.3, 10.0, estimate.width_m);
    CHECK_CLOSE(0.3, 15.0, estimate.length_m);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(sides_touch_a_box_where_its_image_ends);
    RUN_TEST(sides_touch_a_footprint_where_its_image_ends);
    RUN_TEST(a_side_that_is_not_visible_gives_no_row);
    RUN_TEST(a_level_plane_touches_the_nearest_point);
    RUN_TEST(a_head_behind_the_camera_counts_as_hidden);
    RUN_TEST(an_edge_outside_the_image_gives_no_row);
    RUN_TEST(a_doubtful_side_gives_a_row_where_the_solid_ends_in_the_image);
    RUN_TEST(a_house_by_its_box_and_its_corners_has_its_height);
    RUN_TEST(a_good_detector_is_not_spoiled_by_roll);
    return UNITY_END();
}
