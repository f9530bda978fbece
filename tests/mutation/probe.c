/* Computes one hash of the library's behavior for each kind of input. SPDX-License-Identifier: MIT
 *
 * `python -m ci evidence --only mutation` runs it with the library and with each mutant that no unit test notices: lines
 * that differ show what the mutant changes, and a mutant that changes none counts as the same program. It asserts nothing. Its
 * hashes depend on this machine: they are compared with those of the unchanged library, never stored. */
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "check.h"
#include "image/goe_ego_motion.h"
#include "replay.h"
#include "scene.h"

#define FLIGHTS 500
#define IMAGES 44
#define HOSTILE_TRACKS 120
#define PLANS 3
#define FNV_PRIME 0x100000001B3u

static goe_estimator_t estimator;
static check_random_t any;
static uint64_t hash;

void setUp(void) {}
void tearDown(void) {}

static uint32_t below(uint32_t limit) { return check_random_bits(&any) % limit; }
static bool one_in(uint32_t n) { return below(n) == 0u; }
static double between(double low, double high) { return check_random_between(&any, low, high); }

/* ------------------------------------------------------------------------------------------------------------- hashing -- */

static void add_bytes(const void *bytes, size_t count) {
    const unsigned char *byte = bytes;
    for (size_t i = 0; i < count; i++) {
        hash = (hash ^ byte[i]) * FNV_PRIME;
    }
}

static void add_number(int number) { add_bytes(&number, sizeof number); }

static void add_text(const char *text) { add_bytes(text ? text : "", text ? strlen(text) : 0u); }

/* A struct's own padding is undefined. */
static void add_estimate(const goe_estimate_t *e) {
    add_number((int)e->method);
    add_number((int)e->model);
    add_number((int)e->valid);
    add_number(e->fresh ? 1 : 0);
    add_number(e->suspect ? 1 : 0);
    add_number((int)e->reason);
    add_bytes(&e->images_used, sizeof *e - offsetof(goe_estimate_t, images_used));
}

static void begin(uint64_t seed) {
    hash = 0xCBF29CE484222325u;
    any.state = seed * 2654435761u + 88172645463325252u;
    for (int i = 0; i < 8; i++) {
        (void)check_random_bits(&any);
    }
}

static void print_hash(const char *what) { printf("%s %016llx\n", what, (unsigned long long)hash); }

static void add_answers(void) {
    float covariance[GOE_QUANTITIES][GOE_QUANTITIES];
    add_number((int)goe_covariance(&estimator, covariance));
    add_bytes(covariance, sizeof covariance);
    for (int i = 0; i < PLANS; i++) {
        goe_hazard_t hazard;
        const goe_intent_t intent = {
            {(float)between(-20.0, 25.0), (float)between(-20.0, 20.0), (float)between(-3.0, 3.0)},
            (float)between(0.0, 30.0),
            (float)between(0.0, 20.0),
            one_in(3) ? (float)between(0.0, 2.0) : 0.0f,
            one_in(3) ? (float)between(0.0, 1.0) : 0.0f};
        add_number((int)goe_hazard(&estimator, &intent, &hazard));
        add_bytes(&hazard, offsetof(goe_hazard_t, has_clearance));
        add_number(hazard.has_clearance ? 1 : 0);
    }
}

static void update(const goe_image_t *image) {
    goe_estimate_t estimate;
    memset(&estimate, 0, sizeof estimate);
    add_number((int)goe_update(&estimator, image, &estimate));
    add_estimate(&estimate);
    add_answers();
}

/* ------------------------------------------------------------------------------------------------------------- flights -- */

/* Obstacle and path of a flight, and the errors of its pose and detector. */
typedef struct {
    scene_t scene;
    bool moving, late, outline_only, gaps, resets, own_noise;
    double north_m_s, east_m_s, noise_px, cut_px;
} flight_t;

