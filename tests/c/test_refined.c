/* The filter method through the public calls. SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "check.h"
#include "goe_guard.h"
#include "inverse.h"
#include "refined/goe_filter.h"
#include "scene.h"

#define IMAGES 44 /* of a flight towards an obstacle 100 m ahead, 2 m each */
#define BOX_BITS 0x3Fu
#define ELLIPSE_BITS (GOE_HAS_POSITION | GOE_HAS_WIDTH | GOE_HAS_HEIGHT | GOE_HAS_CENTER)
#define RESETS 0 /* in fault_counts */
#define TOP 2    /* feature, in the order of goe_image_t */
#define RAD_PER_DEG 0.017453292519943295

static scene_t scene;
static goe_settings_t settings;
static goe_estimator_t estimator;
static goe_estimate_t estimate;
static goe_image_t image;
static check_random_t any;

/* A truck whose two faces are visible, past which the aircraft weaves. */
void setUp(void) {
    scene_default(&scene);
    scene.width_m = 4.0;
    scene.length_m = 9.0;
    scene.height_m = 6.0;
    scene.alpha_deg = 20.0;
    scene.path = SCENE_WEAVE;
    scene.wobble_deg = 1.0;
    scene.top_nearest = true;
    settings = scene_settings(&scene);
    memset(&estimate, 0, sizeof estimate);
}
void tearDown(void) {}

static void start(void) {
    settings.camera = scene.camera;
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
}

static goe_status_t update(void) { return goe_update(&estimator, &image, &estimate); }

static goe_pixel_t *pixel(int i) {
    goe_pixel_t *const all[] = {&image.left,      &image.right,     &image.top,
                                &image.base_left, &image.base_near, &image.base_right};
    return all[i];
}

static goe_status_t fly(int from, int to) {
    goe_status_t status = GOE_OK;
    for (int k = from; k < to; k++) {
        scene_image(&scene, k, &image, NULL);
        status = update();
    }
    return status;
}

static goe_status_t fly_noisily(int from, int to, double sigma_px) {
    goe_status_t status = GOE_OK;
    for (int k = from; k < to; k++) {
        scene_image(&scene, k, &image, NULL);
        scene_add_noise(&image, &any, sigma_px);
        status = update();
    }
    return status;
}

/* ---------------------------------------------------------------------------------------------------------- the truth -- */

static double folded(double deg) { return deg > 90.0 ? deg - 180.0 : deg <= -90.0 ? deg + 180.0 : deg; }

/* The six quantities in the order of goe_covariance. A box whose side edge lies more across than along is the box whose side
 * is the other edge, and whose front is the face next to it: the estimate's orientation says which one is meant. */
static void give_truth(double truth[GOE_QUANTITIES]) {
    const double s = sin(scene.alpha_deg * RAD_PER_DEG);
    const double c = cos(scene.alpha_deg * RAD_PER_DEG);
    const double half_w = 0.5 * scene.width_m;
    const double half_l = 0.5 * scene.length_m;
    const double all[] = {scene.x0_m, scene.z0_m, scene.alpha_deg, scene.width_m, scene.length_m, scene.height_m};
    memcpy(truth, all, sizeof all);
    if (scene.shape == SCENE_BOX && fabs(folded((double)estimate.orientation_deg - scene.alpha_deg)) > 45.0) {
        const double side = scene.alpha_deg > 0.0 ? 1.0 : -1.0; /* of the nearer long face */
        truth[GOE_X0] += half_l * s + side * half_w * c;
        truth[GOE_Z0] += half_l * c - side * half_w * s;
        truth[GOE_ORIENTATION] -= side * 90.0;
        truth[GOE_WIDTH] = scene.length_m;
        truth[GOE_LENGTH] = scene.width_m;
    }
}

static void set_answer(float value[GOE_QUANTITIES], float sigma[GOE_QUANTITIES]) {
    const goe_estimate_t *e = &estimate;
    const float values[] = {e->x0_m, e->z0_m, e->orientation_deg, e->width_m, e->length_m, e->height_m};
    const float sigmas[] = {e->sigma.x0_m,    e->sigma.z0_m,     e->sigma.orientation_deg,
                            e->sigma.width_m, e->sigma.length_m, e->sigma.height_m};
    memcpy(value, values, sizeof values);
    memcpy(sigma, sigmas, sizeof sigmas);
}

static bool is_valid(int quantity) {
    static const unsigned bits[] = {GOE_HAS_POSITION, GOE_HAS_POSITION, GOE_HAS_ORIENTATION,
                                    GOE_HAS_WIDTH,    GOE_HAS_LENGTH,   GOE_HAS_HEIGHT};
    return (estimate.valid & bits[quantity]) != 0u;
}

/* Every valid quantity within `sigmas` of its own, and within `share` of itself (degrees: of 90). */
static void check_truth(double sigmas, double share) {
    double truth[GOE_QUANTITIES];
    float value[GOE_QUANTITIES];
    float sigma[GOE_QUANTITIES];
    give_truth(truth);
    set_answer(value, sigma);
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        if (is_valid(i)) {
            const double scale = i == GOE_X0 ? truth[GOE_Z0] : i == GOE_ORIENTATION ? 90.0 : truth[i];
            CHECK_CLOSE(sigmas * (double)sigma[i], truth[i], value[i]);
            CHECK_CLOSE(share * scale, truth[i], value[i]);
        }
    }
}

/* ---------------------------------------------------------------------------------------------------- exact recovery -- */

static void check_center(void) {
    scene_truth_t truth;
    double quantity[GOE_QUANTITIES];
    give_truth(quantity);
    scene_image(&scene, IMAGES - 1, &image, &truth);
    CHECK_CLOSE(0.01, truth.center_north_m, estimate.center_north_m);
    CHECK_CLOSE(0.01, truth.center_east_m, estimate.center_east_m);
    CHECK_CLOSE(0.01, quantity[GOE_X0] - truth.dx_m, estimate.x_m);
    CHECK_CLOSE(0.01, quantity[GOE_Z0] - truth.dz_m, estimate.z_m);
}

/* [A1, A8, GOE_HAS_ORIENTATION, goe_estimate_t.center_north_m, goe_estimate_t.height_m, goe_estimate_t.length_m,
 * goe_estimate_t.orientation_deg, goe_estimate_t.width_m, goe_estimate_t.x0_m, goe_image_t.top, goe_refined.c]
 * GIVEN boxes of any orientation on either side WHEN nothing but rounding is wrong THEN all six quantities and the center
 * come out to 1e-4, whichever edge is called the side. */
static void boxes_come_out_as_they_are(void) {
    static const double aside_m[] = {-25.0, -12.0, 15.0};
    for (int path = 0; path < 3; path++) {
        for (int i = 0; i < 3; i++) {
            for (int alpha_deg = -64; alpha_deg <= 64; alpha_deg += 8) {
                setUp();
                scene.path = (scene_path_t)path;
                scene.x0_m = aside_m[i];
                scene.alpha_deg = alpha_deg;
                scene_clear_noise(&settings);
                start();
                CHECK_STATUS(GOE_OK, fly(0, IMAGES));
                TEST_ASSERT_EQUAL_INT(GOE_MODEL_BOX, estimate.model);
                TEST_ASSERT_EQUAL_HEX32(BOX_BITS, estimate.valid);
                TEST_ASSERT_FALSE(estimate.suspect);
                check_truth(3.0, 1.0e-4);
                check_center();
            }
        }
    }
}

