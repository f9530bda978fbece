/* Quality of the autopilot's position. SPDX-License-Identifier: MIT
 *
 *   GPS_RAW_INT                                          a lost fix, or missing messages
 *   EKF_STATUS_REPORT (ArduPilot), ESTIMATOR_STATUS (PX4)  flags, and test ratios of measurements
 *
 * A fault that lasts for 1 s makes the navigation suspect: it becomes a doubt. The doubts end after 5 s without a fault. */
#ifndef HEALTH_H
#define HEALTH_H

#include "wire.h"

/* Bits of faults. */
#define HEALTH_NO_FIX 0x1u     /* a fix was lost */
#define HEALTH_GPS_SILENT 0x2u /* GPS_RAW_INT no longer arrives */
#define HEALTH_FILTER 0x4u     /* the filter's attitude, velocity or position is bad, or not from measurements */
#define HEALTH_GLITCH 0x8u     /* the filter treats GPS as faulty */
#define HEALTH_OFF 0x10u       /* measurements differ greatly from the filter's prediction */

typedef struct {
    bool has_fix;                /* there was a fix */
    int64_t gps_us;              /* own time of the latest GPS_RAW_INT; 0: none yet */
    unsigned gps, filter;        /* faults in the latest message of GPS and filter */
    int64_t since_us, latest_us; /* own times of the first and of the latest of the present faults; 0: none */
    unsigned faults;             /* present faults */
    unsigned doubts;             /* faults that make the navigation suspect; 0: not suspect */
} health_t;

/* Processes a message of the autopilot. */
void health_take(health_t *health, const mavlink_message_t *message, int64_t now_us);

/* Updates faults and doubts; to be called often. Returns whether `doubts` has changed. */
bool health_judge(health_t *health, int64_t now_us);

/* To be called after a restart of the autopilot: deletes the faults of earlier messages. */
void health_restart(health_t *health);

/* Short text for the most severe of these faults; "good" for none. */
const char *health_text(unsigned faults);

#endif
