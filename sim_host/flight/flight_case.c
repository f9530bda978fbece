/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "flight_case.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "aircraft.h"
#include "turbulence.h"

#define MOST_FRAMES 1000000.0
#define LONGEST_S 100000.0
#define STEEPEST_DEG 30.0
#define LARGEST_ROLL_DEG 80.0
#define FASTEST_ROLL_HZ 10.0
#define USUAL_ROLL_HZ 0.4
#define TIME_ROUNDING 1e-9 /* frames: run_s times fps_hz may miss a whole number by rounding */

typedef struct {
    const flight_case_t *setup;
    double course_rad, reach_progress_m;
    vec3_t wind_ned_mps;
    aircraft_t aircraft;
    turbulence_t turbulence;
    air_t air;
    int64_t step; /* steps of AIRCRAFT_STEP_S since the start of the run; negative in the run-in */
} flight_t;

/* Where a frame was taken. */
typedef struct {
    pose_t truth, estimated;
    double airspeed_mps;
} exposure_t;

bool flight_case_default(flight_case_t *setup, const char *obstacle) {
    memset(setup, 0, sizeof *setup);
    if (!obstacle_parse(obstacle, &setup->obstacle)) {
        return false;
    }
    setup->z0_m = (double)NAN;
    setup->speed_mps = SCENARIO_SPEED_MPS;
    setup->fps_hz = SCENARIO_FPS_HZ;
    setup->camera[0] = camera_default();
    setup->cameras = 1;
    setup->noise.rounding = true;
    setup->roll_rate_hz = USUAL_ROLL_HZ;
    setup->seed = 1;
    scenario_t scenario;
    if (scenario_find(obstacle, &scenario)) {
        setup->x0_m = scenario.x0_m;
        setup->altitude_m = scenario.altitude_m;
        setup->run_s = scenario.run_s;
        setup->reach_s = scenario.reach_s;
    } else {
        setup->x0_m = 30.0;
        setup->altitude_m = 0.5 * setup->obstacle.height_m;
        setup->run_s = 18.0;
        setup->reach_s = 20.0;
    }
    return true;
}

void flight_case_paper(flight_case_t *setup, const scenario_t *scenario) {
    (void)flight_case_default(setup, scenario->obstacle);
    setup->cylinder_model = CYLINDER_CLOUD;
    setup->x0_m = scenario->x0_m;
    setup->altitude_m = scenario->altitude_m;
    setup->alpha_deg = scenario->alpha_deg;
    setup->glide_deg = scenario->glide_deg;
    setup->run_s = scenario->run_s;
    setup->reach_s = scenario->reach_s;
}

static bool within(double value, double low, double high) { return value >= low && value <= high; }

static const char *aircraft_fault(const flight_case_t *setup) {
    if (!within(setup->speed_mps, AIRCRAFT_SLOWEST_MPS, AIRCRAFT_FASTEST_MPS)) {
        return "speed: the aircraft flies 12 to 28 m/s";
    }
    if (!within(setup->glide_deg, -STEEPEST_DEG, STEEPEST_DEG)) {
        return "glide: must be -30 to 30 deg";
    }
    if (!(setup->altitude_m > 0.0 && setup->altitude_m <= 10000.0)) {
        return "altitude: must be more than 0 and at most 10000 m";
    }
    if (!(setup->wind_mps >= 0.0 && setup->wind_mps < setup->speed_mps)) {
        return "wind-speed: must be 0 or more and less than the speed";
    }
    if (!within(setup->wind_from_deg, -360.0, 360.0)) {
        return "wind-from: must be -360 to 360 deg";
    }
    if (!within(setup->roll_amplitude_deg, 0.0, LARGEST_ROLL_DEG) ||
        !within(setup->roll_rate_hz, 0.0, FASTEST_ROLL_HZ)) {
        return "roll-amplitude-deg, roll-rate-hz: the amplitude must be 0 to 80 deg, the rate 0 to 10 Hz";
    }
    double alpha;
    controls_t trim;
    const double climb = -radians(setup->glide_deg);
    if (!aircraft_trim(setup->speed_mps / cos(climb), climb, &alpha, &trim)) {
        return "glide: the slope is too steep for this speed (thrust limits)";
    }
    return NULL;
}

