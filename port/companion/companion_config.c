/* Reads the companion's configuration. SPDX-License-Identifier: MIT */
#include "companion_config.h"

#include <errno.h>
#include <ini.h>
#include <inttypes.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "camera_file.h"
#include "ini_lines.h"
#include "link.h"
#include "nearest_name.h"
#include "number_text.h"
#include "renamed_names.h"
#include "settings_text.h"

#define LINE_MAX_LENGTH 190 /* what the parser takes */
#define NAME_MAX 96

/* ------------------------------------------------------------------------------------------------------------ keys -- */

typedef enum { KEY_TEXT, KEY_NUMBER, KEY_WHOLE, KEY_CHOICE, KEY_LIST } key_kind_t;

typedef struct {
    const char *name; /* section.key */
    size_t offset;    /* in companion_config_t */
    key_kind_t kind;
    double low, high, value; /* of numbers; value: by default. Of a choice: its number */
    const char *text;        /* default of a text; choices, or names of the list's bits, in order */
} config_key_t;

#define AT(field) offsetof(companion_config_t, field)
static const config_key_t keys[] = {
    {"link.autopilot", AT(link_autopilot), KEY_TEXT, 0, 0, 0, "udpin:127.0.0.1:14540"},
    {"link.key_file", AT(link_key_file), KEY_TEXT, 0, 0, 0, ""},
    {"link.system", AT(link_system), KEY_WHOLE, 0, 255, 0, NULL},
    {"link.component", AT(link_component), KEY_WHOLE, 1, 255, 196, NULL},
    {"link.request_rates", AT(link_request_rates), KEY_WHOLE, 0, 1, 1, NULL},
    {"link.attitude_hz", AT(link_attitude_hz), KEY_NUMBER, 1, 400, 25, NULL},
    {"link.position_hz", AT(link_position_hz), KEY_NUMBER, 1, 400, 25, NULL},
    {"detections.from", AT(detections_from), KEY_TEXT, 0, 0, 0, "udp:127.0.0.1:14600"},
    {"detections.mavlink", AT(detections_mavlink), KEY_LIST, 0, 0, DETECTIONS_GOE_FEATURES,
     "goe_features landing_target tracking"},
    {"detections.clock", AT(detections_clock), KEY_CHOICE, 0, 0, LINE_CLOCK_UNIX, "unix monotonic age autopilot"},
    {"detections.delay_s", AT(detections_delay_s), KEY_NUMBER, 0, 0.5, 0.1, NULL},
    {"detections.delay_sd_s", AT(detections_delay_sd_s), KEY_NUMBER, 0.0001, 0.5, 0.02, NULL},
    {"detections.shares_clock", AT(detections_shares_clock), KEY_WHOLE, 0, 1, 0, NULL},
    {"detections.classes", AT(detections_classes), KEY_TEXT, 0, 0, 0, ""},
    {"detections.class_names", AT(detections_class_names), KEY_TEXT, 0, 0, 0, ""},
    {"camera.file", AT(camera_file), KEY_TEXT, 0, 0, 0, "camera.ini"},
    {"reaction.mode", AT(reaction_mode), KEY_CHOICE, 0, 0, REACTION_OFF, "off px4 arduplane"},
    {"reaction.modes", AT(reaction_modes), KEY_LIST, 0, 0, 3,
     "mission hold offboard position altitude rtl land takeoff"},
    {"reaction.resume", AT(reaction_resume), KEY_WHOLE, 0, 1, 1, NULL},
    {"reaction.adsb_hz", AT(reaction_adsb_hz), KEY_NUMBER, 0.5, 20, 2, NULL},
    {"reaction.icao", AT(reaction_icao), KEY_WHOLE, 1, 0xFFFFF0, 0xF0E000, NULL},
    {"reports.assess_hz", AT(reports_assess_hz), KEY_NUMBER, 1, 100, 10, NULL},
    {"reports.obstacle_hz", AT(reports_obstacle_hz), KEY_NUMBER, 0.1, 100, 5, NULL},
    {"reports.screen", AT(reports_screen), KEY_WHOLE, 0, 1, 1, NULL},
    {"reports.standard", AT(reports_standard), KEY_LIST, 0, 0, 0,
     "obstacle_distance obstacle_distance_3d collision target_absolute"},
    {"reports.distance_increment_deg", AT(reports_distance_increment_deg), KEY_WHOLE, 5, 180, 5, NULL},
    {"reports.distance_max_m", AT(reports_distance_max_m), KEY_NUMBER, 1, 650, 300, NULL},
    {"record.folder", AT(record_folder), KEY_TEXT, 0, 0, 0, ""},
    {"record.size_max_mb", AT(record_size_max_mb), KEY_NUMBER, 1, 1e6, 500, NULL},
};
#undef AT
#define KEYS (sizeof keys / sizeof keys[0])

