/* Reads camera.ini. SPDX-License-Identifier: MIT */
#include "camera_file.h"

#include <errno.h>
#include <ini.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "ini_lines.h"
#include "nearest_name.h"
#include "number_text.h"
#include "settings_text.h"

#define HEADING_AUTO "auto"
#define SMALLEST_SIZE_PX 1.0f
#define LONGEST_FOCAL_PX 1.0e5f

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

/* The second camera has the keys of the first, which begin otherwise, and its settings lie so much farther on. */
#define CAMERAS 2
#define SECOND_NAME "camera2"
#define SECOND_OFFSET (offsetof(goe_settings_t, more_cameras) - offsetof(goe_settings_t, camera))

typedef struct {
    char text[32];
} key_name_t;

typedef struct {
    ini_lines_t lines;
    const char *path;
    unsigned long key_line[CAMERAS][KEYS]; /* where a key was given; 0: nowhere */
    size_t cameras;                        /* of which any key was given; the first is always asked for */
    goe_settings_t settings;
    bool failed;
    input_error_t *error;
} camera_reader_t;

/* The first fault counts; faults that follow from it are not reported. */
#define FAIL(reader, line, ...)                                                                                        \
    do {                                                                                                               \
        if (!(reader)->failed) {                                                                                       \
            (reader)->failed = true;                                                                                   \
            input_error_set((reader)->error, (reader)->path, line, __VA_ARGS__);                                       \
        }                                                                                                              \
    } while (0)

/* ----------------------------------------------------------------------------------------------------------- lines -- */

/* Sections, ';' comments and "key: value" are the parser's, not this format's. */
static void check_line(camera_reader_t *reader, const char *text) {
    const char *stranger = strpbrk(text, "[]:;");
    if (stranger != NULL) {
        FAIL(reader, reader->lines.number, NULL, "unexpected '%c' in a line of the form: key = value # comment",
             *stranger);
    } else if (*text == '=' || (*text != '\0' && strchr(text, '=') == NULL)) {
        FAIL(reader, reader->lines.number, NULL, "'%s' is not of the form: key = value",
             excerpt_of(text, strlen(text)).text);
    }
}

/* One line for the parser, in the manner of fgets(). Null ends the parsing: end of file, or a fault. */
static char *read_line(char *line, int size, void *user) {
    camera_reader_t *reader = user;
    const char *fault = NULL;
    const char *text = reader->failed ? NULL : ini_lines_next(&reader->lines, &fault);
    if (fault != NULL) {
        FAIL(reader, reader->lines.number, NULL, "%s", fault);
    }
    if (text == NULL) {
        return NULL;
    }
    check_line(reader, text);
    if (strlen(text) >= (size_t)size) {
        FAIL(reader, reader->lines.number, NULL, "the line is longer than %d characters", size - 1);
    }
    if (reader->failed) {
        return NULL;
    }
    (void)memcpy(line, text, strlen(text) + 1u);
    return line;
}

/* ------------------------------------------------------------------------------------------------------------ keys -- */

static void store(goe_settings_t *settings, size_t camera, const camera_key_t *key, float value) {
    (void)memcpy((char *)settings + key->offset + camera * SECOND_OFFSET, &value, sizeof value);
}

static float stored(const goe_settings_t *settings, size_t camera, const camera_key_t *key) {
    float value = 0.0f;
    (void)memcpy(&value, (const char *)settings + key->offset + camera * SECOND_OFFSET, sizeof value);
    return value;
}

/* As the file has it. */
static key_name_t key_name(size_t camera, const camera_key_t *key) {
    key_name_t name;
    (void)snprintf(name.text, sizeof name.text, "%s%s", camera == 0 ? "" : SECOND_NAME,
                   camera == 0 ? key->name : strchr(key->name, '.'));
    return name;
}

/* False: there is no such key. */
static bool find_key(const char *name, size_t *camera, size_t *i) {
    for (*camera = 0; *camera < CAMERAS; (*camera)++) {
        for (*i = 0; *i < KEYS; (*i)++) {
            const bool has_key = *camera == 0 || keys[*i].kind != KIND_HEADING;
            if (has_key && strcmp(key_name(*camera, &keys[*i]).text, name) == 0) {
                return true;
            }
        }
    }
    return false;
}

/* The key that a mistyped one was probably meant to be; empty: none is like it. */
static key_name_t nearest_key(const char *name) {
    key_name_t names[CAMERAS * KEYS], none = {""};
    nearest_name_t nearest = nearest_name_of(name, strlen(name));
    for (size_t i = 0; i < CAMERAS * KEYS; i++) {
        names[i] = key_name(i / KEYS, &keys[i % KEYS]);
        if (i < KEYS || keys[i % KEYS].kind != KIND_HEADING) {
            nearest_name_try(&nearest, names[i].text);
        }
    }
    if (nearest.name == NULL) {
        return none;
    }
    (void)snprintf(none.text, sizeof none.text, "%s", nearest.name);
    return none;
}

