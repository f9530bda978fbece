/* Detects that a pilot or a failsafe has taken over during an order. SPDX-License-Identifier: MIT
 *
 * px4:        an order leads from the previous mode to Hold. Any other mode is a choice of the pilot's, or of a failsafe; after Hold
 *             was reached, so is the previous mode. In Hold another target than the order's is one.
 * arduplane:  the autopilot goes from the previous mode to AVOID_ADSB and back, and reports by STATUSTEXT when it goes back by itself.
 *             Any other change is a choice. */
#ifndef MODE_WATCH_H
#define MODE_WATCH_H

#include "autopilot.h"
#include "companion_config.h"

/* PX4's custom mode: main mode in the third byte, sub mode in the fourth. */
#define PX4_MODE(main, sub) ((uint32_t)(main) << 16 | (uint32_t)(sub) << 24)
#define PX4_MAIN(mode) ((mode) >> 16 & 0xFFu)
#define PX4_SUB(mode) ((mode) >> 24 & 0xFFu)
#define PX4_AUTO_LOITER PX4_MODE(4, 3) /* Hold, where DO_REPOSITION leads to */

typedef struct {
    uint32_t mode_before; /* in which the order was given */
    unsigned judged_at;   /* count of heartbeats by which the mode was looked at last */
    unsigned answered_at; /* ... when the command was acknowledged */
    bool led;             /* the mode of the order was reached */
    int64_t avoided_us;   /* arduplane: own time of the latest heartbeat in AVOID_ADSB ... */
    unsigned left_beats;  /* ... and heartbeats in another mode since */
    unsigned targets_at;  /* px4: count of targets that were looked at ... */
    unsigned strange;     /* ... and how many in a row were another's ... */
    bool matched;         /* ... after one that was the order's: a target that a fence refuses never is */
} mode_watch_t;

/* With a first order: the mode before is the present one, or `mode_before` if that is older. */
void mode_watch_begin(mode_watch_t *watch, const autopilot_t *autopilot, uint32_t mode_before);

/* The order's command was acknowledged. */
void mode_watch_answered(mode_watch_t *watch, const autopilot_t *autopilot);

/* Whether the pilot has chosen another mode.
 *   unanswered   a command of the order's is: the mode before may still be shown
 *   leads        the order leads to another mode: not one to go around */
bool mode_watch_is_overruled(mode_watch_t *watch, const autopilot_t *autopilot, reaction_mode_t reaction,
                             bool unanswered, bool leads);

/* px4: whether the autopilot flies to another place than the one that was sent. */
bool mode_watch_is_target_another(mode_watch_t *watch, const autopilot_t *autopilot, int32_t lat_e7, int32_t lon_e7);

/* Distance of two places that are near each other, m. */
float mode_watch_apart_m(int32_t lat_e7, int32_t lon_e7, int32_t other_lat_e7, int32_t other_lon_e7);

#endif