const char *flight_case_fault(const flight_case_t *setup) {
    if (!within(setup->x0_m, -1e5, 1e5)) {
        return "x0: must lie within +-100000 m";
    }
    if (!isnan(setup->z0_m) && !within(setup->z0_m, -1e5, 1e5)) {
        return "z0: must lie within +-100000 m";
    }
    if (!within(setup->alpha_deg, -360.0, 360.0) || !within(setup->course_deg, -360.0, 360.0)) {
        return "alpha, course: must be -360 to 360 deg";
    }
    if (!(setup->run_s >= 0.0 && setup->run_s <= LONGEST_S && setup->reach_s > 0.0 && setup->reach_s <= LONGEST_S)) {
        return "run, reach: must be 0 to 100000 s, reach more than 0";
    }
    if (!(setup->fps_hz > 0.0 && setup->fps_hz <= 1000.0 && setup->run_s * setup->fps_hz < MOST_FRAMES)) {
        return "fps, run: fps must be more than 0 and at most 1000 Hz, and both must give fewer than a million frames";
    }
    const char *fault = NULL;
    for (int i = 0; i < setup->cameras && fault == NULL; i++) {
        fault = camera_fault(&setup->camera[i]);
    }
    if (fault == NULL) {
        fault = sensor_noise_fault(&setup->noise);
    }
    if (fault == NULL && setup->recording == NULL) {
        fault = aircraft_fault(setup);
    }
    if (fault == NULL && setup->recording != NULL &&
        !within(setup->recording_start_s, 0.0, recorded_flight_duration(setup->recording))) {
        fault = "flight start: lies outside the recording";
    }
    return fault;
}

static vec3_t to_ned(double course_rad, double z, double x, double d) {
    const double c = cos(course_rad), s = sin(course_rad);
    vec3_t ned = {c * z - s * x, s * z + c * x, d};
    return ned;
}

static double height_on_slope(const flight_t *flight, double progress_m) {
    return flight->setup->altitude_m + (flight->reach_progress_m - progress_m) * tan(radians(flight->setup->glide_deg));
}

static guidance_t guide(const flight_t *flight) {
    const flight_case_t *setup = flight->setup;
    const path_t *path = &setup->path;
    const vec3_t position = flight->aircraft.state.position_ned_m;
    const double c = cos(flight->course_rad), s = sin(flight->course_rad);
    const double z = c * position.x + s * position.y, x = c * position.y - s * position.x;
    const double progress = path_progress(path, z, x);
    const path_point_t point = path_at(path, progress);
    const double t = (double)flight->step * AIRCRAFT_STEP_S;
    const double speed = path_speed(path, setup->speed_mps, t, AIRCRAFT_SLOWEST_MPS, AIRCRAFT_FASTEST_MPS);
    const bool ramping = t >= 0.0 && speed > AIRCRAFT_SLOWEST_MPS && speed < AIRCRAFT_FASTEST_MPS;
    const double glide = radians(setup->glide_deg);
    guidance_t guidance;
    guidance.airspeed_mps = speed / cos(glide);
    guidance.acceleration_mps2 = ramping ? path->acceleration_mps2 / cos(glide) : 0.0;
    guidance.height_error_m = height_on_slope(flight, progress) + position.z;
    guidance.climb_rad = -glide;
    guidance.cross_track_m = cos(point.course_rad) * (x - point.x_m) - sin(point.course_rad) * (z - point.z_m);
    guidance.path_course_rad = flight->course_rad + point.course_rad;
    guidance.path_curvature = point.curvature;
    return guidance;
}

