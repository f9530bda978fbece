/* The autopilot as its messages show it: identity, clock, pose, resets, heights. SPDX-License-Identifier: MIT */
#ifndef AUTOPILOT_H
#define AUTOPILOT_H

#include "clock_sync.h"
#include "companion_config.h"
#include "goe_flight.h"
#include "message_rates.h"
#include "wire.h"

#define AUTOPILOT_QUESTIONS 8 /* that are under way at most: a round trip of two seconds */

/* Samples are taken only from one autopilot: the first to send, or that of the configuration. */
typedef struct {
    const companion_config_t *config;
    goe_flight_t *flight;
    wire_t *wire;
    clock_sync_t clock;

    /* identity */
    uint8_t system; /* 0: none yet */
    uint8_t kind;   /* MAV_AUTOPILOT_... */
    uint32_t custom_mode;
    uint8_t base_mode;
    bool landing;   /* EXTENDED_SYS_STATE: on approach, in the flare or rolling ... */
    bool on_ground; /* ... or on the ground */
    bool flaring; /* ArduPlane's text of a landing: the flare has begun; until EXTENDED_SYS_STATE shows another state */
    int64_t recovered_us; /* own time when ArduPilot reported that it ended an avoidance by itself; 0: never */
    int32_t target_lat_e7, target_lon_e7; /* where it flies to, as it reports ... */
    unsigned targets;                     /* ... so many times */
    int64_t heartbeat_us;                 /* own time of the latest */
    unsigned heartbeats;                  /* counted */

    /* pose */
    mavlink_attitude_quaternion_t attitude;
    mavlink_local_position_ned_t position;
    bool has_attitude, has_position;
    unsigned reset_attitude, reset_horizontal, reset_vertical; /* marks for the flight layer */
    float reset_delta_ned_m[3];
    bool reset_delta_known;
    unsigned resets;       /* of all kinds, restarts included, for the log ... */
    bool last_reset_known; /* ... and whether the latest was a step by reset_delta_ned_m */
    int64_t jump_us;       /* own time of the latest jump that was found */
    int64_t report_us;     /* ... and of a reset reported by ODOMETRY that no jump has explained yet; 0: none */
    uint8_t odometry_resets;
    bool has_odometry_resets;
    int strange_times;                /* in a row, against the clock that is known */
    int64_t attitude_us, position_us; /* own times of the latest samples */

    /* down of the ground in the local frame by each source, with the autopilot's time of each */
    float range_finder_down_m, terrain_down_m, home_down_m;
    int64_t range_finder_us, terrain_us;
    bool has_range_finder, has_terrain, has_home;

    /* origin of the local frame */
    int32_t origin_lat_e7, origin_lon_e7;
    float origin_alt_m;
    bool has_origin;
    bool origin_given; /* ... to the flight layer */
    float home_alt_m;  /* over the sea */
    bool has_home_alt;

    int64_t question_us[AUTOPILOT_QUESTIONS]; /* own times of the latest questions for its clock, a ring ... */
    unsigned questions;                       /* ... with so many of them ever */
    bool answered;                            /* one was */
    message_rates_t rates;
    int64_t requested_us, origin_requested_us; /* own times of the latest requests */

    /* counters for summary and status line */
    unsigned long attitudes, positions, bad_samples, restarts, slips, jumps, strangers;
} autopilot_t;

void autopilot_init(autopilot_t *autopilot, const companion_config_t *config, goe_flight_t *flight, wire_t *wire);

/* Whether the latest bytes came from another address than the autopilot's, while the autopilot is not silent: then they are counted,
 * and no message of them may be used. */
bool autopilot_is_stranger(autopilot_t *autopilot, int64_t now_us);

/* Whether a message is of the autopilot that was found. */
bool autopilot_is_from(const autopilot_t *autopilot, const mavlink_message_t *message);

/* Any message; those that are not the autopilot's, or of no interest, are passed over. */
void autopilot_take(autopilot_t *autopilot, const mavlink_message_t *message, int64_t now_us);

/* Requests its clock, its rates and its origin, at their intervals. */
void autopilot_ask(autopilot_t *autopilot, int64_t now_us);

/* GOE_FLIGHT_FLYING, _APPROACH, _FLARE or _LANDED, for goe_flight_assess(). */
uint8_t autopilot_phase(const autopilot_t *autopilot);

/* Its clock now, us since its boot; 0 while not known. */
int64_t autopilot_clock_us(const autopilot_t *autopilot, int64_t now_us);

/* One sigma of that, us. */
double autopilot_clock_sd_us(const autopilot_t *autopilot);

/* "ArduPilot", "PX4" or "autopilot". */
const char *autopilot_kind_text(const autopilot_t *autopilot);

/* Heading of the latest attitude, degrees from north. */
float autopilot_heading_deg(const autopilot_t *autopilot);

#endif
