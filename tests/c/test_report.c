/* Why an estimate is suspect, and the accompanying fields. SPDX-License-Identifier: MIT */
/* tests: lib/refined/goe_report.c */
#include "refined/goe_report.h"

#include <math.h>
#include <string.h>

#include "check.h"
#include "inverse.h"
#include "refined/goe_filter.h"

static goe_filter_t filter;
static goe_settings_t settings;
static goe_estimate_t estimate;
static goe_motion_t motion;
static goe_quantities_t quantities;

/* To 50 ms, as at the beginning of a track. */
static void know_latency(void) {
#if GOE_AUGMENTED
    filter.root.element[goe_srif_augmented_row()] = 20.0f;
#endif
}

void setUp(void) {
    goe_settings_default(&settings);
    goe_filter_clear(&filter);
    memset(&estimate, 0, sizeof estimate);
    memset(&motion, 0, sizeof motion);
    memset(&quantities, 0, sizeof quantities);
    know_latency();
    filter.phase = GOE_PHASE_BOX;
    filter.health.images = 40;
    filter.health.mean_nis = 1.0f;
    filter.health.nis = 7.5f;
    filter.health.nis_rows = 9;
    estimate.method = GOE_METHOD_FILTER;
}
void tearDown(void) {}

static void check_reason(goe_reason_t reason, bool suspect) {
    goe_report_fit(&filter, &settings, &estimate);
    TEST_ASSERT_EQUAL_STRING(goe_reason_text(reason), goe_reason_text(estimate.reason));
    TEST_ASSERT_EQUAL_INT(suspect, estimate.suspect);
}

/* A footprint for which a disc was configured, whose shear is beyond chance. */
static void be_sheared(void) {
    filter.phase = GOE_PHASE_FOOTPRINT;
    filter.kind.is_round = true;
    filter.state[GOE_SHEAR] = 1.0f;
    inverse_start(&filter.root, 0.1);
    know_latency();
}

/* GIVEN more than one reason THEN the most informative one is reported: motion before a wrong corner, no disc, latency, and only then
 * a general nis_ratio, which all of them cause. Late poses alone are corrected, and make nothing suspect. */
static void the_most_informative_reason_is_reported(void) {
    check_reason(GOE_REASON_NONE, false);
    filter.health.mean_nis = 2.0f;
    check_reason(GOE_REASON_NOISE, true);
    filter.health.adrift = true;
    check_reason(GOE_REASON_CONVENTION, true);
    filter.mover.late = true;
    check_reason(GOE_REASON_LATE, true); /* as it does not fit either */
    be_sheared();
    check_reason(GOE_REASON_SHAPE, true);
    filter.health.base_refused = true;
    check_reason(GOE_REASON_BASE, true);
    filter.mover.moves = true;
    check_reason(GOE_REASON_MOVES, true);
    setUp();
    filter.mover.late = true;
    check_reason(GOE_REASON_LATE, false);
    setUp();
    filter.health.adrift = true; /* that fits all the same */
    check_reason(GOE_REASON_NONE, false);
}

/* GIVEN few images THEN a NIS ratio says nothing yet. */
static void few_images_make_nothing_suspect(void) {
    filter.health.mean_nis = 5.0f;
    filter.health.images = 7;
    check_reason(GOE_REASON_NONE, false);
    filter.health.images = 8;
    check_reason(GOE_REASON_NOISE, true);
    settings.filter.nis_ratio_max = 5.0f; /* above which, not from which on */
    check_reason(GOE_REASON_NONE, false);
}

/* GIVEN a sheared footprint THEN it is reported as no disc only if a disc was configured, and only while the model is one. */
static void a_shear_matters_where_a_disc_was_requested(void) {
    be_sheared();
    check_reason(GOE_REASON_SHAPE, true);
    filter.kind.is_round = false;
    check_reason(GOE_REASON_NONE, false);
    be_sheared();
    filter.phase = GOE_PHASE_BOX;
    check_reason(GOE_REASON_NONE, false);
    be_sheared();
    filter.state[GOE_SHEAR] = 0.4f; /* 4 sigma; 4.2 are too many for a cylinder */
    check_reason(GOE_REASON_NONE, false);
    filter.kind.wrong = true; /* the images contradict the class */
    check_reason(GOE_REASON_SHAPE, true);
}

