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
#define WALK_M 0.5f     /* ... of the drift of down in a second */
#define STEP_S 0.125f
#define RANGE_M 100.0f
#define HEIGHT_M 20.0f
#define RANGE_KNOWN 1.0e4f /* to a share of 1e-4: heights alone do not move it */
#define TOP_KNOWN 1.0e4f

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

/* Heights have a constant error, and are exact but for that; the ground is level. */
void setUp(void) {
    any = check_random_start("ground");
    goe_settings_default(&settings);
    settings.navigation.height_bias_sd_m = CONSTANT_M;
    settings.navigation.height_white_sd_m = 0.0f;
    settings.navigation.terrain_height_sd_m = 0.0f;
    settings.navigation.terrain_slope_sd = 0.0f;
    settings.navigation.position_walk_sd_m = 0.0f;
    memset(&image, 0, sizeof image);
    memset(&motion, 0, sizeof motion);
    memset(&view, 0, sizeof view);
    goe_filter_clear(&filter);
    view.image = &image;
    view.motion = &motion;
    view.camera = &settings.camera;
    view.camera_to_body = level;
    memcpy(view.camera_to_trajectory, level, sizeof level);
}
void tearDown(void) {}

static void look(void) { (void)goe_observation_open(&obs, &settings, &filter, &view); }

