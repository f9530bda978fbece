/* Sliding mean of a value, and its variance. SPDX-License-Identifier: MIT */
#ifndef GOE_MEAN_H
#define GOE_MEAN_H

#include "goe.h"

typedef struct {
    float mean;
    float variance; /* of the mean, from the spread of the values; 0 for one value */
} goe_average_t;

/* Adds a value, and returns the mean of the newest `length` values. */
/*@ requires \valid(mean) && 1 <= length <= GOE_WINDOW_MAX; */
goe_average_t goe_mean_add(goe_mean_t *mean, int length, float value);

#endif
