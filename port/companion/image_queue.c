/* Images that wait for a pose. SPDX-License-Identifier: MIT */
#include "image_queue.h"

#include <string.h>

#define WAIT_MAX_US 500000 /* longer than the pose of any link is behind; its time is a wrong one then */

void image_queue_clear(image_queue_t *queue) { queue->count = 0; }

static void drop(image_queue_t *queue, int i) {
    queue->count--;
    (void)memmove(&queue->image[i], &queue->image[i + 1], (size_t)(queue->count - i) * sizeof queue->image[0]);
}

void image_queue_add(image_queue_t *queue, const camera_image_t *image) {
    if (queue->count == IMAGE_QUEUE_MAX) {
        drop(queue, 0);
        queue->given_up++;
    }
    queue->image[queue->count] = *image;
    queue->count++;
}

/* An image of many detections goes in by several calls, the same capture time in each. False: it is too new. */
static bool give(camera_image_t *image, goe_flight_t *flight, image_taken_t taken, void *user) {
    unsigned from = 0;
    do {
        goe_flight_frame_t frame = image->frame;
        const unsigned left = image->detections - from;
        frame.count = (uint8_t)(left < GOE_FLIGHT_DETECTIONS ? left : GOE_FLIGHT_DETECTIONS);
        frame.detection = &image->detection[from];
        const goe_flight_status_t status = goe_flight_frame(flight, &frame);
        if (status == GOE_FLIGHT_TOO_NEW) {
            return false; /* only ever at the first call of an image: the others have the same time */
        }
        taken(user, &frame, status);
        from += frame.count;
    } while (from < image->detections);
    return true;
}

void image_queue_run(image_queue_t *queue, goe_flight_t *flight, uint32_t now_us, image_taken_t taken, void *user) {
    int i = 0;
    while (i < queue->count) {
        const int32_t waited_us =
            (int32_t)(now_us - queue->image[i].frame.arrival_us); /* < 0: the clock was corrected */
        const bool waits_long = waited_us > WAIT_MAX_US;
        if (give(&queue->image[i], flight, taken, user)) {
            drop(queue, i);
        } else if (waits_long) {
            queue->given_up++;
            drop(queue, i);
        } else {
            i++;
        }
    }
}
