/* Reads camera.ini. SPDX-License-Identifier: MIT */
#include "camera_file.h"

#include <ctype.h>
#include <errno.h>
#include <ini.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "number_text.h"

#define HEADING_AUTO "auto"
#define SMALLEST_SIZE_PX 1.0f

typedef enum { KIND_SIZE, KIND_REQUIRED, KIND_OPTIONAL, KIND_HEADING } kind_t;

typedef struct {
    const char *name;
    size_t offset; /* of the float in goe_settings_t */
    kind_t kind;
} camera_key_t;

#define AT(field) offsetof(goe_settings_t, field)
static const camera_key_t keys[] = {
    {"camera.width", AT(camera.width_px), KIND_SIZE},
    {"camera.height", AT(camera.height_px), KIND_SIZE},
    {"camera.fx", AT(camera.fx_px), KIND_REQUIRED},
    {"camera.fy", AT(camera.fy_px), KIND_REQUIRED},
    {"camera.cx", AT(camera.cx_px), KIND_REQUIRED},
    {"camera.cy", AT(camera.cy_px), KIND_REQUIRED},
    {"camera.k1", AT(camera.k1), KIND_OPTIONAL},
    {"camera.k2", AT(camera.k2), KIND_OPTIONAL},
    {"camera.p1", AT(camera.p1), KIND_OPTIONAL},
    {"camera.p2", AT(camera.p2), KIND_OPTIONAL},
    {"camera.k3", AT(camera.k3), KIND_OPTIONAL},
    {"camera.mount_roll_deg", AT(camera.mount_roll_deg), KIND_OPTIONAL},
    {"camera.mount_pitch_deg", AT(camera.mount_pitch_deg), KIND_OPTIONAL},
    {"camera.mount_yaw_deg", AT(camera.mount_yaw_deg), KIND_OPTIONAL},
    {"camera.offset_x_m", AT(camera.offset_m[0]), KIND_OPTIONAL},
    {"camera.offset_y_m", AT(camera.offset_m[1]), KIND_OPTIONAL},
    {"camera.offset_z_m", AT(camera.offset_m[2]), KIND_OPTIONAL},
    {"trajectory.heading_deg", AT(heading_deg), KIND_HEADING},
};
#undef AT
#define KEYS (sizeof keys / sizeof keys[0])

typedef struct {
    FILE *stream;
    const char *path;
    char *text; /* of the current line */
    size_t text_room;
    unsigned long line;
    unsigned long key_line[KEYS]; /* where a key was given; 0: nowhere */
    goe_settings_t settings;
    bool failed;
    input_error_t *error;
} camera_reader_t;

/* The first fault counts; what follows from it is not told. */
#define FAIL(reader, line, ...)                                                                                        \
    do {                                                                                                               \
        if (!(reader)->failed) {                                                                                       \
            (reader)->failed = true;                                                                                   \
            input_error_set((reader)->error, (reader)->path, line, __VA_ARGS__);                                       \
        }                                                                                                              \
    } while (0)

/* ----------------------------------------------------------------------------------------------------------- lines -- */

/* Text without its comment and without blanks (CR among them) at either end: the parser is left no chance to take an
 * indented line for the continuation of the one before. */
static char *trim(char *text) {
    text[strcspn(text, "#")] = '\0';
    while (isspace((unsigned char)*text)) {
        text++;
    }
    size_t length = strlen(text);
    while (length > 0 && isspace((unsigned char)text[length - 1u])) {
        length--;
    }
    text[length] = '\0';
    return text;
}

/* Sections, ';' comments and "key: value" are the parser's, not this format's. */
static void check_line(camera_reader_t *reader, const char *text) {
    const char *stranger = strpbrk(text, "[]:;");
    if (stranger != NULL) {
        FAIL(reader, reader->line, NULL, "unexpected '%c' in a line of the form: key = value # comment", *stranger);
    } else if (*text == '=' || (*text != '\0' && strchr(text, '=') == NULL)) {
        FAIL(reader, reader->line, NULL, "'%s' is not of the form: key = value", excerpt_of(text, strlen(text)).text);
    }
}

/* One line for the parser, in the manner of fgets(). Null ends the parsing: end of file, or a fault. */
static char *read_line(char *line, int size, void *user) {
    static const char mark[] = "\xef\xbb\xbf"; /* byte order mark */
    camera_reader_t *reader = user;
    const ssize_t length = reader->failed ? -1 : getline(&reader->text, &reader->text_room, reader->stream);
    if (length < 0) {
        return NULL;
    }
    reader->line++;
    if (strlen(reader->text) != (size_t)length) {
        FAIL(reader, reader->line, NULL, "the line holds a NUL byte");
        return NULL;
    }
    const bool marked = reader->line == 1 && strncmp(reader->text, mark, sizeof mark - 1u) == 0;
    const char *text = trim(reader->text + (marked ? sizeof mark - 1u : 0u));
    check_line(reader, text);
    if (strlen(text) >= (size_t)size) {
        FAIL(reader, reader->line, NULL, "the line is longer than %d characters", size - 1);
    }
    if (reader->failed) {
        return NULL;
    }
    (void)memcpy(line, text, strlen(text) + 1u);
    return line;
}

