/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "avoidance.h"

#include <math.h>
#include <string.h>

#include "camera_model.h"
#include "image_box.h"
#include "obstacle.h"
#include "random.h"
#include "sensors.h"
#include "turbulence.h"

#define STREAM_AVOID 100 /* far from those of random.h */
#define REACH_S 22.0     /* from the start to the obstacle */
#define AFTER_S 6.0
#define SAMPLE_STEPS 2  /* 50 Hz */
#define FRAME_STEPS 10  /* 10 Hz */
#define ASSESS_STEPS 10 /* 10 Hz */
#define OBEY_S 0.5
#define GLIDE_DEG 3.0
#define ROLL_HZ 0.4
#define ROLL_DEG 10.0
#define LOST_FRAMES 0.05
#define QUEUE 64
#define GO_AROUND_M 40.0
#define GROUND_M 0.3 /* lower than this the aircraft has landed */

const char *const AVOID_NAMES[AVOID_KINDS] = {"mast", "building", "truck"};

bool avoid_is_pass(const avoid_case_t *setup) { return setup->pass_m >= 0.0; }

typedef struct {
    goe_flight_frame_t frame;
    goe_flight_detection_t detection;
    double arrival_s;
} late_frame_t;

typedef struct {
    const avoid_case_t *setup;
    obstacle_t obstacle;
    camera_t camera;
    aircraft_t aircraft;
    air_t air;
    turbulence_t turbulence;
    sensors_t sensors;
    goe_flight_t flight;
    late_frame_t queue[QUEUE];
    int queued;
    bool approach, rolls, drops;
    double course_rad, speed_mps, height_m, glide_rad, reach_m, t_s;
    goe_flight_assessment_t order, obeyed; /* the latest, and the one that is carried out */
    double order_s;
    int wrong_times[GOE_FLIGHT_SLOTS]; /* assessments in a row */
} run_t;

/* ------------------------------------------------------------------------------------------------------------- scene -- */

static double between(random_t *random, double low, double high) { return low + (high - low) * random_uniform(random); }

static void shape(run_t *run, random_t *random) {
    obstacle_t *o = &run->obstacle;
    o->kind = run->setup->kind == AVOID_MAST ? OBSTACLE_CYLINDER : OBSTACLE_BOX;
    switch (run->setup->kind) {
        case AVOID_MAST:
            o->width_m = o->length_m = between(random, 2.0, 8.0);
            o->height_m = between(random, 35.0, 80.0);
            break;
        case AVOID_BUILDING:
            o->width_m = between(random, 6.0, 20.0);
            o->length_m = between(random, 6.0, 20.0);
            o->height_m = between(random, 20.0, 40.0);
            break;
        case AVOID_TRUCK:
        case AVOID_KINDS:
        default:
            o->width_m = 2.5;
            o->length_m = between(random, 6.0, 16.0);
            o->height_m = between(random, 2.6, 4.0);
            break;
    }
    run->height_m = run->approach ? 1.5 : between(random, 15.0, fmin(0.9 * o->height_m, 40.0));
}

/* Half of what the obstacle takes up across the course. */
static double half_across_m(const obstacle_t *o, double course_rad) {
    const double turned = o->heading_rad - course_rad;
    return o->kind == OBSTACLE_CYLINDER ? 0.5 * o->width_m
                                        : 0.5 * (fabs(o->width_m * cos(turned)) + fabs(o->length_m * sin(turned)));
}

static void place(run_t *run, random_t *random) {
    const double c = cos(run->course_rad), s = sin(run->course_rad);
    run->reach_m = run->speed_mps * REACH_S;
    run->obstacle.heading_rad = between(random, -SIM_PI, SIM_PI);
    const double side = random_uniform(random) < 0.5 ? -1.0 : 1.0;
    const double off_m = between(random, -2.0, 2.0);
    const double aside = avoid_is_pass(run->setup)
                             ? side * (run->setup->pass_m + half_across_m(&run->obstacle, run->course_rad))
                             : off_m;
    obstacle_place(&run->obstacle, c * run->reach_m - s * aside, s * run->reach_m + c * aside, 0.0,
                   run->obstacle.heading_rad);
}

static double height_on_path(const run_t *run, double along_m) {
    return run->height_m + (run->reach_m - along_m) * tan(run->glide_rad);
}