/* [A1, A8, goe_estimate_t.width_m, goe_image_t.top, model] Whether it is configured that they are round, or not. */
static void cylinders_come_out_as_they_are(void) {
    static const double aside_m[] = {-25.0, -12.0, 15.0};
    static const double height_m[] = {4.0, 30.0}; /* below and above the camera */
    for (int path = 0; path < 6; path++) {
        const bool round = path >= 3;
        for (int i = 0; i < 6; i++) {
            setUp();
            settings.model = round ? GOE_MODEL_DISC : GOE_MODEL_AUTO;
            scene_make_cylinder(&scene);
            scene.path = (scene_path_t)(path % 3);
            scene.x0_m = aside_m[i % 3];
            scene.height_m = height_m[i / 3];
            scene.width_m = 1.5 + 3.0 * i; /* the first guess, of 6 m, is never right */
            scene_clear_noise(&settings);
            start();
            CHECK_STATUS(GOE_OK, fly(0, IMAGES));
            TEST_ASSERT_EQUAL_INT(round ? GOE_MODEL_DISC : GOE_MODEL_PRISM, estimate.model);
            TEST_ASSERT_EQUAL_HEX32(ELLIPSE_BITS, estimate.valid);
            TEST_ASSERT_FALSE(estimate.suspect);
            check_truth(3.0, round ? 1.0e-4 : 3.0e-3); /* or its sides may be those of another shape */
            check_center();
        }
    }
}

/* [goe_quantities.c] GIVEN the usual noise settings, level ground and drifts off WHEN images come THEN no sigma of a started model ever grows. */
static void sigmas_shrink_with_every_image(void) {
    float before[GOE_QUANTITIES];
    float value[GOE_QUANTITIES];
    float sigma[GOE_QUANTITIES];
    float first = 0.0f;
    scene_level_ground(&settings);
    settings.navigation.velocity_bias_sd_m_s = 0.0f;
    settings.navigation.position_walk_sd_m = 0.0f;
    start();
    fly(0, 6);
    TEST_ASSERT_EQUAL_INT(GOE_MODEL_BOX, estimate.model);
    set_answer(value, before);
    first = before[GOE_Z0];
    for (int k = 6; k < IMAGES; k++) {
        fly(k, k + 1);
        set_answer(value, sigma);
        for (int i = 0; i < GOE_QUANTITIES; i++) {
            if (before[i] > 0.0f) {
                TEST_ASSERT_TRUE(sigma[i] > 0.0f && sigma[i] <= 1.02f * before[i]);
            }
        }
        memcpy(before, sigma, sizeof before);
    }
    TEST_ASSERT_TRUE(sigma[GOE_Z0] < 0.1f * first);
}

/* Information of the next image on the range, with the range known to `share` of itself. */
static double information_gained(const goe_estimator_t *before, double share) {
    estimator = *before;
    goe_triangle_t *root = &estimator.filter.root;
    inverse_t v;
    inverse_of(root, v);
    for (size_t j = GOE_INVERSE_RANGE; j < GOE_STATES; j++) {
        v[GOE_INVERSE_RANGE][j] = 0.0;
    }
    v[GOE_INVERSE_RANGE][GOE_INVERSE_RANGE] = share * (double)estimator.filter.state[GOE_INVERSE_RANGE];
    inverse_put(root, v);
    const goe_triangle_t then = *root;
    double information = 0.0;
    (void)update();
    TEST_ASSERT_EQUAL_UINT8(before->filter.phase, estimator.filter.phase);
    for (size_t i = 0; i <= GOE_INVERSE_RANGE; i++) {
        const double is = (double)root->element[goe_srif_row(i) + GOE_INVERSE_RANGE];
        const double was = (double)then.element[goe_srif_row(i) + GOE_INVERSE_RANGE];
        information += is * is - was * was;
    }
    return information;
}

/* [goe_refined.c]
 * GIVEN a range that is hardly known WHEN an image comes after a good part of the way THEN it gives less information than the same image
 * where the range is known: the linearization point may be wrong by then. */
static void an_uncertain_range_makes_an_image_count_less(void) {
    scene_make_cylinder(&scene);
    start();
    settings.filter.gate_sigma = 100.0f;
    settings.filter.huber_sigma = 100.0f;
    settings.navigation.position_walk_sd_m = 0.0f; /* no time takes information away */
    start();
    (void)fly(0, 30);
    const goe_estimator_t before = estimator;
    scene_image(&scene, 30, &image, NULL);
    const double known = information_gained(&before, 1.0e-3);
    const double less = information_gained(&before, 0.3);
    check_report("information gained at a range known to 30 %, over that at a known one", less / known);
    TEST_ASSERT_TRUE(known > 0.0 && less > 0.0);
    TEST_ASSERT_TRUE(less < 0.9 * known);
}

/* GIVEN a flight WHEN it is mirrored THEN X0 and orientation change sign and nothing else changes. */
static void left_and_right_are_equal(void) {
    for (int shape = 0; shape < 2; shape++) {
        setUp();
        if (shape > 0) {
            scene_make_cylinder(&scene);
        }
        scene.camera.cx_px = 0.0f;
        scene.camera.mount_yaw_deg = 5.0f;
        start();
        fly(0, IMAGES);
        const goe_estimate_t plain = estimate;
        scene = scene_mirrored(&scene);
        start();
        fly(0, IMAGES);
        TEST_ASSERT_EQUAL_HEX32(plain.valid, estimate.valid);
        TEST_ASSERT_EQUAL_INT(plain.model, estimate.model);
        CHECK_CLOSE(2.0e-3, -plain.x0_m, estimate.x0_m);
        CHECK_CLOSE(2.0e-3, plain.z0_m, estimate.z0_m);
        CHECK_CLOSE(2.0e-3, -plain.orientation_deg, estimate.orientation_deg);
        CHECK_CLOSE(1.0e-3, plain.width_m, estimate.width_m);
        CHECK_CLOSE(1.0e-3, plain.length_m, estimate.length_m);
        CHECK_CLOSE(1.0e-3, plain.height_m, estimate.height_m);
        CHECK_CLOSE(1.0e-3 * plain.sigma.z0_m, plain.sigma.z0_m, estimate.sigma.z0_m);
        CHECK_CLOSE(1.0e-3 * plain.sigma.width_m, plain.sigma.width_m, estimate.sigma.width_m);
    }
}

/* GIVEN a camera that is mounted half a degree off in pitch and yaw, within the settings, WHEN a box on flat ground is passed
 * THEN range, height and size are still right, because the images show the error; a filter configured without this error
 * answers worse, and shows it. */
static void a_constant_attitude_error_is_taken_out(void) {
    float nis_ratio[2];
    double error_m[2];
    for (int known = 0; known < 2; known++) {
        setUp();
        scene.camera.mount_pitch_deg = 0.5f;
        scene.camera.mount_yaw_deg = -0.4f;
        scene_clear_noise(&settings);
        settings.detector.point_noise_px = 0.1f;
        settings.navigation.attitude_bias_sd_deg = known > 0 ? 0.5f : 1.0e-3f;
        CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
        fly(0, IMAGES);
        nis_ratio[known] = estimate.nis_ratio;
        error_m[known] = fabs((double)estimate.z0_m - scene.z0_m);
        if (known > 0) {
            TEST_ASSERT_EQUAL_HEX32(BOX_BITS, estimate.valid);
            check_truth(3.0, 0.01);
        }
    }
    TEST_ASSERT_TRUE(nis_ratio[1] < 1.0f && nis_ratio[0] > 2.0f);
    TEST_ASSERT_TRUE(error_m[0] > 3.0 * error_m[1]);
}

/* ----------------------------------------------------------------------------------------------------- honest sigmas -- */

