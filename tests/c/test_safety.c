/* Any input, only finite output. SPDX-License-Identifier: MIT
 *
 * Invariants, checked after every call on random, extreme and broken input:
 *   - the status is one that goe.h allows for the call;
 *   - every number of the estimate and of the estimator is finite, judged by its exponent bits;
 *   - a quantity without its valid bit is 0, one with it lies in its range, sigmas and age are not negative;
 *   - the filter method gives no quantity whose sigma is larger than goe.h allows; the covariance is finite, symmetric and
 *     not negative on its diagonal;
 *   - a refused image changes nothing in the estimator but one counter;
 *   - no byte before or behind the estimator and the estimate is touched.
 * Floats are judged by bits and by integer comparison of bits alone: the test must also work for a library that was
 * compiled, and a program that was linked, with -ffast-math. GOE_TEST_SEED and GOE_TEST_UPDATES set seed and length. */
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "refined/goe_gate.h"
#include "refined/goe_scatter.h"
#include "scene.h"

#define UPDATES_EACH 60000
#define SCATTER_MAX 400.0f /* 21 times the configured variance, 19 for residuals with a correlation of 0.9 */
#define GUARD_BYTES 64
#define GUARD 0xC3

static struct {
    unsigned char before[GUARD_BYTES];
    goe_estimator_t estimator;
    unsigned char between[GUARD_BYTES];
    goe_estimate_t estimate;
    unsigned char behind[GUARD_BYTES];
} memory;

static check_random_t any;
static uint32_t statuses[32]; /* how often each status came, by status + 16 */

void setUp(void) {
    memset(&memory, GUARD, sizeof memory);
    memset(statuses, 0, sizeof statuses);
}
void tearDown(void) {}

static int updates_each(void) {
    const char *wanted = getenv("GOE_TEST_UPDATES");
    return wanted ? (int)strtol(wanted, NULL, 0) : UPDATES_EACH;
}

static uint32_t below(uint32_t limit) { return check_random_bits(&any) % limit; }
static bool one_in(uint32_t n) { return below(n) == 0u; }
static float between(double low, double high) { return (float)check_random_between(&any, low, high); }

/* -------------------------------------------------------------------------------------------------------- invariants -- */

static void check_guard(const unsigned char *bytes) {
    for (int i = 0; i < GUARD_BYTES; i++) {
        TEST_ASSERT_EQUAL_HEX8(GUARD, bytes[i]);
    }
}

static void check_finite(const float *numbers, size_t count, const char *what) {
    for (size_t i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, &numbers[i], sizeof bits);
        TEST_ASSERT_TRUE_MESSAGE((bits & 0x7F800000u) != 0x7F800000u, what);
    }
}

/* |x| <= limit, by the order of the bits. */
static bool within(const float *x, float limit) {
    uint32_t bits;
    uint32_t limit_bits;
    memcpy(&bits, x, sizeof bits);
    memcpy(&limit_bits, &limit, sizeof limit_bits);
    return (bits & 0x7FFFFFFFu) <= limit_bits;
}

static bool is_negative(const float *x) {
    uint32_t bits;
    memcpy(&bits, x, sizeof bits);
    return bits > 0x80000000u;
}

static bool is_zero(const float *x) { return within(x, 0.0f); }

static void check_zero_unless(unsigned has, const float *x) {
    if (!(memory.estimate.valid & has)) {
        TEST_ASSERT_TRUE(is_zero(x));
    }
}

/* |x| <= share |of|, but for rounding. */
static bool within_share(const float *x, double share, const float *of) {
    return within(x, (float)(share * 1.00001 * fabs((double)*of)));
}

static void check_header(const goe_estimate_t *e) {
    const bool position = (e->valid & GOE_HAS_POSITION) != 0u;
    const int model = (int)e->model;
    const int method = (int)e->method;
    TEST_ASSERT_EQUAL_HEX32(0u, e->valid & ~0x7Fu);
    TEST_ASSERT_TRUE(model == GOE_MODEL_NONE || model == GOE_MODEL_DISC || model == GOE_MODEL_LINE ||
                     model == GOE_MODEL_BOX || model == GOE_MODEL_PRISM);
    TEST_ASSERT_TRUE(position == (model != GOE_MODEL_NONE));
    TEST_ASSERT_TRUE(method >= 0 && method <= (int)memory.estimator.settings.method);
    TEST_ASSERT_TRUE(!position || method != 0);
    TEST_ASSERT_TRUE(model != GOE_MODEL_LINE || method == GOE_METHOD_WINDOW);
    TEST_ASSERT_TRUE((model != GOE_MODEL_BOX && model != GOE_MODEL_PRISM) || method == GOE_METHOD_FILTER);
    TEST_ASSERT_TRUE(!e->fresh || position);
    TEST_ASSERT_TRUE(e->images_used >= 0 &&
                     e->images_used <= (method == GOE_METHOD_FILTER ? INT16_MAX : GOE_WINDOW_MAX));
    TEST_ASSERT_TRUE(!is_negative(&e->age_s) && within(&e->age_s, 4000.5f));
    TEST_ASSERT_TRUE(!e->fresh || is_zero(&e->age_s));
}

