/* State of the autopilot from its messages: identity, clock, pose, resets, heights. "Own time" is the companion's monotonic clock.
 * SPDX-License-Identifier: MIT */
#ifndef AUTOPILOT_H
#define AUTOPILOT_H

#include "clock_sync.h"
#include "companion_config.h"
#include "goe_flight.h"
#include "message_rates.h"
#include "wire.h"

#define AUTOPILOT_QUESTIONS 8 /* latest TIMESYNC requests whose answers are accepted: those of two seconds */

/* Samples come from one autopilot only: the first that sends, or the configured one. */
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
    uint8_t system_status; /* MAV_STATE_... */
    bool landing;          /* EXTENDED_SYS_STATE: landing (approach, flare or roll-out) */
    bool on_ground;        /* EXTENDED_SYS_STATE: on the ground */
    bool flaring;         /* ArduPlane's text reported the flare; cleared when EXTENDED_SYS_STATE shows another state */
    int64_t recovered_us; /* own time when ArduPilot reported that it ended an avoidance by itself; 0: never */
    int32_t target_lat_e7, target_lon_e7; /* target position that the autopilot reports */
    unsigned targets;                     /* number of these reports */
    int64_t heartbeat_us;                 /* own time of the latest heartbeat */
    unsigned heartbeats;                  /* number of heartbeats */

    /* pose */
    mavlink_attitude_quaternion_t attitude;
    mavlink_local_position_ned_t position;
    bool has_attitude, has_position;
    unsigned reset_attitude, reset_horizontal, reset_vertical; /* marks for the flight layer */
    float reset_delta_ned_m[3];
    bool reset_delta_known;
    unsigned resets;       /* resets of all kinds and restarts, for the log */
    bool last_reset_known; /* the latest reset was a step by reset_delta_ned_m */
    int64_t jump_us;       /* own time of the latest detected jump; 0: none */
    int64_t report_us;     /* own time of a reset that ODOMETRY reported and that no jump explains yet; 0: none */
    uint8_t odometry_resets;
    bool has_odometry_resets;
    int strange_times;                /* samples in a row whose time contradicts the known clock */
    int64_t attitude_us, position_us; /* own times of the latest samples */

    /* down coordinate of the ground in the local frame from each source, with its time by the autopilot's clock */
    float range_finder_down_m, terrain_down_m, home_down_m;
    int64_t range_finder_us, terrain_us;
    bool has_range_finder, has_terrain, has_home;

    /* origin of the local frame */
    int32_t origin_lat_e7, origin_lon_e7;
    float origin_alt_m;
    bool has_origin;
    bool origin_given; /* the flight layer has the origin */
    float home_alt_m;  /* altitude above sea level */
    bool has_home_alt;

    int64_t question_us[AUTOPILOT_QUESTIONS]; /* own times of the latest TIMESYNC requests, a ring */
    unsigned questions;                       /* number of requests since the start */
    bool answered;                            /* a request was answered */
    message_rates_t rates;
    int64_t requested_us, origin_requested_us; /* own times of the latest requests */

    /* counters for summary and status line */
    unsigned long attitudes, positions, bad_samples, restarts, slips, jumps, strangers;
} autopilot_t;

void autopilot_init(autopilot_t *autopilot, const companion_config_t *config, goe_flight_t *flight, wire_t *wire);

/* Returns whether the latest bytes came from another address than the autopilot's while the autopilot is not silent. Such a message is
 * counted and must not be used. */
bool autopilot_is_stranger(autopilot_t *autopilot, int64_t now_us);

/* Returns whether a message is from this autopilot. */
bool autopilot_is_from(const autopilot_t *autopilot, const mavlink_message_t *message);

/* Processes a message; ignores messages of other senders and of other kinds. */
void autopilot_take(autopilot_t *autopilot, const mavlink_message_t *message, int64_t now_us);

/* Sends the due requests for the autopilot's time, message rates and origin. */
void autopilot_ask(autopilot_t *autopilot, int64_t now_us);

/* GOE_FLIGHT_FLYING, _APPROACH, _FLARE or _LANDED, for goe_flight_assess(). */
uint8_t autopilot_phase(const autopilot_t *autopilot);

/* Present time of the autopilot's clock, us since its boot; 0 while not known. */
int64_t autopilot_clock_us(const autopilot_t *autopilot, int64_t now_us);

/* One sigma of this time, us. */
double autopilot_clock_sd_us(const autopilot_t *autopilot);

/* "ArduPilot", "PX4" or "autopilot". */
const char *autopilot_kind_text(const autopilot_t *autopilot);

/* Heading of the latest attitude, degrees from north. */
float autopilot_heading_deg(const autopilot_t *autopilot);

#endif