/* Solves lower * x = right in place; the squared norm of x. */
static double whitened_square(int n, double c[GOE_QUANTITIES][GOE_QUANTITIES], double right[GOE_QUANTITIES]) {
    double sum = 0.0;
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < i; j++) {
            for (int k = 0; k < j; k++) {
                c[i][j] -= c[i][k] * c[j][k];
            }
            c[i][j] /= c[j][j];
            c[i][i] -= c[i][j] * c[i][j];
            right[i] -= c[i][j] * right[j];
        }
        TEST_ASSERT_TRUE_MESSAGE(c[i][i] > 0.0, "covariance is not positive");
        c[i][i] = sqrt(c[i][i]);
        right[i] /= c[i][i];
        sum += right[i] * right[i];
    }
    return sum;
}

/* Checks goe.h's rules of the covariance, and returns the normalized square of the estimate's error. */
static double check_covariance(int *freedoms) {
    float covariance[GOE_QUANTITIES][GOE_QUANTITIES];
    double c[GOE_QUANTITIES][GOE_QUANTITIES];
    double error[GOE_QUANTITIES];
    double truth[GOE_QUANTITIES];
    float value[GOE_QUANTITIES];
    float sigma[GOE_QUANTITIES];
    int n = 0;
    int kept[GOE_QUANTITIES];
    CHECK_STATUS(GOE_OK, goe_covariance(&estimator, covariance));
    give_truth(truth);
    set_answer(value, sigma);
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        for (int j = 0; j < GOE_QUANTITIES; j++) {
            CHECK_SAME(covariance[i][j], covariance[j][i]);
            if (!is_valid(i) || !is_valid(j)) {
                CHECK_SAME(0.0f, covariance[i][j]);
            }
        }
        if (is_valid(i)) {
            const double square = (double)sigma[i] * (double)sigma[i];
            if (estimate.fresh || i > GOE_Z0) {
                CHECK_CLOSE(1.0e-4 * square, square, covariance[i][i]);
            } else { /* with what its age adds */
                TEST_ASSERT_TRUE((double)covariance[i][i] >= square * (1.0 - 1.0e-4));
                CHECK_CLOSE(0.01, square, covariance[i][i]);
            }
            kept[n++] = i;
        }
    }
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            c[i][j] = (double)covariance[kept[i]][kept[j]];
        }
        error[i] = (double)value[kept[i]] - truth[kept[i]];
    }
    *freedoms = n;
    return whitened_square(n, c, error);
}

/* [GOE_X0, goe_covariance, goe_covariance.c, goe_shape.c, (R20)] */
static void the_covariance_is_positive_and_contains_the_sigmas(void) {
    int freedoms;
    any = check_random_start("covariance");
    for (int shape = 0; shape < 2; shape++) {
        setUp();
        if (shape > 0) {
            scene_make_cylinder(&scene);
        }
        start();
        for (int k = 0; k < IMAGES; k++) {
            fly_noisily(k, k + 1, 0.5);
            if (estimate.valid & GOE_HAS_POSITION) {
                (void)check_covariance(&freedoms);
            }
        }
        TEST_ASSERT_EQUAL_INT(shape > 0 ? 4 : 6, freedoms);
    }
}

typedef struct {
    int runs, valid[GOE_QUANTITIES], within[GOE_QUANTITIES], suspects;
    double nees, freedoms, nis_ratio;
} honesty_t;

static void fly_once(honesty_t *honesty, double sigma_px) {
    double truth[GOE_QUANTITIES];
    float value[GOE_QUANTITIES];
    float sigma[GOE_QUANTITIES];
    int freedoms;
    start();
    fly_noisily(0, IMAGES, sigma_px);
    give_truth(truth);
    set_answer(value, sigma);
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        honesty->valid[i] += is_valid(i) ? 1 : 0;
        honesty->within[i] += is_valid(i) && fabs((double)value[i] - truth[i]) < 2.0 * (double)sigma[i] ? 1 : 0;
    }
    honesty->nees += check_covariance(&freedoms);
    honesty->freedoms += freedoms;
    honesty->nis_ratio += (double)estimate.nis_ratio;
    honesty->suspects += estimate.suspect ? 1 : 0;
    honesty->runs++;
}

/* [A1, A2, goe_covariance, goe_estimate_t.sigma, goe_estimate_t.suspect, goe_quantities.c, (R22)]
 * GIVEN 80 boxes, and 80 cylinders that are configured as discs, Gaussian noise of 0.5 px and nothing else wrong, and configured so
 * THEN the truth lies within 2 sigma in 88 % of the flights or more for each quantity, the error squared by the covariance is that of its
 * number of quantities (of cylinders 0.6 of it: a little too careful), the innovations are as configured, and none is suspected. */
static void sigmas_cover_the_error(void) {
    any = check_random_start("honesty");
    for (int shape = 0; shape < 2; shape++) {
        honesty_t honesty;
        memset(&honesty, 0, sizeof honesty);
        for (int n = 0; n < 80; n++) {
            setUp();
            if (shape > 0) {
                scene_make_cylinder(&scene);
                scene.width_m = check_random_between(&any, 1.0, 12.0);
            } else {
                scene.width_m = check_random_between(&any, 2.5, 10.0);
                scene.length_m = check_random_between(&any, 2.5, 14.0);
                scene.alpha_deg = check_random_between(&any, -70.0, 70.0);
            }
            scene.x0_m = check_random_between(&any, -30.0, 30.0);
            scene.path = (scene_path_t)(n % 3);
            scene_clear_noise(&settings);
            settings.detector.point_noise_px = 0.5f;
            settings.model = shape > 0 ? GOE_MODEL_DISC : GOE_MODEL_AUTO; /* else its sigmas are those of any shape */
            fly_once(&honesty, 0.5);
        }
        check_report(shape > 0 ? "cylinders: NEES over freedoms" : "boxes: NEES over freedoms",
                     honesty.nees / honesty.freedoms);
        check_report("nis_ratio", honesty.nis_ratio / honesty.runs);
        for (int i = 0; i < GOE_QUANTITIES; i++) {
            if (honesty.valid[i] > 0) {
                check_report("share within 2 sigma", (double)honesty.within[i] / honesty.valid[i]);
                TEST_ASSERT_TRUE(honesty.within[i] >= 0.88 * honesty.valid[i]);
            }
        }
        TEST_ASSERT_TRUE(honesty.freedoms >= (shape > 0 ? 3.9 : 5.5) * honesty.runs);
        TEST_ASSERT_TRUE(honesty.nees < 1.35 * honesty.freedoms && honesty.nees > 0.5 * honesty.freedoms);
        TEST_ASSERT_TRUE(honesty.nis_ratio < 1.1 * honesty.runs && honesty.nis_ratio > 0.6 * honesty.runs);
        TEST_ASSERT_EQUAL_INT(0, honesty.suspects);
    }
}

/* --------------------------------------------------------------------------------------------------- the filter's reset -- */

static const float jump[3] = {37.25f, -12.5f, 3.0f};

static void jump_by_then(bool known) {
    image.pose.reset_count++;
    image.pose.reset_delta_known = known;
    for (int i = 0; i < 3; i++) {
        image.pose.position_ned_m[i] += jump[i];
        image.pose.reset_delta_ned_m[i] = known ? jump[i] : 0.0f;
    }
}

/* [goe_pose_t.reset_delta_known]
 * GIVEN a straight flight of which all positions are exact floats WHEN the autopilot's filter jumps by a known delta THEN the
 * answer is the same in all bits but for the center, which moves along. */
