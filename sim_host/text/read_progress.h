/* How far a long reading is: one line of a terminal's standard error, once two seconds have passed. SPDX-License-Identifier: MIT */
#ifndef READ_PROGRESS_H
#define READ_PROGRESS_H

#include <stdbool.h>

typedef struct {
    const char *program;
    bool on_terminal, shown;
    unsigned long rows;
    double next_s;
} read_progress_t;

read_progress_t read_progress_begin(const char *program);

/* One more row; share: of the file, 0 to 1, or less than 0: not known. */
void read_progress_row(read_progress_t *progress, double share);

/* Leaves no trace. */
void read_progress_end(read_progress_t *progress);

#endif
