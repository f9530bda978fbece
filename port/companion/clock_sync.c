/* The autopilot's clock. SPDX-License-Identifier: MIT */
#include "clock_sync.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define BUCKET_US 10000000 /* two of them: clocks that drift by 50 ppm are off by 1 ms at most */
#define STRANGE_US 20000   /* beyond the round trips an offset may differ by this much */
#define STRANGE_MAX 3
#define DRIFT_SD_US 250.0 /* of 25 ppm over half of that time */
#define UNIFORM_SD                                                                                                     \
    0.28867513 /* of a uniform distribution, by its width: the way there may be any share of the round trip */
#define ROUND_MAX_US 1000000 /* a slower answer is useless */

void clock_sync_reset(clock_sync_t *sync) { (void)memset(sync, 0, sizeof *sync); }

static void begin(clock_sync_t *sync, int64_t now_us, int64_t offset_us, int64_t round_us) {
    clock_sync_reset(sync);
    sync->has = true;
    sync->bucket_us = now_us;
    sync->offset_us = offset_us;
    sync->round_us = round_us;
}

static void next_bucket(clock_sync_t *sync, int64_t now_us, int64_t offset_us, int64_t round_us) {
    sync->before_us = sync->offset_us;
    sync->round_before_us = sync->round_us;
    sync->has_before = now_us - sync->bucket_us < 2 * (int64_t)BUCKET_US;
    sync->bucket_us = now_us;
    sync->offset_us = offset_us;
    sync->round_us = round_us;
}

static bool use_before(const clock_sync_t *sync) {
    return sync->has_before &&
           (sync->two_way ? sync->round_before_us < sync->round_us : sync->before_us > sync->offset_us);
}

static int64_t offset(const clock_sync_t *sync) { return use_before(sync) ? sync->before_us : sync->offset_us; }
static int64_t round_trip(const clock_sync_t *sync) {
    return use_before(sync) ? sync->round_before_us : sync->round_us;
}

bool clock_sync_answer(clock_sync_t *sync, int64_t question_us, int64_t now_us, int64_t autopilot_us) {
    const int64_t round_us = now_us - question_us;
    const int64_t offset_us = autopilot_us - question_us - round_us / 2;
    if (round_us < 0 || round_us > ROUND_MAX_US) {
        return true;
    }
    if (!sync->two_way) {
        begin(sync, now_us, offset_us, round_us);
        sync->two_way = true;
        return true;
    }
    if (llabs(offset_us - offset(sync)) > (round_us + round_trip(sync)) / 2 + STRANGE_US) {
        sync->strange++;
        if (sync->strange >= STRANGE_MAX) {
            clock_sync_reset(sync);
            return false;
        }
        return true;
    }
    sync->strange = 0;
    if (now_us - sync->bucket_us > BUCKET_US) {
        next_bucket(sync, now_us, offset_us, round_us);
    } else if (round_us <= sync->round_us) {
        sync->offset_us = offset_us;
        sync->round_us = round_us;
    }
    return true;
}

void clock_sync_one_way(clock_sync_t *sync, int64_t now_us, int64_t autopilot_us) {
    const int64_t offset_us = autopilot_us - now_us;
    if (sync->two_way) {
        return;
    }
    if (!sync->has) {
        begin(sync, now_us, offset_us, 0);
    } else if (now_us - sync->bucket_us > BUCKET_US) {
        next_bucket(sync, now_us, offset_us, 0);
    } else if (offset_us > sync->offset_us) {
        sync->offset_us = offset_us;
    }
}

bool clock_sync_known(const clock_sync_t *sync) { return sync->has; }

int64_t clock_sync_autopilot_us(const clock_sync_t *sync, int64_t own_us) { return own_us + offset(sync); }

double clock_sync_sd_us(const clock_sync_t *sync, double one_way_sd_us) {
    const double way_sd_us = sync->two_way ? UNIFORM_SD * (double)round_trip(sync) : one_way_sd_us;
    return hypot(way_sd_us, DRIFT_SD_US);
}
