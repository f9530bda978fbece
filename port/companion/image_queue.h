/* Queue of images that wait for the pose at their exposure. SPDX-License-Identifier: MIT */
#ifndef IMAGE_QUEUE_H
#define IMAGE_QUEUE_H

#include "camera_image.h"

#define IMAGE_QUEUE_MAX 128 /* enough for 0.5 s of images at 30 Hz with eight messages each */

/* Called for each frame (at most GOE_FLIGHT_DETECTIONS detections) that the flight layer accepted or refused. */
typedef void (*image_taken_t)(void *user, const goe_flight_frame_t *frame, goe_flight_status_t status);

typedef struct {
    camera_image_t image[IMAGE_QUEUE_MAX]; /* in the order of their arrival */
    int count;
    unsigned long given_up; /* images that were dropped: no pose arrived in time, or the queue was full */
} image_queue_t;

void image_queue_clear(image_queue_t *queue);

/* Adds a copy of the image; drops the oldest image if the queue is full. */
void image_queue_add(image_queue_t *queue, const camera_image_t *image);

/* Passes all images to the flight layer. An image for which the layer returns GOE_FLIGHT_TOO_NEW stays in the queue until half a second
 * after its arrival.
 *   now_us  autopilot's clock */
void image_queue_run(image_queue_t *queue, goe_flight_t *flight, uint32_t now_us, image_taken_t taken, void *user);

#endif
