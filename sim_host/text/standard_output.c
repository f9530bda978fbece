/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "standard_output.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

bool standard_output_written(const char *program) {
    const bool failed_before = ferror(stdout) != 0;
    const char *cause = "";
    if (fflush(stdout) != 0) {
        cause = strerror(errno);
    } else if (!failed_before) {
        return true;
    }
    (void)fprintf(stderr, "%s: standard output: cannot be written%s%s\n", program, *cause != '\0' ? ": " : "", cause);
    return false;
}

/* What a function without arguments, called at the end, has to know. */
static const char *watched_program;
static int watched_status;

static void on_end(void) {
    if (!standard_output_written(watched_program)) {
        _exit(watched_status);
    }
}

void standard_output_watch(const char *program, int failed_status) {
    watched_program = program;
    watched_status = failed_status;
    (void)atexit(on_end);
}
