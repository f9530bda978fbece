/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "aircraft.h"

#include <math.h>
#include <string.h>

#define GRAVITY_MPS2 9.80665
#define AIR_DENSITY 1.225 /* kg/m^3 */

/* Airframe. The figures are those of no particular aircraft; they are typical of the class. */
#define MASS_KG 3.2
#define WING_AREA_M2 0.47
#define CHORD_M 0.25
#define INERTIA_ROLL 0.18 /* kg m^2; the product of inertia is neglected */
#define INERTIA_PITCH 0.20
#define INERTIA_YAW 0.35

#define LIFT_0 0.25
#define LIFT_ALPHA 4.8
#define LIFT_ELEVATOR 0.35
#define LIFT_HIGHEST 1.30
#define LIFT_LOWEST (-0.80)
#define DRAG_0 0.045
#define DRAG_INDUCED 0.049 /* 1/(pi e AR) */
#define SIDE_BETA (-0.50)
#define SIDE_RUDDER 0.17

#define PITCH_0 0.02
#define PITCH_ALPHA (-0.70)
#define PITCH_RATE (-14.0)
#define PITCH_ELEVATOR (-1.10)
#define ROLL_BETA (-0.10)
#define ROLL_ROLL_RATE (-0.50)
#define ROLL_YAW_RATE 0.12
#define ROLL_AILERON 0.18
#define YAW_BETA 0.08
#define YAW_ROLL_RATE (-0.03)
#define YAW_YAW_RATE (-0.12)
#define YAW_AILERON (-0.005)
#define YAW_RUDDER (-0.08)

#define THRUST_FULL_N 20.0
#define WINDMILL_N_PER_MPS2 0.003 /* drag of the propeller at throttle 0, times airspeed squared */
#define SLOWEST_FLOW_MPS 1.0      /* directions of slower flow are not divided by it */
#define SURFACE_LAG_S 0.05
#define MOTOR_LAG_S 0.20

/* Autopilot gains */
#define ROLL_RATE_PER_BANK 3.5 /* 1/s */
#define ROLL_RATE_LIMIT_RPS 1.6
#define AILERON_PER_RATE_COMMAND 0.155 /* s; balances roll damping at any speed, times reference over airspeed */
#define AILERON_PER_RATE_ERROR 0.08    /* s */
#define ELEVATOR_PER_PITCH 0.6
#define ELEVATOR_PER_RATE 0.08          /* s */
#define RUDDER_PER_YAW_RATE 0.15        /* s */
#define CLIMB_PER_HEIGHT 0.7            /* 1/s: climb rate over height error */
#define PITCH_PER_CLIMB 1.0             /* of the slope's error */
#define PITCH_INTEGRAL_PER_HEIGHT 0.008 /* rad/(m s) */
#define PITCH_INTEGRAL_LIMIT 0.15       /* rad */
#define INTEGRAL_HEIGHT_LIMIT_M 3.0     /* larger errors are not integrated: no wind-up during a catch */
#define TURN_RATE_PER_COURSE 1.1        /* 1/s */
#define CLOSING_PER_CROSS_TRACK 0.5     /* 1/s: speed towards the path over distance from it */
#define CROSS_TRACK_COURSE_LIMIT 0.8    /* rad */
#define THROTTLE_PER_SPEED 0.25         /* s/m */
#define THROTTLE_INTEGRAL 0.08          /* 1/m */
#define REFERENCE_SPEED_MPS 17.0        /* at which the gains of the surfaces were chosen */

typedef struct { /* time derivative of the state */
    vec3_t position, velocity, rate;
    quat_t attitude;
    controls_t actual;
} derivative_t;

typedef struct {
    double airspeed, alpha, sin_beta, cos_alpha, sin_alpha;
    double pressure_area; /* N */
} airflow_t;

static airflow_t airflow(vec3_t relative_mps) {
    airflow_t flow;
    flow.airspeed = fmax(vec3_norm(relative_mps), SLOWEST_FLOW_MPS);
    flow.alpha = atan2(relative_mps.z, relative_mps.x);
    flow.sin_beta = relative_mps.y / flow.airspeed;
    const double in_plane =
        fmax(sqrt(relative_mps.x * relative_mps.x + relative_mps.z * relative_mps.z), SLOWEST_FLOW_MPS);
    flow.cos_alpha = relative_mps.x / in_plane;
    flow.sin_alpha = relative_mps.z / in_plane;
    flow.pressure_area = 0.5 * AIR_DENSITY * flow.airspeed * flow.airspeed * WING_AREA_M2;
    return flow;
}