static void check_only_valid_fields(const goe_estimate_t *e) {
    const goe_sigma_t *s = &e->sigma;
    const float *positions[] = {&e->x0_m,       &e->z0_m, &e->x_m,  &e->z_m, &e->residual,
                                &e->baseline_m, &s->x0_m, &s->z0_m, &s->x_m, &s->z_m};
    for (size_t i = 0; i < sizeof positions / sizeof positions[0]; i++) {
        check_zero_unless(GOE_HAS_POSITION, positions[i]);
    }
    check_zero_unless(GOE_HAS_WIDTH, &e->width_m);
    check_zero_unless(GOE_HAS_WIDTH, &s->width_m);
    check_zero_unless(GOE_HAS_LENGTH, &e->length_m);
    check_zero_unless(GOE_HAS_LENGTH, &s->length_m);
    check_zero_unless(GOE_HAS_HEIGHT, &e->height_m);
    check_zero_unless(GOE_HAS_HEIGHT, &s->height_m);
    check_zero_unless(GOE_HAS_ORIENTATION, &e->orientation_deg);
    check_zero_unless(GOE_HAS_ORIENTATION, &s->orientation_deg);
    check_zero_unless(GOE_HAS_VELOCITY, &e->velocity_north_m_s);
    check_zero_unless(GOE_HAS_VELOCITY, &e->velocity_east_m_s);
    check_zero_unless(GOE_HAS_VELOCITY, &s->velocity_north_m_s);
    check_zero_unless(GOE_HAS_VELOCITY, &s->velocity_east_m_s);
    check_zero_unless(GOE_HAS_CENTER, &e->center_north_m);
    check_zero_unless(GOE_HAS_CENTER, &e->center_east_m);
    check_zero_unless(GOE_HAS_CENTER, &s->center_north_m);
    check_zero_unless(GOE_HAS_CENTER, &s->center_east_m);
}

static void check_ranges(const goe_estimate_t *e) {
    const float *never_negative[] = {&e->width_m,    &e->length_m, &e->height_m, &e->residual,
                                     &e->baseline_m, &e->nis,      &e->nis_ratio};
    for (size_t i = 0; i < sizeof never_negative / sizeof never_negative[0]; i++) {
        TEST_ASSERT_FALSE(is_negative(never_negative[i]));
    }
    const float *sigmas = &e->sigma.x0_m;
    for (size_t i = 0; i < sizeof e->sigma / sizeof(float); i++) {
        TEST_ASSERT_FALSE(is_negative(&sigmas[i]));
    }
    TEST_ASSERT_TRUE(within(&e->orientation_deg, 90.0f) && within(&e->front_orientation_deg, 90.0f));
    TEST_ASSERT_TRUE(within(&e->length_axis[0], 1.000001f) && within(&e->width_axis[1], 1.000001f));
    TEST_ASSERT_TRUE(e->nis_rows >= 0 && e->nis_rows <= 9);
    TEST_ASSERT_TRUE(e->nis_rows > 0 || is_zero(&e->nis));
}

/* By how much the track's own scatter widens what the filter found. */
static double widening(void) {
    const goe_filter_t *filter = &memory.estimator.filter;
    const float factor =
        goe_scatter_factor(filter, goe_gate_repeated(filter, memory.estimator.settings.detector.point_correlation));
    TEST_ASSERT_TRUE(factor >= 1.0f && factor <= SCATTER_MAX);
    return sqrt((double)factor);
}

/* One sigma of the height above the obstacle's ground: it silences no height of the top. */
static double ground_sd_m(void) {
    const goe_filter_t *filter = &memory.estimator.filter;
    return sqrt((double)goe_filter_variance(filter, GOE_GROUND)) / (double)filter->state[GOE_INVERSE_RANGE];
}

/* What the foot lies above the altimeter's zero may be hidden. */
static double hidden_m(void) {
    const goe_filter_t *filter = &memory.estimator.filter;
    return fmax(-(double)filter->state[GOE_GROUND] / (double)filter->state[GOE_INVERSE_RANGE], 0.0);
}

/* By how much a slope of the ground, which silences nothing, widens a sigma at most. */
static double sloping(void) {
    const goe_filter_t *filter = &memory.estimator.filter;
    const double range_m = 1.0 / (double)filter->state[GOE_INVERSE_RANGE];
    const double rise_m = (double)memory.estimator.settings.navigation.terrain_slope_sd * range_m;
    const double variance = (double)filter->datum.taken_m2 + rise_m * rise_m;
    const double level = fmax((double)filter->datum.taken_m2, 1.0e-3 * variance);
    return sqrt(1.0 + ground_sd_m() * ground_sd_m() * fmax(1.0 / level - 1.0 / variance, 0.0));
}