static void step(flight_t *flight) {
    const aircraft_state_t *state = &flight->aircraft.state;
    flight->air.gust = turbulence_step(&flight->turbulence, fmax(aircraft_airspeed(state, &flight->air), 5.0),
                                       -state->position_ned_m.z, AIRCRAFT_STEP_S);
    const guidance_t guidance = guide(flight);
    aircraft_autopilot(&flight->aircraft, &guidance, &flight->air);
    flight->aircraft.state = aircraft_advance(state, &flight->aircraft.command, &flight->air, AIRCRAFT_STEP_S);
    flight->step++;
}

static const char *take_off(flight_t *flight, const flight_case_t *setup, const path_t *path) {
    flight->setup = setup;
    flight->course_rad = radians(setup->course_deg);
    flight->reach_progress_m = path_progress_of_length(
        path, path_length(path, setup->speed_mps, setup->reach_s, AIRCRAFT_SLOWEST_MPS, AIRCRAFT_FASTEST_MPS));
    const double wind_towards = radians(setup->wind_from_deg) + SIM_PI;
    flight->air.wind_ned_mps.x = setup->wind_mps * cos(wind_towards);
    flight->air.wind_ned_mps.y = setup->wind_mps * sin(wind_towards);
    flight->turbulence = turbulence_start(setup->w20_mps, AIRCRAFT_SPAN_M, setup->seed);

    const bool calm = !(setup->w20_mps > 0.0) && !(setup->wind_mps > 0.0);
    const double run_in_s = calm ? 0.0 : RUN_IN_S;
    flight->step = -llround(run_in_s / AIRCRAFT_STEP_S);
    const double start_progress = -run_in_s * setup->speed_mps;
    const path_point_t run_in = path_at(path, start_progress), start = path_at(path, 0.0);
    const double climb = -radians(setup->glide_deg);
    const vec3_t begin = to_ned(flight->course_rad, run_in.z_m, run_in.x_m, -height_on_slope(flight, start_progress));
    if (!aircraft_start(&flight->aircraft, begin, setup->speed_mps / cos(climb), climb,
                        flight->course_rad + start.course_rad, flight->air.wind_ned_mps)) {
        return "glide: the slope is too steep for this speed";
    }
    while (flight->step < 0) {
        step(flight);
    }
    flight->aircraft.state.position_ned_m =
        to_ned(flight->course_rad, start.z_m, start.x_m, -height_on_slope(flight, 0.0));
    return NULL;
}

static quat_t rolled(const flight_case_t *setup, quat_t attitude, double t_s) {
    const vec3_t roll = {radians(setup->roll_amplitude_deg) * sin(2.0 * SIM_PI * setup->roll_rate_hz * t_s), 0.0, 0.0};
    return setup->roll_amplitude_deg > 0.0 ? quat_multiply(attitude, quat_from_rotation_vector(roll)) : attitude;
}

/* Flies on to the time of an exposure. Between steps the state is moved on from the last one without changing it, so that
 * the flight does not depend on when frames are taken. Returns why the flight ended, or null. */
static const char *fly_to(flight_t *flight, const obstacle_t *obstacle, double t_s, exposure_t *exposure) {
    while ((double)(flight->step + 1) * AIRCRAFT_STEP_S <= t_s) {
        step(flight);
        if (!(flight->aircraft.state.position_ned_m.z < obstacle->ground_d_m)) {
            return "the aircraft hit the ground";
        }
        if (obstacle_contains(obstacle, flight->aircraft.state.position_ned_m)) {
            return "the aircraft flew into the obstacle";
        }
    }
    const double rest_s = t_s - (double)flight->step * AIRCRAFT_STEP_S;
    aircraft_state_t state = flight->aircraft.state;
    if (rest_s > 0.0) {
        state = aircraft_advance(&state, &flight->aircraft.command, &flight->air, rest_s);
    }
    exposure->truth.position_ned_m = state.position_ned_m;
    exposure->truth.attitude = rolled(flight->setup, state.attitude, t_s);
    exposure->estimated = exposure->truth;
    exposure->airspeed_mps = aircraft_airspeed(&state, &flight->air);
    return NULL;
}

