/* Replay of the embedded logs. SPDX-License-Identifier: MIT */
#include "replay.h"

#include <string.h>

#if defined(GOE_BARE_METAL)
#include "semihosting.h"
#else
#include <stdio.h>
void port_write_text(const char *text) { (void)fputs(text, stdout); }
#endif

#define FNV_OFFSET 0xCBF29CE484222325u
#define FNV_PRIME 0x100000001B3u

static void hash_word(replay_t *replay, uint32_t word) {
    for (int byte = 0; byte < 4; byte++) {
        replay->hash = (replay->hash ^ ((word >> (8 * byte)) & 0xFFu)) * FNV_PRIME;
    }
}

static void hash_number(replay_t *replay, float number) {
    uint32_t word;
    memcpy(&word, &number, sizeof word);
    hash_word(replay, word);
}

static void hash_numbers(replay_t *replay, const float *numbers, int count) {
    for (int i = 0; i < count; i++) {
        hash_number(replay, numbers[i]);
    }
}

static void hash_text(replay_t *replay, const char *text) {
    for (; *text != '\0'; text++) {
        hash_word(replay, (uint32_t)(unsigned char)*text);
    }
}

static void hash_sigma(replay_t *replay, const goe_sigma_t *sigma) {
    const float numbers[] = {sigma->x0_m,
                             sigma->z0_m,
                             sigma->x_m,
                             sigma->z_m,
                             sigma->width_m,
                             sigma->length_m,
                             sigma->height_m,
                             sigma->orientation_deg,
                             sigma->center_north_m,
                             sigma->center_east_m,
                             sigma->velocity_north_m_s,
                             sigma->velocity_east_m_s,
                             sigma->latency_s};
    hash_numbers(replay, numbers, (int)(sizeof numbers / sizeof numbers[0]));
}

static void hash_estimate(replay_t *replay, const goe_estimate_t *e) {
    const float numbers[] = {e->age_s,
                             e->velocity_north_m_s,
                             e->velocity_east_m_s,
                             e->latency_s,
                             e->x0_m,
                             e->z0_m,
                             e->x_m,
                             e->z_m,
                             e->width_m,
                             e->length_m,
                             e->height_m,
                             e->orientation_deg,
                             e->orientation_raw_deg,
                             e->front_orientation_deg,
                             e->length_axis[0],
                             e->length_axis[1],
                             e->width_axis[0],
                             e->width_axis[1],
                             e->length_axis_ne[0],
                             e->length_axis_ne[1],
                             e->width_axis_ne[0],
                             e->width_axis_ne[1],
                             e->trajectory_heading_deg,
                             e->center_north_m,
                             e->center_east_m,
                             e->center_ne_m2,
                             e->residual,
                             e->baseline_m,
                             e->nis,
                             e->nis_ratio};
    hash_word(replay, (uint32_t)e->method);
    hash_word(replay, (uint32_t)e->model);
    hash_word(replay, (uint32_t)e->valid);
    hash_word(replay, e->fresh ? 1u : 0u);
    hash_word(replay, e->suspect ? 1u : 0u);
    hash_text(replay, goe_reason_text(e->reason));
    hash_word(replay, (uint32_t)e->nis_rows);
    hash_word(replay, (uint32_t)e->images_used);
    hash_numbers(replay, numbers, (int)(sizeof numbers / sizeof numbers[0]));
    hash_sigma(replay, &e->sigma);
}

static void hash_status(replay_t *replay, goe_status_t status) {
    hash_word(replay, (uint32_t)(int)status);
    hash_text(replay, goe_status_text(status));
}

static void read_numbers(const uint32_t *bits, float *numbers, int count) {
    memcpy(numbers, bits, (size_t)count * sizeof *numbers);
}

