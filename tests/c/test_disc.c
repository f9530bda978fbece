/* Rows of a disc against its exact tangents in double. SPDX-License-Identifier: MIT */
/* tests: lib/refined/goe_disc.c */
#include "refined/goe_disc.h"

#include <math.h>
#include <string.h>

#include "check.h"
#include "sighting.h"

#define CASES 2000

static check_random_t any;
static sighting_t sighting;
static double truth[GOE_STATES];
static size_t kind[GOE_ROWS_MAX]; /* feature of each row that should come */
static size_t expected_rows;

void setUp(void) {}
void tearDown(void) {}

/* ---------------------------------------------------------------------------------------------------------- reference -- */

/* Image coordinate of a feature: left, right: the tangent's azimuth; top: the rim's nearest point, or the farthest if it is
 * the highest; base corners: a point of the center's range on the ground. */
static double see(const double state[GOE_STATES], size_t feature) {
    const double h = (double)sighting.sight.height_m;
    const double px = state[GOE_BEARING] - (double)sighting.sight.camera_m.x * state[GOE_INVERSE_RANGE];
    const double pz = 1.0 - (double)sighting.sight.camera_m.z * state[GOE_INVERSE_RANGE];
    const double distance = sqrt(px * px + pz * pz);
    const double radius = 0.5 * state[GOE_FRONT_X];
    double seen[2];
    if (feature == GOE_POINT_LEFT || feature == GOE_POINT_RIGHT) {
        const double half = asin(radius / distance);
        const double azimuth = atan2(px, pz) + (feature == GOE_POINT_LEFT ? -half : half);
        /* without base corners: half the skew deeper */
        const double half_skew =
            sighting.sight.base ? 0.0 : (feature == GOE_POINT_LEFT ? -0.5 : 0.5) * state[GOE_SIDE_X];
        const double ray[3] = {tan(azimuth) * (1.0 - half_skew / pz), sighting_height(&sighting, state, feature), 1.0};
        sighting_project(&sighting, state, ray, seen);
        return seen[0];
    }
    if (feature == GOE_POINT_TOP) {
        const double y = h * state[GOE_INVERSE_RANGE] - state[GOE_TOP];
        const bool farthest = sighting.settings.filter.top_is_highest && y > 0.0;
        const double share = (distance + (farthest ? radius : -radius)) / distance;
        const double rim[3] = {px * share, y, pz * share};
        sighting_project(&sighting, state, rim, seen);
        return seen[1];
    }
    const double ground[3] = {px, h * state[GOE_INVERSE_RANGE] + state[GOE_GROUND], pz};
    sighting_project(&sighting, state, ground, seen);
    return seen[1];
}

static double predict(const sighting_t *of, const double state[GOE_STATES], size_t row) {
    (void)of;
    return see(state, kind[row]);
}

/* -------------------------------------------------------------------------------------------------------------- input -- */

static void any_disc(void) {
    const double z0_m = sighting_place(&sighting, &any);
    sighting.state[GOE_FRONT_X] = (float)(check_random_between(&any, 0.5, 25.0) / z0_m);
    sighting_finish(&sighting, &any, z0_m, truth);
    expected_rows = 0;
}

static void measure(size_t feature) {
    goe_point_t *point = &sighting.sight.point[feature];
    point->usable = true;
    point->x = 0.0f;
    point->y = (float)check_random_between(&any, -0.2, 0.2);
    if (feature == GOE_POINT_LEFT || feature == GOE_POINT_RIGHT) {
        point->x = 0.0f;
        for (int i = 0; i < SETTLED; i++) { /* the height that is freed of the bias hangs on x a little */
            point->x = (float)see(truth, feature);
        }
    } else {
        point->y = (float)see(truth, feature);
    }
    kind[expected_rows++] = feature;
}

static void check_rows(void) {
    sighting.sight.base =
        sighting.sight.point[GOE_POINT_BASE_LEFT].usable && sighting.sight.point[GOE_POINT_BASE_RIGHT].usable;
    goe_rows_clear(&sighting.rows, &sighting.matrix);
    goe_disc_rows(&sighting.sight, &sighting.rows);
    TEST_ASSERT_EQUAL_size_t(expected_rows, sighting.rows.count);
    for (size_t row = 0; row < expected_rows; row++) {
        TEST_ASSERT_EQUAL_size_t(kind[row], sighting.rows.feature[row]);
    }
    sighting_check_rows(&sighting, predict);
}

