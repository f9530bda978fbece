/* The height above the obstacle's ground: the information of its readings, and the part that stays as the range becomes known, against the
 * same computed at once in double. SPDX-License-Identifier: MIT */
/* tests: lib/refined/goe_ground.c */
#include "refined/goe_ground.h"

#include <math.h>
#include <string.h>

#include "check.h"
#include "refined/goe_model.h"

#define READINGS 40
#define FLIGHTS 20
#define CONSTANT_M 2.0f /* one sigma of the error that all heights have */
#define WHITE_M 3.0f    /* ... of that which is new in each */
#define RANGE_M 100.0f
#define HEIGHT_M 20.0f
#define RANGE_KNOWN 1.0e4f /* to a share of 1e-4: heights alone do not move it */

static goe_filter_t filter;
static goe_settings_t settings;
static goe_observation_t obs;
static goe_motion_t motion;
static goe_image_t image;
static goe_view_t view;
static goe_rows_t rows;
static goe_matrix_t matrix;
static check_random_t any;
static const float level[9] = {1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f}; /* the camera's y axis is down */

void setUp(void) {
    any = check_random_start("ground");
    goe_settings_default(&settings);
    settings.navigation.height_bias_sd_m = CONSTANT_M;
    memset(&image, 0, sizeof image);
    memset(&motion, 0, sizeof motion);
    memset(&view, 0, sizeof view);
    memset(&obs, 0, sizeof obs);
    goe_filter_clear(&filter);
    view.image = &image;
    view.motion = &motion;
    view.camera = &settings.camera;
    view.camera_to_body = level;
    memcpy(view.camera_to_trajectory, level, sizeof level);
    obs.settings = &settings;
}
void tearDown(void) {}

/* A filter at this range with this information on the ground, and little else. */
static void start(float range_m, float height_sd_m) {
    memset(&filter.root, 0, sizeof filter.root);
    for (size_t i = 0; i < GOE_STATES; i++) {
        *goe_srif_at(&filter.root, i, i) = 1.0f;
    }
    filter.phase = GOE_PHASE_FOOTPRINT;
    filter.known = GOE_HAS_POSITION;
    filter.state[GOE_INVERSE_RANGE] = 1.0f / range_m;
    *goe_srif_at(&filter.root, GOE_INVERSE_RANGE, GOE_INVERSE_RANGE) = RANGE_KNOWN * range_m;
    *goe_srif_at(&filter.root, GOE_GROUND, GOE_GROUND) = range_m / height_sd_m;
    static const goe_sides_t none;
    goe_observation_t first = obs;
    first.height_sd_m = height_sd_m;
    first.sides = &none;
    goe_ground_start(&filter, &first);
}

/* Gives the filter its height rows, without any other row. Returns how many rows that were. */
static int give(void) {
    float change[GOE_UNKNOWNS];
    goe_rows_clear(&rows, &matrix);
    memset(&matrix, 0, sizeof matrix);
    rows.white_rad = 1.0e-3f;
    const int reported = goe_ground_row(&filter, &obs, &rows);
    TEST_ASSERT_EQUAL_INT(reported, (int)rows.count);
    (void)goe_model_update(&filter, 1.0f / rows.white_rad, &rows, change);
    return reported;
}

static double ground_sd_m(void) {
    return sqrt((double)goe_filter_variance(&filter, GOE_GROUND)) / (double)filter.state[GOE_INVERSE_RANGE];
}

/* One reading, after the flight has sunk by this much. */
static void read_height(float height_m, float sunk_m) {
    image.pose.position_ned_m[2] = sunk_m;
    motion.height_m = height_m;
    goe_ground_read(&filter, &settings.navigation, &view);
    obs.height_sd_m = sqrtf(CONSTANT_M * CONSTANT_M + WHITE_M * WHITE_M / (float)filter.datum.readings);
}

/* [goe_pose_t.height_m]
 * GIVEN heights with a constant and a white error, of a flight that sinks THEN the filter gets their offset as the mean of all, with the
 * constant error counted once, and follows a mean that moves. */
static void readings_give_the_mean_and_no_more(void) {
    settings.navigation.height_white_sd_m = WHITE_M;
    for (int flight = 0; flight < FLIGHTS; flight++) {
        double sum = 0.0;
        double first_m = 0.0;
        goe_filter_clear(&filter);
        for (int k = 0; k < READINGS; k++) {
            const double noise = (double)WHITE_M * check_random_normal(&any);
            const double sunk = 0.3 * k;
            read_height((float)((double)HEIGHT_M - sunk + noise), (float)sunk);
            first_m = k == 0 ? noise : first_m;
            sum += noise - first_m;
            if (k == 0) {
                start(RANGE_M, obs.height_sd_m);
            } else {
                (void)give();
            }
        }
        const double reported_sd = sqrt((double)(CONSTANT_M * CONSTANT_M) + (double)(WHITE_M * WHITE_M) / READINGS);
        const double offset_m = (double)filter.state[GOE_GROUND] / (double)filter.state[GOE_INVERSE_RANGE];
        CHECK_CLOSE(0.01 * reported_sd, reported_sd, ground_sd_m());
        CHECK_CLOSE(0.05 * reported_sd, sum / READINGS, offset_m);
    }
}

