/* Suspicious content of a readable log: other units, other signs, another order of the quaternion. Nothing is refused for
 * it: a hint describes the observation and the remedy. SPDX-License-Identifier: MIT */
#ifndef LOG_HINTS_H
#define LOG_HINTS_H

#include <stdio.h>

#include "frame.h"

/* All zero at first. Sums over the images, one for each time. */
typedef struct {
    unsigned long broken,
        broken_line; /* rows with a number that is not finite, or a pose that is not known; the first's line */
    unsigned long late, late_line; /* rows whose time does not come after that of their track's row before */
    unsigned long images;
    double first_s, last_s, last[3];
    double way_m; /* flown, level */
    double anchor[2];
    unsigned long moves, odd,
        odd_as_xyzw; /* of a meter; against the nose or tilted; the same with the quaternion's parts moved */
    unsigned long apart, along_exchanged,
        along_inverse; /* away from the nose; along it with north and east exchanged; ... with the inverse attitude */
    unsigned long heights, below; /* images with agl_m; images below the ground, by agl_m or, without it, by d_m */
    double up[2], agl[2], up_agl; /* sums of -d_m and agl_m from the first, of their squares and of their products */
    double first_up, first_agl;
    double ratio[2]; /* of agl_m to -d_m, least and greatest */
} log_hints_t;

void log_hints_add(log_hints_t *hints, const frame_t *frame);

/* Counts a row that the library refuses with GOE_BAD_TIME. */
void log_hints_late(log_hints_t *hints, const frame_t *frame);

/* A line for each hint: "program: warning: file: ...". */
void log_hints_print(const log_hints_t *hints, const char *program, const char *file, FILE *stream);

#endif