/* -------------------------------------------------------------------------------------------------------------- tests -- */

/* [goe_image_t.top, filter.top_is_highest, (R1), (R2), (R5), (R6)]
 * GIVEN discs of any size and place, with the roof below or above the camera THEN residuals are 0 at the truth and all
 * derivatives are those of tangents and rim; with base corners, of the ground below the center, too. */
static void rows_are_those_of_tangents_and_rim(void) {
    any = check_random_start("discs");
    for (int n = 0; n < CASES; n++) {
        any_disc();
        measure(GOE_POINT_LEFT);
        measure(GOE_POINT_RIGHT);
        measure(GOE_POINT_TOP);
        if (n % 2) {
            measure(GOE_POINT_BASE_LEFT);
            measure(GOE_POINT_BASE_RIGHT);
        }
        check_rows();
    }
}

/* [goe_image_t.pose] */
static void each_feature_alone_gives_its_row(void) {
    static const size_t features[] = {GOE_POINT_LEFT, GOE_POINT_RIGHT, GOE_POINT_TOP};
    any = check_random_start("alone");
    for (int n = 0; n < 300; n++) {
        any_disc();
        measure(features[n % 3]);
        check_rows();
    }
}

/* GIVEN a noise model of the shape or of the size THEN it is added to the rows' variance as a share of the width. */
static void shape_and_size_noise_are_shares_of_the_width(void) {
    float variance[2][3];
    any = check_random_start("variance");
    any_disc();
    measure(GOE_POINT_LEFT);
    measure(GOE_POINT_RIGHT);
    measure(GOE_POINT_TOP);
    for (int i = 0; i < 2; i++) {
        sighting.settings.detector.shape_error_rel = i ? 0.12f : 0.0f;
        sighting.sight.outline_share = i ? 0.05f : 0.0f;
        goe_rows_clear(&sighting.rows, &sighting.matrix);
        goe_disc_rows(&sighting.sight, &sighting.rows);
        memcpy(variance[i], sighting.rows.variance, sizeof variance[i]);
    }
    const double width =
        (double)sighting.sight.point[GOE_POINT_RIGHT].x - (double)sighting.sight.point[GOE_POINT_LEFT].x;
    for (int row = 0; row < 3; row++) {
        const double added = 0.0169 * width * width; /* 0.12^2 + 0.05^2 */
        CHECK_CLOSE(1.0e-4 * added, added, (double)variance[1][row] - (double)variance[0][row]);
    }
}

/* [goe_image_t.left, (R18)]
 * GIVEN a disc of the typical size, noise-free and viewed from a level camera WHEN the filter starts on it THEN the state is the
 * truth; of another size, only the direction is. */
static void a_first_guess_has_the_right_direction_and_the_typical_size(void) {
    any = check_random_start("start");
    for (int n = 0; n < 200; n++) {
        goe_triangle_t root;
        float state[GOE_STATES];
        any_disc();
        memset(sighting.state, 0, 3 * sizeof sighting.state[0]);
        memset(truth, 0, 3 * sizeof truth[0]);
        sighting_look(&sighting);
        sighting.settings.filter.prior_width_m = sighting.state[GOE_FRONT_X] / sighting.state[GOE_INVERSE_RANGE];
        measure(GOE_POINT_LEFT);
        measure(GOE_POINT_RIGHT);
        measure(GOE_POINT_TOP);
        sighting.sight.base = false;
        TEST_ASSERT_TRUE(goe_disc_start(&sighting.sight, state, &root));
        const double px =
            truth[GOE_BEARING] - 3.0 * truth[GOE_INVERSE_RANGE]; /* chord and diameter differ by their ratio squared */
        const double pz = 1.0 - 25.0 * truth[GOE_INVERSE_RANGE];
        const double narrow = truth[GOE_FRONT_X] * truth[GOE_FRONT_X] / (px * px + pz * pz);
        CHECK_CLOSE(0.01 + 2.0 * narrow, 0.0, (double)state[GOE_INVERSE_RANGE] / truth[GOE_INVERSE_RANGE] - 1.0);
        CHECK_CLOSE(0.01 + 2.0 * narrow, truth[GOE_BEARING], state[GOE_BEARING]);
        for (size_t i = 0; i < GOE_STATES; i++) {
            TEST_ASSERT_TRUE(*goe_srif_at(&root, i, i) > 0.0f);
        }
    }
}

