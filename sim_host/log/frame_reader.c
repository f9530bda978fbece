/* Reads frames.csv row by row in constant memory. SPDX-License-Identifier: MIT */
#include "frame_reader.h"

#include <csv.h>
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "number_text.h"

#define BUFFER_BYTES (256u * 1024u)
#define ROW_BYTES_MAX (1024u * 1024u) /* bounds the memory that an unclosed quote can take */

/* What a column of the file is: one of frame_value_t, or one of these. */
#define COLUMN_IGNORED (-1)
#define COLUMN_TIME FRAME_VALUES
#define COLUMN_ID (FRAME_VALUES + 1)
#define COLUMN_RESET_COUNT (FRAME_VALUES + 2)
#define COLUMN_CAMERA (FRAME_VALUES + 3)
#define COLUMNS_KNOWN (FRAME_VALUES + 4)

typedef struct {
    char *name;
    int meaning;
} column_t;

struct frame_reader {
    char *path;
    int cameras; /* that there are */
    int descriptor;
    struct csv_parser parser;
    char *buffer;
    size_t begin, end; /* what is not yet parsed of the buffer */
    bool at_end;       /* of the file */
    bool finished;     /* the parser was told so */

    unsigned long line;     /* of the next byte to parse */
    unsigned long row_line; /* on which the current row began */
    size_t row_bytes;
    bool row_open; /* a row has begun and not ended */

    column_t *columns; /* of the header */
    size_t column_count, column_room;
    bool header_done;

    frame_t *frame; /* where the current row goes */
    size_t field;   /* of the current row, from 0 */
    bool row_fault; /* a field of the current row is bad; error tells which */
    bool row_ready;

    bool failed;
    input_error_t error;
};

static const char *known_name(int meaning) {
    switch (meaning) {
        case COLUMN_TIME:
            return FRAME_TIME_NAME;
        case COLUMN_ID:
            return FRAME_ID_NAME;
        case COLUMN_RESET_COUNT:
            return FRAME_RESET_COUNT_NAME;
        case COLUMN_CAMERA:
            return FRAME_CAMERA_NAME;
        default:
            return frame_value_name[meaning];
    }
}

/* The first fault of a file ends the reading. The fault of a field waits for the end of its row: if the row has too few
 * or too many fields, that is the cause, and the field's fault only what follows from it. */
#define SET_ERROR(flag, reader, ...)                                                                                   \
    do {                                                                                                               \
        if (!(reader)->flag) {                                                                                         \
            (reader)->flag = true;                                                                                     \
            input_error_set(&(reader)->error, (reader)->path, __VA_ARGS__);                                            \
        }                                                                                                              \
    } while (0)
#define FAIL(...) SET_ERROR(failed, __VA_ARGS__)
#define FAIL_FIELD(...) SET_ERROR(row_fault, __VA_ARGS__)

/* ---------------------------------------------------------------------------------------------------------- header -- */

static int meaning_of(const char *name, size_t length) {
    for (int meaning = 0; meaning < COLUMNS_KNOWN; meaning++) {
        if (strlen(known_name(meaning)) == length && memcmp(known_name(meaning), name, length) == 0) {
            return meaning;
        }
    }
    return COLUMN_IGNORED;
}

static bool has_column(const frame_reader_t *reader, int meaning) {
    for (size_t i = 0; i < reader->column_count; i++) {
        if (reader->columns[i].meaning == meaning) {
            return true;
        }
    }
    return false;
}