static void any_scene(scene_t *s) {
    scene_default(s);
    if (one_in(3)) {
        scene_make_cylinder(s);
        s->width_m = between(1.0, 40.0);
    }
    s->z0_m = between(30.0, 260.0);
    s->x0_m = between(-0.5, 0.5) * s->z0_m;
    s->width_m = s->shape == SCENE_BOX ? between(2.0, 30.0) : s->width_m;
    s->length_m = between(2.0, 40.0);
    s->height_m = between(2.0, 60.0);
    s->alpha_deg = between(-80.0, 80.0);
    s->path = (scene_path_t)below(3);
    s->arc_radius_m = (one_in(2) ? -1.0 : 1.0) * between(150.0, 900.0);
    s->weave_amplitude_m = between(1.0, 15.0);
    s->weave_period_s = between(3.0, 12.0);
    s->speed_mps = between(4.0, 30.0);
    s->acceleration_mps2 = one_in(3) ? between(-1.0, 1.0) : 0.0;
    s->image_rate_hz = between(3.0, 30.0);
    s->course_deg = between(-180.0, 180.0);
    s->altitude_m = between(3.0, 80.0);
    s->glide_deg = one_in(2) ? between(-2.0, 6.0) : 0.0;
    s->yaw_deg = between(-15.0, 15.0);
    s->pitch_deg = between(-10.0, 10.0);
    s->roll_deg = between(-10.0, 10.0);
    s->wobble_deg = one_in(2) ? between(0.0, 8.0) : 0.0;
    s->roll_swing_deg = one_in(3) ? between(0.0, 15.0) : 0.0;
    s->roll_swing_hz = between(0.2, 2.0);
    s->ground_d_m = between(-50.0, 50.0);
    s->boxes = one_in(3);
    s->upright_boxes = !s->boxes && one_in(5);
    s->top_nearest = one_in(2);
    s->camera.k1 = one_in(3) ? (float)between(-0.2, 0.2) : 0.0f;
    s->camera.p1 = one_in(5) ? (float)between(-0.01, 0.01) : 0.0f;
    s->camera.mount_yaw_deg = (float)between(-10.0, 10.0);
    s->camera.mount_roll_deg = one_in(3) ? (float)between(-180.0, 180.0) : 0.0f;
    s->camera.offset_m[0] = (float)between(-2.0, 2.0);
    s->camera.offset_m[2] = (float)between(-2.0, 2.0);
    if (one_in(2)) {
        s->camera.width_px = 2.0f * s->camera.cx_px;
        s->camera.height_px = 2.0f * s->camera.cy_px;
    }
}

static void any_settings(const flight_t *flight, goe_settings_t *settings) {
    goe_navigation_t *navigation = &settings->navigation;
    goe_detector_t *detector = &settings->detector;
    *settings = one_in(5) ? scene_window_settings(&flight->scene) : scene_settings(&flight->scene);
    settings->model = one_in(3) ? (goe_model_t)(2u + below(2)) : GOE_MODEL_AUTO;
    settings->heading_auto = !one_in(4);
    settings->heading_deg = (float)flight->scene.course_deg;
    settings->window.points = 3 + (int)below(6);
    settings->window.line_points = 1 + (int)below(12);
    settings->window.orientation_memory = 1 + (int)below(30);
    navigation->attitude_walk_sd_deg = one_in(3) ? (float)between(0.0, 0.3) : 0.0f;
    navigation->position_walk_sd_m = (float)between(0.0, 0.3);
    navigation->position_white_sd_m = one_in(3) ? (float)between(0.0, 0.5) : 0.0f;
    navigation->height_white_sd_m = one_in(3) ? (float)between(0.0, 1.0) : 0.0f;
    navigation->velocity_bias_sd_m_s = (float)between(0.0, 0.3);
    navigation->terrain_slope_sd = one_in(3) ? (float)between(0.0, 0.1) : 0.0f;
    navigation->terrain_height_sd_m = (float)between(0.0, 5.0);
    detector->point_noise_px = (float)(0.3 + flight->noise_px);
    detector->point_noise_rel = one_in(3) ? (float)between(0.0, 0.1) : 0.0f;
    detector->point_correlation = one_in(3) ? (float)between(0.0, 0.9) : 0.0f;
    detector->shape_error_rel = one_in(3) ? (float)between(0.0, 0.2) : 0.0f;
    detector->box_noise_px = (float)(0.3 + flight->noise_px);
    detector->box_noise_rel = (float)between(0.0, 0.1);
    detector->box_correlation_time_s = (float)between(0.0, 3.0);
    settings->filter.top_is_highest = one_in(2);
    settings->filter.nis_ratio_max = (float)between(0.5, 3.0);
    settings->filter.range_sd_rel_max = one_in(3) ? (float)between(0.05, 1.0) : 0.25f;
    settings->filter.prior_width_m = (float)between(2.0, 30.0);
}