/* What goe_sigma_t says of the filter method. */
static void check_refined(const goe_estimate_t *e) {
    static const float two_meters = 2.0f;
    const goe_sigma_t *s = &e->sigma;
    if (e->method != GOE_METHOD_FILTER || !(e->valid & GOE_HAS_POSITION)) {
        return;
    }
    if (!e->fresh) { /* of a filter that may have started again since */
        return;
    }
    const double x_m = (double)e->x0_m - (double)memory.estimator.filter.axes.start_dx_m;
    const double z_m = (double)e->z0_m - (double)memory.estimator.filter.axes.start_dz_m;
    const float range_m = (float)sqrt(x_m * x_m + z_m * z_m);
    TEST_ASSERT_FALSE(is_zero(&range_m));
    TEST_ASSERT_TRUE(within(&e->x0_m, 1.0e6f) && within(&e->z0_m, 1.0e6f) && within(&s->x_m, 1.0e6f));
    if (e->model == GOE_MODEL_PRISM || e->model == GOE_MODEL_DISC) {
        /* unobservable depth widens the sigmas and silences none */
        TEST_ASSERT_TRUE(within(&s->z_m, 1.0e6f) && within(&s->width_m, 1.0e6f) && within(&s->height_m, 1.0e6f));
        TEST_ASSERT_FALSE(e->valid & (GOE_HAS_ORIENTATION | GOE_HAS_LENGTH));
        return;
    }
    const double wider = widening() * sloping(); /* scatter and slope widen a sigma, and silence none */
    const double share = (double)memory.estimator.settings.filter.range_sd_rel_max;
    TEST_ASSERT_TRUE(within_share(&s->z_m, share * wider, &range_m));
    TEST_ASSERT_TRUE(within_share(&s->width_m, 0.3 * wider, &e->width_m));
    TEST_ASSERT_TRUE(within_share(&s->length_m, 0.3 * wider, &e->length_m));
    const double size_m = within(&e->height_m, two_meters) ? (double)two_meters : (double)e->height_m;
    TEST_ASSERT_TRUE(within(&s->height_m, (float)(1.001 * wider * (0.3 * size_m + ground_sd_m()) + hidden_m())));
    TEST_ASSERT_TRUE(within(&s->orientation_deg, (float)(10.001 * wider)));
}

static void check_covariance(const goe_estimate_t *e) {
    float covariance[GOE_QUANTITIES][GOE_QUANTITIES];
    memset(covariance, 0xFF, sizeof covariance);
    const goe_status_t status = goe_covariance(&memory.estimator, covariance);
    CHECK_STATUS((e->valid & GOE_HAS_POSITION) ? GOE_OK : GOE_CONVERGING, status);
    check_finite(&covariance[0][0], (size_t)GOE_QUANTITIES * GOE_QUANTITIES, "covariance");
    for (int i = 0; i < GOE_QUANTITIES; i++) {
        TEST_ASSERT_FALSE(is_negative(&covariance[i][i]));
        for (int j = 0; j < i; j++) {
            CHECK_SAME(covariance[i][j], covariance[j][i]);
        }
    }
}

static float any_bits(void) { return check_from_bits(check_random_bits(&any)); }

/* A finite number of any size within the limit, its ends and zeros more often than by chance. */
static float any_within(float limit) {
    const float sign = one_in(2) ? -1.0f : 1.0f;
    switch (below(8)) {
        case 0:
            return sign * limit;
        case 1:
            return sign * 0.0f;
        case 2:
            return sign * check_from_bits(1u + below(0x00800000u)); /* subnormal */
        case 3:
        case 4:
            return sign * check_from_bits(0x2F800000u + below(check_bits(limit) - 0x2F800000u)); /* any exponent */
        default:
            return between(-(double)limit, (double)limit);
    }
}

/* A intent of numbers that make sense, of extremes, or of bits. */
static goe_intent_t any_intent(bool *legal) {
    goe_intent_t intent;
    const bool bits = one_in(4);
    for (int i = 0; i < 3; i++) {
        intent.velocity_ned_m_s[i] = bits ? any_bits() : any_within(one_in(2) ? 30.0f : 1.0e3f);
    }
    intent.margin_m = bits ? any_bits() : fabsf(any_within(1.0e4f));
    intent.clearance_m = bits ? any_bits() : fabsf(any_within(1.0e4f));
    intent.since_image_s = bits ? any_bits() : fabsf(any_within(1.0e3f));
    intent.velocity_sd_m_s = bits ? any_bits() : fabsf(any_within(1.0e2f));
    *legal = !bits;
    return intent;
}

static void check_hazard(const goe_estimate_t *e) {
    static const float one = 1.0f;
    bool legal;
    goe_hazard_t hazard;
    const goe_intent_t intent = any_intent(&legal);
    memset(&hazard, 0xFF, sizeof hazard);
    const int status = (int)goe_hazard(&memory.estimator, &intent, &hazard);
    const int expected = (e->valid & GOE_HAS_POSITION) ? GOE_OK : GOE_CONVERGING;
    TEST_ASSERT_TRUE(status == expected || (!legal && (status == GOE_NOT_FINITE || status == GOE_OUT_OF_RANGE)));
    const float numbers[] = {hazard.tcpa_s,    hazard.dcpa_m,         hazard.clearance_m,         hazard.tcpa_sd_s,
                             hazard.dcpa_sd_m, hazard.clearance_sd_m, hazard.conflict_probability};
    check_finite(numbers, sizeof numbers / sizeof numbers[0], "hazard");
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        TEST_ASSERT_TRUE(i == 2 || !is_negative(&numbers[i]));
        TEST_ASSERT_TRUE(status == GOE_OK || is_zero(&numbers[i]));
    }
    TEST_ASSERT_TRUE(within(&hazard.conflict_probability, one));
    TEST_ASSERT_TRUE(hazard.has_clearance || (is_zero(&hazard.clearance_m) && is_zero(&hazard.clearance_sd_m)));
    TEST_ASSERT_TRUE(!hazard.has_clearance || (e->valid & GOE_HAS_HEIGHT) != 0u);
}

