/* Prints one line: the hash over all outputs of the flight layer for the embedded logs. SPDX-License-Identifier: MIT
 *
 *   flight <hash> frames <n>
 *
 * Every logged image gives a sample of attitude and position, and a frame that comes two images late. An assessment follows each,
 * and all reports of the layer are hashed. The logs' times are shifted so that the 32 bits wrap in flight. */
#include <string.h>

#include "goe_flight.h"
#include "replay.h"

#if defined(GOE_BARE_METAL)
#include "semihosting.h"
#endif

#define IMAGE_PX 1280.0f
#define LATE 2 /* images */
#define MAX_CM 20000u
#define FNV_PRIME 0x100000001B3u

static goe_flight_t flight;

static void hash_words(replay_t *replay, const uint32_t *words, size_t count) {
    for (size_t i = 0; i < count; i++) {
        for (int byte = 0; byte < 4; byte++) {
            replay->hash = (replay->hash ^ ((words[i] >> (8 * byte)) & 0xFFu)) * FNV_PRIME;
        }
    }
}

static void hash_word(replay_t *replay, uint32_t word) { hash_words(replay, &word, 1u); }

static void hash_numbers(replay_t *replay, const float *numbers, size_t count) {
    for (size_t i = 0; i < count; i++) {
        uint32_t word;
        memcpy(&word, &numbers[i], sizeof word);
        hash_word(replay, word);
    }
}

static void hash_hazard(replay_t *replay, const goe_hazard_t *hazard) {
    hash_numbers(replay, &hazard->tcpa_s, 7u);
    hash_word(replay, hazard->has_clearance ? 1u : 0u);
}

static void hash_assessment(replay_t *replay, const goe_flight_assessment_t *a) {
    hash_word(replay, (uint32_t)a->action);
    hash_word(replay,
              (a->late ? 1u : 0u) + (a->suspect ? 2u : 0u) + (a->detector_alive ? 4u : 0u) + (a->pose_alive ? 8u : 0u));
    hash_word(replay, (uint32_t)(int32_t)a->worst);
    hash_word(replay, (uint32_t)(int32_t)a->avoided);
    hash_word(replay, a->obstacles);
    hash_numbers(replay, &a->needed_s, 1u);
    hash_numbers(replay, a->target_ned_m, 3u);
    hash_word(replay, (uint32_t)a->target_lat_e7);
    hash_word(replay, (uint32_t)a->target_lon_e7);
    hash_hazard(replay, &a->hazard);
}

static void hash_obstacle(replay_t *replay, const goe_flight_obstacle_t *o) {
    hash_word(replay, o->id);
    hash_word(replay, (uint32_t)o->valid);
    hash_word(replay, (uint32_t)o->model);
    hash_word(replay,
              (o->suspect ? 1u : 0u) + (o->receding ? 2u : 0u) + (o->in_view ? 4u : 0u) + (o->has_hazard ? 8u : 0u));
    hash_numbers(replay, &o->age_s, 1u);
    hash_numbers(replay, o->center_ned_m, 3u);
    hash_numbers(replay, o->covariance_ne_m2, 3u);
    const float numbers[] = {o->radius_m, o->height_m, o->height_sd_m, o->width_m, o->length_m, o->length_heading_deg};
    hash_numbers(replay, numbers, sizeof numbers / sizeof numbers[0]);
    hash_numbers(replay, o->nearest_ned_m, 3u);
    hash_numbers(replay, o->nearest_body_m, 3u);
    hash_word(replay, (uint32_t)o->lat_e7);
    hash_word(replay, (uint32_t)o->lon_e7);
    hash_hazard(replay, &o->hazard);
}

/* ------------------------------------------------------------------------------------------------------------- input -- */

static uint32_t time_of(const logged_track_t *track, int k) {
    return 0xFFF00000u + (uint32_t)(logged_images[track->first + k].time_us - logged_images[track->first].time_us);
}

/* The velocity that the logs lack: the change of the position since the image before, so that the two agree. */
static void find_velocity(const logged_track_t *track, int k, float velocity_ned_m_s[3]) {
    static const float first_m_s[3] = {15.0f, 1.0f, -0.5f};
    goe_image_t now;
    goe_image_t before;
    memcpy(velocity_ned_m_s, first_m_s, sizeof first_m_s);
    if (k == 0) {
        return;
    }
    replay_read_image(&logged_images[track->first + k], &now);
    replay_read_image(&logged_images[track->first + k - 1], &before);
    const float s = (float)(int32_t)(time_of(track, k) - time_of(track, k - 1)) * 1.0e-6f;
    for (int i = 0; i < 3; i++) {
        velocity_ned_m_s[i] = (now.pose.position_ned_m[i] - before.pose.position_ned_m[i]) / s;
    }
}

