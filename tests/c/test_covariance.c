/* The latest estimate's covariance, and the further inputs of goe_hazard. SPDX-License-Identifier: MIT
 *
 * Estimates and states are written into the estimator, so that every number is known. */
/* tests: lib/goe_covariance.c */
#include "goe_covariance.h"

#include <math.h>
#include <string.h>

#include "check.h"
#include "maths/goe_angle.h"
#include "refined/goe_observation.h"
#include "refined/goe_quantities.h"
#include "scene.h"

static goe_estimator_t estimator;
static goe_covariance_t covariance;

void setUp(void) {
    goe_settings_t settings;
    goe_settings_default(&settings);
    settings.camera.fx_px = settings.camera.fy_px = 900.0f;
    settings.camera.cx_px = settings.camera.cy_px = 640.0f;
    settings.camera.width_px = settings.camera.height_px = 0.0f;
    TEST_ASSERT_EQUAL_INT(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
    estimator.motion.time_us = 5000000;
    estimator.estimate_time_us = 5000000;
    estimator.motion.height_m = 40.0f;
    estimator.estimate.method = GOE_METHOD_FILTER;
    estimator.estimate.valid = GOE_HAS_POSITION;
    for (int i = 0; i < GOE_STATES; i++) {
        estimator.filter.state[i] = 0.01f * (float)(i + 1);
    }
    estimator.filter.state[GOE_INVERSE_RANGE] = 0.005f;
    estimator.filter.answer.outdated = true; /* the filter has gone on since the answer */
}
void tearDown(void) {}

/* GIVEN an answer that the filter has left THEN its covariance is that of its sigmas, squared, and nothing off the diagonal: the
 * correlations are not kept with it. A hazard allows for them by twice the variance. */
static void an_old_answer_has_its_sigmas_alone(void) {
    const float of[GOE_QUANTITIES] = {2.0f, 3.0f, 5.0f, 7.0f, 11.0f, 13.0f};
    goe_sigma_t *sigma = &estimator.estimate.sigma;
    sigma->x0_m = of[GOE_X0];
    sigma->z0_m = of[GOE_Z0];
    sigma->orientation_deg = of[GOE_ORIENTATION];
    sigma->width_m = of[GOE_WIDTH];
    sigma->length_m = of[GOE_LENGTH];
    sigma->height_m = of[GOE_HEIGHT];
    CHECK_STATUS(GOE_OK, goe_covariance(&estimator, covariance));
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        for (int j = 0; j < GOE_QUANTITIES; j++) {
            CHECK_SAME(i == j ? of[i] * of[i] : 0.0f, covariance[i][j]);
        }
    }
    CHECK_STATUS(GOE_OK, goe_covariance_ahead(&estimator, true, 0.0f, covariance));
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        CHECK_SAME(2.0f * of[i] * of[i], covariance[i][i]);
    }
    estimator.estimate.method = GOE_METHOD_WINDOW; /* whose sigmas are all there ever was */
    CHECK_STATUS(GOE_OK, goe_covariance_ahead(&estimator, true, 0.0f, covariance));
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        CHECK_SAME(of[i] * of[i], covariance[i][i]);
    }
}

/* GIVEN an answer four seconds old of an obstacle that stands still THEN its place relative to the camera is less certain by what the
 * own velocity may be off, and by the walk of the own position; an answer of the window's is not. */
static void the_place_grows_uncertain_by_the_own_motion(void) {
    const double bias = 0.05;
    const double walk = 0.05;
    estimator.motion.time_us = 9000000;
    estimator.estimate.sigma.x0_m = 2.0f;
    estimator.estimate.sigma.z0_m = 3.0f;
    CHECK_STATUS(GOE_OK, goe_covariance(&estimator, covariance));
    CHECK_CLOSE(1.0e-5, 4.0 + 16.0 * bias * bias + 4.0 * walk * walk, covariance[GOE_X0][GOE_X0]);
    CHECK_CLOSE(1.0e-5, 9.0 + 16.0 * bias * bias + 4.0 * walk * walk, covariance[GOE_Z0][GOE_Z0]);
    estimator.estimate.method = GOE_METHOD_WINDOW;
    CHECK_STATUS(GOE_OK, goe_covariance(&estimator, covariance));
    CHECK_SAME(4.0f, covariance[GOE_X0][GOE_X0]);
}