static void check_estimate(void) {
    const goe_estimate_t *e = &memory.estimate;
    const size_t floats = (sizeof(goe_estimate_t) - offsetof(goe_estimate_t, age_s)) / sizeof(float);
    check_finite(&e->age_s, floats,
                 "estimate"); /* age_s and all behind it are floats, or a count that looks like one */
    check_header(e);
    check_only_valid_fields(e);
    check_ranges(e);
    check_refined(e);
    check_covariance(e);
    check_hazard(e);
}

static void check_filter(const goe_filter_t *filter) {
    TEST_ASSERT_TRUE(filter->phase <= 3u);
    TEST_ASSERT_TRUE(filter->health.images >= 0 && filter->health.nis_rows >= 0);
    const float sums[] = {filter->health.recent_nis, filter->health.nis, filter->health.mean_nis};
    check_finite(sums, 3, "residuals");
    check_finite(filter->scatter.before, GOE_SERIES + 2, "scatter");
    if (filter->phase != 0u) { /* otherwise the next image starts it again */
        check_finite(filter->state, GOE_STATES, "state");
        check_finite(filter->root.element, sizeof filter->root.element / sizeof(float), "root");
    }
#if GOE_AUGMENTED
    check_finite(filter->root.right, GOE_AUGMENTED, "right-hand side");
    check_finite(filter->mover.augmented, GOE_AUGMENTED, "latency, velocity");
#endif
}

static void check_state(void) {
    const goe_estimator_t *e = &memory.estimator;
    check_finite(e->camera_to_body[0], 9, "mounting");
    check_finite(&e->motion.heading_cos, 2, "heading");
    check_finite(e->motion.origin_ne_m, 2, "origin");
    check_finite(&e->motion.dx_m, 2, "displacement");
    check_finite(&e->window.disc.point[0].dx_m, 4 * GOE_WINDOW_MAX, "disc window");
    check_finite(&e->window.line.point[0].dx_m, 4 * GOE_WINDOW_MAX, "line window");
    check_finite(e->window.length.value, GOE_WINDOW_MAX, "lengths");
    check_finite(e->window.height.value, GOE_WINDOW_MAX, "heights");
    check_finite(&e->window.orientation.filtered_deg, 3, "orientation");
    check_filter(&e->filter);
    TEST_ASSERT_TRUE(e->window.disc.next >= 0 && e->window.disc.next < e->settings.window.points);
    TEST_ASSERT_TRUE(e->window.line.next >= 0 && e->window.line.next < e->settings.window.points);
    TEST_ASSERT_TRUE(e->window.length.next >= 0 && e->window.length.next < e->settings.window.points);
    TEST_ASSERT_TRUE(e->window.height.next >= 0 && e->window.height.next < e->settings.window.points);
}

/* From the latest image taken to the newest refused one: at most 1000 s. */
static float refused_s(const goe_estimator_t *before, int64_t image_us) {
    const uint64_t span_us = (uint64_t)image_us - (uint64_t)before->motion.time_us;
    const float since_s = (float)(span_us < 1000000000u ? (uint32_t)span_us : 1000000000u) * 1.0e-6f;
    return image_us > before->motion.time_us && since_s > before->estimate.age_s ? since_s : before->estimate.age_s;
}

static void update_and_check(const goe_image_t *image) {
    static goe_estimator_t before;
    memcpy(&before, &memory.estimator, sizeof before);
    memset(&memory.estimate, 0xFF, sizeof memory.estimate); /* NaN, if it were left so */
    const int status = (int)goe_update(&memory.estimator, image, &memory.estimate);
    TEST_ASSERT_TRUE(status >= GOE_NO_HEIGHT && status <= GOE_NO_DETECTION);
    statuses[status + 16]++;
    if (!GOE_IMAGE_TAKEN(status)) {
        before.fault_counts[-status]++;
        before.estimate.age_s = refused_s(&before, image->pose.time_us);
        TEST_ASSERT_EQUAL_MEMORY(&before, &memory.estimator, sizeof before);
    }
    TEST_ASSERT_EQUAL_INT(status == GOE_OK || status == GOE_PARTIAL, memory.estimate.fresh);
    check_estimate();
    check_state();
    check_guard(memory.before);
    check_guard(memory.between);
    check_guard(memory.behind);
}

/* -------------------------------------------------------------------------------------------------------------- input -- */

