/* Bytes of a stream or of datagrams into JSON texts. SPDX-License-Identifier: MIT
 *
 * A text is a line. A line that leaves a bracket open goes on with lines that begin with a blank or a closing bracket, as
 * programs print it that indent; with any other line a new text begins. */
#ifndef LINE_READER_H
#define LINE_READER_H

#include <stdbool.h>
#include <stddef.h>

#include "detection_text.h"

typedef struct {
    char text[DETECTION_LINE_MAX];
    size_t length;
    int open;             /* brackets of the text at hand that are not closed ... */
    bool quoted, escaped; /* ... within a string, behind its backslash */
    bool at_start;        /* of a further line of it */
    bool too_long;        /* the rest of it is passed over */
    unsigned long line;   /* number of the latest text, from 1 */
    unsigned long cut;    /* texts that were too long */
} line_reader_t;

typedef void (*line_taker_t)(void *user, const char *text, size_t length);

/* Passes every text that ends in these bytes to `take`; blank ones are skipped. */
void line_reader_take(line_reader_t *reader, const char *bytes, size_t size, line_taker_t take, void *user);

/* A datagram has ended, and with it its last text. */
void line_reader_end(line_reader_t *reader, line_taker_t take, void *user);

#endif
