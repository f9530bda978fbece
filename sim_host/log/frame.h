/* One row of frames.csv: one obstacle in one image. SPDX-License-Identifier: MIT */
#ifndef FRAME_H
#define FRAME_H

#include <stdbool.h>
#include <stdint.h>

#include "goe.h"

#define FRAME_TIME_NAME "t_s"
#define FRAME_ID_NAME "id"
#define FRAME_RESET_COUNT_NAME "reset_count"
#define FRAME_CAMERA_NAME "camera"
#define FRAME_KIND_SHAPE_NAME "kind_shape"
#define FRAME_TIME_TEXT_MAX 63

/* The columns of numbers. Image points are pairs: u, then v. */
typedef enum {
    FRAME_N_M,
    FRAME_E_M,
    FRAME_D_M,
    FRAME_AGL_M,
    FRAME_QW,
    FRAME_QX,
    FRAME_QY,
    FRAME_QZ,
    FRAME_LEFT_U,
    FRAME_LEFT_V,
    FRAME_RIGHT_U,
    FRAME_RIGHT_V,
    FRAME_TOP_U,
    FRAME_TOP_V,
    FRAME_BASE_LEFT_U,
    FRAME_BASE_LEFT_V,
    FRAME_BASE_NEAR_U,
    FRAME_BASE_NEAR_V,
    FRAME_BASE_RIGHT_U,
    FRAME_BASE_RIGHT_V,
    FRAME_BOX_LEFT_PX,
    FRAME_BOX_TOP_PX,
    FRAME_BOX_RIGHT_PX,
    FRAME_BOX_BOTTOM_PX,
    FRAME_RESET_N_M,
    FRAME_RESET_E_M,
    FRAME_RESET_D_M,
    FRAME_KIND_WIDTH_M,
    FRAME_KIND_WIDTH_SD_M,
    FRAME_KIND_HEIGHT_M,
    FRAME_KIND_HEIGHT_SD_M,
    FRAME_VALUES
} frame_value_t;

extern const char *const frame_value_name[FRAME_VALUES]; /* as in the header line */

typedef struct {
    unsigned long line;                      /* of the file */
    char time_text[FRAME_TIME_TEXT_MAX + 1]; /* t_s as it was read */
    double time_s;
    int64_t id;
    int64_t reset_count;        /* 0: the field is empty or the column absent */
    int64_t camera;             /* the number of that which took the image; 0: likewise */
    int64_t kind_shape;         /* GOE_KIND_...; 0: likewise */
    double value[FRAME_VALUES]; /* units as the column's name says; not finite if the log says so */
    bool given[FRAME_VALUES];   /* false: the field is empty or the column absent; value means nothing */
} frame_t;

/* The library's input. An image point is visible if both coordinates are given, a side of the box if its number is. A
 * missing pose value becomes NaN and a time that is not finite or does not fit microseconds GOE_TIME_UNKNOWN, both of which
 * the library refuses. agl_m not given: -d_m. The jump of a reset is known if all three of its numbers are given; of the
 * count only the lowest 8 bits are used, as counters wrap at any width. A size of the kind that is
 * not given is unknown, with its sigma. A camera's number that does not fit becomes one that no camera has. */
void frame_to_image(const frame_t *frame, goe_image_t *image);

#endif