static void a_known_jump_is_compensated(void) {
    scene.path = SCENE_STRAIGHT;
    start();
    fly(0, 30);
    const goe_estimate_t plain = estimate;
    start();
    for (int k = 0; k < 30; k++) {
        scene_image(&scene, k, &image, NULL);
        if (k >= 12) {
            jump_by_then(true);
        }
        update();
    }
    CHECK_SAME(plain.x0_m, estimate.x0_m);
    CHECK_SAME(plain.z0_m, estimate.z0_m);
    CHECK_SAME(plain.z_m, estimate.z_m);
    CHECK_SAME(plain.width_m, estimate.width_m);
    CHECK_SAME(plain.length_m, estimate.length_m);
    CHECK_SAME(plain.height_m, estimate.height_m);
    CHECK_SAME(plain.orientation_deg, estimate.orientation_deg);
    CHECK_SAME(plain.sigma.z0_m, estimate.sigma.z0_m);
    CHECK_SAME(plain.nis_ratio, estimate.nis_ratio);
    TEST_ASSERT_EQUAL_INT(plain.images_used, estimate.images_used);
    CHECK_CLOSE(1.0e-4, plain.center_north_m + jump[0], estimate.center_north_m);
    CHECK_CLOSE(1.0e-4, plain.center_east_m + jump[1], estimate.center_east_m);
    TEST_ASSERT_EQUAL_UINT32(0u, estimator.fault_counts[RESETS]);
}

/* [goe_pose_t.reset_delta_known]
 * GIVEN an answer that is old WHEN the filter jumps by a known delta, and nothing is detected THEN the center moves along. */
static void a_jump_moves_an_old_center_along(void) {
    start();
    fly(0, 25);
    const goe_estimate_t before = estimate;
    TEST_ASSERT_TRUE(before.valid & GOE_HAS_CENTER);
    scene_image(&scene, 25, &image, NULL);
    jump_by_then(true);
    for (int i = 0; i < 6; i++) {
        pixel(i)->visible = false;
    }
    CHECK_STATUS(GOE_NO_DETECTION, update());
    CHECK_CLOSE(1.0e-4, before.center_north_m + jump[0], estimate.center_north_m);
    CHECK_CLOSE(1.0e-4, before.center_east_m + jump[1], estimate.center_east_m);
}

/* [A22, goe_pose_t.reset_delta_known] GIVEN a jump of unknown size THEN the track is that of an estimator which starts with this image. */
static void an_unknown_jump_starts_again(void) {
    goe_estimator_t fresh;
    goe_estimate_t from_fresh;
    start();
    fly(0, 20);
    start();
    fresh = estimator;
    fly(0, 20);
    for (int k = 20; k < IMAGES; k++) {
        scene_image(&scene, k, &image, NULL);
        jump_by_then(false);
        image.pose.reset_count = 1;
        const goe_status_t status = update();
        CHECK_STATUS(goe_update(&fresh, &image, &from_fresh), status);
        TEST_ASSERT_EQUAL_MEMORY(&from_fresh, &estimate, sizeof estimate);
        TEST_ASSERT_TRUE(estimate.images_used <= k - 19);
    }
    TEST_ASSERT_EQUAL_UINT32(1u, estimator.fault_counts[RESETS]);
}

/* [A7] */
static void a_reset_forgets_the_track(void) {
    start();
    fly(0, 20);
    CHECK_STATUS(GOE_OK, goe_reset(&estimator));
    TEST_ASSERT_EQUAL_INT(0, estimator.filter.phase);
    float covariance[GOE_QUANTITIES][GOE_QUANTITIES];
    CHECK_STATUS(GOE_CONVERGING, goe_covariance(&estimator, covariance));
    fly(0, 20);
    const goe_estimate_t again = estimate;
    start();
    fly(0, 20);
    TEST_ASSERT_EQUAL_MEMORY(&estimate, &again, sizeof again);
}

/* ------------------------------------------------------------------------------------------------------------ outliers -- */

/* [goe_refined.c, (R14)] GIVEN single wild points WHEN they come now and then THEN the answer hardly moves. */
static void single_outliers_are_left_out(void) {
    any = check_random_start("outliers");
    scene_clear_noise(&settings);
    settings.detector.point_noise_px = 0.5f;
    start();
    for (int k = 0; k < IMAGES; k++) {
        scene_image(&scene, k, &image, NULL);
        scene_add_noise(&image, &any, 0.5);
        if (k > 5 && k % 3 == 0) {
            pixel(k / 3 % 6)->u_px += 25.0f;
            pixel(k / 3 % 6)->v_px -= 25.0f;
        }
        update();
    }
    TEST_ASSERT_EQUAL_HEX32(BOX_BITS, estimate.valid);
    check_truth(4.0, 0.02);
}

/* [T1] GIVEN a feature that is wrong from the start, and later is right WHEN the flight ends THEN the answer has recovered,
 * whichever feature it was. */
static void a_track_that_began_with_an_outlier_recovers(void) {
    any = check_random_start("capture");
    for (int shape = 0; shape < 2; shape++) {
        for (int feature = 0; feature < (shape > 0 ? 3 : 6); feature++) {
            for (int sign = -1; sign <= 1; sign += 2) {
                setUp();
                if (shape > 0) {
                    scene_make_cylinder(&scene);
                }
                scene_clear_noise(&settings);
                settings.detector.point_noise_px = 0.5f;
                start();
                for (int k = 0; k < IMAGES; k++) {
                    scene_image(&scene, k, &image, NULL);
                    scene_add_noise(&image, &any, 0.5);
                    if (k < 8) {
                        pixel(feature)->u_px += (float)sign * (feature == TOP ? 0.0f : 12.0f);
                        pixel(feature)->v_px += (float)sign * 15.0f;
                    }
                    update();
                }
                TEST_ASSERT_EQUAL_HEX32(shape > 0 ? ELLIPSE_BITS : BOX_BITS, estimate.valid);
                check_truth(5.0, 0.05);
            }
        }
    }
}

/* [T2] GIVEN a detector that finds another top from an image on, 3 m higher WHEN that was refused for a while THEN the height
 * follows, and neither the track nor the range starts again. */
static void another_top_costs_the_height_alone(void) {
    any = check_random_start("another top");
    start();
    fly_noisily(0, 20, 0.5);
    float sigma = estimate.sigma.z0_m;
    scene.height_m += 3.0;
    for (int k = 20; k < 40; k++) {
        CHECK_STATUS(GOE_OK, fly_noisily(k, k + 1, 0.5));
        TEST_ASSERT_EQUAL_INT(GOE_MODEL_BOX, estimate.model);
        TEST_ASSERT_TRUE(estimate.sigma.z0_m < 1.02f * sigma);
        sigma = estimate.sigma.z0_m;
    }
    TEST_ASSERT_TRUE((estimate.valid & GOE_HAS_HEIGHT) != 0u);
    CHECK_CLOSE(0.3, scene.height_m, estimate.height_m);
}

/* [goe_refined.c]
 * GIVEN an attitude whose error drifts WHEN nothing is detected for a while THEN each of the biases is less certain by the variance of a
 * random walk over that time, and the gate counts with it before it is in the filter. */
