/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "flown.h"

#include <math.h>
#include <string.h>

#include "image_box.h"

#define SAMPLE_STEPS 2 /* 50 Hz */
#define FRAME_STEPS 10 /* 10 Hz */
#define ROLL_HZ 0.4
#define ROLL_DEG 10.0
#define LOST_FRAMES 0.05
#define BLIND_EVERY_S 5.0 /* of an aircraft whose detector drops out: sees for VISIBLE_S, then nothing */
#define VISIBLE_S 3.0
#define FORGOTTEN_S 1.5 /* undetected for so long, a tracker takes an obstacle for a new one */
#define WIND_MAX_MPS 4.0
#define TURBULENCE_MAX_MPS 5.0 /* wind at 6 m */
#define CLOCK_START_US 4000000000u

double flown_between(random_t *random, double low, double high) { return low + (high - low) * random_uniform(random); }

/* ------------------------------------------------------------------------------------------------------------- scene -- */

double flown_half_across_m(const obstacle_t *obstacle, double course_rad) {
    const double turned = obstacle->heading_rad - course_rad;
    return obstacle->kind == OBSTACLE_CYLINDER
               ? 0.5 * obstacle->width_m
               : 0.5 * (fabs(obstacle->width_m * cos(turned)) + fabs(obstacle->length_m * sin(turned)));
}

void flown_put(const flown_t *flown, obstacle_t *obstacle, double along_m, double right_m) {
    const double c = cos(flown->course_rad), s = sin(flown->course_rad);
    obstacle_place(obstacle, c * along_m - s * right_m, s * along_m + c * right_m, 0.0, obstacle->heading_rad);
}

void flown_on_path(const flown_t *flown, double north_m, double east_m, double *along_m, double *right_m) {
    const double c = cos(flown->course_rad), s = sin(flown->course_rad);
    *along_m = c * north_m + s * east_m;
    *right_m = c * east_m - s * north_m;
}

double flown_distance_m(const obstacle_t *obstacle, double north_m, double east_m, double up_m) {
    const double north = north_m - obstacle->center_n_m, east = east_m - obstacle->center_e_m;
    const double above = fmax(up_m - obstacle->height_m, 0.0);
    if (obstacle->kind == OBSTACLE_CYLINDER) {
        return hypot(fmax(hypot(north, east) - 0.5 * obstacle->width_m, 0.0), above);
    }
    const double c = cos(obstacle->heading_rad), s = sin(obstacle->heading_rad);
    const double along = fmax(fabs(c * north + s * east) - 0.5 * obstacle->length_m, 0.0);
    const double across = fmax(fabs(c * east - s * north) - 0.5 * obstacle->width_m, 0.0);
    return sqrt(along * along + across * across + above * above);
}

/* ------------------------------------------------------------------------------------------------------------- start -- */

static void start_sensors(flown_t *flown, uint64_t sensor_seed) {
    sensor_noise_t noise;
    flown->camera = camera_default();
    flown->camera.mount_yaw_deg = 0.0;
    camera_prepare(&flown->camera);
    (void)sensor_noise_parse("field", &noise);
    noise.drop_rate = LOST_FRAMES;
    for (int i = 0; i < FLOWN_MAX; i++) {
        flown->sensors[i] = sensors_start(&noise, sensor_seed + (uint64_t)i);
    }
}

const char *flown_start(flown_t *flown, random_t *random, uint64_t seed, uint64_t sensor_seed, double height_m,
                        double climb_rad) {
    const double wind = flown_between(random, 0.0, WIND_MAX_MPS), towards = flown_between(random, -SIM_PI, SIM_PI);
    const vec3_t start = {0.0, 0.0, -height_m};
    flown->air.wind_ned_mps.x = wind * cos(towards);
    flown->air.wind_ned_mps.y = wind * sin(towards);
    flown->turbulence = turbulence_start(flown_between(random, 0.0, TURBULENCE_MAX_MPS), AIRCRAFT_SPAN_M, seed);
    start_sensors(flown, sensor_seed);
    return aircraft_start(&flown->aircraft, start, flown->speed_mps, climb_rad, flown->course_rad,
                          flown->air.wind_ned_mps)
               ? NULL
               : "the aircraft cannot fly so";
}

const char *flown_start_layer(flown_t *flown, double circle_m) {
    const camera_t *camera = &flown->camera;
    goe_settings_t estimator;
    goe_flight_settings_t settings;
    goe_settings_default(&estimator);
    goe_flight_settings_default(&settings);
    settings.loiter_m = (float)circle_m;
    estimator.camera.fx_px = (float)camera->fx_px;
    estimator.camera.fy_px = (float)camera->fy_px;
    estimator.camera.cx_px = (float)camera->cx_px;
    estimator.camera.cy_px = (float)camera->cy_px;
    estimator.camera.width_px = (float)camera->width_px;
    estimator.camera.height_px = (float)camera->height_px;
    return goe_flight_init(&flown->flight, sizeof flown->flight, &estimator, &settings, NULL) == GOE_FLIGHT_OK
               ? NULL
               : "the flight layer refuses its settings";
}

/* ------------------------------------------------------------------------------------------------------------ sensed -- */

uint32_t flown_clock_us(double t_s) { return CLOCK_START_US + (uint32_t)llround(1e6 * t_s); }

static pose_t true_pose(const flown_t *flown) {
    const vec3_t roll = {flown->rolls ? radians(ROLL_DEG) * sin(2.0 * SIM_PI * ROLL_HZ * flown->t_s) : 0.0, 0.0, 0.0};
    pose_t pose;
    pose.position_ned_m = flown->aircraft.state.position_ned_m;
    pose.attitude = quat_multiply(flown->aircraft.state.attitude, quat_from_rotation_vector(roll));
    return pose;
}