/* GIVEN an obstacle that moves, last detected four seconds ago THEN its place has become uncertain by four times the larger sigma of
 * its velocity, along both axes equally, as those of T are not north and east; and its size has not. */
static void the_position_of_a_moving_target_grows_uncertain(void) {
    for (int larger = 0; larger < 2; larger++) {
        goe_sigma_t *sigma = &estimator.estimate.sigma;
        const double own_m2 = 16.0 * 0.05 * 0.05 + 4.0 * 0.05 * 0.05; /* of the own motion in four seconds */
        const double more_m2 = 36.0 * 0.05 * 0.05 + 6.0 * 0.05 * 0.05;
        estimator.estimate.valid = GOE_HAS_POSITION | GOE_HAS_VELOCITY;
        estimator.motion.time_us = 9000000;
        sigma->x0_m = 2.0f;
        sigma->z0_m = 3.0f;
        sigma->width_m = 7.0f;
        sigma->velocity_north_m_s = larger == 0 ? 1.5f : 0.5f;
        sigma->velocity_east_m_s = larger == 0 ? 0.5f : 1.5f;
        CHECK_STATUS(GOE_OK, goe_covariance(&estimator, covariance));
        CHECK_CLOSE(1.0e-4, 4.0 + 36.0 + own_m2, covariance[GOE_X0][GOE_X0]);
        CHECK_CLOSE(1.0e-4, 9.0 + 36.0 + own_m2, covariance[GOE_Z0][GOE_Z0]);
        CHECK_SAME(49.0f, covariance[GOE_WIDTH][GOE_WIDTH]);
        CHECK_SAME(0.0f, covariance[GOE_X0][GOE_Z0]);
        CHECK_STATUS(GOE_OK, goe_covariance_ahead(&estimator, true, 2.0f, covariance)); /* asked two seconds ahead */
        CHECK_CLOSE(1.0e-4, 2.0 * 4.0 + 81.0 + more_m2, covariance[GOE_X0][GOE_X0]);
    }
}

/* [A34] GIVEN an answer of the filter's, fresh or not THEN reach, height and what its height is freed of are as they were with it; of an
 * answer of the window's the filter has no part. */
static void inputs_of_a_hazard_are_kept_with_the_answer(void) {
    goe_answer_t *answer = &estimator.filter.answer;
    answer->reach_m = 7.0f;
    answer->nearer.dx_m = 3.0f;
    answer->nearer.dz_m = -4.0f;
    answer->height_bias_m = 0.5f;
    estimator.filter.datum.height_m = 35.0f;
    for (int fresh = 0; fresh < 2; fresh++) {
        estimator.estimate.fresh = fresh == 1;
        CHECK_SAME(7.0f, goe_latest_answer(&estimator).reach_m);
        CHECK_SAME(3.0f, goe_latest_answer(&estimator).nearer.dx_m);
        CHECK_SAME(-4.0f, goe_latest_answer(&estimator).nearer.dz_m);
        CHECK_SAME(0.5f, goe_latest_answer(&estimator).height_bias_m);
        CHECK_SAME(35.0f, goe_latest_camera_height(&estimator));
    }
    estimator.estimate.method = GOE_METHOD_WINDOW;
    CHECK_SAME(0.0f, goe_latest_answer(&estimator).reach_m);
    CHECK_SAME(0.0f, goe_latest_answer(&estimator).nearer.dx_m);
    CHECK_SAME(0.0f, goe_latest_answer(&estimator).nearer.dz_m);
    CHECK_SAME(0.0f, goe_latest_answer(&estimator).height_bias_m);
    CHECK_SAME(40.0f, goe_latest_camera_height(&estimator));
}

