/* Spans of time. SPDX-License-Identifier: MIT */
#include "maths/goe_time.h"

#define S_PER_US 1.0e-6f

float goe_time_between_s(int64_t from_us, int64_t to_us, uint32_t most_us) {
    const uint64_t span_us = (uint64_t)to_us - (uint64_t)from_us;
    return (float)(span_us < most_us ? (uint32_t)span_us : most_us) * S_PER_US;
}