/* How far the middle of the obstacle lies off the camera's axis. */
static double off_axis_rad(const obstacle_t *obstacle, const view_t *view) {
    const vec3_t middle = {obstacle->center_n_m, obstacle->center_e_m, obstacle->ground_d_m - 0.5 * obstacle->height_m};
    const vec3_t ray = mat3_apply(&view->ned_to_camera, vec3_sub(middle, view->eye_ned_m));
    return atan2(hypot(ray.x, ray.y), ray.z);
}

/* The number of the camera whose image goes into the log. */
static int choose_camera(const flight_case_t *setup, const obstacle_t *obstacle, const pose_t *pose) {
    bool best_whole = false;
    double best_rad = HUGE_VAL;
    int best = 0;
    for (int i = 0; i < setup->cameras && setup->cameras > 1; i++) {
        const view_t view = camera_view(&setup->camera[i], pose);
        const image_box_t box = image_box_project(obstacle, &setup->camera[i], &view);
        const bool whole = image_box_whole(&box, &setup->camera[i]);
        const double rad = off_axis_rad(obstacle, &view);
        if (whole != best_whole ? whole : rad < best_rad) {
            best_whole = whole;
            best_rad = rad;
            best = i;
        }
    }
    return best;
}

/* The image features of the obstacle, from frame->truth. */
static void look(const flight_case_t *setup, const flight_log_t *log, sensors_t *sensors, double t_s,
                 flight_frame_t *frame) {
    frame->camera = choose_camera(setup, &log->obstacle, &frame->truth);
    const camera_t *camera = &setup->camera[frame->camera];
    const view_t view = camera_view(camera, &frame->truth);
    frame->exact = features_project(&log->obstacle, setup->cylinder_model, camera, &view);
    frame->measured = sensors_features(sensors, &frame->exact, camera);
    memset(&frame->exact_box, 0, sizeof frame->exact_box);
    memset(&frame->measured_box, 0, sizeof frame->measured_box);
    if (setup->features == LOG_BOXES) {
        const image_box_t whole = image_box_project(&log->obstacle, camera, &view);
        frame->exact_box = image_box_clipped(&whole, camera);
        frame->measured_box = sensors_box(sensors, &whole, camera, t_s);
    }
    frame->true_agl_m = log->obstacle.ground_d_m - view.eye_ned_m.z;
}

static void expose(const flight_case_t *setup, const flight_log_t *log, sensors_t *sensors, const exposure_t *exposure,
                   double t_s, flight_frame_t *frame) {
    frame->truth = exposure->truth;
    frame->airspeed_mps = exposure->airspeed_mps;
    look(setup, log, sensors, t_s, frame);
    const camera_t *camera = &setup->camera[frame->camera];
    const pose_t sensed = sensors_pose(sensors, &exposure->truth, t_s);
    if (setup->recording == NULL) {
        frame->logged = sensed;
        frame->agl_m = frame->true_agl_m + sensors->altimeter_m;
    } else {
        frame->logged = exposure->estimated;
        frame->agl_m = log->obstacle.ground_d_m - camera_view(camera, &exposure->estimated).eye_ned_m.z;
    }
}

/* Truth in T's axes, from where the first frame was taken. */
static bool shows_a_feature(const flight_frame_t *frame, log_features_t logged) {
    bool seen = logged == LOG_BOXES && frame->measured_box.seen;
    for (int i = 0; i < features_logged(logged); i++) {
        seen = seen || frame->measured.feature[i].seen;
    }
    return seen;
}

/* The image that the track begins with: the first one that shows a feature; the first of all if none does. */
static const flight_frame_t *track_begin(const flight_case_t *setup, const flight_log_t *log) {
    for (size_t k = 0; k < log->count; k++) {
        if (shows_a_feature(&log->frames[k], setup->features)) {
            return &log->frames[k];
        }
    }
    return log->frames;
}

