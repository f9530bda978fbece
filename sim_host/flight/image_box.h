/*
 * The upright bounding box of an obstacle in the raw image, as a detector draws it, before any noise.
 *
 * It frames the whole obstacle, roof and base, hidden parts included, through the lens. Parts outside the lens model's
 * field or behind the camera have no image and are left out. From inside the obstacle, or with none of its edges in the field,
 * there is no box.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#ifndef SIM_IMAGE_BOX_H
#define SIM_IMAGE_BOX_H

#include <stdbool.h>

#include "camera_model.h"
#include "obstacle.h"

enum { SIDE_LEFT, SIDE_TOP, SIDE_RIGHT, SIDE_BOTTOM, SIDE_COUNT };

typedef struct {
    double side_px[SIDE_COUNT]; /* 0 if not visible */
    bool seen;
} image_box_t;

/* "box_left_px", "box_top_px", "box_right_px", "box_bottom_px" */
extern const char *const SIDE_NAMES[SIDE_COUNT];

/* Sides beyond the image's border stay there. */
image_box_t image_box_project(const obstacle_t *obstacle, const camera_t *camera, const view_t *view);

/* Its width, of left and right, or its height, of top and bottom. */
double image_box_size_px(const image_box_t *box, int side);

/* None of it lies beyond the border. */
bool image_box_whole(const image_box_t *box, const camera_t *camera);

/* Sides beyond the border put at the outermost pixels, 0 or size - 1. Not visible if less than 2 px of width or height remain:
 * no detector finds so small an object. */
image_box_t image_box_clipped(const image_box_t *box, const camera_t *camera);

#endif
