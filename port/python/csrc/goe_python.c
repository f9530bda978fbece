/* SPDX-License-Identifier: MIT */
#include "goe_python.h"

#include <string.h>

#include "goe_settings_list.h"

/* -------------------------------------------------------------------------------------------------------- settings -- */

#define ROW(field, kind, unit, low, high, value, text)                                                                 \
    {#field, unit, text, GOE_PYTHON_##kind, (double)(low), (double)(high), (double)(value)},
#define PLACE(field, kind, unit, low, high, value, text) offsetof(goe_settings_t, field),
#define ONE(field, kind, unit, low, high, value, text) (char)1,

static const goe_python_setting_t rows[] = {GOE_SETTINGS(ROW)};
static const size_t places[] = {GOE_SETTINGS(PLACE)};

#define ROWS ((int)(sizeof rows / sizeof rows[0]))
#define CAMERA_ROWS ((int)sizeof((const char[]){GOE_SETTINGS_CAMERA(ONE)}))

const goe_python_setting_t *goe_python_setting(int row) { return row >= 0 && row < ROWS ? &rows[row] : NULL; }

int goe_python_camera_settings(void) { return CAMERA_ROWS; }

static void put(unsigned char *place, int kind, double value) {
    const float real = (float)value;
    const int count = (int)value;
    const bool truth = count != 0;
    const goe_method_t choice = (goe_method_t)count; /* all enumerations of the settings are of one size */
    switch (kind) {
        case GOE_PYTHON_REAL:
            memcpy(place, &real, sizeof real);
            break;
        case GOE_PYTHON_COUNT:
            memcpy(place, &count, sizeof count);
            break;
        case GOE_PYTHON_TRUTH:
            memcpy(place, &truth, sizeof truth);
            break;
        default:
            memcpy(place, &choice, sizeof choice);
            break;
    }
}

void goe_python_settings(const double *values, int cameras, goe_settings_t *settings) {
    goe_settings_default(settings);
    for (int i = 0; i < ROWS; i++) {
        put((unsigned char *)settings + places[i], rows[i].kind, values[i]);
    }
#if GOE_CAMERAS_MAX > 1
    const double *value = values + ROWS;
    for (int c = 0; c + 1 < cameras && c + 1 < GOE_CAMERAS_MAX; c++) {
        for (int i = 0; i < CAMERA_ROWS; i++) {
            const size_t within = places[i] - offsetof(goe_settings_t, camera);
            put((unsigned char *)&settings->more_cameras[c] + within, rows[i].kind, *value++);
        }
    }
#else
    (void)cameras;
#endif
}

goe_status_t goe_python_init(goe_estimator_t *estimator, const double *values, int cameras, const char **bad_field) {
    goe_settings_t settings;
    goe_python_settings(values, cameras, &settings);
    return goe_init(estimator, sizeof *estimator, &settings, bad_field);
}

size_t goe_python_estimator_size(void) { return sizeof(goe_estimator_t); }

void goe_python_sizes(size_t sizes[3]) {
    sizes[0] = sizeof(goe_image_t);
    sizes[1] = sizeof(goe_estimate_t);
    sizes[2] = sizeof(goe_hazard_t);
}

/* ---------------------------------------------------------------------------------------------------------- tracks -- */

/* Why there is no hazard, or GOE_OK. */
static goe_status_t status_of(const goe_estimator_t *estimator, const goe_intent_t *intent, goe_decision_t decision) {
    goe_hazard_t unused;
    if (decision == GOE_DECISION_ACT || decision == GOE_DECISION_CLEAR) {
        return GOE_OK;
    }
    const goe_status_t status = goe_hazard(estimator, intent, &unused);
    return status == GOE_OK && decision == GOE_DECISION_KEEP ? GOE_OUT_OF_RANGE : status; /* of the rule */
}

static goe_decision_t decide(const goe_estimator_t *estimator, const float velocity[3], const goe_python_rule_t *given,
                             int32_t *hazard_status, goe_hazard_t *hazard) {
    goe_intent_t intent;
    goe_rule_t rule;
    memcpy(intent.velocity_ned_m_s, velocity, sizeof intent.velocity_ned_m_s);
    intent.margin_m = given->margin_m;
    intent.clearance_m = given->clearance_m;
    intent.since_image_s = given->since_image_s;
    intent.velocity_sd_m_s = given->velocity_sd_m_s;
    rule.conflict_probability_max = given->conflict_probability_max;
    rule.act_within_s = given->act_within_s;
    rule.suspect_factor = given->suspect_factor;
    rule.stale_growth_m_s = given->stale_growth_m_s;
    const goe_decision_t decision = goe_decide(estimator, &intent, &rule, hazard);
    *hazard_status = (int32_t)status_of(estimator, &intent, decision);
    return decision;
}

bool goe_python_image_taken(int status) { return GOE_IMAGE_TAKEN(status); }

void goe_python_update(goe_estimator_t *estimator, size_t images, const goe_image_t *image, int32_t *status,
                       goe_estimate_t *estimate, float (*covariance)[GOE_QUANTITIES][GOE_QUANTITIES], size_t rules,
                       const goe_python_rule_t *rule, const float (*velocity_ned_m_s)[3], int32_t *decision,
                       int32_t *hazard_status, goe_hazard_t *hazard) {
    for (size_t k = 0; k < images; k++) {
        status[k] = (int32_t)goe_update(estimator, &image[k], &estimate[k]);
        if (covariance != NULL) {
            (void)goe_covariance(estimator, covariance[k]);
        }
        for (size_t i = 0; i < rules; i++) {
            const size_t place = k * rules + i;
            decision[place] =
                (int32_t)decide(estimator, velocity_ned_m_s[k], &rule[i], &hazard_status[place], &hazard[place]);
        }
    }
}
