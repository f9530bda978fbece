/* A flight past tests/c/scene.h's obstacle as an autopilot and a detector give it: samples of the pose at one rate, and frames
 * that come late. SPDX-License-Identifier: MIT */
#ifndef FLOWN_H
#define FLOWN_H

#include "check.h"
#include "goe_flight.h"
#include "scene.h"

#define FLOWN_POSE_HZ 50
#define FLOWN_IMAGE_EVERY 5 /* samples: 10 images a second */
#define FLOWN_DELAY 5       /* samples: 100 ms from the exposure to the arrival */

typedef struct {
    scene_t scene;
    goe_flight_t flight;
    uint32_t start_us; /* of the autopilot's clock; near its end to see it wrap */
    int sample;        /* next */
    uint32_t id;       /* of the detection */
    float score;
    goe_kind_t kind;           /* of its class; 0: unknown */
    bool detects;              /* the detector sees the obstacle */
    bool points;               /* it gives points and base corners, no box */
    uint32_t reset_horizontal; /* in all samples from now on ... */
    uint32_t reset_vertical;
    float jump_ned_m[3];   /* of the latest reset, and added to their positions ... */
    float jumped_ned_m[3]; /* ... as is what the resets before it came to */
    bool jump_known;
    bool height_follows; /* the height jumps along with down */
} flown_t;

/* The scene by upright boxes, its image of 1280 x 1280 px, and a flight layer with default settings. */
void flown_start(flown_t *flown, const goe_flight_settings_t *settings);

uint32_t flown_now_us(const flown_t *flown); /* of the latest sample */

/* Sample k: attitude and position as the autopilot gives them. */
void flown_samples(const flown_t *flown, int k, goe_flight_attitude_t *attitude, goe_flight_position_t *position);

/* What the detector makes of the image at sample k. */
goe_flight_detection_t flown_detection(const flown_t *flown, int k);

/* A frame of these detections, of the image at sample k, in the autopilot's clock, arriving now. */
goe_flight_frame_t flown_frame(const flown_t *flown, int k, const goe_flight_detection_t *detection, int count);

/* One sample on, and a frame if one arrives then. Returns whether one did. */
bool flown_step(flown_t *flown);

/* So many seconds on; in the end an assessment. */
goe_flight_assessment_t flown_fly(flown_t *flown, double seconds);

#endif
