/* Sliding mean. SPDX-License-Identifier: MIT */
#include "goe_mean.h"

goe_average_t goe_mean_add(goe_mean_t *mean, int length, float value) {
    goe_average_t average = {0.0f, 0.0f};
    mean->value[mean->next] = value;
    mean->next = (int16_t)(mean->next + 1 < length ? mean->next + 1 : 0);
    mean->count = (int16_t)(mean->count < length ? mean->count + 1 : length);
    const int n = mean->count;
    const float *end = mean->value + n;
    float sum = 0.0f;
    float squares = 0.0f;
    /* summed anew each time: a running sum would collect rounding errors over a long track */
    for (const float *v = mean->value; v != end; v++) {
        sum += *v;
    }
    average.mean = sum / (float)n;
    for (const float *v = mean->value; v != end; v++) {
        const float off = *v - average.mean;
        squares += off * off;
    }
    average.variance = n > 1 ? squares / (float)((n - 1) * n) : 0.0f;
    return average;
}
