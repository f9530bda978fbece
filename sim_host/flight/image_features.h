/*
 * What an image shows of an obstacle: the columns of an observation log, before any noise.
 *
 *   left, right   box: leftmost and rightmost of its eight corners, as the image shows them.
 *                 cylinder, tangent: middle of the visible stretch of the two lines along which vertical planes through the
 *                 camera touch it: exact. cylinder, cloud: leftmost and rightmost point of a cloud on its wall.
 *   top           point of the roof's rim that is horizontally nearest to the camera: of a box the corner above the nearest
 *                 base corner, of a cylinder the point of the rim (cloud: of the cloud) on the camera's side
 *   base_left, base_near, base_right   box only: base corners of the one or two walls that the camera sees; near only if it
 *                 sees two
 *
 * A feature whose image lies outside the frame, behind the camera, or outside the lens model's field is not visible. From
 * inside the obstacle nothing is visible; from straight above it no base corner is.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#ifndef SIM_IMAGE_FEATURES_H
#define SIM_IMAGE_FEATURES_H

#include <stdbool.h>

#include "camera_model.h"
#include "obstacle.h"

enum {
    FEATURE_LEFT,
    FEATURE_RIGHT,
    FEATURE_TOP,
    FEATURE_BASE_LEFT,
    FEATURE_BASE_NEAR,
    FEATURE_BASE_RIGHT,
    FEATURE_COUNT
};

typedef struct {
    double u_px, v_px; /* 0 if not visible */
    bool seen;
} feature_t;

typedef struct {
    feature_t feature[FEATURE_COUNT];
    double width_px; /* of the silhouette, right minus left, also if it reaches out of the frame; 0 if unknown */
} features_t;

/* What a log carries: left, right and top; base corners too; or upright boxes (image_box.h) and no points. */
typedef enum { LOG_CORNERS, LOG_POINTS, LOG_BOXES } log_features_t;

/* How many of the features, from the first on. */
int features_logged(log_features_t logged);

typedef enum { CYLINDER_TANGENT, CYLINDER_CLOUD } cylinder_model_t;

/* "left", "right", "top", "base_left", "base_near", "base_right" */
extern const char *const FEATURE_NAMES[FEATURE_COUNT];

features_t features_project(const obstacle_t *obstacle, cylinder_model_t cylinder_model, const camera_t *camera,
                            const view_t *view);

#endif
