/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "table_reader.h"

#include <csv.h>
#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "nearest_name.h"
#include "usual_names.h"

#define OTHERS_MAX 200 /* of the list of missing columns */
#define BUFFER_BYTES (256u * 1024u)
#define FIRST_CAPACITY 1024u
#define FIELD_STEP_BYTES (64u * 1024u) /* by which the parser enlarges its room for a field; its own are tiny */

struct table_reader {
    char *path;
    const table_column_t *wanted;
    size_t wanted_count;
    int descriptor;
    double bytes, bytes_read; /* of the file; 0: not known */
    struct csv_parser parser;
    char *buffer;
    size_t begin, end; /* the part of the buffer that is not yet parsed */
    bool at_end;       /* of the file */
    bool finished;     /* the parser knows the end */

    unsigned long line;     /* of the next byte to parse */
    unsigned long row_line; /* on which the current row began */
    size_t row_bytes;       /* of the file, of the current row */
    bool row_open;          /* a row has begun and not ended */

    char *text; /* the current row's fields, a NUL behind each */
    size_t text_used, text_capacity;
    table_field_t *fields; /* of the header, then of the current row */
    size_t field_capacity;
    size_t count;         /* fields of the current row so far */
    size_t nul;           /* the first of them that holds a NUL; SIZE_MAX: none */
    char *header_text;    /* names of the columns, as text */
    const char **headers; /* into header_text */
    size_t columns;       /* of the header */
    unsigned long header_line;
    bool header_done;
    bool row_ready;

    bool failed;
    input_error_t error;
};

/* The first fault of a file ends the reading. */
#define FAIL(reader, ...) input_error_first(&(reader)->failed, &(reader)->error, (reader)->path, __VA_ARGS__)

/* ------------------------------------------------------------------------------------------------------------ memory -- */

/* False: there is no memory. *capacity: in items of so many bytes. */
static bool grow(void **items, size_t *capacity, size_t needed, size_t size) {
    if (needed <= *capacity) {
        return true;
    }
    const size_t doubled = 2u * *capacity + FIRST_CAPACITY;
    const size_t more = doubled > needed ? doubled : needed;
    void *grown = realloc(*items, more * size);
    if (grown == NULL) {
        return false;
    }
    *items = grown;
    *capacity = more;
    return true;
}

static bool add_text(table_reader_t *reader, const char *text, size_t length) {
    void *capacity = reader->text;
    const bool grown = grow(&capacity, &reader->text_capacity, reader->text_used + length + 1u, 1u);
    reader->text = capacity;
    if (grown) {
        (void)memcpy(reader->text + reader->text_used, text, length);
        reader->text_used += length;
        reader->text[reader->text_used++] = '\0';
    }
    return grown;
}

static bool add_field(table_reader_t *reader, const char *text, size_t length) {
    void *capacity = reader->fields;
    const bool grown = grow(&capacity, &reader->field_capacity, reader->count + 1u, sizeof *reader->fields);
    reader->fields = capacity;
    if (!grown || !add_text(reader, text, length)) {
        return false;
    }
    table_field_t *field = &reader->fields[reader->count];
    field->text = NULL; /* the text may still move; see place_fields() */
    field->length = length;
    return true;
}

static void place_fields(table_reader_t *reader) {
    const char *text = reader->text;
    for (size_t i = 0; i < reader->count; i++) {
        reader->fields[i].text = text;
        text += reader->fields[i].length + 1u;
    }
}

/* ---------------------------------------------------------------------------------------------------------- header -- */

static int column_of(const table_reader_t *reader, const char *name, size_t length) {
    for (size_t i = 0; i < reader->wanted_count; i++) {
        if (strlen(reader->wanted[i].name) == length && memcmp(reader->wanted[i].name, name, length) == 0) {
            return (int)i;
        }
    }
    return TABLE_STRANGER;
}

bool table_reader_has(const table_reader_t *reader, size_t column) {
    for (size_t i = 0; i < reader->columns; i++) {
        if (reader->fields[i].column == (int)column) {
            return true;
        }
    }
    return false;
}

/* The row at hand is the header: its text is kept, and each field of the rows gets its column. */
static void take_header(table_reader_t *reader) {
    reader->header_done = true;
    reader->header_line = reader->row_line;
    reader->header_text = reader->text;
    reader->text = NULL;
    reader->text_capacity = 0;
    reader->headers = calloc(reader->count + 1u, sizeof *reader->headers);
    if (reader->headers == NULL) {
        FAIL(reader, reader->row_line, NULL, "out of memory");
        return;
    }
    for (size_t i = 0; i < reader->count && !reader->failed; i++) {
        table_field_t *field = &reader->fields[i];
        reader->headers[i] = field->text;
        field->column = column_of(reader, field->text, field->length);
        if (field->column != TABLE_STRANGER && table_reader_has(reader, (size_t)field->column)) {
            FAIL(reader, reader->row_line, field->text, "the column appears twice");
        }
        reader->columns = i + 1u;
    }
}

