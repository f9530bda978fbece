/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "recorded_flight.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "number_text.h"
#include "table_reader.h"

#define NORM_TOLERANCE 0.01
#define TIME_LIMIT_S 9.2e12 /* ranges as those of a log's frames.csv */
#define POSITION_LIMIT_M 1.0e6
#define FIRST_CAPACITY 1024u

enum { COLUMN_TIME = 0, COLUMN_TRUTH = 1, COLUMN_ESTIMATE = 8, COLUMNS = 15 };

/* In the order of a row's values: time, then position and quaternion, twice. */
static const table_column_t columns[COLUMNS] = {
    {"t_s", true},     {"true_n_m", true}, {"true_e_m", true}, {"true_d_m", true}, {"true_qw", true},
    {"true_qx", true}, {"true_qy", true},  {"true_qz", true},  {"est_n_m", true},  {"est_e_m", true},
    {"est_d_m", true}, {"est_qw", true},   {"est_qx", true},   {"est_qy", true},   {"est_qz", true}};

typedef struct {
    const char *path;
    recorded_flight_t *flight;
    unsigned long line;
    double value[COLUMNS];
    double first_t_s;
    bool failed;
    input_error_t *error;
} reader_t;

/* The first fault of a file ends the reading. */
#define FAIL(reader, ...)                                                                                              \
    input_error_first(&(reader)->failed, (reader)->error, (reader)->path, (reader)->line, __VA_ARGS__)

/* Quaternions are held by their norm. */
static double limit_of(int column) {
    if (column == COLUMN_TIME) {
        return TIME_LIMIT_S;
    }
    return (column - COLUMN_TRUTH) % (COLUMN_ESTIMATE - COLUMN_TRUTH) < 3 ? POSITION_LIMIT_M : (double)INFINITY;
}

static void take_number(reader_t *reader, const table_field_t *field) {
    double value = 0.0;
    const char *name = columns[field->column].name;
    if (!number_parse(field->text, field->length, &value) || !isfinite(value)) {
        FAIL(reader, name, "'%s' is not a finite number", excerpt_of(field->text, field->length).text);
    } else if (fabs(value) > limit_of(field->column)) {
        FAIL(reader, name, "%g is out of range: %g to %g", value, -limit_of(field->column), limit_of(field->column));
    }
    reader->value[field->column] = value;
}

static pose_t pose_of(reader_t *reader, int first) {
    pose_t pose;
    const double *value = &reader->value[first];
    pose.position_ned_m.x = value[0];
    pose.position_ned_m.y = value[1];
    pose.position_ned_m.z = value[2];
    const quat_t q = {value[3], value[4], value[5], value[6]};
    if (!(fabs(sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z) - 1.0) <= NORM_TOLERANCE)) {
        FAIL(reader, columns[first + 3].name, "norm of the quaternion is off 1 by more than 1 %%");
    }
    pose.attitude = quat_normalized(q);
    return pose;
}

static void append(reader_t *reader, const recorded_pose_t *pose) {
    recorded_flight_t *flight = reader->flight;
    if (flight->count == RECORDED_POSES_MAX) {
        FAIL(reader, NULL, "more than %u poses", RECORDED_POSES_MAX);
        return;
    }
    if (flight->count == flight->capacity) {
        const size_t capacity = flight->capacity > 0 ? 2 * flight->capacity : FIRST_CAPACITY;
        recorded_pose_t *grown = realloc(flight->poses, capacity * sizeof *grown);
        if (grown == NULL) {
            FAIL(reader, NULL, "out of memory");
            return;
        }
        flight->poses = grown;
        flight->capacity = capacity;
    }
    flight->poses[flight->count++] = *pose;
}

static void take_row(reader_t *reader, const table_row_t *row) {
    const recorded_flight_t *flight = reader->flight;
    recorded_pose_t pose;
    reader->line = row->line;
    for (size_t i = 0; i < row->fields && !reader->failed; i++) {
        if (row->field[i].column != TABLE_STRANGER) {
            take_number(reader, &row->field[i]);
        }
    }
    if (reader->failed) {
        return;
    }
    if (flight->count == 0) {
        reader->first_t_s = reader->value[COLUMN_TIME];
    }
    pose.t_s = reader->value[COLUMN_TIME] - reader->first_t_s;
    if (flight->count > 0 && !(pose.t_s > flight->poses[flight->count - 1].t_s)) {
        FAIL(reader, columns[COLUMN_TIME].name, "time does not increase");
    }
    pose.truth = pose_of(reader, COLUMN_TRUTH);
    pose.estimated = pose_of(reader, COLUMN_ESTIMATE);
    if (!reader->failed) {
        append(reader, &pose);
    }
}

static void read_rows(reader_t *reader, table_reader_t *table) {
    table_row_t row;
    table_result_t result = TABLE_ROW;
    while (!reader->failed && (result = table_reader_next(table, &row, reader->error)) == TABLE_ROW) {
        take_row(reader, &row);
    }
    reader->failed = reader->failed || result == TABLE_ERROR;
    if (reader->flight->count < 2) {
        FAIL(reader, NULL, "fewer than two poses");
    }
}

bool recorded_flight_read(const char *path, recorded_flight_t *flight, input_error_t *error) {
    reader_t reader;
    memset(&reader, 0, sizeof reader);
    memset(flight, 0, sizeof *flight);
    reader.path = path;
    reader.flight = flight;
    reader.error = error;
    table_reader_t *table = table_reader_open(path, columns, COLUMNS, error);
    if (table == NULL) {
        return false;
    }
    reader.line = table_reader_header_line(table);
    read_rows(&reader, table);
    table_reader_close(table);
    if (reader.failed) {
        recorded_flight_free(flight);
    }
    return !reader.failed;
}

void recorded_flight_free(recorded_flight_t *flight) {
    free(flight->poses);
    memset(flight, 0, sizeof *flight);
}

double recorded_flight_duration(const recorded_flight_t *flight) {
    return flight->count > 0 ? flight->poses[flight->count - 1].t_s : 0.0;
}

static pose_t between(const pose_t *a, const pose_t *b, double fraction) {
    pose_t pose;
    pose.position_ned_m =
        vec3_add(vec3_scale(a->position_ned_m, 1.0 - fraction), vec3_scale(b->position_ned_m, fraction));
    pose.attitude = quat_interpolate(a->attitude, b->attitude, fraction);
    return pose;
}

recorded_pose_t recorded_flight_at(const recorded_flight_t *flight, double t_s) {
    size_t low = 0, high = flight->count - 1;
    if (t_s <= flight->poses[low].t_s) {
        return flight->poses[low];
    }
    if (t_s >= flight->poses[high].t_s) {
        return flight->poses[high];
    }
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        if (flight->poses[middle].t_s <= t_s) {
            low = middle;
        } else {
            high = middle;
        }
    }
    const recorded_pose_t *a = &flight->poses[low], *b = &flight->poses[high];
    const double fraction = (t_s - a->t_s) / (b->t_s - a->t_s);
    recorded_pose_t pose;
    pose.t_s = t_s;
    pose.truth = between(&a->truth, &b->truth, fraction);
    pose.estimated = between(&a->estimated, &b->estimated, fraction);
    return pose;
}
