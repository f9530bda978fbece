/* History of the pose: two rings of samples, and the interpolation between samples. SPDX-License-Identifier: MIT
 *
 * Autopilots publish attitude and position separately and at different rates, hence two rings. A new sample overwrites the newest one if
 * that is less than 20 ms after the one before it. Samples every 4 ms therefore leave gaps just under 24 ms, the newest sample is always
 * there, and 32 of them last for 0.6 s. */
#include "goe_history.h"

#include <math.h>

#include "goe_flight_maths.h"

#define THIN_US 20000
#define GAP_MAX_US 500000                                /* no interpolation over a longer gap */
#define NEAR_S (2.0f * GAP_MAX_US * GOE_FLIGHT_S_PER_US) /* samples farther apart do not show a bend */
#define CHANGES 4                                        /* number of changes of the rate that count */
#define NONE (-1)
#define NORM_MIN 0.5f
/* Error of the interpolation over that of a straight line, one sigma, in recorded flights with samples 200 ms apart. */
#define MISSED_BY_CUBIC 0.2f
#define MISSED_BY_PARABOLA 0.5f

void goe_flight_history_clear(goe_flight_history_t *history) { memset(history, 0, sizeof *history); }

/* ------------------------------------------------------------------------------------------------------------- rings -- */

enum { ATTITUDES, POSITIONS };

/* Index of the sample `back` samples before the newest, in a ring whose next free index is `next`. */
static int place(int next, int back) {
    return (int)((unsigned)(next + 2 * GOE_FLIGHT_SAMPLES - 1 - back) % GOE_FLIGHT_SAMPLES);
}

static int count_of(const goe_flight_history_t *h, int ring) {
    const int count = ring == ATTITUDES ? h->attitude_count : h->position_count;
    return count < GOE_FLIGHT_SAMPLES ? count : GOE_FLIGHT_SAMPLES;
}

static uint32_t time_of(const goe_flight_history_t *h, int ring, int back) {
    return ring == ATTITUDES ? h->attitude[place(h->attitude_next, back)].time_us
                             : h->position[place(h->position_next, back)].time_us;
}

/* Index for a sample of this time; NONE: it is not newer. Advances the ring if the sample needs a place of its own. */
static int make_place(goe_flight_history_t *h, int ring, uint32_t time_us) {
    uint8_t *next = ring == ATTITUDES ? &h->attitude_next : &h->position_next;
    uint8_t *count = ring == ATTITUDES ? &h->attitude_count : &h->position_count;
    const uint32_t newest_us = time_of(h, ring, 0);
    if (*count > 0 && goe_flight_between_us(time_us, newest_us) <= 0) {
        return NONE;
    }
    if (*count > 1 && goe_flight_between_us(newest_us, time_of(h, ring, 1)) < THIN_US) {
        return place(*next, 0);
    }
    const int here = *next % GOE_FLIGHT_SAMPLES;
    *next = (uint8_t)((here + 1) % GOE_FLIGHT_SAMPLES);
    *count = (uint8_t)(*count < GOE_FLIGHT_SAMPLES ? *count + 1 : GOE_FLIGHT_SAMPLES);
    return here;
}

bool goe_flight_history_add_attitude(goe_flight_history_t *history, uint32_t time_us, const float q[4]) {
    const int here = make_place(history, ATTITUDES, time_us);
    if (here != NONE) {
        history->attitude[here].time_us = time_us;
        memcpy(history->attitude[here].q, q, sizeof history->attitude[here].q);
    }
    return here != NONE;
}

bool goe_flight_history_add_position(goe_flight_history_t *history, uint32_t time_us, const float ned_m[3]) {
    const int here = make_place(history, POSITIONS, time_us);
    if (here != NONE) {
        history->position[here].time_us = time_us;
        memcpy(history->position[here].ned_m, ned_m, sizeof history->position[here].ned_m);
    }
    return here != NONE;
}

void goe_flight_history_shift(goe_flight_history_t *history, const float jump_ned_m[3]) {
    for (int k = 0; k < GOE_FLIGHT_SAMPLES; k++) {
        for (int i = 0; i < 3; i++) {
            history->position[k].ned_m[i] += jump_ned_m[i];
        }
    }
}

const goe_flight_history_attitude_t *goe_flight_history_newest_attitude(const goe_flight_history_t *history) {
    return history->attitude_count > 0 ? &history->attitude[place(history->attitude_next, 0)] : NULL;
}