/* The delimiter of a header line that has no comma; 0: it has one, or none at all. */
static char other_delimiter(const table_reader_t *reader) {
    if (reader->columns != 1) {
        return 0;
    }
    const char *found = strpbrk(reader->headers[0], ";\t|");
    return found != NULL ? *found : 0;
}

/* The file's own name for a column that it lacks; null: nothing like it is there. */
static const char *mistyped(const table_reader_t *reader, const char *name) {
    nearest_name_t nearest = nearest_name_of(name, strlen(name));
    for (size_t i = 0; i < reader->columns; i++) {
        if (reader->fields[i].column == TABLE_STRANGER) {
            const char *const ours = usual_name(reader->headers[i]);
            if (ours != NULL && strcmp(ours, name) == 0) {
                return reader->headers[i];
            }
            nearest_name_try(&nearest, reader->headers[i]);
        }
    }
    return nearest.name;
}

/* The column that an ignored one probably means, of those that are absent; null: none. */
static const char *meant_by(const table_reader_t *reader, const char *name) {
    const char *const ours = usual_name(name);
    nearest_name_t nearest = nearest_name_of(name, strlen(name));
    for (size_t i = 0; i < reader->wanted_count; i++) {
        if (!table_reader_has(reader, i)) {
            if (ours != NULL && strcmp(ours, reader->wanted[i].name) == 0) {
                return reader->wanted[i].name;
            }
            nearest_name_try(&nearest, reader->wanted[i].name);
        }
    }
    return nearest.name;
}

const char *table_reader_misspelt(const table_reader_t *reader, size_t *next, const char **meant) {
    for (; *next < reader->columns; (*next)++) {
        const char *const name = reader->headers[*next];
        *meant = reader->fields[*next].column == TABLE_STRANGER ? meant_by(reader, name) : NULL;
        if (*meant != NULL) {
            (*next)++;
            return name;
        }
    }
    return NULL;
}

/* The other missing columns, as the end of a message; empty: there are none. */
static void list_others(const table_reader_t *reader, const char *name, char text[OTHERS_MAX]) {
    size_t used = 0;
    text[0] = '\0';
    for (size_t i = 0; reader->header_done && i < reader->wanted_count; i++) {
        const char *other = reader->wanted[i].name;
        if (reader->wanted[i].required && !table_reader_has(reader, i) && strcmp(other, name) != 0 &&
            used < OTHERS_MAX) {
            used +=
                (size_t)snprintf(text + used, OTHERS_MAX - used, "%s%s", used == 0 ? "; also missing: " : ", ", other);
        }
    }
}

static void fail_missing(table_reader_t *reader, const char *name) {
    char others[OTHERS_MAX];
    list_others(reader, name, others);
    const char delimiter = reader->header_done ? other_delimiter(reader) : 0;
    const char *instead = reader->header_done ? mistyped(reader, name) : NULL;
    if (delimiter != 0) {
        FAIL(reader, reader->header_line, name,
             "missing column: %s separate the columns; a log has commas between them, and points in its numbers",
             delimiter == '\t'  ? "tabs"
             : delimiter == ';' ? "semicolons"
                                : "bars");
    } else if (instead != NULL) {
        FAIL(reader, reader->header_line, name, "missing column; is '%s' meant to be it?%s",
             excerpt_of(instead, strlen(instead)).text, others);
    } else {
        FAIL(reader, reader->header_line, name, "missing column%s",
             reader->header_done ? others : ", the file is empty");
    }
}

static void check_header(table_reader_t *reader) {
    for (size_t i = 0; i < reader->wanted_count; i++) {
        if (reader->wanted[i].required && !table_reader_has(reader, i)) {
            fail_missing(reader, reader->wanted[i].name);
        }
    }
}

/* ------------------------------------------------------------------------------------------------------------ rows -- */

static const char *name_of(const table_reader_t *reader, size_t field) {
    return field < reader->columns ? reader->headers[field] : NULL;
}