static const char *begin(run_t *run) {
    random_t random = random_start(run->setup->seed, STREAM_AVOID);
    sensor_noise_t noise;
    run->approach = run->setup->kind == AVOID_TRUCK;
    run->glide_rad = run->approach ? radians(GLIDE_DEG) : 0.0;
    run->course_rad = between(&random, -SIM_PI, SIM_PI);
    run->speed_mps = between(&random, 14.0, 22.0);
    run->rolls = random_uniform(&random) < 0.5;
    run->drops = random_uniform(&random) < 0.5;
    shape(run, &random);
    place(run, &random);
    const double wind = between(&random, 0.0, 4.0), towards = between(&random, -SIM_PI, SIM_PI);
    run->air.wind_ned_mps.x = wind * cos(towards);
    run->air.wind_ned_mps.y = wind * sin(towards);
    run->turbulence = turbulence_start(between(&random, 0.0, 5.0), AIRCRAFT_SPAN_M, run->setup->seed);
    run->camera = camera_default();
    run->camera.mount_yaw_deg = 0.0;
    camera_prepare(&run->camera);
    (void)sensor_noise_parse("field", &noise);
    noise.drop_rate = LOST_FRAMES;
    run->sensors = sensors_start(&noise, run->setup->seed);
    const vec3_t start = {0.0, 0.0, -height_on_path(run, 0.0)};
    return aircraft_start(&run->aircraft, start, run->speed_mps, -run->glide_rad, run->course_rad,
                          run->air.wind_ned_mps)
               ? NULL
               : "the aircraft cannot fly so";
}

static const char *begin_layer(run_t *run) {
    goe_settings_t estimator;
    goe_flight_settings_t settings;
    goe_settings_default(&estimator);
    goe_flight_settings_default(&settings);
    estimator.camera.fx_px = (float)run->camera.fx_px;
    estimator.camera.fy_px = (float)run->camera.fy_px;
    estimator.camera.cx_px = (float)run->camera.cx_px;
    estimator.camera.cy_px = (float)run->camera.cy_px;
    estimator.camera.width_px = (float)run->camera.width_px;
    estimator.camera.height_px = (float)run->camera.height_px;
    const char *bad = NULL;
    const goe_flight_status_t status = goe_flight_init(&run->flight, sizeof run->flight, &estimator, &settings, &bad);
    return status == GOE_FLIGHT_OK ? NULL : "the flight layer refuses its settings";
}

/* ---------------------------------------------------------------------------------------------------------- aircraft -- */

/* Of a place: along the path, and right of it. */
static void on_path(const run_t *run, double north, double east, double *along_m, double *right_m) {
    const double c = cos(run->course_rad), s = sin(run->course_rad);
    *along_m = c * north + s * east;
    *right_m = c * east - s * north;
}

static void steer(const run_t *run, guidance_t *guidance, double along_m, double right_m) {
    const goe_flight_assessment_t *o = &run->obeyed;
    const vec3_t at = run->aircraft.state.position_ned_m;
    double target_along_m, target_right_m;
    on_path(run, (double)o->target_ned_m[0], (double)o->target_ned_m[1], &target_along_m, &target_right_m);
    switch (o->action) {
        case GOE_FLIGHT_LEFT:
        case GOE_FLIGHT_RIGHT:
            guidance->cross_track_m = right_m - target_right_m;
            break;
        case GOE_FLIGHT_CLIMB:
            guidance->height_error_m = -(double)o->target_ned_m[2] + at.z;
            break;
        case GOE_FLIGHT_GO_AROUND:
            guidance->height_error_m = fmax(-(double)o->target_ned_m[2], GO_AROUND_M) + at.z;
            guidance->climb_rad = 0.0;
            break;
        case GOE_FLIGHT_HOLD:
            guidance->path_course_rad = atan2((double)o->target_ned_m[1] - at.y, (double)o->target_ned_m[0] - at.x);
            guidance->cross_track_m = 0.0;
            break;
        case GOE_FLIGHT_NONE:
        default:
            guidance->height_error_m = height_on_path(run, along_m) + at.z;
            break;
    }
}

static void step(run_t *run) {
    const aircraft_state_t *state = &run->aircraft.state;
    double along_m, right_m;
    on_path(run, state->position_ned_m.x, state->position_ned_m.y, &along_m, &right_m);
    guidance_t guidance;
    memset(&guidance, 0, sizeof guidance);
    guidance.airspeed_mps = run->speed_mps;
    guidance.height_error_m = height_on_path(run, along_m) + state->position_ned_m.z;
    guidance.climb_rad = -run->glide_rad;
    guidance.cross_track_m = right_m;
    guidance.path_course_rad = run->course_rad;
    steer(run, &guidance, along_m, right_m);
    run->air.gust = turbulence_step(&run->turbulence, fmax(aircraft_airspeed(state, &run->air), 5.0),
                                    -state->position_ned_m.z, AIRCRAFT_STEP_S);
    aircraft_autopilot(&run->aircraft, &guidance, &run->air);
    run->aircraft.state = aircraft_advance(state, &run->aircraft.command, &run->air, AIRCRAFT_STEP_S);
    run->t_s += AIRCRAFT_STEP_S;
}

