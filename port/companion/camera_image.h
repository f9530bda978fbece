/* A detector's report of one image. SPDX-License-Identifier: MIT */
#ifndef CAMERA_IMAGE_H
#define CAMERA_IMAGE_H

#include "goe_flight.h"

#define CAMERA_IMAGE_DETECTIONS 255 /* goe_flight_frame_t.number is 8 bits */

typedef struct {
    goe_flight_frame_t frame; /* count and detection are set by image_queue */
    unsigned detections;      /* number of detections in the array */
    unsigned unknown_classes; /* of them: with a class that obstacle_class.c does not list */
    goe_flight_detection_t detection[CAMERA_IMAGE_DETECTIONS];
} camera_image_t;

#endif