typedef struct {
    const char *name;
    size_t offset; /* in goe_flight_settings_t */
    float low, high;
} flight_key_t;

static const flight_key_t flight_keys[] = {
#define GOE_FLIGHT_SETTING(field, least, most, usual) {#field, offsetof(goe_flight_settings_t, field), least, most},
#include "goe_flight_settings_list.h"
#undef GOE_FLIGHT_SETTING
};
#define FLIGHT_KEYS (sizeof flight_keys / sizeof flight_keys[0])

static void *field_of(companion_config_t *config, const config_key_t *key) { return (char *)config + key->offset; }

static const void *value_of(const companion_config_t *config, const config_key_t *key) {
    return (const char *)config + key->offset;
}

/* Word number i of text with single blanks between words; false: there are fewer. */
static bool word_of(const char *text, unsigned i, char word[NAME_MAX]) {
    for (; i > 0 && text != NULL; i--) {
        text = strchr(text, ' ');
        text = text != NULL ? text + 1 : NULL;
    }
    if (text == NULL || *text == '\0') {
        return false;
    }
    (void)snprintf(word, NAME_MAX, "%.*s", (int)strcspn(text, " "), text);
    return true;
}

/* Number of the word that equals `text`, -1: none does. */
static int find_word(const char *words, const char *text) {
    char word[NAME_MAX];
    for (unsigned i = 0; word_of(words, i, word); i++) {
        if (strcmp(word, text) == 0) {
            return (int)i;
        }
    }
    return -1;
}

static void set_text(companion_config_t *config, const config_key_t *key, const char *text) {
    (void)snprintf(field_of(config, key), CONFIG_TEXT_MAX, "%s", text);
}

static void set_number(companion_config_t *config, const config_key_t *key, double value) {
    const unsigned whole = (unsigned)value;
    if (key->kind == KEY_NUMBER) {
        (void)memcpy(field_of(config, key), &value, sizeof value);
    } else {
        (void)memcpy(field_of(config, key), &whole, sizeof whole);
    }
}

static void set_defaults(companion_config_t *config) {
    (void)memset(config, 0, sizeof *config);
    for (size_t i = 0; i < KEYS; i++) {
        if (keys[i].kind == KEY_TEXT) {
            set_text(config, &keys[i], keys[i].text);
        } else {
            set_number(config, &keys[i], keys[i].value);
        }
    }
    goe_settings_default(&config->estimator);
    goe_flight_settings_default(&config->flight);
}

/* ----------------------------------------------------------------------------------------------------------- lines -- */

typedef struct {
    ini_lines_t lines;
    const char *path;
    unsigned long key_line[KEYS], flight_line[FLIGHT_KEYS]; /* where each was given; 0: nowhere */
    companion_config_t *config;
    bool failed;
    input_error_t *error;
} config_reader_t;

/* The first fault counts; faults that follow from it are not reported. */
#define FAIL(reader, key, ...)                                                                                         \
    do {                                                                                                               \
        if (!(reader)->failed) {                                                                                       \
            (reader)->failed = true;                                                                                   \
            input_error_set((reader)->error, (reader)->path, (reader)->lines.number, key, __VA_ARGS__);                \
        }                                                                                                              \
    } while (0)

static char *read_line(char *line, int size, void *user) {
    config_reader_t *reader = user;
    const char *fault = NULL;
    const char *text = reader->failed ? NULL : ini_lines_next(&reader->lines, &fault);
    if (fault != NULL) {
        FAIL(reader, NULL, "%s", fault);
    }
    if (text == NULL) {
        return NULL;
    }
    const size_t length = strlen(text);
    if (length > LINE_MAX_LENGTH) {
        FAIL(reader, NULL, "the line is longer than %d characters", LINE_MAX_LENGTH);
        return NULL;
    }
    if (*text == '[' && text[length - 1u] != ']') {
        FAIL(reader, NULL, "no ']' closes the name of the section");
        return NULL;
    }
    (void)snprintf(line, (size_t)size, "%s\n", text);
    return line;
}

