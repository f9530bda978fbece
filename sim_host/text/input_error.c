/* A fault of an input file, with its position. SPDX-License-Identifier: MIT */
#include "input_error.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define ELLIPSIS "..."

static void set(input_error_t *error, const char *file, unsigned long line, const char *column, const char *format,
                va_list arguments) {
    char reason[256];
    (void)vsnprintf(reason, sizeof reason, format, arguments);
    if (line == 0) {
        (void)snprintf(error->text, sizeof error->text, "%s: %s", file, reason);
    } else if (column == NULL) {
        (void)snprintf(error->text, sizeof error->text, "%s:%lu: %s", file, line, reason);
    } else {
        const excerpt_t name = excerpt_of(column, strlen(column));
        (void)snprintf(error->text, sizeof error->text, "%s:%lu: %s: %s", file, line, name.text, reason);
    }
}

void input_error_set(input_error_t *error, const char *file, unsigned long line, const char *column, const char *format,
                     ...) {
    va_list arguments;
    va_start(arguments, format);
    set(error, file, line, column, format, arguments);
    va_end(arguments);
}

void input_error_first(bool *failed, input_error_t *error, const char *file, unsigned long line, const char *column,
                       const char *format, ...) {
    if (*failed) {
        return;
    }
    *failed = true;
    va_list arguments;
    va_start(arguments, format);
    set(error, file, line, column, format, arguments);
    va_end(arguments);
}

excerpt_t excerpt_of(const char *text, size_t length) {
    excerpt_t excerpt;
    const size_t capacity = sizeof excerpt.text - sizeof ELLIPSIS;
    const size_t kept = length < capacity ? length : capacity;
    for (size_t i = 0; i < kept; i++) {
        const unsigned char c = (unsigned char)text[i];
        excerpt.text[i] = c >= 0x20u && c < 0x7fu ? text[i] : '?';
    }
    (void)memcpy(excerpt.text + kept, length > kept ? ELLIPSIS : "", length > kept ? sizeof ELLIPSIS : 1u);
    return excerpt;
}