static void add_column(frame_reader_t *reader, const char *name, size_t length) {
    const int meaning = meaning_of(name, length);
    if (meaning != COLUMN_IGNORED && has_column(reader, meaning)) {
        FAIL(reader, reader->row_line, known_name(meaning), "the column appears twice");
        return;
    }
    if (reader->column_count == reader->column_room) {
        const size_t room = 2u * reader->column_room + 32u;
        column_t *columns = realloc(reader->columns, room * sizeof *columns);
        if (columns == NULL) {
            FAIL(reader, reader->row_line, NULL, "out of memory");
            return;
        }
        reader->columns = columns;
        reader->column_room = room;
    }
    column_t *column = &reader->columns[reader->column_count];
    column->meaning = meaning;
    column->name = strndup(name, length);
    if (column->name == NULL) {
        FAIL(reader, reader->row_line, NULL, "out of memory");
        return;
    }
    reader->column_count++;
}

/* Time, id and pose are required, of the pose all but the height above ground. An image point needs both its columns, and the
 * jump of a reset the count, without which it would be taken for motion. */
static void check_header(frame_reader_t *reader) {
    static const int required[] = {COLUMN_TIME, COLUMN_ID, FRAME_N_M, FRAME_E_M, FRAME_D_M,
                                   FRAME_QW,    FRAME_QX,  FRAME_QY,  FRAME_QZ};
    const unsigned long line = reader->header_done ? reader->row_line : 1u;
    for (size_t i = 0; i < sizeof required / sizeof required[0]; i++) {
        if (!has_column(reader, required[i])) {
            FAIL(reader, line, known_name(required[i]), "%s",
                 reader->header_done ? "missing column" : "missing column, the file is empty");
        }
    }
    for (int u = FRAME_LEFT_U; u < FRAME_BOX_LEFT_PX; u += 2) {
        const int v = u + 1;
        if (has_column(reader, u) != has_column(reader, v)) {
            const int absent = has_column(reader, u) ? v : u;
            FAIL(reader, line, known_name(absent), "missing column, the image point's other one is there");
        }
    }
    for (int delta = FRAME_RESET_N_M; delta <= FRAME_RESET_D_M; delta++) {
        if (has_column(reader, delta) && !has_column(reader, COLUMN_RESET_COUNT)) {
            FAIL(reader, line, FRAME_RESET_COUNT_NAME, "missing column, %s is there", known_name(delta));
        }
    }
}

/* ------------------------------------------------------------------------------------------------------------ rows -- */

static void store_time(frame_reader_t *reader, const char *text, size_t length) {
    if (!number_parse(text, length, &reader->frame->time_s)) {
        FAIL_FIELD(reader, reader->row_line, FRAME_TIME_NAME, "'%s' is not a number", excerpt_of(text, length).text);
    } else if (length > FRAME_TIME_TEXT_MAX) {
        FAIL_FIELD(reader, reader->row_line, FRAME_TIME_NAME, "longer than %d characters", FRAME_TIME_TEXT_MAX);
    } else {
        (void)memcpy(reader->frame->time_text, text, length + 1u);
    }
}

static void store_integer(frame_reader_t *reader, int meaning, const char *text, size_t length, int64_t *to) {
    if (!integer_parse(text, length, to)) {
        FAIL_FIELD(reader, reader->row_line, known_name(meaning), "'%s' is not an integer of 64 bits",
                   excerpt_of(text, length).text);
    }
}

/* An empty field is the first camera. */
static void store_camera(frame_reader_t *reader, const char *text, size_t length) {
    int64_t number = 0;
    if (length > 0) {
        store_integer(reader, COLUMN_CAMERA, text, length, &number);
    }
    if (number < 0 || number >= reader->cameras) {
        FAIL_FIELD(reader, reader->row_line, FRAME_CAMERA_NAME,
                   "there is no camera %" PRId64 ", the camera file describes 0 %s", number,
                   reader->cameras > 1 ? "and 1" : "alone");
    }
    reader->frame->camera = number;
}

static void store_value(frame_reader_t *reader, int meaning, const char *text, size_t length) {
    if (length == 0) {
        return; /* not measured */
    }
    if (!number_parse(text, length, &reader->frame->value[meaning])) {
        FAIL_FIELD(reader, reader->row_line, frame_value_name[meaning], "'%s' is not a number",
                   excerpt_of(text, length).text);
        return;
    }
    reader->frame->given[meaning] = true;
}

