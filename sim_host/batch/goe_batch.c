/* SPDX-License-Identifier: MIT */
#include "goe_batch.h"

#include <math.h>
#include <string.h>

#include "settings_text.h"

/* -------------------------------------------------------------------------------------------------------- settings -- */

size_t goe_batch_settings_size(void) { return sizeof(goe_settings_t); }

void goe_batch_default(goe_settings_t *settings) { goe_settings_default(settings); }

int goe_batch_set(goe_settings_t *settings, const char *name, double value) {
    const bool set = settings != NULL && name != NULL && isfinite(value) && setting_put(settings, name, value);
    return set ? 0 : -1;
}

/* --------------------------------------------------------------------------------------------------------- columns -- */

static const char *const label_names[GOE_BATCH_LABELS] = {"status",  "method", "model",    "valid", "fresh",
                                                          "suspect", "points", "nis_rows", "reason"};

static const char *const number_names[GOE_BATCH_NUMBERS] = {"x0_m",
                                                            "z0_m",
                                                            "orientation_deg",
                                                            "width_m",
                                                            "length_m",
                                                            "height_m",
                                                            "x0_sd_m",
                                                            "z0_sd_m",
                                                            "orientation_sd_deg",
                                                            "width_sd_m",
                                                            "length_sd_m",
                                                            "height_sd_m",
                                                            "nis",
                                                            "misfit",
                                                            "velocity_north_m_s",
                                                            "velocity_east_m_s",
                                                            "velocity_north_sd_m_s",
                                                            "velocity_east_sd_m_s",
                                                            "latency_s",
                                                            "latency_sd_s"};

static const char *const hazard_names[GOE_BATCH_HAZARD] = {"status",         "time_s",    "miss_m",
                                                           "clearance_m",    "time_sd_s", "miss_sd_m",
                                                           "clearance_sd_m", "violation", "has_clearance"};

const char *goe_batch_label(int column) {
    return column >= 0 && column < GOE_BATCH_LABELS ? label_names[column] : NULL;
}

const char *goe_batch_number(int column) {
    return column >= 0 && column < GOE_BATCH_NUMBERS ? number_names[column] : NULL;
}

const char *goe_batch_reason(int number) {
    return number >= GOE_REASON_NONE && number <= GOE_REASON_NOISE ? goe_reason_text((goe_reason_t)number) : NULL;
}

const char *goe_batch_hazard(int column) {
    return column >= 0 && column < GOE_BATCH_HAZARD ? hazard_names[column] : NULL;
}

/* Copies; in double precision the numbers are rounded here. */
static void put(goe_batch_float_t *to, const float *from, int count) {
    for (int i = 0; i < count; i++) {
        to[i] = (goe_batch_float_t)from[i];
    }
}

static void take(float *to, const goe_batch_float_t *from, int count) {
    for (int i = 0; i < count; i++) {
        to[i] = (float)from[i];
    }
}

static void tell(const goe_estimate_t *estimate, goe_status_t status, int32_t *label, goe_batch_float_t *number) {
    const int32_t labels[GOE_BATCH_LABELS] = {
        (int32_t)status,          (int32_t)estimate->method, (int32_t)estimate->model,
        (int32_t)estimate->valid, estimate->fresh ? 1 : 0,   estimate->suspect ? 1 : 0,
        estimate->points,         estimate->nis_rows,        (int32_t)estimate->reason};
    const float numbers[GOE_BATCH_NUMBERS] = {estimate->x0_m,
                                              estimate->z0_m,
                                              estimate->orientation_deg,
                                              estimate->width_m,
                                              estimate->length_m,
                                              estimate->height_m,
                                              estimate->sigma.x0_m,
                                              estimate->sigma.z0_m,
                                              estimate->sigma.orientation_deg,
                                              estimate->sigma.width_m,
                                              estimate->sigma.length_m,
                                              estimate->sigma.height_m,
                                              estimate->nis,
                                              estimate->misfit,
                                              estimate->velocity_north_m_s,
                                              estimate->velocity_east_m_s,
                                              estimate->sigma.velocity_north_m_s,
                                              estimate->sigma.velocity_east_m_s,
                                              estimate->latency_s,
                                              estimate->sigma.latency_s};
    memcpy(label, labels, sizeof labels);
    put(number, numbers, GOE_BATCH_NUMBERS);
}

/* ------------------------------------------------------------------------------------------------------------- run -- */

static goe_box_t box_of(const goe_batch_track_t *track, int k) {
    const goe_batch_float_t *side = track->box_px + (size_t)k * GOE_BATCH_BOX;
    goe_box_t box;
    take(&box.left_px, side, 1);
    take(&box.top_px, side + 1, 1);
    take(&box.right_px, side + 2, 1);
    take(&box.bottom_px, side + 3, 1);
    box.seen = track->box_seen[k];
    return box;
}