static void on_field(void *text, size_t length, void *user) {
    table_reader_t *reader = user;
    const size_t most = reader->header_done ? reader->columns : TABLE_COLUMNS_MAX;
    if (reader->count < most) {
        if (length > 0 && reader->nul == SIZE_MAX && memchr(text, '\0', length) != NULL) {
            reader->nul = reader->count;
        }
        if (!add_field(reader, text != NULL ? text : "", length)) {
            FAIL(reader, reader->row_line, name_of(reader, reader->count), "out of memory");
        }
    } else if (!reader->header_done) {
        FAIL(reader, reader->row_line, NULL, "more than %u columns", TABLE_COLUMNS_MAX);
    }
    reader->count++; /* of a row, more than there are columns, too: reported at its end */
}

/* Too few or too many fields are the cause of other faults of a row: they are reported first. */
static void check_row(table_reader_t *reader) {
    if (reader->count < reader->columns) {
        FAIL(reader, reader->row_line, name_of(reader, reader->count),
             "the row ends before this column: %zu fields, the header has %zu", reader->count, reader->columns);
    } else if (reader->count > reader->columns) {
        FAIL(reader, reader->row_line, name_of(reader, reader->columns - 1u),
             "the row goes on after this column: %zu fields, the header has %zu", reader->count, reader->columns);
    } else if (reader->nul != SIZE_MAX) {
        FAIL(reader, reader->row_line, name_of(reader, reader->nul), "the field holds a NUL byte");
    }
}

static void on_row_end(int terminator, void *user) {
    (void)terminator;
    table_reader_t *reader = user;
    if (!reader->failed && !reader->header_done) {
        place_fields(reader);
        if (reader->nul != SIZE_MAX) {
            FAIL(reader, reader->row_line, NULL, "the header holds a NUL byte");
        }
        take_header(reader);
        check_header(reader);
    } else if (!reader->failed) {
        check_row(reader);
        reader->row_ready = !reader->failed;
    }
    reader->row_open = false;
}

static void begin_row(table_reader_t *reader) {
    reader->row_open = true;
    reader->row_line = reader->line;
    reader->row_bytes = 0;
    reader->count = 0;
    reader->text_used = 0;
    reader->nul = SIZE_MAX;
}

/* ----------------------------------------------------------------------------------------------------------- bytes -- */

/* Only LF ends a row and CR counts as a blank, so that every call of the parser sees one line at most and the line's
 * number is known without asking the parser. */
static int ends_row(unsigned char c) { return c == CSV_LF; }

static int is_blank(unsigned char c) { return c == CSV_SPACE || c == CSV_TAB || c == CSV_CR; }

static bool all_blank(const char *text, size_t length) {
    for (size_t i = 0; i < length; i++) {
        if (!is_blank((unsigned char)text[i]) && !ends_row((unsigned char)text[i])) {
            return false;
        }
    }
    return true;
}

static void fail_parser(table_reader_t *reader) {
    const int cause = csv_error(&reader->parser);
    FAIL(reader, reader->row_line, name_of(reader, reader->count), "%s",
         cause == CSV_EPARSE ? "a quote is out of place or not closed" : csv_strerror(cause));
}

static void parse_piece(table_reader_t *reader, const char *text, size_t length) {
    if (!reader->row_open && !all_blank(text, length)) {
        begin_row(reader);
    }
    reader->row_bytes += length;
    if (csv_parse(&reader->parser, text, length, on_field, on_row_end, reader) != length) {
        fail_parser(reader);
    } else if (reader->row_open && reader->row_bytes > TABLE_ROW_BYTES_MAX) {
        FAIL(reader, reader->row_line, name_of(reader, reader->count),
             "the row is longer than %u bytes: a quote not closed?", TABLE_ROW_BYTES_MAX);
    }
}

/* A row that is still open has no line break: whether it is whole nobody knows. */
static void finish(table_reader_t *reader) {
    const bool is_cut = reader->row_open;
    reader->finished = true;
    if (csv_fini(&reader->parser, on_field, on_row_end, reader) != 0) {
        fail_parser(reader);
    } else if (is_cut) {
        const size_t last = reader->count > 0 ? reader->count - 1u : 0u;
        FAIL(reader, reader->row_line, name_of(reader, last),
             "the file ends without a line break: is it cut off here?");
    }
    if (!reader->header_done) {
        check_header(reader);
    }
}

/* Reads on behind what the buffer holds. */
static void fill(table_reader_t *reader) {
    ssize_t got = 0;
    do {
        got = read(reader->descriptor, reader->buffer + reader->end, BUFFER_BYTES - reader->end);
    } while (got < 0 && errno == EINTR);
    if (got < 0) {
        FAIL(reader, 0u, NULL, "cannot be read: %s", strerror(errno));
        return;
    }
    reader->end += (size_t)got;
    reader->bytes_read += (double)got;
    reader->at_end = got == 0;
}

