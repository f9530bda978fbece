/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "live.h"

#include <string.h>

#include "approach.h"

/* The distances of the project's README.md; the rest of the rule is the library's. */
#define MARGIN_M 15.0f
#define CLEARANCE_M 10.0f

#define NAME(name) #name "\0"
#define CONTROL(name) CONTROL_##name,
#define FIELD(name) FIELD_##name,
enum { LIVE_CONTROLS(CONTROL) CONTROLS };
enum { LIVE_FIELDS(FIELD) FIELDS };

enum { ORDER_NOTHING_KNOWN, ORDER_CLEAR, ORDER_IN_DOUBT, ORDER_GO_AROUND, ORDER_UNCERTAIN };

#define TEXT_OF(number) #number
#define TEXT(number) TEXT_OF(number)

static float controls[CONTROLS];
static float fields[FIELDS];
static approach_t approach;
static goe_estimator_t estimator;
static goe_estimate_t estimate;
static goe_status_t status;

const char *live_version(void) {
    return TEXT(GOE_VERSION_MAJOR) "." TEXT(GOE_VERSION_MINOR) "." TEXT(GOE_VERSION_PATCH);
}
const char *live_control_names(void) { return LIVE_CONTROLS(NAME); }
const char *live_field_names(void) { return LIVE_FIELDS(NAME); }
float *live_controls(void) { return controls; }
const float *live_fields(void) { return fields; }
const char *live_status(void) { return goe_status_text(status); }
const char *live_reason(void) { return goe_reason_text(estimate.reason); }

/* ----------------------------------------------------------------------------------------------------------- settings -- */

static float larger(float a, float b) { return a > b ? a : b; }

/* The noise of every flight is always configured: see approach.h. */
static void choose_settings(goe_settings_t *settings) {
    goe_settings_default(settings);
    settings->camera.fx_px = settings->camera.fy_px = (float)APPROACH_FOCAL_PX;
    settings->camera.cx_px = 0.5f * (float)APPROACH_IMAGE_WIDTH_PX;
    settings->camera.cy_px = 0.5f * (float)APPROACH_IMAGE_HEIGHT_PX;
    settings->camera.width_px = (float)APPROACH_IMAGE_WIDTH_PX;
    settings->camera.height_px = (float)APPROACH_IMAGE_HEIGHT_PX;
    settings->heading_auto = false; /* north, the course */
    settings->detector.box_noise_rel = (float)APPROACH_BOX_SHARE;
    settings->detector.box_correlation_time_s = (float)APPROACH_CORRELATION_S;
    if (controls[CONTROL_knows] > 0.5f) {
        const float offset_m = controls[CONTROL_height_offset_m];
        settings->detector.box_noise_px = larger(controls[CONTROL_pixel_px], 0.1f);
        settings->detector.point_noise_px = larger(controls[CONTROL_pixel_px], 0.1f);
        settings->navigation.height_bias_sd_m = larger(0.5f, offset_m < 0.0f ? -offset_m : offset_m);
    }
}

static void choose_plan(approach_plan_t *plan) {
    const int kind = (int)controls[CONTROL_kind];
    plan->kind = kind >= 0 && kind < APPROACH_KINDS ? (approach_kind_t)kind : APPROACH_BUILDING;
    plan->detector = controls[CONTROL_detector] > 0.5f ? APPROACH_CORNERS : APPROACH_BOXES;
    plan->roll_deg = (double)controls[CONTROL_roll_deg];
    plan->pixel_px = (double)controls[CONTROL_pixel_px];
    plan->height_offset_m = (double)controls[CONTROL_height_offset_m];
    plan->side_m = (double)controls[CONTROL_side_m];
    plan->seed = (uint64_t)(int64_t)controls[CONTROL_seed];
}

int live_start(void) {
    goe_settings_t settings;
    approach_plan_t plan;
    choose_settings(&settings);
    choose_plan(&plan);
    approach_start(&approach, &plan);
    memset(&estimate, 0, sizeof estimate);
    memset(fields, 0, sizeof fields);
    status = goe_init(&estimator, sizeof estimator, &settings, NULL);
    return status == GOE_OK ? APPROACH_IMAGES : 0;
}

/* ------------------------------------------------------------------------------------------------------------- report -- */

static void report_truth(const approach_truth_t *truth) {
    const approach_obstacle_t *o = &approach.obstacle;
    fields[FIELD_time_s] = (float)truth->time_s;
    fields[FIELD_true_north_m] = (float)truth->north_m;
    fields[FIELD_true_height_m] = (float)truth->height_m;
    fields[FIELD_true_roll_deg] = (float)truth->roll_deg;
    fields[FIELD_true_ahead_m] = (float)(o->north_m - truth->north_m);
    fields[FIELD_true_right_m] = (float)o->east_m;
    fields[FIELD_true_width_m] = (float)o->width_m;
    fields[FIELD_true_length_m] = (float)o->length_m;
    fields[FIELD_true_width_in_view_m] = (float)approach_width_in_view_m(o);
    fields[FIELD_true_obstacle_height_m] = (float)o->height_m;
    fields[FIELD_true_orientation_deg] = (float)o->orientation_deg;
    fields[FIELD_true_round] = o->round ? 1.0f : 0.0f;
}

static void include(goe_box_t *box, const goe_pixel_t *p) {
    if (!p->visible) {
        return;
    }
    const bool first = box->sides == 0;
    box->left_px = first || p->u_px < box->left_px ? p->u_px : box->left_px;
    box->top_px = first || p->v_px < box->top_px ? p->v_px : box->top_px;
    box->right_px = first || p->u_px > box->right_px ? p->u_px : box->right_px;
    box->bottom_px = first || p->v_px > box->bottom_px ? p->v_px : box->bottom_px;
    box->sides = GOE_SIDES_ALL;
}

