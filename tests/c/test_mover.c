/* Late poses and obstacles that move: the columns against differences, the estimates against flights whose poses are late or
 * whose obstacle moves, and none of it where nothing is late or moves. SPDX-License-Identifier: MIT */
/* tests: lib/refined/goe_mover.c */
#include "refined/goe_mover.h"

#include <math.h>
#include <string.h>

#include "check.h"
#include "image/goe_ego_motion.h"
#include "inverse.h"
#include "refined/goe_footprint.h"
#include "scene.h"
#include "sighting.h"

#define UNKNOWNS GOE_UNKNOWNS
#define CASES 200
#define FLIGHTS 10
#define IMAGES 48
#define NOISE_PX 0.5
#define FINE_HZ 80.0 /* images of the scene, of which every tenth is used */
#define STEP 10

static check_random_t any;
static goe_estimator_t estimator;
static scene_t scene;

void setUp(void) {
    any = check_random_start("mover");
    scene_default(&scene);
    scene.image_rate_hz = FINE_HZ;
    scene.wobble_deg = 3.0;
    scene.z0_m = 160.0;
}
void tearDown(void) {}

/* ------------------------------------------------------------------------------------------------- augmented states --------- */

typedef struct {
    double information[UNKNOWNS][UNKNOWNS];
    double right[UNKNOWNS];
} normal_t;

/* R'R and R'z of the triangle, and what rows of unit noise without nuisances add. */
static void add_triangle(goe_triangle_t *root, normal_t *n) {
    for (size_t k = 0; k < UNKNOWNS; k++) {
        for (size_t i = k; i < UNKNOWNS; i++) {
            for (size_t j = k; j < UNKNOWNS; j++) {
                n->information[i][j] += (double)*goe_srif_at(root, k, i) * (double)*goe_srif_at(root, k, j);
            }
            const double z = k < GOE_STATES ? 0.0 : (double)root->right[k - GOE_STATES];
            n->right[i] += (double)*goe_srif_at(root, k, i) * z;
        }
    }
}

static void add_rows(const goe_matrix_t *matrix, normal_t *n) {
    for (size_t r = 0; r < GOE_ROWS_MAX; r++) {
        const float *by = &matrix->row[r][GOE_STATE_COLUMN];
        for (size_t i = 0; i < UNKNOWNS; i++) {
            for (size_t j = 0; j < UNKNOWNS; j++) {
                n->information[i][j] += (double)by[i] * (double)by[j];
            }
            n->right[i] += (double)by[i] * (double)matrix->row[r][GOE_RESIDUAL];
        }
    }
}

/* [(R33)] GIVEN any triangle, with augmented states, and any rows WHEN some of these are estimated THEN information and right-hand
 * side are those of the normal equations, and the estimated ones solve these with the others as they are. */
static void augmented_states_are_solved_with_the_state(void) {
    for (unsigned c = 0; c < CASES; c++) {
        goe_triangle_t root;
        goe_matrix_t matrix;
        float change[UNKNOWNS];
        normal_t expected;
        normal_t actual;
        memset(&root, 0, sizeof root);
        memset(&matrix, 0, sizeof matrix);
        memset(&expected, 0, sizeof expected);
        memset(&actual, 0, sizeof actual);
        for (size_t i = 0; i < UNKNOWNS; i++) {
            for (size_t j = i; j < UNKNOWNS; j++) {
                *goe_srif_at(&root, i, j) = (float)(0.3 * check_random_normal(&any));
            }
            *goe_srif_at(&root, i, i) = 3.0f;
        }
        for (size_t r = 0; r < GOE_ROWS_MAX; r++) {
            for (size_t i = GOE_STATE_COLUMN; i < GOE_COLUMNS; i++) {
                matrix.row[r][i] = (float)check_random_normal(&any);
            }
        }
        root.estimated = (uint8_t)(c % (GOE_AUGMENTED + 1));
        for (size_t i = root.estimated; i < GOE_AUGMENTED; i++) {
            root.right[i] = (float)check_random_normal(&any);
        }
        add_triangle(&root, &expected);
        add_rows(&matrix, &expected);
        (void)goe_srif_update(&root, 1.0f, &matrix, GOE_ROWS_MAX, change);
        add_triangle(&root, &actual);
        for (size_t i = 0; i < UNKNOWNS; i++) {
            double moved = 0.0;
            for (size_t j = 0; j < UNKNOWNS; j++) {
                CHECK_CLOSE(1.0e-4, expected.information[i][j], actual.information[i][j]);
                moved += expected.information[i][j] * (double)change[j];
            }
            CHECK_CLOSE(2.0e-4, expected.right[i] - moved, actual.right[i]);
            if (i < goe_srif_count(&root)) {
                CHECK_CLOSE(2.0e-4, expected.right[i], moved);
            } else {
                CHECK_SAME(0.0f, change[i]);
            }
        }
    }
}

/* [(R19)] GIVEN a latency that is about to be estimated WHEN the states change by a substitution THEN its pending change is kept. */
static void a_change_of_states_keeps_augmented_states(void) {
    goe_triangle_t root;
    goe_substitution_t same;
    memset(&root, 0, sizeof root);
    memset(&same, 0, sizeof same);
    for (size_t i = 0; i < UNKNOWNS; i++) {
        *goe_srif_at(&root, i, i) = 2.0f;
    }
    for (size_t i = 0; i < GOE_CHANGED; i++) {
        same.by[i][i] = 1.0f;
    }
    *goe_srif_at(&root, GOE_TOP, GOE_STATES) = 0.5f;
    root.estimated = 1;
    root.right[0] = 5.0f;
    goe_srif_substitute(&root, &same);
    TEST_ASSERT_EQUAL_UINT8(1, root.estimated);
    CHECK_CLOSE(1.0e-6, 5.0 * 2.0, root.right[0] * *goe_srif_at(&root, GOE_STATES, GOE_STATES));
    CHECK_CLOSE(1.0e-6, 0.5 * 2.0, *goe_srif_at(&root, GOE_TOP, GOE_STATES) * *goe_srif_at(&root, GOE_TOP, GOE_TOP));
}

