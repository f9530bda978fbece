/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "ini_lines.h"

#include <ctype.h>
#include <stdbool.h>
#include <string.h>

#define TEXT_OF(number) #number
#define NUMBER(macro) TEXT_OF(macro)

static char *trim(char *text) {
    text[strcspn(text, "#")] = '\0';
    while (isspace((unsigned char)*text)) {
        text++;
    }
    size_t length = strlen(text);
    while (length > 0 && isspace((unsigned char)text[length - 1u])) {
        length--;
    }
    text[length] = '\0';
    return text;
}

/* The rest of a line that begins with `c`. Null, or why it cannot be taken. */
static const char *read_line(ini_lines_t *lines, int c) {
    size_t length = 0;
    for (; c != EOF && c != '\n'; c = getc(lines->stream)) {
        if (c == '\0') {
            return "the line holds a NUL byte";
        }
        if (length == INI_LINE_BYTES_MAX) {
            return "the line is longer than " NUMBER(INI_LINE_BYTES_MAX) " bytes";
        }
        lines->text[length++] = (char)c;
    }
    lines->text[length] = '\0';
    return NULL;
}

char *ini_lines_next(ini_lines_t *lines, const char **fault) {
    static const char mark[] = "\xef\xbb\xbf"; /* byte order mark */
    const int first = getc(lines->stream);
    *fault = NULL;
    if (first == EOF) {
        return NULL;
    }
    lines->number++;
    *fault = lines->number > INI_LINES_MAX ? "more than " NUMBER(INI_LINES_MAX) " lines" : read_line(lines, first);
    if (*fault != NULL) {
        return NULL;
    }
    const bool marked = lines->number == 1 && strncmp(lines->text, mark, sizeof mark - 1u) == 0;
    return trim(lines->text + (marked ? sizeof mark - 1u : 0u));
}
