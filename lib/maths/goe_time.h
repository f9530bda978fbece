/* Spans of time. SPDX-License-Identifier: MIT */
#ifndef GOE_TIME_H
#define GOE_TIME_H

#include <stdint.h>

/* Seconds from one time to a later one; a span longer than most_us counts as that. */
float goe_time_between_s(int64_t from_us, int64_t to_us, uint32_t most_us);

#endif
