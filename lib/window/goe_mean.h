/* Sliding mean. SPDX-License-Identifier: MIT */
#ifndef GOE_MEAN_H
#define GOE_MEAN_H

#include "goe.h"

typedef struct {
    float mean;
    float variance; /* of the mean, from the spread of the values; 0 if there is one value */
} goe_average_t;

/* Adds a value, of which the newest `length` count, and returns the mean of those. */
/*@ requires \valid(mean) && 1 <= length <= GOE_WINDOW_MAX; */
goe_average_t goe_mean_add(goe_mean_t *mean, int length, float value);

#endif