/* Twice the sine of half the angle between tangents at -0.05 and 0.05. */
#define VISIBLE_WIDTH (0.1 / sqrt(1.0 + 0.05 * 0.05))

/* [(R18)] GIVEN base corners clearly below the horizon THEN flat ground gives the first range; GIVEN ones that are not, or a camera
 * below the ground THEN the typical size does. */
static void flat_ground_gives_the_first_range(void) {
    static const struct {
        float y, height_m;
        bool ground;
    } cases[] = {{0.2f, 20.0f, true}, {0.06f, 20.0f, true}, {0.01f, 20.0f, false}, {0.2f, -1.0f, false}};
    any = check_random_start("flat ground");
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        goe_triangle_t root;
        float state[GOE_STATES];
        any_disc();
        sighting.settings.navigation.attitude_bias_sd_deg = 0.5f; /* three of them are 0.026 */
        sighting.settings.filter.prior_width_m = 6.0f;
        sighting.sight.white_rad = 0.0f;
        sighting.sight.height_m = cases[i].height_m;
        sighting.sight.camera_m.x = 0.0f;
        sighting.sight.camera_m.z = 0.0f;
        sighting.sight.base = true;
        for (size_t f = 0; f < GOE_FEATURES; f++) {
            const float x = f == GOE_POINT_LEFT || f == GOE_POINT_BASE_LEFT ? -0.05f : 0.05f;
            sighting.sight.point[f] = (goe_point_t){x, cases[i].y, f != GOE_POINT_BASE_NEAR};
        }
        TEST_ASSERT_TRUE(goe_disc_start(&sighting.sight, state, &root));
        const double expected_m =
            cases[i].ground ? (double)cases[i].height_m / (double)cases[i].y : 6.0 / VISIBLE_WIDTH;
        CHECK_CLOSE(1.0e-3 * expected_m, expected_m, 1.0 / (double)state[GOE_INVERSE_RANGE]);
    }
}