static void the_attitude_s_error_drifts_with_time(void) {
    const double drift_rad = 0.2 * RAD_PER_DEG; /* per root second */
    settings.navigation.attitude_walk_sd_deg = 0.2f;
    start();
    fly(0, 20);
    goe_filter_t before = estimator.filter;
    for (int k = 20; k < 36; k++) {
        scene_image(&scene, k, &image, NULL);
        for (int i = 0; i < 6; i++) {
            pixel(i)->visible = false;
        }
        CHECK_STATUS(GOE_NO_DETECTION, update());
    }
    const double gained = drift_rad * drift_rad * 16.0 / scene.image_rate_hz;
    goe_filter_t after = estimator.filter;
    CHECK_CLOSE(1.0e-3 * gained, gained, goe_filter_due_drift2(&after, &settings.navigation));
    goe_filter_age(&after, &settings.navigation, 0.0f);
    for (int i = GOE_BIAS_X; i <= GOE_BIAS_Z; i++) {
        const double was = (double)goe_filter_variance(&before, (goe_state_index_t)i);
        const double is = (double)goe_filter_variance(&after, (goe_state_index_t)i);
        CHECK_CLOSE(0.01 * (was + gained), was + gained, is);
    }
}

/* [goe_estimate_t.height_m]
 * GIVEN a cylinder, of which nothing shows how high the camera is above the ground THEN the configured sigma of that is in the
 * height's, and only there. */
static void the_error_of_the_altitude_is_in_the_height(void) {
    float sigma[2][2];
    for (int i = 0; i < 2; i++) {
        setUp();
        scene_make_cylinder(&scene);
        scene_clear_noise(&settings);
        settings.navigation.height_bias_sd_m = i > 0 ? 2.0f : 0.01f;
        start();
        fly(0, IMAGES);
        TEST_ASSERT_EQUAL_HEX32(ELLIPSE_BITS, estimate.valid);
        sigma[i][0] = estimate.sigma.height_m;
        sigma[i][1] = estimate.sigma.z0_m;
    }
    CHECK_CLOSE(0.02, sqrt(4.0 + (double)sigma[0][0] * (double)sigma[0][0]), sigma[1][0]);
    CHECK_CLOSE(1.0e-3 * (double)sigma[0][1], sigma[0][1], sigma[1][1]);
}

/* [T1] GIVEN eight images of another obstacle, 15 m aside and half as far THEN the track ends up at the visible one. */
static void a_track_that_began_at_another_obstacle_recovers(void) {
    scene_clear_noise(&settings);
    settings.detector.point_noise_px = 0.5f;
    start();
    const scene_t right = scene;
    scene.x0_m += 15.0;
    scene.z0_m = 70.0;
    fly(0, 8);
    scene = right;
    fly(8, IMAGES);
    TEST_ASSERT_EQUAL_HEX32(BOX_BITS, estimate.valid);
    check_truth(5.0, 0.02);
}

/* [(R13)] GIVEN a cylinder much narrower or wider than the first guess, near, and pixels that are nearly exact THEN the
 * linearization error at a wrong range neither captures the filter nor makes it sure of a wrong one: round, or of a depth that is
 * estimated once the line of sight has turned. */
static void a_first_guess_that_is_far_off_comes_right(void) {
    static const double width_m[] = {1.0, 3.0, 12.0, 25.0};
    static const double range_m[] = {60.0, 100.0};
    for (int i = 0; i < 16; i++) {
        const bool round = i >= 8;
        int points = 0;
        setUp();
        scene.path = SCENE_STRAIGHT;
        scene.wobble_deg = 0.0;
        scene_make_cylinder(&scene);
        scene.x0_m = -25.0;
        scene.width_m = width_m[i % 4];
        scene.z0_m = range_m[i / 4 % 2];
        scene_clear_noise(&settings);
        settings.model = round ? GOE_MODEL_DISC : GOE_MODEL_AUTO;
        start();
        for (int k = 0; k < 24; k++) {
            fly(k, k + 1);
            TEST_ASSERT_TRUE(estimate.images_used >= points); /* no restart */
            points = estimate.images_used;
            if (estimate.fresh) {
                CHECK_CLOSE(2.5 * (double)estimate.sigma.z0_m, scene.z0_m, estimate.z0_m);
            }
        }
        TEST_ASSERT_EQUAL_INT(round ? GOE_MODEL_DISC : GOE_MODEL_PRISM, estimate.model);
        TEST_ASSERT_FALSE(estimate.suspect);
        CHECK_CLOSE(0.1, scene.z0_m, estimate.z0_m);
    }
}

/* [(R12)]
 * GIVEN images without a detection THEN the process noise of the bias and the bearing is due, and changes nothing until rows come. */
static void time_adds_to_the_bias_and_the_bearing(void) {
    const double dt_s = 0.125;
    settings.navigation.attitude_walk_sd_deg = 0.5f;
    settings.navigation.position_walk_sd_m = 0.3f;
    settings.navigation.terrain_slope_sd = 0.0f;
    start();
    fly(0, 25);
    goe_filter_t *filter = &estimator.filter;
    const goe_filter_t before = *filter;
    const goe_navigation_t *navigation = &settings.navigation;
    CHECK_SAME(0.0f, goe_filter_due_drift2(filter, navigation));
    CHECK_SAME(0.0f, goe_filter_due_walk2(filter, navigation));
    for (int k = 25; k < 29; k++) {
        scene_image(&scene, k, &image, NULL);
        for (int i = 0; i < 6; i++) {
            pixel(i)->visible = false;
        }
        CHECK_STATUS(GOE_NO_DETECTION, update());
    }
    const double drift2 = 4.0 * dt_s * 0.25 * RAD_PER_DEG * RAD_PER_DEG;
    const double q = (double)filter->state[GOE_INVERSE_RANGE];
    const double walk2 = 4.0 * dt_s * 0.09 * q * q;
    CHECK_CLOSE(1.0e-4 * drift2, drift2, goe_filter_due_drift2(filter, navigation));
    CHECK_CLOSE(1.0e-4 * walk2, walk2, goe_filter_due_walk2(filter, navigation));
    for (size_t i = 0; i < GOE_STATES; i++) {
        CHECK_SAME(goe_filter_variance(&before, (goe_state_index_t)i),
                   goe_filter_variance(filter, (goe_state_index_t)i));
    }
    goe_filter_age(filter, navigation, (float)dt_s);
    for (size_t i = GOE_BIAS_X; i <= GOE_BIAS_Z; i++) {
        const double was = (double)goe_filter_variance(&before, (goe_state_index_t)i);
        CHECK_CLOSE(0.01 * drift2, was + drift2, goe_filter_variance(filter, (goe_state_index_t)i));
    }
    const double was = (double)goe_filter_variance(&before, GOE_BEARING);
    TEST_ASSERT_TRUE((double)goe_filter_variance(filter, GOE_BEARING) > was + 0.4 * walk2);
}

/* Flies with a constant error of the reported velocity, and reports the covariance's quantities. */
static void fly_with_error(double north_m_s, double east_m_s, float value[GOE_QUANTITIES]) {
    float sigma[GOE_QUANTITIES];
    start();
    for (int k = 0; k < 25; k++) {
        scene_image(&scene, k, &image, NULL);
        image.pose.position_ned_m[0] += (float)(north_m_s * 0.125 * k);
        image.pose.position_ned_m[1] += (float)(east_m_s * 0.125 * k);
        (void)update();
    }
    set_answer(value, sigma);
}

/* [(R21)] GIVEN the same images WHEN the own velocity and position are given as less well known THEN the covariance grows by the effect that
 * an error of the reported velocity has on the estimate, by two flights with it; and by the walk. */
