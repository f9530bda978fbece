/* Bytes into JSON texts. SPDX-License-Identifier: MIT */
#include "line_reader.h"

static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

static bool is_all_blank(const char *text, size_t length) {
    for (size_t i = 0; i < length; i++) {
        if (!is_blank(text[i])) {
            return false;
        }
    }
    return true;
}

void line_reader_end(line_reader_t *reader, line_taker_t take, void *user) {
    if (reader->too_long) {
        reader->line++;
        reader->cut++;
    } else if (!is_all_blank(reader->text, reader->length)) {
        reader->line++;
        take(user, reader->text, reader->length);
    }
    reader->length = 0;
    reader->open = 0;
    reader->quoted = reader->escaped = reader->at_start = reader->too_long = false;
}

/* Strings have no line breaks in JSON: a quote that is left open ends with its line. */
static void count_brackets(line_reader_t *reader, char c) {
    if (reader->quoted) {
        reader->quoted = reader->escaped || (c != '"' && c != '\n');
        reader->escaped = !reader->escaped && c == '\\';
    } else if (c == '"') {
        reader->quoted = true;
    } else if (c == '[' || c == '{') {
        reader->open++;
    } else if ((c == ']' || c == '}') && reader->open > 0) {
        reader->open--;
    }
}

static void add(line_reader_t *reader, char c) {
    if (reader->length == sizeof reader->text) {
        reader->too_long = true;
    } else {
        reader->text[reader->length] = c;
        reader->length++;
    }
    count_brackets(reader, c);
}

void line_reader_take(line_reader_t *reader, const char *bytes, size_t size, line_taker_t take, void *user) {
    for (size_t i = 0; i < size; i++) {
        const char c = bytes[i];
        if (reader->at_start && !is_blank(c) && c != ']' && c != '}') {
            line_reader_end(reader, take, user);
        }
        reader->at_start = false;
        if (c != '\n') {
            add(reader, c);
        } else if (reader->too_long || reader->open == 0) {
            line_reader_end(reader, take, user);
        } else {
            add(reader, c);
            reader->at_start = true;
        }
    }
}
