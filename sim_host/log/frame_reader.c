/* Reads frames.csv row by row in constant memory. SPDX-License-Identifier: MIT */
#include "frame_reader.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "number_text.h"
#include "table_reader.h"

/* What a column of the file is: one of these, or one of frame_value_t behind them. */
enum { COLUMN_TIME, COLUMN_ID, COLUMN_RESET_COUNT, COLUMN_CAMERA, COLUMN_KIND_SHAPE, COLUMN_VALUES };
#define COLUMNS_KNOWN (COLUMN_VALUES + FRAME_VALUES)
#define KIND_MAX_M 1.0e3
#define KIND_SHARE_MIN 0.01f /* of a size: its least sigma; both as in goe_kind_t */
#define VALUE_COLUMN(name) ((size_t)COLUMN_VALUES + (size_t)(name))

struct frame_reader {
    char *path;
    int cameras; /* that there are */
    table_column_t columns[COLUMNS_KNOWN];
    table_reader_t *table;
    bool failed;
    input_error_t error;
};

/* The first fault of a file ends the reading. */
#define FAIL(reader, ...) input_error_first(&(reader)->failed, &(reader)->error, (reader)->path, __VA_ARGS__)

/* ---------------------------------------------------------------------------------------------------------- header -- */

/* Time, id and pose are required, of the pose all but the height above ground. */
static void name_columns(table_column_t columns[COLUMNS_KNOWN]) {
    static const frame_value_t required[] = {FRAME_N_M, FRAME_E_M, FRAME_D_M, FRAME_QW, FRAME_QX, FRAME_QY, FRAME_QZ};
    static const table_column_t others[COLUMN_VALUES] = {{FRAME_TIME_NAME, true},
                                                         {FRAME_ID_NAME, true},
                                                         {FRAME_RESET_COUNT_NAME, false},
                                                         {FRAME_CAMERA_NAME, false},
                                                         {FRAME_KIND_SHAPE_NAME, false}};
    (void)memcpy(columns, others, sizeof others);
    for (int i = 0; i < FRAME_VALUES; i++) {
        columns[VALUE_COLUMN(i)].name = frame_value_name[i];
        columns[VALUE_COLUMN(i)].required = false;
    }
    for (size_t i = 0; i < sizeof required / sizeof required[0]; i++) {
        columns[VALUE_COLUMN(required[i])].required = true;
    }
}

static bool has_value(const frame_reader_t *reader, int name) {
    return table_reader_has(reader->table, VALUE_COLUMN(name));
}

/* An image point needs both its columns, the size of a kind its sigma, and the jump of a reset the count, without which it would be
 * taken for motion. */
static void check_header(frame_reader_t *reader) {
    const unsigned long line = table_reader_header_line(reader->table);
    for (int u = FRAME_LEFT_U; u < FRAME_BOX_LEFT_PX; u += 2) {
        const int v = u + 1;
        if (has_value(reader, u) != has_value(reader, v)) {
            const int absent = has_value(reader, u) ? v : u;
            FAIL(reader, line, frame_value_name[absent], "missing column, the image point's other one is there");
        }
    }
    for (int size = FRAME_KIND_WIDTH_M; size <= FRAME_KIND_HEIGHT_M; size += 2) {
        const int sd = size + 1;
        if (has_value(reader, size) != has_value(reader, sd)) {
            FAIL(reader, line, frame_value_name[has_value(reader, size) ? sd : size],
                 "missing column, a size needs its sigma");
        }
    }
    for (int delta = FRAME_RESET_N_M; delta <= FRAME_RESET_D_M; delta++) {
        if (has_value(reader, delta) && !table_reader_has(reader->table, COLUMN_RESET_COUNT)) {
            FAIL(reader, line, FRAME_RESET_COUNT_NAME, "missing column, %s is there", frame_value_name[delta]);
        }
    }
}

/* ------------------------------------------------------------------------------------------------------------ rows -- */

static void store_time(frame_reader_t *reader, const table_field_t *field, frame_t *frame) {
    if (!number_parse(field->text, field->length, &frame->time_s)) {
        FAIL(reader, frame->line, FRAME_TIME_NAME, "'%s' is not a number", excerpt_of(field->text, field->length).text);
    } else if (field->length > FRAME_TIME_TEXT_MAX) {
        FAIL(reader, frame->line, FRAME_TIME_NAME, "longer than %d characters", FRAME_TIME_TEXT_MAX);
    } else {
        (void)memcpy(frame->time_text, field->text, field->length + 1u);
    }
}

static void store_integer(frame_reader_t *reader, const char *name, const table_field_t *field, const frame_t *frame,
                          int64_t *to) {
    if (!integer_parse(field->text, field->length, to)) {
        FAIL(reader, frame->line, name, "'%s' is not an integer of 64 bits",
             excerpt_of(field->text, field->length).text);
    }
}

/* An empty field is the first camera. */
static void store_camera(frame_reader_t *reader, const table_field_t *field, frame_t *frame) {
    int64_t number = 0;
    if (field->length > 0) {
        store_integer(reader, FRAME_CAMERA_NAME, field, frame, &number);
    }
    if (number < 0 || number >= reader->cameras) {
        FAIL(reader, frame->line, FRAME_CAMERA_NAME, "there is no camera %" PRId64 ", the camera file describes 0 %s",
             number, reader->cameras > 1 ? "and 1" : "alone");
    }
    frame->camera = number;
}