static void store_text(camera_reader_t *reader, size_t camera, const camera_key_t *key, const char *text) {
    double number = 0.0;
    if (key->kind == KIND_HEADING) {
        reader->settings.heading_auto = strcmp(text, HEADING_AUTO) == 0;
        if (reader->settings.heading_auto) {
            return;
        }
    }
    if (number_parse(text, strlen(text), &number)) {
        store(&reader->settings, camera, key, number_to_float(number));
    } else {
        FAIL(reader, reader->lines.number, key_name(camera, key).text, "'%s' is not a number%s",
             excerpt_of(text, strlen(text)).text, key->kind == KIND_HEADING ? " and not " HEADING_AUTO : "");
    }
}

/* The parser's call for one key; the section is always empty, see check_line(). */
static int on_key(void *user, const char *section, const char *name, const char *text) {
    (void)section;
    camera_reader_t *reader = user;
    size_t camera, i;
    if (!find_key(name, &camera, &i)) {
        const key_name_t guess = nearest_key(name);
        FAIL(reader, reader->lines.number, name, "unknown key%s%s%s", *guess.text != '\0' ? "; did you mean " : "",
             guess.text, *guess.text != '\0' ? "?" : "");
    } else if (reader->key_line[camera][i] != 0) {
        FAIL(reader, reader->lines.number, name, "the key appears twice, first in line %lu",
             reader->key_line[camera][i]);
    } else {
        reader->key_line[camera][i] = reader->lines.number;
        reader->cameras = camera < reader->cameras ? reader->cameras : camera + 1u;
        store_text(reader, camera, &keys[i], text);
    }
    return !reader->failed;
}

/* ---------------------------------------------------------------------------------------------------------- checks -- */

static bool key_missing(const camera_reader_t *reader, size_t camera, size_t i) {
    return (keys[i].kind == KIND_SIZE || keys[i].kind == KIND_REQUIRED) && reader->key_line[camera][i] == 0;
}

/* The ranges are the library's own, the same for every camera: the key is tried alone, of the first one, on top of settings that
 * are known to be good. */
static bool value_accepted(const camera_key_t *key, float value) {
    if (key->kind == KIND_SIZE && value < SMALLEST_SIZE_PX) {
        return false;
    }
    goe_settings_t trial;
    goe_estimator_t estimator;
    (void)memset(&estimator, 0, sizeof estimator);
    goe_settings_default(&trial);
    trial.camera.fx_px = LONGEST_FOCAL_PX; /* which no size contradicts */
    trial.camera.fy_px = LONGEST_FOCAL_PX;
    trial.camera.cx_px = trial.camera.cy_px = 0.0f;
    trial.camera.width_px = trial.camera.height_px = 0.0f;
    trial.heading_auto = false;
    store(&trial, 0, key, value);
    return goe_init(&estimator, sizeof estimator, &trial, NULL) == GOE_OK;
}

static void check_key(camera_reader_t *reader, size_t camera, size_t i) {
    const key_name_t name = key_name(camera, &keys[i]);
    if (key_missing(reader, camera, i)) {
        FAIL(reader, reader->lines.number == 0 ? 1u : reader->lines.number, name.text,
             "missing key, not found up to here");
    } else if (!value_accepted(&keys[i], stored(&reader->settings, camera, &keys[i]))) {
        double low = 0.0, high = 0.0;
        (void)setting_range(keys[i].offset, &low, &high);
        low = keys[i].kind == KIND_SIZE ? (double)SMALLEST_SIZE_PX : low;
        FAIL(reader, reader->key_line[camera][i], name.text, "out of range: %g to %g", low, high);
    }
}

static void check_keys(camera_reader_t *reader) {
    for (size_t camera = 0; camera < reader->cameras; camera++) {
        for (size_t i = 0; i < KEYS; i++) {
            if (camera == 0 || keys[i].kind != KIND_HEADING) {
                check_key(reader, camera, i);
            }
        }
    }
}

/* ------------------------------------------------------------------------------------------------------- interface -- */

static void read_keys(camera_reader_t *reader) {
    reader->lines.stream = fopen(reader->path, "r");
    if (reader->lines.stream == NULL) {
        FAIL(reader, 0u, NULL, "cannot be opened: %s", strerror(errno));
        return;
    }
    errno = 0;
    const int parser_line = ini_parse_stream(read_line, reader, on_key, reader);
    if (ferror(reader->lines.stream) != 0) {
        FAIL(reader, 0u, NULL, "cannot be read: %s", strerror(errno));
    } else if (parser_line != 0) {
        FAIL(reader, parser_line > 0 ? (unsigned long)parser_line : 0u, NULL, "cannot be understood");
    }
    (void)fclose(reader->lines.stream);
}

bool camera_file_read(const char *path, goe_settings_t *settings, input_error_t *error) {
    camera_reader_t reader;
    (void)memset(&reader, 0, sizeof reader);
    reader.path = path;
    reader.error = error;
    reader.cameras = 1;
    reader.settings = *settings;
    read_keys(&reader);
    if (!reader.failed) {
        check_keys(&reader);
    }
    if (reader.failed) {
        return false;
    }
    *settings = reader.settings;
    return true;
}

int camera_file_cameras(const goe_settings_t *settings) { return settings->more_cameras[0].fx_px > 0.0f ? 2 : 1; }