/* ---------------------------------------------------------------------------------------------------------- values -- */

static bool in_range(config_reader_t *reader, const char *name, double value, double low, double high) {
    if (value >= low && value <= high) {
        return true;
    }
    FAIL(reader, name, "%g is out of range: %g to %g", value, low, high);
    return false;
}

static void take_whole(config_reader_t *reader, const config_key_t *key, const char *text) {
    char *end = NULL;
    const double value = (double)strtol(text, &end, 0); /* also 0x... */
    if (end == text || *end != '\0') {
        FAIL(reader, key->name, "'%s' is not a whole number", excerpt_of(text, strlen(text)).text);
    } else if (in_range(reader, key->name, value, key->low, key->high)) {
        set_number(reader->config, key, value);
    }
}

static void take_number(config_reader_t *reader, const config_key_t *key, const char *text) {
    double value = 0.0;
    if (!number_parse(text, strlen(text), &value)) {
        FAIL(reader, key->name, "'%s' is not a number", excerpt_of(text, strlen(text)).text);
    } else if (in_range(reader, key->name, value, key->low, key->high)) {
        set_number(reader->config, key, value);
    }
}

static void take_choice(config_reader_t *reader, const config_key_t *key, const char *text) {
    const int choice = find_word(key->text, text);
    if (choice < 0) {
        FAIL(reader, key->name, "'%s' is none of: %s", excerpt_of(text, strlen(text)).text, key->text);
        return;
    }
    set_number(reader->config, key, (double)choice);
}

static void take_list(config_reader_t *reader, const config_key_t *key, const char *text) {
    char word[NAME_MAX];
    unsigned bits = 0;
    for (unsigned i = 0; word_of(text, i, word); i++) {
        const int bit = find_word(key->text, word);
        if (bit < 0) {
            FAIL(reader, key->name, "'%s' is none of: %s", excerpt_of(word, strlen(word)).text, key->text);
            return;
        }
        bits |= 1u << bit;
    }
    set_number(reader->config, key, (double)bits);
}

static void take_key(config_reader_t *reader, size_t i, const char *text) {
    const config_key_t *key = &keys[i];
    if (reader->key_line[i] != 0) {
        FAIL(reader, key->name, "the key appears twice, first in line %lu", reader->key_line[i]);
        return;
    }
    reader->key_line[i] = reader->lines.number;
    switch (key->kind) {
        case KEY_TEXT:
            set_text(reader->config, key, text);
            break;
        case KEY_NUMBER:
            take_number(reader, key, text);
            break;
        case KEY_WHOLE:
            take_whole(reader, key, text);
            break;
        case KEY_CHOICE:
            take_choice(reader, key, text);
            break;
        case KEY_LIST:
        default:
            take_list(reader, key, text);
            break;
    }
}

static void take_estimator(config_reader_t *reader, const char *name, const char *text) {
    char assignment[LINE_MAX_LENGTH + 2];
    setting_fault_t fault;
    (void)snprintf(assignment, sizeof assignment, "%s=%s", name, text);
    if (!setting_assign(&reader->config->estimator, assignment, &fault) ||
        !settings_in_range(&reader->config->estimator, &fault)) {
        FAIL(reader, NULL, "%s", fault.text);
    }
}

