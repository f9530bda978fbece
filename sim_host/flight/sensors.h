/*
 * What the sensors make of the truth: pixels, pose, height and frame times.
 *
 * Every figure can be set by itself; a figure of 0 switches its source off and leaves all other draws as they were.
 *
 *   pixel       white noise on each coordinate of each feature; then outliers: a feature is displaced by a fixed distance in
 *               a random direction; then, if wanted, rounding to whole pixels. A feature that leaves the frame is lost.
 *   detector    noise of an object detector: each coordinate of each feature has a variance of detector_px^2 +
 *               (detector_width * width of the silhouette)^2 and is correlated from frame to frame
 *   box         of an upright box each side has noise of its own: white of box_px, plus box_share of the box's width (left,
 *               right) or height (top, bottom) that is forgotten with the time constant box_correlation_s; then outliers: a
 *               side is displaced inwards or outwards; then rounding; then the image's border cuts the box
 *   attitude    constant error drawn once a run plus white noise, one sigma about each body axis
 *   position    random walk from 0 at the start plus a constant velocity error drawn once a run, north, east and down
 *   altimeter   constant error of the height over ground drawn once a run
 *   frames      each is lost with a probability; the exposure is displaced by up to +-time_jitter_s (uniform), at most
 *               0.45 frame intervals, and its true time is logged
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#ifndef SIM_SENSORS_H
#define SIM_SENSORS_H

#include <stdbool.h>
#include <stdint.h>

#include "camera_model.h"
#include "image_box.h"
#include "image_features.h"
#include "random.h"

typedef struct {
    bool rounding;
    double pixel_px;
    double outlier_rate, outlier_px;
    double detector_px, detector_width, detector_correlation;
    double box_px, box_share, box_correlation_s;
    double attitude_bias_deg, attitude_noise_deg;
    double position_walk_m; /* after one second; grows with the square root of time */
    double velocity_bias_mps;
    double altimeter_m;
    double drop_rate;
    double time_jitter_s;
} sensor_noise_t;

typedef struct {
    sensor_noise_t noise;
    random_t pixel, detector, outlier, attitude, position, drop, time, box_pixel, box_detector, box_outlier;
    double detector_state[FEATURE_COUNT][2]; /* unit variance */
    bool detector_started;
    double box_state[SIDE_COUNT]; /* unit variance */
    double box_state_s;           /* time of it */
    bool box_started;
    vec3_t attitude_bias_rad, velocity_bias_mps, walk_m;
    double altimeter_m, walked_s;
} sensors_t;

#define SENSOR_NOISE_FORMS "none, rounding, pixel:SIGMA, field or detector"

/* Reads one of SENSOR_NOISE_FORMS:
 *   none       every figure 0
 *   rounding   whole pixels: the paper
 *   pixel:S    white noise of S px, also of a box's sides
 *   field      pixel 0.5 px, outliers 2 % of 15 px, attitude 0.5 deg + 0.1 deg, velocity 0.05 m/s, walk 0.05 m, altimeter 0.5 m;
 *              boxes as detector
 *   detector   points: sqrt((0.7 px)^2 + (0.025 width)^2), correlation 0.5; boxes: 0.5 px white, 0.04 of the size for 1 s,
 *              as measured on recorded feeds of detectors */
bool sensor_noise_parse(const char *text, sensor_noise_t *noise);

/* Null if the figures can be used, otherwise the fault. */
const char *sensor_noise_fault(const sensor_noise_t *noise);

sensors_t sensors_start(const sensor_noise_t *noise, uint64_t seed);

/* Error of the position of the latest sensors_pose(), at that time or later. */
vec3_t sensors_drift(const sensors_t *sensors, double t_s);

/* The following are called once for each frame, lost or not, in this order. */
bool sensors_frame_lost(sensors_t *sensors);
double sensors_time_error(sensors_t *sensors, double frame_interval_s);
pose_t sensors_pose(sensors_t *sensors, const pose_t *truth, double t_s);
features_t sensors_features(sensors_t *sensors, const features_t *truth, const camera_t *camera);

/* If boxes are logged. */
image_box_t sensors_box(sensors_t *sensors, const image_box_t *truth, const camera_t *camera, double t_s);

#endif