static void any_flight(flight_t *flight) {
    memset(flight, 0, sizeof *flight);
    any_scene(&flight->scene);
    flight->moving = one_in(4);
    flight->late = one_in(5);
    flight->outline_only = one_in(4);
    flight->gaps = one_in(3);
    flight->resets = one_in(6);
    flight->own_noise = one_in(4);
    flight->north_m_s = between(-12.0, 12.0);
    flight->east_m_s = between(-8.0, 8.0);
    flight->noise_px = one_in(4) ? 0.0 : between(0.0, 3.0);
}

static void drop_features(const flight_t *flight, goe_image_t *image) {
    goe_pixel_t *features[] = {&image->left,      &image->right,     &image->top,
                               &image->base_left, &image->base_near, &image->base_right};
    for (size_t i = 0; i < 6; i++) {
        const bool base = i >= 3;
        features[i]->visible =
            features[i]->visible && !(flight->outline_only && base) && !(flight->gaps && one_in(base ? 5u : 8u));
    }
    image->box.sides = (uint8_t)(image->box.sides & (flight->gaps && one_in(5) ? below(16) : 15u));
}

static void disturb(const flight_t *flight, int k, goe_image_t *image) {
    const double t = k / flight->scene.image_rate_hz;
    goe_image_t before;
    if (flight->late) {
        const int64_t time_us = image->pose.time_us;
        scene_image(&flight->scene, k > 0 ? k - 1 : 0, &before, NULL);
        image->pose = before.pose;
        image->pose.time_us = time_us;
    }
    if (flight->moving) {
        image->pose.position_ned_m[0] += (float)(flight->north_m_s * t);
        image->pose.position_ned_m[1] += (float)(flight->east_m_s * t);
    }
    if (flight->resets && k > 20) {
        image->pose.reset_count = k > 35 ? 2 : 1;
        image->pose.reset_delta_known = k <= 35;
        image->pose.reset_delta_ned_m[0] = 3.0f;
        image->pose.position_ned_m[0] += 3.0f;
    }
    if (flight->own_noise) {
        image->noise =
            (goe_image_noise_t){(float)between(0.0, 1.0), (float)between(0.0, 2.0), (float)between(0.0, 2.0)};
    }
    scene_add_noise(image, &any, flight->noise_px);
    image->box.left_px += (float)(flight->noise_px * check_random_normal(&any));
    image->box.right_px += (float)(flight->noise_px * check_random_normal(&any));
    image->box.top_px += (float)(flight->noise_px * check_random_normal(&any));
    image->box.bottom_px += (float)(flight->noise_px * check_random_normal(&any));
    drop_features(flight, image);
}

static void fly(int number) {
    flight_t flight;
    goe_settings_t settings;
    const char *bad = NULL;
    begin((uint64_t)number + 1u);
    any_flight(&flight);
    any_settings(&flight, &settings);
    add_number((int)goe_init(&estimator, sizeof estimator, &settings, &bad));
    add_text(bad);
    for (int k = 0; k < IMAGES; k++) {
        goe_image_t image;
        if (flight.gaps && k > 15 && k < 22) {
            continue;
        }
        scene_image(&flight.scene, k, &image, NULL);
        disturb(&flight, k, &image);
        update(&image);
    }
    add_bytes(estimator.fault_counts, sizeof estimator.fault_counts);
}

static void flights(void) {
    uint64_t all = 0;
    for (int i = 0; i < FLIGHTS; i++) {
        fly(i);
        all = all * 31u + hash;
    }
    hash = all;
    print_hash("flights");
}

/* ---------------------------------------------------------------------------------------------------------- bad input -- */

static void spoil(void *memory, size_t size) {
    const uint32_t bits = one_in(3) ? 0x7FC00000u : one_in(2) ? 0xFF800000u : check_random_bits(&any);
    memcpy((unsigned char *)memory + 4u * below((uint32_t)(size / 4u)), &bits, sizeof bits);
}

