/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "recorded_flight.h"

#include <csv.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define COLUMNS 15
#define MOST_FIELDS 64
#define NORM_TOLERANCE 0.01
#define NAME_SIZE 32

static const char *const COLUMN_NAMES[COLUMNS] = {"t_s",     "true_n_m", "true_e_m", "true_d_m", "true_qw",
                                                  "true_qx", "true_qy",  "true_qz",  "est_n_m",  "est_e_m",
                                                  "est_d_m", "est_qw",   "est_qx",   "est_qy",   "est_qz"};

typedef struct {
    const char *path;
    recorded_flight_t *flight;
    char *fault;
    size_t fault_size;
    size_t line, field;               /* line from 1 */
    int column_of_field[MOST_FIELDS]; /* -1: not needed */
    bool found[COLUMNS], filled[COLUMNS];
    double value[COLUMNS];
    double first_t_s;
} reader_t;

static void fail(reader_t *reader, const char *column, const char *reason) {
    if (reader->fault[0] == '\0') {
        (void)snprintf(reader->fault, reader->fault_size, "%s:%zu: %s: %s", reader->path, reader->line, column, reason);
    }
}

static void take_name(reader_t *reader, const char *name) {
    if (reader->field >= MOST_FIELDS) {
        fail(reader, "-", "more than 64 columns");
        return;
    }
    reader->column_of_field[reader->field] = -1;
    for (int i = 0; i < COLUMNS; i++) {
        if (strcmp(name, COLUMN_NAMES[i]) == 0) {
            if (reader->found[i]) {
                fail(reader, COLUMN_NAMES[i], "column appears twice");
            }
            reader->found[i] = true;
            reader->column_of_field[reader->field] = i;
        }
    }
}

static void take_number(reader_t *reader, const char *text) {
    const int column = reader->field < MOST_FIELDS ? reader->column_of_field[reader->field] : -1;
    if (column < 0) {
        return;
    }
    char *end;
    reader->value[column] = strtod(text, &end);
    if (end == text || *end != '\0' || !isfinite(reader->value[column])) {
        fail(reader, COLUMN_NAMES[column], "not a finite number");
    }
    reader->filled[column] = true;
}

static void on_field(void *text, size_t length, void *context) {
    reader_t *reader = context;
    char field[NAME_SIZE * 2];
    const size_t kept = length < sizeof field - 1 ? length : sizeof field - 1;
    if (kept > 0) {
        memcpy(field, text, kept);
    }
    field[kept] = '\0';
    if (reader->line == 1) {
        take_name(reader, field);
    } else {
        take_number(reader, field);
    }
    reader->field++;
}

static pose_t pose_of(reader_t *reader, const double *value, const char *name) {
    pose_t pose;
    pose.position_ned_m.x = value[0];
    pose.position_ned_m.y = value[1];
    pose.position_ned_m.z = value[2];
    const quat_t q = {value[3], value[4], value[5], value[6]};
    if (fabs(sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z) - 1.0) > NORM_TOLERANCE) {
        fail(reader, name, "norm of the quaternion is off 1 by more than 1 %");
    }
    pose.attitude = quat_normalised(q);
    return pose;
}

static void append(reader_t *reader, const recorded_pose_t *pose) {
    recorded_flight_t *flight = reader->flight;
    if (flight->count == flight->capacity) {
        const size_t capacity = flight->capacity > 0 ? 2 * flight->capacity : 1024;
        recorded_pose_t *grown = realloc(flight->poses, capacity * sizeof *grown);
        if (grown == NULL) {
            fail(reader, "-", "out of memory");
            return;
        }
        flight->poses = grown;
        flight->capacity = capacity;
    }
    flight->poses[flight->count++] = *pose;
}

static void end_header(reader_t *reader) {
    for (int i = 0; i < COLUMNS; i++) {
        if (!reader->found[i]) {
            fail(reader, COLUMN_NAMES[i], "column is missing");
        }
    }
}

static void end_values(reader_t *reader) {
    const recorded_flight_t *flight = reader->flight;
    for (int i = 0; i < COLUMNS; i++) {
        if (!reader->filled[i]) {
            fail(reader, COLUMN_NAMES[i], "field is missing");
            return;
        }
        reader->filled[i] = false;
    }
    if (flight->count == 0) {
        reader->first_t_s = reader->value[0];
    }
    recorded_pose_t pose;
    pose.t_s = reader->value[0] - reader->first_t_s;
    if (flight->count > 0 && !(pose.t_s > flight->poses[flight->count - 1].t_s)) {
        fail(reader, "t_s", "time does not increase");
    }
    pose.truth = pose_of(reader, &reader->value[1], "true_qw");
    pose.estimated = pose_of(reader, &reader->value[8], "est_qw");
    if (reader->fault[0] == '\0') {
        append(reader, &pose);
    }
}

static void on_row(int terminator, void *context) {
    (void)terminator;
    reader_t *reader = context;
    if (reader->line == 1) {
        end_header(reader);
    } else if (reader->fault[0] == '\0') {
        end_values(reader);
    }
    reader->field = 0;
    reader->line++;
}

static void parse(reader_t *reader, FILE *file) {
    struct csv_parser parser;
    if (csv_init(&parser, CSV_APPEND_NULL) != 0) {
        fail(reader, "-", "out of memory");
        return;
    }
    char block[65536];
    size_t length = sizeof block;
    while (reader->fault[0] == '\0' && length == sizeof block) {
        length = fread(block, 1, sizeof block, file);
        if (csv_parse(&parser, block, length, on_field, on_row, reader) != length) {
            fail(reader, "-", csv_strerror(csv_error(&parser)));
        }
    }
    if (reader->fault[0] == '\0') {
        (void)csv_fini(&parser, on_field, on_row, reader);
    }
    csv_free(&parser);
    if (ferror(file)) {
        fail(reader, "-", "read error");
    } else if (reader->flight->count < 2) {
        fail(reader, "-", "fewer than two poses");
    }
}

bool recorded_flight_read(const char *path, recorded_flight_t *flight, char *fault, size_t fault_size) {
    reader_t reader;
    memset(&reader, 0, sizeof reader);
    memset(flight, 0, sizeof *flight);
    fault[0] = '\0';
    reader.path = path;
    reader.flight = flight;
    reader.fault = fault;
    reader.fault_size = fault_size;
    reader.line = 1;
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        (void)snprintf(fault, fault_size, "%s: %s", path, strerror(errno));
        return false;
    }
    parse(&reader, file);
    (void)fclose(file);
    if (fault[0] != '\0') {
        recorded_flight_free(flight);
        return false;
    }
    return true;
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
