/* Detects that a pilot or a failsafe has taken over during an order. SPDX-License-Identifier: MIT */
#include "mode_watch.h"

#include <math.h>
#include <string.h>

#define PLANE_AVOID_ADSB 14u
#define PLANE_RTL 11u
#define PLANE_LOITER 12u
#define BEATS_TO_LEAD 2u    /* heartbeats after the acknowledgement within which the mode follows */
#define BEATS_TO_EXPLAIN 2u /* heartbeats after AVOID_ADSB within which the autopilot's report of its end comes */
#define TARGET_OFF_M 20.0f  /* from there on a target is another's: far above rounding */
#define STRANGE_MAX 2u      /* such targets in a row */
#define M_PER_E7 0.0111195f /* of 1e-7 degrees on a sphere of 6371 km */
#define RAD_PER_E7 1.7453293e-9f

void mode_watch_begin(mode_watch_t *watch, const autopilot_t *autopilot, uint32_t mode_before) {
    (void)memset(watch, 0, sizeof *watch);
    watch->mode_before = mode_before;
    watch->judged_at = watch->answered_at = autopilot->heartbeats;
    watch->targets_at = autopilot->targets;
    watch->led = autopilot->custom_mode == PLANE_AVOID_ADSB;
    watch->avoided_us = autopilot->heartbeat_us;
}

void mode_watch_answered(mode_watch_t *watch, const autopilot_t *autopilot) {
    watch->answered_at = autopilot->heartbeats;
    watch->targets_at = autopilot->targets;
    watch->strange = 0;
    watch->matched = false;
}

/* By heartbeats: those that came after the acknowledgement show where the order has led, earlier ones may still show the mode before. */
static bool is_overruled_px4(mode_watch_t *watch, const autopilot_t *autopilot, bool unanswered, bool leads) {
    const uint32_t mode = autopilot->custom_mode;
    const bool is_late = !unanswered && autopilot->heartbeats - watch->answered_at > BEATS_TO_LEAD;
    if (mode == PX4_AUTO_LOITER) {
        watch->led = watch->led || leads;
        return false;
    }
    return mode != watch->mode_before || (leads && (watch->led || is_late));
}

/* AVD_F_RCVRY: ArduPlane reports the end of its avoidance also where a pilot has chosen a mode before. */
static bool is_of_recovery(const mode_watch_t *watch, uint32_t mode) {
    return mode == watch->mode_before || mode == PLANE_RTL || mode == PLANE_LOITER;
}

static bool is_overruled_plane(mode_watch_t *watch, const autopilot_t *autopilot) {
    if (autopilot->custom_mode == PLANE_AVOID_ADSB) {
        watch->led = true;
        watch->avoided_us = autopilot->heartbeat_us;
        watch->left_beats = 0;
        return false;
    }
    if (!watch->led) {
        return autopilot->custom_mode != watch->mode_before;
    }
    if (!is_of_recovery(watch, autopilot->custom_mode)) {
        return true;
    }
    if (autopilot->recovered_us != 0 && autopilot->recovered_us >= watch->avoided_us) { /* by itself: no choice */
        watch->led = false;
        watch->mode_before = autopilot->custom_mode;
        return false;
    }
    watch->left_beats++;
    return watch->left_beats >= BEATS_TO_EXPLAIN;
}

bool mode_watch_is_overruled(mode_watch_t *watch, const autopilot_t *autopilot, reaction_mode_t reaction,
                             bool unanswered, bool leads) {
    if (watch->judged_at == autopilot->heartbeats) {
        return false;
    }
    watch->judged_at = autopilot->heartbeats;
    return reaction == REACTION_PX4 ? is_overruled_px4(watch, autopilot, unanswered, leads)
                                    : is_overruled_plane(watch, autopilot);
}

float mode_watch_apart_m(int32_t lat_e7, int32_t lon_e7, int32_t other_lat_e7, int32_t other_lon_e7) {
    const float north_m = (float)((int64_t)lat_e7 - other_lat_e7) * M_PER_E7;
    const float east_m = (float)((int64_t)lon_e7 - other_lon_e7) * M_PER_E7 * cosf((float)lat_e7 * RAD_PER_E7);
    return hypotf(north_m, east_m);
}

bool mode_watch_is_target_another(mode_watch_t *watch, const autopilot_t *autopilot, int32_t lat_e7, int32_t lon_e7) {
    if (watch->targets_at == autopilot->targets || !watch->led) {
        return false;
    }
    watch->targets_at = autopilot->targets;
    const float off_m = mode_watch_apart_m(lat_e7, lon_e7, autopilot->target_lat_e7, autopilot->target_lon_e7);
    watch->matched = watch->matched || off_m <= TARGET_OFF_M;
    watch->strange = off_m > TARGET_OFF_M && watch->matched ? watch->strange + 1u : 0u;
    return watch->strange >= STRANGE_MAX;
}