static void sample(flown_t *flown) {
    goe_flight_attitude_t attitude;
    goe_flight_position_t position;
    sensors_t *sensors = &flown->sensors[0];
    const pose_t truth = true_pose(flown);
    const pose_t sensed = sensors_pose(sensors, &truth, flown->t_s);
    const vec3_t moving = vec3_add(aircraft_ground_velocity(&flown->aircraft.state), sensors->velocity_bias_mps);
    const double velocity[3] = {moving.x, moving.y, moving.z};
    const double place_m[3] = {sensed.position_ned_m.x, sensed.position_ned_m.y, sensed.position_ned_m.z};
    const double q[4] = {sensed.attitude.w, sensed.attitude.x, sensed.attitude.y, sensed.attitude.z};
    memset(&attitude, 0, sizeof attitude);
    memset(&position, 0, sizeof position);
    attitude.time_us = position.time_us = flown_clock_us(flown->t_s);
    for (int i = 0; i < 4; i++) {
        attitude.q[i] = (float)q[i];
    }
    for (int i = 0; i < 3; i++) {
        position.position_ned_m[i] = (float)place_m[i];
        position.velocity_ned_m_s[i] = (float)velocity[i];
    }
    position.height_m[GOE_FLIGHT_TERRAIN] = (float)(sensors->altimeter_m - truth.position_ned_m.z);
    position.height_valid = 1u << GOE_FLIGHT_TERRAIN;
    (void)goe_flight_attitude(&flown->flight, &attitude);
    (void)goe_flight_position(&flown->flight, &position);
}

static uint32_t id_of(flown_t *flown, int number) {
    const bool forgotten = flown->id[number] == 0u || flown->t_s - flown->detected_s[number] > FORGOTTEN_S;
    flown->detected_s[number] = flown->t_s;
    if (forgotten && flown->new_ids) {
        flown->id[number] = ++flown->ids;
    }
    return flown->new_ids ? flown->id[number] : (uint32_t)number + 1u;
}

static void detect(flown_t *flown, flown_frame_t *late, int number, const image_box_t *box) {
    goe_flight_detection_t *detection = &late->detection[late->frame.count++];
    detection->id = id_of(flown, number);
    detection->score = 0.9f;
    detection->box.sides = GOE_SIDES_ALL;
    detection->box.left_px = (float)box->side_px[SIDE_LEFT];
    detection->box.top_px = (float)box->side_px[SIDE_TOP];
    detection->box.right_px = (float)box->side_px[SIDE_RIGHT];
    detection->box.bottom_px = (float)box->side_px[SIDE_BOTTOM];
}

static void expose(flown_t *flown) {
    const pose_t truth = true_pose(flown);
    const view_t view = camera_view(&flown->camera, &truth);
    const bool lost = sensors_frame_lost(&flown->sensors[0]);
    const bool blind = flown->drops && fmod(flown->t_s, BLIND_EVERY_S) >= VISIBLE_S;
    flown_frame_t late;
    memset(&late, 0, sizeof late);
    late.exposure_s = flown->t_s;
    late.arrival_s = flown->t_s + flown->frame_s;
    late.frame.capture_us = flown_clock_us(flown->t_s);
    late.frame.arrival_us = flown_clock_us(late.arrival_s);
    for (int i = 0; i < flown->obstacles; i++) {
        const image_box_t whole = image_box_project(&flown->obstacle[i], &flown->camera, &view);
        const image_box_t box = sensors_box(&flown->sensors[i], &whole, &flown->camera, flown->t_s);
        if (box.seen && !blind) {
            detect(flown, &late, i, &box);
        }
    }
    late.frame.number = late.frame.count;
    if (!lost && flown->queued < FLOWN_QUEUE) {
        flown->queue[flown->queued++] = late;
    }
}

static void deliver(flown_t *flown) {
    while (flown->queued > 0 && flown->queue[0].arrival_s <= flown->t_s + 1e-9) {
        flown_frame_t *first = &flown->queue[0];
        first->frame.detection = first->detection;
        if (goe_flight_frame(&flown->flight, &first->frame) == GOE_FLIGHT_TOO_NEW) {
            return;
        }
        flown->exposure_s = first->exposure_s;
        flown->arrival_s = flown->t_s;
        flown->queued--;
        memmove(&flown->queue[0], &flown->queue[1], (size_t)flown->queued * sizeof flown->queue[0]);
    }
}

void flown_sense(flown_t *flown, int step) {
    if (step % SAMPLE_STEPS == 0) {
        sample(flown);
    }
    if (step % FRAME_STEPS == 0) {
        expose(flown);
    }
    deliver(flown);
}

/* ------------------------------------------------------------------------------------------------------------- moved -- */

void flown_step(flown_t *flown, const guidance_t *guidance) {
    const aircraft_state_t *state = &flown->aircraft.state;
    flown->air.gust = turbulence_step(&flown->turbulence, fmax(aircraft_airspeed(state, &flown->air), 5.0),
                                      -state->position_ned_m.z, AIRCRAFT_STEP_S);
    aircraft_autopilot(&flown->aircraft, guidance, &flown->air);
    flown->aircraft.state = aircraft_advance(state, &flown->aircraft.command, &flown->air, AIRCRAFT_STEP_S);
    flown->t_s += AIRCRAFT_STEP_S;
}