/* A filter of independent states, each uncertain, seeing a box. */
static void make_box(void) {
    goe_srif_clear(&estimator.filter.root);
    for (size_t i = 0; i < GOE_STATES; i++) {
        *goe_srif_at(&estimator.filter.root, i, i) = 1.0e3f;
    }
    estimator.filter.phase = GOE_PHASE_BOX;
    estimator.filter.axes.turn_cos = 1.0f;
    estimator.estimate.fresh = true;
    estimator.filter.answer.outdated = false;
    estimator.estimate.valid = GOE_HAS_POSITION | GOE_HAS_ORIENTATION | GOE_HAS_WIDTH | GOE_HAS_LENGTH | GOE_HAS_HEIGHT;
    estimator.filter.state[GOE_DEPTH_DIFFERENCE] = 0.02f;
}

/* GIVEN a box's answer THEN its covariance is symmetric, in degrees where it is the orientation's; and of a quantity that is not
 * reported rows and columns are 0, and no other. */
static void an_unreported_quantity_has_no_covariance(void) {
    static const unsigned bits[GOE_QUANTITIES] = {GOE_HAS_POSITION, GOE_HAS_POSITION, GOE_HAS_ORIENTATION,
                                                  GOE_HAS_WIDTH,    GOE_HAS_LENGTH,   GOE_HAS_HEIGHT};
    goe_covariance_t all;
    make_box();
    const unsigned valid = estimator.estimate.valid;
    CHECK_STATUS(GOE_OK, goe_covariance(&estimator, all));
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        TEST_ASSERT_TRUE(all[i][i] > 0.0f);
        for (int j = 0; j < i; j++) {
            CHECK_SAME(all[i][j], all[j][i]);
        }
    }
    goe_covariance_t raw;
    goe_quantities_covariance(&estimator.filter, &estimator.settings, &estimator.motion, false, 0.0f, raw);
    CHECK_CLOSE(1.0e-3 * (double)all[GOE_ORIENTATION][GOE_ORIENTATION],
                (double)raw[GOE_ORIENTATION][GOE_ORIENTATION] * (double)GOE_DEG_PER_RAD * (double)GOE_DEG_PER_RAD,
                all[GOE_ORIENTATION][GOE_ORIENTATION]);
    CHECK_CLOSE(1.0e-3 * fabs((double)all[GOE_ORIENTATION][GOE_WIDTH]),
                (double)raw[GOE_ORIENTATION][GOE_WIDTH] * (double)GOE_DEG_PER_RAD, all[GOE_ORIENTATION][GOE_WIDTH]);
    for (int missing = GOE_ORIENTATION; missing < GOE_QUANTITIES; missing++) {
        estimator.estimate.valid = valid & ~bits[missing];
        CHECK_STATUS(GOE_OK, goe_covariance(&estimator, covariance));
        for (int i = 0; i < GOE_QUANTITIES; i++) {
            for (int j = 0; j < GOE_QUANTITIES; j++) {
                CHECK_SAME(i == missing || j == missing ? 0.0f : all[i][j], covariance[i][j]);
            }
        }
    }
}

/* ------------------------------------------------------------------------------------------------------------ flights -- */

typedef enum { CORNERS, OUTLINE, CHIMNEY, BOXES, BOXES_AND_CORNERS, FLIGHTS } flight_t;

static scene_t scene;

