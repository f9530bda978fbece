/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "scenario_file.h"

#include <ctype.h>
#include <errno.h>
#include <ini.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "text_numbers.h"

#define SECTION_FLIGHT "flight"
#define SECTION_OBSTACLE "obstacle "

typedef struct {
    FILE *stream;
    const char *path;
    char *text; /* of the current line */
    size_t text_room;
    unsigned long line;
    scenario_option_t option;
    scenario_file_t *scenario;
    bool has_shape[SCENARIO_NEIGHBOURS_MAX];
    unsigned long begin[SCENARIO_NEIGHBOURS_MAX]; /* line of its first key */
    bool failed;
    char *fault;
    size_t fault_size;
} scenario_reader_t;

#if defined(__GNUC__) || defined(__clang__)
__attribute__((format(printf, 3, 4)))
#endif
static void
fail(scenario_reader_t *reader, const char *key, const char *format, ...) {
    if (reader->failed) {
        return;
    }
    reader->failed = true;
    char reason[SCENARIO_REASON_MAX];
    va_list values;
    va_start(values, format);
    (void)vsnprintf(reason, sizeof reason, format, values);
    va_end(values);
    (void)snprintf(reader->fault, reader->fault_size, "%s:%lu: %s%s%s", reader->path, reader->line,
                   key != NULL ? key : "", key != NULL ? ": " : "", reason);
}

/* One line for the parser, without comment and blanks, so that it takes none for a continuation. */
static char *read_line(char *line, int size, void *user) {
    scenario_reader_t *reader = user;
    const ssize_t read = reader->failed ? -1 : getline(&reader->text, &reader->text_room, reader->stream);
    if (read < 0) {
        return NULL;
    }
    reader->line++;
    char *begin = reader->text;
    begin[strcspn(begin, "#;\n\r")] = '\0';
    while (isspace((unsigned char)*begin)) {
        begin++;
    }
    if (strlen(reader->text) + 2u > (size_t)size) {
        fail(reader, NULL, "the line is longer than %d characters", size - 2);
    } else if (*begin != '\0' && *begin != '[' && strchr(begin, '=') == NULL) {
        fail(reader, NULL, "a line is [section] or key = value");
    }
    if (reader->failed) {
        return NULL;
    }
    (void)snprintf(line, (size_t)size, "%s\n", begin);
    return line;
}

/* Number of an "obstacle N"; 0: it is none. */
static int obstacle_number(const char *section) {
    double number = 0.0;
    if (!text_numbers(section, SECTION_OBSTACLE, &number, 1) || number > (double)(SCENARIO_NEIGHBOURS_MAX + 1)) {
        return 0;
    }
    return number >= 1.0 && floor(number) >= number ? (int)number : 0;
}

static void take_option(scenario_reader_t *reader, const char *key, const char *name, const char *value) {
    char reason[SCENARIO_REASON_MAX];
    if (!reader->option(name, value, reason)) {
        fail(reader, key, "%s", reason);
    }
}

static void take_first(scenario_reader_t *reader, const char *key, const char *value) {
    if (strcmp(key, "what") == 0) {
        take_option(reader, key, "obstacle", value);
    } else if (strcmp(key, "x0") == 0 || strcmp(key, "z0") == 0 || strcmp(key, "alpha") == 0) {
        take_option(reader, key, key, value);
    } else {
        fail(reader, key, "an obstacle has what, x0, z0 and alpha");
    }
}

static void take_number(scenario_reader_t *reader, const char *key, const char *value, double *number) {
    if (!text_numbers(value, "", number, 1)) {
        fail(reader, key, "'%s' is not a number", value);
    }
}

static void take_neighbour(scenario_reader_t *reader, int i, const char *key, const char *value) {
    neighbour_t *neighbour = &reader->scenario->neighbour[i];
    if (i >= reader->scenario->neighbours) {
        if (i > reader->scenario->neighbours) {
            fail(reader, key, "obstacle %d comes before obstacle %d", i + 2, reader->scenario->neighbours + 2);
            return;
        }
        reader->scenario->neighbours = i + 1;
        reader->begin[i] = reader->line;
        neighbour->z0_m = (double)NAN;
    }
    if (strcmp(key, "what") == 0) {
        reader->has_shape[i] = obstacle_parse(value, &neighbour->obstacle);
        if (!reader->has_shape[i]) {
            fail(reader, key, "'%s' is not %s", value, OBSTACLE_FORMS);
        }
    } else if (strcmp(key, "x0") == 0) {
        take_number(reader, key, value, &neighbour->x0_m);
    } else if (strcmp(key, "z0") == 0) {
        take_number(reader, key, value, &neighbour->z0_m);
    } else if (strcmp(key, "alpha") == 0) {
        take_number(reader, key, value, &neighbour->alpha_deg);
    } else {
        fail(reader, key, "an obstacle has what, x0, z0 and alpha");
    }
}

/* The parser's call for one key. */
static int on_key(void *user, const char *section, const char *key, const char *value) {
    scenario_reader_t *reader = user;
    const int number = obstacle_number(section);
    if (strcmp(section, SECTION_FLIGHT) == 0) {
        take_option(reader, key, key, value);
    } else if (number == 1) {
        take_first(reader, key, value);
    } else if (number > 1) {
        take_neighbour(reader, number - 2, key, value);
    } else {
        fail(reader, key, "[%s] is neither [flight] nor [obstacle 1] to [obstacle %d]", section,
             SCENARIO_NEIGHBOURS_MAX + 1);
    }
    return !reader->failed;
}

static void check_neighbours(scenario_reader_t *reader) {
    for (int i = 0; i < reader->scenario->neighbours; i++) {
        const char *reason = neighbour_fault(&reader->scenario->neighbour[i]);
        if (!reader->has_shape[i]) {
            reason = "what it is, is missing";
        } else if (isnan(reader->scenario->neighbour[i].z0_m)) {
            reason = "z0 is missing";
        }
        if (reason != NULL) {
            reader->line = reader->failed ? reader->line : reader->begin[i];
            fail(reader, NULL, "[obstacle %d]: %s", i + 2, reason);
        }
    }
}

bool scenario_file_read(const char *path, scenario_option_t option, scenario_file_t *scenario, char *fault,
                        size_t fault_size) {
    scenario_reader_t reader;
    memset(&reader, 0, sizeof reader);
    memset(scenario, 0, sizeof *scenario);
    reader.path = path;
    reader.option = option;
    reader.scenario = scenario;
    reader.fault = fault;
    reader.fault_size = fault_size;
    reader.stream = fopen(path, "r");
    if (reader.stream == NULL) {
        (void)snprintf(fault, fault_size, "%s: cannot be opened: %s", path, strerror(errno));
        return false;
    }
    errno = 0;
    if (ini_parse_stream(read_line, &reader, on_key, &reader) != 0 && !reader.failed) {
        fail(&reader, NULL, "cannot be understood");
    }
    if (ferror(reader.stream) != 0 && !reader.failed) {
        fail(&reader, NULL, "cannot be read: %s", strerror(errno));
    }
    (void)fclose(reader.stream);
    free(reader.text);
    check_neighbours(&reader);
    return !reader.failed;
}
