/* The companion: its memory, and the handling of its inputs. SPDX-License-Identifier: MIT
 *
 *   companion_turn()   reads links > autopilot, images > flight layer > assessment > orders, reports, log, status line
 *
 * One thread, no locks; it waits only in poll(). */
#ifndef COMPANION_H
#define COMPANION_H

#include "autopilot.h"
#include "box_check.h"
#include "companion_config.h"
#include "detection_text.h"
#include "flight_record.h"
#include "goe_flight.h"
#include "health.h"
#include "image_queue.h"
#include "line_reader.h"
#include "link.h"
#include "orders.h"
#include "reports.h"
#include "screen.h"
#include "signing.h"
#include "wire.h"

typedef struct {
    unsigned long images;    /* accepted images */
    unsigned long late;      /* frames that came too late or had no pose */
    unsigned long unread;    /* invalid lines and messages */
    unsigned long clockless; /* lines and images that came before the autopilot's clock was known */
    unsigned long classless; /* detections of a class whose size is not known */
} companion_counts_t;

/* Boxes with one fault. */
typedef struct {
    unsigned long boxes;
    int64_t reported_us; /* own time of the latest report; 0: none */
} box_faults_t;

/* Rates and delays of the latest second. */
typedef struct {
    unsigned long attitudes, positions, images; /* counts at the start of the second */
    double pose_hz, image_hz; /* rates of the second; pose_hz: the lower one of attitude and position */
    delay_count_t delay, delay_shown;
    uint32_t capture_us[GOE_CAMERAS_MAX]; /* capture time of each camera's latest image */
} companion_rates_t;

typedef struct {
    companion_config_t config;
    goe_flight_t flight;
    goe_flight_assessment_t assessment;       /* the latest one that did not fail; pose_alive is false since one did */
    link_t *autopilot_link, *detections_link; /* detections_link is null if detections come over MAVLink only */
    wire_t wire;
    signing_t signing;
    autopilot_t autopilot;
    line_reader_t lines;
    image_queue_t queue;
    camera_image_t image; /* image that is being read */
    orders_t orders;
    health_t health;
    screen_t screen;
    goe_flight_action_t advised; /* action that was shown last while reactions are off */
    double turn_m; /* radius of the widest turn that was reported as wider than flight.loiter_m; 0: none */
    flight_record_t record;
    companion_counts_t counts;
    box_faults_t box_faults[BOX_FAULTS];
    companion_rates_t rates;
    unsigned self_check;
    bool detector_alive, pose_alive; /* values that were reported last */
    unsigned links_lost;             /* number of lost links that was reported last */
    unsigned long restarts;          /* number of the autopilot's restarts that was processed last */
    int64_t assessed_us, reported_us, second_us, begun_us;
    bool deafness_reported;
    int64_t clock_difference_us; /* latest difference of UNIX time and monotonic time */
} companion_t;

/* Opens links and log. Null on failure: fault gives the reason. */
companion_t *companion_new(const companion_config_t *config, char *fault, size_t fault_size);

/* Waits for input, at most until the next due work, and handles it. Returns true once a second: time for a status line. */
bool companion_turn(companion_t *companion);

/* Null is ignored. */
void companion_free(companion_t *companion);

#endif