static void start(const goe_settings_t *settings) {
    CHECK_STATUS(GOE_OK, goe_init(&memory.estimator, sizeof memory.estimator, settings, NULL));
}

/* From `least` to `most`, the ends more often than by chance, and small ones as often as large ones. */
static float any_from(float least, float most) {
    switch (below(4)) {
        case 0:
            return least;
        case 1:
            return most;
        default:
            return check_from_bits(check_bits(least) + below(check_bits(most) - check_bits(least)));
    }
}

/* goe_init() refuses a size that focal length and principal point contradict. */
static float fitting(float size_px, float focal_px, float center_px) {
    const float size = size_px > 20.0f * focal_px ? 19.9f * focal_px : size_px;
    const float beyond = fmaxf(-center_px, center_px - size);
    return beyond <= 1.49f * focal_px ? size : 0.0f;
}

static void any_noise(goe_settings_t *s) {
    s->detector.point_noise_px = any_from(0.05f, 100.0f);
    s->detector.point_noise_rel = any_from(0.0f, 1.0f);
    s->detector.point_correlation = any_from(0.0f, 0.95f);
    s->detector.shape_error_rel = any_from(0.0f, 1.0f);
    s->navigation.attitude_bias_sd_deg = any_from(1.0e-3f, 30.0f);
    s->navigation.attitude_white_sd_deg = any_from(1.0e-4f, 30.0f);
    s->navigation.attitude_walk_sd_deg = any_from(0.0f, 30.0f);
    s->navigation.height_bias_sd_m = any_from(1.0e-3f, 1.0e3f);
    s->navigation.velocity_bias_sd_m_s = any_from(0.0f, 100.0f);
    s->navigation.position_walk_sd_m = any_from(0.0f, 100.0f);
    s->filter.prior_width_m = any_from(0.1f, 1.0e3f);
    s->filter.gate_sigma = any_from(1.0f, 100.0f);
    s->filter.huber_sigma = any_from(0.5f, 100.0f);
    s->filter.nis_ratio_max = any_from(1.0e-2f, 1.0e3f);
    s->filter.range_sd_rel_max = any_from(0.01f, 10.0f);
    s->detector.box_noise_px = any_from(0.05f, 100.0f);
    s->detector.box_noise_rel = any_from(0.0f, 1.0f);
    s->detector.box_correlation_time_s = any_from(0.0f, 10.0f);
    s->detector.truncation_noise_rel = any_from(0.0f, 10.0f);
    s->navigation.position_white_sd_m = any_from(0.0f, 100.0f);
    s->navigation.terrain_height_sd_m = any_from(0.0f, 1.0e3f);
    s->camera.width_px = fitting(any_from(0.0f, 1.0e5f), s->camera.fx_px, s->camera.cx_px);
    s->camera.height_px = fitting(any_from(0.0f, 1.0e5f), s->camera.fy_px, s->camera.cy_px);
    s->camera.border_rel = any_from(0.0f, 0.5f);
    s->camera.truncation_rel = any_from(0.0f, 0.5f);
}

static goe_settings_t any_settings(void) {
    goe_settings_t s;
    goe_settings_default(&s);
    s.camera.fx_px = one_in(3) ? 1.0f : one_in(3) ? 1.0e5f : between(1.0, 2000.0);
    s.camera.fy_px = one_in(3) ? 1.0f : one_in(3) ? 1.0e5f : between(1.0, 2000.0);
    s.camera.cx_px = any_within(1.0e5f);
    s.camera.cy_px = any_within(1.0e5f);
    s.camera.width_px = s.camera.height_px = 0.0f;
    if (one_in(2)) {
        s.camera.cx_px = 0.0f;
        s.camera.cy_px = 0.0f;
    }
    if (one_in(3)) {
        s.camera.k1 = any_within(100.0f);
        s.camera.k2 = any_within(100.0f);
        s.camera.p1 = any_within(100.0f);
        s.camera.p2 = any_within(100.0f);
        s.camera.k3 = any_within(100.0f);
    }
    s.camera.mount_yaw_deg = any_within(360.0f);
    s.camera.mount_pitch_deg = any_within(360.0f);
    s.camera.mount_roll_deg = any_within(360.0f);
    for (int i = 0; i < 3; i++) {
        s.camera.offset_m[i] = one_in(2) ? 0.0f : any_within(1.0e4f);
    }
    s.model = (goe_model_t)(GOE_MODEL_AUTO + (int)below(3));
    s.heading_auto = one_in(2);
    s.heading_deg = any_within(360.0f);
    s.window.points = 3 + (int)below(GOE_WINDOW_MAX - 2);
    s.window.line_points = 1 + (int)below(one_in(2) ? 5 : 1000);
    s.window.edge_min_px = one_in(2) ? 0.0f : between(0.0, 20.0);
    s.window.orientation_min_px = one_in(2) ? 0.0f : between(0.0, 5.0);
    s.window.side_min_px = one_in(2) ? 0.1f : between(0.1, 20.0);
    s.window.orientation_memory = 1 + (int)below(one_in(2) ? 3 : 1000);
    s.window.min_baseline_m = one_in(2) ? 1.0e-3f : between(1.0e-3, 10.0);
    s.method = one_in(4) ? GOE_METHOD_WINDOW : GOE_METHOD_FILTER;
    s.filter.top_is_highest = one_in(2);
    if (one_in(2)) {
        any_noise(&s);
    }
    return s;
}

