/* Jumps that no reset announces. SPDX-License-Identifier: MIT */
#include "goe_slip.h"

#include "goe_flight_maths.h"

#define MEMORY_S 1.0f  /* the slip fades: a velocity that is wrong by 1 m/s keeps it at 1 m */
#define CALM_M 0.7f    /* below it the velocity agrees with the positions ... */
#define CALM_S 1.0f    /* ... and after so long it is trusted ... */
#define TRUSTED_S 3.0f /* ... for so long: a filter's correction takes no longer, and a velocity may go wrong */
#define JUMP_M 1.4f    /* beyond it the positions have jumped ... */
#define REST_M 0.3f    /* ... and until they are calm again, beyond this */
#define TURN_M_S2 5.0f /* an aircraft's acceleration changes by some 10 m/s2 in a step: half of it is not predicted */
#define STEP_MAX_S 1.0f

void goe_flight_slip_clear(goe_flight_slip_t *slip) {
    memset(slip, 0, sizeof *slip);
    slip->doubted_s = TRUSTED_S;
}

void goe_flight_slip_between(const goe_flight_history_position_t *newest, const float before_m_s[3],
                             const float now_m_s[3], const goe_flight_position_t *sample, float off_ned_m[3]) {
    const float half_s = 0.5f * goe_flight_between_s(sample->time_us, newest->time_us);
    for (int i = 0; i < 3; i++) {
        const float way_m = half_s * (before_m_s[i] + now_m_s[i]);
        off_ned_m[i] = sample->position_ned_m[i] - newest->ned_m[i] - way_m;
    }
}

/* Whether it is larger than the limit, along the ground or vertically. */
static bool exceeds(const float ned_m[3], float limit_m) {
    return ned_m[0] * ned_m[0] + ned_m[1] * ned_m[1] > limit_m * limit_m || !goe_flight_within(ned_m[2], limit_m);
}

static void judge_calm(goe_flight_slip_t *slip, float step_s) {
    slip->calm_s = exceeds(slip->ned_m, CALM_M) ? 0.0f : goe_flight_smaller(slip->calm_s + step_s, CALM_S);
    if (slip->calm_s < CALM_S) {
        slip->doubted_s = goe_flight_smaller(slip->doubted_s + step_s, TRUSTED_S);
    } else {
        slip->doubted_s = 0.0f;
        slip->jumping = false;
    }
}

bool goe_flight_slip_jumped(goe_flight_slip_t *slip, const float off_ned_m[3], float step_s, float jump_ned_m[3]) {
    float sum_m[3];
    const bool usable = step_s > 0.0f && step_s <= STEP_MAX_S;
    for (int i = 0; i < 3 && usable; i++) {
        sum_m[i] = slip->ned_m[i] * (1.0f - step_s / MEMORY_S) + off_ned_m[i];
    }
    if (!usable || !goe_flight_all_finite(sum_m, 3)) {
        goe_flight_slip_clear(slip);
        return false;
    }
    memcpy(slip->ned_m, sum_m, sizeof sum_m);
    judge_calm(slip, step_s);
    const float limit_m = (slip->jumping ? REST_M : JUMP_M) + TURN_M_S2 * step_s * step_s;
    if (!(slip->doubted_s < TRUSTED_S) || !exceeds(sum_m, limit_m)) {
        return false;
    }
    memcpy(jump_ned_m, sum_m, sizeof sum_m);
    memset(slip->ned_m, 0, sizeof slip->ned_m);
    slip->calm_s = 0.0f;
    slip->jumping = true;
    return true;
}
