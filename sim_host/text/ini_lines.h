/* Lines of a configuration as inih is to get them: it would take an indented line for a continuation of the one before.
 * SPDX-License-Identifier: MIT */
#ifndef INI_LINES_H
#define INI_LINES_H

#include <stddef.h>
#include <stdio.h>

/* All zero before stream is set; free() of text is the owner's. */
typedef struct {
    FILE *stream;
    unsigned long number; /* of the latest line, from 1; 0: none yet */
    char *text;
    size_t room;
} ini_lines_t;

/* The next line without its comment ('#'), a byte order mark, and blanks (CR among them) at either end; it lives until the next
 * call. Null at the end of the file, or with *fault set, which is null otherwise. */
char *ini_lines_next(ini_lines_t *lines, const char **fault);

#endif