static goe_pixel_t any_pixel(float (*number)(void)) {
    goe_pixel_t pixel;
    pixel.u_px = number();
    pixel.v_px = number();
    pixel.visible = !one_in(8);
    return pixel;
}

static float any_own_noise(float (*number)(void)) {
    return one_in(2) ? 0.0f : one_in(60) ? number() : any_from(0.0f, 30.0f);
}

static void fill_features(goe_image_t *image, float (*number)(void)) {
    image->left = any_pixel(number);
    image->right = any_pixel(number);
    image->top = any_pixel(number);
    image->base_left = any_pixel(number);
    image->base_near = any_pixel(number);
    image->base_right = any_pixel(number);
    image->box.left_px = number();
    image->box.top_px = number();
    image->box.right_px = number();
    image->box.bottom_px = number();
    image->box.sides = (uint8_t)(one_in(4) ? below(256) : 0u);
    image->noise.attitude_sd_deg = any_own_noise(number);
    image->noise.height_sd_m = any_own_noise(number);
    image->noise.pixel_sd_px = any_own_noise(number);
}

static void any_attitude(float q[4]) {
    float norm2 = 0.0f;
    do {
        norm2 = 0.0f;
        for (int i = 0; i < 4; i++) {
            q[i] = one_in(4) ? 0.0f : between(-1.0, 1.0);
            norm2 += q[i] * q[i];
        }
    } while (norm2 < 0.01f);
    float root = 1.0f;
    for (int i = 0; i < 30; i++) {
        root = 0.5f * (root + norm2 / root);
    }
    for (int i = 0; i < 4; i++) {
        q[i] /= root;
    }
}

/* -------------------------------------------------------------------------------------------------------------- tests -- */

static void note_statuses(const char *what) {
    UnityPrint(what);
    UnityPrint(":");
    for (int i = 0; i < 32; i++) {
        if (statuses[i] > 0) {
            UnityPrint(" ");
            UnityPrint(goe_status_text((goe_status_t)(i - 16)));
            UnityPrint(" ");
            UnityPrintNumberUnsigned(statuses[i]);
        }
    }
    UNITY_PRINT_EOL();
}

/* [A11, A16, A17, A18, A21, A25, GOE_IMAGE_TAKEN, goe_estimate_t.fresh, goe_estimate_t.valid, goe_hazard, goe_update]
 * GIVEN images of which every number is a random bit pattern, NaNs and infinities among them */
static void random_bits_do_no_harm(void) {
    any = check_random_start("random bits");
    goe_settings_t settings = any_settings();
    start(&settings);
    const int updates = updates_each();
    for (int n = 0; n < updates; n++) {
        goe_image_t image;
        memset(&image, 0, sizeof image);
        fill_features(&image, any_bits);
        for (int i = 0; i < 3; i++) {
            image.pose.position_ned_m[i] = any_bits();
            image.pose.reset_delta_ned_m[i] = any_bits();
        }
        for (int i = 0; i < 4; i++) {
            image.pose.attitude[i] = any_bits();
        }
        image.pose.height_m = any_bits();
        image.pose.time_us = (int64_t)(((uint64_t)check_random_bits(&any) << 32) | check_random_bits(&any));
        image.pose.reset_count = (uint8_t)below(256);
        image.pose.reset_delta_known = one_in(2);
        update_and_check(&image);
    }
    note_statuses("random bits");
    TEST_ASSERT_GREATER_THAN_UINT32((uint32_t)updates / 30u, statuses[16 + GOE_NOT_FINITE]);
}

static float pixel_near(void) { return between(-3.0, 3.0); }
static float pixel_anywhere(void) { return any_within(1.0e5f); }
static float pixel_usual(void) { return between(-700.0, 700.0); }

static void order_box(goe_box_t *box) {
    const goe_box_t b = *box;
    box->left_px = b.left_px < b.right_px ? b.left_px : b.right_px;
    box->right_px = b.left_px < b.right_px ? b.right_px : b.left_px;
    box->top_px = b.top_px < b.bottom_px ? b.top_px : b.bottom_px;
    box->bottom_px = b.top_px < b.bottom_px ? b.bottom_px : b.top_px;
}

/* [A16, A18, A25, A31, GOE_HAS_POSITION, goe_covariance, goe_estimate_t.method, goe_estimate_t.model, goe_estimate_t.valid, goe_update,
 * filter.range_sd_rel_max]
 * GIVEN finite images within the ranges, their extremes preferred, under settings of which the same holds */
