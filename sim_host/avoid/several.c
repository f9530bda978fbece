/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "several.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "aircraft.h"
#include "avoidance.h"
#include "camera_model.h"
#include "image_box.h"
#include "obstacle.h"
#include "random.h"
#include "sensors.h"
#include "turbulence.h"

#define STREAM_SEVERAL 101 /* far from those of random.h */
#define REACH_S 18.0       /* from the start to the first obstacle */
#define AFTER_S 22.0
#define SAMPLE_STEPS 2  /* 50 Hz */
#define FRAME_STEPS 10  /* 10 Hz */
#define ASSESS_STEPS 10 /* 10 Hz */
#define ROLL_HZ 0.4
#define ROLL_DEG 10.0
#define LOST_FRAMES 0.05
#define QUEUE 16
#define GROUND_M 0.3
#define CIRCLE_M 80.0 /* that the autopilot which circles is set to */
#define CAPTURE 4.0   /* how steeply it heads for its circle */
#define BANK_DEG 30.0 /* of the search's turns */
#define BANKS 12      /* to each side */
#define ROLL_IN_S 0.5 /* of the search, behind the delay */
#define SEARCH_S 15.0
#define SEARCH_STEP_S 0.05
#define UNORDERED_S 6.0 /* the search begins this long before the closest approach, if there was no order */
#define OFFSETS 21
#define TRACE_MAX 4096

const char *const SEVERAL_NAMES[SEVERAL_KINDS] = {"single", "pair", "gate", "wall", "row", "field", "between"};

typedef struct {
    goe_flight_frame_t frame;
    goe_flight_detection_t detection[SEVERAL_MAX];
    double arrival_s;
} late_frame_t;

typedef struct {
    const several_case_t *setup;
    obstacle_t obstacle[SEVERAL_MAX];
    sensors_t sensors[SEVERAL_MAX]; /* the first one's pose; of each its box */
    int obstacles;
    camera_t camera;
    aircraft_t aircraft;
    air_t air;
    turbulence_t turbulence;
    goe_flight_t flight;
    late_frame_t queue[QUEUE];
    int queued;
    bool rolls, drops;
    double course_rad, speed_mps, height_m, reach_m, t_s;
    goe_flight_assessment_t given[TRACE_MAX]; /* each assessment */
    int assessed;
    goe_flight_assessment_t obeyed;
    int side;              /* of the latest order */
    double search_at[4];   /* north, east, and their speeds */
    double search_reach_s; /* the delay, and the roll */
} run_t;

/* ------------------------------------------------------------------------------------------------------------- scene -- */

static double between(random_t *random, double low, double high) { return low + (high - low) * random_uniform(random); }
static int among(random_t *random, int least, int most) {
    return least + (int)(random_uniform(random) * (most - least + 1) * 0.999999);
}

/* A mast, or in one of four a building. */
static void shape(obstacle_t *o, random_t *random) {
    const bool mast = random_uniform(random) < 0.75;
    o->kind = mast ? OBSTACLE_CYLINDER : OBSTACLE_BOX;
    o->width_m = between(random, mast ? 2.0 : 6.0, mast ? 8.0 : 16.0);
    o->length_m = mast ? o->width_m : between(random, 6.0, 16.0);
    o->height_m = between(random, 45.0, 80.0);
    o->heading_rad = between(random, -SIM_PI, SIM_PI);
}

static double half_across_m(const obstacle_t *o, double course_rad) {
    const double turned = o->heading_rad - course_rad;
    return o->kind == OBSTACLE_CYLINDER ? 0.5 * o->width_m
                                        : 0.5 * (fabs(o->width_m * cos(turned)) + fabs(o->length_m * sin(turned)));
}

/* along: behind the reach, right: of the course. */
static obstacle_t *put(run_t *run, random_t *random, double along_m, double right_m) {
    obstacle_t *o = &run->obstacle[run->obstacles++];
    const double c = cos(run->course_rad), s = sin(run->course_rad), z = run->reach_m + along_m;
    shape(o, random);
    obstacle_place(o, c * z - s * right_m, s * z + c * right_m, 0.0, o->heading_rad);
    return o;
}

static void move_aside(const run_t *run, obstacle_t *o, double right_m) {
    o->center_n_m -= sin(run->course_rad) * right_m;
    o->center_e_m += cos(run->course_rad) * right_m;
}

