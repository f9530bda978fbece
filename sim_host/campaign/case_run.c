/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "case_run.h"

#include <math.h>
#include <string.h>

#include "case_statistics.h"
#include "frame.h"
#include "number_text.h"

#define US_PER_S 1e6

/* ------------------------------------------------------------------------------------------- what a log would carry -- */

static void log_camera(const camera_t *from, goe_camera_t *to) {
    to->fx_px = number_to_float(from->fx_px);
    to->fy_px = number_to_float(from->fy_px);
    to->cx_px = number_to_float(from->cx_px);
    to->cy_px = number_to_float(from->cy_px);
    to->k1 = number_to_float(from->k1);
    to->k2 = number_to_float(from->k2);
    to->p1 = number_to_float(from->p1);
    to->p2 = number_to_float(from->p2);
    to->k3 = number_to_float(from->k3);
    to->mount_yaw_deg = number_to_float(from->mount_yaw_deg);
    to->mount_pitch_deg = number_to_float(from->mount_pitch_deg);
    to->mount_roll_deg = number_to_float(from->mount_roll_deg);
    to->offset_m[0] = number_to_float(from->offset_m.x);
    to->offset_m[1] = number_to_float(from->offset_m.y);
    to->offset_m[2] = number_to_float(from->offset_m.z);
    to->width_px = number_to_float(from->width_px);
    to->height_px = number_to_float(from->height_px);
}

static void log_value(frame_t *row, frame_value_t name, double value) {
    row->value[name] = value;
    row->given[name] = true;
}

static void log_feature(frame_t *row, frame_value_t name_u, const feature_t *feature) {
    if (feature->seen) {
        log_value(row, name_u, feature->u_px);
        log_value(row, (frame_value_t)(name_u + 1), feature->v_px);
    }
}

static void log_box(frame_t *row, const image_box_t *box) {
    static const frame_value_t sides[SIDE_COUNT] = {
        [SIDE_LEFT] = FRAME_BOX_LEFT_PX,
        [SIDE_TOP] = FRAME_BOX_TOP_PX,
        [SIDE_RIGHT] = FRAME_BOX_RIGHT_PX,
        [SIDE_BOTTOM] = FRAME_BOX_BOTTOM_PX,
    };
    for (int side = 0; side < SIDE_COUNT && box->seen; side++) {
        log_value(row, sides[side], box->side_px[side]);
    }
}

static void log_frame(const flight_frame_t *frame, log_features_t logged, frame_t *row) {
    static const frame_value_t features[FEATURE_COUNT] = {
        [FEATURE_LEFT] = FRAME_LEFT_U,
        [FEATURE_RIGHT] = FRAME_RIGHT_U,
        [FEATURE_TOP] = FRAME_TOP_U,
        [FEATURE_BASE_LEFT] = FRAME_BASE_LEFT_U,
        [FEATURE_BASE_NEAR] = FRAME_BASE_NEAR_U,
        [FEATURE_BASE_RIGHT] = FRAME_BASE_RIGHT_U,
    };
    const pose_t *pose = &frame->logged;
    (void)memset(row, 0, sizeof *row);
    row->camera = frame->camera;
    row->time_s = (double)frame->time_us / US_PER_S; /* the double next to the decimal number that the log shows */
    log_value(row, FRAME_N_M, pose->position_ned_m.x);
    log_value(row, FRAME_E_M, pose->position_ned_m.y);
    log_value(row, FRAME_D_M, pose->position_ned_m.z);
    log_value(row, FRAME_AGL_M, frame->agl_m);
    log_value(row, FRAME_QW, pose->attitude.w);
    log_value(row, FRAME_QX, pose->attitude.x);
    log_value(row, FRAME_QY, pose->attitude.y);
    log_value(row, FRAME_QZ, pose->attitude.z);
    for (int i = 0; i < features_logged(logged); i++) {
        log_feature(row, features[i], &frame->measured.feature[i]);
    }
    if (logged == LOG_BOXES) {
        log_box(row, &frame->measured_box);
    }
}

/* ----------------------------------------------------------------------------------------------------------- noise -- */

/* Rounding to whole pixels is 1/sqrt(12) = 0.29 px, but on a slowly growing image its errors are correlated over some images. */
#define ROUNDING_PX 0.35

/* Figures that the library takes for "none": a pose without errors still carries those of single precision. */
#define LEAST_PIXEL_PX 0.05
#define LEAST_ANGLE_DEG 1e-3
#define LEAST_HEIGHT_M 1e-3

static float at_least(double figure, double least) { return number_to_float(fmax(figure, least)); }

void case_noise(const sensor_noise_t *sensors, goe_settings_t *settings) {
    goe_detector_t *detector = &settings->detector;
    goe_navigation_t *navigation = &settings->navigation;
    const double rounding_px = sensors->rounding ? ROUNDING_PX : 0.0;
    detector->point_noise_px =
        at_least(hypot(hypot(sensors->pixel_px, sensors->detector_px), rounding_px), LEAST_PIXEL_PX);
    detector->point_noise_rel = number_to_float(sensors->detector_width);
    detector->point_correlation = number_to_float(sensors->detector_correlation);
    detector->shape_error_rel = 0.0f;
    navigation->attitude_bias_sd_deg = at_least(sensors->attitude_bias_deg, LEAST_ANGLE_DEG);
    navigation->attitude_white_sd_deg = at_least(sensors->attitude_noise_deg, LEAST_ANGLE_DEG);
    navigation->attitude_walk_sd_deg = 0.0f;
    navigation->height_bias_sd_m = at_least(sensors->altimeter_m, LEAST_HEIGHT_M);
    navigation->velocity_bias_sd_m_s = number_to_float(sensors->velocity_bias_mps);
    navigation->position_walk_sd_m = number_to_float(sensors->position_walk_m);
}

/* ------------------------------------------------------------------------------------------------------------- run -- */

/* The condition is that of exactly the solved points, which only the library's own window knows. The filter
 * method does not answer by (5). */
static double condition_behind(const goe_estimator_t *estimator, const goe_estimate_t *estimate) {
    const goe_window_t *window = &estimator->window;
    const goe_fit_ring_t *ring = estimate->model == GOE_MODEL_LINE ? &window->line : &window->disc;
    return estimate->fresh ? window_condition(ring->point, estimate->images_used) : (double)NAN;
}

const char *case_run(const flight_case_t *setup, const flight_log_t *log, case_setting_t setting,
                     case_sample_t *samples) {
    goe_settings_t settings;
    goe_estimator_t estimator;
    const char *bad_field = "settings";
    goe_settings_default(&settings);
    log_camera(&setup->camera[0], &settings.camera);
    if (setup->cameras > 1) {
        log_camera(&setup->camera[1], &settings.more_cameras[0]);
    }
    settings.heading_auto = false;
    settings.heading_deg = number_to_float(degrees(log->course_rad));
    settings.method = setting.method;
    settings.model = setting.model;
    settings.window.points = setting.window;
    case_noise(&setup->noise, &settings);
    if (goe_init(&estimator, sizeof estimator, &settings, &bad_field) != GOE_OK) {
        return bad_field;
    }
    for (size_t i = 0; i < log->count; i++) {
        frame_t row;
        goe_image_t image;
        log_frame(&log->frames[i], setup->features, &row);
        frame_to_image(&row, &image);
        samples[i].status = goe_update(&estimator, &image, &samples[i].estimate);
        samples[i].condition =
            setting.method == GOE_METHOD_WINDOW ? condition_behind(&estimator, &samples[i].estimate) : (double)NAN;
    }
    return NULL;
}
