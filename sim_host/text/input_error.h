/* A fault of an input file, with its position. SPDX-License-Identifier: MIT */
#ifndef INPUT_ERROR_H
#define INPUT_ERROR_H

#include <stdbool.h>
#include <stddef.h>

typedef struct {
    char text[4608]; /* "file:line: column: reason", without a line break; room for the longest path */
} input_error_t;

#if defined(__GNUC__) || defined(__clang__)
#define INPUT_ERROR_FORMAT(format_at) __attribute__((format(printf, format_at, format_at + 1)))
#else
#define INPUT_ERROR_FORMAT(format_at)
#endif

/* Writes "file:line: column: reason".
 *   line    1 for the first line; 0 when the fault has no line (the file cannot be opened): line and column are left out
 *   column  name of the column or key; null when the fault has none: left out */
void input_error_set(input_error_t *error, const char *file, unsigned long line, const char *column, const char *format,
                     ...) INPUT_ERROR_FORMAT(5);

/* The same for a reader that continues: it reports the first fault. Nothing happens if *failed; else it becomes true. */
void input_error_first(bool *failed, input_error_t *error, const char *file, unsigned long line, const char *column,
                       const char *format, ...) INPUT_ERROR_FORMAT(6);

/* A short printable copy of text from a file, to be quoted in a message; text need not end in a NUL. */
typedef struct {
    char text[48];
} excerpt_t;

excerpt_t excerpt_of(const char *text, size_t length);

#endif
