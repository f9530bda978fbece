/* Logs compiled into the image, because targets have no files. SPDX-License-Identifier: MIT */
#ifndef GOE_EMBEDDED_LOGS_H
#define GOE_EMBEDDED_LOGS_H

#include "goe.h"

/* Numbers are bits of floats, in the order of goe_pose_t and goe_image_t: position (3), height, attitude (4), reset
 * delta (3), u and v of left, right, top, base_left, base_near, base_right. For an image with a box, its left, top, right and
 * bottom instead of left and right. */
typedef struct {
    int64_t time_us;
    uint8_t seen; /* bit i: feature i */
    uint8_t box;  /* goe_box_t.sides */
    uint8_t reset_count;
    uint8_t reset_delta_known;
    uint32_t bits[23];
} logged_image_t;

/* Numbers: goe_camera_t in its order up to the lever arm, heading_deg, then width and height of the image. */
typedef struct {
    const char *name;
    int16_t first, count; /* in logged_images */
    uint8_t model, window, line_points, orientation_memory, heading_auto;
    uint8_t position_white_sd_m;
    uint32_t bits[18];
} logged_track_t;

extern const logged_image_t logged_images[];
extern const logged_track_t logged_tracks[];
extern const int logged_track_count;

#endif