static void store_shape(frame_reader_t *reader, const table_field_t *field, frame_t *frame) {
    if (field->length > 0) {
        store_integer(reader, FRAME_KIND_SHAPE_NAME, field, frame, &frame->kind_shape);
    }
    if (frame->kind_shape < GOE_KIND_UNKNOWN || frame->kind_shape > GOE_KIND_OTHER) {
        FAIL(reader, frame->line, FRAME_KIND_SHAPE_NAME, "%" PRId64 " is no shape: 0 unknown, 1 round, 2 not round",
             frame->kind_shape);
    }
}

static void store_value(frame_reader_t *reader, int name, const table_field_t *field, frame_t *frame) {
    if (field->length == 0) {
        return; /* not measured */
    }
    if (!number_parse(field->text, field->length, &frame->value[name])) {
        FAIL(reader, frame->line, frame_value_name[name], "'%s' is not a number",
             excerpt_of(field->text, field->length).text);
        return;
    }
    frame->given[name] = true;
}

static void store_field(frame_reader_t *reader, const table_field_t *field, frame_t *frame) {
    switch (field->column) {
        case TABLE_STRANGER:
            break;
        case COLUMN_TIME:
            store_time(reader, field, frame);
            break;
        case COLUMN_ID:
            store_integer(reader, FRAME_ID_NAME, field, frame, &frame->id);
            break;
        case COLUMN_RESET_COUNT:
            if (field->length > 0) {
                store_integer(reader, FRAME_RESET_COUNT_NAME, field, frame, &frame->reset_count);
            }
            break;
        case COLUMN_CAMERA:
            store_camera(reader, field, frame);
            break;
        case COLUMN_KIND_SHAPE:
            store_shape(reader, field, frame);
            break;
        default:
            store_value(reader, field->column - COLUMN_VALUES, field, frame);
            break;
    }
}

/* The size of a kind and its sigma, which the estimator takes: a fault here is of the log, not of a measurement. */
static void check_size(frame_reader_t *reader, const frame_t *frame, int size) {
    const int sd = size + 1;
    for (int name = size; name <= sd; name++) {
        if (frame->given[name] && !(frame->value[name] >= 0.0 && frame->value[name] <= KIND_MAX_M)) {
            FAIL(reader, frame->line, frame_value_name[name], "%g is out of range: 0 to %g", frame->value[name],
                 KIND_MAX_M);
        }
    }
    const float size_m = frame->given[size] ? number_to_float(frame->value[size]) : 0.0f;
    const float sd_m = frame->given[sd] ? number_to_float(frame->value[sd]) : 0.0f;
    if (size_m > 0.0f && sd_m < KIND_SHARE_MIN * size_m) {
        FAIL(reader, frame->line, frame_value_name[sd], "%g is less than 1 %% of %s", (double)sd_m,
             frame_value_name[size]);
    }
}

static void store_row(frame_reader_t *reader, const table_row_t *row, frame_t *frame) {
    (void)memset(frame->given, 0, sizeof frame->given);
    frame->reset_count = 0;
    frame->camera = 0;
    frame->kind_shape = 0;
    frame->line = row->line;
    for (size_t i = 0; i < row->fields && !reader->failed; i++) {
        store_field(reader, &row->field[i], frame);
    }
    check_size(reader, frame, FRAME_KIND_WIDTH_M);
    check_size(reader, frame, FRAME_KIND_HEIGHT_M);
}

/* ------------------------------------------------------------------------------------------------------- interface -- */

frame_reader_t *frame_reader_open(const char *path, int cameras, input_error_t *error) {
    frame_reader_t *reader = calloc(1, sizeof *reader);
    if (reader != NULL) {
        reader->path = strdup(path);
    }
    if (reader == NULL || reader->path == NULL) {
        input_error_set(error, path, 0u, NULL, "out of memory");
        frame_reader_close(reader);
        return NULL;
    }
    reader->cameras = cameras;
    name_columns(reader->columns);
    reader->table = table_reader_open(path, reader->columns, COLUMNS_KNOWN, error);
    if (reader->table == NULL) {
        frame_reader_close(reader);
        return NULL;
    }
    check_header(reader);
    if (reader->failed) {
        *error = reader->error;
        frame_reader_close(reader);
        return NULL;
    }
    return reader;
}

frame_reader_result_t frame_reader_next(frame_reader_t *reader, frame_t *frame, input_error_t *error) {
    table_row_t row;
    const table_result_t result = reader->failed ? TABLE_ERROR : table_reader_next(reader->table, &row, &reader->error);
    reader->failed = result == TABLE_ERROR;
    if (result == TABLE_ROW) {
        store_row(reader, &row, frame);
    }
    if (reader->failed) {
        *error = reader->error;
        return FRAME_READER_ERROR;
    }
    return result == TABLE_ROW ? FRAME_READER_ROW : FRAME_READER_END;
}

double frame_reader_share(const frame_reader_t *reader) { return table_reader_share(reader->table); }

void frame_reader_print_misspelt(const frame_reader_t *reader, const char *program, FILE *stream) {
    const char *meant = NULL;
    size_t next = 0;
    for (const char *name = table_reader_misspelt(reader->table, &next, &meant); name != NULL;
         name = table_reader_misspelt(reader->table, &next, &meant)) {
        (void)fprintf(stream, "%s: warning: %s:%lu: %s: unknown column, ignored; did you mean %s?\n", program,
                      reader->path, table_reader_header_line(reader->table), excerpt_of(name, strlen(name)).text,
                      meant);
    }
}

void frame_reader_close(frame_reader_t *reader) {
    if (reader != NULL) {
        table_reader_close(reader->table);
        free(reader->path);
    }
    free(reader);
}
