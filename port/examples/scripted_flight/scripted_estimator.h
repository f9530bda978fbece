/* What the estimating thread of the ports' samples does with what their sensors send. SPDX-License-Identifier: MIT
 *
 * A sample brings threads, a queue, a clock and a printer. Its sensors send scripted_message() at each tick; one thread gives each
 * message to scripted_take(), and alone touches the estimator, so nothing needs a lock. */
#ifndef SCRIPTED_ESTIMATOR_H
#define SCRIPTED_ESTIMATOR_H

#include "scripted_flight.h"

#ifdef __cplusplus
extern "C" {
#endif

#define SCRIPTED_ASSESS_TICKS 5u /* from assessment to assessment, whether images come or not */

/* In the order in which they are sent at one tick. */
typedef enum { SCRIPTED_POSE, SCRIPTED_IMAGE, SCRIPTED_TIMER, SCRIPTED_END } scripted_kind_t;

typedef struct {
    scripted_kind_t kind;
    uint32_t tick;
    union {
        scripted_pose_t pose;
        scripted_image_t image;
    } of; /* nothing of a timer or the end */
} scripted_message_t;

/* The message of a kind at a tick, 0 to SCRIPTED_TICKS - 1; false: none. */
bool scripted_message(uint32_t tick, scripted_kind_t kind, scripted_message_t *message);

typedef uint32_t (*scripted_clock_t)(void); /* may wrap; any unit, of which durations are then */

typedef struct {
    uint32_t calls, sum, most; /* the durations' */
} scripted_cost_t;

typedef struct {
    goe_flight_t flight;
    goe_flight_assessment_t assessment;
    scripted_clock_t clock;
    scripted_cost_t frame;  /* of goe_flight_frame() for the images that it took */
    scripted_cost_t assess; /* of goe_flight_assess() */
    uint32_t dropped;       /* images that were refused, or overtaken while they waited */
    scripted_image_t image;
    bool image_waits;    /* for a pose that is newer than its exposure */
    bool reported_alive; /* as of the latest line: the detector, the action */
    goe_flight_action_t reported_action;
} scripted_estimator_t;

/* false: the settings are refused, and the line gives the reason. */
bool scripted_start(scripted_estimator_t *estimator, scripted_clock_t clock, char line[SCRIPTED_LINE]);

/* Takes a message. true: there is a line to print, one a second and one whenever the action changes or the detector falls silent or
 * comes back. */
bool scripted_take(scripted_estimator_t *estimator, const scripted_message_t *message, char line[SCRIPTED_LINE]);

/* "goe 0.4.0, self-check 0x00": the version compiled, and what goe_self_check() finds. */
void scripted_first_line(char line[SCRIPTED_LINE]);

/* Of scripted_cost_t: 0 without calls. */
uint32_t scripted_mean(const scripted_cost_t *cost);

#ifdef __cplusplus
}
#endif

#endif