void replay_read_image(const logged_image_t *logged, goe_image_t *image) {
    goe_pixel_t *pixels[] = {&image->left,      &image->right,     &image->top,
                             &image->base_left, &image->base_near, &image->base_right};
    memset(image, 0, sizeof *image);
    image->pose.time_us = logged->time_us;
    image->pose.reset_count = logged->reset_count;
    image->pose.reset_delta_known = logged->reset_delta_known != 0u;
    read_numbers(&logged->bits[0], image->pose.position_ned_m, 3);
    read_numbers(&logged->bits[3], &image->pose.height_m, 1);
    read_numbers(&logged->bits[4], image->pose.attitude, 4);
    read_numbers(&logged->bits[8], image->pose.reset_delta_ned_m, 3);
    for (int i = 0; i < 6; i++) {
        read_numbers(&logged->bits[11 + 2 * i], &pixels[i]->u_px, 1);
        read_numbers(&logged->bits[12 + 2 * i], &pixels[i]->v_px, 1);
        pixels[i]->visible = ((logged->seen >> i) & 1u) != 0u;
    }
    if (logged->box != 0u) {
        read_numbers(&logged->bits[11], &image->box.left_px, 4);
        image->box.sides = logged->box;
    }
}

void replay_read_settings(const logged_track_t *track, goe_method_t method, goe_settings_t *settings) {
    goe_camera_t *camera = &settings->camera;
    float *const fields[] = {&camera->fx_px,
                             &camera->fy_px,
                             &camera->cx_px,
                             &camera->cy_px,
                             &camera->k1,
                             &camera->k2,
                             &camera->p1,
                             &camera->p2,
                             &camera->k3,
                             &camera->mount_yaw_deg,
                             &camera->mount_pitch_deg,
                             &camera->mount_roll_deg,
                             &camera->offset_m[0],
                             &camera->offset_m[1],
                             &camera->offset_m[2],
                             &settings->heading_deg,
                             &camera->width_px,
                             &camera->height_px};
    goe_settings_default(settings);
    for (int i = 0; i < 18; i++) {
        read_numbers(&track->bits[i], fields[i], 1);
    }
    settings->method = method;
    settings->model = (goe_model_t)track->model;
    settings->window.points = track->window;
    settings->window.line_points = track->line_points;
    settings->window.orientation_memory = track->orientation_memory;
    settings->heading_auto = track->heading_auto != 0u;
#if GOE_WITH_FILTER
    settings->navigation.position_white_sd_m = (float)track->position_white_sd_m;
#endif
}

replay_t replay_start(void) {
    const replay_t replay = {FNV_OFFSET, 0};
    return replay;
}

static goe_status_t init_track(replay_t *replay, goe_estimator_t *estimator, const logged_track_t *track,
                               goe_method_t method) {
    goe_settings_t settings;
    const char *bad = NULL;
    replay_read_settings(track, method, &settings);
    const goe_status_t status = goe_init(estimator, sizeof *estimator, &settings, &bad);
    hash_status(replay, status);
    hash_text(replay, bad ? bad : "");
    return status;
}

static void hash_covariance(replay_t *replay, const goe_estimator_t *estimator) {
    float covariance[GOE_QUANTITIES][GOE_QUANTITIES];
    hash_status(replay, goe_covariance(estimator, covariance));
    hash_numbers(replay, &covariance[0][0], GOE_QUANTITIES * GOE_QUANTITIES);
}

#if GOE_WITH_HAZARD
static void hash_hazard(replay_t *replay, const goe_estimator_t *estimator) {
    static const goe_intent_t intent = {{15.0f, 1.0f, -0.5f}, 10.0f, 5.0f, 0.0f, 0.0f};
    goe_hazard_t hazard;
    hash_status(replay, goe_hazard(estimator, &intent, &hazard));
    const float numbers[] = {hazard.tcpa_s,    hazard.dcpa_m,    hazard.clearance_m,   hazard.conflict_probability,
                             hazard.tcpa_sd_s, hazard.dcpa_sd_m, hazard.clearance_sd_m};
    hash_numbers(replay, numbers, (int)(sizeof numbers / sizeof numbers[0]));
    hash_word(replay, hazard.has_clearance ? 1u : 0u);
}

