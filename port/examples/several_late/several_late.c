/* Three obstacles at once, through the flight layer: detections come 120 ms after the exposure, with the camera computer's own
 * clock, and poses come late, too: each image waits for the pose that it belongs to. SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "goe_flight.h"

/* ------------------------------------------------------------------------------------------------------------ the world -- */

#define FOCAL_PX 700.0f
#define WIDTH_PX 1280.0f
#define HEIGHT_PX 720.0f
#define FLYING_HEIGHT_M 35.0f
#define SPEED_M_S 18.0f
#define STEP_US 20000u     /* of poses */
#define STEPS_PER_IMAGE 5u /* 10 Hz */
#define LATE_STEPS 6u      /* an image's exposure to its arrival: 120 ms */
#define POSE_LATE_STEPS 8u /* a pose's: 160 ms */
#define ASSESS_STEPS 5u    /* 10 Hz */
#define STEPS 501u
#define PRINT_STEPS 125u        /* of the table: each 2.5 s */
#define CAMERA_CLOCK 987654321u /* what the camera's computer reads when the autopilot reads 0, us */

typedef struct {
    const char *name;
    float north_m, east_m, width_m, top_m;
} thing_t;

static const thing_t things[] = {
    {"mast", 260.0f, 12.0f, 3.0f, 50.0f},
    {"house", 330.0f, -30.0f, 14.0f, 11.0f},
    {"truck", 240.0f, -8.0f, 2.5f, 4.0f},
};
#define THINGS (sizeof things / sizeof things[0])

static float north_m(uint32_t step) { return SPEED_M_S * 1e-6f * (float)STEP_US * (float)step; }

static bool see(const thing_t *thing, uint32_t step, goe_flight_detection_t *detection) {
    const float ahead_m = thing->north_m - north_m(step);
    const float scale = FOCAL_PX / ahead_m;
    memset(detection, 0, sizeof *detection);
    detection->id = (uint32_t)(thing - things) + 1u;
    detection->score = 0.9f;
    detection->box.left_px = 0.5f * WIDTH_PX + scale * (thing->east_m - 0.5f * thing->width_m);
    detection->box.right_px = 0.5f * WIDTH_PX + scale * (thing->east_m + 0.5f * thing->width_m);
    detection->box.top_px = 0.5f * HEIGHT_PX + scale * (FLYING_HEIGHT_M - thing->top_m);
    detection->box.bottom_px = 0.5f * HEIGHT_PX + scale * FLYING_HEIGHT_M;
    detection->box.sides = GOE_SIDES_ALL;
    return ahead_m > 10.0f && detection->box.right_px < WIDTH_PX && detection->box.left_px > 0.0f &&
           detection->box.bottom_px < HEIGHT_PX;
}

/* --------------------------------------------------------------------------------------------------- what you would write -- */

static goe_flight_t flight; /* all the memory there is */

/* The autopilot's samples, as they come. */
static void take_pose(uint32_t step) {
    goe_flight_attitude_t attitude = {0};
    goe_flight_position_t position = {0};
    attitude.time_us = position.time_us = step * STEP_US;
    attitude.q[0] = 1.0f;
    position.position_ned_m[0] = north_m(step);
    position.position_ned_m[2] = -FLYING_HEIGHT_M;
    position.velocity_ned_m_s[0] = SPEED_M_S;
    position.height_m[GOE_FLIGHT_TERRAIN] = FLYING_HEIGHT_M;
    position.height_valid = 1u << GOE_FLIGHT_TERRAIN;
    (void)goe_flight_attitude(&flight, &attitude);
    (void)goe_flight_position(&flight, &position);
}

/* What came from the camera's computer, until its pose is there. */
typedef struct {
    goe_flight_frame_t frame;
    goe_flight_detection_t detection[THINGS];
    bool waits;
} message_t;

