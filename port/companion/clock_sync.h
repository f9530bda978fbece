/* Offset of the autopilot's clock from the companion's. SPDX-License-Identifier: MIT
 *
 * Two-way: the answer to a TIMESYNC request contains the autopilot's time. The offset assumes that the request took half of the round
 * trip, and comes from the exchange with the shortest round trip of the last 10 to 20 s. One-way, until the first answer: the offset
 * comes from the message with the least (arrival - sending), because a message cannot arrive before it was sent. */
#ifndef CLOCK_SYNC_H
#define CLOCK_SYNC_H

#include <stdbool.h>
#include <stdint.h>

typedef struct {
    int64_t offset_us, before_us; /* autopilot's minus own time, from the best exchange of this and the last interval */
    int64_t round_us, round_before_us; /* round trips of these exchanges; one-way: 0 */
    int64_t bucket_us;                 /* own time at the start of this interval */
    int strange;                       /* exchanges in a row that contradict the offset */
    bool has, has_before;
    bool two_way; /* by TIMESYNC */
} clock_sync_t;

void clock_sync_reset(clock_sync_t *sync);

/* Processes an answer to a request.
 *   question_us, now_us  own times of the request and of the arrival of its answer
 *   autopilot_us         the autopilot's time in the answer
 * Returns false if the autopilot's clock has jumped: three answers in a row contradict the known offset, which is then deleted. */
bool clock_sync_answer(clock_sync_t *sync, int64_t question_us, int64_t now_us, int64_t autopilot_us);

/* Processes the time of any message of the autopilot. Does nothing after the first answer. */
void clock_sync_one_way(clock_sync_t *sync, int64_t now_us, int64_t autopilot_us);

/* Returns whether the offset is known: after the first answer or message. */
bool clock_sync_known(const clock_sync_t *sync);

/* Convert an own time to the autopilot's time, and return its one sigma.
 *   one_way_sd_us  one sigma of the link's delay, used without an answer */
int64_t clock_sync_autopilot_us(const clock_sync_t *sync, int64_t own_us);
double clock_sync_sd_us(const clock_sync_t *sync, double one_way_sd_us);

#endif