static void store_field(frame_reader_t *reader, const char *text, size_t length) {
    if (reader->field >= reader->column_count) {
        return; /* told when the row ends and the fields are counted */
    }
    const int meaning = reader->columns[reader->field].meaning;
    if (meaning == COLUMN_TIME) {
        store_time(reader, text, length);
    } else if (meaning == COLUMN_ID) {
        store_integer(reader, meaning, text, length, &reader->frame->id);
    } else if (meaning == COLUMN_RESET_COUNT) {
        if (length > 0) {
            store_integer(reader, meaning, text, length, &reader->frame->reset_count);
        }
    } else if (meaning == COLUMN_CAMERA) {
        store_camera(reader, text, length);
    } else if (meaning != COLUMN_IGNORED) {
        store_value(reader, meaning, text, length);
    }
}

static void on_field(void *text, size_t length, void *user) {
    frame_reader_t *reader = user;
    if (reader->header_done) {
        store_field(reader, text, length);
    } else {
        add_column(reader, text, length);
    }
    reader->field++;
}

static void on_row_end(int terminator, void *user) {
    (void)terminator;
    frame_reader_t *reader = user;
    if (!reader->header_done) {
        reader->header_done = true;
        check_header(reader);
    } else if (reader->field < reader->column_count) {
        FAIL(reader, reader->row_line, reader->columns[reader->field].name,
             "the row ends before this column: %zu fields, the header has %zu", reader->field, reader->column_count);
    } else if (reader->field > reader->column_count) {
        FAIL(reader, reader->row_line, reader->columns[reader->column_count - 1u].name,
             "the row goes on after this column: %zu fields, the header has %zu", reader->field, reader->column_count);
    } else if (reader->row_fault) {
        reader->failed = true;
    } else {
        reader->row_ready = true;
    }
    reader->field = 0;
    reader->row_open = false;
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

static const char *current_column(const frame_reader_t *reader) {
    return reader->header_done && reader->field < reader->column_count ? reader->columns[reader->field].name : NULL;
}

static void fail_parser(frame_reader_t *reader) {
    const int cause = csv_error(&reader->parser);
    FAIL(reader, reader->row_line, current_column(reader), "%s",
         cause == CSV_EPARSE ? "a quote is out of place or not closed" : csv_strerror(cause));
}

static void parse_piece(frame_reader_t *reader, const char *text, size_t length) {
    if (!reader->row_open && !all_blank(text, length)) {
        reader->row_open = true;
        reader->row_line = reader->line;
        reader->row_bytes = 0;
    }
    reader->row_bytes += length;
    if (csv_parse(&reader->parser, text, length, on_field, on_row_end, reader) != length) {
        fail_parser(reader);
    } else if (reader->row_open && reader->row_bytes > ROW_BYTES_MAX) {
        FAIL(reader, reader->row_line, current_column(reader), "the row is longer than %u bytes: a quote not closed?",
             ROW_BYTES_MAX);
    }
}

static void finish(frame_reader_t *reader) {
    reader->finished = true;
    if (csv_fini(&reader->parser, on_field, on_row_end, reader) != 0) {
        fail_parser(reader);
    }
    if (!reader->header_done) {
        check_header(reader);
    }
}

static void refill(frame_reader_t *reader) {
    ssize_t got = 0;
    do {
        got = read(reader->descriptor, reader->buffer, BUFFER_BYTES);
    } while (got < 0 && errno == EINTR);
    if (got < 0) {
        FAIL(reader, 0u, NULL, "cannot be read: %s", strerror(errno));
        return;
    }
    reader->begin = 0;
    reader->end = (size_t)got;
    reader->at_end = got == 0;
}

/* One line, or what the buffer holds of it. */
static void parse_line(frame_reader_t *reader) {
    const char *text = reader->buffer + reader->begin;
    const size_t held = reader->end - reader->begin;
    const char *line_end = memchr(text, CSV_LF, held);
    const size_t length = line_end != NULL ? (size_t)(line_end - text) + 1u : held;
    parse_piece(reader, text, length);
    reader->begin += length;
    reader->line += line_end != NULL ? 1u : 0u;
}

static void step(frame_reader_t *reader) {
    if (reader->begin < reader->end) {
        parse_line(reader);
    } else if (!reader->at_end) {
        refill(reader);
    } else {
        finish(reader);
    }
}

/* Some programs open a UTF-8 file with a byte order mark. A pipe may deliver it byte by byte. */
static void skip_byte_order_mark(frame_reader_t *reader) {
    static const unsigned char mark[] = {0xefu, 0xbbu, 0xbfu};
    while (!reader->at_end && reader->end < sizeof mark) {
        const ssize_t got = read(reader->descriptor, reader->buffer + reader->end, BUFFER_BYTES - reader->end);
        if (got < 0 && errno == EINTR) {
            continue;
        }
        if (got < 0) {
            FAIL(reader, 0u, NULL, "cannot be read: %s", strerror(errno));
            return;
        }
        reader->end += (size_t)got;
        reader->at_end = got == 0;
    }
    if (reader->end >= sizeof mark && memcmp(reader->buffer, mark, sizeof mark) == 0) {
        reader->begin = sizeof mark;
    }
}

/* ------------------------------------------------------------------------------------------------------- interface -- */

static bool start(frame_reader_t *reader, const char *path) {
    reader->descriptor = -1;
    reader->line = 1;
    reader->row_line = 1;
    if (csv_init(&reader->parser, CSV_STRICT | CSV_STRICT_FINI | CSV_APPEND_NULL) != 0) {
        return false;
    }
    csv_set_term_func(&reader->parser, ends_row);
    csv_set_space_func(&reader->parser, is_blank);
    reader->path = strdup(path);
    reader->buffer = malloc(BUFFER_BYTES);
    return reader->path != NULL && reader->buffer != NULL;
}

frame_reader_t *frame_reader_open(const char *path, int cameras, input_error_t *error) {
    frame_reader_t *reader = calloc(1, sizeof *reader);
    if (reader == NULL || !start(reader, path)) {
        input_error_set(error, path, 0u, NULL, "out of memory");
        frame_reader_close(reader);
        return NULL;
    }
    reader->cameras = cameras;
    reader->descriptor = open(path, O_RDONLY | O_CLOEXEC);
    if (reader->descriptor < 0) {
        FAIL(reader, 0u, NULL, "cannot be opened: %s", strerror(errno));
    } else {
        skip_byte_order_mark(reader);
    }
    while (!reader->failed && !reader->header_done && !reader->finished) {
        step(reader);
    }
    if (reader->failed) {
        *error = reader->error;
        frame_reader_close(reader);
        return NULL;
    }
    return reader;
}

frame_reader_result_t frame_reader_next(frame_reader_t *reader, frame_t *frame, input_error_t *error) {
    reader->frame = frame;
    reader->row_ready = false;
    (void)memset(frame->given, 0, sizeof frame->given);
    frame->reset_count = 0;
    frame->camera = 0;
    while (!reader->failed && !reader->row_ready && !reader->finished) {
        step(reader);
    }
    if (reader->failed) {
        *error = reader->error;
        return FRAME_READER_ERROR;
    }
    return reader->row_ready ? FRAME_READER_ROW : FRAME_READER_END;
}

void frame_reader_close(frame_reader_t *reader) {
    if (reader == NULL) {
        return;
    }
    if (reader->descriptor >= 0) {
        (void)close(reader->descriptor);
    }
    for (size_t i = 0; i < reader->column_count; i++) {
        free(reader->columns[i].name);
    }
    free(reader->columns);
    free(reader->buffer);
    free(reader->path);
    csv_free(&reader->parser);
    free(reader);
}
