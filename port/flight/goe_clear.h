/* How clear of every known obstacle an order is flown. SPDX-License-Identifier: MIT */
#ifndef GOE_FLIGHT_CLEAR_H
#define GOE_FLIGHT_CLEAR_H

#include "goe_flight.h"

/* The aircraft, and the frame of its course: x ahead, y right. */
typedef struct {
    float ned_m[3], course_ne[2];
    float turn_m;          /* radius of the avoiding turn */
    float early_m, late_m; /* way flown on the course until that turn begins: at the soonest, at the latest */
    float through_m;       /* flown on behind a target that is not circled */
    uint32_t time_us;
} goe_flight_clear_own_t;

/* What an order makes the aircraft fly: to a target, and about it. In the frame of the course. */
typedef struct {
    float target_m[2];
    float circle_m;  /* about the target; 0: the aircraft flies through, then along line_m */
    float line_m[2]; /* unit vector */
    float sigmas;    /* of every place, that are taken off its distance */
    bool shifts;     /* an autopilot may also leave the line at once and fly parallel to it to the target */
    bool turns_away; /* the target lies abeam or behind: the turn is the same from early_m and from late_m */
} goe_flight_clear_way_t;

/* Of one obstacle in the frame of the course. */
typedef struct {
    float at_m[2];
    float radius_m;       /* of its circle, with what its age adds */
    float margin_m;       /* wanted about that, with doubt; never 0 */
    float across_sd_m;    /* one sigma across the line of sight */
    float variance_m2[3]; /* ahead ahead, ahead right, right right */
    bool counts;          /* it has a place, and its top is not surely below the aircraft */
} goe_flight_clear_slot_t;

/* Into the frame of the course, of a place and of a direction. */
void goe_flight_clear_relate(const goe_flight_clear_own_t *own, const float place_ne_m[2], float at_m[2]);
void goe_flight_clear_direct(const goe_flight_clear_own_t *own, const float direction_ne[2], float turned[2]);

/* Whether an obstacle has a place, and its top is not surely below this height. */
bool goe_flight_clear_counts(const goe_flight_t *flight, int slot, float down_m);

/* Every slot in that frame. */
void goe_flight_clear_slots(const goe_flight_t *flight, const goe_flight_clear_own_t *own,
                            goe_flight_clear_slot_t slots[GOE_FLIGHT_SLOTS]);

/* The least distance of the way from any obstacle's circle, minus way->sigmas of its position, as a share of the wanted margin
 * there; at most GOE_FLIGHT_CLEAR_MAX. Negative: through one. *nearest: of which slot, -1 if there is none. A way found to be
 * below `enough` is not examined further. */
#define GOE_FLIGHT_CLEAR_MAX 2.0f
float goe_flight_clear_share(const goe_flight_clear_own_t *own, const goe_flight_clear_slot_t slots[GOE_FLIGHT_SLOTS],
                             const goe_flight_clear_way_t *way, float enough, int *nearest);

#endif