/* GIVEN an answer THEN the fit is reported with the filter method's alone; the latency, which both methods suffer from, always. */
static void the_fit_is_reported_with_the_filters_answer(void) {
    filter.mover.augmented[0] = 0.12f;
    goe_report_fit(&filter, &settings, &estimate);
    TEST_ASSERT_EQUAL_INT(40, estimate.images_used);
    TEST_ASSERT_EQUAL_INT(9, estimate.nis_rows);
    CHECK_SAME(7.5f, estimate.nis);
    CHECK_SAME(1.0f, estimate.nis_ratio);
    CHECK_SAME(0.12f, estimate.latency_s);
    CHECK_CLOSE(1.0e-6, 0.05, estimate.sigma.latency_s); /* as before anything was known */
    memset(&estimate, 0, sizeof estimate);
    estimate.method = GOE_METHOD_WINDOW;
    goe_report_fit(&filter, &settings, &estimate);
    TEST_ASSERT_EQUAL_INT(0, estimate.images_used + estimate.nis_rows);
    CHECK_SAME(0.0f, estimate.nis);
    CHECK_SAME(0.0f, estimate.nis_ratio);
    CHECK_SAME(0.12f, estimate.latency_s);
}

/* GIVEN quantities THEN each is reported with its own sigma if its bit says so, and is 0 otherwise; X0 and Z0 with the error of the own
 * position before the filter began, x and z without. */
static void only_known_values_are_reported(void) {
    static const unsigned bits[] = {GOE_HAS_WIDTH, GOE_HAS_LENGTH, GOE_HAS_HEIGHT, GOE_HAS_ORIENTATION, GOE_HAS_CENTER};
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        quantities.value[i] = (float)(10 * (i + 1));
        quantities.sigma[i] = (float)(i + 1);
    }
    quantities.value[GOE_ORIENTATION] = 0.5f;
    quantities.length_axis = (goe_xz_t){0.6f, 0.8f};
    quantities.before_m2 = 8.0f;
    quantities.center_m[0] = 111.0f;
    quantities.center_m[1] = 222.0f;
    quantities.center_sd_m[0] = 11.0f;
    quantities.center_sd_m[1] = 22.0f;
    quantities.center_ne_m2 = 33.0f;
    quantities.model = GOE_MODEL_BOX;
    motion.dx_m = 3.0f;
    motion.dz_m = 4.0f;
    for (size_t n = 0; n < 32; n++) {
        memset(&estimate, 0xA5, sizeof estimate);
        estimate.valid = 0;
        quantities.known = GOE_HAS_POSITION;
        for (size_t i = 0; i < 5; i++) {
            quantities.known |= (n >> i & 1u) != 0u ? bits[i] : 0u;
        }
        const unsigned known = quantities.known;
        TEST_ASSERT_TRUE(goe_report_quantities(&quantities, &motion, &estimate));
        TEST_ASSERT_EQUAL_HEX(known, estimate.valid);
        TEST_ASSERT_TRUE(estimate.fresh);
        TEST_ASSERT_EQUAL_INT(GOE_MODEL_BOX, estimate.model);
        CHECK_SAME(10.0f, estimate.x0_m);
        CHECK_SAME(20.0f, estimate.z0_m);
        CHECK_CLOSE(1.0e-6, 7.0, estimate.x_m);
        CHECK_CLOSE(1.0e-6, 16.0, estimate.z_m);
        CHECK_CLOSE(1.0e-6, 3.0, estimate.sigma.x0_m);
        CHECK_CLOSE(1.0e-6, sqrt(12.0), estimate.sigma.z0_m);
        CHECK_SAME(1.0f, estimate.sigma.x_m);
        CHECK_SAME(2.0f, estimate.sigma.z_m);
        CHECK_SAME(5.0f, estimate.baseline_m);
        const bool width = (known & GOE_HAS_WIDTH) != 0u;
        const bool length = (known & GOE_HAS_LENGTH) != 0u;
        const bool height = (known & GOE_HAS_HEIGHT) != 0u;
        const bool turned = (known & GOE_HAS_ORIENTATION) != 0u;
        const bool center = (known & GOE_HAS_CENTER) != 0u;
        CHECK_SAME(width ? 40.0f : 0.0f, estimate.width_m);
        CHECK_SAME(width ? 4.0f : 0.0f, estimate.sigma.width_m);
        CHECK_SAME(length ? 50.0f : 0.0f, estimate.length_m);
        CHECK_SAME(length ? 5.0f : 0.0f, estimate.sigma.length_m);
        CHECK_SAME(height ? 60.0f : 0.0f, estimate.height_m);
        CHECK_SAME(height ? 6.0f : 0.0f, estimate.sigma.height_m);
        CHECK_CLOSE(1.0e-5, turned ? 28.6478898 : 0.0, estimate.orientation_deg);
        CHECK_CLOSE(1.0e-5, turned ? 28.6478898 : 0.0, estimate.orientation_raw_deg);
        CHECK_CLOSE(1.0e-5, turned ? 28.6478898 - 90.0 : 0.0, estimate.front_orientation_deg);
        CHECK_CLOSE(1.0e-4, turned ? 3.0 * 57.2957795 : 0.0, estimate.sigma.orientation_deg);
        CHECK_SAME(turned ? 0.6f : 0.0f, estimate.length_axis[0]);
        CHECK_SAME(turned ? 0.8f : 0.0f, estimate.length_axis[1]);
        CHECK_SAME(turned ? 0.8f : 0.0f, estimate.width_axis[0]);
        CHECK_SAME(turned ? -0.6f : 0.0f, estimate.width_axis[1]);
        CHECK_SAME(center ? 111.0f : 0.0f, estimate.center_north_m);
        CHECK_SAME(center ? 222.0f : 0.0f, estimate.center_east_m);
        CHECK_SAME(center ? 11.0f : 0.0f, estimate.sigma.center_north_m);
        CHECK_SAME(center ? 22.0f : 0.0f, estimate.sigma.center_east_m);
        CHECK_SAME(center ? 33.0f : 0.0f, estimate.center_ne_m2);
        TEST_ASSERT_FALSE(estimate.valid & GOE_HAS_VELOCITY);
        CHECK_SAME(0.0f, estimate.velocity_east_m_s);
    }
}