/* One line, or its part in the buffer. */
static void parse_line(table_reader_t *reader) {
    const char *text = reader->buffer + reader->begin;
    const size_t held = reader->end - reader->begin;
    const char *line_end = memchr(text, CSV_LF, held);
    const size_t length = line_end != NULL ? (size_t)(line_end - text) + 1u : held;
    parse_piece(reader, text, length);
    reader->begin += length;
    reader->line += line_end != NULL ? 1u : 0u;
}

static void step(table_reader_t *reader) {
    if (reader->begin < reader->end) {
        parse_line(reader);
    } else if (!reader->at_end) {
        reader->begin = reader->end = 0;
        fill(reader);
    } else {
        finish(reader);
    }
}

/* Some programs open a UTF-8 file with a byte order mark. A pipe may deliver it byte by byte. */
static void skip_byte_order_mark(table_reader_t *reader) {
    static const unsigned char mark[] = {0xefu, 0xbbu, 0xbfu};
    while (!reader->failed && !reader->at_end && reader->end < sizeof mark) {
        fill(reader);
    }
    if (reader->end >= sizeof mark && memcmp(reader->buffer, mark, sizeof mark) == 0) {
        reader->begin = sizeof mark;
    }
}

/* ------------------------------------------------------------------------------------------------------- interface -- */

static bool start(table_reader_t *reader, const char *path) {
    reader->descriptor = -1;
    reader->line = reader->row_line = reader->header_line = 1;
    reader->nul = SIZE_MAX;
    if (csv_init(&reader->parser, CSV_STRICT | CSV_STRICT_FINI | CSV_APPEND_NULL) != 0) {
        return false;
    }
    csv_set_term_func(&reader->parser, ends_row);
    csv_set_space_func(&reader->parser, is_blank);
    csv_set_blk_size(&reader->parser, FIELD_STEP_BYTES);
    reader->path = strdup(path);
    reader->buffer = malloc(BUFFER_BYTES);
    return reader->path != NULL && reader->buffer != NULL;
}

table_reader_t *table_reader_open(const char *path, const table_column_t *columns, size_t count, input_error_t *error) {
    table_reader_t *reader = calloc(1, sizeof *reader);
    if (reader == NULL || !start(reader, path)) {
        input_error_set(error, path, 0u, NULL, "out of memory");
        table_reader_close(reader);
        return NULL;
    }
    reader->wanted = columns;
    reader->wanted_count = count;
    reader->descriptor = open(path, O_RDONLY | O_CLOEXEC);
    if (reader->descriptor < 0) {
        FAIL(reader, 0u, NULL, "cannot be opened: %s", strerror(errno));
    } else {
        struct stat status;
        reader->bytes =
            fstat(reader->descriptor, &status) == 0 && S_ISREG(status.st_mode) ? (double)status.st_size : 0.0;
        skip_byte_order_mark(reader);
    }
    while (!reader->failed && !reader->header_done && !reader->finished) {
        step(reader);
    }
    if (reader->failed) {
        *error = reader->error;
        table_reader_close(reader);
        return NULL;
    }
    return reader;
}

unsigned long table_reader_header_line(const table_reader_t *reader) { return reader->header_line; }

double table_reader_share(const table_reader_t *reader) {
    return reader->bytes > 0.0 ? (reader->bytes_read - (double)(reader->end - reader->begin)) / reader->bytes : -1.0;
}

table_result_t table_reader_next(table_reader_t *reader, table_row_t *row, input_error_t *error) {
    reader->row_ready = false;
    while (!reader->failed && !reader->row_ready && !reader->finished) {
        step(reader);
    }
    if (reader->failed) {
        *error = reader->error;
        return TABLE_ERROR;
    }
    if (!reader->row_ready) {
        return TABLE_END;
    }
    place_fields(reader);
    row->field = reader->fields;
    row->fields = reader->columns;
    row->line = reader->row_line;
    return TABLE_ROW;
}

void table_reader_close(table_reader_t *reader) {
    if (reader == NULL) {
        return;
    }
    if (reader->descriptor >= 0) {
        (void)close(reader->descriptor);
    }
    free(reader->headers);
    free(reader->header_text);
    free(reader->fields);
    free(reader->text);
    free(reader->buffer);
    free(reader->path);
    csv_free(&reader->parser);
    free(reader);
}
