/* Sliding mean. SPDX-License-Identifier: MIT */
#include "window/goe_mean.h"

#if GOE_WITH_WINDOW

/* Summed anew each time: a running sum would collect rounding errors over a long track. */
goe_average_t goe_mean_add(goe_mean_t *mean, int length, float value) {
    const int n = mean->count < length ? mean->count + 1 : length;
    float sum = 0.0f;
    float squares = 0.0f;
    mean->value[mean->next] = value;
    mean->next = (int16_t)(mean->next + 1 < length ? mean->next + 1 : 0);
    mean->count = (int16_t)n;
    for (int k = 0; k < n; k++) {
        sum += mean->value[k];
    }
    const float average = sum / (float)n;
    for (int k = 0; k < n; k++) {
        const float off = mean->value[k] - average;
        squares += off * off;
    }
    const goe_average_t result = {average, n > 1 ? squares / (float)((n - 1) * n) : 0.0f};
    return result;
}

#endif
