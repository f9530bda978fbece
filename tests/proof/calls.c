/* One entry for each public call: any arguments, any estimator. SPDX-License-Identifier: MIT */
#include "any.h"

static void update(int method) {
    goe_estimator_t estimator;
    goe_image_t image;
    goe_estimate_t estimate;
    any_estimator(&estimator, method);
    ANY_BITS(image);
    image.camera = 0; /* any other is refused: update_refuses() */
    (void)goe_update(&estimator, &image, &estimate);
}

void proof_update_window(void) { update(GOE_METHOD_WINDOW); }
void proof_update_refined(void) { update(GOE_METHOD_FILTER); }

/* Null pointers, memory that was never initialized, an image of a camera that does not exist. */
static void update_refuses(void) {
    goe_estimator_t estimator;
    goe_image_t image;
    goe_estimate_t estimate;
    any_estimator(&estimator, 0);
    ANY_BITS(image);
    image.camera = (uint8_t)ANY(1, UINT8_MAX);
    (void)goe_update(&estimator, &image, &estimate);
    ANY_BITS(estimator);
    ANY_BITS(image);
    estimator.ready = 0;
    estimator.seal.sum = 0;
    (void)goe_update(NULL, &image, &estimate);
    (void)goe_update(&estimator, NULL, &estimate);
    (void)goe_update(&estimator, &image, NULL);
}

static void init(void) {
    goe_estimator_t estimator;
    goe_settings_t settings;
    const char *bad;
    goe_settings_default(NULL);
    goe_settings_default(&settings);
    ANY_BITS(settings);
    (void)goe_init(NULL, sizeof estimator, &settings, &bad);
    (void)goe_init(&estimator, sizeof estimator, NULL, NULL);
    (void)goe_init(&estimator, (size_t)ANY(0, INT32_MAX), &settings, ANY_TRUTH() ? &bad : NULL);
}

static void reset(void) {
    goe_estimator_t estimator;
    any_estimator(&estimator, 0);
    (void)goe_reset(NULL);
    (void)goe_reset(&estimator);
}

void proof_covariance(void) {
    goe_estimator_t estimator;
    float covariance[GOE_QUANTITIES][GOE_QUANTITIES];
    any_estimator(&estimator, 0);
    (void)goe_covariance(&estimator, NULL);
    (void)goe_covariance(NULL, covariance);
    (void)goe_covariance(&estimator, covariance);
}

void proof_hazard(void) {
    goe_estimator_t estimator;
    goe_intent_t intent;
    goe_hazard_t hazard;
    any_estimator(&estimator, 0);
    ANY_BITS(intent);
    (void)goe_hazard(NULL, &intent, &hazard);
    (void)goe_hazard(&estimator, NULL, &hazard);
    (void)goe_hazard(&estimator, &intent, NULL);
    (void)goe_hazard(&estimator, &intent, &hazard);
}

void proof_decide(void) {
    goe_estimator_t estimator;
    goe_intent_t intent;
    goe_rule_t rule;
    goe_hazard_t hazard;
    any_estimator(&estimator, 0);
    ANY_BITS(intent);
    ANY_BITS(rule);
    ANY_BITS(hazard);
    goe_rule_default(NULL);
    (void)goe_earliest_tcpa_s(NULL);
    (void)goe_earliest_tcpa_s(&hazard);
    (void)goe_decide(NULL, &intent, &rule, &hazard);
    (void)goe_decide(&estimator, NULL, &rule, &hazard);
    (void)goe_decide(&estimator, &intent, &rule, ANY_TRUTH() ? &hazard : NULL);
    goe_rule_default(&rule);
    (void)goe_decide(&estimator, &intent, NULL, NULL);
}

static void texts(void) {
    int number;
    ANY_BITS(number);
    (void)goe_status_text((goe_status_t)number);
    (void)goe_reason_text((goe_reason_t)number);
}

static void self_check(void) { (void)goe_self_check(); }

/* The calls that are analyzed quickly. */
void proof_short_calls(void) {
    update_refuses();
    init();
    reset();
    texts();
    self_check();
}