static void receive(uint32_t exposed, uint32_t now, message_t *message) {
    memset(message, 0, sizeof *message);
    goe_flight_frame_t *frame = &message->frame;
    for (size_t i = 0; i < THINGS; i++) {
        if (see(&things[i], exposed, &message->detection[frame->count])) {
            frame->count++;
        }
    }
    frame->number = frame->count; /* also 0: nothing in view, but the detector is alive */
    frame->time_base = GOE_FLIGHT_SENDER_CLOCK;
    frame->capture_us = CAMERA_CLOCK + exposed * STEP_US;
    frame->sent_us =
        CAMERA_CLOCK + (exposed + LATE_STEPS) * STEP_US; /* the link is fast: the detector takes the time */
    frame->arrival_us = now * STEP_US;                   /* once, however often it is offered */
    message->waits = true;
}

static void offer(message_t *message) {
    message->frame.detection = message->detection;
    if (message->waits) {
        message->waits = goe_flight_frame(&flight, &message->frame) == GOE_FLIGHT_TOO_NEW;
    }
}

static void print_obstacles(const goe_flight_assessment_t *assessment) {
    for (int slot = 0; slot < GOE_FLIGHT_SLOTS; slot++) {
        goe_flight_obstacle_t found;
        if (goe_flight_obstacle(&flight, slot, &found) != GOE_FLIGHT_OK || (found.valid & GOE_HAS_POSITION) == 0u) {
            continue;
        }
        const thing_t *truth = &things[found.id - 1u]; /* the tracker's numbers, here */
        printf("  %-5s %3.0f +- %2.0f m north, %3.0f m east (true: %3.0f, %3.0f), %2.0f m high (%2.0f); in %4.1f s "
               "%2.0f m aside%s%s\n",
               truth->name, (double)found.center_ned_m[0], (double)sqrtf(found.covariance_ne_m2[0]),
               (double)found.center_ned_m[1], (double)truth->north_m, (double)truth->east_m, (double)found.height_m,
               (double)truth->top_m, (double)found.hazard.tcpa_s, (double)found.hazard.dcpa_m,
               found.suspect ? ", suspect" : "", slot == assessment->worst ? ", worst" : "");
    }
}

/* Ten times a second, whether images come or not: a late report is useless. */
static void assess(uint32_t step, goe_flight_action_t *ordered) {
    goe_flight_assessment_t now;
    const bool known = goe_flight_assess(&flight, step * STEP_US, false, &now) == GOE_FLIGHT_OK;
    const double time_s = (double)(1e-6f * (float)STEP_US * (float)step);
    if (known && now.action != *ordered) {
        *ordered = now.action;
        printf("%.1f s: ORDER %s%s\n", time_s, goe_flight_action_text(now.action), now.late ? ", late" : "");
    }
    if (step % PRINT_STEPS == 0u) {
        printf("%.1f s: %u obstacles, detector %s, pose %s\n", time_s, (unsigned)now.obstacles,
               now.detector_alive ? "alive" : "dead", now.pose_alive ? "alive" : "dead");
        print_obstacles(&now);
    }
}

int main(void) {
    goe_settings_t settings;
    goe_flight_settings_t layer;
    goe_settings_default(&settings);
    goe_flight_settings_default(&layer);
    settings.camera.fx_px = settings.camera.fy_px = FOCAL_PX;
    settings.camera.cx_px = 0.5f * WIDTH_PX;
    settings.camera.cy_px = 0.5f * HEIGHT_PX;
    settings.camera.width_px = WIDTH_PX; /* the layer needs the image's size */
    settings.camera.height_px = HEIGHT_PX;
    settings.detector.box_noise_rel = 0.02f;
    layer.delay_s = 0.0f; /* what the link takes at least */
    if (goe_flight_init(&flight, sizeof flight, &settings, &layer, NULL) != GOE_FLIGHT_OK) {
        return 1;
    }
    message_t message = {.waits = false};
    goe_flight_action_t ordered = GOE_FLIGHT_NONE;
    for (uint32_t step = POSE_LATE_STEPS; step < STEPS; step++) {
        if ((step - LATE_STEPS) % STEPS_PER_IMAGE == 0u) {
            receive(step - LATE_STEPS, step, &message);
        }
        take_pose(step - POSE_LATE_STEPS);
        offer(&message); /* after every pose, until it is taken */
        if (step % ASSESS_STEPS == 0u) {
            assess(step, &ordered);
        }
    }
    printf("%u images taken, offered %u times too early, %u too late\n", (unsigned)flight.counters.taken,
           (unsigned)flight.counters.early, (unsigned)flight.counters.late);
    return 0;
}
