/* Capture time of an image by the autopilot's clock. SPDX-License-Identifier: MIT
 *
 * One-way messages: a message cannot arrive before it was sent. The least of (arrival - sending) is therefore the offset of the clocks plus
 * the least delay of the link, which only settings.delay_s gives. It is the least of two buckets of 10 s: a clock that drifts by 50 ppm is
 * off by 1 ms at most. */
#include "goe_clock.h"

#include <math.h>

#include "goe_flight_maths.h"

#define BUCKET_US 10000000
#define STRANGE_US 1000000 /* an arrival so far from the least is of another clock, or a stuck message */
#define STRANGE_MAX 3
#define STRANGE_MIN_US 200000.0f /* least time from the first to the last of them */
#define ALIKE_US 20000.0f        /* largest difference of the offsets of another clock on a link without jitter */
#define SPREADS 3.0f             /* by which it is larger on a link with jitter: number of mean excesses */
#define LONGER 4.0f              /* by which the time that has passed must exceed it */
#define FORGOTTEN_US                                                                                                   \
    100000000     /* of a clock that drifts by 50 ppm, an offset of so long ago is off by 5 ms, as much as delay_sd_s */
#define SETTLED 8 /* number of messages after which the least is close to its final value */
#define SPREAD_MEMORY 16.0f /* number of messages */
#define DRIFT_SD_US 1000.0f
#define SD_MAX_US 1.0e6f

static uint32_t microseconds(float s) { return (uint32_t)(s * 1.0e6f + 0.5f); }

static void begin(goe_flight_clock_t *clock, uint32_t offset_us, uint32_t arrival_us) {
    clock->offset_us = offset_us;
    clock->bucket_us = arrival_us;
    clock->excess_us = 0.0f;
    clock->count = 0;
    clock->strange = 0;
    clock->has_before = false;
}

/* Counts an arrival that is late by more than a second. Those of a clock that was set back are late by the same time, apart from the jitter
 * of the link. Messages that were stuck, and the parts of one image, arrive faster than they were sent: each is less late than the one
 * before. The time that has passed must therefore be much longer than what the offsets may differ by. */
static bool is_another_clock(goe_flight_clock_t *clock, uint32_t offset_us, uint32_t arrival_us) {
    const float alike_us = ALIKE_US + SPREADS * clock->excess_us;
    const int32_t apart_us = goe_flight_between_us(offset_us, clock->strange_offset_us);
    if (clock->strange == 0 || goe_flight_absolute((float)apart_us) > alike_us) {
        clock->strange_offset_us = offset_us;
        clock->strange_us = arrival_us;
        clock->strange = 0;
    }
    clock->strange = (uint8_t)(clock->strange < UINT8_MAX ? clock->strange + 1 : UINT8_MAX);
    const int32_t passed_us = goe_flight_between_us(arrival_us, clock->strange_us);
    return clock->strange >= STRANGE_MAX && (float)passed_us >= goe_flight_larger(STRANGE_MIN_US, LONGER * alike_us);
}

static void learn(goe_flight_clock_t *clock, uint32_t offset_us, uint32_t arrival_us) {
    const int32_t above_us = goe_flight_between_us(offset_us, clock->offset_us);
    if (clock->count == 0 || above_us < -STRANGE_US) {
        begin(clock, offset_us, arrival_us);
    } else if (above_us > STRANGE_US) {
        if (is_another_clock(clock, offset_us, arrival_us)) {
            begin(clock, offset_us, arrival_us);
        }
        return;
    } else if (goe_flight_between_us(arrival_us, clock->bucket_us) > BUCKET_US) {
        clock->before_us = clock->offset_us;
        clock->has_before = true;
        clock->offset_us = offset_us;
        clock->bucket_us = arrival_us;
    } else if (above_us < 0) {
        clock->offset_us = offset_us;
    }
    clock->strange = 0;
    clock->count = (uint8_t)(clock->count < UINT8_MAX ? clock->count + 1 : UINT8_MAX);
}

static uint32_t least(const goe_flight_clock_t *clock) {
    const bool before = clock->has_before && goe_flight_between_us(clock->before_us, clock->offset_us) < 0;
    return before ? clock->before_us : clock->offset_us;
}

/* Mean excess of arrivals over the least. While few have come, the least may exceed the truth by as much. */
static void follow_spread(goe_flight_clock_t *clock, uint32_t offset_us) {
    const int32_t above_us = goe_flight_between_us(offset_us, least(clock));
    const float excess_us = goe_flight_clamped((float)above_us, 0.0f, (float)STRANGE_US);
    const float share = 1.0f / goe_flight_smaller((float)clock->count, SPREAD_MEMORY);
    clock->excess_us += share * (excess_us - clock->excess_us);
}

static uint32_t offset_of(goe_flight_clock_t *clock, const goe_flight_frame_t *frame,
                          const goe_flight_settings_t *settings, float *sd_us) {
    const uint32_t offset_us = frame->arrival_us - frame->sent_us;
    if (clock->synced) {
        *sd_us = clock->synced_sd_us;
        return clock->offset_us;
    }
    learn(clock, offset_us, frame->arrival_us);
    if (clock->count > 0 && clock->strange == 0) {
        follow_spread(clock, offset_us);
    }
    const float unsettled_us = clock->count < SETTLED ? clock->excess_us : 0.0f;
    *sd_us = sqrtf(goe_flight_square(settings->delay_sd_s * 1.0e6f) + DRIFT_SD_US * DRIFT_SD_US +
                   unsettled_us * unsettled_us);
    return least(clock) - microseconds(settings->delay_s);
}

static uint32_t rounded_sd(float sd_us) { return (uint32_t)(goe_flight_smaller(sd_us, SD_MAX_US) + 0.5f); }

uint32_t goe_flight_clock_capture(goe_flight_clock_t *clock, const goe_flight_frame_t *frame,
                                  const goe_flight_settings_t *settings, uint32_t *sd_us) {
    const uint32_t delay_sd_us = microseconds(settings->delay_sd_s);
    float clock_sd_us = 0.0f;
    uint32_t capture_us = frame->capture_us;
    if (frame->time_base == GOE_FLIGHT_SENDER_CLOCK) {
        capture_us += offset_of(clock, frame, settings, &clock_sd_us);
    } else if (frame->time_base == GOE_FLIGHT_AGE) {
        capture_us = frame->arrival_us - microseconds(settings->delay_s) - frame->capture_us;
        clock_sd_us = (float)delay_sd_us;
    }
    const bool stated = frame->time_sd_us > 0u;
    const float own_sd_us = (float)(stated || clock_sd_us > 0.0f ? frame->time_sd_us : delay_sd_us);
    *sd_us = rounded_sd(sqrtf(own_sd_us * own_sd_us + clock_sd_us * clock_sd_us));
    return capture_us;
}

void goe_flight_clock_sync(goe_flight_clock_t *clock, uint32_t offset_us, uint32_t sd_us) {
    memset(clock, 0, sizeof *clock);
    clock->synced = sd_us != UINT32_MAX;
    clock->offset_us = offset_us;
    clock->synced_sd_us = goe_flight_smaller((float)sd_us, SD_MAX_US);
}

void goe_flight_clock_bury(goe_flight_clock_t *clock, uint32_t now_us) {
    if (!clock->synced && clock->count > 0 && goe_flight_between_us(now_us, clock->bucket_us) > FORGOTTEN_US) {
        memset(clock, 0, sizeof *clock);
    }
}
