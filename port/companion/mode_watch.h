/* Detects that a pilot or a failsafe has taken over during an order. SPDX-License-Identifier: MIT
 *
 * px4:        an order leads from the previous mode to Hold. Any other mode is a choice of the pilot or of a failsafe. After Hold was
 *             reached, or if it is not reached in time, the previous mode is also a choice. In Hold, so is a target other than the
 *             order's.
 * arduplane:  the autopilot changes from the previous mode to AVOID_ADSB and back, and reports by STATUSTEXT when it changes back by
 *             itself. Any other change is a choice. */
#ifndef MODE_WATCH_H
#define MODE_WATCH_H

#include "autopilot.h"
#include "companion_config.h"

/* PX4's custom mode: main mode in the third byte, sub mode in the fourth. */
#define PX4_MODE(main, sub) ((uint32_t)(main) << 16 | (uint32_t)(sub) << 24)
#define PX4_MAIN(mode) ((mode) >> 16 & 0xFFu)
#define PX4_SUB(mode) ((mode) >> 24 & 0xFFu)
#define PX4_AUTO_LOITER PX4_MODE(4, 3) /* Hold, the mode after DO_REPOSITION */

typedef struct {
    uint32_t mode_before; /* mode before the order */
    unsigned judged_at;   /* count of heartbeats when the mode was last checked */
    unsigned answered_at; /* count of heartbeats when the command was acknowledged */
    bool led;             /* the mode of the order was reached */
    int64_t avoided_us;   /* arduplane: own time of the latest heartbeat in AVOID_ADSB */
    unsigned left_beats;  /* arduplane: heartbeats in another mode since then */
    unsigned targets_at;  /* px4: count of reported targets when they were last checked */
    unsigned strange;     /* px4: reported targets in a row that are not the order's, after one that was */
    bool matched;         /* px4: a reported target was the order's; false e.g. if the geofence refused the target */
} mode_watch_t;

/* Starts the watch with an order that was given in `mode_before`. */
void mode_watch_begin(mode_watch_t *watch, const autopilot_t *autopilot, uint32_t mode_before);

/* To be called when the order's command was acknowledged. */
void mode_watch_answered(mode_watch_t *watch, const autopilot_t *autopilot);

/* Returns whether the pilot has chosen another mode.
 *   unanswered   a command of the order is not acknowledged yet: the previous mode may still be shown
 *   leads        the order leads to another mode; false for a go-around */
bool mode_watch_is_overruled(mode_watch_t *watch, const autopilot_t *autopilot, reaction_mode_t reaction,
                             bool unanswered, bool leads);

/* px4: returns whether the autopilot flies to another target than the order's. */
bool mode_watch_is_target_another(mode_watch_t *watch, const autopilot_t *autopilot, int32_t lat_e7, int32_t lon_e7);

/* Distance of two nearby places, m. */
float mode_watch_apart_m(int32_t lat_e7, int32_t lon_e7, int32_t other_lat_e7, int32_t other_lon_e7);

#endif
