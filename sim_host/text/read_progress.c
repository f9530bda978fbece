/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "read_progress.h"

#include <stdio.h>
#include <time.h>
#include <unistd.h>

#define AFTER_S 2.0
#define EVERY_S 0.2
#define LOOK_EVERY 1024u /* rows from one look at the clock to the next */
#define CLEAR "\r\033[K"

static double now_s(void) {
    struct timespec now = {0, 0};
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

read_progress_t read_progress_begin(const char *program) {
    const read_progress_t progress = {program, isatty(STDERR_FILENO) != 0, false, 0, now_s() + AFTER_S};
    return progress;
}

void read_progress_row(read_progress_t *progress, double share) {
    if (++progress->rows % LOOK_EVERY != 0 || !progress->on_terminal || now_s() < progress->next_s) {
        return;
    }
    progress->next_s = now_s() + EVERY_S;
    progress->shown = true;
    (void)fprintf(stderr, CLEAR "%s: %lu rows", progress->program, progress->rows);
    if (share >= 0.0) {
        (void)fprintf(stderr, ", %.0f %%", 100.0 * share);
    }
    (void)fflush(stderr);
}

void read_progress_end(read_progress_t *progress) {
    if (progress->shown) {
        (void)fputs(CLEAR, stderr);
        progress->shown = false;
    }
}
