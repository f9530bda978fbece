/* Reads the companion's configuration. SPDX-License-Identifier: MIT */
#ifndef COMPANION_CONFIG_H
#define COMPANION_CONFIG_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "goe_flight.h"
#include "input_error.h"
#include "key_file.h"

#define CONFIG_TEXT_MAX 512

/* Clock of a detection's time, if its line does not name one. */
typedef enum { LINE_CLOCK_UNIX, LINE_CLOCK_MONOTONIC, LINE_CLOCK_AGE, LINE_CLOCK_AUTOPILOT } line_clock_t;

typedef enum { REACTION_OFF, REACTION_PX4, REACTION_ARDUPLANE } reaction_mode_t;

/* Bits of detections_mavlink. */
#define DETECTIONS_GOE_FEATURES 0x01u
#define DETECTIONS_LANDING_TARGET 0x02u
#define DETECTIONS_TRACKING 0x04u

/* Bits of reports_standard. */
#define REPORT_OBSTACLE_DISTANCE 0x01u
#define REPORT_OBSTACLE_DISTANCE_3D 0x02u
#define REPORT_COLLISION 0x04u
#define REPORT_TARGET_ABSOLUTE 0x08u

/* One field per key; companion.ini gives the meaning, unit and default of each. */
typedef struct {
    char link_autopilot[CONFIG_TEXT_MAX];
    uint32_t link_system, link_component, link_request_rates;
    double link_attitude_hz, link_position_hz;
    char link_key_file[CONFIG_TEXT_MAX]; /* path, no longer relative to the configuration; empty: no signatures */
    uint8_t link_key[KEY_BYTES];
    char detections_from[CONFIG_TEXT_MAX];
    line_clock_t detections_clock;
    unsigned detections_mavlink; /* DETECTIONS_... */
    double detections_delay_s, detections_delay_sd_s;
    uint32_t detections_shares_clock;
    char detections_classes[CONFIG_TEXT_MAX];     /* names with single blanks around each; empty: all */
    char detections_class_names[CONFIG_TEXT_MAX]; /* of the numbers 0, 1, ... */
    char camera_file[CONFIG_TEXT_MAX];            /* path, no longer relative to the configuration */
    goe_settings_t estimator;                     /* camera included */
    goe_flight_settings_t flight;
    reaction_mode_t reaction_mode;
    unsigned reaction_modes; /* px4: bits of mission, hold, offboard, position, altitude, rtl, land, takeoff */
    uint32_t reaction_resume, reaction_icao;
    double reaction_adsb_hz;
    double reports_assess_hz, reports_obstacle_hz;
    unsigned reports_standard; /* REPORT_... */
    uint32_t reports_screen;
    uint32_t reports_distance_increment_deg;
    double reports_distance_max_m;
    char record_folder[CONFIG_TEXT_MAX]; /* empty: no log */
    double record_size_max_mb;
} companion_config_t;

/* Reads the file, and those of the camera and the key that it names.
 *   link  null, or the replacement of link.autopilot
 * False on failure: *error gives the reason and the position. */
bool companion_config_read(const char *path, const char *link, companion_config_t *config, input_error_t *error);

/* All keys with their values, as the file would have them. */
void companion_config_print(FILE *stream, const companion_config_t *config);

#endif