static void settle_truth(const flight_case_t *setup, double alpha_deg, flight_log_t *log) {
    const obstacle_t *o = &log->obstacle;
    const double c = cos(log->course_rad), s = sin(log->course_rad);
    double folded = wrap_pi(2.0 * radians(alpha_deg)) / 2.0; /* an axis: 180 degrees are no difference */
    if (folded <= -0.5 * SIM_PI) {
        folded += SIM_PI;
    }
    log->orientation_deg = degrees(folded);
    const flight_frame_t *first = track_begin(setup, log);
    const vec3_t eye = log->count > 0 ? camera_view(&setup->camera[first->camera], &first->truth).eye_ned_m
                                      : to_ned(log->course_rad, 0.0, 0.0, 0.0);
    const double n = o->center_n_m - eye.x, e = o->center_e_m - eye.y;
    log->z0_m = c * n + s * e;
    log->x0_m = c * e - s * n;
    const double half_length = o->kind == OBSTACLE_BOX ? 0.5 * o->length_m : 0.0;
    log->front_z0_m = log->z0_m - half_length * cos(folded);
    log->front_x0_m = log->x0_m - half_length * sin(folded);
}

static void place_for_recording(const flight_case_t *setup, flight_log_t *log) {
    const recorded_pose_t start = recorded_flight_at(setup->recording, setup->recording_start_s);
    const recorded_pose_t reach = recorded_flight_at(setup->recording, setup->recording_start_s + setup->reach_s);
    const vec3_t way = vec3_sub(reach.truth.position_ned_m, start.truth.position_ned_m);
    log->course_rad = setup->course_given ? radians(setup->course_deg) : atan2(way.y, way.x);
    const double z0 = isnan(setup->z0_m) ? cos(log->course_rad) * way.x + sin(log->course_rad) * way.y : setup->z0_m;
    log->origin_ned_m = start.truth.position_ned_m;
    const vec3_t center = vec3_add(log->origin_ned_m, to_ned(log->course_rad, z0, -setup->x0_m, 0.0));
    const double ground = setup->altitude_given ? reach.truth.position_ned_m.z + setup->altitude_m : 0.0;
    obstacle_place(&log->obstacle, center.x, center.y, ground, log->course_rad + radians(setup->alpha_deg));
}

static void place_for_flight(const flight_t *flight, flight_log_t *log) {
    const flight_case_t *setup = flight->setup;
    log->course_rad = flight->course_rad;
    const double z0 = isnan(setup->z0_m) ? path_at(&setup->path, flight->reach_progress_m).z_m : setup->z0_m;
    const vec3_t center = to_ned(log->course_rad, z0, -setup->x0_m, 0.0);
    obstacle_place(&log->obstacle, center.x, center.y, 0.0, log->course_rad + radians(setup->alpha_deg));
}

static const char *take_frames(const flight_case_t *setup, flight_t *flight, flight_log_t *log) {
    const int frames = (int)floor(setup->run_s * setup->fps_hz + TIME_ROUNDING) + 1;
    log->frames = calloc((size_t)frames, sizeof *log->frames);
    if (log->frames == NULL) {
        return "out of memory";
    }
    sensors_t sensors = sensors_start(&setup->noise, setup->seed);
    for (int k = 0; k < frames && log->ended == NULL; k++) {
        flight_frame_t frame;
        exposure_t exposure;
        const bool lost = sensors_frame_lost(&sensors);
        const double jitter = sensors_time_error(&sensors, 1.0 / setup->fps_hz);
        frame.time_us = llround(1e6 * fmax((double)k / setup->fps_hz + jitter, 0.0));
        const double t = (double)frame.time_us * 1e-6;
        if (setup->recording != NULL) {
            const double recorded_t = setup->recording_start_s + t;
            const recorded_pose_t pose = recorded_flight_at(setup->recording, recorded_t);
            exposure.truth = pose.truth;
            exposure.estimated = pose.estimated;
            exposure.airspeed_mps = 0.0;
            log->ended = recorded_t > recorded_flight_duration(setup->recording) ? "the recording is over" : NULL;
        } else {
            log->ended = fly_to(flight, &log->obstacle, t, &exposure);
        }
        if (log->ended == NULL) {
            expose(setup, log, &sensors, &exposure, t, &frame);
            if (!lost) {
                log->frames[log->count++] = frame;
            }
        }
    }
    return NULL;
}

