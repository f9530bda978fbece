/* Where the aircraft was: the latest half second of attitude and position. SPDX-License-Identifier: MIT */
#ifndef GOE_FLIGHT_HISTORY_H
#define GOE_FLIGHT_HISTORY_H

#include "goe_flight.h"

/* What the pose was at a time; attitude of norm 1. */
typedef struct {
    float q[4];
    float ned_m[3];
    float rate_deg_s; /* of the attitude: root mean square over the history */
    float spread_deg; /* one sigma of what interpolation misses of the attitude */
} goe_flight_history_pose_t;

void goe_flight_history_clear(goe_flight_history_t *history);

/* Samples, checked but for their time. False: not newer than the latest of its ring. */
bool goe_flight_history_add_attitude(goe_flight_history_t *history, uint32_t time_us, const float q[4]);
bool goe_flight_history_add_position(goe_flight_history_t *history, uint32_t time_us, const float ned_m[3]);

/* A known jump of the autopilot's filter: older samples are moved as if they had come after it. */
void goe_flight_history_shift(goe_flight_history_t *history, const float jump_ned_m[3]);

/* The newest samples; null if there is none. */
const goe_flight_history_attitude_t *goe_flight_history_newest_attitude(const goe_flight_history_t *history);
const goe_flight_history_position_t *goe_flight_history_newest_position(const goe_flight_history_t *history);

/* GOE_FLIGHT_OK, _TOO_NEW, _TOO_OLD, _NO_POSE. */
goe_flight_status_t goe_flight_history_at(const goe_flight_history_t *history, uint32_t time_us,
                                          goe_flight_history_pose_t *pose);

#endif
