/* The camera's height above the obstacle's ground: its readings, and their rows for the filter. SPDX-License-Identifier: MIT */
#ifndef GOE_GROUND_H
#define GOE_GROUND_H

#include "maths/goe_scalar.h"
#include "refined/goe_filter.h"
#include "refined/goe_observation.h"

/* Takes an image's height, and the change of down. since_s: time since the previous image. */
void goe_ground_read(goe_filter_t *filter, const goe_navigation_t *navigation, const goe_view_t *view, float since_s);

/* Whether an image with a bounding box, or without a detection, lacks a height: a field that was not set is 0, and nobody flies at exactly
 * 0. */
static inline bool goe_ground_lacks_height(const goe_view_t *view) {
    const goe_image_t *image = view->image;
    return goe_magnitude(image->pose.height_m) == 0u && (image->box.sides != 0 || !view->seen);
}

/* Moves the ground by a jump of the autopilot's down. */
static inline void goe_ground_move(goe_filter_t *filter, float down_m) { filter->datum.ground_m += down_m; }

/* Variance of GOE_GROUND, the error of the height above the obstacle's own ground over the range: the ground may slope up or down to it. */
float goe_ground_variance(const goe_observation_t *obs, float inverse_range);

/* If the ground were known to be level, the variance of an unknown would be smaller by the returned factor times the square of its
 * covariance with GOE_GROUND. variance: that of GOE_GROUND. */
float goe_ground_if_level(const goe_filter_t *filter, const goe_navigation_t *navigation, float variance);

/* Call when the filter starts with this image: its prior already contains the height so far. */
void goe_ground_start(goe_filter_t *filter, const goe_observation_t *obs);

/* Notes the first upright box. */
static inline void goe_ground_meet_box(goe_filter_t *filter) { filter->boxes = true; }

/* Adds the uncertainty of the height that has grown since the latest rows. */
void goe_ground_drift(goe_filter_t *filter, const goe_observation_t *obs);

/* The prior of the height is in meters, its state in units of Z0, so their ratio changes as the range becomes known. Updates this ratio
 * after a change of 1/Z0 from inverse_range_before. */
static inline void goe_ground_follow(goe_filter_t *filter, float inverse_range_before) {
    filter->ground_scale *= inverse_range_before / filter->state[GOE_INVERSE_RANGE];
}

/* Call before the rows of an image: removes information that this ratio has made too strong. goe_ground_row() adds missing information. */
void goe_ground_widen(goe_filter_t *filter, const goe_navigation_t *navigation);

/* Appends rows with the information of the heights beyond that already used, if space remains. Returns the number of rows. */
int goe_ground_row(goe_filter_t *filter, const goe_observation_t *obs, goe_rows_t *rows);

#endif