static void take_flight(config_reader_t *reader, const char *name, const char *text) {
    for (size_t i = 0; i < FLIGHT_KEYS; i++) {
        const flight_key_t *key = &flight_keys[i];
        if (strcmp(key->name, name) != 0) {
            continue;
        }
        double value = 0.0;
        if (reader->flight_line[i] != 0) {
            FAIL(reader, name, "the key appears twice, first in line %lu", reader->flight_line[i]);
        } else if (!number_parse(text, strlen(text), &value)) {
            FAIL(reader, name, "'%s' is not a number", excerpt_of(text, strlen(text)).text);
        } else if (in_range(reader, name, value, (double)key->low, (double)key->high)) {
            const float number = number_to_float(value);
            (void)memcpy((char *)&reader->config->flight + key->offset, &number, sizeof number);
        }
        reader->flight_line[i] = reader->lines.number;
        return;
    }
    char full[NAME_MAX];
    (void)snprintf(full, sizeof full, "flight.%s", name);
    const char *now = renamed_name(full, strlen(full));
    if (now != NULL) {
        FAIL(reader, NULL, "unknown setting %s: now %s", full, now);
    } else {
        FAIL(reader, name, "no setting of the flight layer");
    }
}

static void report_unknown(config_reader_t *reader, const char *name, bool in_section) {
    nearest_name_t nearest = nearest_name_of(name, strlen(name));
    for (size_t i = 0; i < KEYS; i++) {
        nearest_name_try(&nearest, keys[i].name);
    }
    if (!in_section) {
        FAIL(reader, name, "unknown key before any [section]");
    } else if (nearest.name == NULL) {
        FAIL(reader, name, "unknown key");
    } else {
        FAIL(reader, name, "unknown key; did you mean %s?", nearest.name);
    }
}

/* The parser's call for one key. */
static int on_key(void *user, const char *section, const char *name, const char *text) {
    config_reader_t *reader = user;
    char full[NAME_MAX];
    if (strcmp(section, "estimator") == 0) {
        take_estimator(reader, name, text);
    } else if (strcmp(section, "flight") == 0) {
        take_flight(reader, name, text);
    } else {
        (void)snprintf(full, sizeof full, "%s.%s", section, name);
        size_t i = 0;
        while (i < KEYS && strcmp(keys[i].name, full) != 0) {
            i++;
        }
        if (i == KEYS) {
            report_unknown(reader, *section != '\0' ? full : name, *section != '\0');
        } else {
            take_key(reader, i, text);
        }
    }
    return !reader->failed;
}

/* ------------------------------------------------------------------------------------------------------- interface -- */

static void read_keys(config_reader_t *reader) {
    reader->lines.stream = fopen(reader->path, "r");
    if (reader->lines.stream == NULL) {
        FAIL(reader, NULL, "cannot be opened: %s", strerror(errno));
        return;
    }
    const int parser_line = ini_parse_stream(read_line, reader, on_key, reader);
    if (ferror(reader->lines.stream) != 0) {
        FAIL(reader, NULL, "cannot be read: %s", strerror(errno));
    } else if (parser_line != 0) {
        FAIL(reader, NULL, "not of the form: key = value");
    }
    (void)fclose(reader->lines.stream);
}

/* A path of the configuration is relative to its folder. False: too long. */
static bool resolve(char path[CONFIG_TEXT_MAX], const char *config_path) {
    const char *slash = strrchr(config_path, '/');
    const size_t folder = *path != '/' && slash != NULL ? (size_t)(slash - config_path) + 1u : 0u;
    const size_t length = strlen(path) + 1u;
    if (folder + length > CONFIG_TEXT_MAX) {
        return false;
    }
    (void)memmove(path + folder, path, length);
    (void)memcpy(path, config_path, folder);
    return true;
}

static bool resolve_if_given(char path[CONFIG_TEXT_MAX], const char *configuration) {
    return *path == '\0' || resolve(path, configuration);
}

/* Blanks around each name, so that a name can be looked for as a whole. A line's length leaves room for them. */
static void pad_classes(char classes[CONFIG_TEXT_MAX]) {
    const size_t length = strlen(classes);
    if (length > 0) {
        (void)memmove(classes + 1, classes, length);
        classes[0] = classes[length + 1u] = ' ';
        classes[length + 2u] = '\0';
    }
}

static bool is_given(const config_reader_t *reader, const char *flight_name) {
    for (size_t i = 0; i < FLIGHT_KEYS; i++) {
        if (strcmp(flight_keys[i].name, flight_name) == 0) {
            return reader->flight_line[i] != 0;
        }
    }
    return false;
}

