/*
 * Prints data for the tests that are not in goe_sim's logs: raw series of the simulator's parts, one row of numbers per step.
 *
 *   sim_probe turbulence W20_MPS AIRSPEED HEIGHT STEP_S COUNT SEED     u v w p q r
 *   sim_probe trim AIRSPEED CLIMB_DEG                                  ok alpha_rad elevator_rad throttle
 *   sim_probe respond AIRSPEED CLIMB_DEG SECONDS WHAT SIZE             see respond(); WHAT: none height cross course speed
 *   sim_probe random SEED STREAM COUNT                                 bits uniform normal (of three equal streams)
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "aircraft.h"
#include "random.h"
#include "rotation.h"
#include "turbulence.h"

static int turbulence(char **argument) {
    const double w20 = atof(argument[0]), airspeed = atof(argument[1]), height = atof(argument[2]);
    const double step_s = atof(argument[3]);
    const long count = atol(argument[4]);
    turbulence_t t = turbulence_start(w20, AIRCRAFT_SPAN_M, strtoull(argument[5], NULL, 10));
    for (long i = 0; i < count; i++) {
        const gust_t g = turbulence_step(&t, airspeed, height, step_s);
        (void)printf("%.9g %.9g %.9g %.9g %.9g %.9g\n", g.velocity_mps.x, g.velocity_mps.y, g.velocity_mps.z,
                     g.rate_rps.x, g.rate_rps.y, g.rate_rps.z);
    }
    return 0;
}

static int trim(char **argument) {
    double alpha;
    controls_t controls;
    const bool ok = aircraft_trim(atof(argument[0]), radians(atof(argument[1])), &alpha, &controls);
    (void)printf("%d %.17g %.17g %.17g\n", ok ? 1 : 0, alpha, controls.elevator_rad, controls.throttle);
    return 0;
}

/* Straight flight north; at 2 s the reference jumps by SIZE: height (m, up), cross (m: the path jumps to the right), course
 * (deg: the path turns right about where the aircraft is), speed (m/s).
 * Row: t height_error cross_track course_deg airspeed climb_deg roll_deg pitch_deg bank_cmd_deg pitch_cmd_deg elevator_deg
 * aileron_deg rudder_deg throttle */
static int respond(char **argument) {
    const double airspeed = atof(argument[0]), climb = radians(atof(argument[1])), seconds = atof(argument[2]);
    const char *what = argument[3];
    const double size = atof(argument[4]);
    const vec3_t start = {0.0, 0.0, -1000.0}, no_wind = {0.0, 0.0, 0.0};
    aircraft_t a;
    air_t air;
    memset(&air, 0, sizeof air);
    if (!aircraft_start(&a, start, airspeed, climb, 0.0, no_wind)) {
        return 1;
    }
    const long steps = lround(seconds / AIRCRAFT_STEP_S);
    double turn_n = 0.0, turn_e = 0.0;
    for (long i = 0; i < steps; i++) {
        const double t = (double)i * AIRCRAFT_STEP_S;
        const bool jumped = t >= 2.0;
        if (!jumped) {
            turn_n = a.state.position_ned_m.x;
            turn_e = a.state.position_ned_m.y;
        }
        guidance_t g;
        memset(&g, 0, sizeof g);
        g.airspeed_mps = airspeed + (jumped && strcmp(what, "speed") == 0 ? size : 0.0);
        g.climb_rad = climb;
        g.path_course_rad = jumped && strcmp(what, "course") == 0 ? radians(size) : 0.0;
        const double n = a.state.position_ned_m.x - turn_n, e = a.state.position_ned_m.y - turn_e;
        g.cross_track_m = cos(g.path_course_rad) * e - sin(g.path_course_rad) * n;
        const double along = cos(g.path_course_rad) * (n + turn_n) + sin(g.path_course_rad) * (e + turn_e);
        g.height_error_m = 1000.0 + along * tan(climb) + a.state.position_ned_m.z;
        if (jumped && strcmp(what, "height") == 0) {
            g.height_error_m += size;
        }
        if (jumped && strcmp(what, "cross") == 0) {
            g.cross_track_m -= size;
        }
        aircraft_autopilot(&a, &g, &air);
        double roll, pitch, yaw;
        quat_to_euler(a.state.attitude, &roll, &pitch, &yaw);
        const vec3_t v = aircraft_ground_velocity(&a.state);
        const controls_t *c = &a.state.actual;
        (void)printf("%.9g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g\n", t,
                     g.height_error_m, g.cross_track_m, degrees(atan2(v.y, v.x)), aircraft_airspeed(&a.state, &air),
                     degrees(atan2(-v.z, hypot(v.x, v.y))), degrees(roll), degrees(pitch),
                     degrees(a.autopilot.bank_command_rad), degrees(a.autopilot.pitch_command_rad),
                     degrees(c->elevator_rad), degrees(c->aileron_rad), degrees(c->rudder_rad), c->throttle);
        a.state = aircraft_advance(&a.state, &a.command, &air, AIRCRAFT_STEP_S);
    }
    return 0;
}

static int random_numbers(char **argument) {
    const uint64_t seed = strtoull(argument[0], NULL, 10), stream = strtoull(argument[1], NULL, 10);
    const long count = atol(argument[2]);
    random_t bits = random_start(seed, stream), uniform = bits, normal = bits;
    for (long i = 0; i < count; i++) {
        (void)printf("%" PRIu64, random_bits(&bits));
        (void)printf(" %.17g", random_uniform(&uniform));
        (void)printf(" %.17g\n", random_normal(&normal));
    }
    return 0;
}

int main(int argc, char **argv) {
    if (argc == 8 && strcmp(argv[1], "turbulence") == 0) {
        return turbulence(&argv[2]);
    }
    if (argc == 4 && strcmp(argv[1], "trim") == 0) {
        return trim(&argv[2]);
    }
    if (argc == 7 && strcmp(argv[1], "respond") == 0) {
        return respond(&argv[2]);
    }
    if (argc == 5 && strcmp(argv[1], "random") == 0) {
        return random_numbers(&argv[2]);
    }
    (void)fprintf(stderr, "usage: see the head of sim_probe.c\n");
    return 2;
}
