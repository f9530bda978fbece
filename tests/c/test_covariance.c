/* The latest estimate's covariance, and what goe_hazard asks beside it. SPDX-License-Identifier: MIT
 *
 * Estimates and states are written into the estimator, so that every number is known. */
#include "goe_covariance.h"

#include <math.h>
#include <string.h>

#include "check.h"
#include "maths/goe_angle.h"
#include "refined/goe_observation.h"
#include "refined/goe_prism.h"
#include "refined/goe_quantities.h"

static goe_estimator_t estimator;
static goe_covariance_t covariance;

void setUp(void) {
    goe_settings_t settings;
    goe_settings_default(&settings);
    settings.camera.fx_px = settings.camera.fy_px = 900.0f;
    settings.camera.cx_px = settings.camera.cy_px = 640.0f;
    TEST_ASSERT_EQUAL_INT(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
    estimator.motion.time_us = 5000000;
    estimator.estimate_time_us = 5000000;
    estimator.motion.height_m = 40.0f;
    estimator.estimate.method = GOE_METHOD_REFINED;
    estimator.estimate.valid = GOE_HAS_POSITION;
    for (int i = 0; i < GOE_STATES; i++) {
        estimator.filter.state[i] = 0.01f * (float)(i + 1);
    }
    estimator.filter.state[GOE_INVERSE_RANGE] = 0.005f;
}
void tearDown(void) {}

/* GIVEN an answer that is not the filter's at hand THEN its covariance is that of its sigmas, squared, and nothing beside the
 * diagonal: what the quantities had in common is not kept with them. */
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
}

/* GIVEN an obstacle that moves, last seen four seconds ago THEN its place has become uncertain by four times the larger sigma of
 * its velocity, along both axes alike, as those of T are not north and east; and its size has not. */
static void the_place_of_what_moves_grows_uncertain(void) {
    for (int larger = 0; larger < 2; larger++) {
        goe_sigma_t *sigma = &estimator.estimate.sigma;
        estimator.motion.time_us = 9000000;
        sigma->x0_m = 2.0f;
        sigma->z0_m = 3.0f;
        sigma->width_m = 7.0f;
        sigma->velocity_north_m_s = larger == 0 ? 1.5f : 0.5f;
        sigma->velocity_east_m_s = larger == 0 ? 0.5f : 1.5f;
        CHECK_STATUS(GOE_OK, goe_covariance(&estimator, covariance));
        CHECK_CLOSE(1.0e-4, 4.0 + 36.0, covariance[GOE_X0][GOE_X0]);
        CHECK_CLOSE(1.0e-4, 9.0 + 36.0, covariance[GOE_Z0][GOE_Z0]);
        CHECK_SAME(49.0f, covariance[GOE_WIDTH][GOE_WIDTH]);
        CHECK_SAME(0.0f, covariance[GOE_X0][GOE_Z0]);
        CHECK_STATUS(GOE_OK, goe_latest_covariance(&estimator, true, 2.0f, covariance)); /* asked two seconds ahead */
        CHECK_CLOSE(1.0e-4, 4.0 + 81.0, covariance[GOE_X0][GOE_X0]);
    }
}

/* GIVEN an answer whose width is not known well enough to be told THEN the hazard's circle reaches as far as the filter's own guess
 * of it: a warning must not wait for a figure. */
static void what_is_not_told_still_reaches(void) {
    const float *x = estimator.filter.state;
    estimator.estimate.fresh = true;
    estimator.filter.state[GOE_SIDE_X] = -0.03f;
    estimator.filter.phase = GOE_PHASE_PRISM;
    CHECK_CLOSE(1.0e-4, (double)x[GOE_PRISM_HALF] / 0.005, goe_latest_reach(&estimator));
    estimator.filter.phase = GOE_PHASE_DISC;
    CHECK_CLOSE(1.0e-4, 0.5 * (double)x[GOE_FRONT_X] / 0.005, goe_latest_reach(&estimator));
    estimator.filter.phase = GOE_PHASE_BOX;
    CHECK_CLOSE(1.0e-4, 0.5 * ((double)x[GOE_FRONT_X] + 0.03) / 0.005, goe_latest_reach(&estimator));
}

/* GIVEN an answer of the window's, or an old one THEN the filter's state has no part in it: it may be another's by now. */
static void an_answer_that_is_not_the_filters_takes_nothing_of_it(void) {
    estimator.estimate.fresh = false;
    CHECK_SAME(0.0f, goe_latest_reach(&estimator));
    CHECK_SAME(0.0f, goe_latest_height_bias(&estimator));
    estimator.estimate.fresh = true;
    estimator.estimate.method = GOE_METHOD_WINDOW;
    CHECK_SAME(0.0f, goe_latest_reach(&estimator));
    CHECK_SAME(0.0f, goe_latest_height_bias(&estimator));
    CHECK_SAME(40.0f, goe_latest_camera_height(&estimator));
    estimator.estimate.method = GOE_METHOD_REFINED;
    CHECK_CLOSE(1.0e-4, (double)estimator.filter.state[GOE_GROUND] / 0.005, goe_latest_height_bias(&estimator));
}

/* GIVEN a height that is kept over the track THEN the camera's is that one, and not the latest image's, whose noise the obstacle's
 * height has no part in. */
static void the_camera_is_as_high_as_the_filter_took_it(void) {
    estimator.estimate.fresh = true;
    estimator.filter.datum.height_m = 35.0f;
    estimator.filter.phase = GOE_PHASE_DISC;
    CHECK_SAME(40.0f, goe_latest_camera_height(&estimator));
    estimator.filter.phase = GOE_PHASE_PRISM;
    CHECK_SAME(35.0f, goe_latest_camera_height(&estimator));
    estimator.filter.phase = GOE_PHASE_DISC;
    estimator.settings.navigation.height_white_m = 1.0f;
    CHECK_SAME(35.0f, goe_latest_camera_height(&estimator));
}

/* A filter of independent states, each uncertain, seeing a box. */
static void make_box(void) {
    goe_srif_clear(&estimator.filter.root);
    for (size_t i = 0; i < GOE_STATES; i++) {
        *goe_srif_at(&estimator.filter.root, i, i) = 1.0e3f;
    }
    goe_srif_invert(&estimator.filter.root, &estimator.filter.inverse);
    estimator.filter.phase = GOE_PHASE_BOX;
    estimator.filter.axes.turn_cos = 1.0f;
    estimator.estimate.fresh = true;
    estimator.estimate.valid = GOE_HAS_POSITION | GOE_HAS_ORIENTATION | GOE_HAS_WIDTH | GOE_HAS_LENGTH | GOE_HAS_HEIGHT;
    estimator.filter.state[GOE_DEPTH_DIFFERENCE] = 0.02f;
}

/* GIVEN a box's answer THEN its covariance is symmetric, in degrees where it is the orientation's; and of a quantity that is not
 * told rows and columns are 0, and no other. */
static void what_is_not_told_has_no_covariance(void) {
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

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(an_old_answer_has_its_sigmas_alone);
    RUN_TEST(the_place_of_what_moves_grows_uncertain);
    RUN_TEST(what_is_not_told_still_reaches);
    RUN_TEST(an_answer_that_is_not_the_filters_takes_nothing_of_it);
    RUN_TEST(the_camera_is_as_high_as_the_filter_took_it);
    RUN_TEST(what_is_not_told_has_no_covariance);
    return UNITY_END();
}
