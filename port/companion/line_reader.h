/* Bytes of a stream or of datagrams into lines. SPDX-License-Identifier: MIT */
#ifndef LINE_READER_H
#define LINE_READER_H

#include <stdbool.h>
#include <stddef.h>

#include "detection_text.h"

typedef struct {
    char text[DETECTION_LINE_MAX];
    size_t length;
    bool too_long;      /* of the line at hand: the rest of it is passed over */
    unsigned long line; /* number of the latest, from 1 */
    unsigned long cut;  /* lines that were too long */
} line_reader_t;

typedef void (*line_taker_t)(void *user, const char *line, size_t length);

/* Hands every line that ends in these bytes to `take`; empty ones are not told. */
void line_reader_take(line_reader_t *reader, const char *bytes, size_t size, line_taker_t take, void *user);

/* A datagram has ended, and with it its last line. */
void line_reader_end(line_reader_t *reader, line_taker_t take, void *user);

#endif