static void unobservable_errors_of_own_motion_are_added(void) {
    float before[GOE_QUANTITIES][GOE_QUANTITIES];
    float after[GOE_QUANTITIES][GOE_QUANTITIES];
    const double s = 24.0 * 0.125;
    const double error_m_s = 0.02;
    double effect2[GOE_QUANTITIES] = {0.0};
    scene.path = SCENE_STRAIGHT;
    scene.wobble_deg = 0.0;
    settings.navigation.velocity_bias_sd_m_s = 0.0f;
    settings.navigation.position_walk_sd_m = 0.0f;
    for (int axis = 0; axis < 2; axis++) {
        float plus[GOE_QUANTITIES];
        float minus[GOE_QUANTITIES];
        fly_with_error(axis == 0 ? error_m_s : 0.0, axis == 0 ? 0.0 : error_m_s, plus);
        fly_with_error(axis == 0 ? -error_m_s : 0.0, axis == 0 ? 0.0 : -error_m_s, minus);
        for (int i = 0; i < GOE_QUANTITIES; i++) {
            const double slope = ((double)plus[i] - (double)minus[i]) / (2.0 * error_m_s);
            effect2[i] += slope * slope;
        }
    }
    start();
    fly(0, 25);
    CHECK_STATUS(GOE_OK, goe_covariance(&estimator, before));
    estimator.settings.navigation.position_walk_sd_m = 2.0f;
    goe_guard_seal(&estimator);
    CHECK_STATUS(GOE_OK, goe_covariance(&estimator, after));
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        const double walked = i <= GOE_Z0 ? 4.0 * s : 0.0;
        CHECK_CLOSE(1.0e-3 * (walked + 1.0e-3), walked, after[i][i] - before[i][i]);
    }
    estimator.settings.navigation.position_walk_sd_m = 0.0f;
    estimator.settings.navigation.velocity_bias_sd_m_s = 1.0f;
    goe_guard_seal(&estimator);
    CHECK_STATUS(GOE_OK, goe_covariance(&estimator, after));
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        CHECK_CLOSE(0.12 * effect2[i], effect2[i], after[i][i] - before[i][i]);
    }
}

/* -------------------------------------------------------------------------------------------------- not a static obstacle -- */

/* The obstacle moves: speeds in T, m/s. Returns the number of images in which it was suspected. */
static int fly_past_a_mover(double vx, double vz, double swing_m) {
    int suspicious = 0;
    const double x0_m = scene.x0_m;
    const double z0_m = scene.z0_m;
    start();
    for (int k = 0; k < IMAGES; k++) {
        const double t = k / scene.image_rate_hz;
        scene.x0_m = x0_m + vx * t + swing_m * sin(2.0 * t);
        scene.z0_m = z0_m + vz * t;
        scene_image(&scene, k, &image, NULL);
        scene_add_noise(&image, &any, 0.5);
        update();
        suspicious += estimate.suspect ? 1 : 0;
    }
    return suspicious;
}

/* [GOE_REASON_MOVES, goe_estimate_t.suspect]
 * GIVEN a truck that crosses, comes, or swings from side to side THEN it is suspected; standing it never is. One that comes
 * at constant speed looks like a standing one of another size but for its height on the ground, which the attitude's error
 * may explain for a while. */
static void a_moving_obstacle_is_suspected(void) {
    static const double motion[][3] = {{4.0, 0.0, 0.0}, {0.0, -8.0, 0.0}, {0.0, 0.0, 4.0}};
    any = check_random_start("movers");
    for (int i = 0; i < 3; i++) {
        setUp();
        scene.x0_m = -20.0;
        const int suspicious = fly_past_a_mover(motion[i][0], motion[i][1], motion[i][2]);
        check_report("images in which a mover is suspected", suspicious);
        TEST_ASSERT_TRUE(suspicious > (i == 1 ? 4 : IMAGES / 2));
    }
    setUp();
    scene.x0_m = -20.0;
    TEST_ASSERT_EQUAL_INT(0, fly_past_a_mover(0.0, 0.0, 0.0));
}

/* GIVEN an autopilot that gives its attitude the wrong way round, on an aircraft that sways THEN the filter starts again and
 * again, and the estimate reports contradictory inputs; GIVEN the right way THEN it never does. */
static void a_wrong_convention_is_reported(void) {
    any = check_random_start("convention");
    for (int wrong = 0; wrong < 2; wrong++) {
        int reported = 0;
        setUp();
        scene.wobble_deg = 10.0;
        start();
        for (int k = 0; k < IMAGES; k++) {
            scene_image(&scene, k, &image, NULL);
            scene_add_noise(&image, &any, 0.5);
            for (int i = 1; wrong > 0 && i < 4; i++) {
                image.pose.attitude[i] = -image.pose.attitude[i];
            }
            update();
            reported += estimate.reason == GOE_REASON_CONVENTION && estimate.suspect ? 1 : 0;
        }
        TEST_ASSERT_TRUE(wrong > 0 ? reported > 0 : reported == 0);
    }
}

/* [A31, goe_quantities.c, filter.range_sd_rel_max]
 * GIVEN a noisy flight THEN a quantity is reported only after two images in a row that knew it: the one before, and this one. */
static void known_in_two_images_in_a_row(void) {
    int held_back = 0;
    any = check_random_start("two in a row");
    for (int shape = 0; shape < 2; shape++) {
        setUp();
        if (shape > 0) {
            scene_make_cylinder(&scene);
        }
        scene.z0_m = 180.0;
        start();
        unsigned before = 0u;
        for (int k = 0; k < 80; k++) {
            fly_noisily(k, k + 1, 0.5);
            const unsigned now = estimator.filter.known;
            const unsigned reported = estimate.valid & ~(GOE_HAS_CENTER | GOE_HAS_VELOCITY);
            if (estimate.fresh && estimate.method == GOE_METHOD_FILTER) {
                TEST_ASSERT_EQUAL_HEX(before & now, reported);
                held_back += (now & ~reported) != 0u ? 1 : 0;
            }
            before = now;
        }
    }
    check_report("images whose quantities waited for the next one", held_back);
    TEST_ASSERT_TRUE(held_back > 0);
}

/* The residual is the window's; the baseline is the way since the track began. */
static void fields_of_the_window_method_alone_are_0(void) {
    scene.path = SCENE_STRAIGHT;
    scene.wobble_deg = 0.0;
    start();
    fly(0, 30);
    TEST_ASSERT_TRUE(estimate.valid & GOE_HAS_POSITION);
    CHECK_SAME(0.0f, estimate.residual);
    CHECK_CLOSE(1.0e-3, 58.0, estimate.baseline_m);
    CHECK_SAME(estimate.orientation_deg, estimate.orientation_raw_deg);
}

/* The number of images behind an answer stops at its largest value. */
static void the_number_of_images_saturates(void) {
    start();
    fly(0, 20);
    TEST_ASSERT_TRUE(estimate.images_used > 10 && estimate.images_used <= 20);
    estimator.filter.health.images = INT16_MAX - 1;
    fly(20, 25);
    TEST_ASSERT_EQUAL_INT(32767, estimate.images_used);
}

/* -------------------------------------------------------------------------------------------------------- forced models -- */

static void a_forced_disc_stays_a_disc(void) {
    settings.model = GOE_MODEL_DISC;
    start();
    for (int k = 0; k < IMAGES; k++) {
        fly(k, k + 1);
        TEST_ASSERT_TRUE(estimate.model == GOE_MODEL_NONE || estimate.model == GOE_MODEL_DISC);
    }
    TEST_ASSERT_EQUAL_INT(GOE_METHOD_FILTER, estimate.method);
    TEST_ASSERT_EQUAL_HEX32(0u, estimate.valid & (GOE_HAS_ORIENTATION | GOE_HAS_LENGTH));
}

/* GIVEN the line model WHEN a box is visible THEN no ellipse is ever reported: the window's line until the box begins, the box from
 * then on. */
