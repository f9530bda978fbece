/* Whatever answer and intent come in, nothing but finite numbers comes out of goe_hazard. SPDX-License-Identifier: MIT
 *
 * As in test_safety.c floats are judged by their bits alone: the test must also hold with -ffast-math. */
/* tests: lib/hazard/goe_hazard.c */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"

#define CALLS 200000
#define UPDATES_PER_CALL 10 /* of GOE_TEST_UPDATES, which shortens the test where an emulator runs it */

static goe_estimator_t estimator;
static check_random_t any;

void setUp(void) {
    goe_settings_t settings;
    goe_settings_default(&settings);
    settings.camera.fx_px = settings.camera.fy_px = 900.0f;
    settings.camera.cx_px = settings.camera.cy_px = 0.0f;
    settings.camera.width_px = settings.camera.height_px = 0.0f;
    settings.method = GOE_METHOD_WINDOW;
    TEST_ASSERT_EQUAL_INT(GOE_OK, goe_init(&estimator, sizeof estimator, &settings, NULL));
}
void tearDown(void) {}

static uint32_t below(uint32_t limit) { return check_random_bits(&any) % limit; }

/* 0, the limit, any magnitude up to it, or a usual one; either sign */
static float up_to(double limit) {
    const double sign = below(2u) ? 1.0 : -1.0;
    switch (below(6u)) {
        case 0u:
            return 0.0f;
        case 1u:
            return (float)(sign * limit);
        case 2u:
            return (float)(sign * limit * pow(10.0, check_random_between(&any, -40.0, 0.0)));
        default:
            return (float)(sign * fmin(limit, 100.0) * check_random_between(&any, 0.0, 1.0));
    }
}

static float magnitude_up_to(double limit) { return (float)fabs((double)up_to(limit)); }

/* Any answer within the ranges that the library keeps. */
static void give_any_answer(void) {
    goe_estimate_t *e = &estimator.estimate;
    const double orientation = check_random_between(&any, -90.0, 90.0);
    const double b = (below(4u) ? orientation : (double)((int)below(4u) - 1) * 45.0) * 0.017453292519943295;
    memset(e, 0, sizeof *e);
    e->method = GOE_METHOD_WINDOW;
    e->model = below(2u) ? GOE_MODEL_DISC : GOE_MODEL_LINE;
    e->valid = GOE_HAS_POSITION | below(64u);
    e->fresh = below(2u) != 0u;
    e->x_m = up_to(4e6);
    e->z_m = up_to(4e6);
    e->width_m = (e->valid & GOE_HAS_WIDTH) ? magnitude_up_to(1e6) : 0.0f;
    e->length_m = (e->valid & GOE_HAS_LENGTH) ? magnitude_up_to(1e6) : 0.0f;
    e->height_m = (e->valid & GOE_HAS_HEIGHT) ? magnitude_up_to(1e6) : 0.0f;
    e->length_axis[0] = (float)sin(b);
    e->length_axis[1] = (float)cos(b);
    e->width_axis[0] = e->length_axis[1];
    e->width_axis[1] = -e->length_axis[0];
    float *sigma = &e->sigma.x0_m;
    for (size_t i = 0; i < sizeof e->sigma / sizeof(float); i++) {
        sigma[i] = magnitude_up_to(1e9);
    }
    e->sigma.orientation_deg = magnitude_up_to(90.0);
    estimator.motion.heading_cos = 1.0f;
    estimator.motion.height_m = up_to(1e5);
    if (below(2u)) {
        estimator.motion.heading_cos = (float)cos(b * 4.0);
        estimator.motion.heading_sin = (float)sin(b * 4.0);
    }
}

static uint32_t magnitude(const float *x) {
    uint32_t bits;
    memcpy(&bits, x, sizeof bits);
    return bits & 0x7FFFFFFFu;
}

static void check_reported(const goe_hazard_t *h) {
    static const float most = 1.0e9f;
    static const float one = 1.0f;
    const float *numbers[] = {&h->tcpa_s,    &h->dcpa_m,    &h->clearance_m,   &h->conflict_probability,
                              &h->tcpa_sd_s, &h->dcpa_sd_m, &h->clearance_sd_m};
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        TEST_ASSERT_TRUE(magnitude(numbers[i]) <= magnitude(&most));
        if (numbers[i] != &h->clearance_m) { /* the only one that may be negative */
            uint32_t bits;
            memcpy(&bits, numbers[i], sizeof bits);
            TEST_ASSERT_TRUE(bits <= 0x80000000u);
        }
    }
    TEST_ASSERT_TRUE(magnitude(&h->conflict_probability) <= magnitude(&one));
}

static int calls(void) {
    const char *wanted = getenv("GOE_TEST_UPDATES");
    return wanted ? (int)strtol(wanted, NULL, 0) / UPDATES_PER_CALL : CALLS;
}

/* [A16, A23, goe_affine.c, goe_hazard_t.conflict_probability] */
static void any_answer_and_plan_give_finite_numbers(void) {
    for (int i = 0; i < calls(); i++) {
        const goe_intent_t intent = {{up_to(1e3), up_to(1e3), up_to(1e3)},
                                     magnitude_up_to(1e4),
                                     magnitude_up_to(1e4),
                                     magnitude_up_to(1e3),
                                     magnitude_up_to(1e2)};
        goe_hazard_t hazard;
        give_any_answer();
        const goe_estimator_t before = estimator;
        memset(&hazard, 0xFF, sizeof hazard);
        CHECK_STATUS(GOE_OK, goe_hazard(&estimator, &intent, &hazard));
        check_reported(&hazard);
        TEST_ASSERT_EQUAL_MEMORY(&before, &estimator, sizeof before);
    }
}

static void any_bits_of_a_plan_are_refused_or_answered(void) {
    for (int i = 0; i < calls(); i++) {
        goe_intent_t intent;
        goe_hazard_t hazard;
        uint32_t bits[7];
        for (int j = 0; j < 7; j++) {
            bits[j] = below(3u) ? check_random_bits(&any) : 0x3F800000u;
        }
        memcpy(intent.velocity_ned_m_s, bits, 3u * sizeof bits[0]);
        memcpy(&intent.margin_m, &bits[3], sizeof bits[3]);
        memcpy(&intent.clearance_m, &bits[4], sizeof bits[4]);
        memcpy(&intent.since_image_s, &bits[5], sizeof bits[5]);
        memcpy(&intent.velocity_sd_m_s, &bits[6], sizeof bits[6]);
        give_any_answer();
        memset(&hazard, 0xFF, sizeof hazard);
        bool finite = true;
        for (int j = 0; j < 7; j++) {
            finite = finite && (bits[j] & 0x7F800000u) != 0x7F800000u;
        }
        const goe_status_t status = goe_hazard(&estimator, &intent, &hazard);
        TEST_ASSERT_TRUE(finite ? status == GOE_OK || status == GOE_OUT_OF_RANGE : status == GOE_NOT_FINITE);
        check_reported(&hazard);
    }
}

int main(void) {
    UNITY_BEGIN();
    any = check_random_start("safety of the hazard");
    RUN_TEST(any_answer_and_plan_give_finite_numbers);
    RUN_TEST(any_bits_of_a_plan_are_refused_or_answered);
    return UNITY_END();
}