/* GIVEN a filter that was given the mean of its heights WHEN it starts again, like a track that begins again at a place THEN it is
 * given the same mean once more, and nothing of the earlier information counts. */
static void a_filter_that_starts_again_receives_the_same_mean(void) {
    settings.navigation.height_white_sd_m = WHITE_M;
    for (int flight = 0; flight < FLIGHTS; flight++) {
        goe_filter_clear(&filter);
        read_height(HEIGHT_M, 0.0f);
        const float first_sd_m = obs.height_sd_m;
        start(RANGE_M, first_sd_m);
        for (int k = 1; k < READINGS; k++) {
            read_height(HEIGHT_M + 5.0f + WHITE_M * (float)check_random_normal(&any), 0.0f);
            (void)give();
        }
        const double reported_m = (double)filter.state[GOE_GROUND] / (double)filter.state[GOE_INVERSE_RANGE];
        const double reported_sd_m = ground_sd_m();
        filter.state[GOE_GROUND] = 0.0f;
        start(RANGE_M, first_sd_m);
        TEST_ASSERT_EQUAL_INT(1, give());
        CHECK_CLOSE(0.02 * reported_sd_m, reported_m, filter.state[GOE_GROUND] / filter.state[GOE_INVERSE_RANGE]);
        CHECK_CLOSE(0.01 * reported_sd_m, reported_sd_m, ground_sd_m());
    }
}

/* GIVEN more readings than are counted THEN the mean continues as that of so many, and the count does not begin again. */
static void the_count_of_readings_saturates(void) {
    settings.navigation.height_white_sd_m = WHITE_M;
    read_height(HEIGHT_M, 0.0f);
    start(RANGE_M, obs.height_sd_m);
    filter.datum.readings = UINT16_MAX - 1u;
    for (int k = 0; k < 3; k++) {
        const double before_m = (double)filter.datum.mean_m;
        read_height(HEIGHT_M + 10.0f, 0.0f);
        TEST_ASSERT_EQUAL_UINT16(UINT16_MAX, filter.datum.readings);
        CHECK_CLOSE(1.0e-6, (10.0 - before_m) / UINT16_MAX, (double)filter.datum.mean_m - before_m);
    }
}

/* GIVEN an image whose rows are all taken THEN the information of the heights waits, and none of it is lost. */
static void an_overflow_is_reported_later(void) {
    settings.navigation.height_white_sd_m = WHITE_M;
    read_height(HEIGHT_M, 0.0f);
    start(RANGE_M, obs.height_sd_m);
    for (int k = 1; k < READINGS; k++) {
        read_height(HEIGHT_M + 1.0f, 0.0f);
    }
    goe_rows_clear(&rows, &matrix);
    rows.count = GOE_ROWS_MAX;
    TEST_ASSERT_EQUAL_INT(0, goe_ground_row(&filter, &obs, &rows));
    TEST_ASSERT_EQUAL_INT(1, give());
    TEST_ASSERT_EQUAL_INT(0, give());
    CHECK_CLOSE(0.001, obs.height_sd_m, ground_sd_m());
    CHECK_CLOSE(0.05, 1.0 - 1.0 / READINGS, filter.state[GOE_GROUND] * RANGE_M);
}

/* GIVEN a filter that knows no position yet THEN what the heights say waits, as its range may be off by a factor; none of it is lost. */
static void without_a_position_the_heights_wait(void) {
    settings.navigation.height_white_sd_m = WHITE_M;
    read_height(HEIGHT_M, 0.0f);
    start(RANGE_M, obs.height_sd_m);
    for (int k = 1; k < READINGS; k++) {
        read_height(HEIGHT_M + 1.0f, 0.0f);
    }
    filter.known = 0;
    TEST_ASSERT_EQUAL_INT(0, give());
    filter.known = GOE_HAS_POSITION;
    TEST_ASSERT_EQUAL_INT(1, give());
    CHECK_CLOSE(0.001, obs.height_sd_m, ground_sd_m());
}

/* [navigation.height_bias_sd_m]
 * GIVEN a first guess of the range that proves wrong THEN the uncertainty of the height is the configured one, in meters: no better when
 * the obstacle is nearer, and no worse when it is farther. */
