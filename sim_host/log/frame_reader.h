/* Reads frames.csv row by row in constant memory. SPDX-License-Identifier: MIT */
#ifndef FRAME_READER_H
#define FRAME_READER_H

#include <stdio.h>

#include "frame.h"
#include "input_error.h"

typedef struct frame_reader frame_reader_t;

typedef enum {
    FRAME_READER_ROW,  /* *frame holds the next row */
    FRAME_READER_END,  /* no more rows */
    FRAME_READER_ERROR /* *error gives the fault and its position; every further call returns it again */
} frame_reader_result_t;

/* Opens the file and checks its header line. A row of none of the so many cameras is an error: the two files of the log do not
 * belong together. Null on failure: *error says why. */
frame_reader_t *frame_reader_open(const char *path, int cameras, input_error_t *error);

frame_reader_result_t frame_reader_next(frame_reader_t *reader, frame_t *frame, input_error_t *error);

/* How much of the file is read, 0 to 1; less than 0: not known. */
double frame_reader_share(const frame_reader_t *reader);

/* A line for each column that is probably misspelt: "program: warning: file:line: ...". Unknown columns are no error. */
void frame_reader_print_misspelt(const frame_reader_t *reader, const char *program, FILE *stream);

/* Null is ignored. */
void frame_reader_close(frame_reader_t *reader);

#endif
