/*
 * A flight recorded elsewhere: the true and the estimated motion, side by side.
 *
 * CSV with a header line; columns in any order, others ignored:
 * t_s, true_{n,e,d}_m, true_q{w,x,y,z}, est_{n,e,d}_m, est_q{w,x,y,z}; NED, Hamilton, body FRD -> NED. Times within
 * +-9.2e12 s, strictly increasing; positions within +-1e6 m; the quaternions' norm is 1 to 1 %.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#ifndef SIM_RECORDED_FLIGHT_H
#define SIM_RECORDED_FLIGHT_H

#include <stdbool.h>
#include <stddef.h>

#include "camera_model.h"
#include "input_error.h"

#define RECORDED_POSES_MAX 1000000u /* a little under three hours at 100 Hz; 120 MB */

typedef struct {
    double t_s; /* since the first row */
    pose_t truth, estimated;
} recorded_pose_t;

typedef struct {
    recorded_pose_t *poses;
    size_t count, capacity;
} recorded_flight_t;

/* Reads a file of 2 to RECORDED_POSES_MAX poses. False: *error says why not and where, and the flight is empty. */
bool recorded_flight_read(const char *path, recorded_flight_t *flight, input_error_t *error);
void recorded_flight_free(recorded_flight_t *flight);

double recorded_flight_duration(const recorded_flight_t *flight);

/* Poses between the rows: position on the straight line, attitude the short way round. Outside the recording its end. */
recorded_pose_t recorded_flight_at(const recorded_flight_t *flight, double t_s);

#endif