/* [(R21), (R33), (R35)] GIVEN an estimate with augmented states THEN the variance of a quantity, on which the attitude's bias has
 * no part, and of a row, is that of the whole inverse. A velocity that is not estimated adds the square of its effect times its sigma. */
static void the_variance_includes_augmented_states(void) {
    goe_triangle_t root;
    memset(&root, 0, sizeof root);
    for (size_t i = 0; i < UNKNOWNS; i++) {
        for (size_t j = i; j < UNKNOWNS; j++) {
            *goe_srif_at(&root, i, j) = (float)(0.3 * check_random_normal(&any));
        }
        *goe_srif_at(&root, i, i) = 3.0f;
    }
    float reciprocal[GOE_STATES];
    goe_srif_reciprocals(&root, reciprocal);
    for (int c = 0; c < CASES; c++) {
        static const uint8_t estimated[] = {GOE_AUGMENTED, 1, 0};
        root.estimated = estimated[c % 3];
        const size_t count = (size_t)GOE_STATES + root.estimated;
        const double considered = c % 4 == 0 ? 0.0 : 0.3;
        float weight[GOE_STATES];
        float direct[GOE_AUGMENTED];
        float part[GOE_AUGMENTED];
        double v[UNKNOWNS];
        const size_t first = c % 2 == 0 ? GOE_UNWEIGHTED : 0; /* of a quantity, or of a row */
        for (size_t i = 0; i < UNKNOWNS; i++) {               /* R'v = w: the variance is v'v */
            const float w = i < first ? 0.0f : (float)check_random_normal(&any);
            *(i < GOE_STATES ? &weight[i] : &direct[i - GOE_STATES]) = w;
            v[i] = (double)w;
            for (size_t k = 0; k < i; k++) {
                v[i] -= (double)*goe_srif_at(&root, k, i) * v[k];
            }
            v[i] /= (double)*goe_srif_at(&root, i, i);
        }
        double expected = 0.0;
        for (size_t i = 0; i < count; i++) {
            expected += v[i] * v[i];
        }
        for (size_t i = count > GOE_STATES ? count : GOE_STATES + 1; i < UNKNOWNS; i++) {
            double effect = (double)direct[i - GOE_STATES];
            for (size_t k = 0; k < count; k++) {
                effect -= (double)*goe_srif_at(&root, k, i) * v[k];
            }
            expected += considered * considered * effect * effect;
        }
        double sum = (double)goe_srif_project(&root, reciprocal, first, weight);
        goe_srif_augmented(&root, weight, first, direct, (float)considered, part);
        for (size_t i = 0; i < GOE_AUGMENTED; i++) {
            sum += (double)part[i] * (double)part[i];
        }
        CHECK_CLOSE(1.0e-5 * expected, expected, sum);
    }
}

/* ----------------------------------------------------------------------------------------------------------- columns -- */

static void rows_of(sighting_t *s) {
    sighting_clear_rows(s);
    goe_observation_linearise(&s->sight);
    goe_footprint_rows(&s->sight, &s->rows);
    goe_rows_end(&s->rows, &s->sight);
}

/* The points come to lie where the state predicts them. */
static void settle(sighting_t *s) {
    for (int i = 0; i < SETTLED; i++) {
        rows_of(s);
        for (size_t r = 0; r < s->rows.count; r++) {
            goe_point_t *point = &s->sight.point[s->rows.feature[r]];
            *(s->rows.axis[r] == GOE_ALONG_X ? &point->x : &point->y) -= s->matrix.row[r][GOE_RESIDUAL];
        }
    }
    rows_of(s);
}

static void check_columns(void) {
    static sighting_t s;
    goe_axes_t axes;
    memset(&axes, 0, sizeof axes);
    static sighting_t moved;
    sighting_start(&s, &any);
    s.state[GOE_BEARING] = (float)check_random_between(&any, -0.1, 0.1);
    s.state[GOE_INVERSE_RANGE] = 0.01f;
    s.state[GOE_SHEAR] = (float)check_random_between(&any, -0.05, 0.05);
    s.state[GOE_HALF] = 0.05f;
    s.state[GOE_LOG_DEPTH] = (float)check_random_between(&any, -0.5, 0.5);
    s.state[GOE_TOP] = 0.2f;
    for (size_t f = 0; f <= GOE_POINT_TOP; f++) {
        s.sight.point[f].usable = true;
        s.sight.point[f].x = f == GOE_POINT_LEFT ? -0.1f : 0.1f;
        s.sight.point[f].y = 0.02f;
    }
    axes.turn_cos = 0.8f;
    axes.turn_sin = 0.6f;
    s.sight.elapsed_s = 3.0f;
    for (size_t i = 0; i < 3; i++) {
        s.sight.rate_rad_s[i] = (float)check_random_between(&any, -0.3, 0.3);
        s.sight.rate_before_rad_s[i] = s.sight.rate_rad_s[i] / 0.8f; /* of which the column takes that share */
    }
    s.sight.gained_m_s.x = 4.0f;
    s.sight.gained_m_s.z = -7.0f;
    settle(&s);
    TEST_ASSERT_TRUE(s.rows.count == 3);
    goe_mover_columns(&axes, &s.sight, &s.rows);
    for (size_t i = 0; i < GOE_AUGMENTED; i++) {
        const double step = i == GOE_AUGMENTED_LATENCY ? 0.02 : 0.2;
        double residual[2][GOE_ROWS_MAX];
        for (int way = 0; way < 2; way++) {
            const double by = way == 0 ? -step : step;
            moved = s;
            moved.sight.state = moved.state;
            moved.sight.settings = &moved.settings;
            if (i == GOE_AUGMENTED_LATENCY) {
                moved.sight.latency_s = (float)by;
                moved.sight.camera_m.x += (float)by * s.sight.gained_m_s.x;
                moved.sight.camera_m.z += (float)by * s.sight.gained_m_s.z;
            } else { /* the state's axes are turned out of T by that angle */
                const double x = i == GOE_AUGMENTED_VELOCITY_X ? 0.8 : -0.6;
                const double z = i == GOE_AUGMENTED_VELOCITY_X ? 0.6 : 0.8;
                moved.sight.camera_m.x -= (float)(by * 3.0 * x);
                moved.sight.camera_m.z -= (float)(by * 3.0 * z);
            }
            rows_of(&moved);
            for (size_t r = 0; r < s.rows.count; r++) {
                residual[way][r] = (double)moved.matrix.row[r][GOE_RESIDUAL];
            }
        }
        for (size_t r = 0; r < s.rows.count; r++) {
            const double expected = (residual[0][r] - residual[1][r]) / (2.0 * step);
            const double column = (double)s.matrix.row[r][GOE_AUGMENTED_COLUMN + i];
            CHECK_CLOSE(0.003 + 0.03 * fabs(expected), expected, column);
        }
    }
}

