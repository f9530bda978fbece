/* What is wrong with an input file, and where. SPDX-License-Identifier: MIT */
#ifndef INPUT_ERROR_H
#define INPUT_ERROR_H

#include <stddef.h>

typedef struct {
    char text[4608]; /* "file:line: column: reason", without a line break; room for the longest path */
} input_error_t;

#if defined(__GNUC__) || defined(__clang__)
#define INPUT_ERROR_FORMAT __attribute__((format(printf, 5, 6)))
#else
#define INPUT_ERROR_FORMAT
#endif

/* Writes "file:line: column: reason".
 *   line    1 for the first line; 0 when the fault has no line (the file cannot be opened): line and column are left out
 *   column  name of the column or key; null when the fault has none: left out */
void input_error_set(input_error_t *error, const char *file, unsigned long line, const char *column, const char *format,
                     ...) INPUT_ERROR_FORMAT;

/* A short printable copy of text from a file, to be quoted in a message; text need not end in a NUL. */
typedef struct {
    char text[48];
} excerpt_t;

excerpt_t excerpt_of(const char *text, size_t length);

#endif
