/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "text_numbers.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool text_numbers(const char *text, const char *prefix, double *values, int count) {
    const size_t length = strlen(prefix);
    if (strncmp(text, prefix, length) != 0) {
        return false;
    }
    const char *rest = text + length;
    for (int i = 0; i < count; i++) {
        char *end;
        values[i] = strtod(rest, &end);
        if (end == rest || !isfinite(values[i]) || *end != (i < count - 1 ? ',' : '\0')) {
            return false;
        }
        rest = end + 1;
    }
    return true;
}
