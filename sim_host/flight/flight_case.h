/*
 * One case: an aircraft flies past an obstacle, its camera and sensors turn that into frames.
 *
 *   view from above; T's axes at the start of the run        Z = course
 *                                                             ^
 *                        obstacle's center  o- - - - - - - - -|  Z0 = the way flown along the course by reach_s
 *                                           |<---- x0_m ----->|       (speed times reach_s for constant speed)
 *                                             (left: positive)|
 *                                                             o---> X   path start, north 0 east 0; ground at down 0
 *
 * x0_m is the paper's side distance: positive is to the LEFT of the course; in T's axes X0 = -x0_m. Both refer to the center
 * of the obstacle's base. alpha_deg turns the length axis from the course, clockwise as viewed from above.
 * speed_mps is the speed over the ground in still air, also on a slope. The slope is fixed in space and passes the obstacle's
 * Z at altitude_m over the ground.
 * In wind or turbulence the aircraft flies in the same air for RUN_IN_S before the start, to begin as disturbed as it
 * goes on; then its position (not its motion) is put on the path's start.
 * A rolling aircraft: from the start of the run a sine is added to the flown roll angle. It turns the camera and leaves the
 * path as it is: the sway of a whole roll period at usual rates is less than a meter.
 * With two cameras, every image is taken by both, and the row is that of the camera that sees the whole obstacle; if both or
 * neither do, of the one whose axis is nearer to its middle. The detector's error continues over the change: the cameras
 * share it, which is worse for an estimator.
 * With a recording, the camera sees from the recorded true pose and the log carries the recorded estimate. Z then points from
 * the true place at the start to the one at reach_s, whose distance is Z0, unless course or z0 are given. Path, speed, slope,
 * wind, roll and the pose part of the noise do not apply.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#ifndef SIM_FLIGHT_CASE_H
#define SIM_FLIGHT_CASE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "camera_model.h"
#include "image_box.h"
#include "image_features.h"
#include "obstacle.h"
#include "path.h"
#include "recorded_flight.h"
#include "scenario.h"
#include "sensors.h"

#define RUN_IN_S 15.0

typedef struct {
    obstacle_t obstacle; /* its shape; the place is set by the flight */
    cylinder_model_t cylinder_model;
    log_features_t features;
    double x0_m;
    double z0_m; /* NaN: from reach_s */
    double alpha_deg, altitude_m, glide_deg;
    double speed_mps, reach_s, run_s, fps_hz;
    double course_deg; /* clockwise from north */
    path_t path;
    double roll_amplitude_deg, roll_rate_hz; /* a sine on top of the flown attitude, about the body's forward axis */
    double w20_mps;                          /* turbulence, see turbulence.h */
    double wind_mps, wind_from_deg;          /* mean wind */
    camera_t camera[CAMERAS_MAX];
    int cameras; /* 1 or 2 */
    sensor_noise_t noise;
    uint64_t seed;
    const recorded_flight_t *recording; /* null: the simulated aircraft flies */
    double recording_start_s;
    bool course_given, altitude_given; /* for recordings: course, and ground level from altitude, are not derived */
} flight_case_t;

typedef struct {
    int64_t time_us;          /* of the exposure */
    int camera;               /* number of that whose image it is */
    pose_t truth, logged;     /* of the vehicle's reference point */
    double true_agl_m, agl_m; /* that camera above ground: as it is, as the altimeter says */
    features_t exact, measured;
    image_box_t exact_box, measured_box; /* LOG_BOXES alone; cut at the image's border */
    double airspeed_mps;                 /* 0 for recordings */
} flight_frame_t;

typedef struct {
    flight_frame_t *frames; /* frames that were not lost, in order of time */
    size_t count;
    obstacle_t obstacle; /* placed */
    vec3_t origin_ned_m; /* where the path starts: x0_m and z0_m of all obstacles are from there */
    double course_rad;
    /* in T's axes, from the true camera of the first frame: center of the base, middle of the near base edge across the
     * length axis (line model's reference; of a cylinder the center) */
    double x0_m, z0_m, front_x0_m, front_z0_m;
    double orientation_deg; /* length axis from Z, -90 < b <= 90 */
    const char *ended;      /* null, or why the flight ended before run_s */
} flight_log_t;

/* Paper's defaults for a shape: the scenario of a named obstacle (middle side distance, orientation 0, level, its first
 * altitude), otherwise 30 m to the side at half height, run 18 s, reach 20 s. Rounded pixels, cylinder as tangents, base
 * corners in the log, no roll. */
bool flight_case_default(flight_case_t *setup, const char *obstacle);

/* One of scenario_get(), as the paper flew it: rounded pixels, cylinder as a point cloud. */
void flight_case_paper(flight_case_t *setup, const scenario_t *scenario);

/* Null if the case can be flown, otherwise why not. */
const char *flight_case_fault(const flight_case_t *setup);

/* Flies. Returns null and fills *log (to be freed with flight_log_free), or says why not. Touches nothing else: cases may be
 * flown in several threads at once. */
const char *flight_case_fly(const flight_case_t *given, flight_log_t *log);

/* Another obstacle in addition to that of a flight. */
typedef struct {
    obstacle_t obstacle;          /* its shape */
    double x0_m, z0_m, alpha_deg; /* as those of flight_case_t; z0_m must be known */
} neighbor_t;

/* Null if it can be placed, otherwise why not. */
const char *neighbor_fault(const neighbor_t *neighbor);

/* What the camera of a flight that was flown with *setup shows of another obstacle on the same ground: times, poses and lost
 * frames are the flight's, pixels have errors of their own, drawn from seed. It ends where the aircraft is inside of the other
 * one. Returns null and fills *log (to be freed with flight_log_free), or says why not. */
const char *flight_log_of_neighbor(const flight_case_t *setup, const flight_log_t *flown, const neighbor_t *neighbor,
                                   uint64_t seed, flight_log_t *log);

void flight_log_free(flight_log_t *log);

#endif
