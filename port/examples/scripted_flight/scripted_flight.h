/* The simulated world of the ports' samples: a straight flight past a mast, with the messages of an autopilot and a detector.
 * SPDX-License-Identifier: MIT
 *
 * Poses come at 50 Hz. Every fifth tick a camera takes an image; its detections come 100 ms later, except that for a second and a half the
 * detector is silent. The arithmetic has the same bits on every target, so the samples print the same on each of them (README.md). The
 * flight does not obey: orders are only printed. */
#ifndef SCRIPTED_FLIGHT_H
#define SCRIPTED_FLIGHT_H

#include "goe_flight.h"

#ifdef __cplusplus
extern "C" {
#endif

#define SCRIPTED_TICK_US 20000u /* of the poses */
#define SCRIPTED_TICKS 750u     /* 15 s */
#define SCRIPTED_IMAGE_TICKS 5u /* from image to image */
#define SCRIPTED_DELAY_TICKS 5u /* from exposure to arrival */

/* What the autopilot publishes at once. */
typedef struct {
    goe_flight_attitude_t attitude;
    goe_flight_position_t position;
} scripted_pose_t;

/* What the detector sends for one image: at most one detection here. frame.detection is not set: point it at detection. */
typedef struct {
    goe_flight_frame_t frame;
    goe_flight_detection_t detection;
} scripted_image_t;

/* The camera: 640 x 480 px, 500 px of focal length, looking ahead. */
void scripted_settings(goe_settings_t *settings);

/* The pose at a tick, 0 to SCRIPTED_TICKS - 1. */
void scripted_pose(uint32_t tick, scripted_pose_t *pose);

/* The image that arrives at a tick; false: none does. */
bool scripted_image(uint32_t tick, scripted_image_t *image);

#define SCRIPTED_LINE 160 /* bytes that hold any line, the ending zero included; none has a line break */

/* One line after an assessment: time, the worst obstacle, its hazard, whether the detector is alive, the action.
 * Numbers are printed as integers, for C libraries that cannot print others. */
void scripted_line(const goe_flight_t *flight, uint32_t now_us, const goe_flight_assessment_t *assessment,
                   char text[SCRIPTED_LINE]);

#ifdef __cplusplus
}
#endif

#endif