static void give_samples(replay_t *replay, const logged_track_t *track, int k, const goe_image_t *image) {
    goe_flight_attitude_t attitude;
    goe_flight_position_t position;
    memset(&attitude, 0, sizeof attitude);
    memset(&position, 0, sizeof position);
    attitude.time_us = position.time_us = time_of(track, k);
    memcpy(attitude.q, image->pose.attitude, sizeof attitude.q);
    memcpy(position.position_ned_m, image->pose.position_ned_m, sizeof position.position_ned_m);
    memcpy(position.reset_delta_ned_m, image->pose.reset_delta_ned_m, sizeof position.reset_delta_ned_m);
    find_velocity(track, k, position.velocity_ned_m_s);
    position.height_m[GOE_FLIGHT_TERRAIN] = image->pose.height_m;
    position.height_valid = 1u << GOE_FLIGHT_TERRAIN;
    position.origin_known = true;
    position.origin_lat_e7 = 474000000;
    position.origin_lon_e7 = 85000000;
    position.reset_horizontal = position.reset_vertical = image->pose.reset_count;
    position.reset_delta_known = image->pose.reset_delta_known;
    hash_word(replay, (uint32_t)(int)goe_flight_attitude(&flight, &attitude));
    hash_word(replay, (uint32_t)(int)goe_flight_position(&flight, &position));
}

static void give_frame(replay_t *replay, const logged_track_t *track, int k, const goe_image_t *image) {
    goe_flight_detection_t detection;
    goe_flight_frame_t frame;
    memset(&detection, 0, sizeof detection);
    memset(&frame, 0, sizeof frame);
    detection.id = 1u;
    detection.score = 1.0f;
    detection.box = image->box;
    detection.left = image->left;
    detection.right = image->right;
    detection.top = image->top;
    detection.base_left = image->base_left;
    detection.base_near = image->base_near;
    detection.base_right = image->base_right;
    frame.arrival_us = time_of(track, k + LATE);
    frame.capture_us = time_of(track, k);
    frame.time_sd_us = 3000u;
    frame.number = frame.count = 1u;
    frame.detection = &detection;
    hash_word(replay, (uint32_t)(int)goe_flight_frame(&flight, &frame));
}

/* ------------------------------------------------------------------------------------------------------------ output -- */

static void read_layer(replay_t *replay, uint32_t now_us, bool approach) {
    goe_flight_assessment_t assessment;
    goe_flight_obstacle_t obstacle;
    uint16_t sector_cm[GOE_FLIGHT_SECTORS] = {0};
    hash_word(replay, (uint32_t)(int)goe_flight_assess(&flight, now_us, approach, &assessment));
    hash_assessment(replay, &assessment);
    hash_word(replay, (uint32_t)(int)goe_flight_obstacle(&flight, 0, &obstacle));
    hash_obstacle(replay, &obstacle);
    hash_word(replay, (uint32_t)(int)goe_flight_sectors(&flight, MAX_CM, sector_cm));
    for (int i = 0; i < GOE_FLIGHT_SECTORS; i++) {
        hash_word(replay, sector_cm[i]);
    }
}

static void fly(replay_t *replay, const logged_track_t *track) {
    goe_settings_t estimator;
    goe_flight_settings_t settings;
    replay_read_settings(track, GOE_METHOD_FILTER, &estimator);
    goe_flight_settings_default(&settings);
    settings.confirm_images = 1.0f;
    if (!(estimator.camera.width_px > 0.0f)) {
        estimator.camera.width_px = estimator.camera.height_px = IMAGE_PX;
    }
    const goe_flight_status_t status = goe_flight_init(&flight, sizeof flight, &estimator, &settings, NULL);
    hash_word(replay, (uint32_t)(int)status);
    for (int k = 0; k < track->count && status == GOE_FLIGHT_OK; k++) {
        goe_image_t image;
        replay_read_image(&logged_images[track->first + k], &image);
        give_samples(replay, track, k, &image);
        if (k >= LATE) {
            replay_read_image(&logged_images[track->first + k - LATE], &image);
            give_frame(replay, track, k - LATE, &image);
            replay->images++;
        }
        read_layer(replay, time_of(track, k), k % 16 < 8);
    }
}

int main(void) {
    char text[17];
    replay_t replay = replay_start();
    for (int t = 0; t < logged_track_count; t++) {
        fly(&replay, &logged_tracks[t]);
    }
    replay_hash_text(replay.hash, text);
    port_write_text("flight ");
    port_write_text(text);
    port_write_text(" frames ");
    replay_write_count(replay.images);
    port_write_text("\n");
    return 0;
}
