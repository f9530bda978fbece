/* Copyright (c) 2026 the goe authors. SPDX-License-Identifier: MIT */
#include "scenario_file.h"

#include <errno.h>
#include <ini.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "ini_lines.h"
#include "text_numbers.h"

#define SECTION_FLIGHT "flight"
#define SECTION_OBSTACLE "obstacle "

/* Keys of an obstacle. */
enum { KEY_KIND, KEY_X0, KEY_Z0, KEY_ALPHA, OBSTACLE_KEYS };
static const char *const KEY_NAMES[OBSTACLE_KEYS] = {"what", "x0", "z0", "alpha"};

typedef struct {
    ini_lines_t lines;
    const char *path;
    scenario_option_t option;
    scenario_file_t *scenario;
    unsigned long line_of[SCENARIO_NEIGHBORS_MAX + 1]
                         [OBSTACLE_KEYS]; /* where each obstacle's key was given; 0: nowhere */
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
    (void)snprintf(reader->fault, reader->fault_size, "%s:%lu: %s%s%s", reader->path, reader->lines.number,
                   key != NULL ? key : "", key != NULL ? ": " : "", reason);
}

static char *read_line(char *line, int size, void *user) {
    scenario_reader_t *reader = user;
    const char *fault = NULL;
    const char *text = reader->failed ? NULL : ini_lines_next(&reader->lines, &fault);
    if (fault != NULL) {
        fail(reader, NULL, "%s", fault);
    }
    if (text == NULL) {
        return NULL;
    }
    if (strlen(text) + 2u > (size_t)size) {
        fail(reader, NULL, "the line is longer than %d characters", size - 2);
    } else if (*text == '[' ? strchr(text, ']') == NULL : *text != '\0' && strchr(text, '=') == NULL) {
        fail(reader, NULL, "a line is [section] or key = value");
    }
    if (reader->failed) {
        return NULL;
    }
    (void)snprintf(line, (size_t)size, "%s\n", text);
    return line;
}

/* Number of an "obstacle N"; 0: it is none. */
static int obstacle_number(const char *section) {
    double number = 0.0;
    if (!text_numbers(section, SECTION_OBSTACLE, &number, 1) || number > (double)(SCENARIO_NEIGHBORS_MAX + 1)) {
        return 0;
    }
    return number >= 1.0 && floor(number) >= number ? (int)number : 0;
}

/* Where an obstacle, from 0, was first given a key; 0: nowhere. */
static unsigned long first_line(const scenario_reader_t *reader, int obstacle) {
    unsigned long first = 0;
    for (int key = 0; key < OBSTACLE_KEYS; key++) {
        const unsigned long line = reader->line_of[obstacle][key];
        first = line != 0 && (first == 0 || line < first) ? line : first;
    }
    return first;
}

static void take_option(scenario_reader_t *reader, const char *key, const char *name, const char *value) {
    char reason[SCENARIO_REASON_MAX];
    if (*value == '\0') {
        fail(reader, key, "no value");
    } else if (!reader->option(name, value, reader->lines.number, reason)) {
        fail(reader, key, "%s", reason);
    }
}

/* The first obstacle is the command line's. */
static void take_first(scenario_reader_t *reader, int key, const char *value) {
    obstacle_t shape;
    if (key == KEY_KIND && !obstacle_parse(value, &shape)) {
        fail(reader, KEY_NAMES[key], "'%s' is not %s", value, OBSTACLE_FORMS);
    } else {
        take_option(reader, KEY_NAMES[key], key == KEY_KIND ? "obstacle" : KEY_NAMES[key], value);
    }
}

static void take_neighbor(scenario_reader_t *reader, int i, int key, const char *value) {
    neighbor_t *neighbor = &reader->scenario->neighbor[i];
    double *const numbers[OBSTACLE_KEYS] = {NULL, &neighbor->x0_m, &neighbor->z0_m, &neighbor->alpha_deg};
    if (i >= reader->scenario->neighbors) {
        reader->scenario->neighbors = i + 1;
        neighbor->z0_m = (double)NAN;
    }
    if (key == KEY_KIND && !obstacle_parse(value, &neighbor->obstacle)) {
        fail(reader, KEY_NAMES[key], "'%s' is not %s", value, OBSTACLE_FORMS);
    } else if (key != KEY_KIND && !text_numbers(value, "", numbers[key], 1)) {
        fail(reader, KEY_NAMES[key], "'%s' is not a number", value);
    } else if (key == KEY_X0) {
        neighbor->x0_m = 0.0 - neighbor->x0_m; /* as --x0, right is positive; in a case, left */
    }
}

static void take_obstacle(scenario_reader_t *reader, int number, const char *name, const char *value) {
    int key = 0;
    while (key < OBSTACLE_KEYS && strcmp(KEY_NAMES[key], name) != 0) {
        key++;
    }
    unsigned long *lines = reader->line_of[number - 1];
    if (key == OBSTACLE_KEYS) {
        fail(reader, name, "an obstacle has what, x0, z0 and alpha");
    } else if (lines[key] != 0) {
        fail(reader, name, "[obstacle %d] has it twice, first in line %lu", number, lines[key]);
    } else if (number > reader->scenario->neighbors + 2 || (number == 2 && first_line(reader, 0) == 0)) {
        fail(reader, name, "obstacle %d comes before obstacle %d", number, number - 1);
    } else if (number == 1) {
        take_first(reader, key, value);
    } else {
        take_neighbor(reader, number - 2, key, value);
    }
    if (key < OBSTACLE_KEYS) {
        lines[key] = reader->lines.number;
    }
}

/* The parser's call for one key. */
static int on_key(void *user, const char *section, const char *key, const char *value) {
    scenario_reader_t *reader = user;
    const int number = obstacle_number(section);
    if (strcmp(section, SECTION_FLIGHT) == 0) {
        take_option(reader, key, key, value);
    } else if (number > 0) {
        take_obstacle(reader, number, key, value);
    } else {
        fail(reader, key, "[%s] is neither [flight] nor [obstacle 1] to [obstacle %d]", section,
             SCENARIO_NEIGHBORS_MAX + 1);
    }
    return !reader->failed;
}

static void check_neighbors(scenario_reader_t *reader) {
    for (int i = 0; i < reader->scenario->neighbors && !reader->failed; i++) {
        const unsigned long *lines = reader->line_of[i + 1];
        const char *reason = neighbor_fault(&reader->scenario->neighbor[i]);
        if (lines[KEY_KIND] == 0) {
            reason = "the kind of obstacle (what) is missing";
        } else if (lines[KEY_Z0] == 0) {
            reason = "z0 is missing";
        }
        if (reason != NULL) {
            reader->lines.number = first_line(reader, i + 1);
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
    reader.lines.stream = fopen(path, "r");
    if (reader.lines.stream == NULL) {
        (void)snprintf(fault, fault_size, "%s: cannot be opened: %s", path, strerror(errno));
        return false;
    }
    errno = 0;
    const int parser_line = ini_parse_stream(read_line, &reader, on_key, &reader);
    if (ferror(reader.lines.stream) != 0) {
        fail(&reader, NULL, "cannot be read: %s", strerror(errno));
    } else if (parser_line > 0) {
        reader.lines.number = reader.failed ? reader.lines.number : (unsigned long)parser_line;
        fail(&reader, NULL, "cannot be understood");
    }
    (void)fclose(reader.lines.stream);
    check_neighbors(&reader);
    return !reader.failed;
}