/* [(R33)] GIVEN a footprint anywhere THEN the columns are the derivatives by the latency and by the velocity. */
static void the_columns_are_derivatives(void) {
    for (int c = 0; c < CASES; c++) {
        check_columns();
    }
}

/* ----------------------------------------------------------------------------------------------------------- followed -- */

/* One image after the start of following an obstacle, by its state at that time. */
static goe_mover_t judge_followed(float latency_s, float velocity_m_s, float velocity_sd_m_s) {
    const float sd[GOE_AUGMENTED] = {0.01f, velocity_sd_m_s, velocity_sd_m_s};
    const float change[GOE_UNKNOWNS] = {0.0f};
    goe_filter_t filter;
    sighting_t s;
    sighting_start(&s, &any);
    goe_filter_clear(&filter);
    filter.mover.followed = true;
    filter.mover.augmented[GOE_AUGMENTED_LATENCY] = latency_s;
    filter.mover.augmented[GOE_AUGMENTED_VELOCITY_X] = velocity_m_s;
    inverse_start(&filter.root, 1.0);
    for (size_t i = 0; i < GOE_AUGMENTED; i++) {
        *goe_srif_at(&filter.root, GOE_STATES + i, GOE_STATES + i) = 1.0f;
    }
    filter.root.estimated = GOE_AUGMENTED;
    for (size_t i = 0; i < GOE_AUGMENTED; i++) {
        inverse_set(&filter.root, GOE_STATES + i, GOE_STATES + i, (double)sd[i]);
    }
    TEST_ASSERT_FALSE(goe_mover_judge(&filter, &s.sight, change, 0.1f));
    return filter.mover;
}

/* GIVEN an obstacle that is followed THEN it moves, unless the poses have proved late meanwhile: then only a fast one, and
 * surely so, as late poses of a turn look like a motion. */
static void late_poses_end_a_motion_that_is_none(void) {
    const goe_mover_t in_time = judge_followed(0.0f, 0.5f, 0.1f);
    TEST_ASSERT_TRUE(in_time.moves && !in_time.late);
    const goe_mover_t both = judge_followed(0.2f, 5.0f, 0.2f);
    TEST_ASSERT_TRUE(both.moves && both.late);
    const goe_mover_t slow = judge_followed(0.2f, 0.5f, 0.05f);
    TEST_ASSERT_TRUE(!slow.moves && slow.late);
    const goe_mover_t unsure = judge_followed(-0.2f, 5.0f, 3.0f);
    TEST_ASSERT_TRUE(!unsure.moves && unsure.late);
}

/* --------------------------------------------------------------------------------------------------------- judgement -- */

static goe_filter_t judged;
static goe_settings_t judging;
static goe_observation_t seen;
static goe_sides_t seen_sides;
static const double reported[3][3] = {{30.0, 2.0, 1.0}, {0.0, 6.0, 1.5}, {0.0, 0.0, 5.0}}; /* of latency and velocity */

/* A box by its corners, long in flight, whose images give T (latency, velocity) = z, with residuals of twice the configured
 * variance, the latency so far being 30 ms. */
static void give_rows(const double z[3]) {
    goe_settings_default(&judging);
    memset(&seen, 0, sizeof seen);
    memset(&seen_sides, 0, sizeof seen_sides);
    goe_filter_clear(&judged);
    seen.settings = &judging;
    seen.sides = &seen_sides;
    seen.base = true;
    seen.elapsed_s = 4.0f;
    judged.phase = GOE_PHASE_BOX;
    for (size_t i = 0; i < 3; i++) {
        for (size_t j = i; j < 3; j++) {
            *goe_srif_at(&judged.root, GOE_STATES + i, GOE_STATES + j) = (float)reported[i][j];
        }
        judged.root.right[i] = (float)z[i];
    }
    judged.mover.augmented[0] = 0.03f;
    judged.root.right[0] -= (float)(reported[0][0] * 0.03);
    judged.mover.observed_s = 3.0f;
    judged.mover.rows = 100.0f;
    judged.mover.nis = (float)(200.0 + z[0] * z[0] + z[1] * z[1] + z[2] * z[2]);
    judged.health.nis = 18.0f;
    judged.health.nis_rows = 9;
}

static bool judge_image(void) {
    const float change[GOE_UNKNOWNS] = {0.0f};
    return goe_mover_judge(&judged, &seen, change, 0.3f);
}

