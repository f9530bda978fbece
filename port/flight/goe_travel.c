/* Comparison of the positions with the velocities. SPDX-License-Identifier: MIT
 *
 * Hazards and orders use the velocity, the estimates use the positions. An autopilot's own filter keeps the two consistent within 0.4 m in
 * a second and 0.9 m in ten (recorded flights of PX4 and ArduPlane). They differ more if a port mixes up axes, signs or units, if the
 * velocity is never set or is that through the air, or after a false satellite fix. The layer does not know which of the two is wrong. It
 * therefore corrects nothing, and clears nothing. */
#include "goe_travel.h"

#include <math.h>

#include "goe_flight_maths.h"

#define GAP_S 0.5f      /* longest gap between samples over which the velocity is known */
#define OFF_M 4.0f      /* allowed horizontal difference of a way */
#define OFF_DOWN_M 3.0f /* allowed vertical one: a climb of 2.5 m/s with the wrong sign exceeds it in a second */
#define DOUBT_S 10.0f   /* time of agreement until the pose counts again */

/* Allowed share of the way: over a second it covers late and rare samples in a turn, over ten only scale errors and slow drift. */
static const struct {
    float span_s, share;
} spans[GOE_FLIGHT_TRAVELS] = {{1.0f, 0.3f}, {10.0f, 0.1f}};

static float length_m(float north_m, float east_m) { return sqrtf(north_m * north_m + east_m * east_m); }

static void begin(goe_flight_way_t *way, const goe_flight_position_t *sample) {
    memset(way, 0, sizeof *way);
    way->begun_us = sample->time_us;
    memcpy(way->begun_ned_m, sample->position_ned_m, sizeof way->begun_ned_m);
}

/* Adds a step by the mean velocity of two samples. */
static void go_on(goe_flight_way_t *way, const float step_ned_m[3]) {
    for (int i = 0; i < 3; i++) {
        way->by_velocity_m[i] += step_ned_m[i];
    }
    way->across_m += length_m(step_ned_m[0], step_ned_m[1]);
    way->down_m += goe_flight_absolute(step_ned_m[2]);
}

/* NaN also counts as a contradiction. */
static bool is_contradicted(const goe_flight_way_t *way, const float ned_m[3], float share) {
    float apart[3];
    float moved[3];
    for (int i = 0; i < 3; i++) {
        moved[i] = ned_m[i] - way->begun_ned_m[i];
        apart[i] = moved[i] - way->by_velocity_m[i];
    }
    const float across_m = goe_flight_larger(way->across_m, length_m(moved[0], moved[1]));
    const float down_m = goe_flight_larger(way->down_m, goe_flight_absolute(moved[2]));
    return !goe_flight_within(length_m(apart[0], apart[1]), OFF_M + share * across_m) ||
           !goe_flight_within(apart[2], OFF_DOWN_M + share * down_m);
}

static void judge(goe_flight_travel_t *travel, const goe_flight_position_t *sample, int span) {
    goe_flight_way_t *way = &travel->way[span];
    const bool contradicted = is_contradicted(way, sample->position_ned_m, spans[span].share);
    if (contradicted) {
        travel->doubted = true;
        travel->doubted_us = sample->time_us;
    }
    if (contradicted || goe_flight_between_s(sample->time_us, way->begun_us) >= spans[span].span_s) {
        begin(way, sample);
    }
}

void goe_flight_travel_take(goe_flight_travel_t *travel, const goe_flight_position_t *sample) {
    const float step_s = goe_flight_between_s(sample->time_us, travel->newest_us);
    const bool follows = travel->begun && step_s >= 0.0f && step_s <= GAP_S;
    float step_ned_m[3];
    for (int i = 0; i < 3; i++) {
        step_ned_m[i] = 0.5f * step_s * (travel->velocity_ned_m_s[i] + sample->velocity_ned_m_s[i]);
    }
    for (int span = 0; span < GOE_FLIGHT_TRAVELS; span++) {
        if (follows) {
            go_on(&travel->way[span], step_ned_m);
            judge(travel, sample, span);
        } else {
            begin(&travel->way[span], sample);
        }
    }
    travel->begun = true;
    travel->newest_us = sample->time_us;
    memcpy(travel->velocity_ned_m_s, sample->velocity_ned_m_s, sizeof travel->velocity_ned_m_s);
    const float ago_s = goe_flight_between_s(sample->time_us, travel->doubted_us);
    travel->doubted = travel->doubted && ago_s >= 0.0f && ago_s < DOUBT_S;
}

void goe_flight_travel_shift(goe_flight_travel_t *travel, const float jump_ned_m[3]) {
    for (int span = 0; span < GOE_FLIGHT_TRAVELS; span++) {
        for (int i = 0; i < 3; i++) {
            travel->way[span].begun_ned_m[i] += jump_ned_m[i];
        }
    }
}

bool goe_flight_travel_end(const goe_flight_travel_t *travel, float ned_m[3], uint32_t *time_us) {
    for (int i = 0; i < 3; i++) {
        ned_m[i] = travel->way[0].begun_ned_m[i] + travel->way[0].by_velocity_m[i];
    }
    *time_us = travel->newest_us;
    return travel->begun;
}

void goe_flight_travel_restart(goe_flight_travel_t *travel) { travel->begun = false; }
