/* Splits the bytes of a stream or of datagrams into JSON texts. SPDX-License-Identifier: MIT
 *
 * A text is a line. If a bracket is open at the end of a line, the text continues with the next lines that begin with a blank or a
 * closing bracket, as in indented JSON. Any other line begins a new text. */
#ifndef LINE_READER_H
#define LINE_READER_H

#include <stdbool.h>
#include <stddef.h>

#include "detection_text.h"

typedef struct {
    char text[DETECTION_LINE_MAX];
    size_t length;
    int open;             /* open brackets of the present text */
    bool quoted, escaped; /* inside a string; after a backslash in it */
    bool at_start;        /* at the start of a further line of the text */
    bool too_long;        /* the text is too long; its rest is ignored */
    unsigned long line;   /* number of the latest text, from 1 */
    unsigned long cut;    /* texts that were too long */
} line_reader_t;

typedef void (*line_taker_t)(void *user, const char *text, size_t length);

/* Passes every text that ends in these bytes to `take`; blank ones are skipped. */
void line_reader_take(line_reader_t *reader, const char *bytes, size_t size, line_taker_t take, void *user);

/* Ends the present text, at the end of a datagram. */
void line_reader_end(line_reader_t *reader, line_taker_t take, void *user);

#endif
