/* The library's settings by name. SPDX-License-Identifier: MIT */
#include "settings_text.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "input_error.h"
#include "number_text.h"

#define WHOLE_MAX 1.0e6
#define LINE_MAX_LENGTH 100
#define INDENT "  "

typedef enum { KIND_NUMBER, KIND_COUNT, KIND_TRUTH, KIND_METHOD, KIND_MODEL } setting_kind_t;

typedef struct {
    const char *name;
    size_t offset; /* in goe_settings_t */
    setting_kind_t kind;
} setting_t;

#define SETTING(field, kind) {#field, offsetof(goe_settings_t, field), kind}

#define TUNED 21u /* so many of the first of these are to be tuned */
static const setting_t settings_by_name[] = {
    SETTING(noise.pixel_px, KIND_NUMBER),
    SETTING(noise.size_share, KIND_NUMBER),
    SETTING(noise.correlation, KIND_NUMBER),
    SETTING(noise.shape_share, KIND_NUMBER),
    SETTING(noise.attitude_bias_deg, KIND_NUMBER),
    SETTING(noise.attitude_white_deg, KIND_NUMBER),
    SETTING(noise.attitude_drift_deg, KIND_NUMBER),
    SETTING(noise.height_m, KIND_NUMBER),
    SETTING(noise.velocity_bias_m_s, KIND_NUMBER),
    SETTING(noise.position_walk_m, KIND_NUMBER),
    SETTING(typical_size_m, KIND_NUMBER),
    SETTING(gate_sigma, KIND_NUMBER),
    SETTING(huber_sigma, KIND_NUMBER),
    SETTING(misfit_max, KIND_NUMBER),
    SETTING(top_is_highest, KIND_TRUTH),
    SETTING(line_points, KIND_COUNT),
    SETTING(edge_min_px, KIND_NUMBER),
    SETTING(orientation_min_px, KIND_NUMBER),
    SETTING(side_min_px, KIND_NUMBER),
    SETTING(orientation_memory, KIND_COUNT),
    SETTING(min_baseline_m, KIND_NUMBER),
    SETTING(method, KIND_METHOD),
    SETTING(model, KIND_MODEL),
    SETTING(window, KIND_COUNT),
    SETTING(heading_auto, KIND_TRUTH),
    SETTING(heading_deg, KIND_NUMBER),
    SETTING(camera.fx_px, KIND_NUMBER),
    SETTING(camera.fy_px, KIND_NUMBER),
    SETTING(camera.cx_px, KIND_NUMBER),
    SETTING(camera.cy_px, KIND_NUMBER),
    SETTING(camera.k1, KIND_NUMBER),
    SETTING(camera.k2, KIND_NUMBER),
    SETTING(camera.p1, KIND_NUMBER),
    SETTING(camera.p2, KIND_NUMBER),
    SETTING(camera.k3, KIND_NUMBER),
    SETTING(camera.mount_yaw_deg, KIND_NUMBER),
    SETTING(camera.mount_pitch_deg, KIND_NUMBER),
    SETTING(camera.mount_roll_deg, KIND_NUMBER),
    SETTING(camera.offset_m[0], KIND_NUMBER),
    SETTING(camera.offset_m[1], KIND_NUMBER),
    SETTING(camera.offset_m[2], KIND_NUMBER),
};
#undef SETTING
#define SETTINGS (sizeof settings_by_name / sizeof settings_by_name[0])

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
    if (setting->kind == KIND_NUMBER) {
        return true;
    }
    const bool whole = fabs(value) <= WHOLE_MAX && fabs(value - rint(value)) <= 0.0;
    return whole && (setting->kind != KIND_TRUTH || (value >= 0.0 && value <= 1.0));
}

static void store(goe_settings_t *settings, const setting_t *setting, double value) {
    unsigned char *field = (unsigned char *)settings + setting->offset;
    switch (setting->kind) {
        case KIND_NUMBER: {
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
        case KIND_METHOD: {
            const goe_method_t method = (goe_method_t)(int)value;
            (void)memcpy(field, &method, sizeof method);
            break;
        }
        case KIND_MODEL:
        default: {
            const goe_model_t model = (goe_model_t)(int)value;
            (void)memcpy(field, &model, sizeof model);
            break;
        }
    }
}

bool setting_put(goe_settings_t *settings, const char *name, double value) {
    const setting_t *setting = find_setting(name, strlen(name), SETTINGS);
    if (setting == NULL || !suits(setting, value)) {
        return false;
    }
    store(settings, setting, value);
    return true;
}

/* ------------------------------------------------------------------------------------------------------- assignment -- */

static void append(setting_fault_t *fault, const char *text) {
    const size_t used = strlen(fault->text);
    (void)snprintf(fault->text + used, sizeof fault->text - used, "%s", text);
}

static bool tell_names(const char *name, size_t length, setting_fault_t *fault) {
    const excerpt_t excerpt = excerpt_of(name, length);
    (void)snprintf(fault->text, sizeof fault->text, "'%s' is no setting; there are ", excerpt.text);
    for (size_t i = 0; i < TUNED; i++) {
        append(fault, settings_by_name[i].name);
        append(fault, i + 2u < TUNED ? ", " : i + 1u < TUNED ? " and " : "");
    }
    return false;
}

static bool tell_value(const setting_t *setting, const char *text, const char *reason, setting_fault_t *fault) {
    const excerpt_t excerpt = excerpt_of(text, strlen(text));
    (void)snprintf(fault->text, sizeof fault->text, "%s: '%s' is not %s", setting->name, excerpt.text, reason);
    return false;
}

bool setting_assign(goe_settings_t *settings, const char *assignment, setting_fault_t *fault) {
    const size_t length = strcspn(assignment, "=");
    const setting_t *setting = find_setting(assignment, length, TUNED);
    if (setting == NULL) {
        return tell_names(assignment, length, fault);
    }
    if (assignment[length] == '\0') {
        (void)snprintf(fault->text, sizeof fault->text, "%s: no value; write %s=VALUE", setting->name, setting->name);
        return false;
    }
    const char *text = assignment + length + 1u;
    double value = 0.0;
    if (!number_parse(text, strlen(text), &value)) {
        return tell_value(setting, text, "a number", fault);
    }
    if (!suits(setting, value)) {
        return tell_value(setting, text, setting->kind == KIND_TRUTH ? "0 or 1" : "a whole number", fault);
    }
    store(settings, setting, value);
    return true;
}

/* ------------------------------------------------------------------------------------------------------------ range -- */

const char *settings_out_of_range(const goe_settings_t *settings) {
    goe_settings_t trial = *settings;
    goe_estimator_t estimator;
    const char *bad_field = NULL;
    (void)memset(&trial.camera, 0, sizeof trial.camera);
    trial.camera.fx_px = 1.0f;
    trial.camera.fy_px = 1.0f;
    return goe_init(&estimator, sizeof estimator, &trial, &bad_field) == GOE_OK ? NULL : bad_field;
}

/* ----------------------------------------------------------------------------------------------------------- print -- */

#define ENTRY_MAX 96

/* "name=value"; the tuned are numbers, counts and truth values. */
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
    for (size_t i = 0; i < TUNED; i++) {
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
