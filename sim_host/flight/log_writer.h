/*
 * Writes a flight as an observation log: a folder with camera.ini, frames.csv, truth.csv, and truth_frames.csv with what each
 * frame would be without noise. Numbers have the fewest digits that read back as the same double.
 *
 * The folder appears whole or not at all: it is written under another name in the same parent folder and then renamed. A log that was
 * written so is replaced, as long as nobody has changed it since; a folder that holds anything else is refused, a log of another
 * program, too. Folders on the way that are missing are made.
 *
 * Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT
 */
#ifndef SIM_LOG_WRITER_H
#define SIM_LOG_WRITER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "flight_case.h"

#define LOG_TRACK_ID 1 /* of the first obstacle; the next ones follow */

/* Of one flight, an obstacle each: with the same number of frames, at the same times. */
typedef struct {
    const flight_log_t *log;
    size_t count;
} flight_logs_t;

/* False: fault says why; the folder is as it was. */
bool log_write(const char *folder, const flight_case_t *setup, const flight_logs_t *logs, char *fault,
               size_t fault_size);

/* Whether log_write() to the folder would replace this file, by whatever links it is named. */
bool log_write_replaces(const char *folder, const char *path);

#endif
