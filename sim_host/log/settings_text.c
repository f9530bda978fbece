/* The library's settings by name. SPDX-License-Identifier: MIT */
#include "settings_text.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "goe_settings_list.h"
#include "input_error.h"
#include "nearest_name.h"
#include "number_text.h"
#include "renamed_names.h"

#define WHOLE_MAX 1.0e6
#define LINE_MAX_LENGTH 100
#define INDENT "  "

typedef enum { KIND_REAL, KIND_COUNT, KIND_TRUTH, KIND_CHOICE } setting_kind_t;

typedef struct {
    const char *name;
    size_t offset; /* in goe_settings_t */
    setting_kind_t kind;
    const char *unit;
    double low, high, value; /* value: by default */
    const char *text;
} setting_t;

#define SETTING(field, kind, unit, low, high, value, text)                                                             \
    {#field, offsetof(goe_settings_t, field), KIND_##kind, unit, (double)(low), (double)(high), (double)(value), text},

/* The tuned ones first: the others have places of their own in logs and options. */
static const setting_t settings_by_name[] = {
    GOE_SETTINGS_FILTER(SETTING) GOE_SETTINGS_VELOCITY(SETTING) /* all of one list */
    GOE_SETTINGS_WINDOW(SETTING) GOE_SETTINGS_GENERAL(SETTING) GOE_SETTINGS_CAMERA(SETTING)};
#define SETTINGS (sizeof settings_by_name / sizeof settings_by_name[0])

static size_t count_tuned(void) {
#define ONE(field, kind, unit, low, high, value, text) 1,
    static const char tuned[] = {GOE_SETTINGS_FILTER(ONE) GOE_SETTINGS_VELOCITY(ONE) GOE_SETTINGS_WINDOW(ONE)};
    return sizeof tuned;
#undef ONE
}

/* ----------------------------------------------------------------------------------------------------------- values -- */

static const setting_t *find_setting(const char *name, size_t length, size_t count) {
    for (size_t i = 0; i < count; i++) {
        const setting_t *setting = &settings_by_name[i];
        if (strlen(setting->name) == length && memcmp(setting->name, name, length) == 0) {
            return setting;
        }
    }
    return NULL;
}

static bool suits(const setting_t *setting, double value) {
    if (setting->kind == KIND_REAL) {
        return true;
    }
    const bool whole = fabs(value) <= WHOLE_MAX && fabs(value - rint(value)) <= 0.0;
    return whole && (setting->kind != KIND_TRUTH || (value >= 0.0 && value <= 1.0));
}

static void store(goe_settings_t *settings, const setting_t *setting, double value) {
    unsigned char *field = (unsigned char *)settings + setting->offset;
    switch (setting->kind) {
        case KIND_REAL: {
            const float number = number_to_float(value);
            (void)memcpy(field, &number, sizeof number);
            break;
        }
        case KIND_COUNT: {
            const int count = (int)value;
            (void)memcpy(field, &count, sizeof count);
            break;
        }
        case KIND_TRUTH: {
            const bool truth = value > 0.0;
            (void)memcpy(field, &truth, sizeof truth);
            break;
        }
        case KIND_CHOICE:
        default: {
            const goe_method_t choice = (goe_method_t)(int)value; /* all enumerations here are of one size */
            (void)memcpy(field, &choice, sizeof choice);
            break;
        }
    }
}

/* ------------------------------------------------------------------------------------------------------- assignment -- */

static void append(setting_fault_t *fault, const char *text) {
    const size_t used = strlen(fault->text);
    (void)snprintf(fault->text + used, sizeof fault->text - used, "%s", text);
}

/* The setting whose group was left out; null if there is none. */
static const char *without_group(const char *name, size_t length) {
    for (size_t i = 0; i < count_tuned(); i++) {
        const char *dot = strrchr(settings_by_name[i].name, '.');
        if (dot != NULL && strlen(dot + 1) == length && strncmp(dot + 1, name, length) == 0) {
            return settings_by_name[i].name;
        }
    }
    return NULL;
}

static bool list_names(const char *name, size_t length, setting_fault_t *fault) {
    const excerpt_t excerpt = excerpt_of(name, length);
    const char *now = renamed_name(name, length);
    if (now != NULL) {
        (void)snprintf(fault->text, sizeof fault->text, "unknown setting %s: now %s", excerpt.text, now);
        return false;
    }
    if (strncmp(name, "camera.", strlen("camera.")) == 0) {
        (void)snprintf(fault->text, sizeof fault->text,
                       "'%s' is no setting here; the camera has its own file or section", excerpt.text);
        return false;
    }
    nearest_name_t nearest = nearest_name_of(name, length);
    for (size_t i = 0; i < count_tuned(); i++) {
        nearest_name_try(&nearest, settings_by_name[i].name);
    }
    const char *full = without_group(name, length);
    if (full != NULL || nearest.name != NULL) {
        (void)snprintf(fault->text, sizeof fault->text, "'%s' is no setting; did you mean %s?", excerpt.text,
                       full != NULL ? full : nearest.name);
        return false;
    }
    (void)snprintf(fault->text, sizeof fault->text, "'%s' is no setting; there are ", excerpt.text);
    for (size_t i = 0; i < count_tuned(); i++) {
        append(fault, settings_by_name[i].name);
        append(fault, i + 2u < count_tuned() ? ", " : i + 1u < count_tuned() ? " and " : "");
    }
    return false;
}

static bool describe_value(const setting_t *setting, const char *text, const char *reason, setting_fault_t *fault) {
    const excerpt_t excerpt = excerpt_of(text, strlen(text));
    (void)snprintf(fault->text, sizeof fault->text, "%s: '%s' is not %s", setting->name, excerpt.text, reason);
    return false;
}

bool setting_assign(goe_settings_t *settings, const char *assignment, setting_fault_t *fault) {
    const size_t length = strcspn(assignment, "=");
    const setting_t *setting = find_setting(assignment, length, count_tuned());
    if (setting == NULL) {
        return list_names(assignment, length, fault);
    }
    if (assignment[length] == '\0') {
        (void)snprintf(fault->text, sizeof fault->text, "%s: no value; write %s=VALUE", setting->name, setting->name);
        return false;
    }
    const char *text = assignment + length + 1u;
    double value = 0.0;
    if (!number_parse(text, strlen(text), &value)) {
        return describe_value(setting, text, "a number", fault);
    }
    if (!suits(setting, value)) {
        return describe_value(setting, text, setting->kind == KIND_TRUTH ? "0 or 1" : "a whole number", fault);
    }
    store(settings, setting, value);
    return true;
}

/* ------------------------------------------------------------------------------------------------------------ range -- */

/* The name of the first setting, camera excluded, that goe_init() refuses; null if it refuses none. */
static const char *first_refused(const goe_settings_t *settings) {
    goe_settings_t trial = *settings;
    goe_estimator_t estimator;
    const char *bad_field = NULL;
    (void)memset(&trial.camera, 0, sizeof trial.camera);
    trial.camera.fx_px = 1.0f;
    trial.camera.fy_px = 1.0f;
    return goe_init(&estimator, sizeof estimator, &trial, &bad_field) == GOE_OK ? NULL : bad_field;
}

bool settings_in_range(const goe_settings_t *settings, setting_fault_t *fault) {
    const char *name = first_refused(settings);
    if (name == NULL) {
        return true;
    }
    const setting_t *setting = find_setting(name, strlen(name), SETTINGS);
    (void)snprintf(fault->text, sizeof fault->text, "%s: out of range: %g to %g", name, setting->low, setting->high);
    return false;
}

/* ----------------------------------------------------------------------------------------------------------- print -- */

#define ENTRY_MAX 96

/* "name=value" */
static void format_entry(char text[ENTRY_MAX], const goe_settings_t *settings, const setting_t *setting) {
    const unsigned char *field = (const unsigned char *)settings + setting->offset;
    if (setting->kind == KIND_COUNT) {
        int count = 0;
        (void)memcpy(&count, field, sizeof count);
        (void)snprintf(text, ENTRY_MAX, "%s=%d", setting->name, count);
    } else if (setting->kind == KIND_TRUTH) {
        bool truth = false;
        (void)memcpy(&truth, field, sizeof truth);
        (void)snprintf(text, ENTRY_MAX, "%s=%d", setting->name, truth ? 1 : 0);
    } else {
        float number = 0.0f;
        (void)memcpy(&number, field, sizeof number);
        (void)snprintf(text, ENTRY_MAX, "%s=%g", setting->name, (double)number);
    }
}

bool settings_print(FILE *stream, const goe_settings_t *settings) {
    size_t column = 0;
    for (size_t i = 0; i < count_tuned(); i++) {
        char entry[ENTRY_MAX];
        format_entry(entry, settings, &settings_by_name[i]);
        const bool fresh_line = column == 0 || column + 1u + strlen(entry) > LINE_MAX_LENGTH;
        if (fprintf(stream, "%s%s%s", fresh_line && column > 0 ? "\n" : "", fresh_line ? INDENT : " ", entry) < 0) {
            return false;
        }
        column = (fresh_line ? strlen(INDENT) : column + 1u) + strlen(entry);
    }
    return fputc('\n', stream) != EOF;
}

bool setting_range(size_t offset, double *low, double *high) {
    for (size_t i = 0; i < SETTINGS; i++) {
        if (settings_by_name[i].offset == offset) {
            *low = settings_by_name[i].low;
            *high = settings_by_name[i].high;
            return true;
        }
    }
    return false;
}

bool settings_list(FILE *stream) {
    bool good = true;
    for (size_t i = 0; i < SETTINGS; i++) {
        const setting_t *s = &settings_by_name[i];
        good = good &&
               fprintf(stream, "%s\t%s\t%g\t%g\t%g\t%s\n", s->name, s->unit, s->low, s->high, s->value, s->text) > 0;
    }
    return good;
}