static vec3_t relative_wind(const aircraft_state_t *state, const air_t *air, const mat3_t *body_to_ned) {
    const vec3_t moving_air = vec3_add(mat3_apply_transposed(body_to_ned, air->wind_ned_mps), air->gust.velocity_mps);
    return vec3_sub(state->velocity_body_mps, moving_air);
}

static vec3_t forces(const airflow_t *flow, const controls_t *controls) {
    const double lift_coefficient =
        clamp(LIFT_0 + LIFT_ALPHA * flow->alpha + LIFT_ELEVATOR * controls->elevator_rad, LIFT_LOWEST, LIFT_HIGHEST);
    const double lift = flow->pressure_area * lift_coefficient;
    const double drag = flow->pressure_area * (DRAG_0 + DRAG_INDUCED * lift_coefficient * lift_coefficient);
    const double side = flow->pressure_area * (SIDE_BETA * flow->sin_beta + SIDE_RUDDER * controls->rudder_rad);
    const double thrust = THRUST_FULL_N * controls->throttle - WINDMILL_N_PER_MPS2 * flow->airspeed * flow->airspeed;
    const double c = flow->cos_alpha, s = flow->sin_alpha;
    vec3_t force = {thrust + lift * s - drag * c, side, -lift * c - drag * s};
    return force;
}

static vec3_t moments(const airflow_t *flow, const controls_t *controls, vec3_t rate) {
    const double half_span = 0.5 * AIRCRAFT_SPAN_M / flow->airspeed, half_chord = 0.5 * CHORD_M / flow->airspeed;
    const double roll = ROLL_BETA * flow->sin_beta + half_span * (ROLL_ROLL_RATE * rate.x + ROLL_YAW_RATE * rate.z) +
                        ROLL_AILERON * controls->aileron_rad;
    const double pitch = PITCH_0 + PITCH_ALPHA * flow->alpha + half_chord * PITCH_RATE * rate.y +
                         PITCH_ELEVATOR * controls->elevator_rad;
    const double yaw = YAW_BETA * flow->sin_beta + half_span * (YAW_ROLL_RATE * rate.x + YAW_YAW_RATE * rate.z) +
                       YAW_AILERON * controls->aileron_rad + YAW_RUDDER * controls->rudder_rad;
    vec3_t moment = {flow->pressure_area * AIRCRAFT_SPAN_M * roll, flow->pressure_area * CHORD_M * pitch,
                     flow->pressure_area * AIRCRAFT_SPAN_M * yaw};
    return moment;
}

static derivative_t derivative(const aircraft_state_t *state, const controls_t *command, const air_t *air) {
    const mat3_t body_to_ned = quat_to_matrix(state->attitude);
    const airflow_t flow = airflow(relative_wind(state, air, &body_to_ned));
    const vec3_t force = forces(&flow, &state->actual);
    const vec3_t moment = moments(&flow, &state->actual, vec3_sub(state->rate_body_rps, air->gust.rate_rps));
    const vec3_t v = state->velocity_body_mps, w = state->rate_body_rps;
    const quat_t q = state->attitude;

    derivative_t d;
    d.position = mat3_apply(&body_to_ned, v);
    d.velocity.x = force.x / MASS_KG + GRAVITY_MPS2 * body_to_ned.m[2][0] + w.z * v.y - w.y * v.z;
    d.velocity.y = force.y / MASS_KG + GRAVITY_MPS2 * body_to_ned.m[2][1] + w.x * v.z - w.z * v.x;
    d.velocity.z = force.z / MASS_KG + GRAVITY_MPS2 * body_to_ned.m[2][2] + w.y * v.x - w.x * v.y;
    d.rate.x = (moment.x - (INERTIA_YAW - INERTIA_PITCH) * w.y * w.z) / INERTIA_ROLL;
    d.rate.y = (moment.y - (INERTIA_ROLL - INERTIA_YAW) * w.x * w.z) / INERTIA_PITCH;
    d.rate.z = (moment.z - (INERTIA_PITCH - INERTIA_ROLL) * w.x * w.y) / INERTIA_YAW;
    d.attitude.w = 0.5 * (-q.x * w.x - q.y * w.y - q.z * w.z);
    d.attitude.x = 0.5 * (q.w * w.x + q.y * w.z - q.z * w.y);
    d.attitude.y = 0.5 * (q.w * w.y + q.z * w.x - q.x * w.z);
    d.attitude.z = 0.5 * (q.w * w.z + q.x * w.y - q.y * w.x);
    d.actual.elevator_rad = (command->elevator_rad - state->actual.elevator_rad) / SURFACE_LAG_S;
    d.actual.aileron_rad = (command->aileron_rad - state->actual.aileron_rad) / SURFACE_LAG_S;
    d.actual.rudder_rad = (command->rudder_rad - state->actual.rudder_rad) / SURFACE_LAG_S;
    d.actual.throttle = (command->throttle - state->actual.throttle) / MOTOR_LAG_S;
    return d;
}