static void by_velocity(double x, double z, double to[3]) {
    for (size_t i = 0; i < 3; i++) {
        to[i] = reported[i][1] * x + reported[i][2] * z;
    }
}

/* GIVEN images with evidence of a velocity, one after the other THEN in the third the obstacle begins to be followed with just that
 * velocity, five times as uncertain as the residuals say and the own motion allows, but no more than any velocity on the ground; the latency,
 * which it may have been taken for, is open again. */
static void a_newly_followed_target_starts_from_the_images(void) {
    double z[3];
    by_velocity(4.0, -3.0, z);
    give_rows(z);
    judging.navigation.velocity_bias_sd_m_s = 0.3f;
    judging.navigation.position_walk_sd_m = 0.2f;
    TEST_ASSERT_FALSE(judge_image());
    TEST_ASSERT_FALSE(judge_image());
    TEST_ASSERT_FALSE(judged.mover.followed);
    TEST_ASSERT_TRUE(judge_image());
    TEST_ASSERT_TRUE(judged.mover.followed && judged.mover.moves && !judged.mover.late);
    CHECK_SAME(0.0f, judged.mover.augmented[0]);
    CHECK_CLOSE(1.0e-4, 4.0, judged.mover.augmented[1]);
    CHECK_CLOSE(1.0e-4, -3.0, judged.mover.augmented[2]);
    TEST_ASSERT_EQUAL_UINT8(GOE_AUGMENTED, judged.root.estimated);
    CHECK_CLOSE(1.0e-3, 20.0, *goe_srif_at(&judged.root, GOE_STATES, GOE_STATES));
    /* the covariance of the velocity, from T'T of its two columns */
    const double xx = reported[0][1] * reported[0][1] + reported[1][1] * reported[1][1];
    const double xz = reported[0][1] * reported[0][2] + reported[1][1] * reported[1][2];
    const double zz =
        reported[0][2] * reported[0][2] + reported[1][2] * reported[1][2] + reported[2][2] * reported[2][2];
    const double d = xx * zz - xz * xz;
    const double own = 0.09 + 0.04 / 4.0;
    const double variance[2] = {25.0 * (2.0 * zz / d + own), 25.0 * (2.0 * xx / d + own)};
    for (size_t k = 0; k < 2; k++) {
        const double sigma = 1.0 / (double)*goe_srif_at(&judged.root, GOE_STATES + 1 + k, GOE_STATES + 1 + k);
        CHECK_CLOSE(1.0e-3, fmin(sqrt(variance[k]), 8.0), sigma);
    }
    CHECK_SAME(0.0f, *goe_srif_at(&judged.root, GOE_STATES + 1, GOE_STATES + 2));
}

/* [(R34), (R35)] GIVEN images in which the obstacle is larger than its range lets it be, by more than three sigma, or a velocity that nothing
 * on the ground has THEN it is followed from a velocity of 0 with a sigma of 8 m/s; without a foot it moves, but is not followed. */
static void an_outgrown_range_is_a_motion(void) {
    double z[3];
    for (int n = 0; n < 4; n++) {
        const bool outgrown = n < 2;
        const bool scale = n != 1;
        by_velocity(outgrown ? 0.0 : 30.0, 0.0, z);
        give_rows(z);
        judging.navigation.velocity_bias_sd_m_s = 0.3f;
        seen.grown2 = outgrown ? 9.1f : 8.9f;
        seen.base = scale;
        bool follows = false;
        for (int i = 0; i < 3; i++) {
            TEST_ASSERT_FALSE(follows);
            follows = judge_image();
        }
        TEST_ASSERT_EQUAL(scale, follows);
        TEST_ASSERT_TRUE(judged.mover.moves);
        if (scale) {
            CHECK_SAME(0.0f, judged.mover.augmented[1]);
            CHECK_SAME(0.0f, judged.mover.augmented[2]);
            CHECK_CLOSE(1.0e-6, 1.0 / 8.0, *goe_srif_at(&judged.root, GOE_STATES + 1, GOE_STATES + 1));
            CHECK_CLOSE(1.0e-6, 1.0 / 8.0, *goe_srif_at(&judged.root, GOE_STATES + 2, GOE_STATES + 2));
        }
    }
}

/* GIVEN the same of an obstacle whose foot no image shows THEN it is not followed, as its velocity may be another range; it is reported as
 * moving only if the images do not fit. */
static void a_target_without_scale_is_not_followed(void) {
    double z[3];
    by_velocity(4.0, -3.0, z);
    for (int nis_ratio = 0; nis_ratio < 2; nis_ratio++) {
        give_rows(z);
        seen.base = false;
        judged.health.mean_nis = nis_ratio == 1 ? 3.0f : 1.0f;
        for (int i = 0; i < 5; i++) {
            TEST_ASSERT_FALSE(judge_image());
        }
        TEST_ASSERT_FALSE(judged.mover.followed);
        TEST_ASSERT_EQUAL_INT(nis_ratio, judged.mover.moves ? 1 : 0);
    }
    give_rows(z); /* of a box its bottom */
    judged.phase = GOE_PHASE_FOOTPRINT;
    judged.boxes = true;
    seen.base = false;
    seen_sides.usable = GOE_SIDE_BOTTOM;
    judged.mover.nis -= 100.0f; /* more is required */
    (void)judge_image();
    (void)judge_image();
    TEST_ASSERT_TRUE(judge_image());
}

/* GIVEN a velocity that is slow, or as large as chance makes it, or that a latency explains as well, or a track that has hardly begun
 * THEN nothing is followed. */
