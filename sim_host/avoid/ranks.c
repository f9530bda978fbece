/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "ranks.h"

#include <math.h>
#include <stdlib.h>

static int compare(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

void ranks_sort(double *numbers, int count) { qsort(numbers, (size_t)count, sizeof *numbers, compare); }

double ranks_quantile(const double *sorted, int count, double share) {
    return count > 0 ? sorted[(int)(share * (count - 1) + 0.5)] : (double)NAN;
}