static void check_link(config_reader_t *reader, size_t offset, const char *none) {
    char fault[2 * CONFIG_TEXT_MAX];
    size_t i = 0;
    while (keys[i].offset != offset) {
        i++;
    }
    const char *where = (const char *)value_of(reader->config, &keys[i]);
    if ((none == NULL || strcmp(where, none) != 0) && !link_check(where, fault, sizeof fault)) {
        reader->lines.number = reader->key_line[i];
        FAIL(reader, keys[i].name, "%s", fault);
    }
}

/* Rules for combinations of values. */
static void check_whole(config_reader_t *reader) {
    check_link(reader, offsetof(companion_config_t, link_autopilot), NULL);
    check_link(reader, offsetof(companion_config_t, detections_from), "none");
    if (360u % reader->config->reports_distance_increment_deg != 0 ||
        reader->config->reports_distance_increment_deg % 5u != 0) {
        reader->lines.number = 0;
        FAIL(reader, NULL, "reports.distance_increment_deg: %u is no multiple of 5 that divides 360",
             reader->config->reports_distance_increment_deg);
    }
    if (reader->config->reaction_mode == REACTION_PX4 && !is_given(reader, "loiter_m")) {
        reader->lines.number = 0;
        FAIL(
            reader, NULL,
            "flight.loiter_m: reaction.mode px4 needs it: a fixed wing circles about the target that it is sent to, by "
            "NAV_LOITER_RAD; 0 for a vehicle that stops there");
    }
    if (reader->config->flight.resets > 0.0f) {
        reader->lines.number = 0;
        FAIL(reader, NULL, "flight.resets: the companion makes the marks of resets itself; leave it out");
    }
}

bool companion_config_read(const char *path, const char *link, companion_config_t *config, input_error_t *error) {
    config_reader_t reader;
    (void)memset(&reader, 0, sizeof reader);
    reader.path = path;
    reader.config = config;
    reader.error = error;
    set_defaults(config);
    read_keys(&reader);
    if (link != NULL) {
        (void)snprintf(config->link_autopilot, sizeof config->link_autopilot, "%s", link);
    }
    if (!reader.failed) {
        check_whole(&reader);
    }
    if (reader.failed) {
        return false;
    }
    if (!resolve(config->camera_file, path) || !resolve_if_given(config->record_folder, path) ||
        !resolve_if_given(config->link_key_file, path)) {
        input_error_set(error, path, 0, NULL, "the path of camera.file, record.folder or link.key_file is too long");
        return false;
    }
    if (*config->link_key_file != '\0' && !key_file_read(config->link_key_file, config->link_key, error)) {
        return false;
    }
    pad_classes(config->detections_classes);
    return camera_file_read(config->camera_file, &config->estimator, error);
}

static void print_list(FILE *stream, const char *words, unsigned bits, bool one) {
    char word[NAME_MAX];
    for (unsigned i = 0; word_of(words, i, word); i++) {
        if (one ? i == bits : (bits >> i & 1u) != 0) {
            (void)fprintf(stream, " %s", word);
        }
    }
}

static void print_key(FILE *stream, const companion_config_t *config, const config_key_t *key) {
    unsigned whole = 0;
    double number = 0.0;
    (void)fprintf(stream, "%s =", key->name);
    if (key->kind == KEY_TEXT) {
        (void)fprintf(stream, " %s", (const char *)value_of(config, key));
    } else if (key->kind == KEY_NUMBER) {
        (void)memcpy(&number, value_of(config, key), sizeof number);
        (void)fprintf(stream, " %g", number);
    } else {
        (void)memcpy(&whole, value_of(config, key), sizeof whole);
        if (key->kind == KEY_WHOLE) {
            (void)fprintf(stream, " %u", whole);
        } else {
            print_list(stream, key->text, whole, key->kind == KEY_CHOICE);
        }
    }
    (void)fputc('\n', stream);
}

void companion_config_print(FILE *stream, const companion_config_t *config) {
    for (size_t i = 0; i < KEYS; i++) {
        print_key(stream, config, &keys[i]);
    }
    for (size_t i = 0; i < FLIGHT_KEYS; i++) {
        float number = 0.0f;
        (void)memcpy(&number, (const char *)&config->flight + flight_keys[i].offset, sizeof number);
        (void)fprintf(stream, "flight.%s = %g\n", flight_keys[i].name, (double)number);
    }
    (void)settings_print(stream, &config->estimator);
}