static void a_forced_line_is_a_box_and_no_ellipse_before_it(void) {
    bool begun = false;
    settings.model = GOE_MODEL_LINE;
    start();
    for (int k = 0; k < IMAGES; k++) {
        fly(k, k + 1);
        TEST_ASSERT_TRUE(estimate.model != GOE_MODEL_DISC && estimate.model != GOE_MODEL_PRISM);
        begun = begun || estimate.model == GOE_MODEL_BOX;
        TEST_ASSERT_TRUE(!begun || (estimate.model == GOE_MODEL_BOX && estimate.method == GOE_METHOD_FILTER));
    }
    TEST_ASSERT_TRUE(begun);
}

/* A forced line with a cylinder in view: never a base corner, never an answer. */
static void a_forced_line_without_corners_informs_nothing(void) {
    scene_make_cylinder(&scene);
    settings.model = GOE_MODEL_LINE;
    start();
    for (int k = 0; k < IMAGES; k++) {
        fly(k, k + 1);
        TEST_ASSERT_EQUAL_HEX32(0u, estimate.valid);
        TEST_ASSERT_EQUAL_INT(GOE_MODEL_NONE, estimate.model);
    }
}

/* [goe_refined.c] GIVEN a track of more images than are counted THEN the count stays at its largest value. */
static void the_count_of_images_saturates(void) {
    start();
    fly(0, 20);
    estimator.filter.health.images = INT16_MAX - 1;
    for (int k = 20; k < 23; k++) {
        fly(k, k + 1);
        TEST_ASSERT_EQUAL_INT(32767, estimate.images_used);
        TEST_ASSERT_TRUE(estimate.nis_ratio >= 0.0f && estimate.nis_ratio < 1.0f);
    }
}

/* GIVEN a forced line and a truck too far away for a box at first THEN nothing is reported until the box begins. */
static void nothing_answers_before_the_box(void) {
    bool begun = false;
    any = check_random_start("before the start");
    settings.model = GOE_MODEL_LINE;
    settings.detector.point_noise_px = 3.0f;
    scene.z0_m = 400.0;
    start();
    for (int k = 0; k < 190; k++) {
        fly_noisily(k, k + 1, 0.05);
        begun = begun || estimate.model == GOE_MODEL_BOX;
        TEST_ASSERT_TRUE(begun || estimate.valid == 0u);
        TEST_ASSERT_TRUE(k > 0 || !begun);
        TEST_ASSERT_TRUE(estimate.method != GOE_METHOD_WINDOW);
    }
    TEST_ASSERT_TRUE(begun);
}

/* ------------------------------------------------------------------------------------------------------- nothing in view -- */

/* [A7, A34] GIVEN a solution WHEN detections end THEN it grows old, follows the motion, and is not changed. */
static void an_answer_follows_the_motion_while_nothing_is_detected(void) {
    start();
    CHECK_STATUS(GOE_OK, fly(0, 25));
    const goe_estimate_t last = estimate;
    for (int k = 25; k < 35; k++) {
        scene_truth_t truth;
        scene_image(&scene, k, &image, &truth);
        for (int i = 0; i < 6; i++) {
            pixel(i)->visible = false;
        }
        CHECK_STATUS(GOE_NO_DETECTION, update());
        TEST_ASSERT_FALSE(estimate.fresh);
        TEST_ASSERT_EQUAL_HEX32(last.valid, estimate.valid);
        TEST_ASSERT_EQUAL_INT(0, estimate.nis_rows);
        CHECK_CLOSE(1.0e-5, (k - 24) / scene.image_rate_hz, estimate.age_s);
        CHECK_SAME(last.x0_m, estimate.x0_m);
        CHECK_SAME(last.width_m, estimate.width_m);
        CHECK_SAME(last.center_north_m, estimate.center_north_m);
        CHECK_CLOSE(1.0e-4, (double)last.x0_m - truth.dx_m, estimate.x_m);
        CHECK_CLOSE(1.0e-4, (double)last.z0_m - truth.dz_m, estimate.z_m);
    }
    CHECK_STATUS(GOE_OK, fly(35, 36));
    TEST_ASSERT_TRUE(estimate.fresh);
    CHECK_SAME(0.0f, estimate.age_s);
    check_truth(1.0, 0.01);
}

/* GIVEN an answer WHEN an image without a feature follows THEN its covariance is what it was, correlations and all, and what the time
 * adds; WHEN the filter starts again THEN it is that of the sigmas, and what the time adds to the place. */
static void the_covariance_of_an_old_answer_only_grows(void) {
    float before[GOE_QUANTITIES][GOE_QUANTITIES];
    float covariance[GOE_QUANTITIES][GOE_QUANTITIES];
    float value[GOE_QUANTITIES];
    float sigma[GOE_QUANTITIES];
    start();
    fly(0, 25);
    CHECK_STATUS(GOE_OK, goe_covariance(&estimator, before));
    TEST_ASSERT_TRUE(before[GOE_Z0][GOE_WIDTH] != 0.0f);
    scene_image(&scene, 25, &image, NULL);
    for (int i = 0; i < 6; i++) {
        pixel(i)->visible = false;
    }
    CHECK_STATUS(GOE_NO_DETECTION, update());
    CHECK_STATUS(GOE_OK, goe_covariance(&estimator, covariance));
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        const double spread = sqrt((double)before[i][i]);
        TEST_ASSERT_TRUE((double)covariance[i][i] >= (double)before[i][i] * (1.0 - 1.0e-5));
        CHECK_CLOSE(0.01 * spread * spread, (double)before[i][i], covariance[i][i]);
        for (int j = 0; j < i; j++) {
            CHECK_CLOSE(0.01 * spread * sqrt((double)before[j][j]), (double)before[i][j], covariance[i][j]);
        }
    }
    goe_filter_enter(&estimator.filter, GOE_PHASE_NONE);
    CHECK_STATUS(GOE_OK, goe_covariance(&estimator, covariance));
    set_answer(value, sigma);
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        const double square = (double)sigma[i] * (double)sigma[i];
        TEST_ASSERT_TRUE((double)covariance[i][i] >= square * (1.0 - 1.0e-6));
        CHECK_CLOSE(1.0e-3, square, covariance[i][i]);
        for (int j = 0; j < i; j++) {
            CHECK_SAME(0.0f, covariance[i][j]);
        }
    }
}

/* [goe_image_t.pose] GIVEN a bounding box alone, or base corners alone THEN the track goes on. */
static void any_subset_of_the_features_will_do(void) {
    start();
    fly(0, 20);
    for (unsigned subset = 1; subset < 64u; subset++) {
        goe_estimator_t kept = estimator;
        scene_image(&scene, 20, &image, NULL);
        for (int i = 0; i < 6; i++) {
            pixel(i)->visible = pixel(i)->visible && (subset >> i & 1u) != 0u;
        }
        const goe_status_t status = update();
        TEST_ASSERT_TRUE(status == GOE_OK || status == GOE_STALE);
        TEST_ASSERT_EQUAL_HEX32(BOX_BITS, estimate.valid);
        check_truth(2.0, 0.05);
        estimator = kept;
    }
}

/* --------------------------------------------------------------------------------------------------------- broken input -- */

typedef void (*spoil_t)(void);
static void spoil_pose(void) { image.pose.position_ned_m[1] = check_from_bits(0x7FC00000u); }
static void spoil_pixel(void) { image.base_near.u_px = check_from_bits(0xFF800000u); }
static void spoil_range(void) { image.top.v_px = 2.0e5f; }
static void spoil_time(void) { image.pose.time_us -= 1000000; }
static void spoil_attitude(void) { image.pose.attitude[0] *= 1.05f; }