/* For the cost ledger. Its decisions depend on bits that are in the hash. */
static void decide(const goe_estimator_t *estimator) {
    static const goe_intent_t intent = {{15.0f, 1.0f, -0.5f}, 10.0f, 5.0f, 0.5f, 0.2f};
    goe_rule_t rule;
    goe_hazard_t hazard;
    goe_rule_default(&rule);
    (void)!goe_decide(estimator, &intent, &rule, &hazard);
    (void)goe_earliest_tcpa_s(&hazard);
}
#else
static void hash_hazard(replay_t *replay, const goe_estimator_t *estimator) {
    (void)replay;
    (void)estimator;
}

static void decide(const goe_estimator_t *estimator) { (void)estimator; }
#endif

static void replay_images(replay_t *replay, goe_estimator_t *estimator, const logged_track_t *track) {
    for (int k = 0; k < track->count; k++) {
        goe_image_t image;
        goe_estimate_t estimate;
        memset(&estimate, 0, sizeof estimate);
        replay_read_image(&logged_images[track->first + k], &image);
        hash_status(replay, goe_update(estimator, &image, &estimate));
        hash_estimate(replay, &estimate);
        hash_covariance(replay, estimator);
        hash_hazard(replay, estimator);
        decide(estimator);
        replay->images++;
    }
    for (int i = 0; i < GOE_FAULT_COUNTS; i++) {
        hash_word(replay, estimator->fault_counts[i]);
    }
}

const goe_method_t replay_methods[REPLAY_METHODS] = {GOE_METHOD_WINDOW, GOE_METHOD_FILTER};

void replay_all(replay_t *replay) {
    static goe_estimator_t estimator;
    for (int t = 0; t < logged_track_count * REPLAY_METHODS; t++) {
        const logged_track_t *track = &logged_tracks[t / REPLAY_METHODS];
        if (init_track(replay, &estimator, track, replay_methods[t % REPLAY_METHODS]) == GOE_OK) {
            replay_images(replay, &estimator, track);
            hash_status(replay, goe_reset(&estimator));
        }
    }
}

/* The answers of a method alone, independent of other compiled parts: the window method always, the filter method where it
 * has solved an image. */
static void replay_own(replay_parts_t *parts, goe_estimator_t *estimator, const logged_track_t *track,
                       goe_method_t method) {
    replay_t *own = method == GOE_METHOD_WINDOW ? &parts->window : &parts->filter;
    replay_t *hazard = method == GOE_METHOD_WINDOW ? &parts->window_hazard : &parts->refined_hazard;
    for (int k = 0; k < track->count; k++) {
        goe_image_t image;
        goe_estimate_t estimate;
        replay_read_image(&logged_images[track->first + k], &image);
        const goe_status_t status = goe_update(estimator, &image, &estimate);
        const bool solved = estimate.method == GOE_METHOD_FILTER && estimate.fresh;
        if (method == GOE_METHOD_WINDOW || solved) {
            hash_status(own, status);
            hash_estimate(own, &estimate);
            hash_covariance(own, estimator);
            hash_hazard(hazard, estimator);
            decide(estimator);
            hazard->images++;
            own->images++;
        }
    }
}

void replay_parts(replay_parts_t *parts) {
    static goe_estimator_t estimator;
    const replay_parts_t begin = {replay_start(), replay_start(), replay_start(), replay_start()};
    replay_t dropped = replay_start();
    *parts = begin;
    for (int t = 0; t < logged_track_count * REPLAY_METHODS; t++) {
        const logged_track_t *track = &logged_tracks[t / REPLAY_METHODS];
        const goe_method_t method = replay_methods[t % REPLAY_METHODS];
        if (init_track(&dropped, &estimator, track, method) == GOE_OK) {
            replay_own(parts, &estimator, track, method);
        }
    }
}

void replay_hash_text(uint64_t hash, char text[17]) {
    static const char digits[] = "0123456789abcdef";
    for (int i = 0; i < 16; i++) {
        text[i] = digits[(hash >> (60 - 4 * i)) & 0xFu];
    }
    text[16] = '\0';
}

void replay_write_count(long count) {
    char text[12];
    int at = 11;
    text[at] = '\0';
    do {
        text[--at] = (char)('0' + count % 10);
        count /= 10;
    } while (count > 0);
    port_write_text(&text[at]);
}
