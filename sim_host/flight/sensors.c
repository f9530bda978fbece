/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "sensors.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "text_numbers.h"

#define LARGEST_JITTER 0.45 /* frame intervals: frames keep their order */

/* Sides of upright boxes, measured on recorded feeds of detectors. */
static void set_box_detector(sensor_noise_t *noise) {
    noise->box_px = 0.5;
    noise->box_share = 0.04;
    noise->box_correlation_s = 1.0;
}

bool sensor_noise_parse(const char *text, sensor_noise_t *noise) {
    memset(noise, 0, sizeof *noise);
    if (strcmp(text, "none") == 0) {
        return true;
    }
    if (strcmp(text, "rounding") == 0) {
        noise->rounding = true;
        return true;
    }
    if (strcmp(text, "field") == 0) {
        noise->pixel_px = 0.5;
        noise->outlier_rate = 0.02;
        noise->outlier_px = 15.0;
        noise->attitude_bias_deg = 0.5;
        noise->attitude_noise_deg = 0.1;
        noise->position_walk_m = 0.05;
        noise->velocity_bias_mps = 0.05;
        noise->altimeter_m = 0.5;
        set_box_detector(noise);
        return true;
    }
    if (strcmp(text, "detector") == 0) {
        noise->detector_px = 0.7;
        noise->detector_width = 0.025;
        noise->detector_correlation = 0.5;
        set_box_detector(noise);
        return true;
    }
    const bool read = text_numbers(text, "pixel:", &noise->pixel_px, 1) && noise->pixel_px >= 0.0;
    noise->box_px = noise->pixel_px;
    return read;
}

#define SIZE_FAULT " must be 0 to 1e6"
const char *sensor_noise_fault(const sensor_noise_t *noise) {
    const struct {
        double value;
        const char *fault;
    } sizes[] = {
        {noise->pixel_px, "pixel-noise: a noise figure" SIZE_FAULT},
        {noise->outlier_px, "outlier-size: a noise figure" SIZE_FAULT},
        {noise->detector_px, "detector-px: a noise figure" SIZE_FAULT},
        {noise->detector_width, "detector-width: a noise figure" SIZE_FAULT},
        {noise->attitude_bias_deg, "attitude-bias: a noise figure" SIZE_FAULT},
        {noise->attitude_noise_deg, "attitude-noise: a noise figure" SIZE_FAULT},
        {noise->position_walk_m, "position-walk: a noise figure" SIZE_FAULT},
        {noise->velocity_bias_mps, "velocity-bias: a noise figure" SIZE_FAULT},
        {noise->altimeter_m, "altimeter-bias: a noise figure" SIZE_FAULT},
        {noise->time_jitter_s, "time-jitter: a noise figure" SIZE_FAULT},
        {noise->box_px, "box-px: a noise figure" SIZE_FAULT},
        {noise->box_share, "box-share: a noise figure" SIZE_FAULT},
        {noise->box_correlation_s, "box-correlation: a noise figure" SIZE_FAULT},
    };
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        if (!(sizes[i].value >= 0.0 && sizes[i].value <= 1e6)) {
            return sizes[i].fault;
        }
    }
    if (!(noise->outlier_rate >= 0.0 && noise->outlier_rate <= 1.0)) {
        return "outlier-rate: a rate must be 0 to 1";
    }
    if (!(noise->drop_rate >= 0.0 && noise->drop_rate <= 1.0)) {
        return "drop-rate: a rate must be 0 to 1";
    }
    if (!(noise->detector_correlation >= 0.0 && noise->detector_correlation < 1.0)) {
        return "detector-correlation: must be 0 or more and less than 1";
    }
    return NULL;
}

static vec3_t normal_vector(random_t *random, double sigma) {
    vec3_t v;
    v.x = sigma * random_normal(random);
    v.y = sigma * random_normal(random);
    v.z = sigma * random_normal(random);
    return v;
}

sensors_t sensors_start(const sensor_noise_t *noise, uint64_t seed) {
    sensors_t s;
    memset(&s, 0, sizeof s);
    s.noise = *noise;
    s.pixel = random_start(seed, STREAM_PIXEL);
    s.detector = random_start(seed, STREAM_DETECTOR);
    s.outlier = random_start(seed, STREAM_OUTLIER);
    s.attitude = random_start(seed, STREAM_ATTITUDE);
    s.position = random_start(seed, STREAM_POSITION);
    s.drop = random_start(seed, STREAM_DROP);
    s.time = random_start(seed, STREAM_TIME);
    s.box_pixel = random_start(seed, STREAM_BOX_PIXEL);
    s.box_detector = random_start(seed, STREAM_BOX_DETECTOR);
    s.box_outlier = random_start(seed, STREAM_BOX_OUTLIER);
    random_t altimeter = random_start(seed, STREAM_ALTIMETER);
    s.attitude_bias_rad = normal_vector(&s.attitude, radians(noise->attitude_bias_deg));
    s.velocity_bias_mps = normal_vector(&s.position, noise->velocity_bias_mps);
    s.altimeter_m = noise->altimeter_m * random_normal(&altimeter);
    return s;
}

bool sensors_frame_lost(sensors_t *sensors) { return random_uniform(&sensors->drop) < sensors->noise.drop_rate; }