static void a_wrong_first_range_leaves_the_height_as_given(void) {
    static const float factor[] = {0.2f, 0.5f, 0.9f, 1.0f, 1.2f, 2.0f, 5.0f};
    for (size_t i = 0; i < sizeof factor / sizeof factor[0]; i++) {
        start(RANGE_M, CONSTANT_M);
        const float before = filter.state[GOE_INVERSE_RANGE];
        filter.state[GOE_INVERSE_RANGE] = before / factor[i];
        goe_ground_follow(&filter, before);
        goe_ground_widen(&filter);
        const int reported = give();
        check_report("sigma of the height over the configured one", ground_sd_m() / (double)CONSTANT_M);
        TEST_ASSERT_EQUAL_INT(factor[i] > 1.0f ? 1 : 0, reported);
        CHECK_CLOSE(0.02, 1.0, ground_sd_m() / (double)CONSTANT_M);
    }
}

/* -------------------------------------------------------------------------------------------------------------- slope -- */

#define SLOPE 0.1f
#define FLOWN_M 50.0f

/* Of the obstacle's own height, units of Z0: of its top above the altimeter's zero, and of the ground below that. */
static double sum_sd(void) {
    float sum[GOE_STATES] = {0.0f};
    float reciprocal[GOE_STATES];
    sum[GOE_GROUND] = 1.0f;
    sum[GOE_TOP] = 1.0f;
    goe_srif_reciprocals(&filter.root, reciprocal);
    return sqrt((double)goe_srif_project(&filter.root, reciprocal, 0, sum));
}

/* GIVEN ground that rises or falls below the altimeter WHEN the aircraft has flown a distance THEN the height above the obstacle's ground
 * is off by slope times distance more, once for each meter however many images it took; the obstacle's own height is not affected. */
static void the_slope_of_the_ground_adds_up_over_the_way(void) {
    settings.navigation.terrain_slope_sd = SLOPE;
    for (int steps = 1; steps <= 4; steps += 3) {
        start(RANGE_M, CONSTANT_M);
        const double height_sd = sum_sd();
        for (int k = 1; k <= steps; k++) {
            filter.flown_m = FLOWN_M * (float)k / (float)steps;
            goe_ground_climb(&filter, &settings.navigation);
            goe_ground_climb(&filter, &settings.navigation); /* nothing was flown since */
        }
        CHECK_CLOSE(1.0e-3, hypot((double)CONSTANT_M, (double)(SLOPE * FLOWN_M)), ground_sd_m());
        CHECK_CLOSE(1.0e-4 * height_sd, height_sd, sum_sd());
    }
}

/* GIVEN heights that are not taken as they come, but by those of all images or as of the first one THEN the way that was flown
 * is in none of them. */
static void a_height_that_is_kept_has_no_slope(void) {
    settings.navigation.terrain_slope_sd = SLOPE;
    for (int kept = 0; kept < 2; kept++) {
        start(RANGE_M, CONSTANT_M);
        filter.datum.boxes = kept == 0;
        settings.navigation.height_white_sd_m = kept == 0 ? 0.0f : WHITE_M;
        TEST_ASSERT_TRUE(goe_ground_is_steady(&filter, &settings.navigation));
        filter.flown_m = FLOWN_M;
        goe_ground_climb(&filter, &settings.navigation);
        CHECK_CLOSE(1.0e-4, (double)CONSTANT_M, ground_sd_m());
    }
}

/* GIVEN ground that slopes below the altimeter WHEN the aircraft flies on THEN the height has become uncertain by the slope times the
 * way, whatever the steps, and the top, counted from the altimeter's zero, by as much the other way: the obstacle's height has not;
 * and nothing of that where the height is kept from the first image on. */
static void sloping_ground_makes_the_height_uncertain(void) {
    static const size_t steps[] = {1, 5};
    settings.navigation.terrain_slope_sd = 0.05f;
    for (size_t n = 0; n < 2; n++) {
        goe_filter_clear(&filter);
        start(RANGE_M, CONSTANT_M);
        for (size_t i = 0; i < steps[n]; i++) {
            filter.flown_m += 60.0f / (float)steps[n];
            goe_ground_climb(&filter, &settings.navigation);
        }
        CHECK_CLOSE(0.01, sqrt(4.0 + 9.0), ground_sd_m());
        const double before = 1.0 + 4.0 / (double)(RANGE_M * RANGE_M); /* of the top, and of the ground */
        CHECK_CLOSE(1.0e-4, before, sum_sd() * sum_sd());
    }
    settings.navigation.height_white_sd_m = 1.0f;
    start(RANGE_M, CONSTANT_M);
    filter.flown_m = 60.0f;
    goe_ground_climb(&filter, &settings.navigation);
    CHECK_CLOSE(0.01, 2.0, ground_sd_m());
}