/* GIVEN an obstacle that is followed THEN its velocity is reported with the rest. GIVEN an image that knows no position THEN the previous
 * answer stays as it is; without a previous one, only the method is reported. */
static void an_image_that_knows_nothing_takes_nothing_back(void) {
    quantities.known = GOE_HAS_POSITION;
    quantities.model = GOE_MODEL_PRISM;
    quantities.moves = true;
    quantities.velocity_m_s[0] = 3.0f;
    quantities.velocity_m_s[1] = -4.0f;
    quantities.velocity_sd_m_s[0] = 0.3f;
    quantities.velocity_sd_m_s[1] = 0.4f;
    TEST_ASSERT_TRUE(goe_report_quantities(&quantities, &motion, &estimate));
    TEST_ASSERT_EQUAL_HEX(GOE_HAS_POSITION | GOE_HAS_VELOCITY, estimate.valid);
    TEST_ASSERT_EQUAL_INT(GOE_MODEL_PRISM, estimate.model);
    CHECK_SAME(3.0f, estimate.velocity_north_m_s);
    CHECK_SAME(-4.0f, estimate.velocity_east_m_s);
    CHECK_SAME(0.3f, estimate.sigma.velocity_north_m_s);
    CHECK_SAME(0.4f, estimate.sigma.velocity_east_m_s);
    const goe_estimate_t before = estimate;
    quantities.known = 0;
    TEST_ASSERT_FALSE(goe_report_quantities(&quantities, &motion, &estimate));
    TEST_ASSERT_EQUAL_MEMORY(&before, &estimate, sizeof estimate);
    memset(&estimate, 0xA5, sizeof estimate);
    estimate.valid = 0;
    TEST_ASSERT_FALSE(goe_report_quantities(&quantities, &motion, &estimate));
    TEST_ASSERT_EQUAL_INT(GOE_METHOD_FILTER, estimate.method);
    TEST_ASSERT_EQUAL_INT(GOE_MODEL_NONE, estimate.model);
    CHECK_SAME(0.0f, estimate.z0_m);
    TEST_ASSERT_FALSE(estimate.fresh);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(the_most_informative_reason_is_reported);
    RUN_TEST(few_images_make_nothing_suspect);
    RUN_TEST(a_shear_matters_where_a_disc_was_requested);
    RUN_TEST(the_fit_is_reported_with_the_filters_answer);
    RUN_TEST(only_known_values_are_reported);
    RUN_TEST(an_image_that_knows_nothing_takes_nothing_back);
    return UNITY_END();
}