/* Two of this clear width between them, the course up to off_m right of the middle. */
static void put_gate(run_t *run, random_t *random, double width_m, double off_m, double apart_m) {
    for (int side = -1; side <= 1; side += 2) {
        obstacle_t *o = put(run, random, side * 0.5 * apart_m, 0.0);
        move_aside(run, o, side * (0.5 * width_m + half_across_m(o, run->course_rad)) - off_m);
    }
}

static bool is_apart(const run_t *run, double least_m) {
    const obstacle_t *last = &run->obstacle[run->obstacles - 1];
    for (int i = 0; i < run->obstacles - 1; i++) {
        if (hypot(run->obstacle[i].center_n_m - last->center_n_m, run->obstacle[i].center_e_m - last->center_e_m) <
            least_m) {
            return false;
        }
    }
    return true;
}

static void put_field(run_t *run, random_t *random, int wanted) {
    for (int tries = 0; tries < 100 && run->obstacles < wanted; tries++) {
        (void)put(run, random, between(random, -60.0, 300.0), between(random, -120.0, 120.0));
        run->obstacles -= is_apart(run, 30.0) ? 0 : 1;
    }
}

static void place(run_t *run, random_t *random, several_outcome_t *outcome) {
    goe_flight_settings_t settings;
    goe_flight_settings_default(&settings);
    switch (run->setup->kind) {
        case SEVERAL_SINGLE:
            (void)put(run, random, 0.0, between(random, -2.0, 2.0));
            break;
        case SEVERAL_PAIR:
            outcome->offset_m = -100.0 + 10.0 * among(random, 0, OFFSETS - 1) + between(random, -5.0, 5.0);
            (void)put(run, random, 0.0, between(random, -2.0, 2.0));
            (void)put(run, random, between(random, -40.0, 60.0), outcome->offset_m);
            if (!is_apart(run, 20.0)) {
                move_aside(run, &run->obstacle[1], outcome->offset_m < 0.0 ? -20.0 : 20.0);
            }
            break;
        case SEVERAL_GATE:
            put_gate(run, random, between(random, 15.0, 60.0), between(random, -8.0, 8.0),
                     between(random, -30.0, 30.0));
            if (random_uniform(random) < 0.5) {
                (void)put(run, random, between(random, 60.0, 200.0), between(random, -2.0, 2.0));
            }
            break;
        case SEVERAL_WALL: {
            const int number = among(random, 3, SEVERAL_MAX);
            const double apart_m = between(random, 20.0, 60.0), off_m = between(random, -0.5, 0.5) * apart_m;
            for (int i = 0; i < number; i++) {
                (void)put(run, random, between(random, -10.0, 10.0), off_m + apart_m * (i - 0.5 * (number - 1)));
            }
            break;
        }
        case SEVERAL_ROW: {
            const int number = among(random, 2, SEVERAL_MAX);
            const double apart_m = between(random, 40.0, 150.0);
            for (int i = 0; i < number; i++) {
                (void)put(run, random, apart_m * i, between(random, -10.0, 10.0));
            }
            break;
        }
        case SEVERAL_BETWEEN:
            put_gate(run, random, 4.0 * (double)settings.margin_m, 0.0, between(random, -30.0, 30.0));
            break;
        case SEVERAL_FIELD:
        case SEVERAL_KINDS:
        default:
            put_field(run, random, among(random, 1, SEVERAL_MAX));
            break;
    }
    outcome->obstacles = run->obstacles;
}

static const char *begin(run_t *run, several_outcome_t *outcome) {
    random_t random = random_start(run->setup->seed, STREAM_SEVERAL);
    sensor_noise_t noise;
    run->course_rad = between(&random, -SIM_PI, SIM_PI);
    run->speed_mps = between(&random, 14.0, 22.0);
    run->reach_m = run->speed_mps * REACH_S;
    run->height_m = between(&random, 15.0, 35.0);
    run->rolls = random_uniform(&random) < 0.5;
    run->drops = random_uniform(&random) < 0.5;
    place(run, &random, outcome);
    const double wind = between(&random, 0.0, 4.0), towards = between(&random, -SIM_PI, SIM_PI);
    run->air.wind_ned_mps.x = wind * cos(towards);
    run->air.wind_ned_mps.y = wind * sin(towards);
    run->turbulence = turbulence_start(between(&random, 0.0, 5.0), AIRCRAFT_SPAN_M, run->setup->seed);
    run->camera = camera_default();
    run->camera.mount_yaw_deg = 0.0;
    camera_prepare(&run->camera);
    (void)sensor_noise_parse("field", &noise);
    noise.drop_rate = LOST_FRAMES;
    for (int i = 0; i < SEVERAL_MAX; i++) {
        run->sensors[i] = sensors_start(&noise, run->setup->seed * SEVERAL_MAX + (uint64_t)i);
    }
    const vec3_t start = {0.0, 0.0, -run->height_m};
    return aircraft_start(&run->aircraft, start, run->speed_mps, 0.0, run->course_rad, run->air.wind_ned_mps)
               ? NULL
               : "the aircraft cannot fly so";
}

