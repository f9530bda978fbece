/*
 * A bar on the terminal with the time left. Debian has no C library for it.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#ifndef PROGRESS_H
#define PROGRESS_H

#include <stdbool.h>
#include <stddef.h>
#include <time.h>

typedef struct {
    const char *what; /* unit of the count: "flights" */
    size_t total;
    struct timespec start;
    bool shown;
} progress_t;

/* The clock starts. Nothing is ever shown if quiet or if standard error is not a terminal. */
void progress_start(progress_t *progress, const char *what, size_t total, bool quiet);

/* Draws the bar again. of_progress: a progress_t; done: of the total. */
void progress_show(void *of_progress, size_t done);

/* Wipes the bar. */
void progress_end(progress_t *progress);

/* Since the start. */
double progress_elapsed_s(const progress_t *progress);

#endif