const goe_flight_history_position_t *goe_flight_history_newest_position(const goe_flight_history_t *history) {
    return history->position_count > 0 ? &history->position[place(history->position_next, 0)] : NULL;
}

/* ----------------------------------------------------------------------------------------------------- interpolation -- */

/* The two samples around a time, counted back from the newest, and the share of the step from the older to the newer. */
typedef struct {
    int newer, older;
    float share;
} bracket_t;

static goe_flight_status_t find(const goe_flight_history_t *h, int ring, uint32_t time_us, bracket_t *found) {
    const int count = count_of(h, ring);
    int back = 0;
    while (back < count && goe_flight_between_us(time_us, time_of(h, ring, back)) < 0) {
        back++;
    }
    found->older = back;
    found->newer = back > 0 ? back - 1 : 0;
    found->share = 0.0f;
    if (back == 0) {
        return time_us == time_of(h, ring, 0) ? GOE_FLIGHT_OK : GOE_FLIGHT_TOO_NEW;
    }
    const uint32_t older_us = time_of(h, ring, back);
    const int32_t gap_us = goe_flight_between_us(time_of(h, ring, back - 1), older_us);
    if (back == count || gap_us > GAP_MAX_US) {
        return GOE_FLIGHT_TOO_OLD;
    }
    const int32_t past_us = goe_flight_between_us(time_us, older_us);
    found->share = (float)past_us / (float)gap_us;
    return GOE_FLIGHT_OK;
}

static float dot(const float a[4], const float b[4]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]; }

/* ----------------------------------------------------------------------------------------- attitude between samples -- */

/* A sample: its time from the older one of the bracket, and q with the sign of a neighbor, as q and -q are the same. */
typedef struct {
    float at_s, q[4];
    bool known;
} knot_t;

static knot_t knot(const goe_flight_history_t *h, int back, const goe_flight_history_attitude_t *from) {
    knot_t k;
    memset(&k, 0, sizeof k);
    if (back < 0 || back >= count_of(h, ATTITUDES)) {
        return k;
    }
    const goe_flight_history_attitude_t *sample = &h->attitude[place(h->attitude_next, back)];
    const float sign = dot(sample->q, from->q) < 0.0f ? -1.0f : 1.0f;
    for (int i = 0; i < 4; i++) {
        k.q[i] = sign * sample->q[i];
    }
    k.at_s = goe_flight_between_s(sample->time_us, from->time_us);
    k.known = goe_flight_within(k.at_s, NEAR_S);
    return k;
}

/* The slope at the middle knot of the parabola through three knots, minus the slope of the line from the middle to `to`. */
static float bend(const knot_t *outer, const knot_t *middle, const knot_t *to, int i) {
    const float before = (middle->q[i] - outer->q[i]) / (middle->at_s - outer->at_s);
    const float behind = (to->q[i] - middle->q[i]) / (to->at_s - middle->at_s);
    return (before - behind) * (to->at_s - middle->at_s) / (to->at_s - outer->at_s);
}

/* Square of the angle between two attitudes: |2 vec(a* b)|^2, by |vec|^2 = 1 - dot^2; without cancellation for small turns. */
static float turn_square(const float a[4], const float b[4]) {
    const float sign = dot(a, b) < 0.0f ? -1.0f : 1.0f;
    float square = 0.0f;
    for (int i = 0; i < 4; i++) {
        square += goe_flight_square(a[i] - sign * b[i]);
    }
    return 4.0f * square;
}

static float root_mean_deg(float integral, float time_s) {
    return time_s > 0.0f ? sqrtf(integral / time_s) * GOE_FLIGHT_DEG_PER_RAD : 0.0f;
}

static float rate_rms_deg_s(const goe_flight_history_t *h) {
    float turns = 0.0f; /* integral of the squared rate */
    float time_s = 0.0f;
    for (int back = 0; back + 1 < count_of(h, ATTITUDES); back++) {
        const goe_flight_history_attitude_t *newer = &h->attitude[place(h->attitude_next, back)];
        const goe_flight_history_attitude_t *older = &h->attitude[place(h->attitude_next, back + 1)];
        const float step_s = goe_flight_between_s(newer->time_us, older->time_us);
        turns += turn_square(newer->q, older->q) / step_s;
        time_s += step_s;
    }
    return root_mean_deg(turns, time_s);
}

