/*
 * A small fixed-wing UAV (3.2 kg, 1.9 m span, cruise at 17 m/s) as a rigid body in six degrees of freedom, and its autopilot.
 *
 * Airframe: linear aerodynamic derivatives with a bounded lift coefficient, quadratic drag polar, electric motor of limited
 * thrust; control surfaces and motor lag behind their commands and have limits. Winds enter as moving and rotating air.
 * Autopilot, 100 Hz, on the true state: airspeed by throttle; height over the ground on a slope by climb angle, pitch angle,
 * elevator; course along a path by bank angle and aileron; yaw damper. Climb, pitch and bank commands are limited.
 * The air's density is constant. Integration: Runge-Kutta of fourth order, fixed steps of AIRCRAFT_STEP_S.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#ifndef SIM_AIRCRAFT_H
#define SIM_AIRCRAFT_H

#include <stdbool.h>

#include "rotation.h"
#include "turbulence.h"

#define AIRCRAFT_STEP_S 0.01
#define AIRCRAFT_SPAN_M 1.9
#define AIRCRAFT_SLOWEST_MPS 12.0 /* range of speed that the autopilot accepts; other wishes are limited to it */
#define AIRCRAFT_FASTEST_MPS 28.0
#define AIRCRAFT_MAX_BANK_DEG 40.0
#define AIRCRAFT_MAX_PITCH_DEG 25.0
#define AIRCRAFT_MAX_CLIMB_DEG 15.0
#define AIRCRAFT_MAX_SURFACE_DEG 25.0

typedef struct {
    double elevator_rad, aileron_rad, rudder_rad; /* positive: nose down, roll right, nose left */
    double throttle;                              /* 0 to 1 */
} controls_t;

typedef struct {
    vec3_t position_ned_m;
    quat_t attitude;          /* body -> NED */
    vec3_t velocity_body_mps; /* over ground */
    vec3_t rate_body_rps;
    controls_t actual; /* what surfaces and motor have reached */
} aircraft_state_t;

typedef struct {
    vec3_t wind_ned_mps; /* mean wind: where the air goes, not where it comes from */
    gust_t gust;
} air_t;

/* What the autopilot is to hold at this moment. */
typedef struct {
    double airspeed_mps;
    double acceleration_mps2; /* of the airspeed, fed forward */
    double height_error_m;    /* intended minus actual height, positive: too low */
    double climb_rad;         /* intended slope, positive up */
    double cross_track_m;     /* right of the path: positive */
    double path_course_rad;   /* from north */
    double path_curvature;    /* 1/m, positive right */
} guidance_t;

typedef struct {
    double trim_airspeed_mps, trim_climb_rad, trim_alpha_rad; /* of the start */
    controls_t trim;
    double pitch_integral_rad, throttle_integral;
    double bank_command_rad, pitch_command_rad; /* for observers */
} autopilot_t;

typedef struct {
    aircraft_state_t state;
    autopilot_t autopilot;
    controls_t command;
} aircraft_t;

/* Steady flight on a straight slope: angle of attack, elevator and throttle. False: the aircraft cannot fly so (the slope is
 * too steep for the speed, either way). */
bool aircraft_trim(double airspeed_mps, double climb_rad, double *alpha_rad, controls_t *trim);

/* An aircraft in trimmed flight at a place on a course; false as aircraft_trim. */
bool aircraft_start(aircraft_t *aircraft, vec3_t position_ned_m, double airspeed_mps, double climb_rad,
                    double course_rad, vec3_t wind_ned_mps);

/* Sets aircraft->command from the state and the commanded values; once a step. */
void aircraft_autopilot(aircraft_t *aircraft, const guidance_t *wanted, const air_t *air);

/* Moves the state on under constant commands and air. step_s <= AIRCRAFT_STEP_S. */
aircraft_state_t aircraft_advance(const aircraft_state_t *state, const controls_t *command, const air_t *air,
                                  double step_s);

double aircraft_airspeed(const aircraft_state_t *state, const air_t *air); /* mean wind and gust included */
vec3_t aircraft_ground_velocity(const aircraft_state_t *state);            /* NED */

#endif