const char *flight_case_fly(const flight_case_t *given, flight_log_t *log) {
    memset(log, 0, sizeof *log);
    const char *fault = flight_case_fault(given);
    if (fault != NULL) {
        return fault;
    }
    flight_case_t setup = *given;
    for (int i = 0; i < setup.cameras; i++) {
        camera_prepare(&setup.camera[i]);
    }
    path_prepare(&setup.path, setup.speed_mps);
    log->obstacle = setup.obstacle;
    flight_t flight;
    memset(&flight, 0, sizeof flight);
    if (setup.recording != NULL) {
        place_for_recording(&setup, log);
    } else {
        fault = take_off(&flight, &setup, &setup.path);
        if (fault != NULL) {
            return fault;
        }
        place_for_flight(&flight, log);
    }
    fault = take_frames(&setup, &flight, log);
    if (fault == NULL) {
        settle_truth(&setup, setup.alpha_deg, log);
    }
    return fault;
}

const char *neighbor_fault(const neighbor_t *neighbor) {
    if (!within(neighbor->x0_m, -1e5, 1e5) || !within(neighbor->z0_m, -1e5, 1e5)) {
        return "x0 and z0: must lie within +-100000 m";
    }
    return within(neighbor->alpha_deg, -360.0, 360.0) ? NULL : "alpha: must be -360 to 360 deg";
}

const char *flight_log_of_neighbor(const flight_case_t *setup, const flight_log_t *flown, const neighbor_t *neighbor,
                                   uint64_t seed, flight_log_t *log) {
    memset(log, 0, sizeof *log);
    const char *fault = neighbor_fault(neighbor);
    if (fault != NULL) {
        return fault;
    }
    flight_case_t prepared = *setup;
    for (int i = 0; i < prepared.cameras; i++) {
        camera_prepare(&prepared.camera[i]);
    }
    log->frames = calloc(flown->count + 1u, sizeof *log->frames);
    if (log->frames == NULL) {
        return "out of memory";
    }
    log->origin_ned_m = flown->origin_ned_m;
    log->course_rad = flown->course_rad;
    log->obstacle = neighbor->obstacle;
    const vec3_t center = vec3_add(log->origin_ned_m, to_ned(log->course_rad, neighbor->z0_m, -neighbor->x0_m, 0.0));
    obstacle_place(&log->obstacle, center.x, center.y, flown->obstacle.ground_d_m,
                   log->course_rad + radians(neighbor->alpha_deg));
    sensors_t sensors = sensors_start(&setup->noise, seed);
    for (size_t k = 0; k < flown->count && log->ended == NULL; k++) {
        flight_frame_t frame = flown->frames[k];
        const double height_error_m = frame.agl_m - frame.true_agl_m;
        look(&prepared, log, &sensors, (double)frame.time_us * 1e-6, &frame);
        frame.agl_m = frame.true_agl_m + height_error_m;
        if (obstacle_contains(&log->obstacle, frame.truth.position_ned_m)) {
            log->ended = "the aircraft flew into the obstacle";
        } else {
            log->frames[log->count++] = frame;
        }
    }
    settle_truth(&prepared, neighbor->alpha_deg, log);
    return NULL;
}

void flight_log_free(flight_log_t *log) {
    free(log->frames);
    memset(log, 0, sizeof *log);
}
