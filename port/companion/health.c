/* How sure the autopilot is of where it is. SPDX-License-Identifier: MIT */
#include "health.h"

#define SILENT_US 3000000      /* without GPS_RAW_INT, which is requested twice a second */
#define DOUBT_AFTER_US 1000000 /* a fault that lasts for so long is a doubt: a single message may be one of a moment */
#define GOOD_AFTER_US 5000000  /* ... which ends when none occurred for so long */
#define RATIO_MAX 1.0f         /* PX4: a measurement beyond it is refused by the filter */
#define VARIANCE_MAX 0.8f      /* ArduPilot: what its own documents call bad */

/* Of EKF_STATUS_REPORT: as ESTIMATOR_STATUS has them, but for these. */
#define EKF_UNINITIALIZED 1024u
#define EKF_GPS_GLITCHING 32768u
#define NEEDED (ESTIMATOR_ATTITUDE | ESTIMATOR_VELOCITY_HORIZ)
#define PLACED (ESTIMATOR_POS_HORIZ_REL | ESTIMATOR_POS_HORIZ_ABS)

static void take_gps(health_t *health, const mavlink_message_t *message, int64_t now_us) {
    const bool is_fix = mavlink_msg_gps_raw_int_get_fix_type(message) >= GPS_FIX_TYPE_3D_FIX;
    health->has_fix = health->has_fix || is_fix;
    health->gps = health->has_fix && !is_fix ? HEALTH_NO_FIX : 0u;
    health->gps_us = now_us;
}

static unsigned faults_of_flags(unsigned flags) {
    const bool is_good =
        (flags & NEEDED) == NEEDED && (flags & PLACED) != 0u && (flags & ESTIMATOR_CONST_POS_MODE) == 0u;
    return is_good ? 0u : HEALTH_FILTER;
}

/* NaN, which the filter has for what it does not measure, is no fault. */
static unsigned faults_of_ratios(const float *ratio, unsigned count, float most) {
    unsigned faults = 0;
    for (unsigned i = 0; i < count; i++) {
        faults |= ratio[i] > most ? HEALTH_OFF : 0u;
    }
    return faults;
}

static void take_estimator(health_t *health, const mavlink_message_t *message) {
    mavlink_estimator_status_t status;
    mavlink_msg_estimator_status_decode(message, &status);
    const float ratio[] = {status.vel_ratio, status.pos_horiz_ratio, status.pos_vert_ratio, status.mag_ratio};
    health->filter = faults_of_flags(status.flags) | faults_of_ratios(ratio, 4, RATIO_MAX) |
                     ((status.flags & ESTIMATOR_GPS_GLITCH) != 0 ? HEALTH_GLITCH : 0u) |
                     ((status.flags & ESTIMATOR_ACCEL_ERROR) != 0 ? HEALTH_FILTER : 0u);
}

static void take_ekf(health_t *health, const mavlink_message_t *message) {
    mavlink_ekf_status_report_t report;
    mavlink_msg_ekf_status_report_decode(message, &report);
    const float variance[] = {report.velocity_variance, report.pos_horiz_variance, report.pos_vert_variance,
                              report.compass_variance};
    health->filter = faults_of_flags(report.flags) | faults_of_ratios(variance, 4, VARIANCE_MAX) |
                     ((report.flags & EKF_GPS_GLITCHING) != 0 ? HEALTH_GLITCH : 0u) |
                     ((report.flags & EKF_UNINITIALIZED) != 0 ? HEALTH_FILTER : 0u);
}

void health_take(health_t *health, const mavlink_message_t *message, int64_t now_us) {
    switch (message->msgid) {
        case MAVLINK_MSG_ID_GPS_RAW_INT:
            take_gps(health, message, now_us);
            break;
        case MAVLINK_MSG_ID_ESTIMATOR_STATUS:
            take_estimator(health, message);
            break;
        case MAVLINK_MSG_ID_EKF_STATUS_REPORT:
            take_ekf(health, message);
            break;
        default:
            break;
    }
}

void health_restart(health_t *health) {
    health->has_fix = false;
    health->gps_us = 0;
    health->gps = health->filter = 0;
}

bool health_judge(health_t *health, int64_t now_us) {
    const bool is_silent = health->gps_us != 0 && now_us - health->gps_us > SILENT_US;
    const unsigned before = health->doubts;
    health->faults = health->gps | health->filter | (is_silent ? HEALTH_GPS_SILENT : 0u);
    if (health->faults != 0) {
        health->since_us = health->since_us != 0 ? health->since_us : now_us;
        health->latest_us = now_us;
        const bool lasts = now_us - health->since_us >= DOUBT_AFTER_US;
        health->doubts = lasts ? health->doubts | health->faults : health->doubts;
    } else {
        health->since_us = 0;
        health->doubts = now_us - health->latest_us >= GOOD_AFTER_US ? 0u : health->doubts;
    }
    return health->doubts != before;
}

const char *health_text(unsigned faults) {
    if ((faults & HEALTH_NO_FIX) != 0) {
        return "GPS fix lost";
    }
    if ((faults & HEALTH_GPS_SILENT) != 0) {
        return "GPS is silent";
    }
    if ((faults & HEALTH_FILTER) != 0) {
        return "filter is not good";
    }
    if ((faults & HEALTH_GLITCH) != 0) {
        return "filter takes GPS for faulty";
    }
    return (faults & HEALTH_OFF) != 0 ? "filter is far off its sensors" : "good";
}