static void report_image(const goe_image_t *image) {
    goe_box_t box = image->box;
    include(&box, &image->left);
    include(&box, &image->right);
    include(&box, &image->top);
    include(&box, &image->base_left);
    include(&box, &image->base_near);
    include(&box, &image->base_right);
    fields[FIELD_box_seen] = box.sides != 0 ? 1.0f : 0.0f;
    fields[FIELD_box_left_px] = box.left_px;
    fields[FIELD_box_top_px] = box.top_px;
    fields[FIELD_box_right_px] = box.right_px;
    fields[FIELD_box_bottom_px] = box.bottom_px;
}

/* The center if valid; otherwise the reference point, which of a prism is its middle. */
static void report_place(const goe_image_t *image) {
    if (estimate.valid & GOE_HAS_CENTER) {
        fields[FIELD_ahead_m] = estimate.center_north_m - image->pose.position_ned_m[0];
        fields[FIELD_right_m] = estimate.center_east_m - image->pose.position_ned_m[1];
        fields[FIELD_ahead_ahead_m2] = estimate.sigma.center_north_m * estimate.sigma.center_north_m;
        fields[FIELD_ahead_right_m2] = estimate.center_ne_m2;
        fields[FIELD_right_right_m2] = estimate.sigma.center_east_m * estimate.sigma.center_east_m;
        return;
    }
    float covariance[GOE_QUANTITIES][GOE_QUANTITIES];
    (void)goe_covariance(&estimator, covariance);
    fields[FIELD_ahead_m] = estimate.z_m;
    fields[FIELD_right_m] = estimate.x_m;
    fields[FIELD_ahead_ahead_m2] = covariance[GOE_Z0][GOE_Z0];
    fields[FIELD_ahead_right_m2] = covariance[GOE_X0][GOE_Z0];
    fields[FIELD_right_right_m2] = covariance[GOE_X0][GOE_X0];
}

static void report_estimate(void) {
    const goe_estimate_t *e = &estimate;
    fields[FIELD_valid] = (float)e->valid;
    fields[FIELD_model] = (float)(int)e->model;
    fields[FIELD_suspect] = e->suspect ? 1.0f : 0.0f;
    fields[FIELD_fresh] = e->fresh ? 1.0f : 0.0f;
    fields[FIELD_age_s] = e->age_s;
    fields[FIELD_nis_ratio] = e->nis_ratio;
    fields[FIELD_images_used] = (float)e->images_used;
    fields[FIELD_width_m] = e->width_m;
    fields[FIELD_width_sd_m] = e->sigma.width_m;
    fields[FIELD_length_m] = e->length_m;
    fields[FIELD_length_sd_m] = e->sigma.length_m;
    fields[FIELD_height_m] = e->height_m;
    fields[FIELD_height_sd_m] = e->sigma.height_m;
    fields[FIELD_orientation_deg] = e->orientation_deg;
    fields[FIELD_orientation_sd_deg] = e->sigma.orientation_deg;
    fields[FIELD_across_north] = e->width_axis_ne[0];
    fields[FIELD_across_east] = e->width_axis_ne[1];
    fields[FIELD_along_north] = e->length_axis_ne[0];
    fields[FIELD_along_east] = e->length_axis_ne[1];
}

/* ------------------------------------------------------------------------------------------------------------- hazard -- */

/* Only "clear" ends an order to go around. */
static int order_of(goe_decision_t decision, const goe_rule_t *rule, const goe_hazard_t *hazard) {
    const int before = (int)fields[FIELD_order];
    if (decision == GOE_DECISION_ACT) {
        return ORDER_GO_AROUND;
    }
    if (decision == GOE_DECISION_CLEAR) {
        return hazard->conflict_probability >= rule->conflict_probability_max ? ORDER_IN_DOUBT : ORDER_CLEAR;
    }
    const bool known = decision == GOE_DECISION_UNKNOWN && (estimate.valid & GOE_HAS_POSITION) != 0u;
    return known && before != ORDER_GO_AROUND ? ORDER_UNCERTAIN : before;
}

static void report_hazard(void) {
    static const goe_intent_t intent = {
        {(float)APPROACH_SPEED_M_S, 0.0f, (float)APPROACH_DESCENT_M_S}, MARGIN_M, CLEARANCE_M, 0.0f, 0.0f};
    goe_rule_t rule;
    goe_hazard_t hazard;
    goe_rule_default(&rule);
    fields[FIELD_order] = (float)order_of(goe_decide(&estimator, &intent, &rule, &hazard), &rule, &hazard);
    fields[FIELD_conflict_probability] = hazard.conflict_probability;
    fields[FIELD_tcpa_s] = hazard.tcpa_s;
    fields[FIELD_tcpa_sd_s] = hazard.tcpa_sd_s;
    fields[FIELD_dcpa_m] = hazard.dcpa_m;
    fields[FIELD_dcpa_sd_m] = hazard.dcpa_sd_m;
    fields[FIELD_clearance_m] = hazard.clearance_m;
    fields[FIELD_clearance_sd_m] = hazard.clearance_sd_m;
    fields[FIELD_has_clearance] = hazard.has_clearance ? 1.0f : 0.0f;
}

int live_next(void) {
    goe_image_t image;
    approach_truth_t truth;
    if (!approach_next(&approach, &image, &truth)) {
        return 0;
    }
    status = goe_update(&estimator, &image, &estimate);
    report_truth(&truth);
    report_image(&image);
    report_estimate();
    report_place(&image);
    report_hazard();
    return 1;
}
