/* Detects resets of the autopilot's filter. SPDX-License-Identifier: MIT */
#include "goe_marks.h"

#include "goe_flight_maths.h"

#define SUM_MAX_M 1.0e6f

goe_flight_marks_change_t goe_flight_marks_attitude(goe_flight_marks_t *marks, uint32_t mark) {
    const bool changed = marks->attitude_known && marks->attitude != mark;
    marks->attitude = mark;
    marks->attitude_known = true;
    return changed ? GOE_FLIGHT_MARKS_UNKNOWN : GOE_FLIGHT_MARKS_SAME;
}

/* If a counter rose by more than 1, one of the jumps was not reported. */
static goe_flight_marks_change_t compare(uint32_t before, uint32_t now, bool counters) {
    if (before == now) {
        return GOE_FLIGHT_MARKS_SAME;
    }
    return !counters || ((now - before) & 0xFFu) == 1u ? GOE_FLIGHT_MARKS_JUMP : GOE_FLIGHT_MARKS_UNKNOWN;
}

static bool add_jump(goe_flight_marks_t *marks, const float jump_ned_m[3]) {
    float sum[3];
    for (int i = 0; i < 3; i++) {
        sum[i] = marks->jumps_ned_m[i] + jump_ned_m[i];
    }
    if (!goe_flight_all_within(sum, 3, SUM_MAX_M)) {
        return false;
    }
    memcpy(marks->jumps_ned_m, sum, sizeof sum);
    return true;
}

goe_flight_marks_change_t goe_flight_marks_position(goe_flight_marks_t *marks, const goe_flight_position_t *sample,
                                                    bool counters, float jump_ned_m[3]) {
    const bool first = !marks->position_known;
    const goe_flight_marks_change_t horizontal = compare(marks->horizontal, sample->reset_horizontal, counters);
    const goe_flight_marks_change_t vertical = compare(marks->vertical, sample->reset_vertical, counters);
    marks->horizontal = sample->reset_horizontal;
    marks->vertical = sample->reset_vertical;
    marks->position_known = true;
    if (first || (horizontal == GOE_FLIGHT_MARKS_SAME && vertical == GOE_FLIGHT_MARKS_SAME)) {
        return GOE_FLIGHT_MARKS_SAME;
    }
    if (horizontal == GOE_FLIGHT_MARKS_UNKNOWN || vertical == GOE_FLIGHT_MARKS_UNKNOWN ||
        !goe_flight_is_set(&sample->reset_delta_known)) {
        return GOE_FLIGHT_MARKS_UNKNOWN;
    }
    for (int i = 0; i < 3; i++) {
        const bool jumped = (i < 2 ? horizontal : vertical) == GOE_FLIGHT_MARKS_JUMP;
        jump_ned_m[i] = jumped ? sample->reset_delta_ned_m[i] : 0.0f;
    }
    return add_jump(marks, jump_ned_m) ? GOE_FLIGHT_MARKS_JUMP : GOE_FLIGHT_MARKS_UNKNOWN;
}