static aircraft_state_t moved(const aircraft_state_t *state, const derivative_t *d, double step_s) {
    aircraft_state_t next = *state;
    next.position_ned_m = vec3_add(state->position_ned_m, vec3_scale(d->position, step_s));
    next.velocity_body_mps = vec3_add(state->velocity_body_mps, vec3_scale(d->velocity, step_s));
    next.rate_body_rps = vec3_add(state->rate_body_rps, vec3_scale(d->rate, step_s));
    next.attitude.w += d->attitude.w * step_s;
    next.attitude.x += d->attitude.x * step_s;
    next.attitude.y += d->attitude.y * step_s;
    next.attitude.z += d->attitude.z * step_s;
    next.actual.elevator_rad += d->actual.elevator_rad * step_s;
    next.actual.aileron_rad += d->actual.aileron_rad * step_s;
    next.actual.rudder_rad += d->actual.rudder_rad * step_s;
    next.actual.throttle += d->actual.throttle * step_s;
    return next;
}

aircraft_state_t aircraft_advance(const aircraft_state_t *state, const controls_t *command, const air_t *air,
                                  double step_s) {
    const derivative_t k1 = derivative(state, command, air);
    const aircraft_state_t s2 = moved(state, &k1, 0.5 * step_s);
    const derivative_t k2 = derivative(&s2, command, air);
    const aircraft_state_t s3 = moved(state, &k2, 0.5 * step_s);
    const derivative_t k3 = derivative(&s3, command, air);
    const aircraft_state_t s4 = moved(state, &k3, step_s);
    const derivative_t k4 = derivative(&s4, command, air);
    aircraft_state_t next = moved(state, &k1, step_s / 6.0);
    next = moved(&next, &k2, step_s / 3.0);
    next = moved(&next, &k3, step_s / 3.0);
    next = moved(&next, &k4, step_s / 6.0);
    next.attitude = quat_normalized(next.attitude);
    return next;
}

double aircraft_airspeed(const aircraft_state_t *state, const air_t *air) {
    const mat3_t body_to_ned = quat_to_matrix(state->attitude);
    return vec3_norm(relative_wind(state, air, &body_to_ned));
}

vec3_t aircraft_ground_velocity(const aircraft_state_t *state) {
    const mat3_t body_to_ned = quat_to_matrix(state->attitude);
    return mat3_apply(&body_to_ned, state->velocity_body_mps);
}

bool aircraft_trim(double airspeed_mps, double climb_rad, double *alpha_rad, controls_t *trim) {
    const double pressure_area = 0.5 * AIR_DENSITY * airspeed_mps * airspeed_mps * WING_AREA_M2;
    const double weight = MASS_KG * GRAVITY_MPS2;
    double alpha = 0.0, thrust = 0.0, elevator = 0.0;
    /* Fixed point: thrust lifts little, so each round gains more than a digit; 40 rounds reach rounding. */
    for (int round = 0; round < 40; round++) {
        elevator = -(PITCH_0 + PITCH_ALPHA * alpha) / PITCH_ELEVATOR;
        const double lift = weight * cos(climb_rad) - thrust * sin(alpha);
        const double lift_coefficient = lift / pressure_area;
        alpha = (lift_coefficient - LIFT_0 - LIFT_ELEVATOR * elevator) / LIFT_ALPHA;
        const double drag = pressure_area * (DRAG_0 + DRAG_INDUCED * lift_coefficient * lift_coefficient);
        thrust = (drag + weight * sin(climb_rad)) / cos(alpha);
    }
    memset(trim, 0, sizeof *trim);
    *alpha_rad = alpha;
    trim->elevator_rad = elevator;
    trim->throttle = (thrust + WINDMILL_N_PER_MPS2 * airspeed_mps * airspeed_mps) / THRUST_FULL_N;
    const double lift_coefficient = LIFT_0 + LIFT_ALPHA * alpha + LIFT_ELEVATOR * elevator;
    return trim->throttle >= 0.0 && trim->throttle <= 1.0 && lift_coefficient < LIFT_HIGHEST &&
           fabs(elevator) < radians(AIRCRAFT_MAX_SURFACE_DEG);
}