/* A disc dead ahead with base corners at `y` below the horizon. */
static void see_base(double y) {
    any_disc();
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

/* GIVEN base corners THEN the first guess of the range is that of flat ground; but the typical size's where they lie so near to the
 * horizon that the attitude's error alone may have put them there, or where the camera is said to be below the ground. */
static void the_ground_gives_the_first_range_where_it_can(void) {
    goe_triangle_t root;
    float state[GOE_STATES];
    any = check_random_start("first range");
    see_base(0.25); /* 20 m above it: 80 m ahead, and the track began 25 m before */
    TEST_ASSERT_TRUE(goe_disc_start(&sighting.sight, state, &root));
    CHECK_CLOSE(1.0e-5, 1.0 / (80.0 + 25.0), state[GOE_INVERSE_RANGE]);
    CHECK_CLOSE(1.0e-4, 3.0 / 105.0, state[GOE_BEARING]);
    see_base(0.25);
    sighting.sight.height_m = -20.0f;
    TEST_ASSERT_TRUE(goe_disc_start(&sighting.sight, state, &root));
    const double by_size = 4.0 / VISIBLE_WIDTH;
    CHECK_CLOSE(1.0e-5, 1.0 / (by_size + 25.0), state[GOE_INVERSE_RANGE]);
    const double sigma = sqrt(pow(0.5 * 0.017453292519943295, 2.0) + pow(0.1 * 0.017453292519943295, 2.0) +
                              pow((double)goe_observation_pixel(&sighting.sight), 2.0));
    for (int n = 0; n < 2; n++) {
        see_base((n == 0 ? 2.9 : 3.1) * sigma);
        TEST_ASSERT_TRUE(goe_disc_start(&sighting.sight, state, &root));
        const double by_ground = 20.0 / (3.1 * sigma);
        CHECK_CLOSE(1.0e-4, 1.0 / ((n == 0 ? by_size : by_ground) + 25.0), state[GOE_INVERSE_RANGE]);
    }
}

/* GIVEN a start THEN the first image gives no more information than it has: the sensors' errors as configured, the range within a factor
 * of three, and all extents by several times themselves, as later images will determine them better. */
static void a_start_is_as_uncertain_as_one_image(void) {
    goe_triangle_t root;
    float x[GOE_STATES];
    any = check_random_start("first root");
    see_base(0.25);
    sighting.sight.point[GOE_POINT_TOP] = (goe_point_t){0.0f, -0.3f, true};
    sighting.sight.height_sd_m = 0.7f;
    sighting.settings.navigation.velocity_bias_sd_m_s = 0.1f;
    memset(x, 0xA5, sizeof x); /* whatever was there before */
    TEST_ASSERT_TRUE(goe_disc_start(&sighting.sight, x, &root));
    for (size_t i = 0; i < 4; i++) {
        CHECK_SAME(0.0f, x[i]); /* biases, ground */
    }
    CHECK_SAME(0.0f, x[GOE_SIDE_X]);
    const double bias = 0.5 * 0.017453292519943295;
    const double width = (double)x[GOE_FRONT_X];
    const double q = (double)x[GOE_INVERSE_RANGE];
    CHECK_CLOSE(1.0e-6, (20.0 + 0.3 * 80.0) * q, x[GOE_TOP]);
    CHECK_CLOSE(1.0e-6, 80.0 * VISIBLE_WIDTH * q, width);
    const double sigma[GOE_STATES] = {
        bias, bias, hypot(bias, 0.008), 0.7 * q, 1.0, 2.0 * q, 10.0 * (double)x[GOE_TOP], width, 5.0 * width, width};
    for (size_t i = 0; i < GOE_STATES; i++) {
        CHECK_CLOSE(1.0e-4, 1.0, sigma[i] * (double)*goe_srif_at(&root, i, i));
        for (size_t j = i + 1; j < GOE_STATES; j++) {
            CHECK_SAME(0.0f, *goe_srif_at(&root, i, j));
        }
    }
    sighting.settings.navigation.terrain_height_sd_m =
        2.4f; /* with an upright box the obstacle's own ground may lie off, too */
    goe_sides_t box = *sighting.sight.sides;
    box.usable = GOE_SIDE_TOP;
    sighting.sight.sides = &box;
    TEST_ASSERT_TRUE(goe_disc_start(&sighting.sight, x, &root));
    CHECK_CLOSE(1.0e-4, 1.0, 2.5 * q * (double)*goe_srif_at(&root, GOE_GROUND, GOE_GROUND));
    sighting.sight.point[GOE_POINT_TOP].y = 0.2499f; /* a top near the altimeter's zero */
    TEST_ASSERT_TRUE(goe_disc_start(&sighting.sight, x, &root));
    CHECK_CLOSE(1.0e-3, 1.0, 10.0 * (double)x[GOE_FRONT_X] * (double)*goe_srif_at(&root, GOE_TOP, GOE_TOP));
}

/* [goe_image_t.left] */
static void no_width_is_no_start(void) {
    goe_triangle_t root;
    float state[GOE_STATES];
    any = check_random_start("no start");
    any_disc();
    sighting.sight.base = false;
    measure(GOE_POINT_LEFT);
    TEST_ASSERT_FALSE(goe_disc_start(&sighting.sight, state, &root));
    measure(GOE_POINT_RIGHT);
    sighting.sight.point[GOE_POINT_RIGHT].x = sighting.sight.point[GOE_POINT_LEFT].x;
    TEST_ASSERT_FALSE(goe_disc_start(&sighting.sight, state, &root));
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(rows_are_those_of_tangents_and_rim);
    RUN_TEST(each_feature_alone_gives_its_row);
    RUN_TEST(shape_and_size_noise_are_shares_of_the_width);
    RUN_TEST(a_first_guess_has_the_right_direction_and_the_typical_size);
    RUN_TEST(flat_ground_gives_the_first_range);
    RUN_TEST(the_ground_gives_the_first_range_where_it_can);
    RUN_TEST(a_start_is_as_uncertain_as_one_image);
    RUN_TEST(no_width_is_no_start);
    return UNITY_END();
}
