/* History of the pose: the samples of attitude and position of the latest 0.6 s or more. SPDX-License-Identifier: MIT */
#ifndef GOE_FLIGHT_HISTORY_H
#define GOE_FLIGHT_HISTORY_H

#include "goe_flight.h"

/* Interpolated pose at a time; the attitude has the norm 1. */
typedef struct {
    float q[4];
    float ned_m[3];
    float rate_deg_s; /* rms rotation rate over the history */
    float spread_deg; /* one sigma of the attitude's interpolation error */
} goe_flight_history_pose_t;

void goe_flight_history_clear(goe_flight_history_t *history);

/* Add a sample that was checked, except for its time. Return false if it is not newer than the latest one of its ring. */
bool goe_flight_history_add_attitude(goe_flight_history_t *history, uint32_t time_us, const float q[4]);
bool goe_flight_history_add_position(goe_flight_history_t *history, uint32_t time_us, const float ned_m[3]);

/* Shifts all samples by a known jump of the autopilot's filter. */
void goe_flight_history_shift(goe_flight_history_t *history, const float jump_ned_m[3]);

/* Return the newest sample; null if there is none. */
const goe_flight_history_attitude_t *goe_flight_history_newest_attitude(const goe_flight_history_t *history);
const goe_flight_history_position_t *goe_flight_history_newest_position(const goe_flight_history_t *history);

/* Interpolates the pose at a time. Returns GOE_FLIGHT_OK, _TOO_NEW, _TOO_OLD or _NO_POSE. */
goe_flight_status_t goe_flight_history_at(const goe_flight_history_t *history, uint32_t time_us,
                                          goe_flight_history_pose_t *pose);

#endif