bool aircraft_start(aircraft_t *aircraft, vec3_t position_ned_m, double airspeed_mps, double climb_rad,
                    double course_rad, vec3_t wind_ned_mps) {
    memset(aircraft, 0, sizeof *aircraft);
    autopilot_t *autopilot = &aircraft->autopilot;
    if (!aircraft_trim(airspeed_mps, climb_rad, &autopilot->trim_alpha_rad, &autopilot->trim)) {
        return false;
    }
    autopilot->trim_airspeed_mps = airspeed_mps;
    autopilot->trim_climb_rad = climb_rad;
    aircraft_state_t *state = &aircraft->state;
    const double alpha = autopilot->trim_alpha_rad;
    state->position_ned_m = position_ned_m;
    state->attitude = quat_from_euler(0.0, climb_rad + alpha, course_rad);
    const mat3_t body_to_ned = quat_to_matrix(state->attitude);
    const vec3_t through_air = {airspeed_mps * cos(alpha), 0.0, airspeed_mps * sin(alpha)};
    state->velocity_body_mps = vec3_add(through_air, mat3_apply_transposed(&body_to_ned, wind_ned_mps));
    state->actual = autopilot->trim;
    aircraft->command = autopilot->trim;
    return true;
}

static double surface(double angle_rad) {
    const double limit = radians(AIRCRAFT_MAX_SURFACE_DEG);
    return clamp(angle_rad, -limit, limit);
}

/* Bank that turns the course of the ground track onto the path, and along it. */
static double bank_command(const guidance_t *guidance, vec3_t ground_velocity) {
    const double ground_speed = hypot(ground_velocity.x, ground_velocity.y);
    const double course = atan2(ground_velocity.y, ground_velocity.x);
    const double towards_path = atan(CLOSING_PER_CROSS_TRACK * guidance->cross_track_m / fmax(ground_speed, 1.0));
    const double wanted =
        guidance->path_course_rad - clamp(towards_path, -CROSS_TRACK_COURSE_LIMIT, CROSS_TRACK_COURSE_LIMIT);
    const double turn_rate = guidance->path_curvature * ground_speed + TURN_RATE_PER_COURSE * wrap_pi(wanted - course);
    const double limit = radians(AIRCRAFT_MAX_BANK_DEG);
    return clamp(atan(turn_rate * ground_speed / GRAVITY_MPS2), -limit, limit);
}

static double lift_coefficient_of(double airspeed_mps, double lift_n) {
    return lift_n / (0.5 * AIR_DENSITY * airspeed_mps * airspeed_mps * WING_AREA_M2);
}

/* How far the angle of attack must differ from the trimmed start for this speed and bank. */
static double alpha_from_trim(const autopilot_t *autopilot, double airspeed_mps, double bank) {
    const double weight = MASS_KG * GRAVITY_MPS2;
    return (lift_coefficient_of(airspeed_mps, weight / fmax(cos(bank), 0.5)) -
            lift_coefficient_of(autopilot->trim_airspeed_mps, weight)) /
           LIFT_ALPHA;
}

static double pitch_command(autopilot_t *autopilot, const guidance_t *guidance, vec3_t ground_velocity, double alpha) {
    const double ground_speed = fmax(hypot(ground_velocity.x, ground_velocity.y), SLOWEST_FLOW_MPS);
    const double ground_climb = atan(-ground_velocity.z / ground_speed);
    if (fabs(guidance->height_error_m) < INTEGRAL_HEIGHT_LIMIT_M) {
        autopilot->pitch_integral_rad = clamp(
            autopilot->pitch_integral_rad + PITCH_INTEGRAL_PER_HEIGHT * guidance->height_error_m * AIRCRAFT_STEP_S,
            -PITCH_INTEGRAL_LIMIT, PITCH_INTEGRAL_LIMIT);
    }
    const double climb_limit = radians(AIRCRAFT_MAX_CLIMB_DEG), pitch_limit = radians(AIRCRAFT_MAX_PITCH_DEG);
    const double climb = clamp(guidance->climb_rad + CLIMB_PER_HEIGHT * guidance->height_error_m / ground_speed,
                               -climb_limit, climb_limit);
    return clamp(climb + PITCH_PER_CLIMB * (climb - ground_climb) + alpha + autopilot->pitch_integral_rad, -pitch_limit,
                 pitch_limit);
}

