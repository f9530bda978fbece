/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "progress.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

#define BAR_WIDTH 32
#define WIPE "\r\033[K"
#define S_PER_MIN 60

void progress_start(progress_t *progress, const char *what, size_t total, bool quiet) {
    progress->what = what;
    progress->total = total;
    progress->shown = !quiet && isatty(STDERR_FILENO) != 0;
    (void)clock_gettime(CLOCK_MONOTONIC, &progress->start);
}

double progress_elapsed_s(const progress_t *progress) {
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)(now.tv_sec - progress->start.tv_sec) + 1e-9 * (double)(now.tv_nsec - progress->start.tv_nsec);
}

void progress_show(void *of_progress, size_t done) {
    const progress_t *progress = of_progress;
    if (!progress->shown || done == 0) {
        return;
    }
    char bar[BAR_WIDTH + 1];
    const size_t filled = BAR_WIDTH * done / progress->total;
    (void)memset(bar, '.', BAR_WIDTH);
    (void)memset(bar, '#', filled);
    bar[BAR_WIDTH] = '\0';
    const double left = progress_elapsed_s(progress) * (double)(progress->total - done) / (double)done;
    const int left_s = (int)(left + 0.5);
    (void)fprintf(stderr, WIPE "[%s] %3zu %%  %zu of %zu %s, %d:%02d left", bar, 100 * done / progress->total, done,
                  progress->total, progress->what, left_s / S_PER_MIN, left_s % S_PER_MIN);
    (void)fflush(stderr);
}

void progress_end(progress_t *progress) {
    if (progress->shown) {
        (void)fputs(WIPE, stderr);
        (void)fflush(stderr);
        progress->shown = false;
    }
}
