/* A line of JSON with an image's detections. README.md has its keys. SPDX-License-Identifier: MIT */
#ifndef DETECTION_TEXT_H
#define DETECTION_TEXT_H

#include <stdbool.h>
#include <stddef.h>

#include "camera_image.h"
#include "companion_config.h"

#define DETECTION_LINE_MAX 65536 /* most bytes of a line; a longer line is invalid */

/* The clocks at the line's arrival, us. */
typedef struct {
    int64_t unix_us, monotonic_us, autopilot_us;
    double autopilot_sd_us; /* one sigma of the offset between autopilot's and own clock */
} detection_now_t;

typedef struct {
    char text[160]; /* the fault of a line */
} detection_fault_t;

/* Reads a line. Detections of classes that detections.classes does not list are left out. The times of the image are by the autopilot's
 * clock. Returns false, with the fault, if the line is invalid. */
bool detection_text_read(const char *line, size_t length, const companion_config_t *config, const detection_now_t *now,
                         camera_image_t *image, detection_fault_t *fault);

#endif
