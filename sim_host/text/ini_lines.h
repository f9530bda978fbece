/* Lines of a configuration as inih is to get them: it would take an indented line for a continuation of the one before.
 * SPDX-License-Identifier: MIT */
#ifndef INI_LINES_H
#define INI_LINES_H

#include <stdio.h>

#define INI_LINE_BYTES_MAX 4096 /* comment and line break counted */
#define INI_LINES_MAX 100000    /* so that what never ends is refused */

/* All zero before stream is set. */
typedef struct {
    FILE *stream;
    unsigned long number; /* of the latest line, from 1; 0: none yet */
    char text[INI_LINE_BYTES_MAX + 1];
} ini_lines_t;

/* The next line without its comment ('#'), a byte order mark, and blanks (CR among them) at either end; it lives until the next
 * call. Null at the end of the file, or with *fault set, which is null otherwise: the line is longer than
 * INI_LINE_BYTES_MAX or holds a NUL byte, or it comes after INI_LINES_MAX others. */
char *ini_lines_next(ini_lines_t *lines, const char **fault);

#endif