/* Thrust of steady flight, to first order: the reference is the trimmed start. */
static double steady_thrust(double airspeed_mps, double climb_rad) {
    const double weight = MASS_KG * GRAVITY_MPS2;
    const double lift = lift_coefficient_of(airspeed_mps, weight * cos(climb_rad));
    const double pressure_area = 0.5 * AIR_DENSITY * airspeed_mps * airspeed_mps * WING_AREA_M2;
    return pressure_area * (DRAG_0 + DRAG_INDUCED * lift * lift) + weight * sin(climb_rad) +
           WINDMILL_N_PER_MPS2 * airspeed_mps * airspeed_mps;
}

static double throttle_command(autopilot_t *autopilot, const guidance_t *guidance, double airspeed) {
    const double more_thrust = steady_thrust(guidance->airspeed_mps, guidance->climb_rad) -
                               steady_thrust(autopilot->trim_airspeed_mps, autopilot->trim_climb_rad) +
                               guidance->acceleration_mps2 * MASS_KG;
    const double error = guidance->airspeed_mps - airspeed;
    const double wanted = autopilot->trim.throttle + more_thrust / THRUST_FULL_N + THROTTLE_PER_SPEED * error +
                          autopilot->throttle_integral;
    const bool pushes_into_limit = (wanted > 1.0 && error > 0.0) || (wanted < 0.0 && error < 0.0);
    if (!pushes_into_limit) {
        autopilot->throttle_integral =
            clamp(autopilot->throttle_integral + THROTTLE_INTEGRAL * error * AIRCRAFT_STEP_S, -0.5, 0.5);
    }
    return clamp(wanted, 0.0, 1.0);
}

void aircraft_autopilot(aircraft_t *aircraft, const guidance_t *wanted, const air_t *air) {
    guidance_t accepted = *wanted;
    accepted.airspeed_mps =
        clamp(wanted->airspeed_mps, AIRCRAFT_SLOWEST_MPS, AIRCRAFT_FASTEST_MPS / cos(wanted->climb_rad));
    const guidance_t *guidance = &accepted;
    const aircraft_state_t *state = &aircraft->state;
    autopilot_t *autopilot = &aircraft->autopilot;
    double roll, pitch, yaw;
    quat_to_euler(state->attitude, &roll, &pitch, &yaw);
    const vec3_t ground_velocity = aircraft_ground_velocity(state);
    const double airspeed = fmax(aircraft_airspeed(state, air), 5.0);
    const double effectiveness = REFERENCE_SPEED_MPS / airspeed;
    const double gain = effectiveness * effectiveness;
    /* rates of a coordinated turn at this bank; what surfaces they take is fed forward */
    const double turn_rate = GRAVITY_MPS2 * tan(roll) / airspeed;
    const double pitch_rate = turn_rate * sin(roll) * cos(pitch), yaw_rate = turn_rate * cos(roll) * cos(pitch);

    const double bank = bank_command(guidance, ground_velocity);
    autopilot->bank_command_rad = bank;
    const double roll_rate = clamp(ROLL_RATE_PER_BANK * (bank - roll), -ROLL_RATE_LIMIT_RPS, ROLL_RATE_LIMIT_RPS);
    aircraft->command.aileron_rad =
        surface(AILERON_PER_RATE_COMMAND * effectiveness * roll_rate +
                AILERON_PER_RATE_ERROR * gain * (roll_rate - state->rate_body_rps.x) -
                0.5 * AIRCRAFT_SPAN_M / airspeed * yaw_rate * (ROLL_YAW_RATE / ROLL_AILERON));

    const double alpha = alpha_from_trim(autopilot, guidance->airspeed_mps, roll);
    autopilot->pitch_command_rad =
        pitch_command(autopilot, guidance, ground_velocity, autopilot->trim_alpha_rad + alpha);
    aircraft->command.elevator_rad =
        surface(autopilot->trim.elevator_rad -
                (PITCH_ALPHA * alpha + 0.5 * CHORD_M / airspeed * PITCH_RATE * pitch_rate) / PITCH_ELEVATOR -
                gain * ELEVATOR_PER_PITCH * (autopilot->pitch_command_rad - pitch) +
                gain * ELEVATOR_PER_RATE * (state->rate_body_rps.y - pitch_rate));

    aircraft->command.rudder_rad = surface(gain * RUDDER_PER_YAW_RATE * (state->rate_body_rps.z - yaw_rate));
    aircraft->command.throttle = throttle_command(autopilot, guidance, airspeed);
}