static void chance_motion_is_not_followed(void) {
    double z[3];
    for (int n = 0; n < 4; n++) {
        by_velocity(n == 0 ? 0.9 : 4.0, n == 0 ? 0.0 : -3.0, z);
        if (n == 1) {
            z[0] += 30.0; /* a part that no velocity explains */
        }
        give_rows(z);
        if (n == 2) {
            judging.navigation.velocity_bias_sd_m_s = 1.1f; /* five of these in both together are not it */
        } else if (n == 3) {
            judged.mover.observed_s = 0.0f;
        }
        for (int i = 0; i < 4; i++) {
            TEST_ASSERT_FALSE(judge_image());
        }
        TEST_ASSERT_FALSE(judged.mover.followed || judged.mover.moves);
    }
}

/* GIVEN images with evidence of a latency that no velocity explains THEN it is estimated from then on, and reported; if a velocity
 * explains it as well, it is not. */
static void a_latency_that_no_velocity_explains_is_estimated(void) {
    double z[3];
    const double late[3] = {30.0 * 0.4, 0.5, -0.5}; /* 0.4 s */
    give_rows(late);
    TEST_ASSERT_FALSE(judge_image());
    TEST_ASSERT_EQUAL_UINT8(1, judged.root.estimated);
    TEST_ASSERT_TRUE(judged.mover.late);
    by_velocity(4.0, -3.0, z);
    give_rows(z);
    TEST_ASSERT_FALSE(judge_image());
    TEST_ASSERT_EQUAL_UINT8(0, judged.root.estimated);
    TEST_ASSERT_FALSE(judged.mover.late);
    const double little[3] = {30.0 * 0.1, 0.5, -0.5}; /* 3 of 2.7 sigma, times the root of two */
    give_rows(little);
    TEST_ASSERT_FALSE(judge_image());
    TEST_ASSERT_FALSE(judged.mover.late);
}

/* An obstacle that is followed, with a velocity and a latency of these sigmas. */
static void be_followed(float x_m_s, float z_m_s, float sd_m_s, float latency_s, float sd_s) {
    const double nothing[3] = {0.0, 0.0, 0.0};
    give_rows(nothing);
    judged.mover.followed = true;
    judged.mover.moves = true;
    judged.mover.augmented[0] = latency_s;
    judged.mover.augmented[1] = x_m_s;
    judged.mover.augmented[2] = z_m_s;
    judged.root.estimated = GOE_AUGMENTED;
    const float sigma[3] = {sd_s, sd_m_s, sd_m_s};
    for (size_t i = 0; i < GOE_STATES; i++) {
        *goe_srif_at(&judged.root, i, i) = 1.0f;
    }
    for (size_t i = 0; i < 3; i++) {
        inverse_set(&judged.root, GOE_STATES + i, GOE_STATES + i, (double)sigma[i]);
    }
}

/* GIVEN an obstacle that is followed WHEN the poses prove late THEN it moves only as far as its velocity is still more than three
 * sigma and a meter a second; when they are in time it does. Late poses in a turn look like a motion at first. */
static void a_followed_target_may_prove_to_be_late_poses(void) {
    static const struct {
        float x, z, sd, latency, sd_s;
        bool late, moves;
    } cases[] = {{3.0f, 4.0f, 0.5f, 0.0f, 0.01f, false, true},   {3.0f, 4.0f, 5.0f, 0.0f, 0.01f, false, true},
                 {3.0f, 4.0f, 0.5f, 0.1f, 0.01f, true, true},    {3.0f, 4.0f, 2.0f, 0.1f, 0.01f, true, false},
                 {0.6f, 0.7f, 0.01f, 0.1f, 0.01f, true, false},  {-3.0f, 4.0f, 1.6f, -0.1f, 0.01f, true, true},
                 {-3.0f, -4.0f, 1.7f, 0.1f, 0.01f, true, false}, {3.0f, 4.0f, 0.5f, 0.1f, 0.05f, false, true},
                 {3.0f, 4.0f, 5.0f, 0.019f, 0.001f, false, true}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        be_followed(cases[i].x, cases[i].z, cases[i].sd, cases[i].latency, cases[i].sd_s);
        TEST_ASSERT_FALSE(judge_image());
        TEST_ASSERT_EQUAL_INT(cases[i].late, judged.mover.late);
        TEST_ASSERT_EQUAL_INT(cases[i].moves, judged.mover.moves);
        TEST_ASSERT_TRUE(judged.mover.followed);
    }
}

/* GIVEN a velocity whose two parts hang together THEN its variance along any direction is that of both. */
static void a_velocitys_variance_is_that_of_both_parts(void) {
    be_followed(3.0f, 4.0f, 1.0f, 0.0f, 0.01f);
    inverse_set(&judged.root, GOE_STATES + 1, GOE_STATES + 2, 0.5);
    const goe_xz_t along[] = {{1.0f, 0.0f}, {0.0f, 1.0f}, {0.6f, 0.8f}, {-0.6f, 0.8f}};
    const double expected[] = {1.25, 1.0, 0.36 + (0.3 + 0.8) * (0.3 + 0.8), 0.36 + (-0.3 + 0.8) * (-0.3 + 0.8)};
    for (size_t i = 0; i < 4; i++) {
        CHECK_CLOSE(1.0e-5, expected[i], goe_mover_variance(&judged, along[i]));
    }
}

/* GIVEN numbers that are impossible in a flight THEN all augmented states begin again, and with them the filter, if its axes moved along.
 * */
static void values_outside_any_flight_are_forgotten(void) {
    for (int followed = 0; followed < 2; followed++) {
        be_followed(3.0f, 4.0f, 0.5f, 0.0f, 0.01f);
        judged.mover.followed = followed == 1;
        judged.mover.augmented[2] = 2.0e9f;
        TEST_ASSERT_EQUAL_INT(followed, judge_image());
        TEST_ASSERT_TRUE(judged.mover.moves && !judged.mover.followed); /* the warning stays */
        CHECK_SAME(0.0f, judged.mover.augmented[2]);
        TEST_ASSERT_EQUAL_UINT8(0, judged.root.estimated);
    }
}

