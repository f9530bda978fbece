/* Clear fraction of an order's path. README.md defines the terms. SPDX-License-Identifier: MIT */
#ifndef GOE_FLIGHT_CLEAR_H
#define GOE_FLIGHT_CLEAR_H

#include "goe_flight.h"

#define GOE_FLIGHT_CLEAR_MARGIN_MIN_M 1.0f /* fractions of a smaller margin would say nothing */

/* The aircraft, and the frame of its course: x ahead, y right. */
typedef struct {
    float ned_m[3], course_ne[2];
    float turn_m;          /* radius of the avoiding turn */
    float early_m, late_m; /* least and greatest distance flown on the course until the turn begins */
    float through_m;       /* distance flown beyond a target that is not circled */
    uint32_t time_us;
} goe_flight_clear_own_t;

/* The path of an order: to a target, and around it. In the frame of the course. */
typedef struct {
    float target_m[2];
    float circle_m;  /* radius of the circle around the target; 0: no circle, the aircraft flies on along line_m */
    float line_m[2]; /* unit vector */
    float sigmas;    /* number of sigmas of an obstacle's position that are subtracted from its distance */
    bool shifts;     /* an autopilot may also leave the line at once, and fly parallel to it to the target */
    bool turns_away; /* the target is abeam or behind: the turn is the same from early_m and from late_m */
} goe_flight_clear_way_t;

/* One obstacle in the frame of the course. */
typedef struct {
    float at_m[2];
    float radius_m;       /* radius of its circle, including the growth with its age */
    float margin_m;       /* wanted distance to the circle, wider if the estimate is suspect; never 0 */
    float across_sd_m;    /* one sigma across the line of sight */
    float variance_m2[3]; /* covariance: ahead ahead, ahead right, right right */
    bool counts;          /* it has a position, and the aircraft does not clear its top at two sigma */
} goe_flight_clear_slot_t;

/* Convert a position and a direction to the frame of the course. */
void goe_flight_clear_relate(const goe_flight_clear_own_t *own, const float place_ne_m[2], float at_m[2]);
void goe_flight_clear_direct(const goe_flight_clear_own_t *own, const float direction_ne[2], float turned[2]);

/* Returns whether an obstacle has a position, and this height does not clear its top at two sigma. */
bool goe_flight_clear_counts(const goe_flight_t *flight, int slot, float down_m);

/* Converts every slot to the frame of the course. */
void goe_flight_clear_slots(const goe_flight_t *flight, const goe_flight_clear_own_t *own,
                            goe_flight_clear_slot_t slots[GOE_FLIGHT_SLOTS]);

/* Returns the clear fraction of a path: its least distance to an obstacle's circle, minus way->sigmas of the obstacle's position, as a
 * fraction of the margin; at most GOE_FLIGHT_CLEAR_MAX, negative inside a circle.
 *   enough   when the fraction falls below this value, the search ends
 *   nearest  receives the slot of that obstacle, -1 if there is none */
#define GOE_FLIGHT_CLEAR_MAX 2.0f
float goe_flight_clear_share(const goe_flight_clear_own_t *own, const goe_flight_clear_slot_t slots[GOE_FLIGHT_SLOTS],
                             const goe_flight_clear_way_t *way, float enough, int *nearest);

#endif
