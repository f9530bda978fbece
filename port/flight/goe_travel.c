/* Comparison of the positions with the velocities. SPDX-License-Identifier: MIT
 *
 * Hazards and orders follow the velocity, the estimates follow the positions. An autopilot's own filter keeps the two together
 * within 0.4 m in a second (recorded flights of PX4 and ArduPlane). A port that mixes up axes, signs or units, a velocity that nobody
 * sets, and a false fix of the satellites separate them. Which of the two is wrong is not known here: so the layer corrects
 * nothing, and clears nothing. */
#include "goe_travel.h"

#include <math.h>

#include "goe_flight_maths.h"

#define SPAN_S 1.0f     /* of one comparison */
#define GAP_S 0.5f      /* between samples: beyond it the velocity in between is not known */
#define OFF_M 3.0f      /* horizontally, and ... */
#define OFF_DOWN_M 2.0f /* ... vertically; so a climb of 2.5 m/s with the wrong sign exceeds it */
#define OFF_SHARE 0.3f  /* of the way: samples 0.2 s apart in a turn, wind instead of ground speed */
#define DOUBT_S 10.0f   /* of agreement before the pose counts again */

static void begin(goe_flight_travel_t *travel, const goe_flight_position_t *sample) {
    travel->begun_us = sample->time_us;
    memcpy(travel->begun_ned_m, sample->position_ned_m, sizeof travel->begun_ned_m);
    memset(travel->by_velocity_m, 0, sizeof travel->by_velocity_m);
    travel->begun = true;
}

static float length_m(float north_m, float east_m) { return sqrtf(north_m * north_m + east_m * east_m); }

/* Whether two ways differ by more than `off_m` and a share of the longer one. NaN differs. */
static bool differ(float apart_m, float one_m, float other_m, float off_m) {
    return !goe_flight_within(apart_m, off_m + OFF_SHARE * goe_flight_larger(one_m, other_m));
}

static bool is_contradicted(const goe_flight_travel_t *travel, const float ned_m[3]) {
    const float *by_velocity = travel->by_velocity_m;
    float moved[3];
    for (int i = 0; i < 3; i++) {
        moved[i] = ned_m[i] - travel->begun_ned_m[i];
    }
    const float apart_m = length_m(moved[0] - by_velocity[0], moved[1] - by_velocity[1]);
    return differ(apart_m, length_m(moved[0], moved[1]), length_m(by_velocity[0], by_velocity[1]), OFF_M) ||
           differ(moved[2] - by_velocity[2], goe_flight_absolute(moved[2]), goe_flight_absolute(by_velocity[2]),
                  OFF_DOWN_M);
}

static void judge(goe_flight_travel_t *travel, const goe_flight_position_t *sample) {
    if (is_contradicted(travel, sample->position_ned_m)) {
        travel->doubted = true;
        travel->doubted_us = sample->time_us;
        begin(travel, sample);
    } else if (goe_flight_between_s(sample->time_us, travel->begun_us) >= SPAN_S) {
        begin(travel, sample);
    }
}

void goe_flight_travel_take(goe_flight_travel_t *travel, const goe_flight_position_t *sample) {
    const float step_s = goe_flight_between_s(sample->time_us, travel->newest_us);
    travel->newest_us = sample->time_us;
    if (travel->begun && step_s >= 0.0f && step_s <= GAP_S) {
        for (int i = 0; i < 3; i++) {
            travel->by_velocity_m[i] += step_s * sample->velocity_ned_m_s[i];
        }
        judge(travel, sample);
    } else {
        begin(travel, sample);
    }
    const float ago_s = goe_flight_between_s(sample->time_us, travel->doubted_us);
    travel->doubted = travel->doubted && ago_s >= 0.0f && ago_s < DOUBT_S;
}

void goe_flight_travel_shift(goe_flight_travel_t *travel, const float jump_ned_m[3]) {
    for (int i = 0; i < 3; i++) {
        travel->begun_ned_m[i] += jump_ned_m[i];
    }
}

void goe_flight_travel_restart(goe_flight_travel_t *travel) { travel->begun = false; }
