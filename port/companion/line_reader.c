/* Bytes into lines. SPDX-License-Identifier: MIT */
#include "line_reader.h"

#include <string.h>

static bool is_blank(const char *text, size_t length) {
    for (size_t i = 0; i < length; i++) {
        if (text[i] != ' ' && text[i] != '\t' && text[i] != '\r') {
            return false;
        }
    }
    return true;
}

void line_reader_end(line_reader_t *reader, line_taker_t take, void *user) {
    if (reader->too_long) {
        reader->line++;
        reader->cut++;
    } else if (!is_blank(reader->text, reader->length)) {
        reader->line++;
        take(user, reader->text, reader->length);
    }
    reader->length = 0;
    reader->too_long = false;
}

static void add(line_reader_t *reader, const char *bytes, size_t size) {
    if (size > sizeof reader->text - reader->length) {
        reader->too_long = true;
    } else {
        (void)memcpy(reader->text + reader->length, bytes, size);
        reader->length += size;
    }
}

void line_reader_take(line_reader_t *reader, const char *bytes, size_t size, line_taker_t take, void *user) {
    while (size > 0) {
        const char *end = memchr(bytes, '\n', size);
        const size_t length = end != NULL ? (size_t)(end - bytes) : size;
        add(reader, bytes, length);
        if (end == NULL) {
            return;
        }
        line_reader_end(reader, take, user);
        bytes += length + 1u;
        size -= length + 1u;
    }
}