static pose_t true_pose(const run_t *run) {
    const vec3_t roll = {run->rolls ? radians(ROLL_DEG) * sin(2.0 * SIM_PI * ROLL_HZ * run->t_s) : 0.0, 0.0, 0.0};
    pose_t pose;
    pose.position_ned_m = run->aircraft.state.position_ned_m;
    pose.attitude = quat_multiply(run->aircraft.state.attitude, quat_from_rotation_vector(roll));
    return pose;
}

/* ------------------------------------------------------------------------------------------------------------- layer -- */

static uint32_t clock_us(double t_s) { return 4000000000u + (uint32_t)llround(1e6 * t_s); } /* wraps in flight */

static void sample(run_t *run) {
    goe_flight_attitude_t attitude;
    goe_flight_position_t position;
    const pose_t truth = true_pose(run);
    const pose_t sensed = sensors_pose(&run->sensors, &truth, run->t_s);
    const vec3_t moving = vec3_add(aircraft_ground_velocity(&run->aircraft.state), run->sensors.velocity_bias_mps);
    const double velocity[3] = {moving.x, moving.y, moving.z};
    const double place_m[3] = {sensed.position_ned_m.x, sensed.position_ned_m.y, sensed.position_ned_m.z};
    const double q[4] = {sensed.attitude.w, sensed.attitude.x, sensed.attitude.y, sensed.attitude.z};
    memset(&attitude, 0, sizeof attitude);
    memset(&position, 0, sizeof position);
    attitude.time_us = position.time_us = clock_us(run->t_s);
    for (int i = 0; i < 4; i++) {
        attitude.q[i] = (float)q[i];
    }
    for (int i = 0; i < 3; i++) {
        position.position_ned_m[i] = (float)place_m[i];
        position.velocity_ned_m_s[i] = (float)velocity[i];
    }
    position.height_m[GOE_FLIGHT_TERRAIN] = (float)(run->sensors.altimeter_m - truth.position_ned_m.z);
    position.height_valid = 1u << GOE_FLIGHT_TERRAIN;
    (void)goe_flight_attitude(&run->flight, &attitude);
    (void)goe_flight_position(&run->flight, &position);
}

static void expose(run_t *run) {
    const pose_t truth = true_pose(run);
    const view_t view = camera_view(&run->camera, &truth);
    const image_box_t whole = image_box_project(&run->obstacle, &run->camera, &view);
    const image_box_t box = sensors_box(&run->sensors, &whole, &run->camera, run->t_s);
    const bool lost = sensors_frame_lost(&run->sensors);
    const bool blind = run->drops && fmod(run->t_s, 5.0) >= 3.0;
    if (lost || run->queued == QUEUE) {
        return;
    }
    late_frame_t *late = &run->queue[run->queued++];
    memset(late, 0, sizeof *late);
    late->arrival_s = run->t_s + run->setup->delay_s;
    late->frame.capture_us = clock_us(run->t_s);
    late->frame.arrival_us = clock_us(late->arrival_s);
    late->frame.number = late->frame.count = box.seen && !blind ? 1 : 0;
    late->detection.id = 1;
    late->detection.score = 0.9f;
    late->detection.box.seen = GOE_SEES_BOX;
    late->detection.box.left_px = (float)box.side_px[SIDE_LEFT];
    late->detection.box.top_px = (float)box.side_px[SIDE_TOP];
    late->detection.box.right_px = (float)box.side_px[SIDE_RIGHT];
    late->detection.box.bottom_px = (float)box.side_px[SIDE_BOTTOM];
}

static void deliver(run_t *run) {
    while (run->queued > 0 && run->queue[0].arrival_s <= run->t_s + 1e-9) {
        late_frame_t *first = &run->queue[0];
        first->frame.detection = &first->detection;
        if (goe_flight_frame(&run->flight, &first->frame) == GOE_FLIGHT_TOO_NEW) {
            return;
        }
        run->queued--;
        memmove(&run->queue[0], &run->queue[1], (size_t)run->queued * sizeof run->queue[0]);
    }
}

static void note_order(const run_t *run, const goe_flight_assessment_t *now, avoid_outcome_t *outcome) {
    double along_m, right_m;
    const vec3_t at = run->aircraft.state.position_ned_m;
    on_path(run, at.x, at.y, &along_m, &right_m);
    outcome->ordered = true;
    outcome->late = now->late;
    outcome->action = now->action;
    outcome->ahead_s = (run->reach_m - along_m) / run->speed_mps;
}