static void extremes_do_no_harm(void) {
    static float (*const numbers[])(void) = {pixel_near, pixel_anywhere, pixel_usual};
    any = check_random_start("extremes");
    const int updates = updates_each();
    int64_t now = 0;
    float (*number)(void) = pixel_near;
    float reach = 1.0f;
    bool still = true;
    for (int n = 0; n < updates; n++) {
        goe_image_t image;
        if (n % 50 == 0) {
            goe_settings_t settings = any_settings();
            start(&settings);
            now = one_in(4) ? INT64_MIN + 1 : 0;
            number = numbers[below(3)];
            reach = one_in(3) ? 1.0e6f : between(1.0e-4, 1000.0);
            still = one_in(2);
        }
        memset(&image, 0, sizeof image);
        fill_features(&image, number);
        if (!one_in(4)) { /* in image order, or hardly anything is ever solved */
            float *const order[] = {&image.base_left.u_px, &image.base_near.u_px, &image.base_right.u_px};
            for (int i = 0; i < 3; i++) {
                const int j = i < 2 ? i : 0;
                if (*order[j] > *order[j + 1]) {
                    const float swap = *order[j];
                    *order[j] = *order[j + 1];
                    *order[j + 1] = swap;
                }
            }
            if (image.left.u_px > image.right.u_px) {
                const float swap = image.left.u_px;
                image.left.u_px = image.right.u_px;
                image.right.u_px = swap;
            }
            order_box(&image.box);
        }
        for (int i = 0; i < 3; i++) {
            image.pose.position_ned_m[i] = any_within(reach);
            image.pose.reset_delta_ned_m[i] = any_within(1.0e6f);
        }
        image.pose.attitude[0] = 1.0f;
        if (!still) {
            any_attitude(image.pose.attitude);
        }
        image.pose.height_m = any_within(1.0e5f);
        now += one_in(100) && now > INT64_MIN ? -1 : one_in(100) ? INT64_C(1) << 60 : 1 + (int64_t)below(100000);
        now = now > (INT64_C(1) << 62) ? INT64_C(1) << 62 : now;
        image.pose.time_us = now;
        image.pose.reset_count = (uint8_t)(one_in(40) ? below(256) : memory.estimator.motion.reset_count);
        image.pose.reset_delta_known = one_in(2);
        update_and_check(&image);
    }
    note_statuses("extremes");
    TEST_ASSERT_GREATER_THAN_UINT32((uint32_t)updates / 1000u, statuses[16 + GOE_OK] + statuses[16 + GOE_PARTIAL]);
}

static void spoil(float *x) {
    if (one_in(60)) {
        *x = one_in(2) ? any_bits() : any_within(1.0e5f);
    } else {
        *x += between(-1.5, 1.5);
    }
}

/* The box of the visible points, in their place. */
static void put_into_box(goe_image_t *image) {
    goe_box_t *box = &image->box;
    box->left_px = image->left.u_px;
    box->right_px = image->right.u_px;
    box->top_px = image->top.v_px;
    box->bottom_px = image->base_near.v_px;
    box->sides =
        (uint8_t)((image->left.visible ? GOE_SIDE_LEFT : 0u) | (image->right.visible ? GOE_SIDE_RIGHT : 0u) |
                  (image->top.visible ? GOE_SIDE_TOP : 0u) | (image->base_near.visible ? GOE_SIDE_BOTTOM : 0u));
    if (!one_in(40)) {
        image->base_left.visible = image->base_near.visible = image->base_right.visible = false;
    }
}

static void any_scene(scene_t *of) {
    scene_t scene;
    scene_default(&scene);
    scene.shape = one_in(3) ? SCENE_CYLINDER : SCENE_BOX;
    scene.path = (scene_path_t)below(3);
    scene.x0_m = (double)between(-60.0, 60.0);
    scene.z0_m = (double)between(40.0, 200.0);
    scene.alpha_deg = (double)between(-90.0, 90.0);
    scene.width_m = (double)between(1.0, 20.0);
    scene.length_m = (double)between(1.0, 40.0);
    scene.height_m = (double)between(1.0, 60.0);
    scene.speed_mps = (double)between(0.0, 40.0);
    scene.wobble_deg = (double)between(0.0, 20.0);
    *of = scene;
}

/* [A16, A31] GIVEN flights that make sense, with pixel noise, broken numbers and missing features now and then */
static void spoiled_flights_do_no_harm(void) {
    any = check_random_start("spoiled flights");
    const int flights = updates_each() / 50;
    for (int f = 0; f < flights; f++) {
        scene_t scene;
        any_scene(&scene);
        goe_settings_t settings = scene_settings(&scene);
        settings.model = (goe_model_t)(GOE_MODEL_AUTO + (int)below(3));
        settings.window.points = 3 + (int)below(GOE_WINDOW_MAX - 2);
        settings.method = one_in(4) ? GOE_METHOD_WINDOW : GOE_METHOD_FILTER;
        settings.filter.top_is_highest = one_in(2);
        if (one_in(3)) {
            any_noise(&settings);
        }
        start(&settings);
        const bool boxed = one_in(3);
        for (int k = 0; k < 50; k++) {
            goe_image_t image;
            scene_image(&scene, k, &image, NULL);
            goe_pixel_t *pixels[] = {&image.left,      &image.right,     &image.top,
                                     &image.base_left, &image.base_near, &image.base_right};
            for (int i = 0; i < 6; i++) {
                spoil(&pixels[i]->u_px);
                spoil(&pixels[i]->v_px);
                pixels[i]->visible = pixels[i]->visible && !one_in(25);
            }
            if (boxed) {
                put_into_box(&image);
            }
            if (one_in(40)) {
                image.pose.attitude[below(4)] = any_bits();
            }
            if (one_in(40)) {
                image.pose.position_ned_m[below(3)] = any_within(1.0e6f);
            }
            if (one_in(60)) {
                image.pose.time_us -= 200000;
            }
            update_and_check(&image);
        }
    }
    note_statuses("spoiled flights");
    TEST_ASSERT_GREATER_THAN_UINT32((uint32_t)flights * 5u, statuses[16 + GOE_OK]);
}