/* ----------------------------------------------------------------------------------------------------------- flights -- */

typedef struct {
    goe_estimate_t estimate;
    int moving, suspect, images; /* that said so; solved ones */
} flight_t;

/* late: images of the fine rate that the pose is behind by; velocity: of the obstacle, north and east. */
static flight_t fly(int late, double north_m_s, double east_m_s) {
    flight_t flight;
    goe_settings_t settings = scene_settings(&scene);
    scene_level_ground(&settings);
    memset(&flight, 0, sizeof flight);
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
    for (int k = 0; k < IMAGES; k++) {
        goe_image_t image;
        goe_image_t before;
        const int fine = 20 + STEP * k;
        const double t = fine / FINE_HZ;
        scene_image(&scene, fine, &image, NULL);
        scene_image(&scene, fine - late, &before, NULL);
        before.pose.time_us = image.pose.time_us;
        image.pose = before.pose;
        image.pose.position_ned_m[0] += (float)(north_m_s * t); /* as it sees an obstacle that moves */
        image.pose.position_ned_m[1] += (float)(east_m_s * t);
        scene_add_noise(&image, &any, NOISE_PX);
        const goe_status_t status = goe_update(&estimator, &image, &flight.estimate);
        flight.images += status == GOE_OK ? 1 : 0;
        flight.moving += flight.estimate.reason == GOE_REASON_MOVES ? 1 : 0;
        flight.suspect += flight.estimate.suspect ? 1 : 0;
    }
    return flight;
}

/* GIVEN a turn of constant rate WHEN images come seldom or often THEN rate and velocity are the turn's; poses nearer than 45 ms give only
 * noise and are waited for, and farther than 0.6 s a mean, which is useless. */
static void rate_and_velocity_are_those_of_the_flight(void) {
    static const double rates_hz[] = {80.0, 40.0, 20.0, 8.0, 2.0, 1.25};
    for (size_t i = 0; i < sizeof rates_hz / sizeof rates_hz[0]; i++) {
        goe_estimate_t estimate;
        scene.path = SCENE_ARC;
        scene.arc_radius_m = 120.0;
        scene.wobble_deg = 0.0;
        scene.image_rate_hz = rates_hz[i];
        const goe_settings_t settings = scene_settings(&scene);
        CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
        for (int k = 0; k < 12; k++) {
            goe_image_t image;
            scene_image(&scene, k, &image, NULL);
            (void)goe_update(&estimator, &image, &estimate);
        }
        const goe_motion_t *m = &estimator.motion;
        const bool seldom = rates_hz[i] < 1.0 / 0.6;
        TEST_ASSERT_EQUAL(!seldom, goe_motion_paced(m));
        const double turning =
            seldom ? 0.0 : scene.speed_mps / scene.arc_radius_m; /* to the right: about Y, which is down */
        CHECK_CLOSE(0.01, turning, m->rate_rad_s[1]);
        CHECK_CLOSE(0.01, turning, m->rate_before_rad_s[1]);
        if (!seldom) {
            CHECK_CLOSE(0.01 * scene.speed_mps, scene.speed_mps,
                        hypot((double)m->velocity_m_s[0], (double)m->velocity_m_s[1]));
        }
    }
}

/* [goe_report.c, (R34)] GIVEN a static obstacle and poses in time THEN nothing moves, nothing is late, and nothing is suspect. */
static void nothing_moves_that_does_not(void) {
    for (int n = 0; n < FLIGHTS; n++) {
        const flight_t flight = fly(0, 0.0, 0.0);
        TEST_ASSERT_EQUAL_INT(0, flight.moving);
        TEST_ASSERT_EQUAL_INT(0, flight.suspect);
        TEST_ASSERT_EQUAL_INT(GOE_REASON_NONE, flight.estimate.reason);
        CHECK_SAME(0.0f, flight.estimate.latency_s);
        TEST_ASSERT_EQUAL_HEX(0, flight.estimate.valid & GOE_HAS_VELOCITY);
        CHECK_SAME(0.0f, flight.estimate.velocity_north_m_s);
    }
}

/* [GOE_WITH_TARGET_MOTION, goe_ego_motion.c, (R34)]
 * GIVEN poses of a tenth of a second before, of an aircraft that sways THEN they are reported as late, by about as much, and nothing
 * moves. */
static void late_poses_are_reported_and_taken_off(void) {
    double worst = 0.0;
    for (int n = 0; n < FLIGHTS; n++) {
        const flight_t flight = fly((int)(0.1 * FINE_HZ), 0.0, 0.0);
        check_worst(&worst, (double)flight.estimate.latency_s - 0.1);
        TEST_ASSERT_EQUAL_INT(GOE_REASON_LATE, flight.estimate.reason);
        TEST_ASSERT_EQUAL_INT(0, flight.moving);
    }
    check_report("latency of 0.1 s, off by, s", worst);
    TEST_ASSERT_TRUE(worst < 0.03);
}