static const char *begin_layer(run_t *run) {
    goe_settings_t estimator;
    goe_flight_settings_t settings;
    goe_settings_default(&estimator);
    goe_flight_settings_default(&settings);
    settings.loiter_m = run->setup->circles ? (float)CIRCLE_M : 0.0f;
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

static void on_path(const run_t *run, double north, double east, double *along_m, double *right_m) {
    const double c = cos(run->course_rad), s = sin(run->course_rad);
    *along_m = c * north + s * east;
    *right_m = c * east - s * north;
}

/* To the target, then clockwise about it. */
static void circle(const run_t *run, guidance_t *guidance, double radius_m) {
    const vec3_t at = run->aircraft.state.position_ned_m;
    const double north = at.x - (double)run->obeyed.target_ned_m[0], east = at.y - (double)run->obeyed.target_ned_m[1];
    const double out_m = hypot(north, east) - radius_m;
    guidance->path_course_rad = atan2(east, north) + 0.5 * SIM_PI + atan(CAPTURE * out_m / radius_m);
    guidance->cross_track_m = 0.0;
    guidance->path_curvature = fabs(out_m) < 0.3 * radius_m ? 1.0 / radius_m : 0.0;
}

static void steer(const run_t *run, guidance_t *guidance, double along_m, double right_m) {
    const goe_flight_assessment_t *o = &run->obeyed;
    const vec3_t at = run->aircraft.state.position_ned_m;
    const double tightest_m = run->speed_mps * run->speed_mps / (9.80665 * tan(radians(BANK_DEG)));
    double target_along_m, target_right_m;
    on_path(run, (double)o->target_ned_m[0], (double)o->target_ned_m[1], &target_along_m, &target_right_m);
    switch (o->action) {
        case GOE_FLIGHT_LEFT:
        case GOE_FLIGHT_RIGHT:
            if (run->setup->circles) {
                circle(run, guidance, fmax(CIRCLE_M, tightest_m));
            } else if (fabs(right_m - target_right_m) > target_along_m - along_m && target_along_m > along_m) {
                guidance->path_course_rad = atan2((double)o->target_ned_m[1] - at.y, (double)o->target_ned_m[0] - at.x);
                guidance->cross_track_m = 0.0;
            } else {
                guidance->cross_track_m = right_m - target_right_m;
            }
            break;
        case GOE_FLIGHT_HOLD:
            circle(run, guidance, run->setup->circles ? fmax(CIRCLE_M, tightest_m) : tightest_m);
            break;
        case GOE_FLIGHT_CLIMB:
        case GOE_FLIGHT_GO_AROUND:
            guidance->height_error_m = -(double)o->target_ned_m[2] + at.z;
            break;
        case GOE_FLIGHT_NONE:
        default:
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
    guidance.height_error_m = run->height_m + state->position_ned_m.z;
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
    const pose_t sensed = sensors_pose(&run->sensors[0], &truth, run->t_s);
    const vec3_t moving = vec3_add(aircraft_ground_velocity(&run->aircraft.state), run->sensors[0].velocity_bias_mps);
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
    position.height_m[GOE_FLIGHT_TERRAIN] = (float)(run->sensors[0].altimeter_m - truth.position_ned_m.z);
    position.height_valid = 1u << GOE_FLIGHT_TERRAIN;
    (void)goe_flight_attitude(&run->flight, &attitude);
    (void)goe_flight_position(&run->flight, &position);
}

static void expose(run_t *run) {
    const pose_t truth = true_pose(run);
    const view_t view = camera_view(&run->camera, &truth);
    const bool lost = sensors_frame_lost(&run->sensors[0]);
    const bool blind = run->drops && fmod(run->t_s, 5.0) >= 3.0;
    late_frame_t late;
    memset(&late, 0, sizeof late);
    late.arrival_s = run->t_s + run->setup->frame_s;
    late.frame.capture_us = clock_us(run->t_s);
    late.frame.arrival_us = clock_us(late.arrival_s);
    for (int i = 0; i < run->obstacles; i++) {
        const image_box_t whole = image_box_project(&run->obstacle[i], &run->camera, &view);
        const image_box_t box = sensors_box(&run->sensors[i], &whole, &run->camera, run->t_s);
        if (!box.seen || blind) {
            continue;
        }
        goe_flight_detection_t *detection = &late.detection[late.frame.count++];
        detection->id = (uint32_t)i + 1u;
        detection->score = 0.9f;
        detection->box.seen = GOE_SEES_BOX;
        detection->box.left_px = (float)box.side_px[SIDE_LEFT];
        detection->box.top_px = (float)box.side_px[SIDE_TOP];
        detection->box.right_px = (float)box.side_px[SIDE_RIGHT];
        detection->box.bottom_px = (float)box.side_px[SIDE_BOTTOM];
    }
    late.frame.number = late.frame.count;
    if (!lost && run->queued < QUEUE) {
        run->queue[run->queued++] = late;
    }
}

static void deliver(run_t *run) {
    while (run->queued > 0 && run->queue[0].arrival_s <= run->t_s + 1e-9) {
        late_frame_t *first = &run->queue[0];
        first->frame.detection = first->detection;
        if (goe_flight_frame(&run->flight, &first->frame) == GOE_FLIGHT_TOO_NEW) {
            return;
        }
        run->queued--;
        memmove(&run->queue[0], &run->queue[1], (size_t)run->queued * sizeof run->queue[0]);
    }
}

/* -1, 1: left, right of the course as the aircraft flies. */
static int side_of(const run_t *run, const goe_flight_assessment_t *order) {
    const vec3_t at = run->aircraft.state.position_ned_m, moving = aircraft_ground_velocity(&run->aircraft.state);
    const double north = (double)order->target_ned_m[0] - at.x, east = (double)order->target_ned_m[1] - at.y;
    if (order->action == GOE_FLIGHT_LEFT || order->action == GOE_FLIGHT_RIGHT) {
        return order->action == GOE_FLIGHT_LEFT ? -1 : 1;
    }
    return order->action != GOE_FLIGHT_HOLD ? 0 : (moving.x * east - moving.y * north < 0.0 ? -1 : 1);
}

static void note_search(run_t *run, double roll_in_s) {
    const vec3_t at = run->aircraft.state.position_ned_m, moving = aircraft_ground_velocity(&run->aircraft.state);
    run->search_at[0] = at.x;
    run->search_at[1] = at.y;
    run->search_at[2] = moving.x;
    run->search_at[3] = moving.y;
    run->search_reach_s = run->setup->obey_s + roll_in_s;
}

static void note_first(run_t *run, const goe_flight_assessment_t *now, several_outcome_t *outcome) {
    double along_m, right_m;
    const vec3_t at = run->aircraft.state.position_ned_m;
    on_path(run, at.x, at.y, &along_m, &right_m);
    outcome->ordered = true;
    outcome->late = now->late;
    outcome->action = now->action;
    outcome->reason = now->reason;
    outcome->ahead_s = (run->reach_m - along_m) / run->speed_mps;
    outcome->known = now->obstacles >= run->obstacles;
    note_search(run, ROLL_IN_S);
}

static void trace(const run_t *run, const goe_flight_assessment_t *now) {
    double along_m, right_m, target_along_m, target_right_m;
    const vec3_t at = run->aircraft.state.position_ned_m;
    on_path(run, at.x, at.y, &along_m, &right_m);
    on_path(run, (double)now->target_ned_m[0], (double)now->target_ned_m[1], &target_along_m, &target_right_m);
    printf("%.1f at %.0f %.1f %.1f: %s %s%s to %.0f %.1f about %d clear %.1f worst %d %.2f in %.1f; ", run->t_s,
           along_m - run->reach_m, right_m, -at.z, goe_flight_action_text(now->action),
           goe_flight_reason_text(now->reason), now->late ? " late" : "",
           now->action ? target_along_m - run->reach_m : 0.0, target_right_m, now->avoided, (double)now->clear_m,
           now->worst, (double)now->hazard.violation, (double)now->hazard.time_s);
    for (int slot = 0; slot < GOE_FLIGHT_SLOTS; slot++) {
        goe_flight_obstacle_t found;
        if (goe_flight_obstacle(&run->flight, slot, &found) == GOE_FLIGHT_OK &&
            (found.valid & GOE_HAS_POSITION) != 0u) {
            on_path(run, (double)found.center_ned_m[0], (double)found.center_ned_m[1], &along_m, &right_m);
            printf(" [%d #%u %.0f %.1f r %.1f sd %.1f %.1f%s]", slot, (unsigned)found.id, along_m - run->reach_m,
                   right_m, (double)found.radius_m, sqrt((double)found.covariance_ne_m2[0]),
                   sqrt((double)found.covariance_ne_m2[2]), found.suspect ? " suspect" : "");
        }
    }
    puts("");
}

static void assess(run_t *run, several_outcome_t *outcome) {
    goe_flight_assessment_t now;
    if (goe_flight_assess(&run->flight, clock_us(run->t_s), GOE_FLIGHT_FLYING, &now) != GOE_FLIGHT_OK) {
        memset(&now, 0, sizeof now);
    }
    const int side = side_of(run, &now);
    if (now.action != GOE_FLIGHT_NONE && !outcome->ordered) {
        note_first(run, &now, outcome);
    }
    if (now.action != (run->assessed > 0 ? run->given[run->assessed - 1].action : GOE_FLIGHT_NONE) && side != 0) {
        outcome->changes += run->side != 0 && side != run->side ? 1 : 0;
        run->side = side;
    }
    if (run->setup->traced) {
        trace(run, &now);
    }
    run->given[run->assessed++] = now;
    const int back = (int)lround(run->setup->obey_s / (ASSESS_STEPS * AIRCRAFT_STEP_S));
    if (run->assessed > back) {
        run->obeyed = run->given[run->assessed - 1 - back];
    }
}

/* ----------------------------------------------------------------------------------------------------------- outcome -- */

static double wall_m(const obstacle_t *o, double at_north, double at_east) {
    const double north = at_north - o->center_n_m, east = at_east - o->center_e_m;
    if (o->kind == OBSTACLE_CYLINDER) {
        return fmax(hypot(north, east) - 0.5 * o->width_m, 0.0);
    }
    const double c = cos(o->heading_rad), s = sin(o->heading_rad);
    return hypot(fmax(fabs(c * north + s * east) - 0.5 * o->length_m, 0.0),
                 fmax(fabs(c * east - s * north) - 0.5 * o->width_m, 0.0));
}

static double nearest_m(const run_t *run, double north, double east, double up) {
    double least = HUGE_VAL;
    for (int i = 0; i < run->obstacles; i++) {
        const double above = fmax(up - run->obstacle[i].height_m, 0.0);
        least = fmin(least, hypot(wall_m(&run->obstacle[i], north, east), above));
    }
    return least;
}

/* Of one turn of this bank, begun when the search begins. */
static double turn_keeps_m(const run_t *run, double bank_rad) {
    double north = run->search_at[0], east = run->search_at[1], least = HUGE_VAL;
    double course = atan2(run->search_at[3], run->search_at[2]);
    const double speed = hypot(run->search_at[3], run->search_at[2]);
    for (int k = 0; k * SEARCH_STEP_S < SEARCH_S && least >= SEVERAL_CLEAR_M; k++) {
        const double t = k * SEARCH_STEP_S;
        course += t < run->search_reach_s ? 0.0 : SEARCH_STEP_S * 9.80665 * tan(bank_rad) / speed;
        north += SEARCH_STEP_S * speed * cos(course);
        east += SEARCH_STEP_S * speed * sin(course);
        least = fmin(least, nearest_m(run, north, east, run->height_m));
    }
    return least;
}

static bool is_possible(const run_t *run) {
    for (int i = -BANKS; i <= BANKS; i++) {
        if (turn_keeps_m(run, radians(BANK_DEG) * i / BANKS) >= SEVERAL_CLEAR_M) {
            return true;
        }
    }
    return false;
}

static void note_place(const run_t *run, several_outcome_t *outcome) {
    const vec3_t at = run->aircraft.state.position_ned_m;
    outcome->closest_m = fmin(outcome->closest_m, nearest_m(run, at.x, at.y, -at.z));
    outcome->collided = outcome->closest_m < AVOID_COLLISION_M || at.z > -GROUND_M;
}

bool several_misses(const several_outcome_t *outcome) {
    return outcome->possible && (outcome->collided || outcome->closest_m < SEVERAL_CLEAR_M);
}

const char *several_fly(const several_case_t *setup, several_outcome_t *outcome) {
    static run_t run; /* 100 kB */
    memset(&run, 0, sizeof run);
    memset(outcome, 0, sizeof *outcome);
    outcome->closest_m = HUGE_VAL;
    run.setup = setup;
    const char *fault = begin(&run, outcome);
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
        if (!outcome->ordered && run.t_s < REACH_S - UNORDERED_S) {
            note_search(&run, ROLL_IN_S);
        }
        step(&run);
        note_place(&run, outcome);
    }
    outcome->possible = !fault && is_possible(&run);
    return fault;
}
