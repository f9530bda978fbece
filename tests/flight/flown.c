/* A flight as an autopilot and a detector give it. SPDX-License-Identifier: MIT */
#include "flown.h"

#include <string.h>

#define IMAGE_PX 1280.0f
#define SAMPLE_US (1000000 / FLOWN_POSE_HZ)

void flown_start(flown_t *flown, const goe_flight_settings_t *settings) {
    memset(flown, 0, sizeof *flown);
    scene_default(&flown->scene);
    flown->scene.image_rate_hz = FLOWN_POSE_HZ;
    flown->scene.upright_boxes = flown->scene.boxes = true;
    flown->scene.camera.width_px = flown->scene.camera.height_px = IMAGE_PX;
    flown->start_us = 1000000u;
    flown->id = 7u;
    flown->score = 0.9f;
    flown->detects = true;
    flown->jump_known = true;
    const goe_settings_t estimator = scene_settings(&flown->scene);
    const char *bad = NULL;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_init(&flown->flight, sizeof flown->flight, &estimator, settings, &bad));
    TEST_ASSERT_NULL(bad);
}

static uint32_t time_of(const flown_t *flown, int k) { return flown->start_us + (uint32_t)(k * SAMPLE_US); }

uint32_t flown_now_us(const flown_t *flown) { return time_of(flown, flown->sample - 1); }

void flown_samples(const flown_t *flown, int k, goe_flight_attitude_t *attitude, goe_flight_position_t *position) {
    goe_image_t image;
    goe_image_t next;
    memset(attitude, 0, sizeof *attitude);
    memset(position, 0, sizeof *position);
    scene_image(&flown->scene, k, &image, NULL);
    scene_image(&flown->scene, k + 1, &next, NULL);
    attitude->time_us = position->time_us = time_of(flown, k);
    memcpy(attitude->q, image.pose.attitude, sizeof attitude->q);
    for (int i = 0; i < 3; i++) {
        const float step_m = next.pose.position_ned_m[i] - image.pose.position_ned_m[i];
        position->position_ned_m[i] = image.pose.position_ned_m[i] + flown->jump_ned_m[i] + flown->jumped_ned_m[i];
        position->velocity_ned_m_s[i] = step_m * (float)FLOWN_POSE_HZ;
    }
    position->height_m[GOE_FLIGHT_TERRAIN] = (float)flown->scene.ground_d_m - image.pose.position_ned_m[2];
    position->height_m[GOE_FLIGHT_TERRAIN] -=
        flown->height_follows ? flown->jump_ned_m[2] + flown->jumped_ned_m[2] : 0.0f;
    position->height_valid = 1u << GOE_FLIGHT_TERRAIN;
    position->reset_horizontal = flown->reset_horizontal;
    position->reset_vertical = flown->reset_vertical;
    position->reset_delta_known = flown->jump_known;
    memcpy(position->reset_delta_ned_m, flown->jump_ned_m, sizeof position->reset_delta_ned_m);
}

goe_flight_detection_t flown_detection(const flown_t *flown, int k) {
    goe_flight_detection_t detection;
    goe_image_t image;
    scene_t scene = flown->scene;
    memset(&detection, 0, sizeof detection);
    scene.upright_boxes = scene.boxes = !flown->points;
    scene_image(&scene, k, &image, NULL);
    detection.id = flown->id;
    detection.score = flown->score;
    detection.box = image.box;
    detection.kind = flown->kind;
    detection.left = image.left;
    detection.right = image.right;
    detection.top = image.top;
    detection.base_left = image.base_left;
    detection.base_near = image.base_near;
    detection.base_right = image.base_right;
    return detection;
}

goe_flight_frame_t flown_frame(const flown_t *flown, int k, const goe_flight_detection_t *detection, int count) {
    goe_flight_frame_t frame;
    memset(&frame, 0, sizeof frame);
    frame.arrival_us = flown_now_us(flown);
    frame.capture_us = time_of(flown, k);
    frame.time_sd_us = 1000u;
    frame.number = frame.count = (uint8_t)count;
    frame.detection = detection;
    return frame;
}

bool flown_step(flown_t *flown) {
    goe_flight_attitude_t attitude;
    goe_flight_position_t position;
    flown_samples(flown, flown->sample, &attitude, &position);
    flown->sample++;
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_attitude(&flown->flight, &attitude));
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_position(&flown->flight, &position));
    const int exposed = flown->sample - 1 - FLOWN_DELAY;
    if (exposed < 0 || exposed % FLOWN_IMAGE_EVERY != 0) {
        return false;
    }
    const goe_flight_detection_t detection = flown_detection(flown, exposed);
    const bool seen =
        flown->points ? detection.left.visible && detection.right.visible : detection.box.sides == GOE_SIDES_ALL;
    const bool detects = flown->detects && seen;
    const goe_flight_frame_t frame = flown_frame(flown, exposed, &detection, detects ? 1 : 0);
    const goe_flight_status_t status = goe_flight_frame(&flown->flight, &frame);
    /* the poses before an unknown reset are gone */
    TEST_ASSERT_TRUE(status == GOE_FLIGHT_OK || (flown->flight.counters.lost > 0u && status < 0));
    return true;
}

goe_flight_assessment_t flown_fly(flown_t *flown, double seconds) {
    goe_flight_assessment_t assessment;
    const int samples = (int)(seconds * FLOWN_POSE_HZ);
    for (int i = 0; i < samples; i++) {
        (void)flown_step(flown);
    }
    TEST_ASSERT_EQUAL(GOE_FLIGHT_OK, goe_flight_assess(&flown->flight, flown_now_us(flown), false, &assessment));
    return assessment;
}
