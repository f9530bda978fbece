/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "ini_lines.h"

#include <ctype.h>
#include <stdbool.h>
#include <string.h>
#include <sys/types.h>

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

char *ini_lines_next(ini_lines_t *lines, const char **fault) {
    static const char mark[] = "\xef\xbb\xbf"; /* byte order mark */
    const ssize_t length = getline(&lines->text, &lines->room, lines->stream);
    *fault = NULL;
    if (length < 0) {
        return NULL;
    }
    lines->number++;
    if (strlen(lines->text) != (size_t)length) {
        *fault = "the line holds a NUL byte";
        return NULL;
    }
    const bool marked = lines->number == 1 && strncmp(lines->text, mark, sizeof mark - 1u) == 0;
    return trim(lines->text + (marked ? sizeof mark - 1u : 0u));
}
