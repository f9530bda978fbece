/* Quality of the autopilot's position. SPDX-License-Identifier: MIT
 *
 *   GPS_RAW_INT                                          a fix that is lost, or messages that cease
 *   EKF_STATUS_REPORT (ArduPilot), ESTIMATOR_STATUS (PX4)  flags, and test ratios of measurements
 *
 * A fault that lasts is a doubt; a doubt ends after a while without a fault. */
#ifndef HEALTH_H
#define HEALTH_H

#include "wire.h"

/* Bits of faults. */
#define HEALTH_NO_FIX 0x1u     /* a fix was lost */
#define HEALTH_GPS_SILENT 0x2u /* GPS_RAW_INT came, and comes no more */
#define HEALTH_FILTER 0x4u     /* attitude, velocity or position of the filter is not good, or not from measurements */
#define HEALTH_GLITCH 0x8u     /* the filter takes GPS for faulty */
#define HEALTH_OFF 0x10u       /* measurements lie far off the filter's */

typedef struct {
    bool has_fix;                /* was one */
    int64_t gps_us;              /* own time of the latest GPS_RAW_INT; 0: none came */
    unsigned gps, filter;        /* faults by the latest message of each */
    int64_t since_us, latest_us; /* own times when the faults began, and of the latest; 0: none */
    unsigned faults;             /* now */
    unsigned doubts;             /* faults for which there is a doubt; 0: none */
} health_t;

/* A message of the autopilot's. */
void health_take(health_t *health, const mavlink_message_t *message, int64_t now_us);

/* To be called often. Returns whether `doubts` has changed. */
bool health_judge(health_t *health, int64_t now_us);

/* The autopilot has restarted: what it said before is no fault any more. */
void health_restart(health_t *health);

/* The gravest of these faults in a few words; "good" for none. */
const char *health_text(unsigned faults);

#endif
