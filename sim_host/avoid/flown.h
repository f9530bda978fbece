/*
 * An aircraft that flies the flight layer (port/flight) among obstacles: wind, sensors with their errors, a detector whose frames come
 * late, and the layer that gets all of it. Where the obstacles are, what an order makes the aircraft fly, and how the flight is judged
 * belong to avoidance.c and several.c.
 *
 * Errors: boxes as measured on recorded feeds of detectors; attitude, position, velocity, height and lost frames as `--noise field` of
 * goe_sim has them; light wind and turbulence; half of the aircraft roll by 10 degrees; for half of them the detector sees nothing for
 * two seconds of every five.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#ifndef SIM_FLOWN_H
#define SIM_FLOWN_H

#include <stdbool.h>
#include <stdint.h>

#include "aircraft.h"
#include "camera_model.h"
#include "goe_flight.h"
#include "obstacle.h"
#include "random.h"
#include "sensors.h"
#include "turbulence.h"

#define FLOWN_MAX 9                               /* obstacles */
#define FLOWN_QUEUE 64                            /* frames on their way */
#define FLOWN_ASSESS_STEPS 10                     /* of AIRCRAFT_STEP_S: 10 Hz */
#define FLOWN_COLLISION_M (0.5 * AIRCRAFT_SPAN_M) /* the aircraft's middle nearer than this: a collision */
#define FLOWN_GROUND_M 0.3                        /* lower than this the aircraft touches the ground */

typedef struct {
    goe_flight_frame_t frame;
    goe_flight_detection_t detection[FLOWN_MAX];
    double exposure_s, arrival_s;
} flown_frame_t;

typedef struct {
    obstacle_t obstacle[FLOWN_MAX];
    sensors_t sensors[FLOWN_MAX]; /* the first one's pose; of each its box */
    int obstacles;
    camera_t camera;
    aircraft_t aircraft;
    air_t air;
    turbulence_t turbulence;
    goe_flight_t flight;
    flown_frame_t queue[FLOWN_QUEUE];
    int queued;
    bool rolls, drops;
    bool new_ids;                 /* an obstacle that was out of view for FORGOTTEN_S gets a new id */
    uint32_t id[FLOWN_MAX], ids;  /* of each obstacle, 0: none yet; given so far */
    double detected_s[FLOWN_MAX]; /* when it was detected last */
    double frame_s;               /* from the exposure to the arrival of a frame */
    double course_rad, speed_mps;
    double reach_m; /* of the path, from its start to the obstacle on it */
    double t_s;
    double exposure_s, arrival_s; /* of the newest frame that the layer took, with or without a detection */
} flown_t;

double flown_between(random_t *random, double low, double high);

/* Half of what the obstacle takes up across the course. */
double flown_half_across_m(const obstacle_t *obstacle, double course_rad);

/* Puts the obstacle at a place of the path: along from its start, right of it. */
void flown_put(const flown_t *flown, obstacle_t *obstacle, double along_m, double right_m);

/* Draws wind, turbulence and sensors, and starts the aircraft at the path's start, above the ground, on its course. Sensors are drawn by
 * sensor_seed and the numbers that follow it, one for each obstacle. Null, or why this cannot be flown. */
const char *flown_start(flown_t *flown, random_t *random, uint64_t seed, uint64_t sensor_seed, double height_m,
                        double climb_rad);

/* Starts the layer: circle_m is the radius that the autopilot circles at, 0: it does not. Null, or why not. */
const char *flown_start_layer(flown_t *flown, double circle_m);

/* Of a place: along the path from its start, and right of it. */
void flown_on_path(const flown_t *flown, double north_m, double east_m, double *along_m, double *right_m);

/* What the layer gets at this step, the step-th of the flight: poses, and the frames that arrive. */
void flown_sense(flown_t *flown, int step);

/* Time of the flight as the layer's clock has it; it wraps in flight. */
uint32_t flown_clock_us(double t_s);

/* Moves the aircraft on by AIRCRAFT_STEP_S. */
void flown_step(flown_t *flown, const guidance_t *guidance);

/* From the obstacle's walls and top, in space; 0: inside. */
double flown_distance_m(const obstacle_t *obstacle, double north_m, double east_m, double up_m);

#endif