/* An estimator in flight, and images with overwritten words; only legal values for a bool. */
static void hostile(void) {
    uint64_t all = 0;
    for (int i = 0; i < HOSTILE_TRACKS; i++) {
        flight_t flight;
        goe_settings_t settings;
        begin((uint64_t)i + 1000u);
        any_flight(&flight);
        any_settings(&flight, &settings);
        (void)goe_init(&estimator, sizeof estimator, &settings, NULL);
        for (int k = 0; k < IMAGES; k++) {
            goe_image_t image;
            scene_image(&flight.scene, k, &image, NULL);
            disturb(&flight, k, &image);
            if (one_in(3)) {
                float *const parts[] = {image.pose.position_ned_m, &image.pose.height_m, image.pose.attitude,
                                        &image.left.u_px,          &image.top.u_px,      &image.base_near.u_px,
                                        &image.box.left_px,        &image.box.top_px,    &image.noise.attitude_sd_deg};
                spoil(parts[below(9)], 8u);
            }
            if (one_in(20)) {
                image.pose.time_us -= 1000000;
            }
            image.camera = one_in(30) ? 1 : 0;
            update(&image);
        }
        add_bytes(estimator.fault_counts, sizeof estimator.fault_counts);
        all = all * 31u + hash;
    }
    hash = all;
    print_hash("hostile");
}

/* ------------------------------------------------------------------------------------------------ calls without a flight -- */

/* Each number of the settings alone, set to each end of the float range; the name of a refused one is reported. */
static void settings_alone(void) {
    static const float values[] = {0.0f,   -1.0f,  1.0e-4f, 0.05f, 0.5f,   1.0f,     2.0f,    30.0f,
                                   100.0f, 360.0f, 1000.0f, 1e4f,  1.0e5f, 1.001e5f, -1.0e5f, 1.0e30f};
    goe_settings_t settings;
    begin(1);
    goe_settings_default(&settings);
    add_bytes(&settings, sizeof settings);
    for (size_t place = 0; place + 4 <= sizeof settings; place += 4) {
        for (size_t i = 0; i < sizeof values / sizeof values[0]; i++) {
            const char *bad = NULL;
            goe_settings_default(&settings);
            settings.camera.fx_px = settings.camera.fy_px = 900.0f;
            settings.camera.cx_px = settings.camera.cy_px = 640.0f;
            memcpy((unsigned char *)&settings + place, &values[i], sizeof values[i]);
            add_number((int)goe_init(&estimator, sizeof estimator, &settings, &bad));
            add_text(bad);
        }
    }
    print_hash("settings");
}

static void calls(void) {
    goe_estimate_t estimate;
    goe_image_t image;
    goe_hazard_t hazard;
    const goe_intent_t intent = {{1.0f, 0.0f, 0.0f}, 1.0f, 1.0f, 0.0f, 0.0f};
    begin(2);
    for (int i = -40; i < 40; i++) {
        add_text(goe_status_text((goe_status_t)i));
        add_text(goe_reason_text((goe_reason_t)i));
    }
    add_number((int)goe_self_check());
    memset(&estimator, 0, sizeof estimator);
    memset(&image, 0, sizeof image);
    add_number((int)goe_update(&estimator, &image, &estimate));
    add_number((int)goe_update(NULL, &image, &estimate));
    add_number((int)goe_update(&estimator, NULL, &estimate));
    add_number((int)goe_update(&estimator, &image, NULL));
    add_number((int)goe_reset(&estimator));
    add_number((int)goe_reset(NULL));
    add_number((int)goe_hazard(&estimator, &intent, &hazard));
    add_number((int)goe_hazard(NULL, &intent, &hazard));
    add_number((int)goe_hazard(&estimator, NULL, &hazard));
    add_number((int)goe_hazard(&estimator, &intent, NULL));
    add_number((int)goe_init(NULL, sizeof estimator, NULL, NULL));
    add_number((int)goe_init(&estimator, 1, NULL, NULL));
    print_hash("calls");
}

int main(void) {
    char text[17];
    replay_t replay = replay_start();
    replay_all(&replay);
    replay_hash_text(replay.hash, text);
    printf("replay %s\n", text);
    calls();
    settings_alone();
    hostile();
    flights();
    return 0;
}