/* ------------------------------------------------------------------------------------------------------------ keys -- */

static void store(goe_settings_t *settings, const camera_key_t *key, float value) {
    (void)memcpy((char *)settings + key->offset, &value, sizeof value);
}

static float stored(const goe_settings_t *settings, const camera_key_t *key) {
    float value = 0.0f;
    (void)memcpy(&value, (const char *)settings + key->offset, sizeof value);
    return value;
}

static size_t key_index(const char *name) {
    size_t i = 0;
    while (i < KEYS && strcmp(keys[i].name, name) != 0) {
        i++;
    }
    return i;
}

static void store_text(camera_reader_t *reader, const camera_key_t *key, const char *text) {
    double number = 0.0;
    if (key->kind == KIND_HEADING) {
        reader->settings.heading_auto = strcmp(text, HEADING_AUTO) == 0;
        if (reader->settings.heading_auto) {
            return;
        }
    }
    if (number_parse(text, strlen(text), &number)) {
        store(&reader->settings, key, number_to_float(number));
    } else {
        FAIL(reader, reader->line, key->name, "'%s' is not a number%s", excerpt_of(text, strlen(text)).text,
             key->kind == KIND_HEADING ? " and not " HEADING_AUTO : "");
    }
}

/* The parser's call for one key; the section is always empty, see check_line(). */
static int on_key(void *user, const char *section, const char *name, const char *text) {
    (void)section;
    camera_reader_t *reader = user;
    const size_t i = key_index(name);
    if (i == KEYS) {
        FAIL(reader, reader->line, name, "unknown key");
    } else if (reader->key_line[i] != 0) {
        FAIL(reader, reader->line, name, "the key appears twice, first in line %lu", reader->key_line[i]);
    } else {
        reader->key_line[i] = reader->line;
        store_text(reader, &keys[i], text);
    }
    return !reader->failed;
}

/* ---------------------------------------------------------------------------------------------------------- checks -- */

static bool key_missing(const camera_reader_t *reader, size_t i) {
    return (keys[i].kind == KIND_SIZE || keys[i].kind == KIND_REQUIRED) && reader->key_line[i] == 0;
}

/* The ranges are the library's own: the key is tried alone, on top of settings that are known to be good. */
static bool value_accepted(const camera_key_t *key, float value) {
    if (key->kind == KIND_SIZE && value < SMALLEST_SIZE_PX) {
        return false;
    }
    goe_settings_t trial;
    goe_estimator_t estimator;
    (void)memset(&estimator, 0, sizeof estimator);
    goe_settings_default(&trial);
    trial.camera.fx_px = 1.0f;
    trial.camera.fy_px = 1.0f;
    trial.heading_auto = false;
    store(&trial, key, value);
    return goe_init(&estimator, sizeof estimator, &trial, NULL) == GOE_OK;
}

static void check_keys(camera_reader_t *reader) {
    for (size_t i = 0; i < KEYS; i++) {
        if (key_missing(reader, i)) {
            FAIL(reader, reader->line == 0 ? 1u : reader->line, keys[i].name, "missing key, not found up to here");
        } else if (!value_accepted(&keys[i], stored(&reader->settings, &keys[i]))) {
            FAIL(reader, reader->key_line[i], keys[i].name, "out of range");
        }
    }
}

/* ------------------------------------------------------------------------------------------------------- interface -- */

static void read_keys(camera_reader_t *reader) {
    reader->stream = fopen(reader->path, "r");
    if (reader->stream == NULL) {
        FAIL(reader, 0u, NULL, "cannot be opened: %s", strerror(errno));
        return;
    }
    errno = 0;
    const int parser_line = ini_parse_stream(read_line, reader, on_key, reader);
    if (ferror(reader->stream) != 0) {
        FAIL(reader, 0u, NULL, "cannot be read: %s", strerror(errno));
    } else if (parser_line != 0) {
        FAIL(reader, parser_line > 0 ? (unsigned long)parser_line : 0u, NULL, "cannot be understood");
    }
    (void)fclose(reader->stream);
}

bool camera_file_read(const char *path, goe_settings_t *settings, input_error_t *error) {
    camera_reader_t reader;
    (void)memset(&reader, 0, sizeof reader);
    reader.path = path;
    reader.error = error;
    reader.settings = *settings;
    read_keys(&reader);
    free(reader.text);
    if (!reader.failed) {
        check_keys(&reader);
    }
    if (reader.failed) {
        return false;
    }
    *settings = reader.settings;
    return true;
}
