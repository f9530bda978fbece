/* Images that wait for a pose as new as their exposure. SPDX-License-Identifier: MIT */
#ifndef IMAGE_QUEUE_H
#define IMAGE_QUEUE_H

#include "camera_image.h"

#define IMAGE_QUEUE_MAX 128 /* half a second of eight messages an image at 30 Hz */

/* Called with each frame, of at most GOE_FLIGHT_DETECTIONS detections, that the flight layer took or refused. */
typedef void (*image_taken_t)(void *user, const goe_flight_frame_t *frame, goe_flight_status_t status);

typedef struct {
    camera_image_t image[IMAGE_QUEUE_MAX]; /* in the order of their arrival */
    int count;
    unsigned long given_up; /* no pose came for them */
} image_queue_t;

void image_queue_clear(image_queue_t *queue);

/* A copy goes in; the oldest is dropped if needed. */
void image_queue_add(image_queue_t *queue, const camera_image_t *image);

/* Gives all to the flight layer whose exposure it has a pose for. GOE_FLIGHT_TOO_NEW stays here, for half a second after its
 * arrival; now_us: autopilot's clock. */
void image_queue_run(image_queue_t *queue, goe_flight_t *flight, uint32_t now_us, image_taken_t taken, void *user);

#endif