static goe_image_t image_of(const goe_batch_track_t *track, int k) {
    goe_image_t image;
    memset(&image, 0, sizeof image);
    const goe_batch_float_t *pose = track->pose + (size_t)k * GOE_BATCH_POSE;
    image.pose.time_us = track->time_us[k];
    take(image.pose.position_ned_m, pose, 3);
    take(&image.pose.height_m, pose + 3, 1);
    take(image.pose.attitude, pose + 4, 4);
    goe_pixel_t *const features[GOE_BATCH_FEATURES] = {&image.left,      &image.right,     &image.top,
                                                       &image.base_left, &image.base_near, &image.base_right};
    const goe_batch_float_t *pixel = track->pixel_px + (size_t)k * GOE_BATCH_PIXELS;
    const uint8_t *seen = track->seen + (size_t)k * GOE_BATCH_FEATURES;
    for (int i = 0; i < GOE_BATCH_FEATURES; i++) {
        take(&features[i]->u_px, pixel + 2 * i, 1);
        take(&features[i]->v_px, pixel + 2 * i + 1, 1);
        features[i]->seen = seen[i] != 0;
    }
    if (track->box_px != NULL) {
        image.box = box_of(track, k);
    }
    if (track->reset_count != NULL) {
        const goe_batch_float_t *jump_m = track->reset_m + (size_t)k * 3;
        image.pose.reset_count = track->reset_count[k];
        image.pose.reset_delta_known = isfinite(jump_m[0]) && isfinite(jump_m[1]) && isfinite(jump_m[2]);
        if (image.pose.reset_delta_known) {
            take(image.pose.reset_delta_ned_m, jump_m, 3);
        }
    }
    image.camera = track->camera != NULL ? track->camera[k] : 0;
    return image;
}

static void ask(const goe_estimator_t *estimator, const goe_estimate_t *estimate, const goe_batch_float_t *velocity,
                const goe_batch_plan_t *asked, goe_batch_float_t *answer) {
    const float doubt = estimate->suspect ? (float)asked->doubt : 1.0f;
    const float old_m = (float)asked->drift_m_s * estimate->age_s;
    goe_plan_t plan;
    plan.since_image_s = 0.0f;
    take(plan.velocity_ned_m_s, velocity, 3);
    plan.margin_m = doubt * (float)asked->margin_m + old_m;
    plan.clearance_m = doubt * (float)asked->clearance_m + old_m;
    goe_hazard_t hazard;
    const goe_status_t status = goe_hazard(estimator, &plan, &hazard);
    const float columns[GOE_BATCH_HAZARD] = {
        (float)status,         hazard.time_s,    hazard.miss_m,
        hazard.clearance_m,    hazard.time_sd_s, hazard.miss_sd_m,
        hazard.clearance_sd_m, hazard.violation, hazard.has_clearance ? 1.0f : 0.0f};
    put(answer, columns, GOE_BATCH_HAZARD);
}

int goe_batch_run(const goe_settings_t *settings, const goe_batch_track_t *track, const goe_batch_answer_t *answer,
                  const char **bad_field) {
    goe_estimator_t estimator;
    const goe_status_t started = goe_init(&estimator, sizeof estimator, settings, bad_field);
    if (started != GOE_OK) {
        return (int)started;
    }
    for (int k = 0; k < track->images; k++) {
        const goe_image_t image = image_of(track, k);
        goe_estimate_t estimate;
        const goe_status_t status = goe_update(&estimator, &image, &estimate);
        tell(&estimate, status, answer->label + (size_t)k * GOE_BATCH_LABELS,
             answer->number + (size_t)k * GOE_BATCH_NUMBERS);
        if (answer->covariance != NULL) {
            float covariance[GOE_QUANTITIES][GOE_QUANTITIES];
            (void)goe_covariance(&estimator, covariance);
            for (int i = 0; i < GOE_QUANTITIES; i++) {
                put(answer->covariance + ((size_t)k * GOE_QUANTITIES + (size_t)i) * GOE_QUANTITIES, covariance[i],
                    GOE_QUANTITIES);
            }
        }
        for (int i = 0; i < track->plans; i++) {
            const size_t place = (size_t)k * (size_t)track->plans + (size_t)i;
            ask(&estimator, &estimate, track->velocity + (size_t)k * 3, track->plan + i,
                answer->hazard + place * GOE_BATCH_HAZARD);
        }
    }
    return GOE_OK;
}