static void start(flight_t flight) {
    scene_default(&scene);
    scene.wobble_deg = 1.0;
    scene.top_nearest = true;
    if (flight == CHIMNEY) {
        scene_make_cylinder(&scene);
    } else if (flight == OUTLINE) { /* whose front turns away on the way */
        scene.width_m = 5.0;
        scene.length_m = 9.0;
        scene.height_m = 6.0;
        scene.alpha_deg = 40.0;
        scene.x0_m = -16.0;
        scene.speed_mps = 10.0;
        scene.image_rate_hz = 20.0;
    }
    goe_settings_t settings = scene_settings(&scene);
    settings.model = flight == CHIMNEY ? GOE_MODEL_DISC : GOE_MODEL_AUTO;
    if (flight == OUTLINE) {
        scene_clear_noise(&settings);
    }
    CHECK_STATUS(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
}

static void see(flight_t flight, int k, check_random_t *any, goe_image_t *image) {
    scene.boxes = flight == BOXES || flight == BOXES_AND_CORNERS;
    scene_image(&scene, k, image, NULL);
    if (flight == BOXES_AND_CORNERS) {
        const goe_box_t box = image->box;
        scene.boxes = false;
        scene_image(&scene, k, image, NULL);
        image->box = box;
    }
    scene_add_noise(image, any, flight == OUTLINE ? 0.0 : 1.5); /* more than the settings say: the track scatters */
    if (flight == OUTLINE) {
        image->base_left.visible = image->base_near.visible = image->base_right.visible = false;
    }
}

/* How many quantities are valid. Each sigma squared is its variance, to rounding. */
static int check_diagonal(const goe_estimate_t *e) {
    static const unsigned bits[GOE_QUANTITIES] = {GOE_HAS_POSITION, GOE_HAS_POSITION, GOE_HAS_ORIENTATION,
                                                  GOE_HAS_WIDTH,    GOE_HAS_LENGTH,   GOE_HAS_HEIGHT};
    const goe_sigma_t *s = &e->sigma;
    const float sigma[GOE_QUANTITIES] = {s->x0_m, s->z0_m, s->orientation_deg, s->width_m, s->length_m, s->height_m};
    int valid = 0;
    CHECK_STATUS(GOE_OK, goe_covariance(&estimator, covariance));
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        if (e->valid & bits[i]) {
            const double expected = (double)sigma[i] * (double)sigma[i];
            if (e->fresh) {
                CHECK_CLOSE(2.0e-4 * expected, expected, covariance[i][i]);
            } else { /* with what its age adds, to the place at most what the sigmas of x and z hold */
                TEST_ASSERT_TRUE((double)covariance[i][i] >= expected * (1.0 - 2.0e-4));
                CHECK_CLOSE(0.02 * expected + 0.01, expected, covariance[i][i]);
            }
            valid++;
        }
    }
    return valid;
}

/* [goe_covariance] GIVEN flights that go through all models, and scatter THEN sigma and covariance agree for every quantity, in images that
 * show the obstacle and in those that do not. */
static void sigmas_and_covariance_agree_in_flight(void) {
    unsigned models = 0;
    unsigned phases = 0;
    check_random_t any = check_random_start("diagonals");
    for (flight_t flight = CORNERS; flight < FLIGHTS; flight++) {
        int valid = 0;
        start(flight);
        for (int k = 0; k < (flight == OUTLINE ? 188 : 40); k++) {
            goe_image_t image;
            goe_estimate_t estimate;
            see(flight, k, &any, &image);
            if (k % 7 == 6) {
                scene_hide_points(&image);
                image.box.sides = 0;
            }
            (void)goe_update(&estimator, &image, &estimate);
            if (estimate.method == GOE_METHOD_FILTER && (estimate.valid & GOE_HAS_POSITION)) {
                valid += check_diagonal(&estimate);
                models |= 1u << estimate.model;
                phases |= 1u << estimator.filter.phase;
            }
        }
        TEST_ASSERT_TRUE(valid > 60);
    }
    TEST_ASSERT_EQUAL_HEX(1u << GOE_MODEL_DISC | 1u << GOE_MODEL_BOX | 1u << GOE_MODEL_PRISM, models);
    TEST_ASSERT_TRUE(phases & 1u << GOE_PHASE_FOOTPRINT && phases & 1u << GOE_PHASE_BOX);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(an_old_answer_has_its_sigmas_alone);
    RUN_TEST(the_position_of_a_moving_target_grows_uncertain);
    RUN_TEST(the_place_grows_uncertain_by_the_own_motion);
    RUN_TEST(inputs_of_a_hazard_are_kept_with_the_answer);
    RUN_TEST(an_unreported_quantity_has_no_covariance);
    RUN_TEST(sigmas_and_covariance_agree_in_flight);
    return UNITY_END();
}