/* The middle's error in its own sigmas, squared: e' C^-1 e. */
static double off_sigmas_squared(const goe_flight_obstacle_t *found, const obstacle_t *truth) {
    const double n = (double)found->center_ned_m[0] - truth->center_n_m,
                 e = (double)found->center_ned_m[1] - truth->center_e_m;
    const double nn = (double)found->covariance_ne_m2[0], ne = (double)found->covariance_ne_m2[1];
    const double ee = (double)found->covariance_ne_m2[2], determinant = nn * ee - ne * ne;
    return determinant > 0.0 ? (ee * n * n - 2.0 * ne * n * e + nn * e * e) / determinant : HUGE_VAL;
}

static void judge_places(run_t *run, avoid_outcome_t *outcome) {
    for (int slot = 0; slot < GOE_FLIGHT_SLOTS; slot++) {
        goe_flight_obstacle_t found;
        const bool known =
            goe_flight_obstacle(&run->flight, slot, &found) == GOE_FLIGHT_OK && (found.valid & GOE_HAS_POSITION) != 0u;
        const bool wrong = known && !found.suspect &&
                           off_sigmas_squared(&found, &run->obstacle) > AVOID_WRONG_SIGMAS * AVOID_WRONG_SIGMAS;
        run->wrong_times[slot] = wrong ? run->wrong_times[slot] + 1 : 0;
        outcome->confident = outcome->confident || run->wrong_times[slot] >= AVOID_WRONG_TIMES;
    }
}

static void assess(run_t *run, avoid_outcome_t *outcome) {
    goe_flight_assessment_t now;
    if (goe_flight_assess(&run->flight, clock_us(run->t_s), run->approach, &now) != GOE_FLIGHT_OK) {
        return;
    }
    judge_places(run, outcome);
    if (now.action != GOE_FLIGHT_NONE && !outcome->ordered) {
        note_order(run, &now, outcome);
    }
    if (!outcome->ordered && now.worst >= 0) {
        outcome->assessed++;
        outcome->suspect += now.suspect ? 1 : 0;
    }
    if (now.action != run->order.action) {
        run->order_s = run->t_s;
    }
    run->order = now;
    if (run->setup->reacts && run->t_s >= run->order_s + OBEY_S) {
        if (run->obeyed.action != GOE_FLIGHT_GO_AROUND) { /* that is flown to its end */
            run->obeyed = run->order;
        }
    }
}

/* ----------------------------------------------------------------------------------------------------------- outcome -- */

/* From the walls and the top, in space. */
static double distance_m(const obstacle_t *o, vec3_t at) {
    const double north = at.x - o->center_n_m, east = at.y - o->center_e_m;
    const double above = fmax(-at.z - o->height_m, 0.0);
    if (o->kind == OBSTACLE_CYLINDER) {
        return hypot(fmax(hypot(north, east) - 0.5 * o->width_m, 0.0), above);
    }
    const double c = cos(o->heading_rad), s = sin(o->heading_rad);
    const double along = fmax(fabs(c * north + s * east) - 0.5 * o->length_m, 0.0);
    const double across = fmax(fabs(c * east - s * north) - 0.5 * o->width_m, 0.0);
    return sqrt(along * along + across * across + above * above);
}

static void note_place(const run_t *run, avoid_outcome_t *outcome) {
    const vec3_t at = run->aircraft.state.position_ned_m;
    double along_m, right_m;
    on_path(run, at.x, at.y, &along_m, &right_m);
    outcome->closest_m = fmin(outcome->closest_m, distance_m(&run->obstacle, at));
    outcome->height_gained_m = fmax(outcome->height_gained_m, -at.z - height_on_path(run, along_m));
    outcome->collided = outcome->closest_m < AVOID_COLLISION_M || (outcome->ordered && at.z > -GROUND_M);
}

const char *avoid_fly(const avoid_case_t *setup, avoid_outcome_t *outcome) {
    run_t run;
    memset(&run, 0, sizeof run);
    memset(outcome, 0, sizeof *outcome);
    outcome->closest_m = HUGE_VAL;
    run.setup = setup;
    const char *fault = begin(&run);
    fault = fault ? fault : begin_layer(&run);
    const int steps = fault ? 0 : (int)((REACH_S + AFTER_S) / AIRCRAFT_STEP_S);
    for (int k = 0; k < steps && !outcome->collided; k++) {
        if (k % SAMPLE_STEPS == 0) {
            sample(&run);
        }
        if (k % FRAME_STEPS == 0) {
            expose(&run);
        }
        deliver(&run);
        if (k % ASSESS_STEPS == 0) {
            assess(&run, outcome);
        }
        step(&run);
        note_place(&run, outcome);
        if (run.aircraft.state.position_ned_m.z > -GROUND_M) {
            break; /* it has landed */
        }
    }
    return fault;
}
