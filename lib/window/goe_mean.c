/* Sliding mean of a value, and its variance. SPDX-License-Identifier: MIT */
#include "window/goe_mean.h"

#if GOE_WITH_WINDOW

/* Summed again each time, because a running sum would collect rounding errors over a long track. */
goe_average_t goe_mean_add(goe_mean_t *mean, int length, float value) {
    const int at = mean->next >= 0 && mean->next < length ? mean->next : 0;
    const int before = mean->count > 0 ? mean->count : 0;
    const int n = before < length ? before + 1 : length;
    float sum = 0.0f;
    float squares = 0.0f;
    mean->value[at] = value;
    mean->next = (int16_t)(at + 1 < length ? at + 1 : 0);
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
