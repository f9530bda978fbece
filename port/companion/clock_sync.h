/* The autopilot's clock against the companion's. SPDX-License-Identifier: MIT
 *
 * Two-way: TIMESYNC requests, the answer gives the autopilot's time; half of the round trip is taken as the way there, and the
 * fastest exchange of the last 10 to 20 s is used. One-way, until an answer came: poses cannot arrive before they were
 * sent, so the least of (arrival - sending). */
#ifndef CLOCK_SYNC_H
#define CLOCK_SYNC_H

#include <stdbool.h>
#include <stdint.h>

typedef struct {
    int64_t offset_us, before_us; /* autopilot's minus own, of the best exchange of this bucket and of the one before */
    int64_t round_us, round_before_us; /* round trips of these; one-way: 0 */
    int64_t bucket_us;                 /* own time when this bucket began */
    int strange;                       /* exchanges in a row that contradict it */
    bool has, has_before;
    bool two_way; /* by TIMESYNC */
} clock_sync_t;

void clock_sync_reset(clock_sync_t *sync);

/* An answer to a request that was sent at question_us and came back at now_us, own clock, from autopilot_us of its clock.
 * Returns false if the autopilot's clock has jumped: three answers in a row contradict the known offset, which is forgotten. */
bool clock_sync_answer(clock_sync_t *sync, int64_t question_us, int64_t now_us, int64_t autopilot_us);

/* A message of the autopilot's time arrived. Nothing once there was an answer. */
void clock_sync_one_way(clock_sync_t *sync, int64_t now_us, int64_t autopilot_us);

/* Nothing is known before the first of either. */
bool clock_sync_known(const clock_sync_t *sync);

/* Autopilot's time of an own one, and its one sigma; one_way_sd_us: replaces the link's delay where that is unknown. */
int64_t clock_sync_autopilot_us(const clock_sync_t *sync, int64_t own_us);
double clock_sync_sd_us(const clock_sync_t *sync, double one_way_sd_us);

#endif