/* [A21] GIVEN a refused image WHEN it comes THEN no byte changes but one counter and the age of the latest image taken, and the
 * answer is reported as a stale one. */
static void a_refused_image_changes_one_counter(void) {
    static const spoil_t spoils[] = {spoil_pose, spoil_pixel, spoil_range, spoil_time, spoil_attitude};
    static const goe_status_t statuses[] = {GOE_NOT_FINITE, GOE_NOT_FINITE, GOE_OUT_OF_RANGE, GOE_BAD_TIME,
                                            GOE_BAD_ATTITUDE};
    start();
    fly(0, 25);
    const goe_estimate_t last = estimate;
    for (int i = 0; i < 5; i++) {
        goe_estimator_t before = estimator;
        scene_image(&scene, 25, &image, NULL);
        spoils[i]();
        CHECK_STATUS(statuses[i], update());
        before.fault_counts[-(int)statuses[i]]++;
        before.estimate.age_s = statuses[i] != GOE_BAD_TIME
                                    ? (float)(image.pose.time_us - before.motion.time_us) * 1.0e-6f
                                    : before.estimate.age_s;
        TEST_ASSERT_EQUAL_MEMORY(&before, &estimator, sizeof before);
        TEST_ASSERT_FALSE(estimate.fresh);
        TEST_ASSERT_EQUAL_HEX32(last.valid, estimate.valid);
        CHECK_SAME(last.z0_m, estimate.z0_m);
        CHECK_SAME(last.sigma.z0_m, estimate.sigma.z0_m);
    }
}

static void reading_calls_refuse_an_invalid_estimator(void) {
    static const float nothing[GOE_QUANTITIES][GOE_QUANTITIES];
    float covariance[GOE_QUANTITIES][GOE_QUANTITIES];
    goe_estimator_t unready;
    memset(&unready, 0, sizeof unready);
    memset(covariance, 0xFF, sizeof covariance);
    CHECK_STATUS(GOE_NOT_INITIALIZED, goe_covariance(&unready, covariance));
    TEST_ASSERT_EQUAL_MEMORY(nothing, covariance, sizeof covariance);
    memset(covariance, 0xFF, sizeof covariance);
    CHECK_STATUS(GOE_BAD_ARGUMENT, goe_covariance(NULL, covariance));
    TEST_ASSERT_EQUAL_MEMORY(nothing, covariance, sizeof covariance);
    start();
    CHECK_STATUS(GOE_BAD_ARGUMENT, goe_covariance(&estimator, NULL));
    memset(covariance, 0xFF, sizeof covariance);
    CHECK_STATUS(GOE_CONVERGING, goe_covariance(&estimator, covariance));
    TEST_ASSERT_EQUAL_MEMORY(nothing, covariance, sizeof covariance);
}

static void swap(goe_pixel_t *a, goe_pixel_t *b) {
    const goe_pixel_t kept = *a;
    *a = *b;
    *b = kept;
}

/* GIVEN left and right exchanged, of the silhouette, of the base, or of both WHEN one image comes so THEN the fault is reported
 * and counted, and the answer stays. */
static void swapped_features_are_reported_and_not_used(void) {
    start();
    fly(0, 25);
    for (int i = 0; i < 3; i++) {
        const uint32_t count = estimator.fault_counts[-GOE_SWAPPED];
        scene_image(&scene, 25 + i, &image, NULL);
        if (i != 1) {
            swap(&image.left, &image.right);
        }
        if (i != 0) {
            swap(&image.base_left, &image.base_right);
        }
        const goe_status_t status = update();
        TEST_ASSERT_TRUE(status == GOE_PARTIAL || status == GOE_SWAPPED);
        TEST_ASSERT_EQUAL_UINT32(count + (i == 2 ? 2u : 1u), estimator.fault_counts[-GOE_SWAPPED]);
        TEST_ASSERT_EQUAL_HEX32(BOX_BITS, estimate.valid);
        check_truth(2.0, 0.02);
    }
    scene_image(&scene, 30, &image, NULL);
    swap(&image.left, &image.right);
    for (int i = 2; i < 6; i++) {
        pixel(i)->visible = false;
    }
    CHECK_STATUS(GOE_SWAPPED, update());
    TEST_ASSERT_FALSE(estimate.fresh);
}

/* ... and from the first image of a track on, which does not start then. */
static void swapped_features_are_reported_before_the_start(void) {
    start();
    for (int k = 0; k < 5; k++) {
        scene_image(&scene, k, &image, NULL);
        swap(&image.left, &image.right);
        swap(&image.base_left, &image.base_right);
        CHECK_STATUS(GOE_SWAPPED, update());
        TEST_ASSERT_EQUAL_HEX32(0u, estimate.valid);
        TEST_ASSERT_EQUAL_UINT32(2u * (uint32_t)(k + 1), estimator.fault_counts[-GOE_SWAPPED]);
    }
    TEST_ASSERT_TRUE(fly(5, 12) >= GOE_OK);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(boxes_come_out_as_they_are);
    RUN_TEST(cylinders_come_out_as_they_are);
    RUN_TEST(sigmas_shrink_with_every_image);
    RUN_TEST(an_uncertain_range_makes_an_image_count_less);
    RUN_TEST(left_and_right_are_equal);
    RUN_TEST(a_constant_attitude_error_is_taken_out);
    RUN_TEST(the_covariance_is_positive_and_contains_the_sigmas);
    RUN_TEST(sigmas_cover_the_error);
    RUN_TEST(a_known_jump_is_compensated);
    RUN_TEST(a_jump_moves_an_old_center_along);
    RUN_TEST(an_unknown_jump_starts_again);
    RUN_TEST(a_reset_forgets_the_track);
    RUN_TEST(single_outliers_are_left_out);
    RUN_TEST(a_track_that_began_with_an_outlier_recovers);
    RUN_TEST(another_top_costs_the_height_alone);
    RUN_TEST(the_attitude_s_error_drifts_with_time);
    RUN_TEST(the_error_of_the_altitude_is_in_the_height);
    RUN_TEST(a_track_that_began_at_another_obstacle_recovers);
    RUN_TEST(a_first_guess_that_is_far_off_comes_right);
    RUN_TEST(time_adds_to_the_bias_and_the_bearing);
    RUN_TEST(unobservable_errors_of_own_motion_are_added);
    RUN_TEST(a_moving_obstacle_is_suspected);
    RUN_TEST(a_wrong_convention_is_reported);
    RUN_TEST(known_in_two_images_in_a_row);
    RUN_TEST(fields_of_the_window_method_alone_are_0);
    RUN_TEST(the_number_of_images_saturates);
    RUN_TEST(a_forced_disc_stays_a_disc);
    RUN_TEST(a_forced_line_is_a_box_and_no_ellipse_before_it);
    RUN_TEST(a_forced_line_without_corners_informs_nothing);
    RUN_TEST(the_count_of_images_saturates);
    RUN_TEST(nothing_answers_before_the_box);
    RUN_TEST(an_answer_follows_the_motion_while_nothing_is_detected);
    RUN_TEST(the_covariance_of_an_old_answer_only_grows);
    RUN_TEST(any_subset_of_the_features_will_do);
    RUN_TEST(a_refused_image_changes_one_counter);
    RUN_TEST(reading_calls_refuse_an_invalid_estimator);
    RUN_TEST(swapped_features_are_reported_and_not_used);
    RUN_TEST(swapped_features_are_reported_before_the_start);
    return UNITY_END();
}
