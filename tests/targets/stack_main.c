/* Prints the stack depth of each public function over the embedded logs. SPDX-License-Identifier: MIT
 *
 *   stack <function> <bytes>
 *
 * The stack is painted before each call. The arguments on the stack belong to the caller. */
#include "replay.h"
#include "semihosting.h"
#include "stack.h"

typedef struct {
    size_t update[REPLAY_METHODS], covariance, hazard, rule, decide, soonest, init, reset, defaults, text, self_check;
} depth_t;

static goe_estimator_t estimator;
static goe_settings_t settings;
static goe_image_t image;
static goe_estimate_t estimate;
static depth_t deepest;

static void keep_larger(size_t *largest, size_t value) {
    if (value > *largest) {
        *largest = value;
    }
}

__attribute__((noinline)) static size_t depth_of_update(void) {
    port_stack_paint();
    (void)goe_update(&estimator, &image, &estimate);
    return port_stack_used();
}

__attribute__((noinline)) static size_t depth_of_init(void) {
    port_stack_paint();
    const goe_status_t status = goe_init(&estimator, sizeof estimator, &settings, NULL);
    return status == GOE_OK ? port_stack_used() : 0u;
}

__attribute__((noinline)) static size_t depth_of_reset(void) {
    port_stack_paint();
    (void)goe_reset(&estimator);
    return port_stack_used();
}

__attribute__((noinline)) static size_t depth_of_defaults(void) {
    static goe_settings_t defaults;
    port_stack_paint();
    goe_settings_default(&defaults);
    return port_stack_used();
}

__attribute__((noinline)) static size_t depth_of_text(void) {
    port_stack_paint();
    (void)goe_status_text(GOE_CORRUPTED);
    return port_stack_used();
}

__attribute__((noinline)) static size_t depth_of_reason(void) {
    port_stack_paint();
    (void)goe_reason_text(GOE_REASON_NOISE);
    return port_stack_used();
}

__attribute__((noinline)) static size_t depth_of_self_check(void) {
    port_stack_paint();
    (void)goe_self_check();
    return port_stack_used();
}

__attribute__((noinline)) static size_t depth_of_covariance(void) {
    static float covariance[GOE_QUANTITIES][GOE_QUANTITIES];
    port_stack_paint();
    (void)goe_covariance(&estimator, covariance);
    return port_stack_used();
}

__attribute__((noinline)) static size_t depth_of_hazard(void) {
    static const goe_intent_t intent = {{15.0f, 1.0f, -0.5f}, 10.0f, 5.0f, 0.0f, 0.0f};
    static goe_hazard_t hazard;
    port_stack_paint();
    const goe_status_t status = goe_hazard(&estimator, &intent, &hazard);
    return status == GOE_OK ? port_stack_used() : 0u;
}

__attribute__((noinline)) static size_t depth_of_rule(void) {
    static goe_rule_t rule;
    port_stack_paint();
    goe_rule_default(&rule);
    return port_stack_used();
}

__attribute__((noinline)) static size_t depth_of_decide(void) {
    static const goe_intent_t intent = {{15.0f, 1.0f, -0.5f}, 10.0f, 5.0f, 0.0f, 0.0f};
    static goe_hazard_t hazard;
    port_stack_paint();
    const goe_decision_t decision = goe_decide(&estimator, &intent, NULL, &hazard);
    return decision != GOE_DECISION_KEEP ? port_stack_used() : 0u;
}

__attribute__((noinline)) static size_t depth_of_soonest(void) {
    static const goe_hazard_t hazard = {.tcpa_s = 10.0f, .tcpa_sd_s = 1.0f};
    port_stack_paint();
    (void)goe_earliest_tcpa_s(&hazard);
    return port_stack_used();
}

static void measure_track(const logged_track_t *track, int method) {
    replay_read_settings(track, replay_methods[method], &settings);
    keep_larger(&deepest.defaults, depth_of_defaults());
    keep_larger(&deepest.init, depth_of_init());
    for (int k = 0; k < track->count; k++) {
        replay_read_image(&logged_images[track->first + k], &image);
        keep_larger(&deepest.update[method], depth_of_update());
        keep_larger(&deepest.covariance, depth_of_covariance());
        keep_larger(&deepest.hazard, depth_of_hazard());
        keep_larger(&deepest.decide, depth_of_decide());
    }
    keep_larger(&deepest.rule, depth_of_rule());
    keep_larger(&deepest.soonest, depth_of_soonest());
    keep_larger(&deepest.reset, depth_of_reset());
}

static void report(const char *function, size_t bytes) {
    port_write_text("stack ");
    port_write_text(function);
    port_write_text(" ");
    replay_write_count((long)bytes);
    port_write_text("\n");
}

int main(void) {
    for (int t = 0; t < logged_track_count * REPLAY_METHODS; t++) {
        measure_track(&logged_tracks[t / REPLAY_METHODS], t % REPLAY_METHODS);
    }
    report("goe_settings_default", deepest.defaults);
    report("goe_init", deepest.init);
    report("goe_update_window", deepest.update[0]);
    report("goe_update", deepest.update[1]);
    report("goe_covariance", deepest.covariance);
    report("goe_hazard", deepest.hazard);
    report("goe_rule_default", deepest.rule);
    report("goe_decide", deepest.decide);
    report("goe_earliest_tcpa_s", deepest.soonest);
    report("goe_reset", deepest.reset);
    report("goe_status_text", depth_of_text());
    report("goe_reason_text", depth_of_reason());
    report("goe_self_check", depth_of_self_check());
    return 0;
}
