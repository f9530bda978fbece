/* The camera's height above the obstacle's ground: its readings, and their rows for the filter. SPDX-License-Identifier: MIT */
#ifndef GOE_GROUND_H
#define GOE_GROUND_H

#include "maths/goe_scalar.h"
#include "refined/goe_filter.h"
#include "refined/goe_observation.h"

/* Takes an image's height, and what down has changed by. since_s: the image before. */
void goe_ground_read(goe_filter_t *filter, const goe_navigation_t *navigation, const goe_view_t *view, float since_s);

/* Whether an image with a box comes without a height: nobody flies at exactly 0, and a field that was not set is 0. */
static inline bool goe_ground_lacks_height(const goe_image_t *image) {
    return image->box.sides != 0 && goe_magnitude(image->pose.height_m) == 0u;
}

/* The autopilot's down jumped by this. */
static inline void goe_ground_move(goe_filter_t *filter, float down_m) { filter->datum.ground_m += down_m; }

/* Of GOE_GROUND, the height above the obstacle's own ground over the range: the ground may slope up or down to it. */
float goe_ground_variance(const goe_observation_t *obs, float inverse_range);

/* If the ground were known to be level, the variance of an unknown would be smaller by this times the square of its covariance with
 * GOE_GROUND, whose variance is given. */
float goe_ground_if_level(const goe_filter_t *filter, const goe_navigation_t *navigation, float variance);

/* The filter starts by this image: its model already has the height so far. */
void goe_ground_start(goe_filter_t *filter, const goe_observation_t *obs);

/* The first upright box. */
static inline void goe_ground_meet_box(goe_filter_t *filter) { filter->datum.boxes = true; }

/* Time has passed since the latest rows: what the height is less certain by. */
void goe_ground_drift(goe_filter_t *filter, const goe_observation_t *obs);

/* Prior information on the height is in meters, its state in units of Z0: as the range becomes known, their ratio
 * moves. This keeps that ratio, after 1/Z0 moved from its earlier value. */
static inline void goe_ground_follow(goe_filter_t *filter, float inverse_range_before) {
    filter->ground_scale *= inverse_range_before / filter->state[GOE_INVERSE_RANGE];
}

/* Removes information that this ratio made too strong, before the rows of an image are taken; missing information is
 * a row of goe_ground_row(). */
void goe_ground_widen(goe_filter_t *filter, const goe_navigation_t *navigation);

/* Appends the information of the heights beyond that already taken, if space remains. Returns how many rows. */
int goe_ground_row(goe_filter_t *filter, const goe_observation_t *obs, goe_rows_t *rows);

#endif