/* rms of the rate's change with time, over the latest samples. The error of the interpolation follows it, not the change at the image:
 * three samples may lie on a line although the attitude between them does not. */
static float change_rms_deg_s2(const goe_flight_history_t *h) {
    float changes = 0.0f; /* integral of the square */
    float time_s = 0.0f;
    for (int back = 1; back + 1 < count_of(h, ATTITUDES) && back <= CHANGES; back++) {
        const goe_flight_history_attitude_t *from = &h->attitude[place(h->attitude_next, back)];
        const knot_t older = knot(h, back + 1, from);
        const knot_t middle = knot(h, back, from);
        const knot_t newer = knot(h, back - 1, from);
        if (newer.known && older.known) {
            const float between_s = 0.5f * (newer.at_s - older.at_s);
            float square = 0.0f;
            for (int i = 0; i < 4; i++) {
                square += goe_flight_square(bend(&older, &middle, &newer, i));
            }
            /* a bend is half of the change of slope, over the step; an angle is twice the vector of its quaternion */
            changes += square * goe_flight_square(4.0f / newer.at_s) * between_s;
            time_s += between_s;
        }
    }
    return root_mean_deg(changes, time_s);
}

/* Interpolates between two samples: by the cubic with slopes from the adjacent samples, by the parabola without one of these, by the
 * straight line without both. In a flight that pitches by 24 degrees a second, rms, with samples 200 ms apart, the line is off by half a
 * degree, the cubic by 0.1, the parabola by 0.26. */
static void blend_attitude(const goe_flight_history_t *h, const bracket_t *bracket, goe_flight_history_pose_t *pose) {
    const goe_flight_history_attitude_t *from = &h->attitude[place(h->attitude_next, bracket->older)];
    const knot_t before = knot(h, bracket->older + 1, from);
    const knot_t older = knot(h, bracket->older, from);
    const knot_t newer = knot(h, bracket->newer, from);
    const knot_t after = knot(h, bracket->newer - 1, from);
    const float f = bracket->share;
    const float step_s = newer.at_s;
    const bool between = step_s > 0.0f;
    for (int i = 0; i < 4; i++) {
        float first = between && before.known ? step_s * bend(&before, &older, &newer, i) : 0.0f;
        float last = between && after.known ? step_s * bend(&after, &newer, &older, i) : 0.0f;
        first = before.known ? first : -last;
        last = after.known ? last : -first;
        const float off = f * (1.0f - f) * ((1.0f - f) * first - f * last);
        pose->q[i] = older.q[i] + f * (newer.q[i] - older.q[i]) + off;
    }
    const float norm =
        sqrtf(dot(pose->q, pose->q)); /* neighbors are within half a turn: at least 0.7, apart from the bend */
    const bool usable = norm > NORM_MIN;
    for (int i = 0; i < 4; i++) {
        pose->q[i] = usable ? pose->q[i] / norm : older.q[i];
    }
    const float missed = before.known && after.known ? MISSED_BY_CUBIC : MISSED_BY_PARABOLA;
    const float bend_s2 = 0.5f * f * (1.0f - f) * step_s * step_s; /* error of a straight line by a rate change */
    pose->spread_deg = bend_s2 > 0.0f ? missed * bend_s2 * change_rms_deg_s2(h) : 0.0f;
}

goe_flight_status_t goe_flight_history_at(const goe_flight_history_t *history, uint32_t time_us,
                                          goe_flight_history_pose_t *pose) {
    bracket_t turn;
    bracket_t move;
    if (history->attitude_count == 0 || history->position_count == 0) {
        return GOE_FLIGHT_NO_POSE;
    }
    const goe_flight_status_t attitude = find(history, ATTITUDES, time_us, &turn);
    const goe_flight_status_t position = find(history, POSITIONS, time_us, &move);
    if (attitude != GOE_FLIGHT_OK || position != GOE_FLIGHT_OK) {
        return attitude < 0 || position < 0 ? GOE_FLIGHT_TOO_OLD : GOE_FLIGHT_TOO_NEW;
    }
    blend_attitude(history, &turn, pose);
    const float *older = history->position[place(history->position_next, move.older)].ned_m;
    const float *newer = history->position[place(history->position_next, move.newer)].ned_m;
    for (int i = 0; i < 3; i++) {
        pose->ned_m[i] = older[i] + move.share * (newer[i] - older[i]);
    }
    pose->rate_deg_s = rate_rms_deg_s(history);
    return GOE_FLIGHT_OK;
}