/* What an opponent would show the filter method, one trick for some images, then the next. */
enum {
    HONEST,
    FROZEN,
    SHRINKING,
    BLOWN_UP,
    ONE_OUTLIER,
    LEAPING,
    BASE_ALONE,
    TOP_ALONE,
    ROOF_BELOW,
    ALL_AT_ONE,
    TRICKS
};

static void play_trick(uint32_t trick, int n, goe_image_t *image, const goe_image_t *frozen) {
    goe_pixel_t *pixels[] = {&image->left,      &image->right,     &image->top,
                             &image->base_left, &image->base_near, &image->base_right};
    const goe_pixel_t *still = &frozen->left;
    const float scale = trick == SHRINKING ? 1.0f / (1.0f + 0.05f * (float)n) : trick == BLOWN_UP ? 40.0f : 1.0f;
    const float leap = trick == LEAPING && n % 2 ? 300.0f : 0.0f;
    const float u = image->left.u_px;
    const float v = image->left.v_px;
    for (uint32_t i = 0; i < 6; i++) {
        pixels[i]->u_px = u + (pixels[i]->u_px - u) * scale + leap;
        pixels[i]->v_px = v + (pixels[i]->v_px - v) * scale;
        if (trick == FROZEN) {
            *pixels[i] = still[i];
        }
        if ((trick == BASE_ALONE && i < 3) || (trick == TOP_ALONE && i != 2)) {
            pixels[i]->visible = false;
        }
        if (trick == ALL_AT_ONE) {
            pixels[i]->u_px = u;
            pixels[i]->v_px = v;
        }
    }
    if (trick == ONE_OUTLIER) {
        pixels[(n / 7) % 6]->u_px += 400.0f;
    }
    if (trick == ROOF_BELOW) {
        image->top.v_px = image->base_left.v_px + 50.0f;
    }
}

static bool fits_a_pixel(const goe_pixel_t *pixel) {
    return within(&pixel->u_px, 9.0e4f) && within(&pixel->v_px, 9.0e4f);
}

/* [A16, A18] GIVEN one track of thousands of images that is never reset: flights flown again and again, the whole obstacle tricked,
 * the aircraft standing, leaping, or seconds away from its last image */
static void long_adversarial_tracks_do_no_harm(void) {
    any = check_random_start("long tracks");
    const int tracks = 6;
    const int images = updates_each() / tracks;
    for (int t = 0; t < tracks; t++) {
        scene_t scene;
        goe_image_t frozen;
        uint32_t trick = HONEST;
        int64_t now = 0;
        int k = 0;
        any_scene(&scene);
        goe_settings_t settings = scene_settings(&scene);
        settings.model = (goe_model_t)(GOE_MODEL_AUTO + t % 3);
        settings.filter.top_is_highest = one_in(2);
        if (t >= 3) {
            any_noise(&settings);
        }
        start(&settings);
        scene_image(&scene, 0, &frozen, NULL);
        for (int n = 0; n < images; n++) {
            goe_image_t image;
            if (n % 10 == 0) {
                trick = one_in(2) ? (uint32_t)HONEST : below(TRICKS);
            }
            if (n % 60 == 0) { /* another obstacle, and the flight from its start, without notice */
                any_scene(&scene);
                k = 0;
            }
            k += one_in(50) ? 0 : 1;
            scene_image(&scene, k, &image, NULL);
            play_trick(trick, n, &image, &frozen);
            if (fits_a_pixel(&image.left) && fits_a_pixel(&image.top)) {
                frozen = image;
            }
            if (t % 2 != 0) {
                put_into_box(&image);
            }
            now += one_in(200) ? 3000000000 : one_in(20) ? 1 : 125000;
            image.pose.time_us = now;
            image.pose.height_m = one_in(100) ? between(-50.0, 50.0) : image.pose.height_m;
            update_and_check(&image);
        }
    }
    note_statuses("long tracks");
    TEST_ASSERT_GREATER_THAN_UINT32((uint32_t)updates_each() / 60u, statuses[16 + GOE_OK]);
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(random_bits_do_no_harm);
    RUN_TEST(extremes_do_no_harm);
    RUN_TEST(spoiled_flights_do_no_harm);
    RUN_TEST(long_adversarial_tracks_do_no_harm);
    return UNITY_END();
}
