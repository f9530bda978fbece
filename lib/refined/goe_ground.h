/* The camera's height above the obstacle's ground: its readings, and their rows for the filter. SPDX-License-Identifier: MIT */
#ifndef GOE_GROUND_H
#define GOE_GROUND_H

#include "maths/goe_scalar.h"
#include "refined/goe_filter.h"
#include "refined/goe_observation.h"

/* Takes an image's height, and what down has changed by. Upright boxes count by it, and heights with a white error do. */
void goe_ground_read(goe_filter_t *filter, const goe_navigation_t *navigation, const goe_view_t *view);

/* Whether an image with a box comes without a height: nobody flies at exactly 0, and a field that was not set is 0. */
static inline bool goe_ground_lacks_height(const goe_image_t *image) {
    return image->box.sides != 0 && goe_magnitude(image->pose.height_m) == 0u;
}

/* Whether the height moves by the changes of down. */
static inline bool goe_ground_is_steady(const goe_filter_t *filter, const goe_navigation_t *navigation) {
    return goe_filter_by_boxes(filter) || navigation->height_white_sd_m > 0.0f;
}

/* The autopilot's down jumped by this. */
static inline void goe_ground_move(goe_filter_t *filter, float down_m) { filter->datum.ground_m += down_m; }

/* The filter starts by this image: its model already has the height so far. */
void goe_ground_start(goe_filter_t *filter, const goe_observation_t *obs);

/* The first upright box of a footprint that began by points: from here on the height counts by the changes of down, and the obstacle's
 * own ground may lie off. */
void goe_ground_meet_box(goe_filter_t *filter, const goe_navigation_t *navigation);

/* The camera flew on: the slope of the ground below it. */
void goe_ground_climb(goe_filter_t *filter, const goe_navigation_t *navigation);

/* Prior information on the height is in meters, its state in units of Z0: as the range becomes known, their ratio
 * moves. This keeps that ratio, after 1/Z0 moved from its earlier value. */
static inline void goe_ground_follow(goe_filter_t *filter, float inverse_range_before) {
    filter->ground_scale *= inverse_range_before / filter->state[GOE_INVERSE_RANGE];
}

/* Removes information that this ratio made too strong, before the rows of an image are taken; missing information is
 * a row of goe_ground_row(). A prism's foot gives its first range, which is near enough: nothing is removed there. */
void goe_ground_widen(goe_filter_t *filter);

/* Appends the information of the heights beyond that already taken, if space remains. Returns how many rows. */
int goe_ground_row(goe_filter_t *filter, const goe_observation_t *obs, goe_rows_t *rows);

#endif