/* GIVEN a first image that knows its own height's error THEN that is kept for the filter's start, of that image and no later one. */
static void the_first_heights_own_error_is_kept(void) {
    settings.navigation.height_white_sd_m = WHITE_M;
    image.noise.height_sd_m = 0.7f;
    read_height(HEIGHT_M, 0.0f);
    CHECK_SAME(0.7f, filter.datum.sd_m);
    image.noise.height_sd_m = 0.2f;
    read_height(HEIGHT_M, 0.0f);
    CHECK_SAME(0.7f, filter.datum.sd_m);
}

/* GIVEN heights with a white error and a box in each image WHEN the height is not set THEN no reading counts and the ground's height is
 * unknown; the first height that is set is the first reading. */
static void a_height_that_is_not_set_is_no_reading(void) {
    settings.navigation.height_white_sd_m = WHITE_M;
    image.box.sides = GOE_SIDES_ALL;
    image.noise.height_sd_m = 0.7f; /* of a height that is not there */
    read_height(0.0f, 0.0f);
    read_height(0.0f, 0.0f);
    TEST_ASSERT_EQUAL_UINT16(0u, filter.datum.readings);
    TEST_ASSERT_TRUE(filter.datum.sd_m >= 1.0e3f);
    image.pose.height_m = HEIGHT_M;
    read_height(HEIGHT_M, 0.0f);
    TEST_ASSERT_EQUAL_UINT16(1u, filter.datum.readings);
    CHECK_CLOSE(1.0e-5, (double)HEIGHT_M, filter.datum.height_m);
}

/* GIVEN a camera on an arm WHEN the aircraft pitches and rolls THEN the camera's height has moved by the arm's end, not by the
 * vehicle's down alone. */
static void the_arm_moves_the_camera_up_and_down(void) {
    const float turned[9] = {0.8f, 0.0f, 0.6f, -0.36f, 0.8f, 0.48f, -0.48f, -0.6f, 0.64f};
    const float mounted[9] = {0.0f, 0.0f, 1.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f}; /* looks ahead */
    settings.navigation.height_white_sd_m = WHITE_M;
    settings.camera.offset_m[0] = 3.0f;
    settings.camera.offset_m[1] = -1.0f;
    settings.camera.offset_m[2] = 0.5f;
    settings.camera.width_px = 1280.0f; /* which is behind the arm in memory */
    view.camera_to_body = mounted;
    read_height(HEIGHT_M, 0.0f); /* level by the camera's axes: y is body's z */
    const double first_down = 0.5;
    memcpy(view.camera_to_trajectory, turned, sizeof turned);
    /* the arm in the camera's axes: x is body's y, y its z, z its x; the second row turns it into down */
    const double down = -0.36 * -1.0 + 0.8 * 0.5 + 0.48 * 3.0;
    read_height(HEIGHT_M, 0.0f);
    const double ground =
        (double)HEIGHT_M + first_down; /* the mean of two heights above what moved does not matter here */
    CHECK_CLOSE(1.0e-4, (double)filter.datum.ground_m - down, filter.datum.height_m);
    CHECK_CLOSE(1.0e-4, 0.5 * (ground + (double)HEIGHT_M + down), filter.datum.ground_m);
}

/* GIVEN a footprint that began by points WHEN the first upright box comes THEN the obstacle's own ground may lie off, once, and from then
 * on the height counts by the changes of down. */
static void the_first_box_frees_the_ground_once(void) {
    start(RANGE_M, 0.5f);
    settings.navigation.terrain_height_sd_m = 2.0f;
    TEST_ASSERT_FALSE(goe_filter_by_boxes(&filter));
    for (int n = 0; n < 2; n++) {
        goe_ground_meet_box(&filter, &settings.navigation);
        TEST_ASSERT_TRUE(goe_filter_by_boxes(&filter));
        CHECK_CLOSE(1.0e-3, sqrt(0.25 + 4.0), ground_sd_m());
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(readings_give_the_mean_and_no_more);
    RUN_TEST(a_filter_that_starts_again_receives_the_same_mean);
    RUN_TEST(the_count_of_readings_saturates);
    RUN_TEST(an_overflow_is_reported_later);
    RUN_TEST(without_a_position_the_heights_wait);
    RUN_TEST(a_wrong_first_range_leaves_the_height_as_given);
    RUN_TEST(the_slope_of_the_ground_adds_up_over_the_way);
    RUN_TEST(a_height_that_is_kept_has_no_slope);
    RUN_TEST(sloping_ground_makes_the_height_uncertain);
    RUN_TEST(the_first_heights_own_error_is_kept);
    RUN_TEST(a_height_that_is_not_set_is_no_reading);
    RUN_TEST(the_arm_moves_the_camera_up_and_down);
    RUN_TEST(the_first_box_frees_the_ground_once);
    return UNITY_END();
}