double sensors_time_error(sensors_t *sensors, double frame_interval_s) {
    const double jitter = fmin(sensors->noise.time_jitter_s, LARGEST_JITTER * frame_interval_s);
    return jitter * (2.0 * random_uniform(&sensors->time) - 1.0);
}

vec3_t sensors_drift(const sensors_t *sensors, double t_s) {
    return vec3_add(sensors->walk_m, vec3_scale(sensors->velocity_bias_mps, t_s));
}

pose_t sensors_pose(sensors_t *sensors, const pose_t *truth, double t_s) {
    const vec3_t white = normal_vector(&sensors->attitude, radians(sensors->noise.attitude_noise_deg));
    const double step = sqrt(fmax(t_s - sensors->walked_s, 0.0));
    sensors->walk_m =
        vec3_add(sensors->walk_m, normal_vector(&sensors->position, sensors->noise.position_walk_m * step));
    sensors->walked_s = fmax(t_s, sensors->walked_s);
    const quat_t turned = quat_from_rotation_vector(vec3_add(sensors->attitude_bias_rad, white));
    pose_t pose = *truth;
    pose.position_ned_m = vec3_add(truth->position_ned_m, sensors_drift(sensors, t_s));
    pose.attitude = quat_multiply(truth->attitude, turned);
    return pose;
}

/* The detector's noise continues from frame to frame whether or not a feature is visible. */
static void step_detector(sensors_t *sensors) {
    const double keep = sensors->detector_started ? sensors->noise.detector_correlation : 0.0;
    const double fresh = sqrt(1.0 - keep * keep);
    for (int i = 0; i < FEATURE_COUNT; i++) {
        for (int axis = 0; axis < 2; axis++) {
            double *state = &sensors->detector_state[i][axis];
            *state = keep * *state + fresh * random_normal(&sensors->detector);
        }
    }
    sensors->detector_started = true;
}

static void disturb(sensors_t *sensors, feature_t *feature, const double detector[2], double detector_sigma) {
    const sensor_noise_t *noise = &sensors->noise;
    const double du = noise->pixel_px * random_normal(&sensors->pixel);
    const double dv = noise->pixel_px * random_normal(&sensors->pixel);
    const bool outlier = random_uniform(&sensors->outlier) < noise->outlier_rate;
    const double direction = 2.0 * SIM_PI * random_uniform(&sensors->outlier);
    const double jump = outlier ? noise->outlier_px : 0.0;
    if (!feature->seen) {
        return;
    }
    feature->u_px += du + detector_sigma * detector[0] + jump * cos(direction);
    feature->v_px += dv + detector_sigma * detector[1] + jump * sin(direction);
    if (noise->rounding) {
        feature->u_px = floor(feature->u_px + 0.5);
        feature->v_px = floor(feature->v_px + 0.5);
    }
}

features_t sensors_features(sensors_t *sensors, const features_t *truth, const camera_t *camera) {
    const sensor_noise_t *noise = &sensors->noise;
    const double detector_sigma = hypot(noise->detector_px, noise->detector_width * truth->width_px);
    features_t measured = *truth;
    step_detector(sensors);
    for (int i = 0; i < FEATURE_COUNT; i++) {
        feature_t *feature = &measured.feature[i];
        disturb(sensors, feature, sensors->detector_state[i], detector_sigma);
        if (feature->seen && !camera_in_image(camera, feature->u_px, feature->v_px)) {
            memset(feature, 0, sizeof *feature);
        }
    }
    return measured;
}

/* As step_detector, in time instead of frames: boxes of any image rate have the same correlation time. */
static void step_box(sensors_t *sensors, double t_s) {
    const double constant_s = sensors->noise.box_correlation_s;
    const bool remembers = sensors->box_started && constant_s > 0.0;
    const double keep = remembers ? exp(-fmax(t_s - sensors->box_state_s, 0.0) / constant_s) : 0.0;
    const double fresh = sqrt(1.0 - keep * keep);
    for (int side = 0; side < SIDE_COUNT; side++) {
        sensors->box_state[side] = keep * sensors->box_state[side] + fresh * random_normal(&sensors->box_detector);
    }
    sensors->box_state_s = t_s;
    sensors->box_started = true;
}

image_box_t sensors_box(sensors_t *sensors, const image_box_t *truth, const camera_t *camera, double t_s) {
    const sensor_noise_t *noise = &sensors->noise;
    image_box_t measured = *truth;
    step_box(sensors, t_s);
    for (int side = 0; side < SIDE_COUNT; side++) {
        const double white = noise->box_px * random_normal(&sensors->box_pixel);
        const double alike = noise->box_share * image_box_size_px(truth, side) * sensors->box_state[side];
        const bool outlier = random_uniform(&sensors->box_outlier) < noise->outlier_rate;
        const double direction = random_uniform(&sensors->box_outlier) < 0.5 ? -1.0 : 1.0;
        const double side_px = truth->side_px[side] + white + alike + (outlier ? direction * noise->outlier_px : 0.0);
        measured.side_px[side] = noise->rounding ? floor(side_px + 0.5) : side_px;
    }
    return image_box_clipped(&measured, camera);
}