/* [GOE_WITH_TARGET_MOTION, (R34), (R35)] GIVEN an obstacle that moves THEN that is reported, and its velocity, within four sigma. */
static void an_obstacle_that_moves_is_followed(void) {
    static const double velocity[][2] = {{0.0, 5.0}, {3.0, -4.0}, {-12.0, 0.0}, {0.0, -10.0}};
    for (size_t i = 0; i < sizeof velocity / sizeof velocity[0]; i++) {
        const flight_t flight = fly(0, velocity[i][0], velocity[i][1]);
        const goe_estimate_t *e = &flight.estimate;
        const double north = ((double)e->velocity_north_m_s - velocity[i][0]) / (double)e->sigma.velocity_north_m_s;
        const double east = ((double)e->velocity_east_m_s - velocity[i][1]) / (double)e->sigma.velocity_east_m_s;
        check_report("velocity to the north, off by, sigmas", north);
        check_report("... to the east", east);
        check_report("sigma to the east, m/s", (double)e->sigma.velocity_east_m_s);
        TEST_ASSERT_TRUE(flight.moving > 0);
        TEST_ASSERT_EQUAL_INT(GOE_REASON_MOVES, e->reason);
        TEST_ASSERT_TRUE(e->suspect);
        TEST_ASSERT_TRUE(e->valid & GOE_HAS_VELOCITY);
        TEST_ASSERT_TRUE(fabs(north) < 4.0 && fabs(east) < 4.0);
        TEST_ASSERT_TRUE(e->sigma.velocity_east_m_s < 2.0f && e->sigma.velocity_east_m_s > 0.0f);
    }
}

/* GIVEN poses that are ahead of the images THEN the latency is reported as negative. */
static void early_poses_are_reported_as_early(void) {
    const flight_t flight = fly(-(int)(0.1 * FINE_HZ), 0.0, 0.0);
    check_report("latency of -0.1 s", (double)flight.estimate.latency_s);
    TEST_ASSERT_EQUAL_INT(GOE_REASON_LATE, flight.estimate.reason);
    CHECK_CLOSE(0.03, -0.1, flight.estimate.latency_s);
    TEST_ASSERT_TRUE(flight.estimate.sigma.latency_s > 0.0f && flight.estimate.sigma.latency_s < 0.03f);
}

/* GIVEN an obstacle that is followed WHEN it is not visible for a while THEN its place relative to the camera moves on with both, and
 * is known less well. */
static void an_old_place_moves_on(void) {
    const flight_t flight = fly(0, -12.0, 0.0);
    goe_estimate_t old;
    goe_image_t image;
    TEST_ASSERT_TRUE(flight.estimate.valid & GOE_HAS_VELOCITY);
    scene_image(&scene, 20 + STEP * (IMAGES - 1), &image, NULL);
    image.pose.position_ned_m[0] += (float)(-12.0 * (20 + STEP * (IMAGES - 1)) / FINE_HZ);
    image.pose.time_us += 2000000; /* the camera is at rest, the obstacle comes */
    scene_hide_points(&image);
    CHECK_STATUS(GOE_NO_DETECTION, goe_update(&estimator, &image, &old));
    const double heading = (double)old.trajectory_heading_deg * 0.017453292519943295;
    const double north_m = 2.0 * (double)flight.estimate.velocity_north_m_s;
    const double east_m = 2.0 * (double)flight.estimate.velocity_east_m_s;
    CHECK_CLOSE(0.01, (double)flight.estimate.z_m + cos(heading) * north_m + sin(heading) * east_m, old.z_m);
    CHECK_CLOSE(0.01, (double)flight.estimate.x_m + cos(heading) * east_m - sin(heading) * north_m, old.x_m);
    TEST_ASSERT_TRUE(old.sigma.z_m > flight.estimate.sigma.z_m);
    CHECK_SAME(flight.estimate.z0_m, old.z0_m);
}

/* [GOE_REASON_MOVES, (R36)] GIVEN an outline alone, which shows directions and no scale WHEN it moves THEN it is never followed. */
static void an_outline_that_moves_is_not_followed(void) {
    int suspect = 0;
    scene_make_cylinder(&scene);
    goe_settings_t settings = scene_settings(&scene);
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
    for (int k = 0; k < IMAGES; k++) {
        goe_image_t image;
        goe_estimate_t estimate;
        const int fine = 20 + STEP * k;
        scene_image(&scene, fine, &image, NULL);
        image.pose.position_ned_m[1] += (float)(8.0 * fine / FINE_HZ);
        scene_add_noise(&image, &any, NOISE_PX);
        (void)goe_update(&estimator, &image, &estimate);
        TEST_ASSERT_EQUAL_HEX(0u, estimate.valid & GOE_HAS_VELOCITY);
        suspect += estimate.suspect ? 1 : 0;
    }
    check_report("images in which it is suspect", suspect);
}

/* GIVEN an obstacle that is followed WHEN it is not visible for two seconds THEN it has gone on with its velocity, relative to the camera
 * that has, too, and its place has become uncertain by the uncertainty of the velocity. */
static void a_followed_target_continues_without_detections(void) {
    const flight_t flight = fly(0, 3.0, -4.0);
    const goe_estimate_t *before = &flight.estimate;
    goe_image_t image;
    goe_estimate_t now;
    const int fine = 20 + STEP * (IMAGES - 1);
    const double t = (fine + 2.0 * FINE_HZ) / FINE_HZ;
    TEST_ASSERT_TRUE(before->valid & GOE_HAS_VELOCITY);
    TEST_ASSERT_TRUE(before->fresh);
    scene_image(&scene, fine + (int)(2.0 * FINE_HZ), &image, NULL);
    image.pose.position_ned_m[0] += (float)(3.0 * t);
    image.pose.position_ned_m[1] += (float)(-4.0 * t);
    scene_hide_points(&image);
    const double dx = (double)estimator.motion.dx_m;
    const double dz = (double)estimator.motion.dz_m;
    CHECK_STATUS(GOE_NO_DETECTION, goe_update(&estimator, &image, &now));
    const double c = (double)estimator.motion.heading_cos;
    const double s = (double)estimator.motion.heading_sin;
    const double north = 2.0 * (double)before->velocity_north_m_s;
    const double east = 2.0 * (double)before->velocity_east_m_s;
    CHECK_CLOSE(2.0e-3, (double)before->x_m + c * east - s * north - ((double)estimator.motion.dx_m - dx), now.x_m);
    CHECK_CLOSE(2.0e-3, (double)before->z_m + c * north + s * east - ((double)estimator.motion.dz_m - dz), now.z_m);
    const double larger = fmax((double)before->sigma.velocity_north_m_s, (double)before->sigma.velocity_east_m_s);
    const goe_navigation_t *own = &estimator.settings.navigation;
    const double own_m2 =
        4.0 * pow((double)own->velocity_bias_sd_m_s, 2.0) + 2.0 * pow((double)own->position_walk_sd_m, 2.0);
    const double grown_m = sqrt(4.0 * larger * larger + own_m2);
    CHECK_CLOSE(1.0e-3, hypot((double)before->sigma.x0_m, grown_m), now.sigma.x_m);
    CHECK_CLOSE(1.0e-3, hypot((double)before->sigma.z0_m, grown_m), now.sigma.z_m);
    TEST_ASSERT_FALSE(now.fresh);
    CHECK_CLOSE(1.0e-4, 2.0, now.age_s);
}