/* The filter starts by this image at this range. It knows the top's place and the range much better than the height. */
static void start(float range_m) {
    memset(&filter.root, 0, sizeof filter.root);
    for (size_t i = 0; i < GOE_STATES; i++) {
        *goe_srif_at(&filter.root, i, i) = 1.0f;
    }
    filter.phase = GOE_PHASE_FOOTPRINT;
    filter.known = GOE_HAS_POSITION;
    filter.due_s = 0.0f;
    filter.state[GOE_INVERSE_RANGE] = 1.0f / range_m;
    filter.state[GOE_GROUND] = 0.0f;
    look();
    *goe_srif_at(&filter.root, GOE_INVERSE_RANGE, GOE_INVERSE_RANGE) = RANGE_KNOWN * range_m;
    *goe_srif_at(&filter.root, GOE_GROUND, GOE_GROUND) =
        1.0f / sqrtf(goe_ground_variance(&obs, filter.state[GOE_INVERSE_RANGE]));
    *goe_srif_at(&filter.root, GOE_TOP, GOE_TOP) = TOP_KNOWN;
    goe_ground_start(&filter, &obs);
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

/* What an image does before its rows and with those of the height. Returns how many these were. */
static int measure(void) {
    goe_ground_widen(&filter, &settings.navigation);
    goe_ground_drift(&filter, &obs);
    filter.due_s = 0.0f;
    return give();
}

static double ground_sd_m(void) {
    return sqrt((double)goe_filter_variance(&filter, GOE_GROUND)) / (double)filter.state[GOE_INVERSE_RANGE];
}

static double offset_m(void) { return (double)filter.state[GOE_GROUND] / (double)filter.state[GOE_INVERSE_RANGE]; }

/* Of the obstacle's own height, units of Z0: of its top above the altimeter's zero, and of the ground below that. */
static double sum_sd(void) {
    float sum[GOE_STATES] = {0.0f};
    float reciprocal[GOE_STATES];
    sum[GOE_GROUND] = 1.0f;
    sum[GOE_TOP] = 1.0f;
    goe_srif_reciprocals(&filter.root, reciprocal);
    return sqrt((double)goe_srif_project(&filter.root, reciprocal, 0, sum));
}

/* One reading, after the flight has sunk by this much since its first image, a step after the reading before. */
static void read_height(float height_m, float sunk_m) {
    const float since_s = goe_filter_has_started(&filter) ? STEP_S : 0.0f;
    image.pose.position_ned_m[2] = sunk_m;
    image.pose.height_m = motion.height_m = height_m;
    filter.due_s += since_s;
    goe_ground_read(&filter, &settings.navigation, &view, since_s);
    look();
}

/* Noise that no reading of the altimeter takes for more than the configured one. */
static float noise_m(void) { return WHITE_M * (float)check_random_between(&any, -0.5, 0.5); }

/* ------------------------------------------------------------------------------------------------------ the readings -- */

/* What the readings say of the altimeter's zero, all at once: least squares for its way, one value for each reading. */
typedef struct {
    double mean_m, variance_m2; /* of the latest */
} batch_t;

static batch_t solve_batch(const double off_m[], size_t count, double white_m, double walked_m) {
    static double a[READINGS][READINGS + 2]; /* the information, its right side, and that of the unit vector */
    memset(a, 0, sizeof a);
    for (size_t i = 0; i < count; i++) {
        a[i][i] += 1.0 / (white_m * white_m);
        a[i][READINGS] = off_m[i] / (white_m * white_m);
    }
    for (size_t i = 1; i < count; i++) { /* the step from the reading before */
        const double step = 1.0 / (walked_m * walked_m);
        a[i][i] += step;
        a[i - 1][i - 1] += step;
        a[i][i - 1] -= step;
        a[i - 1][i] -= step;
    }
    a[count - 1][READINGS + 1] = 1.0;
    for (size_t k = 0; k < count; k++) {
        for (size_t i = k + 1; i < count; i++) {
            const double share = a[i][k] / a[k][k];
            for (size_t j = k; j < READINGS + 2; j++) {
                a[i][j] -= share * a[k][j];
            }
        }
    }
    const double *last = a[count - 1];
    const batch_t batch = {last[READINGS] / last[count - 1], last[READINGS + 1] / last[count - 1]};
    return batch;
}

/* [goe_pose_t.height_m]
 * GIVEN images without an altimeter, whose height is 0, WHEN they show a box or nothing THEN that is no height. WHEN they show points THEN it
 * is one. */
static void a_height_of_0_is_none(void) {
    for (int seen = 0; seen < 2; seen++) {
        for (unsigned sides = 0; sides <= GOE_SIDE_LEFT; sides++) {
            goe_filter_clear(&filter);
            view.seen = seen == 1;
            image.box.sides = (uint8_t)sides;
            image.pose.height_m = motion.height_m = 0.0f;
            goe_ground_read(&filter, &settings.navigation, &view, 0.0f);
            TEST_ASSERT_EQUAL_UINT8(seen == 1 && sides == 0u ? 1u : 0u, filter.health.heights);
        }
    }
}

/* [goe_pose_t.height_m]
 * GIVEN exact heights of a flight that sinks THEN the camera's height is the reading, its error the constant one, and the filter has
 * nothing to learn from later readings, whether or not down may drift. */
static void exact_heights_are_taken_at_once(void) {
    for (int drifts = 0; drifts < 2; drifts++) {
        goe_filter_clear(&filter);
        settings.navigation.position_walk_sd_m = drifts ? 0.05f : 0.0f;
        for (int k = 0; k < READINGS; k++) {
            const float sunk = 0.25f * (float)k;
            read_height(HEIGHT_M - sunk, sunk);
            CHECK_CLOSE(1.0e-5, (double)(HEIGHT_M - sunk), obs.height_m);
            CHECK_CLOSE(1.0e-6, (double)CONSTANT_M, obs.height_sd_m);
            if (k == 0) {
                start(RANGE_M);
            } else {
                TEST_ASSERT_TRUE(measure() == 0 || drifts);
            }
            CHECK_CLOSE(2.0e-3, (double)CONSTANT_M, ground_sd_m());
            CHECK_CLOSE(1.0e-6, 0.0, offset_m());
        }
    }
}

/* GIVEN exact heights whose down drifts THEN the height follows the readings at once. */
static void exact_heights_correct_a_drift_of_down(void) {
    settings.navigation.position_walk_sd_m = WALK_M;
    read_height(HEIGHT_M, 0.0f);
    start(RANGE_M);
    for (int k = 1; k < READINGS; k++) {
        read_height(HEIGHT_M, 0.01f * (float)k); /* the flight is level */
        (void)measure();
    }
    CHECK_CLOSE(1.0e-4, 0.01 * (READINGS - 1), filter.datum.mean_m);
    CHECK_CLOSE(0.02 * 0.01 * (READINGS - 1), 0.01 * (READINGS - 1), offset_m());
}

/* [goe_pose_t.height_m, navigation.height_white_sd_m]
 * GIVEN heights with a constant and a white error, of a flight that sinks THEN the filter gets their offset as the mean of all, with
 * the constant error counted once: 1/(b^2 + w^2/n). */
static void readings_give_the_mean_and_no_more(void) {
    settings.navigation.height_white_sd_m = WHITE_M;
    for (int flight = 0; flight < FLIGHTS; flight++) {
        double sum = 0.0;
        double first_m = 0.0;
        goe_filter_clear(&filter);
        for (int k = 0; k < READINGS; k++) {
            const double noise = (double)noise_m();
            const double sunk = 0.3 * k;
            read_height((float)((double)HEIGHT_M - sunk + noise), (float)sunk);
            first_m = k == 0 ? noise : first_m;
            sum += noise - first_m;
            const double expected2 = (double)(CONSTANT_M * CONSTANT_M) + (double)(WHITE_M * WHITE_M) / (k + 1);
            CHECK_CLOSE(1.0e-5, sqrt(expected2), obs.height_sd_m);
            if (k == 0) {
                start(RANGE_M);
            } else {
                (void)measure();
            }
        }
        const double reported_sd = sqrt((double)(CONSTANT_M * CONSTANT_M) + (double)(WHITE_M * WHITE_M) / READINGS);
        CHECK_CLOSE(0.01 * reported_sd, reported_sd, ground_sd_m());
        CHECK_CLOSE(0.05 * reported_sd, sum / READINGS, offset_m());
    }
}

/* [navigation.position_walk_sd_m]
 * GIVEN noisy heights, and down that drifts THEN the filter's mean and its variance are those of all readings solved at once. */
static void the_mean_of_a_drifting_down_is_the_best(void) {
    settings.navigation.height_white_sd_m = WHITE_M;
    settings.navigation.position_walk_sd_m = WALK_M;
    const double walked_m = (double)WALK_M * sqrt((double)STEP_S);
    for (int flight = 0; flight < FLIGHTS; flight++) {
        double off_m[READINGS] = {0.0};
        double first_m = 0.0;
        goe_filter_clear(&filter);
        for (size_t k = 0; k < READINGS; k++) {
            const float height_m = HEIGHT_M + noise_m();
            first_m = k == 0 ? (double)height_m : first_m;
            off_m[k] = (double)height_m - first_m;
            read_height(height_m, 0.0f);
            if (k == 0) {
                start(RANGE_M);
            } else {
                (void)measure();
            }
            const batch_t batch = solve_batch(off_m, k + 1, (double)WHITE_M, walked_m);
            const double sd_m = sqrt((double)(CONSTANT_M * CONSTANT_M) + batch.variance_m2);
            CHECK_CLOSE(1.0e-4, batch.mean_m, filter.datum.mean_m);
            CHECK_CLOSE(1.0e-4 * batch.variance_m2, batch.variance_m2, filter.datum.noise_m2);
            CHECK_CLOSE(1.0e-4, sd_m, obs.height_sd_m);
            CHECK_CLOSE(0.01 * sd_m, sd_m, ground_sd_m());
            CHECK_CLOSE(0.02 * sd_m, batch.mean_m, offset_m());
        }
    }
}

/* GIVEN a flight whose readings are averaged WHEN the filter starts only then THEN the ground is where their mean puts it, and the filter
 * has no offset. */
static void before_the_start_the_mean_is_the_ground(void) {
    double sum = 0.0;
    settings.navigation.height_white_sd_m = WHITE_M;
    for (int k = 0; k < READINGS; k++) {
        const float noise = noise_m();
        read_height(HEIGHT_M + noise, 0.0f);
        sum += (double)noise;
    }
    CHECK_CLOSE(1.0e-4, (double)HEIGHT_M + sum / READINGS, obs.height_m);
    CHECK_SAME(0.0f, filter.datum.mean_m);
    start(RANGE_M);
    TEST_ASSERT_EQUAL_INT(0, give());
    CHECK_CLOSE(1.0e-4, hypot((double)CONSTANT_M, (double)WHITE_M / sqrt(READINGS)), ground_sd_m());
}

/* GIVEN a filter that was given the mean of its heights WHEN it starts again, like a track that begins again at a place THEN it is
 * given the same mean once more, and nothing of the earlier information counts. */
static void a_filter_that_starts_again_receives_the_same_mean(void) {
    settings.navigation.height_white_sd_m = WHITE_M;
    settings.navigation.position_walk_sd_m = WALK_M;
    for (int flight = 0; flight < FLIGHTS; flight++) {
        goe_filter_clear(&filter);
        read_height(HEIGHT_M, 0.0f);
        start(RANGE_M);
        for (int k = 1; k < READINGS; k++) {
            read_height(HEIGHT_M + 0.5f * WHITE_M + 0.5f * noise_m(), 0.0f);
            (void)measure();
        }
        start(RANGE_M);
        read_height(HEIGHT_M + 0.5f * WHITE_M, 0.0f);
        TEST_ASSERT_EQUAL_INT(1, measure());
        const double sd_m = sqrt((double)(CONSTANT_M * CONSTANT_M + filter.datum.noise_m2));
        CHECK_CLOSE(0.02 * sd_m, filter.datum.mean_m, offset_m());
        CHECK_CLOSE(0.01 * sd_m, sd_m, ground_sd_m());
    }
}

/* GIVEN more readings than are counted THEN the count stays, and readings are averaged and remembered as before. */
static void the_count_of_readings_saturates(void) {
    settings.navigation.height_white_sd_m = WHITE_M;
    for (int k = 0; k < 300; k++) {
        read_height(HEIGHT_M, 0.0f);
        TEST_ASSERT_EQUAL_UINT8(k < 255 ? k + 1 : 255, filter.health.heights);
        CHECK_CLOSE(1.0e-4 / (k + 1), (double)(WHITE_M * WHITE_M) / (k + 1), filter.datum.noise_m2);
    }
    CHECK_CLOSE(0.1, 0.0, filter.datum.scatter_m2);
    const double before = (double)filter.datum.scatter_m2;
    read_height(HEIGHT_M + 8.0f, 0.0f);
    CHECK_CLOSE(1.0e-3, before + (64.0 - before) / 64.0, filter.datum.scatter_m2);
}

/* --------------------------------------------------------------------------------------------------- drift and scatter -- */

/* [navigation.position_walk_sd_m]
 * GIVEN images without a height WHEN time passes THEN the height's variance grows by that of the drift of down, and the top, counted from
 * the altimeter's zero, by as much the other way: the obstacle's own height does not. Without time nothing changes. */
static void down_that_drifts_makes_the_height_uncertain(void) {
    settings.navigation.position_walk_sd_m = WALK_M;
    read_height(HEIGHT_M, 0.0f);
    start(RANGE_M);
    const double own_sd = sum_sd();
    for (int k = 1; k <= READINGS; k++) {
        filter.due_s = STEP_S;
        goe_ground_drift(&filter, &obs);
        filter.due_s = 0.0f;
        goe_ground_drift(&filter, &obs);
        const double expected = (double)(CONSTANT_M * CONSTANT_M) + (double)(WALK_M * WALK_M) * (double)STEP_S * k;
        CHECK_CLOSE(1.0e-3, sqrt(expected), ground_sd_m());
        CHECK_CLOSE(1.0e-3 * own_sd, own_sd, sum_sd());
    }
}

/* [navigation.height_white_sd_m]
 * GIVEN readings that scatter more than configured THEN four times the variance beyond it counts, however many readings there are; the
 * configured part is averaged. A filter that already started loses that information, the obstacle's own height none. */
static void a_scatter_beyond_the_configured_one_stays(void) {
    const double excess_m2 = (double)(WHITE_M * WHITE_M) - 0.25;
    const double limit_m = sqrt((double)(CONSTANT_M * CONSTANT_M) + 4.0 * excess_m2);
    settings.navigation.height_white_sd_m = 0.5f;
    read_height(HEIGHT_M, 0.0f);
    start(RANGE_M);
    const double own_sd = sum_sd();
    for (int k = 1; k <= 1000; k++) {
        read_height(HEIGHT_M + (k % 2 ? WHITE_M : -WHITE_M), 0.0f);
        (void)measure();
    }
    CHECK_CLOSE(0.02 * limit_m, limit_m, obs.height_sd_m);
    CHECK_CLOSE(0.02 * limit_m, limit_m, ground_sd_m());
    CHECK_CLOSE(0.02 * own_sd, own_sd, sum_sd());
    /* AND the same readings are averaged if they scatter as configured */
    goe_filter_clear(&filter);
    settings.navigation.height_white_sd_m = WHITE_M;
    for (int k = 0; k <= 1000; k++) {
        read_height(HEIGHT_M + (k % 2 ? WHITE_M : -WHITE_M), 0.0f);
    }
    CHECK_CLOSE(0.02, (double)CONSTANT_M, obs.height_sd_m);
}

/* GIVEN readings that scattered more than configured for a while WHEN they are quiet again THEN the height is as certain as before. */
static void a_scatter_that_ends_is_forgotten(void) {
    settings.navigation.height_white_sd_m = 0.5f;
    read_height(HEIGHT_M, 0.0f);
    start(RANGE_M);
    for (int k = 1; k < READINGS; k++) {
        read_height(HEIGHT_M + (k % 2 ? WHITE_M : -WHITE_M), 0.0f);
        (void)measure();
    }
    TEST_ASSERT_TRUE(obs.height_sd_m > 2.0f * CONSTANT_M);
    for (int k = 0; k < 600; k++) {
        read_height(HEIGHT_M, 0.0f);
        (void)measure();
    }
    CHECK_CLOSE(0.02 * (double)CONSTANT_M, (double)CONSTANT_M, obs.height_sd_m);
    CHECK_CLOSE(0.02 * (double)CONSTANT_M, (double)CONSTANT_M, ground_sd_m());
}

/* ---------------------------------------------------------------------------------------------------------- rows that wait -- */

static void read_without_rows(void) {
    settings.navigation.height_white_sd_m = WHITE_M;
    read_height(HEIGHT_M, 0.0f);
    start(RANGE_M);
    for (int k = 1; k < READINGS; k++) {
        read_height(HEIGHT_M + 1.0f, 0.0f);
    }
}

/* GIVEN an image whose rows are all taken THEN the information of the heights waits, and none of it is lost. */
static void an_overflow_is_reported_later(void) {
    read_without_rows();
    goe_rows_clear(&rows, &matrix);
    rows.count = GOE_ROWS_MAX;
    TEST_ASSERT_EQUAL_INT(0, goe_ground_row(&filter, &obs, &rows));
    TEST_ASSERT_EQUAL_INT(1, give());
    TEST_ASSERT_EQUAL_INT(0, give());
    CHECK_CLOSE(0.001, obs.height_sd_m, ground_sd_m());
    CHECK_CLOSE(0.05, 1.0 - 1.0 / READINGS, offset_m());
}

/* GIVEN a filter that knows no position yet THEN what the heights say waits, as its range may be off by a factor; none of it is lost. */
static void without_a_position_the_heights_wait(void) {
    read_without_rows();
    filter.known = 0;
    TEST_ASSERT_EQUAL_INT(0, give());
    filter.known = GOE_HAS_POSITION;
    TEST_ASSERT_EQUAL_INT(1, give());
    CHECK_CLOSE(0.001, obs.height_sd_m, ground_sd_m());
}

/* ------------------------------------------------------------------------------------------------------- range and slope -- */

/* The range proves to be this many times the first guess. */
static void correct_range(float factor) {
    const float before = filter.state[GOE_INVERSE_RANGE];
    filter.state[GOE_INVERSE_RANGE] = before / factor;
    filter.state[GOE_GROUND] /= factor;
    goe_ground_follow(&filter, before);
}

/* [navigation.height_bias_sd_m]
 * GIVEN a first guess of the range that proves wrong, of points or of boxes THEN the uncertainty of the height is the configured one, in
 * meters: no better when the obstacle is nearer, and no worse when it is farther. */
static void a_wrong_first_range_leaves_the_height_as_given(void) {
    static const float factor[] = {0.2f, 0.5f, 0.9f, 1.0f, 1.2f, 2.0f, 5.0f};
    for (size_t i = 0; i < 2 * sizeof factor / sizeof factor[0]; i++) {
        start(RANGE_M);
        filter.boxes = i % 2 != 0;
        correct_range(factor[i / 2]);
        const int reported = measure();
        check_report("sigma of the height over the configured one", ground_sd_m() / (double)CONSTANT_M);
        TEST_ASSERT_EQUAL_INT(factor[i / 2] > 1.0f ? 1 : 0, reported);
        CHECK_CLOSE(0.02, 1.0, ground_sd_m() / (double)CONSTANT_M);
    }
}

#define SLOPE 0.02f

/* [navigation.terrain_height_sd_m, navigation.terrain_slope_sd]
 * GIVEN ground that slopes, and an obstacle whose own ground lies off THEN the first height is off by slope times range, and by that
 * ground, whether points or boxes show the obstacle. */
static void the_slope_counts_over_the_range(void) {
    static const float range_m[] = {20.0f, 100.0f, 400.0f};
    settings.navigation.terrain_slope_sd = SLOPE;
    settings.navigation.terrain_height_sd_m = 1.5f;
    for (size_t i = 0; i < 2 * sizeof range_m / sizeof range_m[0]; i++) {
        view.sides.usable = i % 2 ? GOE_SIDES_ALL : 0;
        start(range_m[i / 2]);
        TEST_ASSERT_EQUAL_INT(i % 2, goe_filter_by_boxes(&filter));
        const double slope_m = (double)(SLOPE * range_m[i / 2]);
        const double expected = sqrt((double)(CONSTANT_M * CONSTANT_M) + 1.5 * 1.5 + slope_m * slope_m);
        CHECK_CLOSE(1.0e-4 * expected, expected, ground_sd_m());
        CHECK_CLOSE(1.0e-4 * expected, expected,
                    sqrt((double)goe_ground_variance(&obs, filter.state[GOE_INVERSE_RANGE])) * (double)range_m[i / 2]);
        TEST_ASSERT_EQUAL_INT(0, measure());
        CHECK_CLOSE(1.0e-4 * expected, expected, ground_sd_m());
    }
}

/* [navigation.terrain_slope_sd]
 * GIVEN ground that slopes WHEN the first guess of the range proves wrong THEN the height is off by slope times the corrected range. */
static void the_slope_counts_over_a_corrected_range(void) {
    static const float factor[] = {0.2f, 0.5f, 0.8f, 1.0f, 1.5f, 2.0f, 5.0f};
    settings.navigation.terrain_slope_sd = SLOPE;
    for (size_t i = 0; i < sizeof factor / sizeof factor[0]; i++) {
        start(RANGE_M);
        correct_range(factor[i]);
        filter.due_s = 1.0e-6f; /* another image */
        look();
        (void)measure();
        const double expected = hypot((double)CONSTANT_M, (double)(SLOPE * factor[i] * RANGE_M));
        check_report("range over the first guess", (double)factor[i]);
        check_report("sigma of the height over that of the slope", ground_sd_m() / expected);
        CHECK_CLOSE(0.02, 1.0, ground_sd_m() / expected);
    }
}

/* GIVEN readings that scattered more than configured WHEN the range then proves to be farther THEN what they lost stays lost. */
static void a_corrected_range_brings_no_lost_information_back(void) {
    settings.navigation.height_white_sd_m = 0.5f;
    read_height(HEIGHT_M, 0.0f);
    start(RANGE_M);
    for (int k = 1; k < READINGS; k++) {
        read_height(HEIGHT_M + (k % 2 ? WHITE_M : -WHITE_M), 0.0f);
        (void)measure();
    }
    correct_range(2.0f);
    look();
    (void)measure();
    CHECK_CLOSE(0.05 * (double)obs.height_sd_m, obs.height_sd_m, ground_sd_m());
}

/* ------------------------------------------------------------------------------------------------------- the first height -- */

/* GIVEN a first image that knows its own height's error THEN that is kept for the filter's start, of that image and no later one. */
static void the_first_heights_own_error_is_kept(void) {
    image.noise.height_sd_m = 0.7f;
    read_height(HEIGHT_M, 0.0f);
    CHECK_SAME(0.7f, filter.datum.sd_m);
    image.noise.height_sd_m = 0.2f;
    read_height(HEIGHT_M, 0.0f);
    CHECK_SAME(0.7f, filter.datum.sd_m);
    CHECK_CLOSE(1.0e-6, 0.7, obs.height_sd_m);
}

/* GIVEN heights with a white error and a box in each image WHEN the height is not set THEN no reading counts and the ground's height is
 * unknown; the first height that is set is the first reading, and scatters about none. */
static void a_height_that_is_not_set_is_no_reading(void) {
    settings.navigation.height_white_sd_m = WHITE_M;
    image.box.sides = GOE_SIDES_ALL;
    image.noise.height_sd_m = 0.7f; /* of a height that is not there */
    read_height(0.0f, 0.0f);
    read_height(0.0f, 0.0f);
    TEST_ASSERT_EQUAL_UINT8(0u, filter.health.heights);
    TEST_ASSERT_TRUE(obs.height_sd_m >= 1.0e3f);
    image.pose.height_m = HEIGHT_M;
    read_height(HEIGHT_M, 0.0f);
    TEST_ASSERT_EQUAL_UINT8(1u, filter.health.heights);
    CHECK_CLOSE(1.0e-5, (double)HEIGHT_M, filter.datum.height_m);
    TEST_ASSERT_TRUE(filter.datum.scatter_m2 <= WHITE_M * WHITE_M);
}

/* [goe_pose_t.height_m] GIVEN an image without a height among others THEN the height moves on by the change of down. */
static void a_missing_height_is_moved_on(void) {
    read_height(HEIGHT_M, 0.0f);
    image.box.sides = GOE_SIDES_ALL;
    read_height(0.0f, 3.0f);
    CHECK_CLOSE(1.0e-5, (double)HEIGHT_M - 3.0, obs.height_m);
    CHECK_CLOSE(1.0e-6, (double)CONSTANT_M, obs.height_sd_m);
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

/* GIVEN a footprint that began by points WHEN the first upright box comes THEN the track is one by boxes, and its height is as certain as
 * before: the obstacle's own ground counts from the start. */
static void the_first_box_changes_no_height(void) {
    settings.navigation.terrain_height_sd_m = 2.0f;
    start(RANGE_M);
    TEST_ASSERT_FALSE(goe_filter_by_boxes(&filter));
    goe_ground_meet_box(&filter);
    TEST_ASSERT_TRUE(goe_filter_by_boxes(&filter));
    CHECK_CLOSE(1.0e-3, sqrt(4.0 + 4.0), ground_sd_m());
}

/* GIVEN an autopilot whose down jumps WHEN the ground moves along THEN the readings say the same as before. */
static void a_jump_of_down_is_no_scatter(void) {
    settings.navigation.height_white_sd_m = 0.5f;
    read_height(HEIGHT_M, 0.0f);
    start(RANGE_M);
    goe_ground_move(&filter, 30.0f);
    read_height(HEIGHT_M, 30.0f);
    CHECK_CLOSE(1.0e-5, (double)HEIGHT_M, obs.height_m);
    CHECK_CLOSE(1.0e-5, 0.0, filter.datum.mean_m);
    TEST_ASSERT_TRUE(filter.datum.scatter_m2 <= 0.25f);
}

/* GIVEN readings without any information, and a range that becomes twenty times smaller with each image WHEN the first height is widened each
 * time THEN the variance stays finite, and so do all elements of the root. */
static void a_range_that_leaps_widens_no_ground_without_end(void) {
    settings.navigation.position_walk_sd_m = 0.05f;
    read_height(HEIGHT_M, 0.0f);
    start(RANGE_M);
    for (int k = 0; k < 10 * READINGS; k++) {
        filter.ground_scale = 0.05f;
        goe_ground_widen(&filter, &settings.navigation);
        TEST_ASSERT_TRUE(isfinite((double)goe_filter_variance(&filter, GOE_GROUND)));
    }
    for (size_t i = 0; i < sizeof filter.root.element / sizeof filter.root.element[0]; i++) {
        TEST_ASSERT_TRUE(isfinite((double)filter.root.element[i]));
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(a_height_of_0_is_none);
    RUN_TEST(exact_heights_are_taken_at_once);
    RUN_TEST(exact_heights_correct_a_drift_of_down);
    RUN_TEST(readings_give_the_mean_and_no_more);
    RUN_TEST(the_mean_of_a_drifting_down_is_the_best);
    RUN_TEST(before_the_start_the_mean_is_the_ground);
    RUN_TEST(a_filter_that_starts_again_receives_the_same_mean);
    RUN_TEST(the_count_of_readings_saturates);
    RUN_TEST(down_that_drifts_makes_the_height_uncertain);
    RUN_TEST(a_scatter_beyond_the_configured_one_stays);
    RUN_TEST(a_scatter_that_ends_is_forgotten);
    RUN_TEST(an_overflow_is_reported_later);
    RUN_TEST(without_a_position_the_heights_wait);
    RUN_TEST(a_wrong_first_range_leaves_the_height_as_given);
    RUN_TEST(the_slope_counts_over_the_range);
    RUN_TEST(the_slope_counts_over_a_corrected_range);
    RUN_TEST(a_corrected_range_brings_no_lost_information_back);
    RUN_TEST(the_first_heights_own_error_is_kept);
    RUN_TEST(a_height_that_is_not_set_is_no_reading);
    RUN_TEST(a_missing_height_is_moved_on);
    RUN_TEST(the_arm_moves_the_camera_up_and_down);
    RUN_TEST(the_first_box_changes_no_height);
    RUN_TEST(a_jump_of_down_is_no_scatter);
    RUN_TEST(a_range_that_leaps_widens_no_ground_without_end);
    return UNITY_END();
}
