/* Differences between times, in seconds. SPDX-License-Identifier: MIT */
#ifndef GOE_TIME_H
#define GOE_TIME_H

#include <stdint.h>

#define GOE_S_PER_US 1.0e-6f
#define GOE_TIME_MAX_US 4000000000u /* the longest time that any part distinguishes: 4000 s, which fits 32 bits */

/* Seconds from one time to a later one. A span longer than max_us counts as max_us. */
static inline float goe_time_between_s(int64_t from_us, int64_t to_us, uint32_t max_us) {
    const uint64_t span_us = (uint64_t)to_us - (uint64_t)from_us;
    return (float)(span_us < max_us ? (uint32_t)span_us : max_us) * GOE_S_PER_US;
}

#endif
