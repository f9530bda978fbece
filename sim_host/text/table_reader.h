/* Rows of a CSV file with a header line, in bounded memory: the common part of all tables that the programs read.
 * SPDX-License-Identifier: MIT */
#ifndef TABLE_READER_H
#define TABLE_READER_H

#include <stdbool.h>
#include <stddef.h>

#include "input_error.h"

#define TABLE_ROW_BYTES_MAX (1024u * 1024u) /* bounds the memory that an unclosed quote can take */
#define TABLE_COLUMNS_MAX 4096u
#define TABLE_STRANGER (-1)

typedef struct table_reader table_reader_t;

/* A column that the caller reads; a file may have others. */
typedef struct {
    const char *name;
    bool required;
} table_column_t;

typedef struct {
    const char *text; /* without the blanks around it; holds no NUL and ends in one */
    size_t length;
    int column; /* index among the caller's columns, or TABLE_STRANGER */
} table_field_t;

typedef struct {
    const table_field_t *field; /* as many as the header has; they live until the next call */
    size_t fields;
    unsigned long line; /* on which the row begins, from 1 */
} table_row_t;

typedef enum {
    TABLE_ROW,  /* *row holds the next row */
    TABLE_END,  /* no more rows */
    TABLE_ERROR /* *error gives the fault and its position; every further call returns it again */
} table_result_t;

/* Opens a file and reads its header line; the columns must outlive the reader. Null on failure, and *error gives the
 * reason: the file is unreadable, a required column is missing, one of the columns is there twice. It also suggests the probable name:
 * another delimiter, a mistyped name.
 *
 * Blank lines and a byte order mark are passed over. Rows end in LF, also CR LF, the last one too: a row at whose end the file
 * ends may have been cut off within its last number. */
table_reader_t *table_reader_open(const char *path, const table_column_t *columns, size_t count, input_error_t *error);

/* Whether the file has a column of the caller's. */
bool table_reader_has(const table_reader_t *reader, size_t column);

/* Columns of the file that are none of the caller's, but are named nearly as one of the caller's that the file lacks: from *next on,
 * which is 0 at first. Null: no more. */
const char *table_reader_misspelt(const table_reader_t *reader, size_t *next, const char **meant);

/* Line of the header; 1 if the file is empty. */
unsigned long table_reader_header_line(const table_reader_t *reader);

/* How much of the file is read, 0 to 1; less than 0: not known, as of a pipe. */
double table_reader_share(const table_reader_t *reader);

table_result_t table_reader_next(table_reader_t *reader, table_row_t *row, input_error_t *error);

/* Null is ignored. */
void table_reader_close(table_reader_t *reader);

#endif