#if GOE_WITH_HAZARD
/* [GOE_REASON_MOVES, (R35)]
 * GIVEN traffic on the own course, oncoming or slower WHEN it has been warned of THEN no image takes the warning back, also not when
 * it begins to be followed. */
static void a_newly_followed_target_causes_a_warning(void) {
    static const double north_m_s[] = {-12.0, 8.0};
    for (size_t i = 0; i < sizeof north_m_s / sizeof north_m_s[0]; i++) {
        goe_settings_t of_scene = scene_settings(&scene);
        goe_intent_t intent;
        goe_hazard_t hazard;
        double least = 1.0;
        bool warned = false;
        bool followed = false;
        memset(&intent, 0, sizeof intent);
        intent.velocity_ned_m_s[0] = (float)(scene.speed_mps + north_m_s[i]);
        intent.margin_m = 25.0f;
        intent.clearance_m = 1000.0f;
        scene.x0_m = 0.0;
        scene.z0_m = 200.0;
        CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &of_scene, NULL));
        for (int k = 0; k < IMAGES; k++) {
            goe_image_t image;
            goe_estimate_t estimate;
            scene_image(&scene, 20 + STEP * k, &image, NULL);
            image.pose.position_ned_m[0] += (float)(north_m_s[i] * (20 + STEP * k) / FINE_HZ);
            scene_add_noise(&image, &any, NOISE_PX);
            (void)goe_update(&estimator, &image, &estimate);
            followed = followed || (estimate.valid & GOE_HAS_VELOCITY) != 0u;
            if (goe_hazard(&estimator, &intent, &hazard) == GOE_OK) {
                warned = warned || hazard.conflict_probability > 0.9f;
                least =
                    warned && (double)hazard.conflict_probability < least ? (double)hazard.conflict_probability : least;
            }
        }
        check_report("least violation after the first warning", least);
        TEST_ASSERT_TRUE(warned && (followed || i > 0)); /* the slower one is found later */
        TEST_ASSERT_TRUE(least > 0.5);
    }
}

/* [GOE_REASON_MOVES] GIVEN oncoming traffic WHEN it is followed THEN the time to it is that of both, not of the aircraft alone. */
static void the_hazard_counts_with_both_velocities(void) {
    const flight_t flight = fly(0, -12.0, 0.0);
    goe_intent_t intent;
    goe_hazard_t hazard;
    memset(&intent, 0, sizeof intent);
    intent.velocity_ned_m_s[0] =
        (float)scene.speed_mps - 12.0f; /* as configured: the rest of the approach is the obstacle's part */
    intent.margin_m = 20.0f;
    CHECK_STATUS(GOE_OK, goe_hazard(&estimator, &intent, &hazard));
    const double apart_m = (double)flight.estimate.z_m;
    const double closing = (double)intent.velocity_ned_m_s[0] - (double)flight.estimate.velocity_north_m_s;
    check_report("time to go, s", (double)hazard.tcpa_s);
    TEST_ASSERT_TRUE(hazard.tcpa_s > 0.0f);
    TEST_ASSERT_TRUE((double)hazard.tcpa_s < 1.2 * apart_m / closing &&
                     (double)hazard.tcpa_s > 0.5 * apart_m / closing);
}
#endif

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(augmented_states_are_solved_with_the_state);
    RUN_TEST(the_variance_includes_augmented_states);
    RUN_TEST(a_change_of_states_keeps_augmented_states);
    RUN_TEST(the_columns_are_derivatives);
    RUN_TEST(late_poses_end_a_motion_that_is_none);
    RUN_TEST(rate_and_velocity_are_those_of_the_flight);
    RUN_TEST(nothing_moves_that_does_not);
    RUN_TEST(late_poses_are_reported_and_taken_off);
    RUN_TEST(an_obstacle_that_moves_is_followed);
    RUN_TEST(early_poses_are_reported_as_early);
    RUN_TEST(an_old_place_moves_on);
    RUN_TEST(an_outline_that_moves_is_not_followed);
    RUN_TEST(a_newly_followed_target_starts_from_the_images);
    RUN_TEST(an_outgrown_range_is_a_motion);
    RUN_TEST(a_target_without_scale_is_not_followed);
    RUN_TEST(chance_motion_is_not_followed);
    RUN_TEST(a_latency_that_no_velocity_explains_is_estimated);
    RUN_TEST(a_followed_target_may_prove_to_be_late_poses);
    RUN_TEST(a_velocitys_variance_is_that_of_both_parts);
    RUN_TEST(values_outside_any_flight_are_forgotten);
    RUN_TEST(a_followed_target_continues_without_detections);
#if GOE_WITH_HAZARD
    RUN_TEST(a_newly_followed_target_causes_a_warning);
    RUN_TEST(the_hazard_counts_with_both_velocities);
#endif
    return UNITY_END();
}
